!> Kind of real numbers, and the range of accuracies for which it is sufficient
module vcor_kinds
   use, intrinsic :: iso_fortran_env, only : real64
   implicit none
   private

   public :: wp, finest_accuracy, coarsest_accuracy

   !> Working precision
   integer, parameter :: wp = real64
   !> Highest and lowest accuracy of the coefficient of restitution that can be requested
   real(wp), parameter :: finest_accuracy = 1.0e-11_wp, coarsest_accuracy = 0.1_wp

end module vcor_kinds
