!> Contact, flight and the next contact as one: springs that keep the dent, with internal variables
!>
!> A spring with the compression w carries phi = int_0^t k(t - x) w'(x) dx for a kernel k that is a
!> sum of exponentials. Pressed, it has the compression x that the body gives it; free, it carries
!> no force and recovers:
!>
!>     phi = G_0 w + sum_k G_k p_k + eta w',   p_k' = w' - l_k p_k,   w = max(x, level)
!>
!> with the `level` at which phi = 0. By Boltzmann's law the contact is one spring with x = u(s); by
!> the receding law a row of springs with x = s - sigma, as in `vcor_solver_direct_springs`, and
!> F = int max(0, phi) u''(sigma) dsigma. On each step w is the parabola through its ends and the
!> node before. Nothing is switched where a contact ends or begins.
module vcor_solver_direct_row
   use vcor_impact_law, only : contact_law_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   implicit none
   private

   public :: row_t

   !> The springs at the newest node
   type :: row_t
      !> Whether they are a row of springs in s, otherwise one in u
      logical, private :: recedes = .false.
      !> Whether only that of the row which is touched first is followed
      logical, private :: alone = .false.
      !> Force over the compression of the last step, phi = stiffness (w - level) [N/m^1.5]
      real(wp) :: stiffness = 0.0_wp
      !> Equilibrium modulus and viscosity over the time step [N/m^1.5]
      real(wp), private :: equilibrium = 0.0_wp, drag = 0.0_wp
      !> Moduli G_k [N/m^1.5], decays exp(-l_k dt), and weights of the change of w over a step, and
      !> of that over the step before, in the lags, shape (modes)
      real(wp), allocatable, private :: modulus(:), decay(:), weight(:), bend(:)
      !> Number of springs
      integer :: count = 0
      !> Indentation sigma at first touch [m], u and du/ds there, compression w, its last change,
      !> and the level, shape (>= count)
      real(wp), allocatable, private :: sigma(:), u(:), slope(:), w(:), change(:), level(:)
      !> Lags p_k, shape (>= count, modes)
      real(wp), allocatable, private :: lag(:, :)
      !> Distance between springs [m]
      real(wp), private :: spacing = 0.0_wp
   contains
      procedure :: prepare
      procedure :: set
      procedure :: find_levels
      procedure :: press
      procedure :: accept
      procedure :: surface
      procedure :: modes
   end type row_t

