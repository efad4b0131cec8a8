!> Moduli known only by their transform, the complex modulus Q(s) = s L{E}(s). Functions of time are
!> computed by numerical inversion of the Laplace transform
!>
!>     E = L^-1{Q/s},   dE/dt = L^-1{Q},   int_0^t E = L^-1{Q/s^2}
!>
!> with errors of a few units in the 15th digit of E t. A dashpot, the limit of Q/s at s ->
!> infinity, acts at time 0 and is subtracted from the integral.
!>
!> All singularities of Q lie on the negative real axis. On the parabola w = mu (1 + i y)^2 the
!> integrand of
!>
!>     f(t) = 1/(2 pi i) int exp(s t) F(s) ds,   s = w/t,
!>
!> is analytic for |Im y| < 1 and falls like exp(-mu y^2), so the midpoint rule converges
!> exponentially, with the same nodes for every time: J. A. C. Weideman and L. N. Trefethen, Math.
!> Comp. 76 (2007) 1341, doi:10.1090/S0025-5718-07-01945-X. The nodes below the axis are conjugates
!> of those above and are left out.
module vcor_material_transform
   use vcor_constants, only : pi
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: transform_t

   !> Number of nodes above the axis
   integer, parameter :: contour_nodes = 26

   !> A modulus given by its transform
   type, abstract, extends(material_t) :: transform_t
      private
      !> Nodes w of the inversion
      complex(wp) :: node(contour_nodes) = (0.0_wp, 0.0_wp)
      !> Weights of the inversion
      complex(wp) :: weight(contour_nodes) = (0.0_wp, 0.0_wp)
   contains
      procedure :: prepare
      procedure :: relaxation
      procedure :: rate
      procedure :: integral
   end type transform_t

contains

   !> Set nodes w = s t and weights, which include exp(w), such that f(t) = Im(sum(weight*F(w/t)))/t
   pure subroutine prepare(self)
      class(transform_t), intent(inout) :: self

      ! the error of the rule is exp(-2 pi/step) = 6e-19, times 1e3 at most; exp(w) is exp(-36.8) at
      ! the last node, and the largest term is only four times the sum
      real(wp), parameter :: step = 0.15_wp, mu = 2.6_wp
      complex(wp) :: root
      integer :: k

      do k = 1, contour_nodes
         root = cmplx(1.0_wp, step*(real(k, wp) - 0.5_wp), wp)
         self%node(k) = mu*root**2
         ! dw = 2 i mu (1 + i y) dy, and 1/(2 pi i) of a conjugate pair is Im(..)/pi
         self%weight(k) = step/pi*exp(self%node(k))*2.0_wp*mu*root*(0.0_wp, 1.0_wp)
      end do
   end subroutine prepare

   !> Modulus E(t)
   elemental function relaxation(self, t) result(value)
      class(transform_t), intent(in) :: self
      !> Time [s], t >= 0
      real(wp), intent(in) :: t
      !> E [Pa]
      real(wp) :: value

      if (t > 0.0_wp) then
         value = aimag(sum(self%weight*(self%complex_modulus(self%node/t)/self%node)))
      else
         value = self%glassy()
      end if
   end function relaxation

   !> Rate dE/dt at t > 0
   elemental function rate(self, t) result(value)
      class(transform_t), intent(in) :: self
      !> Time [s], t > 0
      real(wp), intent(in) :: t
      !> Rate [Pa/s], <= 0
      real(wp) :: value

      value = aimag(sum(self%weight*self%complex_modulus(self%node/t)))/t
   end function rate

   !> Integral of E from 0 to t, without the dashpot
   elemental function integral(self, t) result(value)
      class(transform_t), intent(in) :: self
      !> Upper limit [s], t >= 0
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: value

      value = 0.0_wp
      if (t > 0.0_wp) value = t*aimag(sum(self%weight &
         *(self%complex_modulus(self%node/t)/self%node**2))) - self%viscosity
   end function integral

end module vcor_material_transform
