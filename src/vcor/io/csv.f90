!> Tables as text: files of comma-separated values (RFC 4180, but lines end with LF), and plain
!> values for scripts
!>
!>     # vcor 2.0.0
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
!> Lines that begin with `#` come first, then one line with the names, then the rows. The lines
!> after `# case:` without their first two characters are the case. Numbers have 17 digits
!> (`vcor_io_number`); texts are quoted only if necessary. Coordinates of a dimension are a column
!> too, unless they are the numbers 1, 2, 3 ...
module vcor_io_csv
   use, intrinsic :: iso_c_binding, only : c_carriage_return, c_new_line
   use vcor_error, only : error_t
   use vcor_io_file, only : commit, create_file, output_file_t, put, write_stdout
   use vcor_io_number, only : decimal_t, longest_integer, longest_real, new_decimal, &
      put_integer, put_real
   use vcor_io_table, only : column_t, coordinate_row, integer_column, real_column, &
      row_count, table_t
   use vcor_number, only : real_text
   use vcor_text, only : buffer_t
   implicit none
   private

   public :: write_csv, write_rows

   !> Characters for which a text must be quoted; `#` begins a comment for most readers
   character(len=*), parameter :: special = '",#'//c_new_line//c_carriage_return

   !> A block of text to be written
   type :: text_block_t
      !> Room for the text
      character(len=:), allocatable :: text
      !> Last character in use
      integer :: last = 0
      !> Powers of ten for the numbers
      type(decimal_t) :: decimal
   end type text_block_t

contains

   !> Write a table to a file, which appears complete or, on failure, stays as it was
   subroutine write_csv(filename, table, error, threads)
      !> Name of the file; an existing one is replaced
      character(len=*), intent(in) :: filename
      type(table_t), intent(in) :: table
      !> Set if the file could not be written
      type(error_t), allocatable, intent(out) :: error
      !> Threads that convert numbers to text; absent: 1
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

   !> Write some dimensions and columns of all rows to standard output, a line per row, values
   !> separated by blanks
   subroutine write_rows(table, places, error)
      type(table_t), intent(in) :: table
      !> Places of dimensions and columns (`place_in_table`) in order of output, shape (n), n > 0
      integer, intent(in) :: places(:)
      !> Set if they could not be written
      type(error_t), allocatable, intent(out) :: error

      call put_rows(table, places, ' ', error)
   end subroutine write_rows

   !> Write rows: each thread converts a block of rows, and the blocks are written in order
   subroutine put_rows(table, places, separator, error, file, threads)
      type(table_t), intent(in) :: table
      !> Places of dimensions and columns, shape (n), n > 0
      integer, intent(in) :: places(:)
      !> Separator of values; if it is a comma, texts are quoted if necessary
      character, intent(in) :: separator
      !> Set if they could not be written; the file is discarded then
      type(error_t), allocatable, intent(out) :: error
      !> Open file; absent: standard output
      type(output_file_t), intent(inout), optional :: file
      !> Threads that convert numbers to text; absent: 1
      integer, intent(in), optional :: threads

      ! rows of a block: a few milliseconds, long against the time that threads wait
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
               ! the end of the line replaces the last separator
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

   !> Allocate a block of text
   pure subroutine new_block(block, table, places, rows)
      type(text_block_t), intent(out) :: block
      !> Table of the rows
      type(table_t), intent(in) :: table
      !> Places of the values of a row
      integer, intent(in) :: places(:)
      integer, intent(in) :: rows

      integer :: width

      width = max(0, maxval(table%dimensions%width), maxval(table%columns%width))
      call new_decimal(block%decimal)
      ! each character of a text may be a quotation mark, which is doubled
      allocate (character(len=rows*size(places)*max(longest_real + 1, longest_integer + 1, &
         2*width + 3)) :: block%text)
   end subroutine new_block

   !> Add a value and a separator
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

   !> The comments before a table, and the line of names
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
            call add_comments(head, fact%name//' = '//real_text(fact%reals(1))//' '//fact%unit &
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

      !> Add the comment of a column, and its name
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

   !> Add a text as a comment, each line after `# `
   subroutine add_comments(head, text)
      !> Text to add to
      type(buffer_t), intent(inout) :: head
      !> Any number of lines; the last one needs no line end
      character(len=*), intent(in) :: text

      integer :: first, last

      first = 1
      do while (first <= len(text))
         ! For most readers a carriage return ends a line, with or without a line feed: they would
         ! read the text after it as data
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
      !> Any text; trailing blanks are ignored
      character(len=*), intent(in) :: text
      !> Whether to quote the text if necessary
      logical, intent(in) :: quotes
      !> Buffer with room for it
      character(len=*), intent(inout) :: buffer
      !> Last character in use, before and after
      integer, intent(inout) :: last

      integer :: i, n

      n = len_trim(text)
      ! quote an empty field: it might make an empty line, which readers skip
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
