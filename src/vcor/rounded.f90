!> Numbers rounded to a few digits, as reports and messages show them
module vcor_rounded
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_kinds, only : wp
   use vcor_number, only : real_text
   implicit none
   private

   public :: percent, plain_number, short, significant

contains

   !> A number with given significant digits, right-justified
   pure function significant(value, digits, width) result(text)
      real(wp), intent(in) :: value
      !> Digits, 2 .. 15; absent: 8
      integer, intent(in), optional :: digits
      !> Characters, at least digits + 8; absent: 16
      integer, intent(in), optional :: width
      character(len=:), allocatable :: text

      character(len=24) :: buffer
      character(len=12) :: form
      integer :: d, w

      d = 8
      if (present(digits)) d = digits
      w = 16
      if (present(width)) w = width
      if (.not. ieee_is_finite(value)) then
         buffer = 'nan'
      else if (.not. abs(value) > 0.0_wp) then
         buffer = '0'
      else if (abs(value) < 0.1_wp .or. abs(value) >= 10.0_wp**min(6, d)) then
         buffer = scientific(value, d - 1)
      else
         ! count the digits before the point of the rounded number, as for 0.9999999999
         write (form, '(a, i0, a)') '(f24.', d - max(0, &
            floor(log10(abs(value)*(1.0_wp + 0.5_wp*10.0_wp**(-d)))) + 1), ')'
         write (buffer, form) value
      end if
      buffer = adjustl(buffer)
      if (buffer(max(1, len_trim(buffer)):) == '.') buffer(len_trim(buffer):) = ' '
      text = repeat(' ', max(0, w - len_trim(buffer)))//trim(buffer)
   end function significant

   !> A number that is given, rounded to some digits, without zeros at its end
   function plain_number(value, digits) result(text)
      real(wp), intent(in) :: value
      integer, intent(in) :: digits
      character(len=:), allocatable :: text

      real(wp) :: rounded

      text = significant(value, digits, 0)
      read (text, *) rounded
      text = real_text(rounded)
   end function plain_number

   !> A number with two significant digits
   pure function short(value) result(text)
      real(wp), intent(in) :: value
      character(len=:), allocatable :: text

      text = scientific(value, 1)
   end function short

   !> A number such as `-1.5E-03`; the exponent has three digits only if needed, and never loses its
   !> letter as in `es` formats of fixed width (`1.5-103`)
   pure function scientific(value, decimals) result(text)
      real(wp), intent(in) :: value
      !> Digits after the point, 1 .. 14
      integer, intent(in) :: decimals
      character(len=:), allocatable :: text

      character(len=24) :: buffer
      character(len=12) :: form
      integer :: letter

      write (form, '(a, i0, a)') '(es24.', decimals, 'e3)'
      write (buffer, form) value
      text = trim(adjustl(buffer))
      letter = index(text, 'E')
      if (letter > 0) then
         if (text(letter + 2:letter + 2) == '0') text = text(:letter + 1)//text(letter + 3:)
      end if
   end function scientific

   !> A ratio in percent, with two digits
   pure function percent(ratio, whole) result(text)
      real(wp), intent(in) :: ratio
      !> Text for ratios of one or more; absent: the number
      character(len=*), intent(in), optional :: whole
      character(len=:), allocatable :: text

      ! for exact data this is rounding
      real(wp), parameter :: rounding = 1.0e-12_wp
      character(len=24) :: buffer
      character(len=8) :: form
      integer :: exponent

      write (buffer, '(es9.1e3)') 100.0_wp*ratio
      read (buffer(6:), *) exponent
      if (present(whole) .and. ratio >= 1.0_wp) then
         text = whole
      else if (abs(ratio) < rounding) then
         text = '0 %'
      else if (abs(exponent) > 4) then
         text = short(100.0_wp*ratio)//' %'
      else
         write (form, '(a, i0, a)') '(f24.', max(1, 1 - exponent), ')'
         write (buffer, form) 100.0_wp*ratio
         if (exponent > 0) write (buffer, '(i0)') nint(100.0_wp*ratio)
         text = trim(adjustl(buffer))//' %'
      end if
   end function percent

end module vcor_rounded
