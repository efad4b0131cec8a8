!> Rebound of a receding contact in the internal-variable method, from the largest indentation on
!>
!> Near the end at t0 the force goes to zero as u(t0 - t), and the motion is analytic in
!> sqrt(t0 - t). So the last panel has the map t = t0 - D (1 - theta)^2, and its length D is found
!> such that the condition N is zero at its end. Before it come as many panels in t as the accuracy
!> requires. For a kernel that is infinite at first, or has a dashpot, the first of them is in the
!> square root of the time since the largest indentation.
module vcor_solver_ive_rebound
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_trajectory, only : contact_separated, refuse_growth, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : width
   use vcor_numeric_radau_collocation, only : closing, linear
   use vcor_solver_ive_approach, only : approach_t
   use vcor_solver_ive_course, only : course_t, share
   use vcor_solver_ive_newton, only : close_contact, solve, solve_companion
   use vcor_solver_ive_panel, only : step_of
   use vcor_tuning, only : aim, bend_kept, close_to_zero, closest_end, cut_least, &
      end_continuous, end_fast, end_growth, end_hereditary, end_hereditary_growth, end_slow, &
      expected_rebound, farthest_rebound, fast, first_rate, largest_share, &
      margin_of_rest, most_rebound_panels, near_vertex, order_at_end, panel_share, &
      rebound_fast, rebound_growth, rebound_hereditary, rebound_slow, roughly, rounding_per_panel, &
      slowest_fall, smallest_share, sure_growth, &
      tolerable, usual_accuracy
   implicit none
   private

   public :: follow_rebound

   !> Integration of the rebound
   type, extends(course_t) :: rebound_t
      type(approach_t), pointer :: approach => null()
      !> Index of the map of the next panel, unless it is the last one
      integer :: kind = linear
      !> Duration allowed for such a panel, and for the last one [s]
      real(wp) :: length = 0.0_wp, end_length = 0.0_wp
      !> Duration of the panel, and time left to the end of the contact [s]
      real(wp) :: taken = 0.0_wp, rest = 0.0_wp
      !> End of the contact, once it has been found [s]
      real(wp) :: end_found = 0.0_wp
      !> t1' [-] and t1'' [1/s], for a guess
      real(wp) :: rate = 0.0_wp, bend = 0.0_wp
      !> Length of the panel refused before [s]
      real(wp) :: refused_length = huge(1.0_wp)
      !> Duration of the longest panel in which t1 rises, and its end [s]
      real(wp) :: longest_growing = 0.0_wp, growing_until = 0.0_wp
      !> Whether the panel only showed where the contact ends
      logical :: only_finds_end = .false.
      !> Errors of the coefficients of restitution, by the relative velocity and of the sphere:
      !> contribution of the panel, and sum of those before [-]
      real(wp) :: error(2) = 0.0_wp, error_sum(2) = 0.0_wp
   end type rebound_t

