!> Measures of how well an impact meets the assumptions of the model, and their assessment
!>
!> Each measure is a column of the summary. Those with a threshold show whether the contact is
!> Hertzian, on a half space, in a thin and wide plate, and without losses that are not computed.
module vcor_impact_validity
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_impact_outcome, only : none, outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_plate, trajectory_t
   use vcor_kinds, only : pi, standard_gravity, wp
   use vcor_material_type, only : material_t
   use vcor_numeric_quadrature, only : gauss_nodes
   implicit none
   private

   public :: surroundings_t, assess, judge, half_space_resistance
   public :: threshold_t, thresholds, judged, level_of
   public :: levels, level_none, level_good, level_caution, level_outside

   !> Levels of validity: the impact has no result
   integer, parameter :: level_none = 0
   !> No measure exceeds a threshold
   integer, parameter :: level_good = 1
   !> A measure exceeds its first threshold: errors of a few per cent
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
      ! ratio of the forces on a layer and on a half space, same indentation (`layer_law`): sliding
      ! 1.079 at 0.1 and 1.264 at 0.3, bonded with nu = 0.5 1.124 and 1.440; a free plate is softer
      threshold_t('thickness_ratio', 0.1_wp, 0.3_wp), &
      ! the gap between sphere and base is smaller by half the indentation on average, and the
      ! stiffness of a thin incompressible layer goes with its third power: the force is up to 15 %
      ! too small at 0.1, 50 % at 0.3, times the share that the base adds to it
      threshold_t('layer_strain', 0.1_wp, 0.3_wp), &
      ! Rayleigh and Lamb's layer takes 8 % more energy than a thin plate at 0.7, a third more at
      ! 1.3
      threshold_t('plate_wave_number', 0.7_wp, 1.3_wp), &
      ! over the extent: an edge at needed_extent returns the wave at t0; energy of the waves in a
      ! plate hit at its centre: 0.4 % off at 0.6, 4 % at 1, 25 % at 1.25
      threshold_t('needed_extent', 0.6_wp, 1.0_wp), &
      ! stretching increases the bending stiffness by 0.445 times its square
      threshold_t('deflection_ratio', 0.3_wp, 1.0_wp), &
      ! the weight divided by the force that reverses the motion
      threshold_t('weight_ratio', 0.01_wp, 0.1_wp), &
      ! over the yield strength: first yield, and full plasticity of the contact, Johnson, Contact
      ! Mechanics (1985), doi:10.1017/CBO9781139171731, sections 6.1 and 6.2
      threshold_t('mean_pressure', 1.07_wp, 2.8_wp), &
      ! less the wave energy computed: energy lost in reality but not in the model
      threshold_t('half_space_loss', 0.01_wp, 0.1_wp), &
      ! the same, of a plate that is free to bend; judged is the larger of the two
      threshold_t('bending_loss', 0.01_wp, 0.1_wp), &
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
      !> Poisson's ratio of the plate [-]
      real(wp), private :: poisson_ratio = none
      !> `half_space_resistance` of the plate [-]
      real(wp), private :: resistance = none
      !> Gauss' rule of `half_space_resistance`, shape (n)
      real(wp), allocatable, private :: node(:), weight(:)
   contains
      procedure :: follow
   end type surroundings_t

