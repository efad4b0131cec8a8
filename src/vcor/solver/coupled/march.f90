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
   use vcor_solver_coupled_course, only : course_outgrows, course_t
   use vcor_solver_coupled_end, only : end_contact, leave
   use vcor_solver_coupled_kernel, only : kernel_t
   use vcor_solver_coupled_past, only : past_t
   use vcor_solver_coupled_rule, only : differences, integrals
   implicit none
   private

   public :: march

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
         call end_contact(course, impact, kernel, axis(0:k - 1), &
            beside(max(1, k - 2)), past%force(1:n*(k - 1)))
         course%impulse = course%dt*sum(course%force(1:k))
         call leave(course, impact)
      end associate
   end subroutine march

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

      ! springs up to the edge of a contact that resolves the quarter: four are within it
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

end module vcor_solver_coupled_march
