!> The events of a march: the largest indentation, the end of a contact, a maximum of the force
!>
!> A panel that contains an event is solved again with other lengths, until the event is at its end:
!> there collocation is most accurate, and all integrals are sums over whole panels. The length
!> follows by Newton's method from what is smooth in time at the end of the panel:
!>
!>     turn    the rate s' of the indentation
!>     end     s and M = kappa u - F, where F = kappa u(s) - M is zero; F may end as u(s) does
!>     close   the condition N, a parabola of the time left
module vcor_solver_ive_event
   use vcor_kinds, only : wp
   use vcor_numeric_radau_dense, only : width
   use vcor_numeric_radau_rule, only : doubling, linear
   use vcor_solver_ive_equations, only : motion_t
   use vcor_solver_ive_newton, only : guess_growth, guess_rebound, solve_panel
   use vcor_solver_ive_panel, only : panel_t, step_t
   use vcor_tuning, only : ive_contraction, ive_rounding_per_panel
   implicit none
   private

   public :: event_turn, event_end, event_close
   public :: cut_at_event, time_to_event, time_to_zero, first_without_force, solve_up_to

   !> The events
   integer, parameter :: event_turn = 1, event_end = 2, event_close = 3

contains

   !> Solve a panel again until it ends with an event
   subroutine cut_at_event(motion, event, accuracy, time, found)
      !> The solution; its panel is near the event, on return it ends with it
      type(motion_t), intent(inout) :: motion
      !> The event
      integer, intent(in) :: event
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> A guess at the duration of the panel [s]
      real(wp), intent(in) :: time
      !> Whether the event was found
      logical, intent(out) :: found

      ! iterations; where so many do not suffice, a shorter panel is tried
      integer, parameter :: most = 40
      ! length over that of the last panel beyond which polynomials are useless: it ends iterations
      ! that diverge, of which 551 random impacts have none
      real(wp), parameter :: farthest = 2.0_wp
      ! correction that may be left, over the accuracy; that of a turn over the square root of it,
      ! since the two laws of the force differ by the fifth power of the time since then. Ten times
      ! as much changes results by up to 3e-12, 0.07 stated errors
      real(wp), parameter :: near = 1.0e-2_wp
      ! correction of a time, relative, that may be rounding: without, two of 551 random impacts
      ! have no result
      real(wp), parameter :: rounding = 1.0e-7_wp
      type(panel_t) :: last
      real(wp) :: duration, correction, last_correction, allowed
      integer :: iteration

      found = .false.
      correction = huge(1.0_wp)
      allowed = near*accuracy
      if (event == event_turn) allowed = near*sqrt(accuracy)
      duration = time
      do iteration = 1, most
         last = motion%panel
         if (.not. (duration > epsilon(1.0_wp)*motion%start%time .and. duration > 0.0_wp &
             .and. duration < farthest*last%step%duration)) return
         if (abs(duration - last%step%duration) > 0.0_wp) &
            call solve_near(motion, last, step_up_to(last%step, duration))
         if (.not. motion%panel%converged) return
         last_correction = correction
         call time_to_event(motion, event, correction, found)
         if (.not. found) return
         found = abs(correction) <= allowed*duration .or. iteration > 3 &
            .and. abs(correction) <= rounding*(motion%start%time + duration) &
            .and. abs(correction) >= 0.25_wp*abs(last_correction)
         ! on a plate that moves with the sphere, s' may fall slowly
         if (event == event_turn) found = found &
            .and. abs(motion%panel%velocity(motion%panel%stages)) <= allowed*motion%impact%velocity
         if (found) return
         duration = duration + correction
      end do
   end subroutine cut_at_event

   !> The step of another duration
   pure function step_up_to(other, duration) result(step)
      !> A step with the same start
      type(step_t), intent(in) :: other
      !> Duration [s]
      real(wp), intent(in) :: duration
      type(step_t) :: step

      step = step_t(other%kind, duration)
      if (other%kind == doubling) step%kind = linear
   end function step_up_to

   !> Solve a panel that differs little from another
   subroutine solve_near(motion, other, step)
      type(motion_t), intent(inout) :: motion
      !> The other panel
      type(panel_t), intent(in) :: other
      type(step_t), intent(in) :: step

      logical :: fresh

      ! the Jacobian changes as the square of the duration, or less
      fresh = abs(step%duration - other%step%duration) > ive_contraction*other%step%duration
      do
         if (motion%recedes) then
            call guess_rebound(motion, other, step, 0.0_wp, 0.0_wp, .true.)
         else
            call guess_growth(motion, other, step)
         end if
         call solve_panel(motion, step, fresh)
         if (motion%panel%converged .or. fresh) return
         fresh = .true.
      end do
   end subroutine solve_near

   !> Solve the panel from its start up to a time within it, such as that of a maximum
   subroutine solve_up_to(motion, time)
      !> The solution, its panel solved
      type(motion_t), intent(inout) :: motion
      !> Duration [s]
      real(wp), intent(in) :: time

      type(panel_t) :: whole

      whole = motion%panel
      call solve_near(motion, whole, step_up_to(whole%step, time))
   end subroutine solve_up_to

   !> Time from the end of a panel to an event, to first order in what is smooth there
   subroutine time_to_event(motion, event, time, found)
      !> The solution, its panel solved; the rates of the indentation are set
      type(motion_t), intent(inout) :: motion
      !> The event
      integer, intent(in) :: event
      !> Time [s]
      real(wp), intent(out) :: time
      !> Whether the event is near
      logical, intent(out) :: found

      real(wp) :: bend(0:width), slope, curvature, kappa
      integer :: n

      time = 0.0_wp
      n = motion%panel%stages
      associate (panel => motion%panel, rule => motion%rule, contact => motion%sums%contact, &
                 law => motion%impact%law)
         if (event == event_close) then
            ! N is even in the root of the time left, theta = 1 at its zero
            bend = rule%slopes(rule%slopes(panel%condition))
            found = bend(n) > 0.0_wp
            if (found) time = panel%step%duration*time_to_zero(panel%condition(n), &
               -0.5_wp*bend(n), sum(rule%derivative(n, :)*rule%slopes(bend))/12.0_wp)
         else if (event == event_turn) then
            call motion%find_velocity()
            call panel%end_rates(rule, panel%velocity, slope, curvature)
            found = slope < 0.0_wp
            if (found) time = time_to_zero(panel%velocity(n), slope, curvature)
         else if (size(contact%rates) == 0 .and. .not. contact%viscosity > 0.0_wp) then
            ! elastic: the zero of s is that of F, but where F is s^2 it is lost in rounding
            panel%velocity(n) = motion%velocity_at(n)
            found = panel%velocity(n) < 0.0_wp
            if (found) time = -panel%indentation(n)/panel%velocity(n)
         else
            ! kappa is about dF/du, without the modes that settle in the panel
            panel%velocity(n) = motion%velocity_at(n)
            kappa = contact%equilibrium + sum(contact%moduli/(1.0_wp + contact%rates &
               *panel%step%duration))
            call look_ahead(kappa, kappa*panel%u - panel%force)
         end if
      end associate

   contains

      !> Solve kappa u(s + s' x) = M + M' x for x near 0 by Newton's method
      subroutine look_ahead(kappa, memory)
         !> Stiffness kappa [N/m^1.5], > 0
         real(wp), intent(in) :: kappa
         !> Memory M at the points of the panel [N]
         real(wp), intent(in) :: memory(0:width)

         ! relative correction that may be left, as this is part of an outer iteration: with 1e-9
         ! results of 551 random impacts change by up to 0.06 stated errors
         real(wp), parameter :: roughly = 1.0e-3_wp
         integer, parameter :: most = 40
         real(wp) :: correction, slope, rate
         integer :: iteration

         rate = motion%panel%slope_at_end(motion%rule, memory)
         found = .false.
         associate (law => motion%impact%law, s => motion%panel%indentation(n), &
                    v => motion%panel%velocity(n))
            do iteration = 1, most
               slope = kappa*law%slope(s + v*time)*v - rate
               if (.not. slope < 0.0_wp) return
               correction = (memory(n) + rate*time - kappa*law%u(s + v*time))/slope
               time = time + correction
               found = abs(correction) <= max(roughly*abs(time), &
                  ive_rounding_per_panel*motion%panel%time(n))
               if (found) return
            end do
         end associate
      end subroutine look_ahead
   end subroutine time_to_event

   !> Time to the zero of a parabola that falls
   pure function time_to_zero(value, slope, bend) result(time)
      !> Its value, and its derivatives by time, slope < 0
      real(wp), intent(in) :: value, slope, bend
      !> Time, negative if the zero has passed
      real(wp) :: time

      time = 2.0_wp*value/(-slope + sqrt(max(0.0_wp, slope**2 - 2.0_wp*value*bend)))
   end function time_to_zero

   !> First stage of a panel without force; 0 if there is none. While the indentation grows, the
   !> force is positive, and a force <= 0 is rounding
   pure function first_without_force(panel) result(stage)
      type(panel_t), intent(in) :: panel
      integer :: stage

      do stage = 1, panel%stages
         if (panel%force(stage) <= 0.0_wp &
             .and. panel%indentation(stage) < panel%indentation(stage - 1)) return
      end do
      stage = 0
   end function first_without_force

end module vcor_solver_ive_event
