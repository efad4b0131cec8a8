!> Flight of a sphere under its weight between two bounces, in one step
!>
!> In flight everything is free and linear: the sphere's path is a parabola, the dent recovers by
!> exponentials (`vcor_solver_direct_recovery`), and the modes of a structure ring on
!> (`vcor_impact_structure`). A face is touched where the parabola meets the surface of the dent. A
!> structure may come to meet the sphere: the flight ends where the sphere comes back to its reach,
!> which only shrinks, and steps find the touch from there.
module vcor_solver_direct_flight
   use vcor_impact_problem, only : impact_t
   use vcor_impact_structure, only : state_of_modes_t, vibration_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_solver_direct_recovery, only : recovery_t
   use vcor_solver_direct_run, only : run_t
   implicit none
   private

   public :: fly

contains

   !> Fly to the next bounce
   subroutine fly(run, impact, terms, vibration, recovery, share, time)
      !> The run, free at its newest node; on return at the first node of the next bounce
      type(run_t), intent(inout) :: run
      !> The impact, with the velocity at the first node of this bounce; on return of the next one
      type(impact_t), intent(inout) :: impact
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: terms
      type(vibration_t), intent(in) :: vibration
      !> Recovery of its dents
      type(recovery_t), intent(in) :: recovery
      !> Time step over the contact time of an elastic impact
      real(wp), intent(in) :: share
      !> Duration of the flight from the newest node [s]
      real(wp), intent(out) :: time

      type(run_t) :: next
      type(state_of_modes_t) :: modes
      real(wp) :: velocity, place, dt

      velocity = run%sphere_velocity(impact)
      place = run%sphere(impact)
      modes = run%modes%state()
      if (run%is_face) then
         time = time_to_dent(run, impact, recovery, velocity)
      else
         time = time_to_reach(impact, vibration, modes, place, velocity, run%dt)
      end if
      impact%velocity = velocity + impact%gravity*time
      dt = share*impact%law%contact_time*impact%time_scale()
      place = place + time*(velocity + 0.5_wp*impact%gravity*time)
      call next%begin(impact, terms, vibration, dt)
      next%force = 0.0_wp
      next%effort = run%effort
      next%sunk = run%sunk
      call run%row%recover(recovery, time)
      if (run%is_face) then
         next%sunk = next%sunk + run%alpha*run%impulse
         call meet(next)
      else
         modes = vibration%after(modes, time)
         call next%modes%set(modes, 0.0_wp)
         call move_row(next)
         next%place = place
         next%s = place - sum(modes%eta) - sum(modes%lag)
         next%last_s = next%s
         next%depth = next%s - next%row%surface(impact%law) &
            - (impact%velocity - next%modes%rate())*dt*[0.0_wp, 1.0_wp, 2.0_wp]
      end if
      run = next

   contains

      !> Take over the row with its dents
      subroutine move_row(next)
         type(run_t), intent(inout) :: next

         next%row = run%row
         call next%row%set_step(terms, dt)
         call next%row%find_levels()
      end subroutine move_row

      !> Touch a face at the first node
      subroutine meet(next)
         type(run_t), intent(inout) :: next

         next%has_dent = .not. run%row%is_untouched(impact%law, dt*abs(impact%velocity)/share)
         if (.not. next%has_dent) return
         call move_row(next)
         next%place = next%row%compression(impact%law)
         next%s = next%place
         next%last_s = next%s
         call next%row%begin_pressing(impact%law, next%s, impact%velocity*dt)
         ! a row that has a dent in part does not grow in one way
         next%exact_drag = next%exact_drag .and. next%row%has_one_spring()
         next%u = impact%law%u(next%s)
         next%elastic = next%row%elastic_force()
      end subroutine meet
   end subroutine fly

   !> Time until the sphere meets the surface of its dent
   function time_to_dent(run, impact, recovery, velocity) result(time)
      type(run_t), intent(in) :: run
      type(impact_t), intent(in) :: impact
      type(recovery_t), intent(in) :: recovery
      !> Velocity of the sphere [m/s]
      real(wp), intent(in) :: velocity
      !> Time [s]
      real(wp) :: time

      real(wp) :: lower, upper, c(size(recovery%rate))
      integer :: i

      c = run%row%recovery_of_first(recovery)
      lower = 0.0_wp
      upper = 2.0_wp*abs(velocity)/impact%gravity + run%dt
      do while (gap(upper) > 0.0_wp)
         lower = upper
         upper = 2.0_wp*upper
      end do
      ! the surface of a dent falls the less, the longer it has been free: there is one root
      do i = 1, 2*digits(1.0_wp)
         time = 0.5_wp*(lower + upper)
         if (gap(time) > 0.0_wp) then
            lower = time
         else
            upper = time
         end if
      end do

   contains

      !> Distance of the sphere from the dent
      function gap(time)
         !> Time [s]
         real(wp), intent(in) :: time
         !> Distance [m]
         real(wp) :: gap

         gap = run%row%depth_of(impact%law, sum(c*exp(-recovery%rate*time))) &
            - run%s - time*(velocity + 0.5_wp*impact%gravity*time)
      end function gap
   end function time_to_dent

   !> Time until the sphere comes back to the reach of a structure
   function time_to_reach(impact, vibration, modes, place, velocity, dt) result(time)
      type(impact_t), intent(in) :: impact
      type(vibration_t), intent(in) :: vibration
      type(state_of_modes_t), intent(in) :: modes
      !> Displacement [m] and velocity of the sphere [m/s]
      real(wp), intent(in) :: place, velocity
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Time [s]
      real(wp) :: time

      ! steps that cost less than the reach does
      real(wp), parameter :: few = 16.0_wp
      type(state_of_modes_t) :: later
      real(wp) :: last, fall

      time = 0.0_wp
      later = modes
      do
         last = time
         fall = vibration%rigid_position(later) - vibration%reach(later) - place
         time = (sqrt(max(0.0_wp, velocity**2 + 2.0_wp*impact%gravity*fall)) - velocity) &
            /impact%gravity
         if (.not. time > last + few*dt) exit
         later = vibration%after(modes, time)
      end do
      time = max(time, last)
   end function time_to_reach

end module vcor_solver_direct_flight
