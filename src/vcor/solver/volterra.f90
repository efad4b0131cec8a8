!> Double sums of the second Volterra term by O(n) operations per step
!>
!> The second term of Eq. (10) of Green's paper with h2(t1, t2) = h(t1 + t2) is, as a sum over equal
!> steps,
!>
!>     D_n = sum_{a=1..n} sum_{b=1..n} h_{2n-a-b} w_a w_b
!>
!> which is O(n^2) work at every step and O(N^3) in all as it stands. The kernel depends on a + b
!> alone, so D_n = sum_m h_{2n-m} C_n(m) with C_n(m) = sum_{a+b=m; a,b<=n} w_a w_b. From step to
!> step C_n gains 2 w_n w_a at m = n + a and w_n^2 at m = 2n only: O(n) work, the same number but
!> for rounding, arrays of length 2N. The newest value may count by a share of it (the trapezoidal
!> rule's half) before it is taken in as a whole.
module vcor_solver_volterra
   use vcor_kinds, only : wp
   use vcor_numeric_dot, only : dot
   implicit none
   private

   public :: volterra_t

   !> Double sum under way
   type :: volterra_t
      private
      !> weights(room - i) = h_i: reversed, so that the sums run forward through both arrays,
      !> shape (room)
      real(wp), allocatable :: weights(:)
      !> sums(m) = C_n(m), shape (room)
      real(wp), allocatable :: sums(:)
   contains
      !> Make room and set the kernel
      procedure :: prepare
      !> The double sum at a step
      procedure :: double_sum
      !> Its coefficients as a polynomial of the newest value
      procedure :: polynomial
      !> Take the newest value in
      procedure :: accept
   end type volterra_t

contains

   !> Make room and set the kernel; the sums so far stay
   pure subroutine prepare(self, kernel)
      !> The double sum
      class(volterra_t), intent(inout) :: self
      !> Kernel h_i at t = i dt, room for half as many steps, shape (0:)
      real(wp), intent(in) :: kernel(0:)

      real(wp), allocatable :: longer(:)
      integer :: room

      room = size(kernel)
      allocate (longer(room))
      longer = 0.0_wp
      if (allocated(self%sums)) longer(:size(self%sums)) = self%sums
      call move_alloc(longer, self%sums)
      allocate (longer(room))
      longer(room:1:-1) = kernel
      call move_alloc(longer, self%weights)
   end subroutine prepare

   !> Double sum D_n with the newest value w_n counted by a share of it
   pure function double_sum(self, n, w, share, history) result(total)
      !> The double sum
      class(volterra_t), intent(in) :: self
      !> Step, 1 <= n, 2 n <= room
      integer, intent(in) :: n
      !> Values w_1 .. w_n, shape (>= n)
      real(wp), contiguous, intent(in) :: w(:)
      !> Share of the newest value: 1, or 1/2 at the end of the trapezoidal rule
      real(wp), intent(in) :: share
      !> sum_{a<n} h_{n-a} w_a, where it is known from the first term; absent: computed
      real(wp), intent(in), optional :: history
      !> D_n
      real(wp) :: total

      real(wp) :: single
      integer :: room

      room = size(self%weights)
      if (present(history)) then
         single = history
      else
         single = dot(self%weights(room - n + 1:room - 1), w(1:n - 1))
      end if
      total = dot(self%weights(room - 2*n + 2:room - 2), self%sums(2:2*n - 2)) &
         + share*w(n)*(2.0_wp*single + self%weights(room)*share*w(n))
   end function double_sum

   !> D_n = constant + linear w_n + quadratic w_n^2 where the newest value is not known yet
   pure subroutine polynomial(self, n, w, constant, linear, quadratic)
      !> The double sum
      class(volterra_t), intent(in) :: self
      !> Step, 1 <= n, 2 n <= room
      integer, intent(in) :: n
      !> Values, w_1 .. w_{n-1} known, shape (>= n)
      real(wp), contiguous, intent(in) :: w(:)
      !> D_n without the newest value
      real(wp), intent(out) :: constant
      !> Coefficient of w_n
      real(wp), intent(out) :: linear
      !> Coefficient of w_n^2
      real(wp), intent(out) :: quadratic

      integer :: room

      room = size(self%weights)
      constant = dot(self%weights(room - 2*n + 2:room - 2), self%sums(2:2*n - 2))
      linear = 2.0_wp*dot(self%weights(room - n + 1:room - 1), w(1:n - 1))
      quadratic = self%weights(room)
   end subroutine polynomial

   !> Take the newest value w_n in, whole
   pure subroutine accept(self, n, w)
      !> The double sum
      class(volterra_t), intent(inout) :: self
      !> Step
      integer, intent(in) :: n
      !> Values w_1 .. w_n, shape (>= n)
      real(wp), contiguous, intent(in) :: w(:)

      self%sums(n + 1:2*n - 1) = self%sums(n + 1:2*n - 1) + 2.0_wp*w(n)*w(1:n - 1)
      self%sums(2*n) = self%sums(2*n) + w(n)**2
   end subroutine accept

end module vcor_solver_volterra
