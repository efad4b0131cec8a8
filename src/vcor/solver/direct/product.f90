!> Product integration of the twice-integrated equation of motion, for every kernel
!>
!> The steps are equal. On each step u is the parabola through both ends of the step and the node
!> before it, and the kernel is integrated exactly. With du_j = u_j - u_{j-1} and, on step j,
!> u' dt = du_j + (theta - 1/2) (du_j - du_{j-1}), the force of Eqs. (5) and (8) is the sum
!>
!>     F_n = sum_{j=1..n} W_{n-j} du_j,   W_i = w_i + v_i - v_{i-1},
!>     w_i = int_0^1 k((i + 1 - theta) dt) dtheta,
!>     v_i = int_0^1 k((i + 1 - theta) dt) (theta - 1/2) dtheta
!>
!> with finite weights even if k(0) is infinite. The impulse and its integral follow by the
!> Adams-Moulton rule of third order, or by the trapezoidal rule if the plate or a dashpot makes a
!> step stiff, so that the method is stable for any step; a dashpot's impulse is exactly
!> viscosity*u. Each step solves one equation s + c u + d u^2 = r, with d = 0 without the second
!> term of the Volterra series. The start u ~ t^n limits the order: the error falls as dt^(n+1),
!> which is dt^2.5 for a sphere. N steps take N^2/2 multiply-adds on contiguous arrays.
module vcor_solver_direct_product
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, columns, &
      contact_resting, contact_separated, refuse_growth, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_solver_convolution, only : lengthen, second_term_t
   use vcor_solver_direct_contacts, only : solve_contacts
   use vcor_solver_direct_evaluation, only : end_of_contact, end_of_receding_contact, find_peaks, &
      parabola, set_shares
   use vcor_solver_direct_motion, only : node_motion_t
   use vcor_solver_direct_receding, only : receding_t
   use vcor_solver_direct_weights, only : contact_kernel_t, square_weights
   use vcor_solver_type, only : default_accuracy, solver_settings_t, solver_t
   use vcor_tuning, only : direct_first_steps, direct_force, direct_most_work
   implicit none
   private

   public :: product_t, new_product

   !> Product integration
   type, extends(solver_t) :: product_t
   contains
      procedure :: solve
   end type product_t

   !> State of a run with a given time step at the newest node
   type :: product_run_t
      !> Kernel of the contact
      type(contact_kernel_t) :: kernel
      !> Differences of u from node to node [m^1.5]
      real(wp), allocatable :: du(:)
      !> Coefficient c2 of the second term of the Volterra series [m^-1.5], 0 without it
      real(wp) :: second_coefficient = 0.0_wp
      !> The second term; its kernel includes the factor c2
      type(second_term_t) :: second
      !> State of the contact under the receding law
      type(receding_t) :: receding
      !> Viscosity of the kernel's dashpot [N s/m^1.5]
      real(wp) :: viscosity = 0.0_wp
      !> Impulse of the dashpot [N s]; constant once a receding contact shrinks
      real(wp) :: dashpot = 0.0_wp
      !> Motion at the node as a function of the force there
      type(node_motion_t) :: motion
      !> Indentation [m]
      real(wp) :: s = 0.0_wp
      !> u(s) [m^1.5]
      real(wp) :: u = 0.0_wp
      !> du/ds [m^0.5]
      real(wp) :: slope = 0.0_wp
      !> s' [m/s]
      real(wp) :: speed = 0.0_wp
      !> Force without that of the dashpot [N]
      real(wp) :: force = 0.0_wp
   end type product_run_t

