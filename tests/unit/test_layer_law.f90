!> Contact laws of a layer on a rigid base and of the true sphere
!>
!> The values are from a solution of the Fredholm equation with dense matrices in Python, which
!> doubling its nodes changes by 2e-12 at most (`tests/reference/make_layers.py`).
program test_layer_law
   use vcor_error, only : error_t
   use vcor_impact_law, only : cone_factor, contact_law_t, new_contact_law, profile_factor, &
      punch_factor
   use vcor_impact_layer_law, only : lay, layer_t, profile_t
   use vcor_impact_response, only : base_bonded, base_half_space, base_sliding, static_response
   use vcor_kinds, only : pi, wp
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : success
   implicit none

   !> Accuracy of the tables, and that of their slope, which is a derivative
   real(wp), parameter :: accuracy = 1.0e-10_wp, of_slope = 1.0e-9_wp
   !> Radius of the body and thickness of the layer [m]
   real(wp), parameter :: radius = 0.02_wp, thickness = 0.005_wp

   call suite("layer_law")
   call test_kernel()
   call test_values()
   call test_punch_stiffness()
   call test_small()
   call test_thin()
   call test_nearly_incompressible()
   call test_shapes()
   call test_true_sphere()
   call test_share()
   call test_procedures()
   call test_kept()
   call test_depths()
   call finish()

