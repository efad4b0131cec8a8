!> A struck structure: what lies behind the contact as modes of vibration
!>
!> The struck point of a linear structure moves under the contact force F by
!>
!>     U = C_r F + R + sum_n eta_n,   eta_n'' + d_n eta_n' + w_n^2 e*eta_n = y_n F
!>
!> with the modes' frequencies w_n, dampings d_n = 2 zeta_n w_n and yields y_n = 1/m_n, m_n the
!> modal mass at that point, the flexibility C_r of the modes left out, and the rest R: the modes
!> beyond a limit, together (`rest_t`). w = 0 is motion of a rigid body, with d > 0 against a
!> dashpot. e* is 1 in an elastic structure. One of a viscoelastic
!> material, all of whose flexibility is that of modes, has e = E(t)/E_ref, by correspondence; with
!> its material as a sum of exponentials each mode is an oscillator and exponentials
!> (`vcor_impact_creep`):
!>
!>     U = C_r F + sum_n eta_n + sum_k z_k,   eta' = v + jump F,   v' = -b eta - a v + q F,
!>                                            z_k' = r_k F - x_k z_k
!>
!> Once the force has ended, v^2 + b eta^2 of each mode only falls. The struck point then comes at
!> most
!>
!>     reach = sum_n sqrt(eta_n^2 + v_n^2/b_n) + sum_k max(0, -z_k)
!>
!> towards the sphere from the place that rigid motion takes it to: a sphere that is further away,
!> and recedes from it, has left for good.
module vcor_impact_structure
   use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
   use vcor_error, only : error_input, error_numerical, error_t, raise
   use vcor_impact_creep, only : rest_damping, split_modes, split_rest
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: structure_t, new_structure, rest_t, vibration_t, state_of_modes_t

   !> The modes beyond a limit W together. Where the sum of 1/(m_n w_n^2) is the integral of a
   !> density x^power dx in x = W/w they have, to second order in p/W, the receptance
   !>
   !>     C (1 - 2 zeta m_1 p/W - m_2 p^2/W^2),   m_i = (power + 1)/(power + 1 + i)
   !>
   !> and so have two damped oscillators: with u = delay p, delay = sqrt(m_2)/W, Butterworth's D of
   !> fourth order and loss = 2 zeta m_1/sqrt(m_2)
   !>
   !>     C N(u)/D(u),   N = 1 + (d_1 - loss) u + (d_2 - 1 - d_1 loss) u^2
   !>
   !> They do not ring, as the sum of the modes does not, in which each has its own phase; without
   !> damping they are off by u^4
   type :: rest_t
      !> C [m/N]; 0: there is no rest
      real(wp) :: flexibility = 0.0_wp
      !> delay [s] and loss [-]
      real(wp) :: delay = 0.0_wp, loss = 0.0_wp
      !> W [rad/s], and the yield, at W, of one mode which rings as they do: the root of the sum
      !> of their squares, or the sum for those that come in phase again [1/kg]
      real(wp) :: frequency = 0.0_wp, yield = 0.0_wp
   end type rest_t

   !> A structure; immutable once built
   type :: structure_t
      !> Squares w^2 of the frequencies [1/s2], dampings d [1/s] and yields y [1/kg] of the modes,
      !> shape (modes)
      real(wp), allocatable :: square(:), damping(:), yield(:)
      !> Flexibility C_r of the modes left out [m/N], >= 0
      real(wp) :: residual = 0.0_wp
      !> Modes beyond those
      type(rest_t) :: rest
      !> Material of a viscoelastic structure, otherwise unallocated, and its modulus E_ref that w
      !> is for [Pa]
      class(material_t), allocatable, private :: material
      real(wp), private :: reference = 1.0_wp
   contains
      procedure :: exists
      procedure :: is_viscoelastic
      procedure :: falls
      procedure :: slowness
      procedure :: receptance
      procedure :: expand
   end type structure_t

   !> A structure with its material as a sum of exponentials
   type :: vibration_t
      !> Squares b of the frequencies [1/s2], dampings a [1/s], yields q [1/kg] and jumps of the
      !> oscillators [s/kg], shape (modes)
      real(wp), allocatable :: square(:), damping(:), yield(:), jump(:)
      !> Rates x [1/s] and weights r [s/kg] of the exponentials, shape (n); none if the material
      !> does not relax
      real(wp), allocatable :: rate(:), weight(:)
      !> Flexibility of the modes left out [m/N]
      real(wp) :: residual = 0.0_wp
      !> Modes for which the last two oscillators stand, if there are any
      type(rest_t) :: rest
      !> Whether the material relaxes: the state of the modes does not have all energy then
      logical :: relaxes = .false.
      !> Error of the sum [-]
      real(wp) :: error = 0.0_wp
   contains
      procedure :: make_none
      procedure :: at_rest
      procedure :: modes
      procedure :: after
      procedure :: energy
      procedure :: power_lost
      procedure :: rigid_position
      procedure :: rigid_velocity
      procedure :: reach
      procedure :: is_left_by
   end type vibration_t

   !> State of a structure
   type :: state_of_modes_t
      !> Deflections eta of the oscillators [m], and v [m/s], shape (modes)
      real(wp), allocatable :: eta(:), rate(:)
      !> Deflections z of the exponentials [m], shape (n)
      real(wp), allocatable :: lag(:)
   end type state_of_modes_t

