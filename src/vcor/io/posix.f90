!> The system calls behind files: interfaces to C and POSIX, used by `vcor_io` alone
!>
!> Fortran's own units hide what matters here: gfortran writes its buffer when a unit is closed and
!> reports no error if the disk is full then; it has no rename, no directories, no exclusive
!> creation and no locks. All functions are called as C declares them, none is variadic. A path ends
!> with NUL (`c_text`); a `status` is 0 on success. Two functions are Linux's own:
!> `__errno_location` (its name is `__error` on macOS) and `statx`.
module vcor_io_posix
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_f_pointer, c_int, c_int16_t, &
      c_int64_t, c_null_char, c_ptr, c_size_t
   implicit none
   private

   public :: c_fopen, c_fclose, c_fileno, c_rename, c_unlink, c_mkdtemp, c_rmdir, c_mkdir, &
      c_realpath, longest_path
   public :: c_write, c_isatty, c_fallocate, c_pwrite, c_fsync, c_lockf, c_link
   public :: standard_output, standard_error, all_permissions, lock_alone
   public :: last_errno, errno_exists, errno_interrupted, errno_locked, system_reason
   public :: c_text, fortran_text
   public :: file_id_t, file_at, open_file, same_file_id
   public :: nothing_there, plain_file, folder, something_else

   !> File descriptors
   integer(c_int), parameter :: standard_output = 1, standard_error = 2
   !> Values of `errno`: interrupted by a signal (EINTR), another process has the lock (EAGAIN),
   !> there is something of that name (EEXIST)
   integer(c_int), parameter :: errno_interrupted = 4, errno_locked = 11, errno_exists = 17
   !> Permissions rwxrwxrwx, of which the user's umask takes its part away
   integer(c_int), parameter :: all_permissions = int(o'777', c_int)
   !> Operation of `c_lockf`: for this process alone, without waiting (F_TLOCK)
   integer(c_int), parameter :: lock_alone = 2

   !> Bytes of the longest path, with its NUL (PATH_MAX)
   integer, parameter :: longest_path = 4096

   !> What there is at a path; something else is a link that is not followed, a pipe or a device
   integer, parameter :: nothing_there = 0, plain_file = 1, folder = 2, something_else = 3

   !> A file whatever its names: what there is, its device and its number on it
   type :: file_id_t
      !> `nothing_there`, `plain_file`, `folder` or `something_else`
      integer :: kind = nothing_there
      !> Device and number, as the system keeps them
      integer(c_int16_t) :: bits(8) = 0_c_int16_t
   end type file_id_t

   interface
      !> Open a stream, to write files; null if that fails. The mode ends with NUL: `abx` creates a
      !> file, with the permissions that the umask leaves, fails where there is anything of that
      !> name, and writes to the end of the file, wherever others have moved that
      function c_fopen(path, mode) result(stream) bind(c, name='fopen')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*), mode(*)
         type(c_ptr) :: stream
      end function c_fopen

      !> Close a stream, whatever the status
      function c_fclose(stream) result(status) bind(c, name='fclose')
         import :: c_int, c_ptr
         type(c_ptr), intent(in), value :: stream
         integer(c_int) :: status
      end function c_fclose

      !> File descriptor of a stream, for the calls that take one
      function c_fileno(stream) result(descriptor) bind(c, name='fileno')
         import :: c_int, c_ptr
         type(c_ptr), intent(in), value :: stream
         integer(c_int) :: descriptor
      end function c_fileno

      !> Give a file another name, in place of what has that name: complete files get theirs so
      function c_rename(old, new) result(status) bind(c, name='rename')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: old(*), new(*)
         integer(c_int) :: status
      end function c_rename

      !> Remove a file, not a folder; a handler of signals may call it
      function c_unlink(path) result(status) bind(c, name='unlink')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int) :: status
      end function c_unlink

      !> Make a folder of a name that nothing has, for the user alone; null if that fails. The
      !> template ends with XXXXXX and NUL and holds the name on return
      function c_mkdtemp(template) result(place) bind(c, name='mkdtemp')
         import :: c_char, c_ptr
         character(kind=c_char), intent(inout) :: template(*)
         type(c_ptr) :: place
      end function c_mkdtemp

      !> Remove an empty folder; a handler of signals may call it
      function c_rmdir(path) result(status) bind(c, name='rmdir')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int) :: status
      end function c_rmdir

      !> Path from the root, without links and points; null if there is nothing
      function c_realpath(path, resolved) result(place) bind(c, name='realpath')
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*)
         !> Room for `longest_path` bytes
         character(kind=c_char), intent(inout) :: resolved(*)
         type(c_ptr) :: place
      end function c_realpath

      !> Make a folder for results, with the permissions that the umask leaves
      function c_mkdir(path, mode) result(status) bind(c, name='mkdir')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), intent(in), value :: mode
         integer(c_int) :: status
      end function c_mkdir

      !> Write `count` bytes to a file descriptor: how many were written, maybe fewer, or -1 if it
      !> failed
      function c_write(descriptor, bytes, count) result(written) bind(c, name='write')
         import :: c_char, c_int, c_size_t
         integer(c_int), intent(in), value :: descriptor
         character(kind=c_char), intent(in) :: bytes(*)
         integer(c_size_t), intent(in), value :: count
         integer(c_size_t) :: written
      end function c_write

      !> 1 if a file descriptor is a terminal, which is shown the progress of a sweep
      function c_isatty(descriptor) result(is_one) bind(c, name='isatty')
         import :: c_int
         integer(c_int), intent(in), value :: descriptor
         integer(c_int) :: is_one
      end function c_isatty

      !> Take room on the disk for `length` bytes of a file from `offset` on; the status is a value
      !> of `errno`
      function c_fallocate(descriptor, offset, length) result(status) &
         bind(c, name='posix_fallocate')
         import :: c_int, c_int64_t
         integer(c_int), intent(in), value :: descriptor
         integer(c_int64_t), intent(in), value :: offset, length
         integer(c_int) :: status
      end function c_fallocate

      !> As `c_write`, to the place behind the first `offset` bytes of a file: a checkpoint keeps
      !> outcomes so
      function c_pwrite(descriptor, bytes, count, offset) result(written) bind(c, name='pwrite')
         import :: c_int, c_int64_t, c_ptr, c_size_t
         integer(c_int), intent(in), value :: descriptor
         type(c_ptr), intent(in), value :: bytes
         integer(c_size_t), intent(in), value :: count
         integer(c_int64_t), intent(in), value :: offset
         integer(c_size_t) :: written
      end function c_pwrite

      !> Hand what was written to a file to the disk, before a checkpoint is closed
      function c_fsync(descriptor) result(status) bind(c, name='fsync')
         import :: c_int
         integer(c_int), intent(in), value :: descriptor
         integer(c_int) :: status
      end function c_fsync

      !> Lock `length` bytes of a file, 0 for all, from where it is read or written next, as long as
      !> the process has it open: a checkpoint belongs to one process
      function c_lockf(descriptor, operation, length) result(status) bind(c, name='lockf')
         import :: c_int, c_int64_t
         integer(c_int), intent(in), value :: descriptor, operation
         integer(c_int64_t), intent(in), value :: length
         integer(c_int) :: status
      end function c_lockf

      !> Give a file one more name; fails where there is anything of that name
      function c_link(old, new) result(status) bind(c, name='link')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: old(*), new(*)
         integer(c_int) :: status
      end function c_link

      !> Ask for the properties of a file: unlike that of `stat`, the structure of 256 bytes is the
      !> same on all processors
      function c_statx(directory, path, flags, mask, properties) result(status) &
         bind(c, name='statx')
         import :: c_char, c_int, c_int16_t
         integer(c_int), intent(in), value :: directory, flags, mask
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int16_t), intent(inout) :: properties(128)
         integer(c_int) :: status
      end function c_statx

      !> Address of `errno` of this thread, a C int
      function c_errno_place() result(place) bind(c, name='__errno_location')
         import :: c_ptr
         type(c_ptr) :: place
      end function c_errno_place

      !> Address of a text that says what an `errno` means and ends with NUL
      function c_strerror(number) result(text) bind(c, name='strerror')
         import :: c_int, c_ptr
         integer(c_int), intent(in), value :: number
         type(c_ptr) :: text
      end function c_strerror

      !> Bytes of a text of C before its NUL
      pure function c_strlen(text) result(length) bind(c, name='strlen')
         import :: c_ptr, c_size_t
         type(c_ptr), intent(in), value :: text
         integer(c_size_t) :: length
      end function c_strlen
   end interface

