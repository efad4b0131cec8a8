!> The impacts of a case with a &sweep group, on four threads
program from_sweep
   use vcor, only : case_t, error_t, failures_t, new_part, new_summary, new_sweep, read_case, &
      solve_points, summary_t, sweep_t, validate
   implicit none
   type(case_t) :: case
   type(sweep_t) :: sweep
   type(summary_t) :: summary
   type(failures_t) :: failures
   type(error_t), allocatable :: error
   integer :: n, i, cor

   call read_case(case, 'sls_velocity.nml', error)
   if (.not. allocated(error)) call validate(case, error)
   if (.not. allocated(error)) call new_sweep(sweep, case, error)
   n = 0
   if (.not. allocated(error)) n = sweep%grid%count()
   if (.not. allocated(error)) call new_summary(summary, n, error)
   if (.not. allocated(error)) &
      call solve_points(sweep, new_part(n, 1, 1), 4, summary, failures, error)
   if (allocated(error)) then
      print '(a)', error%message
      stop 1
   end if
   ! where there is no result the columns hold nan, and summary%status says why
   cor = findloc(summary%quantities%name == 'cor', .true., dim=1)
   do i = 1, n
      print '(f8.3, a, f11.8)', sweep%grid%axes(1)%values(i), ' m/s: COR ', &
         summary%values(cor)%reals(i)
   end do
end program from_sweep
