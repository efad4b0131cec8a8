!> Response of the face of a body to a pressure p(r) = A J0(kr): its displacement is
!> w = G(k) A J0(kr), and L(k) = mu k G/(1 - nu), with the shear modulus mu, is 1 for the half space
module vcor_impact_response
   use vcor_kinds, only : wp
   implicit none
   private

   public :: base_half_space, base_free, base_bonded, base_sliding
   public :: static_response

   !> What is below the face: the body reaches to infinity
   integer, parameter :: base_half_space = 0
   !> Air: a plate
   integer, parameter :: base_free = 1
   !> A rigid floor, to which the layer is bonded
   integer, parameter :: base_bonded = 2
   !> A rigid floor, on which the layer slides without friction
   integer, parameter :: base_sliding = 3

contains

   !> L - 1 of a layer at rest on a rigid base; 0 for the others, as a free plate is in equilibrium
   !> with no load
   elemental function static_response(base, nu, x) result(excess)
      !> One of the `base_*` constants
      integer, intent(in) :: base
      !> Poisson's ratio [-]
      real(wp), intent(in) :: nu
      !> Wavenumber times thickness k H [-], >= 0
      real(wp), intent(in) :: x
      !> L - 1 [-], <= 0
      real(wp) :: excess

      ! L - 1 is below 1e-100 beyond
      real(wp), parameter :: far = 120.0_wp
      real(wp) :: q

      excess = 0.0_wp
      if (x > far) return
      if (base == base_bonded) then
         q = 3.0_wp - 4.0_wp*nu
         excess = -(2.0_wp*q*exp(-2.0_wp*x) + 4.0_wp*x*(1.0_wp + x) + 1.0_wp + q**2) &
            /(2.0_wp*q*cosh(2.0_wp*x) + 4.0_wp*x**2 + 1.0_wp + q**2)
      else if (base == base_sliding) then
         if (x > 0.0_wp) excess = -(1.0_wp + 2.0_wp*x - exp(-2.0_wp*x))/(sinh(2.0_wp*x) + 2.0_wp*x)
         if (.not. x > 0.0_wp) excess = -1.0_wp
      end if
   end function static_response

end module vcor_impact_response
