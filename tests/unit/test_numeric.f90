!> Quadrature, scalar product, linear systems, collocation
program test_numeric
   use, intrinsic :: iso_fortran_env, only : int32
   use vcor_error, only : error_t
   use vcor_kinds, only : pi, wp
   use vcor_io_crc, only : crc32
   use vcor_solver_convolution, only : dot
   use vcor_numeric_quadrature, only : endpoint_rule, fourier_rule, gauss_nodes, &
      & legendre, radau_nodes
   use vcor_numeric_radau_dense, only : apply, invert, width
   use vcor_numeric_radau_rule, only : closing, doubling, linear, map_t, new_rule, opening, rule_t
   use vcor_numeric_radau_settling, only : new_settling, settling_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : random_t, success
   implicit none

   !> A sum of some ten terms of order one
   real(wp), parameter :: rounding = 4.0e-15_wp
   !> endpoint_rule cuts off what lies below 1e-51; the sum has a hundred terms
   real(wp), parameter :: endpoint_tolerance = 1.0e-13_wp
   !> int_0^delta t^-0.9 with delta = 1e-51 is 1e-5 of the whole
   real(wp), parameter :: strong_endpoint_tolerance = 2.0e-5_wp
   !> fourier_rule is to carry loss tangents of 12 digits
   real(wp), parameter :: fourier_tolerance = 1.0e-12_wp
   !> Pivoted elimination on random systems of up to ten equations: their condition is below 1e4
   real(wp), parameter :: linear_tolerance = 1.0e-11_wp
   !> Polynomials on up to eleven points, no cancellation of more than three digits
   real(wp), parameter :: collocation_tolerance = 1.0e-11_wp
   !> The eigenvectors of the collocation matrices have condition numbers that grow tenfold with
   !> each stage: what is left of 16 digits with 2 .. 8 stages
   real(wp), parameter :: eigenvector_tolerance(2:8) = [1.0e-14_wp, 1.0e-13_wp, 1.0e-13_wp, &
      1.0e-12_wp, 1.0e-12_wp, 1.0e-11_wp, 1.0e-10_wp]
   !> Slopes of polynomials on nine points from their values: two digits of the 16
   real(wp), parameter :: settling_tolerance = 1.0e-13_wp
   !> Rules that are tested
   integer, parameter :: most_stages = min(width, ubound(eigenvector_tolerance, 1))

   call suite("numeric")
   call test_legendre()
   call test_gauss()
   call test_radau()
   call test_endpoint()
   call test_fourier()
   call test_crc()
   call test_dot()
   call test_linear()
   call test_collocation()
   call test_settling()
   call finish()

