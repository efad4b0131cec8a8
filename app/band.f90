!> Warnings of impacts that lean on a material beyond the data that it was fitted to
module vcor_app_band
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_app_job, only : job_t
   use vcor_app_screen, only : percent, short, significant
   use vcor_case_case, only : address_t, case_t, operator(==)
   use vcor_error, only : error_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_text, only : integer_text
   use vcor_kinds, only : wp
   use vcor_case_identified, only : find_reliance, reliance_t
   use vcor_sweep_quantity, only : quantity_place
   use vcor_sweep_summary, only : summary_t
   use vcor_text, only : printable, real_text
   implicit none
   private

   public :: warn_of_bands

contains

   !> Warn on stderr of materials of the bodies that the impacts lean on beyond their data.
   !> Of a sweep the impacts of the shortest and the longest contact are looked at, in which that
   !> shows first
   subroutine warn_of_bands(job, summary)
      type(job_t), intent(in) :: job
      type(summary_t), intent(in) :: summary

      integer :: sphere, plate

      sphere = job%case%material_of('sphere')
      plate = job%case%material_of('plate')
      call warn_of_band(job, summary, sphere)
      call warn_of_temperatures(job, sphere)
      if (plate == sphere) return
      call warn_of_band(job, summary, plate)
      call warn_of_temperatures(job, plate)
   end subroutine warn_of_bands

   !> Warn of temperatures beyond the data behind the shift of a material
   subroutine warn_of_temperatures(job, item)
      type(job_t), intent(in) :: job
      integer, intent(in) :: item

      character(len=*), parameter :: keys(2) = [character(len=22) :: 'valid_temperature_from', &
         'valid_temperature_to']
      type(address_t) :: address
      character(len=:), allocatable :: name, lead, band
      real(wp), allocatable :: temperatures(:)
      real(wp) :: given, ends(2)
      integer :: i, outside

      address = job%case%address('impact', 'temperature')
      given = job%case%number(address)
      allocate (temperatures(count([.not. ieee_is_nan(given)])))
      temperatures = given
      do i = 1, size(job%sweep%grid%axes)
         if (job%sweep%grid%axes(i)%address == address) &
            temperatures = job%sweep%grid%axes(i)%values
      end do
      band = ''
      ends = [-huge(given), huge(given)]
      do i = 1, size(keys)
         if (.not. job%case%given('material', trim(keys(i)), item)) cycle
         call job%case%get('material', trim(keys(i)), ends(i), item)
         if (band /= '') band = band//', '
         band = band//trim(keys(i))//' '//real_text(ends(i))//' K'
      end do
      outside = count(temperatures < ends(1) .or. temperatures > ends(2))
      if (outside == 0) return
      call job%case%get('material', 'name', name, item)
      lead = 'the temperature, '//real_text(temperatures(1))//' K, lies'
      if (size(temperatures) > 1) lead = integer_text(outside)//' of ' &
         //integer_text(size(temperatures))//' temperatures lie'
      write (error_unit, '(a)') 'vcor: warning: '//job%case%source//': '//lead &
         //" outside of the data behind the shift of '"//printable(name)//"' ("//band//')'
   end subroutine warn_of_temperatures

   !> Warn of one material
   subroutine warn_of_band(job, summary, item)
      type(job_t), intent(in) :: job
      type(summary_t), intent(in) :: summary
      integer, intent(in) :: item

      type(reliance_t) :: reliance, worst
      type(case_t) :: case
      type(error_t), allocatable :: error
      integer :: points(2), i, k, time, worst_point, unseen
      logical, allocatable :: known(:)

      if (.not. (job%case%given('material', 'valid_from', item) &
         .or. job%case%given('material', 'valid_to', item))) return
      time = quantity_place('contact_time')
      allocate (known(size(summary%status)))
      known = summary%status == contact_separated
      if (.not. any(known)) return
      points = [minloc(summary%values(time)%reals, dim=1, mask=known), &
         maxloc(summary%values(time)%reals, dim=1, mask=known)]
      worst_point = 0
      do i = 1, merge(1, 2, points(1) == points(2))
         case = job%case
         do k = 1, size(job%sweep%grid%axes)
            associate (axis => job%sweep%grid%axes(k), place => job%sweep%grid%places(points(i)))
               call case%put(axis%address, axis%values(place(k)), error)
            end associate
            if (allocated(error)) return
         end do
         call find_reliance(reliance, case, item, summary%values(time)%reals(points(i)))
         if (.not. reliance%leans) cycle
         if (worst_point > 0) then
            if (change(reliance) <= change(worst)) cycle
         end if
         worst = reliance
         worst_point = points(i)
      end do
      unseen = 0
      if (worst_point > 0 .and. worst%ends(1)) &
         unseen = count(known .and. summary%values(time)%reals <= worst%band(1))
      if (worst_point > 0) write (error_unit, '(a)') 'vcor: warning: '//job%case%source//': ' &
         //message(worst, worst_point)

   contains

      !> Change of cor by what is held constant
      pure function change(found)
         type(reliance_t), intent(in) :: found
         !> The change, large where the other impact has no result
         real(wp) :: change

         change = huge(change)
         if (found%solved) change = abs(found%held - found%cor)
      end function change

      !> What is said
      function message(found, point) result(text)
         type(reliance_t), intent(in) :: found
         integer, intent(in) :: point
         character(len=:), allocatable :: text

         character(len=:), allocatable :: name, place, lead

         call job%case%get('material', 'name', name, item)
         place = ''
         lead = ''
         if (job%sweep%is_grid()) place = ' (at '//job%coordinates(point)//')'
         if (job%sweep%is_grid() .and. unseen > 0) lead = integer_text(unseen)//' of ' &
            //integer_text(size(known))//" contacts lie wholly before the data of '" &
            //printable(name)//"'; where cor changes most "
         associate (contact_time => summary%values(time)%reals(point), &
                    cor => summary%values(quantity_place('cor'))%reals(point))
            text = lead//'the contact lasts '//short(contact_time)//' s'//place//', and ' &
               //share_outside(found%band, found%ends, contact_time)//" the data of '" &
               //printable(name)//"' ("
            if (found%ends(1)) text = text//'valid_from '//short(found%band(1))//' s'
            if (all(found%ends)) text = text//', '
            if (found%ends(2)) text = text//'valid_to '//short(found%band(2))//' s'
            text = text//'): with the modulus held constant there '
            if (found%solved) then
               text = text//'cor changes by '//short(found%held - found%cor)//', from ' &
                  //trim(adjustl(significant(cor, 5)))//' to ' &
                  //trim(adjustl(significant(cor + found%held - found%cor, 5))) &
                  //', a lower bound of the doubt'
            else
               text = text//'it has no result'
            end if
         end associate
      end function message
   end subroutine warn_of_band

   !> How much of a contact lies outside of a band of times: all of it where no lag within it is
   !> known
   pure function share_outside(band, ends, contact_time) result(text)
      !> First and last time of the data [s]
      real(wp), intent(in) :: band(2)
      !> Whether there is such an end
      logical, intent(in) :: ends(2)
      !> Contact time [s]
      real(wp), intent(in) :: contact_time
      !> In words, as `5.0 % of it is earlier than`
      character(len=:), allocatable :: text

      real(wp) :: before, after

      before = 0.0_wp
      after = 0.0_wp
      if (ends(1)) before = min(1.0_wp, band(1)/contact_time)
      if (ends(2)) after = max(0.0_wp, 1.0_wp - band(2)/contact_time)
      text = ''
      if (before > 0.0_wp) text = percent(before, 'all')//' of it lies before'
      if (before > 0.0_wp .and. after > 0.0_wp) text = text//' and '
      if (after > 0.0_wp) text = text//percent(after, 'all')//' of it lies after'
      if (text == '') text = 'hardly any of it lies outside'
   end function share_outside

end module vcor_app_band
