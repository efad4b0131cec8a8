!> The approach of a receding contact, as its rebound needs it
!>
!> While the contact shrinks, force and condition are integrals over the approach up to a time t1
!> (see `vcor_impact_problem`). For a kernel G_0 + sum_k G_k exp(-l_k t) both follow from the lags
!> at t1,
!>
!>   F = G_0 u(t1) + sum_k G_k p_k(t1) exp(-l_k (t - t1)),  p_k = int_0^t1 exp(-l_k (t1 - x)) u' dx
!>   N = G_0 s(t1) + sum_k G_k w_k(t1) exp(-l_k (t - t1)),  w_k = int_0^t1 exp(-l_k (t1 - x)) s' dx
!>
!> and the condition is that N equals the same integral over all the past, int_0^t k(t - x) s'(x)
!> dx. Since dF/dt1 = k(t - t1) u'(t1) and dN/dt1 = k(t - t1) s'(t1), F is a function of N with the
!> slope dF/dN = du/ds at s(t1), which is regular where s' is zero. F goes to zero as u(N) when t1
!> reaches 0, and is continued as an odd function, as if s = v0 t1 before first contact.
module vcor_solver_ive_approach
   use vcor_impact_law, only : contact_law_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_radau_algebra, only : apply, constant, ratio, times, width
   use vcor_numeric_radau_collocation, only : collocation_t
   use vcor_solver_ive_panel, only : panel_t, step_t
   use vcor_tuning, only : closest_to_vertex, gone
   implicit none
   private

   public :: approach_t

   !> One panel of the approach; index 0 is its start
   type :: stretch_t
      !> Time at the start [s]
      real(wp) :: start = 0.0_wp
      !> Map of time in the panel: start + map(1) theta + map(2) theta^2 [s]
      real(wp) :: map(2) = 0.0_wp
      !> Indentation at the points [m]
      real(wp) :: s(0:width) = 0.0_wp
      !> Rate of the indentation [m/s]
      real(wp) :: rate(0:width) = 0.0_wp
      !> For each mode w_k [m] at the points, then p_k [m^1.5], shape (2*points, modes)
      real(wp), allocatable :: past(:, :)
   end type stretch_t

   !> Number of points of a panel
   integer, parameter :: points = width + 1

   !> The approach
   type :: approach_t
      type(contact_law_t), private :: law
      !> Time of its end, the largest indentation [s]
      real(wp) :: end = 0.0_wp
      !> w_k at its end [m], shape (modes)
      real(wp), allocatable :: w(:)
      !> p_k at its end [m^1.5], shape (modes)
      real(wp), allocatable, private :: p(:)
      !> Moduli of the modes [N/m^1.5], followed by a zero if their number is odd, as they are
      !> summed in pairs
      real(wp), allocatable, private :: moduli(:)
      !> Rates of the modes [1/s], increasing, followed by a zero likewise
      real(wp), allocatable, private :: rates(:)
      !> Number of panels
      integer, private :: count = 0
      !> Points of a panel in theta
      real(wp), private :: point(0:width) = 0.0_wp
      !> Barycentric weights of the points
      real(wp), private :: barycentric(0:width) = 0.0_wp
      !> Panels
      type(stretch_t), allocatable, private :: stretch(:)
   contains
      procedure :: add
      procedure :: evaluate
      procedure :: moved
   end type approach_t

