!> The materials of a case
module vcor_case_body
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group, first_row, key_row, last_row, list_key
   use vcor_case_cause, only : explain
   use vcor_case_entries, only : address_t, entry_t
   use vcor_case_inputs, only : put_list
   use vcor_case_reading, only : reading_t
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material, parameters_of
   use vcor_material_shift, only : shift_keys, shift_parameters
   use vcor_material_type, only : density, parameter_t
   implicit none
   private

   public :: read_material, material_of_case, time_factors_of_case

   !> Reason why the shift of a material is not read
   character(len=*), parameter :: without_temperature = &
      'without impact.temperature the material is at its reference temperature'

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

      type(material_data_t) :: data
      type(reading_t) :: reading

      call reading%start(case)
      call read_material(case, item, reading, data)
      call new_material(material, data, error)
      if (.not. allocated(error)) return
      error%item = item
      call explain(case, error)
   end subroutine material_of_case

   !> Shift factors of a material at temperatures of the impact
   subroutine time_factors_of_case(case, item, temperatures, factors, error)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      !> Temperatures [K], > 0, shape (n)
      real(wp), intent(in) :: temperatures(:)
      !> a_T there [-], 1 for a material without a shift, shape (n)
      real(wp), intent(out) :: factors(:)
      !> Error of code `error_input` with the place of its cause, for the first temperature at which
      !> the law does not hold; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(case_t) :: there
      type(address_t) :: address
      type(material_data_t) :: data
      type(reading_t) :: reading
      real(wp) :: b
      integer :: i

      there = case
      address = there%address('impact', 'temperature')
      do i = 1, size(temperatures)
         if (i == 1) then
            ! without a temperature no shift is read
            call there%set(address, temperatures(i))
            call reading%start(there)
            call read_material(there, item, reading, data)
         else if (data%shift%law /= '') then
            data%temperature = temperatures(i)
         end if
         call data%find_factors(factors(i), b, error)
         if (.not. allocated(error)) cycle
         call there%set(address, temperatures(i))
         error%item = item
         call explain(there, error)
         return
      end do
   end subroutine time_factors_of_case

   !> Read a material. Its density is not recorded as read: the impact may have no use for it
   subroutine read_material(case, item, reading, data)
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      type(reading_t), intent(inout) :: reading
      !> The material at the temperature of the impact
      type(material_data_t), intent(out) :: data

      character(len=*), parameter :: data_keys(*) = [character(len=12) :: 'file', 'time_unit', &
         'modulus_unit']
      character(len=*), parameter :: bands(*) = [character(len=22) :: 'valid_from', 'valid_to', &
         'valid_temperature_from', 'valid_temperature_to']
      type(parameter_t), allocatable :: parameters(:)
      character(len=:), allocatable :: word
      integer :: group, i, row

      call reading%get(case, 'material', 'name', data%name, item)
      call reading%get(case, 'material', 'model', data%model, item)
      call reading%get(case, 'material', 'modulus_kind', word, item)
      data%is_shear = word == 'shear'
      do i = 1, size(data_keys)
         if (data%model == 'table') &
            call reading%mark(case%address('material', trim(data_keys(i)), item))
      end do
      do i = 1, size(bands)
         call reading%mark(case%address('material', trim(bands(i)), item), warns=.true.)
      end do
      allocate (parameters, source=[density])
      ! nothing of a rigid body counts but its mass
      if (data%model == 'rigid') then
         call reading%note_unread(case%address('material', 'poisson_ratio', item), &
            'a rigid body does not deform')
      else
         parameters = [parameters, parameters_of(data%model)]
      end if
      call read_shift(case, item, reading, data)
      if (data%shift%law /= '') parameters = [parameters, shift_parameters]
      group = find_group('material')
      do row = first_row(group), last_row(group)
         if (key_row(row) == row) call read_value(address_t(group, item, row))
      end do
      call data%fit_points()

   contains

      !> Read a number or a list that the material is made from
      subroutine read_value(address)
         type(address_t), intent(in) :: address

         type(entry_t) :: entry
         real(wp) :: number
         logical :: is_parameter

         associate (key => catalogue(address%row))
            is_parameter = any(key%name == parameters%name)
            if (key%value_kind == list_key) then
               ! lists are the terms of a Prony series or the points of a table, which are not
               ! parameters
               entry = case%entry(address)
               if (size(entry%list) == 0) return
               call reading%mark(address)
               call put_list(data, trim(key%name), entry%list)
            else if (is_parameter) then
               if (key%name /= density%name) call reading%mark(address)
               number = case%number(address)
               if (.not. ieee_is_nan(number)) call data%set(key%name, number)
            end if
         end associate
      end subroutine read_value
   end subroutine read_material

   !> Read the shift of a material by its temperature; without one it has none
   subroutine read_shift(case, item, reading, data)
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      type(reading_t), intent(inout) :: reading
      type(material_data_t), intent(inout) :: data

      type(address_t) :: temperature
      character(len=:), allocatable :: law
      real(wp), allocatable :: table(:)
      integer :: i

      call case%get('material', 'shift', law, item)
      if (law == '') return
      temperature = case%address('impact', 'temperature')
      if (ieee_is_nan(reading%number(case, temperature))) then
         call reading%note_unread(case%address('material', 'shift', item), without_temperature)
         do i = 1, size(shift_keys)
            call reading%note_unread(case%address('material', trim(shift_keys(i)), item), &
               without_temperature)
         end do
         return
      end if
      data%temperature = case%number(temperature)
      data%shift%law = law
      call reading%mark(case%address('material', 'shift', item))
      call reading%get(case, 'material', 'vertical_shift', data%shift%vertical, item)
      if (law /= 'table') return
      call case%get('material', 'shift_file', table, item)
      call reading%mark(case%address('material', 'shift_file', item))
      call data%shift%set_table(table(1::2), table(2::2))
   end subroutine read_shift

end module vcor_case_body
