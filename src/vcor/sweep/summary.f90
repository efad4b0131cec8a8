!> Outcomes of many impacts, column by column, each in the place of its point
module vcor_sweep_summary
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use vcor_error, only : error_file, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_kinds, only : wp
   use vcor_sweep_quantity, only : point_pending, quantities, quantity_values
   use vcor_text, only : integer_text
   implicit none
   private

   public :: summary_t, new_summary, row_of, numbers_per_point, status_place

   !> Numbers that an outcome is packed into
   integer, parameter :: numbers_per_point = size(quantities) + 2
   !> Place of the status among them
   integer, parameter :: status_place = numbers_per_point

   !> Values of one quantity
   type :: values_t
      !> Values in the unit of the quantity, NaN where a point has none, anything where it is
      !> pending, shape (points)
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
      !> NaN for the values of pending points
      procedure :: blank_pending
   end type summary_t

contains

   !> Make room; all points are pending, and have no values yet
   subroutine new_summary(self, points, error)
      !> The summary
      type(summary_t), intent(out) :: self
      !> Number of points
      integer, intent(in) :: points
      !> Error of code `error_file` if there is not enough memory, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, status

      allocate (self%steps(points), stat=status)
      if (status == 0) allocate (self%status(points), stat=status)
      do i = 1, size(quantities)
         if (status == 0) allocate (self%values(i)%at(points), stat=status)
      end do
      if (status /= 0) call raise(error, error_file, 'there is not enough memory for the ' &
         //'outcomes of '//integer_text(points)//' impacts')
      if (allocated(error)) return
      self%steps = 0
      self%status = point_pending
   end subroutine new_summary

   !> NaN for the values of pending points, before they are written
   pure subroutine blank_pending(self)
      !> The summary
      class(summary_t), intent(inout) :: self

      integer :: i

      do i = 1, size(quantities)
         where (self%status == point_pending) &
            self%values(i)%at = ieee_value(1.0_wp, ieee_quiet_nan)
      end do
   end subroutine blank_pending

   !> An outcome as numbers
   pure function row_of(outcome) result(row)
      !> The outcome
      type(outcome_t), intent(in) :: outcome
      !> Quantities, steps, status
      real(wp) :: row(numbers_per_point)

      row = [quantity_values(outcome), real([outcome%steps, outcome%status], wp)]
   end function row_of

   !> Keep the outcome of a point
   pure subroutine put(self, place, row)
      !> The summary
      class(summary_t), intent(inout) :: self
      !> Its place
      integer, intent(in) :: place
      !> The outcome as numbers, as `row_of` made them
      real(wp), intent(in) :: row(numbers_per_point)

      integer :: i

      do i = 1, size(quantities)
         self%values(i)%at(place) = row(i)
      end do
      self%steps(place) = nint(row(status_place - 1))
      self%status(place) = nint(row(status_place))
   end subroutine put

end module vcor_sweep_summary
