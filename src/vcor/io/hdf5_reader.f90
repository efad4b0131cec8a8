!> HDF5 files read back: what is in them, and what they say about themselves
!>
!>     call open_hdf5(reader, 'case.h5', error)
!>     text = text_attribute(reader, 'title')
!>     call read_column(reader, 'summary/cor', .false., n, column, error)
!>     call close_hdf5(reader)
!>
!> Reads what `vcor_io_hdf5` writes and what others make of it (h5py, h5repack): numbers of any
!> width and byte order, text of variable length. Every error is an `error_file` with the
!> name of the file, but for what a file lacks that is there: that is an `error_input`.
module vcor_io_hdf5_reader
   use, intrinsic :: iso_c_binding, only : c_int64_t, c_loc, c_null_ptr, c_ptr
   use hdf5, only : h5aclose_f, h5aexists_by_name_f, h5aget_space_f, h5aget_type_f, &
      h5aopen_by_name_f, h5aread_f, h5dclose_f, h5dget_space_f, h5dget_type_f, h5dopen_f, &
      h5dread_f, h5dvlen_reclaim_f, h5f_acc_rdonly_f, h5fclose_f, h5fis_hdf5_f, h5fopen_f, &
      h5p_default_f, h5sclose_f, h5sget_simple_extent_npoints_f, h5t_float_f, h5t_integer_f, &
      h5t_native_double, h5t_native_integer, h5t_string, h5t_string_f, h5tclose_f, h5tcopy_f, &
      h5tget_class_f, h5tget_cset_f, h5tis_variable_str_f, h5tset_cset_f, hid_t, hsize_t
   use vcor_error, only : error_file, error_input, error_t, raise
   use vcor_io_hdf5, only : begin_hdf5, c_get_offset, end_hdf5
   use vcor_io_path, only : check_readable, plain_file_exists
   use vcor_io_posix, only : fortran_text
   use vcor_io_seal, only : check_seal
   use vcor_io_table, only : column_t
   use vcor_text, only : integer_text, printable, shortened
   implicit none
   private

   public :: reader_t, open_hdf5, close_hdf5, text_attribute
   public :: read_column, find_dataset

   !> A file that is being read
   type :: reader_t
      !> Its name as messages show it
      character(len=:), allocatable :: path
      !> The file, as HDF5 numbers it; negative unless it is open
      integer(hid_t), private :: file = -1_hid_t
   end type reader_t

contains

   !> Open a file
   subroutine open_hdf5(reader, filename, error)
      type(reader_t), intent(out) :: reader
      character(len=*), intent(in) :: filename
      !> Error of code `error_input` if it is no HDF5 file, `error_file` if it is damaged or cannot
      !> be read
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: fault
      integer :: status
      logical :: is_hdf5

      reader%path = printable(filename)
      call check_readable(filename, 'a file of results', error)
      ! a pipe would keep a reader waiting
      if (allocated(error)) return
      if (.not. plain_file_exists(filename)) call raise(error, error_file, reader%path &
         //': found a device or a pipe, expected a file of results')
      ! before HDF5 sees anything of it
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
         call raise(error, error_input, reader%path//': this is no HDF5 file, expected an HDF5 ' &
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
      !> Open file; closed afterwards
      type(reader_t), intent(inout) :: reader

      integer :: ignored

      if (reader%file < 0_hid_t) return
      call h5fclose_f(reader%file, ignored)
      call end_hdf5()
      reader%file = -1_hid_t
   end subroutine close_hdf5

   !> A text attribute of the file
   function text_attribute(reader, name) result(text)
      type(reader_t), intent(in) :: reader
      character(len=*), intent(in) :: name
      !> Its value; empty if there is none or it is no single text of variable length
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

   !> Read a column of numbers, of which it is known what it has
   subroutine read_column(reader, path, is_whole, length, column, error)
      type(reader_t), intent(in) :: reader
      !> Path of the dataset
      character(len=*), intent(in) :: path
      !> Whether its values are whole numbers
      logical, intent(in) :: is_whole
      !> Number of its values
      integer, intent(in) :: length
      !> Its values, the last dimension the fastest as in nested loops
      type(column_t), intent(out), target :: column
      !> Set if there is none, or it has other values, or it cannot be read
      type(error_t), allocatable, intent(out) :: error

      type(c_ptr) :: place
      integer(hid_t) :: set, type_id
      integer :: class, ignored, status

      call open_dataset(reader, path, set, column%length, error)
      if (allocated(error)) return
      call h5dget_type_f(set, type_id, status)
      call h5tget_class_f(type_id, class, status)
      if (column%length /= length) then
         call raise(error, error_file, reader%path//': found '//integer_text(column%length) &
            //" values in '"//shortened(path)//"', expected "//integer_text(length))
      else if (class /= merge(h5t_integer_f, h5t_float_f, is_whole)) then
         status = -1
      else if (is_whole) then
         allocate (column%integers(length))
         place = c_loc(column%integers)
         if (length > 0) call h5dread_f(set, h5t_native_integer, place, status)
      else
         allocate (column%reals(length))
         place = c_loc(column%reals)
         if (length > 0) call h5dread_f(set, h5t_native_double, place, status)
      end if
      call h5tclose_f(type_id, ignored)
      call h5dclose_f(set, ignored)
      if (status < 0) call raise(error, error_file, reader%path//": the dataset '" &
         //shortened(path)//"' cannot be read as numbers")
   end subroutine read_column

   !> Find a dataset: how many values it has, and where in the file they are
   subroutine find_dataset(reader, path, length, offset, error)
      type(reader_t), intent(in) :: reader
      character(len=*), intent(in) :: path
      !> Number of its values
      integer, intent(out) :: length
      !> Bytes before the first one; negative where they are not in one piece
      integer(c_int64_t), intent(out) :: offset
      !> Set if there is none
      type(error_t), allocatable, intent(out) :: error

      integer(hid_t) :: set
      integer :: ignored

      offset = -1_c_int64_t
      call open_dataset(reader, path, set, length, error)
      if (allocated(error)) return
      offset = c_get_offset(int(set, c_int64_t))
      call h5dclose_f(set, ignored)
   end subroutine find_dataset

   !> Open a dataset
   subroutine open_dataset(reader, path, set, length, error)
      type(reader_t), intent(in) :: reader
      character(len=*), intent(in) :: path
      integer(hid_t), intent(out) :: set
      !> Number of its values
      integer, intent(out) :: length
      !> Error of code `error_input` if there is none; then nothing is open
      type(error_t), allocatable, intent(out) :: error

      integer(hid_t) :: space
      integer :: ignored, status

      length = 0
      call h5dopen_f(reader%file, path, set, status)
      if (status < 0) then
         call raise(error, error_input, reader%path//": there is no dataset '"//shortened(path) &
            //"'")
         return
      end if
      call h5dget_space_f(set, space, status)
      call read_length(space, length, status)
      call h5sclose_f(space, ignored)
      if (status >= 0) return
      call raise(error, error_file, reader%path//": the dataset '"//shortened(path) &
         //"' cannot be read as numbers")
      call h5dclose_f(set, ignored)
   end subroutine open_dataset

   !> Number of values of a space
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
