!> Fits of materials: parameters come back, standard errors are what they say, Prony series are
!> short and positive
program test_fit
   use vcor_error, only : error_input, error_numerical, error_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_fit, only : fit_material, fit_t, fixable_parameters, parameter_t, samples_t, &
      state_bound, state_fixed, state_free, unseen_earlier, unseen_later
   use vcor_fit_result, only : moduli_of
   use vcor_fit_structure, only : is_structured
   use vcor_test, only : check, check_close, check_contains, check_relative, check_text, finish, &
      suite
   implicit none

   !> What the issue asks of exact data
   real(wp), parameter :: exact = 1.0e-8_wp
   !> Relative noise of the data
   real(wp), parameter :: noise = 0.01_wp
   !> Runs with noise, and how many may miss three standard errors
   integer, parameter :: runs = 100, most_misses = 5
   character(len=*), parameter :: models(4) = [character(len=14) :: 'sls', 'power_law', 'cerf', &
      'mittag_leffler']
   type(parameter_t), parameter :: none(0) = [parameter_t ::]
   !> State of the generator of noise
   real(wp) :: state = 0.0_wp
   integer :: i

   call suite('fit')
   do i = 1, size(models)
      call exact_data(trim(models(i)), .false.)
      call exact_data(trim(models(i)), .true.)
      call fixed_parameters(trim(models(i)))
      call noisy_data(trim(models(i)), .false.)
      call noisy_data(trim(models(i)), .true.)
      call noise_is_noise(truth(trim(models(i))), sampled_model(trim(models(i)), .false.))
      call noise_is_noise(truth(trim(models(i))), sampled_model(trim(models(i)), .true.))
   end do
   call materials_at_bounds()
   call error_of_nothing()
   call vanishing_modulus()
   call exponent_of_one()
   call runaway_time()
   call exact_series(.false.)
   call exact_series(.true.)
   call butyl_series(1.0e-6_wp, 81, 12)
   call butyl_series(1.0e-8_wp, 121, 16)
   call butyl_dynamic()
   call noisy_series()
   call noisy_terms(10.421e6_wp)
   call noisy_terms(1.0e3_wp)
   call given_terms()
   call chance()
   call noise_is_noise(truth('prony'), sampled(truth('prony'), 1.0e-6_wp, 1.0e-1_wp, 61, .false.))
   call noise_is_noise(truth('prony'), sampled(truth('prony'), 1.0e-6_wp, 1.0e-1_wp, 61, .true.))
   call wrong_models()
   call ends_of_laws()
   call ends_of_series()
   call refusals()
   call finish()

