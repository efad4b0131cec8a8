!> Convolution quadrature (Ch. Lubich, Numer. Math. 52 (1988) 129, doi:10.1007/BF01398686): a
!> response of transform C(s) becomes weights W_n of equal steps, sum W_n z^n = C(delta(z)/dt), with
!> delta of a multistep method for derivatives
!>
!> Here delta(z) = 2 y (1 + 2 y/beta)/(1 + y/beta)^2 with y = (1 - z)/(1 + z), second order and
!> A-stable. beta = 1 is BDF2; beta = oo is the trapezoidal rule, which does not damp what the step
!> does not resolve, and fails for incompressible plates. In between the error is least near
!> beta = 1.5, by measurement.
module vcor_solver_coupled_rule
   use vcor_kinds, only : pi, wp
   implicit none
   private

   public :: nodes, weights, differences, integrals, wrap

   !> beta of delta(z), see above
   real(wp), parameter :: beta = 1.5_wp
   !> |z|^steps: the weights have errors of its size, and of rounding over it, which the marches
   !> amplify. With 1e-6 and 1e-8 results of 40 random impacts change by up to 3e-6, 2 and 1 stated
   !> errors
   real(wp), parameter :: wrap = 1.0e-7_wp
   !> Numerator and denominator of delta(z), coefficients of 1, z and z^2: with them a time
   !> derivative is sum differences = dt sum integrals of what is differentiated
   real(wp), parameter :: differences(0:2) = 2.0_wp*beta &
      *[beta + 2.0_wp, -4.0_wp, 2.0_wp - beta]
   real(wp), parameter :: integrals(0:2) = [(beta + 1.0_wp)**2, 2.0_wp*(beta**2 - 1.0_wp), &
      (beta - 1.0_wp)**2]

contains

   !> Laplace variables at which a response is needed
   pure function nodes(steps, dt) result(s)
      !> Number of steps, even
      integer, intent(in) :: steps
      !> Step [s]
      real(wp), intent(in) :: dt
      !> Variables [1/s], real parts > 0, shape (0:steps/2); the rest are conjugates
      complex(wp) :: s(0:steps/2)

      complex(wp) :: z
      real(wp) :: part
      integer :: l

      do l = 0, steps/2
         part = real(l, wp)/real(steps, wp)
         z = wrap**(1.0_wp/real(steps, wp))*exp(cmplx(0.0_wp, 2.0_wp*pi*part, wp))
         s(l) = (differences(0) + z*(differences(1) + z*differences(2))) &
            /((integrals(0) + z*(integrals(1) + z*integrals(2)))*dt)
      end do
   end function nodes

   !> Weights of responses given at the nodes, by the inverse discrete transform
   !>
   !>     W_n = |z|^-n/N sum_l C_l exp(-2 pi i l n/N),   C_{N-l} the conjugate of C_l
   pure function weights(response) result(weight)
      !> Responses C at the nodes, shape (:, 0:steps/2)
      complex(wp), intent(in) :: response(:, 0:)
      !> W_0, W_1, ..., shape (:, 0:steps-1)
      real(wp) :: weight(size(response, 1), 0:2*ubound(response, 2) - 1)

      integer :: n, steps

      steps = 2*ubound(response, 2)
      call sum_transform(response, weight)
      do n = 0, steps - 1
         weight(:, n) = weight(:, n)*(wrap**(-real(n, wp)/real(steps, wp))/real(steps, wp))
      end do
   end function weights

   !> The sums of `weights`. Those of even and of odd n are such sums of half as many terms, of
   !> C_l +- C_{l+N/2}, as long as N is a multiple of 4
   pure recursive subroutine sum_transform(c, total)
      !> C_l, shape (:, 0:N/2)
      complex(wp), intent(in) :: c(:, 0:)
      !> The sums, shape (:, 0:N-1)
      real(wp), intent(out) :: total(:, 0:)

      complex(wp), allocatable :: even(:, :), odd(:, :)
      real(wp), allocatable :: part(:, :)
      complex(wp) :: turn
      integer :: half, l, n

      half = ubound(c, 2)
      if (modulo(half, 2) /= 0) then
         do n = 0, 2*half - 1
            total(:, n) = real(c(:, 0), wp) + (1 - 2*modulo(n, 2))*real(c(:, half), wp)
            do l = 1, half - 1
               turn = unit(modulo(l*n, 2*half), 2*half)
               total(:, n) = total(:, n) + 2.0_wp*(real(c(:, l), wp)*real(turn, wp) &
                  - aimag(c(:, l))*aimag(turn))
            end do
         end do
         return
      end if
      allocate (even(size(c, 1), 0:half/2), odd(size(c, 1), 0:half/2), part(size(c, 1), 0:half - 1))
      do l = 0, half/2
         even(:, l) = c(:, l) + conjg(c(:, half - l))
         odd(:, l) = (c(:, l) - conjg(c(:, half - l)))*unit(l, 2*half)
      end do
      call sum_transform(even, part)
      total(:, 0::2) = part
      call sum_transform(odd, part)
      total(:, 1::2) = part
   end subroutine sum_transform

   !> exp(-2 pi i l/N)
   elemental function unit(l, n)
      !> The numbers l and N
      integer, intent(in) :: l, n
      complex(wp) :: unit

      real(wp) :: angle

      angle = -2.0_wp*pi*real(l, wp)/real(n, wp)
      unit = cmplx(cos(angle), sin(angle), wp)
   end function unit

end module vcor_solver_coupled_rule
