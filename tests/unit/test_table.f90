!> Material given by points: the interpolation, its integral, and the sum of exponentials fitted to
!> it
program test_table
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_material_cerf, only : cerf_t, new_cerf
   use vcor_material_power_law, only : new_power_law, power_law_t
   use vcor_material_prony, only : new_prony, prony_t
   use vcor_material_table, only : new_tabulated, tabulated_t
   use vcor_numeric_quadrature, only : gauss_nodes
   use vcor_numeric_monotone, only : cubic, monotone_slopes, piece
   use vcor_test, only : check, check_close, check_relative, finish, suite
   use vcor_test_cases, only : refused, random_t, success
   implicit none

   !> exp and ln of numbers up to 50, whose last digits count fifty times
   real(wp), parameter :: rounding = 3.0e-14_wp
   !> The integral's own quadrature, on panels where E t changes by a factor of 50 at most
   real(wp), parameter :: integral_tolerance = 1.0e-12_wp
   !> Five-point formula with steps of 1/500 t: h^4/30 times a fifth derivative of up to a thousand,
   !> and the cubics' third derivatives where one ends within the five
   real(wp), parameter :: slope_tolerance = 1.0e-6_wp

   !> BUTYL B252 as a Prony series, Eq. (26), and as CERF, Eq. (24)
   type(prony_t) :: prony
   type(cerf_t) :: cerf
   !> One relaxation time, and nothing left after it
   type(prony_t) :: maxwell
   !> Six decades of modulus in twenty of time
   type(power_law_t) :: wide

   call suite("table")
   call make_materials()
   call test_slopes()
   call test_points()
   call test_power_law()
   call test_smooth()
   call test_integral()
   call test_limits()
   call test_terms()
   call test_flat()
   call test_rough()
   call test_complex()
   call test_refusals()
   call finish()

