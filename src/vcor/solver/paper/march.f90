!> One run of the paper's time marching, the seven steps of Section V of Green's paper
!>
!> On equal steps, with the rate w = u' = n s^(n-1) s' and the kernel h = k in form a of Eq. (8), or
!> w = u and h = k' in form b,
!>
!>     H_n = dt sum_{j=1..n} w_j h_{n-j},   F_n = H_n  or  F_n = k(0) u_n + H_n
!>     I_n = I_{n-1} + dt F_n,   U_n = alpha_n I_n,   s''_n = -F_n/m - U''_n
!>
!> or, for a frozen plate, U''_n = alpha_n F'_n. The trapezoidal rule halves the last term of the
!> sums, and is used for I_n, too; the first term is zero. U'' is the backward difference of fifth
!> order, of lower order while fewer points exist; the plate is at rest before contact. s and s'
!> advance by the Adams-Bashforth formula of fifth order, once of fourth order, after three
!> Runge-Kutta steps with the first values of kernel and alpha. An infinite k(0) is replaced by
!> k(dt); a finite one is used unchanged, however steep the kernel.
module vcor_solver_paper_march
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, columns, &
      contact_separated, contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_solver_convolution, only : convolution_t, lengthen, second_term_t
   use vcor_solver_direct_evaluation, only : find_peaks
   use vcor_solver_paper_formulas, only : ab_points, adams_bashforth, damping_limit, &
      first_difference, first_points, kernel_terms, runge_kutta, second_difference, second_points, &
      start_steps
   use vcor_solver_type, only : solver_settings_t
   implicit none
   private

   public :: march, capped, most_steps, share_of_newest, stable_damping

   !> Maximum number of steps: the sums of more take seconds
   integer, parameter :: most_steps = 60000
   !> Number of velocities kept, for a sixth difference
   integer, parameter :: kept = 7
   !> Points of the interpolation that finds the end of the contact
   integer, parameter :: points = 6
   !> Nodes needed beyond the first one without force, so that the root is amid the points
   integer, parameter :: steps_beyond = points/2 - 1

   !> A run with a given step, at its last node
   type :: paper_run_t
      !> Time step [s]
      real(wp) :: dt = 0.0_wp
      !> Weight of the newest value in the sums
      real(wp) :: share = 1.0_wp
      !> Kernel h_j
      type(convolution_t) :: kernel
      !> Values w_j on which the kernel acts
      real(wp), allocatable :: w(:)
      !> Second term of the Volterra series
      type(second_term_t) :: second
      !> First values of the kernel k [N/m^1.5] and of alpha [m/(N s)], as used by the scheme
      real(wp) :: first_kernel = 0.0_wp, first_alpha = 0.0_wp
      !> Indentation [m]
      real(wp) :: s = 0.0_wp
      !> s' [m/s] and s'' [m/s2], newest first
      real(wp) :: velocity(kept) = 0.0_wp, acceleration(ab_points) = 0.0_wp
      !> Force [N] and, where the plate is not frozen, deflection [m], newest first
      real(wp) :: force(first_points) = 0.0_wp, deflection(second_points) = 0.0_wp
      !> Impulse [N s]
      real(wp) :: impulse = 0.0_wp
      !> Integral of alpha' F of a frozen plate [m/s], and its rate [m/s2]
      real(wp) :: drift = 0.0_wp, drift_rate = 0.0_wp
      !> Deflection of the plate [m] and its rate [m/s]
      real(wp) :: plate = 0.0_wp, plate_velocity = 0.0_wp
      !> Damping d = (3/2) alpha sqrt(s) of oscillations from step to step by the plate
      real(wp) :: damping = 0.0_wp
   end type paper_run_t

