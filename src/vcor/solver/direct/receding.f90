!> Receding contact in product integration
!>
!> When the contact shrinks, F = int_0^t1 k(t - x) u'(x) dx, and t1(t) follows from the condition
!> int_t1^t k(t - x) s'(x) dx = 0: T. C. T. Ting, J. Appl. Mech. 33 (1966) 845,
!> doi:10.1115/1.3625192, for the sphere S. C. Hunter, J. Mech. Phys. Solids 8 (1960) 219,
!> doi:10.1016/0022-5096(60)90028-4. With s a parabola on each step, the integral is summed from the
!> newest step backwards until its sign changes: t1 lies in that step, and the kernel is integrated
!> over the part of the step after t1. The newest indentation and velocity depend on the force,
!> s_n = s_0 - a F and s'_n = v_0 - b F, so that F and t1 are found together. The condition does not
!> hold once the contact grows again; from then on the contact is followed spring by spring.
module vcor_solver_direct_receding
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_problem, only : impact_t
   use vcor_kinds, only : wp
   use vcor_solver_convolution, only : lengthen
   use vcor_solver_direct_springs, only : springs_t
   use vcor_solver_direct_weights, only : contact_kernel_t
   use vcor_tuning, only : direct_most_work
   implicit none
   private

   public :: receding_t

   !> Growth of t1 in a step, in units of the step, that may still be rounding: where s' is zero, t1
   !> moves by the root of what s is off
   real(wp), parameter :: rounding = sqrt(epsilon(1.0_wp))

   !> State of a receding contact
   type :: receding_t
      !> Whether the contact shrinks
      logical :: shrinks = .false.
      !> Whether it has begun to grow again in the last step
      logical :: regrows = .false.
      !> Whether it has grown again and is followed by springs
      logical :: regrown = .false.
      !> The springs, and t1 in units of the time step when the contact began to grow again
      type(springs_t) :: springs
      real(wp), private :: smallest = 0.0_wp
      !> t1 in units of the time step at the last three nodes, the newest last; 0 after the end of
      !> contact
      real(wp) :: t1(3) = 0.0_wp
      !> Force at the newest node, without that of a dashpot [N]
      real(wp) :: force = 0.0_wp
      !> Number of the step that contains t1
      integer, private :: step = 0
      !> Last node before the contact shrinks
      integer, private :: turn = 0
      !> Indentation at the nodes [m], shape (0:)
      real(wp), allocatable, private :: s(:)
      !> Differences of s from node to node [m], shape (1:); ds(1) also stands for ds(0)
      real(wp), allocatable, private :: ds(:)
   contains
      procedure :: prepare
      procedure :: accept
      procedure :: find_force
      procedure :: last_condition
   end type receding_t

