!> The march of the internal-variable method: one loop over the panels of an impact
!>
!> While the contact grows, panels begin in the square root of time, in which the motion is analytic
!> from first contact. By Boltzmann's law the contact ends with a panel whose length is such that
!> F = 0 at its end. If the contact recedes, the panel of the largest indentation ends with it, and
!> the rebound follows; its last panel is in the square root of the time left, with N = 0 at its
!> end.
!>
!> Each panel is solved with eight stages and, as part of another solution of the whole impact, with
!> seven. What it adds to the difference of the two decides whether it is accepted, and how long the
!> next one is. What both solutions miss, `find_excess` adds.
module vcor_solver_ive_march
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, refuse_growth, trajectory_t
   use vcor_kinds, only : finest_accuracy, wp
   use vcor_numeric_radau_dense, only : width
   use vcor_numeric_radau_rule, only : bridge_t, closing, doubling, linear, opening, rule_t
   use vcor_solver_ive_approach, only : approach_t
   use vcor_solver_ive_control, only : length_factor
   use vcor_solver_ive_progress, only : at_branch, progress_t
   use vcor_solver_ive_equations, only : motion_t
   use vcor_solver_ive_errors, only : add_ringing, errors_of_march, largest
   use vcor_solver_ive_event, only : cut_at_event, event_close, event_end, event_turn, &
      first_without_force, time_to_event, time_to_zero
   use vcor_solver_ive_lags, only : sums_t
   use vcor_solver_ive_newton, only : guess_growth, guess_rebound, solve_companion, solve_panel
   use vcor_solver_ive_panel, only : step_t
   use vcor_solver_ive_separation, only : judge_separation
   use vcor_tuning, only : direct_most_work, ive_first, ive_growth, ive_leftover, ive_part, &
      ive_rounding, ive_rounding_of_fall, ive_rounding_per_panel, ive_safety, ive_settling, &
      ive_share
   implicit none
   private

   public :: follow

   !> Maximum number of panels, refused ones included
   integer, parameter :: most_panels = 20000
   !> Number of times that a panel in which t1 rises is halved before the rise is real: of 109
   !> random impacts none depends on it, from 1 to 8
   integer, parameter :: most_halvings = 4
   !> Multiplications in the time that a panel takes for each mode of a structure
   real(wp), parameter :: work_of_mode = 300.0_wp

