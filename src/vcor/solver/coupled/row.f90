!> The row of springs under the contact, |x| <= a, on which the Abel transform q(x) of the pressure
!> is sampled, and the hats, piecewise linear functions, on which the smooth part of the response
!> acts
!>
!> The springs stand at the two Gauss points of equal parts of the elements of the hats: products of
!> hats are then integrated exactly by the springs, and the response stays passive. With equidistant
!> springs it does not, and short steps are unstable. The elements are graded towards the axis,
!> where the waves of the response are cylindrical.
module vcor_solver_coupled_row
   use vcor_error, only : error_internal, error_t, raise
   use vcor_kinds, only : wp
   use vcor_numeric_lapack, only : dgesv
   implicit none
   private

   public :: row_t, new_row, transforms

   !> Springs and hats of one radius
   type :: row_t
      !> Number of hats
      integer :: hats = 0
      !> Number of springs
      integer :: springs = 0
      !> Nodes of the hats [m], x_1 = 0 .. x_hats = a
      real(wp), allocatable :: node(:)
      !> Places of the springs [m], increasing
      real(wp), allocatable :: x(:)
      !> Weights of the springs in integrals from -a to a [m]
      real(wp), allocatable :: weight(:)
      !> Left one of the two hats that are not 0 at a spring, and the value of the right one; the
      !> left one has the rest of 1
      integer, allocatable :: hat(:)
      real(wp), allocatable :: right(:)
      !> Springs of an element of the hats, all equal
      integer, private :: of_element = 0
   contains
      procedure :: spread_hats
      procedure :: gather
   end type row_t

   !> Exponent of the grading of the nodes: with 1.25 and 2 results of 40 random impacts change by
   !> up to 6e-4 and 3e-3, 3 and 6 stated errors
   real(wp), parameter :: grading = 1.5_wp

contains

   !> Build the row
   pure subroutine new_row(self, radius, hats, springs)
      type(row_t), intent(out) :: self
      !> Radius a [m], > 0
      real(wp), intent(in) :: radius
      !> Number of hats, > 1
      integer, intent(in) :: hats
      !> Least number of springs
      integer, intent(in) :: springs

      real(wp), parameter :: gauss = 0.28867513459481288225457439025098_wp
      real(wp) :: length
      integer :: element, part, parts, i

      self%hats = hats
      self%node = radius*[(real(i, wp)/real(hats - 1, wp), i=0, hats - 1)]**grading
      parts = max(1, ceiling(real(springs, wp)/real(2*(hats - 1), wp)))
      self%springs = 2*(hats - 1)*parts
      allocate (self%x(self%springs), self%weight(self%springs), self%hat(self%springs))
      allocate (self%right(self%springs))
      self%of_element = 2*parts
      i = 0
      do element = 1, hats - 1
         length = (self%node(element + 1) - self%node(element))/real(parts, wp)
         do part = 1, parts
            self%x(i + 1:i + 2) = self%node(element) &
               + length*(real(part, wp) - 0.5_wp + [-gauss, gauss])
            ! half of the part for each point, on both sides of the axis
            self%weight(i + 1:i + 2) = length
            self%hat(i + 1:i + 2) = element
            self%right(i + 1:i + 2) = (self%x(i + 1:i + 2) - self%node(element)) &
               /(self%node(element + 1) - self%node(element))
            i = i + 2
         end do
      end do
   end subroutine new_row

   !> Add a function on the hats to one on the springs
   pure subroutine spread_hats(self, hats, springs)
      class(row_t), intent(in) :: self
      !> Values at the nodes of the hats
      real(wp), intent(in) :: hats(:)
      !> Values at the springs
      real(wp), contiguous, intent(inout) :: springs(:)

      integer :: element, first, last

      last = 0
      do element = 1, self%hats - 1
         first = last + 1
         last = last + self%of_element
         springs(first:last) = springs(first:last) + (hats(element) &
            + (hats(element + 1) - hats(element))*self%right(first:last))
      end do
   end subroutine spread_hats

   !> Integrals of the hats times a function on the springs
   pure subroutine gather(self, springs, hats)
      class(row_t), intent(in) :: self
      !> Values at the first springs; 0 at the rest
      real(wp), intent(in) :: springs(:)
      !> Integrals
      real(wp), intent(out) :: hats(:)

      real(wp) :: total, right
      integer :: element, first, last, i

      hats = 0.0_wp
      do element = 1, self%hats - 1
         first = self%of_element*(element - 1) + 1
         last = min(first + self%of_element - 1, size(springs))
         if (last < first) exit
         total = 0.0_wp
         right = 0.0_wp
         do i = first, last
            total = total + springs(i)
            right = right + self%right(i)*springs(i)
         end do
         ! the weights of an element are equal
         hats(element) = hats(element) + self%weight(first)*(total - right)
         hats(element + 1) = self%weight(first)*right
      end do
   end subroutine gather

   !> Cosine transforms of the functions dual to the hats, M^-1 int hat cos(kx) dx over (-a, a) with
   !> the matrix M of products of the hats
   subroutine transforms(node, k, dual, error)
      !> Nodes of the hats [m], shape (hats)
      real(wp), intent(in) :: node(:)
      !> Wavenumbers [1/m]
      real(wp), intent(in) :: k(:)
      !> Transforms, shape (hats, size(k))
      real(wp), intent(out) :: dual(:, :)
      !> Error of code `error_internal`
      type(error_t), allocatable, intent(out) :: error

      ! below, the integrals over an element by their series, which err by z^6/5040 = 3e-12; the
      ! closed form loses digits as z^-2
      real(wp), parameter :: small = 0.05_wp
      real(wp), dimension(size(node), size(node)) :: products, inverse
      real(wp) :: third, half, z, even, odd
      complex(wp) :: turn, wave
      integer :: element, i, info, pivots(size(node))

      products = 0.0_wp
      inverse = 0.0_wp
      do element = 1, size(node) - 1
         third = (node(element + 1) - node(element))/3.0_wp
         products(element, element) = products(element, element) + 2.0_wp*third
         products(element + 1, element + 1) = 2.0_wp*third
         products(element, element + 1) = third
         products(element + 1, element) = third
      end do
      do i = 1, size(node)
         inverse(i, i) = 1.0_wp
      end do
      call dgesv(size(node), size(node), products, size(node), pivots, inverse, size(node), info)
      if (info /= 0) then
         call raise(error, error_internal, 'the hats of the contact are dependent')
         return
      end if
      dual = 0.0_wp
      do i = 1, size(k)
         wave = 1.0_wp
         do element = 1, size(node) - 1
            half = 0.5_wp*(node(element + 1) - node(element))
            z = k(i)*half
            ! exp(i k x), from node to middle to node
            turn = cmplx(cos(z), sin(z), wp)
            wave = wave*turn
            ! means of cos(z t) and of t sin(z t) over -1 < t < 1
            if (z < small) then
               even = 1.0_wp - z**2/6.0_wp*(1.0_wp - z**2/20.0_wp)
               odd = z/3.0_wp*(1.0_wp - z**2/10.0_wp*(1.0_wp - z**2/28.0_wp))
            else
               even = aimag(turn)/z
               odd = (even - real(turn, wp))/z
            end if
            even = 2.0_wp*half*even*real(wave, wp)
            odd = -2.0_wp*half*odd*aimag(wave)
            wave = wave*turn
            dual(element, i) = dual(element, i) + even - odd
            dual(element + 1, i) = dual(element + 1, i) + even + odd
         end do
      end do
      dual = matmul(inverse, dual)
   end subroutine transforms

end module vcor_solver_coupled_row
