!> Fails on purpose, in the way that the argument names: CTest wants it to, so that a harness that
!> passes everything is noticed. It stands outside tests/unit, where fpm would run it as a test that
!> must pass.
program fails
   use, intrinsic :: ieee_arithmetic, only : ieee_positive_inf, ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_fortran_env, only : output_unit
   use vcor_kinds, only : wp
   use vcor_test, only : check, check_close, check_contains, check_relative, check_text, &
      & finish, suite
   implicit none

   character(len=32) :: way
   real(wp) :: nan, infinity

   nan = ieee_value(nan, ieee_quiet_nan)
   infinity = ieee_value(infinity, ieee_positive_inf)

   call get_command_argument(1, way)
   call suite("fails, "//trim(way))

   select case (way)
   case ("not")
      call check(.true., "nothing is wrong")
   case ("check")
      call check(.true., "one that passes does not make up for one that fails")
      call check(.false., "false")
   case ("close")
      call check_close(1.25_wp, 1.5_wp, 0.125_wp, "cor")
   case ("relative")
      call check_relative(102.0_wp, 100.0_wp, 0.01_wp, "two percent where one is allowed")
   case ("text")
      call check_text("vcor ", "vcor", "a blank at the end")
   case ("contains")
      call check_contains("vcor", "", "an empty part")
   case ("nan")
      call check_close(nan, 1.0_wp, huge(1.0_wp), "NaN against a number, any tolerance")
   case ("infinity")
      call check_close(infinity, infinity, huge(1.0_wp), "an infinite number")
   case ("nan_expected")
      call check_relative(1.0_wp, nan, 1.0_wp, "NaN expected")
   case ("nan_tolerance")
      call check_close(1.0_wp, 1.0_wp, nan, "NaN as the tolerance")
   case ("none")
      continue
   case default
      ! CTest asks for one such name too, to see that a typo there does not go unnoticed
      write(output_unit, "(a)") "unknown way to fail: "//trim(way)
   end select

   call finish()

end program fails
