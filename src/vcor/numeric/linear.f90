!> Dense linear algebra of the size of a collocation panel
!>
!> For the eight equations of a panel, solved some dozen times per impact, the call of a library
!> routine would cost more than the elimination; loops over columns of a length that the compiler
!> knows become a few hundred vector instructions. An inverse takes a half more operations than
!> factors do, but substitution is a chain in which each of sixteen steps waits for the one before,
!> a product with the inverse is none.
!>
!> Rows are not interchanged: the matrices are Jacobians of Newton's method, unit matrix plus
!> collocation matrix, whose residuals are evaluated afresh in each iteration. That makes it an
!> iterative refinement, to which some lost digits of the inverse do no harm.
module vcor_numeric_linear
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : width
   implicit none
   private

   public :: invert, apply

   integer :: i_row, i_column
   !> 0 on the diagonal, 1 elsewhere
   real(wp), parameter :: others(width, width) = reshape([((merge(0.0_wp, 1.0_wp, &
      i_row == i_column), i_row=1, width), i_column=1, width)], [width, width])

contains

   !> Invert a matrix by the elimination of Gauss and Jordan
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
            ! row k becomes the factors
            do i = 1, width
               matrix(i, j) = matrix(i, j)*others(i, k) + direction(i)*factor
            end do
         end do
      end do
      regular = .true.
   end subroutine invert

   !> Product of matrix and vector, written out: so the sums stay in registers
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

end module vcor_numeric_linear
