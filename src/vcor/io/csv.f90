!> Tables as text files, comma-separated values (RFC 4180, lines end with LF)
!>
!>     # vcor 0.1.0
!>     # title: rubber ball on steel
!>     # columns:
!>     #   cor [1] coefficient of restitution
!>     # case:
!>     # &case
!>     ...
!>     cor,status
!>     6.9313750012345678e-01,separated
!>
!> All lines that begin with `#` come first, then one line with the names, then the rows. Taking the
!> first two characters of the lines after `# case:` away gives the case again. Numbers have 17
!> digits (`vcor_io_number`); text stands between quotation marks only if it has to.
!>
!> Numbers that hold for the table as a whole follow the title: `# contact_time = 1.3e-03 s, ...`.
!> The coordinates of a dimension are columns too, unless they are just numbers in a row.
module vcor_io_csv
   use, intrinsic :: iso_c_binding, only : c_carriage_return, c_new_line
   use vcor_error, only : error_t
   use vcor_io_column, only : column_t
   use vcor_io_csv_rows, only : field, new_row_writer, row_writer_t
   use vcor_io_file, only : commit, create_file, discard, output_file_t, put
   use vcor_io_number, only : real_text
   use vcor_io_table, only : check_table, row_count, table_t
   implicit none
   private

   public :: write_csv, csv_file_t, begin_csv, add_rows, share_rows, end_csv, discard_csv

   !> Rows that become text at once
   integer, parameter :: rows_per_block = 256
   !> Characters that are collected before they go to the file
   integer, parameter :: buffer_length = 65536

   !> A file with a buffer before it
   type :: writer_t
      !> The file
      type(output_file_t) :: file
      !> Text on its way to the file
      character(len=buffer_length) :: buffer
      !> Last character of the buffer in use
      integer :: last = 0
   end type writer_t

   !> A file that grows by rows
   type :: csv_file_t
      !> Whether it is begun and not ended
      logical :: is_open = .false.
      !> The file
      type(output_file_t), private :: file
   end type csv_file_t

contains

   !> Write a table to a file; the file is there as a whole or, if that fails, as it was before
   subroutine write_csv(filename, table, error, threads)
      !> Name of the file; replaced if it is there
      character(len=*), intent(in) :: filename
      !> Table to write
      type(table_t), intent(in) :: table
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      !> Number of threads; 1 if it is not given
      integer, intent(in), optional :: threads
      type(csv_file_t) :: file
      integer :: team

      team = 1
      if (present(threads)) team = threads
      call begin_csv(file, filename, table, error)
      if (allocated(error)) return
      call add_rows(file, table, 1, row_count(table), team, error)
      if (allocated(error)) return
      call end_csv(file, error)
   end subroutine write_csv

   !> Begin a file: what describes the table. Nothing is seen under its name before its end
   subroutine begin_csv(file, filename, table, error)
      !> The file
      type(csv_file_t), intent(out) :: file
      !> Its name; replaced if it is there
      character(len=*), intent(in) :: filename
      !> Table to write
      type(table_t), intent(in) :: table
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(writer_t), allocatable :: writer

      call check_table(table, error)
      if (allocated(error)) return
      ! Not on the stack, for the sake of its buffer
      allocate(writer)
      call create_file(writer%file, filename, error)
      if (allocated(error)) return
      call put_head(writer, table, error)
      if (allocated(error)) return
      call flush_buffer(writer, error)
      if (allocated(error)) return
      file%file = writer%file
      file%is_open = .true.
   end subroutine begin_csv

   !> Add rows: blocks of them become text by several threads, and go to the file in order
   subroutine add_rows(file, table, first, last, threads, error)
      !> The file, begun; discarded on failure
      type(csv_file_t), intent(inout) :: file
      !> Table to write
      type(table_t), intent(in) :: table
      !> First row
      integer, intent(in) :: first
      !> Last row
      integer, intent(in) :: last
      !> Number of threads
      integer, intent(in) :: threads
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      integer :: team

      team = max(1, min(threads, (last - first)/rows_per_block + 1))
!$omp parallel default(none) shared(file, table, error, first, last) num_threads(team)
      call share_rows(file, table, first, last, error)
!$omp end parallel
   end subroutine add_rows

   !> The same, called by all threads of a team, with the same arguments; a thread that has other
   !> things to do may come late
   subroutine share_rows(file, table, first, last, error)
      !> The file, begun; discarded on failure
      type(csv_file_t), intent(inout) :: file
      !> Table to write
      type(table_t), intent(in) :: table
      !> First row
      integer, intent(in) :: first
      !> Last row
      integer, intent(in) :: last
      !> Unallocated before; set if the file could not be written
      type(error_t), allocatable, intent(inout) :: error
      type(row_writer_t) :: rows
      integer :: start

      call new_row_writer(rows, table)
!$omp do schedule(dynamic) ordered
      do start = first, last, rows_per_block
         call rows%take(start, min(start + rows_per_block - 1, last), table)
!$omp ordered
         if (.not. allocated(error)) call put(file%file, rows%text(:rows%last), error)
         if (allocated(error)) file%is_open = .false.
