!> A Prony series as a problem of least squares in the logarithms of its moduli and rates, which
!> keeps all of them positive
module vcor_fit_prony_problem
   use vcor_kinds, only : wp
   use vcor_fit_samples, only : samples_t
   use vcor_numeric_least_squares, only : least_squares_t, minimise
   use vcor_numeric_nnls, only : solve_nnls
   implicit none
   private

   public :: series_t, series_problem_t, new_series_problem, response, solve_moduli, refine
   public :: slowest_rate, fastest_rate

   !> Largest rate times the first time of the samples, smallest rate times the last one. A term
   !> beyond would be seen by one sample only: its modulus would be the noise of that sample times
   !> the exponential of this number
   real(wp), parameter :: fastest = 4.0_wp, slowest = 0.25_wp
   !> The same for frequencies, of which a term is seen further away: like 1/x
   real(wp), parameter :: fastest_seen = 30.0_wp, slowest_seen = 0.03_wp
   !> Range of a modulus beyond that of the samples, as a factor
   real(wp), parameter :: softest = 1.0e-8_wp, hardest = 1.0e4_wp
   !> Part of the smallest modulus below which the equilibrium modulus counts as 0
   real(wp), parameter :: nothing = 1.0e-6_wp
   !> Part of the smallest modulus that an equilibrium modulus starts from at least
   real(wp), parameter :: seed = 1.0e-2_wp
   !> What stands for a modulus of 0, whose logarithm is taken
   real(wp), parameter :: least_modulus = 1.0e-200_wp

   !> A series and how well it fits
   type :: series_t
      !> Equilibrium modulus [Pa], >= 0
      real(wp) :: equilibrium = 0.0_wp
      !> Moduli of the terms [Pa], > 0, shape (n)
      real(wp), allocatable :: moduli(:)
      !> Logarithms of their rates [ln 1/s], increasing, shape (n)
      real(wp), allocatable :: rates(:)
      !> Logarithms of model over data, shape (count)
      real(wp), allocatable :: residuals(:)
      !> Whether the iteration has ended at a solution
      logical :: converged = .false.
   end type series_t

   !> The problem for MINPACK: the unknowns are the logarithms of the equilibrium modulus, if that
   !> is free, of the moduli and of the rates
   type, extends(least_squares_t) :: series_problem_t
      !> The samples
      type(samples_t) :: samples
      !> Their moduli as one list [Pa]
      real(wp), allocatable :: data(:)
      !> Equilibrium modulus where it is not free [Pa]
      real(wp) :: equilibrium = 0.0_wp
      !> Whether it is
      logical :: is_free = .false.
   contains
      procedure :: residuals
      procedure :: jacobian
   end type series_problem_t

