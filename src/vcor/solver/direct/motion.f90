!> Equation of motion in product integration: the motion at a node as a function of the force there
!>
!> Eq. (2) integrated twice is s = v0 t + g t^2/2 - J/m - U with I' = F and J' = I. For every kind
!> of plate it is linear in the force F at the newest node. The plate's deflection and velocity are
!>
!>     constant, relaxing   U = alpha I,   U' = alpha F + alpha' I,   Eqs. (2) and (3)
!>     hereditary           U = alpha I + sum_j W_{n-j} dJ_j,   U' = alpha F + sum_j W_{n-j} dI_j
!>     frozen               U' = int alpha F' dt = alpha F - D,   D = int alpha' F dt
!>
!> I and J are parabolas over each step. The memory psi of the hereditary plate is integrated
!> exactly, like the kernel of the contact. The rate
!> of D starts as a power of t that depends on kernel and plate, so the first steps have a rule of
!> their own. A dashpot's impulse is exactly viscosity*u, so its force is not integrated.
module vcor_solver_direct_motion
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_solver_convolution, only : convolution_t, lengthen
   use vcor_solver_direct_weights, only : memory_weights
   use vcor_tuning, only : direct_near, direct_unresolved
   implicit none
   private

   public :: motion_t

   !> Integral over time up to a node, with the integrand at that node and the one before
   type :: integral_t
      !> Value of the integral
      real(wp) :: value = 0.0_wp
      !> Integrand at the last node and at the one before
      real(wp) :: last = 0.0_wp, before = 0.0_wp
   end type integral_t

   !> Motion of both bodies at the node being solved
   type :: motion_t
      !> Time [s]
      real(wp) :: t = 0.0_wp
      !> s = indentation(1) - indentation(2)*F [m], [m/N]
      real(wp) :: indentation(2) = 0.0_wp
      !> s' = velocity(1) - velocity(2)*F [m/s], [m/(N s)]
      real(wp) :: velocity(2) = 0.0_wp
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha = 0.0_wp
      !> Weight of the newest node in integrals over time [s]
      real(wp) :: weight = 0.0_wp
      !> Impulse [N s] and its integral [N s2], once the node is solved
      real(wp) :: impulse = 0.0_wp, second_impulse = 0.0_wp
      !> Time step [s]
      real(wp), private :: dt = 0.0_wp
      !> Weights of the end of the step, its start and the node before, for integrals over it [s]
      real(wp), private :: rule(3) = 0.0_wp
      !> The same weights for the drift D [s]
      real(wp), private :: drift_rule(3) = 0.0_wp
      !> Rate alpha' [m/(N s2)]
      real(wp), private :: alpha_rate = 0.0_wp
      !> Integral of the force without a dashpot's [N s], and of the whole impulse [N s2]
      type(integral_t), private :: force, whole
      !> Integrals for a frozen plate: of alpha F [m], of alpha' F (the drift D) [m/s], of D [m]
      type(integral_t), private :: push, drift, lag
      !> Whether the plate is frozen
      logical, private :: frozen = .false.
      !> Half the rise of alpha over the step if the step does not resolve alpha', otherwise 0
      !> [m/(N s)]; alpha' at nodes n - 1 and n - 2 [m/(N s2)]
      real(wp), private :: half_rise = 0.0_wp, rates(2) = 0.0_wp
      !> Exponent p of the rate of the drift, alpha' F ~ t^p near t = 0
      real(wp), private :: power = 0.0_wp
      !> Whether alpha' is finite at t = 0
      logical, private :: smooth = .false.
      !> Weights W_i of the memory of a hereditary plate
      type(convolution_t), private :: memory
      !> Force at the last node, with the dashpot's [N]
      real(wp), private :: last_force = 0.0_wp
      !> Differences from node to node that the memory weights multiply in U and in U': dJ [N s2]
      !> and dI [N s]
      real(wp), allocatable, private :: in_u(:), in_rate(:)
   contains
      procedure :: prepare
      procedure :: advance
      procedure :: respond
      procedure :: accept
   end type motion_t

