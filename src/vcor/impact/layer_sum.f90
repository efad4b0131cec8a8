!> Response of a layer during an impact as internal variables
!>
!> U = instant F + sum_k c_k int_0^t exp(-l_k (t - x)) F(x) dx, in which some of the rates l_k are
!> complex conjugate pairs, as waves between the faces oscillate. Least squares fit
!> C(s) = instant + sum_k c_k/(s + l_k). Over the window the rates are the same for all layers: like
!> a Fourier series of a somewhat longer period, they can represent any response on the window.
!>
!> `instant` is the exact C(oo). The impact is stable with the sum, as it is with the layer, if C
!> plus the dent of a flat punch remains passive; so the misfit is weighted by the size of both.
!> Where it is not passive, beyond the last point, growth is too slow to matter within the window
!> of a sphere; for blunter bodies `vcor_solver_ive` refuses impacts with which it is not.
!> Beyond the equidistant rates the points leave the line Re s = 2/window, as the rates do:
!> responses there are damped, and echoes at such frequencies do not affect the motion.
!>
!> What an impact feels of the misfit at a frequency depends on the spectrum of its force, which
!> starts as a power n of time: 3/2 for a sphere, 1 for a flat punch.
!>
!> Impacts share fits. A fit is for a window and a band of footprints: its coefficients are found at
!> several radii in the band and interpolated between them. Windows and bands are steps of geometric
!> ladders, so that the sum of an impact does not depend on the impacts before it.
module vcor_impact_layer_sum
   use vcor_impact_layer, only : layer_t
   use vcor_kinds, only : pi, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_lapack, only : dgeqp3, dormqr, dtrtrs
   implicit none
   private

   public :: layer_misfit_t, layer_sum_t, new_layer_sum

   !> A band of footprints goes from ladder**band to ladder**(band + 1) m; the radii in it are the
   !> zeros of a Chebyshev polynomial of the logarithm
   real(wp), parameter :: ladder = 2.0_wp
   integer, parameter :: radii = 13

   !> Misfits of C as an impact feels them [m/N]
   type :: layer_misfit_t
      !> Of the motion
      real(wp) :: motion = 0.0_wp
      !> Of the velocity, at an end where the force is smooth, and where it is a power of the time
      !> left
      real(wp) :: smooth_end = 0.0_wp, power_end = 0.0_wp
   end type layer_misfit_t

   !> Sums of a layer for a band of footprints
   type :: layer_sum_t
      private
      !> Time up to which the sums hold [s]
      real(wp) :: window = 0.0_wp
      integer :: band = 0
      !> Power n of time as which the force starts, from 1 to 3/2
      real(wp) :: start = 0.0_wp
      !> One rate of each pair, over the inverse of the window
      complex(wp), allocatable :: pair_rate(:)
      !> Coefficients c_k at the radii: real terms, then real and imaginary parts of the pairs,
      !> times the radius [m2/(N s)], shape (terms, radii)
      real(wp), allocatable :: coefficient(:, :)
      !> Largest misfits of C at the radii, weighted for the motion and for the velocity, times the
      !> radius [m2/N]
      real(wp) :: misfit(radii) = 0.0_wp, misfit_of_rate(radii) = 0.0_wp
      !> The latter for echoes beyond the equidistant rates, and all misfits up to them
      real(wp) :: echo_of_rate(radii) = 0.0_wp
   contains
      !> Whether the sums are for a given footprint and window
      procedure :: holds
      !> Sum for a footprint
      procedure :: at
   end type layer_sum_t

   !> Pairs of rates: equidistant ones with the same `damping`, for a period of 2.4 windows, then a
   !> geometric series in which the damping is the distance of neighbours. The force of bodies
   !> blunter than a sphere has more of high frequencies, and takes twice as many
   integer, parameter :: equidistant = 40, equidistant_of_blunt = 80, series = 11
   real(wp), parameter :: step = pi/1.2_wp, damping = 3.0_wp, ratio = 1.25_wp
   !> Real rates; the first, 0, is that of a thin plate, which stays where an impulse has moved it
   integer, parameter :: slow = 17
   real(wp), parameter :: slowest = 0.3_wp, fastest = 3000.0_wp
   integer :: i_rate
   !> Real rates, over the inverse of the window
   real(wp), parameter :: rate(slow) = [0.0_wp, (slowest*(fastest/slowest)**(real(i_rate, wp) &
      /real(slow - 2, wp)), i_rate=0, slow - 2)]

   !> Points s times the window: with real part `line` and spacing `dense`, then a geometric series
   !> that departs from this line with the given slope
   real(wp), parameter :: line = 2.0_wp, dense = 0.6_wp, last = 3000.0_wp, slope = 0.1_wp
   integer, parameter :: sparse = 60
   !> Number of points beyond the equidistant rates that tell echoes
   integer, parameter :: beyond = 10

   !> Rates and points of a fit
   type :: grid_t
      !> One rate of each pair, over the inverse of the window
      complex(wp), allocatable :: pair_rate(:)
      !> Points of the fit; the first `near` are those up to the last equidistant rate
      complex(wp), allocatable :: point(:)
      integer :: near = 0
      !> Points on the line beyond the equidistant rates, in pairs one `step` apart: an echo delayed
      !> by about the window makes them differ, a shorter memory does not
      complex(wp) :: echo(2*beyond) = 0.0_wp
   end type grid_t

   !> A point beyond all rates. The misfit there is that of a dent that comes faster than the sum:
   !> of a disc that waves cross in no time, or of a power law. Its weight for the velocity at an
   !> end where the force is a power of the time left, measured
   complex(wp), parameter :: far = cmplx(4.0_wp*last, 0.0_wp, wp)
   real(wp), parameter :: weight_of_far = 5.0e-4_wp

   !> Spectrum of F over frequency w, 1/(1 + (w window/bend)^(n + 1)), as F starts and ends with the
   !> power n of time, for bodies sharper than a sphere that of a sphere; the exponent for the
   !> velocity U' is n, and that for the weights of the fit is between both for a sphere. Contacts
   !> of blunt bodies are almost as large as the footprint from the start, so their force starts
   !> steeper, and its spectrum bends later
   real(wp), parameter :: bend = 3.0_wp, sphere = 1.5_wp, power_of_fit = 2.0_wp

