!> Legendre polynomials and the quadrature nodes made from them
module vcor_numeric_legendre
   use vcor_constants, only : pi
   use vcor_kinds, only : wp
   implicit none
   private

   public :: legendre, gauss_nodes, radau_nodes

contains

   !> Legendre polynomials P_0 .. P_n at x by the three-term recurrence
   pure function legendre(n, x) result(p)
      !> Highest degree, n >= 0
      integer, intent(in) :: n
      !> Argument
      real(wp), intent(in) :: x
      !> Values, shape (0:n)
      real(wp) :: p(0:n)

      integer :: k

      p(0) = 1.0_wp
      if (n >= 1) p(1) = x
      do k = 1, n - 1
         p(k + 1) = (real(2*k + 1, wp)*x*p(k) - real(k, wp)*p(k - 1))/real(k + 1, wp)
      end do
   end function legendre

   !> Derivative of P_n at x, |x| < 1, given P_0 .. P_n there
   pure function slope(n, x, p) result(dp)
      !> Degree, n >= 1
      integer, intent(in) :: n
      !> Argument
      real(wp), intent(in) :: x
      !> Values of the polynomials at x, shape (0:n)
      real(wp), intent(in) :: p(0:n)
      !> Derivative
      real(wp) :: dp

      dp = real(n, wp)*(p(n - 1) - x*p(n))/((1.0_wp - x)*(1.0_wp + x))
   end function slope

   !> Gauss-Legendre nodes and weights on (0, 1)
   pure subroutine gauss_nodes(node, weight)
      !> Nodes in increasing order, shape (n)
      real(wp), intent(out) :: node(:)
      !> Weights, shape (n)
      real(wp), intent(out) :: weight(:)

      real(wp) :: p(0:size(node)), x, dp
      integer :: n, i, iteration

      n = size(node)
      do i = 1, n
         x = -cos(pi*(real(i, wp) - 0.25_wp)/(real(n, wp) + 0.5_wp))
         do iteration = 1, 6
            p = legendre(n, x)
            x = x - p(n)/slope(n, x, p)
         end do
         p = legendre(n, x)
         dp = slope(n, x, p)
         node(i) = 0.5_wp*(1.0_wp + x)
         weight(i) = 1.0_wp/((1.0_wp - x)*(1.0_wp + x)*dp**2)
      end do
   end subroutine gauss_nodes

   !> Right Radau nodes on (0, 1]: the zeros of P_n - P_{n-1}, the last of them at 1
   pure subroutine radau_nodes(node)
      !> Nodes in increasing order, shape (n), n >= 2
      real(wp), intent(out) :: node(:)

      real(wp) :: p(0:size(node)), x, f, df
      integer :: n, i, iteration

      n = size(node)
      do i = 1, n - 1
         x = -cos(pi*(real(i, wp) - 0.5_wp)/(real(n, wp) - 0.25_wp))
         do iteration = 1, 8
            p = legendre(n, x)
            f = p(n) - p(n - 1)
            df = slope(n, x, p) - slope(n - 1, x, p(0:n - 1))
            x = x - f/df
         end do
         node(i) = 0.5_wp*(1.0_wp + x)
      end do
      node(n) = 1.0_wp
   end subroutine radau_nodes

end module vcor_numeric_legendre
