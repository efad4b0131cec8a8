!> An HDF5 file that is built in memory
!>
!> `vcor_io_file` writes it as a whole, so that a full disk is none of HDF5's business: it keeps a
!> file that cannot be closed, and complains when the program ends. Objects hold no times: the same
!> objects give the same bytes.
!>
!> The first failure is kept; what comes after it does nothing.
module vcor_io_hdf5_image
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_f_pointer, c_int, c_int8_t, &
      & c_int64_t, c_loc, c_null_char, c_null_ptr, c_ptr
   use hdf5, only : h5aclose_f, h5acreate_f, h5awrite_f, h5f_acc_trunc_f, h5f_close_strong_f, &
      & h5f_libver_v18_f, h5f_scope_global_f, h5fclose_f, h5fcreate_f, h5fflush_f, &
      & h5fget_file_image_f, &
      & h5p_crt_order_indexed_f, h5p_crt_order_tracked_f, h5p_dataset_create_f, &
      & h5p_file_access_f, h5p_file_create_f, h5p_group_create_f, h5pclose_f, h5pcreate_f, &
      & h5pset_fapl_core_f, h5pset_fclose_degree_f, h5pset_libver_bounds_f, &
      & h5pset_link_creation_order_f, &
      & h5pset_obj_track_times_f, h5s_scalar_f, h5sclose_f, h5screate_f, h5t_cset_utf8_f, &
      & h5t_ieee_f64le, h5t_native_double, h5t_string, h5tclose_f, h5tcopy_f, h5tset_cset_f, &
      & h5z_filter_deflate_f, h5zfilter_avail_f, hid_t, size_t
   use vcor_error, only : error_t
   use vcor_io_file, only : create_file, output_file_t, put
   use vcor_io_seal, only : seal_of
   use vcor_kinds, only : wp
   implicit none
   private

   public :: writer_t, nothing, open_image, write_image, close_image
   public :: put_attribute, put_number, close_list, note

   !> An identifier that stands for nothing
   integer(hid_t), parameter :: nothing = -1_hid_t
   !> Step by which the file grows in memory [bytes]
   integer(size_t), parameter :: growth = 65536_size_t
   !> First bytes of an HDF5 file
   character(len=*), parameter :: signature = char(137)//"HDF"//char(13)//char(10)//char(26) &
      & //char(10)
   !> HDF5 wants a name for a file in memory too and reads what has that name: nothing can
   character(len=*), parameter :: no_path = "/dev/null/vcor.h5"

   !> A file that is being built in memory
   type :: writer_t
      !> The file
      integer(hid_t) :: file = nothing
      !> How to create the file
      integer(hid_t) :: file_creation = nothing
      !> How to open the file: in memory
      integer(hid_t) :: file_access = nothing
      !> How to create groups
      integer(hid_t) :: group_creation = nothing
      !> How to create datasets
      integer(hid_t) :: dataset_creation = nothing
      !> Whether the library can compress
      logical :: compresses = .false.
      !> Whether nothing is to be compressed
      logical :: is_plain = .false.
      !> What the seal of the file leaves out, as in `seal_of`
      integer(c_int64_t), allocatable :: left_out(:, :)
      !> Type of text
      integer(hid_t) :: text_type = nothing
      !> What failed first; not allocated as long as nothing did
      character(len=:), allocatable :: fault
   end type writer_t

   interface
      !> Ask for what the driver of a file works with
      function c_get_vfd_handle(file, access, handle) result(status) &
         & bind(c, name="H5Fget_vfd_handle")
         import :: c_int, c_int64_t, c_ptr
         !> File
         integer(c_int64_t), intent(in), value :: file
         !> How the file was opened
         integer(c_int64_t), intent(in), value :: access
         !> What the driver works with
         type(c_ptr), intent(out) :: handle
         !> Negative on failure
         integer(c_int) :: status
      end function c_get_vfd_handle
   end interface

