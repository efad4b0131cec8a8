!> Panels of the internal-variable method: the two rules, and how a panel is guessed, solved and
!> accompanied
module vcor_solver_collocator
   use vcor_error, only : error_t
   use vcor_impact_problem, only : hertz, impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : collocation_t, new_collocation, width
   use vcor_numeric_linear, only : apply
   use vcor_solver_general_panel, only : solve_general_panel
   use vcor_solver_modes, only : advance_lags, modes_t, start_t
   use vcor_solver_panel, only : improve_panel, move_to_end, panel_t, solve_near_panel, &
      solve_panel
   use vcor_solver_step, only : step_t
   implicit none
   private

   public :: collocator_t, new_collocator
   public :: guess, solve_step, solve_near_step, improve, accompany, advance, plate_velocity, &
      relative_velocity
   public :: most_steps

   !> Stages of the solution: enough that three panels make an impact, few enough that the
   !> eigenvectors of the integration matrices cost four digits only
   integer, parameter :: stages = width
   !> Stages of its companion
   integer, parameter :: fewer_stages = stages - 1
   !> Steps in x = sqrt(t) are taken from x = 0, h, .. most_steps*h
   integer, parameter :: most_steps = 12

   !> Collocation rules; immutable once built
   type :: collocator_t
      !> Rule of the panels
      type(collocation_t) :: rule
      !> Rule of the companion
      type(collocation_t) :: coarse
      !> Interpolation from the points of `rule` to the nodes of `coarse`
      real(wp) :: to_coarse(width, 0:width) = 0.0_wp
      !> Interpolation from the nodes of `coarse` to those of `rule`, of what is zero at the start
      real(wp) :: from_coarse(width, width) = 0.0_wp
      !> Coefficient c2 of the second term of the Volterra series [m^-1.5], 0 without it
      real(wp) :: second_coefficient = 0.0_wp
      !> Error that Newton's method may leave in the indentation, over its largest value
      real(wp) :: tolerance = 0.0_wp
      !> The same at the end of a panel that is solved with the Jacobian of another one, where the
      !> error falls slowly
      real(wp) :: near_tolerance = 0.0_wp
      !> The same for the companion, whose difference to the solution is wanted to two digits only
      real(wp) :: coarse_tolerance = 0.0_wp
   end type collocator_t

