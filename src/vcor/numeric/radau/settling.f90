!> Decaying exponentials at the end of a panel whose map of time is stationary there
!>
!> On a panel with t = t_end - D y^2, y from 1 to 0, dt/dy = 0 at the end, so collocation does not
!> resolve an exponential that decays within the panel. The integral
!>
!>     w = w_start exp(-a) + int exp(-l (t_end - t)) x'(t) dt
!>       = w_start exp(-a) - int_0^1 exp(-a y^2) dx/dy dy,   a = l D
!>
!> is taken exactly for a polynomial x(y) through the values, with the moments
!> m_k = int_0^1 exp(-a y^2) y^k dy. Integration by parts gives
!> 2 a m_(k+2) = (k + 1) m_k - exp(-a), which is stable upwards
!> for large a, from m_0 = sqrt(pi/a)/2 erf(sqrt(a)), and downwards for small a, from series of
!> positive terms, m_k = exp(-a) sum_i (2 a)^i/((k + 1)(k + 3) .. (k + 1 + 2 i)).
!>
!> As dt/dy = 0 at the end, dx/dy = 0 at y = 0. The polynomial is the one of degree n + 1 that has
!> this slope: it differs from that of degree n by a multiple of the product of y - y_j, which Radau
!> integrals do not see, so slow exponentials stay as accurate as at the end of any panel. Fast
!> ones, whose m_0 falls only as a^(-1/2), would be affected most by a slope.
!>
!> Of a function whose rate is known, such as an impulse, dx/dy = -2 D y f with a polynomial f(y)
!> through its rates at the points after the start. That of x would end with a rate which is that of
!> no f: the force ends as y^(3/2), and fast exponentials feel its last value alone.
!>
!> The powers of y come from an expansion in Legendre polynomials. Computed from the values in one
!> step, their coefficients would have independent errors, five digits of 16; this way they belong
!> to a polynomial that differs from x(y) by rounding.
module vcor_numeric_radau_settling
   use vcor_kinds, only : pi, wp
   use vcor_numeric_quadrature, only : gauss_nodes, legendre
   implicit none
   private

   public :: settling_t, new_settling, total

   !> Highest degree of dx/dy
   integer, parameter :: highest = 8

   !> Rule for polynomials given by their values at fixed points
   type :: settling_t
      private
      !> From the values of x at the points to the coefficients of -dx/dy in Legendre polynomials P_k,
      !> k <= n, of 2 y - 1, and from those of f to the coefficients of f
      real(wp) :: of_slope(0:highest, 0:highest) = 0.0_wp, of_rate(0:highest, 0:highest) = 0.0_wp
      !> Coefficient of y^k in P_j(2 y - 1), shape (k, j)
      real(wp) :: power(0:highest, 0:highest) = 0.0_wp
   contains
      procedure :: powers_of_slope
      procedure :: powers_of_rate
   end type settling_t

