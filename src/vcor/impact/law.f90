!> Contact law: the force as a function of the history of the indentation s, by way of u(s) = s^n,
!>
!>     F(t) = int_0^t k(t - x) u'(x) dx,    k(t) = K E'(t)
!>
!> All that depends on u is in this module. A sphere has n = 3/2 (Hertz). A body of
!> revolution z = C r^p has n = 1 + 1/p and, with kappa = sqrt(pi) Gamma(p/2 + 1)/Gamma((p + 1)/2)
!> (L. A. Galin 1946; I. N. Sneddon, Int. J. Eng. Sci. 3 (1965) 47,
!> doi:10.1016/0020-7225(65)90019-4),
!>
!>     s = C kappa a^p,   F = 2 p/(p + 1) E' a s,   K = 2 p/(p + 1) (C kappa)^(-1/p)
!>
!> with the contact radius a; p = 1 is a cone, a flat punch has n = 1. For all shapes a = K u'(s)/2:
!> an increment of s acts like a flat punch of radius a. Units are given for n = 3/2, such as
!> [m^1.5] for u and [N/m^1.5] for k. Beyond the end of an elastic contact s and the force are
!> negative, so u is continued as an odd function, u(s) = s |s|^(n-1).
!>
!> A layer on a rigid base, and the sphere itself in place of its paraboloid, have a table of u in
!> place of the power (`vcor_impact_layer_law`); K remains that of the half space and of Hertz, so
!> that u ~ s^n as s -> 0. It holds dF/ds = 2 E' S with the punch stiffness S in place of a, and the
!> force follows from u(s) as on the half space, Ting's rule included.
module vcor_impact_law
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_law_table, only : law_table_t
   use vcor_kinds, only : pi, wp
   use vcor_tuning, only : most_iterations
   implicit none
   private

   public :: contact_law_t, new_contact_law, sphere_factor, cone_factor, punch_factor, &
      profile_factor

   !> Exponent of Hertzian contact of curved surfaces [-]
   real(wp), parameter :: hertz = 1.5_wp
   !> Relative change after which Newton's method needs no other iteration: the method squares it,
   !> so that the next one is below the rounding of 1e-16
   real(wp), parameter :: close = 1.0e-9_wp

   !> A contact law, by default Hertz's with the hereditary integral over all the past, which is
   !> exact while the contact grows; immutable once built
   type :: contact_law_t
      !> Exponent n of u ~ s^n as s -> 0, at first contact and where a contact ends [-], >= 1
      real(wp) :: start_exponent = hertz
      !> Duration of an elastic impact in units of `time_scale` [-]
      real(wp) :: contact_time = 3.2180654597190435_wp
      !> Largest indentation of an elastic impact divided by velocity times `time_scale`,
      !> ((n + 1)/2)^(1/(n + 1)) [-]
      real(wp) :: depth = 1.0933620739432781_wp
      !> Whether the integral ends at the time when the growing contact was as small as now: exact
      !> while the contact shrinks, too (T. C. T. Ting, J. Appl. Mech. 33 (1966) 845,
      !> doi:10.1115/1.3625192)
      logical :: receding = .false.
      !> Ratio of u to s^n, up to several contact radii, those that were needed
      type(law_table_t), allocatable, private :: table(:)
      !> Which of them is in use; 0: none, the ratio is 1
      integer, private :: level = 0
      !> Numbers that the tables are for, the first one the base
      real(wp), private :: about(6) = 0.0_wp
      !> Unit of length of the table [m], and half-space contact radius in it divided by s^(n-1)
      !> [m^(1-n)]
      real(wp), private :: length = 0.0_wp, scale = 0.0_wp
      !> Radius of a true sphere [m]; 0: another body, the sphere as a paraboloid
      real(wp), private :: sphere = 0.0_wp
   contains
      procedure, non_overridable :: u
      procedure, non_overridable :: slope
      procedure, non_overridable :: secant
      procedure, non_overridable :: evaluate
      procedure, non_overridable :: inverse
      procedure, non_overridable :: radius
      procedure, non_overridable :: half_space_radius
      procedure, non_overridable :: profile
      procedure, non_overridable :: solve
      procedure, non_overridable :: time_scale
      procedure, non_overridable :: has
      procedure, non_overridable :: is_of_layer
      procedure, non_overridable :: adopt
      procedure, non_overridable :: resize
      procedure, non_overridable :: stiffening
      procedure, non_overridable :: deepest
   end type contact_law_t

