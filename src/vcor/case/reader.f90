!> Reads the inputs of an impact from a case
!>
!> The only place that knows the keys of impact, bodies, contact and solver, which of them say the
!> same, and what each that is left out has no effect on. Values are taken through `reading`, which
!> records them: what is set and not read is refused. So a value is read where it has an effect, and
!> only there.
module vcor_case_reader
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_body, only : read_material
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group
   use vcor_case_entries, only : address_t
   use vcor_case_inputs, only : input_key_t, inputs_t, of_plate, of_sphere, of_target, &
      target_beam, target_block, target_modes, target_none, target_plate, target_rod, waves_body
   use vcor_case_mechanics, only : features_of_case, place_of_method, why_no_pair
   use vcor_case_reading, only : reading_t
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_body, only : support_cantilever, support_clamped, support_free, &
      support_supported
   use vcor_impact_contact, only : pair_eq1, pair_series
   use vcor_impact_face, only : base_bonded, base_free, base_sliding
   use vcor_impact_shape, only : find_shape, shape_parameters, shapes
   use vcor_impact_target, only : waves_constant, waves_frozen, waves_hereditary, waves_none, &
      waves_relaxing
   use vcor_kinds, only : wp
   use vcor_solver_features, only : features, of_ghost, of_second_term, unread, why_unread
   implicit none
   private

   public :: read_inputs, quantity_at, waves_of

   !> Words of a key and what they mean
   character(len=*), parameter :: wave_names(*) = [character(len=10) :: 'none', 'constant', &
      'relaxing', 'frozen', 'hereditary', 'body']
   integer, parameter :: waves(*) = [waves_none, waves_constant, waves_relaxing, waves_frozen, &
      waves_hereditary, waves_body]
   character(len=*), parameter :: base_names(*) = [character(len=7) :: 'free', 'bonded', 'sliding']
   integer, parameter :: bases(*) = [base_free, base_bonded, base_sliding]
   character(len=*), parameter :: target_names(*) = [character(len=5) :: 'plate', 'beam', 'rod', &
      'block', 'modes']
   integer, parameter :: targets(*) = [target_plate, target_beam, target_rod, target_block, &
      target_modes]
   character(len=*), parameter :: support_names(*) = [character(len=10) :: 'supported', 'clamped', &
      'cantilever', 'free']
   integer, parameter :: supports(*) = [support_supported, support_clamped, support_cantilever, &
      support_free]

   !> Groups of the bodies, by their places
   character(len=*), parameter :: bodies(*) = [character(len=6) :: 'sphere', 'plate', 'target']

