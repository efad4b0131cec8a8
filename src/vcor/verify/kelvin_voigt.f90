!> Laws of the viscoelastic sphere of Kelvin and Voigt for the verification table
!>
!> A spring beside a dashpot, F = k (u + A u') with A = viscosity/modulus, is the contact of
!> Kuwabara and Kono (1987) and Brilliantov et al. (1996), F = k (s^1.5 + 3/2 A sqrt(s) s'). In
!> units of T = (m/(k sqrt(v0)))^(2/5) and v0 T the impact is
!>
!>     x'' + b sqrt(x) x' + x^1.5 = 0,   x(0) = 0,  x'(0) = 1,   b = (3/2) A/T ~ v0^(1/5)
!>
!> and ends where x'' = 0, that is F = 0 (Schwager and Poeschel 2008), at x = -b x' > 0.
!>
!> Zener's elastic plate obeys the same equation with b = (3/2) lambda; there F is the spring's
!> force alone and the contact ends at x = 0. Between the two ends w = -x' obeys
!> dw/dx = b sqrt(x) - x^1.5/w. With w = e y and x = b e xi, e being the restitution at x = 0,
!>
!>     dy/dxi = p (sqrt(xi) - xi^1.5/y),   y(0) = 1,   p = b^(5/2) sqrt(e),
!>
!> so the two restitutions are related by Y(p) = y at xi = y,
!>
!>     e_F=0 = e_s=0 Y(p),   Y = 1 + 4/15 p + 13/150 p^2 + 4897/160875 p^3 + ...
!>
!> With sqrt(x) as the variable and dt = sqrt(x) dsigma the equation is polynomial. So e_s=0 is
!> analytic in b and e_F=0 in sqrt(b), and the coefficients of the series are those of the first
!> one, 1 - C b + (3/5) C^2 b^2 + ..., with those of Y. C = (4/5) (5/4)^(3/5) B(3/5, 3/2) is the
!> work of the dashpot along Hertz's impact; from b^3 on they are fitted to solutions in 50 digits
!> (tests/reference/make_kelvin_voigt.py).
module vcor_verify_kelvin_voigt
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_plate, only : waves_constant
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_verify_methods, only : methods_for
   use vcor_verify_impacts, only : elastic, hertz_scale, kelvin_voigt, strike, &
      zener_plate
   use vcor_verify_row, only : accuracy_of, law_t
   implicit none
   private

   public :: series, pade, exact, zener_relation

   !> Modulus of the spring [Pa]; in units of T nothing depends on it
   real(wp), parameter :: modulus = 15.0e6_wp
   !> C = (4/5) (5/4)^(3/5) B(3/5, 3/2) = 1.1534488580952888
   real(wp), parameter :: c = 0.8_wp*1.25_wp**0.6_wp*gamma(0.6_wp)*gamma(1.5_wp)/gamma(2.1_wp)
   !> Coefficients of sqrt(b)^n, n = 0 .. 10
   real(wp), parameter :: coefficient(0:10) = [1.0_wp, 0.0_wp, -c, 0.0_wp, 0.6_wp*c**2, &
      4.0_wp/15.0_wp, -0.5228825680884149639_wp, -0.4_wp*c, 0.34874267526038503473_wp, &
      1.275_wp*c**2*4.0_wp/15.0_wp, -0.23309813201924440033_wp + 13.0_wp/150.0_wp]
   !> Coefficients of p^n in Y(p), n = 0 .. 6
   real(wp), parameter :: ends(0:6) = [1.0_wp, 4.0_wp/15.0_wp, 13.0_wp/150.0_wp, &
      4897.0_wp/160875.0_wp, 453263.0_wp/40540500.0_wp, 4.23002985517994e-3_wp, &
      1.63464708309717e-3_wp]

contains

   !> The series of Schwager and Poeschel in powers of v0^(1/10), for weak dashpots: three speeds,
   !> one material. What is left out begins with b^(11/2) and a coefficient below 1. Cut after
   !> b^(7/2) the series leaves a remainder whose order, from b and b/2, is 4 and what the next two
   !> terms add to it
   subroutine series(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: velocity(3) = [0.01_wp, 1.0_wp, 100.0_wp]
      character(len=*), parameter :: name(3) = [character(len=24) :: 'cor at 0.01 m/s', &
         'cor at 1 m/s', 'cor at 100 m/s']
      ! b at 1 m/s, and the larger b of the two that show the order of the remainder
      real(wp), parameter :: damping = 0.04_wp, larger = 0.02_wp
      real(wp), parameter :: bend(2) = [coefficient(9), coefficient(10)]/coefficient(8)
      character(len=*), parameter :: why = &
         'accuracy asked for, and the first term left out, b^5.5'
      type(impact_t) :: impact, two(2)
      character(len=6) :: methods(2)
      real(wp) :: b, scale, order, order_tolerance
      integer :: i, j

      call law%begin('Weak Kelvin-Voigt contact, F = 0 at the end: series in v0^(1/10)', &
         'T. Schwager, T. Poeschel, Phys. Rev. E 78 (2008) 051304; coefficients recomputed')
      call strike(impact, law%error, elastic(modulus), velocity=1.0_wp)
      if (allocated(law%error)) return
      scale = hertz_scale(impact)
      do i = 1, size(velocity)
         b = damping*velocity(i)**0.2_wp
         call strike(impact, law%error, kelvin_voigt(modulus, damping/1.5_wp*scale*modulus), &
            velocity=velocity(i))
         if (allocated(law%error)) return
         methods = methods_for()
         do j = 1, size(methods)
            call law%add(trim(name(i)), methods(j), polynomial(coefficient, sqrt(b)), &
               accuracy_of(methods(j)) + b**5.5_wp, why, impact)
         end do
      end do

      call damped(law, larger, two(1))
      call damped(law, 0.5_wp*larger, two(2))
      if (allocated(law%error)) return
      b = larger
      order = 4.0_wp + log((1.0_wp + bend(1)*sqrt(b) + bend(2)*b) &
         /(1.0_wp + bend(1)*sqrt(0.5_wp*b) + bend(2)*0.5_wp*b))/log(2.0_wp)
      ! the accuracy over the smaller remainder, and the term of relative order b^1.5
      order_tolerance = (accuracy_of('ive')/(coefficient(8)*(0.5_wp*b)**4) + b**1.5_wp)/log(2.0_wp)
      call law%add_measure('order of the remainder', 'ive', order, order_tolerance, &
         'accuracy asked for over the remainder, and the term of relative order b^1.5', &
         [larger, 0.5_wp*larger], two, order_of_remainder)
   end subroutine series

   !> The Pade approximant [1/4] in sqrt(b) of Mueller and Poeschel. It is made of the series up to
   !> b^(5/2), so its constants follow: with a = 2/(3 C^2) it is
   !> (1 + a x)/(1 + a x + C x^2 + a C x^3 + (2/5) C^2 x^4), x = sqrt(b), and
   !> a = 0.501086, C = 1.15345, a C = 0.577977, (2/5) C^2 = 0.532177. Its own error, against
   !> solutions in 50 digits, is the tolerance
   subroutine pade(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: b(4) = [0.1_wp, 0.25_wp, 1.0_wp, 4.0_wp]
      real(wp), parameter :: own_error(4) = [4.8e-5_wp, 4.5e-4_wp, 4.8e-3_wp, 8.4e-3_wp]
      character(len=*), parameter :: label(4) = ['0.10', '0.25', '1.00', '4.00']
      real(wp), parameter :: a = 2.0_wp/(3.0_wp*c**2)
      type(impact_t) :: impact
      real(wp) :: x
      integer :: i

      call law%begin('Kelvin-Voigt contact, F = 0 at the end: Pade approximant', &
         'P. Mueller, T. Poeschel, Phys. Rev. E 84 (2011) 021302; constants recomputed')
      do i = 1, size(b)
         call damped(law, b(i), impact)
         if (allocated(law%error)) return
         x = sqrt(b(i))
         call law%add('cor, b = '//label(i), 'ive', (1.0_wp + a*x) &
            /(1.0_wp + x*(a + x*(c + x*(a*c + x*0.4_wp*c**2)))), own_error(i), &
            "the approximant's own error at this b", impact)
      end do
   end subroutine pade

   !> The equation in x, solved by Taylor series in 50 digits
   subroutine exact(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: b(3) = [0.1_wp, 1.0_wp, 10.0_wp]
      real(wp), parameter :: cor(3) = [0.89285887550655333376_wp, 0.39393060322987319305_wp, &
         0.02509570443151839241_wp]
      character(len=*), parameter :: label(3) = [' 0.1', ' 1.0', '10.0']
      type(impact_t) :: impact
      character(len=6) :: methods(2)
      integer :: i, j

      call law%begin('Kelvin-Voigt contact, F = 0 at the end, weak to strong', &
         'own solution by Taylor series, 16 digits')
      do i = 1, size(b)
         call damped(law, b(i), impact)
         if (allocated(law%error)) return
         methods = methods_for()
         do j = 1, size(methods)
            call law%add('cor, b = '//label(i), methods(j), cor(i), accuracy_of(methods(j)), &
               'twice what the method is asked for', impact)
         end do
      end do
   end subroutine exact

   !> Zener's plate against the dashpot: e_F=0 = e_s=0 Y(p), with Y up to p^6. What is left out is
   !> below p^7/(1 - p), as the coefficients fall from 4/15 on
   subroutine zener_relation(law)
      !> The law
      type(law_t), intent(inout) :: law

      real(wp), parameter :: lambda(3) = [0.05_wp, 0.2_wp, 0.3_wp]
      character(len=*), parameter :: label(3) = ['0.05', '0.20', '0.30']
      type(impact_t) :: two(2)
      character(len=6) :: methods(2)
      real(wp) :: p, left_out
      integer :: i, j

      call law%begin("Kelvin-Voigt contact (A = lambda T) from Zener's plate, their ends related", &
         'identity: the same equation of motion, ended at F = 0 and at s = 0')
      do i = 1, size(lambda)
         call zener_plate(two(2), law%error, elastic(modulus), waves_constant, lambda(i))
         call damped(law, 1.5_wp*lambda(i), two(1))
         if (allocated(law%error)) return
         ! at most, e being below 1
         p = (1.5_wp*lambda(i))**2.5_wp
         left_out = ends(6)*p**7/(1.0_wp - p)
         methods = methods_for()
         do j = 1, size(methods)
            call law%add_measure('cor, lambda = '//label(i), methods(j), 0.0_wp, &
               2.0_wp*accuracy_of(methods(j)) + left_out, &
               'accuracies of the two impacts, and the terms of Y(p) left out', &
               [1.5_wp*lambda(i)], two, expectation=from_zener)
         end do
      end do
   end subroutine zener_relation

   !> A Kelvin-Voigt impact of given damping
   subroutine damped(law, b, impact)
      !> The law that it is for; takes the error
      type(law_t), intent(inout) :: law
      !> Damping b = (3/2) A/T [-]
      real(wp), intent(in) :: b
      !> The impact
      type(impact_t), intent(out) :: impact

      call strike(impact, law%error, elastic(modulus))
      if (allocated(law%error)) return
      call strike(impact, law%error, kelvin_voigt(modulus, b/1.5_wp*hertz_scale(impact)*modulus))
   end subroutine damped

   !> Order of the remainder that the series leaves when cut after b^(7/2), from two impacts
   pure function order_of_remainder(outcomes, b) result(order)
      !> Outcomes of both
      type(outcome_t), intent(in) :: outcomes(:)
      !> Their damping, the second half of the first, shape (2)
      real(wp), intent(in) :: b(:)
      !> Order
      real(wp) :: order

      real(wp) :: remainder(2)
      integer :: i

      do i = 1, 2
         remainder(i) = outcomes(i)%cor - polynomial(coefficient(0:7), sqrt(b(i)))
      end do
      order = ieee_value(order, ieee_quiet_nan)
      if (remainder(1)*remainder(2) > 0.0_wp) order = log(remainder(1)/remainder(2))/log(2.0_wp)
   end function order_of_remainder

   !> Restitution at F = 0 from that at s = 0, that of Zener's plate
   pure function from_zener(outcomes, b) result(cor)
      !> Outcomes of the dashpot's impact and of that on Zener's plate
      type(outcome_t), intent(in) :: outcomes(:)
      !> Damping, shape (1)
      real(wp), intent(in) :: b(:)
      !> Restitution
      real(wp) :: cor

      cor = ieee_value(cor, ieee_quiet_nan)
      if (outcomes(2)%cor > 0.0_wp) &
         cor = outcomes(2)%cor*polynomial(ends, b(1)**2.5_wp*sqrt(outcomes(2)%cor))
   end function from_zener

   !> A polynomial
   pure function polynomial(coefficients, x) result(value)
      !> Coefficients, shape (0:n)
      real(wp), intent(in) :: coefficients(0:)
      !> Argument
      real(wp), intent(in) :: x
      !> Value
      real(wp) :: value

      integer :: i

      value = 0.0_wp
      do i = ubound(coefficients, 1), 0, -1
         value = value*x + coefficients(i)
      end do
   end function polynomial

end module vcor_verify_kelvin_voigt
