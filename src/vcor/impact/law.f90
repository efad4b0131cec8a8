!> Contact law: how the force follows the indentation s, through u(s) = s^n in
!>
!>     F(t) = int_0^t k(t - x) u'(x) dx,    k(t) = K E'(t)
!>
!> All that depends on the exponent n is asked of this object. A sphere has n = 3/2 (Hertz) and
!> K = (4/3) sqrt(R); a body of revolution z = C r^p has n = 1 + 1/p: I. N. Sneddon, Int. J. Eng.
!> Sci. 3 (1965) 47, doi:10.1016/0020-7225(65)90019-4. Units are written out for n = 3/2, such as
!> [m^1.5] for u and [N/m^1.5] for k.
!>
!> Past the end of an elastic contact s is negative and the force with it, so u is odd:
!> u(s) = s |s|^(n-1).
module vcor_impact_law
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_constants, only : pi
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   implicit none
   private

   public :: contact_law_t, new_contact_law

   !> Exponent of Hertz's contact of curved surfaces [-]
   real(wp), parameter :: hertz = 1.5_wp

   !> A contact law: by default Hertz's, its force the hereditary integral over all the past, which
   !> is exact while the contact grows; immutable once built
   type :: contact_law_t
      !> Exponent n of u = s^n [-], >= 1
      real(wp) :: exponent = hertz
      !> Duration of an elastic impact in units of `time_scale` [-]
      real(wp) :: contact_time = 3.2180654597190435_wp
      !> Whether the integral ends where the contact was as small as it is now and growing: exact
      !> while the contact shrinks too (T. C. T. Ting, J. Appl. Mech. 33 (1966) 845,
      !> doi:10.1115/1.3625192)
      logical :: receding = .false.
   contains
      !> u(s)
      procedure, non_overridable :: u
      !> du/ds
      procedure, non_overridable :: slope
      !> u/s
      procedure, non_overridable :: secant
      !> u/s at many indentations
      procedure, non_overridable :: secants
      !> Indentation at which motion and force agree
      procedure, non_overridable :: solve
      !> Time scale of an elastic impact
      procedure, non_overridable :: time_scale
   end type contact_law_t

contains

   !> Build the law of an exponent
   pure subroutine new_contact_law(self, exponent, receding, error)
      type(contact_law_t), intent(out) :: self
      !> Exponent n [-], >= 1: 3/2 for spheres, 2 for cones, 1 for flat punches
      real(wp), intent(in) :: exponent
      !> Whether the force of a shrinking contact is Ting's
      logical, intent(in) :: receding
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: part

      if (.not. ieee_is_finite(exponent)) then
         call raise(error, error_input, 'the exponent of a contact law must be a number')
      else if (exponent < 1.0_wp) then
         call raise(error, error_input, 'the exponent of a contact law must be at least 1')
      end if
      if (allocated(error)) return
      self%receding = receding
      if (.not. abs(exponent - hertz) > 0.0_wp) return
      ! twice the way to the largest indentation, where k s^(n+1)/(n+1) is the energy
      part = 1.0_wp/(exponent + 1.0_wp)
      self%exponent = exponent
      self%contact_time = 2.0_wp*(0.5_wp/part)**part &
         *sqrt(pi)*gamma(1.0_wp + part)/gamma(0.5_wp + part)
   end subroutine new_contact_law

   !> u(s) = s |s|^(n-1)
   elemental function u(self, s)
      class(contact_law_t), intent(in) :: self
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> u [m^1.5]
      real(wp) :: u

      u = s*self%secant(s)
   end function u

   !> du/ds = n |s|^(n-1)
   elemental function slope(self, s)
      class(contact_law_t), intent(in) :: self
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> Slope [m^0.5], >= 0
      real(wp) :: slope

      slope = self%exponent*self%secant(s)
   end function slope

   !> u/s = |s|^(n-1); for Hertz by a square root, which costs a tenth of a power
   elemental function secant(self, s)
      class(contact_law_t), intent(in) :: self
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> u/s [m^0.5], >= 0
      real(wp) :: secant

      if (abs(self%exponent - hertz) > 0.0_wp) then
         secant = abs(s)**(self%exponent - 1.0_wp)
      else
         secant = sqrt(abs(s))
      end if
   end function secant

   !> u/s at many indentations in one call, for inner loops: u is s times it, the slope n times it
   pure subroutine secants(self, n, s, secant)
      class(contact_law_t), intent(in) :: self
      !> Number of indentations
      integer, intent(in) :: n
      !> Indentations [m]
      real(wp), intent(in) :: s(n)
      !> u/s [m^0.5], >= 0
      real(wp), intent(out) :: secant(n)

      if (abs(self%exponent - hertz) > 0.0_wp) then
         secant = abs(s)**(self%exponent - 1.0_wp)
      else
         secant = sqrt(abs(s))
      end if
   end subroutine secants

   !> Solve s + c u(s) + d u(s)^2 = r by Newton's method for y = sqrt(|s|), which is u/s for Hertz:
   !> no iteration waits for a root
   pure subroutine solve(self, c, d, r, guess, s, secant)
      class(contact_law_t), intent(in) :: self
      !> Coefficient [m^-0.5], >= 0
      real(wp), intent(in) :: c
      !> Coefficient [m^-2], small
      real(wp), intent(in) :: d
      !> Right-hand side [m]
      real(wp), intent(in) :: r
      !> Guess at s [m]
      real(wp), intent(in) :: guess
      !> Indentation [m]
      real(wp), intent(out) :: s
      !> u/s there [m^0.5]
      real(wp), intent(out) :: secant

      real(wp), parameter :: least_guess = 1.0e-3_wp
      real(wp) :: e, y, u, correction
      integer :: iteration

      s = 0.0_wp
      secant = self%secant(s)
      if (.not. abs(r) > 0.0_wp) return
      ! with d = 0 the root lies below sqrt(|r|), and from above Newton's method descends to it
      e = sign(d, r)
      y = sqrt(abs(r))
      ! from far below, next to zero, the first step would leave the range of the numbers
      if (abs(guess) > 0.0_wp) y = min(y, max(sqrt(abs(guess)), least_guess*y))
      do iteration = 1, 60
         secant = y
         if (abs(self%exponent - hertz) > 0.0_wp) secant = y**(2.0_wp*self%exponent - 2.0_wp)
         s = y*y
         u = s*secant
         correction = ((s - abs(r)) + u*(c + e*u)) &
            /(2.0_wp*(y + self%exponent*secant*y*(c + 2.0_wp*e*u)))
         y = y - correction
         ! what is left is about its square
         if (abs(correction) <= 1.0e-9_wp*y) exit
      end do
      s = sign(y*y, r)
      secant = self%secant(s)
   end subroutine solve

   !> Time scale T = (m/(k v0^(n-1)))^(1/(n+1)) of the impact on an elastic contact, F = k u
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

      time = (mass/(firmness*self%secant(velocity)))**(1.0_wp/(self%exponent + 1.0_wp))
   end function time_scale

end module vcor_impact_law
