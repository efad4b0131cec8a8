!> The system calls behind files: thin interfaces to C and POSIX, used by `vcor_io` alone
!>
!> Fortran's own units hide what matters here: gfortran writes its buffer when a unit is closed and
!> reports no error if the disk is full then, it has no rename, no directories and no exclusive
!> creation. All functions are called as C declares them, none is variadic. Two are Linux's own:
!> `__errno_location` (its name is `__error` on macOS) and `statx`. The preprocessor of gfortran
!> does not know the system it runs on, so another system takes an edit of this file.
module vcor_io_posix
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_f_pointer, c_int, c_int16_t, &
      & c_int64_t, c_null_char, c_ptr, c_size_t
   implicit none
   private

   public :: c_access, c_fclose, c_fflush, c_fopen, c_fwrite, c_getpid, c_mkdir, c_rename, c_write
   public :: c_fileno, c_fsync, c_isatty, c_lockf, c_pwrite
   public :: c_close, c_fchmod, c_fdopen, c_link, c_mkdtemp, c_mkstemp, c_rmdir, c_umask, c_unlink
   public :: c_text, is_regular, last_errno, resolved_path, system_reason
   public :: file_id_t, file_at, open_file, same_file_id, nothing_there, plain_file, something_else
   public :: access_exists, all_permissions, errno_exists, errno_interrupted, errno_locked, &
      & file_permissions, lock_alone, standard_error, standard_output

   !> Mode of `c_access`: does something of that name exist (F_OK)
   integer(c_int), parameter :: access_exists = 0
   !> `errno`: interrupted by a signal (EINTR)
   integer(c_int), parameter :: errno_interrupted = 4
   !> `errno`: another process has the lock (EAGAIN)
   integer(c_int), parameter :: errno_locked = 11
   !> Operation of `c_lockf`: for this process alone, without waiting (F_TLOCK)
   integer(c_int), parameter :: lock_alone = 2
   !> File descriptor of the standard error
   integer(c_int), parameter :: standard_error = 2
   !> `errno`: there is something of that name (EEXIST)
   integer(c_int), parameter :: errno_exists = 17
   !> Permissions rw-rw-rw-, of which the user's umask takes its part away
   integer(c_int), parameter :: file_permissions = int(o'666', c_int)
   !> Permissions rwxrwxrwx, of which the user's umask takes its part away
   integer(c_int), parameter :: all_permissions = int(o'777', c_int)
   !> File descriptor of the standard output
   integer(c_int), parameter :: standard_output = 1

   !> What there is at a path: nothing, a file, or something else: a link, a pipe, a folder
   integer, parameter :: nothing_there = 0, plain_file = 1, something_else = 2

   !> A file whatever its names: what there is, its device and its number on it
   type :: file_id_t
      !> `nothing_there`, `plain_file` or `something_else`
      integer :: kind = nothing_there
      !> Device and number, as the system keeps them
      integer(c_int16_t) :: bits(8) = 0_c_int16_t
   end type file_id_t

   interface
      !> Open a stream
      function c_fopen(path, mode) result(stream) bind(c, name="fopen")
         import :: c_char, c_ptr
         !> Path, ends with NUL
         character(kind=c_char), intent(in) :: path(*)
         !> Mode as in C, ends with NUL; `wbx` creates and refuses what exists
         character(kind=c_char), intent(in) :: mode(*)
         !> Stream, null if it failed
         type(c_ptr) :: stream
      end function c_fopen

      !> Write to a stream
      function c_fwrite(bytes, size, count, stream) result(written) bind(c, name="fwrite")
         import :: c_char, c_ptr, c_size_t
         !> What to write
         character(kind=c_char), intent(in) :: bytes(*)
         !> Bytes per item
         integer(c_size_t), intent(in), value :: size
         !> Number of items
         integer(c_size_t), intent(in), value :: count
         !> Open stream
         type(c_ptr), intent(in), value :: stream
         !> Number of items written; fewer than `count` if it failed
         integer(c_size_t) :: written
      end function c_fwrite

      !> Hand the buffer of a stream to the system
      function c_fflush(stream) result(status) bind(c, name="fflush")
         import :: c_int, c_ptr
         !> Open stream
         type(c_ptr), intent(in), value :: stream
         !> 0 on success
         integer(c_int) :: status
      end function c_fflush

      !> Close a stream
      function c_fclose(stream) result(status) bind(c, name="fclose")
         import :: c_int, c_ptr
         !> Open stream; closed afterwards, whatever the status
         type(c_ptr), intent(in), value :: stream
         !> 0 on success
         integer(c_int) :: status
      end function c_fclose

      !> Write to a file descriptor
      function c_write(descriptor, bytes, count) result(written) bind(c, name="write")
         import :: c_char, c_int, c_size_t
         !> File descriptor
         integer(c_int), intent(in), value :: descriptor
         !> What to write
         character(kind=c_char), intent(in) :: bytes(*)
         !> Number of bytes
         integer(c_size_t), intent(in), value :: count
         !> Number of bytes written, may be fewer than `count`; -1 if it failed
         integer(c_size_t) :: written
      end function c_write

      !> File descriptor of a stream
      function c_fileno(stream) result(descriptor) bind(c, name="fileno")
         import :: c_int, c_ptr
         !> Open stream
         type(c_ptr), intent(in), value :: stream
         !> Its descriptor
         integer(c_int) :: descriptor
      end function c_fileno

      !> Write to a place of a file
      function c_pwrite(descriptor, bytes, count, offset) result(written) bind(c, name="pwrite")
         import :: c_int, c_int64_t, c_ptr, c_size_t
         !> File descriptor
         integer(c_int), intent(in), value :: descriptor
         !> Address of what to write
         type(c_ptr), intent(in), value :: bytes
         !> Number of bytes
         integer(c_size_t), intent(in), value :: count
         !> Bytes of the file before the place
         integer(c_int64_t), intent(in), value :: offset
         !> Number of bytes written, may be fewer than `count`; -1 if it failed
         integer(c_size_t) :: written
      end function c_pwrite

      !> Hand what was written to a file to the disk
      function c_fsync(descriptor) result(status) bind(c, name="fsync")
         import :: c_int
         !> File descriptor
         integer(c_int), intent(in), value :: descriptor
         !> 0 on success
         integer(c_int) :: status
      end function c_fsync

      !> Lock a file from where it is read or written next, as long as the process has it open
      function c_lockf(descriptor, operation, length) result(status) bind(c, name="lockf")
         import :: c_int, c_int64_t
         !> File descriptor
         integer(c_int), intent(in), value :: descriptor
         !> What to do
         integer(c_int), intent(in), value :: operation
         !> Number of bytes, 0: all
         integer(c_int64_t), intent(in), value :: length
         !> 0 on success
         integer(c_int) :: status
      end function c_lockf

      !> Whether a file descriptor is a terminal
      function c_isatty(descriptor) result(is_one) bind(c, name="isatty")
         import :: c_int
         !> File descriptor
         integer(c_int), intent(in), value :: descriptor
         !> 1 if it is one
         integer(c_int) :: is_one
      end function c_isatty

      !> Give a file another name, in place of what has that name
      function c_rename(old, new) result(status) bind(c, name="rename")
         import :: c_char, c_int
         !> Path, ends with NUL
         character(kind=c_char), intent(in) :: old(*)
         !> Path, ends with NUL
         character(kind=c_char), intent(in) :: new(*)
         !> 0 on success
         integer(c_int) :: status
      end function c_rename

      !> Remove a file, not a folder; a handler of signals may call it
      function c_unlink(path) result(status) bind(c, name="unlink")
         import :: c_char, c_int
         !> Path, ends with NUL
         character(kind=c_char), intent(in) :: path(*)
         !> 0 on success
         integer(c_int) :: status
      end function c_unlink

      !> Remove an empty folder; a handler of signals may call it
      function c_rmdir(path) result(status) bind(c, name="rmdir")
         import :: c_char, c_int
         !> Path, ends with NUL
         character(kind=c_char), intent(in) :: path(*)
         !> 0 on success
         integer(c_int) :: status
      end function c_rmdir

      !> Give a file one more name; fails where there is anything of that name
      function c_link(old, new) result(status) bind(c, name="link")
         import :: c_char, c_int
         !> Path, ends with NUL
         character(kind=c_char), intent(in) :: old(*)
         !> Path, ends with NUL
         character(kind=c_char), intent(in) :: new(*)
         !> 0 on success
         integer(c_int) :: status
      end function c_link

      !> Make a folder of a name that nothing has, for the user alone
      function c_mkdtemp(template) result(place) bind(c, name="mkdtemp")
         import :: c_char, c_ptr
         !> Path that ends with XXXXXX and NUL; the name on return
         character(kind=c_char), intent(inout) :: template(*)
         !> Null if it failed
         type(c_ptr) :: place
      end function c_mkdtemp

      !> Create and open a file of a name that nothing has, for the user alone
      function c_mkstemp(template) result(descriptor) bind(c, name="mkstemp")
         import :: c_char, c_int
         !> Path that ends with XXXXXX and NUL; the name on return
         character(kind=c_char), intent(inout) :: template(*)
         !> File descriptor, -1 if it failed
         integer(c_int) :: descriptor
      end function c_mkstemp

      !> A stream for a file that is open
      function c_fdopen(descriptor, mode) result(stream) bind(c, name="fdopen")
         import :: c_char, c_int, c_ptr
         !> File descriptor
         integer(c_int), intent(in), value :: descriptor
         !> Mode as in C, ends with NUL
         character(kind=c_char), intent(in) :: mode(*)
         !> Stream, null if it failed
         type(c_ptr) :: stream
      end function c_fdopen

      !> Close a file descriptor
      function c_close(descriptor) result(status) bind(c, name="close")
         import :: c_int
         !> File descriptor
         integer(c_int), intent(in), value :: descriptor
         !> 0 on success
         integer(c_int) :: status
      end function c_close

      !> Set the permissions of an open file
      function c_fchmod(descriptor, mode) result(status) bind(c, name="fchmod")
         import :: c_int
         !> File descriptor
         integer(c_int), intent(in), value :: descriptor
         !> Permissions
         integer(c_int), intent(in), value :: mode
         !> 0 on success
         integer(c_int) :: status
      end function c_fchmod

      !> Set the permissions that new files do not get
      function c_umask(mask) result(before) bind(c, name="umask")
         import :: c_int
         !> The permissions
         integer(c_int), intent(in), value :: mask
         !> Those before
         integer(c_int) :: before
      end function c_umask

      !> Make a directory
      function c_mkdir(path, mode) result(status) bind(c, name="mkdir")
         import :: c_char, c_int
         !> Path, ends with NUL
         character(kind=c_char), intent(in) :: path(*)
         !> Permissions before the umask
         integer(c_int), intent(in), value :: mode
         !> 0 on success
         integer(c_int) :: status
      end function c_mkdir

      !> Ask what may be done with a path
      function c_access(path, mode) result(status) bind(c, name="access")
         import :: c_char, c_int
         !> Path, ends with NUL
         character(kind=c_char), intent(in) :: path(*)
         !> What is asked: `access_exists`
         integer(c_int), intent(in), value :: mode
         !> 0 for yes
         integer(c_int) :: status
      end function c_access

      !> Ask for the properties of a file; unlike that of `stat`, the structure is the same on all
      !> processors
      function c_statx(directory, path, flags, mask, properties) result(status) &
         & bind(c, name="statx")
         import :: c_char, c_int, c_int16_t
         !> Where a relative path begins
         integer(c_int), intent(in), value :: directory
         !> Path, ends with NUL; links are followed
         character(kind=c_char), intent(in) :: path(*)
         !> Flags, 0
         integer(c_int), intent(in), value :: flags
         !> Which properties are asked for
         integer(c_int), intent(in), value :: mask
         !> Structure of 256 bytes, the type and the permissions are two bytes from byte 28 on
         integer(c_int16_t), intent(inout) :: properties(128)
         !> 0 on success
         integer(c_int) :: status
      end function c_statx

      !> A path without links, dots and double slashes
      function c_realpath(path, resolved) result(place) bind(c, name="realpath")
         import :: c_char, c_ptr
         !> Path of something that exists, ends with NUL
         character(kind=c_char), intent(in) :: path(*)
         !> The resolved path, at least 4096 characters, ends with NUL
         character(kind=c_char), intent(out) :: resolved(*)
         !> Null if it failed
         type(c_ptr) :: place
      end function c_realpath

      !> Number of this process
      function c_getpid() result(process) bind(c, name="getpid")
         import :: c_int
         !> Process id
         integer(c_int) :: process
      end function c_getpid

      !> Where `errno` of this thread is
      function c_errno_place() result(place) bind(c, name="__errno_location")
         import :: c_ptr
         !> Address of a C int
         type(c_ptr) :: place
      end function c_errno_place

      !> What an `errno` means
      function c_strerror(number) result(text) bind(c, name="strerror")
         import :: c_int, c_ptr
         !> Value of `errno`
         integer(c_int), intent(in), value :: number
         !> Address of a text that ends with NUL
         type(c_ptr) :: text
      end function c_strerror

      !> Length of a text of C
      function c_strlen(text) result(length) bind(c, name="strlen")
         import :: c_ptr, c_size_t
         !> Address of a text that ends with NUL
         type(c_ptr), intent(in), value :: text
         !> Number of bytes before the NUL
         integer(c_size_t) :: length
      end function c_strlen
   end interface

