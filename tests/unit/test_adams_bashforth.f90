!> The paper's own time marching: its digits, its order, its limits
program test_adams_bashforth
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_outcome, only : evaluate, outcome_t
   use vcor_impact_target, only : waves_frozen, waves_none, waves_relaxing
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : col_force, col_indentation, col_plate, col_sphere, &
      col_time, col_velocity, contact_lasting, contact_separated, trajectory_t
   use vcor_kinds, only : wp
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_sls, prony_t
   use vcor_solver_direct_product, only : new_product, product_t
   use vcor_solver_paper_adams_bashforth, only : adams_bashforth_t, new_adams_bashforth
   use vcor_solver_paper_formulas, only : damping_limit, kernel_terms
   use vcor_solver_type, only : solver_settings_t
   use vcor_test, only : check, check_close, check_contains, check_relative, finish, suite
   use vcor_test_cases, only : refused, rigid_on_plate, run, success
   implicit none

   !> The paper's step for the SLS, 2 ms/3000, and the one of its BUTYL runs [s]
   real(wp), parameter :: sls_step = 2.0e-3_wp/3000.0_wp, butyl_step = 0.4e-6_wp
   !> The order of the start moves the sixth digit, about so much of the value
   real(wp), parameter :: sixth_digit = 4.0e-5_wp
   !> cor of sls and butyl_prony at 10 m/s, ../reference/reference.csv
   real(wp), parameter :: sls_cor = 0.4319868986470_wp, prony_cor = 0.2572184845344_wp
   !> The same sums in another order
   real(wp), parameter :: rounding = 1.0e-12_wp

   type(prony_t) :: sls, prony
   type(power_law_t) :: power_law
   type(cerf_t) :: cerf

   call suite("adams_bashforth")
   call make_materials()
   call test_sls()
   call test_butyl()
   call test_frozen()
   call test_elastic()
   call test_order()
   call test_second_term()
   call test_ghost()
   call test_end()
   call test_limit()
   call test_unstable()
   call test_long_steps()
   call test_refused()
   call finish()

