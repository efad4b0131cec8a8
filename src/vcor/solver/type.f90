!> What all solvers have in common
module vcor_solver_type
   use vcor_error, only : error_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : trajectory_t
   implicit none
   private

   public :: solver_t

   !> A method for impacts; immutable once built, so that threads can share it
   type, abstract :: solver_t
   contains
      !> Compute the course of an impact
      procedure(solve_i), deferred :: solve
   end type solver_t

   abstract interface
      !> Compute the course of an impact
      subroutine solve_i(self, impact, trajectory, error)
         import :: error_t, impact_t, solver_t, trajectory_t
         !> The solver
         class(solver_t), intent(in) :: self
         !> The impact
         type(impact_t), intent(in) :: impact
         !> Its course; an impact that does not end in separation is no error but a status
         type(trajectory_t), intent(out) :: trajectory
         !> Unallocated on success
         type(error_t), allocatable, intent(out) :: error
      end subroutine solve_i
   end interface

end module vcor_solver_type
