!> Reads text files as a whole, writes files that appear complete or not at all, and standard output
!>
!> A file is written under a temporary name, NAME.vcor.tmp, in the same folder. The name is one that
!> only vcor gives: a NAME.tmp may be a file of the user's. It is created exclusively, written,
!> written through to the disk and renamed, with the permissions that the umask leaves; every status
!> is checked. So the final name has the old file or the new one, whenever the process, the disk or
!> the power fails.
!>
!>  - On failure the temporary file is removed. A killed process leaves it behind, and the next one
!>    removes it and begins its own. Of two processes that write the same name at once the one that
!>    began first finds that its temporary file is gone and fails, and the other one succeeds.
!>  - A symbolic link of the final name, or of the temporary one, is replaced by the file; its
!>    target is unchanged.
!>  - A directory, a device or a pipe of the final name, or a link to one, is refused: `/dev/stdout`
!>    would otherwise become a file.
!>  - Trailing blanks of a path are ignored, as by Fortran's `open`.
!>
!> Every error is an `error_file` with the path and the reason of the system. Only one thread writes
!> files at a time.
module vcor_io_file
   use, intrinsic :: iso_c_binding, only : c_associated, c_int, c_int64_t, c_null_ptr, c_ptr, &
      c_size_t
   use vcor_error, only : error_file, error_input, error_t, raise
   use vcor_io_path, only : check_name, check_readable, directory_exists, file_exists, &
      plain_file_exists, quoted_path, raise_system
   use vcor_io_posix, only : c_fallocate, c_fclose, c_fileno, c_fopen, c_fsync, c_isatty, &
      c_rename, c_text, c_unlink, c_write, errno_interrupted, file_at, file_id_t, &
      last_errno, open_file, same_file_id, standard_error, standard_output
   use vcor_text, only : buffer_t, integer_text, printable, shortened
   implicit none
   private

   public :: read_text_file
   public :: output_file_t, create_file, put, reserve, commit, discard, write_file
   public :: remove_file
   public :: write_all, write_stdout, write_terminal, stderr_is_terminal

   !> An output file: `create_file`, any number of `put`, then `commit` or `discard`. A procedure
   !> that fails discards the file
   type :: output_file_t
      !> Path until `commit`
      character(len=:), allocatable :: temporary
      !> Final path
      character(len=:), allocatable :: path
      !> Path by which a library opens this file, whatever becomes of its name
      character(len=:), allocatable :: opened
      !> C stream, null unless the file is open
      type(c_ptr), private :: stream = c_null_ptr
   end type output_file_t

   !> End of the temporary names, which no file has that vcor has not written
   character(len=*), parameter :: temporary_end = '.vcor.tmp'
   !> Longest name of a file that Linux takes [bytes]
   integer, parameter :: longest_name = 255
   !> Largest file that is read [bytes]; a case has a few hundred bytes, a long Prony series a few
   !> thousand, a table of 10,000 points half a million
   integer, parameter :: largest_file = 4*1024**2

