!> Response of a face as weights of convolution quadrature on a row of springs: a local part on the
!> springs, 1/Q', and a smooth part on the hats, (L - 1)/Q' and what moves as a whole
!>
!> No mass, shape, velocity or gravity is in it, so that impacts share it.
module vcor_solver_coupled_kernel
   use vcor_error, only : error_t
   use vcor_impact_face, only : face_t
   use vcor_kinds, only : pi, wp
   use vcor_numeric_quadrature, only : gauss_nodes, legendre
   use vcor_solver_coupled_row, only : new_row, row_t, transforms
   use vcor_solver_coupled_rule, only : nodes, weights, wrap
   use vcor_solver_coupled_spectrum, only : face_moduli_t, new_moduli, new_spectrum, panel_nodes, &
      spectrum_t
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
      !> Whether the springs have a memory: more than their first weight counts
      logical :: remembers = .false.
      !> Whether hats act on each other
      logical :: has_response = .false.
      !> First weights of the hats, shape (hats, hats) [m/N]
      real(wp), allocatable :: now(:, :)
      !> Later weights of the hats [m/N], that of lag n from hat j to hat i at
      !> (i, j + hats (steps - 1 - n)), shape (hats, hats (steps - 1))
      real(wp), allocatable :: later(:, :)
      !> What the face is at the frequencies of the mesh, and the compliance of what moves as a
      !> whole
      type(face_moduli_t) :: moduli
      complex(wp), allocatable, private :: drift(:)
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

      ! of the response, by its additions, products, quotients and roots
      real(wp), parameter :: response = 100.0_wp

      operations = real(self%steps, wp)**2*(response + 1.5_wp*real(self%hats, wp)**2 &
         + real(self%springs, wp))
   end function operations

   !> Whether the kernel is that of a face on a mesh
   pure function is_for(self, face, mesh) result(yes)
      class(kernel_t), intent(in) :: self
      type(face_t), intent(in) :: face
      type(mesh_t), intent(in) :: mesh
      logical :: yes

      yes = self%mesh%springs == mesh%springs .and. self%mesh%hats == mesh%hats &
         .and. .not. abs(self%mesh%radius - mesh%radius) > 0.0_wp
      if (yes) yes = self%moduli%is_for(face, mesh%steps, mesh%window)
      if (yes) yes = all(abs(self%drift - drift_of(face, self)) <= 0.0_wp)
   end function is_for

   !> Compliance of what moves as a whole, at the frequencies of the mesh
   pure function drift_of(face, kernel) result(drift)
      type(face_t), intent(in) :: face
      class(kernel_t), intent(in) :: kernel
      !> Displacement over force [m/N]
      complex(wp) :: drift(kernel%mesh%steps/2 + 1)

      drift = face%drift(nodes(kernel%mesh%steps, 1.0_wp/kernel%rate()))
   end function drift_of

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
   subroutine new_kernel(self, face, mesh, spectrum, error)
      type(kernel_t), intent(out) :: self
      type(face_t), intent(in) :: face
      type(mesh_t), intent(in) :: mesh
      !> Response of the face, computed anew unless it suits the mesh, and as far as it needs it
      type(spectrum_t), intent(inout) :: spectrum
      !> Error of code `error_internal`
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: found(1, 0:mesh%steps - 1)

      self%mesh = mesh
      call new_moduli(self%moduli, face, mesh%steps, mesh%window)
      call new_row(self%row, mesh%radius, mesh%hats, mesh%springs)
      found = weights(reshape(self%moduli%compliance, [1, size(self%moduli%compliance)]))
      allocate (self%local(0:mesh%steps - 1), source=found(1, :))
      ! weights have errors of this size
      self%remembers = any(abs(self%local(1:)) > wrap*self%local(0))
      call add_response(self, face, spectrum, error)
   end subroutine new_kernel

   !> Weights of the hats: with g(k), the cosine transforms of the functions dual to the hats, the
   !> response of hat j to hat i is
   !>
   !>     C_ij(s) = (1/(pi Q'(s))) int_0^oo (L(k, s) - 1) g_i(k) g_j(k) dk + c(s)
   !>
   !> Of these symmetric matrices the upper triangle is stored, see `pair`: the integrals take a
   !> tenth of the time of an impact, and all elements would take nearly twice as long
   subroutine add_response(self, face, spectrum, error)
      type(kernel_t), intent(inout) :: self
      type(face_t), intent(in) :: face
      type(spectrum_t), intent(inout) :: spectrum
      type(error_t), allocatable, intent(out) :: error

      complex(wp) :: response(pair(self%mesh%hats, self%mesh%hats), 0:self%mesh%steps/2)
      complex(wp), allocatable :: integral(:, :)
      real(wp), allocatable :: products(:, :)
      real(wp) :: last
      integer :: l

      self%drift = drift_of(face, self)
      response = spread(self%drift, 1, size(response, 1))
      if (face%has_response()) then
         last = last_wavenumber(self%row)
         if (.not. spectrum%suits(self%moduli, self%mesh%radius)) &
            call new_spectrum(spectrum, face, self%moduli, self%mesh%radius)
         call spectrum%extend(face, last)
         call find_products(self%row, spectrum, last, products, error)
         if (allocated(error)) return
         integral = integrals(products, spectrum%excess)
         do l = 0, ubound(response, 2)
            ! without waves L is one at all frequencies
            response(:, l) = integral(:, 1 + merge(l, 0, face%has_waves)) &
               /self%moduli%modulus(l) + response(:, l)
         end do
         if (face%has_waves) call add_passing(self, face, products, spectrum%passing)
      end if
      call add_weights(self, response)
   end subroutine add_response

   !> Integrals over the wavenumbers, sum products (L - 1)
   pure function integrals(products, excess) result(response)
      !> Products of hats, shape (pairs, nodes)
      real(wp), intent(in) :: products(:, :)
      !> L - 1, shape (>= nodes, frequencies)
      complex(wp), intent(in) :: excess(:, :)
      complex(wp) :: response(size(products, 1), size(excess, 2))

      real(wp) :: part(size(products, 2), size(excess, 2))
      real(wp), dimension(size(products, 1), size(excess, 2)) :: even, odd

      part = real(excess(:size(products, 2), :), wp)
      even = matmul(products, part)
      part = aimag(excess(:size(products, 2), :))
      odd = matmul(products, part)
      response = cmplx(even, odd, wp)
   end function integrals

   !> Unpack the weights of the hats
   pure subroutine add_weights(self, response)
      type(kernel_t), intent(inout) :: self
      !> Response at the frequencies, shape (pairs, 0:steps/2)
      complex(wp), intent(in) :: response(:, 0:)

      real(wp), allocatable :: weight(:, :)
      integer :: i, j, n

      associate (hats => self%mesh%hats, steps => self%mesh%steps)
         allocate (self%now(hats, hats), source=0.0_wp)
         self%has_response = any(abs(response) > 0.0_wp)
         if (.not. self%has_response) return
         allocate (weight(size(response, 1), 0:steps - 1), self%later(hats, hats*(steps - 1)))
         weight = weights(response)
         do j = 1, hats
            do i = 1, hats
               self%now(i, j) = weight(pair(i, j), 0)
            end do
            do n = 1, steps - 1
               do i = 1, hats
                  self%later(i, j + hats*(steps - 1 - n)) = weight(pair(i, j), n)
               end do
            end do
         end do
      end associate
   end subroutine add_weights

   !> Place of an element of a symmetric matrix of which the upper triangle is stored by columns
   pure function pair(i, j)
      !> Row and column
      integer, intent(in) :: i, j
      integer :: pair

      pair = min(i, j) + max(i, j)*(max(i, j) - 1)/2
   end function pair

   !> Wavenumber beyond which the hats have no part in the response: the shortest of them is a wave
   pure function last_wavenumber(row) result(last)
      type(row_t), intent(in) :: row
      !> The wavenumber [1/m]
      real(wp) :: last

      last = max(5.0_wp/row%node(2), 20.0_wp/row%node(row%hats))
   end function last_wavenumber

   !> Products g_i g_j/pi of the transforms of hats times the weights of the quadrature, for the
   !> response at the wavenumbers of a spectrum. On a panel of several parts the response is the
   !> polynomial through its nodes
   subroutine find_products(row, spectrum, last, products, error)
      type(row_t), intent(in) :: row
      type(spectrum_t), intent(in) :: spectrum
      !> Wavenumber up to which the response counts [1/m]
      real(wp), intent(in) :: last
      !> Products for the first nodes of the spectrum, shape (pairs, nodes)
      real(wp), allocatable, intent(out) :: products(:, :)
      type(error_t), allocatable, intent(out) :: error

      real(wp), allocatable :: k(:), share(:), dual(:, :), part(:, :), value(:, :)
      real(wp) :: node(panel_nodes), weight(panel_nodes)
      integer :: panel, panels, i, j, n, first, last_of

      panels = count(spectrum%start < last)
      call gauss_nodes(node, weight)
      allocate (k(0), share(0))
      do panel = 1, panels
         associate (parts => spectrum%parts(panel), &
                    length => spectrum%length(panel)/real(spectrum%parts(panel), wp))
            k = [k, spectrum%start(panel) + length*[(real(i, wp) + node, i=0, parts - 1)]]
            share = [share, length/pi*[(weight, i=1, parts)]]
         end associate
      end do
      allocate (dual(row%hats, size(k)), products(pair(row%hats, row%hats), panel_nodes*panels))
      call transforms(row%node, k, dual, error)
      if (allocated(error)) return
      last_of = 0
      do panel = 1, panels
         first = last_of + 1
         last_of = last_of + panel_nodes*spectrum%parts(panel)
         allocate (part(size(products, 1), first:last_of))
         do n = first, last_of
            do j = 1, row%hats
               part(pair(1, j):pair(j, j), n) = share(n)*dual(j, n)*dual(:j, n)
            end do
         end do
         associate (here => products(:, panel_nodes*(panel - 1) + 1:panel_nodes*panel))
            if (spectrum%parts(panel) > 1) then
               allocate (value(size(part, 2), panel_nodes))
               value = interpolation(node, weight, (k(first:last_of) - spectrum%start(panel)) &
                  /spectrum%length(panel))
               here = matmul(part, value)
               deallocate (value)
            else
               here = part
            end if
         end associate
         deallocate (part)
      end do
   end subroutine find_products

   !> Polynomials that are 1 at one Gauss node and 0 at the others: by the sum of Legendre
   !> polynomials, which the Gauss rule integrates exactly
   pure function interpolation(node, weight, x) result(value)
      !> Nodes and weights of the Gauss rule on (0, 1)
      real(wp), intent(in) :: node(:), weight(:)
      !> Places, 0 to 1
      real(wp), intent(in) :: x(:)
      !> Values, shape (size(x), size(node))
      real(wp) :: value(size(x), size(node))

      real(wp) :: at(0:size(node) - 1), at_node(0:size(node) - 1, size(node))
      integer :: i, j, n

      n = size(node)
      do i = 1, n
         at_node(:, i) = weight(i)*legendre(n - 1, 2.0_wp*node(i) - 1.0_wp) &
            *[(real(2*j + 1, wp), j=0, n - 1)]
      end do
      do i = 1, size(x)
         at = legendre(n - 1, 2.0_wp*x(i) - 1.0_wp)
         value(i, :) = matmul(at, at_node)
      end do
   end function interpolation

   !> Weights of the waves that pass
   subroutine add_passing(self, face, products, excess)
      type(kernel_t), intent(inout) :: self
      type(face_t), intent(in) :: face
      !> Products of the hats, of `find_products`
      real(wp), intent(in) :: products(:, :)
      !> L - 1 of the waves, shape (>= nodes, frequencies)
      complex(wp), intent(in) :: excess(:, :)

      ! part of the row at which `beside` stands, of its elements by their grading an eighth of the
      ! radius: near enough for the curvature on the axis. With an eighth and a half, contact times
      ! of 40 random impacts change by up to 3e-4, 0.8 and 2 stated errors
      real(wp), parameter :: part = 0.25_wp
      complex(wp) :: rate
      real(wp) :: stiffness, near(2*self%mesh%hats, size(products, 2))
      real(wp) :: weight(2*self%mesh%hats, 2*(size(excess, 2) - 1))
      integer :: j, n, lags, hats

      hats = self%mesh%hats
      self%beside = 1 + ceiling(part*real(hats - 1, wp))
      rate = cmplx(self%rate(), kind=wp)
      stiffness = real(face%plate_modulus(rate), wp)
      self%striker_share = max(0.0_wp, 1.0_wp &
         - 1.0_wp/(stiffness*real(face%local_compliance(rate), wp)))
      lags = 2*(size(excess, 2) - 1)
      allocate (self%passing(hats, lags, 2))
      near(:hats, :) = products([(pair(1, j), j=1, hats)], :)
      near(hats + 1:, :) = products([(pair(self%beside, j), j=1, hats)], :)
      weight = weights(integrals(near, excess))/stiffness
      do n = 1, lags
         self%passing(:, lags + 1 - n, 1) = weight(:hats, n)
         self%passing(:, lags + 1 - n, 2) = weight(hats + 1:, n)
      end do
   end subroutine add_passing

end module vcor_solver_coupled_kernel
