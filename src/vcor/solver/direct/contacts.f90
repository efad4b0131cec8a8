!> Impacts on a structure by product integration, through contact, flight and further contacts
!>
!> A structure comes back: after the first separation it may strike the sphere again, and the first
!> separation then means nothing. Runs (`vcor_solver_direct_march`) with ever shorter steps show the
!> errors. Where a contact begins or ends within a step the force is not smooth, ~ tau^n, and the
!> error falls as dt^(n+1), or as dt^2 for materials that relax. N steps take N times the modes and
!> springs.
!>
!> A contact that is just made or just missed is not known better than the velocity of the impact.
!> Impacts with velocities next to it show what it changes: the results depend smoothly on the
!> velocity, to first order along a line, but where the number of contacts changes.
module vcor_solver_direct_contacts
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_bounces, only : bounce_t, bounces_t, ends_error
   use vcor_impact_creep, only : in_order, ordered_rates_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_structure, only : vibration_t
   use vcor_impact_trajectory, only : col_indentation, col_sphere_velocity, col_time, &
      col_velocity, contact_separated, contact_unknown, far_off, trajectory_t
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_spectrum, only : finest_inversion
   use vcor_numeric_richardson, only : richardson, richardson_t
   use vcor_solver_direct_march, only : march, next_to
   use vcor_solver_direct_recovery, only : recovery_t
   use vcor_solver_ringing, only : ringing_t
   use vcor_solver_type, only : solver_settings_t
   use vcor_tuning, only : direct_first_steps, direct_most_work, sum_share, sum_window
   implicit none
   private

   public :: solve_contacts

