!> Springs that push in a step of a march, and their compression: with the approach g of the bodies
!> over the springs without the forces of this step, hats h, their first weights W, that of the
!> springs w, and the weights p of the springs that push,
!>
!>     u = g - sum_j h_j (W f)_j,   f_i = (1/w) sum p h_i u,   u > 0 where the springs push
!>
!> so that f solves (1 + G W/w) f = (1/w) sum p h g with G_ij = sum p h_i h_j, of which only
!> neighbours are not 0.
module vcor_solver_coupled_balance
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_kinds, only : wp
   use vcor_solver_coupled_edge, only : edge_t
   use vcor_solver_coupled_kernel, only : kernel_t
   implicit none
   private

   public :: balance_t

   !> The springs and hats of a step
   type :: balance_t
      !> Approach of the bodies over the springs without the forces of this step [m]
      real(wp), allocatable :: gap(:)
      !> Part of it that the springs keep of earlier pressures [m]
      real(wp), allocatable :: dent(:)
      !> Which springs push
      logical, allocatable :: pushes(:)
      !> Compression of the springs of this step [m], > 0 where they push
      real(wp), allocatable :: compression(:)
      !> Forces of the hats that the springs miss at the edge of the contact [N], shape (hats)
      real(wp), allocatable :: missing(:)
      !> Edge of the contact
      type(edge_t) :: edge
      !> Last spring that pushes, 0 if none does
      integer :: last = 0
      !> Last spring that has pushed so far, in this step too, and before it
      integer :: reach = 0, touched = 0
      !> Weights W of the hats of this step with the mass of the sphere [m/N], shape (hats, hats)
      real(wp), allocatable, private :: now(:, :)
      !> G of a hat with itself and with the next [m], shape (hats)
      real(wp), allocatable, private :: same(:), next(:)
      !> Factors of 1 + G W/w as of `factor`, shape (n, n), and whether they are those of the
      !> springs that push
      real(wp), allocatable, private :: system(:, :)
      integer, allocatable, private :: pivots(:)
      logical, private :: is_factored = .false.
   contains
      procedure :: begin
      procedure :: find_pushing
      procedure, private :: change
      procedure, private :: factor_system
      procedure, private :: find_edge
   end type balance_t

