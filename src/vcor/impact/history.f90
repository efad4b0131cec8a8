!> History of an impact: the states of its trajectory with the contact radius, which is that of the
!> method if it has one, and otherwise that of the contact law
module vcor_impact_history
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_indentation, col_time, columns, trajectory_t
   use vcor_kinds, only : unset, wp
   implicit none
   private

   public :: history, history_columns

   !> Rows of a history: those of the state of a trajectory and, last, the contact radius [m]
   integer, parameter :: history_columns = columns + 1

   !> Equal steps in which the law of a contact that recedes is followed
   integer, parameter :: law_steps = 1000

contains

   !> History at equal steps of time, see `sample` of `trajectory_t`
   pure subroutine history(impact, trajectory, count, rows)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      !> Number of steps, > 0; has no effect for a solver with equal steps
      integer, intent(in) :: count
      !> Rows, shape (history_columns, 0:)
      real(wp), allocatable, intent(out) :: rows(:, :)

      real(wp), allocatable :: state(:, :), depth(:)
      real(wp) :: step
      integer :: i

      call trajectory%sample(count, state)
      allocate (rows(history_columns, 0:ubound(state, 2)))
      rows(:columns, :) = state
      rows(history_columns, :) = unset
      if (.not. allocated(trajectory%state)) return
      if (allocated(trajectory%radius)) then
         rows(history_columns, :) = trajectory%radius(0:ubound(state, 2))
         return
      end if
      call contact_depths(impact, trajectory, depth, step)
      do i = 0, ubound(state, 2)
         associate (time => rows(col_time, i), radius => rows(history_columns, i))
            if (time > trajectory%state(col_time, trajectory%last)) exit
            radius = impact%contact_radius(depth_at(impact, depth, step, time, &
               rows(col_indentation, i)))
         end associate
      end do
   end subroutine history

   !> Depth that the contact law has for the radius: the indentation, or less once a receding
   !> contact shrinks
   pure function depth_at(impact, depth, step, time, indentation) result(value)
      type(impact_t), intent(in) :: impact
      !> Depths of `contact_depths` [m], shape (0:), and their step [s]
      real(wp), intent(in) :: depth(0:), step
      !> Time since first contact [s]
      real(wp), intent(in) :: time
      !> Indentation [m]
      real(wp), intent(in) :: indentation
      !> Depth [m]; NaN where a method has none
      real(wp) :: value

      real(wp) :: part
      integer :: i

      value = max(indentation, 0.0_wp)
      if (.not. impact%law%receding) return
      i = min(int(time/step), ubound(depth, 1) - 1)
      part = time/step - real(i, wp)
      ! while it grows the indentation itself is exact
      if (depth(i + 1) < depth(i) .or. .not. depth(i + 1) >= 0.0_wp) &
         value = (1.0_wp - part)*depth(i) + part*depth(i + 1)
   end function depth_at

   !> Indentation at the time t1 at which a receding contact was growing and as large as now, by
   !>
   !>     int_t1^t k(t - x) s'(x) dx = 0,
   !>
   !> with s linear over each step. A contact that grows again has no single t1: NaN from where it
   !> first shrinks
   pure subroutine contact_depths(impact, trajectory, depth, step)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      !> Depths [m], shape (0:); of a law that does not recede of no use
      real(wp), allocatable, intent(out) :: depth(:)
      !> Step [s]
      real(wp), intent(out) :: step

      real(wp) :: s(0:law_steps), kernel(0:law_steps - 1), sum, term
      integer :: i, j, first

      step = trajectory%state(col_time, trajectory%last)/real(law_steps, wp)
      allocate (depth(0:law_steps), source=unset)
      if (.not. impact%law%receding) return
      s(0) = 0.0_wp
      do i = 1, law_steps
         s(i) = trajectory%indentation_at(real(i, wp)*step)
      end do
      kernel = impact%kernel_step_integrals(step, law_steps)
      kernel(0) = kernel(0) + impact%kernel_viscosity()
      depth = s
      do first = 1, law_steps
         if (s(first) < s(first - 1)) exit
      end do
      if (trajectory%regrows) then
         depth(first:) = unset
         return
      end if
      do i = first, law_steps
         sum = 0.0_wp
         do j = i, 1, -1
            term = kernel(i - j)*(s(j) - s(j - 1))
            if (sum < 0.0_wp .and. sum + term >= 0.0_wp) exit
            sum = sum + term
         end do
         depth(i) = 0.0_wp
         if (j > 0) depth(i) = s(j) + sum/kernel(i - j)
      end do
   end subroutine contact_depths

end module vcor_impact_history
