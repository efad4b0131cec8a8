!> Compliance of a face that a contact moves, beyond its dent on a half space at rest
!>
!> A Hertz contact of radius a presses with the Abel transform q(x) ~ a^2 - x^2, whose transform is
!> g(ka) = 3 (sin ka - ka cos ka)/(ka)^3. Averaged with the same weight, the face moves by F c with
!>
!>     Q' c(p) = (1/pi) int_0^oo (L(k, p) - L(k, 0)) g(ka)^2 dk,     p = s/c_s
!>
!> the response L of `vcor_impact_response` and L(k, 0) that of the layer at rest, which its contact
!> law contains. It depends on p H and a/H alone (of a half space on p a), so it is tabulated: on
!> two rays of p, those of the exponentials of the pulse (`vcor_impact_deviation`), at the nodes
!> that impacts have needed so far. A material that relaxes turns p off the ray; as c is analytic,
!> the polynomials between the nodes are taken at the complex logarithm of p.
module vcor_impact_mobility
   use vcor_impact_response, only : base_free, base_half_space, static_response, wave_responses
   use vcor_kinds, only : pi, wp
   implicit none
   private

   public :: mobility_t, take_over, direct_mobility

   !> Spacing of the nodes in ln(p H), and in ln(a/H). Cubic polynomials are off by 1e-3
   !> typically, and by 6e-3 where a layer, a wave and the contact are of one size
   real(wp), parameter :: step_p = 0.2_wp
   real(wp), parameter :: step_a = 0.25_wp
   !> Numbers of the first and the last node. Below, c p is constant in p (free plates), or c is too
   !> small to matter; a contact that is smaller still is a point
   integer, parameter :: first_p = -70, last_p = 53
   integer, parameter :: first_a = -29, last_a = 13

   !> Integers up to the number of nodes
   integer, parameter :: short = selected_int_kind(int(log10(real((last_p - first_p + 1) &
      *(last_a - first_a + 1)*2))) + 1)

   !> The table of one Poisson's ratio and base; a table is filled where it is used, and a value
   !> does not depend on the order in which it is
   type :: mobility_t
      private
      !> One of the `base_*` constants
      integer :: base = base_half_space
      !> Poisson's ratio [-]; out of range at first
      real(wp) :: poisson_ratio = -2.0_wp
      !> Arguments of the rays of p, shape (rays)
      real(wp), allocatable :: ray(:)
      !> Q' c H over `magnitude` at the nodes that are known; there may be room for more
      complex(wp), allocatable :: value(:)
      integer :: known = 0
      !> Place of a node in `value`, 0 if it is not known, shape (p, a, rays): small, as each
      !> thread and each call of the library has a copy
      integer(short), allocatable :: place(:, :, :)
   contains
      procedure :: describe
      procedure :: compliance
   end type mobility_t