contains

   !> Materials that points are taken from
   subroutine make_materials()
      type(error_t), allocatable :: error

      call new_prony(prony, 10.421e6_wp, [20.181e6_wp, 38.204e6_wp, 87.344e6_wp], &
         [972.0_wp, 6426.0_wp, 34221.0_wp], 0.0_wp, error)
      call success(error, "a Prony series is built")
      call new_cerf(cerf, 0.442e6_wp, 676.5e6_wp, 700.0_wp, error)
      call success(error, "a CERF material is built")
      call new_prony(maxwell, 0.0_wp, [1.0e6_wp], [1400.0_wp], 0.0_wp, error)
      call success(error, "a Maxwell fluid is built")
      call new_power_law(wide, 1.0e5_wp, 1.0e7_wp, 0.3_wp, error)
      call success(error, "a power law is built")
   end subroutine make_materials

   !> Slopes of the interpolation: exact for lines, monotone for any data, third order
   subroutine test_slopes()
      type(random_t) :: random
      real(wp) :: x(8), y(8), slope(8), at, before, value, dy, error(2)
      integer :: trial, i, n

      x = [0.0_wp, 0.1_wp, 0.5_wp, 2.0_wp, 2.1_wp, 3.0_wp, 7.0_wp, 7.5_wp]
      call check_close(monotone_slopes(x, 3.0_wp - 2.0_wp*x), -2.0_wp, rounding, &
         "slopes of a line are that of the line")
      call check_close(monotone_slopes(x(:2), [1.0_wp, 0.0_wp]), -10.0_wp, rounding, &
         "two points make a line")
      do trial = 1, 200
         x(1) = 0.0_wp
         y(1) = 1.0_wp
         do i = 2, size(x)
            x(i) = x(i - 1) + random%log_between(1.0e-6_wp, 1.0_wp)
            y(i) = y(i - 1) - max(0.0_wp, random%between(-1.0_wp, 1.0_wp))
         end do
         slope = monotone_slopes(x, y)
         before = y(1)
         do i = 0, 1000
            at = x(1) + (x(8) - x(1))*real(i, wp)*1.0e-3_wp
            n = piece(x, at)
            call cubic(x(n), x(n + 1), y(n), y(n + 1), slope(n), slope(n + 1), at, value, dy)
            if (.not. value <= before + rounding) exit
            before = value
         end do
         call check(i > 1000, "the interpolation of falling points falls")
      end do
      error = [largest_error(20), largest_error(40)]
      call check(error(1) > 7.0_wp*error(2), "half the distance, an eighth of the error")
   end subroutine test_slopes

   !> Largest error of the interpolation of exp(-x) on (0, 1)
   function largest_error(n) result(largest)
      !> Number of intervals
      integer, intent(in) :: n
      !> The error
      real(wp) :: largest

      real(wp) :: x(0:n), slope(0:n), at, value, dy
      integer :: i, j

      x = [(real(i, wp)/real(n, wp), i=0, n)]
      slope = monotone_slopes(x, exp(-x))
      largest = 0.0_wp
      do i = 1, 999
         at = 0.001_wp*real(i, wp)
         j = piece(x, at) - 1
         call cubic(x(j), x(j + 1), exp(-x(j)), exp(-x(j + 1)), slope(j), slope(j + 1), &
            at, value, dy)
         largest = max(largest, abs(value - exp(-at)))
      end do
   end function largest_error

   !> At the points the modulus is theirs
   subroutine test_points()
      type(tabulated_t) :: material
      type(error_t), allocatable :: error
      real(wp), parameter :: time(4) = [1.0e-6_wp, 1.5e-6_wp, 3.0e-3_wp, 1.0e4_wp]
      real(wp), parameter :: modulus(4) = [3.0e9_wp, 2.0e9_wp, 2.0e9_wp, 1.0e4_wp]

      call new_tabulated(material, time, modulus, error)
      call success(error, "a table is built")
      call check_relative(material%relaxation(time), modulus, rounding, "E at the points")
      call check_close(material%relaxation(1.0e-5_wp), 2.0e9_wp, 1.0e-5_wp, "flat between equals")
      call check_close(material%rate(1.0e-5_wp), 0.0_wp, 0.0_wp, "and at rest")
      call check_close(material%relaxation([0.0_wp, 0.5e-6_wp]), 3.0e9_wp, 0.0_wp, &
         "constant before the first point")
      call check_relative(material%relaxation(1.0e9_wp), 1.0e4_wp, rounding, &
         "constant after the last point")
   end subroutine test_points

   !> A power law is a line in the logarithms: two points make it, over any number of decades
   subroutine test_power_law()
      type(tabulated_t) :: material
      type(error_t), allocatable :: error
      type(exponential_sum_t) :: terms
      real(wp), parameter :: time(4) = [2.0e-6_wp, 1.0e-3_wp, 1.0_wp, 5.0e3_wp]
      real(wp), parameter :: a = 0.4_wp, first = 1.0e-6_wp, last = 1.0e4_wp
      real(wp) :: early
      integer :: i

      call new_tabulated(material, [first, last], 1.0e6_wp*[first, last]**(-a), error)
      call success(error, "two points are enough")
      call check_relative(material%relaxation(time), 1.0e6_wp*time**(-a), rounding, &
         "E = t^-a between them")
      call check_relative(material%rate(time), -a*1.0e6_wp*time**(-a - 1.0_wp), rounding, &
         "its rate")
      early = 1.0e6_wp*first**(1.0_wp - a)
      call check_relative(material%integral(time), early + 1.0e6_wp/(1.0_wp - a) &
         *(time**(1.0_wp - a) - first**(1.0_wp - a)), integral_tolerance, "its integral")
      call check_relative(material%integral(3.0_wp*last), early + 1.0e6_wp/(1.0_wp - a) &
         *(last**(1.0_wp - a) - first**(1.0_wp - a)) + 2.0e6_wp*last**(1.0_wp - a), &
         integral_tolerance, "its integral beyond the points")
      ! three rates to the decade: measured 1e-5
      call material%exponentials(2.0_wp*last, 1.0e-3_wp, terms)
      call check_relative([(terms%equilibrium + sum(terms%moduli*exp(-terms%rates*time(i))), &
         i=1, size(time))], 1.0e6_wp*time**(-a), 2.0e-5_wp, "a power law as a sum of exponentials")
      ! before the first point the table is constant and the sum is not: that counts as well
      call check(terms%error < 2.0e-5_wp + 4.0_wp*first*1.0e6_wp*first**(-a) &
         /material%integral(2.0_wp*last), "the error of the sum, with the time before the data")
      call check(size(terms%rates) <= 35, "with three terms to the decade")
   end subroutine test_power_law

   !> Smooth materials: the interpolation is of third order, and exact data of 25 points to the
   !> decade are good for the error that is measured here
   subroutine test_smooth()
      real(wp) :: coarse, fine

      call interpolation_error(25, cerf, coarse)
      call interpolation_error(50, cerf, fine)
      ! measured 7e-7
      call check(coarse < 1.0e-6_wp, "CERF from 25 points to the decade")
      call check(fine < 0.15_wp*coarse, "CERF: twice the points, an eighth of the error")
      ! a single relaxation time is steeper in the logarithm: measured 5e-5
      call interpolation_error(25, prony, coarse)
      call interpolation_error(50, prony, fine)
      call check(coarse < 1.0e-4_wp, "a Prony series from 25 points to the decade")
      call check(fine < 0.3_wp*coarse, "Prony: twice the points, less than a third of the error")
   end subroutine test_smooth

   !> The integral against a fine quadrature of the modulus, wherever it ends
   subroutine test_integral()
      integer, parameter :: order = 20, parts = 400
      type(tabulated_t) :: material
      type(error_t), allocatable :: error
      real(wp), allocatable :: time(:)
      real(wp) :: node(order), weight(order), expected, lower, upper, end
      integer :: i, j

      call gauss_nodes(node, weight)
      ! far points, which make more than one panel, and near ones
      time = [1.0e-6_wp, 1.3e-6_wp, 1.0e-3_wp, 1.1e-3_wp, 2.0e-3_wp, 5.0_wp]
      call new_tabulated(material, time, [1.0e9_wp, 0.9e9_wp, 2.0e8_wp, 1.0e7_wp, 1.0e7_wp, &
         1.0e3_wp], error)
      call success(error, "a table of far and near points is built")
      expected = 1.0e9_wp*time(1)
      lower = time(1)
      do i = 2, size(time)
         do j = 1, parts
            upper = time(i - 1)*(time(i)/time(i - 1))**(real(j, wp)/real(parts, wp))
            expected = expected + (upper - lower)*sum(weight*material%relaxation(lower &
               + (upper - lower)*node))
            lower = upper
            if (mod(j, 57) == 0 .or. j == parts) call check_relative(material%integral(upper), &
               expected, integral_tolerance, "the integral is that of E")
         end do
      end do
      call check_close(material%integral(0.0_wp), 0.0_wp, 0.0_wp, "no time, no integral")
      call check_relative(material%integral(1.0e-30_wp), 1.0e-21_wp, rounding, "a little time")
      do i = 1, 20
         end = 1.05e-6_wp*10.0_wp**(0.31_wp*real(i, wp))
         call check_relative((material%relaxation(end*0.996_wp) &
            - material%relaxation(end*1.004_wp) &
            + 8.0_wp*(material%relaxation(end*1.002_wp) - material%relaxation(end*0.998_wp))) &
            /(0.024_wp*end), material%rate(end), slope_tolerance, &
               "the rate is the derivative of E")
      end do
   end subroutine test_integral

   !> Glassy and rubbery modulus are those of the ends
   subroutine test_limits()
      type(tabulated_t) :: material
      type(error_t), allocatable :: error

      call new_tabulated(material, [1.0e-3_wp, 1.0_wp, 2.0_wp], [5.0e6_wp, 4.0e6_wp, 1.0e6_wp], &
         error)
      call check_relative(material%glassy(), 5.0e6_wp, rounding, "glassy modulus")
      call check_relative(material%rubbery(), 1.0e6_wp, rounding, "rubbery modulus")
      call check(.not. material%elastic(), "it relaxes")
      call check_close(material%rate([0.0_wp, 3.0_wp]), 0.0_wp, 0.0_wp, &
         "no rate outside of the points")
   end subroutine test_limits

   !> The sum of exponentials of smooth materials: few terms, misfits as measured
   subroutine test_terms()
      type(exponential_sum_t) :: terms

      ! the interpolation of 25 points to the decade is itself no better than 5e-5
      call terms_of(grid(-7.0_wp, 1.0_wp, 25), prony, 3.0e-5_wp, terms)
      call check(size(terms%rates) == 3, "three relaxation times are three terms")
      call check_close(sorted(terms%rates)/[972.0_wp, 6426.0_wp, 34221.0_wp], 1.0_wp, 2.0e-3_wp, &
         "with the rates of the series")
      call check_relative(terms%equilibrium, 10.421e6_wp, 1.0e-4_wp, "and its equilibrium modulus")
      call terms_of(grid(-7.0_wp, 1.0_wp, 1000), prony, 1.0e-6_wp, terms)
      call check(size(terms%rates) == 3, "from 1000 points to the decade, too")
      call check_close(sorted(terms%rates)/[972.0_wp, 6426.0_wp, 34221.0_wp], 1.0_wp, 1.0e-4_wp, &
         "with the rates of the series to four digits")
      call terms_of(grid(-7.0_wp, 1.0_wp, 25), cerf, 1.0e-6_wp, terms)
      call check(size(terms%rates) <= 60, "CERF over eight decades: six terms to the decade")
      call terms_of(grid(-10.0_wp, 10.0_wp, 10), wide, 5.0e-6_wp, terms)
      call check(size(terms%rates) <= 130, "twenty decades")
      ! from 1e6 Pa down to 1 Pa: the interpolation is that bad where E falls steeply
      call terms_of(grid(-6.0_wp, -2.0_wp, 25), maxwell, 6.0e-4_wp, terms)
      call check_relative(sum(terms%moduli), 1.0e6_wp, 3.0e-3_wp, "a Maxwell fluid to E/1e6")
   end subroutine test_terms

   !> What does not relax is elastic
   subroutine test_flat()
      type(tabulated_t) :: material
      type(error_t), allocatable :: error
      type(exponential_sum_t) :: terms

      call new_tabulated(material, [1.0e-3_wp, 1.0_wp, 2.0_wp], 3.0e6_wp*[1.0_wp, 1.0_wp, 1.0_wp], &
         error)
      call success(error, "a constant modulus is built")
      call check(material%elastic(), "it is elastic")
      call check_close(material%relaxation([0.0_wp, 0.1_wp, 1.5_wp, 9.0_wp]), 3.0e6_wp, 0.0_wp, &
         "everywhere the same")
      call material%exponentials(1.0_wp, 1.0e-3_wp, terms)
      call check(size(terms%rates) == 0, "it has no terms")
      call check_close(terms%equilibrium, 3.0e6_wp, 0.0_wp, "but an equilibrium modulus")
      call check_close(terms%error, 0.0_wp, 0.0_wp, "without error")
      call new_tabulated(material, [1.0_wp, 2.0_wp, 3.0_wp], &
         1.0_wp + [0.0_wp, 1.0e-14_wp, 0.0_wp], error)
      call success(error, "growth within rounding is none")
      call check(material%elastic(), "it is elastic, too")
      call new_tabulated(material, [1.0e-10_wp, 1.0_wp, 1.0e10_wp], &
         1.0_wp - [0.0_wp, 0.0_wp, 1.0e-14_wp], error)
      call material%exponentials(1.0_wp, 1.0e-3_wp, terms)
      call check(terms%error < 1.0e-13_wp, "a fall within rounding makes no trouble")
   end subroutine test_flat

   !> Data that no sum of exponentials follows: the misfit says so, and the sum stays one
   subroutine test_rough()
      type(tabulated_t) :: material
      type(error_t), allocatable :: error
      type(exponential_sum_t) :: terms
      real(wp), allocatable :: time(:), modulus(:)
      integer :: i

      ! eight steps, the last one from 0.23 to 0.1: half of that in the middle of the step
      allocate (time, source=grid(-5.0_wp, 1.0_wp, 10))
      allocate (modulus(size(time)))
      modulus = [(1.0e6_wp*(1.0_wp - 0.9_wp*real(i*8/size(time), wp)/7.0_wp), i=0, size(time) - 1)]
      call new_tabulated(material, time, modulus, error)
      call success(error, "a staircase is built")
      call sane(material, time(size(time)), terms, "staircase")
      call check(terms%error > 0.03_wp .and. terms%error < 0.3_wp, "a staircase is met in the mean")
      call new_tabulated(material, [1.0e-3_wp, 1.0_wp, 1.1_wp, 1.0e3_wp], &
         [1.0_wp, 0.9_wp, 1.0e-6_wp, 0.9e-6_wp], error)
      call success(error, "a cliff is built")
      call sane(material, 1.0e3_wp, terms, "cliff")
      call check(terms%error > 0.5_wp, "a cliff is not met")
      call new_tabulated(material, [1.0_wp, 1.01_wp], [1.0_wp, 0.5_wp], error)
      call success(error, "two near points are built")
      call sane(material, 1.01_wp, terms, "two near points")
      call new_tabulated(material, [1.0e-30_wp, 1.0e30_wp], [1.0e30_wp, 1.0e-30_wp], error)
      call success(error, "the widest table is built")
      call sane(material, 1.0e30_wp, terms, "the widest table")
      deallocate (time, modulus)
      allocate (time, source=grid(-6.0_wp, 2.0_wp, 1250))
      allocate (modulus(size(time)))
      modulus = [(1.0e6_wp - 9.0e3_wp*real(i/100, wp), i=0, size(time) - 1)]
      call new_tabulated(material, time, modulus, error)
      call success(error, "ten thousand points in steps are built")
      call sane(material, time(size(time)), terms, "ten thousand points")
   end subroutine test_rough

   !> The complex modulus is that of the sum
   subroutine test_complex()
      type(tabulated_t) :: material
      type(error_t), allocatable :: error
      complex(wp), parameter :: s = (0.0_wp, 5000.0_wp)

      associate (time => grid(-7.0_wp, 1.0_wp, 25))
         call new_tabulated(material, time, prony%relaxation(time), error)
      end associate
      ! the interpolation's error, about
      call check_close(abs(material%complex_modulus(s)/prony%complex_modulus(s) - 1.0_wp), 0.0_wp, &
         5.0e-5_wp, "complex modulus of a Prony series")
   end subroutine test_complex

   !> Points that make no material
   subroutine test_refusals()
      type(tabulated_t) :: material
      class(material_t), allocatable :: built
      type(material_data_t) :: data
      type(error_t), allocatable :: error

      call new_tabulated(material, [1.0_wp], [1.0_wp], error)
      call refused(error, "at least two")
      call new_tabulated(material, [1.0_wp, 2.0_wp], [1.0_wp], error)
      call refused(error, "as many")
      call new_tabulated(material, [0.0_wp, 2.0_wp], [2.0_wp, 1.0_wp], error)
      call refused(error, "positive")
      call new_tabulated(material, [1.0_wp, 2.0_wp], [2.0_wp, 0.0_wp], error)
      call refused(error, "positive")
      call new_tabulated(material, [1.0_wp, 2.0_wp], [1.0e31_wp, 1.0_wp], error)
      call refused(error, "1e30")
      call new_tabulated(material, [1.0_wp, 1.0_wp], [2.0_wp, 1.0_wp], error)
      call refused(error, "increase strictly")
      call new_tabulated(material, [1.0_wp, 2.0_wp], [1.0_wp, 1.1_wp], error)
      call refused(error, "must not increase")

      data%name = "rubber"
      data%model = "table"
      call data%set_list('times', [1.0_wp, 2.0_wp])
      call data%set_list('moduli', [2.0e6_wp, 1.0e6_wp])
      call new_material(built, data, error)
      call success(error, "a table is built by its name")
      call check_relative(built%glassy(), 2.0e6_wp, rounding, "with its points")
      call data%set_list('times', [2.0_wp, 1.0_wp])
      call new_material(built, data, error)
      call refused(error, "increase")
   end subroutine test_refusals

   !> Check that terms are a sum of exponentials, between the limits of the material
   subroutine sane(material, last, terms, what)
      !> The material
      type(tabulated_t), intent(in) :: material
      !> Time of its last point
      real(wp), intent(in) :: last
      !> Its terms
      type(exponential_sum_t), intent(out) :: terms
      !> What it is
      character(len=*), intent(in) :: what

      call material%exponentials(2.0_wp*last, 1.0e-3_wp, terms)
      call check(all(terms%moduli > 0.0_wp) .and. all(terms%rates > 0.0_wp) &
         .and. terms%equilibrium >= 0.0_wp, what//": no term is negative")
      ! but for the misfit that is good enough
      call check(terms%equilibrium <= material%rubbery()*(1.0_wp + 1.0e-6_wp), &
         what//": no more than the last modulus is left in the end")
   end subroutine sane

   !> Terms of a material known by its function
   subroutine terms_of(time, exact, misfit, terms)
      !> Times of the points
      real(wp), intent(in) :: time(:)
      !> The material that the points are of
      class(material_t), intent(in) :: exact
      !> Largest misfit that is right
      real(wp), intent(in) :: misfit
      !> The terms
      type(exponential_sum_t), intent(out) :: terms

      type(tabulated_t) :: material
      type(error_t), allocatable :: error
      real(wp) :: value(size(time)), largest
      integer :: i

      value = exact%relaxation(time)
      call new_tabulated(material, time, value, error)
      call success(error, "a table is built")
      call sane(material, time(size(time)), terms, "smooth material")
      ! that includes the time before the first point, where the sum rises and the table does not
      call check_close(terms%error, 0.0_wp, 3.0_wp*misfit, "the integral of the terms")
      largest = 0.0_wp
      do i = 1, size(time)
         largest = max(largest, abs((terms%equilibrium &
            + sum(terms%moduli*exp(-terms%rates*time(i))))/value(i) - 1.0_wp))
      end do
      call check_close(largest, 0.0_wp, misfit, "the misfit of the terms at the points")
   end subroutine terms_of

   !> Largest relative error of the interpolation in the middle between points
   subroutine interpolation_error(per_decade, exact, largest)
      !> Points to the decade
      integer, intent(in) :: per_decade
      !> The material that the points are of
      class(material_t), intent(in) :: exact
      !> The error
      real(wp), intent(out) :: largest

      type(tabulated_t) :: material
      type(error_t), allocatable :: error
      real(wp), allocatable :: time(:), value(:)
      real(wp) :: t
      integer :: i

      allocate (time, source=grid(-7.0_wp, 1.0_wp, per_decade))
      allocate (value, source=exact%relaxation(time))
      call new_tabulated(material, time, value, error)
      call success(error, "a table is built")
      largest = 0.0_wp
      ! the slope at either end is of second order only
      do i = 2, size(time) - 2
         t = sqrt(time(i)*time(i + 1))
         largest = max(largest, abs(material%relaxation(t)/exact%relaxation(t) - 1.0_wp))
      end do
   end subroutine interpolation_error

   !> Times that are equally spaced on the logarithmic scale
   pure function grid(first, last, per_decade) result(time)
      !> Decimal logarithm of the first
      real(wp), intent(in) :: first
      !> Decimal logarithm of the last
      real(wp), intent(in) :: last
      !> Points to the decade
      integer, intent(in) :: per_decade
      !> Times
      real(wp), allocatable :: time(:)

      integer :: i

      time = [(10.0_wp**(first + real(i, wp)/real(per_decade, wp)), &
         i=0, nint((last - first)*real(per_decade, wp)))]
   end function grid

   !> Numbers in increasing order
   pure function sorted(list) result(increasing)
      !> The numbers
      real(wp), intent(in) :: list(:)
      !> The same
      real(wp) :: increasing(size(list))

      integer :: i

      do i = 1, size(list)
         increasing(1 + count(list < list(i))) = list(i)
      end do
   end function sorted

end program test_table
