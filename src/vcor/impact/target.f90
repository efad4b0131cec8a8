!> What lies behind the contact: the deflection U of the struck point under the contact force
!>
!> A thin infinite plate has U = alpha I with Zener's alpha(t) = sqrt(3 rho/E'_b(t))/(16 rho h^2),
!> Eq. (3); a hereditary one has a memory (`vcor_impact_memory`). A structure with edges, supports
!> or a finite mass has modes (`vcor_impact_structure`). Waves in a plate of any thickness belong to
!> the face, `vcor_impact_face`.
module vcor_impact_target
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_memory, only : memory_t, new_memory
   use vcor_impact_structure, only : structure_t
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_type, only : material_t
   use vcor_number, only : least_magnitude, most_magnitude
   implicit none
   private

   public :: target_t, new_plate, new_target
   public :: waves_none, waves_constant, waves_relaxing, waves_frozen, waves_hereditary

   !> Plate models: no motion, U = 0
   integer, parameter :: waves_none = 0
   !> U = alpha(0) I, Zener 1941
   integer, parameter :: waves_constant = 1
   !> U = alpha(t) I, Eqs. (2) and (3)
   integer, parameter :: waves_relaxing = 2
   !> U' = int alpha F' dt, Eq. (2) without alpha' and alpha'', as in the paper's Fig. 7
   integer, parameter :: waves_frozen = 3
   !> s U = A F/sqrt(Q_b) in the Laplace domain: exact for a thin viscoelastic plate
   integer, parameter :: waves_hereditary = 4

   !> Deflection U of the struck point, of a plate that of its mid-plane, under the contact force
   type :: target_t
      !> Modes of a structure in place of an infinite plate
      type(structure_t) :: structure
      !> One of the `waves_*` constants
      integer, private :: waves = waves_none
      !> sqrt(3 rho (1 - nu^2))/(16 rho h^2), so that alpha = coefficient/sqrt(E_b) [Pa^0.5 m/(N s)]
      real(wp), private :: coefficient = 0.0_wp
      !> alpha(0) [m/(N s)]
      real(wp), private :: initial = 0.0_wp
      !> Material of a plate with variable alpha, otherwise unallocated
      class(material_t), allocatable, private :: material
      !> Memory of a hereditary plate, otherwise unallocated
      type(memory_t), allocatable, private :: memory
   contains
      procedure :: moves
      procedure :: alpha
      procedure :: alpha_at
      procedure :: alpha_after
      procedure :: alpha_rate
      procedure :: frozen
      procedure :: varies
      procedure :: hereditary
      procedure :: drifts
      procedure :: has_memory
      procedure :: yields
      procedure :: response
      procedure :: memory_integral
   end type target_t

