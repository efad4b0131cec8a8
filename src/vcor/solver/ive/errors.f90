!> Errors of the results of an impact: all that the method states is computed here
!>
!> The error of a result has three parts:
!>
!>     march     the difference of the two solutions over the same panels, at their own ends
!>     ringing   what both miss of the ringing of a structure's modes
!>     sums      what the sums of exponentials differ from the moduli for which they stand
!>
!> Shorter panels reduce the first, and of the second what it adds to the velocities; better sums
!> the third. So these are kept apart until it is known whether another attempt is to be made.
module vcor_solver_ive_errors
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_impulse, col_indentation, col_time, col_velocity, &
      trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver_ive_progress, only : at_branch, progress_t, velocities
   use vcor_solver_ive_lags, only : sums_t
   use vcor_tuning, only : ive_harmless, ive_rounding_per_panel, ive_share
   implicit none
   private

   public :: add_ringing, errors_of_march, errors_of_sums, largest, of_force, state_errors

   !> Indices of the errors: of cor and cor_sphere [-], of the contact time [s] and the largest
   !> force [N]
   integer, parameter :: of_cor = 1, of_cor_sphere = 2, of_time = 3, of_force = 4

contains

   !> State the errors of the results
   pure subroutine state_errors(trajectory, errors)
      !> With what ringing adds
      type(trajectory_t), intent(inout) :: trajectory
      !> Errors by march and sums
      real(wp), intent(in) :: errors(4)

      trajectory%cor_error = trajectory%cor_error + errors(of_cor)
      trajectory%cor_sphere_error = trajectory%cor_sphere_error + errors(of_cor_sphere)
      trajectory%contact_time_error = trajectory%contact_time_error + errors(of_time)
      trajectory%max_force_error = trajectory%max_force_error + errors(of_force)
   end subroutine state_errors

   !> Largest error of the velocities and the contact time, which moves by several times what the
   !> velocities do: it may be twice as large, relative
   pure function largest(errors, contact_time)
      !> Errors of the results
      real(wp), intent(in) :: errors(4)
      !> Contact time [s]
      real(wp), intent(in) :: contact_time
      !> Error [-]
      real(wp) :: largest

      largest = max(errors(of_cor), errors(of_cor_sphere), 0.5_wp*errors(of_time)/contact_time)
   end function largest

   !> Errors by the march: the difference between the results of the two solutions at their own ends
   pure function errors_of_march(self, panels, max_force) result(error)
      !> The progress, at the end of the contact
      type(progress_t), intent(in) :: self
      !> Number of panels
      integer, intent(in) :: panels
      !> Largest force [N]
      real(wp), intent(in) :: max_force
      !> Errors of cor, cor_sphere [-], contact time [s] and largest force [N]
      real(wp) :: error(4)

      ! indentation at the end of a panel over that at its start below which it is next to the
      ! branch point of u at s = 0: twice as much changes none of 109 random impacts, 0 one by four
      ! stated errors
      real(wp), parameter :: near_branch = 0.05_wp
      real(wp) :: fine(2), coarse(2), factor, least, left

      fine = velocities(self%fine, self%fine_end)
      coarse = velocities(self%coarse, self%coarse_end)
      associate (v0 => self%fine%impact%velocity, panel => self%fine%panel, &
                 n => self%fine%panel%stages)
         ! both solutions share what Newton's method leaves
         left = self%fine%tolerance*real(panels, wp)
         factor = 1.0_wp
         if (panel%indentation(n) < near_branch*panel%indentation(0)) factor = at_branch
         least = min((self%added + left)*self%speed/v0, ive_harmless*self%control%accuracy)
         ! the two solutions start each panel from one state
         if (allocated(self%fine%sums%vibration)) least = (self%added + left)*self%speed/v0
         error(of_cor:of_cor_sphere) = max(factor*abs(fine - coarse)/v0, least) &
            + ive_rounding_per_panel*real(panels, wp)
         ! the contact ends with the force, or with the branch point of u
         if (self%fine%recedes .or. any(self%fine%sums%contact%rates*panel%step%duration &
             > real(n, wp))) factor = at_branch
         error(of_time) = max(factor*abs(self%fine_end - self%coarse_end), least*panel%time(n))
         ! a velocity missed at rest changes that of the rebound to second order, but its time to
         ! first
         error(of_time) = error(of_time) + self%missed*self%speed/max(abs(fine(1)), tiny(1.0_wp)) &
            *panel%time(n)
         ! what one panel adds enters the force in full
         error(of_force) = max(at_branch*self%force_difference, min(self%added*self%speed/v0, &
            ive_share*self%control%accuracy)*max_force)
      end associate
   end function errors_of_march

   !> Add what the ringing of a structure's modes changes: to the errors of the velocities by the
   !> march, and to those that are stated only, of time and force. There it falls with a lower power
   !> of the frequency
   subroutine add_ringing(self, trajectory, errors)
      !> The progress, at the end of the contact
      type(progress_t), intent(in) :: self
      !> Its errors are set to those by ringing that shorter panels do not reduce
      type(trajectory_t), intent(inout) :: trajectory
      !> Errors of the results by the march
      real(wp), intent(inout) :: errors(4)

      real(wp) :: indentation, error(2)

      trajectory%cor_error = 0.0_wp
      trajectory%cor_sphere_error = 0.0_wp
      trajectory%contact_time_error = 0.0_wp
      trajectory%max_force_error = 0.0_wp
      if (.not. allocated(self%fine%sums%vibration)) return
      associate (impact => self%fine%impact, last => trajectory%state(:, trajectory%last))
         ! the radius of a contact that recedes falls to 0
         indentation = 0.0_wp
         if (.not. self%fine%recedes) indentation = last(col_indentation)
         error = self%ringing%velocity_errors(impact, abs(last(col_velocity)), indentation)
         errors(of_cor:of_cor_sphere) = errors(of_cor:of_cor_sphere) + error(1)/impact%velocity
         trajectory%first_speed = last(col_velocity)
         call self%ringing%add_errors(impact, trajectory, error(2), 1)
      end associate
   end subroutine add_ringing

   !> Errors by the sums of exponentials. The velocities have the error of the sum for the
   !> contact, or that of the kernel's integral up to the largest force times the share of the
   !> momentum taken by then, if larger: heavy losses may end the loading early in the window. The
   !> velocity of a plate is at most that of the impact, and is off by the error of its memory. An
   !> error of the velocities moves the end of the contact, the more the slower the separation. The
   !> largest force F = int k u' dx has the error of the integral: the total variation of u' is
   !> some three times u over the time
   pure function errors_of_sums(impact, sums, trajectory) result(errors)
      type(impact_t), intent(in) :: impact
      type(sums_t), intent(in) :: sums
      type(trajectory_t), intent(in) :: trajectory
      !> Errors of cor, cor_sphere [-], contact time [s] and largest force [N]
      real(wp) :: errors(4)

      real(wp), parameter :: variation = 3.0_wp
      real(wp) :: of_kernel, of_integral, of_plate, of_velocity
      integer :: node

      of_kernel = sums%contact%error
      of_integral = 0.0_wp
      if (of_kernel > 0.0_wp) then
         associate (t => trajectory%time_of_max_force)
            if (t > 0.0_wp) of_integral = abs(sums%contact%integral(t) &
               /(impact%kernel_integral(t) + impact%kernel_viscosity()) - 1.0_wp)
            do node = 1, trajectory%last - 1
               if (trajectory%state(col_time, node) >= t) exit
            end do
         end associate
         of_kernel = max(of_kernel, of_integral*trajectory%state(col_impulse, node) &
            /(impact%mass*impact%velocity))
      end if
      associate (last => trajectory%state(:, trajectory%last))
         of_plate = 0.0_wp
         if (impact%target%hereditary()) of_plate = max(sums%plate%error, &
            abs(sums%plate%integral(last(col_time))/(impact%target%alpha(0.0_wp) &
            + impact%target%memory_integral(last(col_time))) - 1.0_wp))
         if (allocated(sums%vibration)) of_plate = sums%vibration%error
         of_velocity = of_kernel + of_plate
         errors(of_cor:of_cor_sphere) = of_velocity
         errors(of_time) = of_velocity*last(col_time)*impact%velocity/abs(last(col_velocity))
         errors(of_force) = (of_velocity + variation*of_integral)*trajectory%max_force
      end associate
   end function errors_of_sums

end module vcor_solver_ive_errors
