!> The paper's own scheme: explicit time marching by the Adams-Bashforth formula, Section V of
!> Green's paper
!>
!> With rectangles the sums have an error of order dt, with trapezoids of order dt^2 except for a
!> small term of order dt^1.5 from the start, u' ~ sqrt(t). The capped kernel t^-a adds an error of
!> order dt^(1-a). The scheme is stable for small steps only (`vcor_solver_paper_formulas`): a run
!> with a growing oscillation from step to step is refused.
module vcor_solver_paper_adams_bashforth
   use vcor_error, only : error_input, error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_indentation, col_sphere_velocity, col_time, &
      col_velocity, contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_richardson, only : best_ratio
   use vcor_solver_direct_product, only : new_product, product_t
   use vcor_solver_features, only : features, paper, refuse_features
   use vcor_solver_paper_march, only : capped, march, most_steps, share_of_newest, &
      stable_damping
   use vcor_solver_type, only : features_of, solver_settings_t, solver_t
   implicit none
   private

   public :: adams_bashforth_t, new_adams_bashforth

   !> The paper's time marching
   type, extends(solver_t) :: adams_bashforth_t
   contains
      procedure :: solve
   end type adams_bashforth_t

contains

   !> Build the solver
   pure subroutine new_adams_bashforth(self, settings, error)
      type(adams_bashforth_t), intent(out) :: self
      !> Form, quadrature, step, end and second term; a step of 0 is a 3000th of the expected
      !> contact time, an accuracy is only compared with the estimated error
      type(solver_settings_t), intent(in) :: settings
      type(error_t), allocatable, intent(out) :: error

      if (settings%form /= 'a' .and. settings%form /= 'b') then
         call raise(error, error_input, "unknown form '"//trim(settings%form)//"'; known: a, b")
      else if (settings%quadrature /= 'rectangle' .and. settings%quadrature /= 'trapezoid') then
         call raise(error, error_input, "unknown quadrature '"//trim(settings%quadrature) &
            //"'; known: rectangle, trapezoid")
      end if
      if (allocated(error)) return
      self%settings = settings
   end subroutine new_adams_bashforth

   !> Compute the course of an impact, with errors estimated from runs with longer steps
   subroutine solve(self, impact, trajectory, error)
      class(adams_bashforth_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      ! with 3000 steps the paper's impact on SLS is off by 2e-8, with half of them by 2e-7
      integer, parameter :: usual_steps = 3000, fewest_steps = 40
      real(wp) :: dt, contact_time

      call refuse(self, impact, error)
      if (allocated(error)) return
      contact_time = impact%law%contact_time*impact%time_scale()
      dt = self%settings%time_step
      if (.not. dt > 0.0_wp) dt = contact_time/real(usual_steps, wp)
      ! the formulas use seven nodes, and the coarsest run has a quarter of the steps
      if (.not. real(fewest_steps, wp)*dt < contact_time) then
         call raise(error, error_numerical, 'solver.time_step is '//trim(in_seconds(dt)) &
            //', too long for a contact expected to last '//trim(in_seconds(contact_time)) &
            //': at most '//trim(in_seconds(contact_time/real(fewest_steps, wp))))
         return
      end if
      call run(self, impact, dt, self%settings%ghost, trajectory, error)
      if (allocated(error)) return
      if (trajectory%status == contact_separated) &
         call estimate_errors(self, impact, dt, trajectory)
   end subroutine solve

   !> Refuse what the scheme cannot compute
   subroutine refuse(self, impact, error)
      type(adams_bashforth_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> Error of code `error_input`, unallocated if there is none
      type(error_t), allocatable, intent(out) :: error

      ! a k' that is infinite at 0 grows as a power of time towards it, t^-0.01 by 1 % over a factor
      ! of 4
      real(wp), parameter :: early = 1.0e-12_wp, noticeable = 1.01_wp
      type(exponential_sum_t) :: terms
      logical :: has(size(features))
      real(wp) :: time

      has = features_of(self%settings, impact)
      has(paper) = .true.
      call refuse_features(has, error)
      if (allocated(error)) return
      if (self%settings%form == 'b') then
         time = early*impact%time_scale()
         if (impact%modulus%glassy() > huge(1.0_wp)) then
            call raise(error, error_input, "form = 'b' needs a finite modulus at t = 0, which " &
               //"this contact does not have; use form = 'a'")
         else if (abs(impact%modulus%rate(time)) &
                  > noticeable*abs(impact%modulus%rate(4.0_wp*time))) then
            call raise(error, error_input, "form = 'b' needs a modulus with a finite rate at " &
               //"t = 0, which this contact does not have; use form = 'a'")
         else if (abs(self%settings%second_coefficient) > 0.0_wp) then
            call impact%kernel_exponentials(impact%time_scale(), 0.1_wp, terms)
            if (terms%error > 0.0_wp) call raise(error, error_input, 'the second Volterra term ' &
               //"in form = 'b' needs a modulus that is a sum of exponentials; use form = 'a'")
         end if
      end if
   end subroutine refuse

   !> One run, with its failures as errors
   subroutine run(self, impact, dt, ghost, trajectory, error)
      type(adams_bashforth_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Whether to continue after the separation
      logical, intent(in) :: ghost
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      logical :: stable, complete

      call march(self%settings, impact, dt, ghost, trajectory, stable, complete)
      if (.not. stable) then
         call raise(error, error_numerical, "scheme = 'adams_bashforth' is unstable with " &
            //'solver.time_step = '//trim(in_seconds(dt))//': the largest stable one is about ' &
            //trim(in_seconds(stable_step(self, impact, dt))))
      else if (.not. complete) then
         call raise(error, error_numerical, 'no end of the contact within the largest number of ' &
            //"steps of scheme = 'adams_bashforth': give a longer solver.time_step")
      end if
   end subroutine run

   !> Results whose errors are estimated
   pure function results_of(impact, trajectory) result(results)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      !> -s'(t0)/v0 and -z'(t0)/v0 [-], contact time [s], largest force [N]
      real(wp) :: results(4)

      associate (final => trajectory%state(:, trajectory%last))
         results = [-final([col_velocity, col_sphere_velocity])/impact%velocity, final(col_time), &
            trajectory%max_force]
      end associate
   end function results_of

   !> Errors of the results by Richardson's extrapolation from runs with two and four times the
   !> step, with the observed order, at most two; it is almost zero if the kernel falls within a
   !> step. If longer steps are unstable, one other run is used with the order of rectangles or of
   !> the capped kernel
   subroutine estimate_errors(self, impact, dt, trajectory)
      type(adams_bashforth_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> The course with this step
      type(trajectory_t), intent(inout) :: trajectory

      ! 2^order of a kernel t^-0.74
      real(wp), parameter :: smallest_ratio = 1.2_wp
      real(wp), dimension(4) :: found, fine, estimate, ratio
      real(wp) :: coarse(4, 2), least
      logical :: known
      integer :: i

      ! smallest 2^order: k(dt)/k(2 dt) = 2^a makes the order 1 - a
      least = 2.0_wp
      if (capped(impact)) least = max(smallest_ratio, &
         2.0_wp*impact%kernel(2.0_wp*dt)/impact%kernel(dt))

      found = results_of(impact, trajectory)
      do i = 1, 2
         call attempt(2.0_wp**i*dt, coarse(:, i), known)
         if (.not. known) exit
      end do
      select case (i)
      case (3)
         ! the last two may agree by chance: use the first two as well
         estimate = max(abs(coarse(:, 1) - found), abs(coarse(:, 2) - coarse(:, 1))/best_ratio)
         ratio = 4.0_wp
         where (estimate > 0.0_wp) ratio = abs(coarse(:, 2) - coarse(:, 1))/estimate
         estimate = estimate/(min(max(ratio, smallest_ratio), 4.0_wp) - 1.0_wp)
      case (2)
         estimate = abs(coarse(:, 1) - found)/(least - 1.0_wp)
      case default
         call attempt(0.5_wp*dt, fine, known)
         estimate = abs(found)
         if (known) estimate = abs(found - fine)*least/(least - 1.0_wp)
      end select
      trajectory%cor_error = estimate(1)
      trajectory%cor_sphere_error = estimate(2)
      trajectory%contact_time_error = estimate(3)
      trajectory%max_force_error = estimate(4)
      trajectory%accuracy = self%settings%accuracy

   contains

      !> Results with another step
      subroutine attempt(step, value, known)
         !> Time step [s]
         real(wp), intent(in) :: step
         !> Results
         real(wp), intent(out) :: value(4)
         !> Whether there are any
         logical, intent(out) :: known

         type(trajectory_t) :: trajectory
         logical :: stable, complete

         value = 0.0_wp
         call march(self%settings, impact, step, .false., trajectory, stable, complete)
         known = stable .and. complete .and. trajectory%status == contact_separated
         if (known) value = results_of(impact, trajectory)
      end subroutine attempt
   end subroutine estimate_errors

   !> Largest stable time step, estimated along a course from product integration, which is stable
   !> for any step
   function stable_step(self, impact, dt) result(step)
      type(adams_bashforth_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> An unstable time step [s]
      real(wp), intent(in) :: dt
      !> Estimate [s]
      real(wp) :: step

      ! the estimate is shown with three digits: the largest damping of the course is known as well,
      ! and ten bisections of a factor of two are within 0.1 %
      real(wp), parameter :: accuracy = 1.0e-3_wp, noticeably_less = 0.9_wp
      integer, parameter :: halvings = 100, bisections = 10
      type(product_t) :: product
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error
      real(wp) :: damping, lower, upper
      integer :: i

      call new_product(product, solver_settings_t(accuracy=accuracy, &
         end_time=self%settings%end_time, second_coefficient=self%settings%second_coefficient))
      call product%solve(impact, trajectory, error)
      damping = 0.0_wp
      do i = 1, trajectory%last
         damping = max(damping, impact%target%alpha(trajectory%state(col_time, i)) &
            *impact%law%slope(trajectory%state(col_indentation, i)))
      end do

      ! if the damper is not the cause, the steps are too coarse to follow the course
      upper = noticeably_less*dt
      lower = 0.5_wp*dt
      if (holds(upper)) upper = lower
      do i = 1, halvings
         if (holds(lower)) exit
         upper = lower
         lower = 0.5_wp*lower
      end do
      do i = 1, bisections
         step = sqrt(lower*upper)
         if (holds(step)) then
            lower = step
         else
            upper = step
         end if
      end do
      step = lower

   contains

      !> Whether a time step is short enough for the damper and, in form b, for the sum of k' to
      !> leave about k: too much of it makes the force negative
      pure function holds(trial)
         !> Time step [s]
         real(wp), intent(in) :: trial
         logical :: holds

         real(wp) :: left
         integer :: j

         holds = damping <= stable_damping(self%settings, impact, trial)
         if (.not. holds .or. self%settings%form == 'a') return
         left = impact%kernel(0.0_wp) &
            + share_of_newest(self%settings)*trial*impact%factor*impact%modulus%rate(0.0_wp)
         do j = 1, min(int(impact%law%contact_time*impact%time_scale()/trial), most_steps)
            left = left + trial*impact%factor*impact%modulus%rate(trial*real(j, wp))
            holds = left > 0.5_wp*impact%kernel(trial*real(j, wp))
            if (.not. holds) return
         end do
      end function holds
   end function stable_step

   !> A time as text
   pure function in_seconds(time) result(text)
      !> Time [s]
      real(wp), intent(in) :: time
      !> Text such as 4.00E-07 s, of fixed length: gfortran 12 keeps the length of a deferred-length
      !> function result in static storage, where threads collide
      character(len=11) :: text

      character(len=16) :: buffer

      write(buffer, '(es9.2)') time
      text = trim(adjustl(buffer))//' s'
   end function in_seconds

end module vcor_solver_paper_adams_bashforth
