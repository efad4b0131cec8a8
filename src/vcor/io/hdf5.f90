!> Tables as an HDF5 file
!>
!>     /                  attributes program, version, title, case
!>     /summary           a dataset per dimension and column, in their order
!>     /history           the same, if there is a history
!>     /...               the same for each further table
!>
!> Numbers that hold for a table as a whole are attributes of its group, `NAME` and `NAME_units`.
!> Every dataset has the attributes `units` (none for text) and `long_name`. A dimension is a
!> dimension scale and attached to the columns, so that h5py, xarray (h5netcdf), netCDF-4 and h5dump
!> see named axes. A grid has datasets of more than one dimension, the first of the table first, as
!> C and Python count them. Numbers are IEEE binary64 and 32-bit integers, little endian; text is
!> UTF-8 of variable length, which Python reads as `str`. A slash in a name becomes `_`.
!>
!> Columns of more than `longest_plain` numbers most of which repeat the one before are compressed
!> (deflate, which every HDF5 reads): numbers of steps, what the sweep leaves as it is, points
!> without result. Such a column all but vanishes. The digits of different impacts do not repeat:
!> deflate takes a quarter off, in a time in which a tenth of them is solved, on one core, whatever
!> the number of threads and ranks.
!>
!> HDF5 builds the file in memory and `vcor_io_file` writes it, so that a full disk is none of
!> HDF5's business: it keeps a file that cannot be closed, and complains when the program ends.
!> Objects hold no times: the same tables give the same bytes.
module vcor_io_hdf5
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_f_pointer, c_int, &
      & c_int64_t, c_loc, c_null_char, c_null_ptr, c_ptr
   use h5ds, only : h5dsattach_scale_f, h5dsset_scale_f
   use hdf5, only : h5aclose_f, h5acreate_f, h5awrite_f, h5dclose_f, h5dcreate_f, &
      & h5dget_space_f, h5dwrite_f, &
      & h5f_acc_trunc_f, h5f_close_strong_f, h5f_scope_global_f, h5fclose_f, h5fcreate_f, &
      & h5fflush_f, h5fget_file_image_f, h5gclose_f, h5gcreate_f, &
      & h5p_crt_order_indexed_f, h5p_crt_order_tracked_f, h5p_dataset_create_f, &
      & h5p_file_access_f, h5p_file_create_f, h5p_group_create_f, h5pclose_f, h5pcopy_f, &
      & h5pcreate_f, h5pset_chunk_f, h5pset_deflate_f, h5pset_fapl_core_f, &
      & h5pset_fclose_degree_f, h5pset_link_creation_order_f, h5pset_obj_track_times_f, &
      & h5pset_shuffle_f, h5s_scalar_f, h5s_select_set_f, h5sclose_f, h5screate_f, &
      & h5screate_simple_f, h5sselect_hyperslab_f, &
      & h5t_cset_utf8_f, h5t_ieee_f64le, h5t_native_double, h5t_native_integer, &
      & h5t_std_i32le, h5t_string, h5tclose_f, h5tcopy_f, h5tset_cset_f, &
      & h5z_filter_deflate_f, h5zfilter_avail_f, hid_t, hsize_t, size_t
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_column, only : column_t, integer_column, real_column, text_value
   use vcor_io_file, only : write_file
   use vcor_io_hdf5_library, only : begin_hdf5, end_hdf5, handler_t
   use vcor_io_path, only : quoted_path
   use vcor_io_table, only : check_table, table_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: write_hdf5, remark_t, named_table_t

   !> Text that describes a file
   type :: remark_t
      !> Name of the attribute
      character(len=:), allocatable :: name
      !> Its value
      character(len=:), allocatable :: text
   end type remark_t

   !> A table and the name of its group
   type :: named_table_t
      !> Name of the group
      character(len=:), allocatable :: name
      !> The table
      type(table_t) :: table
   end type named_table_t

   !> An identifier that stands for nothing
   integer(hid_t), parameter :: nothing = -1_hid_t
   !> Step by which the file grows in memory [bytes]
   integer(size_t), parameter :: growth = 65536_size_t
   !> Most numbers of a column that is stored as it is
   integer, parameter :: longest_plain = 50000
   !> Numbers that are compressed together; half a megabyte, which HDF5 holds in its cache
   integer, parameter :: chunk_length = 65536
   !> Texts that are handed to HDF5 at once
   integer, parameter :: texts_at_once = 65536
   !> How hard to compress: more makes the file 1 % smaller still
   integer, parameter :: compression = 1
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

   !> Write the summary and, if there are, the history and further tables to a file
   !>
   !> The file is there as a whole or, if that fails, as it was before.
   subroutine write_hdf5(filename, summary, history, error, remarks, plain, more)
      !> Name of the file; replaced if it is there
      character(len=*), intent(in) :: filename
      !> A row per impact; its version, title and case describe the file
      type(table_t), intent(in) :: summary
      !> A row per time
      type(table_t), intent(in), optional :: history
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      !> More that describes the file, shape (n)
      type(remark_t), intent(in), optional :: remarks(:)
      !> Whether all numbers are to be stored as they are, in one piece: false if it is not given
      logical, intent(in), optional :: plain
      !> Further tables, each with its name
      type(named_table_t), intent(in), optional :: more(:)
      type(writer_t) :: writer
      type(handler_t) :: handler
      integer :: i

      call check_table(summary, error)
      if (allocated(error)) return
      if (present(history)) call check_table(history, error)
      if (allocated(error)) return
      if (present(more)) then
         do i = 1, size(more)
            call check_table(more(i)%table, error)
            if (allocated(error)) return
         end do
      end if

      call begin_hdf5(handler, writer%fault)
      if (.not. allocated(writer%fault)) then
         if (present(plain)) writer%is_plain = plain
         call build(writer, summary, history, remarks, more)
         call write_image(writer, filename, error)
         call close_all(writer)
         call end_hdf5(handler)
      end if

      if (allocated(writer%fault) .and. .not. allocated(error)) call raise(error, error_file, &
         & "cannot write "//quoted_path(filename)//": HDF5 cannot "//writer%fault)
   end subroutine write_hdf5

   !> Build the file in memory
   subroutine build(writer, summary, history, remarks, more)
      !> Writer, nothing open yet
      type(writer_t), intent(inout) :: writer
      !> A row per impact
      type(table_t), intent(in) :: summary
      !> A row per time
      type(table_t), intent(in), optional :: history
      !> More that describes the file
      type(remark_t), intent(in), optional :: remarks(:)
      !> Further tables
      type(named_table_t), intent(in), optional :: more(:)
      integer :: i, status

      call prepare(writer)
      if (allocated(writer%fault)) return
      call h5fcreate_f(no_path, h5f_acc_trunc_f, writer%file, status, &
         & writer%file_creation, writer%file_access)
      call note(writer, status, "create a file in memory")
      call put_attribute(writer, writer%file, "program", "vcor")
      call put_attribute(writer, writer%file, "version", summary%version)
      call put_attribute(writer, writer%file, "title", summary%title)
      call put_attribute(writer, writer%file, "case", summary%case_text)
      if (present(remarks)) then
         do i = 1, size(remarks)
            call put_attribute(writer, writer%file, remarks(i)%name, remarks(i)%text)
         end do
      end if
      call put_table(writer, "summary", summary)
      if (present(history)) call put_table(writer, "history", history)
      if (present(more)) then
         do i = 1, size(more)
            call put_table(writer, more(i)%name, more(i)%table)
         end do
      end if
   end subroutine build

   !> Make the property lists and types that all objects share
   subroutine prepare(writer)
      !> Writer
      type(writer_t), intent(inout) :: writer
      integer :: order, status

      order = ior(h5p_crt_order_tracked_f, h5p_crt_order_indexed_f)

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
      ! What is still open after a failure goes with the file
      call h5pset_fclose_degree_f(writer%file_access, h5f_close_strong_f, status)
      call note(writer, status, "keep a file in memory")

      call h5zfilter_avail_f(h5z_filter_deflate_f, writer%compresses, status)
      call note(writer, status, "say whether it can compress")

      call h5tcopy_f(h5t_string, writer%text_type, status)
      call note(writer, status, "make a type for text")
      call h5tset_cset_f(writer%text_type, h5t_cset_utf8_f, status)
      call note(writer, status, "make a type for text")
   end subroutine prepare

   !> Write a table as a group
   subroutine put_table(writer, name, table)
      !> Writer with a file
      type(writer_t), intent(inout) :: writer
      !> Name of the group
      character(len=*), intent(in) :: name
      !> Table to write
      type(table_t), intent(in) :: table
      integer(hid_t) :: dataset, group
      integer(hid_t) :: scales(table%dimension_count)
      integer :: i, j, lengths(table%dimension_count), status

      if (allocated(writer%fault)) return
      call h5gcreate_f(writer%file, name, group, status, gcpl_id=writer%group_creation)
      call note(writer, status, "create the group '"//name//"'")
      if (allocated(writer%fault)) return
      do i = 1, table%fact_count
         associate (fact => table%facts(i))
            call put_number(writer, group, fact%name, fact%value)
            call put_attribute(writer, group, fact%name//"_units", fact%unit)
         end associate
      end do

      scales = nothing
      do i = 1, table%dimension_count
         associate (coordinate => table%dimensions(i)%coordinate)
            lengths(i) = coordinate%length
            call put_column(writer, group, coordinate, lengths(i:i), scales(i))
            if (allocated(writer%fault)) exit
            call h5dsset_scale_f(scales(i), status, link_name(coordinate%name))
            call note(writer, status, "make '"//coordinate%name//"' a dimension scale")
         end associate
      end do

      do j = 1, table%column_count
         call put_column(writer, group, table%columns(j), lengths, dataset)
         if (allocated(writer%fault)) exit
         do i = 1, table%dimension_count
            ! Numbers here count as in C but from 1: the slowest dimension first
            call h5dsattach_scale_f(dataset, scales(i), i, status)
            call note(writer, status, "attach a dimension to '"//table%columns(j)%name//"'")
         end do
         call h5dclose_f(dataset, status)
         call note(writer, status, "close '"//table%columns(j)%name//"'")
      end do

      do i = 1, table%dimension_count
         if (scales(i) == nothing) cycle
         call h5dclose_f(scales(i), status)
         call note(writer, status, "close a dimension scale")
      end do
      call h5gclose_f(group, status)
      call note(writer, status, "close the group '"//name//"'")
   end subroutine put_table

   !> Write a column as a dataset and leave it open
   subroutine put_column(writer, group, column, lengths, dataset)
      !> Writer with a file
      type(writer_t), intent(inout) :: writer
      !> Group to write to
      integer(hid_t), intent(in) :: group
      !> Column to write
      type(column_t), intent(in), target :: column
      !> Lengths of its dimensions, the slowest first
      integer, intent(in) :: lengths(:)
      !> The dataset, open
      integer(hid_t), intent(out) :: dataset
      integer(hid_t) :: creation, file_type, memory_type, space
      integer(hsize_t) :: backwards(size(lengths))
      integer :: status

      dataset = nothing
      if (allocated(writer%fault)) return
      select case (column%kind)
      case (real_column)
         file_type = h5t_ieee_f64le
         memory_type = h5t_native_double
      case (integer_column)
         file_type = h5t_std_i32le
         memory_type = h5t_native_integer
      case default
         file_type = writer%text_type
         memory_type = writer%text_type
      end select

      backwards = int(lengths(size(lengths):1:-1), hsize_t)
      call h5screate_simple_f(size(lengths), backwards, space, status)
      call note(writer, status, "make the dimensions of '"//column%name//"'")
      if (allocated(writer%fault)) return
      creation = writer%dataset_creation
      if (writer%compresses .and. .not. writer%is_plain) then
         if (pays(column)) call prepare_compression(writer, backwards, creation)
      end if
      call h5dcreate_f(group, link_name(column%name), file_type, space, dataset, status, &
         & dcpl_id=creation)
      call note(writer, status, "create '"//column%name//"'")
      if (creation /= writer%dataset_creation) call close_list(writer, creation)
      call h5sclose_f(space, status)
      call note(writer, status, "close the dimensions of '"//column%name//"'")
      if (allocated(writer%fault)) return

      ! An array without elements has no address
      if (column%length > 0) then
         select case (column%kind)
         case (real_column)
            call h5dwrite_f(dataset, memory_type, c_loc(column%reals), status)
         case (integer_column)
            call h5dwrite_f(dataset, memory_type, c_loc(column%integers), status)
         case default
            call write_texts(column, backwards, dataset, memory_type, status)
         end select
         call note(writer, status, "write '"//column%name//"'")
      end if
      if (len(column%unit) > 0) call put_attribute(writer, dataset, "units", column%unit)
      call put_attribute(writer, dataset, "long_name", column%long_name)
   end subroutine put_column

   !> Whether a column is worth to be compressed: it is long, and most of its values repeat the one
   !> before
   pure function pays(column)
      !> The column
      type(column_t), intent(in) :: column
      !> Whether it is
      logical :: pays
      integer(c_int64_t), parameter :: bits = 0_c_int64_t
      integer :: i, n, repeated

      pays = .false.
      n = column%length
      if (n <= longest_plain) return
      repeated = 0
      select case (column%kind)
      case (real_column)
         ! as bits: NaN is not equal to itself
         do i = 2, n
            if (transfer(column%reals(i), bits) == transfer(column%reals(i-1), bits)) &
               & repeated = repeated + 1
         end do
      case (integer_column)
         repeated = count(column%integers(2:) == column%integers(:n-1))
      case default
         continue
      end select
      pays = repeated > n/2
   end function pays

   !> How to create a dataset that is compressed. (Text is not: HDF5 keeps it apart from the
   !> dataset.)
   subroutine prepare_compression(writer, lengths, creation)
      !> Writer
      type(writer_t), intent(inout) :: writer
      !> Lengths of the dimensions, the fastest first
      integer(hsize_t), intent(in) :: lengths(:)
      !> Property list, to be closed; the common one is its model
      integer(hid_t), intent(inout) :: creation
      integer(hsize_t) :: chunk(size(lengths))
      integer :: i, status

      ! The fastest dimensions as a whole, as far as they fit in
      do i = 1, size(chunk)
         chunk(i) = min(lengths(i), max(1_hsize_t, chunk_length/product(chunk(:i-1))))
      end do
      call h5pcopy_f(writer%dataset_creation, creation, status)
      call note(writer, status, "make a property list")
      call h5pset_chunk_f(creation, size(chunk), chunk, status)
      call note(writer, status, "cut a dataset into chunks")
      call h5pset_shuffle_f(creation, status)
      call note(writer, status, "order bytes for compression")
      call h5pset_deflate_f(creation, compression, status)
      call note(writer, status, "compress")
   end subroutine prepare_compression

   !> Write the values of a text column, some at a time: HDF5 wants an address for each
   subroutine write_texts(column, lengths, dataset, memory_type, status)
      !> Text column
      type(column_t), intent(in) :: column
      !> Lengths of its dimensions, the fastest first
      integer(hsize_t), intent(in) :: lengths(:)
      !> Dataset to write to
      integer(hid_t), intent(in) :: dataset
      !> Type of text
      integer(hid_t), intent(in) :: memory_type
      !> Negative on failure
      integer, intent(out) :: status
      character(len=column%width+1, kind=c_char), allocatable, target :: texts(:)
      type(c_ptr), allocatable, target :: places(:)
      integer(hid_t) :: file_space, memory_space
      integer(hsize_t) :: start(size(lengths)), part(size(lengths)), counted(1)
      integer :: first, ignored, i, n, rows

      ! whole rows of the slowest dimension
      n = size(lengths)
      rows = int(product(lengths(:n-1)))
      part = lengths
      part(n) = min(lengths(n), max(1_hsize_t, int(texts_at_once/max(rows, 1), hsize_t)))
      allocate(texts(product(part)), places(product(part)))
      start = 0_hsize_t
      call h5dget_space_f(dataset, file_space, status)
      do while (status >= 0 .and. start(n) < lengths(n))
         part(n) = min(part(n), lengths(n) - start(n))
         first = int(start(n))*rows
         do i = 1, int(product(part))
            texts(i) = column%texts((first + i - 1)*column%width + 1:(first + i)*column%width)
            texts(i)(len_trim(texts(i))+1:len_trim(texts(i))+1) = c_null_char
            places(i) = c_loc(texts(i))
         end do
         counted = product(part)
         call h5screate_simple_f(1, counted, memory_space, status)
         if (status >= 0) &
            & call h5sselect_hyperslab_f(file_space, h5s_select_set_f, start, part, status)
         if (status >= 0) call h5dwrite_f(dataset, memory_type, c_loc(places), status, &
            & memory_space, file_space)
         call h5sclose_f(memory_space, ignored)
         start(n) = start(n) + part(n)
      end do
      call h5sclose_f(file_space, ignored)
   end subroutine write_texts

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

   !> Write the bytes of the file, from where HDF5 has them: a copy would double the memory
   subroutine write_image(writer, filename, error)
      !> Writer with a file
      type(writer_t), intent(inout) :: writer
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
      call write_bytes(length, bytes, writer, filename, error)
   end subroutine write_image

   !> Write bytes as one text
   subroutine write_bytes(length, bytes, writer, filename, error)
      !> Number of bytes
      integer(size_t), intent(in) :: length
      !> The bytes
      character(len=length), intent(in) :: bytes(1)
      !> Writer
      type(writer_t), intent(inout) :: writer
      !> Name of the file; replaced if it is there
      character(len=*), intent(in) :: filename
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      if (bytes(1)(:len(signature)) == signature) then
         call write_file(filename, bytes(1), error)
      else
         call note(writer, -1, "give the bytes of the file")
      end if
   end subroutine write_bytes

   !> Close whatever is open
   subroutine close_all(writer)
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
   end subroutine close_all

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

   !> A name as HDF5 may take it
   pure function link_name(name) result(link)
      !> Name of a column
      character(len=*), intent(in) :: name
      !> The name without slashes, which would name groups
      character(len=len(name)) :: link
      integer :: i

      link = name
      do i = 1, len(link)
         if (link(i:i) == "/") link(i:i) = "_"
      end do
   end function link_name

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

end module vcor_io_hdf5
