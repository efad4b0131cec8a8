!> Function for the Python package alone: the check of a file of results for damage
module vcor_c_api_altered
   use, intrinsic :: iso_c_binding, only : c_int, c_ptr
   use vcor_io_posix, only : fortran => fortran_text
   use vcor_io_seal, only : is_altered
   implicit none
   private

   public :: vcor_is_altered

contains

   !> Whether the seal of a file does not match its contents: HDF5 may crash reading such a file
   function vcor_is_altered(file) bind(c) result(yes)
      !> Name of the file
      type(c_ptr), value :: file
      !> 1 or 0
      integer(c_int) :: yes

!$omp critical (vcor_c_api)
      yes = merge(1_c_int, 0_c_int, is_altered(fortran(file), cut_counts=.false.))
!$omp end critical (vcor_c_api)
   end function vcor_is_altered

end module vcor_c_api_altered
