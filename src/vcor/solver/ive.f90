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
   use vcor_error, only : error_input, error_numerical, error_t, raise
   use vcor_impact_problem, only : hertz_contact_time, impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, &
      contact_lasting, contact_separated, contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, new_collocation
   use vcor_solver_general_panel, only : solve_general_panel
   use vcor_solver_panel, only : advance_modes, hertz, panel_t, solve_panel, start_t
   use vcor_solver_step, only : step_t, step_to
   use vcor_solver_type, only : solver_t
   implicit none
   private

   public :: ive_t, new_ive

   !> Stages of the solution: enough that four panels make an impact, few enough that the
   !> eigenvectors of the integration matrices cost three digits only
   integer, parameter :: stages = 7
   !> Stages of the finer solution
   integer, parameter :: fine_stages = 8
   !> Steps in x = sqrt(t) are taken from x = 0, h, .. most_steps*h
   integer, parameter :: most_steps = 12
   !> End of Newton's method on a panel: what is left is the square of it, at the end of an elastic
   !> contact, where u'' is infinite, its power 1.5
   real(wp), parameter :: newton_tolerance = 3.0e-8_wp
   !> End of Newton's method where the guess is that close already
   real(wp), parameter :: refinement_tolerance = 1.0e-6_wp
   !> Share of the wanted accuracy that the defect of one panel may use up
   real(wp), parameter :: panel_share = 0.2_wp

   !> Internal variable evolution
   type, extends(solver_t) :: ive_t
      private
      !> Wanted accuracy of the coefficient of restitution [-]
      real(wp) :: accuracy = 1.0e-8_wp
      !> End of the computation [s]; 0: follows from the contact's time scale
      real(wp) :: end_time = 0.0_wp
      !> Coefficient c2 of the second term of the Volterra series [m^-1.5], 0 without it
      real(wp) :: second_coefficient = 0.0_wp
      !> Go on after the separation
      logical :: ghost = .false.
      !> Rule of the panels
      type(collocation_t) :: rule
      !> Rule of the finer solution
      type(collocation_t) :: fine
      !> Interpolation from the points of `rule` to the nodes of `fine`
      real(wp) :: to_fine(fine_stages, 0:stages) = 0.0_wp
      !> First step in x over the square root of the expected contact time [-]
      real(wp) :: first_step = 0.25_wp
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

      real(wp) :: unit(0:stages)
      integer :: i, j

      self%accuracy = accuracy
      self%end_time = end_time
      if (present(second_coefficient)) self%second_coefficient = second_coefficient
      if (present(ghost)) self%ghost = ghost
      call new_collocation(self%rule, stages, most_steps, error)
      if (allocated(error)) return
      call new_collocation(self%fine, fine_stages, most_steps, error)
      if (allocated(error)) return

      do j = 0, stages
         unit = 0.0_wp
         unit(j) = 1.0_wp
         do i = 1, fine_stages
            self%to_fine(i, j) = self%rule%interpolate(unit, self%fine%node(i))
         end do
      end do
   end subroutine new_ive

   !> Compute the course of an impact
   subroutine solve(self, impact, trajectory, error)
      !> The solver
      class(ive_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its course
      type(trajectory_t), intent(out) :: trajectory
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: most_trials = 20000
      ! the panel before an end that was refused comes this close to it
      real(wp), parameter :: approach = 0.65_wp
      type(exponential_sum_t) :: kernel
      type(start_t) :: start, fine_start
      type(step_t) :: step
      type(panel_t) :: panel, previous, fine
      real(wp) :: end_time, time_scale, largest_force, force_tolerance, time_tolerance
      real(wp) :: excess, force_error
      integer :: trial, n
      logical :: exact, ends, last

      call impact%kernel_exponentials(kernel, exact)
      if (.not. exact) then
         call raise(error, error_input, 'the contact modulus of this case is no sum of ' &
            //"exponentials, which method = 'ive' needs: use method = 'direct'")
         return
      end if

      n = self%rule%stages
      time_scale = impact%time_scale()
      end_time = self%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%patience()
      allocate (start%q(size(kernel%rates)))
      start%q = 0.0_wp
      fine_start = start
      step%length = self%first_step*sqrt(hertz_contact_time*time_scale)
      call begin(self%rule, impact, trajectory)
      largest_force = 0.0_wp
      ! rounding in the force of stiff internal variables and dashpots is not to stop the march
      force_tolerance = 10.0_wp*max(self%accuracy, 1.0e-8_wp)
      time_tolerance = max(panel_share*self%accuracy, 1.0e-9_wp)

      do trial = 1, most_trials
         last = start%time + step%duration() >= end_time
         if (last) step = step_to(start%time, end_time - start%time)
         call guess(self%rule, impact, previous, start, step, panel)
         call solve_step(self, self%rule, step, impact, kernel, start, panel, newton_tolerance)
         ! while the indentation grows the force is positive: what is not is rounding
         ends = .false.
         if (panel%converged .and. .not. trajectory%status == contact_separated) &
            ends = any(panel%force(1:n) <= 0.0_wp &
            .and. panel%indentation(1:n) < panel%indentation(0:n - 1))
         if (ends) call land(self, impact, kernel, start, step, panel)
         if (.not. panel%converged) then
            call step%shorten(0.5_wp*step%duration())
            cycle
         end if
         previous = panel

         call refine(self, impact, kernel, fine_start, step, panel, fine)
         largest_force = max(largest_force, maxval(panel%force(1:n)))
         excess = (growth_of(fine%impulse, panel%impulse)/(impact%mass*impact%velocity) &
            + growth_of(fine%indentation, panel%indentation)/(impact%velocity*time_scale)) &
            /(panel_share*self%accuracy)
         force_error = growth_of(fine%force, panel%force)
         excess = max(excess, force_error/(largest_force*force_tolerance))
         if (ends) excess = max(excess, force_error/abs(slope_at_end(self%rule, panel)) &
            /(panel%time(n)*time_tolerance))
         if (.not. excess <= 1.0_wp) then
            call step%shorten(merge(approach, 0.5_wp, ends)*step%duration())
            cycle
         end if

         call append(self, impact, kernel, start, panel, trajectory)
         if (ends) then
            trajectory%status = contact_separated
            trajectory%cor_error = error_of_cor(self%rule, impact, panel, fine)
            if (.not. self%ghost) return
            end_time = 2.0_wp*panel%time(n)
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

         call advance(self%rule, step, kernel, panel, start)
         call advance(self%fine, step, kernel, fine, fine_start)
         call step%proceed(min(3.0_wp, max(excess, tiny(1.0_wp))**(-1.0_wp/real(2*n, wp))), &
            most_steps)
      end do
      call raise(error, error_numerical, 'the internal-variable method does not get to the end of ' &
         //'the contact: the accuracy asked for is out of reach')

   contains

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
   end subroutine solve

   !> Make the end of a panel the start of the next one
   subroutine advance(rule, step, kernel, panel, start)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Step
      type(step_t), intent(in) :: step
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> The panel
      type(panel_t), intent(in) :: panel
      !> State at the start of the panel, on return that at its end
      type(start_t), intent(inout) :: start

      associate (n => rule%stages)
         call advance_modes(rule, rule%map(step%index), step%map_scale(), kernel, panel, start%q)
         start%time = panel%time(n)
         start%indentation = panel%indentation(n)
         start%force = panel%force(n)
         start%impulse = panel%impulse(n)
         start%second_impulse = panel%second_impulse(n)
         start%deflection = panel%deflection(n)
         start%drift = panel%drift(n)
      end associate
   end subroutine advance

   !> Solve the panel of a step
   pure subroutine solve_step(self, rule, step, impact, kernel, start, panel, tolerance)
      !> The solver
      type(ive_t), intent(in) :: self
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Step
      type(step_t), intent(in) :: step
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> The panel; on entry its indentation is guessed
      type(panel_t), intent(inout) :: panel
      !> End of Newton's iteration
      real(wp), intent(in) :: tolerance

      if (abs(self%second_coefficient) > 0.0_wp .or. impact%plate%frozen()) then
         call solve_general_panel(rule, rule%map(step%index), step%map_scale(), impact, kernel, &
            self%second_coefficient, start, panel, tolerance)
      else
         call solve_panel(rule, rule%map(step%index), step%map_scale(), impact, kernel, start, &
            panel, tolerance)
      end if
   end subroutine solve_step

   !> First node of a trajectory
   subroutine begin(rule, impact, trajectory)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its course
      type(trajectory_t), intent(inout) :: trajectory

      integer, parameter :: usual_panels = 8

      call trajectory%reserve(usual_panels*rule%stages)
      trajectory%state(:, 0) = 0.0_wp
      trajectory%state(col_velocity, 0) = impact%velocity
      trajectory%state(col_sphere_velocity, 0) = impact%velocity
      trajectory%weight(0) = 0.0_wp
      trajectory%stages = rule%stages
      allocate (trajectory%point(0:rule%stages), source=rule%point(0:rule%stages))
      allocate (trajectory%barycentric(0:rule%stages), source=rule%barycentric(0:rule%stages))
   end subroutine begin

   !> Guess the indentation in the panel to come from the polynomial of the panel solved last
   subroutine guess(rule, impact, previous, start, step, panel)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The impact
      type(impact_t), intent(in) :: impact
      !> The panel solved last, accepted or not; without stages if there is none
      type(panel_t), intent(in) :: previous
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> Step
      type(step_t), intent(in) :: step
      !> The panel
      type(panel_t), intent(inout) :: panel

      ! polynomials run away beyond their own panel
      real(wp), parameter :: farthest = 2.2_wp
      real(wp) :: time, theta
      integer :: j

      associate (map => rule%map(step%index))
         do j = 1, rule%stages
            time = start%time &
               + step%map_scale()*rule%node(j)*(map%slope + map%bend*rule%node(j))
            if (previous%stages == 0) then
               panel%indentation(j) = impact%velocity*time
            else
               theta = min(previous%theta(time), farthest)
               panel%indentation(j) = &
                  rule%interpolate(previous%indentation(0:rule%stages), theta)
            end if
         end do
      end associate
   end subroutine guess

   !> Cut a panel in which the force changes its sign so that it ends where the force is zero
   subroutine land(self, impact, kernel, start, step, panel)
      !> The solver
      type(ive_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> The step, on return the one that ends at the zero
      type(step_t), intent(inout) :: step
      !> The panel, on return the one that ends at the zero; not converged on failure
      type(panel_t), intent(inout) :: panel

      integer, parameter :: most_iterations = 40
      type(panel_t) :: crossing, last
      real(wp) :: theta, time, correction, tolerance, velocity
      real(wp) :: kappa, memory_rate, old_memory, memory
      integer :: iteration, n, k

      n = self%rule%stages
      crossing = panel
      k = 1
      do while (crossing%force(k) > 0.0_wp &
                .or. crossing%indentation(k) >= crossing%indentation(k - 1))
         k = k + 1
      end do
      theta = self%rule%point(k - 1)
      if (k > 1) theta = self%rule%crossing(crossing%force(0:n), theta, self%rule%point(k))
      time = theta*(crossing%map(1) + crossing%map(2)*theta)

      ! Write F = kappa u - M with any kappa that is about dF/du: the indentation s and the memory
      ! M are smooth in time, u = s^1.5 where s goes to zero is not. So Newton's method is put on
      ! kappa u(s) = M with s and M linear in time, the slope of M from the last two iterations
      tolerance = 1.0e-3_wp*min(self%accuracy, 1.0e-7_wp)
      kappa = crossing%end_stiffness
      memory_rate = 0.0_wp
      old_memory = 0.0_wp
      correction = 0.0_wp
      panel%converged = .false.
      last = crossing
      do iteration = 1, most_iterations
         if (.not. time > 0.0_wp) return
         step = step_to(start%time, time)
         call guess(self%rule, impact, last, start, step, panel)
         call solve_step(self, self%rule, step, impact, kernel, start, panel, newton_tolerance)
         if (.not. panel%converged) return
         last = panel
         velocity = impact%velocity - panel%impulse(n)/impact%mass - plate_velocity(impact, panel, n)
         memory = kappa*hertz(panel%indentation(n)) - panel%force(n)
         if (abs(correction) > 0.0_wp) memory_rate = (memory - old_memory)/correction
         old_memory = memory
         call look_ahead(kappa, panel%indentation(n), velocity, memory, memory_rate, correction, &
            panel%converged)
         if (.not. panel%converged) return
         if (abs(correction) <= tolerance*(start%time + time)) return
         time = time + correction
      end do
      panel%converged = .false.
   end subroutine land

   !> Solve kappa hertz(s + v x) = memory + rate x for x near 0 by Newton's method
   pure subroutine look_ahead(kappa, s, v, memory, rate, x, found)
      !> Stiffness kappa [N/m^1.5], > 0
      real(wp), intent(in) :: kappa
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> Its rate [m/s]
      real(wp), intent(in) :: v
      !> Memory [N]
      real(wp), intent(in) :: memory
      !> Its rate [N/s]
      real(wp), intent(in) :: rate
      !> Time [s]
      real(wp), intent(out) :: x
      !> Whether the force falls to zero there
      logical, intent(out) :: found

      real(wp) :: correction, slope
      integer :: iteration

      x = 0.0_wp
      found = .false.
      do iteration = 1, 50
         slope = 1.5_wp*kappa*sqrt(abs(s + v*x))*v - rate
         if (.not. slope < 0.0_wp) return
         correction = (memory + rate*x - kappa*hertz(s + v*x))/slope
         x = x + correction
         found = abs(correction) <= 1.0e-3_wp*abs(x)
         if (found) return
      end do
   end subroutine look_ahead

   !> Velocity of the plate at a stage of a panel: U' = alpha F + alpha' I, or alpha F less the
   !> drift of a frozen plate
   pure function plate_velocity(impact, panel, j) result(velocity)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Stage, > 0
      integer, intent(in) :: j
      !> Velocity [m/s]
      real(wp) :: velocity

      velocity = panel%alpha(j)*panel%force(j)
      if (impact%plate%frozen()) then
         velocity = velocity - panel%drift(j)
      else
         velocity = velocity + impact%plate%alpha_rate(panel%time(j))*panel%impulse(j)
      end if
   end function plate_velocity

   !> Add a panel to the trajectory
   subroutine append(self, impact, kernel, start, panel, trajectory)
      !> The solver
      type(ive_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> The panel
      type(panel_t), intent(in) :: panel
      !> The trajectory
      type(trajectory_t), intent(inout) :: trajectory

      integer :: n, first, j

      n = panel%stages
      call trajectory%reserve(trajectory%final + n)
      call trajectory%add_map(panel%map)
      first = trajectory%final + 1
      trajectory%final = trajectory%final + n
      trajectory%steps = trajectory%steps + 1
      trajectory%weight(first:trajectory%final) = self%rule%weight(1:n) &
         *(panel%map(1) + 2.0_wp*panel%map(2)*self%rule%node(1:n))
      do j = 1, n
         associate (state => trajectory%state(:, first + j - 1))
            state(col_time) = panel%time(j)
            state(col_indentation) = panel%indentation(j)
            state(col_force) = panel%force(j)
            state(col_impulse) = panel%impulse(j)
            state(col_sphere) = impact%velocity*panel%time(j) &
               - panel%second_impulse(j)/impact%mass
            state(col_sphere_velocity) = impact%velocity - panel%impulse(j)/impact%mass
            state(col_plate) = state(col_sphere) - panel%indentation(j)
            state(col_plate_velocity) = plate_velocity(impact, panel, j)
            state(col_velocity) = state(col_sphere_velocity) - state(col_plate_velocity)
         end associate
      end do
      if (trajectory%status == contact_separated) return
      trajectory%last = trajectory%final
      call find_peaks(self, impact, kernel, start, panel, trajectory)
   end subroutine append

   !> Largest indentation and force so far
   subroutine find_peaks(self, impact, kernel, start, panel, trajectory)
      !> The solver
      type(ive_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> The panel
      type(panel_t), intent(in) :: panel
      !> The trajectory, the panel added
      type(trajectory_t), intent(inout) :: trajectory

      type(panel_t) :: peak
      integer :: n, j

      n = panel%stages
      if (rises_and_falls(panel%indentation(0:n))) then
         call solve_to_peak(panel%indentation(0:n))
         if (peak%converged .and. peak%indentation(n) > trajectory%max_indentation) then
            trajectory%max_indentation = peak%indentation(n)
            trajectory%time_of_max_indentation = peak%time(n)
         end if
      end if
      if (rises_and_falls(panel%force(0:n))) then
         call solve_to_peak(panel%force(0:n))
         if (peak%converged .and. peak%force(n) > trajectory%max_force) then
            trajectory%max_force = peak%force(n)
            trajectory%time_of_max_force = peak%time(n)
         end if
      end if
      do j = 1, n
         if (panel%indentation(j) > trajectory%max_indentation) then
            trajectory%max_indentation = panel%indentation(j)
            trajectory%time_of_max_indentation = panel%time(j)
         end if
         if (panel%force(j) > trajectory%max_force) then
            trajectory%max_force = panel%force(j)
            trajectory%time_of_max_force = panel%time(j)
         end if
      end do

   contains

      !> Whether a polynomial has a maximum inside the panel
      pure function rises_and_falls(value)
         !> Values at the points, shape (0:n)
         real(wp), intent(in) :: value(0:)
         !> Whether it rises at the start and falls at the end
         logical :: rises_and_falls

         rises_and_falls = sum(self%rule%derivative(0, 0:n)*value) > 0.0_wp &
            .and. sum(self%rule%derivative(n, 0:n)*value) < 0.0_wp
      end function rises_and_falls

      !> Solve the panel up to a maximum: inside, its polynomials are less accurate than at its end
      subroutine solve_to_peak(value)
         !> Values at the points, shape (0:n)
         real(wp), intent(in) :: value(0:)

         type(step_t) :: step
         real(wp) :: theta

         theta = self%rule%crossing(matmul(self%rule%derivative(0:n, 0:n), value), 0.0_wp, 1.0_wp)
         step = step_to(start%time, theta*(panel%map(1) + panel%map(2)*theta))
         call guess(self%rule, impact, panel, start, step, peak)
         call solve_step(self, self%rule, step, impact, kernel, start, peak, refinement_tolerance)
      end subroutine solve_to_peak
   end subroutine find_peaks

   !> Solve the panel of the finer solution, from its own start
   subroutine refine(self, impact, kernel, start, step, panel, fine)
      !> The solver
      type(ive_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State of the finer solution at the start of the panel
      type(start_t), intent(in) :: start
      !> Step
      type(step_t), intent(in) :: step
      !> The panel
      type(panel_t), intent(in) :: panel
      !> The panel in the finer rule
      type(panel_t), intent(out) :: fine

      fine%indentation(1:fine_stages) = matmul(self%to_fine, panel%indentation(0:stages))
      call solve_step(self, self%fine, step, impact, kernel, start, fine, refinement_tolerance)
   end subroutine refine

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
   pure function error_of_cor(rule, impact, panel, fine) result(estimate)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The impact
      type(impact_t), intent(in) :: impact
      !> The last panel
      type(panel_t), intent(in) :: panel
      !> The last panel of the finer solution
      type(panel_t), intent(in) :: fine
      !> Estimate [-]
      real(wp) :: estimate

      ! what rounding may add, mostly through the eigenvectors of the integration matrices
      real(wp), parameter :: rounding = 5.0e-12_wp
      real(wp) :: impulse_error, time_error, alpha_rate

      associate (n => rule%stages)
         impulse_error = abs(fine%impulse(n + 1) - panel%impulse(n))
         time_error = abs((fine%force(n + 1) - panel%force(n))/slope_at_end(rule, panel))
         alpha_rate = impact%plate%alpha_rate(panel%time(n))
         estimate = rounding + (impulse_error*(1.0_wp/impact%mass + alpha_rate) &
            + time_error*alpha_rate*panel%impulse(n)/panel%time(n) &
            + abs(fine%drift(n + 1) - panel%drift(n)))/impact%velocity
      end associate
   end function error_of_cor

end module vcor_solver_ive
