!> Decaying exponentials at the end of a panel whose map of time is stationary there
!>
!> On a panel with t = t_end - D y^2, y from 1 to 0, dt/dy = 0 at the end, so collocation does not
!> resolve an exponential that decays within the panel. The integral
!>
!>     w = w_start exp(-a) + int exp(-l (t_end - t)) f(t) dt
!>       = w_start exp(-a) + 2 D int_0^1 exp(-a y^2) f y dy,   a = l D
!>
!> is taken exactly for the polynomial f(y) through the values at the nodes, with the moments
!> m_k = int_0^1 exp(-a y^2) y^k dy. Integration by parts gives
!> 2 a m_(k+2) = (k + 1) m_k - exp(-a), which is stable upwards
!> for large a, from m_0 = sqrt(pi/a)/2 erf(sqrt(a)), and downwards for small a, from series of
!> positive terms, m_k = exp(-a) sum_i (2 a)^i/((k + 1)(k + 3) .. (k + 1 + 2 i)).
!>
!> For slow exponentials this is as accurate as collocation at the end of any panel. Fast ones
!> follow the last value of f, which is known: a force, for example, is zero there.
!>
!> The powers of y come from an expansion in Legendre polynomials. Computed from the values in one
!> step, their coefficients would have independent errors, five digits of 16; this way they belong
!> to a polynomial that differs from f(y) by rounding.
module vcor_numeric_radau_settling
   use vcor_kinds, only : pi, wp
   use vcor_numeric_quadrature, only : gauss_nodes, legendre
   implicit none
   private

   public :: settling_t, new_settling

   !> Highest moment
   integer, parameter :: highest = 8

   !> Rule for polynomials given by their values at fixed points
   type :: settling_t
      private
      !> From the values at the points to the coefficients in Legendre polynomials P_k of 2 y - 1
      real(wp) :: legendre(0:highest - 1, highest) = 0.0_wp
      !> Coefficient of y^k in P_j(2 y - 1), shape (k, j)
      real(wp) :: power(0:highest - 1, 0:highest - 1) = 0.0_wp
   contains
      procedure :: total
      procedure, private :: powers
   end type settling_t

contains

   !> Build the rule
   pure subroutine new_settling(self, point)
      type(settling_t), intent(out) :: self
      !> Points theta = 1 - y of the polynomials, rising to 1, shape (n), n <= 8
      real(wp), intent(in) :: point(:)

      real(wp) :: y(highest), weight(highest), polynomial(0:highest - 1), basis
      integer :: i, j, k

      call gauss_nodes(y, weight)
      do j = 1, highest
         polynomial = legendre(highest - 1, 2.0_wp*y(j) - 1.0_wp)
         do i = 1, size(point)
            basis = product((1.0_wp - y(j) - point(:i - 1))/(point(i) - point(:i - 1))) &
               *product((1.0_wp - y(j) - point(i + 1:))/(point(i) - point(i + 1:)))
            do k = 0, size(point) - 1
               self%legendre(k, i) = self%legendre(k, i) + real(2*k + 1, wp)*weight(j) &
                  *polynomial(k)*basis
            end do
         end do
      end do
      do j = 0, highest - 1
         self%power(0, j) = (-1.0_wp)**j
         do k = 1, j
            self%power(k, j) = -self%power(k - 1, j)*real((j + k)*(j - k + 1), wp)/real(k**2, wp)
         end do
      end do
   end subroutine new_settling

   !> Sum of G_k w_k at the end of the panel
   pure function total(self, moduli, rates, scale, start, f)
      class(settling_t), intent(in) :: self
      !> Moduli G_k, shape (modes)
      real(wp), intent(in) :: moduli(:)
      !> Rates l_k [1/s], >= 0, shape (modes)
      real(wp), intent(in) :: rates(:)
      !> Duration D of the panel [s]
      real(wp), intent(in) :: scale
      !> w_k at the start, shape (modes)
      real(wp), intent(in) :: start(:)
      !> f at the points, shape (n)
      real(wp), intent(in) :: f(:)
      !> Sum
      real(wp) :: total

      real(wp) :: g(highest), moment(0:highest), decay
      integer :: k

      g = 2.0_wp*scale*self%powers(f)
      total = 0.0_wp
      do k = 1, size(moduli)
         call find_moments(rates(k)*scale, moment, decay)
         total = total + moduli(k)*(decay*start(k) &
            + (((g(1)*moment(1) + g(2)*moment(2)) + (g(3)*moment(3) + g(4)*moment(4))) &
            + ((g(5)*moment(5) + g(6)*moment(6)) + (g(7)*moment(7) + g(8)*moment(8)))))
      end do
   end function total

   !> Coefficients of f in powers of y, the power 0 first
   pure function powers(self, f) result(g)
      class(settling_t), intent(in) :: self
      !> f at the points, shape (n)
      real(wp), intent(in) :: f(:)
      !> Coefficients
      real(wp) :: g(highest)

      real(wp) :: coefficient(0:highest - 1)
      integer :: i

      coefficient = 0.0_wp
      do i = 1, size(f)
         coefficient = coefficient + self%legendre(:, i)*f(i)
      end do
      g = 0.0_wp
      do i = 0, highest - 1
         g = g + self%power(:, i)*coefficient(i)
      end do
   end function powers

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
