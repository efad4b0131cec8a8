!> Radau IIA collocation with diagonalised integration matrices
!>
!> On a panel of time the independent variable is theta in [0, 1] with a quadratic map,
!>
!>     t = t_n + scale*(slope*theta + bend*theta**2)
!>
!> The integrals from the start of the panel to the stages are scale*B times the integrand at the
!> stages, B = A diag(slope + 2 bend c), with the Radau IIA matrix A and its nodes c. There are only
!> four such maps, so each B = V diag(lambda) V^-1 is diagonalised once, and any function of scale*B
!> costs a few operations per eigenvalue. Of a conjugate pair one eigenvalue is kept: f(B) x is the
!> real part of `right` times f(lambda) times `left` x.
!>
!> Radau IIA: E. Hairer and G. Wanner, Solving Ordinary Differential Equations II, 2nd ed. (1996),
!> section IV.5.
module vcor_numeric_radau_rule
   use vcor_error, only : error_internal, error_t, raise
   use vcor_kinds, only : wp
   use vcor_numeric_lapack, only : dgeev, dgesv
   use vcor_numeric_quadrature, only : legendre, radau_nodes
   use vcor_numeric_radau_dense, only : width
   use vcor_numeric_radau_settling, only : new_settling, settling_t
   implicit none
   private

   public :: rule_t, map_t, new_rule, bridge_t, new_bridge, slots
   public :: opening, doubling, linear, closing

   !> Map t = t_n + D theta^2: a step in the square root of the time since its start
   integer, parameter :: opening = 1
   !> Map in sqrt(t) from t to 4 t
   integer, parameter :: doubling = 2
   !> Map that is linear in t
   integer, parameter :: linear = 3
   !> Map t = t_end - D (1 - theta)^2: a step in the square root of the time left
   integer, parameter :: closing = 4
   !> Coefficients of these maps for a duration of 1
   real(wp), parameter :: map_slope(closing) = [0.0_wp, 2.0_wp/3.0_wp, 1.0_wp, 2.0_wp]
   real(wp), parameter :: map_bend(closing) = [1.0_wp, 1.0_wp/3.0_wp, 0.0_wp, -1.0_wp]

   !> Number of eigenvalues kept: of eight, at most two are real, but for the map `closing`
   integer, parameter :: slots = 5

   !> Integration matrix B of one map, for a duration of 1
   type :: map_t
      !> Coefficients of the map
      real(wp) :: slope = 0.0_wp, bend = 0.0_wp
      !> B and its square
      real(wp) :: matrix(width, width) = 0.0_wp, square(width, width) = 0.0_wp
      !> Eigenvalues, one of each conjugate pair; 1 where there is none. The eigenvalue 0 of
      !> `closing`, whose last stage has no weight, is left out: functions f with f(0) = 0 do not
      !> need it, others do not hold at that stage
      complex(wp) :: eigenvalue(slots) = 1.0_wp
      !> From values at the stages to coefficients of the eigenvectors, their real and imaginary
      !> parts in turn, and back
      real(wp) :: left(2*slots, width) = 0.0_wp, right(width, 2*slots) = 0.0_wp
      !> The same for the last stage alone
      complex(wp) :: last(slots) = 0.0_wp
      !> `left` times a vector of ones
      complex(wp) :: left_one(slots) = 0.0_wp
   contains
      procedure :: function_of
      procedure :: decompose
      procedure :: compose
   end type map_t

   !> A Radau IIA rule
   type :: rule_t
      !> Number of stages
      integer :: stages = 0
      !> Start of the panel, 0, followed by the nodes, the last at 1
      real(wp) :: point(0:width) = 0.0_wp
      !> Quadrature weights of the nodes
      real(wp) :: weight(width) = 0.0_wp
      !> Barycentric weights of `point`
      real(wp) :: barycentric(0:width) = 0.0_wp
      !> Extrapolation to the end of the panel from all points but the last, and to its start from
      !> the nodes
      real(wp) :: end_weight(0:width) = 0.0_wp, start_weight(width) = 0.0_wp
      !> Differentiation matrix on `point`
      real(wp) :: derivative(0:width, 0:width) = 0.0_wp
      !> Exponentials at the end of a panel with the map `closing`
      type(settling_t) :: settling
      !> The maps
      type(map_t) :: map(closing)
   contains
      procedure :: basis
      procedure :: interpolate
      procedure :: interpolate_at
      procedure :: slopes
      procedure :: crossing
   end type rule_t

   !> Interpolation between the nodes of two rules
   type :: bridge_t
      !> From the points of the rule with more stages to the nodes of the other
      real(wp) :: down(width, 0:width) = 0.0_wp
      !> Back, for values that are 0 at the start
      real(wp) :: up(width, width) = 0.0_wp
   end type bridge_t

