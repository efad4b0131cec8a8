!> The impact of a case file, with another velocity
program from_case
   use vcor, only : build_impact, build_solver, case_t, error_t, impact_t, outcome_t, override, &
      read_case, solve_impact, solver_t, trajectory_t
   implicit none
   type(case_t) :: case
   type(impact_t) :: impact
   class(solver_t), allocatable :: solver
   type(trajectory_t) :: trajectory
   type(outcome_t) :: outcome
   type(error_t), allocatable :: error

   call read_case(case, 'sls.nml', error)
   if (.not. allocated(error)) call override(case, 'impact.velocity=2.5', error)
   if (.not. allocated(error)) call case%validate(error)
   if (.not. allocated(error)) call build_impact(case, impact, error)
   if (.not. allocated(error)) call build_solver(case, impact, solver, error)
   if (.not. allocated(error)) call solve_impact(solver, impact, trajectory, outcome, error)
   if (allocated(error)) then
      print '(a)', error%message
      stop 1
   end if
   print '(a, f11.8, a, es8.1)', 'COR ', outcome%cor, ' +- ', outcome%cor_error
end program from_case
