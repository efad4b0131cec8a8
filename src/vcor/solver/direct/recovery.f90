!> Recovery of a dent in flight, exactly over any time
!>
!> A free spring of the contact carries no force (`vcor_solver_direct_row`):
!>
!>     G_0 w + sum_k G_k p_k + eta w' = 0,   p_k' = w' - l_k p_k
!>
!> Its motions are w = c exp(-x t) with the lags p_k = -c x/(l_k - x) exp(-x t), where the
!> retardation rates x are the zeros of the modulus at p = -x,
!>
!>     G_0 - x sum_k G_k/(l_k - x) - eta x
!>
!> which falls between two rates l from plus to minus infinity: one zero lies in each gap, the one
!> below the first rate included, and with a dashpot one beyond the last rate. In q = w - p the
!> motions are orthogonal with the weights G_k/l_k, and eta for w:
!>
!>     c = (eta w + sum_k G_k q_k/(l_k - x))/(eta + sum_k G_k l_k/(l_k - x)^2)
module vcor_solver_direct_recovery
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   implicit none
   private

   public :: recovery_t

   !> The motions of a free spring
   type :: recovery_t
      !> Retardation rates x [1/s], shape (motions)
      real(wp), allocatable :: rate(:)
      !> Shares of w and of q_k in the motions, shapes (motions), (modes, motions), and lags p_k of
      !> a motion with c = 1
      real(wp), allocatable, private :: from_w(:), from_q(:, :), lag(:, :)
   contains
      procedure :: prepare
      procedure :: motions_of
      procedure :: advance
   end type recovery_t

contains

   !> Find the motions of a kernel
   subroutine prepare(self, terms)
      class(recovery_t), intent(out) :: self
      !> Kernel, with rising rates and positive moduli
      type(exponential_sum_t), intent(in) :: terms

      real(wp) :: gap(size(terms%rates)), norm
      integer :: motions, m

      motions = size(terms%rates)
      if (terms%viscosity > 0.0_wp) motions = motions + 1
      allocate (self%rate(motions), self%from_w(motions), self%from_q(size(gap), motions), &
         self%lag(size(gap), motions))
      do m = 1, motions
         call find_zero(terms, m, self%rate(m), gap)
         norm = terms%viscosity + sum(terms%moduli*(terms%rates/gap/gap))
         self%from_w(m) = terms%viscosity/norm
         self%from_q(:, m) = terms%moduli/gap/norm
         self%lag(:, m) = -self%rate(m)/gap
      end do
   end subroutine prepare

   !> Find a zero of the modulus by bisection in the logarithm of its distance from the nearer rate:
   !> distances keep all digits
   pure subroutine find_zero(terms, m, x, gap)
      type(exponential_sum_t), intent(in) :: terms
      !> Number of the zero, that of the rate above it
      integer, intent(in) :: m
      !> The zero, and the distances l_k - x [1/s]
      real(wp), intent(out) :: x, gap(:)

      ! after them the bounds of the logarithm are neighbours
      integer, parameter :: bisections = 64
      real(wp), parameter :: nearest = 1.0e-30_wp
      real(wp) :: below, above, lower, upper, distance, near, side
      integer :: i

      below = 0.0_wp
      if (m > 1) below = terms%rates(m - 1)
      near = below
      side = 1.0_wp
      if (m > size(terms%rates)) then
         ! the dashpot's
         upper = 2.0_wp*(below + (terms%equilibrium + sum(terms%moduli))/terms%viscosity)
         do while (modulus(upper) > 0.0_wp)
            upper = 2.0_wp*upper
         end do
      else
         above = terms%rates(m)
         upper = 0.5_wp*(above - below)
         if (modulus(upper) > 0.0_wp) then
            near = above
            side = -1.0_wp
         end if
      end if
      lower = nearest*upper
      do i = 1, bisections
         distance = sqrt(lower)*sqrt(upper)
         if (modulus(distance) > 0.0_wp .eqv. side > 0.0_wp) then
            lower = distance
         else
            upper = distance
         end if
      end do
      ! a fluid keeps its dent
      if (m == 1 .and. .not. terms%equilibrium > 0.0_wp) distance = 0.0_wp
      x = near + side*distance
      gap = (terms%rates - near) - side*distance

   contains

      !> The modulus at a distance from the near rate
      pure function modulus(distance)
         !> Distance [1/s]
         real(wp), intent(in) :: distance
         real(wp) :: modulus

         real(wp) :: place

         place = near + side*distance
         modulus = terms%equilibrium - place*(terms%viscosity &
            + sum(terms%moduli/((terms%rates - near) - side*distance)))
      end function modulus
   end subroutine find_zero

   !> Amplitudes c of the motions of a free spring
   pure function motions_of(self, w, lag) result(c)
      class(recovery_t), intent(in) :: self
      !> Its compression
      real(wp), intent(in) :: w
      !> Its lags p_k, shape (modes)
      real(wp), intent(in) :: lag(:)
      !> Amplitudes, shape (motions)
      real(wp) :: c(size(self%rate))

      integer :: m

      do m = 1, size(c)
         c(m) = self%from_w(m)*w + sum((w - lag)*self%from_q(:, m))
      end do
   end function motions_of

   !> Advance a free spring
   pure subroutine advance(self, time, w, lag)
      class(recovery_t), intent(in) :: self
      !> Time [s]
      real(wp), intent(in) :: time
      !> Its compression and its lags, shape (modes)
      real(wp), intent(inout) :: w, lag(:)

      real(wp) :: c(size(self%rate))
      integer :: k

      c = self%motions_of(w, lag)*exp(-self%rate*time)
      w = sum(c)
      do k = 1, size(lag)
         lag(k) = sum(self%lag(k, :)*c)
      end do
   end subroutine advance

end module vcor_solver_direct_recovery
