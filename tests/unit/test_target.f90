!> Impacts on structures: closed forms, and the impacts of tests/reference/target.txt
program test_target
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_error, only : error_t
   use vcor_impact_body, only : new_beam, new_block, new_panel, new_rod, support_cantilever, &
      support_clamped, support_free, support_supported
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus
   use vcor_impact_law, only : contact_law_t, new_contact_law
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_impact_structure, only : new_structure, structure_t, vibration_t
   use vcor_impact_target, only : new_target, target_t
   use vcor_impact_trajectory, only : contact_separated, trajectory_t
   use vcor_kinds, only : pi, wp
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, new_rigid, new_sls, prony_t
   use vcor_material_type, only : material_t
   use vcor_solver, only : new_solver, solve_impact, solver_settings_t, solver_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : refused, success
   implicit none

   !> Frequency up to which modes are kept, over pi/(elastic contact time)
   real(wp), parameter :: highest = 300.0_wp
   !> Names of what the reference has
   character(len=*), parameter :: names(9) = [character(len=16) :: 'cor_sphere', 'cor', &
      'contacts', 'contact_time', 'last_separation', 'max_force', 'max_indentation', &
      'structure_energy', 'wave_energy']

   call suite("target")
   call test_block()
   call test_flexibility()
   call test_frequencies()
   call test_refusals()
   call test_creep()
   call test_splitting()
   call test_ringing()
   call test_references()
   call finish()