contains

   !> Build the rules
   subroutine new_collocator(self, accuracy, error)
      !> The rules
      type(collocator_t), intent(out) :: self
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp), parameter :: tightest = 1.0e-14_wp, tolerance_share = 1.0e-5_wp
      real(wp), parameter :: near_tolerance_share = 1.0e-3_wp, coarse_tolerance_share = 3.0e-3_wp
      real(wp) :: unit(0:stages)
      integer :: i, j

      self%tolerance = max(tightest, tolerance_share*accuracy)
      self%near_tolerance = max(tightest, near_tolerance_share*accuracy)
      self%coarse_tolerance = max(tightest, coarse_tolerance_share*accuracy)
      call new_collocation(self%rule, stages, most_steps, error)
      if (allocated(error)) return
      call new_collocation(self%coarse, fewer_stages, most_steps, error)
      if (allocated(error)) return

      do j = 0, stages
         unit = 0.0_wp
         unit(j) = 1.0_wp
         do i = 1, fewer_stages
            self%to_coarse(i, j) = self%rule%interpolate(unit, self%coarse%node(i))
         end do
      end do
      do j = 1, fewer_stages
         unit = 0.0_wp
         unit(j) = 1.0_wp
         do i = 1, stages
            self%from_coarse(i, j) = self%coarse%interpolate(unit, self%rule%node(i))
         end do
      end do
   end subroutine new_collocator

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
      real(wp), dimension(width) :: time, theta

      associate (map => rule%map(step%index))
         time = start%time + step%map_scale()*rule%node*(map%slope + map%bend*rule%node)
      end associate
      if (previous%stages == 0) then
         panel%indentation(1:) = impact%velocity*time
      else
         theta = min(previous%theta(time), farthest)
         panel%indentation(1:) = rule%extend(previous%indentation, theta)
      end if
   end subroutine guess

   !> Solve the panel of a step
   pure subroutine solve_step(self, step, impact, modes, start, panel, inverse)
      !> The collocation
      type(collocator_t), intent(in) :: self
      !> Step
      type(step_t), intent(in) :: step
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> The panel; on entry its indentation is guessed
      type(panel_t), intent(inout) :: panel
      !> Inverse of its Jacobian, for its companion
      real(wp), intent(out) :: inverse(width, width)

      if (is_general(self, impact)) then
         call solve_general_panel(self%rule, self%rule%map(step%index), step%map_scale(), impact, &
            modes, self%second_coefficient, start, panel, self%tolerance)
      else
         call solve_panel(self%rule, self%rule%map(step%index), step%map_scale(), impact, modes, &
            start, self%tolerance, panel, inverse)
      end if
   end subroutine solve_step

   !> Solve a panel next to one that has been solved: of the same start and a somewhat other length
   pure subroutine solve_near_step(self, step, impact, modes, start, tolerance, panel, &
                                   inverse)
      !> The collocation
      type(collocator_t), intent(in) :: self
      !> Step
      type(step_t), intent(in) :: step
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> Wanted error of the indentation over its largest value
      real(wp), intent(in) :: tolerance
      !> The panel; on entry its indentation is guessed
      type(panel_t), intent(inout) :: panel
      !> Inverse of the Jacobian of the other panel, on return of one that serves
      real(wp), intent(inout) :: inverse(width, width)

      type(panel_t) :: guessed

      if (.not. is_general(self, impact)) then
         guessed = panel
         call solve_near_panel(self%rule, self%rule%map(step%index), step%map_scale(), impact, &
            modes, start, tolerance, inverse, panel)
         if (panel%converged) return
         panel = guessed
      end if
      call solve_step(self, step, impact, modes, start, panel, inverse)
   end subroutine solve_near_step

   !> Improve a guess at a panel to an accuracy that is less than that of the solution
   pure subroutine improve(self, step, impact, modes, start, tolerance, panel)
      !> The collocation
      type(collocator_t), intent(in) :: self
      !> Step
      type(step_t), intent(in) :: step
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> Wanted error of the indentation over its largest value
      real(wp), intent(in) :: tolerance
      !> The panel; on entry its indentation is guessed
      type(panel_t), intent(inout) :: panel

      type(panel_t) :: guessed
      real(wp) :: inverse(width, width)

      if (.not. is_general(self, impact)) then
         guessed = panel
         call improve_panel(self%rule, self%rule%map(step%index), step%map_scale(), impact, &
            modes, start, tolerance, panel)
         if (panel%converged) return
         panel = guessed
      end if
      call solve_step(self, step, impact, modes, start, panel, inverse)
   end subroutine improve

   !> Solve the companion of a panel, from its own start
   pure subroutine accompany(self, step, impact, modes, start, panel, inverse, companion)
      !> The collocation
      type(collocator_t), intent(in) :: self
      !> Step
      type(step_t), intent(in) :: step
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State of the companion at the start of the panel
      type(start_t), intent(in) :: start
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Inverse of its Jacobian
      real(wp), intent(in) :: inverse(width, width)
      !> Its companion
      type(panel_t), intent(out) :: companion

      real(wp) :: own_inverse(width, width)
      real(wp) :: scale

      scale = step%map_scale()
      associate (rule => self%coarse, map => self%coarse%map(step%index))
         companion%indentation(1:) = self%to_coarse(:, 0)*panel%indentation(0) &
            + apply(self%to_coarse(:, 1:), panel%indentation(1:))
         if (is_general(self, impact)) then
            call solve_general_panel(rule, map, scale, impact, modes, self%second_coefficient, &
               start, companion, self%tolerance)
            return
         end if
         call solve_near_panel(rule, map, scale, impact, modes, start, self%coarse_tolerance, &
            inverse, companion, self%from_coarse, self%to_coarse(:, 1:))
         if (companion%converged) return
         companion%indentation(1:) = self%to_coarse(:, 0)*panel%indentation(0) &
            + apply(self%to_coarse(:, 1:), panel%indentation(1:))
         call solve_panel(rule, map, scale, impact, modes, start, self%tolerance, companion, &
            own_inverse)
      end associate
   end subroutine accompany

   !> Whether the panels are not those of the plain equations
   pure function is_general(self, impact)
      !> The collocation
      type(collocator_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Whether they are
      logical :: is_general

      is_general = abs(self%second_coefficient) > 0.0_wp .or. impact%plate%frozen()
   end function is_general

   !> Make the end of a panel the start of the next one
   subroutine advance(rule, step, modes, panel, start)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Step
      type(step_t), intent(in) :: step
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> The panel
      type(panel_t), intent(in) :: panel
      !> State at the start of the panel, on return that at its end
      type(start_t), intent(inout) :: start

      real(wp) :: u(width), impulse(width)

      associate (map => rule%map(step%index))
         u = hertz(panel%indentation(1:)) - hertz(start%indentation)
         call advance_lags(map, step%map_scale(), modes%contact, u, start%lag)
         impulse = panel%impulse(1:) - start%impulse
         call advance_lags(map, step%map_scale(), modes%plate, impulse, start%p)
         call move_to_end(panel, start)
      end associate
   end subroutine advance

   !> Velocity of the plate at a stage of a panel: U' = alpha F + alpha' I, or alpha F less the
   !> drift of a frozen or hereditary plate
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
      if (impact%plate%drifts()) then
         velocity = velocity - panel%drift(j)
      else
         velocity = velocity + panel%impulse(j) &
            *impact%plate%alpha_rate(panel%time(j), panel%alpha(j))
      end if
   end function plate_velocity

   !> Rate of the indentation at a stage of a panel: s' = v0 - I/m - U'
   pure function relative_velocity(impact, panel, j) result(velocity)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Stage, > 0
      integer, intent(in) :: j
      !> Velocity [m/s]
      real(wp) :: velocity

      velocity = impact%velocity - panel%impulse(j)/impact%mass - plate_velocity(impact, panel, j)
   end function relative_velocity

end module vcor_solver_collocator
