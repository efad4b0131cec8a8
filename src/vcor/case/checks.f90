!> Checks of a case: errors that it alone reveals (missing keys and groups, values out of range,
!> references to nothing), and numbers that are probably in another unit. Constructors check numbers
!> that depend on each other
module vcor_case_checks
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_input, error_t, raise
   use vcor_case_address, only : material_names, swept_addresses
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group, find_key, first_row, groups, key_row, &
      keys_of, last_row, list_key, real_key, row_for_model, text_key, wanted
   use vcor_case_entries, only : address_t, entry_t, operator(==)
   use vcor_case_grid, only : grid_t, new_grid
   use vcor_case_printed, only : value_text
   use vcor_case_body, only : material_of_case
   use vcor_case_mechanics, only : features_of_case, place_of_method, why_no_pair
   use vcor_case_values, only : range_message
   use vcor_impact_shape, only : find_shape, shapes
   use vcor_kinds, only : wp
   use vcor_material, only : material_t
   use vcor_material_shift, only : coldest, key_laws, keys_needed, shift_keys
   use vcor_number, only : real_text
   use vcor_solver_features, only : coupled, features, of_body, of_frozen_plate, of_thin_plate, &
      own_rules, solves, unread
   use vcor_text, only : canonical_name, printable, quoted, shortened
   use vcor_words, only : contains_word, join_words, list_of_words, longest_name, suggestion
   implicit none
   private

   public :: validate, implausible_numbers, note_length

   !> Length of the longest note
   integer, parameter :: note_length = 400

   !> Limits of plausible values
   type :: limits_t
      !> Group
      character(len=8) :: group
      !> Key; blank: all keys with the unit
      character(len=22) :: key
      !> Unit as in the catalogue
      character(len=6) :: unit
      !> Smallest plausible value, in this unit
      real(wp) :: least
      !> Largest plausible value
      real(wp) :: most
      !> Probable mistake for a smaller value
      character(len=44) :: below
      !> Probable mistake for a larger value
      character(len=44) :: above
   end type limits_t

   !> No limit
   real(wp), parameter :: endless = huge(1.0_wp)
   !> Question about a temperature
   character(len=*), parameter :: celsius = 'is it in degrees Celsius?'
   !> Moduli from those of gels to that of diamond; densities from those of foams to that of osmium;
   !> times from the period of atomic vibrations
   type(limits_t), parameter :: limits(*) = [ &
      limits_t('impact', 'temperature', 'K', coldest, endless, celsius, ''), &
      limits_t('impact', 'velocity', 'm/s', -endless, 300.0_wp, '', 'is it in mm/s?'), &
      limits_t('impact', 'drop_height', 'm', -endless, 15.0_wp, '', 'is it in cm or mm?'), &
      limits_t('sphere', 'radius', 'm', -endless, 1.0_wp, '', 'is it in mm?'), &
      limits_t('sphere', 'diameter', 'm', -endless, 2.0_wp, '', 'is it in mm?'), &
      limits_t('sphere', 'punch_radius', 'm', -endless, 1.0_wp, '', 'is it in mm?'), &
      limits_t('plate', 'half_thickness', 'm', -endless, 1.0_wp, '', 'is it in mm?'), &
      limits_t('plate', 'thickness', 'm', -endless, 2.0_wp, '', 'is it in mm?'), &
      limits_t('target', 'length', 'm', -endless, 10.0_wp, '', 'is it in mm?'), &
      limits_t('target', 'width', 'm', -endless, 10.0_wp, '', 'is it in mm?'), &
      limits_t('target', 'diameter', 'm', -endless, 2.0_wp, '', 'is it in mm?'), &
      limits_t('target', 'thickness', 'm', -endless, 2.0_wp, '', 'is it in mm?'), &
      limits_t('plate', 'surface_radius', 'm', -endless, 10.0_wp, '', 'is it in mm?'), &
      limits_t('plate', 'extent', 'm', -endless, 20.0_wp, '', 'is it in mm?'), &
      limits_t('material', 'reference_temperature', 'K', coldest, endless, celsius, ''), &
      limits_t('material', 'valid_temperature_from', 'K', coldest, endless, celsius, ''), &
      limits_t('material', '', 'Pa', 1.0e3_wp, 2.0e12_wp, 'is it in kPa, MPa or GPa?', &
      'is the power of ten right?'), &
      limits_t('material', '', 'kg/m3', 10.0_wp, 3.0e4_wp, 'is it in g/cm3?', 'is it in g/m3?'), &
      limits_t('material', 'poisson_ratio', '', 0.0_wp, 0.5_wp, 'is the sign right?', ''), &
      limits_t('material', '', 's', 1.0e-13_wp, endless, 'is it a rate, or in another unit?', ''), &
      limits_t('material', '', '1/s', -endless, 1.0e13_wp, '', &
      'is it a time, or in another unit?'), &
      limits_t('material', '', 's^-1/2', -endless, 1.0e13_wp**0.5_wp, '', 'is it in another unit?')]

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
               //trim(groups(group)%name)//' group, expected '//described(group) &
               //trim(merge(', or files of materials after the case', repeat(' ', 38), &
               groups(group)%name == 'material')))
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
      if (.not. allocated(error)) call check_target(self, error)
      if (.not. allocated(error)) call check_temperature(self, swept, error)
      if (.not. allocated(error)) call check_coupled(self, error)
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
      if (all(item /= [self%material_of('sphere'), self%material_of('plate'), &
          self%material_of('target')]) &
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

      character(len=:), allocatable :: shift, name
      type(address_t) :: address
      logical :: belongs
      integer :: i

      call self%get('material', 'shift', shift, item)
      call self%get('material', 'name', name, item)
      do i = 1, size(shift_keys)
         address = self%address('material', trim(shift_keys(i)), item)
         belongs = contains_word(key_laws(i), shift)
         if (self%given('material', trim(shift_keys(i)), item)) then
            if (.not. belongs) call self%refuse('material', trim(shift_keys(i)), item, &
               "the impact does not read it: '"//trim(shift_keys(i)) &
               //"' is for a material of shift "//join_words(trim(key_laws(i))), error)
         else if (i <= keys_needed .and. belongs .and. all(.not. swept == address)) then
            call self%refuse('material', 'shift', item, "key '"//trim(shift_keys(i)) &
               //"' is missing in &material "//quoted(shortened(name))//" with shift = '"//shift &
               //"', expected "//wanted(catalogue(address%row)), error)
         end if
         if (allocated(error)) return
      end do
   end subroutine check_shift

   !> Check that the temperature, given or swept, shifts at least one material
   subroutine check_temperature(self, swept, error)
      !> A case whose bodies have materials
      type(case_t), intent(in) :: self
      !> Addresses of the swept keys
      type(address_t), intent(in) :: swept(:)
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: reason = 'with impact.temperature the material of the ' &
         //'sphere or that of the plate needs a shift, neither has one'
      character(len=:), allocatable :: sphere, plate, target
      integer :: i

      call self%get('material', 'shift', sphere, self%material_of('sphere'))
      call self%get('material', 'shift', plate, self%material_of('plate'))
      call self%get('material', 'shift', target, self%material_of('target'))
      if (sphere//plate//target /= '') return
      if (self%given('impact', 'temperature')) call self%refuse('impact', 'temperature', 1, &
         'the impact does not read it: '//reason, error)
      do i = 1, size(swept)
         if (.not. swept(i) == self%address('impact', 'temperature')) cycle
         call self%refuse('sweep', 'parameter', i, "found 'impact.temperature', which the impact " &
            //'does not read: '//reason, error)
      end do
   end subroutine check_temperature

   !> Check that keys do not contradict the coupled contact: its own law and pair, and what it does
   !> not read. Defaults, as a completed case has them, are no contradiction
   subroutine check_coupled(self, error)
      !> A case whose bodies have materials
      type(case_t), intent(in) :: self
      type(error_t), allocatable, intent(out) :: error

      character(len=longest_name), allocatable :: keys(:)
      character(len=:), allocatable :: cause, method, waves
      logical :: has(size(features))
      integer :: i, j

      has = features_of_case(self)
      if (place_of_method(self) /= coupled .and. .not. has(of_body)) return
      call self%get('solver', 'method', method)
      call self%get('plate', 'waves', waves)
      cause = "solver.method = 'coupled'"
      if (has(of_body)) cause = "plate.waves = 'body'"
      if (place_of_method(self) /= coupled) then
         call self%refuse('solver', 'method', 1, "found method = '"//method//"' with "//cause &
            //", expected 'auto' or 'coupled', which alone solves it", error)
      else if (any([(has(i) .and. .not. solves(coupled, i), &
               i=of_thin_plate, of_frozen_plate)])) then
         call self%refuse('plate', 'waves', 1, "found waves = '"//waves//"' with "//cause &
            //", expected 'body' or 'none'", error)
      end if
      do i = 1, size(own_rules)
         ! a flat punch does not recede, and the pair of a rigid body is none
         if (own_rules(i)%key == 'law' &
             .and. .not. shapes(find_shape(self%model(find_group('sphere'), 1)))%recedes) cycle
         if (own_rules(i)%key == 'pair' .and. why_no_pair(self) /= '') cycle
         if (own_rules(i)%method == coupled) call demand(trim(own_rules(i)%group), &
            trim(own_rules(i)%key), "'"//trim(own_rules(i)%value)//"'", is_read=.true.)
      end do
      do i = 1, size(unread)
         if (.not. (unread(i)%contradicts .and. any(unread(i)%by == coupled))) cycle
         keys = list_of_words(trim(unread(i)%keys))
         do j = 1, size(keys)
            call demand(trim(unread(i)%group), trim(keys(j)), &
               default_text(find_key(trim(unread(i)%group), trim(keys(j)))), is_read=.false.)
         end do
      end do

   contains

      !> Refuse a key that is given with another value
      subroutine demand(group, key, allowed, is_read)
         character(len=*), intent(in) :: group, key
         !> The value that it may have, as in a case; empty if there is none
         character(len=*), intent(in) :: allowed
         !> Whether the key is read: otherwise --set would refuse that value, too
         logical, intent(in) :: is_read

         character(len=:), allocatable :: expected, found
         type(address_t) :: address

         if (allocated(error)) return
         if (.not. self%given(group, key)) return
         address = self%address(group, key)
         found = value_text(catalogue(address%row), self%entry(address))
         if (found == allowed) return
         expected = ''
         if (is_read) expected = allowed//' or '
         call self%refuse(group, key, 1, 'found '//key//' = '//found//' with '//cause &
            //', expected '//expected//'no such key', error)
      end subroutine demand

      !> Default of a key, as in a case
      pure function default_text(row) result(text)
         !> Its row in the catalogue
         integer, intent(in) :: row
         !> Empty if there is none
         character(len=:), allocatable :: text

         text = trim(catalogue(row)%default)
         if (text /= '' .and. catalogue(row)%value_kind == text_key) text = "'"//text//"'"
      end function default_text
   end subroutine check_coupled

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

   !> Check that a structure has its material, and that the edges of an infinite plate are not given
   !> with it
   subroutine check_target(self, error)
      type(case_t), intent(in) :: self
      type(error_t), allocatable, intent(out) :: error

      type(entry_t) :: entry
      character(len=:), allocatable :: base, body

      if (self%count('target') == 0) return
      entry = self%entry(self%address('plate', 'extent'))
      ! what was set is refused with all that the impact does not read
      if (entry%given .and. .not. allocated(entry%origin)) then
         call self%refuse('plate', 'extent', 1, 'found extent with &target, which has its edges: ' &
            //'expected no such key', error)
         return
      end if
      call self%get('target', 'body', body)
      if (self%row(self%address('target', 'material')) == 0) return
      if (self%given('target', 'material')) then
         call check_body(self, 'target', error)
         return
      end if
      call self%get('plate', 'base', base)
      if (base /= 'free') call self%refuse('target', 'material', 1, "key 'material' is missing " &
         //"in &target of body '"//body//"', expected the name of a &material: that of &plate " &
         //'is of the layer on its base', error)
   end subroutine check_target

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
      logical :: is_here, is_other_here
      integer :: row

      key = trim(catalogue(address%row)%name)
      other = trim(catalogue(address%row)%instead)
      entry = self%entry(address)
      is_here = entry%given .or. any(swept == address)
      ! most keys have no other one, and to look for it takes as long as all else
      is_other_here = .false.
      if (other /= '') is_other_here = is_there(other)
      row = self%row(address)
      model = self%model(address%group, address%item)
      message = ''
      associate (group => groups(address%group))
         if (row == 0) then
            if (entry%given) message = "key '"//key//"' does not belong to "//trim(group%selector) &
               //" '"//model &
               //"', its keys are: "//join_words(keys_of(address%group, model))
         else if (is_here .and. is_other_here .and. .not. is_replaced()) then
            call self%refuse(group%name, other, address%item, 'found both '//key//' and '//other &
               //', expected one of them', error)
         else if (entry%present) then
            message = range_message(catalogue(row), entry)
            if (message /= '') message = key//': '//message
         else if (catalogue(row)%required .and. .not. (is_here .or. is_other_here)) then
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

         yes = self%given(groups(address%group)%name, name, address%item) &
            .or. any(swept == self%address(groups(address%group)%name, name, address%item))
      end function is_there

      !> Whether one of the two keys is swept, and the other one comes from the case file
      pure function is_replaced() result(yes)
         logical :: yes

         type(address_t) :: place
         type(entry_t) :: fixed

         place = self%address(groups(address%group)%name, other, address%item)
         fixed = entry
         if (any(swept == address)) fixed = self%entry(place)
         yes = (any(swept == address) .neqv. any(swept == place)) &
            .and. .not. allocated(fixed%origin)
      end function is_replaced
   end subroutine check_entry

   !> Notes about implausible numbers of a case
   subroutine implausible_numbers(case, grid, notes)
      !> A validated case, its data read; values of the grid count in the place of its own
      type(case_t), intent(in) :: case
      !> Grid of the sweep
      type(grid_t), intent(in) :: grid
      !> One line each: place, key and value, and probable mistake
      character(len=note_length), allocatable, intent(out) :: notes(:)

      real(wp), allocatable :: values(:)
      character(len=:), allocatable :: model, place
      type(address_t) :: address
      type(entry_t) :: entry
      integer :: axis, group, i, item, row

      allocate (notes(0))
      do i = 1, size(limits)
         group = find_group(limits(i)%group)
         do item = 1, case%count(groups(group)%name)
            model = case%model(group, item)
            do row = first_row(group), last_row(group)
               if (.not. is_limited(limits(i), model, row)) cycle
               address = address_t(group, item, row)
               entry = case%entry(address)
               values = entry%list
               if (catalogue(row)%value_kind == real_key) values = [entry%number]
               if (.not. entry%present) values = [real(wp) ::]
               place = case%location(address)
               do axis = 1, size(grid%axes)
                  if (grid%axes(axis)%address%row /= row &
                      .or. grid%axes(axis)%address%item /= item) cycle
                  ! points of other programs may have any numbers
                  values = pack(grid%axes(axis)%values, ieee_is_finite(grid%axes(axis)%values))
                  place = case%location('sweep', 'parameter', axis)
               end do
               if (size(values) > 0) call note_if_beyond(limits(i), case%path(address))
            end do
         end do
      end do

   contains

      !> Note that a value of a key is beyond its limits
      subroutine note_if_beyond(limit, name)
         type(limits_t), intent(in) :: limit
         !> Path of the key
         character(len=*), intent(in) :: name

         character(len=note_length) :: note
         character(len=:), allocatable :: unit
         real(wp) :: low, high

         high = maxval(values)
         low = minval(values)
         ! for the terms of a series, the largest one counts
         if (limit%unit == 'Pa') low = high
         note = ''
         unit = ''
         if (limit%unit /= '') unit = ' '//trim(limit%unit)
         if (low < limit%least .and. catalogue(row)%name /= 'equilibrium_modulus') then
            note = real_text(low)//unit//' is less than '//real_text(limit%least) &
               //': '//limit%below
            if (limit%below == celsius) note = trim(note)//' That is ' &
               //real_text(anint(100.0_wp*low + 27315.0_wp)/100.0_wp)//' K'
         else if (high > limit%most) then
            note = real_text(high)//unit//' is more than '//real_text(limit%most) &
               //': '//limit%above
         end if
         if (note == '') return
         note = name//' = '//note
         ! a value that was set has its address as its place
         if (place /= name) note = place//': '//note
         notes = [notes, note]
      end subroutine note_if_beyond
   end subroutine implausible_numbers

   !> Whether limits apply to a key
   pure function is_limited(limit, model, row) result(yes)
      type(limits_t), intent(in) :: limit
      !> Model of the material
      character(len=*), intent(in) :: model
      !> Row of the catalogue
      integer, intent(in) :: row
      logical :: yes

      integer :: own

      own = 0
      associate (key => catalogue(row))
         yes = key_row(row) == row .and. any(key%value_kind == [real_key, list_key]) &
            .and. (limit%key == '' .and. index(key%name, 'valid_') /= 1 .or. limit%key == key%name)
         if (yes) own = row_for_model(row, model)
      end associate
      if (own > 0) yes = catalogue(own)%unit == limit%unit
      yes = yes .and. own > 0
   end function is_limited

end module vcor_case_checks