contains

   !> Read the inputs of an impact
   subroutine read_inputs(case, inputs, reading, error)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      type(inputs_t), intent(out) :: inputs
      !> What they take of the case
      type(reading_t), intent(out) :: reading
      !> Error of code `error_input` if the case is not checked, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      if (min(case%material_of('sphere'), case%material_of('plate')) < 1) then
         call raise(error, error_input, 'the case is empty or not checked: expected read_case, ' &
            //'then validate, without an error')
         return
      end if
      call reading%start(case)
      do i = 1, size(bodies)
         inputs%item(i) = case%material_of(trim(bodies(i)))
         if (inputs%item(i) == 0) cycle
         call reading%mark(case%address(trim(bodies(i)), 'material'))
         call read_material(case, inputs%item(i), reading, inputs%material(i))
      end do
      call read_sphere(case, inputs, reading)
      call read_plate(case, inputs, reading)
      call read_target(case, inputs, reading)
      call read_contact(case, inputs, reading)
      call read_solver(case, inputs, reading)
   end subroutine read_inputs

   !> Read the motion, and what strikes
   subroutine read_sphere(case, inputs, reading)
      type(case_t), intent(in) :: case
      type(inputs_t), intent(inout) :: inputs
      type(reading_t), intent(inout) :: reading

      character(len=:), allocatable :: text
      type(address_t) :: density
      integer :: i

      call take(case, inputs, reading, 'impact', 'velocity')
      call take(case, inputs, reading, 'impact', 'drop_height')
      call reading%get(case, 'sphere', 'shape', text)
      inputs%shape = find_shape(text)
      call take(case, inputs, reading, 'sphere', 'radius')
      if (ieee_is_nan(inputs%radius)) call take(case, inputs, reading, 'sphere', 'diameter')
      do i = 1, size(shape_parameters)
         if (shape_parameters(i)%shape == text) call take(case, inputs, reading, 'sphere', &
            trim(shape_parameters(i)%parameter%name))
      end do
      call take(case, inputs, reading, 'sphere', 'mass')
      density = case%address('material', 'density', inputs%item(of_sphere))
      if (case%given('sphere', 'mass')) then
         call reading%note_unread(density, 'sphere.mass gives the mass of the sphere')
      else if (ieee_is_nan(inputs%mass)) then
         call reading%mark(density)
      end if
      call take(case, inputs, reading, 'material', 'yield_strength', of_sphere)
   end subroutine read_sphere

   !> Read the plate; a rigid one has neither waves nor a base
   subroutine read_plate(case, inputs, reading)
      !> The materials read
      type(case_t), intent(in) :: case
      type(inputs_t), intent(inout) :: inputs
      type(reading_t), intent(inout) :: reading

      character(len=*), parameter :: keys(*) = [character(len=14) :: 'base', 'waves', &
         'half_thickness', 'thickness', 'extent']
      character(len=*), parameter :: thicknesses(*) = [character(len=14) :: 'half_thickness', &
         'thickness']
      character(len=*), parameter :: at_rest = 'the plate is rigid and does not move'
      character(len=*), parameter :: bodies_without(*) = [character(len=5) :: 'block', 'rod', &
         'modes']
      character(len=:), allocatable :: mechanics, text, waves
      integer :: i

      call take(case, inputs, reading, 'plate', 'surface_radius')
      call take(case, inputs, reading, 'material', 'yield_strength', of_plate)
      if (inputs%material(of_plate)%model == 'rigid') then
         inputs%waves = waves_none
         do i = 1, size(keys)
            call reading%note_unread(case%address('plate', trim(keys(i))), at_rest)
         end do
         call reading%note_unread(case%address('material', 'density', inputs%item(of_plate)), &
            at_rest)
         return
      end if
      call reading%mark(case%address('material', 'density', inputs%item(of_plate)))
      call reading%get(case, 'plate', 'base', text)
      inputs%base = bases(findloc(base_names == text, .true., dim=1))
      text = ''
      if (case%count('target') > 0) call case%get('target', 'body', text)
      call case%get('plate', 'waves', waves)
      ! with waves the thickness is that of a free plate beside the body, which is refused
      if (inputs%base == base_free .and. waves == 'none' .and. any(bodies_without == text)) then
         do i = 1, size(thicknesses)
            call reading%note_unread(case%address('plate', trim(thicknesses(i))), &
               "the surface of this body has no thickness of its own; that of a layer needs base")
         end do
      else if (inputs%base == base_free .and. case%given('target', 'thickness')) then
         do i = 1, size(thicknesses)
            call reading%note_unread(case%address('plate', trim(thicknesses(i))), &
               'target.thickness is that of the plate or beam')
         end do
      else
         call take(case, inputs, reading, 'plate', 'half_thickness')
         if (.not. inputs%half_thickness > 0.0_wp) &
            call take(case, inputs, reading, 'plate', 'thickness')
      end if
      call reading%get(case, 'plate', 'waves', text)
      inputs%waves = waves_of(text)
      call case%get('contact', 'mechanics', mechanics)
      inputs%waves_are_chosen = mechanics == 'exact' .and. .not. case%given('plate', 'waves') &
         .and. case%count('target') == 0
      if (case%count('target') > 0) then
         call reading%note_unread(case%address('plate', 'extent'), '&target has its edges')
      else if (text == 'none') then
         call reading%note_unread(case%address('plate', 'extent'), &
            "with plate.waves = 'none' the plate does not move")
      else
         call take(case, inputs, reading, 'plate', 'extent')
      end if
   end subroutine read_plate

   !> Read the structure that carries the struck surface
   subroutine read_target(case, inputs, reading)
      !> The plate read
      type(case_t), intent(in) :: case
      type(inputs_t), intent(inout) :: inputs
      type(reading_t), intent(inout) :: reading

      character(len=*), parameter :: numbers(*) = [character(len=19) :: 'length', 'width', &
         'diameter', 'thickness', 'damping_ratio', 'mass', 'stiffness', 'damping', &
         'residual_compliance']
      character(len=:), allocatable :: text
      real(wp), allocatable :: list(:)
      type(address_t) :: address
      integer :: i

      inputs%target%body = target_none
      if (case%count('target') == 0) return
      call reading%get(case, 'target', 'body', text)
      inputs%target%body = targets(findloc(target_names == text, .true., dim=1))
      ! the inputs are built as they are: numbers of another body do not count
      do i = 1, size(numbers)
         if (case%row(case%address('target', trim(numbers(i)))) == 0) cycle
         call take(case, inputs, reading, 'target', trim(numbers(i)))
      end do
      if (case%row(case%address('target', 'support')) > 0) then
         call reading%get(case, 'target', 'support', text)
         inputs%target%support = supports(findloc(support_names == text, .true., dim=1))
      end if
      address = case%address('target', 'position')
      call reading%mark(address)
      call case%get('target', 'position', inputs%target%position)
      if (inputs%target%body /= target_modes) return
      call reading%mark(case%address('target', 'file'))
      ! the modes that have been read from the file
      call case%get('target', 'file', list)
      inputs%target%modes = reshape(list, [3, size(list)/3])
   end subroutine read_target

   !> Waves by their name in a case
   pure function waves_of(name) result(kind)
      character(len=*), intent(in) :: name
      !> One of the `waves_*` constants
      integer :: kind

      kind = waves(findloc(wave_names == name, .true., dim=1))
   end function waves_of

   !> Read the contact law and the rule for pairs
   subroutine read_contact(case, inputs, reading)
      type(case_t), intent(in) :: case
      type(inputs_t), intent(inout) :: inputs
      type(reading_t), intent(inout) :: reading

      character(len=:), allocatable :: text

      call case%get('contact', 'law', text)
      inputs%receding = text == 'receding'
      if (.not. shapes(inputs%shape)%recedes) then
         ! a user who requests it gets an error
         inputs%receding = inputs%receding .and. case%given('contact', 'law')
         call reading%note_unread(case%address('contact', 'law'), &
            'the contact of a flat punch does not recede')
      else
         call reading%mark(case%address('contact', 'law'))
      end if
      if (why_no_pair(case) == '') then
         call reading%get(case, 'contact', 'pair', text)
         inputs%pair = merge(pair_series, pair_eq1, text == 'series')
      else
         call reading%note_unread(case%address('contact', 'pair'), why_no_pair(case))
      end if
      ! it chooses what is not given and has an effect
      if ((case%given('contact', 'law') .or. .not. shapes(inputs%shape)%recedes) &
          .and. (case%given('contact', 'pair') .or. why_no_pair(case) /= '') &
          .and. (case%given('plate', 'waves') .or. case%count('target') > 0 &
          .or. inputs%material(of_plate)%model == 'rigid')) then
         call reading%note_unread(case%address('contact', 'mechanics'), &
            'contact.law, contact.pair and plate.waves are given, or have no effect')
      else
         call reading%mark(case%address('contact', 'mechanics'))
      end if
   end subroutine read_contact

   !> Read the method and what belongs to it
   subroutine read_solver(case, inputs, reading)
      type(case_t), intent(in) :: case
      type(inputs_t), intent(inout) :: inputs
      type(reading_t), intent(inout) :: reading

      !> Keys that depend on the method
      character(len=*), parameter :: groups(*) = [character(len=6) :: 'impact', 'solver', &
         'solver', 'solver', 'solver', 'solver', 'solver', 'solver']
      character(len=*), parameter :: keys(*) = [character(len=25) :: 'gravity', 'scheme', 'form', &
         'quadrature', 'time_step', 'volterra_order', 'volterra_coefficient', &
         'continue_after_separation']
      character(len=:), allocatable :: text
      character(len=len(unread%reason)) :: reason
      logical :: has(size(features))
      integer :: i

      associate (settings => inputs%settings)
         call reading%get(case, 'solver', 'method', text)
         settings%method = text
         call case%get('solver', 'scheme', text)
         settings%scheme = text
         call case%get('solver', 'form', text)
         settings%form = text
         call case%get('solver', 'quadrature', text)
         settings%quadrature = text
         has = features_of_case(case)
         settings%ghost = has(of_ghost)
         call case%get('impact', 'bounces', settings%bounces)
         call reading%mark(case%address('impact', 'bounces'))
      end associate
      ! they count whether the method reads them or not: it refuses what it cannot take
      call put(case, inputs, 'impact', 'gravity')
      call put(case, inputs, 'solver', 'time_step')
      if (has(of_second_term)) call put(case, inputs, 'solver', 'volterra_coefficient')
      call take(case, inputs, reading, 'solver', 'end_time')
      call take(case, inputs, reading, 'solver', 'accuracy')
      do i = 1, size(keys)
         reason = why_unread(trim(groups(i)), trim(keys(i)), place_of_method(case), has)
         if (reason == '') then
            call reading%mark(case%address(trim(groups(i)), trim(keys(i))))
         else
            call reading%note_unread(case%address(trim(groups(i)), trim(keys(i))), trim(reason))
         end if
      end do
   end subroutine read_solver

   !> Read a number into the inputs, if there is one
   subroutine take(case, inputs, reading, group, key, body)
      type(case_t), intent(in) :: case
      type(inputs_t), intent(inout) :: inputs
      type(reading_t), intent(inout) :: reading
      character(len=*), intent(in) :: group, key
      !> Body of the material; absent: not of a material
      integer, intent(in), optional :: body

      if (present(body)) then
         call reading%mark(case%address(group, key, inputs%item(body)))
      else
         call reading%mark(case%address(group, key))
      end if
      call put(case, inputs, group, key, body)
   end subroutine take

   !> Put a number of the case into the inputs, if there is one, without a record of it
   subroutine put(case, inputs, group, key, body)
      type(case_t), intent(in) :: case
      type(inputs_t), intent(inout) :: inputs
      character(len=*), intent(in) :: group, key
      !> Body of the material; absent: not of a material
      integer, intent(in), optional :: body

      type(input_key_t) :: quantity
      real(wp) :: number
      integer :: item

      item = 1
      quantity%key = key
      quantity%of_structure = group == 'target'
      if (present(body)) then
         item = inputs%item(body)
         quantity%of_body(body) = .true.
      end if
      number = case%number(case%address(group, key, item))
      if (.not. ieee_is_nan(number)) call inputs%put(quantity, number)
   end subroutine put

   !> The number of the inputs at an address of the case
   pure function quantity_at(address, inputs) result(quantity)
      type(address_t), intent(in) :: address
      !> The inputs of its case
      type(inputs_t), intent(in) :: inputs
      type(input_key_t) :: quantity

      quantity%key = catalogue(address%row)%name
      quantity%element = address%element
      if (address%group == find_group('material')) quantity%of_body = inputs%item == address%item
      quantity%of_structure = address%group == find_group('target')
   end function quantity_at

end module vcor_case_reader
