!> What there is to say about a case and its points, for the C interface: numbers that look like
!> those in another unit, and what the data of the materials do not cover; include/vcor.h documents
!> the functions
module vcor_c_api_remarks
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use, intrinsic :: iso_c_binding, only : c_double, c_int, c_null_ptr, c_ptr
   use vcor_c_api_handle, only : build_points, check_counts, copy_points, examined_t, &
      find_places, handle_t, open_case, open_points, shortens_only
   use vcor_c_api_values, only : c_text, demand, get_array, put_copy, put_pointer, report_error
   use vcor_case_checks, only : implausible_numbers, note_length
   use vcor_case_entries, only : address_t, operator(==)
   use vcor_case_inputs, only : is_same
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_coverage, only : find_remarks, outcomes_t, remark_length
   use vcor_kinds, only : wp
   use vcor_sweep_points, only : sweep_t
   implicit none
   private

   public :: vcor_warnings, vcor_beyond_data
   public :: look, examine_impact

contains

   !> Get the numbers that look like those in another unit
   function vcor_warnings(self, m, address_list, n, value_table, text, error) bind(c) result(code)
      type(c_ptr), value :: self
      integer(c_int), value :: m
      type(c_ptr), value :: address_list
      integer(c_int), value :: n
      type(c_ptr), value :: value_table, text, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(c_ptr), pointer :: addresses(:)
      real(c_double), pointer :: values(:, :)
      type(address_t), allocatable :: places(:)
      character(len=:), allocatable :: lines

      call put_pointer(text, c_null_ptr)
      call open_case(self, handle, trouble)
      call check_counts(int(m), min(int(n), 1), 0, 0, trouble)
      call open_points(m, address_list, n, value_table, addresses, values, trouble)
      call demand(text, 'text', trouble)
      if (.not. allocated(trouble) .and. (m == 0 .or. n > 0)) then
!$omp critical (vcor_c_api)
         call find_places(handle%case, addresses, places, trouble)
         if (.not. allocated(trouble)) &
            call look(handle, addresses, places, values, lines, trouble)
         if (.not. allocated(trouble) .and. allocated(lines)) &
            call put_copy(text, c_text(lines), trouble)
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_warnings

   !> Look at the numbers of a case and its points, at those of a single point only if the case or
   !> the addresses have changed
   subroutine look(handle, addresses, places, values, lines, error)
      type(handle_t), intent(inout) :: handle
      !> Addresses as the caller has them, shape (m), and their places
      type(c_ptr), intent(in) :: addresses(:)
      type(address_t), intent(in) :: places(:)
      !> Values, shape (m, n)
      real(wp), intent(in) :: values(:, :)
      !> A line for each number that looks like one in another unit and was not handed over before;
      !> unallocated if there is none
      character(len=:), allocatable, intent(out) :: lines
      !> Error of the case, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(sweep_t) :: sweep
      character(len=note_length), allocatable :: found(:)
      character(len=note_length) :: flaw
      real(wp), allocatable :: numbers(:, :)
      integer :: i

      if (size(values, 2) <= 1) then
         if (size(places) == 0 .and. allocated(handle%tuned)) then
            if (was_looked_at(handle, handle%tuned)) return
         else
            if (was_looked_at(handle, places)) return
         end if
      end if
      call build_points(handle, addresses, places, values, numbers, error)
      if (allocated(error)) return
      call copy_points(handle, numbers, sweep)
      if (size(values, 2) <= 1) then
         handle%looked_at = places
         if (size(places) == 0 .and. allocated(handle%tuned)) handle%looked_at = handle%tuned
      end if
      call implausible_numbers(sweep%case, sweep%grid, found)
      if (.not. allocated(handle%reported)) allocate (handle%reported(0))
      do i = 1, size(found)
         ! what is wrong with a value, wherever it stands
         flaw = found(i)
         flaw = flaw(index(trim(flaw(:index(flaw, ' = ') - 1)), ' ', back=.true.) + 1:)
         if (any(handle%reported == flaw)) cycle
         handle%reported = [handle%reported, flaw]
         if (allocated(lines)) then
            lines = lines//new_line('a')//trim(found(i))
         else
            lines = trim(found(i))
         end if
      end do
   end subroutine look

   !> Whether the last single point that was looked at had values at these addresses
   pure function was_looked_at(handle, places) result(yes)
      type(handle_t), intent(in) :: handle
      type(address_t), intent(in) :: places(:)
      logical :: yes

      yes = allocated(handle%looked_at)
      if (yes) yes = size(handle%looked_at) == size(places)
      if (yes) yes = all(handle%looked_at == places)
   end function was_looked_at

   !> Get what the data of the materials do not say about points that have been solved
   function vcor_beyond_data(self, m, address_list, n, value_table, statuses, contact_times, &
      cors, text, error) bind(c) result(code)
      type(c_ptr), value :: self
      integer(c_int), value :: m
      type(c_ptr), value :: address_list
      integer(c_int), value :: n
      type(c_ptr), value :: value_table, statuses, contact_times, cors, text, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble
      type(c_ptr), pointer :: addresses(:)
      real(c_double), pointer :: values(:, :), status(:), contact_time(:), cor(:)
      type(address_t), allocatable :: places(:)
      type(outcomes_t) :: outcomes
      character(len=:), allocatable :: lines

      call put_pointer(text, c_null_ptr)
      call open_case(self, handle, trouble)
      call demand(text, 'text', trouble)
      call check_counts(int(m), int(n), 0, 0, trouble)
      call open_points(m, address_list, n, value_table, addresses, values, trouble)
      call get_array(n, statuses, 'statuses', status, trouble)
      call get_array(n, contact_times, 'contact_times', contact_time, trouble)
      call get_array(n, cors, 'cors', cor, trouble)
      if (.not. allocated(trouble) .and. n > 0) then
         allocate (outcomes%contact_time, outcomes%cor, source=contact_time)
         allocate (outcomes%known(n))
         outcomes%cor = cor
         outcomes%known = ieee_is_finite(status) .and. ieee_is_finite(contact_time) &
            .and. ieee_is_finite(cor)
         where (outcomes%known) outcomes%known = nint(status) == contact_separated