contains

   !> Prepare for a march: no spring pushes
   pure subroutine begin(self, kernel, sphere, start_exponent)
      class(balance_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel
      !> Displacement of the sphere in a step by the force of that step [m/N]
      real(wp), intent(in) :: sphere
      !> Exponent of the law of the static contact at its start
      real(wp), intent(in) :: start_exponent

      associate (n => kernel%mesh%hats, springs => kernel%row%springs)
         allocate (self%now(n, n), source=kernel%now + sphere)
         allocate (self%same(n), self%next(n), self%gap(springs), self%dent(springs), &
            self%compression(springs), self%missing(n), source=0.0_wp)
         allocate (self%pushes(springs), source=.false.)
      end associate
      call self%edge%begin(start_exponent, kernel%mesh%steps, kernel%remembers)
   end subroutine begin

   !> Find the springs that push, and their compression. All that are on the wrong side change it at
   !> once, which takes two or three rounds from the springs of the step before. If that cycles,
   !> the last of them changes alone, by Murty's rule (K. G. Murty, Opsearch 8 (1971)
   !> 188), which always ends as the response is passive
   subroutine find_pushing(self, kernel, error)
      class(balance_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel
      !> Error of code `error_numerical`
      type(error_t), allocatable, intent(out) :: error

      ! rounds of all at once, ten times what a step takes, and of both kinds: one at a time takes
      ! about as many as springs are wrong
      integer, parameter :: together = 30, most = 1000
      ! rounds after which missing forces are known, small as they are: with one, results of 40
      ! random impacts (benchmarks/exact_impacts.py) change by up to 6e-6, 1.3 stated errors,
      ! without by 1e-3
      integer, parameter :: enough = 2
      real(wp) :: force(kernel%mesh%hats), more(kernel%mesh%hats)
      integer :: wrong(size(self%gap) + 1), round, count, i, n

      n = 0
      do round = 1, most
         self%last = findloc(self%pushes, .true., dim=1, back=.true.)
         self%compression = self%gap
         force = 0.0_wp
         if (self%last > 0) then
            if (.not. self%is_factored) call self%factor_system(kernel)
            ! there is no solution
            if (.not. self%is_factored) exit
            call kernel%row%gather(merge(self%gap(:self%last), 0.0_wp, self%pushes(:self%last)), &
               force)
            n = size(self%pivots)
            force = force/kernel%local(0)
            call solve(self%system, self%pivots, force(:n))
            call kernel%row%spread_hats(-matmul(self%now(:, :n), force(:n)), &
               self%compression)
         end if
         call find_wrong(self%compression, self%pushes, wrong, count)
         if (count == 0) then
            call self%find_edge(kernel)
            if (self%last == 0) return
            do i = 1, enough
               more(:n) = -product_with(self, matmul(self%now(:n, :n), self%missing(:n))) &
                  /kernel%local(0)
               call solve(self%system, self%pivots, more(:n))
               more(:n) = force(:n) + more(:n) + self%missing(:n)
               self%compression = self%gap
               call kernel%row%spread_hats(-matmul(self%now(:, :n), more(:n)), self%compression)
               call self%find_edge(kernel)
            end do
            return
         end if
         if (round > together) then
            call self%change(kernel, wrong(count))
         else
            do i = 1, count
               call self%change(kernel, wrong(i))
            end do
         end if
         self%is_factored = .false.
      end do
      call raise(error, error_numerical, 'no pressure balances a step of the contact: the plate ' &
         //'gives way within the step by more than the contact can resolve; take a thicker ' &
         //'plate, a lighter body or a slower impact')
   end subroutine find_pushing

   !> Find the springs that push and would pull, or the reverse
   pure subroutine find_wrong(compression, pushes, wrong, count)
      !> Compression of the springs [m], and whether they push
      real(wp), contiguous, intent(in) :: compression(:)
      logical, contiguous, intent(in) :: pushes(:)
      !> Their numbers, shape (>= springs + 1), and how many they are
      integer, intent(out) :: wrong(:), count

      integer :: i

      count = 0
      do i = 1, size(compression)
         ! a place that the next one takes unless it is wrong
         wrong(count + 1) = i
         if ((compression(i) > 0.0_wp) .neqv. pushes(i)) count = count + 1
      end do
   end subroutine find_wrong

   !> Find the edge and what the springs miss there
   pure subroutine find_edge(self, kernel)
      class(balance_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel

      call self%edge%find(kernel%row, kernel%local(0), self%compression, self%dent, self%pushes, &
         self%touched, self%missing)
   end subroutine find_edge

   !> Let a spring push, or not
   pure subroutine change(self, kernel, i)
      class(balance_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel
      !> The spring
      integer, intent(in) :: i

      real(wp) :: weight

      self%pushes(i) = .not. self%pushes(i)
      weight = kernel%row%weight(i)
      if (.not. self%pushes(i)) weight = -weight
      associate (hat => kernel%row%hat(i), right => kernel%row%right(i))
         self%same(hat) = self%same(hat) + weight*(1.0_wp - right)**2
         self%same(hat + 1) = self%same(hat + 1) + weight*right**2
         self%next(hat) = self%next(hat) + weight*right*(1.0_wp - right)
      end associate
      self%reach = max(self%reach, i)
   end subroutine change

   !> Factors of 1 + G W/w, for the hats that a spring which pushes acts on: the others have no
   !> force
   pure subroutine factor_system(self, kernel)
      class(balance_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel

      integer :: j, n

      n = kernel%row%hat(self%last) + 1
      if (allocated(self%pivots)) then
         if (size(self%pivots) /= n) deallocate (self%system, self%pivots)
      end if
      if (.not. allocated(self%pivots)) allocate (self%system(n, n), self%pivots(n))
      do j = 1, n
         self%system(:, j) = product_with(self, self%now(:n, j))/kernel%local(0)
         self%system(j, j) = self%system(j, j) + 1.0_wp
      end do
      call factor(self%system, self%pivots, self%is_factored)
   end subroutine factor_system

   !> Product of G, of the first hats, and a vector
   pure function product_with(self, vector) result(product)
      type(balance_t), intent(in) :: self
      !> The vector, shape (n)
      real(wp), intent(in) :: vector(:)
      real(wp) :: product(size(vector))

      associate (n => size(vector), next => self%next)
         product = self%same(:n)*vector
         product(:n - 1) = product(:n - 1) + next(:n - 1)*vector(2:)
         product(2:) = product(2:) + next(:n - 1)*vector(:n - 1)
      end associate
   end function product_with

   !> Factors of a matrix by elimination with row exchanges. Each step does this twice for ten
   !> hats, for which a call of LAPACK takes five times as long
   pure subroutine factor(matrix, pivots, regular)
      !> The matrix; on return its triangular factors, the lower one with a diagonal of 1
      real(wp), intent(inout) :: matrix(:, :)
      !> Row exchanged with each, from its diagonal on
      integer, intent(out) :: pivots(:)
      !> Whether no pivot is 0
      logical, intent(out) :: regular

      real(wp) :: row(size(pivots))
      integer :: i, j, n, p

      n = size(pivots)
      regular = .false.
      do i = 1, n
         p = i - 1 + maxloc(abs(matrix(i:, i)), 1)
         pivots(i) = p
         if (.not. abs(matrix(p, i)) > 0.0_wp) return
         if (p /= i) then
            row(i:) = matrix(i, i:)
            matrix(i, i:) = matrix(p, i:)
            matrix(p, i:) = row(i:)
         end if
         matrix(i + 1:, i) = matrix(i + 1:, i)*(1.0_wp/matrix(i, i))
         do j = i + 1, n
            matrix(i + 1:, j) = matrix(i + 1:, j) - matrix(i, j)*matrix(i + 1:, i)
         end do
      end do
      regular = .true.
   end subroutine factor

   !> Solve with the factors of `factor`
   pure subroutine solve(factors, pivots, right)
      !> The factors, and the rows exchanged
      real(wp), intent(in) :: factors(:, :)
      integer, intent(in) :: pivots(:)
      !> Right-hand side; on return the solution
      real(wp), intent(inout) :: right(:)

      real(wp) :: value
      integer :: i

      do i = 1, size(pivots)
         value = right(pivots(i))
         right(pivots(i)) = right(i)
         right(i) = value
         right(i + 1:) = right(i + 1:) - value*factors(i + 1:, i)
      end do
      do i = size(pivots), 1, -1
         right(i) = right(i)/factors(i, i)
         right(:i - 1) = right(:i - 1) - right(i)*factors(:i - 1, i)
      end do
   end subroutine solve

end module vcor_solver_coupled_balance
