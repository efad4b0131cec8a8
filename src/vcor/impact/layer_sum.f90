!> Response of a layer on the window of an impact as internal variables
!>
!> U = instant F + sum_k c_k int_0^t exp(-l_k (t - x)) F(x) dx, some of the rates l_k in pairs of
!> complex conjugates: waves between the faces ring. C(s) = instant + sum_k c_k/(s + l_k) is fitted
!> by least squares. In units of the window the rates are the same for all layers: a Fourier series
!> on a somewhat longer one can be anything on the window.
!>
!> `instant` is the exact C(oo), not fitted. An impact on the sum stays stable as one on the layer
!> is, if the sum leaves C and the dent of a flat punch together passive: the misfit counts over the
!> size of both. What the fit leaves of it beyond its last point is too slow to grow within the
!> window. Beyond the equidistant rates the points leave the line Re s = 2/window, as far as the
!> rates do: there the response is damped, and what echoes do has no part in the motion.
!>
!> Impacts share windows and fits: a fit is one for a band of footprints, at some radii in it that
!> its coefficients are interpolated between. Windows and bands are steps of ladders, so that an
!> impact has the same sum whichever impacts come before it.
module vcor_impact_layer_sum
   use vcor_constants, only : pi
   use vcor_impact_layer, only : layer_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_lapack, only : dgeqp3, dormqr, dtrtrs
   implicit none
   private

   public :: layer_misfit_t, layer_sum_t, new_layer_sum

   !> The band of footprints: from ladder**band to ladder**(band + 1) m, and radii in it at the
   !> zeros of a Chebyshev polynomial of the logarithm
   real(wp), parameter :: ladder = 2.0_wp
   integer, parameter :: radii = 13

   !> What a sum misses of C [m/N]
   type :: layer_misfit_t
      !> As the motion feels it, in all and of echoes alone
      real(wp) :: motion = 0.0_wp, echo = 0.0_wp
      !> As the velocity feels it at an end at which the force is smooth, and at one where it is not
      real(wp) :: smooth_end = 0.0_wp, power_end = 0.0_wp
   end type layer_misfit_t

   !> Sums of a layer for the footprints of a band
   type :: layer_sum_t
      private
      !> Time up to which they hold [s]
      real(wp) :: window = 0.0_wp
      integer :: band = 0
      !> Coefficients c_k at the radii, real terms, then real and imaginary parts of the pairs,
      !> times the radius [m2/(N s)], shape (terms, radii)
      real(wp), allocatable :: coefficient(:, :)
      !> Largest misfits of C at the radii as the motion feels it and as its rate does, times the
      !> radius [m2/N]
      real(wp) :: misfit(radii) = 0.0_wp, misfit_of_rate(radii) = 0.0_wp
      !> The same of echoes alone, beyond the equidistant rates, and for the rate of all the rest
      real(wp) :: echo(radii) = 0.0_wp, echo_of_rate(radii) = 0.0_wp
   contains
      !> Whether they are for a footprint and a window
      procedure :: holds
      !> The sum for a footprint
      procedure :: at
   end type layer_sum_t

   !> Pairs of rates: equidistant ones for a period that is longer than the window, then a series
   !> with the damping of its steps, up to `top`
   integer, parameter :: equidistant = 40, series = 11
   real(wp), parameter :: step = pi/1.2_wp, damping = 3.0_wp, ratio = 1.25_wp
   !> Real rates, first that of a thin plate: it stays where an impulse has moved it
   integer, parameter :: slow = 17
   real(wp), parameter :: slowest = 0.3_wp, fastest = 3000.0_wp
   integer :: i_rate
   !> The last of the equidistant rates
   real(wp), parameter :: first = step*real(equidistant, wp)
   !> Real rates, and one of each pair, times the window
   real(wp), parameter :: rate(slow) = [0.0_wp, (slowest*(fastest/slowest)**(real(i_rate, wp) &
      /real(slow - 2, wp)), i_rate=0, slow - 2)]
   complex(wp), parameter :: pair_rate(equidistant + series) = [ &
      (cmplx(damping, -step*real(i_rate, wp), wp), i_rate=1, equidistant), &
      (first*ratio**i_rate*cmplx(1.0_wp - 1.0_wp/ratio, -1.0_wp, wp), i_rate=1, series)]
   !> Terms and coefficients
   integer, parameter :: terms_of_fit = slow + 2*(equidistant + series)

   !> Points times the window: on the line with this distance, then a series that leaves it with
   !> this slope
   real(wp), parameter :: line = 2.0_wp, dense = 0.6_wp, last = 3000.0_wp, slope = 0.1_wp
   integer, parameter :: near = floor(first/dense) + 1, sparse = 60, points = near + sparse
   real(wp), parameter :: omega(points) = [(dense*real(i_rate, wp), i_rate=0, near - 1), &
      (first*(last/first)**(real(i_rate, wp)/real(sparse, wp)), i_rate=1, sparse)]
   complex(wp), parameter :: point(points) = [(cmplx(line + slope*max(omega(i_rate) - first, &
      0.0_wp), omega(i_rate), wp), i_rate=1, points)]
   !> Points on the line beyond the equidistant rates, in pairs that are a step apart: what they
   !> differ by is an echo of about the window, the rest has no memory as long as that
   integer, parameter :: beyond = 10
   complex(wp), parameter :: echo(2*beyond) = [ &
      (cmplx(line, first*ratio**(real(i_rate, wp) - 0.5_wp), wp), i_rate=1, beyond), &
      (cmplx(line, first*ratio**(real(i_rate, wp) - 0.5_wp) + step, wp), i_rate=1, beyond)]

   !> Error of the rate beyond all rates, over what stands in for it elsewhere, measured
   real(wp), parameter :: beyond_rates = 5.0e-3_wp

   !> F has parts of the frequency w as 1/(1 + (w window/bend)^power): its start and end are powers
   !> 1.5 of time; for the velocity U' they count for more, and the fit stands between them
   real(wp), parameter :: bend = 3.0_wp, power = 2.5_wp, power_of_rate = 1.5_wp, &
      power_of_fit = 2.0_wp

