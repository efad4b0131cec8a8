!> Files that are there as a whole or not at all; directories, paths and the standard output
!>
!> A file is written under a temporary name in its own directory, `vcor-PROCESS-COUNT.tmp`, with
!> every status checked, closed, and renamed only then. If anything fails the temporary file is
!> removed and what was there under the real name is untouched.
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
   use, intrinsic :: iso_c_binding, only : c_associated, c_int, c_null_char, c_null_ptr, c_ptr, &
      & c_size_t
   use, intrinsic :: iso_fortran_env, only : output_unit
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_posix, only : access_exists, all_permissions, c_access, c_fclose, c_fflush, &
      & c_fopen, c_fwrite, c_getpid, c_isatty, c_mkdir, c_remove, c_rename, c_text, c_write, &
      & errno_exists, errno_interrupted, is_regular, last_errno, resolved_path, standard_error, &
      & standard_output, system_reason
   implicit none
   private

   public :: output_file_t, create_file, put, commit, discard
   public :: write_file, write_stdout, write_terminal, stderr_is_terminal, move_file, remove_file
   public :: file_exists, plain_file_exists, directory_exists, make_directory, join_path
   public :: quoted_path
   public :: same_file

   !> A file that is being written: `create_file`, any number of `put`, then `commit` or `discard`
   !>
   !> A procedure that fails discards the file by itself.
   type :: output_file_t
      private
      !> Stream of C, null unless the file is open
      type(c_ptr) :: stream = c_null_ptr
      !> The real name
      character(len=:), allocatable :: path
      !> The name until `commit`
      character(len=:), allocatable :: temporary
   end type output_file_t

   !> Temporary names that are tried before giving up; each try that fails met a file of that name,
   !> left by a process that was killed
   integer, parameter :: most_temporaries = 1000

contains

   !> Begin a file: nothing is seen under its real name before `commit`
   subroutine create_file(file, path, error, temporary)
      !> The open file
      type(output_file_t), intent(out) :: file
      !> Its real name; the directory must be there
      character(len=*), intent(in) :: path
      !> Set if the file cannot be created
      type(error_t), allocatable, intent(out) :: error
      !> Its name until `commit`, in the same folder, for what grows for so long that it may well be
      !> left behind: what has that name is replaced. Without it a name is found that nothing has
      character(len=*), intent(in), optional :: temporary

      ! One thread at a time: the length of a text that a function returns is static
!$omp critical (vcor_file)
      call begin(file, path, error, temporary)
