!> Rebound of a receding contact in the internal-variable method, from the largest indentation on
!>
!> Next to the end at t0 the force goes to zero as (t0 - t)^1.5, and the motion is analytic in
!> sqrt(t0 - t). So the last panel has the map t = t0 - D (1 - theta)^2 of its length D, which is
!> found so that the condition N is zero at its end. Before it come as many panels in t as the
!> accuracy takes; from a kernel that is infinite at first, or has a dashpot, the first one is in
!> the square root of the time since the largest indentation.
module vcor_solver_rebound
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : closing, collocation_t, linear, width
   use vcor_numeric_linear, only : apply
   use vcor_solver_approach, only : approach_t
   use vcor_solver_collocator, only : collocator_t
   use vcor_solver_modes, only : modes_t
   use vcor_solver_receding, only : refuse_growth
   use vcor_solver_rebound_equations, only : rebound_panel_t, rebound_start_t
   use vcor_solver_rebound_panel, only : advance_rebound, close_contact, solve_rebound_panel
   use vcor_solver_recording, only : record
   implicit none
   private

   public :: follow_rebound


   !> Error of the solution over its difference to the companion, which has a stage less: measured,
   !> below 0.1
   real(wp), parameter :: companion_share = 0.3_wp
   !> What rounding may add to the coefficient of restitution per panel, mostly through the
   !> eigenvectors of the integration matrices
   real(wp), parameter :: rounding = 1.0e-12_wp

