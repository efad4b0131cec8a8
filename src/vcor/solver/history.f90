!> Weights of the history sum of product integration
module vcor_solver_history
   use vcor_impact_plate, only : plate_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_quadrature, only : endpoint_rule, newton_cotes
   implicit none
   private

   public :: history_weights, history_rule, plate_weights

   !> Steps next to t = 0 whose moments are integrated in parts, and the parts of each
   integer, parameter :: near = 16, parts = ubound(newton_cotes, 1)

contains

   !> Weights W_i = w_i + v_i - v_{i-1}, i = 0 .. n - 1, of the kernel of the contact
   pure function history_weights(impact, dt, n) result(weight)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s], > 0
      real(wp), intent(in) :: dt
      !> Number of weights
      integer, intent(in) :: n
      !> Weights [N/m^1.5], shape (0:n-1)
      real(wp) :: weight(0:n - 1)

      real(wp) :: moment(0:n - 1)

      call history_rule(impact, dt, n, weight, moment)
   end function history_weights

   !> Weights W_i = w_i + v_i - v_{i-1} and moments v_i of the kernel of the contact, with w_i the
   !> mean of the kernel over step i and v_i = int_0^1 k((i + 1 - theta) dt) (theta - 1/2) dtheta
   pure subroutine history_rule(impact, dt, n, weight, moment)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s], > 0
      real(wp), intent(in) :: dt
      !> Number of weights
      integer, intent(in) :: n
      !> Weights [N/m^1.5], shape (0:n-1)
      real(wp), intent(out) :: weight(0:)
      !> Moments [N/m^1.5], shape (0:n-1)
      real(wp), intent(out) :: moment(0:)

      call rule_of_means(impact%kernel_step_integrals(dt, n + 1)/dt, &
         impact%kernel_step_integrals(dt/real(parts, wp), near*parts)/dt, &
         impact%kernel_mean_integral(dt)/dt, n, weight, moment)
   end subroutine history_rule

   !> Weights W_i of the memory of a hereditary plate
   pure function plate_weights(plate, dt, n) result(weight)
      !> The plate
      type(plate_t), intent(in) :: plate
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
   end function plate_weights

   !> Weights and moments from means. By parts the moment is, with K the integral of k,
   !> (mean of K over the step - mean of K at its ends)/dt; away from t = 0 it is
   !> (w_{i-1} - w_{i+1})/24 but for terms of order dt^3 times the third derivative of k
   pure subroutine rule_of_means(mean, part, first, n, weight, moment)
      !> Mean of the kernel over each step, shape (0:n)
      real(wp), intent(in) :: mean(0:)
      !> Integral over each part of the first steps, over dt, shape (0:near*parts-1)
      real(wp), intent(in) :: part(0:)
      !> Mean of K over the first step, over dt
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

end module vcor_solver_history