contains

   !> Set up springs that nothing has touched
   subroutine prepare(self, terms, law, dt, spacing)
      class(row_t), intent(out) :: self
      !> Kernel of the contact [N/m^1.5]
      type(exponential_sum_t), intent(in) :: terms
      type(contact_law_t), intent(in) :: law
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Distance between springs of a row, at least [m]
      real(wp), intent(in) :: spacing

      integer, parameter :: usual = 64
      real(wp) :: x(size(terms%rates))
      integer :: room

      ! an elastic contact has one force whatever its past was
      self%recedes = law%receding .and. (size(terms%rates) > 0 .or. terms%viscosity > 0.0_wp)
      self%spacing = spacing
      self%equilibrium = terms%equilibrium
      self%drag = terms%viscosity/dt
      self%modulus = terms%moduli
      x = terms%rates*dt
      self%decay = exp(-x)
      self%weight = part_of_step(x)
      ! int_0^1 exp(-x (1 - theta)) (theta - 1/2) dtheta
      self%bend = second_part(x) - 0.5_wp*self%weight
      self%stiffness = self%equilibrium + sum(self%modulus*(self%weight + self%bend)) &
         + 1.5_wp*self%drag
      room = merge(usual, 1, self%recedes)
      allocate (self%sigma(room), self%u(room), self%slope(room), self%w(room), self%change(room), &
         self%level(room), self%lag(room, size(x)))
      call touch(self, law, 0.0_wp, 0.0_wp)
   end subroutine prepare

   !> (1 - exp(-x))/x
   elemental function part_of_step(x) result(part)
      !> Rate times step, > 0
      real(wp), intent(in) :: x
      real(wp) :: part

      real(wp) :: half

      half = tanh(0.5_wp*x)
      part = 2.0_wp*half/((1.0_wp + half)*x)
   end function part_of_step

   !> int_0^1 exp(-x (1 - theta)) theta dtheta = (1 - part)/x, by its series for small x
   elemental function second_part(x) result(part)
      !> Rate times step, > 0
      real(wp), intent(in) :: x
      real(wp) :: part

      real(wp) :: term
      integer :: i

      if (x > 0.5_wp) then
         part = (1.0_wp - part_of_step(x))/x
         return
      end if
      part = 0.0_wp
      term = 0.5_wp
      do i = 3, 18
         part = part + term
         term = -term*x/real(i, wp)
      end do
   end function second_part

   !> Add a spring
   subroutine touch(self, law, s, change)
      class(row_t), intent(inout) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation at first touch, and its last change [m]
      real(wp), intent(in) :: s, change

      real(wp), allocatable :: longer(:, :)

      if (self%count == size(self%sigma)) then
         self%sigma = [self%sigma, self%sigma]
         self%u = [self%u, self%u]
         self%slope = [self%slope, self%slope]
         self%w = [self%w, self%w]
         self%change = [self%change, self%change]
         self%level = [self%level, self%level]
         allocate (longer(2*self%count, size(self%decay)))
         longer(:self%count, :) = self%lag
         call move_alloc(longer, self%lag)
      end if
      self%count = self%count + 1
      associate (n => self%count)
         self%sigma(n) = s
         self%u(n) = law%u(s)
         self%slope(n) = law%slope(s)
         self%w(n) = 0.0_wp
         self%change(n) = change
         self%level(n) = 0.0_wp
         self%lag(n, :) = 0.0_wp
      end associate
   end subroutine touch

   !> Number of modes of the kernel
   pure function modes(self)
      class(row_t), intent(in) :: self
      integer :: modes

      modes = size(self%decay)
   end function modes

   !> Set the state of the spring touched first, which alone is followed from then on: a force > 0
   !> says that it is touched
   subroutine set(self, w, change, lag)
      class(row_t), intent(inout) :: self
      !> Its compression and the last change of it
      real(wp), intent(in) :: w, change
      !> Its lags, shape (modes)
      real(wp), intent(in) :: lag(:)

      ! where a contact ends, all others are free, and none has recovered less
      self%alone = self%recedes
      self%w(1) = w
      self%change(1) = change
      self%lag(1, :) = lag
   end subroutine set

   !> Find the levels at the next node
   subroutine find_levels(self)
      class(row_t), intent(inout) :: self

      real(wp) :: rest
      integer :: k, j

      associate (n => self%count)
         rest = sum(self%modulus*self%bend) + 0.5_wp*self%drag
         do j = 1, n
            self%level(j) = self%equilibrium*self%w(j) - rest*self%change(j)
         end do
         do k = 1, size(self%decay)
            do j = 1, n
               self%level(j) = self%level(j) + (self%modulus(k)*self%decay(k))*self%lag(j, k)
            end do
         end do
         self%level(:n) = self%sigma(:n) + self%w(:n) - self%level(:n)/self%stiffness
      end associate
   end subroutine find_levels

   !> Force over `stiffness`, and its derivative by s: for a row int max(0, s - level) u'' dsigma,
   !> with the level linear between two springs
   subroutine press(self, law, s, value, slope)
      class(row_t), intent(in) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation [m]
      real(wp), intent(in) :: s
      !> Force over stiffness [m^1.5]
      real(wp), intent(out) :: value
      !> Its derivative [m^0.5]
      real(wp), intent(out) :: slope

      real(wp) :: x(2), sigma(2), u(2), du(2)
      integer :: j, k, n

      value = 0.0_wp
      slope = 0.0_wp
      if (self%alone) then
         value = max(0.0_wp, s - self%level(1))
         return
      else if (.not. self%recedes) then
         value = law%u(s) - self%level(1)
         if (value > 0.0_wp) slope = law%slope(s)
         value = max(0.0_wp, value)
         return
      end if
      n = self%count
      if (s > self%sigma(n)) then
         ! springs that are touched in this step: their level is sigma
         value = law%u(s) - self%u(n) - (s - self%sigma(n))*self%slope(n)
         slope = law%slope(s) - self%slope(n)
      end if
      do j = 1, n - 1
         x = s - self%level(j:j + 1)
         if (.not. max(x(1), x(2)) > 0.0_wp) cycle
         sigma = self%sigma(j:j + 1)
         u = self%u(j:j + 1)
         du = self%slope(j:j + 1)
         if (.not. min(x(1), x(2)) > 0.0_wp) then
            ! only some of the springs between these two are pressed
            k = merge(1, 2, x(1) < x(2))
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
      value = max(0.0_wp, value)
   end subroutine press

   !> Complete the springs with the indentation at the new node
   subroutine accept(self, law, s, change)
      class(row_t), intent(inout) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation there, and its change over the step [m]
      real(wp), intent(in) :: s, change

      real(wp) :: x, next, gained(self%count)
      integer :: j, k

      x = s
      if (.not. self%recedes) x = law%u(s)
      do j = 1, self%count
         next = max(x, self%level(j)) - self%sigma(j)
         gained(j) = next - self%w(j)
         self%w(j) = next
      end do
      do k = 1, size(self%decay)
         do j = 1, self%count
            self%lag(j, k) = self%decay(k)*self%lag(j, k) + (self%weight(k) + self%bend(k)) &
               *gained(j) - self%bend(k)*self%change(j)
         end do
      end do
      self%change(:self%count) = gained
      if (self%alone .or. .not. self%recedes) return
      if (s > self%sigma(self%count) + self%spacing) call touch(self, law, s, change)
   end subroutine accept

   !> Indentation at which the first contact begins or the last ends at the node being solved: that
   !> of the spring touched first
   function surface(self, law) result(s)
      class(row_t), intent(in) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation [m]
      real(wp) :: s

      s = self%level(1)
      if (.not. self%recedes) s = law%inverse(max(0.0_wp, self%level(1)))
   end function surface

end module vcor_solver_direct_row
