!> One panel of the internal-variable method where the plain one does not do: with the second term
!> of the Volterra series, whose force is quadratic in the internal variables, or with the frozen
!> plate, whose deflection is no function of the integration matrix alone
!>
!> As in `vcor_solver_panel`, u - q_k = Z_k (u - q_k,n) with Z_k = (1 + l_k H)^-1, but the matrices
!> are formed. With p_k = u - q_k and the constant c2 of the second term,
!>
!>     F = G_0 u + sum_k G_k p_k + c2 (G_0 u^2 + sum_k G_k p_k^2)
!>
!> since int int k(x + y) u'(t - x) u'(t - y) dx dy = G_0 u^2 + sum_k G_k p_k^2, Eq. (10). The
!> frozen plate has U' = int alpha F' dt = alpha F - Z with Z' = alpha' F, hence
!> U = U_n - Z_n (t - t_n) + H alpha F - H^2 alpha' F.
module vcor_solver_general_panel
   use vcor_impact_problem, only : hertz, impact_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, panel_map_t, width
   use vcor_numeric_linear, only : apply
   use vcor_numeric_pairs, only : constant, ratio, times
   use vcor_solver_modes, only : modes_t, resolve, resolve_contact, start_t
   use vcor_solver_newton, only : most_iterations, newton_t
   use vcor_solver_panel, only : begin_panel, panel_t
   implicit none
   private

   public :: solve_general_panel

