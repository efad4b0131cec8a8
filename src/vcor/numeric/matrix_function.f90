!> Functions of the integration matrix of a collocation panel, B = V diag(lambda) V^-1, with all of
!> its eigenvalues: one of them is zero where the map of the panel stands still at its end
module vcor_numeric_matrix_function
   use vcor_error, only : error_internal, error_t, raise
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : width
   use vcor_numeric_lapack, only : dgeev, zgesv
   implicit none
   private

   public :: spectral_t, new_spectral

   !> A matrix by its eigenvalues and eigenvectors; what is beyond its size is zero
   type :: spectral_t
      !> Eigenvalues: real parts
      real(wp) :: re(width) = 0.0_wp
      !> Eigenvalues: imaginary parts
      real(wp) :: im(width) = 0.0_wp
      !> V: real parts
      real(wp) :: right_re(width, width) = 0.0_wp
      !> V: imaginary parts
      real(wp) :: right_im(width, width) = 0.0_wp
      !> V^-1: real parts
      real(wp) :: left_re(width, width) = 0.0_wp
      !> V^-1: imaginary parts
      real(wp) :: left_im(width, width) = 0.0_wp
      !> V^-1 applied to ones: real parts
      real(wp) :: one_re(width) = 0.0_wp
      !> V^-1 applied to ones: imaginary parts
      real(wp) :: one_im(width) = 0.0_wp
   contains
      !> Components of a vector along the eigenvectors
      procedure :: components
      !> Vector of given components
      procedure :: vector
      !> The matrix f(B)
      procedure :: function_of
   end type spectral_t

contains

   !> Find eigenvalues and eigenvectors
   subroutine new_spectral(self, matrix, error)
      !> The result
      type(spectral_t), intent(out) :: self
      !> The matrix, shape (n, n), n <= width
      real(wp), intent(in) :: matrix(:, :)
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: b(size(matrix, 1), size(matrix, 1)), vr(size(matrix, 1), size(matrix, 1))
      real(wp) :: wr(size(matrix, 1)), wi(size(matrix, 1)), vl(1, 1), work(8*size(matrix, 1))
      complex(wp) :: v(size(matrix, 1), size(matrix, 1)), inverse(size(matrix, 1), size(matrix, 1))
      integer :: pivot(size(matrix, 1)), n, j, info

      n = size(matrix, 1)
      b = matrix
      call dgeev('N', 'V', n, b, n, wr, wi, vl, 1, vr, n, work, size(work), info)
      if (info == 0) then
         inverse = (0.0_wp, 0.0_wp)
         do j = 1, n
            inverse(j, j) = (1.0_wp, 0.0_wp)
            if (wi(j) > 0.0_wp) then
               v(:, j) = cmplx(vr(:, j), vr(:, j + 1), wp)
            else if (wi(j) < 0.0_wp) then
               v(:, j) = conjg(v(:, j - 1))
            else
               v(:, j) = cmplx(vr(:, j), 0.0_wp, wp)
            end if
         end do
         self%re(1:n) = wr
         self%im(1:n) = wi
         self%right_re(1:n, 1:n) = real(v, wp)
         self%right_im(1:n, 1:n) = aimag(v)
         call zgesv(n, n, v, n, pivot, inverse, n, info)
      end if
      if (info /= 0) then
         call raise(error, error_internal, &
            'collocation: the integration matrix has no eigenvectors')
         return
      end if
      self%left_re(1:n, 1:n) = real(inverse, wp)
      self%left_im(1:n, 1:n) = aimag(inverse)
      self%one_re = sum(self%left_re, 2)
      self%one_im = sum(self%left_im, 2)
   end subroutine new_spectral

   !> Components of a vector along the eigenvectors
   pure subroutine components(self, x, re, im)
      !> The matrix
      class(spectral_t), intent(in) :: self
      !> Vector
      real(wp), intent(in) :: x(width)
      !> Components: real parts
      real(wp), intent(out) :: re(width)
      !> Components: imaginary parts
      real(wp), intent(out) :: im(width)

      integer :: i, j

      re = 0.0_wp
      im = 0.0_wp
      do j = 1, width
         do i = 1, width
            re(i) = re(i) + self%left_re(i, j)*x(j)
            im(i) = im(i) + self%left_im(i, j)*x(j)
         end do
      end do
   end subroutine components

   !> Vector of given components, conjugate in pairs
   pure function vector(self, re, im) result(x)
      !> The matrix
      class(spectral_t), intent(in) :: self
      !> Components: real parts
      real(wp), intent(in) :: re(width)
      !> Components: imaginary parts
      real(wp), intent(in) :: im(width)
      !> Vector
      real(wp) :: x(width)

      integer :: i, j

      x = 0.0_wp
      do j = 1, width
         do i = 1, width
            x(i) = x(i) + self%right_re(i, j)*re(j) - self%right_im(i, j)*im(j)
         end do
      end do
   end function vector

   !> The matrix f(B) = V diag(f) V^-1
   pure function function_of(self, re, im) result(matrix)
      !> The matrix
      class(spectral_t), intent(in) :: self
      !> Values of the function at the eigenvalues: real parts
      real(wp), intent(in) :: re(width)
      !> Values: imaginary parts
      real(wp), intent(in) :: im(width)
      !> f(B)
      real(wp) :: matrix(width, width)

      integer :: j

      do j = 1, width
         matrix(:, j) = self%vector(re*self%left_re(:, j) - im*self%left_im(:, j), &
            re*self%left_im(:, j) + im*self%left_re(:, j))
      end do
   end function function_of

end module vcor_numeric_matrix_function
