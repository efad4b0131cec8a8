!> Outcome of an impact: the quantities that users ask for
module vcor_impact_outcome
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_impact_bounces, only : bounce_t, bounces_t, ends_count, ends_none, ends_rest
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, &
      contact_resting, contact_separated, contact_unknown, trajectory_t
   use vcor_kinds, only : pi, wp
   implicit none
   private

   public :: outcome_t, evaluate, bounces_of, none

   !> Quiet NaN for a quantity that does not exist, by its bits: ieee_value is not constant
   real(wp), parameter :: none = transfer(9221120237041090560_int64, 1.0_wp)

   !> The outcome. Without separation only `status`, `steps` and `initial_energy` are set, for a
   !> sphere at rest the maxima and the residual indentation too; all others are NaN. The measures
   !> from `rebound_height` on, which need more than the impact, are set by `assess` of
   !> `vcor_impact_validity`, NaN where they do not apply
   type :: outcome_t
      !> One of the `contact_*` constants of the trajectory
      integer :: status = contact_unknown
      !> Number of time steps
      integer :: steps = 0
      !> Coefficient of restitution by the relative velocity, -s'(t0)/v0 [-]
      real(wp) :: cor = none
      !> Coefficient of restitution by the sphere's own velocity, -z'(t0)/v0 [-]
      real(wp) :: cor_sphere = none
      !> Contact time t0 [s]
      real(wp) :: contact_time = none
      !> Largest indentation [m]
      real(wp) :: max_indentation = none
      !> Time of the largest indentation [s]
      real(wp) :: time_of_max_indentation = none
      !> Largest force [N]
      real(wp) :: max_force = none
      !> Time of the largest force [s]
      real(wp) :: time_of_max_force = none
      !> Indentation at t0 [m]
      real(wp) :: residual_indentation = none
      !> Ratio of residual to largest indentation [-]
      real(wp) :: residual_ratio = none
      !> Hysteresis W_h = int F ds [J]
      real(wp) :: hysteresis_energy = none
      !> Energy radiated into the plate, or given to a structure, W_wave = int F dU [J]
      real(wp) :: wave_energy = none
      !> All the energy that the sphere loses, int F dz = W_h + W_wave [J]
      real(wp) :: energy_loss = none
      !> Kinetic energy before the impact m v0^2/2 [J]
      real(wp) :: initial_energy = none
      !> Kinetic energy of the sphere after the impact m z'(t0)^2/2 [J]
      real(wp) :: final_energy = none
      !> Work of the weight m g z(t0) [J]
      real(wp) :: weight_work = none
      !> Imbalance of the energies: initial - final energy + work of the weight - energy loss [J]
      real(wp) :: energy_imbalance = none
      !> Number of contacts: more than one if a structure strikes again; 0 without a result
      integer :: contacts = 0
      !> Time of the last separation [s]
      real(wp) :: last_separation = none
      !> Number of bounces; 0 without a result
      integer :: bounces = 0
      !> Time from first touch to the end of the last bounce, or to the touch after which the sphere
      !> rests [s], and its estimated error
      real(wp) :: bouncing_time = none
      real(wp) :: bouncing_time_error = none
      !> One of the `ends_*` constants of the bounces
      integer :: bounces_end = ends_none
      !> Restitution of the sphere at the end of the first contact [-]
      real(wp) :: first_cor_sphere = none
      !> Energy left in the modes of a structure at the last separation [J]; NaN if its material
      !> relaxes
      real(wp) :: structure_energy = none
      !> Lowest frequency of interest, 2 pi/t0 [rad/s]
      real(wp) :: min_frequency = none
      !> Zener's inelasticity parameter lambda [-]
      real(wp) :: inelasticity = none
      !> Loss tangent of the contact modulus at `min_frequency` [-]
      real(wp) :: loss_tangent = none
      !> Estimate of the error of `cor` [-]
      real(wp) :: cor_error = none
      !> Estimate of the error of `cor_sphere` [-]
      real(wp) :: cor_sphere_error = none
      !> Estimate of the error of `contact_time` [s]
      real(wp) :: contact_time_error = none
      !> Estimate of the error of `max_force` [N]
      real(wp) :: max_force_error = none
      !> Accuracy requested for both [-]; 0 if none was
      real(wp) :: accuracy = 0.0_wp
      !> Rebound resilience, cor_sphere^2 [-]
      real(wp) :: resilience = none
      !> Height of rebound of a dropped sphere [m]
      real(wp) :: rebound_height = none
      !> Largest radius of the contact [m]
      real(wp) :: contact_radius = none
      !> Contact radius divided by the smaller of Hertz' radius and the sphere's [-]
      real(wp) :: contact_ratio = none
      !> Contact radius divided by the radius of the sphere, times the sphere's share of the
      !> compliance; added up for two spheres [-]
      real(wp) :: sphere_ratio = none
      !> Contact radius divided by thickness of the plate, times the plate's share of the
      !> compliance [-]
      real(wp) :: thickness_ratio = none
      !> Contact radius divided by the thickness of a layer on a base [-]
      real(wp) :: layer_ratio = none
      !> Force divided by that on a half space at the largest indentation of a layer on a base [-]
      real(wp) :: layer_stiffening = none
      !> Largest indentation divided by the thickness of a layer on a base, times the plate's share
      !> of the compliance [-]
      real(wp) :: layer_strain = none
      !> Thickness times the wavenumber of bending waves at the frequency pi/t0 [-]
      real(wp) :: plate_wave_number = none
      !> Distance of the nearest edge from which this wave returns at t0 [m]
      real(wp) :: needed_extent = none
      !> Largest displacement of the plate divided by its thickness [-]
      real(wp) :: deflection_ratio = none
      !> Highest frequency of a list of modes, times t0/pi [-]
      real(wp) :: highest_mode = none
      !> Half of the way of shear waves during the contact over the edge of a cube that is as heavy
      !> as the block whose half space they fill [-]
      real(wp) :: block_reach = none
      !> Weight of the sphere divided by the largest force [-]
      real(wp) :: weight_ratio = none
      !> Mass divided by that of a solid ball of the radius and the density of its material [-]
      real(wp) :: mass_ratio = none
      !> Mean pressure at the time of the largest force [Pa]
      real(wp) :: mean_pressure = none
      !> Largest tension around the axis of the contact divided by `mean_pressure` [-]
      real(wp) :: axis_tension = none
      !> Predicted change of `cor_sphere` towards exact mechanics [-]
      real(wp) :: cor_deviation = none
      !> Share of `initial_energy` that the face as it is takes by waves, less what the model's
      !> takes
      real(wp) :: wave_loss = none
      !> Loss tangent of the contact modulus at pi/t0 [-]
      real(wp) :: peak_loss_tangent = none
      !> Storage modulus of the contact at pi/t0 [Pa]
      real(wp) :: peak_storage_modulus = none
      !> One of the `level_*` constants of `vcor_impact_validity`
      integer :: validity = 0
      !> Index in `thresholds` of the decisive measure; 0: none
      integer :: validity_cause = 0
   contains
      procedure :: come_to_rest
      procedure :: is_finite
      procedure :: misses
      procedure :: gains_energy
      procedure :: is_coupled
      procedure :: has_structure
   end type outcome_t

