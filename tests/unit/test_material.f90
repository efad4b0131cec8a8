!> Relaxation moduli: closed forms, values of 17 digits, one function against another, bad input
program test_material
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan, &
      ieee_quiet_nan, ieee_value
   use, intrinsic :: ieee_exceptions, only : ieee_get_halting_mode, ieee_invalid, ieee_set_flag, &
      ieee_set_halting_mode
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, model_parameters, models, new_material, &
      parameters_of
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_mittag_leffler, only : mittag_leffler_t, new_mittag_leffler
   use vcor_material_type, only : parameter_t, power_of_time
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_rigid, new_sls, prony_t
   use vcor_numeric_quadrature, only : endpoint_rule, fourier_rule, gauss_nodes
   use vcor_test, only : check, check_close, check_relative, check_text, finish, &
      suite
   use vcor_test_cases, only : refused, success
   use vcor_test_material_values, only : cerf_integral, cerf_rate, cerf_relaxation, cerf_time, &
      power_exponent, power_integral, power_relaxation, power_time
   implicit none

   !> A handful of operations, each rounded
   real(wp), parameter :: rounding = 4.0e-15_wp
   !> Values of CERF and of powers: good to some units in the 16th digit
   real(wp), parameter :: value_tolerance = 1.0e-14_wp
   !> Rate and integral of CERF: up to three digits are lost where their formulas change
   real(wp), parameter :: difference_tolerance = 2.0e-13_wp
   !> Five-point formula with steps h of 1/500 t: h^4/30 times a fifth derivative of up to a hundred
   real(wp), parameter :: slope_tolerance = 1.0e-10_wp
   !> The double-exponential rule on integrable singularities at t = 0
   real(wp), parameter :: quadrature_tolerance = 1.0e-12_wp
   !> The rule for Fourier integrals, times the ratio of glassy modulus and result
   real(wp), parameter :: transform_tolerance = 2.0e-11_wp

   call suite("material")
   call test_elastic()
   call test_sls()
   call test_prony()
   call test_dashpot()
   call test_cerf_values()
   call test_cerf()
   call test_power_law()
   call test_rigid()
   call test_consistency()
   call test_refusals()
   call test_not_a_number()
   call test_factory()
   call test_statements()
   call finish()

