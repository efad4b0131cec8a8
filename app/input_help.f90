!> Help on the input, made from the catalogue of keys
module vcor_app_input_help
   use vcor_case_catalogue, only : catalogue, group_t, groups, key_t, range_text
   implicit none
   private

   public :: input_page, input_words, indented

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

contains

   !> The groups with their keys, all or those that a word is about
   function input_page(word) result(text)
      !> Name of a group, KEY, GROUP.KEY, or a choice of a key, such as a model; absent: all
      character(len=*), intent(in), optional :: word
      !> The page; empty if the word is unknown
      character(len=:), allocatable :: text

      character(len=:), allocatable :: entries
      integer :: i, j

      text = ''
      do i = 1, size(groups)
         entries = ''
         do j = 1, size(catalogue)
            if (catalogue(j)%group /= groups(i)%name) cycle
            if (present(word)) then
               if (.not. is_about(word, catalogue(j))) cycle
            end if
            entries = entries//entry_of(catalogue(j))
         end do
         if (entries == '') cycle
         if (text /= '') text = text//nl
         text = text//heading(groups(i))//entries
      end do
   end function input_page

   !> All words that `input_page` knows but GROUP.KEY, a blank before each
   function input_words() result(words)
      !> The words
      character(len=:), allocatable :: words

      integer :: i

      words = ''
      do i = 1, size(catalogue)
         words = words//' '//trim(catalogue(i)%group)//' '//trim(catalogue(i)%name)
         if (catalogue(i)%choices /= '') words = words//' '//trim(catalogue(i)%choices)
      end do
   end function input_words

   !> Whether a word is about a key
   pure function is_about(word, key) result(yes)
      !> The word
      character(len=*), intent(in) :: word
      !> The key
      type(key_t), intent(in) :: key
      !> True if it is its name, its group, both, or one of its choices or models
      logical :: yes

      yes = index(word, ' ') == 0 .and. index(' '//trim(key%group)//' '//trim(key%name)//' ' &
         //trim(key%group)//'.'//trim(key%name)//' '//key%choices//' '//key%models//' ', &
         ' '//word//' ') > 0
   end function is_about

   !> Line of a group
   pure function heading(group) result(text)
      !> The group
      type(group_t), intent(in) :: group
      !> Its line
      character(len=:), allocatable :: text

      text = '&'//trim(group%name)//'  '//trim(group%meaning)
      if (group%repeated) text = text//'; may be repeated'
      if (.not. group%required) text = text//'; optional'
      text = text//nl
   end function heading

   !> Lines of a key
   function entry_of(key) result(text)
      !> The key
      type(key_t), intent(in) :: key
      !> Its lines
      character(len=:), allocatable :: text

      character(len=28) :: name
      character(len=:), allocatable :: note

      name = key%name
      note = ''
      if (key%unit /= '') note = note//' ['//trim(key%unit)//']'
      if (range_text(key) /= '') note = note//', '//range_text(key)
      if (key%required) then
         note = note//', required'
      else if (key%default /= '' .and. key%default /= "''") then
         note = note//', default '//trim(key%default)
      end if
      if (key%models /= '') note = note//'; '//trim(key%models)
      ! a line fits a screen
      if (len_trim(key%meaning) + len(note) > 66) then
         text = '   '//name//trim(key%meaning)//nl//indented(note(verify(note, ' ,'):))
      else
         text = '   '//name//trim(key%meaning)//note//nl
      end if
   end function entry_of

   !> A note below its key or word, in lines that fit a screen
   pure function indented(note) result(text)
      !> The note
      character(len=*), intent(in) :: note
      !> The same in lines of 100 characters at most, below the meanings
      character(len=:), allocatable :: text

      integer, parameter :: margin = 31, width = 100 - margin
      integer :: first, last

      text = ''
      first = 1
      do while (len(note) - first >= width)
         last = first - 1 + index(note(first:first + width), ' ', back=.true.)
         if (last < first) exit
         text = text//repeat(' ', margin)//note(first:last - 1)//nl
         first = last + 1
      end do
      text = text//repeat(' ', margin)//note(first:)//nl
   end function indented

end module vcor_app_input_help
