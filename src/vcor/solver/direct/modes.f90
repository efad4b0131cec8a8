!> Modes of a struck structure on equal steps, exactly for a force that is a parabola over each step
!>
!> The state y of an oscillator (`vcor_impact_structure`) is its eta and v, that of an exponential
!> its z. Over a step
!>
!>     y_n = A y_{n-1} + B_0 F_{n-1} + B_1 F_n + B_2 (F_n - 2 F_{n-1} + F_{n-2})
!>
!> from the matrix of the differential equations of the state. The part
!> A - 1 is computed and added: the rounding of A itself would be the same in every step, and add up
!> to the number of steps. What F_n adds at its own node is left out of the stored state, and added
!> with the next step, so that a step passes through the modes once. A mode that the steps do not
!> resolve follows the force as a spring: left undamped, it would ring with the corners of the
!> parabolas, and make a sphere hop from node to node.
module vcor_solver_direct_modes
   use vcor_impact_structure, only : state_of_modes_t, vibration_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: modes_t

   !> The parts of the structure of one kind at the newest node
   type :: parts_t
      !> Their state without what the force at that node adds, shape (number, components)
      real(wp), allocatable :: y(:, :)
      !> Step from state to change of the state, A - 1, shape (number, components, components)
      real(wp), allocatable :: a(:, :, :)
      !> Responses to the force at the start of the step, what it adds there included, and at the
      !> node before, shape (number, components), and at its end
      real(wp), allocatable :: start(:, :), before(:, :), end(:, :)
   contains
      procedure, private :: make_room
      procedure, private :: set_step
      procedure, private :: join
      procedure, private :: step
   end type parts_t

   !> The modes at the newest node
   type :: modes_t
      !> Oscillators [m, m/s] and exponentials [m]
      type(parts_t), private :: oscillators, exponentials
      !> Rates of the exponentials [1/s], shape (n)
      real(wp), allocatable, private :: rates(:)
      !> Deflection [m/N] and velocity [1/kg s] by the force at the node being solved
      real(wp) :: yield = 0.0_wp
      real(wp), private :: speed = 0.0_wp
      !> Force at the newest node [N]
      real(wp), private :: force = 0.0_wp
      !> Number of multiplications of a step
      real(wp) :: work = 0.0_wp
   contains
      procedure :: prepare
      procedure :: set
      procedure :: advance
      procedure :: accept
      procedure :: deflection
      procedure :: rate
      procedure :: state
   end type modes_t

