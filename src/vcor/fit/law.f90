!> Fit of the models with a few parameters: sls, power_law, cerf, mittag_leffler
!>
!> Every local minimum of a scan over the shapes of the model starts an iteration in the logarithms
!> of the parameters; the lowest result is the fit.
!>
!> Near a solution that the data determine well, the sum of squares is quadratic and its derivatives
!> give the standard errors. It is not if a parameter is known only to a few ten percent, or is at
!> the end of its range. Then each parameter in turn is held at other values and all others are
!> fitted again: the interval of three standard errors ends where the sum of squares has risen by
!> 3^2 variances (profile likelihood: D. M. Bates and D. G. Watts, Nonlinear Regression Analysis and
!> Its Applications, Wiley 1988, chapter 6). The standard error is a third of the distance to the
!> farther end; for a quadratic sum of squares it is the usual one.
module vcor_fit_law
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material, only : material_t, new_material
   use vcor_fit_law_problem, only : described, find_starts, has_two_shapes, law_problem_t, &
      new_law_problem, negligible, release, set_free, unknowns_of
   use vcor_fit_result, only : estimate_t, fit_t, judge, mark_ends, set_errors, state_bound, &
      state_fixed, state_free
   use vcor_fit_samples, only : samples_t
   use vcor_numeric_least_squares, only : minimise
   implicit none
   private

   public :: fit_law

   !> Maximum number of evaluations per unknown
   integer, parameter :: patience = 400
   !> Half width of the interval, in standard errors
   real(wp), parameter :: reach = 3.0_wp

