!> Datasets of HDF5 files read back, as columns or into arrays
!>
!>     call read_dataset(reader, "summary/cor", dataset, error)
!>     call read_numbers(reader, "summary/cor", cor, error)
!>
!> Numbers may be of any width and byte order, text of fixed or variable length.
module vcor_io_hdf5_dataset
   use, intrinsic :: iso_c_binding, only : c_int64_t, c_loc, c_ptr
   use hdf5, only : h5dclose_f, h5dget_space_f, h5dget_type_f, h5dopen_f, h5dread_f, h5sclose_f, &
      & h5t_float_f, h5t_integer_f, h5t_native_double, h5t_native_integer, h5t_string_f, &
      & h5tclose_f, h5tget_class_f, hid_t
   use vcor_error, only : error_file, error_input, error_t, raise
   use vcor_io_column, only : column_t, integer_column, real_column, text_column
   use vcor_io_hdf5_library, only : c_get_offset
   use vcor_io_hdf5_reader, only : reader_t
   use vcor_io_hdf5_text, only : attribute_of, read_lengths, read_texts
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, shortened
   implicit none
   private

   public :: dataset_t, read_dataset, read_numbers, find_place

   !> A dataset
   type :: dataset_t
      !> Name, unit, meaning and values, the last dimension the fastest as in nested loops
      type(column_t) :: column
      !> Lengths of its dimensions, the slowest first; a single value has none
      integer, allocatable :: lengths(:)
      !> Whether it is the scale of a dimension, which has its name
      logical :: is_scale = .false.
   end type dataset_t

   !> Read numbers into an array of their number
   interface read_numbers
      module procedure read_reals
      module procedure read_integers
   end interface read_numbers

