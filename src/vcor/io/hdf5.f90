!> Tables as an HDF5 file
!>
!>     /                  attributes program, version, title, case
!>     /summary           a dataset per dimension and column, in their order
!>     /history           the same, if there is a history
!>     /...               the same for each further table
!>
!> Numbers that belong to a whole table are attributes of its group, `NAME` and `NAME_units`. Every
!> dataset has the attributes `units` (not for text) and `long_name`. Dimensions are dimension
!> scales attached to the columns, so that h5py, xarray (h5netcdf), netCDF-4 and h5dump see named
!> axes. A grid has datasets of several dimensions, the first of the table first, as C and Python
!> count them. Numbers are IEEE binary64 and 32-bit integers, little endian; text is UTF-8 of
!> variable length, which Python reads as `str`. A slash in a name becomes `_`.
!>
!> Datasets of numbers are in chunks with the check sums of HDF5's filter fletcher32, so that
!> reading damaged numbers is an error.
!>
!> HDF5 1.10 crashes when it closes a file that it could not write, as on a full disk. So the disk
!> space of the file is allocated before HDF5 writes to it. Objects have no time stamps: equal
!> tables give equal bytes.
module vcor_io_hdf5
   use, intrinsic :: iso_c_binding, only : c_char, c_loc, c_null_char, c_ptr
   use, intrinsic :: iso_fortran_env, only : int64
   use h5ds, only : h5dsattach_scale_f, h5dsset_scale_f
   use hdf5, only : h5aclose_f, h5acreate_f, h5awrite_f, h5dclose_f, h5dcreate_f, &
      h5dwrite_f, h5eset_auto_f, h5f_acc_rdwr_f, h5f_acc_trunc_f, h5f_close_strong_f, &
      h5f_libver_v110_f, h5fclose_f, h5fcreate_f, h5fopen_f, h5gclose_f, h5gcreate_f, &
      h5iis_valid_f, h5open_f, h5p_crt_order_indexed_f, h5p_crt_order_tracked_f, &
      h5p_dataset_create_f, h5p_file_access_f, h5p_file_create_f, h5p_group_create_f, &
      h5pclose_f, h5pcopy_f, h5pcreate_f, &
      h5pset_chunk_f, h5pset_fclose_degree_f, h5pset_fill_value_f, h5pset_fletcher32_f, &
      h5pset_libver_bounds_f, &
      h5pset_link_creation_order_f, h5pset_obj_track_times_f, h5s_scalar_f, h5sclose_f, &
      h5screate_f, h5screate_simple_f, h5t_cset_utf8_f, h5t_ieee_f64le, h5t_native_double, &
      h5t_native_integer, h5t_std_i32le, h5t_string, h5tclose_f, h5tcopy_f, h5tset_cset_f, hid_t, &
      hsize_t
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_file, only : commit, create_file, discard, output_file_t, reserve
   use vcor_io_path, only : quoted_path
   use vcor_io_table, only : column_t, integer_column, real_column, table_t, &
      text_column, text_value
   use vcor_kinds, only : wp
   use vcor_text, only : link_name
   implicit none
   private

   public :: write_hdf5

   !> An invalid identifier
   integer(hid_t), parameter :: nothing = -1_hid_t

   !> A file that is being written. The first failure is stored; later calls do nothing
   type :: writer_t
      integer(hid_t) :: file = nothing
      !> Property lists for creating groups and datasets
      integer(hid_t) :: group_creation = nothing, dataset_creation = nothing
      integer(hid_t) :: text_type = nothing
      !> The first failure; unallocated if there is none
      character(len=:), allocatable :: fault
   end type writer_t

