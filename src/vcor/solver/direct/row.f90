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
   use vcor_solver_direct_recovery, only : recovery_t
   implicit none
   private

   public :: dent_row_t

   !> The springs at the newest node
   type :: dent_row_t
      !> Whether they are a row of springs in s, otherwise one in u
      logical, private :: recedes = .false.
      !> Whether only that of the row which is touched first is followed
      logical, private :: alone = .false.
      !> Force over the compression of the last step, phi = stiffness (w - level) [N/m^1.5], of all,
      !> or of all but the dashpot
      real(wp) :: stiffness = 0.0_wp
      !> Equilibrium modulus and viscosity over the time step [N/m^1.5]
      real(wp), private :: equilibrium = 0.0_wp, drag = 0.0_wp
      !> Moduli G_k [N/m^1.5], decays exp(-l_k dt), and weights of the change of w over a step, and
      !> of that over the step before, in the lags, shape (modes)
      real(wp), allocatable, private :: modulus(:), decay(:), weight(:), bend(:)
      !> Rates times step l_k dt, and lags of one spring before the newest step, shape (modes)
      real(wp), allocatable, private :: phase(:), before(:)
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
      procedure :: set_step
      procedure :: set
      procedure :: recover
      procedure :: recovery_of_first
      procedure :: is_untouched
      procedure :: begin_pressing
      procedure :: elastic_force
      procedure :: cut
      procedure :: has_one_spring
      procedure :: stiffness_without_dashpot
      procedure :: find_levels
      procedure :: press
      procedure :: accept
      procedure :: surface
      procedure :: compression
      procedure :: depth_of
      procedure :: modes
   end type dent_row_t

