!> The entries of a case: the value of each key, by its address, and where it comes from
!>
!> There is an entry for each key of the catalogue, given or by default: a group that may occur once
!> has its entries from the start, a repeated group has them for each occurrence. An address is
!> group, item, key and, in a list, element. What one key says about another is in `vcor_case_case`.
module vcor_case_entries
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan, ieee_quiet_nan, ieee_value
   use vcor_case_catalogue, only : catalogue, find_group, find_key, first_row, groups, &
      integer_key, last_row, logical_key, real_key, row_for_model, text_key
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_text, only : canonical_name, integer_text, lower, printable
   implicit none
   private

   public :: entries_t, address_t, entry_t, operator(==)

   !> Place of a value in a case
   type :: address_t
      !> Index of the group in `groups`; 0: nowhere
      integer :: group = 0
      !> Index of the item, 1 for a group that occurs once
      integer :: item = 0
      !> First row of the key in `catalogue`
      integer :: row = 0
      !> Index of the number in a list; 0: the whole value
      integer :: element = 0
   end type address_t

   !> A value and its origin; which component has the value depends on the kind of the key
   type :: entry_t
      !> Whether the user gave it
      logical :: given = .false.
      !> Whether there is a value, given or by default
      logical :: present = .false.
      !> Line of the case file; 0 if it is not there
      integer :: line = 0
      !> Origin if it is not the case file
      character(len=:), allocatable :: origin
      !> A real number in the unit of the key, an integer, or 1 for true and 0 for false
      real(wp) :: number = 0.0_wp
      !> A text
      character(len=:), allocatable :: text
      !> A list of numbers in the unit of the key, shape (n)
      real(wp), allocatable :: list(:)
   end type entry_t

   !> One item of a group
   type :: item_t
      !> Whether the group is in the case, not only its defaults
      logical :: present = .false.
      !> First line of the group in the case file; 0 if it is not there
      integer :: line = 0
      !> Its file, if that is not the case file
      character(len=:), allocatable :: source
      !> Entries, from the first to the last row of the group
      type(entry_t), allocatable :: entry(:)
   end type item_t

   !> All items of a group
   type :: items_t
      !> Number of items
      integer :: n = 0
      !> The items, shape (>= n)
      type(item_t), allocatable :: item(:)
   end type items_t

   !> The entries
   type :: entries_t
      !> Name of the case file, for messages
      character(len=:), allocatable :: source
      !> Folder of its data files, with a slash at its end; unallocated: that of `source`
      character(len=:), allocatable :: folder
      !> Items by group
      type(items_t), allocatable, private :: group(:)
   contains
      procedure :: start, add, adopt, clear, remove, source_of, model, address, path, row, number
      procedure :: given, set_entry, unset, trace, trace_item, refuse
      procedure :: count => count_items
      procedure :: line => line_of_item
      procedure :: entry => entry_at
      generic :: get => get_real, get_integer, get_logical, get_text, get_list
      generic :: set => set_entry, set_number, set_text, set_list
      generic :: location => location_of_key, location_of_address
      procedure, private :: get_real, get_integer, get_logical, get_text, get_list
      procedure, private :: set_number, set_text, set_list, location_of_key, location_of_address
   end type entries_t

   !> Whether two addresses are the same
   interface operator(==)
      module procedure same_address
   end interface operator(==)

