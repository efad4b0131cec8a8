!> Quadrature between two square-root branch points with one or two more outside the interval
!>
!> The integrand has branch points of sqrt((l - p)(l - z)(b - l)(q - l)), p < z < b < q, on the
!> interval z < l < b; q may be infinite. Written in Jacobi's elliptic functions of u, l makes it a
!> periodic function that is analytic in a strip |Im u| < K', so the midpoint rule of n nodes
!> converges as exp(-a K'), a = 2 pi n/K, whatever the distances of the points: P. F. Byrd and M. D.
!> Friedman, Handbook of Elliptic Integrals, 2nd ed. (1971), 255; for its use, N. Hale, N. J. Higham
!> and L. N. Trefethen, SIAM J. Numer. Anal. 46 (2008) 2505, doi:10.1137/070700607.
!>
!> With a factor exp(-l t) the edge of the strip cannot be reached, since l is infinite at one point
!> of it. The saddle point of exp(i a u - l t) gives the error exp(-a K' + c), with
!> c = (a t sqrt((q - z)(b - p)))^(1/2) or, without q, c = (27/32 a^2 t (b - p))^(1/3). At
!> Im u = K'/2 l runs on a circle around z and b that passes between p and z, so the error is at
!> most exp(-a K'/2) for any t.
module vcor_numeric_elliptic
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_kinds, only : pi, wp
   implicit none
   private

   public :: branch_rule

   !> Largest number of steps: they converge quadratically, in twelve from a complement of 1e-300
   integer, parameter :: most_steps = 16

   !> Landen's transformation of one modulus
   type :: landen_t
      !> Number of steps
      integer :: steps = 0
      !> Modulus after each step
      real(wp) :: modulus(most_steps) = 0.0_wp
      !> 1 - modulus
      real(wp) :: complement(most_steps) = 1.0_wp
      !> Quarter period K of the functions
      real(wp) :: quarter = 0.5_wp*pi
   end type landen_t

contains

   !> Nodes in (z, b), given by their distances from both ends, and weights, for integrands with
   !> exp(-l t)
   pure subroutine branch_rule(before, length, after, time, accuracy, from_lower, to_upper, &
                               weight)
      !> Distance z - p, > 0
      real(wp), intent(in) :: before
      !> Length b - z, > 0
      real(wp), intent(in) :: length
      !> Distance q - b, > 0; infinite if there is no q
      real(wp), intent(in) :: after
      !> Largest t [inverse of the unit of the distances], >= 0
      real(wp), intent(in) :: time
      !> Relative accuracy wanted, > 0
      real(wp), intent(in) :: accuracy
      !> Distances l - z of the nodes, > 0, shape (n)
      real(wp), allocatable, intent(out) :: from_lower(:)
      !> Distances b - l of the nodes, > 0, shape (n)
      real(wp), allocatable, intent(out) :: to_upper(:)
      !> Weights dl/du h, shape (n)
      real(wp), allocatable, intent(out) :: weight(:)

      ! of a gap whose ends all but meet others: 50 in place of 200 change none of 109 random
      ! impacts
      integer, parameter :: most_nodes = 200
      type(landen_t) :: landen, other
      real(wp) :: m, complement, wanted, c, more, sn, cn, dn, rest
      integer :: j, n

      ! parameter m = k^2 of the functions, and 1 - m
      if (ieee_is_finite(after)) then
         m = length*(after + length + before)/((after + length)*(length + before))
         complement = after*before/((after + length)*(length + before))
      else
         m = length/(length + before)
         complement = before/(length + before)
      end if
      call descend(m, complement, landen)
      call descend(complement, m, other)
      ! a K' = more*wanted, so that exp(-a K' + c) is the accuracy
      wanted = log(2.0_wp/accuracy)
      if (ieee_is_finite(after)) then
         c = 0.25_wp*time*sqrt((after + length)*(length + before))/(wanted*other%quarter)
         more = (sqrt(c) + sqrt(1.0_wp + c))**2
      else
         ! root x of x^3 = 1 + 3 c x^2 to second order in c; more = x^3
         c = (time*(length + before)/(32.0_wp*wanted*other%quarter**2))**(1.0_wp/3.0_wp)
         more = (1.0_wp + c*(1.0_wp + c))**3
      end if
      n = min(most_nodes, ceiling(min(more, 2.0_wp)*wanted*landen%quarter &
         /(2.0_wp*pi*other%quarter)))
      allocate (from_lower(n), to_upper(n), weight(n))
      do j = 1, n
         call jacobi(landen, (real(j, wp) - 0.5_wp)/real(n, wp), sn, cn, dn)
         rest = (before + length*cn**2)/(before + length)
         from_lower(j) = before*length/(before + length)*sn**2/rest
         to_upper(j) = length*cn**2/rest
         weight(j) = landen%quarter/real(n, wp)*2.0_wp*sn*cn*dn*before*length &
            /((before + length)*rest**2)
      end do
   end subroutine branch_rule

   !> Descending Landen transformation: M. Abramowitz and I. A. Stegun, Handbook of Mathematical
   !> Functions (1964), 16.12 and 17.6
   pure subroutine descend(m, complement, landen)
      !> Parameter m, the square of the modulus
      real(wp), intent(in) :: m
      !> 1 - m, > 0
      real(wp), intent(in) :: complement
      !> The transformation
      type(landen_t), intent(out) :: landen

      ! the next modulus, a quarter of the square, is below rounding
      real(wp), parameter :: small = 1.0e-8_wp
      real(wp) :: a, b, c, next

      a = 1.0_wp
      b = sqrt(complement)
      c = sqrt(m)
      do while (landen%steps < most_steps .and. c > small*a)
         next = 0.5_wp*(a + b)
         c = 0.5_wp*(a - b)
         landen%steps = landen%steps + 1
         landen%modulus(landen%steps) = c/next
         landen%complement(landen%steps) = b/next
         b = sqrt(a*b)
         a = next
      end do
      landen%quarter = 0.5_wp*pi/a
   end subroutine descend

   !> Jacobi's elliptic functions
   pure subroutine jacobi(landen, part, sn, cn, dn)
      !> The transformation of the modulus
      type(landen_t), intent(in) :: landen
      !> Argument u divided by the quarter period K, between 0 and 1
      real(wp), intent(in) :: part
      !> sn(u)
      real(wp), intent(out) :: sn
      !> cn(u)
      real(wp), intent(out) :: cn
      !> dn(u)
      real(wp), intent(out) :: dn

      real(wp) :: square, share
      integer :: n

      sn = sin(0.5_wp*pi*part)
      cn = cos(0.5_wp*pi*part)
      dn = 1.0_wp
      do n = landen%steps, 1, -1
         associate (k => landen%modulus(n))
            square = cn**2
            share = 1.0_wp/(1.0_wp + k*sn**2)
            sn = (1.0_wp + k)*sn*share
            cn = cn*dn*share
            dn = (landen%complement(n) + k*square)*share
         end associate
      end do
   end subroutine jacobi

end module vcor_numeric_elliptic
