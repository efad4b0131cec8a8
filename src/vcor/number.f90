!> Real numbers of the input: the ranges that they must be in, and their form in a text
!>
!> The compiler reads each number, so Fortran's rules hold. Input that it would accept silently is
!> refused first: NaN, infinity, numbers out of the range of the kind, and anything that is not
!> entirely a number.
module vcor_number
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, lower, shortened
   implicit none
   private

   public :: interval_t, contains_number, is_within, is_computable, interval_text
   public :: positive, not_negative, between_0_and_1
   public :: spaced, log_spacing
   public :: most_magnitude, least_magnitude
   public :: read_real, looks_numeric, real_text, identity_of

   !> Largest magnitude that is accepted on input
   real(wp), parameter :: largest = 1.0e300_wp
   !> Smallest nonzero magnitude that is accepted on input
   real(wp), parameter :: smallest = 1.0e-300_wp
   !> Magnitudes of the numbers of a case: nothing physical is beyond, and products of five are
   !> finite
   real(wp), parameter :: most_magnitude = 1.0e60_wp, least_magnitude = 1.0e-60_wp

   !> Spacing with equal steps of the logarithm; any other word means equal steps of the value
   character(len=*), parameter :: log_spacing = 'log'

   !> Power of ten beyond which a number is not read
   integer, parameter :: largest_power = 300
   character(len=*), parameter :: decimal_digits = "0123456789"

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

   !> Common ranges
   type(interval_t), parameter :: positive = interval_t(lower=0.0_wp, lower_open=.true.)
   type(interval_t), parameter :: not_negative = interval_t(lower=0.0_wp)
   type(interval_t), parameter :: between_0_and_1 = &
      interval_t(lower=0.0_wp, lower_open=.true., upper=1.0_wp, upper_open=.true.)

