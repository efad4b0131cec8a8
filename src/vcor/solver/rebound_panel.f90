!> One panel of the rebound of a receding contact in the internal-variable method
!>
!> The unknowns are the stage values of t1, by which force F and condition N are known from the
!> approach (`vcor_solver_approach`). With functions of the integration matrix H of the panel as in
!> `vcor_solver_panel`, a force in it takes R F of the indentation and Q F of its rate, and
!> N = int_0^t k(t - x) s'(x) dx is
!>
!>     N = G_0 s_n + S (s - s_n) + b + eta s',   s - s_n = g - R F,   s' = v - Q F
!>
!> with what has not relaxed of s_n in b, and the motion without a force in g and v. What is left is
!>
!>     N + T F = G_0 s_n + S g + b + eta v,    T = S R + eta Q,
!>
!> solved for N by Newton's method with the derivative dF/dN of the approach, and each N for its t1.
!> A dashpot gives no force once the contact shrinks, but takes part in the condition.
!>
!> In the last panel time has the map t = t0 - D (1 - theta)^2, in which the motion is analytic:
!> the force goes to zero as (t0 - t)^1.5. Its length D is found along with its solution.
module vcor_solver_rebound_panel
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : closing, collocation_t, panel_map_t, width
   use vcor_numeric_linear, only : apply, factors_t
   use vcor_numeric_pairs, only : constant, times
   use vcor_solver_approach, only : approach_t
   use vcor_solver_modes, only : advance_lags, modes_t, resolve, start_t
   use vcor_solver_newton, only : newton_t
   use vcor_solver_panel, only : move_to_end, panel_t
   implicit none
   private

   public :: rebound_start_t, rebound_panel_t
   public :: turn_round, solve_rebound_panel, close_contact, advance_rebound

   !> State at the start of a panel of the rebound; internal variables q_k have no part in it
   type, extends(start_t) :: rebound_start_t
      !> Condition N [N/m^0.5]
      real(wp) :: condition = 0.0_wp
      !> Condition at the largest indentation, against which its errors are counted [N/m^0.5]
      real(wp) :: largest_condition = 0.0_wp
      !> t1 [s]
      real(wp) :: t1 = 0.0_wp
      !> What has not relaxed of the indentation, w_k [m], shape (modes)
      real(wp), allocatable :: w(:)
   end type rebound_start_t

   !> Solution on a panel of the rebound
   type, extends(panel_t) :: rebound_panel_t
      !> Condition N [N/m^0.5]
      real(wp) :: condition(0:width) = 0.0_wp
      !> t1 [s]; on entry of the solver a guess
      real(wp) :: t1(0:width) = 0.0_wp
   end type rebound_panel_t

   !> What the equations of a panel are made of; functions of H as in `panel_map_t`
   type :: equations_t
      !> Eigenvalues of H [s]
      real(wp) :: lambda(width)
      !> S [N/m^1.5]
      real(wp) :: stiffness(width)
      !> Velocity of a hereditary plate per impulse in the panel, by its memory [1/kg]
      real(wp) :: plate(width)
      !> What an impulse takes of the velocity: 1/m and that [1/kg]
      real(wp) :: mobility(width)
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha(width)
      !> Its rate [m/(N s^2)]
      real(wp) :: alpha_rate(width)
      !> Velocity of a hereditary plate by what it remembers of earlier panels [m/s]
      real(wp) :: past(width)
      !> Gain of indentation without a force in the panel, g [m]
      real(wp) :: gain(width)
      !> Rate of the indentation without a force in the panel, v [m/s]
      real(wp) :: velocity(width)
      !> Condition without a force in the panel [N/m^0.5]
      real(wp) :: condition(width)
      !> Whether the plate is frozen, and whether it remembers the force
      logical :: frozen, remembers
      !> Whether alpha changes in time, and whether there is a dashpot
      logical :: varies, damped
      !> Whether time stands still at the end
      logical :: closes
   end type equations_t

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

   !> Set up the equations of a panel
   pure subroutine set_up(equations, rule, map, scale, impact, modes, start, panel)
      !> The equations
      type(equations_t), intent(out) :: equations
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
      !> State at the start
      type(rebound_start_t), intent(in) :: start
      !> The panel: its times and plate parameters are set, and all values at its start
      type(rebound_panel_t), intent(inout) :: panel

      real(wp) :: elapsed(width), past(width), velocity, start_alpha, inverse_mass
      integer :: n, i

      n = rule%stages
      panel%stages = n
      panel%map = scale*[map%slope, map%bend]
      elapsed = rule%node*(panel%map(1) + panel%map(2)*rule%node)
      panel%time(0) = start%time
      panel%time(1:) = start%time + elapsed
      panel%indentation(0) = start%indentation
      panel%force(0) = start%force
      panel%impulse(0) = start%impulse
      panel%second_impulse(0) = start%second_impulse
      panel%deflection(0) = start%deflection
      panel%drift(0) = start%drift
      panel%condition(0) = start%condition
      panel%t1(0) = start%t1

      inverse_mass = 1.0_wp/impact%mass
      velocity = impact%velocity - start%impulse*inverse_mass
      associate (e => equations)
         e%frozen = impact%plate%frozen()
         e%remembers = size(modes%plate%rates) > 0
         e%damped = modes%contact%viscosity > 0.0_wp
         e%closes = .not. map%slope + 2.0_wp*map%bend > 0.0_wp
         e%lambda = scale*map%eigenvalue
         e%alpha = 0.0_wp
         e%alpha_rate = 0.0_wp
         e%past = 0.0_wp
         e%plate = 0.0_wp
         e%gain = velocity*elapsed
         e%velocity = velocity
         if (e%remembers) then
            ! what settles at once in a hereditary plate counts as alpha, what it remembers is
            ! U' = R H F + c
            e%alpha(:n) = modes%plate%viscosity
            call resolve(modes%plate, start%p, map, e%lambda, e%plate, past)
            e%past = apply(map%right, past)
            e%gain = e%gain - apply(map%right, times(map%square, e%lambda, past))
            e%velocity = e%velocity - e%past
         else
            do i = 1, n
               call impact%plate%alpha_and_rate(panel%time(i), e%alpha(i), e%alpha_rate(i))
            end do
         end if
         e%mobility = e%plate + constant(inverse_mass)
         e%varies = any(abs(e%alpha_rate) > 0.0_wp)
         if (e%frozen) then
            e%gain = e%gain + start%drift*elapsed
            e%velocity = e%velocity + start%drift
         else if (e%varies) then
            start_alpha = impact%plate%alpha(start%time)
            e%gain = e%gain - (e%alpha - start_alpha)*start%impulse
            e%velocity = e%velocity - e%alpha_rate*start%impulse
         end if
         e%gain(n + 1:) = 0.0_wp
         panel%alpha(1:) = e%alpha

         call resolve(modes%contact, start%w, map, e%lambda, e%stiffness, past)
         e%condition = modes%contact%equilibrium*start%indentation &
            + apply(map%right, times(map%square, e%stiffness, apply(map%left, e%gain)) + past)
         if (e%damped) e%condition = e%condition + modes%contact%viscosity*e%velocity
         e%condition(n + 1:) = 0.0_wp
         ! no force acts at the end of the contact, and it would not count
         if (e%closes) e%condition(n) = 0.0_wp
      end associate
   end subroutine set_up

   !> What forces in the panel take of the condition: T F
   pure function response(map, equations, viscosity, force) result(taken)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> Viscosity of the contact [N s/m^1.5]
      real(wp), intent(in) :: viscosity
      !> Forces at the stages [N]
      real(wp), intent(in) :: force(width)
      !> Condition [N/m^0.5]
      real(wp) :: taken(width)

      associate (e => equations)
         taken = apply(map%right, times(map%square, e%stiffness, lost_indentation(map, e, force)))
         if (e%damped) taken = taken + viscosity*lost_velocity(map, e, force)
      end associate
   end function response

   !> What forces in the panel take of the indentation, R F, in the numbers of the pairs
   pure function lost_indentation(map, equations, force) result(x)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> Forces at the stages [N]
      real(wp), intent(in) :: force(width)
      !> Indentation [m], as `left` makes it of the stages
      real(wp) :: x(width)

      real(wp) :: impulse(width)

      associate (e => equations)
         if (e%frozen) then
            x = times(map%square, e%lambda, apply(map%left, lost_velocity(map, e, force)))
         else
            impulse = times(map%square, e%lambda, apply(map%left, force))
            x = times(map%square, e%lambda, times(map%square, e%mobility, impulse))
            if (e%varies) then
               x = x + apply(map%left, e%alpha*apply(map%right, impulse))
            else
               x = x + e%alpha(1)*impulse
            end if
         end if
      end associate
   end function lost_indentation

   !> What forces in the panel take of the rate of the indentation, Q F. A frozen plate has
   !> U' = alpha F - int alpha' F dt, others U' = alpha F + alpha' I and what they remember
   pure function lost_velocity(map, equations, force) result(velocity)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> Forces at the stages [N]
      real(wp), intent(in) :: force(width)
      !> Velocity [m/s]
      real(wp) :: velocity(width)

      real(wp) :: impulse(width)

      associate (e => equations)
         velocity = e%alpha*force
         impulse = times(map%square, e%lambda, apply(map%left, force))
         velocity = velocity + apply(map%right, times(map%square, e%mobility, impulse))
         if (e%frozen) then
            velocity = velocity - apply(map%right, &
               times(map%square, e%lambda, apply(map%left, e%alpha_rate*force)))
         else if (e%varies) then
            velocity = velocity + e%alpha_rate*apply(map%right, impulse)
         end if
      end associate
   end function lost_velocity

   !> Correct the stage values of t1 by one iteration of Newton's method; condition and force are
   !> extrapolated to the corrected ones
   pure subroutine correct(map, equations, modes, approach, tolerance, newton, factors, panel)
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
      !> Factors of the Jacobian
      type(factors_t), intent(inout) :: factors
      !> The panel
      type(rebound_panel_t), intent(inout) :: panel

      real(wp), dimension(width) :: condition, force, slope, rate, change, unit
      integer :: n, i, j

      n = panel%stages
      condition = 0.0_wp
      force = 0.0_wp
      slope = 0.0_wp
      do i = 1, n
         call approach%evaluate(modes%contact, panel%time(i), panel%t1(i), condition(i), force(i), &
            slope(i), rate(i))
      end do
      associate (viscosity => modes%contact%viscosity)
         change = equations%condition - condition - response(map, equations, viscosity, force)
         if (newton%stale) then
            do j = 1, width
               unit = 0.0_wp
               unit(j) = slope(j)
               factors%matrix(:, j) = response(map, equations, viscosity, unit)
               if (equations%closes) factors%matrix(n, j) = 0.0_wp
               factors%matrix(j, j) = factors%matrix(j, j) + 1.0_wp
            end do
         end if
      end associate
      if (equations%closes) change(n) = 0.0_wp
      call newton%correct(factors, change, condition, tolerance)
      if (newton%failed) return
      do i = 1, n
         panel%t1(i) = approach%moved(panel%t1(i), change(i), rate(i))
      end do
      panel%condition(1:) = condition
      panel%force(1:) = force + slope*change
   end subroutine correct

   !> Motion in the panel by its forces
   pure subroutine integrate(map, equations, panel)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> The panel
      type(rebound_panel_t), intent(inout) :: panel

      real(wp), dimension(width) :: impulse, x

      associate (e => equations, force => panel%force(1:))
         impulse = times(map%square, e%lambda, apply(map%left, force))
         panel%impulse(1:) = panel%impulse(0) + apply(map%right, impulse)
         panel%second_impulse(1:) = panel%second_impulse(0) &
            + panel%impulse(0)*(panel%time(1:) - panel%time(0)) &
            + apply(map%right, times(map%square, e%lambda, impulse))
         panel%indentation(1:) = panel%indentation(0) + e%gain &
            - apply(map%right, lost_indentation(map, e, force))
         if (e%frozen) then
            x = times(map%square, e%lambda, apply(map%left, e%alpha_rate*force))
            panel%drift(1:) = panel%drift(0) + apply(map%right, x)
            x = apply(map%left, e%alpha*force - panel%drift(1:))
            panel%deflection(1:) = panel%deflection(0) &
               + apply(map%right, times(map%square, e%lambda, x))
         else if (e%remembers) then
            x = times(map%square, e%plate, impulse)
            panel%drift(1:) = -(e%past + apply(map%right, x))
            x = apply(map%left, panel%drift(1:))
            panel%deflection(1:) = panel%deflection(0) &
               - apply(map%right, times(map%square, e%lambda, x))
         end if
      end associate
   end subroutine integrate

   !> Solve the collocation equations on a panel
   pure subroutine solve_rebound_panel(rule, map, scale, impact, modes, approach, start, &
                                       tolerance, panel)
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
      !> The panel, its t1 guessed
      type(rebound_panel_t), intent(inout) :: panel

      integer, parameter :: most_iterations = 40
      type(equations_t) :: equations
      type(newton_t) :: newton
      type(factors_t) :: factors
      integer :: iteration

      call set_up(equations, rule, map, scale, impact, modes, start, panel)
      newton = newton_t(unit=start%largest_condition, noise=noise)
      do iteration = 1, most_iterations
         call correct(map, equations, modes, approach, tolerance, newton, factors, panel)
         if (newton%converged .or. newton%failed) exit
      end do
      panel%converged = newton%converged
      if (.not. panel%converged) return
      call integrate(map, equations, panel)
      if (equations%closes) call settle(rule, scale, impact, modes, start, panel)
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
      type(equations_t) :: equations
      type(newton_t) :: newton
      type(factors_t) :: factors
      real(wp) :: elapsed(width), rate, correction, last_correction
      integer :: n, iteration

      n = rule%stages
      newton = newton_t(unit=start%largest_condition, noise=noise)
      panel%converged = .false.
      correction = huge(1.0_wp)
      associate (map => rule%map(closing))
         do iteration = 1, most_iterations
            call set_up(equations, rule, map, length, impact, modes, start, panel)
            panel%t1(n) = 0.0_wp
            call correct(map, equations, modes, approach, tolerance, newton, factors, panel)
            if (newton%failed) return
            call integrate(map, equations, panel)
            call settle(rule, length, impact, modes, start, panel)
            ! N is linear in (1 - theta)^2 at the end
            rate = -0.5_wp*sum(rule%derivative(n, :)*rule%slopes(panel%condition))/length
            if (.not. rate < 0.0_wp) return
            last_correction = correction
            correction = farthest*length
            if (abs(panel%condition(n)) < -rate*correction) correction = -panel%condition(n)/rate
            correction = sign(correction, panel%condition(n))
            panel%converged = newton%converged .and. (abs(correction) &
               <= time_tolerance*(start%time + length) &
               ! rounding in the condition of stiff internal variables ends it, too
               .or. iteration > 3 .and. abs(correction) <= noticeable*length &
               .and. abs(correction) >= 0.25_wp*abs(last_correction))
            if (panel%converged) return
            length = length + correction
            ! the motion does not know how long the panel is
            elapsed = length*rule%node*(map%slope + map%bend*rule%node)
            panel%t1(1:) = rule%extend(panel%t1, min(panel%theta(start%time + elapsed), beyond))
         end do
      end associate
   end subroutine close_contact

   !> Where time stands still at the end of the panel, collocation there says nothing about internal
   !> variables that settle in it: what they make of condition and drift is integrated. The end has
   !> no weight in the integrals of the panel
   pure subroutine settle(rule, scale, impact, modes, start, panel)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start
      type(rebound_start_t), intent(in) :: start
      !> The panel
      type(rebound_panel_t), intent(inout) :: panel

      real(wp) :: velocity

      associate (n => rule%stages, contact => modes%contact, plate => modes%plate)
         if (size(plate%rates) > 0) panel%drift(n) = -rule%settling%total(plate%moduli, &
            scale*plate%rates, start%p, panel%impulse(:n))
         panel%t1(n) = sum(rule%end_weight(0:n - 1)*panel%t1(0:n - 1))
         panel%condition(n) = contact%equilibrium*panel%indentation(n) &
            + rule%settling%total(contact%moduli, scale*contact%rates, start%w, &
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
   end subroutine settle

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
      call advance_lags(rule, map, scale, modes%contact, increment, start%w)
      increment = panel%impulse(1:) - panel%impulse(0)
      call advance_lags(rule, map, scale, modes%plate, increment, start%p)
      call move_to_end(panel, start)
      start%condition = panel%condition(rule%stages)
      start%t1 = panel%t1(rule%stages)
   end subroutine advance_rebound

end module vcor_solver_rebound_panel
