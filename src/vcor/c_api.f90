!> The C interface: the points of cases, which `vcor_c_api_cases` makes, and the columns of their
!> tables; include/vcor.h documents the functions
!>
!> Only one thread at a time handles texts, in the critical section `vcor_c_api`, because gfortran
!> 12 keeps the length of a text returned by a function in static storage. Impacts are solved
!> outside.
module vcor_c_api
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_double, c_f_pointer, c_int, &
      c_loc, c_null_char, c_null_ptr, c_ptr
   use vcor_c_api_handle, only : build, build_points, check_counts, copy_points, find_places, &
      handle_t, open_case, open_points
   use vcor_c_api_impact, only : find_columns, open_columns, refuse, solve_one, take_columns
   use vcor_c_api_values, only : c_column_t, c_numbers, demand, new_column, put_column, put_copy, &
      put_count, put_error, put_pointer, put_text, refuse_long, report_error
   use vcor_case_checks, only : validate
   use vcor_case_entries, only : address_t
   use vcor_case_grid, only : grid_t, new_grid
   use vcor_case_problem, only : problem_t
   use vcor_error, only : error_t
   use vcor_impact_history, only : history
   use vcor_impact_bounces, only : bounces_t
   use vcor_impact_outcome, only : bounces_of, outcome_t
   use vcor_impact_trajectory, only : history_steps
   use vcor_impact_validity, only : surroundings_t
   use vcor_kinds, only : wp
   use vcor_solver, only : settle
   use vcor_sweep_points, only : default_threads, failures_t, solve_point, solve_points, sweep_t, &
      worker_t
   use vcor_sweep_quantity, only : bounce_quantities, bounce_values, history_quantities, &
      new_summary, quantities, quantity_place, quantity_t, summary_t
   use vcor_text, only : integer_text
   use vcor_verify_agreement, only : compared_names
   use vcor_version, only : version
   implicit none
   private

   public :: vcor_library_version, vcor_column_of, vcor_axis, vcor_settle, vcor_solve, &
      vcor_history, vcor_bounces

   !> Tables for `vcor_column_of`
   integer(c_int), parameter :: summary_columns = 0, history_columns = 1, compared_columns = 2, &
      bounce_columns = 3
   integer :: k
   !> The version as a C string
   character(kind=c_char), target :: version_text(len(version) + 1) = &
      [(version(k:k), k=1, len(version)), c_null_char]
   !> Process that has used several threads; 0: none
   integer(c_int) :: process = 0

   interface
      !> Number of the process
      function getpid() bind(c, name='getpid') result(number)
         import :: c_int
         integer(c_int) :: number
      end function getpid
   end interface

contains

   !> Version of the library
   function vcor_library_version() bind(c) result(text)
      type(c_ptr) :: text

      text = c_loc(version_text)
   end function vcor_library_version

   !> Get the description of a column of a table
   function vcor_column_of(table, index, column) bind(c) result(found)
      integer(c_int), value :: table, index
      type(c_ptr), value :: column
      integer(c_int) :: found

      type(quantity_t), allocatable :: list(:)
      type(c_column_t) :: made
      integer :: i

!$omp critical (vcor_c_api)
      select case (table)
      case (summary_columns)
         allocate (list, source=quantities())
      case (history_columns)
         allocate (list, source=history_quantities)
      case (bounce_columns)
         allocate (list, source=bounce_quantities)
      case (compared_columns)
         allocate (list, source=quantities())
         list = list([(quantity_place(trim(compared_names(i))), i=1, size(compared_names))])
      case default
         allocate (list(0))
      end select
      found = 0
      if (c_associated(column) .and. index >= 0 .and. index < size(list)) then
         found = 1
         associate (quantity => list(index + 1))
            made = new_column(quantity%name, quantity%unit, quantity%meaning)
            if (quantity%labels /= '') call put_text('', made%unit)
            call put_text(trim(quantity%symbol), made%symbol)
            call put_text(trim(adjustl(quantity%labels)), made%labels)
            made%first = quantity%first
            made%is_whole = merge(1_c_int, 0_c_int, quantity%is_whole)
         end associate
      end if
      call put_column(column, made)
!$omp end critical (vcor_c_api)
   end function vcor_column_of

   !> Get the address and the values that a &sweep group of the case varies
   function vcor_axis(self, index, column, n, values, error) bind(c) result(code)
      type(c_ptr), value :: self
      integer(c_int), value :: index
      type(c_ptr), value :: column, n, values, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(grid_t) :: grid

      call put_column(column, c_column_t())
      call put_count(n, 0)
      call put_pointer(values, c_null_ptr)
      call open_case(self, handle, trouble)
      call demand(column, 'column', trouble)
      call demand(n, 'n', trouble)
      call demand(values, 'values', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) call validate(handle%case, trouble)
      if (.not. allocated(trouble)) call new_grid(handle%case, grid, trouble)
      if (.not. allocated(trouble)) then
         if (index >= 0 .and. index < size(grid%axes)) then
            associate (axis => grid%axes(index + 1))
               call refuse_long(axis%name, trouble)
               if (.not. allocated(trouble)) &
                  call put_copy(values, c_numbers(axis%values), trouble)
               if (.not. allocated(trouble)) then
                  call put_column(column, new_column(axis%name, axis%unit, axis%meaning))
                  call put_count(n, size(axis%values))
               end if
            end associate
         end if
      end if
