!> Maps of an outcome over two parameters, as filled contours with labelled lines
module vcor_figure_map
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_figure_label, only : is_geometric, largest_of, number_text, parameter_label, &
      quantity_label, suit_unit, with_unit
   use vcor_figure_legend, only : legend_t
   use vcor_figure_result, only : get_axes, get_column, result_t
   use vcor_figure_sweep, only : refuse_empty, rising
   use vcor_io_figure, only : add_curve, add_note, figure_axis_t, figure_t, line_grid, new_figure, &
      note_inside, panel_t, plain, shape_filled
   use vcor_io_hdf5_reader, only : dataset_t
   use vcor_kinds, only : wp
   use vcor_numeric_contour, only : find_loops, loop_t
   use vcor_text, only : integer_text
   implicit none
   private

   public :: map_figure

   !> Intervals between levels that are aimed at
   integer, parameter :: wanted_intervals = 10
   !> Least distance of two labels, and of a label from the edge, in widths and heights of the map
   real(wp), parameter :: label_width = 0.17_wp, label_height = 0.1_wp
   !> Shortest line that is labelled, in widths and heights of the map
   real(wp), parameter :: shortest_line = 0.25_wp

   !> A line around an area that is filled
   type :: area_t
      !> The line
      type(loop_t) :: loop
      !> Number of levels that the values in it reach; -1 in a hole
      integer :: band = 0
   end type area_t

