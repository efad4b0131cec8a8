!> Fractional Zener solid, a spring parallel to a spring and a fractional dashpot in series:
!> E(t) = E_0 + E_1 E_a(-(t/tau)^a). For a = 1/2 it is `cerf`, for a = 1 the standard linear solid
module vcor_material_mittag_leffler
   use, intrinsic :: ieee_arithmetic, only : ieee_negative_inf, ieee_value
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : pi, wp
   use vcor_material_type, only : check_values, equilibrium_modulus, parameter_t, poisson_ratio, &
      relaxing_modulus
   use vcor_number, only : interval_t, positive
   use vcor_material_spectrum, only : farthest_rate, fractional_t
   use vcor_numeric_mittag_leffler, only : mittag_leffler_rule_t, new_mittag_leffler_rule
   implicit none
   private

   public :: mittag_leffler_t, new_mittag_leffler, mittag_leffler_parameters

   !> Parameters of model `mittag_leffler`; with an exponent of 1 it is the standard linear solid
   type(parameter_t), parameter :: mittag_leffler_parameters(*) = [poisson_ratio, &
      equilibrium_modulus, relaxing_modulus, &
      parameter_t('exponent', 'Exponent a of the function E_a(-(t/time)^a)', '', &
      interval_t(lower=0.0_wp, lower_open=.true., upper=1.0_wp)), &
      parameter_t('time', 'Relaxation time', 's', positive)]

   !> E(t) = E_0 + E_1 E_a(-(t/tau)^a)
   type, extends(fractional_t) :: mittag_leffler_t
      private
      !> Exponent a
      real(wp) :: exponent = 0.5_wp
      !> Relaxation time tau [s]
      real(wp) :: time = 1.0_wp
      !> Rule for E_a, its derivative and its integral
      type(mittag_leffler_rule_t) :: rule
   contains
      procedure :: relaxation
      procedure :: rate
      procedure :: integral
      procedure :: complex_modulus
      procedure :: spectrum
      procedure, private :: power
   end type mittag_leffler_t

