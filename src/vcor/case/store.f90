!> The store behind a case: a value for each key of the catalogue, whether it was given, and where
!>
!> Every group that may be there once has its entries from the start, filled with defaults; a
!> repeated group has
!> them for each time it is there. An entry is addressed by a handle, one integer. Nothing is
!> checked here.
module vcor_case_store
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use vcor_kinds, only : wp
   use vcor_interval, only : contains_number, is_computable
   use vcor_case_catalogue, only : catalogue, find_group, find_key, first_row, groups, &
      & integer_key, &
      & key_t, last_row, list_key, logical_key, real_key, text_key, wanted
   use vcor_nearest, only : nearest_name
   use vcor_text, only : integer_text, lower, real_text, shortened
   use vcor_words, only : contains_word
   implicit none
   private

   public :: entry_t, store_t, range_message

   !> One value; only the component of the key's kind has a meaning
   type :: entry_t
      !> Whether it was given in the case or by an override
      logical :: given = .false.
      !> Whether there is a value at all, given or by default
      logical :: present = .false.
      !> Line of the case file it stands in, 0 where there is none
      integer :: line = 0
      !> Where it comes from when that is not the case file
      character(len=:), allocatable :: origin
      !> Value of a real key, in its unit
      real(wp) :: number = 0.0_wp
      !> Value of an integer key
      integer :: whole = 0
      !> Value of a logical key
      logical :: flag = .false.
      !> Value of a text key
      character(len=:), allocatable :: text
      !> Value of a list key, in its unit, shape (n)
      real(wp), allocatable :: list(:)
   end type entry_t

   !> One item of a group
   type :: item_t
      !> Whether the group is in the case, and not only its defaults
      logical :: present = .false.
      !> Line of the case file it begins in, 0 where there is none
      integer :: line = 0
      !> Entries, from the first row of the group to its last
      type(entry_t), allocatable :: entries(:)
   end type item_t

   !> All items of a group
   type :: items_t
      !> Number of items
      integer :: n = 0
      !> The items, shape (>= n)
      type(item_t), allocatable :: item(:)
   end type items_t

   !> Entries of all groups
   type :: store_t
      !> Name of the case file, for messages
      character(len=:), allocatable :: source
      !> Items by group
      type(items_t), allocatable, private :: group(:)
   contains
      !> Begin anew: no group is there, every key has its default
      procedure :: clear
      !> Add a group
      procedure :: add
      !> Number of times a group is in the case
      procedure :: count => count_items
      !> Line of the case file a group begins in
      procedure :: line => line_of_item
      !> Handle of an entry
      procedure :: handle => handle_of
      !> Group, row of the catalogue and item of a handle
      procedure :: locate
      !> An entry, by its handle
      procedure :: entry => entry_at
      !> Whether an entry was given, by its handle
      procedure :: is_given
      !> Set an entry as it is, by its handle
      procedure :: assign
      !> Set a number as it is, by its handle
      procedure :: assign_number
      !> Value of the selector of an item, such as the model of a material
      procedure :: model
   end type store_t

