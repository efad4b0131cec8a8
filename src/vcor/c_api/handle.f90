!> The target of a `vcor_case` of the C interface: a case, and what has been built for its impacts
module vcor_c_api_handle
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use, intrinsic :: iso_c_binding, only : c_associated, c_double, c_f_pointer, c_int, c_ptr
   use vcor_c_api_values, only : array_at, demand
   use vcor_case_address, only : material_names, resolve, swept_addresses
   use vcor_case_body, only : material_of_case
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group, groups, real_key
   use vcor_case_checks, only : note_length, validate
   use vcor_case_entries, only : address_t, entry_t, operator(==)
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_impact_validity, only : surroundings_t
   use vcor_io_coverage, only : has_data
   use vcor_io_data_file, only : read_data
   use vcor_io_path, only : folder_of, full_path, join_path
   use vcor_io_posix, only : fortran => fortran_text
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   use vcor_solver, only : solver_t
   use vcor_sweep_points, only : most_threads, new_sweep, put_numbers, sweep_t, worker_t
   use vcor_text, only : canonical_name, integer_text, shortened
   use vcor_words, only : suggestion
   implicit none
   private

   public :: examined_t, handle_t, open_case, check_counts, open_points, find_place, find_places, &
      follow
   public :: whole_folder, note, forget, build, build_points, copy_points, find_item, &
      find_body, shortens_only, take_worker, give_back

   !> Most numbers that are set from call to call
   integer, parameter :: most_tuned = 16

   !> Single impacts whose data have been examined: those of one state of the materials, the
   !> shortest and the longest contact of them
   type :: examined_t
      !> Addresses with values for the point, shape (m)
      type(address_t), allocatable :: places(:)
      !> The values, shape (m)
      real(wp), allocatable :: values(:)
      !> Shortest and longest contact [s]
      real(wp) :: shortest = 0.0_wp, longest = 0.0_wp
      !> What the data do not say about each of the two, in lines
      character(len=:), allocatable :: of_shortest, of_longest
   end type examined_t

   !> Target of a `vcor_case`
   type :: handle_t
      !> The case as read and set
      type(case_t) :: case
      !> Folder where the process was when the case was read
      character(len=:), allocatable :: place
      !> Numbers that were set since anything else was, shape (n): the case is solved as a point
      !> with values at these addresses, so that setting them again does not build everything anew
      type(address_t), allocatable :: tuned(:)
      !> Addresses of the last single point that was looked at for implausible numbers; unallocated:
      !> none
      type(address_t), allocatable :: looked_at(:)
      !> Notes on implausible numbers that were handed over, without the place of the number
      character(len=note_length), allocatable :: reported(:)
      !> Single impacts of which `vcor_impact` examined the data last; unallocated: none
      type(examined_t), allocatable :: examined
      !> What is common to its impacts
      type(sweep_t) :: sweep
      !> Addresses for which `sweep` was built; unallocated if it must be built
      type(address_t), allocatable :: built_for(:)
      !> How often it was built
      integer :: builds = 0
      !> Whether a material of its bodies has data of a known range
      logical :: has_data = .false.
      !> The last single impact of `sweep`, of which the next one takes what is the same;
      !> unallocated if a call has it, or there was none
      type(worker_t), allocatable :: worker
      !> Solver that has been settled on the mesh of an impact; unallocated: each has its own
      class(solver_t), allocatable :: solver
      !> Material that was built last, so that not every call for a modulus checks the case;
      !> unallocated if it must be built
      class(material_t), allocatable :: body
      !> Its index
      integer :: body_item = 0
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

   !> Check the numbers of elements of a call
   subroutine check_counts(m, n, k, threads, error)
      !> Numbers of addresses, points, columns and threads
      integer, intent(in) :: m, n, k, threads
      !> An earlier error, which is kept, or one of code `error_usage`; unallocated on success
      type(error_t), allocatable, intent(inout) :: error

      if (allocated(error)) return
      if (min(m, n, k) < 0) then
         call raise(error, error_usage, &
            'found a negative number of addresses, points or columns')
      else if (m == 0 .and. n > 1) then
         call raise(error, error_usage, 'found several points without an address, expected one')
      else if (threads < 0 .or. threads > most_threads) then
