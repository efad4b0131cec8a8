!> Panels of the internal-variable method as a trajectory
module vcor_solver_recording
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, &
      contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : collocation_t, width
   use vcor_solver_collocator, only : advance, collocator_t, guess, improve, plate_velocity, &
      solve_step
   use vcor_solver_modes, only : modes_t, start_t
   use vcor_solver_panel, only : panel_t
   use vcor_solver_step, only : step_t, step_to
   implicit none
   private

   public :: forerunner_t
   public :: begin, append, record

   !> The panel before the one that is recorded
   type :: forerunner_t
      !> The panel; without stages if there is none
      type(panel_t) :: panel
      !> State at its start
      type(start_t) :: start
      !> Difference of its force from that of its companion, at its end [N]
      real(wp) :: doubt = 0.0_wp
   end type forerunner_t

contains

   !> First node of a trajectory
   subroutine begin(rule, impact, trajectory)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its course
      type(trajectory_t), intent(inout) :: trajectory

      integer, parameter :: usual_panels = 8

      call trajectory%reserve(usual_panels*rule%stages)
      trajectory%state(:, 0) = 0.0_wp
      trajectory%state(col_velocity, 0) = impact%velocity
      trajectory%state(col_sphere_velocity, 0) = impact%velocity
      trajectory%weight(0) = 0.0_wp
      trajectory%stages = rule%stages
      allocate (trajectory%point(0:rule%stages), source=rule%point(0:rule%stages))
      allocate (trajectory%barycentric(0:rule%stages), source=rule%barycentric(0:rule%stages))
   end subroutine begin

   !> Add a panel to the trajectory
   subroutine append(self, impact, modes, start, panel, doubt, before, accuracy, trajectory)
      !> The collocation
      type(collocator_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Difference of its force from that of its companion, at its end [N]
      real(wp), intent(in) :: doubt
      !> The panel before it
      type(forerunner_t), intent(in) :: before
      !> Wanted relative accuracy of the maxima
      real(wp), intent(in) :: accuracy
      !> The trajectory
      type(trajectory_t), intent(inout) :: trajectory

      call record(self%rule, impact, panel, trajectory)
      if (trajectory%status == contact_separated) return
      trajectory%last = trajectory%final
      call find_peaks(self, impact, modes, start, panel, doubt, before, accuracy, trajectory)
   end subroutine append

   !> Add the nodes of a panel to the trajectory
   subroutine record(rule, impact, panel, trajectory)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The impact
      type(impact_t), intent(in) :: impact
      !> The panel
      type(panel_t), intent(in) :: panel
      !> The trajectory
      type(trajectory_t), intent(inout) :: trajectory

      integer :: n, first, j

      n = panel%stages
      call trajectory%reserve(trajectory%final + n)
      call trajectory%add_map(panel%map)
      first = trajectory%final + 1
      trajectory%final = trajectory%final + n
      trajectory%steps = trajectory%steps + 1
      trajectory%weight(first:trajectory%final) = rule%weight(1:n) &
         *(panel%map(1) + 2.0_wp*panel%map(2)*rule%node(1:n))
      do j = 1, n
         associate (state => trajectory%state(:, first + j - 1))
            state(col_time) = panel%time(j)
            state(col_indentation) = panel%indentation(j)
            state(col_force) = panel%force(j)
            state(col_impulse) = panel%impulse(j)
            state(col_sphere) = impact%velocity*panel%time(j) &
               - panel%second_impulse(j)/impact%mass
            state(col_sphere_velocity) = impact%velocity - panel%impulse(j)/impact%mass
            state(col_plate) = state(col_sphere) - panel%indentation(j)
            state(col_plate_velocity) = plate_velocity(impact, panel, j)
            state(col_velocity) = state(col_sphere_velocity) - state(col_plate_velocity)
         end associate
      end do
   end subroutine record

   !> Largest indentation and force so far
   subroutine find_peaks(self, impact, modes, start, panel, doubt, before, accuracy, trajectory)
      !> The collocation
      type(collocator_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Difference of its force from that of its companion, at its end [N]
      real(wp), intent(in) :: doubt
      !> The panel before it
      type(forerunner_t), intent(in) :: before
      !> Wanted relative accuracy of the maxima
      real(wp), intent(in) :: accuracy
      !> The trajectory, the panel added
      type(trajectory_t), intent(inout) :: trajectory

      integer :: n

      n = panel%stages
      call look_for_peak(panel%indentation, .true., &
         trajectory%max_indentation, trajectory%time_of_max_indentation)
      call look_for_peak(panel%force, .false., trajectory%max_force, &
         trajectory%time_of_max_force)

   contains

      !> Larger value in the panel than so far, if there is one
      subroutine look_for_peak(value, of_indentation, largest, time)
         !> Values at the points of the panel
         real(wp), intent(in) :: value(0:width)
         !> Whether they are those of the indentation, otherwise of the force
         logical, intent(in) :: of_indentation
         !> Largest value so far
         real(wp), intent(inout) :: largest
         !> Its time [s]
         real(wp), intent(inout) :: time

         ! slope by theta at the end, over the value, of a panel that ends at its maximum
         real(wp), parameter :: flat = 1.0e-6_wp
         real(wp) :: peak, peak_time, slope
         integer :: j, other

         ! a maximum is next to the largest of the values, on the side to which they rise there
         j = maxloc(value(0:n), 1) - 1
         slope = sum(self%rule%derivative(j, :)*value)
         other = j + merge(1, -1, slope > 0.0_wp)
         if (other >= 0 .and. other <= n .and. abs(slope) > flat*value(j)) then
            call find_peak(self%rule%slopes(value), min(j, other), of_indentation, peak, peak_time)
         else
            peak = value(j)
            peak_time = panel%time(j)
         end if
         if (.not. (peak > largest .or. value(0) >= largest)) return
         ! where it rises up to the end of the panel, the end is none yet
         if (.not. of_indentation .and. peak_time < panel%time(n)) &
            call refine_force(peak, peak_time)
         largest = peak
         time = peak_time
      end subroutine look_for_peak

      !> Largest force anew with the panel halved that decides it, where it is not accurate enough.
      !> The force of modes that settle at once follows the rate of u, and that is the derivative of
      !> a polynomial: the impulse hardly feels its error but the force does, next to the start of a
      !> panel still that of the panel before. And a panel in t that begins next to the branch point
      !> at t = 0 has an error of rho^-2n, rho = (sqrt(b) + sqrt(a))/(sqrt(b) - sqrt(a)) from a to b
      subroutine refine_force(peak, time)
         !> Largest force [N]
         real(wp), intent(inout) :: peak
         !> Its time [s]
         real(wp), intent(in) :: time

         ! the solution is better than its companion by these factors, measured over 180 impacts: at
         ! the start of a panel the force is that of a whole panel, at the maximum that of a part
         real(wp), parameter :: better = 3.0_wp, better_inside = 12.0_wp
         ! share of a panel in which the force may be that of the panel before
         real(wp), parameter :: next_to_start = 0.1_wp
         type(start_t) :: now
         type(panel_t) :: last
         real(wp) :: root, branch
         logical :: early

         early = before%panel%stages > 0 .and. before%doubt > better*accuracy*peak &
            .and. time - start%time < next_to_start*(panel%time(n) - start%time)
         if (early) then
            now = before%start
            last = before%panel
            call solve_halves(start%time, now, last)
            if (last%converged .and. time > start%time) &
               call solve_to(step_to(now%time, time - now%time), now, last)
         else
            root = sqrt(start%time/time)
            branch = 0.0_wp
            if (root > 0.0_wp) branch = ((1.0_wp - root)/(1.0_wp + root))**(2*n)
            if (max(doubt/(better_inside*peak), branch) <= accuracy) return
            now = start
            last = panel
            call solve_halves(time, now, last)
         end if
         if (last%converged) peak = last%force(n)
      end subroutine refine_force

      !> Go on to a time by two panels: halves in x from first contact, otherwise in time
      subroutine solve_halves(time, now, last)
         !> The time [s]
         real(wp), intent(in) :: time
         !> State at the start, on return that at the end
         type(start_t), intent(inout) :: now
         !> A panel next to the start, on return that at the end; not converged on failure
         type(panel_t), intent(inout) :: last

         type(step_t) :: step

         step = step_to(now%time, merge(0.5_wp, 0.25_wp, now%time > 0.0_wp)*(time - now%time))
         call solve_to(step, now, last)
         if (.not. last%converged) return
         if (step%index == 0) then
            step%index = 1
         else
            step = step_to(now%time, time - now%time)
         end if
         call solve_to(step, now, last)
      end subroutine solve_halves

      !> Go on by one panel
      subroutine solve_to(step, now, last)
         !> The step
         type(step_t), intent(in) :: step
         !> State at its start, on return that at its end
         type(start_t), intent(inout) :: now
         !> A panel next to it, on return its own; not converged on failure
         type(panel_t), intent(inout) :: last

         type(panel_t) :: next
         real(wp) :: inverse(width, width)

         call guess(self%rule, impact, last, now, step, next)
         call solve_step(self, step, impact, modes, now, next, inverse)
         if (next%converged) call advance(self%rule, step, modes, next, now)
         last = next
      end subroutine solve_to

      !> Maximum inside the panel, by improving the panel up to there: the polynomials of the panel
      !> are less accurate inside of it than at its end
      subroutine find_peak(slope, before, of_indentation, peak, time)
         !> Derivative by theta at the points of the panel
         real(wp), intent(in) :: slope(0:width)
         !> Point before it
         integer, intent(in) :: before
         !> Whether it is that of the indentation, otherwise of the force
         logical, intent(in) :: of_indentation
         !> Maximum
         real(wp), intent(out) :: peak
         !> Its time [s]
         real(wp), intent(out) :: time

         ! its square is what the maximum feels
         real(wp), parameter :: tolerance = 1.0e-6_wp
         type(panel_t) :: cut
         type(step_t) :: step
         real(wp) :: theta

         theta = self%rule%crossing(slope, self%rule%point(before), self%rule%point(before + 1), &
            tolerance)
         time = theta*(panel%map(1) + panel%map(2)*theta)
         step = step_to(start%time, time)
         call guess(self%rule, impact, panel, start, step, cut)
         call improve(self, step, impact, modes, start, accuracy, cut)
         if (cut%converged) then
            peak = merge(cut%indentation(n), cut%force(n), of_indentation)
         else if (of_indentation) then
            peak = self%rule%interpolate(panel%indentation, theta)
         else
            peak = self%rule%interpolate(panel%force, theta)
         end if
         time = start%time + time
      end subroutine find_peak
   end subroutine find_peaks

end module vcor_solver_recording
