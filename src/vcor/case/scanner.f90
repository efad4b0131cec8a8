!> A text with namelists as a sequence of tokens, each with its line
!>
!> Knows blanks, comments, both quotes, and what separates words; what the words mean is
!> `vcor_case_namelist`'s.
module vcor_case_scanner
   implicit none
   private

   public :: token_t, scan_text
   public :: word_token, string_token, comma_token, equals_token, section_token, slash_token, &
      & group_token
   public :: bad_token, end_token
   public :: unclosed_quote, unclosed_section, control_byte

   !> Kinds of tokens: anything that is none of the following
   integer, parameter :: word_token = 1
   !> A text in quotes, with them
   integer, parameter :: string_token = 2
   !> A comma
   integer, parameter :: comma_token = 3
   !> An equals sign
   integer, parameter :: equals_token = 4
   !> Something in parentheses, with them
   integer, parameter :: section_token = 5
   !> A slash
   integer, parameter :: slash_token = 6
   !> An ampersand with the word after it
   integer, parameter :: group_token = 7
   !> What cannot be a token; the last one, see `token_t%flaw`
   integer, parameter :: bad_token = 8
   !> The end of the text; the last one
   integer, parameter :: end_token = 9

   !> Flaws of a bad token: a text without quote at its end
   integer, parameter :: unclosed_quote = 1
   !> A parenthesis that is not closed
   integer, parameter :: unclosed_section = 2
   !> A byte that is no part of a text
   integer, parameter :: control_byte = 3

   !> One token
   type :: token_t
      !> One of the `*_token` constants
      integer :: category = end_token
      !> First byte of it in the text
      integer :: first = 1
      !> Last byte of it in the text
      integer :: last = 0
      !> Line it stands in, from 1
      integer :: line = 1
      !> What is wrong with a bad token
      integer :: flaw = 0
   end type token_t

   character, parameter :: tab = achar(9), line_feed = achar(10), carriage_return = achar(13)
   !> What ends a word
   character(len=*), parameter :: delimiters = " ,'""=/&!()"//tab//line_feed//carriage_return

