!> Materials known by their complex modulus: sums of exponentials from their relaxation spectrum,
!> functions of time by inversion of the Laplace transform
!>
!> A completely monotone modulus is E(t) = E_0 + int_0^inf H(l) exp(-l t) dl, with the spectrum
!> H(l) = Im Q(-l + i0)/(pi l) from its complex modulus Q. In y = ln(l) the integrand is analytic
!> for |Im y| < pi/2, so the trapezoidal rule of step h converges as exp(-pi^2/h). It is applied in
!> x, with
!>
!>     y + c asinh((y - y_p)/d) = x - exp(x_a - x) + exp(x - x_b),   x = 0, +-h, +-2 h ..
!>
!> Below x_a and above x_b the right-hand side diverges double-exponentially. There, exp(-l t) acts
!> on the window as 1 - l t + .. and (delta(t) - ..)/l, and a few nodes cover many decades (H.
!> Takahasi and M. Mori, Publ. RIMS 9 (1974) 721). The left-hand side is y unless the spectrum has a
!> peak at y_p so narrow that its poles y_p +- i d lie inside the strip; c = 1 - 2 d/pi moves them
!> to the edge. Rates below all nodes are lumped into a constant, those above them into a dashpot.
module vcor_material_spectrum
   use vcor_kinds, only : pi, unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t, parts
   use vcor_material_type, only : material_t
   use vcor_numeric_contour, only : contour_nodes, contour_rule
   use vcor_tuning, only : spectrum_finer
   implicit none
   private

   public :: fractional_t, sum_of_resolved_spectrum
   public :: transform_t
   public :: constant_rate, farthest_rate, finest_inversion

   !> Rate times window below which a term is lumped into the constant, above its inverse into the
   !> dashpot: over the window it then changes by 1e-14 of itself, the rounding of a sum of some
   !> fifty terms
   real(wp), parameter :: constant_rate = 1.0e-14_wp
   !> |ln| of a rate times window beyond which rates cannot be computed: exp(600) = 4e260 leaves a
   !> factor of 1e47 for the window
   real(wp), parameter :: farthest_rate = 600.0_wp
   !> Accuracy below which no sum is asked for that has to agree with an inverted transform: ten
   !> times more or less changes 109 random impacts by up to 3e-13, 0.007 stated errors
   real(wp), parameter :: finest_inversion = 3.0e-12_wp

   !> A model with fractional derivatives: its spectrum is continuous, and either a power of the
   !> rate or a single peak
   type, abstract, extends(material_t) :: fractional_t
      !> Equilibrium modulus E_0 [Pa]
      real(wp) :: equilibrium = unset
      !> Relaxing modulus E_1 [Pa], infinite for a power
      real(wp) :: relaxing = unset
      !> ln of the rate [1/s] at the peak of the spectrum; not allocated for a power
      real(wp), allocatable :: peak
      !> Distance d of the poles from the peak in ln(l), > 0
      real(wp), allocatable :: distance
   contains
      procedure :: glassy
      procedure :: rubbery
      procedure :: exponentials
   end type fractional_t

   !> A modulus given by its transform, the complex modulus Q(s) = s L{E}(s). Functions of time are
   !> computed by numerical inversion of the Laplace transform
   !>
   !>     E = L^-1{Q/s},   dE/dt = L^-1{Q},   int_0^t E = L^-1{Q/s^2}
   !>
   !> with errors of a few units in the 15th digit of E t. A dashpot, the limit of Q/s at s ->
   !> infinity, acts at time 0 and is subtracted from the integral.
   !>
   !> All singularities of Q lie on the negative real axis, so that the rule of
   !> `vcor_numeric_contour` inverts
   !>
   !>     f(t) = 1/(2 pi i) int exp(s t) F(s) ds,   s = w/t,
   !>
   !> with the same nodes w for every time: f(t) = Im(sum(weight*F(w/t)))/t.
   type, abstract, extends(material_t) :: transform_t
      private
      !> Nodes w of the inversion
      complex(wp) :: node(contour_nodes) = (0.0_wp, 0.0_wp)
      !> Weights of the inversion
      complex(wp) :: weight(contour_nodes) = (0.0_wp, 0.0_wp)
   contains
      procedure :: prepare
      procedure :: relaxation
      procedure :: rate
      procedure :: integral
   end type transform_t

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
      !> Wanted relative accuracy, > 0, < 1
      real(wp), intent(in) :: accuracy
      !> The sum, with the error of its integral
      type(exponential_sum_t), intent(out) :: terms

      call rule_for_spectrum(self, window, accuracy, 1.0_wp, terms, self%peak, self%distance)
      call terms%compare(window, self%integral(window*parts))
   end subroutine exponentials

   !> The quadrature rule as a sum, without its error
   pure subroutine rule_for_spectrum(material, window, accuracy, finer, terms, peak, distance)
      !> The material; its rubbery modulus is E_0
      class(material_t), intent(in) :: material
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0, < 1
      real(wp), intent(in) :: accuracy
      !> Power of the accuracy for which the rule is made, and by whose logarithm its ends lie
      !> farther out, for features at unknown rates; 1 without such
      real(wp), intent(in) :: finer
      type(exponential_sum_t), intent(out) :: terms
      !> ln of the rate [1/s] at the peak of the spectrum; absent: the spectrum is a power of the
      !> rate, or unknown
      real(wp), intent(in), optional :: peak
      !> Distance d of the poles from the peak in ln(l), > 0
      real(wp), intent(in), optional :: distance

      real(wp) :: h, y, w, y_p, d, c, turn_low, turn_high, slope, rate, modulus, shift, head, tail
      real(wp) :: ratio, run_low, run_high, beyond_peak
      real(wp), allocatable :: rates(:), moduli(:)
      integer :: first, last, j, n

      h = -pi**2/(finer*log(accuracy))
      turn_low = log(accuracy)/3.0_wp*log(finer)
      turn_high = -log(accuracy)/3.0_wp*(1.0_wp + log(finer))
      shift = -log(window)
      c = 0.0_wp
      d = 1.0_wp
      y_p = 0.0_wp
      if (present(peak) .and. present(distance)) then
         y_p = peak - shift
         ! seen in x, a turn at the distance D moves the poles by exp(-D) into the strip: they
         ! raise the error of the rule by exp(1)
         turn_low = min(turn_low, y_p - log(2.0_wp*pi/h))
         turn_high = max(turn_high, y_p + log(2.0_wp*pi/h))
         d = distance
         c = max(0.0_wp, 1.0_wp - 2.0_wp*d/pi)
         turn_low = turn_low + c*asinh((turn_low - y_p)/d)
         turn_high = turn_high + c*asinh((turn_high - y_p)/d)
      end if

      first = ceiling((turn_low - log(farthest_rate))/h)
      last = floor((turn_high + log(farthest_rate))/h)
      allocate (rates(last - first + 1), moduli(last - first + 1))
      terms%equilibrium = material%rubbery()
      n = 0
      head = 0.0_wp
      tail = 0.0_wp
      ratio = exp(h)
      run_low = exp(turn_low - real(first - 1, wp)*h)
      run_high = exp(real(first - 1, wp)*h - turn_high)
      do j = first, last
         run_low = run_low/ratio
         run_high = run_high*ratio
         y = real(j, wp)*h - run_low + run_high
         slope = 1.0_wp + run_low + run_high
         if (abs(y) > farthest_rate) cycle
         beyond_peak = y - y_p
         if (c > 0.0_wp) then
            w = solve_sinh(beyond_peak/d, c/d)
            beyond_peak = d*sinh(w)
            y = y_p + beyond_peak
            slope = slope*d*cosh(w)/(d*cosh(w) + c)
         end if
         rate = exp(y + shift)
         modulus = h*slope*material%spectrum(rate, beyond_peak)
         if (rate*window < constant_rate) then
            if (.not. head > 0.0_wp) head = modulus
            terms%equilibrium = terms%equilibrium + modulus
         else if (rate*window > 1.0_wp/constant_rate) then
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
      ! for an exponent near 0 part of the constant lies below all rates; E gives it
      if (head > accuracy*terms%equilibrium) terms%equilibrium = terms%equilibrium &
         + (material%relaxation(window) - terms%value(window))
      ! for an exponent near 1 part of the dashpot lies beyond all rates; the integral of E gives it
      if (tail > accuracy*terms%viscosity) terms%viscosity = terms%viscosity &
         + (material%integral(window) - terms%integral(window))
   end subroutine rule_for_spectrum

   !> Sum of exponentials for a spectrum with features at unknown rates: the rule is made finer
   !> until its integral is as accurate as wanted, or it has too many terms. The best sum is
   !> returned, with its error
   pure subroutine sum_of_resolved_spectrum(material, window, accuracy, most, terms)
      !> The material; its rubbery modulus is E_0
      class(material_t), intent(in) :: material
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0, < 1
      real(wp), intent(in) :: accuracy
      !> Number of terms beyond which it is made no finer
      integer, intent(in) :: most
      !> The sum, with the dashpot of the material
      type(exponential_sum_t), intent(out) :: terms

      type(exponential_sum_t) :: next
      real(wp) :: integrals(size(parts)), finer

      integrals = material%viscosity + material%integral(window*parts)
      terms%error = huge(1.0_wp)
      finer = 1.0_wp
      do
         call rule_for_spectrum(material, window, accuracy, finer, next)
         next%viscosity = next%viscosity + material%viscosity
         call next%compare(window, integrals)
         if (next%error < terms%error) terms = next
         if (terms%error <= accuracy .or. size(next%rates) > most) exit
         finer = spectrum_finer*finer
      end do
   end subroutine sum_of_resolved_spectrum

   !> Solve sinh(w) + b w = x by Newton's method, which converges monotonically from an upper bound
   !> of |w|, as the left-hand side is convex there
   pure function solve_sinh(x, b) result(w)
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
   end function solve_sinh

   !> Set nodes and weights of the inversion
   pure subroutine prepare(self)
      class(transform_t), intent(inout) :: self

      call contour_rule(self%node, self%weight)
   end subroutine prepare

   !> Modulus E(t)
   elemental function relaxation(self, t) result(value)
      class(transform_t), intent(in) :: self
      !> Time [s], t >= 0
      real(wp), intent(in) :: t
      !> E [Pa]
      real(wp) :: value

      if (t > 0.0_wp) then
         value = aimag(sum(self%weight*(self%complex_modulus(self%node/t)/self%node)))
      else
         value = self%glassy()
      end if
   end function relaxation

   !> Rate dE/dt at t > 0
   elemental function rate(self, t) result(value)
      class(transform_t), intent(in) :: self
      !> Time [s], t > 0
      real(wp), intent(in) :: t
      !> Rate [Pa/s], <= 0
      real(wp) :: value

      value = aimag(sum(self%weight*self%complex_modulus(self%node/t)))/t
   end function rate

   !> Integral of E from 0 to t, without the dashpot
   elemental function integral(self, t) result(value)
      class(transform_t), intent(in) :: self
      !> Upper limit [s], t >= 0
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: value

      value = 0.0_wp
      if (t > 0.0_wp) value = t*aimag(sum(self%weight &
         *(self%complex_modulus(self%node/t)/self%node**2))) - self%viscosity
   end function integral

end module vcor_material_spectrum
