!> Tables as text: files of comma-separated values (RFC 4180, lines end with LF), and bare values
!> for scripts
!>
!>     # vcor 1.0.0
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
   use vcor_error, only : error_t
   use vcor_io_file, only : commit, create_file, output_file_t, put, write_stdout
   use vcor_io_number, only : decimal_t, decimal_text, longest_integer, longest_real, new_decimal, &
      put_integer, put_real
   use vcor_io_table, only : column_t, coordinate_row, integer_column, real_column, &
      row_count, table_t
   use vcor_text, only : buffer_t
   implicit none
   private

   public :: write_csv, write_rows

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
   subroutine write_csv(filename, table, error, threads)
      !> Name of the file; replaced if it is there
      character(len=*), intent(in) :: filename
      type(table_t), intent(in) :: table
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      !> Threads that turn numbers into text; one where this is absent
      integer, intent(in), optional :: threads

      type(output_file_t) :: file
      integer :: i

      call create_file(file, filename, error)
      if (.not. allocated(error)) call put(file, head_of(table), error)
      if (.not. allocated(error)) call put_rows(table, pack([(i, i=1, size(table%dimensions) &
         + size(table%columns))], [.not. table%dimensions%is_index, &
         (.true., i=1, size(table%columns))]), ',', error, file, threads)
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

      call put_rows(table, places, ' ', error)
   end subroutine write_rows

   !> Write rows: threads turn some of them into text at a time, and write it in their order
   subroutine put_rows(table, places, separator, error, file, threads)
      type(table_t), intent(in) :: table
      !> Places of dimensions and columns, shape (n), n > 0
      integer, intent(in) :: places(:)
      !> What stands between values; where it is a comma text stands between quotation marks if need
      !> be
      character, intent(in) :: separator
      !> Set if they could not be written; the file is discarded then
      type(error_t), allocatable, intent(out) :: error
      !> Open file; the standard output where this is absent
      type(output_file_t), intent(inout), optional :: file
      !> Threads that turn numbers into text; one where this is absent
      integer, intent(in), optional :: threads

      ! a few milliseconds: long against what threads wait for each other
      integer, parameter :: some = 2048
      integer :: n, rows, team

      n = size(table%dimensions)
      rows = row_count(table)
      team = 1
      if (present(threads)) team = min(threads, rows/some + 1)
!$omp parallel default(none) num_threads(team) &
!$omp shared(table, places, separator, error, file, n, rows)
      block
         type(text_block_t) :: lines
         integer :: first, i, row

         call new_block(lines, table, places, some)
!$omp do ordered schedule(static, 1)
         do first = 1, rows, some
            lines%last = 0
            do row = first, min(rows, first + some - 1)
               do i = 1, size(places)
                  if (places(i) > n) then
                     call put_value(lines, table%columns(places(i) - n), row, separator)
                  else
                     call put_value(lines, table%dimensions(places(i)), &
                        coordinate_row(table, places(i), row), separator)
                  end if
               end do
               ! the line ends in place of the last separator
               lines%text(lines%last:lines%last) = c_new_line
            end do
!$omp ordered
            if (.not. allocated(error) .and. present(file)) &
               call put(file, lines%text(:lines%last), error)
            if (.not. allocated(error) .and. .not. present(file)) &
               call write_stdout(lines%text(:lines%last), error)
!$omp end ordered
         end do
!$omp end do
      end block
!$omp end parallel
   end subroutine put_rows

   !> Make room for a block of text
   pure subroutine new_block(block, table, places, rows)
      type(text_block_t), intent(out) :: block
      !> Table whose rows it is for
      type(table_t), intent(in) :: table
      !> Places of the values in a row
      integer, intent(in) :: places(:)
      integer, intent(in) :: rows

      integer :: width

      width = max(0, maxval(table%dimensions%width), maxval(table%columns%width))
      call new_decimal(block%decimal)
      ! each letter of a text may be a quotation mark, which is written twice
      allocate (character(len=rows*size(places)*max(longest_real + 1, longest_integer + 1, &
         2*width + 3)) :: block%text)
   end subroutine new_block

   !> Add one value and what stands behind it
   subroutine put_value(block, column, row, separator)
      !> Text with room for the value
      type(text_block_t), intent(inout) :: block
      type(column_t), intent(in) :: column
      integer, intent(in) :: row
      character, intent(in) :: separator

      select case (column%kind)
      case (real_column)
         call put_real(block%decimal, column%reals(row), block%text, block%last)
      case (integer_column)
         call put_integer(column%integers(row), block%text, block%last)
      case default
         associate (last => column%integers(row)*column%width)
            call put_field(column%texts(last - column%width + 1:last), separator == ',', &
               block%text, block%last)
         end associate
      end select
      block%last = block%last + 1
      block%text(block%last:block%last) = separator
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
            call add_comments(head, fact%name//' = '//decimal_text(fact%reals(1))//' '//fact%unit &
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

         character(len=2*len(column%name) + 2) :: name
         integer :: last

         last = 0
         call put_field(column%name, .true., name, last)
         names = names//','//name(:last)
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

   !> Add a text as a field of a row
   subroutine put_field(text, quotes, buffer, last)
      !> Any text; blanks at its end do not count
      character(len=*), intent(in) :: text
      !> Whether it stands between quotation marks if need be
      logical, intent(in) :: quotes
      !> Buffer with room for it
      character(len=*), intent(inout) :: buffer
      !> Last character in use, before and after
      integer, intent(inout) :: last

      integer :: i, n

      n = len_trim(text)
      ! An empty field might make an empty line, which readers skip
      if (.not. quotes .or. (n > 0 .and. index(text, ' ') /= 1 &
                             .and. scan(text, special) == 0)) then
         buffer(last + 1:last + n) = text(:n)
         last = last + n
         return
      end if
      call add('"')
      do i = 1, n
         if (text(i:i) == '"') call add('"')
         call add(text(i:i))
      end do
      call add('"')

   contains

      !> Add a letter
      subroutine add(letter)
         character, intent(in) :: letter

         last = last + 1
         buffer(last:last) = letter
      end subroutine add
   end subroutine put_field

end module vcor_io_csv
