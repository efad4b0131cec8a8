!> The contact in the internal-variable method: from first touch to its end, or to the largest
!> indentation if it recedes from there on
!>
!> Near first contact the panels are steps in x = sqrt(t), in which the solution, with u(s), is
!> analytic from the start; later, far from the branch point at t = 0, they are steps in t. Each
!> panel is solved with eight stages and, by its companion, with seven; their difference decides
!> whether it is accepted or halved. The last panel is solved again until it ends where the force is
!> zero: collocation is most accurate at the end of a panel (order 2 n - 1), and all integrals over
!> the contact are then sums over whole panels. Towards the end of a nearly elastic contact, where s
!> goes to zero as well and u(s) loses its derivatives, the panels shrink geometrically.
module vcor_solver_ive_contact
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_time, col_velocity, contact_separated, trajectory_t
   use vcor_kinds, only : finest_accuracy, wp
   use vcor_numeric_radau_algebra, only : width
   use vcor_numeric_radau_collocation, only : collocation_t, most_steps
   use vcor_solver_ive_approach, only : approach_t
   use vcor_solver_ive_collocator, only : collocator_t
   use vcor_solver_ive_course, only : course_t, share
   use vcor_solver_ive_landing, only : end_at_zero, first_without_force, hides_a_zero, &
      land_on_largest, land_on_zero, slope_at_end
   use vcor_solver_ive_modes, only : modes_t
   use vcor_solver_ive_newton, only : guess, solve, solve_companion
   use vcor_solver_ive_panel, only : panel_t, step_to
   use vcor_solver_ive_peaks, only : earlier_panel_t, find_peaks
   use vcor_solver_ive_problem, only : new_panel_problem
   use vcor_solver_ive_rebound, only : follow_rebound
   use vcor_tuning, only : branch_error, cut_at_end, error_of_kernel, fast, &
      first_growth_fast, first_growth_slow, first_longest, first_receding, &
      first_drift, first_receding_growth, first_short, first_slow, first_three, &
      force_share, harmless, inner_allowed, inner_felt, levels_base, &
      levels_error, most_ahead, most_panels, next_to_branch, panel_share, peak_share, &
      rounding_of_fall, rounding_of_force, rounding_per_panel, shallow_end, shallow_factor, &
      tolerable, usual_accuracy, usually_better
   implicit none
   private

   public :: follow

   !> Integration of the contact
   type, extends(course_t) :: contact_t
      !> Whether the contact recedes after the largest indentation, and whether this is in the panel
      logical :: recedes = .false., turns = .false.
      !> Rate of the indentation at the start of the panel [m/s]
      real(wp) :: velocity = 0.0_wp
      !> The panel before
      type(earlier_panel_t) :: before
      !> Difference of the force to that of the companion at the end of the panel [N]
      real(wp) :: force_difference = 0.0_wp
      !> Largest force so far [N]
      real(wp) :: largest_force = 0.0_wp
      !> Contribution of the panel to the error of the motion, and the largest one so far [-]
      real(wp) :: growth = 0.0_wp, largest_growth = 0.0_wp
      !> Effect on a rebound of the difference of the two solutions inside the panel, and the
      !> largest one so far [-]
      real(wp) :: inner = 0.0_wp, largest_inner = 0.0_wp
      !> Effect on a rebound of the branch point of the force at first contact [-]
      real(wp) :: branch_felt = 0.0_wp
      !> Whether the panel ends near s = 0, and whether also near the branch point of u(s)
      logical :: shallow = .false., ends_at_branch = .false.
      !> End of the contact that was refused [s], and number of panels before it is tried again
      real(wp) :: end_found = 0.0_wp
      integer :: ahead = 0
   end type contact_t

