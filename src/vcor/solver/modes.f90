!> Internal variables of a kernel that is a sum of exponentials: what they add to the equations of
!> a panel, and how they get to its end
!>
!> For q_k' = l_k (u - q_k) the stage values follow from those of u:
!> u - q = (1 + l_k H)^-1 (u - q_n) with the integration matrix H of the panel, known through its
!> eigenvalues. A kernel may have a hundred modes, so the loops over them are kept in independent
!> lanes, which the compiler turns into vector instructions.
module vcor_solver_modes
   use vcor_impact_problem, only : hertz
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, panel_map_t, width
   implicit none
   private

   public :: start_t, resolve_modes, advance_modes

   !> Modes summed side by side
   integer, parameter :: lanes = 4

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
      !> Deflection U of a frozen plate [m]
      real(wp) :: deflection = 0.0_wp
      !> What the velocity of a frozen plate falls behind alpha F [m/s]
      real(wp) :: drift = 0.0_wp
      !> Internal variables q_k [m^1.5], shape (modes)
      real(wp), allocatable :: q(:)
   end type start_t

contains

   !> S and b of F = S u - b as functions of an eigenvalue of H
   pure subroutine resolve_modes(kernel, start, lambda, stiffness, memory)
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> Eigenvalues of H [s], shape (pairs)
      complex(wp), intent(in) :: lambda(:)
      !> S [N/m^1.5], shape (pairs), zero beyond
      complex(wp), intent(out) :: stiffness(width)
      !> b without the vector of ones [N], shape (pairs), zero beyond
      complex(wp), intent(out) :: memory(width)

      real(wp), dimension(lanes) :: s_re, s_im, b_re, b_im
      real(wp) :: x, y
      integer :: m, k, n

      n = size(kernel%rates)
      stiffness = (0.0_wp, 0.0_wp)
      memory = (0.0_wp, 0.0_wp)
      do m = 1, size(lambda)
         x = real(lambda(m), wp)
         y = aimag(lambda(m))
         s_re = 0.0_wp
         s_im = 0.0_wp
         b_re = 0.0_wp
         b_im = 0.0_wp
         do k = 1, n - lanes + 1, lanes
            call add(kernel%rates(k:k + lanes - 1), kernel%moduli(k:k + lanes - 1), &
               start%q(k:k + lanes - 1), x, y, s_re, s_im, b_re, b_im)
         end do
         do k = n - mod(n, lanes) + 1, n
            call add(kernel%rates(k), kernel%moduli(k), start%q(k), x, y, s_re(1), s_im(1), &
               b_re(1), b_im(1))
         end do
         stiffness(m) = cmplx(kernel%equilibrium + sum(s_re), sum(s_im), wp)
         memory(m) = cmplx(sum(b_re), sum(b_im), wp)
         if (kernel%viscosity > 0.0_wp) then
            stiffness(m) = stiffness(m) + kernel%viscosity/lambda(m)
            memory(m) = memory(m) + kernel%viscosity*hertz(start%indentation)/lambda(m)
         end if
      end do
   end subroutine resolve_modes

   !> Add G/(1 + l (x + i y)) and its product with q
   elemental subroutine add(rate, modulus, q, x, y, s_re, s_im, b_re, b_im)
      !> Rate l [1/s]
      real(wp), intent(in) :: rate
      !> Modulus G [N/m^1.5]
      real(wp), intent(in) :: modulus
      !> Internal variable [m^1.5]
      real(wp), intent(in) :: q
      !> Real part of the eigenvalue [s]
      real(wp), intent(in) :: x
      !> Imaginary part of the eigenvalue [s]
      real(wp), intent(in) :: y
      !> Sum of G/(1 + l lambda), real part [N/m^1.5]
      real(wp), intent(inout) :: s_re
      !> Imaginary part
      real(wp), intent(inout) :: s_im
      !> Sum of q G/(1 + l lambda), real part [N]
      real(wp), intent(inout) :: b_re
      !> Imaginary part
      real(wp), intent(inout) :: b_im

      real(wp) :: a, d, share

      a = 1.0_wp + rate*x
      d = rate*y
      share = modulus/(a*a + d*d)
      a = a*share
      d = -d*share
      s_re = s_re + a
      s_im = s_im + d
      b_re = b_re + a*q
      b_im = b_im + d*q
   end subroutine add

   !> Internal variables at the end of a panel: q = u - (1 + l H)^-1 (u - q_n) at the last stage
   pure subroutine advance_modes(rule, map, scale, kernel, indentation, q)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> Indentation at the stages [m]
      real(wp), intent(in) :: indentation(width)
      !> Internal variables: at the start on entry, at the end on return [m^1.5], shape (modes)
      real(wp), intent(inout) :: q(:)

      complex(wp) :: from_u, from_q
      real(wp) :: u(width), lag(size(q)), x, y, a, d
      integer :: n, m, k

      n = rule%stages
      u = hertz(indentation)
      lag = 0.0_wp
      do m = 1, map%pairs
         from_q = cmplx(map%right_re(n, m), map%right_im(n, m), wp)
         from_u = from_q*cmplx(sum(map%left_re(:, m)*u), sum(map%left_im(:, m)*u), wp)
         from_q = from_q*map%left_one(m)
         x = scale*real(map%eigenvalue(m), wp)
         y = scale*aimag(map%eigenvalue(m))
         do k = 1, size(q)
            a = 1.0_wp + kernel%rates(k)*x
            d = kernel%rates(k)*y
            lag(k) = lag(k) + ((real(from_u, wp) - q(k)*real(from_q, wp))*a &
               + (aimag(from_u) - q(k)*aimag(from_q))*d)/(a*a + d*d)
         end do
      end do
      q = u(n) - lag
   end subroutine advance_modes

end module vcor_solver_modes
