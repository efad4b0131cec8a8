!> Mittag-Leffler functions E_{a,b}(-u) for 0 < a <= 1 and u >= 0, with a relative error of a few
!> units in the 15th digit
!>
!> Along any contour that comes from minus infinity below the negative real axis and returns above
!> it, with the branch cut of powers on that axis,
!>
!>     E_{a,b}(-u) = 1/(2 pi i) int exp(w) w^(a-b)/(w^a + u) dw.
!>
!> With the rule of `vcor_numeric_contour` the integral converges exponentially, whatever u: see for
!> these functions Garrappa, SIAM J. Numer. Anal. 53 (2015) 1350. The nodes w do not depend on u, so
!> their powers and exponentials are computed once.
!>
!> Evaluated directly, the integral loses digits for large u, where E_{a,1}(-u) ~ 1/(u Gamma(1 - a))
!> is small for a near 1. What cancels is the integrand for a = 1, whose integral is known:
!>
!>     1/(2 pi i) int exp(w) [w^(a-1)/(w^a + u) - 1/(w + u)] dw = E_a(-u) - exp(-u),
!>
!> The bracket is u (w^(a-1) - 1)/((w^a + u)(w + u)), in which w^(a-1) - 1, of the order of 1 - a,
!> is computed without a difference.
module vcor_numeric_mittag_leffler
   use vcor_kinds, only : wp
   use vcor_numeric_contour, only : contour_rule, n => contour_nodes
   implicit none
   private

   public :: mittag_leffler_rule_t, new_mittag_leffler_rule

   !> Rule for one exponent a
   type :: mittag_leffler_rule_t
      private
      !> Exponent a
      real(wp) :: exponent = 1.0_wp
      !> Nodes w, real and imaginary part, shape (n, 2)
      real(wp) :: w(n, 2) = 0.0_wp
      !> w^a
      real(wp) :: power(n, 2) = 0.0_wp
      !> w^(a+1)
      real(wp) :: product(n, 2) = 0.0_wp
      !> Weights exp(w) dw/pi times w^(a-1) - 1
      real(wp) :: weight(n, 2) = 0.0_wp
      !> Weights exp(w) dw/pi times w^(a-2)
      real(wp) :: mean_weight(n, 2) = 0.0_wp
   contains
      procedure :: value
      procedure :: slope
      procedure :: mean
   end type mittag_leffler_rule_t

contains

   !> Build the rule for an exponent
   pure function new_mittag_leffler_rule(exponent) result(self)
      !> Exponent a, 0 < a <= 1, not checked
      real(wp), intent(in) :: exponent
      type(mittag_leffler_rule_t) :: self

      complex(wp) :: w(n), weight(n), half, power, difference
      integer :: k

      self%exponent = exponent
      call contour_rule(w, weight)
      do k = 1, n
         power = exp(exponent*log(w(k)))
         ! exp(2 z) - 1 = 2 sinh(z) exp(z)
         half = -0.5_wp*(1.0_wp - exponent)*log(w(k))
         difference = 2.0_wp*sinh(half)*exp(half)
         self%w(k, :) = parts(w(k))
         self%power(k, :) = parts(power)
         self%product(k, :) = parts(w(k)*power)
         self%weight(k, :) = parts(weight(k)*difference)
         self%mean_weight(k, :) = parts(weight(k)*power/w(k)**2)
      end do
   end function new_mittag_leffler_rule

   !> Real and imaginary part
   pure function parts(z)
      !> Number
      complex(wp), intent(in) :: z
      real(wp) :: parts(2)

      parts = [real(z, wp), aimag(z)]
   end function parts

   !> E_a(-u), which falls from 1 to 0: exp(-u) for a = 1, 1/(1 + u) in the limit a = 0
   elemental function value(self, u) result(y)
      class(mittag_leffler_rule_t), intent(in) :: self
      !> Argument, >= 0 and finite
      real(wp), intent(in) :: u
      !> Value, in [0, 1]
      real(wp) :: y

      real(wp) :: f, g, p(2), term(n)
      integer :: k

      ! numerator and denominator are divided by powers of 1 + u: no u overflows
      f = 1.0_wp/(1.0_wp + u)
      g = u*f
      do k = 1, n
         p = denominator(self%w(k, :), self%power(k, :), f, g)
         term(k) = (self%weight(k, 2)*p(1) - self%weight(k, 1)*p(2))/(p(1)**2 + p(2)**2)
      end do
      y = exp(-u) + f*g*sum(term)
   end function value

   !> u E_{a,a}(-u) = -x d/dx E_a(-x^a), u = x^a, from the derivative of the integral of `value` by
   !> u. In
   !>
   !>     u/(w^a + u)^2 w^(a-1) - u/(w + u)^2 = (w^(a-1) - 1)(u^2 - w^(a+1)) u/((w^a + u)(w + u))^2
   !>
   !> nothing cancels either, and the factor a = `exponent` preserves relative accuracy for small a
   elemental function slope(self, u) result(y)
      class(mittag_leffler_rule_t), intent(in) :: self
      !> Argument, >= 0 and finite
      real(wp), intent(in) :: u
      !> Value, >= 0
      real(wp) :: y

      real(wp) :: f, g, p(2), q(2), z(2), term(n)
      integer :: k

      f = 1.0_wp/(1.0_wp + u)
      g = u*f
      do k = 1, n
         p = denominator(self%w(k, :), self%power(k, :), f, g)
         p = [p(1)**2 - p(2)**2, 2.0_wp*p(1)*p(2)]
         q = [g**2 - f**2*self%product(k, 1), -f**2*self%product(k, 2)]
         z = [self%weight(k, 1)*q(1) - self%weight(k, 2)*q(2), &
            self%weight(k, 1)*q(2) + self%weight(k, 2)*q(1)]
         term(k) = (z(2)*p(1) - z(1)*p(2))/(p(1)**2 + p(2)**2)
      end do
      y = self%exponent*(u*exp(-u) + f*g*sum(term))
   end function slope

   !> E_{a,2}(-u), the mean of E_a(-x^a) from 0 to x with u = x^a. It falls like 1/u, and its
   !> integral loses no digits
   elemental function mean(self, u) result(y)
      class(mittag_leffler_rule_t), intent(in) :: self
      !> Argument, >= 0 and finite
      real(wp), intent(in) :: u
      !> Value, in [0, 1]
      real(wp) :: y

      real(wp) :: f, g, p(2), term(n)
      integer :: k

      f = 1.0_wp/(1.0_wp + u)
      g = u*f
      do k = 1, n
         p = [f*self%power(k, 1) + g, f*self%power(k, 2)]
         term(k) = (self%mean_weight(k, 2)*p(1) - self%mean_weight(k, 1)*p(2))/(p(1)**2 + p(2)**2)
      end do
      y = f*sum(term)
   end function mean

   !> (f w^a + g)(f w + g)
   pure function denominator(w, power, f, g) result(p)
      !> Node w, real and imaginary part
      real(wp), intent(in) :: w(2)
      !> w^a
      real(wp), intent(in) :: power(2)
      !> Factor f
      real(wp), intent(in) :: f
      !> Addend g
      real(wp), intent(in) :: g
      !> Product, real and imaginary part
      real(wp) :: p(2)

      p = [(f*power(1) + g)*(f*w(1) + g) - f**2*power(2)*w(2), &
         f*(power(2)*(f*w(1) + g) + w(2)*(f*power(1) + g))]
   end function denominator

end module vcor_numeric_mittag_leffler
