!> One panel of the internal-variable method: Radau IIA collocation of the twice-integrated
!> equation of motion with the internal variables eliminated
!>
!> For F = G_0 u + sum_k G_k p_k + eta u' with p_k' = u' - l_k p_k, what internal variables fall
!> behind u, the stage values of p_k follow from those of u: p = (1 + l_k H)^-1 (u - u_n + p_n) with
!> H = scale*B the integration matrix of the panel. Hence F = S (u - u_n) + b, with
!>
!>     S = G_0 + sum_k G_k (1 + l_k H)^-1 + eta H^-1,
!>     b = G_0 u_n 1 + sum_k G_k p_k,n (1 + l_k H)^-1 1,
!>
!> functions of H, known through its eigenvalues: `stiffness` and `memory` below are S and b there.
!> What is left is s = v0 t - J/m - alpha I with I = I_n + H F and J = J_n + H I, one nonlinear
!> system for the stage values of s, whatever the number of internal variables.
module vcor_solver_panel
   use vcor_impact_problem, only : hertz, impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : collocation_t, pairs, panel_map_t, width
   use vcor_numeric_linear, only : apply
   use vcor_numeric_pairs, only : times
   use vcor_solver_modes, only : modes_t, resolve, resolve_contact, start_t
   use vcor_solver_newton, only : largest, most_iterations, newton_t
   implicit none
   private

   public :: panel_t
   public :: begin_panel, solve_panel, solve_near_panel, improve_panel, move_to_end

   !> Solution on a panel; index 0 is its start
   type :: panel_t
      !> Number of stages
      integer :: stages = 0
      !> Time in the panel: start + map(1) theta + map(2) theta^2 [s]
      real(wp) :: map(2) = 0.0_wp
      !> Times of the stages [s]
      real(wp) :: time(0:width) = 0.0_wp
      !> Indentation [m]
      real(wp) :: indentation(0:width) = 0.0_wp
      !> Force [N]
      real(wp) :: force(0:width) = 0.0_wp
      !> Impulse [N s]
      real(wp) :: impulse(0:width) = 0.0_wp
      !> Integral of the impulse [N s2]
      real(wp) :: second_impulse(0:width) = 0.0_wp
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha(0:width) = 0.0_wp
      !> Deflection U of a frozen plate, or the part that a hereditary plate's memory has in it [m]
      real(wp) :: deflection(0:width) = 0.0_wp
      !> What the velocity of the plate falls behind alpha F, frozen or hereditary [m/s]
      real(wp) :: drift(0:width) = 0.0_wp
      !> Whether Newton's iteration converged
      logical :: converged = .false.
   contains
      !> Positions of times in the panel
      procedure :: theta
   end type panel_t

   !> What the equations of a panel are made of; vectors over the eigenvalues as in `panel_map_t`
   type :: equations_t
      !> Eigenvalues of H [s]
      real(wp) :: lambda(width)
      !> u at the start of the panel [m^1.5]
      real(wp) :: start_u
      !> S [N/m^1.5]
      real(wp) :: stiffness(width)
      !> V^-1 b [N]
      real(wp) :: memory(width)
      !> H S [N s/m^1.5]
      real(wp) :: impulsive(width)
      !> H^2 S/m [m^-0.5]
      real(wp) :: inertial(width)
      !> Whether the plate remembers the force
      logical :: remembers
      !> Velocity of that plate per impulse in the panel, R of `vcor_solver_modes` [m/(N s2)]
      real(wp) :: plate(width)
      !> Velocity of the plate by what it remembers of earlier panels [m/s]
      real(wp) :: past(width)
      !> Impulse without a force in the panel [N s]
      real(wp) :: free_impulse
      !> Its integral [N s2]
      real(wp) :: free_second_impulse(width)
      !> Indentation with the memory as the only force in the panel [m]
      real(wp) :: right(width)
   end type equations_t

