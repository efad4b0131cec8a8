!> Response of a face as weights of convolution quadrature on a row of springs: a local part on the
!> springs, 1/Q', and a smooth part on the hats, (L - 1)/Q' and what moves as a whole
!>
!> No mass, shape, velocity or gravity is in it, so that impacts share it. Quadrature in k is by
!> panels of Gauss nodes, one grid for all frequencies: a node that depends on the frequency would
!> make an error that is not smooth in it, which the weights of late steps amplify.
module vcor_solver_coupled_kernel
   use vcor_error, only : error_t
   use vcor_impact_face, only : base_free, face_t
   use vcor_kinds, only : pi, wp
   use vcor_numeric_quadrature, only : gauss_nodes
   use vcor_solver_coupled_row, only : new_row, row_t, transforms
   use vcor_solver_coupled_rule, only : nodes, weights
   implicit none
   private

   public :: kernel_t, new_kernel, mesh_t

   !> Steps, springs and hats of a march
   type :: mesh_t
      !> Number of steps, a multiple of 4
      integer :: steps = 0
      !> Least number of springs
      integer :: springs = 0
      !> Number of hats, > 1
      integer :: hats = 0
      !> Duration of all steps [s], > 0
      real(wp) :: window = 0.0_wp
      !> Radius of the row of springs [m], > 0
      real(wp) :: radius = 0.0_wp
   contains
      procedure :: operations
   end type mesh_t

   !> Response of a face on a mesh
   type :: kernel_t
      type(mesh_t) :: mesh
      !> Springs and hats
      type(row_t) :: row
      !> Weights of the springs, shape (0:steps-1) [m/N per m]
      real(wp), allocatable :: local(:)
      !> Weights of the waves of an elastic half space, which pass, from the hats to two of their
      !> nodes, the axis and `beside` [m/N], that of lag n from hat j at (j, lags - n), shape
      !> (hats, lags, 2); unallocated without waves
      real(wp), allocatable :: passing(:, :, :)
      !> A node of the hats near the axis
      integer :: beside = 2
      !> Part of the striker in the local compliance
      real(wp) :: striker_share = 0.0_wp
      !> Poisson's ratio of the plate
      real(wp) :: poisson_ratio = 0.0_wp
      !> Whether the springs have a memory: more than their first weight counts
      logical :: remembers = .false.
      !> Whether hats act on each other
      logical :: has_response = .false.
      !> First weights of the hats, shape (hats, hats) [m/N]
      real(wp), allocatable :: now(:, :)
      !> Later weights of the hats [m/N], that of lag n from hat j to hat i at
      !> (j + hats (steps - 1 - n), i), shape (hats (steps - 1), hats)
      real(wp), allocatable :: later(:, :)
      !> What the face is: its base, Poisson's ratio, thickness, moduli at all frequencies and what
      !> moves as a whole
      integer, private :: base = -1
      logical, private :: has_waves = .false.
      real(wp), private :: thickness = 0.0_wp
      complex(wp), allocatable, private :: modulus(:), compliance(:), p(:), drift(:)
   contains
      procedure :: is_for
      procedure :: numbers
      procedure, private :: rate
   end type kernel_t

