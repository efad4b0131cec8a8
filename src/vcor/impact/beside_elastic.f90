!> Contact modulus of an elastic body and a body whose modulus is a sum of exponentials, by Eq. (1)
!> of Green's paper, as a sum of exponentials
!>
!> With the elastic modulus A, the other modulus B = B_0 + sum B_i exp(-l_i t), and c = A + B_0,
!>
!>     E' = A B/(A + B) = A B_0/c - (A^2/c) (-X + X^2 - X^3 + ...),   X = sum (B_i/c) exp(-l_i t)
!>
!> is a geometric series whose powers are sums of exponentials again: a single rate l gives the
!> rates l, 2 l, 3 l ... X is largest at t = 0, r = sum B_i/c, and n orders leave a remainder of
!> r^n. A polymer beside steel has r of 1e-4 to 1e-2.
!>
!> All products of order k add up to r^k at t = 0, so what is left out is known exactly. Relative to
!> E' it counts at most (1 + r) c/B(t) times.
module vcor_impact_beside_elastic
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   implicit none
   private

   public :: sum_beside_elastic

   !> Maximum number of exponentials: each takes 1 us per impact; fitting a hundred takes 6 ms
   integer, parameter :: most = 400

contains

   !> The contact modulus as a sum of exponentials
   pure subroutine sum_beside_elastic(elastic, other, window, tolerance, terms, is_found)
      !> Plane-strain modulus of the elastic body [Pa], > 0
      real(wp), intent(in) :: elastic
      !> Plane-strain modulus of the other body [Pa], without dashpot
      type(exponential_sum_t), intent(in) :: other
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Largest relative error, > 0
      real(wp), intent(in) :: tolerance
      !> The sum; `terms%error` includes the error of `other`
      type(exponential_sum_t), intent(out) :: terms
      !> Whether a sum of at most `most` terms meets the tolerance
      logical, intent(out) :: is_found

      ! products of the B_i/c, the empty one first; index of the last factor, and its power
      real(wp) :: product(0:most), rate(0:most), share(size(other%moduli))
      integer :: last(0:most), power(0:most)
      real(wp) :: unit, largest, least, lost, rest, part
      integer :: order, i, j, m, n, first, final

      is_found = .false.
      unit = elastic + other%equilibrium
      share = other%moduli/unit
      largest = sum(share)
      ! relative to E': B(t) is smallest at the end of the window
      part = (other%equilibrium + sum(other%moduli*exp(-other%rates*window)))/unit &
         /(1.0_wp + largest)
      if (.not. (largest < 1.0_wp .and. part > 0.0_wp)) return
      least = tolerance*part/real(4*most, wp)

      product(0) = -1.0_wp
      rate(0) = 0.0_wp
      last(0) = 1
      power(0) = 0
      lost = 0.0_wp
      n = 0
      final = -1
      do order = 1, most
         first = final + 1
         final = n
         ! each product once, with its factors in order, times the number of their arrangements
         do i = first, final
            do j = last(i), size(share)
               m = 1
               if (j == last(i)) m = power(i) + 1
               associate (next => -product(i)*share(j)*real(order, wp)/real(m, wp))
                  if (abs(next) < least) cycle
                  if (n == most) return
                  n = n + 1
                  product(n) = next
               end associate
               rate(n) = rate(i) + other%rates(j)
               last(n) = j
               power(n) = m
            end do
         end do
         lost = lost + max(0.0_wp, largest**order - abs(sum(product(final + 1:n))))
         rest = largest**(order + 1)/(1.0_wp - largest)
         if (n == final .or. rest <= 0.25_wp*tolerance*part) exit
      end do

      terms%error = (lost + rest)/part + epsilon(1.0_wp)
      is_found = terms%error <= tolerance
      terms%error = terms%error + other%error
      terms%equilibrium = elastic*(other%equilibrium/unit)
      allocate (terms%moduli, source=elastic*(elastic/unit)*product(1:n))
      allocate (terms%rates, source=rate(1:n))
   end subroutine sum_beside_elastic

end module vcor_impact_beside_elastic
