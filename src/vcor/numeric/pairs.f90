!> Numbers a + b j per pair of eigenvalues, with j^2 = -1 for complex and +1 for real ones
!>
!> A vector of them is stored as in `panel_map_t`: the parts without j, then those with j. Vectors
!> have a length that the compiler knows, which turns the loops into a few vector instructions.
module vcor_numeric_pairs
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : pairs, width
   implicit none
   private

   public :: constant, times, ratio

contains

   !> The same real number for all pairs
   pure function constant(value) result(c)
      !> The number
      real(wp), intent(in) :: value
      !> Vector of it
      real(wp) :: c(width)

      c(:pairs) = value
      c(pairs + 1:) = 0.0_wp
   end function constant

   !> Products
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

   !> Quotients
   pure function ratio(square, a, b) result(c)
      !> j^2
      real(wp), intent(in) :: square(pairs)
      !> Numerators
      real(wp), intent(in) :: a(width)
      !> Denominators, the product of whose eigenvalues is not 0
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

end module vcor_numeric_pairs