contains

   !> Add a panel
   subroutine add(self, law, rule, step, contact, panel, start_rate, rate)
      class(approach_t), intent(inout) :: self
      type(contact_law_t), intent(in) :: law
      type(collocation_t), intent(in) :: rule
      !> Step of the panel
      type(step_t), intent(in) :: step
      !> Kernel of the contact
      type(exponential_sum_t), intent(in) :: contact
      type(panel_t), intent(in) :: panel
      !> Rate of the indentation at the start [m/s]
      real(wp), intent(in) :: start_rate
      !> Rate of the indentation at the stages [m/s]
      real(wp), intent(in) :: rate(:)

      integer, parameter :: usual_panels = 8
      type(stretch_t), allocatable :: longer(:)
      real(wp), dimension(width) :: s, u, slope, lambda, lag
      integer :: k, stages

      stages = rule%stages
      if (.not. allocated(self%stretch)) then
         self%law = law
         self%point = rule%point
         self%barycentric = rule%barycentric
         allocate (self%stretch(usual_panels))
         allocate (self%w(size(contact%rates)), self%p(size(contact%rates)))
         self%w = 0.0_wp
         self%p = 0.0_wp
         self%moduli = in_pairs(contact%moduli)
         self%rates = in_pairs(contact%rates)
      else if (self%count == size(self%stretch)) then
         allocate (longer(2*self%count))
         longer(:self%count) = self%stretch
         call move_alloc(longer, self%stretch)
      end if
      self%count = self%count + 1
      self%end = panel%time(stages)
      associate (stretch => self%stretch(self%count), map => rule%map(step%index))
         stretch%start = panel%time(0)
         stretch%map = panel%map
         stretch%s = panel%indentation
         stretch%rate(0) = start_rate
         stretch%rate(1:stages) = rate(1:stages)
         allocate (stretch%past(2*points, size(self%rates)))
         stretch%past(:, size(self%w) + 1:) = 0.0_wp
         ! from increments in the panel, since modes that settle at once would leave no digits of s
         s = apply(map%left, panel%indentation(1:) - panel%indentation(0))
         call law%evaluate(width, panel%indentation(1:), u, slope)
         u = apply(map%left, panel%indentation(1:)*u - law%u(panel%indentation(0)))
         lambda = step%map_scale()*map%eigenvalue
         do k = 1, size(self%w)
            lag = ratio(map%square, constant(1.0_wp), constant(1.0_wp) + contact%rates(k)*lambda)
            stretch%past(1, k) = self%w(k)
            stretch%past(2:points, k) = apply(map%right, &
               times(map%square, s + self%w(k)*map%left_one, lag))
            stretch%past(points + 1, k) = self%p(k)
            stretch%past(points + 2:, k) = apply(map%right, &
               times(map%square, u + self%p(k)*map%left_one, lag))
            self%w(k) = stretch%past(stages + 1, k)
            self%p(k) = stretch%past(points + stages + 1, k)
         end do
      end associate
   end subroutine add

   !> Numbers followed by a zero if their number is odd
   pure function in_pairs(numbers)
      !> The numbers, shape (n)
      real(wp), intent(in) :: numbers(:)
      !> Padded numbers, shape (n + modulo(n, 2))
      real(wp), allocatable :: in_pairs(:)

      allocate (in_pairs(size(numbers) + modulo(size(numbers), 2)), source=0.0_wp)
      in_pairs(:size(numbers)) = numbers
   end function in_pairs

   !> Force and condition as functions of t1, and their derivatives, at the stages of a rebound
   !> panel
   pure subroutine evaluate(self, equilibrium, stages, t, t1, condition, force, slope, rate)
      class(approach_t), intent(in) :: self
      !> Modulus of the kernel at rate 0 [N/m^1.5]
      real(wp), intent(in) :: equilibrium
      !> Number of stages; values beyond are zero
      integer, intent(in) :: stages
      !> Times [s]
      real(wp), intent(in) :: t(width)
      !> t1 [s], up to the end of the approach
      real(wp), intent(in) :: t1(width)
      !> N [N/m^0.5]
      real(wp), intent(out) :: condition(width)
      !> F [N]
      real(wp), intent(out) :: force(width)
      !> dF/dN [m^0.5]
      real(wp), intent(out) :: slope(width)
      !> dN/dt1 [N/(m^0.5 s)]
      real(wp), intent(out) :: rate(width)

      real(wp) :: theta(width), basis(width, points), past(2*points)
      real(wp), dimension(width) :: s, root, velocity, stiffness, n_past, f_past
      real(wp) :: offset, elapsed
      integer :: panel(width), i, j, active

      theta = 0.0_wp
      do i = 1, stages
         do active = self%count, 2, -1
            if (t1(i) >= self%stretch(active)%start) exit
         end do
         panel(i) = active
         associate (stretch => self%stretch(panel(i)))
            offset = max(t1(i), 0.0_wp) - stretch%start
            theta(i) = 2.0_wp*offset/max(tiny(1.0_wp), stretch%map(1) &
               + sqrt(stretch%map(1)**2 + 4.0_wp*stretch%map(2)*offset))
         end associate
      end do
      basis = basis_at(self, theta)
      s = 0.0_wp
      velocity = 0.0_wp
      stiffness = equilibrium
      n_past = 0.0_wp
      f_past = 0.0_wp
      do i = 1, stages
         ! t1 of an unfinished iteration may be anywhere
         elapsed = max(t(i) - max(t1(i), 0.0_wp), 0.0_wp)
         do active = size(self%w), 1, -1
            if (self%rates(active)*elapsed <= gone) exit
         end do
         associate (stretch => self%stretch(panel(i)))
            past = 0.0_wp
            if (active > 0) call add_modes(active + modulo(active, 2), self%moduli, self%rates, &
               stretch%past, elapsed, stiffness(i), past)
            if (t1(i) > 0.0_wp) then
               do j = 1, points
                  s(i) = s(i) + basis(i, j)*stretch%s(j - 1)
                  velocity(i) = velocity(i) + basis(i, j)*stretch%rate(j - 1)
                  n_past(i) = n_past(i) + basis(i, j)*past(j)
                  f_past(i) = f_past(i) + basis(i, j)*past(points + j)
               end do
            else
               velocity(i) = stretch%rate(0)
               s(i) = velocity(i)*t1(i)
            end if
         end associate
      end do
      call self%law%evaluate(width, s, root, slope)
      where (t1 > 0.0_wp)
         condition = equilibrium*s + n_past
         force = equilibrium*(s*root) + f_past
      else where
         condition = stiffness*s
         force = stiffness*(s*root)
      end where
      rate = stiffness*velocity
   end subroutine evaluate

   !> Sum over the modes that have not relaxed
   pure subroutine add_modes(n, moduli, rates, past, elapsed, stiffness, total)
      !> Number of such modes, even, > 0
      integer, intent(in) :: n
      !> Their moduli [N/m^1.5]
      real(wp), intent(in) :: moduli(n)
      !> Their rates [1/s]
      real(wp), intent(in) :: rates(n)
      !> Their lags at t1, as in `stretch_t`
      real(wp), intent(in) :: past(2*points, n)
      !> Time since t1 [s]
      real(wp), intent(in) :: elapsed
      !> Stiffness, to which the decayed moduli are added [N/m^1.5]
      real(wp), intent(inout) :: stiffness
      !> Sums of the lags, to which those of these modes are added
      real(wp), intent(inout) :: total(2*points)

      ! exponentials computed at a time, which avoids an allocation; even
      integer, parameter :: block = 64
      real(wp) :: share(block)
      integer :: first, i, k

      do first = 0, n - 1, block
         do k = 1, min(block, n - first)
            share(k) = moduli(first + k)*exp(-rates(first + k)*elapsed)
         end do
         do k = 1, min(block, n - first), 2
            stiffness = stiffness + (share(k) + share(k + 1))
            do i = 1, 2*points
               total(i) = total(i) + (share(k)*past(i, first + k) &
                  + share(k + 1)*past(i, first + k + 1))
            end do
         end do
      end do
   end subroutine add_modes

   !> Lagrange polynomials at positions in a panel
   pure function basis_at(self, theta) result(basis)
      class(approach_t), intent(in) :: self
      !> Positions
      real(wp), intent(in) :: theta(width)
      !> Their values
      real(wp) :: basis(width, 0:width)

      real(wp) :: product(width)
      integer :: i, j

      product = 1.0_wp
      do j = 0, width
         do i = 1, width
            basis(i, j) = self%barycentric(j)*product(i)
            product(i) = product(i)*(theta(i) - self%point(j))
         end do
      end do
      product = 1.0_wp
      do j = width, 0, -1
         do i = 1, width
            basis(i, j) = basis(i, j)*product(i)
            product(i) = product(i)*(theta(i) - self%point(j))
         end do
      end do
   end function basis_at

   !> The t1 at which the condition has changed by a given amount from a known one: N is about a
   !> parabola with its vertex at the end of the approach, where s' is zero
   pure function moved(self, t1, change, rate) result(other)
      class(approach_t), intent(in) :: self
      !> Known t1 [s]
      real(wp), intent(in) :: t1
      !> Change of N [N/m^0.5]
      real(wp), intent(in) :: change
      !> dN/dt1 there [N/(m^0.5 s)]
      real(wp), intent(in) :: rate
      !> Other t1 [s], less than the end
      real(wp) :: other

      ! distance before the end at which no digit of the approach is left
      real(wp), parameter :: farthest = 1.0_wp/epsilon(1.0_wp)
      real(wp) :: way, whole

      way = self%end - t1
      whole = rate*way
      if (.not. whole > 0.0_wp) then
         other = self%end - 2.0_wp*abs(way)
      else if (2.0_wp*change >= (1.0_wp - (1.0_wp - closest_to_vertex)**2)*whole) then
         other = t1 + closest_to_vertex*way
      else if (.not. t1 > 0.0_wp .or. -change > farthest*whole) then
         other = t1 - farthest*self%end
         if (-change < farthest*self%end*rate) other = t1 + change/rate
      else
         other = t1 + way*(1.0_wp - sqrt(1.0_wp - 2.0_wp*change/whole))
      end if
   end function moved

end module vcor_solver_ive_approach
