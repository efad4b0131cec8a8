!> Internal variable evolution: the fast method for kernels that are sums of exponentials
!> (Section VI of Green's paper), by collocation with the internal variables eliminated
!>
!> Every impact is solved twice on the same panels, with eight stages and with seven by a companion:
!> what the two differ by is the error, of a panel and of the outcome.
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
   use vcor_impact_problem, only : hertz_contact_time, impact_t
   use vcor_impact_trajectory, only : col_impulse, col_time, col_velocity, contact_separated, &
      contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : width
   use vcor_numeric_linear, only : apply
   use vcor_solver_approach, only : approach_t
   use vcor_solver_collocator, only : accompany, advance, collocator_t, guess, most_steps, &
      new_collocator, relative_velocity, solve_step
   use vcor_solver_landing, only : end_at_zero, estimate_errors, first_without_force, land, &
      land_on_largest, share_of_difference, slope_at_end
   use vcor_solver_modes, only : modes_t, start_t
   use vcor_solver_panel, only : panel_t
   use vcor_solver_rebound, only : follow_rebound
   use vcor_solver_rebound_equations, only : rebound_start_t
   use vcor_solver_rebound_panel, only : turn_round
   use vcor_solver_recording, only : append, begin, forerunner_t
   use vcor_solver_step, only : step_t, step_to
   use vcor_solver_type, only : solver_t
   implicit none
   private

   public :: ive_t, new_ive

   !> Share of the wanted accuracy that the error of one panel may use up
   real(wp), parameter :: panel_share = 1.2_wp

   !> Share of the wanted accuracy that the kernel is approximated to, and the memory of a plate,
   !> which takes a part of the motion only
   real(wp), parameter :: kernel_share = 0.01_wp, plate_share = 0.1_wp
   !> The usual accuracy, that the lengths of the steps are given for
   real(wp), parameter :: usual = 1.0e-8_wp
   !> Error of the coefficients of restitution per relative error of the kernel [-]
   real(wp), parameter :: sensitivity = 0.3_wp

   !> First step over the usual one where the contact recedes and the kernel does not relax within
   !> it: two panels make the approach
   real(wp), parameter :: receding_reach = 1.1_wp
   !> Relative error of a sum of exponentials that makes it none
   real(wp), parameter :: no_sum = 1.0_wp
   !> Loosest accuracy that is worked to: less would save next to nothing, and one cannot tell
   !> panels that are crude from those that are wrong
   real(wp), parameter :: loosest = 1.0e-6_wp
   !> Power of the accuracy by which the first step of a receding contact is shorter where more than
   !> the usual one is asked for: the rebound feels the solution between the ends of the panels, too
   real(wp), parameter :: receding_growth = 0.1_wp
   !> What the rebound feels of the difference of the two solutions there, measured, and the share
   !> of the wanted accuracy that it may have
   real(wp), parameter :: share_of_inner = 5.0e-3_wp, inner_share = 0.3_wp

   !> Internal variable evolution
   type, extends(solver_t) :: ive_t
      private
      !> Wanted accuracy of the coefficient of restitution [-]
      real(wp) :: accuracy = 1.0e-8_wp
      !> The same as it was asked for, which may be looser than what is worked to [-]
      real(wp) :: asked = 1.0e-8_wp
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp) :: end_time = 0.0_wp
      !> Go on after the separation
      logical :: ghost = .false.
      !> Collocation rules
      type(collocator_t) :: collocator
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

      self%accuracy = min(accuracy, loosest)
      self%asked = accuracy
      self%end_time = end_time
      if (present(ghost)) self%ghost = ghost
      call new_collocator(self%collocator, self%accuracy, error)
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
      type(modes_t) :: modes
      real(wp) :: end_time, window, time_scale, error_of_sums
      logical :: complete

      time_scale = impact%time_scale()
      end_time = self%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%patience(time_scale)
      window = margin*hertz_contact_time*time_scale
      do
         call impact%kernel_exponentials(window, kernel_share*self%accuracy, modes%contact)
         if (.not. modes%contact%error < no_sum) then
            call raise(error, error_numerical, 'no sum of exponentials stands for the kernel of ' &
               //"this contact: use method = 'direct'")
            return
         end if
         if (impact%plate%hereditary()) then
            call impact%plate%memory_exponentials(window, plate_share*self%accuracy, modes%plate)
            if (.not. modes%plate%error < no_sum) then
               call raise(error, error_numerical, 'no sum of exponentials stands for what this ' &
                  //"plate remembers: use another plate.waves, or method = 'direct'")
               return
            end if
         else if (.not. allocated(modes%plate%rates)) then
            allocate (modes%plate%moduli(0), modes%plate%rates(0))
         end if
         ! a sum that is the kernel itself holds for ever, ghost lines beyond the end included
         if (.not. (modes%contact%error > 0.0_wp .or. impact%plate%hereditary())) &
            window = huge(1.0_wp)
         call follow(self, impact, modes, time_scale, end_time, window, trajectory, complete, &
            error)
         if (complete .or. allocated(error)) exit
         window = growth*window
      end do
      if (trajectory%status == contact_separated) then
         error_of_sums = sensitivity &
            *(error_felt(impact, modes%contact, window, trajectory) + modes%plate%error)
         trajectory%cor_error = trajectory%cor_error + error_of_sums
         trajectory%cor_sphere_error = trajectory%cor_sphere_error + error_of_sums
      end if
      trajectory%accuracy = self%asked
      associate (contact => modes%contact)
         if (contact%error > 0.0_wp) trajectory%kernel_terms = size(contact%rates)
         trajectory%kernel_error = contact%error
      end associate
   end subroutine solve

   !> Error of the kernel as an impact feels it: where heavy losses end the loading early in the
   !> window, that of the kernel's integral up to there, if that is more, in the share of the
   !> momentum that the loading has taken
   pure function error_felt(impact, contact, window, trajectory) result(error)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its kernel as a sum of exponentials
      type(exponential_sum_t), intent(in) :: contact
      !> Time up to which the sum holds [s]
      real(wp), intent(in) :: window
      !> Its course
      type(trajectory_t), intent(in) :: trajectory
      !> Relative error
      real(wp) :: error

      ! the error oscillates in the logarithm of the time
      real(wp), parameter :: early = 0.05_wp, part(2) = [1.0_wp, 1.5_wp]
      real(wp) :: t, lost
      integer :: i, node

      error = contact%error
      if (.not. (error > 0.0_wp .and. trajectory%time_of_max_force < early*window)) return
      do node = 1, trajectory%last - 1
         if (trajectory%state(col_time, node) >= trajectory%time_of_max_force) exit
      end do
      lost = trajectory%state(col_impulse, node)/(impact%mass*impact%velocity)
      do i = 1, size(part)
         t = part(i)*trajectory%time_of_max_force
         error = max(error, lost*abs(contact%integral(t) &
            /(impact%kernel_integral(t) + impact%kernel_viscosity()) - 1.0_wp))
      end do
   end function error_felt

   !> Follow the contact with the kernel as a sum of exponentials
   subroutine follow(self, impact, modes, time_scale, patience, window, trajectory, &
                     complete, error)
      !> The solver
      class(ive_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
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
      ! power of its length with which the error of a panel falls that ends next to a branch point
      real(wp), parameter :: order_at_branch = 2.5_wp
      ! panels that lead to such an end before it is tried again, at most
      real(wp), parameter :: most_ahead = 6.0_wp
      ! what rounding leaves in the force of stiff internal variables and dashpots, over the largest
      ! force: it is not to stop the march
      real(wp), parameter :: rounding = 1.0e-12_wp
      ! error of a panel, over what it may have, that can be put up with if it is inherited
      real(wp), parameter :: tolerable = 4.0_wp
      ! first step in x over the square root of the expected contact time, where the kernel relaxes
      ! within a step and where it does not, at accuracy 1e-8, and its power of the accuracy: with
      ! `three_panels`, which serves where nothing is halved, three make an impact, with the longest
      ! one two. A sum of both signs may fall faster than a relaxation, and needs more
      real(wp), parameter :: short_step = 0.25_wp, long_step = 0.34_wp, longest_step = 0.48_wp
      real(wp), parameter :: three_panels = 0.35_wp
      real(wp), parameter :: fast = 3.0_wp
      real(wp), parameter :: short_growth = 0.025_wp, long_growth = 0.084_wp
      ! what the two solutions differ by at the end of a panel may cancel in the next ones: of the
      ! largest difference, that much is left as an error
      real(wp), parameter :: share_of_growth = 0.03_wp
      ! residual indentation over the largest one that makes an end a smooth one
      real(wp), parameter :: shallow_end = 0.01_wp
      ! indentation at the end of the last panel over that at its start that is next to the branch
      ! point of u: from one number of stages to the next the error falls by half only, elsewhere
      ! by this factor at least
      real(wp), parameter :: next_to_branch = 0.05_wp, usually_better = 10.0_wp
      type(start_t) :: start, coarse_start
      type(step_t) :: step
      type(panel_t) :: panel, previous, coarse, recorded
      type(approach_t) :: stretches
      type(rebound_start_t) :: rebound
      type(forerunner_t) :: before
      real(wp) :: inverse(width, width)
      real(wp) :: accuracy, end_time, largest_force, peak_tolerance, force_tolerance, time_tolerance
      real(wp) :: excess, refused, growth, largest_growth, force_error, velocity, fall
      real(wp) :: end_found, inner, largest_inner, share_left, approach_error, doubt
      integer :: trial, n, ahead
      logical :: ends, last, inherited, shallow, branches, recedes, turns, signed

      n = self%collocator%rule%stages
      ! the noise of moduli of both signs is not to be resolved
      accuracy = self%accuracy
      signed = any(modes%contact%moduli < 0.0_wp)
      if (signed) accuracy = max(accuracy, sensitivity*modes%contact%error)
      complete = .true.
      end_time = patience
      allocate (start%lag(size(modes%contact%rates)), start%p(size(modes%plate%rates)))
      start%lag = 0.0_wp
      start%p = 0.0_wp
      coarse_start = start
      recedes = impact%law%receding
      largest_inner = 0.0_wp
      if (any(modes%contact%rates*time_scale > fast)) then
         step%reach = short_step*(accuracy/usual)**short_growth
         if (levels(accuracy) == 0 .and. .not. (recedes .or. signed)) step%reach = three_panels
      else if (recedes) then
         step%reach = receding_reach*long_step*(accuracy/usual)**short_growth
      else
         step%reach = min(longest_step, long_step*(accuracy/usual)**long_growth)
      end if
      if (recedes .and. accuracy < usual) step%reach = step%reach*(accuracy/usual)**receding_growth
      step%reach = step%reach*sqrt(hertz_contact_time*time_scale)
      step%length = step%reach
      if (modes%contact%error > 0.0_wp) step%length = step%reach*0.5_wp**levels(accuracy)
      ! alpha' of a frozen plate is infinite at first contact, and enters by a quadrature
      if (modes%contact%error > 0.0_wp .and. impact%plate%frozen()) &
         step%length = 0.5_wp*step%length
      call begin(self%collocator%rule, impact, trajectory)
      largest_force = 0.0_wp
      largest_growth = 0.0_wp
      refused = huge(1.0_wp)
      shallow = .false.
      branches = .false.
      end_found = 0.0_wp
      ahead = 0
      ! the force counts where it has its maximum, and at the end; elsewhere it is what is left of
      ! transients that the impulse does not feel
      peak_tolerance = 10.0_wp*max(accuracy, 1.0e-8_wp)
      force_tolerance = 1.0e3_wp*peak_tolerance
      ! between the two solutions: with panels as short as at the usual accuracy the one that counts
      ! is better by an order, unless modes of a continuous spectrum settle within the last panel,
      ! which neither of them resolves
      time_tolerance = accuracy
      if (.not. modes%contact%error > 0.0_wp) &
         time_tolerance = 3.0_wp*accuracy*min(1.0_wp, (usual/accuracy)**0.2_wp)
      time_tolerance = max(time_tolerance, 1.0e-9_wp)

      do trial = 1, most_trials
         last = start%time + step%duration() >= end_time
         if (last) step = step_to(start%time, end_time - start%time)
         call guess(self%collocator%rule, impact, previous, start, step, panel)
         call solve_step(self%collocator, step, impact, modes, start, panel, inverse)
         turns = .false.
         if (panel%converged .and. recedes) then
            velocity = trajectory%state(col_velocity, trajectory%final)
            turns = is_turning(impact, panel)
            if (turns) call land_on_largest(self%collocator, impact, modes, start, velocity, &
               step, panel, inverse)
         end if
         ends = .false.
         if (panel%converged .and. trajectory%status /= contact_separated .and. .not. recedes) &
            ends = first_without_force(panel) > 0
         if (ends) call land(self%collocator, impact, modes, start, accuracy, &
            shallow_end*trajectory%max_indentation, step, panel, inverse)
         if (.not. panel%converged) then
            call step%shorten(0.5_wp*step%duration())
            cycle
         end if
         previous = panel

         call accompany(self%collocator, step, impact, modes, coarse_start, panel, inverse, &
            coarse)
         if (.not. coarse%converged) then
            call step%shorten(0.5_wp*step%duration())
            cycle
         end if
         largest_force = max(largest_force, maxval(panel%force(1:n)))
         growth = growth_of(panel%impulse, coarse%impulse)/(impact%mass*impact%velocity)
         excess = (growth + growth_of(panel%indentation, coarse%indentation) &
            /(impact%velocity*time_scale))/(panel_share*accuracy)
         if (impact%plate%drifts()) excess = excess + growth_of(panel%drift, coarse%drift) &
            /(impact%velocity*panel_share*accuracy)
         doubt = abs(panel%force(n) - coarse%force(n - 1))
         force_error = max(0.0_wp, min(growth_of(panel%force, coarse%force), doubt) &
            - rounding*largest_force)
         if (ends) then
            ! next to u = s^1.5 = 0 both solutions err in the same direction
            shallow = panel%indentation(n) < shallow_end*trajectory%max_indentation
            if (shallow) force_error = 100.0_wp*force_error
            branches = panel%indentation(n) < next_to_branch*panel%indentation(0)
            if (branches) excess = usually_better*excess
            fall = abs(slope_at_end(self%collocator%rule, panel, panel%force))
            excess = max(excess, share(force_error, fall*(panel%time(n)*time_tolerance)))
         else if (maxval(panel%force(1:n)) > max(panel%force(0), panel%force(n))) then
            excess = max(excess, share(force_error, largest_force*peak_tolerance))
         else
            excess = max(excess, share(force_error, largest_force*force_tolerance))
         end if
         if (recedes) then
            inner = share_of_inner*difference_inside(self%collocator, panel, coarse) &
               /(impact%velocity*time_scale)
            excess = max(excess, inner/(inner_share*accuracy))
         end if
         ! what a shorter panel did not reduce has been handed down by the panels before
         inherited = excess <= tolerable .and. excess > 0.5_wp*refused
         if (.not. (excess <= 1.0_wp .or. inherited)) then
            refused = excess
            if (ends) then
               end_found = start%time + step%duration()
               ahead = 0
               if (branches) ahead = ceiling(min(most_ahead, -log(excess) &
                  /(order_at_branch*log(1.0_wp - approach)))) - 1
            end if
            call step%shorten(merge(approach, 0.5_wp, ends)*step%duration())
            cycle
         end if

         refused = huge(1.0_wp)
         recorded = panel
         largest_growth = max(largest_growth, growth)
         if (ends) then
            call estimate_errors(self%collocator%rule, impact, panel, coarse, &
               trajectory%steps + 1, branches, trajectory%cor_error, trajectory%cor_sphere_error)
            trajectory%cor_error = max(share_of_growth*largest_growth, trajectory%cor_error)
            trajectory%cor_sphere_error = max(share_of_growth*largest_growth, &
               trajectory%cor_sphere_error)
            if (shallow) then
               recorded%force(n) = 0.0_wp
            else
               call end_at_zero(self%collocator%rule, impact, recorded)
            end if
         end if
         call append(self%collocator, impact, modes, start, recorded, doubt, before, accuracy, &
            trajectory)
         before%panel = panel
         before%start = start
         before%doubt = doubt
         complete = .not. panel%time(n) > window
         if (.not. complete) return
         if (recedes) then
            largest_inner = max(largest_inner, inner)
            call stretches%add(self%collocator%rule, self%collocator%rule%map(step%index), &
               step%map_scale(), modes%contact, panel, velocity, &
               trajectory%state(col_velocity, trajectory%final - n + 1:trajectory%final))
         end if
         if (trajectory%status == contact_separated) then
            if (panel%time(n) >= end_time) return
         else if (trajectory%is_stuck(impact)) then
            trajectory%status = contact_sticking
            return
         else if (ends) then
            trajectory%status = contact_separated
            if (.not. self%ghost) return
            ahead = 0
            end_time = 2.0_wp*recorded%time(n)
            if (self%end_time > 0.0_wp) end_time = self%end_time
            if (panel%time(n) >= end_time) return
         else if (last) then
            return
         end if

         call advance(self%collocator%rule, step, modes, panel, start)
         if (turns) then
            share_left = share_of_difference(trajectory%steps)
            approach_error = largest_inner + share_left &
               *abs(panel%impulse(n) - coarse%impulse(n - 1))/(impact%mass*impact%velocity)
            call turn_round(modes, start, stretches, rebound)
            call follow_rebound(self%collocator, impact, modes, stretches, rebound, accuracy, &
               end_time, trajectory, error)
            complete = .not. trajectory%state(col_time, trajectory%final) > window
            trajectory%cor_sphere_error = trajectory%cor_sphere_error + approach_error
            trajectory%cor_error = trajectory%cor_error + approach_error &
               + share_left*abs(panel%drift(n) - coarse%drift(n - 1))/impact%velocity
            return
         end if
         call advance(self%collocator%coarse, step, modes, coarse, coarse_start)
         if (ahead > 0) then
            ! the end is not tried before the panels that lead to it
            ahead = ahead - 1
            step = step_to(start%time, approach*(end_found - start%time))
         else
            call step%proceed(min(3.0_wp, max(excess, tiny(1.0_wp)) &
               **(-1.0_wp/real(2*n - 2, wp))), most_steps)
         end if
      end do
      call raise(error, error_numerical, 'the internal-variable method does not get to the end ' &
         //'of the contact: the accuracy asked for is out of reach')

   contains

      !> Error over what it may be, at most `immense`: the forces of a fluid may be next to nothing
      pure function share(actual, allowed)
         !> Error, >= 0
         real(wp), intent(in) :: actual
         !> What it may be, >= 0
         real(wp), intent(in) :: allowed
         !> Ratio
         real(wp) :: share

         real(wp), parameter :: immense = 1.0e30_wp

         share = 0.0_wp
         if (actual > 0.0_wp) share = immense
         if (actual < immense*allowed) share = actual/allowed
      end function share

      !> By how much the difference of the two solutions grows over the panel
      pure function growth_of(one, other) result(difference)
         !> Values of the solution at the points of the panel
         real(wp), intent(in) :: one(0:)
         !> Values of the companion
         real(wp), intent(in) :: other(0:)
         !> Growth
         real(wp) :: difference

         difference = abs((one(n) - other(n - 1)) - (one(0) - other(0)))
      end function growth_of
   end subroutine follow

   !> Whether the indentation has begun to fall
   pure function is_turning(impact, panel)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Whether it has
      logical :: is_turning

      integer :: j

      is_turning = .false.
      do j = 1, panel%stages
         is_turning = relative_velocity(impact, panel, j) < 0.0_wp
         if (is_turning) return
      end do
   end function is_turning

   !> Largest difference of the two solutions between the ends of a panel [m]
   pure function difference_inside(collocator, panel, coarse) result(difference)
      !> The collocation
      type(collocator_t), intent(in) :: collocator
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Its companion
      type(panel_t), intent(in) :: coarse
      !> Difference
      real(wp) :: difference

      difference = maxval(abs(collocator%to_coarse(:, 0)*panel%indentation(0) &
         + apply(collocator%to_coarse(:, 1:), panel%indentation(1:)) - coarse%indentation(1:)))
   end function difference_inside

   !> Number of times that the first step is halved for a kernel with a continuous spectrum: in it
   !> collocation does not resolve the internal variables that settle within the step
   pure function levels(accuracy)
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Number
      integer :: levels

      levels = max(0, ceiling(log(4.0e-7_wp/(panel_share*accuracy))/log(16.0_wp)))
   end function levels

end module vcor_solver_ive