contains

   !> Integrate the contact with the kernel as a sum of exponentials
   subroutine follow(collocator, impact, modes, accuracy, time_scale, end_time, ghost_end, window, &
                     trajectory, complete, error)
      type(collocator_t), intent(in), target :: collocator
      type(impact_t), intent(in), target :: impact
      type(modes_t), intent(in), target :: modes
      !> Accuracy wanted of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Time scale of the contact [s]
      real(wp), intent(in) :: time_scale
      !> End of the computation if the contact lasts [s]
      real(wp), intent(in) :: end_time
      !> End of the computation beyond the separation [s]; 0: twice the contact time, negative: none
      real(wp), intent(in) :: ghost_end
      !> Time up to which the sums hold [s]
      real(wp), intent(in) :: window
      type(trajectory_t), intent(out) :: trajectory
      !> Whether the window was long enough
      logical, intent(out) :: complete
      type(error_t), allocatable, intent(out) :: error

      type(contact_t) :: contact
      type(approach_t), target :: approach
      integer :: trial
      logical :: over

      contact%problem = new_panel_problem(collocator, impact, modes)
      contact%time_scale = time_scale
      contact%speed = impact%speed_scale(time_scale)
      ! relative to `speed`: v0 may be near zero for a sphere that is put down
      contact%accuracy = max(accuracy*(impact%velocity/contact%speed), &
         min(accuracy, finest_accuracy))
      contact%end_time = end_time
      call start(contact)
      call contact%begin(trajectory)
      complete = .true.
      do trial = 1, most_panels
         ! a panel of no length: shorter ones do not help
         if (.not. contact%step%duration() > epsilon(1.0_wp)**2*time_scale) then
            call trajectory%stop_at_rest(impact, .true., over)
            if (over) return
            exit
         end if
         call solve_panel(contact, trajectory)
         if (.not. (contact%panel%converged .and. contact%coarse%converged)) then
            call contact%step%shorten(0.5_wp*contact%step%duration())
            cycle
         end if
         call judge(contact, trajectory)
         if (is_refused(contact, trajectory%max_force)) then
            call shorten(contact)
            cycle
         end if
         call accept(contact, approach, trajectory)
         complete = .not. contact%panel%time(contact%panel%stages) > window
         if (.not. complete) return
         call stop_at_end(contact, ghost_end, trajectory, over)
         if (over) return
         if (contact%turns) then
            call continue_with_rebound(contact, approach, trajectory, error)
            complete = .not. trajectory%state(col_time, trajectory%final) > window
            return
         end if
         call go_on(contact)
      end do
      call raise(error, error_numerical, 'the internal-variable method does not get to the end ' &
         //'of the contact: the accuracy asked for is out of reach')
   end subroutine follow

   !> First step: the square root of a part of the expected contact time, in x = sqrt(t)
   subroutine start(self)
      type(contact_t), intent(inout) :: self

      real(wp) :: reach, finer
      logical :: continuous, signed, relaxes

      associate (contact => self%problem%modes%contact, impact => self%problem%impact)
         continuous = contact%error > 0.0_wp
         signed = any(contact%moduli < 0.0_wp)
         ! the noise of moduli of both signs must not be resolved
         if (signed) self%accuracy = max(self%accuracy, error_of_kernel*contact%error)
         finer = self%accuracy/usual_accuracy
         self%recedes = impact%law%receding
         self%start%alpha = impact%plate%alpha(0.0_wp)
         self%start%force = impact%first_force()
         self%velocity = impact%velocity - self%start%alpha*self%start%force
         allocate (self%start%lag(size(contact%rates)), source=0.0_wp)
         if (impact%plate%hereditary()) &
            allocate (self%start%p(size(self%problem%modes%plate%rates)), source=0.0_wp)
         self%coarse_start = self%start

         relaxes = any(contact%rates*self%time_scale > fast)
         if (relaxes) then
            reach = first_short*finer**first_growth_fast
            if (levels(self%accuracy) == 0 .and. .not. (self%recedes .or. signed)) &
               reach = first_three
         else if (self%recedes) then
            reach = first_receding*first_slow*finer**first_growth_fast
         else
            reach = min(first_longest, first_slow*finer**first_growth_slow)
         end if
         if (self%recedes .and. finer < 1.0_wp) reach = reach*finer**first_receding_growth
         self%step%reach = reach*sqrt(impact%law%contact_time*self%time_scale)
         if (self%recedes) call shorten_at_branch(self)
         self%step%length = self%step%reach
         if (continuous) self%step%length = self%step%reach*0.5_wp**levels(self%accuracy)
      end associate
   end subroutine start

   !> Shorten the first step of a receding contact if the force, x^(2 n) at first, is no polynomial
   !> in x = sqrt(t). The rebound uses the polynomial of the panel, whose error falls as the force
   !> times the time over which it acts
   pure subroutine shorten_at_branch(self)
      type(contact_t), intent(inout) :: self

      real(wp) :: power, allowed

      associate (law => self%problem%impact%law)
         power = 1.0_wp + law%start_exponent
         self%branch_felt = branch_error*abs(2.0_wp*power - anint(2.0_wp*power)) &
            *(self%step%reach**2/(0.5_wp*law%contact_time*self%time_scale))**power
         allowed = inner_allowed*self%accuracy
         if (self%branch_felt <= allowed) return
         self%step%reach = self%step%reach*(allowed/self%branch_felt)**(0.5_wp/power)
         self%branch_felt = allowed
      end associate
   end subroutine shorten_at_branch

   !> Number of halvings of the first step for a kernel with a continuous spectrum: collocation does
   !> not resolve the internal variables that settle within it
   pure function levels(accuracy)
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Number
      integer :: levels

      levels = max(0, ceiling(log(levels_error/accuracy)/log(levels_base)))
   end function levels

   !> Solve the next panel, cut at the end of the contact or at the largest indentation if it
   !> contains one, and its companion
   subroutine solve_panel(self, trajectory)
      type(contact_t), intent(inout) :: self
      type(trajectory_t), intent(in) :: trajectory

      associate (problem => self%problem, rule => self%problem%collocator%rule)
         self%reaches_end_time = self%start%time + self%step%duration() >= self%end_time
         if (self%reaches_end_time) self%step = step_to(self%start%time, &
            self%end_time - self%start%time)
         call guess(problem, self%previous, self%step, self%start, self%panel)
         call solve(problem, rule, self%step, self%start, self%panel, self%inverse)
         self%turns = .false.
         self%ends = .false.
         if (self%panel%converged .and. self%recedes) then
            self%turns = is_turning(self)
            if (self%turns) call land_on_largest(problem, self%start, self%velocity, &
               self%accuracy, self%step, self%panel, self%inverse)
         else if (self%panel%converged .and. trajectory%status /= contact_separated) then
            self%ends = first_without_force(self%panel) > 0
            if (self%ends) call land_on_zero(problem, self%start, self%accuracy, &
               shallow_end*trajectory%max_indentation, self%step, self%panel, self%inverse)
         end if
         if (.not. self%panel%converged) return
         self%previous = self%panel
         call solve_companion(problem, self%step, self%coarse_start, self%panel, self%inverse, &
            self%coarse)
      end associate
   end subroutine solve_panel

   !> Whether the indentation has begun to fall
   pure function is_turning(self)
      !> The contact, its panel solved
      type(contact_t), intent(in) :: self
      logical :: is_turning

      integer :: j

      is_turning = .false.
      do j = 1, self%panel%stages
         is_turning = self%problem%relative_velocity(self%panel, j) < 0.0_wp
         if (is_turning) return
      end do
   end function is_turning

   !> Error of the panel over the allowed one: of the motion, and of the force at its maximum and at
   !> the end of the contact. Elsewhere errors of the force are remainders of transients, which the
   !> impulse does not feel
   subroutine judge(self, trajectory)
      type(contact_t), intent(inout) :: self
      type(trajectory_t), intent(in) :: trajectory

      real(wp) :: force_error, allowed, cor_error, sphere_error, inherited
      integer :: n, j

      n = self%panel%stages
      associate (panel => self%panel, coarse => self%coarse, impact => self%problem%impact, &
                 collocator => self%problem%collocator)
         ! the indentation is what is left of the fall g t^2/2: its rounding must not be resolved
         self%accuracy = max(self%accuracy, rounding_of_fall*0.5_wp*impact%gravity &
            *panel%time(0)**2/(self%speed*self%time_scale))
         self%largest_force = max(self%largest_force, maxval(panel%force(1:n)))
         self%growth = self%motion_error()
         self%excess = self%growth/(panel_share*self%accuracy)
         ! alpha' of a frozen plate is infinite at first contact, or a spike that both solutions
         ! miss, and the error remains for the rest of the contact
         if (impact%plate%frozen() .and. .not. self%start%time > 0.0_wp) self%excess = &
            max(self%growth, missed_drift(collocator%rule, panel)/self%speed) &
            /(first_drift*self%accuracy)
         self%force_difference = abs(panel%force(n) - coarse%force(n - 1))
         if (self%excess <= 1.0_wp) &
            self%excess = max(self%excess, work_error(self)/(panel_share*self%accuracy))
         force_error = self%force_difference
         allowed = peak_share*self%largest_force*max(self%accuracy, usual_accuracy)
         if (trajectory%status /= contact_separated .and. .not. self%recedes &
             .and. 2.0_wp*panel%force(n) < panel%force(n - 1)) then
            ! an error of the force here shifts the end of the contact
            force_error = max(force_error, settled_error(self))
            allowed = abs(slope_at_end(collocator%rule, panel, panel%force)) &
               *panel%time(n)*self%time_tolerance()
         else if (.not. maxval(panel%force(1:n)) > max(panel%force(0), panel%force(n))) then
            allowed = force_share*allowed
         end if
         if (self%ends) then
            self%shallow = panel%indentation(n) < shallow_end*trajectory%max_indentation
            ! near u(s) = 0 both solutions have errors of the same sign
            if (self%shallow) force_error = max(force_error, shallow_factor &
               *min(self%growth_of(panel%force, coarse%force), self%force_difference))
            self%ends_at_branch = panel%indentation(n) < next_to_branch*panel%indentation(0)
            if (self%ends_at_branch) self%excess = usually_better*self%excess
            call estimate_errors(self, trajectory%steps + 1, cor_error, sphere_error)
            self%excess = max(self%excess, cor_error/self%accuracy)
         end if
         ! a force that is mere rounding has no error
         force_error = max(0.0_wp, min(force_error, maxval(panel%force(0:n))) &
            - rounding_of_force*self%largest_force)
         self%excess = max(self%excess, share(force_error, allowed))
         if (self%recedes) then
            ! the rebound also uses the solution between the ends of the panels
            self%inner = inner_felt*maxval(abs(collocator%coarsened(panel%indentation) &
               - coarse%indentation(1:)))/(self%speed*self%time_scale)
            ! an inherited error does not depend on the length of the panel
            inherited = inner_felt*abs(panel%indentation(0) - coarse%indentation(0)) &
               /(self%speed*self%time_scale)
            self%excess = max(self%excess, (self%inner - inherited)/(inner_allowed*self%accuracy))
         end if
         do j = 1, n
            if (any(impact%outruns(panel%alpha(j - 1), panel%alpha(j), panel%impulse(j:n), &
                panel%time(j:n)))) self%excess = huge(1.0_wp)
         end do
         if (trajectory%status /= contact_separated .and. .not. (self%ends .or. self%recedes)) then
            if (hides_a_zero(collocator%rule, panel, rounding_of_force*self%largest_force)) &
               self%excess = huge(1.0_wp)
         end if
      end associate
   end subroutine judge

   !> Error of the force at the end of the panel that both solutions may share. The force of a
   !> dashpot and of modes that settle within the panel follows the rate of u, the derivative of a
   !> polynomial, known to one order less than u: the error is the contribution of its last
   !> coefficient. A polynomial of n stages resolves modes with l dt/dtheta < n (n + 1)
   pure function settled_error(self) result(error)
      type(contact_t), intent(in) :: self
      !> Error [N]
      real(wp) :: error

      real(wp) :: pace, viscosity

      associate (n => self%panel%stages, rule => self%problem%collocator%rule, &
                 contact => self%problem%modes%contact, law => self%problem%impact%law)
         pace = self%panel%pace_at_end()
         viscosity = contact%viscosity + sum(contact%moduli/contact%rates &
            *exp(-real(n*(n + 1), wp)/(contact%rates*pace)))
         error = abs(viscosity*sum(rule%barycentric*law%u(self%panel%indentation)) &
            /(rule%barycentric(n)*pace))
      end associate
   end function settled_error

   !> Drift int alpha' F dt of a frozen plate that the first panel may miss: its difference from
   !> alpha F - int alpha dF, whose integrand has no spike where alpha rises at once, and the gain
   !> of alpha before the first stage
   pure function missed_drift(rule, panel) result(missed)
      type(collocation_t), intent(in) :: rule
      type(panel_t), intent(in) :: panel
      !> Drift [m/s]
      real(wp) :: missed

      real(wp) :: rise(0:width)

      rise = rule%slopes(panel%force)
      associate (n => panel%stages, alpha => panel%alpha, force => panel%force)
         missed = max((alpha(1) - alpha(0))*force(1), abs(alpha(n)*force(n) - alpha(0)*force(0) &
            - sum(rule%weight(1:n)*alpha(1:n)*rise(1:n)) - (panel%drift(n) - panel%drift(0))))
      end associate
   end function missed_drift

   !> Contribution of the panel to the error of the energy that the plate takes, int alpha F^2, over
   !> the energy at the reference velocity, without gravity the initial one: forces inside a panel
   !> are less accurate than the motion, and squaring does not average their errors out
   pure function work_error(self) result(error)
      type(contact_t), intent(in) :: self
      !> Error [-]
      real(wp) :: error

      associate (collocator => self%problem%collocator, impact => self%problem%impact)
         error = abs(work(collocator%rule, self%panel) - work(collocator%coarse, self%coarse)) &
            /(0.5_wp*impact%mass*self%speed**2)
      end associate

   contains

      !> int alpha F^2 over a panel [J]
      pure function work(rule, panel)
         type(collocation_t), intent(in) :: rule
         type(panel_t), intent(in) :: panel
         !> Energy [J]
         real(wp) :: work

         associate (n => panel%stages, map => panel%map)
            work = sum(rule%weight(1:n)*(map(1) + 2.0_wp*map(2)*rule%node(1:n)) &
               *panel%alpha(1:n)*panel%force(1:n)**2)
         end associate
      end function work
   end function work_error

   !> Whether the panel is refused
   pure function is_refused(self, max_force)
      type(contact_t), intent(in) :: self
      !> Largest force of the panels before [N]
      real(wp), intent(in) :: max_force
      logical :: is_refused

      ! an error that a shorter panel did not reduce is inherited from earlier panels
      is_refused = .not. (self%excess <= 1.0_wp &
         .or. self%excess <= tolerable .and. self%excess > 0.5_wp*self%refused)
      ! a zero of a force that is all rounding is no end
      if (is_refused .and. misses_its_end_only(self)) is_refused = .not. (self%is_best_end() &
         .and. self%force_difference <= max_force)
   end function is_refused

   !> Whether the panel is accurate but for its end; next to a branch point only if the excess is
   !> small, as rounding is
   pure function misses_its_end_only(self) result(misses)
      !> The contact, its panel not accurate enough
      type(contact_t), intent(in) :: self
      logical :: misses

      misses = self%ends .and. self%growth <= panel_share*self%accuracy &
         .and. (self%excess <= tolerable .or. .not. (self%ends_at_branch .or. self%shallow))
   end function misses_its_end_only

   !> Shorten a panel that was refused
   subroutine shorten(self)
      type(contact_t), intent(inout) :: self

      self%refused = self%excess
      if (misses_its_end_only(self)) then
         self%refused_end = self%excess
         self%refused_ends = self%refused_ends + 1
      end if
      if (self%ends) then
         ! next to a branch point the error falls only as s u(s): other panels must first lead to
         ! the end
         self%end_found = self%start%time + self%step%duration()
         self%ahead = 0
         if (self%ends_at_branch) self%ahead = ceiling(min(most_ahead, -log(self%excess) &
            /((1.0_wp + self%problem%impact%law%start_exponent)*log(1.0_wp - cut_at_end)))) - 1
      end if
      call self%step%shorten(merge(cut_at_end, 0.5_wp, self%ends)*self%step%duration())
   end subroutine shorten

   !> Accept the panel: add it to the trajectory
   subroutine accept(self, approach, trajectory)
      type(contact_t), intent(inout) :: self
      !> The approach of a contact that recedes
      type(approach_t), intent(inout) :: approach
      type(trajectory_t), intent(inout) :: trajectory

      type(panel_t) :: recorded
      integer :: n

      n = self%panel%stages
      self%refused = huge(1.0_wp)
      associate (problem => self%problem, rule => self%problem%collocator%rule)
         recorded = self%panel
         self%largest_growth = max(self%largest_growth, self%growth)
         if (self%ends) then
            call estimate_errors(self, trajectory%steps + 1, trajectory%cor_error, &
               trajectory%cor_sphere_error)
            if (self%shallow) then
               recorded%force(n) = 0.0_wp
            else
               call end_at_zero(rule, problem%impact, recorded)
            end if
         end if
         call self%record(recorded, trajectory)
         if (trajectory%status /= contact_separated) then
            trajectory%last = trajectory%final
            call find_peaks(problem, self%start, recorded, self%force_difference, self%before, &
               self%accuracy, trajectory)
         end if
         if (self%recedes) then
            self%largest_inner = max(self%largest_inner, self%inner)
            call approach%add(problem%impact%law, rule, self%step, problem%modes%contact, &
               self%panel, self%velocity, &
               trajectory%state(col_velocity, trajectory%final - n + 1:trajectory%final))
         end if
         self%velocity = trajectory%state(col_velocity, trajectory%final)
         self%before%panel = self%panel
         self%before%start = self%start
         self%before%force_difference = self%force_difference
      end associate
   end subroutine accept

   !> Set the status if the contact ends with the panel, and the end of the computation beyond
   subroutine stop_at_end(self, ghost_end, trajectory, over)
      type(contact_t), intent(inout) :: self
      !> End of the computation beyond the separation [s]; 0: twice the contact time, negative: none
      real(wp), intent(in) :: ghost_end
      type(trajectory_t), intent(inout) :: trajectory
      !> Whether the computation has ended, too
      logical, intent(out) :: over

      if (trajectory%status == contact_separated) then
         over = self%panel%time(self%panel%stages) >= self%end_time
         return
      end if
      call trajectory%stop_at_rest(self%problem%impact, self%reaches_end_time, over)
      if (over) return
      over = self%reaches_end_time
      if (self%ends) then
         trajectory%status = contact_separated
         self%ahead = 0
         self%end_time = ghost_end
         if (.not. abs(ghost_end) > 0.0_wp) &
            self%end_time = 2.0_wp*trajectory%state(col_time, trajectory%last)
         over = self%panel%time(self%panel%stages) >= self%end_time
      end if
   end subroutine stop_at_end

   !> Advance to the next step; if an end was refused, first to the panels that lead to it
   subroutine go_on(self)
      type(contact_t), intent(inout) :: self

      associate (problem => self%problem)
         call problem%advance(problem%collocator%rule, self%step, self%panel, self%start)
         call problem%advance(problem%collocator%coarse, self%step, self%coarse, self%coarse_start)
      end associate
      if (self%ahead > 0) then
         self%ahead = self%ahead - 1
         self%step = step_to(self%start%time, cut_at_end*(self%end_found - self%start%time))
      else
         call self%step%proceed(self%growth_of_step(), most_steps)
      end if
   end subroutine go_on

   !> Continue with the rebound of a receding contact
   subroutine continue_with_rebound(self, approach, trajectory, error)
      !> The contact, at its largest indentation
      type(contact_t), intent(inout) :: self
      type(approach_t), intent(in), target :: approach
      type(trajectory_t), intent(inout) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: part, sphere_error, cor_error

      associate (n => self%panel%stages, panel => self%panel, coarse => self%coarse, &
                 impact => self%problem%impact)
         part = error_over_difference(self)
         sphere_error = self%largest_inner + self%branch_felt + impulse_error(self, part) &
            /(impact%mass*impact%velocity)
         cor_error = sphere_error + part*abs(panel%drift(n) - coarse%drift(n - 1))/impact%velocity &
            + plate_error(self, part)
      end associate
      call self%problem%advance(self%problem%collocator%rule, self%step, self%panel, self%start)
      call follow_rebound(self%course_t, approach, trajectory, error)
      trajectory%cor_sphere_error = trajectory%cor_sphere_error + sphere_error
      trajectory%cor_error = trajectory%cor_error + cor_error
   end subroutine continue_with_rebound

   !> Errors of the coefficients of restitution: with F = 0 at the end, s' = v0 - I/m - alpha' I and
   !> z' = v0 - I/m. The companion reaches F = 0 slightly earlier or later, which affects only the
   !> terms of gravity, alpha' and drift
   pure subroutine estimate_errors(self, panels, cor_error, cor_sphere_error)
      !> The contact, at its end
      type(contact_t), intent(in) :: self
      !> Number of panels
      integer, intent(in) :: panels
      !> Error of the one by the relative velocity [-]
      real(wp), intent(out) :: cor_error
      !> Error of the one of the sphere alone [-]
      real(wp), intent(out) :: cor_sphere_error

      real(wp) :: impulse, time, fall, moved, plate, least, part

      associate (n => self%panel%stages, panel => self%panel, coarse => self%coarse, &
                 impact => self%problem%impact, rule => self%problem%collocator%rule)
         part = error_over_difference(self)
         impulse = impulse_error(self, part)
         fall = slope_at_end(rule, panel, panel%force)
         time = part*abs((panel%force(n) - coarse%force(n - 1))/fall)
         ! the end is moved to the zero of the force along straight lines: the errors of this in the
         ! impulse and in the velocity of the plate
         moved = panel%force(n)/fall
         plate = impact%free_path(panel%time(n)) - panel%second_impulse(n)/impact%mass &
            - panel%indentation(n)
         least = rounding_per_panel*real(panels, wp) &
            + abs(panel%force(n)*moved)/(impact%mass*impact%velocity)
         cor_sphere_error = least + (impulse/impact%mass + impact%gravity*time)/impact%velocity
         cor_error = cor_sphere_error + abs(plate)/(impact%velocity*panel%time(n)) &
            *(moved/panel%time(n))**2 + plate_error(self, part) &
            + (time*(self%plate_gains() &
            + abs(slope_at_end(rule, panel, panel%drift))) &
            + part*abs(panel%drift(n) - coarse%drift(n - 1)))/impact%velocity
      end associate
   end subroutine estimate_errors

   !> Error of the velocity alpha' I of a plate whose alpha grows, over the initial velocity
   pure function plate_error(self, part) result(error)
      !> The contact, its panel solved
      type(contact_t), intent(in) :: self
      !> Error of the solution over its difference to the companion
      real(wp), intent(in) :: part
      !> Error [-]
      real(wp) :: error

      associate (n => self%panel%stages)
         error = part*abs(self%panel%impulse(n) - self%coarse%impulse(n - 1))*self%alpha_rate() &
            /self%problem%impact%velocity
      end associate
   end function plate_error

   !> Error of the impulse. The contributions of the panels to the difference to the companion may
   !> cancel, so the largest contribution of a panel to the error of the motion counts, too
   pure function impulse_error(self, part) result(error)
      !> The contact, its panel accepted
      type(contact_t), intent(in) :: self
      !> Error of the solution over its difference to the companion
      real(wp), intent(in) :: part
      !> Error [N s]
      real(wp) :: error

      associate (n => self%panel%stages, impact => self%problem%impact)
         error = max(part*abs(self%panel%impulse(n) - self%coarse%impulse(n - 1)), &
            min(part*self%largest_growth, harmless*self%accuracy)*impact%mass*self%speed)
         ! next to a branch point the last panel is no more accurate than its companion
         if (self%ends_at_branch) error = max(error, self%growth*impact%mass*self%speed)
      end associate
   end function impulse_error

   !> Error of the solution over its difference to the companion. It is 1 where the solution is no
   !> better: next to the branch point of u, for a frozen plate whose alpha' is infinite at first
   !> contact, and for a plate whose velocity depends on the impulse more than the sphere's does
   pure function error_over_difference(self) result(part)
      !> The contact, its panel solved
      type(contact_t), intent(in) :: self
      real(wp) :: part

      associate (problem => self%problem)
         part = 1.0_wp/self%improvement()
         if (self%ends_at_branch .or. self%alpha_rate()*problem%impact%mass > 1.0_wp .or. &
             problem%impact%plate%frozen() .and. problem%modes%contact%error > 0.0_wp) part = 1.0_wp
      end associate
   end function error_over_difference

end module vcor_solver_ive_contact
