!> Richardson's extrapolation from three values with steps h, h/2 and h/4
module vcor_numeric_richardson
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_quiet_nan, ieee_value
   use vcor_kinds, only : wp
   implicit none
   private

   public :: richardson_t, richardson, best_ratio

   !> Largest ratio of the errors of two levels that is believed: 2^3, since methods of second order
   !> may be of third by chance or by extrapolation
   real(wp), parameter :: best_ratio = 8.0_wp

   !> What three values show
   type :: richardson_t
      !> Observed order of convergence; NaN if they are equal or do not converge monotonically
      real(wp) :: order = 0.0_wp
      !> Extrapolated limit for zero step
      real(wp) :: limit = 0.0_wp
      !> Conservative estimate of the error of the last value
      real(wp) :: error = 0.0_wp
   end type richardson_t

contains

   !> Extrapolate. The limit is taken with the observed order, limited to `lowest` and `highest`,
   !> the orders of singularities and methods: beyond it is chance. The error is taken with the
   !> observed order limited to 1 and 2, ratios of `linear` and `square`,
   !> times P. J. Roache's safety factor for three grids, J. Fluids Eng. 116 (1994) 405,
   !> doi:10.1115/1.2910291, and is at least what the first difference gives with order 2, as the
   !> last two values may agree by chance. Without monotone convergence it is the last difference,
   !> or an eighth of the first. Values that are not finite give NaN
   pure function richardson(value) result(found)
      !> Values with steps h, h/2 and h/4
      real(wp), intent(in) :: value(3)
      !> Order, limit and error
      type(richardson_t) :: found

      real(wp), parameter :: lowest = 0.5_wp, highest = 4.0_wp
      real(wp), parameter :: linear = 2.0_wp, square = 4.0_wp, safety = 1.25_wp
      real(wp) :: first, second, ratio, order

      if (.not. all(ieee_is_finite(value))) then
         found%order = ieee_value(order, ieee_quiet_nan)
         found%limit = found%order
         found%error = found%order
         return
      end if
      first = value(2) - value(1)
      second = value(3) - value(2)
      found%order = ieee_value(found%order, ieee_quiet_nan)
      found%limit = value(3)
      found%error = max(abs(second), abs(first)/best_ratio)
      ! the differences have different signs, or one is zero: no convergence
      if (.not. min(first, second) > 0.0_wp .and. .not. max(first, second) < 0.0_wp) return
      ratio = min(max(first/second, linear), square)
      found%error = max(safety*abs(second)/(ratio - 1.0_wp), &
         abs(first)/(square*(square - 1.0_wp)))
      found%order = log(first/second)/log(2.0_wp)
      order = min(max(found%order, lowest), highest)
      found%limit = value(3) + second/(2.0_wp**order - 1.0_wp)
   end function richardson

end module vcor_numeric_richardson
