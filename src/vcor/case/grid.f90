!> Grids of parameters: the points of a sweep
!>
!> Points are numbered from 1, in the order of nested loops with the first axis outermost:
!> row-major, as in C and Python. A grid without axes has one point. A list of points is a grid
!> whose axes vary together.
module vcor_case_grid
   use vcor_error, only : error_file, error_t, raise
   use vcor_kinds, only : wp
   use vcor_case_address, only : resolve
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, groups, key_t, keys_of, most_points, real_key, &
      row_for_model
   use vcor_case_entries, only : address_t, operator(==)
   use vcor_number, only : log_spacing, real_text, spaced
   use vcor_rounded, only : plain_number
   use vcor_text, only : integer_text, link_name, shortened
   use vcor_words, only : join_words
   implicit none
   private

   public :: axis_t, grid_t, new_grid, coordinates

   !> Largest number of parameters: each is a dimension in the HDF5 file, which has at most 32
   integer, parameter :: most_axes = 32

   !> A parameter and its values
   type :: axis_t
      !> Path of the parameter, `group.key` or `material_name.key`
      character(len=:), allocatable :: name
      !> Unit; blank for a pure number
      character(len=:), allocatable :: unit
      !> Meaning
      character(len=:), allocatable :: meaning
      !> Its address in the case
      type(address_t) :: address
      !> Values in their unit, shape (n), n >= 1
      real(wp), allocatable :: values(:)
   end type axis_t

   !> All parameters that vary
   type :: grid_t
      !> Parameters, the slowest first, shape (axes)
      type(axis_t), allocatable :: axes(:)
      !> Whether point i has value i of each parameter: a list of points, not their product
      logical :: is_list = .false.
   contains
      procedure :: places, case_at
      procedure :: count => count_points
   end type grid_t

