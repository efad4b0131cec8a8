!> A panel of time: its step, the state at its start, and the solution on it
module vcor_solver_ive_panel
   use vcor_impact_structure, only : state_of_modes_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_dense, only : width
   use vcor_numeric_radau_rule, only : rule_t
   implicit none
   private

   public :: step_t, state_t, panel_t

   !> A step of time
   type :: step_t
      !> Its map: opening, doubling, linear or closing
      integer :: kind = 0
      !> Its duration [s]
      real(wp) :: duration = 0.0_wp
   end type step_t

   !> State at the start of a panel
   type :: state_t
      !> Time [s]
      real(wp) :: time = 0.0_wp
      !> Indentation s [m], and the u of it [m^1.5], which is not kept up while the contact recedes
      real(wp) :: indentation = 0.0_wp, u = 0.0_wp
      !> Its rate [m/s]
      real(wp) :: velocity = 0.0_wp
      !> Force F [N]
      real(wp) :: force = 0.0_wp
      !> Impulse I [N s], and its integral J [N s2]
      real(wp) :: impulse = 0.0_wp, second_impulse = 0.0_wp
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha = 0.0_wp
      !> Velocity Z of the target by its memory or modes [m/s], U' = alpha F + Z + C F'
      real(wp) :: drift = 0.0_wp
      !> Condition N of a receding contact [N/m^0.5], and its time t1 [s]
      real(wp) :: condition = 0.0_wp, t1 = 0.0_wp
      !> Lags of u [m^1.5], or of s while the contact recedes [m], shape (modes)
      real(wp), allocatable :: lag(:)
      !> Lags of the impulse in the plate [N s], shape (modes of the plate)
      real(wp), allocatable :: plate_lag(:)
      !> Modes of a struck structure
      type(state_of_modes_t) :: modes
      !> Energy that their dampings have taken [J]
      real(wp) :: lost = 0.0_wp
   end type state_t

   !> Solution on a panel; index 0 is its start. Condition and t1 are set while the contact recedes
   type :: panel_t
      !> Number of stages; 0: nothing has been solved
      integer :: stages = 0
      !> Its step
      type(step_t) :: step
      !> Map of time in the panel: time(0) + map(1) theta + map(2) theta^2 [s]
      real(wp) :: map(2)
      !> Times [s]
      real(wp) :: time(0:width)
      !> Indentation [m], its u [m^1.5] and its rate [m/s]; the rate is set by `find_velocity`
      real(wp) :: indentation(0:width), u(0:width), velocity(0:width)
      !> Force [N]
      real(wp) :: force(0:width)
      !> Impulse [N s], and its integral [N s2]
      real(wp) :: impulse(0:width), second_impulse(0:width)
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha(0:width)
      !> Velocity of the target by its memory or modes [m/s]
      real(wp) :: drift(0:width)
      !> Condition N of a receding contact [N/m^0.5], and its time t1 [s]
      real(wp) :: condition(0:width), t1(0:width)
      !> Whether Newton's iteration converged
      logical :: converged = .false.
   contains
      procedure :: begin
      procedure :: theta
      procedure :: pace
      procedure :: slope_at_end
      procedure :: rate_at
      procedure :: end_rates
      procedure :: move_to_end
   end type panel_t

contains

   !> Set times and all values at the start of a panel
   pure subroutine begin(self, rule, step, start, elapsed)
      class(panel_t), intent(inout) :: self
      type(rule_t), intent(in) :: rule
      type(step_t), intent(in) :: step
      type(state_t), intent(in) :: start
      !> Times of the stages since the start [s]
      real(wp), intent(out) :: elapsed(width)

      self%stages = rule%stages
      self%step = step
      self%map = step%duration*[rule%map(step%kind)%slope, rule%map(step%kind)%bend]
      elapsed = rule%point(1:)*(self%map(1) + self%map(2)*rule%point(1:))
      self%time(0) = start%time
      self%time(1:) = start%time + elapsed
      self%indentation(0) = start%indentation
      self%u(0) = start%u
      self%velocity(0) = start%velocity
      self%force(0) = start%force
      self%impulse(0) = start%impulse
      self%second_impulse(0) = start%second_impulse
      self%alpha(0) = start%alpha
      self%drift = start%drift
      self%condition(0) = start%condition
      self%t1(0) = start%t1
   end subroutine begin

   !> Position of a time in the panel, 0 at the start and 1 at the end
   elemental function theta(self, time)
      class(panel_t), intent(in) :: self
      !> Time [s], not before the panel's start
      real(wp), intent(in) :: time
      real(wp) :: theta

      theta = max(time - self%time(0), 0.0_wp)
      theta = 2.0_wp*theta/max(tiny(1.0_wp), self%map(1) &
         + sqrt(max(self%map(1)**2 + 4.0_wp*self%map(2)*theta, 0.0_wp)))
   end function theta

   !> dt/dtheta [s]
   elemental function pace(self, theta)
      class(panel_t), intent(in) :: self
      !> Position
      real(wp), intent(in) :: theta
      real(wp) :: pace

      pace = self%map(1) + 2.0_wp*self%map(2)*theta
   end function pace

   !> Rate of a value at the end of a panel, by its polynomial
   pure function slope_at_end(self, rule, value) result(slope)
      class(panel_t), intent(in) :: self
      type(rule_t), intent(in) :: rule
      !> Values at the points
      real(wp), intent(in) :: value(0:width)
      !> Rate [1/s]
      real(wp) :: slope

      slope = sum(rule%derivative(rule%stages, :)*value)/self%pace(1.0_wp)
   end function slope_at_end

   !> Rate of a value at a stage, by its polynomial; 0 where time stands still
   pure function rate_at(self, rule, value, j) result(rate)
      class(panel_t), intent(in) :: self
      type(rule_t), intent(in) :: rule
      !> Values at the points
      real(wp), intent(in) :: value(0:width)
      !> Stage
      integer, intent(in) :: j
      !> Rate [1/s]
      real(wp) :: rate

      real(wp) :: pace

      rate = 0.0_wp
      pace = self%pace(rule%point(j))
      if (pace > 0.0_wp) rate = sum(rule%derivative(j, :)*value)/pace
   end function rate_at

   !> First and second time derivative of a value at the end of a panel, by its polynomial
   pure subroutine end_rates(self, rule, value, first, second)
      class(panel_t), intent(in) :: self
      type(rule_t), intent(in) :: rule
      !> Values at the points
      real(wp), intent(in) :: value(0:width)
      !> Derivatives [1/s, 1/s2]
      real(wp), intent(out) :: first, second

      first = self%slope_at_end(rule, value)
      second = (self%slope_at_end(rule, rule%slopes(value)) - 2.0_wp*self%map(2)*first &
         /self%pace(1.0_wp))/self%pace(1.0_wp)
   end subroutine end_rates

   !> Make the end of the panel the start of the next one, except for the lags
   pure subroutine move_to_end(self, start)
      class(panel_t), intent(in) :: self
      !> State at the start of the panel, on return that at its end
      type(state_t), intent(inout) :: start

      associate (n => self%stages)
         start%time = self%time(n)
         start%indentation = self%indentation(n)
         start%u = self%u(n)
         start%velocity = self%velocity(n)
         start%force = self%force(n)
         start%impulse = self%impulse(n)
         start%second_impulse = self%second_impulse(n)
         start%alpha = self%alpha(n)
         start%drift = self%drift(n)
         start%condition = self%condition(n)
         start%t1 = self%t1(n)
      end associate
   end subroutine move_to_end

end module vcor_solver_ive_panel
