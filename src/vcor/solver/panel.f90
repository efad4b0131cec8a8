!> One panel of the internal-variable method: Radau IIA collocation of the twice-integrated
!> equation of motion with the internal variables eliminated
!>
!> For F = G_0 u + sum_k G_k (u - q_k) + eta u' with q_k' = l_k (u - q_k), the stage values of q_k
!> follow from those of u: u - q = (1 + l_k H)^-1 (u - q_n) with H = scale*B the integration matrix
!> of the panel. Hence F = S u - b, with the matrix and the vector
!>
!>     S = G_0 + sum_k G_k (1 + l_k H)^-1 + eta H^-1,
!>     b = sum_k G_k q_k,n (1 + l_k H)^-1 1 + eta u_n H^-1 1,
!>
!> functions of H, known through its eigenvalues: `stiffness` and `memory` below are S and b there.
!> What is left is s = v0 t - J/m - alpha I with I = I_n + H F and J = J_n + H I, one nonlinear
!> system for the stage values of s, whatever the number of internal variables.
module vcor_solver_panel
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, max_stages, panel_map_t
   use vcor_numeric_linear, only : solve_linear
   implicit none
   private

   public :: panel_t, start_t
   public :: solve_panel, advance_modes, hertz

   !> State at the start of a panel
   type :: start_t
      !> Time [s]
      real(wp) :: time = 0.0_wp
      !> Indentation s [m]
      real(wp) :: indentation = 0.0_wp
      !> Force F [N]
      real(wp) :: force = 0.0_wp
      !> Impulse I [N s]
      real(wp) :: impulse = 0.0_wp
      !> Integral of the impulse J [N s2]
      real(wp) :: second_impulse = 0.0_wp
      !> Internal variables q_k [m^1.5], shape (modes)
      real(wp), allocatable :: q(:)
   end type start_t

   !> Solution on a panel; index 0 is its start
   type :: panel_t
      !> Number of stages
      integer :: stages = 0
      !> Time in the panel: start + map(1) theta + map(2) theta^2 [s]
      real(wp) :: map(2) = 0.0_wp
      !> Times of the stages [s]
      real(wp) :: time(0:max_stages) = 0.0_wp
      !> Indentation [m]
      real(wp) :: indentation(0:max_stages) = 0.0_wp
      !> Force [N]
      real(wp) :: force(0:max_stages) = 0.0_wp
      !> Impulse [N s]
      real(wp) :: impulse(0:max_stages) = 0.0_wp
      !> Integral of the impulse [N s2]
      real(wp) :: second_impulse(0:max_stages) = 0.0_wp
      !> Plate parameter alpha [m/(N s)]
      real(wp) :: alpha(0:max_stages) = 0.0_wp
      !> Change of the force per change of u at the last stage alone [N/m^1.5]
      real(wp) :: end_stiffness = 0.0_wp
      !> Whether Newton's iteration converged
      logical :: converged = .false.
   contains
      !> Position of a time in the panel
      procedure :: theta
   end type panel_t

