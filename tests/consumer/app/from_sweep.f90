!> The impacts of a case with a &sweep group, on four threads
program from_sweep
   use vcor, only : case_t, error_t, failures_t, new_sweep, read_case, solve_sweep, summary_t, &
      sweep_t, validate
   implicit none
   type(case_t) :: case
   type(sweep_t) :: sweep
   type(summary_t) :: summary
   type(failures_t) :: failures
   type(error_t), allocatable :: error
   integer :: i, cor

   call read_case(case, 'sls_velocity.nml', error)
   if (.not. allocated(error)) call validate(case, error)
   if (.not. allocated(error)) call new_sweep(sweep, case, error)
   if (.not. allocated(error)) call solve_sweep(sweep, 4, summary, failures, error)
   if (allocated(error)) then
      print '(a)', error%message
      stop 1
   end if
   ! where there is no result the columns hold nan, and summary%status says why
   cor = findloc(summary%quantities%name == 'cor', .true., dim=1)
   do i = 1, sweep%grid%count()
      print '(f8.3, a, f11.8)', sweep%grid%axes(1)%values(i), ' m/s: COR ', &
         summary%values(cor)%reals(i)
   end do
end program from_sweep
