!> Watch over a sweep: what is finished goes to a file, the terminal shows how far it is, and a
!> signal ends it
module vcor_app_watch
   use vcor_app_signals, only : caught_signal
   use vcor_case_grid, only : grid_t
   use vcor_error, only : error_t
   use vcor_io_checkpoint, only : checkpoint_t, create_checkpoint
   use vcor_io_file, only : write_terminal
   use vcor_io_identity, only : identity_t
   use vcor_text, only : integer_text
   use vcor_kinds, only : wp
   use vcor_sweep_points, only : clock, monitor_t
   use vcor_sweep_summary, only : summary_t
   implicit none
   private

   public :: watch_t

   !> Time after which a sweep gets a file [s]: what is shorter is solved anew as quickly
   real(wp), parameter :: time_without_file = 0.25_wp
   !> Time between two lines on the terminal [s]
   real(wp), parameter :: time_between_lines = 0.2_wp
   !> Letters of the line
   integer, parameter :: width = 72

   !> Who watches
   type, extends(monitor_t) :: watch_t
      !> Whether what is finished is kept in a file
      logical :: keeps = .false.
      !> Whether the terminal shows how far it is
      logical :: shows = .false.
      character(len=:), allocatable :: path
      type(identity_t) :: identity
      !> Its grid
      type(grid_t) :: grid
      type(checkpoint_t) :: file
      !> Points that are done
      integer :: done = 0
      !> Points that were done at the beginning
      integer :: done_before = 0
      !> When it began [s]
      real(wp) :: start = 0.0_wp
      !> When the terminal was written to [s]
      real(wp), private :: shown = 0.0_wp
   contains
      !> Points are finished
      procedure :: finished
      !> Whether the sweep has to stop
      procedure, nopass :: stop_code => caught_signal
      !> Take the line off the terminal
      procedure :: clear
   end type watch_t

contains

   !> Points are finished
   subroutine finished(self, first, last, count, summary, error)
      class(watch_t), intent(inout) :: self
      !> First place that may have changed
      integer, intent(in) :: first
      !> Last place that may have changed
      integer, intent(in) :: last
      !> Number of points between them that are new
      integer, intent(in) :: count
      type(summary_t), intent(inout) :: summary
      !> Set if they cannot be kept; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: now

      now = clock()
      self%done = self%done + count
      if (self%file%is_open()) then
         call self%file%put(first, last, summary, error)
      else if (self%keeps .and. now - self%start > time_without_file) then
         call create_checkpoint(self%file, self%path, self%identity, self%grid, summary, &
            error)
      end if
      if (allocated(error)) return
      if (self%shows .and. now - self%shown > time_between_lines) then
         call show(self, now - self%start)
         self%shown = now
      end if
   end subroutine finished

   !> Show how far the sweep is
   subroutine show(self, time)
      type(watch_t), intent(in) :: self
      !> Time since it began [s]
      real(wp), intent(in) :: time

      character(len=:), allocatable :: line
      real(wp) :: rate
      integer :: points

      points = self%identity%part%count()
      rate = real(self%done - self%done_before, wp)/max(time, epsilon(time))
      line = '  '//integer_text(self%done)//' of '//integer_text(points)//' points, ' &
         //integer_text(int(100.0_wp*real(self%done, wp)/real(points, wp)))//' %, ' &
         //rate_text(rate)//', '//time_text(real(points - self%done, wp)/rate)//' left'
      call write_terminal(achar(13)//line//repeat(' ', max(0, width - len(line))))
   end subroutine show

   !> A rate in words
   function rate_text(rate) result(text)
      !> Points per second
      real(wp), intent(in) :: rate
      !> The rate, per minute or hour where it is small
      character(len=:), allocatable :: text

      if (rate >= 1.0_wp) then
         text = integer_text(nint(rate))//'/s'
      else if (rate >= 1.0_wp/60.0_wp) then
         text = integer_text(nint(60.0_wp*rate))//'/min'
      else
         text = integer_text(nint(3600.0_wp*rate))//'/h'
      end if
   end function rate_text

   !> A time as a clock has it
   function time_text(time) result(text)
      !> Time [s]
      real(wp), intent(in) :: time
      !> Hours, minutes and seconds
      character(len=:), allocatable :: text

      real(wp), parameter :: longest = 1.0e9_wp
      integer :: left

      left = ceiling(min(time, longest))
      text = integer_text(left/3600)//':'//two(mod(left, 3600)/60)//':'//two(mod(left, 60))

   contains

      !> Two digits
      function two(number)
         !> Number, from 0 to 59
         integer, intent(in) :: number
         character(len=2) :: two

         write (two, '(i2.2)') number
      end function two
   end function time_text

   !> Take the line off the terminal
   subroutine clear(self)
      class(watch_t), intent(inout) :: self

      if (self%shown > 0.0_wp) &
         call write_terminal(achar(13)//repeat(' ', width)//achar(13))
      self%shown = 0.0_wp
   end subroutine clear

end module vcor_app_watch
