!> Compliance of a plate by linear elastodynamics, as a layer with free faces or as a half space
!>
!> A normal force F on a disc of radius a, the footprint, moves the loaded face by U(s) = C(s) F(s),
!> not counting the dent of Hertz' static half space. With the wavenumber k, the shear modulus
!> mu(s), q = rho s^2/mu, p = q (1 - 2 nu)/(2 (1 - nu)) and the thickness H,
!>
!>     C(s) = 1/(2 pi) int_0^oo [k G(k, s) - (1 - nu)/mu] (sin(k a)/(k a))^2 dk
!>
!>     G = al q/(2 mu) [ta tb/(S tb - T ta) + 1/(S ta - T tb)],   al^2 = k^2 + p,  be^2 = k^2 + q,
!>     S = (k^2 + be^2)^2,  T = 4 k^2 al be,  ta = tanh(al H/2),  tb = tanh(be H/2)
!>
!> for the symmetric and the antisymmetric motions of a layer (Rayleigh 1888, Lamb 1917), and
!> G = al q/(mu (S - T)) for a half space. S - T and tb - ta are computed without cancellation:
!>
!>     S - T = [16 k^6 (q - p) + k^4 (24 q^2 - 16 p q) + 8 k^2 q^3 + q^4]/(S + T)
!>     tb - ta = tanh((be - al) H/2) (1 - ta tb),   be - al = (q - p)/(al + be)
module vcor_impact_layer
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_kinds, only : pi, wp
   use vcor_material_type, only : material_t
   use vcor_numeric_quadrature, only : gauss_nodes
   implicit none
   private

   public :: layer_t, new_layer

   !> Number of Gauss nodes of a panel of wavenumbers
   integer, parameter :: nodes = 12

   !> A layer or a half space
   type :: layer_t
      !> Material, not rigid and with a density
      class(material_t), allocatable, private :: material
      !> Thickness H [m]; 0 for a half space
      real(wp) :: thickness = 0.0_wp
      !> Gauss' rule on (0, 1)
      real(wp), private :: node(nodes) = 0.0_wp, weight(nodes) = 0.0_wp
   contains
      !> Compliance C(s), without Hertz' dent
      procedure :: compliance
      !> Compliance of Hertz' dent
      procedure :: dent
      !> Compliance at infinite s
      procedure :: instant
      !> Distance that a shear wave travels
      procedure :: shear_wave_path
   end type layer_t

