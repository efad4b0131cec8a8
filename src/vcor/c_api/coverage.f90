!> What the data of the materials do not say about solved points, for the C interface;
!> include/vcor.h documents the function
module vcor_c_api_coverage
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use, intrinsic :: iso_c_binding, only : c_double, c_int, c_null_ptr, c_ptr
   use vcor_c_api_handle, only : build_own, build_points, examined_t, find_places, handle_t, &
      open_case, open_points, shortens_only
   use vcor_c_api_values, only : c_text, demand, get_array, put_copy, put_count, &
      put_pointer, report_error
   use vcor_case_entries, only : address_t, operator(==)
   use vcor_case_inputs, only : is_same
   use vcor_error, only : error_t, error_usage, raise
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_coverage, only : find_remarks, has_data, outcomes_t, remark_length
   use vcor_kinds, only : wp
   use vcor_sweep_points, only : sweep_t
   implicit none
   private

   public :: vcor_has_data, vcor_beyond_data

contains

   !> Whether a material of a body has data of a known range
   function vcor_has_data(self, has, error) bind(c) result(code)
      type(c_ptr), value :: self, has, error
      integer(c_int) :: code

      type(handle_t), pointer :: handle
      type(error_t), allocatable :: trouble

      call open_case(self, handle, trouble)
      call demand(has, 'has', trouble)
      if (.not. allocated(trouble)) then
!$omp critical (vcor_c_api)
         call put_count(has, merge(1, 0, has_data(handle%case)))
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_has_data

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
      if (.not. allocated(trouble) .and. min(m, n) < 0) call raise(trouble, error_usage, &
         'found a negative number of addresses or points')
      if (.not. allocated(trouble) .and. m == 0 .and. n > 1) call raise(trouble, error_usage, &
         'found several points without an address, expected one')
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
         if (.not. allocated(trouble)) then
            if (has_data(handle%case)) &
               call examine(handle, addresses, places, values, outcomes, lines, trouble)
         end if
         if (.not. allocated(trouble) .and. allocated(lines)) &
            call put_copy(text, c_text(lines), trouble)
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_beyond_data

   !> Find what the data do not say about points. A single point is examined only if its contact is
   !> shorter or longer than those before, of the same values but for the velocity: data that cover
   !> the shortest and the longest contact cover those between
   subroutine examine(handle, addresses, places, values, outcomes, lines, error)
      type(handle_t), intent(inout) :: handle
      !> Addresses as the caller has them, shape (m), and their places
      type(c_ptr), intent(in) :: addresses(:)
      type(address_t), intent(in) :: places(:)
      !> Values, shape (m, n)
      real(wp), intent(in) :: values(:, :)
      type(outcomes_t), intent(in) :: outcomes
      !> A line for each remark
      character(len=:), allocatable, intent(out) :: lines
      !> Error of the case, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(sweep_t) :: sweep
      character(len=remark_length), allocatable :: remarks(:)
      logical :: matters(size(places)), is_single, is_point, is_alike
      real(wp) :: shortest, longest
      integer :: i

      is_single = size(outcomes%known) == 1
      is_alike = .false.
      shortest = minval(outcomes%contact_time, mask=outcomes%known)
      longest = maxval(outcomes%contact_time, mask=outcomes%known)
      if (is_single) then
         matters = [(.not. shortens_only(handle%case, places(i)), i=1, size(places))]
         if (allocated(handle%examined)) is_alike = like(handle%examined)
      end if
      if (is_alike) then
         lines = handle%examined%lines
         if (handle%examined%shortest <= shortest .and. longest <= handle%examined%longest) return
      end if
      if (size(places) == 0) then
         call build_own(handle, sweep, is_point, error)
      else
         call build_points(handle, places, values, sweep, error, addresses)
      end if
      if (allocated(error)) return
      call find_remarks(sweep%case, sweep%grid, outcomes, .true., remarks)
      lines = ''
      do i = 1, size(remarks)
         lines = lines//trim(remarks(i))//new_line('a')
      end do
      if (.not. is_single) return
      if (.not. is_alike) then
         if (allocated(handle%examined)) deallocate (handle%examined)
         allocate (handle%examined)
         handle%examined%places = places
         handle%examined%values = values(:, 1)
         handle%examined%shortest = shortest
         handle%examined%longest = longest
      end if
      handle%examined%shortest = min(shortest, handle%examined%shortest)
      handle%examined%longest = max(longest, handle%examined%longest)
      handle%examined%lines = lines

   contains

      !> Whether the point differs from those that were examined in the duration of its contact only
      function like(others) result(yes)
         type(examined_t), intent(in) :: others
         logical :: yes

         yes = size(others%places) == size(places)
         if (yes) yes = all(others%places == places)
         if (yes) yes = all(.not. matters .or. is_same(others%values, values(:, 1)))
      end function like
   end subroutine examine

end module vcor_c_api_coverage
