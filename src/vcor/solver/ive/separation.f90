!> Whether the first separation from a struck structure, at which a march ends, is the last one: if
!> it is not, product integration solves the whole
module vcor_solver_ive_separation
   use vcor_impact_trajectory, only : col_force, col_indentation, col_plate, col_plate_velocity, &
      col_sphere, col_sphere_velocity, col_time, trajectory_t
   use vcor_kinds, only : unset, wp
   use vcor_solver_direct_march, only : comes_back, next_to
   use vcor_solver_ive_equations, only : motion_t
   implicit none
   private

   public :: judge_separation

contains

   !> Find out whether the first separation from a structure is the last, and what energy is left in
   !> it
   subroutine judge_separation(motion, trajectory)
      !> The solution, advanced to the end of the contact
      type(motion_t), intent(in) :: motion
      type(trajectory_t), intent(inout) :: trajectory

      real(wp) :: w

      associate (vibration => motion%sums%vibration, modes => motion%start%modes, &
                 last => trajectory%state(:, trajectory%last))
         trajectory%first_end = last(col_time)
         trajectory%first_velocity = last(col_sphere_velocity)
         w = last(col_indentation)
         if (.not. motion%recedes) w = motion%impact%law%u(w)
         call comes_back(motion%impact, motion%sums%contact, vibration, modes, last, w, &
            motion%start%lag, trajectory%returns)
         if (.not. trajectory%returns) trajectory%returns = all_but_leaves(motion, trajectory)
         trajectory%rigid_velocity = vibration%rigid_velocity(modes)
         trajectory%structure_energy = unset
         ! collocation damps modes that are fast compared with a panel
         if (.not. vibration%relaxes) trajectory%structure_energy = &
            sum(trajectory%share(0:trajectory%last) &
            *trajectory%state(col_plate_velocity, 0:trajectory%last)) - motion%start%lost
      end associate
   end subroutine judge_separation

   !> Whether the sphere is so close to leaving the structure before the end of the contact that it
   !> does at a velocity of the impact next to this one, by the rule of `grazes` in
   !> `vcor_solver_direct_march`. A contact that recedes does not come so far: it has grown again
   function all_but_leaves(motion, trajectory)
      !> The solution, advanced to the end of the contact
      type(motion_t), intent(in) :: motion
      type(trajectory_t), intent(in) :: trajectory
      logical :: all_but_leaves

      ! as many halvings of the golden section as give half of the digits, those of a minimum
      integer, parameter :: most = 36
      real(wp), parameter :: golden = 0.6180339887498949_wp
      real(wp) :: depth(0:trajectory%final), firmness, lower, upper, time(2), value(2)
      integer :: i, k

      all_but_leaves = .false.
      associate (terms => motion%sums%contact, law => motion%impact%law, state => trajectory%state)
         ! a dashpot is left where the force ends, not where a dent is
         if (motion%recedes .or. terms%viscosity > 0.0_wp) return
         firmness = terms%equilibrium + sum(terms%moduli)
         do i = 0, trajectory%final
            depth(i) = state(col_indentation, i) - law%inverse(max(0.0_wp, &
               law%u(state(col_indentation, i)) - state(col_force, i)/firmness))
         end do
         do i = 1, trajectory%last - 1
            if (depth(i) > depth(i - 1) .or. depth(i) >= depth(i + 1)) cycle
            lower = state(col_time, i - 1)
            upper = state(col_time, i + 1)
            do k = 1, most
               time = [upper - golden*(upper - lower), lower + golden*(upper - lower)]
               value = [trajectory%value_at(depth, time(1)), trajectory%value_at(depth, time(2))]
               if (value(1) < value(2)) then
                  upper = time(2)
               else
                  lower = time(1)
               end if
            end do
            all_but_leaves = minval(value) < 2.0_wp*next_to*(abs(state(col_sphere, i)) &
               + abs(state(col_plate, i)))
            if (all_but_leaves) return
         end do
      end associate
   end function all_but_leaves

end module vcor_solver_ive_separation
