!> The harness passes what it should; what it must not pass is in tests/fails
program test_harness
   use, intrinsic :: iso_fortran_env, only : real64
   use vcor_kinds, only : wp
   use vcor_test, only : check, check_close, check_contains, check_relative, check_text, &
      & finish, suite
   use vcor_version, only : version
   implicit none

   call suite("harness")

   call check(.true., "true is true")
   call check(wp == real64, "the working precision is double, as the harness supposes of its bits")

   call check_close(1.25_wp, 1.25_wp, 0.0_wp, "a number is close to itself without tolerance")
   call check_close(1.25_wp, 1.5_wp, 0.25_wp, "the tolerance itself still passes")
   call check_close(-huge(1.0_wp), -huge(1.0_wp), 0.0_wp, "the largest number is finite")
   call check_close(tiny(1.0_wp), 0.0_wp, tiny(1.0_wp), "the smallest number can be told from zero")
   call check_close([1.0_wp, 2.0_wp], [1.5_wp, 1.5_wp], 0.5_wp, "arrays, element by element")

   call check_relative(101.0_wp, 100.0_wp, 0.01_wp, "one percent, relative")
   call check_relative(-99.0_wp, -100.0_wp, 0.01_wp, "one percent of a negative number")
   call check_relative(0.0_wp, 0.0_wp, 0.0_wp, "zero is zero")

   call check_text("vcor", "vcor", "texts are equal")
   call check_text("", "", "empty texts are equal")
   call check_contains("indentation [m]", "[m]", "the end of a text is part of it")
   call check_contains("m", "m", "a text is part of itself")

   ! A macro that was not replaced would stand here by its name
   call check(len(version) >= len("0.0.0"), "the version has three numbers: "//version)
   call check(verify(version, "0123456789.") == 0, "the version is digits and dots: "//version)

   call finish()

end program test_harness
