!> Bodies of simple shape that are struck: block, beam, rod and plate as structures
!>
!> The modes are those of Euler and Bernoulli's beam, of the thin rod in its length and of
!> Kirchhoff's plate. Those with frequencies above a limit are kept together, with their
!> flexibility: that under a static force less that of the modes kept, both of which are known in
!> closed form. The frequencies are those with the storage modulus E_ref of the material at the
!> limit.
module vcor_impact_body
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_structure, only : new_structure, rest_t, structure_t
   use vcor_kinds, only : pi, wp
   use vcor_material_type, only : material_t
   use vcor_numeric_quadrature, only : gauss_nodes
   use vcor_tuning, only : most_iterations
   implicit none
   private

   public :: new_block, new_beam, new_rod, new_panel
   public :: support_supported, support_clamped, support_cantilever, support_free

   !> Supports: of both ends of a beam or all edges of a plate; of one end
   integer, parameter :: support_supported = 1
   integer, parameter :: support_clamped = 2
   integer, parameter :: support_cantilever = 3
   integer, parameter :: support_free = 4

   !> Square of a shape, over its largest value, below which a mode is not excited: the rounding of
   !> a position on a node
   real(wp), parameter :: at_node = 1.0e-12_wp
   !> What is wrong with such a position
   character(len=*), parameter :: on_support = 'the impact is on a support, where the structure ' &
      //'does not move'
   !> Loss of the modes beyond the limit, beyond which N/D would feed energy near u = 1
   real(wp), parameter :: most_loss = 0.55_wp
   !> Most modes of a body: a collocation panel takes 50 ns for each
   integer, parameter :: most_modes = 200000

