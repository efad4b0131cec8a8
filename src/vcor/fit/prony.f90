!> Fit of a Prony series with a given number of terms, or with as many as the data support
!>
!> First non-negative least squares finds the moduli of rates on a fine logarithmic grid; few of
!> them are not zero. A relaxation time between two rates of the grid appears at both, so neighbours
!> are merged. Then moduli and rates are refined together, from two starts: the merged spectrum, and
!> rates in equal logarithmic steps: a least-squares problem in their logarithms, which keeps all of
!> them positive.
!>
!> As many terms as the data support: terms are added until the largest misfit is below the accuracy
!> of any data, or while they reduce the Bayesian information criterion m ln(S/m) + p ln m of m
!> moduli, p parameters and the sum of squares S (G. Schwarz, Ann. Stat. 6 (1978) 461). In noisy
!> data it stops before terms follow the noise.
module vcor_fit_prony
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material, only : material_t, new_material
   use vcor_fit_result, only : estimate_t, fit_t, judge, mark_ends, set_errors, state_bound, &
      state_fixed
   use vcor_fit_samples, only : samples_t
   use vcor_numeric_least_squares, only : least_squares_t, minimise
   use vcor_numeric_nnls, only : solve_nnls
   implicit none
   private

   public :: fit_prony

   !> Rates per decade on the grid of the spectrum
   real(wp), parameter :: per_decade = 8.0_wp
   !> Largest misfit that is below the accuracy of any data
   real(wp), parameter :: good_enough = 5.0e-4_wp
   !> Factor above `good_enough` from which refinement may still reach it
   real(wp), parameter :: within_reach = 4.0_wp
   !> Smallest number of terms of a series whose rates are a start for another number
   integer, parameter :: min_guide = 4
   !> If one more term reduces the residual to this fraction, the data are a series of that number
   real(wp), parameter :: completion = 1.0e-3_wp
   !> Unsuccessful steps that end the search: a single one may be due to a poor start
   integer, parameter :: most_failures = 2
   !> Misfit with more terms over that with fewer above which the iteration may have stopped early
   real(wp), parameter :: stalled = 0.7_wp
   !> Factor by which the initial rates extend beyond the data
   real(wp), parameter :: margin = 4.0_wp
   !> Largest number of terms
   integer, parameter :: most_terms = 60
   !> Largest number of terms per decade of the data, plus a few: t^-1/2 to 0.05 % takes 2.3
   real(wp), parameter :: terms_per_decade = 3.0_wp
   integer, parameter :: extra_terms = 5
   !> Relative reduction of the sum of squares that ends an iteration, in the search and at the end
   real(wp), parameter :: coarse = 1.0e-3_wp, fine = 1.0e-7_wp
   !> Maximum number of evaluations in the search and at the end
   integer, parameter :: first_patience = 60, last_patience = 300
   !> Initial modulus of a term that least squares leaves out, over the largest modulus
   real(wp), parameter :: initial_fraction = 1.0e-3_wp
   !> Modulus over the smallest of the samples below which a term, or equilibrium, counts as absent
   real(wp), parameter :: negligible = 1.0e-6_wp

   !> Largest rate times the first time of the samples, and smallest rate times the last one. Only
   !> one sample would show a term beyond: the modulus would be the noise of that sample times the
   !> exponential of this number
   real(wp), parameter :: fastest = 4.0_wp, slowest = 0.25_wp
   !> The same for frequencies, which show a term farther away: it decays only as 1/x
   real(wp), parameter :: fastest_seen = 30.0_wp, slowest_seen = 0.03_wp
   !> Factors by which a modulus may lie below and above those of the samples
   real(wp), parameter :: softest = 1.0e-8_wp, hardest = 1.0e4_wp
   !> Smallest initial equilibrium modulus over the smallest modulus of the samples
   real(wp), parameter :: seed = 1.0e-2_wp
   !> Replaces a modulus of 0 in logarithms [Pa]
   real(wp), parameter :: least_modulus = 1.0e-200_wp

   !> A Prony series and its misfit to samples; the unknowns of the problem are the logarithms of
   !> the equilibrium modulus, if it is free, of the moduli and of the rates
   type, extends(least_squares_t) :: series_t
      type(samples_t) :: samples
      !> Their moduli as one list [Pa]
      real(wp), allocatable :: data(:)
      !> Fixed equilibrium modulus [Pa]; negative: fitted
      real(wp) :: given = -1.0_wp
      !> Whether the equilibrium modulus is an unknown
      logical :: is_free = .false.
      !> Equilibrium modulus [Pa], >= 0
      real(wp) :: equilibrium = 0.0_wp
      !> Moduli of the terms [Pa], > 0, shape (n)
      real(wp), allocatable :: moduli(:)
      !> Logarithms of their rates [ln 1/s], increasing, shape (n)
      real(wp), allocatable :: rates(:)
      !> Logarithms of model over data, shape (count)
      real(wp), allocatable :: misfits(:)
      !> Whether the iteration has converged
      logical :: converged = .false.
   contains
      procedure :: residuals
      procedure :: jacobian
   end type series_t

