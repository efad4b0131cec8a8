!> Fractional Zener solid of order 1/2: E(t) = E_0 + E_1 CERF(b sqrt(t)) with the exponentially
!> scaled complementary error function CERF(x) = exp(x^2) erfc(x), the intrinsic erfc_scaled
module vcor_material_cerf
   use, intrinsic :: ieee_arithmetic, only : ieee_negative_inf, ieee_value
   use vcor_error, only : error_t
   use vcor_kinds, only : pi, sqrt_pi, wp
   use vcor_material_type, only : check_values, equilibrium_modulus, parameter_t, poisson_ratio, &
      relaxing_modulus
   use vcor_number, only : positive
   use vcor_material_spectrum, only : fractional_t
   implicit none
   private

   public :: cerf_t, new_cerf, cerf_parameters

   !> Parameters of model `cerf`
   type(parameter_t), parameter :: cerf_parameters(*) = [poisson_ratio, equilibrium_modulus, &
      relaxing_modulus, &
      parameter_t('beta', 'Square root of the rate of relaxation', 's^-1/2', positive)]

   !> E(t) = E_0 + E_1 CERF(b sqrt(t)), Eq. (24)
   type, extends(fractional_t) :: cerf_t
      private
      !> Parameter b [s^(-1/2)]
      real(wp) :: beta = 1.0_wp
   contains
      procedure :: relaxation
      procedure :: rate
      procedure :: integral
      procedure :: complex_modulus
   end type cerf_t

contains

   !> Build a CERF material
   pure subroutine new_cerf(self, equilibrium, relaxing, beta, error)
      type(cerf_t), intent(out) :: self
      !> Equilibrium modulus E_0 [Pa], >= 0
      real(wp), intent(in) :: equilibrium
      !> Relaxing modulus E_1 [Pa], > 0
      real(wp), intent(in) :: relaxing
      !> Parameter b [s^(-1/2)], > 0
      real(wp), intent(in) :: beta
      type(error_t), allocatable, intent(out) :: error

      call check_values('cerf', cerf_parameters(2:), [equilibrium, relaxing, beta], error)
      if (allocated(error)) return

      self%equilibrium = equilibrium
      self%relaxing = relaxing
      self%beta = beta
      ! Q = E_0 + E_1 sqrt(s)/(sqrt(s) + b) has no pole on this sheet; the nearest is far from it
      self%peak = 2.0_wp*log(beta)
      self%distance = pi
   end subroutine new_cerf

   !> Relaxation modulus E(t)
   elemental function relaxation(self, t) result(value)
      class(cerf_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Modulus [Pa]
      real(wp) :: value

      value = self%equilibrium + self%relaxing*erfc_scaled(self%beta*sqrt(t))
   end function relaxation

   !> Rate of relaxation E_1 b^2 (CERF(x) - 1/(x sqrt(pi))), x = b sqrt(t); minus infinity at t = 0
   elemental function rate(self, t) result(value)
      class(cerf_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Rate [Pa/s], <= 0
      real(wp) :: value

      real(wp) :: x, y

      x = self%beta*sqrt(t)
      if (x > 20.0_wp) then
         ! the two terms cancel: asymptotic series of Eq. (29) without its first term
         y = 1.0_wp/(2.0_wp*x**2)
         value = -self%relaxing*self%beta**2/(x*sqrt_pi)*y &
            *(1.0_wp - 3.0_wp*y*(1.0_wp - 5.0_wp*y*(1.0_wp - 7.0_wp*y*(1.0_wp - 9.0_wp*y &
            *(1.0_wp - 11.0_wp*y*(1.0_wp - 13.0_wp*y*(1.0_wp - 15.0_wp*y*(1.0_wp - 17.0_wp*y))))))))
      else if (x > 0.0_wp) then
         value = self%relaxing*self%beta**2*(erfc_scaled(x) - 1.0_wp/(x*sqrt_pi))
      else
         value = self%relaxing*ieee_value(1.0_wp, ieee_negative_inf)
      end if
   end function rate

   !> Integral of E from 0 to t: E_0 t + E_1 ((CERF(x) - 1)/b^2 + 2 sqrt(t/pi)/b), x = b sqrt(t)
   elemental function integral(self, t) result(value)
      class(cerf_t), intent(in) :: self
      !> Upper limit [s], t >= 0
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: value

      real(wp) :: x

      x = self%beta*sqrt(t)
      value = self%equilibrium*t + self%relaxing*integral_of_cerf(x)/self%beta**2
   end function integral

   !> CERF(x) - 1 + 2 x/sqrt(pi); for small x, where the terms cancel, by its power series
   !> sum_{n>=2} (-x)^n/Gamma(n/2 + 1)
   elemental function integral_of_cerf(x) result(y)
      !> Argument, >= 0
      real(wp), intent(in) :: x
      real(wp) :: y

      real(wp) :: even, odd
      integer :: n

      if (x >= 0.5_wp) then
         y = erfc_scaled(x) - 1.0_wp + 2.0_wp*x/sqrt_pi
      else
         even = x**2
         odd = -x**3*4.0_wp/(3.0_wp*sqrt_pi)
         y = even + odd
         do n = 4, 24, 2
            even = even*x**2*2.0_wp/real(n, wp)
            odd = odd*x**2*2.0_wp/real(n + 1, wp)
            y = y + even + odd
         end do
      end if
   end function integral_of_cerf

   !> Complex modulus E_0 + E_1 sqrt(s)/(sqrt(s) + b), Eq. (25)
   elemental function complex_modulus(self, s) result(modulus)
      class(cerf_t), intent(in) :: self
      !> Laplace variable [1/s], not on the negative real axis
      complex(wp), intent(in) :: s
      !> Complex modulus [Pa]
      complex(wp) :: modulus

      modulus = self%equilibrium + self%relaxing*sqrt(s)/(sqrt(s) + self%beta)
   end function complex_modulus

end module vcor_material_cerf
