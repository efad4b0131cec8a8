!> Evaluation of a run on equal steps: the state at the end of contact, found by interpolation in
!> the last step, the largest values, and the shares of the nodes in the impulse
module vcor_solver_direct_evaluation
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, columns, &
      trajectory_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: end_of_contact, end_of_receding_contact, set_shares, find_peaks, parabola, &
      fall_of

contains

   !> State where F = 0 in the step that ends at node n, the first node with F <= 0. In
   !> F = stiffness u - M the indentation is a Hermite cubic and the memory M a parabola: both are
   !> smooth even if s goes to zero together with F
   pure function end_of_contact(impact, stiffness, trajectory, n, latest) result(node)
      type(impact_t), intent(in) :: impact
      !> Approximate dF/du [N/m^1.5]
      real(wp), intent(in) :: stiffness
      type(trajectory_t), intent(in) :: trajectory
      !> First node with F <= 0
      integer, intent(in) :: n
      !> Position in the step where F <= 0, 0 .. 1
      real(wp), intent(in) :: latest
      !> State at the end of contact
      real(wp) :: node(columns)

      real(wp) :: a(columns), b(columns), memory(-1:1), theta, lower, upper, f, f_lower, f_upper, dt
      integer :: j, iteration

      b = trajectory%state(:, n)
      a = trajectory%state(:, n - 1)
      dt = b(col_time) - a(col_time)
      do j = -1, 1
         associate (near => trajectory%state(:, max(n - 1 + j, 0)))
            memory(j) = stiffness*impact%law%u(near(col_indentation)) - near(col_force)
         end associate
      end do

      lower = 0.0_wp
      upper = latest
      f_lower = a(col_force)
      f_upper = b(col_force)
      if (upper < 1.0_wp) f_upper = stiffness*impact%law%u(hermite(a, b, col_indentation, &
         col_velocity, upper)) - parabola(memory, upper)
      theta = upper
      do iteration = 1, 200
         if (.not. f_upper < 0.0_wp .or. .not. f_lower > 0.0_wp) exit
         theta = (lower*f_upper - upper*f_lower)/(f_upper - f_lower)
         if (mod(iteration, 3) == 0) theta = 0.5_wp*(lower + upper)
         f = stiffness*impact%law%u(hermite(a, b, col_indentation, col_velocity, theta)) &
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

      node(col_time) = a(col_time) + theta*dt
      node(col_impulse) = hermite(a, b, col_impulse, col_force, theta)
      node(col_sphere) = hermite(a, b, col_sphere, col_sphere_velocity, theta)
      call complete(impact, trajectory, n, theta, node)
   end function end_of_contact

   !> State where a receding contact ends in the step that ends at node n: where the condition for
   !> t1 holds with t1 = 0. The force, an integral over u' from 0 to t1, goes to zero as t1^n
   pure function end_of_receding_contact(impact, condition, trajectory, n) result(node)
      type(impact_t), intent(in) :: impact
      !> Integral of k(t - x) s'(x) over the whole contact at nodes n - 2, n - 1 and n in any unit,
      !> negative at node n
      real(wp), intent(in) :: condition(-1:1)
      !> Trajectory, with no force at node n
      type(trajectory_t), intent(in) :: trajectory
      !> First node after the end
      integer, intent(in) :: n
      !> State at the end of contact
      real(wp) :: node(columns)

      real(wp) :: a(columns), theta, tau, once, twice

      a = trajectory%state(:, n - 1)
      theta = fall_of(condition)

      ! (1 - x)^n integrated once and twice from x = 0 to 1
      once = 1.0_wp/(impact%law%start_exponent + 1.0_wp)
      twice = 1.0_wp/(impact%law%start_exponent + 2.0_wp)
      tau = theta*(trajectory%state(col_time, n) - a(col_time))
      node(col_time) = a(col_time) + tau
      node(col_impulse) = a(col_impulse) + once*tau*a(col_force)
      node(col_sphere) = a(col_sphere) + tau*(a(col_sphere_velocity) &
         + tau*(0.5_wp*impact%gravity - twice*a(col_force)/impact%mass))
      call complete(impact, trajectory, n, theta, node)
   end function end_of_receding_contact

   !> Complete the state at the end of contact
   pure subroutine complete(impact, trajectory, n, theta, node)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      !> First node after the end
      integer, intent(in) :: n
      !> Position of the end in the step to node n, 0 .. 1
      real(wp), intent(in) :: theta
      !> State; on entry its time, impulse and displacement of the sphere are set
      real(wp), intent(inout) :: node(columns)

      real(wp) :: drift(-1:1)
      integer :: j

      node(col_force) = 0.0_wp
      node(col_sphere_velocity) = impact%free_velocity(node(col_time)) &
         - node(col_impulse)/impact%mass
      if (impact%target%drifts()) then
         do j = -1, 1
            associate (near => trajectory%state(:, max(n - 1 + j, 0)))
               drift(j) = impact%target%alpha(near(col_time))*near(col_force) &
                  - near(col_plate_velocity)
            end associate
         end do
         node(col_plate) = hermite(trajectory%state(:, n - 1), trajectory%state(:, n), col_plate, &
            col_plate_velocity, theta)
         node(col_plate_velocity) = -parabola(drift, theta)
      else
         node(col_plate) = impact%target%alpha(node(col_time))*node(col_impulse)
         node(col_plate_velocity) = impact%target%alpha_rate(node(col_time))*node(col_impulse)
      end if
      node(col_indentation) = node(col_sphere) - node(col_plate)
      node(col_velocity) = node(col_sphere_velocity) - node(col_plate_velocity)
   end subroutine complete

   !> Cubic through the values and slopes at both ends of a step
   pure function hermite(a, b, value, slope, x) result(y)
      !> State at the start
      real(wp), intent(in) :: a(columns)
      !> State at the end
      real(wp), intent(in) :: b(columns)
      !> Column of the values
      integer, intent(in) :: value
      !> Column of the slopes
      integer, intent(in) :: slope
      !> Position in the step, 0 .. 1
      real(wp), intent(in) :: x
      !> Interpolated value
      real(wp) :: y

      y = a(value)*(1.0_wp + 2.0_wp*x)*(1.0_wp - x)**2 + b(value)*x**2*(3.0_wp - 2.0_wp*x) &
         + (b(col_time) - a(col_time))*x*(1.0_wp - x)*(a(slope)*(1.0_wp - x) - b(slope)*x)
   end function hermite

   !> Shares of the nodes in the impulse I. If x is linear over each step they follow from the
   !> changes dI, also of a force that starts as a root. What the bend of x and the change of F
   !> within the steps add is, with dt dF taken from dI where there are neighbours,
   !>
   !>     int F x dt - sum dI (x_{j-1} + x_j)/2 = dt/6 sum dF dx - dt^2/12 [F x'] + O(dt^4)
   !>
   !> For x = z' this is the change of the sphere's energy
   pure subroutine set_shares(dt, trajectory)
      !> Time step [s]
      real(wp), intent(in) :: dt
      type(trajectory_t), intent(inout) :: trajectory

      real(wp) :: rise(0:trajectory%last), last, part
      integer :: n, j

      n = trajectory%last
      associate (share => trajectory%share, state => trajectory%state)
         rise(0) = dt*state(col_force, 0)
         rise(1:) = state(col_impulse, 1:n) - state(col_impulse, 0:n - 1)
         share(0:n) = 0.0_wp
         do j = 1, n
            share(j - 1:j) = share(j - 1:j) + 0.5_wp*rise(j)
         end do
         if (n < 6) return
         last = state(col_time, n) - state(col_time, n - 1)
         do j = 1, n
            if (j < n - 1) then
               part = (rise(j + 1) - rise(j - 1))/12.0_wp
            else
               part = merge(dt/6.0_wp, last/12.0_wp, j < n) &
                  *(state(col_force, j) - state(col_force, j - 1))
            end if
            share(j - 1:j) = share(j - 1:j) + part*[-1.0_wp, 1.0_wp]
         end do
         share(0:1) = share(0:1) + rise(0)/12.0_wp*[-1.0_wp, 1.0_wp]
         share(n - 2:n - 1) = share(n - 2:n - 1) &
            + dt/12.0_wp*state(col_force, n - 1)*[1.0_wp, -1.0_wp]
      end associate
   end subroutine set_shares

   !> Parabola through values at -1, 0 and 1
   pure function parabola(value, x) result(y)
      real(wp), intent(in) :: value(-1:1)
      !> Argument
      real(wp), intent(in) :: x
      !> Interpolated value
      real(wp) :: y

      y = value(0) + 0.5_wp*x*(value(1) - value(-1) + x*(value(1) - 2.0_wp*value(0) + value(-1)))
   end function parabola

   !> Place between 0 and 1 at which a parabola falls through zero
   pure function fall_of(value) result(x)
      !> Values at -1, 0 and 1, the last one not above 0
      real(wp), intent(in) :: value(-1:1)
      real(wp) :: x

      real(wp) :: lower, upper
      integer :: iteration

      lower = 0.0_wp
      upper = 1.0_wp
      do iteration = 1, digits(1.0_wp)
         x = 0.5_wp*(lower + upper)
         if (parabola(value, x) > 0.0_wp) then
            lower = x
         else
            upper = x
         end if
      end do
   end function fall_of

   !> Largest indentation and force, by the parabola through the largest node and its neighbours
   pure subroutine find_peaks(trajectory)
      type(trajectory_t), intent(inout) :: trajectory

      call peak(col_indentation, trajectory%max_indentation, trajectory%time_of_max_indentation)
      call peak(col_force, trajectory%max_force, trajectory%time_of_max_force)

   contains

      !> Peak of one column
      pure subroutine peak(column, value, time)
         integer, intent(in) :: column
         !> Largest value
         real(wp), intent(out) :: value
         !> Time of the largest value [s]
         real(wp), intent(out) :: time

         real(wp) :: y(-1:1), x, bend
         integer :: i

         i = maxloc(trajectory%state(column, 0:trajectory%last), 1) - 1
         value = trajectory%state(column, i)
         time = trajectory%state(col_time, i)
         ! the last node has another distance
         if (i < 1 .or. i > trajectory%last - 2) return
         y = trajectory%state(column, i - 1:i + 1)
         bend = y(1) - 2.0_wp*y(0) + y(-1)
         if (.not. bend < 0.0_wp) return
         x = 0.5_wp*(y(-1) - y(1))/bend
         value = parabola(y, x)
         time = time + x*(trajectory%state(col_time, i + 1) - time)
      end subroutine peak
   end subroutine find_peaks

end module vcor_solver_direct_evaluation
