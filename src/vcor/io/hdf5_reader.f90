!> HDF5 files read back: what is in them, and what they say about themselves
!>
!>     call open_hdf5(reader, "case.h5", error)
!>     text = text_attribute(reader, "/", "title")
!>     call list_members(reader, "summary", members, error)
!>     call close_hdf5(reader)
!>
!> Numbers and text of datasets are read by `vcor_io_hdf5_dataset`.
!>
!> Reads what `vcor_io_hdf5` writes and what others make of it (h5py, h5repack). Members come in the
!> order in which they were written where the file knows it, else by name. Every error is an
!> `error_file` with the name of the file, but for what a file lacks that is there: that is an
!> `error_input`.
module vcor_io_hdf5_reader
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only : c_loc, c_ptr
   use hdf5, only : h5_index_crt_order_f, h5_index_name_f, h5_iter_inc_f, h5aclose_f, &
      & h5aexists_by_name_f, h5aget_space_f, h5aopen_f, h5aread_f, h5f_acc_rdonly_f, h5fclose_f, &
      & h5fis_hdf5_f, h5fopen_f, h5gclose_f, h5gget_info_f, h5gopen_f, h5i_group_f, &
      & h5iget_type_f, h5lget_name_by_idx_f, h5oclose_f, h5oopen_f, h5sclose_f, h5t_native_double, &
      & hid_t, hsize_t
   use vcor_error, only : error_file, error_input, error_t, raise
   use vcor_io_hdf5_library, only : begin_hdf5, end_hdf5, handler_t
   use vcor_io_hdf5_text, only : attribute_of, read_lengths
   use vcor_io_path, only : directory_exists, file_exists, plain_file_exists
   use vcor_io_seal, only : check_seal
   use vcor_kinds, only : wp
   use vcor_text, only : printable, shortened
   implicit none
   private

   public :: reader_t, open_hdf5, close_hdf5
   public :: member_t, list_members, text_attribute, number_attribute

   !> Longest name of a member that is read [bytes]
   integer, parameter :: longest_name = 512

   !> A file that is being read
   type :: reader_t
      !> Its name as messages show it
      character(len=:), allocatable :: path
      !> The file, as HDF5 numbers it; negative unless it is open
      integer(hid_t) :: file = -1_hid_t
      !> Handler of errors before
      type(handler_t), private :: handler
   end type reader_t

   !> A member of a group
   type :: member_t
      !> Its name
      character(len=:), allocatable :: name
      !> Whether it is a group itself
      logical :: is_group = .false.
   end type member_t

contains

   !> Open a file
   subroutine open_hdf5(reader, filename, error)
      !> The open file
      type(reader_t), intent(out) :: reader
      !> Its name
      character(len=*), intent(in) :: filename
      !> Error of code `error_input` if it is no HDF5 file, `error_file` if it is damaged or cannot
      !> be read
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: fault
      integer :: status
      logical :: is_hdf5

      reader%path = printable(filename)
      if (len_trim(filename) == 0) then
         call raise(error, error_file, "the name of the file is empty, expected that of a file " &
            & //"of results")
      else if (directory_exists(filename)) then
         call raise(error, error_file, reader%path//": found a directory, expected a file of " &
            & //"results")
      else if (.not. file_exists(filename)) then
         call raise(error, error_file, reader%path//": there is no such file")
      else if (.not. plain_file_exists(filename)) then
         ! a pipe would keep a reader waiting
         call raise(error, error_file, reader%path//": found a device or a pipe, expected a file " &
            & //"of results")
      end if
      if (allocated(error)) return
      ! before HDF5 sees anything of it
      call check_seal(filename, error)
      if (allocated(error)) return

      call begin_hdf5(reader%handler, fault)
      if (allocated(fault)) then
         call raise(error, error_file, reader%path//": HDF5 cannot "//fault)
         return
      end if
      call h5fis_hdf5_f(trim(filename), is_hdf5, status)
      if (status < 0) then
         call raise(error, error_file, reader%path//": cannot be read")
      else if (.not. is_hdf5) then
         call raise(error, error_input, reader%path//": this is no HDF5 file, expected an HDF5 " &
            & //"file of results")
      else
         call h5fopen_f(trim(filename), h5f_acc_rdonly_f, reader%file, status)
         if (status < 0) call raise(error, error_file, reader%path//": HDF5 cannot open it: it " &
            & //"is damaged, or being written")
      end if
      if (allocated(error)) call end_hdf5(reader%handler)
   end subroutine open_hdf5

   !> Close a file
   subroutine close_hdf5(reader)
      !> Open file; closed afterwards
      type(reader_t), intent(inout) :: reader
      integer :: ignored

      if (reader%file < 0_hid_t) return
      call h5fclose_f(reader%file, ignored)
      call end_hdf5(reader%handler)
      reader%file = -1_hid_t
   end subroutine close_hdf5

   !> Members of a group, in the order they were written where the file knows it, else by name
   subroutine list_members(reader, path, members, error)
      !> Open file
      type(reader_t), intent(in) :: reader
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
      call h5gopen_f(reader%file, path, group, status)
      if (status < 0) then
         call raise(error, error_input, reader%path//": there is no group '"//shortened(path)//"'")
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
      if (status < 0) call raise(error, error_file, reader%path//": the group '"//shortened(path) &
         & //"' is damaged")
   end subroutine list_members

   !> A text attribute of a group or a dataset
   function text_attribute(reader, path, name) result(text)
      !> Open file
      type(reader_t), intent(in) :: reader
      !> Path of the group or the dataset, `/` for the file
      character(len=*), intent(in) :: path
      !> Name of the attribute
      character(len=*), intent(in) :: name
      !> Its value; empty if there is none or it is no text
      character(len=:), allocatable :: text
      integer(hid_t) :: object
      integer :: ignored, status

      text = ""
      call h5oopen_f(reader%file, path, object, status)
      if (status < 0) return
      text = attribute_of(object, name)
      call h5oclose_f(object, ignored)
   end function text_attribute

   !> A number as attribute of a group or a dataset
   function number_attribute(reader, path, name) result(number)
      !> Open file
      type(reader_t), intent(in) :: reader
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
      call h5aexists_by_name_f(reader%file, path, name, exists, status)
      if (status < 0 .or. .not. exists) return
      call h5oopen_f(reader%file, path, object, status)
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

end module vcor_io_hdf5_reader
