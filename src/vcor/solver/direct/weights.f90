!> Weights W_i of the sums over the past in product integration, F_n = sum_j W_{n-j} du_j with
!> du_j = u_j - u_{j-1}: u' is linear over each step and the kernel times u' is integrated exactly
module vcor_solver_direct_weights
   use vcor_impact_target, only : target_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_quadrature, only : endpoint_rule, newton_cotes
   use vcor_solver_convolution, only : convolution_t
   use vcor_tuning, only : near => direct_near
   implicit none
   private

   public :: contact_kernel_t, memory_weights, square_weights, start_force

   !> Number of parts into which the Newton-Cotes rule divides each step near t = 0
   integer, parameter :: parts = ubound(newton_cotes, 1)

   !> Kernel of the contact with its weights W_i = w_i + v_i - v_{i-1}: w_i is the mean of k over
   !> step i and v_i = int_0^1 k((i + 1 - theta) dt) (theta - 1/2) dtheta
   type, extends(convolution_t) :: contact_kernel_t
      !> Time step [s]
      real(wp) :: dt = 0.0_wp
      !> Means w_i [N/m^1.5], shape (0:room)
      real(wp), allocatable :: mean(:)
      !> Moments v_i [N/m^1.5], shape (0:room-1)
      real(wp), allocatable :: moment(:)
   contains
      procedure :: prepare
      procedure :: late_mean
   end type contact_kernel_t

contains

   !> Compute the weights of the contact kernel
   pure subroutine prepare(self, impact, dt, n)
      class(contact_kernel_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Time step [s], > 0
      real(wp), intent(in) :: dt
      !> Number of weights
      integer, intent(in) :: n

      real(wp) :: weights(0:n - 1)

      self%dt = dt
      if (allocated(self%mean)) deallocate (self%mean, self%moment)
      allocate (self%mean(0:n), self%moment(0:n - 1))
      self%mean = impact%kernel_step_integrals(dt, n + 1)/dt
      call rule_of_means(self%mean, &
         impact%kernel_step_integrals(dt/real(parts, wp), near*parts)/dt, &
         impact%kernel_mean_integral(dt)/dt, n, weights, self%moment)
      call self%set(weights)
   end subroutine prepare

   !> Force soon after first contact, where s = v0 t and u ~ t^n: n int k(t - x) x^(n-1) dx
   pure function start_force(impact, dt, steps) result(force)
      type(impact_t), intent(in) :: impact
      !> Time step [s], > 0
      real(wp), intent(in) :: dt
      !> Times in steps, shape (n)
      real(wp), intent(in) :: steps(:)
      !> Force over u at the end of the first step [N/m^1.5], shape (n)
      real(wp) :: force(size(steps))

      real(wp), allocatable :: node(:), share(:)
      integer :: i

      call endpoint_rule(node, share)
      associate (exponent => impact%law%start_exponent)
         share = share*exponent*(1.0_wp - node)**(exponent - 1.0_wp)
         do i = 1, size(steps)
            force(i) = steps(i)**exponent*sum(share*impact%kernel(dt*steps(i)*node))
         end do
      end associate
   end function start_force

   !> Mean of k(t - x) over the later part in x of the step that t1 lies in, from the mean over the
   !> whole step and the slope between its neighbours
   pure function late_mean(self, i, position) result(mean)
      class(contact_kernel_t), intent(in) :: self
      !> Step of the kernel, whose argument runs from i dt to (i + 1) dt, i > 0
      integer, intent(in) :: i
      !> Start of the part within the step, 0 .. 1
      real(wp), intent(in) :: position
      !> Mean [N/m^1.5]
      real(wp) :: mean

      mean = self%mean(i) + 0.25_wp*position*(self%mean(i - 1) - self%mean(i + 1))
   end function late_mean

   !> Weights W_i of the memory psi of a hereditary plate
   pure function memory_weights(plate, dt, n) result(weight)
      type(target_t), intent(in) :: plate
      !> Time step [s], > 0
      real(wp), intent(in) :: dt
      !> Number of weights
      integer, intent(in) :: n
      !> Weights [m/(N s2)], shape (0:n-1)
      real(wp) :: weight(0:n - 1)

      real(wp), allocatable :: node(:), share(:)
      real(wp) :: moment(0:n - 1), integral(0:n + 1), fine(0:near*parts)
      integer :: i

      do i = 0, n + 1
         integral(i) = plate%memory_integral(dt*real(i, wp))
      end do
      do i = 0, near*parts
         fine(i) = plate%memory_integral(dt*(real(i, wp)/real(parts, wp)))
      end do
      call endpoint_rule(node, share)
      call rule_of_means((integral(1:) - integral(:n))/dt, &
         (fine(1:) - fine(:near*parts - 1))/dt, sum(share*plate%memory_integral(dt*node))/dt, n, &
         weight, moment)
   end function memory_weights

   !> Weights and moments from means. With K the integral of k, integration by parts gives the
   !> moment (mean of K over the step - mean of K at its ends)/dt; away from t = 0 it is
   !> (w_{i-1} - w_{i+1})/24 with an error of order dt^3 times the third derivative of k
   pure subroutine rule_of_means(mean, part, first, n, weight, moment)
      !> Mean of the kernel over each step, shape (0:n)
      real(wp), intent(in) :: mean(0:)
      !> Integral of k over each part of the first steps, divided by dt, shape (0:near*parts-1)
      real(wp), intent(in) :: part(0:)
      !> Mean of K over the first step, divided by dt
      real(wp), intent(in) :: first
      !> Number of weights
      integer, intent(in) :: n
      !> Weights, shape (0:n-1)
      real(wp), intent(out) :: weight(0:)
      !> Moments, shape (0:n-1)
      real(wp), intent(out) :: moment(0:)

      real(wp) :: integral(0:parts)
      integer :: i, j

      moment(0) = first - 0.5_wp*mean(0)
      do i = 1, min(near, n) - 1
         integral(0) = 0.0_wp
         do j = 1, parts
            integral(j) = integral(j - 1) + part(i*parts + j - 1)
         end do
         moment(i) = sum(newton_cotes*integral) - 0.5_wp*integral(parts)
      end do
      do i = near, n - 1
         moment(i) = (mean(i - 1) - mean(i + 1))/24.0_wp
      end do

      weight(0) = mean(0) + moment(0)
      do i = 1, n - 1
         weight(i) = mean(i) + moment(i) - moment(i - 1)
      end do
   end subroutine rule_of_means

   !> Weights of the second term of the Volterra series, means of k(x + y) over squares of steps:
   !> q_i = (1/dt^2) int_0^dt int_0^dt k(i dt + x + y) dx dy is the mean over x of w(i + x/dt), with
   !> w(i) the mean of the kernel over step i. It is computed by quadrature near t = 0, farther off
   !> from the cubic through w at four whole steps
   function square_weights(impact, dt, n) result(mean)
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Number of weights
      integer, intent(in) :: n
      !> Weights q_i [N/m^1.5], shape (0:n-1)
      real(wp) :: mean(0:n - 1)

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
   end function square_weights

end module vcor_solver_direct_weights