contains

   !> Begin anew: no group is there, every key has its default
   pure subroutine clear(self, source)
      !> The store
      class(store_t), intent(inout) :: self
      !> Name of the case file, for messages
      character(len=*), intent(in) :: source
      integer :: g

      self%source = source
      if (allocated(self%group)) deallocate(self%group)
      allocate(self%group(size(groups)))
      do g = 1, size(groups)
         if (groups(g)%repeated) then
            allocate(self%group(g)%item(4))
         else
            allocate(self%group(g)%item(1))
            self%group(g)%n = 1
            call default_item(self%group(g)%item(1), g)
         end if
      end do
   end subroutine clear

   !> An item with nothing but defaults
   pure subroutine default_item(item, group)
      !> The item
      type(item_t), intent(out) :: item
      !> Index of its group
      integer, intent(in) :: group
      character(len=len(catalogue%default)) :: default
      integer :: row

      allocate(item%entries(first_row(group):last_row(group)))
      do row = first_row(group), last_row(group)
         default = catalogue(row)%default
         associate (entry => item%entries(row))
            entry%present = default /= ""
            select case (catalogue(row)%value_kind)
            case (real_key)
               if (entry%present) read(default, *) entry%number
            case (integer_key)
               if (entry%present) read(default, *) entry%whole
            case (logical_key)
               if (entry%present) read(default, *) entry%flag
            case (text_key)
               entry%text = trim(default)
               if (default == "''") entry%text = ""
            case (list_key)
               allocate(entry%list(0))
            case default
               continue
            end select
         end associate
      end do
   end subroutine default_item

   !> Add a group: a new item where it may be repeated, else the group is marked as being there
   pure subroutine add(self, group, line, item)
      !> The store
      class(store_t), intent(inout) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Line of the case file it begins in, 0 where there is none
      integer, intent(in) :: line
      !> Number of the item
      integer, intent(out) :: item
      type(item_t), allocatable :: larger(:)
      integer :: i

      associate (items => self%group(group))
         if (groups(group)%repeated) then
            if (items%n == size(items%item)) then
               allocate(larger(2*items%n))
               do i = 1, items%n
                  larger(i)%present = items%item(i)%present
                  larger(i)%line = items%item(i)%line
                  call move_alloc(items%item(i)%entries, larger(i)%entries)
               end do
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

   !> Number of times a group is in the case
   pure function count_items(self, group) result(n)
      !> The store
      class(store_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> The number
      integer :: n
      integer :: g, i

      n = 0
      g = find_group(group)
      if (g == 0 .or. .not. allocated(self%group)) return
      do i = 1, self%group(g)%n
         if (self%group(g)%item(i)%present) n = n + 1
      end do
   end function count_items

   !> Line of the case file a group begins in
   pure function line_of_item(self, group, item) result(line)
      !> The store
      class(store_t), intent(in) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Number of the item
      integer, intent(in) :: item
      !> The line, 0 where there is none
      integer :: line

      line = self%group(group)%item(item)%line
   end function line_of_item

   !> Handle of an entry; it stays valid while groups are added
   pure function handle_of(self, group, key, item) result(handle)
      !> The store
      class(store_t), intent(in) :: self
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      !> The handle, 0 where there is no such key or item
      integer :: handle
      integer :: g, row, i

      handle = 0
      i = 1
      if (present(item)) i = item
      row = find_key(group, key)
      if (row == 0 .or. .not. allocated(self%group)) return
      g = find_group(catalogue(row)%group)
      if (i < 1 .or. i > self%group(g)%n) return
      handle = (i - 1)*size(catalogue) + row
   end function handle_of

   !> Group, row of the catalogue and item of a handle
   pure subroutine locate(self, handle, group, row, item)
      !> The store
      class(store_t), intent(in) :: self
      !> The handle
      integer, intent(in) :: handle
      !> Index of the group, 0 where the handle is not one
      integer, intent(out) :: group
      !> First row of the key
      integer, intent(out) :: row
      !> Number of the item
      integer, intent(out) :: item

      group = 0
      row = 0
      item = 0
      if (handle < 1 .or. .not. allocated(self%group)) return
      row = mod(handle - 1, size(catalogue)) + 1
      item = (handle - 1)/size(catalogue) + 1
      group = find_group(catalogue(row)%group)
      if (item > self%group(group)%n) group = 0
   end subroutine locate

   !> An entry, by its handle
   pure function entry_at(self, handle) result(entry)
      !> The store
      class(store_t), intent(in) :: self
      !> The handle
      integer, intent(in) :: handle
      !> The entry; one without a value where the handle is 0
      type(entry_t) :: entry
      integer :: group, row, item

      call self%locate(handle, group, row, item)
      if (group > 0) then
         entry = self%group(group)%item(item)%entries(row)
      else
         ! Quiet NaN: whoever calculates with what is not there shall notice
         entry%number = ieee_value(entry%number, ieee_quiet_nan)
      end if
      if (.not. allocated(entry%text)) entry%text = ""
      if (.not. allocated(entry%list)) allocate(entry%list(0))
   end function entry_at

   !> Whether an entry was given, by its handle
   pure function is_given(self, handle) result(yes)
      !> The store
      class(store_t), intent(in) :: self
      !> The handle
      integer, intent(in) :: handle
      !> True if it was; false where the handle is 0
      logical :: yes
      integer :: group, row, item

      yes = .false.
      call self%locate(handle, group, row, item)
      if (group > 0) yes = self%group(group)%item(item)%entries(row)%given
   end function is_given

   !> Set an entry as it is, by its handle; if it is given, the group counts as being in the case
   !> from then on
   pure subroutine assign(self, handle, entry)
      !> The store
      class(store_t), intent(inout) :: self
      !> The handle
      integer, intent(in) :: handle
      !> The entry
      type(entry_t), intent(in) :: entry
      integer :: group, row, item

      call self%locate(handle, group, row, item)
      if (group == 0) return
      self%group(group)%item(item)%entries(row) = entry
      if (entry%given) self%group(group)%item(item)%present = .true.
   end subroutine assign

   !> Set a number as it is, by its handle: cheap, for a sweep
   pure subroutine assign_number(self, handle, number)
      !> The store
      class(store_t), intent(inout) :: self
      !> Handle of a real or integer key
      integer, intent(in) :: handle
      !> The number, in the unit of the key; rounded where the key is an integer
      real(wp), intent(in) :: number
      integer :: group, row, item

      call self%locate(handle, group, row, item)
      if (group == 0) return
      self%group(group)%item(item)%present = .true.
      associate (entry => self%group(group)%item(item)%entries(row))
         if (catalogue(row)%value_kind == integer_key) entry%whole = nint(number)
         if (catalogue(row)%value_kind == real_key) entry%number = number
         entry%given = .true.
         entry%present = .true.
      end associate
   end subroutine assign_number

   !> Value of the selector of an item, such as the model of a material
   pure function model(self, group, item) result(word)
      !> The store
      class(store_t), intent(in) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Number of the item
      integer, intent(in) :: item
      !> The value, lower case; blank where the group has no selector
      character(len=:), allocatable :: word

      word = ""
      if (groups(group)%selector == "") return
      associate (selected => self%group(group)%item(item)%entries( &
         & find_key(groups(group)%name, groups(group)%selector)))
         if (allocated(selected%text)) word = lower(selected%text)
      end associate
   end function model

   !> What is wrong with the value of an entry, as far as its range says
   pure function range_message(key, entry) result(message)
      !> The key, of the model of the entry's item
      type(key_t), intent(in) :: key
      !> The entry
      type(entry_t), intent(in) :: entry
      !> Found and expected; empty when nothing is wrong
      character(len=:), allocatable :: message
      character(len=:), allocatable :: near
      integer :: i

      message = ""
      near = ""
      select case (key%value_kind)
      case (real_key)
         if (.not. contains_number(key%range, entry%number)) message = real_text(entry%number)
      case (integer_key)
         if (.not. contains_number(key%range, real(entry%whole, wp))) &
            & message = integer_text(entry%whole)
      case (list_key)
         do i = 1, size(entry%list)
            if (contains_number(key%range, entry%list(i))) cycle
            message = real_text(entry%list(i))//" in value "//integer_text(i)
            exit
         end do
      case (text_key)
         if (key%choices /= "" .and. .not. contains_word(key%choices, entry%text)) then
            message = "'"//shortened(entry%text)//"'"
            ! a single letter is near to every other
            if (len_trim(entry%text) > 1) near = nearest_name(entry%text, trim(key%choices))
         else if (entry%text == "" .and. key%default /= "''") then
            message = "an empty text"
         end if
      case default
         continue
      end select
      if (message /= "") message = "found "//message//", expected "//wanted(key)
      if (message /= "" .and. key%value_kind == real_key) then
         if (.not. is_computable(entry%number)) message = message//", between 1e-60 and 1e60 in " &
            & //"magnitude: beyond that nothing can be computed"
      end if
      if (near /= "") message = message//"; did you mean '"//near//"'?"
   end function range_message

end module vcor_case_store
