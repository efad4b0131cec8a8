!> The equations of a panel of the internal-variable method, in one form for contact and rebound
!>
!> Motion: s = g - R F and s' = v - Q F, where g and v are the motion without the forces in the
!> panel. R = H^2/m plus the compliance of the plate; H is the integration matrix of the panel.
!>
!> Hereditary integrals: the lags p_k = x - q_k, p_k' = x' - l_k p_k, of x = u or x = s follow from
!> the stage values of x: p = (1 + l_k H)^-1 (x - x_n + p_n). The integrals of a panel are
!>
!>     int k x' = S (x - x_n) + b,   S = G_0 + sum_k G_k (1 + l_k H)^-1 + eta H^-1,
!>                                   b = G_0 x_n 1 + sum_k G_k p_k,n (1 + l_k H)^-1 1
!>
!> for any number of internal variables. While the contact grows, and always by Boltzmann's law,
!> F = S (u - u_n) + b. While it recedes (`vcor_solver_ive_approach`) the condition is
!> N = S (s - s_n) + b + eta s', in which S is without the dashpot, and F is a function of N. Both
!> are equations for one unknown x, with a function f that acts stage by stage,
!>
!>     x + M f(x) = r      contact: x = s, f = u(s) - u_n, M = R S,           r = g - R b
!>                         rebound: x = N, f = F(N),       M = S R + eta Q,   r = S (g - s_n) + b
!>                                                                                + eta v
!>
!> and are solved by Newton's method with the Jacobian 1 + M f'. All matrices, except those of a
!> plate whose alpha varies, are functions of H given by its eigenvalues. Such a matrix f(H) times a
!> vector is `apply(right, times(f, numbers))` with `numbers` = `left` times the vector.
!>
!> The second term of the Volterra series adds c2 (G_0 u^2 + sum_k G_k p_k^2) to F, as
!> int int k(x + y) u'(t - x) u'(t - y) dx dy = G_0 u^2 + sum_k G_k p_k^2, Eq. (10).
!>
!> In the last panel of a receding contact the map of time is stationary at the end, where N = 0,
!> and the length of the panel is found along with its solution.
module vcor_solver_ive_problem
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : apply, apply_product, constant, pairs, ratio, times, width
   use vcor_numeric_radau_collocation, only : closing, collocation_t, panel_map_t
   use vcor_solver_ive_approach, only : approach_t
   use vcor_solver_ive_collocator, only : collocator_t
   use vcor_solver_ive_modes, only : advance_lags, find_response, modes_t
   use vcor_solver_ive_panel, only : move_to_end, panel_t, start_t, step_t
   use vcor_tuning, only : rounding_of_condition
   implicit none
   private

   public :: panel_problem_t, new_panel_problem
   public :: equations_t, product_with_m, form_matrix, lost_indentation

   !> Data that all panels of an impact share; the targets of the pointers must outlive it
   type :: panel_problem_t
      type(collocator_t), pointer :: collocator => null()
      type(impact_t), pointer :: impact => null()
      type(modes_t), pointer :: modes => null()
      !> The approach, once the contact recedes
      type(approach_t), pointer :: approach => null()
      !> Error of x allowed, over its largest value
      real(wp) :: tolerance = 0.0_wp
      !> Condition N at the largest indentation, the reference for its errors [N/m^0.5]
      real(wp) :: largest_condition = 0.0_wp
      !> Rounding in a correction of the condition, over `largest_condition`
      real(wp) :: noise = 0.0_wp
   contains
      procedure :: begin_rebound
      procedure :: set_up
      procedure :: evaluate
      procedure :: move
      procedure :: find_forces
      procedure :: integrate
      procedure :: set_end_condition
      procedure :: set_end_drift
      procedure :: second_term
      procedure :: advance
      procedure :: plate_velocity
      procedure :: relative_velocity
   end type panel_problem_t

   !> The equations of one panel; functions of H are stored as in `panel_map_t`
   type :: equations_t
      !> Map of the panel, H diagonalised
      type(panel_map_t), pointer :: map => null()
      !> Scale of the map [s]
      real(wp) :: scale
      !> 1/m [1/kg]
      real(wp) :: inverse_mass
      !> Times of the stages since the start [s]
      real(wp) :: elapsed(width)
      !> Eigenvalues of H [s]
      real(wp) :: lambda(width)
      !> S [N/m^1.5]
      real(wp) :: stiffness(width)
      !> V^-1 b [N], or [N/m^0.5] while the contact recedes
      real(wp) :: memory(width)
      !> R [s2/kg], without the part of a variable alpha
      real(wp) :: yield(width)
      !> R S, likewise [m^-0.5]
      real(wp) :: whole(width)
      !> H S, by which a variable alpha is multiplied [N s/m^1.5]
      real(wp) :: impulsive(width)
      !> Velocity of a hereditary plate per impulse in the panel, from its memory [1/kg]
      real(wp) :: plate(width)
      !> V^-1 of the plate's velocity from its memory of earlier panels [m/s]
      real(wp) :: past(width)
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha(width)
      !> Rate of alpha, if needed [m/(N s^2)]
      real(wp) :: alpha_rate(width)
      !> g, minus s_n while the contact recedes [m]
      real(wp) :: gain(width)
      !> r [m], or [N/m^0.5] while the contact recedes
      real(wp) :: right(width)
      !> u at the start of the panel [m^1.5]
      real(wp) :: start_u
      !> Viscosity of the dashpot while the contact recedes [N s/m^1.5]
      real(wp) :: viscosity
      !> Whether the contact recedes, and whether it ends with the panel
      logical :: rebounds, closes
      !> Whether alpha varies, whether the plate is frozen, and whether it has a memory
      logical :: varies, frozen, remembers
      !> Whether M is a function of H, except for the part of a variable alpha
      logical :: simple
      !> Whether M has been formed
      logical :: formed = .false.
      !> M
      real(wp) :: matrix(width, width)
      !> The unknown x [m], or [N/m^0.5], and f(x) [m^1.5], or [N], at the stages
      real(wp) :: x(width), f(width)
      !> df/dx [m^0.5], and dN/dt1 while the contact recedes [N/(m^0.5 s)]
      real(wp) :: slope(width), rate(width)
      !> Second term of the Volterra series: matrices (1 + l_k H)^-1, shape (width, width, modes)
      real(wp), allocatable :: lag(:, :, :)
      !> Lags u - q_k at the start, for the second term [m^1.5], shape (modes)
      real(wp), allocatable :: start_lag(:)
   end type equations_t

   integer :: i_row, i_column
   !> Unit matrix
   real(wp), parameter :: identity(width, width) = reshape([((merge(1.0_wp, 0.0_wp, &
      i_row == i_column), i_row=1, width), i_column=1, width)], [width, width])