contains

   !> Begin a file, with the property lists and types that all its objects share
   subroutine open_image(writer)
      !> Writer
      type(writer_t), intent(inout) :: writer
      integer :: order, status

      order = ior(h5p_crt_order_tracked_f, h5p_crt_order_indexed_f)
      allocate(writer%left_out(2, 0))

      call h5pcreate_f(h5p_file_create_f, writer%file_creation, status)
      call note(writer, status, "make a property list")
      call h5pset_link_creation_order_f(writer%file_creation, order, status)
      call note(writer, status, "keep the order of the groups")
      call h5pset_obj_track_times_f(writer%file_creation, .false., status)
      call note(writer, status, "leave times out")

      call h5pcreate_f(h5p_group_create_f, writer%group_creation, status)
      call note(writer, status, "make a property list")
      call h5pset_link_creation_order_f(writer%group_creation, order, status)
      call note(writer, status, "keep the order of the columns")
      call h5pset_obj_track_times_f(writer%group_creation, .false., status)
      call note(writer, status, "leave times out")

      call h5pcreate_f(h5p_dataset_create_f, writer%dataset_creation, status)
      call note(writer, status, "make a property list")
      call h5pset_obj_track_times_f(writer%dataset_creation, .false., status)
      call note(writer, status, "leave times out")

      call h5pcreate_f(h5p_file_access_f, writer%file_access, status)
      call note(writer, status, "make a property list")
      call h5pset_fapl_core_f(writer%file_access, growth, .false., status)
      call note(writer, status, "keep a file in memory")
      ! From 1.8 on HDF5 keeps check sums of what makes a file an HDF5 file
      call h5pset_libver_bounds_f(writer%file_access, h5f_libver_v18_f, h5f_libver_v18_f, status)
      call note(writer, status, "keep check sums")
      ! What is still open after a failure goes with the file
      call h5pset_fclose_degree_f(writer%file_access, h5f_close_strong_f, status)
      call note(writer, status, "keep a file in memory")

      call h5zfilter_avail_f(h5z_filter_deflate_f, writer%compresses, status)
      call note(writer, status, "say whether it can compress")

      call h5tcopy_f(h5t_string, writer%text_type, status)
      call note(writer, status, "make a type for text")
      call h5tset_cset_f(writer%text_type, h5t_cset_utf8_f, status)
      call note(writer, status, "make a type for text")
      if (allocated(writer%fault)) return

      call h5fcreate_f(no_path, h5f_acc_trunc_f, writer%file, status, &
         & writer%file_creation, writer%file_access)
      call note(writer, status, "create a file in memory")
   end subroutine open_image

   !> Write a text attribute
   subroutine put_attribute(writer, object, name, text)
      !> Writer with a file
      type(writer_t), intent(inout) :: writer
      !> What the attribute belongs to
      integer(hid_t), intent(in) :: object
      !> Name of the attribute
      character(len=*), intent(in) :: name
      !> Its value
      character(len=*), intent(in) :: text
      character(len=:, kind=c_char), allocatable, target :: value
      type(c_ptr), target :: place
      integer(hid_t) :: attribute, space
      integer :: status

      if (allocated(writer%fault)) return
      call h5screate_f(h5s_scalar_f, space, status)
      call note(writer, status, "make the attribute '"//name//"'")
      if (allocated(writer%fault)) return
      call h5acreate_f(object, name, writer%text_type, space, attribute, status)
      call note(writer, status, "create the attribute '"//name//"'")
      call h5sclose_f(space, status)
      call note(writer, status, "close the dimensions of the attribute '"//name//"'")
      if (allocated(writer%fault)) return

      value = text//c_null_char
      place = c_loc(value)
      call h5awrite_f(attribute, writer%text_type, c_loc(place), status)
      call note(writer, status, "write the attribute '"//name//"'")
      call h5aclose_f(attribute, status)
      call note(writer, status, "close the attribute '"//name//"'")
   end subroutine put_attribute

   !> Write a number as an attribute
   subroutine put_number(writer, object, name, number)
      !> Writer with a file
      type(writer_t), intent(inout) :: writer
      !> What the attribute belongs to
      integer(hid_t), intent(in) :: object
      !> Name of the attribute
      character(len=*), intent(in) :: name
      !> The number
      real(wp), intent(in) :: number
      real(wp), target :: value
      integer(hid_t) :: attribute, space
      integer :: status

      if (allocated(writer%fault)) return
      call h5screate_f(h5s_scalar_f, space, status)
      call note(writer, status, "make the attribute '"//name//"'")
      if (allocated(writer%fault)) return
      call h5acreate_f(object, name, h5t_ieee_f64le, space, attribute, status)
      call note(writer, status, "create the attribute '"//name//"'")
      call h5sclose_f(space, status)
      call note(writer, status, "close the dimensions of the attribute '"//name//"'")
      if (allocated(writer%fault)) return

      value = number
      call h5awrite_f(attribute, h5t_native_double, c_loc(value), status)
      call note(writer, status, "write the attribute '"//name//"'")
      call h5aclose_f(attribute, status)
      call note(writer, status, "close the attribute '"//name//"'")
   end subroutine put_number

   !> Write the bytes of the file, from where HDF5 has them: a copy would double the memory; and
   !> its seal
   subroutine write_image(writer, file, filename, error)
      !> Writer with a file
      type(writer_t), intent(inout) :: writer
      !> The file on the disk, complete, to be committed
      type(output_file_t), intent(out) :: file
      !> Name of the file; replaced if it is there
      character(len=*), intent(in) :: filename
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      character(len=1, kind=c_char), pointer :: bytes(:)
      type(c_ptr) :: handle
      type(c_ptr), pointer :: place
      integer(size_t) :: length
      integer :: status

      if (allocated(writer%fault)) return
      call h5fflush_f(writer%file, h5f_scope_global_f, status)
      call note(writer, status, "complete the file")
      if (allocated(writer%fault)) return
      handle = c_null_ptr
      call h5fget_file_image_f(writer%file, handle, 0_size_t, status, length)
      call note(writer, status, "give the length of the file")
      ! For a file in memory the handle is the place of a pointer to its bytes
      status = c_get_vfd_handle(int(writer%file, c_int64_t), &
         & int(writer%file_access, c_int64_t), handle)
      call note(writer, status, "give the bytes of the file")
      if (allocated(writer%fault)) return
      call c_f_pointer(handle, place)
      if (.not. c_associated(place) .or. length < len(signature)) then
         call note(writer, -1, "give the bytes of the file")
         return
      end if
      call c_f_pointer(place, bytes, [length])
      call write_bytes(length, bytes, writer, file, filename, error)
   end subroutine write_image

   !> Write bytes as one text
   subroutine write_bytes(length, bytes, writer, file, filename, error)
      !> Number of bytes
      integer(size_t), intent(in) :: length
      !> The bytes
      character(len=length), intent(in), target :: bytes(1)
      !> Writer
      type(writer_t), intent(inout) :: writer
      !> The file on the disk
      type(output_file_t), intent(inout) :: file
      !> Name of the file; replaced if it is there
      character(len=*), intent(in) :: filename
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      integer(c_int8_t), pointer, contiguous :: numbers(:)

      if (bytes(1)(:len(signature)) /= signature) then
         call note(writer, -1, "give the bytes of the file")
         return
      end if
      call create_file(file, filename, error)
      if (.not. allocated(error)) call put(file, bytes(1), error)
      if (allocated(error)) return
      call c_f_pointer(c_loc(bytes), numbers, [length])
      call put(file, seal_of(numbers, writer%left_out), error)
   end subroutine write_bytes

   !> Close whatever is open
   subroutine close_image(writer)
      !> Writer; nothing is open afterwards
      type(writer_t), intent(inout) :: writer
      integer :: status

      if (writer%file /= nothing) then
         call h5fclose_f(writer%file, status)
         call note(writer, status, "close the file")
      end if
      if (writer%text_type /= nothing) then
         call h5tclose_f(writer%text_type, status)
         call note(writer, status, "close a type")
      end if
      call close_list(writer, writer%file_creation)
      call close_list(writer, writer%file_access)
      call close_list(writer, writer%group_creation)
      call close_list(writer, writer%dataset_creation)
   end subroutine close_image

   !> Close a property list
   subroutine close_list(writer, list)
      !> Writer
      type(writer_t), intent(inout) :: writer
      !> Property list, or nothing
      integer(hid_t), intent(in) :: list
      integer :: status

      if (list == nothing) return
      call h5pclose_f(list, status)
      call note(writer, status, "close a property list")
   end subroutine close_list

   !> Keep the first failure
   pure subroutine note(writer, status, what)
      !> Writer
      type(writer_t), intent(inout) :: writer
      !> Status of HDF5, negative on failure
      integer, intent(in) :: status
      !> What was asked of HDF5
      character(len=*), intent(in) :: what

      if (status < 0 .and. .not. allocated(writer%fault)) writer%fault = what
   end subroutine note

end module vcor_io_hdf5_image
