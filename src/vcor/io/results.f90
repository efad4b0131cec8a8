!> Outcomes and trajectories as tables
module vcor_io_results
   use vcor_impact_trajectory, only : col_time, history_steps, trajectory_t
   use vcor_io_table, only : add_column, add_dimension, column_of, column_t, integer_column, &
      move_column, new_table, real_column, table_t, text_column
   use vcor_kinds, only : wp
   use vcor_case_grid, only : axis_t, grid_t
   use vcor_sweep_quantity, only : history_quantities, label_length, labels_of, quantity_t
   use vcor_sweep_summary, only : summary_t, values_t
   use vcor_text, only : integer_text
   implicit none
   private

   public :: summary_table, history_table, axis_column, quantity_column

contains

   !> Summary: a row per impact. Its dimensions are what is swept, each by its path; a single impact
   !> has the dimension `impact` of length one
   subroutine summary_table(table, title, case_text, grid, summary)
      type(table_t), intent(out) :: table
      character(len=*), intent(in) :: title
      character(len=*), intent(in) :: case_text
      type(grid_t), intent(in) :: grid
      !> Their outcomes; they move to the table, so that there are not two of a million
      type(summary_t), intent(inout) :: summary

      type(values_t) :: status
      integer :: i

      call new_table(table, 'summary', title, case_text)
      do i = 1, size(grid%axes)
         call add_dimension(table, axis_column(grid%axes(i), grid%axes(i)%values))
      end do
      if (size(grid%axes) == 0) call add_dimension(table, 'impact', 1)
      do i = 1, size(summary%values)
         call move_in(summary%quantities(i), summary%values(i))
      end do
      status%integers = summary%status
      call move_in(summary%quantities(i), status)

   contains

      !> Move the values of a quantity to a column
      subroutine move_in(quantity, values)
         type(quantity_t), intent(in) :: quantity
         type(values_t), intent(inout) :: values

         type(column_t) :: column

         column = quantity_column(quantity, size(summary%status))
         call move_alloc(values%reals, column%reals)
         call move_alloc(values%integers, column%integers)
         if (column%kind == text_column) column%integers = column%integers - quantity%first + 1
         call move_column(table, column)
      end subroutine move_in
   end subroutine summary_table

   !> A column of what is swept
   pure function axis_column(axis, values) result(column)
      type(axis_t), intent(in) :: axis
      !> Its values, in the unit of the parameter
      real(wp), intent(in) :: values(:)
      type(column_t) :: column

      column = column_of(axis%name, values, axis%unit, axis%meaning)
      if (axis%unit == '') column%unit = '1'
   end function axis_column

   !> A column of a summary, without values
   function quantity_column(quantity, length, as_numbers) result(column)
      type(quantity_t), intent(in) :: quantity
      !> Number of its values
      integer, intent(in) :: length
      !> Whether texts stay the numbers that stand for them; absent: false
      logical, intent(in), optional :: as_numbers
      type(column_t) :: column

      character(len=label_length), allocatable :: labels(:)
      integer :: i

      if (quantity%labels == '') then
         column = column_of(quantity%name, [integer ::], quantity%unit, quantity%meaning)
         if (.not. quantity%is_whole) column%kind = real_column
      else
         allocate (labels, source=labels_of(quantity))
         column = column_of(quantity%name, labels, '', quantity%meaning)
         if (present(as_numbers)) then
            column%kind = integer_column
            column%unit = '1'
            do i = 1, size(labels)
               column%long_name = column%long_name//merge(': ', ', ', i == 1) &
                  //integer_text(quantity%first + i - 1)//' '//trim(labels(i))
            end do
         end if
      end if
      column%length = length
   end function quantity_column

   !> History: a row per time
   subroutine history_table(table, title, case_text, trajectory)
      type(table_t), intent(out) :: table
      character(len=*), intent(in) :: title
      character(len=*), intent(in) :: case_text
      type(trajectory_t), intent(in) :: trajectory

      real(wp), allocatable :: state(:, :)
      integer :: j

      call new_table(table, 'history', title, case_text)
      call trajectory%sample(history_steps, state)
      associate (time => history_quantities(col_time))
         call add_dimension(table, column_of(time%name, state(col_time, :), time%unit, &
            time%meaning))
      end associate
      do j = 1, size(history_quantities)
         if (j == col_time) cycle
         associate (quantity => history_quantities(j))
            call add_column(table, column_of(quantity%name, state(j, :), quantity%unit, &
               quantity%meaning))
         end associate
      end do
   end subroutine history_table

end module vcor_io_results
