!> Real numbers as they are written
!>
!> The compiler reads each number, so Fortran's rules hold. What it would take in silence is
!> refused before: NaN, infinity, numbers beyond the range of the kind, and whatever is not a number
!> from its first to its last byte.
module vcor_case_real
   use vcor_kinds, only : wp
   use vcor_interval, only : largest, smallest
   use vcor_text, only : lower, shortened
   implicit none
   private

   public :: read_real, looks_numeric

   !> Power of ten beyond which a number is not read at all
   integer, parameter :: largest_power = 300
   character(len=*), parameter :: digits = "0123456789"

contains

   !> Read a real number
   subroutine read_real(word, expected, number, message)
      !> The number as it is written
      character(len=*), intent(in) :: word
      !> What is expected, for the message
      character(len=*), intent(in) :: expected
      !> The number
      real(wp), intent(out) :: number
      !> What is wrong, unallocated on success
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
            & //", which is too large, expected at most 1e300 in magnitude"
      else if (power < -largest_power .or. (abs(number) > 0.0_wp .and. abs(number) < smallest)) then
         message = "found "//shortened(word) &
            & //", which is too small, expected 0 or at least 1e-300 in magnitude"
      end if
   end subroutine read_real

   !> Whether a word is a number, infinity or not a number
   pure function looks_numeric(word) result(yes)
      !> The word
      character(len=*), intent(in) :: word
      !> True if it is
      logical :: yes
      integer :: power

      call look_at_number(word, yes, power)
      yes = yes .or. is_not_finite(word)
   end function looks_numeric

   !> Whether a word is a number by Fortran's rules, and how large it is about
   pure subroutine look_at_number(word, good, power)
      !> The word
      character(len=*), intent(in) :: word
      !> Whether it is sign, digits with or without a point, and perhaps an exponent with its letter
      logical, intent(out) :: good
      !> Power of ten of its first digit that is not zero; 0 for zero
      integer, intent(out) :: power
      integer :: i, first, point, after, leading, shift
      integer, parameter :: most_digits = 6

      power = 0
      first = 1
      if (scan(word, "+-") == 1) first = 2
      ! The mantissa: digits first to after - 1, among them at most one point
      after = verify(word(first:), digits//".") + first - 1
      if (after < first) after = len(word) + 1
      point = index(word(first:after-1), ".") + first - 1
      if (point < first) point = after
      good = scan(word(first:after-1), digits) > 0
      if (good .and. point < after) good = index(word(point+1:after-1), ".") == 0
      if (.not. good) return

      leading = scan(word(first:after-1), "123456789") + first - 1
      if (leading >= first) power = merge(point - leading - 1, point - leading, leading < point)
      if (after > len(word)) return

      good = scan(word(after:after), "eEdD") == 1 .and. after < len(word)
      if (.not. good) return
      i = after + 1
      if (scan(word(i:i), "+-") == 1) i = i + 1
      good = i <= len(word)
      if (good) good = verify(word(i:), digits) == 0
      if (.not. good .or. leading < first) return
      first = verify(word(i:), "0") + i - 1
      if (first < i) return
      if (len(word) - first + 1 > most_digits) then
         power = merge(-huge(power), huge(power), word(after+1:after+1) == "-")
      else
         read(word(first:), *) shift
         power = power + merge(-shift, shift, word(after+1:after+1) == "-")
      end if
   end subroutine look_at_number

   !> Whether a word means infinity or not a number
   pure function is_not_finite(word) result(yes)
      !> The word
      character(len=*), intent(in) :: word
      !> True if it does
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
