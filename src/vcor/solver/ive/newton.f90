!> Newton's iteration on the equations of a panel, with the Jacobian kept while it serves
module vcor_solver_ive_newton
   use vcor_kinds, only : wp
   use vcor_numeric_radau_algebra, only : apply, invert, width
   use vcor_solver_ive_tuning, only : newton_close, newton_slow, newton_wildest
   implicit none
   private

   public :: newton_t, most_iterations, largest

   !> Maximum iterations
   integer, parameter :: most_iterations = 40

   !> State of the iteration
   type :: newton_t
      !> Whether the next correction needs a new Jacobian
      logical :: stale = .true.
      !> What errors are counted against; 0: the largest component of the solution
      real(wp) :: unit = 0.0_wp
      !> Correction over that which ends the iteration once it does not fall any more: rounding
      real(wp) :: noise = 0.0_wp
      !> Size of the last correction
      real(wp) :: last = 0.0_wp
      !> Whether the equations are solved
      logical :: converged = .false.
      !> Whether they cannot be
      logical :: failed = .false.
   contains
      !> Correct the solution
      procedure :: correct
   end type newton_t

contains

   !> Correct the solution and judge what is left of its error: next to a fresh Jacobian it falls
   !> with the power 2 of the correction, or 1.5 where u = s^1.5 has its branch point, otherwise
   !> linearly
   pure subroutine correct(self, jacobian, residual, s, tolerance)
      !> State of the iteration
      class(newton_t), intent(inout) :: self
      !> Jacobian where `stale`, otherwise its inverse; on return that
      real(wp), intent(inout) :: jacobian(width, width)
      !> Residual, on return the correction
      real(wp), intent(inout) :: residual(width)
      !> Solution
      real(wp), intent(inout) :: s(width)
      !> Wanted error over the largest component
      real(wp), intent(in) :: tolerance

      real(wp) :: unit, size, rate, left
      logical :: regular

      if (self%stale) then
         call invert(jacobian, regular)
         self%failed = .not. regular
         if (self%failed) return
      end if
      residual = apply(jacobian, residual)
      s = s + residual
      unit = self%unit
      if (.not. unit > 0.0_wp) unit = largest(s)
      self%failed = .not. largest(residual) < newton_wildest*unit
      if (self%failed) return
      size = largest(residual)/unit
      if (self%stale) then
         left = size*sqrt(size)
         self%stale = size > newton_close
      else
         rate = min(1.0_wp, size/self%last)
         left = size*rate/(1.0_wp - 0.5_wp*rate)
         self%stale = rate > newton_slow
      end if
      self%converged = left <= tolerance .or. size <= self%noise .and. .not. size < 0.5_wp*self%last
      self%last = size
   end subroutine correct

   !> Largest magnitude
   pure function largest(x)
      !> Vector
      real(wp), intent(in) :: x(width)
      !> Its norm
      real(wp) :: largest

      real(wp) :: half(width/2)
      integer :: i

      do i = 1, width/2
         half(i) = max(abs(x(i)), abs(x(i + width/2)))
      end do
      largest = max(max(half(1), half(2)), max(half(3), half(4)))
   end function largest

end module vcor_solver_ive_newton
