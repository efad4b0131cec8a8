!> The method that works: internal variables, or product integration where those fail
!>
!> Internal variables fail where the kernel is no sum of exponentials: that of a table whose data
!> begin long after the contact has ended, of some pairs, of exponents next to a limit.
module vcor_solver_auto
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_lasting, contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver_ive, only : ive_t
   use vcor_solver_direct_product, only : product_t
   use vcor_solver_type, only : solver_t
   implicit none
   private

   public :: auto_t

   !> Two methods, each built
   type, extends(solver_t) :: auto_t
      !> What is tried first
      type(ive_t) :: ive
      !> What is tried if that has no result, or one that is far from the accuracy asked for
      type(product_t) :: product
   contains
      procedure :: solve
   end type auto_t

contains

   !> Compute the course of an impact
   subroutine solve(self, impact, trajectory, error)
      !> The solver
      class(auto_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its course
      type(trajectory_t), intent(out) :: trajectory
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(error_t), allocatable :: failure

      call self%ive%solve(impact, trajectory, error)
      if (allocated(error)) then
         if (error%code /= error_numerical) return
         call move_alloc(error, failure)
      else if (trajectory%status /= contact_separated .or. .not. trajectory%misses_by_far()) then
         return
      end if
      call self%product%solve(impact, trajectory, error)
      if (allocated(error) .or. .not. allocated(failure)) return
      ! that equal steps run out says nothing about a contact whose end nobody has set
      if (trajectory%status == contact_lasting .and. &
          .not. self%product%settings%end_time > 0.0_wp) call move_alloc(failure, error)
   end subroutine solve

end module vcor_solver_auto
