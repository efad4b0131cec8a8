!> The coupled contact: limits in which it is known, references, honesty and independence of meshes
program test_coupled
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_contact, only : new_contact_modulus, pair_series
   use vcor_impact_face, only : base_bonded, base_free, base_half_space, base_sliding, base_thin, &
      face_t, new_face
   use vcor_impact_history, only : history, history_columns
   use vcor_impact_law, only : cone_factor, new_contact_law, profile_factor, punch_factor
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_target, only : waves_none
   use vcor_impact_problem, only : impact_t
   use vcor_impact_response, only : static_response, wave_response
   use vcor_impact_trajectory, only : col_force, col_impulse, col_indentation, col_sphere, &
      col_sphere_velocity, col_time, contact_lasting, contact_resting, contact_separated, &
      trajectory_t
   use vcor_kinds, only : pi, wp
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_rigid, prony_t
   use vcor_material_type, only : material_t
   use vcor_solver_coupled, only : coupled_t, new_coupled
   use vcor_solver_coupled_course, only : course_ended, course_t
   use vcor_solver_coupled_kernel, only : kernel_t, mesh_t, new_kernel
   use vcor_solver_coupled_march, only : march
   use vcor_solver_coupled_peak, only : peak, peak_t
   use vcor_solver_coupled_rule, only : differences, integrals, nodes, weights
   use vcor_solver_coupled_spectrum, only : spectrum_t
   use vcor_solver_ive, only : ive_t
   use vcor_solver_type, only : default_accuracy, solver_settings_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : make_ive, random_t, refused, rigid_on_plate, &
      run, success
   implicit none

   !> What a result promises by default
   real(wp), parameter :: accuracy = 1.0e-5_wp

   call suite("coupled")
   call test_response()
   call test_limits_of_response()
   call test_weights()
   call test_peak()
   call test_references()
   call test_elastic()
   call test_static()
   call test_zener()
   call test_thin_plate()
   call test_approach_to_thin()
   call test_half_space_loss()
   call test_passive()
   call test_meshes()
   call test_edge()
   call test_edge_of_memory()
   call test_sharing()
   call test_settled()
   call test_punch()
   call test_gravity()
   call test_end_of_contact()
   call test_fast_end()
   call test_blunt_end()
   call test_end_by_steps()
   call test_units()
   call test_early_force()
   call test_no_end()
   call test_refusals()
   call finish()

