!> What decaying exponentials remember at the end of a panel with a stretched time
!>
!> On a panel with t = t_end - D y^2, y from 1 to 0, collocation says nothing about an exponential
!> that settles in it: the map stands still at the end. So the integral
!>
!>     w = w_start exp(-a) + int exp(-l (t_end - t)) x'(t) dt
!>       = w_start exp(-a) - int_0^1 exp(-a y^2) dx/dy dy,   a = l D
!>
!> is taken of the polynomial x(y) itself: by Gauss's rule, and where exp(-a) is
!> nothing by its powers, int_0^oo exp(-a y^2) k y^(k-1) dy = Gamma(k/2 + 1)/a^(k/2).
module vcor_numeric_settling
   use vcor_kinds, only : wp
   use vcor_numeric_legendre, only : gauss_nodes
   implicit none
   private

   public :: settling_t, new_settling

   !> Nodes of Gauss's rule, and the largest a for which they give all digits
   integer, parameter :: nodes = 24
   real(wp), parameter :: largest = 36.0_wp

   !> Rule for polynomials that are given at some points
   type :: settling_t
      private
      !> y^2 at the nodes
      real(wp) :: square(nodes) = 0.0_wp
      !> From the values at the points to -dx/dy times the weight at the nodes, shape
      !> (nodes, 0:n)
      real(wp), allocatable :: slope(:, :)
      !> From the values at the points to -c_k Gamma(k/2 + 1) of x = sum_k c_k y^k, shape (n, 0:n)
      real(wp), allocatable :: power(:, :)
   contains
      !> Sum over many exponentials
      procedure :: total
   end type settling_t

contains

   !> Build the rule
   pure subroutine new_settling(self, point)
      !> The rule
      type(settling_t), intent(out) :: self
      !> Points theta = 1 - y of the polynomials, all different, shape (0:n)
      real(wp), intent(in) :: point(0:)

      real(wp) :: y(nodes), weight(nodes), own(0:ubound(point, 1)), basis(0:ubound(point, 1))
      integer :: n, i, j, k

      n = ubound(point, 1)
      call gauss_nodes(y, weight)
      self%square = y**2
      own = 1.0_wp - point
      allocate (self%slope(nodes, 0:n), self%power(n, 0:n))
      do i = 0, n
         do k = 1, nodes
            self%slope(k, i) = -weight(k)*slope_of_basis(own, i, y(k))
         end do
         ! Lagrange's polynomial, multiplied out factor by factor
         basis = 0.0_wp
         basis(0) = 1.0_wp
         do j = 0, n
            if (j == i) cycle
            basis = (eoshift(basis, -1) - own(j)*basis)/(own(i) - own(j))
         end do
         do k = 1, n
            self%power(k, i) = -gamma(0.5_wp*real(k, wp) + 1.0_wp)*basis(k)
         end do
      end do
   end subroutine new_settling

   !> Derivative of one of Lagrange's polynomials
   pure function slope_of_basis(point, i, y) result(slope)
      !> Points, shape (0:n)
      real(wp), intent(in) :: point(0:)
      !> Index of the one at which it is 1
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

   !> Sum of G_k w_k at the end
   pure function total(self, moduli, products, start, x)
      !> The rule
      class(settling_t), intent(in) :: self
      !> Moduli G_k, shape (modes)
      real(wp), intent(in) :: moduli(:)
      !> Products a_k of rate and D, >= 0, shape (modes)
      real(wp), intent(in) :: products(:)
      !> w_k at the start, shape (modes)
      real(wp), intent(in) :: start(:)
      !> x at the points, shape (0:n)
      real(wp), intent(in) :: x(0:)
      !> Sum
      real(wp) :: total

      real(wp) :: slope(nodes), power(ubound(x, 1)), root, w
      integer :: i, k

      slope = matmul(self%slope, x)
      power = matmul(self%power, x)
      total = 0.0_wp
      do k = 1, size(moduli)
         if (products(k) <= largest) then
            w = sum(slope*exp(-products(k)*self%square)) + start(k)*exp(-products(k))
         else
            root = 1.0_wp/sqrt(products(k))
            w = 0.0_wp
            do i = size(power), 1, -1
               w = (w + power(i))*root
            end do
         end if
         total = total + moduli(k)*w
      end do
   end function total

end module vcor_numeric_settling
