!> A Prony series and its misfit to samples: a least-squares problem in the logarithms of its moduli
!> and rates, which keeps all of them positive
module vcor_fit_series
   use vcor_kinds, only : wp
   use vcor_fit_samples, only : samples_t
   use vcor_numeric_least_squares, only : least_squares_t, minimise
   use vcor_numeric_nnls, only : solve_nnls
   implicit none
   private

   public :: series_t, new_series, set_bounds, unknowns_of, solve_moduli, refine, slowest_rate, &
      fastest_rate

   !> Largest rate times the first time of the samples, and smallest rate times the last one. Only
   !> one sample would show a term beyond: the modulus would be the noise of that sample times the
   !> exponential of this number
   real(wp), parameter :: fastest = 4.0_wp, slowest = 0.25_wp
   !> The same for frequencies, which show a term farther away: it decays only as 1/x
   real(wp), parameter :: fastest_seen = 30.0_wp, slowest_seen = 0.03_wp
   !> Factors by which a modulus may lie below and above those of the samples
   real(wp), parameter :: softest = 1.0e-8_wp, hardest = 1.0e4_wp
   !> Equilibrium modulus over the smallest modulus of the samples that counts as 0
   real(wp), parameter :: negligible = 1.0e-6_wp
   !> Smallest initial equilibrium modulus over the smallest modulus of the samples
   real(wp), parameter :: seed = 1.0e-2_wp
   !> Replaces a modulus of 0 in logarithms [Pa]
   real(wp), parameter :: least_modulus = 1.0e-200_wp

   !> A series; the unknowns of the problem are the logarithms of the equilibrium modulus, if it is
   !> free, of the moduli and of the rates
   type, extends(least_squares_t) :: series_t
      type(samples_t) :: samples
      !> Their moduli as one list [Pa]
      real(wp), allocatable :: data(:)
      !> Fixed equilibrium modulus [Pa]; negative: fitted
      real(wp) :: given = -1.0_wp
      !> Whether the equilibrium modulus is an unknown
      logical :: is_free = .false.
      !> Equilibrium modulus [Pa], >= 0
      real(wp) :: equilibrium = 0.0_wp
      !> Moduli of the terms [Pa], > 0, shape (n)
      real(wp), allocatable :: moduli(:)
      !> Logarithms of their rates [ln 1/s], increasing, shape (n)
      real(wp), allocatable :: rates(:)
      !> Logarithms of model over data, shape (count)
      real(wp), allocatable :: misfits(:)
      !> Whether the iteration has converged
      logical :: converged = .false.
   contains
      procedure :: residuals
      procedure :: jacobian
   end type series_t

