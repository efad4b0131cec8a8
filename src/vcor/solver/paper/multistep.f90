!> Formulas of the paper's time marching: Adams and Bashforth's, backward differences, Runge and
!> Kutta's start
module vcor_solver_paper_multistep
   use vcor_impact_law, only : contact_law_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: adams_bashforth, second_difference, first_difference, runge_kutta
   public :: start_steps, ab_points, second_points, first_points

   !> Steps of Runge and Kutta's start
   integer, parameter :: start_steps = 3
   !> Slopes in Adams and Bashforth's formula of fifth order
   integer, parameter :: ab_points = 5
   !> Points of the second backward difference of fifth order
   integer, parameter :: second_points = 7
   !> Points of the first backward difference of fifth order
   integer, parameter :: first_points = 6

   !> Weights of the slopes, newest first; column p is the formula of order p
   real(wp), parameter :: adams_bashforth(ab_points, start_steps + 1:ab_points) = reshape([ &
      55.0_wp/24.0_wp, -59.0_wp/24.0_wp, 37.0_wp/24.0_wp, -9.0_wp/24.0_wp, 0.0_wp, &
      1901.0_wp/720.0_wp, -2774.0_wp/720.0_wp, 2616.0_wp/720.0_wp, -1274.0_wp/720.0_wp, &
      251.0_wp/720.0_wp], [ab_points, ab_points - start_steps])

   !> Weights of the points in the second derivative times dt^2, newest first; column p takes p
   !> points
   real(wp), parameter :: second_difference(second_points, 3:second_points) = reshape([ &
      1.0_wp, -2.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      2.0_wp, -5.0_wp, 4.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      35.0_wp/12.0_wp, -26.0_wp/3.0_wp, 19.0_wp/2.0_wp, -14.0_wp/3.0_wp, 11.0_wp/12.0_wp, &
      0.0_wp, 0.0_wp, &
      15.0_wp/4.0_wp, -77.0_wp/6.0_wp, 107.0_wp/6.0_wp, -13.0_wp, 61.0_wp/12.0_wp, &
      -5.0_wp/6.0_wp, 0.0_wp, &
      203.0_wp/45.0_wp, -87.0_wp/5.0_wp, 117.0_wp/4.0_wp, -254.0_wp/9.0_wp, 33.0_wp/2.0_wp, &
      -27.0_wp/5.0_wp, 137.0_wp/180.0_wp], [second_points, second_points - 2])

   !> Weights of the points in the first derivative times dt, newest first; column p takes p points
   real(wp), parameter :: first_difference(first_points, 2:first_points) = reshape([ &
      1.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      1.5_wp, -2.0_wp, 0.5_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      11.0_wp/6.0_wp, -3.0_wp, 1.5_wp, -1.0_wp/3.0_wp, 0.0_wp, 0.0_wp, &
      25.0_wp/12.0_wp, -4.0_wp, 3.0_wp, -4.0_wp/3.0_wp, 0.25_wp, 0.0_wp, &
      137.0_wp/60.0_wp, -5.0_wp, 5.0_wp, -10.0_wp/3.0_wp, 1.25_wp, -0.2_wp], &
      [first_points, first_points - 1])

contains

   !> A step of s'' = -a u - b u' by Runge and Kutta's classical formula of fourth order
   pure subroutine runge_kutta(law, a, b, dt, s, velocity)
      !> Contact law
      type(contact_law_t), intent(in) :: law
      !> Firmness over mass [m^-0.5 s^-2]
      real(wp), intent(in) :: a
      !> Plate parameter times firmness [m^-0.5 s^-1]
      real(wp), intent(in) :: b
      !> Step [s]
      real(wp), intent(in) :: dt
      !> Indentation [m], on return that after the step
      real(wp), intent(inout) :: s
      !> Its rate [m/s], on return that after the step
      real(wp), intent(inout) :: velocity

      real(wp), dimension(2) :: y, k1, k2, k3, k4

      y = [s, velocity]
      k1 = slope(y)
      k2 = slope(y + 0.5_wp*dt*k1)
      k3 = slope(y + 0.5_wp*dt*k2)
      k4 = slope(y + dt*k3)
      y = y + dt/6.0_wp*(k1 + 2.0_wp*(k2 + k3) + k4)
      s = y(1)
      velocity = y(2)

   contains

      !> Slopes of s and s'
      pure function slope(y) result(f)
         !> s and s'
         real(wp), intent(in) :: y(2)
         !> Their slopes
         real(wp) :: f(2)

         f = [y(2), -law%secant(y(1))*(a*y(1) + law%exponent*b*y(2))]
      end function slope
   end subroutine runge_kutta

end module vcor_solver_paper_multistep
