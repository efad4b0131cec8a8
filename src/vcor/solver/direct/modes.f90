!> Modes of a struck structure on equal steps, exactly for a force that is a parabola over each step
!>
!> The state y of a mode is its deflection, its rate and the lags of its material. Over a step
!>
!>     y_n = A y_{n-1} + B_0 F_{n-1} + B_1 F_n + B_2 (F_n - 2 F_{n-1} + F_{n-2})
!>
!> with the exponential of the matrix of the differential equations of state and force. A mode that
!> the steps do not resolve follows the force as a spring: left undamped, it would ring with the
!> corners of the parabolas, and make a sphere hop from node to node.
module vcor_solver_direct_modes
   use vcor_impact_structure, only : state_of_modes_t, vibration_t
   use vcor_kinds, only : wp
   implicit none
   private

   public :: modes_t

   !> The modes at the newest node
   type :: modes_t
      !> The deflections [m], their rates [m/s] and lags [m], shape (modes, parts)
      real(wp), allocatable, private :: y(:, :)
      !> The same at the node being solved, without the force there
      real(wp), allocatable, private :: known(:, :)
      !> Step from state to state, shape (modes, parts, parts)
      real(wp), allocatable, private :: a(:, :, :)
      !> Responses to the force at the start of the step and at the node before, shape
      !> (modes, parts), and at its end
      real(wp), allocatable, private :: start(:, :), before(:, :), end(:, :)
      !> Deflection by the force at the node being solved [m/N]
      real(wp) :: yield = 0.0_wp
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

      ! responses to a force that falls from 1 to 0, that rises to 1, and (x^2 - x)/2
      real(wp), parameter :: force(3, 3) = reshape([1.0_wp, -1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp, &
         0.0_wp, 0.0_wp, -0.5_wp, 1.0_wp], [3, 3])
      ! largest frequency times step: a third of that of a force which alternates from node to node
      real(wp), parameter :: fastest = 1.0_wp
      real(wp), allocatable :: matrix(:, :), answer(:, :)
      real(wp) :: unit
      integer :: modes, parts, n, i

      modes = size(vibration%square)
      parts = 2 + size(vibration%rate)
      allocate (self%y(modes, parts), source=0.0_wp)
      allocate (self%known(modes, parts), source=0.0_wp)
      allocate (self%a(modes, parts, parts), self%start(modes, parts), self%end(modes, parts), &
         self%before(modes, parts), matrix(parts + 3, parts + 3), answer(parts, 3))
      do n = 1, modes
         ! those of a material that relaxes creep, and are damped
         if (sqrt(vibration%square(n))*dt > fastest .and. parts == 2 &
             .and. vibration%damping(n)**2 < vibration%square(n)) then
            self%a(n, :, :) = 0.0_wp
            self%start(n, :) = 0.0_wp
            self%before(n, :) = 0.0_wp
            self%end(n, :) = 0.0_wp
            self%end(n, 1) = vibration%yield(n)/vibration%square(n)
            cycle
         end if
         ! deflections in a unit that makes the matrix as small as it can be
         unit = max(sqrt(vibration%square(n)), 1.0_wp/dt)
         matrix = 0.0_wp
         matrix(1, 2) = unit
         matrix(2, 1) = -vibration%square(n)*vibration%equilibrium/unit
         matrix(2, 2) = -vibration%damping(n)
         do i = 1, size(vibration%rate)
            matrix(2, 2 + i) = -vibration%square(n)*vibration%modulus(i)/unit
            matrix(2 + i, 2) = unit
            matrix(2 + i, 2 + i) = -vibration%rate(i)
         end do
         matrix(2, parts + 1) = vibration%yield(n)
         matrix = dt*matrix
         matrix(parts + 1, parts + 2) = 1.0_wp
         matrix(parts + 2, parts + 3) = 1.0_wp
         call exponentiate(matrix)
         answer = matmul(matrix(:parts, parts + 1:), force)
         do i = 1, parts
            if (i /= 2) then
               matrix(i, :) = matrix(i, :)/unit
               answer(i, :) = answer(i, :)/unit
            end if
         end do
         do i = 1, parts
            if (i /= 2) matrix(:, i) = matrix(:, i)*unit
         end do
         self%a(n, :, :) = matrix(:parts, :parts)
         self%start(n, :) = answer(:, 1) - 2.0_wp*answer(:, 3)
         self%before(n, :) = answer(:, 3)
         self%end(n, :) = answer(:, 2) + answer(:, 3)
      end do
      self%yield = sum(self%end(:, 1))
      self%work = real(modes*parts*(parts + 3), wp)
   end subroutine prepare

   !> Replace a matrix by its exponential: Taylor's series of the matrix over a power of two,
   !> squared
   pure subroutine exponentiate(matrix)
      real(wp), intent(inout) :: matrix(:, :)

      ! 0.5^15/15! is below rounding
      real(wp), parameter :: small = 0.5_wp
      integer, parameter :: terms = 14
      real(wp), dimension(size(matrix, 1), size(matrix, 1)) :: part, total
      integer :: squarings, i

      squarings = max(0, exponent(maxval(sum(abs(matrix), 1))/small))
      part = 0.0_wp
      do i = 1, size(matrix, 1)
         part(i, i) = 1.0_wp
      end do
      total = part
      matrix = matrix*0.5_wp**squarings
      do i = 1, terms
         part = matmul(part, matrix)/real(i, wp)
         total = total + part
      end do
      do i = 1, squarings
         total = matmul(total, total)
      end do
      matrix = total
   end subroutine exponentiate

   !> Set the state
   subroutine set(self, state)
      class(modes_t), intent(inout) :: self
      type(state_of_modes_t), intent(in) :: state

      self%y(:, 1) = state%eta
      self%y(:, 2) = state%rate
      self%y(:, 3:) = state%lag
   end subroutine set

   !> Advance to the next node without the force there
   subroutine advance(self, force)
      class(modes_t), intent(inout) :: self
      !> Force at the last node and the node before [N]
      real(wp), intent(in) :: force(2)

      integer :: i, j, n

      do i = 1, size(self%y, 2)
         do n = 1, size(self%y, 1)
            self%known(n, i) = self%a(n, i, 1)*self%y(n, 1) + self%a(n, i, 2)*self%y(n, 2)
         end do
         do j = 3, size(self%y, 2)
            do n = 1, size(self%y, 1)
               self%known(n, i) = self%known(n, i) + self%a(n, i, j)*self%y(n, j)
            end do
         end do
         if (maxval(force) > 0.0_wp) then
            do n = 1, size(self%y, 1)
               self%known(n, i) = self%known(n, i) + self%start(n, i)*force(1) &
                  + self%before(n, i)*force(2)
            end do
         end if
      end do
   end subroutine advance

   !> Complete the state with the force at the new node
   subroutine accept(self, force)
      class(modes_t), intent(inout) :: self
      !> Force there [N]
      real(wp), intent(in) :: force

      if (force > 0.0_wp) then
         self%y = self%known + self%end*force
      else
         self%y = self%known
      end if
   end subroutine accept

   !> Deflection at the node being solved without the force there
   pure function deflection(self)
      class(modes_t), intent(in) :: self
      !> Deflection [m]
      real(wp) :: deflection

      deflection = total(self%known(:, 1))
   end function deflection

   !> Velocity of the struck point in the modes at the newest node
   pure function rate(self)
      class(modes_t), intent(in) :: self
      !> Velocity [m/s]
      real(wp) :: rate

      rate = total(self%y(:, 2))
   end function rate

   !> Sum of many numbers, in parts that do not wait for each other
   pure function total(values)
      real(wp), contiguous, intent(in) :: values(:)
      real(wp) :: total

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

      allocate (state%eta, source=self%y(:, 1))
      allocate (state%rate, source=self%y(:, 2))
      allocate (state%lag, source=self%y(:, 3:))
   end function state

end module vcor_solver_direct_modes
