!> Internal variable evolution: the fast method for kernels that are sums of exponentials (Section
!> VI of Green's paper), by collocation with the internal variables eliminated
!>
!> Every impact is solved twice on the same panels of time, with eight stages and, by a companion,
!> with seven. Their difference is the error estimate, of a panel and of the outcome. The equations
!> of a panel are in `vcor_solver_ive_problem`, the sequence of panels in `vcor_solver_ive_contact`
!> and `vcor_solver_ive_rebound`.
module vcor_solver_ive
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_impulse, col_time, contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_solver_ive_collocator, only : collocator_t, new_collocator
   use vcor_solver_ive_contact, only : follow
   use vcor_solver_ive_modes, only : modes_t
   use vcor_solver_type, only : default_accuracy, solver_settings_t, solver_t
   use vcor_tuning, only : error_of_kernel, kernel_share, loosest_accuracy, plate_share, &
      window_growth, window_margin
   implicit none
   private

   public :: ive_t, new_ive

   !> Internal variable evolution
   type, extends(solver_t) :: ive_t
      private
      !> Accuracy of the coefficient of restitution used internally [-]; may be higher than
      !> requested
      real(wp) :: accuracy = 0.0_wp
      type(collocator_t) :: collocator
   contains
      procedure :: solve
   end type ive_t

contains

   !> Build the solver
   subroutine new_ive(self, settings, error)
      type(ive_t), intent(out) :: self
      !> Accuracy, end and second term
      type(solver_settings_t), intent(in) :: settings
      type(error_t), allocatable, intent(out) :: error

      self%settings = settings
      if (.not. settings%accuracy > 0.0_wp) self%settings%accuracy = default_accuracy('ive')
      self%accuracy = min(self%settings%accuracy, loosest_accuracy)
      call new_collocator(self%collocator, self%accuracy, settings%second_coefficient, error)
   end subroutine new_ive

   !> Compute the course of an impact. For a kernel that is no finite sum of exponentials, one is
   !> made for a window of some expected contact times, and again for a longer window if the contact
   !> outlasts it
   subroutine solve(self, impact, trajectory, error)
      class(ive_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      type(modes_t) :: modes
      real(wp) :: end_time, ghost_end, window, time_scale, error_of_sums
      logical :: complete

      time_scale = impact%time_scale()
      end_time = self%settings%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%patience(time_scale)
      ghost_end = merge(self%settings%end_time, -1.0_wp, self%settings%ghost)
      window = window_margin*impact%law%contact_time*time_scale
      do
         call impact%kernel_exponentials(window, kernel_share*self%accuracy, modes%contact)
         if (.not. modes%contact%error < 1.0_wp) then
            call raise(error, error_numerical, 'no sum of exponentials stands for the kernel of ' &
               //'this contact')
            return
         end if
         if (impact%plate%hereditary()) then
            call impact%plate%response(window, plate_share*self%accuracy, modes%plate)
            if (.not. modes%plate%error < 1.0_wp) then
               call raise(error, error_numerical, 'no sum of exponentials stands for what this ' &
                  //'plate remembers: use another plate.waves')
               return
            end if
         end if
         ! an exact sum holds for all times, also for ghost lines beyond the end
         if (.not. (modes%contact%error > 0.0_wp .or. impact%plate%hereditary())) &
            window = huge(1.0_wp)
         call follow(self%collocator, impact, modes, self%accuracy, time_scale, end_time, &
            ghost_end, window, trajectory, complete, error)
         if (complete .or. allocated(error)) exit
         window = window_growth*window
      end do
      if (allocated(error)) return
      trajectory%accuracy = self%settings%accuracy
      if (trajectory%status == contact_separated) then
         error_of_sums = error_of_kernel*(error_felt(impact, modes%contact, trajectory) &
            + modes%plate%error)
         trajectory%cor_error = trajectory%cor_error + error_of_sums
         trajectory%cor_sphere_error = trajectory%cor_sphere_error + error_of_sums
      end if
      associate (contact => modes%contact)
         if (contact%error > 0.0_wp) trajectory%kernel_terms = size(contact%rates)
         trajectory%kernel_error = contact%error
      end associate
   end subroutine solve

   !> Error of the kernel as an impact feels it: that of the sum, or that of the kernel's integral
   !> up to the largest force, times the share of the momentum taken by then, if larger. This is the
   !> case where heavy losses end the loading early in the window
   pure function error_felt(impact, contact, trajectory) result(error)
      type(impact_t), intent(in) :: impact
      !> Kernel as a sum of exponentials
      type(exponential_sum_t), intent(in) :: contact
      type(trajectory_t), intent(in) :: trajectory
      !> Relative error
      real(wp) :: error

      real(wp) :: lost
      integer :: node

      error = contact%error
      if (.not. error > 0.0_wp) return
      do node = 1, trajectory%last - 1
         if (trajectory%state(col_time, node) >= trajectory%time_of_max_force) exit
      end do
      lost = trajectory%state(col_impulse, node)/(impact%mass*impact%velocity)
      associate (t => trajectory%time_of_max_force)
         error = max(error, lost*abs(contact%integral(t) &
            /(impact%kernel_integral(t) + impact%kernel_viscosity()) - 1.0_wp))
      end associate
   end function error_felt

end module vcor_solver_ive
