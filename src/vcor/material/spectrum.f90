!> Materials with a continuous spectrum of relaxation as sums of exponentials
!>
!> A completely monotone modulus is E(t) = E_0 + int_0^inf H(l) exp(-l t) dl, and its complex
!> modulus Q gives the spectrum at once: H(l) = Im Q(-l + i0)/(pi l). In y = ln(l) the trapezoidal
!> rule converges exponentially, as the integrand is analytic for |Im y| < pi/2. Its nodes are put at
!>
!>     y = x - exp(x_a - x) + exp(x - x_b),   x = 0, +-h, +-2 h ..
!>
!> which runs away doubly exponentially below x_a and above x_b, where exp(-l t) has become
!> 1 - l t + .. and 1/l delta(t) - .. on the window: few nodes cover what else would be many decades.
module vcor_material_spectrum
   use vcor_constants, only : pi
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: sum_of_spectrum
   real(wp), public :: p_h = 0.4_wp, p_a = 0.1_wp, p_b = 1e5_wp, p_eps=1e-11_wp, p_top=1e14_wp

contains

   !> Sum of exponentials for a material with a continuous spectrum
   pure subroutine sum_of_spectrum(material, window, accuracy, terms)
      !> The material
      class(material_t), intent(in) :: material
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      !> The sum
      type(exponential_sum_t), intent(out) :: terms

      real(wp) :: x, y, rate, modulus, rates(1000), moduli(1000)
      integer :: j, n

      terms%equilibrium = material%rubbery()
      n = 0
      do j = nint((log(p_a) - 8.0_wp)/p_h), nint((log(p_b) + 8.0_wp)/p_h)
         x = real(j, wp)*p_h
         y = x - p_a*exp(-x) + exp(x)/p_b
         if (abs(y) > 300.0_wp) cycle
         rate = exp(y)/window
         modulus = p_h*(1.0_wp + p_a*exp(-x) + exp(x)/p_b)/pi &
            *aimag(material%complex_modulus(cmplx(-rate, 0.0_wp, wp)))
         if (rate*window < p_eps) then
            terms%equilibrium = terms%equilibrium + modulus
         else if (rate*window > p_top) then
            terms%viscosity = terms%viscosity + modulus/rate
         else
            n = n + 1
            rates(n) = rate
            moduli(n) = modulus
         end if
      end do
      allocate (terms%moduli, source=moduli(:n))
      allocate (terms%rates, source=rates(:n))
      terms%error = accuracy
   end subroutine sum_of_spectrum

end module vcor_material_spectrum
