!> Panels of the internal-variable method as a trajectory
module vcor_solver_recording
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, &
      contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t
   use vcor_solver_collocator, only : collocator_t, guess, plate_velocity, refinement_tolerance, &
      solve_step
   use vcor_solver_panel, only : panel_t, start_t
   use vcor_solver_step, only : step_t, step_to
   implicit none
   private

   public :: begin, append

contains

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

   !> Add a panel to the trajectory
   subroutine append(self, impact, kernel, start, panel, trajectory)
      !> The collocation
      type(collocator_t), intent(in) :: self
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
      !> The collocation
      type(collocator_t), intent(in) :: self
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

end module vcor_solver_recording
