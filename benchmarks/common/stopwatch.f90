!> Time per impact, as every benchmark takes it
module vcor_benchmark_stopwatch
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor, only : case_t, error_t, outcome_t, problem_of_case, problem_t, trajectory_t, &
      validate, wp
   use vcor_impact_outcome, only : evaluate
   implicit none
   private

   public :: measurement_t, measure
   public :: median, seconds, stop_on

   !> Batches whose times are compared
   integer, parameter :: batches = 15
   !> Time a batch should take at least [s]
   real(wp), parameter :: batch_time = 0.02_wp

   !> What an impact costs and gives
   type :: measurement_t
      !> Median of the CPU time per impact over the batches [us]
      real(wp) :: time = 0.0_wp
      !> Median of the deviations from it, over it [-]
      real(wp) :: spread = 0.0_wp
      !> What came out
      type(outcome_t) :: outcome
   end type measurement_t

contains

   !> Solve a case many times; impact and solver are built once, as in a sweep
   subroutine measure(case, measurement, error, untimed)
      !> The case, complete
      type(case_t), intent(in) :: case
      !> The measurement
      type(measurement_t), intent(out) :: measurement
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether one run without its time is enough; absent: no
      logical, intent(in), optional :: untimed

      type(problem_t) :: problem
      type(trajectory_t) :: trajectory
      real(wp) :: time(batches), start
      integer :: i, j, repeats

      call validate(case, error)
      if (allocated(error)) return
      call problem_of_case(problem, case, error)
      if (allocated(error)) return
      call problem%solver%solve(problem%impact, trajectory, error)
      if (allocated(error)) return
      measurement%outcome = evaluate(problem%impact, trajectory)
      if (present(untimed)) then
         if (untimed) return
      end if

      repeats = 1
      do
         start = seconds()
         do j = 1, repeats
            call problem%solver%solve(problem%impact, trajectory, error)
         end do
         if (seconds() - start > batch_time) exit
         repeats = 2*repeats
      end do
      do i = 1, batches
         start = seconds()
         do j = 1, repeats
            call problem%solver%solve(problem%impact, trajectory, error)
         end do
         time(i) = 1.0e6_wp*(seconds() - start)/real(repeats, wp)
      end do
      measurement%time = median(time)
      measurement%spread = median(abs(time - measurement%time))/measurement%time
   end subroutine measure

   !> CPU time: what other programs take of the machine does not count
   function seconds() result(time)
      !> Time [s]
      real(wp) :: time

      call cpu_time(time)
   end function seconds

   !> Median of an odd number of values
   pure function median(values) result(middle)
      !> Values, >= 0, shape (n)
      real(wp), intent(in) :: values(:)
      !> Median
      real(wp) :: middle

      real(wp) :: rest(size(values))
      integer :: i

      rest = values
      do i = 1, size(values)/2
         rest(maxloc(rest, 1)) = -1.0_wp
      end do
      middle = maxval(rest)
   end function median

   !> A benchmark has no use for errors
   subroutine stop_on(error)
      !> The error
      type(error_t), allocatable, intent(in) :: error

      if (.not. allocated(error)) return
      write (error_unit, '(a)') 'benchmark: '//error%message
      error stop
   end subroutine stop_on

end module vcor_benchmark_stopwatch
