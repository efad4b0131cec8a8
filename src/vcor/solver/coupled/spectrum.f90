!> Response L - 1 of a face at the wavenumbers and frequencies of a march
!>
!> Neither springs nor hats are in it, so that meshes with the same steps share it. The wavenumbers
!> are panels of Gauss nodes, the same for all frequencies: a node that depends on the frequency
!> would make an error that is not smooth in it, which the weights of late steps amplify.
module vcor_solver_coupled_spectrum
   use vcor_impact_face, only : base_free, face_t
   use vcor_kinds, only : wp
   use vcor_numeric_quadrature, only : gauss_nodes
   use vcor_solver_coupled_rule, only : nodes
   implicit none
   private

   public :: face_moduli_t, new_moduli, new_spectrum, panel_nodes, spectrum_t

   !> What a face is at the frequencies of a march
   type :: face_moduli_t
      !> Number of steps, and duration of all [s]
      integer :: steps = 0
      real(wp) :: window = 0.0_wp
      !> Modulus of the plate [Pa], compliance of the springs [1/Pa], and Laplace variable over the
      !> speed of shear waves [1/m], shape (0:steps/2)
      complex(wp), allocatable :: modulus(:), compliance(:), p(:)
      !> Poisson's ratio of the plate [-]
      real(wp) :: poisson_ratio = 0.0_wp
      !> Base, thickness [m] and whether the inertia of the plate counts
      integer, private :: base = -1
      real(wp), private :: thickness = 0.0_wp
      logical, private :: has_waves = .false.
   contains
      procedure :: is_for
      procedure :: equals
   end type face_moduli_t

   !> Nodes of a panel
   integer, parameter :: panel_nodes = 10
   !> Length of a panel, or of a part of it, over which the products of hats are integrated, times
   !> the radius: these are waves cos(2 k a), of which ten Gauss nodes integrate 12 radians to 3e-9
   real(wp), parameter :: integrated = 6.0_wp

   !> The response
   type :: spectrum_t
      type(face_moduli_t) :: moduli
      !> Radius of the row of springs [m] for which the panels are
      real(wp) :: radius = 0.0_wp
      !> End of the last panel [1/m]
      real(wp) :: last = 0.0_wp
      !> Start and length of the panels [1/m], and parts over which products of hats are integrated
      real(wp), allocatable :: start(:), length(:)
      integer, allocatable :: parts(:)
      !> L - 1 at the nodes of the panels, shape (panel_nodes*panels, 0:steps/2), or 0:0 without
      !> waves
      complex(wp), allocatable :: excess(:, :)
      !> The same of an elastic half space as stiff as the plate in a step, for the first quarter of
      !> the lags; unallocated without waves
      complex(wp), allocatable :: passing(:, :)
   contains
      procedure :: extend
      procedure :: suits
      procedure, private :: add_panels
   end type spectrum_t

