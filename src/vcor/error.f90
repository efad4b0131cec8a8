!> Errors as values: a procedure that can fail has a last argument
!> `type(error_t), allocatable, intent(out) :: error`; unallocated means success
module vcor_error
   implicit none
   private

   public :: error_t, raise
   public :: error_internal, error_usage, error_input, error_file, error_numerical
   public :: code_names, code_meanings

   !> Exit codes of the program; 0 is success
   integer, parameter :: error_internal = 1
   !> The command line is wrong
   integer, parameter :: error_usage = 2
   !> The case is wrong
   integer, parameter :: error_input = 3
   !> A file cannot be read or written
   integer, parameter :: error_file = 4
   !> The numerical solution failed
   integer, parameter :: error_numerical = 5

   !> What the program's exit codes are called, from 0 on
   character(len=*), parameter :: code_names(0:5) = [character(len=17) :: "success", &
      "internal error", "usage", "input", "file", "numerical failure"]
   !> What they mean, from 0 on
   character(len=*), parameter :: code_meanings(0:5) = [character(len=64) :: &
      "what was asked for is done", &
      "a fault of the program, please report it", &
      "the command line is wrong", &
      "a case or a data file is wrong", &
      "a file cannot be read or written", &
      "no result to be trusted, of one impact at least"]

   !> One failure
   type :: error_t
      !> What kind of failure: one of the `error_*` constants, the program's exit code
      integer :: code = error_internal
      !> One line: what was found and what is expected
      character(len=:), allocatable :: message
      !> Names of the arguments that it is about, separated by blanks: the one that is missing, or
      !> those that contradict each other; unallocated where nobody can say
      character(len=:), allocatable :: about
      !> Which of several things has these arguments: the number of a material; 0: none of them
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
      !> Names of the arguments that it is about
      character(len=*), intent(in), optional :: about

      if (allocated(error)) deallocate(error)
      allocate(error)
      error%code = code
      error%message = message
      if (present(about)) error%about = about
   end subroutine raise

end module vcor_error
