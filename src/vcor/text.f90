!> Operations on texts: case, names, and foreign text made safe for a one-line message
module vcor_text
   implicit none
   private

   public :: lower, canonical_name, integer_text, quoted
   public :: printable, shortened, is_utf8, has_control, is_control, control_in, name_flaw
   public :: text_flaw, link_name
   public :: buffer_t

   !> Longest part of a foreign text that a message repeats [bytes]
   integer, parameter :: shown_bytes = 60
   !> Longest text of a case [bytes]
   integer, parameter :: longest_text = 4096

   !> A growing text
   type :: buffer_t
      !> Bytes so far
      integer :: length = 0
      !> Space for bytes, of which the first `length` are in use
      character(len=:), allocatable, private :: room
   contains
      procedure :: add, text
   end type buffer_t

contains

   !> A text in lower case (ASCII letters only)
   pure function lower(text) result(small)
      character(len=*), intent(in) :: text
      character(len=len(text)) :: small
      integer, parameter :: shift = iachar("a") - iachar("A")
      integer :: i

      small = text
      do i = 1, len(text)
         if (text(i:i) >= "A" .and. text(i:i) <= "Z") small(i:i) = achar(iachar(text(i:i)) + shift)
      end do
   end function lower

   !> A name in its form for comparison: lower case, underscores for blanks
   pure function canonical_name(name) result(canonical)
      !> Name of a material
      character(len=*), intent(in) :: name
      !> Its form for comparison
      character(len=:), allocatable :: canonical
      integer :: i

      canonical = trim(adjustl(lower(name)))
      do i = 1, len(canonical)
         if (canonical(i:i) == " ") canonical(i:i) = "_"
      end do
   end function canonical_name

   !> An integer as text
   pure function integer_text(number) result(text)
      integer, intent(in) :: number
      character(len=:), allocatable :: text
      character(len=16) :: buffer

      write(buffer, "(i0)") number
      text = trim(buffer)
   end function integer_text

   !> A text in quotes, as in a namelist
   pure function quoted(text) result(between)
      character(len=*), intent(in) :: text
      !> The text between single quotes, with single quotes inside doubled
      character(len=:), allocatable :: between
      integer :: i, start

      between = "'"
      start = 1
      do
         i = index(text(start:), "'")
         if (i == 0) exit
         between = between//text(start:start+i-1)//"'"
         start = start + i
      end do
      between = between//text(start:)//"'"
   end function quoted

   !> Whether a text contains control characters
   pure function has_control(text) result(yes)
      character(len=*), intent(in) :: text
      !> True if it does; a tab does not count
      logical :: yes
      integer :: i

      yes = .false.
      do i = 1, len(text)
         if (is_control(text(i:i)) .and. iachar(text(i:i)) /= 9) yes = .true.
      end do
   end function has_control

   !> Whether a byte is an ASCII control character
   pure function is_control(byte) result(yes)
      character, intent(in) :: byte
      logical :: yes

      yes = iachar(byte) < 32 .or. iachar(byte) == 127
   end function is_control

   !> Whether a text is UTF-8
   pure function is_utf8(text) result(yes)
      !> Any bytes
      character(len=*), intent(in) :: text
      !> True if it is; plain ASCII is
      logical :: yes
      integer :: i, width

      yes = .true.
      i = 1
      do while (i <= len(text))
         width = utf8_width(text(i:))
         yes = width > 0
         if (.not. yes) return
         i = i + width
      end do
   end function is_utf8

   !> Number of bytes of the UTF-8 character at the start of a text
   pure function utf8_width(text) result(width)
      !> At least one byte
      character(len=*), intent(in) :: text
      !> 1 to 4, 0 if it is not UTF-8
      integer :: width
      integer :: first, i

      first = ichar(text(1:1))
      select case (first)
      case (0:127)
         width = 1
      case (194:223)
         width = 2
      case (224:239)
         width = 3
      case (240:244)
         width = 4
      case default
         width = 0
      end select
      if (width > len(text)) width = 0
      do i = 2, width
         if (ichar(text(i:i)) < 128 .or. ichar(text(i:i)) > 191) width = 0
         if (width == 0) return
      end do
      ! overlong forms, surrogates, and code points beyond Unicode
      if (width < 3) return
      i = ichar(text(2:2))
      if (first == 224 .and. i < 160 .or. first == 237 .and. i > 159 &
         .or. first == 240 .and. i < 144 .or. first == 244 .and. i > 143) width = 0
   end function utf8_width

   !> A text that a message may show: no control characters, only valid UTF-8
   pure function printable(text) result(shown)
      !> Any bytes
      character(len=*), intent(in) :: text
      !> The text with a blank for each tab and line end, and a question mark for each other byte
      !> that cannot be shown
      character(len=len(text)) :: shown
      character(len=*), parameter :: white = achar(9)//achar(10)//achar(13)
      integer :: i, width

      shown = text
      i = 1
      do while (i <= len(text))
         width = utf8_width(text(i:min(i+3, len(text))))
         if (width == 1) then
            if (is_control(text(i:i))) shown(i:i) = merge(" ", "?", index(white, text(i:i)) > 0)
         else if (width == 2) then
            ! the second set of control characters, U+0080 to U+009F
            if (ichar(text(i:i)) == 194 .and. ichar(text(i+1:i+1)) < 160) shown(i:i+1) = "??"
         else if (width == 0) then
            shown(i:i) = "?"
         end if
         i = i + max(1, width)
      end do
   end function printable

   !> A text that a message may repeat: printable, and cut with three dots if it is long
   pure function shortened(text) result(shown)
      !> Any bytes
      character(len=*), intent(in) :: text
      !> At most `shown_bytes` bytes of it
      character(len=:), allocatable :: shown
      integer :: last

      if (len(text) <= shown_bytes) then
         shown = printable(text)
         return
      end if
      ! do not cut a UTF-8 character
      last = shown_bytes - 3
      do while (last > 1 .and. ichar(text(last+1:last+1)) >= 128 &
         .and. ichar(text(last+1:last+1)) < 192)
         last = last - 1
      end do
      shown = printable(text(:last))//"..."
   end function shortened

   !> The first control character of a text: C0, DEL, and C1 of UTF-8 (U+0080 to U+009F)
   pure function control_in(text) result(what)
      !> Any bytes
      character(len=*), intent(in) :: text
      !> Such as `a tab`; empty if there is none
      character(len=:), allocatable :: what
      integer :: i

      what = ''
      do i = 1, len(text)
         select case (ichar(text(i:i)))
         case (0)
            what = 'a NUL character'
         case (9)
            what = 'a tab'
         case (10, 13)
            what = 'a line end'
         case (1:8, 11:12, 14:31, 127)
            what = 'the control character '//integer_text(ichar(text(i:i)))
         case (128:159)
            if (text(max(1, i - 1):max(1, i - 1)) == char(194)) &
               what = 'the control character '//integer_text(ichar(text(i:i)))
         case default
            continue
         end select
         if (what /= '') return
      end do
   end function control_in

   !> Name of a column in HDF5 files
   pure function link_name(name) result(link)
      character(len=*), intent(in) :: name
      !> The name with `_` for slashes, which would denote groups
      character(len=len(name)) :: link

      integer :: i

      do i = 1, len(name)
         link(i:i) = merge('_', name(i:i), name(i:i) == '/')
      end do
   end function link_name

   !> What is wrong with a text as a value in a case
   pure function text_flaw(text) result(flaw)
      !> Any bytes
      character(len=*), intent(in) :: text
      !> What was found and what is expected; empty if nothing is wrong
      character(len=:), allocatable :: flaw

      flaw = ''
      if (.not. is_utf8(text)) then
         flaw = "found a text that is not UTF-8, '"//shortened(text)//"'"
      else if (control_in(text) /= '') then
         flaw = 'found '//control_in(text)//" in '"//shortened(text) &
            //"', expected a text that can be read on one line"
      else if (len(text) > longest_text) then
         flaw = 'found a text of '//integer_text(len(text))//' bytes, expected at most ' &
            //integer_text(longest_text)
      end if
   end function text_flaw

   !> What is wrong with a name of a file; this rule holds wherever files are written. A line end
   !> would leave the comment of a script, an escape sequence would act on the terminal, and some
   !> programs run what follows `|` or `<` at the beginning of a name
   pure function name_flaw(name) result(flaw)
      !> Name of a file or a folder, or a path of such names
      character(len=*), intent(in) :: name
      !> Such as `holds a tab`, or `begins with '|', ...`; empty if nothing is wrong
      character(len=:), allocatable :: flaw
      integer :: i

      flaw = control_in(name)
      if (flaw /= '') then
         flaw = 'holds '//flaw
         return
      end if
      do i = 1, len(name)
         if (scan(name(i:i), '|<') == 0) cycle
         if (i > 1) then
            if (name(i - 1:i - 1) /= '/') cycle
         end if
         flaw = "begins with '"//name(i:i)//"', which other programs take for a pipe"
         if (index(name(:i), '/') > 0) flaw = 'has a part that '//flaw
         return
      end do
   end function name_flaw

   !> Append a text
   pure subroutine add(self, part)
      class(buffer_t), intent(inout) :: self
      character(len=*), intent(in) :: part
      character(len=:), allocatable :: larger
      integer, parameter :: first_room = 256

      if (.not. allocated(self%room)) allocate(character(len=first_room) :: self%room)
      if (self%length + len(part) > len(self%room)) then
         allocate(character(len=2*(self%length + len(part))) :: larger)
         larger(:self%length) = self%room(:self%length)
         call move_alloc(larger, self%room)
      end if
      self%room(self%length+1:self%length+len(part)) = part
      self%length = self%length + len(part)
   end subroutine add

   !> The text so far
   pure function text(self) result(all)
      class(buffer_t), intent(in) :: self
      character(len=self%length) :: all

      if (self%length > 0) all = self%room(:self%length)
   end function text

end module vcor_text
