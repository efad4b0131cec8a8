!> March of an impact in equal steps: at each step the springs of the row that push are found, with
!> the sphere's motion z,
!>
!>     z(t) - h(x) = [C q](x, t) and q > 0, or z(t) - h(x) <= [C q](x, t) and q = 0
!>
!> The springs under contact need not be contiguous. What they miss of the force at the edge of the
!> contact is added (`vcor_solver_coupled_edge`). The sphere is a part of the response that moves as
!> a whole, 1/(m s^2), by two recurrences of the same rule in place of sums.
module vcor_solver_coupled_march
   use vcor_error, only : error_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : pi, wp
   use vcor_solver_coupled_balance, only : balance_t
   use vcor_solver_coupled_kernel, only : kernel_t
   use vcor_solver_coupled_past, only : past_t
   use vcor_solver_coupled_rule, only : differences, integrals
   implicit none
   private

   public :: course_t, march
   public :: course_ended, course_outlasts, course_outgrows

   !> Why a march ended: the sphere has left the face
   integer, parameter :: course_ended = 0
   !> The window ended in contact, or with the sphere still on its way in
   integer, parameter :: course_outlasts = 1
   !> The contact became as large as the row of springs
   integer, parameter :: course_outgrows = 2

   !> Exponent of the law of a sphere; smaller ones are those of blunter bodies
   real(wp), parameter :: round = 1.5_wp

   !> Course of an impact
   type :: course_t
      !> One of the `course_*` constants
      integer :: status = course_outlasts
      !> Number of steps
      integer :: steps = 0
      !> Step [s]
      real(wp) :: dt = 0.0_wp
      !> Force [N], shape (0:)
      real(wp), allocatable :: force(:)
      !> Displacement of the sphere [m], shape (0:)
      real(wp), allocatable :: z(:)
      !> Velocity of the sphere [m/s], shape (0:)
      real(wp), allocatable :: velocity(:)
      !> Contact radius [m], shape (0:)
      real(wp), allocatable :: radius(:)
      !> Time at which the contact ended [s]
      real(wp) :: contact_time = 0.0_wp
      !> Estimated error of that time which shorter steps do not show [s]
      real(wp) :: time_error = 0.0_wp
      !> Impulse of the contact [N s]
      real(wp) :: impulse = 0.0_wp
      !> Largest tension around the axis [Pa], 0 if there is none
      real(wp) :: tension = 0.0_wp
   contains
      procedure :: rests
      procedure :: cor
   end type course_t

