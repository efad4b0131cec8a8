!> A case: the description of an impact, of how it is solved and what is written, as a user gives it
!>
!> Filled by `vcor_io_case_reader`, or by `add`, `assign` and `put`; `validate` says whether it
!> makes sense. After
!> that every value is within its range, and whatever one value needs of another is there.
module vcor_case_case
   use vcor_error, only : error_t
   use vcor_case_checks, only : check_case
   use vcor_case_entries, only : entries_t
   use vcor_case_path, only : resolve_path
   use vcor_case_printed, only : printed_case
   use vcor_case_store, only : entry_t
   implicit none
   private

   public :: case_t

   !> A case
   type, extends(entries_t) :: case_t
   contains
      !> Begin anew, for a case file of this name
      procedure :: start
      !> Check everything that can be told from the case alone
      procedure :: validate
      !> Handle of the entry a path leads to
      procedure :: resolve
      !> The case as namelists
      procedure :: to_text
   end type case_t

contains

   !> Begin anew, for a case file of this name: no group is there, every key has its default
   pure subroutine start(self, source)
      !> The case
      class(case_t), intent(inout) :: self
      !> Name of the case file; the default of `output.stem` is made from it
      character(len=*), intent(in) :: source
      character(len=*), parameter :: extension = ".nml"
      type(entry_t) :: stem
      integer :: mark

      call self%clear(source)
      stem%text = trim(source(index(source, "/", back=.true.)+1:))
      mark = index(stem%text, extension, back=.true.)
      if (mark > 1 .and. mark == len(stem%text) - len(extension) + 1) stem%text = stem%text(:mark-1)
      if (len(stem%text) == 0) stem%text = "case"
      stem%present = .true.
      call self%assign(self%handle("output", "stem"), stem)
   end subroutine start

   !> Check everything that can be told from the case alone: what must be there, ranges, and one
   !> value against
   !> another
   subroutine validate(self, error)
      !> The case
      class(case_t), intent(in) :: self
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      call check_case(self, error)
   end subroutine validate

   !> Handle of the entry a path leads to: `group.key`, or `name.key` for the material of this name
   pure subroutine resolve(self, path, handle, message)
      !> The case
      class(case_t), intent(in) :: self
      !> The path; the name of a material may be in quotes, its blanks may be underscores
      character(len=*), intent(in) :: path
      !> The handle, 0 where the path leads nowhere
      integer, intent(out) :: handle
      !> What is wrong with the path, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      call resolve_path(self, path, handle, message)
   end subroutine resolve

   !> The case as namelists, readable by vcor and by any other reader of namelists to the same
   !> values
   pure function to_text(self, complete, remarks) result(text)
      !> The case
      class(case_t), intent(in) :: self
      !> Whether what was not given is printed with its default; absent: no
      logical, intent(in), optional :: complete
      !> Whether each key has a comment with unit and meaning; absent: no
      logical, intent(in), optional :: remarks
      !> Lines, each with a line feed at its end
      character(len=:), allocatable :: text

      text = printed_case(self, complete, remarks)
   end function to_text

end module vcor_case_case
