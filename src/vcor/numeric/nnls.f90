!> Non-negative least squares: minimise |A x - b| with x >= 0
!>
!> The active-set method of C. L. Lawson and R. J. Hanson, "Solving Least Squares Problems" (1974),
!> chapter 23. All columns of A, in use or not, and b are kept multiplied by the same orthogonal
!> matrix, such that the columns in use are triangular. Then to take a column in is one Householder
!> reflection, to let one go a few plane rotations, and the gradient of the columns not in use is a
!> scalar product each: O(m n) per change, where a factorisation by a library for each set of
!> columns would be O(m k^2), and no normal equations, which would halve the digits.
!>
!> It ends whatever the columns are. A column that is dependent on those in use is not taken in; nor
!> is one whose coefficient rounding makes negative; the residual must fall from one feasible
!> solution to the next; and the changes are counted.
module vcor_numeric_nnls
   use vcor_kinds, only : wp
   implicit none
   private

   public :: solve_nnls

   !> A column is dependent on others if no more than this part of its length is orthogonal to them
   real(wp), parameter :: independent = 1.0e-11_wp
   !> Part of |b| below which a gradient, for columns of length 1, is rounding
   real(wp), parameter :: rounding = 1.0e-14_wp

   !> The problem on its way
   type :: work_t
      !> Columns of A of length 1 and b as the last one, all multiplied by one orthogonal matrix,
      !> shape (m, n + 1)
      real(wp), allocatable :: a(:, :)
      !> Columns in use, the first `count` of them, shape (n)
      integer, allocatable :: set(:)
      !> Number of columns in use
      integer :: count = 0
      !> Whether a column is in use, shape (n)
      logical, allocatable :: used(:)
   end type work_t

