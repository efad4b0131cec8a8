!> Files that are there as a whole or not at all, and the standard output
!>
!> A file is written in a private folder (`vcor_io_scratch`) in its own directory, with every status
!> checked, gets the permissions that the user's umask leaves, is closed, and renamed only then. If
!> anything fails it is removed and what was there under the real name is untouched.
!>
!>  - An interrupted process leaves nothing under the real name. There is no `fsync`: it takes 2 to
!>    10 ms per file, as long as an impact with all the rest, and only a power failure within
!>    seconds makes a difference. A full disk is seen without it.
!>  - A symbolic link under the real name is replaced by the file; what it points at stays as it is.
!>  - A directory, a device or a pipe under the real name, or a link to one, is never replaced but
!>    refused: `/dev/stdout` would else become a file.
!>  - Blanks at the end of a path do not count, as in Fortran's `open`.
!>
!> Every error is an `error_file` with the path and the system's reason.
module vcor_io_file
   use, intrinsic :: iso_c_binding, only : c_associated, c_int, c_null_ptr, c_ptr, c_size_t
   use, intrinsic :: iso_fortran_env, only : output_unit
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_path, only : check_name, directory_exists, file_exists, quoted_path, raise_system
   use vcor_io_posix, only : c_close, c_fchmod, c_fclose, c_fdopen, c_fflush, c_fileno, c_fwrite, &
      & c_isatty, c_rename, c_text, c_umask, c_unlink, c_write, all_permissions, &
      & errno_interrupted, file_permissions, is_regular, last_errno, standard_error, &
      & standard_output
   use vcor_io_scratch, only : forget, make_scratch, make_scratch_file, remove_scratch
   implicit none
   private

   public :: output_file_t, create_file, put, commit, discard
   public :: check_target, write_file, write_stdout, write_terminal, stderr_is_terminal
   public :: move_file, remove_file

   !> A file that is being written: `create_file`, any number of `put`, then `commit` or `discard`
   !>
   !> A procedure that fails discards the file by itself.
   type :: output_file_t
      private
      !> Stream of C, null unless the file is open
      type(c_ptr) :: stream = c_null_ptr
      !> The real name
      character(len=:), allocatable :: path
      !> The private folder that it is in until `commit`
      character(len=:), allocatable :: folder
      !> Its name there
      character(len=:), allocatable :: temporary
   end type output_file_t

contains

   !> Begin a file: nothing is seen under its real name before `commit`
   subroutine create_file(file, path, error)
      !> The open file
      type(output_file_t), intent(out) :: file
      !> Its real name; the directory must be there
      character(len=*), intent(in) :: path
      !> Set if the file cannot be created
      type(error_t), allocatable, intent(out) :: error

      ! One thread at a time: the length of a text that a function returns is static
!$omp critical (vcor_file)
      call begin(file, path, error)
