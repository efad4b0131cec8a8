!> Modes of a struck structure in a panel, eliminated
!>
!> With the integration matrix H of the panel the rate of a mode at the stages is
!>
!>     eta' = D^-1 [eta_0' - w^2 H (e_0 eta_0 + sum_i e_i (1 + l_i H)^-1 p_i,0) + y H F],
!>     D = 1 + d H + w^2 H^2 (e_0 + sum_i e_i (1 + l_i H)^-1),
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

      complex(wp) :: modulus(slots), share(slots, size(vibration%rate)), inverse(slots)
      real(wp), dimension(slots) :: x, y, xx, xy, r, s, b, c
      real(wp) :: one, other, norm, pull, free
      integer :: n, m

      if (size(vibration%rate) == 0) then
         ! elastic: in real numbers, the loop over the eigenvalues innermost
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
               do m = 1, slots
                  one = 1.0_wp + damping*x(m) + square*xx(m)
                  other = damping*y(m) + square*xy(m)
                  norm = 1.0_wp/(one*one + other*other)
                  one = one*norm
                  other = other*norm
                  r(m) = r(m) + yield*one
                  s(m) = s(m) - yield*other
                  free = rate - pull*x(m)
                  b(m) = b(m) + one*free - other*pull*y(m)
                  c(m) = c(m) - one*pull*y(m) - other*free
               end do
            end associate
         end do
         response = response + cmplx(r, s, wp)
         past = past + cmplx(b, c, wp)
      else
         call find_modulus(vibration, eigenvalue, modulus, share)
         do n = 1, size(vibration%square)
            inverse = 1.0_wp/(1.0_wp + eigenvalue*(vibration%damping(n) &
               + vibration%square(n)*eigenvalue*modulus))
            response = response + vibration%yield(n)*inverse
            past = past + inverse*free_rate(vibration, state, n, eigenvalue, share)
         end do
      end if
   end subroutine add_modes

   !> e_0 + sum_i e_i (1 + l_i H)^-1, and the terms of the sum
   pure subroutine find_modulus(vibration, eigenvalue, modulus, share)
      type(vibration_t), intent(in) :: vibration
      !> Eigenvalues of H [s]
      complex(wp), intent(in) :: eigenvalue(slots)
      !> Sum [-]
      complex(wp), intent(out) :: modulus(slots)
      !> Its terms [-], shape (slots, n)
      complex(wp), intent(out) :: share(:, :)

      integer :: i

      modulus = vibration%equilibrium
      do i = 1, size(vibration%rate)
         share(:, i) = vibration%modulus(i)/(1.0_wp + vibration%rate(i)*eigenvalue)
         modulus = modulus + share(:, i)
      end do
   end subroutine find_modulus

   !> eta_0' - w^2 H (e_0 eta_0 + sum_i e_i (1 + l_i H)^-1 p_i,0) of a mode
   pure function free_rate(vibration, state, n, eigenvalue, share) result(rate)
      type(vibration_t), intent(in) :: vibration
      !> State at the start of the panel
      type(state_of_modes_t), intent(in) :: state
      !> Mode
      integer, intent(in) :: n
      !> Eigenvalues of H [s]
      complex(wp), intent(in) :: eigenvalue(slots)
      !> e_i (1 + l_i H)^-1 [-]
      complex(wp), intent(in) :: share(:, :)
      !> Rate [m/s]
      complex(wp) :: rate(slots)

      integer :: i

      rate = vibration%equilibrium*state%eta(n)
      do i = 1, size(vibration%rate)
         rate = rate + share(:, i)*state%lag(n, i)
      end do
      rate = state%rate(n) - vibration%square(n)*eigenvalue*rate
   end function free_rate

   !> Velocity of the struck point at the start of a panel without that by its force, alpha F
   pure function rate_at_start(state) result(rate)
      !> State at the start of the panel
      type(state_of_modes_t), intent(in) :: state
      !> Velocity [m/s]
      real(wp) :: rate

      rate = sum(state%rate)
   end function rate_at_start

   !> State at the end of a panel, and what the dampings take
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

      complex(wp), dimension(slots) :: eigenvalue, impulse, modulus, rate
      complex(wp) :: share(slots, size(vibration%rate))
      real(wp) :: left
      integer :: n, i

      eigenvalue = duration*map%eigenvalue
      impulse = map%decompose(gained)
      call find_modulus(vibration, eigenvalue, modulus, share)
      ! share of the eigenvalue 0 of a map that is stationary at the end
      left = 1.0_wp - sum(real(map%last*map%left_one, wp))
      do n = 1, size(vibration%square)
         rate = (free_rate(vibration, state, n, eigenvalue, share)*map%left_one &
            + vibration%yield(n)*impulse)/(1.0_wp + eigenvalue*(vibration%damping(n) &
            + vibration%square(n)*eigenvalue*modulus))
         do i = 1, size(vibration%rate)
            state%lag(n, i) = left*state%lag(n, i) + sum(real(map%last*(eigenvalue*rate &
               + state%lag(n, i)*map%left_one)/(1.0_wp + vibration%rate(i)*eigenvalue), wp))
         end do
         ! the last stage of a panel in which time stands still at the end has no weight
         if (vibration%damping(n) > 0.0_wp) lost = lost + vibration%damping(n)/vibration%yield(n) &
            *sum(weight*map%compose(rate)**2)
         state%eta(n) = state%eta(n) + sum(real(map%last*eigenvalue*rate, wp))
         state%rate(n) = left*state%rate(n) + sum(real(map%last*rate, wp))
      end do
   end subroutine advance_modes

end module vcor_solver_ive_modes
