!> A model with a few parameters as a problem of least squares in their logarithms
module vcor_fit_problem
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_fit_result, only : moduli_of, parameter_t, state_bound, state_free
   use vcor_fit_samples, only : samples_t
   use vcor_numeric_least_squares, only : least_squares_t
   implicit none
   private

   public :: problem_t, parameters_of, described, misfit, set_free, release
   public :: unknowns_of, unit_of, nothing

   !> Range of times beyond the data, as a factor, and of moduli
   real(wp), parameter :: widest_time = 1.0e4_wp, widest_modulus = 1.0e6_wp
   !> Range of times where it is asked what a parameter at its bound could be instead
   real(wp), parameter :: widest_error = 1.0e8_wp
   !> Range of an exponent
   real(wp), parameter :: least_exponent = 1.0e-3_wp, most_exponent = 0.9999_wp
   !> Part of its unit below which a modulus or rate counts as 0
   real(wp), parameter :: nothing = 1.0e-7_wp
   !> Part of its unit that stands for 0 where the misfit has to depend on the logarithm
   real(wp), parameter :: little = 1.0e-3_wp
   !> Step of the derivatives in the logarithm of a parameter: central differences are then good to
   !> ten digits
   real(wp), parameter :: step = 1.0e-5_wp

   !> The problem for MINPACK; its unknowns are the logarithms of the parameters that are free
   type, extends(least_squares_t) :: problem_t
      !> Name of the model
      character(len=:), allocatable :: model
      !> The samples
      type(samples_t) :: samples
      !> All parameters; those that are not free have their values
      type(parameter_t), allocatable :: parameters(:)
      !> Numbers of those that are free, shape (n)
      integer, allocatable :: free(:)
      !> Range of times beyond the data, as a factor
      real(wp) :: widest = widest_time
   contains
      procedure :: residuals
      procedure :: jacobian
   end type problem_t