contains

   !> Rates and points for a force that starts as a power of time
   pure function grid_for(start) result(grid)
      !> The power, from 1 to 3/2
      real(wp), intent(in) :: start
      type(grid_t) :: grid

      real(wp), allocatable :: omega(:)
      !> Imaginary part of the last equidistant rate
      real(wp) :: first
      integer :: i, n

      n = merge(equidistant_of_blunt, equidistant, start < sphere)
      first = step*real(n, wp)
      allocate (grid%pair_rate, source=[(cmplx(damping, -step*real(i, wp), wp), i=1, n), &
         (first*ratio**i*cmplx(1.0_wp - 1.0_wp/ratio, -1.0_wp, wp), i=1, series)])
      grid%near = floor(first/dense) + 1
      omega = [(dense*real(i, wp), i=0, grid%near - 1), &
         (first*(last/first)**(real(i, wp)/real(sparse, wp)), i=1, sparse)]
      allocate (grid%point, source=cmplx(line + slope*max(omega - first, 0.0_wp), omega, wp))
      grid%echo = [(cmplx(line, first*ratio**(real(i, wp) - 0.5_wp), wp), i=1, beyond), &
         (cmplx(line, first*ratio**(real(i, wp) - 0.5_wp) + step, wp), i=1, beyond)]
   end function grid_for

   !> Index of the band that contains a footprint
   pure function band_of(footprint) result(band)
      !> Radius [m], > 0
      real(wp), intent(in) :: footprint
      integer :: band

      band = floor(log(footprint)/log(ladder))
   end function band_of

   !> Whether the sums are for a given footprint, window and exponent of the contact
   elemental function holds(self, footprint, window, exponent)
      class(layer_sum_t), intent(in) :: self
      !> Radius [m], > 0
      real(wp), intent(in) :: footprint
      !> Time [s]
      real(wp), intent(in) :: window
      !> Exponent of the contact, >= 1
      real(wp), intent(in) :: exponent
      logical :: holds

      holds = .not. abs(self%window - window) > 0.0_wp .and. self%band == band_of(footprint) &
         .and. .not. abs(self%start - min(exponent, sphere)) > 0.0_wp
   end function holds

   !> Fit the sums of the band of a footprint
   pure subroutine new_layer_sum(self, layer, footprint, window, exponent)
      !> The sums; without coefficients if LAPACK fails
      type(layer_sum_t), intent(out) :: self
      type(layer_t), intent(in) :: layer
      !> Radius of the loaded disc [m], > 0
      real(wp), intent(in) :: footprint
      !> Time up to which the sums are to hold [s], > 0
      real(wp), intent(in) :: window
      !> Exponent of the contact, >= 1
      real(wp), intent(in) :: exponent

      integer, parameter :: middle = (radii + 1)/2
      type(grid_t) :: grid
      complex(wp), allocatable :: c(:, :), column(:), all(:), left(:, :)
      real(wp), allocatable :: matrix(:, :), passive(:), size_of_force(:)
      real(wp) :: radius(radii)
      integer :: i, j, points, terms

      self%window = window
      self%band = band_of(footprint)
      self%start = min(exponent, sphere)
      radius = ladder**(real(self%band, wp) + 0.5_wp*(1.0_wp + node()))
      grid = grid_for(self%start)
      self%pair_rate = grid%pair_rate
      points = size(grid%point)
      terms = slow + 2*size(self%pair_rate)
      all = [grid%point, grid%echo, far]/window
      allocate (c(points, radii), passive(points), left(size(all), radii), matrix(2*points, terms))
      do i = 1, points
         c(i, :) = radius*layer%compliance(all(i), radius, accuracy(i)) - at_once()
         passive(i) = abs(c(i, middle)) + abs(radius(middle)*layer%dent(all(i), radius(middle))) &
            *(1.0_wp + (bend/abs(grid%point(i)))**2)
      end do
      do j = 1, terms
         column = response(j, pair_of(j), grid%point)
         matrix(:, j) = [real(column, wp), aimag(column)]
      end do
      call least_squares(matrix, 1.0_wp/(passive &
         *(1.0_wp + (abs(grid%point)/bend)**power_of_fit)), c, self%coefficient)
      if (.not. allocated(self%coefficient)) return
      size_of_force = abs([grid%point, grid%echo(:beyond)])/(bend*(1.0_wp + sphere - self%start))
      do i = 1, size(all)
         if (i <= points) then
            left(i, :) = -c(i, :)
         else
            left(i, :) = at_once() - radius*layer%compliance(all(i), radius, accuracy(i))
         end if
         do j = 1, terms
            left(i, :) = left(i, :) + response(j, pair_of(j), all(i)*window)*self%coefficient(j, :)
         end do
      end do
      do j = 1, radii
         associate (all_left => abs(left(:points + beyond, j)), size_beyond => &
                    size_of_force(points + 1:), echoes => 0.5_wp &
                    *abs(left(points + beyond + 1:points + 2*beyond, j) &
                    - left(points + 1:points + beyond, j)))
            self%misfit(j) = maxval(all_left(:points) &
               /(1.0_wp + size_of_force(:points)**(self%start + 1.0_wp)))
            self%misfit_of_rate(j) = max(weight_of_far*abs(left(size(all), j)), &
               maxval(all_left/(1.0_wp + size_of_force**self%start)))
            self%echo_of_rate(j) = max(maxval(echoes/(1.0_wp + size_beyond**self%start)), &
               maxval(all_left(:grid%near) &
               /(1.0_wp + size_of_force(:grid%near)**self%start)))
         end associate
      end do
      self%coefficient = self%coefficient/window

   contains

      !> Rate of the pair that a coefficient belongs to; any for a real term
      pure function pair_of(term) result(l)
         integer, intent(in) :: term
         complex(wp) :: l

         l = self%pair_rate(max(1, (term - slow + 1)/2))
      end function pair_of

      !> Deflection that follows the force at once, times the radius [m2/N]; the same for all radii
      pure function at_once()
         real(wp) :: at_once

         at_once = radius(middle)*layer%instant(radius(middle))
      end function at_once

      !> Accuracy of C at a point: the force contains less and less of higher frequencies
      pure function accuracy(i)
         integer, intent(in) :: i
         real(wp) :: accuracy

         accuracy = min(3.0e-9_wp*(1.0_wp + (abs(all(i)*window)/bend)**2), 1.0e-6_wp)
      end function accuracy
   end subroutine new_layer_sum

   !> Positions of the radii in the band, from -1 to 1
   pure function node()
      real(wp) :: node(radii)

      integer :: i

      node = [(cos(pi*(real(i, wp) - 0.5_wp)/real(radii, wp)), i=1, radii)]
   end function node

   !> Contribution of a coefficient to C at a point times the window
   elemental function response(term, l, s) result(c)
      !> Number of the coefficient
      integer, intent(in) :: term
      !> Rate of its pair, if it has one
      complex(wp), intent(in) :: l
      !> The point
      complex(wp), intent(in) :: s
      !> C for a coefficient of 1
      complex(wp) :: c

      if (term <= slow) then
         c = 1.0_wp/(s + rate(term))
         return
      end if
      if (mod(term - slow, 2) == 1) then
         c = 0.5_wp/(s + l) + 0.5_wp/(s + conjg(l))
      else
         c = (0.0_wp, 0.5_wp)*(1.0_wp/(s + l) - 1.0_wp/(s + conjg(l)))
      end if
   end function response

   !> Sum for a footprint
   pure subroutine at(self, footprint, terms, misfit)
      class(layer_sum_t), intent(in) :: self
      !> Radius of the loaded disc [m], in the band
      real(wp), intent(in) :: footprint
      !> U' without instant F', as a modulus: viscosity sum_k c_k, moduli -l_k c_k
      type(exponential_sum_t), intent(out) :: terms
      type(layer_misfit_t), intent(out) :: misfit

      real(wp) :: weight(radii), distance(radii), c(size(self%coefficient, 1))
      integer :: i

      ! barycentric interpolation in the logarithm of the radius
      distance = 2.0_wp*(log(footprint)/log(ladder) - real(self%band, wp)) - 1.0_wp - node()
      weight = [((-1.0_wp)**i*sin(pi*(real(i, wp) - 0.5_wp)/real(radii, wp)), i=1, radii)]
      if (any(.not. abs(distance) > 0.0_wp)) then
         weight = merge(0.0_wp, 1.0_wp, abs(distance) > 0.0_wp)
      else
         weight = weight/distance
      end if
      c = matmul(self%coefficient, weight/(sum(weight)*footprint))
      i = minloc(abs(distance), 1)
      misfit = layer_misfit_t(self%misfit(i)/footprint, self%echo_of_rate(i)/footprint, &
         self%misfit_of_rate(i)/footprint)
      terms%rates = rate/self%window
      terms%pair_rates = self%pair_rate/self%window
      terms%moduli = c(:slow)
      terms%pair_moduli = cmplx(c(slow + 1::2), c(slow + 2::2), wp)
      terms%viscosity = sum(terms%moduli) + sum(real(terms%pair_moduli, wp))
      terms%moduli = -terms%rates*terms%moduli
      terms%pair_moduli = -terms%pair_rates*terms%pair_moduli
   end subroutine at

   !> Weighted least squares with several right-hand sides, on the independent columns
   pure subroutine least_squares(matrix, weight, right, x)
      !> Matrix, rows of real parts, then of imaginary ones, shape (2*n, m); on return its factors
      real(wp), intent(inout) :: matrix(:, :)
      !> Weights of the rows, shape (n)
      real(wp), intent(in) :: weight(:)
      !> Right-hand sides, shape (n, k)
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
