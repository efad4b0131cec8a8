!> What a model of a material states of its parameters: once, in the file of the model. The keys of
!> `&material`, the checks of its constructor and the bounds of a fit are made from it
module vcor_material_parameter
   use vcor_error, only : error_input, error_t, raise
   use vcor_interval, only : interval_t, interval_text, is_within
   use vcor_kinds, only : wp
   use vcor_text, only : real_text
   implicit none
   private

   public :: parameter_t, check_values
   public :: linear, logarithmic
   public :: positive, not_negative, between_0_and_1
   public :: density, poisson_ratio, equilibrium_modulus, relaxing_modulus

   !> Scale of a parameter that may be 0: a term of a sum
   integer, parameter :: linear = 1
   !> Scale of one that is a factor
   integer, parameter :: logarithmic = 2

   !> A parameter of a model, or a list of them
   type :: parameter_t
      !> Name, that of the key in &material
      character(len=26) :: name = ''
      !> What it means, one line
      character(len=72) :: meaning = ''
      !> Unit, blank for none
      character(len=8) :: unit = ''
      !> Range, in this unit
      type(interval_t) :: range = interval_t()
      !> Whether it must be given
      logical :: required = .true.
      !> Default as in a namelist; blank: none
      character(len=12) :: default = ''
      !> `linear` or `logarithmic`
      integer :: scale = logarithmic
      !> Whether a fit to data finds it
      logical :: fitted = .false.
      !> Whether it is a list of numbers
      logical :: is_list = .false.
      !> Parameter that may be given in its place, and not beside it; blank: none
      character(len=26) :: instead = ''
   end type parameter_t

   !> Ranges
   type(interval_t), parameter :: positive = interval_t(lower=0.0_wp, lower_open=.true.)
   type(interval_t), parameter :: not_negative = interval_t(lower=0.0_wp)
   type(interval_t), parameter :: between_0_and_1 = &
      interval_t(lower=0.0_wp, lower_open=.true., upper=1.0_wp, upper_open=.true.)

   !> Of every material
   type(parameter_t), parameter :: density = parameter_t('density', &
      'Density; for a sphere without mass, and for a plate with waves', 'kg/m3', positive, &
      required=.false.)
   !> Of every material that deforms
   type(parameter_t), parameter :: poisson_ratio = parameter_t('poisson_ratio', &
      "Poisson's ratio", '', interval_t(lower=-1.0_wp, lower_open=.true., upper=0.5_wp))
   !> Of every model that need not relax to nothing
   type(parameter_t), parameter :: equilibrium_modulus = parameter_t('equilibrium_modulus', &
      'Long-time modulus', 'Pa', not_negative, required=.false., default='0.0', &
      scale=linear, fitted=.true.)
   !> Of the fractional models with a glassy modulus
   type(parameter_t), parameter :: relaxing_modulus = parameter_t('relaxing_modulus', &
      'Part of the modulus that relaxes', 'Pa', positive, fitted=.true.)

contains

   !> Check values against the ranges of their parameters
   pure subroutine check_values(what, parameters, values, error)
      !> What they describe, for the message
      character(len=*), intent(in) :: what
      !> The parameters, shape (n)
      type(parameter_t), intent(in) :: parameters(:)
      !> Their values, shape (n)
      real(wp), intent(in) :: values(:)
      !> Error of code `error_input`, unallocated if all are within their ranges
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: unit
      integer :: i

      do i = 1, size(parameters)
         if (is_within(parameters(i)%range, values(i))) cycle
         unit = ''
         if (parameters(i)%unit /= '') unit = ' ['//trim(parameters(i)%unit)//']'
         call raise(error, error_input, what//', '//trim(parameters(i)%name)//': found ' &
            //real_text(values(i))//', expected a number ' &
            //interval_text(parameters(i)%range)//unit, about=trim(parameters(i)%name))
         return
      end do
   end subroutine check_values

end module vcor_material_parameter
