!> Values as they are written to values of a key's kind
module vcor_case_values
   use vcor_case_namelist, only : value_t, values_of
   use vcor_case_real, only : read_real
   use vcor_case_scanner, only : end_token, scan_text, token_t
   use vcor_kinds, only : wp
   use vcor_case_catalogue, only : integer_key, key_t, list_key, logical_key, real_key, &
      & text_key, wanted
   use vcor_case_case, only : entry_t
   use vcor_case_name, only : control_in
   use vcor_interval, only : contains_number, is_computable
   use vcor_text, only : integer_text, is_utf8, lower, quoted, real_text, shortened
   use vcor_words, only : contains_word, nearest_name, spelled
   implicit none
   private

   public :: convert, convert_text, range_message

   !> Most numbers of a list
   integer, parameter :: longest_list = 1000000
   !> Longest text [bytes]
   integer, parameter :: longest_text = 4096
   character(len=*), parameter :: digits = "0123456789"

contains

   !> Convert the values of a statement
   subroutine convert(key, text, values, entry, message)
      !> The key
      type(key_t), intent(in) :: key
      !> The text the values stand in
      character(len=*), intent(in) :: text
      !> The values, shape (n), n >= 1
      type(value_t), intent(in) :: values(:)
      !> Entry whose value is set
      type(entry_t), intent(inout) :: entry
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      if (any(values%repeats < 1)) then
         message = "found a repeat count that is not a positive number, expected such as 3*1.0"
      else if (key%value_kind == list_key) then
         call convert_list(key, text, values, entry%list, message)
      else if (size(values) > 1 .or. values(1)%repeats > 1) then
         message = too_many(key, text, values)
      else
         call convert_one(key, text, values(1), entry, message)
      end if
      if (allocated(message)) return
      entry%given = .true.
      entry%present = .true.
   end subroutine convert

   !> Convert the value of a command line option, where a text may stand without quotes
   subroutine convert_text(key, text, entry, message)
      !> The key
      type(key_t), intent(in) :: key
      !> The value or values
      character(len=*), intent(in) :: text
      !> Entry whose value is set
      type(entry_t), intent(inout) :: entry
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      type(token_t), allocatable :: tokens(:)
      type(value_t), allocatable :: values(:)
      character(len=:), allocatable :: quotes
      integer :: last, line

      quotes = text
      if (key%value_kind == text_key .and. scan(text, "'""") /= 1) quotes = quoted(text)
      call scan_text(quotes, tokens)
      call values_of(quotes, tokens, 1, values, last, line, message)
      if (allocated(message)) return
      if (size(values) == 0 .or. tokens(last+1)%category /= end_token) then
         message = "found '"//shortened(text)//"', expected "//wanted(key)
         return
      end if
      call convert(key, quotes, values, entry, message)
   end subroutine convert_text

   !> Convert the one value of a key that is not a list
   subroutine convert_one(key, text, value, entry, message)
      !> The key
      type(key_t), intent(in) :: key
      !> The text the value stands in
      character(len=*), intent(in) :: text
      !> The value
      type(value_t), intent(in) :: value
      !> Entry whose value is set
      type(entry_t), intent(inout) :: entry
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      associate (word => text(value%first:value%last))
         if (key%value_kind /= text_key .and. value%in_quotes) then
            message = "found a text in quotes, "//shortened(word)//", expected "//wanted(key)
            return
         end if
         select case (key%value_kind)
         case (real_key)
            call read_real(word, wanted(key), entry%number, message)
         case (integer_key)
            call convert_integer(key, word, entry%number, message)
         case (logical_key)
            call convert_logical(word, entry%number, message)
         case default
            call convert_string(key, word, value%in_quotes, entry%text, message)
         end select
      end associate
   end subroutine convert_one

   !> Convert a list of numbers
   subroutine convert_list(key, text, values, list, message)
      !> The key
      type(key_t), intent(in) :: key
      !> The text the values stand in
      character(len=*), intent(in) :: text
      !> The values, shape (n), n >= 1
      type(value_t), intent(in) :: values(:)
      !> The numbers, shape (sum of the repeat counts)
      real(wp), allocatable, intent(inout) :: list(:)
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      character(len=:), allocatable :: expected
      real(wp) :: number
      integer :: i, n

      expected = wanted(key)
      n = 0
      do i = 1, size(values)
         if (values(i)%repeats > longest_list - n) then
            message = "found more than "//integer_text(longest_list)//" numbers"
            return
         end if
         n = n + values(i)%repeats
      end do
      if (allocated(list)) deallocate(list)
      allocate(list(n))
      n = 0
      do i = 1, size(values)
         associate (word => text(values(i)%first:values(i)%last))
            if (values(i)%in_quotes) then
               message = "found a text in quotes, "//shortened(word)//", expected "//expected
            else
               call read_real(word, expected, number, message)
            end if
         end associate
         if (allocated(message)) return
         list(n+1:n+values(i)%repeats) = number
         n = n + values(i)%repeats
      end do
   end subroutine convert_list

   !> Convert an integer
   subroutine convert_integer(key, word, number, message)
      !> The key, for what is expected
      type(key_t), intent(in) :: key
      !> The integer as it is written
      character(len=*), intent(in) :: word
      !> The integer
      real(wp), intent(out) :: number
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      integer :: first, status, whole

      number = 0.0_wp
      first = 1
      if (scan(word, "+-") == 1) first = 2
      status = 1
      if (len(word) >= first .and. verify(word(first:), digits) == 0) &
         & read(word, *, iostat=status) whole
      if (status == 0) then
         number = real(whole, wp)
      else
         message = "found '"//shortened(word)//"', expected "//wanted(key)
      end if
   end subroutine convert_integer

   !> Convert a logical
   subroutine convert_logical(word, flag, message)
      !> The logical as it is written
      character(len=*), intent(in) :: word
      !> 1 for true, 0 for false
      real(wp), intent(out) :: flag
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      flag = 0.0_wp
      ! Fortran takes anything that begins with t or f, `false_start` and `tru` too
      select case (lower(word))
      case ("t", "true", ".t.", ".true.", ".t", ".true")
         flag = 1.0_wp
      case ("f", "false", ".f.", ".false.", ".f", ".false")
         flag = 0.0_wp
      case default
         message = "found '"//shortened(word)//"', expected .true. or .false."
      end select
   end subroutine convert_logical

   !> Convert a text
   subroutine convert_string(key, word, in_quotes, string, message)
      !> The key, for what is expected
      type(key_t), intent(in) :: key
      !> The text as it is written
      character(len=*), intent(in) :: word
      !> Whether it is in quotes
      logical, intent(in) :: in_quotes
      !> The text without quotes; a choice as the catalogue has it
      character(len=:), allocatable, intent(inout) :: string
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      if (.not. in_quotes) then
         message = "found "//shortened(word)//" without quotes, expected "//shortened(quoted(word))
         return
      end if
      string = without_quotes(word)
      if (key%choices /= "") string = spelled(key%choices, trim(adjustl(string)))
      if (.not. is_utf8(string)) then
         message = "found a text that is not UTF-8, '"//shortened(string)//"'"
      else if (control_in(string) /= "") then
         message = "found "//control_in(string)//" in '"//shortened(string) &
            & //"', expected a text that can be read on one line"
      else if (len(string) > longest_text) then
         message = "found a text of "//integer_text(len(string))//" bytes, expected at most " &
            & //integer_text(longest_text)
      end if
   end subroutine convert_string

   !> A text without its quotes, and each doubled quote in it once
   pure function without_quotes(word) result(string)
      !> The text in quotes
      character(len=*), intent(in) :: word
      !> The text
      character(len=:), allocatable :: string
      integer :: i, n

      allocate(character(len=len(word)) :: string)
      n = 0
      i = 2
      do while (i < len(word))
         n = n + 1
         string(n:n) = word(i:i)
         if (word(i:i) == word(1:1)) i = i + 1
         i = i + 1
      end do
      string = string(:n)
   end function without_quotes

   !> What to say about more than one value where one is expected
   pure function too_many(key, text, values) result(message)
      !> The key
      type(key_t), intent(in) :: key
      !> The text the values stand in
      character(len=*), intent(in) :: text
      !> The values, shape (n), n >= 1
      type(value_t), intent(in) :: values(:)
      !> The message
      character(len=:), allocatable :: message, value
      integer :: n, i, shown_values
      integer, parameter :: most_shown = 8

      n = size(values)
      if (n == 1) then
         ! meant as arithmetic, which a namelist has not
         value = shortened(text(values(1)%first:values(1)%last))
         message = integer_text(values(1)%repeats)
         message = "found more than one value: "//message//"*"//value//" is no product but " &
            & //value//" given "//message//" times, expected "//wanted(key)
         return
      end if
      shown_values = min(n, most_shown)
      message = "found more than one value, '" &
         & //shortened(text(values(1)%first:values(shown_values)%last))
      if (shown_values < n) message = message//" ..."
      message = message//"', expected "//wanted(key)
      if (key%value_kind /= real_key .or. n /= 2) return
      i = values(1)%last + 1
      if (i + 1 /= values(2)%first) return
      if (text(i:i) == "," .and. verify(text(values(1)%last:values(1)%last), digits) == 0) &
         & message = message//" (with a decimal point, not a comma)"
   end function too_many

   !> What is wrong with the value of an entry, as far as its range says
   pure function range_message(key, entry) result(message)
      !> The key, of the model of the entry's item
      type(key_t), intent(in) :: key
      !> The entry
      type(entry_t), intent(in) :: entry
      !> Found and expected; empty when nothing is wrong
      character(len=:), allocatable :: message
      character(len=:), allocatable :: near
      integer :: i

      message = ""
      near = ""
      select case (key%value_kind)
      case (real_key)
         if (.not. contains_number(key%range, entry%number)) message = real_text(entry%number)
      case (integer_key)
         if (.not. contains_number(key%range, entry%number)) &
            & message = integer_text(nint(entry%number))
      case (list_key)
         do i = 1, size(entry%list)
            if (contains_number(key%range, entry%list(i))) cycle
            message = real_text(entry%list(i))//" in value "//integer_text(i)
            exit
         end do
      case (text_key)
         if (key%choices /= "" .and. .not. contains_word(key%choices, entry%text)) then
            message = "'"//shortened(entry%text)//"'"
            ! a single letter is near to every other
            if (len_trim(entry%text) > 1) near = nearest_name(entry%text, trim(key%choices))
         else if (entry%text == "" .and. key%default /= "''") then
            message = "an empty text"
         end if
      case default
         continue
      end select
      if (message /= "") message = "found "//message//", expected "//wanted(key)
      if (message /= "" .and. key%value_kind == real_key) then
         if (.not. is_computable(entry%number)) message = message//", between 1e-60 and 1e60 in " &
            & //"magnitude: beyond that nothing can be computed"
      end if
      if (near /= "") message = message//"; did you mean '"//near//"'?"
   end function range_message

end module vcor_case_values
