!> Standard errors of parameters that the data determine poorly
!>
!> About a solution that the data determine well the sum of squares is a parabola, and derivatives
!> say how wide. It is none where a parameter is known to a few ten percent only, or is at the end
!> of its range. Then each parameter in turn is given other values and all others are fitted again:
!> the interval of three standard errors ends where the sum of squares has risen by 3^2 variances
!> (profile likelihood: D. M. Bates and D. G. Watts, Nonlinear Regression Analysis and Its
!> Applications, Wiley 1988, chapter 6). A third of the way to the end that is further away is the
!> standard error. Of a parabola that is the usual one.
module vcor_fit_interval
   use vcor_kinds, only : wp
   use vcor_fit_problem, only : problem_t, set_free, unit_of, unknowns_of
   use vcor_fit_result, only : fit_t, state_fixed
   use vcor_fit_scan, only : find_starts
   use vcor_numeric_least_squares, only : minimise
   implicit none
   private

   public :: widen_errors

   !> Standard errors to the ends of an interval
   real(wp), parameter :: reach = 3.0_wp

contains

   !> Make the standard errors those of intervals, unless the derivatives are enough
   subroutine widen_errors(fit, problem, squares)
      !> The fit, with errors by the derivatives
      type(fit_t), intent(inout) :: fit
      !> Its problem, in which all is free but what is given
      type(problem_t), intent(in) :: problem
      !> Sum of the squares of the residuals
      real(wp), intent(in) :: squares

      !> Error, as a part of the parameter, up to which the derivatives are enough: they are wrong
      !> by about three times this part of themselves
      real(wp), parameter :: enough = 0.02_wp
      type(problem_t) :: whole
      real(wp) :: ends(2)
      logical :: open(2)
      integer :: i, k

      whole = problem
      whole%parameters%error = fit%parameters%error
      if (all(fit%parameters%error <= enough*max(fit%parameters%value, &
         unit_of(fit%parameters%name, problem%samples)))) return
      do i = 1, size(whole%free)
         k = whole%free(i)
         call find_end(whole, i, -1.0_wp, squares, fit%variance, ends(1), open(1))
         call find_end(whole, i, 1.0_wp, squares, fit%variance, ends(2), open(2))
         associate (parameter => fit%parameters(k))
            parameter%error = maxval(abs(ends - parameter%value))/reach
            ! not even its order of magnitude is known
            if (any(open)) parameter%error = max(parameter%error, parameter%value)
         end associate
      end do
   end subroutine widen_errors

   !> Find an end of the interval of an unknown
   subroutine find_end(problem, i, side, squares, variance, end, open)
      !> The problem, values and errors by the derivatives set
      type(problem_t), intent(in) :: problem
      !> Number of the unknown
      integer, intent(in) :: i
      !> 1 for the upper end, -1 for the lower one
      real(wp), intent(in) :: side
      !> Least sum of the squares of the residuals
      real(wp), intent(in) :: squares
      !> Variance of a residual
      real(wp), intent(in) :: variance
      !> The end, a value of the parameter
      real(wp), intent(out) :: end
      !> Whether it is only that of the range of the fit: the parameter could be anything beyond
      logical, intent(out) :: open

      !> Most trials, and how well the rise is met, in standard errors
      integer, parameter :: most = 30
      real(wp), parameter :: sharp = 0.05_wp
      !> Largest first step, in the logarithm of a parameter
      real(wp), parameter :: first_step = 0.7_wp
      !> Rise from which on it is no straight line from there to the solution, in reaches
      real(wp), parameter :: steep = 4.0_wp
      type(problem_t) :: held
      real(wp) :: unit, limit, step, rise, inside, inside_rise, outside, outside_rise
      real(wp) :: sum_of_squares
      logical :: bounded, linear
      integer :: k, n

      k = problem%free(i)
      held = problem
      held%parameters(k)%state = state_fixed
      call set_free(held)
      associate (best => problem%parameters(k))
         ! what may be 0 is one of the terms of a sum, anything else is a factor
         unit = unit_of(best%name, problem%samples)
         linear = unit > 0.0_wp
         bounded = merge(linear, best%name == 'exponent', side < 0.0_wp)
         if (linear) then
            limit = merge(best%value, exp(problem%upper(i)) - best%value, bounded)
            step = min(reach*best%error, max(best%value, unit))
         else
            limit = side*(merge(problem%lower(i), problem%upper(i), side < 0.0_wp) &
               - log(best%value))
            step = min(reach*best%error/best%value, first_step)
         end if
         limit = max(0.0_wp, limit)
         inside = 0.0_wp
         inside_rise = 0.0_wp
         outside = limit
         outside_rise = -1.0_wp
         do n = 1, most
            step = min(step, outside)
            if (linear) then
               end = max(0.0_wp, best%value + side*step)
            else
               end = best%value*exp(side*step)
            end if
            held%parameters(k)%value = end
            call fit_others(held, sum_of_squares, squares + reach**2*variance)
            rise = sqrt(max(0.0_wp, sum_of_squares - squares)/variance)
            if (abs(rise - reach) < sharp) exit
            if (rise < reach) then
               if (.not. step < limit) exit
               inside = step
               inside_rise = rise
            else
               outside = step
               outside_rise = rise
            end if
            if (outside_rise < 0.0_wp) then
               step = step*min(2.0_wp, 1.05_wp*reach/max(rise, 1.0_wp))
            else if (outside_rise > steep*reach) then
               step = 0.5_wp*(inside + outside)
            else
               step = inside + (outside - inside)*max(0.1_wp, min(0.9_wp, &
                  (reach - inside_rise)/(outside_rise - inside_rise)))
            end if
         end do
      end associate
      open = rise < reach .and. .not. (step < limit .or. bounded)
   end subroutine find_end

   !> Fit all parameters but those that are given
   subroutine fit_others(problem, squares, enough)
      !> The problem: where the iteration starts, and what it comes to if that is good enough
      type(problem_t), intent(inout) :: problem
      !> Least sum of the squares of the residuals
      real(wp), intent(out) :: squares
      !> A sum that is good enough
      real(wp), intent(in) :: enough

      real(wp), allocatable :: starts(:, :)
      integer :: i

      squares = huge(squares)
      call descend(problem, unknowns_of(problem), squares, enough)
      ! a scan of time and exponent would take as long as the fit has taken
      if (squares < enough .or. problem%model == 'mittag_leffler') return
      call find_starts(problem, starts)
      do i = 1, size(starts, 2)
         call descend(problem, log(starts(problem%free, i)), squares, enough)
         if (squares < enough) return
      end do
   end subroutine fit_others

   !> Iterate from a start
   subroutine descend(problem, start, squares, enough)
      !> The problem, which gets the values of a fit that is good enough
      type(problem_t), intent(inout) :: problem
      !> Unknowns
      real(wp), intent(in) :: start(:)
      !> Least sum of squares so far
      real(wp), intent(inout) :: squares
      !> A sum that is good enough
      real(wp), intent(in) :: enough

      !> Reduction of the sum of squares that counts as none, and most evaluations, per unknown
      real(wp), parameter :: tolerance = 1.0e-6_wp
      integer, parameter :: patience = 60
      real(wp) :: x(size(start)), r(problem%samples%count())
      logical :: converged

      x = start
      call minimise(problem, x, r, converged, tolerance, patience*(size(x) + 1))
      squares = min(squares, sum(r**2))
      if (squares < enough) problem%parameters(problem%free)%value = exp(x)
   end subroutine descend

end module vcor_fit_interval
