!> The keys, values and lines behind an error of a constructor
!>
!> Constructors have arguments, not keys: an error names them in `error%about`, and the material in
!> `error%item`. The keys have the names of the arguments.
module vcor_case_cause
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group, find_key, first_row, groups, &
      keys_of, last_row, list_key
   use vcor_case_entries, only : address_t, entry_t, operator(==)
   use vcor_case_printed, only : value_text
   use vcor_error, only : error_t
   use vcor_text, only : integer_text, quoted, shortened
   use vcor_words, only : list_of_words, longest_name
   implicit none
   private

   public :: explain, may_contribute

contains

   !> Add to an error the place and the values that caused it
   !>
   !> The constructor of a material raises 'a standard linear solid needs 0 <= alpha <= beta' about
   !> 'alpha beta'; `update_body` adds item 2. If that is pmma, with both keys in line 8, the
   !> message becomes
   !>
   !>     case.nml:8: found alpha = 130.0 and beta = 120.0 in &material 'pmma': a standard linear
   !>     solid needs 0 <= alpha <= beta
   !>
   !> The line is that of the first given key. Keys without a value are not listed; if none has a
   !> value, the message is "key 'alpha' is missing in &material 'pmma'".
   subroutine explain(case, error)
      type(case_t), intent(in) :: case
      !> Error about arguments that have the names of their keys
      type(error_t), intent(inout) :: error

      type(address_t) :: address, cause
      type(address_t), allocatable :: named(:)
      type(entry_t) :: entry
      character(len=longest_name), allocatable :: names(:)
      character(len=:), allocatable :: place, found, name
      integer :: i
      logical :: is_given

      allocate (names, source=names_about(error))
      allocate (named(0))
      found = ''
      is_given = .false.
      do i = 1, size(names)
         address = address_of(case, trim(names(i)), error%item)
         if (address%group == 0) cycle
         ! two names of one quantity are the key that is given
         if (any(named == address)) cycle
         named = [named, address]
         entry = case%entry(address)
         ! the first one that was given, otherwise the first
         if (cause%group == 0 .or. entry%given .and. .not. is_given) cause = address
         is_given = is_given .or. entry%given
         associate (key => catalogue(address%row))
            ! a place is one or two numbers
            if (key%value_kind == list_key .and. entry%given &
                .and. .not. groups(address%group)%optional) then
               found = found//' and '//integer_text(size(entry%list))//' '//trim(key%name)
            else if ((key%value_kind /= list_key .or. entry%given) .and. entry%present) then
               found = found//' and '//trim(key%name)//' = ' &
                  //shortened(value_text(key, entry))
            end if
         end associate
      end do
      place = ''
      if (error%item > 0) then
         call case%get('material', 'name', name, error%item)
         place = ' in &material '//quoted(shortened(name))
      end if
      if (.not. allocated(error%about)) then
         found = ''
      else if (found /= '') then
         found = 'found'//found(len(' and') + 1:)//place//': '
      else if (cause%group > 0) then
         if (error%item == 0) place = ' in &'//trim(groups(cause%group)%name)
         found = "key '"//trim(catalogue(cause%row)%name)//"' is missing"//place//': '
      end if
      error%message = case%location(cause)//': '//found//error%message
   end subroutine explain

   !> Whether the value at an address may have contributed to an error
   pure function may_contribute(case, address, error) result(yes)
      type(case_t), intent(in) :: case
      !> Address; its element is ignored
      type(address_t), intent(in) :: address
      !> Error of `problem_of_case`
      type(error_t), intent(in) :: error
      logical :: yes

      type(address_t) :: other
      character(len=longest_name), allocatable :: names(:)
      integer :: i

      allocate (names, source=names_about(error))
      yes = size(names) == 0
      do i = 1, size(names)
         other = address_of(case, trim(names(i)), error%item)
         if (other%group > 0) then
            yes = yes .or. (other%row == address%row .and. other%item == address%item)
         else
            ! a key of a material, of either body
            yes = yes .or. catalogue(address%row)%name == names(i)
         end if
      end do
   end function may_contribute

   !> Names of the arguments of an error
   pure function names_about(error) result(names)
      type(error_t), intent(in) :: error
      character(len=longest_name), allocatable :: names(:)

      if (allocated(error%about)) then
         names = list_of_words(error%about)
      else if (error%item > 0) then
         ! without names, all keys of the material may be meant
         names = list_of_words(keys_of(find_group('material')))
      else
         allocate (names(0))
      end if
   end function names_about

   !> Address of the key with the name of an argument, or of the key that is given instead
   pure function address_of(case, name, item) result(address)
      type(case_t), intent(in) :: case
      character(len=*), intent(in) :: name
      !> Index of its material, if it has one; 0: none
      integer, intent(in) :: item
      !> The address; nowhere if there is no such key
      type(address_t) :: address

      type(address_t) :: other
      integer :: row

      address = address_by_name(case, name, item)
      if (address%group == 0) return
      do row = first_row(address%group), last_row(address%group)
         if (catalogue(row)%name /= catalogue(address%row)%instead .and. &
             catalogue(row)%instead /= name) cycle
         other = case%address(groups(address%group)%name, trim(catalogue(row)%name), address%item)
         if (case%given(groups(address%group)%name, trim(catalogue(row)%name), address%item)) &
            address = other
      end do
   end function address_of

   !> Address of the key with the name of an argument
   pure function address_by_name(case, name, item) result(address)
      type(case_t), intent(in) :: case
      character(len=*), intent(in) :: name
      !> Index of its material, if it has one; 0: none
      integer, intent(in) :: item
      !> The address; nowhere if there is no such key
      type(address_t) :: address

      integer :: group, owners

      owners = count([(.not. groups(group)%repeated .and. find_key(groups(group)%name, name) > 0, &
         group=1, size(groups))])
      if (item > 0) then
         address = case%address('material', name, item)
         if (address%group > 0) return
      end if
      ! backwards: for an error about the material of two bodies, take that of the plate
      do group = size(groups), 1, -1
         ! the structure has keys of names that other groups have, which its errors do not name
         if (groups(group)%optional .and. owners > 1) cycle
         if (.not. groups(group)%repeated) address = case%address(groups(group)%name, name)
         if (address%group > 0) return
      end do
   end function address_by_name

end module vcor_case_cause