contains

   !> Follow the rebound
   subroutine follow_rebound(collocator, impact, modes, approach, start, accuracy, end_time, &
                             trajectory, error)
      !> The collocation
      type(collocator_t), intent(in) :: collocator
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> The approach
      type(approach_t), intent(in) :: approach
      !> State at the largest indentation; on return somewhere later
      type(rebound_start_t), intent(inout) :: start
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> End of the computation if the contact lasts [s]
      real(wp), intent(in) :: end_time
      !> Course of the impact, on entry its approach
      type(trajectory_t), intent(inout) :: trajectory
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: most_trials = 400
      ! share of the accuracy that one panel may use up
      real(wp), parameter :: panel_share = 0.45_wp
      ! error of a panel, over what it may have, that can be put up with if half the panel does not
      ! reduce it by half: handed down by the panels before, or rounding in stiff internal variables
      real(wp), parameter :: tolerable = 4.0_wp, tolerable_end = 100.0_wp
      integer, parameter :: enough_closings = 5
      ! what Newton's method may leave, over that in the indentation of a companion
      real(wp), parameter :: share_of_tolerance = 3.0_wp
      ! relative error of the contact time that is rounding
      real(wp), parameter :: closest = 1.0e-13_wp
      ! t1 at the end, extrapolated, over that at the start of the last panel
      real(wp), parameter :: near_zero = 0.3_wp
      ! what a refused panel is cut to at most and at least, and the order with which the error of
      ! the last one falls at least
      real(wp), parameter :: least_cut = 0.8_wp, deepest_cut = 0.2_wp, order_at_end = 3.0_wp
      ! share of what is allowed that is aimed at
      real(wp), parameter :: aim = 0.3_wp
      ! a panel over its start that is rounding: it has been cut and cut again
      real(wp), parameter :: shortest = 1.0e-14_wp
      ! error of a sum of exponentials with which nothing is certain that is as small
      real(wp), parameter :: unreliable = 1.0e-6_wp
      type(rebound_panel_t) :: panel, companion, previous
      real(wp) :: length, end_length, taken, rest, rate, bend, excess, refused, refused_length
      real(wp) :: refused_end, end_found, error_now, error_sum, impulse_error
      real(wp) :: sphere_now, sphere_sum, alpha_rate, tolerance
      integer :: trial, n, kind, closings
      logical :: ends, last, halved, inherited

      n = collocator%rule%stages
      tolerance = share_of_tolerance*collocator%coarse_tolerance
      refused = huge(1.0_wp)
      refused_length = huge(1.0_wp)
      refused_end = huge(1.0_wp)
      closings = 0
      end_found = 0.0_wp
      kind = linear
      if (modes%contact%error > 0.0_wp .or. modes%contact%viscosity > 0.0_wp) kind = 0
      call set_first_lengths()
      error_sum = 0.0_wp
      sphere_sum = 0.0_wp

      do trial = 1, most_trials
         if (end_found > start%time) rest = end_found - start%time
         ends = rest <= end_length
         taken = min(length, share_of_rest()*rest)
         if (ends) taken = rest
         last = start%time + taken >= end_time
         if (last) then
            ends = .false.
            taken = end_time - start%time
         end if
         if (.not. taken > shortest*start%time) exit
         if (ends) then
            call guess(panel, closing, taken)
            call close_contact(collocator%rule, impact, modes, approach, start, tolerance, &
               max(0.1_wp*min(accuracy, 1.0e-8_wp), closest), taken, panel)
            if (panel%converged) previous = panel
            ! rounding in a condition next to zero is no end: t1 has to get there, too
            panel%converged = panel%converged .and. abs(panel%t1(n)) <= near_zero*start%t1
            if (panel%converged) then
               end_found = start%time + taken
               if (end_found > end_time) cycle
            end if
         else
            call guess(panel, kind, taken)
            call solve(collocator%rule, kind, taken, panel)
            if (panel%converged) then
               previous = panel
               if (panel%condition(n) <= 0.0_wp) then
                  ! the end is closer than expected
                  rest = taken*where_zero(panel)
                  refused = huge(1.0_wp)
                  refused_length = huge(1.0_wp)
                  cycle
               end if
            end if
         end if
         if (panel%converged) then
            call copy_guess(panel, companion)
            call solve(collocator%coarse, merge(closing, kind, ends), taken, companion)
         end if
         if (.not. (panel%converged .and. companion%converged)) then
            length = 0.5_wp*min(taken, rest)
            end_length = min(end_length, length)
            cycle
         end if

         alpha_rate = impact%plate%alpha_rate(panel%time(n), panel%alpha(n))
         impulse_error = abs(panel%impulse(n) - companion%impulse(n - 1))
         sphere_now = companion_share*(impulse_error/impact%mass &
            + abs(panel%indentation(n) - companion%indentation(n - 1))/start%t1)/impact%velocity
         error_now = sphere_now + companion_share*(impulse_error*alpha_rate &
            + abs(panel%drift(n) - companion%drift(n - 1)))/impact%velocity
         ! the companion ends a little earlier or later, which changes the velocity of the plate
         if (ends) error_now = error_now + abs((panel%condition(n) - companion%condition(n - 1)) &
            /start%condition*taken)*(alpha_rate*panel%impulse(n)/panel%time(n) &
            + abs((panel%drift(n) - panel%drift(n - 1))/(panel%time(n) - panel%time(n - 1)))) &
            /impact%velocity
         excess = error_now/(panel_share*accuracy)
         halved = taken <= 0.5_wp*refused_length
         inherited = excess <= tolerable .and. halved .and. excess > 0.5_wp*refused
         if (ends) then
            closings = closings + 1
            inherited = inherited .or. (excess <= tolerable_end &
               .and. (excess > 0.5_wp*refused_end .or. closings >= enough_closings))
         end if
         if (.not. (excess <= 1.0_wp .or. inherited)) then
            if (halved) then
               refused = excess
               refused_length = taken
            end if
            if (ends) then
               refused_end = excess
               end_length = taken*cut((excess/aim)**(-1.0_wp/order_at_end))
            else
               length = taken*cut((excess/aim)**(-1.0_wp/real(2*n - 2, wp)))
            end if
            cycle
         end if
         refused = huge(1.0_wp)
         refused_length = huge(1.0_wp)
         if (is_growing()) then
            ! it may be the error of the kernel that makes it grow
            if (modes%contact%error > unreliable) exit
            call refuse_growth(impact, error)
            return
         end if

         if (ends) panel%force(n) = 0.0_wp
         error_sum = error_sum + error_now
         sphere_sum = sphere_sum + sphere_now
         call record(collocator%rule, impact, panel%panel_t, trajectory)
         trajectory%last = trajectory%final
         if (trajectory%is_stuck(impact)) then
            trajectory%status = contact_sticking
            return
         else if (ends) then
            trajectory%status = contact_separated
            trajectory%cor_error = error_sum + rounding*real(trajectory%steps, wp)
            trajectory%cor_sphere_error = sphere_sum + rounding*real(trajectory%steps, wp)
            return
         else if (last) then
            return
         end if
         call expect_end(panel)
         call advance_rebound(collocator%rule, collocator%rule%map(kind), taken, modes, panel, &
            start)
         kind = linear
         length = taken*min(3.0_wp, max(excess, tiny(1.0_wp))**(-1.0_wp/real(2*n - 2, wp)))
      end do
      call raise(error, error_numerical, 'the internal-variable method does not get to the end ' &
         //'of the contact: the accuracy asked for is out of reach')

   contains

      !> Lengths of the first panel, of the last one and of the rebound to begin with
      subroutine set_first_lengths()

         real(wp), parameter :: usual = 1.0e-8_wp
         ! the rebound over the approach where the kernel is constant, and the rate of t1
         real(wp), parameter :: expected = 1.0_wp, first_rate = -1.2_wp
         ! first panel over that where the kernel relaxes within it and where it does not, at the
         ! usual accuracy, and its power of the accuracy
         real(wp), parameter :: rough_first = 0.36_wp, short_first = 0.50_wp, &
            long_first = 0.58_wp, fast = 3.0_wp, growth_of_first = 0.12_wp
         ! last panel over that, and its power: of a continuous spectrum, in contact or plate, the
         ! collocation of a panel does not resolve the modes that settle next to its end
         real(wp), parameter :: fast_end = 0.54_wp, smooth_end = 0.48_wp, growth_of_smooth = 0.12_wp
         real(wp), parameter :: half_rough_end = 0.27_wp
         real(wp), parameter :: rough_end = 0.1_wp, growth_of_rough = 0.3_wp
         logical :: relaxes

         rate = first_rate
         bend = 0.0_wp
         rest = expected*approach%end
         relaxes = any(modes%contact%rates*approach%end > fast)
         length = merge(short_first, long_first, relaxes)*approach%end &
            *(accuracy/usual)**growth_of_first
         end_length = merge(fast_end, smooth_end, relaxes)*approach%end &
            *(accuracy/usual)**growth_of_smooth
         if (modes%contact%error > 0.0_wp) &
            end_length = half_rough_end*approach%end*(accuracy/usual)**growth_of_smooth
         if (modes%contact%error > 0.0_wp .and. impact%plate%hereditary()) then
            length = rough_first*approach%end*(accuracy/usual)**growth_of_first
            end_length = rough_end*approach%end*(accuracy/usual)**growth_of_rough
         end if
      end subroutine set_first_lengths

      !> Share of the rest of the contact that a panel takes, so that some equal ones leave what is
      !> for the last panel. The end is a branch point, from which panels keep away
      pure function share_of_rest() result(share)
         !> Share
         real(wp) :: share

         real(wp), parameter :: smallest = 0.45_wp, largest = 0.67_wp
         real(wp), parameter :: unknown = 1.0e3_wp, margin = 0.95_wp
         integer :: panels

         share = largest
         if (.not. (rest > end_length .and. rest < unknown*end_length)) return
         panels = ceiling(log(margin*end_length/rest)/log(1.0_wp - largest))
         share = max(smallest, 1.0_wp - (margin*end_length/rest)**(1.0_wp/real(panels, wp)))
      end function share_of_rest

      !> What a panel is cut to
      pure function cut(wanted) result(share)
         !> What its error calls for
         real(wp), intent(in) :: wanted
         !> Share of its length
         real(wp) :: share

         share = min(least_cut, max(deepest_cut, wanted))
      end function cut

      !> Expect the end, and t1 up to there, by the parabolas that go on where a panel ends. While
      !> the condition grows nothing tells when the contact ends
      subroutine expect_end(panel)
         !> The panel
         type(rebound_panel_t), intent(in) :: panel

         real(wp), parameter :: share_of_bend = 0.6_wp
         real(wp) :: fall, fall_rate

         call end_rates(panel%t1, rate, bend)
         ! which becomes less and less
         bend = share_of_bend*bend
         call end_rates(panel%condition, fall, fall_rate)
         fall = -fall
         rest = huge(1.0_wp)
         if (panel%condition(n) < 1.0e3_wp*approach%end*fall) rest = 2.0_wp*panel%condition(n) &
            /(fall + sqrt(max(0.0_wp, fall**2 - 2.0_wp*panel%condition(n)*fall_rate)))
      end subroutine expect_end

      !> First and second derivative by time of a value at the end of the panel solved last
      subroutine end_rates(value, first, second)
         !> Its values at the points of the panel
         real(wp), intent(in) :: value(0:width)
         !> Its rate
         real(wp), intent(out) :: first
         !> Rate of that
         real(wp), intent(out) :: second

         real(wp) :: slope(0:width)

         associate (pace => panel%map(1) + 2.0_wp*panel%map(2))
            slope = collocator%rule%slopes(value)
            first = slope(n)/pace
            second = (sum(collocator%rule%derivative(n, :)*slope) - 2.0_wp*panel%map(2)*first) &
               /pace**2
         end associate
      end subroutine end_rates

      !> Whether t1 rises somewhere in the panel. It does where its slope is positive in the
      !> solution and in its companion, by more than the two differ anywhere in the panel
      pure function is_growing() result(grows)
         !> Whether it does
         logical :: grows

         real(wp), parameter :: roughly = 1.0e-3_wp
         real(wp), dimension(0:width) :: slope, bend, other
         real(wp) :: same(width), theta, doubt
         integer :: j, points

         slope = collocator%rule%slopes(panel%t1)
         other = collocator%coarse%slopes(companion%t1)
         same = collocator%to_coarse(:, 0)*slope(0) + apply(collocator%to_coarse(:, 1:), slope(1:))
         ! at the end of the contact time stands still in the map, and t1 with it
         points = merge(n - 2, n - 1, ends)
         doubt = maxval(abs(same(1:points) - other(1:points)))
         grows = any(min(same(1:points), other(1:points)) > doubt)
         ! and where the slope is largest between them
         j = maxloc(slope(0:n), 1) - 1
         if (grows .or. j == 0 .or. j == n) return
         bend = collocator%rule%slopes(slope)
         if (bend(j) < 0.0_wp) j = j - 1
         theta = collocator%rule%crossing(bend, collocator%rule%point(j), &
            collocator%rule%point(j + 1), roughly)
         grows = min(collocator%rule%interpolate(slope, theta), &
            collocator%coarse%interpolate(other, theta)) > doubt
      end function is_growing

      !> Where the condition is zero in a panel, as a share of its time
      function where_zero(panel) result(share)
         !> The panel, the condition at its end not positive
         type(rebound_panel_t), intent(in) :: panel
         !> Share
         real(wp) :: share

         real(wp), parameter :: roughly = 1.0e-3_wp
         real(wp) :: theta
         integer :: j

         j = findloc(panel%condition(1:n) <= 0.0_wp, .true., 1)
         theta = collocator%rule%crossing(panel%condition, collocator%rule%point(j - 1), &
            collocator%rule%point(j), roughly)
         share = theta*(panel%map(1) + panel%map(2)*theta)/sum(panel%map)
      end function where_zero

      !> Solve a panel
      subroutine solve(rule, kind, length, panel)
         !> Collocation rule
         type(collocation_t), intent(in) :: rule
         !> Index of the map
         integer, intent(in) :: kind
         !> Duration [s]
         real(wp), intent(in) :: length
         !> The panel, its t1 guessed
         type(rebound_panel_t), intent(inout) :: panel

         ! of the companion its difference to the solution is wanted, from which it starts
         real(wp), parameter :: companion = 0.05_wp

         call solve_rebound_panel(rule, rule%map(kind), length, impact, modes, approach, start, &
            tolerance, merge(0.0_wp, companion, rule%stages == n), panel)
      end subroutine solve

      !> Guess t1 at the stages of the solution
      subroutine guess(panel, kind, length)
         !> The panel
         type(rebound_panel_t), intent(inout) :: panel
         !> Index of the map
         integer, intent(in) :: kind
         !> Duration [s]
         real(wp), intent(in) :: length

         ! polynomials run away beyond their own panel
         real(wp), parameter :: farthest = 1.2_wp
         ! of what t1 falls, as a guess, and for how long
         real(wp), parameter :: slowest = 0.5_wp, near = 0.1_wp
         real(wp), dimension(width) :: theta, time

         associate (map => collocator%rule%map(kind))
            time = length*collocator%rule%node*(map%slope + map%bend*collocator%rule%node)
         end associate
         panel%t1(1:) = start%t1 + time*(rate + 0.5_wp*bend*time)
         ! which is zero at the end of the contact
         if (kind == closing) panel%t1(1:) = panel%t1(1:) &
            - (start%t1 + length*(rate + 0.5_wp*bend*length))*(time/length)**2
         if (previous%stages > 0) then
            theta = previous%theta(start%time + time)
            panel%t1(1:) = merge(collocator%rule%extend(previous%t1, min(theta, farthest)), &
               panel%t1(1:), theta <= farthest)
         end if
         ! next to the largest indentation t1 falls at least as fast as time grows
         panel%t1(1:) = min(panel%t1(1:), approach%end &
            - slowest*min(start%time + time - approach%end, near*approach%end))
      end subroutine guess

      !> Guess t1 at the stages of the companion
      subroutine copy_guess(panel, companion)
         !> The panel
         type(rebound_panel_t), intent(in) :: panel
         !> Its companion
         type(rebound_panel_t), intent(inout) :: companion

         companion%t1(1:) = collocator%to_coarse(:, 0)*panel%t1(0) &
            + apply(collocator%to_coarse(:, 1:), panel%t1(1:))
      end subroutine copy_guess
   end subroutine follow_rebound

end module vcor_solver_rebound
