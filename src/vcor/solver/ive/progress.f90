!> Where a march stands, and what it hands over: the two solutions, the next step, the trajectory
module vcor_solver_ive_progress
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_dense, only : width
   use vcor_numeric_radau_rule, only : bridge_t
   use vcor_solver_ive_control, only : control_t
   use vcor_solver_ive_equations, only : motion_t
   use vcor_solver_ive_event, only : event_close, event_end, solve_up_to, time_to_event
   use vcor_solver_ive_newton, only : solve_companion
   use vcor_solver_ive_panel, only : panel_t, step_t
   use vcor_solver_ringing, only : ringing_t
   use vcor_tuning, only : ive_harmless, ive_rounding, ive_rounding_per_panel, ive_share
   implicit none
   private

   public :: at_branch, progress_t, velocities

   !> Error over difference where the error of n stages falls only as n^-2: next to a branch point
   !> of u, and in the force of modes that settle within a panel, which follows the rate of u
   real(wp), parameter :: at_branch = 1.0_wp/((8.0_wp/7.0_wp)**2 - 1.0_wp)

   !> Largest values in a panel
   type :: peaks_t
      !> Indentation [m], and its time since the start of the panel [s]
      real(wp) :: indentation = 0.0_wp, time_of_indentation = 0.0_wp
      !> Force [N], its difference from that of the coarse solution [N], and its time since the
      !> start of the panel [s]
      real(wp) :: force = 0.0_wp, force_difference = 0.0_wp, time_of_force = 0.0_wp
   end type peaks_t

   !> The state of a march
   type :: progress_t
      !> The solution, and the same with one stage less
      type(motion_t) :: fine, coarse
      !> Interpolation between them
      type(bridge_t), pointer :: bridge => null()
      !> Largest values in the panel
      type(peaks_t) :: peaks
      !> Difference of the largest forces so far [N]
      real(wp) :: force_difference = 0.0_wp
      !> The panel solved last, accepted or not
      type(panel_t) :: previous
      !> Time scale of the contact [s], and its reference velocity [m/s]
      real(wp) :: time_scale = 0.0_wp, speed = 0.0_wp
      !> End of the computation if the contact lasts [s]
      real(wp) :: end_time = 0.0_wp
      !> The step, and the control of its duration
      type(step_t) :: step
      type(control_t) :: control
      !> Whether the panel ends with the largest indentation, the contact, the computation
      logical :: turns = .false., ends = .false., reaches_end_time = .false.
      !> Times from the end of the panel to the end of the contact in the two solutions [s]
      real(wp) :: fine_end = 0.0_wp, coarse_end = 0.0_wp
      !> Sum of what the panels have added to the difference, without cancellation [-]
      real(wp) :: added = 0.0_wp
      !> Velocity that both solutions miss alike after the largest indentation, over `speed` [-]
      real(wp) :: missed = 0.0_wp
      !> Ringing of a structure's modes, which both solutions miss alike
      type(ringing_t) :: ringing
      !> Errors by the march, once the contact has ended, see `vcor_solver_ive_errors`
      real(wp) :: last_errors(4) = 0.0_wp
      !> Rebound: time left [s], and t1' [-] and t1'' [1/s], for a guess
      real(wp) :: rest = 0.0_wp, rate = 0.0_wp, bend = 0.0_wp
   contains
      procedure :: begin
      procedure :: record
      procedure :: motion_error
      procedure :: missed_velocity
      procedure :: find_ends
      procedure :: end_without_force
      procedure :: find_peaks
      procedure :: record_peaks
   end type progress_t

