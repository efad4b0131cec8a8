!> Edge of the contact between two springs of the row, and the pressure beside it, which the springs
!> do not count: a part of the row counts with two springs or one, and not as far as the edge. The
!> force would change by steps as springs come into contact one by one.
!>
!> With a body of profile h(x) ~ x^n the pressure q(x) from the last spring of the part before to
!> the edge is a chain of lines of x^n:
!>
!> - Without memory it is one line, through the next spring too, which does not push.
!> - With memory the next spring is not on it: its dent is older. While the contact grows over a
!>   face that has not been touched, the edge is where the bodies meet, and a place between two
!>   springs has a pressure by the time since the edge has passed it, on a viscous face with a step
!>   at its beginning. As the approach varies as a line from spring to spring, and the response is
!>   linear, the chain has its corners where the edge was at the earlier steps: the rim.
!> - While the contact shrinks the pressure is smooth, and the line of the last two springs ends at
!>   the edge.
module vcor_solver_coupled_edge
   use vcor_kinds, only : wp
   use vcor_solver_coupled_past, only : find_dents
   use vcor_solver_coupled_row, only : row_t
   implicit none
   private

   public :: edge_t

   !> Corners of the rim: every second goes when there are more, as the steps then are much shorter
   !> than the time in which the edge passes a spring
   integer, parameter :: most = 32

   !> The edge
   type :: edge_t
      !> Exponent n of the profile of the body, 2 of a sphere
      real(wp) :: power = 2.0_wp
      !> Radius of the contact [m], in this step and the step before
      real(wp) :: radius = 0.0_wp, before = 0.0_wp
      !> Whether the contact grows over a face that has not been touched
      logical :: grows = .false.
      !> Number of corners
      integer :: corners = 0
      !> Their places [m], increasing; their dents by the pressures of earlier steps [m] and their
      !> pressures in this step [N/m]
      real(wp) :: place(most) = 0.0_wp, dent(most) = 0.0_wp, pressure(most) = 0.0_wp
      !> First step that the corners have been in contact
      integer :: first = 1
      !> Pressures of earlier steps [N/m], shape (most, steps); unallocated without memory
      real(wp), allocatable :: past(:, :)
   contains
      procedure :: begin
      procedure :: begin_step
      procedure :: find
      procedure :: end_step
   end type edge_t

   !> Chain of lines of x^n
   type :: chain_t
      !> Exponent n
      real(wp) :: power = 2.0_wp
      !> Number of points
      integer :: points = 0
      !> Places [m], increasing, and pressures [N/m]
      real(wp) :: x(most + 4) = 0.0_wp, q(most + 4) = 0.0_wp
   contains
      procedure :: insert
      procedure :: integral
   end type chain_t