contains

   !> Evaluate a trajectory
   pure function evaluate(impact, trajectory) result(outcome)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      type(outcome_t) :: outcome

      complex(wp) :: modulus
      real(wp) :: impulse
      integer :: n

      n = trajectory%last
      outcome%status = trajectory%status
      outcome%steps = trajectory%steps
      outcome%initial_energy = impact%initial_energy()
      if (all(outcome%status /= [contact_separated, contact_resting])) return

      outcome%max_indentation = trajectory%max_indentation
      outcome%time_of_max_indentation = trajectory%time_of_max_indentation
      outcome%max_force = trajectory%max_force
      outcome%time_of_max_force = trajectory%time_of_max_force
      outcome%residual_indentation = trajectory%state(col_indentation, n)
      ! bodies that separate at first touch have no other quantities
      if (.not. outcome%max_indentation > 0.0_wp) return
      outcome%residual_ratio = outcome%residual_indentation/outcome%max_indentation
      if (outcome%status == contact_resting) then
         outcome%bouncing_time = 0.0_wp
         outcome%bounces_end = ends_rest
         return
      end if

      ! impulse of the force less that of the weight
      outcome%contact_time = trajectory%state(col_time, n)
      impulse = trajectory%state(col_impulse, n) &
         - impact%mass*impact%gravity*outcome%contact_time
      outcome%last_separation = outcome%contact_time
      outcome%contacts = 1
      outcome%structure_energy = 0.0_wp
      if (impact%target%structure%exists()) then
         outcome%contact_time = trajectory%first_end
         outcome%contacts = trajectory%contacts
         outcome%structure_energy = trajectory%structure_energy
         outcome%first_cor_sphere = -trajectory%first_velocity/impact%velocity
      end if
      outcome%bounces = 1
      outcome%bouncing_time = outcome%last_separation
      outcome%bounces_end = ends_count
      if (allocated(trajectory%bounces)) then
         outcome%bounces = trajectory%bounces%count
         outcome%bouncing_time = trajectory%bounces%total_time
         outcome%bouncing_time_error = trajectory%bounces%total_time_error
         outcome%bounces_end = trajectory%bounces%ending
      end if
      outcome%cor = -trajectory%state(col_velocity, n)/impact%velocity
      if (impact%target%structure%exists()) outcome%cor = (trajectory%rigid_velocity &
         - trajectory%state(col_sphere_velocity, n))/impact%velocity
      outcome%cor_sphere = impulse/(impact%mass*impact%velocity) - 1.0_wp
      outcome%resilience = outcome%cor_sphere**2
      outcome%hysteresis_energy = sum(trajectory%share(0:n) &
         *trajectory%state(col_velocity, 0:n))
      outcome%wave_energy = sum(trajectory%share(0:n) &
         *trajectory%state(col_plate_velocity, 0:n))
      if (allocated(trajectory%work)) then
         outcome%hysteresis_energy = trajectory%work(1)
         outcome%wave_energy = trajectory%work(2)
      end if
      outcome%energy_loss = outcome%hysteresis_energy + outcome%wave_energy
      if (ieee_is_nan(trajectory%state(col_plate, n))) then
         ! contact and plate solved as one: far away the plate is at rest, or moves as the structure
         ! that carries it, and the faces at the edge of the contact have no velocity apart
         if (.not. outcome%has_structure()) outcome%cor = outcome%cor_sphere
         outcome%energy_loss = sum(trajectory%share(0:n)*trajectory%state(col_sphere_velocity, 0:n))
      end if
      outcome%final_energy = outcome%initial_energy*outcome%resilience
      outcome%weight_work = impact%mass*impact%gravity*trajectory%state(col_sphere, n)
      ! the work done on the sphere, KE0 (1 - cor_sphere^2) from the impulse, and that of its weight
      outcome%energy_imbalance = impulse*(impact%velocity - 0.5_wp*impulse/impact%mass) &
         + outcome%weight_work - outcome%energy_loss

      outcome%min_frequency = 2.0_wp*pi/outcome%contact_time
      if (.not. outcome%is_coupled()) outcome%inelasticity = impact%inelasticity()
      modulus = impact%modulus%dynamic_modulus(outcome%min_frequency)
      outcome%loss_tangent = aimag(modulus)/real(modulus, wp)
      outcome%cor_error = trajectory%cor_error
      outcome%cor_sphere_error = trajectory%cor_sphere_error
      outcome%contact_time_error = trajectory%contact_time_error
      outcome%max_force_error = trajectory%max_force_error
      outcome%accuracy = trajectory%accuracy
   end function evaluate

   !> Bounces of an impact: the impact itself if no more were asked for, none of a sphere that stays
   pure function bounces_of(impact, trajectory, outcome) result(bounces)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      !> Its outcome
      type(outcome_t), intent(in) :: outcome
      type(bounces_t) :: bounces

      type(bounce_t) :: bounce

      if (allocated(trajectory%bounces)) then
         bounces = trajectory%bounces
         return
      end if
      bounces%ending = outcome%bounces_end
      bounces%total_time = outcome%bouncing_time
      if (outcome%status /= contact_separated) return
      bounce%velocity = impact%velocity
      bounce%cor = outcome%cor_sphere
      bounce%cor_error = outcome%cor_sphere_error
      bounce%separation = outcome%last_separation
      if (impact%gravity > 0.0_wp) bounce%height = 0.5_wp*(outcome%cor_sphere &
         *impact%velocity)**2/impact%gravity - trajectory%state(col_sphere, trajectory%last)
      bounce%contacts = outcome%contacts
      bounce%max_force = outcome%max_force
      bounce%max_indentation = outcome%max_indentation
      call bounces%add(bounce)
   end function bounces_of

   !> Take the indentation of a sphere that rests from the balance of spring and weight: the
   !> computation may end while the material still creeps. A fluid keeps its last indentation
   pure subroutine come_to_rest(self, impact)
      !> The outcome of an impact that ended at rest
      class(outcome_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact

      if (.not. impact%pushes_apart()) return
      self%residual_indentation = impact%law%inverse(impact%mass*impact%gravity &
         /(impact%factor*impact%modulus%rubbery()))
      self%max_indentation = max(self%max_indentation, self%residual_indentation)
      self%residual_ratio = self%residual_indentation/self%max_indentation
   end subroutine come_to_rest

   !> Whether all numbers are finite: energies, for example, may overflow
   pure function is_finite(self)
      !> The outcome of an impact that ended in separation
      class(outcome_t), intent(in) :: self
      logical :: is_finite

      is_finite = all(ieee_is_finite([self%cor, self%cor_sphere, self%contact_time, &
         self%max_indentation, self%time_of_max_indentation, self%max_force, &
         self%time_of_max_force, self%residual_indentation, self%residual_ratio, &
         self%energy_loss, self%initial_energy, self%final_energy, self%energy_imbalance, &
         self%min_frequency, self%loss_tangent, self%cor_error, self%cor_sphere_error]))
   end function is_finite

   !> Whether the estimated error exceeds the accuracy requested; false without separation
   pure function misses(self)
      class(outcome_t), intent(in) :: self
      logical :: misses

      misses = self%status == contact_separated .and. self%accuracy > 0.0_wp
      if (misses) misses = max(self%cor_error, self%cor_sphere_error) > self%accuracy
   end function misses

   !> Whether contact and plate were solved as one, so that the energy loss has no parts
   elemental function is_coupled(self)
      !> The outcome of an impact that ended in separation
      class(outcome_t), intent(in) :: self
      logical :: is_coupled

      is_coupled = ieee_is_nan(self%wave_energy) .and. .not. ieee_is_nan(self%energy_loss)
   end function is_coupled

   !> Whether a structure was struck
   elemental function has_structure(self)
      !> The outcome of an impact that ended in separation
      class(outcome_t), intent(in) :: self
      logical :: has_structure

      has_structure = .not. ieee_is_nan(self%first_cor_sphere)
   end function has_structure

   !> Whether the sphere or the two bodies separate with more energy than they had, beyond the
   !> stated errors: the sum of all forces on it did work, or it sank so far that its weight did
   pure function gains_energy(self) result(gains)
      !> The outcome of an impact that ended in separation
      class(outcome_t), intent(in) :: self
      logical :: gains

      ! of sums of thousands of terms: 4500 times epsilon
      real(wp), parameter :: rounding = 1.0e-12_wp
      real(wp) :: cor_margin, sphere_margin

      cor_margin = max(self%cor_error, rounding)
      sphere_margin = max(self%cor_sphere_error, rounding)
      gains = self%cor > 1.0_wp + cor_margin .or. self%cor_sphere > 1.0_wp + sphere_margin
      ! d(1 - e^2) = 2 |e| de
      if (.not. gains) gains = -self%energy_loss - abs(self%energy_imbalance) &
         > 2.0_wp*self%initial_energy*max(abs(self%cor_sphere), 1.0_wp)*sphere_margin
   end function gains_energy

end module vcor_impact_outcome
