!> Private folders: where a file is before it is complete
!>
!> A folder `.vcor-XXXXXX` is made in the folder of the file, so that renaming stays within one file
!> system, under a name that nobody can foresee and with permissions for the user alone. What is
!> made in it meets no link, pipe or file of anybody else, and nobody else can read it.
!>
!> What is there is remembered, and removed by `remove_all_scratch` if a signal ends the process. A
!> folder that a killed process has left means nothing to any other run, and may be removed.
module vcor_io_scratch
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_int, c_null_char
   use vcor_error, only : error_t
   use vcor_io_path, only : join_path, quoted_path, raise_system
   use vcor_io_posix, only : c_mkdtemp, c_mkstemp, c_rmdir, c_text, c_unlink, last_errno
   implicit none
   private

   public :: make_scratch, make_scratch_file, remember, forget, remove_scratch, remove_all_scratch

   !> Longest path that is remembered (PATH_MAX of Linux), and most of them; a run has few at a time
   integer, parameter :: longest = 4096, most = 32

   !> A path as C has it
   type :: place_t
      !> Whether it is in use
      logical :: is_used = .false.
      !> The path, ends with NUL
      character(kind=c_char) :: path(longest) = c_null_char
   end type place_t

   !> Folders and files that are there now
   type(place_t), volatile :: places(most)

contains

   !> Make a private folder
   subroutine make_scratch(folder, path, error)
      !> Its path; unallocated if it cannot be made
      character(len=:), allocatable, intent(out) :: folder
      !> Path of what is to be written, in whose folder it is made
      character(len=*), intent(in) :: path
      !> Set if it cannot be made
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: template

      template = c_text(path(:index(path, "/", back=.true.))//".vcor-XXXXXX")
      if (c_associated(c_mkdtemp(template))) then
         folder = template(:len(template)-1)
         call remember(folder)
      else
         call raise_system(error, "cannot write "//quoted_path(path), last_errno())
      end if
   end subroutine make_scratch

   !> Create a file in a private folder, for the user alone
   subroutine make_scratch_file(folder, path, descriptor)
      !> The folder
      character(len=*), intent(in) :: folder
      !> Path of the file; unallocated if it cannot be created
      character(len=:), allocatable, intent(out) :: path
      !> File descriptor, negative if it cannot be created
      integer(c_int), intent(out) :: descriptor
      character(len=:), allocatable :: template

      template = c_text(join_path(folder, "XXXXXX"))
      descriptor = c_mkstemp(template)
      if (descriptor < 0) return
      path = template(:len(template)-1)
      call remember(path)
   end subroutine make_scratch_file

   !> Remember a path: a signal that ends the process removes what has it
   subroutine remember(path)
      !> Path of a file in a private folder, or of such a folder
      character(len=*), intent(in) :: path
      integer :: i, j

      if (len(path) >= longest) return
!$omp critical (vcor_scratch)
      do i = 1, most
         if (places(i)%is_used) cycle
         do j = 1, len(path)
            places(i)%path(j) = path(j:j)
         end do
         places(i)%path(len(path)+1) = c_null_char
         places(i)%is_used = .true.
         exit
      end do
!$omp end critical (vcor_scratch)
   end subroutine remember

   !> Forget a path: what had it is gone, or has its real name
   subroutine forget(path)
      !> The path
      character(len=*), intent(in) :: path
      integer :: i, j
      logical :: same

      if (len(path) >= longest) return
!$omp critical (vcor_scratch)
      do i = 1, most
         if (.not. places(i)%is_used) cycle
         same = places(i)%path(len(path)+1) == c_null_char
         do j = 1, len(path)
            if (.not. same) exit
            same = places(i)%path(j) == path(j:j)
         end do
         if (same) places(i)%is_used = .false.
      end do
!$omp end critical (vcor_scratch)
   end subroutine forget

   !> Remove a file in a private folder, or such a folder if it is empty; none is fine
   subroutine remove_scratch(path)
      !> Its path
      character(len=*), intent(in) :: path
      integer(c_int) :: ignored

      if (c_unlink(c_text(path)) /= 0) ignored = c_rmdir(c_text(path))
      call forget(path)
   end subroutine remove_scratch

   !> Remove all that is remembered; does nothing that a handler of signals may not do
   subroutine remove_all_scratch()
      integer(c_int) :: ignored
      integer :: i, pass

      ! files, the folders that are empty then, and those that hold such folders
      do pass = 1, 3
         do i = 1, most
            if (.not. places(i)%is_used) cycle
            if (pass == 1) then
               ignored = c_unlink(places(i)%path)
            else
               ignored = c_rmdir(places(i)%path)
            end if
         end do
      end do
   end subroutine remove_all_scratch

end module vcor_io_scratch
