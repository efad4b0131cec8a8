!> Measures of how well an impact meets the assumptions of the model, and their assessment
!>
!> Each measure is a column of the summary. Those with a threshold show whether the contact is
!> Hertzian, on a half space, in a thin and wide plate, and without losses that are not computed.
module vcor_impact_validity
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_impact_deviation, only : face_losses, face_losses_t, predict
   use vcor_impact_face, only : base_free, base_half_space, base_sliding
   use vcor_impact_mobility, only : mobility_t, take_over
   use vcor_impact_outcome, only : none, outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_plate, trajectory_t
   use vcor_kinds, only : pi, standard_gravity, wp
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: surroundings_t, assess, judge
   public :: forgotten_base
   public :: threshold_t, thresholds, judged, level_of
   public :: levels, level_none, level_good, level_caution, level_outside

   !> Cause of an impact without a result if `is_lighter`
   character(len=*), parameter :: forgotten_base = 'the plate is free on both sides and lighter ' &
      //'than the ball; on a floor give plate.base'
   !> Levels of validity: the impact has no result
   integer, parameter :: level_none = 0
   !> No measure exceeds a threshold: cor_sphere within 2 % or 0.01 of exact mechanics
   integer, parameter :: level_good = 1
   !> A measure exceeds its first threshold: cor_sphere within 10 % or 0.05 of exact mechanics
   integer, parameter :: level_caution = 2
   !> A measure exceeds its second threshold: the model does not describe the impact
   integer, parameter :: level_outside = 3
   !> Names of the levels
   character(len=*), parameter :: levels(level_none:level_outside) = [character(len=7) :: &
      'none', 'good', 'caution', 'outside']

   !> Thresholds of one measure
   type :: threshold_t
      !> Column of the measure
      character(len=17) :: measure
      !> Value that calls for caution
      real(wp) :: caution
      !> Value at which the model does not hold
      real(wp) :: outside
   end type threshold_t

   !> Thresholds of the values of `judged`, in the same order; derivations are in docs/validity.md
   type(threshold_t), parameter :: thresholds(*) = [ &
      ! Hertz' force against Sneddon 1965, doi:10.1016/0020-7225(65)90019-4, for a rigid sphere: 1.6
      ! % too high at 0.4, 6.9 % at 0.8, 10 % at 0.95; or sphere_weight*sphere_ratio, if larger
      threshold_t('contact_ratio', 0.4_wp, 0.8_wp), &
      ! the gap between sphere and base is smaller by half the indentation on average, and the
      ! stiffness of a thin incompressible layer goes with its third power: the force is up to 15 %
      ! too small at 0.1, 50 % at 0.3, times the share that the base adds to it
      threshold_t('layer_strain', 0.1_wp, 0.3_wp), &
      ! over the extent: an edge at needed_extent returns the wave at t0; energy of the waves in a
      ! plate hit at its centre: 0.4 % off at 0.6, 4 % at 1, 25 % at 1.25
      threshold_t('needed_extent', 0.6_wp, 1.0_wp), &
      ! stretching increases the bending stiffness by 0.445 times its square
      threshold_t('deflection_ratio', 0.3_wp, 1.0_wp), &
      ! its inverse: without the modes that a list leaves out e errs by 1e-2 at 3 and 2.3e-3 at 10,
      ! with their flexibility by 1.7e-3 and 2e-5, on a square plate of inelasticity 0.2
      threshold_t('highest_mode', 0.1_wp, 0.33333_wp), &
      ! waves are back from the other side of the block while the contact lasts; it is never outside
      threshold_t('block_reach', 1.0_wp, 1.0e9_wp), &
      ! each further contact multiplies the effect of damping and phase; it is never outside
      threshold_t('contacts', 2.0_wp, 1.0e9_wp), &
      ! the weight divided by the force that reverses the motion
      threshold_t('weight_ratio', 0.01_wp, 0.1_wp), &
      ! or its inverse, the larger: a shell bends, which is no Hertz contact, and is
      ! never outside: a pendulum is heavier than its ball
      threshold_t('mass_ratio', 2.0_wp, 1.0e9_wp), &
      ! over the yield strength: first yield, and full plasticity of the contact, Johnson, Contact
      ! Mechanics (1985), doi:10.1017/CBO9781139171731, sections 6.1 and 6.2
      threshold_t('mean_pressure', 1.07_wp, 2.8_wp), &
      ! the part of the force that a contact without adhesion cannot have, if all of it pulled
      threshold_t('axis_tension', 0.02_wp, 0.1_wp), &
      ! over the larger of cor_sphere and 0.5: caution above 2 % of cor_sphere or 0.01, the larger,
      ! outside above 10 % or 0.05; what it says is measured by benchmarks/verdicts.py
      threshold_t('cor_deviation', 0.02_wp, 0.1_wp), &
      ! `gains_energy`, a contradiction: huge if so, which outweighs all others
      threshold_t('energy_loss', 1.0_wp, 1.0_wp)]

   !> Factor of `sphere_ratio` for the thresholds of contact_ratio. A deformable sphere is not a
   !> half space: its indentation is smaller by 0.5 a/r, so the contact is 4 % shorter at a/r = 0.13
   !> and 10 % at 0.27, as on a plate of thickness_ratio 0.1 and 0.3
   real(wp), parameter :: sphere_weight = 3.0_wp

   !> Properties outside the impact that the measures need; NaN if unknown
   type :: surroundings_t
      !> Radius of the sphere [m]
      real(wp) :: radius = none
      !> Whether the second body is a sphere, not a half space
      logical :: is_sphere = .false.
      !> Thickness of the plate, 2h [m]
      real(wp) :: thickness = none
      !> Distance from the contact to the nearest edge of the plate [m]
      real(wp) :: extent = none
      !> Yield strength, the smaller of the two bodies' [Pa]
      real(wp) :: yield_strength = none
      !> Whether the plate is a layer on a rigid base
      logical :: on_base = .false.
      !> Whether the sphere is not taken as a paraboloid
      logical :: is_true = .false.
      !> Whether the waves are those of the plate as it is, of any thickness: what neglects them, or
      !> takes the plate as thin or as a half space, is not judged then
      logical :: has_body = .false.
      !> Whether the sphere is dropped from a given height, and gravity where there is any [m/s2]
      logical :: drops = .false.
      real(wp) :: gravity = standard_gravity
      !> Whether a gravity is given, also 0: the weight that acts along the impact is known
      logical :: is_weighed = .false.
      !> Whether the face is that of a plate, or of a beam, with edges
      logical :: is_panel = .false., is_beam = .false.
      !> Highest frequency of a list of modes without the flexibility of those left out [rad/s]
      real(wp) :: highest_frequency = none
      !> Mass of a block whose face is a half space with waves [kg]
      real(wp) :: block_mass = none
      !> One of the `base_*` constants of `vcor_impact_face`: what is below the face
      integer :: base = base_half_space
      !> Response of the face, as far as impacts have needed it
      type(mobility_t), private :: mobility
      !> Density of the plate [kg/m3], 0 if unknown
      real(wp) :: density = 0.0_wp
   contains
      procedure :: is_lighter
      procedure :: learn_from
   end type surroundings_t

