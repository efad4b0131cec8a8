!> The equations of a panel, in one form for a contact that grows and one that recedes
!>
!> The forces F in a panel reduce the indentation by R F and its rate by Q F; H is the integration
!> matrix of the panel, P(H) the response of a plate with memory or of a structure, C a flexibility
!> that follows the force at once, and ' the derivative of the polynomial:
!>
!>     s = s_n + g - R F,    R = H^2/m + alpha H + P H^2 + C,
!>     s' = .. - Q F,        Q = H/m + alpha + alpha' H + P H + C '
!>
!> The hereditary integral of x = u or s in the panel follows from its lags p_k:
!>
!>     int k x' = S (x - x_n) + b,    S = G_0 + sum_k G_k (1 + l_k H)^-1 + eta H^-1,
!>                                    b = G_0 x_n 1 + sum_k G_k p_k,n (1 + l_k H)^-1 1
!>
!> While the contact grows, F = S (u - u_n) + b. While it recedes, N = S (s - s_n) + b + eta s' with
!> S without the dashpot, and F is a function of N. Both are x + M f(x) = r with an f that acts
!> stage by stage:
!>
!>     grows:    x = s, f = u(s) - u_n,  M = R S,          r = s_n + g - R b
!>     recedes:  x = N, f = F(N),        M = S R + eta Q,  r = S g + b + eta g'
module vcor_solver_ive_equations
   use vcor_impact_problem, only : impact_t
   use vcor_impact_structure, only : vibration_t
   use vcor_kinds, only : wp
   use vcor_numeric_radau_dense, only : apply, width
   use vcor_numeric_radau_rule, only : closing, map_t, rule_t, slots
   use vcor_solver_ive_approach, only : approach_t
   use vcor_solver_ive_lags, only : advance_lags, find_response, sums_t
   use vcor_solver_ive_modes, only : add_modes, advance_modes, rate_at_start
   use vcor_solver_ive_panel, only : panel_t, state_t, step_t
   implicit none
   private

   public :: motion_t, equations_t

   !> One of the two solutions of an impact: what all its panels share, and where it stands. The
   !> targets of the pointers must outlive it
   type :: motion_t
      type(impact_t), pointer :: impact => null()
      type(sums_t), pointer :: sums => null()
      type(rule_t), pointer :: rule => null()
      !> State at the start of the panel
      type(state_t) :: start
      !> The panel
      type(panel_t) :: panel
      !> Inverse of the Jacobian of its equations, for neighbouring panels
      real(wp) :: inverse(width, width) = 0.0_wp
      !> Error that Newton's method may leave in x, over its largest value
      real(wp) :: tolerance = 0.0_wp
      !> Whether the contact recedes
      logical :: recedes = .false.
      !> The approach, for a contact that will recede: that of the better solution, for both, since
      !> polynomials are less accurate between the ends of panels
      type(approach_t), pointer :: approach => null()
   contains
      procedure :: set_up
      procedure :: evaluate
      procedure :: move
      procedure :: finish
      procedure, private :: set_end
      procedure :: velocity_at
      procedure :: plate_velocity_at
      procedure :: find_velocity
      procedure :: work_in_panel
      procedure :: advance
      procedure :: turn
   end type motion_t

   !> The equations of one panel. Functions of H are stored by its eigenvalues, S, R and P as
   !> vectors; a plate whose alpha varies has a further part
   type :: equations_t
      !> Map of the panel
      type(map_t), pointer :: map => null()
      !> Whether the force is zero at the end of the panel, and the last stage has no weight
      logical :: closes
      !> Whether the contact recedes, whether alpha varies in the panel, and whether the target has
      !> a memory or modes
      logical :: recedes, varies, has_memory
      !> Times of the stages since the start [s]
      real(wp) :: elapsed(width)
      !> H and its eigenvalues [s]
      real(wp) :: h(width, width)
      complex(wp) :: eigenvalue(slots)
      !> S [N/m^1.5], R [s2/kg] and R S; without the factor H/m + alpha if alpha varies
      complex(wp) :: stiffness(slots), yield(slots), whole(slots)
      !> Velocity of the target per impulse, P [1/kg], and that from forces in earlier panels [m/s]
      complex(wp) :: plate(slots), past(slots)
      !> alpha [m/(N s)], and its rate where it is needed [m/(N s2)]
      real(wp) :: alpha(width), alpha_rate(width)
      !> Flexibility C [m/N], and the derivative of a polynomial at the stages, its value at the
      !> start first [1/s], set if there is one
      real(wp) :: residual = 0.0_wp
      real(wp) :: derivative(width, 0:width)
      !> Viscosity of the dashpot of a receding contact [N s/m^1.5], and 1/m [1/kg]
      real(wp) :: viscosity, inverse_mass
      !> b [N], or [N/m^0.5]: coefficients of the eigenvectors
      complex(wp) :: memory(slots)
      !> g [m]
      real(wp) :: gain(width)
      !> r [m], or [N/m^0.5]
      real(wp) :: right(width)
      !> Whether M has been formed, and M
      logical :: formed = .false.
      real(wp) :: matrix(width, width)
      !> The unknown x [m], or [N/m^0.5], and f(x) [m^1.5], or [N]
      real(wp) :: x(width), f(width)
      !> df/dx, and dN/dt1 while the contact recedes [N/(m^0.5 s)]
      real(wp) :: slope(width), rate(width)
   contains
      procedure :: matrix_times
      procedure :: form_matrix
      procedure, private :: with_plate
      procedure, private :: lost_indentation
      procedure, private :: lost_velocity
   end type equations_t

