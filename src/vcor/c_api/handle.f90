!> The target of a `vcor_case` of the C interface: a case, and what has been built for its impacts
module vcor_c_api_handle
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use, intrinsic :: iso_c_binding, only : c_associated, c_double, c_f_pointer, c_int, c_ptr
   use vcor_c_api_values, only : array_at, demand
   use vcor_case_address, only : material_names, resolve, swept_addresses
   use vcor_case_body, only : material_of_case
   use vcor_case_case, only : address_t, case_t, entry_t, operator(==)
   use vcor_case_catalogue, only : find_group
   use vcor_case_checks, only : validate
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_io_data_file, only : read_data
   use vcor_io_posix, only : fortran => fortran_text
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   use vcor_solver, only : solver_t
   use vcor_sweep_points, only : new_sweep, sweep_t
   use vcor_text, only : canonical_name, shortened
   use vcor_words, only : suggestion
   implicit none
   private

   public :: handle_t, open_case, open_points, find_place, build, build_points, find_body

   !> Target of a `vcor_case`
   type :: handle_t
      !> The case as read and set
      type(case_t) :: case
      !> What is common to its impacts
      type(sweep_t) :: sweep
      !> Addresses for which `sweep` was built; unallocated if it must be built
      type(address_t), allocatable :: built_for(:)
      !> Solver that has been settled on the mesh of an impact; unallocated: each has its own
      class(solver_t), allocatable :: solver
   end type handle_t

