!> The file of a part of a sweep, unfinished or finished: a valid HDF5 file at any time
!>
!>     /             attributes program, version, title, case, data, points, shard, shards
!>     /summary      over the dimension `point`: swept parameters, check, columns of a summary with
!>                   numbers for texts
!>
!> HDF5 creates the file with space for all points. Every dataset is contiguous and uncompressed, so
!> its numbers have fixed positions in the file, and outcomes are written there as bytes, while
!> HDF5's own data never change again. A disk that is too small is detected at the beginning.
!>
!> A point is done if its check sum is correct. The sum is written last; after a crash of the
!> machine the disk may have any part of what was written, in any order, which the sum reveals.
!>
!> The file is made in a private directory, locked, and then linked to its name, which no other file
!> may have. So if two processes begin the same sweep, one of them gets it; the lock ends with the
!> process, however it ends. Links and pipes of that name are refused, not followed.
module vcor_io_checkpoint
   use, intrinsic :: iso_c_binding, only : c_associated, c_int, c_int64_t, c_loc, c_null_ptr, &
      c_ptr, c_size_t
   use, intrinsic :: iso_fortran_env, only : int8
   use vcor_case_grid, only : grid_t
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_file, only : close_file, create_file, discard, move_file, output_file_t, remove_file
   use vcor_io_hdf5, only : fill_hdf5
   use vcor_io_hdf5_reader, only : close_hdf5, find_dataset, open_hdf5, reader_t
   use vcor_io_identity, only : check_same, identity_t, read_identity
   use vcor_io_path, only : anything_at, check_plain, quoted_path, raise_system
   use vcor_io_posix, only : c_fclose, c_fileno, c_fopen, c_fsync, c_link, c_lockf, c_pwrite, &
      c_text, errno_exists, errno_locked, file_at, last_errno, lock_alone, open_file, same_file_id
   use vcor_io_results, only : axis_column, quantity_column
   use vcor_io_table, only : add_column, add_dimension, column_of, column_t, new_table, table_t
   use vcor_kinds, only : wp
   use vcor_io_seal, only : crc32
   use vcor_sweep_quantity, only : point_pending, quantity_t, summary_t
   use vcor_text, only : integer_text, printable
   implicit none
   private

   public :: checkpoint_t, create_checkpoint, open_checkpoint, read_points

   !> File of an unfinished sweep
   type :: checkpoint_t
      character(len=:), allocatable :: path
      !> C stream, null unless the file is open
      type(c_ptr), private :: stream = c_null_ptr
      !> Positions of columns in the file [bytes]: those of the summary in their order, then check
      integer(c_int64_t), allocatable, private :: offsets(:)
   contains
      procedure :: is_open, put, close_as, remove
      procedure :: close => close_checkpoint
   end type checkpoint_t

