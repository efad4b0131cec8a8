!> Steps of the internal-variable method: in x = sqrt(t) near first contact, later in t
module vcor_solver_ive_step
   use vcor_kinds, only : wp
   use vcor_numeric_radau_collocation, only : linear
   use vcor_tuning, only : owed_length
   implicit none
   private

   public :: step_t, step_to, step_of

   !> One step
   type :: step_t
      !> Index of the map: a step in x starts at x = index*length; `linear` for a step in t,
      !> `closing` for one in the square root of the remaining time
      integer :: index = 0
      !> Length in x [s^0.5] or in t [s]
      real(wp) :: length = 0.0_wp
      !> Nominal length of the first step in x [s^0.5]; steps shortened because of the start grow
      !> back to it
      real(wp) :: reach = 0.0_wp
   contains
      procedure :: map_scale
      procedure :: duration
      procedure :: shorten
      procedure :: proceed
   end type step_t

contains

   !> The step of a given duration, in x if it starts at first contact, else in t
   pure function step_to(start, time) result(step)
      !> Start of the step [s], >= 0
      real(wp), intent(in) :: start
      !> Duration [s]
      real(wp), intent(in) :: time
      type(step_t) :: step

      step = step_of(merge(linear, 0, start > 0.0_wp), time)
   end function step_to

   !> The step of a given duration with a given map
   pure function step_of(kind, time) result(step)
      !> Index of the map, 0 or negative
      integer, intent(in) :: kind
      !> Duration [s]
      real(wp), intent(in) :: time
      type(step_t) :: step

      step%index = kind
      step%length = time
      if (kind == 0) step%length = sqrt(time)
   end function step_of

   !> Scale of the map of the panel [s]
   pure function map_scale(self) result(scale)
      class(step_t), intent(in) :: self
      !> Scale [s]
      real(wp) :: scale

      scale = self%length
      if (self%index >= 0) scale = self%length**2
   end function map_scale

   !> Duration of the step
   pure function duration(self)
      class(step_t), intent(in) :: self
      !> Duration [s]
      real(wp) :: duration

      duration = self%length
      if (self%index >= 0) duration = self%length**2*real(2*self%index + 1, wp)
   end function duration

   !> Shorten the step. Steps in x can only be halved, so that the next ones still start at
   !> multiples of their length; from x = 2 h on, the step becomes one in t of any length
   pure subroutine shorten(self, time)
      class(step_t), intent(inout) :: self
      !> Wanted duration [s], less than the present one
      real(wp), intent(in) :: time

      select case (self%index)
      case (0)
         self%length = 0.5_wp*self%length
      case (1)
         self%length = 0.5_wp*self%length
         self%index = 2
      case default
         self%index = linear
         self%length = time
      end select
   end subroutine shorten

   !> Proceed to the next step
   pure subroutine proceed(self, growth, most)
      !> The step that was taken, on return the next one
      class(step_t), intent(inout) :: self
      !> Factor by which the step could be longer
      real(wp), intent(in) :: growth
      !> Largest index of a step in x
      integer, intent(in) :: most

      if (self%index == linear) then
         self%length = self%length*growth
      else
         self%index = self%index + 1
         if (mod(self%index, 2) == 0 .and. &
             (growth >= 2.0_wp .or. self%length < owed_length*self%reach)) then
            self%index = self%index/2
            self%length = 2.0_wp*self%length
         end if
         if (self%index > most) then
            self%length = self%duration()
            self%index = linear
         end if
      end if
   end subroutine proceed

end module vcor_solver_ive_step
