!> Signals that ask the program to end: SIGINT (Ctrl-C) and SIGTERM
module vcor_app_signals
   use, intrinsic :: iso_c_binding, only : c_funloc, c_funptr, c_int, c_null_funptr
   implicit none
   private

   public :: catch_signals, release_signals, caught_signal, signal_name

   !> Numbers of SIGINT and SIGTERM
   integer(c_int), parameter :: interrupt = 2, terminate = 15

   !> Signal that has come; 0 if there was none
   integer(c_int), volatile :: caught = 0

   interface
      !> Say who handles a signal
      function c_signal(number, handler) result(before) bind(c, name='signal')
         import :: c_funptr, c_int
         !> Number of the signal
         integer(c_int), intent(in), value :: number
         !> The handler; null for the system's own (SIG_DFL)
         type(c_funptr), intent(in), value :: handler
         !> Who did before
         type(c_funptr) :: before
      end function c_signal
   end interface

contains

   !> From now on a signal is noted. A second one ends the program at once, as if nobody cared
   subroutine catch_signals()
      type(c_funptr) :: ignored

      caught = 0
      ignored = c_signal(interrupt, c_funloc(handle))
      ignored = c_signal(terminate, c_funloc(handle))
   end subroutine catch_signals

   !> From now on a signal ends the program
   subroutine release_signals()
      type(c_funptr) :: ignored

      ignored = c_signal(interrupt, c_null_funptr)
      ignored = c_signal(terminate, c_null_funptr)
   end subroutine release_signals

   !> Signal that has come
   function caught_signal() result(number)
      !> Its number; 0 if there was none
      integer :: number

      number = int(caught)
   end function caught_signal

   !> Name of a signal
   pure function signal_name(number) result(name)
      !> Its number
      integer, intent(in) :: number
      !> Its name
      character(len=:), allocatable :: name

      name = 'SIGTERM'
      if (number == int(interrupt)) name = 'SIGINT'
   end function signal_name

   !> Note a signal; does nothing that a handler may not do
   subroutine handle(number) bind(c)
      !> Its number
      integer(c_int), intent(in), value :: number

      type(c_funptr) :: ignored

      caught = number
      ignored = c_signal(interrupt, c_null_funptr)
      ignored = c_signal(terminate, c_null_funptr)
   end subroutine handle

end module vcor_app_signals
