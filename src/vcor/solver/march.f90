!> One run of the paper's time marching, Section V of Green's paper
!>
!> On equal steps, with w the rate u' = (3/2) sqrt(s) s' and h the kernel k in form a of Eq. (8), or
!> w = u = s^1.5 and h = k' in form b,
!>
!>     H_n = dt sum_{j=1..n} w_j h_{n-j},   F_n = H_n  or  F_n = k(0) u_n + H_n
!>     I_n = I_{n-1} + dt F_n,   U_n = alpha_n I_n,   s''_n = -F_n/m - U''_n
!>
!> or, for a frozen plate, U''_n = alpha_n F'_n. The last term of the sums is halved by the
!> trapezoidal rule, and I_n follows it too; the first one is zero. U'' is the backward difference
!> of fifth order, of lower order while fewer points exist, the plate being at rest before contact.
!> s and s' go forward by Adams and Bashforth's formula of fifth order, of fourth order once, after
!> three steps by Runge and Kutta with the kernel and alpha held at their first values. An infinite
!> k(0) is replaced by k(dt); a finite one, however steep the kernel, is taken as it is.
module vcor_solver_march
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, &
      contact_separated, contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_dot, only : dot
   use vcor_solver_multistep, only : ab_points, adams_bashforth, first_difference, first_points, &
      runge_kutta, second_difference, second_points, start_steps
   use vcor_solver_separation, only : insert_separation, set_simpson_weights, steps_beyond
   use vcor_solver_series, only : find_series_peaks
   use vcor_solver_stability, only : damping_limit, kernel_terms
   use vcor_solver_volterra, only : volterra_t
   implicit none
   private

   public :: scheme_t, march, capped, stable_damping

   !> A run of more steps is given up: its history sums take seconds
   integer, parameter :: most_steps = 60000

   !> Scheme but for its step
   type :: scheme_t
      !> Form of Eq. (8): a or b
      character(len=1) :: form = 'a'
      !> Share of the newest value in the sums: 1 in rectangles, 1/2 in trapezoids
      real(wp) :: share = 1.0_wp
      !> Coefficient c2 of the second term of the Volterra series [m^-1.5], 0 without it
      real(wp) :: second_coefficient = 0.0_wp
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp) :: end_time = 0.0_wp
   end type scheme_t

