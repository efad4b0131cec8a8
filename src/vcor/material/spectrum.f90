!> Materials with a continuous spectrum of relaxation as sums of exponentials
!>
!> A completely monotone modulus is E(t) = E_0 + int_0^inf H(l) exp(-l t) dl, and its complex
!> modulus Q gives the spectrum at once: H(l) = Im Q(-l + i0)/(pi l). In y = ln(l) the trapezoidal
!> rule of step h converges exponentially, as exp(-pi^2/h), since the integrand is analytic for
!> |Im y| < pi/2. It is applied in x, with
!>
!>     y + c asinh((y - y_p)/d) = x - exp(x_a - x) + exp(x - x_b),   x = 0, +-h, +-2 h ..
!>
!> The right-hand side runs away doubly exponentially below x_a and above x_b, where exp(-l t) has
!> become 1 - l t + .. and (delta(t) - ..)/l on the window: few nodes cover what would be
!> many decades (H. Takahasi and M. Mori, Publ. RIMS 9 (1974) 721). The left-hand side is y but for
!> spectra with a peak at y_p so narrow that their poles, at y_p +- i d, lie inside the strip; with
!> c = 1 - 2 d/pi they move out to its edge.
!> What lies below all nodes is a constant, what lies above them a dashpot.
module vcor_material_spectrum
   use vcor_constants, only : pi
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_tuning, only : above_peak, below_peak, farther_above, farther_below, &
      loosest_sum, most_runs, negligible_tail, share_of_integral, slow_run
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: fractional_t, sum_of_resolved_spectrum, rule_for_spectrum

   !> A rate this small against that of the window is a constant, its inverse a dashpot
   real(wp), parameter :: constant = 1.0e-14_wp

   !> A material with a continuous spectrum that is a power of the rate, or has one peak: that of a
   !> model with a fractional derivative
   type, abstract, extends(material_t) :: fractional_t
      !> Equilibrium modulus E_0 [Pa]
      real(wp) :: equilibrium = 0.0_wp
      !> Relaxing modulus E_1 [Pa], infinite for a power
      real(wp) :: relaxing = 0.0_wp
      !> ln of the rate [1/s] at which the spectrum has its peak; not allocated for a power
      real(wp), allocatable :: peak
      !> Distance of the poles from the peak in ln(l), > 0
      real(wp), allocatable :: distance
   contains
      procedure :: glassy
      procedure :: rubbery
      procedure :: exponentials
   end type fractional_t