contains

   !> Set up the modes at rest
   subroutine prepare(self, vibration, dt)
      class(modes_t), intent(out) :: self
      type(vibration_t), intent(in) :: vibration
      !> Time step [s]
      real(wp), intent(in) :: dt

      ! largest frequency times step: a third of that of a force which alternates from node to node.
      ! With half of it 18 random impacts on structures take half as many steps again; with twice as
      ! much the worst errs by 2.1 times what is stated, not 1.8
      real(wp), parameter :: fastest = 1.0_wp
      real(wp) :: matrix(2, 2), unit
      integer :: n, modes

      modes = vibration%modes()
      call self%oscillators%make_room(size(vibration%square), 2)
      call self%exponentials%make_room(size(vibration%rate), 1)
      self%rates = vibration%rate
      do n = 1, size(vibration%square)
         associate (square => vibration%square(n), damping => vibration%damping(n), &
                    yield => vibration%yield(n), jump => vibration%jump(n))
            if (n <= modes .and. sqrt(square)*dt > fastest .and. damping**2 < square) then
               self%oscillators%a(n, 1, 1) = -1.0_wp
               self%oscillators%a(n, 2, 2) = -1.0_wp
               self%oscillators%end(n, :) = [(yield + damping*jump)/square, -jump]
               cycle
            end if
            ! deflections in a unit that makes the matrix as small as it can be
            unit = max(sqrt(square), 1.0_wp/dt)
            matrix = reshape([0.0_wp, -square/unit, unit, -damping], [2, 2])
            call self%oscillators%set_step(n, dt, matrix, [unit*jump, yield])
            self%oscillators%a(n, 1, 2) = self%oscillators%a(n, 1, 2)/unit
            self%oscillators%a(n, 2, 1) = self%oscillators%a(n, 2, 1)*unit
            self%oscillators%start(n, 1) = self%oscillators%start(n, 1)/unit
            self%oscillators%before(n, 1) = self%oscillators%before(n, 1)/unit
            self%oscillators%end(n, 1) = self%oscillators%end(n, 1)/unit
         end associate
      end do
      do n = 1, size(vibration%rate)
         call self%exponentials%set_step(n, dt, reshape([-vibration%rate(n)], [1, 1]), &
            [vibration%weight(n)])
      end do
      call self%oscillators%join()
      call self%exponentials%join()
      self%yield = sum(self%oscillators%end(:, 1)) + sum(self%exponentials%end(:, 1))
      self%speed = sum(self%oscillators%end(:, 2)) &
         - sum(self%rates*self%exponentials%end(:, 1))
      self%work = real(10*size(vibration%square) + 4*size(vibration%rate), wp)
   end subroutine prepare

   !> Make room for parts at rest
   subroutine make_room(self, number, components)
      class(parts_t), intent(inout) :: self
      integer, intent(in) :: number, components

      allocate (self%y(number, components), self%start(number, components), &
         self%end(number, components), self%before(number, components), source=0.0_wp)
      allocate (self%a(number, components, components), source=0.0_wp)
   end subroutine make_room

   !> Set the step of a part, y' = B y + b F. The change D = A - 1 and the responses r_j to forces
   !> x^(j - 1)/(j - 1)!, with the time x since the start of a step, are Taylor's series for a step
   !> h that is a power of two shorter, and each two steps are one of twice the length, with
   !>
   !>     r_3: (2 + D) r_3 + h r_2 + h^2/2 r_1,   r_2: (2 + D) r_2 + h r_1,   r_1: (2 + D) r_1,
   !>     D: (2 + D) D
   subroutine set_step(self, n, dt, matrix, push)
      class(parts_t), intent(inout) :: self
      !> Number of the part
      integer, intent(in) :: n
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> B [1/s], shape (components, components), and b, shape (components)
      real(wp), intent(in) :: matrix(:, :), push(:)

      ! largest B h; 0.5^15/15! is below rounding
      real(wp), parameter :: small = 0.5_wp
      integer, parameter :: terms = 14
      real(wp), dimension(size(push), size(push)) :: b, change
      real(wp), dimension(size(push)) :: given, once, twice, thrice
      real(wp) :: h
      integer :: doublings, i

      doublings = max(0, exponent(dt*maxval(sum(abs(matrix), 1))/small))
      ! in units of the time step
      h = 0.5_wp**doublings
      b = (h*dt)*matrix
      given = (h*dt)*push
      change = 0.0_wp
      thrice = 0.0_wp
      do i = terms, 1, -1
         change = (b + matmul(b, change))/real(i, wp)
         thrice = (given + matmul(b, thrice))/real(i + 3, wp)
      end do
      thrice = (given + matmul(b, thrice))/6.0_wp
      twice = 0.5_wp*given + matmul(b, thrice)
      once = given + matmul(b, twice)
      twice = h*twice
      thrice = h**2*thrice
      do i = 1, doublings
         thrice = 2.0_wp*thrice + matmul(change, thrice) + h*(twice + 0.5_wp*h*once)
         twice = 2.0_wp*twice + matmul(change, twice) + h*once
         once = 2.0_wp*once + matmul(change, once)
         change = 2.0_wp*change + matmul(change, change)
         h = 2.0_wp*h
      end do
      self%a(n, :, :) = change
      ! a parabola through the node before, the start and the end of the step adds (x^2 - x)/2 times
      ! its second difference to a line
      self%before(n, :) = thrice - 0.5_wp*twice
      self%start(n, :) = once - twice - 2.0_wp*self%before(n, :)
      self%end(n, :) = twice + self%before(n, :)
   end subroutine set_step

   !> Join what a force adds at its node to its response in the next step
   pure subroutine join(self)
      class(parts_t), intent(inout) :: self

      integer :: i, j

      do i = 1, size(self%end, 2)
         self%start(:, i) = self%start(:, i) + self%end(:, i)
         do j = 1, size(self%end, 2)
            self%start(:, i) = self%start(:, i) + self%a(:, i, j)*self%end(:, j)
         end do
      end do
   end subroutine join

   !> Set the state
   pure subroutine set(self, state, force)
      class(modes_t), intent(inout) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Force at that node [N]
      real(wp), intent(in) :: force

      self%oscillators%y(:, 1) = state%eta
      self%oscillators%y(:, 2) = state%rate
      self%exponentials%y(:, 1) = state%lag
      self%oscillators%y = self%oscillators%y - force*self%oscillators%end
      self%exponentials%y = self%exponentials%y - force*self%exponentials%end
      self%force = force
   end subroutine set

   !> Advance to the next node without the force there
   pure subroutine advance(self, before)
      class(modes_t), intent(inout) :: self
      !> Force at the node before the newest [N]
      real(wp), intent(in) :: before

      call self%oscillators%step(self%force, before)
      call self%exponentials%step(self%force, before)
      self%force = 0.0_wp
   end subroutine advance

   !> Advance parts to the next node without the force there
   pure subroutine step(self, force, before)
      class(parts_t), intent(inout) :: self
      !> Force at the last node and the node before [N]
      real(wp), intent(in) :: force, before

      associate (y => self%y, a => self%a, start => self%start, more => self%before)
         if (size(y, 2) == 1) then
            y(:, 1) = y(:, 1) + (a(:, 1, 1)*y(:, 1) + start(:, 1)*force + more(:, 1)*before)
         else
            call swing(size(y, 1), a(:, 1, 1), a(:, 1, 2), a(:, 2, 1), a(:, 2, 2), &
               start(:, 1), start(:, 2), more(:, 1), more(:, 2), force, before, y(:, 1), y(:, 2))
         end if
      end associate
   end subroutine step

   !> Advance oscillators: arguments apart, for loops over several at once
   pure subroutine swing(n, a_11, a_12, a_21, a_22, start_1, start_2, more_1, more_2, force, &
                         before, y_1, y_2)
      !> Number
      integer, intent(in) :: n
      !> Step from state to change of the state
      real(wp), intent(in) :: a_11(n), a_12(n), a_21(n), a_22(n)
      !> Responses of both components to the force at the start and at the node before
      real(wp), intent(in) :: start_1(n), start_2(n), more_1(n), more_2(n)
      !> Force at both [N]
      real(wp), intent(in) :: force, before
      !> State
      real(wp), intent(inout) :: y_1(n), y_2(n)

      real(wp) :: one, other
      integer :: i

      if (max(force, before) > 0.0_wp) then
         do i = 1, n
            one = a_11(i)*y_1(i) + a_12(i)*y_2(i) + start_1(i)*force + more_1(i)*before
            other = a_21(i)*y_1(i) + a_22(i)*y_2(i) + start_2(i)*force + more_2(i)*before
            y_1(i) = y_1(i) + one
            y_2(i) = y_2(i) + other
         end do
      else
         ! the responses need not be read in flight
         do i = 1, n
            one = a_11(i)*y_1(i) + a_12(i)*y_2(i)
            other = a_21(i)*y_1(i) + a_22(i)*y_2(i)
            y_1(i) = y_1(i) + one
            y_2(i) = y_2(i) + other
         end do
      end if
   end subroutine swing

   !> Complete the state with the force at the new node
   pure subroutine accept(self, force)
      class(modes_t), intent(inout) :: self
      !> Force there [N]
      real(wp), intent(in) :: force

      self%force = force
   end subroutine accept

   !> Deflection at the newest node, at the one being solved without the force there
   pure function deflection(self)
      class(modes_t), intent(in) :: self
      !> Deflection [m]
      real(wp) :: deflection

      deflection = total(self%oscillators%y(:, 1)) + total(self%exponentials%y(:, 1)) &
         + self%yield*self%force
   end function deflection

   !> Velocity of the struck point in the modes at the newest node
   pure function rate(self)
      class(modes_t), intent(in) :: self
      !> Velocity [m/s]
      real(wp) :: rate

      rate = total(self%oscillators%y(:, 2)) - sum(self%rates*self%exponentials%y(:, 1)) &
         + self%speed*self%force
   end function rate

   !> Sum of many numbers, in parts that do not wait for each other
   pure function total(values)
      real(wp), contiguous, intent(in) :: values(:)
      real(wp) :: total

      ! two registers of four numbers: the values come from memory
      integer, parameter :: parts = 8
      real(wp) :: part(parts)
      integer :: n, whole

      whole = size(values) - mod(size(values), parts)
      part = 0.0_wp
      do n = 1, whole, parts
         part = part + values(n:n + parts - 1)
      end do
      total = sum(part) + sum(values(whole + 1:))
   end function total

   !> State at the newest node
   pure function state(self)
      class(modes_t), intent(in) :: self
      type(state_of_modes_t) :: state

      associate (one => self%oscillators, other => self%exponentials)
         allocate (state%eta, source=one%y(:, 1) + self%force*one%end(:, 1))
         allocate (state%rate, source=one%y(:, 2) + self%force*one%end(:, 2))
         allocate (state%lag, source=other%y(:, 1) + self%force*other%end(:, 1))
      end associate
   end function state

end module vcor_solver_direct_modes
