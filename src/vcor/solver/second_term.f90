!> Second term of the Volterra series, Eq. (10) of Green's paper with h2(t1, t2) = h(t1 + t2)
!>
!> As a sum over equal steps it is
!>
!>     D_n = sum_{a=1..n} sum_{b=1..n} h_{2n-a-b} w_a w_b
!>
!> which is O(n^2) work at every step and O(N^3) in all as it stands. The kernel depends on a + b
!> alone, so D_n = sum_m h_{2n-m} C_n(m) with C_n(m) = sum_{a+b=m; a,b<=n} w_a w_b. From step to
!> step C_n gains 2 w_n w_a at m = n + a and w_n^2 at m = 2n only: O(n) work, the same number but
!> for rounding, arrays of length 2N. With the newest value w_n apart,
!>
!>     D_n = sum_{m<=2n-2} h_{2n-m} C_{n-1}(m) + 2 w_n sum_{a<n} h_{n-a} w_a + h_0 w_n^2
module vcor_solver_second_term
   use vcor_kinds, only : wp
   use vcor_solver_convolution, only : convolution_t, lengthen
   implicit none
   private

   public :: second_term_t

   !> Double sum under way
   type :: second_term_t
      !> Kernel h_i at t = i dt, room for half as many steps
      type(convolution_t) :: kernel
      !> sums(m) = C_n(m)
      real(wp), allocatable, private :: sums(:)
   contains
      !> Make room and set the kernel
      procedure :: prepare
      !> The double sum without the newest value
      procedure :: past
      !> Take the newest value in
      procedure :: accept
   end type second_term_t

contains

   !> Make room and set the kernel; the sums so far stay
   pure subroutine prepare(self, kernel)
      !> The double sum
      class(second_term_t), intent(inout) :: self
      !> Kernel h_i at t = i dt, shape (0:)
      real(wp), intent(in) :: kernel(0:)

      call self%kernel%set(kernel)
      call lengthen(self%sums, 1, size(kernel))
   end subroutine prepare

   !> The double sum D_n without the newest value: its part that does not depend on w_n
   pure function past(self, n)
      !> The double sum
      class(second_term_t), intent(in) :: self
      !> Step, 1 <= n, 2 n <= room
      integer, intent(in) :: n
      !> Sum
      real(wp) :: past

      past = self%kernel%sum_over(2*n, 2, 2*n - 2, self%sums)
   end function past

   !> Take the newest value w_n in
   pure subroutine accept(self, n, w)
      !> The double sum
      class(second_term_t), intent(inout) :: self
      !> Step
      integer, intent(in) :: n
      !> Values w_1 .. w_n, shape (>= n)
      real(wp), contiguous, intent(in) :: w(:)

      self%sums(n + 1:2*n - 1) = self%sums(n + 1:2*n - 1) + 2.0_wp*w(n)*w(1:n - 1)
      self%sums(2*n) = self%sums(2*n) + w(n)**2
   end subroutine accept

end module vcor_solver_second_term
