!> Text for the screen: headings, lines of a name, a number and a unit; the report of an impact
module vcor_app_screen
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan
   use vcor_case_choices, only : topic_t
   use vcor_impact_outcome, only : none, outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_impact_validity, only : level_caution, level_outside
   use vcor_rounded, only : short, significant
   use vcor_text, only : integer_text
   use vcor_kinds, only : wp
   use vcor_sweep_quantity, only : quantities, quantity_place, quantity_t, &
      quantity_value, status_name
   use vcor_version, only : version
   implicit none
   private

   public :: report, blocks, screen_items, digits_of_level, heading, line, padded, right, visible

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Name of a group of quantities, and the quantities
   type :: block_t
      character(len=24) :: title
      character(len=20) :: names(9) = ''
   end type block_t
   !> The table of an impact, and of a sweep
   type(block_t), parameter :: blocks(*) = [ &
      block_t('restitution', [character(len=20) :: 'cor_sphere', 'cor', 'resilience', &
      'rebound_height', '', '', '', '', '']), &
      block_t('motion', [character(len=20) :: 'contact_time', 'contacts', 'last_separation', &
      'max_indentation', &
      'residual_indentation', 'residual_ratio', 'contact_radius', 'layer_ratio', &
      'layer_strain']), &
      block_t('force', [character(len=20) :: 'max_force', 'mean_pressure', 'layer_stiffening', &
      '', '', '', '', '', '']), &
      block_t('what decides the loss', [character(len=20) :: 'peak_loss_tangent', &
      'peak_storage_modulus', 'loss_tangent', 'min_frequency', 'inelasticity', '', '', '', ''])]
   !> Items on the screen of a run that are not columns
   type(topic_t), parameter :: screen_items(*) = [ &
      topic_t(' KE_1 ', &
         'left to the sphere: its kinetic energy after the impact, KE_0 cor_sphere^2 [J]'), &
      topic_t(' exponentials kernel ', &
         "'kernel as a sum of 35 exponentials, to 6.0E-10': method ive writes a relaxation " &
         //'modulus with a continuous spectrum (power law, CERF, Mittag-Leffler, tables, some ' &
         //'pairs) as a sum of exponentials. Their number follows from solver.accuracy. The ' &
         //'second number is the largest relative error of its integral over the contact time; ' &
         //'cor_error includes it. A Prony series is such a sum already, so nothing is printed.'), &
      topic_t(' +- ', &
         'estimated numerical error of the number before it: cor_error or cor_sphere_error. It ' &
         //'says nothing about the model or the material data.'), &
      topic_t(' good caution outside ', &
         'levels of validity, of which the worst counts. good: cor_sphere is within 2 % or 0.01 ' &
         //'of exact mechanics (99 of 100 random impacts), caution: within 10 % or 0.05 ' &
         //'(99 of 100), outside: the model is that of another impact. Each line has the ' &
         //'measure, its value, what is off and what to do; vcor help MEASURE says what is ' &
         //'measured.')]

contains

   !> Report of one impact
   function report(filename, title, method, outcome, exact, exact_name, time, bounces, files) &
      result(text)
      character(len=*), intent(in) :: filename
      character(len=*), intent(in) :: title
      character(len=*), intent(in) :: method
      type(outcome_t), intent(in) :: outcome
      !> Outcome with exact mechanics; without numbers if it is not shown
      type(outcome_t), intent(in) :: exact
      !> Name of this mechanics
      character(len=*), intent(in) :: exact_name
      !> Time at which the computation ended [s]
      real(wp), intent(in) :: time
      !> Table of bounces; may be empty
      character(len=*), intent(in) :: bounces
      !> Notes and written files, one per line
      character(len=*), intent(in) :: files
      character(len=:), allocatable :: text

      integer :: i

      text = heading(filename, title)
      if (outcome%status /= contact_separated) then
         text = text//'  the bodies are still in contact at '//short(time)//' s (method ' &
            //method//' in '//steps_of(method, outcome)//'), status ' &
            //trim(status_name(outcome%status))//nl//bounces
      else
         text = text//answer(outcome, exact, exact_name)//nl
         do i = 1, size(blocks)
            if (blocks(i)%title == 'what decides the loss') text = text//budget(outcome)//nl
            text = text//block_text(blocks(i), outcome, exact, exact_name)//nl
         end do
         text = text//bounces//'  method '//method//' in '//steps_of(method, outcome)//nl
      end if
      text = text//files//nl
   end function report

   !> Steps of a computation in words; of methods that choose them a few may be enough
   pure function steps_of(method, outcome) result(text)
      character(len=*), intent(in) :: method
      type(outcome_t), intent(in) :: outcome
      character(len=:), allocatable :: text

      text = integer_text(outcome%steps)//trim(merge(' step ', ' steps', outcome%steps == 1))
      if (method == 'ive' .or. method == 'coupled') text = text//', as many as the accuracy needs'
   end function steps_of

   !> The answer: the coefficient of restitution that an experiment reads, and in a line of its own
   !> whether the model holds, and the exact value if that differs. Each has at most 80 columns
   function answer(outcome, exact, exact_name) result(text)
      type(outcome_t), intent(in) :: outcome, exact
      !> Name of the exact mechanics
      character(len=*), intent(in) :: exact_name
      character(len=:), allocatable :: text

      character(len=:), allocatable :: second

      text = '  e_a = '//significant(outcome%cor_sphere, digits_of(outcome, outcome%cor_sphere, &
         outcome%cor_sphere_error), 0) &
         //', the restitution of the sphere, as a drop test reads it'//nl
      second = ''
      if (outcome%validity == level_outside) second = '; outside the validity of the model'
      if (outcome%validity == level_caution) second = '; with caution'
      if (.not. ieee_is_nan(exact%cor_sphere)) second = second//'; with '//exact_name &
         //' '//significant(exact%cor_sphere, digits_of(exact, exact%cor_sphere, &
         exact%cor_sphere_error), 0)
      if (second /= '') text = text//'  '//second(3:)//nl
   end function answer

   !> Lines of a group of quantities
   function block_text(group, outcome, exact, exact_name) result(text)
      type(block_t), intent(in) :: group
      type(outcome_t), intent(in) :: outcome, exact
      !> Name of the exact mechanics
      character(len=*), intent(in) :: exact_name
      character(len=:), allocatable :: text

      type(quantity_t), allocatable :: columns(:)
      integer :: k

      allocate (columns, source=quantities())
      text = '  '//trim(group%title)//nl
      do k = 1, size(group%names)
         associate (name => group%names(k))
            if (name == '') exit
            if (ieee_is_nan(quantity_value(outcome, name))) cycle
            ! a plate without edges is struck once
            if (name == 'contacts' .and. .not. outcome%has_structure()) cycle
            if (name == 'last_separation' .and. outcome%contacts <= 1) cycle
            associate (quantity => columns(quantity_place(name)))
               if (quantity%is_whole) then
                  text = text//padded('    '//quantity%meaning, 50)//padded(quantity%symbol, 8) &
                     //right(integer_text(nint(quantity_value(outcome, name))), 16)//nl
                  cycle
               end if
               text = text//line('    '//quantity%meaning, 50, quantity%symbol, &
                  shown_value(), merge('        ', quantity%unit, quantity%unit == '1'), &
                  remark(outcome, name), digits_of(outcome, quantity_value(outcome, name), &
                  error_of(outcome, name)))
               if (all(name /= [character(len=10) :: 'cor', 'cor_sphere'])) cycle
               if (name == 'cor' .and. exact%is_coupled()) cycle
               if (ieee_is_nan(exact%cor)) cycle
               text = text//line('      with '//exact_name, 50, quantity%symbol, &
                  quantity_value(exact, name), '', remark(exact, name), &
                  digits_of(exact, quantity_value(exact, name), error_of(exact, name)))
            end associate
         end associate
      end do

   contains

      !> A number of the table; 0 if it is only rounding
      function shown_value() result(value)
         real(wp) :: value

         value = quantity_value(outcome, group%names(k))
         if (group%names(k) == 'residual_indentation') &
            value = visible(value, outcome%max_indentation)
         if (group%names(k) == 'residual_ratio') value = visible(value, 1.0_wp)
      end function shown_value
   end function block_text

   !> Remark after a number
   function remark(outcome, name)
      type(outcome_t), intent(in) :: outcome
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: remark

      remark = ''
      if (name == 'cor') remark = '+- '//short(outcome%cor_error)//' numerical'
      if (name == 'cor_sphere') remark = '+- '//short(outcome%cor_sphere_error)//' numerical'
      if (name == 'contact_time') remark = rough_error(outcome%contact_time, &
         outcome%contact_time_error)
      if (name == 'max_force') remark = rough_error(outcome%max_force, outcome%max_force_error)
   end function remark

   !> Stated error of a quantity of the table; 0 for those without
   pure function error_of(outcome, name) result(error)
      type(outcome_t), intent(in) :: outcome
      character(len=*), intent(in) :: name
      real(wp) :: error

      error = 0.0_wp
      if (name == 'cor') error = outcome%cor_error
      if (name == 'cor_sphere') error = outcome%cor_sphere_error
      if (name == 'contact_time') error = outcome%contact_time_error
      if (name == 'max_force') error = outcome%max_force_error
   end function error_of

   !> Digits that a number of the table carries: by the validity of the model, and no more than one
   !> beyond its error
   pure function digits_of(outcome, value, error) result(digits)
      type(outcome_t), intent(in) :: outcome
      real(wp), intent(in) :: value
      !> Stated error; 0 or NaN if there is none
      real(wp), intent(in) :: error
      integer :: digits

      digits = digits_of_level(outcome%validity, value, error)
   end function digits_of

   !> Digits that a number carries where the model holds, and where it holds with caution or not;
   !> no more than one beyond its error
   pure function digits_of_level(level, value, error) result(digits)
      !> Level of validity
      integer, intent(in) :: level
      real(wp), intent(in) :: value
      !> Stated error; 0 or NaN if there is none
      real(wp), intent(in) :: error
      integer :: digits

      ! below any error, so that nothing is divided by zero
      real(wp), parameter :: least = 1.0e-20_wp

      digits = 8
      if (level == level_caution) digits = 4
      if (level == level_outside) digits = 3
      if (.not. (ieee_is_finite(error) .and. ieee_is_finite(value))) return
      digits = max(2, min(digits, 1 + floor(log10(max(1.0_wp, abs(value)/max(error, least))))))
   end function digits_of_level

   !> Remark on a number that is less accurate than a reader expects
   pure function rough_error(value, error) result(text)
      real(wp), intent(in) :: value
      !> Its estimated error, NaN if there is none
      real(wp), intent(in) :: error
      character(len=:), allocatable :: text

      ! relative error from which it is stated
      real(wp), parameter :: rough = 2.0e-3_wp

      text = ''
      if (.not. ieee_is_finite(error)) return
      if (error > rough*value) text = '+- '//short(error)//' numerical'
   end function rough_error

   !> Program, case and title, and an empty line
   pure function heading(filename, title) result(text)
      character(len=*), intent(in) :: filename
      character(len=*), intent(in) :: title
      character(len=:), allocatable :: text

      text = 'vcor '//version//'  '//filename//nl
      if (len_trim(title) > 0) text = text//trim(title)//nl
      text = text//nl
   end function heading

   !> One line of a table
   pure function line(meaning, width, symbol, value, unit, remark, digits) result(text)
      !> Meaning, indented
      character(len=*), intent(in) :: meaning
      !> Width of its column
      integer, intent(in) :: width
      character(len=*), intent(in) :: symbol
      real(wp), intent(in) :: value
      character(len=*), intent(in) :: unit
      character(len=*), intent(in) :: remark
      !> Digits of the number; absent: 8
      integer, intent(in), optional :: digits
      character(len=:), allocatable :: text

      character(len=:), allocatable :: number

      number = significant(value, digits)
      if (value > huge(value)) number = right('infinite', 16)
      text = padded(meaning, width)//padded(symbol, 8)//number
      if (.not. value > huge(value)) text = text//' '//padded(unit, 7)//remark
      text = trim(text)//nl
   end function line

   !> A text padded with blanks
   pure function padded(text, width) result(wide)
      character(len=*), intent(in) :: text
      !> Minimum length
      integer, intent(in) :: width
      !> The padded text, never shortened
      character(len=:), allocatable :: wide

      wide = trim(text)//repeat(' ', max(0, width - len_trim(text)))
   end function padded

   !> A right-justified text
   pure function right(text, width) result(wide)
      character(len=*), intent(in) :: text
      !> Minimum length
      integer, intent(in) :: width
      !> The justified text, never shortened
      character(len=:), allocatable :: wide

      wide = repeat(' ', max(0, width - len_trim(text)))//trim(text)
   end function right

   !> Energy budget
   function budget(outcome) result(text)
      type(outcome_t), intent(in) :: outcome
      character(len=:), allocatable :: text

      character(len=:), allocatable :: doubt
      integer :: d

      d = digits_of(outcome, 0.0_wp, none)
      text = '  energy'//nl//line('    energy before the impact', 50, 'KE_0', &
         outcome%initial_energy, 'J', '', d)
      if (abs(outcome%weight_work) > 0.0_wp) text = text//line('    gained by the weight', 50, &
         'm g z', outcome%weight_work, 'J', share(outcome%weight_work), d)
      if (outcome%is_coupled()) then
         ! contact and waves are one
         text = text//line('    lost in contact and plate together', 50, 'W', &
            visible(outcome%energy_loss, outcome%initial_energy), 'J', &
            share(outcome%energy_loss), d)
      else
         doubt = ''
         if (visible(outcome%wave_energy, outcome%initial_energy) < 0.0_wp) &
            doubt = '; only W_h + W_wave is a loss'
         text = text//line('    lost in the contact (hysteresis)', 50, 'W_h', &
            visible(outcome%hysteresis_energy, outcome%initial_energy), 'J', &
            share(outcome%hysteresis_energy), d) &
            //line('    '//trim(merge('given to the structure ', 'radiated into the plate', &
            outcome%has_structure())), 50, 'W_wave', &
            visible(outcome%wave_energy, outcome%initial_energy), 'J', &
            share(outcome%wave_energy)//doubt, d)
         if (outcome%has_structure() .and. .not. ieee_is_nan(outcome%structure_energy)) &
            text = text//line('      left in it at the last separation', 50, 'W_s', &
            visible(outcome%structure_energy, outcome%initial_energy), 'J', &
            share(outcome%structure_energy), d)
      end if
      text = text//line('    left to the sphere', 50, 'KE_1', outcome%final_energy, 'J', &
         share(outcome%final_energy), d) &
         //line('    energy imbalance', 50, 'dW', outcome%energy_imbalance, 'J', '', 2)

   contains

      !> Share of the kinetic energy
      pure function share(energy) result(percent)
         !> Energy [J]
         real(wp), intent(in) :: energy
         character(len=10) :: percent

         real(wp) :: part

         ! to a thousandth of a percent at most, the last digit shown; zero has no sign
         part = 1.0e-3_wp*anint(1.0e5_wp*energy/outcome%initial_energy)
         write (percent, '(f8.3, a)') part + 0.0_wp, ' %'
         if (d < 8) write (percent, '(f8.1, a)') anint(10.0_wp*part)/10.0_wp + 0.0_wp, ' %'
         if (abs(part) >= 1.0e3_wp) percent = right(short(part), 8)//' %'
      end function share
   end function budget

   !> A number, or 0 if it is below the trusted digits of its scale, where only rounding and
   !> numerical error remain
   pure function visible(value, scale, digits)
      real(wp), intent(in) :: value
      !> Whole that the number is a part of, > 0
      real(wp), intent(in) :: scale
      !> Trusted digits of the scale; absent: 8
      integer, intent(in), optional :: digits
      real(wp) :: visible

      integer :: d

      d = 8
      if (present(digits)) d = digits
      visible = value
      if (abs(value) <= 10.0_wp**(-d)*scale) visible = 0.0_wp
   end function visible

end module vcor_app_screen
