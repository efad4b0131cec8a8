!> A panel of time of the internal-variable method: its step, the state at its start, and the
!> solution on it
!>
!> Steps are in x = sqrt(t) near first contact, later in t.
module vcor_solver_ive_panel
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : width
   use vcor_numeric_radau_collocation, only : linear
   use vcor_tuning, only : owed_length
   implicit none
   private

   public :: step_t, step_to, step_of
   public :: panel_t, start_t, move_to_end

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

   !> State at the start of a panel
   type :: start_t
      !> Time [s]
      real(wp) :: time = 0.0_wp
      !> Indentation s [m]
      real(wp) :: indentation = 0.0_wp
      !> Force F [N]
      real(wp) :: force = 0.0_wp
      !> Impulse I [N s]
      real(wp) :: impulse = 0.0_wp
      !> Integral of the impulse J [N s2]
      real(wp) :: second_impulse = 0.0_wp
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha = 0.0_wp
      !> Deflection U of a frozen plate, or the part due to the memory of a hereditary plate [m]
      real(wp) :: deflection = 0.0_wp
      !> Drift of a frozen or hereditary plate: alpha F - U' [m/s]
      real(wp) :: drift = 0.0_wp
      !> Condition N of a receding contact [N/m^0.5]
      real(wp) :: condition = 0.0_wp
      !> Time t1 of a receding contact [s]
      real(wp) :: t1 = 0.0_wp
      !> Lags of u [m^1.5], or of the indentation while the contact recedes [m], shape (modes)
      real(wp), allocatable :: lag(:)
      !> Lags P_j of a hereditary plate [N s], P_j' = F - l_j P_j, shape (modes of the plate);
      !> unallocated for other plates
      real(wp), allocatable :: p(:)
   end type start_t

   !> Solution on a panel; index 0 is its start. Components that do not apply, such as the condition
   !> while the contact grows, are not set
   type :: panel_t
      !> Number of stages
      integer :: stages = 0
      !> Map of time in the panel: start + map(1) theta + map(2) theta^2 [s]
      real(wp) :: map(2)
      !> Times of the stages [s]
      real(wp) :: time(0:width)
      !> Indentation [m]
      real(wp) :: indentation(0:width)
      !> Force [N]
      real(wp) :: force(0:width)
      !> Impulse [N s]
      real(wp) :: impulse(0:width)
      !> Integral of the impulse [N s2]
      real(wp) :: second_impulse(0:width)
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha(0:width)
      !> Deflection U of a frozen plate, or the part due to the memory of a hereditary plate [m]
      real(wp) :: deflection(0:width)
      !> Drift of a frozen or hereditary plate: alpha F - U' [m/s]
      real(wp) :: drift(0:width)
      !> Condition N of a receding contact [N/m^0.5]
      real(wp) :: condition(0:width)
      !> Time t1 of a receding contact [s]
      real(wp) :: t1(0:width)
      !> Whether Newton's iteration converged
      logical :: converged = .false.
   contains
      procedure :: begin
      procedure :: theta
      procedure :: pace_at_end
   end type panel_t

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

   !> Set all values at the start of a panel, and its times
   pure subroutine begin(self, stages, node, map, start, elapsed)
      class(panel_t), intent(inout) :: self
      !> Number of stages
      integer, intent(in) :: stages
      !> Nodes, shape (width)
      real(wp), intent(in) :: node(width)
      !> Coefficients of theta and theta^2 in time [s]
      real(wp), intent(in) :: map(2)
      type(start_t), intent(in) :: start
      !> Times of the stages since the start [s]
      real(wp), intent(out) :: elapsed(width)

      self%stages = stages
      self%map = map
      elapsed = node*(map(1) + map(2)*node)
      self%time(0) = start%time
      self%time(1:) = start%time + elapsed
      self%indentation(0) = start%indentation
      self%force(0) = start%force
      self%impulse(0) = start%impulse
      self%second_impulse(0) = start%second_impulse
      self%alpha(0) = start%alpha
      self%deflection = start%deflection
      self%drift = start%drift
      self%condition(0) = start%condition
      self%t1(0) = start%t1
   end subroutine begin

   !> Position of times in the panel: the root of the quadratic map in its stable form
   pure function theta(self, time)
      class(panel_t), intent(in) :: self
      !> Times [s], not before the panel's start
      real(wp), intent(in) :: time(width)
      !> Positions, 0 at the start and 1 at the end
      real(wp) :: theta(width)

      theta = max(time - self%time(0), 0.0_wp)
      theta = 2.0_wp*theta/max(tiny(1.0_wp), self%map(1) &
         + sqrt(max(self%map(1)**2 + 4.0_wp*self%map(2)*theta, 0.0_wp)))
   end function theta

   !> dt/dtheta at the end of a panel [s]
   pure function pace_at_end(self) result(pace)
      class(panel_t), intent(in) :: self
      !> dt/dtheta [s]
      real(wp) :: pace

      pace = self%map(1) + 2.0_wp*self%map(2)
   end function pace_at_end

   !> Make the end of a panel the start of the next one, except for the lags
   pure subroutine move_to_end(panel, start)
      type(panel_t), intent(in) :: panel
      !> State at the start of the panel, on return that at its end
      type(start_t), intent(inout) :: start

      associate (n => panel%stages)
         start%time = panel%time(n)
         start%indentation = panel%indentation(n)
         start%force = panel%force(n)
         start%impulse = panel%impulse(n)
         start%second_impulse = panel%second_impulse(n)
         start%alpha = panel%alpha(n)
         start%deflection = panel%deflection(n)
         start%drift = panel%drift(n)
         start%condition = panel%condition(n)
         start%t1 = panel%t1(n)
      end associate
   end subroutine move_to_end

end module vcor_solver_ive_panel