contains

   !> The problem of an impact whose contact grows
   function new_panel_problem(collocator, impact, modes) result(self)
      type(collocator_t), intent(in), target :: collocator
      type(impact_t), intent(in), target :: impact
      type(modes_t), intent(in), target :: modes
      type(panel_problem_t) :: self

      self%collocator => collocator
      self%impact => impact
      self%modes => modes
      self%tolerance = collocator%tolerance
   end function new_panel_problem

   !> Set up the equations of a panel
   subroutine set_up(self, rule, step, start, panel, equations)
      class(panel_problem_t), intent(in) :: self
      type(collocation_t), intent(in), target :: rule
      type(step_t), intent(in) :: step
      type(start_t), intent(in) :: start
      !> The panel; its times, plate parameters and values at the start are set
      type(panel_t), intent(inout) :: panel
      type(equations_t), intent(out) :: equations

      real(wp) :: velocity
      integer :: n

      n = rule%stages
      associate (e => equations, map => rule%map(step%index), contact => self%modes%contact, &
                 plate => self%impact%plate)
         e%map => rule%map(step%index)
         e%inverse_mass = 1.0_wp/self%impact%mass
         e%rebounds = associated(self%approach)
         e%closes = step%index == closing
         e%scale = step%map_scale()
         call panel%begin(n, rule%node, e%scale*[map%slope, map%bend], start, e%elapsed)
         e%lambda = e%scale*map%eigenvalue
         e%start_u = 0.0_wp
         e%viscosity = 0.0_wp
         if (e%rebounds) then
            e%viscosity = contact%viscosity
         else
            e%start_u = self%impact%law%u(start%indentation)
         end if

         ! plate: alpha of a hereditary one is the viscosity of its sum
         e%frozen = plate%frozen()
         e%remembers = allocated(start%p)
         e%alpha = 0.0_wp
         e%alpha_rate = 0.0_wp
         if (e%remembers) then
            e%alpha(:n) = self%modes%plate%viscosity
         else
            call plate%alpha_at(panel%time(1:n), e%alpha(:n))
         end if
         panel%alpha(1:) = e%alpha
         ! alpha never falls, so it is constant if it is the same at both ends
         e%varies = e%frozen .or. e%alpha(n) > e%alpha(1)
         if (e%frozen .or. e%varies .and. e%viscosity > 0.0_wp) &
            e%alpha_rate(:n) = plate%alpha_rate(panel%time(1:n), e%alpha(:n))

         ! the motion without a force
         velocity = self%impact%free_velocity(start%time) - start%impulse*e%inverse_mass
         if (e%frozen) velocity = velocity + start%drift
         e%gain = velocity*e%elapsed + 0.5_wp*self%impact%gravity*e%elapsed**2
         if (e%remembers) then
            call find_response(self%modes%plate, start%p, map, e%lambda, e%plate, e%past)
            e%gain = e%gain - apply_product(map%right, map%square, e%lambda, e%past)
         end if
         e%yield = times(map%square, e%lambda, e%lambda)*e%inverse_mass
         if (e%remembers) e%yield = e%yield &
            + times(map%square, e%lambda, times(map%square, e%lambda, e%plate))
         if (.not. e%varies) e%yield = e%yield + e%alpha(1)*e%lambda

         call find_response(contact, start%lag, map, e%lambda, e%stiffness, e%memory)
         if (.not. e%rebounds) then
            e%memory = e%memory + contact%equilibrium*e%start_u*map%left_one
            if (contact%viscosity > 0.0_wp) e%stiffness = e%stiffness &
               + ratio(map%square, constant(contact%viscosity), e%lambda)
         end if
         e%whole = times(map%square, e%yield, e%stiffness)
         e%impulsive = times(map%square, e%lambda, e%stiffness)
         e%simple = .not. (e%frozen .or. e%rebounds .and. e%varies .or. e%viscosity > 0.0_wp)
         if (e%rebounds) then
            if (.not. e%frozen) e%gain = e%gain - (e%alpha - start%alpha)*start%impulse
            e%gain(n + 1:) = 0.0_wp
            e%right = contact%equilibrium*start%indentation + apply(map%right, &
               times(map%square, e%stiffness, apply(map%left, e%gain)) + e%memory)
            if (e%viscosity > 0.0_wp) then
               e%right = e%right + e%viscosity*(velocity + self%impact%gravity*e%elapsed)
               if (e%remembers) e%right = e%right - e%viscosity*apply(map%right, e%past)
               if (.not. e%frozen) e%right = e%right - e%viscosity*e%alpha_rate*start%impulse
            end if
            ! the force is zero at the end of the contact, and this stage has no weight
            if (e%closes) e%right(n) = 0.0_wp
         else
            e%gain = e%gain + (self%impact%free_path(start%time) &
               - start%second_impulse*e%inverse_mass - start%deflection)
            if (.not. e%frozen) e%gain = e%gain - e%alpha*start%impulse
            e%right = e%gain - lost_indentation(e, e%memory)
         end if
         e%right(n + 1:) = 0.0_wp
         if (abs(self%collocator%second_coefficient) > 0.0_wp) &
            call set_up_second_term(e, contact%rates, start%lag)
      end associate
   end subroutine set_up

   !> Integral of x over time from the start of the panel, from the values x at its stages
   pure function integral(e, x)
      type(equations_t), intent(in) :: e
      !> Values at the stages
      real(wp), intent(in) :: x(width)
      !> Integrals from the start to the stages
      real(wp) :: integral(width)

      integral = apply_product(e%map%right, e%map%square, e%lambda, apply(e%map%left, x))
   end function integral

   !> Indentation lost to the forces in the panel, R F. Plates have U = alpha I and their memory, a
   !> frozen one has U' = alpha F - int alpha' F dt
   pure function lost_indentation(e, numbers) result(lost)
      type(equations_t), intent(in) :: e
      !> Numbers of the pairs of the forces [N]
      real(wp), intent(in) :: numbers(width)
      !> Indentation [m]
      real(wp) :: lost(width)

      real(wp) :: force(width)

      lost = apply_product(e%map%right, e%map%square, e%yield, numbers)
      if (.not. e%varies) return
      if (e%frozen) then
         force = apply(e%map%right, numbers)
         lost = lost + integral(e, e%alpha*force - integral(e, e%alpha_rate*force))
      else
         lost = lost + e%alpha*apply_product(e%map%right, e%map%square, e%lambda, numbers)
      end if
   end function lost_indentation

   !> Rate of the indentation lost to the forces in the panel, Q F
   pure function lost_velocity(e, numbers) result(lost)
      type(equations_t), intent(in) :: e
      !> Numbers of the pairs of the forces [N]
      real(wp), intent(in) :: numbers(width)
      !> Velocity [m/s]
      real(wp) :: lost(width)

      real(wp) :: force(width), impulse(width)

      associate (map => e%map)
         force = apply(map%right, numbers)
         impulse = times(map%square, e%lambda, numbers)
         lost = e%alpha*force + e%inverse_mass*apply(map%right, impulse)
         if (e%remembers) lost = lost + apply_product(map%right, map%square, e%plate, impulse)
         if (e%frozen) then
            lost = lost - integral(e, e%alpha_rate*force)
         else if (e%varies) then
            lost = lost + e%alpha_rate*apply(map%right, impulse)
         end if
      end associate
   end function lost_velocity

   !> M f
   pure function product_with_m(e, f) result(product)
      type(equations_t), intent(in) :: e
      real(wp), intent(in) :: f(width)
      !> M f
      real(wp) :: product(width)

      real(wp) :: numbers(width)

      if (e%formed) then
         product = apply(e%matrix, f)
         return
      end if
      associate (map => e%map)
         numbers = apply(map%left, f)
         if (e%simple .or. .not. e%varies) then
            product = apply_product(map%right, map%square, e%whole, numbers)
            if (e%varies) product = product &
               + e%alpha*apply_product(map%right, map%square, e%impulsive, numbers)
         else if (e%rebounds) then
            product = apply_product(map%right, map%square, e%stiffness, &
               apply(map%left, lost_indentation(e, numbers)))
         else
            product = lost_indentation(e, times(map%square, e%stiffness, numbers))
         end if
         if (e%viscosity > 0.0_wp) &
            product = product + e%viscosity*lost_velocity(e, numbers)
      end associate
   end function product_with_m

   !> Form M, at once if it is a function of H, else column by column
   pure subroutine form_matrix(e)
      type(equations_t), intent(inout) :: e

      real(wp) :: scaled(width, width), f, g
      integer :: i, j, k

      if (e%simple) then
         do k = 1, pairs
            do i = 1, width
               f = e%whole(k)
               g = e%whole(pairs + k)
               if (e%varies) then
                  f = f + e%alpha(i)*e%impulsive(k)
                  g = g + e%alpha(i)*e%impulsive(pairs + k)
               end if
               scaled(i, k) = e%map%right(i, k)*f + e%map%right(i, pairs + k)*g
               scaled(i, pairs + k) = e%map%right(i, pairs + k)*f &
                  + e%map%square(k)*e%map%right(i, k)*g
            end do
         end do
         do j = 1, width
            e%matrix(:, j) = apply(scaled, e%map%left(:, j))
         end do
      else
         do j = 1, width
            e%matrix(:, j) = product_with_m(e, identity(:, j))
         end do
      end if
      e%formed = .true.
   end subroutine form_matrix

   !> The unknown x and f(x) at the stages: indentation and u, or condition and force from t1
   pure subroutine evaluate(self, e, panel)
      class(panel_problem_t), intent(in) :: self
      type(equations_t), intent(inout) :: e
      type(panel_t), intent(in) :: panel

      if (e%rebounds) then
         call self%approach%evaluate(self%modes%contact%equilibrium, panel%stages, &
            panel%time(1:), panel%t1(1:), e%x, e%f, e%slope, e%rate)
      else
         e%x = panel%indentation(1:)
         call self%impact%law%evaluate(width, e%x, e%f, e%slope)
         e%f = e%x*e%f - e%start_u
      end if
   end subroutine evaluate

   !> Change the unknown of a panel; while the contact recedes, extrapolate condition and force
   pure subroutine move(self, e, change, panel)
      class(panel_problem_t), intent(in) :: self
      !> Equations of the panel, evaluated
      type(equations_t), intent(in) :: e
      !> Change of x
      real(wp), intent(in) :: change(width)
      type(panel_t), intent(inout) :: panel

      integer :: i

      if (e%rebounds) then
         do i = 1, panel%stages
            panel%t1(i) = self%approach%moved(panel%t1(i), change(i), e%rate(i))
         end do
         panel%condition(1:) = e%x + change
         panel%force(1:) = e%f + e%slope*change
      else
         panel%indentation(1:) = e%x + change
      end if
   end subroutine move

   !> Forces of a solution; while the contact recedes they are known already
   pure subroutine find_forces(self, e, panel, numbers)
      class(panel_problem_t), intent(in) :: self
      type(equations_t), intent(inout) :: e
      type(panel_t), intent(inout) :: panel
      !> Numbers of the pairs of the forces [N]
      real(wp), intent(out) :: numbers(width)

      real(wp) :: force(width), second(width, width)

      if (e%rebounds) then
         numbers = apply(e%map%left, panel%force(1:))
         return
      end if
      call self%evaluate(e, panel)
      numbers = times(e%map%square, e%stiffness, apply(e%map%left, e%f)) + e%memory
      panel%force(1:) = apply(e%map%right, numbers)
      if (allocated(e%lag)) then
         call self%second_term(e, force, second)
         panel%force(1:) = panel%force(1:) + force
         numbers = numbers + apply(e%map%left, force)
      end if
   end subroutine find_forces

   !> Forces of a solution, their integrals I = I_n + H F and J = J_n + H I_n + H^2 F, and the
   !> motion if it is not the unknown
   pure subroutine integrate(self, e, panel)
      class(panel_problem_t), intent(in) :: self
      type(equations_t), intent(inout) :: e
      type(panel_t), intent(inout) :: panel

      real(wp), dimension(width) :: numbers, impulse, rate

      associate (map => e%map)
         call self%find_forces(e, panel, numbers)
         if (e%rebounds) panel%indentation(1:) = panel%indentation(0) + e%gain &
            - lost_indentation(e, numbers)
         impulse = times(map%square, e%lambda, numbers)
         panel%impulse(1:) = panel%impulse(0) + apply(map%right, impulse)
         panel%second_impulse(1:) = panel%second_impulse(0) + panel%impulse(0)*e%elapsed &
            + apply_product(map%right, map%square, e%lambda, impulse)
         if (e%frozen) then
            panel%drift(1:) = panel%drift(0) + integral(e, e%alpha_rate*panel%force(1:))
            panel%deflection(1:) = panel%deflection(0) &
               + integral(e, e%alpha*panel%force(1:) - panel%drift(1:))
         else if (e%remembers) then
            rate = times(map%square, e%plate, impulse) + e%past
            panel%drift(1:) = -apply(map%right, rate)
            panel%deflection(1:) = panel%deflection(0) &
               + apply_product(map%right, map%square, e%lambda, rate)
         end if
      end associate
   end subroutine integrate

   !> Set t1 and the condition at the end of a panel whose map is stationary there. Collocation does
   !> not resolve internal variables that settle in such a panel, and the end has no weight in its
   !> integrals, so the condition is integrated by `settling_t`
   pure subroutine set_end_condition(self, rule, e, start, panel)
      class(panel_problem_t), intent(in) :: self
      type(collocation_t), intent(in) :: rule
      type(equations_t), intent(in) :: e
      type(start_t), intent(in) :: start
      type(panel_t), intent(inout) :: panel

      real(wp) :: velocity

      associate (n => rule%stages, contact => self%modes%contact, impact => self%impact)
         panel%t1(n) = sum(rule%end_weight(0:n - 1)*panel%t1(0:n - 1))
         panel%condition(n) = contact%equilibrium*panel%indentation(n) &
            + rule%settling%total(contact%moduli, contact%rates, e%scale, start%lag, &
            panel%indentation(:n))
         if (e%viscosity > 0.0_wp) then
            velocity = impact%free_velocity(panel%time(n)) - panel%impulse(n)*e%inverse_mass
            call self%set_end_drift(rule, e, start, panel)
            if (impact%plate%drifts()) then
               velocity = velocity + panel%drift(n)
            else
               velocity = velocity - panel%impulse(n) &
                  *impact%plate%alpha_rate(panel%time(n), panel%alpha(n))
            end if
            panel%condition(n) = panel%condition(n) + e%viscosity*velocity
         end if
      end associate
   end subroutine set_end_condition

   !> Set the drift of a hereditary plate at the end of such a panel
   pure subroutine set_end_drift(self, rule, e, start, panel)
      class(panel_problem_t), intent(in) :: self
      type(collocation_t), intent(in) :: rule
      type(equations_t), intent(in) :: e
      type(start_t), intent(in) :: start
      type(panel_t), intent(inout) :: panel

      if (.not. e%remembers) return
      associate (n => rule%stages, plate => self%modes%plate)
         panel%drift(n) = -rule%settling%total(plate%moduli, plate%rates, e%scale, start%p, &
            panel%impulse(:n))
      end associate
   end subroutine set_end_drift

   !> Make the end of a panel the start of the next one
   subroutine advance(self, rule, step, panel, start)
      class(panel_problem_t), intent(in) :: self
      type(collocation_t), intent(in) :: rule
      type(step_t), intent(in) :: step
      type(panel_t), intent(in) :: panel
      !> State at the start of the panel, on return that at its end
      type(start_t), intent(inout) :: start

      real(wp) :: gained(width)

      associate (map => rule%map(step%index), law => self%impact%law)
         gained = panel%indentation(1:) - start%indentation
         if (.not. associated(self%approach)) &
            gained = law%u(panel%indentation(1:)) - law%u(start%indentation)
         call advance_lags(map, step%map_scale(), self%modes%contact, gained, start%lag)
         if (allocated(start%p)) call advance_lags(map, step%map_scale(), self%modes%plate, &
            panel%impulse(1:) - start%impulse, start%p)
         call move_to_end(panel, start)
      end associate
   end subroutine advance

   !> Begin the rebound at the end of the approach, the largest indentation
   subroutine begin_rebound(self, approach, start)
      class(panel_problem_t), intent(inout) :: self
      type(approach_t), intent(in), target :: approach
      !> State at the end of the approach, on return at the start of the rebound
      type(start_t), intent(inout) :: start

      self%approach => approach
      start%lag = approach%w
      start%condition = self%modes%contact%equilibrium*start%indentation &
         + sum(self%modes%contact%moduli*approach%w)
      start%t1 = start%time
      self%largest_condition = start%condition
      self%noise = rounding_of_condition
      self%tolerance = self%collocator%near_tolerance
   end subroutine begin_rebound

   !> Set up the second term of the Volterra series: form the matrices of the modes
   pure subroutine set_up_second_term(e, rates, start_lag)
      type(equations_t), intent(inout) :: e
      !> Rates of the modes [1/s], shape (modes)
      real(wp), intent(in) :: rates(:)
      !> Lags u - q_k at the start [m^1.5], shape (modes)
      real(wp), intent(in) :: start_lag(:)

      real(wp) :: settled(width)
      integer :: j, k

      allocate (e%lag(width, width, size(rates)))
      e%start_lag = start_lag
      do k = 1, size(rates)
         settled = ratio(e%map%square, constant(1.0_wp), constant(1.0_wp) + rates(k)*e%lambda)
         do j = 1, width
            e%lag(:, j, k) = apply_product(e%map%right, e%map%square, settled, e%map%left(:, j))
         end do
      end do
   end subroutine set_up_second_term

   !> Force of the second term, c2 (G_0 u^2 + sum_k G_k p_k^2), and its derivative
   pure subroutine second_term(self, e, force, slope)
      class(panel_problem_t), intent(in) :: self
      !> Equations of the panel, evaluated
      type(equations_t), intent(in) :: e
      !> Force [N]
      real(wp), intent(out) :: force(width)
      !> dF/du [N/m^1.5]
      real(wp), intent(out) :: slope(width, width)

      real(wp) :: u(width), p(width)
      integer :: j, k

      u = e%f + e%start_u
      slope = 0.0_wp
      associate (contact => self%modes%contact)
         force = contact%equilibrium*u**2
         do j = 1, width
            slope(j, j) = 2.0_wp*contact%equilibrium*u(j)
         end do
         do k = 1, size(contact%rates)
            p = matmul(e%lag(:, :, k), e%f + e%start_lag(k))
            force = force + contact%moduli(k)*p**2
            do j = 1, width
               slope(:, j) = slope(:, j) + 2.0_wp*contact%moduli(k)*p*e%lag(:, j, k)
            end do
         end do
      end associate
      force = self%collocator%second_coefficient*force
      slope = self%collocator%second_coefficient*slope
   end subroutine second_term

   !> Velocity of the plate at a stage of a panel: U' = alpha F + alpha' I; for a frozen or
   !> hereditary plate, alpha F - drift
   pure function plate_velocity(self, panel, j) result(velocity)
      class(panel_problem_t), intent(in) :: self
      type(panel_t), intent(in) :: panel
      !> Stage, > 0
      integer, intent(in) :: j
      !> Velocity [m/s]
      real(wp) :: velocity

      velocity = panel%alpha(j)*panel%force(j)
      if (self%impact%plate%drifts()) then
         velocity = velocity - panel%drift(j)
      else
         velocity = velocity + panel%impulse(j) &
            *self%impact%plate%alpha_rate(panel%time(j), panel%alpha(j))
      end if
   end function plate_velocity

   !> Rate of the indentation at a stage of a panel: s' = v0 + g t - I/m - U'
   pure function relative_velocity(self, panel, j) result(velocity)
      class(panel_problem_t), intent(in) :: self
      type(panel_t), intent(in) :: panel
      !> Stage, > 0
      integer, intent(in) :: j
      !> Velocity [m/s]
      real(wp) :: velocity

      velocity = self%impact%free_velocity(panel%time(j)) - panel%impulse(j)/self%impact%mass &
         - self%plate_velocity(panel, j)
   end function relative_velocity

end module vcor_solver_ive_problem