!$omp end critical (vcor_file)
   end subroutine create_file

   !> Begin a file
   subroutine begin(file, path, error)
      !> The open file
      type(output_file_t), intent(inout) :: file
      !> Its real name
      character(len=*), intent(in) :: path
      !> Set if the file cannot be created
      type(error_t), allocatable, intent(out) :: error
      integer(c_int) :: descriptor, ignored, reason

      call check_target(path, error)
      if (allocated(error)) return
      file%path = trim(path)
      call make_scratch(file%folder, file%path, error)
      if (allocated(error)) return
      call make_scratch_file(file%folder, file%temporary, descriptor)
      reason = last_errno()
      if (descriptor >= 0) then
         file%stream = c_fdopen(descriptor, c_text("wb"))
         reason = last_errno()
         if (c_associated(file%stream)) return
         ignored = c_close(descriptor)
      end if
      call discard(file)
      call raise_system(error, "cannot write "//quoted_path(path), reason)
   end subroutine begin

   !> Write to a file
   subroutine put(file, text, error)
      !> Open file; discarded on failure
      type(output_file_t), intent(inout) :: file
      !> What to write, byte by byte: nothing is added
      character(len=*), intent(in) :: text
      !> Set if the text could not be written as a whole
      type(error_t), allocatable, intent(out) :: error
      integer(c_size_t) :: length, written
      integer(c_int) :: reason

      call check_open(file, error)
      if (allocated(error)) return
      length = len(text, kind=c_size_t)
      if (length == 0_c_size_t) return
      written = c_fwrite(text, 1_c_size_t, length, file%stream)
      reason = last_errno()
      if (written /= length) call fail(file, reason, error)
   end subroutine put

   !> End a file: hand the rest of it to the system, close it and give it its real name
   subroutine commit(file, error)
      !> Open file; closed afterwards
      type(output_file_t), intent(inout) :: file
      !> Set if the file is not complete; then it is discarded
      type(error_t), allocatable, intent(out) :: error
      integer(c_int) :: reason, status

      call check_open(file, error)
      if (allocated(error)) return

      status = c_fflush(file%stream)
      reason = last_errno()
      if (status == 0) then
         status = c_fchmod(c_fileno(file%stream), permissions())
         reason = last_errno()
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
      if (status /= 0) then
         call fail(file, reason, error)
         return
      end if
      call forget(file%temporary)
      deallocate(file%temporary)
      call discard(file)
   end subroutine commit

   !> Permissions of a new file
   function permissions() result(mode)
      !> Those that the user's umask leaves
      integer(c_int) :: mode
      integer(c_int) :: ignored, mask

      ! It can only be asked for by setting it: nothing is let through meanwhile
!$omp critical (vcor_umask)
      mask = c_umask(all_permissions)
      ignored = c_umask(mask)
!$omp end critical (vcor_umask)
      mode = iand(file_permissions, not(mask))
   end function permissions

   !> Give a file up: the temporary file goes, what has the real name stays
   !>
   !> Does nothing to a file that is not open.
   subroutine discard(file)
      !> Open file; closed afterwards
      type(output_file_t), intent(inout) :: file
      integer(c_int) :: ignored

      if (c_associated(file%stream)) ignored = c_fclose(file%stream)
      file%stream = c_null_ptr
      if (allocated(file%temporary)) then
         call remove_scratch(file%temporary)
         deallocate(file%temporary)
      end if
      if (allocated(file%folder)) then
         call remove_scratch(file%folder)
         deallocate(file%folder)
      end if
   end subroutine discard

   !> Write a whole file at once
   subroutine write_file(path, text, error)
      !> Name of the file; replaced if it is there
      character(len=*), intent(in) :: path
      !> What to write, byte by byte: nothing is added
      character(len=*), intent(in) :: text
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(output_file_t) :: file

      call create_file(file, path, error)
      if (allocated(error)) return
      call put(file, text, error)
      if (allocated(error)) return
      call commit(file, error)
   end subroutine write_file

   !> Write to the standard output at once, unbuffered: a full disk or a closed output is seen
   subroutine write_stdout(text, error)
      !> What to write, byte by byte: nothing is added
      character(len=*), intent(in) :: text
      !> Set if the text could not be written as a whole
      type(error_t), allocatable, intent(out) :: error
      integer(c_size_t) :: first, length, written
      integer(c_int) :: reason
      integer :: status
      character(len=200) :: message

      ! What a caller has left in the unit of Fortran comes first
      message = ""
      flush(output_unit, iostat=status, iomsg=message)
      if (status /= 0) then
         call raise(error, error_file, "cannot write the standard output: "//trim(message))
         return
      end if

      length = len(text, kind=c_size_t)
      first = 1_c_size_t
      do while (first <= length)
         written = c_write(standard_output, text(first:), length - first + 1_c_size_t)
         reason = last_errno()
         if (written >= 0_c_size_t) then
            first = first + written
         else if (reason /= errno_interrupted) then
            call raise_system(error, "cannot write the standard output", reason)
            return
         end if
      end do
   end subroutine write_stdout

   !> Whether the standard error is a terminal
   function stderr_is_terminal() result(is_one)
      !> Whether it is
      logical :: is_one

      is_one = c_isatty(standard_error) == 1
   end function stderr_is_terminal

   !> Write to the standard error at once; whether it works is nobody's business
   subroutine write_terminal(text)
      !> What to write, byte by byte: nothing is added
      character(len=*), intent(in) :: text
      integer(c_size_t) :: ignored

      ignored = c_write(standard_error, text, len(text, kind=c_size_t))
   end subroutine write_terminal

   !> Give a file another name, in place of what has that name
   subroutine move_file(from, to, error)
      !> Its name
      character(len=*), intent(in) :: from
      !> Its new name, in the same folder
      character(len=*), intent(in) :: to
      !> Set if that failed
      type(error_t), allocatable, intent(out) :: error
      integer(c_int) :: reason

      if (c_rename(c_text(from), c_text(to)) == 0) return
      reason = last_errno()
      call raise_system(error, "cannot write "//quoted_path(to), reason)
   end subroutine move_file

   !> Remove a file; none is fine
   subroutine remove_file(path)
      !> Its name
      character(len=*), intent(in) :: path
      integer(c_int) :: ignored

      ignored = c_unlink(c_text(path))
   end subroutine remove_file

   !> Check that a file may have that name
   subroutine check_target(path, error)
      !> Name to check
      character(len=*), intent(in) :: path
      !> Set if it may not
      type(error_t), allocatable, intent(out) :: error

      call check_name(path, error)
      if (allocated(error)) return
      if (len_trim(path) == 0) then
         call raise(error, error_file, "cannot write a file without a name")
      else if (directory_exists(path)) then
         call raise(error, error_file, "cannot write "//quoted_path(path)// &
            & ": it is a directory, expected the name of a file")
      else if (index(path, "/", back=.true.) == len_trim(path)) then
         call raise(error, error_file, "cannot write "//quoted_path(path)// &
            & ": it ends with a slash, expected the name of a file")
      else if (file_exists(path)) then
         if (.not. is_regular(trim(path))) call raise(error, error_file, "cannot write "// &
            & quoted_path(path)//": it is a device or a pipe, expected a file or nothing there")
      end if
   end subroutine check_target

   !> Check that a file is open
   subroutine check_open(file, error)
      !> File to check
      type(output_file_t), intent(in) :: file
      !> Set if it is not
      type(error_t), allocatable, intent(out) :: error

      if (.not. c_associated(file%stream)) call raise(error, error_file, &
         & "cannot write a file that is not open")
   end subroutine check_open

   !> Discard a file for a reason of the system
   subroutine fail(file, reason, error)
      !> Open file; closed afterwards
      type(output_file_t), intent(inout) :: file
      !> Value of `errno`
      integer(c_int), intent(in) :: reason
      !> Set to the reason
      type(error_t), allocatable, intent(inout) :: error

!$omp critical (vcor_file)
      call discard(file)
      call raise_system(error, "cannot write "//quoted_path(file%path), reason)
!$omp end critical (vcor_file)
   end subroutine fail

end module vcor_io_file
