!> The impact of a sphere on a plate: the problem that solvers solve
!>
!> With the displacements z of the sphere and U of the plate, the indentation s = z - U and gravity
!> g, Eq. (2) of Green's paper, integrated twice from s(0) = 0, s'(0) = v0, is
!>
!>     s(t) = v0 t + g t^2/2 - J(t)/m - U(t),    I' = F,   J' = I,    U = alpha(t) I
!>     F(t) = int_0^t k(t - x) u'(x) dx,    u = s^n,    k(t) = K E'(t)
!>
!> By the receding law, once the contact shrinks, the integral ends at the time t1(t) at which the
!> contact was growing and as large as now,
!>
!>     F(t) = int_0^t1 k(t - x) u'(x) dx,   int_t1^t k(t - x) s'(x) dx = 0
module vcor_impact_problem
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_contact, only : contact_modulus_t
   use vcor_impact_face, only : face_t
   use vcor_impact_law, only : contact_law_t, sphere_factor
   use vcor_impact_target, only : target_t
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_number, only : least_magnitude, most_magnitude
   implicit none
   private

   public :: impact_t, new_impact

   !> An impact; solvers do not change it
   type :: impact_t
      !> Velocity of approach v0 [m/s], > 0
      real(wp) :: velocity = 0.0_wp
      !> Mass of the sphere m [kg], > 0
      real(wp) :: mass = 0.0_wp
      !> Gravity g, towards the plate [m/s2], >= 0
      real(wp) :: gravity = 0.0_wp
      !> Shape factor K [m^(2-n)], kernel per unit modulus; (4/3) sqrt(R) for a sphere
      real(wp) :: factor = 0.0_wp
      !> Contact modulus E'(t)
      type(contact_modulus_t) :: modulus
      !> What lies behind the contact
      type(target_t) :: target
      !> Contact law
      type(contact_law_t) :: law
      !> The face that is struck, for method coupled, which takes from it what modulus, plate and
      !> law are for the other methods
      type(face_t) :: face
   contains
      procedure :: launch
      procedure :: free_path
      procedure :: free_velocity
      procedure :: speed_scale
      procedure :: kernel
      procedure :: kernel_integral
      procedure :: kernel_mean_integral
      procedure :: kernel_step_integrals
      procedure :: kernel_exponentials
      procedure :: kernel_viscosity
      procedure :: time_scale
      procedure, private :: elastic_time
      procedure :: deepest
      procedure :: lasting_time
      procedure :: may_part_unnoticed
      procedure :: first_force
      procedure :: ringing
      procedure :: firmness_after
      procedure :: contact_radius
      procedure :: pushes_apart
      procedure :: inelasticity
      procedure :: inelasticity_at
      procedure :: initial_energy
   end type impact_t

