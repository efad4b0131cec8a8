!> Outcomes of many impacts, column by column, each in the place of its point
module vcor_study_summary
   use vcor_error, only : error_internal, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_kinds, only : wp
   use vcor_study_quantity, only : quantities, quantity_values
   use vcor_study_text, only : integer_text
   implicit none
   private

   public :: summary_t, new_summary

   !> Values of one quantity
   type :: values_t
      !> Values in the unit of the quantity, NaN where a point has none, shape (points)
      real(wp), allocatable :: at(:)
   end type values_t

   !> Outcomes
   type :: summary_t
      !> Quantities, in the order of `quantities`
      type(values_t) :: values(size(quantities))
      !> Time steps, shape (points)
      integer, allocatable :: steps(:)
      !> Status, one of the `contact_*` and `point_*` constants, shape (points)
      integer, allocatable :: status(:)
   contains
      !> Keep the outcome of a point
      procedure :: put
   end type summary_t

contains

   !> Make room
   subroutine new_summary(self, points, error)
      !> The summary
      type(summary_t), intent(out) :: self
      !> Number of points
      integer, intent(in) :: points
      !> Error of code `error_internal` if there is not enough memory, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, status

      allocate (self%steps(points), stat=status)
      if (status == 0) allocate (self%status(points), stat=status)
      do i = 1, size(quantities)
         if (status == 0) allocate (self%values(i)%at(points), stat=status)
      end do
      if (status /= 0) call raise(error, error_internal, 'there is not enough memory for the ' &
         //'outcomes of '//integer_text(points)//' impacts')
   end subroutine new_summary

   !> Keep the outcome of a point. Points that differ may be put at the same time
   pure subroutine put(self, point, outcome)
      !> The summary
      class(summary_t), intent(inout) :: self
      !> Number of the point, from 1
      integer, intent(in) :: point
      !> Its outcome
      type(outcome_t), intent(in) :: outcome

      real(wp) :: values(size(quantities))
      integer :: i

      values = quantity_values(outcome)
      do i = 1, size(quantities)
         self%values(i)%at(point) = values(i)
      end do
      self%steps(point) = outcome%steps
      self%status(point) = outcome%status
   end subroutine put

end module vcor_study_summary
