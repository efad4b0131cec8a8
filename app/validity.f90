!> Messages about the validity of results: the measures that are not good, one sentence each, and
!> the number of points of a sweep with each; impacts that rely on a material beyond the data of its
!> fit; and implausible input
module vcor_app_validity
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_rounded, only : percent, plain_number, short, significant
   use vcor_case_address, only : swept_addresses
   use vcor_case_case, only : case_t, operator(==)
   use vcor_case_grid, only : coordinates, grid_t
   use vcor_case_checks, only : implausible_numbers, note_length
   use vcor_case_reading, only : reading_t
   use vcor_impact_outcome, only : none, outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_impact_validity, only : judged, level_caution, level_good, level_of, level_outside, &
      levels, surroundings_t, thresholds
   use vcor_io_coverage, only : find_remarks, outcomes_t, remark_length
   use vcor_kinds, only : pi, wp
   use vcor_sweep_points, only : sweep_t
   use vcor_sweep_quantity, only : quantity_place, quantity_value, summary_t
   use vcor_number, only : real_text
   use vcor_text, only : integer_text, printable
   use vcor_verify_models, only : has_exact_contact, model_t, solve_exact
   implicit none
   private

   public :: mechanics_of, name_of_exact, measures_report, measures_remark, points_report, &
      points_remark, exact_points, about_numbers, warn_of_input, warn_of_data

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Columns of a point that its validity depends on
   character(len=*), parameter :: measures(*) = [character(len=20) :: &
      'cor', 'cor_sphere', 'cor_error', 'cor_sphere_error', 'initial_energy', 'wave_energy', &
      'energy_loss', 'energy_imbalance', 'contact_ratio', 'needed_extent', &
      'deflection_ratio', 'weight_ratio', 'mean_pressure', 'cor_deviation', 'layer_strain', &
      'mass_ratio', 'axis_tension', 'highest_mode', 'contacts', 'block_reach']

