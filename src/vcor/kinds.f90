!> Kind of the real numbers
module vcor_kinds
   use, intrinsic :: iso_fortran_env, only : real64
   implicit none
   private

   public :: wp

   !> Working precision
   integer, parameter :: wp = real64

end module vcor_kinds