contains

   !> A text as C wants it
   pure function c_text(text) result(terminated)
      !> Any text
      character(len=*), intent(in) :: text
      !> The text and a NUL
      character(len=len(text)+1, kind=c_char) :: terminated

      terminated = text//c_null_char
   end function c_text

   !> Whether what exists is a file rather than a device, a pipe or the like
   function is_regular(path)
      !> Path of something that exists; a link counts as what it points at
      character(len=*), intent(in) :: path
      !> False if it is something else; true also if the system does not tell
      logical :: is_regular
      ! AT_FDCWD, STATX_TYPE, S_IFMT and S_IFREG of C
      integer(c_int), parameter :: current_directory = -100, type_of_file = 1
      integer, parameter :: type_bits = int(o'170000'), regular = int(o'100000')
      integer(c_int16_t) :: properties(128)
      integer(c_int) :: status

      is_regular = .true.
      properties = 0_c_int16_t
      status = c_statx(current_directory, c_text(path), 0_c_int, type_of_file, properties)
      if (status == 0) is_regular = iand(int(properties(15)), type_bits) == regular
   end function is_regular

   !> What there is at a path, links not followed
   function file_at(path) result(id)
      !> Path to look at
      character(len=*), intent(in) :: path
      !> The file
      type(file_id_t) :: id
      ! AT_FDCWD and AT_SYMLINK_NOFOLLOW of C
      integer(c_int), parameter :: current_directory = -100, no_follow = int(z'100', c_int)

      id = file_of(current_directory, path, no_follow)
   end function file_at

   !> The file behind a descriptor
   function open_file(descriptor) result(id)
      !> File descriptor
      integer(c_int), intent(in) :: descriptor
      !> The file
      type(file_id_t) :: id
      ! AT_EMPTY_PATH of C
      integer(c_int), parameter :: empty_path = int(z'1000', c_int)

      id = file_of(descriptor, "", empty_path)
   end function open_file

   !> Ask the system for a file
   function file_of(directory, path, flags) result(id)
      !> Where a relative path begins
      integer(c_int), intent(in) :: directory
      !> Path
      character(len=*), intent(in) :: path
      !> Flags
      integer(c_int), intent(in) :: flags
      !> The file
      type(file_id_t) :: id
      ! STATX_TYPE and STATX_INO, S_IFMT and S_IFREG of C; the number is 8 bytes from byte 32 on,
      ! the device 8 bytes from byte 136 on
      integer(c_int), parameter :: type_and_number = int(z'101', c_int)
      integer, parameter :: type_bits = int(o'170000'), regular = int(o'100000')
      integer(c_int16_t) :: properties(128)

      properties = 0_c_int16_t
      if (c_statx(directory, c_text(path), flags, type_and_number, properties) /= 0) return
      id%kind = merge(plain_file, something_else, iand(int(properties(15)), type_bits) == regular)
      id%bits = [properties(17:20), properties(69:72)]
   end function file_of

   !> Whether two files are one, and there is one
   pure function same_file_id(one, other) result(same)
      !> A file
      type(file_id_t), intent(in) :: one
      !> Another file
      type(file_id_t), intent(in) :: other
      !> Whether both are the same
      logical :: same

      same = one%kind /= nothing_there .and. all(one%bits == other%bits)
   end function same_file_id

   !> Value of `errno`: to be asked for right after the call that failed
   function last_errno() result(number)
      !> Number of the last failure
      integer(c_int) :: number
      integer(c_int), pointer :: place

      call c_f_pointer(c_errno_place(), place)
      number = place
   end function last_errno

   !> What the system says about a failure
   function system_reason(number) result(reason)
      !> Value of `errno`
      integer(c_int), intent(in) :: number
      !> Text such as `No space left on device`
      character(len=:), allocatable :: reason
      type(c_ptr) :: text
      character(kind=c_char), pointer :: letters(:)
      integer :: i, length

      text = c_strerror(number)
      length = int(c_strlen(text))
      call c_f_pointer(text, letters, [length])
      allocate(character(len=length) :: reason)
      do i = 1, length
         reason(i:i) = letters(i)
      end do
   end function system_reason

   !> A path without links, dots and double slashes; as it is if there is nothing of that name
   function resolved_path(path) result(resolved)
      !> The path
      character(len=*), intent(in) :: path
      !> The resolved path
      character(len=:), allocatable :: resolved
      ! PATH_MAX of Linux
      integer, parameter :: longest = 4096
      character(kind=c_char) :: buffer(longest)
      integer :: i, length

      resolved = path
      if (.not. c_associated(c_realpath(c_text(path), buffer))) return
      length = 0
      do while (length < longest)
         if (buffer(length + 1) == c_null_char) exit
         length = length + 1
      end do
      resolved = repeat(" ", length)
      do i = 1, length
         resolved(i:i) = buffer(i)
      end do
   end function resolved_path

end module vcor_io_posix
