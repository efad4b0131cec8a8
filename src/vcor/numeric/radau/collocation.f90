!> Radau IIA collocation with diagonalised integration matrices
!>
!> On a panel of time the independent variable is theta in [0, 1] with the quadratic map
!>
!>     t = t_n + scale*(slope*theta + bend*theta**2)
!>
!> The integrals from the start of the panel to the stages are the product of scale*B and the
!> integrand at the stages, B = A diag(slope + 2 bend c), with the Radau IIA matrix A and its nodes
!> c. A step of length h in x = sqrt(t) from x = n h has scale = h^2, slope = 2 n, bend = 1; a step
!> in t has slope = 1, bend = 0. There are few such matrices, so each B = V diag(lambda) V^-1 is
!> diagonalised once, and any function of scale*B costs a few scalar operations per eigenvalue.
!>
!> Radau IIA: E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, 2nd ed. (1996),
!> section IV.5.
module vcor_numeric_radau_collocation
   use vcor_error, only : error_internal, error_t, raise
   use vcor_kinds, only : wp
   use vcor_numeric_lapack, only : dgeev, dgesv
   use vcor_numeric_quadrature, only : legendre, radau_nodes
   use vcor_numeric_radau_algebra, only : pairs, width
   use vcor_numeric_radau_settling, only : new_settling, settling_t
   implicit none
   private

   public :: collocation_t, panel_map_t, new_collocation
   public :: closing, linear, most_steps

   !> Index of the map for a step in t
   integer, parameter :: linear = -1
   !> Index of the map for a step in the square root of the time left to the end of the panel
   integer, parameter :: closing = linear - 1
   !> Steps in x = sqrt(t) may start at x = 0, h, .. most_steps*h; later steps are in t. Each map
   !> takes 0.1 ms at the start of the program; of the 7,000 panels in the tests only nine would
   !> start beyond 5 h
   integer, parameter :: most_steps = 5

   !> Integration matrix B = V diag(lambda) V^-1 of one map, diagonalised
   !>
   !> Eigenvalues are kept as pairs a + b j and a - b j: complex ones with j^2 = -1, real ones two
   !> by two with j^2 = +1. A function f of B is then one number f = a + b j per pair, stored as a
   !> vector of `width`: first all a, then all b. `right` and `left` are real matrices: f(B) u is
   !> `right` times the pairwise product (`times` of `vcor_numeric_radau_algebra`) of f and `left` u
   type :: panel_map_t
      !> Linear coefficient of the map
      real(wp) :: slope = 0.0_wp
      !> Quadratic coefficient of the map
      real(wp) :: bend = 0.0_wp
      !> B itself
      real(wp) :: matrix(width, width) = 0.0_wp
      !> j^2 of each pair
      real(wp) :: square(pairs) = 1.0_wp
      !> Eigenvalues; unused pairs are 1 and have no vectors
      real(wp) :: eigenvalue(width) = [spread(1.0_wp, 1, pairs), spread(0.0_wp, 1, pairs)]
      !> Matrix from the numbers of the pairs to the stages
      real(wp) :: right(width, width) = 0.0_wp
      !> Matrix from the stages to the numbers of the pairs
      real(wp) :: left(width, width) = 0.0_wp
      !> Row of `right` for the last stage
      real(wp) :: last(width) = 0.0_wp
      !> V^-1 applied to a vector of ones
      real(wp) :: left_one(width) = 0.0_wp
   end type panel_map_t

   !> A Radau IIA rule
   type :: collocation_t
      !> Number of stages
      integer :: stages = 0
      !> Nodes in (0, 1], the last at 1
      real(wp) :: node(width) = 0.0_wp
      !> Quadrature weights of the nodes
      real(wp) :: weight(width) = 0.0_wp
      !> Start of the panel, 0, followed by the nodes
      real(wp) :: point(0:width) = 0.0_wp
      !> Barycentric weights of `point`
      real(wp) :: barycentric(0:width) = 0.0_wp
      !> Extrapolation to the end of the panel from all points but the last
      real(wp) :: end_weight(0:width) = 0.0_wp
      !> From values at `point` to the coefficients of 1, theta, theta^2 ...; costs five digits
      real(wp) :: power(0:width, 0:width) = 0.0_wp
      !> Differentiation matrix on `point`
      real(wp) :: derivative(0:width, 0:width) = 0.0_wp
      !> Exponentials at the end of a panel with the map `closing`
      type(settling_t) :: settling
      !> Maps by index: n >= 0 for a step in x = sqrt(t) from x = n h, `linear` for a step in t,
      !> `closing` for one in sqrt(time left). (The size is fixed because gfortran 12, when it
      !> copies a solver with two allocatable arrays of maps, releases only one of them.)
      type(panel_map_t) :: map(closing:most_steps)
   contains
      procedure :: times, interpolate, extend, slopes, crossing
      procedure, private :: powers
   end type collocation_t

