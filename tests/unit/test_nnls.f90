!> Non-negative least squares: known solutions, and the conditions of Karush, Kuhn and Tucker
program test_nnls
   use vcor_kinds, only : wp
   use vcor_numeric_nnls, only : solve_nnls
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : random_t
   implicit none

   !> A few operations, each rounded
   real(wp), parameter :: rounding = 1.0e-14_wp
   !> Gradients of up to 60 products of numbers of order 1, for columns and right-hand sides of
   !> length 1, after as many reflections
   real(wp), parameter :: gradient_tolerance = 1.0e-12_wp
   !> Solutions of random systems, whose condition is below 1e4
   real(wp), parameter :: solution_tolerance = 1.0e-10_wp
   !> Problems of a kind
   integer, parameter :: many = 300

   type(random_t) :: random

   call suite("nnls")
   call test_known()
   call test_random()
   call test_solution()
   call test_dependent()
   call test_exponentials()
   call test_scales()
   call test_guess()
   call finish()

contains

   !> Problems that are solved by hand
   subroutine test_known()
      real(wp) :: x(2), line(3, 2), none(0)

      call solve_nnls(reshape([1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [2, 2]), [2.0_wp, -1.0_wp], x)
      call check_close(x, [2.0_wp, 0.0_wp], rounding, "nearest point of the first quadrant")
      ! a line through (1, 3), (2, 2), (3, 1) may not fall: it is their mean
      line = reshape([1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, 2.0_wp, 3.0_wp], [3, 2])
      call solve_nnls(line, [3.0_wp, 2.0_wp, 1.0_wp], x)
      call check_close(x, [2.0_wp, 0.0_wp], rounding, "a line that may not fall")
      ! no bound in the way: the line through (1, 2), (2, 3), (3, 4)
      call solve_nnls(line, [2.0_wp, 3.0_wp, 4.0_wp], x)
      call check_close(x, 1.0_wp, rounding, "a line that rises")
      ! both columns are better than nothing alone; with the second in use the first has to go
      call solve_nnls(reshape([1.0_wp, 0.2_wp, 1.0_wp, 1.0_wp], [2, 2]), [1.0_wp, 1.0_wp], x)
      call check_close(x, [0.0_wp, 1.0_wp], rounding, "one column is the right-hand side")
      call solve_nnls(line, [-1.0_wp, -2.0_wp, -1.0_wp], x)
      call check_close(x, 0.0_wp, 0.0_wp, "away from all columns the solution is zero")
      call solve_nnls(line, [0.0_wp, 0.0_wp, 0.0_wp], x)
      call check_close(x, 0.0_wp, 0.0_wp, "nothing is approximated by nothing")
      call solve_nnls(reshape(none, [3, 0]), [1.0_wp, 2.0_wp, 3.0_wp], none)
      call check(size(none) == 0, "without columns there is nothing to do")
   end subroutine test_known

   !> Random problems, tall, square and wide
   subroutine test_random()
      real(wp), allocatable :: a(:, :), b(:), x(:)
      integer :: trial, active

      active = 0
      do trial = 1, many
         call random_problem(random%among(1, 40), random%among(1, 40), a, b, x)
         call solve_nnls(a, b, x)
         call check_kkt(a, b, x, "random problem")
         active = active + count(x > 0.0_wp)
      end do
      call check(active > many, "random problems use columns")
   end subroutine test_random

   !> A solution that is known since the right-hand side was made from it
   subroutine test_solution()
      real(wp), allocatable :: a(:, :), b(:), x(:), expected(:)
      integer :: trial, i, n

      do trial = 1, many
         n = random%among(1, 20)
         call random_problem(2*n, n, a, b, x)
         expected = [(max(0.0_wp, random%between(-1.0_wp, 1.0_wp)), i=1, n)]
         b = matmul(a, expected)
         call solve_nnls(a, b, x)
         call check_close(x, expected, solution_tolerance, "the solution is found again")
      end do
   end subroutine test_solution

   !> Columns that are zero, equal, opposite, sums of others, or nearly so
   subroutine test_dependent()
      real(wp), allocatable :: a(:, :), b(:), x(:)
      integer :: trial, i, j, m, n

      do trial = 1, many
         m = random%among(2, 20)
         n = random%among(2, 30)
         call random_problem(m, n, a, b, x)
         do i = 2, n
            j = random%among(1, i - 1)
            select case (random%among(1, 6))
            case (1)
               a(:, i) = 0.0_wp
            case (2)
               a(:, i) = a(:, j)
            case (3)
               a(:, i) = -3.0_wp*a(:, j)
            case (4)
               a(:, i) = 0.5_wp*(a(:, j) + a(:, 1))
            case (5)
               a(:, i) = a(:, j)*(1.0_wp + 1.0e-14_wp*a(:, 1))
            case default
               continue
            end select
         end do
         call solve_nnls(a, b, x)
         call check_kkt(a, b, x, "dependent columns")
      end do
      a(:, :) = 0.0_wp
      call solve_nnls(a, b, x)
      call check_close(x, 0.0_wp, 0.0_wp, "a matrix of zeros")
      a(:, :) = 1.0_wp
      b = 3.0_wp
      call solve_nnls(a, b, x)
      call check_relative(sum(x), 3.0_wp, rounding, "all columns equal")
      call check(count(x > 0.0_wp) == 1, "one of them is enough")
   end subroutine test_dependent

   !> Exponentials of a dense grid of rates: columns that differ by less and less
   subroutine test_exponentials()
      integer, parameter :: m = 120
      real(wp), allocatable :: a(:, :), x(:)
      real(wp) :: t(m), b(m)
      integer :: i, j, n

      t = [(10.0_wp**(0.05_wp*real(i, wp) - 3.0_wp), i=1, m)]
      b = 1.0_wp/(1.0_wp + sqrt(t))
      n = 25
      do i = 1, 4
         allocate (a(m, n), x(n))
         do j = 1, n
            a(:, j) = exp(-10.0_wp**(8.0_wp*real(j, wp)/real(n, wp) - 4.0_wp)*t)
         end do
         call solve_nnls(a, b, x)
         call check_kkt(a, b, x, "exponentials")
         call check(norm2(matmul(a, x) - b) < 1.0e-2_wp*norm2(b), "exponentials approximate")
         deallocate (a, x)
         n = 2*n
      end do
   end subroutine test_exponentials

   !> Neither the units of the columns nor that of the right-hand side matter
   subroutine test_scales()
      real(wp), allocatable :: a(:, :), b(:), x(:), y(:), unit(:)
      integer :: i

      call random_problem(12, 15, a, b, x)
      call solve_nnls(a, b, x)
      unit = [(10.0_wp**random%among(-100, 100), i=1, size(x))]
      allocate (y(size(x)))
      call solve_nnls(a*spread(unit, 1, size(b)), 1.0e-50_wp*b, y)
      call check_close(1.0e50_wp*y*unit, x, solution_tolerance, "units do not matter")
   end subroutine test_scales

   !> A guess at the columns in use changes the way, not the end
   subroutine test_guess()
      real(wp), allocatable :: a(:, :), b(:), x(:), y(:)
      logical, allocatable :: start(:)
      integer :: trial, i

      do trial = 1, many
         call random_problem(random%among(1, 20), random%among(1, 20), a, b, x)
         call solve_nnls(a, b, x)
         if (allocated(y)) deallocate (y, start)
         allocate (y(size(x)), start(size(x)))
         start = [(random%among(0, 1) == 1, i=1, size(x))]
         call solve_nnls(a, b, y, start)
         call check_kkt(a, b, y, "from a guess")
         call check_close(norm2(matmul(a, y) - b), norm2(matmul(a, x) - b), solution_tolerance, &
            "a guess ends at the same residual")
         call solve_nnls(a, b, y, x > 0.0_wp)
         call check_close(norm2(matmul(a, y) - b), norm2(matmul(a, x) - b), solution_tolerance, &
            "and so does a good one")
      end do
   end subroutine test_guess

   !> A random problem
   subroutine random_problem(m, n, a, b, x)
      !> Rows
      integer, intent(in) :: m
      !> Columns
      integer, intent(in) :: n
      !> Matrix
      real(wp), allocatable, intent(out) :: a(:, :)
      !> Right-hand side
      real(wp), allocatable, intent(out) :: b(:)
      !> Room for the solution
      real(wp), allocatable, intent(out) :: x(:)

      integer :: i, j

      allocate (a(m, n), b(m), x(n))
      do j = 1, n
         do i = 1, m
            a(i, j) = random%between(-1.0_wp, 1.0_wp)
         end do
      end do
      b = [(random%between(-1.0_wp, 1.0_wp), i=1, m)]
   end subroutine random_problem

   !> The conditions of the minimum: x >= 0, no descent along any column, none either way along
   !> those in use
   subroutine check_kkt(a, b, x, what)
      !> Matrix
      real(wp), intent(in) :: a(:, :)
      !> Right-hand side
      real(wp), intent(in) :: b(:)
      !> Solution
      real(wp), intent(in) :: x(:)
      !> What is solved
      character(len=*), intent(in) :: what

      real(wp) :: descent(size(x)), largest
      integer :: j

      do j = 1, size(x)
         descent(j) = dot_product(a(:, j), b - matmul(a, x)) &
            /max(norm2(a(:, j))*norm2(b), tiny(1.0_wp))
      end do
      call check(all(x >= 0.0_wp), what//": no coefficient is negative")
      largest = max(0.0_wp, maxval(descent))
      call check_close(largest, 0.0_wp, gradient_tolerance, what//": no column goes further down")
      largest = maxval(abs(merge(descent, 0.0_wp, x > 0.0_wp)))
      call check_close(largest, 0.0_wp, gradient_tolerance, what//": columns in use are at rest")
   end subroutine check_kkt

end program test_nnls
