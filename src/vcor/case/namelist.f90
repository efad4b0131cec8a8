!> Namelists as groups and their statements, with line numbers
!>
!> A text is split into groups `&name ... /` and their statements `key = values`, one group after
!> the other. The
!> values are not looked at here: a statement says where in the text each of them stands.
module vcor_case_namelist
   use vcor_error, only : error_input, error_t, raise
   use vcor_case_scanner, only : bad_token, comma_token, control_byte, end_token, equals_token, &
      & group_token, scan_text, section_token, slash_token, string_token, token_t, unclosed_quote, &
      & unclosed_section, word_token
   use vcor_text, only : integer_text, lower, printable, shortened
   implicit none
   private

   public :: namelist_t, statement_t, value_t, new_namelist, values_of

   !> One value of a statement
   type :: value_t
      !> First byte of it in the text, without repeat count
      integer :: first = 1
      !> Last byte of it in the text
      integer :: last = 0
      !> How many times it is meant, `3*1.0`; negative where that is not a positive number
      integer :: repeats = 1
      !> Whether it is in quotes
      logical :: in_quotes = .false.
   end type value_t

   !> One statement, `key = values` or `key(section) = values`
   type :: statement_t
      !> The key as it is written
      character(len=:), allocatable :: key
      !> What stands in parentheses after the key, without them; unallocated where nothing does
      character(len=:), allocatable :: section
      !> Line the key stands in
      integer :: line = 0
      !> The values, shape (n), n >= 1
      type(value_t), allocatable :: values(:)
   end type statement_t

   !> A text with namelists that is read from its beginning to its end
   type :: namelist_t
      !> The text
      character(len=:), allocatable :: text
      !> Name of its source, for messages
      character(len=:), allocatable :: source
      !> Tokens of the text
      type(token_t), allocatable, private :: tokens(:)
      !> The token that is looked at next
      integer, private :: next = 1
   contains
      !> Find the next group
      procedure :: next_group
      !> Find the next statement of the group
      procedure :: next_statement
      !> A place in the text, for messages
      procedure :: place
   end type namelist_t

