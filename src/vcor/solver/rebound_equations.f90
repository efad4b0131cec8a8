!> Equations of a panel of the rebound of a receding contact in the internal-variable method
!>
!> The unknowns are the stage values of t1, by which force F and condition N are known from the
!> approach (`vcor_solver_approach`). With functions of the integration matrix H of the panel as in
!> `vcor_solver_panel`, a force in it takes R F of the indentation and Q F of its rate, and
!> N = int_0^t k(t - x) s'(x) dx is
!>
!>     N = G_0 s_n + S (s - s_n) + b + eta s',   s - s_n = g - R F,   s' = v - Q F
!>
!> with what has not relaxed of s_n in b, and the motion without a force in g and v. What is left is
!>
!>     N + T F = G_0 s_n + S g + b + eta v,    T = S R + eta Q,
!>
!> with N and F as functions of t1. A dashpot gives no force once the contact shrinks, but takes
!> part in the condition.
module vcor_solver_rebound_equations
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_collocation, only : collocation_t, panel_map_t, width
   use vcor_numeric_linear, only : apply
   use vcor_numeric_pairs, only : constant, times
   use vcor_solver_modes, only : modes_t, resolve, start_t
   use vcor_solver_panel, only : begin_panel, panel_t
   implicit none
   private

   public :: rebound_start_t, rebound_panel_t, equations_t
   public :: set_up, response, integrate

   !> State at the start of a panel of the rebound; internal variables q_k have no part in it
   type, extends(start_t) :: rebound_start_t
      !> Condition N [N/m^0.5]
      real(wp) :: condition = 0.0_wp
      !> Condition at the largest indentation, against which its errors are counted [N/m^0.5]
      real(wp) :: largest_condition = 0.0_wp
      !> t1 [s]
      real(wp) :: t1 = 0.0_wp
      !> What has not relaxed of the indentation, w_k [m], shape (modes)
      real(wp), allocatable :: w(:)
   end type rebound_start_t

   !> Solution on a panel of the rebound
   type, extends(panel_t) :: rebound_panel_t
      !> Condition N [N/m^0.5]
      real(wp) :: condition(0:width) = 0.0_wp
      !> t1 [s]; on entry of the solver a guess
      real(wp) :: t1(0:width) = 0.0_wp
   end type rebound_panel_t

   !> What the equations of a panel are made of; functions of H as in `panel_map_t`
   type :: equations_t
      !> Eigenvalues of H [s]
      real(wp) :: lambda(width)
      !> S [N/m^1.5]
      real(wp) :: stiffness(width)
      !> Velocity of a hereditary plate per impulse in the panel, by its memory [1/kg]
      real(wp) :: plate(width)
      !> What an impulse takes of the velocity: 1/m and that [1/kg]
      real(wp) :: mobility(width)
      !> R [s2/kg], but for the part of an alpha that varies
      real(wp) :: yield(width)
      !> S R likewise [m^-0.5]
      real(wp) :: loss(width)
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha(width)
      !> Its rate [m/(N s^2)]
      real(wp) :: alpha_rate(width)
      !> Velocity of a hereditary plate by what it remembers of earlier panels [m/s]
      real(wp) :: past(width)
      !> Gain of indentation without a force in the panel, g [m]
      real(wp) :: gain(width)
      !> Rate of the indentation without a force in the panel, v [m/s]
      real(wp) :: velocity(width)
      !> Condition without a force in the panel [N/m^0.5]
      real(wp) :: condition(width)
      !> Whether the plate is frozen, and whether it remembers the force
      logical :: frozen, remembers
      !> Whether alpha changes in time, and whether there is a dashpot
      logical :: varies, damped
      !> Whether time stands still at the end
      logical :: closes
   end type equations_t

