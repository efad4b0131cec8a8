!> Tables as text: files of comma-separated values (RFC 4180, lines end with LF), and bare values
!> for scripts
!>
!>     # vcor 0.1.0
!>     # title: rubber ball on steel
!>     # contact_time = 1.3000000000000000e-03 s, contact time t0 of the impact
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
!> digits (`vcor_io_number`); text stands between quotation marks only if it has to. The coordinates
!> of a dimension are columns too, unless they are just numbers in a row.
module vcor_io_csv
   use, intrinsic :: iso_c_binding, only : c_carriage_return, c_new_line
   use vcor_buffer, only : buffer_t
   use vcor_error, only : error_t
   use vcor_io_file, only : commit, create_file, output_file_t, put, write_stdout
   use vcor_io_number, only : decimal_t, decimal_text, longest_integer, longest_real, new_decimal, &
      put_integer, put_real
   use vcor_io_table, only : check_table, column_t, coordinate_row, integer_column, real_column, &
      row_count, table_t, text_value
   implicit none
   private

   public :: write_csv, write_rows

   !> Characters that are collected before they are written
   integer, parameter :: block_length = 65536
   !> What makes quotation marks necessary; `#` begins a comment for most readers
   character(len=*), parameter :: special = '",#'//c_new_line//c_carriage_return

   !> Text on its way out
   type :: text_block_t
      !> Room for the text
      character(len=:), allocatable :: text
      !> Last character in use
      integer :: last = 0
      !> Powers of ten for the numbers
      type(decimal_t) :: decimal
   end type text_block_t