contains

   !> Operations that a kernel and a march take, about: with as many wavenumbers as steps, for each
   !> wavenumber and frequency the response and products of the hats; the transform of these; and
   !> for each step what all steps before have left in springs and hats
   pure function operations(self)
      class(mesh_t), intent(in) :: self
      real(wp) :: operations

      ! of the response
      real(wp), parameter :: response = 100.0_wp

      operations = real(self%steps, wp)**2*(response + 1.5_wp*real(self%hats, wp)**2 &
         + real(self%springs, wp))
   end function operations

   !> Whether the kernel is that of a face on a mesh
   function is_for(self, face, mesh) result(yes)
      class(kernel_t), intent(in) :: self
      type(face_t), intent(in) :: face
      type(mesh_t), intent(in) :: mesh
      logical :: yes

      complex(wp) :: s(0:mesh%steps/2)

      yes = self%mesh%steps == mesh%steps .and. self%mesh%springs == mesh%springs &
         .and. self%mesh%hats == mesh%hats .and. self%base == face%base &
         .and. (self%has_waves .eqv. face%has_waves) &
         .and. .not. abs(self%mesh%window - mesh%window) > 0.0_wp &
         .and. .not. abs(self%mesh%radius - mesh%radius) > 0.0_wp &
         .and. .not. abs(self%poisson_ratio - face%poisson_ratio()) > 0.0_wp &
         .and. .not. abs(self%thickness - face%thickness) > 0.0_wp
      if (.not. yes) return
      s = nodes(mesh%steps, mesh%window/real(mesh%steps, wp))
      yes = all(abs(self%modulus - face%plate_modulus(s)) <= 0.0_wp) &
         .and. all(abs(self%compliance - face%local_compliance(s)) <= 0.0_wp) &
         .and. all(abs(self%p - face%per_shear_speed(s)) <= 0.0_wp)
      if (yes) yes = all(abs(self%drift - face%drift(s)) <= 0.0_wp)
   end function is_for

   !> Laplace variable of a step, 1/dt
   pure function rate(self)
      class(kernel_t), intent(in) :: self
      !> The variable [1/s]
      real(wp) :: rate

      rate = real(self%mesh%steps, wp)/self%mesh%window
   end function rate

   !> Size of the kernel in real numbers
   pure function numbers(self)
      class(kernel_t), intent(in) :: self
      integer :: numbers

      numbers = self%mesh%steps*(self%mesh%hats*(self%mesh%hats + 1) + 8) + 8*self%row%springs
   end function numbers

   !> Build the kernel of a face on a mesh
   subroutine new_kernel(self, face, mesh, error)
      type(kernel_t), intent(out) :: self
      type(face_t), intent(in) :: face
      type(mesh_t), intent(in) :: mesh
      !> Error of code `error_internal`
      type(error_t), allocatable, intent(out) :: error

      ! the part of the first weight from which the springs are elastic
      real(wp), parameter :: negligible = 1.0e-7_wp
      complex(wp) :: s(0:mesh%steps/2)
      real(wp) :: found(1, 0:mesh%steps - 1)

      self%mesh = mesh
      self%base = face%base
      self%has_waves = face%has_waves
      self%poisson_ratio = face%poisson_ratio()
      self%thickness = face%thickness
      s = nodes(mesh%steps, mesh%window/real(mesh%steps, wp))
      self%modulus = face%plate_modulus(s)
      self%compliance = face%local_compliance(s)
      self%p = face%per_shear_speed(s)
      self%drift = face%drift(s)
      call new_row(self%row, mesh%radius, mesh%hats, mesh%springs)
      found = weights(reshape(self%compliance, [1, size(s)]))
      allocate (self%local(0:mesh%steps - 1), source=found(1, :))
      self%remembers = any(abs(self%local(1:)) > negligible*self%local(0))
      call add_response(self, face, s, error)
   end subroutine new_kernel

   !> Weights of the hats: with g(k), the cosine transforms of the functions dual to the hats, the
   !> response of hat j to hat i is
   !>
   !>     C_ij(s) = (1/(pi Q'(s))) int_0^oo (L(k, s) - 1) g_i(k) g_j(k) dk + c(s)
   subroutine add_response(self, face, s, error)
      type(kernel_t), intent(inout) :: self
      type(face_t), intent(in) :: face
      !> Laplace variables [1/s], shape (0:steps/2)
      complex(wp), intent(in) :: s(0:)
      type(error_t), allocatable, intent(out) :: error

      complex(wp), allocatable :: response(:, :), excess(:, :), passing(:)
      real(wp), allocatable :: k(:), share(:), dual(:, :), products(:, :), weight(:, :)
      integer :: hats, steps, i, j, l, n

      hats = self%mesh%hats
      steps = self%mesh%steps
      allocate (self%now(hats, hats), source=0.0_wp)
      allocate (response(pair(hats, hats), 0:steps/2), source=(0.0_wp, 0.0_wp))
      if (face%has_response()) then
         passing = passing_nodes(self, face)
         call wavenumbers(face, [self%p, passing], self%mesh%radius, self%row%node(2), k, share)
         share = share/pi
         allocate (dual(hats, size(k)), products(size(response, 1), size(k)), &
            excess(size(k), 0:steps/2))
         call transforms(self%row%node, k, dual, error)
         if (allocated(error)) return
         do n = 1, size(k)
            do j = 1, hats
               products(pair(1, j):pair(j, j), n) = share(n)*dual(j, n)*dual(:j, n)
            end do
         end do
         do l = 0, steps/2
            if (l == 0 .or. face%has_waves) then
               call face%response(k, self%p(l + 1), excess(:, l))
            else
               excess(:, l) = excess(:, 0)
            end if
         end do
         response = cmplx(matmul(products, real(excess, wp)), matmul(products, aimag(excess)), wp)
         do l = 0, steps/2
            response(:, l) = response(:, l)/self%modulus(l + 1)
         end do
         if (face%has_waves) call add_passing(self, face, k, share, dual, passing)
      end if
      do l = 0, steps/2
         response(:, l) = response(:, l) + face%drift(s(l))
      end do
      self%has_response = any(abs(response) > 0.0_wp)
      if (.not. self%has_response) return
      allocate (weight(size(response, 1), 0:steps - 1), self%later(hats*(steps - 1), hats))
      weight = weights(response)
      do j = 1, hats
         do i = 1, hats
            self%now(i, j) = weight(pair(i, j), 0)
         end do
         do n = 1, steps - 1
            do i = 1, hats
               self%later(i + hats*(steps - 1 - n), j) = weight(pair(i, j), n)
            end do
         end do
      end do
   end subroutine add_response

   !> Place of an element of a symmetric matrix of which the upper triangle is stored by columns
   pure function pair(i, j)
      !> Row and column
      integer, intent(in) :: i, j
      integer :: pair

      pair = min(i, j) + max(i, j)*(max(i, j) - 1)/2
   end function pair

   !> Laplace variables over the speed of shear waves at which the waves that pass are needed: of an
   !> elastic half space as stiff as the plate in a step, for a quarter of the window. They cross
   !> what is left of the contact long before
   pure function passing_nodes(self, face) result(p)
      type(kernel_t), intent(in) :: self
      type(face_t), intent(in) :: face
      !> The variables [1/m], none without waves
      complex(wp), allocatable :: p(:)

      integer, parameter :: part = 4, turn = 4
      integer :: lags

      allocate (p(0))
      if (.not. face%has_waves) return
      lags = turn*((self%mesh%steps - 1)/(part*turn) + 1)
      p = nodes(lags, 1.0_wp/self%rate()) &
         *(real(face%per_shear_speed(cmplx(self%rate(), kind=wp)), wp)/self%rate())
   end function passing_nodes

   !> Weights of the waves that pass
   subroutine add_passing(self, face, k, share, dual, p)
      type(kernel_t), intent(inout) :: self
      type(face_t), intent(in) :: face
      !> Wavenumbers and their weights over pi [1/m]
      real(wp), intent(in) :: k(:), share(:)
      !> Transforms of the functions dual to the hats, shape (hats, size(k))
      real(wp), intent(in) :: dual(:, :)
      !> Laplace variables over the speed of its shear waves [1/m], of `passing_nodes`
      complex(wp), intent(in) :: p(:)

      ! part of the row at which `beside` stands, of its elements by their grading an eighth of the
      ! radius: near enough for the curvature on the axis
      real(wp), parameter :: part = 0.25_wp
      complex(wp) :: excess(size(k)), response(2*size(dual, 1), size(p)), rate
      real(wp) :: products(2*size(dual, 1), size(k)), stiffness
      integer :: hats, l, lags, n

      hats = size(dual, 1)
      self%beside = 1 + ceiling(part*real(hats - 1, wp))
      rate = cmplx(self%rate(), kind=wp)
      stiffness = real(face%plate_modulus(rate), wp)
      self%striker_share = max(0.0_wp, 1.0_wp &
         - 1.0_wp/(stiffness*real(face%local_compliance(rate), wp)))
      do n = 1, size(k)
         products(:hats, n) = (share(n)/stiffness*dual(1, n))*dual(:, n)
         products(hats + 1:, n) = (share(n)/stiffness*dual(self%beside, n))*dual(:, n)
      end do
      do l = 1, size(p)
         call face%half_space_response(k, p(l), excess)
         response(:, l) = cmplx(matmul(products, real(excess, wp)), &
            matmul(products, aimag(excess)), wp)
      end do
      lags = 2*(size(p) - 1)
      allocate (self%passing(hats, lags, 2))
      self%passing = reshape(weights(response), [hats, lags, 2], order=[1, 3, 2])
      self%passing = self%passing(:, lags:1:-1, :)
   end subroutine add_passing

   !> Nodes and weights of the quadrature in k: panels of Gauss nodes, short where the response of
   !> any frequency has a pole nearby, where a layer resonates, and against the waves cos(ka)
   pure subroutine wavenumbers(face, p, radius, finest, k, weight)
      type(face_t), intent(in) :: face
      !> Laplace variables divided by the speed of shear waves [1/m]
      complex(wp), intent(in) :: p(:)
      !> Radius of the row a [m]
      real(wp), intent(in) :: radius
      !> Length of the shortest element of the hats [m]
      real(wp), intent(in) :: finest
      !> Wavenumbers [1/m]
      real(wp), allocatable, intent(out) :: k(:)
      !> Weights [1/m]
      real(wp), allocatable, intent(out) :: weight(:)

      integer, parameter :: order = 10
      real(wp) :: node(order), share(order), start, length, least, last

      call gauss_nodes(node, share)
      last = max(5.0_wp/finest, 20.0_wp/radius)
      if (face%has_waves) then
         least = minval(abs(p))
      else
         least = 1.0_wp/face%thickness
      end if
      allocate (k(0), weight(0))
      start = 0.0_wp
      do while (start < last)
         length = min(6.0_wp/radius, 0.7_wp*max(start, least))
         if (.not. start > 0.0_wp) length = min(length, 0.5_wp*least)
         if (face%thickness > 0.0_wp .and. start*face%thickness < 25.0_wp) &
            length = min(length, 1.5_wp/face%thickness)
         if (face%has_waves .and. start > 0.0_wp) length = min(length, clearance(start))
         k = [k, start + length*node]
         weight = [weight, length*share]
         start = start + length
      end do

   contains

      !> Length that the poles of shear, Rayleigh and bending waves near a wavenumber allow
      pure function clearance(k) result(length)
         !> Wavenumber [1/m], > 0
         real(wp), intent(in) :: k
         real(wp) :: length

         real(wp) :: wave
         integer :: l

         length = huge(1.0_wp)
         do l = 1, size(p)
            wave = abs(p(l))
            if (wave > 0.8_wp*k .and. wave < 2.2_wp*k) &
               length = min(length, 0.77_wp*real(p(l), wp)*min(1.0_wp, k/wave))
            if (face%base /= base_free) cycle
            wave = (6.0_wp*(1.0_wp - face%poisson_ratio()))**0.25_wp*sqrt(wave/face%thickness)
            if (wave*face%thickness < 2.5_wp .and. wave > 0.75_wp*k .and. wave < 1.3_wp*k) &
               length = min(length, 0.54_wp*k*real(p(l), wp)/abs(p(l)))
         end do
      end function clearance
   end subroutine wavenumbers

end module vcor_solver_coupled_kernel
