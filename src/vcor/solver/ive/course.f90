!> State of the integration panel by panel, and what contact and rebound share
!>
!> The error of a panel is mainly the growth, over the panel, of the difference between the solution
!> and its companion. `excess` is this over the allowed error, and the next panel may be longer by
!> the factor excess^(-1/(2 n - 2)) with n stages.
module vcor_solver_ive_course
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : width
   use vcor_solver_ive_panel, only : panel_t, start_t, step_t
   use vcor_solver_ive_problem, only : panel_problem_t
   use vcor_tuning, only : best_time, better, better_power, enough_closings, &
      longest_growth, time_share_continuous, usual_accuracy
   implicit none
   private

   public :: course_t, share

   !> State of the integration
   type :: course_t
      !> Equations of its panels
      type(panel_problem_t) :: problem
      !> The panel being tried, and its companion
      type(panel_t) :: panel, coarse
      !> State at the start of the panel, and of its companion
      type(start_t) :: start, coarse_start
      !> Step of the panel
      type(step_t) :: step
      !> Inverse of the Jacobian of the panel
      real(wp) :: inverse(width, width) = 0.0_wp
      !> The panel solved last, accepted or not
      type(panel_t) :: previous
      !> Accuracy of the motion used internally, over `speed` [-]
      real(wp) :: accuracy = 0.0_wp
      !> Time scale of the contact [s], and its reference velocity [m/s]
      real(wp) :: time_scale = 0.0_wp, speed = 0.0_wp
      !> End of the computation if the contact lasts [s]
      real(wp) :: end_time = 0.0_wp
      !> Error of the panel over the allowed one, and that of the panel refused before
      real(wp) :: excess = 0.0_wp, refused = huge(1.0_wp)
      !> `excess` of the last panel that was refused because of the end of the contact, and the
      !> number of such refusals
      real(wp) :: refused_end = huge(1.0_wp)
      integer :: refused_ends = 0
      !> Whether the contact, or the computation, ends with the panel
      logical :: ends = .false., reaches_end_time = .false.
   contains
      procedure :: begin
      procedure :: record
      procedure :: motion_error
      procedure :: alpha_rate
      procedure :: plate_gains
      procedure :: growth_of
      procedure :: is_best_end
      procedure :: growth_of_step
      procedure :: improvement
      procedure :: time_tolerance
   end type course_t

