!> Values of a case by group and key, with their ranges: what the rest of the program asks a case
!> for
module vcor_case_entries
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use vcor_error, only : error_input, error_internal, error_t, raise
   use vcor_kinds, only : wp
   use vcor_interval, only : contains_number
   use vcor_case_catalogue, only : catalogue, groups, integer_key, real_key, row_for_model, wanted
   use vcor_case_store, only : entry_t, store_t
   use vcor_text, only : canonical_name, integer_text, printable, real_text, same_name
   implicit none
   private

   public :: entries_t

   !> Entries of all groups, by name
   type, extends(store_t) :: entries_t
   contains
      !> Set a number by its handle, if it is within its range
      generic :: put => put_real, put_integer
      procedure, private :: put_real
      procedure, private :: put_integer
      !> Value of a key
      generic :: get => get_real, get_integer, get_logical, get_text, get_list
      procedure, private :: get_real
      procedure, private :: get_integer
      procedure, private :: get_logical
      procedure, private :: get_text
      procedure, private :: get_list
      !> Whether a key was given
      procedure :: given
      !> Whether a key has a value, given or by default
      procedure :: has_value
      !> Where a key was given, for messages
      procedure :: location
      !> Path of an entry, `group.key` or `material_name.key`
      procedure :: path
      !> Item of the material of a name
      procedure :: find_material
   end type entries_t

contains

   !> Set a number by its handle, if it is within its range
   subroutine put_real(self, handle, number, error)
      !> The entries
      class(entries_t), intent(inout) :: self
      !> Handle of a real or integer key
      integer, intent(in) :: handle
      !> The number, in the unit of the key; integral where the key is an integer
      real(wp), intent(in) :: number
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      integer :: group, row, item, applicable

      call self%locate(handle, group, row, item)
      if (group == 0) then
         call raise(error, error_internal, "there is no entry of handle "//integer_text(handle))
         return
      end if
      applicable = row_for_model(row, self%model(group, item))
      if (applicable == 0) applicable = row
      associate (key => catalogue(applicable))
         if (key%value_kind /= real_key .and. key%value_kind /= integer_key) then
            call raise(error, error_internal, self%path(handle)//" is not a number")
         else if (.not. contains_number(key%range, number)) then
            call raise(error, error_input, &
               & self%path(handle)//": found "//real_text(number)//", expected "//wanted(key))
         else if (key%value_kind == integer_key .and. abs(number - anint(number)) > 0.0_wp) then
            call raise(error, error_input, &
               & self%path(handle)//": found "//real_text(number)//", expected "//wanted(key))
         else
            call self%assign_number(handle, number)
         end if
      end associate
   end subroutine put_real

   !> Set a number by its handle, if it is within its range
   subroutine put_integer(self, handle, number, error)
      !> The entries
      class(entries_t), intent(inout) :: self
      !> Handle of a real or integer key
      integer, intent(in) :: handle
      !> The number, in the unit of the key
      integer, intent(in) :: number
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      call self%put_real(handle, real(number, wp), error)
   end subroutine put_integer

   !> Value of a real key; a quiet NaN where there is none
   pure subroutine get_real(self, group, key, value, item)
      !> The entries
      class(entries_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> The value, in the unit of the key
      real(wp), intent(out) :: value
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      type(entry_t) :: entry

      entry = self%entry(self%handle(group, key, item))
      value = entry%number
      if (.not. entry%present) value = ieee_value(value, ieee_quiet_nan)
   end subroutine get_real

   !> Value of an integer key; `-huge(1)` where there is none
   pure subroutine get_integer(self, group, key, value, item)
      !> The entries
      class(entries_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> The value
      integer, intent(out) :: value
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      type(entry_t) :: entry

      entry = self%entry(self%handle(group, key, item))
      value = entry%whole
      if (.not. entry%present) value = -huge(value)
   end subroutine get_integer

   !> Value of a logical key; false where there is none
   pure subroutine get_logical(self, group, key, value, item)
      !> The entries
      class(entries_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> The value
      logical, intent(out) :: value
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      type(entry_t) :: entry

      entry = self%entry(self%handle(group, key, item))
      value = entry%flag
   end subroutine get_logical

   !> Value of a text key; empty where there is none
   pure subroutine get_text(self, group, key, value, item)
      !> The entries
      class(entries_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> The value; choices as the catalogue has them
      character(len=:), allocatable, intent(out) :: value
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      type(entry_t) :: entry

      entry = self%entry(self%handle(group, key, item))
      value = entry%text
   end subroutine get_text

   !> Value of a list key; without elements where there is none
   pure subroutine get_list(self, group, key, value, item)
      !> The entries
      class(entries_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> The values, in the unit of the key, shape (n)
      real(wp), allocatable, intent(out) :: value(:)
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      type(entry_t) :: entry

      entry = self%entry(self%handle(group, key, item))
      value = entry%list
   end subroutine get_list

   !> Whether a key was given
   pure function given(self, group, key, item) result(yes)
      !> The entries
      class(entries_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      !> True if it was
      logical :: yes

      yes = self%is_given(self%handle(group, key, item))
   end function given

   !> Whether a key has a value, given or by default
   pure function has_value(self, group, key, item) result(yes)
      !> The entries
      class(entries_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      !> True if it has one
      logical :: yes
      type(entry_t) :: entry

      entry = self%entry(self%handle(group, key, item))
      yes = entry%present
   end function has_value

   !> Where a key was given, `case.nml:12`; the line of its group where it was not, or the file
   !> alone
   pure function location(self, group, key, item) result(text)
      !> The entries
      class(entries_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      !> The place, for the beginning of a message
      character(len=:), allocatable :: text
      type(entry_t) :: entry
      integer :: handle, g, row, i, line

      handle = self%handle(group, key, item)
      entry = self%entry(handle)
      if (allocated(entry%origin)) then
         text = entry%origin
         return
      end if
      line = entry%line
      if (line == 0 .and. handle > 0) then
         call self%locate(handle, g, row, i)
         line = self%line(g, i)
      end if
      text = printable(self%source)
      if (line > 0) text = text//":"//integer_text(line)
   end function location

   !> Path of an entry, `group.key` or `material_name.key`
   pure function path(self, handle) result(text)
      !> The entries
      class(entries_t), intent(in) :: self
      !> The handle
      integer, intent(in) :: handle
      !> The path, without blanks
      character(len=:), allocatable :: text
      type(entry_t) :: label
      integer :: group, row, item

      call self%locate(handle, group, row, item)
      text = ""
      if (group == 0) return
      text = trim(groups(group)%name)
      if (groups(group)%label /= "") then
         label = self%entry(self%handle(groups(group)%name, groups(group)%label, item))
         if (label%text /= "") text = canonical_name(label%text)
      end if
      text = text//"."//trim(catalogue(row)%name)
   end function path

   !> Item of the material of a name; case, and blanks against underscores, make no difference
   pure function find_material(self, name) result(item)
      !> The entries
      class(entries_t), intent(in) :: self
      !> Name of the material
      character(len=*), intent(in) :: name
      !> Number of the first item of this name, 0 when there is none
      integer :: item
      character(len=:), allocatable :: other

      do item = 1, self%count("material")
         call self%get("material", "name", other, item)
         if (same_name(name, other)) return
      end do
      item = 0
   end function find_material

end module vcor_case_entries
