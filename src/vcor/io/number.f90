!> Real numbers as text with 17 significant digits, which any reader converts back to the same bits
!>
!> The form is that of C's `%.16e`: `-1.2345678901234567e-05`, with a three-digit exponent if two
!> digits are not enough; `nan`, `inf` and `-inf`. The digits are correctly rounded.
!>
!> A formatted write of gfortran takes 1.4 us per number, more than everything else in writing a
!> large table. So a number M 2^e is multiplied by a power of ten, 5^k 2^k, in 27-bit limbs; the 17
!> digits are the integer part of a shifted product. 5^k is truncated to 81 bits, an error of 1e-6
!> of the last digit. Only if the fractional part is that close to one half, where rounding changes,
!> the formatted write decides, as for numbers of 1e17 and above and for subnormal numbers, which
!> are rare. Pairs of reals would not do: the compiler may contract their products and sums.
module vcor_io_number
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_kinds, only : wp
   implicit none
   private

   public :: decimal_t, new_decimal, put_real, put_integer
   public :: longest_real, longest_integer

   !> Longest text of a real number [characters]
   integer, parameter :: longest_real = 24
   !> Longest text of an integer [characters]
   integer, parameter :: longest_integer = 11

   !> Largest power of ten that makes 17 digits the integer part of a number
   integer, parameter :: last_power = 16 + 309
   !> 10^17, which has one digit too many
   integer(int64), parameter :: too_large = 10_int64**17
   !> Bits of the fraction and bias of the exponent, IEEE 754 binary64
   integer, parameter :: fraction_bits = 52, bias = 1023
   !> Exponent field of infinity and NaN
   integer(int64), parameter :: special_exponent = 2047_int64
   !> Bits of a limb: the sum of three products of limbs is far from overflow
   integer, parameter :: limb_bits = 27
   !> Highest limb of the powers of five, counted from 0
   integer, parameter :: top = 2
   !> log10(2)
   real(wp), parameter :: log10_of_2 = 0.30102999566398119521_wp

   !> Powers of ten for the conversion, from `new_decimal`
   type :: decimal_t
      private
      !> 5^k = 2^exponent sum_i limb(i) 2^(27 i), the highest bit set, k = 0 .. `last_power`
      integer(int64) :: limb(0:top, 0:last_power)
      !> Power of two
      integer :: exponent(0:last_power)
      !> The numbers 0 to 99 as two digits
      character(len=2) :: pairs(0:99)
   end type decimal_t