contains

   !> Prepare for a march
   pure subroutine begin(self, start_exponent, steps, remembers)
      class(edge_t), intent(inout) :: self
      !> Exponent of the law of the static contact at its start, 1 + 1/n, or 1 of a punch
      real(wp), intent(in) :: start_exponent
      !> Number of steps
      integer, intent(in) :: steps
      !> Whether the springs have a memory
      logical, intent(in) :: remembers

      if (start_exponent > 1.0_wp) self%power = 1.0_wp/(start_exponent - 1.0_wp)
      if (remembers) allocate (self%past(most, steps), source=0.0_wp)
   end subroutine begin

   !> Begin a step
   pure subroutine begin_step(self, step, local)
      class(edge_t), intent(inout) :: self
      !> The step
      integer, intent(in) :: step
      !> Weights of the springs, shape (0:)
      real(wp), intent(in) :: local(0:)

      if (self%corners == 0) return
      call find_dents(self%dent, self%past(:, self%first:step - 1), local(:step - self%first))
   end subroutine begin_step

   !> Find the edge, and the forces of the hats that the springs miss
   pure subroutine find(self, row, local, compression, dent, pushes, touched, missing)
      class(edge_t), intent(inout) :: self
      type(row_t), intent(in) :: row
      !> First weight of the springs
      real(wp), intent(in) :: local
      !> Compression of the springs, > 0 where they push, and dents by earlier pressures [m]
      real(wp), intent(in) :: compression(:), dent(:)
      !> Which springs push
      logical, intent(in) :: pushes(:)
      !> Number of springs up to the last that has pushed before this step
      integer, intent(in) :: touched
      !> The forces [N], shape (hats)
      real(wp), intent(out) :: missing(:)

      type(chain_t) :: chain
      ! pressures from the first spring that the chain needs to the one after the last that pushes
      real(wp), allocatable :: q(:)
      real(wp) :: rise, fall, here, slope, at
      integer :: first, i, j

      missing = 0.0_wp
      self%radius = 0.0_wp
      self%grows = .false.
      i = findloc(pushes, .true., dim=1, back=.true.)
      if (i == 0) return
      associate (x => row%x, n => self%power, weight => row%weight(i), hat => row%hat(i), &
                 right => row%right(i))
         self%radius = x(i)
         if (i == size(x)) return
         first = i - 1 + modulo(i, 2)
         j = max(1, first - 1)
         allocate (q(j:i + 1), source=compression(j:i + 1)/local)
         chain%power = n
         do j = max(1, first - 1), i
            call chain%insert(x(j), q(j))
         end do
         ! x^n, and its rise to the next spring
         at = raised(x(i), n)
         rise = raised(x(i + 1), n) - at
         ! approach without dents
         here = compression(i) + dent(i)
         slope = (compression(i + 1) - here)/rise
         if (allocated(self%past) .and. i >= touched) then
            self%radius = root(at - here/slope, n)
            self%grows = self%radius >= self%before
         end if
         if (self%grows) then
            do j = 1, self%corners
               self%pressure(j) = (here + slope*(raised(self%place(j), n) - at) &
                  - self%dent(j))/local
               call chain%insert(self%place(j), self%pressure(j))
            end do
            call chain%insert(self%radius, 0.0_wp)
         else
            fall = (q(i) - q(i + 1))/rise
            if (allocated(self%past) .and. i > 1) then
               if (pushes(i - 1)) fall = (q(i - 1) - q(i))/(at - raised(x(i - 1), n))
            end if
            self%radius = x(i + 1)
            if (q(i) < fall*rise) self%radius = root(at + q(i)/fall, n)
            call chain%insert(self%radius, q(i) - fall*(raised(self%radius, n) - at))
         end if
         missing(hat:hat + 1) = [1.0_wp - right, right]*(2.0_wp*chain%integral(0.5_wp*(x(first) &
            + x(first + 1) - weight)) - weight*sum(q(first:i)))
      end associate
   end subroutine find

   !> End a step: the edge is a corner of the next
   pure subroutine end_step(self, step, row, last)
      class(edge_t), intent(inout) :: self
      !> The step
      integer, intent(in) :: step
      type(row_t), intent(in) :: row
      !> Last spring that pushes
      integer, intent(in) :: last

      integer :: n, gone

      self%before = self%radius
      if (.not. self%grows) then
         self%corners = 0
         return
      end if
      n = self%corners
      self%past(:n, step) = self%pressure(:n)
      ! corners before the part of the last spring that the chain begins with
      gone = 0
      if (last > 2) gone = count(self%place(:n) <= row%x(last - 2 + modulo(last, 2)))
      n = n - gone
      self%place(:n) = self%place(gone + 1:gone + n)
      self%past(:n, self%first:step) = self%past(gone + 1:gone + n, self%first:step)
      self%past(n + 1:, self%first:step) = 0.0_wp
      if (n == most) then
         n = most/2
         self%place(:n) = self%place(2:most:2)
         self%past(:n, self%first:step) = self%past(2:most:2, self%first:step)
         self%past(n + 1:, self%first:step) = 0.0_wp
      end if
      if (n == 0) self%first = step
      self%corners = n + 1
      self%place(n + 1) = self%radius
   end subroutine end_step

   !> Insert a point into a chain, in its order
   pure subroutine insert(self, x, q)
      class(chain_t), intent(inout) :: self
      !> Place [m] and pressure [N/m]
      real(wp), intent(in) :: x, q

      integer :: i

      do i = self%points, 1, -1
         if (self%x(i) <= x) exit
         self%x(i + 1) = self%x(i)
         self%q(i + 1) = self%q(i)
      end do
      self%x(i + 1) = x
      self%q(i + 1) = q
      self%points = self%points + 1
   end subroutine insert

   !> Integral of a chain from a place to its end, the first line extended to it
   pure function integral(self, start)
      class(chain_t), intent(in) :: self
      !> The place [m]
      real(wp), intent(in) :: start
      !> The integral [N]
      real(wp) :: integral

      real(wp) :: from, slope, q, at, before
      integer :: i

      integral = 0.0_wp
      associate (x => self%x, n => self%power)
         do i = 1, self%points - 1
            if (.not. x(i + 1) > x(i)) cycle
            if (x(i + 1) <= start .and. i + 1 < self%points) cycle
            from = x(i)
            if (i == 1 .or. from < start) from = start
            before = raised(x(i), n)
            slope = (self%q(i + 1) - self%q(i))/(raised(x(i + 1), n) - before)
            at = raised(from, n)
            q = self%q(i) + slope*(at - before)
            integral = integral + (x(i + 1) - from)*(q - slope*at) &
               + slope*(x(i + 1)*raised(x(i + 1), n) - from*at)/(n + 1.0_wp)
         end do
      end associate
   end function integral

   !> x^n, of a sphere the square
   elemental function raised(x, n)
      !> The number, >= 0, and the exponent
      real(wp), intent(in) :: x, n
      real(wp) :: raised

      if (n > 2.0_wp .or. n < 2.0_wp) then
         raised = x**n
      else
         raised = x**2
      end if
   end function raised

   !> x^(1/n)
   elemental function root(x, n)
      !> The number, >= 0, and the exponent
      real(wp), intent(in) :: x, n
      real(wp) :: root

      if (n > 2.0_wp .or. n < 2.0_wp) then
         root = x**(1.0_wp/n)
      else
         root = sqrt(x)
      end if
   end function root

end module vcor_solver_coupled_edge
