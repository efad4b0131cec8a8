!> Reads HDF5 files: text attributes, and lengths and positions of datasets
!>
!>     call open_hdf5(reader, 'case.h5', error)
!>     text = text_attribute(reader, 'title')
!>     call find_dataset(reader, 'summary/cor', length, offset, error)
!>     call close_hdf5(reader)
!>
!> Every error is an `error_file` with the name of the file.
module vcor_io_hdf5_reader
   use, intrinsic :: iso_c_binding, only : c_int64_t, c_loc, c_null_ptr, c_ptr
   use hdf5, only : h5aclose_f, h5aexists_by_name_f, h5aget_space_f, h5aget_type_f, &
      h5aopen_by_name_f, h5aread_f, h5dclose_f, h5dget_space_f, h5dopen_f, h5dvlen_reclaim_f, &
      h5f_acc_rdonly_f, h5fclose_f, h5fis_hdf5_f, h5fopen_f, h5p_default_f, h5sclose_f, &
      h5sget_simple_extent_npoints_f, h5t_string, h5t_string_f, h5tclose_f, h5tcopy_f, &
      h5tget_class_f, h5tget_cset_f, h5tis_variable_str_f, h5tset_cset_f, hid_t, hsize_t
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_hdf5, only : begin_hdf5, c_get_offset, end_hdf5
   use vcor_io_path, only : check_readable, plain_file_exists
   use vcor_io_posix, only : fortran_text
   use vcor_io_seal, only : check_seal
   use vcor_text, only : printable
   implicit none
   private

   public :: reader_t, open_hdf5, close_hdf5, text_attribute, find_dataset

   !> A file open for reading
   type :: reader_t
      !> Its name for messages
      character(len=:), allocatable :: path
      !> Identifier of the file in HDF5; negative unless it is open
      integer(hid_t), private :: file = -1_hid_t
   end type reader_t

contains

   !> Open a file
   subroutine open_hdf5(reader, filename, error)
      type(reader_t), intent(out) :: reader
      character(len=*), intent(in) :: filename
      !> Set if it is no HDF5 file, is damaged or cannot be read
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: fault
      integer :: status
      logical :: is_hdf5

      reader%path = printable(filename)
      call check_readable(filename, 'a file of results', error)
      ! reading a pipe might wait forever
      if (allocated(error)) return
      if (.not. plain_file_exists(filename)) call raise(error, error_file, reader%path &
         //': found a device or a pipe, expected a file of results')
      ! HDF5 must not read a damaged file
      if (.not. allocated(error)) call check_seal(filename, error)
      if (allocated(error)) return

      call begin_hdf5(fault)
      if (allocated(fault)) then
         call raise(error, error_file, reader%path//': HDF5 cannot '//fault)
         return
      end if
      call h5fis_hdf5_f(trim(filename), is_hdf5, status)
      if (status < 0) then
         call raise(error, error_file, reader%path//': cannot be read')
      else if (.not. is_hdf5) then
         call raise(error, error_file, reader%path//': this is no HDF5 file, expected an HDF5 ' &
            //'file of results')
      else
         call h5fopen_f(trim(filename), h5f_acc_rdonly_f, reader%file, status)
         if (status < 0) call raise(error, error_file, reader%path//': HDF5 cannot open it: it ' &
            //'is damaged, or being written')
      end if
      if (allocated(error)) call end_hdf5()
   end subroutine open_hdf5

   !> Close a file
   subroutine close_hdf5(reader)
      !> Open file; closed on return
      type(reader_t), intent(inout) :: reader

      integer :: ignored

      if (reader%file < 0_hid_t) return
      call h5fclose_f(reader%file, ignored)
      call end_hdf5()
      reader%file = -1_hid_t
   end subroutine close_hdf5

   !> Text attribute of the file
   function text_attribute(reader, name) result(text)
      type(reader_t), intent(in) :: reader
      character(len=*), intent(in) :: name
      !> Its value; empty if there is none, or if it is not a single text of variable length
      character(len=:), allocatable :: text

      type(c_ptr), target :: place
      type(c_ptr) :: buffer
      integer(hid_t) :: attribute, memory_type, space, type_id
      integer :: character_set, class, ignored, length, status
      logical :: exists, varies

      text = ''
      call h5aexists_by_name_f(reader%file, '/', name, exists, status)
      if (status < 0 .or. .not. exists) return
      call h5aopen_by_name_f(reader%file, '/', name, attribute, status)
      if (status < 0) return
      call h5aget_space_f(attribute, space, status)
      call h5aget_type_f(attribute, type_id, status)
      call read_length(space, length, status)
      varies = .false.
      call h5tget_class_f(type_id, class, status)
      if (class == h5t_string_f) call h5tis_variable_str_f(type_id, varies, status)
      if (varies .and. length == 1) then
         call h5tget_cset_f(type_id, character_set, status)
         call h5tcopy_f(h5t_string, memory_type, status)
         call h5tset_cset_f(memory_type, character_set, status)
         place = c_null_ptr
         buffer = c_loc(place)
         call h5aread_f(attribute, memory_type, buffer, status)
         if (status >= 0) then
            text = trim(fortran_text(place))
            call h5dvlen_reclaim_f(memory_type, space, h5p_default_f, buffer, ignored)
         end if
         call h5tclose_f(memory_type, ignored)
      end if
      call h5tclose_f(type_id, ignored)
      call h5sclose_f(space, ignored)
      call h5aclose_f(attribute, ignored)
   end function text_attribute

   !> Find length and position of a dataset
   subroutine find_dataset(reader, path, length, offset, error)
      type(reader_t), intent(in) :: reader
      character(len=*), intent(in) :: path
      !> Number of its values
      integer, intent(out) :: length
      !> Bytes before the first value; negative if the dataset is not contiguous
      integer(c_int64_t), intent(out) :: offset
      !> Set if there is no such dataset
      type(error_t), allocatable, intent(out) :: error

      integer(hid_t) :: set, space
      integer :: ignored, status

      length = 0
      offset = -1_c_int64_t
      call h5dopen_f(reader%file, path, set, status)
      if (status < 0) then
         call raise(error, error_file, reader%path//": there is no dataset '"//path//"'")
         return
      end if
      call h5dget_space_f(set, space, status)
      call read_length(space, length, status)
      call h5sclose_f(space, ignored)
      if (status >= 0) offset = c_get_offset(int(set, c_int64_t))
      call h5dclose_f(set, ignored)
      if (status < 0) call raise(error, error_file, reader%path//": the dataset '"//path &
         //"' cannot be read as numbers")
   end subroutine find_dataset

   !> Number of values of a dataspace
   subroutine read_length(space, length, status)
      integer(hid_t), intent(in) :: space
      integer, intent(out) :: length
      !> Negative on failure
      integer, intent(out) :: status

      integer(hsize_t) :: number

      call h5sget_simple_extent_npoints_f(space, number, status)
      if (number < 0 .or. number > huge(1)) status = -1
      length = 0
      if (status >= 0) length = int(number)
   end subroutine read_length

end module vcor_io_hdf5_reader
