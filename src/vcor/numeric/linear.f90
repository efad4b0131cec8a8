!> Dense linear algebra of the size of a collocation panel
!>
!> For the eight equations of a panel, solved some dozen times per impact, the call of a library
!> routine would cost more than the elimination; loops over columns of a length that the compiler
!> knows become a few hundred vector instructions.
!>
!> Rows are not interchanged: the matrices are Jacobians of Newton's method, unit matrix plus
!> collocation matrix, whose residuals are evaluated afresh in each iteration. That makes it an
!> iterative refinement, to which some lost digits of the factors do no harm.
module vcor_numeric_linear
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : width
   implicit none
   private

   public :: factors_t, factorise, apply

   integer :: i_row, i_column
   !> 1 below the diagonal, 0 elsewhere: whole columns are eliminated without a look at their start
   real(wp), parameter :: below(width, width) = reshape([((merge(1.0_wp, 0.0_wp, &
      i_row > i_column), i_row=1, width), i_column=1, width)], [width, width])

   !> A matrix, and once factorised what solves its linear systems
   type :: factors_t
      !> The matrix, on factorising the upper triangle; what is below has no meaning then
      real(wp) :: matrix(width, width)
      !> Multiples of row k taken from the rows below, column by column; zero above
      real(wp), private :: lower(width, width)
      !> Inverse pivots
      real(wp), private :: inverse(width)
   contains
      !> Solve for a right-hand side
      procedure :: solve
   end type factors_t

contains

   !> Factorise a matrix by Gauss's elimination
   pure subroutine factorise(self, regular)
      !> The matrix, on return its factors
      class(factors_t), intent(inout) :: self
      !> Whether all pivots are nonzero numbers
      logical, intent(out) :: regular

      real(wp) :: factor
      integer :: i, j, k

      regular = .false.
      do k = 1, width
         if (.not. abs(self%matrix(k, k)) > 0.0_wp) return
         self%inverse(k) = 1.0_wp/self%matrix(k, k)
         do i = 1, width
            self%lower(i, k) = self%matrix(i, k)*(self%inverse(k)*below(i, k))
         end do
         do j = k + 1, width
            factor = self%matrix(k, j)
            do i = 1, width
               self%matrix(i, j) = self%matrix(i, j) - self%lower(i, k)*factor
            end do
         end do
      end do
      regular = .true.
   end subroutine factorise

   !> Solve the linear system for a right-hand side
   pure subroutine solve(self, b)
      !> Factors of the matrix
      class(factors_t), intent(in) :: self
      !> Right-hand side, on return the solution
      real(wp), intent(inout) :: b(width)

      real(wp) :: x
      integer :: i, k

      do k = 1, width - 1
         x = b(k)
!GCC$ novector
         do i = k + 1, width
            b(i) = b(i) - self%lower(i, k)*x
         end do
      end do
      do k = width, 1, -1
         x = b(k)*self%inverse(k)
!GCC$ novector
         do i = 1, k - 1
            b(i) = b(i) - self%matrix(i, k)*x
         end do
         b(k) = x
      end do
   end subroutine solve

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
