!> Contact modulus, plate, impact, trajectory and outcome
program test_impact
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite, ieee_is_nan, ieee_positive_inf, &
      ieee_value
   use vcor_error, only : error_input, error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus
   use vcor_impact_law, only : cone_factor, contact_law_t, new_contact_law
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_target, only : new_plate, target_t, waves_constant, waves_none, waves_relaxing
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate_velocity, &
      col_sphere, col_sphere_velocity, col_time, col_velocity, columns, contact_lasting, &
      contact_separated, trajectory_t
   use vcor_kinds, only : pi, wp
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_rigid, new_sls, prony_t
   use vcor_material_type, only : material_t
   use vcor_numeric_quadrature, only : gauss_nodes
   use vcor_solver_ive, only : ive_t
   use vcor_solver_direct_product, only : product_t
   use vcor_test, only : check, check_close, check_contains, check_relative, finish, suite
   use vcor_test_cases, only : refused, make_ive, make_product, rigid_on_plate, success
   implicit none

   !> A dozen operations, each rounded
   real(wp), parameter :: rounding = 4.0e-15_wp
   !> Gauss's rule of eight nodes on the step next to a singularity, over the whole integral
   real(wp), parameter :: step_tolerance = 1.0e-11_wp
   !> Five-point formula with steps of 1/500: (1/500)^4/30 times a fifth derivative of up to a
   !> hundred
   real(wp), parameter :: slope_tolerance = 1.0e-10_wp
   !> Iteration for the time scale ends at changes of 1e-3, contracted by up to 2/5
   real(wp), parameter :: scale_tolerance = 1.0e-3_wp
   !> Fourier quadrature of a pair against closed forms
   real(wp), parameter :: transform_tolerance = 1.0e-11_wp

   type(prony_t) :: rigid, steel, glass, sls
   type(power_law_t) :: power_law
   type(cerf_t) :: cerf
   type(error_t), allocatable :: failure

   call suite("impact")
   call new_rigid(rigid)
   call rigid%set_constants(failure, density=7800.0_wp)
   call new_elastic(steel, 210.0e9_wp, failure)
   call steel%set_constants(failure, density=7800.0_wp, poisson_ratio=0.3_wp)
   call new_elastic(glass, 70.0e9_wp, failure)
   call glass%set_constants(failure, density=2500.0_wp, poisson_ratio=0.22_wp)
   call new_sls(sls, 15.0e6_wp, 300.0_wp, 1200.0_wp, failure)
   call sls%set_constants(failure, density=1100.0_wp)
   call new_power_law(power_law, 8.0e6_wp, 7.0e5_wp, 0.5_wp, failure)
   call power_law%set_constants(failure, density=1100.0_wp)
   call new_cerf(cerf, 8.0e6_wp, 6.0e8_wp, 300.0_wp, failure)
   call cerf%set_constants(failure, density=1100.0_wp)
   call success(failure, "the materials are built")

   call test_four_cases()
   call test_pair()
   call test_integral_of_pair()
   call test_refused_pairs()
   call test_unsound_constants()
   call test_plate()
   call test_radius()
   call test_law()
   call test_time_scale()
   call test_deepest()
   call test_sample()
   call test_outcome()
   call test_stuck()
   call finish()

