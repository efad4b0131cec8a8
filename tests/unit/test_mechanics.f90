!> Exact hereditary mechanics: receding contact, hereditary plate, bodies in series
program test_mechanics
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus, pair_eq1, pair_series
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_target, only : new_plate, target_t, waves_constant, waves_hereditary, &
      waves_none, waves_relaxing
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_rigid, new_sls, prony_t
   use vcor_material_type, only : material_t
   use vcor_solver_ive, only : ive_t
   use vcor_solver_direct_product, only : product_t
   use vcor_solver_type, only : solver_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : make_ive, make_product, random_t, rigid_on_plate, run, success
   implicit none

   !> What ive is asked for
   real(wp), parameter :: ive_accuracy = 1.0e-8_wp
   !> Energy that may be missing, over the initial energy, at the accuracy 1e-8
   real(wp), parameter :: imbalance_tolerance = 1.0e-8_wp

   type(ive_t) :: ive
   type(product_t) :: direct

   call suite("mechanics")
   call make_ive(ive_accuracy, ive)
   call make_product(1.0e-6_wp, 1.0e-6_wp, direct)
   call test_table()
   call test_order()
   call test_reduced_dimension()
   call test_reversible()
   call test_tight_accuracy()
   call test_growing_again()
   call test_fractional()
   call test_nearly_fluid()
   call test_series()
   call test_energies()
   call test_memory()
   call test_light_plates()
   call finish()

