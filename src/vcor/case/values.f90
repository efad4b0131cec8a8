!> Conversion of written values to the kind of a key, and the check of their ranges
module vcor_case_values
   use vcor_case_catalogue, only : integer_key, key_t, list_key, logical_key, real_key, text_key, &
      wanted
   use vcor_case_entries, only : entry_t
   use vcor_case_namelist, only : literal_t, values_in
   use vcor_number, only : contains_number, is_computable, looks_numeric, read_real, real_text
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, lower, quoted, shortened, text_flaw
   use vcor_words, only : contains_word, nearest_name, spelled
   implicit none
   private

   public :: convert, convert_text, range_message

   !> Largest length of a list
   integer, parameter :: longest_list = 1000000
   character(len=*), parameter :: digits = '0123456789'

   !> First bytes of typographic quotes in UTF-8
   character(len=*), parameter :: curly = char(226)//char(128)

contains

   !> Convert the value of a command line option, in which a text needs no quotes
   subroutine convert_text(key, text, entry, message)
      type(key_t), intent(in) :: key
      !> The value or values
      character(len=*), intent(in) :: text
      !> Entry to set
      type(entry_t), intent(inout) :: entry
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      type(literal_t), allocatable :: values(:)
      character(len=:), allocatable :: quotes

      quotes = text
      if (key%value_kind == text_key .and. scan(text, "'""") /= 1) quotes = quoted(text)
      call values_in(quotes, values, message)
      if (message == '' .and. size(values) == 0) &
         message = "found '"//shortened(text)//"', expected "//wanted(key)
      if (message == '') call convert(key, quotes, values, entry, message)
   end subroutine convert_text

   !> Convert the values of a statement
   subroutine convert(key, text, values, entry, message)
      type(key_t), intent(in) :: key
      !> Text with the values
      character(len=*), intent(in) :: text
      !> The values, shape (n), n >= 1
      type(literal_t), intent(in) :: values(:)
      !> Entry to set
      type(entry_t), intent(inout) :: entry
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      integer :: odd

      ! the first value with quotes that it should not have, or without those that it needs
      odd = findloc(values%in_quotes .neqv. key%value_kind == text_key, .true., dim=1)
      if (any(values%repeats < 1)) then
         message = 'found a repeat count that is not a positive number, expected such as 3*1.0'
      else if (key%value_kind /= list_key .and. (size(values) > 1 .or. values(1)%repeats > 1)) then
         message = too_many(key, text, values)
      else if (odd > 0) then
         associate (word => text(values(odd)%first:values(odd)%last))
            message = 'found a text in quotes, '//shortened(word)//', expected '//wanted(key)
            if (key%value_kind == text_key) message = 'found '//shortened(word) &
               //' without quotes, expected '//shortened(quoted(word))
            ! in UTF-8 these quotes have three bytes, which begin with the same two
            if (index(word, curly) == 1 .and. len(word) > 6) message = 'found curly quotes, ' &
               //shortened(word)//', expected straight ones, ' &
               //shortened(quoted(word(4:len(word) - 3)))
         end associate
      else
         associate (word => text(values(1)%first:values(1)%last))
            select case (key%value_kind)
            case (real_key)
               call read_real(word, wanted(key), entry%number, message)
               if (allocated(message)) message = message//unit_behind(key, word)
            case (integer_key)
               call convert_integer(key, word, entry%number, message)
            case (logical_key)
               call convert_logical(word, entry%number, message)
            case (list_key)
               call convert_list(key, text, values, entry%list, message)
            case default
               call convert_string(key, word, entry%text, message)
            end select
         end associate
      end if
      if (allocated(message)) return
      entry%given = .true.
      entry%present = .true.
   end subroutine convert

   !> Convert a list of numbers
   subroutine convert_list(key, text, values, list, message)
      type(key_t), intent(in) :: key
      !> Text with the values
      character(len=*), intent(in) :: text
      !> The values, shape (n), n >= 1
      type(literal_t), intent(in) :: values(:)
      !> The numbers, shape (sum of the repeat counts)
      real(wp), allocatable, intent(inout) :: list(:)
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      character(len=:), allocatable :: expected
      real(wp) :: number
      integer :: i, n

      if (sum(real(values%repeats, wp)) > real(longest_list, wp)) then
         message = 'found more than '//integer_text(longest_list)//' numbers'
         return
      end if
      if (allocated(list)) deallocate (list)
      allocate (list(sum(values%repeats)))
      expected = wanted(key)
      n = 0
      do i = 1, size(values)
         associate (word => text(values(i)%first:values(i)%last), before => values(max(1, i - 1)))
            call read_real(word, expected, number, message)
            if (allocated(message)) message = message//unit_behind(key, word) &
               //unit_hint(key, text(before%first:before%last), word)
         end associate
         if (allocated(message)) return
         list(n + 1:n + values(i)%repeats) = number
         n = n + values(i)%repeats
      end do
   end subroutine convert_list

   !> Convert an integer
   subroutine convert_integer(key, word, number, message)
      !> The key, for the message
      type(key_t), intent(in) :: key
      !> The integer as written
      character(len=*), intent(in) :: word
      real(wp), intent(out) :: number
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      integer :: first, status, whole

      number = 0.0_wp
      first = 1
      if (scan(word, '+-') == 1) first = 2
      status = 1
      if (len(word) >= first .and. verify(word(first:), digits) == 0) &
         read (word, *, iostat=status) whole
      if (status == 0) then
         number = real(whole, wp)
      else
         message = "found '"//shortened(word)//"', expected "//wanted(key)
      end if
   end subroutine convert_integer

   !> Convert a logical
   subroutine convert_logical(word, flag, message)
      !> The logical as written
      character(len=*), intent(in) :: word
      !> 1 for true, 0 for false
      real(wp), intent(out) :: flag
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      flag = 0.0_wp
      ! Fortran accepts anything that begins with t or f, even `false_start` and `tru`
      select case (lower(word))
      case ('t', 'true', '.t.', '.true.', '.t', '.true')
         flag = 1.0_wp
      case ('f', 'false', '.f.', '.false.', '.f', '.false')
         flag = 0.0_wp
      case default
         message = "found '"//shortened(word)//"', expected .true. or .false."
      end select
   end subroutine convert_logical

   !> Convert a text
   subroutine convert_string(key, word, string, message)
      !> The key, for its choices
      type(key_t), intent(in) :: key
      !> The text in quotes, with quotes inside doubled
      character(len=*), intent(in) :: word
      !> The text without quotes; a choice as the catalogue spells it
      character(len=:), allocatable, intent(inout) :: string
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      integer :: i, n

      string = word
      n = 0
      i = 2
      do while (i < len(word))
         n = n + 1
         string(n:n) = word(i:i)
         if (word(i:i) == word(1:1)) i = i + 1
         i = i + 1
      end do
      string = string(:n)
      if (key%choices /= '') string = spelled(key%choices, trim(adjustl(string)))
      if (text_flaw(string) /= '') message = text_flaw(string)
   end subroutine convert_string

   !> Message about several values for a key that takes one
   pure function too_many(key, text, values) result(message)
      type(key_t), intent(in) :: key
      !> Text with the values
      character(len=*), intent(in) :: text
      !> The values, shape (n), n >= 1
      type(literal_t), intent(in) :: values(:)
      character(len=:), allocatable :: message

      integer, parameter :: most_shown = 8
      integer :: n

      n = min(size(values), most_shown)
      associate (first => text(values(1)%first:values(1)%last), last => values(n)%last)
         message = 'found more than one value'
         if (n == 1) then
            ! meant as a product, which namelists do not have
            message = message//': '//integer_text(values(1)%repeats)//'*'//shortened(first) &
               //' is not a product but '//shortened(first)//' given ' &
               //integer_text(values(1)%repeats)//' times, expected '//wanted(key)
            return
         end if
         message = message//", '"//shortened(text(values(1)%first:last))
         if (n < size(values)) message = message//' ...'
         message = message//"', expected "//wanted(key)
         if (key%value_kind /= real_key .or. size(values) /= 2) return
         message = message//unit_hint(key, first, text(values(2)%first:last))
         n = values(1)%last + 1
         if (text(n:n) == ',' .and. values(2)%first == n + 1 .and. verify(first, digits) == 0) &
            message = message//' (with a decimal point, not a comma)'
      end associate
   end function too_many

   !> Hint for a word that is a number with a unit
   pure function unit_behind(key, word) result(hint)
      type(key_t), intent(in) :: key
      !> Such as `70GPa`
      character(len=*), intent(in) :: word
      !> Such as `; give 70e9, in Pa`; empty for any other word
      character(len=:), allocatable :: hint

      integer :: last

      last = scan(word, digits//'.', back=.true.)
      hint = unit_hint(key, word(:last), word(last + 1:))
   end function unit_behind

   !> Hint for a number with a unit
   pure function unit_hint(key, number, unit) result(hint)
      type(key_t), intent(in) :: key
      !> The number as written
      character(len=*), intent(in) :: number
      !> Text after it
      character(len=*), intent(in) :: unit
      !> Such as `; give 70e9, in Pa`; empty if it is not a unit of the key
      character(len=:), allocatable :: hint

      character(len=*), parameter :: prefixes = 'numckMGT'
      integer, parameter :: powers(*) = [-9, -6, -3, -2, 3, 6, 9, 12]
      real(wp) :: celsius
      integer :: place

      hint = ''
      if (.not. looks_numeric(number) .or. len(unit) == 0 .or. key%unit == '') return
      if (key%unit == 'K' .and. any(unit == [character(len=4) :: 'C', '°C', 'oC', 'degC'])) then
         read (number, *, iostat=place) celsius
         if (place == 0) hint = '; '//shortened(number)//' C is ' &
            //real_text(anint(100.0_wp*celsius + 27315.0_wp)/100.0_wp)//' K'
         return
      end if
      place = index(prefixes, unit(1:1))
      if (unit == key%unit .or. index(key%unit, unit//'/') == 1) then
         hint = number
      else if (place > 0 .and. unit(2:) == key%unit .and. scan(number, 'eEdD') == 0) then
         hint = number//'e'//integer_text(powers(place))
      end if
      if (hint /= '') hint = '; give '//shortened(hint)//', in '//trim(key%unit)
   end function unit_hint

   !> Message about a value out of range
   pure function range_message(key, entry) result(message)
      !> Row of the key for the model of the entry's item
      type(key_t), intent(in) :: key
      type(entry_t), intent(in) :: entry
      !> Found and expected; empty if the value is in range
      character(len=:), allocatable :: message

      integer :: i

      message = ''
      select case (key%value_kind)
      case (real_key)
         if (.not. contains_number(key%range, entry%number)) message = real_text(entry%number)
      case (integer_key)
         if (.not. contains_number(key%range, entry%number)) &
            message = integer_text(nint(entry%number))
      case (list_key)
         do i = size(entry%list), 1, -1
            if (.not. contains_number(key%range, entry%list(i))) &
               message = real_text(entry%list(i))//' in value '//integer_text(i)
         end do
      case (text_key)
         if (key%choices /= '' .and. .not. contains_word(key%choices, entry%text)) then
            message = "'"//shortened(entry%text)//"'"
         else if (entry%text == '' .and. key%default /= "''") then
            message = 'an empty text'
         end if
      case default
         continue
      end select
      if (message == '') return
      message = 'found '//message//', expected '//wanted(key)
      if (key%value_kind == real_key) then
         if (key%unit == 'K' .and. entry%number > -273.15_wp) message = message//'; ' &
            //real_text(entry%number)//' C is ' &
            //real_text(anint(100.0_wp*entry%number + 27315.0_wp)/100.0_wp)//' K'
         if (.not. is_computable(entry%number)) message = message//', between 1e-60 and 1e60 in ' &
            //'magnitude: outside of that nothing can be computed'
      else if (key%choices /= '' .and. len_trim(entry%text) > 1) then
         ! a single letter is near any other
         if (nearest_name(entry%text, trim(key%choices)) /= '') message = message &
            //"; did you mean '"//nearest_name(entry%text, trim(key%choices))//"'?"
      end if
   end function range_message

end module vcor_case_values
