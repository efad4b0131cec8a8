!> Results of an impact by two marches, with some steps and with twice as many, and their error
module vcor_solver_coupled_pair
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_solver_coupled_course, only : course_t
   use vcor_solver_coupled_kernel, only : mesh_t
   use vcor_solver_coupled_peak, only : peak, peak_t
   implicit none
   private

   public :: begins_without_bound, distance, limit, pair_t

   !> A mesh on which an impact is solved twice
   type :: pair_t
      !> The mesh with all steps
      type(mesh_t) :: mesh
      !> With half of the steps, and with all
      type(course_t) :: coarse, fine
      !> Extrapolated coefficient of restitution of the sphere [-], contact time [s], largest force
      !> [N] and displacement [m] and their times [s]
      real(wp) :: cor = 0.0_wp, contact_time = 0.0_wp
      real(wp) :: max_force = 0.0_wp, time_of_max_force = 0.0_wp
      real(wp) :: depth = 0.0_wp, time_of_depth = 0.0_wp
      !> Largest forces of both, not extrapolated [N], and error of the latter by what its forces
      !> scatter [N]
      real(wp) :: coarse_force = 0.0_wp, fine_force = 0.0_wp, scatter = 0.0_wp
   contains
      procedure :: extrapolate
   end type pair_t

contains

   !> Extrapolate the results of two marches that have ended
   subroutine extrapolate(self, impact)
      class(pair_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact

      type(peak_t) :: one, two

      associate (a => self%coarse, b => self%fine)
         self%contact_time = limit(a%contact_time, b%contact_time)
         self%cor = limit(a%cor(impact), b%cor(impact))
         one = peak(a%force(0:a%steps), a%dt)
         two = peak(b%force(0:b%steps), b%dt)
         self%coarse_force = one%value
         self%fine_force = two%value
         self%scatter = two%scatter
         self%max_force = limit(one%value, two%value)
         self%time_of_max_force = limit(one%time, two%time)
         one = peak(a%z(0:a%steps), a%dt)
         two = peak(b%z(0:b%steps), b%dt)
         self%depth = limit(one%value, two%value)
         self%time_of_depth = limit(one%time, two%time)
      end associate
   end subroutine extrapolate

   !> Extrapolate to steps of no length
   elemental function limit(coarse, fine)
      !> Value with some steps
      real(wp), intent(in) :: coarse
      !> Value with twice as many
      real(wp), intent(in) :: fine
      real(wp) :: limit

      limit = (4.0_wp*fine - coarse)/3.0_wp
   end function limit

   !> Whether the force of the first step grows without bound as the steps are halved, as that of a
   !> blunt body on an incompressible plate: what each halving adds does not become less
   pure function begins_without_bound(force) result(yes)
      !> Forces of the first step [N], each with steps half as long as before, shape (3)
      real(wp), intent(in) :: force(:)
      logical :: yes

      yes = force(2) > force(1) .and. force(3) - force(2) >= force(2) - force(1)
   end function begins_without_bound

   !> Estimated error of an extrapolated result, the largest of three so that they do not cancel by
   !> chance: what the level changes, what springs and hats change at equal steps, and what is left
   !> if the steps have less effect than of second order
   elemental function distance(long, middle, equal, short)
      !> Results of the level before with its longer and its shorter steps
      real(wp), intent(in) :: long, middle
      !> Results of this level, with steps equal to those shorter ones and with half of them
      real(wp), intent(in) :: equal, short
      real(wp) :: distance

      distance = max(abs(limit(equal, short) - limit(long, middle)), abs(equal - middle))
      associate (before => middle - long, now => short - equal)
         if (abs(before) > 2.0_wp*abs(now)) then
            ! the rest of a geometric series less the third that extrapolation takes away
            distance = max(distance, abs(now)*(now/(before - now) - 1.0_wp/3.0_wp))
         else
            distance = max(distance, 2.0_wp/3.0_wp*abs(now))
         end if
      end associate
   end function distance

end module vcor_solver_coupled_pair
