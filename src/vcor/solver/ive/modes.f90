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
      !> Deflection of the plate that follows the force at once [m/N]
      real(wp) :: instant = 0.0_wp
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
      if (allocated(terms%pair_rates)) call find_pair_response(terms, p, square, lambda, r, c)
      response = r
      past = times(square, c, map%left_one)
   end subroutine find_response

   !> The same for conjugate pairs: 1/(1 + l H) is (1 + conjg(l) H)/n, n = 1 + 2 Re l H + |l|^2 H^2,
   !> so the real part of w/(1 + l H) is (Re w + Re(w conjg(l)) H)/n
   pure subroutine find_pair_response(terms, p, square, lambda, r, c)
      !> The sum
      type(exponential_sum_t), intent(in) :: terms
      !> Lags, those of the pairs last, real and imaginary part
      real(wp), intent(in) :: p(:)
      !> j^2
      real(wp), intent(in) :: square(pairs)
      !> Eigenvalues of H [s]
      real(wp), intent(in) :: lambda(width)
      !> Sums, to which the pairs are added
      real(wp), intent(inout) :: r(width), c(width)

      real(wp), dimension(width) :: squared, inverse, product
      complex(wp) :: past
      integer :: k, n

      squared = times(square, lambda, lambda)
      n = size(terms%rates) + 1
      do k = 1, size(terms%pair_rates)
         associate (l => terms%pair_rates(k), w => terms%pair_moduli(k))
            call invert_pair(l, square, lambda, squared, inverse, product)
            past = w*cmplx(p(n), p(n + 1), wp)
            r = r + real(w, wp)*inverse + real(w*conjg(l), wp)*product
            c = c + real(past, wp)*inverse + real(past*conjg(l), wp)*product
         end associate
         n = n + 2
      end do
   end subroutine find_pair_response

   !> 1/n and H/n
   pure subroutine invert_pair(rate, square, lambda, squared, inverse, product)
      !> l [1/s]
      complex(wp), intent(in) :: rate
      !> j^2
      real(wp), intent(in) :: square(pairs)
      !> Eigenvalues of H [s], and their squares
      real(wp), intent(in) :: lambda(width), squared(width)
      !> 1/n
      real(wp), intent(out) :: inverse(width)
      !> H/n [s]
      real(wp), intent(out) :: product(width)

      real(wp) :: double, size, a, d, norm
      integer :: m

      double = 2.0_wp*real(rate, wp)
      size = real(rate, wp)**2 + aimag(rate)**2
      do m = 1, pairs
         a = 1.0_wp + double*lambda(m) + size*squared(m)
         d = double*lambda(pairs + m) + size*squared(pairs + m)
         norm = 1.0_wp/(a*a - square(m)*(d*d))
         a = a*norm
         d = -d*norm
         inverse(m) = a
         inverse(pairs + m) = d
         product(m) = lambda(m)*a + square(m)*lambda(pairs + m)*d
         product(pairs + m) = lambda(m)*d + lambda(pairs + m)*a
      end do
   end subroutine invert_pair

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
      if (allocated(terms%pair_rates)) call advance_pairs(map, lambda, terms, from_x, from_p, p)

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

   !> The same for conjugate pairs, whose lags are complex
   pure subroutine advance_pairs(map, lambda, terms, from_x, from_p, p)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Eigenvalues of H [s]
      real(wp), intent(in) :: lambda(width)
      !> Sum with the rates l
      type(exponential_sum_t), intent(in) :: terms
      !> Coefficients of x and of 1 in the last stage
      real(wp), intent(in) :: from_x(width), from_p(width)
      !> Lags, those of the pairs last, real and imaginary part
      real(wp), intent(inout) :: p(:)

      real(wp), dimension(width) :: squared, inverse, product
      complex(wp) :: value
      integer :: k, n

      squared = times(map%square, lambda, lambda)
      n = size(terms%rates) + 1
      do k = 1, size(terms%pair_rates)
         associate (l => terms%pair_rates(k))
            call invert_pair(l, map%square, lambda, squared, inverse, product)
            value = sum(from_x*inverse) + conjg(l)*sum(from_x*product) + cmplx(p(n), p(n + 1), wp) &
               *(sum(from_p*inverse) + conjg(l)*sum(from_p*product))
            p(n:n + 1) = [real(value, wp), aimag(value)]
         end associate
         n = n + 2
      end do
   end subroutine advance_pairs

end module vcor_solver_ive_modes
