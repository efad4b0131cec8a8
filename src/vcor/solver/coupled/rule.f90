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

   public :: nodes, weights, differences, integrals

   real(wp), parameter :: beta = 1.5_wp
   !> |z|^steps: the weights have errors of its size, and of rounding over it
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
   !>     W_n = |z|^-n/N [C_0 + C_{N/2} + 2 sum_l Re(C_l exp(2 pi i l n/N))],   0 < l < N/2
   pure function weights(response) result(weight)
      !> Responses C at the nodes, shape (:, 0:steps/2)
      complex(wp), intent(in) :: response(:, 0:)
      !> W_0, W_1, ..., shape (:, 0:steps-1)
      real(wp) :: weight(size(response, 1), 0:2*ubound(response, 2) - 1)

      ! real and imaginary part of what a response is multiplied by, negative for the latter
      real(wp), allocatable :: cosine(:, :), sine(:, :)
      real(wp) :: circle(0:2*ubound(response, 2) - 1), factor
      integer :: l, n, phase, steps

      steps = 2*ubound(response, 2)
      do l = 0, steps - 1
         circle(l) = cos(2.0_wp*pi*real(l, wp)/real(steps, wp))
      end do
      allocate (cosine(0:steps/2, 0:steps - 1), sine(0:steps/2, 0:steps - 1))
      do n = 0, steps - 1
         factor = 2.0_wp*wrap**(-real(n, wp)/real(steps, wp))/real(steps, wp)
         phase = 0
         do l = 0, steps/2
            cosine(l, n) = factor*circle(phase)
            ! the sine is the cosine a quarter later
            sine(l, n) = factor*circle(modulo(phase - steps/4, steps))
            phase = modulo(phase + n, steps)
         end do
         cosine(0, n) = 0.5_wp*cosine(0, n)
         cosine(steps/2, n) = 0.5_wp*cosine(steps/2, n)
      end do
      weight = matmul(real(response, wp), cosine) + matmul(aimag(response), sine)
   end function weights

end module vcor_solver_coupled_rule
