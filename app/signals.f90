!> Signals: those that ask the program to end, SIGINT (Ctrl-C), SIGTERM and SIGHUP, and the one that
!> says that a file has become too large, SIGXFSZ
module vcor_app_signals
   use, intrinsic :: iso_c_binding, only : c_funloc, c_funptr, c_int, c_intptr_t, c_null_funptr
   use vcor_io_file, only : remove_scratch
   implicit none
   private

   public :: prepare_signals, catch_signals, release_signals, caught_signal, signal_name

   !> Numbers of SIGHUP, SIGINT, SIGTERM and SIGXFSZ
   integer(c_int), parameter :: hang_up = 1, interrupt = 2, terminate = 15, file_size = 25

   !> Signal that has come; 0 if there was none
   integer(c_int), volatile :: caught = 0

   interface
      !> Say who handles a signal
      function c_signal(number, handler) result(before) bind(c, name='signal')
         import :: c_funptr, c_int
         integer(c_int), intent(in), value :: number
         !> The handler; null for the system's own (SIG_DFL)
         type(c_funptr), intent(in), value :: handler
         !> Who did before
         type(c_funptr) :: before
      end function c_signal

      !> Send this process a signal
      function c_raise(number) result(status) bind(c, name='raise')
         import :: c_int
         integer(c_int), intent(in), value :: number
         !> 0 on success
         integer(c_int) :: status
      end function c_raise
   end interface

contains

   !> For the whole run: a signal that ends the program takes with it what is not complete, and a
   !> file that becomes too large is an error of writing (EFBIG) like a full disk. SIGXFSZ gets a
   !> handler which does nothing, not SIG_IGN, which a program started by this one would inherit
   subroutine prepare_signals()
      type(c_funptr) :: ignored

      ignored = c_signal(file_size, c_funloc(go_on))
      call release_signals()
   end subroutine prepare_signals

   !> From now on SIGINT or SIGTERM is noted. A second one ends the program at once, as if nobody
   !> cared
   subroutine catch_signals()
      type(c_funptr) :: ignored

      caught = 0
      ignored = c_signal(interrupt, c_funloc(handle))
      ignored = c_signal(terminate, c_funloc(handle))
   end subroutine catch_signals

   !> From now on a signal ends the program
   subroutine release_signals()
      call end_by(hang_up)
      call end_by(interrupt)
      call end_by(terminate)
   end subroutine release_signals

   !> Let a signal end the program, unless who called it has the signal ignored (nohup)
   subroutine end_by(number)
      integer(c_int), intent(in), value :: number

      integer(c_intptr_t), parameter :: ignoring = 1_c_intptr_t
      type(c_funptr) :: before, ignored

      before = c_signal(number, c_funloc(clean_up))
      if (transfer(before, ignoring) == ignoring) ignored = c_signal(number, before)
   end subroutine end_by

   !> Signal that has come. Threads ask at the same time, which the checks of a debug build take for
   !> a recursion
   recursive function caught_signal() result(number)
      !> Its number; 0 if there was none
      integer :: number

      number = int(caught)
   end function caught_signal

   !> Name of a signal
   pure function signal_name(number) result(name)
      integer, intent(in) :: number
      character(len=:), allocatable :: name

      name = 'SIGTERM'
      if (number == int(interrupt)) name = 'SIGINT'
   end function signal_name

   !> Note a signal; does nothing that a handler may not do
   subroutine handle(number) bind(c)
      integer(c_int), intent(in), value :: number

      type(c_funptr) :: ignored

      caught = number
      ignored = c_signal(interrupt, c_funloc(clean_up))
      ignored = c_signal(terminate, c_funloc(clean_up))
   end subroutine handle

   !> Remove what is not complete, and end as the signal does; does nothing that a handler may not
   subroutine clean_up(number) bind(c)
      integer(c_int), intent(in), value :: number

      type(c_funptr) :: ignored
      integer(c_int) :: status

      call remove_scratch()
      ignored = c_signal(number, c_null_funptr)
      ! it is held back until this handler returns
      status = c_raise(number)
   end subroutine clean_up

   !> Do nothing about a signal
   subroutine go_on(number) bind(c)
      integer(c_int), intent(in), value :: number

      if (number /= file_size) return
   end subroutine go_on

end module vcor_app_signals
