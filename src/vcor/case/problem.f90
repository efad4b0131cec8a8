!> Impact and solver of given inputs
!>
!> `build` makes what the inputs describe. It keeps the inputs that it has built from, and rebuilds
!> what depends on those that differ:
!>
!>  - New velocity: only the motion is set, as at every point; materials, contact and solver remain.
!>  - New temperature: materials with a shift are rebuilt, without fitting points of data again, and
!>    then the contact.
!>  - New number of the sphere's material: the same for the sphere only.
!>
!> Threads of a sweep call `build`, so it calls no function with a result of deferred length, since
!> gfortran 12 keeps that length in static storage.
!>
!> Rules for numbers that depend on each other are in the constructors of materials, contact, plate,
!> impact and solver. Their errors name arguments, `error%about`; `vcor_case_cause` finds their keys
!> and lines.
module vcor_case_problem
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_case_case, only : case_t
   use vcor_case_cause, only : explain
   use vcor_case_inputs, only : inputs_t, is_same, of_plate, of_sphere, of_target, &
      positive_or_zero, target_beam, target_block, target_none, target_plate, waves_body
   use vcor_case_structure, only : build_structure, highest_of_list
   use vcor_case_reader, only : read_inputs
   use vcor_case_reading, only : reading_t
   use vcor_error, only : error_input, error_numerical, error_t, raise
   use vcor_impact_contact, only : new_contact_modulus
   use vcor_impact_outcome, only : none, outcome_t
   use vcor_impact_law, only : contact_law_t, new_contact_law
   use vcor_impact_face, only : base_free, base_half_space, face_t, new_face
   use vcor_impact_layer_law, only : layer_t, lay, profile_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_shape, only : describe_shape, shape_sphere, shape_true_sphere
   use vcor_impact_structure, only : structure_t
   use vcor_impact_target, only : new_plate, waves_none
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_impact_validity, only : assess, forgotten_base, surroundings_t
   use vcor_kinds, only : standard_gravity, wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_solver, only : check_settings, new_solver, solve_impact, solver_t
   use vcor_solver_features, only : features, of_structure, of_thin_plate, refuse_features
   implicit none
   private

   public :: problem_t, problem_of_case, solve_case

   !> Impact and solver
   type :: problem_t
      !> The impact
      type(impact_t) :: impact
      !> The solver
      class(solver_t), allocatable :: solver
      !> Data for the measures of validity, in addition to the impact
      type(surroundings_t) :: surroundings
      !> What the inputs take of the case, if they are those of one
      type(reading_t) :: reading
      !> The inputs of this case
      type(inputs_t) :: inputs
      !> The inputs from which materials, contact, law and solver have been built
      type(inputs_t), private :: built
      !> Material of the sphere
      class(material_t), allocatable, private :: sphere
      !> Material of the plate
      class(material_t), allocatable, private :: plate
      !> Material of a structure, if that has one
      class(material_t), allocatable, private :: carrier
      !> Whether modulus, plate and face are those of the inputs
      logical, private :: has_contact = .false.
   contains
      procedure :: build, solve
   end type problem_t

