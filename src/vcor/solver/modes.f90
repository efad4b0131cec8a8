!> Internal variables of a kernel that is a sum of exponentials: what they add to the equations of
!> a panel, and how they get to its end
!>
!> For q_k' = l_k (u - q_k) the stage values follow from those of u:
!> u - q = (1 + l_k H)^-1 (u - q_n) with the integration matrix H of the panel, known through its
!> eigenvalues. A kernel may have a hundred modes: the loops over the eigenvalues are the innermost
!> ones, which the compiler turns into vector instructions.
module vcor_solver_modes
   use vcor_impact_problem, only : hertz
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, pairs, panel_map_t, width
   use vcor_numeric_linear, only : apply
   use vcor_numeric_pairs, only : constant, ratio
   implicit none
   private

   public :: start_t, resolve_modes, advance_modes

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

   !> S and b of F = S u - b as functions of the eigenvalues of H
   pure subroutine resolve_modes(kernel, start, square, lambda, stiffness, memory)
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> j^2 of the pairs
      real(wp), intent(in) :: square(pairs)
      !> Eigenvalues of H [s]
      real(wp), intent(in) :: lambda(width)
      !> S [N/m^1.5]
      real(wp), intent(out) :: stiffness(width)
      !> b without the vector of ones [N]
      real(wp), intent(out) :: memory(width)

      real(wp) :: a, d, share, s(width), b(width), dashpot(width)
      integer :: k, m

      s = constant(kernel%equilibrium)
      b = 0.0_wp
      do k = 1, size(kernel%rates)
         associate (rate => kernel%rates(k), modulus => kernel%moduli(k), q => start%q(k))
            do m = 1, pairs
               a = 1.0_wp + rate*lambda(m)
               d = rate*lambda(pairs + m)
               share = modulus/(a*a - square(m)*(d*d))
               a = a*share
               d = d*share
               s(m) = s(m) + a
               s(pairs + m) = s(pairs + m) - d
               b(m) = b(m) + a*q
               b(pairs + m) = b(pairs + m) - d*q
            end do
         end associate
      end do
      if (kernel%viscosity > 0.0_wp) then
         dashpot = ratio(square, constant(kernel%viscosity), lambda)
         s = s + dashpot
         b = b + dashpot*hertz(start%indentation)
      end if
      stiffness = s
      memory = b
   end subroutine resolve_modes

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

      real(wp), dimension(width) :: u, lambda, from_u, from_q
      real(wp) :: a, d, lag(pairs)
      integer :: m, k

      u = hertz(indentation)
      lambda = scale*map%eigenvalue
      from_u = at_end(apply(map%left, u))
      from_q = at_end(map%left_one)
      do k = 1, size(q)
         associate (rate => kernel%rates(k))
            do m = 1, pairs
               a = 1.0_wp + rate*lambda(m)
               d = rate*lambda(pairs + m)
               lag(m) = ((from_u(m) - q(k)*from_q(m))*a &
                  - (from_u(pairs + m) - q(k)*from_q(pairs + m))*d)/(a*a - map%square(m)*(d*d))
            end do
         end associate
         q(k) = u(rule%stages) - ((lag(1) + lag(2)) + (lag(3) + lag(4)))
      end do

   contains

      !> What the numbers x of the pairs add to the last stage, by products with a + d j: the share
      !> of a, and that of d
      pure function at_end(x) result(share)
         !> Numbers of the pairs
         real(wp), intent(in) :: x(width)
         !> The shares, all of a first
         real(wp) :: share(width)

         associate (last => map%right(rule%stages, :))
            share(:pairs) = last(:pairs)*x(:pairs) + last(pairs + 1:)*x(pairs + 1:)
            share(pairs + 1:) = map%square*last(:pairs)*x(pairs + 1:) + last(pairs + 1:)*x(:pairs)
         end associate
      end function at_end
   end subroutine advance_modes

end module vcor_solver_modes
