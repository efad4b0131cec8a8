!> Solutions of one case that are compared
module vcor_verify_solutions
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_richardson, only : richardson_t
   use vcor_solver, only : solve_impact, solver_t
   implicit none
   private

   public :: attempt_t, comparison_t, compared_t, object, compared_names
   public :: attempt_count, attempt_case, attempt_first, attempt_refined, attempt_halved

   !> Number of attempts
   integer, parameter :: attempt_count = 6
   !> The case's own solver, if it is none of the others
   integer, parameter :: attempt_case = 1
   !> The method that `auto` takes, at the accuracy of the case
   integer, parameter :: attempt_first = 2
   !> The internal variables, refined
   integer, parameter :: attempt_refined = 3
   !> Product integration with dt, dt/2 and dt/4
   integer, parameter :: attempt_halved(3) = [4, 5, 6]

   !> Quantities that are compared, cor first
   character(len=*), parameter :: compared_names(7) = [character(len=20) :: 'cor', 'cor_sphere', &
      'contact_time', 'max_indentation', 'max_force', 'residual_indentation', &
      'hysteresis_energy']

   !> One solution
   type :: attempt_t
      !> Whether it was tried
      logical :: made = .false.
      !> How: ive, direct, or the scheme of the case
      character(len=21) :: label = ''
      !> Accuracy that was asked for, 0 where the step is given
      real(wp) :: accuracy = 0.0_wp
      !> Step [s], 0 where it follows from the accuracy
      real(wp) :: time_step = 0.0_wp
      !> What went wrong, one line; unallocated if nothing did
      character(len=:), allocatable :: failure
      !> Outcome, if nothing went wrong
      type(outcome_t) :: outcome
      !> Distances of its cor and cor_sphere from the most accurate ones
      real(wp) :: seen(2) = 0.0_wp
   contains
      procedure :: try
      procedure :: stated
      procedure :: separated
      procedure :: imbalance
   end type attempt_t

   !> One quantity by all methods
   type :: compared_t
      character(len=20) :: name = ''
      !> Value of each attempt, NaN where there is none
      real(wp) :: value(attempt_count) = 0.0_wp
      !> Product integration, extrapolated
      type(richardson_t) :: direct
      !> The most accurate value
      real(wp) :: best = 0.0_wp
      !> What its digits are counted against: its own size, or that of what it is a part of
      real(wp) :: scale = 1.0_wp
      !> Significant digits that can be trusted
      integer :: digits = 0
   end type compared_t

   !> All of it
   type :: comparison_t
      !> Solutions, by the constants `attempt_*`
      type(attempt_t) :: attempts(attempt_count)
      !> Whether there are two methods to compare
      logical :: two_methods = .true.
      !> Whether the bodies separate in all solutions
      logical :: separated = .false.
      !> Quantities, defined if they separate
      type(compared_t) :: compared(size(compared_names))
      !> The first thing that is wrong, one line; unallocated if nothing is
      character(len=:), allocatable :: objection
   end type comparison_t

contains

   !> Solve, and keep a numerical failure
   subroutine try(self, solver, impact, error, lenient)
      class(attempt_t), intent(inout) :: self
      class(solver_t), intent(in) :: solver
      type(impact_t), intent(in) :: impact
      !> What is no numerical failure; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether an error far above the accuracy is no failure; absent: it is one
      logical, intent(in), optional :: lenient

      type(trajectory_t) :: trajectory

      self%made = .true.
      call solve_impact(solver, impact, trajectory, self%outcome, error)
      if (.not. allocated(error)) return
      if (error%code /= error_numerical) return
      self%failure = error%message
      deallocate (error)
      if (.not. present(lenient)) return
      call solver%solve(impact, trajectory, error)
      if (allocated(error)) then
         deallocate (error)
      else
         deallocate (self%failure)
         self%outcome = evaluate(impact, trajectory)
      end if
   end subroutine try

   !> Errors of cor and cor_sphere that a solution with separation states
   pure function stated(self)
      class(attempt_t), intent(in) :: self
      real(wp) :: stated(2)

      stated = [self%outcome%cor_error, self%outcome%cor_sphere_error]
   end function stated

   !> Whether it ended in separation
   pure function separated(self)
      class(attempt_t), intent(in) :: self
      logical :: separated

      separated = self%made .and. .not. allocated(self%failure)
      if (separated) separated = self%outcome%status == contact_separated
   end function separated

   !> What the budget of energies misses, over the energy before the impact [-]
   elemental function imbalance(self)
      class(attempt_t), intent(in) :: self
      real(wp) :: imbalance

      imbalance = self%outcome%energy_imbalance/self%outcome%initial_energy
   end function imbalance

   !> Note what is wrong, the first time
   pure subroutine object(self, objection)
      type(comparison_t), intent(inout) :: self
      character(len=*), intent(in) :: objection

      if (.not. allocated(self%objection)) self%objection = objection
   end subroutine object

end module vcor_verify_solutions
