!> March of an impact in equal steps: at each step the springs of the row that push are found, with
!> the sphere's motion z,
!>
!>     z(t) - h(x) = [C q](x, t) and q > 0, or z(t) - h(x) <= [C q](x, t) and q = 0
!>
!> The springs under contact need not be contiguous. What they miss of the force, as the edge of the
!> contact lies between two of them, is added, or the force would change by steps as springs come
!> into contact one by one. The sphere is a part of the response that moves
!> as a whole, 1/(m s^2), by two recurrences of the same rule in place of sums.
module vcor_solver_coupled_march
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : pi, wp
   use vcor_numeric_lapack, only : dgesv, dgetrs
   use vcor_solver_convolution, only : dot
   use vcor_solver_coupled_kernel, only : kernel_t
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

   !> The springs and hats of a step
   type :: balance_t
      !> Weights of the hats of this step with the mass of the sphere [m/N]
      real(wp), allocatable :: now(:, :)
      !> sum of weight*value*value over the springs that push [m]
      real(wp), allocatable :: gram(:, :)
      !> Which springs push
      logical, allocatable :: pushes(:)
      !> Approach of the bodies over the springs without the forces of this step [m]
      real(wp), allocatable :: gap(:)
      !> Compression of the springs of this step [m], > 0 where they push
      real(wp), allocatable :: compression(:)
      !> Forces of the hats that the springs miss at the edge of the contact [N], shape (hats)
      real(wp), allocatable :: missing(:)
      !> Radius of the contact [m]
      real(wp) :: radius = 0.0_wp
      !> Number of springs up to the last that has pushed
      integer :: reach = 0
   end type balance_t

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
      real(wp), allocatable :: profile(:), pressure(:, :), hats(:)
      real(wp) :: lost(0:2), path(0:2), per_mass, pull, bend(kernel%mesh%hats)
      real(wp) :: axis(0:kernel%mesh%steps)
      logical :: is_bounded
      integer :: i, k, n, free

      associate (row => kernel%row, steps => kernel%mesh%steps)
         n = kernel%mesh%hats
         course%dt = kernel%mesh%window/real(steps, wp)
         allocate (course%force(0:steps), course%z(0:steps), course%velocity(0:steps), &
            course%radius(0:steps), source=0.0_wp)
         course%velocity(0) = impact%velocity
         allocate (pressure(row%springs, steps), hats(n*steps))
         profile = impact%law%profile(impact%factor, row%x)
         ! the row of a flat punch ends with it
         is_bounded = impact%law%start_exponent > 1.0_wp
         per_mass = course%dt/impact%mass
         ! response of the sphere to the force of this step
         call prepare(balance, kernel, &
            (course%dt*integrals(0)/differences(0))**2/impact%mass)
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
            bend = path(0)
            if (kernel%has_response) then
               do i = 1, n
                  bend(i) = bend(i) + dot(kernel%later(n*(steps - k) + 1:n*(steps - 1), i), &
                     hats(1:n*(k - 1)))
               end do
            end if
            balance%gap = impact%free_path(real(k, wp)*course%dt) - profile
            if (kernel%remembers) call subtract_past(balance%gap(:balance%reach), pressure, &
               kernel%local(:k - 1))
            call spread_hats(kernel, -bend, balance%gap)
            call find_pushing(balance, kernel, error)
            if (allocated(error)) return
            course%steps = k
            pressure(:, k) = merge(balance%compression/kernel%local(0), 0.0_wp, balance%pushes)
            associate (forces => hats(n*(k - 1) + 1:n*k))
               call gather(kernel, pressure(:, k), forces)
               forces = forces + balance%missing
               course%force(k) = sum(forces)
            end associate
            lost(0) = lost(0) + per_mass*integrals(0)/differences(0)*course%force(k)
            path(0) = path(0) + (course%dt*integrals(0)/differences(0))**2/impact%mass &
               *course%force(k)
            course%velocity(k) = impact%free_velocity(real(k, wp)*course%dt) - lost(0)
            course%z(k) = impact%free_path(real(k, wp)*course%dt) - path(0)
            course%radius(k) = balance%radius
            pull = -axis_pressure(balance, row%x, pressure(:, k))
            if (pull > course%tension) course%tension = pull
            if (is_bounded .and. balance%pushes(row%springs)) then
               course%status = course_outgrows
               return
            end if
            axis(k) = axis_compression(balance, profile)
            free = free + 1
            if (axis(k) > 0.0_wp .or. course%velocity(k) >= 0.0_wp .or. any(balance%pushes)) &
               free = 0
            if (free == needed) exit
         end do
         if (k == steps) return
         course%steps = k - needed + 1
         call end_contact(course, impact, kernel, axis(max(0, k - 4):k - 1), hats(1:n*(k - 1)))
         course%impulse = course%dt*sum(course%force(1:k))
         call leave(course, impact)
      end associate
   end subroutine march

   !> Coefficient of restitution of the sphere, of a contact that has ended
   pure function cor(self, impact)
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

   !> Set up the springs and hats, none of which push
   pure subroutine prepare(self, kernel, sphere)
      type(balance_t), intent(out) :: self
      type(kernel_t), intent(in) :: kernel
      !> Displacement of the sphere in a step by the force of that step [m/N]
      real(wp), intent(in) :: sphere

      associate (n => kernel%mesh%hats, springs => kernel%row%springs)
         allocate (self%now(n, n), source=kernel%now + sphere)
         allocate (self%gram(n, n), self%gap(springs), self%compression(springs), &
            self%missing(n), source=0.0_wp)
         allocate (self%pushes(springs), source=.false.)
      end associate
   end subroutine prepare

   !> Subtract what earlier pressures have left in the springs, four steps at a time, as the sum
   !> would otherwise be loaded and stored for each
   pure subroutine subtract_past(gap, pressure, local)
      !> Approach of the bodies over the springs [m]
      real(wp), contiguous, intent(inout) :: gap(:)
      !> Pressures of earlier steps [N/m], shape (springs, >= steps)
      real(wp), contiguous, intent(in) :: pressure(:, :)
      !> Weights of the springs from lag 0 to that of the first step, shape (0:steps)
      real(wp), intent(in) :: local(0:)

      integer :: i, n, steps

      n = size(gap)
      steps = ubound(local, 1)
      do i = 1, steps - 3, 4
         gap = gap - (local(steps + 1 - i)*pressure(:n, i) &
            + local(steps - i)*pressure(:n, i + 1) &
            + local(steps - 1 - i)*pressure(:n, i + 2) &
            + local(steps - 2 - i)*pressure(:n, i + 3))
      end do
      do i = steps - modulo(steps, 4) + 1, steps
         gap = gap - local(steps + 1 - i)*pressure(:n, i)
      end do
   end subroutine subtract_past

   !> Add a function on the hats to one on the springs
   pure subroutine spread_hats(kernel, hats, springs)
      type(kernel_t), intent(in) :: kernel
      !> Values at the nodes of the hats
      real(wp), intent(in) :: hats(:)
      !> Values at the springs
      real(wp), intent(inout) :: springs(:)

      integer :: i

      associate (row => kernel%row)
         do i = 1, row%springs
            springs(i) = springs(i) + row%value(1, i)*hats(row%hat(i)) &
               + row%value(2, i)*hats(row%hat(i) + 1)
         end do
      end associate
   end subroutine spread_hats

   !> Integrals of the hats times a function on the springs
   pure subroutine gather(kernel, springs, hats)
      type(kernel_t), intent(in) :: kernel
      !> Values at the springs
      real(wp), intent(in) :: springs(:)
      !> Integrals
      real(wp), intent(out) :: hats(:)

      integer :: i

      hats = 0.0_wp
      associate (row => kernel%row)
         do i = 1, row%springs
            hats(row%hat(i):row%hat(i) + 1) = hats(row%hat(i):row%hat(i) + 1) &
               + row%weight(i)*springs(i)*row%value(:, i)
         end do
      end associate
   end subroutine gather

   !> Find the springs that push, and their compression. All that are on the wrong side change it at
   !> once, which takes two or three rounds from the springs of the step before. If that cycles,
   !> the last of them changes alone, by Murty's rule (K. G. Murty, Opsearch 8 (1971)
   !> 188), which always ends as the response is passive
   subroutine find_pushing(self, kernel, error)
      type(balance_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel
      !> Error of code `error_numerical`
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: together = 30, most = 1000
      ! rounds after which missing forces are known, small as they are
      integer, parameter :: enough = 2
      real(wp) :: y(kernel%mesh%hats), more(kernel%mesh%hats)
      real(wp) :: system(kernel%mesh%hats, kernel%mesh%hats)
      integer :: round, i, last, pivots(kernel%mesh%hats), info
      logical :: pushes

      ! no spring is known to be on its side before the first solution, which may fail
      last = size(self%gap)
      do round = 1, most
         if (any(self%pushes)) then
            call gather(kernel, merge(self%gap, 0.0_wp, self%pushes), y)
            system = matmul(self%now, self%gram)/kernel%local(0)
            y = matmul(self%now, y)/kernel%local(0)
            do i = 1, size(y)
               system(i, i) = system(i, i) + 1.0_wp
            end do
            call dgesv(size(y), 1, system, size(y), pivots, y, size(y), info)
            if (info /= 0) exit
         else
            y = 0.0_wp
         end if
         self%compression = self%gap
         call spread_hats(kernel, -y, self%compression)
         last = 0
         do i = 1, size(self%gap)
            pushes = self%compression(i) > 0.0_wp
            if (pushes .eqv. self%pushes(i)) cycle
            last = i
            if (round <= together) call change(self, kernel, i)
         end do
         if (last == 0) exit
         if (round > together) call change(self, kernel, last)
      end do
      if (last == 0) then
         call find_edge(self, kernel)
         if (.not. any(self%pushes)) return
         do round = 1, enough
            more = matmul(self%now, self%missing)
            call dgetrs('N', size(y), 1, system, size(y), pivots, more, size(y), info)
            self%compression = self%gap
            call spread_hats(kernel, -y - more, self%compression)
            call find_edge(self, kernel)
         end do
         return
      end if
      call raise(error, error_numerical, 'no pressure balances a step of the contact: the plate ' &
         //'gives way within the step by more than the contact can resolve; take a thicker ' &
         //'plate, a lighter body or a slower impact')
   end subroutine find_pushing

   !> Let a spring push, or not
   pure subroutine change(self, kernel, i)
      type(balance_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel
      !> The spring
      integer, intent(in) :: i

      real(wp) :: weight
      integer :: j

      self%pushes(i) = .not. self%pushes(i)
      weight = kernel%row%weight(i)
      if (.not. self%pushes(i)) weight = -weight
      associate (left => kernel%row%hat(i), value => kernel%row%value(:, i))
         do j = 0, 1
            self%gram(left:left + 1, left + j) = self%gram(left:left + 1, left + j) &
               + weight*value(1 + j)*value
         end do
      end associate
      self%reach = max(self%reach, i)
   end subroutine change

   !> Find the edge of the contact, where the compression, as a^2 - x^2, passes through 0, and the
   !> forces that the springs miss: a part of the row counts with two springs or one, and not as far
   !> as the edge
   pure subroutine find_edge(self, kernel)
      type(balance_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel

      real(wp) :: decline, end
      integer :: i

      self%missing = 0.0_wp
      self%radius = 0.0_wp
      i = findloc(self%pushes, .true., dim=1, back=.true.)
      if (i == 0) return
      associate (x => kernel%row%x, u => self%compression, a => self%radius, &
                 weight => kernel%row%weight(i), hat => kernel%row%hat(i))
         a = x(i)
         if (i == size(x)) return
         ! of the compression with x^2
         decline = (u(i) - u(i + 1))/(x(i + 1)**2 - x(i)**2)
         if (.not. decline > 0.0_wp) return
         a = sqrt(x(i)**2 + min(max(u(i)/decline, 0.0_wp), x(i + 1)**2 - x(i)**2))
         ! the part of this spring: what its two springs would add up to, and the rest to the edge
         end = 0.5_wp*(x(i) + x(i - 1 + 2*modulo(i, 2)) + weight)
         self%missing(hat:hat + 1) = kernel%row%value(:, i)*decline/kernel%local(0) &
            *(2.0_wp/3.0_wp*(a - end)**2*(2.0_wp*a + end) &
            + real(modulo(i, 2), wp)*weight*(a**2 - x(i + 1)**2))
      end associate
   end subroutine find_edge

   !> Compression on the axis, where the contact ends, linear in the profile of the first springs
   pure function axis_compression(self, profile) result(compression)
      type(balance_t), intent(in) :: self
      !> Profile of the body at the springs [m]
      real(wp), intent(in) :: profile(:)
      !> Compression [m]
      real(wp) :: compression

      associate (u => self%compression)
         compression = u(1)
         if (profile(2) > profile(1)) compression = compression &
            - (u(2) - u(1))*(profile(1)/(profile(2) - profile(1)))
      end associate
   end function axis_compression

   !> Mean pressure around the axis, over a quarter of the contact's radius b: with P = -(1/pi)
   !> int_r^a q'(x) (x^2 - r^2)^(-1/2) dx, and q linear in x^2 between the springs
   !>
   !>     -(2/(pi b^2)) sum dq/d(x^2) [G], G = 2/3 (x^3 - (x^2 - b^2)^(3/2) if x > b)
   !>
   !> The springs only push, but P is negative where q rises with x
   pure function axis_pressure(self, x, q) result(mean)
      type(balance_t), intent(in) :: self
      !> Places of the springs [m], and the transform of the pressure there [N/m], shape (springs)
      real(wp), intent(in) :: x(:), q(:)
      !> Pressure [Pa]; 0 for a contact of few springs
      real(wp) :: mean

      ! springs up to the edge of a contact that resolves the quarter
      integer, parameter :: resolved = 16
      real(wp) :: b, before, here
      integer :: i, last

      mean = 0.0_wp
      last = findloc(self%pushes, .true., dim=1, back=.true.)
      if (last < resolved) return
      b = 0.25_wp*self%radius
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

      ! with steps that resolve how the waves end the contact it ends before the root
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

   !> Time before the end of the contact of a round body at which the edge is as fast as the shear
   !> waves, R V/c^2 but for a factor: a^2 = R V (t0 - t)
   pure function supersonic(impact, kernel, velocity) result(time)
      type(impact_t), intent(in) :: impact
      type(kernel_t), intent(in) :: kernel
      !> Velocity V at which the bodies separate [m/s]
      real(wp), intent(in) :: velocity
      !> R V/c^2 [s]; 0 without waves and for other bodies
      real(wp) :: time

      real(wp) :: x

      time = 0.0_wp
      if (.not. kernel%speed > 0.0_wp .or. abs(impact%law%start_exponent - round) > 0.0_wp) return
      x = kernel%row%x(1)
      time = x**2/impact%law%profile(impact%factor, x)*velocity/kernel%speed**2
   end function supersonic

   !> Find the time at which the contact has ended. The approach on the axis ends like the root of
   !> time, as the falling force sends out waves; if those of a half space had passed, it would
   !> fall as steadily as the bodies move apart, and its root does not depend on the steps
   pure subroutine end_contact(course, impact, kernel, axis, hats)
      !> The course, its last step the first without contact
      type(course_t), intent(inout) :: course
      type(impact_t), intent(in) :: impact
      type(kernel_t), intent(in) :: kernel
      !> Compression on the axis in the last steps [m], at least 2
      real(wp), intent(in) :: axis(:)
      !> Forces of the hats in all steps [N]
      real(wp), contiguous, intent(in) :: hats(:)

      ! part of the time with a fast edge by which the waves advance the end: 0.06 to 0.08 for
      ! Poisson's ratios of 0.5 to 0 on elastic half spaces and steps that resolve it; its error
      real(wp), parameter :: advance = 0.07_wp, unknown = 0.03_wp
      real(wp) :: steady(size(axis)), fast
      integer :: first, i, k, last

      course%status = course_ended
      k = course%steps
      fast = supersonic(impact, kernel, -course%velocity(k))
      if (impact%law%start_exponent < round .or. fast > real(k, wp)*course%dt) then
         ! the edge of a blunt body is faster than the waves for longer than a step, and that of any
         ! body on a plate of very slow waves all the time
         course%contact_time = (real(k, wp) - before_end(axis(size(axis) - 1:)))*course%dt
         course%time_error = course%dt
         return
      end if
      steady = axis
      if (allocated(kernel%passing)) then
         associate (n => kernel%mesh%hats, lags => size(kernel%passing, 2))
            do i = 1, size(axis)
               last = k - size(axis) + i
               first = max(1, last - lags + 1)
               steady(i) = axis(i) + sum(kernel%passing(:, lags - last + first:) &
                  *reshape(hats(n*(first - 1) + 1:n*last), [n, last - first + 1]))
            end do
         end associate
      end if
      course%contact_time = (real(k, wp) - before_end(steady))*course%dt - advance*fast
      course%time_error = unknown*fast
   end subroutine end_contact

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
