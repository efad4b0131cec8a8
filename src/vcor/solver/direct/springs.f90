!> Springs of a contact that grows again: the method of dimensionality reduction
!>
!> Whatever the history, the contact is a row of independent springs, spring sigma the one that the
!> body touches first at the indentation sigma (V. L. Popov and M. Hess, Method of Dimensionality
!> Reduction in Contact Mechanics and Friction, 2015). Its compression is w = s - sigma while it is
!> pressed, and w = s - sigma + g with a gap g > 0 while it is free and carries nothing:
!>
!>     phi = int_0^t k(t - x) w'(x) dx,   g = max(0, level - s),
!>     F = int max(0, phi) u''(sigma) dsigma
!>
!> the level being the indentation at which it just carries nothing. The springs that are followed
!> are those touched at nodes. With dw as a parabola over each step phi is a sum over the past, its
!> newest term W_0 dw, so phi = W_0 (s - level), and F is a polygon over sigma times u'', integrated
!> exactly: it rises with s, and s = s_0 - a F has one root. A dashpot adds the derivative of the
!> parabola. The error falls with dt^2; next to the edge of a contact that grows phi is as steep as
!> int k, or with a dashpot jumps, which makes the order less while it does. The sums over the gaps
!> make the work grow with the cube of the steps since the largest indentation.
module vcor_solver_direct_springs
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_solver_convolution, only : lengthen
   use vcor_solver_direct_weights, only : contact_kernel_t
   use vcor_solver_tuning, only : most_work
   implicit none
   private

   public :: springs_t

   !> A spring
   type :: spring_t
      !> Node at which it is touched first
      integer :: touched = 0
      !> Node at which it was free first; 0: it never was
      integer :: released = 0
      !> Indentation sigma that touches it [m]
      real(wp) :: sigma = 0.0_wp
      !> u and du/ds there [m^1.5], [m^0.5]
      real(wp) :: u = 0.0_wp, slope = 0.0_wp
      !> Gap at the last node [m]
      real(wp) :: gap = 0.0_wp
      !> Indentation above which it carries a force at the node that is solved [m]
      real(wp) :: level = 0.0_wp
      !> Differences of its gap from node to node, that at its release first [m]
      real(wp), allocatable :: d_gap(:)
   end type spring_t

   !> The springs under way
   type :: springs_t
      !> Multiplications that their sums have taken
      real(wp) :: work = 0.0_wp
      !> Viscosity over the time step [N/m^1.5]
      real(wp), private :: drag = 0.0_wp
      !> Number of springs
      integer, private :: count = 0
      !> The springs, the one touched first leading, shape (>= count)
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

   !> Follow the springs from first contact to node n, or until their `work` is too much
   subroutine start(self, impact, kernel, n, turn, s, ds)
      class(springs_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(contact_kernel_t), intent(in) :: kernel
      !> Node
      integer, intent(in) :: n
      !> Node up to which the contact has grown
      integer, intent(in) :: turn
      !> Indentation at the nodes [m], and its differences
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
         if (self%work > most_work) return
      end do
   end subroutine start

   !> Force at node n
   subroutine find_force(self, impact, kernel, n, last_s, ds, indentation, force, t1)
      class(springs_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(contact_kernel_t), intent(in) :: kernel
      !> Node
      integer, intent(in) :: n
      !> Indentation at the node before [m]
      real(wp), intent(in) :: last_s
      !> Its differences up to there [m]
      real(wp), contiguous, intent(in) :: ds(:)
      !> s_0 [m] and a [m/N]
      real(wp), intent(in) :: indentation(2)
      !> Force [N]
      real(wp), intent(out) :: force
      !> Time over the time step at which the edge of the contact was touched first; beyond the end
      !> of contact negative
      real(wp), intent(out) :: t1

      real(wp) :: stiffness, s, value, slope, change
      integer :: iteration

      call self%find_levels(kernel, n, last_s, ds)
      stiffness = kernel%newest + 1.5_wp*self%drag
      ! the force is convex: from the second one on the steps go down to the root
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
      ! beyond zero by what the first spring lacks, as k(t) v0 is the rate of its force there
      if (.not. t1 > 0.0_wp) t1 = min(0.0_wp, stiffness*(s - self%spring(1)%level) &
         /(impact%kernel(real(n, wp)*kernel%dt)*ds(1)))
   end subroutine find_force

   !> The level of each spring at node n
   subroutine find_levels(self, kernel, n, last_s, ds)
      class(springs_t), intent(inout) :: self
      type(contact_kernel_t), intent(in) :: kernel
      !> Node
      integer, intent(in) :: n
      !> Indentation at the node before [m]
      real(wp), intent(in) :: last_s
      !> Its differences up to there [m]
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

   !> Take the indentation at node n in
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

   !> Touch a new spring
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

   !> Force over the stiffness of the newest step, int max(0, s - level) u'' dsigma, and its
   !> derivative by s
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
            ! springs that are touched in this step
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
            ! only a part of them is pressed
            k = minloc(x, 1)
            sigma(k) = sigma(1) + (sigma(2) - sigma(1))*x(1)/(x(1) - x(2))
            x(k) = 0.0_wp
            u(k) = law%u(sigma(k))
            du(k) = law%slope(sigma(k))
         end if
         if (.not. sigma(2) > sigma(1)) cycle
         ! by parts
         value = value + x(2)*du(2) - x(1)*du(1) &
            - (x(2) - x(1))*((u(2) - u(1))/(sigma(2) - sigma(1)))
         slope = slope + (du(2) - du(1))
      end do
   end subroutine press

   !> Place of the edge of the contact, by the time over the time step at which it was touched first
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
