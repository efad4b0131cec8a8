!> The approach of a contact that recedes, as its rebound needs it
!>
!> While the contact shrinks, force and condition are integrals over the approach up to a time t1,
!> and both follow from the lags p_k of u and w_k of s at t1:
!>
!>   F = G_0 u(t1) + sum_k G_k p_k(t1) exp(-l_k (t - t1))
!>   N = G_0 s(t1) + sum_k G_k w_k(t1) exp(-l_k (t - t1))
!>
!> At a given time dF/dt1 = k(t - t1) u'(t1) and dN/dt1 = k(t - t1) s'(t1), so F is a function of N
!> with the slope du/ds at s(t1), which is regular where s' is zero. F goes to zero as u(N) when t1
!> reaches 0, and is continued oddly, as if s = v0 t1 before first contact. The iterations of a
!> panel may ask for more than the largest N, which is that at the end of the approach. N goes on
!> from there as a straight line of t1, F as one of N.
!>
!> s is a polynomial in a panel, u is not. What is smoother than u is interpolated between the
!> nodes: of a mode that settles within the panel its lag p_k, of a slow one u - p_k.
module vcor_solver_ive_approach
   use vcor_impact_law, only : contact_law_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_radau_dense, only : width
   use vcor_numeric_radau_rule, only : rule_t, slots
   use vcor_solver_ive_lags, only : find_lags
   use vcor_solver_ive_panel, only : panel_t
   implicit none
   private

   public :: approach_t

   !> Number of points of a panel
   integer, parameter :: points = width + 1
   !> exp(-this) = 6e-19 is negligible
   real(wp), parameter :: gone = 42.0_wp

   !> One panel of the approach
   type :: stretch_t
      !> The panel: times, indentation and its rate
      type(panel_t) :: panel
      !> For each mode w_k [m] at the points, then p_k [m^1.5], or p_k - u of a slow mode,
      !> shape (2*points, modes)
      real(wp), allocatable :: lag(:, :)
      !> Whether a mode is slow in the panel, shape (modes)
      logical, allocatable :: slow(:)
   end type stretch_t

   !> The approach
   type :: approach_t
      !> Rule of its panels
      type(rule_t), pointer, private :: rule => null()
      !> Its end: time [s] and largest indentation [m]
      real(wp) :: end = 0.0_wp, depth = 0.0_wp
      !> Condition N there [N/m^0.5], and -s'' [m/s2]
      real(wp) :: condition = 0.0_wp, bend = 0.0_wp
      !> w_k [m] and p_k [m^1.5] there, shape (modes)
      real(wp), allocatable :: w(:)
      real(wp), allocatable, private :: p(:)
      !> Number of panels, and the panels
      integer, private :: count = 0
      type(stretch_t), allocatable, private :: stretch(:)
   contains
      procedure :: add
      procedure :: evaluate
      procedure :: moved
   end type approach_t

