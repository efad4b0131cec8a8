!> Explicit interfaces to the LAPACK routines that vcor uses
module vcor_numeric_lapack
   use vcor_kinds, only : wp
   implicit none
   private

   public :: dgeev, dgelsy, dgesv

   interface
      !> Eigenvalues and eigenvectors of a general real matrix
      subroutine dgeev(jobvl, jobvr, n, a, lda, wr, wi, vl, ldvl, vr, ldvr, work, lwork, info)
         import :: wp
         !> 'N': no left eigenvectors, 'V': compute them
         character(len=1), intent(in) :: jobvl
         !> 'N': no right eigenvectors, 'V': compute them
         character(len=1), intent(in) :: jobvr
         !> Order of the matrix
         integer, intent(in) :: n
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> The matrix, destroyed on return, shape (lda, n)
         real(wp), intent(inout) :: a(lda, *)
         !> Real parts of the eigenvalues, shape (n)
         real(wp), intent(out) :: wr(*)
         !> Imaginary parts of the eigenvalues, pairs with the positive one first, shape (n)
         real(wp), intent(out) :: wi(*)
         !> Leading dimension of `vl`
         integer, intent(in) :: ldvl
         !> Left eigenvectors, shape (ldvl, n)
         real(wp), intent(out) :: vl(ldvl, *)
         !> Leading dimension of `vr`
         integer, intent(in) :: ldvr
         !> Right eigenvectors; a pair's real and imaginary parts side by side, shape (ldvr, n)
         real(wp), intent(out) :: vr(ldvr, *)
         !> Work space, shape (lwork)
         real(wp), intent(out) :: work(*)
         !> Length of the work space
         integer, intent(in) :: lwork
         !> 0 on success
         integer, intent(out) :: info
      end subroutine dgeev

      !> Least squares by a complete orthogonal factorisation, of least norm where columns depend on
      !> each other
      pure subroutine dgelsy(m, n, nrhs, a, lda, b, ldb, jpvt, rcond, rank, work, lwork, info)
         import :: wp
         !> Number of equations
         integer, intent(in) :: m
         !> Number of unknowns
         integer, intent(in) :: n
         !> Number of right-hand sides
         integer, intent(in) :: nrhs
         !> Leading dimension of `a`
         integer, intent(in) :: lda
         !> The matrix, destroyed on return, shape (lda, n)
         real(wp), intent(inout) :: a(lda, *)
         !> Leading dimension of `b`, >= max(m, n)
         integer, intent(in) :: ldb
         !> Right-hand sides, on return the solutions, shape (ldb, nrhs)
         real(wp), intent(inout) :: b(ldb, *)
         !> On entry 0 for columns that may be interchanged, shape (n)
         integer, intent(inout) :: jpvt(*)
         !> Inverse condition beyond which columns count as dependent
         real(wp), intent(in) :: rcond
         !> Rank found
         integer, intent(out) :: rank
         !> Work space, shape (lwork)
         real(wp), intent(out) :: work(*)
         !> Length of the work space
         integer, intent(in) :: lwork
         !> 0 on success
         integer, intent(out) :: info
      end subroutine dgelsy

      !> Solve a general real system of linear equations
      subroutine dgesv(n, nrhs, a, lda, ipiv, b, ldb, info)
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
   end interface

end module vcor_numeric_lapack
