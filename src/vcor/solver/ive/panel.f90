!> Solution on one panel of time, and the state at its start, of the internal-variable method
module vcor_solver_ive_panel
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : width
   implicit none
   private

   public :: panel_t, start_t
   public :: move_to_end, plate_velocity, relative_velocity, plate_gains

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
      !> Drift of a frozen or hereditary plate: alpha F - U', without recoil [m/s]
      real(wp) :: drift = 0.0_wp
      !> Recoil: velocity of a plate that follows the rate of the force at once [m/s]
      real(wp) :: recoil = 0.0_wp
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
      !> Drift of a frozen or hereditary plate: alpha F - U', without recoil [m/s]
      real(wp) :: drift(0:width)
      !> Recoil: velocity of a plate that follows the rate of the force at once [m/s]
      real(wp) :: recoil(0:width)
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
      self%recoil = start%recoil
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
         start%recoil = panel%recoil(n)
         start%condition = panel%condition(n)
         start%t1 = panel%t1(n)
      end associate
   end subroutine move_to_end

   !> Velocity of the plate at a stage of a panel: U' = alpha F + alpha' I; for a frozen or
   !> hereditary plate, alpha F - drift + recoil
   pure function plate_velocity(impact, panel, j) result(velocity)
      type(impact_t), intent(in) :: impact
      type(panel_t), intent(in) :: panel
      !> Stage, > 0
      integer, intent(in) :: j
      !> Velocity [m/s]
      real(wp) :: velocity

      velocity = panel%alpha(j)*panel%force(j)
      if (impact%plate%drifts()) then
         velocity = velocity - panel%drift(j) + panel%recoil(j)
      else
         velocity = velocity + panel%impulse(j) &
            *impact%plate%alpha_rate(panel%time(j), panel%alpha(j))
      end if
   end function plate_velocity

   !> Rate of the plate's velocity alpha' I at the end of the contact, where F is zero; alpha grows
   !> about as a power of time or exponentially there
   pure function plate_gains(panel, alpha_rate) result(gain)
      !> The last panel of the contact
      type(panel_t), intent(in) :: panel
      !> alpha' at the end [m/(N s2)]
      real(wp), intent(in) :: alpha_rate
      !> Rate [m/s2]
      real(wp) :: gain

      associate (n => panel%stages)
         gain = 0.0_wp
         if (alpha_rate > 0.0_wp) gain = alpha_rate*panel%impulse(n) &
            *max(1.0_wp/panel%time(n), alpha_rate/panel%alpha(n))
      end associate
   end function plate_gains

   !> Rate of the indentation at a stage of a panel: s' = v0 + g t - I/m - U'
   pure function relative_velocity(impact, panel, j) result(velocity)
      type(impact_t), intent(in) :: impact
      type(panel_t), intent(in) :: panel
      !> Stage, > 0
      integer, intent(in) :: j
      !> Velocity [m/s]
      real(wp) :: velocity

      velocity = impact%free_velocity(panel%time(j)) - panel%impulse(j)/impact%mass &
         - plate_velocity(impact, panel, j)
   end function relative_velocity

end module vcor_solver_ive_panel
