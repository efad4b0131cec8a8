!> What the data behind the materials of a case do not say about its impacts
!>
!> There are three kinds of data: the band of times of a fit (`valid_from`, `valid_to`), a table of
!> moduli, and the temperatures of a shift (`valid_temperature_from`, `valid_temperature_to`). All
!> interfaces ask here, and print or hand on the same lines.
module vcor_io_coverage
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_address, only : swept_addresses
   use vcor_case_body, only : material_of_case
   use vcor_case_case, only : case_t
   use vcor_case_entries, only : address_t, operator(==)
   use vcor_case_grid, only : coordinates, grid_t
   use vcor_case_identified, only : find_reliance, reliance_t
   use vcor_error, only : error_t
   use vcor_io_data_file, only : data_file
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   use vcor_number, only : real_text
   use vcor_rounded, only : percent, short, significant
   use vcor_text, only : integer_text, printable
   use vcor_words, only : joined
   implicit none
   private

   public :: outcomes_t, find_remarks, has_data, beyond_table, remark_length

   !> Longest remark; names and paths in it may be long
   integer, parameter :: remark_length = 2048
   !> Share of the contact time from which on times matter; docs/materials.md has the errors
   real(wp), parameter :: seen_from = 0.001_wp

   !> What the remarks need of the points of a grid, each of shape (points)
   type :: outcomes_t
      !> Whether the bodies separated; the other components mean something there only
      logical, allocatable :: known(:)
      !> Contact time [s]
      real(wp), allocatable :: contact_time(:)
      !> Coefficient of restitution [-]
      real(wp), allocatable :: cor(:)
   end type outcomes_t

