!> What the screen shows of an impact
module vcor_app_screen
   use vcor, only : contact_separated, integer_text, outcome_t, quantities, quantity_value, &
      status_name, version, wp
   implicit none
   private

   public :: report

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Quantities of the first table, by name
   character(len=*), parameter :: shown(*) = [character(len=20) :: 'cor', 'cor_sphere', &
      'contact_time', 'max_indentation', 'max_force', 'residual_indentation', 'residual_ratio', &
      'min_frequency', 'inelasticity', 'loss_tangent']

contains

   !> Report of one impact
   function report(filename, title, method, outcome, files) result(text)
      !> Case file
      character(len=*), intent(in) :: filename
      !> Title of the case
      character(len=*), intent(in) :: title
      !> Method that solved it
      character(len=*), intent(in) :: method
      !> Outcome
      type(outcome_t), intent(in) :: outcome
      !> Files written, separated by commas
      character(len=*), intent(in) :: files
      !> Text of several lines
      character(len=:), allocatable :: text

      integer :: i, j

      text = 'vcor '//version//'  '//filename//nl
      if (len_trim(title) > 0) text = text//trim(title)//nl
      text = text//nl
      if (outcome%status /= contact_separated) then
         text = text//'  '//status_name(outcome%status)//' after '//integer_text(outcome%steps) &
            //' steps of method '//method//nl
      else
         do i = 1, size(shown)
            do j = 1, size(quantities)
               if (quantities(j)%name /= shown(i)) cycle
               text = text//'  '//quantities(j)%meaning(1:50)//quantities(j)%symbol &
                  //significant(quantity_value(outcome, j))//'  '//unit_text(quantities(j)%unit)
               if (quantities(j)%name == 'cor') &
                  text = text//'  +- '//short(outcome%cor_error)
               text = trimmed(text)//nl
            end do
         end do
         text = text//nl//budget(outcome)//nl//'  method '//method//', ' &
            //integer_text(outcome%steps)//' steps'//nl
      end if
      if (len(files) > 0) text = text//'  written '//files//nl
   end function report

   !> Energy budget
   function budget(outcome) result(text)
      !> Outcome
      type(outcome_t), intent(in) :: outcome
      !> Lines
      character(len=:), allocatable :: text

      text = '  energy before the impact                          KE_0    ' &
         //significant(outcome%initial_energy)//'  J'//nl &
         //share('  lost in the contact (hysteresis)', 'W_h', outcome%hysteresis_energy) &
         //share('  radiated into the plate', 'W_wave', outcome%wave_energy) &
         //share('  left to the sphere', 'KE_1', outcome%final_energy) &
         //'  imbalance                                         dW      ' &
         //significant(outcome%energy_imbalance)//'  J'//nl

   contains

      !> One part of the budget
      function share(name, symbol, energy) result(line)
         !> What it is
         character(len=*), intent(in) :: name
         !> Its symbol
         character(len=*), intent(in) :: symbol
         !> Energy [J]
         real(wp), intent(in) :: energy
         !> Line
         character(len=:), allocatable :: line

         character(len=50) :: wide
         character(len=8) :: narrow, percent

         wide = name
         narrow = symbol
         ! a thousandth of a percent is the last digit shown; zero has no sign
         write (percent, '(f8.3)') 1.0e-3_wp*max(0, nint(1.0e5_wp*energy/outcome%initial_energy))
         line = '  '//wide//narrow//significant(energy)//'  J  '//percent//' %'//nl
      end function share
   end function budget

   !> A number with eight significant digits, 16 characters
   pure function significant(value) result(text)
      !> The number
      real(wp), intent(in) :: value
      !> Its text
      character(len=16) :: text

      integer, parameter :: digits = 8
      character(len=8) :: form
      integer :: whole

      if (.not. abs(value) > 0.0_wp) then
         text = repeat(' ', 15)//'0'
      else if (abs(value) < 0.1_wp .or. abs(value) >= 1.0e6_wp) then
         write (text, '(es16.7e2)') value
      else
         whole = max(0, floor(log10(abs(value))) + 1)
         write (form, '(a,i1,a)') '(f16.', digits - whole, ')'
         write (text, form) value
      end if
   end function significant

   !> A number with two significant digits
   pure function short(value) result(text)
      !> The number
      real(wp), intent(in) :: value
      !> Its text
      character(len=:), allocatable :: text

      character(len=10) :: buffer

      write (buffer, '(es9.1)') value
      text = trim(adjustl(buffer))
   end function short

   !> Unit, - for a pure number
   pure function unit_text(unit) result(text)
      !> Unit, 1 for a pure number
      character(len=*), intent(in) :: unit
      !> Its text
      character(len=:), allocatable :: text

      text = trim(unit)
      if (text == '1') text = '-'
   end function unit_text

   !> Text without blanks at its end
   pure function trimmed(line) result(text)
      !> The text
      character(len=*), intent(in) :: line
      !> Without trailing blanks
      character(len=:), allocatable :: text

      text = trim(line)
   end function trimmed

end module vcor_app_screen