contains

   !> Whether the plate moves: it has waves and is not rigid
   pure function moves(self)
      class(target_t), intent(in) :: self
      logical :: moves

      moves = self%coefficient > 0.0_wp
   end function moves

   !> Whether the struck point moves: that of a plate with waves, or of a structure
   pure function yields(self)
      class(target_t), intent(in) :: self
      logical :: yields

      yields = self%moves() .or. self%structure%exists()
   end function yields

   !> Build the target of a structure
   pure subroutine new_target(self, structure)
      type(target_t), intent(out) :: self
      type(structure_t), intent(in) :: structure

      self%structure = structure
   end subroutine new_target

   !> Build a plate
   pure subroutine new_plate(self, material, half_thickness, waves, error)
      type(target_t), intent(out) :: self
      !> Its material; a rigid plate does not move
      class(material_t), intent(in) :: material
      !> Half thickness h [m], > 0 if the plate moves
      real(wp), intent(in) :: half_thickness
      !> One of the `waves_*` constants
      integer, intent(in) :: waves
      type(error_t), allocatable, intent(out) :: error

      if (all(waves /= [waves_none, waves_constant, waves_relaxing, waves_frozen, &
          waves_hereditary])) call raise(error, error_input, 'unknown kind of waves, ' &
         //'expected one of the constants waves_*', about='waves')
      if (.not. material%is_built()) call raise(error, error_input, &
         'the material of the plate is empty: no procedure new_... has built it')
      if (allocated(error) .or. waves == waves_none .or. material%rigid) return
      if (.not. half_thickness > 0.0_wp) then
         call raise(error, error_input, 'a plate with waves needs half_thickness > 0 [m]; use ' &
            //"waves = 'none' for a half space", about='half_thickness')
      else if (.not. material%density() > 0.0_wp) then
         call raise(error, error_input, 'a plate with waves needs the density of its ' &
            //"material; use waves = 'none' for a half space", about='density')
      else if (max(half_thickness, material%density()) > most_magnitude &
               .or. min(half_thickness, material%density()) < least_magnitude) then
         call raise(error, error_input, 'half_thickness or density of the plate is out of the ' &
            //'range that can be computed', about='half_thickness density')
      else if (.not. material%glassy() > 0.0_wp .and. waves < waves_hereditary) then
         call raise(error, error_input, 'a plate with waves needs a material that is more than ' &
            //'a dashpot: its modulus is 0 and its deflection infinite', &
            about='waves equilibrium_modulus')
      else if (waves == waves_constant .and. material%glassy() > huge(1.0_wp)) then
         call raise(error, error_input, 'the plate keeps its modulus at t = 0, which for ' &
            //'this material is infinite, so it would not move; use ' &
            //"waves = 'relaxing', 'hereditary' or 'body', or 'none' for a half space", &
            about='waves')
      end if
      if (allocated(error)) return

      self%coefficient = sqrt(3.0_wp*material%density()/material%plane_strain_factor()) &
         /(16.0_wp*material%density()*half_thickness**2)
      if (material%glassy() > 0.0_wp) self%initial = self%coefficient/sqrt(material%glassy())
      self%waves = waves
      if (waves == waves_hereditary) then
         if (material%elastic()) return
         allocate (self%memory)
         call new_memory(self%memory, material, self%coefficient)
         self%initial = self%memory%viscosity
         return
      end if
      ! alpha of an elastic plate is constant
      if (waves /= waves_constant .and. material%glassy() > material%rubbery()) &
         allocate (self%material, source=material)
   end subroutine new_plate

   !> Zener's plate parameter alpha(t), Eq. (3)
   elemental function alpha(self, t) result(value)
      class(target_t), intent(in) :: self
      !> Time since first contact [s], t >= 0
      real(wp), intent(in) :: t
      !> Deflection per impulse [m/(N s)]
      real(wp) :: value

      ! where the modulus has decayed to zero the plate yields at once, but alpha stays finite
      if (allocated(self%material)) then
         value = self%coefficient/sqrt(max(self%material%relaxation(t), least_magnitude))
      else
         value = self%initial
      end if
   end function alpha

   !> Plate parameter alpha at many times
   pure subroutine alpha_at(self, t, value)
      class(target_t), intent(in) :: self
      !> Times since first contact [s], t >= 0
      real(wp), intent(in) :: t(:)
      !> Deflection per impulse [m/(N s)], same shape
      real(wp), intent(out) :: value(:)

      integer :: j

      if (allocated(self%material)) then
         call self%material%relaxation_at(t, value)
         do j = 1, size(t)
            value(j) = self%coefficient/sqrt(max(value(j), least_magnitude))
         end do
      else
         value = self%initial
      end if
   end subroutine alpha_at

   !> Plate parameter after a time: alpha, for a plate with memory the velocity under a constant
   !> force, over that force
   elemental function alpha_after(self, t) result(value)
      class(target_t), intent(in) :: self
      !> Time since first contact [s], t > 0
      real(wp), intent(in) :: t
      !> Deflection per impulse [m/(N s)]
      real(wp) :: value

      value = self%alpha(t)
      if (allocated(self%memory)) value = value + self%memory_integral(t)
   end function alpha_after

   !> Whether U' = int alpha F' dt instead of (alpha I)'
   elemental function frozen(self)
      class(target_t), intent(in) :: self
      !> False for a constant alpha, for which both are the same
      logical :: frozen

      frozen = self%waves == waves_frozen .and. allocated(self%material)
   end function frozen

   !> Whether alpha changes with the time since first contact
   elemental function varies(self)
      class(target_t), intent(in) :: self
      logical :: varies

      varies = allocated(self%material)
   end function varies

   !> Whether the plate has a memory: U' = alpha F + int psi(t - x) F(x) dx
   elemental function hereditary(self)
      class(target_t), intent(in) :: self
      !> False for an elastic thin plate
      logical :: hereditary

      hereditary = allocated(self%memory)
   end function hereditary

   !> Whether U' depends on forces in the past: the target has a memory or modes
   elemental function has_memory(self)
      class(target_t), intent(in) :: self
      logical :: has_memory

      has_memory = allocated(self%memory) .or. self%structure%exists()
   end function has_memory

   !> Whether U' - alpha F is a variable of its own and not alpha' I
   elemental function drifts(self)
      class(target_t), intent(in) :: self
      logical :: drifts

      drifts = self%frozen() .or. self%hereditary()
   end function drifts

   !> Response of a plate with memory as a sum of exponentials, U' = viscosity F + int psi(t - x)
   !> F(x) dx with psi = sum_k w_k exp(-l_k t)
   pure subroutine response(self, window, accuracy, terms)
      !> The plate, with memory
      class(target_t), intent(in) :: self
      !> Time up to which the sum is to hold [s], > 0
      real(wp), intent(in) :: window
      !> Wanted relative accuracy, > 0
      real(wp), intent(in) :: accuracy
      !> psi [m/(N s2)], with alpha [m/(N s)] as its viscosity; `terms%error` is that of the
      !> velocity under a constant force, relative
      type(exponential_sum_t), intent(out) :: terms

      call self%memory%exponentials(window, accuracy, terms)
   end subroutine response

   !> Integral from 0 to t of the memory psi of a hereditary plate
   elemental function memory_integral(self, t) result(value)
      !> The plate, a hereditary one
      class(target_t), intent(in) :: self
      !> Upper limit [s], >= 0
      real(wp), intent(in) :: t
      !> Integral [m/(N s)]
      real(wp) :: value

      value = self%memory%integral(t)
   end function memory_integral

   !> Rate of the plate parameter: alpha' = -alpha E_b'/(2 E_b), with 1/E_b = (alpha/coefficient)^2
   elemental function alpha_rate(self, t, alpha) result(value)
      class(target_t), intent(in) :: self
      !> Time since first contact [s], t > 0
      real(wp), intent(in) :: t
      !> Plate parameter at that time if known [m/(N s)]
      real(wp), intent(in), optional :: alpha
      !> Rate [m/(N s^2)], >= 0
      real(wp) :: value

      real(wp) :: known

      value = 0.0_wp
      if (.not. allocated(self%material)) return
      if (present(alpha)) then
         known = alpha
      else
         known = self%alpha(t)
      end if
      value = -0.5_wp*known*(self%material%rate(t)*(known/self%coefficient)**2)
   end function alpha_rate

end module vcor_impact_target