contains

   !> Open the library and keep it from printing errors
   subroutine begin_hdf5(fault)
      !> What failed; unallocated on success
      character(len=:), allocatable, intent(out) :: fault

      integer :: status
      logical :: is_open

      ! the types of HDF5 are valid if anybody has opened the library; it is never closed here,
      ! since that would close everything else that the program has open in HDF5
      call h5iis_valid_f(h5t_native_double, is_open, status)
      if (status < 0 .or. .not. is_open) call h5open_f(status)
      if (status >= 0) call h5eset_auto_f(0, status)
      if (status < 0) fault = 'open its library'
   end subroutine begin_hdf5

   !> Let HDF5 print errors, its default
   subroutine end_hdf5()
      integer :: ignored

      call h5eset_auto_f(1, ignored)
   end subroutine end_hdf5

   !> Write tables to a file, which appears complete or, on failure, stays as it was
   subroutine write_hdf5(filename, tables, error)
      !> Name of the file; an existing one is replaced
      character(len=*), intent(in) :: filename
      !> Tables, shape (n), n > 0; version, title and case of the first one describe the file
      type(table_t), intent(in) :: tables(:)
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      type(output_file_t) :: file

      call create_file(file, filename, error)
      if (.not. allocated(error)) call fill(file, tables, error)
      if (.not. allocated(error)) call commit(file, error)
   end subroutine write_hdf5

   !> Write tables to an open file
   subroutine fill(file, tables, error)
      !> Open file; discarded on failure
      type(output_file_t), intent(inout) :: file
      type(table_t), intent(in) :: tables(:)
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      type(writer_t) :: writer
      integer :: i, ignored

      call begin_hdf5(writer%fault)
      if (.not. allocated(writer%fault)) then
         call begin_file(writer, file, bytes_of(tables), error)
         if (.not. allocated(error)) then
            call put_text(writer, writer%file, 'program', 'vcor')
            call put_text(writer, writer%file, 'version', tables(1)%version)
            call put_text(writer, writer%file, 'title', tables(1)%title)
            call put_text(writer, writer%file, 'case', tables(1)%case_text)
            do i = 1, size(tables)
               call put_table(writer, tables(i))
            end do
            ! objects left open after a failure are closed with the file
            call h5fclose_f(writer%file, i)
            call note(writer, i, 'close the file')
         end if
         call h5tclose_f(writer%text_type, ignored)
         call h5pclose_f(writer%group_creation, ignored)
         call h5pclose_f(writer%dataset_creation, ignored)
         call end_hdf5()
      end if
      if (allocated(writer%fault)) then
         call raise(error, error_file, &
            'cannot write '//quoted_path(file%path)//': HDF5 cannot '//writer%fault)
         call discard(file)
      end if
   end subroutine fill

   !> Create a file, with the property lists and the type that all its objects share
   subroutine begin_file(writer, file, bytes, error)
      !> Writer without open objects
      type(writer_t), intent(inout) :: writer
      !> File to write to
      type(output_file_t), intent(inout) :: file
      !> Disk space [bytes]
      integer(int64), intent(in) :: bytes
      !> Set if there is not enough space
      type(error_t), allocatable, intent(out) :: error

      integer(hid_t) :: access, creation
      integer :: ignored, order, status(13)

      order = ior(h5p_crt_order_tracked_f, h5p_crt_order_indexed_f)
      call h5pcreate_f(h5p_file_create_f, creation, status(1))
      call h5pset_link_creation_order_f(creation, order, status(2))
      call h5pset_obj_track_times_f(creation, .false., status(3))
      call h5pcreate_f(h5p_group_create_f, writer%group_creation, status(4))
      call h5pset_link_creation_order_f(writer%group_creation, order, status(5))
      call h5pset_obj_track_times_f(writer%group_creation, .false., status(6))
      call h5pcreate_f(h5p_dataset_create_f, writer%dataset_creation, status(7))
      call h5pset_obj_track_times_f(writer%dataset_creation, .false., status(8))
      call h5pcreate_f(h5p_file_access_f, access, status(9))
      ! from 1.8 on HDF5 has check sums of its metadata, from 1.10 on the only chunk of a dataset
      ! needs no index (an index of 1.8 has bytes that are never set)
      call h5pset_libver_bounds_f(access, h5f_libver_v110_f, h5f_libver_v110_f, status(10))
      call h5pset_fclose_degree_f(access, h5f_close_strong_f, status(11))
      call h5tcopy_f(h5t_string, writer%text_type, status(12))
      call h5tset_cset_f(writer%text_type, h5t_cset_utf8_f, status(13))
      call reserve(file, bytes, error)
      if (.not. allocated(error)) then
         call h5fcreate_f(file%opened, h5f_acc_trunc_f, writer%file, status(1), creation, access)
         call h5fclose_f(writer%file, ignored)
         ! HDF5 has released the space
         call reserve(file, bytes, error)
      end if
      if (.not. allocated(error)) then
         call h5fopen_f(file%opened, h5f_acc_rdwr_f, writer%file, status(2), access)
         call note(writer, minval(status), 'create a file')
      end if
      call h5pclose_f(creation, ignored)
      call h5pclose_f(access, ignored)
   end subroutine begin_file

   !> Upper bound of the disk space of tables [bytes]
   pure function bytes_of(tables) result(bytes)
      type(table_t), intent(in) :: tables(:)
      integer(int64) :: bytes

      ! upper bounds of HDF5's own space for a dataset, for a chunk in its index, and for a text
      integer(int64), parameter :: per_dataset = 4096_int64, per_chunk = 512_int64, &
         per_text = 44_int64
      integer :: i, j

      bytes = 0
      do j = 1, size(tables)
         associate (table => tables(j))
            bytes = bytes + 65536_int64 + len(table%case_text, kind=int64)
            do i = 1, size(table%dimensions)
               bytes = bytes + bytes_of_column(table%dimensions(i), [table%dimensions(i)%length])
            end do
            do i = 1, size(table%columns)
               bytes = bytes + bytes_of_column(table%columns(i), table%dimensions%length)
            end do
         end associate
      end do

   contains

      !> Space of one column
      pure function bytes_of_column(column, lengths) result(bytes)
         type(column_t), intent(in) :: column
         !> Lengths of its dimensions
         integer, intent(in) :: lengths(:)
         integer(int64) :: bytes

         integer(int64) :: chunks
         integer :: chunk(size(lengths))

         if (is_uniform(column)) then
            bytes = 0_int64
         else if (column%kind == text_column) then
            bytes = (column%width + per_text)*column%length
         else
            chunk = chunk_of(lengths)
            chunks = product(int((lengths + chunk - 1)/chunk, int64))
            bytes = chunks*(product(int(chunk, int64))*merge(8, 4, column%kind == real_column) &
               + per_chunk)
         end if
         bytes = per_dataset + bytes
      end function bytes_of_column
   end function bytes_of

   !> Lengths of a chunk: all of a small dataset, of a large one equal parts of about a megabyte,
   !> divided along the slowest dimensions
   pure function chunk_of(lengths) result(chunk)
      !> Lengths of the dimensions
      integer, intent(in) :: lengths(:)
      integer :: chunk(size(lengths))

      integer, parameter :: largest = 131072
      integer :: i, parts, room

      room = largest
      do i = size(lengths), 1, -1
         parts = max(1, (lengths(i) + room - 1)/room)
         chunk(i) = max(1, (lengths(i) + parts - 1)/parts)
         room = max(1, room/chunk(i))
      end do
   end function chunk_of

   !> Write a table as a group
   subroutine put_table(writer, table)
      type(writer_t), intent(inout) :: writer
      type(table_t), intent(in), target :: table

      integer(hid_t) :: dataset, group, scales(size(table%dimensions))
      integer :: i, j, status

      if (allocated(writer%fault)) return
      call h5gcreate_f(writer%file, table%name, group, status, gcpl_id=writer%group_creation)
      call note(writer, status, "create the group '"//table%name//"'")
      do i = 1, size(table%facts)
         associate (fact => table%facts(i))
            call put_attribute(writer, group, fact%name, h5t_ieee_f64le, h5t_native_double, &
               c_loc(fact%reals))
            call put_text(writer, group, fact%name//'_units', fact%unit)
         end associate
      end do
      do i = 1, size(scales)
         associate (coordinates => table%dimensions(i))
            call put_column(writer, group, coordinates, [coordinates%length], scales(i))
            if (allocated(writer%fault)) return
            call h5dsset_scale_f(scales(i), status, link_name(coordinates%name))
            call note(writer, status, "make '"//coordinates%name//"' a dimension scale")
         end associate
      end do
      do j = 1, size(table%columns)
         call put_column(writer, group, table%columns(j), table%dimensions%length, dataset)
         if (allocated(writer%fault)) return
         do i = 1, size(scales)
            ! numbered as in C, the slowest dimension first, but from 1
            call h5dsattach_scale_f(dataset, scales(i), i, status)
            call note(writer, status, "attach a dimension to '"//table%columns(j)%name//"'")
         end do
         call h5dclose_f(dataset, status)
      end do
      do i = 1, size(scales)
         call h5dclose_f(scales(i), status)
      end do
      call h5gclose_f(group, status)
   end subroutine put_table

   !> Write a column as a dataset and leave it open
   subroutine put_column(writer, group, column, lengths, dataset)
      type(writer_t), intent(inout) :: writer
      integer(hid_t), intent(in) :: group
      type(column_t), intent(in), target :: column
      !> Lengths of its dimensions, the slowest first
      integer, intent(in) :: lengths(:)
      !> The dataset, open
      integer(hid_t), intent(out) :: dataset

      integer(hid_t) :: creation, space, type_id
      integer(hsize_t) :: chunk(size(lengths))
      integer :: status
      logical :: is_filled

      dataset = nothing
      if (allocated(writer%fault)) return
      select case (column%kind)
      case (real_column)
         type_id = h5t_ieee_f64le
      case (integer_column)
         type_id = h5t_std_i32le
      case default
         type_id = writer%text_type
      end select
      call h5screate_simple_f(size(lengths), int(lengths(size(lengths):1:-1), hsize_t), space, &
         status)
      call note(writer, status, "make the dimensions of '"//column%name//"'")
      is_filled = is_uniform(column)
      call h5pcopy_f(writer%dataset_creation, creation, status)
      if (is_filled) call set_fill_text(column, type_id, creation, status)
      if (column%kind /= text_column .and. column%length > 0) then
         chunk = int(chunk_of(lengths), hsize_t)
         call h5pset_chunk_f(creation, size(chunk), chunk(size(chunk):1:-1), status)
         call note(writer, status, "set the chunks of '"//column%name//"'")
         call h5pset_fletcher32_f(creation, status)
      end if
      call note(writer, status, "set the properties of '"//column%name//"'")
      call h5dcreate_f(group, link_name(column%name), type_id, space, dataset, status, &
         dcpl_id=creation)
      call note(writer, status, "create '"//column%name//"'")
      call h5pclose_f(creation, status)
      call h5sclose_f(space, status)
      if (allocated(writer%fault)) return

      ! an array of size 0 has no address
      if (column%length > 0 .and. .not. is_filled) then
         select case (column%kind)
         case (real_column)
            call h5dwrite_f(dataset, h5t_native_double, c_loc(column%reals), status)
         case (integer_column)
            call h5dwrite_f(dataset, h5t_native_integer, c_loc(column%integers), status)
         case default
            call write_texts(column, dataset, type_id, status)
         end select
         call note(writer, status, "write '"//column%name//"'")
      end if
      if (column%unit /= '') call put_text(writer, dataset, 'units', column%unit)
      call put_text(writer, dataset, 'long_name', column%long_name)
   end subroutine put_column

   !> Whether all values of a long column are one text, usually `status`: it is then only the fill
   !> value of its dataset, which reads the same. HDF5 takes 50 bytes and a microsecond to store a
   !> text
   pure function is_uniform(column)
      type(column_t), intent(in) :: column
      logical :: is_uniform

      integer, parameter :: longest_stored = 50000

      is_uniform = column%kind == text_column .and. column%length > longest_stored
      if (is_uniform) is_uniform = all(column%integers == column%integers(1))
   end function is_uniform

   !> Set the first text of a column as the fill value
   subroutine set_fill_text(column, type_id, creation, status)
      !> Text column
      type(column_t), intent(in) :: column
      integer(hid_t), intent(in) :: type_id
      !> Property list of the dataset
      integer(hid_t), intent(in) :: creation
      !> Negative on failure
      integer, intent(out) :: status

      character(len=:, kind=c_char), allocatable, target :: text
      type(c_ptr), target :: place

      text = text_value(column, 1)//c_null_char
      place = c_loc(text)
      call h5pset_fill_value_f(creation, type_id, c_loc(place), status)
   end subroutine set_fill_text

   !> Write the values of a text column: HDF5 needs the address of each
   subroutine write_texts(column, dataset, type_id, status)
      !> Text column
      type(column_t), intent(in) :: column
      integer(hid_t), intent(in) :: dataset
      integer(hid_t), intent(in) :: type_id
      !> Negative on failure
      integer, intent(out) :: status

      character(len=column%width+1, kind=c_char), allocatable, target :: texts(:)
      type(c_ptr), allocatable, target :: places(:)
      integer :: i

      allocate (texts(maxval(column%integers)), places(column%length))
      do i = 1, size(texts)
         texts(i) = trim(column%texts((i - 1)*column%width + 1:i*column%width))//c_null_char
      end do
      do i = 1, column%length
         places(i) = c_loc(texts(column%integers(i)))
      end do
      call h5dwrite_f(dataset, type_id, c_loc(places), status)
   end subroutine write_texts

   !> Write a text attribute
   subroutine put_text(writer, object, name, text)
      type(writer_t), intent(inout) :: writer
      !> Object of the attribute
      integer(hid_t), intent(in) :: object
      !> Name and value of the attribute
      character(len=*), intent(in) :: name, text

      character(len=:, kind=c_char), allocatable, target :: value
      type(c_ptr), target :: place

      value = text//c_null_char
      place = c_loc(value)
      call put_attribute(writer, object, name, writer%text_type, writer%text_type, c_loc(place))
   end subroutine put_text

   !> Write an attribute
   subroutine put_attribute(writer, object, name, file_type, memory_type, value)
      type(writer_t), intent(inout) :: writer
      !> Object of the attribute
      integer(hid_t), intent(in) :: object
      character(len=*), intent(in) :: name
      !> Type of the value in the file and in memory
      integer(hid_t), intent(in) :: file_type, memory_type
      !> Address of the value
      type(c_ptr), intent(in) :: value

      integer(hid_t) :: attribute, space
      integer :: status(5)

      if (allocated(writer%fault)) return
      call h5screate_f(h5s_scalar_f, space, status(1))
      call h5acreate_f(object, name, file_type, space, attribute, status(2))
      call h5awrite_f(attribute, memory_type, value, status(3))
      call h5aclose_f(attribute, status(4))
      call h5sclose_f(space, status(5))
      call note(writer, minval(status), "write the attribute '"//name//"'")
   end subroutine put_attribute

   !> Store the first failure
   pure subroutine note(writer, status, what)
      type(writer_t), intent(inout) :: writer
      integer, intent(in) :: status
      !> What HDF5 was asked to do
      character(len=*), intent(in) :: what

      if (status < 0 .and. .not. allocated(writer%fault)) writer%fault = what
   end subroutine note

end module vcor_io_hdf5
