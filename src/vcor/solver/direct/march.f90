!> One run of product integration on a structure or under the weight, with a given time step:
!> through contact, flight and further contacts, and on from bounce to bounce
!>
!> The steps are equal, and contact, flight and the next contact are one formula
!> (`vcor_solver_direct_run`). The sphere has left where the structure cannot reach it any more
!> (`vcor_impact_structure`). What touches before that counts, also under gravity.
!>
!> With its weight the sphere comes back: further bounces begin where a flight ends
!> (`vcor_solver_direct_flight`), in steps that are the same share of the time that an elastic
!> contact at their velocity takes. On a face without a structure each separation ends a bounce.
module vcor_solver_direct_march
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_bounces, only : bounce_t, bounces_t, ends_contact, ends_count, ends_rest, &
      ends_time
   use vcor_impact_problem, only : impact_t
   use vcor_impact_structure, only : state_of_modes_t, vibration_t
   use vcor_impact_trajectory, only : col_indentation, col_impulse, col_plate, col_plate_velocity, &
      col_sphere, col_sphere_velocity, col_time, col_velocity, columns, contact_lasting, &
      contact_resting, contact_separated, contact_unknown, trajectory_t, unrest
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_solver_direct_evaluation, only : fall_of, parabola
   use vcor_solver_direct_flight, only : fly
   use vcor_solver_direct_recovery, only : recovery_t
   use vcor_solver_direct_run, only : run_t
   use vcor_solver_type, only : solver_settings_t
   use vcor_tuning, only : direct_first_steps, direct_most_work
   implicit none
   private

   public :: march, comes_back, next_to

   !> Most contacts of an impact
   integer, parameter :: most_contacts = 1000
   !> Most nodes that are stored; beyond it every second one is left out
   integer, parameter :: most_nodes = 16384
   !> Steps of flight after which the reach is computed anew: the dampings make it smaller. With
   !> four times as many 18 random impacts take as long, in the same steps
   integer, parameter :: reach_steps = 64
   !> Relative distance of the velocities next to that of the impact
   real(wp), parameter :: next_to = 1.0e-6_wp

