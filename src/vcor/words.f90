!> Lists of words, separated by blanks in one text, such as the choices of a key or the names of
!> groups; and the known word that is nearest to a misspelt one
module vcor_words
   use vcor_text, only : lower
   implicit none
   private

   public :: contains_word, list_of_words, spelled, join_words, nearest_name, edit_distance, &
      suggestion, longest_name, joined

   !> Longest name that is compared or taken from a list [bytes]
   integer, parameter :: longest_name = 64
   !> Shortest name that counts as the beginning of a known one [bytes]
   integer, parameter :: shortest_beginning = 3

   !> A name of keys, columns or options that there is not: of earlier versions, or of the field
   type :: gone_t
      character(len=20) :: name
      !> What to write instead
      character(len=72) :: advice
   end type gone_t

   !> The names of which there is more to say than another name
   type(gone_t), parameter :: gone(*) = [ &
      gone_t('footprint', "waves = 'body' solves the contact itself: remove it"), &
      gone_t('shore', 'a hardness is not a modulus, see vcor help hardness'), &
      gone_t('hardness', 'a hardness is not a modulus, see vcor help hardness'), &
      gone_t('footprint_effect', "waves = 'body' solves the contact itself: remove it"), &
      gone_t('half_space_loss', 'wave_loss has the waves of every face, in one column'), &
      gone_t('bending_loss', 'wave_loss has the waves of every face, in one column')]

   !> A name that the field has for a word of input or output
   type :: synonym_t
      character(len=20) :: name
      character(len=16) :: here
   end type synonym_t

   !> The synonyms that no likeness of letters leads from
   type(synonym_t), parameter :: synonyms(*) = [ &
      synonym_t('tan_delta', 'loss_tangent'), &
      synonym_t('tan_d', 'loss_tangent'), &
      synonym_t('loss_factor', 'loss_tangent'), &
      synonym_t('restitution', 'cor_sphere'), &
      synonym_t('e', 'cor'), &
      synonym_t('e_a', 'cor_sphere'), &
      synonym_t('t0', 'contact_time'), &
      synonym_t('f_max', 'max_force'), &
      synonym_t('s_max', 'max_indentation'), &
      synonym_t('rebound', 'resilience'), &
      synonym_t('rebound_resilience', 'resilience'), &
      synonym_t('peak_force', 'max_force'), &
      synonym_t('duration', 'contact_time'), &
      synonym_t('contact_duration', 'contact_time'), &
      synonym_t('penetration', 'max_indentation'), &
      synonym_t('deformation', 'max_indentation'), &
      synonym_t('speed', 'velocity'), &
      synonym_t('glued', 'bonded'), &
      synonym_t('clamped', 'bonded'), &
      synonym_t('youngs_modulus', 'modulus')]