contains

   !> Whether k(0) is infinite and replaced
   pure function capped(impact)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Whether it is
      logical :: capped

      capped = impact%modulus%glassy() > huge(1.0_wp)
   end function capped

   !> The kernel k_j at t = j dt, k(0) capped if it is infinite
   pure function kernel_values(impact, dt, n) result(kernel)
      !> The impact
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

   !> Largest d = (3/2) alpha sqrt(s) for which the scheme is stable
   pure function stable_damping(scheme, impact, dt) result(limit)
      !> Scheme
      type(scheme_t), intent(in) :: scheme
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Limit [m^1.5/(N s)]
      real(wp) :: limit

      limit = damping_limit(dt, kernel_values(impact, dt, kernel_terms + 1), scheme%form, &
         scheme%share, impact%plate%frozen())
   end function stable_damping

   !> One run with a given step
   subroutine march(scheme, impact, dt, ghost, trajectory, stable, complete)
      !> Scheme
      type(scheme_t), intent(in) :: scheme
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Go on after the separation
      logical, intent(in) :: ghost
      !> Its course
      type(trajectory_t), intent(out) :: trajectory
      !> Whether no oscillation from step to step grew
      logical, intent(out) :: stable
      !> Whether it did not run out of steps
      logical, intent(out) :: complete

      ! sixth difference of the velocity, 1 for what changes its sign from step to step
      real(wp), parameter :: alternating(0:6) = &
         [1.0_wp, -6.0_wp, 15.0_wp, -20.0_wp, 15.0_wp, -6.0_wp, 1.0_wp]/64.0_wp
      ! such oscillations are seen by then, when they are below most digits of the outcome
      real(wp), parameter :: noticeable = 1.0e-5_wp
      ! beyond these factors of the first velocity no solution goes
      real(wp), parameter :: fastest = 1.2_wp, fastest_ghost = 20.0_wp
      ! weights(room - i) = h_i: reversed, so that the history sum runs forward through both arrays
      real(wp), allocatable :: weights(:), w(:)
      type(volterra_t) :: second
      ! newest first; velocities enough for the sixth difference
      real(wp) :: velocities(0:6), accelerations(ab_points)
      real(wp) :: deflections(second_points), forces(first_points)
      real(wp) :: t, s, velocity, root, history, share, own, alpha, alpha_rate, first_kernel
      real(wp) :: first_alpha, acceleration, force, old_force, impulse, drift, plate, limit
      real(wp) :: drift_rate, plate_velocity, end_time
      integer :: n, room, crossing, p
      logical :: form_a, frozen, two_terms, beyond_limit

      form_a = scheme%form == 'a'
      frozen = impact%plate%frozen()
      two_terms = abs(scheme%second_coefficient) > 0.0_wp
      share = scheme%share
      stable = .false.
      complete = .true.
      end_time = scheme%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%patience(impact%time_scale())
      room = max(kernel_terms, nint(min(min(end_time, 5.0_wp*impact%time_scale())/dt, &
         real(most_steps, wp)))) + steps_beyond + 2
      call make_room()

      if (capped(impact)) then
         first_kernel = impact%kernel(dt)
         first_alpha = impact%plate%alpha(dt)
      else
         first_kernel = impact%kernel(0.0_wp)
         first_alpha = impact%plate%alpha(0.0_wp)
      end if
      limit = stable_damping(scheme, impact, dt)
      beyond_limit = .false.

      trajectory%state(:, 0) = 0.0_wp
      trajectory%state(col_velocity, 0) = impact%velocity
      trajectory%state(col_sphere_velocity, 0) = impact%velocity
      s = 0.0_wp
      velocity = impact%velocity
      velocities = 0.0_wp
      velocities(0) = velocity
      accelerations = 0.0_wp
      deflections = 0.0_wp
      forces = 0.0_wp
      force = 0.0_wp
      impulse = 0.0_wp
      drift = 0.0_wp
      drift_rate = 0.0_wp
      plate = 0.0_wp
      plate_velocity = 0.0_wp
      crossing = 0
      n = 0
      do
         n = n + 1
         if (n > most_steps) then
            complete = .false.
            exit
         end if
         if (n >= room) then
            room = 2*room
            call make_room()
         end if
         t = dt*real(n, wp)

         if (n <= start_steps) then
            call runge_kutta(first_kernel/impact%mass, first_alpha*first_kernel, dt, s, velocity)
         else
            p = min(n, ab_points)
            s = s + dt*sum(adams_bashforth(:, p)*velocities(0:ab_points - 1))
            velocity = velocity + dt*sum(adams_bashforth(:, p)*accelerations)
         end if
         if (.not. abs(velocity) <= merge(fastest, fastest_ghost, crossing == 0) &
             *impact%velocity) return
         velocities(1:) = velocities(:5)
         velocities(0) = velocity

         root = sqrt(abs(s))
         old_force = force
         w(n) = merge(1.5_wp*velocity, s, form_a)*root
         own = share*w(n)
         history = dot(weights(room - n + 1:room - 1), w(1:n - 1))
         force = dt*(history + weights(room)*own)
         if (.not. form_a) force = first_kernel*w(n) + force
         if (two_terms) then
            if (form_a) then
               force = force + scheme%second_coefficient*dt**2 &
                  *second%double_sum(n, w, share, history)
            else
               ! by parts: k(0) u^2 + 2 u int k'(x) u(t - x) dx + int int k''(x + y) u u
               force = force + scheme%second_coefficient*((2.0_wp*force - first_kernel*w(n))*w(n) &
                  + dt**2*second%double_sum(n, w, share))
            end if
            call second%accept(n, w)
         end if

         alpha = impact%plate%alpha(t)
         alpha_rate = impact%plate%alpha_rate(t)
         impulse = impulse + dt*(share*force + (1.0_wp - share)*old_force)
         if (frozen) then
            forces(2:) = forces(:first_points - 1)
            forces(1) = force
            p = min(n + 1, first_points)
            acceleration = alpha*sum(first_difference(:, p)*forces)/dt
            ! U' = int alpha F' dt = alpha F - int alpha' F dt
            drift = drift + dt*(share*alpha_rate*force + (1.0_wp - share)*drift_rate)
            drift_rate = alpha_rate*force
            plate = plate + dt*(1.0_wp - share)*plate_velocity
            plate_velocity = alpha*force - drift
            plate = plate + dt*share*plate_velocity
         else
            plate = alpha*impulse
            plate_velocity = alpha*force + alpha_rate*impulse
            deflections(2:) = deflections(:second_points - 1)
            deflections(1) = plate
            p = min(max(n + 1, 3), second_points)
            acceleration = sum(second_difference(:, p)*deflections)/dt**2
         end if
         accelerations(2:) = accelerations(:ab_points - 1)
         accelerations(1) = -force/impact%mass - acceleration

         ! an oscillation from step to step that the damper should have stopped
         beyond_limit = beyond_limit .or. 1.5_wp*alpha*root > limit
         if (.not. ieee_is_finite(accelerations(1))) return
         if (beyond_limit .and. n > second_points) then
            if (abs(sum(alternating*velocities)) > noticeable*impact%velocity) return
         end if

         trajectory%final = n
         associate (node => trajectory%state(:, n))
            node(col_time) = t
            node(col_indentation) = s
            node(col_velocity) = velocity
            node(col_force) = force
            node(col_impulse) = impulse
            node(col_sphere) = s + plate
            node(col_sphere_velocity) = impact%velocity - impulse/impact%mass
            node(col_plate) = plate
            node(col_plate_velocity) = plate_velocity
         end associate
         if (crossing > 0) then
            if (n < crossing + steps_beyond) cycle
            if (.not. ghost .or. t + dt > end_time*(1.0_wp + 1.0e-9_wp)) exit
            cycle
         end if

         trajectory%last = n
         trajectory%steps = n
         if (force <= 0.0_wp) then
            ! while the indentation grows the force presses
            if (force < 0.0_wp .and. velocity > 0.0_wp .and. .not. two_terms &
                .and. n > second_points) return
            if (velocity <= 0.0_wp) then
               crossing = n
               trajectory%status = contact_separated
               if (ghost .and. .not. scheme%end_time > 0.0_wp) end_time = 2.0_wp*t
               cycle
            end if
         end if
         if (t + dt > end_time*(1.0_wp + 1.0e-9_wp)) exit
         if (trajectory%is_stuck(impact)) then
            trajectory%status = contact_sticking
            exit
         end if
      end do

      stable = .true.
      if (.not. complete) return
      if (crossing > 0) call insert_separation(impact, crossing, trajectory)
      if (.not. ghost) trajectory%final = trajectory%last
      call set_simpson_weights(dt, trajectory)
      call find_series_peaks(trajectory)

   contains

      !> Make room for `room` steps, what is there stays
      subroutine make_room()
         type(exponential_sum_t) :: terms
         real(wp), allocatable :: longer(:), kernel(:), bend(:)
         integer :: i, values

         ! one node more for the end of contact
         call trajectory%reserve(room + 1)
         allocate (longer(room))
         if (allocated(w)) longer(:size(w)) = w
         call move_alloc(longer, w)

         values = room
         if (two_terms .and. form_a) values = 2*room
         allocate (kernel(0:values - 1), longer(room))
         if (form_a) then
            kernel = kernel_values(impact, dt, values)
            if (two_terms) call second%prepare(kernel)
         else
            kernel = impact%hertz_factor*impact%modulus%rate([(dt*real(i, wp), i = 0, values - 1)])
            if (two_terms) then
               ! a finite sum, whatever the accuracy: others are refused
               call impact%kernel_exponentials(dt*real(room, wp), 1.0_wp, terms)
               allocate (bend(0:2*room - 1))
               do i = 0, 2*room - 1
                  bend(i) = sum(terms%moduli*terms%rates**2*exp(-terms%rates*(dt*real(i, wp))))
               end do
               call second%prepare(bend)
            end if
         end if
         longer(room:1:-1) = kernel(0:room - 1)
         call move_alloc(longer, weights)
      end subroutine make_room
   end subroutine march

end module vcor_solver_march
