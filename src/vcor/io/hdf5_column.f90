!> Columns of a table as datasets of an HDF5 file
!>
!> Columns of more than `longest_plain` numbers most of which repeat the one before are compressed
!> (deflate, which every HDF5 reads): numbers of steps, what the sweep leaves as it is, points
!> without result. Such a column all but vanishes. The digits of different impacts do not repeat:
!> deflate takes a quarter off, in a time in which a tenth of them is solved, on one core, whatever
!> the number of threads and ranks.
!>
!> Text HDF5 keeps one by one, apart from the dataset, and cannot compress. A column of nothing but
!> one text, as `status` is where all goes well, is not written at all: the text is its fill value,
!> and it reads as if it were.
module vcor_io_hdf5_column
   use, intrinsic :: iso_c_binding, only : c_char, c_int64_t, c_loc, c_null_char, c_ptr
   use hdf5, only : h5dcreate_f, h5dget_space_f, h5dwrite_f, h5pcopy_f, h5pset_chunk_f, &
      & h5pset_deflate_f, h5pset_fill_value_f, h5pset_shuffle_f, h5s_select_set_f, h5sclose_f, &
      & h5screate_simple_f, h5sselect_hyperslab_f, h5t_ieee_f64le, h5t_native_double, &
      & h5t_native_integer, h5t_std_i32le, hid_t, hsize_t
   use vcor_io_column, only : column_t, integer_column, real_column, text_column
   use vcor_io_hdf5_image, only : close_list, note, nothing, put_attribute, writer_t
   implicit none
   private

   public :: put_column, link_name

   !> Most numbers of a column that is stored as it is
   integer, parameter :: longest_plain = 50000
   !> Numbers that are compressed together; half a megabyte, which HDF5 holds in its cache
   integer, parameter :: chunk_length = 65536
   !> Texts that are handed to HDF5 at once
   integer, parameter :: texts_at_once = 65536
   !> How hard to compress: more makes the file 1 % smaller still
   integer, parameter :: compression = 1

contains

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
      logical :: is_filled

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
      is_filled = is_uniform(column)
      if (is_filled) call prepare_text(writer, column, creation)
      call h5dcreate_f(group, link_name(column%name), file_type, space, dataset, status, &
         & dcpl_id=creation)
      call note(writer, status, "create '"//column%name//"'")
      if (creation /= writer%dataset_creation) call close_list(writer, creation)
      call h5sclose_f(space, status)
      call note(writer, status, "close the dimensions of '"//column%name//"'")
      if (allocated(writer%fault)) return

      ! An array without elements has no address
      if (column%length > 0 .and. .not. is_filled) then
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

   !> Whether a column is nothing but one text, and long
   pure function is_uniform(column)
      !> The column
      type(column_t), intent(in) :: column
      !> Whether it is
      logical :: is_uniform
      integer :: i

      is_uniform = column%kind == text_column .and. column%length > longest_plain
      if (.not. is_uniform) return
      associate (width => column%width)
         do i = 2, column%length
            is_uniform = column%texts((i - 1)*width + 1:i*width) == column%texts(:width)
            if (.not. is_uniform) return
         end do
      end associate
   end function is_uniform

   !> How to create a dataset of nothing but one text
   subroutine prepare_text(writer, column, creation)
      !> Writer
      type(writer_t), intent(inout) :: writer
      !> Text column
      type(column_t), intent(in) :: column
      !> Property list, to be closed; the common one is its model
      integer(hid_t), intent(inout) :: creation
      character(len=column%width+1, kind=c_char), target :: text
      type(c_ptr), target :: place
      integer :: status

      call h5pcopy_f(writer%dataset_creation, creation, status)
      call note(writer, status, "make a property list")
      text = column%texts(:column%width)
      text(len_trim(text)+1:len_trim(text)+1) = c_null_char
      place = c_loc(text)
      call h5pset_fill_value_f(creation, writer%text_type, c_loc(place), status)
      call note(writer, status, "set a fill value")
   end subroutine prepare_text

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

end module vcor_io_hdf5_column
