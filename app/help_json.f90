!> Everything that the program knows about its commands, its input and its output as one JSON
!> document: what `vcor help --json` prints, and what scripts/manual.py makes the manual of
module vcor_app_help_json
   use vcor_app_commands, only : commands, entry_t, get_page, options_of, texts_of
   use vcor_app_help, only : screen_meanings, screen_words
   use vcor_case_catalogue, only : described_keys, groups, integer_key, key_t, kind_name, &
      logical_key, real_key, text_key
   use vcor_interval, only : interval_text
   use vcor_error, only : code_meanings, code_names
   use vcor_sweep_quantity, only : history_quantities, quantities, quantity_t, statuses
   use vcor_text, only : integer_text
   use vcor_version, only : version
   implicit none
   private

   public :: help_json

   !> End of a line
   character(len=*), parameter :: nl = new_line("a")

contains

   !> The document
   function help_json() result(text)
      !> JSON, UTF-8, ends with a line feed
      character(len=:), allocatable :: text

      type(key_t), allocatable :: rows(:)
      character(len=:), allocatable :: list, words
      integer :: i, j, first, last

      allocate (rows, source=described_keys())
      text = "{"//member("program", "vcor")//", "//member("version", version)//","//nl

      words = ""
      first = 1
      do while (first <= len(commands))
         last = first - 2 + index(commands(first:)//" ", " ")
         call add(words, command_object(commands(first:last)))
         first = last + 2
      end do
      text = text//array("commands", words)//","//nl

      words = ""
      do i = 1, size(groups)
         list = ""
         do j = 1, size(rows)
            if (rows(j)%group == groups(i)%name) call add(list, key_object(rows(j)))
         end do
         call add(words, "{"//member("name", groups(i)%name)//", " &
            //member("meaning", groups(i)%meaning)//", "//flag("required", groups(i)%required) &
            //", "//flag("repeated", groups(i)%repeated)//", " &
            //member("label", groups(i)%label)//", "//member("selector", groups(i)%selector) &
            //","//nl//array("keys", list)//"}")
      end do
      text = text//array("groups", words)//","//nl

      text = text//array("summary", columns(quantities()))//","//nl
      text = text//array("history", columns(history_quantities))//","//nl

      words = ""
      do i = 1, size(statuses)
         call add(words, "{"//member("name", statuses(i)%name)//", " &
            //member("meaning", statuses(i)%meaning)//", " &
            //member("advice", statuses(i)%advice)//"}")
      end do
      text = text//array("statuses", words)//","//nl

      words = ""
      do i = 1, size(screen_words)
         call add(words, "{"//array_of_words("words", screen_words(i))//", " &
            //member("meaning", screen_meanings(i))//"}")
      end do
      text = text//array("screen", words)//","//nl

      words = ""
      do i = lbound(code_names, 1), ubound(code_names, 1)
         call add(words, "{"//"""code"": "//integer_text(i)//", " &
            //member("name", code_names(i))//", "//member("meaning", code_meanings(i))//"}")
      end do
      text = text//array("exit_codes", words)//"}"//nl
   end function help_json

   !> A command: how it is called, what it does, its options
   function command_object(command) result(text)
      !> Its name
      character(len=*), intent(in) :: command
      !> JSON
      character(len=:), allocatable :: text

      type(entry_t), allocatable :: page(:)
      character(len=:), allocatable :: entries, name
      integer :: i, mark

      call get_page(command, page)
      entries = ""
      do i = 1, size(page)
         mark = index(page(i)%term//" ", " ")
         name = page(i)%term(:mark - 1)
         if (name == "") then
            call add(entries, "{"//member("text", page(i)%text)//"}")
         else if (index(name, "--") == 1) then
            call add(entries, "{"//member("option", name)//", " &
               //member("value", page(i)%term(mark:))//", "//member("text", page(i)%text)//"}")
         else if (all(name /= ["usage  ", "summary", "example"])) then
            call add(entries, "{"//member("term", page(i)%term)//", " &
               //member("text", page(i)%text)//"}")
         end if
      end do
      associate (summaries => texts_of(command, "summary"))
         text = "{"//member("name", command)//", "//member("summary", summaries(1))//","//nl &
            //array("usage", strings(texts_of(command, "usage")))//","//nl &
            //array("examples", strings(texts_of(command, "example")))//","//nl &
            //array_of_words("options", options_of(command))//","//nl &
            //array("page", entries)//"}"
      end associate
   end function command_object

   !> A key of a group
   function key_object(key) result(text)
      !> The key
      type(key_t), intent(in) :: key
      !> JSON
      character(len=:), allocatable :: text

      text = "{"//member("name", key%name)//", "//member("type", type_name(key%value_kind)) &
         //", "//member("value", kind_name(key%value_kind))//", "//member("meaning", key%meaning) &
         //", "//member("unit", key%unit)
      text = text//", "//member("range", interval_text(key%range))//", " &
         //array_of_words("choices", key%choices)//", "//array_of_words("models", key%models) &
         //", "//flag("required", key%required)
      if (key%instead /= "") text = text//", "//member("instead", key%instead)
      if (key%default == "''") then
         text = text//", "//member("default", "")
      else if (key%default /= "") then
         text = text//", "//member("default", key%default)
      end if
      text = text//"}"
   end function key_object

   !> Name of the type of a key
   pure function type_name(value_kind) result(name)
      !> One of the `*_key` constants
      integer, intent(in) :: value_kind
      !> real, integer, logical, text, or list: one or more reals
      character(len=:), allocatable :: name

      select case (value_kind)
      case (real_key)
         name = "real"
      case (integer_key)
         name = "integer"
      case (logical_key)
         name = "logical"
      case (text_key)
         name = "text"
      case default
         name = "list"
      end select
   end function type_name

   !> Columns of a file
   function columns(list) result(text)
      !> The columns
      type(quantity_t), intent(in) :: list(:)
      !> Objects with commas between them
      character(len=:), allocatable :: text

      integer :: i

      text = ""
      do i = 1, size(list)
         call add(text, column_object(list(i)))
      end do
   end function columns

   !> A column of a file
   function column_object(quantity) result(text)
      !> The column
      type(quantity_t), intent(in) :: quantity
      !> JSON
      character(len=:), allocatable :: text

      text = "{"//member("name", quantity%name)//", "//member("symbol", quantity%symbol)//", " &
         //member("unit", quantity%unit)//", "//member("meaning", quantity%meaning)//"}"
   end function column_object

   !> Append an element to a list
   subroutine add(list, element)
      !> Elements with commas between them
      character(len=:), allocatable, intent(inout) :: list
      !> JSON
      character(len=*), intent(in) :: element

      if (list /= "") list = list//","//nl
      list = list//element
   end subroutine add

   !> Texts as elements of a list
   function strings(texts) result(list)
      !> Texts
      character(len=*), intent(in) :: texts(:)
      !> Strings with commas between them
      character(len=:), allocatable :: list

      integer :: i

      list = ""
      do i = 1, size(texts)
         call add(list, quoted(texts(i)))
      end do
   end function strings

   !> A member whose value is a list
   pure function array(name, list) result(text)
      !> Name
      character(len=*), intent(in) :: name
      !> Elements with commas between them
      character(len=*), intent(in) :: list
      !> JSON
      character(len=:), allocatable :: text

      text = quoted(name)//": ["//list//"]"
   end function array

   !> A member whose value is a list of words
   function array_of_words(name, words) result(text)
      !> Name
      character(len=*), intent(in) :: name
      !> Words separated by blanks
      character(len=*), intent(in) :: words
      !> JSON
      character(len=:), allocatable :: text

      integer :: i

      text = ""
      do i = 1, len_trim(words)
         if (words(i:i) == " ") then
            if (text /= "") text = text//""", """
         else
            text = text//words(i:i)
         end if
      end do
      if (text /= "") text = """"//text//""""
      text = array(name, text)
   end function array_of_words

   !> A member whose value is a text
   pure function member(name, value) result(text)
      !> Name
      character(len=*), intent(in) :: name
      !> Value
      character(len=*), intent(in) :: value
      !> JSON
      character(len=:), allocatable :: text

      text = quoted(name)//": "//quoted(value)
   end function member

   !> A member whose value is true or false
   pure function flag(name, value) result(text)
      !> Name
      character(len=*), intent(in) :: name
      !> Value
      logical, intent(in) :: value
      !> JSON
      character(len=:), allocatable :: text

      text = quoted(name)//": "//trim(merge("true ", "false", value))
   end function flag

   !> A text as a string of JSON
   pure function quoted(words) result(text)
      !> Text without control characters; blanks at its ends do not count
      character(len=*), intent(in) :: words
      !> The same in quotes
      character(len=:), allocatable :: text

      integer :: i

      text = """"
      do i = 1, len_trim(words)
         if (index("""\", words(i:i)) > 0) text = text//"\"
         if (i > 1 .or. words(i:i) /= " ") text = text//words(i:i)
      end do
      text = text//""""
   end function quoted

end module vcor_app_help_json
