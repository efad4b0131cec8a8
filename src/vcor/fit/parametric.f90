!> Fit of the models with a few parameters: sls, power_law, cerf, mittag_leffler
!>
!> Every minimum of a scan over the shapes of the model starts an iteration in the logarithms of the
!> parameters: a local minimum wins only if it is the lowest.
module vcor_fit_parametric
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material, only : material_t, new_material
   use vcor_fit_ends, only : mark_ends
   use vcor_fit_interval, only : widen_errors
   use vcor_fit_problem, only : described, nothing, parameters_of, problem_t, release, &
      set_free, unit_of, unknowns_of
   use vcor_fit_result, only : fit_t, judge, parameter_t, set_errors, state_bound, &
      state_fixed, state_free
   use vcor_fit_samples, only : samples_t
   use vcor_fit_scan, only : find_starts
   use vcor_numeric_least_squares, only : minimise
   implicit none
   private

   public :: fit_parametric

   !> Most evaluations of an iteration, per unknown
   integer, parameter :: patience = 400

contains

   !> Fit a model to samples
   subroutine fit_parametric(fit, model, fixed, samples, error)
      !> The fit
      type(fit_t), intent(out) :: fit
      !> Name of the model, one of those with parameters
      character(len=*), intent(in) :: model
      !> Parameters that have a given value, shape (n)
      type(parameter_t), intent(in) :: fixed(:)
      !> The samples, more than there are parameters
      type(samples_t), intent(in) :: samples
      !> Error of code `error_numerical` if there is no solution, of code `error_input` if a given
      !> value is out of range; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(problem_t) :: problem
      class(material_t), allocatable :: material
      real(wp), allocatable :: x(:), starts(:, :)
      real(wp) :: r(samples%count()), best(samples%count())
      real(wp), allocatable :: solution(:)
      logical :: converged, good
      integer :: i, k

      problem%model = model
      problem%samples = samples
      problem%parameters = parameters_of(model)
      do i = 1, size(fixed)
         do k = 1, size(problem%parameters)
            if (problem%parameters(k)%name /= fixed(i)%name) cycle
            problem%parameters(k)%value = fixed(i)%value
            problem%parameters(k)%state = state_fixed
         end do
      end do
      call set_free(problem)
      call find_starts(problem, starts)
      good = .false.
      do i = 1, size(starts, 2)
         x = log(starts(problem%free, i))
         call minimise(problem, x, r, converged, 0.0_wp, patience*(size(x) + 1))
         if (i > 1) then
            if (.not. norm2(r) < norm2(best)) cycle
         end if
         best = r
         solution = x
         good = converged
      end do
      if (size(starts, 2) == 0) then
         call raise(error, error_numerical, 'model '//model//' has no likeness to the data')
         return
      end if
      call follow_bounds(problem, solution, best, good)
      if (.not. good) then
         call raise(error, error_numerical, 'the fit of model '//model//' does not converge: ' &
            //'give parameters with --fix, or another model')
         return
      end if

      problem%parameters(problem%free)%value = exp(solution)
      fit%data = described(model, problem%parameters)
      fit%parameters = problem%parameters
      call new_material(material, fit%data, error)
      if (allocated(error)) return
      call judge(fit, material, samples)
      problem%parameters = fit%parameters
      call release(problem)
      call set_errors(fit, problem, unknowns_of(problem), best, problem%free, size(samples%at), &
         error)
      if (allocated(error)) return
      call widen_errors(fit, problem, sum(best**2))
      call mark_ends(fit, material, samples)
   end subroutine fit_parametric

   !> What has come to the end of its range: a modulus or rate that vanishes is 0, an exponent 1,
   !> and the others are fitted again; anything else keeps its value
   subroutine follow_bounds(problem, x, r, converged)
      !> The problem; what is at a bound is not free afterwards
      type(problem_t), intent(inout) :: problem
      !> Solution
      real(wp), allocatable, intent(inout) :: x(:)
      !> Residuals
      real(wp), intent(inout) :: r(:)
      !> Whether it is a solution
      logical, intent(inout) :: converged

      real(wp), parameter :: touch = 1.0e-5_wp
      real(wp), allocatable :: kept(:)
      integer :: i

      do i = 1, size(x)
         associate (parameter => problem%parameters(problem%free(i)))
            if (exp(x(i)) < nothing*unit_of(parameter%name, problem%samples)) then
               parameter%value = 0.0_wp
            else if (parameter%name == 'exponent' .and. x(i) > problem%upper(i) - touch &
               .and. problem%model == 'mittag_leffler') then
               parameter%value = 1.0_wp
            else if (x(i) < problem%lower(i) + touch .or. x(i) > problem%upper(i) - touch) then
               parameter%value = exp(x(i))
            else
               cycle
            end if
            parameter%state = state_bound
         end associate
      end do
      if (all(problem%parameters(problem%free)%state == state_free)) return
      kept = pack(x, problem%parameters(problem%free)%state == state_free)
      call move_alloc(kept, x)
      call set_free(problem)
      call minimise(problem, x, r, converged, 0.0_wp, patience*(size(x) + 1))
   end subroutine follow_bounds

end module vcor_fit_parametric