contains

   !> A text as C wants it
   pure function c_text(text) result(terminated)
      character(len=*), intent(in) :: text
      !> The text and a NUL
      character(len=len(text)+1, kind=c_char) :: terminated

      terminated = text//c_null_char
   end function c_text

   !> A text of C
   function fortran_text(place) result(text)
      !> Where it begins, or null
      type(c_ptr), intent(in) :: place
      !> The same; of null an empty one
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

   !> What there is at a path
   function file_at(path, follows) result(id)
      character(len=*), intent(in) :: path
      !> Whether a link counts as what it points at
      logical, intent(in) :: follows
      type(file_id_t) :: id

      ! AT_FDCWD and AT_SYMLINK_NOFOLLOW of C
      integer(c_int), parameter :: current_directory = -100, no_follow = int(z'100', c_int)

      id = file_of(current_directory, path, merge(0_c_int, no_follow, follows))
   end function file_at

   !> The file behind a descriptor
   function open_file(descriptor) result(id)
      integer(c_int), intent(in) :: descriptor
      type(file_id_t) :: id

      ! AT_EMPTY_PATH of C
      integer(c_int), parameter :: empty_path = int(z'1000', c_int)

      id = file_of(descriptor, '', empty_path)
   end function open_file

   !> Ask the system for a file
   function file_of(directory, path, flags) result(id)
      !> Where a relative path begins
      integer(c_int), intent(in) :: directory
      character(len=*), intent(in) :: path
      integer(c_int), intent(in) :: flags
      type(file_id_t) :: id

      ! STATX_TYPE and STATX_INO; S_IFMT, S_IFREG and S_IFDIR of C. The type is two bytes from byte
      ! 28 on, the number 8 bytes from byte 32 on, the device 8 bytes from byte 136 on
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

   !> Whether two files are one, and there is one
   pure function same_file_id(one, other) result(same)
      type(file_id_t), intent(in) :: one
      type(file_id_t), intent(in) :: other
      logical :: same

      same = one%kind /= nothing_there .and. all(one%bits == other%bits)
   end function same_file_id

   !> Value of `errno`: to be asked for right after the call that failed
   function last_errno() result(number)
      integer(c_int) :: number

      integer(c_int), pointer :: place

      call c_f_pointer(c_errno_place(), place)
      number = place
   end function last_errno

   !> What the system says about a failure
   function system_reason(number) result(reason)
      integer(c_int), intent(in) :: number
      !> Text such as `No space left on device`
      character(len=:), allocatable :: reason

      reason = fortran_text(c_strerror(number))
   end function system_reason

end module vcor_io_posix
