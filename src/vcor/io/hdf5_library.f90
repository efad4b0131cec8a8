!> The HDF5 library as writer and reader need it: opened once, and silent while they work
!>
!> HDF5's Fortran interface can turn the printing of errors on and off but cannot tell whether it
!> is on, and a program that uses this library may have a handler of its own: it is kept and set
!> again.
module vcor_io_hdf5_library
   use, intrinsic :: iso_c_binding, only : c_funptr, c_int, c_int64_t, c_null_funptr, c_null_ptr, &
      & c_ptr
   use hdf5, only : h5iis_valid_f, h5open_f, h5t_native_double
   implicit none
   private

   public :: silence_t, begin_silence, end_silence

   !> The error stack that H5E functions take by default (H5E_DEFAULT)
   integer(c_int64_t), parameter :: default_stack = 0_c_int64_t

   !> Handler of errors that is put aside
   type :: silence_t
      private
      !> Handler, null if there is none
      type(c_funptr) :: handler = c_null_funptr
      !> What the handler is called with
      type(c_ptr) :: client = c_null_ptr
   end type silence_t

   interface
      !> Ask for the handler of errors
      function c_get_handler(stack, handler, client) result(status) bind(c, name="H5Eget_auto2")
         import :: c_funptr, c_int, c_int64_t, c_ptr
         !> Error stack
         integer(c_int64_t), intent(in), value :: stack
         !> Handler, null if there is none
         type(c_funptr), intent(out) :: handler
         !> What the handler is called with
         type(c_ptr), intent(out) :: client
         !> Negative on failure
         integer(c_int) :: status
      end function c_get_handler

      !> Set the handler of errors
      function c_set_handler(stack, handler, client) result(status) bind(c, name="H5Eset_auto2")
         import :: c_funptr, c_int, c_int64_t, c_ptr
         !> Error stack
         integer(c_int64_t), intent(in), value :: stack
         !> Handler, null for none
         type(c_funptr), intent(in), value :: handler
         !> What the handler is called with
         type(c_ptr), intent(in), value :: client
         !> Negative on failure
         integer(c_int) :: status
      end function c_set_handler
   end interface

contains

   !> Open the library if nobody has, and keep it from printing
   subroutine begin_silence(silence, status)
      !> What `end_silence` needs
      type(silence_t), intent(out) :: silence
      !> Negative on failure; then there is nothing to end
      integer, intent(out) :: status
      logical :: is_open

      ! The types of HDF5 are there if the library was opened, by whomever; it is never closed here,
      ! since that would close everything else the program has open in HDF5
      call h5iis_valid_f(h5t_native_double, is_open, status)
      if (status < 0 .or. .not. is_open) call h5open_f(status)
      if (status >= 0) status = c_get_handler(default_stack, silence%handler, silence%client)
      if (status >= 0) status = c_set_handler(default_stack, c_null_funptr, c_null_ptr)
   end subroutine begin_silence

   !> Errors are handled as before
   subroutine end_silence(silence)
      !> What `begin_silence` put aside
      type(silence_t), intent(in) :: silence
      integer :: ignored

      ignored = c_set_handler(default_stack, silence%handler, silence%client)
   end subroutine end_silence

end module vcor_io_hdf5_library