contains

   !> Set the plate's Poisson's ratio; the resistance is computed again if it has changed
   pure subroutine follow(self, poisson_ratio)
      class(surroundings_t), intent(inout) :: self
      !> Poisson's ratio [-], -1 < nu <= 0.5
      real(wp), intent(in) :: poisson_ratio

      integer, parameter :: order = 48

      if (allocated(self%node)) then
         if (.not. abs(poisson_ratio - self%poisson_ratio) > 0.0_wp) return
      else
         allocate (self%node(order), self%weight(order))
         call gauss_nodes(self%node, self%weight)
      end if
      self%poisson_ratio = poisson_ratio
      self%resistance = half_space_resistance(poisson_ratio, self%node, self%weight)
   end subroutine follow

   !> Set and judge the measures
   pure subroutine assess(outcome, impact, trajectory, around, sphere, plate)
      !> Outcome of a separation; on return all measures are set
      type(outcome_t), intent(inout) :: outcome
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      type(surroundings_t), intent(in) :: around
      class(material_t), intent(in) :: sphere
      class(material_t), intent(in) :: plate

      complex(wp) :: modulus, plate_modulus
      real(wp) :: hertz_radius, frequency, share, force_radius

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
         hertz_radius = (0.75_wp*impact%factor)**2
         outcome%contact_ratio = outcome%contact_radius/min(hertz_radius, around%radius)
         outcome%sphere_ratio = outcome%contact_radius*((1.0_wp - share)/around%radius &
            + share*max(1.0_wp/hertz_radius - 1.0_wp/around%radius, 0.0_wp))
      end if
      call assess_plate(outcome, impact, trajectory, around, plate, real(plate_modulus, wp), &
         frequency)
      call judge(outcome, around)
   end subroutine assess

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

      real(wp) :: wave_number, shear_speed, alpha

      ! neither a rigid plate nor a dashpot has waves
      if (.not. storage > 0.0_wp) return
      wave_number = 0.0_wp
      if ((impact%target%moves() .or. around%has_body) &
          .and. .not. ieee_is_nan(around%thickness)) then
         if (impact%target%moves()) outcome%deflection_ratio = &
            maxval(abs(trajectory%state(col_plate, 0:trajectory%last)))/around%thickness
         wave_number = sqrt(frequency/around%thickness*sqrt(12.0_wp*plate%density() &
            /(storage*plate%plane_strain_factor())))
         outcome%plate_wave_number = wave_number*around%thickness
         outcome%needed_extent = pi/wave_number
      end if
      if (.not. plate%density() > 0.0_wp) return
      shear_speed = sqrt(storage/(2.0_wp*(1.0_wp + plate%poisson_ratio())*plate%density()))
      ! no wave in a plate is much faster
      if (around%has_body) then
         outcome%needed_extent = 0.5_wp*shear_speed*outcome%contact_time
         if (wave_number*outcome%needed_extent > pi) outcome%needed_extent = pi/wave_number
      end if
      if (around%is_sphere .or. around%on_base) return
      ! Zener's alpha; W = alpha int F^2 dt, of a half sine alpha F^2 t0/2, as the part of a motion
      ! that the loss itself slows down
      if (.not. (impact%target%moves() .or. around%has_body &
          .or. ieee_is_nan(around%thickness))) then
         alpha = sqrt(3.0_wp*plate%density()/(storage*plate%plane_strain_factor())) &
            /(4.0_wp*plate%density()*around%thickness**2)
         outcome%bending_loss = 1.0_wp - exp(-alpha*outcome%max_force/outcome%initial_energy &
            *outcome%max_force*outcome%contact_time/2.0_wp)
      end if
      ! int (dF/dt)^2 dt of a half sine is (pi F)^2/(2 t0)
      outcome%half_space_loss = around%resistance/(2.0_wp*pi*plate%density()*shear_speed**3) &
         *outcome%max_force/outcome%initial_energy*outcome%max_force &
         *pi*frequency/2.0_wp
   end subroutine assess_plate

   !> Values that are compared with the thresholds, in their order; NaN if not judged
   pure function judged(outcome, around) result(values)
      !> Outcome, its measures set
      type(outcome_t), intent(in) :: outcome
      !> Properties outside the impact
      type(surroundings_t), intent(in) :: around
      !> The values [-]
      real(wp) :: values(size(thresholds))

      ! measures of what a plate of any thickness contains
      character(len=*), parameter :: contained(4) = [character(len=17) :: &
         'thickness_ratio', 'plate_wave_number', 'half_space_loss', &
         'bending_loss']
      real(wp) :: thick, bends
      integer :: i

      ! the plate is either thick or bends: of the two losses only the larger one is judged
      thick = outcome%half_space_loss - outcome%wave_energy/outcome%initial_energy
      bends = outcome%bending_loss
      if (.not. (ieee_is_nan(thick) .or. ieee_is_nan(bends))) then
         if (bends > thick) then
            thick = none
         else
            bends = none
         end if
      end if

      values = [merge(none, outcome%contact_ratio, around%is_true), &
         merge(none, outcome%thickness_ratio, around%on_base), outcome%layer_strain, &
         outcome%plate_wave_number, outcome%needed_extent/around%extent, &
         outcome%deflection_ratio, outcome%weight_ratio, &
         outcome%mean_pressure/around%yield_strength, &
         thick, bends, merge(huge(thick), none, outcome%gains_energy())]
      if (around%is_weighed) values(findloc(thresholds%measure, 'weight_ratio', dim=1)) = none
      do i = 1, size(thresholds)
         if (around%has_body .and. any(contained == thresholds(i)%measure)) values(i) = none
      end do
      ! NaN must not be compared
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

   !> Resistance of an elastic half space to a point force F exp(i omega t) on its surface. With
   !> a = c_s/c_p, p^2 = x^2 - a^2, q^2 = x^2 - 1 and R(x) = (2 x^2 - 1)^2 - 4 x^2 p q the surface
   !> moves by -F c_s p/(mu omega R) at the wave number x omega/c_s, so the imaginary part of Lamb's
   !> compliance u/F is -omega I(nu)/(2 pi mu c_s) with
   !>
   !>     I = Im int_0^inf x p/R dx,      p = i|p| for x < a, q = i|q| for x < 1
   !>
   !> consists of pressure and shear waves in x < a, shear waves in a < x < 1 and Rayleigh waves at
   !> the root of R: G. F. Miller, H. Pursey, Proc. R. Soc. A 223 (1954) 521,
   !> doi:10.1098/rspa.1954.0134
   pure function half_space_resistance(poisson_ratio, node, weight) result(resistance)
      !> Poisson's ratio [-], -1 < nu <= 0.5
      real(wp), intent(in) :: poisson_ratio
      !> Nodes of Gauss' rule on (0, 1), shape (n); 48 have an error of 1e-8 at worst, near nu = 0
      real(wp), intent(in) :: node(:)
      !> Weights of the nodes, shape (n)
      real(wp), intent(in) :: weight(:)
      !> I(nu) [-]
      real(wp) :: resistance

      real(wp), dimension(size(node)) :: sine, x, p, q, part
      real(wp) :: a2, root, p_root, q_root, slope, correction
      integer :: iteration

      a2 = 0.5_wp*(1.0_wp - 2.0_wp*poisson_ratio)/(1.0_wp - poisson_ratio)
      sine = sin(0.5_wp*pi*node)
      ! x = a sin(phi) removes the square root from the integrand
      x = sqrt(a2)*sine
      p = sqrt(a2)*cos(0.5_wp*pi*node)
      q = sqrt(1.0_wp - x**2)
      part = x*p/((1.0_wp - 2.0_wp*x**2)**2 + 4.0_wp*x**2*p*q)
      resistance = 0.5_wp*pi*sum(weight*part*p)
      ! x^2 = a^2 + (1 - a^2) sin(phi)^2, dx = p q/x dphi
      x = sqrt(a2 + (1.0_wp - a2)*sine**2)
      p = sqrt(1.0_wp - a2)*sine
      q = sqrt(1.0_wp - a2)*cos(0.5_wp*pi*node)
      part = 4.0_wp*x**3*p**2*q/((1.0_wp - 2.0_wp*x**2)**4 + (4.0_wp*x**2*p*q)**2)
      resistance = resistance + 0.5_wp*pi*sum(weight*part*p*q/x)
      ! right of its root R falls and is concave: Newton's method descends to it monotonically
      root = 1.6_wp
      do iteration = 1, 20
         p_root = sqrt(root**2 - a2)
         q_root = sqrt(root**2 - 1.0_wp)
         slope = 8.0_wp*root*(2.0_wp*root**2 - 1.0_wp) - 8.0_wp*root*p_root*q_root &
            - 4.0_wp*root**3*(q_root/p_root + p_root/q_root)
         correction = ((2.0_wp*root**2 - 1.0_wp)**2 - 4.0_wp*root**2*p_root*q_root)/slope
         root = root - correction
         if (abs(correction) <= 4.0_wp*epsilon(root)) exit
      end do
      resistance = resistance + pi*root*sqrt(root**2 - a2)/abs(slope)
   end function half_space_resistance

end module vcor_impact_validity
