!> Linear algebra of a collocation panel: small dense matrices and their functions
!>
!> The eight equations of a panel are solved some dozen times per impact. A call of a library
!> routine would cost more than the elimination; loops over columns of a length known to the
!> compiler become a few hundred vector instructions. An inverse takes more operations than a
!> factorisation, but a product with it has no chain of dependent steps, while each of the sixteen
!> steps of a substitution waits for the one before.
!>
!> There is no pivoting. The matrices are Jacobians of Newton's method, unit matrix plus collocation
!> matrix, and the residuals are evaluated again in each iteration. This is iterative refinement,
!> which tolerates lost digits in the inverse.
!>
!> A function of a diagonalised matrix is one number a + b j per pair of eigenvalues, with j^2 = -1
!> for complex pairs and +1 for real ones, stored as a vector: first all a, then all b
!> (`panel_map_t` of `vcor_numeric_radau_collocation`).
module vcor_numeric_radau_algebra
   use vcor_kinds, only : wp
   implicit none
   private

   public :: width, pairs
   public :: invert, apply, apply_product, constant, times, ratio

   !> Largest number of stages, and the length of all arrays over stages: arrays of rules with fewer
   !> stages are padded with zeros, so that the innermost loops have a length known to the compiler.
   !> The condition of the eigenvectors grows tenfold per stage; with eight, it costs four digits
   integer, parameter :: width = 8
   !> Number of pairs of eigenvalues of `width` stages
   integer, parameter :: pairs = width/2

   integer :: i_row, i_column
   !> 0 on the diagonal, 1 elsewhere
   real(wp), parameter :: others(width, width) = reshape([((merge(0.0_wp, 1.0_wp, &
      i_row == i_column), i_row=1, width), i_column=1, width)], [width, width])

contains

   !> Invert a matrix by Gauss-Jordan elimination without pivoting
   pure subroutine invert(matrix, regular)
      !> The matrix, on return its inverse
      real(wp), intent(inout) :: matrix(width, width)
      !> Whether all pivots are nonzero numbers
      logical, intent(out) :: regular

      real(wp) :: pivot, factor, direction(width)
      integer :: i, j, k

      regular = .false.
      do k = 1, width
         if (.not. abs(matrix(k, k)) > 0.0_wp) return
         pivot = 1.0_wp/matrix(k, k)
         direction = -matrix(:, k)
         direction(k) = 1.0_wp
         matrix(:, k) = 0.0_wp
         matrix(k, k) = 1.0_wp
         do j = 1, width
            factor = matrix(k, j)*pivot
            ! row k, with others = 0 and direction = 1, becomes the scaled pivot row
            do i = 1, width
               matrix(i, j) = matrix(i, j)*others(i, k) + direction(i)*factor
            end do
         end do
      end do
      regular = .true.
   end subroutine invert

   !> Product of matrix and vector, written out so that the sums stay in registers
   pure function apply(a, x) result(y)
      !> Matrix
      real(wp), intent(in) :: a(width, width)
      !> Vector
      real(wp), intent(in) :: x(width)
      !> a x
      real(wp) :: y(width)

      integer :: i

      do i = 1, width
         y(i) = ((a(i, 1)*x(1) + a(i, 2)*x(2)) + (a(i, 3)*x(3) + a(i, 4)*x(4))) &
            + ((a(i, 5)*x(5) + a(i, 6)*x(6)) + (a(i, 7)*x(7) + a(i, 8)*x(8)))
      end do
   end function apply

   !> The same real number for all pairs
   pure function constant(value) result(c)
      real(wp), intent(in) :: value
      !> The number of each pair
      real(wp) :: c(width)

      c(:pairs) = value
      c(pairs + 1:) = 0.0_wp
   end function constant

   !> Products of the numbers of pairs
   pure function times(square, a, b) result(c)
      !> j^2
      real(wp), intent(in) :: square(pairs)
      !> Factors
      real(wp), intent(in) :: a(width)
      !> Factors
      real(wp), intent(in) :: b(width)
      !> Products
      real(wp) :: c(width)

      integer :: i

      do i = 1, pairs
         c(i) = a(i)*b(i) + square(i)*a(pairs + i)*b(pairs + i)
      end do
      do i = 1, pairs
         c(pairs + i) = a(i)*b(pairs + i) + a(pairs + i)*b(i)
      end do
   end function times

   !> Product of a matrix with the products of two sets of numbers of pairs
   pure function apply_product(matrix, square, a, b) result(y)
      !> Matrix that takes numbers of pairs
      real(wp), intent(in) :: matrix(width, width)
      !> j^2
      real(wp), intent(in) :: square(pairs)
      !> Factors
      real(wp), intent(in) :: a(width)
      !> Factors
      real(wp), intent(in) :: b(width)
      !> matrix (a b)
      real(wp) :: y(width)

      y = apply(matrix, times(square, a, b))
   end function apply_product

   !> Quotients of the numbers of pairs
   pure function ratio(square, a, b) result(c)
      !> j^2
      real(wp), intent(in) :: square(pairs)
      !> Numerators
      real(wp), intent(in) :: a(width)
      !> Denominators, with nonzero eigenvalues
      real(wp), intent(in) :: b(width)
      !> Quotients
      real(wp) :: c(width)

      real(wp) :: norm
      integer :: i

      do i = 1, pairs
         norm = b(i)**2 - square(i)*b(pairs + i)**2
         c(i) = (a(i)*b(i) - square(i)*a(pairs + i)*b(pairs + i))/norm
         c(pairs + i) = (a(pairs + i)*b(i) - a(i)*b(pairs + i))/norm
      end do
   end function ratio

end module vcor_numeric_radau_algebra
