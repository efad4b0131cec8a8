!> Measures of validity: thresholds, compliance of a face with waves, indentation between nodes
program test_validity
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : col_indentation, col_time, col_velocity, trajectory_t
   use vcor_impact_face, only : base_bonded, base_free, base_half_space, base_sliding
   use vcor_impact_mobility, only : direct_mobility, mobility_t, take_over
   use vcor_impact_validity, only : judge, level_caution, level_good, level_none, level_outside, &
      surroundings_t, thresholds
   use vcor_kinds, only : pi, wp
   use vcor_test, only : check, check_relative, finish, suite
   implicit none

   real(wp), parameter :: rounding = 1.0e-14_wp

   call suite("validity")
   call test_half_space()
   call test_thin_plate()
   call test_table()
   call test_thresholds()
   call test_cause()
   call test_gain()
   call test_indentation()
   call finish()

contains

   !> A small contact on a half space has the loss of Miller and Pursey: their integral, from a path
   !> around its singularities (9 digits)
   subroutine test_half_space()
      real(wp), parameter :: ratio(6) = [-0.5_wp, 0.0_wp, 0.25_wp, 0.3_wp, 0.4_wp, 0.5_wp]
      real(wp), parameter :: expected(6) = [2.44644576_wp, 1.34437530_wp, 0.930752602_wp, &
         0.862223129_wp, 0.742946155_wp, 0.656117003_wp]
      ! the next term is of the order of the contact over the wave length, p
      real(wp), parameter :: p = 1.0e-5_wp, tolerance = 10.0_wp*p
      complex(wp) :: extra
      integer :: i

      do i = 1, size(ratio)
         extra = direct_mobility(base_half_space, ratio(i), cmplx(p, 0.0_wp, wp), 1.0_wp)
         call check_relative(-real(extra, wp)*pi*(1.0_wp - ratio(i))/p, expected(i), tolerance, &
            "loss of a half space")
      end do
   end subroutine test_half_space

   !> A free plate that is thin for its waves moves as Zener's, sqrt(6/(1 - nu))/(4 p)
   subroutine test_thin_plate()
      real(wp), parameter :: p = 1.0e-5_wp, nu = 0.3_wp
      ! the next term is y ln(y), relative
      real(wp), parameter :: tolerance = -2.0_wp*p*log(p)
      complex(wp) :: extra

      extra = direct_mobility(base_free, nu, cmplx(p, 0.0_wp, wp), 1.0e-3_wp)
      call check_relative(real(extra, wp), sqrt(6.0_wp/(1.0_wp - nu))/(4.0_wp*p), tolerance, &
         "thin plate")
   end subroutine test_thin_plate

   !> Between its nodes, and off its ray, the table is as accurate as its spacing lets it be
   subroutine test_table()
      integer, parameter :: bases(4) = [base_half_space, base_free, base_bonded, base_sliding]
      ! wave number and radius of the contact in thicknesses, and what a loss turns p by
      real(wp), parameter :: size_of_p(3) = [0.13_wp, 1.1_wp, 6.3_wp]
      real(wp), parameter :: radius(3) = [0.012_wp, 0.17_wp, 0.9_wp]
      real(wp), parameter :: turn(3) = [0.0_wp, -0.2_wp, 0.15_wp]
      real(wp), parameter :: ray(1) = [1.05_wp], nu = 0.35_wp, thickness = 0.02_wp
      ! where wave, layer and contact are of one size
      real(wp), parameter :: tolerance = 1.0e-2_wp
      type(mobility_t) :: table, other
      complex(wp) :: found, expected, p
      integer :: i, j

      do i = 1, size(bases)
         call table%describe(bases(i), nu, ray)
         do j = 1, size(radius)
            p = size_of_p(j)*exp(cmplx(0.0_wp, ray(1) + turn(j), wp))
            call table%compliance(1, p/thickness, radius(j)*thickness, thickness, found)
            expected = direct_mobility(bases(i), nu, p, radius(j))/thickness
            call check_relative(abs(found - expected)/abs(expected) + 1.0_wp, 1.0_wp, tolerance, &
               "table of the face")
         end do
      end do
      ! another that has learned something else, of which this one takes over what has more
      call other%describe(base_sliding, nu, ray)
      call other%compliance(1, p/thickness, radius(1)*thickness, thickness, found)
      call take_over(table, other)
      call table%compliance(1, p/thickness, radius(1)*thickness, thickness, expected)
      call check(.not. abs(found - expected) > 0.0_wp, "the same with what else is known")
      call other%describe(base_free, nu, ray)
      call other%compliance(1, p/thickness, radius(1)*thickness, thickness, found)
      call take_over(table, other)
      call table%describe(base_free, nu, ray)
      call table%compliance(1, p/thickness, radius(1)*thickness, thickness, expected)
      call check(.not. abs(found - expected) > 0.0_wp, "the table of another base")
      call check(abs(expected) > 0.0_wp, "which is not empty")
   end subroutine test_table

   !> Each measure by itself, on either side of both thresholds
   subroutine test_thresholds()
      real(wp), parameter :: below = 0.999_wp, above = 1.001_wp
      integer :: i

      call check(level_at(0, 0.0_wp) == level_good, "good where nothing is judged")
      do i = 1, size(thresholds)
         if (thresholds(i)%measure == 'energy_loss') cycle
         ! whole numbers
         if (thresholds(i)%measure == 'contacts') cycle
         associate (name => thresholds(i)%measure, row => thresholds(i))
            call check(level_at(i, below*row%caution) == level_good, name//" is good")
            call check(level_at(i, above*row%caution) == level_caution, name//": caution")
            call check(level_at(i, below*row%outside) == level_caution, name//": caution still")
            call check(level_at(i, above*row%outside) == level_outside, name//" is outside")
         end associate
      end do
      i = findloc(thresholds%measure, 'contacts', dim=1)
      call check(level_at(i, 1.0_wp) == level_good, "one contact")
      call check(level_at(i, 2.0_wp) == level_caution, "two contacts: caution")
      call check(level_at(i, 900.0_wp) == level_caution, "many contacts: caution still")
   end subroutine test_thresholds

   !> Level of an impact of which one measure is known, or none; it has to be the cause
   function level_at(measure, value) result(level)
      !> Its place in the table, 0: none
      integer, intent(in) :: measure
      !> Value that is held against the threshold
      real(wp), intent(in) :: value
      !> What it comes to
      integer :: level

      real(wp), parameter :: scale = 3.0_wp
      type(outcome_t) :: outcome
      type(surroundings_t) :: around

      outcome = with_loss(0.5_wp, 1.0_wp)
      outcome%sphere_ratio = 0.0_wp
      select case (measure)
      case (0)
         call check(outcome%validity == level_none, "nothing without a result")
      case (1)
         outcome%contact_ratio = value
      case (2)
         outcome%layer_strain = value
      case (3)
         around%extent = scale
         outcome%needed_extent = scale*value
      case (4)
         outcome%deflection_ratio = value
      case (5)
         outcome%highest_mode = 1.0_wp/value
      case (6)
         outcome%block_reach = value
      case (7)
         outcome%contacts = nint(value)
      case (8)
         outcome%weight_ratio = value
      case (9)
         ! a mass that is too small is judged as one that is too large
         outcome%mass_ratio = 1.0_wp/value
      case (10)
         around%yield_strength = scale
         outcome%mean_pressure = scale*value
      case (11)
         outcome%axis_tension = value
      case (12)
         ! below 0.5 the restitution itself does not matter
         outcome%cor_sphere = 0.25_wp
         outcome%cor_deviation = -0.5_wp*value
      case default
         call check(.false., "every measure is tested")
      end select
      call judge(outcome, around)
      level = outcome%validity
      call check(outcome%validity_cause == merge(measure, 0, level > level_good), "the cause")
   end function level_at

   !> An outcome of which only restitution and energies are known
   function with_loss(cor, energy_loss) result(outcome)
      !> Both coefficients of restitution
      real(wp), intent(in) :: cor
      !> Energy loss [J]
      real(wp), intent(in) :: energy_loss
      type(outcome_t) :: outcome

      outcome%cor = cor
      outcome%cor_sphere = cor
      outcome%cor_error = 1.0e-8_wp
      outcome%cor_sphere_error = 1.0e-8_wp
      outcome%initial_energy = 2.0_wp
      outcome%energy_imbalance = 0.0_wp
      outcome%energy_loss = energy_loss
   end function with_loss

   !> Energy from nothing is outside, whatever the measures say; rounding of a lossless impact is
   !> not
   subroutine test_gain()
      type(outcome_t) :: outcome
      type(surroundings_t) :: around
      integer :: i

      do i = 1, 4
         if (i == 1) outcome = with_loss(1.0_wp + 1.0e-6_wp, 1.0_wp)
         if (i == 2) outcome = with_loss(0.5_wp, -1.0e-6_wp)
         if (i == 3) outcome = with_loss(1.0_wp + 1.0e-9_wp, -1.0e-9_wp)
         if (i == 4) outcome = with_loss(0.5_wp, 1.0_wp)
         outcome%sphere_ratio = 0.0_wp
         outcome%contact_ratio = 0.9_wp
         call judge(outcome, around)
         call check(thresholds(outcome%validity_cause)%measure == merge('energy_loss  ', &
            'contact_ratio', i <= 2), "energy from nothing outweighs all else")
         call check(outcome%validity == level_outside, "and is outside")
      end do
   end subroutine test_gain

   !> The worst level counts, and in it what is farthest beyond its first threshold
   subroutine test_cause()
      type(outcome_t) :: outcome
      type(surroundings_t) :: around

      outcome = with_loss(0.5_wp, 1.0_wp)
      outcome%weight_ratio = 0.09_wp
      outcome%sphere_ratio = 0.0_wp
      outcome%contact_ratio = 0.5_wp
      call judge(outcome, around)
      call check(thresholds(outcome%validity_cause)%measure == 'weight_ratio', "nine times caution")
      outcome%contact_ratio = 0.9_wp
      call judge(outcome, around)
      call check(thresholds(outcome%validity_cause)%measure == 'contact_ratio', &
         "outside is worse than any caution")
   end subroutine test_cause

   !> Between equal steps the cubic of a cubic, in the last and shorter step too
   subroutine test_indentation()
      real(wp), parameter :: time(0:3) = [0.0_wp, 1.0_wp, 2.0_wp, 2.5_wp]
      real(wp), parameter :: between(4) = [0.3_wp, 1.0_wp, 1.9_wp, 2.4_wp]
      type(trajectory_t) :: trajectory
      integer :: i

      call trajectory%reserve(3)
      trajectory%last = 3
      trajectory%state(col_time, :) = time
      trajectory%state(col_indentation, :) = cubic(time)
      trajectory%state(col_velocity, :) = 2.0_wp - 3.0_wp*(time - 1.0_wp)**2
      do i = 1, size(between)
         call check_relative(trajectory%indentation_at(between(i)), cubic(between(i)), rounding, &
            "indentation between nodes")
      end do
   end subroutine test_indentation

   !> A cubic
   elemental function cubic(t)
      real(wp), intent(in) :: t
      real(wp) :: cubic

      cubic = 3.0_wp + 2.0_wp*t - (t - 1.0_wp)**3
   end function cubic

end program test_validity