!$omp critical (vcor_c_api)
         call raise(error, error_usage, 'found '//integer_text(threads) &
            //' threads, expected 1 to '//integer_text(most_threads) &
            //', or 0 for as many as there are cores')
!$omp end critical (vcor_c_api)
      end if
   end subroutine check_counts

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

   !> Find the places of addresses in a case
   subroutine find_places(case, addresses, places, error)
      type(case_t), intent(in) :: case
      !> Shape (m)
      type(c_ptr), intent(in) :: addresses(:)
      !> Shape (m)
      type(address_t), allocatable, intent(out) :: places(:)
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      allocate (places(size(addresses)))
      do i = 1, size(addresses)
         call find_place(case, fortran(addresses(i)), places(i), error)
         if (allocated(error)) return
      end do
   end subroutine find_places

   !> Find the data files of a case where they were, if the process has gone to another folder
   subroutine follow(handle)
      type(handle_t), intent(inout) :: handle

      if (allocated(handle%case%folder)) deallocate (handle%case%folder)
      if (full_path('') /= handle%place) handle%case%folder = whole_folder(handle)
   end subroutine follow

   !> Absolute path of the folder of the data files of a case
   function whole_folder(handle) result(folder)
      type(handle_t), intent(in) :: handle
      !> With a slash at its end
      character(len=:), allocatable :: folder

      folder = join_path(handle%place, folder_of(handle%case%source))
   end function whole_folder

   !> Note that a value was set: what was built holds if it is one of the numbers that points bring
   subroutine note(handle, place)
      type(handle_t), intent(inout) :: handle
      type(address_t), intent(in) :: place

      logical :: is_number

      if (allocated(handle%body)) deallocate (handle%body)
      if (allocated(handle%solver) .and. place%group == find_group('solver')) &
         deallocate (handle%solver)
      if (allocated(handle%examined) .and. .not. shortens_only(handle%case, place)) &
         deallocate (handle%examined)
      is_number = all(groups(place%group)%name /= ['sweep ', 'output', 'case  ']) .and. &
         (place%element > 0 .or. catalogue(place%row)%value_kind == real_key)
      if (.not. is_number) then
         call forget(handle)
         return
      end if
      if (allocated(handle%built_for)) then
         if (all(.not. handle%built_for == place)) deallocate (handle%built_for)
      end if
      if (.not. allocated(handle%tuned)) allocate (handle%tuned(0))
      if (any(handle%tuned == place)) return
      ! what the number excludes, as drop_height does velocity, is no longer given
      handle%tuned = pack(handle%tuned, is_given(handle%tuned))
      if (size(handle%tuned) == most_tuned) handle%tuned = handle%tuned(:0)
      handle%tuned = [handle%tuned, place]

   contains

      !> Whether a value is given
      elemental function is_given(address) result(yes)
         type(address_t), intent(in) :: address
         logical :: yes

         type(entry_t) :: entry

         entry = handle%case%entry(address)
         yes = entry%given
      end function is_given
   end subroutine note

   !> Forget what was built and looked at, after a change of the case
   subroutine forget(handle)
      type(handle_t), intent(inout) :: handle

      if (allocated(handle%body)) deallocate (handle%body)
      if (allocated(handle%built_for)) deallocate (handle%built_for)
      if (allocated(handle%tuned)) deallocate (handle%tuned)
      if (allocated(handle%looked_at)) deallocate (handle%looked_at)
      if (allocated(handle%examined)) deallocate (handle%examined)
   end subroutine forget

   !> Whether a value changes the duration of a contact, and neither a material nor its temperature
   pure function shortens_only(case, place) result(yes)
      type(case_t), intent(in) :: case
      type(address_t), intent(in) :: place
      logical :: yes

      yes = place == case%address('impact', 'velocity') &
         .or. place == case%address('impact', 'drop_height')
   end function shortens_only

   !> Check a case and read its data files
   subroutine check(case, error)
      type(case_t), intent(inout) :: case
      type(error_t), allocatable, intent(out) :: error

      call validate(case, error)
      if (.not. allocated(error)) call read_data(case, error)
   end subroutine check

   !> Build what is common to the impacts of a case, unless it has been built
   subroutine build(handle, places, values, error, addresses)
      !> The case
      type(handle_t), intent(inout) :: handle
      !> Places with values for each point
      type(address_t), intent(in) :: places(:)
      !> Values, one column per point
      real(wp), intent(in) :: values(:, :)
      type(error_t), allocatable, intent(out) :: error
      !> Addresses of the places as the caller has them, for messages; absent: their paths
      type(c_ptr), intent(in), optional :: addresses(:)

      type(case_t) :: case
      type(address_t) :: address
      type(address_t), allocatable :: own(:)
      type(entry_t) :: entry
      !> What is known of the face, from before a change of the case
      type(surroundings_t) :: known
      integer :: i, item

      if (allocated(handle%built_for)) then
         if (size(handle%built_for) == size(places)) then
            if (all(handle%built_for == places)) return
         end if
         deallocate (handle%built_for)
      end if
      if (allocated(handle%worker)) deallocate (handle%worker)
      handle%builds = handle%builds + 1
      call follow(handle)
      case = handle%case
      allocate (own, source=swept_addresses(case))
      do i = 1, size(places)
         if (any(own == places(i))) cycle
         ! a value or a list in the case has no effect on points that bring their own
         address = places(i)
         address%element = 0
         call case%drop_alternative(address, always=.true.)
         entry = case%entry(address)
         if (allocated(entry%origin)) then
            deallocate (entry%origin)
            call case%set(address, entry)
         end if
         entry = entry_t()
         ! the &sweep group that a file would have; its values are set later
         call case%add(find_group('sweep'), 0, item)
         entry%given = .true.
         if (present(addresses)) then
            entry%text = fortran(addresses(i))
         else
            entry%text = case%path(places(i))
         end if
         entry%origin = shortened(entry%text)
         call case%set(case%address('sweep', 'parameter', item), entry)
         call case%set(case%address('sweep', 'values', item), &
            merge(values(i, :1), 1.0_wp, ieee_is_finite(values(i, :1))), given=.true.)
      end do
      call check(case, error)
      known = handle%sweep%problem%surroundings
      if (.not. allocated(error)) call new_sweep(handle%sweep, case, error)
      if (allocated(error)) return
      call handle%sweep%problem%surroundings%learn_from(known)
      do i = 1, size(handle%sweep%grid%axes)
         if (any(places == handle%sweep%grid%axes(i)%address)) cycle
         call raise(error, error_input, case%location('sweep', 'parameter', i) &
            //": the case varies '"//handle%sweep%grid%axes(i)%name &
            //"', expected values for it among those of the points, or no &sweep group")
         return
      end do
      handle%sweep%grid%is_list = size(places) > 0
      if (allocated(handle%solver)) then
         deallocate (handle%sweep%problem%solver)
         allocate (handle%sweep%problem%solver, source=handle%solver)
      end if
      handle%has_data = has_data(handle%sweep%case)
      handle%built_for = places
   end subroutine build

   !> Build the impacts of points. Without addresses it is that of the case: as a point with the
   !> numbers that were set, or as it is if there are none or they make no point
   subroutine build_points(handle, addresses, places, values, numbers, error)
      !> The case
      type(handle_t), intent(inout) :: handle
      !> Addresses with values for each point as the caller has them, shape (m)
      type(c_ptr), intent(in) :: addresses(:)
      !> Their places, shape (m)
      type(address_t), intent(in) :: places(:)
      !> Values, shape (m, n)
      real(wp), intent(in) :: values(:, :)
      !> Values at the addresses for which it was built, shape (l, n): those given, or the numbers
      !> that were set
      real(wp), allocatable, intent(out) :: numbers(:, :)
      type(error_t), allocatable, intent(out) :: error

      type(address_t) :: nowhere(0)
      integer :: i

      numbers = values
      if (size(places) > 0) then
         call build(handle, places, values, error, addresses)
         return
      end if
      if (allocated(handle%tuned)) then
         if (size(handle%tuned) > 0) then
            numbers = reshape([(handle%case%number(handle%tuned(i)), i=1, size(handle%tuned))], &
               [size(handle%tuned), 1])
            call build(handle, handle%tuned, numbers, error)
            if (.not. allocated(error)) return
         end if
      end if
      numbers = reshape([real(wp) ::], [0, 1])
      call build(handle, nowhere, numbers, error)
   end subroutine build_points

   !> Copy what has been built, with the values of points
   subroutine copy_points(handle, values, sweep)
      !> The case, built
      type(handle_t), intent(in) :: handle
      !> Values at the addresses for which it was built, shape (m, n)
      real(wp), intent(in) :: values(:, :)
      type(sweep_t), intent(out) :: sweep

      integer :: i

      sweep = handle%sweep
      do i = 1, size(sweep%grid%axes)
         associate (axis => sweep%grid%axes(i))
            axis%values = values(place_among(handle, axis%address), :)
         end associate
      end do
   end subroutine copy_points

   !> Place of an address among those for which the case was built
   pure function place_among(handle, address) result(place)
      type(handle_t), intent(in) :: handle
      type(address_t), intent(in) :: address
      integer :: place

      do place = 1, size(handle%built_for)
         if (handle%built_for(place) == address) return
      end do
   end function place_among

   !> Take the last single impact and give it other numbers, so that the next one is solved while
   !> others use the case
   subroutine take_worker(handle, numbers, worker, error)
      !> The case, built
      type(handle_t), intent(inout) :: handle
      !> Numbers at the addresses for which it was built, shape (m)
      real(wp), intent(in) :: numbers(:)
      type(worker_t), allocatable, intent(out) :: worker
      !> Error of code `error_input` of the numbers, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      if (allocated(handle%worker)) then
         call move_alloc(handle%worker, worker)
         call worker%problem%surroundings%learn_from(handle%sweep%problem%surroundings)
      else
         allocate (worker)
      end if
      associate (axes => handle%sweep%grid%axes)
         call put_numbers(handle%sweep, &
            [(numbers(place_among(handle, axes(i)%address)), i=1, size(axes))], worker, error)
      end associate
   end subroutine take_worker

   !> Give back what `take_worker` has taken, for the next impact
   subroutine give_back(handle, worker, build)
      type(handle_t), intent(inout) :: handle
      !> On return unallocated, if it is kept
      type(worker_t), allocatable, intent(inout) :: worker
      !> Number of the build that it is of
      integer, intent(in) :: build

      call handle%sweep%problem%surroundings%learn_from(worker%problem%surroundings)
      ! another call may have built something else. A mesh that has been settled must not be lost
      ! with the settings of one point
      if (build == handle%builds .and. .not. allocated(handle%solver)) &
         call move_alloc(worker, handle%worker)
   end subroutine give_back

   !> Find a material of a case
   subroutine find_item(self, name, case, item, error)
      type(c_ptr), intent(in) :: self
      !> Name of the material
      type(c_ptr), intent(in) :: name
      !> The case, checked
      type(case_t), intent(out) :: case
      !> Index of the material
      integer, intent(out) :: item
      type(error_t), allocatable, intent(out) :: error

      type(handle_t), pointer :: handle

      item = 0
      call open_case(self, handle, error)
      call demand(name, 'material', error)
      if (allocated(error)) return
!$omp critical (vcor_c_api)
      call find_name(handle, fortran(name), item, error)
      if (.not. allocated(error)) call checked(handle, case, error)
!$omp end critical (vcor_c_api)
   end subroutine find_item

   !> Find the index of a material
   subroutine find_name(handle, name, item, error)
      type(handle_t), intent(in) :: handle
      character(len=*), intent(in) :: name
      !> Index of the material, 0 if there is none
      integer, intent(out) :: item
      type(error_t), allocatable, intent(out) :: error

      item = handle%case%find_material(name)
      if (item == 0) call raise(error, error_usage, "there is no material '"//shortened(name) &
         //"'; "//suggestion(canonical_name(name), material_names(handle%case)))
   end subroutine find_name

   !> A case with its data, checked
   subroutine checked(handle, case, error)
      type(handle_t), intent(inout) :: handle
      type(case_t), intent(out) :: case
      type(error_t), allocatable, intent(out) :: error

      call follow(handle)
      case = handle%case
      call check(case, error)
   end subroutine checked

   !> Get a material of a case
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
      call find_name(handle, fortran(name), item, error)
      if (allocated(handle%body) .and. handle%body_item /= item) deallocate (handle%body)
      if (.not. allocated(error) .and. .not. allocated(handle%body)) then
         call checked(handle, case, error)
         if (.not. allocated(error)) call material_of_case(case, item, handle%body, error)
         if (allocated(error) .and. allocated(handle%body)) deallocate (handle%body)
         handle%body_item = item
      end if
      if (.not. allocated(error)) allocate (material, source=handle%body)
!$omp end critical (vcor_c_api)
   end subroutine find_body

end module vcor_c_api_handle
