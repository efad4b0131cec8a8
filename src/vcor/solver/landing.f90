!> End of the contact in the internal-variable method
module vcor_solver_landing
   use vcor_impact_problem, only : hertz, impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : collocation_t, width
   use vcor_solver_collocator, only : collocator_t, guess, plate_velocity, relative_velocity, &
      solve_near_step
   use vcor_solver_modes, only : modes_t, start_t
   use vcor_solver_panel, only : panel_t
   use vcor_solver_step, only : step_t, step_to
   implicit none
   private

   public :: first_without_force, land, land_on_largest
   public :: end_at_zero, estimate_errors, share_of_difference, slope_at_end

contains

   !> First stage of a panel at which the force is gone; 0 if there is none. While the indentation
   !> grows, or stands still, the force is positive: what is not is rounding
   pure function first_without_force(panel) result(stage)
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Stage
      integer :: stage

      real(wp), parameter :: noticeable = 1.0e-12_wp

      do stage = 1, panel%stages
         if (panel%force(stage) <= 0.0_wp .and. panel%indentation(stage) &
             < panel%indentation(stage - 1) - noticeable*abs(panel%indentation(stage - 1))) return
      end do
      stage = 0
   end function first_without_force

   !> Cut a panel in which the indentation has its maximum so that it ends there. Where that is by
   !> the polynomial of the panel is good enough: the two laws of the force part with the fourth
   !> power of the time since the maximum
   subroutine land_on_largest(self, impact, modes, start, start_velocity, step, panel, inverse)
      !> The collocation
      type(collocator_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> Rate of the indentation there [m/s]
      real(wp), intent(in) :: start_velocity
      !> The step, on return the one that ends at the maximum
      type(step_t), intent(inout) :: step
      !> The panel, on return the one that ends at the maximum; not converged on failure
      type(panel_t), intent(inout) :: panel
      !> Inverse of its Jacobian
      real(wp), intent(inout) :: inverse(width, width)

      real(wp), parameter :: closest = 1.0e-8_wp
      type(panel_t) :: longer
      real(wp) :: velocity(0:width), theta
      integer :: j

      longer = panel
      velocity = 0.0_wp
      velocity(0) = start_velocity
      do j = 1, panel%stages
         velocity(j) = relative_velocity(impact, panel, j)
      end do
      do j = 1, panel%stages - 1
         if (velocity(j) < 0.0_wp) exit
      end do
      theta = self%rule%crossing(velocity, self%rule%point(j - 1), self%rule%point(j), closest)
      step = step_to(start%time, theta*(panel%map(1) + panel%map(2)*theta))
      call guess(self%rule, impact, longer, start, step, panel)
      call solve_near_step(self, step, impact, modes, start, self%near_tolerance, panel, inverse)
   end subroutine land_on_largest

   !> Cut a panel in which the force changes its sign so that it ends where the force is zero
   subroutine land(self, impact, modes, start, accuracy, shallow, step, panel, inverse)
      !> The collocation
      type(collocator_t), intent(in) :: self
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> Wanted accuracy of the coefficient of restitution
      real(wp), intent(in) :: accuracy
      !> Indentation above which the force is about linear in time next to its zero [m]
      real(wp), intent(in) :: shallow
      !> The step, on return the one that ends at the zero, or so close to it that its square does
      !> not count where the force is linear
      type(step_t), intent(inout) :: step
      !> The panel, on return the one that ends at the zero; not converged on failure
      type(panel_t), intent(inout) :: panel
      !> Inverse of its Jacobian
      real(wp), intent(inout) :: inverse(width, width)

      integer, parameter :: most_iterations = 40
      ! a shorter correction tells nothing about slopes
      real(wp), parameter :: noticeable = 1.0e-7_wp
      ! share of the tolerance that the square of a distance to the zero may have
      real(wp), parameter :: share_of_square = 1.0e-2_wp
      type(panel_t) :: crossing, last
      real(wp) :: theta, time, correction, last_correction, tolerance, velocity
      real(wp) :: kappa, memory_rate, old_memory, memory, enough
      integer :: iteration, n, k

      n = self%rule%stages
      crossing = panel
      k = first_without_force(crossing)
      if (crossing%force(k - 1) <= 0.0_wp) then
         ! a panel so crude that its force is negative while the indentation grows
         panel%converged = .false.
         return
      end if
      theta = self%rule%crossing(crossing%force, self%rule%point(k - 1), self%rule%point(k), &
         noticeable)
      time = theta*(crossing%map(1) + crossing%map(2)*theta)

      ! Write F = kappa u - M with any kappa that is about dF/du, the settled internal variables
      ! left out: the indentation s and the memory
      ! M are smooth in time, u = s^1.5 where s goes to zero is not. So Newton's method is put on
      ! kappa u(s) = M with s and M linear in time, the slope of M from the polynomials of the panel
      ! and then from the last two iterations
      tolerance = 0.1_wp*accuracy
      associate (contact => modes%contact)
         kappa = contact%equilibrium + sum(contact%moduli/(1.0_wp + contact%rates*step%duration()))
      end associate
      memory_rate = slope_at(kappa*hertz(crossing%indentation) - crossing%force) &
         /(crossing%map(1) + 2.0_wp*crossing%map(2)*theta)
      old_memory = 0.0_wp
      correction = 0.0_wp
      panel%converged = .false.
      last = crossing
      do iteration = 1, most_iterations
         if (.not. time > 0.0_wp) return
         step = step_to(start%time, time)
         call guess(self%rule, impact, last, start, step, panel)
         call solve_near_step(self, step, impact, modes, start, self%near_tolerance, panel, inverse)
         if (.not. panel%converged) return
         last = panel
         velocity = impact%velocity - panel%impulse(n)/impact%mass &
            - plate_velocity(impact, panel, n)
         memory = kappa*hertz(panel%indentation(n)) - panel%force(n)
         if (abs(correction) > noticeable*time) memory_rate = (memory - old_memory)/correction
         old_memory = memory
         last_correction = correction
         call look_ahead(kappa, panel%indentation(n), velocity, memory, memory_rate, correction, &
            panel%converged)
         if (.not. panel%converged) return
         enough = tolerance
         if (panel%indentation(n) >= shallow) enough = sqrt(share_of_square*tolerance)
         if (abs(correction) <= enough*(start%time + time)) return
         ! rounding in the force of a dashpot or of stiff internal variables ends it, too
         if (iteration > 3 .and. abs(correction) <= noticeable*(start%time + time) &
             .and. abs(correction) >= 0.25_wp*abs(last_correction)) return
         time = time + correction
      end do
      panel%converged = .false.

   contains

      !> Slope of a polynomial at theta
      pure function slope_at(value) result(slope)
         !> Values at the points of the panel
         real(wp), intent(in) :: value(0:width)
         !> Derivative by theta
         real(wp) :: slope

         slope = self%rule%interpolate(self%rule%slopes(value), theta)
      end function slope_at
   end subroutine land

   !> Solve kappa hertz(s + v x) = memory + rate x for x near 0 by Newton's method
   pure subroutine look_ahead(kappa, s, v, memory, rate, x, found)
      !> Stiffness kappa [N/m^1.5], > 0
      real(wp), intent(in) :: kappa
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> Its rate [m/s]
      real(wp), intent(in) :: v
      !> Memory [N]
      real(wp), intent(in) :: memory
      !> Its rate [N/s]
      real(wp), intent(in) :: rate
      !> Time [s]
      real(wp), intent(out) :: x
      !> Whether the force falls to zero there
      logical, intent(out) :: found

      real(wp) :: correction, slope
      integer :: iteration

      x = 0.0_wp
      found = .false.
      do iteration = 1, 50
         slope = 1.5_wp*kappa*sqrt(abs(s + v*x))*v - rate
         if (.not. slope < 0.0_wp) return
         correction = (memory + rate*x - kappa*hertz(s + v*x))/slope
         x = x + correction
         found = abs(correction) <= 1.0e-3_wp*abs(x)
         if (found) return
      end do
   end subroutine look_ahead

   !> Let the last panel end where its force is zero, which is next to where it ends: its
   !> polynomials go on up to there, and all values move with their nodes, so that integrals stay
   !> sums over them
   pure subroutine end_at_zero(rule, impact, panel)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The impact
      type(impact_t), intent(in) :: impact
      !> The last panel
      type(panel_t), intent(inout) :: panel

      real(wp), dimension(0:width) :: shift, plate
      real(wp) :: growth

      associate (n => rule%stages, theta => rule%point, map => panel%map)
         growth = -panel%force(n)/slope_at_end(rule, panel, panel%force)/sum(map)
         ! in theta; the time of the nodes grows by this share
         shift = growth*theta*(map(1) + map(2)*theta) &
            /max(map(1) + 2.0_wp*map(2)*theta, tiny(1.0_wp))
         plate = impact%velocity*panel%time - panel%second_impulse/impact%mass - panel%indentation
         map = (1.0_wp + growth)*map
         panel%time = panel%time(0) + (1.0_wp + growth)*(panel%time - panel%time(0))
         call move(panel%force)
         call move(panel%impulse)
         call move(panel%second_impulse)
         if (.not. impact%plate%hereditary()) &
            call impact%plate%alpha_at(panel%time(1:n), panel%alpha(1:n))
         if (impact%plate%drifts()) then
            call move(panel%drift)
            call move(plate)
         else
            plate(1:n) = panel%alpha(1:n)*panel%impulse(1:n)
         end if
         panel%indentation(1:n) = impact%velocity*panel%time(1:n) &
            - panel%second_impulse(1:n)/impact%mass - plate(1:n)
         panel%force(n) = 0.0_wp
      end associate

   contains

      !> Move the values
      pure subroutine move(value)
         !> Values at the points
         real(wp), intent(inout) :: value(0:width)

         value = value + shift*rule%slopes(value)
      end subroutine move
   end subroutine end_at_zero

   !> Rate of a value at the end of a panel
   pure function slope_at_end(rule, panel, value) result(slope)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Its values at the points of the panel
      real(wp), intent(in) :: value(0:width)
      !> Rate [1/s]
      real(wp) :: slope

      slope = sum(rule%derivative(rule%stages, :)*value)/(panel%map(1) + 2.0_wp*panel%map(2))
   end function slope_at_end

   !> Errors of the coefficients of restitution: with F = 0 at the end, s' = v0 - I/m - alpha' I and
   !> z' = v0 - I/m. The companion reaches F = 0 a little earlier or later, which only alpha' and
   !> the drift feel
   pure subroutine estimate_errors(rule, impact, panel, coarse, panels, branches, cor_error, &
                                   cor_sphere_error)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> The impact
      type(impact_t), intent(in) :: impact
      !> The last panel
      type(panel_t), intent(in) :: panel
      !> Its companion
      type(panel_t), intent(in) :: coarse
      !> Number of panels
      integer, intent(in) :: panels
      !> Whether the indentation ends next to zero, so that in this panel the solution is hardly
      !> better than its companion
      logical, intent(in) :: branches
      !> Error of that by the relative velocity [-]
      real(wp), intent(out) :: cor_error
      !> Error of that of the sphere alone [-]
      real(wp), intent(out) :: cor_sphere_error

      ! what rounding may add per panel, mostly through the eigenvectors of the integration matrices
      real(wp), parameter :: rounding = 5.0e-13_wp
      real(wp) :: impulse_error, time_error, alpha_rate, fall, moved, plate, least, share

      associate (n => rule%stages)
         impulse_error = abs(panel%impulse(n) - coarse%impulse(n - 1))
         ! what this panel adds may cancel what the companion owes to the panels before
         if (branches) impulse_error = max(impulse_error, abs((panel%impulse(n) &
            - panel%impulse(0)) - (coarse%impulse(n - 1) - coarse%impulse(0))))
         fall = slope_at_end(rule, panel, panel%force)
         time_error = abs((panel%force(n) - coarse%force(n - 1))/fall)
         alpha_rate = impact%plate%alpha_rate(panel%time(n), panel%alpha(n))
         ! the end is moved to its zero along straight lines: what that leaves of the impulse, and
         ! of the velocity of the plate
         moved = panel%force(n)/fall
         plate = impact%velocity*panel%time(n) - panel%second_impulse(n)/impact%mass &
            - panel%indentation(n)
         least = rounding*real(panels, wp) &
            + abs(panel%force(n)*moved)/(impact%mass*impact%velocity)
         ! where alpha' of a frozen plate is infinite at first contact, neither solution is better
         share = merge(1.0_wp, share_of_difference(panels), branches .or. impact%plate%frozen()) &
            /impact%velocity
         cor_sphere_error = least + share*impulse_error/impact%mass
         cor_error = cor_sphere_error + abs(plate)/(impact%velocity*panel%time(n)) &
            *(moved/panel%time(n))**2 + share*(impulse_error*alpha_rate &
            + time_error*(alpha_rate*panel%impulse(n)/panel%time(n) &
            + abs(slope_at_end(rule, panel, panel%drift))) &
            + abs(panel%drift(n) - coarse%drift(n - 1)))
      end associate
   end subroutine estimate_errors

   !> Error of the solution over its difference to the companion. The difference is the error of the
   !> companion: that of the solution is less, where the solution is smooth by orders, where it is
   !> not by a factor of some size; with few panels it is anybody's guess
   pure function share_of_difference(panels) result(share)
      !> Number of panels
      integer, intent(in) :: panels
      !> Share
      real(wp) :: share

      real(wp), parameter :: finer = 0.3_wp
      integer, parameter :: few = 2

      share = merge(1.0_wp, finer, panels <= few)
   end function share_of_difference

end module vcor_solver_landing