contains

   !> Add a panel
   subroutine add(self, rule, rates, panel)
      class(approach_t), intent(inout) :: self
      type(rule_t), intent(in), target :: rule
      !> Rates of the modes [1/s], shape (modes)
      real(wp), intent(in) :: rates(:)
      !> The panel, its velocity known
      type(panel_t), intent(in) :: panel

      ! panels for which there is room at first
      integer, parameter :: usual_panels = 8
      type(stretch_t), allocatable :: longer(:)
      complex(wp) :: s(slots), u(slots)
      real(wp) :: gained(width)
      integer :: k, n

      n = rule%stages
      if (self%count == 0) then
         self%rule => rule
         allocate (self%stretch(usual_panels), self%w(size(rates)), self%p(size(rates)))
         self%w = 0.0_wp
         self%p = 0.0_wp
      else if (self%count == size(self%stretch)) then
         allocate (longer(2*self%count))
         longer(:self%count) = self%stretch
         call move_alloc(longer, self%stretch)
      end if
      self%count = self%count + 1
      self%end = panel%time(n)
      self%depth = panel%indentation(n)
      self%bend = -panel%slope_at_end(rule, panel%velocity)
      associate (stretch => self%stretch(self%count), map => rule%map(panel%step%kind), &
                 time => panel%step%duration)
         stretch%panel = panel
         allocate (stretch%lag(2*points, size(rates)), stretch%slow(size(rates)))
         stretch%lag = 0.0_wp
         stretch%slow = rates*time < real(n, wp)
         gained = 0.0_wp
         gained(:n) = panel%indentation(1:n) - panel%indentation(0)
         s = map%decompose(gained)
         gained(:n) = panel%u(1:n) - panel%u(0)
         u = map%decompose(gained)
         do k = 1, size(rates)
            stretch%lag(1, k) = self%w(k)
            call find_lags(map, time, rates(k), s, self%w(k), stretch%lag(2:points, k))
            stretch%lag(points + 1, k) = self%p(k)
            call find_lags(map, time, rates(k), u, self%p(k), stretch%lag(points + 2:, k))
            self%w(k) = stretch%lag(n + 1, k)
            self%p(k) = stretch%lag(points + n + 1, k)
            if (.not. stretch%slow(k)) cycle
            stretch%lag(points + 1:points + n + 1, k) = stretch%lag(points + 1:points + n + 1, k) &
               - panel%u(:n)
         end do
      end associate
   end subroutine add

   !> Condition and force as functions of t1, and their derivatives, at the stages of a panel
   pure subroutine evaluate(self, law, stages, contact, t, t1, condition, force, slope, rate)
      class(approach_t), intent(in) :: self
      type(contact_law_t), intent(in) :: law
      !> Number of stages
      integer, intent(in) :: stages
      !> Kernel [N/m^1.5]
      type(exponential_sum_t), intent(in) :: contact
      !> Times [s]
      real(wp), intent(in) :: t(width)
      !> t1 [s], up to the end of the approach
      real(wp), intent(in) :: t1(width)
      !> N [N/m^0.5], F [N], dF/dN [m^0.5] and dN/dt1 [N/(m^0.5 s)]; zero beyond the stages
      real(wp), dimension(width), intent(out) :: condition, force, slope, rate

      real(wp) :: basis(0:width), total(2*points), s(width), u(width), elapsed
      real(wp), dimension(width) :: stiffness, resolved
      integer :: i, k

      s = 0.0_wp
      stiffness = contact%equilibrium
      resolved = contact%equilibrium
      condition = 0.0_wp
      force = 0.0_wp
      rate = 0.0_wp
      do i = 1, stages
         do k = self%count, 2, -1
            if (t1(i) >= self%stretch(k)%panel%time(0)) exit
         end do
         ! t1 of an unfinished iteration may be anywhere
         elapsed = max(t(i) - max(t1(i), 0.0_wp), 0.0_wp)
         associate (stretch => self%stretch(k))
            call add_modes(contact, elapsed, stretch, stiffness(i), resolved(i), total)
            if (t1(i) > 0.0_wp) then
               basis = self%rule%basis(stretch%panel%theta(min(t1(i), self%end)))
               s(i) = sum(basis*stretch%panel%indentation)
               rate(i) = stiffness(i)*sum(basis*stretch%panel%velocity)
               condition(i) = sum(basis*total(:points))
               force(i) = sum(basis*total(points + 1:))
            else
               s(i) = stretch%panel%velocity(0)*t1(i)
               rate(i) = stiffness(i)*stretch%panel%velocity(0)
            end if
         end associate
      end do
      call law%evaluate(width, s, u, slope)
      u = s*u
      where (t1 >= self%end)
         ! with this rate the way back over a parabola with the vertex at the end is known, too; the
         ! moduli of a fitted sum have both signs
         rate = abs(stiffness)*self%bend*self%end
         condition = condition + contact%equilibrium*s
         force = force + resolved*u + slope*rate*(t1 - self%end)
         condition = condition + rate*(t1 - self%end)
      else where (t1 > 0.0_wp)
         condition = condition + contact%equilibrium*s
         force = force + resolved*u
      else where
         condition = stiffness*s
         force = stiffness*u
      end where
   end subroutine evaluate

   !> Sums over the modes that have not relaxed
   pure subroutine add_modes(contact, elapsed, stretch, stiffness, resolved, total)
      !> Kernel [N/m^1.5]
      type(exponential_sum_t), intent(in) :: contact
      !> Time since t1 [s]
      real(wp), intent(in) :: elapsed
      !> The panel that t1 lies in
      type(stretch_t), intent(in) :: stretch
      !> Stiffness, to which the decayed moduli are added, and that of slow modes alone [N/m^1.5]
      real(wp), intent(inout) :: stiffness, resolved
      !> Sums of the lags
      real(wp), intent(out) :: total(2*points)

      real(wp) :: share
      integer :: k, j

      total = 0.0_wp
      do k = 1, size(contact%rates)
         if (contact%rates(k)*elapsed > gone) cycle
         share = contact%moduli(k)*exp(-contact%rates(k)*elapsed)
         stiffness = stiffness + share
         if (stretch%slow(k)) resolved = resolved + share
         do j = 1, 2*points
            total(j) = total(j) + share*stretch%lag(j, k)
         end do
      end do
   end subroutine add_modes

   !> The t1 at which the condition has changed by a given amount from a known one: N is about a
   !> parabola with its vertex at the end of the approach, where s' is zero, and a straight line
   !> beyond
   pure function moved(self, t1, change, rate) result(other)
      class(approach_t), intent(in) :: self
      !> Known t1 [s]
      real(wp), intent(in) :: t1
      !> Change of N [N/m^0.5]
      real(wp), intent(in) :: change
      !> dN/dt1 there [N/(m^0.5 s)]
      real(wp), intent(in) :: rate
      !> Other t1 [s]
      real(wp) :: other

      ! distance before the end at which no digit of the approach is left
      real(wp), parameter :: farthest = 1.0_wp/epsilon(1.0_wp)
      real(wp) :: way, whole, beyond

      way = self%end - t1
      whole = 0.5_wp*rate*way
      if (.not. way > 0.0_wp) then
         beyond = change - rate*way
         other = self%end + beyond/rate
         if (beyond < 0.0_wp) &
            other = self%end*(1.0_wp - sqrt(-2.0_wp*beyond/(self%end*rate)))
      else if (.not. whole > 0.0_wp) then
         other = self%end - 2.0_wp*way
      else if (change >= whole) then
         other = self%end + (change - whole)/rate*(way/self%end)
      else if (.not. t1 > 0.0_wp .or. -change > farthest*whole) then
         other = t1 - farthest*self%end
         if (-change < farthest*self%end*rate) other = t1 + change/rate
      else
         other = t1 + way*(1.0_wp - sqrt(1.0_wp - change/whole))
      end if
   end function moved

end module vcor_solver_ive_approach