contains

   !> Compute one run with a given time step
   subroutine march(settings, impact, terms, vibration, recovery, dt, trajectory, effort, error)
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: terms
      type(vibration_t), intent(in) :: vibration
      !> Recovery of dents, of use for several bounces
      type(recovery_t), intent(in) :: recovery
      !> Time step [s]
      real(wp), intent(in) :: dt
      type(trajectory_t), intent(out) :: trajectory
      !> Number of multiplications
      real(wp), intent(out) :: effort
      type(error_t), allocatable, intent(out) :: error

      type(run_t) :: run
      real(wp) :: end_time
      integer :: stride

      end_time = settings%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%lasting_time(impact%time_scale())
      call run%begin(impact, terms, vibration, dt)
      call trajectory%begin(run%node(impact))
      stride = 1
      call follow(settings, impact, vibration, end_time, run, stride, trajectory, error)
      effort = run%effort
      if (allocated(error)) return
      trajectory%steps = run%steps
      if (trajectory%status == contact_separated) then
         ! the history ends with the last contact
         trajectory%final = count(trajectory%state(col_time, 1:trajectory%final) &
            < trajectory%separation(col_time))
         call store(trajectory%separation, trajectory, stride)
         if (settings%bounces > 1) call bounce_on(settings, impact, terms, vibration, recovery, &
            run, trajectory, error)
         effort = run%effort
         return
      end if
      call store(run%node(impact), trajectory, stride)
      if (trajectory%status == contact_lasting .and. .not. settings%end_time > 0.0_wp &
          .and. .not. run%force(1) > 0.0_wp) call raise(error, error_numerical, &
         'the sphere stays within the reach of the structure, without damping for ever: give a ' &
         //'damping, or solver.end_time')
   end subroutine march

   !> Follow a bounce until the sphere has left, or stays
   subroutine follow(settings, impact, vibration, end_time, run, stride, trajectory, error)
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      type(vibration_t), intent(in) :: vibration
      !> End of the run [s]
      real(wp), intent(in) :: end_time
      type(run_t), intent(inout) :: run
      !> Number of steps between two nodes that are stored
      integer, intent(inout) :: stride
      !> The course of the bounce
      type(trajectory_t), intent(inout) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: reach
      integer :: flown
      logical :: pressed

      trajectory%contacts = 0
      flown = 0
      reach = huge(1.0_wp)
      do
         pressed = run%force(1) > 0.0_wp
         call run%take_step(impact)
         call find_peaks(run, trajectory)
         if (.not. pressed .and. run%force(1) > 0.0_wp .and. trajectory%contacts == 0) &
            trajectory%touch = touch_of(run, impact)
         if (pressed .and. .not. run%force(1) > 0.0_wp .and. run%steps > 1) then
            call separate(run, impact, vibration, trajectory)
            if (settings%first_contact .or. run%is_face) then
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
         if (trajectory%contacts <= 1) trajectory%grazes = trajectory%grazes &
            .or. grazes(run, impact)
         if (.not. run%force(1) > 0.0_wp .and. trajectory%contacts > 0) then
            if (mod(flown, reach_steps) == 0) reach = vibration%reach(run%modes%state())
            flown = flown + 1
            if (has_left(run, impact, vibration, reach)) then
               trajectory%status = contact_separated
               exit
            end if
         else if (impact%gravity > 0.0_wp) then
            if (is_at_rest(run, impact) .or. settings%bounces > 1 &
                .and. is_held_down(run, impact, vibration)) then
               trajectory%status = contact_resting
               exit
            end if
         end if
         if (run%t > end_time) exit
         if (run%effort > direct_most_work) then
            if (settings%bounces > 1) then
               call raise(error, error_numerical, 'the bounces asked for take more steps than ' &
                  //'product integration can make: give a smaller impact.bounces, or a larger ' &
                  //'solver.accuracy')
               return
            end if
            call raise(error, error_numerical, 'the sphere does not get out of the reach of the ' &
               //'structure within the steps that product integration can make')
            return
         end if
      end do
   end subroutine follow

   !> Follow the bounces after the first one
   subroutine bounce_on(settings, impact, terms, vibration, recovery, run, trajectory, error)
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: terms
      type(vibration_t), intent(in) :: vibration
      type(recovery_t), intent(in) :: recovery
      !> The run, where the sphere has left after the first bounce
      type(run_t), intent(inout) :: run
      !> The course of the first bounce
      type(trajectory_t), intent(inout) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      type(impact_t) :: here
      type(trajectory_t) :: course
      type(bounces_t) :: bounces
      real(wp) :: share, origin, flown, end_time
      integer :: stride

      here = impact
      share = run%dt/(impact%law%contact_time*impact%time_scale())
      origin = 0.0_wp
      course = trajectory
      course%touch = [0.0_wp, impact%velocity]
      do
         call bounces%add(bounce_of(run, here, course, origin))
         if (bounces%count == settings%bounces) then
            bounces%ending = ends_count
            bounces%total_time = bounces%list(bounces%count)%separation
            exit
         end if
         origin = origin + run%t
         call fly(run, here, terms, vibration, recovery, share, flown)
         origin = origin + flown
         end_time = here%lasting_time(here%time_scale())
         if (settings%end_time > 0.0_wp) end_time = settings%end_time - origin
         if (.not. end_time > 0.0_wp) then
            bounces%ending = ends_time
            bounces%total_time = settings%end_time
            exit
         end if
         course = trajectory_t()
         stride = huge(stride)
         call follow(settings, here, vibration, end_time, run, stride, course, error)
         if (allocated(error)) return
         if (course%status == contact_separated) cycle
         trajectory%status = merge(contact_unknown, contact_separated, &
            course%status == contact_unknown)
         bounces%total_time = origin + course%touch(1)
         bounces%ending = merge(ends_rest, ends_contact, course%status == contact_resting)
         if (settings%end_time > 0.0_wp .and. course%status == contact_lasting) then
            bounces%ending = ends_time
            bounces%total_time = settings%end_time
         end if
         exit
      end do
      trajectory%bounces = bounces
   end subroutine bounce_on

   !> What is known of a bounce
   pure function bounce_of(run, impact, course, origin) result(bounce)
      !> The run, where the sphere has left
      type(run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: course
      !> Time at which the run began [s]
      real(wp), intent(in) :: origin
      type(bounce_t) :: bounce

      bounce%time = origin + course%touch(1)
      bounce%velocity = course%touch(2)
      bounce%cor = -course%separation(col_sphere_velocity)/bounce%velocity
      bounce%separation = origin + course%separation(col_time)
      bounce%height = 0.5_wp*run%sphere_velocity(impact)**2/impact%gravity &
         - (run%sunk + run%sphere(impact))
      bounce%contacts = course%contacts
      bounce%max_force = course%max_force
      bounce%max_indentation = course%max_indentation
   end function bounce_of

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
      call trajectory%add(state)
      trajectory%last = trajectory%final
   end subroutine store

   !> Time and velocity of the sphere at a touch in the newest step
   pure function touch_of(run, impact) result(touch)
      type(run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      !> Time [s] and velocity [m/s]
      real(wp) :: touch(2)

      touch = 0.0_wp
      if (.not. run%is_face) &
         touch(1) = run%t - (1.0_wp - fall_of(-run%depth(3:1:-1)))*run%dt
      ! there has been no force before
      touch(2) = impact%free_velocity(touch(1))
   end function touch_of

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
      if (run%is_face) then
         back = run%behind
         x = 1.0_wp - back/run%dt
      end if
      trajectory%contacts = trajectory%contacts + 1
      if (trajectory%contacts == 1) then
         trajectory%first_end = run%t - back
         trajectory%first_velocity = run%sphere_velocity(impact) - impact%gravity*back
         trajectory%first_speed = trajectory%first_velocity - run%modes%rate()
      end if
      modes = run%modes%state()
      trajectory%rigid_velocity = vibration%rigid_velocity(modes)
      trajectory%structure_energy = unset
      if (.not. vibration%relaxes) trajectory%structure_energy = vibration%energy(modes) &
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

   !> Whether the sphere turns towards the structure or away from it so close to its surface, on
   !> either side, that at a velocity of the impact next to this one it does on the other: there
   !> contacts merge or split, are made or missed. Displacements grow as the velocity, or a little
   !> faster
   pure function grazes(run, impact)
      type(run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      logical :: grazes

      real(wp) :: turn, sphere

      grazes = .false.
      associate (depth => run%depth)
         if (.not. (min(depth(1), depth(3)) > depth(2) .or. max(depth(1), depth(3)) < depth(2))) &
            return
         turn = depth(2) - 0.125_wp*(depth(1) - depth(3))**2/(depth(1) - 2.0_wp*depth(2) + depth(3))
         ! by the force of a dashpot the surface is never far away in contact
         if (minval(depth) > 0.0_wp .and. impact%kernel_viscosity() > 0.0_wp) return
      end associate
      sphere = run%sphere(impact)
      grazes = abs(turn) < 2.0_wp*next_to*(abs(sphere) + abs(sphere - run%s))
   end function grazes

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
         abs(run%sphere_velocity(impact)) <= negligible*abs(impact%velocity) .and. &
         abs(run%modes%rate()) <= negligible*abs(impact%velocity)
   end function is_at_rest

   !> Whether the energy that is left cannot lift the sphere off again, where the indentation is
   !> largest (`rests` of a trajectory). On a structure of oscillators the energy of all deviations
   !> from rest,
   !>
   !>     2 V = m v^2 + C_r (F - W)^2 + sum (eta'^2 + w^2 (eta - y W/w^2)^2)/y + (F - W)^2/(k u'),
   !>
   !> only falls, and lifts off a sphere if it is W^2/(k u') with the glassy k, or more
   pure function is_held_down(run, impact, vibration) result(held)
      type(run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      type(vibration_t), intent(in) :: vibration
      logical :: held

      type(state_of_modes_t) :: modes
      real(wp) :: weight, firmness, energy

      held = .false.
      associate (s => run%last_s)
         if (.not. (run%steps > 2 .and. run%force(1) > 0.0_wp .and. s(2) >= s(1) &
             .and. s(2) > s(3))) return
      end associate
      weight = impact%mass*impact%gravity
      if (abs(run%force(1) - weight) >= weight) return
      if (run%is_face) then
         held = unrest(impact, run%node(impact)) < 1.0_wp
         return
      end if
      firmness = impact%factor*impact%modulus%glassy()
      if (vibration%relaxes .or. impact%kernel_viscosity() > 0.0_wp &
          .or. .not. firmness <= huge(1.0_wp)) return
      modes = run%modes%state()
      ! modes beyond the limit follow the force as the flexibility C_r does
      associate (n => vibration%modes())
         energy = impact%mass*run%sphere_velocity(impact)**2 + (vibration%residual &
            + vibration%rest%flexibility)*(run%force(1) - weight)**2 + sum((modes%rate(:n)**2 &
            + vibration%square(:n)*(modes%eta(:n) - vibration%yield(:n)*weight &
            /vibration%square(:n))**2)/vibration%yield(:n))
      end associate
      held = firmness*impact%law%slope(run%s)*energy + (run%force(1) - weight)**2 < weight**2
   end function is_held_down

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
         back = run%force(1) > 0.0_wp .or. run%effort > direct_most_work .or. grazes(run, impact)
         if (back) return
         if (mod(flown, reach_steps) == 0) reach = vibration%reach(run%modes%state())
         flown = flown + 1
         if (has_left(run, impact, vibration, reach)) return
      end do
   end subroutine comes_back

end module vcor_solver_direct_march
