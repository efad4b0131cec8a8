!> Second term of the Volterra series in product integration, at the cost of a few history sums
!>
!>     F2(t) = c2 int int k(x + y) u'(t - x) u'(t - y) dx dy,   Eq. (10) with h2 = k(t1 + t2)
!>
!> With u piecewise linear and the kernel integrated exactly over each square of steps,
!>
!>     F2_n = c2 sum_{a,b=1..n} q_{2n-a-b} du_a du_b
!>     q_i = (1/dt^2) int_0^dt int_0^dt k(i dt + x + y) dx dy
!>
!> which is O(n) work per step by the sums of `vcor_solver_volterra`. The step's own du_n is not
!> known yet; it enters as a quadratic polynomial.
module vcor_solver_second_term
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_quadrature, only : endpoint_rule, newton_cotes
   use vcor_solver_volterra, only : volterra_t
   implicit none
   private

   public :: second_term_t

   !> Second term under way
   type :: second_term_t
      private
      !> Double sum with the weights c2 q_i
      type(volterra_t) :: sums
   contains
      !> Make room
      procedure :: prepare
      !> The term as a polynomial of the unknown u_n
      procedure :: add
      !> Go on to the next step
      procedure :: accept
   end type second_term_t

contains

   !> Make room for `steps` steps, what is there stays
   subroutine prepare(self, impact, coefficient, dt, steps)
      !> The term
      class(second_term_t), intent(inout) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Coefficient c2 [m^-1.5]
      real(wp), intent(in) :: coefficient
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Number of steps
      integer, intent(in) :: steps

      call self%sums%prepare(coefficient*square_means(impact, dt, 2*steps))
   end subroutine prepare

   !> Mean of the kernel over the squares x, y in (0, dt) at i dt + x + y, i = 0 .. n - 1: the mean
   !> over x of w(i + x/dt), w(i) the mean of the kernel over step i. Near t = 0 by quadrature,
   !> farther off from the w at whole steps, up to their fourth difference
   function square_means(impact, dt, n) result(mean)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Number of means
      integer, intent(in) :: n
      !> Means [N/m^1.5], shape (0:n-1)
      real(wp) :: mean(0:n - 1)

      integer, parameter :: near = 16, parts = ubound(newton_cotes, 1)
      real(wp) :: w(0:n + 1), part(0:(near + 2)*parts - 1), step(0:parts)
      real(wp), allocatable :: node(:), share(:)
      integer :: i, j

      w = impact%kernel_step_integrals(dt, n + 2)/dt
      call endpoint_rule(node, share)
      mean(0) = sum(share*(impact%kernel_integral(dt*(1.0_wp + node)) &
         - impact%kernel_integral(dt*node)))/dt
      part = impact%kernel_step_integrals(dt/real(parts, wp), (near + 2)*parts)/dt
      do i = 1, min(near, n) - 1
         do j = 0, parts
            step(j) = sum(part(i*parts + j:(i + 1)*parts + j - 1))
         end do
         mean(i) = sum(newton_cotes*step)
      end do
      do i = near, n - 1
         mean(i) = (13.0_wp*(w(i) + w(i + 1)) - w(i - 1) - w(i + 2))/24.0_wp
      end do
   end function square_means

   !> Add the term at step n to F = known + linear*u_n + quadratic*u_n^2
   pure subroutine add(self, n, du, u, known, linear, quadratic)
      !> The term
      class(second_term_t), intent(in) :: self
      !> Step
      integer, intent(in) :: n
      !> Differences of u, those before step n known [m^1.5], shape (>= n)
      real(wp), intent(in), contiguous :: du(:)
      !> u at the last step [m^1.5]
      real(wp), intent(in) :: u
      !> Constant part [N]
      real(wp), intent(inout) :: known
      !> Coefficient of u_n [N/m^1.5]
      real(wp), intent(inout) :: linear
      !> Coefficient of u_n^2 [N/m^3]
      real(wp), intent(inout) :: quadratic

      real(wp) :: constant, first, own

      ! with du_n = u_n - u
      call self%sums%polynomial(n, du, constant, first, own)
      known = known + constant - first*u + own*u**2
      linear = linear + first - 2.0_wp*own*u
      quadratic = quadratic + own
   end subroutine add

   !> Take du_n into the sums
   pure subroutine accept(self, n, du)
      !> The term
      class(second_term_t), intent(inout) :: self
      !> Step
      integer, intent(in) :: n
      !> Differences of u up to step n [m^1.5], shape (>= n)
      real(wp), intent(in), contiguous :: du(:)

      call self%sums%accept(n, du)
   end subroutine accept

end module vcor_solver_second_term
