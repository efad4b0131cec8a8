!> Internal variables of a kernel that is a sum of exponentials: their part in the equations of a
!> panel, and their values at its end
!>
!> With q_k' = l_k (u - q_k) the lags p_k = u - q_k at the stages follow from u there:
!> p = (1 + l_k H)^-1 (u - u_n + p_n), with the integration matrix H of the panel in terms of its
!> eigenvalues. A kernel may have a hundred modes, so the loops over the eigenvalues are innermost:
!> the compiler vectorises them.
module vcor_solver_ive_modes
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_radau_algebra, only : apply, constant, pairs, ratio, times, width
   use vcor_numeric_radau_collocation, only : panel_map_t
   implicit none
   private

   public :: modes_t, find_response, advance_lags

   !> Sums of exponentials in the hereditary integrals of an impact
   type :: modes_t
      !> Kernel of the contact [N/m^1.5]
      type(exponential_sum_t) :: contact
      !> Memory of a hereditary plate: weights w_j and rates l_j, viscosity alpha [m/(N s)];
      !> without terms for other plates
      type(exponential_sum_t) :: plate
   end type modes_t

contains

   !> Response R of the modes to a function in the panel, and c of their lags at its start, as
   !> functions of the eigenvalues of H: R = G_0 + sum_k G_k (1 + l_k H)^-1 and
   !> c 1 = sum_k G_k p_k (1 + l_k H)^-1 1
   pure subroutine find_response(terms, p, map, lambda, response, past)
      type(exponential_sum_t), intent(in) :: terms
      !> Lags p_k at the start of the panel, shape (modes)
      real(wp), intent(in) :: p(:)
      type(panel_map_t), intent(in) :: map
      !> Eigenvalues of H [s]
      real(wp), intent(in) :: lambda(width)
      !> R
      real(wp), intent(out) :: response(width)
      !> c times V^-1 1
      real(wp), intent(out) :: past(width)

      real(wp) :: a, d, share, r(width), c(width), square(pairs)
      logical :: regular(pairs)
      integer :: k, m

      r = constant(terms%equilibrium)
      c = 0.0_wp
      square = map%square
      ! a pair with a zero eigenvalue, at the stationary end of a map, has the norm 1 + 2 l lambda;
      ! the difference of squares would be inf - inf for an immense rate
      regular = abs(lambda(:pairs)**2 - square*lambda(pairs + 1:)**2) > 0.0_wp
      do k = 1, size(terms%rates)
         associate (rate => terms%rates(k), modulus => terms%moduli(k))
            do m = 1, pairs
               a = 1.0_wp + rate*lambda(m)
               d = rate*lambda(pairs + m)
               share = modulus/merge(a*a - square(m)*(d*d), 1.0_wp + 2.0_wp*rate*lambda(m), &
                  regular(m))
               a = a*share
               d = d*share
               r(m) = r(m) + a
               r(pairs + m) = r(pairs + m) - d
               c(m) = c(m) + a*p(k)
               c(pairs + m) = c(pairs + m) - d*p(k)
            end do
         end associate
      end do
      response = r
      past = times(square, c, map%left_one)
   end subroutine find_response

   !> Lags at the end of a panel: with p' = x' - l p, (1 + l H)^-1 (x + p_n) at the last stage,
   !> where x is zero at the start
   pure subroutine advance_lags(map, scale, terms, x, p)
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> Sum with the rates l
      type(exponential_sum_t), intent(in) :: terms
      !> Increment since the start, at the stages
      real(wp), intent(in) :: x(width)
      !> Lags, at the start on entry and at the end on return, shape (modes)
      real(wp), intent(inout) :: p(:)

      real(wp), dimension(width) :: lambda, from_x, from_p
      real(wp) :: a, d, lag(pairs)
      integer :: m, k

      lambda = scale*map%eigenvalue
      from_x = at_end(apply(map%left, x))
      from_p = at_end(map%left_one)
      do k = 1, size(terms%rates)
         associate (rate => terms%rates(k))
            do m = 1, pairs
               a = 1.0_wp + rate*lambda(m)
               d = rate*lambda(pairs + m)
               lag(m) = ((from_x(m) + p(k)*from_p(m))*a &
                  - (from_x(pairs + m) + p(k)*from_p(pairs + m))*d)/(a*a - map%square(m)*(d*d))
            end do
         end associate
         p(k) = (lag(1) + lag(2)) + (lag(3) + lag(4))
      end do

   contains

      !> Contributions of the numbers x of the pairs to the last stage when multiplied by a + d j:
      !> the coefficients of a, then those of d
      pure function at_end(x) result(share)
         !> Numbers of the pairs
         real(wp), intent(in) :: x(width)
         !> The coefficients
         real(wp) :: share(width)

         associate (last => map%last)
            share(:pairs) = last(:pairs)*x(:pairs) + last(pairs + 1:)*x(pairs + 1:)
            share(pairs + 1:) = map%square*last(:pairs)*x(pairs + 1:) + last(pairs + 1:)*x(:pairs)
         end associate
      end function at_end
   end subroutine advance_lags

end module vcor_solver_ive_modes
