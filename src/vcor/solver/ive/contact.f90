!> The contact in the internal-variable method, from first touch to its end, or to the largest
!> indentation where the contact recedes from there on
!>
!> Close to first contact the panels are steps in x = sqrt(t), in which the solution is analytic
!> from the start, u(s) included; later, where the branch point at t = 0 has become remote, steps
!> in t. Each is solved with eight stages and with seven by its companion, and what the two differ
!> by decides whether the panel is accepted or halved. The last one is solved anew until it ends
!> where the force is zero: the end of a panel is where collocation is most accurate
!> (order 2 n - 1), and all integrals over the contact are then sums over whole panels. Towards the
!> end of a nearly elastic contact, where s goes to zero as well and u(s) loses its derivatives, the
!> panels shrink geometrically.
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
   use vcor_solver_ive_newton, only : accompany, guess, solve
   use vcor_solver_ive_panel, only : panel_t, plate_gains, relative_velocity
   use vcor_solver_ive_problem, only : new_panel_problem
   use vcor_solver_ive_rebound, only : follow_rebound
   use vcor_solver_ive_recording, only : begin, find_peaks, forerunner_t, record
   use vcor_solver_ive_step, only : step_to
   use vcor_solver_tuning, only : branch_error, cut_at_end, error_of_kernel, fast, &
      first_growth_fast, first_growth_slow, first_longest, first_receding, &
      first_drift, first_receding_growth, first_short, first_slow, first_three, &
      force_share, harmless, inner_allowed, inner_felt, layer_accuracy, levels_base, &
      levels_error, most_ahead, most_panels, next_to_branch, panel_share, peak_share, &
      rounding_of_force, rounding_per_panel, shallow_end, shallow_factor, &
      tolerable, usual_accuracy, usually_better
   implicit none
   private

   public :: follow

   !> The contact until it ends
   type, extends(course_t) :: contact_t
      !> Whether the contact recedes after the largest indentation, and whether that is in the panel
      logical :: recedes = .false., turns = .false.
      !> Rate of the indentation at the start of the panel [m/s]
      real(wp) :: velocity = 0.0_wp
      !> The panel before
      type(forerunner_t) :: before
      !> Difference of the force to that of the companion at the end of the panel [N]
      real(wp) :: doubt = 0.0_wp
      !> Largest force so far [N]
      real(wp) :: largest_force = 0.0_wp
      !> What the panel adds to the error of the motion, and the most that one has added [-]
      real(wp) :: growth = 0.0_wp, largest_growth = 0.0_wp
      !> Difference of the impulse to those of the companions of the panels before, where each of
      !> them starts from the solution [N s]
      real(wp) :: handed_down = 0.0_wp
      !> What a rebound feels of the difference of the two solutions inside the panel, and the most
      !> that it has felt [-]
      real(wp) :: inner = 0.0_wp, largest_inner = 0.0_wp
      !> What a rebound feels of the branch point of the force at first contact [-]
      real(wp) :: branch_felt = 0.0_wp
      !> Whether the panel ends next to s = 0, and with it next to the branch point of u(s)
      logical :: shallow = .false., ends_at_branch = .false.
      !> End of the contact that was refused [s], and panels to come before it is tried again
      real(wp) :: end_found = 0.0_wp
      integer :: ahead = 0
   end type contact_t

