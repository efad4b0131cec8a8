!> The end of the contact, which lies between steps
module vcor_solver_coupled_end
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_solver_coupled_course, only : course_ended, course_t
   use vcor_solver_coupled_kernel, only : kernel_t
   implicit none
   private

   public :: end_contact, leave

   !> Exponent of the law of a sphere; smaller ones are those of blunter bodies
   real(wp), parameter :: round = 1.5_wp

contains

   !> Steps from the root of a falling series to its end, by inverse interpolation, or one step
   pure function before_end(value) result(steps)
      !> Values at equal steps, the root near the last
      real(wp), intent(in) :: value(:)
      !> Steps, < 0 if the root is after the end
      real(wp) :: steps

      ! a contact that waves advance ends before the root
      real(wp), parameter :: farthest = -20.0_wp
      real(wp) :: share
      integer :: i, j, n

      n = size(value)
      steps = 1.0_wp
      if (.not. all(value(2:) < value(:n - 1))) return
      steps = 0.0_wp
      do i = 1, n
         share = real(n - i, wp)
         do j = 1, n
            if (j /= i) share = share*value(j)/(value(j) - value(i))
         end do
         steps = steps + share
      end do
      steps = min(max(steps, farthest), real(n - 1, wp))
   end function before_end

   !> Find the time at which the contact has ended.
   !>
   !> While the waves are faster than the edge, the contact of a round body shrinks as a^2 ~ t_s - t
   !> and its force falls as (t_s - t)^(3/2). This sends out waves, and the compression on the axis
   !> ends like a root of time, which no step resolves. If those of an elastic half space, as stiff
   !> as the plate in a step, had passed, the approach there would fall steadily: what else the face
   !> does is slow. Its root t_s does not depend on steps and springs. What the waves do near it is
   !> an impact problem of its own with one length, at which the edge is as fast as they are, a_s =
   !> R V/c, and one time, R V/c^2: V is the speed at which the steady approach falls, and R the
   !> radius of curvature of the body less that of the dent out of which it rises. So the contact
   !> ends R V/c^2 times a number before t_s that depends on Poisson's ratio of the plate and on the
   !> part of the striker in the local compliance alone, `advance`
   pure subroutine end_contact(course, impact, kernel, axis, beside, hats)
      !> The course, its last step the first without contact
      type(course_t), intent(inout) :: course
      type(impact_t), intent(in) :: impact
      type(kernel_t), intent(in) :: kernel
      !> Compression on the axis in the last steps [m], at least 2
      real(wp), intent(in) :: axis(:)
      !> Compression at `kernel%beside` in the last but one of them [m]
      real(wp), intent(in) :: beside
      !> Forces of the hats in all steps [N]
      real(wp), contiguous, intent(in) :: hats(:)

      ! error of `advance` and of the radius of curvature
      real(wp), parameter :: unknown = 0.01_wp
      real(wp) :: steady(size(axis)), dent, fast
      integer :: i, k

      course%status = course_ended
      k = course%steps
      steady = axis
      fast = 0.0_wp
      if (allocated(kernel%passing)) then
         do i = 1, size(axis)
            steady(i) = axis(i) + passing(k - size(axis) + i, 1)
         end do
         if (abs(impact%law%start_exponent - round) <= 0.0_wp) then
            i = size(axis) - 1
            dent = steady(i) - (beside + passing(k - 1, 2))
            if (dent > 0.0_wp) fast = time_of_waves(kernel%row%node(kernel%beside)**2/dent &
               *(steady(i) - steady(i + 1))/course%dt)
         end if
      end if
      if (impact%law%start_exponent < round .or. .not. fast >= 0.0_wp &
          .or. fast > real(k, wp)*course%dt) then
         ! the edge of a blunt body is faster than the waves for longer than a step, and that of any
         ! body on a plate of very slow waves all the time
         course%contact_time = (real(k, wp) - before_end(axis(size(axis) - 1:)))*course%dt
         course%time_error = course%dt
         return
      end if
      course%contact_time = (real(k, wp) - before_end(steady))*course%dt &
         - advance(kernel%moduli%poisson_ratio, kernel%striker_share)*fast
      course%time_error = unknown*fast

   contains

      !> R V/c^2, with the speed of shear waves in a step, as in the waves that pass
      pure function time_of_waves(product) result(time)
         !> R V [m2/s]
         real(wp), intent(in) :: product
         !> R V/c^2 [s]
         real(wp) :: time

         real(wp) :: rate

         rate = 1.0_wp/course%dt
         time = product*(real(impact%face%per_shear_speed(cmplx(rate, kind=wp)), wp)/rate)**2
      end function time_of_waves

      !> Displacement of a node by the waves that pass
      pure function passing(step, node) result(displacement)
         !> Step, and 1: on the axis, 2: at `kernel%beside`
         integer, intent(in) :: step, node
         !> Displacement [m]
         real(wp) :: displacement

         integer :: first

         associate (n => kernel%mesh%hats, lags => size(kernel%passing, 2))
            first = max(1, step - lags + 1)
            displacement = sum(kernel%passing(:, lags - step + first:, node) &
               *reshape(hats(n*(first - 1) + 1:n*step), [n, step - first + 1]))
         end associate
      end function passing
   end subroutine end_contact

   !> Time by which the waves advance the end of the contact of a round body, over R V/c^2. By
   !> marches of elastic spheres on elastic half spaces with 27 to 90 steps in R V/c^2; the formula
   !> is within 0.025 of them, within 0.008 but where the striker is stiffer than the plate, and
   !> within 0.006 for rigid ones. Of a soft striker the waves are a
   !> small perturbation, by the first factor
   elemental function advance(poisson_ratio, striker_share)
      !> Poisson's ratio of the plate [-]
      real(wp), intent(in) :: poisson_ratio
      !> Part of the striker in the local compliance, 0 (rigid) to 1
      real(wp), intent(in) :: striker_share
      real(wp) :: advance

      real(wp), parameter :: rigid(0:1) = [0.089_wp, -0.085_wp], soft(0:1) = [0.85_wp, -0.30_wp]
      real(wp), parameter :: power = 1.4_wp

      advance = (1.0_wp - striker_share)*(rigid(0) + rigid(1)*poisson_ratio &
         + (soft(0) + soft(1)*poisson_ratio)*striker_share**power)
   end function advance

   !> Free flight of the sphere from the end of the contact on
   pure subroutine leave(course, impact)
      !> The course, with contact time and impulse
      type(course_t), intent(inout) :: course
      type(impact_t), intent(in) :: impact

      real(wp) :: flight

      associate (k => course%steps)
         course%velocity(k) = impact%free_velocity(course%contact_time) &
            - course%impulse/impact%mass
         flight = real(k, wp)*course%dt - course%contact_time
         course%z(k) = course%z(k) - (course%velocity(k) + 0.5_wp*impact%gravity*flight)*flight
      end associate
   end subroutine leave

end module vcor_solver_coupled_end