contains

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
      type(rebound_start_t), intent(in) :: start
      !> The panel: its times and plate parameters are set, and all values at its start
      type(rebound_panel_t), intent(inout) :: panel

      real(wp) :: elapsed(width), past(width), velocity, start_alpha, inverse_mass
      integer :: n, i

      n = rule%stages
      call begin_panel(rule, map, scale, start, panel, elapsed)
      panel%condition(0) = start%condition
      panel%t1(0) = start%t1

      inverse_mass = 1.0_wp/impact%mass
      velocity = impact%velocity - start%impulse*inverse_mass
      associate (e => equations)
         e%frozen = impact%plate%frozen()
         e%remembers = size(modes%plate%rates) > 0
         e%damped = modes%contact%viscosity > 0.0_wp
         e%closes = .not. map%slope + 2.0_wp*map%bend > 0.0_wp
         e%lambda = scale*map%eigenvalue
         e%alpha = 0.0_wp
         e%alpha_rate = 0.0_wp
         e%past = 0.0_wp
         e%plate = 0.0_wp
         e%gain = velocity*elapsed
         e%velocity = velocity
         if (e%remembers) then
            ! what settles at once in a hereditary plate counts as alpha, what it remembers is
            ! U' = R H F + c
            e%alpha(:n) = modes%plate%viscosity
            call resolve(modes%plate, start%p, map, e%lambda, e%plate, past)
            e%past = apply(map%right, past)
            e%gain = e%gain - apply(map%right, times(map%square, e%lambda, past))
            e%velocity = e%velocity - e%past
         else
            do i = 1, n
               call impact%plate%alpha_and_rate(panel%time(i), e%alpha(i), e%alpha_rate(i))
            end do
         end if
         e%mobility = e%plate + constant(inverse_mass)
         e%varies = any(abs(e%alpha_rate) > 0.0_wp)
         if (e%frozen) then
            e%gain = e%gain + start%drift*elapsed
            e%velocity = e%velocity + start%drift
         else if (e%varies) then
            start_alpha = impact%plate%alpha(start%time)
            e%gain = e%gain - (e%alpha - start_alpha)*start%impulse
            e%velocity = e%velocity - e%alpha_rate*start%impulse
         end if
         e%gain(n + 1:) = 0.0_wp
         panel%alpha(1:) = e%alpha

         e%yield = times(map%square, e%lambda, times(map%square, e%lambda, e%mobility))
         if (.not. e%varies) e%yield = e%yield + e%alpha(1)*e%lambda
         call resolve(modes%contact, start%w, map, e%lambda, e%stiffness, past)
         e%loss = times(map%square, e%stiffness, e%yield)
         e%condition = modes%contact%equilibrium*start%indentation &
            + apply(map%right, times(map%square, e%stiffness, apply(map%left, e%gain)) + past)
         if (e%damped) e%condition = e%condition + modes%contact%viscosity*e%velocity
         e%condition(n + 1:) = 0.0_wp
         ! no force acts at the end of the contact, and it would not count
         if (e%closes) e%condition(n) = 0.0_wp
      end associate
   end subroutine set_up

   !> What forces in the panel take of the condition: T F
   pure function response(map, equations, viscosity, force, numbers) result(taken)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> Viscosity of the contact [N s/m^1.5]
      real(wp), intent(in) :: viscosity
      !> Forces at the stages [N]
      real(wp), intent(in) :: force(width)
      !> What `left` makes of them
      real(wp), intent(in) :: numbers(width)
      !> Condition [N/m^0.5]
      real(wp) :: taken(width)

      associate (e => equations)
         if (e%frozen .or. e%varies) then
            taken = apply(map%right, &
               times(map%square, e%stiffness, lost_indentation(map, e, force, numbers)))
         else
            taken = apply(map%right, times(map%square, e%loss, numbers))
         end if
         if (e%damped) taken = taken + viscosity*lost_velocity(map, e, force, numbers)
      end associate
   end function response

   !> What forces in the panel take of the indentation, R F, as `left` makes it of the stages
   pure function lost_indentation(map, equations, force, numbers) result(x)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> Forces at the stages [N]
      real(wp), intent(in) :: force(width)
      !> What `left` makes of them
      real(wp), intent(in) :: numbers(width)
      !> Indentation [m]
      real(wp) :: x(width)

      associate (e => equations)
         if (e%frozen) then
            x = times(map%square, e%lambda, apply(map%left, lost_velocity(map, e, force, numbers)))
         else
            x = times(map%square, e%yield, numbers)
            if (e%varies) x = x + apply(map%left, &
               e%alpha*apply(map%right, times(map%square, e%lambda, numbers)))
         end if
      end associate
   end function lost_indentation

   !> What forces in the panel take of the rate of the indentation, Q F. A frozen plate has
   !> U' = alpha F - int alpha' F dt, others U' = alpha F + alpha' I and what they remember
   pure function lost_velocity(map, equations, force, numbers) result(velocity)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> Forces at the stages [N]
      real(wp), intent(in) :: force(width)
      !> What `left` makes of them
      real(wp), intent(in) :: numbers(width)
      !> Velocity [m/s]
      real(wp) :: velocity(width)

      real(wp) :: impulse(width)

      associate (e => equations)
         velocity = e%alpha*force
         impulse = times(map%square, e%lambda, numbers)
         velocity = velocity + apply(map%right, times(map%square, e%mobility, impulse))
         if (e%frozen) then
            velocity = velocity - apply(map%right, &
               times(map%square, e%lambda, apply(map%left, e%alpha_rate*force)))
         else if (e%varies) then
            velocity = velocity + e%alpha_rate*apply(map%right, impulse)
         end if
      end associate
   end function lost_velocity

   !> Motion in the panel by its forces
   pure subroutine integrate(map, equations, panel)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Equations of the panel
      type(equations_t), intent(in) :: equations
      !> The panel
      type(rebound_panel_t), intent(inout) :: panel

      real(wp), dimension(width) :: numbers, impulse, x

      associate (e => equations, force => panel%force(1:))
         numbers = apply(map%left, force)
         impulse = times(map%square, e%lambda, numbers)
         panel%impulse(1:) = panel%impulse(0) + apply(map%right, impulse)
         panel%second_impulse(1:) = panel%second_impulse(0) &
            + panel%impulse(0)*(panel%time(1:) - panel%time(0)) &
            + apply(map%right, times(map%square, e%lambda, impulse))
         panel%indentation(1:) = panel%indentation(0) + e%gain &
            - apply(map%right, lost_indentation(map, e, force, numbers))
         if (e%frozen) then
            x = times(map%square, e%lambda, apply(map%left, e%alpha_rate*force))
            panel%drift(1:) = panel%drift(0) + apply(map%right, x)
            x = apply(map%left, e%alpha*force - panel%drift(1:))
            panel%deflection(1:) = panel%deflection(0) &
               + apply(map%right, times(map%square, e%lambda, x))
         else if (e%remembers) then
            x = times(map%square, e%plate, impulse)
            panel%drift(1:) = -(e%past + apply(map%right, x))
            x = apply(map%left, panel%drift(1:))
            panel%deflection(1:) = panel%deflection(0) &
               - apply(map%right, times(map%square, e%lambda, x))
         end if
      end associate
   end subroutine integrate

end module vcor_solver_rebound_equations
