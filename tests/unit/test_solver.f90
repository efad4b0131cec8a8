!> Both solvers: convergence, what a trajectory holds, contacts that do not end, refusals
program test_solver
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan, ieee_quiet_nan, ieee_value
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_target, only : waves_none, waves_relaxing
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_plate, &
      col_plate_velocity, col_sphere, col_sphere_velocity, col_time, col_velocity, &
      columns, contact_lasting, contact_separated, contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_sls, prony_t
   use vcor_solver, only : method_for, new_solver, solver_settings_t, solver_t
   use vcor_solver_features, only : features, of_body, of_paper_scheme, of_second_term
   use vcor_solver_ive, only : ive_t
   use vcor_solver_direct_product, only : product_t
   use vcor_test, only : check, check_close, check_relative, check_text, finish, &
      suite
   use vcor_test_cases, only : refused, body_on_body, make_ive, make_product, random_t, &
      rigid_on_plate, run, success
   implicit none

   !> Sums and differences of the state, each rounded
   real(wp), parameter :: rounding = 1.0e-13_wp
   !> Integrals over the contact by the weights of the nodes, at default accuracies
   real(wp), parameter :: ive_integral = 1.0e-8_wp, direct_integral = 1.0e-5_wp
   !> cor of tests/reference/reference.csv: sls_v10, butyl_prony_v10 and elastic_v10
   real(wp), parameter :: reference(3) = &
      [0.4319868986470_wp, 0.2572184845344_wp, 0.7912870179168_wp]
   !> cor of a pure power law of exponent 1/2 on a half space
   real(wp), parameter :: power_law_cor = 0.28565312277610_wp
   !> Order of product integration: u = s^1.5 at the start makes it 2.5
   real(wp), parameter :: lowest_order = 2.0_wp, highest_order = 3.0_wp

   type(impact_t) :: impact(3), singular
   type(power_law_t) :: power_law

   call suite("solver")
   call make_impacts()
   call test_ive_accuracy()
   call test_estimates()
   call test_two_maxima()
   call test_pair_with_fluid()
   call test_fluid_plates()
   call test_immense_rate()
   call test_product_order()
   call test_product_accuracy()
   call test_trajectory()
   call test_repeatable()
   call test_lasting()
   call test_sticking()
   call test_factory()
   call finish()

