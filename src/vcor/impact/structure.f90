!> A struck structure: what lies behind the contact as modes of vibration
!>
!> The struck point of a linear structure moves under the contact force F by
!>
!>     U = C_r F + sum_n eta_n,   eta_n'' + d_n eta_n' + w_n^2 e*eta_n = y_n F
!>
!> with the modes' frequencies w_n, dampings d_n = 2 zeta_n w_n and yields y_n = 1/m_n, m_n the
!> modal mass at that point, and the flexibility C_r of the modes left out. w = 0 is motion of a
!> rigid body, with d > 0 against a dashpot. e* is 1 in an elastic structure. One of a viscoelastic
!> material, all of whose flexibility is that of modes, has e = E(t)/E_ref, by correspondence:
!>
!>     e*x = e_0 x + sum_i e_i p_i + e_v x',   p_i' = x' - l_i p_i
!>
!> Once the force has ended, the energy E_n of a mode only falls. The struck point is then at most
!>
!>     reach = min(sum_n sqrt(2 E_n C_n), sqrt(2 sum_n E_n sum_n C_n)),   C_n = y_n/(w_n^2 e_0)
!>
!> away from the place that rigid motion takes it to: a sphere that is further away, and recedes
!> from it, has left for good.
module vcor_impact_structure
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_input, error_numerical, error_t, raise
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: structure_t, new_structure, vibration_t, state_of_modes_t

   !> A structure; immutable once built
   type :: structure_t
      !> Squares w^2 of the frequencies [1/s2], dampings d [1/s] and yields y [1/kg] of the modes,
      !> shape (modes)
      real(wp), allocatable :: square(:), damping(:), yield(:)
      !> Flexibility C_r of the modes left out [m/N], >= 0
      real(wp) :: residual = 0.0_wp
      !> Number of modes, the last ones, each of which stands for many
      integer :: lumped = 0
      !> Material of a viscoelastic structure, otherwise unallocated, and its modulus E_ref that w
      !> is for [Pa]
      class(material_t), allocatable, private :: material
      real(wp), private :: reference = 1.0_wp
   contains
      procedure :: exists
      procedure :: is_viscoelastic
      procedure :: falls
      procedure :: slowness
      procedure :: expand
   end type structure_t

   !> A structure with its material as a sum of exponentials
   type :: vibration_t
      !> Squares of the frequencies [1/s2], dampings, that of a material's dashpot included [1/s],
      !> and yields [1/kg], shape (modes)
      real(wp), allocatable :: square(:), damping(:), yield(:)
      !> Flexibility of the modes left out [m/N]
      real(wp) :: residual = 0.0_wp
      !> Number of modes, the last ones, each of which stands for many
      integer :: lumped = 0
      !> The material: e_0 [-], e_i [-] and l_i [1/s], shape (n); none if it is elastic
      real(wp) :: equilibrium = 1.0_wp
      real(wp), allocatable :: modulus(:), rate(:)
      !> Error of the sum [-]
      real(wp) :: error = 0.0_wp
   contains
      procedure :: rest
      procedure :: energy
      procedure :: power_lost
      procedure :: rigid_position
      procedure :: rigid_velocity
      procedure :: reach
      procedure :: is_left_by
   end type vibration_t

   !> State of a structure
   type :: state_of_modes_t
      !> Deflections eta [m] and their rates [m/s], shape (modes)
      real(wp), allocatable :: eta(:), rate(:)
      !> Lags p of the deflections [m], shape (modes, n)
      real(wp), allocatable :: lag(:, :)
   end type state_of_modes_t

