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
!> The same tables give the same bytes.
module vcor_io_hdf5
   use, intrinsic :: iso_c_binding, only : c_int64_t
   use h5ds, only : h5dsattach_scale_f, h5dsset_scale_f
   use hdf5, only : h5dclose_f, h5dget_storage_size_f, h5dopen_f, h5gclose_f, h5gcreate_f, hid_t, &
      & hsize_t
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_hdf5_column, only : link_name, put_column
   use vcor_io_hdf5_image, only : close_image, note, nothing, open_image, put_attribute, &
      & put_number, write_image, writer_t
   use vcor_io_file, only : commit, discard, output_file_t
   use vcor_io_hdf5_library, only : begin_hdf5, c_get_offset, end_hdf5, handler_t
   use vcor_io_path, only : quoted_path
   use vcor_io_table, only : check_table, table_t
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

contains

   !> Write the summary and, if there are, the history and further tables to a file
   !>
   !> The file is there as a whole or, if that fails, as it was before.
   subroutine write_hdf5(filename, summary, history, error, remarks, changing, more, file)
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
      !> Number of columns of the summary, the last ones, whose numbers will change where they are
      !> in the file; if it is given, all columns are stored as they are, in one piece
      integer, intent(in), optional :: changing
      !> Further tables, each with its name
      type(named_table_t), intent(in), optional :: more(:)
      !> The file, complete, to be given its name by `commit`: it gets it at once without this
      type(output_file_t), intent(out), optional :: file
      type(output_file_t) :: own
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
         writer%is_plain = present(changing)
         call build(writer, summary, history, remarks, more)
         if (present(changing)) call leave_out(writer, summary, changing)
         call write_image(writer, own, filename, error)
         call close_image(writer)
         call end_hdf5(handler)
      end if

      if (allocated(writer%fault) .and. .not. allocated(error)) then
         call discard(own)
         call raise(error, error_file, &
            & "cannot write "//quoted_path(filename)//": HDF5 cannot "//writer%fault)
      end if
      if (present(file)) then
         file = own
      else if (.not. allocated(error)) then
         call commit(own, error)
      end if
   end subroutine write_hdf5

   !> Columns of the summary that will change are no part of the seal
   subroutine leave_out(writer, summary, changing)
      !> Writer with a file
      type(writer_t), intent(inout) :: writer
      !> The summary
      type(table_t), intent(in) :: summary
      !> Number of these columns
      integer, intent(in) :: changing
      integer(hid_t) :: dataset
      integer(hsize_t) :: length
      integer(c_int64_t) :: offset
      integer :: i, place, status

      if (allocated(writer%fault)) return
      deallocate(writer%left_out)
      allocate(writer%left_out(2, changing))
      do i = 1, changing
         associate (name => summary%columns(summary%column_count - changing + i)%name)
            call h5dopen_f(writer%file, "summary/"//link_name(name), dataset, status)
            call note(writer, status, "open '"//name//"'")
            if (allocated(writer%fault)) return
            offset = c_get_offset(int(dataset, c_int64_t))
            call h5dget_storage_size_f(dataset, length, status)
            call note(writer, min(status, merge(0, -1, offset >= 0)), "find '"//name//"'")
            ! in ascending order: HDF5 may have them in another one
            place = 1 + count(writer%left_out(1, :i-1) < offset)
            writer%left_out(:, place+1:i) = writer%left_out(:, place:i-1)
            writer%left_out(:, place) = [offset, int(length, c_int64_t)]
            call h5dclose_f(dataset, status)
            call note(writer, status, "close '"//name//"'")
         end associate
      end do
   end subroutine leave_out

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
      integer :: i

      call open_image(writer)
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

end module vcor_io_hdf5
