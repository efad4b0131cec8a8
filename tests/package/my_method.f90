!> Method `verlet`: the contact alone by Verlet's steps. The example of a method in CONTRIBUTING.md,
!> which a long test puts into the program
!>
!> m s'' = -F, where F(t_n) = sum over all steps of the integral of k(t_n - x) u'(x) dx with u' as
!> its mean in the step: a product integration whose force needs the newest s only, which the
!> velocity in the middle of the step gives.
module vcor_solver_my_method
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_sphere, &
      col_sphere_velocity, col_time, col_velocity, columns, contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver_direct_evaluation, only : end_of_contact, find_peaks, set_shares
   use vcor_solver_type, only : solver_settings_t, solver_t
   implicit none
   private

   public :: verlet_t, new_verlet

   !> The method
   type, extends(solver_t) :: verlet_t
   contains
      procedure :: solve
   end type verlet_t

contains

   !> Build the solver
   subroutine new_verlet(self, settings)
      type(verlet_t), intent(out) :: self
      type(solver_settings_t), intent(in) :: settings

      self%settings = settings
   end subroutine new_verlet

   !> Compute the course of an impact
   subroutine solve(self, impact, trajectory, error)
      class(verlet_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      type(error_t), allocatable, intent(out) :: error

      ! steps of an elastic contact, and most steps of any
      integer, parameter :: usual = 2000, most = 20*usual
      real(wp), allocatable :: u(:), weight(:)
      real(wp) :: dt, middle, node(columns), before
      integer :: n

      dt = self%settings%time_step
      if (.not. dt > 0.0_wp) dt = impact%law%contact_time*impact%time_scale()/real(usual, wp)
      allocate (u(0:most), weight(most))
      u(0) = 0.0_wp
      node = 0.0_wp
      node([col_velocity, col_sphere_velocity]) = impact%velocity
      call trajectory%begin(node)
      do n = 1, most
         weight(n) = (impact%kernel_integral(dt*real(n, wp)) &
            - impact%kernel_integral(dt*real(n - 1, wp)))/dt
         before = node(col_force)
         middle = node(col_velocity) - 0.5_wp*dt*before/impact%mass
         node(col_time) = dt*real(n, wp)
         node([col_indentation, col_sphere]) = node(col_indentation) + dt*middle
         u(n) = impact%law%u(node(col_indentation))
         node(col_force) = sum(weight(n:1:-1)*(u(1:n) - u(0:n - 1)))
         node([col_velocity, col_sphere_velocity]) = middle - 0.5_wp*dt*node(col_force)/impact%mass
         node(col_impulse) = node(col_impulse) + 0.5_wp*dt*(before + node(col_force))
         call trajectory%add(node)
         trajectory%last = n
         trajectory%steps = n
         if (node(col_force) > 0.0_wp .or. node(col_velocity) > 0.0_wp) cycle
         trajectory%state(:, n) = end_of_contact(impact, weight(1), trajectory, n, 1.0_wp)
         trajectory%status = contact_separated
         call set_shares(dt, trajectory)
         call find_peaks(trajectory)
         return
      end do
      call raise(error, error_numerical, 'the contact has not ended after 20 times that of an ' &
         //'elastic sphere')
   end subroutine solve

end module vcor_solver_my_method