contains

   !> Find what the data do not say about the impacts of a grid. For a fit the impacts with the
   !> shortest and the longest contact are examined, which are affected first
   subroutine find_remarks(case, grid, outcomes, with_tables, remarks)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Grid of its points
      type(grid_t), intent(in) :: grid
      type(outcomes_t), intent(in) :: outcomes
      !> Whether to include tables of moduli
      logical, intent(in) :: with_tables
      !> One line each, with the name of the case; none if the data say all that matters
      character(len=remark_length), allocatable, intent(out) :: remarks(:)

      character(len=:), allocatable :: name
      integer :: items(3), i

      allocate (remarks(0))
      items = [case%material_of('sphere'), case%material_of('plate'), case%material_of('target')]
      do i = 1, size(items)
         if (items(i) == 0 .or. any(items(:i - 1) == items(i))) cycle
         call case%get('material', 'name', name, items(i))
         name = "'"//printable(name)//"'"
         call add(beyond_band(case, grid, outcomes, items(i), name))
         if (with_tables) call add(beyond_own_table(case, outcomes, items(i), name))
         call add(beyond_temperatures(case, grid, items(i), name))
      end do

   contains

      !> Add a remark, if it says anything
      subroutine add(words)
         character(len=*), intent(in) :: words

         character(len=remark_length) :: remark

         if (words == '') return
         remark = case%source//': '//words
         remarks = [remarks, remark]
      end subroutine add
   end subroutine find_remarks

   !> Whether a body has a material with data of a known range
   function has_data(case)
      type(case_t), intent(in) :: case
      logical :: has_data

      character(len=*), parameter :: keys(*) = [character(len=22) :: 'valid_from', 'valid_to', &
         'valid_temperature_from', 'valid_temperature_to']
      integer :: items(3), i, j

      has_data = .false.
      items = [case%material_of('sphere'), case%material_of('plate'), case%material_of('target')]
      do i = 1, size(items)
         if (items(i) == 0) cycle
         has_data = has_data .or. data_file(case, items(i)) /= ''
         do j = 1, size(keys)
            has_data = has_data .or. case%given('material', trim(keys(j)), items(i))
         end do
      end do
   end function has_data

   !> Remark on impacts that rely on a material beyond the data of its fit
   function beyond_band(case, grid, outcomes, item, name) result(text)
      type(case_t), intent(in) :: case
      type(grid_t), intent(in) :: grid
      type(outcomes_t), intent(in) :: outcomes
      !> Index of the material
      integer, intent(in) :: item
      !> Its name in quotes
      character(len=*), intent(in) :: name
      !> In words; empty if none relies on it
      character(len=:), allocatable :: text

      type(reliance_t) :: reliance, worst
      character(len=:), allocatable :: place
      integer :: points(2), i, worst_point

      text = ''
      if (.not. (case%given('material', 'valid_from', item) &
         .or. case%given('material', 'valid_to', item))) return
      if (.not. any(outcomes%known)) return
      points = [minloc(outcomes%contact_time, dim=1, mask=outcomes%known), &
         maxloc(outcomes%contact_time, dim=1, mask=outcomes%known)]
      worst_point = 0
      do i = 1, merge(1, 2, points(1) == points(2))
         associate (time => outcomes%contact_time(points(i)))
            call find_reliance(reliance, grid%case_at(case, points(i)), item, time)
            ! an effect that cannot be computed is no reason to be silent
            if (.not. reliance%compared) reliance%relies = &
               reliance%ends(1) .and. reliance%band(1) > seen_from*time &
               .or. reliance%ends(2) .and. reliance%band(2) < time
         end associate
         if (.not. reliance%relies) cycle
         if (worst_point > 0 .and. reliance%change <= worst%change) cycle
         worst = reliance
         worst_point = points(i)
      end do
      if (worst_point == 0) return
      place = ''
      if (size(grid%axes) > 0) place = ' (at '//coordinates(grid, worst_point)//')'
      associate (time => outcomes%contact_time(worst_point), cor => outcomes%cor(worst_point))
         text = 'the contact lasts '//short(time)//' s'//place//', and ' &
            //share_outside(worst%band, worst%ends, time)//' the data of '//name//' ('
         if (worst%ends(1)) text = text//'valid_from '//short(worst%band(1))//' s'
         if (all(worst%ends)) text = text//', '
         if (worst%ends(2)) text = text//'valid_to '//short(worst%band(2))//' s'
         text = text//'): '
         if (.not. worst%compared) then
            text = text//'how much depends on the extrapolation of the fit is not known'
         else if (worst%solved) then
            text = text//'with the modulus held constant there cor changes by ' &
               //short(worst%held - worst%cor)//', from '//significant(cor, 5, 0)//' to ' &
               //significant(cor + worst%held - worst%cor, 5, 0) &
               //': that much depends on the extrapolation of the fit'
         else
            text = text//'with the modulus held constant there it has no result'
         end if
      end associate
   end function beyond_band

   !> Remark on contacts that the data of a table do not cover. Data that a swept temperature shifts
   !> are left out
   function beyond_own_table(case, outcomes, item, name) result(text)
      type(case_t), intent(in) :: case
      type(outcomes_t), intent(in) :: outcomes
      !> Index of the material
      integer, intent(in) :: item
      !> Its name in quotes
      character(len=*), intent(in) :: name
      !> In words; empty if they cover all
      character(len=:), allocatable :: text

      text = ''
      if (case%given('material', 'shift', item) .and. any(swept_addresses(case) &
         == case%address('impact', 'temperature'))) return
      text = beyond_table(case, item, name, pack(outcomes%contact_time, outcomes%known))
   end function beyond_own_table

   !> Message about contacts that the data of a table do not cover
   function beyond_table(case, item, owner, contacts) result(text)
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      !> Owner of the data, in words
      character(len=*), intent(in) :: owner
      !> Contact times [s]
      real(wp), intent(in) :: contacts(:)
      !> In words; empty if they do, or if the material is not a table
      character(len=:), allocatable :: text

      character(len=*), parameter :: constant = ', where the modulus is taken as constant', &
         fitted = ', where the modulus is that of exponentials fitted to the data'
      class(material_t), allocatable :: material
      type(error_t), allocatable :: error
      character(len=:), allocatable :: before, after, waves, method, early
      real(wp), allocatable :: times(:)
      integer :: unseen

      text = ''
      if (data_file(case, item) == '' .or. size(contacts) == 0) return
      call material_of_case(case, item, material, error)
      if (allocated(error)) return
      call case%get('material', 'times', times, item)
      times = times*material%time_factor
      before = ''
      after = ''
      ! a response by frequencies needs the modulus as a sum of exponentials, which goes on rising
      call case%get('plate', 'waves', waves)
      call case%get('solver', 'method', method)
      early = constant
      if (waves == 'body' .or. method == 'coupled') early = fitted
      associate (first => times(1), last => times(size(times)), shortest => minval(contacts), &
                 longest => maxval(contacts), some => size(contacts) > 1)
         unseen = count(contacts <= first)
         if (first > seen_from*shortest) before = 'begin at '//short(first)//' s: ' &
            //percent(min(1.0_wp, first/shortest), 'all')//' of the ' &
            //trim(merge('shortest contact', 'contact         ', some))//' lies before'//early
         if (some .and. unseen > 0) before = 'begin at '//short(first)//' s: ' &
            //integer_text(unseen)//' of '//integer_text(size(contacts)) &
            //' contacts lie entirely before'//early
         if (last < longest) after = 'end at '//short(last)//' s: ' &
            //percent(1.0_wp - last/longest)//' of the ' &
            //trim(merge('longest contact', 'contact        ', some))//' lies after'//constant
      end associate
      if (before//after /= '') text = 'the data of '//owner//' ('//data_file(case, item)//') ' &
         //joined(before, after)
   end function beyond_table

   !> Remark on temperatures beyond the data of the shift of a material
   function beyond_temperatures(case, grid, item, name) result(text)
      type(case_t), intent(in) :: case
      type(grid_t), intent(in) :: grid
      !> Index of the material
      integer, intent(in) :: item
      !> Its name in quotes
      character(len=*), intent(in) :: name
      !> In words; empty if all are within
      character(len=:), allocatable :: text

      character(len=*), parameter :: keys(2) = [character(len=22) :: 'valid_temperature_from', &
         'valid_temperature_to']
      ! data of one temperature scatter by as much
      real(wp), parameter :: same = 1.0_wp
      type(address_t) :: address
      character(len=:), allocatable :: lead, band
      real(wp), allocatable :: temperatures(:)
      real(wp) :: given, ends(2)
      integer :: i, outside

      text = ''
      address = case%address('impact', 'temperature')
      given = case%number(address)
      temperatures = pack([given], [.not. ieee_is_nan(given)])
      do i = 1, size(grid%axes)
         if (grid%axes(i)%address == address) temperatures = grid%axes(i)%values
      end do
      ! points of other programs may have any numbers
      temperatures = pack(temperatures, .not. ieee_is_nan(temperatures))
      band = ''
      ends = [-huge(given), huge(given)]
      do i = 1, size(keys)
         if (.not. case%given('material', trim(keys(i)), item)) cycle
         call case%get('material', trim(keys(i)), ends(i), item)
         if (band /= '') band = band//', '
         band = band//trim(keys(i))//' '//kelvin(ends(i))
      end do
      outside = count(temperatures < ends(1) - same .or. temperatures > ends(2) + same)
      if (outside == 0) return
      lead = 'the temperature, '//kelvin(temperatures(1))//', lies'
      if (size(temperatures) > 1) lead = integer_text(outside)//' of ' &
         //integer_text(size(temperatures))//' temperatures lie'
      text = lead//' outside of the data behind the shift of '//name//' ('//band//')'
   end function beyond_temperatures

   !> A temperature in K and in degrees Celsius
   function kelvin(temperature) result(text)
      !> [K]
      real(wp), intent(in) :: temperature
      character(len=:), allocatable :: text

      text = real_text(temperature)//' K = ' &
         //real_text(anint(100.0_wp*temperature - 27315.0_wp)/100.0_wp)//' C'
   end function kelvin

   !> Share of a contact outside of a band of times; all of it if no time lag within it is known
   pure function share_outside(band, ends, contact_time) result(text)
      !> First and last time of the data [s]
      real(wp), intent(in) :: band(2)
      !> Whether the band has a start, and an end
      logical, intent(in) :: ends(2)
      !> Contact time [s]
      real(wp), intent(in) :: contact_time
      !> In words, such as `5.0 % of it lies before`
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

end module vcor_io_coverage