contains

   !> Whether k(0) is infinite and replaced
   pure function capped(impact)
      type(impact_t), intent(in) :: impact
      logical :: capped

      capped = impact%modulus%glassy() > huge(1.0_wp)
   end function capped

   !> The kernel k_j at t = j dt, k(0) capped if it is infinite
   pure function kernel_values(impact, dt, n) result(kernel)
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Number of values
      integer, intent(in) :: n
      !> Values [N/m^1.5], shape (0:n-1)
      real(wp) :: kernel(0:n - 1)

      integer :: j

      kernel = impact%kernel([(dt*real(j, wp), j = 0, n - 1)])
      if (capped(impact)) kernel(0) = impact%kernel(dt)
   end function kernel_values

   !> Weight of the newest value in the sums: 1 for rectangles, 1/2 for trapezoids
   pure function share_of_newest(settings) result(share)
      type(solver_settings_t), intent(in) :: settings
      !> Share [-]
      real(wp) :: share

      share = merge(0.5_wp, 1.0_wp, settings%quadrature == 'trapezoid')
   end function share_of_newest

   !> Largest d = (3/2) alpha sqrt(s) for which the scheme is stable
   pure function stable_damping(settings, impact, dt) result(limit)
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Limit [m^1.5/(N s)]
      real(wp) :: limit

      limit = damping_limit(dt, kernel_values(impact, dt, kernel_terms + 1), settings%form(1:1), &
         share_of_newest(settings), impact%target%frozen())
   end function stable_damping

   !> One run with a given step
   subroutine march(settings, impact, dt, ghost, trajectory, stable, complete)
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Whether to continue after the separation
      logical, intent(in) :: ghost
      type(trajectory_t), intent(out) :: trajectory
      !> Whether no oscillation from step to step has grown
      logical, intent(out) :: stable
      !> Whether the number of steps was sufficient
      logical, intent(out) :: complete

      ! sixth difference of the velocity: 1 for a value that alternates in sign
      real(wp), parameter :: alternating(kept) = &
         [1.0_wp, -6.0_wp, 15.0_wp, -20.0_wp, 15.0_wp, -6.0_wp, 1.0_wp]/64.0_wp
      ! a growing oscillation is detected before it affects most digits of the outcome
      real(wp), parameter :: noticeable = 1.0e-5_wp
      ! factors of the initial velocity that no solution exceeds
      real(wp), parameter :: fastest = 1.2_wp, fastest_ghost = 20.0_wp
      type(paper_run_t) :: run
      real(wp) :: end_time, limit, t, node(columns)
      integer :: n, room, crossing
      logical :: beyond_limit, ends

      ! steps (1) and (2): the kernel, and the state at first contact
      stable = .false.
      complete = .true.
      end_time = settings%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%lasting_time(impact%time_scale())
      room = max(kernel_terms, nint(min(min(end_time, 5.0_wp*impact%time_scale())/dt, &
         real(most_steps, wp)))) + steps_beyond + 2
      run%dt = dt
      run%share = share_of_newest(settings)
      run%velocity(1) = impact%velocity
      t = merge(dt, 0.0_wp, capped(impact))
      run%first_kernel = impact%kernel(t)
      run%first_alpha = impact%target%alpha(t)
      call make_room(run, settings, impact, room, trajectory)
      node = 0.0_wp
      node([col_velocity, col_sphere_velocity]) = impact%velocity
      call trajectory%begin(node)
      limit = stable_damping(settings, impact, dt)
      beyond_limit = .false.

      ! step (3): the loop over time
      crossing = 0
      n = 0
      do
         n = n + 1
         complete = n <= most_steps
         if (.not. complete) exit
         if (n >= room) then
            room = 2*room
            call make_room(run, settings, impact, room, trajectory)
         end if
         t = dt*real(n, wp)
         call advance(run, impact, n)
         if (.not. abs(run%velocity(1)) <= merge(fastest, fastest_ghost, crossing == 0) &
             *impact%velocity) return
         call sum_force(run, settings, impact, n)
         call accelerate(run, impact, n)

         ! an oscillation from step to step that the damping should have stopped
         beyond_limit = beyond_limit .or. run%damping > limit
         if (.not. ieee_is_finite(run%acceleration(1))) return
         if (beyond_limit .and. n > second_points) then
            if (abs(sum(alternating*run%velocity)) > noticeable*impact%velocity) return
         end if

         call trajectory%add(state_of(run, impact, t))
         ends = t + dt > end_time*(1.0_wp + 1.0e-9_wp)
         if (crossing > 0) then
            if (n >= crossing + steps_beyond .and. (ends .or. .not. ghost)) exit
            cycle
         end if

         trajectory%last = n
         trajectory%steps = n
         if (run%force(1) <= 0.0_wp) then
            ! while the indentation grows the force is positive
            if (run%force(1) < 0.0_wp .and. run%velocity(1) > 0.0_wp .and. n > second_points &
                .and. .not. abs(settings%second_coefficient) > 0.0_wp) return
            if (run%velocity(1) <= 0.0_wp) then
               crossing = n
               trajectory%status = contact_separated
               if (ghost .and. .not. settings%end_time > 0.0_wp) end_time = 2.0_wp*t
               cycle
            end if
         end if
         if (ends) exit
         if (trajectory%is_stuck(impact)) then
            trajectory%status = contact_sticking
            exit
         end if
      end do

      stable = .true.
      if (.not. complete) return
      ! step (7): the outcome
      if (crossing > 0) call insert_separation(impact, crossing, trajectory)
      if (.not. ghost) trajectory%final = trajectory%last
      call set_shares(dt, trajectory)
      call find_peaks(trajectory)
   end subroutine march

   !> Make room for `room` steps; contents are kept
   subroutine make_room(run, settings, impact, room, trajectory)
      type(paper_run_t), intent(inout) :: run
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> Number of steps
      integer, intent(in) :: room
      type(trajectory_t), intent(inout) :: trajectory

      type(exponential_sum_t) :: terms
      real(wp) :: kernel(0:2*room - 1)
      integer :: i, values
      logical :: two_terms

      ! one node more for the end of the contact
      call trajectory%reserve(room + 1)
      call lengthen(run%w, 1, room)
      two_terms = abs(settings%second_coefficient) > 0.0_wp
      values = room
      if (settings%form == 'a') then
         if (two_terms) values = 2*room
         kernel(:values - 1) = kernel_values(impact, run%dt, values)
         if (two_terms) call run%second%prepare(kernel)
      else
         kernel(:room - 1) = impact%factor &
            *impact%modulus%rate([(run%dt*real(i, wp), i = 0, room - 1)])
      end if
      call run%kernel%set(kernel(:room - 1))
      if (two_terms .and. settings%form == 'b') then
         ! k'' of a finite sum of exponentials; other kernels are refused
         call impact%kernel_exponentials(run%dt*real(room, wp), 0.1_wp, terms)
         do i = 0, 2*room - 1
            kernel(i) = sum(terms%moduli*terms%rates**2*exp(-terms%rates*(run%dt*real(i, wp))))
         end do
         call run%second%prepare(kernel)
      end if
   end subroutine make_room

   !> Step (6), second half: s and s' at node n from s'' at earlier nodes
   pure subroutine advance(run, impact, n)
      type(paper_run_t), intent(inout) :: run
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n

      real(wp) :: velocity
      integer :: p

      velocity = run%velocity(1)
      if (n <= start_steps) then
         call runge_kutta(impact%law, run%first_kernel/impact%mass, &
            run%first_alpha*run%first_kernel, run%dt, run%s, velocity)
      else
         p = min(n, ab_points)
         run%s = run%s + run%dt*sum(adams_bashforth(:, p)*run%velocity(:ab_points))
         velocity = velocity + run%dt*sum(adams_bashforth(:, p)*run%acceleration)
      end if
      run%velocity = [velocity, run%velocity(:kept - 1)]
   end subroutine advance

   !> Step (4): the force at node n, the sums of Eqs. (8) and (10)
   pure subroutine sum_force(run, settings, impact, n)
      type(paper_run_t), intent(inout) :: run
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n

      real(wp) :: past, own, force, u
      logical :: form_a

      form_a = settings%form == 'a'
      u = impact%law%u(run%s)
      run%w(n) = u
      if (form_a) run%w(n) = impact%law%slope(run%s)*run%velocity(1)
      own = run%share*run%w(n)
      past = run%kernel%sum_over(n, 1, n - 1, run%w)
      force = run%dt*(past + run%kernel%newest*own)
      if (.not. form_a) force = run%first_kernel*u + force
      if (abs(settings%second_coefficient) > 0.0_wp) then
         ! form b by parts: k(0) u^2 + 2 u int k'(x) u(t - x) dx + int int k''(x + y) u u
         if (.not. form_a) then
            past = run%second%kernel%sum_over(n, 1, n - 1, run%w)
            force = force + settings%second_coefficient*(2.0_wp*force - run%first_kernel*u)*u
         end if
         force = force + settings%second_coefficient*run%dt**2*(run%second%past(n) &
            + own*(2.0_wp*past + run%second%kernel%newest*own))
         call run%second%accept(n, run%w)
      end if
      run%force = [force, run%force(:first_points - 1)]
   end subroutine sum_force

   !> Steps (5) and (6): U'' by backward differences, and s'' from Eq. (11)
   pure subroutine accelerate(run, impact, n)
      type(paper_run_t), intent(inout) :: run
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n

      real(wp) :: alpha, alpha_rate, acceleration
      integer :: p

      associate (dt => run%dt, share => run%share, force => run%force(1))
         alpha = impact%target%alpha(dt*real(n, wp))
         alpha_rate = impact%target%alpha_rate(dt*real(n, wp), alpha)
         run%damping = alpha*impact%law%slope(run%s)
         run%impulse = run%impulse + dt*(share*force + (1.0_wp - share)*run%force(2))
         if (impact%target%frozen()) then
            p = min(n + 1, first_points)
            acceleration = alpha*sum(first_difference(:, p)*run%force)/dt
            ! U' = int alpha F' dt = alpha F - int alpha' F dt
            run%drift = run%drift + dt*(share*alpha_rate*force + (1.0_wp - share)*run%drift_rate)
            run%drift_rate = alpha_rate*force
            run%plate = run%plate + dt*(1.0_wp - share)*run%plate_velocity
            run%plate_velocity = alpha*force - run%drift
            run%plate = run%plate + dt*share*run%plate_velocity
         else
            run%plate = alpha*run%impulse
            run%plate_velocity = alpha*force + alpha_rate*run%impulse
            run%deflection = [run%plate, run%deflection(:second_points - 1)]
            p = min(max(n + 1, 3), second_points)
            acceleration = sum(second_difference(:, p)*run%deflection)/dt**2
         end if
         run%acceleration = [-force/impact%mass - acceleration, run%acceleration(:ab_points - 1)]
      end associate
   end subroutine accelerate

   !> State at the last node
   pure function state_of(run, impact, t) result(node)
      type(paper_run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      !> Its time [s]
      real(wp), intent(in) :: t
      !> State
      real(wp) :: node(columns)

      node(col_time) = t
      node(col_indentation) = run%s
      node(col_velocity) = run%velocity(1)
      node(col_force) = run%force(1)
      node(col_impulse) = run%impulse
      node(col_sphere) = run%s + run%plate
      node(col_sphere_velocity) = impact%velocity - run%impulse/impact%mass
      node(col_plate) = run%plate
      node(col_plate_velocity) = run%plate_velocity
   end function state_of

   !> Insert the node where F = 0 before node n, the first one with F <= 0, and move the later ones
   !> up
   pure subroutine insert_separation(impact, n, trajectory)
      type(impact_t), intent(in) :: impact
      !> Node; `steps_beyond` more nodes follow
      integer, intent(in) :: n
      !> The trajectory, with room for one more node
      type(trajectory_t), intent(inout) :: trajectory

      real(wp) :: window(columns, 0:points - 1), node(columns), lower, upper, x
      integer :: first, last, i, iteration

      first = max(n - points/2, 0)
      last = min(n + steps_beyond, trajectory%final) - first
      window(:, 0:last) = trajectory%state(:, first:first + last)

      ! the sign changes between nodes n - 1 and n
      lower = real(n - 1 - first, wp)
      upper = lower + 1.0_wp
      do iteration = 1, digits(1.0_wp)
         x = 0.5_wp*(lower + upper)
         if (sum(lagrange(last, x)*window(col_force, 0:last)) > 0.0_wp) then
            lower = x
         else
            upper = x
         end if
      end do

      node = matmul(window(:, 0:last), lagrange(last, upper))
      node(col_force) = 0.0_wp
      if (.not. impact%target%frozen()) then
         node(col_plate) = impact%target%alpha(node(col_time))*node(col_impulse)
         node(col_plate_velocity) = impact%target%alpha_rate(node(col_time))*node(col_impulse)
      end if
      node(col_sphere) = node(col_indentation) + node(col_plate)
      node(col_sphere_velocity) = impact%velocity - node(col_impulse)/impact%mass

      do i = trajectory%final, n, -1
         trajectory%state(:, i + 1) = trajectory%state(:, i)
      end do
      trajectory%state(:, n) = node
      trajectory%final = trajectory%final + 1
      trajectory%last = n
   end subroutine insert_separation

   !> Lagrange polynomials of the points 0, 1 .. n
   pure function lagrange(n, x) result(c)
      !> Last point
      integer, intent(in) :: n
      !> Argument
      real(wp), intent(in) :: x
      !> Polynomials, shape (0:n)
      real(wp) :: c(0:n)

      integer :: i, j

      c = 1.0_wp
      do j = 0, n
         do i = 0, n
            if (i /= j) c(j) = c(j)*(x - real(i, wp))/real(j - i, wp)
         end do
      end do
   end function lagrange

   !> Shares of the nodes in the impulse: the force times the weights of Simpson's rule on the equal
   !> steps, of the 3/8 rule on three of them if their number is odd, and on the shorter last step
   !> of the parabola through the last three nodes
   pure subroutine set_shares(dt, trajectory)
      !> Time step [s]
      real(wp), intent(in) :: dt
      type(trajectory_t), intent(inout) :: trajectory

      real(wp) :: h
      integer :: n, even

      n = trajectory%last
      associate (w => trajectory%share)
         w(0:n) = 0.0_wp
         if (n < 1) return
         h = trajectory%state(col_time, n) - trajectory%state(col_time, n - 1)
         if (n < 3) then
            w(0:n - 1) = dt
            w(0) = 0.5_wp*dt
            if (n == 1) w(0) = 0.0_wp
            if (n == 2) w(1) = 0.5_wp*dt
            w(n - 1:n) = w(n - 1:n) + 0.5_wp*h
            w(0:n) = w(0:n)*trajectory%state(col_force, 0:n)
            return
         end if

         ! Simpson's rule up to node `even`, the 3/8 rule from there to node n - 1
         even = n - 1
         if (mod(even, 2) == 1) even = even - 3
         if (even > 0) then
            w(0:even) = 2.0_wp/3.0_wp*dt
            w(1:even - 1:2) = 4.0_wp/3.0_wp*dt
            w(0) = dt/3.0_wp
            w(even) = dt/3.0_wp
         end if
         if (even < n - 1) &
            w(even:n - 1) = w(even:n - 1) + dt*[3.0_wp, 9.0_wp, 9.0_wp, 3.0_wp]/8.0_wp
         call add_last_step(dt, h, w(n - 2:n))
         w(0:n) = w(0:n)*trajectory%state(col_force, 0:n)
      end associate
   end subroutine set_shares

   !> Add the weights of the last step, from the parabola through the last three nodes
   pure subroutine add_last_step(dt, last, weight)
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Length of the last step [s]
      real(wp), intent(in) :: last
      !> Weights of the last three nodes [s]
      real(wp), intent(inout) :: weight(3)

      weight(1) = weight(1) - last**3/(6.0_wp*dt*(dt + last))
      weight(2) = weight(2) + last*(last + 3.0_wp*dt)/(6.0_wp*dt)
      weight(3) = weight(3) + last*(2.0_wp*last + 3.0_wp*dt)/(6.0_wp*(dt + last))
   end subroutine add_last_step

end module vcor_solver_paper_march
