!> The impacts that are timed, and their coefficients of restitution to 12 digits and more
module vcor_benchmark_reference
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor, only : wp
   implicit none
   private

   public :: reference_cor

contains

   !> cor of a row of tests/reference/reference.csv
   function reference_cor(row) result(cor)
      !> Name of the row
      character(len=*), intent(in) :: row
      !> Coefficient of restitution [-]
      real(wp) :: cor

      character(len=*), parameter :: path = 'tests/reference/reference.csv'
      character(len=1024) :: line
      character(len=64) :: name, kernel, laws
      integer :: unit, status

      open (newunit=unit, file=path, status='old', action='read', iostat=status)
      do while (status == 0)
         read (unit, '(a)', iostat=status) line
         if (status /= 0) exit
         if (index(line, row//',') /= 1) cycle
         read (line, *, iostat=status) name, kernel, laws, cor
         if (status /= 0) exit
         close (unit)
         return
      end do
      write (error_unit, '(a)') 'benchmark: no row '//row//' in '//path//': run it from the top ' &
         //'of the sources'
      error stop
   end function reference_cor

end module vcor_benchmark_reference
