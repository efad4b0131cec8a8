!> Labels of figures: units that suit the numbers, parameters by their paths, numbers as text
module vcor_figure_label
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_io_figure, only : plain
   use vcor_kinds, only : wp
   implicit none
   private

   public :: suit_unit, with_unit, quantity_label, parameter_label, number_text, is_geometric
   public :: largest_of, rounded_text

contains

   !> A unit with a prefix, such that the largest of some numbers has one to three digits before the
   !> point, or none; a power of ten for pure numbers that are all very small
   pure subroutine suit_unit(unit, largest, factor, name)
      !> SI unit, or any text: it comes from a file
      character(len=*), intent(in) :: unit
      !> Largest magnitude, in that unit
      real(wp), intent(in) :: largest
      !> What the numbers are multiplied by
      real(wp), intent(out) :: factor
      !> The unit with its prefix, as a figure takes it
      character(len=:), allocatable, intent(out) :: name

      character(len=*), parameter :: prefixes(-6:3) = [character(len=2) :: 'a', 'f', 'p', 'n', &
         'µ', 'm', '', 'k', 'M', 'G']
      ! Pure numbers below are told in powers of ten, frequencies from there on with a prefix: their
      ! digits would not find room beside an axis
      real(wp), parameter :: small = 1.0e-3_wp, many = 1.0e5_wp
      character(len=12) :: exponent
      integer :: power
      real(wp) :: magnitude

      factor = 1.0_wp
      name = plain(unit)
      if (.not. ieee_is_finite(largest)) return
      if (.not. largest > 0.0_wp) return
      magnitude = largest
      select case (unit)
      case ('s', 'm', 'N', 'J', 'Pa', 'N s', 'Pa s')
         continue
      case ('kg')
         magnitude = 1000.0_wp*largest
         name = 'g'
      case ('rad/s')
         if (largest < many) return
      case ('', '1')
         if (largest >= small) return
         power = floor(log10(largest*1.001_wp))
         factor = 10.0_wp**(-power)
         write (exponent, '(i0)') power
         name = '10^{'//trim(exponent)//'}'
         return
      case default
         return
      end select
      ! times, lengths and energies rather in tenths than in hundreds: 0.79 J, but 920 N
      if (scan(unit, 'smJ') == 1 .and. len(unit) == 1) magnitude = 10.0_wp*magnitude
      ! 1000.0001 is 1000 still, and 0.9999 is as good as 1
      power = floor(log10(magnitude*1.001_wp)/3.0_wp)
      power = max(lbound(prefixes, 1), min(ubound(prefixes, 1), power))
      ! there is no Gm in an impact, and no ks
      if (unit == 's' .or. unit == 'm') power = min(0, power)
      factor = 10.0_wp**(-3*power)
      if (unit == 'kg') factor = 1000.0_wp*factor
      name = trim(prefixes(power))//name
   end subroutine suit_unit

   !> A label with its unit
   pure function with_unit(meaning, unit) result(label)
      character(len=*), intent(in) :: meaning
      !> Unit; empty or `1` for a pure number
      character(len=*), intent(in) :: unit
      !> Both
      character(len=:), allocatable :: label

      label = meaning
      if (unit /= '' .and. unit /= '1') label = label//' ['//unit//']'
   end function with_unit

   !> Label of a quantity of the summary, short enough for an axis
   pure function quantity_label(name, long_name) result(label)
      character(len=*), intent(in) :: name
      !> What the file says it is
      character(len=*), intent(in) :: long_name
      !> What it is, in short
      character(len=:), allocatable :: label

      integer :: mark

      label = long_name
      if (label == '') label = spaced(name)
      mark = index(label, ',')
      ! the two coefficients of restitution differ after the comma
      if (mark > 1 .and. name /= 'cor_sphere') label = label(:mark - 1)
   end function quantity_label

   !> Label of a parameter that is swept, short enough for an axis
   pure function parameter_label(path) result(label)
      !> Its path, such as `sls_rubber.beta`
      character(len=*), intent(in) :: path
      !> `sls rubber beta`; the key alone where that is too long
      character(len=:), allocatable :: label

      integer, parameter :: longest = 30

      label = spaced(path)
      if (len(label) > longest) label = spaced(path(index(path, '.', back=.true.) + 1:))
   end function parameter_label

   !> A name with blanks for points and underscores
   pure function spaced(name) result(words)
      character(len=*), intent(in) :: name
      character(len=len(name)) :: words

      integer :: i

      words = name
      do i = 1, len(words)
         if (scan(words(i:i), '._') > 0) words(i:i) = ' '
      end do
   end function spaced

   !> A number with so many significant digits, without zeros at its end
   pure function number_text(value, digits) result(text)
      real(wp), intent(in) :: value
      !> Digits, 1 .. 15
      integer, intent(in) :: digits
      character(len=:), allocatable :: text

      integer :: mark

      text = rounded_text(value, digits)
      mark = index(text, '×')
      if (mark == 0) then
         text = without_zeros(text)
      else
         text = without_zeros(text(:mark - 1))//text(mark:)
      end if
   end function number_text

   !> A number that was rounded to so many significant digits
   pure function rounded_text(value, digits) result(text)
      real(wp), intent(in) :: value
      !> Digits, 1 .. 15
      integer, intent(in) :: digits
      character(len=:), allocatable :: text

      character(len=40) :: buffer
      character(len=12) :: form
      integer :: decimals, power

      if (.not. ieee_is_finite(value)) then
         text = 'none'
         return
      end if
      if (.not. abs(value) > 0.0_wp) then
         text = '0'
         return
      end if
      write (form, '(a, i0, a)') '(es40.', digits - 1, 'e4)'
      write (buffer, form) value
      read (buffer(36:), *) power
      if (power < -4 .or. power > max(5, digits)) then
         text = trim(adjustl(buffer(:34)))
         write (form, '(i0)') power
         text = text//'×10^{'//trim(form)//'}'
         return
      end if
      decimals = max(0, digits - 1 - power)
      write (form, '(a, i0, a)') '(f40.', decimals, ')'
      write (buffer, form) value
      text = trim(adjustl(buffer))
      if (text(len(text):) == '.') text = text(:len(text) - 1)
   end function rounded_text

   !> A number without zeros after the last digit that counts
   pure function without_zeros(number) result(text)
      !> Digits with or without a point
      character(len=*), intent(in) :: number
      !> The same, shorter
      character(len=:), allocatable :: text

      text = number
      if (index(text, '.') == 0) return
      text = text(:verify(text, '0', back=.true.))
      if (text(len(text):) == '.') text = text(:len(text) - 1)
   end function without_zeros

   !> Whether values are in equal steps of their logarithm rather than of themselves
   pure function is_geometric(values) result(yes)
      real(wp), intent(in) :: values(:)
      !> True if they are; fewer than three values are not
      logical :: yes

      real(wp), parameter :: tolerance = 1.0e-6_wp
      real(wp) :: step
      integer :: i, n

      n = size(values)
      yes = .false.
      if (n < 3) return
      do i = 1, n
         if (.not. ieee_is_finite(values(i))) return
         if (.not. values(i) > 0.0_wp) return
      end do
      step = log(values(n)/values(1))/real(n - 1, wp)
      if (.not. abs(step) > 0.0_wp) return
      do i = 2, n
         if (abs(log(values(i)/values(i - 1)) - step) > tolerance*abs(step)) return
      end do
      yes = .true.
   end function is_geometric

   !> Largest magnitude of some values
   pure function largest_of(values) result(largest)
      !> Values; what is not finite does not count
      real(wp), intent(in) :: values(:)
      !> Largest magnitude, -1 if none is finite
      real(wp) :: largest

      integer :: i

      largest = -1.0_wp
      do i = 1, size(values)
         if (.not. ieee_is_finite(values(i))) cycle
         largest = max(largest, abs(values(i)))
      end do
   end function largest_of

end module vcor_figure_label
