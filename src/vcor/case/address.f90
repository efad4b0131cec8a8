!> Addresses from their paths, `group.key` and `material_name.key`, and messages about unknown names
module vcor_case_address
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group, find_key, group_names, groups, keys_of, &
      list_key
   use vcor_case_entries, only : address_t, entry_t
   use vcor_text, only : canonical_name, integer_text, shortened
   use vcor_words, only : join_words, nearest_name, suggestion
   implicit none
   private

   public :: resolve, swept_addresses, unknown_group, unknown_key, material_names

contains

   !> Address of a path: `group.key`, or `name.key` for the material of this name; for an element of
   !> a list also `name.key(2)`
   pure subroutine resolve(case, path, address, message)
      type(case_t), intent(in) :: case
      !> The path; the name of a material may be quoted and have underscores for blanks
      character(len=*), intent(in) :: path
      !> The address; nowhere on failure
      type(address_t), intent(out) :: address
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      character(len=:), allocatable :: owner, key, element
      logical :: in_quotes
      integer :: dot, group, item, mark

      dot = index(path, '.', back=.true.)
      if (dot < 2 .or. dot == len_trim(path)) then
         message = "found '"//shortened(trim(path))//"', expected group.key or material_name.key"
         return
      end if
      owner = trim(adjustl(path(:dot - 1)))
      key = trim(adjustl(path(dot + 1:)))
      element = ''
      mark = index(key, '(')
      if (mark > 1 .and. index(key, ')') == len(key)) then
         element = key(mark:)
         key = trim(key(:mark - 1))
      end if
      in_quotes = scan(owner(1:1), "'""") == 1 .and. len(owner) > 2
      if (in_quotes) in_quotes = owner(len(owner):) == owner(1:1)
      ! a name may have quotes of its own
      if (in_quotes .and. case%find_material(owner) == 0) owner = unquoted(owner)

      group = find_group(owner)
      item = case%find_material(owner)
      if (in_quotes) group = 0
      ! a material may have the name of a group: the key decides, a misspelt one by what it is near
      if (group > 0 .and. item > 0) then
         if (groups(group)%label /= '' .or. find_key(owner, key) == 0 &
            .and. (find_key('material', key) > 0 .or. nearest_name(key, keys_of(group)) == '')) &
            group = 0
      end if
      if (group == 0 .and. item == 0) then
         message = "'"//shortened(owner)//"' is neither a group nor a material; " &
            //suggestion(canonical_name(owner), trim(group_names()//' '//material_names(case)))
         return
      end if
      if (group == 0) then
         group = find_group('material')
      else
         item = 1
         if (find_key(owner, key) > 0 .and. groups(group)%repeated &
             .and. case%count(owner) /= 1) then
            message = 'found '//integer_text(case%count(owner))//' &' &
               //trim(groups(group)%name)//' groups, expected one'
            if (groups(group)%label /= '') message = message(:len(message) - len('one')) &
               //'the name of one of them: '//shortened(join_words(material_names(case)))
            return
         end if
      end if
      address = case%address(groups(group)%name, key, item)
      if (address%group == 0) then
         message = unknown_key(key, group)
      else if (element /= '') then
         call find_element(case, element, address, message)
      end if
   end subroutine resolve

   !> A text without the quotes around it, of which a doubled one within stands for one
   pure function unquoted(text) result(inner)
      !> Text between two quotes of a kind
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: inner

      integer :: i

      inner = ''
      i = 2
      do while (i < len(text))
         inner = inner//text(i:i)
         if (text(i:i + 1) == repeat(text(1:1), 2) .and. i < len(text) - 1) i = i + 1
         i = i + 1
      end do
   end function unquoted

   !> Change the address of a list to that of one of its numbers
   pure subroutine find_element(case, element, address, message)
      type(case_t), intent(in) :: case
      !> Index of the element in parentheses
      character(len=*), intent(in) :: element
      !> Address of the list; nowhere on failure
      type(address_t), intent(inout) :: address
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      type(entry_t) :: entry
      integer :: status

      entry = case%entry(address)
      status = verify(element(2:len(element) - 1), '0123456789')
      if (status == 0) read (element(2:len(element) - 1), *, iostat=status) address%element
      if (catalogue(address%row)%value_kind /= list_key) then
         message = 'found '//shortened(element)//', but it is a single value, not a list'
      else if (status /= 0 .or. address%element < 1 .or. address%element > size(entry%list)) then
         message = 'found '//shortened(element)//' of a list of '//integer_text(size(entry%list)) &
            //' numbers'
         if (size(entry%list) > 0) &
            message = message//', expected (1) to ('//integer_text(size(entry%list))//')'
      end if
      if (allocated(message)) address = address_t()
   end subroutine find_element

   !> Addresses of the parameters of the &sweep groups, as far as their paths are valid
   pure function swept_addresses(case) result(addresses)
      type(case_t), intent(in) :: case
      !> Addresses; nowhere for an invalid path, shape (number of &sweep groups)
      type(address_t), allocatable :: addresses(:)

      character(len=:), allocatable :: parameter, message
      integer :: item

      allocate (addresses(case%count('sweep')))
      do item = 1, size(addresses)
         call case%get('sweep', 'parameter', parameter, item)
         call resolve(case, parameter, addresses(item), message)
      end do
   end function swept_addresses

   !> Message about a key that is not in the catalogue
   pure function unknown_key(key, group) result(message)
      character(len=*), intent(in) :: key
      !> Index of its group
      integer, intent(in) :: group
      character(len=:), allocatable :: message

      integer :: other

      message = "unknown key '"//shortened(key)//"' in &"//trim(groups(group)%name)//'; '
      do other = 1, size(groups)
         if (find_key(groups(other)%name, key) == 0) cycle
         message = message//'it belongs to &'//trim(groups(other)%name)//', '
         exit
      end do
      message = message//suggestion(key, keys_of(group))
   end function unknown_key

   !> Message about a group that is not in the catalogue
   pure function unknown_group(group) result(message)
      character(len=*), intent(in) :: group
      character(len=:), allocatable :: message

      message = "unknown group '&"//shortened(group)//"'; "//suggestion(group, group_names())
   end function unknown_group

   !> Names of the materials as in paths
   pure function material_names(case) result(names)
      type(case_t), intent(in) :: case
      !> The names, separated by blanks
      character(len=:), allocatable :: names

      character(len=:), allocatable :: name
      integer :: item

      names = ''
      do item = 1, case%count('material')
         call case%get('material', 'name', name, item)
         names = names//' '//canonical_name(name)
      end do
      names = trim(adjustl(names))
   end function material_names

end module vcor_case_address
