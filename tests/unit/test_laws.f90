!> Laws of impact that need no reference solution
program test_laws
   use vcor_error, only : error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_target, only : new_plate, target_t, waves_constant, waves_none, waves_relaxing
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_impact_trajectory, only : contact_separated
   use vcor_kinds, only : wp
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_mittag_leffler, only : mittag_leffler_t, new_mittag_leffler
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_rigid, new_sls, prony_t
   use vcor_solver_ive, only : ive_t
   use vcor_solver_direct_product, only : product_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : body_on_body, make_ive, make_product, random_t, rigid_on_plate, &
      run, success
   implicit none

   !> What ive is asked for
   real(wp), parameter :: ive_accuracy = 1.0e-8_wp
   !> What product integration is asked for
   real(wp), parameter :: direct_accuracy = 1.0e-6_wp
   !> Two impacts that differ by a scale are solved on panels that differ by the same scale, but for
   !> rounding and the tolerance of 1e-3 of the time scale
   real(wp), parameter :: scaling_tolerance = 2.0e-8_wp
   !> Energy that may be missing, over the initial energy, at the accuracy 1e-8
   real(wp), parameter :: imbalance_tolerance = 1.0e-8_wp
   !> Two columns of one trajectory
   real(wp), parameter :: rounding = 1.0e-12_wp

   !> Work of a dashpot along Hertz's impact, (4/5) (5/4)^(3/5) B(3/5, 3/2) = 1.1534488580952888
   real(wp), parameter :: c = 0.8_wp*1.25_wp**0.6_wp*gamma(0.6_wp)*gamma(1.5_wp)/gamma(2.1_wp)
   !> Restitution of a Kelvin-Voigt contact in powers of sqrt(b), docs/numerics.md
   real(wp), parameter :: series(0:10) = [1.0_wp, 0.0_wp, -c, 0.0_wp, 0.6_wp*c**2, &
      4.0_wp/15.0_wp, -0.5228825680884149639_wp, -0.4_wp*c, 0.34874267526038503473_wp, &
      1.275_wp*c**2*4.0_wp/15.0_wp, -0.23309813201924440033_wp + 13.0_wp/150.0_wp]

   type(ive_t) :: ive
   type(product_t) :: direct

   call suite("laws")
   call make_ive(ive_accuracy, ive)
   call make_product(0.0_wp, direct_accuracy, direct)
   call test_zener()
   call test_hertz()
   call test_power_law()
   call test_weak_maxwell()
   call test_maxwell_slope()
   call test_kelvin_voigt()
   call test_order_of_the_series()
   call test_kelvin_voigt_and_zener()
   call test_mittag_leffler()
   call test_scaling()
   call test_limits()
   call test_two_restitutions()
   call test_rigid_plate()
   call test_random()
   call finish()

