!> Identification of a material: fits the parameters of a model to samples of its moduli
module vcor_fit
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_kinds, only : wp
   use vcor_material_type, only : linear, parameter_t
   use vcor_number, only : interval_text, is_within
   use vcor_text, only : integer_text, printable
   use vcor_words, only : join_words
   use vcor_fit_law, only : fit_law, stated_parameters
   use vcor_fit_result, only : estimate_t, fit_t, state_bound, state_fixed, state_free, &
      unseen_earlier, unseen_later
   use vcor_fit_samples, only : moduli_of, samples_t
   use vcor_fit_prony, only : fit_prony
   implicit none
   private

   public :: fit_t, estimate_t, samples_t, moduli_of, fit_material, check_fixed, fixable_parameters
   public :: state_free, state_fixed, state_bound, unseen_earlier, unseen_later

   !> Relative change of the modulus below which it counts as constant
   real(wp), parameter :: constant = 1.0e-6_wp

contains

   !> Names of the parameters of a model that can be fixed, separated by blanks
   pure function fixable_parameters(model) result(names)
      character(len=*), intent(in) :: model
      character(len=:), allocatable :: names

      type(parameter_t), allocatable :: stated(:)
      integer :: i

      allocate (stated, source=stated_parameters(model))
      names = trim(stated(1)%name)
      do i = 2, size(stated)
         names = names//' '//trim(stated(i)%name)
      end do
   end function fixable_parameters

   !> Check parameters that are to be fixed at given values
   pure subroutine check_fixed(model, fixed, error)
      !> One of `identifiable_models`
      character(len=*), intent(in) :: model
      !> The parameters, shape (n)
      type(estimate_t), intent(in) :: fixed(:)
      !> Error of code `error_usage`; unallocated if all are parameters of the model, given once and
      !> within range
      type(error_t), allocatable, intent(out) :: error

      real(wp), parameter :: largest = 1.0e30_wp, smallest = 1.0e-30_wp
      type(parameter_t), allocatable :: stated(:)
      character(len=:), allocatable :: expected
      logical :: good
      integer :: i, k

      allocate (stated, source=stated_parameters(model))
      do i = 1, size(fixed)
         k = findloc(stated%name == fixed(i)%name, .true., dim=1)
         if (k == 0) then
            call raise(error, error_usage, "found '"//printable(trim(fixed(i)%name)) &
               //"', expected a parameter of model "//model//': ' &
               //join_words(fixable_parameters(model)))
            return
         end if
         associate (parameter => stated(k), value => fixed(i)%value)
            if (parameter%unit == '') then
               expected = interval_text(parameter%range)
            else
               expected = trim(merge('>=', '> ', parameter%scale == linear))//' 0, at most 1e30'
            end if
            good = is_within(parameter%range, value) .and. value >= smallest .and. value <= largest
            if (parameter%scale == linear) good = good .or. .not. abs(value) > 0.0_wp
         end associate
         if (.not. good) then
            call raise(error, error_usage, 'the value of '//trim(fixed(i)%name) &
               //' is out of range, expected a number '//expected)
         else if (any(fixed(:i - 1)%name == fixed(i)%name)) then
            call raise(error, error_usage, trim(fixed(i)%name)//' is given twice')
         end if
         if (allocated(error)) return
      end do
      if (model /= 'sls' .or. size(fixed) < 2) return
      if (sum(fixed%value, fixed%name == 'alpha') > sum(fixed%value, fixed%name == 'beta') &
         .and. any(fixed%name == 'beta')) call raise(error, error_usage, 'found alpha above ' &
         //'beta, expected alpha <= beta: the rubbery modulus is glassy_modulus*alpha/beta')
   end subroutine check_fixed

   !> Fit a model to samples
   subroutine fit_material(fit, model, terms, fixed, samples, error)
      type(fit_t), intent(out) :: fit
      !> One of `identifiable_models`
      character(len=*), intent(in) :: model
      !> Number of terms of a Prony series; 0: as many as the data support
      integer, intent(in) :: terms
      !> Fixed parameters, shape (n)
      type(estimate_t), intent(in) :: fixed(:)
      type(samples_t), intent(in) :: samples
      !> Error of code `error_usage` if the fixed values are impossible, `error_input` if the data
      !> cannot be fitted, `error_numerical` if the fit fails; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: equilibrium
      integer :: unknowns

      call check_fixed(model, fixed, error)
      if (allocated(error)) return
      unknowns = size(stated_parameters(model)) - size(fixed)
      if (model == 'prony') unknowns = unknowns + 2*max(1, terms)
      if (samples%count() <= unknowns) then
         call raise(error, error_input, 'found '//integer_text(samples%count())//' moduli, ' &
            //'expected at least '//integer_text(unknowns + 1)//': the model has ' &
            //integer_text(unknowns)//' parameters to be found')
      else if (.not. samples%dynamic .and. maxval(samples%modulus) &
         <= (1.0_wp + constant)*minval(samples%modulus)) then
         call raise(error, error_input, 'the modulus does not change: nothing is there to be ' &
            //"fitted, model = 'elastic' describes it")
      else if (.not. falls(samples)) then
         call raise(error, error_input, 'the modulus does not fall with time, or rise with ' &
            //'frequency, as that of a material that relaxes does')
      else if (unknowns == 0) then
         call raise(error, error_usage, 'all parameters are given: nothing is there to be fitted')
      end if
      if (allocated(error)) return

      if (model == 'prony') then
         equilibrium = -1.0_wp
         if (size(fixed) > 0) equilibrium = fixed(size(fixed))%value
         call fit_prony(fit, terms, equilibrium, samples, error)
      else
         call fit_law(fit, model, fixed, samples, error)
      end if
   end subroutine fit_material

   !> Whether the modulus falls with time, or rises with frequency, over all samples: by the sign of
   !> its regression slope on logarithmic scales
   pure function falls(samples) result(yes)
      !> The samples, at least two
      type(samples_t), intent(in) :: samples
      logical :: yes

      real(wp) :: x(size(samples%at))

      x = log(samples%at)
      x = x - sum(x)/real(size(x), wp)
      if (samples%dynamic) x = -x
      yes = dot_product(x, log(samples%modulus)) < 0.0_wp
   end function falls

end module vcor_fit