contains

   !> Band of a footprint
   pure function band_of(footprint) result(band)
      !> Radius [m], > 0
      real(wp), intent(in) :: footprint
      integer :: band

      band = floor(log(footprint)/log(ladder))
   end function band_of

   !> Whether the sums are for a footprint and a window
   elemental function holds(self, footprint, window)
      class(layer_sum_t), intent(in) :: self
      !> Radius [m], > 0
      real(wp), intent(in) :: footprint
      !> Time [s]
      real(wp), intent(in) :: window
      logical :: holds

      holds = .not. abs(self%window - window) > 0.0_wp .and. self%band == band_of(footprint)
   end function holds

   !> Fit the sums of the band of a footprint
   pure subroutine new_layer_sum(self, layer, footprint, window)
      !> The sums; without coefficients if LAPACK fails
      type(layer_sum_t), intent(out) :: self
      type(layer_t), intent(in) :: layer
      !> Radius of the disc that is loaded [m], > 0
      real(wp), intent(in) :: footprint
      !> Time up to which the sums are to hold [s], > 0
      real(wp), intent(in) :: window

      integer, parameter :: middle = (radii + 1)/2
      complex(wp) :: c(points, radii), column(points)
      complex(wp) :: all(points + 2*beyond), left(points + 2*beyond, radii)
      real(wp) :: tail, radius(radii), passive(points), size_of_force(points + beyond)
      real(wp), allocatable :: matrix(:, :)
      integer :: i, j

      self%window = window
      self%band = band_of(footprint)
      radius = ladder**(real(self%band, wp) + 0.5_wp*(1.0_wp + node()))
      all = [point, echo]/window
      do i = 1, points
         c(i, :) = radius*layer%compliance(all(i), radius, accuracy(i)) - at_once()
         passive(i) = abs(c(i, middle)) + abs(radius(middle)*layer%dent(all(i), radius(middle))) &
            *(1.0_wp + (bend/abs(point(i)))**2)
      end do
      allocate (matrix(2*points, terms_of_fit))
      do j = 1, terms_of_fit
         column = response(j, point)
         matrix(:, j) = [real(column, wp), aimag(column)]
      end do
      call least_squares(matrix, 1.0_wp/(passive &
         *(1.0_wp + (abs(point)/bend)**power_of_fit)), c, self%coefficient)
      if (.not. allocated(self%coefficient)) return
      size_of_force = abs([point, echo(:beyond)])/bend
      ! a dent that goes on beyond all rates, as that of a power law, counts as the root of time
      tail = 0.0_wp
      if (.not. abs(at_once()) > 0.0_wp) tail = beyond_rates*radius(middle) &
         *abs(layer%dent(point(points)/window, radius(middle)))*sqrt(bend/abs(point(points)))
      do i = 1, size(all)
         if (i <= points) then
            left(i, :) = -c(i, :)
         else
            left(i, :) = at_once() - radius*layer%compliance(all(i), radius, accuracy(i))
         end if
         do j = 1, terms_of_fit
            left(i, :) = left(i, :) + response(j, all(i)*window)*self%coefficient(j, :)
         end do
      end do
      do j = 1, radii
         associate (all_left => abs(left(:points + beyond, j)), size_beyond => &
                    size_of_force(points + 1:), echoes => 0.5_wp &
                    *abs(left(points + beyond + 1:, j) - left(points + 1:points + beyond, j)))
            self%misfit(j) = maxval(all_left(:points)/(1.0_wp + size_of_force(:points)**power))
            self%misfit_of_rate(j) = max(tail, &
               maxval(all_left/(1.0_wp + size_of_force**power_of_rate)))
            self%echo(j) = maxval(echoes/(1.0_wp + size_beyond**power))
            self%echo_of_rate(j) = max(maxval(echoes/(1.0_wp + size_beyond**power_of_rate)), &
               maxval(all_left(:near)/(1.0_wp + size_of_force(:near)**power_of_rate)))
         end associate
      end do
      self%coefficient = self%coefficient/window

   contains

      !> What follows the force at once, times the radius [m2/N]: the same for all
      pure function at_once()
         real(wp) :: at_once

         at_once = radius(middle)*layer%instant(radius(middle))
      end function at_once

      !> Accuracy of C at a point, where the force has less and less of the frequency
      pure function accuracy(i)
         integer, intent(in) :: i
         real(wp) :: accuracy

         accuracy = min(3.0e-9_wp*(1.0_wp + (abs(all(i)*window)/bend)**2), 1.0e-6_wp)
      end function accuracy
   end subroutine new_layer_sum

   !> Positions of the radii in their band, from -1 to 1
   pure function node()
      real(wp) :: node(radii)

      integer :: i

      node = [(cos(pi*(real(i, wp) - 0.5_wp)/real(radii, wp)), i=1, radii)]
   end function node

   !> What a coefficient adds to C at a point times the window
   elemental function response(term, s) result(c)
      !> Number of the coefficient
      integer, intent(in) :: term
      !> The point
      complex(wp), intent(in) :: s
      !> Part of C for a coefficient of 1
      complex(wp) :: c

      if (term <= slow) then
         c = 1.0_wp/(s + rate(term))
         return
      end if
      associate (l => pair_rate((term - slow + 1)/2))
         if (mod(term - slow, 2) == 1) then
            c = 0.5_wp/(s + l) + 0.5_wp/(s + conjg(l))
         else
            c = (0.0_wp, 0.5_wp)*(1.0_wp/(s + l) - 1.0_wp/(s + conjg(l)))
         end if
      end associate
   end function response

   !> The sum for a footprint
   pure subroutine at(self, footprint, terms, misfit)
      class(layer_sum_t), intent(in) :: self
      !> Radius of the disc that is loaded [m], in the band
      real(wp), intent(in) :: footprint
      !> U' but for instant F': with c_k the viscosity is sum_k c_k and the moduli are -l_k c_k
      type(exponential_sum_t), intent(out) :: terms
      type(layer_misfit_t), intent(out) :: misfit

      real(wp) :: weight(radii), distance(radii), c(terms_of_fit)
      integer :: i

      ! barycentric interpolation in ln a
      distance = 2.0_wp*(log(footprint)/log(ladder) - real(self%band, wp)) - 1.0_wp - node()
      weight = [((-1.0_wp)**i*sin(pi*(real(i, wp) - 0.5_wp)/real(radii, wp)), i=1, radii)]
      if (any(.not. abs(distance) > 0.0_wp)) then
         weight = merge(0.0_wp, 1.0_wp, abs(distance) > 0.0_wp)
      else
         weight = weight/distance
      end if
      c = matmul(self%coefficient, weight/(sum(weight)*footprint))
      i = minloc(abs(distance), 1)
      misfit = layer_misfit_t(self%misfit(i)/footprint, self%echo(i)/footprint, &
         self%echo_of_rate(i)/footprint, self%misfit_of_rate(i)/footprint)
      terms%rates = rate/self%window
      terms%pair_rates = pair_rate/self%window
      terms%moduli = c(:slow)
      terms%pair_moduli = cmplx(c(slow + 1::2), c(slow + 2::2), wp)
      terms%viscosity = sum(terms%moduli) + sum(real(terms%pair_moduli, wp))
      terms%moduli = -terms%rates*terms%moduli
      terms%pair_moduli = -terms%pair_rates*terms%pair_moduli
   end subroutine at

   !> Weighted least squares with many right sides, as far as the columns are independent
   pure subroutine least_squares(matrix, weight, right, x)
      !> Matrix, rows of real parts, then of imaginary ones, shape (2*n, m); on return its factors
      real(wp), intent(inout) :: matrix(:, :)
      !> Weights of the rows, shape (n)
      real(wp), intent(in) :: weight(:)
      !> Right sides, shape (n, k)
      complex(wp), intent(in) :: right(:, :)
      !> Solutions, shape (m, k); not allocated if LAPACK fails
      real(wp), allocatable, intent(out) :: x(:, :)

      real(wp), parameter :: dependent = 1.0e-12_wp
      real(wp), allocatable :: y(:, :), work(:)
      real(wp) :: tau(size(matrix, 2)), length(size(matrix, 2))
      integer :: pivot(size(matrix, 2)), rows, m, n, k, j, info

      rows = size(matrix, 1)
      m = size(matrix, 2)
      k = size(right, 2)
      do j = 1, m
         matrix(:, j) = matrix(:, j)*[weight, weight]
         length(j) = norm2(matrix(:, j))
         matrix(:, j) = matrix(:, j)/length(j)
      end do
      pivot = 0
      allocate (work(70*m), y(rows, k))
      call dgeqp3(rows, m, matrix, rows, pivot, tau, work, size(work), info)
      if (info /= 0) return
      n = count([(abs(matrix(j, j)) > dependent*abs(matrix(1, 1)), j=1, m)])
      do j = 1, k
         y(:, j) = [weight*real(right(:, j), wp), weight*aimag(right(:, j))]
      end do
      call dormqr('L', 'T', rows, k, n, matrix, rows, tau, y, rows, work, size(work), info)
      if (info == 0) call dtrtrs('U', 'N', 'N', n, k, matrix, rows, y, rows, info)
      if (info /= 0) return
      allocate (x(m, k), source=0.0_wp)
      x(pivot(:n), :) = y(:n, :)
      do j = 1, k
         x(:, j) = x(:, j)/length
      end do
   end subroutine least_squares

end module vcor_impact_layer_sum
