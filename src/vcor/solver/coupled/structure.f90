!> The structure behind a face that is solved with its waves: what the coupled contact leaves in it,
!> and whether it strikes again
!>
!> In the contact the structure is a part of the response that moves as a whole (`drift` of
!> `vcor_impact_face`). The march goes on while the sphere still moves towards it, through further
!> contacts. Its state where the sphere leaves follows from the course of the force. From then on
!> it is followed without the waves in the face, which have left the place, with the dent as the
!> springs of a contact without waves keep it (`vcor_solver_direct_march`).
module vcor_solver_coupled_structure
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_structure, only : state_of_modes_t, vibration_t
   use vcor_impact_trajectory, only : col_force, col_indentation, col_sphere, &
      col_sphere_velocity, col_time, columns, trajectory_t
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_solver_direct_march, only : comes_back
   use vcor_solver_direct_modes, only : modes_t
   use vcor_tuning, only : sum_share
   implicit none
   private

   public :: leave_structure

contains

   !> Set what the structure has at the separation, and refuse an impact in which it strikes again
   subroutine leave_structure(impact, accuracy, trajectory, error)
      type(impact_t), intent(in) :: impact
      !> Accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Course of the contact, which has ended
      type(trajectory_t), intent(inout) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      type(vibration_t) :: vibration
      type(state_of_modes_t) :: state
      type(exponential_sum_t) :: terms
      type(modes_t) :: modes
      real(wp) :: end(columns), time, brief, dt, w, before
      real(wp), allocatable :: lag(:)
      integer :: i, n
      logical :: back

      n = trajectory%last
      end = trajectory%state(:, n)
      time = end(col_time)
      brief = min(time, impact%law%contact_time*impact%time_scale())
      call impact%kernel_exponentials(2.0_wp*time, sum_share*accuracy, terms)
      call impact%target%structure%expand(2.0_wp*time, brief, sum_share*accuracy, vibration, error)
      if (allocated(error)) return
      allocate (lag(size(terms%rates)), source=0.0_wp)
      state = vibration%at_rest()
      before = 0.0_wp
      w = 0.0_wp
      dt = 0.0_wp
      do i = 1, n
         ! equal steps but for the last
         if (i == 1 .or. i == n) then
            dt = trajectory%state(col_time, i) - trajectory%state(col_time, i - 1)
            call modes%prepare(vibration, dt)
            call modes%set(state, trajectory%state(col_force, i - 1))
         end if
         if (i == n) then
            ! the force falls as a straight line over the last step
            call modes%advance(2.0_wp*trajectory%state(col_force, i - 1))
         else
            call modes%advance(trajectory%state(col_force, max(i - 2, 0)))
         end if
         call modes%accept(trajectory%state(col_force, i))
         w = trajectory%state(col_sphere, i) - position_of(vibration, modes, &
            trajectory%state(col_force, i))
         lag = lag*exp(-terms%rates*dt) + (w - before)*exp(-0.5_wp*terms%rates*dt)
         before = w
         if (i >= n - 1) state = modes%state()
      end do
      call count_contacts(trajectory)
      trajectory%rigid_velocity = vibration%rigid_velocity(state)
      trajectory%structure_energy = unset
      if (.not. vibration%relaxes) trajectory%structure_energy = vibration%energy(state)
      ! the spring touched first is free at the separation
      if (terms%equilibrium + sum(terms%moduli) > 0.0_wp) then
         before = (terms%equilibrium*w + sum(terms%moduli*lag)) &
            /(terms%equilibrium + sum(terms%moduli))
         w = w - before
         lag = lag - before
      end if
      end(col_indentation) = w
      end(col_sphere) = w + position_of(vibration, modes, 0.0_wp)
      call comes_back(impact, terms, vibration, state, end, w, lag, back)
      if (back) call raise(error, error_numerical, 'the structure strikes the sphere again, or ' &
         //"may, after it has turned back, which method = 'coupled' does not follow: expected " &
         //"waves = 'none', or a structure that is heavier or stiffer")
   end subroutine leave_structure

   !> Find the number of contacts and the end of the first one
   pure subroutine count_contacts(trajectory)
      type(trajectory_t), intent(inout) :: trajectory

      ! nodes without force in a row that make an end
      integer, parameter :: needed = 2
      real(wp) :: value(2), dt
      integer :: i, free, last

      trajectory%first_end = trajectory%state(col_time, trajectory%last)
      trajectory%first_velocity = trajectory%state(col_sphere_velocity, trajectory%last)
      trajectory%contacts = 1
      free = 0
      last = 0
      associate (force => trajectory%state(col_force, :))
         do i = 1, trajectory%last - 1
            if (force(i + 1) > 0.0_wp) then
               if (free >= needed) then
                  trajectory%contacts = trajectory%contacts + 1
                  if (trajectory%contacts == 2) then
                     ! F ~ (t0 - t)^(3/2) at the end of the contact
                     dt = trajectory%state(col_time, last) - trajectory%state(col_time, last - 1)
                     value = force(last:last + 1)**(2.0_wp/3.0_wp)
                     trajectory%first_end = trajectory%state(col_time, last)
                     if (value(1) > value(2)) trajectory%first_end = trajectory%first_end &
                        + dt*min(1.0_wp, value(2)/(value(1) - value(2)))
                     trajectory%first_velocity = trajectory%state(col_sphere_velocity, last)
                     trajectory%contact_time_error = max(trajectory%contact_time_error, dt)
                  end if
               end if
               free = 0
               last = i
            else
               free = free + 1
            end if
         end do
      end associate
   end subroutine count_contacts

   !> Displacement of the structure
   pure function position_of(vibration, modes, force) result(position)
      type(vibration_t), intent(in) :: vibration
      type(modes_t), intent(in) :: modes
      !> Force [N]
      real(wp), intent(in) :: force
      !> Position [m]
      real(wp) :: position

      type(state_of_modes_t) :: state

      state = modes%state()
      position = sum(state%eta) + sum(state%lag) + vibration%residual*force
   end function position_of

end module vcor_solver_coupled_structure
