!> vcor's time per impact where the error of cor is below 1e-8, for the comparison with others
!>
!>     same_error CASE.nml ROW METHOD
!>
!> with ROW of tests/reference/reference.csv. The accuracy asked for is lowered until the error
!> stays below for three values in a row; the first of them is timed. So the rule is that of
!> cvode.c and solve_ivp.py, and so is the line that is printed:
!>
!>     problem,solver,settings,error,microseconds,spread,steps
program same_error
   use, intrinsic :: iso_fortran_env, only : error_unit, output_unit
   use vcor, only : case_t, error_t, override, read_case, wp
   use vcor_benchmark_reference, only : reference_cor
   use vcor_benchmark_stopwatch, only : measure, measurement_t, stop_on
   implicit none

   !> Largest error of cor that counts as solved
   real(wp), parameter :: wanted = 1.0e-8_wp
   !> Values of the accuracy that must agree
   integer, parameter :: confirmed = 3
   type(case_t) :: case
   type(measurement_t) :: measurement
   type(error_t), allocatable :: error
   character(len=512) :: file, row, method
   character(len=40) :: setting, chosen
   character(len=:), allocatable :: name
   real(wp) :: reference
   integer :: rung, good

   if (command_argument_count() /= 3) then
      write (error_unit, '(a)') 'usage: same_error CASE.nml ROW METHOD'
      error stop
   end if
   call get_command_argument(1, file)
   call get_command_argument(2, row)
   call get_command_argument(3, method)
   reference = reference_cor(trim(row))
   call read_case(case, trim(file), error)
   call stop_on(error)
   call set('solver.method='//trim(method))

   good = 0
   do rung = 0, 20
      write (setting, '(a, es7.1)') 'solver.accuracy=', 10.0_wp**(-6.0_wp - 0.25_wp*rung)
      call set(setting)
      call measure(case, measurement, error, untimed=.true.)
      ! a method that cannot do this case is for the caller to mention
      call stop_on(error)
      if (abs(measurement%outcome%cor - reference) <= wanted) then
         if (good == 0) chosen = setting
         good = good + 1
         if (good == confirmed) exit
      else
         good = 0
      end if
   end do
   if (good < confirmed) then
      write (error_unit, '(a)') 'benchmark: '//trim(file)//': the accuracy is out of reach'
      error stop
   end if

   call set(chosen)
   call measure(case, measurement, error)
   call stop_on(error)
   name = trim(file(index(file, '/', back=.true.) + 1:))
   write (output_unit, '(a, es7.1, a, f0.1, a, f5.3, a, i0)') &
      name(:index(name//'.nml', '.nml') - 1)//',vcor '//trim(method)//',' &
      //chosen(index(chosen, '.') + 1:len_trim(chosen))//',', &
      abs(measurement%outcome%cor - reference), ',', measurement%time, ',', measurement%spread, &
      ',', measurement%outcome%steps

contains

   !> Change one key of the case
   subroutine set(key_and_value)
      !> group.key=value
      character(len=*), intent(in) :: key_and_value

      call override(case, trim(key_and_value), error)
      call stop_on(error)
   end subroutine set
end program same_error
