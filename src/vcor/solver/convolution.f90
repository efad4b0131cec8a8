!> Sums over the past on equal steps: the hereditary integrals of the direct methods
!>
!> The second term of the Volterra series, Eq. (10) of Green's paper with h2(t1, t2) = h(t1 + t2),
!> is
!>
!>     D_n = sum_{a=1..n} sum_{b=1..n} h_{2n-a-b} w_a w_b
!>
!> which in this form takes O(n^2) operations per step and O(N^3) in all. As the kernel depends on
!> a + b only, D_n = sum_m h_{2n-m} C_n(m) with C_n(m) = sum_{a+b=m; a,b<=n} w_a w_b. In each step
!> C_n gains only 2 w_n w_a at m = n + a and w_n^2 at m = 2n: O(n) operations and arrays of length
!> 2N for the same number but for rounding. With the newest value w_n separated,
!>
!>     D_n = sum_{m<=2n-2} h_{2n-m} C_{n-1}(m) + 2 w_n sum_{a<n} h_{n-a} w_a + h_0 w_n^2
module vcor_solver_convolution
   use vcor_kinds, only : wp
   implicit none
   private

   public :: convolution_t, second_term_t, dot, lengthen

   !> Weights W_i of sums sum_j W_{n-j} x_j
   type :: convolution_t
      !> Number of weights
      integer :: room = 0
      !> W_0, weight of the newest value
      real(wp) :: newest = 0.0_wp
      !> reversed(room - i) = W_i, so that sums run forward through both arrays, shape (room)
      real(wp), allocatable, private :: reversed(:)
   contains
      procedure :: set
      procedure :: sum_over
   end type convolution_t

   !> Second term of the Volterra series, a double sum that grows step by step
   type :: second_term_t
      !> Kernel h_i at t = i dt, for half as many steps
      type(convolution_t) :: kernel
      !> sums(m) = C_n(m)
      real(wp), allocatable, private :: sums(:)
   contains
      procedure :: prepare
      procedure :: past
      procedure :: accept
   end type second_term_t

contains

   !> Set the weights
   pure subroutine set(self, weights)
      class(convolution_t), intent(inout) :: self
      !> W_i, shape (0:)
      real(wp), intent(in) :: weights(0:)

      self%room = size(weights)
      self%newest = weights(0)
      self%reversed = weights(self%room - 1:0:-1)
   end subroutine set

   !> Sum of W_{n-j} x_j from j = first to last
   pure function sum_over(self, n, first, last, x) result(total)
      class(convolution_t), intent(in) :: self
      !> Step at which the sum is taken, n - first < room
      integer, intent(in) :: n
      !> First step of the range, >= 1
      integer, intent(in) :: first
      !> Last step of the range, <= n
      integer, intent(in) :: last
      !> Values, x_1 first
      real(wp), contiguous, intent(in) :: x(:)
      real(wp) :: total

      associate (shift => self%room - n)
         total = dot(self%reversed(shift + first:shift + last), x(first:last))
      end associate
   end function sum_over

   !> Make room and set the kernel; the sums so far are kept
   pure subroutine prepare(self, kernel)
      class(second_term_t), intent(inout) :: self
      !> Kernel h_i at t = i dt, shape (0:)
      real(wp), intent(in) :: kernel(0:)

      call self%kernel%set(kernel)
      call lengthen(self%sums, 1, size(kernel))
   end subroutine prepare

   !> Part of D_n that does not depend on the newest value w_n
   pure function past(self, n)
      class(second_term_t), intent(in) :: self
      !> Step, 1 <= n, 2 n <= room
      integer, intent(in) :: n
      real(wp) :: past

      past = self%kernel%sum_over(2*n, 2, 2*n - 2, self%sums)
   end function past

   !> Add the newest value w_n to the sums
   pure subroutine accept(self, n, w)
      class(second_term_t), intent(inout) :: self
      !> Step
      integer, intent(in) :: n
      !> Values w_1 .. w_n, shape (>= n)
      real(wp), contiguous, intent(in) :: w(:)

      self%sums(n + 1:2*n - 1) = self%sums(n + 1:2*n - 1) + 2.0_wp*w(n)*w(1:n - 1)
      self%sums(2*n) = self%sums(2*n) + w(n)**2
   end subroutine accept

   !> Scalar product a . b with partial sums in a fixed order, which fill vector registers, avoid
   !> the latency of one running sum, and give the same result on every machine; the intrinsic may
   !> not reorder the sum and takes four times as long
   pure function dot(a, b) result(product)
      !> First vector, shape (n)
      real(wp), contiguous, intent(in) :: a(:)
      !> Second vector, shape (n)
      real(wp), contiguous, intent(in) :: b(:)
      real(wp) :: product

      ! four registers of four numbers hide the latency of four additions
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

   !> Lengthen a series: its values are kept, the rest is 0
   pure subroutine lengthen(series, first, last)
      !> The series; may be unallocated on entry
      real(wp), allocatable, intent(inout) :: series(:)
      !> First index, the same as on entry
      integer, intent(in) :: first
      !> New last index
      integer, intent(in) :: last

      real(wp), allocatable :: longer(:)

      allocate (longer(first:last))
      longer = 0.0_wp
      if (allocated(series)) longer(first:ubound(series, 1)) = series
      call move_alloc(longer, series)
   end subroutine lengthen

end module vcor_solver_convolution
