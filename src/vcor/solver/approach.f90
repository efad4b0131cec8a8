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
!> where t1 gets to 0, and is continued as an odd function: as if s = v0 t1 before first contact.
module vcor_solver_approach
   use vcor_impact_problem, only : hertz
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_collocation, only : collocation_t, panel_map_t, width
   use vcor_numeric_linear, only : apply
   use vcor_numeric_pairs, only : constant, ratio, times
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
      !> For each mode w_k [m] at the points, then p_k [m^1.5], shape (0:2*width + 1, modes)
      real(wp), allocatable :: past(:, :)
   end type stretch_t

   !> exp(-this) is nothing
   real(wp), parameter :: nothing = 42.0_wp
   !> Modes are evaluated in blocks of this size at most, which spares an allocation
   integer, parameter :: block = 32

   !> The approach
   type :: approach_t
      !> Time of its end, the largest indentation [s]
      real(wp) :: end = 0.0_wp
      !> w_k at its end [m], shape (modes)
      real(wp), allocatable :: w(:)
      !> p_k at its end [m^1.5], shape (modes)
      real(wp), allocatable, private :: p(:)
      !> Number of panels
      integer, private :: count = 0
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
      !> Another t1
      procedure :: moved
   end type approach_t

contains

   !> Add a panel
   subroutine add(self, rule, map, scale, contact, panel, start_rate, rate)
      !> The approach
      class(approach_t), intent(inout) :: self
      !> Collocation rule
      type(collocation_t), intent(in) :: rule
      !> Map of the panel
      type(panel_map_t), intent(in) :: map
      !> Scale of the map [s]
      real(wp), intent(in) :: scale
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: contact
      !> The panel
      type(panel_t), intent(in) :: panel
      !> Rate of the indentation at the start [m/s]
      real(wp), intent(in) :: start_rate
      !> Rate of the indentation at the stages [m/s]
      real(wp), intent(in) :: rate(:)

      integer, parameter :: usual = 8
      type(stretch_t), allocatable :: longer(:)
      real(wp), dimension(width) :: s, u, lambda, lag
      integer :: k, stages

      stages = rule%stages
      if (.not. allocated(self%stretch)) then
         self%stages = stages
         self%point = rule%point
         self%barycentric = rule%barycentric
         allocate (self%stretch(usual), self%w(size(contact%rates)), self%p(size(contact%rates)))
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
         allocate (stretch%past(0:2*width + 1, size(self%w)))
         ! from what is gained in the panel: the modes that settle at once leave no digits of s
         s = apply(map%left, panel%indentation(1:) - panel%indentation(0))
         u = apply(map%left, hertz(panel%indentation(1:)) - hertz(panel%indentation(0)))
         lambda = scale*map%eigenvalue
         do k = 1, size(self%w)
            lag = ratio(map%square, constant(1.0_wp), constant(1.0_wp) + contact%rates(k)*lambda)
            stretch%past(0, k) = self%w(k)
            stretch%past(1:width, k) = apply(map%right, &
               times(map%square, s + self%w(k)*map%left_one, lag))
            stretch%past(width + 1, k) = self%p(k)
            stretch%past(width + 2:, k) = apply(map%right, &
               times(map%square, u + self%p(k)*map%left_one, lag))
            self%w(k) = stretch%past(stages, k)
            self%p(k) = stretch%past(width + 1 + stages, k)
         end do
      end associate
   end subroutine add

   !> Force and condition by t1, and their derivatives
   pure subroutine evaluate(self, contact, t, t1, condition, force, slope, rate)
      !> The approach
      class(approach_t), intent(in) :: self
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: contact
      !> Time [s]
      real(wp), intent(in) :: t
      !> t1 [s], up to the end of the approach
      real(wp), intent(in) :: t1
      !> N [N/m^0.5]
      real(wp), intent(out) :: condition
      !> F [N]
      real(wp), intent(out) :: force
      !> dF/dN [m^0.5]
      real(wp), intent(out) :: slope
      !> dN/dt1 [N/(m^0.5 s)]
      real(wp), intent(out) :: rate

      real(wp) :: basis(0:width), past(0:2*width + 1), share(block)
      real(wp) :: theta, offset, elapsed, s, velocity
      integer :: i, j, k, n, active

      elapsed = t - max(t1, 0.0_wp)
      do active = size(contact%rates), 1, -1
         if (contact%rates(active)*elapsed <= nothing) exit
      end do
      do j = self%count, 2, -1
         if (t1 >= self%stretch(j)%start) exit
      end do
      associate (stretch => self%stretch(j))
         past = 0.0_wp
         rate = contact%equilibrium
         k = 0
         do while (k < active)
            n = min(block, active - k)
            share(:n) = contact%moduli(k + 1:k + n)*exp(-contact%rates(k + 1:k + n)*elapsed)
            do i = 1, n
               rate = rate + share(i)
               past = past + share(i)*stretch%past(:, k + i)
            end do
            k = k + n
         end do
         if (t1 > 0.0_wp) then
            offset = t1 - stretch%start
            theta = 2.0_wp*offset/(stretch%map(1) &
               + sqrt(stretch%map(1)**2 + 4.0_wp*stretch%map(2)*offset))
            basis = basis_at(self, theta)
            s = sum(basis*stretch%s)
            condition = contact%equilibrium*s + sum(basis*past(:width))
            force = contact%equilibrium*hertz(s) + sum(basis*past(width + 1:))
            velocity = sum(basis*stretch%rate)
         else
            velocity = stretch%rate(0)
            s = velocity*t1
            condition = rate*s
            force = rate*hertz(s)
         end if
      end associate
      slope = 1.5_wp*sqrt(abs(s))
      rate = rate*velocity
   end subroutine evaluate

   !> Lagrange's polynomials at a position in a panel
   pure function basis_at(self, theta) result(basis)
      !> The approach
      class(approach_t), intent(in) :: self
      !> Position
      real(wp), intent(in) :: theta
      !> Their values
      real(wp) :: basis(0:width)

      real(wp) :: before, after
      integer :: i

      before = 1.0_wp
      do i = 0, width
         basis(i) = self%barycentric(i)*before
         before = before*(theta - self%point(i))
      end do
      after = 1.0_wp
      do i = self%stages, 0, -1
         basis(i) = basis(i)*after
         after = after*(theta - self%point(i))
      end do
   end function basis_at

   !> The t1 at which the condition has changed by a given amount, next to a known one: N is about a
   !> parabola with its vertex at the end of the approach, where s' is zero
   pure function moved(self, t1, change, rate) result(other)
      !> The approach
      class(approach_t), intent(in) :: self
      !> Known t1 [s]
      real(wp), intent(in) :: t1
      !> Change of N [N/m^0.5]
      real(wp), intent(in) :: change
      !> dN/dt1 there [N/(m^0.5 s)]
      real(wp), intent(in) :: rate
      !> Other t1 [s], less than the end
      real(wp) :: other

      ! share of the way to the vertex that is gone at most, and the longest way back over the
      ! time of the approach
      real(wp), parameter :: closest = 0.9_wp, farthest = 1.0e3_wp
      real(wp) :: way, whole

      way = self%end - t1
      whole = rate*way
      if (.not. whole > 0.0_wp) then
         other = self%end - 2.0_wp*abs(way)
      else if (2.0_wp*change >= (1.0_wp - (1.0_wp - closest)**2)*whole) then
         other = t1 + closest*way
      else if (.not. t1 > 0.0_wp .or. -change > farthest*whole) then
         other = t1 - farthest*self%end
         if (-change < farthest*self%end*rate) other = t1 + change/rate
      else
         other = t1 + way*(1.0_wp - sqrt(1.0_wp - 2.0_wp*change/whole))
      end if
   end function moved

end module vcor_solver_approach
