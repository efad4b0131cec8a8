!> Internal variables of a sum of exponentials in a panel, eliminated
!>
!> The lag p_k of a function x, p_k' = x' - l_k p_k, is p = (1 + l_k H)^-1 (x - x_n + p_n) at the
!> stages, with the integration matrix H of the panel. Functions of H are known by its eigenvalues,
!> so a mode costs a few operations for each of them, however stiff it is. A kernel may have a
!> hundred modes: the loops over the eigenvalues are innermost and in real numbers.
module vcor_solver_ive_lags
   use vcor_impact_structure, only : vibration_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_radau_rule, only : map_t, slots
   implicit none
   private

   public :: sums_t, find_response, advance_lags, find_lags

   !> Sums of exponentials in the hereditary integrals of an impact
   type :: sums_t
      !> Kernel of the contact [N/m^1.5]
      type(exponential_sum_t) :: contact
      !> Memory of a hereditary plate: weights w_j and rates l_j, and the viscosity alpha [m/(N s)]
      type(exponential_sum_t) :: plate
      !> Modes of a struck structure, otherwise unallocated
      type(vibration_t), allocatable :: vibration
   end type sums_t

contains

   !> What the modes answer to a function and to their lags at the start of a panel, as functions of
   !> the eigenvalues of H: G_0 + sum_k G_k (1 + l_k H)^-1 and sum_k G_k p_k (1 + l_k H)^-1
   pure subroutine find_response(terms, p, eigenvalue, response, past)
      type(exponential_sum_t), intent(in) :: terms
      !> Lags at the start, shape (modes)
      real(wp), intent(in) :: p(:)
      !> Eigenvalues of H [s]
      complex(wp), intent(in) :: eigenvalue(slots)
      !> Response to the function
      complex(wp), intent(out) :: response(slots)
      !> Response to the lags
      complex(wp), intent(out) :: past(slots)

      real(wp), dimension(slots) :: x, y, r, s, b, c
      real(wp) :: one, d, share
      integer :: k, m

      x = real(eigenvalue, wp)
      y = aimag(eigenvalue)
      r = terms%equilibrium
      s = 0.0_wp
      b = 0.0_wp
      c = 0.0_wp
      do k = 1, size(terms%rates)
         associate (rate => terms%rates(k), modulus => terms%moduli(k), lag => p(k))
            do m = 1, slots
               one = 1.0_wp + rate*x(m)
               d = rate*y(m)
               share = modulus/(one*one + d*d)
               one = one*share
               d = d*share
               r(m) = r(m) + one
               s(m) = s(m) - d
               b(m) = b(m) + one*lag
               c(m) = c(m) - d*lag
            end do
         end associate
      end do
      response = cmplx(r, s, wp)
      past = cmplx(b, c, wp)
   end subroutine find_response

   !> Lags at the end of a panel
   pure subroutine advance_lags(map, duration, terms, x, p)
      type(map_t), intent(in) :: map
      !> Duration of the panel [s]
      real(wp), intent(in) :: duration
      !> Sum with the rates l
      type(exponential_sum_t), intent(in) :: terms
      !> Function at the stages, less its value at the start
      real(wp), intent(in) :: x(:)
      !> Lags, at the start on entry and at the end on return, shape (modes)
      real(wp), intent(inout) :: p(:)

      complex(wp), dimension(slots) :: from_x, from_p
      real(wp), dimension(slots) :: a, b, c, d, re, im, part
      real(wp) :: one, other
      integer :: k, m

      from_x = map%last*map%decompose(x)
      from_p = map%last*map%left_one
      a = real(from_x, wp)
      b = aimag(from_x)
      c = real(from_p, wp)
      d = aimag(from_p)
      re = duration*real(map%eigenvalue, wp)
      im = duration*aimag(map%eigenvalue)
      do k = 1, size(terms%rates)
         do m = 1, slots
            one = 1.0_wp + terms%rates(k)*re(m)
            other = terms%rates(k)*im(m)
            part(m) = ((a(m) + p(k)*c(m))*one + (b(m) + p(k)*d(m))*other)/(one*one + other*other)
         end do
         p(k) = sum(part)
      end do
   end subroutine advance_lags

   !> Lags at all stages of a panel
   pure subroutine find_lags(map, duration, rate, x, start, lag)
      type(map_t), intent(in) :: map
      !> Duration of the panel [s]
      real(wp), intent(in) :: duration
      !> Rate of the mode [1/s]
      real(wp), intent(in) :: rate
      !> Function less its value at the start: coefficients of the eigenvectors
      complex(wp), intent(in) :: x(slots)
      !> Lag at the start
      real(wp), intent(in) :: start
      !> Lags at the stages
      real(wp), intent(out) :: lag(:)

      complex(wp) :: c(slots)
      real(wp) :: one, other, norm
      integer :: m

      do m = 1, slots
         one = 1.0_wp + rate*duration*real(map%eigenvalue(m), wp)
         other = rate*duration*aimag(map%eigenvalue(m))
         norm = 1.0_wp/(one*one + other*other)
         c(m) = (x(m) + start*map%left_one(m))*cmplx(one*norm, -other*norm, wp)
      end do
      lag = map%compose(c)
   end subroutine find_lags

end module vcor_solver_ive_lags
