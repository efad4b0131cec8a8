!> Errors that a case alone reveals: missing keys and groups, values out of range, references to
!> nothing. Constructors check numbers that depend on each other
module vcor_case_checks
   use vcor_error, only : error_input, error_t, raise
   use vcor_case_address, only : material_names, swept_addresses
   use vcor_case_case, only : address_t, case_t, entry_t, operator(==)
   use vcor_case_catalogue, only : catalogue, find_group, find_key, first_row, groups, key_row, &
      keys_of, last_row, row_for_model, wanted
   use vcor_case_grid, only : grid_t, new_grid
   use vcor_case_problem, only : material_of_case
   use vcor_case_unread, only : why_no_shift, why_unread
   use vcor_case_values, only : range_message
   use vcor_kinds, only : wp
   use vcor_material, only : material_t
   use vcor_material_shift, only : keys_needed, shift_keys
   use vcor_number, only : real_text
   use vcor_text, only : canonical_name, printable, quoted, shortened
   use vcor_words, only : join_words, suggestion
   implicit none
   private

   public :: validate

contains

   !> Check a case; the first error found is returned. Swept keys need not be given, and their
   !> values are not checked: an impossible point is a point without result, not an error of the
   !> case
   subroutine validate(self, error)
      type(case_t), intent(in) :: self
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(grid_t) :: grid
      type(address_t), allocatable :: swept(:)
      integer :: group, item

      allocate (swept, source=swept_addresses(self))
      do group = 1, size(groups)
         if (groups(group)%required .and. self%count(groups(group)%name) == 0) then
            call raise(error, error_input, printable(self%source)//': there is no &' &
               //trim(groups(group)%name)//' group, expected '//described(group))
            return
         end if
      end do
      do group = 1, size(groups)
         do item = 1, self%count(groups(group)%name)
            call check_item(self, swept, group, item, error)
            if (allocated(error)) return
         end do
      end do
      do item = 1, self%count('material')
         call check_material(self, swept, item, error)
         if (allocated(error)) return
      end do
      call check_body(self, 'sphere', error)
      if (.not. allocated(error)) call check_body(self, 'plate', error)
      if (.not. allocated(error)) call check_temperature(self, error)
      if (.not. allocated(error)) call check_stem(self, error)
      if (.not. allocated(error)) call new_grid(self, grid, error)
   end subroutine validate

   !> Check a material: name, bands of its data, shift, and whether it can be built
   subroutine check_material(self, swept, item, error)
      type(case_t), intent(in) :: self
      !> Addresses of the swept keys
      type(address_t), intent(in) :: swept(:)
      !> Index of the material
      integer, intent(in) :: item
      type(error_t), allocatable, intent(out) :: error

      class(material_t), allocatable :: material
      type(case_t) :: case
      character(len=:), allocatable :: name, shift
      integer :: group

      call self%get('material', 'name', name, item)
      if (self%find_material(name) < item) then
         call self%refuse('material', 'name', item, "there are two materials of the name '" &
            //shortened(name)//"', the first at " &
            //self%location('material', 'name', self%find_material(name)) &
            //'; expected different names', error)
         return
      end if
      call check_band(self, 'valid_from', 'valid_to', item, error)
      if (.not. allocated(error)) call check_band(self, 'valid_temperature_from', &
         'valid_temperature_to', item, error)
      if (.not. allocated(error)) call check_shift(self, swept, item, error)
      call self%get('material', 'shift', shift, item)
      group = find_group('material')
      ! the points of a table have not been read yet, and a sweep sets numbers of its own
      if (allocated(error) .or. self%model(group, item) == 'table' .or. shift == 'table' &
          .or. any(swept%group == group .and. swept%item == item)) return
      case = self
      ! the impact's temperature does not matter to a material that no body uses, or if it is swept
      if (all(item /= [self%material_of('sphere'), self%material_of('plate')]) &
          .or. any(swept == self%address('impact', 'temperature'))) &
         call case%unset(case%address('impact', 'temperature'))
      call material_of_case(case, item, material, error)
   end subroutine check_material

   !> Check that the start of a band is below its end
   subroutine check_band(self, from, to, item, error)
      type(case_t), intent(in) :: self
      !> Keys of start and end
      character(len=*), intent(in) :: from, to
      !> Index of the material
      integer, intent(in) :: item
      type(error_t), allocatable, intent(inout) :: error

      real(wp) :: first, last

      if (.not. (self%given('material', from, item) .and. self%given('material', to, item))) return
      call self%get('material', from, first, item)
      call self%get('material', to, last, item)
      if (.not. first < last) call self%refuse('material', to, item, 'found '//from//' = ' &
         //real_text(first)//' and '//to//' = '//real_text(last)//', expected '//from//' < '//to, &
         error)
   end subroutine check_band

   !> Check that a shift has the keys that its law needs, and no others
   subroutine check_shift(self, swept, item, error)
      type(case_t), intent(in) :: self
      !> Addresses of the swept keys
      type(address_t), intent(in) :: swept(:)
      !> Index of the material
      integer, intent(in) :: item
      type(error_t), allocatable, intent(inout) :: error

      character(len=:), allocatable :: shift, name, reason
      type(address_t) :: address
      integer :: i

      call self%get('material', 'shift', shift, item)
      call self%get('material', 'name', name, item)
      do i = 1, size(shift_keys)
         address = self%address('material', trim(shift_keys(i)), item)
         reason = why_no_shift(self, address)
         if (self%given('material', trim(shift_keys(i)), item)) then
            if (reason /= '') call self%refuse('material', trim(shift_keys(i)), item, &
               'the impact does not read it: '//reason, error)
         else if (i <= keys_needed .and. reason == '' .and. all(.not. swept == address)) then
            call self%refuse('material', 'shift', item, "key '"//trim(shift_keys(i)) &
               //"' is missing in &material "//quoted(shortened(name))//" with shift = '"//shift &
               //"', expected "//wanted(catalogue(address%row)), error)
         end if
         if (allocated(error)) return
      end do
   end subroutine check_shift

   !> Check that the temperature shifts at least one material
   subroutine check_temperature(self, error)
      !> A case whose bodies have materials
      type(case_t), intent(in) :: self
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: reason

      if (.not. self%given('impact', 'temperature')) return
      reason = why_unread(self, self%address('impact', 'temperature'))
      if (reason /= '') call self%refuse('impact', 'temperature', 1, 'the impact does not read ' &
         //'it: '//reason, error)
   end subroutine check_temperature

   !> Check that the material of a body exists
   subroutine check_body(self, body, error)
      type(case_t), intent(in) :: self
      !> Group of the body
      character(len=*), intent(in) :: body
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: name

      call self%get(body, 'material', name)
      if (self%find_material(name) == 0) call self%refuse(body, 'material', 1, &
         "there is no material '"//shortened(name)//"' for &"//body//'; ' &
         //suggestion(canonical_name(name), material_names(self)), error)
   end subroutine check_body

   !> Check that the stem of file names is not a path
   subroutine check_stem(self, error)
      type(case_t), intent(in) :: self
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: stem

      call self%get('output', 'stem', stem)
      if (index(stem, '/') > 0 .or. stem == '.' .or. stem == '..') &
         call self%refuse('output', 'stem', 1, "found stem = '"//shortened(stem) &
         //"', expected a name without a folder (that is output.directory)", error)
   end subroutine check_stem

   !> A group and its required keys in words
   pure function described(group) result(text)
      !> Index of the group
      integer, intent(in) :: group
      !> Such as `one with velocity`
      character(len=:), allocatable :: text

      integer :: row, selector

      text = ''
      selector = find_key(groups(group)%name, groups(group)%selector)
      do row = first_row(group), last_row(group)
         if (catalogue(row)%models /= '') then
            if (catalogue(selector)%default == '') cycle
            if (row_for_model(row, trim(catalogue(selector)%default)) /= row) cycle
         end if
         if (catalogue(row)%required) text = trim(text//' '//catalogue(row)%name)
      end do
      text = 'one with '//join_words(trim(adjustl(text)))
   end function described

   !> Check the entries of a group, each by itself
   subroutine check_item(self, swept, group, item, error)
      type(case_t), intent(in) :: self
      !> Addresses of the swept keys
      type(address_t), intent(in) :: swept(:)
      !> Index of the group
      integer, intent(in) :: group
      !> Index of the item
      integer, intent(in) :: item
      type(error_t), allocatable, intent(out) :: error

      integer :: row

      ! the selector comes first, as the other keys depend on it
      if (groups(group)%selector /= '') then
         row = find_key(groups(group)%name, groups(group)%selector)
         call check_entry(self, swept, address_t(group, item, row), error)
      end if
      do row = first_row(group), last_row(group)
         if (allocated(error)) return
         if (key_row(row) /= row) cycle
         call check_entry(self, swept, address_t(group, item, row), error)
      end do
   end subroutine check_item

   !> Check one entry: whether it belongs to the group, is present, and is within its range
   subroutine check_entry(self, swept, address, error)
      type(case_t), intent(in) :: self
      !> Addresses of the swept keys
      type(address_t), intent(in) :: swept(:)
      type(address_t), intent(in) :: address
      type(error_t), allocatable, intent(out) :: error

      type(entry_t) :: entry
      character(len=:), allocatable :: key, other, model, label, message
      integer :: row

      key = trim(catalogue(address%row)%name)
      other = trim(catalogue(address%row)%instead)
      entry = self%entry(address)
      row = self%row(address)
      model = self%model(address%group, address%item)
      message = ''
      associate (group => groups(address%group))
         if (row == 0) then
            if (entry%given) message = "key '"//key//"' does not belong to "//trim(group%selector) &
               //" '"//model &
               //"', its keys are: "//join_words(keys_of(address%group, model))
         else if (is_there(key) .and. is_there(other) .and. .not. is_ousted()) then
            call self%refuse(group%name, other, address%item, 'found both '//key//' and '//other &
               //', expected one of them', error)
         else if (entry%present) then
            message = range_message(catalogue(row), entry)
            if (message /= '') message = key//': '//message
         else if (catalogue(row)%required .and. .not. (is_there(key) .or. is_there(other))) then
            message = "key '"//key//"' is missing in &"//trim(group%name)
            if (group%label /= '' .and. group%label /= key) then
               call self%get(group%name, group%label, label, address%item)
               message = message//' '//quoted(shortened(label))
            end if
            if (catalogue(row)%models /= '') message = message//" of "//trim(group%selector) &
               //" '"//model//"'"
            message = message//', expected '//wanted(catalogue(row))
            if (other /= '') message = message//', or '//other
         end if
         if (message /= '') call self%refuse(group%name, key, address%item, message, error)
      end associate

   contains

      !> Whether a key of the item is given or swept
      pure function is_there(name) result(yes)
         character(len=*), intent(in) :: name
         logical :: yes

         yes = self%given(groups(address%group)%name, name, address%item) .or. name /= '' &
            .and. any(swept == self%address(groups(address%group)%name, name, address%item))
      end function is_there

      !> Whether one of the two keys is swept, and the other one comes from the case file
      pure function is_ousted() result(yes)
         logical :: yes

         type(address_t) :: place
         type(entry_t) :: fixed

         place = self%address(groups(address%group)%name, other, address%item)
         fixed = entry
         if (any(swept == address)) fixed = self%entry(place)
         yes = (any(swept == address) .neqv. any(swept == place)) &
            .and. .not. allocated(fixed%origin)
      end function is_ousted
   end subroutine check_entry

end module vcor_case_checks
