!> Checks for the test programs: each program is one suite, its exit code says whether all passed
!>
!>     call suite("prony")
!>     call check_close(material%glassy(), 9.56e6_wp, 1.0_wp, "glassy modulus is the sum")
!>     call finish()
!>
!> What is not decided fails: a number that is NaN or infinite, a suite without checks.
module vcor_test
   use, intrinsic :: iso_fortran_env, only : int64, output_unit
   use vcor_kinds, only : wp
   implicit none
   private

   public :: suite, check, check_close, check_relative, check_text, check_contains, finish

   !> Name of the running suite
   character(len=:), allocatable :: suite_name
   !> Number of checks that passed
   integer :: passed = 0
   !> Number of checks that failed
   integer :: failed = 0

contains

   !> Begin a suite; one per program
   subroutine suite(name)
      !> What is tested
      character(len=*), intent(in) :: name

      suite_name = name
   end subroutine suite

   !> Check that something is true
   subroutine check(condition, what)
      !> What must be true
      logical, intent(in) :: condition
      !> What is checked, as a statement
      character(len=*), intent(in) :: what

      call count_one(condition, what)
      if (.not. condition) call show("found", "false", "expected", "true")
   end subroutine check

   !> Check that a number is within an absolute tolerance of what it should be; each element of an
   !> array is a check
   impure elemental subroutine check_close(actual, expected, tolerance, what)
      !> What was found
      real(wp), intent(in) :: actual
      !> What it should be
      real(wp), intent(in) :: expected
      !> Largest distance between the two that passes, in their unit, not negative
      real(wp), intent(in) :: tolerance
      !> What is checked, as a statement
      character(len=*), intent(in) :: what

      call compare(actual, expected, tolerance, 1.0_wp, what)
   end subroutine check_close

   !> Check that a number is within a relative tolerance of what it should be; each element of an
   !> array is a check
   impure elemental subroutine check_relative(actual, expected, tolerance, what)
      !> What was found
      real(wp), intent(in) :: actual
      !> What it should be; where this is zero only zero passes
      real(wp), intent(in) :: expected
      !> Largest distance between the two that passes, as a part of `abs(expected)`, not negative
      real(wp), intent(in) :: tolerance
      !> What is checked, as a statement
      character(len=*), intent(in) :: what

      call compare(actual, expected, tolerance, abs(expected), what)
   end subroutine check_relative

   !> Check that a text is what it should be, to the last blank
   subroutine check_text(actual, expected, what)
      !> What was found
      character(len=*), intent(in) :: actual
      !> What it should be
      character(len=*), intent(in) :: expected
      !> What is checked, as a statement
      character(len=*), intent(in) :: what
      logical :: same

      ! The comparison of Fortran ignores blanks at the end
      same = len(actual) == len(expected) .and. actual == expected
      call count_one(same, what)
      if (.not. same) call show("found", quoted(actual), "expected", quoted(expected))
   end subroutine check_text

   !> Check that a text contains another one
   subroutine check_contains(text, part, what)
      !> Where to look
      character(len=*), intent(in) :: text
      !> What must be there, at least one character
      character(len=*), intent(in) :: part
      !> What is checked, as a statement
      character(len=*), intent(in) :: what
      logical :: there

      ! An empty text is part of every text: such a check would always pass
      there = len(part) > 0 .and. index(text, part) > 0
      call count_one(there, what)
      if (.not. there) call show("found", quoted(text), "expected in it", quoted(part))
   end subroutine check_contains

   !> End the suite: print the count; leave with an exit code other than 0 if a check failed or none
   !> was made
   subroutine finish()

      if (.not. allocated(suite_name)) suite_name = "(no suite named)"
      write(output_unit, "(a, ': ', i0, ' passed, ', i0, ' failed')") suite_name, passed, failed
      if (passed + failed == 0) write(output_unit, "(a)") "no check was made"
      flush(output_unit)
      if (failed > 0 .or. passed == 0) stop 1
   end subroutine finish

   !> Compare two numbers
   subroutine compare(actual, expected, tolerance, scale, what)
      !> What was found
      real(wp), intent(in) :: actual
      !> What it should be
      real(wp), intent(in) :: expected
      !> Largest distance that passes, in units of `scale`
      real(wp), intent(in) :: tolerance
      !> Unit of the tolerance
      real(wp), intent(in) :: scale
      !> What is checked
      character(len=*), intent(in) :: what
      logical :: near

      ! Comparing a NaN traps in a debug build, so what is not finite never gets to the comparison
      near = .false.
      if (finite(actual) .and. finite(expected) .and. finite(tolerance)) then
         near = abs(actual - expected) <= tolerance*scale
      end if
      call count_one(near, what)
      if (.not. near) then
         call show("found", number(actual), "expected", number(expected), number(tolerance))
      end if
   end subroutine compare

   !> Whether a number is neither infinite nor NaN, from its bits: unlike `ieee_is_finite` this is
   !> safe for the signalling NaN that uninitialised numbers of a debug build hold
   pure function finite(x) result(is_finite)
      !> Any number
      real(wp), intent(in) :: x
      !> False for NaN and infinity
      logical :: is_finite
      !> Width of the fraction and of the exponent, IEEE 754 binary64
      integer, parameter :: fraction_bits = 52, exponent_bits = 11
      integer(int64) :: exponent_field

      exponent_field = ibits(transfer(x, 0_int64), fraction_bits, exponent_bits)
      is_finite = exponent_field /= maskr(exponent_bits, int64)
   end function finite

   !> Count one check; print its name if it failed
   subroutine count_one(good, what)
      !> Whether the check passed
      logical, intent(in) :: good
      !> What was checked
      character(len=*), intent(in) :: what

      if (good) then
         passed = passed + 1
      else
         failed = failed + 1
         write(output_unit, "(3a)") "failed: '", what, "'"
      end if
   end subroutine count_one

   !> Print what a failed check found and expected
   subroutine show(label, actual, other_label, expected, tolerance)
      !> What `actual` is
      character(len=*), intent(in) :: label
      !> What was found
      character(len=*), intent(in) :: actual
      !> What `expected` is
      character(len=*), intent(in) :: other_label
      !> What it should be
      character(len=*), intent(in) :: expected
      !> Tolerance of the comparison
      character(len=*), intent(in), optional :: tolerance

      write(output_unit, "(4x, 2(a, ':', t22, a, :, /, 4x))") label, actual, other_label, expected
      if (present(tolerance)) write(output_unit, "(4x, a, t22, a)") "tolerance:", tolerance
   end subroutine show

   !> A number in full precision
   function number(x) result(text)
      !> Any number
      real(wp), intent(in) :: x
      !> Its text
      character(len=:), allocatable :: text
      character(len=32) :: buffer

      ! Writing a signalling NaN may trap
      if (finite(x)) then
         write(buffer, "(es24.16e3)") x
         text = trim(adjustl(buffer))
      else
         text = "not finite"
      end if
   end function number

   !> A text between quotation marks, so that blanks at its end are seen
   pure function quoted(text) result(between)
      !> Any text
      character(len=*), intent(in) :: text
      !> The text between quotation marks
      character(len=:), allocatable :: between

      between = "'"//text//"'"
   end function quoted

end module vcor_test