contains

   !> Hertz's u = s^1.5, continued oddly: past the end of an elastic contact s is negative, and
   !> the force with it
   elemental function hertz(s) result(u)
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> u [m^1.5]
      real(wp) :: u

      u = s*sqrt(abs(s))
   end function hertz

   !> Position of a time in the panel: the root of the quadratic map in its stable form
   pure function theta(self, time)
      !> The panel
      class(panel_t), intent(in) :: self
      !> Time [s], not before the panel's start
      real(wp), intent(in) :: time
      !> Position, 0 at the start and 1 at the end
      real(wp) :: theta

      real(wp) :: offset

      theta = 0.0_wp
      offset = time - self%time(0)
      if (offset > 0.0_wp) theta = 2.0_wp*offset/(self%map(1) &
         + sqrt(self%map(1)**2 + 4.0_wp*self%map(2)*offset))
   end function theta

   !> Solve the collocation equations on a panel by Newton's method
   pure subroutine solve_panel(rule, map, scale, impact, kernel, start, panel, tolerance)
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
      !> State at the start
      type(start_t), intent(in) :: start
      !> The panel; on entry `indentation` holds a guess at the stages
      type(panel_t), intent(inout) :: panel
      !> Newton's iteration ends with the first correction below this part of the largest
      !> indentation; as it converges quadratically, what is left is of the order of its square
      real(wp), intent(in) :: tolerance

      integer, parameter :: most_iterations = 25
      complex(wp), dimension(map%pairs) :: lambda, stiffness, memory, first, second
      real(wp), dimension(rule%stages) :: s, u, right, alpha, slope, correction, residual
      real(wp), dimension(rule%stages) :: time, force, impulse, second_impulse
      real(wp) :: response(rule%stages, rule%stages), jacobian(rule%stages, rule%stages)
      real(wp) :: w_re, w_im
      integer :: n, i, j, m, iteration
      logical :: regular

      n = rule%stages
      panel%stages = n
      panel%map = scale*[map%slope, map%bend]
      time = start%time + rule%node*(panel%map(1) + panel%map(2)*rule%node)
      alpha = impact%plate%alpha(time)
      lambda = scale*map%eigenvalue
      call resolve_modes(kernel, start, lambda, stiffness, memory)
      memory = memory*map%left_one

      ! response = (H^2/m + alpha H) S, right = v0 t - (J_n + H I_n)/m - alpha I_n + (..) b
      first = lambda**2/impact%mass
      right = impact%velocity*time &
         - (start%second_impulse + start%impulse*(time - start%time))/impact%mass &
         - alpha*start%impulse
      response = 0.0_wp
      do m = 1, map%pairs
         second(m) = first(m)*memory(m)
         do i = 1, n
            w_re = real(second(m), wp) + alpha(i)*real(lambda(m)*memory(m), wp)
            w_im = aimag(second(m)) + alpha(i)*aimag(lambda(m)*memory(m))
            right(i) = right(i) + map%right_re(i, m)*w_re - map%right_im(i, m)*w_im
         end do
         second(m) = lambda(m)*stiffness(m)
         first(m) = first(m)*stiffness(m)
         do i = 1, n
            w_re = real(first(m), wp) + alpha(i)*real(second(m), wp)
            w_im = aimag(first(m)) + alpha(i)*aimag(second(m))
            slope(i) = map%right_re(i, m)*w_re - map%right_im(i, m)*w_im
            correction(i) = map%right_re(i, m)*w_im + map%right_im(i, m)*w_re
         end do
         do j = 1, n
            response(:, j) = response(:, j) + slope*map%left_re(m, j) - correction*map%left_im(m, j)
         end do
      end do

      s = panel%indentation(1:n)
      panel%converged = .false.
      do iteration = 1, most_iterations
         slope = sqrt(abs(s))
         u = s*slope
         slope = 1.5_wp*slope
         residual = right - s
         do j = 1, n
            residual = residual - response(:, j)*u(j)
            jacobian(:, j) = response(:, j)*slope(j)
            jacobian(j, j) = jacobian(j, j) + 1.0_wp
         end do
         call solve_linear(jacobian, residual, regular)
         if (.not. regular) return
         s = s + residual
         if (maxval(abs(residual)) <= tolerance*maxval(abs(s))) then
            panel%converged = .true.
            exit
         end if
      end do

      u = hertz(s)
      force = 0.0_wp
      impulse = start%impulse
      second_impulse = start%second_impulse + start%impulse*(time - start%time)
      panel%end_stiffness = 0.0_wp
      do m = 1, map%pairs
         first(m) = stiffness(m)*cmplx(sum(map%left_re(m, :)*u), sum(map%left_im(m, :)*u), wp) &
            - memory(m)
         second(m) = lambda(m)*first(m)
         force = force + map%right_re(:, m)*real(first(m), wp) - map%right_im(:, m)*aimag(first(m))
         impulse = impulse + map%right_re(:, m)*real(second(m), wp) &
            - map%right_im(:, m)*aimag(second(m))
         second(m) = lambda(m)*second(m)
         second_impulse = second_impulse + map%right_re(:, m)*real(second(m), wp) &
            - map%right_im(:, m)*aimag(second(m))
         panel%end_stiffness = panel%end_stiffness + real(cmplx(map%right_re(n, m), &
            map%right_im(n, m), wp)*stiffness(m)*cmplx(map%left_re(m, n), map%left_im(m, n), wp), wp)
      end do

      panel%time(0) = start%time
      panel%time(1:n) = time
      panel%indentation(0) = start%indentation
      panel%indentation(1:n) = s
      panel%force(0) = start%force
      panel%force(1:n) = force
      panel%impulse(0) = start%impulse
      panel%impulse(1:n) = impulse
      panel%second_impulse(0) = start%second_impulse
      panel%second_impulse(1:n) = second_impulse
      panel%alpha(1:n) = alpha
   end subroutine solve_panel

   !> S and b as functions of an eigenvalue of H
   pure subroutine resolve_modes(kernel, start, lambda, stiffness, memory)
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> Eigenvalues of H [s], shape (pairs)
      complex(wp), intent(in) :: lambda(:)
      !> S [N/m^1.5], shape (pairs)
      complex(wp), intent(out) :: stiffness(:)
      !> b without the vector of ones [N], shape (pairs)
      complex(wp), intent(out) :: memory(:)

      real(wp) :: x, y, a, d, stiffness_re, stiffness_im, memory_re, memory_im
      integer :: m, k

      do m = 1, size(lambda)
         x = real(lambda(m), wp)
         y = aimag(lambda(m))
         stiffness_re = 0.0_wp
         stiffness_im = 0.0_wp
         memory_re = 0.0_wp
         memory_im = 0.0_wp
         do k = 1, size(kernel%rates)
            ! G/(1 + l lambda)
            a = 1.0_wp + kernel%rates(k)*x
            d = kernel%rates(k)*y
            a = kernel%moduli(k)/(a*a + d*d)
            d = -d*a
            a = a + kernel%rates(k)*x*a
            stiffness_re = stiffness_re + a
            stiffness_im = stiffness_im + d
            memory_re = memory_re + a*start%q(k)
            memory_im = memory_im + d*start%q(k)
         end do
         stiffness(m) = cmplx(kernel%equilibrium + stiffness_re, stiffness_im, wp)
         memory(m) = cmplx(memory_re, memory_im, wp)
         if (kernel%viscosity > 0.0_wp) then
            stiffness(m) = stiffness(m) + kernel%viscosity/lambda(m)
            memory(m) = memory(m) + kernel%viscosity*hertz(start%indentation)/lambda(m)
         end if
      end do
   end subroutine resolve_modes

   !> Internal variables at the end of a panel: q = u - (1 + l H)^-1 (u - q_n) at the last stage
   pure subroutine advance_modes(rule, map, scale, kernel, panel, q)
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> The solved panel
      type(panel_t), intent(in) :: panel
      !> Internal variables: at the start on entry, at the end on return [m^1.5], shape (modes)
      real(wp), intent(inout) :: q(:)

      complex(wp), dimension(map%pairs) :: from_u, from_q
      real(wp) :: u(rule%stages), lag(size(q)), x, y, a, d
      integer :: n, m, k

      n = rule%stages
      u = hertz(panel%indentation(1:n))
      lag = 0.0_wp
      do m = 1, map%pairs
         from_q(m) = cmplx(map%right_re(n, m), map%right_im(n, m), wp)
         from_u(m) = from_q(m)*cmplx(sum(map%left_re(m, :)*u), sum(map%left_im(m, :)*u), wp)
         from_q(m) = from_q(m)*map%left_one(m)
         x = scale*real(map%eigenvalue(m), wp)
         y = scale*aimag(map%eigenvalue(m))
         do k = 1, size(q)
            a = 1.0_wp + kernel%rates(k)*x
            d = kernel%rates(k)*y
            lag(k) = lag(k) + ((real(from_u(m), wp) - q(k)*real(from_q(m), wp))*a &
               + (aimag(from_u(m)) - q(k)*aimag(from_q(m)))*d)/(a*a + d*d)
         end do
      end do
      q = u(n) - lag
   end subroutine advance_modes

end module vcor_solver_panel
