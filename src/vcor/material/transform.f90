!> Moduli that are known by their transform only: everything in time follows from the complex
!> modulus Q(s) = s L{E}(s) by inverting Laplace's transform numerically
!>
!>     E = L^-1{Q/s},   dE/dt = L^-1{Q},   int_0^t E = L^-1{Q/s^2}
!>
!> to some units of the 15th digit of E t. What is left of Q at s -> infinity, a dashpot, belongs to
!> the time 0 and is taken off the integral.
module vcor_material_transform
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   use vcor_numeric_laplace, only : contour_nodes, contour_rule
   implicit none
   private

   public :: transform_t

   !> A modulus by its transform
   type, abstract, extends(material_t) :: transform_t
      private
      !> Nodes of the inversion
      complex(wp) :: node(contour_nodes) = (0.0_wp, 0.0_wp)
      !> Its weights
      complex(wp) :: weight(contour_nodes) = (0.0_wp, 0.0_wp)
   contains
      !> Make the rule of the inversion
      procedure :: prepare
      procedure :: relaxation
      procedure :: rate
      procedure :: integral
   end type transform_t

contains

   !> Make the rule of the inversion
   pure subroutine prepare(self)
      class(transform_t), intent(inout) :: self

      call contour_rule(self%node, self%weight)
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

   !> Integral of E from 0 to t, the dashpot left out
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
