!> Outcomes of many impacts, column by column, each in the place of its point
module vcor_sweep_summary
   use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
   use vcor_error, only : error_file, error_t, raise
   use vcor_kinds, only : wp
   use vcor_sweep_part, only : part_t
   use vcor_sweep_quantity, only : point_pending, quantities, quantity_t
   use vcor_text, only : integer_text
   implicit none
   private

   public :: summary_t, values_t, new_summary

   !> Values of one column, shape (points); NaN or 0 where a point has none, anything where it is
   !> pending
   type :: values_t
      !> Of numbers, in their unit
      real(wp), allocatable :: reals(:)
      !> Of whole numbers and of the numbers that stand for texts
      integer, allocatable :: integers(:)
   end type values_t

   !> Outcomes
   type :: summary_t
      !> What the columns are, the status the last one
      type(quantity_t), allocatable :: quantities(:)
      !> All but the status, in the order of `quantities`
      type(values_t), allocatable :: values(:)
      !> Status, one of the `contact_*` and `point_*` constants, shape (points)
      integer, allocatable :: status(:)
   contains
      procedure :: put, put_part, blank_pending
   end type summary_t

contains

   !> Make room; all points are pending, and have no values yet
   subroutine new_summary(self, points, error)
      type(summary_t), intent(out) :: self
      integer, intent(in) :: points
      !> Error of code `error_file` if there is not enough memory, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, status

      allocate (self%quantities, source=quantities())
      allocate (self%values(size(self%quantities) - 1))
      allocate (self%status(points), stat=status)
      do i = 1, size(self%values)
         if (status /= 0) exit
         if (self%quantities(i)%is_whole) then
            allocate (self%values(i)%integers(points), stat=status)
         else
            allocate (self%values(i)%reals(points), stat=status)
         end if
      end do
      if (status == 0) then
         self%status = point_pending
      else
         call raise(error, error_file, 'there is not enough memory for the outcomes of ' &
            //integer_text(points)//' impacts')
      end if
   end subroutine new_summary

   !> NaN or 0 for the values of pending points, before they are written
   pure subroutine blank_pending(self)
      class(summary_t), intent(inout) :: self

      integer :: i

      do i = 1, size(self%values)
         associate (values => self%values(i))
            if (allocated(values%integers)) then
               where (self%status == point_pending) values%integers = 0
            else
               where (self%status == point_pending) &
                  values%reals = ieee_value(1.0_wp, ieee_quiet_nan)
            end if
         end associate
      end do
   end subroutine blank_pending

   !> Keep the outcome of a point
   pure subroutine put(self, place, values)
      class(summary_t), intent(inout) :: self
      integer, intent(in) :: place
      !> The outcome as numbers, as `values_of` makes them
      real(wp), intent(in) :: values(:)

      integer :: i

      do i = 1, size(self%values)
         if (allocated(self%values(i)%integers)) then
            self%values(i)%integers(place) = nint(values(i))
         else
            self%values(i)%reals(place) = values(i)
         end if
      end do
      self%status(place) = nint(values(size(values)))
   end subroutine put

   !> Keep the outcomes of a part
   pure subroutine put_part(self, part, outcomes)
      class(summary_t), intent(inout) :: self
      type(part_t), intent(in) :: part
      !> Outcomes of its points
      type(summary_t), intent(in) :: outcomes

      integer :: i, j

      do i = 1, size(self%values)
         associate (all_values => self%values(i), values => outcomes%values(i))
            do j = 1, part%count()
               if (allocated(values%reals)) then
                  all_values%reals(part%point(j)) = values%reals(j)
               else
                  all_values%integers(part%point(j)) = values%integers(j)
               end if
            end do
         end associate
      end do
      do j = 1, part%count()
         self%status(part%point(j)) = outcomes%status(j)
      end do
   end subroutine put_part

end module vcor_sweep_summary
