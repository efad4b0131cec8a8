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

   public :: summary_t, new_summary, numbers_per_point

   !> Numbers that an outcome is packed into
   integer, parameter :: numbers_per_point = size(quantities) + 2

   !> Values of one quantity
   type :: values_t
      !> Values in the unit of the quantity, NaN where a point has none, anything where it is
      !> pending, shape (points)
      real(wp), allocatable :: at(:)
   end type values_t

   !> Outcomes
   type :: summary_t
      !> Places before the first one that is kept here
      integer :: before = 0
      !> Quantities, in the order of `quantities`
      type(values_t) :: values(size(quantities))
      !> Time steps, shape (points)
      integer, allocatable :: steps(:)
      !> Status, one of the `contact_*` and `point_*` constants, shape (points)
      integer, allocatable :: status(:)
   contains
      !> Keep the outcome of a point
      procedure :: put
      !> All outcomes as numbers
      procedure :: pack => pack_outcomes
      !> Take outcomes from numbers
      procedure :: unpack => unpack_outcomes
      !> NaN for the values of pending points
      procedure :: blank_pending
   end type summary_t

contains

   !> Make room; all points are pending. Their values are not touched: to fill those of a million
   !> takes longer than to solve ten thousand, and the other ranks wait for it
   subroutine new_summary(self, points, error, before)
      !> The summary
      type(summary_t), intent(out) :: self
      !> Number of points
      integer, intent(in) :: points
      !> Error of code `error_file` if there is not enough memory, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Places before the first one; 0 if it is not given
      integer, intent(in), optional :: before

      integer :: i, status

      if (present(before)) self%before = before
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

   !> Keep the outcome of a point. Points that differ may be put at the same time
   pure subroutine put(self, point, outcome)
      !> The summary
      class(summary_t), intent(inout) :: self
      !> Its place: its number where all points of a sweep are kept, > `before`
      integer, intent(in) :: point
      !> Its outcome
      type(outcome_t), intent(in) :: outcome

      real(wp) :: values(size(quantities))
      integer :: i, place

      place = point - self%before
      values = quantity_values(outcome)
      do i = 1, size(quantities)
         self%values(i)%at(place) = values(i)
      end do
      self%steps(place) = outcome%steps
      self%status(place) = outcome%status
   end subroutine put

   !> All outcomes as numbers
   pure subroutine pack_outcomes(self, numbers)
      !> The summary
      class(summary_t), intent(in) :: self
      !> Numbers, shape (points, numbers_per_point)
      real(wp), intent(out) :: numbers(:, :)

      integer :: i

      do i = 1, size(quantities)
         numbers(:, i) = self%values(i)%at
      end do
      numbers(:, size(quantities) + 1) = real(self%steps, wp)
      numbers(:, size(quantities) + 2) = real(self%status, wp)
   end subroutine pack_outcomes

   !> Take outcomes from numbers
   pure subroutine unpack_outcomes(self, first, numbers)
      !> The summary
      class(summary_t), intent(inout) :: self
      !> Place of the first of them, > `before`
      integer, intent(in) :: first
      !> Numbers, as `pack` made them, shape (points, numbers_per_point)
      real(wp), intent(in) :: numbers(:, :)

      integer :: i, a, b

      a = first - self%before
      b = a + size(numbers, 1) - 1
      do i = 1, size(quantities)
         self%values(i)%at(a:b) = numbers(:, i)
      end do
      self%steps(a:b) = nint(numbers(:, size(quantities) + 1))
      self%status(a:b) = nint(numbers(:, size(quantities) + 2))
   end subroutine unpack_outcomes

end module vcor_sweep_summary
