!> Errors as values: a procedure that can fail has a last argument
!> `type(error_t), allocatable, intent(out) :: error`; unallocated means success
module vcor_error
   implicit none
   private

   public :: error_t, raise
   public :: error_internal, error_usage, error_input, error_file, error_numerical
   public :: code_names, code_meanings

   !> Exit codes of the program (0: success): a fault of the program
   integer, parameter :: error_internal = 1
   !> The command line is wrong
   integer, parameter :: error_usage = 2
   !> The case is wrong
   integer, parameter :: error_input = 3
   !> A file cannot be read or written
   integer, parameter :: error_file = 4
   !> The numerical solution failed
   integer, parameter :: error_numerical = 5

   !> Names of the exit codes
   character(len=*), parameter :: code_names(0:5) = [character(len=17) :: "success", &
      "internal error", "usage", "input", "file", "numerical failure"]
   !> Meanings of the exit codes
   character(len=*), parameter :: code_meanings(0:5) = [character(len=64) :: &
      "what was asked for is done", &
      "a fault of the program, please report it", &
      "the command line is wrong", &
      "a case or a data file is wrong", &
      "a file cannot be read or written", &
      "no result to be trusted, of one impact at least"]

   !> One failure
   type :: error_t
      !> One of the `error_*` constants, which is the exit code of the program
      integer :: code = error_internal
      !> One line: what was found and what is expected
      character(len=:), allocatable :: message
      !> Names of the arguments concerned, separated by blanks: the missing one, or those that
      !> contradict each other; unallocated if unknown
      character(len=:), allocatable :: about
      !> Number of the material to which these arguments belong; 0 for others
      integer :: item = 0
   end type error_t

contains

   !> Set an error
   pure subroutine raise(error, code, message, about)
      !> The error, allocated on return
      type(error_t), allocatable, intent(inout) :: error
      !> One of the `error_*` constants
      integer, intent(in) :: code
      !> One line: what was found and what is expected
      character(len=*), intent(in) :: message
      !> Names of the arguments concerned, separated by blanks
      character(len=*), intent(in), optional :: about

      if (allocated(error)) deallocate(error)
      allocate(error)
      error%code = code
      error%message = message
      if (present(about)) error%about = about
   end subroutine raise

end module vcor_error
