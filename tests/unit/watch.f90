!> Who watches a sweep in tests: counts, stops it, or fails
module vcor_test_watch
   use vcor_error, only : error_internal, error_t, raise
   use vcor_sweep_points, only : monitor_t
   use vcor_sweep_quantity, only : summary_t
   implicit none
   private

   public :: watch_t, stops

   !> Code that ends the sweep
   integer :: stops = 0

   !> The watch
   type, extends(monitor_t) :: watch_t
      !> Rounds after which it stops the sweep
      integer :: stops_after = huge(1)
      !> Rounds after which it fails
      integer :: fails_after = huge(1)
      !> Rounds so far
      integer :: rounds = 0
      !> Points so far
      integer :: count = 0
   contains
      !> Count
      procedure :: finished
      !> Say when to stop
      procedure, nopass :: stop_code
   end type watch_t

contains

   !> Count, stop or fail
   subroutine finished(self, first, last, count, summary, error)
      !> The watch
      class(watch_t), intent(inout) :: self
      !> First place
      integer, intent(in) :: first
      !> Last place
      integer, intent(in) :: last
      !> Points that are new
      integer, intent(in) :: count
      !> Outcomes
      type(summary_t), intent(inout) :: summary
      !> Set after `fails_after` rounds
      type(error_t), allocatable, intent(out) :: error

      if (first < 1 .or. last > size(summary%status) .or. last - first + 1 < count) &
         error stop "places of a round"
      self%rounds = self%rounds + 1
      self%count = self%count + count
      if (self%rounds >= self%stops_after) stops = 15
      if (self%rounds >= self%fails_after) call raise(error, error_internal, "injected failure")
   end subroutine finished

   !> When to stop
   function stop_code() result(code)
      !> 0 to go on
      integer :: code

      code = stops
   end function stop_code

end module vcor_test_watch
