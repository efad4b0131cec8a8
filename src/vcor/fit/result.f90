!> Result of a fit: estimates with standard errors, what the data cannot determine, and its JSON
!> document
module vcor_fit_result
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_json, only : array, member, numbers, object
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_fit_samples, only : moduli_of, samples_t
   use vcor_material_type, only : material_t
   use vcor_numeric_lapack, only : dgeqrf, dorgqr
   use vcor_numeric_least_squares, only : covariance, least_squares_t
   use vcor_text, only : integer_text
   use vcor_version, only : version
   implicit none
   private

   public :: fit_t, estimate_t, state_free, state_fixed, state_bound, unseen_earlier, unseen_later
   public :: judge, set_errors, is_structured, mark_ends
   public :: fit_json, parameter_name, shift_note

   !> State of a parameter: determined by the fit
   integer, parameter :: state_free = 0
   !> Given by the user
   integer, parameter :: state_fixed = 1
   !> At the end of its range: the data only limit its distance from there
   integer, parameter :: state_bound = 2
   !> Their names in a document
   character(len=*), parameter :: states(0:2) = ['free ', 'fixed', 'bound']
   !> What a parameter depends on beyond the data: relaxation before they begin
   integer, parameter :: unseen_earlier = 1
   !> Relaxation after they end
   integer, parameter :: unseen_later = 2
   !> Condition number of the scaled derivatives above which parameters are not determined: with a
   !> change of the data by 1e-7 they would have no common digit
   real(wp), parameter :: worst_condition = 1.0e7_wp

   !> Root mean square misfit below the accuracy of any data: numbers have three digits at best
   real(wp), parameter :: negligible = 5.0e-3_wp
   !> Root mean square misfit, a factor of two, that is too large for noise of any kind
   real(wp), parameter :: too_large = log(2.0_wp)
   !> Standard deviations above the mean that one fit in a thousand exceeds by chance
   real(wp), parameter :: significance = 3.1_wp
   !> Minimum excess of residuals over parameters: with fewer no correlation is significant
   integer, parameter :: min_excess = 5

   !> Relative change of the modulus over a decade that counts as zero: for a series the accuracy of
   !> any data, for a law, which extrapolates, more
   real(wp), parameter :: flat_series = 5.0e-3_wp, flat_law = 0.1_wp

   !> Estimate of a parameter
   type :: estimate_t
      !> Name, a key of &material
      character(len=26) :: name = ''
      !> Unit
      character(len=8) :: unit = ''
      !> Value, in this unit
      real(wp) :: value = 0.0_wp
      !> Standard error, in this unit; 0 if the value is fixed
      real(wp) :: error = 0.0_wp
      !> One of the `state_*` constants
      integer :: state = state_free
      !> Relaxation beyond the data on which it depends: `unseen_earlier`, `unseen_later`, or 0
      integer :: unseen = 0
   end type estimate_t

   !> Result of a fit
   type :: fit_t
      type(material_data_t) :: data
      !> Its parameters; moduli and times of a Prony series alternate, the fastest term first
      type(estimate_t), allocatable :: parameters(:)
      !> Root of the mean square of the relative misfits [-]
      real(wp) :: rms = 0.0_wp
      !> Largest relative misfit [-], signed: model over data minus 1
      real(wp) :: largest = 0.0_wp
      !> Its time [s] or angular frequency [rad/s]
      real(wp) :: largest_at = 0.0_wp
      !> Whether it belongs to the loss modulus
      logical :: largest_in_loss = .false.
      !> Variance of the data, as relative misfits, if the model is correct [-]
      real(wp) :: variance = 0.0_wp
      !> Whether the misfits are systematic, not noise: the model does not follow the data
      logical :: structured = .false.
      !> Correlation of the parameters [-], shape (n, n); 0 for fixed ones
      real(wp), allocatable :: correlation(:, :)
      !> Condition number of the derivatives by the free parameters, each scaled to length 1
      real(wp) :: condition = 1.0_wp
   end type fit_t