!$omp end ordered
      end do
!$omp end do
   end subroutine share_rows

   !> End a file: it gets its name
   subroutine end_csv(file, error)
      !> The file, begun; closed afterwards
      type(csv_file_t), intent(inout) :: file
      !> Set if the file is not complete; then it is discarded
      type(error_t), allocatable, intent(out) :: error

      file%is_open = .false.
      call commit(file%file, error)
   end subroutine end_csv

   !> Give a file up; none is fine
   subroutine discard_csv(file)
      !> The file
      type(csv_file_t), intent(inout) :: file

      if (file%is_open) call discard(file%file)
      file%is_open = .false.
   end subroutine discard_csv

   !> Write what describes the table, and the line of the names
   subroutine put_head(writer, table, error)
      !> Open file
      type(writer_t), intent(inout) :: writer
      !> Table to write
      type(table_t), intent(in) :: table
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      integer :: i
      logical :: first

      call put_comments(writer, "vcor "//table%version, error)
      if (allocated(error)) return
      call put_comments(writer, "title: "//table%title, error)
      if (allocated(error)) return
      do i = 1, table%fact_count
         associate (fact => table%facts(i))
            call put_comments(writer, fact%name//" = "//real_text(fact%value)//" "//fact%unit &
               & //", "//fact%long_name, error)
         end associate
         if (allocated(error)) return
      end do
      call put_comments(writer, "columns:", error)
      if (allocated(error)) return
      do i = 1, table%dimension_count
         if (table%dimensions(i)%is_index) cycle
         call put_description(writer, table%dimensions(i)%coordinate, error)
         if (allocated(error)) return
      end do
      do i = 1, table%column_count
         call put_description(writer, table%columns(i), error)
         if (allocated(error)) return
      end do
      call put_comments(writer, "case:", error)
      if (allocated(error)) return
      call put_comments(writer, table%case_text, error)
      if (allocated(error)) return

      first = .true.
      do i = 1, table%dimension_count
         if (table%dimensions(i)%is_index) cycle
         call put_name(writer, table%dimensions(i)%coordinate%name, first, error)
         if (allocated(error)) return
      end do
      do i = 1, table%column_count
         call put_name(writer, table%columns(i)%name, first, error)
         if (allocated(error)) return
      end do
      call put_text(writer, c_new_line, error)
   end subroutine put_head

   !> Write one line that says what a column is
   subroutine put_description(writer, column, error)
      !> Open file
      type(writer_t), intent(inout) :: writer
      !> Column to describe
      type(column_t), intent(in) :: column
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      if (len(column%unit) == 0) then
         call put_comments(writer, "  "//column%name//" "//column%long_name, error)
      else
         call put_comments(writer, &
            & "  "//column%name//" ["//column%unit//"] "//column%long_name, error)
      end if
   end subroutine put_description

   !> Write a text as comment, each of its lines after `# `
   subroutine put_comments(writer, text, error)
      !> Open file
      type(writer_t), intent(inout) :: writer
      !> Any number of lines; the end of the last one may be missing
      character(len=*), intent(in) :: text
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      integer :: end_of_line, first, next

      first = 1
      do while (first <= len(text))
         ! A carriage return ends a line for most readers, with or without a line feed: what comes
         ! after it would be taken for data
         end_of_line = scan(text(first:), c_new_line//c_carriage_return) + first - 1
         if (end_of_line < first) end_of_line = len(text) + 1
         next = end_of_line + 1
         if (next <= len(text)) then
            if (text(next-1:next) == c_carriage_return//c_new_line) next = next + 1
         end if
         call put_text(writer, "# "//text(first:end_of_line-1)//c_new_line, error)
         if (allocated(error)) return
         first = next
      end do
   end subroutine put_comments

   !> Write the name of a column
   subroutine put_name(writer, name, first, error)
      !> Open file
      type(writer_t), intent(inout) :: writer
      !> Name
      character(len=*), intent(in) :: name
      !> Whether it is the first of the line; false afterwards
      logical, intent(inout) :: first
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      if (.not. first) call put_text(writer, ",", error)
      if (allocated(error)) return
      first = .false.
      call put_text(writer, field(name), error)
   end subroutine put_name

   !> Write text through the buffer
   subroutine put_text(writer, text, error)
      !> Open file; discarded on failure
      type(writer_t), intent(inout) :: writer
      !> Text to write
      character(len=*), intent(in) :: text
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      if (writer%last + len(text) > buffer_length) then
         call flush_buffer(writer, error)
         if (allocated(error)) return
      end if
      if (len(text) > buffer_length) then
         call put(writer%file, text, error)
      else
         writer%buffer(writer%last+1:writer%last+len(text)) = text
         writer%last = writer%last + len(text)
      end if
   end subroutine put_text

   !> Hand the buffer to the file
   subroutine flush_buffer(writer, error)
      !> Open file; discarded on failure
      type(writer_t), intent(inout) :: writer
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      call put(writer%file, writer%buffer(:writer%last), error)
      writer%last = 0
   end subroutine flush_buffer

end module vcor_io_csv
