!> Every impact of reference.csv, by both methods
program test_reference
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_kinds, only : wp
   use vcor_solver_ive, only : ive_t
   use vcor_solver_direct_product, only : product_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : make_ive, make_product, read_impact, run
   implicit none

   !> Where the reference stands, from the top of the sources
   character(len=*), parameter :: folder = "tests/reference/"
   !> Its first line: the order that `reference_t` is read in
   character(len=*), parameter :: header = "name,kernel,laws,cor,cor_sphere,contact_time," &
      //"max_indentation,max_force,residual_indentation,residual_ratio,hysteresis_energy," &
      //"wave_energy,initial_energy,energy_imbalance,min_frequency,inelasticity,loss_tangent,digits"
   !> Number of impacts in it
   integer, parameter :: rows = 84
   !> Default accuracy of the internal-variable method
   real(wp), parameter :: default_accuracy = 1.0e-8_wp
   !> The accuracy asked for is that of the coefficients of restitution; at the default accuracy the
   !> contact time is as good
   real(wp), parameter :: time_share = 1.0_wp
   !> At other accuracies a slow end of contact may move the time by more
   real(wp), parameter :: other_time_share = 10.0_wp
   !> Maxima are promised within the accuracy, energies, which go with the square of cor_sphere,
   !> within twice that
   real(wp), parameter :: energy_share = 2.0_wp
   !> The residual indentation moves with the contact time, at the velocity of separation
   real(wp), parameter :: residual_share = 3.0_wp
   !> Energy that may get lost, over initial energy and accuracy: 1e-9 at the default accuracy
   real(wp), parameter :: imbalance_share = 0.1_wp
   !> Rounding errors of the outcome, through the eigenvectors of collocation; of some weight at the
   !> accuracy 1e-10 only
   real(wp), parameter :: rounding = 1.0e-11_wp
   !> An estimate below a tenth of the error is not an estimate
   real(wp), parameter :: too_small = 10.0_wp
   !> An estimate of more than a hundred times the error is none, either; below a tenth of the
   !> accuracy asked for, rounding aside, it misleads nobody
   real(wp), parameter :: too_large = 100.0_wp, estimate_floor = 0.1_wp
   !> Time step of the paper [s]
   real(wp), parameter :: microsecond = 1.0e-6_wp
   !> What product integration at 1 us is to reach: 2.5th order, kernels that are finite at t = 0
   real(wp), parameter :: smooth_tolerance = 5.0e-7_wp
   !> The same for kernels with an infinite rate, or infinite themselves, at t = 0
   real(wp), parameter :: singular_tolerance = 2.0e-5_wp
   !> Steps per contact that compare to 1 us in the paper's impacts
   real(wp), parameter :: usual_steps = 1400.0_wp
   !> Default accuracy of product integration
   real(wp), parameter :: direct_accuracy = 1.0e-6_wp
   !> Loss tangents at the frequency of a contact time that is wrong by 1e-8
   real(wp), parameter :: loss_tolerance = 1.0e-8_wp
   !> Fourier quadrature of general pairs; the reference has twelve digits
   real(wp), parameter :: transform = 1.0e-11_wp
   !> Closed forms with some ten operations; what the case file rounds
   real(wp), parameter :: closed_form = 1.0e-12_wp

   !> One row of the reference
   type :: reference_t
      !> Name of the case
      character(len=40) :: name = ""
      !> Whether the kernel is a sum of exponentials
      logical :: exponential = .false.
      !> What the outcome is to be
      type(outcome_t) :: outcome
   end type reference_t

   type(reference_t) :: reference(rows)
   type(impact_t) :: impact(rows)
   integer :: i

   call suite("reference")
   call read_reference()
   do i = 1, rows
      call read_impact(folder//"cases/"//trim(reference(i)%name)//".nml", impact(i))
   end do
   call test_loss_tangent()
   call test_ive(default_accuracy, time_share)
   call test_ive(1.0e-10_wp, other_time_share)
   call test_ive(1.0e-5_wp, other_time_share)
   call test_direct_microsecond()
   call test_direct_steps()
   call test_direct_default()
   call finish()

contains

   !> Read the reference
   subroutine read_reference()
      character(len=400) :: line
      real(wp) :: value(15)
      integer :: unit, status, n, first, last

      n = 0
      open(newunit=unit, file=folder//"reference.csv", status="old", action="read", iostat=status)
      call check(status == 0, folder//"reference.csv is there")
      if (status /= 0) return
      read(unit, "(a)", iostat=status) line
      call check(status == 0 .and. trim(line) == header, &
         "the columns are those that are known here")
      do
         read(unit, "(a)", iostat=status) line
         if (status /= 0 .or. n == rows) exit
         n = n + 1
         associate (row => reference(n))
            first = index(line, ",")
            row%name = line(:first - 1)
            last = first + index(line(first + 1:), ",")
            row%exponential = line(first + 1:last - 1) == "exponential_sum"
            first = last + index(line(last + 1:), ",")
            read(line(first + 1:), *) value
            row%outcome%cor = value(1)
            row%outcome%cor_sphere = value(2)
            row%outcome%contact_time = value(3)
            row%outcome%max_indentation = value(4)
            row%outcome%max_force = value(5)
            row%outcome%residual_indentation = value(6)
            row%outcome%residual_ratio = value(7)
            row%outcome%hysteresis_energy = value(8)
            row%outcome%wave_energy = value(9)
            row%outcome%initial_energy = value(10)
            row%outcome%min_frequency = value(12)
            row%outcome%inelasticity = value(13)
            row%outcome%loss_tangent = value(14)
         end associate
      end do
      close(unit)
      call check(status /= 0 .and. n == rows, "all rows were read, and there are no more")
   end subroutine read_reference

   !> Loss tangents at the frequency of the reference, of general pairs by Fourier quadrature
   subroutine test_loss_tangent()
      complex(wp) :: modulus
      integer :: i

      do i = 1, rows
         associate (r => reference(i)%outcome)
            modulus = impact(i)%modulus%dynamic_modulus(r%min_frequency)
            call check_relative(aimag(modulus)/real(modulus, wp), r%loss_tangent, transform, &
               trim(reference(i)%name)//": loss tangent at the frequency of the reference")
         end associate
      end do
   end subroutine test_loss_tangent

   !> All sums of exponentials by internal variables
   subroutine test_ive(accuracy, share)
      !> Accuracy asked for
      real(wp), intent(in) :: accuracy
      !> Share of it that is the tolerance of the contact time
      real(wp), intent(in) :: share

      type(ive_t) :: solver
      type(outcome_t) :: outcome
      character(len=12) :: asked
      integer :: i

      write(asked, "(a, es7.1)") " ive ", accuracy
      call make_ive(accuracy, solver)
      do i = 1, rows
         call run(solver, impact(i), outcome)
         associate (r => reference(i)%outcome, name => trim(reference(i)%name)//asked)
            call check(outcome%status == contact_separated, name//": the bodies separate")
            call check_close(outcome%cor, r%cor, accuracy, name//": cor")
            call check_close(outcome%cor_sphere, r%cor_sphere, accuracy, name//": cor_sphere")
            call check_relative(outcome%contact_time, r%contact_time, share*accuracy + rounding, &
               name//": contact_time")
            call check_relative(outcome%max_indentation, r%max_indentation, accuracy + rounding, &
               name//": max_indentation")
            call check_relative(outcome%max_force, r%max_force, accuracy + rounding, &
               name//": max_force")
            call check_close(outcome%residual_ratio, r%residual_ratio, &
               residual_share*share*accuracy + rounding, name//": residual_ratio")
            call check_close(outcome%hysteresis_energy/r%initial_energy, &
               r%hysteresis_energy/r%initial_energy, energy_share*accuracy + rounding, &
               name//": hysteresis_energy")
            call check_close(outcome%wave_energy/r%initial_energy, r%wave_energy/r%initial_energy, &
               energy_share*accuracy + rounding, name//": wave_energy")
            call check_relative(outcome%initial_energy, r%initial_energy, closed_form, &
               name//": initial_energy")
            ! a kernel that is infinite at first has none
            if (r%inelasticity > 0.0_wp .or. .not. ieee_is_nan(outcome%inelasticity)) &
               call check_relative(outcome%inelasticity, r%inelasticity, closed_form, &
               name//": inelasticity")
            call check_close(outcome%energy_imbalance/r%initial_energy, 0.0_wp, &
               imbalance_share*accuracy + rounding, name//": energy_imbalance")
            if (accuracy <= default_accuracy) call check_close(outcome%loss_tangent, &
               r%loss_tangent, loss_tolerance, name//": loss_tangent")
            call check_honest(outcome, r, accuracy, name)
         end associate
      end do
   end subroutine test_ive

   !> The paper's impacts by product integration with its time step
   subroutine test_direct_microsecond()
      type(product_t) :: solver
      integer :: i, found

      found = 0
      call make_product(microsecond, direct_accuracy, solver)
      do i = 1, rows
         select case (reference(i)%name)
         case ("elastic_v10", "sls_v1", "sls_v2", "sls_v5", "sls_v10", "sls_v20", "sls_beta1", &
               "sls_beta10", "sls_beta50", "sls_beta600_v10", "sls_beta2400_v10", &
               "sls_beta4800_v10", "sls_beta1e5", "sls_beta0.001", "sls_beta1e8", &
               "butyl_prony_v1", "butyl_prony_v10", "butyl_prony_v20")
            call check_direct(solver, i, smooth_tolerance, " direct 1 us")
            found = found + 1
         case ("butyl_cerf_v1", "butyl_cerf_v10", "butyl_cerf_v20", "butyl_cerf_v50", &
               "butyl_power_law_v1", "butyl_power_law_v10", "butyl_power_law_v20", &
               "butyl_power_law_v50")
            call check_direct(solver, i, singular_tolerance, " direct 1 us")
            found = found + 1
         case default
            ! no impact of the paper
         end select
      end do
      call check(found == 26, "all of the paper's impacts are in the reference")
   end subroutine test_direct_microsecond

   !> All impacts by product integration with as many steps as the paper has
   subroutine test_direct_steps()
      type(product_t) :: solver
      integer :: i

      do i = 1, rows
         call make_product(reference(i)%outcome%contact_time/usual_steps, direct_accuracy, solver)
         call check_direct(solver, i, merge(smooth_tolerance, singular_tolerance, &
            reference(i)%exponential), " direct 1400 steps")
      end do
   end subroutine test_direct_steps

   !> All impacts by product integration that chooses its steps
   subroutine test_direct_default()
      type(product_t) :: solver
      type(outcome_t) :: outcome
      integer :: i

      call make_product(0.0_wp, direct_accuracy, solver)
      do i = 1, rows
         call check_direct(solver, i, direct_accuracy, " direct", outcome)
         associate (r => reference(i)%outcome, name => trim(reference(i)%name)//" direct")
            call check(max(outcome%cor_error, outcome%cor_sphere_error) <= direct_accuracy, &
               name//": by its own estimate as well")
            call check_honest(outcome, r, direct_accuracy, name)
         end associate
      end do
   end subroutine test_direct_default

   !> One impact by product integration
   subroutine check_direct(solver, i, tolerance, way, result)
      !> The solver
      type(product_t), intent(inout) :: solver
      !> Row of the reference
      integer, intent(in) :: i
      !> Tolerance of both coefficients of restitution
      real(wp), intent(in) :: tolerance
      !> What to add to the name of the case
      character(len=*), intent(in) :: way
      !> The outcome
      type(outcome_t), intent(out), optional :: result

      ! of the maxima and energies, where a step is given; maxima by chosen steps are extrapolated
      real(wp), parameter :: peak_share = 10.0_wp
      type(outcome_t) :: outcome

      call run(solver, impact(i), outcome)
      associate (r => reference(i)%outcome, name => trim(reference(i)%name)//way)
         call check(outcome%status == contact_separated, name//": the bodies separate")
         call check_close(outcome%cor, r%cor, tolerance, name//": cor")
         call check_close(outcome%cor_sphere, r%cor_sphere, tolerance, name//": cor_sphere")
         call check_relative(outcome%max_indentation, r%max_indentation, peak_share*tolerance, &
            name//": max_indentation")
         call check_relative(outcome%max_force, r%max_force, peak_share*tolerance, &
            name//": max_force")
         call check_close(outcome%wave_energy/r%initial_energy, r%wave_energy/r%initial_energy, &
            peak_share*tolerance, name//": wave_energy")
      end associate
      if (present(result)) result = outcome
   end subroutine check_direct

   !> Check that the estimates of the errors are some
   subroutine check_honest(outcome, r, accuracy, name)
      !> The outcome
      type(outcome_t), intent(in) :: outcome
      !> What it is to be
      type(outcome_t), intent(in) :: r
      !> Accuracy asked for, as far as it is promised
      real(wp), intent(in) :: accuracy
      !> Name of the case
      character(len=*), intent(in) :: name

      call check_estimate(outcome%cor_error, outcome%cor - r%cor, accuracy, name//": cor_error")
      call check_estimate(outcome%cor_sphere_error, outcome%cor_sphere - r%cor_sphere, accuracy, &
         name//": cor_sphere_error")
   end subroutine check_honest

   !> Check an estimated error against the true one
   subroutine check_estimate(estimate, error, accuracy, name)
      !> The estimate
      real(wp), intent(in) :: estimate
      !> The error
      real(wp), intent(in) :: error
      !> Accuracy asked for, as far as it is promised
      real(wp), intent(in) :: accuracy
      !> Names of the case and of the estimate
      character(len=*), intent(in) :: name

      call check(abs(error) <= too_small*estimate, name//" is not too small")
      call check(estimate <= too_large*abs(error) + estimate_floor*accuracy + rounding, &
         name//" is not too large")
   end subroutine check_estimate

end program test_reference
