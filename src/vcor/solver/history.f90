!> Weights of the history sum of product integration
module vcor_solver_history
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_quadrature, only : endpoint_rule, newton_cotes
   implicit none
   private

   public :: history_weights

contains

   !> Weights W_i = w_i + v_i - v_{i-1}, i = 0 .. n - 1, with w_i the mean of the kernel over step i
   !> and v_i its moment int_0^1 k((i + 1 - theta) dt) (theta - 1/2) dtheta. By parts the moment is,
   !> with K the integral of k, (mean of K over the step - mean of K at its ends)/dt; away from
   !> t = 0 it is (w_{i-1} - w_{i+1})/24 but for terms of order dt^3 k'''
   pure function history_weights(impact, dt, n) result(weight)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s], > 0
      real(wp), intent(in) :: dt
      !> Number of weights
      integer, intent(in) :: n
      !> Weights [N/m^1.5], shape (0:n-1)
      real(wp) :: weight(0:n - 1)

      integer, parameter :: near = 16, parts = ubound(newton_cotes, 1)
      real(wp) :: mean(0:n), part(0:near*parts - 1), integral(0:parts), moment(0:n - 1)
      real(wp), allocatable :: node(:), share(:)
      integer :: i, j

      mean = impact%kernel_step_integrals(dt, n + 1)/dt

      ! first step: the kernel may be singular at its end
      call endpoint_rule(node, share)
      moment(0) = sum(share*impact%kernel_integral(dt*node))/dt - 0.5_wp*mean(0)
      part = impact%kernel_step_integrals(dt/real(parts, wp), near*parts)
      do i = 1, min(near, n) - 1
         integral(0) = 0.0_wp
         do j = 1, parts
            integral(j) = integral(j - 1) + part(i*parts + j - 1)
         end do
         moment(i) = (sum(newton_cotes*integral) - 0.5_wp*integral(parts))/dt
      end do
      do i = near, n - 1
         moment(i) = (mean(i - 1) - mean(i + 1))/24.0_wp
      end do

      weight(0) = mean(0) + moment(0)
      do i = 1, n - 1
         weight(i) = mean(i) + moment(i) - moment(i - 1)
      end do
   end function history_weights

end module vcor_solver_history
