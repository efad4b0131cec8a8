!> Commands that other packages bring: `vcor NAME ...` is `vcor-NAME ...` if PATH has such a program
module vcor_app_external
   use, intrinsic :: iso_c_binding, only : c_char, c_int, c_loc, c_null_char, c_null_ptr, c_ptr
   use vcor_app_cli, only : argument_t
   use vcor_app_commands, only : commands
   use vcor_words, only : contains_word
   implicit none
   private

   public :: run_external

   !> A word for C
   type :: c_word_t
      !> Its letters and a null
      character(kind=c_char), allocatable :: letters(:)
   end type c_word_t

   interface
      !> Become another program, found in PATH; comes back on failure only
      function c_execvp(file, arguments) bind(c, name='execvp') result(status)
         import :: c_int, c_ptr
         !> Its name
         type(c_ptr), value :: file
         !> Its arguments, the name first, null last
         type(c_ptr), intent(in) :: arguments(*)
         integer(c_int) :: status
      end function c_execvp
   end interface

contains

   !> Become the program that the first word names; comes back if the word is a command, or no name,
   !> or there is no such program
   subroutine run_external(words)
      !> Words after the name of the program
      type(argument_t), intent(in) :: words(:)

      character(len=*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz0123456789_'
      type(c_word_t), target :: texts(size(words))
      type(c_ptr) :: arguments(size(words) + 1)
      character(len=:), allocatable :: text
      integer(c_int) :: status
      integer :: i, j

      if (size(words) == 0) return
      if (len(words(1)%text) == 0 .or. verify(words(1)%text, letters) > 0) return
      if (contains_word(commands, words(1)%text)) return
      do i = 1, size(words)
         text = words(i)%text//c_null_char
         if (i == 1) text = 'vcor-'//text
         texts(i)%letters = [(text(j:j), j=1, len(text))]
         arguments(i) = c_loc(texts(i)%letters)
      end do
      arguments(size(arguments)) = c_null_ptr
      status = c_execvp(arguments(1), arguments)
   end subroutine run_external

end module vcor_app_external