contains

   !> An elastic solid does not relax
   subroutine test_elastic()
      type(prony_t) :: material
      type(error_t), allocatable :: error
      type(exponential_sum_t) :: terms

      call new_elastic(material, 3.0e9_wp, error)
      call success(error, "an elastic solid is built")
      call check_close(material%relaxation([0.0_wp, 1.0_wp, 1.0e9_wp]), 3.0e9_wp, 0.0_wp, &
         "an elastic solid does not relax")
      call check_close(material%rate(1.0_wp), 0.0_wp, 0.0_wp, "its rate is zero")
      call check_relative(material%integral(2.5_wp), 7.5e9_wp, rounding, "its integral is E t")
      call check_close(material%glassy(), 3.0e9_wp, 0.0_wp, "its glassy modulus is E")
      call check_close(material%rubbery(), 3.0e9_wp, 0.0_wp, "its rubbery modulus is E")
      call check_close(abs(material%complex_modulus((0.0_wp, 7.0_wp)) - 3.0e9_wp), 0.0_wp, 0.0_wp, &
         "its complex modulus is E")
      call material%exponentials(1.0_wp, 1.0e-8_wp, terms)
      call check(size(terms%moduli) == 0, "it is a sum of no exponentials")
      call check_close(terms%error, 0.0_wp, 0.0_wp, "and that sum exactly")
      call check(material%elastic(), "it is elastic")
      call check(.not. material%rigid, "it is not rigid")
      call material%set_constants(error, poisson_ratio=0.3_wp)
      call check_relative(material%plane_strain_factor(), 1.0_wp/0.91_wp, rounding, &
         "plane strain factor 1/(1 - nu^2)")
   end subroutine test_elastic

   !> The standard linear solid of Eq. (13) is a Prony series of one term
   subroutine test_sls()
      real(wp), parameter :: glassy = 15.0e6_wp, alpha = 300.0_wp, beta = 1200.0_wp
      real(wp), parameter :: time(5) = [0.0_wp, 1.0e-5_wp, 1.0e-3_wp, 0.01_wp, 0.5_wp]
      type(prony_t) :: sls, prony
      type(error_t), allocatable :: error

      call new_sls(sls, glassy, alpha, beta, error)
      call success(error, "a standard linear solid is built")
      call check_relative(sls%relaxation(time), &
         glassy*(alpha/beta + (1.0_wp - alpha/beta)*exp(-beta*time)), rounding, "E(t) of Eq. (13)")
      call check_relative(sls%glassy(), glassy, rounding, "glassy modulus of the SLS")
      call check_relative(sls%rubbery(), glassy*alpha/beta, rounding, "rubbery modulus of the SLS")

      call new_prony(prony, glassy*alpha/beta, [glassy*(1.0_wp - alpha/beta)], [beta], &
         0.0_wp, error)
      call success(error, "a Prony series of one term is built")
      call check_relative(prony%relaxation(time), sls%relaxation(time), rounding, &
         "E(t) of a Prony series of one term is that of the SLS")
      call check_relative(prony%rate(time(:4)), sls%rate(time(:4)), rounding, "and so is its rate")
      call check_relative(prony%integral(time), sls%integral(time), rounding, "and its integral")
      call check_relative(abs(prony%complex_modulus((0.0_wp, 700.0_wp))), &
         abs(sls%complex_modulus((0.0_wp, 700.0_wp))), rounding, "and its complex modulus")

      call new_sls(sls, glassy, 0.0_wp, 0.0_wp, error)
      call success(error, "an SLS with beta = 0 is built")
      call check_close(sls%relaxation(time), glassy, 0.0_wp, "an SLS with beta = 0 is elastic")
      call check_close(sls%rubbery(), glassy, 0.0_wp, "an SLS with beta = 0 has no rubbery plateau")
      call new_sls(sls, glassy, beta, beta, error)
      call check_close(sls%relaxation(time), glassy, 0.0_wp, "an SLS with alpha = beta is elastic")
      call new_sls(sls, glassy, 0.0_wp, beta, error)
      call check_close(sls%rubbery(), 0.0_wp, 0.0_wp, "an SLS with alpha = 0 is a Maxwell fluid")
   end subroutine test_sls

   !> The Prony series of Eq. (26)
   subroutine test_prony()
      real(wp), parameter :: equilibrium = 10.421e6_wp
      real(wp), parameter :: moduli(3) = [20.181e6_wp, 38.204e6_wp, 87.344e6_wp]
      real(wp), parameter :: rates(3) = [972.0_wp, 6426.0_wp, 34221.0_wp]
      complex(wp), parameter :: s = (300.0_wp, 5000.0_wp)
      complex(wp) :: expected
      type(prony_t) :: material
      type(exponential_sum_t) :: terms, double
      type(error_t), allocatable :: error
      real(wp) :: t

      call new_prony(material, equilibrium, moduli, rates, 0.0_wp, error)
      call success(error, "a Prony series is built")
      t = 1.0e-4_wp
      call check_relative(material%relaxation(t), equilibrium + sum(moduli*exp(-rates*t)), &
         rounding, "E(t) of Eq. (26)")
      call check_relative(material%rate(t), -sum(moduli*rates*exp(-rates*t)), rounding, &
         "its rate")
      call check_relative(material%integral(t), equilibrium*t &
         + sum(moduli*(1.0_wp - exp(-rates*t))/rates), rounding, "its integral")
      call check_relative(material%rate(0.0_wp), -sum(moduli*rates), rounding, "its rate at t = 0")
      call check_close(material%integral(0.0_wp), 0.0_wp, 0.0_wp, "no time, no integral")
      ! (1 - exp(-x))/x = 1 - x/2 + x^2/6: the difference would lose twelve digits
      call check_relative(material%integral(1.0e-24_wp), material%glassy()*1.0e-24_wp, rounding, &
         "the integral over a short time does not cancel")
      call check_relative(material%integral(1.0e-7_wp), 1.0e-7_wp*(equilibrium + sum(moduli &
         *(1.0_wp - 0.5e-7_wp*rates*(1.0_wp - 1.0e-7_wp*rates/3.0_wp*(1.0_wp - 0.25e-7_wp*rates &
         *(1.0_wp - 0.2e-7_wp*rates)))))), rounding, "nor does that over a tenth of a microsecond")
      call check_relative(material%relaxation(1.0e9_wp), equilibrium, 0.0_wp, &
         "after all relaxation the equilibrium modulus is left")
      expected = equilibrium + sum(moduli*s/(s + rates))
      call check_close(abs(material%complex_modulus(s)/expected - 1.0_wp), 0.0_wp, rounding, &
         "complex modulus of Eq. (27)")
      call check_relative(material%glassy(), equilibrium + sum(moduli), rounding, "glassy modulus")
      call check_relative(material%rubbery(), equilibrium, 0.0_wp, "rubbery modulus")

      call material%exponentials(1.0_wp, 1.0e-8_wp, terms)
      call check_close(terms%error, 0.0_wp, 0.0_wp, "a Prony series is a sum of exponentials")
      call check(.not. material%elastic(), "it is not elastic")
      call check_close(terms%rates, rates, 0.0_wp, "with its own rates")
      double = terms
      call double%scale(2.0_wp)
      call check_relative(double%moduli, 2.0_wp*moduli, 0.0_wp, &
         "twice the sum has twice the moduli")
      call check_relative(double%equilibrium, 2.0_wp*equilibrium, 0.0_wp, "and equilibrium modulus")
      call check_close(double%rates, rates, 0.0_wp, "but the same rates")
   end subroutine test_prony

   !> A dashpot in parallel
   subroutine test_dashpot()
      type(prony_t) :: material
      type(exponential_sum_t) :: terms
      type(error_t), allocatable :: error
      real(wp), parameter :: none(0) = [real(wp) ::]

      call new_prony(material, 2.0e6_wp, none, none, 400.0_wp, error)
      call success(error, "a Kelvin-Voigt solid is built")
      call check_close(material%viscosity, 400.0_wp, 0.0_wp, "it has a viscosity")
      call check_close(material%relaxation(1.0_wp), 2.0e6_wp, 0.0_wp, "E(t) leaves it out")
      call check_relative(aimag(material%complex_modulus((0.0_wp, 30.0_wp))), 12000.0_wp, &
         rounding, "the loss modulus is viscosity times frequency")
      call material%exponentials(1.0_wp, 1.0e-8_wp, terms)
      call check_close(terms%error, 0.0_wp, 0.0_wp, "it is a sum of exponentials")
      call terms%scale(3.0_wp)
      call check_relative(terms%viscosity, 1200.0_wp, rounding, "a scaled sum has a scaled dashpot")
   end subroutine test_dashpot

   !> CERF from x = 1e-8 to 1e8, on both sides of where the formulas change
   subroutine test_cerf_values()
      type(cerf_t) :: material
      type(error_t), allocatable :: error

      call new_cerf(material, 0.0_wp, 1.0_wp, 1.0_wp, error)
      call success(error, "a CERF material is built")
      call check_relative(material%relaxation(cerf_time), cerf_relaxation, value_tolerance, &
         "CERF(x), x = 1e-8 .. 1e8")
      call check_relative(material%rate(cerf_time), cerf_rate, difference_tolerance, &
         "rate of CERF, x = 1e-8 .. 1e8")
      call check_relative(material%integral(cerf_time), cerf_integral, difference_tolerance, &
         "integral of CERF, x = 1e-8 .. 1e8")
   end subroutine test_cerf_values

   !> Parameters and limits of a CERF material
   subroutine test_cerf()
      real(wp), parameter :: equilibrium = 8.0e6_wp, relaxing = 6.0e8_wp, beta = 50.0_wp
      type(cerf_t) :: unit, material
      type(error_t), allocatable :: error
      type(exponential_sum_t) :: terms

      call new_cerf(unit, 0.0_wp, 1.0_wp, 1.0_wp, error)
      call new_cerf(material, equilibrium, relaxing, beta, error)
      call success(error, "a CERF material is built")
      call check_relative(material%relaxation(1.0e-3_wp), &
         equilibrium + relaxing*unit%relaxation(2.5_wp), value_tolerance, "E(t) of Eq. (24)")
      call check_relative(material%rate(1.0e-3_wp), relaxing*beta**2*unit%rate(2.5_wp), &
         value_tolerance, "its rate")
      call check_relative(material%integral(1.0e-3_wp), &
         equilibrium*1.0e-3_wp + relaxing*unit%integral(2.5_wp)/beta**2, value_tolerance, &
         "its integral")
      call check_close(material%integral(0.0_wp), 0.0_wp, 0.0_wp, "no time, no integral")
      call check_relative(material%glassy(), equilibrium + relaxing, rounding, "glassy modulus")
      call check_relative(material%relaxation(0.0_wp), equilibrium + relaxing, rounding, &
         "E(0) is the glassy modulus")
      call check_relative(material%rubbery(), equilibrium, 0.0_wp, "rubbery modulus")
      call check(.not. ieee_is_finite(material%rate(0.0_wp)), "the rate at t = 0 is infinite")
      call check_close(abs(material%complex_modulus((2500.0_wp, 0.0_wp)) &
         - (equilibrium + 0.5_wp*relaxing)), 0.0_wp, 1.0e-6_wp, "half relaxed at s = beta^2")
      call material%exponentials(1.0e-3_wp, 1.0e-8_wp, terms)
      call check(terms%error > 0.0_wp, "a CERF material is not a sum of exponentials")
      call check(.not. material%elastic(), "it is not elastic")
   end subroutine test_cerf

   !> The power law against values of 17 digits, parameters and limits
   subroutine test_power_law()
      type(power_law_t) :: material
      type(error_t), allocatable :: error
      type(exponential_sum_t) :: terms
      complex(wp), parameter :: s = (0.0_wp, 1.0e4_wp)
      integer :: i

      do i = 1, size(power_time)
         call new_power_law(material, 0.0_wp, 2.0_wp, power_exponent(i), error)
         call success(error, "a power law is built")
         call check_relative(material%relaxation(power_time(i)), 2.0_wp*power_relaxation(i), &
            value_tolerance, "power law t^-a/Gamma(1 - a)")
         call check_relative(material%integral(power_time(i)), 2.0_wp*power_integral(i), &
            value_tolerance, "integral of the power law")
         call check_relative(material%rate(power_time(i)), &
            -2.0_wp*power_exponent(i)*power_relaxation(i)/power_time(i), value_tolerance, &
            "rate of the power law")
         call check_relative(abs(material%complex_modulus(s)), 2.0_wp*1.0e4_wp**power_exponent(i), &
            value_tolerance, "complex modulus C s^a: absolute value")
         call check_relative(atan2(aimag(material%complex_modulus(s)), &
            real(material%complex_modulus(s), wp)), power_exponent(i)*asin(1.0_wp), &
            value_tolerance, "complex modulus C s^a: angle a pi/2")
      end do
      call new_power_law(material, 3.0_wp, 2.0_wp, 0.5_wp, error)
      call check_relative(material%integral(4.0_wp), 12.0_wp + 8.0_wp/sqrt(acos(-1.0_wp)), &
         value_tolerance, "integral with an equilibrium modulus")
      call check_close(material%integral(0.0_wp), 0.0_wp, 0.0_wp, "no time, no integral")
      call check(.not. ieee_is_finite(material%glassy()), "the glassy modulus is infinite")
      call check(.not. ieee_is_finite(material%relaxation(0.0_wp)), "E(0) is infinite")
      call check(.not. ieee_is_finite(material%rate(0.0_wp)), "the rate at t = 0 is infinite")
      call check_close(material%rubbery(), 3.0_wp, 0.0_wp, "rubbery modulus of a power law")
      call material%exponentials(1.0e-3_wp, 1.0e-8_wp, terms)
      call check(terms%error > 0.0_wp, "a power law is not a sum of exponentials")
      call check(.not. material%elastic(), "it is not elastic")
   end subroutine test_power_law

   !> A rigid body
   subroutine test_rigid()
      type(prony_t) :: material

      call new_rigid(material)
      call check(material%rigid, "a rigid body is rigid")
      call check(.not. ieee_is_finite(material%glassy()), "its modulus is infinite")
      call check(.not. ieee_is_nan(material%relaxation(1.0_wp)), "at any time")
   end subroutine test_rigid

   !> Rate, integral and complex modulus belong to the relaxation modulus, whatever the model
   subroutine test_consistency()
      type(prony_t) :: prony
      type(cerf_t) :: cerf
      type(power_law_t) :: power_law
      type(mittag_leffler_t) :: mittag_leffler
      type(error_t), allocatable :: error

      call new_prony(prony, 1.0e6_wp, [2.0e6_wp, 3.0e6_wp], [0.8_wp, 3.0_wp], 0.0_wp, error)
      call consistent(prony, "prony")
      call new_sls(prony, 15.0e6_wp, 0.5_wp, 2.0_wp, error)
      call consistent(prony, "sls")
      call new_cerf(cerf, 1.0e6_wp, 4.0e6_wp, 1.3_wp, error)
      call consistent(cerf, "cerf")
      call new_power_law(power_law, 1.0e6_wp, 2.0e6_wp, 0.5_wp, error)
      call consistent(power_law, "power_law a = 0.5")
      call new_power_law(power_law, 1.0e6_wp, 2.0e6_wp, 0.2_wp, error)
      call consistent(power_law, "power_law a = 0.2")
      call new_mittag_leffler(mittag_leffler, 1.0e6_wp, 4.0e6_wp, 0.6_wp, 0.7_wp, error)
      call consistent(mittag_leffler, "mittag_leffler a = 0.6")
      call new_mittag_leffler(mittag_leffler, 1.0e6_wp, 4.0e6_wp, 0.97_wp, 0.7_wp, error)
      call consistent(mittag_leffler, "mittag_leffler a = 0.97")
   end subroutine test_consistency

   !> One function of a material against another
   subroutine consistent(material, name)
      !> The material, its times of relaxation around 1 s
      class(material_t), intent(in) :: material
      !> What to call it
      character(len=*), intent(in) :: name

      real(wp), parameter :: time(3) = [0.1_wp, 1.0_wp, 10.0_wp]
      real(wp), parameter :: frequency(3) = [0.1_wp, 1.0_wp, 10.0_wp]
      ! exp(-x) has fallen to 1e-18 at the end of the last panel, of length 1
      integer, parameter :: panels = 42, order = 12
      real(wp), allocatable :: node(:), weight(:), xs(:), ws(:), xc(:), wc(:)
      real(wp) :: x(order), w(order), h, transform
      complex(wp) :: modulus
      integer :: i, panel

      call endpoint_rule(node, weight)
      call fourier_rule(xs, ws, xc, wc)
      call gauss_nodes(x, w)
      do i = 1, size(time)
         associate (t => time(i), omega => frequency(i))
            h = 0.002_wp*t
            call check_close((material%relaxation(t - 2.0_wp*h) &
               - material%relaxation(t + 2.0_wp*h) &
               + 8.0_wp*(material%relaxation(t + h) - material%relaxation(t - h)))/(12.0_wp*h) &
               /(material%relaxation(t)/t), material%rate(t)/(material%relaxation(t)/t), &
               slope_tolerance, name//": the rate is the derivative of E")
            call check_relative(t*sum(weight*material%relaxation(t*node)), material%integral(t), &
               quadrature_tolerance, name//": the integral is that of E")
            call check(material%rate(t) <= 0.0_wp, name//": E does not grow")

            modulus = material%complex_modulus(cmplx(omega, 0.0_wp, wp))
            transform = sum(weight*material%relaxation(node/omega)*exp(-node))
            do panel = 1, panels - 1
               transform = transform + sum(w*material%relaxation((real(panel, wp) + x)/omega) &
                  *exp(-real(panel, wp) - x))
            end do
            call check_relative(transform, real(modulus, wp), quadrature_tolerance, &
               name//": the complex modulus is s L{E}(s) at real s")
            modulus = material%complex_modulus(cmplx(0.0_wp, omega, wp))
            call check_relative(material%rubbery() + sum(ws*(material%relaxation(xs/omega) &
               - material%rubbery())), real(modulus, wp), transform_tolerance, &
               name//": storage modulus by the sine transform of E")
            call check_relative(sum(wc*(material%relaxation(xc/omega) - material%rubbery())), &
               aimag(modulus), transform_tolerance, name//": loss modulus by the cosine transform")
         end associate
      end do
      modulus = material%complex_modulus((0.0_wp, 1.0e-12_wp))
      call check_relative(real(modulus, wp), material%rubbery(), 1.0e-2_wp, &
         name//": slow oscillations meet the rubbery modulus")
      if (.not. ieee_is_finite(material%glassy())) return
      modulus = material%complex_modulus((0.0_wp, 1.0e12_wp))
      call check_relative(real(modulus, wp), material%glassy(), 1.0e-5_wp, &
         name//": fast oscillations meet the glassy modulus")
   end subroutine consistent

   !> Parameters that make no material
   subroutine test_refusals()
      type(prony_t) :: prony
      type(cerf_t) :: cerf
      type(power_law_t) :: power_law
      type(error_t), allocatable :: error
      real(wp), parameter :: none(0) = [real(wp) ::]

      call new_elastic(prony, 0.0_wp, error)
      call refused(error, "an elastic solid without modulus", "")
      call new_elastic(prony, -1.0_wp, error)
      call refused(error, "a negative modulus", "")
      call new_sls(prony, 0.0_wp, 1.0_wp, 2.0_wp, error)
      call refused(error, "an SLS without glassy modulus", "glassy_modulus")
      call new_sls(prony, 1.0_wp, 2.0_wp, 1.0_wp, error)
      call refused(error, "an SLS that gets stiffer", "rubbery modulus exceeds")
      call new_sls(prony, 1.0_wp, -1.0_wp, 1.0_wp, error)
      call refused(error, "an SLS with a negative alpha", "alpha")
      call new_prony(prony, 1.0_wp, [1.0_wp, 2.0_wp], [1.0_wp], 0.0_wp, error)
      call refused(error, "a rate missing", "as many rates as moduli")
      call new_prony(prony, 1.0_wp, [1.0_wp], [0.0_wp], 0.0_wp, error)
      call refused(error, "a rate of zero", "positive")
      call new_prony(prony, 1.0_wp, [-1.0_wp], [1.0_wp], 0.0_wp, error)
      call refused(error, "a negative modulus of a term", "positive")
      call new_prony(prony, -1.0_wp, [1.0_wp], [1.0_wp], 0.0_wp, error)
      call refused(error, "a negative equilibrium modulus", "negative")
      call new_prony(prony, 1.0_wp, none, none, -1.0_wp, error)
      call refused(error, "a negative viscosity", "negative")
      call new_prony(prony, 0.0_wp, none, none, 0.0_wp, error)
      call refused(error, "a Prony series of nothing", "no stiffness")
      call new_cerf(cerf, -1.0_wp, 1.0_wp, 1.0_wp, error)
      call refused(error, "a CERF material below zero", "equilibrium_modulus")
      call new_cerf(cerf, 1.0_wp, 0.0_wp, 1.0_wp, error)
      call refused(error, "a CERF material that does not relax", "relaxing_modulus")
      call new_cerf(cerf, 1.0_wp, 1.0_wp, 0.0_wp, error)
      call refused(error, "a CERF material without beta", "beta")
      call new_power_law(power_law, 1.0_wp, 0.0_wp, 0.5_wp, error)
      call refused(error, "a power law without coefficient", "coefficient")
      call new_power_law(power_law, -1.0_wp, 1.0_wp, 0.5_wp, error)
      call refused(error, "a power law below zero", "equilibrium_modulus")
      call new_power_law(power_law, 1.0_wp, 1.0_wp, 0.0_wp, error)
      call refused(error, "an exponent of 0", "exponent")
      call new_power_law(power_law, 1.0_wp, 1.0_wp, 1.0_wp, error)
      call refused(error, "an exponent of 1", "exponent")
   end subroutine test_refusals

   !> What is not a number is not a parameter
   subroutine test_not_a_number()
      type(prony_t) :: prony
      type(cerf_t) :: cerf
      type(power_law_t) :: power_law
      type(mittag_leffler_t) :: mittag_leffler
      type(error_t), allocatable :: error
      real(wp) :: nan
      logical :: halting

      ! to compare a NaN is an invalid operation, at which a debug build halts; the program keeps
      ! NaN away from here, a user of the library may not
      call ieee_get_halting_mode(ieee_invalid, halting)
      call ieee_set_halting_mode(ieee_invalid, .false.)
      nan = ieee_value(1.0_wp, ieee_quiet_nan)
      call new_elastic(prony, nan, error)
      call refused(error, "NaN as a modulus", "")
      call new_sls(prony, nan, 1.0_wp, 2.0_wp, error)
      call refused(error, "NaN as a glassy modulus", "")
      call new_sls(prony, 1.0_wp, nan, 2.0_wp, error)
      call refused(error, "NaN as alpha", "")
      call new_sls(prony, 1.0_wp, 1.0_wp, nan, error)
      call refused(error, "NaN as beta", "")
      call new_prony(prony, 1.0_wp, [nan], [1.0_wp], 0.0_wp, error)
      call refused(error, "NaN as the modulus of a term", "")
      call new_prony(prony, 1.0_wp, [1.0_wp], [nan], 0.0_wp, error)
      call refused(error, "NaN as a rate", "")
      call new_prony(prony, 1.0_wp, [1.0_wp], [1.0_wp], nan, error)
      call refused(error, "NaN as a viscosity", "")
      call new_cerf(cerf, nan, 1.0_wp, 1.0_wp, error)
      call refused(error, "NaN as an equilibrium modulus", "")
      call new_cerf(cerf, 1.0_wp, nan, 1.0_wp, error)
      call refused(error, "NaN as a relaxing modulus", "")
      call new_cerf(cerf, 1.0_wp, 1.0_wp, nan, error)
      call refused(error, "NaN as beta of a CERF material", "")
      call new_power_law(power_law, nan, 1.0_wp, 0.5_wp, error)
      call refused(error, "NaN as equilibrium modulus of a power law", "")
      call new_power_law(power_law, 1.0_wp, nan, 0.5_wp, error)
      call refused(error, "NaN as a coefficient", "")
      call new_power_law(power_law, 1.0_wp, 1.0_wp, nan, error)
      call refused(error, "NaN as an exponent", "")
      call new_mittag_leffler(mittag_leffler, nan, 1.0_wp, 0.5_wp, 1.0_wp, error)
      call refused(error, "NaN as equilibrium modulus of a Mittag-Leffler material", "")
      call new_mittag_leffler(mittag_leffler, 1.0_wp, nan, 0.5_wp, 1.0_wp, error)
      call refused(error, "NaN as its relaxing modulus", "")
      call new_mittag_leffler(mittag_leffler, 1.0_wp, 1.0_wp, nan, 1.0_wp, error)
      call refused(error, "NaN as its exponent", "")
      call new_mittag_leffler(mittag_leffler, 1.0_wp, 1.0_wp, 0.5_wp, nan, error)
      call refused(error, "NaN as its time", "")
      call ieee_set_flag(ieee_invalid, .false.)
      call ieee_set_halting_mode(ieee_invalid, halting)
   end subroutine test_not_a_number

   !> Materials by the name of their model
   subroutine test_factory()
      character(len=*), parameter :: model(7) = [character(len=14) :: 'rigid', 'elastic', 'sls', &
         'prony', 'power_law', 'cerf', 'mittag_leffler']
      type(material_data_t) :: data
      class(material_t), allocatable :: material
      type(error_t), allocatable :: error
      integer :: i

      data%name = 'some rubber'
      call data%set('density', 1100.0_wp)
      call data%set('poisson_ratio', 0.45_wp)
      call data%set('modulus', 1.0e6_wp)
      call data%set('glassy_modulus', 2.0e6_wp)
      call data%set('alpha', 1.0_wp)
      call data%set('beta', 4.0_wp)
      call data%set('equilibrium_modulus', 3.0e6_wp)
      call data%set_list('moduli', [4.0e6_wp])
      call data%set_list('rates', [5.0_wp])
      call data%set('viscosity', 6.0_wp)
      call data%set('coefficient', 7.0_wp)
      call data%set('exponent', 0.25_wp)
      call data%set('relaxing_modulus', 8.0e6_wp)
      call data%set('time', 9.0_wp)
      do i = 1, size(model)
         data%model = trim(model(i))
         call new_material(material, data, error)
         call success(error, data%model//" is built by its name")
         call check(allocated(material), data%model//" is there")
         if (.not. allocated(material)) cycle
         call check_text(material%name, 'some rubber', data%model//" has its name")
         call check_close(material%density(), 1100.0_wp, 0.0_wp, data%model//" has its density")
         call check_close(material%poisson_ratio(), 0.45_wp, 0.0_wp, &
            data%model//": Poisson's ratio")
         call check(material%rigid .eqv. i == 1, data%model//": only the rigid body is rigid")
         select case (i)
         case (2)
            call check_close(material%glassy(), 1.0e6_wp, 0.0_wp, "elastic has its modulus")
         case (3)
            call check_close(material%rubbery(), 0.5e6_wp, 1.0e-8_wp, "sls has its parameters")
         case (4)
            call check_close(material%viscosity, 6.0_wp, 0.0_wp, "prony has its dashpot")
            call check_relative(material%glassy(), 7.0e6_wp, rounding, "prony has its moduli")
         case (5)
            call check_relative(material%relaxation(16.0_wp), 3.0e6_wp &
               + 3.5_wp/gamma(0.75_wp), rounding, "power_law has its parameters")
         case (6)
            call check_relative(material%glassy(), 11.0e6_wp, rounding, "cerf has its parameters")
         case (7)
            call check_relative(material%glassy(), 11.0e6_wp, rounding, "mittag_leffler: moduli")
            call check_relative(real(material%complex_modulus((1.0_wp, 0.0_wp)), wp), &
               3.0e6_wp + 8.0e6_wp*9.0_wp**0.25_wp/(1.0_wp + 9.0_wp**0.25_wp), rounding, &
               "mittag_leffler: exponent and time")
         case default
            call check(.not. material%glassy() < huge(1.0_wp), "rigid has no parameters")
         end select
      end do

      data%model = 'rubber'
      call new_material(material, data, error)
      call refused(error, "an unknown model", &
         "known: rigid, elastic, sls, prony, power_law, cerf, mittag_leffler")
      call check(.not. allocated(material), "an unknown model makes no material")
      data%model = 'sls'
      call data%set('alpha', 5.0_wp)
      call new_material(material, data, error)
      call refused(error, "an impossible SLS", "alpha <= beta")
      call check(.not. allocated(material), "bad parameters make no material")
      call data%set('glasy_modulus', 1.0e6_wp)
      call new_material(material, data, error)
      call refused(error, "a parameter that no model has", "glasy_modulus")
   end subroutine test_factory

   !> What the models state of their parameters
   subroutine test_statements()
      character(len=:), allocatable :: model
      type(parameter_t) :: stated
      character(len=len(stated%unit)) :: time
      integer :: first, last, i

      first = 1
      do while (first <= len(models))
         last = first - 2 + index(models(first:)//' ', ' ')
         model = models(first:last)
         call check(size(parameters_of(model)) > 0, model//" states its parameters")
         first = last + 2
      end do
      do i = 1, size(model_parameters)
         stated = model_parameters(i)%parameter
         model = trim(model_parameters(i)%model)//", "//trim(stated%name)
         call check(index(" "//models//" ", " "//trim(model_parameters(i)%model)//" ") > 0, &
            model//": the model is known")
         call check(stated%meaning /= '', model//" has a meaning")
         call check(stated%default == '' .or. .not. stated%required, &
            model//" has a default or is required")
         ! what a temperature makes of a parameter follows from its unit
         time = stated%unit
         if (stated%unit(:2) == 'Pa') time = adjustl(stated%unit(3:))
         call check(time == '' .or. time == 's^a' .or. abs(power_of_time(time)) > 0.0_wp, &
            model//": the power of the time is known")
      end do
   end subroutine test_statements

end program test_material
