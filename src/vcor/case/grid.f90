!> Grids of parameters: the points of a sweep
!>
!> Points are numbered from 1, in the order of nested loops with the first axis outside: row-major,
!> as C and Python count. A grid without axes has one point. A list of points is a grid in which all
!> axes go on together.
module vcor_case_grid
   use vcor_case_case, only : address_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: axis_t, grid_t

   !> One parameter and its values
   type :: axis_t
      !> Path of the parameter, `group.key` or `material_name.key`
      character(len=:), allocatable :: name
      !> Unit; blank for a pure number
      character(len=:), allocatable :: unit
      !> What it is
      character(len=:), allocatable :: meaning
      !> Its address in the case
      type(address_t) :: address
      !> Values in their unit, shape (n), n >= 1
      real(wp), allocatable :: values(:)
   end type axis_t

   !> All parameters that are varied
   type :: grid_t
      !> Parameters, the slowest first, shape (axes)
      type(axis_t), allocatable :: axes(:)
      !> Whether point i has value i of each parameter: a list of points, not their product
      logical :: is_list = .false.
   contains
      !> Number of points
      procedure :: count => count_points
      !> Which value of each parameter a point has
      procedure :: places
   end type grid_t

contains

   !> Number of points
   pure function count_points(self) result(n)
      !> The grid; the product of its lengths is a default integer
      class(grid_t), intent(in) :: self
      !> Number, at least 1
      integer :: n

      integer :: i

      n = 1
      do i = 1, merge(1, size(self%axes), self%is_list)
         n = n*size(self%axes(i)%values)
      end do
   end function count_points

   !> Which value of each parameter a point has
   pure function places(self, point)
      !> The grid
      class(grid_t), intent(in) :: self
      !> Number of the point, from 1
      integer, intent(in) :: point
      !> Numbers of the values, from 1, shape (axes)
      integer :: places(size(self%axes))

      integer :: i, rest

      places = point
      if (self%is_list) return
      rest = point - 1
      do i = size(self%axes), 1, -1
         associate (n => size(self%axes(i)%values))
            places(i) = mod(rest, n) + 1
            rest = rest/n
         end associate
      end do
   end function places

end module vcor_case_grid