contains

   !> Get the target of a `vcor_case`
   subroutine open_case(self, handle, error)
      type(c_ptr), intent(in) :: self
      !> The case, null if there is none
      type(handle_t), pointer, intent(out) :: handle
      !> Error of code `error_usage` if there is none, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      nullify (handle)
      if (c_associated(self)) then
         call c_f_pointer(self, handle)
      else
         call raise(error, error_usage, 'the case is NULL: vcor_read has not made one')
      end if
   end subroutine open_case

   !> Get the addresses and values of points, as arguments have them
   subroutine open_points(m, address_list, n, value_table, addresses, values, error)
      !> Numbers of addresses and of points
      integer(c_int), intent(in) :: m, n
      type(c_ptr), intent(in) :: address_list, value_table
      !> Shapes (m) and (m, n)
      type(c_ptr), pointer, intent(out) :: addresses(:)
      real(c_double), pointer, intent(out) :: values(:, :)
      !> An earlier error, which is kept, or one of code `error_usage`; unallocated on success
      type(error_t), allocatable, intent(inout) :: error

      integer :: i

      nullify (addresses, values)
      if (m > 0) call demand(address_list, 'addresses', error)
      if (m > 0 .and. n > 0) call demand(value_table, 'values', error)
      if (allocated(error)) return
      call c_f_pointer(array_at(address_list, m), addresses, [m])
      call c_f_pointer(array_at(value_table, min(m, n)), values, [m, n])
      do i = 1, m
         call demand(addresses(i), 'addresses[i]', error)
      end do
   end subroutine open_points

   !> Find the place of an address in a case
   subroutine find_place(case, address, place, error)
      type(case_t), intent(in) :: case
      character(len=*), intent(in) :: address
      type(address_t), intent(out) :: place
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: message

      call resolve(case, address, place, message)
      if (allocated(message)) call raise(error, error_usage, shortened(address)//': '//message)
   end subroutine find_place

   !> Check a case and read its data files
   subroutine check(case, error)
      type(case_t), intent(inout) :: case
      type(error_t), allocatable, intent(out) :: error

      call validate(case, error)
      if (.not. allocated(error)) call read_data(case, error)
   end subroutine check

   !> Build what is common to the impacts of a case, unless it has been built
   subroutine build(handle, addresses, values, error)
      !> The case
      type(handle_t), intent(inout) :: handle
      !> Addresses with values for each point
      type(c_ptr), intent(in) :: addresses(:)
      !> Values, one column per point
      real(wp), intent(in) :: values(:, :)
      type(error_t), allocatable, intent(out) :: error

      type(case_t) :: case
      type(address_t) :: places(size(addresses)), address
      type(address_t), allocatable :: own(:)
      type(entry_t) :: entry
      integer :: i, item

      do i = 1, size(addresses)
         call find_place(handle%case, fortran(addresses(i)), places(i), error)
         if (allocated(error)) return
      end do
      if (allocated(handle%built_for)) then
         if (size(handle%built_for) == size(places)) then
            if (all(handle%built_for == places)) return
         end if
         deallocate (handle%built_for)
      end if
      case = handle%case
      allocate (own, source=swept_addresses(case))
      do i = 1, size(addresses)
         if (any(own == places(i))) cycle
         ! a value or a list in the case has no effect on points that bring their own
         address = places(i)
         address%element = 0
         call case%oust(address, always=.true.)
         entry = case%entry(address)
         if (allocated(entry%origin)) then
            deallocate (entry%origin)
            call case%set(address, entry)
         end if
         entry = entry_t()
         ! the &sweep group that a file would have; its values are set later
         call case%add(find_group('sweep'), 0, item)
         entry%given = .true.
         entry%text = fortran(addresses(i))
         entry%origin = shortened(entry%text)
         call case%set(case%address('sweep', 'parameter', item), entry)
         call case%set(case%address('sweep', 'values', item), &
            merge(values(i, :1), 1.0_wp, ieee_is_finite(values(i, :1))), given=.true.)
      end do
      call check(case, error)
      if (.not. allocated(error)) call new_sweep(handle%sweep, case, error)
      if (allocated(error)) return
      do i = 1, size(handle%sweep%grid%axes)
         if (any(places == handle%sweep%grid%axes(i)%address)) cycle
         call raise(error, error_input, case%location('sweep', 'parameter', i) &
            //": the case varies '"//handle%sweep%grid%axes(i)%name &
            //"', expected values for it among those of the points, or no &sweep group")
         return
      end do
      handle%sweep%grid%is_list = size(addresses) > 0
      if (allocated(handle%solver)) then
         deallocate (handle%sweep%problem%solver)
         allocate (handle%sweep%problem%solver, source=handle%solver)
      end if
      handle%built_for = places
   end subroutine build

   !> Build the impacts of points
   subroutine build_points(handle, addresses, values, sweep, error)
      !> The case
      type(handle_t), intent(inout) :: handle
      !> Addresses with values for each point, shape (m)
      type(c_ptr), intent(in) :: addresses(:)
      !> Values, shape (m, n)
      real(wp), intent(in) :: values(:, :)
      type(sweep_t), intent(out) :: sweep
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      call build(handle, addresses, values, error)
      if (allocated(error)) return
      sweep = handle%sweep
      do i = 1, size(sweep%grid%axes)
         associate (axis => sweep%grid%axes(i))
            axis%values = values(findloc(handle%built_for == axis%address, .true., dim=1), :)
         end associate
      end do
   end subroutine build_points

   !> Build a material of a case
   subroutine find_body(self, name, material, error)
      type(c_ptr), intent(in) :: self
      !> Name of the material
      type(c_ptr), intent(in) :: name
      class(material_t), allocatable, intent(out) :: material
      type(error_t), allocatable, intent(out) :: error

      type(handle_t), pointer :: handle
      type(case_t) :: case
      integer :: item

      call open_case(self, handle, error)
      call demand(name, 'material', error)
      if (allocated(error)) return
!$omp critical (vcor_c_api)
      case = handle%case
      item = case%find_material(fortran(name))
      if (item == 0) then
         call raise(error, error_usage, "there is no material '"//shortened(fortran(name)) &
            //"'; "//suggestion(canonical_name(fortran(name)), material_names(case)))
      else
         call check(case, error)
      end if
      if (.not. allocated(error)) call material_of_case(case, item, material, error)
!$omp end critical (vcor_c_api)
   end subroutine find_body

end module vcor_c_api_handle
