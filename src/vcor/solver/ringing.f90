!> What a solution misses of the ringing of a structure's modes
!>
!> From first touch on a mode rings beside the force that it follows, with an amplitude a that is
!> known (`impact_t%ringing`). A collocation panel that does not resolve the mode lets it follow the
!> force as a spring does, with any number of stages, so that the difference of two solutions does
!> not show it. Modes beyond a limit (`rest_t` of `vcor_impact_structure`) do not ring at all in the
!> solution. Their phases differ, and what they do together is less than three times the root of the
!> sum of the squares of what each does. The force changes with the surface by its stiffness
!> S = dF/ds, and the integral of a ringing force is what is left at first and last touch, the ends
!> of S(t):
!>
!>     impulse = a/w (Gamma(n) S(s = v/w) + S(s)),   v and s the velocity and the indentation there
!>
!> At first touch, where s = 0 and S ~ t^(n - 1), it is the integral of a sin(w t - (n + 1) pi/2) S,
!> and has one sign for all modes.
module vcor_solver_ringing
   use vcor_impact_problem, only : impact_t
   use vcor_impact_structure, only : vibration_t
   use vcor_impact_trajectory, only : trajectory_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_rule, only : closing, map_t, rule_t
   implicit none
   private

   public :: ringing_t

   !> The ringing modes; none without a structure
   type :: ringing_t
      private
      !> Frequencies [rad/s] and halves of the dampings [1/s], shape (modes)
      real(wp), allocatable :: frequency(:), decay(:)
      !> Amplitudes [m], and velocities that the sphere misses by the impulse at first touch [m/s],
      !> same shape
      real(wp), allocatable :: amplitude(:), velocity(:)
      !> Parts of the amplitudes that the panels have missed, of modes that can be resolved, and
      !> whether these are followed: the others count as missed, shape (modes resolved)
      real(wp), allocatable :: missed(:)
      logical, allocatable :: followed(:)
      !> Number of modes that can be resolved; one more stands for those beyond the limit
      integer :: modes = 0
      !> Time scale of the contact [s]
      real(wp) :: time_scale = 0.0_wp
      !> Longest duration of a panel of each map [s]; 0: not yet found
      real(wp) :: longest(closing) = 0.0_wp
   contains
      procedure :: begin
      procedure :: limit
      procedure :: added
      procedure :: accept
      procedure :: velocity_errors
      procedure, private :: deflection
      procedure :: add_errors
   end type ringing_t