!$omp end critical (vcor_c_api)
      code = report_error(trouble, error)
   end function vcor_axis

   !> Keep the mesh that suits a case for all that is solved from it later
   function vcor_settle(self, error) bind(c) result(code)
      type(c_ptr), value :: self, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(problem_t) :: problem
      type(address_t) :: none(0)
      real(wp) :: nothing(0, 1)

      call open_case(self, handle, trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) then
         if (allocated(handle%solver)) deallocate (handle%solver)
         if (allocated(handle%built_for)) deallocate (handle%built_for)
         call build(handle, none, nothing, trouble)
         problem = handle%sweep%problem
      end if
!$omp end critical (vcor_c_api)
      if (.not. allocated(trouble)) then
         call settle(problem%solver, problem%impact, trouble)
!$omp critical (vcor_c_api)
         if (allocated(trouble)) then
            trouble%message = handle%case%source//': '//trouble%message
         else
            call move_alloc(problem%solver, handle%solver)
         end if
         if (allocated(handle%built_for)) deallocate (handle%built_for)
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_settle

   !> Solve points
   function vcor_solve(self, m, address_list, n, value_table, k, column_list, result_table, &
      threads, error) bind(c) result(code)
      type(c_ptr), value :: self
      integer(c_int), value :: m
      type(c_ptr), value :: address_list
      integer(c_int), value :: n
      type(c_ptr), value :: value_table
      integer(c_int), value :: k
      type(c_ptr), value :: column_list, result_table
      integer(c_int), value :: threads
      type(c_ptr), value :: error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(c_ptr), pointer :: addresses(:), columns(:)
      real(c_double), pointer :: values(:, :), results(:, :)
      type(address_t), allocatable :: points(:)
      integer, allocatable :: places(:)
      character(len=:), allocatable :: remark
      type(outcome_t) :: outcome

      call open_case(self, handle, trouble)
      call check_counts(int(m), int(n), int(k), int(threads), trouble)
      call open_points(m, address_list, n, value_table, addresses, values, trouble)
      call open_columns(k, column_list, n, result_table, columns, results, trouble)
      if (.not. allocated(trouble)) then
         results = ieee_value(1.0_wp, ieee_quiet_nan)
!$omp critical (vcor_c_api)
         call find_columns(columns, places, trouble)
         if (.not. allocated(trouble) .and. n > 0) &
            call find_places(handle%case, addresses, points, trouble)
!$omp end critical (vcor_c_api)
      end if
      if (.not. allocated(trouble) .and. n == 1) then
         call solve_one(handle, addresses, points, values, outcome, remark, trouble)
         if (.not. allocated(trouble)) call take_columns(outcome, places, results(:, 1))
      else if (.not. allocated(trouble) .and. n > 1) then
         call solve_table(handle, addresses, points, values, places, int(threads), results, &
            remark, trouble)
      end if
      if (.not. allocated(trouble) .and. allocated(remark)) then
!$omp critical (vcor_c_api)
         if (m == 0) then
            call refuse(handle, outcome, remark, trouble)
         else if (n == 1) then
            remark = '1 of 1 points have no result, the first is point 1: '//remark
         end if
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
      if (.not. allocated(trouble) .and. allocated(remark)) call put_error(error, code, remark)
   end function vcor_solve

   !> Solve the points of a table
   subroutine solve_table(handle, addresses, points, values, places, threads, results, remark, &
                          error)
      type(handle_t), intent(inout) :: handle
      !> Addresses with values for each point as the caller has them, shape (m)
      type(c_ptr), intent(in) :: addresses(:)
      !> The addresses, shape (m)
      type(address_t), intent(in) :: points(:)
      !> Values, shape (m, n)
      real(wp), intent(in) :: values(:, :)
      !> Places of columns of the summary, shape (k)
      integer, intent(in) :: places(:)
      !> Number of threads, 0: the default
      integer, intent(in) :: threads
      !> Values of the columns, shape (k, n); NaN where there is none
      real(wp), intent(inout) :: results(:, :)
      !> How many points have no result and why; unallocated if all have one
      character(len=:), allocatable, intent(out) :: remark
      !> Error of the case, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(sweep_t) :: sweep
      type(summary_t) :: summary
      type(failures_t) :: failures
      type(surroundings_t) :: learned
      real(wp), allocatable :: numbers(:, :)
      integer(c_int) :: current
      integer :: team, i