contains

   !> A map of a quantity
   subroutine map_figure(results, quantities, figure, error)
      !> Results, one
      type(result_t), intent(in) :: results(:)
      !> Names of quantities of the summary, one
      type(legend_t), intent(in) :: quantities(:)
      type(figure_t), intent(out) :: figure
      !> Error of code `error_input` or `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(dataset_t), allocatable :: axes(:)
      type(dataset_t) :: column
      type(figure_axis_t) :: x_axis, y_axis
      type(area_t), allocatable :: areas(:)
      real(wp), allocatable :: x(:), y(:), z(:, :), levels(:)
      character(len=:), allocatable :: unit
      real(wp) :: factor

      call get_axes(results(1), axes)
      if (size(results) > 1) then
         call raise(error, error_usage, 'a map shows one file of results, found ' &
            //integer_text(size(results)))
      else if (size(quantities) > 1) then
         call raise(error, error_usage, 'a map shows one quantity, found ' &
            //integer_text(size(quantities))//' in --quantity')
      else if (size(axes) /= 2) then
         call raise(error, error_input, results(1)%path//': a map needs a sweep of two ' &
            //'parameters, found '//integer_text(size(axes)))
      else if (min(axes(1)%column%length, axes(2)%column%length) < 2) then
         call raise(error, error_input, results(1)%path//': a map needs at least two values of ' &
            //'each parameter, found one')
      end if
      if (allocated(error)) return
      call get_column(results(1), 'summary', quantities(1)%text, column, error)
      if (.not. allocated(error)) call refuse_empty(results(1), column, error)
      if (allocated(error)) return

      call set_axis(axes(1), x_axis, x)
      call set_axis(axes(2), y_axis, y)
      call suit_unit(column%column%unit, largest_of(column%column%reals), factor, unit)
      ! the second dimension is the fastest
      z = transpose(reshape(factor*column%column%reals, [size(y), size(x)]))
      z = z(rising(x), rising(y))
      x = x(rising(x))
      y = y(rising(y))

      call new_figure(figure, 'map over '//parameter_label(axes(1)%column%name)//' and ' &
         //parameter_label(axes(2)%column%name), panels=1, columns=1)
      associate (panel => figure%panels(1))
         panel%x = x_axis
         panel%y = y_axis
         panel%heading = with_unit(plain(quantity_label(quantities(1)%text, &
            column%column%long_name)), unit)
         call find_levels(pack(z, are_finite(z)), levels)
         call find_areas(x, y, z, levels, areas)
         call fill(panel, areas, size(levels))
         call draw_lines(panel, areas, levels, [x(1), x(size(x))], [y(1), y(size(y))])
      end associate
   end subroutine map_figure

   !> Axis of a parameter and its values as contours take them, the logarithm on such an axis
   subroutine set_axis(parameter, axis, values)
      type(dataset_t), intent(in) :: parameter
      type(figure_axis_t), intent(out) :: axis
      !> Its values, or their decadic logarithms
      real(wp), allocatable, intent(out) :: values(:)

      character(len=:), allocatable :: unit
      real(wp) :: factor

      associate (column => parameter%column)
         call suit_unit(column%unit, largest_of(column%reals), factor, unit)
         axis%label = with_unit(plain(parameter_label(column%name)), unit)
         axis%is_log = is_geometric(column%reals)
         values = factor*column%reals
         axis%lower = minval(values)
         axis%upper = maxval(values)
         if (axis%is_log) values = log10(values)
      end associate
   end subroutine set_axis

   !> Which values are finite
   pure function are_finite(z) result(finite)
      !> Values
      real(wp), intent(in) :: z(:, :)
      !> True where they are
      logical :: finite(size(z, 1), size(z, 2))

      integer :: i, j

      do j = 1, size(z, 2)
         do i = 1, size(z, 1)
            finite(i, j) = ieee_is_finite(z(i, j))
         end do
      end do
   end function are_finite

   !> Round levels between the least and the largest of some values
   pure subroutine find_levels(values, levels)
      !> Values, at least one
      real(wp), intent(in) :: values(:)
      !> Levels, none where all values are the same
      real(wp), allocatable, intent(out) :: levels(:)

      real(wp), parameter :: round_steps(4) = [1.0_wp, 2.0_wp, 2.5_wp, 5.0_wp]
      real(wp) :: range, step
      integer :: i, power

      allocate (levels(0))
      range = maxval(values) - minval(values)
      if (.not. range > 1.0e-10_wp*maxval(abs(values))) return
      power = floor(log10(range/real(wanted_intervals, wp)))
      step = 10.0_wp**(power + 1)
      do i = size(round_steps), 1, -1
         if (round_steps(i)*10.0_wp**power >= range/real(wanted_intervals, wp)) &
            step = round_steps(i)*10.0_wp**power
      end do
      levels = [(step*real(i, wp), i=floor(minval(values)/step) + 1, &
         ceiling(maxval(values)/step) - 1)]
   end subroutine find_levels

   !> All areas, the larger before the smaller that may lie in them
   subroutine find_areas(x, y, z, levels, areas)
      !> Coordinates
      real(wp), intent(in) :: x(:), y(:)
      !> Values, shape (nx, ny)
      real(wp), intent(in) :: z(:, :)
      !> Levels, rising
      real(wp), intent(in) :: levels(:)
      !> Areas, shape (n)
      type(area_t), allocatable, intent(out) :: areas(:)

      type(area_t), allocatable :: more(:)
      type(loop_t), allocatable :: loops(:)
      real(wp), allocatable :: bounds(:)
      type(area_t) :: moved
      integer :: i, j, k

      allocate (areas(0))
      ! first the map as a whole
      bounds = [-huge(1.0_wp), levels]
      do k = 1, size(bounds)
         call find_loops(x, y, z, bounds(k), loops)
         allocate (more(size(areas) + size(loops)))
         more(:size(areas)) = areas
         do i = 1, size(loops)
            more(size(areas) + i)%loop = loops(i)
            more(size(areas) + i)%band = merge(k - 1, k - 2, loops(i)%area > 0.0_wp)
         end do
         call move_alloc(more, areas)
      end do
      do i = 2, size(areas)
         do j = i, 2, -1
            if (abs(areas(j - 1)%loop%area) >= abs(areas(j)%loop%area)) exit
            moved = areas(j)
            areas(j) = areas(j - 1)
            areas(j - 1) = moved
         end do
      end do
   end subroutine find_areas

   !> Fill the areas
   pure subroutine fill(panel, areas, level_count)
      type(panel_t), intent(inout) :: panel
      !> Areas, the larger first
      type(area_t), intent(in) :: areas(:)
      !> Number of levels
      integer, intent(in) :: level_count

      integer :: i, shade

      do i = 1, size(areas)
         shade = -1
         if (areas(i)%band >= 0) shade = nint(100.0_wp*real(areas(i)%band, wp) &
            /real(max(1, level_count), wp))
         call fill_one(panel, areas(i)%loop, shade)
      end do
   end subroutine fill

   !> Fill one area
   pure subroutine fill_one(panel, loop, shade)
      type(panel_t), intent(inout) :: panel
      !> The line around it
      type(loop_t), intent(in) :: loop
      !> Its shade [%]
      integer, intent(in) :: shade

      real(wp) :: x(size(loop%x) + 1), y(size(loop%x) + 1)

      x = [loop%x, loop%x(1)]
      y = [loop%y, loop%y(1)]
      call as_drawn(panel, x, y)
      call add_curve(panel, x, y, shape_filled, shade)
   end subroutine fill_one

   !> Values on the axes for what may be logarithms
   pure subroutine as_drawn(panel, x, y)
      type(panel_t), intent(in) :: panel
      !> Coordinates
      real(wp), intent(inout) :: x(:), y(:)

      if (panel%x%is_log) x = 10.0_wp**x
      if (panel%y%is_log) y = 10.0_wp**y
   end subroutine as_drawn

   !> Draw the lines between the areas, without the edge of the map, and label them
   subroutine draw_lines(panel, areas, levels, x_range, y_range)
      type(panel_t), intent(inout) :: panel
      type(area_t), intent(in) :: areas(:)
      real(wp), intent(in) :: levels(:)
      !> Ends of the coordinates
      real(wp), intent(in) :: x_range(2), y_range(2)

      real(wp) :: placed(2, 200)
      integer :: first, i, j, k, last, n, placed_count, start

      placed_count = 0
      do i = 1, size(areas)
         associate (loop => areas(i)%loop)
            k = areas(i)%band
            if (loop%area < 0.0_wp) k = k + 1
            if (k < 1) cycle
            n = size(loop%x)
            ! begin where the line leaves the edge, if it does
            start = 1
            do first = 1, n
               if (loop%on_edge(first) .and. .not. loop%on_edge(modulo(first, n) + 1)) start = first
            end do
            if (.not. any(loop%on_edge)) then
               call draw_line([(loop%x(at(j)), j=0, n)], [(loop%y(at(j)), j=0, n)], levels(k))
               cycle
            end if
            first = 1
            do while (first < n)
               last = first
               do while (last < n .and. .not. loop%on_edge(at(last)))
                  last = last + 1
               end do
               if (last - first > 1) call draw_line([(loop%x(at(j)), j=first, last - 1)], &
                  [(loop%y(at(j)), j=first, last - 1)], levels(k))
               first = last + 1
            end do
         end associate
      end do

   contains

      !> Place on the loop, so many points after its start
      pure function at(offset) result(place)
         !> Number of points
         integer, intent(in) :: offset
         !> Number of the point
         integer :: place

         place = modulo(start - 1 + offset, n) + 1
      end function at

      !> One line, its label where there is room
      subroutine draw_line(x, y, level)
         !> Its points
         real(wp), intent(in) :: x(:), y(:)
         real(wp), intent(in) :: level

         real(wp), parameter :: tries(7) = [0.5_wp, 0.4_wp, 0.6_wp, 0.3_wp, 0.7_wp, 0.2_wp, 0.8_wp]
         real(wp) :: along(size(x)), spot(2), u(size(x)), v(size(x)), drawn_x(size(x)), &
            drawn_y(size(x))
         integer :: j, t

         drawn_x = x
         drawn_y = y
         call as_drawn(panel, drawn_x, drawn_y)
         call add_curve(panel, drawn_x, drawn_y, line_grid, 1)

         u = (x - x_range(1))/(x_range(2) - x_range(1))
         v = (y - y_range(1))/(y_range(2) - y_range(1))
         along(1) = 0.0_wp
         do j = 2, size(x)
            along(j) = along(j - 1) + hypot(u(j) - u(j - 1), v(j) - v(j - 1))
         end do
         if (along(size(x)) < shortest_line .or. placed_count >= size(placed, 2)) return
         do t = 1, size(tries)
            j = minloc(abs(along - tries(t)*along(size(x))), 1)
            spot = [u(j), v(j)]
            if (abs(spot(1) - 0.5_wp) > 0.5_wp - 0.6_wp*label_width) cycle
            if (abs(spot(2) - 0.5_wp) > 0.5_wp - 0.45_wp*label_height) cycle
            if (any(abs(placed(1, :placed_count) - spot(1)) < label_width &
               .and. abs(placed(2, :placed_count) - spot(2)) < label_height)) cycle
            placed_count = placed_count + 1
            placed(:, placed_count) = spot
            call add_note(panel, note_inside, drawn_x(j), drawn_y(j), number_text(level, 6))
            return
         end do
      end subroutine draw_line
   end subroutine draw_lines

end module vcor_figure_map
