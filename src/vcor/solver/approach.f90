!> The approach of a receding contact, as its rebound needs it
!>
!> While the contact shrinks, force and condition are integrals over the approach up to a time t1
!> (see `vcor_impact_problem`). For a kernel G_0 + sum_k G_k exp(-l_k t) both are known from what
!> had not relaxed at t1,
!>
!>   F = G_0 u(t1) + sum_k G_k p_k(t1) exp(-l_k (t - t1)),  p_k = int_0^t1 exp(-l_k (t1 - x)) u' dx
!>   N = G_0 s(t1) + sum_k G_k w_k(t1) exp(-l_k (t - t1)),  w_k = int_0^t1 exp(-l_k (t1 - x)) s' dx
!>
!> and the condition is that N is the same integral over all the past, int_0^t k(t - x) s'(x) dx. As
!> dF/dt1 = k(t - t1) u'(t1) and dN/dt1 = k(t - t1) s'(t1), F is a function of N with the slope
!> dF/dN = u'/s' = 1.5 sqrt(s(t1)), which is regular where s' is zero. It goes to zero as N^1.5,
!> where t1 gets to 0, and is continued as an odd function.
module vcor_solver_approach
   use vcor_impact_problem, only : hertz
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, panel_map_t, width
   use vcor_numeric_linear, only : apply
   use vcor_numeric_pairs, only : constant, ratio
   use vcor_solver_panel, only : panel_t
   implicit none
   private

   public :: approach_t

   !> One panel of the approach; index 0 is its start
   type :: stretch_t
      !> Time at its start [s]
      real(wp) :: start = 0.0_wp
      !> Time in it: start + map(1) theta + map(2) theta^2 [s]
      real(wp) :: map(2) = 0.0_wp
      !> Indentation at its points [m]
      real(wp) :: s(0:width) = 0.0_wp
      !> Rate of the indentation [m/s]
      real(wp) :: rate(0:width) = 0.0_wp
      !> w_k [m], shape (0:width, modes)
      real(wp), allocatable :: w(:, :)
      !> p_k [m^1.5], shape (0:width, modes)
      real(wp), allocatable :: p(:, :)
   end type stretch_t

   !> The approach
   type :: approach_t
      !> Number of panels
      integer :: count = 0
      !> Time of its end, the largest indentation [s]
      real(wp) :: end = 0.0_wp
      !> w_k at its end [m], shape (modes)
      real(wp), allocatable :: w(:)
      !> p_k at its end [m^1.5], shape (modes)
      real(wp), allocatable, private :: p(:)
      !> Number of stages of the panels
      integer, private :: stages = 0
      !> Their points
      real(wp), private :: point(0:width) = 0.0_wp
      !> Barycentric weights of the points
      real(wp), private :: barycentric(0:width) = 0.0_wp
      !> Panels
      type(stretch_t), allocatable, private :: stretch(:)
   contains
      !> Add a panel
      procedure :: add
      !> Force and condition by t1
      procedure :: evaluate
      !> Force by the condition
      procedure :: find_force
   end type approach_t

