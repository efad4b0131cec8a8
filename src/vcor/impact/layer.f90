!> Compliance of a plate by linear elastodynamics: a layer with free faces, or a half space
!>
!> A normal load F on the disc of radius a, the footprint, moves the loaded face by U(s) = C(s) F(s)
!> beyond the dent of Hertz' static half space. With k the wavenumber, mu(s) the shear modulus,
!> q = rho s^2/mu, p = q (1 - 2 nu)/(2 (1 - nu)) and H the thickness,
!>
!>     C(s) = 1/(2 pi) int_0^oo [k G(k, s) - (1 - nu)/mu] (sin(k a)/(k a))^2 dk
!>
!>     G = al q/(2 mu) [ta tb/(S tb - T ta) + 1/(S ta - T tb)],   al^2 = k^2 + p,  be^2 = k^2 + q,
!>     S = (k^2 + be^2)^2,  T = 4 k^2 al be,  ta = tanh(al H/2),  tb = tanh(be H/2)
!>
!> the symmetric and the antisymmetric motions of a layer (Rayleigh 1888, Lamb 1917), and
!> G = al q/(mu (S - T)) for a half space. S - T and tb - ta are formed without cancellation:
!>
!>     S - T = [16 k^6 (q - p) + k^4 (24 q^2 - 16 p q) + 8 k^2 q^3 + q^4]/(S + T)
!>     tb - ta = tanh((be - al) H/2) (1 - ta tb),   be - al = (q - p)/(al + be)
module vcor_impact_layer
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_constants, only : pi
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   use vcor_numeric_quadrature, only : gauss_nodes
   implicit none
   private

   public :: layer_t, new_layer

   !> Nodes of a panel of wavenumbers
   integer, parameter :: nodes = 12

   !> A layer or a half space
   type :: layer_t
      !> Material, neither rigid nor without density
      class(material_t), allocatable, private :: material
      !> Thickness H [m]; 0: a half space
      real(wp) :: thickness = 0.0_wp
      !> Gauss' rule on (0, 1)
      real(wp), private :: node(nodes) = 0.0_wp, weight(nodes) = 0.0_wp
   contains
      !> Compliance beyond Hertz' dent
      procedure :: compliance
      !> The same for many footprints
      procedure :: compliances
      !> Hertz' dent by a flat punch
      procedure :: dent
      !> Compliance for what happens at once
      procedure :: instant
   end type layer_t

