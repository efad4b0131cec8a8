!> Fit of a Prony series with a given number of terms, or with as many as the data support
!>
!> The spectrum comes first: the moduli of rates on a fine logarithmic grid are a problem of
!> non-negative least squares, and few of them are not zero. A relaxation time between two rates of
!> the grid shows up as both, so neighbours are merged. Then moduli and rates are refined together,
!> from two starts: the merged spectrum, and rates in equal steps.
!>
!> As many as the data support: terms are added until the largest misfit is below what any data are
!> good for, or as long as they pay by the Bayesian information criterion
!> m ln(S/m) + p ln m of m moduli, p parameters and the sum of squares S (G. Schwarz, Ann. Stat. 6
!> (1978) 461). In noise it ends where more terms would follow the noise.
module vcor_fit_prony
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material, only : material_t, new_material
   use vcor_fit_prony_problem, only : fastest_rate, new_series_problem, refine, series_t, &
      series_problem_t, slowest_rate, solve_moduli
   use vcor_fit_result, only : estimate_t, fit_t, judge, mark_ends, set_errors, state_bound, &
      state_fixed
   use vcor_fit_samples, only : samples_t
   implicit none
   private

   public :: fit_prony

   !> Rates per decade of the grid of the spectrum
   real(wp), parameter :: per_decade = 8.0_wp
   !> Largest misfit that no data beat
   real(wp), parameter :: good_enough = 5.0e-4_wp
   !> Largest misfit that may become that small, as a factor
   real(wp), parameter :: close = 4.0_wp
   !> Fewest terms of a series whose rates are a start for others
   integer, parameter :: least_guide = 4
   !> One term more that reduces the residual to this part completes a series that the data are
   real(wp), parameter :: completes = 1.0e-3_wp
   !> Steps that do not pay before the search ends: one may be a poor start
   integer, parameter :: most_in_vain = 2
   !> Part of the misfit that more terms leave, above which the iteration may have stopped short
   real(wp), parameter :: halfway = 0.7_wp
   !> Factor by which the rates that a fit starts from go beyond the data
   real(wp), parameter :: around = 4.0_wp
   !> Most terms
   integer, parameter :: most_terms = 60
   !> Most terms per decade of the data, and a few more: t^-1/2 to 0.05 % takes 2.3 per decade
   real(wp), parameter :: terms_per_decade = 3.0_wp
   integer, parameter :: few_more = 5
   !> Reduction of the sum of squares that counts as none, while the number is searched and at last
   real(wp), parameter :: coarse = 1.0e-3_wp, fine = 1.0e-7_wp
   !> Most evaluations, while the number is searched and at last
   integer, parameter :: first_patience = 60, last_patience = 300
   !> Part of the largest modulus that starts a term which least squares do without
   real(wp), parameter :: little = 1.0e-3_wp
   !> Part of the smallest modulus of the samples below which a term is none
   real(wp), parameter :: nothing = 1.0e-6_wp

