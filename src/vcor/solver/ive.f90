!> Internal variable evolution: the fast method for kernels that are sums of exponentials
!> (Section VI of Green's paper), by collocation with the internal variables eliminated
!>
!> Every impact is solved twice on the same panels, with seven stages and with eight: what the two
!> differ by is the error, of a panel and of the outcome.
!>
!> Time is cut into panels. Close to first contact they are steps in x = sqrt(t), in which the
!> solution is analytic from the start, u = s^1.5 included; later, where the branch point at t = 0
!> has become remote, steps in t. Panels are accepted or cut by their
!> error, so the mesh adapts itself.
!> The last panel is solved anew until it ends where the force is zero: the end of a panel is where
!> collocation is most accurate (order 2 n - 1), and all integrals over the contact are then sums
!> over whole panels. Towards the end of a nearly elastic contact, where s goes to zero as well and
!> u = s^1.5 loses its derivatives, the panels shrink geometrically.
module vcor_solver_ive
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : hertz_contact_time, impact_t, law_receding
   use vcor_impact_trajectory, only : contact_separated, contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, linear
   use vcor_solver_approach, only : approach_t
   use vcor_solver_collocator, only : advance, collocator_t, guess, most_steps, new_collocator, &
      plate_velocity, refine, solve_step
   use vcor_solver_landing, only : first_without_force, land
   use vcor_solver_modes, only : start_t
   use vcor_solver_panel, only : panel_t
   use vcor_solver_rebound, only : follow_rebound, new_rebound_rule, rebound_rule_t
   use vcor_solver_rebound_panel, only : rebound_start_t
   use vcor_solver_recording, only : append, begin
   use vcor_solver_step, only : step_t, step_to
   use vcor_solver_type, only : solver_t
   implicit none
   private

   public :: ive_t, new_ive

   !> Share of the wanted accuracy that the error of one panel may use up
   real(wp), parameter :: panel_share = 0.4_wp

   !> Share of the wanted accuracy that the kernel is approximated to: where that is the usual one
   !> and better, and at most
   real(wp), parameter :: kernel_share = 0.01_wp, usual = 1.0e-8_wp, largest_share = 0.02_wp
   !> Error of the coefficient of restitution per relative error of the kernel [-]
   real(wp), parameter :: sensitivity = 0.3_wp

   !> First step over the usual one where the contact recedes: the rebound needs the approach between
   !> its panels' ends, too
   real(wp), parameter :: receding_reach = 0.8_wp

   !> Internal variable evolution
   type, extends(solver_t) :: ive_t
      private
      !> Wanted accuracy of the coefficient of restitution [-]
      real(wp) :: accuracy = 1.0e-8_wp
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp) :: end_time = 0.0_wp
      !> Go on after the separation
      logical :: ghost = .false.
      !> Collocation rules
      type(collocator_t) :: collocator
      !> What the rebound of a receding contact needs of the rules, that of the solution first
      type(rebound_rule_t) :: rebound(2)
   contains
      procedure :: solve
   end type ive_t