contains

   !> Make room for `steps` steps and set the memory weights; steps already taken are kept
   subroutine prepare(self, impact, dt, steps)
      class(motion_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Number of steps
      integer, intent(in) :: steps

      self%dt = dt
      self%frozen = impact%plate%frozen()
      if (self%frozen) call find_power(impact, dt, self%power, self%smooth)
      if (.not. impact%plate%hereditary()) return
      call self%memory%set(memory_weights(impact%plate, dt, steps))
      call lengthen(self%in_u, 1, steps)
      call lengthen(self%in_rate, 1, steps)
   end subroutine prepare

   !> Advance to node n: choose the rule for the step and add to each integral all but the share of
   !> node n itself
   pure subroutine advance(self, impact, n, stiffness, viscosity)
      class(motion_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n
      !> dF/ds [N/m] and the dashpot's dF/ds' [N s/m], both at the last node
      real(wp), intent(in) :: stiffness, viscosity

      ! weights of the end of the step, its start and the node before
      real(wp), parameter :: adams_moulton(3) = [5.0_wp, 8.0_wp, -1.0_wp]/12.0_wp
      real(wp), parameter :: trapezoid(3) = [0.5_wp, 0.5_wp, 0.0_wp]
      real(wp) :: response, last_alpha, rise

      self%t = self%dt*real(n, wp)
      last_alpha = self%alpha
      self%rates = [self%alpha_rate, self%rates(1)]
      if (n == 1 .and. self%smooth) self%rates(1) = impact%plate%alpha_rate(0.0_wp)
      self%alpha = impact%plate%alpha(self%t)
      self%alpha_rate = impact%plate%alpha_rate(self%t, self%alpha)
      response = self%alpha + self%dt*self%memory%newest
      self%rule = self%dt*adams_moulton
      ! trapezoids damp at once what decays at the rate 2/dt, and what is faster better than the
      ! rule of Adams and Moulton, which is stable up to 6/dt
      if (n == 1 .or. self%dt*(response*stiffness + viscosity/impact%mass) > 2.0_wp) &
         self%rule = self%dt*trapezoid
      self%weight = self%rule(1)
      call go_on(self%force, self%rule)
      call go_on(self%whole, self%rule)
      if (.not. self%frozen) return
      self%drift_rule = self%rule
      if (n <= direct_near) self%drift_rule = self%dt*power_rule(n, self%power)
      self%half_rise = 0.0_wp
      rise = self%alpha - last_alpha
      if ((n > direct_near .or. self%smooth) .and. abs(rise &
          - sum(self%rule*[self%alpha_rate, self%rates])) > direct_unresolved*rise) then
         self%drift_rule = 0.0_wp
         self%half_rise = 0.5_wp*rise
      end if
      call go_on(self%push, self%rule)
      call go_on(self%drift, self%drift_rule)
      call go_on(self%lag, self%rule)
      self%drift%value = self%drift%value + self%half_rise*self%last_force
   end subroutine advance

   !> Set the motion at node n as a linear function of the force there
   pure subroutine respond(self, impact, n, dashpot)
      class(motion_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n
      !> Known part of a dashpot's impulse [N s]
      real(wp), intent(in) :: dashpot

      real(wp) :: i, j, weight, rate, plate, plate_velocity, per_force

      ! I and J without this node's force
      weight = self%weight
      i = self%force%value + dashpot
      j = self%whole%value + weight*i
      if (self%frozen) then
         plate = self%push%value - self%lag%value - weight*self%drift%value
         plate_velocity = -self%drift%value
         per_force = self%alpha - self%drift_rule(1)*self%alpha_rate - self%half_rise
         rate = 0.0_wp
      else
         plate = self%alpha*i
         plate_velocity = self%alpha_rate*i
         per_force = self%alpha
         rate = self%alpha_rate
      end if
      self%indentation(1) = impact%free_path(self%t) - j/impact%mass - plate
      self%indentation(2) = weight*(weight/impact%mass + per_force)
      self%velocity(1) = impact%free_velocity(self%t) - i/impact%mass - plate_velocity
      self%velocity(2) = weight/impact%mass + per_force + weight*rate
      if (self%memory%room == 0) return
      self%indentation(1) = self%indentation(1) &
         - self%memory%sum_over(n, 1, n - 1, self%in_u)
      self%velocity(1) = self%velocity(1) - self%memory%sum_over(n, 1, n - 1, self%in_rate)
      associate (newest => self%memory%newest)
         self%indentation = self%indentation &
            - newest*[j - self%second_impulse, -weight*weight]
         self%velocity = self%velocity - newest*[i - self%impulse, -weight]
      end associate
   end subroutine respond

   !> Complete all integrals with the force found at node n
   pure subroutine accept(self, n, force, dashpot, drag)
      class(motion_t), intent(inout) :: self
      !> Node
      integer, intent(in) :: n
      !> Force without a dashpot's [N]
      real(wp), intent(in) :: force
      !> Impulse of the dashpot [N s] and its force [N]
      real(wp), intent(in) :: dashpot, drag

      real(wp) :: impulse

      call complete(self%force, self%rule, force)
      impulse = self%force%value + dashpot
      call complete(self%whole, self%rule, impulse)
      if (self%memory%room > 0) then
         self%in_u(n) = self%whole%value - self%second_impulse
         self%in_rate(n) = impulse - self%impulse
      end if
      self%last_force = force + drag
      self%impulse = impulse
      self%second_impulse = self%whole%value
      if (.not. self%frozen) return
      call complete(self%push, self%rule, self%alpha*force)
      call complete(self%drift, self%drift_rule, self%alpha_rate*force)
      self%drift%value = self%drift%value + self%half_rise*force
      call complete(self%lag, self%rule, self%drift%value)
   end subroutine accept

   !> Extend an integral to the next node, without the share of that node
   pure subroutine go_on(integral, rule)
      type(integral_t), intent(inout) :: integral
      !> Rule for the step [s]
      real(wp), intent(in) :: rule(3)

      integral%value = integral%value + rule(2)*integral%last + rule(3)*integral%before
   end subroutine go_on

   !> Add the share of the newest node to an integral
   pure subroutine complete(integral, rule, integrand)
      type(integral_t), intent(inout) :: integral
      !> Rule for the step [s]
      real(wp), intent(in) :: rule(3)
      !> Integrand at the node
      real(wp), intent(in) :: integrand

      integral%value = integral%value + rule(1)*integrand
      integral%before = integral%last
      integral%last = integrand
   end subroutine complete

   !> Exponent p of the drift rate of a frozen plate, alpha' F ~ t^p near t = 0: alpha' can be
   !> infinite there if the spectrum is continuous, and F = int k u' ~ t^(n-1) int k
   pure subroutine find_power(impact, dt, power, smooth)
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Exponent p, from the ratio of values at 2 dt and dt
      real(wp), intent(out) :: power
      !> Whether alpha' is finite at t = 0; if so it is left out of p, as dt may not resolve it
      logical, intent(out) :: smooth

      ! a time of early*dt resolves alpha'; a ratio of alpha' above `one` counts as 1
      real(wp), parameter :: early = 1.0e-9_wp, one = 0.9999_wp

      ! before the first point of a table alpha' is 0
      smooth = ratio_of_rates(early*dt) > one &
         .or. .not. impact%plate%alpha_rate(early*dt) > 0.0_wp
      power = impact%kernel_integral(2.0_wp*dt)/impact%kernel_integral(dt)
      if (.not. smooth) power = power*ratio_of_rates(dt)
      power = impact%law%start_exponent - 1.0_wp + log(max(power, 0.5_wp))/log(2.0_wp)

   contains

      !> Ratio alpha'(2 t)/alpha'(t)
      pure real(wp) function ratio_of_rates(t)
         real(wp), intent(in) :: t

         ratio_of_rates = impact%plate%alpha_rate(2.0_wp*t) &
            /max(impact%plate%alpha_rate(t), tiny(1.0_wp))
      end function ratio_of_rates
   end subroutine find_power

   !> Weights of the end of step n, its start and the node before, for an integral over the step;
   !> exact for t^power times a constant on step 1, a linear function on step 2, then a parabola
   pure function power_rule(n, power) result(rule)
      !> Step, >= 1
      integer, intent(in) :: n
      !> Exponent of t, > -1
      real(wp), intent(in) :: power
      !> Weights, in units of the step
      real(wp) :: rule(3)

      real(wp) :: moment(0:2), x
      integer :: k

      ! moments of (t - n)^k t^power over the step, t in steps: first of t^k t^power, then shifted
      x = real(n, wp)
      do k = 0, 2
         moment(k) = (x**(power + real(k + 1, wp)) - (x - 1.0_wp)**(power + real(k + 1, wp))) &
            /(power + real(k + 1, wp))
      end do
      moment(2) = moment(2) - 2.0_wp*x*moment(1) + x*x*moment(0)
      moment(1) = moment(1) - x*moment(0)
      rule = 0.0_wp
      select case (n)
      case (1)
         rule(1) = moment(0)
      case (2)
         rule(1:2) = [moment(0) + moment(1), -moment(1)]
      case default
         rule = [moment(0) + 1.5_wp*moment(1) + 0.5_wp*moment(2), -2.0_wp*moment(1) - moment(2), &
            0.5_wp*(moment(1) + moment(2))]
         rule(3) = rule(3)/(x - 2.0_wp)**power
      end select
      rule(1) = rule(1)/x**power
      if (n > 1) rule(2) = rule(2)/(x - 1.0_wp)**power
   end function power_rule

end module vcor_solver_direct_motion
