!> Implausible numbers of a case, which are probably in another unit
module vcor_case_plausibility
   use vcor_case_case, only : address_t, case_t, entry_t
   use vcor_case_catalogue, only : catalogue, find_group, first_row, groups, key_row, last_row, &
      list_key, real_key, row_for_model
   use vcor_case_grid, only : grid_t
   use vcor_kinds, only : wp
   use vcor_number, only : real_text
   implicit none
   private

   public :: implausible_numbers, note_length

   !> Length of the longest note
   integer, parameter :: note_length = 400

   !> Limits of plausible values
   type :: limits_t
      !> Group
      character(len=8) :: group
      !> Key; blank: all keys with the unit
      character(len=22) :: key
      !> Unit as in the catalogue
      character(len=6) :: unit
      !> Smallest plausible value, in this unit
      real(wp) :: least
      !> Largest plausible value
      real(wp) :: most
      !> Probable mistake for a smaller value
      character(len=44) :: below
      !> Probable mistake for a larger value
      character(len=44) :: above
   end type limits_t

   !> No limit
   real(wp), parameter :: endless = huge(1.0_wp)
   !> Question about a temperature
   character(len=*), parameter :: celsius = 'is it in degrees Celsius?'
   !> Moduli from those of gels to that of diamond; densities from those of foams to that of osmium;
   !> times from the period of atomic vibrations
   type(limits_t), parameter :: limits(*) = [ &
      limits_t('impact', 'temperature', 'K', 100.0_wp, endless, celsius, ''), &
      limits_t('impact', 'drop_height', 'm', -endless, 30.0_wp, '', 'is it in cm or mm?'), &
      limits_t('sphere', 'radius', 'm', -endless, 1.0_wp, '', 'is it in mm?'), &
      limits_t('material', 'reference_temperature', 'K', 100.0_wp, endless, celsius, ''), &
      limits_t('material', 'valid_temperature_from', 'K', 100.0_wp, endless, celsius, ''), &
      limits_t('material', '', 'Pa', 1.0e3_wp, 2.0e12_wp, 'is it in kPa, MPa or GPa?', &
      'has it a power of ten too many?'), &
      limits_t('material', '', 'kg/m3', 10.0_wp, 3.0e4_wp, 'is it in g/cm3?', 'is it in g/m3?'), &
      limits_t('material', 'poisson_ratio', '', 0.0_wp, 0.5_wp, 'is the sign right?', ''), &
      limits_t('material', '', 's', 1.0e-13_wp, endless, 'is it a rate, or in another unit?', ''), &
      limits_t('material', '', '1/s', -endless, 1.0e13_wp, '', &
      'is it a time, or in another unit?'), &
      limits_t('material', '', 's^-1/2', -endless, 1.0e13_wp**0.5_wp, '', 'is it in another unit?')]

contains

   !> Notes about implausible numbers of a case
   subroutine implausible_numbers(case, grid, notes)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Grid of the sweep
      type(grid_t), intent(in) :: grid
      !> One line each: place, key and value, and probable mistake
      character(len=note_length), allocatable, intent(out) :: notes(:)

      real(wp), allocatable :: values(:)
      character(len=:), allocatable :: model, place
      type(address_t) :: address
      type(entry_t) :: entry
      integer :: axis, group, i, item, row

      allocate (notes(0))
      do i = 1, size(limits)
         group = find_group(limits(i)%group)
         do item = 1, case%count(groups(group)%name)
            model = case%model(group, item)
            do row = first_row(group), last_row(group)
               if (.not. is_limited(limits(i), model, row)) cycle
               address = address_t(group, item, row)
               entry = case%entry(address)
               values = entry%list
               if (catalogue(row)%value_kind == real_key) values = [entry%number]
               if (.not. entry%present) values = [real(wp) ::]
               place = case%location(address)
               do axis = 1, size(grid%axes)
                  if (grid%axes(axis)%address%row /= row &
                      .or. grid%axes(axis)%address%item /= item) cycle
                  values = grid%axes(axis)%values
                  place = case%location('sweep', 'parameter', axis)
               end do
               if (size(values) > 0) call judge(limits(i), case%path(address))
            end do
         end do
      end do

   contains

      !> Check the values of one key
      subroutine judge(limit, name)
         type(limits_t), intent(in) :: limit
         !> Path of the key
         character(len=*), intent(in) :: name

         character(len=note_length) :: note
         character(len=:), allocatable :: unit
         real(wp) :: low, high

         high = maxval(values)
         low = minval(values)
         ! for the terms of a series, the largest one counts
         if (limit%unit == 'Pa') low = high
         note = ''
         unit = ''
         if (limit%unit /= '') unit = ' '//trim(limit%unit)
         if (low < limit%least .and. catalogue(row)%name /= 'equilibrium_modulus') then
            note = real_text(low)//unit//' is less than '//real_text(limit%least) &
               //': '//limit%below
         else if (high > limit%most) then
            note = real_text(high)//unit//' is more than '//real_text(limit%most) &
               //': '//limit%above
         end if
         if (note == '') return
         note = place//': '//name//' = '//note
         notes = [notes, note]
      end subroutine judge
   end subroutine implausible_numbers

   !> Whether limits apply to a key
   pure function is_limited(limit, model, row) result(yes)
      type(limits_t), intent(in) :: limit
      !> Model of the material
      character(len=*), intent(in) :: model
      !> Row of the catalogue
      integer, intent(in) :: row
      logical :: yes

      integer :: own

      own = 0
      associate (key => catalogue(row))
         yes = key_row(row) == row .and. any(key%value_kind == [real_key, list_key]) &
            .and. (limit%key == '' .or. limit%key == key%name)
         if (yes) own = row_for_model(row, model)
      end associate
      if (own > 0) yes = catalogue(own)%unit == limit%unit
      yes = yes .and. own > 0
   end function is_limited

end module vcor_case_plausibility