contains

   !> A series without terms
   pure function new_series(samples, given) result(series)
      type(samples_t), intent(in) :: samples
      !> Equilibrium modulus [Pa]; negative: fitted
      real(wp), intent(in) :: given
      type(series_t) :: series

      series%samples = samples
      series%data = samples%all()
      series%given = given
   end function new_series

   !> Logarithm of the smallest rate of a term
   pure function slowest_rate(samples) result(rate)
      type(samples_t), intent(in) :: samples
      real(wp) :: rate

      rate = log(merge(slowest_seen, slowest, samples%dynamic)/samples%last_time())
   end function slowest_rate

   !> Logarithm of the largest rate of a term
   pure function fastest_rate(samples) result(rate)
      type(samples_t), intent(in) :: samples
      real(wp) :: rate

      rate = log(merge(fastest_seen, fastest, samples%dynamic)/samples%first_time())
   end function fastest_rate

   !> Response of a term of modulus 1 at the samples: exp(-l t), or, with x = omega/l, x^2/(1 + x^2)
   !> and x/(1 + x^2)
   pure function response(samples, rate) result(moduli)
      type(samples_t), intent(in) :: samples
      !> Logarithm of the rate l
      real(wp), intent(in) :: rate
      !> Moduli, shape (count)
      real(wp) :: moduli(samples%count())

      integer :: n

      n = size(samples%at)
      if (samples%dynamic) then
         associate (x => samples%at*exp(-rate))
            moduli(:n) = x**2/(1.0_wp + x**2)
            moduli(n + 1:) = x/(1.0_wp + x**2)
         end associate
      else
         moduli = exp(-exp(rate)*samples%at)
      end if
   end function response

   !> Set the rates, and the moduli by non-negative least squares of the relative misfits
   subroutine solve_moduli(series, rates)
      !> The series; on return its moduli are >= 0
      type(series_t), intent(inout) :: series
      !> Logarithms of the rates, shape (n)
      real(wp), intent(in) :: rates(:)

      real(wp) :: a(size(series%data), 0:size(rates)), b(size(series%data)), x(0:size(rates))
      integer :: k

      a(:, 0) = 0.0_wp
      a(:size(series%samples%modulus), 0) = 1.0_wp/series%samples%modulus
      do k = 1, size(rates)
         a(:, k) = response(series%samples, rates(k))/series%data
      end do
      b = 1.0_wp
      if (series%given >= 0.0_wp) then
         b = b - series%given*a(:, 0)
         a(:, 0) = 0.0_wp
      end if
      call solve_nnls(a, b, x)
      series%equilibrium = merge(series%given, x(0), series%given >= 0.0_wp)
      series%rates = rates
      series%moduli = x(1:)
   end subroutine solve_moduli

   !> Set the number of unknowns, and their bounds
   pure subroutine set_bounds(self, is_free)
      class(series_t), intent(inout) :: self
      !> Whether the equilibrium modulus is an unknown
      logical, intent(in) :: is_free

      integer :: n, first

      self%is_free = is_free
      n = size(self%rates)
      first = merge(1, 0, is_free) + n + 1
      if (allocated(self%lower)) deallocate (self%lower, self%upper)
      allocate (self%lower(first + n - 1), source=log(softest*minval(self%data)))
      allocate (self%upper(first + n - 1), source=log(hardest*maxval(self%data)))
      self%lower(first:) = slowest_rate(self%samples)
      self%upper(first:) = fastest_rate(self%samples)
   end subroutine set_bounds

   !> Unknowns of a series
   pure function unknowns_of(series, least) result(x)
      type(series_t), intent(in) :: series
      !> Smallest equilibrium modulus over the smallest modulus of the samples
      real(wp), intent(in) :: least
      real(wp), allocatable :: x(:)

      x = [log(series%moduli), series%rates]
      if (series%is_free) &
         x = [log(max(series%equilibrium, least*minval(series%samples%modulus))), x]
   end function unknowns_of

   !> Refine all moduli and rates together, and sort the terms by their rates
   subroutine refine(series, tolerance, most)
      type(series_t), intent(inout) :: series
      !> Relative reduction of the sum of squares that ends the iteration
      real(wp), intent(in) :: tolerance
      !> Maximum number of evaluations
      integer, intent(in) :: most

      call iterate(series, series%given < 0.0_wp)
      if (.not. series%is_free) return
      if (series%equilibrium > negligible*minval(series%samples%modulus)) return
      series%equilibrium = 0.0_wp
      call iterate(series, .false.)

   contains

      !> Iterate with or without the equilibrium modulus as an unknown
      subroutine iterate(series, is_free)
         type(series_t), intent(inout) :: series
         logical, intent(in) :: is_free

         real(wp) :: r(size(series%data))
         real(wp), allocatable :: x(:)
         logical :: converged
         integer :: n, first

         call set_bounds(series, is_free)
         n = size(series%rates)
         first = merge(1, 0, is_free)
         ! non-negative least squares may have left out a modulus that the refinement needs
         allocate (x, source=unknowns_of(series, seed))
         call minimise(series, x, r, converged, tolerance, most)
         if (is_free) series%equilibrium = exp(x(1))
         series%moduli = exp(x(first + 1:first + n))
         series%rates = x(first + n + 1:)
         series%misfits = r
         series%converged = converged
         call order(series)
      end subroutine iterate
   end subroutine refine

   !> Sort the terms of a series by their rates
   pure subroutine order(series)
      type(series_t), intent(inout) :: series

      real(wp) :: rate, modulus
      integer :: i, k

      do i = 2, size(series%rates)
         rate = series%rates(i)
         modulus = series%moduli(i)
         do k = i - 1, 1, -1
            if (series%rates(k) <= rate) exit
            series%rates(k + 1) = series%rates(k)
            series%moduli(k + 1) = series%moduli(k)
         end do
         series%rates(k + 1) = rate
         series%moduli(k + 1) = modulus
      end do
   end subroutine order

   !> Residuals: logarithms of model over data
   subroutine residuals(self, x, r)
      class(series_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: r(:)

      integer :: k, n, first

      first = merge(1, 0, self%is_free)
      n = (size(x) - first)/2
      r = 0.0_wp
      r(:size(self%samples%at)) = self%equilibrium
      if (self%is_free) r(:size(self%samples%at)) = exp(x(1))
      do k = 1, n
         r = r + exp(x(first + k))*response(self%samples, x(first + n + k))
      end do
      r = log(max(r, least_modulus)/self%data)
   end subroutine residuals

   !> Derivatives of the residuals. Those by ln l are -l t exp(-l t), and -2 x^2/(1 + x^2)^2 and
   !> -x (1 - x^2)/(1 + x^2)^2
   subroutine jacobian(self, x, j)
      class(series_t), intent(in) :: self
      real(wp), intent(in) :: x(:)
      !> Derivatives, shape (count, size(x))
      real(wp), intent(out) :: j(:, :)

      real(wp) :: model(size(j, 1)), term(size(j, 1))
      integer :: i, k, n, m, first

      first = merge(1, 0, self%is_free)
      n = (size(x) - first)/2
      m = size(self%samples%at)
      call self%residuals(x, model)
      model = self%data*exp(model)
      if (self%is_free) then
         j(:, 1) = 0.0_wp
         j(:m, 1) = exp(x(1))/model(:m)
      end if
      do k = 1, n
         term = exp(x(first + k))*response(self%samples, x(first + n + k))/model
         j(:, first + k) = term
         if (self%samples%dynamic) then
            do i = 1, m
               associate (y => self%samples%at(i)*exp(-x(first + n + k)))
                  j(i, first + n + k) = -2.0_wp*term(i)/(1.0_wp + y**2)
                  j(m + i, first + n + k) = -term(m + i)*(1.0_wp - y**2)/(1.0_wp + y**2)
               end associate
            end do
         else
            j(:, first + n + k) = -exp(x(first + n + k))*self%samples%at*term
         end if
      end do
   end subroutine jacobian

end module vcor_fit_series