contains

   !> Build a structure
   pure subroutine new_structure(self, square, damping, yield, error, residual, material, &
                                 reference, rest)
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
      !> Modes beyond those; absent: none
      type(rest_t), intent(in), optional :: rest

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
      if (present(rest)) self%rest = rest
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

   !> Time in which the structure moves with a mass on it: the root of mass times flexibility, once
   !> it has relaxed if something is left of its stiffness
   pure function slowness(self, mass) result(time)
      class(structure_t), intent(in) :: self
      !> Mass [kg]
      real(wp), intent(in) :: mass
      !> Time [s]
      real(wp) :: time

      real(wp) :: softer

      time = 0.0_wp
      if (.not. allocated(self%square)) return
      softer = 1.0_wp
      if (allocated(self%material)) then
         if (self%material%rubbery() > 0.0_wp) softer = self%reference/self%material%rubbery()
      end if
      time = sqrt(mass*(self%residual + softer*(self%rest%flexibility &
         + sum(self%yield/max(self%square, tiny(1.0_wp)), self%square > 0.0_wp))))
   end function slowness

   !> Displacement divided by force in the Laplace domain
   elemental function receptance(self, s) result(compliance)
      class(structure_t), intent(in) :: self
      !> Laplace variable [1/s]
      complex(wp), intent(in) :: s
      !> Compliance [m/N]; 0 without a structure
      complex(wp) :: compliance

      complex(wp) :: modulus, u

      compliance = 0.0_wp
      if (.not. allocated(self%square)) return
      modulus = 1.0_wp
      if (allocated(self%material)) modulus = self%material%complex_modulus(s)/self%reference
      compliance = self%residual + sum(self%yield/(s*(s + self%damping) + modulus*self%square))
      associate (rest => self%rest)
         if (.not. rest%flexibility > 0.0_wp) return
         u = rest%delay*s
         compliance = compliance + rest%flexibility/modulus &
            *(1.0_wp + u*((rest_damping(1) - rest%loss) + u*(rest_damping(2) - 1.0_wp &
            - rest_damping(1)*rest%loss)))/(1.0_wp + u*(rest_damping(1) &
            + u*(rest_damping(2) + u*(rest_damping(1) + u))))
      end associate
   end function receptance

   !> Expand the material in a sum of exponentials. A rule with the error e resolves rates up to
   !> e^(-1/3) over the window, and lumps those beyond: in a longer window the error must fall with
   !> the third power of what is brief in it
   pure subroutine expand(self, window, brief, accuracy, vibration, error)
      class(structure_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Time of the changes that it is to resolve [s], > 0, not above the window
      real(wp), intent(in) :: brief
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      type(vibration_t), intent(out) :: vibration
      type(error_t), allocatable, intent(out) :: error

      type(exponential_sum_t) :: terms
      real(wp), allocatable :: rate(:), weight(:)
      integer :: n, all

      vibration%residual = self%residual
      vibration%rest = self%rest
      n = size(self%square)
      all = n + merge(2, 0, self%rest%flexibility > 0.0_wp)
      allocate (vibration%square(all), vibration%damping(all), vibration%yield(all), &
         vibration%jump(all))
      if (.not. allocated(self%material)) then
         vibration%square(:n) = self%square
         vibration%damping(:n) = self%damping
         vibration%yield(:n) = self%yield
         vibration%jump(:n) = 0.0_wp
         allocate (vibration%rate(0), vibration%weight(0))
         terms%equilibrium = 1.0_wp
         allocate (terms%rates(0), terms%moduli(0))
      else
         call self%material%exponentials(window, max(accuracy*(brief/window)**3, &
            epsilon(1.0_wp)), terms)
         if (terms%error > 0.0_wp) terms%error = max(terms%error, abs(terms%integral(brief) &
            /(self%material%integral(brief) + self%material%viscosity) - 1.0_wp))
         if (.not. terms%error < 1.0_wp) then
            call raise(error, error_numerical, 'no sum of exponentials represents the material ' &
               //'of this structure')
            return
         end if
         call terms%scale(1.0_wp/self%reference)
         vibration%error = terms%error
         call split_modes(terms, self%square, self%damping + self%square*terms%viscosity, &
            self%yield, vibration%damping(:n), vibration%square(:n), vibration%yield(:n), &
            vibration%jump(:n), vibration%rate, vibration%weight)
         vibration%relaxes = size(vibration%rate) > 0
      end if
      if (all == n) return
      call split_rest(terms, self%rest%flexibility, self%rest%delay, [1.0_wp, &
         rest_damping(1) - self%rest%loss, rest_damping(2) - 1.0_wp &
         - rest_damping(1)*self%rest%loss], vibration%damping(n + 1:), vibration%square(n + 1:), &
         vibration%yield(n + 1:), vibration%jump(n + 1:), rate, weight)
      vibration%rate = [vibration%rate, rate]
      vibration%weight = [vibration%weight, weight]
   end subroutine expand

   !> Make it no structure: nothing moves
   subroutine make_none(self)
      class(vibration_t), intent(out) :: self

      allocate (self%square(0), self%damping(0), self%yield(0), self%jump(0), self%rate(0), &
         self%weight(0))
   end subroutine make_none

   !> Number of oscillators each of which is one mode
   pure function modes(self)
      class(vibration_t), intent(in) :: self
      integer :: modes

      modes = size(self%square)
      if (self%rest%flexibility > 0.0_wp) modes = modes - 2
   end function modes

   !> State of rest
   pure function at_rest(self) result(state)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t) :: state

      allocate (state%eta(size(self%square)), source=0.0_wp)
      allocate (state%rate(size(self%square)), source=0.0_wp)
      allocate (state%lag(size(self%rate)), source=0.0_wp)
   end function at_rest

   !> State after a time without force
   pure function after(self, state, time) result(later)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Time [s], >= 0
      real(wp), intent(in) :: time
      type(state_of_modes_t) :: later

      real(wp) :: even, odd, root, half, fall
      integer :: n

      later = state
      do n = 1, size(self%square)
         ! exp(-a t/2) times cos(w t) and sin(w t)/w, w^2 = b - a^2/4, or cosh and sinh
         associate (b => self%square(n), a => self%damping(n), eta => state%eta(n), &
                    v => state%rate(n))
            root = sqrt(abs(b - 0.25_wp*a**2))
            if (b > 0.25_wp*a**2) then
               even = exp(-0.5_wp*a*time)*cos(root*time)
               odd = exp(-0.5_wp*a*time)*sin(root*time)/root
            else
               ! the slower of the two rates a/2 -+ w keeps its digits by their product b
               fall = 0.0_wp
               if (a > 0.0_wp) fall = exp(-b/(0.5_wp*a + root)*time)
               if (.not. a > 0.0_wp) fall = 1.0_wp
               half = tanh(root*time)
               even = fall/(1.0_wp + half)
               odd = fall*time
               if (root*time > 0.0_wp) odd = fall*half/(1.0_wp + half)/root
            end if
            later%eta(n) = even*eta + odd*(v + 0.5_wp*a*eta)
            later%rate(n) = even*v - odd*(b*eta + 0.5_wp*a*v)
         end associate
      end do
      later%lag = exp(-self%rate*time)*state%lag
   end function after

   !> Kinetic and elastic energy of a structure that does not relax, in all modes but the rest
   pure function energy(self, state)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Energy [J]
      real(wp) :: energy

      associate (n => self%modes())
         energy = sum(0.5_wp/self%yield(:n)*(state%rate(:n)**2 &
            + self%square(:n)*state%eta(:n)**2))
      end associate
   end function energy

   !> Power that the dampings of a structure take that does not relax
   pure function power_lost(self, state) result(power)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Power [W]
      real(wp) :: power

      associate (n => self%modes())
         power = sum(self%damping(:n)/self%yield(:n)*state%rate(:n)**2)
      end associate
   end function power_lost

   !> Where the struck point would be if the modes with stiffness were at rest, and those against a
   !> dashpot had come to rest. A fluid keeps its deflection
   pure function rigid_position(self, state) result(position)
      class(vibration_t), intent(in) :: self
      type(state_of_modes_t), intent(in) :: state
      !> Position [m]
      real(wp) :: position

      integer :: n

      position = sum(state%lag, .not. self%rate > 0.0_wp)
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
      !> Distance [m]
      real(wp) :: distance

      integer :: n

      distance = sum(max(0.0_wp, -state%lag), self%rate > 0.0_wp)
      do n = 1, size(self%square)
         if (self%square(n) > 0.0_wp) then
            distance = distance + sqrt(state%eta(n)**2 + state%rate(n)**2/self%square(n))
         else if (self%damping(n) > 0.0_wp) then
            distance = distance + abs(state%rate(n))/self%damping(n)
         end if
      end do
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
