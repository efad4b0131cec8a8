!> HDF5 files that this program has written, read back
!>
!>     call open_hdf5(reader, "case.h5", error)
!>     text = reader%text("version")
!>     call reader%get_reals("summary/cor", values)
!>     call reader%close(error)
!>
!> The first failure is kept, everything after it does nothing, and `close` makes an error of it.
module vcor_io_hdf5_reader
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_f_pointer, c_int64_t, c_loc, &
      & c_null_char, c_null_ptr, c_ptr
   use hdf5, only : h5aclose_f, h5aexists_f, h5aopen_f, h5aread_f, h5dclose_f, h5dget_space_f, &
      & h5dopen_f, h5dread_f, h5f_acc_rdonly_f, h5fclose_f, h5fopen_f, &
      & h5sclose_f, h5sget_simple_extent_npoints_f, h5t_cset_utf8_f, &
      & h5t_native_double, h5t_native_integer, h5t_string, h5tclose_f, h5tcopy_f, h5tset_cset_f, &
      & hid_t, hsize_t
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_file, only : quoted_path
   use vcor_io_hdf5_library, only : begin_hdf5, end_hdf5, handler_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: reader_t, open_hdf5

   !> An open file
   type :: reader_t
      !> What failed first; not allocated as long as nothing did
      character(len=:), allocatable :: fault
      !> Its path
      character(len=:), allocatable, private :: path
      !> The file
      integer(hid_t), private :: file = -1_hid_t
      !> What handled errors before
      type(handler_t), private :: handler
   contains
      !> An attribute of the file
      procedure :: text
      !> Real numbers
      procedure :: get_reals
      !> Whole numbers
      procedure :: get_integers
      !> Where in the file a dataset is
      procedure :: place
      !> Close the file
      procedure :: close => close_hdf5
   end type reader_t

   interface
      !> Where in the file the numbers of a dataset begin that is stored in one piece
      function c_get_offset(dataset) result(offset) bind(c, name="H5Dget_offset")
         import :: c_int64_t
         !> The dataset
         integer(c_int64_t), intent(in), value :: dataset
         !> Bytes before it, all bits set if there is none
         integer(c_int64_t) :: offset
      end function c_get_offset
   end interface