contains

   !> Build the solver
   pure subroutine new_product(self, settings)
      type(product_t), intent(out) :: self
      !> Time step, end time, accuracy and second term. Without a time step the step is halved until
      !> the accuracy is reached; with one, the error is only compared with the accuracy
      type(solver_settings_t), intent(in) :: settings

      self%settings = settings
      if (.not. max(settings%accuracy, settings%time_step) > 0.0_wp) &
         self%settings%accuracy = default_accuracy('direct')
   end subroutine new_product

   !> Compute the course of an impact, with the error estimated from runs with longer steps
   subroutine solve(self, impact, trajectory, error)
      class(product_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      ! steps by which the contact may be longer with half of the step
      integer, parameter :: spare = 8
      real(wp) :: dt, span, work, cor(3), cor_sphere(3), contact_time(3), depth(3), force(3)
      type(richardson_t) :: found
      integer :: level, room
      logical :: crude

      if (impact%target%structure%exists() .or. self%settings%bounces > 1) then
         call solve_contacts(self%settings, impact, trajectory, error)
         return
      end if
      associate (time_step => self%settings%time_step, end_time => self%settings%end_time, &
                 accuracy => self%settings%accuracy)
         if (time_step > 0.0_wp) then
            dt = 4.0_wp*time_step
         else
            dt = impact%law%contact_time/real(direct_first_steps, wp)*impact%time_scale()
            ! make the end time a whole number of steps
            if (end_time > 0.0_wp) &
               dt = end_time/real(ceiling(min(end_time/dt, real(most_steps(.false.), wp))), wp)
         end if

         level = 0
         ! the newest of three runs moves the others on, of which the first ones are none
         cor = 0.0_wp
         cor_sphere = 0.0_wp
         contact_time = 0.0_wp
         depth = 0.0_wp
         force = 0.0_wp
         span = 5.0_wp*impact%time_scale()
         if (end_time > 0.0_wp) span = min(span, end_time)
         room = nint(span/dt)
         do
            level = level + 1
            call march(self%settings, impact, dt, room, trajectory, crude, work, error)
            if (allocated(error)) return
            if (crude .and. .not. time_step > 0.0_wp) then
               dt = 0.5_wp*dt
               room = 2*room
               level = 0
               cycle
            end if
            ! coarse steps can miss the separation: only the given step can show that there is none
            if (trajectory%status /= contact_separated .and. (level == 3 .or. &
                .not. (time_step > 0.0_wp .or. trajectory%status == contact_resting &
                .and. 2*trajectory%steps <= most_steps(trajectory%regrows)))) return
            associate (final => trajectory%state(:, trajectory%last))
               cor = [cor(2:3), -final(col_velocity)/impact%velocity]
               cor_sphere = [cor_sphere(2:3), -final(col_sphere_velocity)/impact%velocity]
               contact_time = [contact_time(2:3), final(col_time)]
            end associate
            depth = [depth(2:3), trajectory%max_indentation]
            force = [force(2:3), trajectory%max_force]
            if (level >= 3) then
               trajectory%accuracy = accuracy
               found = richardson(cor)
               trajectory%cor_error = found%error
               found = richardson(cor_sphere)
               trajectory%cor_sphere_error = found%error
               found = richardson(contact_time)
               trajectory%contact_time_error = found%error
               ! cor has the errors of cor_sphere and of the plate, which cancel only by chance
               trajectory%cor_error = max(trajectory%cor_error, trajectory%cor_sphere_error)
               ! if the contact is small when it grows again, few springs resolve it, and the three
               ! runs may not yet show the order
               if (trajectory%regrows) then
                  trajectory%cor_error = max(trajectory%cor_error, abs(cor(3) - cor(2)))
                  trajectory%cor_sphere_error = max(trajectory%cor_sphere_error, &
                     abs(cor_sphere(3) - cor_sphere(2)))
               end if
               found = richardson(force)
               trajectory%max_force_error = found%error
               if (time_step > 0.0_wp) return
               if (max(trajectory%cor_error, trajectory%cor_sphere_error) <= accuracy &
                   .and. found%error <= direct_force*accuracy*force(3)) then
                  ! the maxima may be less accurate than cor: extrapolate them
                  trajectory%max_force = found%limit
                  found = richardson(depth)
                  trajectory%max_indentation = found%limit
                  return
               end if
               if (2*trajectory%steps > most_steps(trajectory%regrows) &
                   .or. 8.0_wp*work > direct_most_work) then
                  if (trajectory%misses_by_far()) call raise(error, error_numerical, 'the ' &
                     //'accuracy asked for is out of reach of product integration: give a ' &
                     //'larger solver.accuracy')
                  return
               end if
            end if
            dt = 0.5_wp*dt
            room = 2*trajectory%final + spare
         end do
      end associate
   end subroutine solve

   !> Largest number of steps n of a run, whose sums take n^2/2 multiplications; half as many if the
   !> contact has grown again, as it seldom ends soon then
   pure integer function most_steps(regrows)
      !> Whether the contact has grown again
      logical, intent(in) :: regrows

      most_steps = int(sqrt(2.0_wp*direct_most_work))
      if (regrows) most_steps = most_steps/2
   end function most_steps

   !> Compute one run with a given time step
   subroutine march(settings, impact, dt, expected, trajectory, crude, work, error)
      !> End time, second term, and whether to continue after the separation
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Expected number of steps, for memory; more are possible
      integer, intent(in) :: expected
      type(trajectory_t), intent(out) :: trajectory
      !> Whether the step is too long for the growth of the plate's alpha
      logical, intent(out) :: crude
      !> Number of multiplications for springs, which grows with the cube of the number of steps
      real(wp), intent(out) :: work
      type(error_t), allocatable, intent(out) :: error

      type(product_run_t) :: run
      real(wp) :: end_time, node(columns), alpha, theta
      integer :: n, room, most
      logical :: ends, stopped

      end_time = settings%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%lasting_time(impact%time_scale())
      room = min(max(16, expected), most_steps(.false.)) + 1
      run%second_coefficient = settings%second_coefficient
      run%viscosity = impact%kernel_viscosity()
      run%speed = impact%velocity
      run%motion%alpha = impact%target%alpha(0.0_wp)
      call make_room(run, impact, dt, room, trajectory)
      node = 0.0_wp
      node(col_sphere_velocity) = impact%velocity
      node(col_force) = impact%first_force()
      node(col_plate_velocity) = impact%target%alpha(0.0_wp)*impact%first_force()
      node(col_velocity) = impact%velocity - node(col_plate_velocity)
      call trajectory%begin(node)
      crude = .false.
      work = 0.0_wp
      n = 0
      do
         n = n + 1
         most = most_steps(trajectory%regrows .and. .not. settings%time_step > 0.0_wp)
         if (n > most) then
            if (trajectory%status /= contact_separated) call give_up(trajectory%regrows, error)
            exit
         end if
         alpha = run%motion%alpha
         if (n >= room) then
            room = 2*room
            call make_room(run, impact, dt, room, trajectory)
         end if
         call take_step(run, impact, n)
         work = run%receding%springs%work
         if (work > direct_most_work) then
            call give_up(.true., error)
            return
         end if
         crude = crude .or. &
            impact%may_part_unnoticed(alpha, run%motion%alpha, run%motion%impulse, run%motion%t)
         if (crude .and. .not. settings%time_step > 0.0_wp) return
         if (run%receding%regrows) then
            ! the weight may make it grow again: stop if the remaining energy cannot separate it
            call trajectory%stop_at_rest(impact, .true., stopped)
            if (stopped) exit
            if (run%receding%regrown) trajectory%regrows = .true.
            if (.not. run%receding%regrown) then
               call refuse_growth(impact, error)
               return
            end if
         end if
         ! the velocity of the sphere is lost in the rounding error of s'
         if (.not. abs(run%speed)*epsilon(1.0_wp) < impact%free_velocity(run%motion%t)) then
            call raise(error, error_numerical, 'fixed steps do not follow this plate: its motion ' &
               //'grows without bound')
            return
         end if
         node = state_of(run, impact)
         call trajectory%add(node)
         if (trajectory%status == contact_separated) then
            if (node(col_time) + dt > end_time*(1.0_wp + 1.0e-9_wp)) exit
            cycle
         end if

         trajectory%last = n
         trajectory%steps = n
         ! while the indentation grows the force is positive; a negative one is a rounding error
         ends = node(col_force) <= 0.0_wp .and. run%speed < 0.0_wp
         theta = 1.0_wp
         if (.not. ends .and. impact%gravity > 0.0_wp .and. n > 2) &
            call find_dip(trajectory%state(col_force, n - 2:n), theta, ends)
         if (run%receding%shrinks) then
            ends = run%receding%t1(3) <= 0.0_wp
            if (ends) trajectory%state(:, n) = end_of_receding_contact(impact, &
               run%receding%last_condition(run%kernel, run%viscosity, n, &
               trajectory%state(col_velocity, n - 2:n)), trajectory, n)
         else if (ends) then
            trajectory%state(:, n) = end_of_contact(impact, run%kernel%newest, &
               trajectory, n, theta)
         end if
         call trajectory%stop_at_rest(impact, n == most &
            .or. node(col_time) + dt > end_time*(1.0_wp + 1.0e-9_wp), stopped)
         if (stopped) then
            exit
         else if (ends) then
            trajectory%status = contact_separated
            if (.not. settings%ghost) exit
            call trajectory%add(node)
            if (.not. settings%end_time > 0.0_wp) end_time = 2.0_wp*node(col_time)
         else if (node(col_time) + dt > end_time*(1.0_wp + 1.0e-9_wp)) then
            exit
         end if
      end do
      call set_shares(dt, trajectory)
      call find_peaks(trajectory)
   end subroutine march

   !> Find out whether a force vanishes for a moment in the newest step, by a parabola, as that of a
   !> sphere may that leaves a contact under its weight only just
   pure subroutine find_dip(force, theta, dips)
      !> Force at the last three nodes [N], > 0
      real(wp), intent(in) :: force(-1:1)
      !> Position of the least force in the step, 0 .. 1; unchanged if it does not vanish
      real(wp), intent(inout) :: theta
      logical, intent(out) :: dips

      real(wp) :: bend, x

      dips = .false.
      bend = force(1) - 2.0_wp*force(0) + force(-1)
      if (.not. bend > 0.0_wp) return
      x = 0.5_wp*(force(-1) - force(1))/bend
      dips = x > 0.0_wp .and. x < 1.0_wp .and. parabola(force, x) < 0.0_wp
      if (dips) theta = x
   end subroutine find_dip

   !> Raise the error that a contact lasts too long
   subroutine give_up(regrows, error)
      !> Whether the contact has grown again
      logical, intent(in) :: regrows
      type(error_t), allocatable, intent(out) :: error

      if (regrows) then
         call raise(error, error_numerical, 'the contact grows again before it has ended, as on ' &
            //'a plate that is too light for the sphere, and lasts for more steps than product ' &
            //"integration can make then: use law = 'boltzmann'")
      else
         call raise(error, error_numerical, 'the end of this contact takes more steps than ' &
            //'product integration can make')
      end if
   end subroutine give_up

   !> Make room for `room` steps; contents are kept
   subroutine make_room(run, impact, dt, room, trajectory)
      type(product_run_t), intent(inout) :: run
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Number of steps
      integer, intent(in) :: room
      type(trajectory_t), intent(inout) :: trajectory

      ! with ghost lines the end of contact is an additional node
      call trajectory%reserve(room + 1)
      call run%kernel%prepare(impact, dt, room)
      call lengthen(run%du, 1, room)
      call run%motion%prepare(impact, dt, room)
      if (impact%law%receding) call run%receding%prepare(room)
      if (abs(run%second_coefficient) > 0.0_wp) call run%second%prepare(run%second_coefficient &
         *square_weights(impact, dt, 2*room))
   end subroutine make_room

   !> Advance to node n: compute the motion and the force there
   subroutine take_step(run, impact, n)
      type(product_run_t), intent(inout) :: run
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n

      real(wp) :: last_s, last_speed

      call run%motion%advance(impact, n, run%slope*run%kernel%newest, run%slope*run%viscosity)
      last_s = run%s
      last_speed = max(0.0_wp, run%speed)
      if (run%receding%shrinks) then
         call step_with_a_part(run, impact, n, run%dashpot)
      else
         call step_with_all_the_past(run, impact, n)
         ! if the motion turns in the first step, the step is too long, and the next run halves it.
         ! A dashpot's impulse remains that at the largest indentation, in this step if s' was
         ! positive at its start, otherwise earlier (near rest)
         if (impact%law%receding .and. run%speed < 0.0_wp .and. n > 1) &
            call step_with_a_part(run, impact, n, run%viscosity*impact%law%u(last_s &
            + 0.5_wp*run%kernel%dt*last_speed**2/(last_speed - run%speed)))
      end if
      call run%motion%accept(n, run%force, run%dashpot)
      if (impact%law%receding) call run%receding%accept(n, run%s)
   end subroutine take_step

   !> Solve node n with a force that is the sum over the whole past: the equation of motion with
   !> F = known + linear*u + quadratic*u^2 and the dashpot's viscosity*u' is s + c u + d u^2 = r
   subroutine step_with_all_the_past(run, impact, n)
      type(product_run_t), intent(inout) :: run
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n

      real(wp) :: known, linear, quadratic, single, own, last_u
      logical :: two_terms

      call run%motion%respond(impact, n, 0.0_wp)
      last_u = run%u
      linear = run%kernel%newest
      known = run%kernel%sum_over(n, 1, n - 1, run%du) - linear*last_u
      quadratic = 0.0_wp
      two_terms = abs(run%second_coefficient) > 0.0_wp
      if (two_terms) then
         ! the second term as a polynomial in u_n, by du_n = u_n - u_{n-1}
         single = run%second%kernel%sum_over(n, 1, n - 1, run%du)
         own = run%second%kernel%newest
         known = known + run%second%past(n) - 2.0_wp*single*last_u + own*last_u**2
         linear = linear + 2.0_wp*(single - own*last_u)
         quadratic = own
      end if
      associate (s_0 => run%motion%indentation(1), per_force => run%motion%indentation(2), &
                 v_0 => run%motion%velocity(1), slowing => run%motion%velocity(2), &
                 weight => run%motion%weight, alpha => run%motion%alpha)
         call impact%law%solve(per_force*(linear + run%viscosity/weight), per_force*quadratic, &
            s_0 - per_force*known, run%s + run%kernel%dt*run%speed, run%s)
         run%u = impact%law%u(run%s)
         run%slope = impact%law%slope(run%s)
         run%du(n) = run%u - last_u
         if (two_terms) call run%second%accept(n, run%du)
         run%force = known + (linear + quadratic*run%u)*run%u
         run%dashpot = run%viscosity*run%u
         ! U' contains alpha F, and F the dashpot's force, which is proportional to s'
         run%speed = (v_0 - slowing*run%force - (slowing - alpha)/weight*run%dashpot) &
            /(1.0_wp + alpha*run%viscosity*run%slope)
      end associate
   end subroutine step_with_all_the_past

   !> Solve node n with the force of a shrinking contact, from the past up to t1 or from springs.
   !> If the contact still grows, the solution is left as it is
   subroutine step_with_a_part(run, impact, n, dashpot)
      type(product_run_t), intent(inout) :: run
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n
      !> Impulse of the dashpot [N s]
      real(wp), intent(in) :: dashpot

      call run%motion%respond(impact, n, dashpot)
      associate (indentation => run%motion%indentation, velocity => run%motion%velocity)
         call run%receding%find_force(impact, run%kernel, n, run%du, indentation, velocity)
         if (.not. run%receding%shrinks) return
         run%dashpot = dashpot
         run%force = run%receding%force
         run%s = indentation(1) - indentation(2)*run%force
         run%slope = impact%law%slope(run%s)
         run%speed = velocity(1) - velocity(2)*run%force
      end associate
   end subroutine step_with_a_part

   !> Force of the dashpot at the node, 0 once a receding contact shrinks
   pure function drag(run)
      type(product_run_t), intent(in) :: run
      !> Force [N]
      real(wp) :: drag

      drag = 0.0_wp
      if (.not. run%receding%shrinks) drag = run%viscosity*run%slope*run%speed
   end function drag

   !> State at the node
   pure function state_of(run, impact) result(node)
      type(product_run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      !> State
      real(wp) :: node(columns)

      node(col_time) = run%motion%t
      node(col_indentation) = run%s
      node(col_velocity) = run%speed
      node(col_force) = run%force + drag(run)
      node(col_impulse) = run%motion%impulse
      node(col_sphere) = impact%free_path(run%motion%t) - run%motion%second_impulse/impact%mass
      node(col_sphere_velocity) = impact%free_velocity(run%motion%t) &
         - run%motion%impulse/impact%mass
      node(col_plate) = node(col_sphere) - run%s
      node(col_plate_velocity) = node(col_sphere_velocity) - run%speed
   end function state_of

end module vcor_solver_direct_product
