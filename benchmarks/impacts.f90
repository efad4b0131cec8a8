!> Times of the solvers on the paper's impacts, on one core: a table to be read by hand. Each time
!> is the median of several batches, so that a disturbed batch does not count
program impacts
   use, intrinsic :: iso_fortran_env, only : output_unit
   use vcor, only : case_t, error_t, override, problem_of_case, problem_t, read_case, &
      trajectory_t, validate, wp
   use vcor_benchmark_stopwatch, only : measure, measurement_t, median, seconds, stop_on
   use vcor_solver_convolution, only : dot
   implicit none

   integer, parameter :: batches = 9
   character(len=*), parameter :: folder = 'examples/paper/'
   real(wp) :: one, two

   write (output_unit, '(a)') 'impact          settings                                        ' &
      //'us per impact   steps   error of cor'
   call report('sls', [character(len=40) :: 'solver.accuracy=1e-8'])
   call report('sls', [character(len=40) :: 'solver.accuracy=1e-6'])
   call report('sls', [character(len=40) :: 'solver.accuracy=1e-11'])
   call report('elastic', [character(len=40) :: 'solver.accuracy=1e-8'])
   call report('butyl_prony', [character(len=40) :: 'solver.accuracy=1e-8'])
   call report('sls', [character(len=40) :: 'solver.accuracy=1e-8', 'solver.volterra_order=2'])
   call report('sls', [character(len=40) :: 'solver.method=direct', 'solver.time_step=8.9436e-7'], &
      one)
   call report('sls', [character(len=40) :: 'solver.method=direct', 'solver.time_step=8.9436e-7', &
      'solver.volterra_order=2'], two)
   call report('butyl_cerf', [character(len=40) :: 'solver.accuracy=1e-8'])
   call report('butyl_cerf', [character(len=40) :: 'solver.accuracy=1e-6'])
   call report('butyl_power_law', [character(len=40) :: 'solver.accuracy=1e-8'])
   call report('butyl_power_law', [character(len=40) :: 'solver.accuracy=1e-6'])
   call report('butyl_cerf', [character(len=40) :: 'solver.method=direct', &
      'solver.time_step=5e-7'])
   call report('butyl_power_law', [character(len=40) :: 'solver.method=direct', &
      'solver.time_step=5e-7'])
   call report('sls_printed', [character(len=40) :: 'solver.scheme=adams_bashforth'])
   call report('sls_printed', [character(len=40) :: 'solver.volterra_order=2'])
   write (output_unit, '(/, a, f4.1, a)') 'second Volterra term, product, 1500 steps: ', two/one, &
      ' times the run without it (the paper: twenty times and more)'
   call sweep('butyl_power_law_printed', 'plate.waves=frozen', 'adams_bashforth, 0.4 us')
   call sweep('butyl_power_law', 'solver.accuracy=1e-8', 'ive, 1e-8')
   call sweep('butyl_prony', 'solver.accuracy=1e-8', 'ive, 1e-8')
   call history_sum(1500)

contains

   !> The paper's sweep of BUTYL over 50 velocities. (With its scheme and step it is stable above
   !> 41 m/s with the frozen plate only.)
   subroutine sweep(name, choice, label)
      !> Name of the example
      character(len=*), intent(in) :: name
      !> Override, group.key=value
      character(len=*), intent(in) :: choice
      !> What is timed
      character(len=*), intent(in) :: label

      type(case_t) :: case
      type(problem_t) :: problem
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error
      character(len=40) :: setting
      real(wp) :: time, total
      integer :: v

      call read_case(case, folder//name//'.nml', error)
      call stop_on(error)
      call override(case, choice, error)
      call stop_on(error)
      total = 0.0_wp
      do v = 1, 50
         write (setting, '(a, i0)') 'impact.velocity=', v
         call override(case, trim(setting), error)
         call stop_on(error)
         call validate(case, error)
         call stop_on(error)
         call problem_of_case(problem, case, error)
         call stop_on(error)
         time = seconds()
         call problem%solver%solve(problem%impact, trajectory, error)
         total = total + seconds() - time
         call stop_on(error)
      end do
      write (output_unit, '(a, f8.2, a)') name//', '//label//', 50 velocities: ', &
         1.0e3_wp*total, ' ms (the paper: about 6 s)'
   end subroutine sweep

   !> Time one example with some settings
   subroutine report(name, settings, per_impact)
      !> Name of the example
      character(len=*), intent(in) :: name
      !> Overrides, group.key=value
      character(len=*), intent(in) :: settings(:)
      !> Time per impact [us]
      real(wp), intent(out), optional :: per_impact

      type(case_t) :: case
      type(measurement_t) :: measurement
      type(error_t), allocatable :: error
      character(len=48) :: label
      integer :: i

      call read_case(case, folder//name//'.nml', error)
      call stop_on(error)
      label = ''
      do i = 1, size(settings)
         call override(case, trim(settings(i)), error)
         call stop_on(error)
         label = trim(label)//' '//settings(i)(index(settings(i), '.') + 1:)
      end do
      call measure(case, measurement, error)
      call stop_on(error)
      if (present(per_impact)) per_impact = measurement%time
      write (output_unit, '(a16, a48, f13.1, i8, es15.1)') name//repeat(' ', 16), adjustl(label), &
         measurement%time, measurement%outcome%steps, measurement%outcome%cor_error
   end subroutine report

   !> The history sum of product integration against plain dot products of the same lengths
   subroutine history_sum(n)
      !> Number of steps
      integer, intent(in) :: n

      real(wp), allocatable :: a(:), b(:)
      real(wp) :: ours(batches), plain(batches), total
      integer :: i, j

      allocate (a(n), b(n))
      call random_number(a)
      call random_number(b)
      total = 0.0_wp
      do i = 1, batches
         ours(i) = seconds()
         do j = 1, n
            total = total + dot(a(n - j + 1:n), b(1:j))
         end do
         ours(i) = seconds() - ours(i)
         plain(i) = seconds()
         do j = 1, n
            total = total + dot_product(a(1:j), b(1:j))
         end do
         plain(i) = seconds() - plain(i)
      end do
      write (output_unit, '(a, i0, a, 2(f8.1, a), f6.2, a)') 'history sum of ', n, ' steps: ', &
         1.0e6_wp*median(ours), ' us; intrinsic dot_product: ', 1.0e6_wp*median(plain), &
         ' us;', real(n, wp)**2/2.0e9_wp/median(ours), ' multiply-adds per ns'
      ! the sums are used, so that none is optimised away
      if (.not. total > 0.0_wp) write (output_unit, '(a)') 'impossible'
   end subroutine history_sum
end program impacts
