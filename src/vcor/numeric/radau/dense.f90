!> Linear algebra of the equations of a collocation panel: dense matrices of a fixed size
!>
!> A panel has eight equations, which are solved some dozen times per impact. Loops of a length that
!> the compiler knows become a few hundred vector instructions; a call of a library costs more. An
!> inverse takes more operations than factors, but products with it are not a chain of dependent
!> steps. There is no pivoting: the matrices are the unit matrix plus a collocation matrix, and the
!> residuals are evaluated anew in each iteration of Newton's method, which mends lost digits.
module vcor_numeric_radau_dense
   use vcor_kinds, only : wp
   implicit none
   private

   public :: width, apply, invert

   !> Largest number of stages, and the size of all matrices: rules with fewer stages are padded
   !> with zeros. The condition of the eigenvectors grows tenfold per stage; with eight, it costs
   !> four digits
   integer, parameter :: width = 8

contains

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

   !> Invert a matrix by Gauss-Jordan elimination without interchanges
   pure subroutine invert(matrix, regular)
      !> The matrix, on return its inverse
      real(wp), intent(inout) :: matrix(width, width)
      !> Whether all pivots are nonzero numbers
      logical, intent(out) :: regular

      real(wp) :: pivot, factor, column(width)
      integer :: i, j, k

      regular = .false.
      do k = 1, width
         if (.not. abs(matrix(k, k)) > 0.0_wp) return
         pivot = 1.0_wp/matrix(k, k)
         column = -matrix(:, k)
         column(k) = 0.0_wp
         matrix(:, k) = 0.0_wp
         matrix(k, k) = 1.0_wp
         do j = 1, width
            factor = matrix(k, j)*pivot
            do i = 1, width
               matrix(i, j) = matrix(i, j) + column(i)*factor
            end do
            matrix(k, j) = factor
         end do
      end do
      regular = .true.
   end subroutine invert

end module vcor_numeric_radau_dense
