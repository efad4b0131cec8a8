!> Monotone interpolation by piecewise cubics, which rise, fall and are constant where the data are
module vcor_numeric_monotone
   use vcor_kinds, only : wp
   implicit none
   private

   public :: monotone_slopes, piece, cubic

contains

   !> Slopes at the points for which Hermite's cubics between them are monotone: F. N. Fritsch and
   !> J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300, doi:10.1137/0905021. Third order for
   !> smooth data
   pure function monotone_slopes(x, y) result(slope)
      !> Points, strictly increasing, shape (n), n >= 2
      real(wp), intent(in) :: x(:)
      !> Values, shape (n)
      real(wp), intent(in) :: y(:)
      !> Slopes, shape (n)
      real(wp) :: slope(size(x))

      real(wp) :: h(size(x) - 1), secant(size(x) - 1), a, b
      integer :: i, n

      n = size(x)
      h = x(2:) - x(:n - 1)
      secant = (y(2:) - y(:n - 1))/h
      do i = 2, n - 1
         slope(i) = 0.0_wp
         if (.not. (min(secant(i - 1), secant(i)) > 0.0_wp .or. &
             max(secant(i - 1), secant(i)) < 0.0_wp)) cycle
         ! weighted harmonic mean, with the larger weight on the secant of the shorter interval
         a = (h(i - 1) + 2.0_wp*h(i))/(3.0_wp*(h(i - 1) + h(i)))
         b = 1.0_wp - a
         slope(i) = secant(i - 1)*(secant(i)/(a*secant(i) + b*secant(i - 1)))
      end do
      if (n == 2) then
         slope = secant(1)
      else
         slope(1) = end_slope(h(1), h(2), secant(1), secant(2))
         slope(n) = end_slope(h(n - 1), h(n - 2), secant(n - 1), secant(n - 2))
      end if
   end function monotone_slopes

   !> Slope at an end: that of the parabola through three points, limited so that the cubic stays
   !> monotone
   pure function end_slope(h, further_h, secant, further_secant) result(slope)
      !> Length of the interval at the end
      real(wp), intent(in) :: h
      !> Length of the next interval
      real(wp), intent(in) :: further_h
      !> Secant of the interval at the end
      real(wp), intent(in) :: secant
      !> Secant of the next interval
      real(wp), intent(in) :: further_secant
      real(wp) :: slope

      slope = secant + h/(h + further_h)*(secant - further_secant)
      if (secant > 0.0_wp) then
         slope = min(max(slope, 0.0_wp), 3.0_wp*secant)
      else
         slope = max(min(slope, 0.0_wp), 3.0_wp*secant)
      end if
   end function end_slope

   !> Interval that contains a point, by bisection
   pure function piece(x, at) result(i)
      !> Ends of the intervals, increasing, shape (n), n >= 2
      real(wp), intent(in) :: x(:)
      !> The point; if outside, the first or the last interval is returned
      real(wp), intent(in) :: at
      !> x(i) <= at < x(i + 1)
      integer :: i

      integer :: upper, middle

      i = 1
      upper = size(x)
      do while (upper - i > 1)
         middle = (i + upper)/2
         if (x(middle) <= at) then
            i = middle
         else
            upper = middle
         end if
      end do
   end function piece

   !> Hermite's cubic between two points
   elemental subroutine cubic(x0, x1, y0, y1, slope0, slope1, x, y, slope)
      !> First abscissa
      real(wp), intent(in) :: x0
      !> Second abscissa, > x0
      real(wp), intent(in) :: x1
      !> Value at x0
      real(wp), intent(in) :: y0
      !> Value at x1
      real(wp), intent(in) :: y1
      !> Slope at x0
      real(wp), intent(in) :: slope0
      !> Slope at x1
      real(wp), intent(in) :: slope1
      !> Argument
      real(wp), intent(in) :: x
      !> Value at x
      real(wp), intent(out) :: y
      !> Slope at x
      real(wp), intent(out) :: slope

      real(wp) :: h, u, secant, c2, c3

      h = x1 - x0
      u = x - x0
      secant = (y1 - y0)/h
      c2 = (3.0_wp*secant - 2.0_wp*slope0 - slope1)/h
      c3 = (slope0 + slope1 - 2.0_wp*secant)/h**2
      y = y0 + u*(slope0 + u*(c2 + u*c3))
      slope = slope0 + u*(2.0_wp*c2 + 3.0_wp*u*c3)
   end subroutine cubic

end module vcor_numeric_monotone
