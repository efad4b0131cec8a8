!> System calls for files: interfaces to C and POSIX, for `vcor_io` only
!>
!> Fortran's own units are not sufficient: gfortran writes its buffer when a unit is closed and does
!> not report a full disk then; it has no rename, directories or exclusive creation. All
!> functions have their C prototypes, none is variadic. A path ends with NUL (`c_text`); a `status`
!> is 0 on success. Two functions exist on Linux only: `__errno_location` (`__error` on macOS) and
!> `statx`.
module vcor_io_posix
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_f_pointer, c_int, c_int16_t, &
      c_int64_t, c_null_char, c_ptr, c_size_t
   implicit none
   private

   public :: c_fopen, c_fclose, c_fileno, c_rename, c_unlink, c_mkdir, c_realpath, longest_path
   public :: c_write, c_isatty, c_fallocate, c_truncate, c_fsync
   public :: standard_output, standard_error, all_permissions
   public :: last_errno, errno_exists, errno_interrupted, system_reason
   public :: c_text, fortran_text
   public :: file_id_t, file_at, open_file, same_file_id
   public :: nothing_there, plain_file, folder, something_else

   !> File descriptors
   integer(c_int), parameter :: standard_output = 1, standard_error = 2
   !> Values of `errno`: interrupted by a signal (EINTR), name exists (EEXIST)
   integer(c_int), parameter :: errno_interrupted = 4, errno_exists = 17
   !> Permissions rwxrwxrwx, reduced by the umask of the user
   integer(c_int), parameter :: all_permissions = int(o'777', c_int)

   !> Size of the longest path with its NUL (PATH_MAX) [bytes]
   integer, parameter :: longest_path = 4096

   !> What exists at a path; something else is an unfollowed link, a pipe or a device
   integer, parameter :: nothing_there = 0, plain_file = 1, folder = 2, something_else = 3

   !> Identity of a file, independent of its names
   type :: file_id_t
      !> `nothing_there`, `plain_file`, `folder` or `something_else`
      integer :: kind = nothing_there
      !> Device and inode number, as the system stores them
      integer(c_int16_t) :: bits(8) = 0_c_int16_t
   end type file_id_t

   interface
      !> Open a stream to write a file; null on failure. The mode ends with NUL: `wx` creates a file
      !> with the permissions that the umask leaves and fails if the name exists, even as a link
      !> (O_EXCL); with `a` everything is written at the end of the file, wherever others moved it
      function c_fopen(path, mode) result(stream) bind(c, name='fopen')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*), mode(*)
         type(c_ptr) :: stream
      end function c_fopen

      !> Close a stream, even if the status is not 0
      function c_fclose(stream) result(status) bind(c, name='fclose')
         import :: c_int, c_ptr
         type(c_ptr), intent(in), value :: stream
         integer(c_int) :: status
      end function c_fclose

      !> File descriptor of a stream
      function c_fileno(stream) result(descriptor) bind(c, name='fileno')
         import :: c_int, c_ptr
         type(c_ptr), intent(in), value :: stream
         integer(c_int) :: descriptor
      end function c_fileno

      !> Rename a file, replacing one of the new name: complete files get their names this way
      function c_rename(old, new) result(status) bind(c, name='rename')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: old(*), new(*)
         integer(c_int) :: status
      end function c_rename

      !> Remove a file, not a directory
      function c_unlink(path) result(status) bind(c, name='unlink')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int) :: status
      end function c_unlink

      !> Absolute path without links and dots; null if it does not exist
      function c_realpath(path, resolved) result(place) bind(c, name='realpath')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*)
         !> Room for `longest_path` bytes
         character(kind=c_char), intent(inout) :: resolved(*)
         type(c_ptr) :: place
      end function c_realpath

      !> Make a directory for results, with the permissions that the umask leaves
      function c_mkdir(path, mode) result(status) bind(c, name='mkdir')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), intent(in), value :: mode
         integer(c_int) :: status
      end function c_mkdir

      !> Write `count` bytes to a file descriptor; returns the number of bytes written, which may be
      !> smaller, or -1 on failure
      function c_write(descriptor, bytes, count) result(written) bind(c, name='write')
         import :: c_char, c_int, c_size_t
         integer(c_int), intent(in), value :: descriptor
         character(kind=c_char), intent(in) :: bytes(*)
         integer(c_size_t), intent(in), value :: count
         integer(c_size_t) :: written
      end function c_write

      !> 1 if a file descriptor is a terminal, which shows the progress of a sweep
      function c_isatty(descriptor) result(is_one) bind(c, name='isatty')
         import :: c_int
         integer(c_int), intent(in), value :: descriptor
         integer(c_int) :: is_one
      end function c_isatty

      !> Allocate disk space for `length` bytes of a file from `offset` on; the status is a value of
      !> `errno`
      function c_fallocate(descriptor, offset, length) result(status) &
         bind(c, name='posix_fallocate')
         import :: c_int, c_int64_t
         integer(c_int), intent(in), value :: descriptor
         integer(c_int64_t), intent(in), value :: offset, length
         integer(c_int) :: status
      end function c_fallocate

      !> Cut a file to a length
      function c_truncate(path, length) result(status) bind(c, name='truncate')
         import :: c_char, c_int, c_int64_t
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int64_t), intent(in), value :: length
         integer(c_int) :: status
      end function c_truncate

      !> Write a file through to the disk, before it gets its name
      function c_fsync(descriptor) result(status) bind(c, name='fsync')
         import :: c_int
         integer(c_int), intent(in), value :: descriptor
         integer(c_int) :: status
      end function c_fsync

      !> Get the properties of a file: unlike that of `stat`, this structure of 256 bytes is the
      !> same on all processors
      function c_statx(directory, path, flags, mask, properties) result(status) &
         bind(c, name='statx')
         import :: c_char, c_int, c_int16_t
         integer(c_int), intent(in), value :: directory, flags, mask
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int16_t), intent(inout) :: properties(128)
         integer(c_int) :: status
      end function c_statx

      !> Address of `errno`, a C int, of this thread
      function c_errno_place() result(place) bind(c, name='__errno_location')
         import :: c_ptr
         type(c_ptr) :: place
      end function c_errno_place

      !> Address of a text, ending with NUL, that explains a value of `errno`
      function c_strerror(number) result(text) bind(c, name='strerror')
         import :: c_int, c_ptr
         integer(c_int), intent(in), value :: number
         type(c_ptr) :: text
      end function c_strerror

      !> Length of a C string before its NUL [bytes]
      pure function c_strlen(text) result(length) bind(c, name='strlen')
         import :: c_ptr, c_size_t
         type(c_ptr), intent(in), value :: text
         integer(c_size_t) :: length
      end function c_strlen
   end interface

