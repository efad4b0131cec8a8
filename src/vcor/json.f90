!> Parts of a JSON document, UTF-8. Each part ends with a comma and a blank or a line end, which
!> `object` and `array` remove from their last part
module vcor_json
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_kinds, only : wp
   use vcor_number, only : real_text
   use vcor_text, only : is_control
   implicit none
   private

   public :: object, array, member, words, strings

   !> A member of an object with a text, a real or a logical value
   interface member
      module procedure text_member
      module procedure real_member
      module procedure logical_member
   end interface member

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

contains

   !> Texts as a list of strings
   pure function strings(texts) result(list)
      character(len=*), intent(in) :: texts(:)
      character(len=:), allocatable :: list

      integer :: i

      list = ''
      do i = 1, size(texts)
         list = list//quoted(texts(i))//', '
      end do
   end function strings

   !> Members as an object
   pure function object(members) result(text)
      character(len=*), intent(in) :: members
      character(len=:), allocatable :: text

      text = '{'//members(:len(members) - 2)//'},'//nl
   end function object

   !> A list as an array, or as a member with this value
   pure function array(list, name) result(text)
      character(len=*), intent(in) :: list
      character(len=*), intent(in), optional :: name
      character(len=:), allocatable :: text

      text = '['//list(:max(0, len(list) - 2))//'],'//nl
      if (present(name)) text = quoted(name)//': '//text
   end function array

   !> A member whose value is an array of words; the list has single blanks between them
   pure function words(name, list) result(text)
      character(len=*), intent(in) :: name, list
      character(len=:), allocatable :: text

      integer :: i

      text = ''
      do i = 1, len_trim(list)
         if (list(i:i) /= ' ') then
            text = text//list(i:i)
         else if (text /= '') then
            text = text//'", "'
         end if
      end do
      if (text /= '') text = '"'//text//'", '
      text = array(text, name)
   end function words

   pure function text_member(name, value) result(text)
      character(len=*), intent(in) :: name, value
      character(len=:), allocatable :: text

      text = quoted(name)//': '//quoted(value)//', '
   end function text_member

   pure function real_member(name, value) result(text)
      character(len=*), intent(in) :: name
      real(wp), intent(in) :: value
      character(len=:), allocatable :: text

      text = quoted(name)//': null, '
      if (ieee_is_finite(value)) text = quoted(name)//': '//real_text(value)//', '
   end function real_member

   pure function logical_member(name, value) result(text)
      character(len=*), intent(in) :: name
      logical, intent(in) :: value
      character(len=:), allocatable :: text

      text = quoted(name)//': '//trim(merge('true ', 'false', value))//', '
   end function logical_member

   !> A text as a string, without blanks at its ends
   pure function quoted(words) result(text)
      character(len=*), intent(in) :: words
      character(len=:), allocatable :: text

      character(len=6) :: code
      integer :: i

      text = '"'
      do i = 1, len_trim(words)
         if (is_control(words(i:i))) then
            write (code, '(a, z4.4)') '\u', iachar(words(i:i))
            text = text//code
         else if (i > 1 .or. words(i:i) /= ' ') then
            if (index('"\', words(i:i)) > 0) text = text//'\'
            text = text//words(i:i)
         end if
      end do
      text = text//'"'
   end function quoted

end module vcor_json
