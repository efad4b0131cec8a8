!> Largest indentation and force of the internal-variable method, more accurate than its panels are
!> between their ends
module vcor_solver_ive_peaks
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : width
   use vcor_solver_ive_newton, only : guess, improve, solve
   use vcor_solver_ive_panel, only : panel_t, start_t, step_t, step_to
   use vcor_solver_ive_problem, only : panel_problem_t
   use vcor_tuning, only : force_better, force_unsure, peak_position
   implicit none
   private

   public :: earlier_panel_t, find_peaks

   !> The panel before the one being recorded
   type :: earlier_panel_t
      !> The panel; without stages if there is none
      type(panel_t) :: panel
      !> State at its start
      type(start_t) :: start
      !> Difference of its force to that of its companion at the end [N]
      real(wp) :: force_difference = 0.0_wp
   end type earlier_panel_t

contains

   !> Update the largest indentation and force
   subroutine find_peaks(problem, start, panel, force_difference, before, accuracy, trajectory)
      type(panel_problem_t), intent(in) :: problem
      type(start_t), intent(in) :: start
      type(panel_t), intent(in) :: panel
      !> Difference of its force to that of its companion at the end [N]
      real(wp), intent(in) :: force_difference
      !> The panel before
      type(earlier_panel_t), intent(in) :: before
      !> Wanted relative accuracy of the maxima
      real(wp), intent(in) :: accuracy
      !> The trajectory, the panel added
      type(trajectory_t), intent(inout) :: trajectory

      real(wp) :: peak, change, time
      !> Whether the force rose up to the start of the panel
      logical :: rises

      associate (n => panel%stages)
         call find_peak(problem, start, panel, panel%indentation, .true., accuracy, peak, change, &
            time)
         if (peak > trajectory%max_indentation &
             .or. trajectory%time_of_max_indentation >= panel%time(0)) then
            trajectory%max_indentation = peak
            trajectory%time_of_max_indentation = time
         end if
         call find_peak(problem, start, panel, panel%force, .false., accuracy, peak, change, time)
         rises = trajectory%time_of_max_force >= panel%time(0)
         ! a force that rises up to the end of the panel has no maximum in it
         if ((rises .or. peak > trajectory%max_force) .and. time > 0.0_wp &
             .and. time < panel%time(n)) call refine_force(problem, start, panel, &
            force_difference, before, accuracy, change, time, peak)
         if (rises .or. peak > trajectory%max_force) then
            trajectory%max_force = peak
            trajectory%time_of_max_force = time
         end if
      end associate
   end subroutine find_peaks

   !> Maximum in a panel, by solving the panel up to there: its polynomials are less accurate inside
   !> than at the end
   subroutine find_peak(problem, start, panel, value, of_indentation, accuracy, peak, change, time)
      type(panel_problem_t), intent(in) :: problem
      type(start_t), intent(in) :: start
      type(panel_t), intent(in) :: panel
      !> Values at the points of the panel
      real(wp), intent(in) :: value(0:width)
      !> Whether these are the indentation, otherwise the force
      logical, intent(in) :: of_indentation
      !> Wanted relative accuracy of the maximum
      real(wp), intent(in) :: accuracy
      !> Maximum
      real(wp), intent(out) :: peak
      !> Change of the maximum by the improvement
      real(wp), intent(out) :: change
      !> Time of the maximum [s]
      real(wp), intent(out) :: time

      type(panel_t) :: cut
      type(step_t) :: step
      real(wp) :: slope, bend, slopes(0:width), theta
      integer :: n, j, other, first

      n = panel%stages
      ! a maximum is next to the largest value, on the side to which the values rise
      j = maxloc(value(0:n), 1) - 1
      peak = value(j)
      change = 0.0_wp
      time = panel%time(j)
      associate (rule => problem%collocator%rule)
         slopes = rule%slopes(value)
         slope = slopes(j)
         other = j + merge(1, -1, slope > 0.0_wp)
         if (other < 0 .or. other > n) return
         bend = sum(rule%derivative(j, :)*slopes)
         if ((j == 0 .or. j == n) .and. 0.5_wp*slope**2 < -bend*accuracy*value(j)) then
            ! so close to the end of the panel that a parabola is accurate enough
            peak = peak - 0.5_wp*slope**2/bend
            time = time - slope/bend*(panel%map(1) + 2.0_wp*panel%map(2)*rule%point(j))
            return
         end if
         first = min(j, other)
         theta = rule%crossing(slopes, rule%point(first), rule%point(first + 1), &
            peak_position)
         time = theta*(panel%map(1) + panel%map(2)*theta)
         step = step_to(start%time, time)
         call guess(problem, panel, step, start, cut)
         call improve(problem, step, start, accuracy, cut)
         change = rule%interpolate(value, theta)
         peak = change
         if (cut%converged) peak = merge(cut%indentation(n), cut%force(n), of_indentation)
         change = abs(peak - change)
         time = start%time + time
      end associate
   end subroutine find_peak

   !> Compute the largest force again, with halved panels, if it may not be accurate enough. The
   !> difference to the force of the companion exceeds its error by far, so more of it is allowed if
   !> the improvement has changed little, the later the maximum is in the panel: the improvement
   !> does not see what the panel before has left, which fades along the panel. Forces of modes that
   !> settle at once follow the rate of u, the derivative of a polynomial: the impulse hardly feels
   !> its error, but the force does. And a panel in t that starts near the branch point at t = 0 has
   !> an error of rho^-2n, rho = (sqrt(b) + sqrt(a))/(sqrt(b) - sqrt(a)) from a to b
   subroutine refine_force(problem, start, panel, force_difference, before, accuracy, change, &
                           time, peak)
      type(panel_problem_t), intent(in) :: problem
      type(start_t), intent(in) :: start
      type(panel_t), intent(in) :: panel
      !> Difference of its force to that of its companion at the end [N]
      real(wp), intent(in) :: force_difference
      !> The panel before
      type(earlier_panel_t), intent(in) :: before
      !> Wanted relative accuracy
      real(wp), intent(in) :: accuracy
      !> Change of the largest force by the improvement [N]
      real(wp), intent(in) :: change
      !> Time of the largest force [s]
      real(wp), intent(in) :: time
      !> Largest force [N]
      real(wp), intent(inout) :: peak

      type(start_t) :: now
      type(panel_t) :: last
      real(wp) :: root, branch, part, here, allowed
      logical :: inherited

      associate (n => panel%stages)
         inherited = before%force_difference > force_better*accuracy*peak
         part = (time - start%time)/(panel%time(n) - start%time)
         here = force_difference
         if (inherited) here = before%force_difference**(1.0_wp - part)*force_difference**part
         root = sqrt(start%time/time)
         branch = 0.0_wp
         if (root > 0.0_wp) branch = ((1.0_wp - root)/(1.0_wp + root))**(2*n)
         allowed = accuracy
         if (.not. change > accuracy*peak) allowed = max(1.0_wp, force_unsure*part)*accuracy
         if (max(here/peak, branch) <= allowed) return
         now = start
         last = panel
         if (inherited) then
            now = before%start
            last = before%panel
            call solve_halves(problem, start%time, now, last)
         end if
         if (last%converged .and. time > start%time) call solve_halves(problem, time, now, last)
         if (last%converged) peak = last%force(n)
      end associate
   end subroutine refine_force

   !> Advance to a given time by two panels: halves in x from first contact, otherwise in t
   subroutine solve_halves(problem, time, now, last)
      type(panel_problem_t), intent(in) :: problem
      !> The time [s]
      real(wp), intent(in) :: time
      !> State at the start, on return at the given time
      type(start_t), intent(inout) :: now
      !> A neighbouring panel, on return the second one; not converged on failure
      type(panel_t), intent(inout) :: last

      type(step_t) :: step

      step = step_to(now%time, merge(0.5_wp, 0.25_wp, now%time > 0.0_wp)*(time - now%time))
      call solve_on(problem, step, now, last)
      if (.not. last%converged) return
      if (step%index == 0) then
         step%index = 1
      else
         step = step_to(now%time, time - now%time)
      end if
      call solve_on(problem, step, now, last)
   end subroutine solve_halves

   !> Advance by one panel
   subroutine solve_on(problem, step, now, last)
      type(panel_problem_t), intent(in) :: problem
      type(step_t), intent(in) :: step
      !> State at the start, on return at the end
      type(start_t), intent(inout) :: now
      !> A neighbouring panel, on return the one solved; not converged on failure
      type(panel_t), intent(inout) :: last

      type(panel_t) :: next
      real(wp) :: inverse(width, width)

      associate (rule => problem%collocator%rule)
         call guess(problem, last, step, now, next)
         call solve(problem, rule, step, now, next, inverse)
         if (next%converged) call problem%advance(rule, step, next, now)
      end associate
      last = next
   end subroutine solve_on

end module vcor_solver_ive_peaks
