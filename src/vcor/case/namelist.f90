!> Namelists as groups and statements, with line numbers
!>
!> A text is a sequence of tokens, from which groups `&name ... /` and their statements
!> `key = values` are taken in order. A statement has the positions of its values in the text;
!> `vcor_case_values` converts them.
module vcor_case_namelist
   use vcor_error, only : error_input, error_t, raise
   use vcor_text, only : integer_text, is_control, lower, printable, shortened
   implicit none
   private

   public :: namelist_t, statement_t, literal_t, new_namelist, values_in

   !> One value of a statement
   type :: literal_t
      !> First byte in the text, without repeat count
      integer :: first = 1
      !> Last byte in the text
      integer :: last = 0
      !> Repeat count, as in `3*1.0`; negative if it is not a positive number
      integer :: repeats = 1
      !> Whether it is in quotes
      logical :: in_quotes = .false.
   end type literal_t

   !> One statement, `key = values` or `key(section) = values`
   type :: statement_t
      !> The key as written
      character(len=:), allocatable :: key
      !> Text in parentheses after the key; unallocated if there is none
      character(len=:), allocatable :: section
      !> Line of the key
      integer :: line = 0
      !> The values, shape (n), n >= 1
      type(literal_t), allocatable :: values(:)
   end type statement_t

   !> A token
   type :: token_t
      !> `,`, `=` or `/`; `&` with the word after it, `'` for a quoted text, `(` for parentheses and
      !> their content, `w` for any other word, `.` for the end, `?` for an invalid token
      character :: kind = '.'
      !> First byte in the text
      integer :: first = 1
      !> Last byte in the text
      integer :: last = 0
      !> Its line, from 1
      integer :: line = 1
   end type token_t

   !> A text with namelists, read from start to end
   type :: namelist_t
      !> The text
      character(len=:), allocatable :: text
      !> Name of its source, for messages
      character(len=:), allocatable :: source
      !> Tokens of the text, the last one the end or invalid
      type(token_t), allocatable, private :: tokens(:)
      !> Message about an invalid last token
      character(len=:), allocatable, private :: flaw
      !> Index of the next token
      integer, private :: next = 1
   contains
      procedure :: next_group, next_statement, place
   end type namelist_t

   character, parameter :: tab = achar(9), line_feed = achar(10), carriage_return = achar(13)
   character(len=*), parameter :: line_ends = line_feed//carriage_return
   !> Characters that end a word
   character(len=*), parameter :: delimiters = " ,'""=/&!()"//tab//line_ends

