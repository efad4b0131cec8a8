!> What a name may hold: the one rule for all names that are written anywhere, be it as the name of
!> a file, in a file of results or in a script
!>
!> A line end in a name leaves the comment of a script, an escape sequence goes to a terminal, and
!> gnuplot, as other programs, runs what follows `|` or `<` at the beginning of a file's name.
module vcor_case_name
   use vcor_text, only : integer_text
   implicit none
   private

   public :: control_in, name_flaw

contains

   !> The first control character of a text: C0, DEL, and C1 of UTF-8 (U+0080 to U+009F)
   pure function control_in(text) result(what)
      !> Any bytes
      character(len=*), intent(in) :: text
      !> Such as `a tab`; empty if there is none
      character(len=:), allocatable :: what
      integer, parameter :: nul = 0, tab = 9, line_feed = 10, carriage_return = 13, blank = 32, &
         del = 127, first_c1 = 128, last_c1 = 159, lead_c1 = 194
      integer :: byte, i

      what = ''
      do i = 1, len(text)
         byte = ichar(text(i:i))
         if (byte == lead_c1 .and. i < len(text)) byte = ichar(text(i + 1:i + 1))
         select case (byte)
         case (nul)
            what = 'a NUL character'
         case (tab)
            what = 'a tab'
         case (line_feed, carriage_return)
            what = 'a line end'
         case (nul + 1:tab - 1, carriage_return - 2:carriage_return - 1, &
            carriage_return + 1:blank - 1, del)
            what = 'the control character '//integer_text(byte)
         case (first_c1:last_c1)
            if (ichar(text(i:i)) == lead_c1) what = 'the control character '//integer_text(byte)
         case default
            continue
         end select
         if (what /= '') return
      end do
   end function control_in

   !> What is wrong with a name
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

end module vcor_case_name
