!> Columns of numbers in text files, as spreadsheets, other programs and people write them
!>
!> Between columns stands a comma, a semicolon, a tab or blanks. Lines end as they do on any system,
!> what follows a # does not count, and a byte-order mark is passed over.
module vcor_io_columns
   implicit none
   private

   public :: lines_in, take_line, split, start_of, blanks

   character(len=*), parameter :: line_feed = achar(10), carriage_return = achar(13)
   character(len=*), parameter :: byte_order_mark = char(239)//char(187)//char(191)
   !> What is blank
   character(len=*), parameter :: blanks = " "//achar(9)

contains

   !> Where the first line of a text begins
   pure function start_of(text) result(start)
      !> The text
      character(len=*), intent(in) :: text
      !> Place of its first character
      integer :: start

      start = 1
      if (index(text, byte_order_mark) == 1) start = 1 + len(byte_order_mark)
   end function start_of

   !> Number of lines in a text, or a little more
   pure function lines_in(text) result(n)
      !> The text
      character(len=*), intent(in) :: text
      !> The number
      integer :: n
      integer :: i

      n = 1
      do i = 1, len(text)
         if (text(i:i) == line_feed .or. text(i:i) == carriage_return) n = n + 1
      end do
   end function lines_in

   !> Take a line from a text
   pure subroutine take_line(text, start, content, comment)
      !> The text
      character(len=*), intent(in) :: text
      !> Where the line begins, on return where the next one does
      integer, intent(inout) :: start
      !> The line without its end and without what follows a #
      character(len=:), allocatable, intent(out) :: content
      !> What follows the #
      character(len=:), allocatable, intent(out), optional :: comment
      integer :: last, mark

      last = scan(text(start:), carriage_return//line_feed) + start - 2
      if (last < start - 1) last = len(text)
      mark = index(text(start:last), "#")
      content = text(start:merge(start + mark - 2, last, mark > 0))
      if (present(comment)) comment = text(start + len(content) + 1:last)
      start = last + 2
      if (start > len(text)) return
      if (text(start-1:start) == carriage_return//line_feed) start = start + 1
   end subroutine take_line

   !> Find the columns of a line: between commas or semicolons if there are any, else between blanks
   pure subroutine split(content, columns, from, to)
      !> The line
      character(len=*), intent(in) :: content
      !> Their number, 0 in a blank line
      integer, intent(out) :: columns
      !> Where each of them begins, as far as there is room, shape (n)
      integer, intent(out) :: from(:)
      !> Where it ends, blanks left out, shape (n)
      integer, intent(out) :: to(:)
      integer :: start, last

      columns = 0
      from = 1
      to = 0
      if (verify(content, blanks) == 0) return
      start = 1
      do
         if (scan(content, ",;") > 0) then
            last = scan(content(start:), ",;") + start - 2
         else
            start = verify(content(start:), blanks) + start - 1
            last = scan(content(start:), blanks) + start - 2
         end if
         if (last < start - 1) last = len(content)
         columns = columns + 1
         if (columns <= size(from)) then
            from(columns) = start
            to(columns) = start - 1 + verify(content(start:last), blanks, back=.true.)
            if (to(columns) >= start) from(columns) = start - 1 &
               & + verify(content(start:last), blanks)
         end if
         start = last + 2
         if (last == len(content)) exit
         if (scan(content, ",;") == 0 .and. verify(content(last+1:), blanks) == 0) exit
      end do
   end subroutine split

end module vcor_io_columns
