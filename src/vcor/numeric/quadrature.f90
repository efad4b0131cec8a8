!> Quadrature rules for integrals of relaxation moduli; Legendre polynomials, nodes of Gauss and
!> Radau
module vcor_numeric_quadrature
   use vcor_kinds, only : pi, wp
   implicit none
   private

   public :: endpoint_rule, fourier_rule, graded_rule, newton_cotes
   public :: legendre, gauss_nodes, radau_nodes

   !> Closed Newton-Cotes rule of nine points on (0, 1)
   real(wp), parameter :: newton_cotes(0:8) = [989.0_wp, 5888.0_wp, -928.0_wp, 10496.0_wp, &
      -4540.0_wp, 10496.0_wp, -928.0_wp, 5888.0_wp, 989.0_wp]/28350.0_wp

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

   !> Right Radau nodes on (0, 1]: the zeros of P_n - P_{n-1}, of which the last is 1
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

   !> Rule on (0, 1) for integrands with an integrable singularity of unknown kind at 0: the
   !> double-exponential substitution of Takahasi and Mori, Publ. RIMS 9 (1974) 721,
   !> doi:10.2977/prims/1195192451
   pure subroutine endpoint_rule(node, weight)
      !> Nodes, shape (n)
      real(wp), allocatable, intent(out) :: node(:)
      !> Weights, shape (n)
      real(wp), allocatable, intent(out) :: weight(:)

      ! the nodes reach down to 1e-51; what lies below is 2e-11 of the integral of t^-0.8 and 4e-6
      ! of that of t^-0.9, with half of the nodes 6e-2 and 0.2
      integer, parameter :: half = 48
      ! a change at a thousandth of the end is integrated to 2e-12; with twice the step to 1e-6
      real(wp), parameter :: h = 0.09_wp
      real(wp) :: y, e
      integer :: i

      allocate (node(-half:half), weight(-half:half))
      do i = -half, half
         y = h*real(i, wp)
         ! the node is 1/(1 + exp(-pi sinh y)): tiny near 0, but with full relative accuracy
         e = exp(-pi*sinh(y))
         node(i) = 1.0_wp/(1.0_wp + e)
         weight(i) = h*pi*cosh(y)*node(i)*(e*node(i))
      end do
   end subroutine endpoint_rule

   !> Rule from 0 to the last of some ends, for integrands that may be singular at 0 and may vary at
   !> any scale of the logarithm: the endpoint rule up to the first end, Gauss-Legendre in the
   !> logarithm between the others
   pure subroutine graded_rule(ends, node, weight, last)
      !> Ends, > 0, increasing by factors of about 3, shape (m)
      real(wp), intent(in) :: ends(:)
      !> Nodes in increasing order, shape (n)
      real(wp), allocatable, intent(out) :: node(:)
      !> Weights, shape (n)
      real(wp), allocatable, intent(out) :: weight(:)
      !> Number of nodes below each end, shape (m)
      integer, intent(out), optional :: last(:)

      ! over a factor of 3.3 in t: fourteen digits of exp(-t), at least nine of 1/(1 + c exp(-t))
      integer, parameter :: order = 12
      real(wp), allocatable :: first_node(:), first_weight(:)
      real(wp) :: x(order), w(order), t(order), length
      integer :: i, n

      call endpoint_rule(first_node, first_weight)
      n = size(first_node)
      allocate (node(n + order*(size(ends) - 1)), weight(n + order*(size(ends) - 1)))
      node(:n) = ends(1)*first_node
      weight(:n) = ends(1)*first_weight
      if (present(last)) last(1) = n
      call gauss_nodes(x, w)
      do i = 2, size(ends)
         length = log(ends(i)/ends(i - 1))
         t = ends(i - 1)*exp(length*x)
         node(n + 1:n + order) = t
         weight(n + 1:n + order) = length*w*t
         n = n + order
         if (present(last)) last(i) = n
      end do
   end subroutine graded_rule

   !> Rules for int_0^inf f(x) sin(x) dx and int_0^inf f(x) cos(x) dx with f smooth in log(x) and
   !> slowly decaying: T. Ooura and M. Mori, J. Comput. Appl. Math. 112 (1999) 229,
   !> doi:10.1016/S0377-0427(99)00223-X
   pure subroutine fourier_rule(sine_node, sine_weight, cosine_node, cosine_weight)
      !> Nodes of the sine rule, shape (n)
      real(wp), allocatable, intent(out) :: sine_node(:)
      !> Weights of the sine rule, sin(x) included, shape (n)
      real(wp), allocatable, intent(out) :: sine_weight(:)
      !> Nodes of the cosine rule, shape (n)
      real(wp), allocatable, intent(out) :: cosine_node(:)
      !> Weights of the cosine rule, cos(x) included, shape (n)
      real(wp), allocatable, intent(out) :: cosine_weight(:)

      ! towards x = 0 the terms fall only with phi, as exp(-a exp(-y)) with a small a: the cosine
      ! rule needs nodes down to 1e-200 for a power law of exponent 0.9; 80 nodes leave 5e-3 of it.
      ! With 45 nodes in place of 60 powers are off by up to 7e-5, with twice the step exp(-1000 x)
      ! by 5e-5 (2e-12)
      integer, parameter :: first = -110, last = 60
      real(wp), parameter :: h = 0.08_wp, m = pi/h
      real(wp) :: y, phi, slope, excess
      integer :: i

      allocate (sine_node(first:last), sine_weight(first:last))
      allocate (cosine_node(first:last), cosine_weight(first:last))
      do i = first, last
         y = h*real(i, wp)
         call substitution(y, m, phi, slope, excess)
         sine_node(i) = m*phi
         ! m y is a multiple of pi, so the sine of a large x = m phi is +-that of m (phi - y)
         if (y > 0.0_wp) then
            sine_weight(i) = m*h*slope*real(1 - 2*modulo(i, 2), wp)*sin(m*excess)
         else
            sine_weight(i) = m*h*slope*sin(m*phi)
         end if
         y = h*(real(i, wp) - 0.5_wp)
         call substitution(y, m, phi, slope, excess)
         cosine_node(i) = m*phi
         if (y > 0.0_wp) then
            cosine_weight(i) = m*h*slope*real(1 - 2*modulo(i, 2), wp)*sin(m*excess)
         else
            cosine_weight(i) = m*h*slope*cos(m*phi)
         end if
      end do
   end subroutine fourier_rule

   !> phi(y) = y/(1 - exp(-2 y - a (1 - exp(-y)) - b (exp(y) - 1))), its derivative and phi - y
   pure subroutine substitution(y, m, phi, slope, excess)
      !> Argument
      real(wp), intent(in) :: y
      !> Scale of the rule, pi divided by its step
      real(wp), intent(in) :: m
      real(wp), intent(out) :: phi
      !> Derivative
      real(wp), intent(out) :: slope
      !> phi - y, without cancellation for y > 0
      real(wp), intent(out) :: excess

      ! the authors' choice; with half of it powers are off by up to 2e-8, with its double nodes
      ! underflow
      real(wp), parameter :: b = 0.25_wp
      real(wp) :: a, g, dg, e

      a = b/sqrt(1.0_wp + m*log(1.0_wp + m)/(4.0_wp*pi))
      g = 2.0_wp*y + a*(1.0_wp - exp(-y)) + b*(exp(y) - 1.0_wp)
      dg = 2.0_wp + a*exp(-y) + b*exp(y)
      ! only exp(-|g|) is computed: it cannot overflow
      if (abs(y) < 1.0e-8_wp) then
         phi = 1.0_wp/dg
         slope = 0.5_wp - 0.5_wp*(b - a)/dg**2
         excess = phi - y
      else if (y > 0.0_wp) then
         e = exp(-g)
         phi = y/(1.0_wp - e)
         slope = (1.0_wp - e - y*dg*e)/(1.0_wp - e)**2
         excess = phi*e
      else
         e = exp(g)
         phi = -y*e/(1.0_wp - e)
         slope = -e*(1.0_wp - e + y*dg)/(1.0_wp - e)**2
         excess = phi - y
      end if
   end subroutine substitution

end module vcor_numeric_quadrature