contains

   !> Fit a Prony series
   subroutine fit_prony(fit, terms, fixed, samples, error)
      !> The fit
      type(fit_t), intent(out) :: fit
      !> Number of terms; 0: as many as the data support
      integer, intent(in) :: terms
      !> Equilibrium modulus [Pa]; negative: to be found
      real(wp), intent(in) :: fixed
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Error of code `error_numerical` if there is no solution, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(series_t) :: series, spectrum
      integer :: n

      call find_spectrum(spectrum, samples, fixed)
      if (terms > 0) then
         call fit_terms(series, terms, spectrum, samples, fixed, last_patience)
      else
         call search(series, spectrum, samples, fixed)
         call shorten(series, spectrum, samples, fixed)
      end if
      n = size(series%rates)
      do
         call refine(series, samples, fixed, fine, last_patience)
         if (terms == 0) call prune(series, samples, fixed)
         if (series%converged) then
            call conclude(fit, series, fixed, samples, error)
         else
            call raise(error, error_numerical, 'the fit of a Prony series does not converge: ' &
               //'give another number of terms with --terms')
         end if
         ! what the data do not support is not given: then take a term less
         if (.not. allocated(error) .or. terms > 0 .or. n == 1) exit
         n = n - 1
         spectrum = series
         call fit_terms(series, n, spectrum, samples, fixed, last_patience)
      end do
   end subroutine fit_prony

   !> Take terms away as long as the series stays good enough: the search has looked at iterations
   !> that were cut short
   subroutine shorten(series, spectrum, samples, fixed)
      !> The series
      type(series_t), intent(inout) :: series
      !> The spectrum
      type(series_t), intent(in) :: spectrum
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: to be found
      real(wp), intent(in) :: fixed

      type(series_t) :: trial

      do while (is_good(series) .and. size(series%rates) > 1)
         call fit_terms(trial, size(series%rates) - 1, spectrum, samples, fixed, last_patience, &
            series)
         call refine(trial, samples, fixed, fine, last_patience)
         if (.not. is_good(trial)) exit
         ! data that are this series
         if (norm2(series%residuals) < completes*norm2(trial%residuals)) exit
         series = trial
      end do
   end subroutine shorten

   !> Drop terms that the refinement has made next to nothing
   subroutine prune(series, samples, fixed)
      !> The series
      type(series_t), intent(inout) :: series
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: to be found
      real(wp), intent(in) :: fixed

      logical :: needed(size(series%rates))

      needed = series%moduli > nothing*minval(samples%modulus)
      if (all(needed) .or. .not. any(needed)) return
      series%rates = pack(series%rates, needed)
      series%moduli = pack(series%moduli, needed)
      call refine(series, samples, fixed, fine, last_patience)
   end subroutine prune

   !> The spectrum on a grid, neighbours merged
   subroutine find_spectrum(spectrum, samples, fixed)
      !> The spectrum as a series
      type(series_t), intent(out) :: spectrum
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: to be found
      real(wp), intent(in) :: fixed

      real(wp), allocatable :: rates(:), moduli(:)
      real(wp) :: width
      integer :: i, n

      associate (first => slowest_rate(samples), last => fastest_rate(samples))
         n = 1 + ceiling((last - first)/log(10.0_wp)*per_decade)
         width = (last - first)/real(n - 1, wp)
         rates = first + width*[(real(i, wp), i=0, n - 1)]
      end associate
      allocate (moduli(n))
      call solve_moduli(samples, fixed, rates, spectrum%equilibrium, moduli)
      spectrum%rates = pack(rates, moduli > 0.0_wp)
      spectrum%moduli = pack(moduli, moduli > 0.0_wp)
      do while (size(spectrum%rates) > 1)
         n = closest(spectrum%rates)
         if (spectrum%rates(n + 1) - spectrum%rates(n) > 1.5_wp*width) exit
         call merge_terms(spectrum, n)
      end do
   end subroutine find_spectrum

   !> Number of the rate that is closest to the next one
   pure function closest(rates) result(n)
      !> Logarithms of rates, increasing
      real(wp), intent(in) :: rates(:)
      !> Its number
      integer :: n

      n = minloc(rates(2:) - rates(:size(rates) - 1), dim=1)
   end function closest

   !> Make one term of two neighbours
   pure subroutine merge_terms(series, n)
      !> The series
      type(series_t), intent(inout) :: series
      !> Number of the first of the two
      integer, intent(in) :: n

      associate (rates => series%rates, moduli => series%moduli)
         rates(n) = (rates(n)*moduli(n) + rates(n + 1)*moduli(n + 1))/(moduli(n) + moduli(n + 1))
         moduli(n) = moduli(n) + moduli(n + 1)
      end associate
      series%rates = [series%rates(:n), series%rates(n + 2:)]
      series%moduli = [series%moduli(:n), series%moduli(n + 2:)]
   end subroutine merge_terms

   !> Fit a number of terms, from both starts
   subroutine fit_terms(series, terms, spectrum, samples, fixed, most, guide)
      !> The better series
      type(series_t), intent(out) :: series
      !> Number of terms
      integer, intent(in) :: terms
      !> The spectrum
      type(series_t), intent(in) :: spectrum
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: to be found
      real(wp), intent(in) :: fixed
      !> Most evaluations
      integer, intent(in) :: most
      !> A series of another number of terms, whose rates are a better start than equal steps
      type(series_t), intent(in), optional :: guide

      type(series_t) :: other
      integer :: i

      ! equal steps over the band of the data and a little more, half a step from the ends
      associate (first => log(1.0_wp/(around*samples%last_time())), &
         last => log(around/samples%first_time()))
         series%rates = first + (last - first)*[(real(2*i - 1, wp), i=1, terms)]/real(2*terms, wp)
      end associate
      if (present(guide)) series%rates = spread_rates(guide%rates, terms)
      call start_from_rates(series, samples, fixed)
      call refine(series, samples, fixed, coarse, most)
      if (size(spectrum%rates) < terms) return
      other%rates = spectrum%rates
      other%moduli = spectrum%moduli
      do while (size(other%rates) > terms)
         call merge_terms(other, closest(other%rates))
      end do
      call start_from_rates(other, samples, fixed)
      call refine(other, samples, fixed, coarse, most)
      if (norm2(other%residuals) < norm2(series%residuals)) series = other
   end subroutine fit_terms

   !> Rates of another number of terms with the same distribution
   pure function spread_rates(rates, terms) result(others)
      !> Logarithms of rates, increasing, shape (n), n >= 2
      real(wp), intent(in) :: rates(:)
      !> Number of terms
      integer, intent(in) :: terms
      !> Logarithms of their rates, shape (terms)
      real(wp) :: others(terms)

      real(wp) :: place
      integer :: i, k

      do i = 1, terms
         ! terms stand in the middle of equal parts of the spectrum
         place = 0.5_wp + (real(i, wp) - 0.5_wp)*real(size(rates), wp)/real(terms, wp)
         k = max(1, min(size(rates) - 1, int(place)))
         others(i) = rates(k) + (place - real(k, wp))*(rates(k + 1) - rates(k))
      end do
   end function spread_rates

   !> Moduli for the rates of a series
   subroutine start_from_rates(series, samples, fixed)
      !> The series, its rates set
      type(series_t), intent(inout) :: series
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: to be found
      real(wp), intent(in) :: fixed

      if (allocated(series%moduli)) deallocate (series%moduli)
      allocate (series%moduli(size(series%rates)))
      call solve_moduli(samples, fixed, series%rates, series%equilibrium, series%moduli)
      series%moduli = max(series%moduli, &
         little*max(maxval(series%moduli), minval(samples%modulus)))
   end subroutine start_from_rates

   !> Search the number of terms: with growing steps as far as it pays, then with steps that halve
   subroutine search(series, spectrum, samples, fixed)
      !> The series
      type(series_t), intent(out) :: series
      !> The spectrum
      type(series_t), intent(in) :: spectrum
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: to be found
      real(wp), intent(in) :: fixed

      type(series_t) :: trial
      real(wp) :: best
      integer :: n, most, width, in_vain
      logical :: better

      most = min(most_terms, (samples%count() - 2)/2, few_more &
         + ceiling(terms_per_decade*log10(samples%last_time()/samples%first_time())))
      best = huge(best)
      in_vain = 0
      n = 1
      do
         call try(n, better)
         in_vain = merge(0, in_vain + 1, better)
         if (n == most .or. in_vain == most_in_vain) exit
         if (is_good(series)) exit
         n = min(most, n + 1 + n/4)
      end do
      width = 1 + size(series%rates)/4
      do while (width > 1)
         width = (width + 1)/2
         n = size(series%rates)
         call try(n - width, better)
         if (.not. better .and. .not. is_good(series)) call try(n + width, better)
         if (width == 2 .and. .not. better) exit
      end do
      do
         call try(size(series%rates) - 1, better)
         if (.not. better) exit
      end do
      ! data that are a series of one term more are told by what is left then
      if (size(series%rates) == most) return
      call fit_terms(trial, size(series%rates) + 1, spectrum, samples, fixed, first_patience)
      if (norm2(trial%residuals) < completes*norm2(series%residuals)) series = trial

   contains

      !> Try a number of terms
      subroutine try(terms, better)
         !> The number
         integer, intent(in) :: terms
         !> Whether it is the best so far
         logical, intent(out) :: better

         real(wp) :: value
         logical :: guided, look

         better = .false.
         if (terms < 1 .or. terms > most) return
         guided = allocated(series%rates)
         if (guided) guided = size(series%rates) >= least_guide
         if (guided) then
            call fit_terms(trial, terms, spectrum, samples, fixed, first_patience, series)
         else
            call fit_terms(trial, terms, spectrum, samples, fixed, first_patience)
         end if
         ! nearly there, or a term less, or no closer than with fewer terms, which is a place on the
         ! way: worth a closer look, before longer ones are tried
         look = maxval(abs(trial%residuals)) <= close*good_enough
         if (allocated(series%rates)) look = look .or. terms == size(series%rates) - 1 .or. &
            (terms > size(series%rates) &
            .and. norm2(trial%residuals) > halfway*norm2(series%residuals))
         if (look .and. .not. is_good(trial)) &
            call refine(trial, samples, fixed, fine, last_patience)
         value = criterion(trial)
         ! of those that are good enough the shortest
         if (is_good(trial)) value = -0.5_wp*huge(value)*(1.0_wp - 1.0e-3_wp*real(terms, wp))
         better = value < best
         if (.not. better) return
         best = value
         series = trial
      end subroutine try
   end subroutine search

   !> Whether a series is as good as any data
   pure function is_good(series) result(yes)
      !> The series
      type(series_t), intent(in) :: series
      !> Whether it is
      logical :: yes

      yes = maxval(abs(series%residuals)) <= good_enough
   end function is_good

   !> Bayesian information criterion
   pure function criterion(series) result(value)
      !> The series
      type(series_t), intent(in) :: series
      !> The criterion
      real(wp) :: value

      real(wp) :: m, p

      m = real(size(series%residuals), wp)
      p = real(2*size(series%rates) + 1, wp)
      value = m*log(max(sum(series%residuals**2)/m, epsilon(m)**2)) + p*log(m)
   end function criterion

   !> Make the fit of a series: parameters, misfit, standard errors
   subroutine conclude(fit, series, fixed, samples, error)
      !> The fit
      type(fit_t), intent(out) :: fit
      !> The series
      type(series_t), intent(in) :: series
      !> Equilibrium modulus [Pa]; negative: it was to be found
      real(wp), intent(in) :: fixed
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Error of code `error_numerical` if the data do not determine the terms
      type(error_t), allocatable, intent(out) :: error

      real(wp), parameter :: touch = 1.0e-5_wp
      type(series_problem_t) :: problem
      class(material_t), allocatable :: material
      integer, allocatable :: free(:)
      real(wp), allocatable :: x(:)
      integer :: i, k, n

      n = size(series%rates)
      fit%data%name = 'prony'
      fit%data%model = 'prony'
      call fit%data%set('equilibrium_modulus', series%equilibrium)
      call fit%data%set_list('moduli', series%moduli(n:1:-1))
      call fit%data%set_list('rates', exp(series%rates(n:1:-1)))
      allocate (fit%parameters(2*n + 1))
      fit%parameters(1) = estimate_t('equilibrium_modulus', 'Pa', series%equilibrium)
      if (fixed >= 0.0_wp) then
         fit%parameters(1)%state = state_fixed
      else if (.not. series%equilibrium > 0.0_wp) then
         fit%parameters(1)%state = state_bound
      end if
      do i = 1, n
         k = n + 1 - i
         fit%parameters(2*i) = estimate_t('moduli', 'Pa', series%moduli(k))
         fit%parameters(2*i + 1) = estimate_t('times', 's', exp(-series%rates(k)))
      end do

      call new_material(material, fit%data, error)
      if (allocated(error)) return
      call judge(fit, material, samples)
      problem = new_series_problem(samples, n, series%equilibrium, fixed < 0.0_wp)
      x = [log(series%moduli(n:1:-1)), series%rates(n:1:-1)]
      free = [(2*i, i=1, n), (2*i + 1, i=1, n)]
      if (problem%is_free) then
         x = [log(max(series%equilibrium, nothing*minval(samples%modulus))), x]
         free = [1, free]
      end if
      where (x < problem%lower + touch .or. x > problem%upper - touch) &
         fit%parameters(free)%state = state_bound
      if (any(series%moduli <= nothing*minval(samples%modulus))) then
         call raise(error, error_numerical, 'the data do not support so many terms: take fewer, ' &
            //'or leave --terms out')
         return
      end if
      call set_errors(fit, problem, x, series%residuals, free, size(samples%at), error)
      if (.not. allocated(error)) call mark_ends(fit, material, samples)
   end subroutine conclude

end module vcor_fit_prony
