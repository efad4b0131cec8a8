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
!> exactly, like the kernel of the contact, and so is alpha' of the frozen plate: it may be infinite
!> at t = 0 or be over within a part of a step, while F is a power of t times a parabola. A
!> dashpot's impulse is exactly viscosity*u, so its force is not integrated; beside a frozen plate
!> there is none.
module vcor_solver_direct_motion
   use vcor_impact_target, only : target_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_quadrature, only : endpoint_rule, gauss_nodes
   use vcor_solver_convolution, only : convolution_t, lengthen
   use vcor_solver_direct_weights, only : memory_weights, start_force
   implicit none
   private

   public :: node_motion_t

   !> Integral over time up to a node, with the integrand at that node and the one before
   type :: integral_t
      !> Value of the integral
      real(wp) :: value = 0.0_wp
      !> Integrand at the last node and at the one before
      real(wp) :: last = 0.0_wp, before = 0.0_wp
   end type integral_t

   !> Motion of both bodies at the node being solved
   type :: node_motion_t
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
      !> Weights of the force at the same nodes in the drift D over the step [m/(N s)]
      real(wp), private :: drift_rule(3) = 0.0_wp
      !> Rate alpha' [m/(N s2)], 0 for a frozen plate
      real(wp), private :: alpha_rate = 0.0_wp
      !> Integral of the force without a dashpot's [N s], and of the whole impulse [N s2]
      type(integral_t), private :: force, whole
      !> Integrals for a frozen plate: of alpha F [m], of F over alpha (the drift D) [m/s], of D [m]
      type(integral_t), private :: push, drift, lag
      !> Whether the plate is frozen
      logical, private :: frozen = .false.
      !> For a frozen plate, exponent p of the force near t = 0, F ~ t^p, and nodes and weights of
      !> Gauss on a step
      real(wp), private :: power = 0.0_wp, node(4) = 0.0_wp, share(4) = 0.0_wp
      !> Weights W_i of the memory of a hereditary plate
      type(convolution_t), private :: memory
      !> Differences from node to node that the memory weights multiply in U and in U': dJ [N s2]
      !> and dI [N s]
      real(wp), allocatable, private :: in_u(:), in_rate(:)
   contains
      procedure :: prepare
      procedure :: advance
      procedure :: respond
      procedure :: accept
   end type node_motion_t