contains

   !> Zener's table: restitution against inelasticity of an elastic impact on a plate
   subroutine test_zener()
      real(wp), parameter :: lambda(3) = [0.05_wp, 0.2_wp, 1.0_wp]
      real(wp), parameter :: table(3) = [0.91777150179008_wp, 0.71404487999215_wp, &
         0.18412287416505_wp]
      type(prony_t) :: material, rigid
      type(contact_modulus_t) :: modulus
      type(target_t) :: plate
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp) :: half
      integer :: i, waves

      call new_elastic(material, 15.0e6_wp, error)
      call material%set_constants(error, density=1100.0_wp)
      call new_rigid(rigid)
      call new_contact_modulus(modulus, rigid, material, .false., error)
      do i = 1, size(lambda)
         ! lambda falls with the square of the thickness
         call new_plate(plate, material, 0.02_wp, waves_constant, error)
         call new_impact(impact, 10.0_wp, 0.03_wp, 0.01_wp, 0.0_wp, modulus, plate, error)
         half = 0.02_wp*sqrt(impact%inelasticity()/lambda(i))
         do waves = waves_constant, waves_relaxing
            call new_plate(plate, material, half, waves, error)
            call new_impact(impact, 10.0_wp, 0.03_wp, 0.01_wp, 0.0_wp, modulus, plate, error)
            call success(error, "an elastic impact is built")
            call check_relative(impact%inelasticity(), lambda(i), rounding, "lambda is as wanted")
            call run(ive, impact, outcome)
            call check_close(outcome%cor, table(i), ive_accuracy, "ive: Zener's table")
            call check_close(outcome%residual_ratio, 0.0_wp, ive_accuracy, &
               "ive: an elastic body keeps no indentation")
            call run(direct, impact, outcome)
            call check_close(outcome%cor, table(i), direct_accuracy, "direct: Zener's table")
         end do
      end do
   end subroutine test_zener

   !> Hertz's elastic impact: nothing is lost, and its duration is known
   subroutine test_hertz()
      ! (4/5) sqrt(pi) Gamma(2/5)/Gamma(9/10) (5/4)^(2/5)
      real(wp), parameter :: duration = 3.2180654597190435_wp
      type(prony_t) :: material
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      type(random_t) :: random
      ! what the branch point of u = s^1.5 at the end may cost, over the accuracy
      real(wp), parameter :: end_share = 0.2_wp
      ! of an estimate of the error
      real(wp), parameter :: largest_ratio = 3.0_wp
      type(ive_t) :: other
      real(wp) :: mass, velocity, radius, scale, deepest
      integer :: i

      do i = 1, 10
         call new_elastic(material, random%log_between(1.0e4_wp, 1.0e12_wp), error)
         mass = random%log_between(1.0e-9_wp, 1.0e3_wp)
         velocity = random%log_between(1.0e-4_wp, 1.0e3_wp)
         radius = random%log_between(1.0e-5_wp, 1.0_wp)
         call rigid_on_plate(material, waves_none, velocity, impact, mass, radius)
         scale = (mass/(4.0_wp/3.0_wp*sqrt(radius)*material%glassy()/0.75_wp &
            *sqrt(velocity)))**0.4_wp
         call run(ive, impact, outcome)
         call check_close(outcome%cor, 1.0_wp, end_share*ive_accuracy, "Hertz: nothing is lost")
         call check(abs(outcome%hysteresis_energy) <= end_share*ive_accuracy &
            *outcome%initial_energy, "Hertz: no hysteresis")
         call check_relative(outcome%contact_time, duration*scale, ive_accuracy, &
            "Hertz: contact time 3.218 T")
         ! m v^2/2 = (2/5) k s^2.5
         deepest = 1.25_wp**0.4_wp*velocity*scale
         call check_relative(outcome%max_indentation, deepest, 10.0_wp*ive_accuracy, &
            "Hertz: largest indentation")
         call check_relative(outcome%max_force, mass*velocity/scale*1.25_wp**0.6_wp, &
            10.0_wp*ive_accuracy, "Hertz: largest force")
      end do
      do i = 2, 10
         call make_ive(10.0_wp**(-i), other)
         call run(other, impact, outcome)
         call check_close(outcome%cor, 1.0_wp, min(10.0_wp**(-i), &
            largest_ratio*outcome%cor_error), "Hertz: the error is what it says")
      end do
   end subroutine test_hertz

   !> Without a plate the restitution of a pure power law depends on its exponent alone
   subroutine test_power_law()
      real(wp), parameter :: exponent(3) = [0.25_wp, 0.5_wp, 0.75_wp]
      real(wp), parameter :: law(3) = [0.57164767998043_wp, 0.28565312277610_wp, 0.097580216965_wp]
      type(power_law_t) :: material
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      type(random_t) :: random
      integer :: i, j

      do i = 1, size(exponent)
         do j = 1, 3
            call new_power_law(material, 0.0_wp, random%log_between(1.0e4_wp, 1.0e8_wp), &
               exponent(i), error)
            call rigid_on_plate(material, waves_none, random%log_between(0.01_wp, 100.0_wp), &
               impact, random%log_between(1.0e-6_wp, 1.0_wp), random%log_between(1.0e-4_wp, 0.1_wp))
            call run(direct, impact, outcome)
            call check_close(outcome%cor, law(i), direct_accuracy, &
               "the restitution of a power law depends on its exponent alone")
         end do
      end do
   end subroutine test_power_law

   !> Maxwell fluid that relaxes little during the contact: cor = 1 - (5/9) t_c/tau
   subroutine test_weak_maxwell()
      type(prony_t) :: material
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp) :: ratio(2), small(2)
      integer :: i

      do i = 1, 2
         ! tau = 10 s and 100 s, contact of a millisecond
         call new_sls(material, 15.0e6_wp, 0.0_wp, 10.0_wp**(-i), error)
         call rigid_on_plate(material, waves_none, 10.0_wp, impact)
         call make_ive(1.0e-10_wp, ive)
         call run(ive, impact, outcome)
         small(i) = outcome%contact_time*10.0_wp**(-i)
         ratio(i) = (1.0_wp - outcome%cor)/small(i)
      end do
      call make_ive(ive_accuracy, ive)
      ! the next term is of relative order (t_c/tau)^(2/3), 0.3 of it: 8e-4 and 2e-4 are left out
      call check_close(ratio, 5.0_wp/9.0_wp, 0.5_wp*small**(2.0_wp/3.0_wp), &
         "weak Maxwell fluid: 1 - (5/9) t_c/tau")
      call check(abs(ratio(2) - 5.0_wp/9.0_wp) < abs(ratio(1) - 5.0_wp/9.0_wp), &
         "the weaker, the closer")
   end subroutine test_weak_maxwell

   !> The next term of a weak Maxwell fluid, with t_c the contact time of Hertz, epsilon = t_c/tau
   !>
   !>     (1 - e)/epsilon = 5/9 - (3/5) (2/3.218)^(5/3) epsilon^(2/3) + O(epsilon)
   !>
   !> (docs/numerics.md). Three values of epsilon, each an eighth of the one before, give the
   !> coefficient without the next two powers, epsilon^(1/3) and epsilon^(2/3)
   subroutine test_maxwell_slope()
      real(wp), parameter :: epsilon(3) = 1.0e-2_wp*[1.0_wp, 1.0_wp/8.0_wp, 1.0_wp/64.0_wp]
      real(wp), parameter :: duration = 3.2180654597190435_wp
      type(prony_t) :: material
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp) :: ratio(3), first(2)
      integer :: i

      call make_ive(1.0e-11_wp, ive)
      do i = 1, 3
         call new_elastic(material, 15.0e6_wp, error)
         call rigid_on_plate(material, waves_none, 10.0_wp, impact)
         call new_sls(material, 15.0e6_wp, 0.0_wp, epsilon(i)/(duration*impact%time_scale()), error)
         call rigid_on_plate(material, waves_none, 10.0_wp, impact)
         call run(ive, impact, outcome)
         ratio(i) = ((1.0_wp - outcome%cor)/epsilon(i) - 5.0_wp/9.0_wp)/epsilon(i)**(2.0_wp/3.0_wp)
      end do
      call make_ive(ive_accuracy, ive)
      first = 2.0_wp*ratio(2:3) - ratio(1:2)
      ! the power 1 that is left
      call check_close((4.0_wp*first(2) - first(1))/3.0_wp, &
         -0.6_wp*(2.0_wp/duration)**(5.0_wp/3.0_wp), epsilon(2), "weak Maxwell fluid: next term")
   end subroutine test_maxwell_slope

   !> A spring and a dashpot side by side, F = k (u + A u'), on a half space: the restitution
   !> depends on b = (3/2) A/T alone (T. Schwager, T. Poeschel, Phys. Rev. E 78 (2008) 051304). With
   !> solutions in 50 digits (tests/reference/make_kelvin_voigt.py), the series for weak
   !> dashpots, and the Pade approximant of P. Mueller and T. Poeschel (Phys. Rev. E 84
   !> (2011) 021302), whose own errors are known
   subroutine test_kelvin_voigt()
      real(wp), parameter :: b(3) = [0.1_wp, 1.0_wp, 10.0_wp]
      real(wp), parameter :: cor(3) = [0.89285887550655333376_wp, 0.39393060322987319305_wp, &
         0.02509570443151839241_wp]
      real(wp), parameter :: weak(3) = [0.016_wp, 0.04_wp, 0.1_wp]
      real(wp), parameter :: rounded(4) = [0.1_wp, 0.25_wp, 1.0_wp, 4.0_wp]
      real(wp), parameter :: own_error(4) = [4.8e-5_wp, 4.5e-4_wp, 4.8e-3_wp, 8.4e-3_wp]
      real(wp), parameter :: a = 2.0_wp/(3.0_wp*c**2)
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      integer :: i

      do i = 1, size(b)
         call damp(b(i), impact)
         call run(ive, impact, outcome)
         call check_close(outcome%cor, cor(i), ive_accuracy, "ive: Kelvin-Voigt contact")
         call run(direct, impact, outcome)
         call check_close(outcome%cor, cor(i), direct_accuracy, "direct: Kelvin-Voigt contact")
      end do
      do i = 1, size(weak)
         call damp(weak(i), impact)
         call run(ive, impact, outcome)
         call check_close(outcome%cor, polynomial(series, sqrt(weak(i))), &
            ive_accuracy + weak(i)**5.5_wp, "weak dashpot: series in v0^(1/10)")
      end do
      do i = 1, size(rounded)
         call damp(rounded(i), impact)
         call run(ive, impact, outcome)
         associate (x => sqrt(rounded(i)))
            call check_close(outcome%cor, (1.0_wp + a*x) &
               /(1.0_wp + x*(a + x*(c + x*(a*c + x*0.4_wp*c**2)))), own_error(i), &
               "Pade approximant")
         end associate
      end do
   end subroutine test_kelvin_voigt

   !> What the series leaves after b^(7/2) falls as b^4, but for the effect of the next two terms
   subroutine test_order_of_the_series()
      real(wp), parameter :: b(2) = [0.02_wp, 0.01_wp]
      real(wp), parameter :: bend(2) = [series(9), series(10)]/series(8)
      ! the term of relative order b^1.5, and the accuracy over the remainder
      real(wp), parameter :: tolerance = 1.2e-2_wp
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      real(wp) :: rest(2), order
      integer :: i

      call make_ive(1.0e-11_wp, ive)
      do i = 1, 2
         call damp(b(i), impact)
         call run(ive, impact, outcome)
         rest(i) = outcome%cor - polynomial(series(0:7), sqrt(b(i)))
      end do
      call make_ive(ive_accuracy, ive)
      order = 4.0_wp + log((1.0_wp + bend(1)*sqrt(b(1)) + bend(2)*b(1)) &
         /(1.0_wp + bend(1)*sqrt(b(2)) + bend(2)*b(2)))/log(2.0_wp)
      call check_close(log(rest(1)/rest(2))/log(2.0_wp), order, tolerance, &
         "the order of what the series leaves")
   end subroutine test_order_of_the_series

   !> A Kelvin-Voigt contact with A = lambda T and Zener's plate obey the same equation of motion,
   !> one until F = 0 and the other until s = 0: their restitutions differ by the factor Y(p),
   !> p = b^(5/2) sqrt(e), of docs/numerics.md
   subroutine test_kelvin_voigt_and_zener()
      real(wp), parameter :: lambda(3) = [0.05_wp, 0.2_wp, 0.3_wp]
      real(wp), parameter :: ends(0:6) = [1.0_wp, 4.0_wp/15.0_wp, 13.0_wp/150.0_wp, &
         4897.0_wp/160875.0_wp, 453263.0_wp/40540500.0_wp, 4.23002985517994e-3_wp, &
         1.63464708309717e-3_wp]
      type(prony_t) :: material, rigid
      type(contact_modulus_t) :: modulus
      type(target_t) :: plate
      type(impact_t) :: impact
      type(outcome_t) :: outcome, zener
      type(error_t), allocatable :: error
      real(wp) :: p
      integer :: i

      call new_elastic(material, 15.0e6_wp, error)
      call material%set_constants(error, density=1100.0_wp)
      call new_rigid(rigid)
      call new_contact_modulus(modulus, rigid, material, .false., error)
      do i = 1, size(lambda)
         call new_plate(plate, material, 0.02_wp, waves_constant, error)
         call new_impact(impact, 10.0_wp, 0.03_wp, 0.01_wp, 0.0_wp, modulus, plate, error)
         call new_plate(plate, material, 0.02_wp*sqrt(impact%inelasticity()/lambda(i)), &
            waves_constant, error)
         call new_impact(impact, 10.0_wp, 0.03_wp, 0.01_wp, 0.0_wp, modulus, plate, error)
         call success(error, "an elastic impact is built")
         call run(ive, impact, zener)
         call damp(1.5_wp*lambda(i), impact)
         call run(ive, impact, outcome)
         p = (1.5_wp*lambda(i))**2.5_wp*sqrt(zener%cor)
         ! what Y leaves out is below the last coefficient times p^7/(1 - p)
         call check_close(outcome%cor, zener%cor*polynomial(ends, p), &
            2.0_wp*ive_accuracy + ends(6)*p**7/(1.0_wp - p), &
            "Kelvin-Voigt contact from Zener's plate")
      end do
   end subroutine test_kelvin_voigt_and_zener

   !> With exponent 1/2 the Mittag-Leffler function is CERF's exp(b^2 t) erfc(b sqrt(t)), with
   !> exponent 1 it is exp(-t/tau), the standard linear solid. The models of each pair have
   !> different code. An exponent next to 1 changes cor by less than its distance from 1
   subroutine test_mittag_leffler()
      real(wp), parameter :: beta = 700.0_wp, next_to_one = 1.0_wp - 1.0e-12_wp
      type(mittag_leffler_t) :: material
      type(cerf_t) :: cerf
      type(prony_t) :: sls
      type(impact_t) :: impact
      type(outcome_t) :: outcome, other
      type(error_t), allocatable :: error

      call new_mittag_leffler(material, 0.442e6_wp, 676.5e6_wp, 0.5_wp, 1.0_wp/beta**2, error)
      call rigid_on_plate(material, waves_relaxing, 10.0_wp, impact)
      call run(ive, impact, outcome)
      call new_cerf(cerf, 0.442e6_wp, 676.5e6_wp, beta, error)
      call rigid_on_plate(cerf, waves_relaxing, 10.0_wp, impact)
      call run(ive, impact, other)
      call check_close(outcome%cor, other%cor, 2.0_wp*ive_accuracy, "exponent 1/2: CERF")
      call new_mittag_leffler(material, 3.75e6_wp, 11.25e6_wp, next_to_one, 1.0_wp/1200.0_wp, error)
      call rigid_on_plate(material, waves_relaxing, 10.0_wp, impact)
      call run(ive, impact, outcome)
      call new_sls(sls, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      call rigid_on_plate(sls, waves_relaxing, 10.0_wp, impact)
      call run(ive, impact, other)
      call check_close(outcome%cor, other%cor, 2.0_wp*ive_accuracy, "exponent next to 1: SLS")
   end subroutine test_mittag_leffler

   !> A Kelvin-Voigt impact of given damping
   subroutine damp(b, impact)
      !> Damping b = (3/2) A/T [-]
      real(wp), intent(in) :: b
      type(impact_t), intent(out) :: impact

      real(wp), parameter :: modulus = 15.0e6_wp
      type(prony_t) :: material
      type(error_t), allocatable :: error
      real(wp) :: none(0)

      call new_elastic(material, modulus, error)
      call rigid_on_plate(material, waves_none, 10.0_wp, impact)
      call new_prony(material, modulus, none, none, b/1.5_wp*impact%time_scale()*modulus, error)
      call rigid_on_plate(material, waves_none, 10.0_wp, impact)
   end subroutine damp

   !> A polynomial
   pure function polynomial(coefficients, x) result(value)
      !> Coefficients, shape (0:n)
      real(wp), intent(in) :: coefficients(0:)
      real(wp), intent(in) :: x
      real(wp) :: value

      integer :: i

      value = 0.0_wp
      do i = ubound(coefficients, 1), 0, -1
         value = value*x + coefficients(i)
      end do
   end function polynomial

   !> Without a plate mass, radius and velocity matter through T alone
   subroutine test_scaling()
      type(prony_t) :: material
      type(impact_t) :: impact
      type(outcome_t) :: one, other
      type(error_t), allocatable :: error
      type(random_t) :: random
      real(wp) :: mass, velocity, radius
      integer :: i

      call new_prony(material, 1.0e6_wp, [2.0e6_wp, 5.0e6_wp], [300.0_wp, 4000.0_wp], 0.0_wp, error)
      call rigid_on_plate(material, waves_none, 4.0_wp, impact, 0.02_wp, 0.01_wp)
      call run(ive, impact, one)
      do i = 1, 10
         velocity = random%log_between(0.01_wp, 100.0_wp)
         radius = random%log_between(1.0e-3_wp, 0.1_wp)
         mass = 0.02_wp*sqrt(velocity/4.0_wp)*sqrt(radius/0.01_wp)
         call rigid_on_plate(material, waves_none, velocity, impact, mass, radius)
         call run(ive, impact, other)
         call check_close(other%cor, one%cor, scaling_tolerance, "the same T, the same restitution")
         call check_relative(other%contact_time, one%contact_time, scaling_tolerance, &
            "the same T, the same contact time")
      end do
      call rigid_on_plate(material, waves_none, 8.0_wp, impact, 0.02_wp, 0.01_wp)
      call run(ive, impact, other)
      call check(abs(other%cor - one%cor) > 1.0e-3_wp, "another T, another restitution")
   end subroutine test_scaling

   !> An SLS that relaxes never, or at once, is elastic
   subroutine test_limits()
      real(wp), parameter :: slow(2) = [1.0e-2_wp, 1.0e-4_wp], fast(2) = [1.0e6_wp, 1.0e8_wp]
      ! loss tangents: beta t0 before, (beta t0)^-1/2 of the indentation after
      real(wp), parameter :: slow_tolerance(2) = [1.0e-5_wp, 1.2e-7_wp]
      real(wp), parameter :: fast_tolerance(2) = [1.0e-2_wp, 1.0e-4_wp]
      type(prony_t) :: material
      type(impact_t) :: impact
      type(outcome_t) :: elastic, outcome
      type(error_t), allocatable :: error
      integer :: i

      call new_elastic(material, 15.0e6_wp, error)
      call rigid_on_plate(material, waves_relaxing, 10.0_wp, impact)
      call run(ive, impact, elastic)
      do i = 1, 2
         call new_sls(material, 15.0e6_wp, 0.25_wp*slow(i), slow(i), error)
         call rigid_on_plate(material, waves_relaxing, 10.0_wp, impact)
         call run(ive, impact, outcome)
         call check_close(outcome%cor, elastic%cor, slow_tolerance(i), &
            "beta -> 0: elastic with the glassy modulus")
      end do
      call new_elastic(material, 3.75e6_wp, error)
      call rigid_on_plate(material, waves_relaxing, 10.0_wp, impact)
      call run(ive, impact, elastic)
      do i = 1, 2
         call new_sls(material, 15.0e6_wp, 0.25_wp*fast(i), fast(i), error)
         call rigid_on_plate(material, waves_relaxing, 10.0_wp, impact)
         call run(ive, impact, outcome)
         call check_close(outcome%cor, elastic%cor, fast_tolerance(i), &
            "beta -> infinity: elastic with the rubbery modulus")
      end do
   end subroutine test_limits

   !> The two coefficients of restitution differ where alpha changes, and only there
   subroutine test_two_restitutions()
      type(prony_t) :: material
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      integer :: waves

      call new_sls(material, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      do waves = waves_none, waves_relaxing
         call rigid_on_plate(material, waves, 10.0_wp, impact)
         call run(ive, impact, outcome)
         if (waves == waves_relaxing) then
            call check(outcome%cor - outcome%cor_sphere > 0.01_wp, &
               "with a relaxing plate sphere and indentation differ")
         else
            call check_close(outcome%cor_sphere, outcome%cor, ive_accuracy, &
               "with a constant alpha, or none, both restitutions are one")
         end if
         if (waves == waves_none) call check_close(outcome%wave_energy, 0.0_wp, 0.0_wp, &
            "a plate that does not move takes no energy")
         call run(direct, impact, outcome)
         if (waves /= waves_relaxing) call check_close(outcome%cor_sphere, outcome%cor, &
            direct_accuracy, "direct: with a constant alpha, or none, both are one")
      end do
   end subroutine test_two_restitutions

   !> A rigid plate has no waves
   subroutine test_rigid_plate()
      type(prony_t) :: soft, hard
      type(impact_t) :: impact
      type(outcome_t) :: still, moving
      type(error_t), allocatable :: error

      call new_sls(soft, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      call new_rigid(hard)
      call body_on_body(soft, hard, waves_none, 10.0_wp, impact)
      call run(ive, impact, still)
      call body_on_body(soft, hard, waves_relaxing, 10.0_wp, impact)
      call run(ive, impact, moving)
      call check_close(moving%cor, still%cor, 0.0_wp, "a rigid plate does not move")
      call check_close(moving%wave_energy, 0.0_wp, 0.0_wp, "a rigid plate takes no energy")
      call check(still%cor < 1.0_wp, "but the sphere loses some")
   end subroutine test_rigid_plate

   !> Energy balance and agreement of both methods on random materials and geometries
   subroutine test_random()
      integer, parameter :: trials = 100, most_terms = 4
      ! both on the safe side of their own estimates
      real(wp), parameter :: agreement = 2.0_wp*direct_accuracy
      type(random_t) :: random
      type(prony_t) :: material
      type(impact_t) :: impact
      type(outcome_t) :: outcome, other
      type(error_t), allocatable :: error
      real(wp) :: moduli(most_terms), rates(most_terms), equilibrium
      integer :: i, j, n, waves

      do i = 1, trials
         n = random%among(1, most_terms)
         equilibrium = random%log_between(1.0e6_wp, 1.0e8_wp)
         do j = 1, n
            moduli(j) = random%log_between(1.0e5_wp, 1.0e8_wp)
            rates(j) = random%log_between(1.0_wp, 1.0e5_wp)
         end do
         waves = random%among(waves_none, waves_relaxing)
         call new_prony(material, equilibrium, moduli(:n), rates(:n), 0.0_wp, error)
         call material%set_constants(error, density=random%log_between(500.0_wp, 8000.0_wp))
         call rigid_on_plate(material, waves, random%log_between(0.1_wp, 50.0_wp), impact, &
            mass=random%log_between(1.0e-3_wp, 0.1_wp), &
            radius=random%log_between(0.002_wp, 0.05_wp))
         call run(ive, impact, outcome)
         call check(outcome%status == contact_separated, "a random impact ends")
         call check(outcome%cor > 0.0_wp .and. outcome%cor <= 1.0_wp + ive_accuracy, &
            "a random restitution is between 0 and 1")
         call check(outcome%cor_sphere <= outcome%cor + ive_accuracy, &
            "the sphere's own restitution is the smaller one")
         call check(outcome%hysteresis_energy >= 0.0_wp .and. &
            outcome%wave_energy >= 0.0_wp, "energy is lost, not won")
         call check_close(outcome%energy_imbalance/outcome%initial_energy, 0.0_wp, &
            imbalance_tolerance, "energy is conserved")
         call check_close(outcome%initial_energy - outcome%final_energy &
            - outcome%hysteresis_energy - outcome%wave_energy, outcome%energy_imbalance, &
            rounding*outcome%initial_energy, "the imbalance is what the budget misses")
         call run(direct, impact, other)
         call check_close(other%cor, outcome%cor, agreement, "both methods agree")
         call check_close(other%cor_sphere, outcome%cor_sphere, agreement, &
            "both methods agree on the sphere")
         call check_relative(other%loss_tangent, outcome%loss_tangent, 1.0e-3_wp, &
            "both methods agree on the loss tangent")
      end do
   end subroutine test_random

end program test_laws
