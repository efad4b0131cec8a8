!> What exists at a path, directories, and paths in messages
!>
!> Trailing blanks of a path are ignored, as by Fortran's `open`. Every error is an `error_file`
!> with the path and the reason of the system.
module vcor_io_path
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_int, c_null_char
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_posix, only : all_permissions, c_mkdir, c_realpath, c_text, file_at, file_id_t, &
      folder, last_errno, longest_path, nothing_there, plain_file, same_file_id, system_reason
   use vcor_text, only : is_control, name_flaw, printable
   implicit none
   private

   public :: file_exists, plain_file_exists, directory_exists, make_directory
   public :: folder_of, join_path, path_from, full_path, same_file, quoted_path
   public :: anything_at, check_name, check_plain, check_readable, raise_system

contains

   !> Whether a file, a device or a pipe of that name exists, but no directory; links are followed
   function file_exists(path) result(exists)
      character(len=*), intent(in) :: path
      logical :: exists

      exists = all(kind_of(path, follows=.true.) /= [nothing_there, folder])
   end function file_exists

   !> Whether a regular file of that name exists, which can be read without side effects; links are
   !> followed
   function plain_file_exists(path) result(exists)
      character(len=*), intent(in) :: path
      logical :: exists

      exists = kind_of(path, follows=.true.) == plain_file
   end function plain_file_exists

   !> Whether a directory of that name exists
   function directory_exists(path) result(exists)
      !> Path; empty for the current directory
      character(len=*), intent(in) :: path
      logical :: exists

      exists = path == '' .or. kind_of(path, follows=.true.) == folder
   end function directory_exists

   !> Whether anything of that name exists, even a broken link
   function anything_at(path) result(exists)
      character(len=*), intent(in) :: path
      logical :: exists

      exists = kind_of(path, follows=.false.) /= nothing_there
   end function anything_at

   !> Check that a path is a regular file or does not exist
   subroutine check_plain(path, error)
      character(len=*), intent(in) :: path
      !> Set if it is a link of any kind, a pipe, a directory or a device
      type(error_t), allocatable, intent(out) :: error

      if (all(kind_of(path, follows=.false.) /= [nothing_there, plain_file])) call raise(error, &
         error_file, quoted_path(path)//' is a link, a folder, a pipe or a device, expected a ' &
         //'file or nothing')
   end subroutine check_plain

   !> Check that something readable of that name exists
   subroutine check_readable(path, expected, error)
      character(len=*), intent(in) :: path
      !> Expected file, for messages
      character(len=*), intent(in) :: expected
      !> Set if it does not exist or is a directory
      type(error_t), allocatable, intent(out) :: error

      if (path == '') then
         call raise(error, error_file, 'the name of the file is empty, expected that of '//expected)
      else if (directory_exists(path)) then
         call raise(error, error_file, printable(path)//': found a directory, expected '//expected)
      else if (.not. file_exists(path)) then
         call raise(error, error_file, printable(path)//': there is no such file')
      end if
   end subroutine check_readable

   !> What exists at a path
   function kind_of(path, follows) result(kind)
      character(len=*), intent(in) :: path
      !> Whether to follow links
      logical, intent(in) :: follows
      !> `nothing_there`, `plain_file`, `folder` or `something_else`
      integer :: kind

      type(file_id_t) :: id

      id = file_at(trim(path), follows)
      kind = id%kind
   end function kind_of

   !> Make a directory, with its parents, unless it exists
   subroutine make_directory(path, error)
      !> Path of the directory; empty for the current one
      character(len=*), intent(in) :: path
      !> Set if the directory does not exist afterwards
      type(error_t), allocatable, intent(out) :: error
      integer(c_int) :: reason, status
      integer :: last

      call check_name(path, error)
      if (allocated(error)) return
      if (directory_exists(path)) return

      do last = 1, len_trim(path)
         ! each directory of the path, from the top
         if (path(last:last) == '/') cycle
         if (last < len_trim(path)) then
            if (path(last+1:last+1) /= '/') cycle
         end if
         status = c_mkdir(c_text(path(:last)), all_permissions)
         reason = last_errno()
         if (status == 0) cycle
         ! The reason is irrelevant if the directory exists: another process may have made it, or it
         ! may be accessible but not writable
         if (directory_exists(path(:last))) cycle
         if (file_exists(path(:last))) then
            call raise(error, error_file, 'cannot make the directory '//quoted_path(path)//': '// &
               quoted_path(path(:last))//' is a file, expected a directory')
         else
            call raise_system(error, 'cannot make the directory '//quoted_path(path(:last)), reason)
         end if
         return
      end do
   end subroutine make_directory

   !> Directory of a file, with a trailing slash
   pure function folder_of(path) result(directory)
      character(len=*), intent(in) :: path
      !> Empty for the current directory
      character(len=:), allocatable :: directory

      directory = path(:index(path, '/', back=.true.))
   end function folder_of

   !> Path of a file in a directory
   pure function join_path(directory, name) result(path)
      !> Directory, with or without a trailing slash; empty for the current one
      character(len=*), intent(in) :: directory
      !> Path from there; an absolute path is returned as it is
      character(len=*), intent(in) :: name
      !> The path, without trailing blanks
      character(len=:), allocatable :: path

      path = trim(name)
      if (len_trim(directory) == 0 .or. index(name, '/') == 1) return
      path = trim(directory)
      if (path(len(path):) /= '/') path = path//'/'
      path = path//trim(name)
   end function join_path

   !> Path of a file in a directory, relative to another directory
   function path_from(viewer, directory, name) result(path)
      !> The other directory, empty for the current one
      character(len=*), intent(in) :: viewer
      !> Directory of the file, empty for the current one
      character(len=*), intent(in) :: directory
      !> Path from there; an absolute path is returned as it is
      character(len=*), intent(in) :: name
      character(len=:), allocatable :: path

      character(len=:), allocatable :: root

      path = name
      if (viewer == directory) return
      path = join_path(directory, name)
      if (viewer == '' .or. index(path, '/') == 1) return
      root = full_path(directory)
      if (root /= '') path = join_path(root, name)
   end function path_from

   !> Absolute path of a directory, without links and dots
   function full_path(directory) result(path)
      !> Empty for the current one, otherwise with a slash at its end
      character(len=*), intent(in) :: directory
      !> Empty if there is no such directory
      character(len=:), allocatable :: path

      character(kind=c_char) :: root(longest_path)
      integer :: i

      path = ''
      if (.not. c_associated(c_realpath(c_text(directory//'.'), root))) return
      do i = 1, findloc(root, c_null_char, dim=1) - 1
         path = path//root(i)
      end do
   end function full_path

   !> Whether two paths are one file, by name and directory; the file need not exist
   function same_file(one, other) result(same)
      character(len=*), intent(in) :: one
      character(len=*), intent(in) :: other
      logical :: same

      integer :: a, b

      a = index(one, '/', back=.true.)
      b = index(other, '/', back=.true.)
      same = one(a+1:) == other(b+1:)
      if (.not. same .or. one == other) return
      same = same_file_id(file_at(one(:a)//'.', follows=.true.), &
         file_at(other(:b)//'.', follows=.true.))
   end function same_file

   !> A path for messages: quoted, on one line
   pure function quoted_path(path) result(quoted)
      character(len=*), intent(in) :: path
      !> The path in quotes, with `?` for every control character
      character(len=:), allocatable :: quoted

      integer :: i

      quoted = "'"//trim(path)//"'"
      do i = 1, len(quoted)
         if (is_control(quoted(i:i))) quoted(i:i) = '?'
      end do
      quoted = printable(quoted)
   end function quoted_path

   !> Check that a name may be written to
   subroutine check_name(path, error)
      character(len=*), intent(in) :: path
      !> Set if it may not, see `name_flaw`
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: flaw

      flaw = name_flaw(path)
      if (flaw /= '') call raise(error, error_file, 'cannot write '//quoted_path(path) &
         //': the name '//flaw//', expected another name')
   end subroutine check_name

   !> Raise an error with the reason of the system
   subroutine raise_system(error, what, reason)
      !> The error, allocated on return
      type(error_t), allocatable, intent(inout) :: error
      character(len=*), intent(in) :: what
      integer(c_int), intent(in) :: reason

      call raise(error, error_file, what//': '//system_reason(reason))
   end subroutine raise_system

end module vcor_io_path
