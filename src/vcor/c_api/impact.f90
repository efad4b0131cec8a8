!> The C interface: a single impact and what there is to say about it, in one call; include/vcor.h
!> documents the function
module vcor_c_api_impact
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only : c_associated, c_double, c_f_pointer, c_int, c_null_ptr, &
      c_ptr
   use vcor_c_api_handle, only : build, build_points, check_counts, find_places, give_back, &
      handle_t, open_case, open_points, take_worker
   use vcor_c_api_remarks, only : examine_impact, look
   use vcor_c_api_values, only : array_at, c_text, demand, put_copy, put_pointer, report_error
   use vcor_case_entries, only : address_t
   use vcor_error, only : error_input, error_numerical, error_t, error_usage, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_validity, only : level_good, levels, thresholds
   use vcor_io_posix, only : fortran => fortran_text
   use vcor_kinds, only : wp
   use vcor_sweep_points, only : name_reason, solve_numbers, without_result, worker_t
   use vcor_sweep_quantity, only : point_invalid, quantities, quantity_names, quantity_t, values_of
   use vcor_text, only : shortened
   use vcor_words, only : suggestion
   implicit none
   private

   public :: vcor_impact
   public :: open_columns, find_columns, take_columns, solve_one, refuse

   !> Columns of the summary; unallocated before the first call
   type(quantity_t), allocatable :: summary(:)

contains

   !> Solve a single impact, and say what there is to say about it
   function vcor_impact(self, m, address_list, value_list, k, column_list, result_list, units, &
      validity, beyond_data, error) bind(c) result(code)
      type(c_ptr), value :: self
      integer(c_int), value :: m
      type(c_ptr), value :: address_list, value_list
      integer(c_int), value :: k
      type(c_ptr), value :: column_list, result_list, units, validity, beyond_data, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(c_ptr), pointer :: addresses(:), columns(:)
      real(c_double), pointer :: values(:, :), results(:, :)
      type(address_t), allocatable :: points(:)
      integer, allocatable :: places(:)
      character(len=:), allocatable :: reason
      type(outcome_t) :: outcome

      call put_pointer(units, c_null_ptr)
      call put_pointer(validity, c_null_ptr)
      call put_pointer(beyond_data, c_null_ptr)
      call open_case(self, handle, trouble)
      call check_counts(int(m), 1, int(k), 0, trouble)
      call open_points(m, address_list, 1_c_int, value_list, addresses, values, trouble)
      call open_columns(k, column_list, 1_c_int, result_list, columns, results, trouble)
      if (.not. allocated(trouble)) then
         results = ieee_value(1.0_wp, ieee_quiet_nan)
!$omp critical (vcor_c_api)
         call find_columns(columns, places, trouble)
         if (.not. allocated(trouble)) call find_places(handle%case, addresses, points, trouble)
         if (.not. allocated(trouble)) &
            call put_units(handle, addresses, points, values, units, trouble)
!$omp end critical (vcor_c_api)
      end if
      if (.not. allocated(trouble)) &
         call solve_one(handle, addresses, points, values, outcome, reason, trouble)
      if (.not. allocated(trouble)) then
         call take_columns(outcome, places, results(:, 1))
