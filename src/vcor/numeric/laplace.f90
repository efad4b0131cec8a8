!> Inversion of Laplace transforms whose singularities all lie on the negative real axis
!>
!> On the parabola w = mu (1 + i y)^2 the integrand of
!>
!>     f(t) = 1/(2 pi i) int exp(s t) F(s) ds,   s = w/t,
!>
!> is analytic for |Im y| < 1 and falls like exp(-mu y^2), so the midpoint rule converges
!> exponentially, with the same nodes for every time: J. A. C. Weideman and L. N. Trefethen,
!> Math. Comp. 76 (2007) 1341, doi:10.1090/S0025-5718-07-01945-X. The nodes below the axis are the
!> conjugates of those above and are not needed.
module vcor_numeric_laplace
   use vcor_constants, only : pi
   use vcor_kinds, only : wp
   implicit none
   private

   public :: contour_nodes, contour_rule

   !> Nodes above the axis
   integer, parameter :: contour_nodes = 26

contains

   !> Nodes w and weights such that f(t) = Im(sum(weight*F(w/t)))/t
   pure subroutine contour_rule(node, weight)
      !> Nodes w = s t [-]
      complex(wp), intent(out) :: node(contour_nodes)
      !> Weights, exp(w) included
      complex(wp), intent(out) :: weight(contour_nodes)

      ! the rule is off by exp(-2 pi/step) = 6e-19, times 1e3 at most; exp(w) falls to exp(-36.8) at
      ! the last node, and the largest term is four times the sum only
      real(wp), parameter :: step = 0.15_wp, mu = 2.6_wp
      complex(wp) :: root
      integer :: k

      do k = 1, contour_nodes
         root = cmplx(1.0_wp, step*(real(k, wp) - 0.5_wp), wp)
         node(k) = mu*root**2
         ! dw = 2 i mu (1 + i y) dy, and 1/(2 pi i) of a conjugate pair is Im(..)/pi
         weight(k) = step/pi*exp(node(k))*2.0_wp*mu*root*(0.0_wp, 1.0_wp)
      end do
   end subroutine contour_rule

end module vcor_numeric_laplace