contains

   !> Build a layer
   pure subroutine new_layer(self, material, thickness)
      !> The layer
      type(layer_t), intent(out) :: self
      !> Material, with a density
      class(material_t), intent(in) :: material
      !> Thickness [m], > 0; 0 for a half space
      real(wp), intent(in) :: thickness

      allocate (self%material, source=material)
      self%thickness = thickness
      call gauss_nodes(self%node, self%weight)
   end subroutine new_layer

   !> Compliance C(s), without Hertz' dent, for discs of several radii, at little more cost than one
   pure function compliance(self, s, footprint, accuracy) result(c)
      class(layer_t), intent(in) :: self
      !> Laplace variable [1/s], real part > 0
      complex(wp), intent(in) :: s
      !> Radii a of the loaded disc [m], > 0, shape (n)
      real(wp), intent(in) :: footprint(:)
      !> Wanted error, relative to C plus the dent, >= 1e-9
      real(wp), intent(in) :: accuracy
      !> Compliances [m/N], shape (n)
      complex(wp) :: c(size(footprint))

      ! largest wavenumber of Rayleigh waves over that of shear waves, for nu >= 0, and its growth
      ! with -nu; range of the wavenumber of bending waves over that of a thin plate
      real(wp), parameter :: rayleigh(2) = [1.15_wp, 0.3_wp], bending(2) = [0.7_wp, 1.6_wp]
      ! smallest c_s/c_p that is resolved; below, Poisson's ratio is practically 1/2
      real(wp), parameter :: fastest = 0.03_wp
      ! the asymptote holds beyond these, over 1/radius, shear wavenumber and 1/thickness
      real(wp), parameter :: far_footprint = 40.0_wp, far_wave = 0.37_wp, far_face = 30.0_wp
      real(wp), parameter :: order = 2.0_wp*real(nodes, wp)
      complex(wp) :: modulus, shear, p, q, g(nodes)
      real(wp) :: nu, share, shear_wave, bending_wave, damping, behind, ellipse, reach, widest
      real(wp) :: last, low, step, k(nodes), x(nodes), zeta(2)
      integer :: i

      nu = self%material%poisson_ratio()
      share = (1.0_wp - 2.0_wp*nu)/(2.0_wp*(1.0_wp - nu))
      modulus = self%material%complex_modulus(s)
      shear = modulus/(2.0_wp*(1.0_wp + nu))
      q = self%material%density()*s**2/shear
      p = share*q

      ! Gauss' rule with n nodes has the error ellipse^(-2 n) for an integrand analytic in the
      ! ellipse around the panel whose half axes add up to `ellipse` half panels. So a panel may be
      ! `reach` times as long as its distance from the poles of G, and `widest`/a for the factor
      ! sin(k a)
      ellipse = accuracy**(-1.0_wp/order)
      reach = 4.0_wp*ellipse/(ellipse**2 - 1.0_wp)
      widest = 2.0_wp*(gamma(order + 1.0_wp)*accuracy)**(1.0_wp/order)

      shear_wave = sqrt(abs(q))
      damping = abs(real(sqrt(q), wp))/shear_wave
      last = max(far_footprint/minval(footprint), far_wave*accuracy**(-1.0_wp/6.0_wp)*shear_wave)
      bending_wave = 0.0_wp
      if (self%thickness > 0.0_wp) then
         ! k^4 = -12 rho (1 - nu^2) s^2/(E H^2)
         bending_wave = sqrt(sqrt(6.0_wp*(1.0_wp - nu))*shear_wave/self%thickness)
         last = max(last, far_face/self%thickness)
      end if
      behind = (rayleigh(1) + rayleigh(2)*max(0.0_wp, -nu))*shear_wave

      c = (0.0_wp, 0.0_wp)
      low = 0.0_wp
      do while (low < last)
         ! distance of poles from the real axis: damping over group speed, which is at most that of
         ! pressure waves and at most the phase speed, for bending waves twice the phase speed
         step = reach*(damping*max(max(sqrt(share), fastest)*shear_wave, min(low, shear_wave)) &
            + max(0.0_wp, low - behind))
         if (low < bending(2)*bending_wave) step = min(step, &
            max(bending(1)*bending_wave - low, 0.5_wp*reach*damping*low))
         step = min(step, widest/maxval(footprint))
         k = low + step*self%node
         g = step*self%weight*(deflection(k, q, p, self%thickness) - (1.0_wp - nu))
         do i = 1, size(footprint)
            x = k*footprint(i)
            c(i) = c(i) + sum(g*(sin(x)/x)**2)
         end do
         low = low + step
      end do

      ! beyond, k G mu = (1 - nu) (1 + zeta_1 q/k^2 + zeta_2 (q/k^2)^2 + ...)
      zeta(1) = -(3.0_wp - 4.0_wp*share + 3.0_wp*share**2)/(4.0_wp*(1.0_wp - share))
      zeta(2) = (11.0_wp - 22.0_wp*share + 18.0_wp*share**2 - 2.0_wp*share**3 - share**4) &
         /(16.0_wp*(1.0_wp - share)**2)
      do i = 1, 2
         c = c + (1.0_wp - nu)*zeta(i)*(q/low**2)**i*(1.0_wp/(2.0_wp*low*real(2*i + 1, wp)) &
            + sin(2.0_wp*low*footprint)/(4.0_wp*low**2*footprint))/footprint**2
      end do
      c = c/(2.0_wp*pi*shear)
   end function compliance

   !> Compliance of a flat punch on a static half space; C(s) plus this is passive
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

   !> Compliance at s -> oo: minus the glassy compliance of the punch
   pure function instant(self, footprint) result(c)
      class(layer_t), intent(in) :: self
      !> Radius a of the loaded disc [m], > 0
      real(wp), intent(in) :: footprint
      !> Compliance [m/N], <= 0
      real(wp) :: c

      real(wp) :: nu

      nu = self%material%poisson_ratio()
      c = 0.0_wp
      if (ieee_is_finite(self%material%glassy()) .and. .not. self%material%viscosity > 0.0_wp) &
         c = -(1.0_wp - nu**2)/(2.0_wp*self%material%glassy()*footprint)
   end function instant

   !> Distance that a shear wave travels in a time
   pure function shear_wave_path(self, time) result(path)
      class(layer_t), intent(in) :: self
      !> Time [s], > 0
      real(wp), intent(in) :: time
      !> Distance [m]
      real(wp) :: path

      real(wp) :: shear

      shear = abs(self%material%complex_modulus(cmplx(1.0_wp/time, 0.0_wp, wp))) &
         /(2.0_wp*(1.0_wp + self%material%poisson_ratio()))
      path = time*sqrt(shear/self%material%density())
   end function shear_wave_path

   !> k mu G, the deflection of the face under a load that varies as J_0(k r)
   elemental function deflection(k, q, p, thickness) result(g)
      !> Wavenumber [1/m], > 0
      real(wp), intent(in) :: k
      !> s^2 over the squared speeds of shear and of pressure waves [1/m2]
      complex(wp), intent(in) :: q, p
      !> Thickness [m]; 0 for a half space
      real(wp), intent(in) :: thickness
      !> k mu G [-]
      complex(wp) :: g

      ! |al - be| H below which the difference of exp(-al H) and exp(-be H) is taken by a series
      real(wp), parameter :: small = 0.1_wp
      integer, parameter :: terms = 8
      complex(wp) :: al, be, s, t, s_less_t, da, db, d, difference
      real(wp) :: k2
      integer :: i

      k2 = k*k
      al = sqrt(k2 + p)
      be = sqrt(k2 + q)
      s = (2.0_wp*k2 + q)**2
      t = 4.0_wp*k2*al*be
      s_less_t = (k2*(k2*(16.0_wp*k2*(q - p) + q*(24.0_wp*q - 16.0_wp*p)) + 8.0_wp*q**3) + q**4) &
         /(s + t)
      g = k*al*q
      if (.not. thickness > 0.0_wp) then
         g = g/s_less_t
         return
      end if
      da = exp(-thickness*al)
      db = exp(-thickness*be)
      d = thickness*(q - p)/(al + be)
      difference = da - db
      if (abs(d) < small) then
         difference = 1.0_wp
         do i = terms, 2, -1
            difference = 1.0_wp - d/real(i, wp)*difference
         end do
         difference = da*d*difference
      end if
      difference = 2.0_wp*t*difference
      g = 0.5_wp*g*((1.0_wp - da)*(1.0_wp - db) &
         /(s_less_t*(1.0_wp - db)*(1.0_wp + da) + difference) + (1.0_wp + da)*(1.0_wp + db) &
         /(s_less_t*(1.0_wp - da)*(1.0_wp + db) - difference))
   end function deflection

end module vcor_impact_layer