!$omp critical (vcor_c_api)
         if (allocated(reason)) then
            call refuse(handle, outcome, reason, trouble)
         else
            call put_validity(handle, outcome, validity, trouble)
            if (.not. allocated(trouble)) call put_beyond_data(handle, addresses, points, values, &
               outcome, beyond_data, trouble)
         end if
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_impact

   !> Hand over the numbers that look like those in another unit, if that is asked for
   subroutine put_units(handle, addresses, places, values, text, error)
      type(handle_t), intent(inout) :: handle
      !> Addresses as the caller has them, shape (m), and their places
      type(c_ptr), intent(in) :: addresses(:)
      type(address_t), intent(in) :: places(:)
      !> Values, shape (m, 1)
      real(wp), intent(in) :: values(:, :)
      !> Address of the pointer of the caller, or null
      type(c_ptr), intent(in) :: text
      !> Error of code `error_file` if there was no memory; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(error_t), allocatable :: flaw
      character(len=:), allocatable :: lines

      if (.not. c_associated(text)) return
      ! what is wrong with the case is refused when it is solved
      call look(handle, addresses, places, values, lines, flaw)
      if (allocated(lines)) call put_copy(text, c_text(lines), error)
   end subroutine put_units

   !> Hand over the validity, if that is asked for and not good
   subroutine put_validity(handle, outcome, text, error)
      type(handle_t), intent(in) :: handle
      type(outcome_t), intent(in) :: outcome
      !> Address of the pointer of the caller, or null
      type(c_ptr), intent(in) :: text
      !> Error of code `error_file` if there was no memory; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (.not. c_associated(text) .or. outcome%validity <= level_good) return
      call put_copy(text, c_text(handle%case%source//': validity: ' &
         //trim(levels(outcome%validity))//' (' &
         //trim(thresholds(outcome%validity_cause)%measure)//')'), error)
   end subroutine put_validity

   !> Hand over what the data of the materials do not cover, if that is asked for
   subroutine put_beyond_data(handle, addresses, places, values, outcome, text, error)
      type(handle_t), intent(inout) :: handle
      !> Addresses as the caller has them, shape (m), and their places
      type(c_ptr), intent(in) :: addresses(:)
      type(address_t), intent(in) :: places(:)
      !> Values, shape (m, 1)
      real(wp), intent(in) :: values(:, :)
      type(outcome_t), intent(in) :: outcome
      !> Address of the pointer of the caller, or null
      type(c_ptr), intent(in) :: text
      !> Error of code `error_file` if there was no memory; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(error_t), allocatable :: flaw
      character(len=:), allocatable :: lines

      if (.not. c_associated(text)) return
      ! an impact that cannot be compared is no reason to lose its result
      call examine_impact(handle, addresses, places, values, outcome, lines, flaw)
      if (allocated(lines)) call put_copy(text, c_text(lines), error)
   end subroutine put_beyond_data

   !> Get the names of columns and the place of their values, as arguments have them
   subroutine open_columns(k, column_list, n, result_table, columns, results, error)
      !> Numbers of columns and of points
      integer(c_int), intent(in) :: k, n
      type(c_ptr), intent(in) :: column_list, result_table
      !> Shapes (k) and (k, n)
      type(c_ptr), pointer, intent(out) :: columns(:)
      real(c_double), pointer, intent(out) :: results(:, :)
      !> An earlier error, which is kept, or one of code `error_usage`; unallocated on success
      type(error_t), allocatable, intent(inout) :: error

      integer :: i

      nullify (columns, results)
      if (k > 0) call demand(column_list, 'columns', error)
      if (k > 0 .and. n > 0) call demand(result_table, 'results', error)
      if (allocated(error)) return
      call c_f_pointer(array_at(column_list, k), columns, [k])
      do i = 1, k
         call demand(columns(i), 'columns[i]', error)
      end do
      call c_f_pointer(array_at(result_table, min(k, n)), results, [k, n])
   end subroutine open_columns

   !> Find columns of the summary
   subroutine find_columns(names, places, error)
      !> Shape (k)
      type(c_ptr), intent(in) :: names(:)
      !> Places in `quantities`, shape (k)
      integer, allocatable, intent(out) :: places(:)
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: name
      integer :: i, j, next

      if (.not. allocated(summary)) allocate (summary, source=quantities())
      allocate (places(size(names)), source=0)
      next = 1
      do i = 1, size(names)
         name = fortran(names(i))
         ! most callers have them in their order
         do j = 1, size(summary)
            if (summary(next)%name == name) places(i) = next
            next = mod(next, size(summary)) + 1
            if (places(i) > 0) exit
         end do
         if (places(i) == 0) call raise(error, error_usage, "unknown name '"//shortened(name) &
            //"'; "//suggestion(name, quantity_names()))
         if (allocated(error)) return
      end do
   end subroutine find_columns

   !> Values of columns of the summary
   pure subroutine take_columns(outcome, places, values)
      type(outcome_t), intent(in) :: outcome
      !> From `find_columns`, shape (k)
      integer, intent(in) :: places(:)
      !> Shape (k)
      real(wp), intent(out) :: values(:)

      real(wp), allocatable :: row(:)

      allocate (row, source=values_of(outcome))
      values = row(places)
   end subroutine take_columns

   !> Solve a single impact
   subroutine solve_one(handle, addresses, places, values, outcome, reason, error)
      type(handle_t), intent(inout) :: handle
      !> Addresses as the caller has them, shape (m), and their places; shape (0): the case itself
      type(c_ptr), intent(in) :: addresses(:)
      type(address_t), intent(in) :: places(:)
      !> Values, shape (m, 1)
      real(wp), intent(in) :: values(:, :)
      !> Outcome, without numbers if it has no result
      type(outcome_t), intent(out) :: outcome
      !> Why it has no result; unallocated if it has one
      character(len=:), allocatable, intent(out) :: reason
      !> Error of the case, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(worker_t), allocatable :: worker
      type(error_t), allocatable :: trouble
      type(address_t) :: nowhere(0)
      real(wp), allocatable :: numbers(:, :)
      integer :: built
      logical :: is_point

      is_point = .true.
      do
!$omp critical (vcor_c_api)
         if (is_point) then
            call build_points(handle, addresses, places, values, numbers, error)
         else
            numbers = numbers(:0, :)
            call build(handle, nowhere, numbers, error)
         end if
         if (.not. allocated(error)) then
            call take_worker(handle, numbers(:, 1), worker, trouble)
            built = handle%builds
         end if
!$omp end critical (vcor_c_api)
         if (allocated(error)) return
         call solve_numbers(worker, outcome, trouble)
!$omp critical (vcor_c_api)
         if (any(without_result == outcome%status)) &
            call name_reason(worker%problem, outcome%status, trouble, reason)
         call give_back(handle, worker, built)
!$omp end critical (vcor_c_api)
         if (.not. allocated(reason) .or. size(places) > 0 .or. size(numbers) == 0) return
         ! the case as it is has the place of each value in its message
         is_point = .false.
         deallocate (reason)
      end do
   end subroutine solve_one

   !> Raise the error of an impact without a result
   subroutine refuse(handle, outcome, reason, error)
      type(handle_t), intent(in) :: handle
      type(outcome_t), intent(in) :: outcome
      !> In words
      character(len=*), intent(in) :: reason
      !> Of code `error_input` if the values make no impact, else `error_numerical`
      type(error_t), allocatable, intent(inout) :: error

      call raise(error, merge(error_input, error_numerical, outcome%status == point_invalid), &
         handle%case%source//': '//reason)
   end subroutine refuse

end module vcor_c_api_impact
