!> Mittag-Leffler material: values of 17 digits over 60 decades of time, the members of the family
!> that have a model of their own, and what must not overflow
program test_mittag_leffler
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_mittag_leffler, only : mittag_leffler_t, new_mittag_leffler
   use vcor_material_prony, only : new_sls, prony_t
   use vcor_numeric_mittag_leffler, only : mittag_leffler_rule_t, new_mittag_leffler_rule
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : refused, success
   use vcor_test_material_values, only : ml_exponent, ml_mean, ml_rate, ml_slope, ml_spectrum, &
      ml_time, ml_value
   implicit none

   !> A handful of operations, each rounded
   real(wp), parameter :: rounding = 4.0e-15_wp
   !> 26 terms of four times their sum at most, and for a near 1 the rounding of (t/tau)^a times its
   !> value in exp(-(t/tau)^a), which counts up to 35
   real(wp), parameter :: value_tolerance = 2.0e-14_wp
   !> The spectrum: the rounding of rate*tau times the sharpness of its peak
   real(wp), parameter :: spectrum_tolerance = 1.0e-13_wp
   !> Rate and integral of CERF are good to this where their formulas change
   real(wp), parameter :: cerf_tolerance = 2.0e-13_wp

   call suite("mittag_leffler")
   call test_values()
   call test_rule()
   call test_parameters()
   call test_spectrum()
   call test_cerf()
   call test_sls()
   call test_nearly_sls()
   call test_narrow_peak()
   call test_extremes()
   call test_refusals()
   call finish()

