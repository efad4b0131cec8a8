!> Kind of the real numbers, and the accuracies that it is good for
module vcor_kinds
   use, intrinsic :: iso_fortran_env, only : real64
   implicit none
   private

   public :: wp, finest_accuracy, coarsest_accuracy

   !> Working precision
   integer, parameter :: wp = real64
   !> Finest and coarsest accuracy of the coefficient of restitution that can be asked for
   real(wp), parameter :: finest_accuracy = 1.0e-11_wp, coarsest_accuracy = 0.1_wp

end module vcor_kinds
