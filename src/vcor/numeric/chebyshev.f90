!> Polynomials through values at the points of Chebyshev, by their coefficients
module vcor_numeric_chebyshev
   use vcor_kinds, only : pi, wp
   implicit none
   private

   public :: chebyshev_points, coefficients_of, polynomial, polynomial_slope

contains

   !> Zeros of T_n, in increasing order
   pure function chebyshev_points(n) result(x)
      !> Number of points, > 0
      integer, intent(in) :: n
      !> Points in (-1, 1)
      real(wp) :: x(n)

      integer :: i

      x = [(-cos(pi*(real(i, wp) - 0.5_wp)/real(n, wp)), i=1, n)]
   end function chebyshev_points

   !> Matrix from values at these points to the coefficients of 1, x, x^2 ... of their polynomial
   pure function coefficients_of(n) result(matrix)
      !> Number of points, > 0; rounding grows as (1 + sqrt(2))^n for rough values
      integer, intent(in) :: n
      !> Matrix, shape (0:n - 1, n)
      real(wp) :: matrix(0:n - 1, n)

      real(wp) :: x(n), value(n, 0:n - 1), power(0:n - 1, 0:n - 1)
      integer :: k

      x = chebyshev_points(n)
      value = 0.0_wp
      power = 0.0_wp
      value(:, 0) = 1.0_wp
      power(0, 0) = 1.0_wp
      do k = 1, n - 1
         if (k == 1) then
            value(:, 1) = x
            power(1, 1) = 1.0_wp
         else
            value(:, k) = 2.0_wp*x*value(:, k - 1) - value(:, k - 2)
            power(1:, k) = 2.0_wp*power(:n - 2, k - 1)
            power(:, k) = power(:, k) - power(:, k - 2)
         end if
      end do
      value(:, 1:) = 2.0_wp*value(:, 1:)
      matrix = matmul(power, transpose(value))/real(n, wp)
   end function coefficients_of

   !> Value of a polynomial
   pure function polynomial(coefficient, x) result(value)
      !> Coefficients of 1, x, x^2 ..., shape (n)
      real(wp), intent(in) :: coefficient(:)
      !> Argument
      real(wp), intent(in) :: x
      !> Value
      real(wp) :: value

      integer :: k

      value = coefficient(size(coefficient))
      do k = size(coefficient) - 1, 1, -1
         value = coefficient(k) + x*value
      end do
   end function polynomial

   !> Derivative of a polynomial
   pure function polynomial_slope(coefficient, x) result(slope)
      !> Coefficients of 1, x, x^2 ..., shape (n)
      real(wp), intent(in) :: coefficient(:)
      !> Argument
      real(wp), intent(in) :: x
      !> Derivative
      real(wp) :: slope

      integer :: k

      slope = 0.0_wp
      do k = size(coefficient), 2, -1
         slope = real(k - 1, wp)*coefficient(k) + x*slope
      end do
   end function polynomial_slope

end module vcor_numeric_chebyshev
