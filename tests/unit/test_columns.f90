!> Every column of the summary is as accurate as asked, and both estimated errors are honest, where
!> that is hard: plates whose alpha' is infinite at first contact, modes that settle at once
program test_columns
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_kinds, only : wp
   use vcor_solver_ive, only : ive_t
   use vcor_solver_direct_product, only : product_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : make_ive, make_product, read_impact, run
   implicit none

   !> Where the cases and their numbers stand, from the top of the sources. The numbers are made by
   !> spectral collocation in time with the exact kernels, which shares nothing with the solvers
   character(len=*), parameter :: folder = "tests/reference/columns/"
   !> Number of impacts
   integer, parameter :: rows = 10
   !> What the numbers themselves are good to, and rounding
   real(wp), parameter :: digits = 1.0e-11_wp
   !> Energies go with the square of cor_sphere: twice its error
   real(wp), parameter :: energy_share = 2.0_wp
   !> An error that is stated is not to be exceeded by more
   real(wp), parameter :: honest = 3.0_wp
   !> What may be stated, over the accuracy: errors that the panels inherit are put up with
   real(wp), parameter :: stated_share = 2.0_wp

   character(len=40) :: name(rows)
   real(wp) :: expected(8, rows)
   type(impact_t) :: impact(rows)
   integer :: i

   call suite("columns")
   call read_numbers()
   do i = 1, rows
      call read_impact(folder//trim(name(i))//".nml", impact(i))
   end do
   call test_ive(1.0e-6_wp)
   call test_ive(1.0e-8_wp)
   call test_ive(1.0e-10_wp)
   call test_direct()
   call test_frozen_order()
   call finish()

contains

   !> Read the numbers
   subroutine read_numbers()
      character(len=400) :: line
      integer :: unit, status, i, comma

      open(newunit=unit, file=folder//"columns.csv", status="old", action="read", iostat=status)
      call check(status == 0, folder//"columns.csv is there")
      if (status /= 0) return
      read(unit, "(a)") line
      do i = 1, rows
         read(unit, "(a)") line
         comma = index(line, ",")
         name(i) = line(:comma - 1)
         read(line(comma + 1:), *) expected(:, i)
      end do
      close(unit)
   end subroutine read_numbers

   !> All columns by internal variables
   subroutine test_ive(accuracy)
      !> Accuracy asked for
      real(wp), intent(in) :: accuracy

      type(ive_t) :: solver
      type(outcome_t) :: outcome
      character(len=12) :: asked
      integer :: i

      write(asked, "(a, es7.1)") " ive ", accuracy
      call make_ive(accuracy, solver)
      do i = 1, rows
         call run(solver, impact(i), outcome)
         associate (r => expected(:, i), label => trim(name(i))//asked, &
                    tolerance => accuracy + digits)
            call check_coefficients(outcome, r, accuracy, label)
            call check_relative(outcome%contact_time, r(3), tolerance, label//": contact_time")
            call check_relative(outcome%max_indentation, r(4), tolerance, &
               label//": max_indentation")
            call check_relative(outcome%max_force, r(5), tolerance, label//": max_force")
            call check_close(outcome%residual_indentation/r(4), r(6)/r(4), tolerance, &
               label//": residual_indentation")
            call check_energies(outcome, r, energy_share*tolerance, label)
         end associate
      end do
   end subroutine test_ive

   !> By product integration
   subroutine test_direct()
      ! those of the frozen plates of the power law are the hardest
      real(wp), parameter :: accuracy = 1.0e-6_wp, share = 2.0_wp
      type(product_t) :: solver
      type(outcome_t) :: outcome
      integer :: i

      call make_product(0.0_wp, accuracy, solver)
      do i = 1, rows
         call run(solver, impact(i), outcome)
         associate (r => expected(:, i), label => trim(name(i))//" direct")
            call check_coefficients(outcome, r, accuracy, label)
            call check_relative(outcome%max_indentation, r(4), accuracy, &
               label//": max_indentation")
            call check_relative(outcome%max_force, r(5), accuracy, label//": max_force")
            call check_energies(outcome, r, share*energy_share*accuracy, label)
         end associate
      end do
   end subroutine test_direct

   !> Both coefficients and their stated errors
   subroutine check_coefficients(outcome, r, accuracy, label)
      !> The outcome
      type(outcome_t), intent(in) :: outcome
      !> What it is to be
      real(wp), intent(in) :: r(8)
      !> Accuracy asked for
      real(wp), intent(in) :: accuracy
      !> What is tested
      character(len=*), intent(in) :: label

      call check(outcome%status == contact_separated, label//": the bodies separate")
      call check_close(outcome%cor, r(1), min(accuracy, honest*outcome%cor_error) + digits, &
         label//": cor")
      call check_close(outcome%cor_sphere, r(2), min(accuracy, honest*outcome%cor_sphere_error) &
         + digits, label//": cor_sphere")
      call check(max(outcome%cor_error, outcome%cor_sphere_error) <= stated_share*accuracy, &
         label//": by its own estimates as well")
   end subroutine check_coefficients

   !> Energies
   subroutine check_energies(outcome, r, tolerance, label)
      !> The outcome
      type(outcome_t), intent(in) :: outcome
      !> What it is to be
      real(wp), intent(in) :: r(8)
      !> Tolerance, over the energy before the impact
      real(wp), intent(in) :: tolerance
      !> What is tested
      character(len=*), intent(in) :: label

      associate (whole => outcome%initial_energy)
         call check_close(outcome%hysteresis_energy/whole, r(7)/whole, tolerance, &
            label//": hysteresis_energy")
         call check_close(outcome%wave_energy/whole, r(8)/whole, tolerance, label//": wave_energy")
         call check_close(outcome%energy_imbalance/whole, 0.0_wp, tolerance, &
            label//": energy_imbalance")
      end associate
   end subroutine check_energies

   !> A drift whose rate begins as a power of t: with the rule of Adams and Moulton alone the order
   !> was 1.65 on the frozen Mittag-Leffler plate, 1.16 on that of the power law
   subroutine test_frozen_order()
      integer, parameter :: coarse = 200, fine = 800
      real(wp), parameter :: least_order = 2.3_wp
      real(wp) :: error(2)

      error = [error_with(coarse), error_with(fine)]
      call check(error(2) <= error(1)*(real(coarse, wp)/real(fine, wp))**least_order, &
         "direct on a frozen plate: order of cor_sphere")
   end subroutine test_frozen_order

   !> Error of cor_sphere of the frozen Mittag-Leffler plate with so many steps
   function error_with(steps) result(error)
      !> Number of steps of the contact
      integer, intent(in) :: steps
      !> Error
      real(wp) :: error

      type(product_t) :: solver
      type(outcome_t) :: outcome

      call make_product(expected(3, 3)/real(steps, wp), 1.0e-6_wp, solver)
      call run(solver, impact(3), outcome)
      error = abs(outcome%cor_sphere - expected(2, 3))
   end function error_with

end program test_columns