contains

   !> A material of each model, with the numbers of the paper or close to them
   function truth(model) result(data)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> The material
      type(material_data_t) :: data

      data%name = 'truth'
      data%model = model
      call data%set('glassy_modulus', 15.0e6_wp)
      call data%set('alpha', 300.0_wp)
      call data%set('beta', merge(700.0_wp, 1200.0_wp, model == 'cerf'))
      call data%set('equilibrium_modulus', 2.28e6_wp)
      call data%set('relaxing_modulus', 676.5e6_wp)
      call data%set('coefficient', 8.85e5_wp)
      call data%set('exponent', merge(0.62_wp, 0.5_wp, model == 'mittag_leffler'))
      call data%set('time', 2.0e-6_wp)
      call data%set_list('moduli', [20.181e6_wp, 38.204e6_wp, 87.344e6_wp])
      call data%set_list('rates', [972.0_wp, 6426.0_wp, 34221.0_wp])
   end function truth

   !> Samples of a material
   function sampled(data, first, last, n, dynamic) result(samples)
      !> The material
      type(material_data_t), intent(in) :: data
      !> First time [s]
      real(wp), intent(in) :: first
      !> Last time [s]
      real(wp), intent(in) :: last
      !> Number of points
      integer, intent(in) :: n
      !> Whether storage and loss modulus are wanted
      logical, intent(in) :: dynamic
      !> The samples
      type(samples_t) :: samples

      class(material_t), allocatable :: material
      type(error_t), allocatable :: error
      real(wp) :: all((1 + merge(1, 0, dynamic))*n)
      integer :: k

      call new_material(material, data, error)
      samples%dynamic = dynamic
      allocate (samples%at(n), samples%modulus(n), samples%loss(size(all) - n))
      samples%at = first*(last/first)**[(real(k, wp)/real(n - 1, wp), k=0, n - 1)]
      if (dynamic) samples%at = 1.0_wp/samples%at(n:1:-1)
      all = moduli_of(material, samples)
      samples%modulus = all(:n)
      samples%loss = all(n + 1:)
   end function sampled

   !> Samples of a material of a model, over the decades in which it relaxes
   function sampled_model(model, dynamic) result(samples)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Whether storage and loss modulus are wanted
      logical, intent(in) :: dynamic
      !> The samples
      type(samples_t) :: samples

      if (model == 'sls') then
         samples = sampled(truth(model), 1.0e-5_wp, 1.0e-2_wp, 41, dynamic)
      else
         samples = sampled(truth(model), 1.0e-9_wp, 1.0e-1_wp, 41, dynamic)
      end if
   end function sampled_model

   !> A parameter of a material by its name
   function parameter_of(data, name) result(value)
      !> The material
      type(material_data_t), intent(in) :: data
      !> Name of the parameter
      character(len=*), intent(in) :: name
      !> Its value
      real(wp) :: value

      value = data%number(name)
   end function parameter_of

   !> Exact data give their parameters back
   subroutine exact_data(model, dynamic)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Whether from storage and loss modulus
      logical, intent(in) :: dynamic

      type(fit_t) :: fit
      type(error_t), allocatable :: error
      integer :: k

      call fit_material(fit, model, 0, none, sampled_model(model, dynamic), error)
      call check(.not. allocated(error), model//' is fitted')
      if (allocated(error)) return
      do k = 1, size(fit%parameters)
         call check_relative(fit%parameters(k)%value, &
            parameter_of(truth(model), trim(fit%parameters(k)%name)), exact, &
            model//' gives back '//trim(fit%parameters(k)%name))
      end do
      call check(all(fit%parameters%state == state_free), 'and all of it was free')
      call check_close(fit%largest, 0.0_wp, exact, 'nothing is missed')
   end subroutine exact_data

   !> A parameter that is given stays, and the others come back
   subroutine fixed_parameters(model)
      !> Name of the model
      character(len=*), intent(in) :: model

      type(fit_t) :: fit
      type(parameter_t) :: fixed(1)
      type(error_t), allocatable :: error
      character(len=:), allocatable :: names, name
      integer :: mark, k

      names = fixable_parameters(model)//' '
      do while (len(names) > 0)
         mark = index(names, ' ')
         name = names(:mark - 1)
         names = names(mark + 1:)
         fixed(1)%name = name
         fixed(1)%value = parameter_of(truth(model), name)
         call fit_material(fit, model, 0, fixed, sampled_model(model, .false.), error)
         call check(.not. allocated(error), model//' is fitted with '//name//' given')
         if (allocated(error)) cycle
         do k = 1, size(fit%parameters)
            call check_relative(fit%parameters(k)%value, &
               parameter_of(truth(model), trim(fit%parameters(k)%name)), exact, &
               model//' with '//name//' given gives back '//trim(fit%parameters(k)%name))
            call check((fit%parameters(k)%state == state_fixed) &
               .eqv. fit%parameters(k)%name == name, 'what is given is told')
         end do
      end do
      ! a wrong value stays too
      fixed(1)%value = 1.1_wp*fixed(1)%value
      call fit_material(fit, model, 0, fixed, sampled_model(model, .true.), error)
      call check(.not. allocated(error), 'a wrong value can be given')
      if (allocated(error)) return
      k = size(fit%parameters)
      call check_close(fit%parameters(k)%value, fixed(1)%value, 0.0_wp, 'it stays what it is')
      call check(abs(fit%largest) > 1.0e-3_wp, 'and something is missed then')
   end subroutine fixed_parameters

   !> Numbers of a normal distribution (Box and Muller), from a multiplicative generator (Lehmer)
   subroutine draw(numbers)
      !> The numbers
      real(wp), intent(out) :: numbers(:)

      real(wp), parameter :: two_pi = 6.283185307179586_wp
      real(wp), parameter :: multiplier = 16807.0_wp, modulus = 2147483647.0_wp
      real(wp) :: uniform(2)
      integer :: k, m

      do k = 1, size(numbers)
         do m = 1, 2
            state = mod(multiplier*state, modulus)
            uniform(m) = state/modulus
         end do
         numbers(k) = sqrt(-2.0_wp*log(uniform(1)))*cos(two_pi*uniform(2))
      end do
   end subroutine draw

   !> Begin a run
   subroutine begin_noise(run)
      !> Its number
      integer, intent(in) :: run

      real(wp) :: unused(10)

      state = real(1000 + run, wp)
      ! the first numbers of seeds that are close together are close together too
      call draw(unused)
   end subroutine begin_noise

   !> Put noise on samples
   subroutine spoil(samples, times)
      !> The samples
      type(samples_t), intent(inout) :: samples
      !> How many times the usual noise; absent: 1
      real(wp), intent(in), optional :: times

      real(wp) :: numbers(size(samples%at)), part

      part = noise
      if (present(times)) part = times*noise
      call draw(numbers)
      samples%modulus = samples%modulus*(1.0_wp + part*numbers)
      if (.not. samples%dynamic) return
      call draw(numbers)
      samples%loss = samples%loss*(1.0_wp + part*numbers)
   end subroutine spoil

   !> With noise the true values lie within three standard errors, nearly always
   subroutine noisy_data(model, dynamic)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Whether from storage and loss modulus
      logical, intent(in) :: dynamic

      real(wp) :: spread

      call fit_noisy(truth(model), sampled_model(model, dynamic), model, spread)
      ! and they are not just wide: the mean square is 1 +- 0.14 for 100 runs, three times that
      call check_close(spread, 1.0_wp, 0.42_wp, &
         model//': the standard error of the last parameter is its spread')
   end subroutine noisy_data

   !> Fit a material many times from data with noise
   subroutine fit_noisy(data, clean, what, spread, widest)
      !> The material
      type(material_data_t), intent(in) :: data
      !> Its samples
      type(samples_t), intent(in) :: clean
      !> What it is called
      character(len=*), intent(in) :: what
      !> Mean square of the distance of the last parameter, in standard errors
      real(wp), intent(out) :: spread
      !> Number of a parameter whose standard error is at most half of it in most of the runs
      integer, intent(in), optional :: widest

      type(fit_t) :: fit
      type(samples_t) :: samples
      type(error_t), allocatable :: error
      real(wp) :: distance
      integer :: run, k, misses, wide
      logical :: inside

      misses = 0
      wide = 0
      spread = 0.0_wp
      do run = 1, runs
         call begin_noise(run)
         samples = clean
         call spoil(samples)
         call fit_material(fit, data%model, 0, none, samples, error)
         inside = .not. allocated(error)
         if (inside) then
            do k = 1, size(fit%parameters)
               distance = abs(fit%parameters(k)%value &
                  - parameter_of(data, trim(fit%parameters(k)%name)))
               inside = inside .and. distance <= 3.0_wp*fit%parameters(k)%error
               if (k == size(fit%parameters)) spread = spread + (distance &
                  /max(fit%parameters(k)%error, tiny(1.0_wp)))**2/real(runs, wp)
            end do
            if (present(widest)) then
               if (.not. fit%parameters(widest)%error <= 0.5_wp*fit%parameters(widest)%value) &
                  wide = wide + 1
            end if
         end if
         if (.not. inside) misses = misses + 1
      end do
      call check(misses <= most_misses, what//': the truth is within three standard errors')
      if (present(widest)) call check(wide < runs/2, what//': they say something')
   end subroutine fit_noisy

   !> The same of materials whose equilibrium modulus or rate often vanishes in the noise, or whose
   !> relaxation lies at the edge of the data or beyond, so that hardly anything is a parabola
   subroutine materials_at_bounds()
      type(material_data_t) :: data
      real(wp) :: spread

      data%name = 'truth'
      data%model = 'mittag_leffler'
      call data%set('equilibrium_modulus', 2.06e6_wp)
      call data%set('relaxing_modulus', 1.11e8_wp)
      call data%set('exponent', 0.218_wp)
      call data%set('time', 1.0e-3_wp)
      call fit_noisy(data, sampled(data, 1.0e-6_wp, 1.0e-1_wp, 40, .false.), &
         'a small equilibrium modulus', spread, 3)

      data%model = 'cerf'
      call data%set('equilibrium_modulus', 3.5e5_wp)
      call data%set('relaxing_modulus', 1.67e7_wp)
      call data%set('beta', 6.0_wp)
      call fit_noisy(data, sampled(data, 2.1e-7_wp, 2.7e-3_wp, 56, .false.), &
         'a CERF that has hardly begun', spread, 3)

      data%model = 'sls'
      call data%set('glassy_modulus', 2.26e7_wp)
      call data%set('alpha', 195.0_wp)
      call data%set('beta', 338.0_wp)
      call fit_noisy(data, sampled(data, 1.9e-7_wp, 3.0e-4_wp, 86, .false.), &
         'a solid that looks like a fluid', spread, 1)
   end subroutine materials_at_bounds

   !> The equilibrium modulus alone is to be found and is 0: the error is that of a sum of known
   !> terms, of which d ln E / d E_0 = 1/E
   subroutine error_of_nothing()
      !> The end of the interval is found to this part, and the logarithm is no straight line
      real(wp), parameter :: tolerance = 0.05_wp
      type(fit_t) :: fit
      type(material_data_t) :: data
      type(samples_t) :: samples
      type(parameter_t) :: fixed(2)
      type(error_t), allocatable :: error
      real(wp) :: expected
      integer :: k

      data = truth('power_law')
      call data%set('equilibrium_modulus', 0.0_wp)
      fixed%name = [character(len=20) :: 'coefficient', 'exponent']
      fixed%value = [data%number('coefficient'), data%number('exponent')]
      samples = sampled(data, 1.0e-7_wp, 1.0e-1_wp, 61, .false.)
      expected = 1.0_wp/norm2(1.0_wp/samples%modulus)
      ! 1 % of the modulus to and fro, and a little less than there is
      samples%modulus = samples%modulus*(0.9999_wp + noise*[((-1.0_wp)**k, k=1, 61)])
      call fit_material(fit, 'power_law', 0, fixed, samples, error)
      call check(.not. allocated(error), 'an equilibrium modulus alone is fitted')
      if (allocated(error)) return
      call check(fit%parameters(1)%state == state_bound, 'it is at its bound')
      call check_relative(fit%parameters(1)%error, expected*fit%rms, tolerance, &
         'its standard error is that of a sum')
      call check(all(fit%parameters(2:)%error <= 0.0_wp), 'what is given has none')
   end subroutine error_of_nothing

   !> A material without equilibrium modulus is found to have none
   subroutine vanishing_modulus()
      type(fit_t) :: fit
      type(material_data_t) :: data
      type(error_t), allocatable :: error

      data = truth('power_law')
      call data%set('equilibrium_modulus', 0.0_wp)
      call fit_material(fit, 'power_law', 0, none, &
         sampled(data, 1.0e-7_wp, 1.0e-1_wp, 61, .false.), error)
      call check(.not. allocated(error), 'a power law alone is fitted')
      if (allocated(error)) return
      call check_close(fit%parameters(1)%value, 0.0_wp, 0.0_wp, 'its equilibrium modulus is 0')
      call check(fit%parameters(1)%state == state_bound, 'and at its bound')
      call check_relative(fit%parameters(2)%value, data%number('coefficient'), exact, &
         'the coefficient')
      call check_relative(fit%parameters(3)%value, data%number('exponent'), exact, &
         'the exponent')

      data = truth('sls')
      call data%set('alpha', 0.0_wp)
      call fit_material(fit, 'sls', 0, none, &
         sampled(data, 1.0e-5_wp, 1.0e-2_wp, 61, .false.), error)
      call check(.not. allocated(error), 'a Maxwell fluid is fitted')
      if (allocated(error)) return
      call check_close(fit%parameters(2)%value, 0.0_wp, 0.0_wp, 'its alpha is 0')
      call check_relative(fit%parameters(3)%value, data%number('beta'), exact, &
         'its rate comes back')
   end subroutine vanishing_modulus

   !> A standard linear solid is a Mittag-Leffler material of exponent 1
   subroutine exponent_of_one()
      type(fit_t) :: fit
      type(error_t), allocatable :: error

      call fit_material(fit, 'mittag_leffler', 0, none, sampled_model('sls', .false.), error)
      call check(.not. allocated(error), 'an SLS is fitted as Mittag-Leffler')
      if (allocated(error)) return
      call check_close(fit%parameters(3)%value, 1.0_wp, 0.0_wp, 'its exponent is 1')
      call check_relative(fit%parameters(4)%value, 1.0_wp/1200.0_wp, exact, 'its time is 1/beta')
   end subroutine exponent_of_one

   !> The CERF closest to a power law has no end: it is told, and what is determined is right
   subroutine runaway_time()
      type(fit_t) :: fit
      type(error_t), allocatable :: error

      call fit_material(fit, 'cerf', 0, none, sampled_model('power_law', .false.), error)
      call check(.not. allocated(error), 'CERF is fitted to a power law')
      if (allocated(error)) return
      call check(fit%parameters(3)%state == state_bound, 'beta is at its bound')
      call check_relative(fit%parameters(2)%value/fit%parameters(3)%value, 8.85e5_wp, 1.0e-3_wp, &
         'E_1/beta is the coefficient')
      call check(all(fit%parameters(2:)%error >= fit%parameters(2:)%value), &
         'and neither of them is determined')
   end subroutine runaway_time

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
      type(parameter_t) :: fixed(1)
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

   !> Of residuals that are noise one in a thousand is said to be structured, whatever the fit took
   subroutine chance()
      integer, parameter :: points(3) = [12, 30, 80], draws = 4000
      !> Of 4000 draws: a Poisson distribution of mean 4 exceeds it once in 20,000
      integer, parameter :: most = 14
      real(wp), allocatable :: j(:, :), q(:, :), r(:), x(:)
      integer :: i, k, m, n, run, alarms

      do n = 1, size(points)
         m = points(n)
         allocate (j(2*m, 4), q(2*m, 4), r(2*m), x(m))
         x(:) = [(2.0_wp*real(i, wp)/real(m + 1, wp) - 1.0_wp, i=1, m)]
         do k = 1, 4
            j(:, k) = [x**(k - 1), x**(k - 1)]
            q(:, k) = j(:, k)
            do i = 1, k - 1
               q(:, k) = q(:, k) - dot_product(q(:, i), q(:, k))*q(:, i)
            end do
            q(:, k) = q(:, k)/norm2(q(:, k))
         end do
         alarms = 0
         call begin_noise(n)
         do run = 1, draws
            call draw(r(:m))
            ! noise that storage and loss modulus share
            r(m + 1:) = r(:m)
            r = r - matmul(q, matmul(r, q))
            if (is_structured(r, j, m)) alarms = alarms + 1
         end do
         call check(alarms <= most, 'noise is taken for structure once in a thousand')
         r = [cos(6.0_wp*x), cos(6.0_wp*x)]
         r = r - matmul(q, matmul(r, q))
         if (m > 12) call check(is_structured(r, j, m), 'waves are structure')
         call check(.not. is_structured(1.0e-3_wp*r, j, m), 'but not where they are negligible')
         r(::2) = abs(r(::2))
         r(2::2) = -abs(r(2::2))
         call check(.not. is_structured(r, j, m), 'what alternates is none')
         deallocate (j, q, r, x)
      end do
   end subroutine chance

   !> Noise, however large, is not taken for a model that is not that of the data
   subroutine noise_is_noise(data, clean)
      !> The material
      type(material_data_t), intent(in) :: data
      !> Its samples
      type(samples_t), intent(in) :: clean

      type(fit_t) :: fit
      type(samples_t) :: samples
      type(error_t), allocatable :: error
      integer :: run

      do run = 1, 10
         call begin_noise(run)
         samples = clean
         ! 10 %
         call spoil(samples, 10.0_wp)
         call fit_material(fit, data%model, 0, none, samples, error)
         if (allocated(error)) cycle
         call check(.not. fit%structured, data%model//': noise is noise')
      end do
   end subroutine noise_is_noise

   !> A model that is not that of the data is told, with noise and without
   subroutine wrong_models()
      character(len=*), parameter :: wrong(3) = [character(len=14) :: 'sls', 'cerf', 'prony']
      type(parameter_t) :: fixed(1)
      type(fit_t) :: fit
      type(samples_t) :: samples
      type(error_t), allocatable :: error
      integer :: i, k, parts

      fixed(1)%name = 'relaxing_modulus'
      fixed(1)%value = 676.5e6_wp
      do i = 1, size(wrong)
         do k = 1, 4
            samples = sampled(truth('power_law'), 1.0e-6_wp, 1.0e-2_wp, 41, k > 2)
            call begin_noise(k)
            if (mod(k, 2) == 0) call spoil(samples, 2.0_wp)
            parts = merge(1, 0, wrong(i) == 'cerf')
            call fit_material(fit, trim(wrong(i)), merge(2, 0, wrong(i) == 'prony'), &
               fixed(:parts), samples, error)
            call check(.not. allocated(error), 'a wrong model is fitted')
            if (allocated(error)) cycle
            call check(fit%structured, trim(wrong(i))//' does not follow a power law')
         end do
      end do
      ! of few terms some percent are missed, of more next to nothing
      samples = sampled(truth('power_law'), 1.0e-6_wp, 1.0e-2_wp, 81, .false.)
      call fit_material(fit, 'prony', 8, none, samples, error)
      call check(.not. allocated(error), 'a series of eight terms')
      if (allocated(error)) return
      call check(.not. fit%structured, 'follows a power law over four decades')
   end subroutine wrong_models

   !> What a law says about times that the data do not have is marked
   subroutine ends_of_laws()
      type(fit_t) :: fit
      type(error_t), allocatable :: error

      call fit_material(fit, 'sls', 0, none, &
         sampled(truth('sls'), 1.0e-5_wp, 1.0e-2_wp, 41, .false.), error)
      call check(.not. allocated(error), 'an SLS from plateau to plateau')
      if (.not. allocated(error)) call check(all(fit%parameters%unseen == 0), 'is seen')
      ! it relaxes at 0.8 ms
      call fit_material(fit, 'sls', 0, none, &
         sampled(truth('sls'), 1.0e-5_wp, 5.0e-4_wp, 41, .false.), error)
      call check(.not. allocated(error), 'an SLS of which the end is not seen')
      if (.not. allocated(error)) call check(all(fit%parameters%unseen &
         == [0, unseen_later, unseen_later]), 'has its rates by extrapolation')
      call fit_material(fit, 'sls', 0, none, &
         sampled(truth('sls'), 5.0e-4_wp, 1.0e-2_wp, 41, .false.), error)
      call check(.not. allocated(error), 'an SLS of which the beginning is not seen')
      if (.not. allocated(error)) call check(all(fit%parameters%unseen &
         == [unseen_earlier, 0, 0]), 'has its glassy modulus by extrapolation')
      call fit_material(fit, 'power_law', 0, none, &
         sampled(truth('power_law'), 1.0e-6_wp, 1.0e-2_wp, 41, .true.), error)
      call check(.not. allocated(error), 'a power law')
      if (.not. allocated(error)) call check(all(fit%parameters%unseen &
         == [unseen_later, 0, 0]), 'never comes to its equilibrium modulus')
   end subroutine ends_of_laws

   !> A series whose data end before it has relaxed has no standard error of what follows
   subroutine ends_of_series()
      !> Last time of the data: before the slowest of five terms, and long after it
      real(wp), parameter :: last(2) = [2.0e-4_wp, 1.0_wp]
      type(material_data_t) :: data
      type(fit_t) :: fit
      type(samples_t) :: samples
      type(error_t), allocatable :: error
      integer :: i, k, n, right
      logical :: dynamic

      data = truth('prony')
      call data%set('equilibrium_modulus', 3.0e6_wp)
      call data%set_list('moduli', [1.0e8_wp, 6.0e7_wp, 4.0e7_wp, 3.0e7_wp, 2.0e7_wp])
      call data%set_list('rates', [1.0e6_wp, 1.0e5_wp, 1.0e4_wp, 1.0e3_wp, 1.0e2_wp])
      do k = 1, 4
         dynamic = k > 2
         right = 0
         associate (end => last(2 - mod(k, 2)))
            n = nint(10.0_wp*log10(end/1.0e-8_wp))
            do i = 1, 5
               samples = sampled(data, 1.0e-8_wp, end, n, dynamic)
               call begin_noise(i)
               call spoil(samples)
               call fit_material(fit, 'prony', 0, none, samples, error)
               if (allocated(error)) cycle
               associate (first => fit%parameters(1))
                  if (mod(k, 2) == 0) then
                     if (first%unseen == 0 &
                        .and. abs(first%value - 3.0e6_wp) < 3.0_wp*first%error) right = right + 1
                  else if (first%unseen == unseen_later .or. first%error >= first%value) then
                     right = right + 1
                  end if
               end associate
            end do
         end associate
         call check(right == 5, 'the equilibrium modulus is stated where it is seen')
      end do
   end subroutine ends_of_series

   !> What cannot be fitted
   subroutine refusals()
      type(fit_t) :: fit
      type(samples_t) :: samples
      type(error_t), allocatable :: error

      call fit_material(fit, 'mittag_leffler', 0, none, &
         sampled(truth('mittag_leffler'), 1.0e-6_wp, 1.0e-4_wp, 4, .false.), error)
      call check(allocated(error), 'four points do not give four parameters')
      if (allocated(error)) call check_contains(error%message, 'expected at least 5', 'and why')

      samples = sampled_model('sls', .false.)
      samples%modulus = 1.0e6_wp
      call fit_material(fit, 'sls', 0, none, samples, error)
      call check(allocated(error), 'a constant modulus is not fitted')
      if (allocated(error)) then
         call check(error%code == error_input, 'as an error of the input')
         call check_contains(error%message, 'elastic', 'it is elastic')
      end if

      samples = sampled_model('sls', .false.)
      call fit_material(fit, 'prony', 4, none, samples, error)
      call check(allocated(error), 'an SLS does not give a series of four terms')
      if (allocated(error)) call check(error%code == error_numerical, 'as a numerical failure')
      call check_text(fixable_parameters('prony'), 'equilibrium_modulus', 'what a series can have')
   end subroutine refusals

end program test_fit
