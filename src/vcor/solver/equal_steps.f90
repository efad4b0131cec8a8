!> Evaluation of a course on equal time steps with a shorter last step, common to both direct
!> schemes
module vcor_solver_equal_steps
   use vcor_impact_trajectory, only : col_force, col_indentation, col_time, trajectory_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: parabola, find_peaks

contains

   !> Parabola through values at -1, 0 and 1
   pure function parabola(value, x) result(y)
      real(wp), intent(in) :: value(-1:1)
      !> Argument
      real(wp), intent(in) :: x
      !> Interpolated value
      real(wp) :: y

      y = value(0) + 0.5_wp*x*(value(1) - value(-1) + x*(value(1) - 2.0_wp*value(0) + value(-1)))
   end function parabola

   !> Largest indentation and force, by the parabola through the largest node and its neighbours
   pure subroutine find_peaks(trajectory)
      type(trajectory_t), intent(inout) :: trajectory

      call peak(col_indentation, trajectory%max_indentation, trajectory%time_of_max_indentation)
      call peak(col_force, trajectory%max_force, trajectory%time_of_max_force)

   contains

      !> Peak of one column
      pure subroutine peak(column, value, time)
         integer, intent(in) :: column
         !> Largest value
         real(wp), intent(out) :: value
         !> Time of the largest value [s]
         real(wp), intent(out) :: time

         real(wp) :: y(-1:1), x, bend
         integer :: i

         i = maxloc(trajectory%state(column, 0:trajectory%last), 1) - 1
         value = trajectory%state(column, i)
         time = trajectory%state(col_time, i)
         ! the last node has another distance
         if (i < 1 .or. i > trajectory%last - 2) return
         y = trajectory%state(column, i - 1:i + 1)
         bend = y(1) - 2.0_wp*y(0) + y(-1)
         if (.not. bend < 0.0_wp) return
         x = 0.5_wp*(y(-1) - y(1))/bend
         value = parabola(y, x)
         time = time + x*(trajectory%state(col_time, i + 1) - time)
      end subroutine peak
   end subroutine find_peaks

end module vcor_solver_equal_steps