contains

   !> E(t), rate and integral from t/tau = 1e-30 to 1e30, exponents from 0.01 to the last below 1
   subroutine test_values()
      type(mittag_leffler_t) :: material
      type(error_t), allocatable :: error
      integer :: i, first, last

      do i = 1, size(ml_exponent)
         first = (i - 1)*size(ml_time) + 1
         last = i*size(ml_time)
         call new_mittag_leffler(material, 0.0_wp, 1.0_wp, ml_exponent(i), 1.0_wp, error)
         call success(error, "a Mittag-Leffler material is built")
         call check_relative(material%relaxation(ml_time), ml_value(first:last), value_tolerance, &
            "E_a(-t^a), t = 1e-30 .. 1e30")
         call check_relative(material%rate(ml_time)*ml_time, -ml_slope(first:last), &
            value_tolerance, "its rate")
         call check_relative(material%integral(ml_time), ml_mean(first:last)*ml_time, &
            value_tolerance, "its integral")
      end do
   end subroutine test_values

   !> The function itself at the ends of what the material lets through
   subroutine test_rule()
      type(mittag_leffler_rule_t) :: rule
      real(wp), parameter :: u(5) = [0.0_wp, 1.0e-3_wp, 1.0_wp, 30.0_wp, huge(u)]

      rule = new_mittag_leffler_rule(1.0_wp)
      call check_relative(rule%value(u(:4)), exp(-u(:4)), 0.0_wp, "E_1(-u) = exp(-u)")
      call check_relative(rule%slope(u(:4)), u(:4)*exp(-u(:4)), 0.0_wp, "its slope")
      call check_relative(rule%mean(u(3:4)), (1.0_wp - exp(-u(3:4)))/u(3:4), rounding, "its mean")
      call check_close(rule%value(huge(u)), 0.0_wp, 0.0_wp, "nothing is left in the end")
      rule = new_mittag_leffler_rule(tiny(u))
      call check_relative(rule%value(u), 1.0_wp/(1.0_wp + u), rounding, "E_0(-u) = 1/(1 + u)")
      call check_relative(rule%mean(u), 1.0_wp/(1.0_wp + u), rounding, "and that is its mean")
   end subroutine test_rule

   !> Moduli and relaxation time
   subroutine test_parameters()
      real(wp), parameter :: equilibrium = 2.0e6_wp, relaxing = 3.0e8_wp
      ! a power of two, so that t/tau is what it was
      real(wp), parameter :: tau = 2.0_wp**(-12), t(3) = [0.01_wp, 1.0_wp, 40.0_wp]
      complex(wp), parameter :: s = (0.3_wp, 0.7_wp)
      type(mittag_leffler_t) :: unit, material
      type(error_t), allocatable :: error

      call new_mittag_leffler(unit, 0.0_wp, 1.0_wp, 0.7_wp, 1.0_wp, error)
      call new_mittag_leffler(material, equilibrium, relaxing, 0.7_wp, tau, error)
      call success(error, "a Mittag-Leffler material is built")
      call check_relative(material%relaxation(t*tau), &
         equilibrium + relaxing*unit%relaxation(t), rounding, "E(t)")
      call check_relative(material%rate(t*tau), relaxing*unit%rate(t)/tau, rounding, "its rate")
      call check_relative(material%integral(t*tau), &
         tau*(equilibrium*t + relaxing*unit%integral(t)), rounding, "its integral")
      call check_close(abs(material%complex_modulus(s/tau) &
         - (equilibrium + relaxing*unit%complex_modulus(s))), 0.0_wp, rounding*relaxing, &
         "its complex modulus")
      call check_relative(material%relaxation(0.0_wp), equilibrium + relaxing, rounding, &
         "E(0) is the glassy modulus")
      call check_relative(material%glassy(), equilibrium + relaxing, rounding, "glassy modulus")
      call check_relative(material%rubbery(), equilibrium, 0.0_wp, "rubbery modulus")
      call check_close(material%integral(0.0_wp), 0.0_wp, 0.0_wp, "no time, no integral")
      call check(.not. ieee_is_finite(material%rate(0.0_wp)), "the rate at t = 0 is infinite")
      call check(material%rate(0.0_wp) < 0.0_wp, "and negative")
   end subroutine test_parameters

   !> The imaginary part of Q on both sides of the negative axis, and Q against its formula
   subroutine test_spectrum()
      type(mittag_leffler_t) :: material
      type(error_t), allocatable :: error
      complex(wp), parameter :: s(4) = [(0.4_wp, 0.0_wp), (0.1_wp, 5.0_wp), (0.0_wp, 0.02_wp), &
         (-3.0_wp, -1.0_wp)]
      complex(wp) :: p(size(s)), upper(size(ml_rate)), lower(size(ml_rate))
      integer :: i, first, last

      do i = 1, size(ml_exponent)
         first = (i - 1)*size(ml_rate) + 1
         last = i*size(ml_rate)
         call new_mittag_leffler(material, 0.0_wp, 1.0_wp, ml_exponent(i), 1.0_wp, error)
         upper = material%complex_modulus(cmplx(-ml_rate, 0.0_wp, wp))
         lower = material%complex_modulus(cmplx(-ml_rate, -0.0_wp, wp))
         call check_relative(aimag(upper), ml_spectrum(first:last), spectrum_tolerance, &
            "spectrum, rates from 1e-30 to 1e30")
         call check_close(abs(lower - conjg(upper)), 0.0_wp, 0.0_wp, &
            "the conjugate on the lower side")
         p = s**ml_exponent(i)
         call check_close(abs(material%complex_modulus(s) - p/(1.0_wp + p)), 0.0_wp, rounding, &
            "Q = s^a/(1 + s^a)")
      end do
   end subroutine test_spectrum

   !> Exponent 1/2 is CERF with b = tau^(-1/2)
   subroutine test_cerf()
      real(wp), parameter :: tau = 0.0625_wp
      complex(wp), parameter :: s(3) = [(1.0_wp, 0.0_wp), (0.0_wp, 16.0_wp), (2.0_wp, 1.0e5_wp)]
      type(mittag_leffler_t) :: half
      type(cerf_t) :: cerf
      type(error_t), allocatable :: error

      call new_mittag_leffler(half, 1.0e6_wp, 5.0e6_wp, 0.5_wp, tau, error)
      call new_cerf(cerf, 1.0e6_wp, 5.0e6_wp, 1.0_wp/sqrt(tau), error)
      call check_relative(half%relaxation(ml_time), cerf%relaxation(ml_time), value_tolerance, &
         "exponent 1/2 is CERF")
      call check_relative(half%rate(ml_time), cerf%rate(ml_time), cerf_tolerance, &
         "and so is the rate")
      call check_relative(half%integral(ml_time), cerf%integral(ml_time), cerf_tolerance, &
         "and the integral")
      call check_close(abs(half%complex_modulus(s) - cerf%complex_modulus(s)), 0.0_wp, &
         6.0e6_wp*rounding, "and the complex modulus")
   end subroutine test_cerf

   !> Exponent 1 is the standard linear solid
   subroutine test_sls()
      real(wp), parameter :: tau = 1.0e-3_wp, time(5) = [0.0_wp, 1.0e-18_wp, 1.0e-3_wp, 0.02_wp, &
         1.0e12_wp]
      class(material_t), allocatable :: material
      type(prony_t) :: sls

      call build(1.0_wp, tau, material)
      if (.not. allocated(material)) return
      call sls_of(sls, tau)
      call check_relative(material%relaxation(time), sls%relaxation(time), rounding, &
         "exponent 1 is the SLS")
      call check_relative(material%rate(time(:4)), sls%rate(time(:4)), rounding, &
         "and so is the rate, finite at t = 0 too")
      call check_relative(material%integral(time), sls%integral(time), rounding, &
         "and the integral")
      call check_close(abs(material%complex_modulus((0.0_wp, 300.0_wp)) &
         - sls%complex_modulus((0.0_wp, 300.0_wp))), 0.0_wp, 4.0e6_wp*rounding, &
         "and the complex modulus")
      select type (material)
      type is (prony_t)
         call check(.true., "it is a sum of exponentials")
      class default
         call check(.false., "it is a sum of exponentials")
      end select
   end subroutine test_sls

   !> Next to exponent 1 nothing breaks: the modulus goes over into that of the SLS
   subroutine test_nearly_sls()
      real(wp), parameter :: tau = 1.0e-3_wp, below(3) = [1.0e-6_wp, 1.0e-12_wp, epsilon(tau)]
      real(wp), parameter :: time(4) = [1.0e-12_wp, 1.0e-4_wp, 1.0e-3_wp, 0.01_wp]
      class(material_t), allocatable :: material
      type(prony_t) :: sls
      integer :: i

      call sls_of(sls, tau)
      do i = 1, size(below)
         call build(1.0_wp - below(i), tau, material)
         if (.not. allocated(material)) cycle
         call check_relative(material%relaxation(time), sls%relaxation(time), &
            rounding + below(i), "just below exponent 1 E is that of the SLS")
         ! compared with exp(-10) = 5e-5 the power law of the tail has grown, though 1 - a is its
         ! factor
         call check_relative(material%rate(time), sls%rate(time), &
            5.0_wp*rounding + 1.0e3_wp*below(i), "and its rate")
         call check_relative(material%integral(time), sls%integral(time), rounding + below(i), &
            "and its integral")
      end do
   end subroutine test_nearly_sls

   !> As a sum of exponentials too: the peak of the spectrum is as narrow as 1 - a, and is met
   subroutine test_narrow_peak()
      real(wp), parameter :: below(5) = [1.0e-2_wp, 1.0e-6_wp, 1.0e-9_wp, 1.0e-12_wp, &
         epsilon(1.0_wp)]
      real(wp), parameter :: tau = 1.0e-3_wp, window(3) = [1.0e-4_wp, 1.0e-3_wp, 1.0e-2_wp]
      real(wp), parameter :: part(3) = [0.1_wp, 0.5_wp, 1.0_wp]
      real(wp), parameter :: accuracy = 1.0e-12_wp, wanted = 1.0e-11_wp
      class(material_t), allocatable :: material
      type(exponential_sum_t) :: terms
      real(wp) :: time
      integer :: i, j, k

      do i = 1, size(below)
         call build(1.0_wp - below(i), tau, material)
         if (.not. allocated(material)) cycle
         do j = 1, size(window)
            call material%exponentials(window(j), accuracy, terms)
            do k = 1, size(part)
               time = part(k)*window(j)
               call check_relative(terms%integral(time), material%integral(time), wanted, &
                  "the integral of the sum")
               call check_relative(terms%equilibrium + sum(terms%moduli*exp(-terms%rates*time)), &
                  material%relaxation(time), wanted, "the sum")
            end do
            call check(terms%error <= wanted, "and its error says so")
         end do
      end do
   end subroutine test_narrow_peak

   !> A material by the factory: 1 MPa of 4 MPa are left
   subroutine build(exponent, tau, material)
      !> Exponent
      real(wp), intent(in) :: exponent
      !> Relaxation time [s]
      real(wp), intent(in) :: tau
      !> The material
      class(material_t), allocatable, intent(out) :: material

      type(material_data_t) :: data
      type(error_t), allocatable :: error

      data%name = 'rubber'
      data%model = 'mittag_leffler'
      call data%set('equilibrium_modulus', 1.0e6_wp)
      call data%set('relaxing_modulus', 3.0e6_wp)
      call data%set('exponent', exponent)
      call data%set('time', tau)
      call new_material(material, data, error)
      call success(error, "a Mittag-Leffler material is built by its name")
   end subroutine build

   !> The same as a standard linear solid
   subroutine sls_of(sls, tau)
      !> The material
      type(prony_t), intent(out) :: sls
      !> Relaxation time [s]
      real(wp), intent(in) :: tau

      type(error_t), allocatable :: error

      call new_sls(sls, 4.0e6_wp, 0.25_wp/tau, 1.0_wp/tau, error)
      call success(error, "an SLS is built")
   end subroutine sls_of

   !> Where t/tau, its powers or s tau are beyond all numbers: a debug build halts at an overflow
   subroutine test_extremes()
      real(wp), parameter :: exponent(6) = [1.0e-12_wp, 0.01_wp, 0.5_wp, 0.99_wp, &
         1.0_wp - 1.0e-12_wp, 1.0_wp - epsilon(1.0_wp)]
      real(wp), parameter :: tau(5) = [tiny(tau), 1.0e-200_wp, 1.0_wp, 1.0e200_wp, huge(tau)]
      real(wp), parameter :: size_of(5) = [0.0_wp, tiny(tau), 1.0e-160_wp, 1.0e160_wp, huge(tau)]
      type(mittag_leffler_t) :: material
      type(error_t), allocatable :: error
      complex(wp) :: modulus
      integer :: i, j

      do i = 1, size(exponent)
         do j = 1, size(tau)
            call new_mittag_leffler(material, 0.0_wp, 1.0_wp, exponent(i), tau(j), error)
            call success(error, "a material with an extreme time is built")
            call check(all(material%relaxation(size_of) >= 0.0_wp &
               .and. material%relaxation(size_of) <= 1.0_wp + rounding), "0 <= E <= E_0 + E_1")
            call check(all(material%rate(size_of) <= 0.0_wp), "E does not grow")
            call check(all(material%integral(size_of) >= 0.0_wp), "the integral is positive")
            call check_modulus(material, cmplx(-size_of, 0.0_wp, wp))
            call check_modulus(material, cmplx(0.0_wp, size_of, wp))
            call check_modulus(material, cmplx(size_of, 0.0_wp, wp))
         end do
      end do
      call new_mittag_leffler(material, 3.0_wp, 1.0_wp, 0.5_wp, 1.0_wp, error)
      modulus = material%complex_modulus((0.0_wp, 0.0_wp))
      call check_close(abs(modulus - 3.0_wp), 0.0_wp, 0.0_wp, "Q(0) is the rubbery modulus")
   end subroutine test_extremes

   !> The complex modulus is a number, and its loss not negative
   subroutine check_modulus(material, s)
      !> The material
      type(mittag_leffler_t), intent(in) :: material
      !> Laplace variables above the real axis [1/s]
      complex(wp), intent(in) :: s(:)

      call check(all(ieee_is_finite(abs(material%complex_modulus(s)))), "Q is finite")
      call check(all(aimag(material%complex_modulus(s)) >= 0.0_wp), "the loss is not negative")
   end subroutine check_modulus

   !> Parameters that make no material
   subroutine test_refusals()
      type(mittag_leffler_t) :: material
      type(material_data_t) :: data
      class(material_t), allocatable :: built
      type(error_t), allocatable :: error

      call new_mittag_leffler(material, -1.0_wp, 1.0_wp, 0.5_wp, 1.0_wp, error)
      call refused(error, "equilibrium_modulus")
      call new_mittag_leffler(material, 0.0_wp, 0.0_wp, 0.5_wp, 1.0_wp, error)
      call refused(error, "relaxing_modulus")
      call new_mittag_leffler(material, 0.0_wp, 1.0_wp, 0.5_wp, 0.0_wp, error)
      call refused(error, "time")
      call new_mittag_leffler(material, 0.0_wp, 1.0_wp, 0.0_wp, 1.0_wp, error)
      call refused(error, "exponent")
      call new_mittag_leffler(material, 0.0_wp, 1.0_wp, 1.2_wp, 1.0_wp, error)
      call refused(error, "exponent")
      call new_mittag_leffler(material, 0.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, error)
      call refused(error, "exponent")

      data%name = 'rubber'
      data%model = 'mittag_leffler'
      call data%set('exponent', 1.0_wp)
      call data%set('relaxing_modulus', 1.0_wp)
      call data%set('time', 0.0_wp)
      call new_material(built, data, error)
      call refused(error, "time")
      call data%set('time', 1.0_wp)
      call data%set('relaxing_modulus', -1.0_wp)
      call new_material(built, data, error)
      call refused(error, "moduli")
      call data%set('exponent', 1.5_wp)
      call data%set('relaxing_modulus', 1.0_wp)
      call new_material(built, data, error)
      call refused(error, "exponent")
   end subroutine test_refusals

end program test_mittag_leffler
