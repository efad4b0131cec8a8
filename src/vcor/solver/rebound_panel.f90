!> One panel of the rebound of a receding contact in the internal-variable method
!>
!> The force is a function F(N) of the condition N = int_0^t k(t - x) s'(x) dx, known from the
!> approach (`vcor_solver_approach`). With the matrices of the panel as in `vcor_solver_panel`,
!> N = G_0 s_n + S (s - s_n) + b + eta s' with what has not relaxed of s_n in b, and s = s_0 - R F,
!> s' = v_0 - Q F with what F does to the motion in R and Q. What is left is
!>
!>     N + T F(N) = G_0 s_n + S (s_0 - s_n) + b + eta v_0,    T = S R + eta Q
!>
!> for the stage values of N. A dashpot gives no force once the contact shrinks, but takes part in
!> the condition.
module vcor_solver_rebound_panel
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, panel_map_t, width
   use vcor_numeric_linear, only : apply, factorise, factors_t
   use vcor_numeric_pairs, only : constant, times
   use vcor_solver_approach, only : approach_t
   use vcor_solver_general_panel, only : function_of_h
   use vcor_solver_modes, only : advance_modes, lags_at_end, start_t, sum_modes
   use vcor_solver_panel, only : panel_t
   implicit none
   private

   public :: rebound_start_t, rebound_panel_t
   public :: turn_round, solve_rebound_panel, advance_rebound

   !> State at the start of a panel of the rebound
   type :: rebound_start_t
      !> Time [s]
      real(wp) :: time = 0.0_wp
      !> Indentation s [m]
      real(wp) :: indentation = 0.0_wp
      !> Force [N]
      real(wp) :: force = 0.0_wp
      !> Condition N [N/m^0.5]
      real(wp) :: condition = 0.0_wp
      !> Condition at the largest indentation, against which its errors are counted [N/m^0.5]
      real(wp) :: largest_condition = 0.0_wp
      !> t1 [s]
      real(wp) :: t1 = 0.0_wp
      !> Impulse I [N s]
      real(wp) :: impulse = 0.0_wp
      !> Integral of the impulse J [N s2]
      real(wp) :: second_impulse = 0.0_wp
      !> Deflection U of a frozen plate, or the part of a hereditary plate's memory in it [m]
      real(wp) :: deflection = 0.0_wp
      !> What the velocity of the plate falls behind alpha F [m/s]
      real(wp) :: drift = 0.0_wp
      !> What has not relaxed of the indentation, w_k [m], shape (modes)
      real(wp), allocatable :: w(:)
      !> Memory P_j of a hereditary plate [N s], shape (modes of the plate)
      real(wp), allocatable :: p(:)
   end type rebound_start_t

   !> Solution on a panel of the rebound
   type, extends(panel_t) :: rebound_panel_t
      !> Condition N [N/m^0.5]
      real(wp) :: condition(0:width) = 0.0_wp
      !> t1 [s]; on entry of the solver a guess
      real(wp) :: t1(0:width) = 0.0_wp
   end type rebound_panel_t

