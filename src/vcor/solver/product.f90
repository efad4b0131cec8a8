!> Product integration of the twice-integrated equation of motion, for every kernel
!>
!> On equal steps u is taken as a parabola through the ends of the step and the node before, and the
!> kernel integrated exactly over each step. With u' dt = du_j + (theta - 1/2) (du_j - du_{j-1}) on
!> step j, du_j = u_j - u_{j-1}, the force is one sum over the history,
!>
!>     F_n = sum_{j=1..n} W_{n-j} du_j,   W_i = w_i + v_i - v_{i-1},
!>     w_i = int_0^1 k((i + 1 - theta) dt) dtheta,
!>     v_i = int_0^1 k((i + 1 - theta) dt) (theta - 1/2) dtheta
!>
!> so that a singular kernel needs no care. Impulse and second impulse follow by the Adams-Moulton
!> rule of third order, or by the trapezoidal rule where the plate or a dashpot makes a step stiff,
!> which keeps the method stable for any step; a dashpot's impulse is viscosity*u exactly. What is
!> left per step is one equation s + c s^1.5 + d s^3 = r, d = 0 without the second term of the
!> Volterra series. The drift of a frozen plate, the integral of alpha' F, begins with the power of
!> time that kernel and plate give it: no parabola. The error falls with dt^2.5, the start u ~ t^1.5
!> being what limits it. The history sum makes N^2/2 multiplications and additions in all, on
!> contiguous arrays.
module vcor_solver_product
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : hertz, hertz_contact_time, impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, columns, &
      contact_separated, contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_dot, only : dot
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_solver_history, only : history_rule
   use vcor_solver_plate_sums, only : plate_sums_t
   use vcor_solver_receding, only : receding_t, refuse_growth
   use vcor_solver_second_term, only : second_term_t
   use vcor_solver_series, only : end_of_contact, end_of_receding_contact, find_series_peaks, &
      set_series_weights
   use vcor_solver_type, only : solver_t
   implicit none
   private

   public :: product_t, new_product

   !> A run of more steps is given up: its history sums take seconds
   integer, parameter :: most_steps = 60000

   !> Product integration
   type, extends(solver_t) :: product_t
      private
      !> Time step [s]; 0: refined until the accuracy is reached
      real(wp) :: time_step = 0.0_wp
      !> Wanted accuracy of the coefficient of restitution [-]; 0: none, the time step is given
      real(wp) :: accuracy = 1.0e-6_wp
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp) :: end_time = 0.0_wp
      !> Coefficient c2 of the second term of the Volterra series [m^-1.5], 0 without it
      real(wp) :: second_coefficient = 0.0_wp
      !> Go on after the separation
      logical :: ghost = .false.
   contains
      procedure :: solve
   end type product_t

