!> What the data of the materials do not say about solved points, for the C interface;
!> include/vcor.h documents the function
module vcor_c_api_coverage
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use, intrinsic :: iso_c_binding, only : c_double, c_int, c_null_ptr, c_ptr
   use vcor_c_api_handle, only : build_own, build_points, find_places, &
      handle_t, open_case, open_points
   use vcor_c_api_values, only : c_text, demand, get_array, put_copy, put_pointer, report_error
   use vcor_case_case, only : address_t
   use vcor_error, only : error_t, error_usage, raise
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_coverage, only : find_remarks, has_data, outcomes_t, remark_length
   use vcor_sweep_points, only : sweep_t
   implicit none
   private

   public :: vcor_beyond_data

contains

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
      type(sweep_t) :: sweep
      type(address_t), allocatable :: places(:)
      type(outcomes_t) :: outcomes
      character(len=remark_length), allocatable :: remarks(:)
      character(len=:), allocatable :: lines
      integer :: i
      logical :: is_point

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
         if (m == 0) then
            call build_own(handle, sweep, is_point, trouble)
         else
            call find_places(handle%case, addresses, places, trouble)
            if (.not. allocated(trouble)) &
               call build_points(handle, places, values, sweep, trouble, addresses)
         end if
         if (.not. allocated(trouble)) then
            call find_remarks(sweep%case, sweep%grid, outcomes, .true., remarks)
            lines = ''
            do i = 1, size(remarks)
               lines = lines//trim(remarks(i))//new_line('a')
            end do
            if (has_data(sweep%case)) call put_copy(text, c_text(lines), trouble)
         end if
!$omp end critical (vcor_c_api)
      end if
      code = report_error(trouble, error)
   end function vcor_beyond_data

end module vcor_c_api_coverage