contains

   !> The impacts of the paper at 10 m/s, and a pure power law
   subroutine make_impacts()
      type(prony_t) :: material
      type(error_t), allocatable :: error

      call new_sls(material, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      call rigid_on_plate(material, waves_relaxing, 10.0_wp, impact(1))
      call new_prony(material, 10.421e6_wp, [20.181e6_wp, 38.204e6_wp, 87.344e6_wp], &
         [972.0_wp, 6426.0_wp, 34221.0_wp], 0.0_wp, error)
      call rigid_on_plate(material, waves_relaxing, 10.0_wp, impact(2))
      call new_elastic(material, 15.0e6_wp, error)
      call rigid_on_plate(material, waves_relaxing, 10.0_wp, impact(3))
      call new_power_law(power_law, 0.0_wp, 7.0e5_wp, 0.5_wp, error)
      call rigid_on_plate(power_law, waves_none, 10.0_wp, singular)
      call success(error, "the materials are built")
   end subroutine make_impacts

   !> The error of internal variables is below the accuracy asked for, and more costs more steps
   subroutine test_ive_accuracy()
      type(ive_t) :: solver
      type(outcome_t) :: outcome
      real(wp) :: accuracy
      integer :: i, digits, steps(3)

      steps = 0
      do digits = 4, 10
         accuracy = 10.0_wp**(-digits)
         call make_ive(accuracy, solver)
         do i = 1, 3
            call run(solver, impact(i), outcome)
            call check(outcome%status == contact_separated, "the bodies separate")
            call check_close(outcome%cor, reference(i), accuracy, &
               "ive: the error is below the accuracy asked for")
            call check(outcome%cor_error <= accuracy, "ive: by its own estimate as well")
            if (digits == 10) call check(outcome%steps > steps(i), &
               "ive: ten digits need more steps than four")
            if (digits == 4) steps(i) = outcome%steps
         end do
      end do
      call make_ive(0.1_wp, solver)
      call run(solver, singular, outcome)
      call check_close(outcome%cor, power_law_cor, 1.0e-6_wp, &
         "ive: six digits cost no more than one, and are given")
   end subroutine test_ive_accuracy

   !> At every accuracy the error of random impacts is below it, and their estimates are its size:
   !> losses from nothing to nearly all, kernels that are sums of exponentials and one that is not
   subroutine test_estimates()
      integer, parameter :: trials = 60
      ! an estimate may be too small by so much, and rounding; too large, for most, by so much
      real(wp), parameter :: too_small = 5.0_wp, finest = 1.0e-11_wp, too_large = 0.5_wp
      type(prony_t) :: slow, fast
      type(power_law_t) :: fractional
      type(impact_t) :: random_impact
      type(ive_t) :: solver
      type(outcome_t) :: outcome, exact
      type(random_t) :: random
      type(error_t), allocatable :: error
      real(wp) :: accuracy, velocity, radius
      integer :: i, digits, cautious, separated

      call new_sls(slow, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      call new_prony(fast, 10.421e6_wp, [20.181e6_wp, 38.204e6_wp, 87.344e6_wp], &
         [972.0_wp, 6426.0_wp, 34221.0_wp], 0.0_wp, error)
      call new_power_law(fractional, 2.28e6_wp, 0.885e6_wp, 0.5_wp, error)
      call success(error, "three materials are built")
      cautious = 0
      separated = 0
      do i = 1, trials
         velocity = random%log_between(0.01_wp, 100.0_wp)
         radius = random%log_between(1.0e-3_wp, 0.05_wp)
         select case (mod(i, 3))
         case (0)
            call rigid_on_plate(slow, waves_relaxing, velocity, random_impact, radius=radius)
         case (1)
            call rigid_on_plate(fast, waves_relaxing, velocity, random_impact, radius=radius)
         case default
            call rigid_on_plate(fractional, waves_relaxing, velocity, random_impact, radius=radius)
         end select
         call make_ive(finest, solver)
         call run(solver, random_impact, exact)
         if (exact%status /= contact_separated) cycle
         do digits = 4, 9
            accuracy = 10.0_wp**(-digits)
            call make_ive(accuracy, solver)
            call run(solver, random_impact, outcome)
            call check(outcome%status == contact_separated, "a random impact ends")
            call check_close(outcome%cor, exact%cor, accuracy, &
               "a random impact: the error is below the accuracy asked for")
            call check_close(outcome%cor, exact%cor, too_small*outcome%cor_error + finest, &
               "a random impact: the estimate is not too small")
            separated = separated + 1
            if (outcome%cor_error > too_large*accuracy) cautious = cautious + 1
         end do
      end do
      call check(separated > 3*trials, "most random impacts end")
      call check(10*cautious < separated, "few estimates are as large as the accuracy")
   end subroutine test_estimates

   !> A heavy sphere has two maxima of the force: the larger one counts, at every accuracy
   subroutine test_two_maxima()
      type(prony_t) :: material
      type(impact_t) :: heavy
      type(ive_t) :: solver
      type(outcome_t) :: outcome, exact
      type(error_t), allocatable :: error
      integer :: digits

      call new_sls(material, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      call rigid_on_plate(material, waves_relaxing, 22.5767_wp, heavy, radius=0.0620684_wp)
      call success(error, "a heavy sphere is built")
      call make_ive(1.0e-11_wp, solver)
      call run(solver, heavy, exact)
      do digits = 5, 9
         call make_ive(10.0_wp**(-digits), solver)
         call run(solver, heavy, outcome)
         call check_relative(outcome%max_force, exact%max_force, 10.0_wp**(1 - digits), &
            "the larger of two maxima of the force")
      end do
   end subroutine test_two_maxima

   !> A plate that has lost nearly all its stiffness recedes from the sphere, and the
   !> contact ends long before the first step that its time scale asks for: it is seen to end, and
   !> to turn where it does, at every accuracy; or the contact lasts, and rounding in next to no
   !> force is not to keep its end from being found. References by tests/reference/impact_solver.py,
   !> the last two by ive at 1e-10
   subroutine test_fluid_plates()
      real(wp), parameter :: alpha(9) = [1.0e-4_wp, 1.0e-4_wp, 1.0e-4_wp, 1.0e-4_wp, 1.0_wp, &
         1.0e-2_wp, 3.0e-3_wp, 1.0e-4_wp, 1.0e-4_wp]
      real(wp), parameter :: beta(9) = [5.88e6_wp, 1.0e5_wp, 1.19e4_wp, 1.0e5_wp, 1.8e4_wp, &
         1.0e6_wp, 3.0e6_wp, 4.64159e7_wp, 1.06082e8_wp]
      logical, parameter :: receding(9) = [.false., .false., .true., .true., .true., .true., &
         .false., .false., .false.]
      real(wp), parameter :: cor(9) = [0.43898_wp, 0.412498286_wp, 0.336355376_wp, 0.421353081_wp, &
         0.288561116_wp, 0.308531266_wp, 0.195588273_wp, 2.035e-5_wp, 3.468e-5_wp]
      real(wp), parameter :: roughly = 1.0e-5_wp
      type(prony_t) :: material
      type(impact_t) :: fluid
      type(ive_t) :: solver
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      integer :: i, digits

      do digits = 6, 8
         call make_ive(10.0_wp**(-digits), solver)
         do i = 1, size(beta)
            call new_sls(material, 15.0e6_wp, alpha(i), beta(i), error)
            call rigid_on_plate(material, waves_relaxing, 10.0_wp, fluid)
            fluid%law%receding = receding(i)
            call success(error, "a receding plate is built")
            call run(solver, fluid, outcome)
            call check_close(outcome%cor, cor(i), roughly, "a receding plate")
         end do
      end do
   end subroutine test_fluid_plates

   !> A mode that relaxes at once changes nothing, not at the end of a receding contact either,
   !> where time stands still in the panel
   subroutine test_immense_rate()
      real(wp), parameter :: rate(2) = [1.0e24_wp, 1.0e60_wp]
      type(prony_t) :: material
      type(impact_t) :: problem
      type(ive_t) :: solver
      type(outcome_t) :: without, outcome
      type(error_t), allocatable :: error
      integer :: i

      call make_ive(1.0e-9_wp, solver)
      do i = 0, size(rate)
         call new_prony(material, 3.0e6_wp, spread(1.0e6_wp, 1, min(i, 1) + 1), &
            [1.0e3_wp, rate(max(i, 1):i)], 0.0_wp, error)
         call success(error, "a mode that relaxes at once")
         call rigid_on_plate(material, waves_none, 10.0_wp, problem)
         problem%law%receding = .true.
         call run(solver, problem, outcome)
         if (i == 0) without = outcome
         call check_close(outcome%cor, without%cor, 1.0e-9_wp, "a mode that relaxes at once")
      end do
   end subroutine test_immense_rate

   !> Eq. (1) with a fluid, whose modulus is nothing long before its sum ends: both methods see
   !> it stick, or come back all the same
   subroutine test_pair_with_fluid()
      real(wp), parameter :: rate(2) = [1.0e6_wp, 1.0e3_wp]
      integer, parameter :: status(2) = [contact_sticking, contact_separated]
      real(wp), parameter :: direct_accuracy = 1.0e-6_wp
      type(prony_t) :: fluid, solid
      type(impact_t) :: two
      type(ive_t) :: ive
      type(product_t) :: product
      type(outcome_t) :: outcome, other
      type(error_t), allocatable :: error
      integer :: i

      call make_ive(1.0e-8_wp, ive)
      call make_product(0.0_wp, direct_accuracy, product)
      call new_prony(solid, 1.0e5_wp, [1.0e7_wp], [1.0e3_wp], 0.0_wp, error)
      do i = 1, size(rate)
         call new_prony(fluid, 0.0_wp, [1.0e7_wp], [rate(i)], 0.0_wp, error)
         call success(error, "a fluid is built")
         call body_on_body(fluid, solid, waves_none, 1.0_wp, two)
         call run(ive, two, outcome)
         call run(product, two, other)
         call check(outcome%status == status(i), "with a fluid: ive")
         call check(other%status == status(i), "with a fluid: direct")
         if (status(i) /= contact_separated) cycle
         call check_close(outcome%cor, other%cor, direct_accuracy, "with a fluid: both agree")
         call check(outcome%cor_error <= direct_accuracy, "with a fluid: the estimate")
      end do
   end subroutine test_pair_with_fluid

   !> Product integration on steps that are halved
   subroutine test_product_order()
      call check_order(impact(1), reference(1), "sls")
      call check_order(impact(2), reference(2), "butyl_prony")
      call check_order(singular, power_law_cor, "power_law")
   end subroutine test_product_order

   !> Check the order of product integration
   subroutine check_order(problem, cor, name)
      !> The impact, lasting about a millisecond
      type(impact_t), intent(in) :: problem
      !> Its coefficient of restitution
      real(wp), intent(in) :: cor
      !> What to call it
      character(len=*), intent(in) :: name

      integer, parameter :: halvings = 3
      type(product_t) :: solver
      type(outcome_t) :: outcome
      real(wp) :: error(0:halvings), order
      integer :: i

      do i = 0, halvings
         call make_product(8.0e-6_wp/2.0_wp**i, 1.0_wp, solver)
         call run(solver, problem, outcome)
         error(i) = abs(outcome%cor - cor)
         call check(error(i) <= 10.0_wp*outcome%cor_error .and. &
            outcome%cor_error <= 100.0_wp*error(i), name//": the estimate of the error is honest")
      end do
      order = log(error(0)/error(halvings))/(real(halvings, wp)*log(2.0_wp))
      call check(order >= lowest_order, name//": product integration is of order 2 at least")
      call check_close(order, 0.5_wp*(lowest_order + highest_order), &
         0.5_wp*(highest_order - lowest_order), name//": order of product integration")
   end subroutine check_order

   !> Product integration refines until its estimate meets the accuracy
   subroutine test_product_accuracy()
      type(product_t) :: solver
      type(outcome_t) :: outcome
      integer :: digits, i, steps

      steps = 0
      do digits = 3, 7
         call make_product(0.0_wp, 10.0_wp**(-digits), solver)
         do i = 1, 3
            call run(solver, impact(i), outcome)
            call check_close(outcome%cor, reference(i), 10.0_wp**(-digits), &
               "product: the error is below the accuracy asked for")
         end do
         call run(solver, singular, outcome)
         call check_close(outcome%cor, power_law_cor, 10.0_wp**(-digits), &
            "product: also for a singular kernel")
         call check(outcome%steps >= steps, "product: more digits need no fewer steps")
         steps = outcome%steps
      end do
   end subroutine test_product_accuracy

   !> What the columns of a trajectory have to do with each other
   subroutine test_trajectory()
      type(ive_t) :: ive
      type(product_t) :: product

      call make_ive(1.0e-8_wp, ive)
      call check_trajectory(ive, impact(1), ive_integral, "ive")
      call check_trajectory(ive, impact(2), ive_integral, "ive")
      call make_product(0.0_wp, 1.0e-6_wp, product)
      call check_trajectory(product, impact(1), direct_integral, "direct")
      call check_trajectory(product, singular, direct_integral, "direct")
   end subroutine test_trajectory

   !> Check one trajectory
   subroutine check_trajectory(solver, problem, tolerance, name)
      !> The solver
      class(solver_t), intent(inout) :: solver
      !> The impact
      type(impact_t), intent(in) :: problem
      !> Tolerance of integrals
      real(wp), intent(in) :: tolerance
      !> What to call it
      character(len=*), intent(in) :: name

      type(trajectory_t) :: trajectory
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp), allocatable :: state(:, :), share(:)
      real(wp) :: largest
      integer :: n

      call solver%solve(problem, trajectory, error)
      call success(error, name//": an impact is solved")
      outcome = evaluate(problem, trajectory)
      n = trajectory%last
      ! copies, with node 0 the first: the arrays of a trajectory may be longer
      allocate (state(columns, 0:n), share(0:n))
      state = trajectory%state(:, 0:n)
      share = trajectory%share(0:n)
      call check_close(state([col_time, col_indentation, col_force, col_impulse, col_sphere, &
         col_plate], 0), 0.0_wp, 0.0_wp, name//": all is zero at first contact")
      call check_relative(state([col_velocity, col_sphere_velocity], 0), problem%velocity, &
         0.0_wp, name//": but the velocities")
      call check(all(state(col_time, 1:n) > state(col_time, 0:n - 1)), name//": time goes on")
      largest = maxval(abs(state(col_sphere, :)))
      call check_close(maxval(abs(state(col_indentation, :) - state(col_sphere, :) &
         + state(col_plate, :)))/largest, 0.0_wp, rounding, name//": s = z - U")
      call check_close(maxval(abs(state(col_velocity, :) - state(col_sphere_velocity, :) &
         + state(col_plate_velocity, :)))/problem%velocity, 0.0_wp, tolerance, &
         name//": s' = z' - U'")
      call check_close(maxval(abs(problem%mass*(problem%velocity &
         - state(col_sphere_velocity, :)) - state(col_impulse, :)))/state(col_impulse, n), &
         0.0_wp, rounding, name//": m (v0 - z') = I")
      call check_close(maxval(abs(problem%target%alpha(state(col_time, :)) &
         *state(col_impulse, :) - state(col_plate, :)))/largest, 0.0_wp, rounding, &
         name//": U = alpha I")
      call check(all(state(col_force, 1:n - 1) > 0.0_wp), name//": the force presses")
      call check_close(state(col_force, n)/outcome%max_force, 0.0_wp, tolerance, &
         name//": and is zero at the end")
      call check_relative(sum(share), state(col_impulse, n), tolerance, &
         name//": the shares make up the impulse")
      call check_relative(2.0_wp*sum(share*state(col_sphere_velocity, :)), problem%mass &
         *(problem%velocity**2 - state(col_sphere_velocity, n)**2), tolerance, &
         name//": the work of the force is the change of the sphere's energy")
      call check_relative(sum(share*state(col_time, :)), state(col_time, n)*state(col_impulse, n) &
         - problem%mass*(problem%velocity*state(col_time, n) - state(col_sphere, n)), tolerance, &
         name//": z is the integral of z'")
      call check(outcome%max_indentation >= maxval(state(col_indentation, :)) &
         *(1.0_wp - rounding), name//": no node is deeper than the largest indentation")
      call check(outcome%max_force >= maxval(state(col_force, :))*(1.0_wp - rounding), &
         name//": no force is larger than the largest")
      call check(outcome%time_of_max_force < outcome%time_of_max_indentation, &
         name//": the force is largest before the indentation")
   end subroutine check_trajectory

   !> A solver is not changed by what it solves
   subroutine test_repeatable()
      type(ive_t) :: solver
      type(outcome_t) :: first, other, again

      call make_ive(1.0e-8_wp, solver)
      call run(solver, impact(1), first)
      call run(solver, impact(2), other)
      call run(solver, impact(1), again)
      call check_close(again%cor, first%cor, 0.0_wp, "the same impact has the same outcome")
      call check(abs(other%cor - first%cor) > 0.1_wp, "another one has another")
   end subroutine test_repeatable

   !> A contact that does not end within the time given
   subroutine test_lasting()
      real(wp), parameter :: too_short = 1.0e-3_wp, enough = 2.0e-3_wp
      character(len=*), parameter :: method(2) = [character(len=6) :: "ive", "direct"]
      type(solver_settings_t) :: settings
      class(solver_t), allocatable :: solver
      type(trajectory_t) :: trajectory
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      integer :: i

      settings%scheme = "product"
      do i = 1, 2
         settings%method = trim(method(i))
         settings%end_time = too_short
         call new_solver(solver, settings, impact(1), error)
         call success(error, trim(method(i))//" is built")
         call solver%solve(impact(1), trajectory, error)
         call success(error, trim(method(i))//": a short time is not an error")
         outcome = evaluate(impact(1), trajectory)
         call check(outcome%status == contact_lasting, &
            & trim(method(i))//": but its own status")
         call check(all(ieee_is_nan([outcome%cor, outcome%contact_time, outcome%cor_error])), &
            trim(method(i))//": without an outcome")
         ! product integration ends with a whole step
         call check_relative(trajectory%state(col_time, trajectory%last), too_short, &
            merge(1.0e-12_wp, 0.05_wp, i == 1), trim(method(i))//": it ends when it is told to")
         settings%end_time = enough
         call new_solver(solver, settings, impact(1), error)
         call run(solver, impact(1), outcome)
         call check_close(outcome%cor, reference(1), 1.0e-6_wp, &
            trim(method(i))//": a longer time changes nothing")
      end do
   end subroutine test_lasting

   !> A sphere that falls into a fluid does not come back
   subroutine test_sticking()
      type(prony_t) :: fluid
      type(impact_t) :: fall
      type(ive_t) :: ive
      type(product_t) :: product
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error

      call new_sls(fluid, 15.0e6_wp, 0.0_wp, 1.0e5_wp, error)
      call success(error, "a Maxwell fluid is built")
      call rigid_on_plate(fluid, waves_none, 1.0_wp, fall)
      call make_ive(1.0e-8_wp, ive)
      call run(ive, fall, outcome)
      call check(outcome%status == contact_sticking .or. outcome%status == contact_lasting, &
         "ive: in a Maxwell fluid that relaxes fast the sphere sticks")
      call make_product(0.0_wp, 1.0e-6_wp, product)
      call run(product, fall, outcome)
      call check(outcome%status == contact_sticking .or. outcome%status == contact_lasting, &
         "direct: in a Maxwell fluid that relaxes fast the sphere sticks")
   end subroutine test_sticking

   !> Solvers by name
   subroutine test_factory()
      type(cerf_t) :: cerf
      type(impact_t) :: general
      type(solver_settings_t) :: settings
      class(solver_t), allocatable :: solver
      type(outcome_t) :: outcome, direct
      type(error_t), allocatable :: error
      logical :: has(size(features))

      ! what the settings are by themselves
      has = .false.
      call check_text(trim(method_for("auto", "product", has)), "ive", "auto is ive")
      call check_text(trim(method_for("direct", "product", has)), "direct", &
         & "what is asked for is taken")
      has(of_second_term) = .true.
      call check_text(trim(method_for("auto", "product", has)), "direct", &
         & "auto is direct for the variants of the paper")
      has(of_paper_scheme) = .true.
      call check_text(trim(method_for("auto", "adams_bashforth", has)), "direct", &
         & "auto is direct for the scheme of the paper")
      has(of_body) = .true.
      call check_text(trim(method_for("auto", "product", has)), "coupled", &
         & "auto is coupled for waves in a plate of any thickness")
      call new_solver(solver, settings, singular, error)
      call success(error, "auto solves a power law")
      call run(solver, singular, outcome)
      call check_close(outcome%cor, power_law_cor, 1.0e-8_wp, "to eight digits")
      call new_solver(solver, settings, impact(1), error)
      call run(solver, impact(1), outcome)
      call check_close(outcome%cor, reference(1), 1.0e-8_wp, "and an SLS to eight")
      settings%method = "direct"
      settings%time_step = 1.0e-6_wp
      call new_solver(solver, settings, impact(1), error)
      call run(solver, impact(1), outcome)
      call check(outcome%steps == 1342, "the time step is taken: t0 = 1341.5 us")
      settings%time_step = 0.0_wp

      call new_cerf(cerf, 8.0e6_wp, 6.0e8_wp, 300.0_wp, error)
      call rigid_on_plate(cerf, waves_relaxing, 10.0_wp, general)
      settings%method = "ive"
      call new_solver(solver, settings, general, error)
      call success(error, "ive for a CERF material")
      call run(solver, general, outcome)
      settings%method = "direct"
      settings%accuracy = 1.0e-6_wp
      call new_solver(solver, settings, general, error)
      call run(solver, general, direct)
      call check_close(outcome%cor, direct%cor, 1.0e-6_wp, "ive and direct agree on it")
      settings%accuracy = 0.0_wp

      settings%accuracy = -1.0_wp
      call new_solver(solver, settings, error)
      call refused(error, "a solver for any impact: accuracy < 0", "must not be negative")
      settings%accuracy = ieee_value(1.0_wp, ieee_quiet_nan)
      call new_solver(solver, settings, error)
      call refused(error, "a solver for any impact: accuracy nan", "must be numbers")
      settings%accuracy = 0.0_wp

      settings%method = "magic"
      call new_solver(solver, settings, impact(1), error)
      call refused(error, "an unknown method", "auto, ive, direct")
      settings%method = "direct"
      settings%scheme = "magic"
      call new_solver(solver, settings, impact(1), error)
      call refused(error, "an unknown scheme", "product")
   end subroutine test_factory

end program test_solver
