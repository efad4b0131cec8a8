!> Kernels that impacts share, and responses that the meshes of one impact share
module vcor_solver_coupled_store
   use vcor_error, only : error_t
   use vcor_impact_face, only : face_t
   use vcor_solver_coupled_kernel, only : kernel_t, mesh_t, new_kernel
   use vcor_solver_coupled_spectrum, only : spectrum_t
   implicit none
   private

   public :: new_store, store_t

   !> Place of a kernel
   type :: slot_t
      type(kernel_t), allocatable :: kernel
   end type slot_t

   !> Places for kernels, and their largest size in real numbers, 64 MB
   integer, parameter :: slots = 64, most_numbers = 8000000
   !> Places for the responses that meshes of an impact share: three of its pairs of meshes
   integer, parameter :: spectra = 3

   !> The kernels and responses
   type :: store_t
      !> Kernels, shape (slots); allocatable, for gfortran 12 does not finalise an array of fixed
      !> shape
      type(slot_t), allocatable :: slot(:)
      !> Responses, and the place of the newest
      type(spectrum_t), allocatable, private :: spectrum(:)
      integer, private :: newest_spectrum = spectra
      !> Place of the newest kernel
      integer, private :: newest = slots
   contains
      procedure :: find
   end type store_t

contains

   !> Build an empty store
   pure subroutine new_store(self)
      type(store_t), intent(out) :: self

      allocate (self%slot(slots), self%spectrum(spectra))
   end subroutine new_store

   !> Find the kernel of a face on a mesh, and compute it if there is none
   subroutine find(self, face, mesh, i, error)
      class(store_t), intent(inout) :: self
      type(face_t), intent(in) :: face
      type(mesh_t), intent(in) :: mesh
      !> Its slot
      integer, intent(out) :: i
      !> Error of code `error_internal`
      type(error_t), allocatable, intent(out) :: error

      integer :: j

      do i = 1, slots
         if (.not. allocated(self%slot(i)%kernel)) cycle
         if (self%slot(i)%kernel%is_for(face, mesh)) return
      end do
      call make_room(self)
      i = self%newest
      j = place(self, mesh)
      if (self%spectrum(j)%moduli%steps /= mesh%steps) self%newest_spectrum = j
      allocate (self%slot(i)%kernel)
      call new_kernel(self%slot(i)%kernel, face, mesh, self%spectrum(j), error)
   end subroutine find

   !> Place of the spectrum for a mesh: that with as many steps, or the oldest
   pure function place(self, mesh) result(i)
      type(store_t), intent(in) :: self
      type(mesh_t), intent(in) :: mesh
      integer :: i

      do i = 1, size(self%spectrum)
         if (self%spectrum(i)%moduli%steps == mesh%steps) return
      end do
      i = 1 + modulo(self%newest_spectrum, size(self%spectrum))
   end function place

   !> Make room for a kernel: delete the oldest
   pure subroutine make_room(self)
      type(store_t), intent(inout) :: self

      integer :: total, i, oldest

      total = 0
      do i = 1, slots
         if (allocated(self%slot(i)%kernel)) total = total + self%slot(i)%kernel%numbers()
      end do
      self%newest = 1 + modulo(self%newest, slots)
      do i = 0, slots - 1
         oldest = 1 + modulo(self%newest + i - 1, slots)
         if (.not. allocated(self%slot(oldest)%kernel)) cycle
         if (i > 0 .and. total <= most_numbers) exit
         total = total - self%slot(oldest)%kernel%numbers()
         deallocate (self%slot(oldest)%kernel)
      end do
   end subroutine make_room

end module vcor_solver_coupled_store