contains

   !> Identity of a list, equal for equal lists: different ones have different identities except by
   !> chance, one in 2^62. It is computed once, where the list is read
   pure function identity_of(list) result(identity)
      !> Shape (n)
      real(wp), intent(in) :: list(:)
      integer(int64) :: identity

      ! multiplication by a prime below 2^31 modulo the prime 2^31 - 1, of two halves each, so that
      ! no product overflows
      integer(int64), parameter :: modulus = 2147483647_int64, factors(2) = [48271_int64, &
         69621_int64]
      integer(int64) :: bits, part, sums(2)
      integer :: i, half, k

      sums = size(list) + 1_int64
      do i = 1, size(list)
         bits = transfer(list(i), bits)
         do half = 0, 1
            part = ibits(bits, 32*half, 32)
            do k = 1, 2
               sums(k) = modulo(sums(k)*factors(k) + part, modulus)
            end do
         end do
      end do
      identity = ishft(sums(1), 31) + sums(2)
   end function identity_of

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

      yes = abs(number) <= most_magnitude &
         .and. (abs(number) >= least_magnitude .or. .not. abs(number) > 0.0_wp)
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
      ! within the range of an integer, 2.1e9
      real(wp), parameter :: whole_below = 1.0e9_wp

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

   !> Read a real number
   subroutine read_real(word, expected, number, message)
      !> The number as written
      character(len=*), intent(in) :: word
      !> Expected input, for the message
      character(len=*), intent(in) :: expected
      real(wp), intent(out) :: number
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      logical :: good
      integer :: power, status

      number = 0.0_wp
      status = 0
      call look_at_number(word, good, power)
      ! Reading a number beyond the range of the kind traps in a debug build
      if (good .and. abs(power) <= largest_power) read(word, *, iostat=status) number
      if (.not. good .or. status /= 0) then
         message = "found '"//shortened(word)//"', expected "//expected
         if (is_not_finite(word)) message = message//", finite"
      else if (power > largest_power .or. abs(number) > largest) then
         message = "found "//shortened(word) &
            //", which is too large, expected at most 1e300 in magnitude"
      else if (power < -largest_power .or. (abs(number) > 0.0_wp .and. abs(number) < smallest)) then
         message = "found "//shortened(word) &
            //", which is too small, expected 0 or at least 1e-300 in magnitude"
      end if
   end subroutine read_real

   !> Whether a word is a number, infinity or NaN
   pure function looks_numeric(word) result(yes)
      character(len=*), intent(in) :: word
      logical :: yes
      integer :: power

      call look_at_number(word, yes, power)
      yes = yes .or. is_not_finite(word)
   end function looks_numeric

   !> Whether a word is a number by Fortran's rules, and its order of magnitude
   pure subroutine look_at_number(word, good, power)
      character(len=*), intent(in) :: word
      !> Whether it has digits with or without a point, and perhaps a sign and a lettered exponent
      logical, intent(out) :: good
      !> Power of ten of its first nonzero digit; 0 for zero
      integer, intent(out) :: power

      integer, parameter :: most_digits = 6
      integer :: first, last, point, leading, exponent, shift

      ! the mantissa
      power = 0
      first = 1
      if (scan(word, '+-') == 1) first = 2
      last = first + verify(word(first:)//' ', decimal_digits//'.') - 2
      good = scan(word(first:last), decimal_digits) > 0
      if (.not. good) return
      point = first + index(word(first:last)//'.', '.') - 1
      leading = first + scan(word(first:last), '123456789') - 1
      if (leading >= first) power = merge(point - leading - 1, point - leading, leading < point)
      if (point < last) good = index(word(point + 1:last), '.') == 0
      if (.not. good .or. last == len(word)) return

      ! the exponent, from its first nonzero digit
      exponent = last + 2
      good = scan(word(last + 1:last + 1), 'eEdD') == 1
      if (good .and. scan(word(exponent:), '+-') == 1) exponent = exponent + 1
      good = good .and. exponent <= len(word) .and. verify(word(exponent:), decimal_digits) == 0
      if (.not. good .or. leading < first) return
      shift = 0
      exponent = exponent + verify(word(exponent:)//'.', '0') - 1
      if (len(word) - exponent >= most_digits) then
         shift = 10**most_digits
      else if (exponent <= len(word)) then
         read (word(exponent:), *) shift
      end if
      power = power + merge(-shift, shift, word(last + 2:last + 2) == '-')
   end subroutine look_at_number

   !> Whether a word denotes infinity or NaN
   pure function is_not_finite(word) result(yes)
      character(len=*), intent(in) :: word
      logical :: yes
      integer :: first

      first = 1
      if (scan(word, "+-") == 1) first = 2
      select case (lower(word(first:)))
      case ("nan", "inf", "infinity")
         yes = .true.
      case default
         yes = .false.
      end select
   end function is_not_finite

   !> A real number in the shortest form that restores the same bits: `0.01`, `7.0e10`
   pure function real_text(number) result(text)
      !> The number, finite or not
      real(wp), intent(in) :: number
      !> Its text, at most 24 characters
      character(len=:), allocatable :: text
      character(len=*), parameter :: formats(3) = ["(es32.14e3)", "(es32.15e3)", "(es32.16e3)"]
      character(len=32) :: buffer
      real(wp) :: back
      integer :: digits, status

      if (.not. ieee_is_finite(number)) then
         text = trim(merge("NaN     ", "Infinity", ieee_is_nan(number)))
         return
      end if
      do digits = merge(1, size(formats), abs(number) < largest), size(formats)
         write(buffer, formats(digits)) number
         if (digits == size(formats)) exit
         read(buffer, *, iostat=status) back
         if (status == 0 .and. abs(back - number) <= 0.0_wp) exit
      end do
      text = tidied(trim(adjustl(buffer)))
   end function real_text

   !> A number from an `es` format, without superfluous zeros
   pure function tidied(scientific) result(text)
      !> Such as `-1.50000000000000E+003`
      character(len=*), intent(in) :: scientific
      !> Such as `-1500.0`
      character(len=:), allocatable :: text
      character(len=:), allocatable :: digits, sign
      integer, parameter :: fixed_below = 6, fixed_above = -5
      integer :: start, mark, exponent, length

      sign = ""
      start = 1
      if (scientific(1:1) == "-") then
         sign = "-"
         start = 2
      end if
      mark = index(scientific, "E")
      read(scientific(mark+1:), *) exponent
      digits = scientific(start:start)//scientific(start+2:mark-1)
      length = max(1, verify(digits, "0", back=.true.))
      digits = digits(:length)

      if (exponent >= fixed_below .or. exponent <= fixed_above) then
         if (length == 1) digits = digits//"0"
         text = sign//digits(1:1)//"."//digits(2:)//"e"//integer_text(exponent)
      else if (exponent < 0) then
         text = sign//"0."//repeat("0", -exponent - 1)//digits
      else
         if (length < exponent + 2) digits = digits//repeat("0", exponent + 2 - length)
         text = sign//digits(:exponent+1)//"."//digits(exponent+2:)
      end if
   end function tidied

end module vcor_number
