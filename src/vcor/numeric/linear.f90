!> Dense linear systems of the size of a collocation panel
module vcor_numeric_linear
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : width
   implicit none
   private

   public :: solve_linear

contains

   !> Solve A x = b by Gauss and Jordan's elimination with partial pivoting. For the eight equations
   !> of a panel, solved some dozen times per impact, the call of a library routine would cost more
   !> than the elimination; with loops over whole columns of known length it is a few hundred vector
   !> instructions
   pure subroutine solve_linear(a, b, regular)
      !> Matrix, destroyed on return
      real(wp), intent(inout) :: a(width, width)
      !> Right-hand side, on return the solution
      real(wp), intent(inout) :: b(width)
      !> Whether all pivots were nonzero numbers
      logical, intent(out) :: regular

      real(wp) :: column(width), pivot, factor
      integer :: j, k, p

      regular = .false.
      do k = 1, width
         p = k
         do j = k + 1, width
            if (abs(a(j, k)) > abs(a(p, k))) p = j
         end do
         if (.not. abs(a(p, k)) > 0.0_wp) return
         if (p /= k) then
            do j = k, width
               factor = a(k, j)
               a(k, j) = a(p, j)
               a(p, j) = factor
            end do
            factor = b(k)
            b(k) = b(p)
            b(p) = factor
         end if
         pivot = 1.0_wp/a(k, k)
         column = a(:, k)
         do j = k + 1, width
            factor = a(k, j)*pivot
            a(:, j) = a(:, j) - column*factor
            a(k, j) = factor
         end do
         factor = b(k)*pivot
         b = b - column*factor
         b(k) = factor
      end do
      regular = .true.
   end subroutine solve_linear

end module vcor_numeric_linear
