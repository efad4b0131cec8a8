!> Sweeps: the order of the grid, spacing, what is built per point, threads, failures
program test_sweep
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_error, only : error_input, error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_io_case_reader, only : override, read_case_text
   use vcor_kinds, only : wp
   use vcor_case_address, only : swept_addresses
   use vcor_case_case, only : case_t
   use vcor_case_checks, only : validate
   use vcor_case_entries, only : address_t, operator(==)
   use vcor_case_grid, only : grid_t, new_grid
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_sweep_quantity, only : new_summary, point_failed, point_invalid, point_pending, &
      quantity_place, status_name, summary_t, values_of
   use vcor_sweep_points, only : default_threads, failures_t, new_sweep, solve_point, &
      solve_points, sweep_t, worker_t
   use vcor_test_watch, only : watch_t
   use vcor_number, only : real_text, spaced
   use vcor_test, only : check, check_close, check_contains, check_text, finish, suite
   implicit none

   character(len=*), parameter :: lf = achar(10)
   character(len=*), parameter :: text = "&impact velocity = 5.0 /"//lf &
      //"&sphere radius = 0.01, material = 'steel' /"//lf &
      //"&plate half_thickness = 0.02, material = 'sls rubber' /"//lf &
      //"&material name = 'steel', model = 'rigid', density = 7800.0 /"//lf &
      //"&material name = 'sls rubber', model = 'sls', density = 1100.0, poisson_ratio = 0.5," &
      //" glassy_modulus = 15.0e6, alpha = 300.0, beta = 1200.0 /"//lf
   character(len=*), parameter :: sweeps = "&sweep parameter = 'sls_rubber.beta'" &
      //" values = 100.0, 600.0, 1200.0 /"//lf//"&sweep parameter = 'impact.velocity'" &
      //" start = -5.0, stop = 10.0, count = 4 /"//lf
   !> The same bits are asked for
   real(wp), parameter :: exact = 0.0_wp

   call suite("sweep")
   call test_spacing()
   call test_order()
   call test_grid_of_a_case()
   call test_points()
   call test_threads()
   call test_trouble()
   call test_statuses()
   call finish()

