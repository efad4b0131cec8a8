!> Springs of a contact that grows again: the method of dimensionality reduction
!>
!> Whatever the history, the contact is equivalent to a row of independent springs (V. L. Popov and
!> M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction, 2015). The body
!> first touches spring sigma at the indentation sigma. A pressed spring has the compression
!> w = s - sigma; a free one carries no force and has w = s - sigma + g with a gap g > 0:
!>
!>     phi = int_0^t k(t - x) w'(x) dx,   g = max(0, level - s),
!>     F = int max(0, phi) u''(sigma) dsigma
!>
!> in which `level` is the indentation at which phi = 0. The springs first touched at the nodes are
!> followed. With w a parabola on each step, phi is a sum over the past with the newest term W_0 dw,
!> so that phi = W_0 (s - level). It is taken as linear in sigma between these springs, and F is
!> integrated exactly; F rises with s, so that s = s_0 - a F has one root. A dashpot adds its
!> viscosity times w' of the parabola. The error falls as dt^2, but more slowly while the contact
!> grows, as phi is then as steep as int k at the edge, or jumps there if there is a dashpot. The
!> sums over the gaps take work that grows with the cube of the steps since the largest indentation.
module vcor_solver_direct_springs
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_solver_convolution, only : lengthen
   use vcor_solver_direct_weights, only : contact_kernel_t
   use vcor_tuning, only : direct_most_work
   implicit none
   private

   public :: springs_t

   !> A spring
   type :: spring_t
      !> Node at which the body first touches it
      integer :: touched = 0
      !> First node at which it was free, 0 if it never was
      integer :: released = 0
      !> Indentation sigma at which the body first touches it [m]
      real(wp) :: sigma = 0.0_wp
      !> u [m^1.5] and du/ds [m^0.5] at indentation sigma
      real(wp) :: u = 0.0_wp, slope = 0.0_wp
      !> Gap at the last node [m]
      real(wp) :: gap = 0.0_wp
      !> Indentation at the newest node above which it carries a force [m]
      real(wp) :: level = 0.0_wp
      !> Differences of its gap from node to node, beginning with that at its release [m]
      real(wp), allocatable :: d_gap(:)
   end type spring_t

   !> All springs of a contact
   type :: springs_t
      !> Number of multiplications in the sums over gaps so far
      real(wp) :: work = 0.0_wp
      !> Viscosity divided by the time step [N/m^1.5]
      real(wp), private :: drag = 0.0_wp
      !> Number of springs
      integer, private :: count = 0
      !> The springs in the order in which they are touched, shape (>= count)
      type(spring_t), allocatable, private :: spring(:)
   contains
      procedure :: start
      procedure :: find_force
      procedure, private :: find_levels
      procedure, private :: accept
      procedure, private :: press
      procedure, private :: edge
   end type springs_t

