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
   use vcor_numeric_linear, only : apply
   use vcor_solver_modes, only : resolve_modes, start_t
   use vcor_solver_newton, only : most_iterations, newton_t
   implicit none
   private

   public :: panel_t
   public :: solve_panel

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
         + sqrt(max(0.0_wp, self%map(1)**2 + 4.0_wp*self%map(2)*offset)))
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
      !> Wanted error of the indentation over its largest value
      real(wp), intent(in) :: tolerance

      complex(wp), dimension(width) :: lambda, stiffness, memory
      real(wp), dimension(width) :: s, u, root, elapsed, alpha, right, change
      real(wp) :: response(width, width)
      type(newton_t) :: newton
      integer :: n, i, j, iteration

      n = rule%stages
      panel%stages = n
      panel%map = scale*[map%slope, map%bend]
      elapsed = rule%node*(panel%map(1) + panel%map(2)*rule%node)
      panel%time(0) = start%time
      panel%time(1:) = start%time + elapsed
      alpha = 0.0_wp
      do i = 1, n
         alpha(i) = impact%plate%alpha(panel%time(i))
      end do
      lambda = scale*map%eigenvalue
      call resolve_modes(kernel, start, lambda(1:map%pairs), stiffness, memory)
      memory = memory*map%left_one
      call assemble(map, lambda, stiffness, memory, alpha, 1.0_wp/impact%mass, right, response)
      right = right + impact%velocity*panel%time(1:) &
         - (start%second_impulse + start%impulse*elapsed)/impact%mass - alpha*start%impulse

      s = 0.0_wp
      s(1:n) = panel%indentation(1:n)
      right(n + 1:) = 0.0_wp
      do iteration = 1, most_iterations
         root = sqrt(abs(s))
         u = s*root
         change = right - s - apply(response, u)
         if (newton%stale) then
            root = 1.5_wp*root
            do j = 1, width
               do i = 1, width
                  newton%jacobian%matrix(i, j) = response(i, j)*root(j)
               end do
               newton%jacobian%matrix(j, j) = newton%jacobian%matrix(j, j) + 1.0_wp
            end do
         end if
         call newton%correct(change, s, tolerance)
         if (newton%converged .or. newton%failed) exit
      end do
      panel%converged = newton%converged
      if (.not. panel%converged) return

      panel%indentation(0) = start%indentation
      panel%indentation(1:) = s
      panel%alpha(1:) = alpha
      panel%force(0) = start%force
      panel%impulse(0) = start%impulse
      panel%impulse(1:) = start%impulse
      panel%second_impulse(0) = start%second_impulse
      panel%second_impulse(1:) = start%second_impulse + start%impulse*elapsed
      call integrate(map, lambda, stiffness, memory, hertz(s), panel)
   end subroutine solve_panel

   !> With f(H) = V f(lambda) V^-1:
   !> right = (H^2/m + alpha H) b,  response = (H^2/m + alpha H) S
   pure subroutine assemble(map, lambda, stiffness, memory, alpha, inverse_mass, right, response)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Eigenvalues of H [s]
      complex(wp), intent(in) :: lambda(width)
      !> S [N/m^1.5]
      complex(wp), intent(in) :: stiffness(width)
      !> V^-1 b [N]
      complex(wp), intent(in) :: memory(width)
      !> Plate parameter at the stages [m/(N s)]
      real(wp), intent(in) :: alpha(width)
      !> 1/m [1/kg]
      real(wp), intent(in) :: inverse_mass
      !> Share of the memory in the indentation [m]
      real(wp), intent(out) :: right(width)
      !> Indentation that is missing per u at the stages [m^-0.5]
      real(wp), intent(out) :: response(width, width)

      real(wp) :: column(width), re(width, width), im(width, width)
      real(wp) :: x, y, c_re, c_im, d_re, d_im, f, g
      complex(wp) :: first
      integer :: i, j, m

      right = 0.0_wp
      do m = 1, map%pairs
         first = lambda(m)*stiffness(m)
         c_re = real(first, wp)
         c_im = aimag(first)
         first = inverse_mass*lambda(m)*first
         d_re = real(first, wp)
         d_im = aimag(first)
         first = lambda(m)*memory(m)
         x = real(first, wp)
         y = aimag(first)
         first = inverse_mass*lambda(m)*first
         do i = 1, width
            f = real(first, wp) + alpha(i)*x
            g = aimag(first) + alpha(i)*y
            right(i) = right(i) + map%right_re(i, m)*f - map%right_im(i, m)*g
            f = d_re + alpha(i)*c_re
            g = d_im + alpha(i)*c_im
            re(i, m) = map%right_re(i, m)*f - map%right_im(i, m)*g
            im(i, m) = map%right_re(i, m)*g + map%right_im(i, m)*f
         end do
      end do
      do j = 1, width
         column = 0.0_wp
         do m = 1, map%pairs
            x = map%left_re(j, m)
            y = map%left_im(j, m)
            do i = 1, width
               column(i) = column(i) + re(i, m)*x - im(i, m)*y
            end do
         end do
         response(:, j) = column
      end do
   end subroutine assemble

   !> F = S u - b and its integrals I = I_n + H F, J = J_n + H I_n + H^2 F
   pure subroutine integrate(map, lambda, stiffness, memory, u, panel)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Eigenvalues of H [s]
      complex(wp), intent(in) :: lambda(width)
      !> S [N/m^1.5]
      complex(wp), intent(in) :: stiffness(width)
      !> V^-1 b [N]
      complex(wp), intent(in) :: memory(width)
      !> u at the stages [m^1.5]
      real(wp), intent(in) :: u(width)
      !> The panel; on entry impulse and second impulse as they would be without a force
      type(panel_t), intent(inout) :: panel

      complex(wp) :: force, impulse, second
      real(wp) :: x, y
      integer :: i, j, m

      panel%force(1:) = 0.0_wp
      do m = 1, map%pairs
         x = 0.0_wp
         y = 0.0_wp
         do j = 1, width
            x = x + map%left_re(j, m)*u(j)
            y = y + map%left_im(j, m)*u(j)
         end do
         force = stiffness(m)*cmplx(x, y, wp) - memory(m)
         impulse = lambda(m)*force
         second = lambda(m)*impulse
         do i = 1, width
            x = map%right_re(i, m)
            y = map%right_im(i, m)
            panel%force(i) = panel%force(i) + x*real(force, wp) - y*aimag(force)
            panel%impulse(i) = panel%impulse(i) + x*real(impulse, wp) - y*aimag(impulse)
            panel%second_impulse(i) = panel%second_impulse(i) + x*real(second, wp) &
               - y*aimag(second)
         end do
      end do
   end subroutine integrate

end module vcor_solver_panel