contains

   !> Set the first node of a trajectory
   subroutine begin(self, trajectory)
      class(course_t), intent(in) :: self
      type(trajectory_t), intent(inout) :: trajectory

      integer, parameter :: usual_panels = 8

      associate (rule => self%problem%collocator%rule, impact => self%problem%impact)
         call trajectory%reserve(usual_panels*rule%stages)
         trajectory%state(:, 0) = 0.0_wp
         trajectory%state(col_sphere_velocity, 0) = impact%velocity
         trajectory%state(col_force, 0) = impact%first_force()
         trajectory%state(col_plate_velocity, 0) = impact%plate%alpha(0.0_wp)*impact%first_force()
         trajectory%state(col_velocity, 0) = impact%velocity &
            - trajectory%state(col_plate_velocity, 0)
         trajectory%share(0) = 0.0_wp
         trajectory%stages = rule%stages
         allocate (trajectory%point(0:rule%stages), source=rule%point(0:rule%stages))
         allocate (trajectory%barycentric(0:rule%stages), source=rule%barycentric(0:rule%stages))
      end associate
   end subroutine begin

   !> Add the nodes of a panel to the trajectory
   subroutine record(self, panel, trajectory)
      class(course_t), intent(in) :: self
      type(panel_t), intent(in) :: panel
      type(trajectory_t), intent(inout) :: trajectory

      integer :: n, first, j

      associate (rule => self%problem%collocator%rule, impact => self%problem%impact)
         n = panel%stages
         call trajectory%reserve(trajectory%final + n)
         call trajectory%add_map(panel%map)
         first = trajectory%final + 1
         trajectory%final = trajectory%final + n
         trajectory%steps = trajectory%steps + 1
         trajectory%share(first:trajectory%final) = rule%weight(1:n) &
            *(panel%map(1) + 2.0_wp*panel%map(2)*rule%node(1:n))*panel%force(1:n)
         do j = 1, n
            associate (state => trajectory%state(:, first + j - 1))
               state(col_time) = panel%time(j)
               state(col_indentation) = panel%indentation(j)
               state(col_force) = panel%force(j)
               state(col_impulse) = panel%impulse(j)
               state(col_sphere) = impact%free_path(panel%time(j)) &
                  - panel%second_impulse(j)/impact%mass
               state(col_sphere_velocity) = impact%free_velocity(panel%time(j)) &
                  - panel%impulse(j)/impact%mass
               state(col_plate) = state(col_sphere) - panel%indentation(j)
               state(col_plate_velocity) = self%problem%plate_velocity(panel, j)
               state(col_velocity) = state(col_sphere_velocity) - state(col_plate_velocity)
            end associate
         end do
      end associate
   end subroutine record

   !> Growth over the panel of the difference between solution and companion
   pure function growth_of(self, one, other) result(difference)
      class(course_t), intent(in) :: self
      !> Values of the solution at the points of the panel
      real(wp), intent(in) :: one(0:width)
      !> Values of the companion
      real(wp), intent(in) :: other(0:width)
      real(wp) :: difference

      associate (n => self%panel%stages)
         difference = abs((one(n) - other(n - 1)) - (one(0) - other(0)))
      end associate
   end function growth_of

   !> Contribution of a panel to the error of the motion, from its companion: through the impulse,
   !> in the velocity of the sphere or alpha' I of the plate; the indentation; the velocity of a
   !> plate that drifts
   pure function motion_error(self) result(error)
      class(course_t), intent(in) :: self
      !> Error over `speed`: without gravity that of the coefficient of restitution [-]
      real(wp) :: error

      associate (panel => self%panel, coarse => self%coarse, impact => self%problem%impact)
         error = self%growth_of(panel%impulse, coarse%impulse) &
            *max(1.0_wp/impact%mass, self%alpha_rate())/self%speed &
            + self%growth_of(panel%indentation, coarse%indentation) &
            /(self%speed*self%time_scale)
         if (impact%plate%drifts()) &
            error = error + self%growth_of(panel%drift, coarse%drift)/self%speed
      end associate
   end function motion_error

   !> Rate of alpha at the end of the panel, for a plate with velocity alpha F + alpha' I
   pure function alpha_rate(self) result(rate)
      class(course_t), intent(in) :: self
      !> Rate [m/(N s2)]
      real(wp) :: rate

      rate = 0.0_wp
      associate (n => self%panel%stages, panel => self%panel, &
                 plate => self%problem%impact%plate)
         if (.not. plate%drifts() .and. panel%alpha(n) > panel%alpha(0)) &
            rate = plate%alpha_rate(panel%time(n), panel%alpha(n))
      end associate
   end function alpha_rate

   !> Rate of the plate's velocity alpha' I at the end of the contact, where F is zero; alpha grows
   !> about as a power of time or exponentially there
   pure function plate_gains(self) result(gain)
      !> The course, its panel the last one of the contact
      class(course_t), intent(in) :: self
      !> Rate [m/s2]
      real(wp) :: gain

      associate (n => self%panel%stages, panel => self%panel, alpha_rate => self%alpha_rate())
         gain = 0.0_wp
         if (alpha_rate > 0.0_wp) gain = alpha_rate*panel%impulse(n) &
            *max(1.0_wp/panel%time(n), alpha_rate/panel%alpha(n))
      end associate
   end function plate_gains

   !> Whether an end cannot be improved: rounding in the force of stiff internal variables, or an
   !> inherited error, limits the accuracy of its time
   pure function is_best_end(self) result(best)
      !> The course, its panel judged
      class(course_t), intent(in) :: self
      logical :: best

      best = self%excess > 0.5_wp*self%refused_end .or. self%refused_ends + 1 >= enough_closings
   end function is_best_end

   !> Factor by which the next panel may be longer than an accepted one
   pure function growth_of_step(self) result(factor)
      class(course_t), intent(in) :: self
      real(wp) :: factor

      factor = min(longest_growth, max(self%excess, tiny(1.0_wp)) &
         **(-1.0_wp/real(2*self%panel%stages - 2, wp)))
   end function growth_of_step

   !> Difference of the solution to its companion over its error: a fixed factor for panels as short
   !> as at the usual accuracy, less for longer ones
   pure function improvement(self) result(factor)
      class(course_t), intent(in) :: self
      real(wp) :: factor

      factor = better*min(1.0_wp, (usual_accuracy/self%accuracy)**better_power)
   end function improvement

   !> Relative difference of the contact times of the two solutions that is accepted. Neither of
   !> them resolves the modes of a continuous spectrum that settle within the last panel; that of a
   !> rebound is short enough
   pure function time_tolerance(self) result(tolerance)
      class(course_t), intent(in) :: self
      !> Tolerance [-]
      real(wp) :: tolerance

      tolerance = self%improvement()
      if (self%problem%modes%contact%error > 0.0_wp .and. &
          .not. associated(self%problem%approach)) tolerance = time_share_continuous
      tolerance = max(tolerance*self%accuracy, best_time)
   end function time_tolerance

   !> Error over the allowed error, limited to `immense`: the forces of a fluid may be almost zero
   pure function share(actual, allowed)
      !> Error, >= 0
      real(wp), intent(in) :: actual
      !> Allowed error, >= 0
      real(wp), intent(in) :: allowed
      real(wp) :: share

      real(wp), parameter :: immense = 1.0e30_wp

      share = 0.0_wp
      if (actual > 0.0_wp) share = immense
      if (actual < immense*allowed) share = actual/allowed
   end function share

end module vcor_solver_ive_course
