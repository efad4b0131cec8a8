!> Judging: extrapolation, the comparison of methods
program test_verification
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan, ieee_quiet_nan, &
      ieee_value
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_sticking
   use vcor_io_case_reader, only : override, read_case
   use vcor_kinds, only : wp
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_case_case, only : case_t
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_verify_agreement, only : attempt_first, attempt_halved, attempt_refined, attempt_t, &
      comparison_t, is_honest, judge_ends, judge_numbers
   use vcor_verify_methods, only : compare
   use vcor_test, only : check, check_close, check_contains, check_relative, check_text, finish, &
      suite
   use vcor_test_cases, only : success
   implicit none

   !> Sums of a few numbers near 1
   real(wp), parameter :: rounding = 1.0e-14_wp

   call suite("verification")
   call test_richardson()
   call test_richardson_without_order()
   call test_honest()
   call test_comparison()
   call test_objections()
   call finish()

contains

   !> Not a number
   function nan()
      real(wp) :: nan

      nan = ieee_value(nan, ieee_quiet_nan)
   end function nan

   !> Values that converge with a known order
   subroutine test_richardson()
      real(wp), parameter :: order(4) = [1.0_wp, 1.5_wp, 2.0_wp, 2.5_wp]
      real(wp), parameter :: limit = 0.4_wp, coefficient = 1.0e-3_wp
      ! an order of a half is told from differences of 1e-5 with an error of rounding
      real(wp), parameter :: order_tolerance = 1.0e-9_wp
      type(richardson_t) :: found
      integer :: i

      do i = 1, size(order)
         found = richardson(limit + coefficient*0.5_wp**(order(i)*[0.0_wp, 1.0_wp, 2.0_wp]))
         call check_close(found%order, order(i), order_tolerance, "the order is found")
         call check_close(found%limit, limit, rounding, "and the limit")
         call check(found%error >= 1.2_wp*coefficient*0.25_wp**order(i), &
            "the error is on the safe side")
      end do
   end subroutine test_richardson

   !> Values that are equal, erratic or not finite
   subroutine test_richardson_without_order()
      type(richardson_t) :: found

      found = richardson([0.4_wp, 0.4_wp, 0.4_wp])
      call check(ieee_is_nan(found%order), "equal values show no order")
      call check_close([found%limit, found%error], [0.4_wp, 0.0_wp], 0.0_wp, "nor an error")
      found = richardson([0.4_wp, 0.5_wp, 0.4_wp])
      call check(ieee_is_nan(found%order), "values that jump show no order")
      call check_close(found%limit, 0.4_wp, 0.0_wp, "their limit is the last")
      call check(found%error >= 0.09_wp, "its error the jump")
      found = richardson([0.4_wp, 0.5_wp, 0.5_wp])
      call check(ieee_is_nan(found%order) .and. found%error > 1.0e-3_wp, &
         "two that agree by chance do not make an error of nothing")
      found = richardson([0.4_wp, 0.5_wp, 0.503_wp])
      call check(found%error > 0.008_wp, "nor do two that are next to each other")
      found = richardson([0.4_wp, nan(), 0.4_wp])
      call check(.not. ieee_is_finite(found%limit) .and. .not. ieee_is_finite(found%error), &
         "NaN leaves nothing")
      found = richardson([1.0e-300_wp, 1.5e-300_wp, 1.75e-300_wp])
      call check_relative(found%order, 1.0_wp, 1.0e-9_wp, "tiny values")
   end subroutine test_richardson_without_order

   !> An error is honest if it is not much too small
   subroutine test_honest()
      type(attempt_t) :: this

      real(wp), parameter :: exact(2) = 0.0_wp

      this%outcome%cor_error = 1.0e-6_wp
      this%outcome%cor_sphere_error = 4.0e-6_wp
      this%distance = [2.0e-6_wp, 8.0e-6_wp]
      call check(all(is_honest(this, exact)), "twice the stated error is fine")
      this%distance(1) = 5.0e-6_wp
      call check(all(is_honest(this, exact) .eqv. [.false., .true.]), "five times is not")
      call check(all(is_honest(this, exact + 1.0e-6_wp)), "unless the reference is as uncertain")
      this%distance = [2.0e-6_wp, 2.0e-5_wp]
      call check(all(is_honest(this, exact) .eqv. [.true., .false.]), "of cor_sphere neither")
      this%distance = [nan(), 0.0_wp]
      call check(all(is_honest(this, exact) .eqv. [.false., .true.]), "NaN is not")
      this%distance = 0.0_wp
      this%outcome%cor_error = nan()
      call check(all(is_honest(this, exact) .eqv. [.false., .true.]), "nor is an error of NaN")
   end subroutine test_honest

   !> The paper's SLS case by both methods
   subroutine compare_sls(comparison)
      !> The comparison
      type(comparison_t), intent(out) :: comparison

      type(case_t) :: case
      type(problem_t) :: problem
      type(error_t), allocatable :: error

      call read_case(case, "examples/paper/sls.nml", error)
      call success(error, "a case is read")
      call problem_of_case(problem, case, error)
      call success(error, "its impact is built")
      call compare(case, problem, comparison, error)
      call success(error, "it is compared")
   end subroutine compare_sls

   !> Both methods agree on the paper's SLS case
   subroutine test_comparison()
      type(comparison_t) :: comparison
      integer :: i

      call compare_sls(comparison)
      call check(.not. allocated(comparison%objection), "there is nothing to object to")
      call check(comparison%two_methods .and. comparison%separated, "two methods and one end")
      call check(all(comparison%compared%digits >= 8), "eight digits of everything")
      call check_close(comparison%compared(1)%best, 0.4319868986470_wp, 1.0e-11_wp, "the best cor")
      call check_close(comparison%compared%direct%order, 2.5_wp, 0.3_wp, &
         "product integration converges with order 2.5")
      do i = attempt_first, size(comparison%attempts)
         call check(all(is_honest(comparison%attempts(i), [0.0_wp, 0.0_wp])), "honest errors")
      end do
   end subroutine test_comparison

   !> What is wrong is found
   subroutine test_objections()
      ! the last value is right, and each difference eight times the one before
      real(wp), parameter :: growing(3) = 1.0e-4_wp*[-9.0_wp, -8.0_wp, 0.0_wp]
      real(wp), parameter :: jumping(3) = 1.0e-4_wp*[-0.5_wp, -2.0_wp, -0.1_wp]
      type(comparison_t) :: good, bad
      integer :: i

      call compare_sls(good)

      bad = good
      associate (outcome => bad%attempts(attempt_halved(3))%outcome)
         outcome%max_force = 1.001_wp*outcome%max_force
      end associate
      call judge_numbers(bad)
      call objects(bad, "direct does not converge to a max_force", "a force that jumps")

      bad = good
      do i = 1, size(attempt_halved)
         associate (outcome => bad%attempts(attempt_halved(i))%outcome)
            outcome%max_force = (1.0_wp + 1.0e-6_wp)*outcome%max_force
         end associate
      end do
      call judge_numbers(bad)
      call objects(bad, "do not agree on max_force", "a force that differs")

      bad = good
      do i = 1, size(attempt_halved)
         associate (outcome => bad%attempts(attempt_halved(i))%outcome)
            outcome%max_force = (1.0_wp + growing(i))*outcome%max_force
         end associate
      end do
      call judge_numbers(bad)
      call objects(bad, "direct does not converge to a max_force", "differences that grow")

      ! the first value right by chance, the errors of the others falling
      bad = good
      do i = 1, size(attempt_halved)
         associate (outcome => bad%attempts(attempt_halved(i))%outcome)
            outcome%max_force = (1.0_wp + jumping(i))*outcome%max_force
         end associate
      end do
      call judge_numbers(bad)
      call check(.not. allocated(bad%objection), "values that jump as maxima on a grid do are fine")

      bad = good
      associate (outcome => bad%attempts(attempt_first)%outcome)
         outcome%cor = outcome%cor + 0.5_wp*bad%attempts(attempt_first)%accuracy
         outcome%cor_error = 0.5e-3_wp*bad%attempts(attempt_first)%accuracy
      end associate
      call judge_numbers(bad)
      call objects(bad, "ive is farther from", "an estimate a thousand times too small")

      bad = good
      associate (outcome => bad%attempts(attempt_refined)%outcome)
         outcome%cor = outcome%cor + 1.0e-6_wp
      end associate
      call judge_numbers(bad)
      call objects(bad, "states", "a restitution that differs")

      bad = good
      bad%attempts(attempt_halved(2))%outcome%cor = nan()
      call judge_numbers(bad)
      call objects(bad, "states", "a restitution of NaN")

      bad = good
      associate (outcome => bad%attempts(attempt_first)%outcome)
         outcome%energy_imbalance = 1.0e-6_wp*outcome%initial_energy
      end associate
      call judge_numbers(bad)
      call objects(bad, "energies of ive", "energy that is lost by ive")

      bad = good
      associate (outcome => bad%attempts(attempt_halved(3))%outcome)
         outcome%energy_imbalance = 1.0e-4_wp*outcome%initial_energy
      end associate
      call judge_numbers(bad)
      call objects(bad, "energies of direct", "energy that is lost by direct")

      bad = good
      bad%attempts(attempt_halved(1))%outcome%status = contact_sticking
      call judge_ends(bad)
      call objects(bad, "separated by ive, sticks by direct", "different ends")
      call check(.not. bad%separated, "different ends are not compared")

      bad = good
      bad%attempts(attempt_first)%failure = "it broke"
      call judge_ends(bad)
      call objects(bad, "ive: it broke", "a failure")
      call check(.not. bad%separated, "failures are not compared")
   end subroutine test_objections

   !> Check that a comparison objects to something
   subroutine objects(comparison, part, what)
      !> The comparison, judged
      type(comparison_t), intent(in) :: comparison
      !> Part of the objection
      character(len=*), intent(in) :: part
      !> What it must object to
      character(len=*), intent(in) :: what

      call check(allocated(comparison%objection), "there is an objection to "//what)
      if (allocated(comparison%objection)) &
         call check_contains(comparison%objection, part, "it is about "//what)
   end subroutine objects

end program test_verification
