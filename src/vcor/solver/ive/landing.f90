!> Finding the end of the contact, or of the approach, in the internal-variable method
!>
!> The panel that contains the end is solved again with lengths from Newton's method: for s' = 0 at
!> the end of the approach, and for kappa u(s) = M at the end of the contact, where F = kappa u - M.
!> For s and M are smooth in time where u(s) and F are not.
module vcor_solver_ive_landing
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : width
   use vcor_numeric_radau_collocation, only : collocation_t
   use vcor_solver_ive_newton, only : guess, solve, solve_near
   use vcor_solver_ive_panel, only : panel_t, start_t, step_t, step_to
   use vcor_solver_ive_problem, only : panel_problem_t
   use vcor_tuning, only : landing_share, most_iterations, peak_guess, roughly, &
      share_of_square
   implicit none
   private

   public :: first_without_force, hides_a_zero, land_on_zero, land_on_largest, end_at_zero, &
      slope_at_end

   !> Correction of a time, relative, that may be rounding
   real(wp), parameter :: rounding = sqrt(epsilon(1.0_wp))

contains

   !> First stage of a panel without force; 0 if there is none. While the indentation grows or is
   !> constant, the force is positive, and a force <= 0 is rounding
   pure function first_without_force(panel) result(stage)
      type(panel_t), intent(in) :: panel
      integer :: stage

      do stage = 1, panel%stages
         if (panel%force(stage) <= 0.0_wp &
             .and. panel%indentation(stage) < panel%indentation(stage - 1)) return
      end do
      stage = 0
   end function first_without_force

   !> Whether the force is zero between two stages but positive again at the second, as for a sphere
   !> that its weight almost keeps in contact: the panel is too long to show the end
   pure function hides_a_zero(rule, panel, noise) result(hides)
      type(collocation_t), intent(in) :: rule
      type(panel_t), intent(in) :: panel
      !> Rounding in the force [N]
      real(wp), intent(in) :: noise
      logical :: hides

      real(wp) :: slope(0:width), growth(0:width), lowest
      integer :: j

      hides = .false.
      slope = rule%slopes(panel%force)
      if (.not. any(slope(0:width - 1) < 0.0_wp .and. slope(1:) > 0.0_wp)) return
      growth = rule%slopes(panel%indentation)
      do j = 1, panel%stages
         if (.not. (panel%force(j - 1) > 0.0_wp .and. growth(j - 1) < 0.0_wp)) cycle
         if (.not. (slope(j - 1) < 0.0_wp .and. slope(j) > 0.0_wp)) cycle
         lowest = rule%crossing(slope, rule%point(j - 1), rule%point(j), rounding)
         hides = rule%interpolate(panel%force, lowest) < -noise
         if (hides) return
      end do
   end function hides_a_zero

   !> Cut a panel at the maximum of the indentation: first where the polynomial of the panel has it,
   !> then by Newton's method. Full accuracy is not needed: the two laws of the force differ only by
   !> the fourth power of the time since the maximum
   subroutine land_on_largest(problem, start, start_velocity, accuracy, step, panel, inverse)
      type(panel_problem_t), intent(in) :: problem
      type(start_t), intent(in) :: start
      !> Rate of the indentation at the start [m/s]
      real(wp), intent(in) :: start_velocity
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> The step, on return the one that ends at the maximum
      type(step_t), intent(inout) :: step
      !> The panel, on return the one that ends at the maximum; not converged on failure
      type(panel_t), intent(inout) :: panel
      !> Inverse of its Jacobian
      real(wp), intent(inout) :: inverse(width, width)

      ! length over that of the panel beyond which its polynomials are useless
      real(wp), parameter :: farthest = 2.0_wp
      type(panel_t) :: last
      type(step_t) :: whole
      real(wp) :: velocity(0:width), theta, time, fall
      integer :: j, iteration

      whole = step
      velocity = 0.0_wp
      velocity(0) = start_velocity
      call find_velocity()
      do j = 1, panel%stages - 1
         if (velocity(j) < 0.0_wp) exit
      end do
      associate (rule => problem%collocator%rule)
         theta = rule%crossing(velocity, rule%point(j - 1), rule%point(j), peak_guess)
         time = theta*(panel%map(1) + panel%map(2)*theta)
         do iteration = 1, most_iterations
            last = panel
            panel%converged = time <= farthest*whole%duration()
            if (.not. panel%converged) then
               step = whole
               return
            end if
            step = step_to(start%time, time)
            call solve_cut(problem, last, start, step, panel, inverse)
            if (.not. panel%converged) return
            call find_velocity()
            fall = -slope_at_end(rule, panel, velocity)
            ! on a plate that goes along, the velocity falls slowly: t1 does not fall before it is 0
            if (abs(velocity(panel%stages)) <= sqrt(accuracy)*min(problem%impact%velocity, &
                fall*time)) return
            panel%converged = fall > 0.0_wp .and. fall*time > -velocity(panel%stages)
            if (.not. panel%converged) return
            time = time + velocity(panel%stages)/fall
         end do
      end associate
      panel%converged = .false.

   contains

      !> Rate of the indentation at the stages
      subroutine find_velocity()

         integer :: stage

         do stage = 1, panel%stages
            velocity(stage) = problem%relative_velocity(panel, stage)
         end do
      end subroutine find_velocity
   end subroutine land_on_largest

   !> Solve a panel that is cut from a longer one
   subroutine solve_cut(problem, longer, start, step, panel, inverse)
      type(panel_problem_t), intent(in) :: problem
      !> The longer panel
      type(panel_t), intent(in) :: longer
      type(start_t), intent(in) :: start
      type(step_t), intent(in) :: step
      !> The panel; not converged on failure
      type(panel_t), intent(inout) :: panel
      !> Inverse of the Jacobian of the longer panel, on return of one that converges
      real(wp), intent(inout) :: inverse(width, width)

      associate (collocator => problem%collocator)
         call guess(problem, longer, step, start, panel)
         call solve_near(problem, collocator%rule, step, start, inverse, panel)
         if (panel%converged) return
         call guess(problem, longer, step, start, panel)
         call solve(problem, collocator%rule, step, start, panel, inverse)
      end associate
   end subroutine solve_cut

   !> Cut a panel in which the force changes sign at the zero of the force
   subroutine land_on_zero(problem, start, accuracy, shallow, step, panel, inverse)
      type(panel_problem_t), intent(in) :: problem
      type(start_t), intent(in) :: start
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Indentation above which the force is about linear in time near its zero [m]
      real(wp), intent(in) :: shallow
      !> The step, on return the one that ends at the zero; if the force is linear there, so close
      !> to it that the square of the distance is negligible
      type(step_t), intent(inout) :: step
      !> The panel, on return the one that ends at the zero; not converged on failure
      type(panel_t), intent(inout) :: panel
      !> Inverse of its Jacobian
      real(wp), intent(inout) :: inverse(width, width)

      type(panel_t) :: last
      real(wp) :: length, time, correction, last_correction, tolerance, kappa, memory_rate, &
         old_memory, memory, velocity
      logical :: elastic
      integer :: iteration, n

      n = panel%stages
      last = panel
      length = step%duration()
      associate (contact => problem%modes%contact, law => problem%impact%law)
         elastic = size(contact%rates) == 0 .and. .not. contact%viscosity > 0.0_wp
         ! kappa may be anything about dF/du, here without modes that settle in the step. s and M
         ! are taken as linear in time; the slope of M comes from the polynomials of the panel, then
         ! from the last two iterations
         kappa = contact%equilibrium + sum(contact%moduli/(1.0_wp + contact%rates*step%duration()))
         call look_for_zero(problem%collocator%rule, law, kappa, panel, time, memory_rate)
         panel%converged = .false.
         tolerance = landing_share*accuracy
         old_memory = 0.0_wp
         correction = 0.0_wp
         do iteration = 1, most_iterations
            ! the zero is in the panel; polynomials are useless beyond twice its length
            if (.not. (time > 0.0_wp .and. time < 2.0_wp*length)) return
            step = step_to(start%time, time)
            call solve_cut(problem, last, start, step, panel, inverse)
            if (.not. panel%converged) return
            last = panel
            memory = kappa*law%u(panel%indentation(n)) - panel%force(n)
            if (abs(correction) > rounding*time) &
               memory_rate = (memory - old_memory)/correction
            old_memory = memory
            last_correction = correction
            velocity = problem%relative_velocity(panel, n)
            if (elastic) then
               ! s = 0: the force of a cone is a square of s, whose zero is lost in rounding
               panel%converged = velocity < 0.0_wp
               correction = -panel%indentation(n)/velocity
            else
               call look_ahead(law, kappa, panel%indentation(n), velocity, memory, memory_rate, &
                  correction, panel%converged)
            end if
            if (.not. panel%converged) return
            if (abs(correction) <= (start%time + time)*merge(sqrt(share_of_square*tolerance), &
               tolerance, panel%indentation(n) >= shallow)) return
            ! rounding in the force of a dashpot or of stiff internal variables ends the iteration,
            ! too
            if (iteration > 3 .and. abs(correction) <= rounding*(start%time + time) &
                .and. abs(correction) >= abs(last_correction)) return
            time = time + correction
         end do
      end associate
      panel%converged = .false.
   end subroutine land_on_zero

   !> Zero of the force in a panel by its polynomials, and the slope there of M = kappa u - F
   subroutine look_for_zero(rule, law, kappa, panel, time, memory_rate)
      type(collocation_t), intent(in) :: rule
      type(contact_law_t), intent(in) :: law
      !> Stiffness kappa [N/m^1.5]
      real(wp), intent(in) :: kappa
      type(panel_t), intent(in) :: panel
      !> Time of the zero since the start of the panel [s]; 0 if the panel is so crude that its
      !> force is negative while the indentation grows
      real(wp), intent(out) :: time
      !> Slope of M [N/s]
      real(wp), intent(out) :: memory_rate

      real(wp) :: theta
      integer :: k

      time = 0.0_wp
      memory_rate = 0.0_wp
      k = first_without_force(panel)
      if (panel%force(k - 1) <= 0.0_wp) return
      theta = rule%crossing(panel%force, rule%point(k - 1), rule%point(k), rounding)
      time = theta*(panel%map(1) + panel%map(2)*theta)
      memory_rate = rule%interpolate(rule%slopes(kappa*law%u(panel%indentation) - panel%force), &
         theta)/(panel%map(1) + 2.0_wp*panel%map(2)*theta)
   end subroutine look_for_zero

   !> Solve kappa u(s + v x) = memory + rate x for x near 0 by Newton's method
   pure subroutine look_ahead(law, kappa, s, v, memory, rate, x, found)
      type(contact_law_t), intent(in) :: law
      !> Stiffness kappa [N/m^1.5], > 0
      real(wp), intent(in) :: kappa
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> Its rate [m/s]
      real(wp), intent(in) :: v
      !> Memory M [N]
      real(wp), intent(in) :: memory
      !> Rate of M [N/s]
      real(wp), intent(in) :: rate
      !> Time [s]
      real(wp), intent(out) :: x
      !> Whether the force falls to zero there
      logical, intent(out) :: found

      real(wp) :: correction, slope
      integer :: iteration

      x = 0.0_wp
      found = .false.
      do iteration = 1, most_iterations
         slope = kappa*law%slope(s + v*x)*v - rate
         if (.not. slope < 0.0_wp) return
         correction = (memory + rate*x - kappa*law%u(s + v*x))/slope
         x = x + correction
         found = abs(correction) <= roughly*abs(x)
         if (found) return
      end do
   end subroutine look_ahead

   !> Move the end of the last panel to the zero of its force nearby: the polynomials are continued
   !> to it, and all values move with their nodes, so that integrals remain sums over the nodes
   pure subroutine end_at_zero(rule, impact, panel)
      type(collocation_t), intent(in) :: rule
      type(impact_t), intent(in) :: impact
      !> The last panel
      type(panel_t), intent(inout) :: panel

      real(wp), dimension(0:width) :: shift, plate
      real(wp) :: growth

      associate (n => rule%stages, theta => rule%point, map => panel%map)
         growth = -panel%force(n)/slope_at_end(rule, panel, panel%force)/sum(map)
         ! shift of the nodes in theta; their times grow by the factor 1 + growth
         shift = growth*theta*(map(1) + map(2)*theta) &
            /max(map(1) + 2.0_wp*map(2)*theta, tiny(1.0_wp))
         plate = impact%free_path(panel%time) - panel%second_impulse/impact%mass - panel%indentation
         map = (1.0_wp + growth)*map
         panel%time = panel%time(0) + (1.0_wp + growth)*(panel%time - panel%time(0))
         call move(panel%force)
         call move(panel%impulse)
         call move(panel%second_impulse)
         if (.not. impact%plate%hereditary()) &
            call impact%plate%alpha_at(panel%time(1:n), panel%alpha(1:n))
         if (impact%plate%drifts()) then
            call move(panel%drift)
            call move(plate)
         else
            plate(1:n) = panel%alpha(1:n)*panel%impulse(1:n)
         end if
         panel%indentation(1:n) = impact%free_path(panel%time(1:n)) &
            - panel%second_impulse(1:n)/impact%mass - plate(1:n)
         panel%force(n) = 0.0_wp
      end associate

   contains

      !> Move the values with their nodes
      pure subroutine move(value)
         !> Values at the points
         real(wp), intent(inout) :: value(0:width)

         value = value + shift*rule%slopes(value)
      end subroutine move
   end subroutine end_at_zero

   !> Rate of a value at the end of a panel
   pure function slope_at_end(rule, panel, value) result(slope)
      type(collocation_t), intent(in) :: rule
      type(panel_t), intent(in) :: panel
      !> Values at the points of the panel
      real(wp), intent(in) :: value(0:width)
      !> Rate [1/s]
      real(wp) :: slope

      slope = sum(rule%derivative(rule%stages, :)*value)/panel%pace_at_end()
   end function slope_at_end

end module vcor_solver_ive_landing
