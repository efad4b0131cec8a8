!> The impact of a case file, with another velocity
program from_case
   use vcor, only : case_t, error_t, outcome_t, override, problem_of_case, problem_t, read_case, &
      trajectory_t, validate
   implicit none
   type(case_t) :: case
   type(problem_t) :: problem
   type(trajectory_t) :: trajectory
   type(outcome_t) :: outcome
   type(error_t), allocatable :: error

   call read_case(case, 'sls.nml', error)
   if (.not. allocated(error)) call override(case, 'impact.velocity=2.5', error)
   if (.not. allocated(error)) call validate(case, error)
   if (.not. allocated(error)) call problem_of_case(problem, case, error)
   if (.not. allocated(error)) call problem%solve(trajectory, outcome, error)
   if (allocated(error)) then
      print '(a)', error%message
      stop 1
   end if
   print '(a, f11.8, a, es8.1)', 'COR ', outcome%cor, ' +- ', outcome%cor_error
end program from_case