contains

   !> The check value of CRC-32, in one piece and in two of any length
   subroutine test_crc()
      integer :: i
      character(len=*), parameter :: text = '123456789'
      ! 0xCBF43926 as a signed number
      integer(int32), parameter :: expected = -873187034_int32
      logical :: same

      same = .true.
      do i = 0, 9
         same = same .and. crc32(text(i + 1:), crc32(text(:i), 0_int32)) == expected
      end do
      call check(same, 'CRC-32 of 123456789')
   end subroutine test_crc

   !> Legendre polynomials against their closed forms
   subroutine test_legendre()
      real(wp), parameter :: x = 0.3_wp
      real(wp) :: p(0:4), one(0:0)

      p = legendre(4, x)
      call check_close(p, [1.0_wp, x, 0.5_wp*(3.0_wp*x**2 - 1.0_wp), &
         0.5_wp*x*(5.0_wp*x**2 - 3.0_wp), 0.125_wp*(35.0_wp*x**4 - 30.0_wp*x**2 + 3.0_wp)], &
         rounding, "Legendre polynomials up to degree 4")
      one = legendre(0, x)
      call check_close(one, 1.0_wp, 0.0_wp, "P_0 alone")
      p = legendre(4, 1.0_wp)
      call check_close(p, 1.0_wp, rounding, "all Legendre polynomials are 1 at 1")
   end subroutine test_legendre

   !> Gauss' rule of n nodes is exact to degree 2 n - 1, and no further
   subroutine test_gauss()
      real(wp), allocatable :: node(:), weight(:)
      integer :: n, k

      do n = 1, 20
         allocate (node(n), weight(n))
         call gauss_nodes(node, weight)
         do k = 0, 2*n - 1
            call check_close(sum(weight*node**k), 1.0_wp/real(k + 1, wp), rounding, &
               "Gauss' rule integrates polynomials up to degree 2 n - 1")
         end do
         call check(all(node > 0.0_wp) .and. all(node < 1.0_wp) .and. all(weight > 0.0_wp), &
            "Gauss' nodes are inside, the weights positive")
         call check(all(node(2:) > node(:n - 1)), "Gauss' nodes increase")
         call check_close(node + node(n:1:-1), 1.0_wp, rounding, "Gauss' nodes are symmetric")
         deallocate (node, weight)
      end do
      allocate (node(3), weight(3))
      call gauss_nodes(node, weight)
      call check(abs(sum(weight*node**6) - 1.0_wp/7.0_wp) > 1.0e-4_wp, &
         "three Gauss nodes do not integrate degree 6")
   end subroutine test_gauss

   !> Radau's nodes with the weights of interpolation are exact to degree 2 n - 2
   subroutine test_radau()
      type(rule_t) :: rule
      type(error_t), allocatable :: error
      real(wp), allocatable :: node(:)
      integer :: n, k

      allocate (node(2))
      call radau_nodes(node)
      call check_close(node, [1.0_wp/3.0_wp, 1.0_wp], rounding, "the two Radau nodes")
      deallocate (node)
      do n = 2, most_stages
         allocate (node(n))
         call radau_nodes(node)
         call new_rule(rule, n, error)
         call success(error, "a collocation rule is built")
         call check_close(rule%point(1:n), node, rounding, "collocation sits on Radau's nodes")
         do k = 0, 2*n - 2
            call check_close(sum(rule%weight(1:n)*node**k), 1.0_wp/real(k + 1, wp), rounding, &
               "Radau's rule integrates polynomials up to degree 2 n - 2")
         end do
         call check_close(node(n), 1.0_wp, 0.0_wp, "the last Radau node is at 1")
         call check(all(node(2:) > node(:n - 1)) .and. node(1) > 0.0_wp &
            .and. all(rule%weight(1:n) > 0.0_wp), &
            "Radau's nodes increase, the weights are positive")
         deallocate (node)
      end do
   end subroutine test_radau

   !> Integrals over (0, 1) with singularities at 0
   subroutine test_endpoint()
      real(wp), allocatable :: node(:), weight(:)
      real(wp), parameter :: exponent(8) = &
         [-0.75_wp, -0.5_wp, -0.25_wp, 0.0_wp, 0.1_wp, 0.5_wp, 1.0_wp, 7.0_wp]
      integer :: i

      call endpoint_rule(node, weight)
      call check(all(node > 0.0_wp) .and. all(node <= 1.0_wp), "endpoint nodes are inside")
      do i = 1, size(exponent)
         call check_relative(sum(weight*node**exponent(i)), 1.0_wp/(1.0_wp + exponent(i)), &
            merge(2.0e-12_wp, endpoint_tolerance, i == 1), "endpoint rule on a power")
      end do
      call check_relative(sum(weight*node**(-0.9_wp)), 10.0_wp, strong_endpoint_tolerance, &
         "endpoint rule on t^-0.9")
      call check_relative(sum(weight*log(node)), -1.0_wp, endpoint_tolerance, &
         "endpoint rule on log t")
      call check_relative(sum(weight*exp(-5.0_wp*node)), (1.0_wp - exp(-5.0_wp))/5.0_wp, &
         endpoint_tolerance, "endpoint rule on an analytic function")
      call check_relative(sum(weight/(1.0_wp + 30.0_wp*sqrt(node))), &
         2.0_wp*(30.0_wp - log(31.0_wp))/900.0_wp, endpoint_tolerance, &
         "endpoint rule on a function of sqrt(t)")
   end subroutine test_endpoint

   !> int_0^inf f(x) sin(x) dx and int_0^inf f(x) cos(x) dx
   subroutine test_fourier()
      ! f = 1/(1 + x), from Ci(1) and si(1); f = (1 + x)^-0.1 and (1 + x)^-2.5, from the incomplete
      ! gamma function: exp(-i) E_p(-i), mpmath
      real(wp), parameter :: sines(3) = &
         [0.62144962423581336_wp, 0.96445036467241808_wp, 0.25396602433678821_wp]
      real(wp), parameter :: cosines(3) = &
         [0.34337796155642703_wp, 0.058717433665519065_wp, 0.35706747992631386_wp]
      real(wp), parameter :: power(3) = [1.0_wp, 0.1_wp, 2.5_wp]
      real(wp), parameter :: rate(4) = [0.05_wp, 0.5_wp, 1.0_wp, 20.0_wp]
      real(wp), parameter :: exponent(3) = [0.1_wp, 0.5_wp, 0.9_wp]
      real(wp), allocatable :: xs(:), ws(:), xc(:), wc(:)
      integer :: i

      call fourier_rule(xs, ws, xc, wc)
      do i = 1, size(rate)
         call check_relative(sum(ws*exp(-rate(i)*xs)), 1.0_wp/(1.0_wp + rate(i)**2), &
            fourier_tolerance, "sine transform of exp(-r x)")
         call check_relative(sum(wc*exp(-rate(i)*xc)), rate(i)/(1.0_wp + rate(i)**2), &
            fourier_tolerance, "cosine transform of exp(-r x)")
      end do
      do i = 1, size(power)
         call check_relative(sum(ws*(1.0_wp + xs)**(-power(i))), sines(i), fourier_tolerance, &
            "sine transform of (1 + x)^-p")
         call check_relative(sum(wc*(1.0_wp + xc)**(-power(i))), cosines(i), fourier_tolerance, &
            "cosine transform of (1 + x)^-p")
      end do
      do i = 1, size(exponent)
         associate (a => exponent(i))
            call check_relative(sum(ws*xs**(-a)), gamma(1.0_wp - a)*cos(0.5_wp*pi*a), &
               fourier_tolerance, "sine transform of a power law")
            call check_relative(sum(wc*xc**(-a)), gamma(1.0_wp - a)*sin(0.5_wp*pi*a), &
               fourier_tolerance, "cosine transform of a power law")
         end associate
      end do
   end subroutine test_fourier

   !> The scalar product of integers is exact in any order of summation
   subroutine test_dot()
      real(wp) :: a(100), b(100)
      type(random_t) :: random
      integer :: n, i, whole

      do i = 1, size(a)
         a(i) = real(random%among(-1000, 1000), wp)
         b(i) = real(random%among(-1000, 1000), wp)
      end do
      do n = 0, size(a)
         whole = 0
         do i = 1, n
            whole = whole + nint(a(i))*nint(b(i))
         end do
         call check_close(dot(a(1:n), b(1:n)), real(whole, wp), 0.0_wp, &
            "the scalar product of n integers is exact")
      end do
   end subroutine test_dot

   !> Gaussian elimination; systems of fewer equations are padded with the unit matrix
   subroutine test_linear()
      real(wp) :: a(width, width), x(width), b(width), c(width)
      ! growth of the elimination without interchanges in such matrices: a hundredfold at most
      real(wp), parameter :: growth_tolerance = 100.0_wp*linear_tolerance
      type(random_t) :: random
      real(wp) :: inverse(width, width)
      logical :: regular
      integer :: n, i, j, trial

      do n = 1, width
         do trial = 1, 20
            ! the Jacobians of a panel are the unit matrix and something smaller
            a = unit_matrix()
            do j = 1, width
               x(j) = random%between(-1.0_wp, 1.0_wp)
               do i = 1, width
                  if (max(i, j) <= n) a(i, j) = a(i, j) + random%between(-0.4_wp, 0.4_wp)
               end do
            end do
            b = apply(a, x)
            call check_close(b, matmul(a, x), linear_tolerance, "a product with a vector")
            inverse = a
            call invert(inverse, regular)
            call check(regular, "a random matrix is regular")
            b = apply(inverse, b)
            ! the residual is small whatever the condition, but for the growth of the elimination
            call check_close(maxval(abs(matmul(a, b) - matmul(a, x))), 0.0_wp, growth_tolerance, &
               "a random system is solved")
            ! and refinement takes the growth away
            c = matmul(a, x) - matmul(a, b)
            c = apply(inverse, c)
            call check_close(maxval(abs(matmul(a, b + c) - matmul(a, x))), 0.0_wp, &
               linear_tolerance, "a random system is refined")
         end do

         inverse = unit_matrix()
         inverse(n, :) = 0.0_wp
         call invert(inverse, regular)
         call check(.not. regular, "a matrix with a row of zeros is singular")
      end do

      inverse = unit_matrix()
      inverse(:2, :2) = reshape([1.0_wp, 2.0_wp, 2.0_wp, 4.0_wp], [2, 2])
      call invert(inverse, regular)
      call check(.not. regular, "a matrix with two rows that are multiples is singular")
   end subroutine test_linear

   !> The unit matrix
   pure function unit_matrix() result(a)
      !> Ones on the diagonal
      real(wp) :: a(width, width)

      integer :: i

      a = 0.0_wp
      do i = 1, width
         a(i, i) = 1.0_wp
      end do
   end function unit_matrix

   !> Polynomials are interpolated, differentiated and integrated exactly, through the eigenvectors
   subroutine test_collocation()
      type(rule_t) :: rule
      type(error_t), allocatable :: error
      real(wp) :: value(0:width), slope(0:width)
      integer :: n, j

      do n = 2, most_stages
         call new_rule(rule, n, error)
         call success(error, "a collocation rule is built")
         value = rule%point**n
         call check_close(rule%interpolate(value, 0.37_wp), 0.37_wp**n, &
            collocation_tolerance, "a polynomial of degree n is interpolated")
         call check_close(rule%interpolate(value, 2.0_wp), 2.0_wp**n, &
            collocation_tolerance*4.0_wp**n, "a polynomial is extended beyond its panel")
         do j = 0, n
            call check_close(rule%interpolate(value, rule%point(j)), value(j), rounding, &
               "interpolation takes the values at the points")
         end do
         slope = rule%slopes(value)
         call check_close(slope(0:n), &
            real(n, wp)*rule%point(0:n)**(n - 1), collocation_tolerance, &
            "a polynomial of degree n is differentiated")
         value = (rule%point - 0.43_wp)*(1.0_wp + rule%point)
         j = count(rule%point(1:n) < 0.43_wp)
         call check_close(rule%crossing(value, j, 1.0e-10_wp), 0.43_wp, &
            collocation_tolerance, "the zero of a polynomial is found")
         call check_map(rule, rule%map(linear), 1.0_wp, 0.0_wp)
         call check_map(rule, rule%map(opening), 0.0_wp, 1.0_wp)
         call check_map(rule, rule%map(doubling), 2.0_wp/3.0_wp, 1.0_wp/3.0_wp)
         call check_close([rule%map(closing)%slope, rule%map(closing)%bend], [2.0_wp, -1.0_wp], &
            0.0_wp, "a closing panel is in the root of the time left")
      end do
   end subroutine test_collocation

   !> What exponentials remember at the end of a panel in which time runs as y^2, against Gauss's
   !> rule on geometric pieces of it; from slow ones to such that settle at once
   subroutine test_settling()
      integer, parameter :: pieces = 60, order = 20
      real(wp), parameter :: product(9) = [1.0e-3_wp, 0.3_wp, 2.0_wp, 12.0_wp, 35.9_wp, 36.1_wp, &
         1.0e2_wp, 1.0e4_wp, 1.0e8_wp]
      real(wp), parameter :: scale = 2.0_wp, start = 0.7_wp
      type(settling_t) :: rule
      real(wp) :: node(8), f(8), gauss(order), weight(order), y, upper
      real(wp) :: expected, rate
      integer :: n, i, j, k, p

      call gauss_nodes(gauss, weight)
      do n = 7, 8
         call radau_nodes(node(:n))
         call new_settling(rule, node(:n))
         do k = 0, n - 1
            f(:n) = (1.0_wp - node(:n))**k
            do p = 1, size(product)
               rate = product(p)
               expected = start*decay(rate)
               upper = 1.0_wp
               do j = 1, pieces
                  do i = 1, order
                     y = upper*(0.5_wp + 0.5_wp*gauss(i))
                     expected = expected + 0.5_wp*upper*weight(i)*2.0_wp*scale*y**(k + 1) &
                        *decay(rate*y**2)
                  end do
                  upper = 0.5_wp*upper
               end do
               call check_close(rule%total([3.0_wp], [rate/scale], scale, [start], f(:n)), &
                  3.0_wp*expected, settling_tolerance, "an exponential settles")
            end do
         end do
      end do
   end subroutine test_settling

   !> exp(-a), 0 where that is nothing
   pure function decay(a)
      !> a
      real(wp), intent(in) :: a
      real(wp) :: decay

      decay = 0.0_wp
      if (a < 600.0_wp) decay = exp(-a)
   end function decay

   !> B = A diag(slope + 2 bend c): B f is the integral of f(t) over t = slope theta + bend theta^2,
   !> exact for f of degree n - 2 in theta, and functions of B follow from its eigenvalues
   subroutine check_map(rule, map, slope, bend)
      !> The rule
      type(rule_t), intent(in) :: rule
      !> The map
      type(map_t), intent(in) :: map
      !> What its slope is to be
      real(wp), intent(in) :: slope
      !> What its bend is to be
      real(wp), intent(in) :: bend

      real(wp) :: b(width, width), inverse(width, width)
      real(wp) :: node(rule%stages), one(width), length, tolerance
      integer :: n, k

      n = rule%stages
      tolerance = eigenvector_tolerance(n)
      node = rule%point(1:n)
      call check_close(map%slope, slope, rounding, "slope of the map")
      call check_close(map%bend, bend, rounding, "bend of the map")
      one = map%compose(map%left_one)
      b = map%function_of(map%eigenvalue)
      inverse = map%function_of(1.0_wp/map%eigenvalue)
      call check_close(map%compose(map%decompose(map%matrix(:, 1)))/map%matrix(n, 1), &
         map%matrix(:, 1)/map%matrix(n, 1), tolerance, "a vector is taken apart and put together")
      call check_close(map%square, matmul(map%matrix, map%matrix), rounding, "the square of B")
      length = slope + bend
      call check_close(one(1:n), 1.0_wp, tolerance, "V V^-1 takes a constant to itself")
      call check_close(b/length, map%matrix/length, tolerance, "V lambda V^-1 is B")
      do k = 0, n - 2
         call check_close(matmul(map%matrix(1:n, 1:n), node**k)/length, &
            (slope*node**(k + 1)/real(k + 1, wp) + 2.0_wp*bend*node**(k + 2)/real(k + 2, wp)) &
            /length, rounding, "B integrates powers of theta exactly")
      end do
      ! B's smallest eigenvalue is about a hundredth of its largest
      call check_close(matmul(inverse(1:n, 1:n), matmul(map%matrix(1:n, 1:n), node)), node, &
         100.0_wp*tolerance, "the inverse of B by its eigenvalues")
   end subroutine check_map

end program test_numeric
