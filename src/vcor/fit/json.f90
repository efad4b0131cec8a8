!> A fit as a JSON document, which `vcor fit --json` writes and the Python package reads
module vcor_fit_json
   use vcor_json, only : array, member, numbers, object
   use vcor_text, only : integer_text
   use vcor_fit_result, only : fit_t
   use vcor_fit_samples, only : samples_t
   use vcor_kinds, only : wp
   use vcor_version, only : version
   implicit none
   private

   public :: fit_json, parameter_name, shift_note

   !> States of a parameter, by their numbers
   character(len=*), parameter :: states(0:2) = ['free ', 'fixed', 'bound']

contains

   !> Name of a parameter as a key of &material, with the index of its term in a series
   pure function parameter_name(fit, i) result(name)
      type(fit_t), intent(in) :: fit
      integer, intent(in) :: i
      character(len=:), allocatable :: name

      name = trim(fit%parameters(i)%name)
      if (fit%data%model == 'prony' .and. i > 1) name = name//'('//integer_text(i/2)//')'
   end function parameter_name

   !> Note that the standard errors of a fit to a master curve omit the errors of the shift factors:
   !> these move all points of a temperature together, which no misfit shows
   pure function shift_note(samples) result(text)
      type(samples_t), intent(in) :: samples
      !> The note; empty for data without a shift
      character(len=:), allocatable :: text

      text = ''
      if (.not. allocated(samples%keys)) return
      if (index(samples%keys, ' shift =') > 0) text = 'the standard errors leave out those of ' &
         //'the shift factors: vcor identify fits moduli and shift at once'
   end function shift_note

   !> The document: parameters in SI units, covariance, correlation, misfit and band of the data
   pure function fit_json(fit, samples, group) result(text)
      type(fit_t), intent(in) :: fit
      type(samples_t), intent(in) :: samples
      !> The material as a &material group
      character(len=*), intent(in) :: group
      character(len=:), allocatable :: text

      character(len=:), allocatable :: list, covariance, correlation
      integer :: i

      list = ''
      covariance = ''
      correlation = ''
      do i = 1, size(fit%parameters)
         associate (one => fit%parameters(i))
            list = list//object(member('name', parameter_name(fit, i))//member('unit', one%unit) &
               //member('value', one%value)//member('standard_error', one%error) &
               //member('state', trim(states(one%state))))
            correlation = correlation//array(numbers(fit%correlation(:, i)))
            covariance = covariance//array(numbers(fit%correlation(:, i)*(one%error &
               *fit%parameters%error)))
         end associate
      end do
      text = object(member('program', 'vcor')//member('version', version) &
         //member('name', fit%data%name)//member('model', fit%data%model) &
         //array(list, 'parameters')//array(covariance, 'covariance') &
         //array(correlation, 'correlation')//member('rms_misfit', fit%rms) &
         //member('largest_misfit', fit%largest)//member('largest_misfit_at', fit%largest_at) &
         //member('follows', .not. fit%structured)//member('note', shift_note(samples)) &
         //array(numbers([samples%first_time(), samples%last_time()]), 'band') &
         //member('group', group))
      text = text(:len(text) - 2)//new_line('a')
   end function fit_json

end module vcor_fit_json
