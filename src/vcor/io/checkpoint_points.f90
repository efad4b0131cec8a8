!> What a file of a sweep under way holds: its columns and check sums, and how they are read back
!>
!> A point is done if its check sum is right. It is written last; after a crash of the machine the
!> disk may have any part of what was written, in any order, and the sum tells.
module vcor_io_checkpoint_points
   use, intrinsic :: iso_fortran_env, only : int8
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_table, only : column_t, integer_column, real_column, text_column, text_value
   use vcor_io_hdf5_reader, only : close_hdf5, open_hdf5, read_column, reader_t
   use vcor_io_identity, only : check_same, identity_t, read_identity
   use vcor_io_path, only : quoted_path
   use vcor_kinds, only : wp
   use vcor_numeric_crc, only : crc32
   use vcor_sweep_quantity, only : point_pending, quantities, status_code
   use vcor_sweep_summary, only : summary_t
   implicit none
   private

   public :: read_points, read_results, check_of, dataset
   public :: columns, steps_column, status_column, check_column

   !> The columns, that is the quantities, steps, status and check
   integer, parameter :: columns = size(quantities) + 3, steps_column = size(quantities) + 1, &
      status_column = size(quantities) + 2, check_column = size(quantities) + 3

contains

   !> Read a file
   subroutine read_points(path, identity, summary, error, expected)
      !> Its path
      character(len=*), intent(in) :: path
      !> What it is about
      type(identity_t), intent(out) :: identity
      !> Outcomes of its points; there is room for all of them if `expected` is given, otherwise
      !> they are pending afterwards where there is no room
      type(summary_t), intent(inout) :: summary
      !> Set if it cannot be read, or is not about what is expected
      type(error_t), allocatable, intent(out) :: error
      !> What it should be about; nothing but this is read without it
      type(identity_t), intent(in), optional :: expected

      integer, allocatable :: checks(:)
      integer :: i
      logical :: is_ours

      call read_identity(path, identity, is_ours, error)
      if (allocated(error)) return
      if (.not. is_ours .or. identity%part%points == 0) then
         call raise(error, error_file, quoted_path(path)//' is not a part of a sweep of vcor')
         return
      end if
      if (.not. present(expected)) return
      call check_same(path, identity, expected, error)
      if (allocated(error)) return
      if (identity%part%number /= expected%part%number &
         .or. identity%part%points /= expected%part%points) then
         call raise(error, error_file, quoted_path(path)//' has other points of the sweep')
         return
      end if
      allocate (checks(size(summary%status)))
      call read_columns(path, summary, error, checks)
      if (allocated(error)) return
      do i = 1, size(checks)
         if (checks(i) == check_of(summary, i)) cycle
         summary%status(i) = point_pending
         summary%steps(i) = 0
      end do
   end subroutine read_points

   !> Read the results of a finished sweep, as its file has them
   subroutine read_results(path, summary, error)
      !> Its path
      character(len=*), intent(in) :: path
      !> Outcomes, with room for all of its points
      type(summary_t), intent(inout) :: summary
      !> Error of code `error_file` if they cannot be read
      type(error_t), allocatable, intent(out) :: error

      call read_columns(path, summary, error)
   end subroutine read_results

   !> Read all columns of a file
   subroutine read_columns(path, summary, error, checks)
      !> Its path
      character(len=*), intent(in) :: path
      !> Outcomes, with room for all of its points
      type(summary_t), intent(inout) :: summary
      !> Error of code `error_file` if they cannot be read
      type(error_t), allocatable, intent(out) :: error
      !> Check sums, shape (points); a file without them has the status as text
      integer, intent(inout), optional :: checks(:)

      type(reader_t) :: reader
      type(column_t) :: column
      integer :: i, points

      points = size(summary%status)
      call open_hdf5(reader, path, error)
      if (allocated(error)) return
      do i = 1, size(quantities)
         call read_column(reader, dataset(i), real_column, points, column, error)
         if (allocated(error)) exit
         call move_alloc(column%reals, summary%values(i)%at)
      end do
      if (.not. allocated(error)) &
         call read_column(reader, dataset(steps_column), integer_column, points, column, error)
      if (.not. allocated(error)) call move_alloc(column%integers, summary%steps)
      if (.not. allocated(error)) call read_column(reader, dataset(status_column), &
         merge(integer_column, text_column, present(checks)), points, column, error)
      if (.not. allocated(error)) then
         if (present(checks)) then
            summary%status = column%integers
            call read_column(reader, dataset(check_column), integer_column, points, column, error)
            if (.not. allocated(error)) checks = column%integers
         else
            summary%status = [(status_code(text_value(column, i)), i=1, points)]
         end if
      end if
      call close_hdf5(reader)
      if (allocated(error)) error%code = error_file
   end subroutine read_columns

   !> Path of the dataset of a column
   pure function dataset(column) result(path)
      !> Number of the column
      integer, intent(in) :: column
      !> Its path in the file
      character(len=:), allocatable :: path

      select case (column)
      case (steps_column)
         path = 'steps'
      case (status_column)
         path = 'status'
      case (check_column)
         path = 'check'
      case default
         path = trim(quantities(column)%name)
      end select
      path = 'summary/'//path
   end function dataset

   !> Check sum of a point: CRC-32 of its numbers as the file has them, quantities, steps, status,
   !> and of its place, so that two points that have changed places are found
   pure function check_of(summary, place) result(check)
      !> Outcomes
      type(summary_t), intent(in) :: summary
      !> Place of the point
      integer, intent(in) :: place
      !> The sum, 1 in place of 0; 0 where the point is pending, and nowhere else
      integer :: check

      integer(int8), parameter :: bytes(1) = 0_int8
      real(wp) :: values(size(quantities))
      integer :: i

      check = 0
      if (summary%status(place) == point_pending) return
      do i = 1, size(quantities)
         values(i) = summary%values(i)%at(place)
      end do
      check = crc32([transfer(values, bytes), &
         transfer([summary%steps(place), summary%status(place), place], bytes)], 0)
      if (check == 0) check = 1
   end function check_of

end module vcor_io_checkpoint_points
