!> What is in an HDF5 file: its groups, numbers of any shape, text, attributes
!>
!>     call open_input(input, "case.h5", error)
!>     call list_members(input, "summary", members, error)
!>     call read_dataset(input, "summary/cor", dataset, error)
!>     text = text_attribute(input, "/", "title")
!>     call close_input(input)
!>
!> Reads what `vcor_io_hdf5` writes and what others make of it (h5py, h5repack): numbers of any
!> width and byte order, text of fixed or variable length. Members come in the order in which they
!> were written where the file knows it, else by name. Every error is an `error_file` with the name
!> of the file, but for a file that is there and is no HDF5 file: that is an `error_input`.
module vcor_io_hdf5_contents
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only : c_loc, c_ptr
   use hdf5, only : h5_index_crt_order_f, h5_index_name_f, h5_iter_inc_f, h5aclose_f, &
      & h5aexists_by_name_f, h5aget_space_f, h5aopen_f, h5aread_f, h5dclose_f, h5dget_space_f, &
      & h5dget_type_f, h5dopen_f, h5dread_f, h5f_acc_rdonly_f, h5fclose_f, h5fis_hdf5_f, &
      & h5fopen_f, h5gclose_f, h5gget_info_f, h5gopen_f, h5i_group_f, h5iget_type_f, &
      & h5lget_name_by_idx_f, h5oclose_f, h5oopen_f, h5sclose_f, h5t_float_f, h5t_integer_f, &
      & h5t_native_double, h5t_native_integer, h5t_string_f, h5tclose_f, h5tget_class_f, hid_t, &
      & hsize_t
   use vcor_error, only : error_file, error_input, error_t, raise
   use vcor_io_file, only : directory_exists, file_exists
   use vcor_io_hdf5_library, only : begin_hdf5, end_hdf5, handler_t
   use vcor_io_hdf5_text, only : attribute_of, read_lengths, read_texts
   use vcor_io_table, only : column_t, integer_column, real_column, text_column
   use vcor_kinds, only : wp
   use vcor_study_text, only : printable, shortened
   implicit none
   private

   public :: hdf5_input_t, member_t, dataset_t
   public :: open_input, close_input, list_members, read_dataset
   public :: text_attribute, number_attribute

   !> Longest name of a member that is read [bytes]
   integer, parameter :: longest_name = 512

   !> A file that is being read
   type :: hdf5_input_t
      private
      !> The file
      integer(hid_t) :: file = -1_hid_t
      !> Its name as messages show it
      character(len=:), allocatable, public :: path
      !> Handler of errors before
      type(handler_t) :: handler
   end type hdf5_input_t

   !> A member of a group
   type :: member_t
      !> Its name
      character(len=:), allocatable :: name
      !> Whether it is a group itself
      logical :: is_group = .false.
   end type member_t

   !> A dataset
   type :: dataset_t
      !> Name, unit, meaning and values, the last dimension the fastest as in nested loops
      type(column_t) :: column
      !> Lengths of its dimensions, the slowest first; a single value has none
      integer, allocatable :: lengths(:)
      !> Whether it is the scale of a dimension, which has its name
      logical :: is_scale = .false.
   end type dataset_t