contains

   !> Build a Mittag-Leffler material
   pure subroutine new_mittag_leffler(self, equilibrium, relaxing, exponent, time, error)
      type(mittag_leffler_t), intent(out) :: self
      !> Equilibrium modulus E_0 [Pa], >= 0
      real(wp), intent(in) :: equilibrium
      !> Relaxing modulus E_1 [Pa], > 0
      real(wp), intent(in) :: relaxing
      !> Exponent a, 0 < a < 1; `new_material` of vcor_material builds a = 1 as a Prony series of
      !> one term
      real(wp), intent(in) :: exponent
      !> Relaxation time tau [s], > 0
      real(wp), intent(in) :: time
      type(error_t), allocatable, intent(out) :: error

      call check_values('mittag_leffler', mittag_leffler_parameters(2:), &
         [equilibrium, relaxing, exponent, time], error)
      if (allocated(error)) return
      if (.not. exponent < 1.0_wp) call raise(error, error_input, &
         'with an exponent of 1 a Mittag-Leffler material is a Prony series of one term')
      if (allocated(error)) return

      self%equilibrium = equilibrium
      self%relaxing = relaxing
      self%exponent = exponent
      self%time = time
      self%rule = new_mittag_leffler_rule(exponent)
      ! Q has poles where (s tau)^a = -1, at this distance from the peak in ln(s)
      self%peak = -log(time)
      self%distance = pi*(1.0_wp - exponent)/exponent
   end subroutine new_mittag_leffler

   !> (t/tau)^a
   elemental function power(self, t) result(u)
      class(mittag_leffler_t), intent(in) :: self
      !> Time [s], >= 0
      real(wp), intent(in) :: t
      !> Argument of the Mittag-Leffler function [-]
      real(wp) :: u

      ! limited so that t/tau does not overflow; the modulus has relaxed long before
      u = (min(t, 0.5_wp*huge(t)*min(self%time, 1.0_wp))/self%time)**self%exponent
   end function power

   !> Relaxation modulus E(t)
   elemental function relaxation(self, t) result(value)
      class(mittag_leffler_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Modulus [Pa]
      real(wp) :: value

      value = self%equilibrium + self%relaxing*self%rule%value(self%power(t))
   end function relaxation

   !> Rate of relaxation: -E_1 u E_{a,a}(-u)/t with u = (t/tau)^a, minus infinity at t = 0
   elemental function rate(self, t) result(value)
      class(mittag_leffler_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Rate [Pa/s], <= 0
      real(wp) :: value

      real(wp) :: fall

      value = self%relaxing
      if (.not. self%is_built()) return
      fall = self%relaxing*self%rule%slope(self%power(t))
      ! a quotient that overflows is minus infinity too
      if (fall < huge(t)*min(t, 1.0_wp)) then
         value = -fall/t
      else
         value = ieee_value(1.0_wp, ieee_negative_inf)
      end if
   end function rate

   !> Integral of E from 0 to t: t (E_0 + E_1 E_{a,2}(-u)) with u = (t/tau)^a
   elemental function integral(self, t) result(value)
      class(mittag_leffler_t), intent(in) :: self
      !> Upper limit [s], t >= 0
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: value

      value = t*(self%equilibrium + self%relaxing*self%rule%mean(self%power(t)))
   end function integral

   !> Relaxation spectrum (E_1/(4 pi)) sin(phi)/(sinh(a x/2)^2 + sin(phi/2)^2), phi = pi (1 - a), at
   !> the rate exp(x)/tau. For a near 1 it is a peak of a width of about 1 - a, for which x computed
   !> from the rate has too few digits
   elemental function spectrum(self, rate, beyond_peak) result(density)
      class(mittag_leffler_t), intent(in) :: self
      !> Rate [1/s], > 0
      real(wp), intent(in) :: rate
      !> x, the logarithm of the rate times tau
      real(wp), intent(in) :: beyond_peak
      !> Spectrum per logarithm of the rate [Pa]
      real(wp) :: density

      real(wp) :: phi

      associate (not_needed => rate)
      end associate
      phi = pi*(1.0_wp - self%exponent)
      density = 0.25_wp*self%relaxing/pi*sin(phi) &
         /(sinh(0.5_wp*self%exponent*min(abs(beyond_peak), farthest_rate))**2 + sin(0.5_wp*phi)**2)
   end function spectrum

   !> Complex modulus E_0 + E_1 p/(1 + p) with p = (s tau)^a = q exp(i phi)
   !>
   !> On the upper side of the negative real axis its imaginary part is pi times the rate times the
   !> relaxation spectrum. It is small for a near 0 or 1, as sin(phi) is, and for a near 1 has a
   !> narrow peak at q = 1, where 1 + p is small. To keep the digits, phi is measured from the
   !> nearer real half axis, and the smaller of p and 1/p is used: |1 + p|^2/|p| is the same for
   !> both
   elemental function complex_modulus(self, s) result(modulus)
      class(mittag_leffler_t), intent(in) :: self
      !> Laplace variable [1/s]; on the negative real axis the sign of its imaginary part, which may
      !> be a signed zero, selects the side
      complex(wp), intent(in) :: s
      !> Complex modulus [Pa]
      complex(wp) :: modulus

      real(wp) :: x, y, r, q, h, angle, sine, cosine, shifted, square, storage

      ! computed in the upper half plane; the value below is its conjugate
      x = real(s, wp)
      y = abs(aimag(s))
      r = min(abs(s), 0.5_wp*huge(r)/max(self%time, 1.0_wp))*self%time
      if (.not. r > 0.0_wp) then
         modulus = self%equilibrium
         return
      end if
      q = r**self%exponent
      h = q
      if (q > 1.0_wp) h = 1.0_wp/q

      ! real part of 1 + h exp(i phi)
      if (x < 0.0_wp) then
         angle = pi*(1.0_wp - self%exponent) + self%exponent*atan2(y, -x)
         sine = sin(angle)
         cosine = -cos(angle)
         shifted = (1.0_wp - h) + 2.0_wp*h*sin(0.5_wp*angle)**2
      else
         sine = sin(self%exponent*atan2(y, x))
         cosine = sin(0.5_wp*pi*(1.0_wp - self%exponent) + self%exponent*atan2(x, y))
         shifted = 1.0_wp + h*cosine
      end if
      square = shifted**2 + (h*sine)**2
      if (q > 1.0_wp) then
         storage = shifted/square
      else
         storage = h*(h + cosine)/square
      end if
      modulus = cmplx(self%equilibrium + self%relaxing*storage, &
         sign(self%relaxing*h*sine/square, aimag(s)), wp)
   end function complex_modulus

end module vcor_material_mittag_leffler
