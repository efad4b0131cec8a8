!> A line of text as Markdown or roff has it
!>
!> Texts have one mark of their own: what stands between backquotes is to be typed or read as it is.
!> Everything else is plain, and characters that mean something in Markdown or roff are escaped.
module vcor_app_inline
   implicit none
   private

   public :: inline, roff, wrapped, guarded, plain_words, replaced, upper

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

contains

   !> A text without the marks that a page may have: no backquotes
   pure function plain_words(words) result(plain)
      !> Any text
      character(len=*), intent(in) :: words
      !> The same with apostrophes for backquotes
      character(len=:), allocatable :: plain

      plain = replaced(words, '`', "'")
   end function plain_words

   !> A text with its marks and plain characters as Markdown or roff has them
   pure function inline(words, man) result(text)
      !> The text
      character(len=*), intent(in) :: words
      !> Whether it is for man
      logical, intent(in) :: man
      !> The same for the page
      character(len=:), allocatable :: text

      integer :: first, last
      logical :: code

      text = ''
      first = 1
      code = .false.
      do while (first <= len(words))
         last = first + index(words(first:)//'`', '`') - 2
         if (man) then
            if (code) text = text//'\fB'
            text = text//roff(words(first:last))
            if (code) text = text//'\fR'
         else if (code) then
            text = text//'`'//words(first:last)//'`'
         else
            text = text//markdown(words(first:last))
         end if
         code = .not. code
         first = last + 2
      end do
   end function inline

   !> A plain text as Markdown has it
   pure function markdown(words) result(text)
      !> The text
      character(len=*), intent(in) :: words
      !> The same, escaped
      character(len=:), allocatable :: text

      text = replaced(replaced(words, '*', '\*'), '<', '\<')
   end function markdown

   !> A plain text as roff has it: a minus sign is none of the typographer's dashes, and so on
   pure function roff(words) result(text)
      !> The text
      character(len=*), intent(in) :: words
      !> The same, escaped
      character(len=:), allocatable :: text

      text = replaced(replaced(words, '\', '\e'), '-', '\-')
      text = replaced(replaced(replaced(text, "'", '\(aq'), '^', '\(ha'), '~', '\(ti')
   end function roff

   !> A text in lines that end where there is a blank
   pure function wrapped(words, width, margin, man) result(text)
      !> The text, one line
      character(len=*), intent(in) :: words
      !> Longest line
      integer, intent(in) :: width
      !> What every line but the first begins with
      character(len=*), intent(in) :: margin
      !> Whether it is for man
      logical, intent(in) :: man
      !> The lines, the last one ended too
      character(len=:), allocatable :: text

      character(len=:), allocatable :: start
      integer :: first, last, room

      text = ''
      start = ''
      first = 1
      do
         room = width - len(start)
         last = len(words)
         if (last - first >= room) then
            last = first - 1 + index(words(first:first + room), ' ', back=.true.)
            if (last < first) last = first - 1 + index(words(first:)//' ', ' ')
            last = last - 1
         end if
         if (man) then
            text = text//guarded(words(first:last))//nl
         else
            text = text//start//words(first:last)//nl
         end if
         first = last + 2
         start = margin
         if (first > len(words)) exit
      end do
   end function wrapped

   !> A line of roff that begins with no request
   pure function guarded(words) result(text)
      !> The line
      character(len=*), intent(in) :: words
      !> The same, or with something before it that prints nothing
      character(len=:), allocatable :: text

      text = words
      if (index(words, '.') == 1) text = '\&'//words
   end function guarded

   !> A text with something else in the place of each part of a kind
   pure function replaced(words, old, new) result(text)
      !> The text
      character(len=*), intent(in) :: words
      !> The part
      character(len=*), intent(in) :: old
      !> What comes in its place
      character(len=*), intent(in) :: new
      !> The new text
      character(len=:), allocatable :: text

      integer :: first, mark

      text = ''
      first = 1
      do
         mark = index(words(first:), old)
         if (mark == 0) exit
         text = text//words(first:first + mark - 2)//new
         first = first + mark - 1 + len(old)
      end do
      text = text//words(first:)
   end function replaced

   !> A text in upper case
   pure function upper(words) result(text)
      !> The text
      character(len=*), intent(in) :: words
      !> The same in upper case
      character(len=len(words)) :: text

      integer, parameter :: shift = iachar('A') - iachar('a')
      integer :: i

      text = words
      do i = 1, len(words)
         if (words(i:i) >= 'a' .and. words(i:i) <= 'z') &
            text(i:i) = achar(iachar(words(i:i)) + shift)
      end do
   end function upper

end module vcor_app_inline
