!> The public interface as another program uses it: every name of module vcor, and no other module
!> of the library. What the procedures compute is tested where they are; here it is that they fit
!> together
program test_library
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan, ieee_positive_inf, ieee_quiet_nan, &
      ieee_value
   use vcor, only : base_bonded, base_free, base_half_space, base_sliding, case_t, case_text, &
      cerf_t, contact_lasting, contact_law_t, contact_modulus_t, contact_resting, &
      contact_separated, contact_sticking, error_file, error_input, error_numerical, error_t, &
      error_usage, face_t, failures_t, history_table, impact_t, inputs_t, material_t, &
      mittag_leffler_t, new_beam, new_block, new_cerf, new_contact_law, new_contact_modulus, &
      new_elastic, new_face, new_impact, new_mittag_leffler, new_panel, new_plate, new_power_law, &
      new_prony, new_rigid, new_rod, new_sls, new_solver, new_structure, new_sweep, new_tabulated, &
      new_target, outcome_t, override, pair_eq1, pair_series, power_law_t, problem_of_case, &
      problem_t, prony_t, read_case, read_case_text, read_data, solve_impact, solve_sweep, &
      solver_settings_t, solver_t, structure_t, summary_t, summary_table, support_cantilever, &
      support_clamped, support_free, support_supported, sweep_t, table_t, tabulated_t, target_t, &
      trajectory_t, validate, version, waves_constant, waves_frozen, waves_hereditary, waves_none, &
      waves_relaxing, wp, write_csv, write_hdf5
   use vcor_test, only : check, check_close, check_contains, check_relative, finish, suite
   implicit none

   !> COR of the paper's SLS plate at 10 m/s by `vcor verify`, and the accuracy of method ive
   real(wp), parameter :: sls_cor = 0.431986898647_wp, tolerance = 1.0e-8_wp
   !> The same case by a file
   character(len=*), parameter :: sls_file = 'examples/paper/sls.nml'

   call suite("library")
   call check(index(version, '.') > 0, "the version has a dot")
   call test_materials()
   call test_unbuilt()
   call test_impacts()
   call test_structures()
   call test_refusals()
   call test_case()
   call test_inputs()
   call test_errors()
   call test_sweep()
   call finish()

