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
   use vcor_numeric_pairs, only : constant, ratio, times
   implicit none
   private

   public :: start_t, resolve_modes, resolve_plate, advance_modes, sum_modes, lags_at_end

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
      !> Deflection U of a frozen plate, or the part that a hereditary plate's memory has in it [m]
      real(wp) :: deflection = 0.0_wp
      !> What the velocity of the plate falls behind alpha F, frozen or hereditary [m/s]
      real(wp) :: drift = 0.0_wp
      !> Internal variables q_k [m^1.5], shape (modes)
      real(wp), allocatable :: q(:)
      !> Memory P_j of a hereditary plate [N s], P_j' = F - l_j P_j, shape (modes of the plate)
      real(wp), allocatable :: p(:)
      !> Weights w_j and rates l_j of that memory, without alpha; of no length without one
      type(exponential_sum_t) :: plate
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

   !> What the memory of a hereditary plate makes of the impulse H F in the panel and of its own
   !> past, as functions of the eigenvalues of H: the velocity is R H F + c 1 with
   !> R = sum_j w_j (1 + l_j H)^-1
   pure subroutine resolve_plate(start, map, lambda, response, past)
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Eigenvalues of H [s]
      real(wp), intent(in) :: lambda(width)
      !> R [m/(N s2)]
      real(wp), intent(out) :: response(width)
      !> c, the vector of ones in it [m/s]
      real(wp), intent(out) :: past(width)

      real(wp) :: a, d, share
      integer :: k, m

      response = 0.0_wp
      past = 0.0_wp
      do k = 1, size(start%p)
         do m = 1, pairs
            a = 1.0_wp + start%plate%rates(k)*lambda(m)
            d = start%plate%rates(k)*lambda(pairs + m)
            share = start%plate%moduli(k)/(a*a - map%square(m)*(d*d))
            a = a*share
            d = d*share
            response(m) = response(m) + a
            response(pairs + m) = response(pairs + m) - d
            past(m) = past(m) + a*start%p(k)
            past(pairs + m) = past(pairs + m) - d*start%p(k)
         end do
      end do
      past = times(map%square, past, map%left_one)
   end subroutine resolve_plate

   !> Internal variables at the end of a panel: q = u - (1 + l H)^-1 (u - q_n) at the last stage
   pure subroutine advance_modes(rule, map, scale, kernel, u, q)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> What they follow, at the stages: u [m^1.5]
      real(wp), intent(in) :: u(width)
      !> Internal variables: at the start on entry, at the end on return [m^1.5], shape (modes)
      real(wp), intent(inout) :: q(:)

      real(wp), dimension(width) :: lambda, from_u, from_q
      real(wp) :: a, d, lag(pairs)
      integer :: m, k

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

   !> Sum of G_k/(1 + l_k H) as a function of the eigenvalues, and the vector sum of
   !> G_k q_k (1 + l_k H)^-1 1
   pure subroutine sum_modes(moduli, rates, q, map, scale, share, vector)
      !> G_k, shape (modes)
      real(wp), intent(in) :: moduli(:)
      !> l_k [1/s], shape (modes)
      real(wp), intent(in) :: rates(:)
      !> Values q_k at the start of the panel, shape (modes)
      real(wp), intent(in) :: q(:)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The function
      real(wp), intent(out) :: share(width)
      !> The vector
      real(wp), intent(out) :: vector(width)

      real(wp), dimension(width) :: one, lambda, with_q
      integer :: k

      lambda = scale*map%eigenvalue
      share = 0.0_wp
      with_q = 0.0_wp
      do k = 1, size(q)
         one = moduli(k)*ratio(map%square, constant(1.0_wp), &
            constant(1.0_wp) + rates(k)*lambda)
         share = share + one
         with_q = with_q + q(k)*one
      end do
      vector = apply(map%right, times(map%square, with_q, map%left_one))
   end subroutine sum_modes

   !> Sum of G_k (1 + l_k H)^-1 (x - q_k) at the end of a panel whose map stands still there. What
   !> collocation at the end says about modes that have settled is lost in that; they are
   !> extrapolated from the other points
   pure function lags_at_end(rule, map, scale, terms, q, x) result(total)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> G_k and l_k
      type(exponential_sum_t), intent(in) :: terms
      !> q_k at the start of the panel, shape (modes)
      real(wp), intent(in) :: q(:)
      !> x at the start and at the stages
      real(wp), intent(in) :: x(0:width)
      !> Sum
      real(wp) :: total

      ! product of rate and length from which a mode counts as settled
      real(wp), parameter :: settled = 30.0_wp
      real(wp) :: part(width)
      logical :: chosen(size(q))

      chosen = terms%rates*scale > settled
      part = lags(.not. chosen)
      total = part(rule%stages)
      if (.not. any(chosen)) return
      part = lags(chosen)
      total = total + rule%end_weight(0)*sum(terms%moduli*(x(0) - q), mask=chosen) &
         + sum(rule%end_weight(1:rule%stages - 1)*part(1:rule%stages - 1))

   contains

      !> The sum over some modes at the stages
      pure function lags(mask) result(part)
         !> The modes, shape (modes)
         logical, intent(in) :: mask(:)
         !> The sum
         real(wp) :: part(width)

         real(wp) :: f(width), with_q(width)

         call sum_modes(pack(terms%moduli, mask), pack(terms%rates, mask), pack(q, mask), map, &
            scale, f, with_q)
         part = apply(map%right, times(map%square, f, apply(map%left, x(1:)))) - with_q
      end function lags
   end function lags_at_end

end module vcor_solver_modes
