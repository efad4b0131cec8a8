!> From a case to the impact that it describes, and its solver
!>
!> `update` follows the numbers of the case: it rebuilds what depends on a changed number, and
!> nothing else. The case numbers its changes. Each object stores in `..._made_at` the latest change
!> of the numbers from which it was made, and stays valid as long as that is their latest change:
!>
!>  - New velocity: only the motion is set, as at every point; materials, contact and solver remain.
!>  - New temperature: materials with a shift are rebuilt, without fitting points of data again, and
!>    then the contact.
!>  - New number of the sphere's material: the same for the sphere only.
!>
!> Threads of a sweep call `update`, so it calls no function with a result of deferred length, since
!> gfortran 12 keeps that length in static storage.
!>
!> Rules for numbers that depend on each other are in the constructors of materials, contact, plate,
!> impact and solver. Their errors name arguments, `error%about`; `explain` replaces them by keys
!> and lines, and `may_contribute` tells whether a swept key is one of them.
module vcor_case_problem
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_case, only : address_t, case_t, entry_t
   use vcor_case_catalogue, only : catalogue, find_group, first_row, groups, key_row, keys_of, &
      last_row, list_key
   use vcor_case_printed, only : value_text
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_contact, only : new_contact_modulus, pair_eq1, pair_series
   use vcor_impact_outcome, only : none, outcome_t
   use vcor_impact_law, only : cone_factor, contact_law_t, new_contact_law, profile_factor, &
      punch_factor, sphere_factor
   use vcor_impact_face, only : base_bonded, base_free, base_half_space, base_sliding, face_t, &
      new_face
   use vcor_impact_layer_law, only : layer_t, lay, profile_t
   use vcor_impact_plate, only : new_plate, waves_constant, waves_frozen, waves_hereditary, &
      waves_none, waves_relaxing
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_impact_validity, only : assess, surroundings_t
   use vcor_kinds, only : pi, standard_gravity, wp
   use vcor_material, only : material_data_t, material_t, new_material, parameters_of
   use vcor_material_type, only : density, parameter_t
   use vcor_material_shift, only : shift_parameters
   use vcor_solver, only : check_settings, new_solver, solve_impact, solver_settings_t, solver_t
   use vcor_text, only : integer_text, quoted, shortened
   use vcor_words, only : list_of_words, longest_name
   implicit none
   private

   public :: problem_t, problem_of_case, material_of_case, solve_case, may_contribute

   !> Number of no change: an object that has not been made, or could not
   integer, parameter :: never = -1

   !> A material of the case
   type :: body_t
      !> Address of the material in the case
      type(address_t) :: address
      !> Address of its temperature; nowhere if the material has no shift
      type(address_t) :: temperature
      !> Addresses of the other numbers and lists from which it is made, shape (n)
      type(address_t), allocatable :: made_from(:)
      !> Its data
      type(material_data_t) :: data
      !> The material, allocated after it was built
      class(material_t), allocatable :: material
      !> Latest change of all these numbers when it was made
      integer :: made_at = never
   end type body_t

   !> Addresses of the numbers from which an impact is made
   type :: numbers_t
      type(address_t) :: velocity, drop_height, gravity, radius, mass, surface_radius
      type(address_t) :: half_thickness, thickness, half_angle, punch_radius
      type(address_t) :: profile_coefficient, profile_power
      type(address_t) :: extent, yield_strength(2)
      type(address_t) :: time_step, end_time, accuracy, second_coefficient
   end type numbers_t

   !> Impact and solver of a case
   type :: problem_t
      !> The impact
      type(impact_t) :: impact
      !> The solver
      class(solver_t), allocatable :: solver
      !> Settings of the solution
      type(solver_settings_t) :: settings
      !> Data for the measures of validity beside the impact
      type(surroundings_t) :: surroundings
      !> Material of the sphere
      type(body_t), private :: sphere
      !> Material of the plate
      type(body_t), private :: plate
      !> Addresses of the numbers
      type(numbers_t), private :: at
      !> Shape of the striking body, as named in the case
      character(len=11), private :: shape = 'sphere'
      !> One of base_free, base_bonded and base_sliding
      integer, private :: base = base_free
      !> Waves of a thin plate, one of the `waves_*` constants
      integer, private :: waves = waves_relaxing
      !> Whether the plate has waves as it is, of any thickness
      logical, private :: has_body = .false.
      !> One of the `pair_*` constants
      integer, private :: pair = pair_eq1
      !> Whether the Volterra series has its second term
      logical, private :: second_term = .false.
      !> Latest change of materials and half thickness when modulus and plate were made from them
      integer, private :: contact_made_at = never
      !> Latest change of the numbers of the solver when it was made
      integer, private :: solver_made_at = never
   contains
      procedure :: update, solve
   end type problem_t