contains

   !> Build a rule and its diagonalised maps
   subroutine new_collocation(self, stages, error)
      type(collocation_t), intent(out) :: self
      !> Number of stages, 2 .. width
      integer, intent(in) :: stages
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: matrix(stages, stages)
      integer :: n

      self%stages = stages
      call radau_nodes(self%node(1:stages))
      self%point(1:stages) = self%node(1:stages)
      self%barycentric(0:stages) = barycentric_weights(self%point(0:stages))
      self%power(0:stages, 0:stages) = power_matrix(self%point(0:stages))
      self%derivative(0:stages, 0:stages) = &
         differentiation_matrix(self%point(0:stages), self%barycentric(0:stages))
      self%end_weight(0:stages - 1) = barycentric_weights(self%point(0:stages - 1)) &
         /(1.0_wp - self%point(0:stages - 1))
      self%end_weight = self%end_weight/sum(self%end_weight)
      call new_settling(self%settling, self%point(0:stages))
      call integration_matrix(self%node(1:stages), matrix, error)
      if (allocated(error)) return
      self%weight(1:stages) = matrix(stages, :)

      call diagonalise(matrix, self%node(1:stages), 2.0_wp, -1.0_wp, self%map(closing), error)
      if (allocated(error)) return
      call diagonalise(matrix, self%node(1:stages), 1.0_wp, 0.0_wp, self%map(linear), error)
      if (allocated(error)) return
      do n = 0, most_steps
         call diagonalise(matrix, self%node(1:stages), 2.0_wp*real(n, wp), 1.0_wp, self%map(n), &
            error)
         if (allocated(error)) return
      end do
   end subroutine new_collocation

   !> Radau IIA matrix, A_ij = int_0^{c_i} l_j, by way of Legendre polynomials, whose integrals are
   !> known: int_{-1}^{x} P_k = (P_{k+1} - P_{k-1})/(2k + 1)
   subroutine integration_matrix(node, matrix, error)
      !> Nodes in (0, 1], shape (n)
      real(wp), intent(in) :: node(:)
      !> Integrals, shape (n, n)
      real(wp), intent(out) :: matrix(:, :)
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: value(size(node), size(node)), integral(size(node), size(node))
      real(wp) :: p(0:size(node))
      integer :: pivot(size(node)), n, i, k, info

      n = size(node)
      do i = 1, n
         p = legendre(n, 2.0_wp*node(i) - 1.0_wp)
         value(:, i) = p(0:n - 1)
         integral(1, i) = node(i)
         do k = 1, n - 1
            integral(k + 1, i) = 0.5_wp*(p(k + 1) - p(k - 1))/real(2*k + 1, wp)
         end do
      end do
      ! A value^T = integral^T; the arrays hold the transposes, so solve value (A^T) = integral
      call dgesv(n, n, value, n, pivot, integral, n, info)
      if (info /= 0) then
         call raise(error, error_internal, 'collocation: the Radau matrix is singular')
         return
      end if
      matrix = transpose(integral)
   end subroutine integration_matrix

   !> Eigenvalues and eigenvectors of B = A diag(slope + 2 bend c)
   subroutine diagonalise(matrix, node, slope, bend, map, error)
      !> Radau IIA matrix A, shape (n, n)
      real(wp), intent(in) :: matrix(:, :)
      !> Nodes c, shape (n)
      real(wp), intent(in) :: node(:)
      !> Linear coefficient of the map
      real(wp), intent(in) :: slope
      !> Quadratic coefficient of the map
      real(wp), intent(in) :: bend
      !> The diagonalised map
      type(panel_map_t), intent(out) :: map
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: b(size(node), size(node)), wr(size(node)), wi(size(node))
      real(wp) :: vl(1, 1), vr(size(node), size(node)), work(8*size(node))
      real(wp) :: inverse(size(node), size(node)), factors(size(node), size(node))
      integer :: pivot(size(node)), n, j, m, other, info

      n = size(node)
      do j = 1, n
         b(:, j) = matrix(:, j)*(slope + 2.0_wp*bend*node(j))
      end do
      map%slope = slope
      map%bend = bend
      map%matrix(1:n, 1:n) = b
      call dgeev('N', 'V', n, b, n, wr, wi, vl, 1, vr, n, work, size(work), info)
      if (info == 0) then
         inverse = 0.0_wp
         do j = 1, n
            inverse(j, j) = 1.0_wp
         end do
         factors = vr
         call dgesv(n, n, factors, n, pivot, inverse, n, info)
      end if
      if (info /= 0) then
         call raise(error, error_internal, &
            'collocation: the integration matrix has no eigenvectors')
         return
      end if

      m = 0
      other = 0
      do j = 1, n
         if (wi(j) > 0.0_wp) then
            ! the real part of (x - i y) v is x Re v + y Im v
            m = m + 1
            map%square(m) = -1.0_wp
            map%eigenvalue([m, pairs + m]) = [wr(j), wi(j)]
            map%right(1:n, m) = vr(:, j)
            map%right(1:n, pairs + m) = -vr(:, j + 1)
            map%left(m, 1:n) = inverse(j, :)
            map%left(pairs + m, 1:n) = -inverse(j + 1, :)
         else if (wi(j) < 0.0_wp) then
            cycle
         else if (other == 0) then
            other = j
         else
            call join(other, j)
            other = 0
         end if
      end do
      ! an odd number of real eigenvalues leaves one over
      if (other > 0) then
         m = m + 1
         map%eigenvalue(m) = wr(other)
         map%right(1:n, m) = vr(:, other)
         map%left(m, 1:n) = inverse(other, :)
      end if
      map%left_one = sum(map%left, 2)
      map%last = map%right(n, :)

   contains

      !> Combine two real eigenvalues into a pair a + b and a - b:
      !> x v + y w = (x + y)/2 (v + w) + (x - y)/2 (v - w)
      subroutine join(first, second)
         !> Number of the first eigenvalue
         integer, intent(in) :: first
         !> Number of the second eigenvalue
         integer, intent(in) :: second

         m = m + 1
         map%eigenvalue(m) = 0.5_wp*(wr(first) + wr(second))
         map%eigenvalue(pairs + m) = 0.5_wp*(wr(first) - wr(second))
         map%right(1:n, m) = vr(:, first) + vr(:, second)
         map%right(1:n, pairs + m) = vr(:, first) - vr(:, second)
         map%left(m, 1:n) = 0.5_wp*(inverse(first, :) + inverse(second, :))
         map%left(pairs + m, 1:n) = 0.5_wp*(inverse(first, :) - inverse(second, :))
      end subroutine join
   end subroutine diagonalise

   !> Barycentric weights of a set of nodes
   pure function barycentric_weights(x) result(w)
      !> Nodes, all different, shape (n)
      real(wp), intent(in) :: x(:)
      !> Weights, shape (n)
      real(wp) :: w(size(x))

      integer :: i

      do i = 1, size(x)
         w(i) = 1.0_wp/(product(x(i) - x(:i - 1))*product(x(i) - x(i + 1:)))
      end do
   end function barycentric_weights

   !> Coefficients of the Lagrange polynomials in powers of x, one polynomial per column
   pure function power_matrix(x) result(power)
      !> Nodes, all different, shape (0:n)
      real(wp), intent(in) :: x(0:)
      !> Coefficients, shape (0:n, 0:n)
      real(wp) :: power(0:ubound(x, 1), 0:ubound(x, 1))

      integer :: i, j

      power = 0.0_wp
      power(0, :) = 1.0_wp
      do i = 0, ubound(x, 1)
         do j = 0, ubound(x, 1)
            if (j /= i) power(:, i) = (eoshift(power(:, i), -1) - x(j)*power(:, i))/(x(i) - x(j))
         end do
      end do
   end function power_matrix

   !> Differentiation matrix: row i times the values is the derivative of their polynomial at node i
   pure function differentiation_matrix(x, w) result(d)
      !> Nodes, shape (n)
      real(wp), intent(in) :: x(:)
      !> Their barycentric weights, shape (n)
      real(wp), intent(in) :: w(:)
      !> Matrix, shape (n, n)
      real(wp) :: d(size(x), size(x))

      integer :: i, j

      do j = 1, size(x)
         do i = 1, size(x)
            if (i /= j) d(i, j) = (w(j)/w(i))/(x(i) - x(j))
         end do
      end do
      do i = 1, size(x)
         d(i, i) = -sum(d(i, :i - 1)) - sum(d(i, i + 1:))
      end do
   end function differentiation_matrix

   !> Times of the stages of a panel since its start
   pure function times(self, index, scale)
      class(collocation_t), intent(in) :: self
      !> Index of the map
      integer, intent(in) :: index
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> Times [s]
      real(wp) :: times(width)

      associate (map => self%map(index))
         times = scale*self%node*(map%slope + map%bend*self%node)
      end associate
   end function times

   !> Value of the polynomial through given values at the points
   pure function interpolate(self, value, theta) result(y)
      class(collocation_t), intent(in) :: self
      !> Values at `point`, shape (0:stages)
      real(wp), intent(in) :: value(0:)
      !> Argument, in [0, 1], or somewhat beyond to extrapolate
      real(wp), intent(in) :: theta
      real(wp) :: y

      real(wp) :: before(0:width), after
      integer :: j

      ! Lagrange's form, with the products of the differences before and after each point
      before(0) = 1.0_wp
      do j = 1, self%stages
         before(j) = before(j - 1)*(theta - self%point(j - 1))
      end do
      after = 1.0_wp
      y = 0.0_wp
      do j = self%stages, 0, -1
         y = y + value(j)*self%barycentric(j)*before(j)*after
         after = after*(theta - self%point(j))
      end do
   end function interpolate

   !> Values of the polynomial through given values at the points, for many arguments and with ten
   !> digits: an initial guess
   pure function extend(self, value, theta) result(y)
      class(collocation_t), intent(in) :: self
      !> Values at `point`
      real(wp), intent(in) :: value(0:width)
      !> Arguments
      real(wp), intent(in) :: theta(width)
      real(wp) :: y(width)

      real(wp) :: c(0:width)
      integer :: i

      c = self%powers(value)
      do i = 1, width
         y(i) = c(0) + theta(i)*(c(1) + theta(i)*(c(2) + theta(i)*(c(3) + theta(i)*(c(4) &
            + theta(i)*(c(5) + theta(i)*(c(6) + theta(i)*(c(7) + theta(i)*c(8))))))))
      end do
   end function extend

   !> Coefficients of 1, theta, theta^2 ... of the polynomial through given values at the points
   pure function powers(self, value) result(c)
      class(collocation_t), intent(in) :: self
      !> Values at `point`
      real(wp), intent(in) :: value(0:width)
      real(wp) :: c(0:width)

      c = combined(self%power, value)
   end function powers

   !> Product of a matrix and values at the points, written out as in `apply`
   pure function combined(a, x) result(y)
      !> Matrix
      real(wp), intent(in) :: a(0:width, 0:width)
      !> Vector
      real(wp), intent(in) :: x(0:width)
      !> a x
      real(wp) :: y(0:width)

      integer :: i

      do i = 0, width
         y(i) = (((a(i, 0)*x(0) + a(i, 1)*x(1)) + (a(i, 2)*x(2) + a(i, 3)*x(3))) &
            + ((a(i, 4)*x(4) + a(i, 5)*x(5)) + (a(i, 6)*x(6) + a(i, 7)*x(7)))) + a(i, 8)*x(8)
      end do
   end function combined

   !> Derivative by theta, at the points, of the polynomial through given values there
   pure function slopes(self, value) result(slope)
      class(collocation_t), intent(in) :: self
      !> Values at `point`
      real(wp), intent(in) :: value(0:width)
      !> Derivative
      real(wp) :: slope(0:width)

      slope = combined(self%derivative, value)
   end function slopes

   !> Zero of the polynomial through given values, in an interval where it changes sign, by the
   !> Illinois method, to ten digits; the upper end if the signs are equal
   pure function crossing(self, value, lower, upper, tolerance) result(theta)
      class(collocation_t), intent(in) :: self
      !> Values at `point`
      real(wp), intent(in) :: value(0:width)
      !> Lower end of the interval
      real(wp), intent(in) :: lower
      !> Upper end of the interval
      real(wp), intent(in) :: upper
      !> Iteration ends with a step of this size; the error is smaller
      real(wp), intent(in) :: tolerance
      real(wp) :: theta

      real(wp) :: c(0:width), a, b, fa, fb, f, previous
      integer :: iteration

      c = self%powers(value)
      a = lower
      b = upper
      fa = at(a)
      fb = at(b)
      theta = b
      if ((fa > 0.0_wp) .eqv. (fb > 0.0_wp)) return
      do iteration = 1, 100
         previous = theta
         theta = (a*fb - b*fa)/(fb - fa)
         if (abs(theta - previous) <= tolerance) exit
         f = at(theta)
         if ((f > 0.0_wp) .neqv. (fb > 0.0_wp)) then
            a = b
            fa = fb
         else
            fa = 0.5_wp*fa
         end if
         b = theta
         fb = f
         if (.not. abs(fb - fa) > 0.0_wp) exit
      end do

   contains

      !> Value of the polynomial; the order of the products leaves few dependent steps
      pure function at(x) result(y)
         !> Argument
         real(wp), intent(in) :: x
         real(wp) :: y

         real(wp) :: x2, x4

         x2 = x*x
         x4 = x2*x2
         y = ((c(0) + c(1)*x) + (c(2) + c(3)*x)*x2) &
            + (((c(4) + c(5)*x) + (c(6) + c(7)*x)*x2) + c(8)*x4)*x4
      end function at
   end function crossing

end module vcor_numeric_radau_collocation