contains

   !> Write a table to a file; the file is there as a whole or, if that fails, as it was before
   subroutine write_csv(filename, table, error)
      !> Name of the file; replaced if it is there
      character(len=*), intent(in) :: filename
      !> Table to write
      type(table_t), intent(in) :: table
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error

      type(output_file_t) :: file
      type(text_block_t), allocatable :: block
      integer :: i, row

      call check_table(table, error)
      if (.not. allocated(error)) call create_file(file, filename, error)
      if (.not. allocated(error)) call put(file, head_of(table), error)
      if (allocated(error)) return
      call new_block(block, table)
      do row = 1, row_count(table)
         do i = 1, size(table%dimensions)
            if (table%dimensions(i)%is_index) cycle
            call put_value(block, table%dimensions(i), coordinate_row(table, i, row), ',', .true.)
         end do
         do i = 1, size(table%columns)
            call put_value(block, table%columns(i), row, ',', .true.)
         end do
         ! the line ends in place of the last comma
         block%text(block%last:block%last) = c_new_line
         if (block%last < block_length) cycle
         call put(file, block%text(:block%last), error)
         if (allocated(error)) return
         block%last = 0
      end do
      call put(file, block%text(:block%last), error)
      if (.not. allocated(error)) call commit(file, error)
   end subroutine write_csv

   !> Write some dimensions and columns of all rows to the standard output, a line per row with
   !> blanks between the values
   subroutine write_rows(table, places, error)
      type(table_t), intent(in) :: table
      !> Places of dimensions and columns (`place_in_table`), in their order, shape (n), n > 0
      integer, intent(in) :: places(:)
      !> Set if they could not be written
      type(error_t), allocatable, intent(out) :: error

      type(text_block_t), allocatable :: block
      integer :: i, row

      call new_block(block, table)
      do row = 1, row_count(table)
         do i = 1, size(places)
            associate (column => places(i) - size(table%dimensions))
               if (column > 0) then
                  call put_value(block, table%columns(column), row, ' ', .false.)
               else
                  call put_value(block, table%dimensions(places(i)), &
                     coordinate_row(table, places(i), row), ' ', .false.)
               end if
            end associate
         end do
         block%text(block%last:block%last) = c_new_line
         if (block%last < block_length) cycle
         call write_stdout(block%text(:block%last), error)
         if (allocated(error)) return
         block%last = 0
      end do
      call write_stdout(block%text(:block%last), error)
   end subroutine write_rows

   !> Make room for a block of text and one more row
   subroutine new_block(block, table)
      !> Block without text
      type(text_block_t), allocatable, intent(out) :: block
      !> Table whose rows it is for
      type(table_t), intent(in) :: table

      integer :: columns, width

      columns = size(table%dimensions) + size(table%columns)
      width = max(0, maxval(table%dimensions%width), maxval(table%columns%width))
      allocate (block)
      call new_decimal(block%decimal)
      ! each letter of a text may be a quotation mark, which is written twice
      allocate (character(len=block_length + columns*max(longest_real + 1, longest_integer + 1, &
         2*width + 3)) :: block%text)
   end subroutine new_block

   !> Add one value and what stands behind it
   subroutine put_value(block, column, row, separator, quotes)
      !> Text with room for the value
      type(text_block_t), intent(inout) :: block
      type(column_t), intent(in) :: column
      !> Number of the value
      integer, intent(in) :: row
      !> What stands behind it
      character, intent(in) :: separator
      !> Whether text stands between quotation marks where it has to
      logical, intent(in) :: quotes

      select case (column%kind)
      case (real_column)
         call put_real(block%decimal, column%reals(row), block%text, block%last)
      case (integer_column)
         call put_integer(column%integers(row), block%text, block%last)
      case default
         if (quotes) then
            call put_text(field(text_value(column, row)))
         else
            call put_text(text_value(column, row))
         end if
      end select
      call put_text(separator)

   contains

      !> Add text
      subroutine put_text(text)
         character(len=*), intent(in) :: text

         block%text(block%last + 1:block%last + len(text)) = text
         block%last = block%last + len(text)
      end subroutine put_text
   end subroutine put_value

   !> What describes a table, and the line of the names
   function head_of(table) result(text)
      type(table_t), intent(in) :: table
      character(len=:), allocatable :: text

      type(buffer_t) :: head
      character(len=:), allocatable :: names
      integer :: i

      call add_comments(head, 'vcor '//table%version)
      call add_comments(head, 'title: '//table%title)
      do i = 1, size(table%facts)
         associate (fact => table%facts(i))
            call add_comments(head, fact%name//' = '//decimal_text(fact%value)//' '//fact%unit &
               //', '//fact%long_name)
         end associate
      end do
      call add_comments(head, 'columns:')
      names = ''
      do i = 1, size(table%dimensions)
         if (.not. table%dimensions(i)%is_index) call add_column(table%dimensions(i))
      end do
      do i = 1, size(table%columns)
         call add_column(table%columns(i))
      end do
      call add_comments(head, 'case:')
      call add_comments(head, table%case_text)
      call head%add(names(2:)//c_new_line)
      text = head%text()

   contains

      !> Describe a column, and keep its name
      subroutine add_column(column)
         type(column_t), intent(in) :: column

         names = names//','//field(column%name)
         if (column%unit == '') then
            call add_comments(head, '  '//column%name//' '//column%long_name)
         else
            call add_comments(head, '  '//column%name//' ['//column%unit//'] '//column%long_name)
         end if
      end subroutine add_column
   end function head_of

   !> Add a text as comment, each of its lines after `# `
   subroutine add_comments(head, text)
      !> Text to add to
      type(buffer_t), intent(inout) :: head
      !> Any number of lines; the end of the last one may be missing
      character(len=*), intent(in) :: text

      integer :: first, last

      first = 1
      do while (first <= len(text))
         ! A carriage return ends a line for most readers, with or without a line feed: what comes
         ! after it would be taken for data
         last = scan(text(first:), c_new_line//c_carriage_return) + first - 2
         if (last < first - 1) last = len(text)
         call head%add('# '//text(first:last)//c_new_line)
         first = last + 2
         if (first > len(text)) exit
         if (text(last + 1:first) == c_carriage_return//c_new_line) first = first + 1
      end do
   end subroutine add_comments

   !> A text as a field of a row
   pure function field(text)
      !> Any text
      character(len=*), intent(in) :: text
      !> The text, between quotation marks if need be
      character(len=:), allocatable :: field

      integer :: i

      field = text
      ! An empty field might make an empty line, which readers skip
      if (text /= '' .and. index(text, ' ') /= 1 .and. scan(text, special) == 0) return
      field = '"'
      do i = 1, len(text)
         field = field//text(i:i)
         if (text(i:i) == '"') field = field//'"'
      end do
      field = field//'"'
   end function field

end module vcor_io_csv
