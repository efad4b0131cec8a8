!> Everything that the program knows about its commands, its input and its output as one JSON
!> document: what `vcor help --json` prints, and what scripts/manual.py makes the manual of
module vcor_app_help_json
   use vcor_app_commands, only : command_count, commands, entry_t, get_page, options_of, &
      package_commands, texts_of
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
      character(len=8) :: names(command_count)
      integer :: i

      text = member("program", "vcor")//member("version", version)
      list = commands
      read (list, *) names
      list = ""
      do i = 1, size(names)
         list = list//command_object(trim(names(i)))
      end do
      text = text//array("commands", list)
      list = ""
      do i = 1, size(package_commands)
         list = list//object(member("name", package_commands(i)%term) &
            //member("summary", package_commands(i)%text))
      end do
      text = text//array("package_commands", list)
      list = ""
      do i = 1, size(groups)
         associate (group => groups(i))
            list = list//object(member("name", group%name)//member("meaning", group%meaning) &
               //flag("required", group%required)//flag("repeated", group%repeated) &
               //member("label", group%label)//member("selector", group%selector) &
               //array("keys", keys_of(group%name)))
         end associate
      end do
      text = text//array("groups", list)//array("summary", columns(quantities())) &
         //array("history", columns(history_quantities))
      list = ""
      do i = 1, size(statuses)
         list = list//object(member("name", statuses(i)%name) &
            //member("meaning", statuses(i)%meaning)//member("advice", statuses(i)%advice))
      end do
      text = text//array("statuses", list)
      list = ""
      do i = 1, size(screen_words)
         list = list//object(words("words", screen_words(i))//member("meaning", screen_meanings(i)))
      end do
      text = text//array("screen", list)
      list = ""
      do i = lbound(code_names, 1), ubound(code_names, 1)
         list = list//object("""code"": "//integer_text(i)//", "//member("name", code_names(i)) &
            //member("meaning", code_meanings(i)))
      end do
      text = object(text//array("exit_codes", list))
      text = text(:len(text) - 2)//nl
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
            entries = entries//object(member("text", page(i)%text))
         else if (index(name, "--") == 1) then
            entries = entries//object(member("option", name) &
               //member("value", page(i)%term(mark:))//member("text", page(i)%text))
         else if (all(name /= ["usage  ", "summary", "example"])) then
            entries = entries//object(member("term", page(i)%term)//member("text", page(i)%text))
         end if
      end do
      associate (summaries => texts_of(command, "summary"))
         text = object(member("name", command)//member("summary", summaries(1)) &
            //array("usage", strings(texts_of(command, "usage"))) &
            //array("examples", strings(texts_of(command, "example"))) &
            //words("options", options_of(command))//array("page", entries))
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
            text = member("name", key%name)//member("type", type_name(key%value_kind)) &
               //member("value", kind_name(key%value_kind))//member("meaning", key%meaning) &
               //member("unit", key%unit)//member("range", interval_text(key%range)) &
               //words("choices", key%choices)//words("models", key%models) &
               //flag("required", key%required)
            if (key%default == "''") then
               text = text//member("default", "")
            else if (key%default /= "") then
               text = text//member("default", key%default)
            end if
            if (key%instead /= "") text = text//member("instead", key%instead)
            list = list//object(text)
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
            list = list//object(member("name", quantity%name)//member("symbol", quantity%symbol) &
               //member("unit", quantity%unit)//member("meaning", quantity%meaning))
         end associate
      end do
   end function columns

   !> Texts as strings. Here as below a comma and one character more end every part
   function strings(texts) result(list)
      character(len=*), intent(in) :: texts(:)
      character(len=:), allocatable :: list

      integer :: i

      list = ""
      do i = 1, size(texts)
         list = list//quoted(texts(i))//", "
      end do
   end function strings

   !> Members as an object
   pure function object(members) result(text)
      character(len=*), intent(in) :: members
      character(len=:), allocatable :: text

      text = "{"//members(:len(members) - 2)//"},"//nl
   end function object

   !> A member whose value is a list
   pure function array(name, list) result(text)
      character(len=*), intent(in) :: name, list
      character(len=:), allocatable :: text

      text = quoted(name)//": ["//list(:max(0, len(list) - 2))//"],"//nl
   end function array

   !> A member whose value is a list of words, given with single blanks between them
   pure function words(name, list) result(text)
      character(len=*), intent(in) :: name, list
      character(len=:), allocatable :: text

      integer :: i

      text = ""
      do i = 1, len_trim(list)
         if (list(i:i) /= " ") then
            text = text//list(i:i)
         else if (text /= "") then
            text = text//""", """
         end if
      end do
      if (text /= "") text = """"//text//""", "
      text = array(name, text)
   end function words

   !> A member whose value is a text
   pure function member(name, value) result(text)
      character(len=*), intent(in) :: name, value
      character(len=:), allocatable :: text

      text = quoted(name)//": "//quoted(value)//", "
   end function member

   !> A member whose value is true or false
   pure function flag(name, value) result(text)
      character(len=*), intent(in) :: name
      logical, intent(in) :: value
      character(len=:), allocatable :: text

      text = quoted(name)//": "//trim(merge("true ", "false", value))//", "
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
