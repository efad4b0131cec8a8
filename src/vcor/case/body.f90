!> A material of a case: described once, and built again when one of its numbers changes
module vcor_case_body
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_case, only : address_t, case_t, entry_t
   use vcor_case_catalogue, only : catalogue, first_row, key_row, last_row, list_key
   use vcor_case_cause, only : explain
   use vcor_case_reading, only : reading_t
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material, parameters_of
   use vcor_material_shift, only : shift_keys, shift_parameters
   use vcor_material_type, only : density, parameter_t
   implicit none
   private

   public :: body_t, describe, update_body, material_of_case

   !> Reason why the shift of a material is not read
   character(len=*), parameter :: without_temperature = &
      'without impact.temperature the material is at its reference temperature'
   !> Number of no change: a material that has not been made, or could not
   integer, parameter :: never = -1

   !> A material of the case
   type :: body_t
      !> Address of the material in the case
      type(address_t) :: address
      !> Address of its temperature; nowhere if the material has no shift
      type(address_t) :: temperature
      !> Addresses of the other numbers and lists from which it is made, shape (n)
      type(address_t), allocatable :: made_from(:)
      !> Its data
      type(material_data_t) :: data
      !> The material, allocated after it was built
      class(material_t), allocatable :: material
      !> Latest change of all these numbers when it was made
      integer :: made_at = never
   end type body_t

contains

   !> Build a material of a case
   subroutine material_of_case(case, item, material, error)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      class(material_t), allocatable, intent(out) :: material
      !> Error of code `error_input` with the place of its cause, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(body_t) :: body
      type(reading_t) :: reading

      call reading%start(case)
      call describe(body, case, item, reading)
      call update_body(body, case, reading, error)
      if (allocated(error)) then
         call explain(case, error)
      else
         call move_alloc(body%material, material)
      end if
   end subroutine material_of_case

   !> Describe a material except for its numbers
   subroutine describe(body, case, item, reading)
      !> The material, not built
      type(body_t), intent(out) :: body
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      type(reading_t), intent(inout) :: reading

      character(len=*), parameter :: data_keys(*) = [character(len=12) :: 'file', 'time_unit', &
         'modulus_unit']
      character(len=*), parameter :: bands(*) = [character(len=22) :: 'valid_from', 'valid_to', &
         'valid_temperature_from', 'valid_temperature_to']
      type(parameter_t), allocatable :: parameters(:)
      type(address_t) :: address
      type(entry_t) :: entry
      character(len=:), allocatable :: word
      integer :: i, row
      logical :: counts

      body%address = case%address('material', 'name', item)
      call reading%get(case, 'material', 'name', body%data%name, item)
      call reading%get(case, 'material', 'model', body%data%model, item)
      call reading%get(case, 'material', 'modulus_kind', word, item)
      body%data%is_shear = word == 'shear'
      do i = 1, size(data_keys)
         if (body%data%model == 'table') &
            call reading%mark(case%address('material', trim(data_keys(i)), item))
      end do
      do i = 1, size(bands)
         call reading%mark(case%address('material', trim(bands(i)), item), warns=.true.)
      end do
      allocate (parameters, source=[density])
      ! nothing of a rigid body counts but its mass
      if (body%data%model == 'rigid') then
         call reading%leave(case%address('material', 'poisson_ratio', item), &
            'a rigid body does not deform')
      else
         parameters = [parameters, parameters_of(body%data%model)]
      end if
      call describe_shift(body, case, item, reading)
      if (body%data%shift%law /= '') parameters = [parameters, shift_parameters]
      allocate (body%made_from(0))
      do row = first_row(body%address%group), last_row(body%address%group)
         if (key_row(row) /= row) cycle
         ! lists are the terms of a Prony series or the points of a table, which are not parameters
         counts = any(catalogue(row)%name == parameters%name)
         address = address_t(body%address%group, item, row)
         if (catalogue(row)%value_kind == list_key) then
            entry = case%entry(address)
            counts = size(entry%list) > 0
         end if
         if (counts) body%made_from = [body%made_from, address]
      end do
   end subroutine describe

   !> Describe the shift of a material by its temperature; without one it has none
   subroutine describe_shift(body, case, item, reading)
      type(body_t), intent(inout) :: body
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      type(reading_t), intent(inout) :: reading

      type(address_t) :: temperature
      character(len=:), allocatable :: law
      real(wp), allocatable :: table(:)
      integer :: i

      call case%get('material', 'shift', law, item)
      if (law == '') return
      temperature = case%address('impact', 'temperature')
      if (ieee_is_nan(reading%number(case, temperature))) then
         call reading%leave(case%address('material', 'shift', item), without_temperature)
         do i = 1, size(shift_keys)
            call reading%leave(case%address('material', trim(shift_keys(i)), item), &
               without_temperature)
         end do
         return
      end if
      body%temperature = temperature
      body%data%shift%law = law
      call reading%mark(case%address('material', 'shift', item))
      call reading%get(case, 'material', 'vertical_shift', body%data%shift%vertical, item)
      if (law /= 'table') return
      call case%get('material', 'shift_file', table, item)
      call reading%mark(case%address('material', 'shift_file', item))
      body%data%shift%temperatures = table(1::2)
      body%data%shift%logarithms = table(2::2)
   end subroutine describe_shift

   !> Update a material
   subroutine update_body(body, case, reading, error)
      !> The material, described
      type(body_t), intent(inout) :: body
      type(case_t), intent(in) :: case
      type(reading_t), intent(inout) :: reading
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp), allocatable :: list(:)
      real(wp) :: number
      integer :: i, latest

      latest = max(case%latest_change(body%made_from), case%latest_change([body%temperature]))
      if (body%made_at == latest) return
      body%made_at = never
      body%data%temperature = 0.0_wp
      if (body%temperature%group > 0) body%data%temperature = reading%number(case, body%temperature)
      do i = 1, size(body%made_from)
         associate (address => body%made_from(i), key => catalogue(body%made_from(i)%row))
            ! the impact may have no use for the density
            if (key%name /= density%name) call reading%mark(address)
            if (key%value_kind == list_key) then
               call case%get('material', key%name, list, address%item)
               call body%data%set_list(key%name, list)
            else
               number = case%number(address)
               if (.not. ieee_is_nan(number)) call body%data%set(key%name, number)
            end if
         end associate
      end do
      call body%data%fit_points()
      call new_material(body%material, body%data, error)
      if (allocated(error)) then
         error%item = body%address%item
      else
         body%made_at = latest
      end if
   end subroutine update_body

end module vcor_case_body
