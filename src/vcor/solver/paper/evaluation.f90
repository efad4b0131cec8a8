!> Step (7) of the paper, the evaluation: root of the force by Lagrange interpolation, integrals by
!> Simpson's rule
module vcor_solver_paper_evaluation
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, columns, &
      trajectory_t
   use vcor_kinds, only : wp
   use vcor_solver_equal_steps, only : add_last_step
   implicit none
   private

   public :: steps_beyond, insert_separation, set_simpson_weights

   !> Points of the interpolation
   integer, parameter :: points = 6
   !> Nodes wanted beyond the first one without force, so that the root lies amid the points
   integer, parameter :: steps_beyond = points/2 - 1

contains

   !> Put the node where F = 0 before node n, the first one with F <= 0; the nodes behind move up
   pure subroutine insert_separation(impact, n, trajectory)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Node; `steps_beyond` more have followed
      integer, intent(in) :: n
      !> The trajectory, room for a node more
      type(trajectory_t), intent(inout) :: trajectory

      real(wp) :: window(columns, 0:points - 1), node(columns), lower, upper, x
      integer :: first, last, i, iteration

      first = max(n - points/2, 0)
      last = min(n + steps_beyond, trajectory%final) - first
      window(:, 0:last) = trajectory%state(:, first:first + last)

      ! the sign changes between nodes n - 1 and n
      lower = real(n - 1 - first, wp)
      upper = lower + 1.0_wp
      do iteration = 1, digits(1.0_wp)
         x = 0.5_wp*(lower + upper)
         if (sum(lagrange(last, x)*window(col_force, 0:last)) > 0.0_wp) then
            lower = x
         else
            upper = x
         end if
      end do

      node = matmul(window(:, 0:last), lagrange(last, upper))
      node(col_force) = 0.0_wp
      if (.not. impact%plate%frozen()) then
         node(col_plate) = impact%plate%alpha(node(col_time))*node(col_impulse)
         node(col_plate_velocity) = impact%plate%alpha_rate(node(col_time))*node(col_impulse)
      end if
      node(col_sphere) = node(col_indentation) + node(col_plate)
      node(col_sphere_velocity) = impact%velocity - node(col_impulse)/impact%mass

      do i = trajectory%final, n, -1
         trajectory%state(:, i + 1) = trajectory%state(:, i)
      end do
      trajectory%state(:, n) = node
      trajectory%final = trajectory%final + 1
      trajectory%last = n
   end subroutine insert_separation

   !> Lagrange's polynomials of the points 0, 1 .. n
   pure function lagrange(n, x) result(c)
      !> Last point
      integer, intent(in) :: n
      !> Argument
      real(wp), intent(in) :: x
      !> Polynomials, shape (0:n)
      real(wp) :: c(0:n)

      integer :: i, j

      c = 1.0_wp
      do j = 0, n
         do i = 0, n
            if (i /= j) c(j) = c(j)*(x - real(i, wp))/real(j - i, wp)
         end do
      end do
   end function lagrange

   !> Weights for integrals over the contact: Simpson's rule on the equal steps, with Simpson's 3/8
   !> rule on three of them where their number is odd, and on the last step, which is shorter, the
   !> parabola through the last three nodes
   pure subroutine set_simpson_weights(dt, trajectory)
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> The trajectory
      type(trajectory_t), intent(inout) :: trajectory

      real(wp) :: h
      integer :: n, even

      n = trajectory%last
      associate (w => trajectory%weight)
         w(0:n) = 0.0_wp
         if (n < 1) return
         h = trajectory%state(col_time, n) - trajectory%state(col_time, n - 1)
         if (n < 3) then
            w(0:n - 1) = dt
            w(0) = 0.5_wp*dt
            if (n == 1) w(0) = 0.0_wp
            if (n == 2) w(1) = 0.5_wp*dt
            w(n - 1:n) = w(n - 1:n) + 0.5_wp*h
            return
         end if

         ! steps that go by pairs, up to node `even`; the other three up to node n - 1
         even = n - 1
         if (mod(even, 2) == 1) even = even - 3
         if (even > 0) then
            w(0:even) = 2.0_wp/3.0_wp*dt
            w(1:even - 1:2) = 4.0_wp/3.0_wp*dt
            w(0) = dt/3.0_wp
            w(even) = dt/3.0_wp
         end if
         if (even < n - 1) &
            w(even:n - 1) = w(even:n - 1) + dt*[3.0_wp, 9.0_wp, 9.0_wp, 3.0_wp]/8.0_wp
         call add_last_step(dt, h, w(n - 2:n))
      end associate
   end subroutine set_simpson_weights

end module vcor_solver_paper_evaluation
