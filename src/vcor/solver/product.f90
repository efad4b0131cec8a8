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
!> left per step is one equation s + c s^1.5 = r. The error falls with dt^2.5, the start u ~ t^1.5
!> being what limits it. The history sum makes N^2/2 multiplications and additions in all, on
!> contiguous arrays.
module vcor_solver_product
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : hertz_contact_time, impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, &
      contact_lasting, contact_separated, contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_dot, only : dot
   use vcor_solver_history, only : history_weights
   use vcor_solver_series, only : end_of_contact, find_series_peaks, set_series_weights
   use vcor_solver_type, only : solver_t
   implicit none
   private

   public :: product_t, new_product

   !> A run of more steps is given up: its history sums would take minutes
   integer, parameter :: most_steps = 200000

   !> Product integration
   type, extends(solver_t) :: product_t
      private
      !> Time step [s]; 0: refined until the accuracy is reached
      real(wp) :: time_step = 0.0_wp
      !> Wanted accuracy of the coefficient of restitution [-]
      real(wp) :: accuracy = 1.0e-6_wp
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp) :: end_time = 0.0_wp
   contains
      procedure :: solve
   end type product_t

contains

   !> Build the solver
   pure subroutine new_product(self, time_step, accuracy, end_time)
      !> The solver
      type(product_t), intent(out) :: self
      !> Time step [s]; 0: refined until the accuracy is reached
      real(wp), intent(in) :: time_step
      !> Wanted accuracy of the coefficient of restitution, > 0
      real(wp), intent(in) :: accuracy
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp), intent(in) :: end_time

      self%time_step = time_step
      self%accuracy = accuracy
      self%end_time = end_time
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
      real(wp) :: dt, end_time, cor(3)
      integer :: level

      end_time = self%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%patience()
      if (self%time_step > 0.0_wp) then
         dt = 4.0_wp*self%time_step
      else
         dt = hertz_contact_time*impact%time_scale()/real(first_steps, wp)
      end if

      level = 0
      do
         level = level + 1
         call march(impact, dt, end_time, trajectory, error)
         if (allocated(error)) return
         ! coarse steps can miss the end, so only the given step decides that there is none
         if (trajectory%status /= contact_separated .and. &
             (.not. self%time_step > 0.0_wp .or. level == 3)) return
         cor = [cor(2:3), -trajectory%state(col_velocity, trajectory%last)/impact%velocity]
         if (level >= 3) then
            trajectory%cor_error = error_of_last(cor)
            if (self%time_step > 0.0_wp .or. trajectory%cor_error <= self%accuracy) return
            if (2*trajectory%steps > most_steps) then
               call raise(error, error_numerical, 'the accuracy asked for is out of reach of ' &
                  //"product integration: raise accuracy or use method = 'ive'")
               return
            end if
         end if
         dt = 0.5_wp*dt
      end do
   end subroutine solve

   !> Error of the last of three values with steps 4 dt, 2 dt and dt, by Richardson's extrapolation
   !> with the order that the three show, at most two and at least one
   pure function error_of_last(value) result(error)
      !> Values
      real(wp), intent(in) :: value(3)
      !> Estimate
      real(wp) :: error

      real(wp) :: ratio

      error = abs(value(3) - value(2))
      ratio = 2.0_wp
      if (error > 0.0_wp) ratio = abs(value(2) - value(1))/error
      error = error/(min(max(ratio, 2.0_wp), 4.0_wp) - 1.0_wp)
   end function error_of_last

   !> One run with a given step
   subroutine march(impact, dt, end_time, trajectory, error)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> End of the computation [s]
      real(wp), intent(in) :: end_time
      !> Its course
      type(trajectory_t), intent(out) :: trajectory
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      ! rules for the integral over a step, from its end, its start and the node before
      real(wp), parameter :: adams_moulton(3) = [5.0_wp, 8.0_wp, -1.0_wp]/12.0_wp
      real(wp), parameter :: trapezoid(3) = [0.5_wp, 0.5_wp, 0.0_wp]
      ! Adams and Moulton's rule is stable up to 6 for a decay rate times the step
      real(wp), parameter :: stiff = 2.0_wp
      ! weights(room - i) = W_i: reversed, so that the history sum runs forward through both arrays
      real(wp), allocatable :: weights(:), du(:)
      real(wp) :: rule(3), t, s, u, velocity, force, impulse, regular_impulse, second_impulse
      real(wp) :: regular_force, previous_force, previous_impulse, before_force, before_impulse
      real(wp) :: history, viscosity, stiffness, alpha, alpha_rate, old_u, start, response, right
      integer :: n, room

      viscosity = impact%kernel_viscosity()
      room = min(max(16, nint(min(end_time, 5.0_wp*impact%time_scale())/dt)), most_steps) + 1
      call make_room()
      stiffness = weights(room)
      trajectory%state(:, 0) = 0.0_wp
      trajectory%state(col_velocity, 0) = impact%velocity
      trajectory%state(col_sphere_velocity, 0) = impact%velocity

      s = 0.0_wp
      u = 0.0_wp
      velocity = impact%velocity
      regular_force = 0.0_wp
      impulse = 0.0_wp
      regular_impulse = 0.0_wp
      second_impulse = 0.0_wp
      before_force = 0.0_wp
      before_impulse = 0.0_wp
      n = 0
      do
         n = n + 1
         if (n > most_steps) then
            call raise(error, error_numerical, 'no end of the contact within the largest number ' &
               //"of steps of product integration: give a longer time_step or use method = 'ive'")
            return
         end if
         if (n >= room) then
            room = 2*room
            call make_room()
         end if
         t = dt*real(n, wp)
         alpha = impact%plate%alpha(t)
         alpha_rate = impact%plate%alpha_rate(t)
         history = dot(weights(room - n + 1:room - 1), du(1:n - 1))

         rule = adams_moulton
         if (n == 1 .or. 1.5_wp*sqrt(abs(s))*dt*(alpha*stiffness + viscosity/impact%mass) > stiff) &
            rule = trapezoid

         ! F = stiffness*(u - old_u) + history + viscosity*u': impulse and second impulse of all
         ! that is known, then the equation for u, then what u adds
         old_u = u
         previous_force = regular_force
         previous_impulse = impulse
         start = history - stiffness*old_u
         regular_impulse = regular_impulse &
            + dt*(rule(1)*start + rule(2)*previous_force + rule(3)*before_force)
         second_impulse = second_impulse &
            + dt*(rule(1)*regular_impulse + rule(2)*previous_impulse + rule(3)*before_impulse)
         response = dt*rule(1)*stiffness + viscosity
         right = impact%velocity*t - second_impulse/impact%mass - alpha*regular_impulse
         call solve_step((dt*rule(1)/impact%mass + alpha)*response, right, s + dt*velocity, s, u)

         du(n) = u - old_u
         regular_force = start + stiffness*u
         regular_impulse = regular_impulse + dt*rule(1)*stiffness*u
         impulse = regular_impulse + viscosity*u
         second_impulse = second_impulse + dt*rule(1)*response*u
         before_force = previous_force
         before_impulse = previous_impulse
         velocity = (impact%velocity - impulse/impact%mass - alpha*regular_force &
            - alpha_rate*impulse)/(1.0_wp + 1.5_wp*alpha*viscosity*sqrt(abs(s)))
         force = regular_force + 1.5_wp*viscosity*sqrt(abs(s))*velocity

         associate (state => trajectory%state(:, n))
            state(col_time) = t
            state(col_indentation) = s
            state(col_velocity) = velocity
            state(col_force) = force
            state(col_impulse) = impulse
            state(col_sphere) = impact%velocity*t - second_impulse/impact%mass
            state(col_sphere_velocity) = impact%velocity - impulse/impact%mass
            state(col_plate) = alpha*impulse
            state(col_plate_velocity) = alpha*force + alpha_rate*impulse
         end associate
         trajectory%last = n
         trajectory%steps = n

         ! while the indentation grows the force is positive: what is not is rounding
         if (force <= 0.0_wp .and. velocity < 0.0_wp) then
            call end_of_contact(impact, stiffness, trajectory)
            trajectory%status = contact_separated
            exit
         else if (t >= end_time) then
            trajectory%status = contact_lasting
            exit
         else if (trajectory%is_stuck(impact%mass)) then
            trajectory%status = contact_sticking
            exit
         end if
      end do
      call set_series_weights(dt, trajectory)
      call find_series_peaks(trajectory)

   contains

      !> Make room for `room` steps, what is there stays
      subroutine make_room()
         real(wp), allocatable :: longer(:)

         call trajectory%reserve(room)
         allocate (longer(room))
         if (allocated(du)) longer(:size(du)) = du
         call move_alloc(longer, du)
         allocate (longer(room))
         longer(room:1:-1) = history_weights(impact, dt, room)
         call move_alloc(longer, weights)
      end subroutine make_room
   end subroutine march

   !> Solve s + c s^1.5 = r, odd in r, for y = sqrt(|s|): y^2 + c y^3 = |r| by Newton's method
   pure subroutine solve_step(c, r, guess, s, u)
      !> Coefficient [m^-0.5], >= 0
      real(wp), intent(in) :: c
      !> Right-hand side [m]
      real(wp), intent(in) :: r
      !> Guess at s [m]
      real(wp), intent(in) :: guess
      !> Indentation [m]
      real(wp), intent(out) :: s
      !> s^1.5 with the sign of s [m^1.5]
      real(wp), intent(out) :: u

      real(wp) :: y, correction
      integer :: iteration

      s = 0.0_wp
      u = 0.0_wp
      if (.not. abs(r) > 0.0_wp) return
      ! the root lies below sqrt(|r|); from any start Newton's method descends to it
      y = sqrt(abs(r))
      if (abs(guess) > 0.0_wp) y = min(y, sqrt(abs(guess)))
      do iteration = 1, 60
         correction = (y*y*(1.0_wp + c*y) - abs(r))/(y*(2.0_wp + 3.0_wp*c*y))
         y = y - correction
         if (abs(correction) <= 1.0e-9_wp*y) exit
      end do
      s = sign(y*y, r)
      u = s*y
   end subroutine solve_step

end module vcor_solver_product