contains

   !> Glassy modulus E_0 + E_1
   pure function glassy(self) result(modulus)
      class(fractional_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = self%equilibrium + self%relaxing
   end function glassy

   !> Rubbery modulus E_0
   pure function rubbery(self) result(modulus)
      class(fractional_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = self%equilibrium
   end function rubbery

   !> The modulus as a sum of exponentials, from its spectrum
   pure subroutine exponentials(self, window, accuracy, terms)
      class(fractional_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      !> The sum; its error is the largest one found at some times of the window
      type(exponential_sum_t), intent(out) :: terms

      call rule_for_spectrum(self, window, accuracy, terms, self%peak, self%distance)
      terms%error = largest_error(self, window, terms)
   end subroutine exponentials

   !> The rule by itself, its error not known
   pure subroutine rule_for_spectrum(material, window, accuracy, terms, peak, distance, finer, &
                                     below, above)
      !> The material; its rubbery modulus is E_0
      class(material_t), intent(in) :: material
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      type(exponential_sum_t), intent(out) :: terms
      !> ln of the rate [1/s] at which the spectrum has its peak; absent: it is a power of the rate
      real(wp), intent(in), optional :: peak
      !> Distance d of the poles from the peak in ln(l), > 0
      real(wp), intent(in), optional :: distance
      !> What the step is divided by; absent: 1
      real(wp), intent(in), optional :: finer
      !> How much farther out the run to slow rates begins, as ln of the rate; absent: 0
      real(wp), intent(in), optional :: below
      !> The same for the run to fast rates
      real(wp), intent(in), optional :: above

      ! beyond all rates that can be computed with
      real(wp), parameter :: farthest = 600.0_wp
      real(wp) :: h, y, w, y_p, d, c, turn_low, turn_high, slope, rate, modulus, shift, tail
      real(wp) :: ratio, run_low, run_high, beyond_peak
      real(wp), allocatable :: rates(:), moduli(:)
      integer :: first, last, j, n

      h = -pi**2/log(min(accuracy, loosest_sum))
      turn_low = log(slow_run)
      turn_high = -log(min(accuracy, loosest_sum))/3.0_wp
      if (present(finer)) h = h/finer
      if (present(below)) turn_low = turn_low - below
      if (present(above)) turn_high = turn_high + above
      shift = -log(window)
      c = 0.0_wp
      d = 1.0_wp
      y_p = 0.0_wp
      if (present(peak) .and. present(distance)) then
         y_p = peak - shift
         ! the runs are to begin where the spectrum has become a power of the rate
         turn_low = min(turn_low, y_p - below_peak)
         turn_high = max(turn_high, y_p + above_peak)
         d = distance
         c = max(0.0_wp, 1.0_wp - 2.0_wp*d/pi)
         turn_low = turn_low + c*asinh((turn_low - y_p)/d)
         turn_high = turn_high + c*asinh((turn_high - y_p)/d)
      end if

      first = ceiling((turn_low - log(farthest))/h)
      last = floor((turn_high + log(farthest))/h)
      allocate (rates(last - first + 1), moduli(last - first + 1))
      terms%equilibrium = material%rubbery()
      n = 0
      tail = 0.0_wp
      ratio = exp(h)
      run_low = exp(turn_low - real(first - 1, wp)*h)
      run_high = exp(real(first - 1, wp)*h - turn_high)
      do j = first, last
         run_low = run_low/ratio
         run_high = run_high*ratio
         y = real(j, wp)*h - run_low + run_high
         slope = 1.0_wp + run_low + run_high
         if (abs(y) > farthest) cycle
         beyond_peak = y - y_p
         if (c > 0.0_wp) then
            w = spread_over_peak(beyond_peak/d, c/d)
            beyond_peak = d*sinh(w)
            y = y_p + beyond_peak
            slope = slope*d*cosh(w)/(d*cosh(w) + c)
         end if
         rate = exp(y + shift)
         modulus = h*slope*material%spectrum(rate, beyond_peak)
         if (rate*window < constant) then
            terms%equilibrium = terms%equilibrium + modulus
         else if (rate*window > 1.0_wp/constant) then
            tail = modulus/rate
            terms%viscosity = terms%viscosity + tail
         else
            n = n + 1
            rates(n) = rate
            moduli(n) = modulus
         end if
      end do
      allocate (terms%moduli, source=moduli(:n))
      allocate (terms%rates, source=rates(:n))
      ! an exponent next to 1 has a part of its dashpot beyond all rates: the integral tells it
      if (tail > negligible_tail*accuracy*terms%viscosity) terms%viscosity = terms%viscosity &
         + (material%integral(window) - terms%integral(window))
   end subroutine rule_for_spectrum

   !> Sum of exponentials for a material whose spectrum has its features where it pleases: refined
   !> until the modulus and its integral are met. Where that does not happen the best sum is
   !> returned, and its error tells
   pure subroutine sum_of_resolved_spectrum(material, window, accuracy, terms)
      !> The material; its rubbery modulus is E_0, and its dashpot is not in the sum
      class(material_t), intent(in) :: material
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      type(exponential_sum_t), intent(out) :: terms

      real(wp), parameter :: part(2) = [1.0_wp, 0.01_wp]
      type(exponential_sum_t) :: sum_now
      real(wp) :: expected, found
      integer :: i, refinement

      terms%error = huge(1.0_wp)
      do refinement = 0, most_runs
         call rule_for_spectrum(material, window, accuracy, sum_now, finer=2.0_wp**refinement, &
            below=farther_below*real(refinement, wp), &
            above=farther_above*real(refinement, wp))
         sum_now%error = largest_error(material, window, sum_now)
         do i = 1, size(part)
            expected = material%integral(part(i)*window)
            found = sum_now%integral(part(i)*window)
            sum_now%error = max(sum_now%error, share_of_integral*abs(found/expected - 1.0_wp))
         end do
         if (sum_now%error < terms%error) terms = sum_now
         if (terms%error <= 2.0_wp*accuracy) exit
      end do
   end subroutine sum_of_resolved_spectrum

   !> Solve sinh(w) + b w = x by Newton's method: sinh is convex on the side of the root, so from an
   !> upper bound of |w| it descends
   pure function spread_over_peak(x, b) result(w)
      !> Right-hand side
      real(wp), intent(in) :: x
      !> Coefficient, > 0
      real(wp), intent(in) :: b
      !> Solution
      real(wp) :: w

      real(wp) :: correction
      integer :: iteration

      w = sign(min(abs(x)/b, asinh(abs(x))), x)
      do iteration = 1, 60
         correction = (sinh(w) + b*w - x)/(cosh(w) + b)
         w = w - correction
         if (abs(correction) <= 1.0e-12_wp*abs(w)) exit
      end do
   end function spread_over_peak

   !> Largest relative error of a sum at some times of the window. For shorter times the error may
   !> be larger; what counts there are the integrals of the modulus, which are kept
   pure function largest_error(material, window, terms) result(error)
      class(material_t), intent(in) :: material
      !> Time up to which the sum is to hold [s]
      real(wp), intent(in) :: window
      type(exponential_sum_t), intent(in) :: terms
      real(wp) :: error

      ! the window in parts of equal length: one exponential tells a term at the ends of them all
      integer, parameter :: parts = 5
      real(wp) :: value(parts), decay, term
      integer :: i, k

      value = terms%equilibrium
      do k = 1, size(terms%rates)
         decay = exp(-terms%rates(k)*(window/real(parts, wp)))
         term = terms%moduli(k)
         do i = 1, parts
            term = term*decay
            value(i) = value(i) + term
         end do
      end do
      error = 0.0_wp
      do i = 1, parts
         error = max(error, abs(value(i)/material%relaxation(real(i, wp)/real(parts, wp)*window) &
            - 1.0_wp))
      end do
   end function largest_error

end module vcor_material_spectrum