contains

   !> Add a panel
   subroutine add(self, rule, map, scale, kernel, panel, start_rate, rate)
      !> The approach
      class(approach_t), intent(inout) :: self
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Rate of the indentation at the start [m/s]
      real(wp), intent(in) :: start_rate
      !> Rate of the indentation at the stages [m/s]
      real(wp), intent(in) :: rate(:)

      type(stretch_t), allocatable :: longer(:)
      real(wp), dimension(width) :: s, u, decay
      integer :: k, stages

      stages = rule%stages
      if (.not. allocated(self%stretch)) then
         self%stages = stages
         self%point = rule%point
         self%barycentric = rule%barycentric
         allocate (self%stretch(4), self%w(size(kernel%rates)), self%p(size(kernel%rates)))
         self%w = 0.0_wp
         self%p = 0.0_wp
      else if (self%count == size(self%stretch)) then
         allocate (longer(2*self%count))
         longer(:self%count) = self%stretch
         call move_alloc(longer, self%stretch)
      end if
      self%count = self%count + 1
      self%end = panel%time(stages)
      associate (stretch => self%stretch(self%count))
         stretch%start = panel%time(0)
         stretch%map = panel%map
         stretch%s = panel%indentation
         stretch%rate(0) = start_rate
         stretch%rate(1:stages) = rate(1:stages)
         allocate (stretch%w(0:width, size(self%w)), stretch%p(0:width, size(self%p)))
         ! from what is gained in the panel: the modes that settle at once leave no digits of s
         s = apply(map%left, panel%indentation(1:) - panel%indentation(0))
         u = apply(map%left, hertz(panel%indentation(1:)) - hertz(panel%indentation(0)))
         do k = 1, size(self%w)
            decay = constant(1.0_wp) + kernel%rates(k)*scale*map%eigenvalue
            stretch%w(0, k) = self%w(k)
            stretch%p(0, k) = self%p(k)
            stretch%w(1:, k) = apply(map%right, &
               ratio(map%square, s + self%w(k)*map%left_one, decay))
            stretch%p(1:, k) = apply(map%right, &
               ratio(map%square, u + self%p(k)*map%left_one, decay))
            self%w(k) = stretch%w(stages, k)
            self%p(k) = stretch%p(stages, k)
         end do
      end associate
   end subroutine add

   !> Force and condition by t1
   pure subroutine evaluate(self, kernel, t, t1, condition, force, firmness, s, rate)
      !> The approach
      class(approach_t), intent(in) :: self
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> Time [s]
      real(wp), intent(in) :: t
      !> t1 [s], 0 .. end of the approach
      real(wp), intent(in) :: t1
      !> N [N/m^0.5]
      real(wp), intent(out) :: condition
      !> F [N]
      real(wp), intent(out) :: force
      !> k(t - t1) [N/m^1.5]
      real(wp), intent(out) :: firmness
      !> s(t1) [m]
      real(wp), intent(out) :: s
      !> s'(t1) [m/s]
      real(wp), intent(out) :: rate

      ! exp(-this) is nothing
      real(wp), parameter :: nothing = 42.0_wp
      real(wp) :: basis(0:width), theta, offset, share, w, p, before(0:width), after
      integer :: i, j, k, n

      do j = self%count, 2, -1
         if (t1 >= self%stretch(j)%start) exit
      end do
      n = self%stages
      associate (stretch => self%stretch(j))
         offset = max(0.0_wp, t1 - stretch%start)
         theta = 0.0_wp
         if (offset > 0.0_wp) theta = 2.0_wp*offset/(stretch%map(1) &
            + sqrt(stretch%map(1)**2 + 4.0_wp*stretch%map(2)*offset))
         basis = 0.0_wp
         before(0) = 1.0_wp
         do i = 1, n
            before(i) = before(i - 1)*(theta - self%point(i - 1))
         end do
         after = 1.0_wp
         do i = n, 0, -1
            basis(i) = self%barycentric(i)*before(i)*after
            after = after*(theta - self%point(i))
         end do

         s = sum(basis*stretch%s)
         rate = sum(basis*stretch%rate)
         firmness = kernel%equilibrium
         condition = kernel%equilibrium*s
         force = kernel%equilibrium*hertz(s)
         do k = 1, size(kernel%rates)
            if (kernel%rates(k)*(t - t1) > nothing) cycle
            share = kernel%moduli(k)*exp(-kernel%rates(k)*(t - t1))
            w = 0.0_wp
            p = 0.0_wp
            do i = 0, width
               w = w + basis(i)*stretch%w(i, k)
               p = p + basis(i)*stretch%p(i, k)
            end do
            firmness = firmness + share
            condition = condition + share*w
            force = force + share*p
         end do
      end associate
   end subroutine evaluate

   !> Force by the condition: t1 by Newton's method between 0 and the end of the approach, until the
   !> force that is extrapolated by its slope is right
   pure subroutine find_force(self, kernel, t, condition, velocity, tolerance, t1, force, &
                              slope)
      !> The approach
      class(approach_t), intent(in) :: self
      !> The kernel
      type(exponential_sum_t), intent(in) :: kernel
      !> Time [s]
      real(wp), intent(in) :: t
      !> N [N/m^0.5]
      real(wp), intent(in) :: condition
      !> Velocity of approach [m/s]
      real(wp), intent(in) :: velocity
      !> Relative error that the force may have
      real(wp), intent(in) :: tolerance
      !> t1 [s]: a guess, on return the solution; negative where N is
      real(wp), intent(inout) :: t1
      !> F [N]
      real(wp), intent(out) :: force
      !> dF/dN [m^0.5]
      real(wp), intent(out) :: slope

      integer, parameter :: most_iterations = 60
      ! t1 over the time of the approach, and its bracket, that are nothing
      real(wp), parameter :: nothing = 1.0e-14_wp
      ! where a relaxed fluid answers with no force any indentation may be asked for [m]
      real(wp), parameter :: farthest = 1.0e60_wp
      real(wp) :: lower, upper, found, rate, firmness, s, lacking
      integer :: iteration

      lower = 0.0_wp
      upper = self%end
      if (.not. condition > 0.0_wp .or. .not. (t1 > lower .and. t1 < upper)) then
         ! next to the end N = k(t) s with s = v0 t1
         firmness = kernel%equilibrium + sum(kernel%moduli*exp(-min(kernel%rates*t, 600.0_wp)))
         s = sign(farthest, condition)
         if (abs(condition) < farthest*firmness) s = condition/firmness
         t1 = s/velocity
         force = firmness*hertz(s)
         slope = 1.5_wp*sqrt(abs(s))
         if (.not. t1 > nothing*upper) return
         t1 = min(t1, 0.99_wp*upper)
      end if
      do iteration = 1, most_iterations
         call self%evaluate(kernel, t, t1, found, force, firmness, s, rate)
         lacking = condition - found
         slope = 1.5_wp*sqrt(max(s, 0.0_wp))
         force = force + slope*lacking
         ! the slope changes by 0.75/(k sqrt(s)) per N
         if (0.6_wp*lacking**2 <= tolerance*abs(force)*firmness*slope) exit
         if (lacking > 0.0_wp) then
            lower = t1
         else
            upper = t1
         end if
         ! Newton's step, or half of the bracket where that leads out of it
         if (abs(lacking) < upper*firmness*rate) then
            t1 = t1 + lacking/(firmness*rate)
         else
            t1 = lower
         end if
         if (.not. (t1 > lower .and. t1 < upper)) t1 = 0.5_wp*(lower + upper)
         if (upper - lower <= nothing*self%end) exit
      end do
   end subroutine find_force

end module vcor_solver_approach