contains

   !> March from first contact until the sphere leaves, or the window or the row of springs ends
   subroutine march(impact, kernel, course, error)
      type(impact_t), intent(in) :: impact
      !> Response of `impact%face`
      type(kernel_t), intent(in) :: kernel
      type(course_t), intent(out) :: course
      !> Error of code `error_numerical`
      type(error_t), allocatable, intent(out) :: error

      ! steps in a row without contact that make its end
      integer, parameter :: needed = 2
      type(balance_t) :: balance
      type(past_t) :: past
      real(wp), allocatable :: profile(:)
      real(wp) :: lost(0:2), path(0:2), per_mass, pull, bend(kernel%mesh%hats)
      real(wp) :: axis(0:kernel%mesh%steps), beside(kernel%mesh%steps)
      real(wp) :: height
      logical :: is_bounded
      integer :: k, last, n, free

      associate (row => kernel%row, steps => kernel%mesh%steps)
         n = kernel%mesh%hats
         course%dt = kernel%mesh%window/real(steps, wp)
         allocate (course%force(0:steps), course%z(0:steps), course%velocity(0:steps), &
            course%radius(0:steps), source=0.0_wp)
         course%velocity(0) = impact%velocity
         call past%begin(kernel)
         profile = impact%law%profile(impact%factor, row%x)
         height = impact%law%profile(impact%factor, row%node(kernel%beside))
         ! the row of a flat punch ends with it
         is_bounded = impact%law%start_exponent > 1.0_wp
         per_mass = course%dt/impact%mass
         ! response of the sphere to the force of this step
         call balance%begin(kernel, (course%dt*integrals(0)/differences(0))**2/impact%mass, &
            impact%law%start_exponent)
         lost = 0.0_wp
         path = 0.0_wp
         axis(0) = 0.0_wp
         free = 0
         do k = 1, steps - 1
            ! velocity and path that earlier forces have taken from the sphere
            lost = [0.0_wp, lost(0:1)]
            path = [0.0_wp, path(0:1)]
            if (k > 1) lost(0) = per_mass*integrals(1)*course%force(k - 1)
            if (k > 2) lost(0) = lost(0) + per_mass*integrals(2)*course%force(k - 2)
            lost(0) = (lost(0) - differences(1)*lost(1) - differences(2)*lost(2))/differences(0)
            path(0) = (course%dt*sum(integrals*lost) - differences(1)*path(1) &
               - differences(2)*path(2))/differences(0)
            balance%touched = balance%reach
            call past%begin_step(kernel, k, balance%touched)
            bend = path(0) + past%bends(kernel, k)
            balance%gap = impact%free_path(real(k, wp)*course%dt) - profile
            if (kernel%remembers) then
               call past%dents(kernel, k, balance%dent(:balance%touched))
               balance%gap(:balance%touched) = balance%gap(:balance%touched) &
                  - balance%dent(:balance%touched)
               call balance%edge%begin_step(k, kernel%local)
            end if
            call row%spread_hats(-bend, balance%gap)
            call balance%find_pushing(kernel, error)
            if (allocated(error)) return
            course%steps = k
            past%pressure(:, k) = merge(balance%compression/kernel%local(0), 0.0_wp, &
               balance%pushes)
            last = balance%last
            associate (forces => past%force(n*(k - 1) + 1:n*k))
               call row%gather(past%pressure(:last, k), forces)
               forces = forces + balance%missing
               course%force(k) = sum(forces)
            end associate
            lost(0) = lost(0) + per_mass*integrals(0)/differences(0)*course%force(k)
            path(0) = path(0) + (course%dt*integrals(0)/differences(0))**2/impact%mass &
               *course%force(k)
            course%velocity(k) = impact%free_velocity(real(k, wp)*course%dt) - lost(0)
            course%z(k) = impact%free_path(real(k, wp)*course%dt) - path(0)
            course%radius(k) = balance%edge%radius
            call balance%edge%end_step(k, row, last)
            pull = -axis_pressure(balance%edge%radius, row%x(:last), past%pressure(:last, k))
            if (pull > course%tension) course%tension = pull
            if (is_bounded .and. balance%pushes(row%springs)) then
               course%status = course_outgrows
               return
            end if
            axis(k) = compression_at(balance, kernel, profile, 1, 0.0_wp)
            beside(k) = compression_at(balance, kernel, profile, kernel%beside, height)
            free = free + 1
            if (axis(k) > 0.0_wp .or. course%velocity(k) >= 0.0_wp .or. balance%last > 0) &
               free = 0
            if (free == needed) exit
         end do
         if (k == steps) return
         course%steps = k - needed + 1
         call end_contact(course, impact, kernel, axis(max(0, k - 4):k - 1), &
            beside(max(1, k - 2)), past%force(1:n*(k - 1)))
         course%impulse = course%dt*sum(course%force(1:k))
         call leave(course, impact)
      end associate
   end subroutine march

   !> Coefficient of restitution of the sphere, of a contact that has ended
   elemental function cor(self, impact)
      class(course_t), intent(in) :: self
      type(impact_t), intent(in) :: impact
      !> Coefficient [-]
      real(wp) :: cor

      cor = (self%impulse/impact%mass - impact%free_velocity(self%contact_time))/impact%velocity
   end function cor

   !> Whether the weight keeps the sphere in contact for good: over the last third of the time the
   !> force is within a tenth of it. So near to rest the contact is linear and passive, and the
   !> deviation decays
   pure function rests(self, weight)
      class(course_t), intent(in) :: self
      !> Weight of the sphere [N], 0 without gravity
      real(wp), intent(in) :: weight
      logical :: rests

      real(wp), parameter :: near = 0.1_wp

      rests = self%status == course_outlasts .and. weight > 0.0_wp
      if (rests) rests = all(abs(self%force(2*self%steps/3:self%steps) - weight) <= near*weight)
   end function rests

   !> Compression at a node of the hats, linear in the profile of the springs on both sides of it,
   !> or of the first two
   pure function compression_at(balance, kernel, profile, node, height) result(compression)
      type(balance_t), intent(in) :: balance
      type(kernel_t), intent(in) :: kernel
      !> Profile of the body at the springs [m]
      real(wp), intent(in) :: profile(:)
      !> The node
      integer, intent(in) :: node
      !> Profile of the body at the node [m]
      real(wp), intent(in) :: height
      !> Compression [m]
      real(wp) :: compression

      integer :: i

      i = max(1, (node - 1)*(size(profile)/(kernel%row%hats - 1)))
      associate (u => balance%compression(i:i + 1), h => profile(i:i + 1))
         compression = u(1)
         if (h(2) > h(1)) compression = compression + (u(2) - u(1))*(height - h(1))/(h(2) - h(1))
      end associate
   end function compression_at

   !> Mean pressure around the axis, over a quarter of the contact's radius b: with P = -(1/pi)
   !> int_r^a q'(x) (x^2 - r^2)^(-1/2) dx, and q linear in x^2 between the springs
   !>
   !>     -(2/(pi b^2)) sum dq/d(x^2) [G], G = 2/3 (x^3 - (x^2 - b^2)^(3/2) if x > b)
   !>
   !> The springs only push, but P is negative where q rises with x
   pure function axis_pressure(radius, x, q) result(mean)
      !> Radius of the contact [m]
      real(wp), intent(in) :: radius
      !> Places of the springs up to the last that pushes [m], and the transform of the pressure
      !> there [N/m]
      real(wp), intent(in) :: x(:), q(:)
      !> Pressure [Pa]; 0 for a contact of few springs, and where no spring makes it negative
      real(wp) :: mean

      ! springs up to the edge of a contact that resolves the quarter
      integer, parameter :: resolved = 16
      real(wp) :: b, before, here
      integer :: i, last

      mean = 0.0_wp
      last = size(x)
      if (last < resolved) return
      if (all(q(2:) <= q(:last - 1))) return
      b = 0.25_wp*radius
      ! the slope of the first two springs holds up to the axis
      before = 0.0_wp
      do i = 1, last - 1
         here = weight_of(x(i + 1), b)
         mean = mean + (q(i) - q(i + 1))/(x(i + 1)**2 - x(i)**2)*(here - before)
         before = here
      end do
      ! q falls to 0 from the last spring to the edge, of a punch at once
      mean = mean + q(last)*x(last)*(1.0_wp - sqrt(1.0_wp - (b/x(last))**2))
      mean = mean*2.0_wp/(pi*b**2)
   end function axis_pressure

   !> The function G of `axis_pressure`
   elemental function weight_of(x, b) result(weight)
      !> Place, and radius of the disc [m]
      real(wp), intent(in) :: x, b
      real(wp) :: weight

      weight = 2.0_wp/3.0_wp*(x**3 - max(x**2 - b**2, 0.0_wp)*sqrt(max(x**2 - b**2, 0.0_wp)))
   end function weight_of

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

end module vcor_solver_coupled_march
