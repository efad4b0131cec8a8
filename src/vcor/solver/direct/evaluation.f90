!> Evaluation of a run of product integration: the state at the end of contact, found by
!> interpolation in the last step, and quadrature weights for integrals over the contact
module vcor_solver_direct_evaluation
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, columns, &
      trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver_equal_steps, only : add_last_step, parabola
   use vcor_tuning, only : next_to_integer
   implicit none
   private

   public :: end_of_contact, end_of_receding_contact, set_weights, start_weights

contains

   !> State where F = 0 in the step that ends at node n, the first node with F <= 0. In
   !> F = stiffness u - M the indentation is a Hermite cubic and the memory M a parabola: both are
   !> smooth even if s goes to zero together with F
   pure function end_of_contact(impact, stiffness, recoil, trajectory, n) result(node)
      type(impact_t), intent(in) :: impact
      !> Approximate dF/du [N/m^1.5]
      real(wp), intent(in) :: stiffness
      !> Recoil C(oo) F' in U' of a layer at nodes n - 2, n - 1 and n [m/s]
      real(wp), intent(in) :: recoil(-1:1)
      type(trajectory_t), intent(in) :: trajectory
      !> First node with F <= 0
      integer, intent(in) :: n
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
      upper = 1.0_wp
      f_lower = a(col_force)
      f_upper = b(col_force)
      theta = 1.0_wp
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
      call complete(impact, recoil, trajectory, n, theta, node)
      f = (0.5_wp*(memory(1) - memory(-1)) + theta*(memory(1) - 2.0_wp*memory(0) + memory(-1)))/dt
      associate (instant => impact%plate%instant(), velocity => node(col_velocity))
         velocity = (velocity + instant*f) &
            /(1.0_wp + instant*stiffness*impact%law%slope(node(col_indentation)))
         node(col_plate_velocity) = node(col_sphere_velocity) - velocity
      end associate
   end function end_of_contact

   !> State where a receding contact ends in the step that ends at node n: at t1 = 0, as t1 is a
   !> smooth function of time. The force, an integral over u' from 0 to t1, goes to zero as t1^n
   pure function end_of_receding_contact(impact, t1, recoil, trajectory, n) result(node)
      type(impact_t), intent(in) :: impact
      !> t1 at nodes n - 2, n - 1 and n in any unit, negative at node n
      real(wp), intent(in) :: t1(-1:1)
      !> Recoil C(oo) F' in U' of a layer at the same nodes [m/s]
      real(wp), intent(in) :: recoil(-1:1)
      !> Trajectory, with no force at node n
      type(trajectory_t), intent(in) :: trajectory
      !> First node after the end
      integer, intent(in) :: n
      !> State at the end of contact
      real(wp) :: node(columns)

      real(wp) :: a(columns), theta, lower, upper, tau, once, twice
      integer :: iteration

      a = trajectory%state(:, n - 1)
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

      ! (1 - x)^n integrated once and twice from x = 0 to 1
      once = 1.0_wp/(impact%law%exponent + 1.0_wp)
      twice = 1.0_wp/(impact%law%exponent + 2.0_wp)
      tau = theta*(trajectory%state(col_time, n) - a(col_time))
      node(col_time) = a(col_time) + tau
      node(col_impulse) = a(col_impulse) + once*tau*a(col_force)
      node(col_sphere) = a(col_sphere) + tau*(a(col_sphere_velocity) &
         + tau*(0.5_wp*impact%gravity - twice*a(col_force)/impact%mass))
      call complete(impact, recoil, trajectory, n, theta, node)
   end function end_of_receding_contact

   !> Complete the state at the end of contact, without the recoil in the plate's velocity there
   pure subroutine complete(impact, recoil, trajectory, n, theta, node)
      type(impact_t), intent(in) :: impact
      !> Recoil C(oo) F' in U' of a layer at nodes n - 2, n - 1 and n [m/s]
      real(wp), intent(in) :: recoil(-1:1)
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
      if (impact%plate%drifts()) then
         do j = -1, 1
            associate (near => trajectory%state(:, max(n - 1 + j, 0)))
               drift(j) = impact%plate%alpha(near(col_time))*near(col_force) &
                  + recoil(j) - near(col_plate_velocity)
            end associate
         end do
         node(col_plate) = hermite(trajectory%state(:, n - 1), trajectory%state(:, n), col_plate, &
            col_plate_velocity, theta)
         node(col_plate_velocity) = -parabola(drift, theta)
      else
         node(col_plate) = impact%plate%alpha(node(col_time))*node(col_impulse)
         node(col_plate_velocity) = impact%plate%alpha_rate(node(col_time))*node(col_impulse)
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

   !> Weights for integrals over the contact: the trapezoidal rule on the equal steps, corrected at
   !> both ends by the first difference (Gregory), with a dashpot by `start_weights` at the start;
   !> on the shorter last step, the parabola through the last three nodes
   pure subroutine set_weights(impact, dt, trajectory)
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      type(trajectory_t), intent(inout) :: trajectory

      real(wp), parameter :: difference = 1.0_wp/12.0_wp
      integer :: n

      n = trajectory%last
      associate (w => trajectory%weight)
         w(0:n) = 0.5_wp*dt
         if (n < 2) return
         ! trapezoidal rule up to node n - 1
         w(1:n - 2) = dt
         w(n) = 0.0_wp
         if (n >= 6) then
            if (impact%kernel_viscosity() > 0.0_wp) then
               w(0:3) = w(0:3) + dt*start_weights(impact%law)
            else
               w(0:1) = w(0:1) + dt*difference*[-1.0_wp, 1.0_wp]
            end if
            w(n - 2:n - 1) = w(n - 2:n - 1) + dt*difference*[1.0_wp, -1.0_wp]
         end if
         call add_last_step(dt, trajectory%state(col_time, n) - trajectory%state(col_time, n - 1), &
            w(n - 2:n))
      end associate
   end subroutine set_weights

   !> Corrections to the trapezoidal rule with unit steps for integrands that start as a sum of
   !> 1, t^(n-1), t and t^n, as the force of a dashpot does: for t^p the rule is too large by
   !> zeta(-p). If n is close to an integer these are smooth and Gregory's correction is enough
   pure function start_weights(law) result(weight)
      type(contact_law_t), intent(in) :: law
      !> Corrections to the weights of nodes 0 .. 3
      real(wp) :: weight(4)

      real(wp) :: p, a, b, c, d(2)

      p = law%exponent - 1.0_wp
      weight = [-1.0_wp, 1.0_wp, 0.0_wp, 0.0_wp]/12.0_wp
      if (abs(p - anint(p)) < next_to_integer) return
      ! for the corrections w_j, with v_j = w_j j^p:
      ! sum v_j = a, sum v_j j^(1-p) = a + b, sum v_j j = a + c
      a = -zeta(-p)
      b = 1.0_wp/12.0_wp - a
      c = -zeta(-law%exponent) - a
      d = [2.0_wp, 3.0_wp]**(1.0_wp - p) - 1.0_wp
      weight(4) = (b - d(1)*c)/(d(2) - 2.0_wp*d(1))
      weight(3) = c - 2.0_wp*weight(4)
      weight(2) = a - weight(3) - weight(4)
      weight(3:4) = weight(3:4)/[2.0_wp, 3.0_wp]**p
      weight(1) = -sum(weight(2:4))
   end function start_weights

   !> Riemann's zeta function for -2 < s < 0 by the Euler-Maclaurin formula
   pure function zeta(s)
      !> Argument
      real(wp), intent(in) :: s
      real(wp) :: zeta

      integer, parameter :: terms = 20
      integer :: k

      associate (n => real(terms, wp))
         zeta = sum([(real(k, wp)**(-s), k=1, terms - 1)]) + n**(-s)*(0.5_wp + n/(s - 1.0_wp) &
            + s/(12.0_wp*n)*(1.0_wp - (s + 1.0_wp)*(s + 2.0_wp)/(60.0_wp*n**2) &
            *(1.0_wp - (s + 3.0_wp)*(s + 4.0_wp)/(42.0_wp*n**2) &
            *(1.0_wp - (s + 5.0_wp)*(s + 6.0_wp)/(40.0_wp*n**2)))))
      end associate
   end function zeta

end module vcor_solver_direct_evaluation
