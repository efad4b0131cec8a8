!> Explicit interfaces to the LAPACK routines that vcor uses
module vcor_numeric_lapack
   use vcor_kinds, only : wp
   implicit none
   private

   public :: dgeev, dgeqp3, dgeqrf, dgesv, dgetrs, dorgqr, dpotrf, dtrtrs

   interface
      !> Eigenvalues and eigenvectors of a general real matrix
      subroutine dgeev(jobvl, jobvr, n, a, lda, wr, wi, vl, ldvl, vr, ldvr, work, lwork, info)
         import :: wp
         !> 'N': left eigenvectors are not computed, 'V': they are
         character(len=1), intent(in) :: jobvl
         !> 'N': right eigenvectors are not computed, 'V': they are
         character(len=1), intent(in) :: jobvr
         !> Order of the matrix
         integer, intent(in) :: n
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> The matrix, destroyed on return, shape (lda, n)
         real(wp), intent(inout) :: a(lda, *)
         !> Real parts of the eigenvalues, shape (n)
         real(wp), intent(out) :: wr(*)
         !> Imaginary parts of the eigenvalues, the positive one of a pair first, shape (n)
         real(wp), intent(out) :: wi(*)
         !> Leading dimension of `vl`
         integer, intent(in) :: ldvl
         !> Left eigenvectors, shape (ldvl, n)
         real(wp), intent(out) :: vl(ldvl, *)
         !> Leading dimension of `vr`
         integer, intent(in) :: ldvr
         !> Right eigenvectors, for a pair its real and its imaginary part, shape (ldvr, n)
         real(wp), intent(out) :: vr(ldvr, *)
         !> Work space, shape (lwork)
         real(wp), intent(out) :: work(*)
         !> Length of the work space
         integer, intent(in) :: lwork
         !> 0 on success
         integer, intent(out) :: info
      end subroutine dgeev

      !> QR factorisation with column pivoting, A P = Q R; |R(i, i)| does not increase with i
      pure subroutine dgeqp3(m, n, a, lda, jpvt, tau, work, lwork, info)
         import :: wp
         !> Rows
         integer, intent(in) :: m
         !> Columns
         integer, intent(in) :: n
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> The matrix, on return R in its upper triangle, reflections below, shape (lda, n)
         real(wp), intent(inout) :: a(lda, *)
         !> Nonzero: the column comes first; on return the original number of each, shape (n)
         integer, intent(inout) :: jpvt(*)
         !> Scalars of the reflections of which Q is the product, shape (min(m, n))
         real(wp), intent(out) :: tau(*)
         !> Workspace, shape (lwork)
         real(wp), intent(out) :: work(*)
         !> Size of `work`, at least 3 n + 1
         integer, intent(in) :: lwork
         !> 0 on success
         integer, intent(out) :: info
      end subroutine dgeqp3

      !> QR factorisation of a general real matrix
      pure subroutine dgeqrf(m, n, a, lda, tau, work, lwork, info)
         import :: wp
         !> Number of rows
         integer, intent(in) :: m
         !> Number of columns
         integer, intent(in) :: n
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> The matrix, on return R on and above the diagonal, reflections below, shape (lda, n)
         real(wp), intent(inout) :: a(lda, *)
         !> Scalars of the reflections, shape (min(m, n))
         real(wp), intent(out) :: tau(*)
         !> Work space, shape (lwork)
         real(wp), intent(out) :: work(*)
         !> Length of the work space, >= n
         integer, intent(in) :: lwork
         !> 0 on success
         integer, intent(out) :: info
      end subroutine dgeqrf

      !> Solve a general real system of linear equations
      pure subroutine dgesv(n, nrhs, a, lda, ipiv, b, ldb, info)
         import :: wp
         !> Number of equations
         integer, intent(in) :: n
         !> Number of right-hand sides
         integer, intent(in) :: nrhs
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> The matrix, on return its factors, shape (lda, n)
         real(wp), intent(inout) :: a(lda, *)
         !> Row interchanges, shape (n)
         integer, intent(out) :: ipiv(*)
         !> Leading dimension of `b`
         integer, intent(in) :: ldb
         !> Right-hand sides, on return the solutions, shape (ldb, nrhs)
         real(wp), intent(inout) :: b(ldb, *)
         !> 0 on success
         integer, intent(out) :: info
      end subroutine dgesv

      !> Solve a system with the triangular factors that `dgesv` has left
      pure subroutine dgetrs(trans, n, nrhs, a, lda, ipiv, b, ldb, info)
         import :: wp
         !> 'N': the system itself
         character(len=1), intent(in) :: trans
         !> Order of the matrix
         integer, intent(in) :: n
         !> Number of right sides
         integer, intent(in) :: nrhs
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> The factors, shape (lda, n)
         real(wp), intent(in) :: a(lda, *)
         !> Row exchanges, shape (n)
         integer, intent(in) :: ipiv(*)
         !> Leading dimension of `b`
         integer, intent(in) :: ldb
         !> Right sides, on return the solutions, shape (ldb, nrhs)
         real(wp), intent(inout) :: b(ldb, *)
         !> 0 on success
         integer, intent(out) :: info
      end subroutine dgetrs

      !> The first columns of Q of a QR factorisation
      pure subroutine dorgqr(m, n, k, a, lda, tau, work, lwork, info)
         import :: wp
         !> Rows
         integer, intent(in) :: m
         !> Number of columns wanted, at most m
         integer, intent(in) :: n
         !> Number of reflections, at most n
         integer, intent(in) :: k
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> Reflections as `dgeqp3` or `dgeqrf` leave them; on return the columns, shape (lda, n)
         real(wp), intent(inout) :: a(lda, *)
         !> Scalars of the reflections, shape (k)
         real(wp), intent(in) :: tau(*)
         !> Workspace, shape (lwork)
         real(wp), intent(out) :: work(*)
         !> Size of `work`, at least n
         integer, intent(in) :: lwork
         !> 0 on success
         integer, intent(out) :: info
      end subroutine dorgqr

      !> Cholesky factor of a symmetric positive definite matrix
      pure subroutine dpotrf(uplo, n, a, lda, info)
         import :: wp
         !> 'U': upper, 'L': lower triangle
         character(len=1), intent(in) :: uplo
         !> Order of the matrix
         integer, intent(in) :: n
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> The triangle, on return its factor; the other half is not referenced, shape (lda, n)
         real(wp), intent(inout) :: a(lda, *)
         !> 0 on success, > 0: not positive definite
         integer, intent(out) :: info
      end subroutine dpotrf

      !> Solve a triangular system of linear equations
      pure subroutine dtrtrs(uplo, trans, diag, n, nrhs, a, lda, b, ldb, info)
         import :: wp
         !> 'U': upper, 'L': lower triangle
         character(len=1), intent(in) :: uplo
         !> 'N': A x = b, 'T': A' x = b
         character(len=1), intent(in) :: trans
         !> 'N': the diagonal of `a` is used, 'U': it is taken as ones
         character(len=1), intent(in) :: diag
         !> Order of the matrix
         integer, intent(in) :: n
         !> Number of right-hand sides
         integer, intent(in) :: nrhs
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> The triangle; the other half is not referenced, shape (lda, n)
         real(wp), intent(in) :: a(lda, *)
         !> Leading dimension of `b`
         integer, intent(in) :: ldb
         !> Right-hand sides, on return the solutions, shape (ldb, nrhs)
         real(wp), intent(inout) :: b(ldb, *)
         !> 0 on success, > 0: a zero on the diagonal
         integer, intent(out) :: info
      end subroutine dtrtrs
   end interface

end module vcor_numeric_lapack