contains

   !> Position of times in the panel: the root of the quadratic map in its stable form
   pure function theta(self, time)
      !> The panel
      class(panel_t), intent(in) :: self
      !> Times [s], not before the panel's start
      real(wp), intent(in) :: time(width)
      !> Positions, 0 at the start and 1 at the end
      real(wp) :: theta(width)

      theta = max(time - self%time(0), 0.0_wp)
      theta = 2.0_wp*theta/max(tiny(1.0_wp), self%map(1) &
         + sqrt(max(self%map(1)**2 + 4.0_wp*self%map(2)*theta, 0.0_wp)))
   end function theta

   !> Set what is known of a panel before it is solved: its times, and all values at its start
   pure subroutine begin_panel(rule, map, scale, start, panel, elapsed)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> State at the start
      class(start_t), intent(in) :: start
      !> The panel
      class(panel_t), intent(inout) :: panel
      !> Times of the stages since the start [s]
      real(wp), intent(out) :: elapsed(width)

      panel%stages = rule%stages
      panel%map = scale*[map%slope, map%bend]
      elapsed = rule%node*(panel%map(1) + panel%map(2)*rule%node)
      panel%time(0) = start%time
      panel%time(1:) = start%time + elapsed
      panel%indentation(0) = start%indentation
      panel%force(0) = start%force
      panel%impulse(0) = start%impulse
      panel%second_impulse(0) = start%second_impulse
      panel%deflection(0) = start%deflection
      panel%drift(0) = start%drift
   end subroutine begin_panel

   !> Set up the equations of a panel
   pure subroutine set_up(equations, rule, map, scale, impact, modes, start, panel)
      !> The equations
      type(equations_t), intent(out) :: equations
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start
      type(start_t), intent(in) :: start
      !> The panel: its times and plate parameters are set, and all values at its start
      type(panel_t), intent(inout) :: panel

      real(wp) :: elapsed(width), impulse(width), yield(width), inverse_mass
      integer :: n

      n = rule%stages
      call begin_panel(rule, map, scale, start, panel, elapsed)
      panel%alpha(1:) = 0.0_wp
      call impact%plate%alpha_at(panel%time(1:n), panel%alpha(1:n))
      ! what settles at once in a hereditary plate counts as alpha
      if (size(start%p) > 0) panel%alpha(1:n) = modes%plate%viscosity

      inverse_mass = 1.0_wp/impact%mass
      associate (e => equations)
         e%lambda = scale*map%eigenvalue
         e%start_u = hertz(start%indentation)
         call resolve_contact(modes%contact, start, map, e%lambda, e%stiffness, e%memory)
         e%impulsive = times(map%square, e%lambda, e%stiffness)
         e%inertial = inverse_mass*times(map%square, e%lambda, e%impulsive)
         e%free_impulse = start%impulse
         e%free_second_impulse = start%second_impulse + start%impulse*elapsed
         impulse = times(map%square, e%lambda, e%memory)
         e%right = impact%velocity*panel%time(1:) - (e%free_second_impulse &
            + apply(map%right, times(map%square, e%lambda, impulse)))*inverse_mass &
            - panel%alpha(1:)*(start%impulse + apply(map%right, impulse))
         e%remembers = size(start%p) > 0
         if (e%remembers) then
            ! U has V with V' = R H F + c beside alpha I
            call resolve(modes%plate, start%p, map, e%lambda, e%plate, e%past)
            yield = times(map%square, e%lambda, e%plate)
            e%inertial = e%inertial + times(map%square, yield, e%impulsive)
            e%right = e%right - start%deflection - apply(map%right, &
               times(map%square, yield, impulse) + times(map%square, e%lambda, e%past))
         end if
         e%right(n + 1:) = 0.0_wp
      end associate
   end subroutine set_up

   !> Solve the collocation equations on a panel by Newton's method
   pure subroutine solve_panel(rule, map, scale, impact, modes, start, tolerance, panel, inverse)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start
      type(start_t), intent(in) :: start
      !> Wanted error of the indentation over its largest value
      real(wp), intent(in) :: tolerance
      !> The panel; on entry `indentation` holds a guess at the stages
      type(panel_t), intent(inout) :: panel
      !> Inverse of the Jacobian, for panels next to this one
      real(wp), intent(out) :: inverse(width, width)

      type(equations_t) :: equations
      real(wp), dimension(width) :: s, u, root, change
      real(wp) :: response(width, width)
      type(newton_t) :: newton
      integer :: i, j, iteration

      call set_up(equations, rule, map, scale, impact, modes, start, panel)
      call assemble(map, equations, panel%alpha(1:), response)
      s = panel%indentation(1:)
      s(rule%stages + 1:) = 0.0_wp
      do iteration = 1, most_iterations
         root = sqrt(abs(s))
         u = s*root - equations%start_u
         change = equations%right - s - apply(response, u)
         if (newton%stale) then
            root = 1.5_wp*root
            do j = 1, width
               do i = 1, width
                  inverse(i, j) = response(i, j)*root(j)
               end do
               inverse(j, j) = inverse(j, j) + 1.0_wp
            end do
         end if
         call newton%correct(inverse, change, s, tolerance)
         if (newton%converged .or. newton%failed) exit
      end do
      panel%converged = newton%converged
      if (.not. panel%converged) return
      panel%indentation(1:) = s
      call integrate(map, equations, hertz(s), panel)
   end subroutine solve_panel

   !> Solve the collocation equations on a panel with the Jacobian of one next to it, of another
   !> length or another rule. No matrix is formed, so this costs half of a solution. With another
   !> rule, what is wanted are the values at the end: force and impulses are left out elsewhere
   pure subroutine solve_near_panel(rule, map, scale, impact, modes, start, tolerance, inverse, &
                                    panel, to, from)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start
      type(start_t), intent(in) :: start
      !> Wanted error of the indentation at the end of the panel over its largest value
      real(wp), intent(in) :: tolerance
      !> Inverse of the Jacobian of the other panel
      real(wp), intent(in) :: inverse(width, width)
      !> The panel; on entry `indentation` holds a guess at the stages. Not converged where the
      !> Jacobian does not serve
      type(panel_t), intent(inout) :: panel
      !> Interpolation to the stages of another rule, of what is zero at the start; absent: both
      !> panels have the same rule
      real(wp), intent(in), optional :: to(width, width)
      !> Interpolation from them
      real(wp), intent(in), optional :: from(width, width)

      ! what does not contract like this is better solved with a Jacobian of its own
      real(wp), parameter :: slowest = 0.2_wp
      integer, parameter :: most = 8
      type(equations_t) :: equations
      real(wp) :: change(width), s(width), size, last, rate
      integer :: iteration

      call set_up(equations, rule, map, scale, impact, modes, start, panel)
      s = panel%indentation(1:)
      s(rule%stages + 1:) = 0.0_wp
      panel%converged = .false.
      last = 0.0_wp
      do iteration = 1, most
         change = displaced(map, equations, panel%alpha(1:), s) - s
         if (present(to)) change = apply(to, change)
         change = apply(inverse, change)
         if (present(from)) change = apply(from, change)
         size = largest(change)
         ! a guess that is no guess
         if (.not. size <= largest(s)) return
         s = s + change
         if (iteration > 1) then
            rate = size/last
            if (.not. rate <= slowest) return
            panel%converged = abs(change(rule%stages))*rate <= tolerance*largest(s)
            if (panel%converged) exit
         end if
         last = max(size, tiny(1.0_wp))
      end do
      if (.not. panel%converged) return
      panel%indentation(1:) = s
      if (present(to) .and. .not. equations%remembers) then
         call integrate_to_end(map, equations, hertz(s), panel)
      else
         call integrate(map, equations, hertz(s), panel)
         ! what is left of the error goes to the force, so that the motion is that of the impulse
         panel%indentation(1:) = impact%velocity*panel%time(1:) &
            - panel%second_impulse(1:)*(1.0_wp/impact%mass) - panel%alpha(1:)*panel%impulse(1:)
         if (equations%remembers) &
            panel%indentation(1:) = panel%indentation(1:) - panel%deflection(1:)
         panel%indentation(rule%stages + 1:) = 0.0_wp
      end if
   end subroutine solve_near_panel

   !> Indentation v0 t - J/m - alpha I that follows from the forces at an indentation s
   pure function displaced(map, equations, alpha, s) result(displacement)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> Plate parameter at the stages [m/(N s)]
      real(wp), intent(in) :: alpha(width)
      !> Indentation at the stages [m]
      real(wp), intent(in) :: s(width)
      !> That which follows [m]
      real(wp) :: displacement(width)

      real(wp) :: x(width)

      x = apply(map%left, s*sqrt(abs(s)) - equations%start_u)
      displacement = equations%right - apply(map%right, times(map%square, equations%inertial, x)) &
         - alpha*apply(map%right, times(map%square, equations%impulsive, x))
   end function displaced

   !> Improve a guess at a panel by two functional iterations: s from the forces of the guess, and
   !> again. The error of an interpolated guess oscillates from stage to stage, and two integrals
   !> leave little of it. Force and impulses are those at the end of the panel only
   pure subroutine improve_panel(rule, map, scale, impact, modes, start, tolerance, panel)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Modes of contact and plate
      type(modes_t), intent(in) :: modes
      !> State at the start
      type(start_t), intent(in) :: start
      !> Wanted error of the indentation over its largest value
      real(wp), intent(in) :: tolerance
      !> The panel; on entry `indentation` holds a guess at the stages. Not converged where the
      !> second iteration still changes the indentation by more than the tolerance
      type(panel_t), intent(inout) :: panel

      type(equations_t) :: equations
      real(wp) :: s(width)

      call set_up(equations, rule, map, scale, impact, modes, start, panel)
      s = displaced(map, equations, panel%alpha(1:), panel%indentation(1:))
      panel%indentation(1:) = displaced(map, equations, panel%alpha(1:), s)
      call integrate_to_end(map, equations, hertz(panel%indentation(1:)), panel)
      panel%converged = largest(panel%indentation(1:) - s) <= tolerance*largest(s)
   end subroutine improve_panel

   !> The matrix (H^2/m + alpha H) S
   pure subroutine assemble(map, equations, alpha, response)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> Plate parameter at the stages [m/(N s)]
      real(wp), intent(in) :: alpha(width)
      !> Indentation that is missing per u at the stages [m^-0.5]
      real(wp), intent(out) :: response(width, width)

      real(wp) :: scaled(width, width), f, g
      integer :: i, j, m

      do m = 1, pairs
         do i = 1, width
            f = equations%inertial(m) + alpha(i)*equations%impulsive(m)
            g = equations%inertial(pairs + m) + alpha(i)*equations%impulsive(pairs + m)
            scaled(i, m) = map%right(i, m)*f + map%right(i, pairs + m)*g
            scaled(i, pairs + m) = map%right(i, pairs + m)*f + map%square(m)*map%right(i, m)*g
         end do
      end do
      do j = 1, width
         response(:, j) = apply(scaled, map%left(:, j))
      end do
   end subroutine assemble

   !> F = S (u - u_n) + b and its integrals I = I_n + H F, J = J_n + H I_n + H^2 F
   pure subroutine integrate(map, equations, u, panel)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> u at the stages [m^1.5]
      real(wp), intent(in) :: u(width)
      !> The panel
      type(panel_t), intent(inout) :: panel

      real(wp) :: x(width), y(width)

      x = times(map%square, equations%stiffness, apply(map%left, u - equations%start_u)) &
         + equations%memory
      panel%force(1:) = apply(map%right, x)
      x = times(map%square, equations%lambda, x)
      panel%impulse(1:) = equations%free_impulse + apply(map%right, x)
      if (equations%remembers) then
         y = times(map%square, equations%plate, x) + equations%past
         panel%drift(1:) = -apply(map%right, y)
         panel%deflection(1:) = panel%deflection(0) &
            + apply(map%right, times(map%square, equations%lambda, y))
      end if
      x = times(map%square, equations%lambda, x)
      panel%second_impulse(1:) = equations%free_second_impulse + apply(map%right, x)
   end subroutine integrate

   !> The same at the end of the panel only
   pure subroutine integrate_to_end(map, equations, u, panel)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> u at the stages [m^1.5]
      real(wp), intent(in) :: u(width)
      !> The panel
      type(panel_t), intent(inout) :: panel

      real(wp) :: x(width)

      associate (n => panel%stages)
         x = times(map%square, equations%stiffness, apply(map%left, u - equations%start_u)) &
            + equations%memory
         panel%force(n) = sum(map%last*x)
         x = times(map%square, equations%lambda, x)
         panel%impulse(n) = equations%free_impulse + sum(map%last*x)
         x = times(map%square, equations%lambda, x)
         panel%second_impulse(n) = equations%free_second_impulse(n) + sum(map%last*x)
      end associate
   end subroutine integrate_to_end

   !> Make the end of a panel the start of the next one, internal variables aside
   pure subroutine move_to_end(panel, start)
      !> The panel
      class(panel_t), intent(in) :: panel
      !> State at the start of the panel, on return that at its end
      class(start_t), intent(inout) :: start

      associate (n => panel%stages)
         start%time = panel%time(n)
         start%indentation = panel%indentation(n)
         start%force = panel%force(n)
         start%impulse = panel%impulse(n)
         start%second_impulse = panel%second_impulse(n)
         start%deflection = panel%deflection(n)
         start%drift = panel%drift(n)
      end associate
   end subroutine move_to_end

end module vcor_solver_panel
