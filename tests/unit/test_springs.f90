!> Contacts that grow again, spring by spring, compared with the numbers of
!> tests/reference/regrowth.py
program test_springs
   use vcor_error, only : error_t
   use vcor_impact_law, only : contact_law_t, new_contact_law
   use vcor_impact_layer_law, only : lay, layer_t, profile_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_target, only : new_plate, waves_none, waves_relaxing
   use vcor_impact_problem, only : impact_t
   use vcor_impact_response, only : base_bonded
   use vcor_kinds, only : pi, wp
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_elastic, new_prony, prony_t
   use vcor_material_type, only : material_t
   use vcor_solver_direct_product, only : product_t
   use vcor_solver_direct_springs, only : springs_t
   use vcor_solver_direct_weights, only : contact_kernel_t
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : make_product, rigid_on_plate, run, success
   implicit none

   !> Depth [m] and duration [s] of the indentation that is prescribed
   real(wp), parameter :: depth = 1.0e-3_wp, duration = 4.0e-3_wp
   !> Parts of the duration at which the force is compared
   real(wp), parameter :: at(4) = [0.5_wp, 0.6_wp, 0.8_wp, 1.0_wp]
   !> Modulus of the plate [Pa], of which rubber keeps a tenth, and its rate [1/s]
   real(wp), parameter :: glassy = 15.0e6_wp, rubbery = 1.5e6_wp, rate = 1000.0_wp
   real(wp), parameter :: poisson_ratio = 0.45_wp, density = 1100.0_wp, velocity = 5.0_wp
   !> The least order of convergence that counts as the second
   real(wp), parameter :: least_order = 1.8_wp

   call suite("springs")
   call test_elastic()
   call test_layer()
   call test_prescribed()
   call test_singular()
   call test_impacts()
   call test_order()
   call finish()

