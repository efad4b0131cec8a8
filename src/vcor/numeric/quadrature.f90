!> Quadrature rules for the integrands of relaxation moduli
module vcor_numeric_quadrature
   use vcor_constants, only : pi
   use vcor_kinds, only : wp
   implicit none
   private

   public :: endpoint_rule, fourier_rule

contains

   !> Rule on (0, 1) for integrands with a singularity at 0, integrable, of unknown kind: the
   !> double-exponential substitution of Takahasi and Mori, Publ. RIMS 9 (1974) 721,
   !> doi:10.2977/prims/1195192451
   pure subroutine endpoint_rule(node, weight)
      !> Nodes, shape (n)
      real(wp), allocatable, intent(out) :: node(:)
      !> Weights, shape (n)
      real(wp), allocatable, intent(out) :: weight(:)

      integer, parameter :: half = 48
      real(wp), parameter :: h = 0.09_wp
      real(wp) :: y, e
      integer :: i

      allocate (node(-half:half), weight(-half:half))
      do i = -half, half
         y = h*real(i, wp)
         ! the node is 1/(1 + exp(-pi sinh y)), tiny near 0 but never lost there
         e = exp(-pi*sinh(y))
         node(i) = 1.0_wp/(1.0_wp + e)
         weight(i) = h*pi*cosh(y)*node(i)*(e*node(i))
      end do
   end subroutine endpoint_rule

   !> Rules for int_0^inf f(x) sin(x) dx and int_0^inf f(x) cos(x) dx with f smooth on the
   !> logarithmic scale and slowly decaying: T. Ooura and M. Mori, J. Comput. Appl. Math. 112
   !> (1999) 229, doi:10.1016/S0377-0427(99)00223-X
   pure subroutine fourier_rule(sine_node, sine_weight, cosine_node, cosine_weight)
      !> Nodes of the sine rule, shape (n)
      real(wp), allocatable, intent(out) :: sine_node(:)
      !> Weights of the sine rule, sin(x) included, shape (n)
      real(wp), allocatable, intent(out) :: sine_weight(:)
      !> Nodes of the cosine rule, shape (n)
      real(wp), allocatable, intent(out) :: cosine_node(:)
      !> Weights of the cosine rule, cos(x) included, shape (n)
      real(wp), allocatable, intent(out) :: cosine_weight(:)

      integer, parameter :: half = 100
      real(wp), parameter :: h = 0.05_wp, m = pi/h
      real(wp) :: phi, slope
      integer :: i

      allocate (sine_node(-half:half), sine_weight(-half:half))
      allocate (cosine_node(-half:half), cosine_weight(-half:half))
      do i = -half, half
         call substitution(h*real(i, wp), m, phi, slope)
         sine_node(i) = m*phi
         sine_weight(i) = m*h*slope*sin(m*phi)
         call substitution(h*(real(i, wp) - 0.5_wp), m, phi, slope)
         cosine_node(i) = m*phi
         cosine_weight(i) = m*h*slope*cos(m*phi)
      end do
   end subroutine fourier_rule

   !> phi(y) = y/(1 - exp(-2 y - a (1 - exp(-y)) - b (exp(y) - 1))) and its derivative
   pure subroutine substitution(y, m, phi, slope)
      !> Argument
      real(wp), intent(in) :: y
      !> Scale of the rule, pi over its step
      real(wp), intent(in) :: m
      !> Value
      real(wp), intent(out) :: phi
      !> Derivative
      real(wp), intent(out) :: slope

      real(wp), parameter :: b = 0.25_wp
      real(wp) :: a, g, dg, ddg, e

      a = b/sqrt(1.0_wp + m*log(1.0_wp + m)/(4.0_wp*pi))
      g = 2.0_wp*y + a*(1.0_wp - exp(-y)) + b*(exp(y) - 1.0_wp)
      dg = 2.0_wp + a*exp(-y) + b*exp(y)
      if (abs(y) < 1.0e-8_wp) then
         ddg = b - a
         phi = 1.0_wp/dg
         slope = 0.5_wp - 0.5_wp*ddg/dg**2
      else if (g < -600.0_wp) then
         phi = 0.0_wp
         slope = 0.0_wp
      else
         e = exp(-g)
         phi = y/(1.0_wp - e)
         slope = (1.0_wp - e - y*dg*e)/(1.0_wp - e)**2
      end if
   end subroutine substitution

end module vcor_numeric_quadrature
