!> Files of a sweep under way, and shards of a sweep: a valid HDF5 file at every moment
!>
!>     /             attributes program, version, title, case, data, points, shard, shards
!>     /summary      over the dimension `point`: what is swept, the columns of a summary, status as
!>                   a number, check
!>
!> HDF5 writes the file once, as a whole, all points pending: nan. Every dataset is in one piece and
!> uncompressed, so its numbers have a fixed place in the file, and what makes the file an HDF5 file
!> never changes again. Outcomes are written to their places by the system's `pwrite`, which is why
!> neither SIGKILL nor a crash leaves a file that HDF5 cannot open, and why a chunk costs its own
!> length only. The room is taken at the beginning: a disk that is too small is noticed then.
!>
!> The file is made in a private folder and locked before it gets its name, which it takes from no
!> other file. So of two processes that begin the same sweep one has it, and the lock goes with the
!> process, however that ends. Links and pipes of that name are refused, not followed.
module vcor_io_checkpoint
   use, intrinsic :: iso_c_binding, only : c_associated, c_int, c_int64_t, c_loc, c_null_ptr, &
      c_ptr, c_size_t
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_checkpoint_points, only : check_column, check_of, columns, dataset, read_points, &
      status_column, steps_column
   use vcor_io_file, only : make_scratch, move_file, remember, remove_file, remove_scratch
   use vcor_io_hdf5, only : write_hdf5
   use vcor_io_hdf5_reader, only : close_hdf5, find_place, open_hdf5, reader_t
   use vcor_io_identity, only : identity_t, remarks_of
   use vcor_text, only : integer_text
   use vcor_io_path, only : anything_at, check_plain, join_path, quoted_path, raise_system
   use vcor_io_posix, only : c_fclose, c_fileno, c_fopen, c_fsync, c_link, c_lockf, c_pwrite, &
      c_text, errno_exists, errno_interrupted, errno_locked, file_at, last_errno, lock_alone, &
      open_file, same_file_id, system_reason
   use vcor_io_results, only : unit_of
   use vcor_io_table, only : add_column, add_dimension, move_in_column, new_table, table_t
   use vcor_kinds, only : wp
   use vcor_case_grid, only : grid_t
   use vcor_sweep_part, only : part_t
   use vcor_sweep_quantity, only : quantities
   use vcor_sweep_summary, only : summary_t
   implicit none
   private

   public :: checkpoint_t, create_checkpoint, open_checkpoint, attach

   !> A file of a sweep under way
   type :: checkpoint_t
      !> Its path
      character(len=:), allocatable :: path
      !> Stream of C, null unless the file is open
      type(c_ptr), private :: stream = c_null_ptr
      !> Where in the file each column begins [bytes]
      integer(c_int64_t), private :: offsets(columns) = 0_c_int64_t
   contains
      !> Whether there is a file
      procedure :: is_open
      !> Keep outcomes
      procedure :: put
      !> Close the file, which stays
      procedure :: close => close_checkpoint
      !> Close the file and give it another name
      procedure :: close_as
      !> Close the file and remove it
      procedure :: remove
   end type checkpoint_t