contains

   !> Build the solver
   pure subroutine new_product(self, time_step, accuracy, end_time, second_coefficient, ghost)
      !> The solver
      type(product_t), intent(out) :: self
      !> Time step [s]; 0: refined until the accuracy is reached
      real(wp), intent(in) :: time_step
      !> Wanted accuracy of the coefficient of restitution, > 0; with a time step it is what the
      !> result is held against, and may be 0
      real(wp), intent(in) :: accuracy
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp), intent(in) :: end_time
      !> Coefficient of the second term of the Volterra series [m^-1.5]; absent: without it
      real(wp), intent(in), optional :: second_coefficient
      !> Go on after the separation, to `end_time` or to twice the contact time; absent: no
      logical, intent(in), optional :: ghost

      self%time_step = time_step
      self%accuracy = accuracy
      self%end_time = end_time
      if (present(second_coefficient)) self%second_coefficient = second_coefficient
      if (present(ghost)) self%ghost = ghost
   end subroutine new_product

   !> Compute the course of an impact, with the error estimated from runs with longer steps
   subroutine solve(self, impact, trajectory, error)
      !> The solver
      class(product_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its course
      type(trajectory_t), intent(out) :: trajectory
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: first_steps = 64
      real(wp), parameter :: least_part = 32.0_wp
      real(wp) :: dt, cor(3), cor_sphere(3), depth(3), force(3)
      type(richardson_t) :: found
      integer :: level

      if (self%time_step > 0.0_wp) then
         dt = 4.0_wp*self%time_step
      else
         ! a glassy modulus that lasts for no time at all is no reason for tiny steps
         dt = hertz_contact_time/real(first_steps, wp)*max(impact%fast_time_scale(), &
            impact%time_scale()/least_part)
         ! the last step ends where the computation is to end
         if (self%end_time > 0.0_wp) &
            dt = self%end_time/real(ceiling(min(self%end_time/dt, real(most_steps, wp))), wp)
      end if

      level = 0
      do
         level = level + 1
         call march(self, impact, dt, trajectory, error)
         if (allocated(error)) return
         ! coarse steps can miss the end, so only the given step decides that there is none
         if (trajectory%status /= contact_separated .and. &
             (.not. self%time_step > 0.0_wp .or. level == 3)) return
         associate (final => trajectory%state(:, trajectory%last))
            cor = [cor(2:3), -final(col_velocity)/impact%velocity]
            cor_sphere = [cor_sphere(2:3), -final(col_sphere_velocity)/impact%velocity]
         end associate
         depth = [depth(2:3), trajectory%max_indentation]
         force = [force(2:3), trajectory%max_force]
         if (level >= 3) then
            trajectory%accuracy = self%accuracy
            found = richardson(cor)
            trajectory%cor_error = found%error
            found = richardson(cor_sphere)
            trajectory%cor_sphere_error = found%error
            if (self%time_step > 0.0_wp) return
            if (max(trajectory%cor_error, trajectory%cor_sphere_error) <= self%accuracy) then
               ! the steps were not chosen for the maxima
               trajectory%max_indentation = extrapolated(depth)
               trajectory%max_force = extrapolated(force)
               return
            end if
            if (2*trajectory%steps > most_steps) then
               if (.not. trajectory%misses_by_far()) return
               call raise(error, error_numerical, 'the accuracy asked for is out of reach of ' &
                  //'product integration: give a larger solver.accuracy')
               return
            end if
         end if
         dt = 0.5_wp*dt
      end do
   end subroutine solve

   !> Limit of three values with steps 4 dt, 2 dt and dt, the last one where they show no order that
   !> the method has
   pure function extrapolated(value)
      !> Values
      real(wp), intent(in) :: value(3)
      !> Their limit
      real(wp) :: extrapolated

      real(wp), parameter :: least_order = 1.5_wp
      type(richardson_t) :: found

      extrapolated = value(3)
      found = richardson(value)
      if (.not. ieee_is_finite(found%order)) return
      if (found%order >= least_order) extrapolated = found%limit
   end function extrapolated

   !> One run with a given step
   subroutine march(self, impact, dt, trajectory, error)
      !> The solver
      type(product_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Its course
      type(trajectory_t), intent(out) :: trajectory
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      ! rules for the integral over a step, from its end, its start and the node before
      real(wp), parameter :: adams_moulton(3) = [5.0_wp, 8.0_wp, -1.0_wp]/12.0_wp
      real(wp), parameter :: trapezoid(3) = [0.5_wp, 0.5_wp, 0.0_wp]
      ! Adams and Moulton's rule is stable up to 6 for a decay rate times the step
      real(wp), parameter :: stiff = 2.0_wp
      ! steps next to t = 0 on which the rate of the drift is no parabola
      integer, parameter :: near_start = 16
      ! weights(room - i) = W_i: reversed, so that the history sum runs forward through both arrays
      real(wp), allocatable :: weights(:), moments(:), du(:)
      type(second_term_t) :: second
      type(plate_sums_t) :: memory
      type(receding_t) :: contact
      ! integrals over time: value, and integrand at the last node and the one before, of the force
      ! without a dashpot's, of the whole impulse, and for a frozen plate of alpha F, alpha' F and
      ! the drift, the integral of alpha' F
      real(wp), dimension(3) :: impulse, second_impulse, push, drift, lag
      ! s and s' at the node without its force, and what they lose per force
      real(wp), dimension(2) :: indentation, velocity
      real(wp) :: drift_rule(3), drift_power
      real(wp) :: rule(3), weight, t, s, u, last_u, speed, last_speed, force, dashpot, held
      real(wp) :: viscosity, stiffness, alpha, alpha_rate, known, linear, quadratic, whole_impulse
      real(wp) :: end_time, node(columns)
      integer :: n, room
      logical :: frozen, two_terms, receding, ends

      viscosity = impact%kernel_viscosity()
      frozen = impact%plate%frozen()
      two_terms = abs(self%second_coefficient) > 0.0_wp
      receding = impact%law%receding
      end_time = self%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%patience(impact%time_scale())
      room = min(max(16, nint(min(end_time, 5.0_wp*impact%time_scale())/dt)), most_steps) + 1
      call make_room()
      stiffness = weights(room)
      trajectory%state(:, 0) = 0.0_wp
      trajectory%state(col_velocity, 0) = impact%velocity
      trajectory%state(col_sphere_velocity, 0) = impact%velocity

      drift_power = 0.0_wp
      if (frozen) drift_power = power_of_drift(impact, dt)
      s = 0.0_wp
      u = 0.0_wp
      speed = impact%velocity
      impulse = 0.0_wp
      second_impulse = 0.0_wp
      push = 0.0_wp
      drift = 0.0_wp
      lag = 0.0_wp
      force = 0.0_wp
      dashpot = 0.0_wp
      held = 0.0_wp
      n = 0
      do
         n = n + 1
         if (n > most_steps) exit
         if (n >= room) then
            room = 2*room
            call make_room()
         end if
         t = dt*real(n, wp)
         call impact%plate%alpha_and_rate(t, alpha, alpha_rate)
         rule = dt*adams_moulton
         if (n == 1 .or. 1.5_wp*sqrt(abs(s))*dt*((alpha + dt*memory%newest)*stiffness &
             + viscosity/impact%mass) > stiff) rule = dt*trapezoid
         weight = rule(1)
         drift_rule = rule
         if (frozen .and. n <= near_start) drift_rule = dt*power_rule(n, drift_power)

         ! what is known before this node's force
         call memory%sum_up(n)
         impulse(1) = so_far(impulse)
         second_impulse(1) = so_far(second_impulse)
         if (frozen) then
            push(1) = so_far(push)
            drift(1) = drift(1) + drift_rule(2)*drift(2) + drift_rule(3)*drift(3)
            lag(1) = so_far(lag)
         end if

         if (.not. contact%shrinks) then
            call set_motion(0.0_wp)
            ! F = known + linear*u + quadratic*u^2, and the dashpot's viscosity*u', makes
            ! s + c u + d u^2 = right
            known = dot(weights(room - n + 1:room - 1), du(1:n - 1)) - stiffness*u
            linear = stiffness
            quadratic = 0.0_wp
            if (two_terms) call second%add(n, du, u, known, linear, quadratic)
            last_u = u
            last_speed = speed
            call solve_step(indentation(2)*linear + indentation(2)/weight*viscosity, &
               indentation(2)*quadratic, indentation(1) - indentation(2)*known, s + dt*speed, s, u)
            du(n) = u - last_u
            force = known + (linear + quadratic*u)*u
            dashpot = viscosity*u
            ! with alpha F in U' and the dashpot's force in F
            speed = (velocity(1) - velocity(2)*force - (velocity(2) - alpha)/weight*dashpot) &
               /(1.0_wp + 1.5_wp*alpha*viscosity*sqrt(abs(s)))
            if (two_terms) call second%accept(n, du)
            ! a first step in which the motion turns is too long, and will be halved
            if (receding .and. speed < 0.0_wp .and. n > 1) then
               ! a dashpot's impulse stays what it is at the largest indentation; at rest that may
               ! have been some steps ago
               last_speed = max(0.0_wp, last_speed)
               held = viscosity*hertz(trajectory%state(col_indentation, n - 1) &
                  + 0.5_wp*dt*last_speed**2/(last_speed - speed))
               call set_motion(held)
               call contact%find_force(impact, n, du, indentation, velocity, viscosity)
            end if
         else
            call set_motion(held)
            call contact%find_force(impact, n, du, indentation, velocity, viscosity)
         end if
         if (contact%regrows) then
            call refuse_growth(impact, error)
            return
         end if
         if (contact%shrinks) then
            force = contact%force
            dashpot = held
            s = indentation(1) - indentation(2)*force
            speed = velocity(1) - velocity(2)*force
         end if

         call take(impulse, force, weight*force)
         whole_impulse = impulse(1) + dashpot
         call take(second_impulse, whole_impulse, weight*whole_impulse)
         call memory%accept(n, whole_impulse, second_impulse(1))
         call contact%accept(n, s)
         if (frozen) then
            call take(push, alpha*force, weight*alpha*force)
            call take(drift, alpha_rate*force, drift_rule(1)*alpha_rate*force)
            call take(lag, drift(1), weight*drift(1))
         end if
         if (.not. contact%shrinks) force = force + 1.5_wp*viscosity*sqrt(abs(s))*speed

         node(col_time) = t
         node(col_indentation) = s
         node(col_velocity) = speed
         node(col_force) = force
         node(col_impulse) = whole_impulse
         node(col_sphere) = impact%velocity*t - second_impulse(1)/impact%mass
         node(col_sphere_velocity) = impact%velocity - whole_impulse/impact%mass
         node(col_plate) = node(col_sphere) - s
         node(col_plate_velocity) = node(col_sphere_velocity) - speed
         trajectory%final = trajectory%final + 1
         trajectory%state(:, trajectory%final) = node
         if (trajectory%status == contact_separated) then
            if (t + dt > end_time*(1.0_wp + 1.0e-9_wp)) exit
            cycle
         end if

         trajectory%last = n
         trajectory%steps = n
         ! while the indentation grows the force is positive: what is not is rounding
         ends = force <= 0.0_wp .and. speed < 0.0_wp
         if (contact%shrinks) then
            ends = contact%t1(3) <= 0.0_wp
            if (ends) trajectory%state(:, n) = end_of_receding_contact(impact, contact%t1, &
               trajectory, n)
         else if (ends) then
            trajectory%state(:, n) = end_of_contact(impact, stiffness, trajectory, n)
         end if
         if (trajectory%is_stuck(impact)) then
            trajectory%status = contact_sticking
            exit
         else if (ends) then
            trajectory%status = contact_separated
            if (.not. self%ghost) exit
            trajectory%final = n + 1
            trajectory%state(:, n + 1) = node
            if (.not. self%end_time > 0.0_wp) end_time = 2.0_wp*t
         else if (t + dt > end_time*(1.0_wp + 1.0e-9_wp)) then
            exit
         end if
      end do
      call set_series_weights(dt, viscosity > 0.0_wp, trajectory)
      call find_series_peaks(trajectory)

   contains

      !> Make room for `room` steps, what is there stays
      subroutine make_room()
         real(wp), allocatable :: longer(:)

         ! one node more for the end of contact before ghost lines
         call trajectory%reserve(room + 1)
         allocate (longer(room))
         if (allocated(du)) longer(:size(du)) = du
         call move_alloc(longer, du)
         allocate (longer(room))
         if (allocated(moments)) deallocate (moments)
         allocate (moments(0:room - 1))
         call history_rule(impact, dt, room, longer, moments)
         longer = longer(room:1:-1)
         call move_alloc(longer, weights)
         if (receding) call contact%prepare(dt, weights, moments)
         if (impact%plate%hereditary()) call memory%prepare(impact%plate, dt, room)
         if (two_terms) call second%prepare(impact, self%second_coefficient, dt, room)
      end subroutine make_room

      !> s and s' at this node without its force, and what they lose per force
      subroutine set_motion(held)
         !> Impulse of a dashpot [N s]
         real(wp), intent(in) :: held

         real(wp) :: i, j, rate

         ! I and J without this node's force, and the rate of U' per impulse
         i = impulse(1) + held
         j = second_impulse(1) + weight*i
         rate = alpha_rate + memory%newest
         indentation(1) = impact%velocity*t - j/impact%mass
         velocity(1) = impact%velocity - i/impact%mass
         if (frozen) then
            indentation(1) = indentation(1) - (push(1) - lag(1) - weight*drift(1))
            velocity(1) = velocity(1) + drift(1)
            indentation(2) = weight*(weight/impact%mass + alpha - drift_rule(1)*alpha_rate)
            velocity(2) = weight/impact%mass + alpha - drift_rule(1)*alpha_rate
         else
            indentation(1) = indentation(1) - alpha*i - memory%deflection - memory%newest*j
            velocity(1) = velocity(1) - rate*i - memory%velocity
            indentation(2) = weight*(weight/impact%mass + alpha + weight*memory%newest)
            velocity(2) = weight/impact%mass + alpha + weight*rate
         end if
      end subroutine set_motion

      !> An integral up to this node without the share of the node itself
      pure function so_far(integral) result(value)
         !> Value, integrand at the last node and the one before
         real(wp), intent(in) :: integral(3)
         !> Value
         real(wp) :: value

         value = integral(1) + rule(2)*integral(2) + rule(3)*integral(3)
      end function so_far
   end subroutine march

   !> Power of t with which the rate of a frozen plate's drift, alpha' F, begins: alpha' is infinite
   !> at first contact for a continuous spectrum, and F = int k u' goes with t^(1/2) int k
   pure function power_of_drift(impact, dt) result(power)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Power, of the first two steps
      real(wp) :: power

      real(wp) :: ratio

      ratio = impact%kernel_integral(2.0_wp*dt)/impact%kernel_integral(dt) &
         *impact%plate%alpha_rate(2.0_wp*dt)/max(impact%plate%alpha_rate(dt), tiny(1.0_wp))
      power = 0.5_wp + log(max(ratio, 0.5_wp))/log(2.0_wp)
   end function power_of_drift

   !> Rule for the integral over step n, from its end, its start and the node before, that is exact
   !> for t^power times a parabola, on the first two steps times what can be told from fewer nodes
   pure function power_rule(n, power) result(rule)
      !> Step
      integer, intent(in) :: n
      !> Power, > -1
      real(wp), intent(in) :: power
      !> The rule, over the step
      real(wp) :: rule(3)

      real(wp) :: moment(0:2), x
      integer :: k

      ! of (t - n)^k t^power
      x = real(n, wp)
      do k = 0, 2
         moment(k) = (x**(power + real(k + 1, wp)) - (x - 1.0_wp)**(power + real(k + 1, wp))) &
            /(power + real(k + 1, wp))
      end do
      moment(2) = moment(2) - 2.0_wp*x*moment(1) + x*x*moment(0)
      moment(1) = moment(1) - x*moment(0)
      rule = 0.0_wp
      select case (n)
      case (1)
         rule(1) = moment(0)
      case (2)
         rule(1:2) = [moment(0) + moment(1), -moment(1)]
      case default
         rule = [moment(0) + 1.5_wp*moment(1) + 0.5_wp*moment(2), -2.0_wp*moment(1) - moment(2), &
            0.5_wp*(moment(1) + moment(2))]
         rule(3) = rule(3)/(x - 2.0_wp)**power
      end select
      rule(1) = rule(1)/x**power
      if (n > 1) rule(2) = rule(2)/(x - 1.0_wp)**power
   end function power_rule

   !> Complete an integral by the share of this node
   pure subroutine take(integral, integrand, share)
      !> Value, integrand at the last node and the one before
      real(wp), intent(inout) :: integral(3)
      !> Integrand at this node
      real(wp), intent(in) :: integrand
      !> Share of the node in the integral
      real(wp), intent(in) :: share

      integral = [integral(1) + share, integrand, integral(2)]
   end subroutine take

   !> Solve s + c u + d u^2 = r, u = s^1.5 with the sign of s, for y = sqrt(|s|):
   !> y^2 + c y^3 +- d y^6 = |r| by Newton's method
   pure subroutine solve_step(c, d, r, guess, s, u)
      !> Coefficient [m^-0.5], >= 0
      real(wp), intent(in) :: c
      !> Coefficient [m^-2], small
      real(wp), intent(in) :: d
      !> Right-hand side [m]
      real(wp), intent(in) :: r
      !> Guess at s [m]
      real(wp), intent(in) :: guess
      !> Indentation [m]
      real(wp), intent(out) :: s
      !> s^1.5 with the sign of s [m^1.5]
      real(wp), intent(out) :: u

      real(wp) :: y, e, correction
      integer :: iteration

      s = 0.0_wp
      u = 0.0_wp
      if (.not. abs(r) > 0.0_wp) return
      e = sign(d, r)
      ! with d = 0 the root lies below sqrt(|r|), and from any start Newton's method descends to it
      y = sqrt(abs(r))
      if (abs(guess) > 0.0_wp) y = min(y, sqrt(abs(guess)))
      do iteration = 1, 60
         correction = (y*y*(1.0_wp + c*y + e*y**4) - abs(r)) &
            /(y*(2.0_wp + 3.0_wp*c*y + 6.0_wp*e*y**4))
         y = y - correction
         if (abs(correction) <= 1.0e-9_wp*y) exit
      end do
      s = sign(y*y, r)
      u = s*y
   end subroutine solve_step

end module vcor_solver_product