contains

   !> Integrate the rebound
   subroutine follow_rebound(course, approach, trajectory, error)
      !> The integration up to the largest indentation
      type(course_t), intent(in) :: course
      type(approach_t), intent(in), target :: approach
      !> Trajectory, on entry the approach
      type(trajectory_t), intent(inout) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      ! t1 over the time of the approach: the force is 1e-9 of its largest value
      real(wp), parameter :: lost = 1.0e-6_wp
      type(rebound_t) :: rebound
      integer :: trial
      logical :: over

      rebound%course_t = course
      call start(rebound, approach)
      do trial = 1, most_rebound_panels
         call choose_length(rebound)
         if (.not. rebound%taken > epsilon(1.0_wp)*rebound%start%time) exit
         call solve_panel(rebound)
         if (rebound%only_finds_end) cycle
         if (.not. (rebound%panel%converged .and. rebound%coarse%converged)) then
            rebound%length = 0.5_wp*min(rebound%taken, rebound%rest)
            rebound%end_length = min(rebound%end_length, rebound%length)
            cycle
         end if
         call judge(rebound)
         if (is_refused(rebound)) then
            call shorten(rebound)
            cycle
         end if
         rebound%refused = huge(1.0_wp)
         rebound%refused_length = huge(1.0_wp)
         if (is_growing(rebound)) then
            if (is_crude(rebound)) then
               call halve(rebound)
               cycle
            end if
            if (rebound%problem%modes%contact%error > rebound%accuracy) then
               call raise(error, error_numerical, 'the contact seems to grow again before it ' &
                  //'has ended, which may be the error of the sum of exponentials that stands ' &
                  //'for the material')
               return
            end if
            ! a contact that its weight makes grow again may not separate any more
            call trajectory%stop_at_rest(rebound%problem%impact, .true., over)
            if (over) return
            if (rebound%start%t1 < lost*approach%end) exit
            call refuse_growth(rebound%problem%impact, error)
            return
         end if
         call accept(rebound, trajectory)
         call stop_at_end(rebound, trajectory, over)
         if (over) return
         call go_on(rebound)
      end do
      if (rebound%start%t1 < lost*approach%end) then
         call raise(error, error_numerical, 'the force of this contact creeps to zero so slowly ' &
            //'that its end is lost in rounding: next to nothing of the velocity comes back')
         return
      end if
      call raise(error, error_numerical, 'the internal-variable method does not get to the end ' &
         //'of the contact: the accuracy asked for is out of reach')
   end subroutine follow_rebound

   !> Choose initial lengths of the first panel, of the last one and of the whole rebound
   subroutine start(self, approach)
      type(rebound_t), intent(inout) :: self
      type(approach_t), intent(in), target :: approach

      real(wp) :: finer
      logical :: relaxes, continuous

      self%approach => approach
      call self%problem%begin_rebound(approach, self%start)
      self%previous%stages = 0
      self%refused = huge(1.0_wp)
      associate (contact => self%problem%modes%contact, time => approach%end)
         continuous = contact%error > 0.0_wp
         if (continuous .or. contact%viscosity > 0.0_wp) self%kind = 0
         relaxes = any(contact%rates*time > fast)
         finer = self%accuracy/usual_accuracy
         self%rate = first_rate
         self%rest = expected_rebound*time
         self%length = merge(rebound_fast, rebound_slow, relaxes)*time*finer**rebound_growth
         self%end_length = merge(end_fast, end_slow, relaxes)*time*finer**end_growth
         ! collocation does not resolve the modes of a continuous spectrum, of contact or plate,
         ! that settle near the end of a panel
         if (continuous) self%end_length = end_continuous*time*finer**end_growth
         if (continuous .and. self%problem%impact%plate%hereditary()) then
            self%length = rebound_hereditary*time*finer**rebound_growth
            self%end_length = end_hereditary*time*finer**end_hereditary_growth
         end if
      end associate
   end subroutine start

   !> Choose the duration of the next panel. The end is a branch point, from which panels keep a
   !> distance: equal shares of the remaining time lead to the length of the last panel
   subroutine choose_length(self)
      type(rebound_t), intent(inout) :: self

      real(wp) :: part, left
      integer :: panels

      if (self%end_found > self%start%time) self%rest = self%end_found - self%start%time
      self%ends = self%rest <= self%end_length
      self%taken = self%rest
      if (.not. self%ends) then
         part = largest_share
         left = margin_of_rest*self%end_length/self%rest
         if (left > 0.0_wp) then
            panels = ceiling(log(left)/log(1.0_wp - largest_share))
            part = max(smallest_share, 1.0_wp - left**(1.0_wp/real(panels, wp)))
         end if
         self%taken = min(self%length, part*self%rest)
      end if
      self%reaches_end_time = self%start%time + self%taken >= self%end_time
      if (self%reaches_end_time) then
         self%ends = .false.
         self%taken = self%end_time - self%start%time
      end if
   end subroutine choose_length

   !> Solve the next panel and its companion
   subroutine solve_panel(self)
      type(rebound_t), intent(inout) :: self

      real(wp) :: theta
      integer :: n, j

      self%only_finds_end = .false.
      self%coarse%converged = .false.
      associate (problem => self%problem, rule => self%problem%collocator%rule, &
                 panel => self%panel)
         n = rule%stages
         self%step = step_of(merge(closing, self%kind, self%ends), self%taken)
         call guess(self)
         if (self%ends) then
            call close_contact(problem, self%start, closest_end*min(self%accuracy, &
               usual_accuracy), self%taken, panel, self%inverse)
            self%step = step_of(closing, self%taken)
         else
            call solve(problem, rule, self%step, self%start, panel, self%inverse)
         end if
         if (.not. panel%converged) return
         self%previous = panel
         if (self%ends) then
            ! a condition near zero may be rounding: at the end t1 must be near zero, too
            panel%converged = abs(panel%t1(n)) <= close_to_zero*self%start%t1
            if (.not. panel%converged) return
            self%end_found = self%start%time + self%taken
            self%only_finds_end = self%end_found > self%end_time
         else if (panel%condition(n) <= 0.0_wp) then
            ! the end is closer than expected
            j = findloc(panel%condition(1:n) <= 0.0_wp, .true., 1)
            theta = rule%crossing(panel%condition, rule%point(j - 1), rule%point(j), roughly)
            self%rest = theta*(panel%map(1) + panel%map(2)*theta)
            self%refused = huge(1.0_wp)
            self%refused_length = huge(1.0_wp)
            self%only_finds_end = .true.
         end if
         if (self%only_finds_end) return
         call solve_companion(problem, self%step, self%start, panel, self%inverse, self%coarse)
      end associate
   end subroutine solve_panel

   !> Guess t1 in the next panel
   subroutine guess(self)
      type(rebound_t), intent(inout) :: self

      real(wp), dimension(width) :: theta, time

      associate (t1 => self%panel%t1(1:), start => self%start, vertex => self%approach%end, &
                 rule => self%problem%collocator%rule)
         time = rule%times(self%step%index, self%step%map_scale())
         t1 = start%t1 + time*(self%rate + 0.5_wp*self%bend*time)
         ! t1 is zero at the end of the contact
         if (self%ends) t1 = t1 - (start%t1 &
            + self%taken*(self%rate + 0.5_wp*self%bend*self%taken))*(time/self%taken)**2
         if (self%previous%stages > 0) then
            theta = self%previous%theta(start%time + time)
            t1 = merge(rule%extend(self%previous%t1, min(theta, farthest_rebound)), t1, &
               theta <= farthest_rebound)
         end if
         ! near the largest indentation t1 falls at least half as fast as time grows
         t1 = min(t1, vertex - slowest_fall*min(start%time + time - vertex, near_vertex*vertex))
      end associate
   end subroutine guess

   !> Error of the panel over the allowed one: of the motion, and of the contact time
   subroutine judge(self)
      type(rebound_t), intent(inout) :: self

      real(wp) :: part, alpha_rate, impulse_error, time_error
      integer :: n

      n = self%panel%stages
      associate (panel => self%panel, coarse => self%coarse, impact => self%problem%impact)
         alpha_rate = self%alpha_rate()
         impulse_error = abs(panel%impulse(n) - coarse%impulse(n - 1))
         part = 1.0_wp/self%improvement()
         self%error = part*(impulse_error/impact%mass &
            + abs(panel%indentation(n) - coarse%indentation(n - 1))/self%start%t1)/impact%velocity
         self%error(1) = self%error(1) + part*(impulse_error*alpha_rate &
            + abs(panel%drift(n) - coarse%drift(n - 1)))/impact%velocity
         time_error = 0.0_wp
         if (self%ends) then
            ! the companion ends slightly earlier or later: weight and plate change the velocities
            time_error = abs(panel%condition(n) - coarse%condition(n - 1))/self%start%condition &
               *self%taken
            self%error = self%error + time_error*impact%gravity/impact%velocity
            self%error(1) = self%error(1) + time_error*(self%plate_gains() &
               + abs((panel%drift(n) - panel%drift(n - 1))/(panel%time(n) - panel%time(n - 1)))) &
               /impact%velocity
         else if (self%rest < self%end_time) then
            ! extrapolated linearly to the end
            time_error = max(0.0_wp, abs(panel%condition(n) - coarse%condition(n - 1)) &
               - self%problem%noise*self%problem%largest_condition)/panel%condition(n) &
               *max(0.0_wp, self%rest - self%taken)
         end if
         self%excess = max(self%motion_error()/(panel_share*self%accuracy), &
            share(time_error, panel%time(n)*self%time_tolerance()))
         if (self%ends) self%excess = max(self%excess, self%error(1)/self%accuracy)
      end associate
   end subroutine judge

   !> Whether the panel is refused
   pure function is_refused(self)
      type(rebound_t), intent(in) :: self
      logical :: is_refused

      ! an error that half the panel does not halve is inherited, or rounding in stiff internal
      ! variables
      is_refused = .not. (self%excess <= 1.0_wp .or. self%excess <= tolerable &
         .and. is_half_of_refused(self) .and. self%excess > 0.5_wp*self%refused)
      if (is_refused .and. self%ends) is_refused = .not. self%is_best_end()
   end function is_refused

   !> Whether the panel is at most half as long as the one refused before
   pure function is_half_of_refused(self) result(is_half)
      type(rebound_t), intent(in) :: self
      logical :: is_half

      is_half = self%taken <= 0.5_wp*self%refused_length
   end function is_half_of_refused

   !> Shorten the next panel after a refusal
   subroutine shorten(self)
      type(rebound_t), intent(inout) :: self

      real(wp) :: order

      if (is_half_of_refused(self)) then
         self%refused = self%excess
         self%refused_length = self%taken
      end if
      order = real(2*self%panel%stages - 2, wp)
      if (self%ends) order = order_at_end
      associate (length => self%taken*min(cut_least, (self%excess/aim)**(-1.0_wp/order)))
         if (self%ends) then
            self%refused_end = self%excess
            self%refused_ends = self%refused_ends + 1
            self%end_length = length
         else
            self%length = length
         end if
      end associate
   end subroutine shorten

   !> Whether t1 rises somewhere in the panel: its slope is positive in the solution and in the
   !> companion, by more than the two differ anywhere in the panel
   pure function is_growing(self) result(grows)
      type(rebound_t), intent(in) :: self
      logical :: grows

      real(wp), dimension(0:width) :: slope, bend, other
      real(wp) :: same(width), theta, difference
      integer :: n, j, points

      associate (collocator => self%problem%collocator, rule => self%problem%collocator%rule)
         n = rule%stages
         slope = rule%slopes(self%panel%t1)
         other = collocator%coarse%slopes(self%coarse%t1)
         same = collocator%coarsened(slope)
         ! at the end of the contact the map is stationary, and so is t1
         points = merge(n - 2, n - 1, self%ends)
         difference = maxval(abs(same(1:points) - other(1:points)))
         grows = any(min(same(1:points), other(1:points)) > difference)
         ! check the largest slope between the points, too
         j = maxloc(slope(0:n), 1) - 1
         if (grows .or. j == 0 .or. j == n) return
         bend = rule%slopes(slope)
         if (bend(j) < 0.0_wp) j = j - 1
         theta = rule%crossing(bend, rule%point(j), rule%point(j + 1), roughly)
         grows = min(rule%interpolate(slope, theta), &
            collocator%coarse%interpolate(other, theta)) > difference
      end associate
   end function is_growing

   !> Whether t1 may rise only because the panel is crude and has not been halved enough. A rise
   !> within a small part of the first such panel is real
   pure function is_crude(self)
      !> The rebound, t1 rising in its panel
      type(rebound_t), intent(in) :: self
      logical :: is_crude

      is_crude = self%taken > sure_growth*self%longest_growing
   end function is_crude

   !> Halve a panel in which t1 rises
   subroutine halve(self)
      type(rebound_t), intent(inout) :: self

      if (self%taken > self%longest_growing) then
         self%longest_growing = self%taken
         self%growing_until = self%start%time + self%taken
      end if
      self%length = 0.5_wp*self%taken
      self%end_length = min(self%end_length, self%length)
   end subroutine halve

   !> Accept the panel: add it to the trajectory
   subroutine accept(self, trajectory)
      type(rebound_t), intent(inout) :: self
      type(trajectory_t), intent(inout) :: trajectory

      if (self%ends) self%panel%force(self%panel%stages) = 0.0_wp
      if (self%start%time + self%taken >= self%growing_until) self%longest_growing = 0.0_wp
      self%error_sum = self%error_sum + self%error
      call self%record(self%panel, trajectory)
      trajectory%last = trajectory%final
   end subroutine accept

   !> Set the status if the contact ends with the panel
   subroutine stop_at_end(self, trajectory, over)
      type(rebound_t), intent(in) :: self
      type(trajectory_t), intent(inout) :: trajectory
      !> Whether the contact or the computation has ended
      logical, intent(out) :: over

      call trajectory%stop_at_rest(self%problem%impact, self%reaches_end_time, over)
      if (over) return
      over = self%reaches_end_time .or. self%ends
      if (self%ends) then
         trajectory%status = contact_separated
         trajectory%cor_error = self%error_sum(1) + 2*rounding_per_panel*real(trajectory%steps, wp)
         trajectory%cor_sphere_error = self%error_sum(2) &
            + 2*rounding_per_panel*real(trajectory%steps, wp)
      end if
   end subroutine stop_at_end

   !> Advance to the next panel, and extrapolate t1 and the end of the contact by parabolas from the
   !> end of this one. While the condition grows, the end is unknown
   subroutine go_on(self)
      type(rebound_t), intent(inout) :: self

      real(wp) :: fall, fall_rate

      associate (panel => self%panel, rule => self%problem%collocator%rule, n => self%panel%stages)
         call end_rates(panel%t1, self%rate, self%bend)
         ! t1'' decreases along the panel
         self%bend = bend_kept*self%bend
         call end_rates(panel%condition, fall, fall_rate)
         fall = -fall
         self%rest = huge(1.0_wp)
         if (fall > 0.0_wp) self%rest = 2.0_wp*panel%condition(n)/(fall &
            + sqrt(max(0.0_wp, fall**2 - 2.0_wp*panel%condition(n)*fall_rate)))
         call self%problem%advance(rule, self%step, panel, self%start)
      end associate
      self%kind = linear
      self%length = self%taken*self%growth_of_step()

   contains

      !> First and second time derivative of a value at the end of the panel
      subroutine end_rates(value, first, second)
         !> Values at the points of the panel
         real(wp), intent(in) :: value(0:width)
         !> First derivative
         real(wp), intent(out) :: first
         !> Second derivative
         real(wp), intent(out) :: second

         real(wp) :: slope(0:width)

         associate (rule => self%problem%collocator%rule, panel => self%panel)
            slope = rule%slopes(value)
            first = slope(panel%stages)/panel%pace_at_end()
            second = (sum(rule%derivative(panel%stages, :)*slope) - 2.0_wp*panel%map(2)*first) &
               /panel%pace_at_end()**2
         end associate
      end subroutine end_rates
   end subroutine go_on

end module vcor_solver_ive_rebound