contains

   !> Follow the springs from first contact to node n, or until `work` exceeds `direct_most_work`
   subroutine start(self, impact, kernel, n, turn, s, ds)
      class(springs_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(contact_kernel_t), intent(in) :: kernel
      !> Node
      integer, intent(in) :: n
      !> Last node before the contact shrinks
      integer, intent(in) :: turn
      !> Indentation at the nodes and its differences from node to node [m]
      real(wp), intent(in) :: s(0:)
      real(wp), contiguous, intent(in) :: ds(:)

      integer :: i

      if (allocated(self%spring)) deallocate (self%spring)
      self%count = 0
      self%drag = impact%kernel_viscosity()/kernel%dt
      allocate (self%spring(turn + 1))
      do i = 0, turn
         call touch(self, impact%law, i, s(i))
      end do
      do i = turn + 1, n
         call self%find_levels(kernel, i, s(i - 1), ds)
         call self%accept(impact%law, i, s(i))
         if (self%work > direct_most_work) return
      end do
   end subroutine start

   !> Find the force and t1 at node n
   subroutine find_force(self, impact, kernel, n, last_s, ds, indentation, force, t1)
      class(springs_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(contact_kernel_t), intent(in) :: kernel
      !> Node
      integer, intent(in) :: n
      !> Indentation at the node before [m]
      real(wp), intent(in) :: last_s
      !> Differences of the indentation up to that node [m]
      real(wp), contiguous, intent(in) :: ds(:)
      !> s_0 [m] and a [m/N] in s = s_0 - a F
      real(wp), intent(in) :: indentation(2)
      !> Force [N]
      real(wp), intent(out) :: force
      !> Time at which the body first touched the present edge of the contact, in units of the time
      !> step; 0 after the end of contact
      real(wp), intent(out) :: t1

      real(wp) :: stiffness, s, value, slope, change
      integer :: iteration

      call self%find_levels(kernel, n, last_s, ds)
      stiffness = kernel%newest + 1.5_wp*self%drag
      ! the force is convex in s: after one of Newton's steps the others fall towards the root
      s = last_s
      do iteration = 1, 60
         call self%press(impact%law, s, value, slope)
         force = stiffness*value
         change = (s - indentation(1) + indentation(2)*force) &
            /(1.0_wp + indentation(2)*stiffness*slope)
         s = s - change
         if (abs(change) <= 4.0_wp*epsilon(s)*abs(s)) exit
      end do
      call self%press(impact%law, s, value, slope)
      force = stiffness*value
      call self%accept(impact%law, n, s)
      t1 = self%edge(s)
   end subroutine find_force

   !> Compute the level of each spring at node n
   subroutine find_levels(self, kernel, n, last_s, ds)
      class(springs_t), intent(inout) :: self
      type(contact_kernel_t), intent(in) :: kernel
      !> Node
      integer, intent(in) :: n
      !> Indentation at the node before [m]
      real(wp), intent(in) :: last_s
      !> Differences of the indentation up to that node [m]
      real(wp), contiguous, intent(in) :: ds(:)

      real(wp) :: pressed, force
      integer :: i, j, m

      pressed = -0.5_wp*self%drag*ds(n - 1)
      i = n - 1
      do j = self%count, 1, -1
         associate (spring => self%spring(j))
            pressed = pressed + kernel%sum_over(n, spring%touched + 1, i, ds)
            i = spring%touched
            force = pressed - kernel%moment(n - i - 1)*ds(max(i, 1))
            if (spring%released > 0) then
               m = n - spring%released
               force = force + kernel%sum_over(m + 1, 1, m, spring%d_gap) &
                  - 0.5_wp*self%drag*spring%d_gap(m)
               self%work = self%work + real(m, wp)
            end if
            spring%level = last_s + spring%gap - force/(kernel%newest + 1.5_wp*self%drag)
         end associate
      end do
   end subroutine find_levels

   !> Store the gaps at node n, and add a spring if the indentation is larger than ever before
   subroutine accept(self, law, n, s)
      class(springs_t), intent(inout) :: self
      type(contact_law_t), intent(in) :: law
      !> Node
      integer, intent(in) :: n
      !> Indentation there [m]
      real(wp), intent(in) :: s

      real(wp) :: gap
      integer :: j, m

      do j = 1, self%count
         associate (spring => self%spring(j))
            gap = max(0.0_wp, spring%level - s)
            if (spring%released == 0) then
               if (.not. gap > 0.0_wp) cycle
               spring%released = n
               allocate (spring%d_gap(16))
            end if
            m = n - spring%released + 1
            if (m > size(spring%d_gap)) call lengthen(spring%d_gap, 1, 2*m)
            spring%d_gap(m) = gap - spring%gap
            spring%gap = gap
         end associate
      end do
      if (s > self%spring(self%count)%sigma) call touch(self, law, n, s)
   end subroutine accept

   !> Add the spring that is first touched at node n
   subroutine touch(self, law, n, s)
      class(springs_t), intent(inout) :: self
      type(contact_law_t), intent(in) :: law
      !> Node
      integer, intent(in) :: n
      !> Indentation there [m]
      real(wp), intent(in) :: s

      type(spring_t), allocatable :: more(:)

      if (self%count == size(self%spring)) then
         allocate (more(2*self%count))
         more(:self%count) = self%spring
         call move_alloc(more, self%spring)
      end if
      self%count = self%count + 1
      associate (spring => self%spring(self%count))
         spring%touched = n
         spring%sigma = s
         spring%u = law%u(s)
         spring%slope = law%slope(s)
      end associate
   end subroutine touch

   !> Force divided by the stiffness of the newest step, int max(0, s - level) u'' dsigma, and its
   !> derivative with respect to s
   pure subroutine press(self, law, s, value, slope)
      class(springs_t), intent(in) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> Integral [m^1.5]
      real(wp), intent(out) :: value
      !> Its derivative [m^0.5]
      real(wp), intent(out) :: slope

      real(wp) :: x(2), sigma(2), u(2), du(2)
      integer :: j, k

      value = 0.0_wp
      slope = 0.0_wp
      associate (last => self%spring(self%count))
         if (s > last%sigma) then
            ! springs first touched in this step: their level is sigma
            value = law%u(s) - last%u - (s - last%sigma)*last%slope
            slope = law%slope(s) - last%slope
         end if
      end associate
      do j = 1, self%count - 1
         associate (left => self%spring(j), right => self%spring(j + 1))
            x = s - [left%level, right%level]
            if (.not. maxval(x) > 0.0_wp) cycle
            sigma = [left%sigma, right%sigma]
            u = [left%u, right%u]
            du = [left%slope, right%slope]
         end associate
         if (.not. minval(x) > 0.0_wp) then
            ! only some of the springs between these two are pressed
            k = minloc(x, 1)
            sigma(k) = sigma(1) + (sigma(2) - sigma(1))*x(1)/(x(1) - x(2))
            x(k) = 0.0_wp
            u(k) = law%u(sigma(k))
            du(k) = law%slope(sigma(k))
         end if
         if (.not. sigma(2) > sigma(1)) cycle
         ! integrate by parts, s - level being linear in sigma
         value = value + x(2)*du(2) - x(1)*du(1) &
            - (x(2) - x(1))*((u(2) - u(1))/(sigma(2) - sigma(1)))
         slope = slope + (du(2) - du(1))
      end do
   end subroutine press

   !> Time at which the body first touched the present edge of the contact, in units of the time
   !> step; 0 if no spring is pressed
   pure real(wp) function edge(self, s)
      class(springs_t), intent(in) :: self
      !> Indentation [m]
      real(wp), intent(in) :: s

      real(wp) :: left, right
      integer :: j

      j = findloc(self%spring(:self%count)%level < s, .true., 1, back=.true.)
      edge = 0.0_wp
      if (j == 0) return
      edge = real(self%spring(j)%touched, wp)
      if (j == self%count) return
      left = s - self%spring(j)%level
      right = self%spring(j + 1)%level - s
      edge = edge + left/(left + right) &
         *real(self%spring(j + 1)%touched - self%spring(j)%touched, wp)
   end function edge

end module vcor_solver_direct_springs
