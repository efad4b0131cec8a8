!> What a fit has found
module vcor_fit_result
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_fit_samples, only : samples_t
   use vcor_fit_structure, only : is_structured
   use vcor_material_type, only : material_t
   use vcor_numeric_least_squares, only : covariance, least_squares_t
   implicit none
   private

   public :: fit_t, parameter_t, state_free, state_fixed, state_bound, unseen_earlier, unseen_later
   public :: moduli_of, judge, set_errors

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

   !> One parameter
   type :: parameter_t
      !> Name, a key of &material
      character(len=20) :: name = ''
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
   end type parameter_t

   !> A fit
   type :: fit_t
      !> The material
      type(material_data_t) :: data
      !> Its parameters; moduli and times of a Prony series alternate, the fastest term first
      type(parameter_t), allocatable :: parameters(:)
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
      !> Condition of the derivatives by the parameters that are free, each scaled to length 1
      real(wp) :: condition = 1.0_wp
   end type fit_t

contains

   !> Moduli of a material where there are samples
   pure function moduli_of(material, samples) result(moduli)
      !> The material
      class(material_t), intent(in) :: material
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Relaxation moduli, or storage and then loss moduli [Pa], shape (count)
      real(wp) :: moduli(samples%count())

      complex(wp) :: complex_moduli(size(samples%loss))

      if (samples%dynamic) then
         complex_moduli = material%complex_modulus(cmplx(0.0_wp, samples%at, wp))
         moduli(:size(samples%at)) = real(complex_moduli, wp)
         moduli(size(samples%at) + 1:) = aimag(complex_moduli)
      else
         moduli = material%relaxation(samples%at)
      end if
   end function moduli_of

   !> Say how well a material agrees with samples
   pure subroutine judge(fit, material, samples)
      !> The fit
      type(fit_t), intent(inout) :: fit
      !> Its material
      class(material_t), intent(in) :: material
      !> The samples
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
      !> The problem
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

      real(wp) :: j(size(r), size(x)), inverse(size(x), size(x)), condition, scale
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
      fit%structured = is_structured(r, j(:, inner), points)
      fit%variance = sum(r**2)/real(max(1, size(r) - size(inner)), wp)
      call covariance(j, inverse, condition)
      do i = 1, size(x)
         associate (parameter => fit%parameters(free(i)))
            ! the unknown of a time of a series is its rate
            scale = merge(parameter%value, exp(x(i)), parameter%name == 'times')
            parameter%error = scale*sqrt(fit%variance)*sqrt(inverse(i, i))
         end associate
      end do
   end subroutine set_errors

end module vcor_fit_result
