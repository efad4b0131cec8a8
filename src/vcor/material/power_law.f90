!> Fractional Kelvin-Voigt solid, a spring parallel to a fractional dashpot, which Bagley and Torvik
!> fitted to BUTYL B252: E(t) = E_0 + C t^-a/Gamma(1 - a)
module vcor_material_power_law
   use, intrinsic :: ieee_arithmetic, only : ieee_positive_inf, ieee_value
   use vcor_error, only : error_t
   use vcor_kinds, only : unset, wp
   use vcor_material_type, only : check_values, equilibrium_modulus, parameter_t, poisson_ratio
   use vcor_number, only : between_0_and_1, positive
   use vcor_material_spectrum, only : fractional_t
   implicit none
   private

   public :: power_law_t, new_power_law, power_law_parameters

   !> Parameters of model `power_law`
   type(parameter_t), parameter :: power_law_parameters(*) = [poisson_ratio, &
      equilibrium_modulus, &
      parameter_t('coefficient', 'Coefficient C of C t^-a / Gamma(1-a)', 'Pa s^a', positive), &
      parameter_t('exponent', 'Exponent a of C t^-a / Gamma(1-a)', '', between_0_and_1)]

   !> E(t) = E_0 + C t^-a/Gamma(1 - a), Eq. (23-b) with a = 1/2
   type, extends(fractional_t) :: power_law_t
      private
      !> Coefficient C [Pa s^a]
      real(wp) :: coefficient = 0.0_wp
      !> Exponent a
      real(wp) :: exponent = 0.5_wp
      !> C/Gamma(1 - a) [Pa s^a]
      real(wp) :: factor = unset
   contains
      procedure :: relaxation
      procedure :: rate
      procedure :: integral
      procedure :: complex_modulus
   end type power_law_t

contains

   !> Build a power law
   pure subroutine new_power_law(self, equilibrium, coefficient, exponent, error)
      type(power_law_t), intent(out) :: self
      !> Equilibrium modulus E_0 [Pa], >= 0
      real(wp), intent(in) :: equilibrium
      !> Coefficient C [Pa s^a], > 0
      real(wp), intent(in) :: coefficient
      !> Exponent a, 0 < a < 1
      real(wp), intent(in) :: exponent
      type(error_t), allocatable, intent(out) :: error

      call check_values('power_law', power_law_parameters(2:), &
         [equilibrium, coefficient, exponent], error)
      if (allocated(error)) return

      self%equilibrium = equilibrium
      self%relaxing = ieee_value(1.0_wp, ieee_positive_inf)
      self%coefficient = coefficient
      self%exponent = exponent
      self%factor = coefficient/gamma(1.0_wp - exponent)
   end subroutine new_power_law

   !> Relaxation modulus E(t), infinite at t = 0
   elemental function relaxation(self, t) result(value)
      class(power_law_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Modulus [Pa]
      real(wp) :: value

      if (t > 0.0_wp) then
         value = self%equilibrium + self%factor*t**(-self%exponent)
      else
         value = self%relaxing
      end if
   end function relaxation

   !> Rate of relaxation dE/dt, minus infinity at t = 0
   elemental function rate(self, t) result(value)
      class(power_law_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Rate [Pa/s], <= 0
      real(wp) :: value

      if (t > 0.0_wp) then
         value = -self%exponent*self%factor*t**(-self%exponent - 1.0_wp)
      else
         value = -self%relaxing
      end if
   end function rate

   !> Integral of E from 0 to t: E_0 t + C t^(1-a)/((1 - a) Gamma(1 - a))
   elemental function integral(self, t) result(value)
      class(power_law_t), intent(in) :: self
      !> Upper limit [s], t >= 0
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: value

      value = self%equilibrium*t &
         + self%factor*t**(1.0_wp - self%exponent)/(1.0_wp - self%exponent)
   end function integral

   !> Complex modulus E_0 + C s^a, transform of Eq. (23)
   elemental function complex_modulus(self, s) result(modulus)
      class(power_law_t), intent(in) :: self
      !> Laplace variable [1/s], not on the negative real axis
      complex(wp), intent(in) :: s
      !> Complex modulus [Pa]
      complex(wp) :: modulus

      modulus = self%equilibrium + self%coefficient*s**self%exponent
   end function complex_modulus

end module vcor_material_power_law