contains

   !> Compute the course of an impact on a structure: the step is halved until the results of three
   !> runs agree
   subroutine solve_contacts(settings, impact, trajectory, error)
      !> Accuracy, time step, end time
      type(solver_settings_t), intent(in) :: settings
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      ! share of the accuracy, or of the error that the sums leave, at which the steps are short
      ! enough: the other results err by up to five times as much as cor_sphere. With twice as much
      ! three of 18 random impacts change, by up to two stated errors, for 2 per cent of the steps
      real(wp), parameter :: share = 0.2_wp
      type(vibration_t) :: vibration
      type(exponential_sum_t) :: terms
      type(recovery_t) :: recovery
      type(trajectory_t) :: near
      type(impact_t) :: other
      type(solver_settings_t) :: once
      type(bounces_t) :: bounces(3)
      real(wp) :: dt, dearer, shortest, window, effort, value(3, 6), beside(2, 4), thousandth, &
         of_sums, wanted
      logical :: given, exact, short_enough
      integer :: level, side

      given = settings%time_step > 0.0_wp
      ! effort of a run with half of the step over that of this one, at most: half as long steps
      ! touch twice as many springs
      dearer = 3.0_wp
      if (settings%bounces > 1 .and. impact%law%receding) dearer = 5.0_wp
      dt = impact%law%contact_time/real(direct_first_steps, wp)*impact%time_scale()
      shortest = dt/64.0_wp
      if (given) dt = 4.0_wp*settings%time_step
      window = 8.0_wp*sum_window*impact%law%contact_time*impact%time_scale()
      call find_sums()
      if (allocated(error)) return
      value = unset
      level = 0
      thousandth = 0.0_wp
      do
         level = level + 1
         call march(settings, impact, terms, vibration, recovery, dt, trajectory, effort, error)
         if (allocated(error)) return
         if (.not. exact .and. end_of(trajectory) > window) then
            window = 4.0_wp*end_of(trajectory)
            call find_sums()
            if (allocated(error)) return
            level = 0
            cycle
         end if
         bounces = [bounces(2:), bounces_t()]
         if (allocated(trajectory%bounces)) bounces(3) = trajectory%bounces
         value = cshift(value, 1, 1)
         value(3, :) = [results_of(trajectory, impact), &
            trajectory%first_end, trajectory%max_force, trajectory%max_indentation, &
            real(trajectory%contacts, wp)]
         if (trajectory%status == contact_unknown) then
            ! steps that are too long let the sphere hop from node to node, half as far with half of
            ! the step; contacts that are real stay where they are
            if (last(trajectory, col_time) > 0.75_wp*thousandth .and. thousandth > 0.0_wp &
                .or. dearer*effort > direct_most_work .or. dt < shortest) then
               call raise(error, error_numerical, 'the sphere has struck the structure a ' &
                  //'thousand times and is still within its reach')
               return
            end if
            thousandth = last(trajectory, col_time)
            level = 0
         else if (trajectory%status /= contact_separated) then
            if (level >= 3 .or. dearer*effort > direct_most_work) return
         else if (level >= 3) then
            call set_errors()
            if (allocated(trajectory%bounces)) call set_errors_of_bounces()
            if (given) exit
            if (short_enough) exit
            if (dearer*effort > direct_most_work) then
               if (trajectory%misses_by_far()) call raise(error, error_numerical, 'the ' &
                  //'accuracy asked for is out of reach of product integration: give a larger ' &
                  //'solver.accuracy')
               exit
            end if
         end if
         dt = 0.5_wp*dt
      end do
      if (allocated(error)) return
      if (allocated(trajectory%bounces)) call leave_out_unknown(trajectory)
      if (trajectory%contacts == 1 .and. .not. trajectory%grazes) return
      once = settings
      once%bounces = 1
      do side = 1, 2
         other = impact
         other%velocity = impact%velocity*(1.0_wp + real(2*side - 3, wp)*next_to)
         ! with longer steps the number of contacts would change at another velocity
         call march(once, other, terms, vibration, recovery, dt, near, effort, error)
         if (allocated(error)) return
         beside(side, :) = [results_of(near, other), near%first_end, real(near%contacts, wp)]
      end do
      trajectory%change_beside = max(change_of(1), change_of(2))
      trajectory%cor_error = trajectory%cor_error + change_of(1)
      trajectory%cor_sphere_error = trajectory%cor_sphere_error + change_of(2)
      trajectory%contact_time_error = trajectory%contact_time_error + change_of(3)

   contains

      !> Largest change of a result beside the impact, beyond that along a line. If the number of
      !> contacts is another one on both sides, nothing tells the line
      pure function change_of(i) result(change)
         !> Result
         integer, intent(in) :: i
         !> Change
         real(wp) :: change

         associate (e => beside(:, i), middle => value(3, i))
            if (all(nint(beside(:, 4)) /= nint(value(3, 6)))) then
               change = maxval(abs(e - middle))
            else
               change = abs(e(1) - 2.0_wp*middle + e(2))
            end if
         end associate
      end function change_of

      !> Expand contact and structure in sums of exponentials
      subroutine find_sums()

         type(exponential_sum_t) :: short
         real(wp) :: accuracy, brief

         accuracy = sum_share*max(settings%accuracy, epsilon(1.0_wp))
         brief = impact%law%contact_time*impact%time_scale()
         ! as in `expand` of a structure
         call impact%kernel_exponentials(window, max(accuracy*(brief/window)**3, &
            finest_inversion), terms)
         if (.not. terms%error < 1.0_wp) then
            call raise(error, error_numerical, 'no sum of exponentials represents the kernel ' &
               //'of this contact')
            return
         end if
         ! data have the error that they have: what a long window adds up to says little about a
         ! contact, which is brief in it
         if (terms%error > accuracy) then
            call impact%kernel_exponentials(sum_window*brief, accuracy, short)
            terms%error = max(terms%error, short%error)
         end if
         if (impact%target%structure%exists()) then
            call impact%target%structure%expand(window, brief, accuracy, vibration, error)
         else
            call vibration%make_none()
         end if
         of_sums = terms%error + vibration%error
         exact = .not. of_sums > 0.0_wp
         if (settings%bounces == 1 .or. allocated(error)) return
         if (any(terms%moduli < 0.0_wp)) then
            call raise(error, error_numerical, 'the kernel of this contact is a sum of ' &
               //'exponentials of either sign, whose dent is not followed through a flight: ' &
               //"expected impact.bounces = 1, or contact.pair = 'series' of materials that are " &
               //'sums of exponentials')
            return
         end if
         call sort(terms)
         call recovery%prepare(terms)
      end subroutine find_sums

      !> Errors of the bounces from the last three runs, with those of the sums. The energy that is
      !> left depends smoothly on everything, where a bounce is just made too: a bounce is known
      !> where cor^2 is
      subroutine set_errors_of_bounces()

         type(richardson_t) :: found
         integer :: n, known

         known = minval(bounces%count)
         associate (new => trajectory%bounces)
            do n = 1, new%count
               associate (bounce => new%list(n))
                  bounce%cor_error = bounce%cor
                  if (n <= known) then
                     found = richardson([bounces(1)%list(n)%cor, bounces(2)%list(n)%cor, &
                        bounce%cor])
                     bounce%cor_error = found%error
                  end if
                  short_enough = short_enough .and. miss_of(bounce) <= share*wanted
                  if (n <= known) bounce%cor_error = bounce%cor_error + of_sums
               end associate
            end do
            found = richardson(bounces%total_time)
            new%total_time_error = found%error + of_sums*new%total_time
         end associate
      end subroutine set_errors_of_bounces

      !> Errors of the results from the last three runs, with those of the sums, and whether steps
      !> are short enough
      subroutine set_errors()

         type(richardson_t) :: found
         ! where a contact is just made or missed, steps must tell velocities apart next to it
         real(wp), parameter :: apart = 0.1_wp*next_to
         type(ringing_t) :: ringing
         real(wp) :: of_modes(2)

         trajectory%accuracy = settings%accuracy
         wanted = max(settings%accuracy, of_sums)
         if (trajectory%grazes) wanted = max(min(settings%accuracy, apart), of_sums)
         if (terms%error > 0.0_wp) trajectory%kernel_terms = size(terms%rates)
         trajectory%kernel_error = terms%error
         found = richardson(value(:, 1))
         short_enough = found%error <= share*wanted
         trajectory%cor_error = found%error + of_sums
         found = richardson(value(:, 2))
         short_enough = short_enough .and. found%error <= share*wanted
         trajectory%cor_sphere_error = found%error + of_sums
         found = richardson(value(:, 3))
         short_enough = short_enough .and. is_done(3, found%error, trajectory%first_end)
         trajectory%contact_time_error = found%error + of_sums*trajectory%first_end
         found = richardson(value(:, 4))
         short_enough = short_enough .and. is_done(4, found%error, trajectory%max_force)
         trajectory%max_force_error = found%error + of_sums*trajectory%max_force
         call ringing%begin(impact, vibration, impact%time_scale(), 0.0_wp)
         of_modes = ringing%velocity_errors(impact, abs(last(trajectory, col_velocity)), &
            last(trajectory, col_indentation))
         call ringing%add_errors(impact, trajectory, of_modes(2), trajectory%contacts)
      end subroutine set_errors

      !> Whether shorter steps do not help a result: it is accurate, or its differences from run to
      !> run do not fall any more. Those of the end of a contact that only just ends do not: there s
      !> all but has a double root, which moves by the root of what rounding changes
      pure function is_done(i, uncertainty, size)
         !> Result
         integer, intent(in) :: i
         !> Its error by the steps, and its size
         real(wp), intent(in) :: uncertainty, size
         logical :: is_done

         is_done = uncertainty <= wanted*size &
            .or. all(nint(value(:, 6)) == nint(value(3, 6))) &
            .and. abs(value(3, i) - value(2, i)) >= abs(value(2, i) - value(1, i))
      end function is_done
   end subroutine solve_contacts

   !> Coefficients of restitution against the rigid motion of the structure and of the sphere alone,
   !> 0 of a sphere that does not leave
   pure function results_of(trajectory, impact) result(e)
      type(trajectory_t), intent(in) :: trajectory
      type(impact_t), intent(in) :: impact
      !> Coefficients
      real(wp) :: e(2)

      e = 0.0_wp
      if (trajectory%status == contact_separated) e = [trajectory%rigid_velocity, 0.0_wp] &
         - last(trajectory, col_sphere_velocity)
      e = e/impact%velocity
   end function results_of

   !> A column of the last node
   pure function last(trajectory, column) result(value)
      type(trajectory_t), intent(in) :: trajectory
      !> Its number
      integer, intent(in) :: column
      !> Value
      real(wp) :: value

      value = trajectory%state(column, trajectory%last)
   end function last

   !> Merge exponentials of one rate, in the order of their rates
   pure subroutine sort(terms)
      type(exponential_sum_t), intent(inout) :: terms

      type(ordered_rates_t) :: spectrum

      spectrum = in_order(terms)
      terms%rates = spectrum%rate(1:)
      terms%moduli = spectrum%modulus(1:)
   end subroutine sort

   !> Time at which a run has ended
   pure function end_of(trajectory) result(time)
      type(trajectory_t), intent(in) :: trajectory
      !> Time [s]
      real(wp) :: time

      time = last(trajectory, col_time)
      if (allocated(trajectory%bounces)) time = max(time, trajectory%bounces%total_time)
   end function end_of

   !> Error of a bounce that counts, that of cor^2
   pure function miss_of(bounce) result(error)
      type(bounce_t), intent(in) :: bounce
      !> Error [-]
      real(wp) :: error

      error = min(1.0_wp, 2.0_wp*bounce%cor)*bounce%cor_error
   end function miss_of

   !> Leave out bounces that are not known
   pure subroutine leave_out_unknown(trajectory)
      type(trajectory_t), intent(inout) :: trajectory

      integer :: n

      if (.not. trajectory%accuracy > 0.0_wp) return
      associate (bounces => trajectory%bounces)
         do n = 1, bounces%count
            if (miss_of(bounces%list(n)) <= far_off*trajectory%accuracy) cycle
            bounces%count = n - 1
            bounces%ending = ends_error
            bounces%total_time = 0.0_wp
            if (n > 1) bounces%total_time = bounces%list(n - 1)%separation
            bounces%total_time_error = unset
            exit
         end do
      end associate
   end subroutine leave_out_unknown

end module vcor_solver_direct_contacts
