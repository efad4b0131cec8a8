!> Laws of the verification table for a viscoelastic sphere of Kelvin and Voigt
!>
!> A spring beside a dashpot, F = k (u + A u') with A = viscosity/modulus, is the contact of
!> Kuwabara and Kono (1987) and Brilliantov et al. (1996), F = k (s^1.5 + 3/2 A sqrt(s) s'). In
!> units of T = (m/(k sqrt(v0)))^(2/5) and v0 T the impact is
!>
!>     x'' + b sqrt(x) x' + x^1.5 = 0,   x(0) = 0,  x'(0) = 1,   b = (3/2) A/T ~ v0^(1/5)
!>
!> and ends where x'' = 0, that is F = 0 (Schwager and Poeschel 2008), at x = -b x' > 0.
!>
!> Zener's elastic plate obeys the same equation with b = (3/2) lambda; there F is the force of the
!> spring alone and the contact ends at x = 0. Between the two ends w = -x' obeys
!> dw/dx = b sqrt(x) - x^1.5/w. With w = e y and x = b e xi, e being the restitution at x = 0,
!>
!>     dy/dxi = p (sqrt(xi) - xi^1.5/y),   y(0) = 1,   p = b^(5/2) sqrt(e),
!>
!> so Y(p), the value of y where xi = y, relates the two restitutions:
!>
!>     e_F=0 = e_s=0 Y(p),   Y = 1 + 4/15 p + 13/150 p^2 + 4897/160875 p^3 + ...
!>
!> With sqrt(x) as the variable and dt = sqrt(x) dsigma the equation is polynomial. So e_s=0 is
!> analytic in b and e_F=0 in sqrt(b). The series of e_F=0 is Y times that of e_s=0,
!> 1 - C b + (3/5) C^2 b^2 + ..., where C = (4/5) (5/4)^(3/5) B(3/5, 3/2) is the work of the dashpot
!> along Hertz's impact; the coefficients of e_s=0 from b^3 on are fitted to solutions in 50 digits
!> (tests/reference/make_kelvin_voigt.py).
module vcor_verify_kelvin_voigt
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_plate, only : waves_constant
   use vcor_kinds, only : wp
   use vcor_verify_law, only : kelvin_voigt, law_t, strike_t, time_scale, zener_plate
   implicit none
   private

   public :: series, pade, exact, zener_relation

   !> Modulus of the spring [Pa]; in units of T nothing depends on its value
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
   !> Damping b of the two impacts that show the order of the remainder
   real(wp), parameter :: halved(2) = [0.02_wp, 0.01_wp]

contains

   !> The series of Schwager and Poeschel in powers of v0^(1/10), for a weak dashpot at three
   !> velocities. The omitted terms begin with b^(11/2) and a coefficient below 1. The order of the
   !> remainder after b^(7/2), measured with b and b/2, is 4 plus the effect of the next two terms
   subroutine series(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: velocity(3) = [0.01_wp, 1.0_wp, 100.0_wp]
      character(len=*), parameter :: name(3) = [character(len=24) :: 'cor at 0.01 m/s', &
         'cor at 1 m/s', 'cor at 100 m/s']
      ! b at 1 m/s
      real(wp), parameter :: damping = 0.04_wp
      real(wp), parameter :: bend(2) = [coefficient(9), coefficient(10)]/coefficient(8)
      type(strike_t) :: strike
      real(wp) :: b, order
      integer :: i

      call law%begin('Weak Kelvin-Voigt contact, F = 0 at the end: series in v0^(1/10)', &
         'T. Schwager, T. Poeschel, Phys. Rev. E 78 (2008) 051304; coefficients recomputed')
      strike%velocity = 1.0_wp
      strike%plate = kelvin_voigt(modulus, damping/1.5_wp*time_scale(strike, modulus)*modulus)
      do i = 1, size(velocity)
         b = damping*velocity(i)**0.2_wp
         strike%velocity = velocity(i)
         call law%add_check([strike])
         call law%add_row(name(i), polynomial(coefficient, sqrt(b)), more=b**5.5_wp, &
            reason='accuracy asked for, and the first term left out, b^5.5')
      end do

      b = halved(1)
      order = 4.0_wp + log((1.0_wp + bend(1)*sqrt(b) + bend(2)*b) &
         /(1.0_wp + bend(1)*sqrt(0.5_wp*b) + bend(2)*0.5_wp*b))/log(2.0_wp)
      call law%add_check([damped(halved(1)), damped(halved(2))], 'ive')
      call law%add_row('order of the remainder', order, &
         1.0_wp/(coefficient(8)*halved(2)**4*log(2.0_wp)), b**1.5_wp/log(2.0_wp), &
         'accuracy asked for over the remainder, and the term of relative order b^1.5', &
         measure=order_of_remainder)
   end subroutine series

   !> The Pade approximant [1/4] in sqrt(b) of Mueller and Poeschel, which agrees with the series up
   !> to b^(5/2). So with x = sqrt(b) and a = 2/(3 C^2) it is
   !> (1 + a x)/(1 + a x + C x^2 + a C x^3 + (2/5) C^2 x^4), where a = 0.501086, C = 1.15345,
   !> a C = 0.577977 and (2/5) C^2 = 0.532177. The tolerance is its error against 50 digits
   subroutine pade(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: b(4) = [0.1_wp, 0.25_wp, 1.0_wp, 4.0_wp]
      real(wp), parameter :: own_error(4) = [4.8e-5_wp, 4.5e-4_wp, 4.8e-3_wp, 8.4e-3_wp]
      character(len=*), parameter :: label(4) = ['0.10', '0.25', '1.00', '4.00']
      real(wp), parameter :: a = 2.0_wp/(3.0_wp*c**2)
      integer :: i

      call law%begin('Kelvin-Voigt contact, F = 0 at the end: Pade approximant', &
         'P. Mueller, T. Poeschel, Phys. Rev. E 84 (2011) 021302; constants recomputed')
      do i = 1, size(b)
         associate (x => sqrt(b(i)))
            call law%add_check([damped(b(i))], 'ive')
            call law%add_row('cor, b = '//label(i), (1.0_wp + a*x) &
               /(1.0_wp + x*(a + x*(c + x*(a*c + x*0.4_wp*c**2)))), 0.0_wp, own_error(i), &
               "the approximant's own error at this b")
         end associate
      end do
   end subroutine pade

   !> The scaled equation of motion, solved by Taylor series in 50 digits
   subroutine exact(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: b(3) = [0.1_wp, 1.0_wp, 10.0_wp]
      real(wp), parameter :: cor(3) = [0.89285887550655333376_wp, 0.39393060322987319305_wp, &
         0.02509570443151839241_wp]
      character(len=*), parameter :: label(3) = [' 0.1', ' 1.0', '10.0']
      integer :: i

      call law%begin('Kelvin-Voigt contact, F = 0 at the end, weak to strong', &
         'own solution by Taylor series, 16 digits')
      do i = 1, size(b)
         call law%add_check([damped(b(i))])
         call law%add_row('cor, b = '//label(i), cor(i))
      end do
   end subroutine exact

   !> Zener's plate against the dashpot: e_F=0 = e_s=0 Y(p), with Y up to p^6. The coefficients fall
   !> from 4/15 on, and p is largest with e = 1, so the omitted terms are below p^7/(1 - p) times
   !> the last coefficient
   subroutine zener_relation(law)
      type(law_t), intent(inout) :: law

      real(wp), parameter :: lambda(3) = [0.05_wp, 0.2_wp, 0.3_wp]
      character(len=*), parameter :: label(3) = ['0.05', '0.20', '0.30']
      integer :: i

      call law%begin("Kelvin-Voigt contact (A = lambda T) from Zener's plate, their ends related", &
         'identity: the same equation of motion, ended at F = 0 and at s = 0')
      do i = 1, size(lambda)
         associate (p => (1.5_wp*lambda(i))**2.5_wp)
            call law%add_check([damped(1.5_wp*lambda(i)), &
               zener_plate(modulus, waves_constant, lambda(i))])
            call law%add_row('cor, lambda = '//label(i), times=2.0_wp, &
               more=ends(6)*p**7/(1.0_wp - p), expectation=from_zener, &
               reason='accuracies of the two impacts, and the terms of Y(p) left out')
         end associate
      end do
   end subroutine zener_relation

   !> A Kelvin-Voigt impact of given damping
   pure function damped(b) result(strike)
      !> Damping b = (3/2) A/T [-]
      real(wp), intent(in) :: b
      type(strike_t) :: strike

      strike%plate = kelvin_voigt(modulus, b/1.5_wp*time_scale(strike, modulus)*modulus)
   end function damped

   !> Order of the remainder of the series after b^(7/2), from the impacts of damping `halved`
   pure function order_of_remainder(outcomes) result(order)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: order

      real(wp) :: remainder(2)
      integer :: i

      do i = 1, 2
         remainder(i) = outcomes(i)%cor - polynomial(coefficient(0:7), sqrt(halved(i)))
      end do
      order = ieee_value(order, ieee_quiet_nan)
      if (remainder(1)*remainder(2) > 0.0_wp) order = log(remainder(1)/remainder(2))/log(2.0_wp)
   end function order_of_remainder

   !> Restitution at F = 0 from that at s = 0, which is that of the second impact, Zener's plate
   pure function from_zener(outcomes) result(cor)
      type(outcome_t), intent(in) :: outcomes(:)
      real(wp) :: cor

      cor = ieee_value(cor, ieee_quiet_nan)
      associate (plate => outcomes(2))
         if (plate%cor > 0.0_wp) cor = plate%cor &
            *polynomial(ends, (1.5_wp*plate%inelasticity)**2.5_wp*sqrt(plate%cor))
      end associate
   end function from_zener

   !> A polynomial
   pure function polynomial(coefficients, x) result(value)
      !> Coefficients, shape (0:n)
      real(wp), intent(in) :: coefficients(0:)
      real(wp), intent(in) :: x
      real(wp) :: value

      integer :: i

      value = 0.0_wp
      do i = ubound(coefficients, 1), 0, -1
         value = value*x + coefficients(i)
      end do
   end function polynomial

end module vcor_verify_kelvin_voigt
