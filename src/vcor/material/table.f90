!> Material given by points of its relaxation modulus, interpolated in logarithms, and a sum of
!> exponentials fitted to them
!>
!> With the rates on a grid, the moduli follow from non-negative least squares of the relative
!> misfit, and most of them are zero. A single relaxation time appears as two neighbours on the
!> grid, so the grid is refined around the rates in use as long as that reduces the misfit enough;
!> rates that are close together are merged at the end.
module vcor_material_table
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t, parts
   use vcor_material_type, only : material_t, parameter_t, poisson_ratio
   use vcor_numeric_quadrature, only : gauss_nodes
   use vcor_numeric_monotone, only : cubic, monotone_slopes, piece
   use vcor_numeric_nnls, only : solve_nnls
   use vcor_tuning, only : sum_samples, table_fastest, table_misfit, table_rates
   implicit none
   private

   public :: tabulated_t, new_tabulated, modulus_rounding, smallest_value, largest_value
   public :: table_parameters

   !> Parameters of model `table`, besides its points
   type(parameter_t), parameter :: table_parameters(*) = [poisson_ratio]

   !> Relative growth of the modulus between two points that counts as rounding: of files with ten
   !> digits
   real(wp), parameter :: modulus_rounding = 1.0e-10_wp
   !> Smallest time [s] and modulus [Pa]; outside these bounds products may over- or underflow
   real(wp), parameter :: smallest_value = 1.0e-30_wp
   !> Largest time [s] and modulus [Pa]
   real(wp), parameter :: largest_value = 1.0e30_wp

   !> Quadrature nodes per panel: E t changes by a factor of 50 at most, and the error is 1e-13
   integer, parameter :: order = 8
   !> Largest change of ln t, and of ln E, over a panel
   real(wp), parameter :: longest_panel = 1.0_wp

   !> E(t) through given points: with x = ln(t/t_1) and y = ln(E/E_1), y is a monotone piecewise
   !> cubic of x, exact for a power law; E is constant before the first point and after the last
   type, extends(material_t) :: tabulated_t
      private
      !> Time of the first point t_1 [s]
      real(wp) :: first_time = huge(1.0_wp)
      !> Modulus of the first point E_1 [Pa]
      real(wp) :: first_modulus = unset
      !> Ends of the panels: x at the points, and between points that are far apart, shape (n)
      real(wp), allocatable :: x(:)
      !> y at `x`, shape (n)
      real(wp), allocatable :: y(:)
      !> dy/dx at `x`, shape (n)
      real(wp), allocatable :: slope(:)
      !> Integral of E from 0 to `x`, in units of E_1 t_1, shape (n)
      real(wp), allocatable :: area(:)
      !> Nodes of the quadrature on (0, 1)
      real(wp) :: node(order) = 0.0_wp
      !> Weights of the quadrature
      real(wp) :: weight(order) = 0.0_wp
      !> Sum of exponentials fitted to the points
      type(exponential_sum_t) :: terms = exponential_sum_t(unset, null(), null())
      !> Integral from 0 to `x` of the sum less that of E, in units of E_1 t_1, shape (n)
      real(wp), allocatable :: excess(:)
   contains
      procedure :: relaxation
      procedure :: rate
      procedure :: integral
      procedure :: complex_modulus
      procedure :: glassy
      procedure :: rubbery
      procedure :: exponentials
      procedure :: rescale
   end type tabulated_t

