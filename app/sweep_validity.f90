!> Messages about the validity of the points of a sweep: how many are not good by which measure, and
!> where, and what exact mechanics gives at some of them
module vcor_app_sweep_validity
   use vcor_app_validity, only : name_of_exact
   use vcor_case_case, only : case_t
   use vcor_case_grid, only : coordinates, grid_t
   use vcor_impact_outcome, only : none, outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_impact_validity, only : judged, level_caution, level_good, level_of, level_outside, &
      levels, surroundings_t, thresholds
   use vcor_kinds, only : wp
   use vcor_rounded, only : plain_number, significant
   use vcor_sweep_quantity, only : quantity_place, summary_t
   use vcor_text, only : integer_text
   use vcor_verify_models, only : has_exact_contact, model_t, solve_exact
   implicit none
   private

   public :: points_report, points_remark, exact_points

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Columns of a point that its validity depends on
   character(len=*), parameter :: measures(*) = [character(len=20) :: &
      'cor', 'cor_sphere', 'cor_error', 'cor_sphere_error', 'initial_energy', 'wave_energy', &
      'energy_loss', 'energy_imbalance', 'contact_ratio', 'needed_extent', &
      'deflection_ratio', 'weight_ratio', 'mean_pressure', 'cor_deviation', 'layer_strain', &
      'mass_ratio', 'axis_tension', 'highest_mode', 'contacts', 'block_reach']