contains

   !> Make room for `steps` steps; contents are kept
   pure subroutine prepare(self, steps)
      class(receding_t), intent(inout) :: self
      !> Number of steps
      integer, intent(in) :: steps

      call lengthen(self%s, 0, steps)
      call lengthen(self%ds, 1, steps)
   end subroutine prepare

   !> Store the indentation at node n
   pure subroutine accept(self, n, s)
      class(receding_t), intent(inout) :: self
      !> Node
      integer, intent(in) :: n
      !> Indentation there [m]
      real(wp), intent(in) :: s

      if (.not. allocated(self%s)) return
      self%s(n) = s
      self%ds(n) = s - self%s(n - 1)
      if (.not. self%shrinks) then
         self%step = n
         self%turn = n
         self%t1 = real(n, wp)
      end if
   end subroutine accept

   !> Find the force and t1 at node n. If the contact has not shrunk so far and t1 lies in the
   !> newest step, the contact still grows and nothing is set
   subroutine find_force(self, impact, kernel, n, du, indentation, velocity)
      class(receding_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(contact_kernel_t), intent(in) :: kernel
      !> Node
      integer, intent(in) :: n
      !> Differences of u, shape (>= n - 1)
      real(wp), contiguous, intent(in) :: du(:)
      !> s_0 [m] and a [m/N]
      real(wp), intent(in) :: indentation(2)
      !> v_0 [m/s] and b [m/(N s)]
      real(wp), intent(in) :: velocity(2)

      real(wp) :: last(2)
      logical :: grew

      last = self%t1(2:3)
      grew = last(2) > last(1) + rounding
      if (.not. self%regrown) then
         call follow_edge(self, impact, kernel, n, du, indentation, velocity)
         ! on a fixed plate without gravity s' only falls, and growth is a rounding error
         if (.not. (self%regrows &
             .and. (impact%target%yields() .or. impact%gravity > 0.0_wp))) return
         self%regrown = .true.
         self%smallest = last(2)
         call self%springs%start(impact, kernel, n - 1, self%turn, self%s, self%ds)
         if (self%springs%work > direct_most_work) return
      end if
      self%t1(1:2) = last
      call self%springs%find_force(impact, kernel, n, self%s(n - 1), self%ds, indentation, &
         self%force, self%t1(3))
      self%regrows = self%t1(3) > last(2) + rounding .and. .not. grew
      ! springs that were never released are not affected by the growth: with the edge among them
      ! the condition holds again. The search for t1 begins at a step that is certainly free
      if (self%t1(3) > 0.0_wp .and. ceiling(self%t1(3)) + 1 < floor(self%smallest)) then
         self%regrown = .false.
         self%step = ceiling(self%t1(3)) + 1
      end if
   end subroutine find_force

   !> Find force and t1 at node n from the condition, as long as the contact does not grow again
   subroutine follow_edge(self, impact, kernel, n, du, indentation, velocity)
      class(receding_t), intent(inout) :: self
      type(impact_t), intent(in) :: impact
      type(contact_kernel_t), intent(in) :: kernel
      !> Node
      integer, intent(in) :: n
      !> Differences of u, shape (>= n - 1)
      real(wp), contiguous, intent(in) :: du(:)
      !> s_0 [m] and a [m/N]
      real(wp), intent(in) :: indentation(2)
      !> v_0 [m/s] and b [m/(N s)]
      real(wp), intent(in) :: velocity(2)

      real(wp) :: viscosity, known, per_force, force, condition, earlier, earlier_force
      integer :: m

      viscosity = impact%kernel_viscosity()
      m = self%step
      ! the integral in the condition, with a dashpot's term, is known - per_force*F
      per_force = kernel%newest*indentation(2) + viscosity*velocity(2)
      known = kernel%sum_over(n, m + 1, n - 1, self%ds) - kernel%moment(n - m - 1)*self%ds(m) &
         + kernel%newest*(indentation(1) - self%s(n - 1)) + viscosity*velocity(1)
      force = kernel%sum_over(n, 1, m, du) + kernel%moment(n - m - 1)*du(m)
      condition = known - per_force*force
      if (condition > 0.0_wp) then
         self%regrows = self%shrinks
         return
      end if
      self%shrinks = .true.

      do
         earlier = known + kernel%mean(n - m)*self%ds(m) &
            + kernel%moment(n - m)*(self%ds(m) - self%ds(max(m - 1, 1)))
         earlier_force = 0.0_wp
         if (m > 1) earlier_force = force - kernel%mean(n - m)*du(m) &
            - kernel%moment(n - m)*(du(m) - du(m - 1))
         if (earlier - per_force*earlier_force > 0.0_wp) exit
         known = earlier
         force = earlier_force
         m = m - 1
         if (m == 0) exit
      end do
      self%step = max(m, 1)
      self%t1(1:2) = self%t1(2:3)
      if (m == 0) then
         self%force = 0.0_wp
         self%t1(3) = 0.0_wp
      else
         self%force = force
         call find_in_step(self, impact%law, kernel, n, m, du, known, per_force)
      end if
      self%regrows = self%t1(3) > self%t1(2) + rounding
   end subroutine follow_edge

   !> N, the integral of k(t - x) s'(x) over the whole contact, at the last three nodes. The contact
   !> ends at its zero: it is smooth there, while t1 may fall from far to 0 within a step
   pure function last_condition(self, kernel, viscosity, n, speed) result(condition)
      class(receding_t), intent(in) :: self
      type(contact_kernel_t), intent(in) :: kernel
      !> Viscosity of the kernel's dashpot [N s/m^1.5]
      real(wp), intent(in) :: viscosity
      !> Newest node, the first one after the end
      integer, intent(in) :: n
      !> s' at the last three nodes [m/s]
      real(wp), intent(in) :: speed(3)
      !> Integral [N/m^0.5]
      real(wp) :: condition(3)

      integer :: i, node

      do i = 1, 3
         node = max(1, n - 3 + i)
         condition(i) = kernel%sum_over(node, 1, node, self%ds) &
            - kernel%moment(node - 1)*self%ds(1) + viscosity*speed(i)
      end do
   end function last_condition

   !> Find t1 in step m, and the force, by the Illinois method
   subroutine find_in_step(self, law, kernel, n, m, du, known, per_force)
      !> The contact; on entry its force is the one for t1 at the end of step m
      class(receding_t), intent(inout) :: self
      type(contact_law_t), intent(in) :: law
      type(contact_kernel_t), intent(in) :: kernel
      !> Node
      integer, intent(in) :: n
      !> Step that contains t1
      integer, intent(in) :: m
      !> Differences of u, shape (>= m)
      real(wp), intent(in) :: du(:)
      !> Condition for t1 at the end of step m, without per_force*F [N/m^0.5]
      real(wp), intent(in) :: known
      !> Decrease of the condition per force [m^-0.5]
      real(wp), intent(in) :: per_force

      real(wp) :: lower, upper, f_lower, f_upper, f, x, force, end_u
      integer :: iteration

      end_u = law%u(self%s(m))
      lower = 0.0_wp
      upper = 1.0_wp
      call evaluate(lower, f_lower, force)
      call evaluate(upper, f_upper, force)
      x = upper
      do iteration = 1, 60
         if (.not. f_lower > f_upper) exit
         x = (lower*f_upper - upper*f_lower)/(f_upper - f_lower)
         call evaluate(x, f, force)
         if (abs(f) <= epsilon(f)*abs(known) .or. .not. abs(upper - lower) > epsilon(x)) exit
         if ((f > 0.0_wp) .neqv. (f_upper > 0.0_wp)) then
            lower = upper
            f_lower = f_upper
         else
            f_lower = 0.5_wp*f_lower
         end if
         upper = x
         f_upper = f
      end do
      self%force = force
      self%t1(3) = real(m - 1, wp) + x

   contains

      !> Condition and force for t1 at a given position in step m
      subroutine evaluate(position, condition, up_to)
         !> Position from the start, 0, to the end, 1, of the step
         real(wp), intent(in) :: position
         real(wp), intent(out) :: condition
         !> Force [N]
         real(wp), intent(out) :: up_to

         real(wp) :: before, s1, part, moment

         associate (ds => self%ds(m), bend => self%ds(m) - self%ds(max(m - 1, 1)))
            s1 = self%s(m - 1) + position*(ds - 0.5_wp*bend*(1.0_wp - position))
            moment = kernel%moment(n - m)*(1.0_wp - position)
            part = kernel%late_mean(n - m, position)
            condition = known + part*(self%s(m) - s1) + moment*bend
         end associate
         before = 0.0_wp
         if (m > 1) before = du(m - 1)
         up_to = self%force - part*(end_u - law%u(s1)) - moment*(du(m) - before)
         condition = condition - per_force*up_to
      end subroutine evaluate
   end subroutine find_in_step

end module vcor_solver_direct_receding
