!> What a fit has found: estimates with standard errors, and what the data cannot say
module vcor_fit_result
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_fit_samples, only : moduli_of, samples_t
   use vcor_material_type, only : material_t
   use vcor_numeric_lapack, only : dgeqrf, dorgqr
   use vcor_numeric_least_squares, only : covariance, least_squares_t
   implicit none
   private

   public :: fit_t, estimate_t, state_free, state_fixed, state_bound, unseen_earlier, unseen_later
   public :: judge, set_errors, is_structured, mark_ends

   !> State of a parameter: found by the fit
   integer, parameter :: state_free = 0
   !> Given by the user
   integer, parameter :: state_fixed = 1
   !> Run to the end of its range: the data say no more than how far away it can be
   integer, parameter :: state_bound = 2
   !> What a parameter depends on beyond the data: on what relaxes before they begin
   integer, parameter :: unseen_earlier = 1
   !> On what relaxes after they end
   integer, parameter :: unseen_later = 2
   !> Condition of the scaled derivatives beyond which parameters are not determined: they would
   !> have no digit in common with those of data that differ by 1e-7
   real(wp), parameter :: worst_condition = 1.0e7_wp

   !> Root mean square misfit that is as good as any data: numbers of three digits are no better
   real(wp), parameter :: negligible = 5.0e-3_wp
   !> Root mean square misfit, a factor of two, that is no noise of moduli, whatever its order
   real(wp), parameter :: hopeless = log(2.0_wp)
   !> Standard deviations above the mean that one fit in a thousand exceeds by chance
   real(wp), parameter :: unlikely = 3.1_wp
   !> Residuals more than parameters, at least: with fewer no correlation is so far above the mean
   integer, parameter :: least = 5

   !> Change of the modulus over a decade that is none: for a series as good as any data, for a law,
   !> which goes on by itself, more
   real(wp), parameter :: flat_series = 5.0e-3_wp, flat_law = 0.1_wp

   !> Estimate of a parameter
   type :: estimate_t
      !> Name, a key of &material
      character(len=26) :: name = ''
      !> Unit
      character(len=8) :: unit = ''
      !> Value, in this unit
      real(wp) :: value = 0.0_wp
      !> Standard error, in this unit; 0 if the value is given
      real(wp) :: error = 0.0_wp
      !> One of the `state_*` constants
      integer :: state = state_free
      !> What its value depends on that the data do not show: `unseen_earlier`, `unseen_later`, or 0
      integer :: unseen = 0
   end type estimate_t

   !> A fit
   type :: fit_t
      type(material_data_t) :: data
      !> Its parameters; moduli and times of a Prony series alternate, the fastest term first
      type(estimate_t), allocatable :: parameters(:)
      !> Root of the mean square of the relative misfits [-]
      real(wp) :: rms = 0.0_wp
      !> Largest relative misfit, with its sign: model over data less 1 [-]
      real(wp) :: largest = 0.0_wp
      !> Time [s] or angular frequency [rad/s] where it is
      real(wp) :: largest_at = 0.0_wp
      !> Whether it is one of the loss modulus
      logical :: largest_in_loss = .false.
      !> Variance of the data, as relative misfits, if the model is right [-]
      real(wp) :: variance = 0.0_wp
      !> Whether the misfits are no noise: the model does not follow the data
      logical :: structured = .false.
      !> Correlation of the parameters [-], shape (n, n); 0 of those that are given
      real(wp), allocatable :: correlation(:, :)
      !> Condition of the derivatives by the parameters that are free, each scaled to length 1
      real(wp) :: condition = 1.0_wp
   end type fit_t

