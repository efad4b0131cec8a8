!> One panel of the rebound of a receding contact in the internal-variable method
!>
!> The equations of `vcor_solver_rebound_equations` are solved for the condition N by Newton's
!> method, with the derivative dF/dN that is known from the approach, and each N for its t1.
!>
!> In the last panel time has the map t = t0 - D (1 - theta)^2, in which the motion is analytic:
!> the force goes to zero as (t0 - t)^1.5. Its length D is found along with its solution.
module vcor_solver_rebound_panel
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : closing, collocation_t, panel_map_t, width
   use vcor_numeric_linear, only : apply
   use vcor_solver_approach, only : approach_t
   use vcor_solver_modes, only : advance_lags, modes_t, start_t
   use vcor_solver_newton, only : newton_t
   use vcor_solver_panel, only : move_to_end
   use vcor_solver_rebound_equations, only : equations_t, integrate, rebound_panel_t, &
      rebound_start_t, response, set_up
   implicit none
   private

   public :: turn_round, solve_rebound_panel, close_contact, advance_rebound

   !> What rounding may leave of a correction, over the largest condition
   real(wp), parameter :: noise = 1.0e-9_wp

contains

   !> State at the largest indentation, where the approach has ended and the rebound begins
   pure subroutine turn_round(modes, start, approach, rebound)
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the end of the approach
      type(start_t), intent(in) :: start
      !> The approach
      type(approach_t), intent(in) :: approach
      !> The same state for the rebound
      type(rebound_start_t), intent(out) :: rebound

      rebound%start_t = start
      rebound%condition = modes%contact%equilibrium*start%indentation &
         + sum(modes%contact%moduli*approach%w)
      rebound%largest_condition = rebound%condition
      rebound%t1 = start%time
      rebound%w = approach%w
   end subroutine turn_round

   !> Correct the stage values of t1 by one iteration of Newton's method; condition and force are
   !> extrapolated to the corrected ones
   pure subroutine correct(map, equations, modes, approach, tolerance, newton, inverse, panel)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> The approach
      type(approach_t), intent(in) :: approach
      !> Wanted error of the condition over its largest value
      real(wp), intent(in) :: tolerance
      !> State of the iteration
      type(newton_t), intent(inout) :: newton
      !> Inverse of the Jacobian
      real(wp), intent(inout) :: inverse(width, width)
      !> The panel
      type(rebound_panel_t), intent(inout) :: panel

      real(wp), dimension(width) :: condition, force, slope, rate, change, unit
      integer :: n, i, j

      n = panel%stages
      call approach%evaluate(modes%contact%equilibrium, n, panel%time(1:), panel%t1(1:), &
         condition, force, slope, rate)
      associate (viscosity => modes%contact%viscosity)
         change = equations%condition - condition &
            - response(map, equations, viscosity, force, apply(map%left, force))
         if (newton%stale) then
            do j = 1, width
               unit = 0.0_wp
               unit(j) = slope(j)
               inverse(:, j) = response(map, equations, viscosity, unit, &
                  slope(j)*map%left(:, j))
               if (equations%closes) inverse(n, j) = 0.0_wp
               inverse(j, j) = inverse(j, j) + 1.0_wp
            end do
         end if
      end associate
      if (equations%closes) change(n) = 0.0_wp
      call newton%correct(inverse, change, condition, tolerance)
      if (newton%failed) return
      do i = 1, n
         panel%t1(i) = approach%moved(panel%t1(i), change(i), rate(i))
      end do
      panel%condition(1:) = condition
      panel%force(1:) = force + slope*change
   end subroutine correct

   !> Solve the collocation equations on a panel
   pure subroutine solve_rebound_panel(rule, map, scale, impact, modes, approach, start, &
                                       tolerance, share, panel)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> The approach
      type(approach_t), intent(in) :: approach
      !> State at the start
      type(rebound_start_t), intent(in) :: start
      !> Wanted error of the condition over its largest value
      real(wp), intent(in) :: tolerance
      !> Share of the difference to the guess that it may have instead
      real(wp), intent(in) :: share
      !> The panel, its t1 guessed
      type(rebound_panel_t), intent(inout) :: panel

      integer, parameter :: most_iterations = 40
      type(equations_t) :: equations
      type(newton_t) :: newton
      real(wp) :: inverse(width, width)
      integer :: iteration

      call set_up(equations, rule, map, scale, impact, modes, start, panel)
      newton = newton_t(unit=start%largest_condition, noise=noise, share=share)
      do iteration = 1, most_iterations
         call correct(map, equations, modes, approach, tolerance, newton, inverse, panel)
         if (newton%converged .or. newton%failed) exit
      end do
      panel%converged = newton%converged
      if (.not. panel%converged) return
      call integrate(map, equations, panel)
      if (equations%closes) then
         call settle_drift(rule, scale, modes%plate, start, panel)
         call settle_condition(rule, scale, impact, modes%contact, start, panel)
      end if
   end subroutine solve_rebound_panel

   !> Solve the last panel and find its duration, at the end of which N is zero
   pure subroutine close_contact(rule, impact, modes, approach, start, tolerance, time_tolerance, &
                                 length, panel)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> The approach
      type(approach_t), intent(in) :: approach
      !> State at the start
      type(rebound_start_t), intent(in) :: start
      !> Wanted error of the condition over its largest value
      real(wp), intent(in) :: tolerance
      !> Wanted relative error of the time of the end
      real(wp), intent(in) :: time_tolerance
      !> A guess at the duration, on return the duration [s]
      real(wp), intent(inout) :: length
      !> The panel, its t1 guessed; not converged on failure
      type(rebound_panel_t), intent(inout) :: panel

      integer, parameter :: most_iterations = 40
      ! no step goes farther than this, over the length
      real(wp), parameter :: farthest = 0.4_wp
      ! a correction over the length that may be rounding
      real(wp), parameter :: noticeable = 1.0e-7_wp
      ! polynomials run away beyond their own panel
      real(wp), parameter :: beyond = 1.2_wp
      ! a panel over its start that is rounding: there is no end to be found
      real(wp), parameter :: shortest = 1.0e-14_wp
      type(equations_t) :: equations
      type(newton_t) :: newton
      real(wp) :: inverse(width, width)
      real(wp) :: elapsed(width), fall, correction, last_correction
      integer :: n, iteration

      n = rule%stages
      newton = newton_t(unit=start%largest_condition, noise=noise)
      panel%converged = .false.
      correction = huge(1.0_wp)
      associate (map => rule%map(closing))
         do iteration = 1, most_iterations
            if (.not. length > shortest*start%time) return
            call set_up(equations, rule, map, length, impact, modes, start, panel)
            panel%t1(n) = 0.0_wp
            call correct(map, equations, modes, approach, tolerance, newton, inverse, panel)
            if (newton%failed) return
            call integrate(map, equations, panel)
            if (equations%damped) call settle_drift(rule, length, modes%plate, start, panel)
            call settle_condition(rule, length, impact, modes%contact, start, panel)
            ! N is linear in (1 - theta)^2 at the end
            fall = 0.5_wp*sum(rule%derivative(n, :)*rule%slopes(panel%condition))
            if (.not. fall > 0.0_wp) return
            last_correction = correction
            correction = farthest*length
            if (abs(panel%condition(n)) < farthest*fall) &
               correction = panel%condition(n)/fall*length
            correction = sign(correction, panel%condition(n))
            panel%converged = newton%converged .and. (abs(correction) &
               <= time_tolerance*(start%time + length) &
               ! rounding in the condition of stiff internal variables ends it, too
               .or. iteration > 3 .and. abs(correction) <= noticeable*length &
               .and. abs(correction) >= 0.25_wp*abs(last_correction))
            if (panel%converged) exit
            length = length + correction
            ! the motion does not know how long the panel is
            elapsed = length*rule%node*(map%slope + map%bend*rule%node)
            panel%t1(1:) = rule%extend(panel%t1, min(panel%theta(start%time + elapsed), beyond))
         end do
      end associate
      if (panel%converged) call settle_drift(rule, length, modes%plate, start, panel)
   end subroutine close_contact

   !> Where time stands still at the end of the panel, collocation there says nothing about internal
   !> variables that settle in it: what they make of the drift of a hereditary plate is integrated
   pure subroutine settle_drift(rule, scale, plate, start, panel)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> Memory of the plate
      type(exponential_sum_t), intent(in) :: plate
      !> State at the start
      type(rebound_start_t), intent(in) :: start
      !> The panel
      type(rebound_panel_t), intent(inout) :: panel

      associate (n => rule%stages)
         if (size(plate%rates) > 0) panel%drift(n) = -rule%settling%total(plate%moduli, &
            plate%rates, scale, start%p, panel%impulse(:n))
      end associate
   end subroutine settle_drift

   !> The same for the condition. The end has no weight in the integrals of the panel
   pure subroutine settle_condition(rule, scale, impact, contact, start, panel)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: contact
      !> State at the start
      type(rebound_start_t), intent(in) :: start
      !> The panel, its drift known
      type(rebound_panel_t), intent(inout) :: panel

      real(wp) :: velocity

      associate (n => rule%stages)
         panel%t1(n) = sum(rule%end_weight(0:n - 1)*panel%t1(0:n - 1))
         panel%condition(n) = contact%equilibrium*panel%indentation(n) &
            + rule%settling%total(contact%moduli, contact%rates, scale, start%w, &
            panel%indentation(:n))
         if (contact%viscosity > 0.0_wp) then
            velocity = impact%velocity - panel%impulse(n)/impact%mass
            if (impact%plate%drifts()) then
               velocity = velocity + panel%drift(n)
            else
               velocity = velocity - panel%impulse(n) &
                  *impact%plate%alpha_rate(panel%time(n), panel%alpha(n))
            end if
            panel%condition(n) = panel%condition(n) + contact%viscosity*velocity
         end if
      end associate
   end subroutine settle_condition

   !> Make the end of a panel the start of the next one
   pure subroutine advance_rebound(rule, map, scale, modes, panel, start)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> The panel
      type(rebound_panel_t), intent(in) :: panel
      !> State at the start of the panel, on return that at its end
      type(rebound_start_t), intent(inout) :: start

      real(wp) :: increment(width)

      increment = panel%indentation(1:) - panel%indentation(0)
      call advance_lags(map, scale, modes%contact, increment, start%w)
      increment = panel%impulse(1:) - panel%impulse(0)
      call advance_lags(map, scale, modes%plate, increment, start%p)
      call move_to_end(panel, start)
      start%condition = panel%condition(rule%stages)
      start%t1 = panel%t1(rule%stages)
   end subroutine advance_rebound

end module vcor_solver_rebound_panel