contains

   !> A rigid block on a spring and a dashpot, either of which may be missing
   pure subroutine new_block(self, mass, stiffness, damping, error)
      type(structure_t), intent(out) :: self
      !> Mass [kg], > 0
      real(wp), intent(in) :: mass
      !> Stiffness of the spring [N/m], >= 0
      real(wp), intent(in) :: stiffness
      !> Coefficient of the dashpot [N s/m], >= 0
      real(wp), intent(in) :: damping
      type(error_t), allocatable, intent(out) :: error

      if (mass > 0.0_wp) then
         call new_structure(self, [stiffness/mass], [damping/mass], [1.0_wp/mass], error)
      else
         call raise(error, error_input, 'expected a mass > 0 of a block', about='mass')
      end if
   end subroutine new_block

   !> Check what a body is made of
   pure subroutine check_body(material, sizes, damping_ratio, highest, error)
      class(material_t), intent(in) :: material
      !> Sizes of the body [m]
      real(wp), intent(in) :: sizes(:)
      !> Damping ratio of all modes [-]
      real(wp), intent(in) :: damping_ratio
      !> Frequency up to which modes are kept [rad/s]
      real(wp), intent(in) :: highest
      type(error_t), allocatable, intent(out) :: error

      if (.not. material%is_built()) then
         call raise(error, error_input, 'the material of the structure is empty: no procedure ' &
            //'new_... has built it')
      else if (material%rigid .or. .not. material%density() > 0.0_wp) then
         call raise(error, error_input, 'a structure needs a material that deforms, and its ' &
            //'density', about='density')
      else if (.not. (all([sizes, highest] > 0.0_wp) .and. damping_ratio >= 0.0_wp)) then
         call raise(error, error_input, 'expected sizes and a highest frequency > 0 of a ' &
            //'structure, and a damping ratio >= 0')
      end if
   end subroutine check_body

   !> Check a place along a body
   pure subroutine check_place(position, length, error)
      !> Position and length [m]
      real(wp), intent(in) :: position, length
      type(error_t), allocatable, intent(out) :: error

      if (.not. (position >= 0.0_wp .and. position <= length)) call raise(error, error_input, &
         'the impact is beyond the end of the structure: expected 0 <= position <= length', &
         about='position')
   end subroutine check_place

   !> A slender beam of rectangular section, struck across its length
   pure subroutine new_beam(self, material, length, width, thickness, support, position, &
                            damping_ratio, highest, error)
      type(structure_t), intent(out) :: self
      !> Material, neither rigid nor without density
      class(material_t), intent(in) :: material
      !> Length, width and thickness, in the direction of the impact [m], > 0
      real(wp), intent(in) :: length, width, thickness
      !> One of the `support_*` constants
      integer, intent(in) :: support
      !> Position of the impact from the left end, a cantilever's clamped one [m], 0 .. length
      real(wp), intent(in) :: position
      !> Damping ratio of all modes [-], >= 0
      real(wp), intent(in) :: damping_ratio
      !> Frequency up to which modes are kept [rad/s], > 0
      real(wp), intent(in) :: highest
      type(error_t), allocatable, intent(out) :: error

      real(wp), allocatable :: w(:), yield(:)
      real(wp) :: modulus, stiffness, line, unit, x
      integer :: n, k

      call check_body(material, [length, width, thickness], damping_ratio, highest, error)
      if (.not. allocated(error)) call check_place(position, length, error)
      if (allocated(error)) return
      modulus = storage_modulus(material, highest)
      stiffness = modulus*width*thickness**3/12.0_wp
      line = material%density()*width*thickness
      x = position/length
      ! w = unit lambda^2
      unit = sqrt(stiffness/line)/length**2
      call count_modes(sqrt(highest/unit)/pi, n, error)
      if (allocated(error)) return
      allocate (w(n), yield(n))
      do k = 1, n
         call mode_of_beam(support, k, x, w(k), yield(k))
      end do
      w = unit*w**2
      yield = yield/(line*length)
      if (support == support_free) then
         w = [0.0_wp, 0.0_wp, w]
         yield = [1.0_wp, 12.0_wp*(x - 0.5_wp)**2, yield*(line*length)]/(line*length)
      end if
      call assemble(self, w, yield, static_beam(support, x)*length**3/stiffness, damping_ratio, &
         material, modulus, highest, 0.5_wp, .false., error)
   end subroutine new_beam

   !> A slender rod, struck at its end along its length
   pure subroutine new_rod(self, material, length, diameter, support, damping_ratio, highest, error)
      type(structure_t), intent(out) :: self
      !> Material, neither rigid nor without density
      class(material_t), intent(in) :: material
      !> Length and diameter [m], > 0
      real(wp), intent(in) :: length, diameter
      !> Support of the far end, `support_free` or `support_clamped`
      integer, intent(in) :: support
      !> Damping ratio of all modes [-], >= 0
      real(wp), intent(in) :: damping_ratio
      !> Frequency up to which modes are kept [rad/s], > 0
      real(wp), intent(in) :: highest
      type(error_t), allocatable, intent(out) :: error

      real(wp), allocatable :: w(:), yield(:)
      real(wp) :: modulus, area, unit, mass, flexibility
      integer :: n, k

      call check_body(material, [length, diameter], damping_ratio, highest, error)
      if (allocated(error)) return
      modulus = storage_modulus(material, highest)
      area = 0.25_wp*pi*diameter**2
      mass = material%density()*area*length
      unit = pi*sqrt(modulus/material%density())/length
      call count_modes(highest/unit, n, error)
      if (allocated(error)) return
      flexibility = length/(modulus*area)
      if (support == support_free) then
         w = unit*[(real(k, wp), k=0, n)]
         yield = [1.0_wp, (2.0_wp, k=1, n)]/mass
         flexibility = flexibility/3.0_wp
      else
         w = unit*[(real(k, wp) - 0.5_wp, k=1, n)]
         yield = [(2.0_wp, k=1, n)]/mass
      end if
      call assemble(self, w, yield, flexibility, damping_ratio, material, modulus, highest, &
         0.0_wp, .true., error)
   end subroutine new_rod

   !> A thin rectangular plate, simply supported at all edges
   pure subroutine new_panel(self, material, length, width, thickness, position, damping_ratio, &
                             highest, error)
      type(structure_t), intent(out) :: self
      !> Material, neither rigid nor without density
      class(material_t), intent(in) :: material
      !> Length, width and thickness [m], > 0
      real(wp), intent(in) :: length, width, thickness
      !> Position of the impact along length and width [m]
      real(wp), intent(in) :: position(2)
      !> Damping ratio of all modes [-], >= 0
      real(wp), intent(in) :: damping_ratio
      !> Frequency up to which modes are kept [rad/s], > 0
      real(wp), intent(in) :: highest
      type(error_t), allocatable, intent(out) :: error

      real(wp), allocatable :: w(:), yield(:)
      real(wp) :: modulus, stiffness, surface, unit, square, along, across, last
      integer :: i, j, n, most

      call check_body(material, [length, width, thickness], damping_ratio, highest, error)
      if (.not. allocated(error)) call check_place(position(1), length, error)
      if (.not. allocated(error)) call check_place(position(2), width, error)
      if (allocated(error)) return
      modulus = storage_modulus(material, highest)
      stiffness = modulus*material%plane_strain_factor()*thickness**3/12.0_wp
      surface = material%density()*thickness
      ! w = unit k^2
      unit = sqrt(stiffness/surface)
      ! a few modes at least
      last = max(highest/unit, 16.0_wp*pi**2*(1.0_wp/length**2 + 1.0_wp/width**2))
      call count_modes(last*length*width/(4.0_wp*pi) + sqrt(last)*(length + width)/pi, most, error)
      if (allocated(error)) return
      allocate (w(most), yield(most))
      n = 0
      do i = 1, int(sqrt(last)*length/pi)
         along = sin(real(i, wp)*pi*position(1)/length)**2
         if (along < at_node) cycle
         do j = 1, int(sqrt(last)*width/pi)
            square = (real(i, wp)*pi/length)**2 + (real(j, wp)*pi/width)**2
            across = sin(real(j, wp)*pi*position(2)/width)**2
            if (square > last) exit
            if (across < at_node) cycle
            n = n + 1
            w(n) = unit*square
            yield(n) = 4.0_wp*along*across/(surface*length*width)
         end do
      end do
      if (n == 0) then
         call raise(error, error_input, on_support, about='position')
         return
      end if
      call assemble(self, w(:n), yield(:n), static_panel(length, width, position)/stiffness, &
         damping_ratio, material, modulus, highest, 0.0_wp, .false., error)
   end subroutine new_panel

   !> Modulus that the frequencies are for: the storage modulus at the highest one
   pure function storage_modulus(material, frequency) result(modulus)
      class(material_t), intent(in) :: material
      !> Frequency [rad/s]
      real(wp), intent(in) :: frequency
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = real(material%complex_modulus(cmplx(0.0_wp, frequency, wp)), wp)
   end function storage_modulus

   !> Round a number of modes up
   pure subroutine count_modes(number, n, error)
      !> The number, > 0
      real(wp), intent(in) :: number
      !> Number of modes
      integer, intent(out) :: n
      !> Error if there are too many
      type(error_t), allocatable, intent(out) :: error

      n = 1
      if (number < real(most_modes, wp)) then
         n = 1 + int(number)
      else
         call raise(error, error_input, 'the structure has too many modes below the frequencies ' &
            //'that the impact excites: its edges are too far away to matter; take an infinite ' &
            //"plate, waves = 'constant' without &target", about='length width')
      end if
   end subroutine count_modes

   !> Put the modes together, less those on whose node the impact is, and those beyond the limit.
   !> Far from the first one the sum of 1/(m_n w_n^2) over the modes beyond a frequency w is the
   !> integral of a density that falls as x^power dx with x = W/w
   pure subroutine assemble(self, w, yield, static, damping_ratio, material, modulus, highest, &
                            power, in_phase, error)
      type(structure_t), intent(out) :: self
      !> Frequencies [rad/s] and yields [1/kg] of the modes, shape (n)
      real(wp), intent(in) :: w(:), yield(:)
      !> Flexibility of all modes but those of rigid motion [m/N]
      real(wp), intent(in) :: static
      !> Damping ratio [-]
      real(wp), intent(in) :: damping_ratio
      class(material_t), intent(in) :: material
      !> Modulus [Pa]
      real(wp), intent(in) :: modulus
      !> The limit W [rad/s]
      real(wp), intent(in) :: highest
      !> Power of x
      real(wp), intent(in) :: power
      !> Whether the modes come in phase again: their waves have one velocity
      logical, intent(in) :: in_phase
      type(error_t), allocatable, intent(out) :: error

      type(rest_t) :: rest
      real(wp) :: moment(2)
      logical :: kept(size(w))

      kept = yield > at_node*maxval(yield)
      if (.not. (static > 0.0_wp .and. any(kept))) then
         call raise(error, error_input, on_support, about='position')
         return
      end if
      rest%flexibility = static - sum(yield/max(w, tiny(1.0_wp))**2, kept .and. w > 0.0_wp)
      if (rest%flexibility > epsilon(1.0_wp)*static) then
         rest%frequency = max(highest, maxval(w))
         moment = (power + 1.0_wp)/(power + [2.0_wp, 3.0_wp])
         rest%delay = sqrt(moment(2))/rest%frequency
         rest%loss = min(2.0_wp*damping_ratio*moment(1)/sqrt(moment(2)), most_loss)
         ! what all yield, and how much of it one does, by those in the upper half of those kept
         rest%yield = rest%flexibility*rest%frequency**2*(power + 1.0_wp)
         if (.not. in_phase) rest%yield = sqrt(rest%yield &
            *sum(yield**2, kept .and. w > 0.5_wp*maxval(w)) &
            /sum(yield, kept .and. w > 0.5_wp*maxval(w)))
      else
         rest%flexibility = 0.0_wp
      end if
      call new_structure(self, pack(w**2, kept), 2.0_wp*damping_ratio*pack(w, kept), &
         pack(yield, kept), error, 0.0_wp, material, modulus, rest)
   end subroutine assemble

   !> Mode of a beam of unit length, mass and stiffness
   pure subroutine mode_of_beam(support, k, x, root, square)
      !> One of the `support_*` constants
      integer, intent(in) :: support
      !> Number of the mode that bends
      integer, intent(in) :: k
      !> Position, 0 .. 1
      real(wp), intent(in) :: x
      !> Root of the frequency, and the square of the shape, with the mean 1 over the length
      real(wp), intent(out) :: root, square

      real(wp) :: side, decay, c, q, shape, change
      integer :: i

      if (support == support_supported) then
         root = real(k, wp)*pi
         square = 2.0_wp*sin(root*x)**2
         return
      end if
      ! cos(lambda) cosh(lambda) = side, by Newton's method
      side = merge(-1.0_wp, 1.0_wp, support == support_cantilever)
      root = (real(k, wp) + merge(-0.5_wp, 0.5_wp, support == support_cantilever))*pi
      do i = 1, most_iterations
         decay = 2.0_wp*exp(-root)/(1.0_wp + exp(-2.0_wp*root))
         change = (cos(root) - side*decay)/(sin(root) - side*decay*tanh(root))
         root = root + change
         if (abs(change) <= epsilon(root)*root) exit
      end do
      ! cosh q -+ cos q - sigma (sinh q -+ sin q) without differences of large numbers, with
      ! 1 - sigma = c exp(-lambda)
      decay = exp(-root)
      q = root*x
      if (support == support_cantilever) then
         c = 2.0_wp*(sin(root) - cos(root) - decay)/(1.0_wp - decay**2 + 2.0_wp*decay*sin(root))
      else
         c = 2.0_wp*(cos(root) - sin(root) - decay)/(1.0_wp - decay**2 - 2.0_wp*decay*sin(root))
      end if
      shape = exp(-q) + 0.5_wp*c*(exp(q - root) - exp(-q - root))
      change = cos(q) - (1.0_wp - c*decay)*sin(q)
      shape = shape + merge(change, -change, support == support_free)
      square = shape**2
   end subroutine mode_of_beam

   !> Flexibility of a beam of unit length and stiffness under a static force, that of a free one
   !> without its rigid motion: the integral of the square of the bending moment, with the force in
   !> balance with the inertia
   pure function static_beam(support, x) result(flexibility)
      !> One of the `support_*` constants
      integer, intent(in) :: support
      !> Position of the force, 0 .. 1
      real(wp), intent(in) :: x
      !> Flexibility
      real(wp) :: flexibility

      real(wp) :: node(4), weight(4)

      select case (support)
      case (support_supported)
         flexibility = (x*(1.0_wp - x))**2/3.0_wp
      case (support_clamped)
         flexibility = (x*(1.0_wp - x))**3/3.0_wp
      case (support_cantilever)
         flexibility = x**3/3.0_wp
      case default
         ! exact for polynomials of degree 7
         call gauss_nodes(node, weight)
         flexibility = x*sum(weight*moment(x*node, x - 0.5_wp)**2) &
            + (1.0_wp - x)*sum(weight*moment((1.0_wp - x)*node, 0.5_wp - x)**2)
      end select

   contains

      !> Moment at a distance from an end, before the force
      elemental function moment(y, offset)
         !> Distance from that end
         real(wp), intent(in) :: y
         !> Distance of the force from the middle, positive if it is beyond it
         real(wp), intent(in) :: offset
         real(wp) :: moment

         moment = y**2*(0.5_wp + offset*(2.0_wp*y - 3.0_wp))
      end function moment
   end function static_beam

   !> Flexibility of a simply supported rectangle of unit stiffness under a static force, by Levy's
   !> series, sum_i (2/a) sin(k_i x)^2 (-g'/(2 k)), with g = sum_j (2/b) sin(l_j y)^2/(k^2 + l_j^2)
   !> = sinh(k y) sinh(k (b - y))/(k sinh(k b)); the rest of the series has 1/(4 k^3) for -g'/(2 k),
   !> and 1/2 for the square on the average
   pure function static_panel(length, width, position) result(flexibility)
      !> Length and width [m]
      real(wp), intent(in) :: length, width
      !> Position along both [m]
      real(wp), intent(in) :: position(2)
      !> Flexibility times stiffness [m2]
      real(wp) :: flexibility

      ! the rest beyond the average falls as the third power of the number of terms, to 1e-13
      integer, parameter :: terms = 20000
      real(wp) :: k, g, slope, far, near(3)
      integer :: i

      flexibility = 0.0_wp
      do i = terms, 1, -1
         k = real(i, wp)*pi/length
         near = exp(-2.0_wp*k*[position(2), width - position(2), width])
         g = (1.0_wp - near(1))*(1.0_wp - near(2))/(2.0_wp*k*(1.0_wp - near(3)))
         slope = g*(-1.0_wp/k + 2.0_wp*(position(2)*near(1)/(1.0_wp - near(1)) &
            + (width - position(2))*near(2)/(1.0_wp - near(2)) - width*near(3)/(1.0_wp - near(3))))
         flexibility = flexibility - 2.0_wp/length*sin(k*position(1))**2*slope/(2.0_wp*k)
      end do
      far = (real(terms, wp) + 0.5_wp)*pi/length
      flexibility = flexibility + 1.0_wp/(8.0_wp*pi*far**2)
   end function static_panel

end module vcor_impact_body