contains

   !> Build a rule and its diagonalised maps
   subroutine new_rule(self, stages, error)
      type(rule_t), intent(out) :: self
      !> Number of stages, 2 .. width
      integer, intent(in) :: stages
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: matrix(stages, stages)
      integer :: n

      n = stages
      self%stages = n
      call radau_nodes(self%point(1:n))
      self%barycentric(0:n) = barycentric_weights(self%point(0:n))
      self%derivative(0:n, 0:n) = differentiation_matrix(self%point(0:n), self%barycentric(0:n))
      self%end_weight(0:n - 1) = barycentric_weights(self%point(0:n - 1)) &
         /(1.0_wp - self%point(0:n - 1))
      self%end_weight = self%end_weight/sum(self%end_weight)
      self%start_weight(1:n) = -barycentric_weights(self%point(1:n))/self%point(1:n)
      self%start_weight = self%start_weight/sum(self%start_weight)
      call new_settling(self%settling, self%point(1:n))
      call integration_matrix(self%point(1:n), matrix, error)
      if (allocated(error)) return
      self%weight(1:n) = matrix(n, :)
      do n = 1, closing
         call diagonalise(matrix, self%point(1:stages), map_slope(n), map_bend(n), self%map(n), &
            error)
         if (allocated(error)) return
      end do
   end subroutine new_rule

   !> Build the interpolation between two rules
   pure subroutine new_bridge(self, fine, coarse)
      type(bridge_t), intent(out) :: self
      !> Rules with more and fewer stages
      type(rule_t), intent(in) :: fine, coarse

      real(wp) :: basis(0:width)
      integer :: i

      do i = 1, coarse%stages
         self%down(i, :) = fine%basis(coarse%point(i))
      end do
      do i = 1, fine%stages
         basis = coarse%basis(fine%point(i))
         self%up(i, :) = basis(1:)
      end do
   end subroutine new_bridge

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
      ! A value^T = integral^T, and the arrays hold the transposes
      call dgesv(n, n, value, n, pivot, integral, n, info)
      if (info /= 0) call raise(error, error_internal, 'collocation: the Radau matrix is singular')
      matrix = transpose(integral)
   end subroutine integration_matrix

   !> Eigenvalues and eigenvectors of B = A diag(slope + 2 bend c)
   subroutine diagonalise(matrix, node, slope, bend, map, error)
      !> Radau IIA matrix A, shape (n, n)
      real(wp), intent(in) :: matrix(:, :)
      !> Nodes c, shape (n)
      real(wp), intent(in) :: node(:)
      !> Coefficients of the map
      real(wp), intent(in) :: slope, bend
      !> The diagonalised map
      type(map_t), intent(out) :: map
      type(error_t), allocatable, intent(out) :: error

      ! eigenvalue over the largest one that is zero but for rounding: that of the map `closing` is
      ! 1e-16, the next one 0.13
      real(wp), parameter :: zero = 1.0e-9_wp
      real(wp), dimension(size(node), size(node)) :: b, vector, inverse, factors
      real(wp) :: wr(size(node)), wi(size(node)), none(1, 1), work(8*size(node))
      integer :: pivot(size(node)), n, j, m, info

      n = size(node)
      do j = 1, n
         b(:, j) = matrix(:, j)*(slope + 2.0_wp*bend*node(j))
      end do
      map%slope = slope
      map%bend = bend
      map%matrix(:n, :n) = b
      map%square(:n, :n) = matmul(b, b)
      call dgeev('N', 'V', n, b, n, wr, wi, none, 1, vector, n, work, size(work), info)
      if (info == 0) then
         inverse = 0.0_wp
         do j = 1, n
            inverse(j, j) = 1.0_wp
         end do
         factors = vector
         call dgesv(n, n, factors, n, pivot, inverse, n, info)
      end if
      if (info /= 0) then
         call raise(error, error_internal, &
            'collocation: the integration matrix has no eigenvectors')
         return
      end if
      m = 0
      do j = 1, n
         if (wi(j) < 0.0_wp .or. abs(wr(j)) <= zero*maxval(abs(wr))) cycle
         m = m + 1
         map%eigenvalue(m) = cmplx(wr(j), wi(j), wp)
         map%right(:n, 2*m - 1) = vector(:, j)
         map%left(2*m - 1, :n) = inverse(j, :)
         if (wi(j) > 0.0_wp) then
            ! x Re v + y Im v is the real part of (x - i y) v
            map%right(:n, 2*m) = -vector(:, j + 1)
            map%left(2*m, :n) = -inverse(j + 1, :)
         end if
      end do
      map%left_one = pairs(sum(map%left, 2))
      map%last = cmplx(map%right(n, 1::2), -map%right(n, 2::2), wp)
   end subroutine diagonalise

   !> The matrix f(B)
   pure function function_of(self, f) result(matrix)
      class(map_t), intent(in) :: self
      !> f at the eigenvalues
      complex(wp), intent(in) :: f(slots)
      !> f(B)
      real(wp) :: matrix(width, width)

      real(wp) :: r(width, 2*slots)
      integer :: i, j, m

      do m = 1, slots
         r(:, 2*m - 1) = real(f(m), wp)*self%right(:, 2*m - 1) + aimag(f(m))*self%right(:, 2*m)
         r(:, 2*m) = real(f(m), wp)*self%right(:, 2*m) - aimag(f(m))*self%right(:, 2*m - 1)
      end do
      do j = 1, width
         associate (l => self%left(:, j))
            do i = 1, width
               matrix(i, j) = (((r(i, 1)*l(1) + r(i, 2)*l(2)) + (r(i, 3)*l(3) + r(i, 4)*l(4))) &
                  + ((r(i, 5)*l(5) + r(i, 6)*l(6)) + (r(i, 7)*l(7) + r(i, 8)*l(8)))) &
                  + (r(i, 9)*l(9) + r(i, 10)*l(10))
            end do
         end associate
      end do
   end function function_of

   !> Coefficients of the eigenvectors in a vector
   pure function decompose(self, x) result(c)
      class(map_t), intent(in) :: self
      !> Values at the stages
      real(wp), intent(in) :: x(width)
      !> Coefficients
      complex(wp) :: c(slots)

      real(wp) :: y(2*slots)
      integer :: i

      associate (l => self%left)
         do i = 1, 2*slots
            y(i) = ((l(i, 1)*x(1) + l(i, 2)*x(2)) + (l(i, 3)*x(3) + l(i, 4)*x(4))) &
               + ((l(i, 5)*x(5) + l(i, 6)*x(6)) + (l(i, 7)*x(7) + l(i, 8)*x(8)))
         end do
      end associate
      c = pairs(y)
   end function decompose

   !> Complex numbers from their real and imaginary parts, in turn
   pure function pairs(y) result(c)
      real(wp), intent(in) :: y(2*slots)
      complex(wp) :: c(slots)

      c = cmplx(y(1::2), y(2::2), wp)
   end function pairs

   !> The vector with given coefficients
   pure function compose(self, c) result(x)
      class(map_t), intent(in) :: self
      !> Coefficients of the eigenvectors
      complex(wp), intent(in) :: c(slots)
      !> Values at the stages
      real(wp) :: x(width)

      real(wp) :: y(2*slots)
      integer :: i

      y(1::2) = real(c, wp)
      y(2::2) = aimag(c)
      associate (r => self%right)
         do i = 1, width
            x(i) = (((r(i, 1)*y(1) + r(i, 2)*y(2)) + (r(i, 3)*y(3) + r(i, 4)*y(4))) &
               + ((r(i, 5)*y(5) + r(i, 6)*y(6)) + (r(i, 7)*y(7) + r(i, 8)*y(8)))) &
               + (r(i, 9)*y(9) + r(i, 10)*y(10))
         end do
      end associate
   end function compose

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

   !> Lagrange polynomials of the points
   pure function basis(self, theta) result(value)
      class(rule_t), intent(in) :: self
      !> Argument, in [0, 1], or somewhat beyond to extrapolate
      real(wp), intent(in) :: theta
      !> Their values
      real(wp) :: value(0:width)

      real(wp) :: before, after
      integer :: j

      value = 0.0_wp
      before = 1.0_wp
      do j = 0, self%stages
         value(j) = self%barycentric(j)*before
         before = before*(theta - self%point(j))
      end do
      after = 1.0_wp
      do j = self%stages, 0, -1
         value(j) = value(j)*after
         after = after*(theta - self%point(j))
      end do
   end function basis

   !> Value of the polynomial through given values at the points
   pure function interpolate(self, value, theta) result(y)
      class(rule_t), intent(in) :: self
      !> Values at `point`
      real(wp), intent(in) :: value(0:width)
      !> Argument
      real(wp), intent(in) :: theta
      real(wp) :: y

      y = sum(self%basis(theta)*value)
   end function interpolate

   !> Values of the polynomial through given values at the points, at many arguments
   pure function interpolate_at(self, value, theta) result(y)
      class(rule_t), intent(in) :: self
      !> Values at `point`
      real(wp), intent(in) :: value(0:width)
      !> Arguments
      real(wp), intent(in) :: theta(width)
      real(wp) :: y(width)

      real(wp) :: before(width, 0:width), after(width)
      integer :: j

      before(:, 0) = 1.0_wp
      do j = 1, self%stages
         before(:, j) = before(:, j - 1)*(theta - self%point(j - 1))
      end do
      after = 1.0_wp
      y = 0.0_wp
      do j = self%stages, 0, -1
         y = y + (self%barycentric(j)*value(j))*(before(:, j)*after)
         after = after*(theta - self%point(j))
      end do
   end function interpolate_at

   !> Derivative by theta, at the points, of the polynomial through given values there
   pure function slopes(self, value) result(slope)
      class(rule_t), intent(in) :: self
      !> Values at `point`
      real(wp), intent(in) :: value(0:width)
      !> Derivative
      real(wp) :: slope(0:width)

      integer :: j

      slope = self%derivative(:, 0)*value(0)
      do j = 1, width
         slope = slope + self%derivative(:, j)*value(j)
      end do
   end function slopes

   !> Zero of the polynomial through given values between two points where it changes sign, by the
   !> Illinois method; the second point if the signs are equal
   pure function crossing(self, value, first, tolerance) result(theta)
      class(rule_t), intent(in) :: self
      !> Values at `point`
      real(wp), intent(in) :: value(0:width)
      !> Index of the first of the two points
      integer, intent(in) :: first
      !> Iteration ends with a step of this size; the error is smaller
      real(wp), intent(in) :: tolerance
      real(wp) :: theta

      real(wp) :: a, b, fa, fb, f, previous
      integer :: iteration

      a = self%point(first)
      b = self%point(first + 1)
      fa = value(first)
      fb = value(first + 1)
      theta = b
      if ((fa > 0.0_wp) .eqv. (fb > 0.0_wp)) return
      do iteration = 1, 100
         previous = theta
         theta = (a*fb - b*fa)/(fb - fa)
         if (abs(theta - previous) <= tolerance) exit
         f = self%interpolate(value, theta)
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
   end function crossing

end module vcor_numeric_radau_rule