contains

   !> Build a structure
   pure subroutine new_structure(self, square, damping, yield, error, residual, material, reference)
      type(structure_t), intent(out) :: self
      !> Squares of the modes' frequencies [1/s2], >= 0, shape (modes)
      real(wp), intent(in) :: square(:)
      !> Their dampings 2 zeta w [1/s], >= 0, same shape
      real(wp), intent(in) :: damping(:)
      !> Inverse of their masses at the struck point [1/kg], > 0, same shape
      real(wp), intent(in) :: yield(:)
      type(error_t), allocatable, intent(out) :: error
      !> Flexibility of modes left out [m/N], >= 0; absent: 0
      real(wp), intent(in), optional :: residual
      !> Material of a viscoelastic structure, whose modulus all frequencies follow; absent, rigid
      !> or elastic: none
      class(material_t), intent(in), optional :: material
      !> Modulus that the frequencies are for [Pa], > 0; with `material`
      real(wp), intent(in), optional :: reference

      if (present(residual)) self%residual = residual
      if (.not. ieee_is_finite(self%residual)) self%residual = -1.0_wp
      if (size(square) == 0 .and. .not. self%residual > 0.0_wp) then
         call raise(error, error_input, 'a structure without modes and flexibility does not move')
      else if (size(damping) /= size(square) .or. size(yield) /= size(square)) then
         call raise(error, error_input, 'the modes of a structure need as many dampings and ' &
            //'masses as frequencies')
      else if (self%residual < 0.0_wp .or. .not. all(ieee_is_finite([square, damping, yield]))) then
         call raise(error, error_input, 'frequencies, dampings, masses and flexibility of a ' &
            //'structure must be numbers, none of them negative')
      else if (any(square < 0.0_wp) .or. any(damping < 0.0_wp) .or. any(yield <= 0.0_wp)) then
         call raise(error, error_input, 'frequencies and dampings of the modes must not be ' &
            //'negative, their masses positive')
      end if
      if (.not. allocated(error) .and. present(material) .and. self%residual > 0.0_wp) then
         if (.not. (material%rigid .or. material%elastic())) call raise(error, error_input, &
            'the flexibility of a viscoelastic structure must be that of modes')
      end if
      if (allocated(error)) return
      self%square = square
      self%damping = damping
      self%yield = yield
      if (.not. present(material)) return
      if (material%rigid .or. material%elastic()) return
      allocate (self%material, source=material)
      self%reference = reference
   end subroutine new_structure

   !> Whether there is a structure
   elemental function exists(self)
      class(structure_t), intent(in) :: self
      logical :: exists

      exists = allocated(self%square)
   end function exists

   !> Whether its material relaxes
   elemental function is_viscoelastic(self)
      class(structure_t), intent(in) :: self
      logical :: is_viscoelastic

      is_viscoelastic = allocated(self%material)
   end function is_viscoelastic

   !> Whether it would fall under its weight: a mode has no stiffness
   elemental function falls(self)
      class(structure_t), intent(in) :: self
      logical :: falls

      falls = .false.
      if (allocated(self%square)) falls = any(.not. self%square > 0.0_wp)
   end function falls

   !> Time in which the structure moves with a mass on it: the root of mass times flexibility
   pure function slowness(self, mass) result(time)
      class(structure_t), intent(in) :: self
      !> Mass [kg]
      real(wp), intent(in) :: mass
      !> Time [s]
      real(wp) :: time

      time = 0.0_wp
      if (.not. allocated(self%square)) return
      time = sqrt(mass*(self%residual + sum(self%yield/max(self%square, tiny(1.0_wp)), &
         self%square > 0.0_wp)))
   end function slowness

   !> Expand the material in a sum of exponentials
   pure subroutine expand(self, window, accuracy, vibration, error)
      class(structure_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      type(vibration_t), intent(out) :: vibration
      type(error_t), allocatable, intent(out) :: error

      type(exponential_sum_t) :: terms

      vibration%square = self%square
      vibration%damping = self%damping
      vibration%yield = self%yield
      vibration%residual = self%residual
      vibration%lumped = self%lumped
      allocate (vibration%modulus(0), vibration%rate(0))
      if (.not. allocated(self%material)) return
      call self%material%exponentials(window, accuracy, terms)
      if (.not. terms%error < 1.0_wp) then
         call raise(error, error_numerical, 'no sum of exponentials represents the material of ' &
            //'this structure')
         return
      end if
      call terms%scale(1.0_wp/self%reference)
      vibration%equilibrium = terms%equilibrium
      vibration%modulus = terms%moduli
      vibration%rate = terms%rates
      vibration%error = terms%error
      vibration%damping = vibration%damping + vibration%square*terms%viscosity
   end subroutine expand

   !> State of rest
   pure function rest(self) result(state)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t) :: state

      allocate (state%eta(size(self%square)), source=0.0_wp)
      allocate (state%rate(size(self%square)), source=0.0_wp)
      allocate (state%lag(size(self%square), size(self%rate)), source=0.0_wp)
   end function rest

   !> Kinetic and elastic energy of each mode, that of the springs of its material included
   pure function energy(self, state) result(of_mode)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Energy [J], shape (modes)
      real(wp) :: of_mode(size(self%square))

      integer :: i

      of_mode = self%equilibrium*state%eta**2
      do i = 1, size(self%rate)
         of_mode = of_mode + self%modulus(i)*state%lag(:, i)**2
      end do
      of_mode = 0.5_wp/self%yield*(state%rate**2 + self%square*of_mode)
   end function energy

   !> Power that the dampings of the modes take
   pure function power_lost(self, state) result(power)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Power [W]
      real(wp) :: power

      power = sum(self%damping/self%yield*state%rate**2)
   end function power_lost

   !> Where the struck point would be if the modes with stiffness were at rest, and those against a
   !> dashpot had come to rest
   pure function rigid_position(self, state) result(position)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Position [m]
      real(wp) :: position

      integer :: n

      position = 0.0_wp
      do n = 1, size(self%square)
         if (self%square(n) > 0.0_wp) cycle
         position = position + state%eta(n)
         if (self%damping(n) > 0.0_wp) position = position + state%rate(n)/self%damping(n)
      end do
   end function rigid_position

   !> Velocity of the struck point in the modes without stiffness
   pure function rigid_velocity(self, state) result(velocity)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Velocity [m/s]
      real(wp) :: velocity

      velocity = sum(state%rate, .not. self%square > 0.0_wp)
   end function rigid_velocity

   !> How far the struck point can come from its rigid position once the force has ended
   pure function reach(self, state) result(distance)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Distance [m]; infinite, a huge number, for a fluid
      real(wp) :: distance

      real(wp) :: energy(size(self%square)), one, together, flexibility, spring
      integer :: n

      energy = self%energy(state)
      distance = 0.0_wp
      one = 0.0_wp
      together = 0.0_wp
      flexibility = 0.0_wp
      do n = 1, size(self%square)
         spring = self%square(n)*self%equilibrium
         if (self%square(n) > 0.0_wp .and. .not. spring > 0.0_wp) then
            distance = huge(1.0_wp)
            return
         else if (spring > 0.0_wp) then
            one = one + sqrt(2.0_wp*energy(n)*self%yield(n)/spring)
            together = together + energy(n)
            flexibility = flexibility + self%yield(n)/spring
         else if (self%damping(n) > 0.0_wp) then
            distance = distance + abs(state%rate(n))/self%damping(n)
         end if
      end do
      distance = distance + min(one, sqrt(2.0_wp*together*flexibility))
   end function reach

   !> Whether a sphere without contact never touches the structure again, weight apart
   pure function is_left_by(self, state, place, velocity, reach) result(is_left)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Displacement of the sphere [m], that of an infinite plate subtracted, and velocity [m/s]
      real(wp), intent(in) :: place, velocity
      !> Reach of the structure [m]
      real(wp), intent(in) :: reach
      logical :: is_left

      is_left = velocity < sum(state%rate, .not. (self%square > 0.0_wp .or. self%damping > 0.0_wp))
      if (is_left) is_left = self%rigid_position(state) - place >= reach
   end function is_left_by

end module vcor_impact_structure
