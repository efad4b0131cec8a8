!> Non-negative least squares: minimise |A x - b| with x >= 0
!>
!> The active-set method of C. L. Lawson and R. J. Hanson, "Solving Least Squares Problems" (1974),
!> chapter 23, on LAPACK's QR factorisation.
!> All columns of A, in use (x > 0) or not, and b are kept multiplied by one orthogonal matrix that
!> makes the columns in use triangular. When a column enters or leaves, only those after it are
!> factorised again, and the gradient of an unused column is one scalar product. Normal equations,
!> which would halve the digits, are not formed.
!>
!> The iteration ends for any columns: a column is not taken in if it depends linearly on those in
!> use, or if rounding makes its coefficient negative; the residual must fall from one feasible
!> solution to the next; and the number of changes is limited.
module vcor_numeric_nnls
   use vcor_kinds, only : wp
   use vcor_numeric_lapack, only : dgeqrf, dtrtrs
   implicit none
   private

   public :: solve_nnls

   !> Part of a column's length orthogonal to those in use below which it counts as dependent: a
   !> hundred times more or less changes none of 30 impacts with tables of data
   real(wp), parameter :: independent = 1.0e-11_wp
   !> Gradient, over |b| and for columns of length 1, that is rounding: with 1e-12 ten of these
   !> impacts change, by up to 1.8 stated errors, with 1e-16 two, by up to half of one
   real(wp), parameter :: rounding = 1.0e-14_wp