contains

   !> Whether the plate is free on both sides, moves, and is lighter than the ball: what lies in the
   !> shadow of the ball
   pure function is_lighter(self, impact)
      class(surroundings_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      logical :: is_lighter

      is_lighter = self%base == base_free .and. (impact%target%moves() .or. self%has_body) &
         .and. .not. (ieee_is_nan(self%radius) .or. ieee_is_nan(self%thickness))
      if (is_lighter) is_lighter = pi*self%radius**2*self%thickness*self%density < impact%mass
   end function is_lighter

   !> Take over what another has learned of the response of the face
   pure subroutine learn_from(self, other)
      class(surroundings_t), intent(inout) :: self
      type(surroundings_t), intent(in) :: other

      call take_over(self%mobility, other%mobility)
   end subroutine learn_from

   !> Set and judge the measures
   pure subroutine assess(outcome, impact, trajectory, around, sphere, plate, carrier)
      !> Outcome of a separation; on return all measures are set
      type(outcome_t), intent(inout) :: outcome
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      !> Around it; its table of the face grows
      type(surroundings_t), intent(inout) :: around
      class(material_t), intent(in) :: sphere
      class(material_t), intent(in) :: plate
      !> Material of the plate or beam with edges that carries the face; that of the plate if there
      !> is none
      class(material_t), intent(in) :: carrier

      complex(wp) :: modulus, plate_modulus
      real(wp) :: hertz_radius, frequency, share, force_radius, storage

      frequency = pi/outcome%contact_time
      if (around%drops .and. outcome%cor_sphere >= 0.0_wp) outcome%rebound_height = &
         outcome%resilience*(impact%velocity*(impact%velocity/(2.0_wp*around%gravity)))
      if (allocated(trajectory%radius)) then
         outcome%contact_radius = maxval(trajectory%radius(0:trajectory%last))
         force_radius = trajectory%radius_at(outcome%time_of_max_force)
      else
         ! the force is largest before the contact recedes
         outcome%contact_radius = impact%contact_radius(outcome%max_indentation)
         force_radius = impact%contact_radius( &
            trajectory%indentation_at(outcome%time_of_max_force))
      end if
      outcome%weight_ratio = impact%mass*around%gravity/outcome%max_force
      outcome%mean_pressure = outcome%max_force/(pi*force_radius**2)
      if (allocated(trajectory%radius)) outcome%axis_tension = &
         trajectory%tension/outcome%mean_pressure
      modulus = impact%modulus%dynamic_modulus(frequency)
      outcome%peak_loss_tangent = aimag(modulus)/real(modulus, wp)
      outcome%peak_storage_modulus = real(modulus, wp)
      plate_modulus = 0.0_wp
      if (.not. plate%rigid) plate_modulus = plate%complex_modulus(cmplx(0.0_wp, frequency, wp))
      share = plate_share(sphere, plate, plate_modulus, frequency)
      outcome%thickness_ratio = outcome%contact_radius/around%thickness*share
      if (around%on_base) then
         outcome%layer_ratio = outcome%contact_radius/around%thickness
         outcome%layer_strain = outcome%max_indentation/around%thickness*share
         ! with its waves the layer has no static law
         if (impact%law%is_of_layer()) &
            outcome%layer_stiffening = impact%law%stiffening(outcome%max_indentation)
      end if
      ! other shapes have no radius
      if (.not. ieee_is_nan(around%radius)) then
         ! two spheres have the reduced mass
         if (.not. around%is_sphere .and. sphere%density() > 0.0_wp) outcome%mass_ratio = &
            impact%mass/(4.0_wp/3.0_wp*pi*around%radius**3*sphere%density())
         hertz_radius = (0.75_wp*impact%factor)**2
         outcome%contact_ratio = outcome%contact_radius/min(hertz_radius, around%radius)
         outcome%sphere_ratio = outcome%contact_radius*((1.0_wp - share)/around%radius &
            + share*max(1.0_wp/hertz_radius - 1.0_wp/around%radius, 0.0_wp))
      end if
      storage = real(plate_modulus, wp)
      if (around%is_panel .or. around%is_beam) storage = real(carrier%complex_modulus( &
         cmplx(0.0_wp, frequency, wp)), wp)
      call assess_plate(outcome, impact, trajectory, around, carrier, storage, frequency)
      call compare_with_exact(outcome, impact, around, sphere, plate, carrier, modulus, &
         plate_modulus)
      outcome%highest_mode = around%highest_frequency*outcome%contact_time/pi
      if (around%density > 0.0_wp) outcome%block_reach = outcome%needed_extent &
         /(around%block_mass/around%density)**(1.0_wp/3.0_wp)
      call judge(outcome, around)
   end subroutine assess

   !> Set the measures of what exact mechanics would change
   pure subroutine compare_with_exact(outcome, impact, around, sphere, plate, carrier, modulus, &
                                      plate_modulus)
      type(outcome_t), intent(inout) :: outcome
      type(impact_t), intent(in) :: impact
      type(surroundings_t), intent(inout) :: around
      class(material_t), intent(in) :: sphere
      class(material_t), intent(in) :: plate, carrier
      !> Moduli of contact and plate at i pi/t0 [Pa]
      complex(wp), intent(in) :: modulus, plate_modulus

      type(face_losses_t) :: losses

      outcome%cor_deviation = 0.0_wp
      if (around%has_body) then
         outcome%wave_loss = 0.0_wp
      else if (around%is_beam .or. around%is_panel .and. around%on_base) then
         ! the face of a beam, and of a layer on a structure, is neither a half space nor a plate
         call predict(outcome, impact, sphere, plate, modulus, plate_modulus, outcome%is_coupled())
      else if (has_face(around, plate, plate_modulus)) then
         call face_losses(losses, outcome, impact, carrier, around%base, around%thickness, &
            around%mobility, around%is_panel)
         call predict(outcome, impact, sphere, plate, modulus, plate_modulus, &
            outcome%is_coupled(), losses)
      else
         call predict(outcome, impact, sphere, plate, modulus, plate_modulus, outcome%is_coupled())
      end if
   end subroutine compare_with_exact

   !> Whether the plate has a face that takes waves: not a rigid one, nor a second sphere
   pure function has_face(around, plate, modulus)
      type(surroundings_t), intent(in) :: around
      class(material_t), intent(in) :: plate
      !> Modulus of the plate at i pi/t0 [Pa]
      complex(wp), intent(in) :: modulus
      logical :: has_face

      has_face = .not. (plate%rigid .or. around%is_sphere .and. ieee_is_nan(around%thickness))
      if (has_face) has_face = plate%density() > 0.0_wp .and. real(modulus, wp) > 0.0_wp
   end function has_face

   !> Share of the second body in the compliance of the contact
   pure function plate_share(sphere, plate, modulus, frequency) result(share)
      class(material_t), intent(in) :: sphere
      class(material_t), intent(in) :: plate
      !> Complex modulus of the plate at the frequency [Pa]
      complex(wp), intent(in) :: modulus
      !> Frequency [rad/s]
      real(wp), intent(in) :: frequency
      !> Share [-], 1 under a rigid sphere
      real(wp) :: share

      real(wp) :: stiffness

      share = 0.0_wp
      if (plate%rigid) return
      share = 1.0_wp
      if (sphere%rigid) return
      stiffness = abs(sphere%complex_modulus(cmplx(0.0_wp, frequency, wp))) &
         *sphere%plane_strain_factor()
      share = stiffness/(stiffness + abs(modulus)*plate%plane_strain_factor())
   end function plate_share

   !> Set the measures of the plate's waves
   pure subroutine assess_plate(outcome, impact, trajectory, around, plate, storage, frequency)
      type(outcome_t), intent(inout) :: outcome
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      type(surroundings_t), intent(in) :: around
      class(material_t), intent(in) :: plate
      !> Storage modulus of the plate [Pa], 0 for a rigid one
      real(wp), intent(in) :: storage
      !> Frequency of the storage modulus, pi/t0 [rad/s]
      real(wp), intent(in) :: frequency

      real(wp) :: wave_number, shear_speed, stiffness
      logical :: bends

      ! neither a rigid plate nor a dashpot has waves
      if (.not. storage > 0.0_wp) return
      shear_speed = 0.0_wp
      if (plate%density() > 0.0_wp) shear_speed = sqrt(storage/(2.0_wp &
         *(1.0_wp + plate%poisson_ratio())*plate%density()))
      if (around%on_base) then
         ! a layer does not bend: a sliding one has extensional waves, of sqrt(2/(1 - nu)) c_s
         if (.not. around%has_body) return
         if (around%base == base_sliding) shear_speed = shear_speed &
            *sqrt(2.0_wp/(1.0_wp - plate%poisson_ratio()))
         outcome%needed_extent = 0.5_wp*shear_speed*outcome%contact_time
         return
      end if
      wave_number = 0.0_wp
      bends = impact%target%moves() .or. around%is_panel .or. around%is_beam
      if ((bends .or. around%has_body) .and. .not. ieee_is_nan(around%thickness)) then
         ! a free beam moves as a whole
         if (bends .and. .not. impact%target%structure%falls()) outcome%deflection_ratio = &
            maxval(abs(trajectory%state(col_plate, 0:trajectory%last)))/around%thickness
         stiffness = storage
         if (.not. around%is_beam) stiffness = storage*plate%plane_strain_factor()
         wave_number = sqrt(frequency/around%thickness*sqrt(12.0_wp*plate%density()/stiffness))
         outcome%plate_wave_number = wave_number*around%thickness
         outcome%needed_extent = pi/wave_number
      end if
      if (.not. around%has_body) return
      ! no wave in a plate is much faster
      outcome%needed_extent = 0.5_wp*shear_speed*outcome%contact_time
      if (wave_number*outcome%needed_extent > pi) outcome%needed_extent = pi/wave_number
   end subroutine assess_plate

   !> Values that are compared with the thresholds, in their order; NaN if not judged
   pure function judged(outcome, around) result(values)
      !> Outcome, its measures set
      type(outcome_t), intent(in) :: outcome
      !> Properties outside the impact
      type(surroundings_t), intent(in) :: around
      !> The values [-]
      real(wp) :: values(size(thresholds))

      real(wp) :: gain

      values = [merge(none, outcome%contact_ratio, around%is_true), &
         outcome%layer_strain, outcome%needed_extent/around%extent, &
         outcome%deflection_ratio, 1.0_wp/outcome%highest_mode, &
         outcome%block_reach, &
         merge(real(outcome%contacts, wp), none, outcome%contacts > 1), &
         outcome%weight_ratio, outcome%mass_ratio, &
         outcome%mean_pressure/around%yield_strength, &
         outcome%axis_tension, &
         abs(outcome%cor_deviation)/max(outcome%cor_sphere, 0.5_wp), &
         merge(huge(gain), none, outcome%gains_energy())]
      if (around%is_weighed) values(findloc(thresholds%measure, 'weight_ratio', dim=1)) = none
      ! NaN must not be compared
      if (.not. ieee_is_nan(outcome%mass_ratio)) values(findloc(thresholds%measure, 'mass_ratio', &
         dim=1)) = max(outcome%mass_ratio, 1.0_wp/outcome%mass_ratio)
      if (ieee_is_nan(outcome%sphere_ratio)) return
      if (ieee_is_nan(values(1)) .and. outcome%sphere_ratio > 0.0_wp) values(1) = 0.0_wp
      if (.not. ieee_is_nan(values(1))) &
         values(1) = max(values(1), sphere_weight*outcome%sphere_ratio)
   end function judged

   !> Set the worst level of all measures, and the measure that causes it: of several, the one
   !> farthest beyond its first threshold
   pure subroutine judge(outcome, around)
      !> Outcome, its measures set
      type(outcome_t), intent(inout) :: outcome
      !> Properties outside the impact
      type(surroundings_t), intent(in) :: around

      real(wp) :: values(size(thresholds)), excess, largest
      integer :: i, level

      values = judged(outcome, around)
      outcome%validity = level_good
      outcome%validity_cause = 0
      largest = 0.0_wp
      do i = 1, size(thresholds)
         level = level_of(i, values(i))
         if (level <= level_good .or. level < outcome%validity) cycle
         excess = values(i)/thresholds(i)%caution
         if (level == outcome%validity .and. excess <= largest) cycle
         outcome%validity = level
         outcome%validity_cause = i
         largest = excess
      end do
   end subroutine judge

   !> Level of one measure
   pure function level_of(measure, value) result(level)
      !> Index in `thresholds`
      integer, intent(in) :: measure
      !> Value compared with the threshold; NaN if none
      real(wp), intent(in) :: value
      !> One of the `level_*` constants
      integer :: level

      level = level_none
      if (ieee_is_nan(value)) return
      level = level_good
      if (value >= thresholds(measure)%caution) level = level_caution
      if (value >= thresholds(measure)%outside) level = level_outside
   end function level_of

end module vcor_impact_validity
