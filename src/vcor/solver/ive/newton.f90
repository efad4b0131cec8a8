!> Newton's method for the equations x + M f(x) = r of a panel
!>
!> The Jacobian 1 + M diag(f') is inverted and kept as long as the iteration contracts. Panels next
!> to a solved one, and companions by interpolation between their stages and those of the solution,
!> use the same inverse, so no matrix is formed for them. The last panel of a receding contact is
!> solved together with its length.
module vcor_solver_ive_newton
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : apply, invert, width
   use vcor_numeric_radau_collocation, only : closing, collocation_t
   use vcor_solver_ive_panel, only : panel_t, start_t, step_of, step_t
   use vcor_solver_ive_problem, only : equations_t, form_matrix, lost_indentation, &
      panel_problem_t, product_with_m
   use vcor_tuning, only : farthest_closing, farthest_rebound, most_iterations, &
      newton_close, no_better, noticeable_time, slowest_contraction
   implicit none
   private

   public :: guess, solve, solve_near, improve, solve_companion, close_contact

   !> State of the iteration
   type :: newton_t
      !> Whether the next correction needs a new Jacobian
      logical :: stale = .true.
      !> Size of the last correction
      real(wp) :: last = 0.0_wp
      !> Whether the equations have been solved
      logical :: converged = .false.
      !> Whether they cannot be solved
      logical :: failed = .false.
   end type newton_t

contains

   !> Guess the indentation in the next panel from the polynomial of the last one that was solved
   subroutine guess(problem, previous, step, start, panel)
      type(panel_problem_t), intent(in) :: problem
      !> The panel solved last, accepted or not; without stages if there is none
      type(panel_t), intent(in) :: previous
      type(step_t), intent(in) :: step
      type(start_t), intent(in) :: start
      type(panel_t), intent(inout) :: panel

      real(wp) :: time(width)

      associate (rule => problem%collocator%rule)
         time = start%time + rule%times(step%index, step%map_scale())
         if (previous%stages == 0) then
            panel%indentation(1:) = problem%impact%free_path(time)
         else
            panel%indentation(1:) = rule%extend(previous%indentation, previous%theta(time))
         end if
      end associate
   end subroutine guess

   !> Solve the equations of a panel by Newton's method
   subroutine solve(problem, rule, step, start, panel, inverse)
      type(panel_problem_t), intent(in) :: problem
      type(collocation_t), intent(in) :: rule
      type(step_t), intent(in) :: step
      type(start_t), intent(in) :: start
      !> The panel; on entry `indentation`, or `t1`, holds a guess at the stages
      type(panel_t), intent(inout) :: panel
      !> Inverse of the Jacobian, for use in neighbouring panels
      real(wp), intent(out) :: inverse(width, width)

      type(equations_t) :: equations
      type(newton_t) :: newton
      integer :: iteration

      call problem%set_up(rule, step, start, panel, equations)
      do iteration = 1, most_iterations
         call correct(newton, problem, equations, inverse, panel)
         if (newton%converged .or. newton%failed) exit
      end do
      panel%converged = newton%converged
      if (.not. panel%converged) return
      call problem%integrate(equations, panel)
      if (.not. equations%closes) return
      call problem%set_end_condition(rule, equations, start, panel)
      call problem%set_end_drift(rule, equations, start, panel)
   end subroutine solve

   !> Correct a panel, and estimate the error that remains: with a new Jacobian it falls as u does
   !> at its branch point, or faster, otherwise linearly
   subroutine correct(self, problem, e, inverse, panel)
      type(newton_t), intent(inout) :: self
      type(panel_problem_t), intent(in) :: problem
      type(equations_t), intent(inout) :: e
      !> Inverse of the Jacobian, computed again if `stale`
      real(wp), intent(inout) :: inverse(width, width)
      type(panel_t), intent(inout) :: panel

      ! largest u [m^n] or force [N]
      real(wp), parameter :: beyond_all = 1.0e120_wp
      real(wp) :: change(width), force(width), second(width, width)
      real(wp) :: unit, size, rate, left
      logical :: regular
      integer :: n, j

      n = panel%stages
      call problem%evaluate(e, panel)
      ! stop a diverging iteration before products overflow
      self%failed = .not. largest(e%f) < beyond_all
      if (self%failed) return
      if (self%stale .and. .not. e%formed) call form_matrix(e)
      change = e%right - e%x - product_with_m(e, e%f)
      if (allocated(e%lag)) then
         call problem%second_term(e, force, second)
         change = change - lost_indentation(e, apply(e%map%left, force))
      end if
      if (e%closes) change(n) = 0.0_wp
      if (self%stale) then
         do j = 1, width
            inverse(:, j) = e%matrix(:, j)*e%slope(j)
            if (allocated(e%lag)) inverse(:, j) = inverse(:, j) &
               + lost_indentation(e, apply(e%map%left, second(:, j)))*e%slope(j)
            if (e%closes) inverse(n, j) = 0.0_wp
            inverse(j, j) = inverse(j, j) + 1.0_wp
         end do
         call invert(inverse, regular)
         self%failed = .not. regular
         if (self%failed) return
      end if
      change = apply(inverse, change)
      unit = problem%largest_condition
      if (.not. unit > 0.0_wp) unit = largest(e%x + change)
      ! a panel without any indentation is none
      self%failed = .not. unit > 0.0_wp
      if (self%failed) return
      call problem%move(e, change, panel)
      size = largest(change)/unit
      if (self%stale) then
         left = min(problem%impact%law%u(size), size)
         self%stale = size > newton_close
      else
         rate = min(1.0_wp, size/self%last)
         left = size*rate/(1.0_wp - 0.5_wp*rate)
         self%stale = rate > slowest_contraction
      end if
      self%converged = left <= problem%tolerance &
         .or. size <= problem%noise .and. .not. size < 0.5_wp*self%last
      self%last = size
   end subroutine correct

   !> Solve the equations of a panel with the Jacobian of another: a neighbour of other length, or
   !> the panel whose companion it is. No matrix is formed, so this costs half of a full solution
   subroutine solve_near(problem, rule, step, start, inverse, panel)
      type(panel_problem_t), intent(in) :: problem
      type(collocation_t), intent(in) :: rule
      type(step_t), intent(in) :: step
      type(start_t), intent(in) :: start
      !> Inverse of the Jacobian of a panel with the full number of stages
      real(wp), intent(in) :: inverse(width, width)
      !> The panel; on entry `indentation`, or `t1`, holds a guess at the stages. Not converged if
      !> the Jacobian is not good enough
      type(panel_t), intent(inout) :: panel

      type(equations_t) :: equations
      real(wp) :: change(width), size, unit, last, rest, contraction
      integer :: iteration
      logical :: coarse

      panel%converged = .false.
      if (abs(problem%collocator%second_coefficient) > 0.0_wp) return
      coarse = rule%stages < problem%collocator%rule%stages
      call problem%set_up(rule, step, start, panel, equations)
      last = 0.0_wp
      do iteration = 1, most_iterations
         call problem%evaluate(equations, panel)
         change = equations%right - equations%x - product_with_m(equations, equations%f)
         if (equations%closes) change(rule%stages) = 0.0_wp
         if (coarse) change = apply(problem%collocator%from_coarse, change)
         change = apply(inverse, change)
         if (coarse) change = apply(problem%collocator%to_coarse(:, 1:), change)
         size = largest(change)
         unit = problem%largest_condition
         if (.not. equations%rebounds) unit = largest(equations%x)
         ! the guess was useless
         if (.not. size <= unit) return
         call problem%move(equations, change, panel)
         if (iteration > 1) then
            contraction = size/last
            if (.not. contraction <= slowest_contraction) return
            rest = abs(change(rule%stages))
            if (equations%closes) rest = size
            panel%converged = rest*contraction <= problem%collocator%near_tolerance*unit
            if (panel%converged) exit
         end if
         last = max(size, tiny(1.0_wp))
      end do
      if (.not. panel%converged) return
      call problem%integrate(equations, panel)
      if (equations%closes) then
         call problem%set_end_condition(rule, equations, start, panel)
         call problem%set_end_drift(rule, equations, start, panel)
      else if (.not. equations%rebounds) then
         ! keep the remaining error in the force, so that the motion agrees with the impulse
         panel%indentation(1:) = problem%impact%free_path(panel%time(1:)) &
            - panel%second_impulse(1:)*equations%inverse_mass
         if (.not. equations%frozen) &
            panel%indentation(1:) = panel%indentation(1:) - panel%alpha(1:)*panel%impulse(1:)
         if (equations%frozen .or. equations%remembers) &
            panel%indentation(1:) = panel%indentation(1:) - panel%deflection(1:)
         panel%indentation(rule%stages + 1:) = 0.0_wp
      end if
   end subroutine solve_near

   !> Improve motion and forces of a guessed panel by two fixed-point iterations, s from the forces
   !> of the previous s. The error of an interpolated guess oscillates from stage to stage, and two
   !> integrations leave little of it
   subroutine improve(problem, step, start, tolerance, panel)
      !> The problem, its contact growing
      type(panel_problem_t), intent(in) :: problem
      type(step_t), intent(in) :: step
      type(start_t), intent(in) :: start
      !> Error of the indentation allowed, over its largest value
      real(wp), intent(in) :: tolerance
      !> The panel; on entry `indentation` holds a guess at the stages. It is solved if the second
      !> iteration changes the indentation by more than the tolerance
      type(panel_t), intent(inout) :: panel

      type(equations_t) :: equations
      real(wp) :: guessed(width), numbers(width), inverse(width, width)
      integer :: iteration

      guessed = panel%indentation(1:)
      panel%converged = .false.
      if (.not. abs(problem%collocator%second_coefficient) > 0.0_wp) then
         call problem%set_up(problem%collocator%rule, step, start, panel, equations)
         do iteration = 1, 2
            call problem%evaluate(equations, panel)
            panel%indentation(1:) = equations%right - product_with_m(equations, equations%f)
         end do
         panel%converged = largest(panel%indentation(1:) - equations%x) &
            <= tolerance*largest(equations%x)
      end if
      if (panel%converged) then
         call problem%find_forces(equations, panel, numbers)
      else
         panel%indentation(1:) = guessed
         call solve(problem, problem%collocator%rule, step, start, panel, inverse)
      end if
   end subroutine improve

   !> Solve the companion of a panel, from the companion's own start
   subroutine solve_companion(problem, step, start, panel, inverse, companion)
      type(panel_problem_t), intent(in) :: problem
      type(step_t), intent(in) :: step
      !> State of the companion at the start of the panel
      type(start_t), intent(in) :: start
      type(panel_t), intent(in) :: panel
      !> Inverse of the Jacobian of the panel
      real(wp), intent(in) :: inverse(width, width)
      type(panel_t), intent(out) :: companion

      real(wp) :: own_inverse(width, width)

      associate (collocator => problem%collocator)
         call guess_companion()
         call solve_near(problem, collocator%coarse, step, start, inverse, companion)
         if (companion%converged) return
         call guess_companion()
         call solve(problem, collocator%coarse, step, start, companion, own_inverse)
      end associate

   contains

      !> Guess the companion by interpolation
      subroutine guess_companion()

         associate (collocator => problem%collocator)
            companion%indentation(1:) = collocator%coarsened(panel%indentation)
            if (associated(problem%approach)) companion%t1(1:) = collocator%coarsened(panel%t1)
         end associate
      end subroutine guess_companion
   end subroutine solve_companion

   !> Solve the last panel of a receding contact, and find its duration, for which N = 0 at the end
   subroutine close_contact(problem, start, time_tolerance, length, panel, inverse)
      !> The problem, its contact receding
      type(panel_problem_t), intent(in) :: problem
      type(start_t), intent(in) :: start
      !> Relative error allowed for the time of the end
      real(wp), intent(in) :: time_tolerance
      !> A guess at the duration, on return the duration [s]
      real(wp), intent(inout) :: length
      !> The panel, its t1 guessed; not converged on failure
      type(panel_t), intent(inout) :: panel
      !> Inverse of its Jacobian
      real(wp), intent(out) :: inverse(width, width)

      type(equations_t) :: equations
      type(newton_t) :: newton
      real(wp) :: fall, correction, last_correction
      integer :: n, iteration

      panel%converged = .false.
      correction = huge(1.0_wp)
      associate (rule => problem%collocator%rule)
         n = rule%stages
         do iteration = 1, most_iterations
            if (.not. length > epsilon(length)*start%time) return
            call problem%set_up(rule, step_of(closing, length), start, panel, equations)
            panel%t1(n) = 0.0_wp
            call correct(newton, problem, equations, inverse, panel)
            if (newton%failed) return
            call problem%integrate(equations, panel)
            call problem%set_end_condition(rule, equations, start, panel)
            ! N is linear in (1 - theta)^2 near the end
            fall = 0.5_wp*sum(rule%derivative(n, :)*rule%slopes(panel%condition))
            if (.not. fall > 0.0_wp) return
            last_correction = correction
            correction = farthest_closing*length
            if (abs(panel%condition(n)) < farthest_closing*fall) &
               correction = panel%condition(n)/fall*length
            correction = sign(correction, panel%condition(n))
            panel%converged = newton%converged .and. (abs(correction) &
               <= time_tolerance*(start%time + length) &
               ! rounding in the condition of stiff internal variables ends the iteration, too
               .or. iteration > 3 .and. abs(correction) <= noticeable_time*length &
               .and. abs(correction) >= no_better*abs(last_correction))
            if (panel%converged) then
               call problem%set_end_drift(rule, equations, start, panel)
               exit
            end if
            length = length + correction
            ! move t1 to the same times in the panel of the new length
            panel%t1(1:) = rule%extend(panel%t1, min(panel%theta(start%time &
               + rule%times(closing, length)), farthest_rebound))
         end do
      end associate
   end subroutine close_contact

   !> Largest magnitude of the elements
   pure function largest(x)
      real(wp), intent(in) :: x(width)
      real(wp) :: largest

      real(wp) :: half(width/2)
      integer :: i

      do i = 1, width/2
         half(i) = max(abs(x(i)), abs(x(i + width/2)))
      end do
      largest = max(max(half(1), half(2)), max(half(3), half(4)))
   end function largest

end module vcor_solver_ive_newton
