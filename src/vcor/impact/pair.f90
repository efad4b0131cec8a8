!> Contact modulus of a pair of bodies, Eq. (1) of Green's paper, as a sum of exponentials: a series
!> if one body is elastic, else a fit
!>
!> With an elastic modulus A, the other modulus B = B_0 + sum B_i exp(-l_i t), and c = A + B_0,
!>
!>     E' = A B/(A + B) = A B_0/c - (A^2/c) (-X + X^2 - X^3 + ...),   X = sum (B_i/c) exp(-l_i t)
!>
!> is a geometric series whose powers are sums of exponentials again: a single rate l gives the
!> rates l, 2 l, 3 l ... X is largest at t = 0, r = sum B_i/c, and n orders leave a remainder of
!> r^n. A polymer on steel has r of 1e-4 to 1e-2.
!>
!> All products of order k add up to r^k at t = 0, so what is left out is known exactly. Relative to
!> E' it counts at most (1 + r) c/B(t) times.
!>
!> The signs of the powers alternate: the modulus of a pair is not completely monotone even if those
!> of both bodies are. So the fit has moduli of either sign, by linear least squares with rates on a
!> fixed grid, fine enough for any mixture of exponentials; a coarser grid misses single relaxation
!> times between its rates.
!>
!> In units of the window the samples, weights and rates are the same for
!> all fits, and so is the QR factorisation of the matrix. It takes a few milliseconds and is made
!> once; a fit is a product with Q^T and a triangular solution. By column pivoting each column is
!> the one that depends least on those before it; the last ones, which would make the moduli large
!> and the misfit hardly smaller, are left out.
module vcor_impact_pair
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t, parts
   use vcor_numeric_lapack, only : dgeqp3, dorgqr, dtrtrs
   use vcor_numeric_quadrature, only : graded_rule
   use vcor_tuning, only : most => sum_most, pair_fast, pair_independent, pair_spacing, &
      sum_samples
   implicit none
   private

   public :: first_sample, sum_with_elastic, signed_fit_t, new_signed_fit

   !> Times, in units of the window, up to which the modulus is integrated. The modulus may be
   !> singular at 0 and is smooth in the logarithm of time afterwards
   real(wp), parameter :: ends(*) = [1.0e-4_wp, 3.0e-4_wp, 1.0e-3_wp, 3.0e-3_wp, 0.01_wp, 0.03_wp, &
      0.1_wp, parts]
   !> Index in `ends` of the time from which values of the fit count; before, only its integral
   integer, parameter :: checked = 5
   !> That time, in units of the window
   real(wp), parameter :: first_sample = ends(checked)

   !> Data that all fits share, in units of the window
   type :: signed_fit_t
      private
      !> Times of the samples, then the nodes of the integrals, shape (samples + nodes)
      real(wp), allocatable, public :: time(:)
      !> Number of samples
      integer :: samples = 0
      !> Weights of the samples, shape (samples)
      real(wp), allocatable :: weight(:)
      !> Rates, the first is 0, shape (n)
      real(wp), allocatable :: rate(:)
      !> Q^T of the weighted, normalised and pivoted columns, shape (n, samples)
      real(wp), allocatable :: q(:, :)
      !> R, shape (n, n)
      real(wp), allocatable :: r(:, :)
      !> Lengths of the weighted columns, shape (n)
      real(wp), allocatable :: length(:)
      !> Number of nodes below each of `ends`
      integer :: last(size(ends)) = 0
      !> Weights of the nodes, shape (nodes)
      real(wp), allocatable :: share(:)
   contains
      procedure :: fit
   end type signed_fit_t

