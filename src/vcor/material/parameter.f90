!> Ranges of numbers, spaced values, and the parameters of material models. Each model states its
!> parameters once, in its own file; the keys of `&material`, the checks of its constructor and the
!> bounds of a fit follow from them
module vcor_material_parameter
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, real_text
   implicit none
   private

   public :: interval_t, contains_number, is_within, is_computable, interval_text, largest, smallest
   public :: spaced, log_spacing, parameter_t, check_values, power_of_time
   public :: linear, logarithmic
   public :: positive, not_negative, between_0_and_1
   public :: density, poisson_ratio, equilibrium_modulus, relaxing_modulus

   !> Largest magnitude that is accepted on input
   real(wp), parameter :: largest = 1.0e300_wp
   !> Smallest nonzero magnitude that is accepted on input
   real(wp), parameter :: smallest = 1.0e-300_wp
   !> Magnitudes of the numbers of a case: nothing physical is beyond, and products of several are
   !> finite
   real(wp), parameter :: most = 1.0e60_wp, least = 1.0e-60_wp

   !> Spacing with equal steps of the logarithm; any other word means equal steps of the value
   character(len=*), parameter :: log_spacing = 'log'

   !> Range of a number
   type :: interval_t
      !> Lower bound, in the unit of the key
      real(wp) :: lower = -largest
      !> Upper bound, in the unit of the key
      real(wp) :: upper = largest
      !> Whether the lower bound itself is outside
      logical :: lower_open = .false.
      !> Whether the upper bound itself is outside
      logical :: upper_open = .false.
   end type interval_t

   !> Scale of a parameter that may be 0, such as a term of a sum
   integer, parameter :: linear = 1
   !> Scale of a parameter that is a factor
   integer, parameter :: logarithmic = 2

   !> A parameter of a model, a number or a list
   type :: parameter_t
      !> Name, which is the key in &material
      character(len=26) :: name = ''
      !> Meaning, one line
      character(len=72) :: meaning = ''
      !> Unit, blank for none
      character(len=8) :: unit = ''
      !> Range, in the unit above
      type(interval_t) :: range = interval_t()
      !> Whether it is required
      logical :: required = .true.
      !> Default as in a namelist; blank: none
      character(len=12) :: default = ''
      !> `linear` or `logarithmic`
      integer :: scale = logarithmic
      !> Whether `vcor fit` determines it
      logical :: fitted = .false.
      !> Whether it is a list of numbers
      logical :: is_list = .false.
      !> Parameter that may be given instead, but not in addition; blank: none
      character(len=26) :: instead = ''
   end type parameter_t

   !> Common ranges
   type(interval_t), parameter :: positive = interval_t(lower=0.0_wp, lower_open=.true.)
   type(interval_t), parameter :: not_negative = interval_t(lower=0.0_wp)
   type(interval_t), parameter :: between_0_and_1 = &
      interval_t(lower=0.0_wp, lower_open=.true., upper=1.0_wp, upper_open=.true.)

   !> Parameter of every material
   type(parameter_t), parameter :: density = parameter_t('density', &
      'Density; for a sphere without mass, and for a plate with waves', 'kg/m3', positive, &
      required=.false.)
   !> Parameter of every material that deforms
   type(parameter_t), parameter :: poisson_ratio = parameter_t('poisson_ratio', &
      "Poisson's ratio", '', interval_t(lower=-1.0_wp, lower_open=.true., upper=0.5_wp))
   !> Parameter of every model that may have an equilibrium modulus
   type(parameter_t), parameter :: equilibrium_modulus = parameter_t('equilibrium_modulus', &
      'Long-time modulus', 'Pa', not_negative, required=.false., default='0.0', &
      scale=linear, fitted=.true.)
   !> Parameter of the fractional models with a finite glassy modulus
   type(parameter_t), parameter :: relaxing_modulus = parameter_t('relaxing_modulus', &
      'Part of the modulus that relaxes', 'Pa', positive, fitted=.true.)