contains

   !> Build the law for an exponent
   pure subroutine new_contact_law(self, exponent, receding, error)
      type(contact_law_t), intent(out) :: self
      !> Exponent n [-], >= 1: 3/2 for spheres, 2 for cones, 1 for flat punches
      real(wp), intent(in) :: exponent
      !> Whether the force of a shrinking contact follows Ting
      logical, intent(in) :: receding
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: part

      if (.not. ieee_is_finite(exponent)) then
         call raise(error, error_input, 'the exponent of a contact law must be a number')
      else if (exponent < 1.0_wp) then
         call raise(error, error_input, 'the exponent of a contact law must be at least 1')
      else if (receding .and. .not. exponent > 1.0_wp) then
         call raise(error, error_input, 'the contact of a flat punch has one radius and does not ' &
            //"recede: law = 'boltzmann' is exact for it", about='law shape')
      end if
      if (allocated(error)) return
      self%receding = receding
      if (.not. abs(exponent - hertz) > 0.0_wp) return
      ! twice the time to the largest indentation, from the elastic energy k s^(n+1)/(n+1)
      part = 1.0_wp/(exponent + 1.0_wp)
      self%start_exponent = exponent
      self%depth = (0.5_wp/part)**part
      self%contact_time = 2.0_wp*self%depth &
         *sqrt(pi)*gamma(1.0_wp + part)/gamma(0.5_wp + part)
   end subroutine new_contact_law

   !> Factor K of a sphere, (4/3) sqrt(R) with 1/R = 1/r + 1/r_surface, footnote 2 of Green's paper
   pure subroutine sphere_factor(radius, surface_radius, factor, error)
      !> Radius of the sphere r [m], > 0
      real(wp), intent(in) :: radius
      !> Radius of curvature of the plate at the contact [m]: 0 = flat, negative = concave
      real(wp), intent(in) :: surface_radius
      !> K [m^0.5]
      real(wp), intent(out) :: factor
      type(error_t), allocatable, intent(out) :: error

      factor = 0.0_wp
      if (.not. radius > 0.0_wp) then
         call raise(error, error_input, 'the radius of the sphere must be positive', &
            about='radius')
      else if (.not. ieee_is_finite(surface_radius)) then
         call raise(error, error_input, 'the radius of the surface must be a number, 0 where it ' &
            //'is flat', about='surface_radius')
      else if (surface_radius < 0.0_wp .and. abs(surface_radius) <= radius) then
         call raise(error, error_input, &
            'a concave surface must have a larger radius than the sphere, or Hertz does not ' &
            //'apply', about='surface_radius radius')
      else if (abs(surface_radius) > 0.0_wp) then
         factor = 4.0_wp/3.0_wp*sqrt(radius/(1.0_wp + radius/surface_radius))
      else
         factor = 4.0_wp/3.0_wp*sqrt(radius)
      end if
   end subroutine sphere_factor

   !> Factor K of a cone, n = 2
   pure function cone_factor(half_angle) result(factor)
      !> Angle between axis and side [deg], in (0, 90)
      real(wp), intent(in) :: half_angle
      !> K [-]
      real(wp) :: factor

      factor = 2.0_wp/pi*tan(half_angle*(pi/180.0_wp))
   end function cone_factor

   !> Factor K of a flat punch, n = 1
   pure function punch_factor(radius) result(factor)
      !> Radius [m], > 0
      real(wp), intent(in) :: radius
      !> K [m]
      real(wp) :: factor

      factor = 2.0_wp*radius
   end function punch_factor

   !> Factor K of a profile z = C r^p, n = 1 + 1/p
   pure function profile_factor(coefficient, power) result(factor)
      !> C [m^(1-p)], > 0
      real(wp), intent(in) :: coefficient
      !> p [-], >= 1
      real(wp), intent(in) :: power
      !> K [m^(2-n)]
      real(wp) :: factor

      real(wp) :: log_kappa

      log_kappa = 0.5_wp*log(pi) + log_gamma(0.5_wp*power + 1.0_wp) &
         - log_gamma(0.5_wp*(power + 1.0_wp))
      factor = 2.0_wp*power/(power + 1.0_wp)*exp(-(log(coefficient) + log_kappa)/power)
   end function profile_factor

   !> Whether the law has a table for given numbers
   pure function has(self, about, level)
      class(contact_law_t), intent(in) :: self
      !> The numbers
      real(wp), intent(in) :: about(6)
      !> Which table
      integer, intent(in) :: level
      logical :: has

      has = allocated(self%table) .and. .not. any(abs(about - self%about) > 0.0_wp)
      if (has) has = self%table(level)%reach > 0.0_wp
   end function has

   !> Whether the law is that of a layer on a base
   pure function is_of_layer(self)
      class(contact_law_t), intent(in) :: self
      logical :: is_of_layer

      ! the first number is the base, 0 for a half space
      is_of_layer = self%level > 0 .and. self%about(1) > 0.0_wp
   end function is_of_layer

   !> Take a table, and forget those for other numbers
   pure subroutine adopt(self, table, about, level, levels)
      class(contact_law_t), intent(inout) :: self
      type(law_table_t), intent(in) :: table
      !> Numbers that it is for
      real(wp), intent(in) :: about(6)
      !> Which one it is, and how many there may be
      integer, intent(in) :: level, levels

      if (allocated(self%table)) then
         if (any(abs(about - self%about) > 0.0_wp)) deallocate (self%table)
      end if
      if (.not. allocated(self%table)) allocate (self%table(levels))
      self%table(level) = table
      self%about = about
   end subroutine adopt

   !> Use a table, and set the size of what it describes
   pure subroutine resize(self, level, factor, length, sphere)
      class(contact_law_t), intent(inout) :: self
      !> Which table
      integer, intent(in) :: level
      !> Factor K of the shape [m^(2-n)]
      real(wp), intent(in) :: factor
      !> Unit of length of the table [m]
      real(wp), intent(in) :: length
      !> Radius of a true sphere [m]; 0: another body
      real(wp), intent(in) :: sphere

      self%level = level
      self%length = length
      self%scale = self%half_space_radius(factor, 1.0_wp)/length
      self%sphere = sphere
   end subroutine resize

   !> u(s), odd
   elemental function u(self, s)
      class(contact_law_t), intent(in) :: self
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> u [m^1.5]
      real(wp) :: u

      u = s*self%secant(s)
   end function u

   !> du/ds, n |s|^(n-1) for a power
   elemental function slope(self, s)
      class(contact_law_t), intent(in) :: self
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> Slope [m^0.5], >= 0
      real(wp) :: slope

      real(wp) :: value(1), at(1)

      call self%evaluate(1, [s], value, at)
      slope = at(1)
   end function slope

   !> u/s, |s|^(n-1) for a power
   elemental function secant(self, s)
      class(contact_law_t), intent(in) :: self
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> u/s [m^0.5], >= 0
      real(wp) :: secant

      real(wp) :: value(1), at(1)

      call self%evaluate(1, [s], value, at)
      secant = value(1)
   end function secant

   !> u/s and du/ds at many indentations, for inner loops: u = s (u/s). For Hertz the power is a
   !> square root, which costs a tenth of it
   pure subroutine evaluate(self, n, s, secant, slope)
      class(contact_law_t), intent(in) :: self
      !> Number of indentations
      integer, intent(in) :: n
      !> Indentations [m]
      real(wp), intent(in) :: s(n)
      !> u/s [m^0.5], >= 0
      real(wp), intent(out) :: secant(n)
      !> du/ds [m^0.5], >= 0
      real(wp), intent(out) :: slope(n)

      real(wp) :: ratio, rise
      integer :: i

      if (abs(self%start_exponent - hertz) > 0.0_wp) then
         secant = abs(s)**(self%start_exponent - 1.0_wp)
      else
         secant = sqrt(abs(s))
      end if
      slope = self%start_exponent*secant
      if (self%level == 0) return
      do i = 1, n
         call self%table(self%level)%stiffening(self%scale*secant(i), ratio, rise)
         slope(i) = slope(i)*ratio + (self%start_exponent - 1.0_wp)*secant(i)*rise
         secant(i) = secant(i)*ratio
      end do
   end subroutine evaluate

   !> Indentation at which u has a given value
   elemental function inverse(self, u) result(s)
      class(contact_law_t), intent(in) :: self
      !> u [m^1.5], >= 0
      real(wp), intent(in) :: u
      !> Indentation [m]
      real(wp) :: s

      real(wp) :: secant(1), slope(1), ratio
      integer :: iteration

      s = u**(1.0_wp/self%start_exponent)
      if (.not. (self%level > 0 .and. s > 0.0_wp)) return
      ! Newton's method for the logarithms, in which u is nearly a straight line
      do iteration = 1, most_iterations
         call self%evaluate(1, [s], secant, slope)
         ratio = u/(s*secant(1))
         s = s*ratio**(secant(1)/slope(1))
         if (abs(ratio - 1.0_wp) <= close) exit
      end do
   end function inverse

   !> Contact radius, for a power a = K u'(s)/2: an increment of s acts like a flat punch of this
   !> radius
   elemental function radius(self, factor, s)
      class(contact_law_t), intent(in) :: self
      !> Factor K of the shape [m^(2-n)]
      real(wp), intent(in) :: factor
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> Contact radius [m]
      real(wp) :: radius

      real(wp) :: x

      if (self%level > 0) then
         x = self%scale*abs(s)**(self%start_exponent - 1.0_wp)
         radius = self%length*x*self%table(self%level)%widening(x)
      else
         radius = 0.5_wp*factor*self%slope(s)
      end if
   end function radius

   !> Contact radius on a half space, K n s^(n-1)/2
   elemental function half_space_radius(self, factor, s) result(radius)
      class(contact_law_t), intent(in) :: self
      !> Factor K of the shape [m^(2-n)]
      real(wp), intent(in) :: factor
      !> Indentation [m], >= 0
      real(wp), intent(in) :: s
      !> Radius [m]
      real(wp) :: radius

      radius = 0.5_wp*factor*self%start_exponent*s**(self%start_exponent - 1.0_wp)
   end function half_space_radius

   !> Force divided by that on a half space at the same indentation, if the law is that of a layer
   pure function stiffening(self, s) result(ratio)
      class(contact_law_t), intent(in) :: self
      !> Indentation [m], > 0
      real(wp), intent(in) :: s
      !> Ratio [-]
      real(wp) :: ratio

      real(wp) :: rise, x
      integer :: iteration

      ratio = 1.0_wp
      if (self%level == 0) return
      call self%table(self%level)%stiffening( &
         self%scale*s**(self%start_exponent - 1.0_wp), ratio, rise)
      if (.not. self%sphere > 0.0_wp) return
      ! on a half space s = a x and F/E' = (R^2 + a^2) x - R a with x = atanh(a/R)
      x = sqrt(s/self%sphere)
      do iteration = 1, most_iterations
         rise = (self%sphere*x*tanh(x) - s)/(self%sphere*(tanh(x) + x/cosh(x)**2))
         x = x - rise
         if (abs(rise) <= close*x) exit
      end do
      ratio = ratio*4.0_wp/3.0_wp*(s/self%sphere)**hertz/((1.0_wp + tanh(x)**2)*x - tanh(x))
   end function stiffening

   !> Largest indentation up to which the law is known
   elemental function deepest(self) result(s)
      class(contact_law_t), intent(in) :: self
      !> Indentation [m]
      real(wp) :: s

      s = huge(1.0_wp)
      if (self%level == 0) return
      if (self%start_exponent > 1.0_wp) then
         s = (self%table(self%level)%reach/self%scale)**(1.0_wp/(self%start_exponent - 1.0_wp))
      else if (self%scale > self%table(self%level)%reach) then
         s = 0.0_wp
      end if
   end function deepest

   !> Profile h(x) of the body in the method of dimensionality reduction: it touches the half space
   !> up to x at the indentation h(x), x^2/R for a sphere. Flat for a punch, whose radius is K/2. A
   !> true sphere has none beyond its radius, but as many times that as no contact reaches
   elemental function profile(self, factor, x) result(h)
      class(contact_law_t), intent(in) :: self
      !> Factor K of the shape [m^(2-n)]
      real(wp), intent(in) :: factor
      !> Distance from the axis [m], >= 0
      real(wp), intent(in) :: x
      !> Profile [m]
      real(wp) :: h

      h = 0.0_wp
      if (self%sphere > 0.0_wp) then
         h = x*atanh(min(x/self%sphere, nearest(1.0_wp, -1.0_wp)))
      else if (self%start_exponent > 1.0_wp) then
         h = (2.0_wp*x/(self%start_exponent*factor)) &
            **(1.0_wp/(self%start_exponent - 1.0_wp))
      end if
   end function profile

   !> Solve s + c u(s) + d u(s)^2 = r by Newton's method for y = sqrt(|s|), which is u/s for Hertz,
   !> so that no iteration takes a root
   pure subroutine solve(self, c, d, r, guess, s)
      class(contact_law_t), intent(in) :: self
      !> Coefficient [m^-0.5], >= 0
      real(wp), intent(in) :: c
      !> Coefficient [m^-2], small
      real(wp), intent(in) :: d
      !> Right-hand side [m]
      real(wp), intent(in) :: r
      !> Guess of s [m]
      real(wp), intent(in) :: guess
      !> Indentation [m]
      real(wp), intent(out) :: s

      ! part of the largest possible root: a guess of it takes one step up to 500 times the root,
      ! and nine that halve the distance
      real(wp), parameter :: least_guess = 1.0e-3_wp
      real(wp) :: e, y, u, correction, secant(1), slope(1)
      integer :: iteration

      s = 0.0_wp
      if (.not. abs(r) > 0.0_wp) return
      ! with d = 0 the root y is below sqrt(|r|), and Newton's method descends to it monotonically
      e = sign(d, r)
      y = sqrt(abs(r))
      ! from a guess too close to zero the first step would overflow
      if (abs(guess) > 0.0_wp) y = min(y, max(sqrt(abs(guess)), least_guess*y))
      do iteration = 1, most_iterations
         s = y*y
         if (self%level > 0 .or. abs(self%start_exponent - hertz) > 0.0_wp) then
            call self%evaluate(1, [s], secant, slope)
         else
            secant = y
            slope = hertz*y
         end if
         u = s*secant(1)
         correction = ((s - abs(r)) + u*(c + e*u)) &
            /(2.0_wp*y*(1.0_wp + slope(1)*(c + 2.0_wp*e*u)))
         y = y - correction
         ! the remaining error is about the square of the correction
         if (abs(correction) <= close*y) exit
      end do
      s = sign(y*y, r)
   end subroutine solve

   !> Time scale T = (m/(k v0^(n-1)))^(1/(n+1)) of an impact on an elastic contact, F = k u. With a
   !> table it is that of the power by which u grows at the largest indentation
   pure function time_scale(self, mass, firmness, velocity) result(time)
      class(contact_law_t), intent(in) :: self
      !> Mass [kg], > 0
      real(wp), intent(in) :: mass
      !> Firmness k of the contact [N/m^1.5], > 0
      real(wp), intent(in) :: firmness
      !> Velocity of approach v0 [m/s], > 0
      real(wp), intent(in) :: velocity
      !> Time scale [s]
      real(wp) :: time

      real(wp) :: s, secant(1), slope(1), ratio
      integer :: iteration

      time = (mass/(firmness*velocity**(self%start_exponent - 1.0_wp))) &
         **(1.0_wp/(self%start_exponent + 1.0_wp))
      if (self%level == 0) return
      ! the energy m v0^2/2 = k int u ds, and int u ds of this power
      s = self%depth*velocity*time
      do iteration = 1, most_iterations
         call self%evaluate(1, [s], secant, slope)
         ratio = 0.5_wp*mass*velocity**2*(1.0_wp + slope(1)/secant(1)) &
            /(firmness*s*s*secant(1))
         s = s*ratio**(1.0_wp/(1.0_wp + slope(1)/secant(1)))
         if (abs(ratio - 1.0_wp) <= close) exit
      end do
      time = s/(self%depth*velocity)
   end function time_scale

end module vcor_impact_law
