!> Dense linear systems of a few equations
module vcor_numeric_linear
   use vcor_kinds, only : wp
   implicit none
   private

   public :: solve_linear

contains

   !> Solve A x = b by Gaussian elimination with partial pivoting. For the half dozen equations of
   !> a collocation panel, solved some dozen times per impact, the call of a library routine would
   !> cost more than the elimination
   pure subroutine solve_linear(a, b, regular)
      !> Matrix, destroyed on return, shape (n, n)
      real(wp), intent(inout) :: a(:, :)
      !> Right-hand side, on return the solution, shape (n)
      real(wp), intent(inout) :: b(:)
      !> Whether all pivots were nonzero numbers
      logical, intent(out) :: regular

      real(wp) :: pivot, swap
      integer :: n, i, j, k, p

      n = size(b)
      regular = .false.
      do k = 1, n
         p = k
         do i = k + 1, n
            if (abs(a(i, k)) > abs(a(p, k))) p = i
         end do
         if (.not. abs(a(p, k)) > 0.0_wp) return
         if (p /= k) then
            do j = k, n
               swap = a(k, j)
               a(k, j) = a(p, j)
               a(p, j) = swap
            end do
            swap = b(k)
            b(k) = b(p)
            b(p) = swap
         end if
         pivot = 1.0_wp/a(k, k)
         do i = k + 1, n
            a(i, k) = a(i, k)*pivot
         end do
         do j = k + 1, n
            do i = k + 1, n
               a(i, j) = a(i, j) - a(i, k)*a(k, j)
            end do
         end do
         do i = k + 1, n
            b(i) = b(i) - a(i, k)*b(k)
         end do
      end do
      do k = n, 1, -1
         b(k) = b(k)/a(k, k)
         do i = 1, k - 1
            b(i) = b(i) - a(i, k)*b(k)
         end do
      end do
      regular = .true.
   end subroutine solve_linear

end module vcor_numeric_linear