contains

   !> Fit a Prony series
   subroutine fit_prony(fit, terms, given, samples, error)
      type(fit_t), intent(out) :: fit
      !> Number of terms; 0: as many as the data support
      integer, intent(in) :: terms
      !> Equilibrium modulus [Pa]; negative: fitted
      real(wp), intent(in) :: given
      type(samples_t), intent(in) :: samples
      !> Error of code `error_numerical` if there is no solution, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(series_t) :: series, spectrum
      integer :: n

      call find_spectrum(spectrum, samples, given)
      if (terms > 0) then
         call fit_terms(series, terms, spectrum, last_patience)
      else
         call search(series, spectrum)
         call shorten(series, spectrum)
      end if
      n = size(series%rates)
      do
         call refine(series, fine, last_patience)
         if (terms == 0) call prune(series)
         if (series%converged) then
            call conclude(fit, series, error)
         else
            call raise(error, error_numerical, 'the fit of a Prony series does not converge: ' &
               //'give another number of terms with --terms')
         end if
         ! the data may not support the term found last: try one term fewer
         if (.not. allocated(error) .or. terms > 0 .or. n == 1) exit
         n = n - 1
         spectrum = series
         call fit_terms(series, n, spectrum, last_patience)
      end do
   end subroutine fit_prony

   !> Remove terms while the series stays good enough: the search compares unfinished iterations
   subroutine shorten(series, spectrum)
      type(series_t), intent(inout) :: series
      type(series_t), intent(in) :: spectrum

      type(series_t) :: trial

      do while (is_good(series) .and. size(series%rates) > 1)
         call fit_terms(trial, size(series%rates) - 1, spectrum, last_patience, series)
         call refine(trial, fine, last_patience)
         if (.not. is_good(trial)) exit
         ! the data are a series of this number of terms
         if (norm2(series%misfits) < completion*norm2(trial%misfits)) exit
         series = trial
      end do
   end subroutine shorten

   !> Remove terms whose moduli the refinement has made negligible
   subroutine prune(series)
      type(series_t), intent(inout) :: series

      logical :: needed(size(series%rates))

      needed = series%moduli > negligible*minval(series%samples%modulus)
      if (all(needed) .or. .not. any(needed)) return
      series%rates = pack(series%rates, needed)
      series%moduli = pack(series%moduli, needed)
      call refine(series, fine, last_patience)
   end subroutine prune

   !> Spectrum on a grid, with neighbours merged
   subroutine find_spectrum(spectrum, samples, given)
      type(series_t), intent(out) :: spectrum
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: fitted
      real(wp), intent(in) :: given

      real(wp) :: width
      integer :: i, n

      spectrum = new_series(samples, given)
      associate (first => slowest_rate(samples), last => fastest_rate(samples))
         n = 1 + ceiling((last - first)/log(10.0_wp)*per_decade)
         width = (last - first)/real(n - 1, wp)
         call solve_moduli(spectrum, first + width*[(real(i, wp), i=0, n - 1)])
      end associate
      spectrum%rates = pack(spectrum%rates, spectrum%moduli > 0.0_wp)
      spectrum%moduli = pack(spectrum%moduli, spectrum%moduli > 0.0_wp)
      do while (size(spectrum%rates) > 1)
         n = closest(spectrum%rates)
         if (spectrum%rates(n + 1) - spectrum%rates(n) > 1.5_wp*width) exit
         call merge_terms(spectrum, n)
      end do
   end subroutine find_spectrum

   !> Index of the rate that is closest to the next one
   pure function closest(rates) result(n)
      !> Logarithms of rates, increasing
      real(wp), intent(in) :: rates(:)
      integer :: n

      n = minloc(rates(2:) - rates(:size(rates) - 1), dim=1)
   end function closest

   !> Merge two neighbouring terms
   pure subroutine merge_terms(series, n)
      type(series_t), intent(inout) :: series
      !> Index of the first of the two
      integer, intent(in) :: n

      associate (rates => series%rates, moduli => series%moduli)
         rates(n) = (rates(n)*moduli(n) + rates(n + 1)*moduli(n + 1))/(moduli(n) + moduli(n + 1))
         moduli(n) = moduli(n) + moduli(n + 1)
      end associate
      series%rates = [series%rates(:n), series%rates(n + 2:)]
      series%moduli = [series%moduli(:n), series%moduli(n + 2:)]
   end subroutine merge_terms

   !> Fit a given number of terms, from both starts
   subroutine fit_terms(series, terms, spectrum, most, guide)
      !> The better series
      type(series_t), intent(out) :: series
      integer, intent(in) :: terms
      type(series_t), intent(in) :: spectrum
      !> Maximum number of evaluations
      integer, intent(in) :: most
      !> A series of another number of terms, whose rates are a better start than equal steps
      type(series_t), intent(in), optional :: guide

      type(series_t) :: other
      integer :: i

      series = new_series(spectrum%samples, spectrum%given)
      if (present(guide)) then
         call start_from(series, spread_rates(guide%rates, terms))
      else
         ! equal steps over the band of the data and slightly beyond, half a step from the ends
         associate (first => log(1.0_wp/(margin*series%samples%last_time())), &
            last => log(margin/series%samples%first_time()))
            call start_from(series, first + (last - first)*[(real(2*i - 1, wp), i=1, terms)] &
               /real(2*terms, wp))
         end associate
      end if
      call refine(series, coarse, most)
      if (size(spectrum%rates) < terms) return
      other = spectrum
      do while (size(other%rates) > terms)
         call merge_terms(other, closest(other%rates))
      end do
      call start_from(other, (other%rates))
      call refine(other, coarse, most)
      if (norm2(other%misfits) < norm2(series%misfits)) series = other
   end subroutine fit_terms

   !> Rates with the same distribution for another number of terms
   pure function spread_rates(rates, terms) result(others)
      !> Logarithms of rates, increasing, shape (n), n >= 2
      real(wp), intent(in) :: rates(:)
      integer, intent(in) :: terms
      !> Logarithms of the new rates, shape (terms)
      real(wp) :: others(terms)

      real(wp) :: place
      integer :: i, k

      do i = 1, terms
         ! terms are in the middle of equal parts of the spectrum
         place = 0.5_wp + (real(i, wp) - 0.5_wp)*real(size(rates), wp)/real(terms, wp)
         k = max(1, min(size(rates) - 1, int(place)))
         others(i) = rates(k) + (place - real(k, wp))*(rates(k + 1) - rates(k))
      end do
   end function spread_rates

   !> Set the rates at the start of an iteration, and moduli that are not 0
   subroutine start_from(series, rates)
      type(series_t), intent(inout) :: series
      !> Logarithms of the rates
      real(wp), intent(in) :: rates(:)

      call solve_moduli(series, rates)
      series%moduli = max(series%moduli, &
         initial_fraction*max(maxval(series%moduli), minval(series%samples%modulus)))
   end subroutine start_from

   !> Search the number of terms: with growing steps while they succeed, then with halved steps
   subroutine search(series, spectrum)
      type(series_t), intent(out) :: series
      type(series_t), intent(in) :: spectrum

      type(series_t) :: trial
      real(wp) :: best
      integer :: n, most, width, failures
      logical :: better

      associate (samples => spectrum%samples)
         most = min(most_terms, (samples%count() - 2)/2, extra_terms &
            + ceiling(terms_per_decade*log10(samples%last_time()/samples%first_time())))
      end associate
      best = huge(best)
      failures = 0
      n = 1
      do
         call try_terms(n, better)
         failures = merge(0, failures + 1, better)
         if (n == most .or. failures == most_failures) exit
         if (is_good(series)) exit
         n = min(most, n + 1 + n/4)
      end do
      width = 1 + size(series%rates)/4
      do while (width > 1)
         width = (width + 1)/2
         n = size(series%rates)
         call try_terms(n - width, better)
         if (.not. better .and. .not. is_good(series)) call try_terms(n + width, better)
         if (width == 2 .and. .not. better) exit
      end do
      do
         call try_terms(size(series%rates) - 1, better)
         if (.not. better) exit
      end do
      ! one more term shows whether the data are a series of that number
      if (size(series%rates) == most) return
      call fit_terms(trial, size(series%rates) + 1, spectrum, first_patience)
      if (norm2(trial%misfits) < completion*norm2(series%misfits)) series = trial

   contains

      !> Try a number of terms
      subroutine try_terms(terms, better)
         integer, intent(in) :: terms
         !> Whether it is the best one so far
         logical, intent(out) :: better

         real(wp) :: value
         logical :: guided, look

         better = .false.
         if (terms < 1 .or. terms > most) return
         guided = allocated(series%rates)
         if (guided) guided = size(series%rates) >= min_guide
         if (guided) then
            call fit_terms(trial, terms, spectrum, first_patience, series)
         else
            call fit_terms(trial, terms, spectrum, first_patience)
         end if
         ! refine further if the series is nearly good enough, has one term fewer, or has more terms
         ! and hardly a smaller misfit, so that its iteration may have stopped early
         look = maxval(abs(trial%misfits)) <= within_reach*good_enough
         if (allocated(series%rates)) look = look .or. terms == size(series%rates) - 1 .or. &
            (terms > size(series%rates) &
            .and. norm2(trial%misfits) > stalled*norm2(series%misfits))
         if (look .and. .not. is_good(trial)) call refine(trial, fine, last_patience)
         value = criterion(trial)
         ! among series that are good enough the shortest is best
         if (is_good(trial)) value = -0.5_wp*huge(value)*(1.0_wp - 1.0e-3_wp*real(terms, wp))
         better = value < best
         if (.not. better) return
         best = value
         series = trial
      end subroutine try_terms
   end subroutine search

   !> Whether a series is as accurate as any data
   pure function is_good(series) result(yes)
      type(series_t), intent(in) :: series
      logical :: yes

      yes = maxval(abs(series%misfits)) <= good_enough
   end function is_good

   !> Bayesian information criterion
   pure function criterion(series) result(value)
      type(series_t), intent(in) :: series
      real(wp) :: value

      real(wp) :: m, p

      m = real(size(series%misfits), wp)
      p = real(2*size(series%rates) + 1, wp)
      value = m*log(max(sum(series%misfits**2)/m, epsilon(m)**2)) + p*log(m)
   end function criterion

   !> Build the fit from a series: parameters, misfit, standard errors
   subroutine conclude(fit, found, error)
      type(fit_t), intent(out) :: fit
      type(series_t), intent(in) :: found
      !> Error of code `error_numerical` if the data do not determine the terms
      type(error_t), allocatable, intent(out) :: error

      real(wp), parameter :: touch = 1.0e-5_wp
      type(series_t) :: series
      class(material_t), allocatable :: material
      integer, allocatable :: free(:)
      real(wp), allocatable :: x(:)
      integer :: i, n

      n = size(found%rates)
      ! the fastest term first
      series = found
      series%moduli = found%moduli(n:1:-1)
      series%rates = found%rates(n:1:-1)
      fit%data%name = 'prony'
      fit%data%model = 'prony'
      call fit%data%set('equilibrium_modulus', series%equilibrium)
      call fit%data%set_list('moduli', series%moduli)
      call fit%data%set_list('rates', exp(series%rates))
      allocate (fit%parameters(2*n + 1))
      fit%parameters(1) = estimate_t('equilibrium_modulus', 'Pa', series%equilibrium)
      if (series%given >= 0.0_wp) then
         fit%parameters(1)%state = state_fixed
      else if (.not. series%equilibrium > 0.0_wp) then
         fit%parameters(1)%state = state_bound
      end if
      do i = 1, n
         fit%parameters(2*i) = estimate_t('moduli', 'Pa', series%moduli(i))
         fit%parameters(2*i + 1) = estimate_t('times', 's', exp(-series%rates(i)))
      end do

      call new_material(material, fit%data, error)
      if (allocated(error)) return
      call judge(fit, material, series%samples)
      call set_bounds(series, series%given < 0.0_wp)
      x = unknowns_of(series, negligible)
      free = [(2*i, i=1, n), (2*i + 1, i=1, n)]
      if (series%is_free) free = [1, free]
      where (x < series%lower + touch .or. x > series%upper - touch) &
         fit%parameters(free)%state = state_bound
      if (any(series%moduli <= negligible*minval(series%samples%modulus))) then
         call raise(error, error_numerical, 'the data do not support so many terms: take fewer, ' &
            //'or leave --terms out')
         return
      end if
      call set_errors(fit, series, x, series%misfits, free, size(series%samples%at), error)
      if (.not. allocated(error)) call mark_ends(fit, material, series%samples)
   end subroutine conclude

   !> A series without terms
   pure function new_series(samples, given) result(series)
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: fitted
      real(wp), intent(in) :: given
      type(series_t) :: series

      series%samples = samples
      series%data = samples%all()
      series%given = given
   end function new_series

   !> Logarithm of the smallest rate of a term
   pure function slowest_rate(samples) result(rate)
      type(samples_t), intent(in) :: samples
      real(wp) :: rate

      rate = log(merge(slowest_seen, slowest, samples%dynamic)/samples%last_time())
   end function slowest_rate

   !> Logarithm of the largest rate of a term
   pure function fastest_rate(samples) result(rate)
      type(samples_t), intent(in) :: samples
      real(wp) :: rate

      rate = log(merge(fastest_seen, fastest, samples%dynamic)/samples%first_time())
   end function fastest_rate

   !> Response of a term of modulus 1 at the samples: exp(-l t), or, with x = omega/l, x^2/(1 + x^2)
   !> and x/(1 + x^2)
   pure function response(samples, rate) result(moduli)
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

   !> Set the rates, and the moduli by non-negative least squares of the relative misfits
   subroutine solve_moduli(series, rates)
      !> The series; on return its moduli are >= 0
      type(series_t), intent(inout) :: series
      !> Logarithms of the rates, shape (n)
      real(wp), intent(in) :: rates(:)

      real(wp) :: a(size(series%data), 0:size(rates)), b(size(series%data)), x(0:size(rates))
      integer :: k

      a(:, 0) = 0.0_wp
      a(:size(series%samples%modulus), 0) = 1.0_wp/series%samples%modulus
      do k = 1, size(rates)
         a(:, k) = response(series%samples, rates(k))/series%data
      end do
      b = 1.0_wp
      if (series%given >= 0.0_wp) then
         b = b - series%given*a(:, 0)
         a(:, 0) = 0.0_wp
      end if
      call solve_nnls(a, b, x)
      series%equilibrium = merge(series%given, x(0), series%given >= 0.0_wp)
      series%rates = rates
      series%moduli = x(1:)
   end subroutine solve_moduli

   !> Set the number of unknowns, and their bounds
   pure subroutine set_bounds(self, is_free)
      class(series_t), intent(inout) :: self
      !> Whether the equilibrium modulus is an unknown
      logical, intent(in) :: is_free

      integer :: n, first

      self%is_free = is_free
      n = size(self%rates)
      first = merge(1, 0, is_free) + n + 1
      if (allocated(self%lower)) deallocate (self%lower, self%upper)
      allocate (self%lower(first + n - 1), source=log(softest*minval(self%data)))
      allocate (self%upper(first + n - 1), source=log(hardest*maxval(self%data)))
      self%lower(first:) = slowest_rate(self%samples)
      self%upper(first:) = fastest_rate(self%samples)
   end subroutine set_bounds

   !> Unknowns of a series
   pure function unknowns_of(series, least) result(x)
      type(series_t), intent(in) :: series
      !> Smallest equilibrium modulus over the smallest modulus of the samples
      real(wp), intent(in) :: least
      real(wp), allocatable :: x(:)

      x = [log(series%moduli), series%rates]
      if (series%is_free) &
         x = [log(max(series%equilibrium, least*minval(series%samples%modulus))), x]
   end function unknowns_of

   !> Refine all moduli and rates together, and sort the terms by their rates
   subroutine refine(series, tolerance, most)
      type(series_t), intent(inout) :: series
      !> Relative reduction of the sum of squares that ends the iteration
      real(wp), intent(in) :: tolerance
      !> Maximum number of evaluations
      integer, intent(in) :: most

      call iterate(series, series%given < 0.0_wp)
      if (.not. series%is_free) return
      if (series%equilibrium > negligible*minval(series%samples%modulus)) return
      series%equilibrium = 0.0_wp
      call iterate(series, .false.)

   contains

      !> Iterate with or without the equilibrium modulus as an unknown
      subroutine iterate(series, is_free)
         type(series_t), intent(inout) :: series
         logical, intent(in) :: is_free

         real(wp) :: r(size(series%data))
         real(wp), allocatable :: x(:)
         logical :: converged
         integer :: n, first

         call set_bounds(series, is_free)
         n = size(series%rates)
         first = merge(1, 0, is_free)
         ! non-negative least squares may have left out a modulus that the refinement needs
         allocate (x, source=unknowns_of(series, seed))
         call minimise(series, x, r, converged, tolerance, most)
         if (is_free) series%equilibrium = exp(x(1))
         series%moduli = exp(x(first + 1:first + n))
         series%rates = x(first + n + 1:)
         series%misfits = r
         series%converged = converged
         call order(series)
      end subroutine iterate
   end subroutine refine

   !> Sort the terms of a series by their rates
   pure subroutine order(series)
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
      class(series_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
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

   !> Derivatives of the residuals. Those by ln l are -l t exp(-l t), and -2 x^2/(1 + x^2)^2 and
   !> -x (1 - x^2)/(1 + x^2)^2
   subroutine jacobian(self, x, j)
      class(series_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
      !> Derivatives, shape (count, size(x))
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

end module vcor_fit_prony