contains

   !> Set the first node of a trajectory
   subroutine begin(self, trajectory)
      class(progress_t), intent(in) :: self
      type(trajectory_t), intent(out) :: trajectory

      ! panels for which there is room at first
      integer, parameter :: usual_panels = 8

      associate (rule => self%fine%rule, start => self%fine%start)
         call trajectory%reserve(usual_panels*rule%stages)
         trajectory%state(:, 0) = 0.0_wp
         trajectory%state(col_sphere_velocity, 0) = self%fine%impact%velocity
         trajectory%state(col_force, 0) = start%force
         trajectory%state(col_plate_velocity, 0) = start%alpha*start%force
         trajectory%state(col_velocity, 0) = start%velocity
         trajectory%share(0) = 0.0_wp
         trajectory%stages = rule%stages
         allocate (trajectory%point(0:rule%stages), source=rule%point(0:rule%stages))
         allocate (trajectory%barycentric(0:rule%stages), source=rule%barycentric(0:rule%stages))
      end associate
   end subroutine begin

   !> Add the nodes of the panel to the trajectory; its rates of the indentation are known
   subroutine record(self, trajectory)
      class(progress_t), intent(in) :: self
      type(trajectory_t), intent(inout) :: trajectory

      integer :: n, first, j

      associate (panel => self%fine%panel, rule => self%fine%rule, impact => self%fine%impact)
         n = panel%stages
         call trajectory%reserve(trajectory%final + n)
         call trajectory%add_map(panel%map)
         first = trajectory%final
         trajectory%final = first + n
         trajectory%last = trajectory%final
         trajectory%steps = trajectory%steps + 1
         trajectory%share(first + 1:first + n) = rule%weight(1:n)*panel%pace(rule%point(1:n)) &
            *panel%force(1:n)
         if (self%ends) trajectory%share(first + n) = panel%impulse(n) - panel%impulse(0) &
            - sum(trajectory%share(first + 1:first + n - 1))
         do j = 1, n
            associate (state => trajectory%state(:, first + j))
               state(col_time) = panel%time(j)
               state(col_indentation) = panel%indentation(j)
               state(col_velocity) = panel%velocity(j)
               state(col_force) = panel%force(j)
               state(col_impulse) = panel%impulse(j)
               state(col_sphere) = impact%free_path(panel%time(j)) &
                  - panel%second_impulse(j)/impact%mass
               state(col_sphere_velocity) = impact%free_velocity(panel%time(j)) &
                  - panel%impulse(j)/impact%mass
               state(col_plate) = state(col_sphere) - panel%indentation(j)
               ! what Newton's method leaves is in s
               if (.not. impact%target%has_memory()) then
                  state(col_plate) = panel%alpha(j)*panel%impulse(j)
                  state(col_indentation) = state(col_sphere) - state(col_plate)
               end if
               state(col_plate_velocity) = state(col_sphere_velocity) - panel%velocity(j)
            end associate
         end do
      end associate
   end subroutine record

   !> What the panel adds to the difference between the two solutions, in all that results are made
   !> of: the impulse in the velocities of sphere and plate, the indentation, and the energy that
   !> the plate takes, in which errors of the force do not average out
   pure function motion_error(self) result(error)
      class(progress_t), intent(in) :: self
      !> Error over `speed` [-]
      real(wp) :: error

      real(wp) :: rate
      integer :: n

      associate (fine => self%fine%panel, coarse => self%coarse%panel, impact => self%fine%impact)
         n = fine%stages
         rate = 1.0_wp/impact%mass
         if (fine%alpha(n) > fine%alpha(0) .and. .not. impact%target%has_memory()) &
            rate = max(rate, impact%target%alpha_rate(fine%time(n), fine%alpha(n)))
         if (allocated(self%fine%sums%vibration)) then
            error = error_beside_modes()
            return
         end if
         error = (added(fine%impulse, coarse%impulse)*rate &
            + added(fine%indentation, coarse%indentation)/self%time_scale)/self%speed
         ! errors of the memory of a plate at first contact decay
         if (fine%time(0) > 0.0_wp) error = error + added(fine%drift, coarse%drift)/self%speed
         error = max(error, abs(self%fine%work_in_panel() - self%coarse%work_in_panel()) &
            /(0.5_wp*impact%mass*self%speed**2))
      end associate

   contains

      !> Error before a structure: that of the panel alone, as both solutions start from one state.
      !> The surface moves in fast modes, too, which change nothing but s: the motion of the sphere
      !> counts, and the mean of s over the panel
      pure function error_beside_modes() result(error)
         !> Error over `speed` [-]
         real(wp) :: error

         real(wp) :: mean

         associate (fine => self%fine%panel, coarse => self%coarse%panel, &
                    weight => self%fine%rule%weight, other => self%coarse%rule%weight)
            mean = sum(weight(:n)*fine%pace(self%fine%rule%point(1:n))*fine%indentation(1:n)) &
               - sum(other(:n - 1)*coarse%pace(self%coarse%rule%point(1:n - 1)) &
               *coarse%indentation(1:n - 1))
            error = ((abs(fine%impulse(n) - coarse%impulse(n - 1)) &
               + abs(fine%second_impulse(n) - coarse%second_impulse(n - 1))/self%time_scale) &
               /self%fine%impact%mass + abs(mean)/(fine%step%duration*self%time_scale))/self%speed
         end associate
      end function error_beside_modes

      !> What the panel adds to the difference between two values
      pure function added(one, other) result(difference)
         !> Values of the two solutions at the points
         real(wp), intent(in) :: one(0:width), other(0:width)
         real(wp) :: difference

         real(wp) :: before, after

         before = one(0) - other(0)
         after = one(n) - other(n - 1)
         difference = abs(after - before)
         ! a difference that only decays is no error
         if (before*after >= 0.0_wp) difference = max(0.0_wp, abs(after) - abs(before))
      end function added
   end function motion_error

   !> Velocity that both solutions miss alike after the largest indentation. Modes that are fast
   !> compared with the rebound make a layer of width 1/l there. Within it t1 falls at the rate of
   !> time, after it the relaxed contact yields: with s' = -a (t - t_m) and the stiffness
   !> K of the slower modes, K (s(t_m) - s(t1)) = a G/l (t - t_m - 1/l). The force u'' (s(t_m) -
   !> s(t1))^2 K/2 has a kink at 1/l, and a polynomial that continues it to t_m misses the impulse
   !> u'' (a G)^2/(6 K l^5). A panel of n stages resolves modes with l dt/dtheta < n (n + 1)
   pure function missed_velocity(self) result(missed)
      !> The progress, its panel the first of a rebound
      class(progress_t), intent(in) :: self
      !> Velocity over `speed` [-]
      real(wp) :: missed

      ! part of s over which the law is differentiated again: twice as much changes nothing that 109
      ! random impacts state
      real(wp), parameter :: part = 0.1_wp
      real(wp) :: slower, bend, acceleration, ratio, rate, s
      integer :: k, n

      n = self%fine%panel%stages
      associate (panel => self%fine%panel, contact => self%fine%sums%contact, &
                 law => self%fine%impact%law, mass => self%fine%impact%mass)
         s = panel%indentation(0)
         bend = (law%slope(s) - law%slope((1.0_wp - part)*s))/(part*s)
         acceleration = panel%force(0)/mass
         missed = 0.0_wp
         do k = 1, size(contact%rates)
            rate = contact%rates(k)
            slower = contact%equilibrium + sum(contact%moduli, contact%rates < rate)
            ! a fluid has nothing slower that pushes
            if (.not. slower > 0.0_wp) cycle
            ratio = contact%moduli(k)/slower
            missed = missed + slower*ratio*(1.0_wp + ratio)/rate**5 &
               *exp(-real(n*(n + 1), wp)/(rate*panel%step%duration))
         end do
         missed = abs(bend)*acceleration**2*missed/(6.0_wp*mass*self%speed)
      end associate
   end function missed_velocity

   !> Find the end of the contact in both solutions; with that of a coarse one whose force is
   !> rounding the panel ends
   subroutine find_ends(self, max_force, found)
      class(progress_t), intent(inout) :: self
      !> Largest force so far [N]
      real(wp), intent(in) :: max_force
      !> Whether there is one
      logical, intent(out) :: found

      integer :: event

      event = merge(event_close, event_end, self%fine%recedes)
      call time_to_event(self%fine, event, self%fine_end, found)
      if (.not. found) return
      call time_to_event(self%coarse, event, self%coarse_end, found)
      associate (panel => self%coarse%panel)
         if (found .or. abs(panel%force(panel%stages)) > ive_rounding*max_force) return
      end associate
      self%coarse_end = 0.0_wp
      found = .true.
   end subroutine find_ends

   !> Move the last node of the fine solution to the end of the contact, which it almost is
   pure subroutine end_without_force(self)
      class(progress_t), intent(inout) :: self

      real(wp) :: v(2)

      v = velocities(self%fine, self%fine_end)
      associate (panel => self%fine%panel, n => self%fine%panel%stages, time => self%fine_end)
         panel%time(n) = panel%time(n) + time
         panel%indentation(n) = panel%indentation(n) + v(1)*time
         panel%velocity(n) = v(1)
         panel%second_impulse(n) = panel%second_impulse(n) + panel%impulse(n)*time
         panel%impulse(n) = panel%impulse(n) + 0.5_wp*panel%force(n)*time
         panel%force(n) = 0.0_wp
         if (self%fine%impact%target%has_memory()) return
         panel%alpha(n) = self%fine%impact%target%alpha(panel%time(n))
         panel%indentation(n) = self%fine%impact%free_path(panel%time(n)) &
            - panel%second_impulse(n)/self%fine%impact%mass - panel%alpha(n)*panel%impulse(n)
      end associate
   end subroutine end_without_force

   !> Relative velocity and velocity of the sphere at the end of the contact, where F = 0
   pure function velocities(motion, time) result(v)
      type(motion_t), intent(in) :: motion
      !> Time from the end of the panel to the end of the contact [s]
      real(wp), intent(in) :: time
      !> Velocities [m/s]
      real(wp) :: v(2)

      real(wp) :: impulse

      associate (panel => motion%panel, n => motion%panel%stages, impact => motion%impact, &
                 plate => motion%impact%target)
         impulse = panel%impulse(n) + 0.5_wp*panel%force(n)*time
         v = impact%free_velocity(panel%time(n) + time) - impulse/impact%mass
         if (allocated(motion%sums%vibration)) then
            ! against its rigid motion
            v(1) = v(1) - impulse*sum(plate%structure%yield, .not. plate%structure%square > 0.0_wp)
         else if (plate%hereditary()) then
            v(1) = v(1) - panel%drift(n)
            if (.not. motion%recedes) v(1) = v(1) &
               - time*panel%slope_at_end(motion%rule, panel%drift)
         else if (plate%moves()) then
            v(1) = v(1) - impulse*plate%alpha_rate(panel%time(n) + time)
         end if
      end associate
   end function velocities

   !> Find the largest indentation and force in the panel
   subroutine find_peaks(self)
      class(progress_t), intent(inout) :: self

      real(wp) :: other

      associate (fine => self%fine%panel, coarse => self%coarse%panel, peaks => self%peaks)
         call find_peak(self, fine%indentation, .true., peaks%indentation, other, &
            peaks%time_of_indentation)
         call find_peak(self, fine%force, .false., peaks%force, peaks%force_difference, &
            peaks%time_of_force)
      end associate
   end subroutine find_peaks

   !> Record the peaks of an accepted panel if they exceed those of earlier ones
   pure subroutine record_peaks(self, trajectory)
      class(progress_t), intent(inout) :: self
      type(trajectory_t), intent(inout) :: trajectory

      associate (peaks => self%peaks, start => self%fine%start%time)
         if (peaks%indentation > trajectory%max_indentation) then
            trajectory%max_indentation = peaks%indentation
            trajectory%time_of_max_indentation = start + peaks%time_of_indentation
         end if
         if (peaks%force > trajectory%max_force) then
            trajectory%max_force = peaks%force
            trajectory%time_of_max_force = start + peaks%time_of_force
            self%force_difference = peaks%force_difference
         end if
      end associate
   end subroutine record_peaks

   !> Maximum of indentation or force in a panel. Where the two solutions differ too much inside the
   !> panel, it is solved up to the maximum: collocation is most accurate at the end
   subroutine find_peak(self, value, of_indentation, peak, difference, time)
      class(progress_t), intent(inout) :: self
      !> Values at the points of the panel
      real(wp), intent(in) :: value(0:width)
      !> Whether these are the indentation, otherwise the force
      logical, intent(in) :: of_indentation
      !> Maximum, and its difference from that of the coarse solution
      real(wp), intent(out) :: peak, difference
      !> Its time since the start of the panel [s]
      real(wp), intent(out) :: time

      ! error of the position in the panel; its square enters the maximum, itself the pressure at
      ! that time: 1e-10 changes results of 109 random impacts by up to 1e-12, 0.01 stated errors
      real(wp), parameter :: position = 1.0e-14_wp
      real(wp) :: smooth(0:width), slopes(0:width), theta, beyond
      integer :: n, j, other

      associate (rule => self%fine%rule, map => self%fine%panel%map)
         n = rule%stages
         j = maxloc(value(0:n), 1) - 1
         smooth = value
         ! the force at the start has the error of a rate at the end of the panel before
         if (.not. of_indentation) smooth(0) = sum(rule%start_weight*value(1:))
         slopes = rule%slopes(smooth)
         other = j + merge(1, -1, slopes(j) > 0.0_wp)
         beyond = -0.5_wp*slopes(j)**2/sum(rule%derivative(j, :)*slopes)
         ! close to an end of the panel a parabola has it
         if (other < 0 .or. other > n .or. (j == 0 .or. j == n) &
             .and. beyond >= 0.0_wp .and. beyond < ive_harmless*self%control%accuracy*value(j)) then
            time = merge(self%fine%panel%step%duration, 0.0_wp, j == n)
            peak = value(j)
            if (other >= 0 .and. other <= n) peak = peak + beyond
            difference = abs(value(j) - end_value(self%coarse%panel, &
               merge(self%coarse%panel%stages, 0, j == n)))
            return
         end if
         theta = rule%crossing(slopes, min(j, other), position)
         time = theta*(map(1) + map(2)*theta)
         peak = value_inside(self%fine, of_indentation, theta)
         ! the difference may have a zero there
         difference = max(abs(peak - value_inside(self%coarse, of_indentation, theta)), &
            abs(value(j) - value_inside(self%coarse, of_indentation, rule%point(j))), &
            abs(value(other) - value_inside(self%coarse, of_indentation, rule%point(other))))
         if (merge(1.0_wp, at_branch, of_indentation)*difference &
             <= 0.5_wp*self%control%accuracy*peak) return
         call solve_up_to_peak(self, of_indentation, time, peak, difference)
      end associate

   contains

      !> Value at a point of a panel
      pure function end_value(panel, point)
         type(panel_t), intent(in) :: panel
         integer, intent(in) :: point
         real(wp) :: end_value

         end_value = merge(panel%indentation(point), panel%force(point), of_indentation)
      end function end_value
   end subroutine find_peak

   !> Indentation or force between the nodes of a panel. The force is no polynomial, but u(s) is
   !> known from s, and what is interpolated is the part of it that has relaxed in slow modes
   pure function value_inside(motion, of_indentation, theta) result(value)
      type(motion_t), intent(in) :: motion
      !> Whether the indentation, otherwise the force
      logical, intent(in) :: of_indentation
      !> Position in the panel
      real(wp), intent(in) :: theta
      !> Value
      real(wp) :: value

      real(wp) :: basis(0:width), stiffness
      integer :: n

      associate (panel => motion%panel, contact => motion%sums%contact, law => motion%impact%law)
         n = panel%stages
         basis = motion%rule%basis(theta)
         value = sum(basis*panel%indentation)
         if (of_indentation) return
         stiffness = contact%equilibrium + sum(contact%moduli, &
            contact%rates*panel%step%duration < real(n, wp))
         value = stiffness*law%u(value) - sum(basis(:n)*(stiffness*panel%u(:n) &
            - panel%force(:n)))
      end associate
   end function value_inside

   !> Value of a maximum, and for the force its difference between the two solutions, by solving the
   !> panel up to there; unchanged if the equations cannot be solved
   subroutine solve_up_to_peak(self, of_indentation, time, peak, difference)
      class(progress_t), intent(inout) :: self
      !> Whether the indentation, otherwise the force
      logical, intent(in) :: of_indentation
      !> Time since the start of the panel [s]
      real(wp), intent(inout) :: time
      !> Maximum, and its difference from that of the coarse solution
      real(wp), intent(inout) :: peak, difference

      type(panel_t) :: fine, coarse
      real(wp) :: value(0:width), slope, bend

      fine = self%fine%panel
      coarse = self%coarse%panel
      call solve_up_to(self%fine, time)
      if (self%fine%panel%converged) then
         peak = last_value(self%fine%panel)
         if (.not. of_indentation) call solve_companion(self%coarse, self%fine, self%bridge)
         if (self%coarse%panel%converged) difference = abs(peak - last_value(self%coarse%panel))
         ! the maximum of the whole panel's polynomial is next to that of the solution
         value = merge(self%fine%panel%indentation, self%fine%panel%force, of_indentation)
         if (.not. of_indentation) value(0) = sum(self%fine%rule%start_weight*value(1:))
         call self%fine%panel%end_rates(self%fine%rule, value, slope, bend)
         if (bend < 0.0_wp) then
            time = time - slope/bend
            peak = peak - 0.5_wp*slope**2/bend
            difference = difference - 0.5_wp*slope**2/bend
         end if
      end if
      self%fine%panel = fine
      self%coarse%panel = coarse

   contains

      !> Value at the end of a panel
      pure function last_value(panel) result(value)
         type(panel_t), intent(in) :: panel
         real(wp) :: value

         value = merge(panel%indentation(panel%stages), panel%force(panel%stages), of_indentation)
      end function last_value
   end subroutine solve_up_to_peak

end module vcor_solver_ive_progress