contains

   !> Split a text into tokens
   pure subroutine scan_text(text, tokens)
      !> The text; lines end with line feed, carriage return, or both
      character(len=*), intent(in) :: text
      !> Its tokens, the last of which is bad or the end, shape (n)
      type(token_t), allocatable, intent(out) :: tokens(:)
      type(token_t), allocatable :: larger(:)
      integer :: n, position, line
      integer, parameter :: first_room = 256

      allocate(tokens(first_room))
      n = 0
      line = 1
      position = 1
      ! UTF-8 byte order mark
      if (index(text(:min(3, len(text))), char(239)//char(187)//char(191)) == 1) position = 4
      do
         call skip_blanks(text, position, line)
         n = n + 1
         if (n > size(tokens)) then
            allocate(larger(2*size(tokens)))
            larger(:n-1) = tokens
            call move_alloc(larger, tokens)
         end if
         call next_token(text, position, line, tokens(n))
         if (tokens(n)%category == bad_token .or. tokens(n)%category == end_token) exit
         position = tokens(n)%last + 1
      end do
      tokens = tokens(:n)
   end subroutine scan_text

   !> Go on to what is neither blank nor comment
   pure subroutine skip_blanks(text, position, line)
      !> The text
      character(len=*), intent(in) :: text
      !> Byte to look at next
      integer, intent(inout) :: position
      !> Its line
      integer, intent(inout) :: line
      logical :: in_comment

      in_comment = .false.
      do while (position <= len(text))
         select case (text(position:position))
         case (line_feed)
            line = line + 1
            in_comment = .false.
         case (carriage_return)
            ! Before a line feed it is part of the same line end
            if (at(text, position + 1) /= line_feed) then
               line = line + 1
               in_comment = .false.
            end if
         case (" ", tab)
            continue
         case ("!")
            in_comment = .true.
         case default
            if (.not. in_comment .or. is_control(text(position:position))) return
         end select
         position = position + 1
      end do
   end subroutine skip_blanks

   !> The token at a position
   pure subroutine next_token(text, position, line, token)
      !> The text
      character(len=*), intent(in) :: text
      !> First byte of the token
      integer, intent(in) :: position
      !> Its line
      integer, intent(in) :: line
      !> The token
      type(token_t), intent(out) :: token

      token%first = position
      token%last = position
      token%line = line
      if (position > len(text)) then
         token%category = end_token
         return
      end if
      select case (text(position:position))
      case (",")
         token%category = comma_token
      case ("=")
         token%category = equals_token
      case ("/")
         token%category = slash_token
      case ("'", '"')
         call end_string(text, token)
      case ("(", ")")
         call end_section(text, token)
      case ("&")
         token%category = group_token
         token%last = end_of_word(text, position + 1)
      case default
         token%category = word_token
         token%last = end_of_word(text, position)
      end select
      if (token%category /= bad_token) call refuse_control_bytes(text, token)
   end subroutine next_token

   !> Last byte of a word
   pure function end_of_word(text, first) result(last)
      !> The text
      character(len=*), intent(in) :: text
      !> First byte of the word
      integer, intent(in) :: first
      !> Its last byte, `first - 1` when there is no word
      integer :: last

      last = first
      do while (last <= len(text))
         if (index(delimiters, text(last:last)) > 0) exit
         last = last + 1
      end do
      last = last - 1
   end function end_of_word

   !> Find the end of a text in quotes; it has to be in the same line
   pure subroutine end_string(text, token)
      !> The text
      character(len=*), intent(in) :: text
      !> The token, which begins with the quote
      type(token_t), intent(inout) :: token
      character :: quote
      integer :: i

      quote = text(token%first:token%first)
      token%category = string_token
      i = token%first
      do
         i = i + 1
         if (at(text, i) == quote) then
            ! A doubled quote is a quote in the text
            if (at(text, i + 1) /= quote) exit
            i = i + 1
         else if (at(text, i) == line_feed .or. at(text, i) == carriage_return) then
            token%category = bad_token
            token%flaw = unclosed_quote
            i = i - 1
            exit
         end if
      end do
      token%last = min(i, len(text))
   end subroutine end_string

   !> Find the closing parenthesis; it has to be in the same line
   pure subroutine end_section(text, token)
      !> The text
      character(len=*), intent(in) :: text
      !> The token, which begins with a parenthesis
      type(token_t), intent(inout) :: token
      integer :: i

      token%category = section_token
      i = token%first
      if (at(text, i) == "(") then
         do
            i = i + 1
            if (scan(at(text, i), ")=('""!"//line_feed//carriage_return) > 0) exit
         end do
      end if
      token%last = min(i, len(text))
      if (at(text, i) == ")" .and. i > token%first) return
      token%category = bad_token
      token%flaw = unclosed_section
      token%last = token%first
   end subroutine end_section

   !> Make a token with a control byte in it a bad one
   pure subroutine refuse_control_bytes(text, token)
      !> The text
      character(len=*), intent(in) :: text
      !> The token
      type(token_t), intent(inout) :: token
      integer :: i

      do i = token%first, token%last
         if (.not. is_control(text(i:i))) cycle
         token%category = bad_token
         token%flaw = control_byte
         token%first = i
         token%last = i
         return
      end do
   end subroutine refuse_control_bytes

   !> Whether a byte is no part of any text
   pure function is_control(byte) result(yes)
      !> The byte
      character, intent(in) :: byte
      !> True for ASCII control characters but tab
      logical :: yes

      yes = (iachar(byte) < 32 .and. byte /= tab) .or. iachar(byte) == 127
   end function is_control

   !> A byte of a text; a line feed beyond its end
   pure function at(text, position) result(byte)
      !> The text
      character(len=*), intent(in) :: text
      !> Which byte
      integer, intent(in) :: position
      !> The byte
      character :: byte

      byte = line_feed
      if (position <= len(text)) byte = text(position:position)
   end function at

end module vcor_case_scanner
