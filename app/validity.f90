!> Messages about the mechanics and the validity of an impact: the measures that are not good, one
!> sentence each
module vcor_app_validity
   use vcor_case_case, only : case_t
   use vcor_case_reading, only : reading_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_validity, only : judged, level_caution, level_good, level_of, level_outside, &
      levels, surroundings_t, thresholds
   use vcor_kinds, only : wp
   use vcor_rounded, only : percent, significant
   use vcor_sweep_quantity, only : quantity_value
   use vcor_verify_models, only : model_t
   implicit none
   private

   public :: mechanics_of, name_of_exact, measures_report, measures_remark, about_numbers

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

contains

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

end module vcor_app_validity
