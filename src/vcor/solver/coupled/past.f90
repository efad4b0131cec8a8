!> What earlier steps of a march have left: dents of the springs and bends of the hats, sums over all
!> lags, which take most of its operations
!>
!> For a block of steps what the steps before it have left is one product of matrices, which reads
!> weights and forces once for the block; for each step sums over the block itself remain.
module vcor_solver_coupled_past
   use vcor_kinds, only : wp
   use vcor_solver_coupled_kernel, only : kernel_t
   implicit none
   private

   public :: find_dents, past_t

   !> Steps of a block: the sums that remain are then short beside the products, of 80 steps too
   integer, parameter :: block = 16

   !> The past of a march
   type :: past_t
      !> Pressures of the springs [N/m], shape (springs, steps)
      real(wp), allocatable :: pressure(:, :)
      !> Forces of the hats [N], those of a step after those of the step before
      real(wp), allocatable :: force(:)
      !> Steps before the block, and springs up to the last that had pushed by then
      integer, private :: before = 0, touched = 0
      !> What the steps before the block have left in its steps [m]: dents, shape (springs, block),
      !> and bends, shape (hats, block)
      real(wp), allocatable, private :: dent(:, :), bend(:, :)
   contains
      procedure :: begin
      procedure :: begin_step
      procedure :: dents
      procedure :: bends
   end type past_t

contains

   !> Prepare for a march
   pure subroutine begin(self, kernel)
      class(past_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel

      associate (springs => kernel%row%springs, hats => kernel%mesh%hats, &
                 steps => kernel%mesh%steps)
         allocate (self%pressure(springs, steps), self%force(hats*steps))
         allocate (self%dent(springs, block), self%bend(hats, block), source=0.0_wp)
      end associate
   end subroutine begin

   !> Begin a step: with the first of a block sum over the steps before
   pure subroutine begin_step(self, kernel, step, touched)
      class(past_t), intent(inout) :: self
      type(kernel_t), intent(in) :: kernel
      !> The step, and the number of springs up to the last that has pushed
      integer, intent(in) :: step, touched

      real(wp), allocatable :: local(:, :), force(:, :)
      integer :: before, i, j, lags, many

      before = step - 1
      if (before == 0 .or. modulo(before, block) /= 0) return
      self%before = before
      self%touched = touched
      many = min(block, kernel%mesh%steps - step)
      if (kernel%remembers) then
         allocate (local(before, many))
         do j = 1, many
            do i = 1, before
               local(i, j) = kernel%local(before + j - i)
            end do
         end do
         self%dent(:touched, :many) = matmul(self%pressure(:touched, :before), local)
      end if
      if (.not. kernel%has_response) return
      lags = before + many - 1
      associate (hats => kernel%mesh%hats, all => size(kernel%later, 2))
         ! forces of each step at the places of their lags, the longest first
         allocate (force(hats*lags, many), source=0.0_wp)
         do j = 1, many
            force(hats*(many - j) + 1:hats*(many - j + before), j) = self%force(:hats*before)
         end do
         self%bend(:, :many) = matmul(kernel%later(:, all - hats*lags + 1:), force)
      end associate
   end subroutine begin_step

   !> Dents that the pressures before a step have left
   pure subroutine dents(self, kernel, step, dent)
      class(past_t), intent(in) :: self
      type(kernel_t), intent(in) :: kernel
      !> The step, of the block begun last
      integer, intent(in) :: step
      !> Dents [m], of the springs up to the last that has pushed
      real(wp), contiguous, intent(out) :: dent(:)

      call find_dents(dent, self%pressure(:, self%before + 1:step - 1), &
         kernel%local(:step - 1 - self%before))
      if (self%before > 0) dent(:self%touched) = dent(:self%touched) &
         + self%dent(:self%touched, step - self%before)
   end subroutine dents

   !> Bends that the forces before a step have left
   pure function bends(self, kernel, step) result(bend)
      class(past_t), intent(in) :: self
      type(kernel_t), intent(in) :: kernel
      !> The step, of the block begun last
      integer, intent(in) :: step
      !> Displacements of the hats [m], shape (hats)
      real(wp) :: bend(kernel%mesh%hats)

      integer :: i, first, last

      bend = 0.0_wp
      if (.not. kernel%has_response) return
      if (self%before > 0) bend = self%bend(:, step - self%before)
      first = kernel%mesh%hats*self%before + 1
      last = kernel%mesh%hats*(step - 1)
      associate (all => size(kernel%later, 2))
         do i = first, last
            bend = bend + kernel%later(:, all - last + i)*self%force(i)
         end do
      end associate
   end function bends

   !> Dents that pressures have left, four steps at a time, as the sum would otherwise be loaded and
   !> stored for each
   pure subroutine find_dents(dent, pressure, local)
      !> Dents [m]
      real(wp), contiguous, intent(out) :: dent(:)
      !> Pressures of earlier steps [N/m], shape (>= size(dent), >= steps)
      real(wp), contiguous, intent(in) :: pressure(:, :)
      !> Weights of the springs from lag 0 to that of the first step, shape (0:steps)
      real(wp), intent(in) :: local(0:)

      integer :: i, n, steps

      n = size(dent)
      steps = ubound(local, 1)
      dent = 0.0_wp
      do i = 1, steps - 3, 4
         dent = dent + (local(steps + 1 - i)*pressure(:n, i) &
            + local(steps - i)*pressure(:n, i + 1) &
            + local(steps - 1 - i)*pressure(:n, i + 2) &
            + local(steps - 2 - i)*pressure(:n, i + 3))
      end do
      do i = steps - modulo(steps, 4) + 1, steps
         dent = dent + local(steps + 1 - i)*pressure(:n, i)
      end do
   end subroutine find_dents

end module vcor_solver_coupled_past