contains

   !> The words of a list as an array
   pure function list_of_words(words) result(list)
      !> Words separated by single blanks, each of at most `longest_name` bytes
      character(len=*), intent(in) :: words
      character(len=longest_name), allocatable :: list(:)
      integer :: first, last

      allocate (list(0))
      first = 1
      do while (first <= len_trim(words))
         last = first + index(words(first:)//" ", " ") - 2
         list = [character(len=longest_name) :: list, words(first:last)]
         first = last + 2
      end do
   end function list_of_words

   !> Whether a list contains a word
   pure function contains_word(words, word) result(yes)
      !> Words separated by blanks
      character(len=*), intent(in) :: words
      character(len=*), intent(in) :: word
      logical :: yes

      yes = len_trim(word) > 0 .and. index(trim(word), " ") == 0
      if (yes) yes = index(" "//words//" ", " "//trim(word)//" ") > 0
   end function contains_word

   !> A word as spelled in a list; upper and lower case are equal
   pure function spelled(words, word) result(same)
      !> Words separated by blanks
      character(len=*), intent(in) :: words
      character(len=*), intent(in) :: word
      !> The word as in the list; in lower case if it is not there
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
      !> Words separated by a comma and a blank
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

   !> Join two texts in one line; either may be empty
   pure function joined(first, second) result(text)
      character(len=*), intent(in) :: first, second
      character(len=:), allocatable :: text

      text = first//second
      if (first /= '' .and. second /= '') text = first//'; '//second
   end function joined

   !> Suggestion for an unknown name: what took the place of one that is gone, the nearest known
   !> one, or as many as fit in a line
   pure function suggestion(name, known) result(text)
      !> The unknown name
      character(len=*), intent(in) :: name
      !> Known names separated by blanks
      character(len=*), intent(in) :: known
      !> `did you mean '...'?` or `known: ...`
      character(len=:), allocatable :: text

      integer, parameter :: line = 300
      integer :: last

      last = findloc(gone%name == lower(name), .true., dim=1)
      if (last > 0) then
         text = trim(gone(last)%advice)
         return
      end if
      text = nearest_name(name, known)
      if (len(text) > 0) then
         text = "did you mean '"//text//"'?"
         return
      end if
      last = len_trim(known)
      if (last > line) last = index(known(:line), " ", back=.true.) - 1
      text = "known: "//join_words(known(:last))
      if (last < len_trim(known)) text = text//", ..."
   end function suggestion

   !> The known name that means the same as a given one, or else the nearest
   pure function nearest_name(name, known) result(word)
      !> The unknown name, any case
      character(len=*), intent(in) :: name
      !> Known names separated by single blanks, any case
      character(len=*), intent(in) :: known
      !> The nearest one, empty if none is near
      character(len=:), allocatable :: word
      integer :: first, last, distance, least, most

      word = ""
      if (len_trim(name) == 0 .or. len_trim(name) > longest_name) return
      first = findloc(synonyms%name == lower(name), .true., dim=1)
      if (first > 0) word = trim(synonyms(first)%here)
      if (contains_word(lower(known), word)) return
      word = ""
      ! one error in a short name, one per three letters in a long one, none in a single letter
      most = min(max(1, (len_trim(name) + 1)/3), len_trim(name) - 1)
      least = most + 1
      first = 1
      do while (first <= len_trim(known))
         last = first + index(known(first:)//" ", " ") - 2
         distance = edit_distance(lower(trim(name)), lower(known(first:last)))
         if (is_beginning(name, known(first:last))) distance = min(distance, 1)
         if (is_beginning(known(first:last), name)) distance = min(distance, most)
         if (distance < least .or. (distance == least .and. last - first + 1 < len(word))) then
            least = distance
            word = known(first:last)
         end if
         first = last + 2
      end do
   end function nearest_name

   !> Whether a name is the beginning of a part of a known one, such as thickness of half_thickness
   !> or velocity of impact.velocity
   pure function is_beginning(name, word) result(yes)
      !> The unknown name, any case
      character(len=*), intent(in) :: name
      !> The known one
      character(len=*), intent(in) :: word
      logical :: yes

      yes = len_trim(name) >= shortest_beginning
      if (yes) yes = index("_"//lower(word), "_"//lower(trim(name))) > 0 &
         .or. index(lower(word), "."//lower(trim(name))) > 0
   end function is_beginning

   !> Smallest number of letters to insert, delete, change, or swap with a neighbour that turns one
   !> word into the other
   pure function edit_distance(a, b) result(distance)
      !> One word
      character(len=*), intent(in) :: a
      character(len=*), intent(in) :: b
      integer :: distance
      ! Distances of the beginnings of a (first index) and b
      integer :: d(-1:len(a), -1:len(b))
      integer :: i, j, change

      ! index -1 serves swaps only and is never the minimum
      d = len(a) + len(b)
      d(0:, 0) = [(i, i = 0, len(a))]
      d(0, 0:) = [(j, j = 0, len(b))]
      do j = 1, len(b)
         do i = 1, len(a)
            change = merge(0, 1, a(i:i) == b(j:j))
            d(i, j) = min(d(i-1, j) + 1, d(i, j-1) + 1, d(i-1, j-1) + change)
            if (is_swap(a(:i), b(:j))) d(i, j) = min(d(i, j), d(i-2, j-2) + 1)
         end do
      end do
      distance = d(len(a), len(b))
   end function edit_distance

   !> Whether two words end with the same two letters in different order
   pure function is_swap(a, b) result(yes)
      !> One word
      character(len=*), intent(in) :: a
      character(len=*), intent(in) :: b
      logical :: yes

      yes = len(a) > 1 .and. len(b) > 1
      if (yes) yes = a(len(a):) == b(len(b)-1:len(b)-1) .and. a(len(a)-1:len(a)-1) == b(len(b):)
   end function is_swap

end module vcor_words
