!> Figures of sweeps: outcomes over the parameter that is varied, as Figs. 4, 8 and 9 of the paper
module vcor_figure_sweep
   use vcor_error, only : error_input, error_t, raise
   use vcor_figure_label, only : is_geometric, largest_of, number_text, parameter_label, &
      quantity_label, suit_unit, with_unit
   use vcor_figure_legend, only : column_room, fitted, legend_t, page_room
   use vcor_figure_result, only : get_axes, get_column, result_t
   use vcor_io_figure, only : add_curve, figure_t, line_solid, new_figure, plain, points_only, &
      style_count
   use vcor_io_hdf5_reader, only : dataset_t
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, shortened
   implicit none
   private

   public :: sweep_figure, refuse_empty, rising

   !> One curve: values of a quantity over the parameter
   type :: line_t
      !> Values of the parameter, shape (n)
      real(wp), allocatable :: x(:)
      !> Values of the quantity, shape (n)
      real(wp), allocatable :: y(:)
      !> Text of the legend
      character(len=:), allocatable :: text
   end type line_t

contains

   !> Outcomes over a parameter, a panel for each quantity. One result with two parameters: a curve
   !> for each value of the one that has fewer
   subroutine sweep_figure(results, legends, quantities, figure, error)
      !> Results, shape (n)
      type(result_t), intent(in) :: results(:)
      !> Their texts
      type(legend_t), intent(in) :: legends(:)
      !> Names of quantities of the summary
      type(legend_t), intent(in) :: quantities(:)
      type(figure_t), intent(out) :: figure
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(dataset_t), allocatable :: axes(:), first(:)
      type(line_t), allocatable :: lines(:)
      type(dataset_t) :: column
      character(len=:), allocatable :: unit, label
      real(wp) :: x_factor, y_factor, largest
      integer :: i, j, k
      logical :: is_log

      call get_axes(results(1), first)
      largest = 0.0_wp
      is_log = .true.
      do i = 1, size(results)
         call get_axes(results(i), axes)
         call check_axes(results(i), axes, first, size(results), error)
         if (allocated(error)) return
         j = across(axes)
         largest = max(largest, largest_of(axes(j)%column%reals))
         is_log = is_log .and. is_geometric(axes(j)%column%reals)
      end do
      associate (axis => first(across(first))%column)
         call suit_unit(axis%unit, largest, x_factor, unit)
         label = with_unit(plain(parameter_label(axis%name)), unit)
      end associate

      call new_figure(figure, 'outcomes over '//parameter_label(first(across(first))%column%name), &
         size(quantities), merge(2, 1, size(quantities) > 1))
      do k = 1, size(quantities)
         associate (panel => figure%panels(k))
            largest = 0.0_wp
            do i = 1, size(results)
               call get_column(results(i), 'summary', quantities(k)%text, column, error)
               if (allocated(error)) return
               call refuse_empty(results(i), column, error)
               if (allocated(error)) return
               largest = max(largest, largest_of(column%column%reals))
            end do
            call suit_unit(column%column%unit, largest, y_factor, unit)
            panel%x%label = label
            panel%x%is_log = is_log
            panel%y%label = with_unit(plain(quantity_label(quantities(k)%text, &
               column%column%long_name)), unit)
            do i = 1, size(results)
               call get_column(results(i), 'summary', quantities(k)%text, column, error)
               call get_axes(results(i), axes)
               call cut_lines(axes, column, fitted(legends(i)%text, merge(page_room, column_room, &
                  size(quantities) > 1)), lines)
               do j = 1, size(lines)
                  if (size(results) == 1 .and. size(axes) == 1 .and. .not. legends(i)%given &
                     .or. k > 1) lines(j)%text = ''
                  call add_curve(panel, x_factor*lines(j)%x, y_factor*lines(j)%y, &
                     merge(points_only, line_solid, size(lines(j)%x) == 1), &
                     merge(j, i, size(results) == 1), lines(j)%text)
               end do
            end do
         end associate
      end do
   end subroutine sweep_figure

   !> Which parameter is the horizontal axis: the one with more values
   pure function across(axes) result(place)
      !> Parameters, one or two
      type(dataset_t), intent(in) :: axes(:)
      !> Its number
      integer :: place

      place = 1
      if (size(axes) < 2) return
      if (axes(2)%column%length > axes(1)%column%length) place = 2
   end function across

   !> Refuse what cannot be drawn as curves over one parameter
   subroutine check_axes(result, axes, first, count, error)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> Its parameters
      type(dataset_t), intent(in) :: axes(:)
      !> Those of the first file
      type(dataset_t), intent(in) :: first(:)
      !> Number of files
      integer, intent(in) :: count
      !> Error of code `error_input`, unallocated where all is well
      type(error_t), allocatable, intent(out) :: error

      integer :: curves

      if (size(axes) == 0) then
         call raise(error, error_input, result%path//': this is no sweep: nothing is varied in ' &
            //'it, expected the results of a case with a &sweep group')
      else if (size(axes) > 2) then
         call raise(error, error_input, result%path//': this sweep has '//integer_text(size(axes)) &
            //' parameters, expected one or two')
      else if (size(axes) == 2 .and. count > 1) then
         call raise(error, error_input, result%path//': this sweep has two parameters; with ' &
            //'several files in one figure expected one')
      else if (axes(1)%column%name /= first(1)%column%name) then
         call raise(error, error_input, result%path//": this sweep is over '" &
            //shortened(axes(1)%column%name)//"', that of the first file over '" &
            //shortened(first(1)%column%name)//"'; expected the same parameter")
      end if
      if (allocated(error) .or. size(axes) < 2) return
      curves = axes(3 - across(axes))%column%length
      if (curves > style_count) call raise(error, error_input, result%path//': a curve for each ' &
         //'of the '//integer_text(curves)//" values of '" &
         //shortened(axes(3 - across(axes))%column%name)//"' is more than the " &
         //integer_text(style_count)//' that can be told apart; expected --kind map')
   end subroutine check_axes

   !> Cut the values of a quantity into curves
   subroutine cut_lines(axes, column, text, lines)
      !> Parameters, one or two
      type(dataset_t), intent(in) :: axes(:)
      !> The quantity
      type(dataset_t), intent(in) :: column
      !> Text of the legend where there is one curve
      character(len=*), intent(in) :: text
      !> Curves
      type(line_t), allocatable, intent(out) :: lines(:)

      character(len=:), allocatable :: unit
      real(wp), allocatable :: table(:, :)
      real(wp) :: factor
      integer :: i, place

      place = across(axes)
      associate (x => axes(place)%column%reals, y => column%column%reals)
         if (size(axes) == 1) then
            allocate (lines(1))
            allocate (lines(1)%x, source=x(rising(x)))
            allocate (lines(1)%y, source=y(rising(x)))
            lines(1)%text = text
         else
            ! the last dimension is the fastest
            table = reshape(y, [axes(2)%column%length, axes(1)%column%length])
            if (place == 2) table = transpose(table)
            associate (other => axes(3 - place)%column)
               call suit_unit(other%unit, largest_of(other%reals), factor, unit)
               allocate (lines(other%length))
               do i = 1, size(lines)
                  lines(i)%x = x(rising(x))
                  lines(i)%y = table(i, rising(x))
                  lines(i)%text = plain(parameter_label(other%name))//' = ' &
                     //number_text(factor*other%reals(i), 5)
                  if (unit /= '' .and. unit /= '1') lines(i)%text = lines(i)%text//' '//unit
               end do
            end associate
         end if
      end associate
   end subroutine cut_lines

   !> Order in which values rise: a sweep may have its values in any
   pure function rising(values) result(order)
      real(wp), intent(in) :: values(:)
      !> Their numbers
      integer :: order(size(values))

      integer :: i, j, n

      ! a long list is one of equal steps, upwards or downwards, and in order at once
      n = size(values)
      order = [(merge(i, n + 1 - i, values(1) <= values(n)), i=1, n)]
      do i = 2, n
         do j = i, 2, -1
            if (values(order(j - 1)) <= values(order(j))) exit
            order(j - 1:j) = order([j, j - 1])
         end do
      end do
   end function rising

   !> Refuse a quantity without a single value, or with values that do not fit the parameters
   subroutine refuse_empty(result, column, error)
      !> What a file holds
      type(result_t), intent(in) :: result
      !> The quantity
      type(dataset_t), intent(in) :: column
      !> Error of code `error_input`, unallocated where there are values
      type(error_t), allocatable, intent(out) :: error

      type(dataset_t), allocatable :: axes(:)
      integer :: i

      call get_axes(result, axes)
      if (size(column%lengths) /= size(axes)) then
         i = 1
      else
         do i = 1, size(axes)
            if (axes(i)%column%length /= column%lengths(i)) exit
         end do
      end if
      if (i <= size(axes)) then
         call raise(error, error_input, result%path//": the dimensions of '" &
            //shortened(column%column%name)//"' are not those of the parameters")
      else if (.not. largest_of(column%column%reals) >= 0.0_wp) then
         call raise(error, error_input, result%path//": '"//shortened(column%column%name) &
            //"' has no value at any point: no impact of this sweep has a result")
      end if
   end subroutine refuse_empty

end module vcor_figure_sweep
