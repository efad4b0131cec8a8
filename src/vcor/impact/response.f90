!> Response of the face of a layer to a pressure p(r) = A J0(kr) exp(s t): its displacement is
!> w = G(k, s) A J0(kr) exp(s t)
!>
!> All is written for L(k, p) = mu k G/(1 - nu), which is 1 for the half space at rest and falls to
!> it for k -> oo, with the shear modulus mu, p = s/c_s and the speed c_s of shear waves. With H the
!> thickness, q = (c_s/c_p)^2 = (1 - 2 nu)/(2 (1 - nu)), y = (p/k)^2, a = sqrt(1 + q y) and
!> b = sqrt(1 + y), the Rayleigh function is D = S - T with S = (2 + y)^2 and T = 4 a b, and the
!> half space (H. Lamb, Phil. Trans. R. Soc. A 203 (1904) 1, doi:10.1098/rsta.1904.0013) has
!> L = a y/((1 - nu) D). A layer has the factors, with ta and tb the hyperbolic tangents of a and b
!> times k H, for a free plate times k H/2,
!>
!>     free plate      (D/2) [ta tb/(S tb - T ta) + 1/(S ta - T tb)]
!>     sliding base    D ta tb/(S tb - T ta)
!>     bonded base     D (tb - a b ta)/[(S + 4 a^2 b^2) ta tb - a b (4 + S)
!>                        + 4 a b (2 + y)/(cosh(a k H) cosh(b k H))]
!>
!> The sums of convolution quadrature amplify rounding, and L - 1 is small where most of the nodes
!> are: all differences of nearly equal terms are replaced by what is left of them.
module vcor_impact_response
   use vcor_kinds, only : wp
   implicit none
   private

   public :: base_half_space, base_free, base_bonded, base_sliding
   public :: static_response, wave_response, wave_responses

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

   !> L - 1 of a face with waves
   elemental function wave_response(base, nu, thickness, k, p) result(excess)
      !> One of the `base_*` constants
      integer, intent(in) :: base
      !> Poisson's ratio [-]
      real(wp), intent(in) :: nu
      !> Thickness H [m], > 0 for a layer
      real(wp), intent(in) :: thickness
      !> Wavenumber k [1/m], > 0
      real(wp), intent(in) :: k
      !> Laplace variable divided by the speed of shear waves [1/m], real part > 0
      complex(wp), intent(in) :: p
      !> L - 1 [-]
      complex(wp) :: excess

      complex(wp) :: one(1)

      call wave_responses(base, nu, thickness, [k], p, one)
      excess = one(1)
   end function wave_response

   !> L - 1 of a face with waves at many wavenumbers. The half space is in real numbers, for then
   !> the compiler computes two at once; the layer takes the rates from it, and only where it is
   !> thin enough to differ
   pure subroutine wave_responses(base, nu, thickness, k, p, excess)
      !> One of the `base_*` constants
      integer, intent(in) :: base
      !> Poisson's ratio [-]
      real(wp), intent(in) :: nu
      !> Thickness H [m], > 0 for a layer
      real(wp), intent(in) :: thickness
      !> Wavenumbers k [1/m], > 0
      real(wp), intent(in) :: k(:)
      !> Laplace variable divided by the speed of shear waves [1/m], real part > 0
      complex(wp), intent(in) :: p
      !> L - 1 [-], same shape
      complex(wp), intent(out) :: excess(:)

      ! exponent beyond which a layer is taken for the half space, from which it differs by 1e-14:
      ! the weights of late steps amplify that by 1e7, to 1e-7, the error that they have from
      ! convolution quadrature
      real(wp), parameter :: far = 32.0_wp
      real(wp) :: length(size(k))
      ! real and imaginary parts of y, a and b
      real(wp), dimension(size(k)) :: yr, yi, ar, ai, br, bi
      real(wp) :: q, up_r, up_i, down_r, down_i, size_a, size_b, over
      real(wp) :: square_r, square_i
      complex(wp) :: a, b
      integer :: i

      q = (1.0_wp - 2.0_wp*nu)/(2.0_wp*(1.0_wp - nu))
      square_r = real(p, wp)**2 - aimag(p)**2
      square_i = 2.0_wp*real(p, wp)*aimag(p)
      do i = 1, size(k)
         over = 1.0_wp/k(i)**2
         yr(i) = square_r*over
         yi(i) = square_i*over
      end do
      call roots(1.0_wp + q*yr, q*yi, ar, ai)
      call roots(1.0_wp + yr, yi, br, bi)
      ! D = S - T = (S^2 - T^2)/(S + T) = y poly/(S + T), and L - 1 with its factor y. Quotients by
      ! 1 + a and 1 + b share a division, which takes as long as ten products
      do i = 1, size(k)
         size_a = (1.0_wp + ar(i))**2 + ai(i)**2
         size_b = (1.0_wp + br(i))**2 + bi(i)**2
         over = 4.0_wp/(size_a*size_b)
         ! 4 q/(1 + a) + 4/(1 + b) + a (4 + y) + 4 q b
         up_r = over*(q*size_b*(1.0_wp + ar(i)) + size_a*(1.0_wp + br(i))) &
            + ar(i)*(4.0_wp + yr(i)) - ai(i)*yi(i) + 4.0_wp*q*br(i)
         up_i = -over*(q*size_b*ai(i) + size_a*bi(i)) + ai(i)*(4.0_wp + yr(i)) + ar(i)*yi(i) &
            + 4.0_wp*q*bi(i)
         ! 8 y + y^2
         square_r = yr(i)*(8.0_wp + yr(i)) - yi(i)**2
         square_i = yi(i)*(8.0_wp + 2.0_wp*yr(i))
         up_r = 2.0_wp*(1.0_wp - q)*up_r - (24.0_wp - 16.0_wp*q) - square_r
         up_i = 2.0_wp*(1.0_wp - q)*up_i - square_i
         ! 16 (1 - q) + y (24 - 16 q + 8 y + y^2)
         down_r = 16.0_wp*(1.0_wp - q) + yr(i)*(24.0_wp - 16.0_wp*q + square_r) - yi(i)*square_i
         down_i = yi(i)*(24.0_wp - 16.0_wp*q + square_r) + yr(i)*square_i
         over = 1.0_wp/(down_r**2 + down_i**2)
         square_r = (up_r*down_r + up_i*down_i)*over
         square_i = (up_i*down_r - up_r*down_i)*over
         excess(i) = cmplx(yr(i)*square_r - yi(i)*square_i, yr(i)*square_i + yi(i)*square_r, wp)
      end do
      if (base == base_half_space) return

      length = k*thickness
      if (base == base_free) length = 0.5_wp*length
      do i = 1, size(k)
         if (2.0_wp*length(i)*min(ar(i), br(i)) > far) cycle
         a = cmplx(ar(i), ai(i), wp)
         b = cmplx(br(i), bi(i), wp)
         excess(i) = excess(i) + (1.0_wp + excess(i)) &
            *layer_factor(base, q, length(i), cmplx(yr(i), yi(i), wp), a, b)
      end do
   end subroutine wave_responses

   !> Factor of a layer on the L of the half space, less 1
   elemental function layer_factor(base, q, length, y, a, b) result(ratio)
      !> One of the `base_*` constants of a layer
      integer, intent(in) :: base
      !> Square of the ratio of wave speeds, and length k H or k H/2
      real(wp), intent(in) :: q, length
      !> The variables y, a and b
      complex(wp), intent(in) :: y, a, b
      complex(wp) :: ratio

      complex(wp) :: s, t, d, kappa, even, less, ta, tb, more, swap
      ! of the wave that reaches farther, 1, and the other, 2: rate, exp(-2 length rate) and 1 less
      ! that; w makes up the difference of their tangents, tb - ta = sign f w (2 - w)
      complex(wp) :: rate, e1, e2, rest1, rest2, w, f, both
      real(wp) :: sign

      sign = 1.0_wp
      if (real(b, wp) < real(a, wp)) sign = -1.0_wp
      rate = a
      if (sign < 0.0_wp) rate = b
      rest1 = decay(2.0_wp*length*rate)
      w = decay((length*sign*(1.0_wp - q))*(y*over(a + b)))
      e1 = 1.0_wp - rest1
      e2 = e1*(1.0_wp - w)**2
      rest2 = rest1 + e1*w*(2.0_wp - w)
      ! the quotients by 1 + e1 and 1 + e2 in one, and less = 1 - ta
      both = over((1.0_wp + e1)*(1.0_wp + e2))
      f = 2.0_wp*e1*both
      ta = rest1*(1.0_wp + e2)*both
      tb = rest2*(1.0_wp + e1)*both
      less = f*(1.0_wp + e2)
      if (sign < 0.0_wp) then
         swap = ta
         ta = tb
         tb = swap
         less = 2.0_wp*e2*(1.0_wp + e1)*both
      end if

      s = (2.0_wp + y)**2
      t = 4.0_wp*a*b
      d = y*(16.0_wp*(1.0_wp - q) + y*(24.0_wp - 16.0_wp*q + y*(8.0_wp + y)))*over(s + t)
      ! tb - ta, and T times it
      both = sign*f*w*(2.0_wp - w)
      more = t*both
      select case (base)
      case (base_free)
         ratio = 0.5_wp*((d*less + more)*(d*tb + more) - (d*less*tb + more)*(d*ta - more)) &
            *over((d*ta - more)*(d*tb + more))
      case (base_sliding)
         ratio = -(d*less*tb + more)*over(d*tb + more)
      case default
         kappa = -y*(1.0_wp + q + q*y)*over(1.0_wp + a*b)
         even = f*((s + 0.25_wp*t**2)*w**2 + 2.0_wp*(1.0_wp - w)*(y + 2.0_wp*kappa)**2)
         ratio = (d*(both - kappa*less) + even)*over(kappa*d - even)
      end select
   end function layer_factor

   !> 1/z by one division, for numbers whose squares are in range
   elemental function over(z)
      !> Number
      complex(wp), intent(in) :: z
      complex(wp) :: over

      over = conjg(z)*(1.0_wp/(real(z, wp)**2 + aimag(z)**2))
   end function over

   !> Square roots with a positive real part, not of numbers on the negative real axis
   pure subroutine roots(x, y, real_part, imaginary_part)
      !> Real and imaginary parts of the numbers
      real(wp), intent(in) :: x(:), y(:)
      !> Those of the roots
      real(wp), intent(out) :: real_part(:), imaginary_part(:)

      real(wp) :: large, small
      integer :: i

      do i = 1, size(x)
         large = sqrt(0.5_wp*(sqrt(x(i)**2 + y(i)**2) + abs(x(i))))
         small = 0.5_wp*abs(y(i))/large
         real_part(i) = merge(large, small, x(i) >= 0.0_wp)
         imaginary_part(i) = sign(merge(small, large, x(i) >= 0.0_wp), y(i))
      end do
   end subroutine roots

   !> 1 - exp(-z), to full accuracy for small z too
   elemental function decay(z)
      !> Exponent, real part >= 0
      complex(wp), intent(in) :: z
      complex(wp) :: decay

      ! below, sinh(z/2) in 1 - exp(-z) = 2 exp(-z/2) sinh(z/2) is a short series
      real(wp), parameter :: small = 0.5_wp
      complex(wp) :: square

      if (abs(real(z, wp)) + abs(aimag(z)) > small) then
         decay = 1.0_wp - exp(-real(z, wp))*cmplx(cos(aimag(z)), -sin(aimag(z)), wp)
      else
         square = 0.25_wp*z**2
         decay = z*exp(-0.5_wp*z)*(1.0_wp + square/6.0_wp*(1.0_wp + square/20.0_wp &
            *(1.0_wp + square/42.0_wp*(1.0_wp + square/72.0_wp*(1.0_wp + square/110.0_wp)))))
      end if
   end function decay

end module vcor_impact_response
