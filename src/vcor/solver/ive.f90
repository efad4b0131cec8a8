!> Internal variable evolution: the fast method for kernels that are sums of exponentials (Section
!> VI of Green's paper), by collocation with the internal variables eliminated
!>
!> `vcor_solver_ive_march` solves an impact twice over the same panels, with eight and with seven
!> stages; the error of every result is the difference of the two. Where one exceeds the accuracy,
!> the march is repeated with a lower tolerance.
module vcor_solver_ive
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_time, contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_dense, only : width
   use vcor_numeric_radau_rule, only : bridge_t, new_bridge, new_rule, rule_t
   use vcor_solver_features, only : ive, refuse_features
   use vcor_solver_ive_errors, only : errors_of_sums, largest, of_force, state_errors
   use vcor_solver_ive_lags, only : sums_t
   use vcor_solver_ive_march, only : follow
   use vcor_solver_type, only : default_accuracy, features_of, solver_settings_t, solver_t
   use vcor_tuning, only : ive_loosest, sum_share, sum_window
   implicit none
   private

   public :: ive_t, new_ive

   !> Internal variable evolution
   type, extends(solver_t) :: ive_t
      private
      !> Accuracy of the coefficient of restitution used internally [-]; may be higher than
      !> requested
      real(wp) :: accuracy = 0.0_wp
      !> Rules of the two solutions
      type(rule_t) :: rules(2)
      !> Interpolation between them
      type(bridge_t) :: bridge
   contains
      procedure :: solve
   end type ive_t

   !> What an attempt takes
   type :: effort_t
      !> Tolerance of the march, and accuracy of the sums of exponentials, over their usual ones
      real(wp) :: march = 1.0_wp, sums = 1.0_wp
      !> Time up to which the sums are to hold [s]
      real(wp) :: window = 0.0_wp
   end type effort_t

contains

   !> Build the solver
   subroutine new_ive(self, settings, error)
      type(ive_t), intent(out) :: self
      !> Accuracy and end
      type(solver_settings_t), intent(in) :: settings
      type(error_t), allocatable, intent(out) :: error

      call refuse_features(by_ive(features_of(settings)), error)
      if (allocated(error)) return
      self%settings = settings
      if (.not. settings%accuracy > 0.0_wp) self%settings%accuracy = default_accuracy('ive')
      self%accuracy = min(self%settings%accuracy, ive_loosest)
      call new_rule(self%rules(1), width, error)
      if (.not. allocated(error)) call new_rule(self%rules(2), width - 1, error)
      if (.not. allocated(error)) call new_bridge(self%bridge, self%rules(1), self%rules(2))
   end subroutine new_ive

   !> Features of an impact that is solved by this method
   pure function by_ive(features) result(has)
      !> Those of impact and settings, shape (n)
      logical, intent(in) :: features(:)
      logical :: has(size(features))

      has = features
      has(ive) = .true.
   end function by_ive

   !> Compute the course of an impact: march, and again while an error exceeds the accuracy, with a
   !> lower tolerance or a better sum of exponentials, whichever it is that errs; the best counts.
   !> For a kernel that is no finite sum of exponentials, one is made for a window of some expected
   !> contact times, and again for a longer one if the contact outlasts it
   subroutine solve(self, impact, trajectory, error)
      class(ive_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      ! with two, 109 random impacts are the same
      integer, parameter :: most = 4
      type(effort_t) :: effort
      type(trajectory_t) :: other
      type(error_t), allocatable :: failure
      real(wp) :: worst, last
      integer :: trial

      call refuse_features(by_ive(features_of(self%settings, impact)), error)
      if (allocated(error)) return
      effort%window = sum_window*impact%law%contact_time*impact%time_scale()
      call attempt(self, impact, effort, trajectory, worst, error)
      if (allocated(error) .or. trajectory%returns) return
      do trial = 2, most
         if (.not. worst > self%accuracy) return
         call attempt(self, impact, effort, other, last, failure)
         if (allocated(failure)) return
         if (other%status /= contact_separated) return
         if (last < worst) then
            worst = last
            trajectory = other
         end if
      end do
   end subroutine solve

   !> One march, with an effort; the effort that a better one takes
   subroutine attempt(self, impact, effort, trajectory, worst, error)
      class(ive_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      type(effort_t), intent(inout) :: effort
      type(trajectory_t), intent(out) :: trajectory
      !> Largest of the errors [-]; 0 if the contact did not separate
      real(wp), intent(out) :: worst
      type(error_t), allocatable, intent(out) :: error

      type(sums_t) :: sums
      real(wp) :: time_scale, end_time, window, of_march(4), of_sums(4)
      logical :: complete

      worst = 0.0_wp
      time_scale = impact%time_scale()
      end_time = self%settings%end_time
      if (.not. end_time > 0.0_wp) end_time = impact%lasting_time(time_scale)
      do
         call find_sums(impact, effort%window, effort%sums*self%accuracy, sums, error)
         if (allocated(error)) return
         ! an exact sum holds for all times
         window = effort%window
         if (.not. (sums%contact%error > 0.0_wp .or. impact%target%hereditary() &
             .or. impact%target%structure%is_viscoelastic())) window = huge(1.0_wp)
         call follow(self%rules, self%bridge, impact, sums, self%accuracy, effort%march, &
            time_scale, end_time, window, trajectory, of_march, complete, error)
         if (complete .or. allocated(error)) exit
         ! 4, 16, 256 .. times the expected contact time
         effort%window = window*max(sum_window, window/(impact%law%contact_time*time_scale))
      end do
      if (allocated(error)) return
      trajectory%accuracy = self%settings%accuracy
      if (sums%contact%error > 0.0_wp) trajectory%kernel_terms = size(sums%contact%rates)
      trajectory%kernel_error = sums%contact%error
      if (trajectory%status /= contact_separated) return
      of_sums = errors_of_sums(impact, sums, trajectory)
      call state_errors(trajectory, of_march)
      call state_errors(trajectory, of_sums)
      worst = worst_of(of_march + of_sums)
      if (worst_of(of_sums) > 0.5_wp*worst) then
         effort%sums = 0.1_wp*effort%sums*min(1.0_wp, self%accuracy/worst)
         effort%window = sum_window*trajectory%state(col_time, trajectory%last)
      else
         effort%march = 0.1_wp*effort%march
      end if

   contains

      !> The largest of some errors
      pure function worst_of(errors)
         !> Errors of the results
         real(wp), intent(in) :: errors(4)
         !> Error [-]
         real(wp) :: worst_of

         worst_of = max(largest(errors, trajectory%state(col_time, trajectory%last)), &
            errors(of_force)/trajectory%max_force)
      end function worst_of
   end subroutine attempt

   !> Find the sums of exponentials of contact and plate
   subroutine find_sums(impact, window, accuracy, sums, error)
      type(impact_t), intent(in) :: impact
      !> Time up to which they are to hold [s]
      real(wp), intent(in) :: window
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      type(sums_t), intent(out) :: sums
      type(error_t), allocatable, intent(out) :: error

      call impact%kernel_exponentials(window, sum_share*accuracy, sums%contact)
      if (.not. sums%contact%error < 1.0_wp) then
         call raise(error, error_numerical, 'no sum of exponentials represents the kernel ' &
            //'of this contact')
         return
      end if
      if (impact%target%structure%exists()) then
         allocate (sums%vibration)
         call impact%target%structure%expand(window, impact%law%contact_time &
            *impact%time_scale(), sum_share*accuracy, sums%vibration, error)
      end if
      if (.not. impact%target%hereditary()) return
      call impact%target%response(window, sum_share*accuracy, sums%plate)
      if (.not. sums%plate%error < 1.0_wp) call raise(error, error_numerical, 'no sum of ' &
         //'exponentials represents the memory of this plate: use another plate.waves')
   end subroutine find_sums

end module vcor_solver_ive
