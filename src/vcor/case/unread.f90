!> Keys that an impact does not read: neither solution nor output depends on them. Setting or
!> sweeping one is an error, since unchanged numbers would be mistaken for an answer
!>
!> The keys that are read are listed by name, so a new key is refused until it is added here.
module vcor_case_unread
   use vcor_error, only : error_input, error_t, raise
   use vcor_solver_type, only : method_for
   use vcor_text, only : integer_text
   use vcor_case_address, only : swept_addresses
   use vcor_case_case, only : address_t, case_t, entry_t, operator(==)
   use vcor_case_catalogue, only : catalogue, find_group, first_row, groups, key_row, last_row
   use vcor_material_shift, only : key_laws, shift_keys
   use vcor_words, only : contains_word, join_words
   implicit none
   private

   public :: why_unread, why_no_shift, refuse_unread, method_of, has_body

contains

   !> Refuse a value from --set, or another origin than the case file, that a sweep varies or the
   !> impact does not read. In the case file such values are allowed
   subroutine refuse_unread(case, all_materials, error)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Whether materials are read that no body uses
      logical, intent(in) :: all_materials
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(entry_t) :: entry
      character(len=:), allocatable :: reason
      integer :: group, item, material, row

      material = find_group('material')
      do group = 1, size(groups)
         do item = 1, case%count(groups(group)%name)
            do row = first_row(group), last_row(group)
               if (key_row(row) /= row) cycle
               entry = case%entry(address_t(group, item, row))
               if (.not. allocated(entry%origin)) cycle
               reason = why_varied(case, address_t(group, item, row), entry%origin)
               if (reason == '' .and. .not. (all_materials .and. group == material)) &
                  reason = why_set_unread(case, address_t(group, item, row))
               if (reason == '') cycle
               call raise(error, error_input, entry%origin//': '//reason)
               return
            end do
         end do
      end do
   end subroutine refuse_unread

   !> Reason why a value that was set has no effect: a sweep varies it
   pure function why_varied(case, address, origin) result(reason)
      type(case_t), intent(in) :: case
      type(address_t), intent(in) :: address
      !> Its origin, which includes the index of an element
      character(len=*), intent(in) :: origin
      !> The reason; empty if no sweep varies it
      character(len=:), allocatable :: reason

      type(address_t), allocatable :: swept(:)
      integer :: found, i

      found = 0
      allocate (swept, source=swept_addresses(case))
      do i = 1, size(swept)
         if (swept(i)%row /= address%row .or. swept(i)%item /= address%item) cycle
         if (swept(i)%element > 0 .and. &
             index(origin, '('//integer_text(swept(i)%element)//')') == 0) cycle
         found = i
      end do
      reason = ''
      if (found > 0) reason = 'the &sweep group at '//case%location('sweep', 'parameter', found) &
         //' varies it, expected a key that no sweep varies'
   end function why_varied

   !> Reason why a value that was set is not read
   pure function why_set_unread(case, address) result(reason)
      type(case_t), intent(in) :: case
      type(address_t), intent(in) :: address
      !> The reason; empty if it is read
      character(len=:), allocatable :: reason

      select case (group_and_key(address))
      case ('material.valid_from', 'material.valid_to', 'material.valid_temperature_from', &
         'material.valid_temperature_to')
         ! no number depends on the band of the data, but a warning does
         reason = why_material_is_unread(case, address%item)
      case default
         reason = why_unread(case, address)
      end select
      if (reason /= '') reason = 'the impact does not read it: '//reason
   end function why_set_unread

   !> Reason why an impact does not read a key
   pure function why_unread(case, address) result(reason)
      !> A case whose entries are within their ranges and whose bodies have materials
      type(case_t), intent(in) :: case
      type(address_t), intent(in) :: address
      !> The reason; empty if the key is read
      character(len=:), allocatable :: reason

      character(len=*), parameter :: why_coupled = 'method coupled is linear theory and takes ' &
         //"its own steps: this key is for method = 'direct'"
      character(len=:), allocatable :: scheme
      integer :: order

      associate (group => address%group, item => address%item)
         reason = ''
         select case (group_and_key(address))
         case ('case.title', 'impact.velocity', 'impact.drop_height', &
            'sphere.shape', 'sphere.radius', 'sphere.material', 'sphere.mass', &
            'sphere.half_angle', 'sphere.punch_radius', 'sphere.profile_coefficient', &
            'sphere.profile_power', 'plate.material', 'plate.surface_radius', 'solver.method', &
            'solver.end_time', 'solver.accuracy')
            continue
         case ('solver.scheme', 'solver.volterra_order', 'solver.continue_after_separation')
            if (method_of(case) == 'coupled') reason = why_coupled
         case ('output.csv', 'output.hdf5', 'output.history', 'output.directory', 'output.stem')
            continue
         case ('sweep.parameter', 'sweep.values', 'sweep.start', 'sweep.stop', 'sweep.count')
            continue
         case ('sweep.spacing')
            if (case%given('sweep', 'values', item)) reason = 'it is for start, stop and count'
         case ('impact.gravity')
            call case%get('solver', 'scheme', scheme)
            if (scheme == 'adams_bashforth') &
               reason = "adams_bashforth marches the paper's wave equation, without a weight"
         case ('plate.extent')
            reason = why_plate_rests(case)
         case ('plate.waves', 'plate.half_thickness', 'plate.thickness', 'plate.base')
            if (body_model(case, 'plate') == 'rigid') reason = why_plate_rests(case)
         case ('contact.mechanics')
            if (case%given('contact', 'law') .and. case%given('contact', 'pair') &
                .and. case%given('plate', 'waves')) &
               reason = 'contact.law, contact.pair and plate.waves are all given'
         case ('contact.law')
            if (case%model(find_group('sphere'), 1) == 'punch') &
               reason = 'the contact of a flat punch does not recede'
         case ('contact.pair')
            reason = why_no_pair(case)
         case ('solver.time_step')
            if (method_of(case) == 'ive') reason = 'method ive takes its own steps, ' &
               //"solver.time_step is for method = 'direct'"
            if (method_of(case) == 'coupled') reason = why_coupled
         case ('solver.form', 'solver.quadrature')
            call case%get('solver', 'scheme', scheme)
            if (scheme /= 'adams_bashforth') reason = "it is for scheme = 'adams_bashforth'"
            if (method_of(case) == 'coupled') reason = why_coupled
         case ('solver.volterra_coefficient')
            call case%get('solver', 'volterra_order', order)
            if (order /= 2) reason = 'it is for solver.volterra_order = 2'
         case ('impact.temperature')
            if (.not. (shifts('sphere') .or. shifts('plate'))) reason = 'with impact.temperature ' &
               //'the material of the sphere or that of the plate needs a shift, neither has one'
         case ('material.shift', 'material.shift_file', 'material.vertical_shift', &
            'material.reference_temperature', 'material.wlf_c1', 'material.wlf_c2', &
            'material.activation_energy')
            reason = why_material_is_unread(case, item)
            if (reason == '') reason = why_no_shift(case, address)
            if (reason == '' .and. .not. case%given('impact', 'temperature') .and. .not. &
                any(swept_addresses(case) == case%address('impact', 'temperature'))) reason = &
               'without impact.temperature the material is at its reference temperature'
         case ('material.valid_from', 'material.valid_to', 'material.valid_temperature_from', &
            'material.valid_temperature_to')
            reason = 'it is for the warning about the band of the data, no number depends on it'
         case ('material.density')
            reason = why_material_is_unread(case, item)
            if (reason == '') reason = why_weightless(case, item)
         case ('material.yield_strength')
            reason = why_material_is_unread(case, item)
         case ('material.poisson_ratio')
            reason = why_material_is_unread(case, item)
            if (reason == '' .and. case%model(group, item) == 'rigid') &
               reason = 'a rigid body does not deform'
         case default
            ! other keys of a material are parameters of its modulus
            reason = 'nothing depends on it'
            if (groups(group)%name == 'material') reason = why_material_is_unread(case, item)
         end select
      end associate

   contains

      !> Whether the temperature shifts the material of a body
      pure function shifts(body)
         !> sphere or plate
         character(len=*), intent(in) :: body
         logical :: shifts

         character(len=:), allocatable :: law

         law = ''
         if (case%material_of(body) > 0) &
            call case%get('material', 'shift', law, case%material_of(body))
         shifts = law /= ''
      end function shifts
   end function why_unread

   !> Reason why a key has no part in the shift by temperature
   pure function why_no_shift(case, address) result(reason)
      type(case_t), intent(in) :: case
      !> Address of a key of a material
      type(address_t), intent(in) :: address
      !> The reason; empty if it has one, or if it is no key of a shift
      character(len=:), allocatable :: reason

      character(len=:), allocatable :: shift
      integer :: i

      reason = ''
      i = findloc(shift_keys == catalogue(address%row)%name, .true., dim=1)
      if (i == 0) return
      call case%get('material', 'shift', shift, address%item)
      if (.not. contains_word(key_laws(i), shift)) reason = "'"//trim(shift_keys(i)) &
         //"' is for a material of shift "//join_words(trim(key_laws(i)))
   end function why_no_shift

   !> Group and key as one word
   pure function group_and_key(address) result(word)
      type(address_t), intent(in) :: address
      !> Such as `sphere.radius`
      character(len=len(groups%name) + 1 + len(catalogue%name)) :: word

      word = trim(groups(address%group)%name)//'.'//catalogue(address%row)%name
   end function group_and_key

   !> Reason why the plate does not move
   pure function why_plate_rests(case) result(reason)
      type(case_t), intent(in) :: case
      !> The reason; empty if it moves
      character(len=:), allocatable :: reason

      character(len=:), allocatable :: waves

      reason = ''
      call case%get('plate', 'waves', waves)
      if (body_model(case, 'plate') == 'rigid') then
         reason = 'the plate is rigid and does not move'
      else if (waves == 'none') then
         reason = "with plate.waves = 'none' the plate does not move"
      end if
   end function why_plate_rests

   !> Reason why the rule for pairs does not matter
   pure function why_no_pair(case) result(reason)
      type(case_t), intent(in) :: case
      !> The reason; empty if it does
      character(len=:), allocatable :: reason

      reason = ''
      if (body_model(case, 'sphere') == 'rigid') then
         reason = 'the sphere is rigid'
      else if (body_model(case, 'plate') == 'rigid') then
         reason = 'the plate is rigid'
      else if (case%material_of('sphere') == case%material_of('plate')) then
         reason = 'sphere and plate are of one material'
      else if (body_model(case, 'sphere') == 'elastic' .and. &
               body_model(case, 'plate') == 'elastic') then
         reason = 'sphere and plate are elastic'
      end if
   end function why_no_pair

   !> Reason why a material does not matter for the impact
   pure function why_material_is_unread(case, item) result(reason)
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      !> The reason; empty if it matters
      character(len=:), allocatable :: reason

      reason = ''
      if (item /= case%material_of('sphere') .and. item /= case%material_of('plate')) &
         reason = 'neither the sphere nor the plate is of this material'
   end function why_material_is_unread

   !> Reason why the density of a body's material does not matter for the impact
   pure function why_weightless(case, item) result(reason)
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      !> The reason; empty if it matters
      character(len=:), allocatable :: reason

      logical :: has_mass

      reason = ''
      has_mass = case%given('sphere', 'mass') &
         .or. any(swept_addresses(case) == case%address('sphere', 'mass'))
      if (item == case%material_of('sphere')) then
         if (.not. has_mass) return
         reason = 'sphere.mass gives the mass of the sphere'
      end if
      if (item == case%material_of('plate')) then
         if (len(reason) > 0) reason = reason//', and '
         if (body_model(case, 'plate') == 'rigid') then
            reason = reason//why_plate_rests(case)
         else
            ! it determines waves in a thick body even if there are none in a thin plate
            reason = ''
         end if
      end if
   end function why_weightless

   !> Whether the impact has waves in a plate of any thickness; a rigid plate has none
   pure function has_body(case)
      type(case_t), intent(in) :: case
      logical :: has_body

      character(len=:), allocatable :: waves

      call case%get('plate', 'waves', waves)
      has_body = waves == 'body' .and. body_model(case, 'plate') /= 'rigid'
   end function has_body

   !> Method in use
   pure function method_of(case) result(name)
      type(case_t), intent(in) :: case
      !> ive, direct or coupled
      character(len=7) :: name

      character(len=:), allocatable :: method, scheme

      call case%get('solver', 'method', method)
      call case%get('solver', 'scheme', scheme)
      name = method_for(method, scheme, has_body(case))
   end function method_of

   !> Model of the material of a body
   pure function body_model(case, body) result(model)
      type(case_t), intent(in) :: case
      !> sphere or plate
      character(len=*), intent(in) :: body
      !> Its model; empty if there is no such material
      character(len=:), allocatable :: model

      integer :: item

      model = ''
      item = case%material_of(body)
      if (item > 0) call case%get('material', 'model', model, item)
   end function body_model

end module vcor_case_unread
