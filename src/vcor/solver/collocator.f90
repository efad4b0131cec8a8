!> Panels of the internal-variable method: the two rules, and how a panel is guessed and solved
module vcor_solver_collocator
   use vcor_error, only : error_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, new_collocation
   use vcor_solver_general_panel, only : solve_general_panel
   use vcor_solver_modes, only : advance_modes, start_t
   use vcor_solver_panel, only : panel_t, solve_panel
   use vcor_solver_step, only : step_t
   implicit none
   private

   public :: collocator_t, new_collocator
   public :: guess, solve_step, refine, advance, plate_velocity
   public :: most_steps

   !> Stages of the solution: enough that four panels make an impact, few enough that the
   !> eigenvectors of the integration matrices cost three digits only
   integer, parameter :: stages = 7
   !> Stages of the finer solution
   integer, parameter :: fine_stages = 8
   !> Steps in x = sqrt(t) are taken from x = 0, h, .. most_steps*h
   integer, parameter :: most_steps = 12

   !> Collocation rules; immutable once built
   type :: collocator_t
      !> Rule of the panels
      type(collocation_t) :: rule
      !> Rule of the finer solution
      type(collocation_t) :: fine
      !> Interpolation from the points of `rule` to the nodes of `fine`
      real(wp) :: to_fine(fine_stages, 0:stages) = 0.0_wp
      !> Coefficient c2 of the second term of the Volterra series [m^-1.5], 0 without it
      real(wp) :: second_coefficient = 0.0_wp
      !> Error that Newton's method may leave in the indentation, over its largest value
      real(wp) :: tolerance = 0.0_wp
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

      real(wp), parameter :: tightest = 1.0e-14_wp, tolerance_share = 1.0e-4_wp
      real(wp) :: unit(0:stages)
      integer :: i, j

      self%tolerance = max(tightest, tolerance_share*accuracy)
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

   !> Solve the panel of a step
   pure subroutine solve_step(self, rule, step, impact, kernel, start, panel)
      !> The collocation
      type(collocator_t), intent(in) :: self
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

      if (abs(self%second_coefficient) > 0.0_wp .or. impact%plate%frozen()) then
         call solve_general_panel(rule, rule%map(step%index), step%map_scale(), impact, kernel, &
            self%second_coefficient, start, panel, self%tolerance)
      else
         call solve_panel(rule, rule%map(step%index), step%map_scale(), impact, kernel, start, &
            panel, self%tolerance)
      end if
   end subroutine solve_step

   !> Solve the panel of the finer solution, from its own start
   subroutine refine(self, impact, kernel, start, step, panel, fine)
      !> The collocation
      type(collocator_t), intent(in) :: self
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
      call solve_step(self, self%fine, step, impact, kernel, start, fine)
   end subroutine refine

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
         call advance_modes(rule, rule%map(step%index), step%map_scale(), kernel, &
            panel%indentation(1:), start%q)
         start%time = panel%time(n)
         start%indentation = panel%indentation(n)
         start%force = panel%force(n)
         start%impulse = panel%impulse(n)
         start%second_impulse = panel%second_impulse(n)
         start%deflection = panel%deflection(n)
         start%drift = panel%drift(n)
      end associate
   end subroutine advance

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
         velocity = velocity + panel%impulse(j) &
            *impact%plate%alpha_rate(panel%time(j), panel%alpha(j))
      end if
   end function plate_velocity

end module vcor_solver_collocator