contains

   !> Number of points
   pure function count_points(self) result(n)
      !> The grid; its number of points must not exceed the largest integer
      class(grid_t), intent(in) :: self
      !> Number, at least 1
      integer :: n

      integer :: i

      n = 1
      do i = 1, merge(1, size(self%axes), self%is_list)
         n = n*size(self%axes(i)%values)
      end do
   end function count_points

   !> Indices of the values of a point
   pure function places(self, point)
      class(grid_t), intent(in) :: self
      !> Index of the point, from 1
      integer, intent(in) :: point
      !> Indices of the values, from 1, shape (axes)
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

   !> The case of a point
   pure function case_at(self, case, point) result(other)
      class(grid_t), intent(in) :: self
      !> The case of the grid
      type(case_t), intent(in) :: case
      !> Index of the point, from 1
      integer, intent(in) :: point
      type(case_t) :: other

      integer :: i, places(size(self%axes))

      places = self%places(point)
      other = case
      do i = 1, size(places)
         call other%drop_alternative(self%axes(i)%address, always=.true.)
         call other%set(self%axes(i)%address, self%axes(i)%values(places(i)))
      end do
   end function case_at

   !> Build the grid of a case; the ranges of the keys are not checked
   subroutine new_grid(case, grid, error)
      !> A case whose entries are within their ranges
      type(case_t), intent(in) :: case
      !> The grid; without axes if the case has no &sweep group
      type(grid_t), intent(out) :: grid
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: points
      integer :: item

      allocate (grid%axes(case%count('sweep')))
      if (size(grid%axes) > most_axes) then
         call case%refuse('sweep', 'parameter', most_axes + 1, 'found ' &
            //integer_text(size(grid%axes))//' &sweep groups, expected at most ' &
            //integer_text(most_axes)//', the dimensions that an HDF5 file may have', error)
         return
      end if
      points = 1.0_wp
      do item = 1, size(grid%axes)
         call find_parameter(case, item, grid%axes(:item - 1), grid%axes(item), error)
         if (allocated(error)) return
         call find_values(case, item, points, grid%axes(item)%values, error)
         if (allocated(error)) return
         points = points*real(size(grid%axes(item)%values), wp)
      end do
   end subroutine new_grid

   !> Find the parameter of a &sweep group
   subroutine find_parameter(case, item, before, axis, error)
      type(case_t), intent(in) :: case
      !> Index of the group
      integer, intent(in) :: item
      !> Parameters of the previous groups, shape (item - 1)
      type(axis_t), intent(in) :: before(:)
      !> Parameter without its values
      type(axis_t), intent(out) :: axis
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: path, message, model
      integer :: group, row, i

      call case%get('sweep', 'parameter', path, item)
      call resolve(case, path, axis%address, message)
      if (allocated(message)) then
         call case%refuse('sweep', 'parameter', item, message, error)
         return
      end if

      axis%name = case%path(axis%address)
      group = axis%address%group
      row = axis%address%row
      model = case%model(group, axis%address%item)
      if (groups(group)%name == 'sweep') then
         message = "found '"//shortened(path)//"', but a sweep cannot vary a sweep"
      else if (groups(group)%name == 'output') then
         message = "found '"//shortened(path)//"', but a sweep cannot vary its own output"
      else if (row_for_model(row, model) == 0) then
         message = "key '"//trim(catalogue(row)%name)//"' does not belong to model '"//model &
            //"', its keys are: "//join_words(keys_of(group, model))
      else if (catalogue(row)%value_kind /= real_key .and. axis%address%element == 0) then
         message = "found '"//shortened(path)//"', which is "//kind_of(catalogue(row)) &
            //'; expected a single real number'
      end if
      do i = 1, size(before)
         if (before(i)%address == axis%address) then
            message = "'"//shortened(path)//"' is swept twice, the first at " &
               //case%location('sweep', 'parameter', i)
         else if (link_name(before(i)%name) == link_name(axis%name)) then
            message = "'"//shortened(path)//"' and '"//shortened(before(i)%name) &
               //"' have the same name in HDF5 files, where a slash is '_': rename a material"
         end if
      end do
      if (allocated(message)) then
         call case%refuse('sweep', 'parameter', item, message, error)
         return
      end if
      row = row_for_model(row, model)
      axis%unit = trim(catalogue(row)%unit)
      axis%meaning = trim(catalogue(row)%meaning)
   end subroutine find_parameter

   !> Kind of a key in words
   pure function kind_of(key) result(words)
      type(key_t), intent(in) :: key
      !> Such as `a list`
      character(len=:), allocatable :: words

      character(len=*), parameter :: names(*) = [character(len=14) :: 'a number', &
         'a whole number', 'a switch', 'a text', 'a list']

      words = trim(names(key%value_kind))
   end function kind_of

   !> Values of a &sweep group
   subroutine find_values(case, item, points, values, error)
      type(case_t), intent(in) :: case
      !> Index of the group
      integer, intent(in) :: item
      !> Number of points of the previous groups
      real(wp), intent(in) :: points
      !> Values, shape (n), n >= 1
      real(wp), allocatable, intent(out) :: values(:)
      type(error_t), allocatable, intent(out) :: error

      character(len=5), parameter :: ends(3) = [character(len=5) :: 'start', 'stop', 'count']
      character(len=:), allocatable :: spacing
      real(wp), allocatable :: room(:)
      real(wp) :: start, stop
      integer :: i, n, status

      call case%get('sweep', 'spacing', spacing, item)
      if (case%given('sweep', 'values', item)) then
         do i = 1, size(ends)
            if (case%given('sweep', trim(ends(i)), item)) call case%refuse('sweep', trim(ends(i)), &
               item, 'found both values and '//trim(ends(i))//', expected values, or start, ' &
               //'stop and count', error)
            if (allocated(error)) return
         end do
         call case%get('sweep', 'values', values, item)
         n = size(values)
         if (spacing == log_spacing) then
            call case%refuse('sweep', 'spacing', item, "spacing = 'log' is for start, stop and " &
               //'count, found values', error)
         else if (n == 0) then
            call case%refuse('sweep', 'values', item, 'the list is empty, expected one value or ' &
               //'more', error)
         end if
      else
         do i = 1, size(ends)
            if (case%given('sweep', trim(ends(i)), item)) cycle
            call case%refuse('sweep', trim(ends(i)), item, "key '"//trim(ends(i)) &
               //"' is missing in &sweep, expected values, or start, stop and count", error)
            return
         end do
         call case%get('sweep', 'start', start, item)
         call case%get('sweep', 'stop', stop, item)
         call case%get('sweep', 'count', n, item)
         if (spacing == log_spacing .and. .not. start > 0.0_wp) then
            call case%refuse('sweep', 'start', item, "found start = "//real_text(start) &
               //", expected start > 0 with spacing = 'log'", error)
         else if (spacing == log_spacing .and. .not. stop > 0.0_wp) then
            call case%refuse('sweep', 'stop', item, "found stop = "//real_text(stop) &
               //", expected stop > 0 with spacing = 'log'", error)
         end if
      end if
      if (allocated(error)) return
      if (points*real(n, wp) > real(most_points, wp)) then
         call case%refuse('sweep', 'parameter', item, 'the grid has ' &
            //real_text(points*real(n, wp))//' points, expected at most ' &
            //integer_text(most_points), error)
         return
      end if
      if (.not. allocated(values)) then
         ! room for copies and sorting, too
         allocate (room(4*n), stat=status)
         if (status /= 0) then
            call raise(error, error_file, case%location('sweep', 'count', item)//': there is ' &
               //'not enough memory for a sweep of '//integer_text(n)//' points: their values ' &
               //'alone take '//integer_text(n/125000 + 1)//' MB')
            return
         end if
         deallocate (room)
         values = spaced(start, stop, n, spacing)
      end if
      call refuse_repeated(case, item, values, error)
   end subroutine find_values

   !> Refuse a repeated value: its points would be solved twice, and files could not distinguish
   !> them
   subroutine refuse_repeated(case, item, values, error)
      type(case_t), intent(in) :: case
      !> Index of the &sweep group
      integer, intent(in) :: item
      !> Its values, shape (n)
      real(wp), intent(in) :: values(:)
      !> Error; unallocated if no two values are equal
      type(error_t), allocatable, intent(inout) :: error

      real(wp), allocatable :: sorted(:)
      character(len=:), allocatable :: key
      integer :: i, n

      n = size(values)
      if (all(values(2:) > values(:n - 1)) .or. all(values(2:) < values(:n - 1))) return
      sorted = values
      call sort(sorted)
      do i = 2, n
         if (sorted(i) > sorted(i - 1)) cycle
         key = 'count'
         if (case%given('sweep', 'values', item)) key = 'values'
         call case%refuse('sweep', key, item, 'the value '//real_text(sorted(i)) &
            //' is there twice, expected different values', error)
         return
      end do
   end subroutine refuse_repeated

   !> Sort numbers in at most order n^1.5 operations: Shell's sort with Knuth's gaps
   pure subroutine sort(values)
      !> Finite numbers; on return increasing, shape (n)
      real(wp), intent(inout) :: values(:)

      real(wp) :: value
      integer :: gap, i, j

      gap = 1
      do while (gap < size(values)/3)
         gap = 3*gap + 1
      end do
      do while (gap > 0)
         do i = gap + 1, size(values)
            value = values(i)
            do j = i - gap, 1, -gap
               if (values(j) <= value) exit
               values(j + gap) = values(j)
            end do
            values(j + gap) = value
         end do
         gap = gap/3
      end do
   end subroutine sort

   !> Names and values of the swept parameters at a point
   function coordinates(grid, point) result(text)
      type(grid_t), intent(in) :: grid
      integer, intent(in) :: point
      character(len=:), allocatable :: text

      integer :: i, places(size(grid%axes))

      places = grid%places(point)
      text = ''
      do i = 1, size(places)
         text = text//', '//grid%axes(i)%name//' = ' &
            //plain_number(grid%axes(i)%values(places(i)), 8)
      end do
      text = text(3:)
   end function coordinates

end module vcor_case_grid