contains

   !> Make room for `steps` steps and set the memory weights; steps already taken are kept
   subroutine prepare(self, impact, dt, steps)
      class(node_motion_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Number of steps
      integer, intent(in) :: steps

      real(wp) :: force(2)

      self%dt = dt
      self%frozen = impact%target%frozen()
      if (self%frozen) then
         force = start_force(impact, dt, [1.0_wp, 2.0_wp])
         self%power = log(force(2)/force(1))/log(2.0_wp)
         call gauss_nodes(self%node, self%share)
      end if
      if (.not. impact%target%hereditary()) return
      call self%memory%set(memory_weights(impact%target, dt, steps))
      call lengthen(self%in_u, 1, steps)
      call lengthen(self%in_rate, 1, steps)
   end subroutine prepare

   !> Advance to node n: choose the rule for the step and add to each integral all but the share of
   !> node n itself
   pure subroutine advance(self, impact, n, stiffness, viscosity)
      class(node_motion_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n
      !> dF/ds [N/m] and the dashpot's dF/ds' [N s/m], both at the last node
      real(wp), intent(in) :: stiffness, viscosity

      ! weights of the end of the step, its start and the node before
      real(wp), parameter :: adams_moulton(3) = [5.0_wp, 8.0_wp, -1.0_wp]/12.0_wp
      real(wp), parameter :: trapezoid(3) = [0.5_wp, 0.5_wp, 0.0_wp]
      real(wp) :: response, last_alpha
      logical :: stiff

      self%t = self%dt*real(n, wp)
      last_alpha = self%alpha
      self%alpha = impact%target%alpha(self%t)
      if (.not. self%frozen) self%alpha_rate = impact%target%alpha_rate(self%t, self%alpha)
      response = self%alpha + self%dt*self%memory%newest
      self%rule = self%dt*adams_moulton
      ! trapezoids damp at once what decays at the rate 2/dt, and what is faster better than the
      ! rule of Adams and Moulton, which is stable up to 6/dt
      stiff = self%dt*(response*stiffness + viscosity/impact%mass) > 2.0_wp
      if (n == 1 .or. stiff) self%rule = self%dt*trapezoid
      self%weight = self%rule(1)
      call go_on(self%force, self%rule)
      call go_on(self%whole, self%rule)
      if (.not. self%frozen) return
      if (n == 1) then
         self%drift_rule = [first_drift(impact, self%dt), 0.0_wp, 0.0_wp]
      else
         self%drift_rule = rule_of_drift(self, impact%target, n, last_alpha, stiff .or. n == 2)
      end if
      call go_on(self%push, self%rule)
      call go_on(self%drift, self%drift_rule)
      call go_on(self%lag, self%rule)
   end subroutine advance

   !> Set the motion at node n as a linear function of the force there
   pure subroutine respond(self, impact, n, dashpot)
      class(node_motion_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      !> Node
      integer, intent(in) :: n
      !> Known part of a dashpot's impulse [N s]
      real(wp), intent(in) :: dashpot

      real(wp) :: i, j, weight, plate, plate_velocity, per_force

      ! I and J without this node's force
      weight = self%weight
      i = self%force%value + dashpot
      j = self%whole%value + weight*i
      if (self%frozen) then
         plate = self%push%value - self%lag%value - weight*self%drift%value
         plate_velocity = -self%drift%value
         per_force = self%alpha - self%drift_rule(1)
      else
         plate = self%alpha*i
         plate_velocity = self%alpha_rate*i
         per_force = self%alpha
      end if
      self%indentation(1) = impact%free_path(self%t) - j/impact%mass - plate
      self%indentation(2) = weight*(weight/impact%mass + per_force)
      self%velocity(1) = impact%free_velocity(self%t) - i/impact%mass - plate_velocity
      self%velocity(2) = weight/impact%mass + per_force + weight*self%alpha_rate
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
   pure subroutine accept(self, n, force, dashpot)
      class(node_motion_t), intent(inout) :: self
      !> Node
      integer, intent(in) :: n
      !> Force without a dashpot's [N]
      real(wp), intent(in) :: force
      !> Impulse of the dashpot [N s]
      real(wp), intent(in) :: dashpot

      real(wp) :: impulse

      call complete(self%force, self%rule, force)
      impulse = self%force%value + dashpot
      call complete(self%whole, self%rule, impulse)
      if (self%memory%room > 0) then
         self%in_u(n) = self%whole%value - self%second_impulse
         self%in_rate(n) = impulse - self%impulse
      end if
      self%impulse = impulse
      self%second_impulse = self%whole%value
      if (.not. self%frozen) return
      call complete(self%push, self%rule, self%alpha*force)
      call complete(self%drift, self%drift_rule, force)
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

   !> Weight of F at the end of the first step in int alpha' F over it, from the force soon after
   !> first contact: a relaxation that is over within a part of the step may have moved the plate
   pure function first_drift(impact, dt) result(weight)
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Weight [m/(N s)]
      real(wp) :: weight

      real(wp), allocatable :: node(:), share(:)

      call endpoint_rule(node, share)
      weight = dt*sum(share*impact%target%alpha_rate(dt*node)*start_force(impact, dt, node)) &
         /sum(start_force(impact, dt, [1.0_wp]))
   end function first_drift

   !> Weights of F at the end of step n, its start and the node before in int alpha' F over the
   !> step, with F = t^power times the parabola, or the line, through these nodes. By parts it is
   !> [(alpha - alpha_start) F] - int (alpha - alpha_start) F', also where alpha' is not resolved
   pure function rule_of_drift(self, plate, n, start, linear) result(rule)
      !> The motion, with alpha at the end of the step
      type(node_motion_t), intent(in) :: self
      type(target_t), intent(in) :: plate
      !> Step, >= 2
      integer, intent(in) :: n
      !> alpha at its start [m/(N s)]
      real(wp), intent(in) :: start
      !> Whether it is the line
      logical, intent(in) :: linear
      !> Weights [m/(N s)]
      real(wp) :: rule(3)

      real(wp) :: base(3), slope(3), integral(3), t
      integer :: i

      integral = 0.0_wp
      do i = 1, size(self%node)
         associate (x => self%node(i))
            t = real(n - 1, wp) + x
            if (linear) then
               base = [x, 1.0_wp - x, 0.0_wp]
               slope = [1.0_wp, -1.0_wp, 0.0_wp]
            else
               base = [0.5_wp*x*(1.0_wp + x), (1.0_wp - x)*(1.0_wp + x), -0.5_wp*x*(1.0_wp - x)]
               slope = [0.5_wp + x, -2.0_wp*x, x - 0.5_wp]
            end if
         end associate
         integral = integral + self%share(i)*(plate%alpha(self%dt*t) - start)*t**self%power &
            *(slope + self%power*base/t)
      end do
      rule = -integral/real(max(1, [n, n - 1, n - 2]), wp)**self%power
      rule(1) = rule(1) + (self%alpha - start)
   end function rule_of_drift

end module vcor_solver_direct_motion