contains

   !> State at the largest indentation, where the approach has ended and the rebound begins
   pure subroutine turn_round(kernel, start, approach, rebound)
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State at the end of the approach
      type(start_t), intent(in) :: start
      !> The approach
      type(approach_t), intent(in) :: approach
      !> The same state for the rebound
      type(rebound_start_t), intent(out) :: rebound

      rebound%time = start%time
      rebound%indentation = start%indentation
      rebound%force = start%force
      rebound%condition = kernel%equilibrium*start%indentation &
         + sum(kernel%moduli*approach%w)
      rebound%largest_condition = rebound%condition
      rebound%t1 = start%time
      rebound%impulse = start%impulse
      rebound%second_impulse = start%second_impulse
      rebound%deflection = start%deflection
      rebound%drift = start%drift
      allocate (rebound%w, source=approach%w)
      allocate (rebound%p, source=start%p)
   end subroutine turn_round

   !> Solve the collocation equations on a panel by Newton's method
   subroutine solve_rebound_panel(rule, map, scale, impact, kernel, memory, approach, start, &
                                  tolerance, panel)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> Memory of a hereditary plate
      type(exponential_sum_t), intent(in) :: memory
      !> The approach
      type(approach_t), intent(in) :: approach
      !> State at the start
      type(rebound_start_t), intent(in) :: start
      !> Wanted error of the condition over its largest value
      real(wp), intent(in) :: tolerance
      !> The panel
      type(rebound_panel_t), intent(inout) :: panel

      integer, parameter :: most_iterations = 40
      ! share of Newton's tolerance that t1 is solved to
      real(wp), parameter :: inner = 0.1_wp
      ! what rounding may leave of a correction
      real(wp), parameter :: noise = 1.0e-9_wp
      ! a correction over the largest condition that leads nowhere
      real(wp), parameter :: wildest = 1.0e3_wp
      real(wp), dimension(width) :: elapsed, alpha, alpha_rate, share, b, lost
      real(wp), dimension(width) :: known_s, known_v, gained
      real(wp), dimension(width) :: known, condition, force, slope, change
      real(wp), dimension(width, width) :: h, r, s, q, t
      type(factors_t) :: factors
      real(wp) :: size_now, size_before
      integer :: n, i, j, iteration
      logical :: regular, frozen, remembers, stands_still

      n = rule%stages
      frozen = impact%plate%frozen()
      remembers = size(memory%rates) > 0
      panel%stages = n
      panel%map = scale*[map%slope, map%bend]
      elapsed = rule%node*(panel%map(1) + panel%map(2)*rule%node)
      panel%time(0) = start%time
      panel%time(1:) = start%time + elapsed
      alpha = 0.0_wp
      alpha_rate = 0.0_wp
      do i = 1, n
         call impact%plate%alpha_and_rate(panel%time(i), alpha(i), alpha_rate(i))
      end do
      if (remembers) alpha(1:n) = memory%viscosity
      panel%alpha(1:) = alpha

      h = scale*map%matrix
      call sum_modes(kernel%moduli, kernel%rates, start%w, map, scale, share, b)
      s = function_of_h(map, share + constant(kernel%equilibrium))

      ! s = known_s - R F, s' = known_v - Q F
      known_s = impact%velocity*panel%time(1:) &
         - (start%second_impulse + start%impulse*elapsed)/impact%mass
      known_v = impact%velocity - start%impulse/impact%mass
      lost = 0.0_wp
      ! s - s_n, from which the condition is made: modes that settle at once leave no digits of s
      gained = (impact%velocity - start%impulse/impact%mass)*elapsed
      if (frozen) then
         known_s = known_s - start%deflection + start%drift*elapsed
         gained = gained + start%drift*elapsed
         known_v = known_v + start%drift
         do j = 1, width
            q(:, j) = h(:, j)*(1.0_wp/impact%mass - alpha_rate(j))
         end do
         r = matmul(h, q)
         do j = 1, width
            r(:, j) = r(:, j) + h(:, j)*alpha(j)
            q(j, j) = q(j, j) + alpha(j)
         end do
      else
         known_s = known_s - alpha*start%impulse
         gained = gained - (alpha - merge(memory%viscosity, impact%plate%alpha(start%time), &
            remembers))*start%impulse
         known_v = known_v - alpha_rate*start%impulse
         q = h/impact%mass
         if (remembers) then
            ! U' has sum w_j P_j, P_j = (1 + l_j H)^-1 (P_j,n + H F)
            call sum_modes(memory%moduli, memory%rates, start%p, map, scale, share, lost)
            q = q + matmul(function_of_h(map, share), h)
            known_s = known_s - start%deflection - apply(h, lost)
            gained = gained - apply(h, lost)
            known_v = known_v - lost
         end if
         r = matmul(h, q)
         do j = 1, width
            do i = 1, width
               r(i, j) = r(i, j) + alpha(i)*h(i, j)
               q(i, j) = q(i, j) + alpha_rate(i)*h(i, j)
            end do
            q(j, j) = q(j, j) + alpha(j)
         end do
      end if
      t = matmul(s, r)
      known = kernel%equilibrium*start%indentation + apply(s, gained) + b
      if (kernel%viscosity > 0.0_wp) then
         t = t + kernel%viscosity*q
         known = known + kernel%viscosity*known_v
      end if
      known(n + 1:) = 0.0_wp
      stands_still = .not. map%slope + 2.0_wp*map%bend > 0.0_wp
      if (stands_still) then
         ! no force acts at the end, and it would not count
         known(n) = 0.0_wp
         t(n, :) = 0.0_wp
         panel%t1(n) = 0.0_wp
      end if

      ! t1 is guessed, and N follows from it
      condition = 0.0_wp
      force = 0.0_wp
      slope = 0.0_wp
      do i = 1, n
         call guess_condition(panel%t1(i), panel%time(i), condition(i))
      end do
      panel%converged = .false.
      size_before = huge(1.0_wp)
      do iteration = 1, most_iterations
         do i = 1, n
            call approach%find_force(kernel, panel%time(i), condition(i), impact%velocity, &
               inner*tolerance, panel%t1(i), force(i), slope(i))
         end do
         change = known - condition - apply(t, force)
         do j = 1, width
            factors%matrix(:, j) = t(:, j)*slope(j)
            factors%matrix(j, j) = factors%matrix(j, j) + 1.0_wp
         end do
         call factorise(factors, regular)
         if (.not. regular) return
         call factors%solve(change)
         if (.not. maxval(abs(change)) <= wildest*start%largest_condition) return
         condition = condition + change
         ! the force is extrapolated by its slope, whose error is of second order
         force = force + slope*change
         size_now = maxval(abs(change))/start%largest_condition
         panel%converged = size_now*min(1.0_wp, sqrt(size_now)) <= tolerance
         ! rounding in the condition of stiff internal variables ends it, too
         if (.not. panel%converged .and. .not. size_now < 0.5_wp*size_before) &
            panel%converged = size_now <= noise
         if (panel%converged .or. iteration > 8 .and. .not. size_now < size_before) exit
         size_before = size_now
      end do
      if (.not. panel%converged) return

      panel%indentation(0) = start%indentation
      panel%force(0) = start%force
      panel%condition(0) = start%condition
      panel%t1(0) = start%t1
      panel%impulse(0) = start%impulse
      panel%second_impulse(0) = start%second_impulse
      panel%deflection(0) = start%deflection
      panel%drift(0) = start%drift
      panel%condition(1:) = condition
      panel%force(1:) = force
      panel%indentation(1:) = known_s - apply(r, force)
      panel%impulse(1:) = start%impulse + apply(h, force)
      panel%second_impulse(1:) = start%second_impulse + apply(h, panel%impulse(1:))
      if (frozen) then
         panel%drift(1:) = start%drift + apply(h, alpha_rate*force)
         panel%deflection(1:) = start%deflection + apply(h, alpha*force - panel%drift(1:))
      else if (remembers) then
         panel%drift(1:) = -lost - apply(map%right, times(map%square, share, apply(map%left, &
            apply(h, force))))
         panel%deflection(1:) = start%deflection - apply(h, panel%drift(1:))
      end if
      panel%t1(0) = start%t1
      if (stands_still) call extrapolate_to_end()

   contains

      !> Where the map stands still at the end of the panel, collocation there says nothing about
      !> internal variables that have settled: what they make of condition and drift is taken from
      !> the other points. The end has no weight in the integrals
      subroutine extrapolate_to_end()

         panel%t1(n) = sum(rule%end_weight(0:n - 1)*panel%t1(0:n - 1))
         panel%condition(n) = kernel%equilibrium*panel%indentation(n) &
            + kernel%viscosity*(known_v(n) - sum(q(n, :)*force)) &
            + lags_at_end(rule, map, scale, kernel, -start%w, &
            panel%indentation - start%indentation)
         if (remembers) panel%drift(n) = &
            -lags_at_end(rule, map, scale, memory, -start%p, panel%impulse - start%impulse)
      end subroutine extrapolate_to_end

      !> N by t1
      subroutine guess_condition(t1, time, condition)
         !> t1 [s]
         real(wp), intent(in) :: t1
         !> Time [s]
         real(wp), intent(in) :: time
         !> N
         real(wp), intent(out) :: condition

         real(wp) :: other_force, firmness, indentation, rate

         if (t1 > 0.0_wp) then
            call approach%evaluate(kernel, time, min(t1, approach%end), condition, &
               other_force, firmness, indentation, rate)
         else
            condition = impact%velocity*t1*(kernel%equilibrium + sum(kernel%moduli &
               *exp(-min(kernel%rates*time, 600.0_wp))))
         end if
      end subroutine guess_condition
   end subroutine solve_rebound_panel

   !> Make the end of a panel the start of the next one
   pure subroutine advance_rebound(rule, map, scale, kernel, memory, panel, start)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> Memory of a hereditary plate
      type(exponential_sum_t), intent(in) :: memory
      !> The panel
      type(rebound_panel_t), intent(in) :: panel
      !> State at the start of the panel, on return that at its end
      type(rebound_start_t), intent(inout) :: start

      real(wp) :: increment(width)
      integer :: n

      n = rule%stages
      increment = panel%indentation(1:) - panel%indentation(0)
      start%w = -start%w
      call advance_modes(rule, map, scale, kernel, increment, start%w)
      start%w = increment(n) - start%w
      if (size(start%p) > 0) then
         ! P = (1 + l H)^-1 (P_n + H F), the lag of H F behind its own modes
         increment = panel%impulse(1:) - panel%impulse(0)
         start%p = -start%p
         call advance_modes(rule, map, scale, memory, increment, start%p)
         start%p = increment(n) - start%p
      end if
      start%time = panel%time(n)
      start%indentation = panel%indentation(n)
      start%force = panel%force(n)
      start%condition = panel%condition(n)
      start%t1 = panel%t1(n)
      start%impulse = panel%impulse(n)
      start%second_impulse = panel%second_impulse(n)
      start%deflection = panel%deflection(n)
      start%drift = panel%drift(n)
   end subroutine advance_rebound

end module vcor_solver_rebound_panel