contains

   !> The contact modulus with an elastic body as a sum of exponentials
   pure subroutine sum_with_elastic(elastic, other, window, tolerance, terms, is_found)
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
   end subroutine sum_with_elastic

   !> Compute the data that all fits share
   pure subroutine new_signed_fit(self)
      !> The data; without factors if LAPACK fails, and then the error of every sum is huge
      type(signed_fit_t), intent(out) :: self

      call set_nodes(self)
      call set_factors(self)
   end subroutine new_signed_fit

   !> Set samples and nodes of the integrals
   pure subroutine set_nodes(self)
      type(signed_fit_t), intent(inout) :: self

      real(wp), allocatable :: time(:), node(:)
      integer :: i, last

      ! up to rates whose inverse is rounding
      last = 0
      do while (rate_at(real(last, wp))*epsilon(1.0_wp) < 1.0_wp)
         last = last + 1
      end do
      self%rate = [(rate_at(real(i, wp)), i=0, last)]
      time = [(1.0_wp/(1.0_wp + rate_at(real(i, wp)/real(sum_samples, wp))), &
         i=sum_samples*last, 0, -1)]
      self%samples = size(time)
      ! the integral up to the first checked time is set by itself, so what remains of a misfit in
      ! the force is its first moment: by t^2 in the logarithm of time
      self%weight = min(1.0_wp, time/ends(checked))**2

      call graded_rule(ends, node, self%share, self%last)
      self%time = [time, node]

   contains

      !> Rates, numbered from 0: the first is 0, the next are equally spaced in the logarithm, and a
      !> few at the end cover many decades
      pure real(wp) function rate_at(number)
         real(wp), intent(in) :: number

         associate (z => exp(pair_spacing*number) - 1.0_wp)
            rate_at = z*exp(z/pair_fast)
         end associate
      end function rate_at
   end subroutine set_nodes

   !> Factorise the matrix
   pure subroutine set_factors(self)
      !> The data, its nodes set
      type(signed_fit_t), intent(inout) :: self

      real(wp), allocatable :: matrix(:, :), work(:)
      real(wp) :: tau(size(self%rate)), length(size(self%rate))
      integer :: pivot(size(self%rate)), j, n, info

      n = size(self%rate)
      ! LAPACK's blocks of 64 columns need no more
      allocate (matrix(self%samples, n), work(70*n))
      do j = 1, n
         matrix(:, j) = self%weight*exp(-self%rate(j)*self%time(:self%samples))
         length(j) = norm2(matrix(:, j))
         matrix(:, j) = matrix(:, j)/length(j)
      end do
      ! the constant is always the first column
      pivot = 0
      pivot(1) = 1
      call dgeqp3(self%samples, n, matrix, self%samples, pivot, tau, work, size(work), info)
      if (info == 0) then
         n = count([(abs(matrix(j, j)) > pair_independent*abs(matrix(1, 1)), j=1, n)])
         self%r = matrix(:n, :n)
         call dorgqr(self%samples, n, n, matrix, self%samples, tau, work, size(work), info)
      end if
      if (info /= 0) return
      self%q = transpose(matrix(:, :n))
      self%rate = self%rate(pivot(:n))
      self%length = length(pivot(:n))
   end subroutine set_factors

   !> Fit a modulus
   pure subroutine fit(self, window, modulus, terms)
      class(signed_fit_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Modulus at `time` times the window [Pa], >= 0, shape (n)
      real(wp), intent(in) :: modulus(:)
      !> The sum; its moduli may be negative
      type(exponential_sum_t), intent(out) :: terms

      real(wp) :: moduli(size(self%rate)), integrals(size(ends))
      integer :: i, n, info

      if (.not. allocated(self%q)) then
         terms%error = huge(terms%error)
         allocate (terms%moduli(0), terms%rates(0))
         return
      end if
      associate (integrand => self%share*modulus(self%samples + 1:), last => self%last)
         integrals(1) = sum(integrand(:last(1)))
         do i = 2, size(ends)
            integrals(i) = integrals(i - 1) + sum(integrand(last(i - 1) + 1:last(i)))
         end do
      end associate
      n = size(self%rate)
      moduli = matmul(self%q, self%weight*modulus(:self%samples))
      call dtrtrs('U', 'N', 'N', n, 1, self%r, n, moduli, n, info)
      moduli = moduli/self%length
      terms%equilibrium = moduli(1)
      terms%rates = [self%rate(2:), maxval(self%rate)]/window
      terms%moduli = [moduli(2:), 0.0_wp]
      ! one term of the fastest rate corrects the integral up to the time from which values count
      terms%moduli(n) = (integrals(checked)*window - terms%integral(ends(checked)*window)) &
         *terms%rates(n)
      call terms%compare(window, integrals(size(ends) - size(parts) + 1:)*window)
      do i = checked + 1, size(ends) - size(parts)
         terms%error = max(terms%error, &
            abs(terms%integral(ends(i)*window)/(integrals(i)*window) - 1.0_wp))
      end do
   end subroutine fit

end module vcor_impact_pair