contains

   !> Law of a paraboloid on a layer
   subroutine make_law(law, base, poisson_ratio, of_thickness)
      type(contact_law_t), intent(out) :: law
      !> One of the `base_*` constants
      integer, intent(in) :: base
      !> Poisson's ratio [-]
      real(wp), intent(in) :: poisson_ratio
      !> Thickness [m]
      real(wp), intent(in) :: of_thickness

      type(error_t), allocatable :: error

      call lay(law, layer_t(base, poisson_ratio, 1.0_wp, of_thickness), profile_t(), hertz(), error)
      call success(error, "the law of a layer is built")
   end subroutine make_law

   !> Factor K of the paraboloid [m^0.5]
   pure real(wp) function hertz()
      hertz = 4.0_wp/3.0_wp*sqrt(radius)
   end function hertz

   !> S, half the force of a punch per indentation and E' [m]
   function stiffness(layer, of_radius) result(half)
      type(layer_t), intent(in) :: layer
      !> Radius of the punch [m]
      real(wp), intent(in) :: of_radius
      !> S [m]
      real(wp) :: half

      type(contact_law_t) :: law
      type(error_t), allocatable :: error

      call new_contact_law(law, 1.0_wp, .false., error)
      call lay(law, layer, profile_t(0.0_wp), punch_factor(of_radius), error)
      call success(error, "a punch on a layer is built")
      half = 0.5_wp*punch_factor(of_radius)*law%slope(1.0e-4_wp)
   end function stiffness

   !> The kernel of the integral equation: 1 - L from 60 digits, and its limits
   subroutine test_kernel()
      real(wp), parameter :: x(3) = [0.1_wp, 1.0_wp, 3.0_wp]

      call check_relative(-static_response(base_bonded, 0.5_wp, x), [0.9993451182235_wp, &
         0.7594183188173_wp, 0.1132791459247_wp], 1.0e-12_wp, "bonded, nu = 0.5")
      call check_relative(-static_response(base_bonded, 0.3_wp, x), [0.9591549555763_wp, &
         0.5842482015435_wp, 0.06817303361996_wp], 1.0e-12_wp, "bonded, nu = 0.3")
      call check_relative(-static_response(base_sliding, 0.5_wp, x), [0.9500001108995_wp, &
         0.5091053463435_wp, 0.03368838708349_wp], 1.0e-12_wp, "sliding")
      call check(.not. any(abs(static_response(base_half_space, 0.3_wp, x)) > 0.0_wp), &
         "the half space has none")
   end subroutine test_kernel

   !> Force, stiffness and contact radius at given indentations, thin to thick
   subroutine test_values()
      real(wp), parameter :: chi(7) = [0.05_wp, 0.1_wp, 0.2_wp, 0.3_wp, 0.5_wp, 0.8_wp, 1.0_wp]
      real(wp), parameter :: bonded(7) = [1.060242018014_wp, 1.129082002714_wp, &
         1.297945555919_wp, 1.518216115282_wp, 2.156215005822_wp, 3.688382357019_wp, &
         5.115373760664_wp]
      real(wp), parameter :: bonded_slope(7) = [1.081686200807_wp, 1.178127052867_wp, &
         1.426319906241_wp, 1.768151740015_wp, 2.810713445087_wp, 5.369798473918_wp, &
         7.777231501068_wp]
      real(wp), parameter :: bonded_radius(7) = [1.019653934766_wp, 1.040984865655_wp, &
         1.087964270976_wp, 1.138673041867_wp, 1.23827361124_wp, 1.353901569776_wp, &
         1.409487479108_wp]
      real(wp), parameter :: sliding(7) = [1.03881904678_wp, 1.081114414263_wp, &
         1.17709446533_wp, 1.289588913625_wp, 1.566844877914_wp, 2.098013874824_wp, &
         2.504503080635_wp]
      ! s R/H^2 and F over Hertz' at a/H = 2, 5, 10 and 20
      real(wp), parameter :: wide(4) = [2.0_wp, 5.0_wp, 10.0_wp, 19.99_wp]
      real(wp), parameter :: depth(3) = [1.81961128623_wp, 8.978117264293_wp, 31.22602044131_wp]
      real(wp), parameter :: force(3) = [8.46801102344_wp, 46.2161525517_wp, 235.5992781135_wp]
      type(contact_law_t) :: law
      real(wp) :: s(7)
      integer :: i

      s = (chi*thickness)**2/radius
      call make_law(law, base_bonded, 0.5_wp, thickness)
      do i = 1, size(s)
         call check_relative(law%u(s(i)), bonded(i)*s(i)**1.5_wp, accuracy, "bonded: force")
         call check_relative(law%slope(s(i)), bonded_slope(i)*1.5_wp*sqrt(s(i)), of_slope, &
            "bonded: stiffness")
         call check_relative(law%radius(hertz(), s(i)), bonded_radius(i)*sqrt(radius*s(i)), &
            accuracy, "bonded: contact radius")
         call check_relative(law%stiffening(s(i)), bonded(i), accuracy, "bonded: stiffening")
      end do
      do i = 1, 3
         call check_relative(law%u(depth(i)*thickness**2/radius), force(i)*(depth(i) &
            *thickness**2/radius)**1.5_wp, accuracy, "a thin layer")
         call check_relative(law%radius(hertz(), depth(i)*thickness**2/radius), &
            wide(i)*thickness, accuracy, "a thin layer: contact radius")
      end do
      call make_law(law, base_sliding, 0.31_wp, thickness)
      do i = 1, size(s)
         call check_relative(law%u(s(i)), sliding(i)*s(i)**1.5_wp, accuracy, &
            "sliding, whatever Poisson's ratio: force")
      end do
   end subroutine test_values

   !> dF/ds = 2 E' S(a) for every body, S that of a punch, and ds/da = (2/R) S/S' for a paraboloid
   subroutine test_punch_stiffness()
      real(wp), parameter :: chi(4) = [0.02_wp, 0.4_wp, 1.7_wp, 6.0_wp], step = 1.0e-3_wp
      type(contact_law_t) :: law, cone
      type(layer_t) :: layer
      type(error_t), allocatable :: error
      real(wp) :: s, a, slope
      integer :: i

      layer = layer_t(base_bonded, 0.42_wp, 1.0_wp, thickness)
      call make_law(law, base_bonded, 0.42_wp, thickness)
      call new_contact_law(cone, 2.0_wp, .false., error)
      call lay(cone, layer, profile_t(1.0_wp), cone_factor(45.0_wp), error)
      call success(error, "a cone on a layer is built")
      do i = 1, size(chi)
         s = (chi(i)*thickness)**2/radius
         a = law%radius(hertz(), s)
         call check_relative(0.5_wp*hertz()*law%slope(s), stiffness(layer, a), of_slope, &
            "dF/ds = 2 E' S of a paraboloid")
         slope = (log(law%radius(hertz(), s*(1.0_wp + step))) &
            - log(law%radius(hertz(), s*(1.0_wp - step))))/(2.0_wp*s*step)
         call check_relative(1.0_wp/slope, 2.0_wp*a/radius*stiffness(layer, a)*2.0_wp*a*step &
            /(stiffness(layer, a*(1.0_wp + step)) - stiffness(layer, a*(1.0_wp - step))), &
            step**2, "ds/da = (2/R) S/S'")
         call check_relative(0.5_wp*cone_factor(45.0_wp)*cone%slope(s), &
            stiffness(layer, cone%radius(cone_factor(45.0_wp), s)), of_slope, &
            "dF/ds = 2 E' S of a cone")
      end do
   end subroutine test_punch_stiffness

   !> A thick layer is a half space, and F/F_Hertz = 1 + 2 k_0 chi with the moment of the kernel
   subroutine test_small()
      real(wp), parameter :: moment(2) = [0.5634774996515_wp, 0.371651250225_wp]
      integer, parameter :: bases(2) = [base_bonded, base_sliding]
      real(wp), parameter :: s(2) = [1.0e-7_wp, 4.0e-7_wp]
      type(contact_law_t) :: law
      real(wp) :: rest(2), chi(2)
      integer :: i

      chi = sqrt(radius*s)/thickness
      do i = 1, size(bases)
         call make_law(law, bases(i), 0.5_wp, 1.0e8_wp)
         call check_relative(law%u(s), s**1.5_wp, accuracy, "a thick layer is a half space")
         call make_law(law, bases(i), 0.5_wp, thickness)
         rest = law%u(s)/s**1.5_wp - 1.0_wp - 2.0_wp*moment(i)*chi
         call check(all(abs(rest) < 4.0_wp*chi**2), "the first term of the series")
         call check_close(log(rest(2)/rest(1))/log(2.0_wp), 2.0_wp, 0.1_wp, "the order of the rest")
      end do
   end subroutine test_small

   !> The limits of thin layers, and the order of the approach in H/a: faster for a sliding one
   subroutine test_thin()
      real(wp), parameter :: depth(2) = [28.0_wp, 110.0_wp], order(3) = [3.0_wp, 2.0_wp, 2.0_wp]
      type(contact_law_t) :: law
      real(wp) :: force(2), rest(2), a(2), s(2), limit(2), nu
      integer :: kind

      s = depth*thickness**2/radius
      do kind = 1, 3
         nu = merge(0.5_wp, 0.3_wp, kind == 3)
         call make_law(law, merge(base_sliding, base_bonded, kind == 1), nu, thickness)
         a = law%radius(hertz(), s)
         force = hertz()*law%u(s)
         limit = pi*radius*s**2/thickness
         if (kind == 2) limit = limit*(1.0_wp - nu)**2/(1.0_wp - 2.0_wp*nu)
         if (kind == 3) limit = 0.5_wp*pi*radius**2*s**3/thickness**3
         rest = abs(force/limit - 1.0_wp)
         call check(all(rest < 25.0_wp*(thickness/a)**2), "the limit of a thin layer")
         call check_close(log(rest(1)/rest(2))/log(a(2)/a(1)), order(kind), 0.3_wp, &
            "the order of its approach")
         call check_relative(a, sqrt(merge(4.0_wp, 2.0_wp, kind == 3)*radius*s), 2.0_wp &
            *maxval(thickness/a), "its contact radius")
      end do
   end subroutine test_thin

   !> A layer that is not thin does not notice the last thousandth of incompressibility
   subroutine test_nearly_incompressible()
      real(wp), parameter :: ratio(3) = [0.498_wp, 0.499_wp, 0.5_wp]
      type(contact_law_t) :: law
      real(wp) :: u(3)
      integer :: i

      do i = 1, 3
         call make_law(law, base_bonded, ratio(i), thickness)
         u(i) = law%u((0.5_wp*thickness)**2/radius)
      end do
      call check_relative(u(2), u(3), 5.0e-3_wp, "nu = 0.499 is nearly 0.5")
      call check_close((u(3) - u(2))/(u(2) - u(1)), 1.0_wp, 0.05_wp, "and the limit is smooth")
   end subroutine test_nearly_incompressible

   !> Cone and power on a layer
   subroutine test_shapes()
      real(wp), parameter :: s(2) = [0.2802597310947_wp, 0.6054979968854_wp]
      real(wp), parameter :: force(2) = [0.06322193113769_wp, 0.42450710925_wp]
      type(contact_law_t) :: law
      type(layer_t) :: layer
      type(error_t), allocatable :: error
      real(wp) :: factor

      layer = layer_t(base_bonded, 0.5_wp, 1.0_wp, thickness)
      call new_contact_law(law, 2.0_wp, .false., error)
      call lay(law, layer, profile_t(1.0_wp), cone_factor(45.0_wp), error)
      call success(error, "a cone on a layer is built")
      call check_relative(cone_factor(45.0_wp)*law%u(s*thickness), force*thickness**2, accuracy, &
         "force of a cone")
      call check_relative(law%radius(cone_factor(45.0_wp), s*thickness), [0.2_wp, 0.5_wp] &
         *thickness, accuracy, "contact radius of a cone")
      ! the paraboloid by its profile, z = r^2/(2 R)
      factor = profile_factor(0.5_wp/radius, 2.0_wp)
      call new_contact_law(law, 1.5_wp, .false., error)
      call lay(law, layer, profile_t(2.0_wp), factor, error)
      call check_relative(factor*law%u((0.5_wp*thickness)**2/radius), hertz()*2.156215005822_wp &
         *((0.5_wp*thickness)**2/radius)**1.5_wp, accuracy, "a paraboloid by its profile")
   end subroutine test_shapes

   !> The sphere itself: on a half space in closed form, on a layer twice as thick as its radius
   subroutine test_true_sphere()
      real(wp), parameter :: part(4) = [1.0e-4_wp, 0.05_wp, 0.4_wp, 0.83_wp]
      real(wp), parameter :: s(2) = [0.01876437526885_wp, 0.07241462152237_wp]
      real(wp), parameter :: force(2) = [0.002712637475987_wp, 0.02299937327218_wp]
      type(contact_law_t) :: law
      type(error_t), allocatable :: error
      real(wp) :: a(4), depth(4), expected(4), high

      call lay(law, layer_t(), profile_t(radius=radius), hertz(), error)
      call success(error, "a true sphere is built")
      a = part*radius
      depth = a*atanh(part)
      expected = (radius**2 + a**2)*atanh(part) - radius*a
      call check_relative(hertz()*law%u(depth(2:)), expected(2:), accuracy, &
         "force of a true sphere")
      call check_relative(law%radius(hertz(), depth), a, accuracy, "its contact radius")
      call check_relative(law%stiffening(depth(3)), 1.0_wp, accuracy, "a half space is not a layer")
      call check_relative(law%profile(hertz(), a), depth, accuracy, "its profile")
      call check(law%profile(hertz(), radius) > 18.0_wp*radius, &
         "there is nothing beyond its radius")
      call check(radius < law%deepest() .and. law%deepest() < 1.2_wp*radius, &
         "it may be as deep as its radius")
      high = 2.0_wp*radius
      call lay(law, layer_t(base_bonded, 0.5_wp, 1.0_wp, high), profile_t(radius=radius), hertz(), &
         error)
      call success(error, "a true sphere on a layer is built")
      call check_relative(hertz()*law%u(s*high), force*high**2, accuracy, "its force on a layer")
      call check_relative(law%radius(hertz(), s*high), [0.1_wp, 0.2_wp]*high, accuracy, &
         "its contact radius on a layer")
      ! a sphere much larger than the layer is a paraboloid
      call lay(law, layer_t(base_bonded, 0.5_wp, 1.0_wp, 1.0e-4_wp*radius), &
         profile_t(radius=radius), hertz(), error)
      call check_relative(law%u(1.0e-8_wp*radius), 5.115373760664_wp*(1.0e-8_wp*radius)**1.5_wp, &
         1.0e-7_wp, "a large sphere on a thin layer is a paraboloid")
   end subroutine test_true_sphere

   !> Only the layer's share in the compliance is stiffened
   subroutine test_share()
      real(wp), parameter :: s = 1.0e-8_wp, moment = 0.5634774996515_wp
      type(contact_law_t) :: law
      type(error_t), allocatable :: error

      call lay(law, layer_t(base_bonded, 0.5_wp, 0.25_wp, thickness), profile_t(), hertz(), error)
      call success(error, "a sphere that deforms is built")
      call check_close((law%stiffening(s) - 1.0_wp)/(0.5_wp*moment*sqrt(radius*s)/thickness), &
         1.0_wp, 0.01_wp, "a quarter of the compliance")
      call lay(law, layer_t(base_bonded, 0.5_wp, 0.0_wp, thickness), profile_t(), hertz(), error)
      call check_relative(law%u(1.0e-3_wp), 1.0e-3_wp**1.5_wp, accuracy, "no share")
   end subroutine test_share

   !> What solvers ask of a table
   subroutine test_procedures()
      real(wp), parameter :: s(5) = [-3.0e-4_wp, 0.0_wp, 1.0e-9_wp, 2.0e-4_wp, 0.03_wp]
      real(wp), parameter :: mass = 0.1_wp, firmness = 3.0e7_wp, velocity = 2.0_wp
      integer, parameter :: parts = 4000
      type(contact_law_t) :: law
      real(wp) :: secant(5), slope(5), found, deepest, energy
      integer :: i

      call make_law(law, base_bonded, 0.5_wp, thickness)
      call law%evaluate(size(s), s, secant, slope)
      call check(.not. any(abs(secant - law%secant(s)) + abs(slope - law%slope(s)) > 0.0_wp), &
         "many values are the same")
      call check(.not. abs(law%u(s(1)) + law%u(-s(1))) > 0.0_wp, "u is odd")
      call check(.not. abs(law%slope(s(1)) - law%slope(-s(1))) > 0.0_wp, "u' is even")
      call check_relative(law%inverse(law%u(s(3:))), s(3:), 1.0e-12_wp, "inverse of u")
      do i = 3, 5
         call law%solve(2.0_wp, 0.0_wp, s(i) + 2.0_wp*law%u(s(i)), 0.5_wp*s(i), found)
         call check_relative(found, s(i), 1.0e-12_wp, "root of the equation of a step")
         call law%solve(2.0_wp, 0.0_wp, -s(i) - 2.0_wp*law%u(s(i)), 1.0_wp, found)
         call check_relative(found, -s(i), 1.0e-12_wp, "root beyond the end of contact")
      end do
      ! the table continues as a power
      call check(s(5) < law%deepest() .and. law%deepest() < 1.0_wp, "the end of the table")
      call check_relative(law%slope(2.0_wp)/law%secant(2.0_wp), law%slope(1.0_wp) &
         /law%secant(1.0_wp), 1.0e-12_wp, "beyond, u is a power")
      ! the depth of an elastic impact, from its energy
      deepest = law%depth*velocity*law%time_scale(mass, firmness, velocity)
      energy = 0.0_wp
      do i = 1, parts
         energy = energy + firmness*law%u(deepest*(real(i, wp) - 0.5_wp)/real(parts, wp))*deepest &
            /real(parts, wp)
      end do
      call check_relative(energy, 0.5_wp*mass*velocity**2, 0.1_wp, "depth of an elastic impact")
   end subroutine test_procedures

   !> A table is kept for other sizes of body and layer, and not for another layer
   subroutine test_kept()
      type(contact_law_t) :: law, other
      type(error_t), allocatable :: error
      real(wp) :: s

      call make_law(law, base_sliding, 0.3_wp, thickness)
      other = law
      call lay(other, layer_t(base_sliding, 0.3_wp, 1.0_wp, 3.0_wp*thickness), profile_t(), &
         hertz(), error)
      s = 1.0e-4_wp
      call check_relative(other%stiffening(9.0_wp*s), law%stiffening(s), 1.0e-14_wp, &
         "similar contacts are equally stiff")
      call lay(other, layer_t(base_bonded, 0.3_wp, 1.0_wp, thickness), profile_t(), hertz(), error)
      call check(other%stiffening(s) > 1.01_wp*law%stiffening(s), "a bonded layer is stiffer")
      call lay(other, layer_t(base_sliding, 0.3_wp, 1.0_wp, thickness), profile_t(), hertz(), error)
      call check(.not. abs(other%u(s) - law%u(s)) > 0.0_wp, "the same law again, to the last bit")
   end subroutine test_kept

   !> A law that is asked for small indentations is that for all, and the depth of a body is found
   subroutine test_depths()
      real(wp), parameter :: needed(4) = [1.0e-5_wp, 1.0e-3_wp, 0.02_wp, huge(1.0_wp)]
      type(contact_law_t) :: law, again, whole
      type(layer_t) :: layer
      type(error_t), allocatable :: error
      real(wp) :: s, before
      integer :: i

      layer = layer_t(base_bonded, 0.46_wp, 1.0_wp, thickness)
      call make_law(whole, layer%base, layer%poisson_ratio, thickness)
      before = 0.0_wp
      do i = 1, size(needed)
         call lay(law, layer, profile_t(), hertz(), error, needed(i))
         call success(error, "a law up to an indentation is built")
         call check(law%deepest() >= min(needed(i), whole%deepest()), "it reaches as far")
         call check(law%deepest() > before, "and not much farther")
         before = law%deepest()
         s = min(needed(i), 0.99_wp*whole%deepest())
         call check_relative(law%u(s), whole%u(s), accuracy, "the same force")
         call check_relative(law%slope(s), whole%slope(s), of_slope, "the same stiffness")
         call check_relative(law%radius(hertz(), s), whole%radius(hertz(), s), accuracy, &
            "the same contact radius")
      end do
      ! what has been tabulated before leaves no trace
      call lay(again, layer, profile_t(), hertz(), error, needed(1))
      call lay(law, layer, profile_t(), hertz(), error, needed(1))
      s = needed(1)
      call check(.not. abs(law%u(s) - again%u(s)) > 0.0_wp, "the same, to the last bit")
      call check(.not. abs(law%deepest() - again%deepest()) > 0.0_wp, "and as deep")
      ! a punch has one contact radius
      call new_contact_law(law, 1.0_wp, .false., error)
      call lay(law, layer, profile_t(0.0_wp), punch_factor(3.0_wp*thickness), error, 1.0e-3_wp)
      call check(law%deepest() > 1.0_wp, "a punch may go to any depth")
      call check_relative(0.5_wp*punch_factor(3.0_wp*thickness)*law%slope(1.0e-3_wp), &
         stiffness(layer, 3.0_wp*thickness), accuracy, "its stiffness is that of all depths")
   end subroutine test_depths

end program test_layer_law