contains

   !> Check that nothing went wrong
   subroutine success(error, what)
      !> Unallocated on success
      type(error_t), allocatable, intent(in) :: error
      !> What was done
      character(len=*), intent(in) :: what

      if (allocated(error)) then
         call check(.false., what//": "//error%message)
      else
         call check(.true., what)
      end if
   end subroutine success

   !> One modulus of each model: E = 1 + 2 f(t) MPa at t = 1 s
   subroutine test_materials()
      real(wp), parameter :: mega = 1.0e6_wp, e = exp(1.0_wp)
      type(prony_t) :: prony
      type(power_law_t) :: power_law
      type(cerf_t) :: cerf
      type(mittag_leffler_t) :: mittag_leffler
      type(tabulated_t) :: tabulated
      type(error_t), allocatable :: error

      call new_rigid(prony)
      call check(prony%rigid, "a rigid body is one")
      call new_elastic(prony, mega, error)
      call success(error, "an elastic solid is built")
      call compare(prony, 1.0_wp, "elastic")
      call new_sls(prony, 3.0_wp*mega, 1.0_wp, 3.0_wp, error)
      call success(error, "an SLS is built")
      call compare(prony, 1.0_wp + 2.0_wp*e**(-3), "sls")
      call new_prony(prony, mega, [2.0_wp*mega], [1.0_wp], 0.0_wp, error)
      call success(error, "a Prony series is built")
      call compare(prony, 1.0_wp + 2.0_wp/e, "prony")
      call new_power_law(power_law, mega, 2.0_wp*mega, 0.5_wp, error)
      call success(error, "a power law is built")
      call compare(power_law, 1.0_wp + 2.0_wp/sqrt(acos(-1.0_wp)), "power law")
      call new_cerf(cerf, mega, 2.0_wp*mega, 1.0_wp, error)
      call success(error, "a CERF is built")
      call compare(cerf, 1.0_wp + 2.0_wp*e*erfc(1.0_wp), "cerf")
      call new_mittag_leffler(mittag_leffler, mega, 2.0_wp*mega, 0.5_wp, 1.0_wp, error)
      call success(error, "a Mittag-Leffler material is built")
      call compare(mittag_leffler, 1.0_wp + 2.0_wp*e*erfc(1.0_wp), "mittag_leffler, a = 1/2")
      call new_tabulated(tabulated, [0.1_wp, 1.0_wp, 10.0_wp], [3.0_wp, 2.0_wp, 1.0_wp]*mega, error)
      call success(error, "a table is built")
      call compare(tabulated, 2.0_wp, "table")
   end subroutine test_materials

   !> Compare a modulus at 1 s
   subroutine compare(material, modulus, what)
      class(material_t), intent(in) :: material
      !> Expected modulus [MPa]
      real(wp), intent(in) :: modulus
      !> Name of the model
      character(len=*), intent(in) :: what

      real(wp), parameter :: mega = 1.0e6_wp, rounding = 1.0e-12_wp

      call check_relative(material%relaxation(1.0_wp), modulus*mega, rounding, &
         what//": modulus at 1 s")
   end subroutine compare

   !> What nothing has built is refused or gives NaN
   subroutine test_unbuilt()
      type(prony_t) :: prony, steel
      type(power_law_t) :: power_law
      type(cerf_t) :: cerf
      type(mittag_leffler_t) :: mittag_leffler
      type(tabulated_t) :: tabulated
      type(trajectory_t) :: trajectory
      type(target_t) :: plate
      type(contact_modulus_t) :: modulus
      type(error_t), allocatable :: error
      real(wp), allocatable :: state(:, :)
      complex(wp) :: dynamic

      call new_elastic(prony, -1.0_wp, error)
      call refused(error, error_input, "a negative modulus")
      call check_unbuilt(prony, "prony")
      call check_unbuilt(power_law, "power_law")
      call check_unbuilt(cerf, "cerf")
      call check_unbuilt(mittag_leffler, "mittag_leffler")
      call check_unbuilt(tabulated, "table")
      call new_rigid(steel)
      call new_contact_modulus(modulus, prony, steel, .true., error)
      call refused(error, error_input, "an unbuilt sphere")
      call new_contact_modulus(modulus, steel, tabulated, .false., error)
      call refused(error, error_input, "an unbuilt block")
      dynamic = modulus%dynamic_modulus(1.0_wp)
      call check(all(ieee_is_nan([modulus%relaxation(1.0_wp), modulus%rate(1.0_wp), &
         modulus%integral(1.0_wp), modulus%mean_integral(1.0_wp), real(dynamic, wp), &
         modulus%step_integrals(1.0_wp, 2), modulus%glassy(), modulus%rubbery()])), &
         "an unbuilt contact modulus is NaN")
      call new_plate(plate, prony, 0.01_wp, waves_relaxing, error)
      call refused(error, error_input, "a plate of an unbuilt material")
      call trajectory%sample(10, state)
      call check(all(ieee_is_nan(state)), "a trajectory that nothing solved has no state")
      call check(ieee_is_nan(trajectory%indentation_at(0.0_wp)), "nor an indentation")
   end subroutine test_unbuilt

   !> Check that the numbers of a material are NaN
   subroutine check_unbuilt(material, what)
      class(material_t), intent(in) :: material
      !> Name of the model
      character(len=*), intent(in) :: what

      real(wp) :: modulus(1)
      complex(wp) :: complex_modulus

      call material%relaxation_at([1.0_wp], modulus)
      complex_modulus = material%complex_modulus((0.0_wp, 1.0_wp))
      call check(all(ieee_is_nan([material%relaxation(1.0_wp), material%rate(1.0_wp), &
         material%integral(1.0_wp), material%glassy(), material%rubbery(), modulus, &
         real(complex_modulus, wp)])), "the moduli of an unbuilt "//what//" are NaN")
   end subroutine check_unbuilt

   !> A steel ball on rubber: every plate, law and pair, by the default and by another method
   subroutine test_impacts()
      integer, parameter :: waves(5) = [waves_none, waves_constant, waves_relaxing, &
         waves_hereditary, waves_frozen]
      type(prony_t) :: steel, rubber
      type(contact_modulus_t) :: modulus
      type(target_t) :: plate
      type(contact_law_t) :: law
      type(impact_t) :: impact
      type(outcome_t) :: outcome, other
      type(trajectory_t) :: trajectory
      type(solver_settings_t) :: settings
      type(error_t), allocatable :: error
      real(wp) :: mass
      integer :: i

      call new_rigid(steel)
      call new_sls(rubber, 15.0e6_wp, 300.0_wp, 1200.0_wp, error)
      call success(error, "the rubber is built")
      call rubber%set_constants(error, density=1100.0_wp, poisson_ratio=0.5_wp)
      call success(error, "density and Poisson's ratio are set")
      mass = 4.0_wp/3.0_wp*acos(-1.0_wp)*0.01_wp**3*7800.0_wp
      do i = 1, size(waves)
         call new_contact_modulus(modulus, steel, rubber, .false., error, &
            pair=merge(pair_series, pair_eq1, i == 1))
         call success(error, "the contact modulus is built")
         call new_plate(plate, rubber, 0.02_wp, waves(i), error)
         call success(error, "the plate is built")
         call new_contact_law(law, 1.5_wp, i == 2, error)
         call success(error, "the contact law is built")
         call new_impact(impact, 10.0_wp, mass, 0.01_wp, 0.0_wp, modulus, plate, error, &
            law=law)
         call success(error, "the impact is built")
         call solve_impact(impact, outcome, error)
         call success(error, "the impact is solved")
         call check(outcome%status == contact_separated .and. outcome%cor > 0.0_wp &
            .and. outcome%cor < 1.0_wp, "a ball comes back")
         if (waves(i) /= waves_relaxing) cycle
         call check_close(outcome%cor, sls_cor, tolerance, "the paper's impact")
         settings%method = 'direct'
         call solve_impact(impact, other, error, settings, trajectory)
         call success(error, "the impact is solved by another method")
         call check_close(other%cor, outcome%cor, outcome%cor_error + other%cor_error, &
            "two methods agree")
         call check(trajectory%status == other%status, "the course is that of the outcome")
      end do
   end subroutine test_impacts

   !> Structures of every kind are struck
   subroutine test_structures()

      real(wp), parameter :: mass = 4.1e-3_wp, length = 0.1_wp, highest = 1.0e7_wp, &
         spring = 1.0e8_wp
      type(prony_t) :: steel, rigid
      type(contact_modulus_t) :: modulus
      type(structure_t) :: structure
      type(target_t) :: target
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp) :: first
      integer :: i

      call new_elastic(steel, 210.0e9_wp, error)
      call steel%set_constants(error, 7850.0_wp, 0.3_wp)
      call success(error, "steel is built")
      call new_contact_modulus(modulus, steel, steel, .true., error)
      first = 0.0_wp
      do i = 1, 8
         select case (i)
         case (1)
            call new_block(structure, 0.2_wp, spring, 0.0_wp, error)
         case (2)
            ! the same as a list of modes
            call new_structure(structure, [spring/0.2_wp], [0.0_wp], [1.0_wp/0.2_wp], error)
         case (3)
            call new_rod(structure, steel, length, 0.02_wp, support_free, 0.01_wp, highest, error)
         case (4)
            call new_panel(structure, steel, length, length, 0.01_wp, [0.5_wp, 0.4_wp]*length, &
               0.01_wp, highest, error)
         case default
            call new_beam(structure, steel, length, 0.02_wp, 0.02_wp, i - 4, 0.4_wp*length, &
               0.01_wp, highest, error)
         end select
         call success(error, "a structure is built")
         call new_target(target, structure)
         call new_impact(impact, 1.0_wp, mass, 0.005_wp, 0.0_wp, modulus, target, error)
         call solve_impact(impact, outcome, error)
         call success(error, "an impact on a structure is solved")
         call check(outcome%status == contact_separated .and. outcome%cor_sphere < 1.0_wp, &
            "a structure takes energy")
         if (i == 1) first = outcome%cor_sphere
         if (i == 2) call check_close(outcome%cor_sphere, first, tolerance, &
            "a block is a list of one mode")
      end do
      call check(all([support_supported, support_clamped, support_cantilever, support_free] &
         == [1, 2, 3, 4]), "the beams had every support")
      call new_block(structure, 0.0_wp, spring, 0.0_wp, error)
      call refused(error, error_input, "a block without mass")
      call new_rigid(rigid)
      call new_rod(structure, rigid, length, 0.02_wp, support_free, 0.0_wp, highest, error)
      call refused(error, error_input, "a rigid rod")
      call new_beam(structure, steel, length, 0.0_wp, 0.01_wp, support_free, 0.0_wp, 0.0_wp, &
         highest, error)
      call refused(error, error_input, "a beam without width")
      call new_panel(structure, steel, length, length, 0.01_wp, [0.5_wp, 1.5_wp]*length, 0.0_wp, &
         highest, error)
      call refused(error, error_input, "an impact beside a plate")
   end subroutine test_structures

   !> What an impact cannot be made of
   subroutine test_refusals()
      real(wp), parameter :: modulus_of = 1.0e7_wp, mass = 0.03_wp, radius = 0.01_wp
      type(prony_t) :: steel, rubber, other
      type(contact_modulus_t) :: modulus, empty
      type(target_t) :: plate
      type(impact_t) :: impact, nothing
      type(outcome_t) :: outcome
      type(trajectory_t) :: trajectory
      type(problem_t) :: problem
      type(case_t) :: case
      type(face_t) :: face
      class(solver_t), allocatable :: solver
      type(error_t), allocatable :: error
      real(wp) :: nan, infinite

      nan = ieee_value(nan, ieee_quiet_nan)
      infinite = ieee_value(infinite, ieee_positive_inf)
      call new_rigid(steel)
      call new_elastic(rubber, modulus_of, error)
      call success(error, "rubber is built")
      call new_prony(other, infinite, [modulus_of], [1.0_wp], 0.0_wp, error)
      call refused(error, error_input, "an infinite modulus")
      call new_prony(other, 0.0_wp, [modulus_of], [infinite], 0.0_wp, error)
      call refused(error, error_input, "an infinite rate")
      call new_contact_modulus(modulus, steel, rubber, .false., error, pair=55)
      call refused(error, error_input, "an unknown pair")
      call new_plate(plate, rubber, 0.02_wp, 77, error)
      call refused(error, error_input, "unknown waves")
      call new_contact_modulus(modulus, steel, rubber, .false., error)
      call success(error, "the contact modulus is built")
      call new_plate(plate, rubber, 0.0_wp, waves_none, error)
      call success(error, "the plate is built")
      call new_impact(impact, 1.0_wp, mass, radius, nan, modulus, plate, error)
      call refused(error, error_input, "a surface of no radius")
      call new_impact(impact, 1.0_wp, mass, radius, 0.0_wp, modulus, plate, error, gravity=-9.8_wp)
      call refused(error, error_input, "negative gravity")
      call new_impact(impact, 1.0_wp, mass, radius, 0.0_wp, modulus, plate, error, gravity=nan)
      call refused(error, error_input, "gravity that is not a number")
      call new_impact(impact, 1.0_wp, mass, radius, 0.0_wp, empty, plate, error)
      call refused(error, error_input, "an empty contact modulus")
      call solve_impact(nothing, outcome, error)
      call refused(error, error_input, "an empty impact")
      call check(outcome%status /= contact_separated, "a failure is not a separation")
      call problem%solve(trajectory, outcome, error)
      call refused(error, error_input, "an empty problem")
      call problem_of_case(problem, case, error)
      call refused(error, error_input, "an empty case")
      call new_impact(impact, 1.0_wp, mass, radius, 0.0_wp, modulus, plate, error)
      call success(error, "the impact is built")
      call new_solver(solver, solver_settings_t(accuracy=1.0e-20_wp), impact, error)
      call refused(error, error_input, "an accuracy that nothing reaches")
      call new_solver(solver, solver_settings_t(time_step=-1.0_wp), impact, error)
      call refused(error, error_input, "a negative step")
      call new_solver(solver, solver_settings_t(), impact, error)
      call success(error, "a solver is built")
      call solve_impact(solver, impact, trajectory, outcome, error)
      call success(error, "an impact is solved by it")
      call check_close(outcome%resilience, outcome%cor_sphere**2, 0.0_wp, "its resilience")
      call rubber%set_constants(error, density=1100.0_wp, poisson_ratio=0.45_wp)
      call success(error, "the density is set")
      call new_plate(plate, rubber, 0.0_wp, waves_none, error)
      call new_face(face, rubber, steel, base_free, 0.1_wp, .true., error)
      call success(error, "the face of a plate with waves is built")
      call check(all([base_half_space, base_bonded, base_sliding] /= base_free), "four bases")
      call new_impact(impact, 1.0_wp, mass, radius, 0.0_wp, modulus, plate, error, face=face)
      call solve_impact(impact, outcome, error)
      call success(error, "an impact on a plate with waves is solved")
      call check(ieee_is_nan(outcome%wave_energy), "its waves are not apart from the contact")
      call solve_impact(impact, outcome, error, solver_settings_t(method='ive'))
      call refused(error, error_input, "internal variables for waves in a plate")
   end subroutine test_refusals

   !> A case file, and the tables of its results
   subroutine test_case()
      type(case_t) :: case
      type(inputs_t) :: inputs
      type(problem_t) :: problem
      type(outcome_t) :: outcome
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error
      type(table_t) :: table

      call read_case(case, sls_file, error)
      if (.not. allocated(error)) call override(case, 'impact.velocity=10', error)
      if (.not. allocated(error)) call validate(case, error)
      if (.not. allocated(error)) call read_data(case, error)
      call success(error, "a case is read")
      call problem_of_case(problem, case, error)
      call success(error, "impact and solver of a case are built")
      call problem%solve(trajectory, outcome, error)
      call success(error, "the impact of a case is solved")
      call check_close(outcome%cor, sls_cor, tolerance, "the paper's impact by its case")
      call history_table(table, 'sls', case_text(case, complete=.true.), problem%impact, trajectory)
      call check_contains(table%case_text, 'velocity', "a table has its case")
      call write_csv('no/such/folder/x.csv', table, error)
      call refused(error, error_file, "no folder for a text")
      call write_hdf5('no/such/folder/x.h5', [table], error)
      call refused(error, error_file, "no folder for an HDF5 file")
      ! a plate of a tenth of a millimetre absorbs the impact
      inputs = problem%inputs
      inputs%half_thickness = 1.0e-4_wp
      call problem%build(inputs, error)
      call success(error, "the impact of other inputs is built")
      call solve_impact(problem%impact, outcome, error)
      call check(allocated(error) .or. any(outcome%status &
         == [contact_sticking, contact_lasting, contact_resting]), &
         "a ball on a foil does not come back")
   end subroutine test_case

   !> A problem builds what differs: after the inputs of any other case it is that of its case alone
   subroutine test_inputs()
      character(len=*), parameter :: names(*) = [character(len=24) :: 'ball_on_anvil', &
         'ball_on_wood_panel', 'coating_on_steel', 'cone_into_gel', 'granular_pair', &
         'polyurea_ball_in_seat', 'rubber_pad_on_steel', 'steel_on_measured_rubber', &
         'paper/sls', 'paper/butyl_prony_frozen', 'paper/butyl_power_law']
      type(case_t) :: case
      type(inputs_t) :: inputs(size(names))
      type(outcome_t) :: alone(size(names)), found
      type(problem_t) :: problem, one
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error
      integer :: i, j, k, place

      do i = 1, size(names)
         call read_case(case, 'examples/'//trim(names(i))//'.nml', error)
         if (.not. allocated(error)) call validate(case, error)
         if (.not. allocated(error)) call read_data(case, error)
         if (.not. allocated(error)) call problem_of_case(problem, case, error)
         if (.not. allocated(error)) call problem%solve(trajectory, alone(i), error)
         call success(error, trim(names(i))//" is solved alone")
         inputs(i) = problem%inputs
      end do
      do i = 1, size(names)
         do j = i, size(names)
            do k = 0, 1
               place = merge(i, j, k == 0)
               call one%build(inputs(place), error)
               if (.not. allocated(error)) call one%solve(trajectory, found, error)
               call success(error, trim(names(place))//" is solved after another case")
               associate (wanted => alone(place))
                  call check_close([found%cor, found%max_force, found%contact_time, &
                     found%hysteresis_energy, found%cor_error], [wanted%cor, wanted%max_force, &
                     wanted%contact_time, wanted%hysteresis_energy, wanted%cor_error], 0.0_wp, &
                     trim(names(place))//" is the same after another case")
               end associate
            end do
         end do
      end do
   end subroutine test_inputs

   !> Each kind of error
   subroutine test_errors()
      type(case_t) :: case
      type(error_t), allocatable :: error

      call read_case(case, 'no/such/case.nml', error)
      call refused(error, error_file, "no file")
      call read_case_text(case, '&impact velocity = 1 speed = 2 /', 'text', error)
      call refused(error, error_input, "no key")
      call read_case(case, sls_file, error)
      call success(error, "the case is read")
      call override(case, 'impact.velocity', error)
      call refused(error, error_usage, "no value")
      call check(all(error_numerical /= [error_file, error_input, error_usage]), &
         "each kind has its code")
   end subroutine test_errors

   !> Check the code of an error
   subroutine refused(error, code, what)
      !> Unallocated where there is none, which fails
      type(error_t), allocatable, intent(in) :: error
      !> Expected code
      integer, intent(in) :: code
      !> What was done
      character(len=*), intent(in) :: what

      integer :: found

      found = 0
      if (allocated(error)) found = error%code
      call check(found == code, what)
   end subroutine refused

   !> A sweep of velocities
   subroutine test_sweep()
      character(len=*), parameter :: nl = new_line('a')
      type(case_t) :: case
      type(sweep_t) :: sweep, unbuilt
      type(summary_t) :: summary
      type(failures_t) :: failures
      type(table_t) :: table
      type(error_t), allocatable :: error

      call read_case(case, sls_file, error)
      call success(error, "the case is read")
      call read_case_text(case, case_text(case, complete=.false.)//nl//'&sweep parameter = ' &
         //"'impact.velocity', values = 2.5, 5, 10 /", 'sweep', error)
      if (.not. allocated(error)) call validate(case, error)
      if (.not. allocated(error)) call new_sweep(sweep, case, error)
      call success(error, "a sweep is built")
      call solve_sweep(sweep, 2, summary, failures, error)
      call success(error, "its points are solved")
      call check(failures%count == 0, "all points have a result")
      call check(summary%quantities(1)%name == 'cor', "the first quantity is the COR")
      call check_close(summary%values(1)%reals(3), sls_cor, tolerance, "the last point")
      call solve_sweep(sweep, 0, summary, failures, error)
      call check(allocated(error), "no thread solves nothing")
      call solve_sweep(unbuilt, 1, summary, failures, error)
      call check(allocated(error), "a sweep that is not built is refused")
      call solve_sweep(sweep, 1, summary, failures, error)
      call success(error, "the points are solved again")
      call summary_table(table, 'sweep', case_text(case, complete=.true.), sweep%grid, summary)
      call check_close(table%columns(1)%reals(3), sls_cor, tolerance, "the same in the table")
   end subroutine test_sweep

end program test_library