contains

   !> A steel ball on a half space of steel or of glass
   subroutine make_impact(structure, impact)
      type(structure_t), intent(in) :: structure
      !> The impact
      type(impact_t), intent(out) :: impact

      type(prony_t) :: steel, glass
      type(contact_modulus_t) :: modulus
      type(target_t) :: target
      type(error_t), allocatable :: error

      call new_elastic(steel, 210.0e9_wp, error)
      call steel%set_constants(error, 7850.0_wp, 0.3_wp)
      call new_elastic(glass, 70.0e9_wp, error)
      call glass%set_constants(error, 2500.0_wp, 0.22_wp)
      call new_contact_modulus(modulus, steel, glass, .false., error)
      call new_target(target, structure)
      call new_impact(impact, 1.0_wp, 0.01_wp, 0.005_wp, 0.0_wp, modulus, target, error)
      call success(error, "an impact on a structure is built")
   end subroutine make_impact

   !> Solve an impact
   subroutine solve(impact, method, outcome, trajectory, accuracy)
      type(impact_t), intent(in) :: impact
      !> Name of the method
      character(len=*), intent(in) :: method
      type(outcome_t), intent(out) :: outcome
      type(trajectory_t), intent(out) :: trajectory
      !> Accuracy; absent: that of the method
      real(wp), intent(in), optional :: accuracy

      type(solver_settings_t) :: settings
      class(solver_t), allocatable :: solver
      type(error_t), allocatable :: error

      settings%method = method
      if (present(accuracy)) settings%accuracy = accuracy
      call new_solver(solver, settings, error)
      if (.not. allocated(error)) call solve_impact(solver, impact, trajectory, outcome, error)
      call success(error, "an impact on a structure is solved by "//method)
   end subroutine solve

   !> A free block has Newton's impact, a dashpot the inelastic one of Zener's plate
   subroutine test_block()

      real(wp), parameter :: of_ive = 1.0e-8_wp, of_direct = 1.0e-6_wp, mass = 0.03_wp
      type(structure_t) :: block
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      call new_block(block, mass, 0.0_wp, 0.0_wp, error)
      call success(error, "a block is built")
      call check(block%falls(), "a free block falls")
      call make_impact(block, impact)
      call solve(impact, 'ive', outcome, trajectory)
      call check_close(outcome%cor_sphere, (mass - impact%mass)/(mass + impact%mass), of_ive, &
         "an elastic impact on a free block")
      call check_close(outcome%cor, 1.0_wp, of_ive, "cor against the block")
      call check_relative(outcome%structure_energy, &
         0.5_wp*mass*(2.0_wp*impact%mass/(mass + impact%mass))**2, of_ive, "energy of the block")
      call solve(impact, 'direct', outcome, trajectory)
      call check_close(outcome%cor_sphere, (mass - impact%mass)/(mass + impact%mass), of_direct, &
         "an elastic impact on a free block by direct")
      call check(outcome%contacts == 1, "one contact with a free block")
      ! a block that is heavy for its dashpot: one without stiffness does not fall on the ball
      call new_block(block, mass, 0.0_wp, 20.0_wp, error)
      call make_impact(block, impact)
      call solve(impact, 'auto', outcome, trajectory)
      call check(outcome%status == contact_separated, "a block against a dashpot lets the ball go")
      call check(outcome%wave_energy > outcome%structure_energy, "a dashpot takes energy")
   end subroutine test_block

   !> A material for beams and plates
   subroutine make_material(material)
      !> Aluminium
      type(prony_t), intent(out) :: material

      type(error_t), allocatable :: error

      call new_elastic(material, 70.0e9_wp, error)
      call material%set_constants(error, 2700.0_wp, 0.3_wp)
   end subroutine make_material

   !> Flexibility of all modes
   pure function flexibility(structure) result(value)
      type(structure_t), intent(in) :: structure
      !> Flexibility [m/N]
      real(wp) :: value

      value = structure%residual + structure%rest%flexibility &
         + sum(structure%yield/structure%square, structure%square > 0.0_wp)
   end function flexibility

   !> The sum of all modes is the flexibility of textbooks, and hardly depends on the limit
   subroutine test_flexibility()

      real(wp), parameter :: tolerance = 1.0e-10_wp, length = 0.4_wp, width = 0.03_wp, &
         thickness = 0.01_wp, at = 0.13_wp
      ! S. Timoshenko and S. Woinowsky-Krieger, Theory of Plates and Shells, 2nd ed. (1959), table
      ! 23: deflection under a force at the centre of a square, 0.01160 P a^2/D
      real(wp), parameter :: of_square = 0.01160_wp, digits_of_square = 5.0e-4_wp
      type(prony_t) :: material
      type(structure_t) :: body, other
      type(error_t), allocatable :: error
      real(wp) :: bending

      call make_material(material)
      bending = 70.0e9_wp*width*thickness**3/12.0_wp
      call new_beam(body, material, length, width, thickness, support_supported, at, 0.0_wp, &
         1.0e6_wp, error)
      call check_relative(flexibility(body), (at*(length - at))**2/(3.0_wp*bending*length), &
         tolerance, "flexibility of a supported beam")
      call new_beam(body, material, length, width, thickness, support_cantilever, length, 0.0_wp, &
         1.0e6_wp, error)
      call check_relative(flexibility(body), length**3/(3.0_wp*bending), tolerance, &
         "flexibility of a cantilever")
      call new_beam(body, material, length, width, thickness, support_clamped, at, 0.0_wp, &
         1.0e6_wp, error)
      call check_relative(flexibility(body), (at*(length - at)/length)**3/(3.0_wp*bending), &
         tolerance, "flexibility of a clamped beam")
      ! the sum over many modes of a free beam has what its moment says
      call new_beam(body, material, length, width, thickness, support_free, at, 0.0_wp, 1.0e4_wp, &
         error)
      call new_beam(other, material, length, width, thickness, support_free, at, 0.0_wp, 1.0e9_wp, &
         error)
      call check_relative(sum(other%yield(3:)/other%square(3:), other%square(3:) < 1.0e18_wp), &
         flexibility(body), 1.0e-7_wp, "flexibility of a free beam")
      call new_rod(body, material, length, thickness, support_clamped, 0.0_wp, 1.0e7_wp, error)
      call check_relative(flexibility(body), length/(70.0e9_wp*0.25_wp*pi*thickness**2), &
         tolerance, "flexibility of a clamped rod")
      call new_panel(body, material, length, length, thickness, [0.5_wp*length, 0.5_wp*length], &
         0.0_wp, 1.0e5_wp, error)
      bending = 70.0e9_wp*thickness**3/(12.0_wp*0.91_wp)
      call check_relative(flexibility(body), of_square*length**2/bending, digits_of_square, &
         "flexibility of a square plate")
      call new_panel(body, material, length, width, thickness, [at, 0.01_wp], 0.0_wp, 1.0e6_wp, &
         error)
      call new_panel(other, material, width, length, thickness, [0.02_wp, length - at], 0.0_wp, &
         2.0e6_wp, error)
      call check_relative(flexibility(body), flexibility(other), tolerance, &
         "a plate turned by a quarter")
      call success(error, "a plate is built")
   end subroutine test_flexibility

   !> Frequencies and shapes of textbooks
   subroutine test_frequencies()

      real(wp), parameter :: tolerance = 1.0e-11_wp, length = 0.4_wp, width = 0.03_wp, &
         thickness = 0.01_wp
      real(wp), parameter :: cantilever = 1.8751040687119611_wp, clamped = 4.7300407448627040_wp
      type(prony_t) :: material
      type(structure_t) :: body
      type(error_t), allocatable :: error
      real(wp) :: unit, mass

      call make_material(material)
      unit = sqrt(70.0e9_wp*thickness**2/(12.0_wp*2700.0_wp))/length**2
      mass = 2700.0_wp*length*width*thickness
      call new_beam(body, material, length, width, thickness, support_cantilever, length, 0.01_wp, &
         1.0e6_wp, error)
      call check_relative(sqrt(body%square(1)), unit*cantilever**2, tolerance, &
         "frequency of a cantilever")
      call check_relative(body%damping(1), 0.02_wp*unit*cantilever**2, tolerance, &
         "damping of a cantilever")
      call check_relative(body%yield(1), 4.0_wp/mass, tolerance, "mass of a mode at the tip")
      call new_beam(body, material, length, width, thickness, support_free, 0.0_wp, 0.0_wp, &
         1.0e6_wp, error)
      call check_relative(sqrt(body%square(3)), unit*clamped**2, tolerance, &
         "frequency of a free beam")
      call check_relative(body%yield(3), 4.0_wp/mass, tolerance, "mass of a mode at the end")
      call check_relative(sum(body%yield(:2)), 4.0_wp/mass, tolerance, "rigid motion of the end")
      call new_beam(body, material, length, width, thickness, support_clamped, 0.5_wp*length, &
         0.0_wp, 1.0e6_wp, error)
      call check_relative(sqrt(body%square(1)), unit*clamped**2, tolerance, &
         "frequency of a clamped beam")
      call success(error, "beams are built")
   end subroutine test_frequencies

   !> What no structure can be
   subroutine test_refusals()

      real(wp), parameter :: none(0) = [real(wp) ::], length = 0.4_wp
      type(prony_t) :: material
      type(structure_t) :: body
      type(error_t), allocatable :: error

      call make_material(material)
      call new_structure(body, none, none, none, error)
      call refused(error, "a structure without modes", "does not move")
      call new_structure(body, [1.0_wp], [0.0_wp], [0.0_wp], error)
      call refused(error, "a mode without yield", "masses positive")
      call new_structure(body, [-1.0_wp], [0.0_wp], [1.0_wp], error)
      call refused(error, "a mode of negative stiffness", "must not be negative")
      call new_beam(body, material, length, 0.03_wp, 0.01_wp, support_supported, 0.0_wp, 0.0_wp, &
         1.0e6_wp, error)
      call refused(error, "an impact on a support", "on a support")
      call new_panel(body, material, length, length, 0.01_wp, [length, 0.1_wp], 0.0_wp, 1.0e6_wp, &
         error)
      call refused(error, "an impact on an edge", "on a support")
      call new_panel(body, material, length, length, 0.01_wp, [0.1_wp, 0.0_wp], 0.0_wp, 1.0e6_wp, &
         error)
      call refused(error, "an impact on another edge", "on a support")
      call new_panel(body, material, 100.0_wp, 100.0_wp, 1.0e-4_wp, [50.0_wp, 50.0_wp], 0.0_wp, &
         1.0e8_wp, error)
      call refused(error, "a plate without end", "too many modes")
   end subroutine test_refusals

   !> A structure of a material that relaxes far sooner than the impact is one of its rubbery
   !> modulus, and a list of modes with their flexibility is the structure
   subroutine test_creep()

      real(wp), parameter :: tolerance = 2.0e-4_wp, of_list = 2.0e-8_wp
      type(prony_t) :: relaxed, elastic
      type(structure_t) :: body, same, list
      type(impact_t) :: impact
      type(outcome_t) :: outcome, expected
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error

      call new_prony(relaxed, 70.0e9_wp, [10.0e9_wp], [1.0e10_wp], 0.0_wp, error)
      call relaxed%set_constants(error, 2700.0_wp, 0.3_wp)
      call make_material(elastic)
      call new_beam(body, relaxed, 0.4_wp, 0.03_wp, 0.01_wp, support_free, 0.2_wp, 0.0_wp, &
         1.0e6_wp, error)
      call new_beam(same, elastic, 0.4_wp, 0.03_wp, 0.01_wp, support_free, 0.2_wp, 0.0_wp, &
         1.0e6_wp, error)
      call check(body%is_viscoelastic() .and. .not. same%is_viscoelastic(), &
         "only one of two beams relaxes")
      call make_impact(same, impact)
      call solve(impact, 'auto', expected, trajectory)
      call make_impact(body, impact)
      call solve(impact, 'auto', outcome, trajectory)
      call check_close(outcome%cor_sphere, expected%cor_sphere, tolerance, &
         "a beam that has relaxed")
      call new_beam(same, elastic, 0.4_wp, 0.03_wp, 0.01_wp, support_free, 0.2_wp, 0.0_wp, &
         2.0e7_wp, error)
      call make_impact(same, impact)
      call solve(impact, 'auto', expected, trajectory)
      call new_structure(list, same%square, same%damping, same%yield, error, &
         same%rest%flexibility)
      call make_impact(list, impact)
      call solve(impact, 'auto', outcome, trajectory)
      call check_close(outcome%cor_sphere, expected%cor_sphere, of_list, &
         "modes beyond the limit as a flexibility")
   end subroutine test_creep

   !> The oscillators and exponentials of modes that relax are what the correspondence principle
   !> says: terms that are not in order, of one rate, fluids, dashpots, modes that do not swing, and
   !> more modes than rates
   subroutine test_splitting()

      type(prony_t) :: prony
      type(power_law_t) :: power
      type(error_t), allocatable :: error

      call new_prony(prony, 1.0e9_wp, [2.0e9_wp, 1.0e9_wp, 5.0e8_wp, 1.0e8_wp], &
         [3.0e4_wp, 1.0e2_wp, 3.0e4_wp, 1.0e6_wp], 0.0_wp, error)
      call check_split(prony, 1.0e4_wp, "a Prony series")
      call new_prony(prony, 1.0e9_wp, [2.0e9_wp], [3.0e4_wp], 2.0e3_wp, error)
      call check_split(prony, 1.0e4_wp, "a dashpot beside a spring and a term")
      call new_prony(prony, 1.0e9_wp, [real(wp) ::], [real(wp) ::], 2.0e5_wp, error)
      call check_split(prony, 1.0e4_wp, "a dashpot beside a spring")
      call new_prony(prony, 0.0_wp, [1.0e9_wp, 2.0e9_wp], [1.0e3_wp, 1.0e5_wp], 0.0_wp, error)
      call check_split(prony, 1.0e4_wp, "a fluid")
      call new_prony(prony, 1.0e6_wp, [1.0e9_wp], [1.0e5_wp], 0.0_wp, error)
      call check_split(prony, 1.0e4_wp, "a mode that creeps")
      call new_power_law(power, 1.0e9_wp, 6.0e7_wp, 0.3_wp, error)
      call check_split(power, 1.0e5_wp, "a power law")
      call new_power_law(power, 0.0_wp, 6.0e7_wp, 0.5_wp, error)
      call check_split(power, 1.0e5_wp, "a fluid power law")
      call success(error, "materials are built")
   end subroutine test_splitting

   !> Compare the receptance of a structure with that of its parts
   subroutine check_split(material, frequency, name)
      class(material_t), intent(in) :: material
      !> A frequency of the motion [rad/s]
      real(wp), intent(in) :: frequency
      !> What the material is
      character(len=*), intent(in) :: name

      ! of a sum of exponentials, which is none with an accuracy of 1e-10, and of partial fractions
      real(wp), parameter :: of_sum = 1.0e-8_wp, of_parts = 1.0e-11_wp, reference = 1.5e9_wp
      integer, parameter :: modes = 40
      type(structure_t) :: body
      type(vibration_t) :: vibration
      type(error_t), allocatable :: error
      real(wp) :: w(modes), yield(modes), worst
      complex(wp) :: p, whole, parts
      integer :: i

      w = frequency*[(0.05_wp*real(i, wp)**2, i=0, modes - 1)]
      yield = [(1.0_wp + 0.5_wp*sin(real(i, wp)), i=1, modes)]
      call new_structure(body, w**2, 0.04_wp*w, yield, error, material=material, &
         reference=reference)
      call success(error, name//": the structure is built")
      call body%expand(4.0_wp/frequency, 2.0_wp/frequency, 1.0e-10_wp, vibration, error)
      call success(error, name//": the structure is split")
      worst = 0.0_wp
      do i = -2, 6
         p = frequency*2.0_wp**i*exp((0.0_wp, 1.0_wp)*0.13_wp*real(i, wp))
         whole = sum(yield/(p**2 + 0.04_wp*w*p + w**2*(material%complex_modulus(p)/reference)))
         parts = sum((vibration%yield + vibration%jump*(p + vibration%damping)) &
            /(p**2 + vibration%damping*p + vibration%square)) &
            + sum(vibration%weight/(p + vibration%rate))
         worst = max(worst, abs(parts/whole - 1.0_wp))
      end do
      call check(worst <= merge(of_sum, of_parts, vibration%error > 0.0_wp), &
         name//": receptance by parts")
      call check(sum(vibration%jump) <= 0.0_wp .and. all(vibration%damping >= 0.0_wp), &
         name//": parts lose energy")
   end subroutine check_split
   !> Modes of undamped bodies that ring faster than panels follow: what they change is stated. A
   !> rod is a dashpot sqrt(E rho) A until its far end answers
   subroutine test_ringing()

      real(wp), parameter :: coarse = 1.0e-6_wp, fine = 1.0e-8_wp, finest = 1.0e-10_wp, &
         length = 0.1_wp, diameter = 0.02_wp
      type(prony_t) :: material
      type(structure_t) :: body
      type(impact_t) :: impact
      type(outcome_t) :: exact, outcome
      type(trajectory_t) :: trajectory
      type(error_t), allocatable :: error
      real(wp) :: limit
      integer :: kind

      call make_material(material)
      call new_block(body, 1.0e-9_wp, 0.0_wp, sqrt(70.0e9_wp*2700.0_wp)*0.25_wp*pi*diameter**2, &
         error)
      call make_impact(body, impact)
      call solve(impact, 'ive', exact, trajectory, finest)
      limit = highest*pi/(impact%law%contact_time*impact%time_scale())
      do kind = 1, 5
         select case (kind)
         case (1)
            call new_rod(body, material, 2.0_wp*length, diameter, support_free, 0.0_wp, limit, &
               error)
         case (2)
            call new_rod(body, material, 2.0_wp*length, diameter, support_clamped, 0.0_wp, limit, &
               error)
         case (3)
            call new_beam(body, material, length, diameter, 0.02_wp, support_free, 0.3_wp*length, &
               0.0_wp, limit, error)
         case (4)
            call new_beam(body, material, length, diameter, 0.03_wp, support_clamped, &
               0.4_wp*length, 0.0_wp, limit, error)
         case default
            call new_panel(body, material, length, length, 0.02_wp, [0.4_wp, 0.5_wp]*length, &
               0.0_wp, limit, error)
         end select
         call success(error, "an undamped body is built")
         call make_impact(body, impact)
         if (kind > 2) call solve(impact, 'ive', exact, trajectory, finest)
         call solve(impact, 'ive', outcome, trajectory, coarse)
         call compare(kind, coarse, outcome, exact)
         call solve(impact, 'ive', outcome, trajectory, fine)
         call compare(kind, fine, outcome, exact)
      end do
   end subroutine test_ringing

   !> Check that an outcome is as good as it says
   subroutine compare(kind, accuracy, outcome, exact)
      !> Body
      integer, intent(in) :: kind
      !> Accuracy asked for
      real(wp), intent(in) :: accuracy
      type(outcome_t), intent(in) :: outcome
      !> A better outcome
      type(outcome_t), intent(in) :: exact

      character(len=40) :: name

      write (name, '(a, i0, a, es7.1)') "body ", kind, " that rings, at ", accuracy
      call check_close(outcome%cor_sphere, exact%cor_sphere, outcome%cor_sphere_error &
         + exact%cor_sphere_error, trim(name)//": cor_sphere is as good as it says")
      call check(outcome%cor_sphere_error <= accuracy, trim(name)//": it is as good as asked")
      call check_close(outcome%contact_time, exact%contact_time, outcome%contact_time_error &
         + exact%contact_time_error, trim(name)//": contact_time is as good as it says")
      call check_close(outcome%max_force, exact%max_force, outcome%max_force_error &
         + exact%max_force_error, trim(name)//": max_force is as good as it says")
   end subroutine compare

   !> Impacts on structures of every kind
   subroutine test_references()

      ! cor_sphere for one contact and for several, all else relative
      real(wp), parameter :: once = 1.0e-8_wp, often = 1.0e-6_wp, relative = 1.0e-6_wp
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(trajectory_t) :: trajectory
      real(wp) :: expected(9), found(9)
      character(len=80) :: name
      integer :: unit, status, impacts, i

      open (newunit=unit, file='tests/reference/target.txt', status='old', action='read')
      impacts = 0
      do
         call read_impact(unit, name, impact, expected, status)
         if (status /= 0) exit
         impacts = impacts + 1
         call solve(impact, 'auto', outcome, trajectory)
         found = [outcome%cor_sphere, outcome%cor, real(outcome%contacts, wp), &
            outcome%contact_time, outcome%last_separation, outcome%max_force, &
            outcome%max_indentation, outcome%structure_energy, outcome%wave_energy]
         call check_close(found(1), expected(1), merge(once, often, outcome%contacts == 1), &
            trim(name)//": cor_sphere")
         call check(nint(found(3)) == nint(expected(3)), trim(name)//": contacts")
         do i = 2, size(names)
            if (i == 3 .or. ieee_is_nan(expected(i))) cycle
            call check_relative(found(i), expected(i), relative, trim(name)//": "//names(i))
         end do
      end do
      close (unit)
      call check(impacts == 14, "all impacts on structures are read")
   end subroutine test_references

   !> Read the next impact of the file
   subroutine read_impact(unit, name, impact, expected, status)
      !> Unit of the file
      integer, intent(in) :: unit
      !> Remark
      character(len=*), intent(out) :: name
      !> The impact
      type(impact_t), intent(out) :: impact
      !> What is to come out, in the order of `names`
      real(wp), intent(out) :: expected(9)
      !> 0, or that of the end of the file
      integer, intent(out) :: status

      character(len=200) :: line
      character(len=8) :: body
      type(prony_t) :: sphere, plate
      type(contact_modulus_t) :: modulus
      type(contact_law_t) :: law
      type(target_t) :: target
      type(structure_t) :: structure
      type(error_t), allocatable :: error
      real(wp), allocatable :: mode(:, :)
      real(wp) :: velocity, gravity, radius, mass, stiffness, damping, length, width, diameter, &
         thickness, position(2), ratio, limit
      integer :: receding, support, modes, i

      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) return
         if (line(1:1) /= '#') exit
         name = line(3:)
      end do
      read (line, *) velocity, gravity, radius, receding
      call read_material(unit, sphere)
      call read_material(unit, plate)
      read (unit, *) body, mass, stiffness, damping, length, width, diameter, thickness, support, &
         position, ratio, modes
      allocate (mode(3, modes))
      do i = 1, modes
         read (unit, *) mode(:, i)
      end do
      read (unit, *) expected
      call new_contact_modulus(modulus, sphere, plate, &
         abs(sphere%glassy() - plate%glassy()) <= 0.0_wp, error)
      call new_contact_law(law, 1.5_wp, receding == 1, error)
      call new_impact(impact, velocity, 4.0_wp/3.0_wp*pi*radius**3*sphere%density(), radius, &
         0.0_wp, modulus, target, error, law, gravity)
      call success(error, trim(name)//" is built")
      limit = highest*pi/(law%contact_time*impact%time_scale())
      select case (body)
      case ('block')
         call new_block(structure, mass, stiffness, damping, error)
      case ('beam')
         call new_beam(structure, plate, length, width, thickness, support, position(1), ratio, &
            limit, error)
      case ('rod')
         call new_rod(structure, plate, length, diameter, support, ratio, limit, error)
      case ('plate')
         call new_panel(structure, plate, length, width, thickness, position, ratio, limit, error)
      case default
         call new_structure(structure, (2.0_wp*pi*mode(1, :))**2, 4.0_wp*pi*mode(1, :)*mode(2, :), &
            1.0_wp/mode(3, :), error)
      end select
      call success(error, trim(name)//": its structure is built")
      call new_target(impact%target, structure)
   end subroutine read_impact

   !> Read a material
   subroutine read_material(unit, material)
      !> Unit of the file
      integer, intent(in) :: unit
      !> The material
      type(prony_t), intent(out) :: material

      type(error_t), allocatable :: error
      character(len=200) :: line
      character(len=8) :: model
      real(wp) :: poisson_ratio, density, number(7)
      integer :: terms

      read (unit, '(a)') line
      read (line, *) model, poisson_ratio, density
      select case (model)
      case ('rigid')
         call new_rigid(material)
         call material%set_constants(error, density=density)
         return
      case ('elastic')
         read (line, *) model, poisson_ratio, density, number(1)
         call new_elastic(material, number(1), error)
      case ('sls')
         read (line, *) model, poisson_ratio, density, number(:3)
         call new_sls(material, number(1), number(2), number(3), error)
      case default
         read (line, *) model, poisson_ratio, density, number(1), terms, number(2:)
         call new_prony(material, number(1), number(2:4), number(5:7), 0.0_wp, error)
      end select
      call material%set_constants(error, density, poisson_ratio)
   end subroutine read_material

end program test_target
