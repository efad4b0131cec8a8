!> Internal variable evolution: the fast method for kernels that are sums of exponentials (Section
!> VI of Green's paper), by collocation with the internal variables eliminated
!>
!> Every impact is solved twice on the same panels of time, with eight stages and, by a companion,
!> with seven. Their difference is the error estimate, of a panel and of the outcome. On a layer,
!> which oscillates, each panel of the companion starts from the solution. The equations of a panel
!> are in `vcor_solver_ive_problem`, the sequence of panels in `vcor_solver_ive_contact` and
!> `vcor_solver_ive_rebound`.
module vcor_solver_ive
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_layer_sum, only : layer_misfit_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, &
      col_plate, col_plate_velocity, col_time, contact_separated, trajectory_t
   use vcor_kinds, only : pi, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_solver_ive_collocator, only : collocator_t, new_collocator
   use vcor_solver_ive_contact, only : follow
   use vcor_solver_ive_modes, only : modes_t
   use vcor_solver_type, only : default_accuracy, solver_settings_t, solver_t
   use vcor_tuning, only : end_of_blunt, error_of_blunt, error_of_kernel, error_of_layer, &
      error_of_motion, kernel_share, layer_growth, layer_reach, layer_start, loosest_accuracy, &
      plate_share, shallow_end, window_growth, window_margin
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
      type(layer_misfit_t) :: misfit
      real(wp) :: end_time, ghost_end, window, first_window, growth, time_scale, error_of_sums
      real(wp) :: stiffness, blunt, impulse, known_time, known_impulse
      logical :: complete, ends

      time_scale = impact%time_scale()
      end_time = self%settings%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%patience(time_scale)
      ghost_end = merge(self%settings%end_time, -1.0_wp, self%settings%ghost)
      window = window_margin*impact%law%contact_time*time_scale
      growth = window_growth
      if (impact%plate%layered()) then
         window = impact%plate%window(impact%law%contact_time*time_scale)
         growth = layer_growth
      end if
      first_window = window
      known_time = 0.0_wp
      known_impulse = 0.0_wp
      do
         call impact%kernel_exponentials(window, kernel_share*self%accuracy, modes%contact)
         if (.not. modes%contact%error < 1.0_wp) then
            call raise(error, error_numerical, 'no sum of exponentials stands for the kernel of ' &
               //'this contact')
            return
         end if
         if (impact%plate%hereditary()) then
            call impact%plate%response(window, impact%law%start_exponent, plate_share*self%accuracy, &
               modes%plate, modes%instant, misfit)
            if (impact%plate%layered()) modes%plate%error = misfit%motion*impact%mass/window**2
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
         if (trajectory%status /= contact_separated) then
            known_time = window
            known_impulse = trajectory%impulse_at(window)
         end if
         window = growth*window
      end do
      ends = trajectory%status == contact_separated
      ! nor does it hold if the contact ends within a shorter window that showed no end
      if (impact%plate%layered() .and. trajectory%steps > 0 .and. ((ends .or. allocated(error)) &
          .and. trajectory%time_of_max_force < layer_start*window .or. ends &
          .and. trajectory%state(col_time, trajectory%last) < known_time)) call raise(error, &
         error_numerical, 'the force is largest before the sum of exponentials of the plate ' &
         //'begins to hold: the plate is too soft, too thin or too light for this sphere; take a ' &
         //"larger plate.half_thickness, a lighter sphere, or method = 'direct'")
      ! the sums for bodies blunter than a sphere have fast rates that nothing else keeps in check
      if (impact%plate%layered() .and. impact%law%start_exponent < 1.5_wp &
          .and. trajectory%max_indentation > 0.0_wp .and. .not. allocated(error)) then
         if (is_unstable(impact, modes, window, trajectory%max_indentation)) call raise(error, &
            error_numerical, 'the sum of exponentials of the plate oscillates ever more with ' &
            //"this contact: use method = 'direct' or a larger plate.footprint")
      end if
      if (allocated(error)) return
      trajectory%accuracy = self%settings%accuracy
      if (impact%plate%layered()) trajectory%accuracy = max(trajectory%accuracy, layer_reach)
      if (ends) then
         error_of_sums = error_of_kernel*error_felt(impact, modes%contact, trajectory)
         if (impact%plate%layered()) then
            ! for ghost lines the window became longer than the contact needs
            window = first_window
            do while (window < trajectory%state(col_time, trajectory%last))
               window = growth*window
            end do
            stiffness = impact%mass/window**2
            impulse = trajectory%state(col_impulse, trajectory%last)/(impact%mass*impact%velocity)
            error_of_sums = error_of_sums + error_of_motion*impulse*misfit%motion*stiffness
            if (known_time > 0.0_wp) error_of_sums = max(error_of_sums, &
               abs(trajectory%impulse_at(known_time) - known_impulse)/(impact%mass*impact%velocity))
            trajectory%cor_error = trajectory%cor_error + error_of_layer*stiffness &
               *merge(misfit%power_end, misfit%smooth_end, ends_as_power(impact, trajectory))
            ! 1 for a flat punch, 0 for a sphere and sharper bodies
            blunt = max(3.0_wp - 2.0_wp*impact%law%start_exponent, 0.0_wp)*speed_of_face(trajectory) &
               /impact%velocity
            error_of_sums = max(error_of_sums, error_of_blunt*blunt)
            trajectory%cor_error = max(trajectory%cor_error, end_of_blunt*blunt)
         else
            error_of_sums = error_of_sums + error_of_kernel*modes%plate%error
         end if
         trajectory%cor_error = trajectory%cor_error + error_of_sums
         trajectory%cor_sphere_error = trajectory%cor_sphere_error + error_of_sums
      end if
      associate (contact => modes%contact)
         if (contact%error > 0.0_wp) trajectory%kernel_terms = size(contact%rates)
         trajectory%kernel_error = contact%error
      end associate
   end subroutine solve

   !> Whether a motion beside the largest indentation grows by e^2 or more within the window, which
   !> with the layer itself it never does. Such motions are zeros of 1/(m s^2) + dent + C to the
   !> right of Re s = 2/window, where it has no poles: by the argument principle it turns once
   !> around 0 for each while s goes up that line and down again; beside a dashpot a quarter turn is
   !> missing on either way
   pure function is_unstable(impact, modes, window, indentation)
      !> The impact, its plate a layer
      type(impact_t), intent(in) :: impact
      !> Contact and layer as sums
      type(modes_t), intent(in) :: modes
      !> Window of the sums [s]
      real(wp), intent(in) :: window
      !> Largest indentation [m]
      real(wp), intent(in) :: indentation
      logical :: is_unstable

      ! steps of the frequency, over the inverse of the window and relative, and its end, beyond all
      ! rates
      real(wp), parameter :: line = 2.0_wp, step = 1.2_wp, growth = 1.02_wp, last = 1.0e4_wp
      complex(wp) :: s, psi, now, before, pair(size(modes%plate%pair_rates))
      real(wp) :: frequency, turn

      frequency = 0.0_wp
      turn = 0.0_wp
      before = 1.0_wp
      do while (frequency < last)
         s = cmplx(line, frequency, wp)/window
         psi = modes%plate%viscosity + sum(modes%plate%moduli/(s + modes%plate%rates))
         associate (c => modes%plate%pair_moduli, l => modes%plate%pair_rates)
            pair = s*(s + 2.0_wp*real(l, wp)) + real(l*conjg(l), wp)
            psi = psi + sum((s*real(c, wp) + real(c*conjg(l), wp))*conjg(pair) &
               /(real(pair, wp)**2 + aimag(pair)**2))
         end associate
         now = 1.0_wp/(impact%mass*s**2) + modes%instant + psi/s &
            + 1.0_wp/(modes%contact%complex_modulus(s)*impact%law%slope(indentation))
         turn = turn + atan2(aimag(now*conjg(before)), real(now*conjg(before), wp))
         before = now/abs(now)
         frequency = max(frequency + step, growth*frequency)
      end do
      is_unstable = abs(turn) > pi
   end function is_unstable

   !> Whether the force ends as s^1.5, so that errors of the fast response of a layer appear in the
   !> velocity at the end
   pure function ends_as_power(impact, trajectory)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      logical :: ends_as_power

      ends_as_power = impact%law%receding .or. trajectory%state(col_indentation, trajectory%last) &
         < shallow_end*trajectory%max_indentation
   end function ends_as_power

   !> Velocity of the face by its waves, without a dent: at the largest force, and on average, since
   !> at the end there is no force [m/s]
   pure function speed_of_face(trajectory) result(speed)
      type(trajectory_t), intent(in) :: trajectory
      real(wp) :: speed

      associate (last => trajectory%last, state => trajectory%state)
         speed = max(abs(state(col_plate_velocity, maxloc(state(col_force, 0:last), dim=1) - 1)), &
            abs(state(col_plate, last))/state(col_time, last))
      end associate
   end function speed_of_face

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