contains

   !> Build a material from points of E(t)
   pure subroutine new_tabulated(self, times, moduli, error)
      type(tabulated_t), intent(out) :: self
      !> Times [s], > 0, strictly increasing, shape (n), n >= 2
      real(wp), intent(in) :: times(:)
      !> Moduli at these times [Pa], > 0, not increasing except by rounding, shape (n)
      real(wp), intent(in) :: moduli(:)
      type(error_t), allocatable, intent(out) :: error

      ! relative difference below which the logarithms of two times could not be told apart: these
      ! are at most 69, with a rounding error of 1.4e-14
      real(wp), parameter :: rounding = 1.0e-12_wp
      real(wp) :: falling(size(moduli))
      integer :: i, n

      n = size(times)
      if (n < 2 .or. size(moduli) /= n) then
         call raise(error, error_input, &
            'a table needs at least two points, and as many moduli as times')
      else if (.not. (all(times >= smallest_value) .and. all(times <= largest_value) &
          .and. all(moduli >= smallest_value) .and. all(moduli <= largest_value))) then
         call raise(error, error_input, &
            'the times and moduli of a table must be positive, between 1e-30 and 1e30')
      else if (.not. all(times(2:) > times(:n - 1)*(1.0_wp + rounding))) then
         call raise(error, error_input, 'the times of a table must increase strictly')
      else if (.not. all(moduli(2:) <= moduli(:n - 1)*(1.0_wp + modulus_rounding))) then
         call raise(error, error_input, 'the moduli of a table must not increase with time')
      end if
      if (allocated(error)) return

      self%first_time = times(1)
      self%first_modulus = moduli(1)
      falling = moduli
      do i = 2, n
         falling(i) = min(falling(i), falling(i - 1))
      end do
      call set_panels(self, log(times/times(1)), log(falling/moduli(1)))
      call set_terms(self)
      self%discrete = .true.
   end subroutine new_tabulated

   !> Divide the intervals between the points into panels, and integrate over each
   pure subroutine set_panels(self, x, y)
      type(tabulated_t), intent(inout) :: self
      !> x at the points, shape (n)
      real(wp), intent(in) :: x(:)
      !> y at the points, shape (n)
      real(wp), intent(in) :: y(:)

      real(wp) :: slope(size(x))
      integer :: parts(size(x) - 1), i, j, k, n

      n = size(x)
      slope = monotone_slopes(x, y)
      parts = ceiling(max(x(2:) - x(:n - 1), y(:n - 1) - y(2:))/longest_panel)
      n = 1 + sum(parts)
      allocate (self%x(n), self%y(n), self%slope(n), self%area(n))
      k = 0
      do i = 1, size(parts)
         do j = 0, parts(i) - 1
            k = k + 1
            self%x(k) = x(i) + (x(i + 1) - x(i))*real(j, wp)/real(parts(i), wp)
            call cubic(x(i), x(i + 1), y(i), y(i + 1), slope(i), slope(i + 1), self%x(k), &
               self%y(k), self%slope(k))
         end do
      end do
      self%x(n) = x(size(x))
      self%y(n) = y(size(x))
      self%slope(n) = slope(size(x))

      call gauss_nodes(self%node, self%weight)
      self%area(1) = 1.0_wp
      do k = 2, n
         self%area(k) = self%area(k - 1) + area_of(self, k - 1, self%x(k))
      end do
   end subroutine set_panels

   !> Fit the sum of exponentials
   pure subroutine set_terms(self)
      !> The material, its panels set
      type(tabulated_t), intent(inout) :: self

      real(wp), allocatable :: time(:)
      real(wp) :: step
      integer :: i, n

      if (.not. self%glassy() > self%rubbery()) then
         self%terms%equilibrium = self%first_modulus
         allocate (self%terms%moduli(0), self%terms%rates(0))
         return
      end if
      associate (length => self%x(size(self%x)))
         n = ceiling(length/log(10.0_wp)*table_rates*real(sum_samples, wp))
         step = length/real(n, wp)
      end associate
      time = self%first_time*exp([(real(i, wp)*step, i=0, n)])
      call fit_exponentials(time, self%relaxation(time), self%terms)
      self%excess = self%terms%integral(self%first_time*exp(self%x)) &
         /(self%first_modulus*self%first_time) - self%area
   end subroutine set_terms

   !> Multiply all times and all moduli without a new fit; only while the material is being built,
   !> before threads share it
   pure subroutine rescale(self, times_by, moduli_by)
      class(tabulated_t), intent(inout) :: self
      !> Factor of the times, > 0
      real(wp), intent(in) :: times_by
      !> Factor of the moduli, > 0
      real(wp), intent(in) :: moduli_by

      self%first_time = times_by*self%first_time
      self%first_modulus = moduli_by*self%first_modulus
      call self%terms%scale(moduli_by)
      self%terms%rates(:) = self%terms%rates/times_by
   end subroutine rescale

   !> y and its slope at x within the data
   elemental subroutine interpolate(self, x, y, slope)
      class(tabulated_t), intent(in) :: self
      !> ln(t/t_1)
      real(wp), intent(in) :: x
      !> ln(E/E_1)
      real(wp), intent(out) :: y
      !> d ln E/d ln t, <= 0
      real(wp), intent(out) :: slope

      integer :: i

      i = piece(self%x, x)
      call cubic(self%x(i), self%x(i + 1), self%y(i), self%y(i + 1), self%slope(i), &
         self%slope(i + 1), x, y, slope)
   end subroutine interpolate

   !> Integral of E, that is of exp(y + x), over a panel from its start to x, in units of E_1 t_1
   pure function area_of(self, panel, x) result(area)
      class(tabulated_t), intent(in) :: self
      integer, intent(in) :: panel
      !> Upper limit, within the panel
      real(wp), intent(in) :: x
      real(wp) :: area

      real(wp) :: at(order), y(order), slope(order)

      associate (start => self%x(panel))
         at = start + (x - start)*self%node
         call cubic(start, self%x(panel + 1), self%y(panel), self%y(panel + 1), &
            self%slope(panel), self%slope(panel + 1), at, y, slope)
         area = (x - start)*sum(self%weight*exp(y + at))
      end associate
   end function area_of

   !> Relaxation modulus E(t)
   elemental function relaxation(self, t) result(value)
      class(tabulated_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Modulus [Pa]
      real(wp) :: value

      real(wp) :: x, y, slope

      if (t <= self%first_time) then
         value = self%first_modulus
         return
      end if
      x = log(t/self%first_time)
      if (x < self%x(size(self%x))) then
         call interpolate(self, x, y, slope)
         value = self%first_modulus*exp(y)
      else
         value = self%rubbery()
      end if
   end function relaxation

   !> Rate of relaxation dE/dt = (E/t) d ln E/d ln t, 0 outside the data
   elemental function rate(self, t) result(value)
      class(tabulated_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Rate [Pa/s], <= 0
      real(wp) :: value

      real(wp) :: x, y, slope

      value = merge(0.0_wp, unset, allocated(self%x))
      if (t <= self%first_time) return
      x = log(t/self%first_time)
      if (.not. x < self%x(size(self%x))) return
      call interpolate(self, x, y, slope)
      value = self%first_modulus*exp(y)*slope/t
   end function rate

   !> Integral of E from 0 to t
   elemental function integral(self, t) result(value)
      class(tabulated_t), intent(in) :: self
      !> Upper limit [s], t >= 0
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: value

      real(wp) :: x
      integer :: i

      if (t <= self%first_time) then
         value = self%first_modulus*t
         return
      end if
      x = log(t/self%first_time)
      associate (last => size(self%x))
         if (x < self%x(last)) then
            i = piece(self%x, x)
            value = self%first_modulus*self%first_time*(self%area(i) + area_of(self, i, x))
         else
            value = self%first_modulus*self%first_time*self%area(last) &
               + self%rubbery()*(t - self%first_time*exp(self%x(last)))
         end if
      end associate
   end function integral

   !> Complex modulus of the sum of exponentials, E_0 + sum E_k s/(s + l_k)
   elemental function complex_modulus(self, s) result(modulus)
      class(tabulated_t), intent(in) :: self
      !> Laplace variable [1/s], not on the negative real axis
      complex(wp), intent(in) :: s
      !> Complex modulus [Pa]
      complex(wp) :: modulus

      modulus = self%terms%complex_modulus(s)
   end function complex_modulus

   !> Glassy modulus, that of the first point
   pure function glassy(self) result(modulus)
      class(tabulated_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = self%first_modulus
   end function glassy

   !> Rubbery modulus, that of the last point
   pure function rubbery(self) result(modulus)
      class(tabulated_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = self%first_modulus
      if (allocated(self%y)) modulus = modulus*exp(self%y(size(self%y)))
   end function rubbery

   !> The sum of exponentials fitted to the data
   pure subroutine exponentials(self, window, accuracy, terms)
      class(tabulated_t), intent(in) :: self
      !> Time up to which the sum is to hold [s]
      real(wp), intent(in) :: window
      !> Relative accuracy wanted: has no effect, as the sum represents all that the data contain
      real(wp), intent(in) :: accuracy
      !> The sum, with the error of its integral up to half the window, where the contact is
      !> expected to end; data may have steps, so it counts at all points, too
      type(exponential_sum_t), intent(out) :: terms

      integer :: i

      associate (not_needed => accuracy)
      end associate
      terms = self%terms
      if (size(terms%rates) == 0) return
      associate (end => 0.5_wp*window)
         call terms%compare(end, self%integral(end*parts))
         do i = 1, size(self%x)
            associate (t => self%first_time*exp(self%x(i)))
               if (t > end) exit
               terms%error = max(terms%error, self%first_modulus*self%first_time &
                  *abs(self%excess(i))/self%integral(max(t, end*parts(1))))
            end associate
         end do
      end associate
   end subroutine exponentials

   !> Fit E(t) = E_0 + sum E_k exp(-l_k t), E_0 and E_k >= 0
   pure subroutine fit_exponentials(time, modulus, terms)
      !> Times of the samples [s], increasing, > 0, about equally spaced in the logarithm, shape (m)
      real(wp), intent(in) :: time(:)
      !> Modulus at these times [Pa], > 0, not increasing, shape (m)
      real(wp), intent(in) :: modulus(:)
      !> The sum; `terms%error` is the largest relative misfit at the samples
      type(exponential_sum_t), intent(out) :: terms

      real(wp), allocatable :: grid(:), rate(:), weight(:), finer(:), better(:)
      real(wp) :: spacing, residual, misfit, new_residual, new_misfit, width
      integer :: i, n

      ! the variable is the logarithm of the rate
      associate (lower => log(1.0_wp/(table_fastest*time(size(time)))), &
                 upper => log(table_fastest/time(1)))
         n = 1 + ceiling((upper - lower)/log(10.0_wp)*table_rates)
         spacing = (upper - lower)/real(n - 1, wp)
         allocate (grid(n))
         grid = [(lower + real(i, wp)*spacing, i=0, n - 1)]
      end associate

      rate = grid
      call fit(time, modulus, rate, weight, residual, misfit)
      width = spacing
      do while (misfit > table_misfit .and. width**2 > table_misfit)
         width = 0.5_wp*width
         finer = refined(rate, width, grid)
         call fit(time, modulus, finer, better, new_residual, new_misfit, guess=rate)
         if (.not. new_residual*real(size(finer), wp)**3 &
            < residual*real(size(rate), wp)**3) exit
         call move_alloc(finer, rate)
         call move_alloc(better, weight)
         residual = new_residual
         misfit = new_misfit
      end do

      do while (width < 2.0_wp*spacing .and. size(rate) > 1)
         finer = merged(rate, weight(1:), 1.01_wp*width)
         width = 2.0_wp*width
         if (size(finer) == size(rate)) cycle
         call fit(time, modulus, finer, better, new_residual, new_misfit)
         if (new_misfit > table_misfit .and. new_residual*real(size(finer), wp)**3 &
            > residual*real(size(rate), wp)**3) exit
         call move_alloc(finer, rate)
         call move_alloc(better, weight)
         residual = new_residual
         misfit = new_misfit
      end do

      terms%equilibrium = modulus(1)*weight(0)
      allocate (terms%rates, source=exp(rate))
      allocate (terms%moduli, source=modulus(1)*weight(1:))
      terms%error = misfit
   end subroutine fit_exponentials

   !> Weights of given rates by non-negative least squares
   pure subroutine fit(time, modulus, rate, weight, residual, misfit, guess)
      !> Times [s], shape (m)
      real(wp), intent(in) :: time(:)
      !> Modulus [Pa], shape (m)
      real(wp), intent(in) :: modulus(:)
      !> Logarithms of rates; on return those with positive weight, increasing
      real(wp), allocatable, intent(inout) :: rate(:)
      !> Weights divided by the first modulus, that of the equilibrium modulus first, shape (0:n)
      real(wp), allocatable, intent(out) :: weight(:)
      !> Square root of the sum of squares of the relative misfits
      real(wp), intent(out) :: residual
      !> Largest relative misfit
      real(wp), intent(out) :: misfit
      !> Those of the given rates that are probably in use, increasing
      real(wp), intent(in), optional :: guess(:)

      real(wp) :: a(size(time), 0:size(rate)), x(0:size(rate)), ones(size(time))
      logical :: start(0:size(rate))
      integer :: j, k

      a(:, 0) = modulus(1)/modulus
      do j = 1, size(rate)
         a(:, j) = a(:, 0)*exp(-exp(rate(j))*time)
      end do
      ones = 1.0_wp
      start = .false.
      if (present(guess)) then
         start(0) = .true.
         k = 1
         do j = 1, size(rate)
            if (k > size(guess)) exit
            start(j) = .not. rate(j) < guess(k)
            if (start(j)) k = k + 1
         end do
      end if
      call solve_nnls(a, ones, x, start)

      ones = matmul(a, x) - 1.0_wp
      residual = norm2(ones)
      misfit = maxval(abs(ones))
      rate = pack(rate, x(1:) > 0.0_wp)
      allocate (weight(0:size(rate)))
      weight(0) = x(0)
      weight(1:) = pack(x(1:), x(1:) > 0.0_wp)
   end subroutine fit

   !> Rates in use, a neighbour on either side of each, and the grid
   pure function refined(rate, width, grid) result(finer)
      !> Logarithms of the rates in use, increasing, shape (n)
      real(wp), intent(in) :: rate(:)
      !> Distance of the neighbours in the logarithm
      real(wp), intent(in) :: width
      !> Logarithms of the rates of the first grid, increasing
      real(wp), intent(in) :: grid(:)
      !> Increasing logarithms of rates
      real(wp), allocatable :: finer(:)

      real(wp) :: all(3*size(rate) + size(grid))
      integer :: n

      all(:size(rate)) = rate
      n = size(rate)
      call insert([rate - width, rate + width, grid], grid(1), grid(size(grid)), 0.1_wp*width, &
         all, n)
      finer = all(:n)
   end function refined

   !> Insert numbers into an increasing list unless they are out of bounds or already there
   pure subroutine insert(numbers, lower, upper, same, list, n)
      real(wp), intent(in) :: numbers(:)
      !> Lower bound
      real(wp), intent(in) :: lower
      !> Upper bound
      real(wp), intent(in) :: upper
      !> Distance below which two numbers count as the same
      real(wp), intent(in) :: same
      !> The list, increasing, shape (>= n + size(numbers))
      real(wp), intent(inout) :: list(:)
      !> Length of the list
      integer, intent(inout) :: n

      integer :: i, place

      do i = 1, size(numbers)
         if (numbers(i) < lower - same .or. numbers(i) > upper + same) cycle
         if (any(abs(list(:n) - numbers(i)) < same)) cycle
         place = 1 + count(list(:n) < numbers(i))
         list(place + 1:n + 1) = list(place:n)
         list(place) = numbers(i)
         n = n + 1
      end do
   end subroutine insert

   !> Replace pairs of close neighbours by their weighted mean
   pure function merged(rate, weight, width) result(fewer)
      !> Logarithms of the rates, increasing, shape (n)
      real(wp), intent(in) :: rate(:)
      !> Their weights, > 0, shape (n)
      real(wp), intent(in) :: weight(:)
      !> Largest distance of close neighbours
      real(wp), intent(in) :: width
      !> Logarithms of rates, increasing
      real(wp), allocatable :: fewer(:)

      real(wp) :: all(size(rate))
      integer :: i, n

      n = 0
      i = 1
      do while (i <= size(rate))
         n = n + 1
         all(n) = rate(i)
         if (i < size(rate)) then
            if (rate(i + 1) - rate(i) <= width) then
               all(n) = (rate(i)*weight(i) + rate(i + 1)*weight(i + 1))/(weight(i) + weight(i + 1))
               i = i + 1
            end if
         end if
         i = i + 1
      end do
      fewer = all(:n)
   end function merged

end module vcor_material_table