contains

   !> The materials of the paper
   subroutine make_materials()
      type(error_t), allocatable :: error

      call new_sls(sls, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      call success(error, "Eq. (14) is built")
      call new_prony(prony, 10.421e6_wp, [20.181e6_wp, 38.204e6_wp, 87.344e6_wp], &
         [972.0_wp, 6426.0_wp, 34221.0_wp], 0.0_wp, error)
      call success(error, "Eq. (26) is built")
      call new_power_law(power_law, 22.8e5_wp, 8.85e5_wp, 0.5_wp, error)
      call success(error, "Eq. (23-b) is built")
      call new_cerf(cerf, 0.442e6_wp, 0.6765e9_wp, 700.0_wp, error)
      call success(error, "Eq. (24) is built")
   end subroutine make_materials

   !> March; without a plate's other model, second term or ghost lines
   subroutine march(impact, time_step, form, quadrature, outcome)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: time_step
      !> Form of the force
      character(len=*), intent(in) :: form
      !> Sums
      character(len=*), intent(in) :: quadrature
      !> Its outcome
      type(outcome_t), intent(out) :: outcome

      type(adams_bashforth_t) :: solver
      type(error_t), allocatable :: error

      call new_adams_bashforth(solver, solver_settings_t(time_step=time_step, form=form, &
         quadrature=quadrature), error)
      if (allocated(error)) call success(error, "the marching scheme is built")
      call run(solver, impact, outcome)
   end subroutine march

   !> The digits that the paper prints for the SLS, and one or two more
   subroutine test_sls()
      type(impact_t) :: impact
      type(outcome_t) :: outcome

      call rigid_on_plate(sls, waves_relaxing, 10.0_wp, impact)
      call march(impact, sls_step, "a", "rectangle", outcome)
      call check_close(outcome%cor, 0.4313_wp, 0.5e-4_wp, "sls: the paper's COR")
      call check_close(outcome%cor, 0.43132_wp, 0.5e-5_wp, "sls: COR")
      call check_close(outcome%max_force, 600.7_wp, 0.05_wp, "sls: the paper's largest force")
      call check_relative(outcome%max_force, 600.708_wp, sixth_digit, "sls: largest force")
      call check_close(outcome%residual_ratio, 0.5593_wp, 0.5e-4_wp, "sls: the paper's residual")
      call check_relative(outcome%residual_ratio, 0.559309_wp, sixth_digit, "sls: residual")
      call check_close(outcome%hysteresis_energy, 0.793_wp, 0.5e-3_wp, "sls: the paper's loss")
      call check_relative(outcome%hysteresis_energy, 0.79325_wp, sixth_digit, "sls: loss")
      call check_close(1.0e3_wp*outcome%contact_time, 1.34153_wp, 0.5e-5_wp, "sls: contact time")
      call check_close(outcome%min_frequency, 4683.6_wp, 0.05_wp, "sls: lowest frequency")

      call march(impact, 1.0e-6_wp, "a", "trapezoid", outcome)
      call check_close(outcome%cor, 0.43199_wp, 2.5e-5_wp, "sls: COR with trapezoids")
      call march(impact, 1.0e-6_wp, "b", "trapezoid", outcome)
      call check_close(outcome%cor, 0.43199_wp, 2.5e-5_wp, "sls: COR with form b")
      call march(impact, 0.5e-6_wp, "b", "rectangle", outcome)
      call check_close(outcome%cor, sls_cor, 1.5e-4_wp, "sls: COR with form b and rectangles")
   end subroutine test_sls

   !> The digits that the paper prints for BUTYL
   subroutine test_butyl()
      type(impact_t) :: impact
      type(outcome_t) :: outcome

      call rigid_on_plate(power_law, waves_relaxing, 10.0_wp, impact)
      call march(impact, butyl_step, "a", "rectangle", outcome)
      call check_close(outcome%max_force, 921.7_wp, 0.05_wp, "butyl: the paper's largest force")
      call check_relative(outcome%max_force, 921.67_wp, sixth_digit, "butyl: largest force")
      call check_close(1.0e3_wp*outcome%max_indentation, 2.1921_wp, 0.5e-4_wp, &
         "butyl: largest indentation")
      call check_close(outcome%hysteresis_energy, 1.172_wp, 0.5e-3_wp, "butyl: the paper's loss")
      call check_relative(outcome%hysteresis_energy, 1.17184_wp, sixth_digit, "butyl: loss")
      call check_close(outcome%min_frequency, 8101.8_wp, 0.05_wp, "butyl: lowest frequency")
      ! what the capped kernel leaves out, as in the estimate
      call check(abs(outcome%cor - 0.2114372812_wp) <= 1.5_wp*outcome%cor_error &
         .and. outcome%cor_error < 0.01_wp, "butyl: the estimate includes the capped kernel")
   end subroutine test_butyl

   !> Prony's COR "about 24 % higher", deformations "11 % apart": frozen against relaxing
   subroutine test_frozen()
      type(impact_t) :: impact
      type(outcome_t) :: frozen, relaxing

      call rigid_on_plate(prony, waves_frozen, 10.0_wp, impact)
      call march(impact, sls_step, "a", "trapezoid", frozen)
      call check_close(frozen%cor, 0.26730_wp, 1.0e-5_wp, "frozen: COR of the Prony series")
      call check_close(1.0e3_wp*frozen%max_indentation, 2.442_wp, 0.5e-3_wp, &
         "frozen: largest indentation")
      call check_close(frozen%energy_imbalance/frozen%initial_energy, 0.0_wp, 1.0e-4_wp, &
         "frozen: energy is conserved")
      call rigid_on_plate(power_law, waves_relaxing, 10.0_wp, impact)
      call march(impact, sls_step, "a", "rectangle", relaxing)
      call check_close(relaxing%cor, 0.2155_wp, 0.5e-4_wp, "relaxing: COR of the power law")
      call check_close(1.0e3_wp*relaxing%max_indentation, 2.196_wp, 0.5e-3_wp, &
         "relaxing: largest indentation")
      call check_close(frozen%cor/relaxing%cor, 1.24_wp, 0.005_wp, "24 % higher")
      call check_close(frozen%max_indentation/relaxing%max_indentation, 1.11_wp, 0.005_wp, &
         "11 % apart")
      call rigid_on_plate(power_law, waves_frozen, 50.0_wp, impact)
      call march(impact, 0.1e-6_wp, "a", "rectangle", frozen)
      call check_close(frozen%hysteresis_energy, 30.65_wp, 0.1_wp, "frozen: loss at 50 m/s")
   end subroutine test_frozen

   !> The SLS without decay is elastic
   subroutine test_elastic()
      type(prony_t) :: slow, elastic
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error

      call new_sls(slow, 15.0e6_wp, 0.25e-9_wp, 1.0e-9_wp, error)
      call rigid_on_plate(slow, waves_relaxing, 10.0_wp, impact)
      call march(impact, sls_step, "a", "rectangle", outcome)
      call check_close(outcome%cor, 0.79_wp, 0.005_wp, "elastic limit: the paper's COR")
      call check_close(1.0e3_wp*outcome%contact_time, 1.4_wp, 0.05_wp, &
         "elastic limit: the paper's contact time")
      call new_elastic(elastic, 15.0e6_wp, error)
      call rigid_on_plate(elastic, waves_frozen, 10.0_wp, impact)
      call march(impact, sls_step, "a", "trapezoid", outcome)
      call check_close(outcome%cor, 0.7912870179_wp, 1.0e-5_wp, "elastic: COR")
      call check_close(outcome%residual_ratio, 0.0_wp, 1.0e-3_wp, "elastic: nothing remains")
      call rigid_on_plate(elastic, waves_none, 10.0_wp, impact)
      call march(impact, sls_step, "a", "trapezoid", outcome)
      call check_close(outcome%cor, 1.0_wp, 1.0e-5_wp, "elastic without waves: nothing is lost")
   end subroutine test_elastic

   !> Order one with rectangles, about two with trapezoids, and errors that are known
   subroutine test_order()
      integer, parameter :: halvings = 3
      character(len=9), parameter :: quadrature(2) = ["rectangle", "trapezoid"]
      ! of tests/reference
      real(wp), parameter :: sls_cor_sphere = 0.4022529366124_wp
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      real(wp) :: error(0:halvings), order, error_sphere
      integer :: i, j

      call rigid_on_plate(sls, waves_relaxing, 10.0_wp, impact)
      do j = 1, 2
         do i = 0, halvings
            call march(impact, 4.0e-6_wp/2.0_wp**i, "a", quadrature(j), outcome)
            error(i) = abs(outcome%cor - sls_cor)
            call check(error(i) <= 10.0_wp*outcome%cor_error .and. &
               outcome%cor_error <= 30.0_wp*error(i), &
               quadrature(j)//": the estimate of the error is honest")
            error_sphere = abs(outcome%cor_sphere - sls_cor_sphere)
            call check(error_sphere <= 10.0_wp*outcome%cor_sphere_error .and. &
               outcome%cor_sphere_error <= 30.0_wp*error_sphere, &
               quadrature(j)//": that of cor_sphere is, too")
         end do
         order = log(error(0)/error(halvings))/(real(halvings, wp)*log(2.0_wp))
         ! the start u' ~ sqrt(t) adds a small term of order 1.5 to the trapezoids' 2, of the other
         ! sign: what is measured is a little more
         call check_close(order, merge(1.0_wp, 2.2_wp, j == 1), merge(0.1_wp, 0.4_wp, j == 1), &
            quadrature(j)//": order")
      end do
      call rigid_on_plate(prony, waves_relaxing, 10.0_wp, impact)
      call march(impact, 0.5e-6_wp, "a", "trapezoid", outcome)
      call check_close(outcome%cor, prony_cor, 5.0e-6_wp, "prony: trapezoids converge")
   end subroutine test_order

   !> The second term in the force, against the sums written out and against internal variables
   subroutine test_second_term()
      real(wp), parameter :: coefficient = 200.0_wp
      character(len=9), parameter :: quadrature(2) = ["rectangle", "trapezoid"]
      character(len=1), parameter :: form(2) = ["a", "b"]
      ! form b is stable with shorter steps only
      real(wp), parameter :: step(2) = [8.0e-6_wp, 1.0e-6_wp]
      type(impact_t) :: impact
      type(adams_bashforth_t) :: solver
      type(product_t) :: product
      type(outcome_t) :: outcome, reference, without
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error
      real(wp) :: largest
      integer :: i, j, n

      call rigid_on_plate(sls, waves_relaxing, 10.0_wp, impact)
      call new_product(product, solver_settings_t(time_step=5.0e-7_wp, &
         second_coefficient=coefficient))
      call run(product, impact, reference)
      call march(impact, 1.0e-6_wp, "a", "trapezoid", without)
      call check(abs(without%cor - reference%cor) > 1.0e-3_wp, "the second term matters")
      do i = 1, 2
         do j = 1, 2
            call new_adams_bashforth(solver, solver_settings_t(time_step=step(i), form=form(i), &
               quadrature=quadrature(j), second_coefficient=coefficient), error)
            call solver%solve(impact, trajectory, error)
            call success(error, "a run with the second term")
            largest = trajectory%max_force
            do n = 1, trajectory%last - 1, trajectory%last/10
               call check_close(written_out(impact, trajectory, n, step(i), coefficient, &
                  form(i), j == 2), trajectory%state(col_force, n), rounding*largest, &
                  "form "//form(i)//", "//quadrature(j)//": the force is the sums written out")
            end do
            call new_adams_bashforth(solver, solver_settings_t(time_step=1.0e-6_wp, form=form(i), &
               quadrature=quadrature(j), second_coefficient=coefficient), error)
            call run(solver, impact, outcome)
            call check_close(outcome%cor, reference%cor, merge(2.0e-3_wp, 1.0e-5_wp, j == 1), &
               "form "//form(i)//", "//quadrature(j)//": COR as by product integration")
         end do
      end do
   end subroutine test_second_term

   !> Force of Eqs. (8) and (10) at a node of an impact with the SLS, by sums written out
   function written_out(impact, trajectory, n, dt, coefficient, form, trapezoid) result(force)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Its course
      type(trajectory_t), intent(in) :: trajectory
      !> Node
      integer, intent(in) :: n
      !> Time step [s]
      real(wp), intent(in) :: dt
      !> Coefficient of the second term
      real(wp), intent(in) :: coefficient
      !> Form of the force
      character(len=1), intent(in) :: form
      !> Whether the last terms are halved
      logical, intent(in) :: trapezoid
      !> Force [N]
      real(wp) :: force

      real(wp), parameter :: glassy = 15.0e6_wp/0.75_wp
      real(wp) :: w(n), u, firmness, single, double
      integer :: i, j

      firmness = impact%factor*glassy
      associate (s => trajectory%state(col_indentation, 1:n), &
                 v => trajectory%state(col_velocity, 1:n))
         u = s(n)**1.5_wp
         w = 1.5_wp*sqrt(s)*v
         if (form == "b") w = s**1.5_wp
      end associate
      if (trapezoid) w(n) = 0.5_wp*w(n)
      single = 0.0_wp
      double = 0.0_wp
      do i = 1, n
         single = single + dt*w(i)*firmness*sls_kernel(form, dt*real(n - i, wp), 1)
         do j = 1, n
            double = double + dt**2*w(i)*w(j)*firmness &
               *sls_kernel(form, dt*real(2*n - i - j, wp), 2)
         end do
      end do
      force = single + coefficient*double
      if (form == "b") force = firmness*u + single &
         + coefficient*(firmness*u**2 + 2.0_wp*u*single + double)
   end function written_out

   !> Kernel of the SLS divided by its firmness: k, or k' and k'' in form b
   pure function sls_kernel(form, time, term) result(k)
      !> Form of the force
      character(len=1), intent(in) :: form
      !> Time [s]
      real(wp), intent(in) :: time
      !> Term of the Volterra series
      integer, intent(in) :: term
      !> Value [-], [1/s] or [1/s^2]
      real(wp) :: k

      real(wp), parameter :: beta = 1200.0_wp

      k = 0.75_wp*exp(-beta*time)
      if (form == "b") then
         k = k*(-beta)**term
      else
         k = k + 0.25_wp
      end if
   end function sls_kernel

   !> Beyond the separation
   subroutine test_ghost()
      type(impact_t) :: impact
      type(adams_bashforth_t) :: plain, solver
      type(trajectory_t) :: trajectory, short
      type(outcome_t) :: outcome, other
      type(error_t), allocatable :: error
      integer :: waves, n

      do waves = waves_relaxing, waves_frozen
         call rigid_on_plate(sls, waves, 10.0_wp, impact)
         call new_adams_bashforth(plain, solver_settings_t(time_step=1.0e-6_wp, &
            quadrature="rectangle"), error)
         call plain%solve(impact, short, error)
         call success(error, "a run without ghost")
         call new_adams_bashforth(solver, solver_settings_t(time_step=1.0e-6_wp, &
            quadrature="rectangle", ghost=.true.), error)
         call solver%solve(impact, trajectory, error)
         call success(error, "a run with ghost")
         outcome = evaluate(impact, short)
         other = evaluate(impact, trajectory)
         call check(short%final == short%last, "without ghost nothing follows")
         call check_relative([other%cor, other%contact_time, other%hysteresis_energy, &
            other%cor_error], [outcome%cor, outcome%contact_time, outcome%hysteresis_energy, &
            outcome%cor_error], 0.0_wp, "the ghost changes nothing")
         n = trajectory%final
         call check_close(trajectory%state(col_time, n), 2.0_wp*other%contact_time, 2.0e-6_wp, &
            "the ghost goes on to twice the contact time")
         call check(all(trajectory%state(col_time, 1:n) > 0.0_wp) .and. &
            all(trajectory%state(col_time, 2:n) > trajectory%state(col_time, 1:n - 1)), &
            "time goes on")
         call check(trajectory%state(col_force, trajectory%last + 1) < 0.0_wp, &
            "the ghost pulls")
         call check_close(trajectory%state(col_force, trajectory%last), 0.0_wp, 0.0_wp, &
            "no force at the separation")
         call check_close(maxval(abs(trajectory%state(col_sphere, 1:n) &
            - trajectory%state(col_plate, 1:n) - trajectory%state(col_indentation, 1:n))), &
            0.0_wp, 1.0e-16_wp, "s = z - U")
      end do
      call new_adams_bashforth(solver, solver_settings_t(time_step=1.0e-6_wp, end_time=4.0e-3_wp, &
         quadrature="rectangle", ghost=.true.), error)
      call solver%solve(impact, trajectory, error)
      call check_close(trajectory%state(col_time, trajectory%final), 4.0e-3_wp, 2.0e-6_wp, &
         "or to the end that is asked for")
   end subroutine test_ghost

   !> Ends other than a separation, and the step where none is given
   subroutine test_end()
      type(impact_t) :: impact
      type(adams_bashforth_t) :: solver
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error

      call rigid_on_plate(sls, waves_relaxing, 10.0_wp, impact)
      call new_adams_bashforth(solver, solver_settings_t(time_step=1.0e-6_wp, end_time=1.0e-3_wp, &
         quadrature="rectangle"), error)
      call run(solver, impact, outcome)
      call check(outcome%status == contact_lasting, "a short time ends in contact")
      call check(outcome%steps == 1000, "after the steps that fit in")
      call new_adams_bashforth(solver, solver_settings_t(quadrature="rectangle"), error)
      call run(solver, impact, outcome)
      call check(outcome%status == contact_separated .and. abs(outcome%steps - 3000) < 600, &
         "without a step it takes about 3000")
   end subroutine test_end

   !> Limit of stability: closed forms for a constant kernel
   subroutine test_limit()
      ! sigma(-1), delta2(-1) and delta1(-1) of the formulas of fifth order
      real(wp), parameter :: sigma = 551.0_wp/45.0_wp, second = 4592.0_wp/45.0_wp
      real(wp), parameter :: first = 256.0_wp/15.0_wp
      real(wp), parameter :: dt = 1.0e-3_wp, firmness = 7.0_wp
      real(wp) :: kernel(0:kernel_terms)

      kernel = firmness
      call check_relative(damping_limit(dt, kernel, "a", 1.0_wp, .false.), &
         8.0_wp/(sigma*second*dt*firmness), 1.0e-10_wp, "limit: rectangles, z = -1")
      call check_relative(damping_limit(dt, kernel, "a", 1.0_wp, .true.), &
         4.0_wp/(sigma*first*dt*firmness), 1.0e-10_wp, "limit: rectangles, frozen plate")
      ! roots of the characteristic polynomials, computed apart
      call check_relative(damping_limit(dt, kernel, "a", 0.5_wp, .false.)*dt*firmness, &
         0.08865_wp, 0.01_wp, "limit: trapezoids")
      call check_relative(damping_limit(dt, kernel, "b", 1.0_wp, .false.)*dt*firmness, &
         0.00082077_wp, 0.01_wp, "limit: form b, rectangles")
      call check_relative(damping_limit(dt, kernel, "b", 0.5_wp, .false.)*dt*firmness, &
         0.0035125_wp, 0.01_wp, "limit: form b, trapezoids")
      call check_relative(damping_limit(dt, kernel, "b", 0.5_wp, .true.)*dt*firmness, &
         0.0025708_wp, 0.01_wp, "limit: form b, frozen plate")
   end subroutine test_limit

   !> An unstable run is refused, and the step that the message names works
   subroutine test_unstable()
      type(impact_t) :: impact

      call rigid_on_plate(cerf, waves_relaxing, 10.0_wp, impact)
      call check_unstable(impact, 1.0e-6_wp, "a", "rectangle", "cerf")
      call rigid_on_plate(power_law, waves_relaxing, 50.0_wp, impact)
      call check_unstable(impact, 1.0e-6_wp, "a", "rectangle", "power law at 50 m/s")
      call check_unstable(impact, butyl_step, "a", "rectangle", "power law at 50 m/s, 0.4 us")
      call rigid_on_plate(prony, waves_relaxing, 10.0_wp, impact)
      call check_unstable(impact, 1.0e-6_wp, "b", "rectangle", "prony, form b")
      call check_unstable(impact, 4.0e-6_wp, "b", "trapezoid", "prony, form b, trapezoids")
      call rigid_on_plate(sls, waves_relaxing, 10.0_wp, impact)
      call check_unstable(impact, 2.0e-5_wp, "a", "rectangle", "sls")
   end subroutine test_unstable

   !> Check that a run is refused as unstable
   subroutine check_unstable(impact, time_step, form, quadrature, name)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time step [s]
      real(wp), intent(in) :: time_step
      !> Form of the force
      character(len=*), intent(in) :: form
      !> Sums
      character(len=*), intent(in) :: quadrature
      !> What to call it
      character(len=*), intent(in) :: name

      character(len=*), parameter :: before = "largest stable one is about "
      type(adams_bashforth_t) :: solver
      type(trajectory_t) :: trajectory
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp) :: stable
      integer :: i

      call new_adams_bashforth(solver, solver_settings_t(time_step=time_step, form=form, &
         quadrature=quadrature), error)
      call solver%solve(impact, trajectory, error)
      call check(allocated(error), name//": unstable")
      if (.not. allocated(error)) return
      call check(error%code == error_numerical, name//": a numerical failure")
      call check_contains(error%message, before, name//": the message names a step")
      i = index(error%message, before)
      if (i == 0) return
      read (error%message(i + len(before):), *) stable
      call check(stable < time_step, name//": a shorter one")
      call march(impact, stable, form, quadrature, outcome)
      call check(outcome%status == contact_separated .and. outcome%cor > 0.0_wp &
         .and. outcome%cor < 1.0_wp, name//": with it there is an outcome")
   end subroutine check_unstable

   !> What the scheme cannot do
   subroutine test_refused()
      type(prony_t) :: dashpot
      type(impact_t) :: impact
      type(adams_bashforth_t) :: solver
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      call new_adams_bashforth(solver, solver_settings_t(form="c", quadrature="rectangle"), error)
      call refused(error, "a, b")
      call new_adams_bashforth(solver, solver_settings_t(quadrature="simpson"), error)
      call refused(error, "rectangle, trapezoid")

      call new_adams_bashforth(solver, solver_settings_t(form="b", quadrature="rectangle"), error)
      call rigid_on_plate(power_law, waves_relaxing, 10.0_wp, impact)
      call solver%solve(impact, trajectory, error)
      call refused(error, "finite modulus")
      call rigid_on_plate(cerf, waves_relaxing, 10.0_wp, impact)
      call solver%solve(impact, trajectory, error)
      call refused(error, "finite rate")

      call new_prony(dashpot, 1.0e6_wp, [1.0e6_wp], [1000.0_wp], 10.0_wp, error)
      call rigid_on_plate(dashpot, waves_relaxing, 10.0_wp, impact)
      call new_adams_bashforth(solver, solver_settings_t(quadrature="rectangle"), error)
      call solver%solve(impact, trajectory, error)
      call refused(error, "viscosity")
   end subroutine test_refused

   !> Steps that make no course
   subroutine test_long_steps()
      real(wp), parameter :: step(3) = [1.0e-4_wp, 1.0e-2_wp, 1.0e200_wp]
      type(impact_t) :: impact
      type(adams_bashforth_t) :: solver
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error
      integer :: i

      call rigid_on_plate(sls, waves_relaxing, 10.0_wp, impact)
      do i = 1, size(step)
         call new_adams_bashforth(solver, solver_settings_t(time_step=step(i), &
            quadrature="rectangle"), error)
         call solver%solve(impact, trajectory, error)
         call check(allocated(error), "a step like the contact is refused")
         if (.not. allocated(error)) cycle
         call check(error%code == error_numerical, "as a numerical failure")
         call check_contains(error%message, "at most", "the message says how long it may be")
      end do
   end subroutine test_long_steps

end program test_adams_bashforth