contains

   !> Whether there is a file
   pure function is_open(self)
      !> The file
      class(checkpoint_t), intent(in) :: self
      !> Whether there is
      logical :: is_open

      is_open = c_associated(self%stream)
   end function is_open

   !> Begin a file, with what is done so far
   subroutine create_checkpoint(self, path, identity, grid, summary, error, old)
      !> The file
      type(checkpoint_t), intent(inout) :: self
      !> Its path; nothing but `old` may be there
      character(len=*), intent(in) :: path
      !> What it is about
      type(identity_t), intent(in) :: identity
      !> Grid of the sweep
      type(grid_t), intent(in) :: grid
      !> Outcomes of all places of the part; they move to a table and back
      type(summary_t), intent(inout) :: summary
      !> Set if the file cannot be written, or another process has begun it
      type(error_t), allocatable, intent(out) :: error
      !> File that it replaces, closed afterwards; there is none if it is not open or not given
      type(checkpoint_t), intent(inout), optional :: old

      type(table_t) :: table
      character(len=:), allocatable :: folder, temporary
      integer :: i, offset

      call make_scratch(folder, path, error)
      if (allocated(error)) return
      temporary = join_path(folder, 'part.h5')
      call remember(temporary)
      call summary%blank_pending()
      call begin_table(table, identity, grid)
      offset = size(table%columns)
      call add_column(table, 'check', [(check_of(summary, i), i = 1, size(summary%status))], &
         '1', 'CRC-32 of the numbers of the summary in this row and of its number; '// &
         '0: pending')
      do i = 1, size(quantities)
         call move_in_column(table, trim(quantities(i)%name), summary%values(i)%at, &
            trim(quantities(i)%unit), trim(quantities(i)%meaning))
      end do
      call move_in_column(table, 'steps', summary%steps, '1', 'number of time steps')
      call move_in_column(table, 'status', summary%status, '1', 'how the contact ended: -1 '// &
         'pending, 0 separated, 1 no_separation, 2 sticks, 3 invalid, 4 failed')
      call write_hdf5(temporary, table, error=error, remarks=remarks_of(identity), changing=columns)
      if (.not. allocated(table%fault)) then
         do i = 1, size(quantities)
            call move_alloc(table%columns(offset + 1 + i)%reals, summary%values(i)%at)
         end do
         call move_alloc(table%columns(offset + 2 + size(quantities))%integers, summary%steps)
         call move_alloc(table%columns(offset + 3 + size(quantities))%integers, summary%status)
      end if
      if (.not. allocated(error)) call attach(self, temporary, error)
      if (.not. allocated(error)) call name_file(self, path, error, old)
      if (allocated(error)) then
         call self%remove()
         ! nobody knows the other name
         i = index(error%message, temporary)
         if (i > 0) error%message = error%message(:i - 1)//path &
            //error%message(i + len(temporary):)
      end if
      call remove_scratch(temporary)
      call remove_scratch(folder)
   end subroutine create_checkpoint

   !> Give a file its name
   subroutine name_file(self, path, error, old)
      !> The file
      type(checkpoint_t), intent(inout) :: self
      !> Its name; nothing but `old` may have it
      character(len=*), intent(in) :: path
      !> Set if it cannot have the name
      type(error_t), allocatable, intent(out) :: error
      !> File that it replaces, closed afterwards
      type(checkpoint_t), intent(inout), optional :: old

      logical :: replaces, taken

      replaces = .false.
      if (present(old)) replaces = old%is_open()
      if (replaces) then
         call move_file(self%path, path, error)
         call old%close()
      else if (c_link(c_text(self%path), c_text(path)) /= 0) then
         taken = last_errno() == errno_exists
         if (.not. taken) taken = anything_at(path)
         if (taken) then
            call raise(error, error_file, in_use(path))
         else
            ! there are file systems without links
            call move_file(self%path, path, error)
         end if
      end if
      if (.not. allocated(error)) self%path = path
   end subroutine name_file

   !> What there is to say where another process is at work
   pure function in_use(path) result(text)
      !> Path of the file
      character(len=*), intent(in) :: path
      !> One line
      character(len=:), allocatable :: text

      text = quoted_path(path)//' is in use: another vcor is at work on this sweep'
   end function in_use

   !> Table of the points of a part
   subroutine begin_table(table, identity, grid)
      !> The table, without outcomes
      type(table_t), intent(out) :: table
      !> What it is about
      type(identity_t), intent(in) :: identity
      !> Grid of the sweep
      type(grid_t), intent(in) :: grid

      integer, allocatable :: points(:), places(:)
      real(wp), allocatable :: values(:)
      integer :: i, j

      call new_table(table, 'summary', identity%title, identity%case_text)
      points = [(identity%part%point(i), i = 1, identity%part%count())]
      call add_dimension(table, 'point', points, '1', 'number of the point in the sweep')
      allocate (values(size(points)))
      do j = 1, size(grid%axes)
         associate (axis => grid%axes(j))
            do i = 1, size(points)
               places = grid%places(points(i))
               values(i) = axis%values(places(j))
            end do
            call add_column(table, axis%name, values, unit_of(axis%unit), axis%meaning)
         end associate
      end do
   end subroutine begin_table

   !> Go on with a file that is there
   subroutine open_checkpoint(self, path, identity, summary, error)
      !> The file
      type(checkpoint_t), intent(inout) :: self
      !> Its path
      character(len=*), intent(in) :: path
      !> What it should be about
      type(identity_t), intent(in) :: identity
      !> Outcomes: those that the file has
      type(summary_t), intent(inout) :: summary
      !> Error of code `error_file` if the file is about something else, is no such file, or another
      !> process is at work on it; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(identity_t) :: found

      call check_plain(path, error)
      if (.not. allocated(error)) call read_points(path, found, summary, error, identity)
      if (.not. allocated(error)) call attach(self, path, error)
   end subroutine open_checkpoint

   !> Open a file that is there for writing, and learn where its columns are
   subroutine attach(self, path, error)
      !> The file
      type(checkpoint_t), intent(inout) :: self
      !> Its path
      character(len=*), intent(in) :: path
      !> Set if it cannot be written
      type(error_t), allocatable, intent(out) :: error

      type(reader_t) :: reader
      integer(c_int) :: reason
      integer :: i

      self%path = path
      call check_plain(path, error)
      if (.not. allocated(error)) call open_hdf5(reader, path, error)
      if (allocated(error)) return
      do i = 1, columns
         call find_place(reader, dataset(i), self%offsets(i), error)
         if (allocated(error)) exit
      end do
      call close_hdf5(reader)
      if (allocated(error)) then
         error%code = error_file
         return
      end if

      self%stream = c_fopen(c_text(path), c_text('rb+'))
      reason = last_errno()
      if (.not. c_associated(self%stream)) then
         call raise(error, error_file, 'cannot write '//quoted_path(path)//': '// &
            system_reason(reason))
         return
      end if
      ! Not flock, which HDF5 takes to read a file, and others may read this one. A lock goes when
      ! any stream of the file is closed, so HDF5 comes first here. Where there are no locks one
      ! goes without
      if (c_lockf(c_fileno(self%stream), lock_alone, 0_c_int64_t) /= 0) then
         reason = last_errno()
         if (reason == errno_locked) call raise(error, error_file, in_use(path))
      end if
      ! no link, and no file that has been replaced or removed since
      if (.not. same_file_id(file_at(path, follows=.false.), open_file(c_fileno(self%stream)))) &
         call raise(error, error_file, in_use(path))
      if (allocated(error)) call self%close()
   end subroutine attach

   !> Keep outcomes
   subroutine put(self, first, last, summary, error)
      !> The file
      class(checkpoint_t), intent(in) :: self
      !> First place
      integer, intent(in) :: first
      !> Last place
      integer, intent(in) :: last
      !> Outcomes of all places
      type(summary_t), intent(in), target :: summary
      !> Set if they could not be written
      type(error_t), allocatable, intent(out) :: error

      integer, target :: checks(last - first + 1)
      integer :: i

      do i = 1, size(quantities)
         call write_at(self, self%offsets(i), storage_size(1.0_wp)/8, first, last, &
            c_loc(summary%values(i)%at(first)), error)
         if (allocated(error)) return
      end do
      call write_at(self, self%offsets(steps_column), storage_size(1)/8, first, last, &
         c_loc(summary%steps(first)), error)
      if (allocated(error)) return
      call write_at(self, self%offsets(status_column), storage_size(1)/8, first, last, &
         c_loc(summary%status(first)), error)
      if (allocated(error)) return
      do i = 1, size(checks)
         checks(i) = check_of(summary, first + i - 1)
      end do
      call write_at(self, self%offsets(check_column), storage_size(1)/8, first, last, &
         c_loc(checks), error)
   end subroutine put

   !> Write numbers to their place
   subroutine write_at(self, offset, bytes, first, last, values, error)
      !> The file
      class(checkpoint_t), intent(in) :: self
      !> Where the column begins
      integer(c_int64_t), intent(in) :: offset
      !> Bytes of a number
      integer, intent(in) :: bytes
      !> First place
      integer, intent(in) :: first
      !> Last place
      integer, intent(in) :: last
      !> Address of the numbers
      type(c_ptr), intent(in) :: values
      !> Set if they could not be written
      type(error_t), allocatable, intent(out) :: error

      integer(c_size_t) :: length, done, written
      integer(c_int64_t) :: start
      integer(c_int) :: reason

      length = int(last - first + 1, c_size_t)*int(bytes, c_size_t)
      start = offset + int(first - 1, c_int64_t)*int(bytes, c_int64_t)
      done = 0_c_size_t
      do while (done < length)
         written = c_pwrite(c_fileno(self%stream), shifted(values, done), length - done, &
            start + done)
         reason = last_errno()
         if (written > 0_c_size_t) then
            done = done + written
         else if (reason /= errno_interrupted) then
            call raise(error, error_file, 'cannot write '//quoted_path(self%path)//': '// &
               system_reason(reason))
            return
         end if
      end do
   end subroutine write_at

   !> An address so many bytes further
   pure function shifted(place, bytes)
      !> The address
      type(c_ptr), intent(in) :: place
      !> Number of bytes
      integer(c_size_t), intent(in) :: bytes
      !> The address there
      type(c_ptr) :: shifted

      shifted = transfer(transfer(place, 0_c_int64_t) + int(bytes, c_int64_t), shifted)
   end function shifted

   !> Close the file, which stays
   subroutine close_checkpoint(self)
      !> The file
      class(checkpoint_t), intent(inout) :: self

      integer(c_int) :: ignored

      if (.not. self%is_open()) return
      ignored = c_fsync(c_fileno(self%stream))
      ignored = c_fclose(self%stream)
      self%stream = c_null_ptr
   end subroutine close_checkpoint

   !> Close the file, complete, and give it another name
   subroutine close_as(self, path, error)
      !> The file
      class(checkpoint_t), intent(inout) :: self
      !> Its new path, in the same folder
      character(len=*), intent(in) :: path
      !> Set if that failed
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: reason, status

      status = c_fsync(c_fileno(self%stream))
      reason = last_errno()
      call self%close()
      if (status == 0) then
         call move_file(self%path, path, error)
      else
         call raise_system(error, 'cannot write '//quoted_path(path), reason)
      end if
   end subroutine close_as

   !> Close the file and remove it; none is fine
   subroutine remove(self)
      !> The file
      class(checkpoint_t), intent(inout) :: self

      integer(c_int) :: ignored

      if (.not. self%is_open()) return
      ! while it is locked: nobody else may take it for theirs
      call remove_file(self%path)
      ignored = c_fclose(self%stream)
      self%stream = c_null_ptr
   end subroutine remove

end module vcor_io_checkpoint