contains

   !> Whether two addresses are the same
   elemental function same_address(a, b) result(same)
      type(address_t), intent(in) :: a
      type(address_t), intent(in) :: b
      logical :: same

      same = a%row == b%row .and. a%item == b%item .and. a%element == b%element
   end function same_address

   !> Reset all: no groups, and defaults for all keys
   pure subroutine start(self, source)
      class(entries_t), intent(inout) :: self
      !> Name of the case file
      character(len=*), intent(in) :: source

      integer :: g

      self%source = source
      if (allocated(self%folder)) deallocate (self%folder)
      if (allocated(self%group)) deallocate (self%group)
      allocate (self%group(size(groups)))
      do g = 1, size(groups)
         allocate (self%group(g)%item(merge(4, 1, groups(g)%repeated)))
         if (groups(g)%repeated) cycle
         self%group(g)%n = 1
         call default_item(self%group(g)%item(1), g)
      end do
   end subroutine start

   !> An item with defaults only
   pure subroutine default_item(item, group)
      type(item_t), intent(out) :: item
      !> Index of the group
      integer, intent(in) :: group

      integer :: row

      allocate (item%entry(first_row(group):last_row(group)))
      do row = first_row(group), last_row(group)
         call set_default(item%entry(row), row)
      end do
   end subroutine default_item

   !> Set the default of a key
   pure subroutine set_default(entry, row)
      type(entry_t), intent(out) :: entry
      !> Row of the key
      integer, intent(in) :: row

      character(len=len(catalogue%default)) :: default

      default = catalogue(row)%default
      entry%present = default /= ''
      select case (catalogue(row)%value_kind)
      case (real_key, integer_key)
         if (entry%present) read (default, *) entry%number
      case (logical_key)
         if (default == '.true.') entry%number = 1.0_wp
      case (text_key)
         entry%text = trim(default)
         if (default == "''") entry%text = ''
      case default
         allocate (entry%list(0))
      end select
   end subroutine set_default

   !> Add a group: a new item if it may be repeated, otherwise mark it as present
   pure subroutine add(self, group, line, item)
      class(entries_t), intent(inout) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> First line of the group in the case file; 0 if it is not there
      integer, intent(in) :: line
      !> Index of the item
      integer, intent(out) :: item

      type(item_t), allocatable :: larger(:)

      associate (items => self%group(group))
         if (groups(group)%repeated) then
            if (items%n == size(items%item)) then
               allocate (larger(2*items%n))
               larger(:items%n) = items%item
               call move_alloc(larger, items%item)
            end if
            items%n = items%n + 1
            call default_item(items%item(items%n), group)
         end if
         item = items%n
         items%item(item)%present = .true.
         items%item(item)%line = line
      end associate
   end subroutine add

   !> Add a material of another case, or put it in the place of one; it keeps its file and its
   !> lines
   pure subroutine adopt(self, other, item, place)
      class(entries_t), intent(inout) :: self
      class(entries_t), intent(in) :: other
      !> Index of the material in the other case
      integer, intent(in) :: item
      !> Index of the material that it replaces; absent: none
      integer, intent(in), optional :: place

      integer :: group, own

      group = find_group('material')
      if (present(place)) then
         own = place
      else
         call self%add(group, 0, own)
      end if
      self%group(group)%item(own) = other%group(group)%item(item)
      self%group(group)%item(own)%source = other%source_of(item)
   end subroutine adopt

   !> Remove all items of a group that may be repeated
   pure subroutine clear(self, group)
      class(entries_t), intent(inout) :: self
      !> Index of the group
      integer, intent(in) :: group

      self%group(group)%n = 0
   end subroutine clear

   !> Remove an item of a group; a group that occurs once is then as if it were not in the case
   pure subroutine remove(self, group, item)
      class(entries_t), intent(inout) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Index of the item
      integer, intent(in) :: item

      integer :: i

      associate (items => self%group(group))
         if (groups(group)%repeated) then
            do i = item, items%n - 1
               items%item(i) = items%item(i + 1)
            end do
            items%n = items%n - 1
         else
            call default_item(items%item(item), group)
         end if
      end associate
   end subroutine remove

   !> File of a material
   pure function source_of(self, item) result(source)
      class(entries_t), intent(in) :: self
      !> Index of the material
      integer, intent(in) :: item
      character(len=:), allocatable :: source

      source = self%source
      associate (material => self%group(find_group('material'))%item(item))
         if (allocated(material%source)) source = material%source
      end associate
   end function source_of

   !> Number of occurrences of a group in the case
   pure function count_items(self, group) result(n)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group
      integer :: n

      integer :: g

      n = 0
      g = find_group(group)
      if (g == 0 .or. .not. allocated(self%group)) return
      n = count(self%group(g)%item(:self%group(g)%n)%present)
   end function count_items

   !> First line of a group in the case file
   pure function line_of_item(self, group, item) result(line)
      class(entries_t), intent(in) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Index of the item
      integer, intent(in) :: item
      !> The line; 0 if there is none
      integer :: line

      line = self%group(group)%item(item)%line
   end function line_of_item

   !> Value of the selector of an item, such as the model of a material
   pure function model(self, group, item) result(word)
      class(entries_t), intent(in) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Index of the item
      integer, intent(in) :: item
      !> The value in lower case; empty if the group has no selector
      character(len=:), allocatable :: word

      word = ''
      if (groups(group)%selector == '') return
      word = lower(self%group(group)%item(item)%entry( &
         find_key(groups(group)%name, groups(group)%selector))%text)
   end function model

   !> Address of a key
   pure function address(self, group, key, item)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item
      !> The address, nowhere if there is no such key or item
      type(address_t) :: address

      integer :: g, i

      i = 1
      if (present(item)) i = item
      g = find_group(group)
      if (g == 0 .or. .not. allocated(self%group)) return
      if (i < 1 .or. i > self%group(g)%n) return
      address%row = find_key(group, key)
      if (address%row == 0) return
      address%group = g
      address%item = i
   end function address

   !> Path of an address, `group.key`, `material_name.key` or `material_name.key(2)`
   pure function path(self, address) result(text)
      class(entries_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> The path, without blanks; empty for nowhere
      character(len=:), allocatable :: text

      character(len=:), allocatable :: label

      text = ''
      if (address%group == 0) return
      associate (group => groups(address%group))
         text = trim(group%name)
         if (group%label /= '') then
            call self%get(group%name, group%label, label, address%item)
            if (label /= '') text = canonical_name(label)
         end if
      end associate
      text = text//'.'//trim(catalogue(address%row)%name)
      if (address%element > 0) text = text//'('//integer_text(address%element)//')'
   end function path

   !> Row of the catalogue for an address, which depends on the model
   pure function row(self, address)
      class(entries_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> The row, 0 if the key does not belong to the model
      integer :: row

      row = row_for_model(address%row, self%model(address%group, address%item))
   end function row

   !> Entry at an address
   pure function entry_at(self, address) result(entry)
      class(entries_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> The entry, its text and list allocated; without a value for nowhere
      type(entry_t) :: entry

      if (address%group > 0) &
         entry = self%group(address%group)%item(address%item)%entry(address%row)
      if (.not. allocated(entry%text)) entry%text = ''
      if (.not. allocated(entry%list)) allocate (entry%list(0))
      if (address%element > 0) entry%number = entry%list(address%element)
   end function entry_at

   !> Number at an address, of a real, integer or logical key, or in a list; a quiet NaN if there is
   !> none
   pure function number(self, address)
      class(entries_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> The number, in the unit of the key
      real(wp) :: number

      ! NaN reveals calculations with a missing number
      number = ieee_value(number, ieee_quiet_nan)
      if (address%group == 0) return
      associate (entry => self%group(address%group)%item(address%item)%entry(address%row))
         if (address%element > 0) then
            number = entry%list(address%element)
         else if (entry%present) then
            number = entry%number
         end if
      end associate
   end function number

   !> Value of a real key; a quiet NaN if there is none
   pure subroutine get_real(self, group, key, value, item)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> In the unit of the key
      real(wp), intent(out) :: value
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item

      value = self%number(self%address(group, key, item))
   end subroutine get_real

   !> Value of an integer key; `-huge(1)` if there is none
   pure subroutine get_integer(self, group, key, value, item)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      integer, intent(out) :: value
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item

      value = -huge(value)
      if (.not. ieee_is_nan(self%number(self%address(group, key, item)))) &
         value = nint(self%number(self%address(group, key, item)))
   end subroutine get_integer

   !> Value of a logical key; false if there is none
   pure subroutine get_logical(self, group, key, value, item)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      logical, intent(out) :: value
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item

      type(entry_t) :: entry

      entry = self%entry(self%address(group, key, item))
      value = entry%number > 0.5_wp
   end subroutine get_logical

   !> Value of a text key; empty if there is none
   pure subroutine get_text(self, group, key, value, item)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> A choice as the catalogue spells it
      character(len=:), allocatable, intent(out) :: value
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item

      type(entry_t) :: entry

      entry = self%entry(self%address(group, key, item))
      call move_alloc(entry%text, value)
   end subroutine get_text

   !> Value of a list key; shape (0) if there is none
   pure subroutine get_list(self, group, key, value, item)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> In the unit of the key, shape (n)
      real(wp), allocatable, intent(out) :: value(:)
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item

      type(entry_t) :: entry

      entry = self%entry(self%address(group, key, item))
      call move_alloc(entry%list, value)
   end subroutine get_list

   !> Whether the user gave a key
   pure function given(self, group, key, item)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item
      logical :: given

      type(entry_t) :: entry

      entry = self%entry(self%address(group, key, item))
      given = entry%given
   end function given

   !> Set an entry without checks; for a number in a list, only that number
   pure subroutine set_entry(self, address, entry)
      class(entries_t), intent(inout) :: self
      type(address_t), intent(in) :: address
      type(entry_t), intent(in) :: entry

      real(wp), allocatable :: list(:)

      associate (item => self%group(address%group)%item(address%item))
         if (address%element > 0) list = item%entry(address%row)%list
         item%entry(address%row) = entry
         if (address%element > 0) then
            list(address%element) = entry%number
            call move_alloc(list, item%entry(address%row)%list)
         end if
      end associate
      call mark(self, address, entry%given)
   end subroutine set_entry

   !> Set a number without checks
   pure subroutine set_number(self, address, number)
      class(entries_t), intent(inout) :: self
      !> Address of a real, integer or logical key, or of a number in a list
      type(address_t), intent(in) :: address
      !> The number, in the unit of the key
      real(wp), intent(in) :: number

      associate (entry => self%group(address%group)%item(address%item)%entry(address%row))
         if (address%element > 0) then
            entry%list(address%element) = number
         else
            entry%number = number
         end if
      end associate
      call mark(self, address, .true.)
   end subroutine set_number

   !> Set a text without checks
   pure subroutine set_text(self, address, text, given)
      class(entries_t), intent(inout) :: self
      !> Address of a text key
      type(address_t), intent(in) :: address
      character(len=*), intent(in) :: text
      !> Whether it counts as given by the user
      logical, intent(in) :: given

      self%group(address%group)%item(address%item)%entry(address%row)%text = text
      call mark(self, address, given)
   end subroutine set_text

   !> Set a list without checks
   pure subroutine set_list(self, address, list, given)
      class(entries_t), intent(inout) :: self
      !> Address of a list key
      type(address_t), intent(in) :: address
      !> The list, in the unit of the key, shape (n)
      real(wp), intent(in) :: list(:)
      !> Whether it counts as given by the user
      logical, intent(in) :: given

      self%group(address%group)%item(address%item)%entry(address%row)%list = list
      call mark(self, address, given)
   end subroutine set_list

   !> Record that an entry has a value; if it is given, its group counts as present
   pure subroutine mark(self, address, given)
      class(entries_t), intent(inout) :: self
      type(address_t), intent(in) :: address
      !> Whether the user gave the value
      logical, intent(in) :: given

      associate (item => self%group(address%group)%item(address%item))
         item%entry(address%row)%present = .true.
         item%entry(address%row)%given = given
         if (given) item%present = .true.
      end associate
   end subroutine mark

   !> Reset a key to its default
   pure subroutine unset(self, address)
      class(entries_t), intent(inout) :: self
      type(address_t), intent(in) :: address

      call set_default(self%group(address%group)%item(address%item)%entry(address%row), &
         address%row)
   end subroutine unset

   !> State where the value at an address comes from
   pure subroutine trace(self, address, line, origin)
      class(entries_t), intent(inout) :: self
      type(address_t), intent(in) :: address
      !> Line of the case file; 0 if it is not there
      integer, intent(in) :: line
      !> Origin if it is not the case file; otherwise empty
      character(len=*), intent(in) :: origin

      associate (entry => self%group(address%group)%item(address%item)%entry(address%row))
         entry%line = line
         if (allocated(entry%origin)) deallocate (entry%origin)
         if (origin /= '') entry%origin = origin
      end associate
   end subroutine trace

   !> State where an item of a group comes from
   pure subroutine trace_item(self, group, item, line, source)
      class(entries_t), intent(inout) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Index of the item
      integer, intent(in) :: item
      !> First line of the group in its file; 0 if it is not there
      integer, intent(in) :: line
      !> Its file
      character(len=*), intent(in) :: source

      associate (place => self%group(group)%item(item))
         place%line = line
         if (allocated(place%source)) deallocate (place%source)
         if (source /= self%source) place%source = source
      end associate
   end subroutine trace_item

   !> Raise an error about a key
   pure subroutine refuse(self, group, key, item, message, error)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> Index of the item
      integer, intent(in) :: item
      !> Text with found and expected values
      character(len=*), intent(in) :: message
      type(error_t), allocatable, intent(inout) :: error

      call raise(error, error_input, self%location(group, key, item)//': '//message)
   end subroutine refuse

   !> Place where a key was given, for messages
   pure function location_of_key(self, group, key, item) result(text)
      class(entries_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> Index of the item; absent: 1
      integer, intent(in), optional :: item
      !> The place, with which a message begins
      character(len=:), allocatable :: text

      text = self%location(self%address(group, key, item))
   end function location_of_key

   !> Place where the value at an address was given, `case.nml:12`; the line of its group if it was
   !> not given, or only the file
   pure function location_of_address(self, address) result(text)
      class(entries_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> The place, with which a message begins
      character(len=:), allocatable :: text

      integer :: line

      text = printable(self%source)
      if (address%group == 0) return
      associate (item => self%group(address%group)%item(address%item))
         if (allocated(item%source)) text = printable(item%source)
         if (allocated(item%entry(address%row)%origin)) then
            text = item%entry(address%row)%origin
            return
         end if
         line = item%entry(address%row)%line
         if (line == 0) line = item%line
      end associate
      if (line > 0) text = text//':'//integer_text(line)
   end function location_of_address

end module vcor_case_entries