contains

   !> Build the impact and the solver of a case; swept keys have their values in the case
   subroutine problem_of_case(self, case, error)
      type(problem_t), intent(out) :: self
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Error of code `error_input` with the place of its cause, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(inputs_t) :: inputs

      call read_inputs(case, inputs, self%reading, error)
      if (allocated(error)) return
      self%inputs = inputs
      call self%build(inputs, error)
      if (allocated(error)) call explain(case, error)
   end subroutine problem_of_case

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

   !> Build what the inputs describe, as far as they are new
   subroutine build(self, inputs, error)
      class(problem_t), intent(inout) :: self
      type(inputs_t), intent(in) :: inputs
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(layer_t) :: layer
      type(profile_t) :: profile
      real(wp) :: mass, factor
      logical :: is_new(3)

      if (allocated(self%solver) .and. .not. is_same(self%built%settings, inputs%settings)) &
         deallocate (self%solver)
      call build_material(self%sphere, self%built%material(of_sphere), &
         inputs%material(of_sphere), is_new(of_sphere), error)
      if (allocated(error)) error%item = inputs%item(of_sphere)
      if (allocated(error)) return
      call build_material(self%plate, self%built%material(of_plate), inputs%material(of_plate), &
         is_new(of_plate), error)
      if (allocated(error)) error%item = inputs%item(of_plate)
      if (any(is_new(:of_plate)) .or. .not. inputs%is_one_contact(self%built)) &
         self%has_contact = .false.
      if (allocated(error)) return
      if (.not. self%has_contact) call build_contact(self, inputs, error)
      if (allocated(error)) return
      mass = inputs%striking_mass(self%sphere%density())
      if (ieee_is_nan(inputs%mass) .and. .not. self%sphere%density() > 0.0_wp) then
         call raise(error, error_input, 'the mass of the sphere follows from it; or give ' &
            //'mass in &sphere', about='density')
         error%item = inputs%item(of_sphere)
         return
      end if
      call set_shape(self, inputs, layer, profile, factor, error)
      if (.not. allocated(error)) call self%impact%launch(inputs%approach_velocity(), mass, &
         factor, error, positive_or_zero(inputs%gravity))
      if (.not. allocated(error)) call lay(self%impact%law, layer, profile, factor, error, &
         deepest_of(self%impact, inputs))
      if (.not. allocated(error)) call set_structure(self, inputs, error)
      if (allocated(error)) return
      call set_surroundings(self, inputs)
      call check_settings(inputs%settings, self%impact, error)
      if (allocated(error)) return
      if (allocated(self%solver)) return
      call new_solver(self%solver, inputs%settings, error)
      if (.not. allocated(error)) self%built%settings = inputs%settings
   end subroutine build

   !> Set the structure that carries the struck surface: the modes that count follow from the time
   !> scale of the contact
   subroutine set_structure(self, inputs, error)
      !> The problem, its impact launched
      type(problem_t), intent(inout) :: self
      type(inputs_t), intent(in) :: inputs
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(structure_t) :: none_of_it
      logical :: is_new

      self%impact%target%structure = none_of_it
      self%impact%face%structure = none_of_it
      if (inputs%target%body == target_none) return
      if (self%impact%face%has_waves .and. any(inputs%target%body == [target_plate, &
          target_beam])) then
         call raise(error, error_input, 'the modes of this body hold the bending that waves = ' &
            //"'body' holds: expected waves = 'none', or a block, a rod or a list of modes", &
            about='waves body')
      else if (self%impact%face%base == base_free .and. self%impact%face%has_waves) then
         call raise(error, error_input, 'a free plate of this thickness moves beside the ' &
            //'structure: expected a base, a face without thickness (a half space), or ' &
            //"waves = 'none'", about='thickness half_thickness waves')
      end if
      if (allocated(error)) return
      if (inputs%item(of_target) > 0) call build_material(self%carrier, &
         self%built%material(of_target), inputs%material(of_target), is_new, error)
      if (allocated(error)) error%item = inputs%item(of_target)
      if (allocated(error)) return
      call build_structure(self%impact%target%structure, &
         inputs, self%impact, self%carrier, error)
      self%impact%face%structure = self%impact%target%structure
      if (.not. allocated(error)) return
      if (.not. allocated(error%about)) return
      if (error%about == 'density') error%item = inputs%item(of_target)
   end subroutine set_structure

   !> Build a material if it is new
   subroutine build_material(material, known, data, is_new, error)
      !> The material; unallocated if there is none yet
      class(material_t), allocatable, intent(inout) :: material
      !> The data that it has been built from; on return the new ones
      type(material_data_t), intent(inout) :: known
      type(material_data_t), intent(in) :: data
      !> Whether it was
      logical, intent(out) :: is_new
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      is_new = .not. allocated(material)
      if (.not. is_new) is_new = .not. known%is_same_as(data)
      if (.not. is_new) return
      known = data
      call new_material(material, known, error)
   end subroutine build_material

   !> Build contact modulus, plate and face of the impact
   subroutine build_contact(self, inputs, error)
      !> The problem, its materials built
      type(problem_t), intent(inout) :: self
      type(inputs_t), intent(in) :: inputs
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      logical :: has(size(features))

      ! before such waves ask for a thickness
      has = .false.
      has(of_structure) = inputs%target%body /= target_none
      has(of_thin_plate) = all(inputs%waves /= [waves_none, waves_body])
      call refuse_features(has, error)
      if (.not. allocated(error)) call new_contact_modulus(self%impact%modulus, self%sphere, &
         self%plate, inputs%material(of_sphere)%deforms_as(inputs%material(of_plate)), error, &
         inputs%pair)
      if (.not. allocated(error)) call new_plate(self%impact%target, self%plate, &
         inputs%half_thickness, merge(waves_none, inputs%waves, inputs%waves == waves_body), error)
      if (.not. allocated(error)) call build_face(self, inputs, error)
      if (allocated(error)) then
         if (.not. allocated(error%about)) return
         if (error%about == 'density') error%item = inputs%item(of_plate)
         return
      end if
      self%built%pair = inputs%pair
      self%built%waves = inputs%waves
      self%built%base = inputs%base
      self%built%half_thickness = inputs%half_thickness
      self%built%settings%method = inputs%settings%method
      self%has_contact = .true.
   end subroutine build_contact

   !> Build the face of the impact if the coupled contact is to be solved. A rigid plate has no
   !> waves
   subroutine build_face(self, inputs, error)
      !> The problem, its materials built
      type(problem_t), intent(inout) :: self
      type(inputs_t), intent(in) :: inputs
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: base
      logical :: has_waves

      self%impact%face = face_t()
      has_waves = inputs%waves == waves_body
      if (.not. (has_waves .or. inputs%settings%method == 'coupled')) return
      base = inputs%base
      ! without waves a wide free plate is as stiff as a half space
      if (base == base_free .and. .not. (has_waves .and. inputs%half_thickness > 0.0_wp)) &
         base = base_half_space
      call new_face(self%impact%face, self%plate, self%sphere, base, &
         2.0_wp*inputs%half_thickness, has_waves, error)
   end subroutine build_face

   !> Indentation up to which the contact law is needed
   pure function deepest_of(impact, inputs) result(s)
      !> The impact, launched
      type(impact_t), intent(in) :: impact
      type(inputs_t), intent(in) :: inputs
      !> Indentation [m]; huge: no bound is known
      real(wp) :: s

      s = huge(1.0_wp)
      ! what moves may be struck again, and the motion after separation has no bound
      if (inputs%target%body /= target_none .or. inputs%settings%ghost) return
      ! the force of a second term may be less
      if (.not. abs(inputs%settings%second_coefficient) > 0.0_wp) s = impact%deepest()
   end function deepest_of

   !> Set the power of the contact law of the shape of the striking body, and describe what it is
   !> further
   subroutine set_shape(self, inputs, layer, profile, factor, error)
      !> The problem, its materials built
      type(problem_t), intent(inout) :: self
      type(inputs_t), intent(in) :: inputs
      !> What the body presses, and its profile
      type(layer_t), intent(out) :: layer
      type(profile_t), intent(out) :: profile
      !> Factor K of the shape [m^(2-n)]
      real(wp), intent(out) :: factor
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(contact_law_t) :: law
      real(wp) :: exponent

      factor = 0.0_wp
      ! a sweep may pass from a second sphere to a seat
      if (inputs%waves_are_chosen .and. (inputs%surface_radius > 0.0_wp &
          .eqv. inputs%waves == waves_body)) then
         call raise(error, error_input, "mechanics = 'exact' leaves waves = 'none' with a second " &
            //"sphere, and solves them in a flat or concave surface: expected one sign, or " &
            //'plate.waves', about='surface_radius')
         return
      end if
      if (abs(inputs%surface_radius) > 0.0_wp) then
         if (inputs%shape /= shape_sphere) call raise(error, error_input, &
            "only shape = 'sphere' meets a curved surface", about='surface_radius shape')
         if (inputs%base /= base_free) call raise(error, error_input, 'a layer on a base is flat', &
            about='surface_radius base')
         if (allocated(error)) return
      end if
      call describe_shape(inputs%shape, inputs%radius, inputs%surface_radius, &
         inputs%shape_numbers, exponent, factor, error)
      if (.not. allocated(error)) call new_contact_law(law, exponent, inputs%receding, error)
      if (.not. allocated(error)) call describe_layer(self, inputs, layer, error)
      if (allocated(error)) return
      ! a table of the law stays as long as it is for the same body and kind of layer
      if (abs(law%start_exponent - self%impact%law%start_exponent) > 0.0_wp &
          .or. self%built%shape /= inputs%shape &
          .or. (self%impact%law%is_of_layer() .neqv. layer%base /= base_half_space)) then
         self%impact%law = law
         self%built%shape = inputs%shape
      end if
      self%impact%law%receding = inputs%receding
      profile%power = 0.0_wp
      if (exponent > 1.0_wp) profile%power = 1.0_wp/(exponent - 1.0_wp)
      if (inputs%shape == shape_true_sphere) profile%radius = inputs%radius
   end subroutine set_shape

   !> Layer on a base, for the contact law: a half space if there is none, or its waves are solved
   subroutine describe_layer(self, inputs, layer, error)
      !> The problem, its materials built
      type(problem_t), intent(in) :: self
      type(inputs_t), intent(in) :: inputs
      type(layer_t), intent(out) :: layer
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: sphere, plate

      if (inputs%base == base_free .or. self%plate%rigid) return
      layer%thickness = 2.0_wp*inputs%half_thickness
      if (.not. layer%thickness > 0.0_wp) then
         call raise(error, error_input, 'a layer on a base needs its thickness [m], or ' &
            //'half_thickness', about='base thickness')
      else if (all(inputs%waves /= [waves_none, waves_body])) then
         call raise(error, error_input, 'the waves of a thin plate are those of a free one, ' &
            //"expected waves = 'none' or 'body' with a base", about='waves base')
      end if
      if (allocated(error) .or. inputs%waves == waves_body) return
      if (inputs%settings%method == 'coupled') return
      layer%base = inputs%base
      layer%poisson_ratio = self%plate%poisson_ratio()
      if (self%sphere%rigid) return
      if (inputs%material(of_sphere)%deforms_as(inputs%material(of_plate))) then
         layer%share = 0.5_wp
      else if (self%sphere%elastic() .and. self%plate%elastic()) then
         sphere = self%sphere%glassy()*self%sphere%plane_strain_factor()
         plate = self%plate%glassy()*self%plate%plane_strain_factor()
         layer%share = sphere/(sphere + plate)
      else
         call raise(error, error_input, 'of a ball and a layer that both deform, one of which ' &
            //"relaxes, expected model = 'rigid' of the ball, if it is by far the stiffer one, " &
            //"or one material of both, or waves = 'body'", about='base material')
      end if
   end subroutine describe_layer

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
      if (allocated(error)) then
         if (error%code == error_numerical .and. self%surroundings%has_body) then
            if (self%surroundings%is_lighter(self%impact)) &
               error%message = error%message//'; '//forgotten_base
         end if
         return
      end if
      if (outcome%status /= contact_separated) return
      if (self%surroundings%is_panel .or. self%surroundings%is_beam) then
         call assess(outcome, self%impact, trajectory, self%surroundings, self%sphere, self%plate, &
            self%carrier)
      else
         call assess(outcome, self%impact, trajectory, self%surroundings, self%sphere, self%plate, &
            self%plate)
      end if
   end subroutine solve

   !> Set the data for the measures of validity
   subroutine set_surroundings(self, inputs)
      !> The problem, its impact built
      type(problem_t), intent(inout) :: self
      type(inputs_t), intent(in) :: inputs

      real(wp) :: yield_strength(2)

      associate (around => self%surroundings)
         around%radius = inputs%radius
         around%is_sphere = inputs%surface_radius > 0.0_wp
         around%thickness = none
         if (inputs%half_thickness > 0.0_wp) around%thickness = 2.0_wp*inputs%half_thickness
         around%on_base = inputs%base /= base_free
         around%is_true = inputs%shape == shape_true_sphere
         around%has_body = self%impact%face%has_waves
         around%extent = inputs%extent
         around%drops = .not. ieee_is_nan(inputs%drop_height)
         around%is_weighed = .not. ieee_is_nan(inputs%gravity)
         around%gravity = merge(self%impact%gravity, standard_gravity, self%impact%gravity > 0.0_wp)
         yield_strength = inputs%yield_strength
         if (ieee_is_nan(yield_strength(1))) yield_strength(1) = yield_strength(2)
         if (.not. any(ieee_is_nan(yield_strength))) yield_strength(1) = minval(yield_strength)
         around%yield_strength = yield_strength(1)
         around%is_panel = inputs%target%body == target_plate
         around%is_beam = inputs%target%body == target_beam
         if ((around%is_panel .or. around%is_beam) .and. .not. around%on_base) &
            around%thickness = inputs%target_thickness()
         around%highest_frequency = highest_of_list(inputs%target)
         around%density = self%plate%density()
         around%block_mass = none
         if (inputs%target%body == target_block .and. around%has_body .and. .not. around%on_base) &
            around%block_mass = inputs%target%mass
         around%base = inputs%base
         if (inputs%base == base_free .and. .not. (inputs%half_thickness > 0.0_wp &
             .or. around%is_panel)) around%base = base_half_space
      end associate
   end subroutine set_surroundings

end module vcor_case_problem
