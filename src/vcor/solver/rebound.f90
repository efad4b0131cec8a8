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
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : closing, collocation_t, linear, width
   use vcor_solver_approach, only : approach_t
   use vcor_solver_rebound_panel, only : advance_rebound, rebound_panel_t, rebound_start_t, &
      solve_rebound_panel
   use vcor_solver_recording, only : record
   implicit none
   private

   public :: follow_rebound


   !> Error of the solution over its difference to the companion, which has a stage less: measured,
   !> below 0.1
   real(wp), parameter :: companion_share = 0.2_wp
   !> What rounding may add to the coefficient of restitution per panel, mostly through the
   !> eigenvectors of the integration matrices
   real(wp), parameter :: rounding = 1.0e-12_wp

contains

   !> Follow the rebound
   subroutine follow_rebound(rules, impact, kernel, memory, approach, start, accuracy, tolerance, &
                             end_time, trajectory, error)
      !> Collocation rules of the solution and of its companion
      type(collocation_t), intent(in) :: rules(2)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> Memory of a hereditary plate
      type(exponential_sum_t), intent(in) :: memory
      !> The approach
      type(approach_t), intent(in) :: approach
      !> State at the largest indentation; on return somewhere later
      type(rebound_start_t), intent(inout) :: start
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Error that Newton's method may leave, over the largest value
      real(wp), intent(in) :: tolerance
      !> End of the computation if the contact lasts [s]
      real(wp), intent(in) :: end_time
      !> Course of the impact, on entry its approach
      type(trajectory_t), intent(inout) :: trajectory
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: most_trials = 400
      ! share of the accuracy that one panel may use up
      real(wp), parameter :: panel_share = 0.3_wp
      ! error of a panel, over what it may have, that can be put up with if a shorter one does not
      ! reduce it: handed down by the panels before, or rounding in stiff internal variables
      real(wp), parameter :: tolerable = 4.0_wp, tolerable_end = 100.0_wp
      integer, parameter :: enough_closings = 5
      ! t1 at the end, extrapolated, over that at the start of the last panel
      real(wp), parameter :: near_zero = 0.3_wp
      ! first panel over the expected rebound at accuracy 1e-8, and its power of the accuracy
      real(wp), parameter :: first_share = 0.5_wp, growth_of_first = 0.12_wp, usual = 1.0e-8_wp
      ! a panel as long as this over the rest of the rebound is to be the last one; others leave a
      ! rest that is worth a panel
      real(wp), parameter :: closing_share = 0.9_wp, longest_share = 0.6_wp
      ! rate of t1 at first, where the kernel is constant; its growth that is rounding, over the
      ! time of the approach, and its rate
      real(wp), parameter :: first_rate = -1.2_wp, noticeable = 1.0e-6_wp, growing = 1.0e-3_wp
      type(rebound_panel_t) :: panel, companion, previous
      real(wp) :: length, taken, rest, rate, excess, refused, refused_end, end_found, slope
      real(wp) :: error_now, error_sum, alpha_rate
      integer :: trial, n, kind, closings
      logical :: ends, last, inherited

      n = rules(1)%stages
      refused = huge(1.0_wp)
      refused_end = huge(1.0_wp)
      closings = 0
      end_found = 0.0_wp
      slope = 0.0_wp
      kind = linear
      if (kernel%error > 0.0_wp .or. kernel%viscosity > 0.0_wp) kind = 0
      rate = first_rate
      length = -start%t1/rate*first_share*(accuracy/usual)**growth_of_first
      error_sum = 0.0_wp

      do trial = 1, most_trials
         ! while t1 stands still nothing tells when the contact ends
         rest = huge(1.0_wp)
         if (rate < 0.0_wp) rest = -start%t1/rate
         if (end_found > start%time) rest = end_found - start%time
         ends = length >= closing_share*rest
         taken = min(length, longest_share*rest)
         if (ends) taken = rest
         last = start%time + taken >= end_time
         if (last) then
            ends = .false.
            taken = end_time - start%time
         end if
         if (ends) then
            call close_contact(panel, taken)
            ! rounding in a condition next to zero is no end: t1 has to get there, too
            panel%converged = panel%converged .and. abs(panel%t1(n)) <= near_zero*start%t1
            if (panel%converged) then
               end_found = start%time + taken
               if (end_found > end_time) cycle
            end if
         else
            call guess(panel, kind, taken)
            call solve(1, kind, taken, panel)
            if (panel%converged) then
               previous = panel
               if (panel%condition(n) <= 0.0_wp) then
                  ! the end is closer than expected
                  call set_rate(panel)
                  refused = huge(1.0_wp)
                  length = taken
                  if (-start%t1 < closing_share*taken*rate) length = 0.5_wp*taken
                  cycle
               end if
            end if
         end if
         if (panel%converged) then
            call copy_guess(panel, companion)
            call solve(2, merge(closing, kind, ends), taken, companion)
         end if
         if (.not. (panel%converged .and. companion%converged)) then
            length = 0.5_wp*min(taken, rest)
            cycle
         end if

         alpha_rate = impact%plate%alpha_rate(panel%time(n), panel%alpha(n))
         ! at the end the drift is extrapolated, by which both have errors of the same size
         error_now = companion_share*(abs(panel%impulse(n) - companion%impulse(n - 1)) &
            *(1.0_wp/impact%mass + alpha_rate) &
            + merge(1.0_wp/companion_share, 1.0_wp, ends) &
            *abs(panel%drift(n) - companion%drift(n - 1)) &
            + abs(panel%indentation(n) - companion%indentation(n - 1))/start%t1)/impact%velocity
         if (ends) error_now = error_now + abs((panel%condition(n) - companion%condition(n - 1)) &
            /start%condition*taken)*alpha_rate*panel%impulse(n)/(panel%time(n)*impact%velocity)
         excess = error_now/(panel_share*accuracy)
         inherited = excess <= tolerable .and. excess > 0.5_wp*refused
         if (ends) then
            closings = closings + 1
            inherited = inherited .or. (excess <= tolerable_end &
               .and. (excess > 0.5_wp*refused_end .or. closings >= enough_closings))
         end if
         if (.not. (excess <= 1.0_wp .or. inherited)) then
            refused = excess
            if (ends) refused_end = excess
            length = 0.5_wp*taken
            cycle
         end if
         refused = huge(1.0_wp)
         if (any(panel%t1(1:n) - panel%t1(0:n - 1) > noticeable*approach%end &
             + growing*(panel%time(1:n) - panel%time(0:n - 1)))) then
            call raise(error, error_numerical, "the contact grows again before it has ended, " &
               //"which law = 'receding' does not cover: use law = 'boltzmann'")
            return
         end if

         if (ends) panel%force(n) = 0.0_wp
         error_sum = error_sum + error_now
         call record(rules(1), impact, panel%panel_t, trajectory)
         trajectory%last = trajectory%final
         if (ends) then
            trajectory%status = contact_separated
            trajectory%cor_error = error_sum + rounding*real(trajectory%steps, wp)
            return
         else if (trajectory%is_stuck(impact%mass)) then
            trajectory%status = contact_sticking
            return
         else if (last) then
            return
         end if
         call set_rate(panel)
         call advance_rebound(rules(1), rules(1)%map(kind), taken, kernel, memory, &
            panel, start)
         kind = linear
         length = taken*min(3.0_wp, max(excess, tiny(1.0_wp))**(-1.0_wp/real(2*n - 2, wp)))
      end do
      call raise(error, error_numerical, 'the internal-variable method does not get to the end ' &
         //'of the contact: the accuracy asked for is out of reach')

   contains

      !> Solve a panel
      subroutine solve(which, kind, length, panel)
         !> 1 for the solution, 2 for its companion
         integer, intent(in) :: which
         !> Index of the map
         integer, intent(in) :: kind
         !> Duration [s]
         real(wp), intent(in) :: length
         !> The panel, its t1 guessed
         type(rebound_panel_t), intent(inout) :: panel

         call solve_rebound_panel(rules(which), rules(which)%map(kind), length, impact, kernel, &
            memory, approach, start, tolerance, panel)
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
         real(wp), dimension(width) :: theta, time
         integer :: j

         theta = rules(1)%node
         if (kind == closing) theta = theta*(2.0_wp - theta)
         if (kind == 0) theta = theta**2
         time = start%time + length*theta
         panel%t1(1:) = start%t1 + rate*(time - start%time)
         if (previous%stages == 0) return
         theta = previous%theta(time)
         do j = 1, n
            if (theta(j) <= farthest) &
               panel%t1(j) = rules(1)%interpolate(previous%t1(0:n), theta(j))
         end do
      end subroutine guess

      !> Guess t1 at the stages of the companion
      subroutine copy_guess(panel, companion)
         !> The panel
         type(rebound_panel_t), intent(in) :: panel
         !> Its companion
         type(rebound_panel_t), intent(inout) :: companion

         integer :: j

         do j = 1, rules(2)%stages
            companion%t1(j) = rules(1)%interpolate(panel%t1(0:n), rules(2)%node(j))
         end do
      end subroutine copy_guess

      !> Find the length of the last panel, so that the condition is zero at its end, by the secant
      !> method
      subroutine close_contact(panel, length)
         !> The last panel; not converged on failure
         type(rebound_panel_t), intent(inout) :: panel
         !> A guess at its duration, on return the duration [s]
         real(wp), intent(inout) :: length

         integer, parameter :: most_iterations = 30
         ! a shorter correction tells nothing about slopes
         real(wp), parameter :: noticeable = 1.0e-7_wp, closest = 1.0e-13_wp
         ! no step goes farther than this, over the length
         real(wp), parameter :: farthest = 0.4_wp
         real(wp) :: correction, last_correction, condition, old_condition
         integer :: iteration

         ! the condition falls faster and faster; once known, its rate at the end is known for good
         if (.not. slope < 0.0_wp) slope = -1.5_wp*start%condition/length
         old_condition = 0.0_wp
         correction = 0.0_wp
         do iteration = 1, most_iterations
            call guess(panel, closing, length)
            call solve(1, closing, length, panel)
            if (.not. panel%converged) return
            condition = panel%condition(n)
            if (abs(correction) > noticeable*length) slope = (condition - old_condition)/correction
            panel%converged = slope < 0.0_wp
            if (.not. panel%converged) return
            previous = panel
            old_condition = condition
            last_correction = correction
            correction = -condition/slope
            correction = sign(min(abs(correction), farthest*length), correction)
            if (abs(correction) <= max(0.1_wp*min(accuracy, 1.0e-8_wp), closest) &
                *(start%time + length)) return
            ! rounding in the condition of stiff internal variables ends it, too
            if (iteration > 3 .and. abs(correction) <= noticeable*length &
                .and. abs(correction) >= 0.25_wp*abs(last_correction)) return
            length = length + correction
         end do
         panel%converged = .false.
      end subroutine close_contact

      !> Set the mean rate of t1 in the later part of a panel
      subroutine set_rate(panel)
         !> The panel
         type(rebound_panel_t), intent(in) :: panel

         integer :: j

         j = n/2
         rate = (panel%t1(n) - panel%t1(j))/(panel%time(n) - panel%time(j))
      end subroutine set_rate
   end subroutine follow_rebound

end module vcor_solver_rebound
