!> What can be told to be wrong from a case alone: what is missing, what is out of range, what
!> contradicts itself
module vcor_case_checks
   use vcor_error, only : error_input, error_t, raise
   use vcor_case_axes, only : new_grid
   use vcor_case_consistency, only : check_consistency
   use vcor_case_grid, only : grid_t
   use vcor_case_catalogue, only : catalogue, find_key, first_row, groups, &
      & keys_of, last_row, row_for_model, wanted
   use vcor_case_address, only : swept_addresses
   use vcor_case_case, only : address_t, case_t, entry_t, operator(==)
   use vcor_case_values, only : range_message
   use vcor_text, only : printable, shortened
   use vcor_words, only : join_words
   implicit none
   private

   public :: validate

contains

   !> Check a case; the first thing that is wrong becomes the error. What a sweep varies need not be
   !> given, and its values are not checked here: a point that makes no sense is a point without
   !> result, not a case that is wrong
   subroutine validate(self, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(grid_t) :: grid
      type(address_t), allocatable :: swept(:)
      integer :: group, item

      allocate(swept, source=swept_addresses(self))
      do group = 1, size(groups)
         if (groups(group)%required .and. self%count(groups(group)%name) == 0) then
            call raise(error, error_input, printable(self%source)//": there is no &" &
               & //trim(groups(group)%name)//" group, expected "//described(group))
            return
         end if
      end do
      do group = 1, size(groups)
         do item = 1, max(1, self%count(groups(group)%name))
            if (self%count(groups(group)%name) == 0) exit
            call check_item(self, swept, group, item, error)
            if (allocated(error)) return
         end do
      end do
      call check_consistency(self, swept, error)
      if (allocated(error)) return
      call new_grid(self, grid, error)
   end subroutine validate

   !> A group and the keys it needs, in words
   pure function described(group) result(text)
      !> Index of the group
      integer, intent(in) :: group
      !> Such as `one with velocity`
      character(len=:), allocatable :: text
      integer :: row

      text = ""
      do row = first_row(group), last_row(group)
         if (catalogue(row)%required .and. catalogue(row)%models == "") &
            & text = trim(text//" "//catalogue(row)%name)
      end do
      text = "one with "//join_words(trim(adjustl(text)))
   end function described

   !> Check each entry of a group by itself
   subroutine check_item(self, swept, group, item, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Index of the group
      integer, intent(in) :: group
      !> Number of the item
      integer, intent(in) :: item
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      integer :: row

      ! What the meaning of other keys depends on comes first
      if (groups(group)%selector /= "") then
         row = find_key(groups(group)%name, groups(group)%selector)
         call check_entry(self, swept, group, row, item, error)
         if (allocated(error)) return
      end if
      do row = first_row(group), last_row(group)
         if (find_key(catalogue(row)%group, catalogue(row)%name) /= row) cycle
         call check_entry(self, swept, group, row, item, error)
         if (allocated(error)) return
      end do
   end subroutine check_item

   !> Check one entry by itself: whether it belongs there, is there, and is within its range
   subroutine check_entry(self, swept, group, row, item, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Addresses of what a sweep varies
      type(address_t), intent(in) :: swept(:)
      !> Index of the group
      integer, intent(in) :: group
      !> First row of the key
      integer, intent(in) :: row
      !> Number of the item
      integer, intent(in) :: item
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(entry_t) :: entry
      character(len=:), allocatable :: key, model, message
      integer :: applicable
      logical :: has_other

      key = trim(catalogue(row)%name)
      model = self%model(group, item)
      entry = self%entry(address_t(group, item, row))
      applicable = row_for_model(row, model)
      if (applicable == 0) then
         if (entry%given) call fail(self, group, key, item, "key '"//key &
            & //"' does not belong to model '"//model//"', its keys are: " &
            & //join_words(keys_of(group, model)), error)
         return
      end if
      has_other = .false.
      if (catalogue(row)%instead /= "") has_other = is_given(trim(catalogue(row)%instead))
      if (has_other .and. is_given(key)) then
         call fail(self, group, trim(catalogue(row)%instead), item, "found both "//key//" and " &
            & //trim(catalogue(row)%instead)//", expected one of them", error)
      else if (entry%present) then
         message = range_message(catalogue(applicable), entry)
         if (message /= "") call fail(self, group, key, item, key//": "//message, error)
      else if (catalogue(applicable)%required .and. .not. (is_given(key) .or. has_other)) then
         message = "key '"//key//"' is missing in &"//trim(groups(group)%name)
         if (groups(group)%label /= "" .and. groups(group)%label /= key) &
            & message = message//" "//owner_name(self, group, item)
         if (catalogue(applicable)%models /= "") message = message//" of model '"//model//"'"
         message = message//", expected "//wanted(catalogue(applicable))
         if (catalogue(row)%instead /= "") message = message//", or "//catalogue(row)%instead
         call fail(self, group, key, item, trim(message), error)
      end if

   contains

      !> Whether a key of the item is given, or varied by a sweep
      pure function is_given(name)
         !> Name of the key
         character(len=*), intent(in) :: name
         !> Whether it is
         logical :: is_given

         is_given = self%given(groups(group)%name, name, item) &
            & .or. any(swept == self%address(groups(group)%name, name, item))
      end function is_given
   end subroutine check_entry

   !> Name of an item, in quotes
   pure function owner_name(self, group, item) result(name)
      !> The case
      type(case_t), intent(in) :: self
      !> Index of a group with a label
      integer, intent(in) :: group
      !> Number of the item
      integer, intent(in) :: item
      !> The name
      character(len=:), allocatable :: name
      character(len=:), allocatable :: label

      call self%get(groups(group)%name, groups(group)%label, label, item)
      name = "'"//shortened(label)//"'"
   end function owner_name

   !> Raise an error about a key
   subroutine fail(self, group, key, item, message, error)
      !> The case
      type(case_t), intent(in) :: self
      !> Index of the group
      integer, intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> Number of the item
      integer, intent(in) :: item
      !> Found and expected
      character(len=*), intent(in) :: message
      !> The error
      type(error_t), allocatable, intent(inout) :: error

      call raise(error, error_input, self%location(groups(group)%name, key, item)//": "//message)
   end subroutine fail

end module vcor_case_checks