contains

   !> Find what a face is at the frequencies of a march
   pure subroutine new_moduli(self, face, steps, window)
      type(face_moduli_t), intent(out) :: self
      type(face_t), intent(in) :: face
      !> Number of steps, and duration of all [s]
      integer, intent(in) :: steps
      real(wp), intent(in) :: window

      complex(wp) :: s(0:steps/2)

      s = nodes(steps, window/real(steps, wp))
      self%steps = steps
      self%window = window
      self%base = face%base
      self%has_waves = face%has_waves
      self%poisson_ratio = face%poisson_ratio()
      self%thickness = face%thickness
      allocate (self%modulus(0:steps/2), source=face%plate_modulus(s))
      allocate (self%compliance(0:steps/2), source=face%local_compliance(s))
      allocate (self%p(0:steps/2), source=face%per_shear_speed(s))
   end subroutine new_moduli

   !> Whether this is what a face is at the frequencies of a march
   pure function is_for(self, face, steps, window) result(yes)
      class(face_moduli_t), intent(in) :: self
      type(face_t), intent(in) :: face
      !> Number of steps, and duration of all [s]
      integer, intent(in) :: steps
      real(wp), intent(in) :: window
      logical :: yes

      type(face_moduli_t) :: other

      yes = self%steps == steps .and. .not. abs(self%window - window) > 0.0_wp
      if (.not. yes) return
      call new_moduli(other, face, steps, window)
      yes = self%equals(other)
   end function is_for

   !> Whether two faces and marches are the same
   pure function equals(self, other) result(yes)
      class(face_moduli_t), intent(in) :: self
      type(face_moduli_t), intent(in) :: other
      logical :: yes

      yes = self%steps == other%steps .and. .not. abs(self%window - other%window) > 0.0_wp &
         .and. self%base == other%base .and. (self%has_waves .eqv. other%has_waves) &
         .and. .not. abs(self%poisson_ratio - other%poisson_ratio) > 0.0_wp &
         .and. .not. abs(self%thickness - other%thickness) > 0.0_wp
      if (.not. yes) return
      yes = all(abs(self%modulus - other%modulus) <= 0.0_wp) &
         .and. all(abs(self%compliance - other%compliance) <= 0.0_wp) &
         .and. all(abs(self%p - other%p) <= 0.0_wp)
   end function equals

   !> Begin a spectrum without wavenumbers
   pure subroutine new_spectrum(self, face, moduli, radius)
      type(spectrum_t), intent(out) :: self
      type(face_t), intent(in) :: face
      !> The face at the frequencies of the march
      type(face_moduli_t), intent(in) :: moduli
      !> Radius of the row of springs [m]
      real(wp), intent(in) :: radius

      integer :: frequencies

      self%moduli = moduli
      self%radius = radius
      frequencies = moduli%steps/2
      if (.not. face%has_waves) frequencies = 0
      allocate (self%start(0), self%length(0), self%excess(0, 0:frequencies))
      if (face%has_waves) &
         allocate (self%passing(0, 0:size(passing_nodes(face, moduli)) - 1))
   end subroutine new_spectrum

   !> Compute the response up to a wavenumber. Panels and nodes do not depend on how far it has been
   !> known before
   pure subroutine extend(self, face, last)
      class(spectrum_t), intent(inout) :: self
      type(face_t), intent(in) :: face
      !> Wavenumber up to which the response is needed [1/m]
      real(wp), intent(in) :: last

      complex(wp), allocatable :: passing(:), excess(:, :)
      real(wp), allocatable :: k(:)
      real(wp) :: node(panel_nodes), share(panel_nodes)
      integer :: i, known, l

      if (self%last >= last) return
      known = size(self%start)
      allocate (passing, source=passing_nodes(face, self%moduli))
      call self%add_panels(face, [self%moduli%p, passing], last)
      call gauss_nodes(node, share)
      allocate (k, source=[(self%start(i) + self%length(i)*node, i=known + 1, size(self%start))])
      known = panel_nodes*known
      allocate (excess(known + size(k), 0:ubound(self%excess, 2)))
      do l = 0, ubound(excess, 2)
         excess(:known, l) = self%excess(:, l)
         call face%response(k, self%moduli%p(l), excess(known + 1:, l))
      end do
      call move_alloc(excess, self%excess)
      if (.not. face%has_waves) return
      allocate (excess(known + size(k), 0:ubound(self%passing, 2)))
      do l = 0, ubound(excess, 2)
         excess(:known, l) = self%passing(:, l)
         call face%half_space_response(k, passing(l + 1), excess(known + 1:, l))
      end do
      call move_alloc(excess, self%passing)
   end subroutine extend

   !> Whether the response is that of a face at the frequencies of a march
   pure function suits(self, moduli, radius)
      class(spectrum_t), intent(in) :: self
      type(face_moduli_t), intent(in) :: moduli
      !> Radius of the row of springs [m]
      real(wp), intent(in) :: radius
      logical :: suits

      suits = allocated(self%excess) .and. .not. abs(self%radius - radius) > 0.0_wp
      if (suits) suits = self%moduli%equals(moduli)
   end function suits

   !> Laplace variables over the speed of shear waves at which the waves that pass are needed: of an
   !> elastic half space as stiff as the plate in a step, for a quarter of the window. They cross
   !> what is left of the contact long before
   pure function passing_nodes(face, moduli) result(p)
      type(face_t), intent(in) :: face
      type(face_moduli_t), intent(in) :: moduli
      !> The variables [1/m], none without waves
      complex(wp), allocatable :: p(:)

      ! a quarter of the window; the transform takes steps in multiples of four
      integer, parameter :: part = 4, turn = 4
      real(wp) :: rate
      integer :: lags

      allocate (p(0))
      if (.not. face%has_waves) return
      rate = real(moduli%steps, wp)/moduli%window
      lags = turn*((moduli%steps - 1)/(part*turn) + 1)
      p = nodes(lags, 1.0_wp/rate)*(real(face%per_shear_speed(cmplx(rate, kind=wp)), wp)/rate)
   end function passing_nodes

   !> Divide the wavenumbers from the last panel on into panels, short where the response of any
   !> frequency has a pole nearby and where a layer resonates.
   !>
   !> A panel over which the products of hats are integrated at once integrates the response to
   !> twice as many digits as a polynomial through its nodes has. A longer one has the response as
   !> that polynomial, so that its poles, at k = 0 too, must be farther from it: with the distance x
   !> over half of the length, the polynomial errs by (x + sqrt(x^2 +- 1))^-10, 1e-10 at x = 5
   pure subroutine add_panels(self, face, p, last)
      class(spectrum_t), intent(inout) :: self
      type(face_t), intent(in) :: face
      !> Laplace variables divided by the speed of shear waves [1/m]
      complex(wp), intent(in) :: p(:)
      !> Wavenumber at which the last panel ends or earlier [1/m]
      real(wp), intent(in) :: last

      ! with the distance of a pole over half of the length 2.6 and 5, and the length over the
      ! distance of the panel from k = 0
      real(wp), parameter :: near(2) = [0.77_wp, 0.4_wp], growth(2) = [0.7_wp, 0.5_wp]
      ! wavenumber times thickness up to which a layer resonates: half of it changes results of 40
      ! random impacts by up to 6e-7, 3e-4 stated errors
      real(wp), parameter :: resonant = 25.0_wp
      real(wp) :: start, length, least, longer

      if (face%has_waves) then
         least = minval(abs(p))
      else
         least = 1.0_wp/face%thickness
      end if
      start = self%last
      do while (start < last)
         length = 0.5_wp*least
         if (start > 0.0_wp) length = min(growth(1)*max(start, least), near(1)*clearance(start))
         if (start*face%thickness < resonant .and. face%thickness > 0.0_wp) then
            length = min(length, 1.5_wp/face%thickness, integrated/self%radius)
         else
            longer = min(growth(2)*start, near(2)*clearance(start))
            length = min(length, max(longer, integrated/self%radius))
         end if
         self%start = [self%start, start]
         self%length = [self%length, length]
         start = start + length
      end do
      self%last = start
      self%parts = ceiling(self%length*(self%radius/integrated*(1.0_wp - epsilon(1.0_wp))))

   contains

      !> Distance of the poles of shear, Rayleigh and bending waves near a wavenumber from the real
      !> axis
      pure function clearance(k) result(distance)
         !> Wavenumber [1/m], > 0
         real(wp), intent(in) :: k
         real(wp) :: distance

         real(wp) :: wave
         integer :: l

         distance = huge(1.0_wp)
         if (.not. face%has_waves) return
         do l = 1, size(p)
            wave = abs(p(l))
            if (wave > 0.8_wp*k .and. wave < 2.2_wp*k) &
               distance = min(distance, real(p(l), wp)*min(1.0_wp, k/wave))
            if (face%base /= base_free) cycle
            wave = (6.0_wp*(1.0_wp - face%poisson_ratio()))**0.25_wp*sqrt(wave/face%thickness)
            if (wave*face%thickness < 2.5_wp .and. wave > 0.75_wp*k .and. wave < 1.3_wp*k) &
               distance = min(distance, 0.7_wp*k*real(p(l), wp)/abs(p(l)))
         end do
      end function clearance
   end subroutine add_panels

end module vcor_solver_coupled_spectrum
