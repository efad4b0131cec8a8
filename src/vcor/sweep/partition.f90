!> What part of the points of a sweep a run solves, and what is left of it
!>
!> A run has all points, or with `--shard I/N` one of each N that follow one another: the I-th of
!> the first N, the next of the next N, and so on around. So, whatever is swept and wherever its
!> impacts cost most, all shards cost about the same; always the I-th would be the same value of the
!> last parameter where N points make a row of the grid. Within its part a point has a place.
module vcor_sweep_partition
   implicit none
   private

   public :: part_t, new_part, todo_t, new_todo

   !> A part of the points
   type :: part_t
      !> Number of the part, from 1 to `parts`
      integer :: number = 1
      !> Number of parts
      integer :: parts = 1
      !> Points of the whole sweep
      integer :: points = 0
   contains
      !> Number of points of the part
      procedure :: count => count_places
      !> Point at a place
      procedure :: point
   end type part_t

   !> Places that lie one after the other
   type :: range_t
      !> First place
      integer :: first = 1
      !> Last place
      integer :: last = 0
   end type range_t

   !> Places that are still to be solved
   type :: todo_t
      !> Number of places
      integer :: left = 0
      !> Places in ascending order, shape (n)
      type(range_t), allocatable, private :: ranges(:)
      !> Range that is taken from
      integer, private :: at = 1
   contains
      !> Take places off
      procedure :: take
   end type todo_t

contains

   !> A part of a sweep
   pure function new_part(points, number, parts) result(part)
      !> Points of the sweep, > 0
      integer, intent(in) :: points
      !> Number of the part, from 1 to `parts`
      integer, intent(in) :: number
      !> Number of parts, > 0
      integer, intent(in) :: parts
      !> The part
      type(part_t) :: part

      part%points = points
      part%number = number
      part%parts = parts
   end function new_part

   !> Number of points
   pure function count_places(self) result(n)
      !> The part
      class(part_t), intent(in) :: self
      !> Number; 0 where there are more parts than points
      integer :: n

      n = self%points/self%parts
      if (self%point(n + 1) <= self%points) n = n + 1
   end function count_places

   !> Point at a place
   pure function point(self, place)
      !> The part
      class(part_t), intent(in) :: self
      !> Place in the part, from 1
      integer, intent(in) :: place
      !> Number of the point in the whole sweep, from 1
      integer :: point

      point = (place - 1)*self%parts + mod(self%number + place - 2, self%parts) + 1
   end function point

   !> What is left where some places are done
   pure subroutine new_todo(self, done)
      !> What is left
      type(todo_t), intent(out) :: self
      !> Whether a place is done, shape (places)
      logical, intent(in) :: done(:)

      integer :: i, n
      logical :: before

      n = 0
      before = .true.
      do i = 1, size(done)
         if (before .and. .not. done(i)) n = n + 1
         before = done(i)
      end do
      allocate (self%ranges(n))
      n = 0
      before = .true.
      do i = 1, size(done)
         if (.not. done(i)) then
            if (before) then
               n = n + 1
               self%ranges(n)%first = i
            end if
            self%ranges(n)%last = i
            self%left = self%left + 1
         end if
         before = done(i)
      end do
   end subroutine new_todo

   !> Take places off
   pure subroutine take(self, most, first, last)
      !> What is left
      class(todo_t), intent(inout) :: self
      !> Most places to take, > 0
      integer, intent(in) :: most
      !> First place
      integer, intent(out) :: first
      !> Last place; below `first` where nothing is left
      integer, intent(out) :: last

      first = 1
      last = 0
      if (self%left == 0) return
      associate (range => self%ranges(self%at))
         first = range%first
         last = range%last
         if (last - first >= most) last = first + most - 1
         range%first = last + 1
         if (last == range%last) self%at = self%at + 1
      end associate
      self%left = self%left - (last - first + 1)
   end subroutine take

end module vcor_sweep_partition
