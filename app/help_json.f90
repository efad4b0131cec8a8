!> All help as one JSON document, `vcor help --json`, from which scripts/manual.py makes the manual
module vcor_app_help_json
   use vcor_app_commands, only : command_names, part_t, options_of, package_commands, page_of, &
      texts_of
   use vcor_app_screen, only : screen_items
   use vcor_case_described, only : described_groups
   use vcor_error, only : code_meanings, code_names
   use vcor_json, only : array, member, object, strings, words
   use vcor_solver_features, only : features, methods, of_paper_scheme, reads, refusals, &
      solves, unread
   use vcor_sweep_quantity, only : bounce_quantities, history_quantities, quantities, &
      quantity_t, statuses
   use vcor_text, only : integer_text
   use vcor_version, only : version
   use vcor_words, only : contains_word, list_of_words, longest_name
   implicit none
   private

   public :: help_json

contains

   !> All help as a JSON document, UTF-8
   function help_json() result(text)
      character(len=:), allocatable :: text

      character(len=:), allocatable :: list
      integer :: i

      text = member("program", "vcor")//member("version", version)
      list = ""
      do i = 1, size(command_names)
         list = list//command_object(command_names(i))
      end do
      text = text//array(list, "commands")
      list = ""
      do i = 1, size(package_commands)
         list = list//object(member("name", package_commands(i)%term) &
            //member("summary", package_commands(i)%text))
      end do
      text = text//array(list, "package_commands")
      text = text//array(described_groups(), "groups")//array(columns(quantities()), "summary") &
         //array(columns(history_quantities), "history") &
         //array(columns(bounce_quantities), "bounces")
      list = ""
      do i = 1, size(statuses)
         list = list//object(member("name", statuses(i)%name) &
            //member("meaning", statuses(i)%meaning)//member("advice", statuses(i)%advice))
      end do
      text = text//array(list, "statuses")
      list = ""
      do i = 1, size(screen_items)
         list = list//object(words("words", screen_items(i)%words) &
            //member("meaning", screen_items(i)%meaning))
      end do
      text = text//array(list, "screen")
      list = ""
      do i = lbound(code_names, 1), ubound(code_names, 1)
         list = list//object("""code"": "//integer_text(i)//", "//member("name", code_names(i)) &
            //member("meaning", code_meanings(i)))
      end do
      text = object(text//array(list, "exit_codes")//methods_and_features())
      text = text(:len(text) - 2)//new_line("a")
   end function help_json

   !> The table of methods and features as members of a JSON object
   function methods_and_features() result(text)
      character(len=:), allocatable :: text

      character(len=longest_name), allocatable :: names(:)
      character(len=:), allocatable :: list, known
      integer :: i, j, other

      text = words("methods", names_of([(.true., i=1, size(methods))]))
      list = ""
      do i = size(methods) + 1, size(features)
         ! the scheme is the method paper
         if (i == of_paper_scheme) cycle
         list = list//object(member("meaning", features(i)%meaning) &
            //member("keys", features(i)%keys) &
            //words("methods", names_of([(solves(j, i), j=1, size(methods))])))
      end do
      text = text//array(list, "features")
      list = ""
      known = ""
      do i = 1, size(unread)
         allocate (names, source=list_of_words(trim(unread(i)%keys)))
         do j = 1, size(names)
            if (contains_word(known, names(j))) cycle
            known = known//" "//trim(names(j))
            list = list//object(member("key", trim(unread(i)%group)//"."//trim(names(j))) &
               //words("methods", names_of([(reads(other, trim(unread(i)%group), &
               trim(names(j))), other=1, size(methods))])))
         end do
         deallocate (names)
      end do
      text = text//array(list, "method_keys")
      list = ""
      do i = 1, size(refusals)
         do j = 1, size(refusals(i)%by)
            other = refusals(i)%by(j)
            if (other <= size(methods)) cycle
            list = list//object(member("one", features(other)%keys) &
               //member("other", features(refusals(i)%feature)%keys) &
               //member("reason", refusals(i)%message))
         end do
      end do
      text = text//array(list, "exclusions")
   end function methods_and_features

   !> Names of some methods, separated by blanks
   pure function names_of(chosen) result(names)
      !> Shape (size(methods))
      logical, intent(in) :: chosen(:)
      character(len=:), allocatable :: names

      integer :: i

      names = ""
      do i = 1, size(methods)
         if (chosen(i)) names = trim(adjustl(names//" "//methods(i)))
      end do
   end function names_of

   !> Usage, summary, examples and options of a command as a JSON object
   function command_object(command) result(text)
      character(len=*), intent(in) :: command
      character(len=:), allocatable :: text

      type(part_t), allocatable :: page(:)
      character(len=:), allocatable :: entries, name
      integer :: i, mark

      allocate (page, source=page_of(command))
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
            //array(strings(texts_of(command, "usage")), "usage") &
            //array(strings(texts_of(command, "example")), "examples") &
            //words("options", options_of(command))//array(entries, "page"))
      end associate
   end function command_object

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

end module vcor_app_help_json
