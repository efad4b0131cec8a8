!> Lists of words in one text, with blanks between them: the choices of a key, the names of groups
module vcor_words
   use vcor_text, only : lower
   implicit none
   private

   public :: contains_word, spelled, join_words

contains

   !> Whether a list of words holds a word
   pure function contains_word(words, word) result(yes)
      !> Words separated by blanks
      character(len=*), intent(in) :: words
      !> The word
      character(len=*), intent(in) :: word
      !> True if it is there
      logical :: yes

      yes = len_trim(word) > 0 .and. index(trim(word), " ") == 0
      if (yes) yes = index(" "//words//" ", " "//trim(word)//" ") > 0
   end function contains_word

   !> A word as it is spelled in a list of words: upper and lower case make no difference
   pure function spelled(words, word) result(same)
      !> Words separated by blanks
      character(len=*), intent(in) :: words
      !> The word
      character(len=*), intent(in) :: word
      !> The word of the list; in lower case when it is not there
      character(len=len(word)) :: same
      integer :: place

      same = lower(word)
      if (.not. contains_word(lower(words), same)) return
      place = index(" "//lower(words)//" ", " "//same//" ")
      same = words(place:place + len(word) - 1)
   end function spelled

   !> Words with commas between them
   pure function join_words(words) result(text)
      !> Words separated by blanks
      character(len=*), intent(in) :: words
      !> The same separated by a comma and a blank
      character(len=:), allocatable :: text
      integer :: position

      text = ""
      do position = 1, len_trim(words)
         if (words(position:position) == " ") then
            text = text//", "
         else
            text = text//words(position:position)
         end if
      end do
   end function join_words

end module vcor_words