contains

   !> Set up the equations of a panel
   subroutine set_up(self, step, e)
      class(motion_t), intent(inout) :: self
      type(step_t), intent(in) :: step
      type(equations_t), intent(out) :: e

      real(wp) :: velocity
      integer :: n

      associate (start => self%start, impact => self%impact, contact => self%sums%contact)
         n = self%rule%stages
         e%map => self%rule%map(step%kind)
         e%closes = step%kind == closing
         e%recedes = self%recedes
         e%inverse_mass = 1.0_wp/impact%mass
         call self%panel%begin(self%rule, step, start, e%elapsed)
         e%h = step%duration*e%map%matrix
         e%eigenvalue = step%duration*e%map%eigenvalue
         velocity = impact%free_velocity(start%time) - start%impulse*e%inverse_mass
         e%gain = e%elapsed*(velocity + 0.5_wp*impact%gravity*e%elapsed)
         call add_plate(self, e)

         call find_response(contact, start%lag, e%eigenvalue, e%stiffness, e%memory)
         e%memory = e%memory*e%map%left_one
         e%viscosity = 0.0_wp
         if (self%recedes) then
            e%viscosity = contact%viscosity
            e%whole = e%stiffness*e%yield
            e%right = contact%equilibrium*start%indentation &
               + e%map%compose(e%stiffness*e%map%decompose(e%gain) + e%memory)
            if (e%viscosity > 0.0_wp) call add_dashpot(self, velocity, e)
            if (e%closes) e%right(n) = 0.0_wp
         else
            if (contact%viscosity > 0.0_wp) e%stiffness = e%stiffness &
               + contact%viscosity/e%eigenvalue
            e%memory = e%memory + contact%equilibrium*start%u*e%map%left_one
            e%whole = e%stiffness*e%yield
            e%right = start%indentation + e%gain - e%lost_indentation(e%memory)
         end if
         e%right(n + 1:) = 0.0_wp
      end associate
   end subroutine set_up

   !> Add the plate: its parameter, and its share of R and g
   subroutine add_plate(self, e)
      class(motion_t), intent(inout) :: self
      type(equations_t), intent(inout) :: e

      integer :: n

      n = self%rule%stages
      e%varies = .false.
      e%alpha = 0.0_wp
      e%alpha_rate = 0.0_wp
      associate (start => self%start, plate => self%impact%target)
         e%has_memory = plate%has_memory()
         if (allocated(self%sums%vibration)) then
            call add_structure(self, self%sums%vibration, e)
         else if (e%has_memory) then
            e%alpha(:n) = self%sums%plate%viscosity
            call find_response(self%sums%plate, start%plate_lag, e%eigenvalue, e%plate, e%past)
            e%past = e%past*e%map%left_one
            e%gain = e%gain - e%map%compose(e%eigenvalue*e%past)
         else if (plate%moves()) then
            call plate%alpha_at(self%panel%time(1:n), e%alpha(:n))
            ! alpha never falls, so it is constant if it is the same at both ends
            e%varies = e%alpha(n) > e%alpha(1)
            if (e%varies) e%gain = e%gain - (e%alpha - start%alpha)*start%impulse
         end if
         e%yield = e%eigenvalue
         if (.not. e%varies) e%yield = e%yield*(e%inverse_mass*e%eigenvalue + e%alpha(1))
         if (e%has_memory) e%yield = e%yield + e%plate*e%eigenvalue**2 + e%residual
         self%panel%alpha(1:) = e%alpha
      end associate
   end subroutine add_plate

   !> Add a struck structure
   subroutine add_structure(self, vibration, e)
      class(motion_t), intent(in) :: self
      type(vibration_t), intent(in) :: vibration
      type(equations_t), intent(inout) :: e

      integer :: j

      associate (n => self%rule%stages, start => self%start, panel => self%panel)
         e%plate = 0.0_wp
         e%past = 0.0_wp
         call add_modes(vibration, start%modes, e%eigenvalue, e%plate, e%past)
         e%past = e%past*e%map%left_one
         e%residual = vibration%residual
         e%gain = e%gain - e%map%compose(e%eigenvalue*e%past) + e%residual*start%force
         e%derivative = 0.0_wp
         if (.not. e%residual > 0.0_wp) return
         do j = 1, n
            if (panel%pace(self%rule%point(j)) > 0.0_wp) &
               e%derivative(j, :) = self%rule%derivative(j, :)/panel%pace(self%rule%point(j))
         end do
      end associate
   end subroutine add_structure

   !> Add the dashpot of a receding contact: eta s' in the condition
   subroutine add_dashpot(self, velocity, e)
      class(motion_t), intent(in) :: self
      !> Velocity of the sphere at the start [m/s]
      real(wp), intent(in) :: velocity
      type(equations_t), intent(inout) :: e

      associate (n => self%rule%stages, plate => self%impact%target)
         e%right = e%right + e%viscosity*(velocity + self%impact%gravity*e%elapsed)
         if (e%has_memory) e%right = e%right - e%viscosity*e%map%compose(e%past)
         if (e%residual > 0.0_wp) &
            e%right = e%right - e%viscosity*e%residual*self%start%force*e%derivative(:, 0)
         if (.not. e%varies) return
         e%alpha_rate(:n) = plate%alpha_rate(self%panel%time(1:n), e%alpha(:n))
         e%right = e%right - e%viscosity*e%alpha_rate*self%start%impulse
      end associate
   end subroutine add_dashpot

   !> Indentation lost to forces in the panel, R F
   pure function lost_indentation(self, force) result(lost)
      class(equations_t), intent(in) :: self
      !> Forces [N]: coefficients of the eigenvectors
      complex(wp), intent(in) :: force(slots)
      !> Indentation [m]
      real(wp) :: lost(width)

      lost = self%with_plate(self%map%compose(self%yield*force))
   end function lost_indentation

   !> The factor H/m + alpha, if alpha varies
   pure function with_plate(self, x) result(product)
      class(equations_t), intent(in) :: self
      real(wp), intent(in) :: x(width)
      real(wp) :: product(width)

      product = x
      if (self%varies) product = self%inverse_mass*apply(self%h, x) + self%alpha*x
   end function with_plate

   !> Rate of the indentation lost to forces in the panel, Q F
   pure function lost_velocity(self, force) result(lost)
      class(equations_t), intent(in) :: self
      !> Forces [N]
      real(wp), intent(in) :: force(width)
      !> Velocity [m/s]
      real(wp) :: lost(width)

      real(wp) :: impulse(width)

      impulse = apply(self%h, force)
      lost = self%alpha*force + (self%inverse_mass + self%alpha_rate)*impulse
      if (self%has_memory) lost = lost + self%map%compose(self%plate*self%map%decompose(impulse))
      if (self%residual > 0.0_wp) &
         lost = lost + self%residual*apply(self%derivative(:, 1:), force)
   end function lost_velocity

   !> M f
   pure function matrix_times(self, f) result(product)
      class(equations_t), intent(in) :: self
      real(wp), intent(in) :: f(width)
      real(wp) :: product(width)

      complex(wp) :: c(slots)

      if (self%formed) then
         product = apply(self%matrix, f)
         return
      end if
      c = self%map%decompose(f)
      if (self%recedes .and. self%varies) then
         product = self%map%compose(self%stiffness*self%map%decompose(self%lost_indentation(c)))
      else
         product = self%with_plate(self%map%compose(self%whole*c))
      end if
      if (self%viscosity > 0.0_wp) product = product + self%viscosity*self%lost_velocity(f)
   end function matrix_times

   !> Form M, at once if it is a function of H, else column by column
   pure subroutine form_matrix(self)
      class(equations_t), intent(inout) :: self

      real(wp) :: unit(width)
      integer :: j

      if (self%recedes .and. (self%viscosity > 0.0_wp .or. self%varies)) then
         do j = 1, width
            unit = 0.0_wp
            unit(j) = 1.0_wp
            self%matrix(:, j) = self%matrix_times(unit)
         end do
      else
         self%matrix = self%map%function_of(self%whole)
         do j = 1, width
            self%matrix(:, j) = self%with_plate(self%matrix(:, j))
         end do
      end if
      self%formed = .true.
   end subroutine form_matrix

   !> The unknown x and f(x) at the stages: indentation and u, or condition and force from t1
   pure subroutine evaluate(self, e)
      class(motion_t), intent(inout) :: self
      type(equations_t), intent(inout) :: e

      if (self%recedes) then
         call self%approach%evaluate(self%impact%law, self%rule%stages, self%sums%contact, &
            self%panel%time(1:), self%panel%t1(1:), e%x, e%f, e%slope, e%rate)
      else
         e%x = self%panel%indentation(1:)
         call self%impact%law%evaluate(width, e%x, e%f, e%slope)
         self%panel%u(1:) = e%x*e%f
         e%f = self%panel%u(1:) - self%start%u
      end if
   end subroutine evaluate

   !> Change x; while the contact recedes, t1 follows, and the force is extrapolated
   pure subroutine move(self, e, change)
      class(motion_t), intent(inout) :: self
      !> Equations of the panel, evaluated
      type(equations_t), intent(in) :: e
      !> Change of x
      real(wp), intent(in) :: change(width)

      integer :: i

      associate (panel => self%panel)
         if (self%recedes) then
            do i = 1, panel%stages
               panel%t1(i) = self%approach%moved(panel%t1(i), change(i), e%rate(i))
            end do
            panel%condition(1:) = e%x + change
            panel%force(1:) = e%f + e%slope*change
         else
            panel%indentation(1:) = e%x + change
         end if
      end associate
   end subroutine move

   !> Complete the solution of a panel: forces, their integrals, the rest of the motion
   pure subroutine finish(self, e)
      class(motion_t), intent(inout) :: self
      type(equations_t), intent(inout) :: e

      complex(wp) :: force(slots)
      real(wp) :: gained(width)

      associate (panel => self%panel)
         if (self%recedes) then
            if (e%closes) panel%force(self%rule%stages) = 0.0_wp
            force = e%map%decompose(panel%force(1:))
            panel%indentation(1:) = panel%indentation(0) + e%gain - e%lost_indentation(force)
            ! the eigenvalue 0 of a closing panel is left out, for which R is C; the force ends
            ! there
            if (e%closes) panel%indentation(self%rule%stages) = &
               panel%indentation(self%rule%stages) &
               + e%residual*sum(real(e%map%last*force, wp))
         else
            call self%evaluate(e)
            force = e%stiffness*e%map%decompose(e%f) + e%memory
            panel%force(1:) = e%map%compose(force)
         end if
         gained = apply(e%h, panel%force(1:))
         panel%impulse(1:) = panel%impulse(0) + gained
         panel%second_impulse(1:) = panel%second_impulse(0) + panel%impulse(0)*e%elapsed &
            + apply(e%h, gained)
         if (e%has_memory) panel%drift(1:) = e%map%compose(e%plate*e%map%decompose(gained) + e%past)
         if (e%closes) call self%set_end()
      end associate
   end subroutine finish

   !> Drift, t1 and condition at the end of a panel whose map is stationary there. Collocation does
   !> not resolve modes that settle in such a panel; their lags at the end are integrated exactly
   pure subroutine set_end(self)
      class(motion_t), intent(inout) :: self

      associate (n => self%rule%stages, panel => self%panel, start => self%start, &
                 contact => self%sums%contact, plate => self%sums%plate, &
                 time => self%panel%step%duration)
         if (self%impact%target%hereditary()) then
            panel%drift(n) = self%rule%settling%total(plate%moduli, plate%rates, time, &
               start%plate_lag, panel%force(1:n))
         else if (allocated(self%sums%vibration)) then
            associate (map => self%rule%map(panel%step%kind))
               panel%drift(n) = panel%drift(n) + rate_at_start(self%sums%vibration, &
                  start%modes)*(1.0_wp - sum(real(map%last*map%left_one, wp)))
            end associate
         end if
         panel%t1(n) = sum(self%rule%end_weight(0:n - 1)*panel%t1(0:n - 1))
         call self%find_velocity()
         panel%condition(n) = contact%equilibrium*panel%indentation(n) &
            + self%rule%settling%total(contact%moduli, contact%rates, time, start%lag, &
            panel%velocity(1:n)) + contact%viscosity*panel%velocity(n)
      end associate
   end subroutine set_end

   !> Velocity of the target at a stage of the panel: U' = alpha F + alpha' I, or with memory
   !> alpha F + Z + C F'
   pure function plate_velocity_at(self, j) result(velocity)
      class(motion_t), intent(in) :: self
      !> Stage
      integer, intent(in) :: j
      !> Velocity [m/s]
      real(wp) :: velocity

      associate (panel => self%panel)
         velocity = panel%alpha(j)*panel%force(j) + panel%drift(j)
         if (allocated(self%sums%vibration)) then
            if (self%sums%vibration%residual > 0.0_wp) velocity = velocity &
               + self%sums%vibration%residual*panel%rate_at(self%rule, panel%force, j)
         else if (.not. self%impact%target%hereditary()) then
            velocity = velocity + panel%impulse(j) &
               *self%impact%target%alpha_rate(panel%time(j), panel%alpha(j))
         end if
      end associate
   end function plate_velocity_at

   !> Rate of the indentation at a stage of the panel, s' = v0 + g t - I/m - U'
   pure function velocity_at(self, j) result(velocity)
      class(motion_t), intent(in) :: self
      !> Stage
      integer, intent(in) :: j
      !> Velocity [m/s]
      real(wp) :: velocity

      velocity = self%impact%free_velocity(self%panel%time(j)) &
         - self%panel%impulse(j)/self%impact%mass - self%plate_velocity_at(j)
   end function velocity_at

   !> Rate of the indentation at all stages
   pure subroutine find_velocity(self)
      class(motion_t), intent(inout) :: self

      integer :: j

      do j = 1, self%panel%stages
         self%panel%velocity(j) = self%velocity_at(j)
      end do
      self%panel%velocity(self%panel%stages + 1:) = 0.0_wp
   end subroutine find_velocity

   !> Work int alpha F^2 in the panel [J]
   pure function work_in_panel(self) result(work)
      class(motion_t), intent(in) :: self
      real(wp) :: work

      associate (panel => self%panel, n => self%rule%stages)
         work = sum(self%rule%weight(:n)*panel%pace(self%rule%point(1:n))*panel%alpha(1:n) &
            *panel%force(1:n)**2)
      end associate
   end function work_in_panel

   !> Make the end of the panel the start of the next one; its rate of the indentation must be known
   pure subroutine advance(self)
      class(motion_t), intent(inout) :: self

      real(wp), dimension(width) :: gained, weight
      real(wp), allocatable :: lag(:)

      associate (panel => self%panel, start => self%start, &
                 map => self%rule%map(self%panel%step%kind), time => self%panel%step%duration)
         gained = panel%indentation(1:) - start%indentation
         if (self%recedes) then
            lag = start%lag
            call advance_lags(map, time, self%sums%contact, gained, start%lag)
            ! the eigenvalue 0 of a closing panel: a structure may strike again
            if (allocated(self%sums%vibration)) start%lag = start%lag &
               + lag*(1.0_wp - sum(real(map%last*map%left_one, wp)))
         else
            gained = panel%u(1:) - start%u
            call advance_lags(map, time, self%sums%contact, gained, start%lag)
         end if
         if (self%impact%target%hereditary()) call advance_lags(map, time, self%sums%plate, &
            panel%impulse(1:) - start%impulse, start%plate_lag)
         if (allocated(self%sums%vibration)) then
            gained = panel%impulse(1:) - start%impulse
            weight = self%rule%weight
            weight(:panel%stages) = weight(:panel%stages) &
               *panel%pace(self%rule%point(1:panel%stages))
            call advance_modes(map, time, self%sums%vibration, gained, weight, start%modes, &
               start%lost)
         end if
         call panel%move_to_end(start)
      end associate
   end subroutine advance

   !> Let the contact recede from the start of the next panel on. Both solutions begin the rebound
   !> with the condition that the approach ends with: it is the largest that there is a t1 for
   pure subroutine turn(self)
      class(motion_t), intent(inout) :: self

      associate (contact => self%sums%contact, start => self%start)
         self%recedes = .true.
         start%indentation = self%approach%depth
         start%lag = self%approach%w
         start%t1 = start%time
         start%condition = contact%equilibrium*start%indentation + sum(contact%moduli*start%lag)
         self%approach%condition = start%condition
      end associate
   end subroutine turn

end module vcor_solver_ive_equations
