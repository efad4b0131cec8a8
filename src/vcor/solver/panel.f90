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
   use vcor_impact_problem, only : hertz, impact_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, panel_map_t, width
   use vcor_numeric_linear, only : solve_linear
   implicit none
   private

   public :: panel_t, start_t
   public :: solve_panel, resolve_modes, advance_modes

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
      !> Deflection U of a frozen plate [m]
      real(wp) :: deflection = 0.0_wp
      !> What the velocity of a frozen plate falls behind alpha F [m/s]
      real(wp) :: drift = 0.0_wp
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
      !> Deflection U of a frozen plate [m]
      real(wp) :: deflection(0:width) = 0.0_wp
      !> What the velocity of a frozen plate falls behind alpha F [m/s]
      real(wp) :: drift(0:width) = 0.0_wp
      !> Change of the force but the dashpot's per change of u at the last stage alone [N/m^1.5]
      real(wp) :: end_stiffness = 0.0_wp
      !> Whether Newton's iteration converged
      logical :: converged = .false.
   contains
      !> Position of a time in the panel
      procedure :: theta
   end type panel_t

contains

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
      complex(wp), dimension(width) :: lambda, stiffness, memory, spectrum
      real(wp), dimension(width) :: s, u, time, alpha, right, slope, change, re, im
      real(wp) :: response(width, width), jacobian(width, width)
      complex(wp) :: first, second
      integer :: n, j, m, iteration
      logical :: regular

      n = rule%stages
      panel%stages = n
      panel%map = scale*[map%slope, map%bend]
      time = start%time + rule%node*(panel%map(1) + panel%map(2)*rule%node)
      alpha = 0.0_wp
      alpha(1:n) = impact%plate%alpha(time(1:n))
      lambda = scale*map%eigenvalue
      call resolve_modes(kernel, start, lambda(1:map%pairs), stiffness, memory)
      memory = memory*map%left_one

      ! With f(H) = V f(lambda) V^-1:
      ! right = v0 t - (J_n + H I_n)/m - alpha I_n + (H^2/m + alpha H) b
      ! response = (H^2/m + alpha H) S
      right = impact%velocity*time &
         - (start%second_impulse + start%impulse*(time - start%time))/impact%mass &
         - alpha*start%impulse
      response = 0.0_wp
      do m = 1, map%pairs
         first = lambda(m)**2*memory(m)/impact%mass
         second = lambda(m)*memory(m)
         re = real(first, wp) + alpha*real(second, wp)
         im = aimag(first) + alpha*aimag(second)
         right = right + map%right_re(:, m)*re - map%right_im(:, m)*im
         first = lambda(m)**2*stiffness(m)/impact%mass
         second = lambda(m)*stiffness(m)
         slope = real(first, wp) + alpha*real(second, wp)
         change = aimag(first) + alpha*aimag(second)
         re = map%right_re(:, m)*slope - map%right_im(:, m)*change
         im = map%right_re(:, m)*change + map%right_im(:, m)*slope
         do j = 1, width
            response(:, j) = response(:, j) + re*map%left_re(j, m) - im*map%left_im(j, m)
         end do
      end do

      s = 0.0_wp
      s(1:n) = panel%indentation(1:n)
      right(n + 1:) = 0.0_wp
      panel%converged = .false.
      do iteration = 1, most_iterations
         slope = sqrt(abs(s))
         u = s*slope
         slope = 1.5_wp*slope
         change = right - s
         do j = 1, width
            change = change - response(:, j)*u(j)
            jacobian(:, j) = response(:, j)*slope(j)
            jacobian(j, j) = jacobian(j, j) + 1.0_wp
         end do
         call solve_linear(jacobian, change, regular)
         if (.not. regular) return
         s = s + change
         panel%converged = maxval(abs(change)) <= tolerance*maxval(abs(s))
         if (panel%converged) exit
      end do

      ! F = S u - b, I = I_n + H F, J = J_n + H I
      u = hertz(s)
      do m = 1, map%pairs
         first = cmplx(sum(map%left_re(:, m)*u), sum(map%left_im(:, m)*u), wp)
         spectrum(m) = stiffness(m)*first - memory(m)
      end do
      panel%time(0) = start%time
      panel%indentation(0) = start%indentation
      panel%force(0) = start%force
      panel%impulse(0) = start%impulse
      panel%second_impulse(0) = start%second_impulse
      panel%time(1:) = time
      panel%indentation(1:) = s
      panel%alpha(1:) = alpha
      panel%force(1:) = 0.0_wp
      panel%impulse(1:) = start%impulse
      panel%second_impulse(1:) = start%second_impulse + start%impulse*(time - start%time)
      panel%end_stiffness = 0.0_wp
      do m = 1, map%pairs
         re = map%right_re(:, m)
         im = map%right_im(:, m)
         first = spectrum(m)
         panel%force(1:) = panel%force(1:) + re*real(first, wp) - im*aimag(first)
         first = lambda(m)*first
         panel%impulse(1:) = panel%impulse(1:) + re*real(first, wp) - im*aimag(first)
         first = lambda(m)*first
         panel%second_impulse(1:) = panel%second_impulse(1:) + re*real(first, wp) - im*aimag(first)
         first = (stiffness(m) - kernel%viscosity/lambda(m)) &
            *cmplx(map%left_re(n, m), map%left_im(n, m), wp)
         panel%end_stiffness = panel%end_stiffness + re(n)*real(first, wp) - im(n)*aimag(first)
      end do
   end subroutine solve_panel

   !> S and b as functions of an eigenvalue of H
   pure subroutine resolve_modes(kernel, start, lambda, stiffness, memory)
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> State at the start of the panel
      type(start_t), intent(in) :: start
      !> Eigenvalues of H [s], shape (pairs)
      complex(wp), intent(in) :: lambda(:)
      !> S [N/m^1.5], shape (pairs), zero beyond
      complex(wp), intent(out) :: stiffness(width)
      !> b without the vector of ones [N], shape (pairs), zero beyond
      complex(wp), intent(out) :: memory(width)

      real(wp) :: x, y, a, d, stiffness_re, stiffness_im, memory_re, memory_im
      integer :: m, k

      stiffness = (0.0_wp, 0.0_wp)
      memory = (0.0_wp, 0.0_wp)
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

      complex(wp) :: from_u, from_q
      real(wp) :: u(width), lag(size(q)), x, y, a, d
      integer :: n, m, k

      n = rule%stages
      u = hertz(panel%indentation(1:))
      lag = 0.0_wp
      do m = 1, map%pairs
         from_q = cmplx(map%right_re(n, m), map%right_im(n, m), wp)
         from_u = from_q*cmplx(sum(map%left_re(:, m)*u), sum(map%left_im(:, m)*u), wp)
         from_q = from_q*map%left_one(m)
         x = scale*real(map%eigenvalue(m), wp)
         y = scale*aimag(map%eigenvalue(m))
         do k = 1, size(q)
            a = 1.0_wp + kernel%rates(k)*x
            d = kernel%rates(k)*y
            lag(k) = lag(k) + ((real(from_u, wp) - q(k)*real(from_q, wp))*a &
               + (aimag(from_u) - q(k)*aimag(from_q))*d)/(a*a + d*d)
         end do
      end do
      q = u(n) - lag
   end subroutine advance_modes

end module vcor_solver_panel
