!> Everything that the program knows about its commands, its input and its output as one JSON
!> document: what `vcor help --json` prints, and what scripts/manual.py makes the manual of
module vcor_app_help_json
   use vcor_app_commands, only : commands, entry_t, get_page, options_of, package_commands, &
      texts_of
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

   !> The document, UTF-8
   function help_json() result(text)
      character(len=:), allocatable :: text

      character(len=:), allocatable :: list
      integer :: i, first, last

      text = "{"//member("program", "vcor")//", "//member("version", version)//","//nl

      list = ""
      first = 1
      do while (first <= len(commands))
         last = first - 2 + index(commands(first:)//" ", " ")
         call add(list, command_object(commands(first:last)))
         first = last + 2
      end do
      text = text//array("commands", list)//","//nl

      list = ""
      do i = 1, size(package_commands)
         call add(list, "{"//member("name", package_commands(i)%term)//", " &
            //member("summary", package_commands(i)%text)//"}")
      end do
      text = text//array("package_commands", list)//","//nl

      list = ""
      do i = 1, size(groups)
         associate (group => groups(i))
            call add(list, "{"//member("name", group%name)//", "//member("meaning", group%meaning) &
               //", "//flag("required", group%required)//", "//flag("repeated", group%repeated) &
               //", "//member("label", group%label)//", "//member("selector", group%selector) &
               //","//nl//array("keys", keys_of(group%name))//"}")
         end associate
      end do
      text = text//array("groups", list)//","//nl
      text = text//array("summary", columns(quantities()))//","//nl
      text = text//array("history", columns(history_quantities))//","//nl

      list = ""
      do i = 1, size(statuses)
         call add(list, "{"//member("name", statuses(i)%name)//", " &
            //member("meaning", statuses(i)%meaning)//", " &
            //member("advice", statuses(i)%advice)//"}")
      end do
      text = text//array("statuses", list)//","//nl

      list = ""
      do i = 1, size(screen_words)
         call add(list, "{"//array_of_words("words", screen_words(i))//", " &
            //member("meaning", screen_meanings(i))//"}")
      end do
      text = text//array("screen", list)//","//nl

      list = ""
      do i = lbound(code_names, 1), ubound(code_names, 1)
         call add(list, "{"//"""code"": "//integer_text(i)//", " &
            //member("name", code_names(i))//", "//member("meaning", code_meanings(i))//"}")
      end do
      text = text//array("exit_codes", list)//"}"//nl
   end function help_json

   !> A command: how it is called, what it does, its options
   function command_object(command) result(text)
      character(len=*), intent(in) :: command
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

   !> The keys of a group
   function keys_of(group) result(list)
      character(len=*), intent(in) :: group
      character(len=:), allocatable :: list

      type(key_t), allocatable :: rows(:)
      character(len=:), allocatable :: text
      integer :: i

      allocate (rows, source=described_keys())
      list = ""
      do i = 1, size(rows)
         associate (key => rows(i))
            if (key%group /= group) cycle
            text = "{"//member("name", key%name)//", "//member("type", type_name(key%value_kind)) &
               //", "//member("value", kind_name(key%value_kind))//", " &
               //member("meaning", key%meaning)//", "//member("unit", key%unit)//", " &
               //member("range", interval_text(key%range))//", " &
               //array_of_words("choices", key%choices)//", " &
               //array_of_words("models", key%models)//", "//flag("required", key%required)
            if (key%default == "''") then
               text = text//", "//member("default", "")
            else if (key%default /= "") then
               text = text//", "//member("default", key%default)
            end if
            if (key%instead /= "") text = text//", "//member("instead", key%instead)
            call add(list, text//"}")
         end associate
      end do
   end function keys_of

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
   function columns(quantities) result(list)
      type(quantity_t), intent(in) :: quantities(:)
      character(len=:), allocatable :: list

      integer :: i

      list = ""
      do i = 1, size(quantities)
         associate (quantity => quantities(i))
            call add(list, "{"//member("name", quantity%name)//", " &
               //member("symbol", quantity%symbol)//", "//member("unit", quantity%unit)//", " &
               //member("meaning", quantity%meaning)//"}")
         end associate
      end do
   end function columns

   !> Append an element to a list, which is elements with commas between them
   subroutine add(list, element)
      character(len=:), allocatable, intent(inout) :: list
      character(len=*), intent(in) :: element

      if (list /= "") list = list//","//nl
      list = list//element
   end subroutine add

   !> Texts as a list of strings
   function strings(texts) result(list)
      character(len=*), intent(in) :: texts(:)
      character(len=:), allocatable :: list

      integer :: i

      list = ""
      do i = 1, size(texts)
         call add(list, quoted(texts(i)))
      end do
   end function strings

   !> A member whose value is a list
   pure function array(name, list) result(text)
      character(len=*), intent(in) :: name, list
      character(len=:), allocatable :: text

      text = quoted(name)//": ["//list//"]"
   end function array

   !> A member whose value is a list of words, given with single blanks between them
   pure function array_of_words(name, words) result(text)
      character(len=*), intent(in) :: name, words
      character(len=:), allocatable :: text

      integer :: i

      text = ""
      do i = 1, len_trim(words)
         if (words(i:i) /= " ") then
            text = text//words(i:i)
         else if (text /= "") then
            text = text//""", """
         end if
      end do
      if (text /= "") text = """"//text//""""
      text = array(name, text)
   end function array_of_words

   !> A member whose value is a text
   pure function member(name, value) result(text)
      character(len=*), intent(in) :: name, value
      character(len=:), allocatable :: text

      text = quoted(name)//": "//quoted(value)
   end function member

   !> A member whose value is true or false
   pure function flag(name, value) result(text)
      character(len=*), intent(in) :: name
      logical, intent(in) :: value
      character(len=:), allocatable :: text

      text = quoted(name)//": "//trim(merge("true ", "false", value))
   end function flag

   !> A text as a string of JSON
   pure function quoted(words) result(text)
      !> Text without control characters; blanks at its ends do not count
      character(len=*), intent(in) :: words
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
