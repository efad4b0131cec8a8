!> Fit of the models with a few parameters: sls, power_law, cerf, mittag_leffler
!>
!> All these models are E_0 + E_1 f(t; p), linear in two moduli for a given shape p: a time, an
!> exponent or both. So the shapes are scanned over the whole range that the data resolve, and
!> non-negative least squares gives the best two moduli for each; no start is guessed. The unit of a
!> parameter tells whether it is a modulus, a time, a rate or an exponent. Every local minimum of
!> the scan starts an iteration in the logarithms of the parameters; the lowest result is the fit.
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
   use vcor_material, only : material_data_t, material_t, new_material, parameters_of
   use vcor_material_type, only : linear, parameter_t, power_of_time
   use vcor_fit_result, only : estimate_t, fit_t, judge, mark_ends, set_errors, state_bound, &
      state_fixed, state_free
   use vcor_fit_samples, only : moduli_of, samples_t
   use vcor_numeric_least_squares, only : least_squares_t, minimise
   use vcor_numeric_nnls, only : solve_nnls
   implicit none
   private

   public :: fit_law, stated_parameters

   !> Maximum number of evaluations per unknown
   integer, parameter :: patience = 400
   !> Half width of the interval, in standard errors
   real(wp), parameter :: reach = 3.0_wp

   !> Factor by which times may lie beyond those of the data, and moduli
   real(wp), parameter :: time_margin = 1.0e4_wp, modulus_margin = 1.0e6_wp
   !> The same for times while the error of a parameter at its bound is estimated
   real(wp), parameter :: error_margin = 1.0e8_wp
   !> Range of an exponent
   real(wp), parameter :: least_exponent = 1.0e-3_wp, most_exponent = 0.9999_wp
   !> Fraction of its `unit` below which a modulus or rate counts as 0
   real(wp), parameter :: negligible = 1.0e-7_wp
   !> Fraction of its `unit` that replaces 0 where the misfit must depend on the logarithm
   real(wp), parameter :: small = 1.0e-3_wp
   !> Step of the central differences, in the logarithm of a parameter: ten correct digits
   real(wp), parameter :: step = 1.0e-5_wp

   !> Times of the scan per decade, and the factor by which they extend beyond the data
   real(wp), parameter :: per_decade = 4.0_wp, scan_margin = 1.0e2_wp
   !> Exponents of the scan
   real(wp), parameter :: exponents(*) = [0.02_wp, 0.05_wp, 0.1_wp, 0.15_wp, 0.2_wp, 0.25_wp, &
      0.3_wp, 0.35_wp, 0.4_wp, 0.45_wp, 0.5_wp, 0.55_wp, 0.6_wp, 0.65_wp, 0.7_wp, 0.75_wp, &
      0.8_wp, 0.85_wp, 0.9_wp, 0.95_wp, 0.98_wp]
   !> Largest number of minima of the scan from which an iteration starts
   integer, parameter :: most_starts = 6

   !> The problem for MINPACK; its unknowns are the logarithms of the free parameters
   type, extends(least_squares_t) :: law_problem_t
      character(len=:), allocatable :: model
      type(samples_t) :: samples
      !> Properties of the parameters, as the model states them, shape (parameters)
      type(parameter_t), allocatable :: stated(:)
      !> Estimates; those that are not free have their values, shape (parameters)
      type(estimate_t), allocatable :: parameters(:)
      !> Reference value of a parameter that may be 0: the smallest modulus, or the reciprocal of
      !> the last time; 0 for any other parameter, shape (parameters)
      real(wp), allocatable :: unit(:)
      !> Indices of the free parameters, shape (n)
      integer, allocatable :: free(:)
      !> Factor by which times may lie beyond those of the data
      real(wp) :: margin = time_margin
   contains
      procedure :: residuals
      procedure :: jacobian
   end type law_problem_t

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

   !> Parameters of a model that a fit finds
   pure function stated_parameters(model) result(stated)
      character(len=*), intent(in) :: model
      !> Fitted parameters, without lists
      type(parameter_t), allocatable :: stated(:)

      type(parameter_t), allocatable :: all(:)

      allocate (all, source=parameters_of(model))
      allocate (stated, source=pack(all, all%fitted .and. .not. all%is_list))
   end function stated_parameters

   !> Build the problem of a model
   subroutine new_law_problem(self, model, fixed, samples)
      type(law_problem_t), intent(out) :: self
      character(len=*), intent(in) :: model
      !> Parameters with given values, shape (n)
      type(estimate_t), intent(in) :: fixed(:)
      type(samples_t), intent(in) :: samples

      integer :: i

      self%model = model
      self%samples = samples
      allocate (self%stated, source=stated_parameters(model))
      allocate (self%parameters(size(self%stated)), self%unit(size(self%stated)))
      self%parameters%name = self%stated%name
      self%parameters%unit = self%stated%unit
      where (self%stated%unit == '') self%parameters%unit = '1'
      self%unit = 0.0_wp
      where (self%stated%scale == linear) self%unit = 1.0_wp/samples%last_time()
      where (self%stated%scale == linear .and. self%stated%unit == 'Pa') &
         self%unit = minval(samples%modulus)
      do i = 1, size(fixed)
         where (self%parameters%name == fixed(i)%name)
            self%parameters%value = fixed(i)%value
            self%parameters%state = state_fixed
         end where
      end do
      call set_free(self)
   end subroutine new_law_problem

   !> Set the list of free parameters, and their bounds
   subroutine set_free(problem)
      type(law_problem_t), intent(inout) :: problem

      real(wp) :: shortest, longest, softest, hardest
      integer :: i, k

      problem%free = pack([(i, i=1, size(problem%parameters))], &
         problem%parameters%state == state_free)
      if (allocated(problem%lower)) deallocate (problem%lower, problem%upper)
      allocate (problem%lower(size(problem%free)), problem%upper(size(problem%free)))
      shortest = problem%samples%first_time()/problem%margin
      longest = problem%samples%last_time()*problem%margin
      softest = minval(problem%samples%modulus)/modulus_margin
      hardest = maxval(problem%samples%modulus)*modulus_margin
      do i = 1, size(problem%free)
         k = problem%free(i)
         associate (lower => problem%lower(i), upper => problem%upper(i), &
                    power => power_of_time(problem%stated(k)%unit))
            if (abs(power) > 0.0_wp) then
               lower = min(power*log(shortest), power*log(longest))
               upper = max(power*log(shortest), power*log(longest))
            else if (problem%stated(k)%unit == 'Pa') then
               lower = log(softest)
               upper = log(hardest)
            else if (problem%stated(k)%unit == 'Pa s^a') then
               ! for an arbitrary exponent a, C of C t^-a may have any value
               lower = log(softest) + min(0.0_wp, log(shortest))
               upper = log(hardest) + max(0.0_wp, log(longest))
            else
               lower = log(least_exponent)
               upper = log(most_exponent)
            end if
            if (problem%unit(k) > 0.0_wp) lower = log(0.01_wp*negligible*problem%unit(k))
         end associate
      end do
   end subroutine set_free

   !> Free the parameters at their bounds, and widen the bounds
   subroutine release(problem)
      type(law_problem_t), intent(inout) :: problem

      where (problem%parameters%state == state_bound) problem%parameters%state = state_free
      problem%margin = error_margin
      call set_free(problem)
   end subroutine release

   !> Unknowns, limited to the bounds, from the values of the parameters
   pure function unknowns_of(problem) result(x)
      type(law_problem_t), intent(in) :: problem
      !> Logarithms of the free parameters
      real(wp) :: x(size(problem%free))

      x = log(max(problem%parameters(problem%free)%value, small*problem%unit(problem%free)))
      x = max(problem%lower, min(problem%upper, x))
   end function unknowns_of

   !> The material with the given values of the parameters
   pure function described(problem, values) result(data)
      class(law_problem_t), intent(in) :: problem
      !> Values of all parameters
      real(wp), intent(in) :: values(:)
      type(material_data_t) :: data

      integer :: i

      data%name = problem%model
      data%model = problem%model
      do i = 1, size(values)
         call data%set(trim(problem%parameters(i)%name), values(i))
      end do
      ! keep the rubbery modulus at or below the glassy one
      if (problem%model == 'sls') &
         call data%set('alpha', min(data%number('alpha'), data%number('beta')))
   end function described

   !> Residuals: logarithms of model over data
   subroutine residuals(self, x, r)
      class(law_problem_t), intent(in) :: self
      !> Logarithms of the free parameters
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: r(:)

      real(wp) :: values(size(self%parameters))

      values = self%parameters%value
      values(self%free) = exp(x)
      r = misfit(self, values)
   end subroutine residuals

   !> Logarithms of model over data
   function misfit(problem, values) result(r)
      class(law_problem_t), intent(in) :: problem
      !> Values of all parameters
      real(wp), intent(in) :: values(:)
      real(wp) :: r(problem%samples%count())

      !> Residual where the model does not exist
      real(wp), parameter :: far_off = 1.0e3_wp
      class(material_t), allocatable :: material
      type(error_t), allocatable :: error

      call new_material(material, described(problem, values), error)
      if (allocated(error)) then
         r = far_off
      else
         r = log(max(moduli_of(material, problem%samples), tiny(1.0_wp))) &
            - log(problem%samples%all())
      end if
   end function misfit

   !> Derivatives of the residuals, by central differences
   subroutine jacobian(self, x, j)
      class(law_problem_t), intent(in) :: self
      !> Logarithms of the free parameters
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: j(:, :)

      real(wp) :: up(size(x)), down(size(x)), r(size(j, 1))
      integer :: i

      do i = 1, size(x)
         up = x
         down = x
         up(i) = min(x(i) + step, self%upper(i))
         down(i) = max(x(i) - step, self%lower(i))
         call self%residuals(up, j(:, i))
         call self%residuals(down, r)
         j(:, i) = (j(:, i) - r)/(up(i) - down(i))
      end do
   end subroutine jacobian

   !> Starts of the iteration: the local minima of a scan over all shapes, the lowest first
   subroutine find_starts(problem, starts)
      type(law_problem_t), intent(in) :: problem
      !> Values of all parameters, shape (parameters, starts)
      real(wp), allocatable, intent(out) :: starts(:, :)

      real(wp), allocatable :: times(:), powers(:), cost(:, :), values(:, :, :)
      logical, allocatable :: lowest(:, :)
      integer :: i, k, place(2)

      call get_scan(problem, times, powers)
      allocate (cost(0:size(times) + 1, 0:size(powers) + 1), source=huge(1.0_wp))
      allocate (values(size(problem%parameters), size(times), size(powers)))
      do k = 1, size(powers)
         do i = 1, size(times)
            call scan_shape(problem, times(i), powers(k), values(:, i, k), cost(i, k))
         end do
      end do
      allocate (lowest(size(times), size(powers)))
      do k = 1, size(powers)
         do i = 1, size(times)
            lowest(i, k) = cost(i, k) < huge(1.0_wp) &
               .and. cost(i, k) <= minval(cost(i - 1:i + 1, k - 1:k + 1))
         end do
      end do
      allocate (starts(size(problem%parameters), min(most_starts, count(lowest))))
      do i = 1, size(starts, 2)
         place = minloc(cost(1:size(times), 1:size(powers)), mask=lowest)
         lowest(place(1), place(2)) = .false.
         starts(:, i) = values(:, place(1), place(2))
      end do
   end subroutine find_starts

   !> Whether a parameter is the time of the shape, as a time or a rate
   elemental function is_time(parameter) result(yes)
      type(parameter_t), intent(in) :: parameter
      logical :: yes

      yes = parameter%scale /= linear .and. abs(power_of_time(parameter%unit)) > 0.0_wp
   end function is_time

   !> Whether the shape of a model consists of a time and an exponent
   pure function has_two_shapes(problem) result(yes)
      type(law_problem_t), intent(in) :: problem
      logical :: yes

      yes = any(is_time(problem%stated)) .and. any(problem%stated%unit == '')
   end function has_two_shapes

   !> Times and exponents of the scan: a single one if it is fixed, or if the model has none
   pure subroutine get_scan(problem, times, powers)
      type(law_problem_t), intent(in) :: problem
      !> Times [s]
      real(wp), allocatable, intent(out) :: times(:)
      !> Exponents [-]
      real(wp), allocatable, intent(out) :: powers(:)

      real(wp) :: first, last
      integer :: i, k, n

      times = [1.0_wp]
      powers = [1.0_wp]
      first = problem%samples%first_time()/scan_margin
      last = problem%samples%last_time()*scan_margin
      n = 1 + ceiling(per_decade*log10(last/first))
      do i = 1, size(problem%parameters)
         associate (parameter => problem%parameters(i), is_fixed => problem%parameters(i)%state &
                    == state_fixed)
            if (problem%stated(i)%unit == '') then
               powers = exponents
               if (is_fixed) powers = [parameter%value]
            else if (is_time(problem%stated(i))) then
               times = first*(last/first)**([(real(k, wp), k=0, n - 1)]/real(n - 1, wp))
               if (is_fixed) times = [parameter%value]
               if (is_fixed .and. parameter%unit /= 's') times = 1.0_wp/times
               if (is_fixed .and. parameter%unit == 's^-1/2') times = times**2
            end if
         end associate
      end do
   end subroutine get_scan

   !> Best moduli for one shape, and the remaining cost
   subroutine scan_shape(problem, time, power, values, cost)
      type(law_problem_t), intent(in) :: problem
      !> Time of the shape [s]
      real(wp), intent(in) :: time
      !> Exponent of the shape
      real(wp), intent(in) :: power
      !> Values of all parameters
      real(wp), intent(out) :: values(:)
      !> Sum of the squares of the residuals
      real(wp), intent(out) :: cost

      !> Fraction of the smallest datum at which a modulus that is not needed starts
      real(wp), parameter :: small = 1.0e-3_wp
      class(material_t), allocatable :: material
      type(error_t), allocatable :: error
      real(wp) :: a(problem%samples%count(), 2), b(problem%samples%count()), modulus(2)
      real(wp) :: shape(size(values))
      integer :: i

      cost = huge(cost)
      do i = 1, size(values)
         associate (stated => problem%stated(i))
            shape(i) = merge(power, 1.0_wp, stated%unit == '')
            if (stated%scale == linear) shape(i) = 0.0_wp
            if (.not. is_time(stated)) cycle
            shape(i) = time
            if (stated%unit /= 's') shape(i) = 1.0_wp/time
            if (stated%unit == 's^-1/2') shape(i) = sqrt(shape(i))
         end associate
      end do
      values = 0.0_wp
      call new_material(material, described(problem, shape), error)
      if (allocated(error)) return
      a(:, 2) = moduli_of(material, problem%samples)/problem%samples%all()
      a(:, 1) = 0.0_wp
      a(:size(problem%samples%modulus), 1) = 1.0_wp/problem%samples%modulus
      b = 1.0_wp
      ! the two moduli of sls are a sum and a quotient of parameters
      do i = 1, 2
         if (problem%model == 'sls' .or. problem%parameters(i)%state /= state_fixed) cycle
         b = b - problem%parameters(i)%value*a(:, i)
         a(:, i) = 0.0_wp
      end do
      call solve_nnls(a, b, modulus)
      modulus = max(modulus, small*minval(problem%samples%modulus))

      values = shape
      do i = 1, size(values)
         select case (problem%parameters(i)%name)
         case ('equilibrium_modulus')
            values(i) = modulus(1)
         case ('relaxing_modulus', 'coefficient')
            values(i) = modulus(2)
         case ('glassy_modulus')
            values(i) = sum(modulus)
         case ('alpha')
            values(i) = modulus(1)/sum(modulus)/time
         case default
            continue
         end select
      end do
      where (problem%parameters%state == state_fixed) values = problem%parameters%value
      cost = sum(misfit(problem, values)**2)
   end subroutine scan_shape

end module vcor_fit_law