contains

   !> Set base and Poisson's ratio; the table starts again if they change
   pure subroutine describe(self, base, poisson_ratio, ray)
      class(mobility_t), intent(inout) :: self
      !> base_half_space, base_free, base_bonded or base_sliding
      integer, intent(in) :: base
      !> Poisson's ratio [-], -1 < nu <= 0.5
      real(wp), intent(in) :: poisson_ratio
      !> Arguments of the rays of p, always the same, in (-pi/2, pi/2)
      real(wp), intent(in) :: ray(:)

      if (base == self%base .and. .not. abs(poisson_ratio - self%poisson_ratio) > 0.0_wp) return
      self%base = base
      self%poisson_ratio = poisson_ratio
      if (.not. allocated(self%place)) then
         allocate (self%ray, source=ray)
         allocate (self%place(first_p:last_p, first_a:last_a, size(ray)))
         allocate (self%value(64))
      end if
      self%place = 0
      self%known = 0
   end subroutine describe

   !> Take the table of another if that is of something else, or knows more
   pure subroutine take_over(self, other)
      type(mobility_t), intent(inout) :: self
      type(mobility_t), intent(in) :: other

      if (other%known == 0) return
      if (other%base == self%base .and. other%known <= self%known .and. &
         .not. abs(other%poisson_ratio - self%poisson_ratio) > 0.0_wp) return
      self = other
   end subroutine take_over

   !> Q' c(p)
   pure subroutine compliance(self, ray, p, radius, thickness, extra)
      !> The table, described
      class(mobility_t), intent(inout) :: self
      !> Number of the ray next to p
      integer, intent(in) :: ray
      !> Laplace variable over the speed of shear waves [1/m], real part > 0
      complex(wp), intent(in) :: p
      !> Radius of the contact [m], > 0
      real(wp), intent(in) :: radius
      !> Thickness H [m]; any for a half space
      real(wp), intent(in) :: thickness
      !> Plane-strain modulus times the compliance [1/m]
      complex(wp), intent(out) :: extra

      complex(wp) :: weight_p(4), weight_a(4), place_p
      real(wp) :: length, place_a
      integer :: i, j, k, m

      length = thickness
      if (self%base == base_half_space) length = radius
      place_p = cmplx(log(abs(p)*length), atan2(aimag(p), real(p, wp)) - self%ray(ray), wp)/step_p
      if (real(place_p, wp) < real(first_p, wp)) place_p = &
         cmplx(real(first_p, wp), aimag(place_p), wp)
      if (real(place_p, wp) > real(last_p, wp)) place_p = &
         cmplx(real(last_p, wp), aimag(place_p), wp)
      place_a = min(max(log(radius/length)/step_a, real(first_a, wp)), real(last_a, wp))
      i = min(max(floor(real(place_p, wp)) - 1, first_p), last_p - 3)
      j = min(max(floor(place_a) - 1, first_a), last_a - 3)
      call weigh(place_p - real(i, wp), weight_p)
      call weigh(cmplx(place_a - real(j, wp), 0.0_wp, wp), weight_a)
      extra = 0.0_wp
      do m = 1, 4
         ! at a node, as a half space always is, whose unit of length is the radius
         if (.not. abs(weight_a(m)) > 0.0_wp) cycle
         do k = 1, 4
            call learn(self, i + k - 1, j + m - 1, ray)
            extra = extra + weight_p(k)*weight_a(m) &
               *self%value(self%place(i + k - 1, j + m - 1, ray))
         end do
      end do
      extra = extra*magnitude(self%base, p*length)/length
   end subroutine compliance

   !> Weights of cubic interpolation between nodes at 0, 1, 2, 3
   pure subroutine weigh(x, weight)
      complex(wp), intent(in) :: x
      complex(wp), intent(out) :: weight(4)

      weight = [-(x - 1.0_wp)*(x - 2.0_wp)*(x - 3.0_wp)/6.0_wp, &
         x*(x - 2.0_wp)*(x - 3.0_wp)/2.0_wp, -x*(x - 1.0_wp)*(x - 3.0_wp)/2.0_wp, &
         x*(x - 1.0_wp)*(x - 2.0_wp)/6.0_wp]
   end subroutine weigh

   !> Compute the value of a node if it is not known
   pure subroutine learn(self, i, j, ray)
      class(mobility_t), intent(inout) :: self
      !> Numbers of the node in p and a, and of the ray
      integer, intent(in) :: i, j, ray

      complex(wp), allocatable :: more(:)
      complex(wp) :: p

      if (self%place(i, j, ray) > 0) return
      if (self%known == size(self%value)) then
         allocate (more(2*self%known))
         more(:self%known) = self%value
         call move_alloc(more, self%value)
      end if
      p = exp(cmplx(step_p*real(i, wp), self%ray(ray), wp))
      self%known = self%known + 1
      self%value(self%known) = direct_mobility(self%base, self%poisson_ratio, p, &
         exp(step_a*real(j, wp)))/magnitude(self%base, p)
      self%place(i, j, ray) = int(self%known, short)
   end subroutine learn

   !> How Q' c H goes for small and for large p, so that the quotient varies little
   elemental function magnitude(base, p)
      !> One of the `base_*` constants
      integer, intent(in) :: base
      !> Laplace variable over the speed of shear waves, times H [-]
      complex(wp), intent(in) :: p
      complex(wp) :: magnitude

      select case (base)
      case (base_half_space)
         magnitude = p
      case (base_free)
         magnitude = (1.0_wp + p)/p
      case default
         ! a layer on a rigid base is an inertia first
         magnitude = p**2/(1.0_wp + p)
      end select
   end function magnitude

   !> Q' c(p) by quadrature, in units of the thickness; of the half space in any unit. The
   !> trapezoidal rule in ln k converges exponentially: the poles nearest to the axis, those of
   !> bending waves, are 0.25 off it where p is 0.5 off the imaginary axis, and leave exp(-2 pi
   !> 0.25/0.125) = 4e-6
   pure function direct_mobility(base, poisson_ratio, p, radius) result(extra)
      !> One of the `base_*` constants
      integer, intent(in) :: base
      !> Poisson's ratio [-]
      real(wp), intent(in) :: poisson_ratio
      !> Laplace variable over the speed of shear waves, times H [-], real part > 0
      complex(wp), intent(in) :: p
      !> Radius of the contact over H [-]
      real(wp), intent(in) :: radius
      !> Plane-strain modulus times the compliance, times H [-]
      complex(wp) :: extra

      real(wp), parameter :: step = 0.125_wp
      ! below, L does not change; above, g^2 is below 1e-4
      real(wp), parameter :: low = 3.0e-3_wp, high = 20.0_wp
      complex(wp), allocatable :: excess(:)
      real(wp), allocatable :: k(:)
      real(wp) :: least
      integer :: i, n

      least = min(abs(p), 1.0_wp/radius)
      if (base /= base_half_space) least = min(least, 1.0_wp)
      if (base == base_free) least = min(least, sqrt(abs(p)))
      least = low*least
      n = ceiling(log(high/radius/least)/step)
      allocate (k(0:n), excess(0:n))
      k = [(least*exp(step*real(i, wp)), i=0, n)]
      call wave_responses(base, poisson_ratio, 1.0_wp, k, p, excess)
      excess = excess - static_response(base, poisson_ratio, k)
      ! the part below the first node, and half of its weight
      excess(0) = excess(0)*(0.5_wp + 1.0_wp/step)
      extra = sum(excess*(k*transform(k*radius)**2))*step/pi
   end function direct_mobility

   !> Transform of a Hertz contact, g(z) = 3 (sin z - z cos z)/z^3
   elemental function transform(z)
      !> Wavenumber times radius [-], >= 0
      real(wp), intent(in) :: z
      real(wp) :: transform

      ! below, the series, which errs by z^4/280 = 6e-10; the closed form loses digits as z^-2
      real(wp), parameter :: small = 0.02_wp

      if (z < small) then
         transform = 1.0_wp - 0.1_wp*z**2
      else
         transform = 3.0_wp*(sin(z) - z*cos(z))/z**3
      end if
   end function transform

end module vcor_impact_mobility