contains

   !> Build an impact
   pure subroutine new_impact(self, velocity, mass, radius, surface_radius, modulus, target, &
                              error, law, gravity, face)
      type(impact_t), intent(out) :: self
      !> Velocity of approach [m/s], > 0
      real(wp), intent(in) :: velocity
      !> Mass of the sphere [kg], > 0
      real(wp), intent(in) :: mass
      !> Radius of the sphere [m], > 0
      real(wp), intent(in) :: radius
      !> Radius of curvature of the plate at the contact [m]: 0 = flat, negative = concave
      real(wp), intent(in) :: surface_radius
      type(contact_modulus_t), intent(in) :: modulus
      type(target_t), intent(in) :: target
      type(error_t), allocatable, intent(out) :: error
      !> Contact law; absent: Hertz's with the integral over all the past
      type(contact_law_t), intent(in), optional :: law
      !> Gravity [m/s2], >= 0; absent: 0
      real(wp), intent(in), optional :: gravity
      !> The face that is struck; needed by method coupled, which solves every impact whose face has
      !> waves
      type(face_t), intent(in), optional :: face

      real(wp) :: factor

      if (.not. modulus%is_built()) then
         call raise(error, error_input, 'the contact modulus is empty: new_contact_modulus has ' &
            //'not built it')
         return
      end if
      self%modulus = modulus
      self%target = target
      if (present(law)) self%law = law
      if (present(face)) self%face = face
      call sphere_factor(radius, surface_radius, factor, error)
      if (.not. allocated(error)) call self%launch(velocity, mass, factor, error, gravity)
   end subroutine new_impact

   !> Change the motion, mass and shape of the body; modulus, plate and law remain
   pure subroutine launch(self, velocity, mass, factor, error, gravity)
      class(impact_t), intent(inout) :: self
      !> Velocity of approach [m/s], > 0
      real(wp), intent(in) :: velocity
      !> Mass [kg], > 0
      real(wp), intent(in) :: mass
      !> Shape factor K [m^(2-n)], > 0
      real(wp), intent(in) :: factor
      type(error_t), allocatable, intent(out) :: error
      !> Gravity [m/s2], >= 0; absent: 0
      real(wp), intent(in), optional :: gravity

      ! the computed mass of a tiny sphere may underflow to zero
      if (.not. (velocity > 0.0_wp .and. mass >= 0.0_wp .and. factor > 0.0_wp)) then
         call raise(error, error_input, 'velocity, mass and radius of the sphere must be ' &
            //'positive', about='velocity mass radius')
      else if (max(velocity, mass, factor**2) > most_magnitude &
               .or. min(velocity, mass, factor**2) < least_magnitude) then
         call raise(error, error_input, &
            'velocity, mass or radius of the sphere is out of the range that can be computed', &
            about='velocity mass radius')
      end if
      self%gravity = 0.0_wp
      if (present(gravity)) self%gravity = gravity
      if (.not. ieee_is_finite(self%gravity)) self%gravity = -1.0_wp
      if (self%gravity < 0.0_wp .or. self%gravity > most_magnitude) call raise(error, error_input, &
         'gravity must not be negative, nor out of the range that can be computed', about='gravity')
      if (allocated(error)) return
      self%velocity = velocity
      self%mass = mass
      self%factor = factor
   end subroutine launch

   !> Distance covered by the sphere without a contact force, v0 t + g t^2/2
   elemental function free_path(self, t) result(path)
      class(impact_t), intent(in) :: self
      !> Time since first contact [s]
      real(wp), intent(in) :: t
      !> Distance [m]
      real(wp) :: path

      path = self%velocity*t + 0.5_wp*self%gravity*t**2
   end function free_path

   !> Velocity of the sphere without a contact force, v0 + g t
   elemental function free_velocity(self, t) result(velocity)
      class(impact_t), intent(in) :: self
      !> Time since first contact [s]
      real(wp), intent(in) :: t
      !> Velocity [m/s]
      real(wp) :: velocity

      velocity = self%velocity + self%gravity*t
   end function free_velocity

   !> Reference velocity of the motion, v0 + g T with the time scale T: not zero for a sphere that
   !> is merely put down
   pure function speed_scale(self, time_scale) result(speed)
      class(impact_t), intent(in) :: self
      !> Time scale of the contact [s]
      real(wp), intent(in) :: time_scale
      !> Velocity [m/s]
      real(wp) :: speed

      speed = abs(self%velocity) + self%gravity*time_scale
   end function speed_scale

   !> Force at first contact, nonzero only for a dashpot under a flat punch (n = 1), and reduced by
   !> a plate that yields at once
   pure function first_force(self) result(force)
      class(impact_t), intent(in) :: self
      !> Force [N]
      real(wp) :: force

      real(wp) :: drag

      drag = self%kernel_viscosity()*self%law%slope(0.0_wp)
      force = drag*self%velocity/(1.0_wp + self%target%alpha(0.0_wp)*drag)
   end function first_force

   !> Amplitude with which a mode of a structure rings after first touch. The force F(t) ~ t^n is
   !> smooth but for its start, which leaves a fast mode with the amplitude n! F(1/w) y/w^2; a slow
   !> one has no more than that of the time scale
   pure function ringing(self, frequency, yield, time_scale) result(amplitude)
      class(impact_t), intent(in) :: self
      !> Frequency w [rad/s], > 0, and yield y [1/kg] of the mode
      real(wp), intent(in) :: frequency, yield
      !> Time scale of the contact [s]
      real(wp), intent(in) :: time_scale
      !> Amplitude [m]
      real(wp) :: amplitude

      real(wp) :: time

      time = min(1.0_wp/frequency, time_scale)
      amplitude = gamma(self%law%start_exponent + 1.0_wp)*self%firmness_after(time) &
         *self%law%u(self%free_path(time))*yield*time**2
   end function ringing

   !> Force over u a time after it began to grow: the kernel, and the viscosity over the time
   pure function firmness_after(self, time) result(firmness)
      class(impact_t), intent(in) :: self
      !> Time [s], > 0
      real(wp), intent(in) :: time
      !> Firmness [N/m^1.5]
      real(wp) :: firmness

      firmness = self%kernel(time) + self%kernel_viscosity()/time
   end function firmness_after

   !> Contact radius
   elemental function contact_radius(self, indentation) result(radius)
      class(impact_t), intent(in) :: self
      !> Indentation [m]
      real(wp), intent(in) :: indentation
      !> Radius [m]
      real(wp) :: radius

      radius = self%law%radius(self%factor, indentation)
   end function contact_radius

   !> Kernel k(t) = K E'(t), Eq. (5)
   elemental function kernel(self, t) result(k)
      class(impact_t), intent(in) :: self
      !> Time [s], t >= 0
      real(wp), intent(in) :: t
      !> Kernel [N/m^1.5]
      real(wp) :: k

      k = self%factor*self%modulus%relaxation(t)
   end function kernel

   !> Integral of the kernel from 0 to t, without the dashpot
   elemental function kernel_integral(self, t) result(value)
      class(impact_t), intent(in) :: self
      !> Upper limit [s], >= 0
      real(wp), intent(in) :: t
      !> Integral [N s/m^1.5]
      real(wp) :: value

      value = self%factor*self%modulus%integral(t)
   end function kernel_integral

   !> Mean over (0, t) of the integral of the kernel
   pure function kernel_mean_integral(self, t) result(value)
      class(impact_t), intent(in) :: self
      !> Time [s], > 0
      real(wp), intent(in) :: t
      !> Mean [N s/m^1.5]
      real(wp) :: value

      value = self%factor*self%modulus%mean_integral(t)
   end function kernel_mean_integral

   !> Integrals of the kernel over the steps from i dt to (i + 1) dt, i = 0 .. n - 1
   pure function kernel_step_integrals(self, dt, n) result(value)
      class(impact_t), intent(in) :: self
      !> Length of the steps [s], > 0
      real(wp), intent(in) :: dt
      !> Number of steps
      integer, intent(in) :: n
      !> Integrals [N s/m^1.5], shape (0:n-1)
      real(wp) :: value(0:n - 1)

      value = self%factor*self%modulus%step_integrals(dt, n)
   end function kernel_step_integrals

   !> The kernel as a sum of exponentials, Eq. (17): exact if it is one, else an approximation
   pure subroutine kernel_exponentials(self, window, accuracy, terms)
      class(impact_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      !> The sum [N/m^1.5]; `terms%error` is its estimated relative error
      type(exponential_sum_t), intent(out) :: terms

      call self%modulus%exponentials(window, accuracy, terms)
      call terms%scale(self%factor)
   end subroutine kernel_exponentials

   !> Viscosity of the kernel's dashpot
   pure function kernel_viscosity(self) result(viscosity)
      class(impact_t), intent(in) :: self
      !> Viscosity [N s/m^1.5]
      real(wp) :: viscosity

      viscosity = self%factor*self%modulus%viscosity()
   end function kernel_viscosity

   !> Time scale T of the contact: that of an elastic impact with the mean of the kernel over (0, T)
   pure function time_scale(self, tolerance) result(scale)
      class(impact_t), intent(in) :: self
      !> Tolerated relative error; absent: 1e-3
      real(wp), intent(in), optional :: tolerance
      !> Time scale [s]
      real(wp) :: scale

      real(wp) :: firmness, viscosity, guess, least
      integer :: iteration

      least = 1.0e-3_wp
      if (present(tolerance)) least = tolerance
      ! fixed-point iteration from the time scale of the glassy contact, or 1 s; for a kernel t^-a
      ! the map contracts by a/(n + 1)
      scale = 1.0_wp
      firmness = self%factor*self%modulus%glassy()
      if (firmness > 0.0_wp .and. firmness <= huge(1.0_wp)) scale = self%elastic_time(firmness)
      viscosity = self%kernel_viscosity()
      do iteration = 1, 60
         firmness = (self%kernel_integral(scale) + viscosity)/scale
         guess = self%elastic_time(firmness)
         if (abs(guess - scale) <= least*guess) exit
         scale = guess
      end do
      scale = guess
   end function time_scale

   !> Time scale of an elastic contact, T = (m/(k sqrt(v0)))^(2/5) for Hertz, with v0 + g T instead
   !> of v0 under gravity. Of v0 its size counts: a dent that recovers meets a sphere on its way up
   pure function elastic_time(self, firmness) result(time)
      class(impact_t), intent(in) :: self
      !> Firmness k of the contact [N/m^1.5], > 0
      real(wp), intent(in) :: firmness
      !> Time scale [s]
      real(wp) :: time

      real(wp) :: guess
      integer :: iteration

      time = self%law%time_scale(self%mass, firmness, abs(self%velocity))
      if (.not. self%gravity > 0.0_wp) return
      ! the map contracts by (n - 1)/(n + 1)
      do iteration = 1, 60
         guess = self%law%time_scale(self%mass, firmness, self%speed_scale(time))
         if (abs(guess - time) <= 1.0e-3_wp*guess) exit
         time = guess
      end do
      time = guess
   end function elastic_time

   !> Indentation that the first contact on a body at rest cannot exceed: as it grows, the force is
   !> at least k(oo) u, and u at least s^n, since a layer is stiffer than a half space. With the
   !> energies it is k(oo) s^(n+1)/(n+1) <= m v0^2/2 + m g s. Not of a true sphere, which is softer
   pure function deepest(self) result(s)
      class(impact_t), intent(in) :: self
      !> Indentation [m]; huge if the contact has no equilibrium modulus
      real(wp) :: s

      real(wp) :: firmness, n

      s = huge(1.0_wp)
      firmness = self%factor*self%modulus%rubbery()
      if (.not. firmness > 0.0_wp) return
      n = self%law%start_exponent
      s = (0.5_wp*(n + 1.0_wp)*self%mass/firmness*self%velocity**2)**(1.0_wp/(n + 1.0_wp))
      ! the larger one of two energies is at least half of their sum
      if (self%gravity > 0.0_wp) s = max(2.0_wp**(1.0_wp/(n + 1.0_wp))*s, &
         (2.0_wp*(n + 1.0_wp)*self%mass/firmness*self%gravity)**(1.0_wp/n))
   end function deepest

   !> Default time after which a contact counts as lasting: a thousand time scales, with the rubbery
   !> modulus if there is one, and of the sphere on a structure
   pure function lasting_time(self, time_scale) result(time)
      class(impact_t), intent(in) :: self
      !> Time scale T [s]
      real(wp), intent(in) :: time_scale
      !> Time [s]
      real(wp) :: time

      real(wp) :: firmness

      time = time_scale
      firmness = self%factor*self%modulus%rubbery()
      if (firmness > 0.0_wp) time = max(time, self%elastic_time(firmness))
      time = 1000.0_wp*max(time, self%target%structure%slowness(self%mass))
   end function lasting_time

   !> Whether the plate may move away from the sphere and be caught up with within one step,
   !> unnoticed: alpha grows during the step, and alpha I is a noticeable part of the distance
   !> covered
   elemental function may_part_unnoticed(self, alpha_before, alpha, impulse, time)
      class(impact_t), intent(in) :: self
      !> alpha at the start and at the end of the step [m/(N s)]
      real(wp), intent(in) :: alpha_before, alpha
      !> Impulse at the end of the step [N s]
      real(wp), intent(in) :: impulse
      !> End of the step [s]
      real(wp), intent(in) :: time
      logical :: may_part_unnoticed

      ! growth of alpha in a step that resolves it, and noticeable part of the distance: half and
      ! twice as much of the latter make six panels more and two fewer of 1118 in 109 random impacts
      real(wp), parameter :: resolved = 2.0_wp, noticeable = 0.3_wp

      may_part_unnoticed = alpha > resolved*alpha_before &
         .and. alpha*impulse > noticeable*self%free_path(time)
   end function may_part_unnoticed

   !> Whether the contact has an equilibrium modulus that pushes the bodies apart once all else has
   !> relaxed. For a fluid-like contact the COR is about its ratio to the mean modulus over the
   !> contact; it counts as zero below the rounding of the velocities
   pure function pushes_apart(self)
      class(impact_t), intent(in) :: self
      logical :: pushes_apart

      ! velocities are sums of hundreds of terms
      real(wp), parameter :: rounding = 1.0e-13_wp
      real(wp) :: time

      time = self%time_scale()
      pushes_apart = self%factor*self%modulus%rubbery()*time &
         > rounding*(self%kernel_integral(time) + self%kernel_viscosity())
   end function pushes_apart

   !> Zener's parameter lambda = alpha(0) m/T with T = (m/(k(0) sqrt(v0)))^(2/5); NaN for a kernel
   !> that is infinite or zero at t = 0, and for a plate that moves but is infinitely stiff then
   pure function inelasticity(self) result(lambda)
      class(impact_t), intent(in) :: self
      !> Parameter [-]
      real(wp) :: lambda

      real(wp) :: firmness

      lambda = unset
      if (self%target%moves() .and. .not. self%target%alpha(0.0_wp) > 0.0_wp) return
      firmness = self%factor*self%modulus%glassy()
      if (firmness > 0.0_wp .and. firmness <= huge(1.0_wp)) &
         lambda = self%target%alpha(0.0_wp)*self%mass &
         /self%law%time_scale(self%mass, firmness, self%velocity)
   end function inelasticity

   !> Zener's parameter with the moduli of the contact and the plate at a frequency, for kernels
   !> that are infinite at t = 0 too
   pure function inelasticity_at(self, frequency) result(lambda)
      class(impact_t), intent(in) :: self
      !> Frequency of the storage modulus [rad/s], > 0; the plate is taken at its inverse
      real(wp), intent(in) :: frequency
      !> Parameter [-]
      real(wp) :: lambda

      lambda = self%target%alpha_after(1.0_wp/frequency)*self%mass &
         /self%elastic_time(self%factor*real(self%modulus%dynamic_modulus(frequency), wp))
   end function inelasticity_at

   !> Kinetic energy of the sphere before the impact, m v0^2/2
   pure function initial_energy(self) result(energy)
      class(impact_t), intent(in) :: self
      !> Energy [J]
      real(wp) :: energy

      energy = 0.5_wp*self%mass*self%velocity**2
   end function initial_energy

end module vcor_impact_problem
