!> Newton's method for the equations of a panel, and the guesses it starts from
module vcor_solver_ive_newton
   use vcor_kinds, only : wp
   use vcor_numeric_radau_dense, only : apply, invert, width
   use vcor_numeric_radau_rule, only : bridge_t, rule_t
   use vcor_solver_ive_equations, only : equations_t, motion_t
   use vcor_solver_ive_panel, only : panel_t, step_t
   use vcor_tuning, only : ive_contraction
   implicit none
   private

   public :: solve_panel, solve_companion, guess_growth, guess_rebound

   !> Maximum number of iterations: with 6, 109 random impacts take 6 per cent more panels, with 24
   !> 2 per cent fewer, each after more iterations
   integer, parameter :: most_iterations = 12
   !> Position beyond the end of a panel up to which its polynomials are a guess; those of t1, which
   !> has a vertex, diverge sooner. Half or twice the first makes no panel more or fewer
   real(wp), parameter :: farthest = 2.5_wp, farthest_t1 = 1.2_wp

contains

   !> Solve the equations of a panel, from a guess at indentation or t1 at the stages
   subroutine solve_panel(motion, step, fresh)
      !> The solution; `panel` is solved, or not converged
      type(motion_t), intent(inout) :: motion
      type(step_t), intent(in) :: step
      !> Whether to begin with the Jacobian of this panel, and not with the last one
      logical, intent(in) :: fresh

      ! largest u [m^n] or force [N]
      real(wp), parameter :: beyond_all = 1.0e120_wp
      type(equations_t) :: e
      real(wp) :: change(width), unit, size, last, left, rate
      logical :: stale, regular
      integer :: iteration

      call motion%set_up(step, e)
      motion%panel%converged = .false.
      stale = fresh
      last = 0.0_wp
      do iteration = 1, most_iterations
         call motion%evaluate(e)
         ! a diverging iteration ends before products overflow
         if (.not. largest(e%f) < beyond_all) return
         if (stale .and. .not. e%formed) call e%form_matrix()
         change = e%right - e%x - e%matrix_times(e%f)
         if (e%closes) change(motion%rule%stages) = 0.0_wp
         if (stale) then
            call form_inverse(motion, e, regular)
            if (.not. regular) return
         end if
         change = apply(motion%inverse, change)
         unit = motion%approach%condition
         if (.not. motion%recedes) unit = largest(e%x + change)
         if (.not. unit > 0.0_wp) return
         call motion%move(e, change)
         size = largest(change)/unit
         ! with the Jacobian of this panel the error falls as u does at its branch point, or faster
         if (stale) then
            left = size*sqrt(size)
            stale = size > ive_contraction
         else
            rate = 1.0_wp
            if (iteration > 1) rate = min(1.0_wp, size/last)
            left = 2.0_wp*size*rate
            stale = rate > ive_contraction .and. (iteration > 1 .or. size > ive_contraction)
         end if
         motion%panel%converged = left <= motion%tolerance
         if (motion%panel%converged) exit
         last = max(size, tiny(1.0_wp))
      end do
      if (motion%panel%converged) call motion%finish(e)
   end subroutine solve_panel

   !> Inverse of the Jacobian 1 + M f'
   subroutine form_inverse(motion, e, regular)
      type(motion_t), intent(inout) :: motion
      !> Equations of the panel, evaluated
      type(equations_t), intent(in) :: e
      !> Whether there is one
      logical, intent(out) :: regular

      integer :: j, n

      n = motion%rule%stages
      associate (inverse => motion%inverse)
         do j = 1, width
            inverse(:, j) = e%matrix(:, j)*e%slope(j)
            if (e%closes) inverse(n, j) = 0.0_wp
            inverse(j, j) = inverse(j, j) + 1.0_wp
         end do
         call invert(inverse, regular)
      end associate
   end subroutine form_inverse

   !> Solve a panel that has been solved with one more stage, from the interpolated solution and
   !> with the same Jacobian, between two interpolations: each correction leaves a thirtieth of the
   !> error
   subroutine solve_companion(motion, finer, bridge)
      !> The solution; its panel is solved, or not converged
      type(motion_t), intent(inout) :: motion
      !> The other one, its panel solved
      type(motion_t), intent(in) :: finer
      type(bridge_t), intent(in) :: bridge

      type(equations_t) :: e
      real(wp) :: change(width), unit, size, last
      integer :: iteration

      call guess()
      call motion%set_up(finer%panel%step, e)
      motion%panel%converged = .false.
      last = 0.0_wp
      do iteration = 1, most_iterations
         call motion%evaluate(e)
         change = e%right - e%x - e%matrix_times(e%f)
         if (e%closes) change(motion%rule%stages) = 0.0_wp
         change = apply(bridge%down(:, 1:), apply(finer%inverse, apply(bridge%up, change)))
         unit = motion%approach%condition
         if (.not. motion%recedes) unit = largest(e%x + change)
         size = largest(change)/max(unit, tiny(1.0_wp))
         ! the guess, or the Jacobian, was useless
         if (.not. size <= 1.0_wp .or. iteration > 1 .and. size > ive_contraction*last) exit
         call motion%move(e, change)
         motion%panel%converged = size <= motion%tolerance .or. iteration > 1 &
            .and. size*size <= motion%tolerance*last
         if (motion%panel%converged) exit
         last = max(size, tiny(1.0_wp))
      end do
      if (motion%panel%converged) then
         call motion%finish(e)
      else
         call guess()
         call solve_panel(motion, finer%panel%step, .true.)
      end if

   contains

      !> Interpolate the finer solution
      subroutine guess()

         motion%panel%indentation = 0.0_wp
         motion%panel%t1 = 0.0_wp
         if (motion%recedes) then
            motion%panel%t1(1:) = finer%panel%t1(0)*bridge%down(:, 0) &
               + apply(bridge%down(:, 1:), finer%panel%t1(1:))
         else
            motion%panel%indentation(1:) = finer%panel%indentation(0)*bridge%down(:, 0) &
               + apply(bridge%down(:, 1:), finer%panel%indentation(1:))
         end if
      end subroutine guess
   end subroutine solve_companion

   !> Guess the indentation in a panel from the polynomial of the panel solved last, else a parabola
   subroutine guess_growth(motion, previous, step)
      type(motion_t), intent(inout) :: motion
      !> The panel solved last, accepted or not; without stages if there is none
      type(panel_t), intent(in) :: previous
      type(step_t), intent(in) :: step

      real(wp), dimension(width) :: elapsed, theta, parabola

      associate (s => motion%panel%indentation, start => motion%start, impact => motion%impact)
         elapsed = elapsed_at(motion%rule, step)
         if (start%time > 0.0_wp) then
            parabola = start%indentation + elapsed*(start%velocity &
               - 0.5_wp*elapsed*start%force/impact%mass)
         else
            parabola = impact%free_path(elapsed)
         end if
         s(1:) = parabola
         if (previous%stages == 0) return
         theta = previous%theta(start%time + elapsed)
         s(1:) = merge(motion%rule%interpolate_at(previous%indentation, min(theta, farthest)), &
            parabola, theta < farthest)
      end associate
   end subroutine guess_growth

   !> Guess t1 in a panel of the rebound
   subroutine guess_rebound(motion, previous, step, rate, bend, ends)
      type(motion_t), intent(inout) :: motion
      !> The panel of the rebound solved last, accepted or not; without stages if there is none
      type(panel_t), intent(in) :: previous
      type(step_t), intent(in) :: step
      !> t1' [-] and t1'' [1/s] at the start
      real(wp), intent(in) :: rate, bend
      !> Whether the contact ends with the panel, with t1 = 0
      logical, intent(in) :: ends

      ! slowest fall of t1 after the largest indentation, and the share of the approach for which it
      ! holds: without it 45 of 551 random impacts are computed in other panels, none of them worse
      real(wp), parameter :: slowest = 0.5_wp, near = 0.1_wp
      real(wp), dimension(width) :: elapsed, theta
      real(wp) :: vertex

      vertex = motion%approach%end
      associate (t1 => motion%panel%t1, start => motion%start)
         elapsed = elapsed_at(motion%rule, step)
         t1(1:) = start%t1 + elapsed*(rate + 0.5_wp*bend*elapsed)
         ! t1 ends as the root of the time left
         if (ends) t1(1:) = start%t1*left(elapsed)*(1.0_wp + (1.0_wp - left(elapsed)) &
            *(1.0_wp + 2.0_wp*step%duration*rate/start%t1))
         if (previous%stages > 0) then
            theta = previous%theta(start%time + elapsed)
            t1(1:) = merge(motion%rule%interpolate_at(previous%t1, min(theta, farthest_t1)), &
               t1(1:), theta <= farthest_t1)
         end if
         t1(1:) = min(t1(1:), vertex - slowest*min(start%time + elapsed - vertex, near*vertex))
      end associate

   contains

      !> Root of the share of the step that is left
      elemental function left(elapsed)
         !> Time since its start [s]
         real(wp), intent(in) :: elapsed
         real(wp) :: left

         left = sqrt(max(0.0_wp, 1.0_wp - elapsed/step%duration))
      end function left
   end subroutine guess_rebound

   !> Times of the stages since the start of a step [s]
   pure function elapsed_at(rule, step) result(elapsed)
      type(rule_t), intent(in) :: rule
      type(step_t), intent(in) :: step
      !> Times [s]
      real(wp) :: elapsed(width)

      associate (map => rule%map(step%kind), theta => rule%point(1:))
         elapsed = step%duration*theta*(map%slope + map%bend*theta)
      end associate
   end function elapsed_at

   !> Largest magnitude of the elements
   pure function largest(x)
      real(wp), intent(in) :: x(width)
      real(wp) :: largest

      real(wp) :: half(width/2)
      integer :: i

      do i = 1, width/2
         half(i) = max(abs(x(i)), abs(x(i + width/2)))
      end do
      largest = max(max(half(1), half(2)), max(half(3), half(4)))
   end function largest

end module vcor_solver_ive_newton