contains

   !> Check values against the ranges of their parameters
   pure subroutine check_values(what, parameters, values, error)
      !> Material model, for the message
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

   !> Power of time in a unit of times, rates or their roots; 0 for others
   elemental function power_of_time(unit) result(power)
      character(len=*), intent(in) :: unit
      real(wp) :: power

      power = merge(1.0_wp, 0.0_wp, unit == 's')
      if (unit == '1/s') power = -1.0_wp
      if (unit == 's^1/2') power = 0.5_wp
      if (unit == 's^-1/2') power = -0.5_wp
   end function power_of_time

   !> Whether a number is within a range
   pure function contains_number(range, number) result(yes)
      type(interval_t), intent(in) :: range
      !> The number, finite or not
      real(wp), intent(in) :: number
      !> False for NaN, infinity, and magnitudes too large or too small to compute with
      logical :: yes

      yes = is_within(range, number)
      if (yes) yes = is_computable(number)
   end function contains_number

   !> Whether a number is finite and within the bounds of a range
   pure function is_within(range, number) result(yes)
      type(interval_t), intent(in) :: range
      !> The number, finite or not
      real(wp), intent(in) :: number
      logical :: yes

      ! separate statement: comparing a NaN traps in a debug build
      yes = ieee_is_finite(number)
      if (.not. yes) return
      yes = (number >= range%lower .or. range%lower <= -largest) &
         .and. (number <= range%upper .or. range%upper >= largest)
      if (range%lower_open) yes = yes .and. number > range%lower
      if (range%upper_open) yes = yes .and. number < range%upper
   end function is_within

   !> Whether a finite number is zero or of a magnitude that computations can handle
   pure function is_computable(number) result(yes)
      real(wp), intent(in) :: number
      logical :: yes

      yes = abs(number) <= most .and. (abs(number) >= least .or. .not. abs(number) > 0.0_wp)
   end function is_computable

   !> A range as text: `> 0`, `in (-1, 0.5]`; empty without bounds
   pure function interval_text(range) result(text)
      type(interval_t), intent(in) :: range
      character(len=:), allocatable :: text

      if (range%lower > -largest .and. range%upper < largest) then
         text = "in "//merge("(", "[", range%lower_open)//bound_text(range%lower)//", " &
            //bound_text(range%upper)//merge(")", "]", range%upper_open)
      else if (range%lower > -largest) then
         text = trim(merge("> ", ">=", range%lower_open))//" "//bound_text(range%lower)
      else if (range%upper < largest) then
         text = trim(merge("< ", "<=", range%upper_open))//" "//bound_text(range%upper)
      else
         text = ""
      end if
   end function interval_text

   !> A bound as text; whole numbers without a fraction
   pure function bound_text(bound) result(text)
      real(wp), intent(in) :: bound
      character(len=:), allocatable :: text
      real(wp), parameter :: whole_below = 1.0e6_wp

      text = real_text(bound)
      if (abs(bound) >= whole_below) return
      if (abs(bound - anint(bound)) <= 0.0_wp) text = integer_text(nint(bound))
   end function bound_text

   !> Values between two ends, which are included exactly
   pure function spaced(start, stop, count, spacing) result(values)
      !> First value; > 0 with logarithmic spacing
      real(wp), intent(in) :: start
      !> Last value, which may be below the first one; > 0 with logarithmic spacing
      real(wp), intent(in) :: stop
      !> Number of values, > 0; a single value is `start`
      integer, intent(in) :: count
      !> `linear` or `log`
      character(len=*), intent(in) :: spacing
      !> The values, shape (count)
      real(wp) :: values(count)

      integer :: i

      ! both forms are exact for whole numbers and decades
      do i = 2, count - 1
         if (spacing == log_spacing) then
            values(i) = 10.0_wp**between(log10(start), log10(stop))
         else
            values(i) = between(start, stop)
         end if
      end do
      values(count) = stop
      values(1) = start

   contains

      !> Value i of `count` in equal steps
      pure function between(a, b)
         !> First value
         real(wp), intent(in) :: a
         !> Last value
         real(wp), intent(in) :: b
         !> Value i
         real(wp) :: between

         between = (a*real(count - i, wp) + b*real(i - 1, wp))/real(count - 1, wp)
      end function between
   end function spaced

end module vcor_material_parameter
