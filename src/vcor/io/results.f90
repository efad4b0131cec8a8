!> Outcomes and trajectories as tables, and the files of a summary
module vcor_io_results
   use vcor_error, only : error_t
   use vcor_impact_trajectory, only : col_time, history_steps, trajectory_t
   use vcor_io_csv, only : write_csv
   use vcor_io_hdf5, only : remark_t, write_hdf5
   use vcor_io_table, only : add_column, add_dimension, move_in_column, new_table, table_t
   use vcor_kinds, only : wp
   use vcor_case_grid, only : grid_t
   use vcor_sweep_quantity, only : history_quantities, label_length, labels_of, quantity_t
   use vcor_sweep_summary, only : summary_t, values_t
   implicit none
   private

   public :: summary_table, history_table, write_summary, unit_of

contains

   !> Summary: a row per impact. Its dimensions are what is swept, each by its path; a single impact
   !> has the dimension `impact` of length one
   subroutine summary_table(table, title, case_text, grid, summary)
      !> The table
      type(table_t), intent(out) :: table
      !> Title of the case
      character(len=*), intent(in) :: title
      !> Full case
      character(len=*), intent(in) :: case_text
      !> Points
      type(grid_t), intent(in) :: grid
      !> Their outcomes; they move to the table, so that there are not two of a million
      type(summary_t), intent(inout) :: summary

      integer :: i

      call new_table(table, 'summary', title, case_text)
      do i = 1, size(grid%axes)
         associate (axis => grid%axes(i))
            call add_dimension(table, axis%name, axis%values, unit_of(axis%unit), axis%meaning)
         end associate
      end do
      if (size(grid%axes) == 0) call add_dimension(table, 'impact', 1)
      do i = 1, size(summary%values)
         call move_in_quantity(table, summary%quantities(i), summary%values(i))
      end do
      associate (status => summary%quantities(i))
         call add_labels(table, status, summary%status)
      end associate
   end subroutine summary_table

   !> Move the values of a quantity to a column
   subroutine move_in_quantity(table, quantity, values)
      !> The table
      type(table_t), intent(inout) :: table
      !> The quantity
      type(quantity_t), intent(in) :: quantity
      !> Its values; not allocated afterwards but for texts
      type(values_t), intent(inout) :: values

      if (allocated(values%reals)) then
         call move_in_column(table, trim(quantity%name), values%reals, trim(quantity%unit), &
            trim(quantity%meaning))
      else if (quantity%labels == '') then
         call move_in_column(table, trim(quantity%name), values%integers, trim(quantity%unit), &
            trim(quantity%meaning))
      else
         call add_labels(table, quantity, values%integers)
      end if
   end subroutine move_in_quantity

   !> Add a column of the texts that numbers stand for
   subroutine add_labels(table, quantity, numbers)
      !> The table
      type(table_t), intent(inout) :: table
      !> The quantity
      type(quantity_t), intent(in) :: quantity
      !> Its numbers
      integer, intent(in) :: numbers(:)

      character(len=label_length), allocatable :: labels(:)

      allocate (labels, source=labels_of(quantity))
      call add_column(table, trim(quantity%name), labels(numbers - quantity%first + 1), '', &
         trim(quantity%meaning))
   end subroutine add_labels

   !> Unit as tables have it
   pure function unit_of(unit) result(name)
      !> Unit of a key; blank for a pure number
      character(len=*), intent(in) :: unit
      !> Unit, 1 for a pure number
      character(len=:), allocatable :: name

      name = unit
      if (name == '') name = '1'
   end function unit_of

   !> History: a row per time
   subroutine history_table(table, title, case_text, trajectory)
      !> The table
      type(table_t), intent(out) :: table
      !> Title of the case
      character(len=*), intent(in) :: title
      !> Full case
      character(len=*), intent(in) :: case_text
      !> The trajectory
      type(trajectory_t), intent(in) :: trajectory

      real(wp), allocatable :: state(:, :)
      integer :: j

      call new_table(table, 'history', title, case_text)
      call trajectory%sample(history_steps, state)
      associate (time => history_quantities(col_time))
         call add_dimension(table, trim(time%name), state(col_time, :), trim(time%unit), &
            trim(time%meaning))
      end associate
      do j = 1, size(history_quantities)
         if (j == col_time) cycle
         call add_column(table, trim(history_quantities(j)%name), state(j, :), &
            trim(history_quantities(j)%unit), trim(history_quantities(j)%meaning))
      end do
   end subroutine history_table

   !> Write a summary. HDF5 comes last: where it is there, all is there
   subroutine write_summary(csv, hdf5, table, remarks, error)
      !> Name of the CSV file; empty: none
      character(len=*), intent(in) :: csv
      !> Name of the HDF5 file; empty: none
      character(len=*), intent(in) :: hdf5
      !> A row per impact
      type(table_t), intent(in) :: table
      !> More that describes the HDF5 file, shape (n)
      type(remark_t), intent(in) :: remarks(:)
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (csv /= '') call write_csv(csv, table, error)
      if (allocated(error) .or. hdf5 == '') return
      call write_hdf5(hdf5, table, error, remarks)
   end subroutine write_summary

end module vcor_io_results
