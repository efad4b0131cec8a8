!> Nonlinear least squares with bounds, and the covariance of the solution
!>
!> The iteration is MINPACK's (Levenberg and Marquardt): J. J. More, B. S. Garbow, K. E. Hillstrom,
!> "User Guide for MINPACK-1", Argonne National Laboratory report ANL-80-74 (1980). MINPACK has no
!> bounds, so it iterates on angles y with x = l + (u - l) (1 + sin y)/2, as in F. James and M.
!> Roos, Comput. Phys. Commun. 10 (1975) 343. An iteration that reaches a bound can leave it again.
module vcor_numeric_least_squares
   use vcor_kinds, only : wp
   use vcor_numeric_lapack, only : dgesvd
   implicit none
   private

   public :: least_squares_t, minimise, covariance

   !> Residuals as functions of n unknowns with bounds
   type, abstract :: least_squares_t
      !> Smallest values of the unknowns, shape (n)
      real(wp), allocatable :: lower(:)
      !> Largest values of the unknowns, shape (n)
      real(wp), allocatable :: upper(:)
   contains
      !> Residuals
      procedure(residuals_i), deferred :: residuals
      !> Derivatives of the residuals
      procedure(jacobian_i), deferred :: jacobian
   end type least_squares_t

   abstract interface
      !> Residuals
      subroutine residuals_i(self, x, r)
         import :: least_squares_t, wp
         class(least_squares_t), intent(in) :: self
         !> Unknowns within their bounds, shape (n)
         real(wp), intent(in) :: x(:)
         !> Residuals, shape (m)
         real(wp), intent(out) :: r(:)
      end subroutine residuals_i

      !> Derivatives of the residuals
      subroutine jacobian_i(self, x, j)
         import :: least_squares_t, wp
         class(least_squares_t), intent(in) :: self
         !> Unknowns within their bounds, shape (n)
         real(wp), intent(in) :: x(:)
         !> Derivatives, shape (m, n)
         real(wp), intent(out) :: j(:, :)
      end subroutine jacobian_i
   end interface

   abstract interface
      !> Residuals or their derivatives, as `lmder` calls them
      subroutine lmder_function_i(m, n, x, fvec, fjac, ldfjac, iflag)
         import :: wp
         !> Number of residuals
         integer, intent(in) :: m
         !> Number of unknowns
         integer, intent(in) :: n
         !> Unknowns, shape (n)
         real(wp), intent(in) :: x(n)
         !> Residuals, set if iflag = 1, shape (m)
         real(wp), intent(inout) :: fvec(m)
         !> Leading dimension of `fjac`
         integer, intent(in) :: ldfjac
         !> Derivatives, set if iflag = 2, shape (ldfjac, n)
         real(wp), intent(inout) :: fjac(ldfjac, n)
         !> Residuals (1) or derivatives (2); negative on return ends the iteration
         integer, intent(inout) :: iflag
      end subroutine lmder_function_i
   end interface

   interface
      !> Least squares by the method of Levenberg and Marquardt, with derivatives
      subroutine lmder(fcn, m, n, x, fvec, fjac, ldfjac, ftol, xtol, gtol, maxfev, diag, mode, &
                       factor, nprint, info, nfev, njev, ipvt, qtf, wa1, wa2, wa3, wa4)
         import :: lmder_function_i, wp
         !> Residuals and derivatives
         procedure(lmder_function_i) :: fcn
         !> Number of residuals
         integer, intent(in) :: m
         !> Number of unknowns, <= m
         integer, intent(in) :: n
         !> Unknowns, on entry an initial guess, on return the solution, shape (n)
         real(wp), intent(inout) :: x(n)
         !> Residuals at the solution, shape (m)
         real(wp), intent(out) :: fvec(m)
         !> Leading dimension of `fjac`, >= m
         integer, intent(in) :: ldfjac
         !> Upper triangle: R of the derivatives with pivoted columns, shape (ldfjac, n)
         real(wp), intent(out) :: fjac(ldfjac, n)
         !> Relative reduction of the sum of squares at which the iteration ends
         real(wp), intent(in) :: ftol
         !> Relative change of the unknowns at which the iteration ends
         real(wp), intent(in) :: xtol
         !> Cosine between residuals and any column of the derivatives at which the iteration ends
         real(wp), intent(in) :: gtol
         !> Maximum evaluations of the residuals
         integer, intent(in) :: maxfev
         !> Scales of the unknowns, set if mode = 1, shape (n)
         real(wp), intent(inout) :: diag(n)
         !> Scales from the derivatives (1) or as given (2)
         integer, intent(in) :: mode
         !> Bound of the first step, in scaled unknowns
         real(wp), intent(in) :: factor
         !> With 0, `fcn` is not called between the iterations
         integer, intent(in) :: nprint
         !> Wrong arguments (0), a tolerance met (1 to 4), too many evaluations (5), a tolerance
         !> below rounding (6 to 8), or ended by `fcn` (negative)
         integer, intent(out) :: info
         !> Number of evaluations of the residuals
         integer, intent(out) :: nfev
         !> Number of evaluations of the derivatives
         integer, intent(out) :: njev
         !> Order of the pivoted columns, shape (n)
         integer, intent(out) :: ipvt(n)
         !> First n elements of Q' r, shape (n)
         real(wp), intent(out) :: qtf(n)
         !> Work space
         real(wp), intent(out) :: wa1(n), wa2(n), wa3(n), wa4(m)
      end subroutine lmder
   end interface

   !> The problem that MINPACK solves, one per thread: MINPACK passes no data on to the function
   !> that it calls
   class(least_squares_t), pointer :: current => null()
!$omp threadprivate(current)

