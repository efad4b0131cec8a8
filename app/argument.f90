!> Words of the command line
module vcor_app_argument
   implicit none
   private

   public :: argument_t, get_arguments

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

end module vcor_app_argument
