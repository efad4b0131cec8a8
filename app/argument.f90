!> Words of the command line
module vcor_app_argument
   use, intrinsic :: iso_fortran_env, only : int64
   implicit none
   private

   public :: argument_t, get_arguments, append_word, has_word, sum_of_words

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

   !> A number that tells command lines apart; what follows --threads does not count
   pure function sum_of_words(words) result(sum)
      !> Words, shape (n)
      type(argument_t), intent(in) :: words(:)
      !> The number, >= 0
      integer :: sum

      integer(int64), parameter :: factor = 131_int64, modulus = 2147483647_int64
      integer(int64) :: number
      integer :: i, j
      logical :: counts

      number = 0_int64
      counts = .true.
      do i = 1, size(words)
         if (counts .and. index(words(i)%text, '--threads') /= 1) then
            do j = 1, len(words(i)%text)
               number = mod(factor*number + int(ichar(words(i)%text(j:j)), int64), modulus)
            end do
            number = mod(factor*number + 256_int64, modulus)
         end if
         counts = words(i)%text /= '--threads'
      end do
      sum = int(number)
   end function sum_of_words

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
      character(len=*), intent(in) :: word
      !> Whether it is there
      logical :: has

      has = len(word) > 0 .and. index(word, ' ') == 0 &
         .and. index(' '//list//' ', ' '//word//' ') > 0
   end function has_word

end module vcor_app_argument