contains

   !> Rubber
   subroutine make_rubber(rubber, viscosity)
      !> The material
      type(prony_t), intent(out) :: rubber
      !> Its viscosity [Pa s]
      real(wp), intent(in) :: viscosity

      type(error_t), allocatable :: error

      call new_prony(rubber, rubbery, [glassy - rubbery], [rate], viscosity, error)
      call success(error, "a rubber is built")
   end subroutine make_rubber

   !> A contact of a material and an exponent
   subroutine make_contact(material, exponent, impact)
      !> The material
      class(material_t), intent(inout) :: material
      !> Exponent of the law [-]
      real(wp), intent(in) :: exponent
      !> The impact
      type(impact_t), intent(out) :: impact

      type(error_t), allocatable :: error

      call material%set_constants(error, density, poisson_ratio)
      call rigid_on_plate(material, waves_none, velocity, impact)
      call new_contact_law(impact%law, exponent, .true., error)
      call success(error, "a contact law is built")
   end subroutine make_contact

   !> Indentation with a small growth after the first maximum, and a last one beyond it
   elemental function wave(x) result(s)
      !> Part of the duration
      real(wp), intent(in) :: x
      !> Indentation [m]
      real(wp) :: s

      s = depth*(x + 0.25_wp*sin(2.0_wp*pi*x) + 0.05_wp*sin(8.0_wp*pi*x))
   end function wave

   !> Forces where that indentation is prescribed
   function forces(impact, steps, touched) result(force)
      !> The contact
      type(impact_t), intent(in) :: impact
      !> Number of steps, a multiple of 10
      integer, intent(in) :: steps
      !> Times at which the body first touched the edge of then, in units of the step
      real(wp), intent(out), optional :: touched(4)
      !> Forces at the parts `at` of the duration [N]
      real(wp) :: force(4)

      type(contact_kernel_t) :: kernel
      type(springs_t) :: springs
      real(wp) :: s(0:steps), ds(steps), value(steps), t1(steps)
      integer :: n, turn

      s = wave([(real(n, wp)/real(steps, wp), n=0, steps)])
      ds = s(1:) - s(:steps - 1)
      turn = findloc(ds <= 0.0_wp, .true., 1) - 1
      call kernel%prepare(impact, duration/real(steps, wp), steps)
      call springs%start(impact, kernel, turn + 1, turn, s, ds)
      do n = turn + 2, steps
         call springs%find_force(impact, kernel, n, s(n - 1), ds, [s(n), 0.0_wp], value(n), t1(n))
      end do
      force = value(nint(at*real(steps, wp)))
      if (present(touched)) touched = t1(nint(at*real(steps, wp)))
   end function forces

   !> An elastic contact has Hertz's force whatever happens
   subroutine test_elastic()
      real(wp), parameter :: tolerance = 1.0e-12_wp, exponent(3) = [1.2_wp, 1.5_wp, 2.0_wp]
      type(prony_t) :: elastic
      type(impact_t) :: impact
      type(error_t), allocatable :: error
      real(wp) :: force(4)
      integer :: i, j

      call new_elastic(elastic, glassy, error)
      do i = 1, size(exponent)
         call make_contact(elastic, exponent(i), impact)
         force = forces(impact, 200)
         do j = 1, size(at)
            call check_relative(force(j), impact%kernel(0.0_wp)*impact%law%u(wave(at(j))), &
               tolerance, "an elastic contact that grows again")
         end do
      end do
   end subroutine test_elastic

   !> On a layer an elastic contact has the layer's force, and the edge of any contact refers to the
   !> same time as on a half space
   subroutine test_layer()
      real(wp), parameter :: thickness = 3.0e-3_wp, tolerance = 1.0e-9_wp
      type(prony_t) :: material
      type(impact_t) :: impact
      type(error_t), allocatable :: error
      real(wp) :: force(4), plain(4), touched(4), touched_layer(4)
      integer :: j

      call new_elastic(material, glassy, error)
      call make_contact(material, 1.5_wp, impact)
      call lay(impact%law, layer_t(base_bonded, poisson_ratio, 1.0_wp, thickness), profile_t(), &
         impact%factor, error)
      call success(error, "a layer is built")
      force = forces(impact, 200)
      do j = 1, size(at)
         call check_relative(force(j), impact%kernel(0.0_wp)*impact%law%u(wave(at(j))), &
            tolerance, "an elastic contact with a layer")
      end do
      call make_rubber(material, 0.0_wp)
      call make_contact(material, 1.5_wp, impact)
      plain = forces(impact, 200, touched)
      call lay(impact%law, layer_t(base_bonded, poisson_ratio, 1.0_wp, thickness), profile_t(), &
         impact%factor, error)
      force = forces(impact, 200, touched_layer)
      call check(all(force > 1.1_wp*plain), "a layer is stiffer")
      call check_relative(touched_layer, touched, 1.0e-12_wp, &
         "the time t1 does not depend on the thickness")
   end subroutine test_layer

   !> Forces of a sphere on rubber, with a dashpot too, and of a cone
   subroutine test_prescribed()
      real(wp), parameter :: expected(4, 3) = reshape([7.77430832_wp, 4.53914743_wp, &
         14.40741667_wp, 41.60040797_wp, 8.04996_wp, 4.06076_wp, 15.27158_wp, 43.87416_wp, &
         0.17549298444_wp, 0.09391468413_wp, 0.4024345565_wp, 1.5012999875_wp], [4, 3])
      real(wp), parameter :: exponent(3) = [1.5_wp, 1.5_wp, 2.0_wp]
      real(wp), parameter :: viscosity(3) = [0.0_wp, 300.0_wp, 0.0_wp]
      ! with a step of 1/800 of the duration
      real(wp), parameter :: tolerance(3) = [1.0e-5_wp, 1.0e-4_wp, 1.0e-5_wp]
      type(prony_t) :: rubber
      type(impact_t) :: impact
      real(wp) :: coarse(4), fine(4)
      integer :: i, j

      do i = 1, size(exponent)
         call make_rubber(rubber, viscosity(i))
         call make_contact(rubber, exponent(i), impact)
         coarse = forces(impact, 400)
         fine = forces(impact, 800)
         do j = 1, size(at)
            call check_relative(fine(j), expected(j, i), tolerance(i), "a prescribed indentation")
            ! with a dashpot the force of the springs at a growing edge jumps
            if (.not. viscosity(i) > 0.0_wp) call check(abs(fine(j) - expected(j, i)) &
               <= abs(coarse(j) - expected(j, i))*0.5_wp**least_order, &
               "a prescribed indentation: second order")
         end do
      end do
   end subroutine test_prescribed

   !> A kernel that is infinite at first: with the force as int k V', V = int w u'' dsigma, in place
   !> of int phi u'' dsigma, extrapolated
   subroutine test_singular()
      real(wp), parameter :: expected(4) = [8.18116_wp, 3.31208_wp, 17.55474_wp, 41.90834_wp]
      real(wp), parameter :: tolerance = 5.0e-5_wp
      type(power_law_t) :: power_law
      type(impact_t) :: impact
      type(error_t), allocatable :: error
      real(wp) :: force(4)
      integer :: j

      call new_power_law(power_law, 1.0e6_wp, 2.0e5_wp, 0.5_wp, error)
      call success(error, "a power law is built")
      call make_contact(power_law, 1.5_wp, impact)
      force = forces(impact, 800)
      do j = 1, size(at)
         call check_relative(force(j), expected(j), tolerance, "a singular kernel")
      end do
   end subroutine test_singular

   !> Impacts on plates that relax
   subroutine test_impacts()
      real(wp), parameter :: half_thickness(3) = [8.0e-3_wp, 8.0e-3_wp, 7.0e-3_wp]
      real(wp), parameter :: gravity(3) = [0.0_wp, 1.0_wp, 0.0_wp]
      real(wp), parameter :: viscosity(3) = [0.0_wp, 0.0_wp, 300.0_wp]
      real(wp), parameter :: cor(3) = [0.0131984545_wp, 0.0127004196_wp, 0.0119194191_wp]
      real(wp), parameter :: cor_sphere(3) = [0.0131746304_wp, 0.0126835971_wp, 0.0119142999_wp]
      real(wp), parameter :: time(3) = [0.0123566427_wp, 0.0127066636_wp, 0.0141601997_wp]
      real(wp), parameter :: accuracy = 2.0e-5_wp, in_time = 2.0e-3_wp, imbalance = accuracy
      type(product_t) :: product
      type(prony_t) :: rubber
      type(impact_t) :: impact
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      integer :: i

      call make_product(0.0_wp, accuracy, product)
      do i = 1, size(cor)
         call make_rubber(rubber, viscosity(i))
         call make_contact(rubber, 1.5_wp, impact)
         call new_plate(impact%target, rubber, half_thickness(i), waves_relaxing, error)
         call success(error, "a light plate is built")
         impact%gravity = gravity(i)
         call run(product, impact, outcome)
         call check_close(outcome%cor, cor(i), outcome%cor_error, "regrowth: cor")
         call check_close(outcome%cor_sphere, cor_sphere(i), outcome%cor_sphere_error, &
            "regrowth: cor_sphere")
         call check_close(outcome%cor_error, 0.0_wp, accuracy, "regrowth: stated error")
         call check_relative(outcome%contact_time, time(i), in_time, "regrowth: contact time")
         call check_close(outcome%energy_imbalance/outcome%initial_energy, 0.0_wp, imbalance, &
            "regrowth: energy")
      end do
   end subroutine test_impacts

   !> Such an impact converges with the square of the step
   subroutine test_order()
      real(wp), parameter :: exact = 0.0131984545_wp, step = 1.6e-5_wp
      type(product_t) :: coarse, fine
      type(prony_t) :: rubber
      type(impact_t) :: impact
      type(outcome_t) :: one, other
      type(error_t), allocatable :: error

      call make_rubber(rubber, 0.0_wp)
      call make_contact(rubber, 1.5_wp, impact)
      call new_plate(impact%target, rubber, 8.0e-3_wp, waves_relaxing, error)
      call success(error, "a light plate is built")
      call make_product(step, 0.1_wp, coarse)
      call make_product(0.5_wp*step, 0.1_wp, fine)
      call run(coarse, impact, one)
      call run(fine, impact, other)
      call check(log(abs(one%cor - exact)/abs(other%cor - exact))/log(2.0_wp) >= least_order, &
         "product integration of a contact that grows again is of second order")
   end subroutine test_order

end program test_springs