contains

   !> Number of points of a sweep that are not good, and for each measure, not only the one that
   !> decides, how many points it concerns and where
   function points_report(grid, summary, surroundings) result(text)
      type(grid_t), intent(in) :: grid
      type(summary_t), intent(in) :: summary
      !> Surroundings of the impacts
      type(surroundings_t), intent(in) :: surroundings
      !> Lines; empty if all are good
      character(len=:), allocatable :: text

      type(surroundings_t) :: around
      real(wp), dimension(size(grid%axes), size(thresholds), level_outside) :: least, most
      real(wp) :: at(size(grid%axes)), values(size(thresholds))
      integer :: found(size(thresholds), level_outside)
      integer :: cause, decides, i, k, level, validity, columns(size(measures))
      integer :: places(size(grid%axes))

      text = points_remark(grid, summary)
      if (text == '') return
      text = '  '//text//nl
      columns = places_of_measures()
      validity = quantity_place('validity')
      decides = quantity_place('validity_cause')
      around = surroundings
      do k = 1, size(grid%axes)
         ! what varies is known only where it decides
         if (grid%axes(k)%name == 'plate.extent') around%extent = none
         if (index(grid%axes(k)%name, '.yield_strength') > 0) around%yield_strength = none
      end do
      found = 0
      least = huge(least)
      most = -huge(most)
      do i = 1, size(summary%status)
         if (summary%values(validity)%integers(i) <= level_good) cycle
         values = judged(outcome_at(summary, columns, i), around)
         places = grid%places(i)
         at = [(grid%axes(k)%values(places(k)), k=1, size(places))]
         do cause = 1, size(thresholds)
            level = level_of(cause, values(cause))
            if (summary%values(decides)%integers(i) == cause) &
               level = summary%values(validity)%integers(i)
            if (level <= level_good) cycle
            found(cause, level) = found(cause, level) + 1
            least(:, cause, level) = min(least(:, cause, level), at)
            most(:, cause, level) = max(most(:, cause, level), at)
         end do
      end do
      do level = level_outside, level_caution, -1
         do cause = 1, size(thresholds)
            if (found(cause, level) > 0) text = text//'    '//trim(levels(level))//': ' &
               //integer_text(found(cause, level))//' by '//trim(thresholds(cause)%measure)//', ' &
               //place_of(grid, least(:, cause, level), most(:, cause, level))//nl
         end do
      end do
   end function points_report

   !> Number of points of a sweep that are not good, and the measures, in one line
   function points_remark(grid, summary) result(text)
      type(grid_t), intent(in) :: grid
      type(summary_t), intent(in) :: summary
      !> In words; empty if all are good
      character(len=:), allocatable :: text

      character(len=:), allocatable :: causes
      integer :: cause, level

      text = ''
      associate (found => summary%values(quantity_place('validity'))%integers, &
                 by => summary%values(quantity_place('validity_cause'))%integers)
         do level = level_outside, level_caution, -1
            if (.not. any(found == level)) cycle
            causes = ''
            do cause = 1, size(thresholds)
               if (any(found == level .and. by == cause)) &
                  causes = causes//', '//trim(thresholds(cause)%measure)
            end do
            text = text//', '//integer_text(count(found == level))//' of ' &
               //integer_text(grid%count())//' points '//trim(levels(level))//' ('//causes(3:)//')'
         end do
      end associate
      if (text /= '') text = 'validity: '//text(3:)
   end function points_remark

   !> Restitution of the sphere with exact mechanics at the first and the last point with a result,
   !> at those of the smallest and the largest value, and at those of the largest predicted
   !> deviations, as long as that takes little time; and the largest difference that is found
   !> beside the predicted one
   function exact_points(case, grid, summary) result(text)
      type(case_t), intent(in) :: case
      type(grid_t), intent(in) :: grid
      type(summary_t), intent(in) :: summary
      !> Lines; empty if it is the same, or nothing has a result
      character(len=:), allocatable :: text

      character(len=*), parameter :: labels(9) = [character(len=8) :: 'first', 'last', 'smallest', &
         'largest', '', '', '', '', '']
      ! steps after which no other point is solved, some 0.2 s: a clock would make the screen depend
      ! on the machine. What a failure took is not known
      integer, parameter :: most_steps = 2000, steps_of_failure = most_steps/2
      type(model_t) :: exact
      logical, allocatable :: known(:)
      logical :: differs, is_shown
      integer :: points(size(labels)), i, farthest
      integer :: steps
      real(wp) :: difference, largest
      character(len=:), allocatable :: value

      text = ''
      differs = .false.
      allocate (known(size(summary%status)))
      known = summary%status == contact_separated
      if (.not. any(known)) return
      if (case%count('target') > 0 .and. has_exact_contact(case)) return
      farthest = 0
      largest = 0.0_wp
      associate (cor => summary%values(quantity_place('cor_sphere'))%reals, &
                 deviation => summary%values(quantity_place('cor_deviation'))%reals)
         points(:4) = [findloc(known, .true., dim=1), findloc(known, .true., dim=1, back=.true.), &
            minloc(cor, dim=1, mask=known), maxloc(cor, dim=1, mask=known)]
         known(points(:4)) = .false.
         do i = 5, size(points)
            points(i) = maxloc(abs(deviation), dim=1, mask=known)
            if (points(i) > 0) known(points(i)) = .false.
         end do
         steps = 0
         do i = 1, size(points)
            if (steps > most_steps) exit
            if (points(i) == 0 .or. any(points(:i - 1) == points(i))) cycle
            call solve_exact(grid%case_at(case, points(i)), outcome_at(summary, &
               places_of_measures(), points(i)), exact, is_shown)
            differs = differs .or. is_shown
            value = 'no result'
            steps = steps + merge(steps_of_failure, exact%outcome%steps, allocated(exact%failure))
            if (.not. allocated(exact%failure)) then
               value = significant(exact%outcome%cor_sphere, 5, 0)
               difference = exact%outcome%cor_sphere - cor(points(i))
               if (is_shown .and. abs(difference) > abs(largest)) then
                  largest = difference
                  farthest = points(i)
               end if
            end if
            if (labels(i) /= '') text = text//'    '//trim(labels(i))//', ' &
               //coordinates(grid, points(i))//': '//significant(cor(points(i)), 5, 0) &
               //', exact '//value//nl
         end do
         if (farthest > 0) text = text//'    largest difference found ' &
            //significant(largest, 3, 0)//', predicted '//significant(deviation(farthest), 3, 0) &
            //', '//coordinates(grid, farthest)//nl
      end associate
      if (differs) text = '  cor_sphere with '//name_of_exact(case)//nl//text
      if (.not. differs) text = ''
   end function exact_points

   !> Places of the columns of `outcome_at`; finding them for each point would take longer than all
   !> the rest
   function places_of_measures() result(places)
      integer :: places(size(measures))

      integer :: i

      places = [(quantity_place(trim(measures(i))), i=1, size(measures))]
   end function places_of_measures

   !> The columns of a point that its validity depends on
   pure function outcome_at(summary, places, point) result(outcome)
      type(summary_t), intent(in) :: summary
      !> From `places_of_measures`
      integer, intent(in) :: places(:)
      integer, intent(in) :: point
      type(outcome_t) :: outcome

      outcome%status = summary%status(point)
      outcome%cor = summary%values(places(1))%reals(point)
      outcome%cor_sphere = summary%values(places(2))%reals(point)
      outcome%cor_error = summary%values(places(3))%reals(point)
      outcome%cor_sphere_error = summary%values(places(4))%reals(point)
      outcome%initial_energy = summary%values(places(5))%reals(point)
      outcome%wave_energy = summary%values(places(6))%reals(point)
      outcome%energy_loss = summary%values(places(7))%reals(point)
      outcome%energy_imbalance = summary%values(places(8))%reals(point)
      outcome%contact_ratio = summary%values(places(9))%reals(point)
      outcome%needed_extent = summary%values(places(10))%reals(point)
      outcome%deflection_ratio = summary%values(places(11))%reals(point)
      outcome%weight_ratio = summary%values(places(12))%reals(point)
      outcome%mean_pressure = summary%values(places(13))%reals(point)
      outcome%cor_deviation = summary%values(places(14))%reals(point)
      outcome%layer_strain = summary%values(places(15))%reals(point)
      outcome%mass_ratio = summary%values(places(16))%reals(point)
      outcome%axis_tension = summary%values(places(17))%reals(point)
      outcome%highest_mode = summary%values(places(18))%reals(point)
      outcome%contacts = summary%values(places(19))%integers(point)
      outcome%block_reach = summary%values(places(20))%reals(point)
   end function outcome_at

   !> Ranges of the parameters of some points
   function place_of(grid, least, most) result(text)
      type(grid_t), intent(in) :: grid
      !> Smallest and largest values of the parameters, shape (axes)
      real(wp), intent(in) :: least(:), most(:)
      !> Names and ranges
      character(len=:), allocatable :: text

      integer :: k

      text = ''
      do k = 1, size(least)
         text = text//', '//grid%axes(k)%name//' '//plain_number(least(k), 5)
         if (most(k) > least(k)) text = text//' .. '//plain_number(most(k), 5)
      end do
      text = text(3:)
   end function place_of

end module vcor_app_sweep_validity
