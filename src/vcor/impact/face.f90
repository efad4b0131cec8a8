!> The face that is struck: what the pressure p(r) between two bodies moves, by exact linear theory
!>
!> With the Abel transform q(x) of the pressure, a row of springs, the approach of the bodies over
!> the row is C q, in the Laplace domain of s
!>
!>     C(u, s) = [1/Q'_b + 1/Q'_a] delta(u) + (1/(pi Q'_b)) int_0^oo (L(k, p) - 1) cos(ku) dk + c(s)
!>
!> with the plane-strain moduli Q' of plate b and striker a, the response L of the plate's face
!> (`vcor_impact_response`) and c(s) of what moves as a whole.
module vcor_impact_face
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_response, only : base_bonded, base_free, base_half_space, base_sliding, &
      static_response, wave_responses
   use vcor_impact_structure, only : structure_t
   use vcor_kinds, only : wp
   use vcor_material_type, only : material_t
   implicit none
   private

   public :: face_t, new_face
   public :: base_half_space, base_free, base_bonded, base_sliding, base_thin

   !> A free plate by the theory of thin plates, c(s) = A/(s sqrt(Q'_b)): the limit of `base_free`
   integer, parameter :: base_thin = 4

   !> The face and the striker; immutable once built
   type :: face_t
      !> One of the `base_*` constants
      integer :: base = base_half_space
      !> Whether the inertia of the plate counts
      logical :: has_waves = .false.
      !> Thickness H = 2 h [m], > 0 unless it is a half space
      real(wp) :: thickness = 0.0_wp
      !> The structure that carries the face, if there is one
      type(structure_t) :: structure
      !> Material of the plate; unallocated: rigid
      class(material_t), allocatable, private :: plate
      !> Material of the striker, as a half space; unallocated: rigid
      class(material_t), allocatable, private :: striker
   contains
      procedure :: is_built
      procedure :: has_response
      procedure :: local_compliance
      procedure :: is_viscous
      procedure :: plate_modulus
      procedure :: drift
      procedure :: per_shear_speed
      procedure :: poisson_ratio
      procedure :: response
      procedure :: half_space_response
   end type face_t

contains

   !> Build the face
   subroutine new_face(self, plate, striker, base, thickness, has_waves, error)
      type(face_t), intent(out) :: self
      !> Material of the plate; a rigid one has no response
      class(material_t), intent(in) :: plate
      !> Material of the striker, not rigid if the plate is
      class(material_t), intent(in) :: striker
      !> One of the `base_*` constants
      integer, intent(in) :: base
      !> Thickness H = 2 h [m]; > 0 unless the base is `base_half_space`
      real(wp), intent(in) :: thickness
      !> Whether the inertia of the plate counts, which then needs a density
      logical, intent(in) :: has_waves
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (.not. (plate%is_built() .and. striker%is_built())) then
         call raise(error, error_input, 'a material is empty: no procedure new_... has built it')
      else if (plate%rigid .and. striker%rigid) then
         call raise(error, error_input, &
            'sphere and plate are both rigid, expected one that deforms', about='material')
      else if (all(base /= [base_half_space, base_free, base_bonded, base_sliding, base_thin])) then
         call raise(error, error_input, 'unknown base of a layer', about='base')
      else if (base /= base_half_space .and. .not. thickness > 0.0_wp) then
         call raise(error, error_input, 'a layer needs a thickness > 0 [m]', &
            about='thickness half_thickness')
      else if ((has_waves .or. base == base_free .or. base == base_thin) .and. .not. plate%rigid &
               .and. .not. plate%density() > 0.0_wp) then
         call raise(error, error_input, 'a plate with waves needs the density of its material', &
            about='density')
      end if
      if (allocated(error)) return
      self%base = base
      if (base /= base_half_space) self%thickness = thickness
      self%has_waves = has_waves
      if (.not. plate%rigid) allocate (self%plate, source=plate)
      if (.not. striker%rigid) allocate (self%striker, source=striker)
   end subroutine new_face

   !> Whether the face has been built
   elemental function is_built(self)
      class(face_t), intent(in) :: self
      logical :: is_built

      is_built = allocated(self%plate) .or. allocated(self%striker)
   end function is_built

   !> Whether the face has more than local springs: L is not 1, or something moves as a whole
   elemental function has_response(self)
      class(face_t), intent(in) :: self
      logical :: has_response

      has_response = allocated(self%plate) .and. (self%has_waves .and. self%base /= base_thin &
         .or. any(self%base == [base_bonded, base_sliding]))
   end function has_response

   !> Modulus Q'_b of the plate
   elemental function plate_modulus(self, s) result(modulus)
      class(face_t), intent(in) :: self
      !> Laplace variable [1/s]
      complex(wp), intent(in) :: s
      !> Plane-strain modulus [Pa]; 0 for a rigid plate
      complex(wp) :: modulus

      modulus = 0.0_wp
      if (allocated(self%plate)) &
         modulus = self%plate%plane_strain_factor()*self%plate%complex_modulus(s)
   end function plate_modulus

   !> Compliance of the springs, 1/Q'_b + 1/Q'_a
   elemental function local_compliance(self, s) result(compliance)
      class(face_t), intent(in) :: self
      !> Laplace variable [1/s]
      complex(wp), intent(in) :: s
      !> Compliance [1/Pa]
      complex(wp) :: compliance

      compliance = 0.0_wp
      if (allocated(self%plate)) compliance = 1.0_wp/self%plate_modulus(s)
      if (allocated(self%striker)) compliance = compliance &
         + 1.0_wp/(self%striker%plane_strain_factor()*self%striker%complex_modulus(s))
   end function local_compliance

   !> Whether a body has a dashpot in parallel: the pressure ends with a step at the edge of a
   !> contact that grows
   elemental function is_viscous(self)
      class(face_t), intent(in) :: self
      logical :: is_viscous

      is_viscous = .false.
      if (allocated(self%plate)) is_viscous = self%plate%viscosity > 0.0_wp
      if (allocated(self%striker)) is_viscous = is_viscous .or. self%striker%viscosity > 0.0_wp
   end function is_viscous

   !> Compliance c(s) of what moves as a whole: of a thin plate by its bending waves, of a structure
   elemental function drift(self, s) result(compliance)
      class(face_t), intent(in) :: self
      !> Laplace variable [1/s]
      complex(wp), intent(in) :: s
      !> Displacement divided by force [m/N]; 0 without a structure unless the base is `base_thin`
      complex(wp) :: compliance

      compliance = self%structure%receptance(s)
      if (self%base == base_thin .and. allocated(self%plate)) compliance = &
         compliance + sqrt(3.0_wp/self%plate%density())/(4.0_wp*self%thickness**2) &
         /(s*sqrt(self%plate_modulus(s)))
   end function drift

   !> Laplace variable divided by the speed of shear waves, c_s^2 = Q'_b (1 - nu)/(2 rho)
   elemental function per_shear_speed(self, s) result(p)
      class(face_t), intent(in) :: self
      !> Laplace variable [1/s]
      complex(wp), intent(in) :: s
      !> s/c_s [1/m]; 0 without inertia
      complex(wp) :: p

      p = 0.0_wp
      if (.not. (allocated(self%plate) .and. self%has_waves)) return
      p = s/sqrt(self%plate_modulus(s)*((1.0_wp - self%plate%poisson_ratio()) &
         /(2.0_wp*self%plate%density())))
   end function per_shear_speed

   !> Poisson's ratio of the plate
   elemental function poisson_ratio(self) result(nu)
      class(face_t), intent(in) :: self
      !> The ratio [-]; 0 for a rigid plate
      real(wp) :: nu

      nu = 0.0_wp
      if (allocated(self%plate)) nu = self%plate%poisson_ratio()
   end function poisson_ratio

   !> L - 1 at many wavenumbers
   pure subroutine response(self, k, p, excess)
      class(face_t), intent(in) :: self
      !> Wavenumbers [1/m], > 0
      real(wp), intent(in) :: k(:)
      !> Laplace variable divided by the speed of shear waves [1/m], of `per_shear_speed`
      complex(wp), intent(in) :: p
      !> L - 1 [-], same shape
      complex(wp), intent(out) :: excess(:)

      if (self%has_waves) then
         call wave_responses(self%base, self%poisson_ratio(), self%thickness, k, p, excess)
      else
         excess = static_response(self%base, self%poisson_ratio(), k*self%thickness)
      end if
   end subroutine response

   !> L - 1 at many wavenumbers of a half space of the plate's material
   pure subroutine half_space_response(self, k, p, excess)
      class(face_t), intent(in) :: self
      !> Wavenumbers [1/m], > 0
      real(wp), intent(in) :: k(:)
      !> Laplace variable over the speed of shear waves [1/m], of `per_shear_speed`
      complex(wp), intent(in) :: p
      !> L - 1 [-], same shape
      complex(wp), intent(out) :: excess(:)

      call wave_responses(base_half_space, self%poisson_ratio(), 0.0_wp, k, p, excess)
   end subroutine half_space_response

end module vcor_impact_face