contains

   !> Parameters of a model
   pure function parameters_of(model) result(parameters)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Its parameters, without values; none for other models
      type(parameter_t), allocatable :: parameters(:)

      select case (model)
      case ('sls')
         parameters = [parameter_t('glassy_modulus', 'Pa'), parameter_t('alpha', '1/s'), &
            parameter_t('beta', '1/s')]
      case ('power_law')
         parameters = [parameter_t('equilibrium_modulus', 'Pa'), &
            parameter_t('coefficient', 'Pa s^a'), parameter_t('exponent', '1')]
      case ('cerf')
         parameters = [parameter_t('equilibrium_modulus', 'Pa'), &
            parameter_t('relaxing_modulus', 'Pa'), parameter_t('beta', 's^-1/2')]
      case ('mittag_leffler')
         parameters = [parameter_t('equilibrium_modulus', 'Pa'), &
            parameter_t('relaxing_modulus', 'Pa'), parameter_t('exponent', '1'), &
            parameter_t('time', 's')]
      case default
         allocate (parameters(0))
      end select
   end function parameters_of

   !> What a parameter that may be 0 is compared with: the least modulus, or the rate that is seen
   !> at the last time
   elemental function unit_of(name, samples) result(value)
      !> Name of the parameter
      character(len=*), intent(in) :: name
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Value in the unit of the parameter; 0 where it may not be 0
      real(wp) :: value

      select case (name)
      case ('equilibrium_modulus')
         value = minval(samples%modulus)
      case ('alpha')
         value = 1.0_wp/samples%last_time()
      case default
         value = 0.0_wp
      end select
   end function unit_of

   !> Note which parameters are free, and set their bounds
   subroutine set_free(problem)
      !> The problem
      type(problem_t), intent(inout) :: problem

      real(wp) :: shortest, longest, softest, hardest
      integer :: i, k

      problem%free = pack([(i, i=1, size(problem%parameters))], &
         problem%parameters%state == state_free)
      if (allocated(problem%lower)) deallocate (problem%lower, problem%upper)
      allocate (problem%lower(size(problem%free)), problem%upper(size(problem%free)))
      shortest = problem%samples%first_time()/problem%widest
      longest = problem%samples%last_time()*problem%widest
      softest = minval(problem%samples%modulus)/widest_modulus
      hardest = maxval(problem%samples%modulus)*widest_modulus
      do i = 1, size(problem%free)
         k = problem%free(i)
         associate (lower => problem%lower(i), upper => problem%upper(i))
            select case (problem%parameters(k)%name)
            case ('exponent')
               lower = log(least_exponent)
               upper = log(most_exponent)
            case ('time')
               lower = log(shortest)
               upper = log(longest)
            case ('alpha')
               lower = log(0.01_wp*nothing*unit_of('alpha', problem%samples))
               upper = -log(shortest)
            case ('beta')
               lower = -log(longest)
               upper = -log(shortest)
               if (problem%model == 'cerf') then
                  lower = 0.5_wp*lower
                  upper = 0.5_wp*upper
               end if
            case ('equilibrium_modulus')
               lower = log(0.01_wp*nothing*unit_of('equilibrium_modulus', problem%samples))
               upper = log(hardest)
            case default
               lower = log(softest)
               upper = log(hardest)
            end select
         end associate
         ! C t^-a may have any C where a is any
         if (problem%parameters(k)%name == 'coefficient') then
            problem%lower(i) = log(softest) + min(0.0_wp, log(shortest))
            problem%upper(i) = log(hardest) + max(0.0_wp, log(longest))
         end if
      end do
   end subroutine set_free

   !> Make what has come to its bound free again, and the bounds wider
   subroutine release(problem)
      !> The problem
      type(problem_t), intent(inout) :: problem

      where (problem%parameters%state == state_bound) problem%parameters%state = state_free
      problem%widest = widest_error
      call set_free(problem)
   end subroutine release

   !> Unknowns of the values of the parameters, within the bounds
   pure function unknowns_of(problem) result(x)
      !> The problem
      type(problem_t), intent(in) :: problem
      !> Logarithms of the free parameters
      real(wp) :: x(size(problem%free))

      associate (free => problem%parameters(problem%free))
         x = log(max(free%value, little*unit_of(free%name, problem%samples)))
      end associate
      x = max(problem%lower, min(problem%upper, x))
   end function unknowns_of

   !> A model with parameters as the description of a material
   pure function described(model, parameters) result(data)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Its parameters
      type(parameter_t), intent(in) :: parameters(:)
      !> The description
      type(material_data_t) :: data

      integer :: i

      data%name = model
      data%model = model
      do i = 1, size(parameters)
         call data%set(trim(parameters(i)%name), parameters(i)%value)
      end do
      ! the rubbery modulus does not exceed the glassy one
      if (model == 'sls') call data%set('alpha', min(data%number('alpha'), data%number('beta')))
   end function described

   !> Residuals: logarithms of model over data
   subroutine residuals(self, x, r)
      !> The problem
      class(problem_t), intent(in) :: self
      !> Logarithms of the free parameters
      real(wp), intent(in) :: x(:)
      !> Residuals
      real(wp), intent(out) :: r(:)

      type(parameter_t) :: parameters(size(self%parameters))

      parameters = self%parameters
      parameters(self%free)%value = exp(x)
      r = misfit(self%model, parameters, self%samples)
   end subroutine residuals

   !> Logarithms of model over data
   function misfit(model, parameters, samples) result(r)
      !> Name of the model
      character(len=*), intent(in) :: model
      !> Its parameters
      type(parameter_t), intent(in) :: parameters(:)
      !> The samples
      type(samples_t), intent(in) :: samples
      !> Logarithms
      real(wp) :: r(samples%count())

      !> What stands for a model that is nothing there
      real(wp), parameter :: far_off = 1.0e3_wp
      class(material_t), allocatable :: material
      type(error_t), allocatable :: error

      call new_material(material, described(model, parameters), error)
      if (allocated(error)) then
         r = far_off
      else
         r = log(max(moduli_of(material, samples), tiny(1.0_wp))/samples%all())
      end if
   end function misfit

   !> Derivatives of the residuals, by central differences
   subroutine jacobian(self, x, j)
      !> The problem
      class(problem_t), intent(in) :: self
      !> Logarithms of the free parameters
      real(wp), intent(in) :: x(:)
      !> Derivatives
      real(wp), intent(out) :: j(:, :)

      real(wp) :: up(size(x)), down(size(x)), r(size(j, 1))
      integer :: i

      do i = 1, size(x)
         up = x
         down = x
         up(i) = min(x(i) + step, self%upper(i))
         down(i) = max(x(i) - step, self%lower(i))
         call self%residuals(up, j(:, i))
         call self%residuals(down, r)
         j(:, i) = (j(:, i) - r)/(up(i) - down(i))
      end do
   end subroutine jacobian

end module vcor_fit_problem