contains

   !> Build a layer
   pure subroutine new_layer(self, material, thickness)
      !> The layer
      type(layer_t), intent(out) :: self
      !> Material, with a density
      class(material_t), intent(in) :: material
      !> Thickness [m], > 0; 0: a half space
      real(wp), intent(in) :: thickness

      allocate (self%material, source=material)
      self%thickness = thickness
      call gauss_nodes(self%node, self%weight)
   end subroutine new_layer

   !> Compliance C(s) beyond Hertz' dent, to about 2e-8 of it and of the dent
   pure function compliance(self, s, footprint) result(c)
      !> The layer
      class(layer_t), intent(in) :: self
      !> Laplace variable [1/s], real part > 0
      complex(wp), intent(in) :: s
      !> Radius a of the disc that is loaded [m], > 0
      real(wp), intent(in) :: footprint
      !> Compliance [m/N]
      complex(wp) :: c

      associate (all => self%compliances(s, [footprint]))
         c = all(1)
      end associate
   end function compliance

   !> The same for many footprints, which costs little more than for one
   pure function compliances(self, s, footprint) result(c)
      class(layer_t), intent(in) :: self
      !> Laplace variable [1/s], real part > 0
      complex(wp), intent(in) :: s
      !> Radii a of the disc that is loaded [m], > 0, shape (n)
      real(wp), intent(in) :: footprint(:)
      !> Compliances [m/N], shape (n)
      complex(wp) :: c(size(footprint))

      ! Panels grow geometrically from where nothing has happened yet; among the poles of the
      ! propagating modes they follow their distance from the real axis, further out the footprint
      real(wp), parameter :: start = 1.0e-3_wp, growth = 0.5_wp, near_poles = 1.4_wp
      real(wp), parameter :: slow_share = 0.3_wp, beyond_rayleigh = 1.4_wp, oscillation = 5.0_wp
      real(wp), parameter :: around_bending(2) = [0.7_wp, 1.6_wp]
      ! The integrand is its asymptote from here on
      real(wp), parameter :: far_footprint = 40.0_wp, far_wave = 15.0_wp, far_face = 30.0_wp
      complex(wp) :: modulus, shear, p, q, g(nodes)
      real(wp) :: nu, gamma, distance, last_pole, bending, bending_distance, first, last, low, step
      real(wp) :: k(nodes), x(nodes)
      integer :: i

      nu = self%material%poisson_ratio()
      gamma = (1.0_wp - 2.0_wp*nu)/(2.0_wp*(1.0_wp - nu))
      modulus = self%material%complex_modulus(s)
      shear = modulus/(2.0_wp*(1.0_wp + nu))
      q = self%material%density()*s**2/shear
      p = gamma*q

      distance = near_poles*max(sqrt(gamma), slow_share)*abs(real(sqrt(q), wp))
      last_pole = beyond_rayleigh*sqrt(abs(q))
      first = start*min(distance, last_pole)
      bending = 0.0_wp
      bending_distance = 0.0_wp
      last = max(far_footprint/minval(footprint), far_wave*sqrt(abs(q)))
      if (self%thickness > 0.0_wp) then
         ! k^4 = -12 rho (1 - nu^2) s^2/(E H^2)
         bending = sqrt(sqrt(6.0_wp*(1.0_wp - nu)*abs(q))/self%thickness)
         bending_distance = 0.5_wp*near_poles*bending*abs(real(s, wp)/s)
         first = min(first, start*bending)
         last = max(last, far_face/self%thickness)
      end if

      c = (0.0_wp, 0.0_wp)
      low = 0.0_wp
      do while (low < last)
         step = max(growth*low, first)
         if (low < last_pole) then
            step = min(step, distance)
         else if (low < around_bending(1)*bending) then
            step = min(step, max(around_bending(1)*bending - low, bending_distance))
         else if (low < around_bending(2)*bending) then
            step = min(step, bending_distance)
         end if
         step = min(step, oscillation/maxval(footprint))
         k = low + step*self%node
         g = step*self%weight*(deflection(k, q, p, self%thickness) - (1.0_wp - nu))
         do i = 1, size(footprint)
            x = k*footprint(i)
            c(i) = c(i) + sum(g*(sin(x)/x)**2)
         end do
         low = low + step
      end do

      ! k G mu = (1 - nu) (1 + zeta q/k^2 + ...) beyond, and int_K^oo sin(k a)^2/k^4 dk
      associate (a => footprint, zeta => 0.5_wp*gamma &
                 - (3.0_wp - 2.0_wp*gamma)/(2.0_wp*(1.0_wp - gamma)) + 0.25_wp*(3.0_wp + gamma))
         c = c + (1.0_wp - nu)*zeta*q/a**2*(1.0_wp/(6.0_wp*low**3) &
            + sin(2.0_wp*low*a)/(4.0_wp*a*low**4))
      end associate
      c = c/(2.0_wp*pi*shear)
   end function compliances

   !> Compliance of a flat punch on the static half space, what C(s) lacks to be passive
   pure function dent(self, s, footprint) result(c)
      class(layer_t), intent(in) :: self
      !> Laplace variable [1/s], real part > 0
      complex(wp), intent(in) :: s
      !> Radius of the punch [m], > 0
      real(wp), intent(in) :: footprint
      !> Compliance [m/N]
      complex(wp) :: c

      c = (1.0_wp - self%material%poisson_ratio()**2) &
         /(2.0_wp*self%material%complex_modulus(s)*footprint)
   end function dent

   !> Compliance at s -> oo: minus that of the punch, glassy
   pure function instant(self, footprint) result(c)
      class(layer_t), intent(in) :: self
      !> Radius a of the disc that is loaded [m], > 0
      real(wp), intent(in) :: footprint
      !> Compliance [m/N], <= 0
      real(wp) :: c

      real(wp) :: nu

      nu = self%material%poisson_ratio()
      c = 0.0_wp
      if (ieee_is_finite(self%material%glassy()) .and. .not. self%material%viscosity > 0.0_wp) &
         c = -(1.0_wp - nu**2)/(2.0_wp*self%material%glassy()*footprint)
   end function instant

   !> k mu G: deflection of the face by a load that varies as J_0(k r)
   elemental function deflection(k, q, p, thickness) result(g)
      !> Wavenumber [1/m], > 0
      real(wp), intent(in) :: k
      !> s^2 over the squares of the speeds of shear and pressure waves [1/m2]
      complex(wp), intent(in) :: q, p
      !> Thickness [m]; 0: a half space
      real(wp), intent(in) :: thickness
      !> k mu G [-]
      complex(wp) :: g

      complex(wp) :: al, be, s, t, s_less_t, ta, tb, tb_less_ta
      real(wp) :: k2

      k2 = k*k
      al = sqrt(k2 + p)
      be = sqrt(k2 + q)
      s = (2.0_wp*k2 + q)**2
      t = 4.0_wp*k2*al*be
      s_less_t = (k2*(k2*(16.0_wp*k2*(q - p) + q*(24.0_wp*q - 16.0_wp*p)) + 8.0_wp*q**3) + q**4) &
         /(s + t)
      if (thickness > 0.0_wp) then
         ta = tanh_right(0.5_wp*thickness*al)
         tb = tanh_right(0.5_wp*thickness*be)
         tb_less_ta = tanh(0.5_wp*thickness*(q - p)/(al + be))*(1.0_wp - ta*tb)
         g = 0.5_wp*k*al*q*(ta*tb/(s_less_t*tb + t*tb_less_ta) &
            + 1.0_wp/(s_less_t*ta - t*tb_less_ta))
      else
         g = k*al*q/s_less_t
      end if
   end function deflection

   !> tanh z for a real part that is not negative, however large
   elemental function tanh_right(z) result(value)
      !> z
      complex(wp), intent(in) :: z
      !> tanh z
      complex(wp) :: value

      complex(wp) :: decay

      decay = exp(-2.0_wp*z)
      value = (1.0_wp - decay)/(1.0_wp + decay)
   end function tanh_right

end module vcor_impact_layer
