!> Standard errors of fits: in a thousand fits to data with noise they are what they say
program test_fit_errors
   use vcor_error, only : error_t
   use vcor_fit, only : fit_material, fit_t, samples_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_test, only : check, check_close, finish, suite
   use fit_data, only : truth, sampled, sampled_model, parameter_of, begin_noise, spoil, runs, &
      most_misses, models, none
   implicit none

   integer :: i

   call suite('fit_errors')
   do i = 1, size(models)
      call noisy_data(trim(models(i)), .false.)
      call noisy_data(trim(models(i)), .true.)
   end do
   call materials_at_bounds()
   call finish()

contains

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

end program test_fit_errors
