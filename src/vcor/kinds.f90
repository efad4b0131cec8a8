!> Kind of real numbers, the accuracies for which it is sufficient, and constants of mathematics and
!> physics
module vcor_kinds
   use, intrinsic :: iso_fortran_env, only : int64, real64
   implicit none
   private

   public :: wp, finest_accuracy, coarsest_accuracy
   public :: pi, sqrt_pi, standard_gravity, gas_constant, unset

   !> Working precision
   integer, parameter :: wp = real64
   !> Highest and lowest accuracy of the coefficient of restitution that can be requested
   real(wp), parameter :: finest_accuracy = 1.0e-11_wp, coarsest_accuracy = 0.1_wp
   !> Ratio of a circle's circumference to its diameter
   real(wp), parameter :: pi = 3.1415926535897932384626433832795_wp
   !> Square root of pi
   real(wp), parameter :: sqrt_pi = 1.7724538509055160272981674833411_wp
   !> Standard acceleration of gravity [m/s2], exact by definition (CGPM 1901)
   real(wp), parameter :: standard_gravity = 9.80665_wp
   !> Molar gas constant [J/(mol K)], exact by definition (SI 2019)
   real(wp), parameter :: gas_constant = 8.31446261815324_wp
   !> Quiet NaN, for a number that nothing has set
   real(wp), parameter :: unset = transfer(huge(1_int64), 1.0_wp)

end module vcor_kinds
