!> Who watches a sweep in tests: counts, or fails
module vcor_test_watch
   use vcor_error, only : error_internal, error_t, raise
   use vcor_sweep_points, only : monitor_t
   use vcor_sweep_quantity, only : point_pending, summary_t
   implicit none
   private

   public :: watch_t

   !> The watch
   type, extends(monitor_t) :: watch_t
      !> Rounds after which it fails
      integer :: fails_after = huge(1)
      !> Rounds so far
      integer :: rounds = 0
      !> Points so far
      integer :: count = 0
   contains
      !> Count
      procedure :: finished
   end type watch_t

contains

   !> Count, or fail
   subroutine finished(self, places, summary, error)
      !> The watch
      class(watch_t), intent(inout) :: self
      !> Points of the round
      integer, intent(in) :: places(:)
      !> Outcomes
      type(summary_t), intent(in) :: summary
      !> Set after `fails_after` rounds
      type(error_t), allocatable, intent(out) :: error

      if (any(summary%status(places) == point_pending)) error stop "places of a round"
      self%rounds = self%rounds + 1
      self%count = self%count + size(places)
      if (self%rounds >= self%fails_after) call raise(error, error_internal, "injected failure")
   end subroutine finished

end module vcor_test_watch