!$omp end critical (vcor_file)
   end subroutine create_file

   !> Begin a file
   subroutine begin(file, path, error, given)
      !> The open file
      type(output_file_t), intent(inout) :: file
      !> Its real name
      character(len=*), intent(in) :: path
      !> Set if the file cannot be created
      type(error_t), allocatable, intent(out) :: error
      !> Its name until `commit`, if that is given
      character(len=*), intent(in), optional :: given
      character(len=:), allocatable :: temporary
      integer(c_int) :: reason
      integer :: count

      call check_name(path, error)
      if (allocated(error)) return
      file%path = trim(path)
      if (present(given)) then
         file%stream = c_fopen(c_text(given), c_text("wb"))
         reason = last_errno()
         if (c_associated(file%stream)) then
            file%temporary = given
         else
            call raise_system(error, "cannot write "//quoted_path(given), reason)
         end if
         return
      end if

      do count = 1, most_temporaries
         temporary = temporary_path(file%path, count)
         file%stream = c_fopen(c_text(temporary), c_text("wbx"))
         reason = last_errno()
         if (c_associated(file%stream)) then
            file%temporary = temporary
            return
         end if
         if (reason /= errno_exists) exit
      end do
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
      deallocate(file%temporary)
   end subroutine commit

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
         ignored = c_remove(c_text(file%temporary))
         deallocate(file%temporary)
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

      ignored = c_remove(c_text(path))
   end subroutine remove_file

   !> Whether there is a file, a device or a pipe of that name, a directory excepted; a link counts
   !> as what it points at
   function file_exists(path) result(exists)
      !> Path to look at
      character(len=*), intent(in) :: path
      !> True if there is one
      logical :: exists

      exists = c_access(c_text(trim(path)), access_exists) == 0
      if (exists) exists = .not. directory_exists(path)
   end function file_exists

   !> Whether there is a file of that name that can be looked into without consequences
   function plain_file_exists(path) result(exists)
      !> Path to look at
      character(len=*), intent(in) :: path
      !> True if there is one; a link counts as what it points at
      logical :: exists

      exists = file_exists(path)
      if (exists) exists = is_regular(trim(path))
   end function plain_file_exists

   !> Whether there is a directory of that name; a link counts as what it points at
   function directory_exists(path) result(exists)
      !> Path to look at; empty is the current directory
      character(len=*), intent(in) :: path
      !> True if there is one
      logical :: exists

      ! Only a directory has a member `.`
      exists = c_access(c_text(join_path(path, ".")), access_exists) == 0
   end function directory_exists

   !> Make a directory, and those above it; one that is there is fine
   subroutine make_directory(path, error)
      !> Path of the directory; empty is the current directory
      character(len=*), intent(in) :: path
      !> Set if there is no such directory afterwards
      type(error_t), allocatable, intent(out) :: error
      integer(c_int) :: reason, status
      integer :: last

      call check_text_of(path, error)
      if (allocated(error)) return
      if (directory_exists(path)) return

      do last = 1, len_trim(path)
         ! Each part that ends here or before a slash, top down
         if (path(last:last) == "/") cycle
         if (last < len_trim(path)) then
            if (path(last+1:last+1) /= "/") cycle
         end if
         status = c_mkdir(c_text(path(:last)), all_permissions)
         reason = last_errno()
         if (status == 0) cycle
         ! Whatever the reason: what counts is that there is a directory, perhaps made by another
         ! process at the same time, or one that may be entered but not written
         if (directory_exists(path(:last))) cycle
         if (file_exists(path(:last))) then
            call raise(error, error_file, "cannot make the directory "//quoted_path(path)//": "// &
               & quoted_path(path(:last))//" is a file, expected a directory")
         else
            call raise_system(error, "cannot make the directory "//quoted_path(path(:last)), reason)
         end if
         return
      end do
   end subroutine make_directory

   !> Path of a member of a directory
   pure function join_path(directory, name) result(path)
      !> Directory, with or without a slash at the end; empty is the current directory
      character(len=*), intent(in) :: directory
      !> Path from there; one that begins with a slash stands for itself
      character(len=*), intent(in) :: name
      !> The path, without blanks at the end
      character(len=:), allocatable :: path

      path = trim(name)
      if (len_trim(directory) == 0 .or. index(name, "/") == 1) return
      path = trim(directory)
      if (path(len(path):) /= "/") path = path//"/"
      path = path//trim(name)
   end function join_path

   !> Whether two paths lead to one file, by the folders they are in, links resolved, and the names
   function same_file(one, other) result(same)
      !> A path
      character(len=*), intent(in) :: one
      !> Another path
      character(len=*), intent(in) :: other
      !> Whether both are the same
      logical :: same
      integer :: a, b

      a = index(one, "/", back=.true.)
      b = index(other, "/", back=.true.)
      same = one(a+1:) == other(b+1:)
      if (same) same = folder_of(one, a) == folder_of(other, b)

   contains

      !> Folder of a path, resolved
      function folder_of(path, slash) result(folder)
         !> The path
         character(len=*), intent(in) :: path
         !> Place of its last slash, 0 if it has none
         integer, intent(in) :: slash
         !> The folder
         character(len=:), allocatable :: folder

         if (slash == 0) then
            folder = resolved_path(".")
         else
            folder = resolved_path(path(:slash))
         end if
      end function folder_of
   end function same_file

   !> A path as it stands in a message: between quotes, on one line
   pure function quoted_path(path) result(quoted)
      !> Any path
      character(len=*), intent(in) :: path
      !> The path between quotes, `?` for every control character
      character(len=:), allocatable :: quoted
      integer :: i

      quoted = "'"//trim(path)//"'"
      do i = 1, len(quoted)
         if (iachar(quoted(i:i)) < iachar(" ") .or. iachar(quoted(i:i)) == 127) quoted(i:i) = "?"
      end do
   end function quoted_path

   !> A name for the time of writing
   !>
   !> It is in the directory of the file, so that renaming stays within one file system, and does
   !> not hold the real name, since a longer one might be too long for the file system.
   function temporary_path(path, count) result(temporary)
      !> The real name
      character(len=*), intent(in) :: path
      !> Number of the try
      integer, intent(in) :: count
      !> The temporary name
      character(len=:), allocatable :: temporary
      character(len=48) :: name

      write(name, "('vcor-', i0, '-', i0, '.tmp')") c_getpid(), count
      temporary = path(:index(path, "/", back=.true.))//trim(name)
   end function temporary_path

   !> Check that a file may have that name
   subroutine check_name(path, error)
      !> Name to check
      character(len=*), intent(in) :: path
      !> Set if it may not
      type(error_t), allocatable, intent(out) :: error

      call check_text_of(path, error)
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
   end subroutine check_name

   !> Check that a path can be handed to C
   subroutine check_text_of(path, error)
      !> Path to check
      character(len=*), intent(in) :: path
      !> Set if C would take a part of it for the whole
      type(error_t), allocatable, intent(out) :: error

      if (index(path, c_null_char) > 0) call raise(error, error_file, &
         & "the path "//quoted_path(path)//" holds a NUL character, expected text")
   end subroutine check_text_of

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

   !> Set an error with the reason of the system
   subroutine raise_system(error, what, reason)
      !> The error, allocated on return
      type(error_t), allocatable, intent(inout) :: error
      !> What failed
      character(len=*), intent(in) :: what
      !> Value of `errno`
      integer(c_int), intent(in) :: reason

      call raise(error, error_file, what//": "//system_reason(reason))
   end subroutine raise_system

end module vcor_io_file
