!> Commands of other packages: `vcor NAME ...` runs `vcor-NAME ...` if PATH has such a program
module vcor_app_external
   use, intrinsic :: iso_c_binding, only : c_char, c_f_pointer, c_int, c_loc, &
      c_null_char, c_null_ptr, c_ptr, c_size_t
   use vcor_app_cli, only : argument_t
   use vcor_app_commands, only : commands
   use vcor_io_posix, only : fortran_text
   use vcor_words, only : contains_word
   implicit none
   private

   public :: run_external, external_commands

   !> Characters in the name of a command
   character(len=*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz0123456789_'

   !> Longest name that is listed [bytes]
   integer, parameter :: longest = 64

   !> A C string
   type :: c_word_t
      !> Its characters and a null
      character(kind=c_char), allocatable :: letters(:)
   end type c_word_t

   !> `glob_t` of the C library
   type, bind(c) :: glob_t
      !> Number of paths
      integer(c_size_t) :: count = 0
      !> Pointers to them, shape (count)
      type(c_ptr) :: paths = c_null_ptr
      !> Remaining components, with spare room
      integer(c_size_t) :: rest(16) = 0
   end type glob_t

   interface
      !> Replace the process by another program, found in PATH; returns only on failure
      function c_execvp(file, arguments) bind(c, name='execvp') result(status)
         import :: c_int, c_ptr
         !> Its name
         type(c_ptr), value :: file
         !> Its arguments, the name first, null last
         type(c_ptr), intent(in) :: arguments(*)
         integer(c_int) :: status
      end function c_execvp

      !> Paths that match a pattern
      function c_glob(pattern, flags, handler, found) bind(c, name='glob') result(status)
         import :: c_char, c_int, c_ptr, glob_t
         character(kind=c_char), intent(in) :: pattern(*)
         integer(c_int), value :: flags
         !> Called on an error; null: nothing
         type(c_ptr), value :: handler
         type(glob_t), intent(inout) :: found
         integer(c_int) :: status
      end function c_glob

      !> Release the paths
      subroutine c_globfree(found) bind(c, name='globfree')
         import :: glob_t
         type(glob_t), intent(inout) :: found
      end subroutine c_globfree

      !> 0 if a file may be accessed in this mode
      function c_access(path, mode) bind(c, name='access') result(status)
         import :: c_int, c_ptr
         type(c_ptr), value :: path
         integer(c_int), value :: mode
         integer(c_int) :: status
      end function c_access
   end interface

contains

   !> Run the program of the first word, or of the topic of `help`; returns if the word is a
   !> built-in command or no name, or if there is no such program
   subroutine run_external(words)
      !> Words after the name of the program
      type(argument_t), intent(in) :: words(:)

      type(argument_t) :: called(size(words))
      type(c_word_t), target :: texts(size(words))
      type(c_ptr) :: arguments(size(words) + 1)
      character(len=:), allocatable :: text
      integer(c_int) :: status
      integer :: i, j

      if (size(words) == 0) return
      called = words
      if (words(1)%text == 'help' .and. size(words) == 2) then
         called(1)%text = words(2)%text
         called(2)%text = '--help'
      end if
      text = called(1)%text
      if (len(text) == 0 .or. verify(text, letters) > 0) return
      if (contains_word(commands()//' input output', text)) return
      called(1)%text = 'vcor-'//text
      do i = 1, size(called)
         text = called(i)%text//c_null_char
         texts(i)%letters = [(text(j:j), j=1, len(text))]
         arguments(i) = c_loc(texts(i)%letters)
      end do
      arguments(size(arguments)) = c_null_ptr
      status = c_execvp(arguments(1), arguments)
   end subroutine run_external

   !> Commands for which PATH has programs
   function external_commands() result(names)
      !> Their names without duplicates, shape (n)
      character(len=longest), allocatable :: names(:)

      integer(c_int), parameter :: mark_folders = 2, may_run = 1
      type(glob_t) :: found
      type(c_ptr), pointer :: paths(:)
      character(len=:), allocatable :: folders, pattern, name
      integer :: i, j, first, length

      call get_environment_variable('PATH', length=length)
      allocate (character(len=length) :: folders)
      call get_environment_variable('PATH', folders)
      allocate (names(0))
      pattern = ''
      do i = 1, length + 1
         if (i <= length) then
            if (folders(i:i) /= ':') then
               if (index('*?[\', folders(i:i)) > 0) pattern = pattern//'\'
               pattern = pattern//folders(i:i)
               cycle
            end if
         end if
         if (pattern /= '') pattern = pattern//'/'
         pattern = pattern//'vcor-*'//c_null_char
         found = glob_t()
         if (c_glob(pattern, mark_folders, c_null_ptr, found) == 0) then
            call c_f_pointer(found%paths, paths, [found%count])
            do j = 1, size(paths)
               if (c_access(paths(j), may_run) /= 0) cycle
               name = fortran_text(paths(j))
               first = index(name, '/vcor-', back=.true.) + 6
               if (verify(name(first:), letters) == 0 .and. all(names /= name(first:)) .and. &
                  .not. contains_word(commands(), name(first:))) &
                  names = [character(len=longest) :: names, name(first:)]
            end do
         end if
         call c_globfree(found)
         pattern = ''
      end do
   end function external_commands

end module vcor_app_external
