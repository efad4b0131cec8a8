!> Quantities of a row. (A pointer to a procedure inside a program would need an executable stack.)
module test_verification_quantities
   use vcor_impact_outcome, only : outcome_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: weighted_sum, twice_the_first

contains

   !> A sum of restitutions
   pure function weighted_sum(outcomes) result(value)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: value

      value = sum([1.0_wp, 2.0_wp]*outcomes%cor)
   end function weighted_sum

   !> Twice the first restitution
   pure function twice_the_first(outcomes) result(value)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: value

      value = 2.0_wp*outcomes(1)%cor
   end function twice_the_first

end module test_verification_quantities

!> Judging: rows of the verification table, extrapolation, the comparison of methods
program test_verification
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan, ieee_positive_inf, &
      ieee_quiet_nan, ieee_value
   use test_verification_quantities, only : twice_the_first, weighted_sum
   use vcor_error, only : error_internal, error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated, contact_sticking
   use vcor_io_case_reader, only : override, read_case
   use vcor_kinds, only : wp
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_case_case, only : case_t
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_verify, only : build_law, evaluate_law, law_count
   use vcor_verify_law, only : elastic, judge, law_t, row_t, sls, strike_t, verdict_t
   use vcor_verify_methods, only : attempt_first, attempt_halved, attempt_refined, attempt_t, &
      compare, comparison_t, is_honest, judge_ends, judge_numbers
   use vcor_test, only : check, check_close, check_contains, check_relative, check_text, finish, &
      suite
   use vcor_test_cases, only : success
   implicit none

   !> Sums of a few numbers near 1
   real(wp), parameter :: rounding = 1.0e-14_wp

   call suite("verification")
   call test_judge()
   call test_judge_of_pairs()
   call test_judge_of_measures()
   call test_judge_of_nothing()
   call test_laws()
   call test_wrong_law()
   call test_law_that_does_not_exist()
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

   !> A row about cor
   function row_of(expected, tolerance) result(row)
      real(wp), intent(in) :: expected
      real(wp), intent(in) :: tolerance
      type(row_t) :: row

      row%name = "cor"
      row%expected = expected
      row%times = 0.0_wp
      row%more = tolerance
   end function row_of

   !> An outcome with a restitution
   function outcome_of(cor) result(outcome)
      real(wp), intent(in) :: cor
      type(outcome_t) :: outcome

      outcome%status = contact_separated
      outcome%cor = cor
      outcome%max_force = 600.0_wp
   end function outcome_of

   !> What is within the tolerance passes, nothing else does
   subroutine test_judge()
      type(row_t) :: row
      type(verdict_t) :: verdict
      real(wp) :: infinite

      infinite = ieee_value(infinite, ieee_positive_inf)
      verdict = judge(row_of(0.5_wp, 1.0e-3_wp), 1, [outcome_of(0.5005_wp)])
      call check(verdict%passed, "a value within the tolerance passes")
      call check_close([verdict%expected, verdict%found, verdict%deviation], &
         [0.5_wp, 0.5005_wp, 0.0005_wp], rounding, "expected, found and their difference")
      verdict = judge(row_of(0.5_wp, 1.0e-3_wp), 1, [outcome_of(0.4995_wp)])
      call check(verdict%passed, "a value below passes as well")
      verdict = judge(row_of(0.5_wp, 1.0e-3_wp), 1, [outcome_of(0.4985_wp)])
      call check(.not. verdict%passed, "a value beyond the tolerance fails")
      verdict = judge(row_of(0.6_wp, 1.0e-3_wp), 1, [outcome_of(0.5_wp)])
      call check(.not. verdict%passed, "a wrong expected value fails")
      verdict = judge(row_of(0.5_wp, 0.0_wp), 1, [outcome_of(0.5_wp)])
      call check(verdict%passed, "no tolerance is one")

      verdict = judge(row_of(0.5_wp, 1.0_wp), 1, [outcome_of(nan())])
      call check(.not. verdict%passed, "NaN fails")
      verdict = judge(row_of(nan(), 1.0_wp), 1, [outcome_of(0.5_wp)])
      call check(.not. verdict%passed, "NaN expected fails")
      verdict = judge(row_of(0.5_wp, nan()), 1, [outcome_of(0.5_wp)])
      call check(.not. verdict%passed, "NaN for a tolerance fails")
      verdict = judge(row_of(0.5_wp, infinite), 1, [outcome_of(0.5_wp)])
      call check(.not. verdict%passed, "an infinite tolerance fails")
      verdict = judge(row_of(0.5_wp, 1.0_wp), 1, [outcome_of(infinite)])
      call check(.not. verdict%passed, "infinity fails")

      row = row_of(6.0_wp, 1.0e-9_wp)
      row%quantity = "max_force"
      row%unit = 100.0_wp
      verdict = judge(row, 1, [outcome_of(0.5_wp)])
      call check(verdict%passed, "another quantity in another unit")
      row%quantity = "no_such_quantity"
      verdict = judge(row, 1, [outcome_of(0.5_wp)])
      call check(.not. verdict%passed, "a quantity that does not exist fails")
   end subroutine test_judge

   !> The second outcome is what is expected
   subroutine test_judge_of_pairs()
      type(row_t) :: row
      type(verdict_t) :: verdict

      row = row_of(0.0_wp, 1.0e-3_wp)
      row%twin = 2
      verdict = judge(row, 1, [outcome_of(0.5_wp), outcome_of(0.5004_wp)])
      call check(verdict%passed, "a pair that agrees passes")
      call check_close(verdict%expected, 0.5004_wp, 0.0_wp, "the second one is expected")
      verdict = judge(row, 1, [outcome_of(0.5_wp), outcome_of(0.502_wp)])
      call check(.not. verdict%passed, "a pair that does not fails")
   end subroutine test_judge_of_pairs

   !> What is found and what is expected may be made of all outcomes
   subroutine test_judge_of_measures()
      type(row_t) :: row
      type(verdict_t) :: verdict

      row = row_of(0.0_wp, rounding)
      row%measure => weighted_sum
      row%expectation => twice_the_first
      verdict = judge(row, 1, [outcome_of(0.4_wp), outcome_of(0.2_wp)])
      call check(verdict%passed, "a measure against an expectation")
      call check_close([verdict%found, verdict%expected], 0.8_wp, rounding, "both of them")
   end subroutine test_judge_of_measures

   !> No outcome, or one without separation
   subroutine test_judge_of_nothing()
      type(verdict_t) :: verdict
      type(outcome_t) :: none(0), sticking

      verdict = judge(row_of(0.5_wp, 1.0_wp), 1, none)
      call check(.not. verdict%passed, "a row without outcomes fails")
      call check(ieee_is_nan(verdict%found), "nothing was found")
      sticking = outcome_of(0.5_wp)
      sticking%status = contact_sticking
      verdict = judge(row_of(0.5_wp, 1.0_wp), 1, [sticking])
      call check(.not. verdict%passed, "a sphere that sticks has no restitution")
   end subroutine test_judge_of_nothing

   !> Every row can be read and can fail; what the rows find is tested from outside
   subroutine test_laws()
      integer, parameter :: name_width = 31
      type(law_t) :: law
      type(error_t), allocatable :: error
      type(outcome_t) :: none(0)
      type(verdict_t) :: verdict
      integer :: i, j, k, method

      do i = 1, law_count
         call build_law(i, law, error)
         call success(error, "a law is built")
         call check(len(law%title) > 0 .and. len(law%source) > 0, "a law has a title and a source")
         call check(law%count > 0, "a law has checks")
         do j = 1, law%count
            associate (this => law%checks(j))
               call check(this%count > 0 .and. size(this%strikes) > 0, "a check has rows")
               do k = 1, this%count
                  associate (row => this%rows(k))
                     call check(len_trim(row%name) <= name_width, "a name fits: "//row%name)
                     call check(len_trim(row%reason) > 0, "a tolerance has a reason: "//row%name)
                     do method = this%first, this%last
                        verdict = judge(row, method, none)
                        call check(verdict%tolerance > 0.0_wp .and. verdict%tolerance &
                           <= max(1.0e-2_wp, 0.05_wp*abs(row%expected)), "it can fail: "//row%name)
                     end do
                  end associate
               end do
            end associate
         end do
      end do
   end subroutine test_laws

   !> A wrong number is found, an impact without an end too, and the others are not touched
   subroutine test_wrong_law()
      type(law_t) :: law
      type(strike_t) :: rebound, glue
      type(verdict_t), allocatable :: verdicts(:)

      rebound = strike_t(elastic(15.0e6_wp))
      glue = strike_t(sls(15.0e6_wp, 0.0_wp, 1.0e6_wp))
      call law%begin("a law", "a source")
      call law%add_check([rebound])
      call law%add_row("right", 1.0_wp)
      call law%add_row("wrong", 0.9_wp)
      call law%add_check([glue], 'ive')
      call law%add_row("glue", 0.0_wp, more=1.0_wp, reason="any number would do")
      call law%add_row("glue again", 0.0_wp, more=1.0_wp)
      call law%add_check([rebound, glue], 'ive')
      call law%add_row("pair", more=1.0_wp, twin=2)
      call law%add_check([strike_t(elastic(-1.0_wp))], 'ive')
      call law%add_row("no material", 0.0_wp, more=1.0_wp)
      call evaluate_law(law, verdicts)
      call check(size(verdicts) == 8, "a verdict for each row and method")
      call check(all(verdicts(:4)%method == ["ive   ", "ive   ", "direct", "direct"]), &
         "all rows of a check by one method, then by the other")
      call check(verdicts(1)%passed .and. verdicts(3)%passed, "right rows pass")
      call check(.not. any(verdicts([2, 4])%passed), "a wrong number fails")
      call check_close(verdicts(2)%deviation, 0.1_wp, 1.0e-8_wp, "by as much as it is wrong")
      call check(.not. any(verdicts(5:)%passed), "impacts without an end, or none at all, fail")
      call check(all(ieee_is_nan(verdicts(5:)%found)), "and leave no number")
   end subroutine test_wrong_law

   !> Asking for too many laws is a mistake of the program
   subroutine test_law_that_does_not_exist()
      type(law_t) :: law
      type(error_t), allocatable :: error

      call build_law(law_count + 1, law, error)
      call check(allocated(error), "there is no such law")
      if (allocated(error)) call check(error%code == error_internal, "an internal error")
   end subroutine test_law_that_does_not_exist

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