contains

   !> Build the solver
   subroutine new_ive(self, accuracy, end_time, error, second_coefficient, ghost)
      !> The solver
      type(ive_t), intent(out) :: self
      !> Wanted accuracy of the coefficient of restitution, > 0
      real(wp), intent(in) :: accuracy
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp), intent(in) :: end_time
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Coefficient of the second term of the Volterra series [m^-1.5]; absent: without it
      real(wp), intent(in), optional :: second_coefficient
      !> Go on after the separation, to `end_time` or to twice the contact time; absent: no
      logical, intent(in), optional :: ghost

      self%accuracy = accuracy
      self%end_time = end_time
      if (present(ghost)) self%ghost = ghost
      call new_collocator(self%collocator, accuracy, error)
      if (.not. allocated(error)) call new_rebound_rule(self%rebound(1), self%collocator%fine, error)
      if (.not. allocated(error)) call new_rebound_rule(self%rebound(2), self%collocator%rule, error)
      if (present(second_coefficient)) &
         self%collocator%second_coefficient = second_coefficient
   end subroutine new_ive

   !> Compute the course of an impact. Where the kernel is no finite sum of exponentials, one is
   !> made that holds up to some times the expected contact time, and anew if the contact outlasts
   !> it
   subroutine solve(self, impact, trajectory, error)
      !> The solver
      class(ive_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its course
      type(trajectory_t), intent(out) :: trajectory
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp), parameter :: margin = 2.0_wp, growth = 20.0_wp
      type(exponential_sum_t) :: kernel
      real(wp) :: share, end_time, window, time_scale
      logical :: complete

      share = min(kernel_share*max(1.0_wp, self%accuracy/usual), largest_share)
      time_scale = impact%time_scale()
      end_time = self%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%patience()
      window = margin*hertz_contact_time*time_scale
      do
         call impact%kernel_exponentials(window, share*self%accuracy, kernel)
         ! a sum that is the kernel itself holds for ever, ghost lines beyond the end included
         if (.not. kernel%error > 0.0_wp) window = huge(1.0_wp)
         call follow(self, impact, kernel, time_scale, end_time, window, trajectory, complete, &
            error)
         if (complete .or. allocated(error)) exit
         window = growth*window
      end do
      if (trajectory%status == contact_separated) &
         trajectory%cor_error = trajectory%cor_error + sensitivity*kernel%error
      if (kernel%error > 0.0_wp) trajectory%kernel_terms = size(kernel%rates)
      trajectory%kernel_error = kernel%error
   end subroutine solve

   !> Follow the contact with the kernel as a sum of exponentials
   subroutine follow(self, impact, kernel, time_scale, patience, window, trajectory, complete, &
                     error)
      !> The solver
      class(ive_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> Time scale of the contact [s]
      real(wp), intent(in) :: time_scale
      !> End of the computation if the contact lasts [s]
      real(wp), intent(in) :: patience
      !> Time up to which the sum holds [s]
      real(wp), intent(in) :: window
      !> Its course
      type(trajectory_t), intent(out) :: trajectory
      !> Whether the window was long enough
      logical, intent(out) :: complete
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: most_trials = 20000
      ! the panel before an end that was refused comes this close to it
      real(wp), parameter :: approach = 0.65_wp
      ! what rounding leaves in the force of stiff internal variables and dashpots, over the largest
      ! force: it is not to stop the march
      real(wp), parameter :: rounding = 1.0e-12_wp
      ! error of a panel, over what it may have, that can be put up with if it is inherited
      real(wp), parameter :: tolerable = 4.0_wp
      ! first step in x over the square root of the expected contact time, where the kernel relaxes
      ! within a step and where it does not, at accuracy 1e-8, and its power of the accuracy
      real(wp), parameter :: short_step = 0.25_wp, long_step = 0.34_wp, fast = 3.0_wp
      real(wp), parameter :: step_growth = 0.025_wp
      ! residual indentation over the largest one that makes an end a smooth one
      real(wp), parameter :: shallow_end = 0.01_wp, elastic_end = 1.0e-3_wp
      type(start_t) :: start, fine_start
      type(step_t) :: step
      type(panel_t) :: panel, previous, fine, recorded
      real(wp) :: accuracy, end_time, largest_force, peak_tolerance, force_tolerance, time_tolerance
      real(wp) :: excess, refused, force_error
      integer :: trial, n
      logical :: ends, last, inherited, shallow, elastic, turns
      type(approach_t) :: approaches(2)
      type(rebound_start_t) :: rebounds(2)
      type(exponential_sum_t) :: memory

      n = self%collocator%rule%stages
      ! the noise of moduli of both signs is not to be resolved
      accuracy = self%accuracy
      if (any(kernel%moduli < 0.0_wp)) accuracy = max(accuracy, sensitivity*kernel%error)
      complete = .true.
      end_time = patience
      allocate (start%q(size(kernel%rates)))
      start%q = 0.0_wp
      fine_start = start
      step%reach = merge(short_step, long_step, any(kernel%rates*time_scale > fast)) &
         *(accuracy/usual)**step_growth*sqrt(hertz_contact_time*time_scale)
      if (impact%law == law_receding) step%reach = receding_reach*step%reach
      step%length = step%reach
      if (kernel%error > 0.0_wp) step%length = step%reach*0.5_wp**levels(accuracy)
      call begin(self%collocator%fine, impact, trajectory)
      largest_force = 0.0_wp
      refused = huge(1.0_wp)
      shallow = .false.
      ! the force counts where it has its maximum, and at the end; elsewhere it is what is left of
      ! transients that the impulse does not feel
      peak_tolerance = 10.0_wp*max(accuracy, 1.0e-8_wp)
      force_tolerance = 1.0e3_wp*peak_tolerance
      ! between the two solutions; the finer one is better by an order
      time_tolerance = max(3.0_wp*accuracy*min(1.0_wp, (usual/accuracy)**0.3_wp), 1.0e-9_wp)

      do trial = 1, most_trials
         last = start%time + step%duration() >= end_time
         if (last) step = step_to(start%time, end_time - start%time)
         call guess(self%collocator%rule, impact, previous, start, step, panel)
         call solve_step(self%collocator, self%collocator%rule, step, impact, kernel, start, &
            panel)
         ends = .false.
         turns = panel%converged .and. impact%law == law_receding
         if (turns) turns = any(rates(panel) < 0.0_wp)
         if (turns) call turn()
         if (panel%converged .and. trajectory%status /= contact_separated .and. .not. turns) &
            ends = first_without_force(panel) > 0
         if (ends) call land(self%collocator, impact, kernel, start, accuracy, step, panel)
         if (.not. panel%converged) then
            call step%shorten(0.5_wp*step%duration())
            cycle
         end if
         previous = panel

         call refine(self%collocator, impact, kernel, fine_start, step, panel, fine)
         if (.not. fine%converged) then
            call step%shorten(0.5_wp*step%duration())
            cycle
         end if
         largest_force = max(largest_force, maxval(panel%force(1:n)))
         excess = (growth_of(fine%impulse, panel%impulse)/(impact%mass*impact%velocity) &
            + growth_of(fine%indentation, panel%indentation)/(impact%velocity*time_scale)) &
            /(panel_share*accuracy)
         force_error = max(0.0_wp, min(growth_of(fine%force, panel%force), &
            abs(fine%force(n + 1) - panel%force(n))) - rounding*largest_force)
         if (ends) then
            ! next to u = s^1.5 = 0 both solutions err in the same direction
            shallow = panel%indentation(n) < shallow_end*trajectory%max_indentation
            if (shallow) force_error = 100.0_wp*force_error
            excess = max(excess, force_error/abs(slope_at_end(self%collocator%rule, panel)) &
               /(panel%time(n)*time_tolerance))
         else if (maxval(panel%force(1:n)) > max(panel%force(0), panel%force(n))) then
            excess = max(excess, force_error/(largest_force*peak_tolerance))
         else
            excess = max(excess, force_error/(largest_force*force_tolerance))
         end if
         ! what a shorter panel did not reduce has been handed down by the panels before
         inherited = excess <= tolerable .and. excess > 0.5_wp*refused
         if (.not. (excess <= 1.0_wp .or. inherited)) then
            refused = excess
            call step%shorten(merge(approach, 0.5_wp, ends)*step%duration())
            cycle
         end if

         refused = huge(1.0_wp)
         recorded = fine
         if (ends) then
            elastic = panel%indentation(n) < elastic_end*trajectory%max_indentation
            trajectory%cor_error = error_of_cor(self%collocator%rule, impact, panel, fine, &
               trajectory%steps + 1, elastic)
            call end_at_zero(impact, slope_at_end(self%collocator%rule, panel), shallow, recorded)
         end if
         call append(self%collocator, impact, kernel, fine_start, panel, recorded, accuracy, &
            trajectory)
         complete = .not. panel%time(n) > window
         if (.not. complete) return
         if (impact%law == law_receding) then
            call approaches(1)%add(self%collocator%fine, self%rebound(1)%spectral(step%index), step%map_scale(), kernel, &
               fine_start%q, fine, trajectory%state(3, trajectory%final - fine%stages), rates(fine))
            call approaches(2)%add(self%collocator%rule, self%rebound(2)%spectral(step%index), step%map_scale(), kernel, &
               start%q, panel, trajectory%state(3, trajectory%final - fine%stages), rates(panel))
         end if
         if (ends) then
            trajectory%status = contact_separated
            if (.not. self%ghost) return
            end_time = 2.0_wp*recorded%time(n + 1)
            if (self%end_time > 0.0_wp) end_time = self%end_time
         end if
         if (trajectory%status == contact_separated) then
            if (panel%time(n) >= end_time) return
         else if (trajectory%is_stuck(impact%mass)) then
            trajectory%status = contact_sticking
            return
         else if (last) then
            return
         end if

         call advance(self%collocator%rule, step, kernel, panel, start)
         call advance(self%collocator%fine, step, kernel, fine, fine_start)
         if (turns) then
            call set(rebounds(1), fine_start, approaches(1))
            call set(rebounds(2), start, approaches(2))
            call follow_rebound(self%rebound, impact, kernel, memory, approaches(1), rebounds(1), accuracy, &
               self%collocator%tolerance, end_time, trajectory, error)
            complete = .not. trajectory%state(1, trajectory%final) > window
            return
         end if
         call step%proceed(min(3.0_wp, max(excess, tiny(1.0_wp))**(-1.0_wp/real(2*n, wp))), &
            most_steps)
      end do
      call raise(error, error_numerical, 'the internal-variable method does not get to the end ' &
         //'of the contact: the accuracy asked for is out of reach')

   contains

      subroutine set(rebound, start, approach)
         type(rebound_start_t), intent(out) :: rebound
         type(start_t), intent(in) :: start
         type(approach_t), intent(in) :: approach

         rebound%time = start%time
         rebound%indentation = start%indentation
         rebound%force = start%force
         rebound%t1 = start%time
         rebound%impulse = start%impulse
         rebound%second_impulse = start%second_impulse
         rebound%deflection = start%deflection
         rebound%drift = start%drift
         rebound%r = approach%r
         rebound%condition = kernel%equilibrium*start%indentation + sum(kernel%moduli*(start%indentation - approach%r))
         allocate (rebound%p(0))
         if (.not. allocated(memory%rates)) allocate (memory%rates(0), memory%moduli(0))
      end subroutine set

      function rates(panel)
         type(panel_t), intent(in) :: panel
         real(wp) :: rates(panel%stages)

         integer :: j

         do j = 1, panel%stages
            rates(j) = impact%velocity - panel%impulse(j)/impact%mass - plate_velocity(impact, panel, j)
         end do
      end function rates

      subroutine turn()

         real(wp) :: theta, v(0:panel%stages)

         v(1:) = rates(panel)
         v(0) = impact%velocity
         if (trajectory%final > 0) v(0) = trajectory%state(3, trajectory%final)
         theta = self%collocator%rule%crossing(v, 0.0_wp, 1.0_wp)
         step = step_to(start%time, theta*(panel%map(1) + panel%map(2)*theta))
         previous = panel
         call guess(self%collocator%rule, impact, previous, start, step, panel)
         call solve_step(self%collocator, self%collocator%rule, step, impact, kernel, start, panel)
      end subroutine turn

      !> By how much the difference of the two solutions grows over the panel
      pure function growth_of(one, other) result(difference)
         !> Values of the finer solution at the points of the panel
         real(wp), intent(in) :: one(0:)
         !> Values of the solution
         real(wp), intent(in) :: other(0:)
         !> Growth
         real(wp) :: difference

         difference = abs((one(n + 1) - other(n)) - (one(0) - other(0)))
      end function growth_of
   end subroutine follow

   !> Number of times that the first step is halved for a kernel with a continuous spectrum: in it
   !> collocation does not resolve the internal variables that settle within the step
   pure function levels(accuracy)
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Number
      integer :: levels

      levels = max(0, ceiling(log(4.0e-7_wp/(panel_share*accuracy))/log(16.0_wp)))
   end function levels

   !> Let the finer solution end where its own force is zero, which is next to where that of the
   !> other one is
   pure subroutine end_at_zero(impact, slope, shallow, fine)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Rate of the force [N/s], < 0
      real(wp), intent(in) :: slope
      !> Whether the indentation ends next to zero, where the force is not linear in time
      logical, intent(in) :: shallow
      !> The last panel of the finer solution
      type(panel_t), intent(inout) :: fine

      real(wp) :: time

      associate (n => fine%stages)
         if (.not. shallow) then
            time = -fine%force(n)/slope
            fine%time(n) = fine%time(n) + time
            fine%impulse(n) = fine%impulse(n) + 0.5_wp*time*fine%force(n)
            fine%second_impulse(n) = fine%second_impulse(n) + time*fine%impulse(n)
            fine%indentation(n) = fine%indentation(n) + time*(impact%velocity &
               - fine%impulse(n)/impact%mass - plate_velocity(impact, fine, n))
            fine%alpha(n) = impact%plate%alpha(fine%time(n))
         end if
         fine%force(n) = 0.0_wp
      end associate
   end subroutine end_at_zero

   !> Rate of the force at the end of a panel
   pure function slope_at_end(rule, panel) result(slope)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Rate [N/s]
      real(wp) :: slope

      associate (n => rule%stages)
         slope = sum(rule%derivative(n, 0:n)*panel%force(0:n))/(panel%map(1) + 2.0_wp*panel%map(2))
      end associate
   end function slope_at_end

   !> Error of the coefficient of restitution: with F = 0 at the end, s' = v0 - I/m - alpha' I. The
   !> finer solution reaches F = 0 a little earlier or later, which only alpha' feels
   pure function error_of_cor(rule, impact, panel, fine, panels, shallow) result(estimate)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The impact
      type(impact_t), intent(in) :: impact
      !> The last panel
      type(panel_t), intent(in) :: panel
      !> The last panel of the finer solution
      type(panel_t), intent(in) :: fine
      !> Number of panels
      integer, intent(in) :: panels
      !> Whether the indentation ends next to zero
      logical, intent(in) :: shallow
      !> Estimate [-]
      real(wp) :: estimate

      ! what rounding may add per panel, mostly through the eigenvectors of the integration matrices
      real(wp), parameter :: rounding = 5.0e-13_wp
      ! the difference is the error of the coarser solution: that of the finer one is less, where
      ! the solution is smooth by orders, where it is not by a factor of this size
      real(wp), parameter :: finer = 0.3_wp
      real(wp) :: impulse_error, time_error, alpha_rate

      associate (n => rule%stages)
         impulse_error = abs(fine%impulse(n + 1) - panel%impulse(n))
         time_error = abs((fine%force(n + 1) - panel%force(n))/slope_at_end(rule, panel))
         alpha_rate = impact%plate%alpha_rate(panel%time(n), panel%alpha(n))
         estimate = rounding*real(panels, wp) + merge(1.0_wp, finer, shallow)/impact%velocity &
            *(impulse_error*(1.0_wp/impact%mass + alpha_rate) &
            + time_error*alpha_rate*panel%impulse(n)/panel%time(n) &
            + abs(fine%drift(n + 1) - panel%drift(n)))
      end associate
   end function error_of_cor

end module vcor_solver_ive
