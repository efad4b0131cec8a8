!> Sums over the past on equal steps: hereditary integrals as the direct methods compute them
module vcor_solver_convolution
   use vcor_kinds, only : wp
   implicit none
   private

   public :: convolution_t, dot, lengthen

   !> Weights W_i of sums sum_j W_{n-j} x_j
   type :: convolution_t
      !> Number of weights
      integer :: room = 0
      !> W_0, the share of the newest value
      real(wp) :: newest = 0.0_wp
      !> reversed(room - i) = W_i, so that sums run forward through both arrays, shape (room)
      real(wp), allocatable, private :: reversed(:)
   contains
      !> Set the weights
      procedure :: set
      !> One weight
      procedure :: weight
      !> Sum over a part of the past
      procedure :: sum_over
   end type convolution_t

contains

   !> Set the weights
   pure subroutine set(self, weights)
      !> The convolution
      class(convolution_t), intent(inout) :: self
      !> W_i, shape (0:)
      real(wp), intent(in) :: weights(0:)

      self%room = size(weights)
      self%newest = weights(0)
      self%reversed = weights(self%room - 1:0:-1)
   end subroutine set

   !> The weight W_i
   pure function weight(self, i)
      !> The convolution
      class(convolution_t), intent(in) :: self
      !> Steps that have passed, 0 <= i < room
      integer, intent(in) :: i
      !> Weight
      real(wp) :: weight

      weight = self%reversed(self%room - i)
   end function weight

   !> Sum of W_{n-j} x_j from j = first to last
   pure function sum_over(self, n, first, last, x) result(total)
      !> The convolution
      class(convolution_t), intent(in) :: self
      !> Step at which the sum is taken, n - first < room
      integer, intent(in) :: n
      !> First step of the part, >= 1
      integer, intent(in) :: first
      !> Its last step, <= n
      integer, intent(in) :: last
      !> Values, x_1 first
      real(wp), contiguous, intent(in) :: x(:)
      !> Sum
      real(wp) :: total

      associate (shift => self%room - n)
         total = dot(self%reversed(shift + first:shift + last), x(first:last))
      end associate
   end function sum_over

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

   !> Make a series longer: what is there stays, the rest is 0
   pure subroutine lengthen(series, first, last)
      !> The series; on entry it may not be allocated
      real(wp), allocatable, intent(inout) :: series(:)
      !> Its first index, that of the series on entry
      integer, intent(in) :: first
      !> Its last index
      integer, intent(in) :: last

      real(wp), allocatable :: longer(:)

      allocate (longer(first:last))
      longer = 0.0_wp
      if (allocated(series)) longer(first:ubound(series, 1)) = series
      call move_alloc(longer, series)
   end subroutine lengthen

end module vcor_solver_convolution