contains

   !> Open a file
   subroutine open_hdf5(self, path, error)
      !> The file
      type(reader_t), intent(out) :: self
      !> Its path
      character(len=*), intent(in) :: path
      !> Set if it is no HDF5 file, or cannot be read
      type(error_t), allocatable, intent(out) :: error
      integer :: status

      self%path = path
      call begin_hdf5(self%handler, self%fault)
      if (allocated(self%fault)) then
         call raise(error, error_file, "cannot read "//quoted_path(path)//": HDF5 cannot "// &
            & self%fault)
         return
      end if
      call h5fopen_f(path, h5f_acc_rdonly_f, self%file, status)
      if (status >= 0) return
      call end_hdf5(self%handler)
      call raise(error, error_file, "cannot read "//quoted_path(path)//": expected an HDF5 file")
   end subroutine open_hdf5

   !> An attribute of the file
   function text(self, name)
      !> The file
      class(reader_t), intent(inout) :: self
      !> Name of the attribute
      character(len=*), intent(in) :: name
      !> Its value, empty if there is no such text
      character(len=:), allocatable :: text
      character(kind=c_char), pointer :: letters(:)
      type(c_ptr), target :: place
      type(c_ptr) :: buffer
      integer(hid_t) :: attribute, text_type
      integer, parameter :: longest = 2**30
      integer :: i, status
      logical :: exists

      text = ""
      if (allocated(self%fault)) return
      call h5aexists_f(self%file, name, exists, status)
      if (status < 0 .or. .not. exists) return
      call h5tcopy_f(h5t_string, text_type, status)
      call note(self, status, "make a type for text")
      call h5tset_cset_f(text_type, h5t_cset_utf8_f, status)
      call note(self, status, "make a type for text")
      call h5aopen_f(self%file, name, attribute, status)
      call note(self, status, "open the attribute '"//name//"'")
      if (allocated(self%fault)) return
      place = c_null_ptr
      buffer = c_loc(place)
      call h5aread_f(attribute, text_type, buffer, status)
      call note(self, status, "read the attribute '"//name//"'")
      call h5aclose_f(attribute, status)
      call h5tclose_f(text_type, status)
      if (allocated(self%fault) .or. .not. c_associated(place)) return
      call c_f_pointer(place, letters, [longest])
      i = 1
      do while (letters(i) /= c_null_char)
         i = i + 1
      end do
      text = repeat(" ", i - 1)
      do i = 1, len(text)
         text(i:i) = letters(i)
      end do
   end function text

   !> Real numbers
   subroutine get_reals(self, name, values)
      !> The file
      class(reader_t), intent(inout) :: self
      !> Path of the dataset
      character(len=*), intent(in) :: name
      !> Its numbers; their number is checked, shape (n)
      real(wp), intent(inout), target :: values(:)

      call read_numbers(self, name, h5t_native_double, size(values), c_loc(values))
   end subroutine get_reals

   !> Whole numbers
   subroutine get_integers(self, name, values)
      !> The file
      class(reader_t), intent(inout) :: self
      !> Path of the dataset
      character(len=*), intent(in) :: name
      !> Its numbers; their number is checked, shape (n)
      integer, intent(inout), target :: values(:)

      call read_numbers(self, name, h5t_native_integer, size(values), c_loc(values))
   end subroutine get_integers

   !> Read a dataset
   subroutine read_numbers(self, name, memory_type, length, place)
      !> The file
      type(reader_t), intent(inout) :: self
      !> Path of the dataset
      character(len=*), intent(in) :: name
      !> Type of the numbers
      integer(hid_t), intent(in) :: memory_type
      !> Expected number of them
      integer, intent(in) :: length
      !> Where they go
      type(c_ptr), intent(in) :: place
      type(c_ptr) :: values
      integer(hid_t) :: dataset, space
      integer(hsize_t) :: found
      integer :: status

      if (allocated(self%fault)) return
      call h5dopen_f(self%file, name, dataset, status)
      call note(self, status, "find '"//name//"'")
      if (allocated(self%fault)) return
      call h5dget_space_f(dataset, space, status)
      call note(self, status, "give the length of '"//name//"'")
      call h5sget_simple_extent_npoints_f(space, found, status)
      call note(self, status, "give the length of '"//name//"'")
      if (.not. allocated(self%fault) .and. found /= int(length, hsize_t)) &
         & call note(self, -1, "read '"//name//"', which has another length than expected")
      if (.not. allocated(self%fault) .and. length > 0) then
         values = place
         call h5dread_f(dataset, memory_type, values, status)
         call note(self, status, "read '"//name//"'")
      end if
      call h5sclose_f(space, status)
      call h5dclose_f(dataset, status)
   end subroutine read_numbers

   !> Where in the file a dataset is that is stored in one piece
   function place(self, name) result(offset)
      !> The file
      class(reader_t), intent(inout) :: self
      !> Path of the dataset
      character(len=*), intent(in) :: name
      !> Bytes before its first number
      integer(c_int64_t) :: offset
      integer(hid_t) :: dataset
      integer :: status

      offset = -1_c_int64_t
      if (allocated(self%fault)) return
      call h5dopen_f(self%file, name, dataset, status)
      call note(self, status, "find '"//name//"'")
      if (allocated(self%fault)) return
      offset = c_get_offset(int(dataset, c_int64_t))
      if (offset < 0) call note(self, -1, "say where '"//name//"' is")
      call h5dclose_f(dataset, status)
   end function place

   !> Close the file
   subroutine close_hdf5(self, error)
      !> The file
      class(reader_t), intent(inout) :: self
      !> Set to what failed first since the file was opened
      type(error_t), allocatable, intent(out) :: error
      integer :: status

      call h5fclose_f(self%file, status)
      call note(self, status, "close the file")
      call end_hdf5(self%handler)
      if (allocated(self%fault)) call raise(error, error_file, "cannot read "// &
         & quoted_path(self%path)//": HDF5 cannot "//self%fault)
   end subroutine close_hdf5

   !> Keep the first failure
   pure subroutine note(self, status, what)
      !> The file
      class(reader_t), intent(inout) :: self
      !> Status of HDF5, negative on failure
      integer, intent(in) :: status
      !> What was asked of HDF5
      character(len=*), intent(in) :: what

      if (status < 0 .and. .not. allocated(self%fault)) self%fault = what
   end subroutine note

end module vcor_io_hdf5_reader