contains

   !> Build the impact and the solver of a case; swept keys have their values in the case
   subroutine problem_of_case(self, case, error)
      type(problem_t), intent(out) :: self
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Error of code `error_input` with the place of its cause, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: wave_names(*) = [character(len=10) :: 'none', 'constant', &
         'relaxing', 'frozen', 'hereditary', 'body']
      integer, parameter :: waves(*) = [waves_none, waves_constant, waves_relaxing, waves_frozen, &
         waves_hereditary, waves_none]
      character(len=*), parameter :: base_names(*) = [character(len=7) :: 'free', 'bonded', &
         'sliding']
      integer, parameter :: bases(*) = [base_free, base_bonded, base_sliding]
      character(len=:), allocatable :: text
      integer :: order

      if (min(case%material_of('sphere'), case%material_of('plate')) < 1) then
         call raise(error, error_input, 'the case is empty or not checked: expected read_case, ' &
            //'then validate, without an error')
         return
      end if
      self%at%velocity = case%address('impact', 'velocity')
      self%at%drop_height = case%address('impact', 'drop_height')
      self%at%gravity = case%address('impact', 'gravity')
      self%at%radius = case%address('sphere', 'radius')
      self%at%mass = case%address('sphere', 'mass')
      self%at%half_angle = case%address('sphere', 'half_angle')
      self%at%punch_radius = case%address('sphere', 'punch_radius')
      self%at%profile_coefficient = case%address('sphere', 'profile_coefficient')
      self%at%profile_power = case%address('sphere', 'profile_power')
      self%at%surface_radius = case%address('plate', 'surface_radius')
      self%at%half_thickness = case%address('plate', 'half_thickness')
      self%at%thickness = case%address('plate', 'thickness')
      self%at%extent = case%address('plate', 'extent')
      self%at%time_step = case%address('solver', 'time_step')
      self%at%end_time = case%address('solver', 'end_time')
      self%at%accuracy = case%address('solver', 'accuracy')
      self%at%second_coefficient = case%address('solver', 'volterra_coefficient')

      call case%get('plate', 'waves', text)
      self%waves = waves(findloc(wave_names == text, .true., dim=1))
      self%has_body = text == 'body'
      call case%get('plate', 'base', text)
      self%base = bases(findloc(base_names == text, .true., dim=1))
      call case%get('sphere', 'shape', text)
      self%shape = text
      call case%get('contact', 'law', text)
      self%impact%law%receding = text == 'receding'
      ! the contact of a punch does not recede; a user who requests it gets an error
      if (self%shape == 'punch' .and. .not. case%given('contact', 'law')) &
         self%impact%law%receding = .false.
      call case%get('contact', 'pair', text)
      self%pair = merge(pair_series, pair_eq1, text == 'series')

      call case%get('solver', 'method', text)
      self%settings%method = text
      call case%get('solver', 'scheme', text)
      self%settings%scheme = text
      call case%get('solver', 'form', text)
      self%settings%form = text
      call case%get('solver', 'quadrature', text)
      self%settings%quadrature = text
      call case%get('solver', 'volterra_order', order)
      self%second_term = order == 2
      call case%get('solver', 'continue_after_separation', self%settings%ghost)

      call describe(self%sphere, case, case%material_of('sphere'))
      call describe(self%plate, case, case%material_of('plate'))
      self%at%yield_strength = [ &
         case%address('material', 'yield_strength', self%sphere%address%item), &
         case%address('material', 'yield_strength', self%plate%address%item)]
      call self%update(case, error)
      if (allocated(error)) call explain(case, error)
   end subroutine problem_of_case

   !> Build a material of a case
   subroutine material_of_case(case, item, material, error)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      class(material_t), allocatable, intent(out) :: material
      !> Error of code `error_input` with the place of its cause, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(body_t) :: body

      call describe(body, case, item)
      call update_body(body, case, error)
      if (allocated(error)) then
         call explain(case, error)
      else
         call move_alloc(body%material, material)
      end if
   end subroutine material_of_case

   !> Solve the impact of a case
   subroutine solve_case(case, outcome, error)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      type(outcome_t), intent(out) :: outcome
      type(error_t), allocatable, intent(out) :: error

      type(problem_t) :: problem
      type(trajectory_t) :: trajectory

      call problem_of_case(problem, case, error)
      if (.not. allocated(error)) call problem%solve(trajectory, outcome, error)
   end subroutine solve_case

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
      type(entry_t) :: entry
      character(len=longest_name), allocatable :: names(:)
      character(len=:), allocatable :: place, found, name
      integer :: i
      logical :: is_given

      allocate (names, source=names_about(error))
      found = ''
      is_given = .false.
      do i = 1, size(names)
         address = address_of(case, trim(names(i)), error%item)
         if (address%group == 0) cycle
         entry = case%entry(address)
         ! the first one that was given, otherwise the first
         if (cause%group == 0 .or. entry%given .and. .not. is_given) cause = address
         is_given = is_given .or. entry%given
         associate (key => catalogue(address%row))
            if (key%value_kind == list_key .and. entry%given) then
               found = found//' and '//integer_text(size(entry%list))//' '//trim(key%name)
            else if (key%value_kind /= list_key .and. entry%present) then
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

   !> Address of the key with the name of an argument
   pure function address_of(case, name, item) result(address)
      type(case_t), intent(in) :: case
      character(len=*), intent(in) :: name
      !> Index of its material, if it has one; 0: none
      integer, intent(in) :: item
      !> The address; nowhere if there is no such key
      type(address_t) :: address

      integer :: group

      if (item > 0) then
         address = case%address('material', name, item)
         if (address%group > 0) return
      end if
      ! backwards: for an error about the material of two bodies, take that of the plate
      do group = size(groups), 1, -1
         if (.not. groups(group)%repeated) address = case%address(groups(group)%name, name)
         if (address%group > 0) return
      end do
   end function address_of

   !> Describe a material except for its numbers
   subroutine describe(body, case, item)
      !> The material, not built
      type(body_t), intent(out) :: body
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item

      type(parameter_t), allocatable :: parameters(:)
      type(address_t) :: address
      type(entry_t) :: entry
      real(wp), allocatable :: table(:)
      character(len=:), allocatable :: word
      integer :: row
      logical :: counts

      body%address = case%address('material', 'name', item)
      call case%get('material', 'name', body%data%name, item)
      call case%get('material', 'model', body%data%model, item)
      call case%get('material', 'modulus_kind', word, item)
      body%data%is_shear = word == 'shear'
      call case%get('material', 'shift', word, item)
      body%data%shift%law = word
      call case%get('material', 'vertical_shift', body%data%shift%vertical, item)
      if (word /= '') body%temperature = case%address('impact', 'temperature')
      if (word == 'table') then
         call case%get('material', 'shift_file', table, item)
         body%data%shift%temperatures = table(1::2)
         body%data%shift%logarithms = table(2::2)
      end if
      allocate (parameters, source=[density, shift_parameters, parameters_of(body%data%model)])
      allocate (body%made_from(0))
      do row = first_row(body%address%group), last_row(body%address%group)
         if (key_row(row) /= row) cycle
         ! lists are the terms of a Prony series or the points of a table, which are not parameters
         counts = any(catalogue(row)%name == parameters%name)
         address = address_t(body%address%group, item, row)
         if (catalogue(row)%value_kind == list_key) then
            entry = case%entry(address)
            counts = size(entry%list) > 0
         end if
         if (counts) body%made_from = [body%made_from, address]
      end do
   end subroutine describe

   !> Update the problem to the numbers of the case
   subroutine update(self, case, error)
      !> The problem of this case
      class(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: velocity, gravity, mass, factor
      integer :: latest

      call update_body(self%sphere, case, error)
      if (allocated(error)) return
      call update_body(self%plate, case, error)
      if (allocated(error)) return
      latest = max(self%sphere%made_at, self%plate%made_at, &
         case%latest_change([self%at%half_thickness, self%at%thickness]))
      if (self%contact_made_at /= latest) then
         self%contact_made_at = never
         call build_contact(self, case, error)
         if (allocated(error)) return
         self%contact_made_at = latest
      end if
      gravity = case%number(self%at%gravity)
      velocity = case%number(self%at%velocity)
      if (ieee_is_nan(velocity)) velocity = sqrt(2.0_wp*case%number(self%at%drop_height) &
         *merge(gravity, standard_gravity, gravity > 0.0_wp))
      mass = case%number(self%at%mass)
      if (ieee_is_nan(mass)) then
         mass = 4.0_wp/3.0_wp*pi*case%number(self%at%radius)**3*self%sphere%material%density()
         if (.not. self%sphere%material%density() > 0.0_wp) then
            call raise(error, error_input, 'the mass of the sphere follows from it; or give ' &
               //'mass in &sphere', about='density')
            error%item = self%sphere%address%item
            return
         end if
      end if
      call set_shape(self, case, factor, error)
      if (.not. allocated(error)) call self%impact%launch(velocity, mass, factor, error, gravity)
      if (allocated(error)) return
      call update_surroundings(self, case)
      call update_solver(self, case, error)
   end subroutine update

   !> Solve the impact, and assess whether the model holds
   subroutine solve(self, trajectory, outcome, error)
      !> The problem; it keeps what it computes for similar impacts
      class(problem_t), intent(inout) :: self
      !> Trajectory of the impact
      type(trajectory_t), intent(inout) :: trajectory
      !> Outcome with the measures of validity
      type(outcome_t), intent(out) :: outcome
      !> Error of code `error_numerical` as from `solve_impact`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (.not. allocated(self%solver)) then
         call raise(error, error_input, 'the problem is empty: problem_of_case has not built it')
         return
      end if
      call solve_impact(self%solver, self%impact, trajectory, outcome, error)
      if (allocated(error) .or. outcome%status /= contact_separated) return
      call assess(outcome, self%impact, trajectory, self%surroundings, self%sphere%material, &
         self%plate%material)
   end subroutine solve

   !> Update the data for the measures of validity
   subroutine update_surroundings(self, case)
      !> The problem, its materials built
      type(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case

      real(wp) :: yield_strength(2)

      self%surroundings%radius = case%number(self%at%radius)
      self%surroundings%is_sphere = case%number(self%at%surface_radius) > 0.0_wp
      self%surroundings%thickness = none
      if (half_thickness(self, case) > 0.0_wp) &
         self%surroundings%thickness = 2.0_wp*half_thickness(self, case)
      self%surroundings%on_base = self%base /= base_free .and. .not. self%plate%material%rigid
      self%surroundings%is_true = self%shape == 'true_sphere'
      self%surroundings%has_body = self%impact%face%has_waves
      self%surroundings%extent = case%number(self%at%extent)
      self%surroundings%drops = .not. ieee_is_nan(case%number(self%at%drop_height))
      self%surroundings%is_weighed = self%impact%gravity > 0.0_wp
      self%surroundings%gravity = merge(self%impact%gravity, standard_gravity, &
         self%surroundings%is_weighed)
      yield_strength = [case%number(self%at%yield_strength(1)), &
         case%number(self%at%yield_strength(2))]
      if (ieee_is_nan(yield_strength(1))) yield_strength(1) = yield_strength(2)
      if (.not. any(ieee_is_nan(yield_strength))) yield_strength(1) = minval(yield_strength)
      self%surroundings%yield_strength = yield_strength(1)
      call self%surroundings%follow(self%plate%material%poisson_ratio())
   end subroutine update_surroundings

   !> Build contact modulus, plate and face of the impact
   subroutine build_contact(self, case, error)
      !> The problem, its materials built
      type(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      call new_contact_modulus(self%impact%modulus, self%sphere%material, self%plate%material, &
         self%sphere%data%deforms_as(self%plate%data), error, self%pair)
      if (.not. allocated(error)) call new_plate(self%impact%plate, self%plate%material, &
         half_thickness(self, case), self%waves, error)
      if (.not. allocated(error)) call build_face(self, case, error)
      if (.not. allocated(error)) return
      if (.not. allocated(error%about)) return
      if (error%about == 'density') error%item = self%plate%address%item
   end subroutine build_contact

   !> Build the face of the impact if the coupled contact is to be solved. A rigid plate has no
   !> waves
   subroutine build_face(self, case, error)
      !> The problem, its materials built
      type(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: base
      logical :: has_waves

      self%impact%face = face_t()
      has_waves = self%has_body .and. .not. self%plate%material%rigid
      if (.not. (has_waves .or. self%settings%method == 'coupled')) return
      base = self%base
      ! without waves a wide free plate is as stiff as a half space
      if (base == base_free .and. .not. (has_waves .and. half_thickness(self, case) > 0.0_wp)) &
         base = base_half_space
      call new_face(self%impact%face, self%plate%material, self%sphere%material, base, &
         2.0_wp*half_thickness(self, case), has_waves, error)
   end subroutine build_face

   !> Set the contact law of the shape of the striking body
   subroutine set_shape(self, case, factor, error)
      type(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case
      !> Factor K of the shape [m^(2-n)]
      real(wp), intent(out) :: factor
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(contact_law_t) :: law
      type(layer_t) :: layer
      type(profile_t) :: profile
      real(wp) :: exponent, surface_radius

      surface_radius = case%number(self%at%surface_radius)
      factor = 0.0_wp
      exponent = law%start_exponent
      if (abs(surface_radius) > 0.0_wp) then
         if (self%shape /= 'sphere') call raise(error, error_input, "only shape = 'sphere' meets " &
            //'a curved surface', about='surface_radius shape')
         if (self%base /= base_free) call raise(error, error_input, 'a layer on a base is flat', &
            about='surface_radius base')
         if (allocated(error)) return
      end if
      select case (self%shape)
      case ('cone')
         exponent = 2.0_wp
         factor = cone_factor(case%number(self%at%half_angle))
      case ('punch')
         exponent = 1.0_wp
         factor = punch_factor(case%number(self%at%punch_radius))
      case ('power')
         exponent = 1.0_wp + 1.0_wp/case%number(self%at%profile_power)
         factor = profile_factor(case%number(self%at%profile_coefficient), &
            case%number(self%at%profile_power))
      case default
         call sphere_factor(case%number(self%at%radius), surface_radius, factor, error)
      end select
      if (.not. allocated(error)) &
         call new_contact_law(law, exponent, self%impact%law%receding, error)
      if (allocated(error)) return
      if (abs(law%start_exponent - self%impact%law%start_exponent) > 0.0_wp) self%impact%law = law
      profile%power = 0.0_wp
      if (exponent > 1.0_wp) profile%power = 1.0_wp/(exponent - 1.0_wp)
      if (self%shape == 'true_sphere') profile%radius = case%number(self%at%radius)
      call describe_layer(self, case, layer, error)
      if (.not. allocated(error)) call lay(self%impact%law, layer, profile, factor, error)
   end subroutine set_shape

   !> Layer on a base, for the contact law: a half space if there is none, or its waves are solved
   subroutine describe_layer(self, case, layer, error)
      !> The problem, its materials built
      type(problem_t), intent(in) :: self
      type(case_t), intent(in) :: case
      type(layer_t), intent(out) :: layer
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: sphere, plate

      if (self%base == base_free .or. self%plate%material%rigid) return
      layer%thickness = 2.0_wp*half_thickness(self, case)
      if (.not. layer%thickness > 0.0_wp) then
         call raise(error, error_input, 'a layer on a base needs its thickness [m], or ' &
            //'half_thickness', about='base thickness')
      else if (self%waves /= waves_none) then
         call raise(error, error_input, 'the waves of a thin plate are those of a free one, ' &
            //"expected waves = 'none' or 'body' with a base", about='waves base')
      else if (self%settings%scheme /= 'product') then
         call raise(error, error_input, 'adams_bashforth is the scheme of the paper, for a free ' &
            //"plate; use method = 'ive', or 'direct' with scheme = 'product'", &
            about='scheme base')
      end if
      if (allocated(error) .or. self%has_body .or. self%settings%method == 'coupled') return
      layer%base = self%base
      layer%poisson_ratio = self%plate%material%poisson_ratio()
      if (self%sphere%material%rigid) return
      if (self%sphere%data%deforms_as(self%plate%data)) then
         layer%share = 0.5_wp
      else if (self%sphere%material%elastic() .and. self%plate%material%elastic()) then
         sphere = self%sphere%material%glassy()*self%sphere%material%plane_strain_factor()
         plate = self%plate%material%glassy()*self%plate%material%plane_strain_factor()
         layer%share = sphere/(sphere + plate)
      else
         call raise(error, error_input, "the layer's share in the compliance must not change " &
            //'with time: expected one rigid body, two elastic ones or two of one material, ' &
            //"or waves = 'body'", about='base material')
      end if
   end subroutine describe_layer

   !> Update settings and solver
   subroutine update_solver(self, case, error)
      !> The problem, its impact built
      type(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: latest

      latest = case%latest_change([self%at%time_step, self%at%end_time, self%at%accuracy, &
         self%at%second_coefficient])
      if (self%solver_made_at /= latest) then
         self%settings%time_step = number_or_zero(case, self%at%time_step)
         self%settings%end_time = number_or_zero(case, self%at%end_time)
         self%settings%accuracy = number_or_zero(case, self%at%accuracy)
         self%settings%second_coefficient = 0.0_wp
         if (self%second_term) &
            self%settings%second_coefficient = case%number(self%at%second_coefficient)
      end if
      call check_settings(self%settings, self%impact, error)
      if (.not. allocated(error) .and. self%solver_made_at /= latest) then
         call new_solver(self%solver, self%settings, error)
         if (.not. allocated(error)) self%solver_made_at = latest
      end if
   end subroutine update_solver

   !> Half the thickness of the plate [m]; 0 if there is none
   pure function half_thickness(self, case) result(half)
      type(problem_t), intent(in) :: self
      type(case_t), intent(in) :: case
      real(wp) :: half

      half = number_or_zero(case, self%at%half_thickness)
      if (.not. half > 0.0_wp) half = 0.5_wp*number_or_zero(case, self%at%thickness)
   end function half_thickness

   !> Number at an address; 0 if there is none
   pure function number_or_zero(case, address) result(number)
      type(case_t), intent(in) :: case
      type(address_t), intent(in) :: address
      real(wp) :: number

      number = case%number(address)
      if (ieee_is_nan(number)) number = 0.0_wp
   end function number_or_zero

   !> Update a material
   subroutine update_body(body, case, error)
      !> The material, described
      type(body_t), intent(inout) :: body
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp), allocatable :: list(:)
      real(wp) :: number
      integer :: i, latest

      latest = max(case%latest_change(body%made_from), case%latest_change([body%temperature]))
      if (body%made_at == latest) return
      body%made_at = never
      body%data%temperature = number_or_zero(case, body%temperature)
      do i = 1, size(body%made_from)
         associate (address => body%made_from(i), key => catalogue(body%made_from(i)%row))
            if (key%value_kind == list_key) then
               call case%get('material', key%name, list, address%item)
               call body%data%set_list(key%name, list)
            else
               number = case%number(address)
               if (.not. ieee_is_nan(number)) call body%data%set(key%name, number)
            end if
         end associate
      end do
      call body%data%fit_points()
      call new_material(body%material, body%data, error)
      if (allocated(error)) then
         error%item = body%address%item
      else
         body%made_at = latest
      end if
   end subroutine update_body

end module vcor_case_problem
