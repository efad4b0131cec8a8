!> Trajectories of the marches of an impact
module vcor_solver_coupled_record
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_sphere, &
      col_sphere_velocity, col_time, columns, contact_lasting, contact_resting, contact_separated, &
      trajectory_t
   use vcor_kinds, only : unset, wp
   use vcor_solver_coupled_course, only : course_t
   use vcor_solver_coupled_pair, only : limit, pair_t
   use vcor_solver_coupled_peak, only : peak, peak_t
   implicit none
   private

   public :: record, record_contact

contains

   !> Record the course of a contact that has ended, extrapolated at the nodes of the longer steps
   subroutine record(pair, impact, trajectory)
      type(pair_t), intent(in) :: pair
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(inout) :: trajectory

      real(wp) :: end(columns)
      integer :: i, n

      associate (a => pair%coarse, b => pair%fine)
         n = count([(real(i, wp)*a%dt < pair%contact_time, i=1, min(a%steps - 1, (b%steps - 1)/2))])
         call fill(trajectory, impact, a%dt, limit(a%force(0:n), b%force(0:2*n:2)), &
            limit(a%z(0:n), b%z(0:2*n:2)), limit(a%velocity(0:n), b%velocity(0:2*n:2)), &
            b%radius(0:2*n:2))
         trajectory%steps = a%steps + b%steps
         trajectory%tension = b%tension
         trajectory%radius(n + 1) = 0.0_wp
         ! the end, with the impulse of the whole contact
         n = n + 1
         trajectory%last = n
         end = unset
         end(col_time) = pair%contact_time
         end(col_force) = 0.0_wp
         end(col_sphere_velocity) = -pair%cor*impact%velocity
         end(col_impulse) = impact%mass*(impact%free_velocity(pair%contact_time) &
            + pair%cor*impact%velocity)
         end(col_sphere) = limit(a%z(a%steps), b%z(b%steps))
         end(col_indentation) = end(col_sphere)
         call trajectory%add(end)
      end associate
      call share_impulse(trajectory)
      trajectory%status = contact_separated
      trajectory%max_indentation = pair%depth
      trajectory%time_of_max_indentation = pair%time_of_depth
      trajectory%max_force = pair%max_force
      trajectory%time_of_max_force = pair%time_of_max_force
   end subroutine record

   !> Record the course of a contact that has not ended
   subroutine record_contact(course, impact, trajectory)
      type(course_t), intent(in) :: course
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(inout) :: trajectory

      type(peak_t) :: top

      associate (n => course%steps)
         call fill(trajectory, impact, course%dt, course%force(0:n), course%z(0:n), &
            course%velocity(0:n), course%radius(0:n))
         trajectory%steps = n
         trajectory%last = n
         trajectory%status = contact_lasting
         if (course%rests(impact%mass*impact%gravity)) trajectory%status = contact_resting
         top = peak(course%force(0:n), course%dt)
         trajectory%max_force = top%value
         trajectory%time_of_max_force = top%time
         top = peak(course%z(0:n), course%dt)
         trajectory%max_indentation = top%value
         trajectory%time_of_max_indentation = top%time
      end associate
      call share_impulse(trajectory)
   end subroutine record_contact

   !> Record equal steps. The plate has no displacement apart from the indentation: both are the
   !> approach of the sphere to the undisturbed face
   subroutine fill(trajectory, impact, dt, force, z, velocity, radius)
      type(trajectory_t), intent(inout) :: trajectory
      type(impact_t), intent(in) :: impact
      !> Step [s]
      real(wp), intent(in) :: dt
      !> Force [N], displacement [m] and velocity of the sphere [m/s], shape (0:n)
      real(wp), intent(in) :: force(0:), z(0:), velocity(0:)
      !> Contact radius [m], same shape
      real(wp), intent(in) :: radius(0:)

      real(wp) :: state(columns)
      integer :: i, n

      n = ubound(force, 1)
      call trajectory%reserve(n + 1)
      state = unset
      do i = 0, n
         state(col_time) = real(i, wp)*dt
         state(col_force) = max(0.0_wp, force(i))
         state([col_sphere, col_indentation]) = z(i)
         state(col_sphere_velocity) = velocity(i)
         state(col_impulse) = impact%mass*(impact%free_velocity(real(i, wp)*dt) - velocity(i))
         if (i == 0) call trajectory%begin(state)
         if (i > 0) call trajectory%add(state)
      end do
      allocate (trajectory%radius(0:n + 1), source=unset)
      trajectory%radius(0:n) = radius
   end subroutine fill

   !> Share the impulse of each step among its ends. Forces would do worse: they may begin as the
   !> square root of time
   pure subroutine share_impulse(trajectory)
      type(trajectory_t), intent(inout) :: trajectory

      associate (n => trajectory%last, impulse => trajectory%state(col_impulse, :))
         trajectory%share(0:n - 1) = 0.5_wp*(impulse(2:n + 1) - impulse(1:n))
         trajectory%share(n) = 0.0_wp
         trajectory%share(1:n) = trajectory%share(1:n) + 0.5_wp*(impulse(2:n + 1) - impulse(1:n))
      end associate
   end subroutine share_impulse

end module vcor_solver_coupled_record
