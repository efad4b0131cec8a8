!> Contours on a rectangular grid: closed lines around where a function is at least some level
!>
!> Marching squares: a cell's corners are inside (z >= level) or outside; the line crosses each edge
!> whose ends differ, at the place that linear interpolation says. Segments are oriented, the inside
!> at their left, so that every crossing begins one segment and ends another, and following them
!> closes a loop without a search. In a saddle the mean of the corners decides.
!>
!> Around the grid lies a ring of nodes that are outside. So lines close along the edge of the grid,
!> and along holes in it, nodes whose value is not finite.
module vcor_numeric_contour
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_kinds, only : wp
   implicit none
   private

   public :: loop_t, find_loops

   !> A closed line
   type :: loop_t
      !> Its points, each once, shape (n)
      real(wp), allocatable :: x(:), y(:)
      !> Whether a point is on the edge of the grid or of a hole in it rather than on the contour
      logical, allocatable :: on_edge(:)
      !> Signed area: positive around an inside, negative around an outside that is enclosed
      real(wp) :: area = 0.0_wp
   end type loop_t

contains

   !> Closed lines around where z >= level
   subroutine find_loops(x, y, z, level, loops)
      !> Coordinates, in order, shape (nx) and (ny)
      real(wp), intent(in) :: x(:), y(:)
      !> Values, shape (nx, ny); what is not finite is a hole
      real(wp), intent(in) :: z(:, :)
      !> The level; -huge: all that is finite is inside
      real(wp), intent(in) :: level
      !> The lines, shape (n)
      type(loop_t), allocatable, intent(out) :: loops(:)

      logical :: inside(0:size(x) + 1, 0:size(y) + 1), known(0:size(x) + 1, 0:size(y) + 1)
      ! Crossing after a crossing; -1 where there is none
      integer :: next(0:2*(size(x) + 2)*(size(y) + 2) - 1)
      integer :: i, j

      inside = .false.
      known = .false.
      do j = 1, size(y)
         do i = 1, size(x)
            if (.not. ieee_is_finite(z(i, j))) cycle
            known(i, j) = .true.
            inside(i, j) = z(i, j) >= level
         end do
      end do

      next = -1
      do j = 0, size(y)
         do i = 0, size(x)
            call link_cell(i, j)
         end do
      end do

      allocate (loops(0))
      do i = 0, size(next) - 1
         if (next(i) >= 0) call follow(i)
      end do

   contains

      !> Number of the edge from node (i, j) to its right, or upwards
      pure function edge(i, j, upwards) result(number)
         !> The node
         integer, intent(in) :: i, j
         !> 0 to the right, 1 upwards
         integer, intent(in) :: upwards
         !> Its number, from 0
         integer :: number

         number = 2*(j*(size(x) + 2) + i) + upwards
      end function edge

      !> Link the crossings of a cell
      subroutine link_cell(i, j)
         !> Its lower left corner
         integer, intent(in) :: i, j

         ! Corners and edges anticlockwise; edge k goes from corner k to the next
         logical :: corner(4), joined
         integer :: edges(4), k, m, step

         corner = [inside(i, j), inside(i + 1, j), inside(i + 1, j + 1), inside(i, j + 1)]
         if (all(corner) .or. .not. any(corner)) return
         edges = [edge(i, j, 0), edge(i + 1, j, 1), edge(i, j + 1, 0), edge(i, j, 1)]
         joined = .false.
         if ((corner(1) .eqv. corner(3)) .and. all(known(i:i + 1, j:j + 1))) &
            joined = sum(z(i:i + 1, j:j + 1)) >= 4.0_wp*level
         do k = 1, 4
            ! where the inside ends a segment begins: back around it, or across to the other inside
            if (.not. corner(k) .or. corner(modulo(k, 4) + 1)) cycle
            step = merge(1, -1, joined .and. (corner(1) .eqv. corner(3)))
            m = k
            do
               m = modulo(m - 1 + step, 4) + 1
               if (corner(m) .neqv. corner(modulo(m, 4) + 1)) exit
            end do
            next(edges(k)) = edges(m)
         end do
      end subroutine link_cell

      !> Follow a line until it closes
      subroutine follow(first)
         !> A crossing of it
         integer, intent(in) :: first

         type(loop_t) :: loop
         type(loop_t), allocatable :: more(:)
         integer :: count, here, k, then

         count = 0
         here = first
         do
            count = count + 1
            here = next(here)
            if (here == first) exit
         end do
         allocate (loop%x(count), loop%y(count), loop%on_edge(count))
         count = 0
         here = first
         do
            count = count + 1
            call place(here, loop%x(count), loop%y(count), loop%on_edge(count))
            ! the corner of an edge is met twice
            if (count > 1) then
               if (loop%on_edge(count) .and. loop%on_edge(count - 1) &
                  .and. abs(loop%x(count) - loop%x(count - 1)) <= 0.0_wp &
                  .and. abs(loop%y(count) - loop%y(count - 1)) <= 0.0_wp) count = count - 1
            end if
            then = next(here)
            next(here) = -1
            here = then
            if (here == first) exit
         end do
         if (count < 3) return
         loop%x = loop%x(:count)
         loop%y = loop%y(:count)
         loop%on_edge = loop%on_edge(:count)
         do k = 1, count
            associate (after => modulo(k, count) + 1)
               loop%area = loop%area + 0.5_wp*((loop%x(k) - loop%x(1))*(loop%y(after) - loop%y(1)) &
                  - (loop%x(after) - loop%x(1))*(loop%y(k) - loop%y(1)))
            end associate
         end do
         if (.not. abs(loop%area) > 0.0_wp) return

         allocate (more(size(loops) + 1))
         do k = 1, size(loops)
            call move_loop(loops(k), more(k))
         end do
         call move_loop(loop, more(size(more)))
         call move_alloc(more, loops)
      end subroutine follow

      !> Where the line crosses an edge
      pure subroutine place(number, at_x, at_y, on_edge)
         !> The edge
         integer, intent(in) :: number
         !> Coordinates
         real(wp), intent(out) :: at_x, at_y
         !> Whether one end of it is not in the grid: then the place is the other end
         logical, intent(out) :: on_edge

         integer :: i, j, k, l
         real(wp) :: share

         i = modulo(number/2, size(x) + 2)
         j = number/2/(size(x) + 2)
         k = i + 1 - modulo(number, 2)
         l = j + modulo(number, 2)
         on_edge = .not. (known(i, j) .and. known(k, l))
         if (on_edge) then
            if (.not. inside(i, j)) then
               i = k
               j = l
            end if
            at_x = x(i)
            at_y = y(j)
         else
            share = (level - z(i, j))/(z(k, l) - z(i, j))
            at_x = x(i) + share*(x(k) - x(i))
            at_y = y(j) + share*(y(l) - y(j))
         end if
      end subroutine place
   end subroutine find_loops

   !> Move a line
   pure subroutine move_loop(from, to)
      !> Line to move
      type(loop_t), intent(inout) :: from
      !> Where it goes
      type(loop_t), intent(inout) :: to

      call move_alloc(from%x, to%x)
      call move_alloc(from%y, to%y)
      call move_alloc(from%on_edge, to%on_edge)
      to%area = from%area
   end subroutine move_loop

end module vcor_numeric_contour