contains

   !> Logarithm of the smallest rate of a term
   pure function slowest_rate(samples) result(rate)
      !> The samples
      type(samples_t), intent(in) :: samples
      !> The logarithm
      real(wp) :: rate

      rate = log(merge(slowest_seen, slowest, samples%dynamic)/samples%last_time())
   end function slowest_rate

   !> Logarithm of the largest rate of a term
   pure function fastest_rate(samples) result(rate)
      !> The samples
      type(samples_t), intent(in) :: samples
      !> The logarithm
      real(wp) :: rate

      rate = log(merge(fastest_seen, fastest, samples%dynamic)/samples%first_time())
   end function fastest_rate

   !> Moduli of a term of modulus 1 where there are samples: exp(-l t), or with x = omega/l
   !> x^2/(1 + x^2) and x/(1 + x^2)
   pure function response(samples, rate) result(moduli)
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Logarithm of the rate l
      real(wp), intent(in) :: rate
      !> Moduli, shape (count)
      real(wp) :: moduli(samples%count())

      integer :: n

      n = size(samples%at)
      if (samples%dynamic) then
         associate (x => samples%at*exp(-rate))
            moduli(:n) = x**2/(1.0_wp + x**2)
            moduli(n + 1:) = x/(1.0_wp + x**2)
         end associate
      else
         moduli = exp(-exp(rate)*samples%at)
      end if
   end function response

   !> Moduli of terms with given rates, by non-negative least squares of the relative misfits
   subroutine solve_moduli(samples, fixed, rates, equilibrium, moduli)
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: to be found
      real(wp), intent(in) :: fixed
      !> Logarithms of the rates, shape (n)
      real(wp), intent(in) :: rates(:)
      !> Equilibrium modulus [Pa]
      real(wp), intent(out) :: equilibrium
      !> Moduli of the terms [Pa], >= 0, shape (n)
      real(wp), intent(out) :: moduli(:)

      real(wp) :: a(samples%count(), 0:size(rates)), b(samples%count()), x(0:size(rates))
      integer :: k

      associate (data => samples%all())
         a(:, 0) = 0.0_wp
         a(:size(samples%modulus), 0) = 1.0_wp/samples%modulus
         do k = 1, size(rates)
            a(:, k) = response(samples, rates(k))/data
         end do
      end associate
      b = 1.0_wp
      if (fixed >= 0.0_wp) then
         b = b - fixed*a(:, 0)
         a(:, 0) = 0.0_wp
      end if
      call solve_nnls(a, b, x)
      equilibrium = x(0)
      if (fixed >= 0.0_wp) equilibrium = fixed
      moduli = x(1:)
   end subroutine solve_moduli

   !> Make a problem of a number of terms
   pure function new_series_problem(samples, terms, equilibrium, is_free) result(problem)
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Number of terms
      integer, intent(in) :: terms
      !> Equilibrium modulus [Pa]
      real(wp), intent(in) :: equilibrium
      !> Whether it is free
      logical, intent(in) :: is_free
      !> The problem
      type(series_problem_t) :: problem

      integer :: first

      problem%samples = samples
      problem%data = samples%all()
      problem%equilibrium = equilibrium
      problem%is_free = is_free
      first = merge(1, 0, is_free) + terms + 1
      allocate (problem%lower(first + terms - 1), problem%upper(first + terms - 1))
      problem%lower = log(softest*minval(problem%data))
      problem%upper = log(hardest*maxval(problem%data))
      problem%lower(first:) = slowest_rate(samples)
      problem%upper(first:) = fastest_rate(samples)
   end function new_series_problem

   !> Refine a series: all moduli and rates at once
   subroutine refine(series, samples, fixed, tolerance, most)
      !> The series, on return ordered
      type(series_t), intent(inout) :: series
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: to be found
      real(wp), intent(in) :: fixed
      !> Reduction of the sum of squares that counts as none
      real(wp), intent(in) :: tolerance
      !> Most evaluations
      integer, intent(in) :: most

      type(series_problem_t) :: problem
      real(wp), allocatable :: x(:)
      integer :: n, first

      n = size(series%rates)
      if (.not. allocated(series%residuals)) allocate (series%residuals(samples%count()))
      problem = new_series_problem(samples, n, series%equilibrium, &
         fixed < 0.0_wp)
      first = merge(1, 0, problem%is_free)
      allocate (x(first + 2*n))
      ! least squares for given rates may do without a modulus that the refinement needs
      if (problem%is_free) x(1) = log(max(series%equilibrium, seed*minval(samples%modulus)))
      x(first + 1:first + n) = log(series%moduli)
      x(first + n + 1:) = series%rates
      call minimise(problem, x, series%residuals, series%converged, tolerance, most)
      if (problem%is_free) series%equilibrium = exp(x(1))
      series%moduli = exp(x(first + 1:first + n))
      series%rates = x(first + n + 1:)
      call order(series)
      if (.not. problem%is_free) return
      if (series%equilibrium > nothing*minval(samples%modulus)) return
      series%equilibrium = 0.0_wp
      problem = new_series_problem(samples, n, 0.0_wp, .false.)
      x = [log(series%moduli), series%rates]
      call minimise(problem, x, series%residuals, series%converged, tolerance, most)
      series%moduli = exp(x(:n))
      series%rates = x(n + 1:)
      call order(series)
   end subroutine refine

   !> Put the terms of a series in the order of their rates
   pure subroutine order(series)
      !> The series
      type(series_t), intent(inout) :: series

      real(wp) :: rate, modulus
      integer :: i, k

      do i = 2, size(series%rates)
         rate = series%rates(i)
         modulus = series%moduli(i)
         do k = i - 1, 1, -1
            if (series%rates(k) <= rate) exit
            series%rates(k + 1) = series%rates(k)
            series%moduli(k + 1) = series%moduli(k)
         end do
         series%rates(k + 1) = rate
         series%moduli(k + 1) = modulus
      end do
   end subroutine order

   !> Residuals: logarithms of model over data
   subroutine residuals(self, x, r)
      !> The problem
      class(series_problem_t), intent(in) :: self
      !> Unknowns
      real(wp), intent(in) :: x(:)
      !> Residuals
      real(wp), intent(out) :: r(:)

      integer :: k, n, first

      first = merge(1, 0, self%is_free)
      n = (size(x) - first)/2
      r = 0.0_wp
      r(:size(self%samples%at)) = self%equilibrium
      if (self%is_free) r(:size(self%samples%at)) = exp(x(1))
      do k = 1, n
         r = r + exp(x(first + k))*response(self%samples, x(first + n + k))
      end do
      r = log(max(r, least_modulus)/self%data)
   end subroutine residuals

   !> Derivatives of the residuals. By ln l: -l t exp(-l t), -2 x^2/(1 + x^2)^2 and
   !> -x (1 - x^2)/(1 + x^2)^2
   subroutine jacobian(self, x, j)
      !> The problem
      class(series_problem_t), intent(in) :: self
      !> Unknowns
      real(wp), intent(in) :: x(:)
      !> Derivatives
      real(wp), intent(out) :: j(:, :)

      real(wp) :: model(size(j, 1)), term(size(j, 1))
      integer :: i, k, n, m, first

      first = merge(1, 0, self%is_free)
      n = (size(x) - first)/2
      m = size(self%samples%at)
      call self%residuals(x, model)
      model = self%data*exp(model)
      if (self%is_free) then
         j(:, 1) = 0.0_wp
         j(:m, 1) = exp(x(1))/model(:m)
      end if
      do k = 1, n
         term = exp(x(first + k))*response(self%samples, x(first + n + k))/model
         j(:, first + k) = term
         if (self%samples%dynamic) then
            do i = 1, m
               associate (y => self%samples%at(i)*exp(-x(first + n + k)))
                  j(i, first + n + k) = -2.0_wp*term(i)/(1.0_wp + y**2)
                  j(m + i, first + n + k) = -term(m + i)*(1.0_wp - y**2)/(1.0_wp + y**2)
               end associate
            end do
         else
            j(:, first + n + k) = -exp(x(first + n + k))*self%samples%at*term
         end if
      end do
   end subroutine jacobian

end module vcor_fit_prony_problem
