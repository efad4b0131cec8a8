!> Fits of Prony series: they are short and positive, and their terms come back
program test_fit_prony
   use vcor_error, only : error_t
   use vcor_fit, only : estimate_t, fit_material, fit_t, samples_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use fit_data, only : begin_noise, exact, most_misses, noise, none, runs, sampled, spoil, state, &
      truth
   implicit none

   call suite('fit_prony')
   call exact_series(.false.)
   call exact_series(.true.)
   call butyl_series(1.0e-6_wp, 81, 12)
   call butyl_series(1.0e-8_wp, 121, 16)
   call butyl_dynamic()
   call noisy_series()
   call noisy_terms(10.421e6_wp)
   call noisy_terms(1.0e3_wp)
   call given_terms()
   call finish()

contains

   !> A Prony series comes back with as many terms as it has
   subroutine exact_series(dynamic)
      !> Whether from storage and loss modulus
      logical, intent(in) :: dynamic

      type(fit_t) :: fit
      type(material_data_t) :: data
      type(error_t), allocatable :: error
      integer :: k

      data = truth('prony')
      call data%set('equilibrium_modulus', 10.421e6_wp)
      call fit_material(fit, 'prony', 0, none, &
         sampled(data, 1.0e-6_wp, 1.0e-1_wp, 101, dynamic), error)
      call check(.not. allocated(error), 'a series of three terms is fitted')
      if (allocated(error)) return
      call check(size(fit%data%list('moduli')) == 3, 'with three terms')
      if (size(fit%data%list('moduli')) /= 3) return
      associate (moduli => fit%data%list('moduli'), rates => fit%data%list('rates'), &
         true_moduli => data%list('moduli'), true_rates => data%list('rates'))
         do k = 1, 3
            call check_relative(moduli(k), true_moduli(4 - k), exact, 'a modulus comes back')
            call check_relative(rates(k), true_rates(4 - k), exact, 'a rate comes back')
         end do
      end associate
      call check_relative(fit%data%number('equilibrium_modulus'), 10.421e6_wp, exact, &
         'the equilibrium modulus comes back')
   end subroutine exact_series

   !> BUTYL's power law over some decades
   subroutine butyl_series(first, n, most)
      !> First time [s]
      real(wp), intent(in) :: first
      !> Number of samples
      integer, intent(in) :: n
      !> Most terms
      integer, intent(in) :: most

      type(fit_t) :: fit
      type(error_t), allocatable :: error

      call fit_material(fit, 'prony', 0, none, &
         sampled(truth('power_law'), first, 1.0e-2_wp, n, .false.), error)
      call check(.not. allocated(error), 'BUTYL is fitted by a series')
      if (allocated(error)) return
      call check(size(fit%data%list('moduli')) <= most, 'with no more terms than needed')
      call check(abs(fit%largest) <= 1.0e-3_wp, 'to 0.1 %')
      call check_sound(fit)
   end subroutine butyl_series

   !> A series is positive and far from ill-conditioned, its times one after the other
   subroutine check_sound(fit)
      !> The fit
      type(fit_t), intent(in) :: fit

      integer :: n

      n = size(fit%data%list('moduli'))
      call check(all(fit%data%list('moduli') > 0.0_wp) .and. all(fit%data%list('rates') > 0.0_wp), &
         'moduli and rates are positive')
      associate (rates => fit%data%list('rates'))
         call check(all(rates(:n - 1) > 1.2_wp*rates(2:)), 'no two times are the same')
      end associate
      call check(fit%condition < 1.0e4_wp, 'the problem is well conditioned')
   end subroutine check_sound

   !> The same from storage and loss modulus
   subroutine butyl_dynamic()
      type(fit_t) :: fit
      type(error_t), allocatable :: error

      call fit_material(fit, 'prony', 0, none, &
         sampled(truth('power_law'), 1.0e-6_wp, 1.0e-2_wp, 81, .true.), error)
      call check(.not. allocated(error), 'BUTYL is fitted by a series from dynamic data')
      if (allocated(error)) return
      call check(abs(fit%largest) <= 1.0e-3_wp, 'to 0.1 %')
      call check(all(fit%data%list('moduli') > 0.0_wp), 'moduli are positive')
   end subroutine butyl_dynamic

   !> In noise a series does not follow the noise
   subroutine noisy_series()
      type(fit_t) :: fit
      type(samples_t) :: samples
      type(error_t), allocatable :: error

      state = 4711.0_wp
      samples = sampled(truth('power_law'), 1.0e-6_wp, 1.0e-2_wp, 81, .false.)
      call spoil(samples)
      call fit_material(fit, 'prony', 0, none, samples, error)
      call check(.not. allocated(error), 'noisy BUTYL is fitted by a series')
      if (allocated(error)) return
      call check(size(fit%data%list('moduli')) >= 3 .and. size(fit%data%list('moduli')) <= 7, &
         'with some terms, not many')
      call check_close(fit%rms, noise, 0.25_wp*noise, 'what it misses is the noise')
      call check_sound(fit)
   end subroutine noisy_series

   !> With noise the true values of a series lie within three standard errors, nearly always
   subroutine noisy_terms(equilibrium)
      !> Equilibrium modulus [Pa]; it vanishes in the noise if it is small
      real(wp), intent(in) :: equilibrium

      type(fit_t) :: fit
      type(material_data_t) :: data
      type(samples_t) :: clean, samples
      type(error_t), allocatable :: error
      real(wp) :: distance(7), spread
      integer :: run, misses

      data = truth('prony')
      call data%set('equilibrium_modulus', equilibrium)
      clean = sampled(data, 1.0e-6_wp, merge(1.0e-1_wp, 6.0e-3_wp, equilibrium > 1.0e6_wp), 101, &
         .false.)
      misses = 0
      spread = 0.0_wp
      do run = 1, runs
         call begin_noise(run)
         samples = clean
         call spoil(samples)
         call fit_material(fit, 'prony', 3, none, samples, error)
         if (allocated(error)) then
            misses = misses + 1
            cycle
         end if
         associate (moduli => data%list('moduli'), times => 1.0_wp/data%list('rates'))
            distance = (fit%parameters%value - [equilibrium, moduli(3), times(3), moduli(2), &
               times(2), moduli(1), times(1)])/max(fit%parameters%error, tiny(1.0_wp))
         end associate
         if (.not. all(abs(distance) <= 3.0_wp)) misses = misses + 1
         spread = spread + sum(distance**2)/real(7*runs, wp)
      end do
      call check(misses <= most_misses, 'series: the truth is within three standard errors')
      ! those of a modulus that is at its bound are smaller than its error
      call check(spread > 0.5_wp .and. spread < 1.42_wp, 'series: the errors are the spread')
   end subroutine noisy_terms

   !> A number of terms is taken as it is
   subroutine given_terms()
      integer, parameter :: terms(3) = [3, 5, 8]
      type(fit_t) :: fit
      type(estimate_t) :: fixed(1)
      type(error_t), allocatable :: error
      real(wp) :: before
      integer :: k

      before = 1.0_wp
      do k = 1, size(terms)
         call fit_material(fit, 'prony', terms(k), none, &
            sampled(truth('power_law'), 1.0e-6_wp, 1.0e-2_wp, 81, .false.), error)
         call check(.not. allocated(error), 'a series of a given number of terms')
         if (allocated(error)) cycle
         call check(size(fit%data%list('moduli')) == terms(k), 'it has so many')
         call check(fit%rms < 0.3_wp*before, 'and more terms miss less')
         before = fit%rms
      end do
      fixed(1)%name = 'equilibrium_modulus'
      fixed(1)%value = 2.28e6_wp
      call fit_material(fit, 'prony', 8, fixed, &
         sampled(truth('power_law'), 1.0e-6_wp, 1.0e-2_wp, 81, .false.), error)
      call check(.not. allocated(error), 'a series with its equilibrium modulus given')
      if (allocated(error)) return
      call check_close(fit%data%number('equilibrium_modulus'), 2.28e6_wp, 0.0_wp, &
         'it is what was given')
   end subroutine given_terms

end program test_fit_prony
