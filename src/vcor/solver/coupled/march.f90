!> March of an impact in equal steps: at each step the springs of the row that push are found, with
!> the sphere's motion z,
!>
!>     z(t) - h(x) = [C q](x, t) and q > 0, or z(t) - h(x) <= [C q](x, t) and q = 0
!>
!> The springs under contact need not be contiguous. The sphere is a part of the response that moves
!> as a whole, 1/(m s^2), by two recurrences of the same rule in place of sums.
module vcor_solver_coupled_march
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_numeric_lapack, only : dgesv
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
      !> Impulse of the contact [N s]
      real(wp) :: impulse = 0.0_wp
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

      type(balance_t) :: balance
      real(wp), allocatable :: profile(:), pressure(:, :), hats(:)
      real(wp) :: lost(0:2), path(0:2), per_mass, axis(0:1), bend(kernel%mesh%hats)
      logical :: is_bounded
      integer :: i, k, n

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
         axis = 0.0_wp
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
            call gather(kernel, pressure(:, k), hats(n*(k - 1) + 1:n*k))
            course%force(k) = sum(hats(n*(k - 1) + 1:n*k))
            lost(0) = lost(0) + per_mass*integrals(0)/differences(0)*course%force(k)
            path(0) = path(0) + (course%dt*integrals(0)/differences(0))**2/impact%mass &
               *course%force(k)
            course%velocity(k) = impact%free_velocity(real(k, wp)*course%dt) - lost(0)
            course%z(k) = impact%free_path(real(k, wp)*course%dt) - path(0)
            course%radius(k) = edge(balance, row%x)
            if (is_bounded .and. balance%pushes(row%springs)) then
               course%status = course_outgrows
               return
            end if
            axis = [axis_compression(balance, profile), axis(0)]
            if (axis(0) <= 0.0_wp .and. course%velocity(k) < 0.0_wp &
                .and. .not. any(balance%pushes)) exit
         end do
         if (k == steps) return
         call end_contact(course, impact, axis(1)/(axis(1) - axis(0)))
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
         allocate (self%gram(n, n), self%gap(springs), self%compression(springs), source=0.0_wp)
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
   !> once, which takes two or three rounds from the springs of the step before. If that goes round
   !> in circles the last of them changes alone, by Murty's rule (K. G. Murty, Opsearch 8 (1971)
   !> 188), which always ends as the response is passive
   subroutine find_pushing(self, kernel, error)
      type(balance_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel
      !> Error of code `error_numerical`
      type(error_t), allocatable, intent(out) :: error

      integer, parameter :: together = 30, most = 1000
      real(wp) :: y(kernel%mesh%hats), system(kernel%mesh%hats, kernel%mesh%hats)
      integer :: round, i, last, pivots(kernel%mesh%hats), info
      logical :: pushes

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
         if (last == 0) return
         if (round > together) call change(self, kernel, last)
      end do
      call raise(error, error_numerical, 'the springs that push in a step of the contact cannot ' &
         //'be found')
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

   !> Contact radius, where the compression of the springs passes through 0
   pure function edge(self, x) result(radius)
      type(balance_t), intent(in) :: self
      !> Places of the springs [m]
      real(wp), intent(in) :: x(:)
      !> Radius [m]
      real(wp) :: radius

      integer :: i

      radius = 0.0_wp
      do i = size(x), 1, -1
         if (self%pushes(i)) exit
      end do
      if (i == 0) return
      radius = x(i)
      if (i < size(x)) radius = radius + (x(i + 1) - x(i))*self%compression(i) &
         /(self%compression(i) - self%compression(i + 1))
   end function edge

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

   !> End a contact in the last step
   pure subroutine end_contact(course, impact, part)
      type(course_t), intent(inout) :: course
      type(impact_t), intent(in) :: impact
      !> Part of the step after which the contact ended
      real(wp), intent(in) :: part

      course%status = course_ended
      associate (k => course%steps)
         course%contact_time = (real(k - 1, wp) + min(max(part, 0.0_wp), 1.0_wp))*course%dt
         course%impulse = course%dt*sum(course%force(1:k))
         course%velocity(k) = impact%free_velocity(course%contact_time) &
            - course%impulse/impact%mass
         course%z(k) = course%z(k) &
            - course%velocity(k)*(real(k, wp)*course%dt - course%contact_time)
      end associate
   end subroutine end_contact

end module vcor_solver_coupled_march
