!> Screens of help about commands and about words of input and output
module vcor_app_help
   use vcor_app_commands, only : command_names, commands, part_t, missing_package, &
      package_commands, page_of, texts_of
   use vcor_app_external, only : external_commands
   use vcor_app_screen, only : screen_items
   use vcor_case_catalogue, only : described_keys, groups, key_t, range_text
   use vcor_case_choices, only : choices, topics
   use vcor_error, only : code_names, error_t, error_usage, raise
   use vcor_words, only : contains_word, nearest_name, suggestion
   use vcor_sweep_quantity, only : bounce_quantities, history_quantities, quantities, &
      quantity_names, quantity_t, statuses
   use vcor_text, only : integer_text, printable
   use vcor_version, only : version
   implicit none
   private

   public :: help_text

   !> End of a line
   character(len=*), parameter :: nl = new_line("a")
   !> What the program does not have, of which users ask
   character(len=*), parameter :: not_there = "tangential rolling oblique"
   !> Longest line of a page
   integer, parameter :: width = 86
   !> Column of the meaning of an option, a key or a column
   integer, parameter :: margin = 30

contains

   !> A help page
   subroutine help_text(topic, text, error)
      !> Topic; empty for the overview. It may also be a group, a key or a choice of the input, or a
      !> column or a status of the output
      character(len=*), intent(in) :: topic
      character(len=:), allocatable, intent(out) :: text
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: words

      select case (topic)
      case ("", "help")
         text = overview()
      case ("input")
         text = "A case file holds Fortran namelists, &GROUP KEY = VALUE, ... /, in SI units." &
            //nl//nl//words_page(topic)
      case ("output")
         text = words_page(topic)
      case default
         text = command_page(page_of(topic))
         if (text == "") text = words_page(topic)
         ! NAME.KEY of a material, as the messages about a case have it
         if (text == "" .and. index(topic, ".") > 1) &
            text = words_page("material"//topic(index(topic, ".", back=.true.):))
         if (text /= "") return
         if (missing_package(topic) /= "") then
            call raise(error, error_usage, missing_package(topic))
            return
         end if
         if (contains_word(not_there, topic)) then
            call raise(error, error_usage, "no help on '"//printable(topic)//"': vcor has normal " &
               //"impacts, without friction and spin")
            return
         end if
         if (topic == "hollow") then
            call raise(error, error_usage, "no help on 'hollow': a hollow sphere has its mass in " &
               //"sphere.mass; its contact is that of a solid one")
            return
         end if
         ! too many words to list, but they can be searched for a similar one
         words = commands()//" input output"//all_words()
         if (nearest_name(topic, words) == "") then
            text = suggestion(topic, commands()//" input output") &
               //", or a word of the input or the output"
         else
            text = suggestion(topic, words)
         end if
         call raise(error, error_usage, "no help on '"//printable(topic)//"'; "//text)
      end select
   end subroutine help_text

   !> Overview
   function overview() result(text)
      character(len=:), allocatable :: text

      integer, parameter :: column = 30
      character(len=:), allocatable :: usage, words
      integer :: i, place

      text = "vcor "//version//": coefficient of restitution of viscoelastic impacts"//nl//nl
      do i = 1, size(command_names)
         associate (usages => texts_of(command_names(i), "usage"), &
                    meanings => texts_of(command_names(i), "summary"))
            usage = trim(usages(1))
            usage = usage(:index(usage//" [options]", " [options]") - 1)
            text = text//merge("usage: ", "       ", i == 1)//usage &
               //repeat(" ", max(1, column - len(usage)))//trim(meanings(1))//nl
         end associate
      end do
      text = text//"       vcor --version"//nl//nl
      associate (found => external_commands())
         if (size(found) > 0) text = text &
            //"programs of PATH that vcor NAME runs; see vcor NAME --help:"//nl
         do i = 1, size(found)
            place = findloc(package_commands%term == found(i), .true., dim=1)
            words = "not part of vcor"
            if (place > 0) words = trim(package_commands(place)%text)
            text = text//item("       vcor "//found(i), words)
         end do
         if (size(found) > 0) text = text//nl
         if (all(found /= package_commands(1)%term)) text = text//"More commands come with the " &
            //"Python package, such as vcor "//trim(package_commands(1)%term) &
            //", which says how to install it."//nl//nl
      end associate
      text = text &
         //"TOPIC: a command, input, output, or a word of the input or the output."//nl &
         //"vcor help --json prints everything as one JSON document."//nl//nl
      text = text//"exit codes: 0 "//trim(code_names(0))
      do i = 1, ubound(code_names, 1)
         text = text//", "//integer_text(i)//" "//trim(code_names(i))
      end do
      text = text//nl
   end function overview

   !> Page of a command
   function command_page(page) result(text)
      type(part_t), intent(in) :: page(:)
      character(len=:), allocatable :: text

      character(len=:), allocatable :: words, before, kind
      integer :: i

      text = ""
      kind = ""
      do i = 1, size(page)
         before = kind
         words = plain(page(i)%text)
         kind = "item"
         if (page(i)%term == "") kind = "paragraph"
         if (any(page(i)%term == ["usage  ", "summary", "example"])) kind = trim(page(i)%term)
         if (index(page(i)%term, "--") == 1) kind = "option"
         ! a blank line before each paragraph, and between different kinds
         if (kind == "paragraph" .or. (kind /= before .and. any(kind == ["option ", "example"]))) &
            text = text//nl
         select case (kind)
         case ("usage", "example")
            if (kind == before) then
               text = text//repeat(" ", len(kind) + 2)//words//nl
            else
               text = text//kind//": "//words//nl
            end if
         case ("paragraph")
            text = text//wrapped("", words, 0)
         case ("summary")
            cycle
         case default
            text = text//item("  "//page(i)%term, words)
         end select
      end do
   end function command_page

   !> The parts of input and output about a topic
   function words_page(topic) result(text)
      !> `input`: all keys; `output`: columns of the summary, and statuses; or a word: the name of a
      !> group, KEY, GROUP.KEY, a choice of a key, such as a model, name or symbol of a column, name
      !> of a status, a word of the screen
      character(len=*), intent(in) :: topic
      !> Lines under headings; empty if the word is unknown
      character(len=:), allocatable :: text

      type(key_t), allocatable :: keys(:)
      character(len=:), allocatable :: heading, last, advice
      integer :: i, j

      text = ""
      last = ""
      allocate (keys, source=described_keys())
      do i = 1, size(groups)
         heading = "&"//trim(groups(i)%name)//"  "//trim(groups(i)%meaning)
         if (groups(i)%repeated) heading = heading//"; may be repeated"
         if (.not. groups(i)%required) heading = heading//"; optional"
         do j = 1, size(keys)
            associate (key => keys(j))
               if (key%group == groups(i)%name) call show("input", item("   "//key%name, &
                  about(key))//meanings(key), trim(key%group)//" "//trim(key%name)//" " &
                  //trim(key%group)//"."//trim(key%name)//" "//trim(key%choices)//" "//key%models)
            end associate
         end do
      end do
      heading = "Columns of STEM_summary.csv and names for --print:"
      call show_columns("output", quantities())
      heading = "Values of status; the numbers are nan for all but separated:"
      do i = 1, size(statuses)
         advice = ""
         if (statuses(i)%advice /= "") advice = item("", "what to do: "//statuses(i)%advice)
         call show("output", item("   "//statuses(i)%name, statuses(i)%meaning)//advice, &
            "status "//statuses(i)%name)
      end do
      heading = "Columns of STEM.csv, the time history:"
      call show_columns("", history_quantities)
      heading = "Columns of STEM_bounces.csv, the bounces:"
      call show_columns("", bounce_quantities)
      heading = "In this program:"
      do i = 1, size(topics)
         call show("", item("   "//word_of(topics(i)%words), topics(i)%meaning), topics(i)%words)
      end do
      heading = "On the screen of a run:"
      do i = 1, size(screen_items)
         call show("", item("", screen_items(i)%meaning), screen_items(i)%words)
      end do

   contains

      !> Show lines under their heading if they are about the topic
      subroutine show(page, lines, about)
         !> Page on which they are always shown; empty: none
         character(len=*), intent(in) :: page
         character(len=*), intent(in) :: lines
         !> Words of these lines
         character(len=*), intent(in) :: about

         if (.not. merge(topic == page, contains_word(about, topic), &
            contains_word("input output", topic))) return
         if (heading /= last .and. text /= "") text = text//nl
         if (heading /= last) text = text//heading//nl
         last = heading
         text = text//lines
      end subroutine show

      !> Show columns of a file
      subroutine show_columns(page, columns)
         !> Page on which they are always shown; empty: none
         character(len=*), intent(in) :: page
         type(quantity_t), intent(in) :: columns(:)

         character(len=:), allocatable :: unit
         integer :: k

         do k = 1, size(columns)
            associate (column => columns(k))
               unit = ""
               if (column%symbol /= "") unit = " ["//trim(column%unit)//"], symbol "//column%symbol
               call show(page, item("   "//column%name, trim(column%meaning)//unit), &
                  trim(column%name)//" "//column%symbol)
            end associate
         end do
      end subroutine show_columns
   end function words_page

   !> Meaning and values of a key
   function about(key) result(words)
      type(key_t), intent(in) :: key
      !> Meaning, unit, range, default, models
      character(len=:), allocatable :: words

      words = trim(key%meaning)
      if (key%unit /= "") words = words//" ["//trim(key%unit)//"]"
      if (range_text(key) /= "") words = words//", "//range_text(key)
      if (key%required) then
         words = words//", required"
         if (key%instead /= "") words = words//", or "//trim(key%instead)
      else if (key%default /= "" .and. key%default /= "''") then
         words = words//", default "//trim(key%default)
      end if
      if (key%models /= "") words = words//"; "//trim(key%models)
   end function about

   !> The words that a key can have, a line each
   function meanings(key) result(text)
      type(key_t), intent(in) :: key
      !> Lines; empty where the words explain themselves
      character(len=:), allocatable :: text

      integer :: i

      text = ""
      do i = 1, size(choices)
         if (choices(i)%key == trim(key%group)//"."//key%name .and. contains_word(key%choices, &
            choices(i)%word)) text = text//item("", trim(choices(i)%word)//": " &
            //choices(i)%meaning)
      end do
   end function meanings

   !> First of the words of a topic
   pure function word_of(words) result(word)
      !> Words between blanks
      character(len=*), intent(in) :: words
      character(len=:), allocatable :: word

      word = adjustl(words)
      word = word(:index(word//" ", " ") - 1)
   end function word_of

   !> All words of input and output except GROUP.KEY, each after a blank
   function all_words() result(words)
      character(len=:), allocatable :: words

      type(key_t), allocatable :: rows(:)
      integer :: i

      allocate (rows, source=described_keys())
      words = " "//quantity_names()
      do i = 1, size(rows)
         words = words//" "//trim(rows(i)%group)//" "//trim(rows(i)%name)
         if (rows(i)%choices /= "") words = words//" "//trim(rows(i)%choices)
      end do
      do i = 1, size(statuses)
         words = words//" "//trim(statuses(i)%name)
      end do
      do i = 1, size(topics)
         words = words//" "//trim(adjustl(topics(i)%words))
      end do
   end function all_words

   !> A term and its meaning
   pure function item(term, words) result(text)
      !> The term, indented
      character(len=*), intent(in) :: term
      character(len=*), intent(in) :: words
      character(len=:), allocatable :: text

      character(len=max(margin, len_trim(term) + 2)) :: start

      start = term
      text = wrapped(start, trim(words), margin)
   end function item

   !> A text broken into lines at blanks
   pure function wrapped(start, words, indent) result(text)
      !> Start of the first line
      character(len=*), intent(in) :: start
      character(len=*), intent(in) :: words
      !> Indentation of the other lines
      integer, intent(in) :: indent
      !> Lines of at most `width` characters
      character(len=:), allocatable :: text

      integer :: first, last, room

      text = start
      room = width - len(start)
      first = 1
      do
         last = len(words)
         if (last - first >= room) last = first - 2 + index(words(first:first + room), " ", &
            back=.true.)
         if (last < first) last = first - 2 + index(words(first:)//" ", " ")
         text = text//words(first:last)//nl
         first = last + 2
         if (first > len(words)) exit
         text = text//repeat(" ", indent)
         room = width - indent
      end do
   end function wrapped

   !> A text without backquotes
   pure function plain(words) result(text)
      character(len=*), intent(in) :: words
      character(len=:), allocatable :: text

      integer :: i

      text = ""
      do i = 1, len_trim(words)
         if (words(i:i) /= "`") text = text//words(i:i)
      end do
   end function plain

end module vcor_app_help
