!> Contact law of a body that does not indent a half space as a power: a ratio to this power as a
!> function of the contact radius that the body has on a half space
!>
!> With the law s^n of a half space, its contact radius b(s) = K n s^(n-1)/2, a length, the unit of
!> the table, and x = b/length, the law is
!>
!>     u = s^n f(x),   du/ds = s^(n-1) (n f + (n - 1) x f'(x)),   a = length x g(x)
!>
!> in which f and g are smooth and 1 at x = 0. A flat punch has one x.
module vcor_impact_law_table
   use vcor_kinds, only : wp
   use vcor_numeric_chebyshev, only : coefficients_of, polynomial
   implicit none
   private

   public :: law_table_t, new_law_table, degree, widest_panel

   !> Degree of the polynomials of a panel, and its largest width in units of the length: f and g
   !> are analytic within a distance of about 1, so that the error is (1/32)^9
   integer, parameter :: degree = 8
   real(wp), parameter :: widest_panel = 0.125_wp

   !> The table
   type :: law_table_t
      !> Largest x of the table; beyond, u continues as the power of s that it is there
      real(wp) :: reach = 0.0_wp
      !> Number of panels per unit of x [-]
      real(wp), private :: density = 0.0_wp
      !> Coefficients of f for each panel in powers of its coordinate, -1 .. 1, shape
      !> (0:degree, 0:panels - 1)
      real(wp), allocatable, private :: f(:, :)
      !> The same of g
      real(wp), allocatable, private :: g(:, :)
   contains
      procedure, non_overridable :: stiffening
      procedure, non_overridable :: widening
   end type law_table_t

contains

   !> Build the table from values of f and g
   pure subroutine new_law_table(self, reach, f, g)
      type(law_table_t), intent(out) :: self
      !> Largest x, > 0
      real(wp), intent(in) :: reach
      !> Values of f at the Chebyshev points of equal panels, shape (degree + 1, panels)
      real(wp), intent(in) :: f(:, :)
      !> Values of g there
      real(wp), intent(in) :: g(:, :)

      real(wp) :: matrix(0:degree, degree + 1)
      integer :: panels

      panels = size(f, 2)
      self%reach = reach
      self%density = real(panels, wp)/reach
      matrix = coefficients_of(degree + 1)
      allocate (self%f(0:degree, 0:panels - 1), self%g(0:degree, 0:panels - 1))
      self%f = matmul(matrix, f)
      self%g = matmul(matrix, g)
   end subroutine new_law_table

   !> f and x f' at a given x
   pure subroutine stiffening(self, x, f, rise)
      class(law_table_t), intent(in) :: self
      !> Contact radius on a half space divided by the length [-], >= 0
      real(wp), intent(in) :: x
      !> f [-]
      real(wp), intent(out) :: f
      !> x f'(x) [-]
      real(wp), intent(out) :: rise

      real(wp) :: t, slope, inside, beyond
      integer :: i, k

      inside = self%density*min(x, self%reach)
      i = min(int(inside), size(self%f, 2) - 1)
      t = 2.0_wp*inside - real(2*i + 1, wp)
      f = self%f(degree, i)
      slope = 0.0_wp
      do k = degree - 1, 0, -1
         slope = f + t*slope
         f = self%f(k, i) + t*f
      end do
      rise = 2.0_wp*inside*slope
      if (.not. x > self%reach) return
      beyond = (x/self%reach)**(rise/f)
      f = f*beyond
      rise = rise*beyond
   end subroutine stiffening

   !> g at a given x, beyond the table that at its end
   pure function widening(self, x) result(g)
      class(law_table_t), intent(in) :: self
      !> Contact radius on a half space divided by the length [-], >= 0
      real(wp), intent(in) :: x
      !> g [-]
      real(wp) :: g

      real(wp) :: inside
      integer :: i

      inside = self%density*min(x, self%reach)
      i = min(int(inside), size(self%g, 2) - 1)
      g = polynomial(self%g(:, i), 2.0_wp*inside - real(2*i + 1, wp))
   end function widening

end module vcor_impact_law_table