contains

   !> A text as a C string
   pure function c_text(text) result(terminated)
      character(len=*), intent(in) :: text
      !> The text and a NUL
      character(len=len(text)+1, kind=c_char) :: terminated

      terminated = text//c_null_char
   end function c_text

   !> Text of a C string
   function fortran_text(place) result(text)
      !> Its address, or null
      type(c_ptr), intent(in) :: place
      !> The text; empty for null
      character(len=:), allocatable :: text

      character(kind=c_char), pointer :: letters(:)
      integer :: i, n

      n = 0
      if (c_associated(place)) n = int(c_strlen(place))
      allocate (character(len=n) :: text)
      if (n == 0) return
      call c_f_pointer(place, letters, [n])
      do i = 1, n
         text(i:i) = letters(i)
      end do
   end function fortran_text

   !> What exists at a path
   function file_at(path, follows) result(id)
      character(len=*), intent(in) :: path
      !> Whether to follow links
      logical, intent(in) :: follows
      type(file_id_t) :: id

      ! AT_FDCWD and AT_SYMLINK_NOFOLLOW of C
      integer(c_int), parameter :: current_directory = -100, no_follow = int(z'100', c_int)

      id = file_of(current_directory, path, merge(0_c_int, no_follow, follows))
   end function file_at

   !> Identity of an open file
   function open_file(descriptor) result(id)
      integer(c_int), intent(in) :: descriptor
      type(file_id_t) :: id

      ! AT_EMPTY_PATH of C
      integer(c_int), parameter :: empty_path = int(z'1000', c_int)

      id = file_of(descriptor, '', empty_path)
   end function open_file

   !> Ask the system about a file
   function file_of(directory, path, flags) result(id)
      !> Directory where a relative path begins
      integer(c_int), intent(in) :: directory
      character(len=*), intent(in) :: path
      integer(c_int), intent(in) :: flags
      type(file_id_t) :: id

      ! STATX_TYPE and STATX_INO; S_IFMT, S_IFREG and S_IFDIR of C. The type is at byte 28 (2
      ! bytes), the inode number at byte 32 (8 bytes), the device at byte 136 (8 bytes)
      integer(c_int), parameter :: type_and_number = int(z'101', c_int)
      integer, parameter :: type_bits = int(o'170000'), regular = int(o'100000'), &
         directory_bits = int(o'040000')
      integer(c_int16_t) :: properties(128)

      properties = 0_c_int16_t
      if (c_statx(directory, c_text(path), flags, type_and_number, properties) /= 0) return
      select case (iand(int(properties(15)), type_bits))
      case (regular)
         id%kind = plain_file
      case (directory_bits)
         id%kind = folder
      case default
         id%kind = something_else
      end select
      id%bits = [properties(17:20), properties(69:72)]
   end function file_of

   !> Whether two files exist and are the same
   pure function same_file_id(one, other) result(same)
      type(file_id_t), intent(in) :: one
      type(file_id_t), intent(in) :: other
      logical :: same

      same = one%kind /= nothing_there .and. all(one%bits == other%bits)
   end function same_file_id

   !> Value of `errno`, valid immediately after the failed call
   function last_errno() result(number)
      integer(c_int) :: number

      integer(c_int), pointer :: place

      call c_f_pointer(c_errno_place(), place)
      number = place
   end function last_errno

   !> Explanation of the system for a failure
   function system_reason(number) result(reason)
      integer(c_int), intent(in) :: number
      !> Text such as `No space left on device`
      character(len=:), allocatable :: reason

      reason = fortran_text(c_strerror(number))
   end function system_reason

end module vcor_io_posix
