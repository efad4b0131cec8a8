!> Real numbers as written in input
!>
!> The compiler reads each number, so Fortran's rules hold. Input that it would accept silently is
!> refused first: NaN, infinity, numbers out of the range of the kind, and anything that is not
!> entirely a number.
module vcor_case_real
   use vcor_kinds, only : wp
   use vcor_material_parameter, only : largest, smallest
   use vcor_text, only : lower, shortened
   implicit none
   private

   public :: read_real, looks_numeric

   !> Power of ten beyond which a number is not read
   integer, parameter :: largest_power = 300
   character(len=*), parameter :: digits = "0123456789"

contains

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
      last = first + verify(word(first:)//' ', digits//'.') - 2
      good = scan(word(first:last), digits) > 0
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
      good = good .and. exponent <= len(word) .and. verify(word(exponent:), digits) == 0
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

end module vcor_case_real
