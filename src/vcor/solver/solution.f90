!> From a solver and an impact to its outcome, or why there is none: the one place where a result is
!> held against the accuracy that was asked for
module vcor_solver_solution
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver_type, only : solver_t
   implicit none
   private

   public :: solve_impact

contains

   !> Solve an impact
   subroutine solve_impact(solver, impact, trajectory, outcome, error)
      !> The solver
      class(solver_t), intent(in) :: solver
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its course
      type(trajectory_t), intent(inout) :: trajectory
      !> Its outcome; one that is no separation has a status and no numbers
      type(outcome_t), intent(out) :: outcome
      !> Error of code `error_numerical` if the solution fails, is far from the accuracy asked for
      !> or leaves the range of the numbers; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: advice(2) = [character(len=59) :: &
         "use method = 'direct' or give a larger solver.accuracy", &
         'give a larger solver.accuracy or a shorter solver.time_step']

      call solver%solve(impact, trajectory, error)
      if (allocated(error)) return
      outcome = evaluate(impact, trajectory)
      if (outcome%status /= contact_separated) return
      if (.not. outcome%is_finite()) then
         call raise(error, error_numerical, 'the numbers of this impact are beyond all that can ' &
            //'be computed')
      else if (trajectory%misses_by_far()) then
         call raise(error, error_numerical, 'the estimated error of cor, ' &
            //as_text(max(outcome%cor_error, outcome%cor_sphere_error)) &
            //', is more than a hundred times the accuracy asked for, '//as_text(outcome%accuracy) &
            //': '//trim(advice(merge(1, 2, trajectory%stages > 0))))
      end if
   end subroutine solve_impact

   !> A number as text, of fixed length: gfortran 12 keeps the length of a text of deferred length
   !> that a function returns in static storage, where threads collide
   pure function as_text(number) result(text)
      !> The number, > 0
      real(wp), intent(in) :: number
      !> Such as 1.0E-08
      character(len=7) :: text

      write (text, '(es7.1)') number
   end function as_text

end module vcor_solver_solution
