!> Kernel of the static contact with a layer of thickness 1,
!>
!>     K(u) = (1/pi) int_0^oo (L(k) - 1) cos(ku) dk
!>
!> as pieces of polynomials: L - 1 falls as k^2 exp(-2 k), so that K is analytic up to |Im u| = 2,
!> and for large u, where L ~ k at small k counts, it is smooth in the logarithm of u.
module vcor_impact_layer_kernel
   use vcor_impact_response, only : static_response
   use vcor_kinds, only : pi, wp
   use vcor_numeric_chebyshev, only : chebyshev_points, coefficients_of
   use vcor_numeric_quadrature, only : gauss_nodes
   implicit none
   private

   public :: layer_kernel_t, new_layer_kernel

   !> Number of coefficients of a panel. Its width is 1/2 up to u = 2, then a quarter of each
   !> octave: half of it is an eighth of the distance to the singularities, and the error (1/16)^12
   integer, parameter :: terms = 12

   !> The kernel
   type :: layer_kernel_t
      !> Coefficients of a panel in powers of its coordinate, -1 .. 1, shape (terms, 0:panels - 1)
      real(wp), allocatable, private :: coefficient(:, :)
   contains
      procedure, non_overridable :: at
   end type layer_kernel_t

contains

   !> Build the kernel
   pure subroutine new_layer_kernel(self, base, poisson_ratio, reach)
      type(layer_kernel_t), intent(out) :: self
      !> One of the `base_*` constants of a layer on a base
      integer, intent(in) :: base
      !> Poisson's ratio [-]
      real(wp), intent(in) :: poisson_ratio
      !> Largest u [-], > 0
      real(wp), intent(in) :: reach

      ! L - 1 is below rounding beyond this k; nodes of a panel, which resolve the cosine over a
      ! phase of 9
      real(wp), parameter :: last = 20.0_wp, phase = 9.0_wp
      integer, parameter :: order = 16
      real(wp) :: node(order), weight(order), point(terms), u(terms), value(terms)
      real(wp) :: matrix(terms, terms), start, width, step, k
      complex(wp) :: wave(terms), turn(terms)
      integer :: panels, parts, i, j, part

      call gauss_nodes(node, weight)
      point = chebyshev_points(terms)
      matrix = coefficients_of(terms)
      panels = panel_of(reach) + 1
      allocate (self%coefficient(terms, 0:panels - 1))
      do i = 0, panels - 1
         call place(i, start, width)
         u = start + 0.5_wp*width*(1.0_wp + point)
         parts = ceiling(last*max(1.0_wp, (start + width)/phase))
         step = last/real(parts, wp)
         value = 0.0_wp
         ! from one part to the next exp(i k u) turns by the same angle
         turn = exp(cmplx(0.0_wp, step*u, wp))
         do j = 1, order
            wave = exp(cmplx(0.0_wp, step*node(j)*u, wp))
            do part = 1, parts
               k = step*(real(part - 1, wp) + node(j))
               value = value + weight(j)*static_response(base, poisson_ratio, k)*real(wave, wp)
               wave = wave*turn
            end do
         end do
         self%coefficient(:, i) = matmul(matrix, value*(step/pi))
      end do
   end subroutine new_layer_kernel

   !> K(u)
   pure function at(self, u) result(value)
      class(layer_kernel_t), intent(in) :: self
      !> u [-], >= 0
      real(wp), intent(in) :: u
      !> K [-]
      real(wp) :: value

      real(wp) :: start, width, t
      integer :: i, k

      i = panel_of(u)
      call place(i, start, width)
      t = 2.0_wp*(u - start)/width - 1.0_wp
      value = self%coefficient(terms, i)
      do k = terms - 1, 1, -1
         value = self%coefficient(k, i) + t*value
      end do
   end function at

   !> Panel that contains u
   pure integer function panel_of(u) result(i)
      !> u [-], >= 0
      real(wp), intent(in) :: u

      i = int(2.0_wp*u)
      if (i >= 4) i = 4*exponent(u) - 8 + int(8.0_wp*fraction(u))
   end function panel_of

   !> Start and width of a panel
   pure subroutine place(i, start, width)
      !> Panel
      integer, intent(in) :: i
      real(wp), intent(out) :: start, width

      width = 0.5_wp
      start = 0.5_wp*real(i, wp)
      if (i < 4) return
      width = 0.25_wp*2.0_wp**(i/4)
      start = width*real(4 + modulo(i, 4), wp)
   end subroutine place

end module vcor_impact_layer_kernel