contains

   !> Compute the powers of ten: about 20 us, once per table
   pure subroutine new_decimal(decimal)
      !> Powers of ten for `put_real`
      type(decimal_t), intent(out) :: decimal
      ! two additional limbs for the errors of about 300 products
      integer(int64) :: limb(0:top+2)
      integer :: exponent, k

      limb = 0_int64
      limb(top+2) = 2_int64**(limb_bits - 1)
      exponent = 1 - limb_bits*(top + 1)
      do k = 0, last_power
         if (k > 0) call times_five(limb, exponent)
         decimal%limb(:, k) = limb(2:)
         decimal%exponent(k) = exponent
      end do

      do k = 0, 99
         decimal%pairs(k) = achar(iachar('0') + k/10)//achar(iachar('0') + mod(k, 10))
      end do
   end subroutine new_decimal

   !> Write a real number into a buffer
   pure subroutine put_real(decimal, x, buffer, last)
      !> Powers of ten
      type(decimal_t), intent(in) :: decimal
      !> Any number, including NaN and infinity
      real(wp), intent(in) :: x
      !> Buffer with room for `longest_real` characters after `last`
      character(len=*), intent(inout) :: buffer
      !> Last character in use, before and after
      integer, intent(inout) :: last
      ! exponent of 2^56 = 7.2e16, above which negative powers of ten would be needed
      integer, parameter :: largest_exponent = 55
      integer(int64) :: bits, digits, field, fraction
      integer :: exponent, power

      ! compare bits only: an ordered comparison with NaN traps in a debug build
      bits = transfer(x, 0_int64)
      field = ibits(bits, fraction_bits, 11)
      fraction = ibits(bits, 0, fraction_bits)
      if (field == special_exponent .and. fraction /= 0_int64) then
         call put_text('nan', buffer, last)
         return
      end if
      if (bits < 0_int64) call put_text('-', buffer, last)
      if (field == special_exponent) then
         call put_text('inf', buffer, last)
         return
      end if

      exponent = int(field) - bias
      digits = -1_int64
      if (field == 0_int64 .and. fraction == 0_int64) then
         digits = 0_int64
         power = 0
      else if (field > 0_int64 .and. exponent <= largest_exponent) then
         call find_digits(decimal, ibset(fraction, fraction_bits), exponent, digits, power)
      end if
      if (digits < 0_int64) call ask_compiler(x, digits, power)
      call put_digits(decimal, digits, power, buffer, last)
   end subroutine put_real

   !> Write an integer into a buffer
   pure subroutine put_integer(number, buffer, last)
      integer, intent(in) :: number
      !> Buffer with room for `longest_integer` characters after `last`
      character(len=*), intent(inout) :: buffer
      !> Last character in use, before and after
      integer, intent(inout) :: last
      character(len=longest_integer) :: text
      integer :: first, rest

      ! remainders of a negative number are negative; its absolute value may not exist
      rest = number
      first = longest_integer + 1
      do
         first = first - 1
         text(first:first) = achar(iachar('0') + abs(mod(rest, 10)))
         rest = rest/10
         if (rest == 0) exit
      end do
      if (number < 0) call put_text('-', buffer, last)
      call put_text(text(first:), buffer, last)
   end subroutine put_integer

   !> Find the 17 digits of a number
   pure subroutine find_digits(decimal, mantissa, exponent, digits, power)
      !> Powers of ten
      type(decimal_t), intent(in) :: decimal
      !> The number times 2^(52 - exponent), 2^52 to 2^53 - 1
      integer(int64), intent(in) :: mantissa
      !> Power of two of the first bit
      integer, intent(in) :: exponent
      !> The digits, 10^16 to 10^17 - 1; -1 if the rounding is undecided
      integer(int64), intent(out) :: digits
      !> Power of ten of the first digit
      integer, intent(out) :: power
      ! an error of one in the last bit of 5^k is below 2^26 in `rest`
      integer(int64), parameter :: undecided = 2_int64**28
      integer(int64), parameter :: limb_mask = 2_int64**limb_bits - 1_int64
      real(wp), parameter :: unit = 2.0_wp**(-fraction_bits)
      integer(int64) :: column(0:top+2), half, high, low, rest
      integer :: i, k, shift

      low = iand(mantissa, limb_mask)
      high = shiftr(mantissa, limb_bits)
      ! log2(m) >= m - 1 for m from 1 to 2, so the power is correct or one too small
      power = floor((real(exponent - 1, wp) + real(mantissa, wp)*unit)*log10_of_2)
      do
         k = 16 - power
         column(0) = low*decimal%limb(0, k)
         column(1) = low*decimal%limb(1, k) + high*decimal%limb(0, k)
         column(2) = low*decimal%limb(2, k) + high*decimal%limb(1, k)
         column(3) = high*decimal%limb(2, k)
         column(4) = 0_int64
         do i = 0, top + 1
            column(i+1) = column(i+1) + shiftr(column(i), limb_bits)
            column(i) = iand(column(i), limb_mask)
         end do

         ! the binary point is in the third limb, 21 to 26 bits from its right end: the 17 or 18
         ! digits are 54 to 58 of the 133 or 134 bits
         shift = fraction_bits - exponent - k - decimal%exponent(k) - 2*limb_bits
         digits = shiftl(column(4), 2*limb_bits - shift) + shiftl(column(3), limb_bits - shift) &
            + shiftr(column(2), shift)
         rest = shiftl(iand(column(2), shiftl(1_int64, shift) - 1_int64), limb_bits) + column(1)
         half = shiftl(1_int64, shift + limb_bits - 1)
         if (rest > half) digits = digits + 1_int64
         if (digits < too_large) exit
         power = power + 1
      end do
      if (abs(rest - half) < undecided) digits = -1_int64
   end subroutine find_digits

   !> Find the 17 digits of a number by a formatted write
   pure subroutine ask_compiler(x, digits, power)
      !> A finite number
      real(wp), intent(in) :: x
      !> The digits, 10^16 to 10^17 - 1
      integer(int64), intent(out) :: digits
      !> Power of ten of the first digit
      integer, intent(out) :: power
      character(len=longest_real) :: text

      write (text, '(es24.16e3)') abs(x)
      ! ' d.dddddddddddddddde+ddd'
      text(3:3) = text(2:2)
      read (text(3:19), '(i17)') digits
      read (text(21:24), '(i4)') power
   end subroutine ask_compiler

   !> Write 17 digits and the exponent into a buffer
   pure subroutine put_digits(decimal, digits, power, buffer, last)
      !> Pairs of digits
      type(decimal_t), intent(in) :: decimal
      !> The digits, 0 to 10^17 - 1
      integer(int64), intent(in) :: digits
      !> Power of ten of the first digit, -999 to 999
      integer, intent(in) :: power
      !> Buffer with room after `last`
      character(len=*), intent(inout) :: buffer
      !> Last character in use, before and after
      integer, intent(inout) :: last
      ! two halves of four pairs: the processor can work on two independent chains of quotients
      integer(int64), parameter :: half = 10_int64**8
      integer :: high, low, pair, place

      high = int(digits/half)
      low = int(digits - half*(digits/half))
      do pair = 3, 0, -1
         place = last + 3 + 2*pair
         buffer(place:place+1) = decimal%pairs(mod(high, 100))
         buffer(place+8:place+9) = decimal%pairs(mod(low, 100))
         high = high/100
         low = low/100
      end do
      buffer(last+1:last+1) = achar(iachar('0') + high)
      buffer(last+2:last+2) = '.'
      last = last + 18

      buffer(last+1:last+1) = 'e'
      buffer(last+2:last+2) = merge('-', '+', power < 0)
      last = last + 2
      place = abs(power)
      if (place > 99) then
         last = last + 1
         buffer(last:last) = achar(iachar('0') + place/100)
         place = mod(place, 100)
      end if
      buffer(last+1:last+2) = decimal%pairs(place)
      last = last + 2
   end subroutine put_digits

   !> Write a text into a buffer
   pure subroutine put_text(text, buffer, last)
      character(len=*), intent(in) :: text
      !> Buffer with room after `last`
      character(len=*), intent(inout) :: buffer
      !> Last character in use, before and after
      integer, intent(inout) :: last

      buffer(last+1:last+len(text)) = text
      last = last + len(text)
   end subroutine put_text

   !> Multiply by five
   pure subroutine times_five(limb, exponent)
      !> Limbs from the lowest to the highest, whose highest bit is set before and after
      integer(int64), intent(inout) :: limb(0:)
      !> Exponent of their power of two
      integer, intent(inout) :: exponent
      integer(int64) :: carry, sum
      integer :: i, shift

      carry = 0_int64
      do i = 0, ubound(limb, 1)
         sum = 5_int64*limb(i) + carry
         limb(i) = ibits(sum, 0, limb_bits)
         carry = ishft(sum, -limb_bits)
      end do
      ! shift the two or three bits of the carry, which is 2 to 4, into the highest limb
      shift = 2
      if (carry >= 4_int64) shift = 3
      do i = 0, ubound(limb, 1) - 1
         limb(i) = ior(ishft(limb(i), -shift), ishft(ibits(limb(i+1), 0, shift), limb_bits - shift))
      end do
      i = ubound(limb, 1)
      limb(i) = ior(ishft(limb(i), -shift), ishft(carry, limb_bits - shift))
      exponent = exponent + shift
   end subroutine times_five

end module vcor_io_number
