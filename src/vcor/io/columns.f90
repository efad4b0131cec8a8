!> Columns of numbers in text files, as spreadsheets, other programs and people write them
!>
!> Columns are separated by commas, semicolons, tabs or blanks; in lines with tabs that begin with a
!> word, a name or unit, by tabs only. Any line ends are accepted, text after a # and a byte-order
!> mark are ignored. Numbers may have decimal commas if columns are separated by something else. A
!> line `sep=;` counts as blank.
module vcor_io_columns
   use vcor_kinds, only : wp
   use vcor_material_table, only : largest_value, smallest_value
   use vcor_number, only : looks_numeric, read_real, real_text
   use vcor_text, only : has_control, lower
   implicit none
   private

   public :: row_t, most_columns, decimals_t, lines_in, split, read_value, not_a_text

   character(len=*), parameter :: line_feed = achar(10), carriage_return = achar(13)
   character(len=*), parameter :: byte_order_mark = char(239)//char(187)//char(191)
   !> Blank characters
   character(len=*), parameter :: tab = achar(9), blanks = " "//tab

   !> Message about a file with decimal commas and points
   character(len=*), parameter :: mixed_decimals = "found both decimal commas and decimal points" &
         //", expected one of them in all lines"
   !> Message about a file that is no text
   character(len=*), parameter :: not_a_text = "found a control character, expected a text file " &
         //"(in ASCII or UTF-8)"

   !> Form of the numbers of a file
   type :: decimals_t
      !> Whether some have decimal commas
      logical :: commas = .false.
      !> Whether some have decimal points
      logical :: points = .false.
   end type decimals_t

   !> Largest number of columns of a file
   integer, parameter :: most_columns = 64

   !> A text, read line by line
   type :: row_t
      !> Number of the line, 0 before the first one is taken
      integer :: line = 0
      !> False after the last line; `line` remains its number
      logical :: is_there = .true.
      !> The line without its end and without text after a #, decimal commas replaced by points
      character(len=:), allocatable :: content
      !> Text after the #
      character(len=:), allocatable :: comment
      !> Number of its columns, 0 in a blank line
      integer :: columns = 0
      !> Form of the numbers in this line, and in all lines checked so far
      type(decimals_t) :: here, so_far
      !> Start of the next line; first and last character of each column of this one
      integer, private :: next = 0, from(most_columns) = 1, to(most_columns) = 0
   contains
      procedure :: cell, is_numeric
      procedure :: take => take_row
      procedure :: check => check_row
   end type row_t