contains

   !> Values between two ends
   subroutine test_spacing()
      real(wp), parameter :: rounding = 4.0_wp*epsilon(1.0_wp)
      real(wp) :: values(7)

      call check_close(spaced(1.0_wp, 50.0_wp, 50, 'linear'), &
         spaced(1.0_wp, 50.0_wp, 50, 'linear'), exact, "the same twice")
      values = spaced(1.0_wp, 7.0_wp, 7, 'linear')
      call check_close(values, [1.0_wp, 2.0_wp, 3.0_wp, 4.0_wp, 5.0_wp, 6.0_wp, 7.0_wp], exact, &
         "whole numbers")
      values = spaced(1.0e-3_wp, 1.0e3_wp, 7, 'log')
      call check_close(values/[1.0e-3_wp, 1.0e-2_wp, 0.1_wp, 1.0_wp, 10.0_wp, 100.0_wp, &
         1000.0_wp], [1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp], rounding, "decades")
      values = spaced(0.1_wp, 0.3_wp, 7, 'log')
      call check_close(values([1, 7]), [0.1_wp, 0.3_wp], exact, "the ends are met")
      call check_close(values(2:7)/values(1:6), spread(3.0_wp**(1.0_wp/6.0_wp), 1, 6), rounding, &
         "equal ratios")
      values = spaced(0.3_wp, -0.1_wp, 7, 'linear')
      call check_close(values([1, 7]), [0.3_wp, -0.1_wp], exact, "falling values")
      call check_close(values(2:7) - values(1:6), spread(-0.4_wp/6.0_wp, 1, 6), rounding, &
         "equal steps")
      call check_close(spaced(2.0_wp, 3.0_wp, 1, 'linear'), [2.0_wp], exact, "one value")
      values = spaced(-1.0e300_wp, 1.0e300_wp, 7, 'linear')
      call check_close(values(4), 0.0_wp, exact, "no overflow")
   end subroutine test_spacing

   !> The first axis is the slowest
   subroutine test_order()
      type(grid_t) :: grid
      integer :: i, j, k, point

      allocate (grid%axes(0))
      call check(grid%count() == 1, "a grid without axes has one point")
      call check(size(grid%places(1)) == 0, "which has no places")
      deallocate (grid%axes)
      allocate (grid%axes(3))
      grid%axes(1)%values = [1.0_wp, 2.0_wp]
      grid%axes(2)%values = [1.0_wp]
      grid%axes(3)%values = [1.0_wp, 2.0_wp, 3.0_wp]
      call check(grid%count() == 6, "product of the lengths")
      point = 0
      do i = 1, 2
         do j = 1, 1
            do k = 1, 3
               point = point + 1
               call check(all(grid%places(point) == [i, j, k]), "place of a point")
            end do
         end do
      end do
   end subroutine test_order

   !> From &sweep groups to axes
   subroutine test_grid_of_a_case()
      type(case_t) :: case
      type(grid_t) :: grid
      type(error_t), allocatable :: error
      type(address_t), allocatable :: addresses(:)

      call read_case_text(case, text//sweeps, "x.nml", error)
      call check(.not. allocated(error), "the case is read")
      call validate(case, error)
      call check(.not. allocated(error), "the case is sound")
      call new_grid(case, grid, error)
      call check(.not. allocated(error), "its grid is built")
      call check(size(grid%axes) == 2, "two axes")
      call check_text(grid%axes(1)%name, "sls_rubber.beta", "name of an axis")
      call check_text(grid%axes(1)%unit, "1/s", "unit of an axis")
      call check_text(grid%axes(2)%name, "impact.velocity", "name of another")
      call check_close(grid%axes(2)%values, [-5.0_wp, 0.0_wp, 5.0_wp, 10.0_wp], exact, "values")
      allocate (addresses, source=swept_addresses(case))
      call check(all(addresses == [case%address("material", "beta", 2), &
         case%address("impact", "velocity")]), "addresses")
      call override(case, "'sls rubber'.alpha=1500", error)
      call validate(case, error)
      call check(.not. allocated(error), "what is swept contradicts nothing")
      call override(case, "sls_rubber.poisson_ratio=-1.5", error)
      call check(allocated(error), "other values are checked")
   end subroutine test_grid_of_a_case

   !> A point is the impact that the case describes with its values
   subroutine test_points()
      type(case_t) :: case, single
      type(sweep_t) :: sweep
      type(worker_t) :: worker
      type(outcome_t) :: outcome, expected
      type(problem_t) :: problem
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error
      integer :: point, places(2)

      call read_case_text(case, text//sweeps, "x.nml", error)
      call new_sweep(sweep, case, error)
      call check(.not. allocated(error), "the sweep is built")
      call check(sweep%is_grid() .and. sweep%grid%count() == 12, "it has its points")
      ! backwards, so that each point follows on a different one
      do point = 12, 1, -1
         call solve_point(sweep, point, worker, outcome, error)
         places = sweep%grid%places(point)
         if (places(1) == 1 .or. places(2) < 3) then
            call check(allocated(error), "a point that makes no sense has an error")
            if (.not. allocated(error)) cycle
            call check(error%code == error_input .and. outcome%status == point_invalid, &
               "and is invalid")
            if (places(2) < 3) call check_contains(error%message, &
               "impact.velocity is out of range", "the range is told")
            call check(all(ieee_is_nan(values_without_status(outcome))), "and has no numbers")
            cycle
         end if
         call check(.not. allocated(error), "a point is solved")
         call read_case_text(single, text, "x.nml", error)
         associate (axes => sweep%grid%axes)
            call override(single, "sls_rubber.beta="//real_text(axes(1)%values(places(1))), error)
            call override(single, "impact.velocity="//real_text(axes(2)%values(places(2))), error)
         end associate
         call problem_of_case(problem, single, error)
         call problem%solve(trajectory, expected, error)
         associate (one => values_without_status(outcome), &
                    other => values_without_status(expected))
            call check(all(ieee_is_nan(one) .eqv. ieee_is_nan(other)), "what there is")
            call check_close(pack(one, .not. ieee_is_nan(one)), &
               pack(other, .not. ieee_is_nan(one)), exact, &
               "its outcome is that of the impact by itself")
         end associate
      end do
   end subroutine test_points

   !> The same bits and failures, whatever was there before, with any number of threads
   subroutine test_threads()
      type(sweep_t) :: sweep
      type(summary_t) :: one, other
      type(failures_t) :: failures, others
      type(watch_t) :: watch
      type(error_t), allocatable :: error
      integer :: i, n, pending

      call long_sweep(sweep)
      n = sweep%grid%count()
      call new_summary(one, n, error)
      call check(.not. allocated(error), "there is room")
      call solve_points(sweep, 1, one, failures, error)
      call check(.not. allocated(error), "solved")
      call new_summary(other, n, error)
      do i = 1, n, 3
         call other%put(i, one%row(i))
      end do
      pending = count(other%status == point_pending)
      call solve_points(sweep, 2, other, others, error, watch)
      call check(watch%count == pending, "points that are pending are solved, once")
      do i = 1, n
         call check(all(transfer(one%row(i), [0]) == transfer(other%row(i), [0])), "the same bits")
      end do
      call check(failures%count == count(one%status /= contact_separated), "failures are counted")
      call check(sum(failures%kind(:failures%kinds)%count) == failures%count, "each once")
      call check(failures%count == others%count .and. failures%kinds == others%kinds, &
         "the same failures")
      do i = 1, failures%kinds
         associate (kind => failures%kind(i), again => others%kind(i))
            call check(one%status(kind%first) == kind%status, "a point of that status")
            call check(all(one%status(:kind%first - 1) /= kind%status), "is the first one")
            call check(kind%count == count(one%status == kind%status), "of so many")
            call check(kind%first == again%first, "the same first point")
            call check_text(again%message, kind%message, "the same message")
         end associate
      end do
      call check(failures%kinds > 0 .and. failures%kind(1)%status == point_invalid, &
         "some points are invalid")
      call check_contains(failures%kind(1)%message, "out of range", "the message says why")
      call check(default_threads() >= 1, "there is a thread")
   end subroutine test_threads

   !> A sweep of some points, of which some make no impact
   subroutine long_sweep(sweep)
      !> The sweep
      type(sweep_t), intent(out) :: sweep
      type(case_t) :: case
      type(error_t), allocatable :: error

      call read_case_text(case, text//sweeps//"&sweep parameter = 'sphere.radius' start = 1e-3," &
         //" stop = 1e-2, count = 40, spacing = 'log' /", "x.nml", error)
      call new_sweep(sweep, case, error)
      call check(.not. allocated(error), "the sweep is built")
   end subroutine long_sweep

   !> A monitor that cannot keep the results ends the sweep
   subroutine test_trouble()
      type(sweep_t) :: sweep
      type(summary_t) :: summary
      type(failures_t) :: failures
      type(watch_t) :: watch
      type(error_t), allocatable :: error
      integer :: n

      call long_sweep(sweep)
      n = sweep%grid%count()
      call new_summary(summary, n, error)
      watch%fails_after = 2
      call solve_points(sweep, 2, summary, failures, error, watch)
      call check(allocated(error), "failed")
      if (allocated(error)) call check_text(error%message, "injected failure", "for that reason")
      call check(watch%rounds == 2, "at once")
   end subroutine test_trouble

   !> Numbers of an outcome but its steps and status
   function values_without_status(outcome) result(values)
      !> The outcome
      type(outcome_t), intent(in) :: outcome
      !> Its numbers
      real(wp), allocatable :: values(:)

      values = values_of(outcome)
      ! validity and its cause are texts, contacts and steps are counted in any case
      values = values(:size(values) - 4)
      values = [values(:quantity_place('contacts') - 1), values(quantity_place('contacts') + 1:)]
   end function values_without_status

   !> Names of statuses
   subroutine test_statuses()
      call check_text(trim(status_name(point_invalid)), "invalid", "no impact")
      call check_text(trim(status_name(point_failed)), "failed", "no solution")
   end subroutine test_statuses

end program test_sweep
