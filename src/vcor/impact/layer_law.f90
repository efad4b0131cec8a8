!> Static law of a layer on a rigid base, and that of the true sphere, as tables
!>
!> A body of profile h(x) (`contact_law_t%profile`) that presses a layer with a contact of radius a
!> has the pressure p = (E'/pi) int k J0(kr) int_0^a psi(x) cos kx dx dk, with
!>
!>     psi(x) + share int_-a^a K(x - t) psi(t) dt = s - h(x),   psi(a) = 0,   F = 2 E' int_0^a psi
!>
!> and the kernel K of `vcor_impact_layer_kernel` (I. I. Vorovich, Yu. A. Ustinov, J. Appl. Math.
!> Mech. 23 (1959) 637; `share` is that of the layer in the compliance of both bodies). With the
!> solutions chi for the right side 1 and eta for h it is
!>
!>     s = eta(a)/chi(a),   S = int_0^a chi,   F = 2 E' (s S - int_0^a eta),   dF/ds = 2 E' S
!>
!> On Gauss nodes of fixed panels the matrix I + sqrt(w) K sqrt(w) is symmetric and positive, and
!> that of a smaller a is a leading part of it: one Cholesky factor L serves all a. With
!> y = L^-1 sqrt(w) and z = L^-1 sqrt(w) h it is S = y.y, int eta = y.z, and the row of K at x = a,
!> v = L^-1 row, gives chi(a) = 1 - v.y and eta(a) = h(a) - v.z. Nodes between the last panel and a
!> border the factor.
!>
!> Lengths are in units of the thickness, for a true sphere that is smaller in units of its radius;
!> indentations in units in which h(x) = x^p, or that of a sphere x^2 for small x.
module vcor_impact_layer_law
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_law_table, only : degree, law_table_t, new_law_table, widest_panel
   use vcor_impact_layer_kernel, only : layer_kernel_t, new_layer_kernel
   use vcor_impact_response, only : base_half_space
   use vcor_kinds, only : wp
   use vcor_numeric_chebyshev, only : chebyshev_points, coefficients_of, polynomial, &
      polynomial_slope
   use vcor_numeric_lapack, only : dpotrf, dtrtrs
   use vcor_numeric_quadrature, only : gauss_nodes
   implicit none
   private

   public :: profile_t, layer_t, lay

   !> Largest contact radius of a table, in units of the thickness of a layer and of the radius of a
   !> true sphere, which is then deeper than its radius in a half space
   real(wp), parameter :: widest = 20.0_wp, deepest = 0.85_wp

   !> Shape of the body
   type :: profile_t
      !> p of h(x) = x^p [-]; 0: a flat punch
      real(wp) :: power = 2.0_wp
      !> Radius of a true sphere, p = 2 [m], or in the unit of the table; 0: none
      real(wp) :: radius = 0.0_wp
   contains
      procedure :: height
      procedure :: steepness
      procedure :: area
   end type profile_t

   !> What the body presses
   type :: layer_t
      !> One of the `base_*` constants: a half space, bonded or sliding
      integer :: base = base_half_space
      !> Poisson's ratio [-]
      real(wp) :: poisson_ratio = 0.5_wp
      !> Its share in the compliance of the contact [-], in [0, 1]
      real(wp) :: share = 1.0_wp
      !> Thickness [m], or in the unit of the table; not used for a half space
      real(wp) :: thickness = 1.0_wp
   end type layer_t

   !> Nodes of the first panel, on which x is a cube, so that powers are smooth, and of all others,
   !> which are one unit wide
   integer, parameter :: first_nodes = 24, nodes = 8
   !> Ends of panels of the contact radius on which the law is a polynomial, and its number of
   !> points: next to a = 0 the singularities are at a distance of 1, elsewhere of more than a
   real(wp), parameter :: edges(*) = [0.5_wp, 1.0_wp, 2.0_wp, 4.0_wp, 8.0_wp, 16.0_wp]
   integer, parameter :: points = 16

   !> Discretised equation for all contact radii up to the largest one
   type :: equation_t
      type(layer_t) :: layer
      type(profile_t) :: profile
      type(layer_kernel_t) :: kernel
      !> Nodes and the roots of their weights, shape (n)
      real(wp), allocatable :: x(:), root(:)
      !> Cholesky factor, lower triangle, shape (n, n)
      real(wp), allocatable :: factor(:, :)
      !> L^-1 sqrt(w) and L^-1 sqrt(w) h, shape (n, 2)
      real(wp), allocatable :: known(:, :)
      !> Gauss rules of the first panel and the others on (0, 1)
      real(wp) :: first_node(first_nodes) = 0.0_wp, first_weight(first_nodes) = 0.0_wp
      real(wp) :: node(nodes) = 0.0_wp, weight(nodes) = 0.0_wp
   contains
      procedure :: build
      procedure :: nodes_between
      procedure :: coupling
      procedure :: press
   end type equation_t

contains

   !> Height h(x)
   pure function height(self, x) result(h)
      class(profile_t), intent(in) :: self
      !> Distance from the axis [-], >= 0
      real(wp), intent(in) :: x
      !> h [-]
      real(wp) :: h

      if (self%radius > 0.0_wp) then
         h = self%radius*x*atanh(x/self%radius)
      else if (self%power > 0.0_wp) then
         h = x**self%power
      else
         h = 0.0_wp
      end if
   end function height

   !> Slope divided by height, x h'(x)/h(x)
   pure function steepness(self, x) result(slope)
      class(profile_t), intent(in) :: self
      !> Distance from the axis [-], > 0
      real(wp), intent(in) :: x
      !> Slope in the logarithms [-]
      real(wp) :: slope

      slope = self%power
      if (self%radius > 0.0_wp) slope = 1.0_wp &
         + x/(self%radius*(1.0_wp - (x/self%radius)**2)*atanh(x/self%radius))
   end function steepness

   !> x h - int_0^x h dx, half the force on a half space over E'
   pure function area(self, x, node, weight)
      class(profile_t), intent(in) :: self
      !> Distance from the axis [-], >= 0
      real(wp), intent(in) :: x
      !> Gauss' rule on (0, 1), shape (n)
      real(wp), intent(in) :: node(:), weight(:)
      !> Area [-]
      real(wp) :: area

      integer :: i

      if (self%radius > 0.0_wp) then
         area = x*(self%height(x) - sum([(weight(i)*self%height(x*node(i)), i=1, size(node))]))
      else
         area = self%power/(self%power + 1.0_wp)*x**(self%power + 1.0_wp)
      end if
   end function area

   !> Give a contact law the table of a body on a layer, or of a true sphere on a half space; other
   !> bodies on a half space need none. Tables are kept as long as they hold
   subroutine lay(law, layer, profile, factor, error, deepest_needed)
      !> Law of the body's power
      type(contact_law_t), intent(inout) :: law
      !> The layer, in m
      type(layer_t), intent(in) :: layer
      !> The body, in m
      type(profile_t), intent(in) :: profile
      !> Factor K of the shape [m^(2-n)]
      real(wp), intent(in) :: factor
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Indentation up to which the law will be asked for [m], since the time that a table takes
      !> grows with it; absent, huge or of a true sphere: as far as tables reach
      real(wp), intent(in), optional :: deepest_needed

      type(layer_t) :: unit_layer
      type(profile_t) :: unit_profile
      type(law_table_t) :: table
      real(wp) :: length, about(6)
      real(wp), allocatable :: ends(:)
      integer :: level

      unit_layer = layer
      unit_profile = profile
      if (layer%base == base_half_space) then
         if (.not. profile%radius > 0.0_wp) return
         length = profile%radius
         unit_layer = layer_t()
      else
         length = layer%thickness
         if (profile%radius > 0.0_wp) length = min(length, profile%radius)
         unit_layer%thickness = layer%thickness/length
      end if
      unit_profile%radius = profile%radius/length
      about = [real(unit_layer%base, wp), unit_layer%poisson_ratio, unit_layer%share, &
         unit_layer%thickness, unit_profile%power, unit_profile%radius]
      ends = panels_to(unit_layer, unit_profile)
      level = size(ends)
      if (present(deepest_needed)) then
         ! the contact is wider than on a half space
         if (deepest_needed < huge(1.0_wp) .and. .not. profile%radius > 0.0_wp) level = min(level, &
            1 + count(ends < law%half_space_radius(factor, deepest_needed)/length))
      end if
      do
         if (.not. law%has(about, level)) then
            call tabulate(table, unit_layer, unit_profile, ends(:level), error)
            if (allocated(error)) return
            call law%adopt(table, about, level, size(ends))
         end if
         call law%resize(level, factor, length, profile%radius)
         if (level == size(ends)) exit
         if (law%deepest() >= deepest_needed) exit
         level = level + 1
      end do
   end subroutine lay

   !> Ends of the panels of the contact radius on which the law is a polynomial, from the second one
   pure function panels_to(layer, profile) result(ends)
      !> Layer and body in units of the table
      type(layer_t), intent(in) :: layer
      type(profile_t), intent(in) :: profile
      !> Ends [-], shape (panels)
      real(wp), allocatable :: ends(:)

      real(wp) :: largest

      largest = widest*layer%thickness
      if (layer%base == base_half_space) largest = huge(1.0_wp)
      if (profile%radius > 0.0_wp) largest = min(largest, deepest*profile%radius)
      ends = [pack(edges, edges < largest), largest]
   end function panels_to

   !> Tabulate the law: f is the ratio of the force to that on a half space at the same indentation,
   !> where the contact radius is x = s^(1/p), and g the contact radius divided by x
   subroutine tabulate(table, layer, profile, ends, error)
      type(law_table_t), intent(out) :: table
      type(layer_t), intent(in) :: layer
      type(profile_t), intent(in) :: profile
      !> Ends of the panels of the contact radius [-], shape (m)
      real(wp), intent(in) :: ends(:)
      type(error_t), allocatable, intent(out) :: error

      type(equation_t) :: equation
      real(wp) :: point(points), matrix(points, points), value(points, 2), start, a
      real(wp), allocatable :: piece(:, :, :)
      integer :: i, j

      equation%layer = layer
      equation%profile = profile
      call equation%build(ends(size(ends)), error)
      if (allocated(error)) return
      point = chebyshev_points(points)
      matrix = coefficients_of(points)
      allocate (piece(points, 2, size(ends)))
      start = 0.0_wp
      do i = 1, size(ends)
         do j = 1, points
            a = start + 0.5_wp*(ends(i) - start)*(1.0_wp + point(j))
            call equation%press(a, value(j, 1), value(j, 2), error)
            if (allocated(error)) return
         end do
         piece(:, :, i) = matmul(matrix, value)
         start = ends(i)
      end do
      call resample(table, equation, [0.0_wp, ends], piece)
   end subroutine tabulate

   !> Resample the law from equal parts of the contact radius to those of the indentation
   subroutine resample(table, equation, ends, piece)
      type(law_table_t), intent(out) :: table
      type(equation_t), intent(in) :: equation
      !> Ends of the panels of the contact radius, shape (0:m)
      real(wp), intent(in) :: ends(0:)
      !> Coefficients of indentation and force, in units of those of a half space with the same
      !> contact radius, shape (points, 2, m)
      real(wp), intent(in) :: piece(:, :, :)

      real(wp), allocatable :: f(:, :), g(:, :)
      real(wp) :: point(degree + 1), x, a, at_end, ratio, force, power
      integer :: panels, i, j, k

      power = equation%profile%power
      a = ends(size(piece, 3))
      at_end = a
      if (power > 0.0_wp) at_end = (equation%profile%height(a) &
         *sum(piece(:, 1, size(piece, 3))))**(1.0_wp/power)
      panels = ceiling(at_end/widest_panel)
      allocate (f(degree + 1, panels), g(degree + 1, panels))
      point = chebyshev_points(degree + 1)
      a = 0.0_wp
      k = 1
      do i = 1, panels
         do j = 1, degree + 1
            x = at_end/real(panels, wp)*(real(i, wp) - 0.5_wp + 0.5_wp*point(j))
            call find_radius(x, max(a, 0.5_wp*x))
            f(j, i) = force
            if (power > 0.0_wp) f(j, i) = force*equation%profile%area(a, equation%first_node, &
               equation%first_weight)/(power/(power + 1.0_wp)*x**(power + 1.0_wp))
            g(j, i) = a/x
         end do
      end do
      call new_law_table(table, at_end, f, g)

   contains

      !> Contact radius for which the half space has the radius x at the same indentation, by
      !> Newton's method for the logarithms
      subroutine find_radius(wanted, guess)
         !> x [-]
         real(wp), intent(in) :: wanted
         !> Guess of the contact radius [-], > 0
         real(wp), intent(in) :: guess

         real(wp) :: t, half, change
         integer :: iteration

         a = guess
         if (.not. power > 0.0_wp) a = wanted
         do iteration = 1, 50
            a = min(a, ends(ubound(ends, 1)))
            k = max(1, count(ends < a))
            half = 0.5_wp*(ends(k) - ends(k - 1))
            t = (a - ends(k - 1))/half - 1.0_wp
            ratio = polynomial(piece(:, 1, k), t)
            force = polynomial(piece(:, 2, k), t)
            if (.not. power > 0.0_wp) return
            change = (log(equation%profile%height(a)*ratio) - power*log(wanted)) &
               /(equation%profile%steepness(a) &
               + a/half*polynomial_slope(piece(:, 1, k), t)/ratio)
            a = a*exp(-change)
            if (abs(change) <= 4.0_wp*epsilon(a)) exit
         end do
      end subroutine find_radius
   end subroutine resample

   !> Build nodes, factor and known solutions
   subroutine build(self, largest, error)
      !> The equation; layer and profile are set
      class(equation_t), intent(inout) :: self
      !> Largest contact radius [-]
      real(wp), intent(in) :: largest
      type(error_t), allocatable, intent(out) :: error

      integer :: panels, n, i, info

      call gauss_nodes(self%first_node, self%first_weight)
      call gauss_nodes(self%node, self%weight)
      if (self%layer%base /= base_half_space) call new_layer_kernel(self%kernel, self%layer%base, &
         self%layer%poisson_ratio, 2.0_wp*largest/self%layer%thickness)
      panels = int(largest)
      allocate (self%x(0), self%root(0))
      do i = 1, panels
         call self%nodes_between(real(i - 1, wp), real(i, wp), self%x, self%root)
      end do
      n = size(self%x)
      allocate (self%factor(n, n), self%known(n, 2))
      do i = 1, n
         self%factor(i:, i) = self%coupling(self%x(i:), self%root(i:), self%x(i), self%root(i))
         self%factor(i, i) = self%factor(i, i) + 1.0_wp
      end do
      if (n == 0) return
      self%known(:, 1) = self%root
      self%known(:, 2) = [(self%root(i)*self%profile%height(self%x(i)), i=1, n)]
      call dpotrf('L', n, self%factor, n, info)
      if (info == 0) call dtrtrs('L', 'N', 'N', n, 2, self%factor, n, self%known, n, info)
      if (info /= 0) call refuse(error)
   end subroutine build

   !> Raise the error that the equation has no solution
   pure subroutine refuse(error)
      type(error_t), allocatable, intent(out) :: error

      call raise(error, error_input, 'the law of this layer cannot be computed', &
         about='base poisson_ratio')
   end subroutine refuse

   !> Add the nodes of a panel; only the first one begins at 0
   pure subroutine nodes_between(self, from, to, x, root)
      class(equation_t), intent(in) :: self
      !> Start and end [-]
      real(wp), intent(in) :: from, to
      !> Nodes and the roots of their weights
      real(wp), allocatable, intent(inout) :: x(:), root(:)

      real(wp) :: width

      width = to - from
      if (from > 0.0_wp) then
         x = [x, from + width*self%node]
         root = [root, sqrt(width*self%weight)]
      else
         x = [x, width*self%first_node**3]
         root = [root, sqrt(3.0_wp*width*self%first_weight)*self%first_node]
      end if
   end subroutine nodes_between

   !> Kernel between nodes of even functions, times the roots of their weights
   pure function coupling(self, x, root, to, root_to) result(row)
      class(equation_t), intent(in) :: self
      !> Nodes and the roots of their weights, shape (n)
      real(wp), intent(in) :: x(:), root(:)
      !> Another node and the root of its weight
      real(wp), intent(in) :: to, root_to
      !> Row of the matrix
      real(wp) :: row(size(x))

      integer :: i

      row = 0.0_wp
      if (self%layer%base == base_half_space) return
      associate (unit => self%layer%thickness)
         do i = 1, size(x)
            row(i) = self%kernel%at(abs(x(i) - to)/unit) + self%kernel%at((x(i) + to)/unit)
         end do
         row = self%layer%share/unit*root_to*row*root
      end associate
   end function coupling

   !> Indentation and force at a contact radius, each in units of that of a half space at this
   !> radius; for a punch 1 and the force divided by that of a half space at this indentation
   subroutine press(self, a, indentation, force, error)
      class(equation_t), intent(in) :: self
      !> Contact radius [-], > 0
      real(wp), intent(in) :: a
      real(wp), intent(out) :: indentation, force
      type(error_t), allocatable, intent(out) :: error

      real(wp), allocatable :: x(:), root(:), border(:, :), corner(:, :), more(:, :), row(:)
      real(wp) :: s, edge(2), sums(2)
      integer :: n, m, i, info

      allocate (x(0), root(0))
      n = 0
      if (a > 1.0_wp) n = first_nodes + nodes*(ceiling(a) - 2)
      call self%nodes_between(real(ceiling(a) - 1, wp), a, x, root)
      ! the last row is that of the edge x = a, where the solution is wanted
      x = [x, a]
      root = [root, 1.0_wp]
      m = size(x) - 1
      allocate (border(n, m + 1), corner(m + 1, m + 1), more(m + 1, 2))
      do i = 1, m + 1
         border(:, i) = self%coupling(self%x(:n), self%root(:n), x(i), root(i))
         corner(i:, i) = self%coupling(x(i:), root(i:), x(i), root(i))
         if (i <= m) corner(i, i) = corner(i, i) + 1.0_wp
      end do
      more(:, 1) = root
      more(:, 2) = [(root(i)*self%profile%height(x(i)), i=1, m + 1)]
      sums = 0.0_wp
      info = 0
      if (n > 0) then
         call dtrtrs('L', 'N', 'N', n, m + 1, self%factor, size(self%factor, 1), border, n, info)
         do i = 1, m + 1
            corner(i:, i) = corner(i:, i) - matmul(border(:, i), border(:, i:))
         end do
         more = more - matmul(transpose(border), self%known(:n, :))
         sums = matmul(self%known(:n, 1), self%known(:n, :))
      end if
      if (info == 0) call dpotrf('L', m, corner, m + 1, info)
      edge = more(m + 1, :)
      if (info == 0) call dtrtrs('L', 'N', 'N', m, 2, corner, m + 1, more, m + 1, info)
      row = corner(m + 1, :m)
      if (info == 0) call dtrtrs('L', 'N', 'N', m, 1, corner, m + 1, row, m, info)
      if (info /= 0) then
         call refuse(error)
         return
      end if
      sums = sums + matmul(more(:m, 1), more(:m, :))
      edge = edge - matmul(row, more(:m, :))
      if (self%profile%power > 0.0_wp) then
         s = edge(2)/edge(1)
         indentation = s/self%profile%height(a)
         force = (s*sums(1) - sums(2)) &
            /self%profile%area(a, self%first_node, self%first_weight)
      else
         indentation = 1.0_wp
         force = sums(1)/a
      end if
   end subroutine press

end module vcor_impact_layer_law
