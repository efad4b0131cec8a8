!> HDF5 as the modules that use it find it and leave it: its library open, its errors not printed
module vcor_io_hdf5_library
   use, intrinsic :: iso_c_binding, only : c_funptr, c_int, c_int64_t, c_null_funptr, c_ptr
   use hdf5, only : h5iis_valid_f, h5open_f, h5t_native_double
   implicit none
   private

   public :: handler_t, begin_hdf5, end_hdf5, c_get_offset

   !> The error stack that H5E functions take by default (H5E_DEFAULT)
   integer(c_int64_t), parameter :: default_stack = 0_c_int64_t

   !> What handled errors before
   type :: handler_t
      type(c_funptr), private :: handler
      !> What it is called with
      type(c_ptr), private :: client
   end type handler_t

   ! HDF5's Fortran interface can turn the printing of errors on and off but cannot tell whether it
   ! is on, and a program that uses this library may have a handler of its own
   interface
      !> Ask for the handler of errors
      function c_get_handler(stack, handler, client) result(status) bind(c, name="H5Eget_auto2")
         import :: c_funptr, c_int, c_int64_t, c_ptr
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
         integer(c_int64_t), intent(in), value :: stack
         !> Handler, null for none
         type(c_funptr), intent(in), value :: handler
         !> What the handler is called with
         type(c_ptr), intent(in), value :: client
         !> Negative on failure
         integer(c_int) :: status
      end function c_set_handler

      !> Where in the file the numbers of a dataset begin that is stored in one piece
      function c_get_offset(dataset) result(offset) bind(c, name="H5Dget_offset")
         import :: c_int64_t
         integer(c_int64_t), intent(in), value :: dataset
         !> Bytes before it, all bits set if there is none
         integer(c_int64_t) :: offset
      end function c_get_offset
   end interface

contains

   !> Open the library and keep it from printing
   subroutine begin_hdf5(before, fault)
      !> What handled errors before
      type(handler_t), intent(out) :: before
      !> What failed; unallocated on success
      character(len=:), allocatable, intent(out) :: fault
      integer :: status
      logical :: is_open

      ! The types of HDF5 are there if the library was opened, by whomever; it is never closed here,
      ! since that would close everything else the program has open in HDF5
      call h5iis_valid_f(h5t_native_double, is_open, status)
      if (status < 0 .or. .not. is_open) then
         call h5open_f(status)
         if (status < 0) fault = "open its library"
      end if
      if (allocated(fault)) return
      if (c_get_handler(default_stack, before%handler, before%client) < 0) then
         fault = "give its handler of errors"
      else if (c_set_handler(default_stack, c_null_funptr, before%client) < 0) then
         fault = "take a handler of errors"
      end if
   end subroutine begin_hdf5

   !> Errors are handled as before
   subroutine end_hdf5(before)
      !> What handled errors before
      type(handler_t), intent(in) :: before
      integer(c_int) :: ignored

      ignored = c_set_handler(default_stack, before%handler, before%client)
   end subroutine end_hdf5

end module vcor_io_hdf5_library
