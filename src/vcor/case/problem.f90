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
!> impact and solver. Their errors name arguments, `error%about`; `vcor_case_cause` finds their keys
!> and lines.
!>
!> Values are taken through `reading`, which records them: what is set and not read is refused. So a
!> value is read where it has an effect, and only there.
module vcor_case_problem
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_body, only : body_t, describe, update_body
   use vcor_case_case, only : address_t, case_t
   use vcor_case_cause, only : explain
   use vcor_case_mechanics, only : features_of_case, place_of_method, why_no_pair
   use vcor_case_reading, only : reading_t
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
   use vcor_solver, only : check_settings, new_solver, solve_impact, &
      solver_settings_t, solver_t
   use vcor_solver_features, only : features, of_body, of_ghost, of_second_term, unread, why_unread
   implicit none
   private

   public :: problem_t, problem_of_case, solve_case

   !> Number of no change: an object that has not been made, or could not
   integer, parameter :: never = -1

   !> Addresses of the numbers from which an impact is made
   type :: numbers_t
      type(address_t) :: velocity, drop_height, gravity, radius, diameter, mass, surface_radius
      !> Of the materials of sphere and plate
      type(address_t) :: density(2), yield_strength(2)
      type(address_t) :: half_thickness, thickness, half_angle, punch_radius
      type(address_t) :: profile_coefficient, profile_power
      type(address_t) :: extent
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
      !> Data for the measures of validity, in addition to the impact
      type(surroundings_t) :: surroundings
      !> What the impact reads of the case
      type(reading_t) :: reading
      !> Material of the sphere
      type(body_t), private :: sphere
      !> Material of the plate
      type(body_t), private :: plate
      !> Addresses of the numbers
      type(numbers_t), private :: at
      !> Radius of the sphere [m]; NaN for other bodies
      real(wp), private :: radius = 0.0_wp
      !> Half the thickness of the plate [m]; 0 if there is none
      real(wp), private :: half_thickness = 0.0_wp
      !> Shape of the striking body, as named in the case
      character(len=11), private :: shape = 'sphere'
      !> One of base_free, base_bonded and base_sliding
      integer, private :: base = base_free
      !> Waves of a thin plate, one of the `waves_*` constants
      integer, private :: waves = waves_relaxing
      !> Whether the surface was that of a second sphere when `mechanics` chose the waves
      logical, private :: is_pair = .false.
      !> Whether `mechanics` chose the waves
      logical, private :: is_chosen = .false.
      !> One of the `pair_*` constants
      integer, private :: pair = pair_eq1
      !> Its features, see `vcor_solver_features`
      logical, private :: has(size(features)) = .false.
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

      character(len=*), parameter :: bodies(*) = [character(len=6) :: 'sphere', 'plate']
      integer :: i, item

      if (min(case%material_of('sphere'), case%material_of('plate')) < 1) then
         call raise(error, error_input, 'the case is empty or not checked: expected read_case, ' &
            //'then validate, without an error')
         return
      end if
      self%at%velocity = case%address('impact', 'velocity')
      self%at%drop_height = case%address('impact', 'drop_height')
      self%at%gravity = case%address('impact', 'gravity')
      self%at%radius = case%address('sphere', 'radius')
      self%at%diameter = case%address('sphere', 'diameter')
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

      call self%reading%start(case)
      call describe(self%sphere, case, case%material_of('sphere'), self%reading)
      call describe(self%plate, case, case%material_of('plate'), self%reading)
      do i = 1, size(bodies)
         call self%reading%mark(case%address(bodies(i), 'material'))
         item = case%material_of(bodies(i))
         self%at%density(i) = case%address('material', 'density', item)
         self%at%yield_strength(i) = case%address('material', 'yield_strength', item)
      end do
      if (case%given('sphere', 'mass')) call self%reading%leave(self%at%density(1), &
         'sphere.mass gives the mass of the sphere')
      if (self%plate%data%model == 'rigid') call self%reading%leave(self%at%density(2), &
         'the plate is rigid and does not move')
      call choose_contact(self, case)
      call choose_plate(self, case)
      call choose_method(self, case)
      call self%update(case, error)
      if (allocated(error)) call explain(case, error)
   end subroutine problem_of_case

   !> Read the shape, the contact law and the rule for pairs
   subroutine choose_contact(self, case)
      !> The problem, its materials described
      type(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case

      character(len=:), allocatable :: text

      call self%reading%get(case, 'sphere', 'shape', text)
      self%shape = text
      call case%get('contact', 'law', text)
      self%impact%law%receding = text == 'receding'
      if (self%shape == 'punch') then
         ! a user who requests it gets an error
         self%impact%law%receding = self%impact%law%receding .and. case%given('contact', 'law')
         call self%reading%leave(case%address('contact', 'law'), &
            'the contact of a flat punch does not recede')
      else
         call self%reading%mark(case%address('contact', 'law'))
      end if
      if (why_no_pair(case) == '') then
         call self%reading%get(case, 'contact', 'pair', text)
         self%pair = merge(pair_series, pair_eq1, text == 'series')
      else
         call self%reading%leave(case%address('contact', 'pair'), why_no_pair(case))
      end if
      ! it chooses what is not given
      if (case%given('contact', 'law') .and. case%given('contact', 'pair') &
          .and. case%given('plate', 'waves')) then
         call self%reading%leave(case%address('contact', 'mechanics'), &
            'contact.law, contact.pair and plate.waves are all given')
      else
         call self%reading%mark(case%address('contact', 'mechanics'))
      end if
   end subroutine choose_contact

   !> Read the base of the plate and its waves: a rigid one has none
   subroutine choose_plate(self, case)
      !> The problem, its materials described
      type(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case

      character(len=*), parameter :: wave_names(*) = [character(len=10) :: 'none', 'constant', &
         'relaxing', 'frozen', 'hereditary', 'body']
      integer, parameter :: waves(*) = [waves_none, waves_constant, waves_relaxing, waves_frozen, &
         waves_hereditary, waves_none]
      character(len=*), parameter :: base_names(*) = [character(len=7) :: 'free', 'bonded', &
         'sliding']
      integer, parameter :: bases(*) = [base_free, base_bonded, base_sliding]
      character(len=*), parameter :: keys(*) = [character(len=14) :: 'base', 'waves', &
         'half_thickness', 'thickness', 'extent']
      character(len=:), allocatable :: text
      integer :: i

      if (self%plate%data%model == 'rigid') then
         self%waves = waves_none
         do i = 1, size(keys)
            call self%reading%leave(case%address('plate', keys(i)), &
               'the plate is rigid and does not move')
         end do
         self%at%extent = address_t()
         return
      end if
      call self%reading%get(case, 'plate', 'base', text)
      self%base = bases(findloc(base_names == text, .true., dim=1))
      call self%reading%get(case, 'plate', 'waves', text)
      self%waves = waves(findloc(wave_names == text, .true., dim=1))
      self%is_pair = case%has_second_sphere()
      call case%get('contact', 'mechanics', text)
      self%is_chosen = text == 'exact' .and. .not. case%given('plate', 'waves')
      call case%get('plate', 'waves', text)
      if (text == 'none') then
         call self%reading%leave(self%at%extent, &
            "with plate.waves = 'none' the plate does not move")
         self%at%extent = address_t()
      end if
   end subroutine choose_plate

   !> Read the method and what belongs to it
   subroutine choose_method(self, case)
      type(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case

      !> Keys that depend on the method
      character(len=*), parameter :: groups(*) = [character(len=6) :: 'impact', 'solver', &
         'solver', 'solver', 'solver', 'solver', 'solver', 'solver']
      character(len=*), parameter :: keys(*) = [character(len=25) :: 'gravity', 'scheme', 'form', &
         'quadrature', 'time_step', 'volterra_order', 'volterra_coefficient', &
         'continue_after_separation']
      character(len=:), allocatable :: text
      character(len=len(unread%reason)) :: reason
      integer :: i

      call self%reading%get(case, 'solver', 'method', text)
      self%settings%method = text
      call case%get('solver', 'scheme', text)
      self%settings%scheme = text
      call case%get('solver', 'form', text)
      self%settings%form = text
      call case%get('solver', 'quadrature', text)
      self%settings%quadrature = text
      self%has = features_of_case(case)
      self%settings%ghost = self%has(of_ghost)
      do i = 1, size(keys)
         reason = why_unread(trim(groups(i)), trim(keys(i)), place_of_method(case), self%has)
         if (reason == '') then
            call self%reading%mark(case%address(trim(groups(i)), trim(keys(i))))
         else
            call self%reading%leave(case%address(trim(groups(i)), trim(keys(i))), trim(reason))
         end if
      end do
   end subroutine choose_method

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

   !> Update the problem to the numbers of the case
   subroutine update(self, case, error)
      !> The problem of this case
      class(problem_t), intent(inout) :: self
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: velocity, gravity, height, mass, factor
      integer :: latest

      call update_body(self%sphere, case, self%reading, error)
      if (.not. allocated(error)) call update_body(self%plate, case, self%reading, error)
      if (allocated(error)) return
      self%radius = self%reading%number(case, self%at%radius)
      if (ieee_is_nan(self%radius)) &
         self%radius = 0.5_wp*self%reading%number(case, self%at%diameter)
      self%half_thickness = 0.0_wp
      if (.not. self%plate%material%rigid) then
         self%half_thickness = positive_or_zero(self%reading%number(case, self%at%half_thickness))
         if (.not. self%half_thickness > 0.0_wp) self%half_thickness = &
            0.5_wp*positive_or_zero(self%reading%number(case, self%at%thickness))
         call self%reading%mark(self%at%density(2))
      end if
      latest = max(self%sphere%made_at, self%plate%made_at, &
         case%latest_change([self%at%half_thickness, self%at%thickness]))
      if (self%contact_made_at /= latest) then
         self%contact_made_at = never
         call build_contact(self, error)
         if (allocated(error)) return
         self%contact_made_at = latest
      end if
      gravity = positive_or_zero(case%number(self%at%gravity))
      velocity = self%reading%number(case, self%at%velocity)
      height = self%reading%number(case, self%at%drop_height)
      if (ieee_is_nan(velocity)) &
         velocity = sqrt(2.0_wp*height*merge(gravity, standard_gravity, gravity > 0.0_wp))
      mass = self%reading%number(case, self%at%mass)
      if (ieee_is_nan(mass)) then
         mass = 4.0_wp/3.0_wp*pi*self%radius**3*self%sphere%material%density()
         call self%reading%mark(self%at%density(1))
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
      integer :: i

      self%surroundings%radius = self%radius
      self%surroundings%is_sphere = case%number(self%at%surface_radius) > 0.0_wp
      self%surroundings%thickness = none
      if (self%half_thickness > 0.0_wp) &
         self%surroundings%thickness = 2.0_wp*self%half_thickness
      self%surroundings%on_base = self%base /= base_free .and. .not. self%plate%material%rigid
      self%surroundings%is_true = self%shape == 'true_sphere'
      self%surroundings%has_body = self%impact%face%has_waves
      self%surroundings%extent = self%reading%number(case, self%at%extent)
      self%surroundings%drops = .not. ieee_is_nan(case%number(self%at%drop_height))
      self%surroundings%is_weighed = .not. ieee_is_nan(case%number(self%at%gravity))
      self%surroundings%gravity = merge(self%impact%gravity, standard_gravity, &
         self%impact%gravity > 0.0_wp)
      do i = 1, size(yield_strength)
         yield_strength(i) = self%reading%number(case, self%at%yield_strength(i))
      end do
      if (ieee_is_nan(yield_strength(1))) yield_strength(1) = yield_strength(2)
      if (.not. any(ieee_is_nan(yield_strength))) yield_strength(1) = minval(yield_strength)
      self%surroundings%yield_strength = yield_strength(1)
      self%surroundings%density = self%plate%material%density()
      self%surroundings%base = self%base
      if (self%base == base_free .and. .not. self%half_thickness > 0.0_wp) &
         self%surroundings%base = base_half_space
   end subroutine update_surroundings

   !> Build contact modulus, plate and face of the impact
   subroutine build_contact(self, error)
      !> The problem, its materials built
      type(problem_t), intent(inout) :: self
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      call new_contact_modulus(self%impact%modulus, self%sphere%material, self%plate%material, &
         self%sphere%data%deforms_as(self%plate%data), error, self%pair)
      if (.not. allocated(error)) call new_plate(self%impact%plate, self%plate%material, &
         self%half_thickness, self%waves, error)
      if (.not. allocated(error)) call build_face(self, error)
      if (.not. allocated(error)) return
      if (.not. allocated(error%about)) return
      if (error%about == 'density') error%item = self%plate%address%item
   end subroutine build_contact

   !> Build the face of the impact if the coupled contact is to be solved. A rigid plate has no
   !> waves
   subroutine build_face(self, error)
      !> The problem, its materials built
      type(problem_t), intent(inout) :: self
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: base
      logical :: has_waves

      self%impact%face = face_t()
      has_waves = self%has(of_body)
      if (.not. (has_waves .or. self%settings%method == 'coupled')) return
      base = self%base
      ! without waves a wide free plate is as stiff as a half space
      if (base == base_free .and. .not. (has_waves .and. self%half_thickness > 0.0_wp)) &
         base = base_half_space
      call new_face(self%impact%face, self%plate%material, self%sphere%material, base, &
         2.0_wp*self%half_thickness, has_waves, error)
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

      surface_radius = self%reading%number(case, self%at%surface_radius)
      factor = 0.0_wp
      exponent = law%start_exponent
      ! a sweep may pass from a second sphere to a seat
      if (self%is_chosen .and. (surface_radius > 0.0_wp .neqv. self%is_pair)) then
         call raise(error, error_input, "mechanics = 'exact' leaves waves = 'none' with a second " &
            //"sphere, and solves them in a flat or concave surface: expected one sign, or " &
            //'plate.waves', about='surface_radius')
         return
      end if
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
         factor = cone_factor(self%reading%number(case, self%at%half_angle))
      case ('punch')
         exponent = 1.0_wp
         factor = punch_factor(self%reading%number(case, self%at%punch_radius))
      case ('power')
         exponent = 1.0_wp + 1.0_wp/self%reading%number(case, self%at%profile_power)
         factor = profile_factor(self%reading%number(case, self%at%profile_coefficient), &
            self%reading%number(case, self%at%profile_power))
      case default
         call sphere_factor(self%radius, surface_radius, factor, error)
      end select
      if (.not. allocated(error)) &
         call new_contact_law(law, exponent, self%impact%law%receding, error)
      if (allocated(error)) return
      if (abs(law%start_exponent - self%impact%law%start_exponent) > 0.0_wp) self%impact%law = law
      profile%power = 0.0_wp
      if (exponent > 1.0_wp) profile%power = 1.0_wp/(exponent - 1.0_wp)
      if (self%shape == 'true_sphere') profile%radius = self%radius
      call describe_layer(self, layer, error)
      if (.not. allocated(error)) call lay(self%impact%law, layer, profile, factor, error)
   end subroutine set_shape

   !> Layer on a base, for the contact law: a half space if there is none, or its waves are solved
   subroutine describe_layer(self, layer, error)
      !> The problem, its materials built
      type(problem_t), intent(in) :: self
      type(layer_t), intent(out) :: layer
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: sphere, plate

      if (self%base == base_free .or. self%plate%material%rigid) return
      layer%thickness = 2.0_wp*self%half_thickness
      if (.not. layer%thickness > 0.0_wp) then
         call raise(error, error_input, 'a layer on a base needs its thickness [m], or ' &
            //'half_thickness', about='base thickness')
      else if (self%waves /= waves_none) then
         call raise(error, error_input, 'the waves of a thin plate are those of a free one, ' &
            //"expected waves = 'none' or 'body' with a base", about='waves base')
      end if
      if (allocated(error) .or. self%has(of_body) .or. self%settings%method == 'coupled') return
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
         call raise(error, error_input, 'of a layer that relaxes and a ball that deforms too, ' &
            //"expected model = 'rigid' of the ball, if it is by far the stiffer one, or one " &
            //"material of both, or waves = 'body'", about='base material')
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
         self%settings%time_step = positive_or_zero(case%number(self%at%time_step))
         self%settings%end_time = positive_or_zero(self%reading%number(case, self%at%end_time))
         self%settings%accuracy = positive_or_zero(self%reading%number(case, self%at%accuracy))
         self%settings%second_coefficient = 0.0_wp
         if (self%has(of_second_term)) &
            self%settings%second_coefficient = case%number(self%at%second_coefficient)
      end if
      call check_settings(self%settings, self%impact, error)
      if (.not. allocated(error) .and. self%solver_made_at /= latest) then
         call new_solver(self%solver, self%settings, error)
         if (.not. allocated(error)) self%solver_made_at = latest
      end if
   end subroutine update_solver

   !> A positive number; 0 if there is none
   pure function positive_or_zero(number) result(positive)
      !> NaN if there is none
      real(wp), intent(in) :: number
      real(wp) :: positive

      positive = number
      if (ieee_is_nan(number)) positive = 0.0_wp
   end function positive_or_zero

end module vcor_case_problem
