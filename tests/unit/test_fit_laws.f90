!> Fits of the models with a few parameters: those of exact data come back, at bounds too
program test_fit_laws
   use vcor_error, only : error_t
   use vcor_fit, only : estimate_t, fit_material, fit_t, fixable_parameters, samples_t, &
      state_bound, state_fixed, state_free
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use fit_data, only : truth, sampled, sampled_model, parameter_of, exact, noise, models, none
   implicit none

   integer :: i

   call suite('fit_laws')
   do i = 1, size(models)
      call exact_data(trim(models(i)), .false.)
      call exact_data(trim(models(i)), .true.)
      call fixed_parameters(trim(models(i)))
   end do
   call error_of_nothing()
   call vanishing_modulus()
   call exponent_of_one()
   call runaway_time()
   call finish()

contains

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
      type(estimate_t) :: fixed(1)
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

   !> The equilibrium modulus alone is to be found and is 0: the error is that of a sum of known
   !> terms, of which d ln E / d E_0 = 1/E
   subroutine error_of_nothing()
      !> The end of the interval is found to this part, and the logarithm is no straight line
      real(wp), parameter :: tolerance = 0.05_wp
      type(fit_t) :: fit
      type(material_data_t) :: data
      type(samples_t) :: samples
      type(estimate_t) :: fixed(2)
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

end program test_fit_laws
