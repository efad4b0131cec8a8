!> Richardson's extrapolation from three values with steps h, h/2 and h/4
module vcor_numeric_richardson
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_quiet_nan, ieee_value
   use vcor_kinds, only : wp
   implicit none
   private

   public :: richardson_t, richardson

   !> What three values tell
   type :: richardson_t
      !> Order of convergence that they show; NaN where they show none, being equal or erratic
      real(wp) :: order = 0.0_wp
      !> Limit for steps of no length
      real(wp) :: limit = 0.0_wp
      !> Estimate of the error of the last value, on the safe side
      real(wp) :: error = 0.0_wp
   end type richardson_t

contains

   !> Extrapolate. Orders outside of `lowest` and `highest` are chance: the limit is then taken with
   !> the nearer of the two. The error is taken with an order between one and two, one where they
   !> show none, times the safety factor for three grids of P. J. Roache, J. Fluids Eng. 116 (1994)
   !> 405, doi:10.1115/1.2910291. It is not below what the larger steps say of it with order two,
   !> as the last two values may agree by chance. Values that are not finite tell nothing: NaN
   pure function richardson(value) result(found)
      !> Values with steps h, h/2 and h/4
      real(wp), intent(in) :: value(3)
      !> What they tell
      type(richardson_t) :: found

      real(wp), parameter :: lowest = 0.5_wp, highest = 4.0_wp, best_ratio = 8.0_wp
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
      ! differences of different signs, or one of them none at all, are no convergence
      if (.not. min(first, second) > 0.0_wp .and. .not. max(first, second) < 0.0_wp) return
      ratio = min(max(first/second, linear), square)
      found%error = max(safety*abs(second)/(ratio - 1.0_wp), &
         abs(first)/(square*(square - 1.0_wp)))
      found%order = log(first/second)/log(2.0_wp)
      order = min(max(found%order, lowest), highest)
      found%limit = value(3) + second/(2.0_wp**order - 1.0_wp)
   end function richardson

end module vcor_numeric_richardson