contains

   !> Take the next line of a text
   pure subroutine take_row(self, text)
      class(row_t), intent(inout) :: self
      character(len=*), intent(in) :: text

      if (self%line == 0) self%next = merge(4, 1, index(text, byte_order_mark) == 1)
      self%is_there = self%next <= len(text)
      if (.not. self%is_there) return
      call take_line(text, self%next, self%content, self%comment)
      self%line = self%line + 1
      call take_decimals(self%content, self%here)
      call split(self%content, self%columns, self%from, self%to)
   end subroutine take_row

   !> Check a line of numbers
   pure subroutine check_row(self, message)
      class(row_t), intent(inout) :: self
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      self%so_far%commas = self%so_far%commas .or. self%here%commas
      self%so_far%points = self%so_far%points .or. self%here%points
      if (has_control(self%content)) then
         message = not_a_text
      else if (self%so_far%commas .and. self%so_far%points) then
         message = mixed_decimals
      end if
   end subroutine check_row

   !> A column
   pure function cell(self, i)
      class(row_t), intent(in) :: self
      !> Index of the column, at most `columns` and `most_columns`
      integer, intent(in) :: i
      character(len=:), allocatable :: cell

      cell = self%content(self%from(i):self%to(i))
   end function cell

   !> Whether a column looks like a number
   elemental function is_numeric(self, i)
      class(row_t), intent(in) :: self
      !> Index of the column
      integer, intent(in) :: i
      logical :: is_numeric

      is_numeric = looks_numeric(self%content(self%from(i):self%to(i)))
   end function is_numeric

   !> Upper bound of the number of lines of a text
   pure function lines_in(text) result(n)
      character(len=*), intent(in) :: text
      integer :: n
      integer :: i

      n = 1
      do i = 1, len(text)
         if (text(i:i) == line_feed .or. text(i:i) == carriage_return) n = n + 1
      end do
   end function lines_in

   !> Read a line of a text; a line that names the separator becomes blank
   pure subroutine take_line(text, start, content, comment)
      character(len=*), intent(in) :: text
      !> Start of the line; on return start of the next one
      integer, intent(inout) :: start
      !> The line without its end and without text after a #
      character(len=:), allocatable, intent(out) :: content
      !> Text after the #
      character(len=:), allocatable, intent(out) :: comment
      integer :: last, mark

      last = scan(text(start:), carriage_return//line_feed) + start - 2
      if (last < start - 1) last = len(text)
      mark = index(text(start:last), "#")
      content = text(start:merge(start + mark - 2, last, mark > 0))
      comment = text(start + len(content) + 1:last)
      if (names_separator(content)) content = ""
      start = last + 2
      if (start > len(text)) return
      if (text(start-1:start) == carriage_return//line_feed) start = start + 1
   end subroutine take_line

   !> Whether a line is `sep=;`, by which Excel learns the separator; here it follows from the lines
   !> of numbers
   pure function names_separator(content) result(yes)
      character(len=*), intent(in) :: content
      logical :: yes

      yes = len(content) == 5
      if (yes) yes = lower(content(:4)) == "sep=" .and. scan(content(5:), ",; "//achar(9)) == 1
   end function names_separator

   !> Replace the decimal commas of a line by points
   pure subroutine take_decimals(content, decimals)
      character(len=*), intent(inout) :: content
      !> Form of its numbers
      type(decimals_t), intent(out) :: decimals
      integer :: i

      decimals%commas = has_decimal_commas(content)
      decimals%points = index(content, ".") > 0
      if (.not. decimals%commas) return
      do i = 1, len(content)
         if (content(i:i) == ",") content(i:i) = "."
      end do
   end subroutine take_decimals

   !> Whether each comma of a line is between two digits, and columns have another separator
   pure function has_decimal_commas(content) result(yes)
      character(len=*), intent(in) :: content
      logical :: yes
      character(len=*), parameter :: digits = "0123456789"
      integer :: first, i, last

      yes = .false.
      if (index(content, ",") == 0) return
      first = verify(content, blanks)
      last = verify(content, blanks, back=.true.)
      if (scan(content(first:last), ";"//blanks) == 0) return
      do i = 1, len(content)
         if (content(i:i) /= ",") cycle
         if (i == 1 .or. i == len(content)) return
         if (verify(content(i-1:i-1)//content(i+1:i+1), digits) > 0) return
      end do
      yes = .true.
   end function has_decimal_commas

   !> Find the columns of a line: separated by commas or semicolons if there are any, otherwise by
   !> tabs in a line of words (cells may be empty then), otherwise by blanks
   pure subroutine split(content, columns, from, to)
      character(len=*), intent(in) :: content
      !> Number of columns, 0 in a blank line
      integer, intent(out) :: columns
      !> First character of each column, as far as there is room, shape (n)
      integer, intent(out) :: from(:)
      !> Last character without blanks, shape (n)
      integer, intent(out) :: to(:)
      character(len=:), allocatable :: between
      integer :: start, last

      columns = 0
      from = 1
      to = 0
      start = verify(content, blanks)
      if (start == 0) return
      between = blanks
      if (scan(content, ",;") > 0) then
         between = ",;"
      else if (scan(content, tab) > 0 .and. verify(content(start:start), "+-.0123456789") > 0) then
         between = tab
      end if
      start = 1
      do
         if (between == blanks) start = verify(content(start:), blanks) + start - 1
         last = scan(content(start:), between) + start - 2
         if (last < start - 1) last = len(content)
         columns = columns + 1
         if (columns <= size(from)) then
            from(columns) = start
            to(columns) = start - 1 + verify(content(start:last), blanks, back=.true.)
            if (to(columns) >= start) from(columns) = start - 1 &
                  + verify(content(start:last), blanks)
         end if
         start = last + 2
         if (last == len(content)) exit
         if (between /= ",;" .and. verify(content(last+1:), blanks) == 0) exit
      end do
   end subroutine split

   !> Read a time, a frequency or a modulus
   subroutine read_value(cell, what, size_of_unit, value, message)
      !> Text of the column
      character(len=*), intent(in) :: cell
      !> Name of the quantity, for messages
      character(len=*), intent(in) :: what
      !> Size of its unit in SI units
      real(wp), intent(in) :: size_of_unit
      !> The number in its unit, > 0
      real(wp), intent(out) :: value
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      character(len=:), allocatable :: expected

      value = 0.0_wp
      expected = "a "//what//" > 0"
      if (what(1:1) == "a") expected = "an"//expected(2:)
      call read_real(cell, expected, value, message)
      if (allocated(message)) return
      if (.not. value > 0.0_wp) then
         message = "found "//real_text(value)//", expected "//expected
      else if (.not. (value >= smallest_value/size_of_unit &
            .and. value <= largest_value/size_of_unit)) then
         message = "found "//real_text(value)//", expected "//expected//", between " &
               //real_text(smallest_value)//" and "//real_text(largest_value) &
               //" in units of the SI"
      end if
   end subroutine read_value

end module vcor_io_columns
