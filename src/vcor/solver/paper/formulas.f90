!> Formulas of the paper's time marching (Adams-Bashforth, backward differences, Runge-Kutta start)
!> and their stability
!>
!> Oscillations from step to step are too fast for the inertia of the sphere and for changes of s
!> and alpha. For the scheme s'' = -U'' = -d (k s')' with d = alpha du/ds, (3/2) alpha sqrt(s) for
!> a sphere: a damper. For s' ~ z^n and x = 1/z each of its formulas is a factor:
!>
!>     Adams-Bashforth  (1 - x)/x s' = dt sigma(x) s''
!>     force, form a    F = (3/2) sqrt(s) dt (K(x) - (1 - g) k_0) s',  K(x) = sum_j k_j x^j
!>     force, form b    F = (3/2) sqrt(s) k_0 s,  s = dt sigma(x) x/(1 - x) s'
!>     impulse          I = dt (g + (1 - g) x)/(1 - x) F
!>     difference       U'' = alpha delta2(x)/dt^2 I, frozen plate: U'' = alpha delta1(x)/dt F
!>
!> with g = 1 for rectangles and 1/2 for trapezoids. Each z on the unit circle belongs to one d; the
!> smallest real, positive d is where a mode first stops decaying. For form a with rectangles this
!> is z = -1 with sigma = 551/45, delta2 = 4592/45 and, for a constant kernel, K = k_0/2:
!> dt (3/2) alpha k_0 sqrt(s) < 0.0064, while the Adams-Bashforth formula alone allows 0.163.
module vcor_solver_paper_formulas
   use vcor_impact_law, only : contact_law_t
   use vcor_kinds, only : pi, wp
   implicit none
   private

   public :: adams_bashforth, second_difference, first_difference, runge_kutta
   public :: start_steps, ab_points, second_points, first_points
   public :: damping_limit, kernel_terms

   !> Steps of the Runge-Kutta start
   integer, parameter :: start_steps = 3
   !> Slopes in the Adams-Bashforth formula of fifth order
   integer, parameter :: ab_points = 5
   !> Points of the second backward difference of fifth order
   integer, parameter :: second_points = 7
   !> Points of the first backward difference of fifth order
   integer, parameter :: first_points = 6

   !> Weights of the slopes, newest first; column p is the formula of order p
   real(wp), parameter :: adams_bashforth(ab_points, start_steps + 1:ab_points) = reshape([ &
      55.0_wp/24.0_wp, -59.0_wp/24.0_wp, 37.0_wp/24.0_wp, -9.0_wp/24.0_wp, 0.0_wp, &
      1901.0_wp/720.0_wp, -2774.0_wp/720.0_wp, 2616.0_wp/720.0_wp, -1274.0_wp/720.0_wp, &
      251.0_wp/720.0_wp], [ab_points, ab_points - start_steps])

   !> Weights of the points in the second derivative times dt^2, newest first; column p takes p
   !> points
   real(wp), parameter :: second_difference(second_points, 3:second_points) = reshape([ &
      1.0_wp, -2.0_wp, 1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      2.0_wp, -5.0_wp, 4.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      35.0_wp/12.0_wp, -26.0_wp/3.0_wp, 19.0_wp/2.0_wp, -14.0_wp/3.0_wp, 11.0_wp/12.0_wp, &
      0.0_wp, 0.0_wp, &
      15.0_wp/4.0_wp, -77.0_wp/6.0_wp, 107.0_wp/6.0_wp, -13.0_wp, 61.0_wp/12.0_wp, &
      -5.0_wp/6.0_wp, 0.0_wp, &
      203.0_wp/45.0_wp, -87.0_wp/5.0_wp, 117.0_wp/4.0_wp, -254.0_wp/9.0_wp, 33.0_wp/2.0_wp, &
      -27.0_wp/5.0_wp, 137.0_wp/180.0_wp], [second_points, second_points - 2])

   !> Weights of the points in the first derivative times dt, newest first; column p takes p points
   real(wp), parameter :: first_difference(first_points, 2:first_points) = reshape([ &
      1.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      1.5_wp, -2.0_wp, 0.5_wp, 0.0_wp, 0.0_wp, 0.0_wp, &
      11.0_wp/6.0_wp, -3.0_wp, 1.5_wp, -1.0_wp/3.0_wp, 0.0_wp, 0.0_wp, &
      25.0_wp/12.0_wp, -4.0_wp, 3.0_wp, -4.0_wp/3.0_wp, 0.25_wp, 0.0_wp, &
      137.0_wp/60.0_wp, -5.0_wp, 5.0_wp, -10.0_wp/3.0_wp, 1.25_wp, -0.2_wp], &
      [first_points, first_points - 1])
   !> Number of kernel values that are summed individually
   integer, parameter :: kernel_terms = 32

contains

   !> A step of s'' = -a u - b u' by the classical Runge-Kutta formula of fourth order
   pure subroutine runge_kutta(law, a, b, dt, s, velocity)
      type(contact_law_t), intent(in) :: law
      !> Firmness over mass [m^-0.5 s^-2]
      real(wp), intent(in) :: a
      !> Plate parameter times firmness [m^-0.5 s^-1]
      real(wp), intent(in) :: b
      !> Step [s]
      real(wp), intent(in) :: dt
      !> Indentation [m], on return after the step
      real(wp), intent(inout) :: s
      !> Rate of the indentation [m/s], on return after the step
      real(wp), intent(inout) :: velocity

      real(wp), dimension(2) :: y, k1, k2, k3, k4

      y = [s, velocity]
      k1 = slope(y)
      k2 = slope(y + 0.5_wp*dt*k1)
      k3 = slope(y + 0.5_wp*dt*k2)
      k4 = slope(y + dt*k3)
      y = y + dt/6.0_wp*(k1 + 2.0_wp*(k2 + k3) + k4)
      s = y(1)
      velocity = y(2)

   contains

      !> Derivatives of s and s'
      pure function slope(y) result(f)
         !> s and s'
         real(wp), intent(in) :: y(2)
         !> Their derivatives
         real(wp) :: f(2)

         f = [y(2), -(a*law%u(y(1)) + b*law%slope(y(1))*y(2))]
      end function slope
   end subroutine runge_kutta

   !> Largest d = (3/2) alpha sqrt(s) for which the scheme is stable
   pure function damping_limit(dt, kernel, form, share, frozen) result(limit)
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Kernel k_j at t = j dt, j = 0 .. kernel_terms [N/m^1.5], as used by the scheme
      real(wp), intent(in) :: kernel(0:kernel_terms)
      !> Form of the force: a or b
      character(len=1), intent(in) :: form
      !> Weight g of the newest value in the sums, 1 or 1/2
      real(wp), intent(in) :: share
      !> Whether the plate is frozen
      logical, intent(in) :: frozen
      !> Limit [m^1.5/(N s)]
      real(wp) :: limit

      ! modes below the first angle belong to the solution itself
      integer, parameter :: angles = 120
      real(wp), parameter :: first_angle = 0.1_wp*pi
      complex(wp) :: d, previous
      real(wp) :: crossing, weight
      integer :: i

      limit = huge(1.0_wp)
      previous = (0.0_wp, 0.0_wp)
      do i = 0, angles
         d = damping_at(first_angle + (pi - first_angle)*real(i, wp)/real(angles, wp))
         crossing = -1.0_wp
         if (i == angles) then
            ! at z = -1 everything is real
            crossing = real(d, wp)
         else if (i > 0 .and. aimag(d)*aimag(previous) <= 0.0_wp) then
            weight = aimag(previous)/(aimag(previous) - aimag(d))
            crossing = real(previous, wp) + weight*real(d - previous, wp)
         end if
         if (crossing > 0.0_wp) limit = min(limit, crossing)
         previous = d
      end do

   contains

      !> The damping that makes a mode z = exp(i angle) neither grow nor decay
      pure function damping_at(angle) result(damping)
         !> Angle, 0 < angle <= pi
         real(wp), intent(in) :: angle
         complex(wp) :: damping

         complex(wp) :: x, sigma, response

         x = exp(cmplx(0.0_wp, -angle, wp))
         if (angle >= pi) x = (-1.0_wp, 0.0_wp)
         sigma = polynomial(adams_bashforth(:, ab_points), x)
         if (form == 'a') then
            response = dt*(transform(x) - (1.0_wp - share)*kernel(0))
         else
            response = kernel(0)*dt*sigma*x/(1.0_wp - x)
         end if
         if (frozen) then
            response = response*polynomial(first_difference(:, first_points), x)/dt
         else
            response = response*polynomial(second_difference(:, second_points), x)/dt &
               *(share + (1.0_wp - share)*x)/(1.0_wp - x)
         end if
         ! trapezoids give no response at z = -1
         damping = (-1.0_wp, 0.0_wp)
         if (abs(response) > tiny(1.0_wp)) damping = -(1.0_wp - x)/(x*dt*sigma*response)
      end function damping_at

      !> sum_j k_j x^j for |x| = 1, x /= 1; the smooth tail from value and slope at its start
      pure function transform(x) result(value)
         !> Argument
         complex(wp), intent(in) :: x
         !> Sum
         complex(wp) :: value

         associate (n => kernel_terms)
            value = polynomial(kernel(0:n - 1), x) + x**n/(1.0_wp - x) &
               *(kernel(n) + (kernel(n) - kernel(n - 1))*x/(1.0_wp - x))
         end associate
      end function transform
   end function damping_limit

   !> Polynomial by Horner's rule
   pure function polynomial(c, x) result(value)
      !> Coefficients, lowest first
      real(wp), intent(in) :: c(:)
      !> Argument
      complex(wp), intent(in) :: x
      complex(wp) :: value

      integer :: j

      value = cmplx(c(size(c)), 0.0_wp, wp)
      do j = size(c) - 1, 1, -1
         value = value*x + c(j)
      end do
   end function polynomial

end module vcor_solver_paper_formulas