contains

   !> Read a text file, or a pipe, whose size is unknown, unchanged
   subroutine read_text_file(path, text, error, kind)
      character(len=*), intent(in) :: path
      character(len=:), allocatable, intent(out) :: text
      !> Error of code `error_file` if it cannot be read, `error_input` if it is too large
      type(error_t), allocatable, intent(out) :: error
      !> Kind of file expected, for messages; absent: a case file
      character(len=*), intent(in), optional :: kind

      type(buffer_t) :: buffer
      character(len=256) :: message
      character(len=:), allocatable :: expected, failed
      character :: byte
      integer :: unit, status

      expected = 'a case file'
      if (present(kind)) expected = kind
      call check_readable(path, expected, error)
      if (allocated(error)) return
      failed = 'open'
      open (newunit=unit, file=trim(path), status='old', action='read', access='stream', &
         form='unformatted', iostat=status, iomsg=message)
      if (status == 0) then
         failed = 'read'
         do while (status == 0 .and. buffer%length <= largest_file)
            read (unit, iostat=status, iomsg=message) byte
            if (status == 0) call buffer%add(byte)
         end do
         close (unit)
      end if
      text = buffer%text()
      if (status == 0) then
         call raise(error, error_input, printable(path)//': the file is larger than 4 MB, ' &
            //'expected '//expected)
      else if (.not. is_iostat_end(status)) then
         ! the reason of the system follows the name of the file
         call raise(error, error_file, printable(path)//': cannot '//failed//' the file: ' &
            //shortened(trim(adjustl(message(index(message, ': ', back=.true.) + 1:)))))
      end if
   end subroutine read_text_file

   !> Create a file; nothing has its final name before `commit`
   subroutine create_file(file, path, error)
      type(output_file_t), intent(out) :: file
      !> Final path; its directory must exist
      character(len=*), intent(in) :: path
      !> Set if the file cannot be created
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: reason
      integer :: separator

      call check_target(path, error)
      if (allocated(error)) return
      file%path = trim(path)
      ! of a name as long as the system takes it, the end
      separator = index(file%path, '/', back=.true.)
      file%temporary = file%path(:separator)//file%path(max(separator, &
         len(file%path) - longest_name + len(temporary_end)) + 1:)//temporary_end
      call remove_file(file%temporary)
      file%stream = c_fopen(c_text(file%temporary), c_text('w+x'))
      reason = last_errno()
      if (c_associated(file%stream)) then
         file%opened = '/dev/fd/'//integer_text(int(c_fileno(file%stream)))
         return
      end if
      call raise_system(error, 'cannot write '//quoted_path(file%path), reason)
      ! a folder of this name, or of another process
      deallocate (file%temporary)
   end subroutine create_file

   !> Write to a file
   subroutine put(file, text, error)
      !> Open file; discarded on failure
      type(output_file_t), intent(inout) :: file
      !> Text, written unchanged
      character(len=*), intent(in) :: text
      !> Set if the text could not be written completely
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: reason

      call write_all(c_fileno(file%stream), text, reason)
      if (reason /= 0) call fail(file, reason, error)
   end subroutine put

   !> Allocate disk space for HDF5, which writes to the file by its path `opened` and may leave it
   !> shorter
   subroutine reserve(file, bytes, error)
      !> Open file; discarded on failure
      type(output_file_t), intent(inout) :: file
      !> Length of the file [bytes]
      integer(c_int64_t), intent(in) :: bytes
      !> Set if there is not enough space
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: reason

      reason = c_fallocate(c_fileno(file%stream), 0_c_int64_t, bytes)
      if (reason /= 0) call fail(file, reason, error)
   end subroutine reserve

   !> Close a file and give it its final name
   subroutine commit(file, error)
      !> Open file; closed on return
      type(output_file_t), intent(inout) :: file
      !> Set if the file is not complete; it is discarded then
      type(error_t), allocatable, intent(out) :: error

      type(file_id_t) :: written, named
      integer(c_int) :: reason, status

      status = c_fsync(c_fileno(file%stream))
      reason = last_errno()
      written = open_file(c_fileno(file%stream))
      named = file_at(file%temporary, follows=.false.)
      if (.not. same_file_id(written, named)) then
         call raise(error, error_file, 'cannot write '//quoted_path(file%path)//': ' &
            //quoted_path(file%temporary)//' was deleted or replaced while it was written')
         ! the name is another's
         deallocate (file%temporary)
         call discard(file)
         return
      end if
      if (status == 0) then
         status = c_fclose(file%stream)
         reason = last_errno()
         file%stream = c_null_ptr
      end if
      if (status == 0) then
         status = c_rename(c_text(file%temporary), c_text(file%path))
         reason = last_errno()
      end if
      if (status == 0) deallocate (file%temporary)
      if (status /= 0) call fail(file, reason, error)
   end subroutine commit

   !> Discard a file, and leave the final path as it is. A file that is not open is ignored
   subroutine discard(file)
      !> Open file; closed on return
      type(output_file_t), intent(inout) :: file

      integer(c_int) :: ignored

      if (c_associated(file%stream)) ignored = c_fclose(file%stream)
      file%stream = c_null_ptr
      if (.not. allocated(file%temporary)) return
      call remove_file(file%temporary)
      deallocate (file%temporary)
   end subroutine discard

   !> Write a file in one call
   subroutine write_file(path, text, error)
      !> Name of the file; an existing one is replaced
      character(len=*), intent(in) :: path
      !> Text, written unchanged
      character(len=*), intent(in) :: text
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      type(output_file_t) :: file

      call create_file(file, path, error)
      if (.not. allocated(error)) call put(file, text, error)
      if (.not. allocated(error)) call commit(file, error)
   end subroutine write_file

   !> Check that a path may be written to
   subroutine check_target(path, error)
      character(len=*), intent(in) :: path
      !> Set if it may not
      type(error_t), allocatable, intent(out) :: error

      call check_name(path, error)
      if (allocated(error)) return
      if (path == '') then
         call raise(error, error_file, 'cannot write a file without a name')
      else if (directory_exists(path)) then
         call refuse('it is a directory, expected the name of a file')
      else if (index(path, '/', back=.true.) == len_trim(path)) then
         call refuse('it ends with a slash, expected the name of a file')
      else if (file_exists(path)) then
         if (.not. plain_file_exists(path)) &
            call refuse('it is a device or a pipe, expected a file or nothing there')
      end if

   contains

      !> Refuse the name
      subroutine refuse(reason)
         character(len=*), intent(in) :: reason

         call raise(error, error_file, 'cannot write '//quoted_path(path)//': '//reason)
      end subroutine refuse
   end subroutine check_target

   !> Discard a file, with an error of the system
   subroutine fail(file, reason, error)
      !> Open file; closed on return
      type(output_file_t), intent(inout) :: file
      integer(c_int), intent(in) :: reason
      !> Set to the reason
      type(error_t), allocatable, intent(inout) :: error

      call discard(file)
      call raise_system(error, 'cannot write '//quoted_path(file%path), reason)
   end subroutine fail

   !> Remove a file if it exists
   subroutine remove_file(path)
      character(len=*), intent(in) :: path

      integer(c_int) :: ignored

      ignored = c_unlink(c_text(path))
   end subroutine remove_file

   !> Write to standard output, unbuffered, so that a full disk or a closed output is detected
   subroutine write_stdout(text, error)
      !> Text, written unchanged
      character(len=*), intent(in) :: text
      !> Set if the text could not be written completely
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: reason

      call write_all(standard_output, text, reason)
      if (reason /= 0) call raise_system(error, 'cannot write the standard output', reason)
   end subroutine write_stdout

   !> Write a text completely, in as many calls as necessary
   subroutine write_all(descriptor, text, reason)
      integer(c_int), intent(in) :: descriptor
      character(len=*), intent(in) :: text
      !> Value of `errno` on failure; 0 on success
      integer(c_int), intent(out) :: reason

      integer(c_size_t) :: first, length, written

      reason = 0
      length = len(text, kind=c_size_t)
      first = 1_c_size_t
      do while (first <= length)
         written = c_write(descriptor, text(first:), length - first + 1_c_size_t)
         if (written >= 0_c_size_t) then
            first = first + written
            cycle
         end if
         reason = last_errno()
         if (reason /= errno_interrupted) return
         reason = 0
      end do
   end subroutine write_all

   !> Whether standard error is a terminal
   function stderr_is_terminal() result(is_one)
      logical :: is_one

      is_one = c_isatty(standard_error) == 1
   end function stderr_is_terminal

   !> Write to standard error, unbuffered; failures are ignored
   subroutine write_terminal(text)
      !> Text, written unchanged
      character(len=*), intent(in) :: text

      integer(c_size_t) :: ignored

      ignored = c_write(standard_error, text, len(text, kind=c_size_t))
   end subroutine write_terminal

end module vcor_io_file
