!> Impacts on a structure by product integration, through contact, flight and further contacts
!>
!> A structure comes back: after the first separation it may strike the sphere again, and the first
!> separation then means nothing. The steps are equal. The force is a parabola over each step;
!> sphere and modes follow it exactly (`vcor_solver_direct_modes`), and the springs of the contact
!> keep the dent (`vcor_solver_direct_row`), so that contact, flight and the next contact are one
!> formula. In each step s = s_0 - c F and F = stiffness*value(s), which rises with s, have one
!> solution. Where a contact begins or ends within a step the force is not smooth, ~ tau^n, and the
!> error falls as dt^(n+1), or as dt^2 for materials that relax. N steps take N times the modes and
!> springs.
!>
!> The sphere has left where the structure cannot reach it any more (`vcor_impact_structure`). What
!> touches before that counts, also under gravity.
!>
!> A contact that is just made or just missed is not known better than the velocity of the impact.
!> Impacts with velocities next to it show what it changes: the results depend smoothly on the
!> velocity, to first order along a line, but where the number of contacts changes.
module vcor_solver_direct_contacts
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_structure, only : state_of_modes_t, vibration_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, columns, &
      contact_lasting, contact_resting, contact_separated, contact_unknown, trajectory_t
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_solver_direct_evaluation, only : fall_of, parabola
   use vcor_solver_direct_modes, only : modes_t
   use vcor_solver_direct_row, only : row_t
   use vcor_solver_ringing, only : ringing_t
   use vcor_solver_type, only : solver_settings_t
   use vcor_tuning, only : direct_first_steps, direct_most_work, sum_share, sum_window
   implicit none
   private

   public :: solve_contacts, comes_back

   !> Most contacts of an impact
   integer, parameter :: most_contacts = 1000
   !> Most nodes that are stored; beyond it every second one is left out
   integer, parameter :: most_nodes = 16384
   !> Steps of flight after which the reach is computed anew: the dampings make it smaller
   integer, parameter :: reach_steps = 64
   !> Relative distance of the velocities next to that of the impact
   real(wp), parameter :: next_to = 1.0e-6_wp
   !> Multiplications in the time that a step takes besides those for modes and springs
   real(wp), parameter :: work_of_step = 300.0_wp
   !> Weights of the newest node, the one before and that before it, for integrals over a step
   real(wp), parameter :: rule(3) = [5.0_wp, 8.0_wp, -1.0_wp]/12.0_wp

   !> A run with a given time step, at its newest node
   type :: run_t
      !> Time step, time at which the run begins [s], and number of steps
      real(wp) :: dt = 0.0_wp, start = 0.0_wp
      integer :: steps = 0
      !> Modes of the structure and springs of the contact
      type(modes_t) :: modes
      type(row_t) :: row
      !> Whether no mode is a rigid motion, nor a part a flow
      logical :: is_held = .false.
      !> Flexibility that follows at once [m/N]
      real(wp) :: residual = 0.0_wp
      !> Time [s], indentation [m], impulse [N s] and its integral [N s2]
      real(wp) :: t = 0.0_wp, s = 0.0_wp, impulse = 0.0_wp, second_impulse = 0.0_wp
      !> What the last two are short of their sums, by rounding
      real(wp) :: rest(2) = 0.0_wp
      !> Force at the newest node and at the two before [N]; 0 before one that is 0
      real(wp) :: force(3) = 0.0_wp
      !> s less the surface of the dent, at the newest node and the two before [m]
      real(wp) :: depth(3) = 0.0_wp
      !> Force times the velocity of the contact and of the structure, at the same nodes [W], and
      !> the integrals of both [J]
      real(wp) :: power(2, 3) = 0.0_wp, work(2) = 0.0_wp
      !> Last three indentations [m]
      real(wp) :: last_s(3) = 0.0_wp
      !> Multiplications so far
      real(wp) :: effort = 0.0_wp
   contains
      procedure :: begin
      procedure :: take_step
      procedure :: node
      procedure :: sphere_velocity
      procedure :: sphere
   end type run_t