contains

   !> Set up the modes at first touch
   subroutine begin(self, impact, vibration, time_scale, least)
      class(ringing_t), intent(out) :: self
      type(impact_t), intent(in) :: impact
      type(vibration_t), intent(in) :: vibration
      !> Time scale of the contact [s]
      real(wp), intent(in) :: time_scale
      !> Velocity below which the ringing need not be known [m/s]
      real(wp), intent(in) :: least

      ! standard deviations of a sum of random phases, which three in a thousand exceed
      real(wp), parameter :: deviations = 3.0_wp
      real(wp) :: yield(vibration%modes() + 1)
      integer :: n, total

      self%modes = vibration%modes()
      total = self%modes
      self%time_scale = time_scale
      self%frequency = sqrt(vibration%square(:total))
      self%decay = 0.5_wp*vibration%damping(:total)
      yield(:total) = vibration%yield(:total)
      if (vibration%rest%flexibility > 0.0_wp) then
         total = total + 1
         self%frequency = [self%frequency, vibration%rest%frequency]
         self%decay = [self%decay, 0.0_wp]
         ! amplitudes fall as w^-(n + 2), which the integral of their squares divides by 2 n + 3
         yield(total) = deviations*vibration%rest%yield &
            /sqrt(2.0_wp*impact%law%start_exponent + 3.0_wp)
      end if
      allocate (self%amplitude(total), self%velocity(total), self%missed(self%modes), &
         source=0.0_wp)
      do n = 1, total
         if (.not. self%frequency(n) > 0.0_wp) cycle
         self%amplitude(n) = impact%ringing(self%frequency(n), yield(n), time_scale)
         self%velocity(n) = self%amplitude(n)*push(self, n, impact, impact%velocity, 0.0_wp)
      end do
      ! all that are not followed add a hundredth of the least velocity
      self%followed = 2.0_wp*real(self%modes, wp)*self%velocity(:self%modes) >= 0.01_wp*least
      where (.not. self%followed) self%missed = 1.0_wp
   end subroutine begin

   !> Velocity of the sphere by a ringing surface, over the amplitude
   pure function push(self, n, impact, velocity, indentation) result(rate)
      type(ringing_t), intent(in) :: self
      !> Mode
      integer, intent(in) :: n
      type(impact_t), intent(in) :: impact
      !> Velocity [m/s] and indentation [m] at first or last touch
      real(wp), intent(in) :: velocity, indentation
      !> Velocity over the amplitude [1/s]
      real(wp) :: rate

      real(wp) :: time

      time = min(1.0_wp/self%frequency(n), self%time_scale)
      rate = impact%firmness_after(time)*(gamma(impact%law%start_exponent) &
         *impact%law%slope(velocity*time) + impact%law%slope(indentation))*time/impact%mass
   end function push

   !> Part of its amplitude that a mode misses in a panel: the difference between its undamped free
   !> motion and that of the rule
   pure function part(map, phase) result(missed)
      type(map_t), intent(in) :: map
      !> Frequency times duration
      real(wp), intent(in) :: phase
      !> Part, 0 .. 2
      real(wp) :: missed

      complex(wp) :: inverse(size(map%last))
      real(wp) :: left

      missed = 0.0_wp
      ! the error of seven stages is below rounding
      if (phase < 1.0_wp) return
      ! all but a few per cent: the rule damps the mode
      missed = 1.0_wp
      if (phase > 100.0_wp) return
      inverse = map%last*map%left_one/(1.0_wp + (phase*map%eigenvalue)**2)
      left = 1.0_wp - sum(real(map%last*map%left_one, wp))
      missed = sqrt((cos(phase) - left - sum(real(inverse, wp)))**2 &
         + (sin(phase) - phase*sum(real(inverse*map%eigenvalue, wp)))**2)
   end function part

   !> Velocity that a panel misses, if the sphere leaves as fast as it came
   pure function added(self, map, start, duration) result(velocity)
      class(ringing_t), intent(in) :: self
      type(map_t), intent(in) :: map
      !> Start and duration of the panel [s]
      real(wp), intent(in) :: start, duration
      !> Velocity [m/s]
      real(wp) :: velocity

      integer :: n

      velocity = 0.0_wp
      if (.not. allocated(self%velocity)) return
      do n = 1, self%modes
         if (self%followed(n)) velocity = velocity + 2.0_wp*self%velocity(n) &
            *exp(-self%decay(n)*start)*part(map, self%frequency(n)*duration)
      end do
   end function added

   !> Longest panel of a map at first touch that misses less than a velocity
   subroutine limit(self, rule, kind, least, duration)
      class(ringing_t), intent(inout) :: self
      type(rule_t), intent(in) :: rule
      !> The map
      integer, intent(in) :: kind
      !> The velocity [m/s]
      real(wp), intent(in) :: least
      !> Duration [s]
      real(wp), intent(out) :: duration

      ! ratio of the bounds between which it lies: a panel is at most so much shorter than it may
      ! be; with 1.3 one of 18 random impacts changes
      real(wp), parameter :: ratio = 1.1_wp
      real(wp) :: shorter, longer

      duration = huge(1.0_wp)
      if (.not. allocated(self%velocity)) return
      duration = self%longest(kind)
      if (duration > 0.0_wp) return
      duration = huge(1.0_wp)
      if (2.0_wp*sum(self%velocity(:self%modes), self%followed) > least) then
         shorter = 1.0_wp/maxval(self%frequency(:self%modes))
         duration = shorter
         do
            longer = 2.0_wp*shorter
            if (self%added(rule%map(kind), 0.0_wp, longer) > least) exit
            shorter = longer
         end do
         do while (longer > ratio*shorter)
            duration = sqrt(longer*shorter)
            if (self%added(rule%map(kind), 0.0_wp, duration) > least) then
               longer = duration
            else
               shorter = duration
            end if
         end do
         duration = shorter
      end if
      self%longest(kind) = duration
   end subroutine limit

   !> Add what an accepted panel has missed
   pure subroutine accept(self, map, start, duration)
      class(ringing_t), intent(inout) :: self
      type(map_t), intent(in) :: map
      !> Start and duration of the panel [s]
      real(wp), intent(in) :: start, duration

      integer :: n

      if (.not. allocated(self%velocity)) return
      do n = 1, self%modes
         ! never more than another ringing of the same amplitude
         if (.not. (self%followed(n) .and. self%missed(n) < 2.0_wp)) cycle
         self%missed(n) = min(2.0_wp, self%missed(n) &
            + exp(-self%decay(n)*start)*part(map, self%frequency(n)*duration))
      end do
   end subroutine accept

   !> Errors of the sphere's velocity at last touch: by what panels have missed, and by modes beyond
   !> the limit
   pure function velocity_errors(self, impact, velocity, indentation) result(error)
      class(ringing_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> Velocity [m/s] and indentation [m] at last touch
      real(wp), intent(in) :: velocity, indentation
      !> Errors [m/s]
      real(wp) :: error(2)

      real(wp) :: all
      integer :: n

      error = 0.0_wp
      if (.not. allocated(self%velocity)) return
      do n = 1, size(self%velocity)
         if (.not. self%velocity(n) > 0.0_wp) cycle
         all = self%velocity(n) + self%amplitude(n)*push(self, n, impact, velocity, indentation)
         if (n > self%modes) then
            error(2) = error(2) + all
         else
            error(1) = error(1) + self%missed(n)*all
         end if
      end do
   end function velocity_errors

   !> Deflection with which the modes ring that panels have missed, and those beyond the limit
   pure function deflection(self)
      class(ringing_t), intent(in) :: self
      !> Deflection [m]
      real(wp) :: deflection

      deflection = 0.0_wp
      if (allocated(self%velocity)) deflection = sum(self%missed*self%amplitude(:self%modes)) &
         + sum(self%amplitude(self%modes + 1:))
   end function deflection

   !> Add to the errors of a trajectory what no finer solution takes away
   pure subroutine add_errors(self, impact, trajectory, velocity, contacts)
      class(ringing_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(inout) :: trajectory
      !> Error of the sphere's velocity [m/s]
      real(wp), intent(in) :: velocity
      !> Number of contacts, each of which makes the structure ring
      integer, intent(in) :: contacts

      real(wp) :: change, deflection

      deflection = self%deflection()
      change = real(contacts, wp)*velocity/impact%velocity
      trajectory%cor_error = trajectory%cor_error + change
      trajectory%cor_sphere_error = trajectory%cor_sphere_error + change
      trajectory%contact_time_error = trajectory%contact_time_error + deflection &
         /max(abs(trajectory%first_speed), tiny(1.0_wp))
      ! F ~ s^n
      trajectory%max_force_error = trajectory%max_force_error + real(contacts, wp)*deflection &
         *impact%law%slope(trajectory%max_indentation)/impact%law%u(trajectory%max_indentation) &
         *trajectory%max_force
   end subroutine add_errors

end module vcor_solver_ringing