contains

   !> Solve the collocation equations on a panel by Newton's method
   pure subroutine solve_general_panel(rule, map, scale, impact, modes, coefficient, start, &
                                       panel, tolerance)
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
      !> Coefficient c2 of the second term of the Volterra series [m^-1.5], 0 without it
      real(wp), intent(in) :: coefficient
      !> State at the start
      type(start_t), intent(in) :: start
      !> The panel; on entry `indentation` holds a guess at the stages
      type(panel_t), intent(inout) :: panel
      !> Wanted error of the indentation over its largest value
      real(wp), intent(in) :: tolerance

      real(wp), dimension(width) :: lambda, stiffness, memory
      real(wp), dimension(width) :: s, u, elapsed, alpha, alpha_rate, right, change, force, b
      real(wp), dimension(width) :: impulse, drift, share, past
      real(wp), dimension(width, width) :: h, response, s_matrix, slope, plate, inverse
      real(wp) :: lag(width, width, size(modes%contact%rates))
      integer :: n, iteration, j, k
      real(wp) :: start_u
      type(newton_t) :: newton
      logical :: frozen, remembers

      n = rule%stages
      frozen = impact%plate%frozen()
      remembers = size(start%p) > 0
      s = 0.0_wp
      s(1:n) = panel%indentation(1:n)
      call begin_panel(rule, map, scale, start, panel, elapsed)
      alpha = 0.0_wp
      call impact%plate%alpha_at(panel%time(1:n), alpha(1:n))
      if (remembers) alpha(1:n) = modes%plate%viscosity
      alpha_rate = 0.0_wp
      if (frozen) alpha_rate(1:n) = impact%plate%alpha_rate(panel%time(1:n))

      h = scale*map%matrix
      lambda = scale*map%eigenvalue
      call resolve_contact(modes%contact, start, map, lambda, stiffness, memory)
      s_matrix = function_of_h(map, stiffness)
      b = apply(map%right, memory)
      start_u = hertz(start%indentation)
      lag = 0.0_wp
      if (abs(coefficient) > 0.0_wp) then
         do k = 1, size(lag, 3)
            lag(:, :, k) = function_of_h(map, ratio(map%square, constant(1.0_wp), &
               constant(1.0_wp) + modes%contact%rates(k)*lambda))
         end do
      end if

      ! s = right - response F
      right = impact%velocity*panel%time(1:) &
         - (start%second_impulse + start%impulse*elapsed)/impact%mass
      response = matmul(h, h)
      if (frozen) then
         right = right - start%deflection + start%drift*elapsed
         do j = 1, width
            response(:, j) = response(:, j)*(1.0_wp/impact%mass - alpha_rate(j)) + h(:, j)*alpha(j)
         end do
      else
         right = right - alpha*start%impulse
         do j = 1, width
            response(:, j) = response(:, j)/impact%mass + alpha*h(:, j)
         end do
         if (remembers) then
            ! U has V with V' = R H F + c beside alpha I
            call resolve(modes%plate, start%p, map, lambda, share, memory)
            past = apply(map%right, memory)
            plate = matmul(function_of_h(map, share), h)
            response = response + matmul(h, plate)
            right = right - start%deflection - apply(h, past)
         end if
      end if

      right(n + 1:) = 0.0_wp
      do iteration = 1, most_iterations
         u = hertz(s)
         force = matmul(s_matrix, u - start_u) + b
         slope = s_matrix
         call add_second_term(modes%contact, coefficient, u, start_u, start%lag, lag, force, &
            slope)
         change = right - s - matmul(response, force)
         if (newton%stale) then
            inverse = matmul(response, slope)
            do j = 1, width
               inverse(:, j) = inverse(:, j)*1.5_wp*sqrt(abs(s(j)))
               inverse(j, j) = inverse(j, j) + 1.0_wp
            end do
         end if
         call newton%correct(inverse, change, s, tolerance)
         if (newton%converged .or. newton%failed) exit
      end do
      panel%converged = newton%converged
      if (.not. panel%converged) return

      u = hertz(s)
      force = matmul(s_matrix, u - start_u) + b
      slope = s_matrix
      call add_second_term(modes%contact, coefficient, u, start_u, start%lag, lag, force, slope)
      impulse = start%impulse + matmul(h, force)
      drift = start%drift + matmul(h, alpha_rate*force)
      if (remembers) drift = -past - apply(plate, force)
      panel%indentation(1:) = s
      panel%force(1:) = force
      panel%impulse(1:) = impulse
      panel%second_impulse(1:) = start%second_impulse + matmul(h, impulse)
      panel%drift(1:) = drift
      if (remembers) then
         panel%deflection(1:) = start%deflection - matmul(h, drift)
      else
         panel%deflection(1:) = start%deflection + matmul(h, alpha*force - drift)
      end if
      panel%alpha(1:) = alpha
   end subroutine solve_general_panel

   !> Add the second term of the Volterra series to the force and its derivative to the stiffness
   pure subroutine add_second_term(kernel, coefficient, u, start_u, start_lag, lag, force, slope)
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> Coefficient c2 [m^-1.5], 0 without the term
      real(wp), intent(in) :: coefficient
      !> u at the stages [m^1.5]
      real(wp), intent(in) :: u(width)
      !> u at the start of the panel [m^1.5]
      real(wp), intent(in) :: start_u
      !> What the internal variables fall behind there, u - q_k [m^1.5], shape (modes)
      real(wp), intent(in) :: start_lag(:)
      !> Matrices Z_k, shape (width, width, modes)
      real(wp), intent(in) :: lag(:, :, :)
      !> Force at the stages [N]
      real(wp), intent(inout) :: force(width)
      !> dF/du [N/m^1.5]
      real(wp), intent(inout) :: slope(width, width)

      real(wp) :: p(width)
      integer :: j, k

      if (.not. abs(coefficient) > 0.0_wp) return
      force = force + coefficient*kernel%equilibrium*u**2
      do j = 1, width
         slope(j, j) = slope(j, j) + 2.0_wp*coefficient*kernel%equilibrium*u(j)
      end do
      do k = 1, size(kernel%rates)
         p = matmul(lag(:, :, k), u - start_u + start_lag(k))
         force = force + coefficient*kernel%moduli(k)*p**2
         do j = 1, width
            slope(:, j) = slope(:, j) + 2.0_wp*coefficient*kernel%moduli(k)*p*lag(:, j, k)
         end do
      end do
   end subroutine add_second_term

   !> The matrix f(H) = V f(lambda) V^-1
   pure function function_of_h(map, f) result(matrix)
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Values of the function at the eigenvalues
      real(wp), intent(in) :: f(width)
      !> The matrix
      real(wp) :: matrix(width, width)

      integer :: j

      do j = 1, width
         matrix(:, j) = apply(map%right, times(map%square, f, map%left(:, j)))
      end do
   end function function_of_h

end module vcor_solver_general_panel