contains

   !> Say how well a material agrees with samples
   pure subroutine judge(fit, material, samples)
      type(fit_t), intent(inout) :: fit
      class(material_t), intent(in) :: material
      type(samples_t), intent(in) :: samples

      real(wp) :: misfit(samples%count())
      integer :: place

      misfit = moduli_of(material, samples)/samples%all() - 1.0_wp
      fit%rms = norm2(misfit)/sqrt(real(size(misfit), wp))
      place = maxloc(abs(misfit), dim=1)
      fit%largest = misfit(place)
      fit%largest_in_loss = place > size(samples%at)
      if (fit%largest_in_loss) place = place - size(samples%at)
      fit%largest_at = samples%at(place)
   end subroutine judge

   !> Set standard errors from the derivatives at the solution: those of a linear problem about it;
   !> and tell whether the residuals are the noise that they are made of.
   !> What is at its bound is an unknown of it like the others: their errors allow for what it could
   !> be instead
   subroutine set_errors(fit, problem, x, r, free, points, error)
      !> The fit, its values and states set
      type(fit_t), intent(inout) :: fit
      class(least_squares_t), intent(in) :: problem
      !> Its solution, logarithms of the parameters `free`; what is 0 has a small value, shape (n)
      real(wp), intent(in) :: x(:)
      !> Residuals there, shape (m)
      real(wp), intent(in) :: r(:)
      !> Numbers of the parameters that the unknowns stand for, shape (n)
      integer, intent(in) :: free(:)
      !> Number of times or frequencies
      integer, intent(in) :: points
      !> Error of code `error_numerical` if the data do not determine the parameters
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: j(size(r), size(x)), inverse(size(x), size(x)), condition
      !> Standard deviations of the unknowns over that of a residual; of a rate, whose logarithm is
      !> that of the time but for its sign, with another sign
      real(wp) :: deviations(size(x))
      integer, allocatable :: inner(:)
      integer :: i

      inner = pack([(i, i=1, size(x))], fit%parameters(free)%state == state_free)
      call problem%jacobian(x, j)
      call covariance(j(:, inner), inverse(:size(inner), :size(inner)), fit%condition)
      if (.not. fit%condition <= worst_condition) then
         call raise(error, error_numerical, 'the data do not determine all parameters of model ' &
            //fit%data%model//": take fewer, by --terms or --fix, or another model")
         return
      end if
      fit%structured = norm2(r) > hopeless*sqrt(real(size(r), wp))
      if (.not. fit%structured) fit%structured = is_structured(r, j(:, inner), points)
      fit%variance = sum(r**2)/real(max(1, size(r) - size(inner)), wp)
      call covariance(j, inverse, condition)
      allocate (fit%correlation(size(fit%parameters), size(fit%parameters)), source=0.0_wp)
      do i = 1, size(x)
         deviations(i) = sqrt(inverse(i, i))
         associate (parameter => fit%parameters(free(i)))
            ! the unknown of a time of a series is its rate
            if (parameter%name == 'times') then
               parameter%error = parameter%value*sqrt(fit%variance)*deviations(i)
               deviations(i) = -deviations(i)
            else
               parameter%error = exp(x(i))*sqrt(fit%variance)*deviations(i)
            end if
         end associate
      end do
      do i = 1, size(x)
         fit%correlation(free, free(i)) = inverse(:, i)/(deviations*deviations(i))
         fit%correlation(free(i), free(i)) = 1.0_wp
      end do
   end subroutine set_errors

   !> Whether neighbouring residuals have so much in common that they are no noise
   !>
   !> Noise knows nothing of its neighbour, a model that is wrong misses the data in the same sense
   !> over many points. So it is not the size of the residuals that tells, but their correlation
   !> with the next one, rho = sum r_i r_(i+1)/sum r_i^2, in order of time or frequency. Of noise it
   !> would be 0 but for the fit, which has taken from the residuals what its p parameters could
   !> follow, and that is smooth. Residuals r = M e of independent noise e of one variance, with M
   !> the projection on what the derivatives by the parameters do not span and A r the mean of the
   !> two neighbours (rho = r'A r/r'r), have a rho of the mean and variance
   !>
   !>    tr(MA)/n,   2 (tr(MAMA) - tr(MA)^2/n)/(n (n + 2)),   n = m - p
   !>
   !> for any number m of points (J. Durbin and G. S. Watson, Biometrika 37 (1950) 409,
   !> doi:10.1093/biomet/37.3-4.409).
   pure function is_structured(r, j, points) result(yes)
      !> Residuals of a least squares fit, one or more sequences after each other, shape (m)
      real(wp), intent(in) :: r(:)
      !> Their derivatives by the parameters that were free, of full rank, shape (m, p)
      real(wp), intent(in) :: j(:, :)
      !> Points of a sequence
      integer, intent(in) :: points
      !> True if they are not negligible and no noise, false if there are too few to tell
      logical :: yes

      real(wp) :: q(size(j, 1), size(j, 2)), aq(size(j, 1), size(j, 2)), g(size(j, 2), size(j, 2))
      real(wp) :: tau(size(j, 2)), work(32*size(j, 2)), n, mean, square, rho
      integer :: i, sequences, info

      yes = .false.
      if (size(r) < size(j, 2) + least) return
      if (norm2(r) <= negligible*sqrt(real(size(r), wp))) return
      q = j
      if (size(q, 2) > 0) then
         call dgeqrf(size(q, 1), size(q, 2), q, size(q, 1), tau, work, size(work), info)
         call dorgqr(size(q, 1), size(q, 2), size(q, 2), q, size(q, 1), tau, work, size(work), info)
      end if
      do i = 1, size(q, 2)
         aq(:, i) = neighbours(q(:, i), points)
      end do
      g = matmul(transpose(q), aq)
      sequences = size(r)/points
      n = real(size(r) - size(q, 2), wp)
      mean = -sum([(g(i, i), i=1, size(g, 1))])/n
      square = 0.5_wp*real(size(r) - sequences, wp) - 2.0_wp*sum(aq**2) + sum(g**2)
      rho = dot_product(r, neighbours(r, points))/sum(r**2)
      ! storage and loss modulus may share their noise, or one of them have next to all of it: then
      ! chance has the variance of one sequence
      yes = rho - mean > unlikely*sqrt(real(sequences, wp)*2.0_wp*(square - n*mean**2) &
         /(n*(n + 2.0_wp)))
   end function is_structured

   !> Mean of the two neighbours of each number; where there is none it counts as 0
   pure function neighbours(r, points) result(means)
      !> Numbers, one or more sequences after each other
      real(wp), intent(in) :: r(:)
      !> Numbers of a sequence
      integer, intent(in) :: points
      !> Means of neighbours, same shape
      real(wp) :: means(size(r))

      integer :: i

      means = 0.0_wp
      do i = 1, size(r) - 1
         if (mod(i, points) == 0) cycle
         means(i) = means(i) + 0.5_wp*r(i + 1)
         means(i + 1) = means(i + 1) + 0.5_wp*r(i)
      end do
   end function neighbours

   !> Mark the parameters whose values depend on what the data do not show: on what relaxes before
   !> they begin and after they end
   !>
   !> A modulus that still falls where the data end goes on falling, and no datum tells how far. A
   !> law of few parameters says how, and is right if it is the law of the material. A series has no
   !> say: what relaxes later is part of its equilibrium modulus, and its slowest term lies in
   !> between. The same holds where the data begin. So what the standard error of a modulus is worth
   !> depends on the slope at that end: if a decade more of it is more than the standard error, the
   !> error is only that of a material that the model describes beyond the data too. So is that of a
   !> relaxation time beyond the data.
   subroutine mark_ends(fit, material, samples)
      !> The fit, with standard errors
      type(fit_t), intent(inout) :: fit
      class(material_t), intent(in) :: material
      type(samples_t), intent(in) :: samples

      real(wp) :: early, late, error, time
      integer :: i, n

      associate (flat => merge(flat_series, flat_law, fit%data%model == 'prony'))
         early = fall(material, samples%first_time(), samples%dynamic, flat)
         late = fall(material, samples%last_time(), samples%dynamic, flat)
      end associate
      n = size(fit%parameters)
      error = 0.0_wp
      do i = 1, n
         associate (parameter => fit%parameters(i))
            ! a time of a series goes with its modulus
            if (parameter%name /= 'times') error = parameter%error
            if (parameter%state /= state_free) cycle
            select case (parameter%name)
            case ('equilibrium_modulus')
               if (late > error) parameter%unseen = unseen_later
            case ('alpha')
               ! the rubbery modulus is glassy_modulus*alpha/beta
               if (late > fit%data%number('glassy_modulus')*error/fit%data%number('beta')) &
                  parameter%unseen = unseen_later
            case ('glassy_modulus', 'relaxing_modulus')
               if (early > error) parameter%unseen = unseen_earlier
            case ('moduli', 'times')
               if (i <= 3 .and. early > error) parameter%unseen = unseen_earlier
               if (i >= n - 1 .and. late > error) parameter%unseen = unseen_later
            case ('beta', 'time')
               time = parameter%value
               if (parameter%name == 'beta') time = 1.0_wp/time
               if (fit%data%model == 'cerf') time = time**2
               if (time < samples%first_time()) parameter%unseen = unseen_earlier
               if (time > samples%last_time()) parameter%unseen = unseen_later
            case default
               continue
            end select
         end associate
      end do
   end subroutine mark_ends

   !> Fall of the modulus over a decade, by its slope; 0 where it is flat
   function fall(material, time, dynamic, flat) result(change)
      class(material_t), intent(in) :: material
      !> Time [s]
      real(wp), intent(in) :: time
      !> Whether it is that of the storage modulus at the angular frequency 1/time
      logical, intent(in) :: dynamic
      !> Part of the modulus that is no change
      real(wp), intent(in) :: flat
      !> Fall of the relaxation modulus, or of the storage modulus [Pa]
      real(wp) :: change

      !> Half the step of the difference
      real(wp), parameter :: step = 1.0e-3_wp
      real(wp) :: moduli(2), times(2)

      times = time*exp([-step, step])
      if (dynamic) then
         moduli = real(material%complex_modulus(cmplx(0.0_wp, 1.0_wp/times, wp)), wp)
      else
         moduli = material%relaxation(times)
      end if
      change = log(10.0_wp)*(moduli(1) - moduli(2))/(2.0_wp*step)
      if (change <= flat*moduli(2)) change = 0.0_wp
   end function fall

end module vcor_fit_result
