!> Evaluation of a solution on equal time steps: end of contact, quadrature weights, peaks
module vcor_solver_series
   use vcor_impact_problem, only : hertz, impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, columns, &
      trajectory_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: end_of_contact, end_of_receding_contact, set_series_weights, find_series_peaks

contains

   !> State where F = 0 in the step before node n, the first one with F <= 0. The indentation (by
   !> cubic Hermite interpolation) and the memory M = stiffness u - F (by a parabola) are smooth
   !> there even where s goes to zero with F
   pure function end_of_contact(impact, stiffness, trajectory, n) result(node)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> About dF/du [N/m^1.5]
      real(wp), intent(in) :: stiffness
      !> The trajectory
      type(trajectory_t), intent(in) :: trajectory
      !> Node
      integer, intent(in) :: n
      !> State
      real(wp) :: node(columns)

      real(wp) :: a(columns), b(columns), memory(-1:1), drift(-1:1), dt, theta, lower, upper
      real(wp) :: f, f_lower, f_upper, t
      integer :: j, iteration

      b = trajectory%state(:, n)
      a = trajectory%state(:, n - 1)
      dt = b(col_time) - a(col_time)
      do j = -1, 1
         associate (near => trajectory%state(:, max(n - 1 + j, 0)))
            memory(j) = stiffness*hertz(near(col_indentation)) - near(col_force)
            drift(j) = impact%plate%alpha(near(col_time))*near(col_force) - near(col_plate_velocity)
         end associate
      end do

      lower = 0.0_wp
      upper = 1.0_wp
      f_lower = a(col_force)
      f_upper = b(col_force)
      theta = 1.0_wp
      do iteration = 1, 200
         if (.not. f_upper < 0.0_wp .or. .not. f_lower > 0.0_wp) exit
         theta = (lower*f_upper - upper*f_lower)/(f_upper - f_lower)
         if (mod(iteration, 3) == 0) theta = 0.5_wp*(lower + upper)
         f = stiffness*hertz(hermite(a, b, dt, col_indentation, col_velocity, theta)) &
            - parabola(memory, theta)
         if (abs(upper - lower) <= 1.0e-13_wp) exit
         if (f > 0.0_wp) then
            lower = theta
            f_lower = f
         else
            upper = theta
            f_upper = f
         end if
      end do
      if (.not. f_lower > 0.0_wp) theta = 0.0_wp

      t = a(col_time) + theta*dt
      node(col_time) = t
      node(col_force) = 0.0_wp
      node(col_impulse) = hermite(a, b, dt, col_impulse, col_force, theta)
      node(col_sphere) = hermite(a, b, dt, col_sphere, col_sphere_velocity, theta)
      node(col_sphere_velocity) = impact%velocity - node(col_impulse)/impact%mass
      if (impact%plate%drifts()) then
         node(col_plate) = hermite(a, b, dt, col_plate, col_plate_velocity, theta)
         node(col_plate_velocity) = -parabola(drift, theta)
      else
         node(col_plate) = impact%plate%alpha(t)*node(col_impulse)
         node(col_plate_velocity) = impact%plate%alpha_rate(t)*node(col_impulse)
      end if
      node(col_indentation) = node(col_sphere) - node(col_plate)
      node(col_velocity) = node(col_sphere_velocity) - node(col_plate_velocity)
   end function end_of_contact

   !> State where a receding contact ends in the step before node n, as t1 gets to 0: it is a smooth
   !> function of time, and the force goes to zero as t1^1.5
   pure function end_of_receding_contact(impact, t1, trajectory, n) result(node)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> t1 at nodes n - 2, n - 1 and n in any unit, the last one negative
      real(wp), intent(in) :: t1(-1:1)
      !> The trajectory, node n without a force
      type(trajectory_t), intent(in) :: trajectory
      !> Node
      integer, intent(in) :: n
      !> State
      real(wp) :: node(columns)

      ! integrals of (1 - x)^1.5 from 0 to 1, once and twice
      real(wp), parameter :: once = 2.0_wp/5.0_wp, twice = 2.0_wp/7.0_wp
      real(wp) :: a(columns), b(columns), drift(-1:1), theta, lower, upper, tau, dt
      integer :: j, iteration

      b = trajectory%state(:, n)
      a = trajectory%state(:, n - 1)
      dt = b(col_time) - a(col_time)
      lower = 0.0_wp
      upper = 1.0_wp
      do iteration = 1, digits(1.0_wp)
         theta = 0.5_wp*(lower + upper)
         if (parabola(t1, theta) > 0.0_wp) then
            lower = theta
         else
            upper = theta
         end if
      end do
      do j = -1, 1
         associate (near => trajectory%state(:, max(n - 1 + j, 0)))
            drift(j) = impact%plate%alpha(near(col_time))*near(col_force) - near(col_plate_velocity)
         end associate
      end do

      tau = theta*dt
      node(col_time) = a(col_time) + tau
      node(col_force) = 0.0_wp
      node(col_impulse) = a(col_impulse) + once*tau*a(col_force)
      node(col_sphere) = a(col_sphere) + tau*(a(col_sphere_velocity) &
         - twice*tau*a(col_force)/impact%mass)
      node(col_sphere_velocity) = impact%velocity - node(col_impulse)/impact%mass
      if (impact%plate%drifts()) then
         node(col_plate) = hermite(a, b, dt, col_plate, col_plate_velocity, theta)
         node(col_plate_velocity) = -parabola(drift, theta)
      else
         node(col_plate) = impact%plate%alpha(node(col_time))*node(col_impulse)
         node(col_plate_velocity) = impact%plate%alpha_rate(node(col_time))*node(col_impulse)
      end if
      node(col_indentation) = node(col_sphere) - node(col_plate)
      node(col_velocity) = node(col_sphere_velocity) - node(col_plate_velocity)
   end function end_of_receding_contact

   !> Cubic through values and slopes at both ends of a step
   pure function hermite(a, b, dt, value, slope, x) result(y)
      !> State at the start
      real(wp), intent(in) :: a(columns)
      !> State at the end
      real(wp), intent(in) :: b(columns)
      !> Length of the step [s]
      real(wp), intent(in) :: dt
      !> Column of the values
      integer, intent(in) :: value
      !> Column of the slopes
      integer, intent(in) :: slope
      !> Position in the step, 0 .. 1
      real(wp), intent(in) :: x
      !> Interpolated value
      real(wp) :: y

      y = a(value)*(1.0_wp + 2.0_wp*x)*(1.0_wp - x)**2 + b(value)*x**2*(3.0_wp - 2.0_wp*x) &
         + dt*x*(1.0_wp - x)*(a(slope)*(1.0_wp - x) - b(slope)*x)
   end function hermite

   !> Parabola through values at -1, 0 and 1
   pure function parabola(value, x) result(y)
      !> Values
      real(wp), intent(in) :: value(-1:1)
      !> Argument
      real(wp), intent(in) :: x
      !> Interpolated value
      real(wp) :: y

      y = value(0) + 0.5_wp*x*(value(1) - value(-1) + x*(value(1) - 2.0_wp*value(0) + value(-1)))
   end function parabola

   !> Weights for integrals over the contact: trapezoids on the equal steps with both ends corrected
   !> by the first difference, with a dashpot the start for integrands in powers of t^(1/2); on the
   !> last step, which is shorter, the parabola through the last three nodes
   pure subroutine set_series_weights(dt, dashpot, trajectory)
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Whether the force has a dashpot's part, which grows as t^(1/2)
      logical, intent(in) :: dashpot
      !> The trajectory
      type(trajectory_t), intent(inout) :: trajectory

      ! a sum over t^p misses zeta(-p) dt^(p+1): what the first four nodes must add for
      ! p = 0, 1/2, 1 and 3/2
      real(wp), parameter :: start(0:3) = [-0.3442526640259193_wp, 0.8987100175331462_wp, &
         -0.8479953763218676_wp, 0.2935380228146408_wp]
      real(wp), parameter :: difference = 1.0_wp/12.0_wp
      real(wp) :: h
      integer :: n

      n = trajectory%last
      associate (w => trajectory%weight)
         w(0:n) = 0.0_wp
         if (n >= 2) then
            ! trapezoids up to node n - 1
            w(0:n - 1) = dt
            w(0) = 0.5_wp*dt
            w(n - 1) = 0.5_wp*dt
            if (n >= 6) then
               if (dashpot) then
                  w(0:3) = w(0:3) + dt*start
               else
                  w(0) = w(0) - dt*difference
                  w(1) = w(1) + dt*difference
               end if
               w(n - 1) = w(n - 1) - dt*difference
               w(n - 2) = w(n - 2) + dt*difference
            end if
            h = trajectory%state(col_time, n) - trajectory%state(col_time, n - 1)
            w(n - 2) = w(n - 2) - h**3/(6.0_wp*dt*(dt + h))
            w(n - 1) = w(n - 1) + h*(h + 3.0_wp*dt)/(6.0_wp*dt)
            w(n) = h*(2.0_wp*h + 3.0_wp*dt)/(6.0_wp*(dt + h))
         else
            w(0:n) = 0.5_wp*dt
         end if
      end associate
   end subroutine set_series_weights

   !> Largest indentation and force, by the parabola through the largest node and its neighbours
   pure subroutine find_series_peaks(trajectory)
      !> The trajectory
      type(trajectory_t), intent(inout) :: trajectory

      call peak(col_indentation, trajectory%max_indentation, trajectory%time_of_max_indentation)
      call peak(col_force, trajectory%max_force, trajectory%time_of_max_force)

   contains

      !> Peak of one column
      pure subroutine peak(column, value, time)
         !> Column
         integer, intent(in) :: column
         !> Largest value
         real(wp), intent(out) :: value
         !> Its time [s]
         real(wp), intent(out) :: time

         real(wp) :: y(-1:1), x, bend
         integer :: i

         i = maxloc(trajectory%state(column, 0:trajectory%last), 1) - 1
         value = trajectory%state(column, i)
         time = trajectory%state(col_time, i)
         ! the last node is not at an equal distance
         if (i < 1 .or. i > trajectory%last - 2) return
         y = trajectory%state(column, i - 1:i + 1)
         bend = y(1) - 2.0_wp*y(0) + y(-1)
         if (.not. bend < 0.0_wp) return
         x = 0.5_wp*(y(-1) - y(1))/bend
         value = parabola(y, x)
         time = time + x*(trajectory%state(col_time, i + 1) - time)
      end subroutine peak
   end subroutine find_series_peaks

end module vcor_solver_series
