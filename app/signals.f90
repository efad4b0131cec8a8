!> Signals that end the program, SIGINT (Ctrl-C), SIGTERM and SIGHUP, and SIGXFSZ, which reports
!> that a file is too large
module vcor_app_signals
   use, intrinsic :: iso_c_binding, only : c_funloc, c_funptr, c_int, c_intptr_t, c_null_funptr
   use vcor_io_file, only : remove_scratch
   implicit none
   private

   public :: prepare_signals, catch_signals, release_signals, caught_signal, signal_name

   !> Numbers of SIGHUP, SIGINT, SIGTERM and SIGXFSZ
   integer(c_int), parameter :: hang_up = 1, interrupt = 2, terminate = 15, file_size = 25

   !> Signal received; 0: none
   integer(c_int), volatile :: caught = 0

   interface
      !> Set the handler of a signal
      function c_signal(number, handler) result(before) bind(c, name='signal')
         import :: c_funptr, c_int
         integer(c_int), intent(in), value :: number
         !> The handler; null for the default of the system (SIG_DFL)
         type(c_funptr), intent(in), value :: handler
         !> Previous handler
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

   !> Set handlers for the whole run: a signal that ends the program also removes incomplete files,
   !> and a file that becomes too large is an error of writing (EFBIG), like a full disk. SIGXFSZ
   !> gets a handler that does nothing, not SIG_IGN, which programs started by this one would
   !> inherit
   subroutine prepare_signals()
      type(c_funptr) :: ignored

      ignored = c_signal(file_size, c_funloc(go_on))
      call release_signals()
   end subroutine prepare_signals

   !> Record SIGINT or SIGTERM from now on; a second one ends the program at once
   subroutine catch_signals()
      type(c_funptr) :: ignored

      caught = 0
      ignored = c_signal(interrupt, c_funloc(handle))
      ignored = c_signal(terminate, c_funloc(handle))
   end subroutine catch_signals

   !> Let signals end the program from now on
   subroutine release_signals()
      call end_by(hang_up)
      call end_by(interrupt)
      call end_by(terminate)
   end subroutine release_signals

   !> Let a signal end the program, unless the caller has ignored it (nohup)
   subroutine end_by(number)
      integer(c_int), intent(in), value :: number

      integer(c_intptr_t), parameter :: ignoring = 1_c_intptr_t
      type(c_funptr) :: before, ignored

      before = c_signal(number, c_funloc(clean_up))
      if (transfer(before, ignoring) == ignoring) ignored = c_signal(number, before)
   end subroutine end_by

   !> Signal received. Threads call this concurrently, which the checks of a debug build mistake for
   !> recursion
   recursive function caught_signal() result(number)
      !> Its number; 0: none
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

   !> Record a signal; uses only calls allowed in a handler
   subroutine handle(number) bind(c)
      integer(c_int), intent(in), value :: number

      type(c_funptr) :: ignored

      caught = number
      ignored = c_signal(interrupt, c_funloc(clean_up))
      ignored = c_signal(terminate, c_funloc(clean_up))
   end subroutine handle

   !> Remove incomplete files and end as the signal does; uses only calls allowed in a handler
   subroutine clean_up(number) bind(c)
      integer(c_int), intent(in), value :: number

      type(c_funptr) :: ignored
      integer(c_int) :: status

      call remove_scratch()
      ignored = c_signal(number, c_null_funptr)
      ! the signal is blocked until this handler returns
      status = c_raise(number)
   end subroutine clean_up

   !> Ignore a signal
   subroutine go_on(number) bind(c)
      integer(c_int), intent(in), value :: number

      if (number /= file_size) return
   end subroutine go_on

end module vcor_app_signals