contains

   !> L - 1 against the equations of motion and the conditions on both sides of the layer.
   !> Potentials f of dilatation, f'' = a^2 f, and g of shear, g'' = b^2 g, have the displacements
   !> f' + k g along z and -k f - g' along r, and the stresses mu ((k^2 + b^2) f + 2 k g') and
   !> mu (-2 k f' - (k^2 + b^2) g)
   subroutine test_response()
      ! the system has waves that grow and decay over the layer
      real(wp), parameter :: tolerance = 1.0e-9_wp
      integer, parameter :: bases(4) = [base_half_space, base_free, base_bonded, base_sliding]
      type(random_t) :: random
      complex(wp) :: p, matrix(4, 4), right(4), expected, face(4)
      real(wp) :: k, nu, thickness, q
      complex(wp) :: a, b
      integer :: i, j

      do i = 1, 200
         do j = 1, size(bases)
            k = random%log_between(0.3_wp, 5.0_wp)
            thickness = random%log_between(0.3_wp, 1.5_wp)
            nu = random%between(-0.5_wp, 0.5_wp)
            p = random%log_between(0.2_wp, 5.0_wp)*exp(cmplx(0.0_wp, random%between(-1.5_wp, &
               1.5_wp), wp))
            q = (1.0_wp - 2.0_wp*nu)/(2.0_wp*(1.0_wp - nu))
            a = sqrt(k**2 + q*p**2)
            b = sqrt(k**2 + p**2)
            ! f and g are sums of exp(-a z) and exp(-b z) from the face and, the last two, from the
            ! bottom; face: displacement, then rows: stresses of the face, conditions at the bottom
            face = [-a, cmplx(k, 0.0_wp, wp), a*exp(-a*thickness), k*exp(-b*thickness)]
            matrix(1, :) = [k**2 + b**2, -2.0_wp*k*b, (k**2 + b**2)*exp(-a*thickness), &
               2.0_wp*k*b*exp(-b*thickness)]
            matrix(2, :) = [2.0_wp*k*a, -(k**2 + b**2), -2.0_wp*k*a*exp(-a*thickness), &
               -(k**2 + b**2)*exp(-b*thickness)]
            associate (ea => exp(-a*thickness), eb => exp(-b*thickness), s => k**2 + b**2)
               select case (bases(j))
               case (base_half_space)
                  matrix(3, :) = [0.0_wp, 0.0_wp, 1.0_wp, 0.0_wp]
                  matrix(4, :) = [0.0_wp, 0.0_wp, 0.0_wp, 1.0_wp]
               case (base_free)
                  matrix(3, :) = [s*ea, -2.0_wp*k*b*eb, s, 2.0_wp*k*b]
                  matrix(4, :) = [2.0_wp*k*a*ea, -s*eb, -2.0_wp*k*a, -s]
               case (base_bonded)
                  matrix(3, :) = [-a*ea, k*eb, a, cmplx(k, 0.0_wp, wp)]
                  matrix(4, :) = [-k*ea, b*eb, cmplx(-k, 0.0_wp, wp), -b]
               case default
                  matrix(3, :) = [-a*ea, k*eb, a, cmplx(k, 0.0_wp, wp)]
                  matrix(4, :) = [2.0_wp*k*a*ea, -s*eb, -2.0_wp*k*a, -s]
               end select
            end associate
            right = [-1.0_wp, 0.0_wp, 0.0_wp, 0.0_wp]
            call solve_complex(matrix, right)
            expected = k/(1.0_wp - nu)*sum(face*right) - 1.0_wp
            call check(abs(wave_response(bases(j), nu, thickness, k, p) - expected) &
               <= tolerance*(1.0_wp + abs(expected)), "L meets the conditions of the layer")
         end do
      end do
   end subroutine test_response

   !> Solve a complex system by elimination with pivots
   subroutine solve_complex(matrix, right)
      !> The matrix, destroyed on return
      complex(wp), intent(inout) :: matrix(:, :)
      !> Right-hand side, on return the solution
      complex(wp), intent(inout) :: right(:)

      complex(wp) :: row(size(right)), value
      integer :: i, j, pivot

      do i = 1, size(right)
         pivot = i - 1 + maxloc(abs(matrix(i:, i)), 1)
         row = matrix(i, :)
         matrix(i, :) = matrix(pivot, :)
         matrix(pivot, :) = row
         value = right(i)
         right(i) = right(pivot)
         right(pivot) = value
         do j = i + 1, size(right)
            value = matrix(j, i)/matrix(i, i)
            matrix(j, :) = matrix(j, :) - value*matrix(i, :)
            right(j) = right(j) - value*right(i)
         end do
      end do
      do i = size(right), 1, -1
         right(i) = (right(i) - sum(matrix(i, i + 1:)*right(i + 1:)))/matrix(i, i)
      end do
   end subroutine solve_complex

   !> Weights of a derivative, sum integrals W_n-j dt = differences, for numbers of steps that are
   !> powers of two times an odd number, small or large
   subroutine test_weights()
      integer, parameter :: steps(3) = [160, 148, 4]
      real(wp), parameter :: rounding = 1.0e-7_wp, dt = 0.01_wp
      real(wp), allocatable :: weight(:, :)
      real(wp) :: expected
      integer :: i, n

      do i = 1, size(steps)
         weight = weights(reshape(dt*nodes(steps(i), dt), [1, steps(i)/2 + 1]))
         do n = 0, steps(i) - 1
            expected = 0.0_wp
            if (n <= 2) expected = differences(n)
            ! weights begin with 1
            call check_close(sum(integrals(:min(n, 2))*weight(1, n + 1:n + 1 - min(n, 2):-1)), &
               expected, rounding*abs(differences(0)), "weights of a derivative")
         end do
      end do
   end subroutine test_weights

   !> The top of a sine between its steps, and its error where the values scatter
   subroutine test_peak()
      integer, parameter :: steps = 160
      real(wp), parameter :: noise = 1.0e-3_wp
      type(random_t) :: random
      type(peak_t) :: top
      real(wp) :: value(0:steps)
      integer :: i, n, missed

      value = [(sin(pi*real(i, wp)/(real(steps, wp) - 0.3_wp)), i=0, steps)]
      top = peak(value, 1.0_wp)
      call check_close(top%value, 1.0_wp, 1.0e-7_wp, "the top of a sine")
      call check_close(top%time, 0.5_wp*(real(steps, wp) - 0.3_wp), 1.0e-3_wp, "its time")
      call check(top%scatter <= 1.0e-7_wp, "a sine does not scatter")
      missed = 0
      do n = 1, 100
         top = peak(value + noise*[(random%between(-1.0_wp, 1.0_wp), i=0, steps)], 1.0_wp)
         if (abs(top%value - 1.0_wp) > 3.0_wp*top%scatter) missed = missed + 1
         call check(top%scatter <= noise, "the top scatters less than its values")
      end do
      call check(missed <= 2, "the top is within three errors")
   end subroutine test_peak

   !> Thick layers are half spaces, slow waves are none, and small differences keep their digits
   subroutine test_limits_of_response()
      real(wp), parameter :: digits = 1.0e-10_wp, slow = 1.0e-5_wp
      complex(wp), parameter :: p = (0.3_wp, 2.0_wp)
      real(wp), parameter :: nu = 0.35_wp
      complex(wp) :: half_space
      real(wp) :: y
      integer :: base

      half_space = wave_response(base_half_space, nu, 0.0_wp, 1.3_wp, p)
      do base = base_free, base_sliding
         call check(abs(wave_response(base, nu, 300.0_wp, 1.3_wp, p) - half_space) <= digits, &
            "a thick layer is a half space")
      end do
      do base = base_bonded, base_sliding
         call check_close(real(wave_response(base, nu, 1.0_wp, 1.3_wp, cmplx(slow, 0.0_wp, &
            wp)), wp), static_response(base, nu, 1.3_wp), 10.0_wp*slow**2, "slow waves are none")
      end do
      call check_close(static_response(base_bonded, nu, 0.0_wp), -1.0_wp, digits, &
         "a bonded layer does not yield to a uniform pressure at rest")
      ! L - 1 = -y (3 - 4 q + 3 q^2)/(4 (1 - q)) + O(y^2), q = 3/13
      y = 1.0e-12_wp
      call check_relative(real(wave_response(base_half_space, nu, 0.0_wp, 1.0_wp, &
         cmplx(sqrt(y), 0.0_wp, wp)), wp), -y*(3.0_wp - 12.0_wp/13.0_wp + 27.0_wp/169.0_wp) &
         /(40.0_wp/13.0_wp), digits, "a small difference from the half space at rest")
   end subroutine test_limits_of_response

   !> A ball, a plate and what strikes it otherwise
   subroutine make_impact(impact, plate, base, thickness, velocity, mass, factor, exponent, &
                          has_waves, striker, gravity)
      type(impact_t), intent(out) :: impact
      !> Material with density and Poisson's ratio
      class(material_t), intent(in) :: plate
      !> One of the `base_*` constants
      integer, intent(in) :: base
      !> Thickness [m]; 0 for a half space
      real(wp), intent(in) :: thickness
      !> Velocity [m/s], mass [kg] and factor K of the shape
      real(wp), intent(in) :: velocity, mass, factor
      !> Exponent of the law; absent: Hertz's
      real(wp), intent(in), optional :: exponent
      !> Whether the plate has inertia; absent: it has
      logical, intent(in), optional :: has_waves
      !> Material of the striker; absent: rigid
      class(material_t), intent(in), optional :: striker
      !> Gravity [m/s2]; absent: 0
      real(wp), intent(in), optional :: gravity

      class(material_t), allocatable :: other
      type(prony_t) :: rigid
      type(error_t), allocatable :: error
      logical :: waves

      call new_rigid(rigid)
      if (present(striker)) then
         allocate (other, source=striker)
      else
         allocate (other, source=rigid)
      end if
      waves = .true.
      if (present(has_waves)) waves = has_waves
      call new_contact_modulus(impact%modulus, other, plate, .false., error, pair_series)
      if (.not. allocated(error)) call new_face(impact%face, plate, other, base, thickness, waves, &
         error)
      if (present(exponent) .and. .not. allocated(error)) &
         call new_contact_law(impact%law, exponent, .false., error)
      if (.not. allocated(error)) call impact%launch(velocity, mass, factor, error, gravity)
      if (allocated(error)) call success(error, "an impact is built")
   end subroutine make_impact

   !> An elastic or Prony material
   function solid(equilibrium, moduli, rates, density, poisson_ratio) result(material)
      !> Moduli [Pa], rates [1/s], density [kg/m3] and Poisson's ratio
      real(wp), intent(in) :: equilibrium, moduli(:), rates(:), density, poisson_ratio
      type(prony_t) :: material

      type(error_t), allocatable :: error

      call new_prony(material, equilibrium, moduli, rates, 0.0_wp, error)
      call material%set_constants(error, density=density, poisson_ratio=poisson_ratio)
   end function solid

   !> The paper's rubber
   function rubber(poisson_ratio) result(material)
      !> Poisson's ratio
      real(wp), intent(in) :: poisson_ratio
      type(prony_t) :: material

      material = solid(3.75e6_wp, [11.25e6_wp], [1200.0_wp], 1100.0_wp, poisson_ratio)
   end function rubber

   !> Factor of a sphere
   pure function sphere(radius) result(factor)
      !> Radius [m]
      real(wp), intent(in) :: radius
      real(wp) :: factor

      factor = 4.0_wp/3.0_wp*sqrt(radius)
   end function sphere

   !> Solve an impact by a new solver
   subroutine solve(impact, trajectory, asked)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(out) :: trajectory
      !> Accuracy asked for; absent: the default
      real(wp), intent(in), optional :: asked

      type(coupled_t), allocatable :: solver
      type(solver_settings_t) :: settings
      type(error_t), allocatable :: error

      if (present(asked)) settings%accuracy = asked
      allocate (solver)
      call new_coupled(solver, settings)
      call solver%solve(impact, trajectory, error)
      if (allocated(error)) call success(error, "an impact is solved")
   end subroutine solve

   !> Coefficient of restitution of the sphere
   pure function cor_of(impact, trajectory) result(cor)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      real(wp) :: cor

      cor = -trajectory%state(col_sphere_velocity, trajectory%last)/impact%velocity
   end function cor_of

   !> Check a coefficient within three times its stated error, and within the default accuracy
   subroutine check_cor(impact, trajectory, expected, what)
      type(impact_t), intent(in) :: impact
      type(trajectory_t), intent(in) :: trajectory
      !> Coefficient
      real(wp), intent(in) :: expected
      !> What is checked
      character(len=*), intent(in) :: what

      ! last digit of the references
      real(wp), parameter :: rounding = 1.0e-7_wp

      call check(trajectory%status == contact_separated, what//": the bodies separate")
      call check(trajectory%cor_sphere_error <= accuracy, what//": to the accuracy asked for")
      call check_close(cor_of(impact, trajectory), expected, &
         min(accuracy, 3.0_wp*trajectory%cor_sphere_error) + rounding, what)
   end subroutine check_cor

   !> Impacts solved to 7 digits by a program with another discretisation, and partly checked by
   !> finite elements (tests/reference/coupled_elements.py)
   subroutine test_references()
      real(wp), parameter :: steel_ball = 0.0326725635973338_wp, none(0) = 0.0_wp
      type(impact_t) :: impact
      type(prony_t) :: steel
      type(power_law_t) :: fractional
      type(error_t), allocatable :: error

      call make_impact(impact, solid(70.0e9_wp, none, none, 2500.0_wp, 0.22_wp), base_free, &
         0.004_wp, 1.0_wp, 0.0002613805087786708_wp, sphere(0.002_wp))
      call expect(impact, 0.82696409_wp, 1.67211e-5_wp, 52.7954_wp, "a ball on 4 mm of glass")
      steel = solid(210.0e9_wp, none, none, 7800.0_wp, 0.3_wp)
      call make_impact(impact, steel, base_half_space, 0.0_wp, 3.0_wp, steel_ball, &
         sphere(0.01_wp), striker=steel)
      call expect(impact, 0.99357683_wp, 5.537e-5_wp, 6491.95_wp, "an elastic ball on steel")
      call make_impact(impact, solid(2.6e9_wp, [0.5e9_wp, 0.9e9_wp], [3.0e4_wp, 4.0e5_wp], &
         1180.0_wp, 0.35_wp), base_free, 0.003_wp, 1.0_wp, 1.0471975511965977e-5_wp, &
         sphere(0.001_wp))
      call expect(impact, 0.77433907_wp, 1.69024e-5_wp, 2.03713_wp, "a bead on 3 mm of PMMA")
      call make_impact(impact, rubber(0.5_wp), base_free, 0.04_wp, 2.0_wp, steel_ball, &
         sphere(0.01_wp))
      call expect(impact, 0.40181876_wp, 1.94335e-3_wp, 89.7197_wp, "the paper's rubber, 2 m/s")
      call make_impact(impact, rubber(0.5_wp), base_free, 0.04_wp, 10.0_wp, steel_ball, &
         sphere(0.01_wp))
      call expect(impact, 0.38090382_wp, 1.36734e-3_wp, 625.669_wp, "the paper's own impact")
      call make_impact(impact, rubber(0.5_wp), base_bonded, 0.01_wp, 2.0_wp, steel_ball, &
         sphere(0.01_wp))
      call expect(impact, 0.61184068_wp, 1.61161e-3_wp, 127.66_wp, "10 mm bonded to a floor")
      call make_impact(impact, rubber(0.48_wp), base_sliding, 0.01_wp, 2.0_wp, steel_ball, &
         sphere(0.01_wp))
      call expect(impact, 0.58138785_wp, 1.767e-3_wp, 0.0_wp, "10 mm sliding on a floor")
      call new_power_law(fractional, 2.0e6_wp, 0.3e6_wp, 0.3_wp, error)
      call fractional%set_constants(error, density=1100.0_wp, poisson_ratio=0.45_wp)
      call make_impact(impact, fractional, base_free, 0.02_wp, 2.0_wp, steel_ball, sphere(0.01_wp))
      call expect(impact, 0.23481215_wp, 3.62165e-3_wp, 47.3033_wp, "20 mm of a power law")
      call make_impact(impact, rubber(0.45_wp), base_half_space, 0.0_wp, 1.0_wp, 0.03_wp, &
         cone_factor(60.0_wp), exponent=2.0_wp)
      call expect(impact, 0.4555351_wp, 3.99527e-3_wp, 23.9918_wp, "a cone on a half space")
   end subroutine test_references

   !> Check the impact
   subroutine expect(impact, cor, contact_time, max_force, what)
      type(impact_t), intent(in) :: impact
      !> Coefficient, contact time [s] and largest force [N], 0: unknown
      real(wp), intent(in) :: cor, contact_time, max_force
      !> Its name
      character(len=*), intent(in) :: what

      type(trajectory_t) :: trajectory

      call solve(impact, trajectory)
      call check_cor(impact, trajectory, cor, what)
      call check_relative(trajectory%state(col_time, trajectory%last), contact_time, 2.0e-3_wp, &
         what//": contact time")
      if (max_force > 0.0_wp) call check_relative(trajectory%max_force, max_force, 1.0e-4_wp, &
         what//": largest force")
      call check_close(sum(trajectory%share(0:trajectory%last) &
         *trajectory%state(col_sphere_velocity, 0:trajectory%last)), impact%initial_energy() &
         *(1.0_wp - cor**2), accuracy*impact%initial_energy(), what//": energy")
   end subroutine expect

   !> An elastic contact without inertia loses nothing, and lasts as long as Hertz says
   subroutine test_elastic()
      real(wp), parameter :: none(0) = 0.0_wp, exponent(3) = [1.5_wp, 2.0_wp, 1.25_wp]
      real(wp), parameter :: factor(3) = [0.13_wp, 1.0_wp, 0.05_wp]
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      integer :: i

      do i = 1, size(exponent)
         call make_impact(impact, solid(1.0e7_wp, none, none, 1100.0_wp, 0.3_wp), base_half_space, &
            0.0_wp, 2.0_wp, 0.03_wp, factor(i), exponent(i), has_waves=.false.)
         call solve(impact, trajectory)
         call check_cor(impact, trajectory, 1.0_wp, "an elastic contact at rest loses nothing")
         call check_relative(trajectory%state(col_time, trajectory%last), &
            impact%law%contact_time*impact%time_scale(1.0e-10_wp), 1.0e-3_wp, "its contact time")
      end do
   end subroutine test_elastic

   !> Without inertia it is Ting's contact, by a solver without Ting's rule
   subroutine test_static()
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      type(trajectory_t) :: course
      type(ive_t) :: ive
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp), allocatable :: rows(:, :)
      real(wp) :: mass
      integer :: i

      call rigid_on_plate(rubber(0.5_wp), waves_none, 2.0_wp, impact)
      call new_contact_law(impact%law, 1.5_wp, .true., error)
      call make_ive(1.0e-9_wp, ive)
      call run(ive, impact, outcome)
      call ive%solve(impact, course, error)
      call history(impact, course, 50, rows)
      mass = impact%mass
      call make_impact(impact, rubber(0.5_wp), base_half_space, 0.0_wp, 2.0_wp, mass, &
         sphere(0.01_wp), has_waves=.false.)
      call solve(impact, trajectory)
      call check_cor(impact, trajectory, outcome%cor_sphere, "receding contact")
      call check_relative(trajectory%max_force, outcome%max_force, 1.0e-3_wp, &
         "receding contact: force")
      call check_relative(maxval(trajectory%radius(0:trajectory%last)), &
         sqrt(0.01_wp*outcome%max_indentation), 1.0e-3_wp, "receding contact: radius")
      do i = 1, 49
         call check_close(trajectory%radius_at(rows(col_time, i)), rows(history_columns, i), &
            1.0e-3_wp*maxval(trajectory%radius(0:trajectory%last)), "receding contact: history")
      end do
      ! a law that does not recede has the radius of its indentation
      impact%law%receding = .false.
      call ive%solve(impact, course, error)
      call history(impact, course, 50, rows)
      call check(all(abs(rows(history_columns, :) - sqrt(0.01_wp*max(rows(col_indentation, :), &
         0.0_wp))) <= 1.0e-12_wp), "Boltzmann's contact has the radius of its indentation")
   end subroutine test_static

   !> Zener's plate: an elastic impact depends on lambda = alpha m/T alone
   subroutine test_zener()
      real(wp), parameter :: lambda(3) = [0.05_wp, 0.2_wp, 1.0_wp], none(0) = 0.0_wp
      real(wp), parameter :: cor(3) = [0.917771501790_wp, 0.714044879992_wp, 0.184122874165_wp]
      type(prony_t) :: glass
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      real(wp) :: alpha, thickness
      integer :: i

      glass = solid(70.0e9_wp, none, none, 2500.0_wp, 0.22_wp)
      do i = 1, size(lambda)
         call make_impact(impact, glass, base_half_space, 0.0_wp, 1.0_wp, 2.6e-4_wp, &
            sphere(0.002_wp), has_waves=.false.)
         alpha = lambda(i)*impact%time_scale(1.0e-12_wp)/impact%mass
         thickness = sqrt(sqrt(3.0_wp*(1.0_wp - 0.22_wp**2)/(70.0e9_wp*2500.0_wp))/(4.0_wp*alpha))
         call make_impact(impact, glass, base_thin, thickness, 1.0_wp, 2.6e-4_wp, &
            sphere(0.002_wp), has_waves=.false.)
         call solve(impact, trajectory)
         call check_cor(impact, trajectory, cor(i), "Zener's plate")
      end do
   end subroutine test_zener

   !> A plate that is thin against the waves is Zener's: the loss that his theory leaves out falls
   !> as the thickness over the way of the waves during the contact
   subroutine test_thin_plate()
      real(wp), parameter :: none(0) = 0.0_wp, thickness = 0.002_wp
      real(wp), parameter :: velocity(2) = [0.5_wp, 0.5_wp/8.0_wp]
      type(prony_t) :: glass
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      real(wp) :: exact, missing(2)
      integer :: i

      glass = solid(70.0e9_wp, none, none, 2500.0_wp, 0.22_wp)
      do i = 1, size(velocity)
         call make_impact(impact, glass, base_free, thickness, velocity(i), 2.6e-4_wp, &
            sphere(0.002_wp))
         call solve(impact, trajectory)
         exact = cor_of(impact, trajectory)
         call make_impact(impact, glass, base_thin, thickness, velocity(i), 2.6e-4_wp, &
            sphere(0.002_wp), has_waves=.false.)
         call solve(impact, trajectory)
         missing(i) = (cor_of(impact, trajectory) - exact)/(1.0_wp - exact) &
            *trajectory%state(col_time, trajectory%last)
      end do
      call check_relative(missing(2), missing(1), 0.02_wp, "a thin plate is the limit, order one")
   end subroutine test_thin_plate

   !> Where the contact is small against the thickness H, the compliance of a free plate is
   !>
   !>     C = (alpha/s) [1 - (2/(5 pi)) (6 - 6 nu)^(1/2) y ln y + O(y)],   y = s H/c_s
   !>
   !> The term with ln y acts as a spring between sphere and plate, so the restitution differs from
   !> its limit by x [A ln(1/x) + B] + O(x^2 ln(x)^2), x = H/(c_s T), with A from Zener's impact
   !> with such a spring. Moduli that no material has make x fall from 0.016 to 0.002
   subroutine test_approach_to_thin()
      real(wp), parameter :: none(0) = 0.0_wp, nu = 0.5_wp, density = 1100.0_wp, mass = 0.0326726_wp
      real(wp), parameter :: modulus(2) = 1.5e18_wp*[1.0_wp, 2.0_wp**20], lambda = 0.5_wp
      ! the accuracies over x of the second plate, and x ln(x)^2 of the first
      real(wp), parameter :: a = 0.0248552_wp, tolerance = 1.0e-3_wp
      type(prony_t) :: solid_of
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      real(wp) :: off(2), scale, thickness, x(2)
      integer :: i

      do i = 1, 2
         solid_of = solid(modulus(i), none, none, density, nu)
         call make_impact(impact, solid_of, base_half_space, 0.0_wp, 10.0_wp, mass, &
            sphere(0.01_wp), has_waves=.false.)
         scale = impact%time_scale(1.0e-12_wp)
         thickness = sqrt(sqrt(3.0_wp*(1.0_wp - nu**2)/(modulus(i)*density)) &
            /(4.0_wp*lambda*scale/mass))
         x(i) = thickness/(sqrt(modulus(i)/(3.0_wp*density))*scale)
         call make_impact(impact, solid_of, base_free, thickness, 10.0_wp, mass, sphere(0.01_wp))
         call solve(impact, trajectory, 1.0e-6_wp)
         off(i) = cor_of(impact, trajectory)
         call make_impact(impact, solid_of, base_thin, thickness, 10.0_wp, mass, &
            sphere(0.01_wp), has_waves=.false.)
         call solve(impact, trajectory, 1.0e-6_wp)
         off(i) = (off(i) - cor_of(impact, trajectory))/x(i)
      end do
      call check_close((off(2) - off(1))/log(x(1)/x(2)), a, tolerance, &
         "a plate becomes thin as x ln(1/x)")
   end subroutine test_approach_to_thin

   !> A slow impact on a half space loses W = kappa int (dF/dt)^2 dt, kappa = I(nu)/(2 pi rho c_s^3)
   !> (G. F. Miller and H. Pursey, Proc. R. Soc. A 223 (1954) 521, doi:10.1098/rspa.1954.0134)
   subroutine test_half_space_loss()
      real(wp), parameter :: none(0) = 0.0_wp, nu(2) = [0.0_wp, 0.5_wp]
      ! imaginary part of Lamb's point compliance
      real(wp), parameter :: imaginary(2) = [1.3444_wp, 0.656_wp]
      real(wp), parameter :: modulus = 70.0e9_wp, density = 2500.0_wp
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      real(wp) :: loss, speed
      integer :: i

      do i = 1, size(nu)
         call make_impact(impact, solid(modulus, none, none, density, nu(i)), base_half_space, &
            0.0_wp, 0.01_wp, 2.6e-4_wp, sphere(0.002_wp))
         call solve(impact, trajectory, 1.0e-6_wp)
         speed = sqrt(modulus/(2.0_wp*(1.0_wp + nu(i))*density))
         associate (n => trajectory%last, state => trajectory%state)
            loss = imaginary(i)/(2.0_wp*pi*density*speed**3) &
               *sum((state(col_force, 1:n) - state(col_force, 0:n - 1))**2 &
               /(state(col_time, 1:n) - state(col_time, 0:n - 1)))/impact%initial_energy()
         end associate
         call check_relative(1.0_wp - cor_of(impact, trajectory)**2, loss, 0.03_wp, &
            "a slow impact on a half space loses what Miller and Pursey say")
      end do
   end subroutine test_half_space_loss

   !> Whatever the plate, an impact without weight makes no energy
   subroutine test_passive()
      type(random_t) :: random
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      real(wp) :: cor, radius
      integer :: i, base

      do i = 1, 8
         base = random%among(base_half_space, base_sliding)
         radius = random%log_between(1.0e-3_wp, 1.0e-2_wp)
         call make_impact(impact, solid(random%log_between(1.0e7_wp, 1.0e10_wp), &
            [random%log_between(1.0e6_wp, 1.0e9_wp)], [random%log_between(1.0e2_wp, 1.0e5_wp)], &
            1200.0_wp, random%between(0.0_wp, 0.5_wp)), base, &
            radius*random%log_between(0.5_wp, 20.0_wp), random%log_between(0.1_wp, 3.0_wp), &
            4.0e3_wp*radius**3, sphere(radius))
         call solve(impact, trajectory)
         cor = cor_of(impact, trajectory)
         call check(cor > 0.0_wp .and. cor < 1.0_wp, "no impact makes energy")
      end do
   end subroutine test_passive

   !> Springs, hats and steps are means: what each changes falls when it is refined
   subroutine test_meshes()
      type(impact_t) :: impact
      real(wp) :: cor

      call make_impact(impact, rubber(0.45_wp), base_free, 0.02_wp, 2.0_wp, 0.0327_wp, &
         sphere(0.01_wp))
      cor = cor_on(impact, 160, 168, 8)
      call check_close(cor_on(impact, 160, 336, 8), cor, 5.0e-6_wp, "twice as many springs")
      call check_close(cor_on(impact, 160, 168, 14), cor, 1.0e-5_wp, "more hats")
      call check_close(cor_on(impact, 160, 168, 8, 1.15_wp), cor, 1.0e-5_wp, "a longer row")
      call check_relative((cor_on(impact, 80, 168, 8) - cor) &
         /(cor - cor_on(impact, 320, 168, 8)), 4.0_wp, 0.1_wp, "second order in the step")
   end subroutine test_meshes

   !> The edge of the contact lies between two springs: without waves the force of an elastic sphere
   !> is Hertz's of the approach at each step, wherever it lies
   subroutine test_edge()
      real(wp), parameter :: none(0) = 0.0_wp, modulus = 1.0e7_wp
      type(impact_t) :: impact
      type(course_t) :: course
      integer :: first, n

      call make_impact(impact, solid(modulus, none, none, 1000.0_wp, 0.0_wp), base_half_space, &
         0.0_wp, 2.0_wp, 0.01_wp, sphere(0.01_wp), has_waves=.false.)
      course = course_on(impact, 160, 40, 5)
      call check(course%status == course_ended, "the contact ends")
      n = course%steps - 1
      first = findloc(course%force > 1.0e-3_wp*maxval(course%force), .true., dim=1) - 1
      do while (course%force(n) < 1.0e-3_wp*maxval(course%force))
         n = n - 1
      end do
      call check(n - first > 60, "most steps are in contact")
      call check(all(abs(course%force(first:n) - impact%factor*modulus &
         *course%z(first:n)**1.5_wp) <= 1.0e-6_wp*maxval(course%force)), &
         "the force follows the approach between springs")
   end subroutine test_edge

   !> With a memory the next spring, which does not push, does not show where the edge is: few
   !> springs with many steps each have the coefficient of many springs, where the pressure at the
   !> edge ends with a step and where it does not
   subroutine test_edge_of_memory()
      real(wp), parameter :: none(0) = 0.0_wp, tolerance = 4.0e-6_wp
      type(prony_t) :: viscous
      type(power_law_t) :: fractional
      type(impact_t) :: impact
      type(error_t), allocatable :: error

      call new_prony(viscous, 1.0e7_wp, none, none, 1.0e3_wp, error)
      call viscous%set_constants(error, density=1000.0_wp, poisson_ratio=0.0_wp)
      call make_impact(impact, viscous, base_half_space, 0.0_wp, 2.0_wp, 0.01_wp, sphere(0.01_wp), &
         has_waves=.false.)
      call check_close(cor_on(impact, 480, 60, 5), cor_on(impact, 480, 900, 5), tolerance, &
         "springs under the edge on a viscous face")
      call new_power_law(fractional, 5.0e6_wp, 8.0e5_wp, 0.35_wp, error)
      call fractional%set_constants(error, density=1000.0_wp, poisson_ratio=0.0_wp)
      call make_impact(impact, fractional, base_half_space, 0.0_wp, 2.0_wp, 0.01_wp, &
         sphere(0.01_wp), has_waves=.false.)
      call check_close(cor_on(impact, 480, 60, 5), cor_on(impact, 480, 900, 5), tolerance, &
         "springs under the edge of a power law")
      ! the edge of a cone is as far from the springs beside it near the axis as from the axis
      call make_impact(impact, viscous, base_half_space, 0.0_wp, 2.0_wp, 0.01_wp, &
         cone_factor(60.0_wp), exponent=2.0_wp, has_waves=.false.)
      call check_close(cor_on(impact, 480, 112, 5), cor_on(impact, 480, 900, 5), &
         3.0_wp*tolerance, "springs under the edge of a cone")
   end subroutine test_edge_of_memory

   !> Coefficient of a march
   function cor_on(impact, steps, springs, hats, longer) result(cor)
      type(impact_t), intent(in) :: impact
      !> Steps, springs and hats
      integer, intent(in) :: steps, springs, hats
      !> Factor of the radius of the row; absent: 1
      real(wp), intent(in), optional :: longer
      real(wp) :: cor

      type(course_t) :: course

      course = course_on(impact, steps, springs, hats, longer)
      call check(course%status == course_ended, "the contact ends")
      cor = course%cor(impact)
   end function cor_on

   !> Course of a march
   function course_on(impact, steps, springs, hats, longer) result(course)
      type(impact_t), intent(in) :: impact
      !> Steps, springs and hats
      integer, intent(in) :: steps, springs, hats
      !> Factor of the radius of the row; absent: 1
      real(wp), intent(in), optional :: longer
      type(course_t) :: course

      real(wp), parameter :: window = 2.5e-3_wp, radius = 4.0e-3_wp
      type(mesh_t) :: mesh
      type(kernel_t) :: kernel
      type(spectrum_t) :: spectrum
      type(error_t), allocatable :: error

      mesh = mesh_t(steps, springs, hats, window, radius)
      if (present(longer)) mesh%radius = longer*radius
      call new_kernel(kernel, impact%face, mesh, spectrum, error)
      if (.not. allocated(error)) call march(impact, kernel, course, error)
      if (allocated(error)) call success(error, "an impact is marched")
   end function course_on

   !> A kernel that is shared changes no bit, whatever was solved before
   subroutine test_sharing()
      type(coupled_t), allocatable :: shared, alone
      type(impact_t) :: impact
      type(trajectory_t) :: one, other
      type(error_t), allocatable :: error
      ! the relative velocity does not exist
      integer, parameter :: rows(5) = [col_time, col_force, col_impulse, col_sphere, &
         col_sphere_velocity]
      integer :: i

      allocate (shared)
      call new_coupled(shared, solver_settings_t(accuracy=1.0e-4_wp))
      do i = 0, 7
         call make_impact(impact, rubber(0.45_wp + 0.01_wp*real(i/4, wp)), base_half_space, &
            0.0_wp, 1.0_wp + 0.02_wp*real(modulo(i, 4), wp), 0.03_wp, sphere(0.01_wp))
         call shared%solve(impact, one, error)
         call success(error, "an impact is solved by an old solver")
         allocate (alone)
         call new_coupled(alone, solver_settings_t(accuracy=1.0e-4_wp))
         call alone%solve(impact, other, error)
         call success(error, "an impact is solved by a new solver")
         associate (last => one%last)
            call check(last == other%last, "sharing changes no number of steps")
            call check(all(abs(one%state(rows, 0:last) - other%state(rows, 0:last)) <= 0.0_wp), &
               "sharing changes no bit")
         end associate
         deallocate (alone)
      end do
   end subroutine test_sharing

   !> Neighbours of an impact take its mesh, whatever suits them, until another one is settled
   subroutine test_settled()
      real(wp), parameter :: velocity(*) = [1.5_wp, 1.6_wp, 1.7_wp]
      type(coupled_t), allocatable :: solver
      type(impact_t) :: impact
      type(trajectory_t) :: near, own
      type(error_t), allocatable :: error
      real(wp) :: step
      integer :: i

      allocate (solver)
      call new_coupled(solver, solver_settings_t())
      do i = 1, size(velocity)
         call make_impact(impact, rubber(0.45_wp), base_free, 0.02_wp, velocity(i), 0.03_wp, &
            sphere(0.01_wp))
         if (i /= 2) call solver%settle(impact, error)
         call success(error, "an impact is settled")
         call solver%solve(impact, near, error)
         call success(error, "a neighbour is solved")
         call solve(impact, own)
         call check_close(cor_of(impact, near), cor_of(impact, own), accuracy, &
            "it is as good on the mesh of the other")
         if (i == 1) step = near%state(col_time, 1)
         if (i == 2) call check(abs(near%state(col_time, 1) - step) <= 0.0_wp, "steps are kept")
         if (i == 2) call check(abs(own%state(col_time, 1) - step) > 0.0_wp, "others suit it")
         if (i == 3) call check(abs(near%state(col_time, 1) - own%state(col_time, 1)) <= 0.0_wp, &
            "an impact that is settled has its own steps")
      end do
   end subroutine test_settled

   !> A flat punch, without inertia a damped oscillator, and with inertia on a layer
   subroutine test_punch()
      real(wp), parameter :: none(0) = 0.0_wp, radius = 0.003_wp, mass = 0.03_wp
      type(prony_t) :: material
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error
      real(wp) :: omega, damping, damped, angle

      call new_prony(material, 1.0e6_wp, none, none, 100.0_wp, error)
      call material%set_constants(error, density=1100.0_wp, poisson_ratio=0.45_wp)
      call make_impact(impact, material, base_half_space, 0.0_wp, 1.0_wp, mass, &
         punch_factor(radius), exponent=1.0_wp, has_waves=.false.)
      call solve(impact, trajectory)
      omega = sqrt(impact%kernel(1.0_wp)/mass)
      damping = 0.5_wp*impact%kernel_viscosity()/(mass*omega)
      damped = sqrt(1.0_wp - damping**2)
      angle = pi - atan(2.0_wp*damping*damped/(1.0_wp - 2.0_wp*damping**2))
      call check_cor(impact, trajectory, exp(-damping/damped*angle) &
         *(damping/damped*sin(angle) - cos(angle)), "a punch on a damped spring")
      call make_impact(impact, rubber(0.45_wp), base_bonded, 0.01_wp, 1.0_wp, mass, &
         punch_factor(radius), exponent=1.0_wp)
      call solve(impact, trajectory)
      call check(trajectory%cor_sphere_error <= accuracy, "a punch on a layer converges")
      call check_relative(maxval(trajectory%radius(0:trajectory%last)), radius, 0.01_wp, &
         "its radius is its own")
   end subroutine test_punch

   !> The contact time does not depend on the places of springs and steps, although waves make the
   !> contact of a round body end within a time that no step resolves; under gravity that of a slow
   !> impact is a part of cor_sphere. On an elastic half space the sphere is where it began at the
   !> end but for these waves, z(t0) = g R V^2/c^2, g = 0.061 for a rigid sphere and nu = 0.3
   !> (tests/reference/end_of_contact.py)
   subroutine test_end_of_contact()
      real(wp), parameter :: gravity = 9.81_wp, resolved = 1.0e-5_wp
      real(wp), parameter :: share = 0.061_wp
      real(wp), parameter :: none(0) = 0.0_wp, radius = 0.005_wp
      real(wp), parameter :: velocity(4) = [0.05_wp, 0.1_wp, 0.3_wp, 1.0_wp]
      type(impact_t) :: impact
      type(trajectory_t) :: coarse, fine
      real(wp) :: separation
      integer :: i

      do i = 1, size(velocity)
         call make_impact(impact, rubber(0.5_wp), base_free, 0.02_wp, velocity(i), 0.004_wp, &
            sphere(radius), gravity=gravity)
         call solve(impact, coarse)
         call solve(impact, fine, asked=0.1_wp*accuracy)
         call check_close(coarse%state(col_time, coarse%last), fine%state(col_time, fine%last), &
            resolved*fine%state(col_time, fine%last), "contact times agree")
         call check_close(cor_of(impact, coarse), cor_of(impact, fine), &
            3.0_wp*coarse%cor_sphere_error, "a slow impact under gravity and its stated error")
         call check(coarse%cor_sphere_error <= accuracy, "a slow impact is as accurate as others")
      end do
      call make_impact(impact, solid(15.0e6_wp, none, none, 1100.0_wp, 0.3_wp), base_half_space, &
         0.0_wp, 4.0_wp, 0.02_wp, sphere(radius))
      call solve(impact, coarse)
      separation = cor_of(impact, coarse)*impact%velocity
      ! c^2 = E/(2 (1 + nu) rho)
      call check_close(coarse%state(col_sphere, coarse%last), share*radius*separation**2 &
         *2.6_wp*1100.0_wp/15.0e6_wp, 3.0_wp*separation*coarse%contact_time_error, &
         "a sphere leaves an elastic half space where it met it, but for the waves")
   end subroutine test_end_of_contact

   !> A fast impact of an elastic sphere on a plate that relaxes, whose dent is flatter than the
   !> sphere at the end, against a finer march of the same kind (800 to 6400 steps, 12 and 30 hats)
   subroutine test_fast_end()
      real(wp), parameter :: none(0) = 0.0_wp, time = 6.4017e-5_wp, tolerance = 5.0e-4_wp
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory

      call make_impact(impact, relaxing(1.0_wp, 1.0_wp), base_free, 0.0292_wp, 342.9_wp, &
         3.428e-3_wp, sphere(4.7165e-3_wp), &
         striker=solid(1.4374e9_wp, none, none, 1000.0_wp, 0.2564_wp))
      call solve(impact, trajectory)
      call check_relative(trajectory%state(col_time, trajectory%last), time, tolerance, &
         "the end of a fast impact of an elastic sphere")
      call check(abs(trajectory%state(col_time, trajectory%last) - time) &
         <= 3.0_wp*trajectory%contact_time_error, "its stated error")
   end subroutine test_fast_end

   !> The end of blunt bodies, whose pressure ends over a wide contact at once, against marches of
   !> 2560 and 5120 steps with 64 hats, by the last values of the compression: on elastic and
   !> relaxing faces, of rigid and elastic bodies
   subroutine test_blunt_end()
      real(wp), parameter :: sharp = 1.0e-3_wp, none(0) = 0.0_wp
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory

      call make_impact(impact, rubber(0.4_wp), base_half_space, 0.0_wp, 5.0_wp, 0.01_wp, &
         profile_factor(5.0e3_wp, 3.0_wp), exponent=4.0_wp/3.0_wp)
      call solve(impact, trajectory)
      call expect_end(trajectory, 8.9480e-4_wp, "r^3 on rubber", sharp)
      call make_impact(impact, solid(15.0e6_wp, none, none, 1100.0_wp, 0.3_wp), base_half_space, &
         0.0_wp, 1.0_wp, 0.004_wp, profile_factor(2.0e5_wp, 4.0_wp), exponent=1.25_wp)
      call solve(impact, trajectory)
      call expect_end(trajectory, 6.0078e-4_wp, "r^4 on an elastic half space", sharp)
      call make_impact(impact, solid(1686086.2746_wp, [4202043.06645_wp, 3471469.31074_wp], &
         [3469.77543_wp, 71942.05534_wp], 1094.6563_wp, 0.36053582_wp), base_half_space, 0.0_wp, &
         2.261682743_wp, 1.9886118e-3_wp, profile_factor(3148.9126184_wp, 2.56908717_wp), &
         exponent=1.0_wp + 1.0_wp/2.56908717_wp, &
         striker=solid(183884350.84_wp, none, none, 1000.0_wp, 0.36603436_wp))
      call solve(impact, trajectory)
      call expect_end(trajectory, 1.18852e-3_wp, "an elastic body on one that relaxes", sharp)
      call make_impact(impact, solid(63536218.4_wp, [51206055.2_wp], [20.0_wp], 1051.145_wp, &
         0.38125_wp), base_sliding, 7.2308e-3_wp, 30.82_wp, 0.05376584_wp, &
         profile_factor(75.093945_wp, 2.11195889_wp), exponent=1.0_wp + 1.0_wp/2.11195889_wp)
      call solve(impact, trajectory)
      call expect_end(trajectory, 4.4746e-4_wp, "a body on a layer that slides", sharp)
   end subroutine test_blunt_end

   !> On a layer thinner than the contact the waves come back before its end, which is that of the
   !> last values of the compression: against a march of 5120 steps
   subroutine test_end_by_steps()
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory

      call make_impact(impact, solid(160169.3332_wp, [103867.5216_wp, 231251.7555_wp], &
         [567.36578_wp, 1257.57392_wp], 982.11331_wp, 0.48813811_wp), base_bonded, &
         2.3831934e-3_wp, 2.7799989_wp, 0.01424084146_wp, sphere(7.566086495e-3_wp))
      call solve(impact, trajectory)
      call expect_end(trajectory, 2.180e-3_wp, "a thin layer")
   end subroutine test_end_by_steps

   !> Check the end of a contact, and its stated error
   subroutine expect_end(trajectory, time, what, sharp)
      type(trajectory_t), intent(in) :: trajectory
      !> Its time [s]
      real(wp), intent(in) :: time
      !> Its name
      character(len=*), intent(in) :: what
      !> Relative error that is stated at most
      real(wp), intent(in), optional :: sharp

      call check(abs(end_of(trajectory) - time) <= 3.0_wp*trajectory%contact_time_error, &
         what//": the end of its contact is within three stated errors")
      if (present(sharp)) call check(trajectory%contact_time_error <= sharp*time, &
         what//": the end of its contact is sharp")
   end subroutine expect_end

   !> End of the contact
   pure function end_of(trajectory) result(time)
      type(trajectory_t), intent(in) :: trajectory
      !> The time [s]
      real(wp) :: time

      time = trajectory%state(col_time, trajectory%last)
   end function end_of

   !> Results do not depend on the units of length and time
   subroutine test_units()
      real(wp), parameter :: tolerance = 1.0e-9_wp
      real(wp), parameter :: length(*) = [1.0_wp, 1000.0_wp, 0.3_wp, 1.7_wp]
      real(wp), parameter :: time(*) = [1.0_wp, 1.0e6_wp, 7.0_wp, 0.011_wp]
      type(impact_t) :: impact
      type(trajectory_t) :: one, other
      real(wp) :: cor
      integer :: i

      do i = 1, size(length)
         call make_impact(impact, relaxing(length(i), time(i)), base_bonded, 0.02_wp*length(i), &
            50.0_wp*length(i)/time(i), 3.4e-3_wp, sphere(4.7e-3_wp*length(i)))
         call solve(impact, other)
         if (i == 1) then
            one = other
            cor = cor_of(impact, one)
         end if
         call check_close(cor_of(impact, other), cor, tolerance, "units and the coefficient")
         call check_relative(other%state(col_time, other%last), &
            one%state(col_time, one%last)*time(i), tolerance, "units and the contact time")
         call check_relative(other%max_force, one%max_force*length(i)/time(i)**2, tolerance, &
            "units and the largest force")
      end do
   end subroutine test_units

   !> A solid that relaxes by nine tenths, in units of length and time
   function relaxing(length, time) result(material)
      !> Units in a metre and in a second
      real(wp), intent(in) :: length, time
      type(prony_t) :: material

      real(wp), parameter :: equilibrium = 0.2375582e9_wp, rest = 2.2113707e9_wp

      material = solid(equilibrium/(length*time**2), [rest/(length*time**2)], &
         [54264.355_wp/time], 1221.972_wp/length**3, 0.31112_wp)
   end function relaxing

   !> Weight: a bounce gains what the sphere falls, and a sphere that is put down comes to rest
   subroutine test_gravity()
      real(wp), parameter :: none(0) = 0.0_wp, gravity = 9.81_wp
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      type(power_law_t) :: fractional
      type(error_t), allocatable :: error
      real(wp) :: work, cor

      call make_impact(impact, solid(1.0e6_wp, none, none, 1100.0_wp, 0.3_wp), base_half_space, &
         0.0_wp, 0.05_wp, 0.03_wp, sphere(0.01_wp), has_waves=.false., gravity=gravity)
      call solve(impact, trajectory)
      cor = cor_of(impact, trajectory)
      work = impact%mass*gravity*trajectory%state(col_sphere, trajectory%last)
      call check_close(cor**2, 1.0_wp + work/impact%initial_energy(), 2.0e-5_wp, &
         "an elastic bounce under gravity")
      call make_impact(impact, solid(1.0e5_wp, [2.0e6_wp], [300.0_wp], 1100.0_wp, 0.45_wp), &
         base_half_space, 0.0_wp, 0.01_wp, 0.03_wp, sphere(0.01_wp), gravity=gravity)
      call solve(impact, trajectory)
      call check(trajectory%status == contact_resting, "a sphere that is put down rests")
      call check_relative(trajectory%state(col_force, trajectory%last), impact%mass*gravity, &
         0.1_wp, "its weight is carried")

      ! the force falls to a thirtieth of the weight, where long steps see an end, and rises again
      call new_power_law(fractional, 2.2e5_wp, 3.87e4_wp, 0.6664_wp, error)
      call fractional%set_constants(error, density=1100.0_wp, poisson_ratio=0.45_wp)
      call make_impact(impact, fractional, base_sliding, 0.05_wp, 0.1844_wp, 3.128e-4_wp, &
         0.2887_wp, exponent=2.0_wp, gravity=gravity)
      call solve(impact, trajectory)
      call check(trajectory%status == contact_resting, "a cone that nearly leaves rests")
   end subroutine test_gravity

   !> On a light plate the force is largest long before the contact ends, and as exact
   subroutine test_early_force()
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory

      call make_impact(impact, solid(7.798237e6_wp, [57.311808e6_wp], [98.5612_wp], 1100.0_wp, &
         0.35_wp), base_free, 0.00986283_wp, 12.743651_wp, 0.02307016_wp, 0.17439484_wp)
      call solve(impact, trajectory)
      call check(trajectory%time_of_max_force < 0.1_wp*trajectory%state(col_time, &
         trajectory%last), "the contact goes on for long")
      ! by 1280 steps in a fifth of the time
      call check_relative(trajectory%max_force, 620.65_wp, 1.0e-3_wp, "its largest force")
      ! within the first of 320 steps of the contact; by 640 steps in a thousandth of it
      call make_impact(impact, solid(146796.494_wp, [186287.067_wp, 43780.3362_wp], &
         [10788.5025_wp, 623.465034_wp], 1006.11614_wp, 0.49_wp), base_free, 4.5633138698e-4_wp, &
         0.03173044286533_wp, 1.0843769379e-4_wp, profile_factor(3102.503571_wp, 2.3496357943_wp), &
         exponent=1.0_wp + 1.0_wp/2.3496357943_wp)
      call solve(impact, trajectory)
      call check(abs(trajectory%max_force - 2.25007e-4_wp) <= 3.0_wp*trajectory%max_force_error, &
         "a force that comes in the first step is within three stated errors")
      call check(trajectory%max_force_error <= 0.01_wp*trajectory%max_force, &
         "its error is small")
      ! a blunt body on an incompressible layer begins with a force that no step resolves
      call make_impact(impact, solid(2.0e6_wp, [1.0e6_wp, 1.0e6_wp, 3.0e6_wp], [100.0_wp, &
         3.0e3_wp, 4.0e4_wp], 1100.0_wp, 0.5_wp), base_bonded, 0.01_wp, 2.0_wp, 0.01_wp, &
         profile_factor(1.0e5_wp, 4.0_wp), exponent=1.25_wp)
      call solve(impact, trajectory, asked=10.0_wp*accuracy)
      call check(trajectory%max_force_error > 0.01_wp*trajectory%max_force, &
         "a force without a largest value has a large error")
   end subroutine test_early_force

   !> Contacts that do not end: on a sheet too light for the sphere, or before the end time
   subroutine test_no_end()
      real(wp), parameter :: none(0) = 0.0_wp
      type(coupled_t), allocatable :: solver
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      call make_impact(impact, solid(70.0e9_wp, none, none, 2500.0_wp, 0.22_wp), base_free, &
         0.0002_wp, 1.0_wp, 2.6e-4_wp, sphere(0.002_wp))
      allocate (solver)
      call new_coupled(solver, solver_settings_t(end_time=1.0e-4_wp))
      call solver%solve(impact, trajectory, error)
      call success(error, "an end time before the end is not an error")
      call check(trajectory%status == contact_lasting, "a sheet keeps the sphere")
      call new_coupled(solver, solver_settings_t(end_time=1.0e-3_wp))
      call make_impact(impact, rubber(0.45_wp), base_half_space, 0.0_wp, 1.0_wp, 0.03_wp, &
         sphere(0.01_wp))
      call solver%solve(impact, trajectory, error)
      call success(error, "an end time before the end is not an error")
      call check(trajectory%status == contact_lasting, "the end time is before the end")
      call new_coupled(solver, solver_settings_t(end_time=1.0e-2_wp))
      call solver%solve(impact, trajectory, error)
      call success(error, "an end time after the end is not an error")
      call check(trajectory%status == contact_separated, "the end time is after the end")
   end subroutine test_no_end

   !> What cannot be solved is refused with its reason
   subroutine test_refusals()
      type(coupled_t), allocatable :: solver
      type(impact_t) :: impact
      type(trajectory_t) :: trajectory
      type(face_t) :: face
      type(prony_t) :: rigid, unknown
      type(error_t), allocatable :: error

      allocate (solver)
      call new_coupled(solver, solver_settings_t(accuracy=1.0e-11_wp))
      call make_impact(impact, rubber(0.45_wp), base_half_space, 0.0_wp, 1.0_wp, 0.03_wp, &
         sphere(0.01_wp))
      call solver%solve(impact, trajectory, error)
      call check(allocated(error), "an accuracy out of reach is refused")
      if (allocated(error)) call check(error%code == error_numerical, "as a numerical failure")
      call check_close(default_accuracy("coupled"), accuracy, 0.0_wp, "the default accuracy")
      call new_rigid(rigid)
      call new_face(face, rigid, rigid, base_half_space, 0.0_wp, .true., error)
      call refused(error, "two rigid bodies", "")
      call new_elastic(unknown, 1.0e9_wp, error)
      call new_face(face, unknown, rigid, base_half_space, 0.0_wp, .true., error)
      call refused(error, "waves without a density", "")
      call new_face(face, rubber(0.5_wp), rigid, base_bonded, 0.0_wp, .true., error)
      call refused(error, "a layer without a thickness", "")
   end subroutine test_refusals

end program test_coupled