contains

   !> Solve min |A x - b|, x >= 0
   pure subroutine solve_nnls(a, b, x, start)
      !> Matrix A, finite, shape (m, n)
      real(wp), intent(in) :: a(:, :)
      !> Right-hand side, finite, shape (m)
      real(wp), intent(in) :: b(:)
      !> Solution, shape (n); exactly 0 where the bound is active
      real(wp), intent(out) :: x(:)
      !> Columns that are probably in use, a guess that saves time; shape (n)
      logical, intent(in), optional :: start(:)

      ! `q`: columns of length 1, then b, all times the orthogonal matrix; `set`: columns in use;
      ! `blocked`: columns not to be taken in
      real(wp) :: q(size(b), size(x) + 1), length(size(x)), z(size(x))
      integer, allocatable :: set(:)
      logical :: blocked(size(x))
      real(wp) :: residual, before
      integer :: j, trial

      length = norm2(a, dim=1)
      where (.not. length > 0.0_wp) length = 1.0_wp
      q(:, :size(x)) = a/spread(length, 1, size(b))
      q(:, size(x) + 1) = b
      x = 0.0_wp
      allocate (set(0))
      if (present(start)) then
         do j = 1, size(x)
            if (start(j)) call take_in(q, set, j)
         end do
         z = solution(q, set)
         call make_feasible(q, set, x, z)
      end if
      residual = norm2(q(size(set) + 1:, size(x) + 1))

      blocked = .false.
      do trial = 1, 10*size(x)
         blocked(set) = .true.
         j = steepest(q, size(set), blocked, rounding*norm2(b))
         if (j == 0) exit
         blocked(j) = .true.
         call take_in(q, set, j)
         z = solution(q, set)
         if (.not. z(j) > 0.0_wp) then
            set = pack(set, set /= j)
            cycle
         end if
         call make_feasible(q, set, x, z)
         before = residual
         residual = norm2(q(size(set) + 1:, size(x) + 1))
         if (.not. residual < before) exit
         blocked = .false.
      end do
      x = x/length
   end subroutine solve_nnls

   !> Unused column with the steepest descent
   pure function steepest(q, count, blocked, least) result(column)
      !> The columns, shape (m, n + 1)
      real(wp), intent(in) :: q(:, :)
      !> Number of columns in use
      integer, intent(in) :: count
      !> Columns that must not be taken in, shape (n)
      logical, intent(in) :: blocked(:)
      !> Smallest descent that counts
      real(wp), intent(in) :: least
      !> Column; 0 if the residual falls along none
      integer :: column

      real(wp) :: descent(size(blocked))

      descent = matmul(q(count + 1:, size(q, 2)), q(count + 1:, :size(blocked)))
      column = maxloc(descent, dim=1, mask=descent > least .and. .not. blocked)
   end function steepest

   !> Take a column in, unless it depends linearly on those in use
   pure subroutine take_in(q, set, column)
      !> The columns, shape (m, n + 1)
      real(wp), intent(inout) :: q(:, :)
      !> Numbers of the columns in use
      integer, allocatable, intent(inout) :: set(:)
      !> Number of the column
      integer, intent(in) :: column

      if (size(set) == size(q, 1)) return
      set = [set, column]
      call make_triangular(q, set, size(set), size(q, 1))
      if (.not. abs(q(size(set), column)) > independent) set = set(:size(set) - 1)
   end subroutine take_in

   !> Make the columns in use triangular from a given one on, by QR of their lower rows
   pure subroutine make_triangular(q, set, first, last)
      !> The columns, shape (m, n + 1)
      real(wp), intent(inout) :: q(:, :)
      !> Numbers of the columns in use
      integer, intent(in) :: set(:)
      !> Place in `set` of the first column that is not yet triangular
      integer, intent(in) :: first
      !> Last row that is not zero in these columns
      integer, intent(in) :: last

      real(wp) :: used(first:last, first:size(set)), factors(size(set)), work(size(q, 2))
      integer :: info

      used = q(first:last, set(first:))
      associate (m => size(used, 1), n => size(used, 2))
         call dgeqrf(m, n, used, m, factors, work, size(work), info)
         call reflect(used, factors(:min(m, n)), q(first:last, :))
      end associate
   end subroutine make_triangular

   !> Multiply columns by the reflections of a QR factorisation
   !>
   !> As LAPACK's dormqr, which passes through all columns twice for each reflection: here those of
   !> a group stay in the cache. The sums of four columns side by side do not wait for each other
   pure subroutine reflect(vectors, factors, columns)
      !> Vectors of the reflections below the diagonal, with 1 on it, as dgeqrf leaves them;
      !> shape (m, k)
      real(wp), intent(in) :: vectors(:, :)
      !> Factors of the reflections, shape (min(m, k))
      real(wp), intent(in) :: factors(:)
      !> The columns, shape (m, n)
      real(wp), intent(inout) :: columns(:, :)

      integer, parameter :: group = 4
      real(wp) :: some(size(columns, 1), group), product(group)
      integer :: i, j, k, width

      some = 0.0_wp
      do j = 1, size(columns, 2), group
         width = min(group, size(columns, 2) - j + 1)
         some(:, :width) = columns(:, j:j + width - 1)
         do k = 1, size(factors)
            product = some(k, :)
            do i = k + 1, size(some, 1)
               product = product + vectors(i, k)*some(i, :)
            end do
            product = factors(k)*product
            some(k, :) = some(k, :) - product
            do i = 1, group
               some(k + 1:, i) = some(k + 1:, i) - product(i)*vectors(k + 1:, k)
            end do
         end do
         columns(:, j:j + width - 1) = some(:, :width)
      end do
   end subroutine reflect

   !> Least-squares solution with the columns in use
   pure function solution(q, set) result(z)
      !> The columns, shape (m, n + 1)
      real(wp), intent(in) :: q(:, :)
      !> Numbers of the columns in use
      integer, intent(in) :: set(:)
      !> Solution, 0 for unused columns, shape (n)
      real(wp) :: z(size(q, 2) - 1)

      real(wp) :: triangle(size(set), size(set)), right(size(set))
      integer :: info

      associate (n => size(set))
         triangle = q(:n, set)
         right = q(:n, size(q, 2))
         call dtrtrs('U', 'N', 'N', n, 1, triangle, max(1, n), right, max(1, n), info)
      end associate
      z = 0.0_wp
      z(set) = right
   end function solution

   !> Move from a feasible solution to the least-squares solution with the columns in use, and
   !> remove the columns whose bounds stop it on the way
   pure subroutine make_feasible(q, set, x, z)
      !> The columns, shape (m, n + 1)
      real(wp), intent(inout) :: q(:, :)
      !> Numbers of the columns in use
      integer, allocatable, intent(inout) :: set(:)
      !> A feasible solution, on return the least-squares solution with the remaining columns
      real(wp), intent(inout) :: x(:)
      !> Least-squares solution with the columns in use
      real(wp), intent(inout) :: z(:)

      real(wp) :: part(size(x)), step
      logical, allocatable :: stays(:)
      integer :: last

      do while (any(.not. z(set) > 0.0_wp))
         ! part of the way to z along which each x stays >= 0; x and z may both be 0
         part = 1.0_wp
         where (.not. z > 0.0_wp) part = x/max(x - z, tiny(1.0_wp))
         step = minval(part(set))
         x = max(0.0_wp, x + step*(z - x))
         stays = z(set) > 0.0_wp .or. part(set) > step
         last = size(set)
         set = pack(set, stays)
         call make_triangular(q, set, findloc(stays, .false., dim=1), last)
         z = solution(q, set)
      end do
      x = z
   end subroutine make_feasible

end module vcor_numeric_nnls