contains

   !> Fit a model to samples
   subroutine fit_law(fit, model, fixed, samples, error)
      type(fit_t), intent(out) :: fit
      !> Name of a model with a few parameters
      character(len=*), intent(in) :: model
      !> Parameters with given values, shape (n)
      type(estimate_t), intent(in) :: fixed(:)
      !> The samples, more than there are parameters
      type(samples_t), intent(in) :: samples
      !> Error of code `error_numerical` if there is no solution, of code `error_input` if a given
      !> value is out of range; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(law_problem_t) :: problem
      class(material_t), allocatable :: material
      real(wp), allocatable :: x(:), starts(:, :)
      real(wp) :: r(samples%count()), best(samples%count())
      real(wp), allocatable :: solution(:)
      logical :: converged, good
      integer :: i

      call new_law_problem(problem, model, fixed, samples)
      call find_starts(problem, starts)
      good = .false.
      do i = 1, size(starts, 2)
         x = log(starts(problem%free, i))
         call minimise(problem, x, r, converged, 0.0_wp, patience*(size(x) + 1))
         if (i > 1) then
            if (.not. norm2(r) < norm2(best)) cycle
         end if
         best = r
         solution = x
         good = converged
      end do
      if (size(starts, 2) == 0) then
         call raise(error, error_numerical, 'model '//model//' has no likeness to the data')
         return
      end if
      call follow_bounds(problem, solution, best, good)
      if (.not. good) then
         call raise(error, error_numerical, 'the fit of model '//model//' does not converge: ' &
            //'give parameters with --fix, or another model')
         return
      end if

      problem%parameters(problem%free)%value = exp(solution)
      fit%data = described(problem, problem%parameters%value)
      fit%parameters = problem%parameters
      call new_material(material, fit%data, error)
      if (allocated(error)) return
      call judge(fit, material, samples)
      problem%parameters = fit%parameters
      call release(problem)
      call set_errors(fit, problem, unknowns_of(problem), best, problem%free, size(samples%at), &
         error)
      if (allocated(error)) return
      call widen_errors(fit, problem, sum(best**2))
      call mark_ends(fit, material, samples)
   end subroutine fit_law

   !> Fix the parameters at the ends of their ranges and fit the others again: a modulus or rate
   !> that vanishes becomes 0, an exponent 1, and any other parameter keeps its value
   subroutine follow_bounds(problem, x, r, converged)
      !> The problem; on return parameters at a bound are not free
      type(law_problem_t), intent(inout) :: problem
      !> Solution
      real(wp), allocatable, intent(inout) :: x(:)
      real(wp), intent(inout) :: r(:)
      !> Whether the iteration has converged
      logical, intent(inout) :: converged

      real(wp), parameter :: touch = 1.0e-5_wp
      real(wp), allocatable :: kept(:)
      integer :: i

      do i = 1, size(x)
         associate (parameter => problem%parameters(problem%free(i)))
            if (exp(x(i)) < negligible*problem%unit(problem%free(i))) then
               parameter%value = 0.0_wp
            else if (parameter%unit == '1' .and. x(i) > problem%upper(i) - touch &
               .and. .not. problem%stated(problem%free(i))%range%upper_open) then
               parameter%value = problem%stated(problem%free(i))%range%upper
            else if (x(i) < problem%lower(i) + touch .or. x(i) > problem%upper(i) - touch) then
               parameter%value = exp(x(i))
            else
               cycle
            end if
            parameter%state = state_bound
         end associate
      end do
      if (all(problem%parameters(problem%free)%state == state_free)) return
      kept = pack(x, problem%parameters(problem%free)%state == state_free)
      call move_alloc(kept, x)
      call set_free(problem)
      call minimise(problem, x, r, converged, 0.0_wp, patience*(size(x) + 1))
   end subroutine follow_bounds

   !> Replace the standard errors by those of intervals, unless the derivatives suffice
   subroutine widen_errors(fit, problem, squares)
      !> The fit, with errors from the derivatives
      type(fit_t), intent(inout) :: fit
      !> Its problem, in which all parameters are free except the given ones
      type(law_problem_t), intent(in) :: problem
      !> Sum of the squares of the residuals
      real(wp), intent(in) :: squares

      !> Relative error of a parameter up to which the derivatives suffice: the error itself then
      !> has a relative error of about three times this value
      real(wp), parameter :: enough = 0.02_wp
      type(law_problem_t) :: whole
      real(wp) :: ends(2)
      logical :: open(2)
      integer :: i, k

      whole = problem
      whole%parameters%error = fit%parameters%error
      if (all(fit%parameters%error <= enough*max(fit%parameters%value, problem%unit))) return
      do i = 1, size(whole%free)
         k = whole%free(i)
         call find_end(whole, i, -1.0_wp, squares, fit%variance, ends(1), open(1))
         call find_end(whole, i, 1.0_wp, squares, fit%variance, ends(2), open(2))
         associate (parameter => fit%parameters(k))
            parameter%error = maxval(abs(ends - parameter%value))/reach
            ! the interval does not end: not even the order of magnitude is known
            if (any(open)) parameter%error = max(parameter%error, parameter%value)
         end associate
      end do
   end subroutine widen_errors

   !> Find one end of the interval of an unknown
   subroutine find_end(problem, i, side, squares, variance, end, open)
      !> The problem, its values and errors from the derivatives set
      type(law_problem_t), intent(in) :: problem
      !> Index of the unknown
      integer, intent(in) :: i
      !> 1 for the upper end, -1 for the lower one
      real(wp), intent(in) :: side
      !> Smallest sum of the squares of the residuals
      real(wp), intent(in) :: squares
      !> Variance of a residual
      real(wp), intent(in) :: variance
      !> The end, as a value of the parameter
      real(wp), intent(out) :: end
      !> Whether it is only the end of the range of the fit: the parameter may lie beyond
      logical, intent(out) :: open

      !> Maximum number of trials, and tolerance of the rise, in standard errors
      integer, parameter :: most = 30
      real(wp), parameter :: sharp = 0.05_wp
      !> Largest first step, in the logarithm of a parameter
      real(wp), parameter :: first_step = 0.7_wp
      !> Rise at the outer end, over `reach`, above which bisection replaces the secant
      real(wp), parameter :: steep = 4.0_wp
      type(law_problem_t) :: held
      real(wp) :: unit, limit, step, rise, inside, inside_rise, outside, outside_rise
      real(wp) :: sum_of_squares
      logical :: bounded, linear
      integer :: k, n

      k = problem%free(i)
      held = problem
      held%parameters(k)%state = state_fixed
      call set_free(held)
      associate (best => problem%parameters(k))
         ! a parameter that may be 0 is a term of a sum: step linearly; any other is a factor
         unit = problem%unit(k)
         linear = unit > 0.0_wp
         bounded = merge(linear, best%unit == '1', side < 0.0_wp)
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

   !> Fit all free parameters, with others held
   subroutine fit_others(problem, squares, enough)
      !> The problem, at the start of the iteration; on return with the solution if it is good
      !> enough
      type(law_problem_t), intent(inout) :: problem
      !> Least sum of the squares of the residuals
      real(wp), intent(out) :: squares
      !> Sum of squares that is good enough
      real(wp), intent(in) :: enough

      real(wp), allocatable :: starts(:, :)
      integer :: i

      squares = huge(squares)
      call descend(problem, unknowns_of(problem), squares, enough)
      ! a scan over time and exponent takes as long as the whole fit
      if (squares < enough .or. has_two_shapes(problem)) return
      call find_starts(problem, starts)
      do i = 1, size(starts, 2)
         call descend(problem, log(starts(problem%free, i)), squares, enough)
         if (squares < enough) return
      end do
   end subroutine fit_others

   !> Iterate from one start
   subroutine descend(problem, start, squares, enough)
      !> The problem; gets the values of a fit that is good enough
      type(law_problem_t), intent(inout) :: problem
      real(wp), intent(in) :: start(:)
      !> Smallest sum of squares so far
      real(wp), intent(inout) :: squares
      !> Sum of squares that is good enough
      real(wp), intent(in) :: enough

      !> Relative reduction of the sum of squares that ends the iteration, and maximum number of
      !> evaluations per unknown
      real(wp), parameter :: tolerance = 1.0e-6_wp
      integer, parameter :: patience = 60
      real(wp) :: x(size(start)), r(problem%samples%count())
      logical :: converged

      x = start
      call minimise(problem, x, r, converged, tolerance, patience*(size(x) + 1))
      squares = min(squares, sum(r**2))
      if (squares < enough) problem%parameters(problem%free)%value = exp(x)
   end subroutine descend

end module vcor_fit_law