contains

   !> Read a dataset with its unit and meaning
   subroutine read_dataset(reader, path, dataset, error)
      !> Open file
      type(reader_t), intent(in) :: reader
      !> Path of the dataset
      character(len=*), intent(in) :: path
      !> The dataset
      type(dataset_t), intent(out) :: dataset
      !> Set if there is none or it cannot be read
      type(error_t), allocatable, intent(out) :: error
      integer(hid_t) :: set, space, type_id
      integer :: class, ignored, status

      call open_dataset(reader, path, set, error)
      if (allocated(error)) return
      call h5dget_space_f(set, space, status)
      if (status >= 0) call read_lengths(space, dataset%lengths, status)
      if (status >= 0) then
         dataset%column%name = path(index(path, "/", back=.true.)+1:)
         dataset%column%unit = attribute_of(set, "units")
         dataset%column%long_name = attribute_of(set, "long_name")
         dataset%is_scale = attribute_of(set, "CLASS") == "DIMENSION_SCALE"
         dataset%column%length = product(dataset%lengths)
         call h5dget_type_f(set, type_id, status)
         call h5tget_class_f(type_id, class, status)
         if (status >= 0) call read_values(set, space, type_id, class, dataset%column, status)
         call h5tclose_f(type_id, ignored)
      end if
      call h5sclose_f(space, ignored)
      call h5dclose_f(set, ignored)
      if (status < 0) call raise(error, error_file, reader%path//": the dataset '"// &
         & shortened(path)//"' cannot be read as numbers or text")
   end subroutine read_dataset

   !> Read the values of a dataset
   subroutine read_values(set, space, type_id, class, column, status)
      !> The dataset
      integer(hid_t), intent(in) :: set
      !> Its space
      integer(hid_t), intent(in) :: space
      !> Its type in the file
      integer(hid_t), intent(in) :: type_id
      !> Class of its type
      integer, intent(in) :: class
      !> Column whose length is set; its kind and values are afterwards
      type(column_t), intent(inout), target :: column
      !> Negative on failure
      integer, intent(out) :: status
      type(c_ptr) :: place

      status = 0
      if (class == h5t_float_f) then
         column%kind = real_column
         allocate(column%reals(column%length))
         if (column%length == 0) return
         place = c_loc(column%reals)
         call h5dread_f(set, h5t_native_double, place, status)
      else if (class == h5t_integer_f) then
         column%kind = integer_column
         allocate(column%integers(column%length))
         if (column%length == 0) return
         place = c_loc(column%integers)
         call h5dread_f(set, h5t_native_integer, place, status)
      else if (class == h5t_string_f) then
         column%kind = text_column
         call read_texts(set, .false., space, type_id, column, status)
      else
         status = -1
      end if
   end subroutine read_values

   !> Open a dataset
   subroutine open_dataset(reader, path, set, error)
      !> Open file
      type(reader_t), intent(in) :: reader
      !> Path of the dataset
      character(len=*), intent(in) :: path
      !> The dataset
      integer(hid_t), intent(out) :: set
      !> Error of code `error_input` if there is none
      type(error_t), allocatable, intent(out) :: error
      integer :: status

      call h5dopen_f(reader%file, path, set, status)
      if (status < 0) call raise(error, error_input, reader%path//": there is no dataset '" &
         & //shortened(path)//"'")
   end subroutine open_dataset

   !> Read real numbers
   subroutine read_reals(reader, path, values, error)
      !> Open file
      type(reader_t), intent(in) :: reader
      !> Path of the dataset
      character(len=*), intent(in) :: path
      !> Its numbers, shape (n)
      real(wp), intent(inout), target :: values(:)
      !> Set if there are none, or not as many, or they cannot be read
      type(error_t), allocatable, intent(out) :: error

      call read_into(reader, path, h5t_native_double, size(values), c_loc(values), error)
   end subroutine read_reals

   !> Read whole numbers
   subroutine read_integers(reader, path, values, error)
      !> Open file
      type(reader_t), intent(in) :: reader
      !> Path of the dataset
      character(len=*), intent(in) :: path
      !> Its numbers, shape (n)
      integer, intent(inout), target :: values(:)
      !> Set if there are none, or not as many, or they cannot be read
      type(error_t), allocatable, intent(out) :: error

      call read_into(reader, path, h5t_native_integer, size(values), c_loc(values), error)
   end subroutine read_integers

   !> Read numbers to a place
   subroutine read_into(reader, path, memory_type, length, place, error)
      !> Open file
      type(reader_t), intent(in) :: reader
      !> Path of the dataset
      character(len=*), intent(in) :: path
      !> Type of the numbers
      integer(hid_t), intent(in) :: memory_type
      !> Number of them
      integer, intent(in) :: length
      !> Where they go
      type(c_ptr), intent(in) :: place
      !> Set if there are none, or not as many, or they cannot be read
      type(error_t), allocatable, intent(out) :: error
      type(c_ptr) :: values
      integer(hid_t) :: set, space
      integer, allocatable :: lengths(:)
      integer :: ignored, status

      call open_dataset(reader, path, set, error)
      if (allocated(error)) return
      call h5dget_space_f(set, space, status)
      if (status >= 0) call read_lengths(space, lengths, status)
      if (status >= 0) then
         if (product(lengths) /= length) then
            call raise(error, error_file, reader%path//": found "//integer_text(product(lengths)) &
               & //" numbers in '"//shortened(path)//"', expected "//integer_text(length))
         else if (length > 0) then
            values = place
            call h5dread_f(set, memory_type, values, status)
         end if
      end if
      call h5sclose_f(space, ignored)
      call h5dclose_f(set, ignored)
      if (status < 0) call raise(error, error_file, reader%path//": the dataset '"// &
         & shortened(path)//"' cannot be read as numbers")
   end subroutine read_into

   !> Find where in the file a dataset is that is stored in one piece
   subroutine find_place(reader, path, offset, error)
      !> Open file
      type(reader_t), intent(in) :: reader
      !> Path of the dataset
      character(len=*), intent(in) :: path
      !> Bytes before its first number
      integer(c_int64_t), intent(out) :: offset
      !> Set if there is no dataset, or it is not in one piece
      type(error_t), allocatable, intent(out) :: error
      integer(hid_t) :: set
      integer :: ignored

      offset = -1_c_int64_t
      call open_dataset(reader, path, set, error)
      if (allocated(error)) return
      offset = c_get_offset(int(set, c_int64_t))
      call h5dclose_f(set, ignored)
      if (offset < 0) call raise(error, error_file, reader%path//": the dataset '"// &
         & shortened(path)//"' is not in one piece")
   end subroutine find_place

end module vcor_io_hdf5_dataset
