!> What one thread does at the beginning of its team's work, while the others go ahead
module vcor_sweep_aside
   implicit none
   private

   public :: aside_t

   !> Something to do that the work of the others does not touch
   type, abstract :: aside_t
   contains
      !> Do it
      procedure(run_i), deferred :: run
   end type aside_t

   abstract interface
      !> Do it
      subroutine run_i(self)
         import :: aside_t
         !> What there is to do; nothing afterwards
         class(aside_t), intent(inout) :: self
      end subroutine run_i
   end interface

end module vcor_sweep_aside
