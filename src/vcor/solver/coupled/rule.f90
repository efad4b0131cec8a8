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

   !> Weights of responses given at the nodes: the inverse discrete transform as a matrix product
   pure function weights(steps) result(matrix)
      !> Number of steps, a multiple of 4
      integer, intent(in) :: steps
      !> In rows real and imaginary parts at the nodes in turn, in columns W_0, W_1, ...; shape
      !> (2 (steps/2 + 1), 0:steps-1)
      real(wp) :: matrix(2*(steps/2 + 1), 0:steps - 1)

      real(wp) :: cosine(0:steps - 1), factor
      integer :: l, n, phase

      do l = 0, steps - 1
         cosine(l) = cos(2.0_wp*pi*real(l, wp)/real(steps, wp))
      end do
      do n = 0, steps - 1
         factor = wrap**(-real(n, wp)/real(steps, wp))/real(steps, wp)
         do l = 0, steps/2
            phase = modulo(l*n, steps)
            matrix(2*l + 1, n) = factor*cosine(phase)
            ! the sine is the cosine a quarter later
            matrix(2*l + 2, n) = factor*cosine(modulo(phase - steps/4, steps))
            if (l > 0 .and. 2*l < steps) matrix(2*l + 1:2*l + 2, n) = &
               2.0_wp*matrix(2*l + 1:2*l + 2, n)
         end do
      end do
   end function weights

end module vcor_solver_coupled_rule
