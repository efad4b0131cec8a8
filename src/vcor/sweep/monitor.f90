!> Who watches over a sweep: keeps what is finished, shows how far it is, says when to stop
module vcor_sweep_monitor
   use vcor_error, only : error_t
   use vcor_sweep_summary, only : summary_t
   implicit none
   private

   public :: monitor_t

   !> A watch; only the first rank calls `finished`
   type, abstract :: monitor_t
   contains
      !> Places are finished
      procedure(finished_i), deferred :: finished
      !> Whether the sweep has to stop
      procedure(stop_code_i), deferred :: stop_code
   end type monitor_t

   abstract interface
      !> Places are finished
      subroutine finished_i(self, first, last, summary, error)
         import :: error_t, monitor_t, summary_t
         !> The watch
         class(monitor_t), intent(inout) :: self
         !> First place
         integer, intent(in) :: first
         !> Last place
         integer, intent(in) :: last
         !> Outcomes of all places
         type(summary_t), intent(inout) :: summary
         !> What ends the sweep: its results cannot be kept, say; unallocated on success
         type(error_t), allocatable, intent(out) :: error
      end subroutine finished_i

      !> Whether the sweep has to stop, after the chunks that are at work
      function stop_code_i(self) result(code)
         import :: monitor_t
         !> The watch
         class(monitor_t), intent(in) :: self
         !> 0 to go on; whatever else is handed to who has begun the sweep
         integer :: code
      end function stop_code_i
   end interface

end module vcor_sweep_monitor
