!> Paths to entries, `group.key` and `material_name.key`, and what to say about names that are not
!> known
module vcor_case_path
   use vcor_case_entries, only : entries_t
   use vcor_case_catalogue, only : find_group, find_key, group_names, groups, keys_of
   use vcor_nearest, only : nearest_name, suggestion
   use vcor_text, only : canonical_name, integer_text, shortened
   use vcor_words, only : join_words
   implicit none
   private

   public :: resolve_path, swept_handles, unknown_group, unknown_key, material_names

contains

   !> Handle of the entry a path leads to: `group.key`, or `name.key` for the material of this
   !> name, whose name
   !> may be in quotes
   pure subroutine resolve_path(self, path, handle, message)
      !> The case
      class(entries_t), intent(in) :: self
      !> The path
      character(len=*), intent(in) :: path
      !> The handle, 0 where the path leads nowhere
      integer, intent(out) :: handle
      !> What is wrong with the path, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      character(len=:), allocatable :: owner, key
      logical :: in_quotes
      integer :: dot, group, item

      handle = 0
      dot = index(path, ".", back=.true.)
      if (dot < 2 .or. dot == len_trim(path)) then
         message = "found '"//shortened(trim(path))//"', expected group.key or material_name.key"
         return
      end if
      owner = trim(adjustl(path(:dot-1)))
      key = trim(adjustl(path(dot+1:)))
      in_quotes = scan(owner(1:1), "'""") == 1 .and. len(owner) > 2
      if (in_quotes) in_quotes = owner(len(owner):) == owner(1:1)
      if (in_quotes) owner = owner(2:len(owner)-1)

      group = find_group(owner)
      item = self%find_material(owner)
      if (in_quotes) group = 0
      ! A material may be called like a group: the key decides
      if (group > 0 .and. item > 0) then
         if (find_key(owner, key) == 0) group = 0
      end if

      if (group == 0 .and. item > 0) then
         handle = self%handle("material", key, item)
         if (handle == 0) message = unknown_key(key, find_group("material"))
      else if (group == 0) then
         message = unknown_owner(self, owner)
      else if (find_key(owner, key) == 0) then
         message = unknown_key(key, group)
      else if (.not. groups(group)%repeated) then
         handle = self%handle(owner, key)
      else if (self%count(owner) == 1) then
         handle = self%handle(owner, key, 1)
      else if (groups(group)%label == "") then
         message = "found "//integer_text(self%count(owner))//" &"//trim(groups(group)%name) &
            & //" groups, expected one"
      else
         message = "found "//integer_text(self%count(owner))//" &"//trim(groups(group)%name) &
            & //" groups, expected the name of one of them: " &
            & //shortened(join_words(material_names(self)))
      end if
   end subroutine resolve_path

   !> Handles of what the &sweep groups vary, as far as their paths lead somewhere: for checks,
   !> which do not ask for a value that the sweep gives
   pure function swept_handles(case) result(handles)
      !> The case
      class(entries_t), intent(in) :: case
      !> Handles, 0 where a path leads nowhere, shape (number of &sweep groups)
      integer, allocatable :: handles(:)

      character(len=:), allocatable :: path, message
      integer :: item

      allocate (handles(case%count('sweep')))
      do item = 1, size(handles)
         call case%get('sweep', 'parameter', path, item)
         call resolve_path(case, path, handles(item), message)
      end do
   end function swept_handles

   !> What to say about a key that is not in the catalogue
   pure function unknown_key(key, group) result(message)
      !> The key
      character(len=*), intent(in) :: key
      !> Index of the group it was found in
      integer, intent(in) :: group
      !> The message
      character(len=:), allocatable :: message
      integer :: other

      message = "unknown key '"//shortened(key)//"' in &"//trim(groups(group)%name)//"; "
      if (nearest_name(key, keys_of(group)) == "") then
         do other = 1, size(groups)
            if (find_key(groups(other)%name, key) == 0) cycle
            message = message//"it belongs to &"//trim(groups(other)%name)//", "
            exit
         end do
      end if
      message = message//suggestion(key, keys_of(group))
   end function unknown_key

   !> What to say about a group that is not in the catalogue
   pure function unknown_group(group) result(message)
      !> The group
      character(len=*), intent(in) :: group
      !> The message
      character(len=:), allocatable :: message

      message = "unknown group '&"//shortened(group)//"'; "//suggestion(group, group_names())
   end function unknown_group

   !> What to say about the first part of a path that is neither a group nor a material
   pure function unknown_owner(self, owner) result(message)
      !> The case
      class(entries_t), intent(in) :: self
      !> The first part of the path
      character(len=*), intent(in) :: owner
      !> The message
      character(len=:), allocatable :: message
      character(len=:), allocatable :: known

      known = trim(group_names()//" "//material_names(self))
      message = "'"//shortened(owner)//"' is neither a group nor a material; " &
         & //suggestion(canonical_name(owner), known)
   end function unknown_owner

   !> Names of the materials as they are in paths
   pure function material_names(self) result(names)
      !> The case
      class(entries_t), intent(in) :: self
      !> The names, separated by blanks
      character(len=:), allocatable :: names
      character(len=:), allocatable :: name
      integer :: item

      names = ""
      do item = 1, self%count("material")
         call self%get("material", "name", name, item)
         names = names//" "//canonical_name(name)
      end do
      names = trim(adjustl(names))
   end function material_names

end module vcor_case_path
