!> A case: the description of an impact, of how it is solved and of what is written, as a user
!> gives it
!>
!> A case has an entry for each key of the catalogue, given or by default: a group that may be there
!> once has its entries from the start, a repeated group has them for each time it is there. An
!> address is group, item, key and, in a list, element. A sweep sets the number at an address, and
!> `vcor_case_problem` reads it there.
!>
!> The changes of a case are numbered, and an entry knows which one gave it its value. So whoever
!> makes something from entries sees by `latest_change` of them whether it has to be made anew.
module vcor_case_case
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan, ieee_quiet_nan, &
      ieee_value
   use vcor_case_catalogue, only : catalogue, find_group, find_key, first_row, groups, &
      integer_key, last_row, logical_key, real_key, row_for_model, text_key
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_text, only : canonical_name, integer_text, lower, printable
   implicit none
   private

   public :: case_t, address_t, entry_t, operator(==)

   !> Where a value stands in a case
   type :: address_t
      !> Index of the group in `groups`, 0: nowhere
      integer :: group = 0
      !> Number of the item, 1 for a group that is there once
      integer :: item = 0
      !> First row of the key in `catalogue`
      integer :: row = 0
      !> Which number of a list, 0: the value as a whole
      integer :: element = 0
   end type address_t

   !> A value and what is known of it; only what the kind of its key asks for has a meaning
   type :: entry_t
      !> Whether it was given by the user
      logical :: given = .false.
      !> Whether there is a value at all, given or by default
      logical :: present = .false.
      !> Line of the case file, 0 where it does not stand there
      integer :: line = 0
      !> Where it comes from when that is not the case file
      character(len=:), allocatable :: origin
      !> A real number in the unit of the key, an integer, or 1 for true and 0 for false
      real(wp) :: number = 0.0_wp
      !> A text
      character(len=:), allocatable :: text
      !> A list of numbers in the unit of the key, shape (n)
      real(wp), allocatable :: list(:)
      !> Number of the change of the case that gave it its value, 0: it has had its default always
      integer :: changed = 0
   end type entry_t

   !> One item of a group
   type :: item_t
      !> Whether the group is in the case, and not only its defaults
      logical :: present = .false.
      !> Line of the case file it begins in, 0 where there is none
      integer :: line = 0
      !> File that it comes from when that is not the case file
      character(len=:), allocatable :: source
      !> Entries, from the first row of the group to its last
      type(entry_t), allocatable :: entry(:)
   end type item_t

   !> All items of a group
   type :: items_t
      !> Number of items
      integer :: n = 0
      !> The items, shape (>= n)
      type(item_t), allocatable :: item(:)
   end type items_t

   !> A case
   type :: case_t
      !> Name of the case file, for messages
      character(len=:), allocatable :: source
      !> Items by group
      type(items_t), allocatable, private :: group(:)
      !> Number of its changes so far
      integer, private :: changes = 0
   contains
      procedure :: start, add, adopt, is_materials, source_of, latest_change, model, find_material
      procedure :: material_of, address, path, row, number, given, unset, oust, refuse
      procedure :: count => count_items
      procedure :: line => line_of_item
      procedure :: entry => entry_at
      generic :: get => get_real, get_integer, get_logical, get_text, get_list
      generic :: set => set_entry, set_number, set_text, set_list
      generic :: location => location_of_key, location_of_address
      procedure, private :: get_real, get_integer, get_logical, get_text, get_list, set_entry
      procedure, private :: set_number, set_text, set_list, location_of_key, location_of_address
   end type case_t

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

   !> Begin anew: no group is there, every key has its default
   pure subroutine start(self, source)
      class(case_t), intent(inout) :: self
      !> Name of the case file; the default of `output.stem` is made from it
      character(len=*), intent(in) :: source

      character(len=*), parameter :: extension = '.nml'
      character(len=:), allocatable :: stem
      integer :: g, mark

      self%source = source
      if (allocated(self%group)) deallocate (self%group)
      allocate (self%group(size(groups)))
      do g = 1, size(groups)
         allocate (self%group(g)%item(merge(4, 1, groups(g)%repeated)))
         if (groups(g)%repeated) cycle
         self%group(g)%n = 1
         call default_item(self%group(g)%item(1), g)
      end do
      stem = trim(source(index(source, '/', back=.true.) + 1:))
      mark = index(stem, extension, back=.true.)
      if (mark > 1 .and. mark == len(stem) - len(extension) + 1) stem = stem(:mark - 1)
      if (len(stem) == 0) stem = 'case'
      call self%set(self%address('output', 'stem'), stem, given=.false.)
   end subroutine start

   !> An item with nothing but defaults
   pure subroutine default_item(item, group)
      type(item_t), intent(out) :: item
      !> Index of its group
      integer, intent(in) :: group

      integer :: row

      allocate (item%entry(first_row(group):last_row(group)))
      do row = first_row(group), last_row(group)
         call set_default(item%entry(row), row)
      end do
   end subroutine default_item

   !> Give a key its default
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

   !> Add a group: a new item where it may be repeated, else the group is marked as being there
   pure subroutine add(self, group, line, item)
      class(case_t), intent(inout) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Line of the case file it begins in, 0 where there is none
      integer, intent(in) :: line
      !> Number of the item
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

   !> Add a material of another case, which keeps its file and its lines
   pure subroutine adopt(self, other, item)
      class(case_t), intent(inout) :: self
      class(case_t), intent(in) :: other
      !> Number of the material there
      integer, intent(in) :: item

      integer :: group, own

      group = find_group('material')
      call self%add(group, 0, own)
      self%group(group)%item(own) = other%group(group)%item(item)
      self%group(group)%item(own)%source = other%source
      self%changes = max(self%changes, other%changes)
   end subroutine adopt

   !> Whether there is nothing but materials
   pure function is_materials(self) result(yes)
      class(case_t), intent(in) :: self
      logical :: yes

      integer :: i

      yes = self%count('material') > 0 .and. all([(self%count(groups(i)%name) == 0 &
         .or. groups(i)%name == 'material', i=1, size(groups))])
   end function is_materials

   !> File that a material comes from
   pure function source_of(self, item) result(source)
      class(case_t), intent(in) :: self
      !> Number of the material
      integer, intent(in) :: item
      character(len=:), allocatable :: source

      source = self%source
      associate (material => self%group(find_group('material'))%item(item))
         if (allocated(material%source)) source = material%source
      end associate
   end function source_of

   !> Number of times a group is in the case
   pure function count_items(self, group) result(n)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group
      integer :: n

      integer :: g

      n = 0
      g = find_group(group)
      if (g == 0 .or. .not. allocated(self%group)) return
      n = count(self%group(g)%item(:self%group(g)%n)%present)
   end function count_items

   !> Line of the case file a group begins in
   pure function line_of_item(self, group, item) result(line)
      class(case_t), intent(in) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Number of the item
      integer, intent(in) :: item
      !> The line, 0 where there is none
      integer :: line

      line = self%group(group)%item(item)%line
   end function line_of_item

   !> Number of the latest change of some values: as long as it stays the same, so do they
   pure function latest_change(self, addresses) result(number)
      class(case_t), intent(in) :: self
      !> Where they stand; nowhere does not count
      type(address_t), intent(in) :: addresses(:)
      !> Number of the change, 0: there was none
      integer :: number

      integer :: i

      number = 0
      do i = 1, size(addresses)
         associate (at => addresses(i))
            if (at%group > 0) &
               number = max(number, self%group(at%group)%item(at%item)%entry(at%row)%changed)
         end associate
      end do
   end function latest_change

   !> Value of the selector of an item, such as the model of a material
   pure function model(self, group, item) result(word)
      class(case_t), intent(in) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Number of the item
      integer, intent(in) :: item
      !> The value, lower case; blank where the group has no selector
      character(len=:), allocatable :: word

      word = ''
      if (groups(group)%selector == '') return
      word = lower(self%group(group)%item(item)%entry( &
         find_key(groups(group)%name, groups(group)%selector))%text)
   end function model

   !> Item of the material of a name; case, and blanks against underscores, make no difference
   pure function find_material(self, name) result(item)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: name
      !> Number of the first item of this name, 0 when there is none
      integer :: item

      character(len=:), allocatable :: other

      do item = 1, self%count('material')
         call self%get('material', 'name', other, item)
         if (canonical_name(name) == canonical_name(other)) return
      end do
      item = 0
   end function find_material

   !> Item of the material of a body
   pure function material_of(self, body) result(item)
      class(case_t), intent(in) :: self
      !> sphere or plate
      character(len=*), intent(in) :: body
      !> Number of the material, 0 when there is none of this name
      integer :: item

      character(len=:), allocatable :: name

      call self%get(body, 'material', name)
      item = self%find_material(name)
   end function material_of

   !> Address of a key
   pure function address(self, group, key, item)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> Number of the item; absent: 1
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
      class(case_t), intent(in) :: self
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
      class(case_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> The row, 0 if the key does not belong to the model
      integer :: row

      row = row_for_model(address%row, self%model(address%group, address%item))
   end function row

   !> Entry at an address
   pure function entry_at(self, address) result(entry)
      class(case_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> The entry, with text and list, and without a value for nowhere
      type(entry_t) :: entry

      if (address%group > 0) &
         entry = self%group(address%group)%item(address%item)%entry(address%row)
      if (.not. allocated(entry%text)) entry%text = ''
      if (.not. allocated(entry%list)) allocate (entry%list(0))
      if (address%element > 0) entry%number = entry%list(address%element)
   end function entry_at

   !> Number at an address: of a real, integer or logical key, or in a list; a quiet NaN where there
   !> is none
   pure function number(self, address)
      class(case_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> The number, in the unit of the key
      real(wp) :: number

      ! whoever calculates with what is not there shall notice
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

   !> Value of a real key; a quiet NaN where there is none
   pure subroutine get_real(self, group, key, value, item)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> In the unit of the key
      real(wp), intent(out) :: value
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item

      value = self%number(self%address(group, key, item))
   end subroutine get_real

   !> Value of an integer key; `-huge(1)` where there is none
   pure subroutine get_integer(self, group, key, value, item)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      integer, intent(out) :: value
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item

      value = -huge(value)
      if (.not. ieee_is_nan(self%number(self%address(group, key, item)))) &
         value = nint(self%number(self%address(group, key, item)))
   end subroutine get_integer

   !> Value of a logical key; false where there is none
   pure subroutine get_logical(self, group, key, value, item)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      logical, intent(out) :: value
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item

      type(entry_t) :: entry

      entry = self%entry(self%address(group, key, item))
      value = entry%number > 0.5_wp
   end subroutine get_logical

   !> Value of a text key; empty where there is none
   pure subroutine get_text(self, group, key, value, item)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> Choices as the catalogue has them
      character(len=:), allocatable, intent(out) :: value
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item

      type(entry_t) :: entry

      entry = self%entry(self%address(group, key, item))
      call move_alloc(entry%text, value)
   end subroutine get_text

   !> Value of a list key; without elements where there is none
   pure subroutine get_list(self, group, key, value, item)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> In the unit of the key, shape (n)
      real(wp), allocatable, intent(out) :: value(:)
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item

      type(entry_t) :: entry

      entry = self%entry(self%address(group, key, item))
      call move_alloc(entry%list, value)
   end subroutine get_list

   !> Whether a key was given
   pure function given(self, group, key, item)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      logical :: given

      type(entry_t) :: entry

      entry = self%entry(self%address(group, key, item))
      given = entry%given
   end function given

   !> Set an entry as it is; of a number in a list only that number
   pure subroutine set_entry(self, address, entry)
      class(case_t), intent(inout) :: self
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
      call note_change(self, address, entry%given)
      if (address == self%address('contact', 'mechanics')) call choose_mechanics(self, entry%text)
   end subroutine set_entry

   !> Give keys of the mechanics that the user has not given what goes with `mechanics`
   pure subroutine choose_mechanics(self, mechanics)
      type(case_t), intent(inout) :: self
      !> `paper`, the defaults of the keys, or `exact`
      character(len=*), intent(in) :: mechanics

      character(len=*), parameter :: groups_of(3) = [character(len=7) :: 'contact', 'contact', &
         'plate'], keys(3) = [character(len=5) :: 'law', 'pair', 'waves'], &
         exact(3) = [character(len=8) :: 'receding', 'series', 'body']
      type(address_t) :: address
      integer :: i

      do i = 1, size(keys)
         address = self%address(trim(groups_of(i)), trim(keys(i)))
         if (self%given(trim(groups_of(i)), trim(keys(i)))) cycle
         call self%unset(address)
         if (mechanics == 'exact') call self%set(address, trim(exact(i)), given=.false.)
      end do
   end subroutine choose_mechanics

   !> Set a number as it is: cheap, for a sweep. The same number as before is no change
   pure subroutine set_number(self, address, number)
      class(case_t), intent(inout) :: self
      !> Address of a real, integer or logical key, or of a number in a list
      type(address_t), intent(in) :: address
      !> The number, in the unit of the key
      real(wp), intent(in) :: number

      real(wp) :: before

      before = self%number(address)
      if (ieee_is_finite(before) .and. ieee_is_finite(number)) then
         if (.not. abs(number - before) > 0.0_wp) then
            call mark(self, address, .true.)
            return
         end if
      end if
      associate (entry => self%group(address%group)%item(address%item)%entry(address%row))
         if (address%element > 0) then
            entry%list(address%element) = number
         else
            entry%number = number
         end if
      end associate
      call note_change(self, address, .true.)
   end subroutine set_number

   !> Set a text as it is
   pure subroutine set_text(self, address, text, given)
      class(case_t), intent(inout) :: self
      !> Address of a text key
      type(address_t), intent(in) :: address
      character(len=*), intent(in) :: text
      !> Whether it counts as given by the user
      logical, intent(in) :: given

      self%group(address%group)%item(address%item)%entry(address%row)%text = text
      call note_change(self, address, given)
   end subroutine set_text

   !> Set a list as it is
   pure subroutine set_list(self, address, list, given)
      class(case_t), intent(inout) :: self
      !> Address of a list key
      type(address_t), intent(in) :: address
      !> The list, in the unit of the key, shape (n)
      real(wp), intent(in) :: list(:)
      !> Whether it counts as given by the user
      logical, intent(in) :: given

      self%group(address%group)%item(address%item)%entry(address%row)%list = list
      call note_change(self, address, given)
   end subroutine set_list

   !> Note that an entry has a new value
   pure subroutine note_change(self, address, given)
      class(case_t), intent(inout) :: self
      type(address_t), intent(in) :: address
      !> Whether the value was given by the user
      logical, intent(in) :: given

      call mark(self, address, given)
      call number_change(self, address)
   end subroutine note_change

   !> Give the entry at an address the number of a new change
   pure subroutine number_change(self, address)
      class(case_t), intent(inout) :: self
      type(address_t), intent(in) :: address

      self%changes = self%changes + 1
      self%group(address%group)%item(address%item)%entry(address%row)%changed = self%changes
   end subroutine number_change

   !> Note that an entry has a value; if it is given, the group counts as being in the case
   pure subroutine mark(self, address, given)
      class(case_t), intent(inout) :: self
      type(address_t), intent(in) :: address
      !> Whether the value was given by the user
      logical, intent(in) :: given

      associate (item => self%group(address%group)%item(address%item))
         item%entry(address%row)%present = .true.
         item%entry(address%row)%given = given
         if (given) item%present = .true.
      end associate
   end subroutine mark

   !> Take a value back: the key has its default
   pure subroutine unset(self, address)
      class(case_t), intent(inout) :: self
      type(address_t), intent(in) :: address

      call set_default(self%group(address%group)%item(address%item)%entry(address%row), &
         address%row)
      call number_change(self, address)
   end subroutine unset

   !> Take back what is given in place of a key, as drop_height for velocity or the other way round
   pure subroutine oust(self, address, always)
      class(case_t), intent(inout) :: self
      type(address_t), intent(in) :: address
      !> Whether that is taken back, too, which was set and does not stand in the case file
      logical, intent(in) :: always

      type(entry_t) :: entry
      type(address_t) :: other
      integer :: row

      do row = first_row(address%group), last_row(address%group)
         if (catalogue(row)%instead /= catalogue(address%row)%name &
             .and. catalogue(address%row)%instead /= catalogue(row)%name) cycle
         other = self%address(trim(groups(address%group)%name), trim(catalogue(row)%name), &
            address%item)
         entry = self%entry(other)
         if (entry%given .and. (always .or. .not. allocated(entry%origin))) call self%unset(other)
      end do
   end subroutine oust

   !> Raise an error about a key
   pure subroutine refuse(self, group, key, item, message, error)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> Number of the item
      integer, intent(in) :: item
      !> Found and expected
      character(len=*), intent(in) :: message
      type(error_t), allocatable, intent(inout) :: error

      call raise(error, error_input, self%location(group, key, item)//': '//message)
   end subroutine refuse

   !> Where a key was given, for messages
   pure function location_of_key(self, group, key, item) result(text)
      class(case_t), intent(in) :: self
      character(len=*), intent(in) :: group, key
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      !> The place, for the beginning of a message
      character(len=:), allocatable :: text

      text = self%location(self%address(group, key, item))
   end function location_of_key

   !> Where the value at an address was given, `case.nml:12`; the line of its group where it was
   !> not, or the file alone
   pure function location_of_address(self, address) result(text)
      class(case_t), intent(in) :: self
      type(address_t), intent(in) :: address
      !> The place, for the beginning of a message
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

end module vcor_case_case