contains

   !> Open a file
   subroutine open_input(input, filename, error)
      !> The open file
      type(hdf5_input_t), intent(out) :: input
      !> Its name
      character(len=*), intent(in) :: filename
      !> Error of code `error_input` if it is no HDF5 file, `error_file` if it cannot be read
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: fault
      integer :: status
      logical :: is_hdf5

      input%path = printable(filename)
      if (len_trim(filename) == 0) then
         call raise(error, error_file, "the name of the file is empty, expected that of a file " &
            & //"of results")
      else if (directory_exists(filename)) then
         call raise(error, error_file, input%path//": found a directory, expected a file of " &
            & //"results")
      else if (.not. file_exists(filename)) then
         call raise(error, error_file, input%path//": there is no such file")
      end if
      if (allocated(error)) return

      call begin_hdf5(input%handler, fault)
      if (allocated(fault)) then
         call raise(error, error_file, input%path//": HDF5 cannot "//fault)
         return
      end if
      call h5fis_hdf5_f(trim(filename), is_hdf5, status)
      if (status < 0) then
         call raise(error, error_file, input%path//": cannot be read")
      else if (.not. is_hdf5) then
         call raise(error, error_input, input%path//": this is no HDF5 file, expected the .h5 " &
            & //"file of a run")
      else
         call h5fopen_f(trim(filename), h5f_acc_rdonly_f, input%file, status)
         if (status < 0) call raise(error, error_file, input%path//": HDF5 cannot open it: it is " &
            & //"damaged, or being written")
      end if
      if (allocated(error)) call end_hdf5(input%handler)
   end subroutine open_input

   !> Close a file
   subroutine close_input(input)
      !> Open file; closed afterwards
      type(hdf5_input_t), intent(inout) :: input
      integer :: ignored

      if (input%file < 0_hid_t) return
      call h5fclose_f(input%file, ignored)
      call end_hdf5(input%handler)
      input%file = -1_hid_t
   end subroutine close_input

   !> Members of a group, in the order they were written where the file knows it, else by name
   subroutine list_members(input, path, members, error)
      !> Open file
      type(hdf5_input_t), intent(in) :: input
      !> Path of the group, `/` for the file
      character(len=*), intent(in) :: path
      !> Its members, shape (n)
      type(member_t), allocatable, intent(out) :: members(:)
      !> Set if there is no such group or it cannot be read
      type(error_t), allocatable, intent(out) :: error
      character(len=longest_name) :: name
      integer(hid_t) :: group, object
      integer :: count, i, ignored, kind, last_order, order, status, storage

      allocate(members(0))
      call h5gopen_f(input%file, path, group, status)
      if (status < 0) then
         call raise(error, error_input, input%path//": there is no group '"//shortened(path)//"'")
         return
      end if
      call h5gget_info_f(group, storage, count, last_order, status)
      if (status >= 0) then
         deallocate(members)
         allocate(members(count))
      end if
      order = h5_index_crt_order_f
      do i = 1, size(members)
         call h5lget_name_by_idx_f(group, ".", order, h5_iter_inc_f, int(i - 1, hsize_t), name, &
            & status)
         if (status < 0 .and. i == 1) then
            order = h5_index_name_f
            call h5lget_name_by_idx_f(group, ".", order, h5_iter_inc_f, 0_hsize_t, name, status)
         end if
         if (status < 0) exit
         members(i)%name = trim(name)
         call h5oopen_f(group, trim(name), object, status)
         if (status < 0) exit
         call h5iget_type_f(object, kind, status)
         members(i)%is_group = kind == h5i_group_f
         call h5oclose_f(object, ignored)
      end do
      call h5gclose_f(group, ignored)
      if (status < 0) call raise(error, error_file, input%path//": the group '"//shortened(path) &
         & //"' is damaged")
   end subroutine list_members

   !> Read a dataset with its unit and meaning
   subroutine read_dataset(input, path, dataset, error)
      !> Open file
      type(hdf5_input_t), intent(in) :: input
      !> Path of the dataset
      character(len=*), intent(in) :: path
      !> The dataset
      type(dataset_t), intent(out) :: dataset
      !> Set if there is none or it cannot be read
      type(error_t), allocatable, intent(out) :: error
      integer(hid_t) :: set, space, type_id
      integer :: class, ignored, status

      call h5dopen_f(input%file, path, set, status)
      if (status < 0) then
         call raise(error, error_input, input%path//": there is no dataset '"//shortened(path)//"'")
         return
      end if
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
      if (status < 0) call raise(error, error_file, input%path//": the dataset '"//shortened(path) &
         & //"' cannot be read as numbers or text")
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

   !> A text attribute of a group or a dataset
   function text_attribute(input, path, name) result(text)
      !> Open file
      type(hdf5_input_t), intent(in) :: input
      !> Path of the group or the dataset, `/` for the file
      character(len=*), intent(in) :: path
      !> Name of the attribute
      character(len=*), intent(in) :: name
      !> Its value; empty if there is none or it is no text
      character(len=:), allocatable :: text
      integer(hid_t) :: object
      integer :: ignored, status

      text = ""
      call h5oopen_f(input%file, path, object, status)
      if (status < 0) return
      text = attribute_of(object, name)
      call h5oclose_f(object, ignored)
   end function text_attribute

   !> A number as attribute of a group or a dataset
   function number_attribute(input, path, name) result(number)
      !> Open file
      type(hdf5_input_t), intent(in) :: input
      !> Path of the group or the dataset, `/` for the file
      character(len=*), intent(in) :: path
      !> Name of the attribute
      character(len=*), intent(in) :: name
      !> Its value; NaN if there is none or it is no single number
      real(wp) :: number
      real(wp), target :: value(1)
      type(c_ptr) :: place
      integer(hid_t) :: attribute, object, space
      integer, allocatable :: lengths(:)
      integer :: ignored, status
      logical :: exists

      number = ieee_value(1.0_wp, ieee_quiet_nan)
      call h5aexists_by_name_f(input%file, path, name, exists, status)
      if (status < 0 .or. .not. exists) return
      call h5oopen_f(input%file, path, object, status)
      if (status < 0) return
      call h5aopen_f(object, name, attribute, status)
      if (status >= 0) then
         call h5aget_space_f(attribute, space, status)
         call read_lengths(space, lengths, status)
         if (status >= 0 .and. product(lengths) == 1) then
            place = c_loc(value)
            call h5aread_f(attribute, h5t_native_double, place, status)
            if (status >= 0) number = value(1)
         end if
         call h5sclose_f(space, ignored)
         call h5aclose_f(attribute, ignored)
      end if
      call h5oclose_f(object, ignored)
   end function number_attribute

end module vcor_io_hdf5_contents