contains

   !> Warn on stderr of implausible numbers, and note which values are taken because none is given:
   !> the mass of one of two spheres, the temperature of a material with a shift
   subroutine warn_of_input(case, sweep)
      type(case_t), intent(in) :: case
      !> Its impacts
      type(sweep_t), intent(in) :: sweep

      character(len=note_length), allocatable :: notes(:)
      character(len=:), allocatable :: name, mechanics
      real(wp) :: temperature
      integer :: i

      call implausible_numbers(case, sweep%grid, notes)
      do i = 1, size(notes)
         write (error_unit, '(a)') 'vcor: warning: '//trim(notes(i))
      end do
      if (sweep%problem%surroundings%is_sphere .and. .not. any(swept_addresses(case) &
         == case%address('sphere', 'mass')) .and. .not. case%given('sphere', 'mass')) &
         write (error_unit, '(a)') 'vcor: note: '//case%location('plate', 'surface_radius') &
         //': the second body is a sphere, and mass is not given: the mass is that of &sphere ' &
         //'alone, '//short(sweep%problem%impact%mass)//' kg, as if the second one could not ' &
         //'move; two free spheres need their reduced mass, m1 m2/(m1 + m2)'
      call case%get('contact', 'mechanics', mechanics)
      if (mechanics == 'exact' .and. case%count('target') > 0 &
          .and. .not. case%given('plate', 'waves')) then
         write (error_unit, '(a)') 'vcor: note: '//case%location('contact', 'mechanics') &
            //": the surface moves with the structure: mechanics = 'exact' leaves plate.waves " &
            //"= 'none'"
      else if (mechanics == 'exact' .and. case%has_second_sphere() &
               .and. .not. case%given('plate', 'waves')) then
         write (error_unit, '(a)') 'vcor: note: '//case%location('contact', 'mechanics') &
            //": two spheres are no half space: mechanics = 'exact' leaves plate.waves = 'none'"
      end if
      if (case%given('impact', 'temperature') .or. any(swept_addresses(case) &
         == case%address('impact', 'temperature'))) return
      do i = 1, case%count('material')
         if (.not. case%given('material', 'shift', i)) cycle
         call case%get('material', 'name', name, i)
         call case%get('material', 'reference_temperature', temperature, i)
         write (error_unit, '(a)') 'vcor: note: '//case%location('material', 'shift', i) &
            //": '"//printable(name)//"' is at its reference temperature, " &
            //real_text(temperature)//' K: there is no impact.temperature'
      end do
   end subroutine warn_of_input

   !> Mechanics of a case, as far as the impact reads them
   function mechanics_of(case, reading, exact) result(text)
      type(case_t), intent(in) :: case
      type(reading_t), intent(in) :: reading
      !> Other mechanics to name instead
      type(model_t), intent(in), optional :: exact
      !> Such as `waves relaxing, law boltzmann`
      character(len=:), allocatable :: text

      character(len=*), parameter :: groups(4) = [character(len=7) :: 'plate', 'contact', &
         'contact', 'plate']
      character(len=*), parameter :: keys(4) = [character(len=5) :: 'waves', 'law', 'pair', 'base']
      character(len=:), allocatable :: word
      integer :: i

      text = ''
      do i = 1, size(keys)
         if (.not. reading%has(case%address(trim(groups(i)), trim(keys(i))))) cycle
         call case%get(trim(groups(i)), trim(keys(i)), word)
         if (word == 'free') cycle
         ! the surface moves with the structure
         if (keys(i) == 'waves' .and. case%count('target') > 0) then
            text = text//', '//structure_text(case)
            if (word == 'none') cycle
         end if
         if (present(exact) .and. keys(i) /= 'base') then
            word = trim(exact%law)
            if (i == 1) word = trim(exact%waves)
            if (i == 3) word = trim(exact%pair)
         end if
         text = text//', '//trim(keys(i))//' '//word
      end do
      text = text(3:)
      ! a base that is forgotten
      if (present(exact) .or. .not. reading%has(case%address('plate', 'base')) &
          .or. case%count('target') > 0) return
      call case%get('plate', 'base', word)
      if (word == 'free' .and. (case%given('plate', 'thickness') &
         .or. case%given('plate', 'half_thickness'))) text = text//', free on both sides'
   end function mechanics_of

   !> The structure of a case in words
   function structure_text(case) result(text)
      type(case_t), intent(in) :: case
      !> Such as `target beam cantilever`
      character(len=:), allocatable :: text

      character(len=:), allocatable :: word

      call case%get('target', 'body', word)
      text = 'target '//word
      call case%get('target', 'support', word)
      if (word /= '') text = text//' '//word
   end function structure_text

   !> Name of what `solve_exact` solves: with a plate or a beam only the contact is exact
   function name_of_exact(case) result(name)
      type(case_t), intent(in) :: case
      !> `exact mechanics` or `receding contact`
      character(len=:), allocatable :: name

      character(len=:), allocatable :: body

      name = 'exact mechanics'
      if (case%count('target') == 0) return
      call case%get('target', 'body', body)
      if (body == 'plate' .or. body == 'beam') name = 'receding contact'
   end function name_of_exact

   !> The level of an impact, a line for each measure that is not good, and one line for the good
   !> ones
   function measures_report(outcome, surroundings, exact) result(text)
      type(outcome_t), intent(in) :: outcome
      !> Surroundings of the impact
      type(surroundings_t), intent(in) :: surroundings
      !> Outcome with exact mechanics, if that differs and there is one
      type(outcome_t), intent(in), optional :: exact
      !> Lines; the first has the level
      character(len=:), allocatable :: text

      real(wp) :: values(size(thresholds))
      character(len=:), allocatable :: good
      integer :: i, level

      text = '  validity: '//trim(levels(outcome%validity))//nl
      values = judged(outcome, surroundings)
      good = ''
      do i = 1, size(thresholds)
         if (level_of(i, values(i)) == level_good) good = good//', ' &
            //measure_text(outcome, i, values(i))
      end do
      do level = level_outside, level_caution, -1
         do i = 1, size(thresholds)
            if (level_of(i, values(i)) == level) text = text//'    '//trim(levels(level))//': ' &
               //measure_text(outcome, i, values(i))//': '//sentence(i)//nl
         end do
      end do
      if (good /= '') text = text//'    good: '//good(3:)//nl

   contains

      !> Meaning of a measure for this impact, and advice
      function sentence(measure) result(words)
         !> Index of the measure in `thresholds`
         integer, intent(in) :: measure
         character(len=:), allocatable :: words

         associate (value => values(measure))
            select case (thresholds(measure)%measure)
            case ('contact_ratio')
               if (value > outcome%contact_ratio) then
                  words = 'the sphere is not a half space: its indentation is about ' &
                     //percent(0.5_wp*outcome%sphere_ratio) &
                     //' too large; a slower impact makes a smaller contact'
                  return
               end if
               ! first term of Sneddon's force over Hertz's
               words = "Hertz' force is about "//percent(0.1_wp*value**2) &
                  //" too high; compare shape = 'true_sphere', or take a slower impact"
            case ('layer_strain')
               words = 'the indentation is '//percent(value)//' of the thickness, deep for small ' &
                  //'strains: the force is too small; take a slower impact or a thicker layer'
            case ('needed_extent')
               words = 'waves return from the edge at plate.extent = ' &
                  //brief(surroundings%extent)//' m; good from '//brief(surroundings%extent*value &
                  /thresholds(measure)%caution)//' m on'
            case ('deflection_ratio')
               words = 'the plate bends by '//percent(value) &
                  //' of its thickness, too far for linear bending; take a thicker plate'
            case ('weight_ratio')
               words = 'the weight is '//percent(value) &
                  //' of the largest force, and left out: give impact.gravity, 0 on a pendulum'
            case ('highest_mode')
               words = 'the modes end '//trim(merge('below     ', 'just above', &
                  outcome%highest_mode < 1.0_wp))//' the frequency of the contact, pi/t0: give ' &
                  //'more of them, or target.residual_compliance'
            case ('block_reach')
               words = 'the block is lighter than the half space that its waves fill, ' &
                  //percent(value)//" of its size: compare waves = 'none', or give the modes of " &
                  //'the body'
            case ('contacts')
               words = 'the structure strikes the sphere again: damping and phase decide; a ' &
                  //'velocity that differs by a per cent may give another number'
            case ('mean_pressure')
               words = brief(value)//' times the yield strength (first yield: 1.07), cor is ' &
                  //'too high; take a slower impact'
            case ('axis_tension')
               words = 'around the axis the contact pulls with '//percent(value)//' of its mean ' &
                  //'pressure, where a real one opens; take a slower or a smaller body'
            case ('energy_loss')
               words = gain()
            case ('mass_ratio')
               words = 'hollow, or mass in grams? Of a shell that bends this is no model; a ' &
                  //'pendulum is heavier than its ball'
            case default
               words = 'exact mechanics is predicted to give cor_sphere ' &
                  //brief(max(outcome%cor_sphere + outcome%cor_deviation, 0.0_wp))
               if (present(exact)) then
                  words = words//', and gives '//brief(exact%cor_sphere)
               else
                  words = words//"; compare mechanics = 'exact'"
               end if
               if (surroundings%is_panel) words = 'without thin-plate theory cor_sphere is ' &
                  //'predicted to be '//brief(max(outcome%cor_sphere + outcome%cor_deviation, &
                  0.0_wp))
            end select
         end associate
      end function sentence

      !> Where the energy comes from that the sphere, or both bodies, have gained
      function gain() result(words)
         character(len=:), allocatable :: words

         if (outcome%cor_sphere > 1.0_wp .and. outcome%energy_loss >= 0.0_wp) then
            words = 'the sphere leaves faster than it came: its weight did more work than the ' &
               //'contact dissipated'
         else if (outcome%cor_sphere <= 1.0_wp .and. outcome%energy_loss >= 0.0_wp) then
            words = 'the bodies separate faster than they met, because the plate still moves; ' &
               //"compare waves = 'body'"
         else
            words = 'the sphere gains energy, which no plate supplies: this model of the ' &
               //"plate does not hold; compare waves = 'body'"
         end if
      end function gain
   end function measures_report

   !> The level of an impact that is not good, and the measures, in one line
   function measures_remark(outcome, surroundings) result(text)
      type(outcome_t), intent(in) :: outcome
      !> Surroundings of the impact
      type(surroundings_t), intent(in) :: surroundings
      !> In words; empty if all are good or there is no result
      character(len=:), allocatable :: text

      real(wp) :: values(size(thresholds))
      integer :: i

      text = ''
      if (outcome%validity <= level_good) return
      values = judged(outcome, surroundings)
      do i = 1, size(thresholds)
         if (level_of(i, values(i)) > level_good) text = text//', ' &
            //measure_text(outcome, i, values(i))
      end do
      text = 'validity '//trim(levels(outcome%validity))//': '//text(3:)
   end function measures_remark

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
         if (farthest > 0) text = text//'    largest difference found '//brief(largest) &
            //', predicted '//brief(deviation(farthest))//', '//coordinates(grid, farthest)//nl
      end associate
      if (differs) text = '  cor_sphere with '//name_of_exact(case)//nl//text
      if (.not. differs) text = ''
   end function exact_points

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

   !> Note about plain numbers, in one line
   pure function about_numbers(case, words) result(text)
      type(case_t), intent(in) :: case
      !> Text about their accuracy and validity; may be empty
      character(len=*), intent(in) :: words
      !> The line; empty without text
      character(len=:), allocatable :: text

      text = ''
      if (words /= '') text = case%source//': '//words
   end function about_numbers

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

   !> A measure and its value, for the contact ratio also what is judged in its place
   function measure_text(outcome, measure, value) result(text)
      type(outcome_t), intent(in) :: outcome
      !> Index of the measure in `thresholds`
      integer, intent(in) :: measure
      !> Value that is judged
      real(wp), intent(in) :: value
      !> Such as `contact_ratio 0.67`
      character(len=:), allocatable :: text

      text = trim(thresholds(measure)%measure)
      text = text//' '//brief(quantity_value(outcome, text))
      if (thresholds(measure)%measure /= 'contact_ratio') return
      if (value > outcome%contact_ratio) &
         text = text//" (three times the sphere's share: "//brief(value)//')'
   end function measure_text

   !> A number with three digits
   function brief(value) result(text)
      real(wp), intent(in) :: value
      character(len=:), allocatable :: text

      text = significant(value, 3, 0)
   end function brief

   !> Warn on stderr of impacts that rely on what the data of the materials do not say
   subroutine warn_of_data(case, grid, summary)
      type(case_t), intent(in) :: case
      type(grid_t), intent(in) :: grid
      type(summary_t), intent(in) :: summary

      character(len=remark_length), allocatable :: remarks(:)
      integer :: i

      call find_remarks(case, grid, outcomes_t(summary%status == contact_separated, &
         summary%values(quantity_place('contact_time'))%reals, &
         summary%values(quantity_place('cor'))%reals), size(grid%axes) > 0, remarks)
      do i = 1, size(remarks)
         write (error_unit, '(a)') 'vcor: warning: '//trim(remarks(i))
      end do
   end subroutine warn_of_data

end module vcor_app_validity
