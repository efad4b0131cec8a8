!> One solution of a case among those that are compared
module vcor_verify_attempt
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver, only : new_solver, solve_impact, solver_settings_t, solver_t
   use vcor_case_case, only : case_t
   use vcor_case_problem, only : problem_of_case, problem_t
   implicit none
   private

   public :: attempt_t

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
      !> Solve with given settings
      procedure :: try
      !> Solve as the case says
      procedure :: try_case
      !> Errors of both that it states
      procedure :: stated
      !> Whether it ended in separation
      procedure :: separated
      !> What the budget of energies misses, over the energy before the impact
      procedure :: imbalance
   end type attempt_t

contains

   !> Solve with given settings, the method being ive or direct
   subroutine try(self, settings, impact, error, lenient)
      !> The attempt
      class(attempt_t), intent(inout) :: self
      !> Settings
      type(solver_settings_t), intent(in) :: settings
      !> The impact
      type(impact_t), intent(in) :: impact
      !> What is no numerical failure; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether an error far above the accuracy is no failure; absent: it is one
      logical, intent(in), optional :: lenient

      class(solver_t), allocatable :: solver
      type(trajectory_t) :: trajectory

      self%label = settings%method
      self%time_step = settings%time_step
      if (.not. self%time_step > 0.0_wp) self%accuracy = settings%accuracy
      call new_solver(solver, settings, impact, error)
      if (allocated(error)) return
      call solve(self, solver, impact, error)
      if (.not. (present(lenient) .and. allocated(self%failure))) return
      call solver%solve(impact, trajectory, error)
      if (allocated(error)) then
         deallocate (error)
      else
         deallocate (self%failure)
         self%outcome = evaluate(impact, trajectory)
      end if
   end subroutine try

   !> Solve as the case says
   subroutine try_case(self, case, error)
      !> The attempt
      class(attempt_t), intent(inout) :: self
      !> A validated case
      type(case_t), intent(in) :: case
      !> What is no numerical failure; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(problem_t) :: problem
      character(len=:), allocatable :: scheme

      call case%get('solver', 'scheme', scheme)
      self%label = 'case: '//scheme
      if (case%given('solver', 'time_step')) call case%get('solver', 'time_step', self%time_step)
      call problem_of_case(problem, case, error)
      if (.not. allocated(error)) call solve(self, problem%solver, problem%impact, error)
   end subroutine try_case

   !> Solve
   subroutine solve(self, solver, impact, error)
      !> The attempt
      class(attempt_t), intent(inout) :: self
      !> The solver
      class(solver_t), intent(in) :: solver
      !> The impact
      type(impact_t), intent(in) :: impact
      !> What is no numerical failure; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(trajectory_t) :: trajectory

      self%made = .true.
      call solve_impact(solver, impact, trajectory, self%outcome, error)
      if (allocated(error)) then
         if (error%code /= error_numerical) return
         self%failure = error%message
         deallocate (error)
      end if
   end subroutine solve

   !> Errors of cor and cor_sphere that it states
   pure function stated(self)
      !> The attempt, separated
      class(attempt_t), intent(in) :: self
      !> Errors
      real(wp) :: stated(2)

      stated = [self%outcome%cor_error, self%outcome%cor_sphere_error]
   end function stated

   !> Whether it ended in separation
   pure function separated(self)
      !> The attempt
      class(attempt_t), intent(in) :: self
      !> Whether it did
      logical :: separated

      separated = self%made .and. .not. allocated(self%failure)
      if (separated) separated = self%outcome%status == contact_separated
   end function separated

   !> What the budget of energies misses, over the energy before the impact
   elemental function imbalance(self)
      !> The attempt, separated
      class(attempt_t), intent(in) :: self
      !> Imbalance [-]
      real(wp) :: imbalance

      imbalance = self%outcome%energy_imbalance/self%outcome%initial_energy
   end function imbalance

end module vcor_verify_attempt