contains

   !> Solve min |A x - b|, x >= 0
   pure subroutine solve_nnls(a, b, x, start)
      !> Matrix A, finite, shape (m, n)
      real(wp), intent(in) :: a(:, :)
      !> Right-hand side, finite, shape (m)
      real(wp), intent(in) :: b(:)
      !> Solution, shape (n); exactly 0 where the bound holds
      real(wp), intent(out) :: x(:)
      !> Columns that are likely in use, a guess that saves time; shape (n)
      logical, intent(in), optional :: start(:)

      type(work_t) :: work
      real(wp), allocatable :: length(:), z(:)
      logical, allocatable :: blocked(:)
      real(wp) :: residual, before
      integer :: i, j, n, trial
      logical :: taken

      n = size(a, 2)
      allocate (work%a(size(a, 1), n + 1), work%set(n), work%used(n), length(n), z(n), blocked(n))
      work%used = .false.
      do j = 1, n
         length(j) = norm2(a(:, j))
         work%a(:, j) = a(:, j)
         if (length(j) > 0.0_wp) work%a(:, j) = a(:, j)/length(j)
      end do
      work%a(:, n + 1) = b
      x = 0.0_wp
      blocked = .not. length > 0.0_wp
      residual = norm2(b)
      before = residual

      if (present(start)) then
         do j = 1, n
            if (start(j) .and. .not. blocked(j)) call take_in(work, j, taken)
         end do
         call make_feasible(work, x, z)
         residual = norm2(work%a(work%count + 1:, n + 1))
      end if

      do trial = 1, 10*n
         j = steepest(work, blocked, rounding*norm2(b))
         if (j == 0) exit
         call take_in(work, j, taken)
         if (taken) then
            call solve_triangle(work, z)
            if (.not. z(j) > 0.0_wp) then
               call let_go(work, work%count)
               taken = .false.
            end if
         end if
         if (.not. taken) then
            blocked(j) = .true.
            cycle
         end if
         call make_feasible(work, x, z)
         before = residual
         residual = norm2(work%a(work%count + 1:, n + 1))
         if (.not. residual < before) exit
         blocked = .not. length > 0.0_wp
      end do

      do i = 1, work%count
         j = work%set(i)
         x(j) = x(j)/length(j)
      end do
   end subroutine solve_nnls

   !> Column not in use with the steepest descent
   pure function steepest(work, blocked, least) result(column)
      !> The problem
      type(work_t), intent(in) :: work
      !> Columns that are not to be taken, shape (n)
      logical, intent(in) :: blocked(:)
      !> Descent that counts as none
      real(wp), intent(in) :: least
      !> Column; 0: none goes down
      integer :: column

      real(wp) :: descent, largest
      integer :: j, n

      n = size(blocked)
      column = 0
      largest = least
      if (work%count == size(work%a, 1)) return
      do j = 1, n
         if (work%used(j) .or. blocked(j)) cycle
         descent = dot_product(work%a(work%count + 1:, j), work%a(work%count + 1:, n + 1))
         if (descent > largest) then
            largest = descent
            column = j
         end if
      end do
   end function steepest

   !> Take a column in, unless it depends on those in use: a Householder reflection of the rows
   !> below the triangle, I - v v'/h
   pure subroutine take_in(work, column, taken)
      !> The problem
      type(work_t), intent(inout) :: work
      !> The column, not in use
      integer, intent(in) :: column
      !> Whether it was taken
      logical, intent(out) :: taken

      real(wp) :: v(size(work%a, 1)), pivot, h, factor
      integer :: j, k

      k = work%count + 1
      taken = .false.
      if (k > size(work%a, 1)) return
      v(k:) = work%a(k:, column)
      ! the sign that does not cancel
      pivot = -sign(norm2(v(k:)), v(k))
      if (.not. abs(pivot) > independent) return
      h = pivot*(pivot - v(k))
      v(k) = v(k) - pivot
      work%used(column) = .true.
      do j = 1, size(work%a, 2)
         if (j <= size(work%used)) then
            ! columns in use are zero there
            if (work%used(j)) cycle
         end if
         factor = dot_product(v(k:), work%a(k:, j))/h
         work%a(k:, j) = work%a(k:, j) - factor*v(k:)
      end do
      work%a(k, column) = pivot
      work%a(k + 1:, column) = 0.0_wp
      work%set(k) = column
      work%count = k
      taken = .true.
   end subroutine take_in

   !> Let a column go: those after it lose what stands below the diagonal by plane rotations
   pure subroutine let_go(work, place)
      !> The problem
      type(work_t), intent(inout) :: work
      !> Its place in `set`
      integer, intent(in) :: place

      real(wp) :: c, s, r, upper
      integer :: i, j

      work%used(work%set(place)) = .false.
      work%set(place:work%count - 1) = work%set(place + 1:work%count)
      work%count = work%count - 1
      do i = place, work%count
         associate (a => work%a(:, work%set(i)))
            r = norm2(a(i:i + 1))
            c = a(i)/r
            s = a(i + 1)/r
         end associate
         do j = 1, size(work%a, 2)
            upper = work%a(i, j)
            work%a(i, j) = c*upper + s*work%a(i + 1, j)
            work%a(i + 1, j) = c*work%a(i + 1, j) - s*upper
         end do
         work%a(i + 1, work%set(i)) = 0.0_wp
      end do
   end subroutine let_go

   !> Least squares with the columns in use
   pure subroutine solve_triangle(work, z)
      !> The problem
      type(work_t), intent(in) :: work
      !> Solution, 0 for other columns, shape (n)
      real(wp), intent(out) :: z(:)

      real(wp) :: right(work%count)
      integer :: i

      z = 0.0_wp
      right = work%a(:work%count, size(work%a, 2))
      do i = work%count, 1, -1
         associate (a => work%a(:, work%set(i)))
            right(i) = right(i)/a(i)
            right(:i - 1) = right(:i - 1) - right(i)*a(:i - 1)
            z(work%set(i)) = right(i)
         end associate
      end do
   end subroutine solve_triangle

   !> Go from a feasible solution towards least squares with the columns in use, and let go those
   !> whose bound is in the way, until it is reached
   pure subroutine make_feasible(work, x, z)
      !> The problem
      type(work_t), intent(inout) :: work
      !> A feasible solution, on return the one of least squares with the columns that are left
      real(wp), intent(inout) :: x(:)
      !> Work space, shape (n)
      real(wp), intent(out) :: z(:)

      real(wp) :: step
      integer :: i, j, nearest

      do
         call solve_triangle(work, z)
         nearest = 0
         step = 1.0_wp
         do i = 1, work%count
            j = work%set(i)
            if (z(j) > 0.0_wp) cycle
            ! x may be 0, and z as well
            if (x(j) > step*(x(j) - z(j)) .and. nearest > 0) cycle
            nearest = i
            if (x(j) > 0.0_wp) then
               step = x(j)/(x(j) - z(j))
            else
               step = 0.0_wp
            end if
         end do
         if (nearest == 0) exit
         do i = 1, work%count
            j = work%set(i)
            x(j) = max(0.0_wp, x(j) + step*(z(j) - x(j)))
         end do
         x(work%set(nearest)) = 0.0_wp
         do i = work%count, 1, -1
            if (.not. x(work%set(i)) > 0.0_wp .and. .not. z(work%set(i)) > 0.0_wp) &
               call let_go(work, i)
         end do
      end do
      x = z
   end subroutine make_feasible

end module vcor_numeric_nnls