contains

   !> Build the rule
   pure subroutine new_settling(self, point)
      type(settling_t), intent(out) :: self
      !> Points theta = 1 - y of the polynomials, rising to 1, shape (0:n), n <= 8
      real(wp), intent(in) :: point(0:)

      real(wp) :: y(highest + 1), weight(highest + 1), projection(0:highest), slope
      real(wp) :: at(0:ubound(point, 1))
      integer :: i, j, k, n

      n = ubound(point, 1)
      at = 1.0_wp - point
      call gauss_nodes(y, weight)
      do j = 1, highest + 1
         projection = legendre(highest, 2.0_wp*y(j) - 1.0_wp)*weight(j) &
            *[(real(2*k + 1, wp), k=0, highest)]
         do i = 0, n
            slope = slope_of_basis(at, i, y(j)) - slope_of_basis(at, i, 0.0_wp) &
               *slope_of_product(at, y(j))/slope_of_product(at, 0.0_wp)
            self%of_slope(:n, i) = self%of_slope(:n, i) - projection(:n)*slope
            if (i > 0) self%of_rate(:n, i) = self%of_rate(:n, i) + projection(:n) &
               *basis(at(1:), i, y(j))
         end do
      end do
      do j = 0, highest
         self%power(0, j) = (-1.0_wp)**j
         do k = 1, j
            self%power(k, j) = -self%power(k - 1, j)*real((j + k)*(j - k + 1), wp)/real(k**2, wp)
         end do
      end do
   end subroutine new_settling

   !> Lagrange polynomial
   pure function basis(point, i, y) result(value)
      !> Points, shape (n)
      real(wp), intent(in) :: point(:)
      !> Index of the point at which the polynomial is 1
      integer, intent(in) :: i
      !> Argument
      real(wp), intent(in) :: y
      real(wp) :: value

      value = product((y - point(:i - 1))/(point(i) - point(:i - 1))) &
         *product((y - point(i + 1:))/(point(i) - point(i + 1:)))
   end function basis

   !> Derivative of a Lagrange polynomial
   pure function slope_of_basis(point, i, y) result(slope)
      !> Points, shape (0:n)
      real(wp), intent(in) :: point(0:)
      !> Index of the point at which the polynomial is 1
      integer, intent(in) :: i
      !> Argument
      real(wp), intent(in) :: y
      !> Derivative
      real(wp) :: slope

      real(wp) :: term
      integer :: j, m

      slope = 0.0_wp
      do m = 0, ubound(point, 1)
         if (m == i) cycle
         term = 1.0_wp/(point(i) - point(m))
         do j = 0, ubound(point, 1)
            if (j /= i .and. j /= m) term = term*((y - point(j))/(point(i) - point(j)))
         end do
         slope = slope + term
      end do
   end function slope_of_basis

   !> Derivative of the product of y - y_j
   pure function slope_of_product(point, y) result(slope)
      !> Points y_j, shape (0:n)
      real(wp), intent(in) :: point(0:)
      !> Argument
      real(wp), intent(in) :: y
      real(wp) :: slope

      integer :: j

      slope = 0.0_wp
      do j = 0, ubound(point, 1)
         slope = slope + product(y - point(:j - 1))*product(y - point(j + 1:))
      end do
   end function slope_of_product

   !> Sum of G_k w_k at the end of the panel
   pure function total(moduli, rates, scale, start, g)
      !> Moduli G_k, shape (modes)
      real(wp), intent(in) :: moduli(:)
      !> Rates l_k [1/s], >= 0, shape (modes)
      real(wp), intent(in) :: rates(:)
      !> Duration D of the panel [s]
      real(wp), intent(in) :: scale
      !> w_k at the start, shape (modes)
      real(wp), intent(in) :: start(:)
      !> Coefficients of -dx/dy in powers of y
      real(wp), intent(in) :: g(0:highest)
      !> Sum
      real(wp) :: total

      real(wp) :: moment(0:highest)
      real(wp) :: decay
      integer :: k

      total = 0.0_wp
      do k = 1, size(moduli)
         call find_moments(rates(k)*scale, moment, decay)
         total = total + moduli(k)*(decay*start(k) &
            + (((g(1)*moment(1) + g(2)*moment(2)) + (g(3)*moment(3) + g(4)*moment(4))) &
            + ((g(5)*moment(5) + g(6)*moment(6)) + (g(7)*moment(7) + g(8)*moment(8)))))
      end do
   end function total

   !> Coefficients of -dx/dy in powers of y, from x at the points
   pure function powers_of_slope(self, x) result(g)
      class(settling_t), intent(in) :: self
      !> x at the points, shape (0:n)
      real(wp), intent(in) :: x(0:)
      !> Coefficients
      real(wp) :: g(0:highest)

      real(wp) :: coefficient(0:highest)
      integer :: i, n

      n = ubound(x, 1)
      coefficient = 0.0_wp
      do i = 0, n - 1
         coefficient = coefficient + self%of_slope(:, i)*(x(i) - x(n))
      end do
      g = 0.0_wp
      do i = 0, highest
         g = g + self%power(:, i)*coefficient(i)
      end do
   end function powers_of_slope

   !> Coefficients of -dx/dy in powers of y, from the rate of x at the points after the start
   pure function powers_of_rate(self, scale, f) result(g)
      class(settling_t), intent(in) :: self
      !> Duration D of the panel [s]
      real(wp), intent(in) :: scale
      !> Rate dx/dt at the points, shape (n)
      real(wp), intent(in) :: f(:)
      !> Coefficients
      real(wp) :: g(0:highest)

      real(wp) :: coefficient(0:highest)
      integer :: i

      coefficient = 0.0_wp
      do i = 1, size(f)
         coefficient = coefficient + self%of_rate(:, i)*(2.0_wp*scale*f(i))
      end do
      g = 0.0_wp
      do i = 0, highest
         g(1:) = g(1:) + self%power(:highest - 1, i)*coefficient(i)
      end do
   end function powers_of_rate

   !> Moments m_k = int_0^1 exp(-a y^2) y^k dy
   pure subroutine find_moments(a, moment, decay)
      !> a, >= 0
      real(wp), intent(in) :: a
      real(wp), intent(out) :: moment(0:highest)
      !> exp(-a), or 0 where it is below rounding
      real(wp), intent(out) :: decay

      ! upwards no digit is lost from `smallest` on; exp(-a) is rounding from `largest` on
      real(wp), parameter :: smallest = 1.0_wp, largest = 40.0_wp
      ! terms that the series needs up to a = `smallest` for full accuracy
      integer, parameter :: terms = 15
      real(wp), parameter :: half_root_of_pi = 0.5_wp*sqrt(pi)
      integer :: number
      real(wp), parameter :: inverse(2*terms + highest) = &
         [(1.0_wp/real(number, wp), number=1, 2*terms + highest)]
      real(wp) :: double, half, root, even, odd
      integer :: i, k

      if (a < smallest) then
         decay = exp(-a)
         double = 2.0_wp*a
         even = 1.0_wp
         odd = 1.0_wp
         do i = terms - 1, 1, -1
            even = 1.0_wp + double*inverse(highest + 2*i)*even
            odd = 1.0_wp + double*inverse(highest + 1 + 2*i)*odd
         end do
         moment(highest - 1) = decay*inverse(highest)*even
         moment(highest) = decay*inverse(highest + 1)*odd
         do k = highest - 2, 0, -1
            moment(k) = (decay + double*moment(k + 2))*inverse(k + 1)
         end do
      else
         half = 0.5_wp/a
         root = sqrt(a)
         decay = 0.0_wp
         moment(0) = half_root_of_pi/root
         if (a < largest) then
            decay = exp(-a)
            moment(0) = moment(0)*(1.0_wp - decay*erfc_scaled(root))
         end if
         moment(1) = (1.0_wp - decay)*half
         do k = 0, highest - 2
            moment(k + 2) = (real(k + 1, wp)*moment(k) - decay)*half
         end do
      end if
   end subroutine find_moments

end module vcor_numeric_radau_settling