contains

   !> Whether the file is open
   pure function is_open(self)
      class(checkpoint_t), intent(in) :: self
      logical :: is_open

      is_open = c_associated(self%stream)
   end function is_open

   !> Create a file with the outcomes so far
   subroutine create_checkpoint(self, path, identity, grid, summary, error)
      type(checkpoint_t), intent(inout) :: self
      !> Its path, which must not exist
      character(len=*), intent(in) :: path
      type(identity_t), intent(in) :: identity
      type(grid_t), intent(in) :: grid
      !> Outcomes at all places of the part; pending ones become NaN
      type(summary_t), intent(inout) :: summary
      !> Set if the file cannot be written, or if another process has created it
      type(error_t), allocatable, intent(out) :: error

      type(output_file_t) :: file
      type(table_t) :: tables(1)

      self%path = path
      call create_file(file, path, error)
      if (allocated(error)) return
      call lay_out(tables(1), identity, grid, summary%quantities)
      call fill_hdf5(file, tables, error, identity%data, identity%part)
      if (.not. allocated(error)) call close_file(file, error)
      if (.not. allocated(error)) call attach(self, file%temporary, summary%quantities, &
         size(summary%status), error)
      if (.not. allocated(error)) call self%put(1, size(summary%status), summary, error)
      if (.not. allocated(error)) call name_file(file%temporary, path, error)
      if (allocated(error)) call self%close()
      call discard(file)
   end subroutine create_checkpoint

   !> Points of a part as a table, with columns without values
   subroutine lay_out(table, identity, grid, quantities)
      type(table_t), intent(out) :: table
      type(identity_t), intent(in) :: identity
      type(grid_t), intent(in) :: grid
      type(quantity_t), intent(in) :: quantities(:)

      type(column_t) :: check
      integer, allocatable :: points(:), places(:)
      real(wp), allocatable :: values(:)
      integer :: i, j

      call new_table(table, 'summary', identity%title, identity%case_text)
      points = [(identity%part%point(i), i=1, identity%part%count())]
      call add_dimension(table, column_of('point', points, '1', &
         'number of the point in the sweep'))
      allocate (values(size(points)))
      do j = 1, size(grid%axes)
         do i = 1, size(points)
            places = grid%places(points(i))
            values(i) = grid%axes(j)%values(places(j))
         end do
         call add_column(table, axis_column(grid%axes(j), values))
      end do
      check = column_of('check', [integer ::], '1', &
         'CRC-32 of the numbers of the summary in this row and of its number; 0: pending')
      check%length = size(points)
      call add_column(table, check)
      do i = 1, size(quantities)
         call add_column(table, quantity_column(quantities(i), size(points), as_numbers=.true.))
      end do
   end subroutine lay_out

   !> Give a file its final name
   subroutine name_file(temporary, path, error)
      character(len=*), intent(in) :: temporary
      !> Final name, which must not exist
      character(len=*), intent(in) :: path
      !> Set if the name is taken
      type(error_t), allocatable, intent(out) :: error

      logical :: is_taken

      if (c_link(c_text(temporary), c_text(path)) == 0) return
      is_taken = last_errno() == errno_exists
      if (.not. is_taken) is_taken = anything_at(path)
      if (is_taken) then
         call raise_in_use(path, error)
      else
         ! the file system has no links
         call move_file(temporary, path, error)
      end if
   end subroutine name_file

   !> Raise the error that another process uses the file
   subroutine raise_in_use(path, error)
      character(len=*), intent(in) :: path
      !> Set
      type(error_t), allocatable, intent(inout) :: error

      call raise(error, error_file, quoted_path(path) &
         //' is in use: another vcor is at work on this sweep')
   end subroutine raise_in_use

   !> Continue with an existing file
   subroutine open_checkpoint(self, path, identity, summary, error, anew)
      type(checkpoint_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      type(identity_t), intent(in) :: identity
      !> Outcomes, all pending; on return those of the file
      type(summary_t), intent(inout) :: summary
      !> Error of code `error_file` if the file belongs to another run, is not a file of a part, or
      !> is used by another process; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether to discard the outcomes of the file
      logical, intent(in) :: anew

      self%path = path
      call check_plain(path, error)
      if (allocated(error)) return
      if (anew) then
         call check_part(path, identity, error)
         if (allocated(error)) error%message = error%message &
            //'; remove it, or finish that sweep with --resume'
      else
         call read_points(path, identity, summary, error)
      end if
      if (.not. allocated(error)) &
         call attach(self, path, summary%quantities, size(summary%status), error)
      if (allocated(error) .or. .not. anew) return
      call self%put(1, size(summary%status), summary, error)
   end subroutine open_checkpoint

   !> Open an existing file for writing, and find its columns
   subroutine attach(self, place, quantities, points, error)
      type(checkpoint_t), intent(inout) :: self
      !> Its current path, which may be temporary
      character(len=*), intent(in) :: place
      type(quantity_t), intent(in) :: quantities(:)
      !> Number of points
      integer, intent(in) :: points
      !> Set if it cannot be written
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: reason

      call find_columns(place, quantities, points, self%offsets, error)
      if (allocated(error)) return
      self%stream = c_fopen(c_text(place), c_text('rb+'))
      reason = last_errno()
      if (.not. c_associated(self%stream)) then
         call raise_system(error, 'cannot write '//quoted_path(self%path), reason)
         return
      end if
      ! Not flock: HDF5 uses it for reading, and others may read this file. Closing any stream of
      ! the file releases the lock, so HDF5 comes first here. File systems without locks are
      ! accepted
      if (c_lockf(c_fileno(self%stream), lock_alone, 0_c_int64_t) /= 0) then
         if (last_errno() == errno_locked) call raise_in_use(self%path, error)
      end if
      ! refuse a link, and a file that has been replaced or removed since
      if (.not. same_file_id(file_at(place, follows=.false.), &
         open_file(c_fileno(self%stream)))) call raise_in_use(self%path, error)
      if (allocated(error)) call self%close()
   end subroutine attach

   !> Store outcomes
   subroutine put(self, first, last, summary, error)
      class(checkpoint_t), intent(in) :: self
      integer, intent(in) :: first
      integer, intent(in) :: last
      type(summary_t), intent(in), target :: summary
      !> Set if they could not be written
      type(error_t), allocatable, intent(out) :: error

      ! bytes of a number
      integer, parameter :: real_width = 8, integer_width = 4
      integer, allocatable, target :: checks(:)
      integer(c_int) :: reason
      integer :: i, n

      n = size(summary%values)
      do i = 1, n
         associate (values => summary%values(i))
            if (allocated(values%reals)) then
               call write_at(i, c_loc(values%reals(first)), real_width)
            else
               call write_at(i, c_loc(values%integers(first)), integer_width)
            end if
         end associate
      end do
      call write_at(n + 1, c_loc(summary%status(first)), integer_width)
      ! last, because a point is done if its check sum is correct
      allocate (checks, source=checks_of(summary, first, last))
      call write_at(n + 2, c_loc(checks), integer_width)

   contains

      !> Write numbers of a column to their positions
      subroutine write_at(column, numbers, width)
         integer, intent(in) :: column
         !> Address of the first number
         type(c_ptr), intent(in) :: numbers
         !> Bytes of a number
         integer, intent(in) :: width

         integer(c_size_t) :: length

         if (allocated(error)) return
         length = int(last - first + 1, c_size_t)*width
         if (c_pwrite(c_fileno(self%stream), numbers, length, self%offsets(column) &
            + int(first - 1, c_int64_t)*width) == length) return
         reason = last_errno()
         call raise_system(error, 'cannot write '//quoted_path(self%path), reason)
      end subroutine write_at
   end subroutine put

   !> Close the file and keep it
   subroutine close_checkpoint(self)
      class(checkpoint_t), intent(inout) :: self

      integer(c_int) :: ignored

      if (.not. self%is_open()) return
      ignored = c_fsync(c_fileno(self%stream))
      ignored = c_fclose(self%stream)
      self%stream = c_null_ptr
   end subroutine close_checkpoint

   !> Close the complete file and rename it
   subroutine close_as(self, path, error)
      class(checkpoint_t), intent(inout) :: self
      !> New path, in the same directory
      character(len=*), intent(in) :: path
      !> Set on failure
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: reason

      if (c_fsync(c_fileno(self%stream)) /= 0) then
         reason = last_errno()
         call raise_system(error, 'cannot write '//quoted_path(path), reason)
      end if
      call self%close()
      if (.not. allocated(error)) call move_file(self%path, path, error)
   end subroutine close_as

   !> Close the file and remove it, if it is open
   subroutine remove(self)
      class(checkpoint_t), intent(inout) :: self

      integer(c_int) :: ignored

      if (.not. self%is_open()) return
      ! removed while it is locked, before another process can use it
      call remove_file(self%path)
      ignored = c_fclose(self%stream)
      self%stream = c_null_ptr
   end subroutine remove

   !> Refuse a file that is not the expected part of a sweep
   subroutine check_part(path, expected, error)
      character(len=*), intent(in) :: path
      type(identity_t), intent(in) :: expected
      !> Error of code `error_file`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: found

      call read_identity(path, found, error)
      if (allocated(error)) return
      if (found%version == '' .or. found%part%points == 0) then
         call raise(error, error_file, quoted_path(path)//' is not a part of a sweep of vcor')
         return
      end if
      call check_same(path, found, expected, error)
      if (allocated(error)) return
      if (found%part%number /= expected%part%number &
         .or. found%part%points /= expected%part%points) &
         call raise(error, error_file, quoted_path(path)//' has other points of the sweep')
   end subroutine check_part

   !> Read the file of a part
   subroutine read_points(path, identity, summary, error)
      character(len=*), intent(in) :: path
      type(identity_t), intent(in) :: identity
      !> Outcomes of the points of the part, allocated; on return those with a wrong check sum are
      !> pending
      type(summary_t), intent(inout) :: summary
      !> Error of code `error_file` if it cannot be read, or belongs to another run
      type(error_t), allocatable, intent(out) :: error

      integer(c_int64_t), allocatable :: offsets(:)
      integer, allocatable :: checks(:)
      integer :: i, n, status, unit

      call check_part(path, identity, error)
      if (.not. allocated(error)) &
         call find_columns(path, summary%quantities, size(summary%status), offsets, error)
      if (allocated(error)) return
      n = size(summary%values)
      allocate (checks(size(summary%status)))
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', &
         action='read', iostat=status)
      if (status == 0) then
         do i = 1, n
            if (status /= 0) exit
            associate (values => summary%values(i))
               if (allocated(values%reals)) then
                  read (unit, pos=offsets(i) + 1, iostat=status) values%reals
               else
                  read (unit, pos=offsets(i) + 1, iostat=status) values%integers
               end if
            end associate
         end do
         if (status == 0) read (unit, pos=offsets(n + 1) + 1, iostat=status) summary%status
         if (status == 0) read (unit, pos=offsets(n + 2) + 1, iostat=status) checks
         close (unit)
      end if
      if (status /= 0) then
         call raise(error, error_file, printable(path)//': cannot be read')
         return
      end if
      where (checks /= checks_of(summary, 1, size(checks))) summary%status = point_pending
   end subroutine read_points

   !> Find the columns of the file of a part
   subroutine find_columns(path, quantities, points, offsets, error)
      character(len=*), intent(in) :: path
      type(quantity_t), intent(in) :: quantities(:)
      !> Number of points
      integer, intent(in) :: points
      !> Bytes before the numbers of each column: those of the summary in their order, then check
      integer(c_int64_t), allocatable, intent(out) :: offsets(:)
      !> Error of code `error_file` if a column is missing or has another layout
      type(error_t), allocatable, intent(out) :: error

      type(reader_t) :: reader
      character(len=:), allocatable :: name
      integer :: i, length

      allocate (offsets(size(quantities) + 1))
      call open_hdf5(reader, path, error)
      if (allocated(error)) return
      do i = 1, size(offsets)
         name = 'summary/check'
         if (i <= size(quantities)) name = 'summary/'//trim(quantities(i)%name)
         call find_dataset(reader, name, length, offsets(i), error)
         if (allocated(error)) exit
         if (length /= points) then
            call raise(error, error_file, reader%path//': found '//integer_text(length) &
               //" values in '"//name//"', expected "//integer_text(points))
         else if (offsets(i) < 0) then
            call raise(error, error_file, reader%path//": the dataset '"//name &
               //"' is not in one piece")
         end if
         if (allocated(error)) exit
      end do
      call close_hdf5(reader)
      if (.not. allocated(error)) return
      error%message = error%message//'; the file is damaged, or of an earlier version of vcor'
   end subroutine find_columns

   !> Check sums of points: CRC-32 of their numbers as in the file, in the order of columns, and of
   !> their places, so that exchanged points are detected
   pure function checks_of(summary, first, last) result(checks)
      type(summary_t), intent(in) :: summary
      integer, intent(in) :: first
      integer, intent(in) :: last
      !> The sums, with 1 for 0; 0 only for pending points
      integer :: checks(last - first + 1)

      integer(int8), parameter :: bytes(1) = 0_int8
      integer(int8) :: row(8*size(summary%quantities))
      integer :: i, place, n

      do place = first, last
         checks(place - first + 1) = 0
         if (summary%status(place) == point_pending) cycle
         n = 0
         do i = 1, size(summary%values)
            associate (values => summary%values(i))
               if (allocated(values%reals)) then
                  row(n + 1:n + 8) = transfer(values%reals(place), bytes)
                  n = n + 8
               else
                  row(n + 1:n + 4) = transfer(values%integers(place), bytes)
                  n = n + 4
               end if
            end associate
         end do
         row(n + 1:n + 8) = transfer([summary%status(place), place], bytes)
         checks(place - first + 1) = crc32(row(:n + 8), 0)
         if (checks(place - first + 1) == 0) checks(place - first + 1) = 1
      end do
   end function checks_of

end module vcor_io_checkpoint