contains

   !> Set the misfits of a material to samples
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

   !> Set standard errors from the derivatives at the solution, by linearisation, and find whether
   !> the residuals are noise. Parameters at a bound are unknowns like the others, so the errors of
   !> the others allow for their possible values
   subroutine set_errors(fit, problem, x, r, free, points, error)
      !> The fit, its values and states set
      type(fit_t), intent(inout) :: fit
      class(least_squares_t), intent(in) :: problem
      !> Its solution, logarithms of the parameters `free`, with a small value for 0, shape (n)
      real(wp), intent(in) :: x(:)
      !> Residuals at the solution, shape (m)
      real(wp), intent(in) :: r(:)
      !> Indices of the parameters of the unknowns, shape (n)
      integer, intent(in) :: free(:)
      !> Number of times or frequencies
      integer, intent(in) :: points
      !> Error of code `error_numerical` if the data do not determine the parameters
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: j(size(r), size(x)), inverse(size(x), size(x)), condition
      !> Standard deviations of the unknowns over that of a residual; negative for a rate whose time
      !> is the parameter, as ln(time) = -ln(rate)
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
      fit%structured = norm2(r) > too_large*sqrt(real(size(r), wp))
      if (.not. fit%structured) fit%structured = is_structured(r, j(:, inner), points)
      fit%variance = sum(r**2)/real(max(1, size(r) - size(inner)), wp)
      call covariance(j, inverse, condition)
      allocate (fit%correlation(size(fit%parameters), size(fit%parameters)), source=0.0_wp)
      do i = 1, size(x)
         deviations(i) = sqrt(inverse(i, i))
         associate (parameter => fit%parameters(free(i)))
            ! the unknown of a time is the logarithm of its rate
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

   !> Whether neighbouring residuals are correlated too much for noise
   !>
   !> Noise is independent from point to point, while a wrong model errs in the same direction over
   !> many points. So the test uses not the size of the residuals but their correlation with the
   !> next one, rho = sum r_i r_(i+1)/sum r_i^2, in order of time or frequency. For noise it would
   !> be 0, but the fit has removed from the residuals the smooth part that its p parameters could
   !> follow. Let r = M e with independent noise e of one variance and the projection M orthogonal
   !> to the derivatives by the parameters, and let A r be the mean of the two neighbours, so
   !> rho = r'A r/r'r. Then rho has the mean and the variance
   !>
   !>    tr(MA)/n,   2 (tr(MAMA) - tr(MA)^2/n)/(n (n + 2)),   n = m - p
   !>
   !> for any number m of points (J. Durbin and G. S. Watson, Biometrika 37 (1950) 409,
   !> doi:10.1093/biomet/37.3-4.409).
   pure function is_structured(r, j, points) result(yes)
      !> Residuals of a least squares fit, one or more sequences in turn, shape (m)
      real(wp), intent(in) :: r(:)
      !> Their derivatives by the free parameters, of full rank, shape (m, p)
      real(wp), intent(in) :: j(:, :)
      !> Number of points of a sequence
      integer, intent(in) :: points
      !> True if they are neither negligible nor noise; false if there are too few to decide
      logical :: yes

      real(wp) :: q(size(j, 1), size(j, 2)), aq(size(j, 1), size(j, 2)), g(size(j, 2), size(j, 2))
      real(wp) :: tau(size(j, 2)), work(32*size(j, 2)), n, mean, square, rho
      integer :: i, sequences, info

      yes = .false.
      if (size(r) < size(j, 2) + min_excess) return
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
      ! storage and loss modulus may share their noise, or one of them may have nearly all of it: in
      ! both cases the variance is that of one sequence
      yes = rho - mean > significance*sqrt(real(sequences, wp)*2.0_wp*(square - n*mean**2) &
         /(n*(n + 2.0_wp)))
   end function is_structured

   !> Mean of the two neighbours of each number; a missing neighbour counts as 0
   pure function neighbours(r, points) result(means)
      !> Numbers, one or more sequences in turn
      real(wp), intent(in) :: r(:)
      !> Length of a sequence
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

   !> Mark the parameters whose values depend on relaxation before the data begin or after they end
   !>
   !> A modulus that still falls at the end of the data continues to fall, and no datum tells how
   !> far. A law with few parameters extrapolates, correctly if it is the law of the material. A
   !> series does not: it adds what relaxes later to its equilibrium modulus and to its slowest
   !> term. The same holds at the beginning of the data. So the slope at that end decides: if the
   !> modulus would change by more than its standard error over another decade, the error is valid
   !> only if the model also describes the material beyond the data. The same applies to a
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
            ! a time of a series is marked with its modulus
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

   !> Fall of the modulus over a decade, from its slope; 0 if it is flat
   function fall(material, time, dynamic, flat) result(change)
      class(material_t), intent(in) :: material
      !> Time [s]
      real(wp), intent(in) :: time
      !> Whether to use the storage modulus at the angular frequency 1/time
      logical, intent(in) :: dynamic
      !> Fraction of the modulus that counts as no change
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

   !> Name of a parameter as a key of &material, with the index of its term in a series
   pure function parameter_name(fit, i) result(name)
      type(fit_t), intent(in) :: fit
      integer, intent(in) :: i
      character(len=:), allocatable :: name

      name = trim(fit%parameters(i)%name)
      if (fit%data%model == 'prony' .and. i > 1) name = name//'('//integer_text(i/2)//')'
   end function parameter_name

   !> Note that the standard errors of a fit to a master curve omit the errors of the shift factors:
   !> these move all points of a temperature together, which no misfit shows
   pure function shift_note(samples) result(text)
      type(samples_t), intent(in) :: samples
      !> The note; empty for data without a shift
      character(len=:), allocatable :: text

      text = ''
      if (.not. allocated(samples%keys)) return
      if (index(samples%keys, ' shift =') > 0) text = 'the standard errors leave out those of ' &
         //'the shift factors: vcor identify fits moduli and shift at once'
   end function shift_note

   !> The document: parameters in SI units, covariance, correlation, misfit and band of the data
   pure function fit_json(fit, samples, group) result(text)
      type(fit_t), intent(in) :: fit
      type(samples_t), intent(in) :: samples
      !> The material as a &material group
      character(len=*), intent(in) :: group
      character(len=:), allocatable :: text

      character(len=:), allocatable :: list, covariance, correlation
      integer :: i

      list = ''
      covariance = ''
      correlation = ''
      do i = 1, size(fit%parameters)
         associate (one => fit%parameters(i))
            list = list//object(member('name', parameter_name(fit, i))//member('unit', one%unit) &
               //member('value', one%value)//member('standard_error', one%error) &
               //member('state', trim(states(one%state))))
            correlation = correlation//array(numbers(fit%correlation(:, i)))
            covariance = covariance//array(numbers(fit%correlation(:, i)*(one%error &
               *fit%parameters%error)))
         end associate
      end do
      text = object(member('program', 'vcor')//member('version', version) &
         //member('name', fit%data%name)//member('model', fit%data%model) &
         //array(list, 'parameters')//array(covariance, 'covariance') &
         //array(correlation, 'correlation')//member('rms_misfit', fit%rms) &
         //member('largest_misfit', fit%largest)//member('largest_misfit_at', fit%largest_at) &
         //member('follows', .not. fit%structured)//member('note', shift_note(samples)) &
         //array(numbers([samples%first_time(), samples%last_time()]), 'band') &
         //member('group', group))
      text = text(:len(text) - 2)//new_line('a')
   end function fit_json

end module vcor_fit_result