contains

   !> Split a text into tokens
   pure subroutine new_namelist(self, text, source)
      type(namelist_t), intent(out) :: self
      !> The text; lines end with line feed, carriage return, or both
      character(len=*), intent(in) :: text
      !> Name of its source, for messages
      character(len=*), intent(in) :: source

      character(len=*), parameter :: byte_order_mark = char(239)//char(187)//char(191)
      type(token_t), allocatable :: larger(:)
      type(token_t) :: token
      integer :: n

      self%text = text
      self%source = source
      self%flaw = ''
      allocate (self%tokens(256))
      n = 0
      if (index(text, byte_order_mark) == 1) token%last = len(byte_order_mark)
      do
         call go_on(text, token, self%flaw)
         n = n + 1
         if (n > size(self%tokens)) then
            allocate (larger(2*n))
            larger(:n - 1) = self%tokens
            call move_alloc(larger, self%tokens)
         end if
         self%tokens(n) = token
         if (token%kind == '.' .or. token%kind == '?') exit
      end do
      self%tokens = self%tokens(:n)
   end subroutine new_namelist

   !> Find the next token
   pure subroutine go_on(text, token, flaw)
      character(len=*), intent(in) :: text
      !> A token; on return the next one
      type(token_t), intent(inout) :: token
      !> Message if it is invalid
      character(len=:), allocatable, intent(inout) :: flaw

      integer :: i, length

      token%first = token%last + 1
      call skip_blanks(text, token%first, token%line)
      i = token%first
      token%last = i - 1
      token%kind = '.'
      if (i > len(text)) return
      token%last = i
      token%kind = text(i:i)
      select case (text(i:i))
      case (',', '=', '/')
         continue
      case ("'", '"')
         token%kind = "'"
         token%last = end_of_string(text, i)
         if (token%last == 0) then
            token%kind = '?'
            token%last = end_of(text, i, line_ends)
            flaw = 'the text '//shortened(text(i:token%last)) &
               //' is cut off, expected a closing quote in its line'
         end if
      case ('(', ')')
         token%last = end_of(text, i + 1, ")=('""!"//line_ends) + 1
         if (text(i:i) == ')' .or. text(token%last:min(token%last, len(text))) /= ')') then
            token%kind = '?'
            flaw = "found '"//text(i:i)//"' without its counterpart"
            token%last = i
         end if
      case ('&')
         token%last = end_of(text, i + 1, delimiters)
      case default
         token%kind = 'w'
         token%last = end_of(text, i, delimiters)
      end select
      ! a control character is the more useful message
      do length = 1, token%last - i + 1
         if (.not. is_control(text(i + length - 1:i + length - 1)) &
             .or. text(i + length - 1:i + length - 1) == tab) cycle
         token%kind = '?'
         flaw = 'found byte '//integer_text(ichar(text(i + length - 1:i + length - 1))) &
            //', a control character, expected a text file'
         exit
      end do
   end subroutine go_on

   !> Skip blanks and comments
   pure subroutine skip_blanks(text, position, line)
      character(len=*), intent(in) :: text
      !> Byte to read next
      integer, intent(inout) :: position
      integer, intent(inout) :: line

      logical :: in_comment

      in_comment = .false.
      do position = position, len(text)
         select case (text(position:position))
         case (line_feed, carriage_return)
            in_comment = .false.
            line = line + 1
            ! two bytes, one line end
            if (text(position:min(position + 1, len(text))) == carriage_return//line_feed) &
               line = line - 1
         case (' ', tab)
            continue
         case ('!')
            in_comment = .true.
         case default
            if (.not. in_comment .or. is_control(text(position:position))) return
         end select
      end do
   end subroutine skip_blanks

   !> Last byte before any of some characters
   pure function end_of(text, first, others) result(last)
      character(len=*), intent(in) :: text
      !> First byte to compare
      integer, intent(in) :: first
      character(len=*), intent(in) :: others
      !> Last byte; `first - 1` if there is none
      integer :: last

      last = first - 1
      do while (last < len(text))
         if (index(others, text(last + 1:last + 1)) > 0) exit
         last = last + 1
      end do
   end function end_of

   !> End of a quoted text
   pure function end_of_string(text, first) result(last)
      character(len=*), intent(in) :: text
      !> Position of its opening quote
      integer, intent(in) :: first
      !> Position of the closing quote; 0 if there is none in the line
      integer :: last

      last = first
      do
         last = end_of(text, last + 1, text(first:first)//line_ends) + 1
         if (last > len(text)) exit
         if (text(last:last) /= text(first:first)) exit
         if (last == len(text)) return
         ! a doubled quote is part of the text
         if (text(last + 1:last + 1) /= text(first:first)) return
         last = last + 1
      end do
      last = 0
   end function end_of_string

   !> A place, `case.nml:12`
   pure function place(self, line) result(text)
      class(namelist_t), intent(in) :: self
      integer, intent(in) :: line
      !> The place, with which a message begins
      character(len=:), allocatable :: text

      text = printable(self%source)//':'//integer_text(line)
   end function place

   !> Find the next group
   subroutine next_group(self, name, line, error)
      !> The namelists, at the beginning or after a group
      class(namelist_t), intent(inout) :: self
      !> Name of the group as written; unallocated after the last one
      character(len=:), allocatable, intent(out) :: name
      integer, intent(out) :: line
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: message

      associate (token => self%tokens(self%next))
         line = token%line
         message = ''
         if (token%kind == '.') then
            return
         else if (token%kind == '&') then
            name = self%text(token%first + 1:token%last)
            if (lower(name) == 'end') message = 'found &end outside of a group'
            if (name == '') &
               message = 'found & without a name, expected the name of a group at once after it'
            self%next = self%next + 1
         else if (token%kind == '?') then
            message = self%flaw
         else
            message = shown(self)//' outside of groups, expected &group'
            if (self%text(token%first:token%first) == '$') then
               message = message//' (a group begins with &, not with $)'
            else if (self%next > 1) then
               associate (before => self%tokens(self%next - 1))
                  if (before%kind == '/' .and. before%line == line) message = message &
                     //' (the / before it ends its group; a text with / needs quotes)'
               end associate
            end if
         end if
      end associate
      if (message /= '') call raise(error, error_input, self%place(line)//': '//message)
   end subroutine next_group

   !> Find the next statement of the group
   subroutine next_statement(self, group, statement, found, error)
      !> The namelists, within a group
      class(namelist_t), intent(inout) :: self
      !> Name of the group, for messages
      character(len=*), intent(in) :: group
      type(statement_t), intent(out) :: statement
      !> Whether there was a statement; false after the last one of the group
      logical, intent(out) :: found
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: message, place
      integer :: line
      logical :: is_end

      place = ' in &'//shortened(group)
      message = ''
      associate (token => self%tokens(self%next))
         line = token%line
         found = is_assignment(self, self%next)
         is_end = token%kind == '/'
         if (token%kind == '&') is_end = lower(self%text(token%first:token%last)) == '&end'
         if (is_end) then
            self%next = self%next + 1
            return
         else if (token%kind == '&') then
            message = shown(self)//place//', expected / to end it first'
         else if (token%kind == '.') then
            message = 'found the end of the file'//place//', expected / to end it'
         else if (token%kind == '?') then
            message = self%flaw
         else if (token%kind /= 'w') then
            message = shown(self)//place//', expected key = value or /'
         else if (.not. found) then
            message = shown(self)//place//', expected key = value'
            ! an invalid next token is the more useful message
            if (self%tokens(self%next + 1)%kind == '?') message = self%flaw
         else
            statement%key = self%text(token%first:token%last)
            statement%line = line
         end if
      end associate
      if (found) then
         self%next = self%next + 1
         associate (token => self%tokens(self%next))
            if (token%kind == '(') statement%section = self%text(token%first + 1:token%last - 1)
            if (token%kind == '(') self%next = self%next + 1
         end associate
         self%next = self%next + 1
         call take_values(self, statement%values, line, message)
         if (message == '' .and. size(statement%values) == 0) then
            line = statement%line
            message = "key '"//shortened(statement%key)//"' has no value"
         end if
      end if
      if (message /= '') call raise(error, error_input, self%place(line)//': '//message)
   end subroutine next_statement

   !> Values of a text with nothing else
   pure subroutine values_in(text, values, message)
      character(len=*), intent(in) :: text
      !> The values, shape (n)
      type(literal_t), allocatable, intent(out) :: values(:)
      !> Message; empty on success, and without values if there is anything else
      character(len=:), allocatable, intent(out) :: message

      type(namelist_t) :: namelist
      integer :: line

      call new_namelist(namelist, text, '')
      call take_values(namelist, values, line, message)
      if (message == '' .and. namelist%tokens(namelist%next)%kind /= '.') values = values(:0)
   end subroutine values_in

   !> Read the next values
   pure subroutine take_values(self, values, line, message)
      !> The namelists; on return the next token is the one after the values
      class(namelist_t), intent(inout) :: self
      !> The values, shape (n), n >= 0
      type(literal_t), allocatable, intent(out) :: values(:)
      !> Line of the error
      integer, intent(out) :: line
      !> Message on failure, empty on success
      character(len=:), allocatable, intent(out) :: message

      integer :: i, first, n
      logical :: after_separator

      message = ''
      first = self%next
      do while (scan(self%tokens(self%next)%kind, "w',(=") > 0)
         if (is_assignment(self, self%next)) exit
         self%next = self%next + 1
      end do
      allocate (values(self%next - first))
      n = 0
      after_separator = .true.
      do i = first, self%next - 1
         associate (token => self%tokens(i))
            line = token%line
            if (token%kind == ',') then
               if (after_separator) &
                  message = 'found an empty value before a comma, expected a value'
            else if (token%kind == '=' .or. token%kind == '(') then
               message = "found '"//shortened(self%text(token%first:token%last))//"' among values"
            else
               if (i > first .and. .not. after_separator) then
                  if (self%tokens(i - 1)%last + 1 == token%first) message = "found '" &
                     //shortened(self%text(self%tokens(i - 1)%first:token%last)) &
                     //"', expected a blank or a comma between values (a quote is doubled in a " &
                     //'text)'
               end if
               n = n + 1
               values(n) = literal_t(token%first, token%last, in_quotes=token%kind == "'")
               if (token%kind == 'w') call split_repeats(self%text, values(n))
               if (values(n)%last < values(n)%first) &
                  message = 'found a repeat count without a value'
            end if
            after_separator = token%kind == ','
         end associate
         if (message /= '') return
      end do
      values = values(:n)
      ! an invalid token ends the values
      line = self%tokens(self%next)%line
      if (self%tokens(self%next)%kind == '?') message = self%flaw
   end subroutine take_values

   !> Whether tokens are a word, possibly a section, and an equals sign
   pure function is_assignment(self, i) result(yes)
      class(namelist_t), intent(in) :: self
      !> Index of the first token
      integer, intent(in) :: i
      logical :: yes

      integer :: after

      yes = self%tokens(i)%kind == 'w'
      if (.not. yes) return
      after = i + 1
      if (self%tokens(after)%kind == '(') after = after + 1
      yes = self%tokens(after)%kind == '='
   end function is_assignment

   !> Split a word such as `3*1.0` into repeat count and value
   pure subroutine split_repeats(text, value)
      character(len=*), intent(in) :: text
      !> The value; on return `first` is after the count
      type(literal_t), intent(inout) :: value

      integer, parameter :: most_digits = 9
      integer :: star

      star = index(text(value%first:value%last), '*') + value%first - 1
      if (star <= value%first) return
      if (verify(text(value%first:star - 1), '0123456789') > 0) return
      value%repeats = 0
      ! reading cannot fail: these are digits only, and few enough
      if (star - value%first <= most_digits) read (text(value%first:star - 1), '(i9)') value%repeats
      if (value%repeats == 0) value%repeats = -1
      value%first = star + 1
   end subroutine split_repeats

   !> Next token, for messages
   pure function shown(self) result(text)
      class(namelist_t), intent(in) :: self
      !> Such as `found 'velocity'`
      character(len=:), allocatable :: text

      associate (token => self%tokens(self%next))
         text = "found '"//shortened(self%text(token%first:token%last))//"'"
      end associate
   end function shown

end module vcor_case_namelist