contains

   !> The SLS rubber of the paper
   subroutine make_rubber(rubber)
      !> The material
      type(prony_t), intent(out) :: rubber

      type(error_t), allocatable :: error

      call new_sls(rubber, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      call success(error, "an SLS is built")
   end subroutine make_rubber

   !> The paper's first impact in all models, to ten digits: each model by independent code with
   !> steps refined until the digits stood
   subroutine test_table()
      integer, parameter :: waves(5) = [waves_none, waves_constant, waves_relaxing, &
         waves_hereditary, waves_hereditary]
      logical, parameter :: receding(5) = [.true., .true., .true., .false., .true.]
      real(wp), parameter :: cor(5) = [0.6320155755_wp, 0.4902964335_wp, 0.4479958102_wp, &
         0.4711951774_wp, 0.4875824382_wp]
      real(wp), parameter :: cor_sphere(5) = [0.6320155755_wp, 0.4902964335_wp, 0.4195242675_wp, &
         0.4434202328_wp, 0.4606655775_wp]
      real(wp), parameter :: contact_time(5) = [0.001391361347_wp, 0.001444646412_wp, &
         0.001442593897_wp, 0.001337438012_wp, 0.001433384911_wp]
      character(len=*), parameter :: name(5) = [character(len=21) :: "none, receding", &
         "constant, receding", "relaxing, receding", "hereditary, boltzmann", &
         "hereditary, receding"]
      ! with a step of 1 us
      real(wp), parameter :: direct_tolerance = 1.0e-5_wp
      type(prony_t) :: rubber
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(ive_t) :: loose
      integer :: i, digits

      call make_rubber(rubber)
      do i = 1, size(cor)
         call rigid_on_plate(rubber, waves(i), 10.0_wp, impact)
         impact%law%receding = receding(i)
         call run(ive, impact, outcome)
         call check_close(outcome%cor, cor(i), ive_accuracy, trim(name(i))//": ive, cor")
         call check_close(outcome%cor_sphere, cor_sphere(i), ive_accuracy, &
            trim(name(i))//": ive, cor_sphere")
         call check_relative(outcome%contact_time, contact_time(i), ive_accuracy, &
            trim(name(i))//": ive, contact time")
         call check_close(outcome%cor, cor(i), 3.0_wp*outcome%cor_error + 1.0e-10_wp, &
            trim(name(i))//": ive, the error is what it says")
         do digits = 1, 6
            call make_ive(10.0_wp**(-digits), loose)
            call run(loose, impact, outcome)
            call check_close(outcome%cor, cor(i), 10.0_wp**(-digits), &
               trim(name(i))//": ive with few digits, cor")
         end do
         call run(direct, impact, outcome)
         call check_close(outcome%cor, cor(i), direct_tolerance, trim(name(i))//": direct, cor")
         call check_relative(outcome%contact_time, contact_time(i), direct_tolerance, &
            trim(name(i))//": direct, contact time")
      end do
   end subroutine test_table

   !> Product integration is of second order with both exact models
   subroutine test_order()
      real(wp), parameter :: exact = 0.4875824382_wp, step = 8.0e-6_wp
      real(wp), parameter :: least_order = 1.8_wp
      type(product_t) :: coarse, fine
      type(prony_t) :: rubber
      type(impact_t) :: impact
      type(outcome_t) :: one, other

      call make_rubber(rubber)
      call rigid_on_plate(rubber, waves_hereditary, 10.0_wp, impact)
      impact%law%receding = .true.
      call make_product(step, 1.0e-6_wp, coarse)
      call make_product(0.25_wp*step, 1.0e-6_wp, fine)
      call run(coarse, impact, one)
      call run(fine, impact, other)
      call check(log(abs(one%cor - exact)/abs(other%cor - exact))/log(4.0_wp) >= least_order, &
         "product integration with exact mechanics is of second order")
   end subroutine test_order

   !> The method of dimensionality reduction: the contact as a row of independent elements of width
   !> dx and stiffness E' dx under the profile x^2/R. Each comes into contact when s = x^2/R,
   !> follows the SLS law as long as its force is positive, and then has lost contact for good.
   !> V. L. Popov and M. Hess, Method of Dimensionality Reduction in Contact Mechanics and Friction
   !> (2015), section 7; motion by the leapfrog method
   subroutine test_reduced_dimension()
      integer, parameter :: elements = 3000
      real(wp), parameter :: dt = 2.0e-8_wp, radius = 0.01_wp, velocity = 10.0_wp
      real(wp), parameter :: rate = 1200.0_wp, glassy = 20.0e6_wp, rubbery = 5.0e6_wp
      real(wp), parameter :: tolerance = 1.0e-4_wp
      type(prony_t) :: rubber
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      real(wp), dimension(elements) :: edge, relaxing, elastic
      logical, dimension(elements) :: touches, lost
      real(wp) :: s, v, ds, force, dx, decay, gain, t
      integer :: i

      call make_rubber(rubber)
      call rigid_on_plate(rubber, waves_none, velocity, impact)
      impact%law%receding = .true.
      call run(ive, impact, outcome)

      ! x from 0 to the largest contact radius and somewhat beyond, elements between equal steps
      dx = sqrt(radius*1.02_wp*outcome%max_indentation)/real(elements, wp)
      edge = [((dx*(real(i, wp) - 0.5_wp))**2/radius, i=1, elements)]
      relaxing = 0.0_wp
      elastic = 0.0_wp
      touches = .false.
      lost = .false.
      decay = exp(-rate*dt)
      gain = exp(-0.5_wp*rate*dt)
      s = 0.0_wp
      v = velocity
      t = 0.0_wp
      force = 0.0_wp
      do
         t = t + dt
         v = v - dt*force/impact%mass
         ds = v*dt
         s = s + ds
         do i = 1, elements
            if (lost(i)) cycle
            if (.not. touches(i)) then
               ! the elements lie in the order of their contact
               if (s <= edge(i)) exit
               touches(i) = .true.
               elastic(i) = rubbery*(s - edge(i))
               relaxing(i) = (glassy - rubbery)*(s - edge(i))
            else
               elastic(i) = elastic(i) + rubbery*ds
               relaxing(i) = relaxing(i)*decay + (glassy - rubbery)*ds*gain
            end if
            if (elastic(i) + relaxing(i) < 0.0_wp) then
               lost(i) = .true.
               elastic(i) = 0.0_wp
               relaxing(i) = 0.0_wp
            end if
         end do
         ! both sides of the row
         force = 2.0_wp*dx*sum(elastic + relaxing)
         if (v < 0.0_wp .and. .not. force > 0.0_wp) exit
         if (t > 3.0e-3_wp) exit
      end do
      call check_close(-v/velocity, outcome%cor, tolerance, "a row of elements: cor")
      call check_relative(t, outcome%contact_time, 10.0_wp*tolerance, "a row of elements: time")
   end subroutine test_reduced_dimension

   !> An elastic contact is reversible: the same with both laws
   subroutine test_reversible()
      type(prony_t) :: elastic
      type(impact_t) :: impact
      type(outcome_t) :: outcome, usual
      type(error_t), allocatable :: error
      integer, parameter :: waves(3) = [waves_none, waves_constant, waves_hereditary]
      ! the usual law ends where u = s^1.5 has its branch point
      real(wp), parameter :: tolerance = 1.0e-8_wp, direct_tolerance = 1.0e-5_wp
      integer :: i

      call new_elastic(elastic, 15.0e6_wp, error)
      call success(error, "an elastic material is built")
      do i = 1, size(waves)
         call rigid_on_plate(elastic, waves(i), 10.0_wp, impact)
         call run(ive, impact, usual)
         impact%law%receding = .true.
         call run(ive, impact, outcome)
         call check_close(outcome%cor, usual%cor, tolerance, "elastic contact: ive, cor")
         call check_relative(outcome%contact_time, usual%contact_time, tolerance, &
            "elastic contact: ive, contact time")
         call check(abs(outcome%residual_indentation) <= tolerance*outcome%max_indentation, &
            "elastic contact: no indentation is left")
         call run(direct, impact, outcome)
         call check_close(outcome%cor, usual%cor, direct_tolerance, "elastic contact: direct, cor")
      end do
   end subroutine test_reversible

   !> The approach between the ends of its panels affects a rebound, too, and is not a floor for its
   !> error: the stated one is what was asked for
   subroutine test_tight_accuracy()
      integer, parameter :: waves(4) = [waves_none, waves_constant, waves_relaxing, &
         waves_hereditary]
      ! rubbery over glassy modulus, and rates from slow to fast against the contact [1/s]
      real(wp), parameter :: rubbery(2) = [0.95_wp, 0.5_wp]
      real(wp), parameter :: rate(3) = [100.0_wp, 1200.0_wp, 2.0e4_wp]
      real(wp), parameter :: tight = 1.0e-10_wp, tightest = 1.0e-11_wp, largest_stated = 5.0e-11_wp
      type(ive_t) :: fine, finest
      type(prony_t) :: rubber
      type(impact_t) :: impact
      type(outcome_t) :: outcome, exact
      type(error_t), allocatable :: error
      integer :: i, j, k

      call make_ive(tight, fine)
      call make_ive(tightest, finest)
      do i = 1, size(waves)
         do j = 1, size(rubbery)
            do k = 1, size(rate)
               call new_sls(rubber, 15.0e6_wp, rubbery(j)*rate(k), rate(k), error)
               call success(error, "an SLS is built")
               call rigid_on_plate(rubber, waves(i), 2.0_wp, impact)
               impact%law%receding = .true.
               call run(fine, impact, outcome)
               call run(finest, impact, exact)
               call check_close(outcome%cor_error, 0.0_wp, tight, "receding at 1e-10: stated")
               call check_close(exact%cor_error, 0.0_wp, largest_stated, &
                  "receding at 1e-11: stated")
               call check_close(outcome%cor, exact%cor, outcome%cor_error + exact%cor_error, &
                  "receding at 1e-10: cor")
            end do
         end do
      end do
   end subroutine test_tight_accuracy

   !> A plate so light that the contact grows again, by up to 1.4e-3 of the time for 4.2 mm, has no
   !> result of ive at any accuracy, but one of direct: that of tests/reference/regrowth.py.
   !> Somewhat heavier ones have both
   subroutine test_growing_again()
      real(wp), parameter :: light(5) = [2.5e-3_wp, 3.0e-3_wp, 3.5e-3_wp, 4.0e-3_wp, 4.2e-3_wp]
      real(wp), parameter :: cor(5) = [2.88110e-5_wp, 2.79849e-4_wp, 1.528545e-3_wp, &
         4.291694e-3_wp, 5.724595e-3_wp]
      real(wp), parameter :: heavier(2) = [4.4e-3_wp, 6.0e-3_wp]
      real(wp), parameter :: poisson_ratio = 0.45_wp, density = 1100.0_wp, velocity = 5.0_wp
      real(wp), parameter :: direct_accuracy = 1.0e-4_wp
      type(ive_t) :: fast
      type(product_t) :: product
      type(outcome_t) :: outcome
      type(prony_t) :: rubber
      type(impact_t) :: impact
      type(error_t), allocatable :: error
      integer :: i, digits

      call make_rubber(rubber)
      call rubber%set_constants(error, density, poisson_ratio)
      call rigid_on_plate(rubber, waves_relaxing, velocity, impact)
      impact%law%receding = .true.
      call make_product(0.0_wp, direct_accuracy, product)
      do i = 1, size(light)
         call new_plate(impact%target, rubber, light(i), waves_relaxing, error)
         call success(error, "a light plate is built")
         do digits = 4, 11
            call make_ive(10.0_wp**(-digits), fast)
            call check(is_growing(fast, impact), "a contact that grows again: ive says so")
         end do
         call run(product, impact, outcome)
         call check_close(outcome%cor, cor(i), outcome%cor_error, "a contact that grows again: cor")
         call check_close(outcome%cor_error, 0.0_wp, direct_accuracy, &
            "a contact that grows again: stated error")
      end do
      do i = 1, size(heavier)
         call new_plate(impact%target, rubber, heavier(i), waves_relaxing, error)
         call success(error, "a plate is built")
         do digits = 4, 11
            call make_ive(10.0_wp**(-digits), fast)
            call check(.not. is_growing(fast, impact), "a contact that does not grow again: ive")
         end do
         call check(.not. is_growing(product, impact), &
            "a contact that does not grow again: direct")
      end do
   end subroutine test_growing_again

   !> Whether a solver says that the contact grows again; otherwise it has a result
   function is_growing(solver, impact)
      !> The solver
      class(solver_t), intent(inout) :: solver
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Whether it says so
      logical :: is_growing

      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      call solver%solve(impact, trajectory, error)
      is_growing = allocated(error)
      if (is_growing) then
         call check(error%code == error_numerical .and. index(error%message, "grows again") > 0, &
            "the contact is refused because it grows again")
      else
         call check(trajectory%status == contact_separated, "the contact ends")
      end if
   end function is_growing

   !> The fractional kernels by both methods, product integration extrapolated
   subroutine test_fractional()
      type(power_law_t) :: power_law
      type(cerf_t) :: cerf
      type(error_t), allocatable :: error

      call new_power_law(power_law, 5.6e6_wp, 8.9e5_wp, 0.5_wp, error)
      call success(error, "a power law is built")
      call compare(power_law, "power law")
      call new_power_law(power_law, 1.0e6_wp, 2.0e6_wp, 0.3_wp, error)
      call success(error, "a power law is built")
      call compare(power_law, "power law of exponent 0.3")
      call new_cerf(cerf, 10.0e6_wp, 60.0e6_wp, 50.0_wp, error)
      call success(error, "a CERF is built")
      call compare(cerf, "CERF")
   end subroutine test_fractional

   !> A receding contact of power laws that are nearly dashpots, whose fast modes amplify rounding
   !> errors of the indentation at the end
   subroutine test_nearly_fluid()
      real(wp), parameter :: exponent(6) = [0.85_wp, 0.92_wp, 0.94_wp, 0.97_wp, 0.98_wp, 0.995_wp]
      ! what ive is to be as accurate as, and product integration, its steps halved, at 1 us
      real(wp), parameter :: finer = 1.0e-10_wp, of_direct = 2.0e-6_wp
      type(power_law_t) :: material
      type(impact_t) :: impact
      type(ive_t) :: fine
      type(outcome_t) :: outcome, exact
      type(error_t), allocatable :: error
      integer :: i

      call make_ive(finer, fine)
      do i = 1, size(exponent)
         call new_power_law(material, 0.0_wp, 2.0e4_wp, exponent(i), error)
         call success(error, "a power law next to a dashpot is built")
         call rigid_on_plate(material, waves_none, 5.0_wp, impact)
         impact%law%receding = .true.
         call run(ive, impact, outcome)
         call run(fine, impact, exact)
         call check(outcome%status == contact_separated, "a nearly fluid contact ends")
         call check_close(outcome%cor, exact%cor, ive_accuracy, "a nearly fluid contact: 1e-8")
         call check_close(exact%cor_error, 0.0_wp, 2.0_wp*finer, "a nearly fluid contact: 1e-10")
         if (i > 2) cycle
         call run(direct, impact, outcome)
         call check_close(outcome%cor, exact%cor, of_direct, "a nearly fluid contact: direct")
      end do
   end subroutine test_nearly_fluid

   !> Compare both methods on the exact models
   subroutine compare(material, name)
      !> The material of the plate
      class(material_t), intent(in) :: material
      !> Its name
      character(len=*), intent(in) :: name

      real(wp), parameter :: tolerance = 1.0e-6_wp
      type(impact_t) :: impact
      type(outcome_t) :: outcome, coarse, fine
      type(product_t) :: solver
      real(wp) :: step
      integer :: i

      do i = 1, 2
         call rigid_on_plate(material, waves_hereditary, 10.0_wp, impact)
         impact%law%receding = i == 2
         call run(ive, impact, outcome)
         step = outcome%contact_time/500.0_wp
         call make_product(step, 1.0e-6_wp, solver)
         call run(solver, impact, coarse)
         call make_product(0.5_wp*step, 1.0e-6_wp, solver)
         call run(solver, impact, fine)
         call check_close(outcome%cor, fine%cor + (fine%cor - coarse%cor)/3.0_wp, tolerance, &
            name//": both methods, cor")
         call check_relative(outcome%contact_time, fine%contact_time &
            + (fine%contact_time - coarse%contact_time)/3.0_wp, 10.0_wp*tolerance, &
            name//": both methods, contact time")
      end do
   end subroutine compare

   !> Two bodies in series
   subroutine test_series()
      real(wp), parameter :: tolerance = 1.0e-11_wp
      type(prony_t) :: rubber, other, elastic, rigid, viscous
      type(contact_modulus_t) :: series, eq1
      type(error_t), allocatable :: error
      complex(wp) :: a, b
      real(wp), parameter :: time(4) = [1.0e-5_wp, 1.0e-4_wp, 1.0e-3_wp, 1.0e-2_wp]
      real(wp), parameter :: omega(3) = [10.0_wp, 1000.0_wp, 1.0e5_wp]
      integer :: i

      call make_rubber(rubber)
      call new_rigid(rigid)
      call new_elastic(elastic, 40.0e6_wp, error)
      call success(error, "an elastic material is built")
      call new_prony(other, 2.0e6_wp, [5.0e6_wp, 20.0e6_wp, 3.0e6_wp], &
         [50.0_wp, 1200.0_wp, 3.0e4_wp], 0.0_wp, error)
      call success(error, "a Prony series is built")
      call new_prony(viscous, 2.0e6_wp, [5.0e6_wp], [50.0_wp], 300.0_wp, error)
      call success(error, "a Prony series with a dashpot is built")

      call new_contact_modulus(series, rigid, rubber, .false., error, pair_series)
      call success(error, "a rigid body in series")
      call new_contact_modulus(eq1, rigid, rubber, .false., error, pair_eq1)
      call check_relative(series%relaxation(time), eq1%relaxation(time), tolerance, &
         "series and Eq. (1) agree where one body is rigid")
      call new_contact_modulus(series, rubber, rubber, .true., error, pair_series)
      call new_contact_modulus(eq1, rubber, rubber, .true., error, pair_eq1)
      call check_relative(series%relaxation(time), eq1%relaxation(time), tolerance, &
         "series and Eq. (1) agree for one material")
      call new_contact_modulus(series, rubber, rubber, .false., error, pair_series)
      call check_relative(series%relaxation(time), eq1%relaxation(time), tolerance, &
         "two materials that are the same are one")
      do i = 1, size(omega)
         call new_contact_modulus(series, rubber, other, .false., error, pair_series)
         call success(error, "two Prony series in series")
         call of_both(rubber, other, omega(i), a, b)
         call check(abs(series%dynamic_modulus(omega(i))*(a + b)/(a*b) - 1.0_wp) <= tolerance, &
            "compliances add: two Prony series")
         call new_contact_modulus(series, elastic, viscous, .false., error, pair_series)
         call success(error, "a spring and a Prony series with a dashpot in series")
         call of_both(elastic, viscous, omega(i), a, b)
         call check(abs(series%dynamic_modulus(omega(i))*(a + b)/(a*b) - 1.0_wp) <= tolerance, &
            "compliances add: a spring and a dashpot")
      end do
   end subroutine test_series

   !> Plane-strain moduli of two materials at a frequency
   subroutine of_both(first, second, omega, a, b)
      !> One material
      class(material_t), intent(in) :: first
      !> The other one
      class(material_t), intent(in) :: second
      !> Frequency [rad/s]
      real(wp), intent(in) :: omega
      !> Modulus of one [Pa]
      complex(wp), intent(out) :: a
      !> Modulus of the other one [Pa]
      complex(wp), intent(out) :: b

      a = first%plane_strain_factor()*first%complex_modulus(cmplx(0.0_wp, omega, wp))
      b = second%plane_strain_factor()*second%complex_modulus(cmplx(0.0_wp, omega, wp))
   end subroutine of_both

   !> Random materials and geometries: energies are positive and close, the sphere loses speed
   subroutine test_energies()
      integer, parameter :: cases = 200
      type(random_t) :: random
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(prony_t) :: prony
      type(power_law_t) :: power_law
      type(cerf_t) :: cerf
      type(error_t), allocatable :: error
      real(wp) :: e, velocity, radius, mass
      integer :: i, separated

      separated = 0
      do i = 1, cases
         e = random%log_between(1.0e6_wp, 1.0e9_wp)
         velocity = random%log_between(0.1_wp, 30.0_wp)
         radius = random%log_between(0.003_wp, 0.03_wp)
         mass = random%log_between(0.3_wp, 3.0_wp)*3.0e4_wp*radius**3
         select case (mod(i, 4))
         case (0)
            call new_power_law(power_law, 0.2_wp*e, e*1.0e-2_wp, random%between(0.2_wp, 0.6_wp), &
               error)
            call rigid_on_plate(power_law, waves_hereditary, velocity, impact, mass, radius)
         case (1)
            call new_cerf(cerf, 0.3_wp*e, e, random%log_between(5.0_wp, 200.0_wp), error)
            call rigid_on_plate(cerf, waves_hereditary, velocity, impact, mass, radius)
         case (2)
            call new_sls(prony, e, 0.3_wp*1.0e3_wp, random%log_between(400.0_wp, 3.0e3_wp), error)
            call rigid_on_plate(prony, waves_hereditary, velocity, impact, mass, radius)
         case default
            call new_prony(prony, random%log_between(0.05_wp, 1.0_wp)*e, &
               e*[0.5_wp, 1.0_wp, 2.0_wp], [random%log_between(10.0_wp, 300.0_wp), &
               random%log_between(300.0_wp, 3.0e3_wp), random%log_between(3.0e3_wp, 1.0e5_wp)], &
               0.0_wp, error)
            call rigid_on_plate(prony, waves_hereditary, velocity, impact, mass, radius)
         end select
         call success(error, "a random material is built")
         impact%law%receding = mod(i/4, 2) == 0
         call run(ive, impact, outcome)
         if (outcome%status /= contact_separated) cycle
         separated = separated + 1
         call check(outcome%cor_sphere < 1.0_wp, "random impact: the sphere loses speed")
         call check(outcome%hysteresis_energy >= 0.0_wp .and. outcome%wave_energy >= 0.0_wp &
            .and. outcome%final_energy >= 0.0_wp, "random impact: no energy is negative")
         call check(abs(outcome%energy_imbalance) <= imbalance_tolerance*outcome%initial_energy, &
            "random impact: the energies close")
      end do
      call check(separated == cases, "all random impacts end in separation")
   end subroutine test_energies

   !> The memory of a plate as a sum of exponentials: the velocity under a constant force is as
   !> accurate as asked for at all times, however long the sum is to hold
   subroutine test_memory()
      real(wp), parameter :: window(3) = [1.0e-3_wp, 0.1_wp, 10.0_wp]
      ! between asked for and found
      real(wp), parameter :: accuracy(3) = [1.0e-5_wp, 1.0e-7_wp, 1.0e-9_wp]
      real(wp), parameter :: density = 1100.0_wp, half_thickness = 0.01_wp
      type(prony_t) :: prony(3)
      type(target_t) :: plate
      type(exponential_sum_t) :: terms
      type(error_t), allocatable :: error
      real(wp) :: time, expected
      integer :: i, j, k, m

      call new_sls(prony(1), 2.7e5_wp, 10.0_wp, 3300.0_wp, error)
      call success(error, "an SLS is built")
      call new_prony(prony(2), 1.0e4_wp, [4.0e5_wp, 1.0e5_wp, 3.0e5_wp], &
         [3000.0_wp, 480.0_wp, 400.0_wp], 0.0_wp, error)
      call success(error, "a Prony series is built")
      call new_prony(prony(3), 0.0_wp, [1.0e6_wp, 1.0e6_wp], [1.0e5_wp, 1.0_wp], 0.0_wp, error)
      call success(error, "a fluid is built")
      do i = 1, size(prony)
         call prony(i)%set_constants(error, density=density)
         call new_plate(plate, prony(i), half_thickness, waves_hereditary, error)
         call success(error, "a hereditary plate is built")
         do j = 1, size(window)
            do k = 1, size(accuracy)
               call plate%response(window(j), accuracy(k), terms)
               do m = 0, 24
                  time = window(j)*10.0_wp**(-0.25_wp*real(m, wp))
                  expected = plate%alpha(0.0_wp) + plate%memory_integral(time)
                  call check_relative(terms%integral(time), expected, accuracy(k), &
                     "memory of a plate: velocity under a constant force")
               end do
            end do
         end do
      end do
   end subroutine test_memory

   !> Plates that are light against the sphere and relax fast against the contact: the error is what
   !> it says, though most of the energy goes and the contact lasts many times as long as expected
   subroutine test_light_plates()
      integer, parameter :: cases = 100
      ! the difference of two solutions vanishes by chance now and then
      real(wp), parameter :: usual_ratio = 10.0_wp, largest_ratio = 100.0_wp
      integer, parameter :: most_by_chance = 2
      type(random_t) :: random
      type(ive_t) :: fine
      type(prony_t) :: rubber
      type(impact_t) :: impact
      type(outcome_t) :: outcome, exact
      type(error_t), allocatable :: error
      real(wp) :: rate
      integer :: i, by_chance

      by_chance = 0
      call make_ive(1.0e-10_wp, fine)
      do i = 1, cases
         rate = random%log_between(1.0e2_wp, 3.0e4_wp)
         call new_sls(rubber, random%log_between(2.0e5_wp, 2.0e7_wp), &
            rate*random%log_between(1.0e-3_wp, 0.3_wp), rate, error)
         call success(error, "a random SLS is built")
         call rigid_on_plate(rubber, waves_hereditary, random%log_between(0.1_wp, 10.0_wp), &
            impact, mass=random%log_between(0.03_wp, 0.3_wp))
         impact%law%receding = mod(i, 2) == 0
         call run(ive, impact, outcome)
         call run(fine, impact, exact)
         call check_close(outcome%cor, exact%cor, ive_accuracy, "light plate: cor")
         call check_close(outcome%cor, exact%cor, largest_ratio*outcome%cor_error, &
            "light plate: the error is what it says")
         if (.not. abs(outcome%cor - exact%cor) <= usual_ratio*outcome%cor_error) &
            by_chance = by_chance + 1
      end do
      call check(by_chance <= most_by_chance, "light plates: the errors are what they say")
   end subroutine test_light_plates

end program test_mechanics
