!> Modes of a struck structure in a panel, eliminated
!>
!> With the integration matrix H of the panel the parts of a structure (`vcor_impact_structure`)
!> move at the stages by
!>
!>     v = D^-1 [v_0 - b H eta_0 + (q - b jump H) H F],   D = 1 + a H + b H^2
!>     z = (1 + x H)^-1 (z_0 + r H F),   U' = sum v - sum x z,
!>
!> one more function of H that adds to the response P of a plate with memory, U' = alpha F + P H F +
!> past. So a mode costs a few operations for each eigenvalue of H whatever its frequency and
!> damping are; one that a panel does not resolve follows the force as a spring does.
module vcor_solver_ive_modes
   use vcor_impact_structure, only : state_of_modes_t, vibration_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_dense, only : width
   use vcor_numeric_radau_rule, only : map_t, slots
   implicit none
   private

   public :: add_modes, advance_modes, rate_at_start

contains

   !> Add what the modes answer to the impulse of the panel, and what they do without it, as
   !> functions of the eigenvalues of H
   pure subroutine add_modes(vibration, state, eigenvalue, response, past)
      type(vibration_t), intent(in) :: vibration
      !> State at the start of the panel
      type(state_of_modes_t), intent(in) :: state
      !> Eigenvalues of H [s]
      complex(wp), intent(in) :: eigenvalue(slots)
      !> Velocity per impulse [1/kg]
      complex(wp), intent(inout) :: response(slots)
      !> Velocity [m/s]
      complex(wp), intent(inout) :: past(slots)

      real(wp), dimension(slots) :: x, y, xx, xy, r, s, b, c
      real(wp) :: one, other, norm, pull, free, jump, gain
      integer :: n, m

      ! in real numbers, the loop over the eigenvalues innermost
      x = real(eigenvalue, wp)
      y = aimag(eigenvalue)
      xx = x*x - y*y
      xy = 2.0_wp*x*y
      r = 0.0_wp
      s = 0.0_wp
      b = 0.0_wp
      c = 0.0_wp
      do n = 1, size(vibration%square)
         associate (square => vibration%square(n), damping => vibration%damping(n), &
                    yield => vibration%yield(n), rate => state%rate(n))
            pull = square*state%eta(n)
            jump = square*vibration%jump(n)
            do m = 1, slots
               one = 1.0_wp + damping*x(m) + square*xx(m)
               other = damping*y(m) + square*xy(m)
               norm = 1.0_wp/(one*one + other*other)
               one = one*norm
               other = other*norm
               gain = yield - jump*x(m)
               r(m) = r(m) + gain*one - jump*y(m)*other
               s(m) = s(m) - gain*other - jump*y(m)*one
               free = rate - pull*x(m)
               b(m) = b(m) + one*free - other*pull*y(m)
               c(m) = c(m) - one*pull*y(m) - other*free
            end do
         end associate
      end do
      do n = 1, size(vibration%rate)
         associate (rate => vibration%rate(n))
            do m = 1, slots
               one = 1.0_wp + rate*x(m)
               other = rate*y(m)
               norm = rate/(one*one + other*other)
               one = one*norm
               other = other*norm
               r(m) = r(m) - vibration%weight(n)*one
               s(m) = s(m) + vibration%weight(n)*other
               b(m) = b(m) - state%lag(n)*one
               c(m) = c(m) + state%lag(n)*other
            end do
         end associate
      end do
      response = response + cmplx(r, s, wp)
      past = past + cmplx(b, c, wp)
   end subroutine add_modes

   !> Velocity of the struck point at the start of a panel without that by its force, alpha F
   pure function rate_at_start(vibration, state) result(rate)
      type(vibration_t), intent(in) :: vibration
      !> State at the start of the panel
      type(state_of_modes_t), intent(in) :: state
      !> Velocity [m/s]
      real(wp) :: rate

      rate = sum(state%rate) - sum(vibration%rate*state%lag)
   end function rate_at_start

   !> State at the end of a panel, and what the dampings take of a structure that does not relax
   pure subroutine advance_modes(map, duration, vibration, gained, weight, state, lost)
      type(map_t), intent(in) :: map
      !> Duration of the panel [s]
      real(wp), intent(in) :: duration
      type(vibration_t), intent(in) :: vibration
      !> Impulse at the stages, less that at the start [N s]
      real(wp), intent(in) :: gained(width)
      !> Weights of the stages in integrals over the panel [s]
      real(wp), intent(in) :: weight(width)
      !> State at the start on entry, at the end on return
      type(state_of_modes_t), intent(inout) :: state
      !> Energy lost in the dampings, to which that in the panel is added [J]
      real(wp), intent(inout) :: lost

      complex(wp), dimension(slots) :: eigenvalue, impulse, rate
      real(wp) :: left
      integer :: n, modes

      eigenvalue = duration*map%eigenvalue
      impulse = map%decompose(gained)
      ! share of the eigenvalue 0 of a map that is stationary at the end
      left = 1.0_wp - sum(real(map%last*map%left_one, wp))
      ! what the others take has gone into modes
      modes = vibration%modes()
      do n = 1, size(vibration%square)
         associate (square => vibration%square(n), damping => vibration%damping(n), &
                    jump => vibration%jump(n))
            rate = ((state%rate(n) - square*eigenvalue*state%eta(n))*map%left_one &
               + (vibration%yield(n) - square*jump*eigenvalue)*impulse) &
               /(1.0_wp + eigenvalue*(damping + square*eigenvalue))
            ! the last stage of a panel in which time stands still at the end has no weight
            if (damping > 0.0_wp .and. .not. vibration%relaxes .and. n <= modes) lost = lost &
               + damping/vibration%yield(n)*sum(weight*map%compose(rate)**2)
            state%eta(n) = state%eta(n) + sum(real(map%last*(eigenvalue*rate + jump*impulse), wp))
            state%rate(n) = left*state%rate(n) + sum(real(map%last*rate, wp))
         end associate
      end do
      do n = 1, size(vibration%rate)
         state%lag(n) = left*state%lag(n) + sum(real(map%last*(state%lag(n)*map%left_one &
            + vibration%weight(n)*impulse)/(1.0_wp + vibration%rate(n)*eigenvalue), wp))
      end do
   end subroutine advance_modes

end module vcor_solver_ive_modes
