!> Fit of a sum of exponentials to samples of a non-increasing modulus
!>
!> With the rates on a grid, the moduli follow from non-negative least squares of the relative
!> misfit, and most of them are zero. A single relaxation time appears as two neighbours on the
!> grid, so the grid is refined around the rates in use as long as that reduces the misfit enough;
!> rates that are close together are merged at the end.
module vcor_material_exponential_fit
   use vcor_kinds, only : wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_numeric_nnls, only : solve_nnls
   use vcor_tuning, only : fastest_of_data, good_misfit, least_gain, merging_loss, &
      most_refinements, rates_per_decade, slowest_of_data
   implicit none
   private

   public :: fit_exponentials

contains

   !> Fit E(t) = E_0 + sum E_k exp(-l_k t), E_0 and E_k >= 0
   pure subroutine fit_exponentials(time, modulus, terms)
      !> Times of the samples [s], increasing, > 0, about equally spaced in the logarithm, shape (m)
      real(wp), intent(in) :: time(:)
      !> Modulus at these times [Pa], > 0, not increasing, shape (m)
      real(wp), intent(in) :: modulus(:)
      !> The sum; `terms%error` is the largest relative misfit at the samples
      type(exponential_sum_t), intent(out) :: terms

      real(wp), allocatable :: grid(:), rate(:), weight(:), finer(:), better(:)
      real(wp) :: spacing, residual, misfit, new_residual, new_misfit, bound, width
      integer :: i, n

      ! the variable is the logarithm of the rate
      associate (lower => log(slowest_of_data/time(size(time))), &
                 upper => log(fastest_of_data/time(1)))
         n = 1 + ceiling((upper - lower)/log(10.0_wp)*rates_per_decade)
         spacing = (upper - lower)/real(n - 1, wp)
         allocate (grid(n))
         grid = [(lower + real(i, wp)*spacing, i=0, n - 1)]
      end associate

      rate = grid
      call fit(time, modulus, rate, weight, residual, misfit)
      width = spacing
      do i = 1, most_refinements
         if (misfit <= good_misfit) exit
         width = 0.5_wp*width
         finer = refined(rate, width, grid)
         call fit(time, modulus, finer, better, new_residual, new_misfit, guess=rate)
         if (.not. new_residual*real(size(finer), wp)**2 &
            < least_gain*residual*real(size(rate), wp)**2) exit
         call move_alloc(finer, rate)
         call move_alloc(better, weight)
         residual = new_residual
         misfit = new_misfit
      end do

      bound = max(good_misfit, merging_loss*misfit)
      do while (width < 2.0_wp*spacing .and. size(rate) > 1)
         finer = merged(rate, weight(1:), 1.01_wp*width)
         width = 2.0_wp*width
         if (size(finer) == size(rate)) cycle
         call fit(time, modulus, finer, better, new_residual, new_misfit)
         if (.not. new_misfit <= bound) exit
         call move_alloc(finer, rate)
         call move_alloc(better, weight)
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
      !> Weights over the first modulus, that of the equilibrium modulus first, shape (0:n)
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

end module vcor_material_exponential_fit