contains

   !> Set up springs that nothing has touched
   subroutine prepare(self, terms, law, dt, spacing)
      class(dent_row_t), intent(out) :: self
      !> Kernel of the contact [N/m^1.5]
      type(exponential_sum_t), intent(in) :: terms
      type(contact_law_t), intent(in) :: law
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Distance between springs of a row, at least [m]
      real(wp), intent(in) :: spacing

      ! springs for which there is room at first
      integer, parameter :: usual = 64
      integer :: room

      ! an elastic contact has one force whatever its past was
      self%recedes = law%receding .and. (size(terms%rates) > 0 .or. terms%viscosity > 0.0_wp)
      self%spacing = spacing
      call self%set_step(terms, dt)
      room = merge(usual, 1, self%recedes)
      allocate (self%sigma(room), self%u(room), self%slope(room), self%w(room), self%change(room), &
         self%level(room), self%lag(room, size(terms%rates)))
      call touch(self, law, 0.0_wp, 0.0_wp)
   end subroutine prepare

   !> Set the length of the steps
   subroutine set_step(self, terms, dt)
      class(dent_row_t), intent(inout) :: self
      !> Kernel of the contact [N/m^1.5]
      type(exponential_sum_t), intent(in) :: terms
      !> Time step [s]
      real(wp), intent(in) :: dt

      real(wp) :: x(size(terms%rates))

      self%equilibrium = terms%equilibrium
      self%drag = terms%viscosity/dt
      self%modulus = terms%moduli
      x = terms%rates*dt
      self%phase = x
      self%decay = exp(-x)
      self%weight = part_of_step(x)
      ! int_0^1 exp(-x (1 - theta)) (theta - 1/2) dtheta
      self%bend = second_part(x) - 0.5_wp*self%weight
      self%stiffness = self%equilibrium + sum(self%modulus*(self%weight + self%bend)) &
         + 1.5_wp*self%drag
   end subroutine set_step

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
      class(dent_row_t), intent(inout) :: self
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
      class(dent_row_t), intent(in) :: self
      integer :: modes

      modes = size(self%decay)
   end function modes

   !> Set the state of the spring touched first, which alone is followed from then on: a force > 0
   !> says that it is touched
   subroutine set(self, w, change, lag)
      class(dent_row_t), intent(inout) :: self
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

   !> Let the dent recover in flight
   subroutine recover(self, recovery, time)
      class(dent_row_t), intent(inout) :: self
      !> That of this kernel
      type(recovery_t), intent(in) :: recovery
      !> Time [s]
      real(wp), intent(in) :: time

      integer :: j

      do j = 1, self%count
         call recovery%advance(time, self%w(j), self%lag(j, :))
      end do
      self%change(:self%count) = 0.0_wp
   end subroutine recover

   !> Amplitudes of the motions of the free spring touched first, whose compression is their sum
   pure function recovery_of_first(self, recovery) result(c)
      class(dent_row_t), intent(in) :: self
      !> That of this kernel
      type(recovery_t), intent(in) :: recovery
      !> Amplitudes, shape (motions)
      real(wp) :: c(size(recovery%rate))

      c = recovery%motions_of(self%w(1), self%lag(1, :))
   end function recovery_of_first

   !> Whether nothing noticeable is left of a dent
   pure function is_untouched(self, law, indentation)
      class(dent_row_t), intent(in) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation of the next contact [m]
      real(wp), intent(in) :: indentation
      logical :: is_untouched

      ! share of that indentation, four times epsilon, below which its force does not change
      real(wp), parameter :: negligible = 1.0e-15_wp
      real(wp) :: least

      least = negligible*indentation
      if (.not. self%recedes) least = negligible*law%u(indentation)
      is_untouched = maxval(abs(self%w(:self%count))) <= least &
         .and. all(abs(self%lag(:self%count, :)) <= least)
   end function is_untouched

   !> Begin a contact at a node, where a sphere meets a dent: what would have been pressed over a
   !> step before it makes the first parabola straight
   subroutine begin_pressing(self, law, s, travel)
      class(dent_row_t), intent(inout) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation, and its change over a step before [m]
      real(wp), intent(in) :: s, travel

      if (self%recedes) then
         self%change(1) = travel
      else
         self%change(1) = law%slope(s)*travel
      end if
   end subroutine begin_pressing

   !> Cut the newest step of one spring, over the rest of which it is straight
   subroutine cut(self, w, part, start)
      class(dent_row_t), intent(inout) :: self
      !> Compression at the end of the part [m^1.5]
      real(wp), intent(in) :: w
      !> Part of the step, 0 .. 1
      real(wp), intent(in) :: part
      !> Compression at its start [m^1.5]
      real(wp), intent(in) :: start

      self%w(1) = w
      self%lag(1, :) = exp(-part*self%phase)*self%before &
         + part_of_step(part*self%phase)*(w - start)
   end subroutine cut

   !> Whether the contact is one spring in u, as by Boltzmann's law
   pure function has_one_spring(self)
      class(dent_row_t), intent(in) :: self
      logical :: has_one_spring

      has_one_spring = .not. self%recedes
   end function has_one_spring

   !> Force over the compression of the last step without the dashpot
   pure function stiffness_without_dashpot(self) result(stiffness)
      class(dent_row_t), intent(in) :: self
      !> Stiffness [N/m^1.5]
      real(wp) :: stiffness

      stiffness = self%equilibrium + sum(self%modulus*(self%weight + self%bend))
   end function stiffness_without_dashpot

   !> Force of all but the dashpot in one spring in u at the newest node
   pure function elastic_force(self) result(force)
      class(dent_row_t), intent(in) :: self
      !> Force [N]
      real(wp) :: force

      force = self%equilibrium*self%w(1) + sum(self%modulus*self%lag(1, :))
   end function elastic_force

   !> Find the levels at the next node
   subroutine find_levels(self, with_dashpot)
      class(dent_row_t), intent(inout) :: self
      !> Whether the force of the dashpot is included; absent: it is
      logical, intent(in), optional :: with_dashpot

      real(wp) :: rest, drag
      integer :: k, j

      drag = self%drag
      if (present(with_dashpot)) then
         if (.not. with_dashpot) drag = 0.0_wp
         self%stiffness = self%stiffness_without_dashpot() + 1.5_wp*drag
      end if
      associate (n => self%count)
         rest = sum(self%modulus*self%bend) + 0.5_wp*drag
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
      class(dent_row_t), intent(in) :: self
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
      class(dent_row_t), intent(inout) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation there, and its change over the step [m]
      real(wp), intent(in) :: s, change

      real(wp) :: x, next, gained(self%count)
      integer :: j, k

      x = s
      if (.not. self%recedes) then
         x = law%u(s)
         self%before = self%lag(1, :)
      end if
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
      class(dent_row_t), intent(in) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation [m]
      real(wp) :: s

      s = self%depth_of(law, self%level(1))
   end function surface

   !> Indentation at which the spring touched first is as it is at the newest node
   function compression(self, law) result(s)
      class(dent_row_t), intent(in) :: self
      type(contact_law_t), intent(in) :: law
      !> Indentation [m]
      real(wp) :: s

      s = self%depth_of(law, self%w(1))
   end function compression

   !> Indentation that compresses the spring touched first
   function depth_of(self, law, w) result(s)
      class(dent_row_t), intent(in) :: self
      type(contact_law_t), intent(in) :: law
      !> Its compression
      real(wp), intent(in) :: w
      !> Indentation [m]
      real(wp) :: s

      s = w
      if (.not. self%recedes) s = law%inverse(max(0.0_wp, w))
   end function depth_of

end module vcor_solver_direct_row
