!> Fit of a Prony series with a given number of terms, or with as many as the data support
!>
!> The spectrum comes first: the moduli of rates on a fine logarithmic grid are a problem of
!> non-negative least squares, and few of them are not zero. A relaxation time between two rates of
!> the grid shows up as both, so neighbours are merged. Then moduli and rates are refined together,
!> from two starts: the merged spectrum, and rates in equal steps.
!>
!> As many as the data support: terms are added one at a time until the largest misfit is below what
!> any data are good for, or as long as they pay by the Bayesian information criterion
!> m ln(S/m) + p ln m of m moduli, p parameters and the sum of squares S (G. Schwarz, Ann. Stat. 6
!> (1978) 461). In noise it ends where more terms would follow the noise.
module vcor_material_fit_series
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material, only : material_t, new_material
   use vcor_material_fit_exponentials, only : fastest_rate, new_series_problem, refine, series_t, &
      series_problem_t, slowest_rate, solve_moduli
   use vcor_material_fit_result, only : fit_t, judge, parameter_t, set_errors, state_bound, &
      state_fixed
   use vcor_material_fit_samples, only : samples_t
   implicit none
   private

   public :: fit_series

   !> Rates per decade of the grid of the spectrum
   real(wp), parameter :: per_decade = 8.0_wp
   !> Largest misfit that no data beat
   real(wp), parameter :: good_enough = 5.0e-4_wp
   !> One term more that reduces the residual to this part completes a series that the data are
   real(wp), parameter :: completes = 1.0e-3_wp
   !> Additional terms that do not pay before the search ends: some data need two at once
   integer, parameter :: most_in_vain = 3
   !> Most terms
   integer, parameter :: most_terms = 60
   !> Reduction of the sum of squares that counts as none, while the number is searched and at last
   real(wp), parameter :: coarse = 1.0e-4_wp, fine = 1.0e-9_wp
   !> Most evaluations, while the number is searched and at last
   integer, parameter :: first_patience = 60, last_patience = 2000
   !> Part of the largest modulus that starts a term which least squares do without
   real(wp), parameter :: little = 1.0e-3_wp

contains

   !> Fit a Prony series
   subroutine fit_series(fit, terms, fixed, samples, error)
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

      call find_spectrum(spectrum, samples, fixed)
      if (terms > 0) then
         call fit_terms(series, terms, spectrum, samples, fixed, last_patience)
      else
         call search(series, spectrum, samples, fixed)
      end if
      call refine(series, samples, fixed, fine, last_patience)
      if (.not. series%converged) then
         call raise(error, error_numerical, 'the fit of a Prony series does not converge: give ' &
            //'another number of terms with --terms')
         return
      end if
      call conclude(fit, series, fixed, samples, error)
   end subroutine fit_series

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
   subroutine fit_terms(series, terms, spectrum, samples, fixed, most)
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

      type(series_t) :: other
      integer :: i

      ! equal steps, half a step from the ends
      associate (first => slowest_rate(samples), last => fastest_rate(samples))
         series%rates = first + (last - first)*[(real(2*i - 1, wp), i=1, terms)]/real(2*terms, wp)
      end associate
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

   !> Search the number of terms
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
      real(wp) :: lowest, value
      integer :: n, in_vain

      lowest = huge(lowest)
      in_vain = 0
      do n = 1, min(most_terms, (samples%count() - 2)/2)
         call fit_terms(trial, n, spectrum, samples, fixed, first_patience)
         if (n > 1) then
            if (maxval(abs(series%residuals)) <= good_enough) then
               if (norm2(trial%residuals) < completes*norm2(series%residuals)) series = trial
               return
            end if
         end if
         value = criterion(trial)
         if (n == 1 .or. value < lowest) then
            lowest = value
            series = trial
            in_vain = 0
         else
            in_vain = in_vain + 1
            if (in_vain == most_in_vain) exit
         end if
      end do
   end subroutine search

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

      real(wp), parameter :: touch = 1.0e-9_wp
      type(series_problem_t) :: problem
      class(material_t), allocatable :: material
      integer, allocatable :: free(:)
      real(wp), allocatable :: x(:)
      integer :: i, k, n

      n = size(series%rates)
      fit%data%name = 'prony'
      fit%data%model = 'prony'
      fit%data%equilibrium_modulus = series%equilibrium
      fit%data%moduli = series%moduli(n:1:-1)
      fit%data%rates = exp(series%rates(n:1:-1))
      allocate (fit%parameters(2*n + 1))
      fit%parameters(1) = parameter_t('equilibrium_modulus', 'Pa', series%equilibrium)
      if (fixed >= 0.0_wp) then
         fit%parameters(1)%state = state_fixed
      else if (.not. series%equilibrium > 0.0_wp) then
         fit%parameters(1)%state = state_bound
      end if
      do i = 1, n
         k = n + 1 - i
         fit%parameters(2*i) = parameter_t('moduli', 'Pa', series%moduli(k))
         fit%parameters(2*i + 1) = parameter_t('times', 's', exp(-series%rates(k)))
      end do

      call new_material(material, fit%data, error)
      if (allocated(error)) return
      call judge(fit, material, samples)
      problem = new_series_problem(samples, n, series%equilibrium, &
         fixed < 0.0_wp .and. series%equilibrium > 0.0_wp)
      x = [log(series%moduli(n:1:-1)), series%rates(n:1:-1)]
      free = [(2*i, i=1, n), (2*i + 1, i=1, n)]
      if (problem%is_free) then
         x = [log(series%equilibrium), x]
         free = [1, free]
      end if
      where (x < problem%lower + touch .or. x > problem%upper - touch) &
         fit%parameters(free)%state = state_bound
      if (any(fit%parameters(free)%name == 'moduli' &
         .and. fit%parameters(free)%state == state_bound)) then
         call raise(error, error_numerical, 'the data do not support so many terms: take fewer, ' &
            //'or leave --terms out')
         return
      end if
      call set_errors(fit, problem, x, series%residuals, free, error)
   end subroutine conclude

end module vcor_material_fit_series
