!> Quadrature between two branch points of the square-root kind with two more beyond them
!>
!> The substitution by Jacobi's elliptic functions that turns sqrt((l - p)(l - z)(b - l)(q - l)),
!> p < z < b < q, into a single-valued function makes all four of them points of a double period.
!> An integrand over (z, b) whose only singularities are these becomes periodic and analytic, and
!> the midpoint rule of n nodes converges as exp(-2 pi n K'/K), however far apart the points are:
!> P. F. Byrd and M. D. Friedman, Handbook of Elliptic Integrals, 2nd ed. (1971), 255, and
!> N. Hale, N. J. Higham and L. N. Trefethen, SIAM J. Numer. Anal. 46 (2008) 2505,
!> doi:10.1137/070700607, for the use of it.
module vcor_numeric_elliptic
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_constants, only : pi
   use vcor_kinds, only : wp
   implicit none
   private

   public :: branch_rule

   !> Steps after which the transformation has converged for any parameter
   integer, parameter :: most_steps = 30

   !> Landen's transformation for one parameter
   type :: landen_t
      !> Parameter m
      real(wp) :: m = 0.0_wp
      !> 1 - m
      real(wp) :: complement = 1.0_wp
      !> Number of steps
      integer :: steps = 0
      !> c/a of each step
      real(wp) :: ratio(most_steps) = 0.0_wp
      !> Factor of the argument after the last one
      real(wp) :: factor = 1.0_wp
   end type landen_t

contains

   !> Nodes in (z, b) by their distances from both ends, and weights
   pure subroutine branch_rule(before, length, after, accuracy, from_lower, to_upper, weight)
      !> Distance z - p, > 0
      real(wp), intent(in) :: before
      !> Length b - z, > 0
      real(wp), intent(in) :: length
      !> Distance q - b, > 0; infinite if there is no q
      real(wp), intent(in) :: after
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      !> Distances l - z of the nodes, > 0, shape (n)
      real(wp), allocatable, intent(out) :: from_lower(:)
      !> Distances b - l of the nodes, > 0, shape (n)
      real(wp), allocatable, intent(out) :: to_upper(:)
      !> Weights dl/du h, shape (n)
      real(wp), allocatable, intent(out) :: weight(:)

      integer, parameter :: most_nodes = 200
      ! the strip of the rule is not quite as wide where the integrand has other features
      real(wp), parameter :: margin = 1.1_wp
      type(landen_t) :: landen
      real(wp) :: m, complement, quarter, sn, cn, dn, rest
      integer :: j, n

      ! modulus m = k^2 of the functions and its complement
      if (ieee_is_finite(after)) then
         m = length*(after + length + before)/((after + length)*(length + before))
         complement = after*before/((after + length)*(length + before))
      else
         m = length/(length + before)
         complement = before/(length + before)
      end if
      quarter = 0.5_wp*pi/mean(1.0_wp, sqrt(complement))
      n = min(most_nodes, 1 + ceiling(-margin*log(accuracy)*quarter &
         *mean(1.0_wp, sqrt(m))/pi**2))
      allocate (from_lower(n), to_upper(n), weight(n))
      call descend(m, complement, landen)
      do j = 1, n
         call jacobi(landen, quarter*(real(j, wp) - 0.5_wp)/real(n, wp), sn, cn, dn)
         rest = (before + length*cn**2)/(before + length)
         from_lower(j) = before*length/(before + length)*sn**2/rest
         to_upper(j) = length*cn**2/rest
         weight(j) = quarter/real(n, wp)*2.0_wp*sn*cn*dn*before*length &
            /((before + length)*rest**2)
      end do
   end subroutine branch_rule

   !> Arithmetic-geometric mean
   pure function mean(a, b)
      !> One number, > 0
      real(wp), intent(in) :: a
      !> The other number, > 0
      real(wp), intent(in) :: b
      !> Their mean
      real(wp) :: mean

      real(wp) :: other, next
      integer :: i

      ! it converges quadratically
      mean = a
      other = b
      do i = 1, 40
         next = 0.5_wp*(mean + other)
         other = sqrt(mean*other)
         mean = next
         if (abs(mean - other) <= 1.0e-15_wp*mean) exit
      end do
   end function mean

   !> Descending Landen transformation for a parameter: M. Abramowitz and I. A. Stegun, Handbook of
   !> Mathematical Functions (1964), 16.4
   pure subroutine descend(m, complement, landen)
      !> Parameter m
      real(wp), intent(in) :: m
      !> 1 - m, > 0
      real(wp), intent(in) :: complement
      !> The transformation
      type(landen_t), intent(out) :: landen

      real(wp) :: a, b, c, next

      landen%m = m
      landen%complement = complement
      a = 1.0_wp
      b = sqrt(complement)
      c = sqrt(m)
      landen%steps = 0
      do while (landen%steps < most_steps .and. c > 1.0e-15_wp*a)
         next = 0.5_wp*(a + b)
         c = 0.5_wp*(a - b)
         b = sqrt(a*b)
         a = next
         landen%steps = landen%steps + 1
         landen%ratio(landen%steps) = c/a
      end do
      landen%factor = 2.0_wp**landen%steps*a
   end subroutine descend

   !> Jacobi's elliptic functions
   pure subroutine jacobi(landen, u, sn, cn, dn)
      !> The transformation of their parameter
      type(landen_t), intent(in) :: landen
      !> Argument, between 0 and the quarter period
      real(wp), intent(in) :: u
      !> sn(u)
      real(wp), intent(out) :: sn
      !> cn(u)
      real(wp), intent(out) :: cn
      !> dn(u)
      real(wp), intent(out) :: dn

      real(wp) :: phi
      integer :: n

      phi = landen%factor*u
      do n = landen%steps, 1, -1
         phi = 0.5_wp*(phi + asin(max(-1.0_wp, min(1.0_wp, landen%ratio(n)*sin(phi)))))
      end do
      sn = sin(phi)
      cn = cos(phi)
      dn = sqrt(landen%complement + landen%m*cn**2)
   end subroutine jacobi

end module vcor_numeric_elliptic
