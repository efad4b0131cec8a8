!> Rule for the inversion of Laplace transforms whose singularities lie on the negative real axis
!>
!> On the parabola w = mu (1 + i y)^2 the integrand of
!>
!>     1/(2 pi i) int exp(w) f(w) dw
!>
!> is analytic for |Im y| < 1 and falls like exp(-mu y^2), so the midpoint rule converges
!> exponentially, whatever f: J. A. C. Weideman and L. N. Trefethen, Math. Comp. 76 (2007) 1341,
!> doi:10.1090/S0025-5718-07-01945-X. The nodes below the axis are conjugates of those above and are
!> left out: the integral is Im(sum(weight*f(node))).
module vcor_numeric_contour
   use vcor_kinds, only : pi, wp
   implicit none
   private

   public :: contour_nodes, contour_rule

   !> Number of nodes above the axis
   integer, parameter :: contour_nodes = 26
   !> Step of the nodes in y: the error of the rule is exp(-2 pi/step) = 6e-19, times 1e3 at most
   real(wp), parameter :: step = 0.15_wp
   !> Vertex of the parabola: exp(w) is exp(-36.8) at the last node, and the largest term is only
   !> four times the sum
   real(wp), parameter :: mu = 2.6_wp

contains

   !> Nodes, and weights with exp(w)
   pure subroutine contour_rule(node, weight)
      !> Nodes w
      complex(wp), intent(out) :: node(contour_nodes)
      !> Weights exp(w) dw/pi
      complex(wp), intent(out) :: weight(contour_nodes)

      complex(wp) :: root
      integer :: k

      do k = 1, contour_nodes
         root = cmplx(1.0_wp, step*(real(k, wp) - 0.5_wp), wp)
         node(k) = mu*root**2
         ! dw = 2 i mu (1 + i y) dy, and 1/(2 pi i) of a conjugate pair is Im(..)/pi
         weight(k) = step/pi*exp(node(k))*2.0_wp*mu*root*(0.0_wp, 1.0_wp)
      end do
   end subroutine contour_rule

end module vcor_numeric_contour
