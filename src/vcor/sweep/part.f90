!> A part of a list of points, which a shard of a sweep solves, or a rank in a round
!>
!> Part I of N has one point of every N consecutive ones: the I-th of the first N, the next one of
!> the next N, and so on cyclically. So all parts take about the same time, wherever in the sweep
!> impacts are slow. (With the I-th point of every N, a part would have a single value of the last
!> parameter if N points are a row of the grid.) Points of a part are numbered by their place in it.
module vcor_sweep_part
   implicit none
   private

   public :: part_t, new_part, most_threads

   !> Largest number of threads of a process
   integer, parameter :: most_threads = 1024

   !> A part of the points
   type :: part_t
      !> Index of the part, 1 .. `parts`
      integer :: number = 1
      integer :: parts = 1
      !> Number of points of all parts
      integer :: points = 0
   contains
      procedure :: point
      procedure :: count => count_places
   end type part_t

contains

   !> A part of a list of points
   pure function new_part(points, number, parts) result(part)
      !> Number of points of all parts, > 0
      integer, intent(in) :: points
      !> Index of the part, 1 .. `parts`
      integer, intent(in) :: number
      !> Number of parts, > 0
      integer, intent(in) :: parts
      type(part_t) :: part

      part = part_t(number=number, parts=parts, points=points)
   end function new_part

   !> Number of points of the part
   pure function count_places(self) result(n)
      class(part_t), intent(in) :: self
      !> Number; 0 if there are more parts than points and this part has none
      integer :: n

      n = self%points/self%parts
      if (self%point(n + 1) <= self%points) n = n + 1
   end function count_places

   !> Point at a place of the part
   pure function point(self, place)
      class(part_t), intent(in) :: self
      !> Place in the part, from 1
      integer, intent(in) :: place
      !> Index of the point among those of all parts, from 1
      integer :: point

      point = (place - 1)*self%parts + mod(self%number + place - 2, self%parts) + 1
   end function point

end module vcor_sweep_part
