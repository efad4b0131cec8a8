!> A part of a list of points: what a shard of a sweep solves, and what a rank solves of a round
!>
!> Part I of N has one of each N points that follow one another: the I-th of the first N, the next
!> of the next N, and so on around. So all parts take about the same time, whatever is swept and
!> wherever its impacts are slowest. (Always the I-th would be the same value of the last parameter
!> where N points make a row of the grid.) Within its part a point has a place.
module vcor_sweep_part
   implicit none
   private

   public :: part_t, new_part, most_threads

   !> Most threads of a process that can be asked for
   integer, parameter :: most_threads = 1024

   !> A part of the points
   type :: part_t
      !> Number of the part, from 1 to `parts`
      integer :: number = 1
      integer :: parts = 1
      !> Points of all parts together
      integer :: points = 0
   contains
      procedure :: point
      procedure :: count => count_places
   end type part_t

contains

   !> A part of a list of points
   pure function new_part(points, number, parts) result(part)
      !> Points of all parts together, > 0
      integer, intent(in) :: points
      !> Number of the part, from 1 to `parts`
      integer, intent(in) :: number
      !> Number of parts, > 0
      integer, intent(in) :: parts
      type(part_t) :: part

      part = part_t(number=number, parts=parts, points=points)
   end function new_part

   !> Number of points
   pure function count_places(self) result(n)
      class(part_t), intent(in) :: self
      !> Number; 0 where there are more parts than points and this one has none
      integer :: n

      n = self%points/self%parts
      if (self%point(n + 1) <= self%points) n = n + 1
   end function count_places

   !> Point at a place
   pure function point(self, place)
      class(part_t), intent(in) :: self
      !> Place in the part, from 1
      integer, intent(in) :: place
      !> Number of the point among those of all parts, from 1
      integer :: point

      point = (place - 1)*self%parts + mod(self%number + place - 2, self%parts) + 1
   end function point

end module vcor_sweep_part