!$omp critical (vcor_c_api)
      team = max(1, threads)
      if (threads == 0) team = default_threads()
      ! a child of fork does not have the threads of its parent
      current = getpid()
      if (process /= 0 .and. process /= current) team = 1
      if (process == 0 .and. team > 1) process = current
      call new_summary(summary, size(results, 2), error, team)
      if (.not. allocated(error)) &
         call build_points(handle, addresses, points, values, numbers, error)
      if (.not. allocated(error)) call copy_points(handle, numbers, sweep)
!$omp end critical (vcor_c_api)
      if (allocated(error)) return
      call solve_points(sweep, team, summary, failures, error, learned=learned)
!$omp critical (vcor_c_api)
      call handle%sweep%problem%surroundings%learn_from(learned)
!$omp end critical (vcor_c_api)
      do i = 1, size(places)
         if (places(i) > size(summary%values)) then
            results(i, :) = real(summary%status, wp)
         else if (allocated(summary%values(places(i))%reals)) then
            results(i, :) = summary%values(places(i))%reals
         else
            results(i, :) = real(summary%values(places(i))%integers, wp)
         end if
      end do
      if (failures%count == 0) return
!$omp critical (vcor_c_api)
      remark = integer_text(failures%count)//' of '//integer_text(size(results, 2)) &
         //' points have no result, the first is point ' &
         //integer_text(failures%kind(1)%first)//': '//failures%kind(1)%message
!$omp end critical (vcor_c_api)
   end subroutine solve_table

   !> Compute the history of a single impact
   function vcor_history(self, rows, values, error) bind(c) result(code)
      type(c_ptr), value :: self
      type(c_ptr), value :: rows, values, error
      integer(c_int) :: code

      type(error_t), allocatable :: trouble
      type(worker_t) :: worker
      type(outcome_t) :: outcome
      real(wp), allocatable :: state(:, :)

      call solve_alone(self, rows, values, worker, outcome, trouble)
      if (.not. allocated(trouble)) then
         call history(worker%problem%impact, worker%trajectory, history_steps, state)
         call put_rows(state, rows, values, trouble)
      end if
      code = report_error(trouble, error)
   end function vcor_history

   !> Compute the bounces of a single impact
   function vcor_bounces(self, rows, values, error) bind(c) result(code)
      type(c_ptr), value :: self
      type(c_ptr), value :: rows, values, error
      integer(c_int) :: code

      type(error_t), allocatable :: trouble
      type(worker_t) :: worker
      type(outcome_t) :: outcome
      type(bounces_t) :: bounces
      real(wp), allocatable :: table(:, :)
      integer :: i

      call solve_alone(self, rows, values, worker, outcome, trouble)
      if (.not. allocated(trouble)) then
         bounces = bounces_of(worker%problem%impact, worker%trajectory, outcome)
         allocate (table(size(bounce_quantities), bounces%count))
         do i = 1, bounces%count
            table(:, i) = bounce_values(i, bounces%list(i))
         end do
         call put_rows(table, rows, values, trouble)
      end if
      code = report_error(trouble, error)
   end function vcor_bounces

   !> Solve a single impact of which rows are to be handed over
   subroutine solve_alone(self, rows, values, worker, outcome, trouble)
      !> `vcor_case`
      type(c_ptr), intent(in) :: self
      !> Number of rows and the rows, set to none
      type(c_ptr), intent(in) :: rows, values
      type(worker_t), intent(out) :: worker
      type(outcome_t), intent(out) :: outcome
      !> What is wrong; unallocated on success
      type(error_t), allocatable, intent(out) :: trouble

      type(handle_t), pointer :: handle
      type(sweep_t) :: sweep
      type(address_t) :: none(0)
      real(wp) :: nothing(0, 1)

      call put_count(rows, 0)
      call put_pointer(values, c_null_ptr)
      call open_case(self, handle, trouble)
      call demand(rows, 'rows', trouble)
      call demand(values, 'values', trouble)
!$omp critical (vcor_c_api)
      if (.not. allocated(trouble)) call build(handle, none, nothing, trouble)
      if (.not. allocated(trouble)) sweep = handle%sweep
!$omp end critical (vcor_c_api)
      if (allocated(trouble)) return
      call solve_point(sweep, 1, worker, outcome, trouble)
      if (.not. allocated(trouble)) return
!$omp critical (vcor_c_api)
      trouble%message = handle%case%source//': '//trouble%message
!$omp end critical (vcor_c_api)
   end subroutine solve_alone

   !> Hand over rows
   subroutine put_rows(table, rows, values, trouble)
      !> The rows, shape (columns, rows)
      real(wp), intent(in) :: table(:, :)
      type(c_ptr), intent(in) :: rows, values
      !> What is wrong; unallocated on success
      type(error_t), allocatable, intent(out) :: trouble

      call put_copy(values, c_numbers(reshape(table, [size(table)])), trouble)
      if (.not. allocated(trouble)) call put_count(rows, size(table, 2))
   end subroutine put_rows

end module vcor_c_api
