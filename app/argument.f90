!> Words of the command line
module vcor_app_argument
   implicit none
   private

   public :: argument_t, get_arguments, append_word, has_word

   !> One word
   type :: argument_t
      !> The word
      character(len=:), allocatable :: text
   end type argument_t

contains

   !> All words after the name of the program
   subroutine get_arguments(words)
      !> Words, shape (n)
      type(argument_t), allocatable, intent(out) :: words(:)

      integer :: i, length

      allocate (words(command_argument_count()))
      do i = 1, size(words)
         call get_command_argument(i, length=length)
         allocate (character(len=length) :: words(i)%text)
         if (length > 0) call get_command_argument(i, words(i)%text)
      end do
   end subroutine get_arguments

   !> Append a word. (gfortran 12 writes past the end of a deferred-length component in an array
   !> constructor of structure constructors, so there is none.)
   subroutine append_word(words, text)
      !> Words, shape (n)
      type(argument_t), allocatable, intent(inout) :: words(:)
      !> The word
      character(len=*), intent(in) :: text

      type(argument_t), allocatable :: longer(:)
      integer :: i

      allocate (longer(size(words) + 1))
      do i = 1, size(words)
         call move_alloc(words(i)%text, longer(i)%text)
      end do
      longer(size(longer))%text = text
      call move_alloc(longer, words)
   end subroutine append_word

   !> Whether a list has a word
   pure function has_word(list, word) result(has)
      !> Words separated by single blanks
      character(len=*), intent(in) :: list
      !> The word
      character(len=*), intent(in) :: word
      !> Whether it is there
      logical :: has

      has = len(word) > 0 .and. index(word, ' ') == 0 &
         .and. index(' '//list//' ', ' '//word//' ') > 0
   end function has_word

end module vcor_app_argument