contains

   !> Compute the course of an impact on a structure: the step is halved until the results of three
   !> runs agree
   subroutine solve_contacts(settings, impact, trajectory, error)
      !> Accuracy, time step, end time
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      ! share of the accuracy at which the steps are short enough: the other results err by up to
      ! five times as much as cor_sphere
      real(wp), parameter :: share = 0.2_wp
      type(vibration_t) :: vibration
      type(exponential_sum_t) :: terms
      type(trajectory_t) :: near
      type(impact_t) :: other
      real(wp) :: dt, shortest, window, effort, value(3, 6), beside(2, 4), thousandth
      logical :: given, exact, short_enough
      integer :: level, side

      given = settings%time_step > 0.0_wp
      dt = impact%law%contact_time/real(direct_first_steps, wp)*impact%time_scale()
      shortest = dt/64.0_wp
      if (given) dt = 4.0_wp*settings%time_step
      window = 8.0_wp*sum_window*impact%law%contact_time*impact%time_scale()
      call find_sums()
      if (allocated(error)) return
      value = unset
      level = 0
      thousandth = 0.0_wp
      do
         level = level + 1
         call march(settings, impact, terms, vibration, dt, trajectory, effort, error)
         if (allocated(error)) return
         if (.not. exact .and. trajectory%state(col_time, trajectory%last) > window) then
            window = 4.0_wp*trajectory%state(col_time, trajectory%last)
            call find_sums()
            if (allocated(error)) return
            level = 0
            cycle
         end if
         value = cshift(value, 1, 1)
         value(3, :) = [results_of(trajectory, impact), &
            trajectory%first_end, trajectory%max_force, trajectory%max_indentation, &
            real(trajectory%contacts, wp)]
         if (trajectory%status == contact_unknown) then
            ! steps that are too long let the sphere hop from node to node, half as far with half of
            ! the step; contacts that are real stay where they are
            if (last(trajectory, col_time) > 0.75_wp*thousandth .and. thousandth > 0.0_wp &
                .or. 3.0_wp*effort > direct_most_work .or. dt < shortest) then
               call raise(error, error_numerical, 'the sphere has struck the structure a ' &
                  //'thousand times and is still within its reach')
               return
            end if
            thousandth = last(trajectory, col_time)
            level = 0
         else if (trajectory%status /= contact_separated) then
            if (level >= 3 .or. 3.0_wp*effort > direct_most_work) return
         else if (level >= 3) then
            call set_errors()
            if (given) exit
            if (short_enough) exit
            if (3.0_wp*effort > direct_most_work) then
               if (trajectory%misses_by_far()) call raise(error, error_numerical, 'the ' &
                  //'accuracy asked for is out of reach of product integration: give a larger ' &
                  //'solver.accuracy')
               exit
            end if
         end if
         dt = 0.5_wp*dt
      end do
      if (allocated(error)) return
      if (trajectory%contacts == 1 .and. .not. trajectory%just_missed) return
      do side = 1, 2
         other = impact
         other%velocity = impact%velocity*(1.0_wp + real(2*side - 3, wp)*next_to)
         ! with longer steps the number of contacts would change at another velocity
         call march(settings, other, terms, vibration, dt, near, effort, error)
         if (allocated(error)) return
         beside(side, :) = [results_of(near, other), near%first_end, real(near%contacts, wp)]
      end do
      trajectory%change_beside = max(change_of(1), change_of(2))
      trajectory%cor_error = trajectory%cor_error + change_of(1)
      trajectory%cor_sphere_error = trajectory%cor_sphere_error + change_of(2)
      trajectory%contact_time_error = trajectory%contact_time_error + change_of(3)

   contains

      !> Largest change of a result beside the impact, beyond that along a line. If the number of
      !> contacts is another one on both sides, nothing tells the line
      pure function change_of(i) result(change)
         !> Result
         integer, intent(in) :: i
         !> Change
         real(wp) :: change

         associate (e => beside(:, i), middle => value(3, i))
            if (all(nint(beside(:, 4)) /= nint(value(3, 6)))) then
               change = maxval(abs(e - middle))
            else
               change = abs(e(1) - 2.0_wp*middle + e(2))
            end if
         end associate
      end function change_of

      !> Expand contact and structure in sums of exponentials
      subroutine find_sums()

         ! accuracy of the numerical inversion of a pair
         real(wp), parameter :: rounding = 3.0e-12_wp
         real(wp) :: accuracy, brief

         accuracy = sum_share*max(settings%accuracy, epsilon(1.0_wp))
         brief = impact%law%contact_time*impact%time_scale()
         ! as in `expand` of a structure
         call impact%kernel_exponentials(window, max(accuracy*(brief/window)**3, rounding), terms)
         if (.not. terms%error < 1.0_wp) then
            call raise(error, error_numerical, 'no sum of exponentials represents the kernel ' &
               //'of this contact')
            return
         end if
         call impact%target%structure%expand(window, brief, accuracy, vibration, error)
         exact = .not. max(terms%error, vibration%error) > 0.0_wp
      end subroutine find_sums

      !> Errors of the results from the last three runs, with those of the sums, and whether steps
      !> are short enough
      subroutine set_errors()

         type(richardson_t) :: found
         type(ringing_t) :: ringing
         real(wp) :: of_sums, of_modes(2)

         of_sums = terms%error + vibration%error
         trajectory%accuracy = settings%accuracy
         if (terms%error > 0.0_wp) trajectory%kernel_terms = size(terms%rates)
         trajectory%kernel_error = terms%error
         found = richardson(value(:, 1))
         trajectory%cor_error = found%error + of_sums
         found = richardson(value(:, 2))
         trajectory%cor_sphere_error = found%error + of_sums
         found = richardson(value(:, 3))
         trajectory%contact_time_error = found%error + of_sums*trajectory%first_end
         found = richardson(value(:, 4))
         trajectory%max_force_error = found%error + of_sums*trajectory%max_force
         short_enough = max(trajectory%cor_error, trajectory%cor_sphere_error) &
            <= share*settings%accuracy &
            .and. is_done(3, trajectory%contact_time_error, trajectory%first_end) &
            .and. is_done(4, trajectory%max_force_error, trajectory%max_force)
         call ringing%begin(impact, vibration, impact%time_scale(), 0.0_wp)
         of_modes = ringing%velocity_errors(impact, abs(last(trajectory, col_velocity)), &
            last(trajectory, col_indentation))
         call ringing%add_errors(impact, trajectory, of_modes(2), trajectory%contacts)
      end subroutine set_errors

      !> Whether shorter steps do not help a result: it is accurate, or its differences from run to
      !> run do not fall any more. Those of the end of a contact that only just ends do not: there s
      !> all but has a double root, which moves by the root of what rounding changes
      pure function is_done(i, uncertainty, size)
         !> Result
         integer, intent(in) :: i
         !> Its error, and its size
         real(wp), intent(in) :: uncertainty, size
         logical :: is_done

         is_done = uncertainty <= settings%accuracy*size &
            .or. all(nint(value(:, 6)) == nint(value(3, 6))) &
            .and. abs(value(3, i) - value(2, i)) >= abs(value(2, i) - value(1, i))
      end function is_done
   end subroutine solve_contacts

   !> Coefficients of restitution against the rigid motion of the structure and of the sphere alone,
   !> 0 of a sphere that does not leave
   pure function results_of(trajectory, impact) result(e)
      type(trajectory_t), intent(in) :: trajectory
      type(impact_t), intent(in) :: impact
      !> Coefficients
      real(wp) :: e(2)

      e = 0.0_wp
      if (trajectory%status == contact_separated) e = [trajectory%rigid_velocity, 0.0_wp] &
         - last(trajectory, col_sphere_velocity)
      e = e/impact%velocity
   end function results_of

   !> A column of the last node
   pure function last(trajectory, column) result(value)
      type(trajectory_t), intent(in) :: trajectory
      !> Its number
      integer, intent(in) :: column
      !> Value
      real(wp) :: value

      value = trajectory%state(column, trajectory%last)
   end function last

   !> Compute one run with a given time step
   subroutine march(settings, impact, terms, vibration, dt, trajectory, effort, error)
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: terms
      type(vibration_t), intent(in) :: vibration
      !> Time step [s]
      real(wp), intent(in) :: dt
      type(trajectory_t), intent(out) :: trajectory
      !> Number of multiplications
      real(wp), intent(out) :: effort
      type(error_t), allocatable, intent(out) :: error

      type(run_t) :: run
      real(wp) :: end_time, reach
      integer :: stride, flown
      logical :: pressed

      end_time = settings%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%patience(impact%time_scale())
      call run%begin(impact, terms, vibration, dt)
      call trajectory%reserve(1024)
      trajectory%state(:, 0) = run%node(impact)
      trajectory%share(0) = 0.0_wp
      trajectory%contacts = 0
      stride = 1
      flown = 0
      reach = huge(1.0_wp)
      do
         pressed = run%force(1) > 0.0_wp
         call run%take_step(impact)
         effort = run%effort
         call find_peaks(run, trajectory)
         if (pressed .and. .not. run%force(1) > 0.0_wp .and. run%steps > 1) then
            call separate(run, impact, vibration, trajectory)
            if (settings%first_contact) then
               trajectory%status = contact_separated
               exit
            end if
            if (trajectory%contacts == most_contacts) then
               trajectory%status = contact_unknown
               exit
            end if
            flown = 0
         end if
         if (mod(run%steps, stride) == 0) call store(run%node(impact), trajectory, stride)
         if (trajectory%contacts <= 1) trajectory%just_missed = trajectory%just_missed &
            .or. misses(run, impact)
         if (.not. run%force(1) > 0.0_wp .and. trajectory%contacts > 0) then
            if (mod(flown, reach_steps) == 0) reach = vibration%reach(run%modes%state())
            flown = flown + 1
            if (has_left(run, impact, vibration, reach)) then
               trajectory%status = contact_separated
               exit
            end if
         else if (impact%gravity > 0.0_wp) then
            if (is_at_rest(run, impact)) then
               trajectory%status = contact_resting
               exit
            end if
         end if
         if (run%t > end_time) exit
         if (effort > direct_most_work) then
            call raise(error, error_numerical, 'the sphere does not get out of the reach of the ' &
               //'structure within the steps that product integration can make')
            return
         end if
      end do
      trajectory%steps = run%steps
      if (trajectory%status == contact_separated) then
         ! the history ends with the last contact
         trajectory%final = count(trajectory%state(col_time, 1:trajectory%final) &
            < trajectory%separation(col_time))
         call store(trajectory%separation, trajectory, stride)
         return
      end if
      call store(run%node(impact), trajectory, stride)
      if (trajectory%status == contact_lasting .and. .not. settings%end_time > 0.0_wp &
          .and. .not. run%force(1) > 0.0_wp) call raise(error, error_numerical, &
         'the sphere stays within the reach of the structure, without damping for ever: give a ' &
         //'damping, or solver.end_time')
   end subroutine march

   !> Begin a run at first contact
   subroutine begin(self, impact, terms, vibration, dt)
      class(run_t), intent(out) :: self
      type(impact_t), intent(in) :: impact
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: terms
      type(vibration_t), intent(in) :: vibration
      !> Time step [s]
      real(wp), intent(in) :: dt

      self%dt = dt
      self%residual = vibration%residual
      self%is_held = all(vibration%square > 0.0_wp) .and. all(vibration%rate > 0.0_wp)
      call self%modes%prepare(vibration, dt)
      call self%row%prepare(terms, impact%law, dt, 0.0_wp)
      if (.not. self%residual > 0.0_wp) self%force(1) = impact%first_force()
   end subroutine begin

   !> Advance to the next node
   subroutine take_step(self, impact)
      class(run_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact

      integer, parameter :: most_iterations = 60
      real(wp) :: known, per_force, value, slope, s, change, force, velocity, bend
      integer :: iteration

      self%steps = self%steps + 1
      call self%modes%advance(self%force(2))
      call self%row%find_levels()
      associate (dt => self%dt, f => self%force)
         ! a sum of equal steps would be off by the same rounding in each of them
         self%t = self%start + real(self%steps, wp)*dt
         known = self%second_impulse + dt*self%impulse + dt**2*(10.0_wp*f(1) - f(2))/24.0_wp
         per_force = 0.125_wp*dt**2/impact%mass + self%modes%yield + self%residual
         s = impact%free_path(self%t) - known/impact%mass - self%modes%deflection()
         known = s
         ! the force is convex in s: after one of Newton's steps the others fall towards the root
         do iteration = 1, most_iterations
            call self%row%press(impact%law, s, value, slope)
            change = (s - known + per_force*self%row%stiffness*value) &
               /(1.0_wp + per_force*self%row%stiffness*slope)
            s = s - change
            if (abs(change) <= 4.0_wp*epsilon(s)*max(abs(s), abs(known))) exit
         end do
         call self%row%press(impact%law, s, value, slope)
         force = self%row%stiffness*value
         self%depth = [s - self%row%surface(impact%law), self%depth(1), self%depth(2)]
         call self%row%accept(impact%law, s, s - self%s)
         call self%modes%accept(force)
         bend = force - 2.0_wp*f(1) + f(2)
         if (.not. max(force, f(1)) > 0.0_wp) bend = 0.0_wp
         call add(self%second_impulse, self%rest(2), dt*(self%impulse + self%rest(1)) &
            + dt**2*(f(1)/3.0_wp + force/6.0_wp - bend/24.0_wp))
         call add(self%impulse, self%rest(1), dt*(0.5_wp*(f(1) + force) - bend/12.0_wp))
         self%last_s = [s, self%last_s(1), self%last_s(2)]
         self%s = s
         f = [force, f(1), f(2)]
         if (.not. force > 0.0_wp) f(2:) = 0.0_wp
         velocity = 0.0_wp
         if (force > 0.0_wp) velocity = self%modes%rate()
         self%power(:, 2:3) = self%power(:, 1:2)
         self%power(:, 1) = force*[self%sphere_velocity(impact) - velocity, velocity]
         if (any(abs(self%power(2, :)) > 0.0_wp)) self%work = self%work &
            + dt*matmul(self%power, rule)
         self%effort = self%effort + work_of_step + self%modes%work &
            + real(self%row%count*(20 + 4*self%row%modes()), wp)
      end associate
   end subroutine take_step

   !> Add to a sum, and keep what rounding takes from it for the next time (W. Kahan, Commun. ACM 8
   !> (1965) 40, doi:10.1145/363707.363723)
   pure subroutine add(total, rest, part)
      !> The sum, and what it is short of
      real(wp), intent(inout) :: total, rest
      !> What is added
      real(wp), intent(in) :: part

      real(wp) :: more, last

      more = part + rest
      last = total
      total = last + more
      rest = more - (total - last)
   end subroutine add

   !> Velocity of the sphere [m/s]
   pure function sphere_velocity(self, impact) result(velocity)
      class(run_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      real(wp) :: velocity

      velocity = impact%free_velocity(self%t) - self%impulse/impact%mass
   end function sphere_velocity

   !> Displacement of the sphere [m]
   pure function sphere(self, impact) result(place)
      class(run_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      real(wp) :: place

      place = impact%free_path(self%t) - self%second_impulse/impact%mass
   end function sphere

   !> State at the node
   pure function node(self, impact) result(state)
      class(run_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> State
      real(wp) :: state(columns)

      state(col_time) = self%t
      state(col_indentation) = self%s
      state(col_force) = self%force(1)
      state(col_impulse) = self%impulse
      state(col_sphere) = self%sphere(impact)
      state(col_sphere_velocity) = self%sphere_velocity(impact)
      state(col_plate) = state(col_sphere) - self%s
      state(col_plate_velocity) = self%modes%rate() + self%residual*(1.5_wp*self%force(1) &
         - 2.0_wp*self%force(2) + 0.5_wp*self%force(3))/self%dt
      state(col_velocity) = state(col_sphere_velocity) - state(col_plate_velocity)
   end function node

   !> Store a node; where there are too many, every second one is left out
   subroutine store(state, trajectory, stride)
      !> State
      real(wp), intent(in) :: state(columns)
      type(trajectory_t), intent(inout) :: trajectory
      !> Number of steps between two nodes
      integer, intent(inout) :: stride

      integer :: half

      if (trajectory%final == most_nodes) then
         half = most_nodes/2
         trajectory%state(:, 0:half) = trajectory%state(:, 0:most_nodes:2)
         trajectory%final = half
         stride = 2*stride
      end if
      call trajectory%reserve(trajectory%final + 1)
      trajectory%final = trajectory%final + 1
      trajectory%state(:, trajectory%final) = state
      trajectory%share(trajectory%final) = 0.0_wp
      trajectory%last = trajectory%final
   end subroutine store

   !> Record the end of a contact in the newest step: where s meets the surface of the dent
   subroutine separate(run, impact, vibration, trajectory)
      type(run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      type(vibration_t), intent(in) :: vibration
      type(trajectory_t), intent(inout) :: trajectory

      type(state_of_modes_t) :: modes
      real(wp) :: state(columns), back, x

      x = fall_of(run%depth(3:1:-1))
      back = (1.0_wp - x)*run%dt
      trajectory%contacts = trajectory%contacts + 1
      if (trajectory%contacts == 1) then
         trajectory%first_end = run%t - back
         trajectory%first_velocity = run%sphere_velocity(impact) - impact%gravity*back
         trajectory%first_speed = trajectory%first_velocity - run%modes%rate()
      end if
      modes = run%modes%state()
      trajectory%rigid_velocity = vibration%rigid_velocity(modes)
      trajectory%structure_energy = unset
      if (size(vibration%rate) == 0) trajectory%structure_energy = vibration%energy(modes) &
         + back*vibration%power_lost(modes)
      trajectory%work = run%work
      state = run%node(impact)
      state(col_time) = state(col_time) - back
      state(col_indentation) = parabola(run%last_s(3:1:-1), x)
      state(col_sphere_velocity) = state(col_sphere_velocity) - impact%gravity*back
      state(col_sphere) = state(col_sphere) - back*state(col_sphere_velocity)
      state(col_plate) = state(col_sphere) - state(col_indentation)
      state(col_velocity) = state(col_sphere_velocity) - state(col_plate_velocity)
      trajectory%separation = state
   end subroutine separate

   !> Whether a sphere without contact is out of reach
   pure function has_left(run, impact, vibration, reach)
      type(run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      type(vibration_t), intent(in) :: vibration
      !> Reach of the structure [m]
      real(wp), intent(in) :: reach
      logical :: has_left

      if (run%is_held) then
         ! the same without the state of all modes
         has_left = run%sphere_velocity(impact) < 0.0_wp .and. -run%sphere(impact) >= reach
      else
         has_left = vibration%is_left_by(run%modes%state(), run%sphere(impact), &
            run%sphere_velocity(impact), reach)
      end if
   end function has_left

   !> Whether a sphere without contact is closest to the structure, or one in contact closest to
   !> leaving it, and so close that it does at a velocity of the impact next to this one:
   !> displacements grow as the velocity, or a little faster
   pure function misses(run, impact)
      type(run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      logical :: misses

      real(wp) :: depth(3), bend, closest, sphere

      misses = .false.
      depth = run%depth
      ! in contact it is the least depth
      if (minval(depth) > 0.0_wp) depth = -depth
      if (.not. maxval(depth) < 0.0_wp) return
      if (.not. (depth(2) >= depth(1) .and. depth(2) > depth(3))) return
      bend = depth(1) - 2.0_wp*depth(2) + depth(3)
      closest = depth(2) - 0.125_wp*(depth(1) - depth(3))**2/bend
      sphere = run%sphere(impact)
      misses = -closest < 2.0_wp*next_to*(abs(sphere) + abs(sphere - run%s))
   end function misses

   !> Whether the weight keeps the sphere in contact, at rest
   pure function is_at_rest(run, impact) result(rests)
      type(run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      logical :: rests

      ! a motion with this velocity and force, over those of the impact and the weight, is none
      real(wp), parameter :: negligible = 1.0e-7_wp
      real(wp) :: weight

      weight = impact%mass*impact%gravity
      rests = abs(run%force(1) - weight) <= negligible*weight .and. &
         abs(run%sphere_velocity(impact)) <= negligible*impact%velocity .and. &
         abs(run%modes%rate()) <= negligible*impact%velocity
   end function is_at_rest

   !> Find the largest indentation and force by the parabola through the last three nodes
   pure subroutine find_peaks(run, trajectory)
      type(run_t), intent(in) :: run
      type(trajectory_t), intent(inout) :: trajectory

      call peak(run%force, trajectory%max_force, trajectory%time_of_max_force)
      if (run%force(1) > 0.0_wp) &
         call peak(run%last_s, trajectory%max_indentation, trajectory%time_of_max_indentation)

   contains

      !> Peak of one value
      pure subroutine peak(value, largest, time)
         !> Value at the newest node and the two before
         real(wp), intent(in) :: value(3)
         !> Largest value
         real(wp), intent(inout) :: largest
         !> Its time [s]
         real(wp), intent(inout) :: time

         real(wp) :: bend, x

         if (.not. (value(2) >= value(1) .and. value(2) > value(3))) return
         bend = value(1) - 2.0_wp*value(2) + value(3)
         x = 0.5_wp*(value(3) - value(1))/bend
         if (parabola(value(3:1:-1), x) > largest) then
            largest = parabola(value(3:1:-1), x)
            time = run%t + (x - 1.0_wp)*run%dt
         end if
      end subroutine peak
   end subroutine find_peaks

   !> Whether a structure strikes the sphere again after their first separation: their free motion
   !> is followed in small steps until the sphere is out of reach
   subroutine comes_back(impact, terms, vibration, modes, node, w, lag, back)
      type(impact_t), intent(in) :: impact
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: terms
      type(vibration_t), intent(in) :: vibration
      !> State of the structure at the separation
      type(state_of_modes_t), intent(in) :: modes
      !> State at the separation
      real(wp), intent(in) :: node(columns)
      !> Compression of the spring touched first, and its lags, shape (modes)
      real(wp), intent(in) :: w, lag(:)
      !> Whether it does, or may
      logical, intent(out) :: back

      type(run_t) :: run
      real(wp) :: dt, reach
      integer :: flown

      dt = impact%law%contact_time/real(direct_first_steps, wp)*impact%time_scale()
      call run%begin(impact, terms, vibration, dt)
      call run%modes%set(modes, 0.0_wp)
      call run%row%set(w, 0.0_wp, lag)
      run%force = 0.0_wp
      run%start = node(col_time)
      run%s = node(col_indentation)
      run%impulse = node(col_impulse)
      run%second_impulse = (impact%free_path(run%start) - node(col_sphere))*impact%mass
      flown = 0
      do
         call run%take_step(impact)
         back = run%force(1) > 0.0_wp .or. run%effort > direct_most_work .or. misses(run, impact)
         if (back) return
         if (mod(flown, reach_steps) == 0) reach = vibration%reach(run%modes%state())
         flown = flown + 1
         if (has_left(run, impact, vibration, reach)) return
      end do
   end subroutine comes_back

end module vcor_solver_direct_contacts