contains

   !> The law of spheres is s sqrt(|s|) to the last bit, by default, built, or asked for many
   !> values; the other laws hold at both ends of their exponents
   subroutine test_law()
      real(wp), parameter :: s(5) = [-2.0e-5_wp, 0.0_wp, 3.0e-7_wp, 1.7e-4_wp, 4.0_wp]
      ! contact times of n = 1, half a period of a spring, and of n = 2
      real(wp), parameter :: exponent(2) = [1.0_wp, 2.0_wp]
      real(wp), parameter :: guess(5) = [0.0_wp, -1.0e-300_wp, 1.0e-12_wp, -3.9_wp, 1.0e6_wp]
      real(wp) :: duration(2), root(5), slope(5), found
      type(contact_law_t) :: hertz, built, law
      type(error_t), allocatable :: error
      integer :: i

      call new_contact_law(built, 1.5_wp, .true., error)
      call success(error, "the law of spheres is built")
      call check(built%receding .and. .not. hertz%receding, "the receding law is asked for")
      call check(.not. abs(built%contact_time - hertz%contact_time) > 0.0_wp, &
         "a built law of spheres is the default")
      call check_close(hertz%contact_time, 0.8_wp*sqrt(pi)*gamma(0.4_wp)/gamma(0.9_wp) &
         *1.25_wp**0.4_wp, rounding, "Hertz: contact time in units of T")
      call check(.not. any(abs(hertz%u(s) - s*sqrt(abs(s))) > 0.0_wp), "u = s sqrt(|s|)")
      call check(.not. any(abs(hertz%slope(s) - 1.5_wp*sqrt(abs(s))) > 0.0_wp), "slope of u")
      call hertz%evaluate(size(s), s, root, slope)
      call check(.not. any(abs(root - sqrt(abs(s))) > 0.0_wp), "u/s of many values")
      call check(.not. any(abs(slope - hertz%slope(s)) > 0.0_wp), "du/ds of many values")
      call check_close(hertz%depth, 1.25_wp**0.4_wp, rounding, "Hertz: depth in units of v0 T")
      call check_relative(hertz%inverse(8.0_wp), 4.0_wp, rounding, "s of a given u")
      call check_relative(hertz%radius(4.0_wp/3.0_wp*sqrt(0.3_wp), 1.0e-3_wp), &
         sqrt(0.3e-3_wp), rounding, "a = sqrt(R s)")
      call check_relative(hertz%profile(4.0_wp/3.0_wp*sqrt(0.3_wp), 1.0e-3_wp), &
         1.0e-6_wp/0.3_wp, rounding, "h = x^2/R")
      call check_relative(hertz%time_scale(2.0_wp, 3.0_wp, 4.0_wp), (1.0_wp/3.0_wp)**0.4_wp, &
         rounding, "T = (m/(k sqrt(v0)))^(2/5)")
      ! s + 3 u(s) = 28 at s = 4; the guess may be next to nothing, and as well far too large
      do i = 1, size(guess)
         call hertz%solve(3.0_wp, 0.0_wp, -28.0_wp, guess(i), found)
         call check_relative(found, -4.0_wp, rounding, "root of the equation of a step")
      end do

      duration = [pi, 2.0_wp*1.5_wp**(1.0_wp/3.0_wp)*sqrt(pi)*gamma(4.0_wp/3.0_wp) &
         /gamma(5.0_wp/6.0_wp)]
      do i = 1, size(exponent)
         call new_contact_law(law, exponent(i), .false., error)
         call success(error, "another law is built")
         call check_relative(law%contact_time, duration(i), rounding, "contact time in units of T")
         call check_relative(law%u(-0.3_wp), -0.3_wp**exponent(i), rounding, "u is odd")
         call check_relative(law%slope(-0.3_wp), exponent(i)*0.3_wp**(exponent(i) - 1.0_wp), &
            rounding, "u' is even")
         call law%evaluate(size(s), s, root, slope)
         call check(.not. any(abs(root - law%secant(s)) + abs(slope - law%slope(s)) > 0.0_wp), &
            "many values are the same")
         call check_relative(law%inverse(law%u(0.3_wp)), 0.3_wp, rounding, "inverse of u")
         call check_relative(law%depth, (0.5_wp*(exponent(i) + 1.0_wp)) &
            **(1.0_wp/(exponent(i) + 1.0_wp)), rounding, "depth in units of v0 T")
         call check_relative(law%time_scale(2.0_wp, 3.0_wp, 4.0_wp), &
            merge(sqrt(2.0_wp/3.0_wp), (2.0_wp/12.0_wp)**(1.0_wp/3.0_wp), i == 1), rounding, &
            "T of another law")
      end do
      ! the cone touches x at (pi/2) x cot, the punch is flat
      call check_relative(law%profile(cone_factor(30.0_wp), 0.2_wp), 0.1_wp*pi*sqrt(3.0_wp), &
         rounding, "profile of a cone")
      call new_contact_law(law, 1.0_wp, .false., error)
      call check(.not. abs(law%profile(0.3_wp, 0.1_wp)) > 0.0_wp, "a flat punch is flat")
      call check_relative(law%radius(0.3_wp, 1.0e-3_wp), 0.15_wp, rounding, "radius of a punch")

      call new_contact_law(law, 0.9_wp, .false., error)
      call refused(error, "an exponent below 1", "")
      call new_contact_law(law, ieee_value(1.0_wp, ieee_positive_inf), .false., error)
      call refused(error, "an infinite exponent", "")
   end subroutine test_law

   !> Density and Poisson's ratio out of range are refused, and change nothing
   subroutine test_unsound_constants()
      type(prony_t) :: soft
      type(target_t) :: plate
      type(error_t), allocatable :: error
      real(wp) :: ratio(5), density(3)
      integer :: i

      ratio = [1.0_wp, -1.0_wp, 0.51_wp, -7.0_wp, ieee_value(1.0_wp, ieee_positive_inf)]
      density = [0.0_wp, -1.0_wp, ieee_value(1.0_wp, ieee_positive_inf)]
      soft = sls
      do i = 1, size(ratio)
         call soft%set_constants(error, density=900.0_wp, poisson_ratio=ratio(i))
         call refused(error, "Poisson's ratio", "")
      end do
      do i = 1, size(density)
         call soft%set_constants(error, density=density(i), poisson_ratio=0.3_wp)
         call refused(error, "a density", "")
      end do
      call check_close(soft%density(), 1100.0_wp, 0.0_wp, "the density stays")
      call check_close(soft%poisson_ratio(), 0.5_wp, 0.0_wp, "Poisson's ratio stays")
      call soft%set_constants(error, density=1.0e300_wp)
      call new_plate(plate, soft, 0.02_wp, waves_relaxing, error)
      call refused(error, "a density beyond the numbers", "")
      call new_plate(plate, sls, 1.0e155_wp, waves_relaxing, error)
      call refused(error, "a thickness whose square is beyond the numbers", "")
   end subroutine test_unsound_constants

   !> The cases of the paper's Section III
   subroutine test_four_cases()
      type(contact_modulus_t) :: modulus
      type(exponential_sum_t) :: terms
      type(error_t), allocatable :: error
      real(wp) :: a, b
      real(wp), parameter :: t = 4.0e-4_wp

      ! 1: both elastic
      a = 210.0e9_wp/(1.0_wp - 0.3_wp**2)
      b = 70.0e9_wp/(1.0_wp - 0.22_wp**2)
      call new_contact_modulus(modulus, steel, glass, .false., error)
      call success(error, "two elastic bodies")
      call check_relative(modulus%glassy(), a*b/(a + b), rounding, "two elastic bodies: Eq. (1)")
      call check_relative(modulus%relaxation(t), a*b/(a + b), rounding, "they do not relax")
      call modulus%exponentials(1.0_wp, 1.0e-8_wp, terms)
      call check(size(terms%moduli) == 0, "they are a sum of no exponentials")
      call check_close(terms%error, 0.0_wp, 0.0_wp, "and that sum exactly")
      call new_contact_modulus(modulus, steel, steel, .true., error)
      call check_relative(modulus%glassy(), 0.5_wp*a, rounding, "two of the same: half the modulus")

      ! 2: both of one viscoelastic material
      call new_contact_modulus(modulus, sls, sls, .true., error)
      call check_relative(modulus%relaxation(t), 0.5_wp*sls%relaxation(t)/0.75_wp, rounding, &
         "both of one viscoelastic material")
      call modulus%exponentials(1.0_wp, 1.0e-8_wp, terms)
      call check_close(terms%error, 0.0_wp, 0.0_wp, "both of one SLS: a sum of exponentials")
      call check_relative(terms%moduli(1), 0.5_wp*15.0e6_wp/0.75_wp*0.75_wp, rounding, &
         "with half of the modulus in its term")
      call check_relative(terms%rates(1), 1200.0_wp, rounding, "and the rate of the SLS")

      ! 3 and 4: one of them hard
      call new_contact_modulus(modulus, rigid, sls, .false., error)
      call same_as(modulus, sls, 1.0_wp/0.75_wp, "hard sphere on a soft plate")
      call new_contact_modulus(modulus, sls, rigid, .false., error)
      call same_as(modulus, sls, 1.0_wp/0.75_wp, "soft sphere on a hard plate")
      call new_contact_modulus(modulus, rigid, power_law, .false., error)
      call same_as(modulus, power_law, 1.0_wp/0.75_wp, "hard sphere on a power law")
      call new_contact_modulus(modulus, cerf, rigid, .false., error)
      call same_as(modulus, cerf, 1.0_wp/0.75_wp, "CERF sphere on a hard plate")
   end subroutine test_four_cases

   !> Check that a contact modulus is a multiple of a material's
   subroutine same_as(modulus, material, factor, what)
      !> The contact modulus
      type(contact_modulus_t), intent(in) :: modulus
      !> The material
      class(material_t), intent(in) :: material
      !> Factor
      real(wp), intent(in) :: factor
      !> What they are
      character(len=*), intent(in) :: what

      integer, parameter :: steps = 20
      real(wp), parameter :: t = 4.0e-4_wp, omega = 4000.0_wp
      complex(wp) :: dynamic

      call check_relative(modulus%relaxation(t), factor*material%relaxation(t), rounding, &
         what//": relaxation")
      call check_relative(modulus%rate(t), factor*material%rate(t), rounding, what//": rate")
      call check_relative(modulus%rubbery(), factor*material%rubbery(), rounding, &
         what//": rubbery modulus")
      if (ieee_is_finite(material%glassy())) call check_relative(modulus%glassy(), &
         factor*material%glassy(), rounding, what//": glassy modulus")
      dynamic = modulus%dynamic_modulus(omega)/material%complex_modulus(cmplx(0.0_wp, omega, wp))
      call check_close(abs(dynamic - factor), 0.0_wp, rounding, what//": dynamic modulus")
      call check_relative(sum(modulus%step_integrals(t/steps, steps)), &
         factor*material%integral(t), 10.0_wp*rounding, what//": the steps are the whole")
   end subroutine same_as

   !> Two different materials of which one relaxes, at least
   subroutine test_pair()
      type(prony_t) :: soft
      type(power_law_t) :: other
      type(error_t), allocatable :: error
      type(contact_modulus_t) :: modulus
      complex(wp) :: dynamic
      real(wp) :: g, r, b, s, omega

      call new_sls(soft, 8.0e6_wp, 360.0_wp, 900.0_wp, error)
      call soft%set_constants(error, poisson_ratio=0.45_wp)
      call pair_of(soft, sls, "two SLS")
      call pair_of(sls, steel, "SLS and steel")
      call pair_of(power_law, steel, "power law and steel")
      call pair_of(cerf, sls, "CERF and SLS")
      call pair_of(power_law, cerf, "power law and CERF")
      call new_power_law(other, 2.0e6_wp, 3.0e5_wp, 0.3_wp, error)
      call success(error, "another power law")
      call other%set_constants(error, poisson_ratio=0.4_wp)
      call pair_of(power_law, other, "two power laws")
      call check_with_elastic(sls, steel, 4, "SLS and steel")
      call check_with_elastic(sls, glass, 4, "SLS and glass")
      call new_prony(soft, 1.0e7_wp, [1.0e9_wp, 4.0e8_wp, 3.0e7_wp], &
         [1.0e6_wp, 1.0e4_wp, 3.0e2_wp], 0.0_wp, error)
      call check_with_elastic(soft, glass, 150, "three relaxation times and glass")
      ! powers of 1/2, and of more than 1
      call new_elastic(soft, 22.0e6_wp, error)
      call check_with_elastic(sls, soft, 60, "SLS and something as hard")
      call new_elastic(soft, 1.0e6_wp, error)
      call pair_of(sls, soft, "SLS and something softer")

      ! An SLS of glassy modulus g and rubbery r with an elastic body of modulus s: with
      ! y = exp(-b t), E' = s (r + d y)/(s + r + d y), whose transform is a hypergeometric series;
      ! in the limit s -> infinity it is that of the SLS, for s = 1e9 g to nine digits
      g = 15.0e6_wp/0.75_wp
      r = 0.25_wp*g
      b = 1200.0_wp
      omega = 4000.0_wp
      call new_elastic(soft, 1.0e9_wp*g, error)
      call new_contact_modulus(modulus, sls, soft, .false., error)
      s = soft%glassy()*soft%plane_strain_factor()
      dynamic = modulus%dynamic_modulus(omega)
      call check_relative(real(dynamic, wp), r + (g - r)*omega**2/(omega**2 + b**2), 1.0e-8_wp, &
         "storage modulus of an SLS on something very hard")
      call check_relative(aimag(dynamic), (g - r)*omega*b/(omega**2 + b**2), 1.0e-8_wp, &
         "loss modulus of an SLS on something very hard")
      ! two moduli with the same course make a pair with a closed form
      call new_contact_modulus(modulus, sls, sls, .false., error)
      dynamic = modulus%dynamic_modulus(omega)
      call check_relative(real(dynamic, wp), 0.5_wp*(r + (g - r)*omega**2/(omega**2 + b**2)), &
         transform_tolerance, "storage modulus of a pair of equals")
      call check_relative(aimag(dynamic), 0.5_wp*(g - r)*omega*b/(omega**2 + b**2), &
         transform_tolerance, "loss modulus of a pair of equals")
      call new_contact_modulus(modulus, power_law, power_law, .false., error)
      dynamic = modulus%dynamic_modulus(omega) &
         /(power_law%complex_modulus(cmplx(0.0_wp, omega, wp))*0.5_wp/0.75_wp)
      call check_close(abs(dynamic - 1.0_wp), 0.0_wp, transform_tolerance, &
         "dynamic modulus of a pair of equal power laws")
      call check(s > g, "the hard one is harder")
   end subroutine test_pair

   !> Integral of an SLS with an elastic body, long after it has relaxed and before: with
   !> c = s + r, E' = s (1 - s/(c + d exp(-b t))), whose integral is a logarithm
   subroutine test_integral_of_pair()
      ! the modulus falls thirtyfold at b t = ln(d/c), with poles close to the real axis
      real(wp), parameter :: s = 1.0e6_wp, r = 1.0e5_wp, d = 4.0e7_wp, b = 1.0e3_wp
      ! twelve Gauss nodes over a factor of 3.2, with the poles at 40 degrees from the real axis
      real(wp), parameter :: tolerance = 1.0e-9_wp
      type(prony_t) :: relaxing, elastic
      type(contact_modulus_t) :: modulus
      type(error_t), allocatable :: error
      real(wp) :: t, expected
      integer :: i

      call new_prony(relaxing, r, [d], [b], 0.0_wp, error)
      call success(error, "an SLS as a Prony series")
      call new_elastic(elastic, s, error)
      call relaxing%set_constants(error, poisson_ratio=0.0_wp)
      call elastic%set_constants(error, poisson_ratio=0.0_wp)
      call new_contact_modulus(modulus, relaxing, elastic, .false., error)
      call success(error, "it makes a pair")
      do i = -3, 3
         t = 10.0_wp**i/b
         expected = s*(t - s/(s + r)*(t + log((s + r + d*exp(-b*t))/(s + r + d))/b))
         call check_relative(modulus%integral(t), expected, tolerance, "integral of a pair")
      end do
   end subroutine test_integral_of_pair

   !> Check a pair against Eq. (1)
   subroutine pair_of(first, second, what)
      !> One material
      class(material_t), intent(in) :: first
      !> The other one
      class(material_t), intent(in) :: second
      !> What they are
      character(len=*), intent(in) :: what

      integer, parameter :: steps = 20
      real(wp), parameter :: t = 4.0e-4_wp, h = t/500.0_wp
      ! what a pair is to be as good as where cor is wanted to eight digits, with one to spare
      ! y^3.4 for t^-0.3, by 24 nodes: 24^-(2*4.4)/10
      real(wp), parameter :: mean_tolerance = 1.0e-8_wp
      real(wp), parameter :: window = 4.0e-3_wp, fit_tolerance = 1.0e-9_wp
      type(contact_modulus_t) :: modulus, other
      type(error_t), allocatable :: error
      type(exponential_sum_t) :: terms
      real(wp) :: a, b, whole(1), time, node(24), weight(24), check_mean
      integer :: i

      call new_contact_modulus(modulus, first, second, .false., error)
      call success(error, what//" make a pair")
      call new_contact_modulus(other, second, first, .false., error)
      a = first%relaxation(t)*first%plane_strain_factor()
      b = second%relaxation(t)*second%plane_strain_factor()
      call check_relative(modulus%relaxation(t), a*b/(a + b), rounding, what//": Eq. (1)")
      call check_relative(other%relaxation(t), a*b/(a + b), rounding, what//": the other way round")
      call check_close(t*modulus%rate(t)/modulus%relaxation(t), t &
         *(modulus%relaxation(t - 2.0_wp*h) - modulus%relaxation(t + 2.0_wp*h) &
         + 8.0_wp*(modulus%relaxation(t + h) &
         - modulus%relaxation(t - h)))/(12.0_wp*h)/modulus%relaxation(t), slope_tolerance, &
         what//": the rate is the derivative")
      whole = modulus%step_integrals(t, 1)
      call check_relative(sum(modulus%step_integrals(t/steps, steps)), whole(1), step_tolerance, &
         what//": the steps are the whole")
      ! by Gauss's rule over the root of the time, in which the integral is smooth
      call gauss_nodes(node, weight)
      check_mean = sum(2.0_wp*node*weight*modulus%integral(t*node**2))
      call check_relative(modulus%mean_integral(t), check_mean, mean_tolerance, &
         what//": mean of the integral")
      if (ieee_is_finite(first%glassy()) .and. ieee_is_finite(second%glassy())) then
         call check_relative(modulus%relaxation(0.0_wp), modulus%glassy(), rounding, &
            what//": E'(0) is the glassy modulus")
      else if (ieee_is_finite(second%glassy())) then
         call check_relative(modulus%glassy(), second%glassy()*second%plane_strain_factor(), &
            rounding, what//": the glassy modulus is that of the finite one")
         call check_relative(modulus%relaxation(0.0_wp), modulus%glassy(), rounding, &
            what//": and so is E'(0)")
      else if (.not. ieee_is_finite(first%glassy())) then
         call check(.not. ieee_is_finite(modulus%glassy()), what//": no glassy modulus")
         call check(.not. ieee_is_finite(modulus%relaxation(0.0_wp)), what//": nor E'(0)")
      end if
      a = first%rubbery()*first%plane_strain_factor()
      b = second%rubbery()*second%plane_strain_factor()
      call check_relative(modulus%rubbery(), a*b/(a + b), rounding, what//": rubbery modulus")
      call check_close(modulus%viscosity(), 0.0_wp, 0.0_wp, what//": no dashpot")

      call modulus%exponentials(window, 1.0e-8_wp, terms)
      call check(terms%error > 0.0_wp, what//": no finite sum of exponentials")
      call check_close(terms%error, 0.0_wp, fit_tolerance, what//": but close to one")
      do i = 0, 20
         time = window*0.01_wp**(real(i, wp)/20.0_wp)
         call check_relative(terms%equilibrium + sum(terms%moduli*exp(-terms%rates*time)), &
            modulus%relaxation(time), fit_tolerance, what//": as the sum is")
      end do
      call check_relative(terms%equilibrium*window &
         + sum(terms%moduli/terms%rates*(1.0_wp - exp(-terms%rates*window))), &
         modulus%integral(window), fit_tolerance, what//": and its integral")
   end subroutine pair_of

   !> Check the sum of a pair of an elastic body and one that relaxes: it holds from the start
   subroutine check_with_elastic(relaxing, elastic, most, what)
      !> The one that relaxes
      class(material_t), intent(in) :: relaxing
      !> The elastic one
      class(material_t), intent(in) :: elastic
      !> Most terms that it takes
      integer, intent(in) :: most
      !> What they are
      character(len=*), intent(in) :: what

      real(wp), parameter :: window = 4.0e-3_wp
      type(contact_modulus_t) :: modulus, other
      type(error_t), allocatable :: error
      type(exponential_sum_t) :: terms, others
      real(wp) :: accuracy, time, difference
      integer :: i, k

      call new_contact_modulus(modulus, relaxing, elastic, .false., error)
      call success(error, what//" make a pair")
      call new_contact_modulus(other, elastic, relaxing, .false., error)
      do k = 4, 8, 4
         accuracy = 0.1_wp**k
         call modulus%exponentials(window, accuracy, terms)
         call check(size(terms%moduli) <= most, what//": a short sum")
         call check(terms%error <= 1.0e-2_wp*accuracy, what//": much better than asked for")
         difference = 0.0_wp
         do i = -1, 30
            time = 0.0_wp
            if (i >= 0) time = window*0.5_wp**i
            difference = max(difference, abs((terms%equilibrium + sum(terms%moduli &
               *exp(-terms%rates*time)))/modulus%relaxation(time) - 1.0_wp))
         end do
         call check(difference <= terms%error + rounding, what//": the sum is within its error")
      end do
      call other%exponentials(window, accuracy, others)
      call check_relative(others%equilibrium + sum(others%moduli), terms%equilibrium &
         + sum(terms%moduli), rounding, what//": the other way round")
   end subroutine check_with_elastic

   !> Pairs that make no contact modulus
   subroutine test_refused_pairs()
      type(prony_t) :: dashpot, fluid
      type(contact_modulus_t) :: modulus
      type(error_t), allocatable :: error
      real(wp), parameter :: none(0) = [real(wp) ::]

      call new_contact_modulus(modulus, rigid, rigid, .false., error)
      call check(allocated(error), "two rigid bodies are refused")
      if (allocated(error)) call check_contains(error%message, "both rigid", "and it is said why")
      call new_prony(dashpot, 1.0e6_wp, none, none, 10.0_wp, error)
      call new_contact_modulus(modulus, dashpot, sls, .false., error)
      call check(allocated(error), "a dashpot in a pair is refused")
      if (allocated(error)) call check(error%code == error_input, "as an error of the input")
      call new_contact_modulus(modulus, steel, dashpot, .false., error)
      call check(allocated(error), "also with an elastic body")
      call new_contact_modulus(modulus, rigid, dashpot, .false., error)
      call success(error, "with a rigid body it is not")
      call check_relative(modulus%viscosity(), 10.0_wp/0.75_wp, rounding, &
         "and its viscosity counts")
      call new_prony(fluid, 0.0_wp, [1.0e6_wp], [10.0_wp], 0.0_wp, error)
      call new_contact_modulus(modulus, fluid, sls, .false., error)
      call success(error, "a fluid and a solid make a pair")
      call check_close(modulus%rubbery(), 0.0_wp, 0.0_wp, "that relaxes to nothing")
   end subroutine test_refused_pairs

   !> Zener's parameter alpha
   subroutine test_plate()
      real(wp), parameter :: half = 0.02_wp, t = 4.0e-4_wp, h = t/500.0_wp
      type(target_t) :: plate
      type(prony_t) :: nothing
      type(error_t), allocatable :: error
      real(wp), parameter :: none(0) = [real(wp) ::]

      call new_plate(plate, sls, half, waves_relaxing, error)
      call success(error, "a relaxing plate is built")
      call check_relative(plate%alpha(0.0_wp), sqrt(3.0_wp*1100.0_wp/(15.0e6_wp/0.75_wp)) &
         /(16.0_wp*1100.0_wp*half**2), rounding, "alpha(0) of Eq. (3)")
      call check_relative(plate%alpha(t), sqrt(3.0_wp*1100.0_wp/(sls%relaxation(t)/0.75_wp)) &
         /(16.0_wp*1100.0_wp*half**2), rounding, "alpha(t) of Eq. (3)")
      call check_relative(plate%alpha_rate(t), (plate%alpha(t - 2.0_wp*h) &
         - plate%alpha(t + 2.0_wp*h) + 8.0_wp*(plate%alpha(t + h) - plate%alpha(t - h))) &
         /(12.0_wp*h), slope_tolerance, "its rate is the derivative")
      call new_plate(plate, power_law, half, waves_relaxing, error)
      call check_relative(plate%alpha_rate(t), (plate%alpha(t - 2.0_wp*h) &
         - plate%alpha(t + 2.0_wp*h) + 8.0_wp*(plate%alpha(t + h) - plate%alpha(t - h))) &
         /(12.0_wp*h), slope_tolerance, "also for a power law")
      call check_close(plate%alpha(0.0_wp), 0.0_wp, 0.0_wp, "whose alpha(0) is zero")
      call new_plate(plate, sls, half, waves_constant, error)
      call check_relative(plate%alpha(1.0_wp), sqrt(3.0_wp*1100.0_wp/(15.0e6_wp/0.75_wp)) &
         /(16.0_wp*1100.0_wp*half**2), rounding, "a constant plate keeps alpha(0)")
      call check_close(plate%alpha_rate(t), 0.0_wp, 0.0_wp, "and has no rate")
      call new_plate(plate, sls, 0.0_wp, waves_none, error)
      call success(error, "a plate without waves needs no thickness")
      call check_close(plate%alpha(t), 0.0_wp, 0.0_wp, "it does not move")
      call new_plate(plate, rigid, half, waves_relaxing, error)
      call success(error, "a rigid plate is built")
      call check_close(plate%alpha(t), 0.0_wp, 0.0_wp, "it does not move, either")
      call new_plate(plate, steel, half, waves_relaxing, error)
      call check_relative(plate%alpha(t), plate%alpha(0.0_wp), 0.0_wp, &
         "elastic plates are constant")

      call new_plate(plate, sls, 0.0_wp, waves_relaxing, error)
      call check(allocated(error), "waves without a thickness are refused")
      call new_sls(nothing, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      call new_plate(plate, nothing, half, waves_constant, error)
      call check(allocated(error), "waves without a density are refused")
      call new_prony(nothing, 0.0_wp, none, none, 1.0_wp, error)
      call nothing%set_constants(error, density=1000.0_wp)
      call new_plate(plate, nothing, half, waves_constant, error)
      call check(allocated(error), "waves in a dashpot are refused")
   end subroutine test_plate

   !> Footnote 2: 1/R = 1/r + 1/r_surface
   subroutine test_radius()
      real(wp), parameter :: r = 0.01_wp, t = 4.0e-4_wp
      real(wp), parameter :: surface(3) = [0.0_wp, 0.03_wp, -0.03_wp]
      real(wp), parameter :: hertz(3) = [0.01_wp, 0.0075_wp, 0.015_wp]
      type(contact_modulus_t) :: modulus
      type(target_t) :: plate
      type(impact_t) :: impact
      type(error_t), allocatable :: error
      real(wp) :: whole(1)
      integer :: i

      call new_contact_modulus(modulus, rigid, sls, .false., error)
      call new_plate(plate, sls, 0.02_wp, waves_relaxing, error)
      do i = 1, 3
         call new_impact(impact, 5.0_wp, 0.03_wp, r, surface(i), modulus, plate, error)
         call success(error, "an impact is built")
         call check_relative(impact%factor, 4.0_wp/3.0_wp*sqrt(hertz(i)), rounding, &
            "flat, convex, concave: the radius of Hertz")
         call check_relative(impact%kernel(t), impact%factor*modulus%relaxation(t), &
            rounding, "kernel of Eq. (5)")
         whole = impact%kernel_step_integrals(t, 1)
         call check_relative(whole(1), impact%factor*sls%integral(t)/0.75_wp, rounding, &
            "and its integral")
      end do
      call check_relative(impact%initial_energy(), 0.375_wp, rounding, "energy m v^2/2")
      call new_impact(impact, 5.0_wp, 0.03_wp, r, -0.01_wp, modulus, plate, error)
      call check(allocated(error), "a hollow as narrow as the sphere is refused")
      call new_impact(impact, 0.0_wp, 0.03_wp, r, 0.0_wp, modulus, plate, error)
      call check(allocated(error), "no velocity is refused")
      call new_impact(impact, 1.0_wp, -0.03_wp, r, 0.0_wp, modulus, plate, error)
      call check(allocated(error), "a negative mass is refused")
      call new_impact(impact, 1.0_wp, 0.03_wp, 0.0_wp, 0.0_wp, modulus, plate, error)
      call check(allocated(error), "no radius is refused")
   end subroutine test_radius

   !> Time scale and Zener's parameter
   subroutine test_time_scale()
      type(impact_t) :: impact
      type(prony_t) :: rubber
      type(error_t), allocatable :: error
      real(wp) :: scale, firmness, mass, whole(1)

      call new_elastic(rubber, 15.0e6_wp, error)
      call rubber%set_constants(error, density=1100.0_wp)
      call rigid_on_plate(rubber, waves_relaxing, 10.0_wp, impact)
      mass = 4.0_wp/3.0_wp*pi*1.0e-6_wp*7800.0_wp
      firmness = 4.0_wp/3.0_wp*0.1_wp*15.0e6_wp/0.75_wp
      scale = (mass/(firmness*sqrt(10.0_wp)))**0.4_wp
      call check_relative(impact%time_scale(), scale, rounding, "T of an elastic contact")
      call check_relative(impact%inelasticity(), mass/scale &
         *sqrt(3.0_wp*1100.0_wp*0.75_wp/15.0e6_wp)/(16.0_wp*1100.0_wp*0.02_wp**2), &
         rounding, "Zener's lambda = alpha(0) m/T")
      call check_close(impact%inelasticity(), 0.138_wp, 1.0e-4_wp, "the paper's is 0.1380")
      call check(impact%lasting_time(impact%time_scale()) > 100.0_wp*scale, "a contact may last")

      call rigid_on_plate(power_law, waves_relaxing, 10.0_wp, impact)
      scale = impact%time_scale()
      whole = impact%kernel_step_integrals(scale, 1)
      call check_relative(scale, (mass*scale/(whole(1)*sqrt(10.0_wp)))**0.4_wp, scale_tolerance, &
         "T with the mean kernel over T")
      call check(ieee_is_nan(impact%inelasticity()), "a singular kernel has no lambda")
   end subroutine test_time_scale

   !> The bound of the indentation is met by an elastic body without weight, and at rest by its
   !> weight alone with a factor of 2^(1/n) for what energy and weight have in common
   subroutine test_deepest()
      real(wp), parameter :: mass = 0.05_wp, radius = 0.01_wp, velocity = 2.0_wp, g = 9.81_wp
      type(impact_t) :: impact
      type(contact_modulus_t) :: modulus
      type(target_t) :: plate
      type(error_t), allocatable :: error
      real(wp) :: k

      call new_plate(plate, glass, 0.0_wp, waves_none, error)
      call new_contact_modulus(modulus, rigid, glass, .false., error)
      call new_impact(impact, velocity, mass, radius, 0.0_wp, modulus, plate, error)
      call success(error, "an elastic impact is built")
      k = 4.0_wp/3.0_wp*sqrt(radius)*modulus%rubbery()
      call check_relative(impact%deepest(), (1.25_wp*mass*velocity**2/k)**0.4_wp, rounding, &
         "the energy is that of the spring")
      call impact%launch(1.0e-9_wp, mass, impact%factor, error, g)
      call check_relative(impact%deepest(), 2.0_wp**(2.0_wp/3.0_wp)*(2.5_wp*mass*g/k) &
         **(2.0_wp/3.0_wp), rounding, "the weight's work is at most twice")
      ! of a power law without an equilibrium modulus nothing is known
      call new_contact_modulus(modulus, rigid, fluid(), .false., error)
      call new_impact(impact, velocity, mass, radius, 0.0_wp, modulus, plate, error)
      call check(.not. impact%deepest() < huge(1.0_wp), "a fluid has no bound")
   end subroutine test_deepest

   !> Power law without an equilibrium modulus
   function fluid()
      type(power_law_t) :: fluid
      type(error_t), allocatable :: error

      call new_power_law(fluid, 0.0_wp, 7.0e5_wp, 0.5_wp, error)
      call success(error, "a fluid is built")
   end function fluid

   !> Samples of a trajectory at equal steps
   subroutine test_sample()
      integer, parameter :: count = 200
      ! interpolated between stages: two orders worse than at the nodes of an accuracy of 1e-8
      real(wp), parameter :: interpolation = 1.0e-5_wp
      type(impact_t) :: impact
      type(ive_t) :: ive
      type(product_t) :: product
      type(trajectory_t) :: coarse, fine, series
      type(error_t), allocatable :: error
      real(wp), allocatable :: sample(:, :), exact(:, :)
      real(wp) :: largest, time
      integer :: i, j

      call rigid_on_plate(sls, waves_relaxing, 10.0_wp, impact)
      call make_ive(1.0e-8_wp, ive)
      call ive%solve(impact, coarse, error)
      call coarse%sample(count, sample)
      call check(lbound(sample, 2) == 0 .and. ubound(sample, 2) == count .and. &
         size(sample, 1) == columns, "as many samples as wanted")
      time = coarse%state(col_time, coarse%last)
      do i = 0, count
         call check_close(sample(col_time, i)/time, real(i, wp)/real(count, wp), rounding, &
            "at equal steps of time")
      end do
      call check_close(sample(:, 0) - coarse%state(:, 0), 0.0_wp, 0.0_wp, "from the first node")
      call check_close(sample(:, count) - coarse%state(:, coarse%last), 0.0_wp, 0.0_wp, &
         "to the last node")
      call make_ive(1.0e-10_wp, ive)
      call ive%solve(impact, fine, error)
      call fine%sample(count, exact)
      do j = 2, columns
         largest = maxval(abs(exact(j, :)))
         call check_close(maxval(abs(sample(j, :) - exact(j, :)))/largest, 0.0_wp, interpolation, &
            "the samples of two accuracies agree")
      end do

      call make_product(1.0e-5_wp, 1.0e-6_wp, product)
      call product%solve(impact, series, error)
      deallocate (sample)
      call series%sample(count, sample)
      call check(ubound(sample, 2) == series%last, "the nodes of a time series are its samples")
      call check_close(maxval(abs(sample - series%state(:, 0:series%last))), 0.0_wp, 0.0_wp, &
         "without any change")
   end subroutine test_sample

   !> What moves is not stuck, whatever its force; what stands still is, if nothing pushes it: a
   !> fluid in any case, a solid if the plate moved with the sphere and there is no indentation
   subroutine test_stuck()
      real(wp), parameter :: mass = 2.0_wp, indentation = 0.1_wp
      type(trajectory_t) :: trajectory
      type(impact_t) :: fluid, solid

      call build_fluid(0.0_wp, mass, fluid)
      call build_fluid(1.0e-3_wp, mass, solid)
      call check(.not. fluid%pushes_apart(), "a fluid has no spring")
      call check(solid%pushes_apart(), "a soft spring is one")
      call build_fluid(1.0e-20_wp, mass, solid)
      call check(.not. solid%pushes_apart(), "unless rounding hides it")
      call build_fluid(1.0e-3_wp, mass, solid)

      call trajectory%reserve(1)
      trajectory%state = 0.0_wp
      trajectory%last = 1
      trajectory%state(col_velocity, 0) = 1.0_wp
      trajectory%state(col_indentation, 1) = indentation
      trajectory%state(col_sphere, 1) = indentation
      call check(trajectory%is_stuck(fluid), "at rest without force")
      call check(.not. trajectory%is_stuck(solid), "a spring will push")
      trajectory%state(col_force, 1) = -1.0e-12_wp
      call check(trajectory%is_stuck(fluid), "rounding of a force pushes nothing")
      trajectory%state(col_force, 1) = 1.0_wp
      call check(.not. trajectory%is_stuck(fluid), "a force pushes")
      trajectory%state(col_force, 1) = -10.0_wp
      trajectory%state(col_velocity, 1) = -0.3_wp
      call check(.not. trajectory%is_stuck(fluid), "a tensile force does not count as less motion")
      trajectory%state(:, 1) = 0.0_wp
      trajectory%state(col_sphere, 1) = indentation
      call check(trajectory%is_stuck(solid), "in a plate that goes with the sphere")
   end subroutine test_stuck

   !> A sphere on a Maxwell fluid parallel to a spring
   subroutine build_fluid(equilibrium, mass, impact)
      real(wp), intent(in) :: equilibrium
      real(wp), intent(in) :: mass
      type(impact_t), intent(out) :: impact

      type(prony_t) :: material
      type(error_t), allocatable :: error

      call new_prony(material, equilibrium, [1.0e6_wp], [1.0e4_wp], 0.0_wp, error)
      call success(error, "a fluid")
      call rigid_on_plate(material, waves_none, 1.0_wp, impact, mass=mass)
   end subroutine build_fluid

   !> A trajectory made by hand: F = F0 sin(pi t/t0), so that all integrals are known
   subroutine test_outcome()
      integer, parameter :: nodes = 4
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      type(outcome_t) :: outcome
      complex(wp) :: modulus
      integer :: i

      call rigid_on_plate(sls, waves_relaxing, 2.0_wp, impact, mass=0.1_wp)
      call trajectory%reserve(nodes)
      trajectory%state = 0.0_wp
      trajectory%last = nodes
      trajectory%steps = 7
      do i = 0, nodes
         trajectory%state(col_time, i) = 3.0e-4_wp*real(i, wp)
         trajectory%state(col_force, i) = real(i*(nodes - i), wp)
         trajectory%state(col_velocity, i) = 2.0_wp - 0.75_wp*real(i, wp)
         trajectory%state(col_plate_velocity, i) = 0.125_wp*real(i, wp)
         trajectory%state(col_sphere_velocity, i) = 2.0_wp - 0.625_wp*real(i, wp)
      end do
      trajectory%share = [1.0_wp, 4.0_wp, 2.0_wp, 4.0_wp, 1.0_wp]*1.0e-4_wp &
         *trajectory%state(col_force, :)
      trajectory%state(col_impulse, nodes) = 0.25_wp
      trajectory%state(col_indentation, nodes) = 1.0e-4_wp
      trajectory%max_indentation = 8.0e-4_wp
      trajectory%time_of_max_indentation = 5.0e-4_wp
      trajectory%max_force = 4.0_wp
      trajectory%time_of_max_force = 6.0e-4_wp
      trajectory%cor_error = 1.0e-9_wp
      trajectory%cor_sphere_error = 2.0e-9_wp

      trajectory%status = contact_lasting
      outcome = evaluate(impact, trajectory)
      call check(outcome%status == contact_lasting, "a lasting contact is passed on")
      call check(outcome%steps == 7, "the number of steps is passed on")
      call check_relative(outcome%initial_energy, 0.2_wp, rounding, "initial energy")

      trajectory%status = contact_separated
      outcome = evaluate(impact, trajectory)
      call check(outcome%status == contact_separated, "the separation is passed on")
      call check_relative(outcome%cor, 0.5_wp, rounding, "cor = -s'/v0")
      call check_relative(outcome%cor_sphere, 0.25_wp, rounding, "cor_sphere = I/(m v0) - 1")
      call check_relative(outcome%contact_time, 1.2e-3_wp, rounding, "contact time")
      call check_relative(outcome%max_indentation, 8.0e-4_wp, rounding, "largest indentation")
      call check_relative(outcome%time_of_max_indentation, 5.0e-4_wp, rounding, "and its time")
      call check_relative(outcome%max_force, 4.0_wp, rounding, "largest force")
      call check_relative(outcome%time_of_max_force, 6.0e-4_wp, rounding, "and its time")
      call check_relative(outcome%residual_indentation, 1.0e-4_wp, rounding, "residual indentation")
      call check_relative(outcome%residual_ratio, 0.125_wp, rounding, "and its ratio")
      ! sums by hand: F s' = 3*1.25 + 4*0.5 - 3*0.25 with weights 4, 2, 4; F U' = 3/8, 1, 9/8
      call check_relative(outcome%hysteresis_energy, 16.0e-4_wp, rounding, "W_h = int F ds")
      call check_relative(outcome%wave_energy, 8.0e-4_wp, rounding, "W_wave = int F dU")
      call check_relative(outcome%final_energy, 0.0125_wp, rounding, "m z'^2/2")
      call check_relative(outcome%energy_imbalance, 0.1875_wp - 24.0e-4_wp, rounding, &
         "what the budget misses")
      call check_relative(outcome%min_frequency, 2.0_wp*pi/1.2e-3_wp, rounding, "2 pi/t0")
      call check_relative(outcome%inelasticity, impact%inelasticity(), 0.0_wp, "Zener's lambda")
      modulus = sls%complex_modulus(cmplx(0.0_wp, outcome%min_frequency, wp))
      call check_relative(outcome%loss_tangent, aimag(modulus)/real(modulus, wp), rounding, &
         "loss tangent at 2 pi/t0")
      call check_close([outcome%cor_error, outcome%cor_sphere_error], [1.0e-9_wp, 2.0e-9_wp], &
         0.0_wp, "the estimates of the errors")
   end subroutine test_outcome

end program test_impact