contains

   !> Begin with a text
   pure subroutine new_namelist(self, text, source)
      !> The namelists
      type(namelist_t), intent(out) :: self
      !> The text
      character(len=*), intent(in) :: text
      !> Name of its source, for messages
      character(len=*), intent(in) :: source

      self%text = text
      self%source = source
      call scan_text(text, self%tokens)
   end subroutine new_namelist

   !> A place in the text, `case.nml:12`
   pure function place(self, line) result(text)
      !> The namelists
      class(namelist_t), intent(in) :: self
      !> The line
      integer, intent(in) :: line
      !> The place, for the beginning of a message
      character(len=:), allocatable :: text

      text = printable(self%source)//":"//integer_text(line)
   end function place

   !> Find the next group
   subroutine next_group(self, name, line, error)
      !> The namelists, at the beginning or after a group
      class(namelist_t), intent(inout) :: self
      !> Name of the group as it is written; unallocated after the last one
      character(len=:), allocatable, intent(out) :: name
      !> Line of it
      integer, intent(out) :: line
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(token_t) :: token
      character(len=:), allocatable :: message

      token = self%tokens(self%next)
      line = token%line
      select case (token%category)
      case (end_token)
         return
      case (group_token)
         name = self%text(token%first+1:token%last)
         if (lower(name) == "end") then
            message = "found &end outside of a group"
         else if (name == "") then
            message = "found & without a name, expected the name of a group at once after it"
         end if
         self%next = self%next + 1
      case (bad_token)
         message = flaw_message(self, token)
      case default
         message = outside_message(self, token)
      end select
      if (allocated(message)) call raise(error, error_input, self%place(line)//": "//message)
   end subroutine next_group

   !> Find the next statement of the group
   subroutine next_statement(self, group, statement, found, error)
      !> The namelists, within a group
      class(namelist_t), intent(inout) :: self
      !> Name of the group, for messages
      character(len=*), intent(in) :: group
      !> The statement
      type(statement_t), intent(out) :: statement
      !> Whether there was one; false after the last one of the group
      logical, intent(out) :: found
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(token_t) :: token
      character(len=:), allocatable :: message
      integer :: last, line

      found = .false.
      token = self%tokens(self%next)
      line = token%line
      select case (token%category)
      case (slash_token)
         self%next = self%next + 1
         return
      case (group_token)
         if (lower(self%text(token%first:token%last)) == "&end") then
            self%next = self%next + 1
            return
         end if
         message = "found "//shown(self, token)//" in &"//shortened(group) &
            & //", expected / to end it first"
      case (end_token)
         message = "found the end of the file in &"//shortened(group)//", expected / to end it"
      case (bad_token)
         message = flaw_message(self, token)
      case (word_token)
         if (.not. is_assignment(self%tokens, self%next)) then
            message = "found "//shown(self, token)//" in &"//shortened(group) &
               & //", expected key = value"
            ! What cannot be a token says more
            if (self%tokens(self%next+1)%category == bad_token) &
               & message = flaw_message(self, self%tokens(self%next+1))
         end if
      case default
         message = "found "//shown(self, token)//" in &"//shortened(group) &
            & //", expected key = value or /"
      end select
      if (.not. allocated(message)) then
         found = .true.
         statement%key = self%text(token%first:token%last)
         statement%line = token%line
         if (self%tokens(self%next+1)%category == section_token) then
            self%next = self%next + 1
            token = self%tokens(self%next)
            statement%section = self%text(token%first+1:token%last-1)
         end if
         call values_of(self%text, self%tokens, self%next + 2, statement%values, last, line, &
            & message)
         self%next = last + 1
         if (.not. allocated(message)) then
            ! What cannot be a token ends the values, but its own message says more
            if (self%tokens(self%next)%category == bad_token) then
               line = self%tokens(self%next)%line
               message = flaw_message(self, self%tokens(self%next))
            else if (size(statement%values) == 0) then
               line = statement%line
               message = "key '"//shortened(statement%key)//"' has no value"
            end if
         end if
      end if
      if (allocated(message)) call raise(error, error_input, self%place(line)//": "//message)
   end subroutine next_statement

   !> Whether a word, perhaps a section, and an equals sign follow each other
   pure function is_assignment(tokens, i) result(yes)
      !> The tokens, the last of which is bad or the end
      type(token_t), intent(in) :: tokens(:)
      !> Index of the first
      integer, intent(in) :: i
      !> True if they do
      logical :: yes
      integer :: after

      yes = tokens(i)%category == word_token
      if (.not. yes) return
      after = i + 1
      if (tokens(after)%category == section_token) after = after + 1
      yes = tokens(after)%category == equals_token
   end function is_assignment

   !> The values that begin at a token
   pure subroutine values_of(text, tokens, first, values, last, line, message)
      !> The text
      character(len=*), intent(in) :: text
      !> Its tokens, the last of which is bad or the end
      type(token_t), intent(in) :: tokens(:)
      !> Index of the first token
      integer, intent(in) :: first
      !> The values, shape (n), n >= 0
      type(value_t), allocatable, intent(out) :: values(:)
      !> Index of the last token of the values
      integer, intent(out) :: last
      !> Line of what is wrong
      integer, intent(out) :: line
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      type(value_t) :: value
      integer :: i, n
      logical :: after_separator, repeated

      last = first - 1
      do i = first, size(tokens)
         if (is_assignment(tokens, i)) exit
         if (.not. any(tokens(i)%category == [word_token, string_token, comma_token, &
            & section_token, equals_token])) exit
         last = i
      end do
      allocate(values(last - first + 1))
      n = 0
      line = tokens(first)%line
      after_separator = .true.
      repeated = .false.
      do i = first, last
         line = tokens(i)%line
         select case (tokens(i)%category)
         case (comma_token)
            if (after_separator .or. repeated) &
               & message = "found an empty value before a comma, expected a value"
            after_separator = .true.
         case (word_token, string_token)
            if (repeated .neqv. is_glued(tokens, i)) message = "found '" &
               & //shortened(text(tokens(max(first, i-1))%first:tokens(i)%last)) &
               & //"', expected a blank or a comma between values (a quote is doubled in a text)"
            if (.not. repeated) value%repeats = 1
            value%first = tokens(i)%first
            value%last = tokens(i)%last
            value%in_quotes = tokens(i)%category == string_token
            if (.not. value%in_quotes) call split_repeats(text, value)
            ! A repeat count before a text in quotes is a word of its own
            repeated = value%last < value%first .and. i < last
            if (repeated) repeated = tokens(i+1)%category == string_token &
               & .and. is_glued(tokens, i + 1)
            if (.not. repeated) then
               if (value%last < value%first) message = "found a repeat count without a value"
               n = n + 1
               values(n) = value
            end if
            after_separator = .false.
         case default
            message = "found '"//shortened(text(tokens(i)%first:tokens(i)%last))//"' among values"
         end select
         if (allocated(message)) return
      end do
      values = values(:n)
   end subroutine values_of

   !> Whether a value stands directly after another one
   pure function is_glued(tokens, i) result(yes)
      !> The tokens
      type(token_t), intent(in) :: tokens(:)
      !> Index of the later one
      integer, intent(in) :: i
      !> True if it does
      logical :: yes

      yes = i > 1
      if (.not. yes) return
      yes = tokens(i-1)%last + 1 == tokens(i)%first .and. &
         & (tokens(i-1)%category == word_token .or. tokens(i-1)%category == string_token)
   end function is_glued

   !> Split a word such as `3*1.0` into repeat count and value
   pure subroutine split_repeats(text, value)
      !> The text
      character(len=*), intent(in) :: text
      !> The value; `first` is moved behind the count
      type(value_t), intent(inout) :: value
      integer, parameter :: most_digits = 9
      integer :: star

      value%repeats = 1
      star = index(text(value%first:value%last), "*")
      if (star < 2) return
      star = value%first + star - 1
      if (verify(text(value%first:star-1), "0123456789") > 0) return
      value%repeats = -1
      ! Digits alone, and few enough of them: this cannot fail
      if (star - value%first <= most_digits) read(text(value%first:star-1), "(i9)") value%repeats
      if (value%repeats == 0) value%repeats = -1
      value%first = star + 1
   end subroutine split_repeats

   !> What to say about a bad token
   pure function flaw_message(self, token) result(message)
      !> The namelists
      class(namelist_t), intent(in) :: self
      !> The token
      type(token_t), intent(in) :: token
      !> The message
      character(len=:), allocatable :: message

      select case (token%flaw)
      case (unclosed_quote)
         message = "the text "//shortened(self%text(token%first:token%last)) &
            & //" is cut off, expected a closing quote in its line"
      case (unclosed_section)
         message = "found "//shown(self, token)//" without its counterpart"
      case (control_byte)
         message = "found byte "//integer_text(ichar(self%text(token%first:token%first))) &
            & //", a control character, expected a text file"
      case default
         message = "found "//shown(self, token)
      end select
   end function flaw_message

   !> What to say about a token outside of groups
   pure function outside_message(self, token) result(message)
      !> The namelists
      class(namelist_t), intent(in) :: self
      !> The token
      type(token_t), intent(in) :: token
      !> The message
      character(len=:), allocatable :: message
      logical :: after_slash

      message = "found "//shown(self, token)//" outside of groups, expected &group"
      if (token%category == word_token .and. self%text(token%first:token%first) == "$") then
         message = message//" (a group begins with &, not with $)"
         return
      end if
      if (self%next == 1) return
      associate (before => self%tokens(self%next-1))
         after_slash = before%category == slash_token .and. before%line == token%line
      end associate
      if (after_slash) message = message &
         & //" (the / before it ends its group; a text with / needs quotes)"
   end function outside_message

   !> A token in quotes, for messages
   pure function shown(self, token) result(text)
      !> The namelists
      class(namelist_t), intent(in) :: self
      !> The token
      type(token_t), intent(in) :: token
      !> The token
      character(len=:), allocatable :: text

      text = "'"//shortened(self%text(token%first:token%last))//"'"
   end function shown

end module vcor_case_namelist
