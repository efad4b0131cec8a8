!> Course of an impact as marched on one mesh
module vcor_solver_coupled_course
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: course_t
   public :: course_ended, course_outlasts, course_outgrows

   !> Why a march ended: the sphere has left the face
   integer, parameter :: course_ended = 0
   !> The window ended in contact, or with the sphere still on its way in
   integer, parameter :: course_outlasts = 1
   !> The contact became as large as the row of springs
   integer, parameter :: course_outgrows = 2

   !> Course of an impact
   type :: course_t
      !> One of the `course_*` constants
      integer :: status = course_outlasts
      !> Number of steps
      integer :: steps = 0
      !> Step [s]
      real(wp) :: dt = 0.0_wp
      !> Force [N], shape (0:)
      real(wp), allocatable :: force(:)
      !> Displacement of the sphere [m], shape (0:)
      real(wp), allocatable :: z(:)
      !> Velocity of the sphere [m/s], shape (0:)
      real(wp), allocatable :: velocity(:)
      !> Contact radius [m], shape (0:)
      real(wp), allocatable :: radius(:)
      !> Time at which the contact ended [s]
      real(wp) :: contact_time = 0.0_wp
      !> Estimated error of that time which shorter steps do not show [s]
      real(wp) :: time_error = 0.0_wp
      !> Impulse of the contact [N s]
      real(wp) :: impulse = 0.0_wp
      !> Largest tension around the axis [Pa], 0 if there is none
      real(wp) :: tension = 0.0_wp
   contains
      procedure :: rests
      procedure :: cor
   end type course_t

contains

   !> Coefficient of restitution of the sphere, of a contact that has ended
   elemental function cor(self, impact)
      class(course_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> Coefficient [-]
      real(wp) :: cor

      cor = (self%impulse/impact%mass - impact%free_velocity(self%contact_time))/impact%velocity
   end function cor

   !> Whether the weight keeps the sphere in contact for good: over the last third of the time the
   !> force is within a tenth of it. So near to rest the contact is linear and passive, and the
   !> deviation decays
   pure function rests(self, weight)
      class(course_t), intent(in) :: self
      !> Weight of the sphere [N], 0 without gravity
      real(wp), intent(in) :: weight
      logical :: rests

      ! part of the weight by which a linear contact may differ from rest
      real(wp), parameter :: near = 0.1_wp

      rests = self%status == course_outlasts .and. weight > 0.0_wp
      if (rests) rests = all(abs(self%force(2*self%steps/3:self%steps) - weight) <= near*weight)
   end function rests

end module vcor_solver_coupled_course
