!> Explicit interface to the MINPACK routine that vcor uses
!>
!> J. J. More, B. S. Garbow, K. E. Hillstrom, "User Guide for MINPACK-1", Argonne National
!> Laboratory report ANL-80-74 (1980).
module vcor_numeric_minpack
   use vcor_kinds, only : wp
   implicit none
   private

   public :: lmder, lmder_function_i

   abstract interface
      !> What `lmder` calls: residuals or their derivatives
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
         !> Unknowns, on entry a guess, shape (n)
         real(wp), intent(inout) :: x(n)
         !> Residuals at the solution, shape (m)
         real(wp), intent(out) :: fvec(m)
         !> Leading dimension of `fjac`, >= m
         integer, intent(in) :: ldfjac
         !> Its triangle is that of the pivoted derivatives, shape (ldfjac, n)
         real(wp), intent(out) :: fjac(ldfjac, n)
         !> Reduction of the sum of squares that counts as none, relative
         real(wp), intent(in) :: ftol
         !> Change of the unknowns that counts as none, relative
         real(wp), intent(in) :: xtol
         !> Cosine between residuals and a column of the derivatives that counts as none
         real(wp), intent(in) :: gtol
         !> Most evaluations of the residuals
         integer, intent(in) :: maxfev
         !> Scales of the unknowns, set if mode = 1, shape (n)
         real(wp), intent(inout) :: diag(n)
         !> Scales from the derivatives (1), or given (2)
         integer, intent(in) :: mode
         !> Bound of the first step, in scaled unknowns
         real(wp), intent(in) :: factor
         !> 0: nothing is called between the iterations
         integer, intent(in) :: nprint
         !> 0 wrong arguments, 1 to 4 a tolerance is met, 5 too many evaluations, 6 to 8 a tolerance
         !> is below what rounding allows; negative: ended by the function
         integer, intent(out) :: info
         !> Evaluations of the residuals
         integer, intent(out) :: nfev
         !> Evaluations of the derivatives
         integer, intent(out) :: njev
         !> Order of the columns, shape (n)
         integer, intent(out) :: ipvt(n)
         !> Residuals in the basis of the columns, shape (n)
         real(wp), intent(out) :: qtf(n)
         !> Work space, shape (n)
         real(wp), intent(out) :: wa1(n)
         !> Work space, shape (n)
         real(wp), intent(out) :: wa2(n)
         !> Work space, shape (n)
         real(wp), intent(out) :: wa3(n)
         !> Work space, shape (m)
         real(wp), intent(out) :: wa4(m)
      end subroutine lmder
   end interface

end module vcor_numeric_minpack
