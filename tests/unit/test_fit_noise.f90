!> What a fit says of the data: whether misfits are noise, what relaxes before and after them
program test_fit_noise
   use vcor_error, only : error_input, error_numerical, error_t
   use vcor_fit, only : estimate_t, fit_material, fit_t, fixable_parameters, samples_t, &
      unseen_earlier, unseen_later
   use vcor_fit_result, only : is_structured
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_test, only : check, check_contains, check_text, finish, suite
   use fit_data, only : truth, sampled, sampled_model, draw, begin_noise, spoil, models, none
   implicit none

   integer :: i

   call suite('fit_noise')
   do i = 1, size(models)
      call noise_is_noise(truth(trim(models(i))), sampled_model(trim(models(i)), .false.))
      call noise_is_noise(truth(trim(models(i))), sampled_model(trim(models(i)), .true.))
   end do
   call chance()
   call noise_is_noise(truth('prony'), sampled(truth('prony'), 1.0e-6_wp, 1.0e-1_wp, 61, .false.))
   call noise_is_noise(truth('prony'), sampled(truth('prony'), 1.0e-6_wp, 1.0e-1_wp, 61, .true.))
   call wrong_models()
   call ends_of_laws()
   call ends_of_series()
   call a_damaged_value()
   call refusals()
   call finish()

contains

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
      type(estimate_t) :: fixed(1)
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

   !> A loss modulus with a damaged exponent, twelve decades off, is a misfit and no stop: a trial
   !> material without any loss has a logarithm there
   subroutine a_damaged_value()
      type(fit_t) :: fit
      type(samples_t) :: samples
      type(error_t), allocatable :: error

      samples%dynamic = .true.
      samples%at = [6.3e-2_wp, 0.63_wp, 6.3_wp, 63.0_wp, 630.0_wp]
      samples%modulus = [2.8e6_wp, 3.0e6_wp, 4.0e6_wp, 6.0e6_wp, 9.5e6_wp]
      samples%loss = [1.0e18_wp, 5.0e5_wp, 1.0e6_wp, 2.0e6_wp, 3.0e6_wp]
      call fit_material(fit, 'sls', 0, none, samples, error)
      call check(.not. allocated(error), 'a damaged value is fitted')
      if (.not. allocated(error)) call check(fit%largest > 1.0_wp, 'and said to be far off')
   end subroutine a_damaged_value

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

end program test_fit_noise
