!> Outcomes and trajectories as tables
module vcor_io_results
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : col_time, trajectory_t
   use vcor_io_table, only : add_column, add_dimension, new_table, table_t
   use vcor_kinds, only : wp
   use vcor_study_quantity, only : history_quantities, quantities, quantity_value, status_name
   use vcor_version, only : version
   implicit none
   private

   public :: summary_table, history_table

   !> Steps of a history where the solver does not work in equal steps
   integer, parameter :: history_steps = 500

contains

   !> Summary: a row per impact
   subroutine summary_table(table, title, case_text, outcomes)
      !> The table
      type(table_t), intent(out) :: table
      !> Title of the case
      character(len=*), intent(in) :: title
      !> Full case
      character(len=*), intent(in) :: case_text
      !> Outcomes, shape (n)
      type(outcome_t), intent(in) :: outcomes(:)

      real(wp) :: values(size(outcomes))
      character(len=13) :: status(size(outcomes))
      integer :: i, j

      call new_table(table, version, title, case_text)
      call add_dimension(table, 'impact', size(outcomes))
      do j = 1, size(quantities)
         do i = 1, size(outcomes)
            values(i) = quantity_value(outcomes(i), j)
         end do
         call add_column(table, trim(quantities(j)%name), values, trim(quantities(j)%unit), &
            trim(quantities(j)%meaning))
      end do
      call add_column(table, 'steps', outcomes%steps, '1', 'number of time steps')
      do i = 1, size(outcomes)
         status(i) = status_name(outcomes(i)%status)
      end do
      call add_column(table, 'status', status, '', 'how the contact ended')
   end subroutine summary_table

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

      call new_table(table, version, title, case_text)
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

end module vcor_io_results