contains

   !> Minimise the sum of squares
   subroutine minimise(problem, x, r, converged, tolerance, most)
      class(least_squares_t), intent(in), target :: problem
      !> Unknowns, on entry an initial guess, on return the solution within its bounds, shape (n)
      real(wp), intent(inout) :: x(:)
      !> Residuals at the solution, shape (m), m >= n
      real(wp), intent(out) :: r(:)
      !> Whether the iteration converged; false if it gave up
      logical, intent(out) :: converged
      !> Relative change of the sum of squares and of the unknowns at which the iteration ends; 0:
      !> as small as rounding allows
      real(wp), intent(in) :: tolerance
      !> Maximum evaluations of the residuals
      integer, intent(in) :: most

      real(wp), parameter :: first_step = 10.0_wp
      real(wp) :: j(size(r), size(x)), tol
      real(wp), dimension(size(x)) :: y, scales, qtf, wa1, wa2, wa3
      real(wp) :: wa4(size(r))
      integer :: order(size(x)), info, nfev, njev

      converged = .true.
      if (size(x) > 0) then
         tol = max(tolerance, 4.0_wp*epsilon(1.0_wp))
         y = angles_of(problem, x)
         current => problem
         call lmder(evaluate, size(r), size(x), y, r, j, size(r), tol, tol, 0.0_wp, most, scales, &
            1, first_step, 0, info, nfev, njev, order, qtf, wa1, wa2, wa3, wa4)
         nullify (current)
         converged = info >= 1 .and. info /= 5
         x = unknowns_of(problem, y)
      end if
      call problem%residuals(x, r)
   end subroutine minimise

   !> Unknowns from angles
   pure function unknowns_of(problem, y) result(x)
      class(least_squares_t), intent(in) :: problem
      !> Angles, shape (n)
      real(wp), intent(in) :: y(:)
      !> Unknowns within their bounds, shape (n)
      real(wp) :: x(size(y))

      x = problem%lower + (problem%upper - problem%lower)*0.5_wp*(1.0_wp + sin(y))
   end function unknowns_of

   !> Angles from unknowns; an unknown at or beyond a bound starts a little within it
   pure function angles_of(problem, x) result(y)
      class(least_squares_t), intent(in) :: problem
      !> Unknowns, shape (n)
      real(wp), intent(in) :: x(:)
      !> Angles, shape (n)
      real(wp) :: y(size(x))

      !> Largest sine of an angle: at a bound itself the derivative by the angle is zero
      real(wp), parameter :: most = 0.99_wp

      y = asin(max(-most, min(most, &
         2.0_wp*(x - problem%lower)/(problem%upper - problem%lower) - 1.0_wp)))
   end function angles_of

   !> Callback of MINPACK
   subroutine evaluate(m, n, x, fvec, fjac, ldfjac, iflag)
      !> Number of residuals
      integer, intent(in) :: m
      !> Number of unknowns
      integer, intent(in) :: n
      !> Angles
      real(wp), intent(in) :: x(n)
      !> Residuals
      real(wp), intent(inout) :: fvec(m)
      !> Leading dimension
      integer, intent(in) :: ldfjac
      !> Derivatives
      real(wp), intent(inout) :: fjac(ldfjac, n)
      !> Whether to set the residuals (1) or the derivatives (2)
      integer, intent(inout) :: iflag

      real(wp) :: inside(n)
      integer :: i

      inside = unknowns_of(current, x)
      if (iflag == 1) then
         call current%residuals(inside, fvec)
      else
         call current%jacobian(inside, fjac(:m, :))
         do i = 1, n
            fjac(:m, i) = fjac(:m, i)*0.5_wp*(current%upper(i) - current%lower(i))*cos(x(i))
         end do
      end if
   end subroutine evaluate

   !> Inverse of J' J from the singular values of J with its columns scaled to length 1.
   !> Combinations of unknowns that the residuals do not determine get a very large variance; the
   !> others keep theirs
   subroutine covariance(j, inverse, condition)
      !> Derivatives of the residuals, shape (m, n), m >= n
      real(wp), intent(in) :: j(:, :)
      !> The inverse, shape (n, n)
      real(wp), intent(out) :: inverse(:, :)
      !> Largest over smallest singular value; huge where that is 0
      real(wp), intent(out) :: condition

      !> Smallest scaled singular value that derivatives of ten digits can tell from 0, and the
      !> length that replaces that of a zero column
      real(wp), parameter :: least = 1.0e-9_wp, shortest = 1.0e-100_wp
      real(wp) :: scaled(size(j, 1), size(j, 2)), length(size(j, 2)), values(size(j, 2))
      real(wp) :: rows(size(j, 2), size(j, 2)), none(1, 1)
      real(wp) :: work(8*size(j, 1) + 8*size(j, 2))
      integer :: i, k, n, info

      n = size(j, 2)
      condition = 1.0_wp
      if (n == 0) return
      length = max(norm2(j, dim=1), shortest)
      inverse = huge(inverse)
      condition = huge(condition)
      do i = 1, n
         scaled(:, i) = j(:, i)/length(i)
      end do
      call dgesvd('N', 'S', size(j, 1), n, scaled, size(j, 1), values, none, 1, rows, n, work, &
         size(work), info)
      if (info /= 0) return
      if (values(n) > epsilon(1.0_wp)**2) condition = values(1)/values(n)
      values = max(values, least)
      do k = 1, n
         rows(k, :) = rows(k, :)/values(k)
      end do
      do k = 1, n
         do i = 1, n
            inverse(i, k) = dot_product(rows(:, i)/length(i), rows(:, k)/length(k))
         end do
      end do
   end subroutine covariance

end module vcor_numeric_least_squares