!$omp critical (vcor_c_api)
         call find_places(handle%case, addresses, places, trouble)
         if (.not. allocated(trouble)) &
            call examine(handle, addresses, places, values, outcomes, lines, trouble)
         if (.not. allocated(trouble) .and. allocated(lines)) &
            call put_copy(text, c_text(lines), trouble)
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_beyond_data

   !> Find what the data do not say about points
   subroutine examine(handle, addresses, places, values, outcomes, lines, error)
      type(handle_t), intent(inout) :: handle
      !> Addresses as the caller has them, shape (m), and their places
      type(c_ptr), intent(in) :: addresses(:)
      type(address_t), intent(in) :: places(:)
      !> Values, shape (m, n)
      real(wp), intent(in) :: values(:, :)
      type(outcomes_t), intent(in) :: outcomes
      !> A line for each remark; unallocated if no material has data of a known range
      character(len=:), allocatable, intent(out) :: lines
      !> Error of the case, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(sweep_t) :: sweep
      character(len=remark_length), allocatable :: remarks(:)
      real(wp), allocatable :: numbers(:, :)
      integer :: i

      call build_points(handle, addresses, places, values, numbers, error)
      if (allocated(error)) return
      if (.not. handle%has_data) return
      call copy_points(handle, numbers, sweep)
      call find_remarks(sweep%case, sweep%grid, outcomes, .true., remarks)
      lines = ''
      do i = 1, size(remarks)
         lines = lines//trim(remarks(i))//new_line('a')
      end do
   end subroutine examine

   !> Find what the data do not say about a single impact. It is examined only if its contact is
   !> shorter or longer than those before, of the same values but for the velocity: data that cover
   !> the shortest and the longest contact cover those between, and of these is said what is said of
   !> the two
   subroutine examine_impact(handle, addresses, places, values, outcome, lines, error)
      type(handle_t), intent(inout) :: handle
      !> Addresses as the caller has them, shape (m), and their places
      type(c_ptr), intent(in) :: addresses(:)
      type(address_t), intent(in) :: places(:)
      !> Values, shape (m, 1)
      real(wp), intent(in) :: values(:, :)
      !> Its outcome, with a result
      type(outcome_t), intent(in) :: outcome
      !> A line for each remark; unallocated if there is none
      character(len=:), allocatable, intent(out) :: lines
      !> Error of the case, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(outcomes_t) :: outcomes
      real(wp) :: shortest, longest
      logical :: is_alike, is_shorter, is_longer

      shortest = huge(shortest)
      longest = -huge(longest)
      if (outcome%status == contact_separated) then
         shortest = outcome%contact_time
         longest = outcome%contact_time
      end if
      is_alike = .false.
      if (allocated(handle%examined)) is_alike = like(handle%examined)
      if (.not. is_alike) then
         if (allocated(handle%examined)) deallocate (handle%examined)
         allocate (handle%examined)
         handle%examined%places = places
         handle%examined%values = values(:, 1)
      end if
      is_shorter = .not. is_alike .or. shortest < handle%examined%shortest
      is_longer = .not. is_alike .or. longest > handle%examined%longest
      if (is_shorter .or. is_longer) then
         outcomes = outcomes_t(known=[outcome%status == contact_separated], &
            contact_time=[outcome%contact_time], cor=[outcome%cor])
         call examine(handle, addresses, places, values, outcomes, lines, error)
         if (allocated(error) .or. .not. allocated(lines)) then
            deallocate (handle%examined)
            return
         end if
      end if
      associate (examined => handle%examined)
         if (is_shorter) examined%shortest = shortest
         if (is_shorter) examined%of_shortest = lines
         if (is_longer) examined%longest = longest
         if (is_longer) examined%of_longest = lines
         if (.not. allocated(lines)) then
            lines = examined%of_shortest
            if (lines == '' .and. shortest > examined%shortest .or. longest >= examined%longest) &
               lines = examined%of_longest
         end if
      end associate
      if (lines == '') deallocate (lines)

   contains

      !> Whether the point differs from those that were examined in the duration of its contact only
      function like(others) result(yes)
         type(examined_t), intent(in) :: others
         logical :: yes

         integer :: i

         yes = size(others%places) == size(places)
         if (yes) yes = all(others%places == places)
         do i = 1, size(places)
            if (.not. yes) exit
            yes = shortens_only(handle%case, places(i)) .or. is_same(others%values(i), values(i, 1))
         end do
      end function like
   end subroutine examine_impact

end module vcor_c_api_remarks