contains

   !> March through an impact. Each trial of a panel ends in one of these ways:
   !>
   !> not solved: an equation has no solution, or the panel only showed where the contact ends.
   !> Another
   !>    step is chosen
   !>
   !> refused: it adds more to the difference of the two solutions than a panel may. Shorter
   !>
   !> rising: in the rebound t1 seems to rise, as where the contact grows again. Halved, since a
   !>    polynomial may rise where t1 does not; what still rises after `most_halvings` does, and
   !>    the march ends there, with the reason
   !>
   !> not complete: the sums of exponentials do not hold for so long. The march begins again with
   !> others
   !>
   !> over: the sphere rests or sticks, or the computation ends in contact
   !>
   !> ends: the contact has ended, and the errors are known. Otherwise the march goes on
   subroutine follow(rules, bridge, impact, sums, accuracy, share, time_scale, end_time, window, &
                     trajectory, errors, complete, error)
      !> Rules of the two solutions
      type(rule_t), intent(in), target :: rules(2)
      type(bridge_t), intent(in), target :: bridge
      type(impact_t), intent(in), target :: impact
      type(sums_t), intent(in), target :: sums
      !> Accuracy wanted of the coefficient of restitution, and the share of it that a panel may add
      !> to the difference of the two solutions
      real(wp), intent(in) :: accuracy, share
      !> Time scale of the contact [s]
      real(wp), intent(in) :: time_scale
      !> End of the computation if the contact lasts [s]
      real(wp), intent(in) :: end_time
      !> Time up to which the sums hold [s]
      real(wp), intent(in) :: window
      type(trajectory_t), intent(out) :: trajectory
      !> Errors of the results by the march, see `vcor_solver_ive_errors`
      real(wp), intent(out) :: errors(4)
      !> Whether the window was long enough
      logical, intent(out) :: complete
      type(error_t), allocatable, intent(out) :: error

      type(progress_t) :: progress
      type(approach_t), target :: approach
      real(wp) :: work
      integer :: trial
      logical :: over, solved

      errors = 0.0_wp
      complete = .true.
      call start(progress, rules, bridge, impact, sums, approach, accuracy, share, time_scale, &
         end_time)
      call progress%begin(trajectory)
      work = 0.0_wp
      if (allocated(sums%vibration)) work = work_of_mode*real(size(sums%vibration%square), wp)
      do trial = 1, most_panels
         ! a contact that takes so many panels lasts: product integration follows it in less time
         if (real(trial, wp)*work > direct_most_work) exit
         call choose_step(progress)
         if (.not. progress%step%duration > epsilon(1.0_wp)*progress%fine%start%time) exit
         call solve_step(progress, solved)
         if (.not. solved) cycle
         call find_excess(progress, trajectory)
         if (is_refused(progress)) then
            call shorten(progress)
            cycle
         end if
         if (progress%fine%recedes) then
            if (is_rising(progress)) then
               if (progress%control%growths == 0) &
                  progress%control%growth_end = progress%fine%start%time + progress%step%duration
               progress%control%growths = progress%control%growths + 1
               if (progress%control%growths > most_halvings) then
                  call stop_growing(progress, trajectory, error)
                  return
               end if
               call halve(progress)
               cycle
            end if
         end if
         call accept(progress, trajectory)
         complete = .not. progress%fine%start%time > window
         if (.not. complete) return
         call trajectory%stop_at_rest(impact, progress%reaches_end_time, over)
         if (over .or. progress%reaches_end_time) return
         if (progress%ends) then
            trajectory%status = contact_separated
            errors = progress%last_errors
            call add_ringing(progress, trajectory, errors)
            if (allocated(sums%vibration)) call judge_separation(progress%fine, trajectory)
            return
         end if
         call go_on(progress)
      end do
      call trajectory%stop_at_rest(impact, .true., over)
      if (over) return
      call raise_no_end(progress, error)
   end subroutine follow

   !> Start at first contact
   subroutine start(self, rules, bridge, impact, sums, approach, accuracy, share, time_scale, &
                    end_time)
      type(progress_t), intent(out) :: self
      type(rule_t), intent(in), target :: rules(2)
      type(bridge_t), intent(in), target :: bridge
      type(impact_t), intent(in), target :: impact
      type(sums_t), intent(in), target :: sums
      type(approach_t), intent(inout), target :: approach
      real(wp), intent(in) :: accuracy, share, time_scale, end_time

      real(wp) :: floor

      self%time_scale = time_scale
      self%end_time = end_time
      self%speed = impact%speed_scale(time_scale)
      ! relative to `speed`: v0 may be near zero for a sphere that is put down
      self%control%accuracy = max(accuracy*(impact%velocity/self%speed), &
         min(accuracy, finest_accuracy))
      ! the noise of moduli of both signs must not be resolved
      floor = 0.0_wp
      if (any(sums%contact%moduli < 0.0_wp)) floor = sums%contact%error
      self%control%tolerance = max(ive_share*share*self%control%accuracy, floor, &
         ive_rounding_per_panel)
      self%bridge => bridge
      call start_motion(self%fine, rules(1))
      call start_motion(self%coarse, rules(2))
      self%control%length = first_length(self, impact%law%contact_time*time_scale)
      call resolve_modes()
      if (allocated(sums%vibration)) call self%ringing%begin(impact, sums%vibration, &
         time_scale, self%control%tolerance*self%speed)

   contains

      !> Shorten the first panel, until those of the modes that settle within it, which it does not
      !> resolve, matter little. A mode settles at the time 1/l, after an impulse of G u(v/l)/l
      subroutine resolve_modes()

         real(wp) :: missed(size(sums%contact%rates))

         associate (g => sums%contact%moduli, l => sums%contact%rates)
            missed = abs(g)*impact%law%u(self%speed/l)/(l*impact%mass*self%speed)
            do while (sum(missed, l*self%control%length > real(rules(1)%stages, wp)) &
                      > ive_settling*self%control%tolerance)
               self%control%length = ive_safety*self%control%length
            end do
         end associate
      end subroutine resolve_modes

      !> Start one of the two solutions
      subroutine start_motion(motion, rule)
         type(motion_t), intent(inout) :: motion
         type(rule_t), intent(in), target :: rule

         motion%impact => impact
         motion%sums => sums
         motion%rule => rule
         motion%approach => approach
         ! at least rounding in products with a matrix
         motion%tolerance = max(width**2*epsilon(1.0_wp), ive_leftover*self%control%tolerance)
         associate (now => motion%start)
            now%alpha = impact%target%alpha(0.0_wp)
            now%force = impact%first_force()
            if (allocated(sums%vibration)) then
               now%modes = sums%vibration%at_rest()
               ! a flexibility takes up the velocity at first
               if (sums%vibration%residual > 0.0_wp) now%force = 0.0_wp
            end if
            now%velocity = impact%velocity - now%alpha*now%force
            allocate (now%lag(size(sums%contact%rates)), source=0.0_wp)
            if (impact%target%hereditary()) &
               allocate (now%plate_lag(size(sums%plate%rates)), source=0.0_wp)
         end associate
      end subroutine start_motion
   end subroutine start

   !> Length of the first panel of a motion that lasts for a time; half of it after a largest
   !> indentation
   pure function first_length(self, time) result(length)
      type(progress_t), intent(in) :: self
      !> Time [s]
      real(wp), intent(in) :: time
      !> Length [s]
      real(wp) :: length

      length = ive_first*time*self%control%tolerance**(1.0_wp/real(2*self%fine%rule%stages - 2, wp))
   end function first_length

   !> Choose the next step
   !>
   !> growing contact: the first panel is in the root of time, in which the motion is analytic, and
   !> so
   !>    is a long one, from t to 4 t, if modes of a continuous spectrum have settled by then or if
   !> the
   !>    contact recedes. Without such panels 109 random impacts take 1240 in place of 1118; if all
   !>    long panels are such, 1124
   !>
   !> receding contact: the panel that ends it is in the root of the time left, and those before
   !> keep
   !>    a distance from this branch point. The first one is in the root of its time if the kernel
   !> is
   !>    infinite at first or has a dashpot: without this the worst of these impacts errs by 2.3
   !> times
   !>    what is stated, not by 0.97
   subroutine choose_step(self)
      type(progress_t), intent(inout) :: self

      real(wp) :: part, doubled, allowed

      associate (step => self%step, time => self%fine%start%time)
         self%ends = .false.
         step%kind = linear
         allowed = longest(self, linear)
         self%control%length = min(self%control%length, allowed)
         step%duration = self%control%length
         if (self%fine%recedes) then
            allowed = longest(self, closing)
            self%control%end_length = min(self%control%end_length, allowed)
            self%ends = self%rest <= self%control%end_length
            if (self%ends) then
               step = step_t(closing, self%rest)
            else
               ! the end is a branch point, from which panels keep a distance
               part = min(ive_part, max(0.5_wp, 1.0_wp - self%control%end_length/self%rest))
               step%duration = min(self%control%length, part*self%rest)
               if (.not. time > self%fine%approach%end .and. is_fast(self)) step%kind = opening
            end if
         else
            if (time < self%control%lead) step%duration = min(self%control%length, &
               ive_part*(self%control%end_found - time))
            ! a doubling is tried where it may do without the safety of the length
            doubled = 3.0_wp*time
            if (.not. self%control%refused < huge(1.0_wp)) &
               doubled = ive_safety*(2.0_wp + ive_safety)*time
            if (.not. time > 0.0_wp) then
               allowed = longest(self, opening)
               step = step_t(opening, min(step%duration, allowed))
            else if (step%duration >= doubled .and. (has_settled(self) &
                     .or. self%fine%impact%law%receding)) then
               allowed = longest(self, doubling)
               if (allowed >= 3.0_wp*time) step = step_t(doubling, 3.0_wp*time)
            end if
         end if
         self%reaches_end_time = time + step%duration >= self%end_time
         if (.not. self%reaches_end_time) return
         self%ends = .false.
         step%duration = self%end_time - time
         if (any(step%kind == [doubling, closing])) step%kind = linear
      end associate
   end subroutine choose_step

   !> Longest panel of a map in which no ringing mode of a structure is missed
   function longest(self, kind) result(duration)
      type(progress_t), intent(inout) :: self
      !> The map
      integer, intent(in) :: kind
      !> Duration [s]
      real(wp) :: duration

      call self%ringing%limit(self%fine%rule, kind, self%control%tolerance*self%speed, duration)
   end function longest

   !> Whether modes of a continuous spectrum have settled since first contact: the motion goes on
   !> in the root of time
   pure function has_settled(self)
      type(progress_t), intent(in) :: self
      logical :: has_settled

      associate (contact => self%fine%sums%contact, time => self%fine%start%time)
         has_settled = contact%error > 0.0_wp &
            .and. any(contact%rates*time > real(self%fine%rule%stages, wp))
      end associate
   end function has_settled

   !> Whether the motion after the largest indentation begins with a root of time: the kernel is
   !> infinite at first or has a dashpot
   pure function is_fast(self)
      type(progress_t), intent(in) :: self
      logical :: is_fast

      associate (contact => self%fine%sums%contact)
         is_fast = contact%error > 0.0_wp .or. contact%viscosity > 0.0_wp
      end associate
   end function is_fast

   !> Solve the next panel twice; a panel that contains an event ends with it
   subroutine solve_step(self, solved)
      type(progress_t), intent(inout) :: self
      !> Whether there are two solutions; if not, another step is chosen
      logical, intent(out) :: solved

      associate (fine => self%fine)
         self%turns = .false.
         if (fine%recedes) then
            call solve_rebound(self, solved)
            if (.not. solved) return
         else
            call guess_growth(fine, self%previous, self%step)
            call solve_panel(fine, self%step, .true.)
            if (fine%panel%converged) call look_for_event(self)
         end if
         solved = fine%panel%converged
         if (solved) then
            self%previous = fine%panel
            self%step = fine%panel%step
            call solve_companion(self%coarse, fine, self%bridge)
            solved = self%coarse%panel%converged
         end if
         if (.not. solved) call halve(self)
      end associate
   end subroutine solve_step

   !> Look for the event in a panel while the contact grows, and cut it there
   subroutine look_for_event(self)
      type(progress_t), intent(inout) :: self

      ! time to an event after the panel, over its duration: with 0 and 0.3 109 random impacts take
      ! 1127 and 1114 panels (1118)
      real(wp), parameter :: soon = 0.15_wp
      real(wp) :: theta, time
      integer :: event, j
      logical :: found

      associate (fine => self%fine, panel => self%fine%panel, rule => self%fine%rule)
         if (fine%impact%law%receding) then
            call fine%find_velocity()
            j = findloc(panel%velocity(1:) < 0.0_wp, .true., 1)
            self%turns = j > 0
            if (self%turns) theta = rule%crossing(panel%velocity, j - 1, 1.0e-8_wp)
         else
            j = first_without_force(panel)
            self%ends = j > 0
            if (self%ends) then
               ! the panel is so crude that its force is negative while the indentation grows
               panel%converged = panel%force(j - 1) > 0.0_wp
               if (.not. panel%converged) return
               theta = rule%crossing(panel%force, j - 1, 1.0e-8_wp)
            end if
         end if
         event = merge(event_turn, event_end, fine%impact%law%receding)
         if (j > 0) then
            time = theta*(panel%map(1) + panel%map(2)*theta)
         else
            ! an event that follows soon belongs to this panel
            if (self%reaches_end_time .or. .not. fine%start%time > 0.0_wp &
                .or. self%control%refused < huge(1.0_wp)) return
            call time_to_event(fine, event, time, found)
            if (.not. found .or. .not. time > 0.0_wp .or. time > soon*panel%step%duration) return
            time = time + panel%step%duration
            self%turns = event == event_turn
            self%ends = event == event_end
         end if
         self%reaches_end_time = .false.
         call cut_at_event(fine, event, self%control%accuracy, time, found)
         panel%converged = found
      end associate
   end subroutine look_for_event

   !> Solve a panel of the rebound
   subroutine solve_rebound(self, solved)
      type(progress_t), intent(inout) :: self
      !> False if the panel only showed where the contact ends
      logical, intent(out) :: solved

      real(wp) :: theta
      integer :: j
      logical :: found

      solved = .true.
      associate (fine => self%fine, panel => self%fine%panel)
         call guess_rebound(fine, self%previous, self%step, self%rate, self%bend, self%ends)
         call solve_panel(fine, self%step, .true.)
         if (.not. panel%converged) return
         if (self%ends) then
            call cut_at_event(fine, event_close, self%control%accuracy, panel%step%duration, found)
            panel%converged = found
            if (found) self%rest = panel%step%duration
         else
            j = findloc(panel%condition(1:panel%stages) <= 0.0_wp, .true., 1)
            if (j == 0) return
            theta = fine%rule%crossing(panel%condition, j - 1, 1.0e-3_wp)
            self%rest = theta*(panel%map(1) + panel%map(2)*theta)
            self%previous = panel
            solved = .false.
         end if
      end associate
   end subroutine solve_rebound

   !> What the panel adds to the difference of the two solutions, over what it may add. In addition:
   !> the time of the end, the force where it is largest, and panels that hide an end
   subroutine find_excess(self, trajectory)
      type(progress_t), intent(inout) :: self
      type(trajectory_t), intent(in) :: trajectory

      real(wp) :: inherited
      logical :: found

      associate (fine => self%fine, impact => self%fine%impact)
         ! s is the small difference of large terms, such as g t^2/2: panels must not resolve its
         ! rounding
         self%control%tolerance = max(self%control%tolerance, ive_rounding_of_fall*0.5_wp &
            *impact%gravity*fine%start%time**2/(self%speed*self%time_scale))
         self%control%growth = self%motion_error()
         self%control%excess = self%control%growth/self%control%tolerance
         call fine%find_velocity()
         associate (coarse => self%coarse%panel)
            coarse%velocity(coarse%stages) = self%coarse%velocity_at(coarse%stages)
         end associate
         if (self%ends) then
            call self%find_ends(trajectory%max_force, found)
            if (found) then
               self%control%excess = max(self%control%excess, largest(errors_of_march(self, 0, &
                  trajectory%max_force), fine%panel%time(fine%panel%stages)) &
                  /self%control%accuracy)
            else
               self%control%excess = huge(1.0_wp)
            end if
         end if
         if (fine%recedes .and. self%step%kind == linear &
             .and. .not. fine%start%time > fine%approach%end) then
            self%missed = self%missed_velocity()
            self%control%excess = max(self%control%excess, self%missed/self%control%tolerance)
         end if
         self%control%excess = max(self%control%excess, self%ringing%added( &
            fine%rule%map(self%step%kind), fine%start%time, self%step%duration) &
            /(self%control%tolerance*self%speed))
         if (hides_an_end(self, trajectory%max_force)) self%control%excess = huge(1.0_wp)
         if (.not. self%control%excess >= 0.0_wp) self%control%excess = huge(1.0_wp)
         if (fine%recedes .or. is_refused(self)) return
         call self%find_peaks()
         ! the force where it is largest; elsewhere its errors are remainders of transients
         if (self%peaks%force > trajectory%max_force &
             .and. self%peaks%time_of_force < self%step%duration) then
            inherited = abs(fine%start%force - self%coarse%start%force)
            self%control%excess = max(self%control%excess, at_branch &
               *(self%peaks%force_difference - inherited)/(self%control%accuracy*self%peaks%force))
         end if
      end associate
   end subroutine find_excess

   !> Whether the contact may have ended unnoticed within the panel: a plate moves away from the
   !> sphere and is caught up with, or the force is zero between two stages, as of a sphere that its
   !> weight almost keeps in contact
   function hides_an_end(self, max_force) result(hides)
      !> The progress, its panel solved
      type(progress_t), intent(in) :: self
      !> Largest force so far [N]
      real(wp), intent(in) :: max_force
      logical :: hides

      real(wp) :: slope(0:width), theta
      integer :: j, n

      associate (panel => self%fine%panel, impact => self%fine%impact, rule => self%fine%rule)
         n = panel%stages
         hides = impact%may_part_unnoticed(panel%alpha(0), panel%alpha(n), panel%impulse(n), &
            panel%time(n))
         if (hides) return
         if (self%ends .or. impact%law%receding) return
         slope = rule%slopes(panel%force)
         do j = 1, panel%stages
            if (.not. (panel%force(j - 1) > 0.0_wp .and. panel%velocity(j - 1) < 0.0_wp &
                .and. slope(j - 1) < 0.0_wp .and. slope(j) > 0.0_wp)) cycle
            theta = rule%crossing(slope, j - 1, 1.0e-8_wp)
            hides = rule%interpolate(panel%force, theta) < -ive_rounding*max_force
            if (hides) return
         end do
      end associate
   end function hides_an_end

   !> Whether the panel is refused
   pure function is_refused(self)
      type(progress_t), intent(in) :: self
      logical :: is_refused

      is_refused = self%control%is_refused(self%ends, .not. self%fine%start%time > 0.0_wp)
   end function is_refused

   !> Shorten a panel that was refused
   subroutine shorten(self)
      type(progress_t), intent(inout) :: self

      call self%control%shorten(self%step%duration, self%fine%rule%stages, self%ends, &
         self%fine%start%time, self%fine%recedes, self%fine%impact%law%start_exponent)
   end subroutine shorten

   !> Halve a panel that cannot be solved
   subroutine halve(self)
      type(progress_t), intent(inout) :: self

      call self%control%halve(self%step%duration, self%fine%start%time)
   end subroutine halve

   !> Whether t1 rises somewhere in the panel: in both solutions, by more than the two differ
   pure function is_rising(self) result(rises)
      type(progress_t), intent(in) :: self
      logical :: rises

      real(wp), dimension(0:width) :: slope, other
      real(wp) :: fine, difference, least
      integer :: j, points

      associate (rule => self%fine%rule, coarse => self%coarse%rule)
         slope = rule%slopes(self%fine%panel%t1)
         other = coarse%slopes(self%coarse%panel%t1)
         ! at the end of the contact the map is stationary, and so is t1
         points = coarse%stages - merge(1, 0, self%ends)
         difference = 0.0_wp
         least = -huge(1.0_wp)
         do j = 1, points
            fine = rule%interpolate(slope, coarse%point(j))
            difference = max(difference, abs(fine - other(j)))
            least = max(least, min(fine, other(j)))
         end do
         rises = least > difference
      end associate
   end function is_rising

   !> Stop where a receding contact grows again
   subroutine stop_growing(self, trajectory, error)
      type(progress_t), intent(in) :: self
      type(trajectory_t), intent(inout) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      logical :: over

      if (self%fine%sums%contact%error > self%control%accuracy) then
         call raise(error, error_numerical, 'the contact seems to grow again before it has ' &
            //'ended, which may be the error of the sum of exponentials that represents the ' &
            //'material')
         return
      end if
      ! a contact that its weight makes grow again may not separate any more
      call trajectory%stop_at_rest(self%fine%impact, .true., over)
      if (over) return
      if (is_lost(self)) then
         call raise_no_end(self, error)
      else
         call refuse_growth(self%fine%impact, error)
      end if
   end subroutine stop_growing

   !> Whether a rebound has no force left: it is 1e-9 of its largest value
   pure function is_lost(self)
      type(progress_t), intent(in) :: self
      logical :: is_lost

      is_lost = self%fine%recedes
      ! before the rebound there is no t1
      if (is_lost) is_lost = self%fine%start%t1 < 1.0e-6_wp*self%fine%approach%end
   end function is_lost

   !> Say that the end of the contact is out of reach
   subroutine raise_no_end(self, error)
      type(progress_t), intent(in) :: self
      type(error_t), allocatable, intent(out) :: error

      if (is_lost(self)) then
         call raise(error, error_numerical, 'the force of this contact falls to zero so slowly ' &
            //'that its end is lost in rounding: the sphere keeps almost none of its velocity')
      else
         call raise(error, error_numerical, 'the internal-variable method does not reach the ' &
            //'end of the contact: the accuracy asked for is out of reach')
      end if
   end subroutine raise_no_end

   !> Accept the panel
   subroutine accept(self, trajectory)
      type(progress_t), intent(inout) :: self
      type(trajectory_t), intent(inout) :: trajectory

      self%control%refused = huge(1.0_wp)
      self%added = self%added + self%control%growth
      associate (fine => self%fine, panel => self%fine%panel)
         if (self%ends) then
            self%last_errors = errors_of_march(self, trajectory%steps + 1, trajectory%max_force)
            call self%end_without_force()
         end if
         call self%record(trajectory)
         call self%ringing%accept(fine%rule%map(self%step%kind), fine%start%time, &
            self%step%duration)
         if (.not. fine%recedes) call self%record_peaks(trajectory)
         if (fine%impact%law%receding .and. .not. fine%recedes) call fine%approach%add( &
            fine%rule, fine%sums%contact%rates, panel)
         call fine%advance()
         if (allocated(fine%sums%vibration)) then
            ! what the two differ by in fast modes would part them, however well these average out
            self%coarse%start = fine%start
         else
            call self%coarse%advance()
         end if
         ! panels that creep to the place where the contact grows have not passed it
         if (fine%start%time >= self%control%growth_end) self%control%growths = 0
      end associate
   end subroutine accept

   !> Choose the length of the next panel
   subroutine go_on(self)
      type(progress_t), intent(inout) :: self

      real(wp) :: factor

      associate (fine => self%fine, time => self%fine%start%time)
         factor = min(ive_growth, length_factor(max(self%control%excess, tiny(1.0_wp)), &
            real(2*fine%rule%stages - 2, wp)))
         self%control%length = factor*self%step%duration
         ! near first contact steps in sqrt(t) grow by this factor
         if (.not. fine%recedes) then
            if (self%step%kind == opening) &
               self%control%length = time*min(3.0_wp, factor*(2.0_wp + factor))
            if (self%step%kind == doubling) &
               self%control%length = time*factor*(1.0_wp + 0.25_wp*factor)
         end if
         if (self%turns) then
            call fine%turn()
            call self%coarse%turn()
            self%previous%stages = 0
            self%rate = -1.2_wp
            self%rest = fine%approach%end
            self%control%length = first_length(self, 4.0_wp*fine%approach%end)
            self%control%end_length = self%control%length
            if (is_fast(self)) self%control%end_length = 0.5_wp*self%control%length
         else if (fine%recedes) then
            call extrapolate(self)
         end if
      end associate
   end subroutine go_on

   !> Extrapolate t1 and the end of the contact by parabolas from the end of the panel. While the
   !> condition grows, the end is unknown
   subroutine extrapolate(self)
      type(progress_t), intent(inout) :: self

      real(wp) :: slope, bend

      associate (panel => self%fine%panel, rule => self%fine%rule, n => self%fine%panel%stages)
         call panel%end_rates(rule, panel%t1, self%rate, self%bend)
         ! t1'' decreases along the panel
         self%bend = 0.6_wp*self%bend
         call panel%end_rates(rule, panel%condition, slope, bend)
         self%rest = huge(1.0_wp)
         if (slope < 0.0_wp) self%rest = time_to_zero(panel%condition(n), slope, bend)
      end associate
   end subroutine extrapolate

end module vcor_solver_ive_march
