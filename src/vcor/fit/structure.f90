!> Whether what a model misses of the data is more than noise
!>
!> Noise knows nothing of its neighbour, a model that is wrong misses the data in the same sense
!> over many points. So it is not the size of the residuals that tells, but their correlation with
!> the next one, rho = sum r_i r_(i+1)/sum r_i^2, in order of time or frequency. Of noise it would
!> be 0 but for the fit, which has taken from the residuals what its p parameters could follow, and
!> that is smooth. Residuals r = M e of independent noise e of one variance, with M the projection
!> on what the derivatives by the parameters do not span and A r the mean of the two neighbours
!> (rho = r'A r/r'r), have a rho of the mean and variance
!>
!>    tr(MA)/n,   2 (tr(MAMA) - tr(MA)^2/n)/(n (n + 2)),   n = m - p
!>
!> for any number m of points (J. Durbin and G. S. Watson, Biometrika 37 (1950) 409,
!> doi:10.1093/biomet/37.3-4.409).
module vcor_fit_structure
   use vcor_kinds, only : wp
   use vcor_numeric_lapack, only : dgeqrf, dorgqr
   implicit none
   private

   public :: is_structured

   !> Root mean square misfit that is as good as any data: numbers of three digits are no better
   real(wp), parameter :: negligible = 5.0e-3_wp
   !> Standard deviations above the mean that one fit in a thousand exceeds by chance
   real(wp), parameter :: unlikely = 3.1_wp
   !> Residuals more than parameters, at least: with fewer no correlation is so far above the mean
   integer, parameter :: least = 5

contains

   !> Whether neighbouring residuals have so much in common that they are no noise
   pure function is_structured(r, j, points) result(yes)
      !> Residuals of a least squares fit, one or more sequences after each other, shape (m)
      real(wp), intent(in) :: r(:)
      !> Their derivatives by the parameters that were free, of full rank, shape (m, p)
      real(wp), intent(in) :: j(:, :)
      !> Points of a sequence
      integer, intent(in) :: points
      !> True if they are not negligible and no noise, false if there are too few to tell
      logical :: yes

      real(wp) :: q(size(j, 1), size(j, 2)), aq(size(j, 1), size(j, 2)), g(size(j, 2), size(j, 2))
      real(wp) :: tau(size(j, 2)), work(32*size(j, 2)), n, mean, square, rho
      integer :: i, sequences, info

      yes = .false.
      if (size(r) < size(j, 2) + least) return
      if (norm2(r) <= negligible*sqrt(real(size(r), wp))) return
      q = j
      if (size(q, 2) > 0) then
         call dgeqrf(size(q, 1), size(q, 2), q, size(q, 1), tau, work, size(work), info)
         call dorgqr(size(q, 1), size(q, 2), size(q, 2), q, size(q, 1), tau, work, size(work), info)
      end if
      do i = 1, size(q, 2)
         aq(:, i) = neighbours(q(:, i), points)
      end do
      g = matmul(transpose(q), aq)
      sequences = size(r)/points
      n = real(size(r) - size(q, 2), wp)
      mean = -sum([(g(i, i), i=1, size(g, 1))])/n
      square = 0.5_wp*real(size(r) - sequences, wp) - 2.0_wp*sum(aq**2) + sum(g**2)
      rho = dot_product(r, neighbours(r, points))/sum(r**2)
      ! storage and loss modulus may share their noise, or one of them have next to all of it: then
      ! chance has the variance of one sequence
      yes = rho - mean > unlikely*sqrt(real(sequences, wp)*2.0_wp*(square - n*mean**2) &
         /(n*(n + 2.0_wp)))
   end function is_structured

   !> Mean of the two neighbours of each number; where there is none it counts as 0
   pure function neighbours(r, points) result(means)
      !> Numbers, one or more sequences after each other
      real(wp), intent(in) :: r(:)
      !> Numbers of a sequence
      integer, intent(in) :: points
      !> Means of neighbours, same shape
      real(wp) :: means(size(r))

      integer :: i

      means = 0.0_wp
      do i = 1, size(r) - 1
         if (mod(i, points) == 0) cycle
         means(i) = means(i) + 0.5_wp*r(i + 1)
         means(i + 1) = means(i + 1) + 0.5_wp*r(i)
      end do
   end function neighbours

end module vcor_fit_structure