contains

   !> Follow the contact with the kernel as a sum of exponentials
   subroutine follow(collocator, impact, modes, accuracy, time_scale, end_time, ghost_end, window, &
                     trajectory, complete, error)
      type(collocator_t), intent(in), target :: collocator
      type(impact_t), intent(in), target :: impact
      type(modes_t), intent(in), target :: modes
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Time scale of the contact [s]
      real(wp), intent(in) :: time_scale
      !> End of the computation if the contact lasts [s]
      real(wp), intent(in) :: end_time
      !> End of the computation beyond the separation [s]; 0: twice the contact time, negative: none
      real(wp), intent(in) :: ghost_end
      !> Time up to which the sum holds [s]
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
      ! of a sphere that is put down rather than thrown, v0 is no measure
      contact%accuracy = max(accuracy*(impact%velocity/contact%speed), &
         min(accuracy, finest_accuracy))
      contact%end_time = end_time
      call start(contact)
      call begin(collocator%rule, impact, trajectory)
      complete = .true.
      do trial = 1, most_panels
         ! a panel that has been cut to nothing: no other one does better
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
         if (is_refused(contact)) then
            call shorten(contact)
            cycle
         end if
         call accept(contact, approach, trajectory)
         complete = .not. contact%panel%time(contact%panel%stages) > window
         if (.not. complete) return
         call stop_at_end(contact, ghost_end, trajectory, over)
         if (over) return
         if (contact%turns) then
            call turn_round(contact, approach, trajectory, error)
            complete = .not. trajectory%state(col_time, trajectory%final) > window
            return
         end if
         call go_on(contact)
      end do
      call raise(error, error_numerical, 'the internal-variable method does not get to the end ' &
         //'of the contact: the accuracy asked for is out of reach')
   end subroutine follow

   !> First step: the square root of some part of the expected contact time, in x = sqrt(t)
   subroutine start(self)
      type(contact_t), intent(inout) :: self

      real(wp) :: reach, finer
      logical :: continuous, signed, relaxes

      associate (contact => self%problem%modes%contact, impact => self%problem%impact)
         continuous = contact%error > 0.0_wp
         signed = any(contact%moduli < 0.0_wp)
         ! the noise of moduli of both signs is not to be resolved
         if (signed) self%accuracy = max(self%accuracy, error_of_kernel*contact%error)
         if (impact%plate%layered()) &
            self%accuracy = max(self%accuracy, layer_accuracy, self%problem%modes%plate%error)
         finer = self%accuracy/usual_accuracy
         self%recedes = impact%law%receding
         self%start%alpha = impact%plate%alpha(0.0_wp)
         self%start%force = impact%first_force()
         self%velocity = impact%velocity - self%start%alpha*self%start%force
         allocate (self%start%lag(size(contact%rates)), source=0.0_wp)
         if (impact%plate%hereditary()) &
            allocate (self%start%p(self%problem%modes%plate%variables()), source=0.0_wp)
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

   !> Shorten the first step of a contact that recedes where the force, x^(2 n) at first, is no
   !> polynomial in x = sqrt(t). The rebound takes it from that of the panel; the error falls as
   !> the force and the time that it acts
   pure subroutine shorten_at_branch(self)
      type(contact_t), intent(inout) :: self

      real(wp) :: power, allowed

      associate (law => self%problem%impact%law)
         power = 1.0_wp + law%exponent
         self%branch_felt = branch_error*abs(2.0_wp*power - anint(2.0_wp*power)) &
            *(self%step%reach**2/(0.5_wp*law%contact_time*self%time_scale))**power
         allowed = inner_allowed*self%accuracy
         if (self%branch_felt <= allowed) return
         self%step%reach = self%step%reach*(allowed/self%branch_felt)**(0.5_wp/power)
         self%branch_felt = allowed
      end associate
   end subroutine shorten_at_branch

   !> Number of times that the first step is halved for a kernel with a continuous spectrum: in it
   !> collocation does not resolve the internal variables that settle within the step
   pure function levels(accuracy)
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Number
      integer :: levels

      levels = max(0, ceiling(log(levels_error/accuracy)/log(levels_base)))
   end function levels

   !> Solve the next panel, up to the end of the contact or the largest indentation if that is in
   !> it, and its companion
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
            self%turns = is_turning(problem%impact, self%panel)
            if (self%turns) call land_on_largest(problem, self%start, self%velocity, &
               self%accuracy, self%step, self%panel, self%inverse)
         else if (self%panel%converged .and. trajectory%status /= contact_separated) then
            self%ends = first_without_force(self%panel) > 0
            ! what rings in a layer does not keep the end from being found
            if (self%ends) call land_on_zero(problem, self%start, &
               merge(usual_accuracy, self%accuracy, problem%impact%plate%layered()), &
               shallow_end*trajectory%max_indentation, self%step, self%panel, self%inverse)
         end if
         if (.not. self%panel%converged) return
         self%previous = self%panel
         call accompany(problem, self%step, self%coarse_start, self%panel, self%inverse, &
            self%coarse)
      end associate
   end subroutine solve_panel

   !> Whether the indentation has begun to fall
   pure function is_turning(impact, panel)
      type(impact_t), intent(in) :: impact
      type(panel_t), intent(in) :: panel
      logical :: is_turning

      integer :: j

      is_turning = .false.
      do j = 1, panel%stages
         is_turning = relative_velocity(impact, panel, j) < 0.0_wp
         if (is_turning) return
      end do
   end function is_turning

   !> Error of the panel over what it may be: that of the motion, and of the force where it has its
   !> maximum and at the end; elsewhere it is what is left of transients that the impulse does not
   !> feel
   subroutine judge(self, trajectory)
      type(contact_t), intent(inout) :: self
      type(trajectory_t), intent(in) :: trajectory

      real(wp) :: force_error, allowed, cor_error, sphere_error, inherited
      integer :: n, j

      n = self%panel%stages
      associate (panel => self%panel, coarse => self%coarse, impact => self%problem%impact, &
                 collocator => self%problem%collocator)
         self%largest_force = max(self%largest_force, maxval(panel%force(1:n)))
         self%growth = self%motion_error()
         self%excess = self%growth/(panel_share*self%accuracy)
         ! alpha' of a frozen plate is infinite at first contact, or a spike that both solutions
         ! miss, and its error stays for the rest of the contact
         if (impact%plate%frozen() .and. .not. self%start%time > 0.0_wp) self%excess = &
            max(self%growth, missed_drift(collocator%rule, panel)/self%speed) &
            /(first_drift*self%accuracy)
         self%doubt = abs(panel%force(n) - coarse%force(n - 1))
         if (self%excess <= 1.0_wp .and. .not. impact%plate%layered()) &
            self%excess = max(self%excess, work_error(self)/(panel_share*self%accuracy))
         force_error = self%doubt
         allowed = peak_share*self%largest_force*max(self%accuracy, usual_accuracy)
         if (trajectory%status /= contact_separated .and. .not. self%recedes &
             .and. 2.0_wp*panel%force(n) < panel%force(n - 1)) then
            ! what the force is off by here moves the end of the contact
            force_error = max(force_error, settled_error(self))
            allowed = abs(slope_at_end(collocator%rule, panel, panel%force)) &
               *panel%time(n)*self%time_tolerance()
         else if (.not. maxval(panel%force(1:n)) > max(panel%force(0), panel%force(n))) then
            allowed = force_share*allowed
         end if
         if (self%ends) then
            self%shallow = panel%indentation(n) < shallow_end*trajectory%max_indentation
            ! next to u(s) = 0 both solutions err in the same direction
            if (self%shallow) force_error = max(force_error, shallow_factor &
               *min(self%growth_of(panel%force, coarse%force), self%doubt))
            self%ends_at_branch = panel%indentation(n) < next_to_branch*panel%indentation(0)
            if (self%ends_at_branch) self%excess = usually_better*self%excess
            call estimate_errors(self, trajectory%steps + 1, cor_error, sphere_error)
            ! the velocity of a layer's face rings: shorter panels do not reach its error
            if (.not. impact%plate%layered()) self%excess = max(self%excess, &
               cor_error/self%accuracy)
         end if
         ! of a force that is no more than rounding there is nothing to be off by
         force_error = max(0.0_wp, min(force_error, maxval(panel%force(0:n))) &
            - rounding_of_force*self%largest_force)
         self%excess = max(self%excess, share(force_error, allowed))
         if (self%recedes) then
            ! the rebound feels the solution between the ends of the panels, too
            self%inner = inner_felt*maxval(abs(collocator%coarsened(panel%indentation) &
               - coarse%indentation(1:)))/(self%speed*self%time_scale)
            ! what is handed down stays however short the panel is
            inherited = inner_felt*abs(panel%indentation(0) - coarse%indentation(0)) &
               /(self%speed*self%time_scale)
            self%excess = max(self%excess, (self%inner - inherited)/(inner_allowed*self%accuracy))
         end if
         do j = 1, n
            if (any(impact%outruns(panel%alpha(j - 1), panel%alpha(j), panel%impulse(j:n), &
                panel%time(j:n)))) self%excess = huge(1.0_wp)
         end do
         if (trajectory%status /= contact_separated .and. .not. (self%ends .or. self%recedes)) then
            if (hides_a_zero(collocator%rule, panel)) self%excess = huge(1.0_wp)
         end if
      end associate
   end subroutine judge

   !> Error of the force at the end of the panel that both solutions may share: a dashpot and
   !> the modes that settle within the panel follow the rate of u. That is the derivative of a
   !> polynomial, known to one order less than u: the error is what its last coefficient adds to it.
   !> A polynomial of n stages resolves modes with l dt/dtheta < n (n + 1)
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

   !> Drift of a frozen plate, int alpha' F dt, that the first panel may miss: what alpha F - int
   !> alpha dF, whose integrand has no spike where alpha rises at once, has besides, and what alpha
   !> gains before the first stage
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

   !> What the panel adds to the error of the energy that the plate takes, int alpha F^2, over that
   !> of the impact: forces inside a panel are less accurate than the motion, and their square keeps
   !> that
   pure function work_error(self) result(error)
      type(contact_t), intent(in) :: self
      !> Error [-]
      real(wp) :: error

      associate (collocator => self%problem%collocator, impact => self%problem%impact)
         error = abs(work(collocator%rule, self%panel) - work(collocator%coarse, self%coarse)) &
            /impact%initial_energy()
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
   pure function is_refused(self)
      type(contact_t), intent(in) :: self
      logical :: is_refused

      ! what a shorter panel did not reduce has been handed down by the panels before
      is_refused = .not. (self%excess <= 1.0_wp &
         .or. self%excess <= tolerable .and. self%excess > 0.5_wp*self%refused)
      if (is_refused .and. misses_its_end_only(self)) is_refused = .not. self%is_best_end()
   end function is_refused

   !> Whether the panel is known but for its end: next to a branch point that is rounding
   pure function misses_its_end_only(self) result(misses)
      !> The contact, its panel beyond what it may be off by
      type(contact_t), intent(in) :: self
      logical :: misses

      misses = self%ends .and. self%growth <= panel_share*self%accuracy &
         .and. (self%excess <= tolerable .or. .not. (self%ends_at_branch .or. self%shallow))
   end function misses_its_end_only

   !> Shorten a panel that is refused
   subroutine shorten(self)
      type(contact_t), intent(inout) :: self

      self%refused = self%excess
      if (misses_its_end_only(self)) then
         self%refused_end = self%excess
         self%refused_ends = self%refused_ends + 1
      end if
      if (self%ends) then
         ! next to a branch point the error falls as s u(s) only: panels that lead to the end come
         ! first
         self%end_found = self%start%time + self%step%duration()
         self%ahead = 0
         if (self%ends_at_branch) self%ahead = ceiling(min(most_ahead, -log(self%excess) &
            /((1.0_wp + self%problem%impact%law%exponent)*log(1.0_wp - cut_at_end)))) - 1
      end if
      call self%step%shorten(merge(cut_at_end, 0.5_wp, self%ends)*self%step%duration())
   end subroutine shorten

   !> Make the panel a part of the course
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
         call record(rule, problem%impact, recorded, trajectory)
         if (trajectory%status /= contact_separated) then
            trajectory%last = trajectory%final
            call find_peaks(problem, self%start, recorded, self%doubt, self%before, &
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
         self%before%doubt = self%doubt
      end associate
   end subroutine accept

   !> Set the status of a contact that has come to its end with the panel, and how far to go on
   subroutine stop_at_end(self, ghost_end, trajectory, over)
      type(contact_t), intent(inout) :: self
      !> End of the computation beyond the separation [s]; 0: twice the contact time, negative: none
      real(wp), intent(in) :: ghost_end
      type(trajectory_t), intent(inout) :: trajectory
      !> Whether the computation has come to its end, too
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

   !> Go on to the next step: to an end that was refused not before the panels that lead to it
   subroutine go_on(self)
      type(contact_t), intent(inout) :: self

      associate (problem => self%problem)
         call problem%advance(problem%collocator%rule, self%step, self%panel, self%start)
         if (problem%impact%plate%layered()) then
            ! from companion to companion the difference to the solution would ring on, and no
            ! shorter panel reduces that
            associate (n => self%panel%stages)
               self%handed_down = self%handed_down + self%panel%impulse(n) &
                  - self%coarse%impulse(n - 1)
            end associate
            self%coarse_start = self%start
         else
            call problem%advance(problem%collocator%coarse, self%step, self%coarse, &
               self%coarse_start)
         end if
      end associate
      if (self%ahead > 0) then
         self%ahead = self%ahead - 1
         self%step = step_to(self%start%time, cut_at_end*(self%end_found - self%start%time))
      else
         call self%step%proceed(self%growth_of_step(), most_steps)
      end if
   end subroutine go_on

   !> Go on with the rebound of a contact that recedes
   subroutine turn_round(self, approach, trajectory, error)
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
   end subroutine turn_round

   !> Errors of the coefficients of restitution: with F = 0 at the end, s' = v0 - I/m - alpha' I and
   !> z' = v0 - I/m. The companion reaches F = 0 a little earlier or later, which only gravity,
   !> alpha' and the drift feel
   pure subroutine estimate_errors(self, panels, cor_error, cor_sphere_error)
      !> The contact, at its end
      type(contact_t), intent(in) :: self
      !> Number of panels
      integer, intent(in) :: panels
      !> Error of that by the relative velocity [-]
      real(wp), intent(out) :: cor_error
      !> Error of that of the sphere alone [-]
      real(wp), intent(out) :: cor_sphere_error

      real(wp) :: impulse, time, alpha_rate, fall, moved, plate, least, part

      associate (n => self%panel%stages, panel => self%panel, coarse => self%coarse, &
                 impact => self%problem%impact, rule => self%problem%collocator%rule)
         part = error_over_difference(self)
         impulse = impulse_error(self, part)
         fall = slope_at_end(rule, panel, panel%force)
         time = part*abs((panel%force(n) - coarse%force(n - 1))/fall)
         alpha_rate = self%alpha_rate()
         ! the end is moved to its zero along straight lines: what that leaves of the impulse, and
         ! of the velocity of the plate
         moved = panel%force(n)/fall
         plate = impact%free_path(panel%time(n)) - panel%second_impulse(n)/impact%mass &
            - panel%indentation(n)
         least = rounding_per_panel*real(panels, wp) &
            + abs(panel%force(n)*moved)/(impact%mass*impact%velocity)
         cor_sphere_error = least + (impulse/impact%mass + impact%gravity*time)/impact%velocity
         cor_error = cor_sphere_error + abs(plate)/(impact%velocity*panel%time(n)) &
            *(moved/panel%time(n))**2 + plate_error(self, part) &
            + (time*(plate_gains(panel, alpha_rate) &
            + abs(slope_at_end(rule, panel, panel%drift))) &
            + part*abs(panel%drift(n) - coarse%drift(n - 1)))/impact%velocity
         ! next to s = 0 both solutions have F' = 0, but not at the same time
         if (.not. (self%ends_at_branch .or. self%shallow)) cor_error = cor_error &
            + (part*abs(panel%recoil(n) - coarse%recoil(n - 1)) &
            + time*abs(slope_at_end(rule, panel, panel%recoil)))/impact%velocity
      end associate
   end subroutine estimate_errors

   !> Error of the velocity alpha' I of a plate whose alpha grows, over that of the impact
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

   !> Error of the impulse. What the panels add to the difference to the companion may cancel, which
   !> says nothing about the solution: what one of them has added to that of the motion counts, too
   pure function impulse_error(self, part) result(error)
      !> The contact, its panel accepted
      type(contact_t), intent(in) :: self
      !> Error of the solution over its difference to the companion
      real(wp), intent(in) :: part
      !> Error [N s]
      real(wp) :: error

      associate (n => self%panel%stages, impact => self%problem%impact)
         error = max(part*abs(self%handed_down + self%panel%impulse(n) &
            - self%coarse%impulse(n - 1)), &
            min(part*self%largest_growth, harmless*self%accuracy)*impact%mass*self%speed)
         ! next to a branch point the panel before the end is no better
         if (self%ends_at_branch) error = max(error, self%growth*impact%mass*self%speed)
      end associate
   end function impulse_error

   !> Error of the solution over its difference to the companion, which is no better next to the
   !> branch point of u, where alpha' of a frozen plate is infinite at first contact, and where the
   !> velocity of a plate that flees feels the impulse more than that of the sphere
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
