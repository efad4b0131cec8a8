!> A linear viscoelastic material: all that solvers use of it, and the parameters of its models
module vcor_material_type
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : pi, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_number, only : interval_t, interval_text, is_within, not_negative, positive, real_text
   implicit none
   private

   public :: material_t
   public :: parameter_t, check_values, power_of_time
   public :: density, poisson_ratio, equilibrium_modulus, relaxing_modulus

   !> A material. Its modulus does not change after construction, so threads can share it; before,
   !> it is NaN
   type, abstract :: material_t
      !> Name in the case
      character(len=:), allocatable :: name
      !> Mass density [kg/m3]; 0 if unknown
      real(wp), private :: mass_density = 0.0_wp
      !> Poisson's ratio [-]
      real(wp), private :: nu = 0.5_wp
      !> Whether it is rigid: the modulus is infinite
      logical :: rigid = .false.
      !> Whether the modulus is a finite sum of exponentials, or is represented by the same one for
      !> every window and accuracy
      logical :: discrete = .false.
      !> Viscosity of a dashpot in parallel: E(t) has a term viscosity*delta(t) [Pa s], >= 0,
      !> which `relaxation` and `integral` leave out
      real(wp) :: viscosity = 0.0_wp
      !> Factor a_T by which the temperature has multiplied all times [-]
      real(wp) :: time_factor = 1.0_wp
   contains
      !> Relaxation modulus E(t)
      procedure(of_time_i), deferred :: relaxation
      procedure :: relaxation_at
      !> Rate of relaxation dE/dt
      procedure(of_time_i), deferred :: rate
      !> Integral of the relaxation modulus from 0 to t
      procedure(of_time_i), deferred :: integral
      !> Complex modulus s L{E}(s)
      procedure(complex_modulus_i), deferred :: complex_modulus
      procedure :: spectrum
      !> Glassy modulus E(0), infinite for a singular kernel
      procedure(limit_i), deferred :: glassy
      !> Rubbery modulus E(infinity)
      procedure(limit_i), deferred :: rubbery
      !> The modulus as a sum of exponentials
      procedure(exponentials_i), deferred :: exponentials
      procedure :: is_built
      procedure :: elastic
      procedure :: plane_strain_factor
      procedure :: density => density_of
      procedure :: poisson_ratio => poisson_ratio_of
      procedure :: set_constants
   end type material_t

   !> A parameter of a model, a number or a list. Each model states its parameters once, in its own
   !> file; the keys of `&material` and the checks of its constructor follow
   type :: parameter_t
      !> Name, which is the key in &material
      character(len=26) :: name = ''
      !> Meaning, one line
      character(len=72) :: meaning = ''
      !> Unit, blank for none
      character(len=8) :: unit = ''
      !> Range, in the unit above
      type(interval_t) :: range = interval_t()
      !> Whether it is required
      logical :: required = .true.
      !> Default as in a namelist; blank: none
      character(len=12) :: default = ''
      !> Whether it is a list of numbers
      logical :: is_list = .false.
      !> Parameter that may be given instead, but not in addition; blank: none
      character(len=26) :: instead = ''
   end type parameter_t

   !> Parameter of every material
   type(parameter_t), parameter :: density = parameter_t('density', &
      'Density; for a sphere without mass, and for a plate with waves', 'kg/m3', positive, &
      required=.false.)
   !> Parameter of every material that deforms
   type(parameter_t), parameter :: poisson_ratio = parameter_t('poisson_ratio', &
      "Poisson's ratio", '', interval_t(lower=-1.0_wp, lower_open=.true., upper=0.5_wp))
   !> Both, which `set_constants` sets
   type(parameter_t), parameter :: constants(*) = [density, poisson_ratio]
   !> Parameter of every model that may have an equilibrium modulus
   type(parameter_t), parameter :: equilibrium_modulus = parameter_t('equilibrium_modulus', &
      'Long-time modulus', 'Pa', not_negative, required=.false., default='0.0')
   !> Parameter of the fractional models with a finite glassy modulus
   type(parameter_t), parameter :: relaxing_modulus = parameter_t('relaxing_modulus', &
      'Part of the modulus that relaxes', 'Pa', positive)

   abstract interface
      !> A function of time
      elemental function of_time_i(self, t) result(value)
         import :: material_t, wp
         class(material_t), intent(in) :: self
         !> Time since the strain step [s], t >= 0
         real(wp), intent(in) :: t
         !> E [Pa], dE/dt [Pa/s] or the integral [Pa s]
         real(wp) :: value
      end function of_time_i

      !> A function of the Laplace variable
      elemental function complex_modulus_i(self, s) result(modulus)
         import :: material_t, wp
         class(material_t), intent(in) :: self
         !> Laplace variable [1/s], not on the negative real axis; i omega gives storage and loss
         complex(wp), intent(in) :: s
         !> Complex modulus [Pa]
         complex(wp) :: modulus
      end function complex_modulus_i

      !> A limit of the relaxation modulus
      pure function limit_i(self) result(modulus)
         import :: material_t, wp
         class(material_t), intent(in) :: self
         !> Modulus [Pa]
         real(wp) :: modulus
      end function limit_i

      !> The modulus as a sum of exponentials: exact if it is one, else an approximation
      pure subroutine exponentials_i(self, window, accuracy, terms)
         import :: exponential_sum_t, material_t, wp
         class(material_t), intent(in) :: self
         !> Time up to which the sum is to hold [s], > 0
         real(wp), intent(in) :: window
         !> Wanted relative accuracy, > 0
         real(wp), intent(in) :: accuracy
         !> The sum; `terms%error` is its estimated relative error
         type(exponential_sum_t), intent(out) :: terms
      end subroutine exponentials_i
   end interface

contains

   !> Relaxation modulus E(t) at many times, overridden by models with a faster way
   pure subroutine relaxation_at(self, t, value)
      class(material_t), intent(in) :: self
      !> Times since the strain step [s], t >= 0
      real(wp), intent(in) :: t(:)
      !> Modulus [Pa], same shape
      real(wp), intent(out) :: value(:)

      value = self%relaxation(t)
   end subroutine relaxation_at

   !> Relaxation spectrum l H(l) of E(t) = E_0 + int H(l) exp(-l t) dl, which is Im Q(-l + i0)/pi. A
   !> model with a narrow peak uses the distance from it, which the rate alone does not give to all
   !> digits
   elemental function spectrum(self, rate, beyond_peak) result(density)
      class(material_t), intent(in) :: self
      !> Rate l [1/s], > 0
      real(wp), intent(in) :: rate
      !> ln of the rate over that of the peak of the spectrum, if there is a narrow one
      real(wp), intent(in) :: beyond_peak
      !> Spectrum per ln(l) [Pa]
      real(wp) :: density

      associate (not_needed => beyond_peak)
      end associate
      density = aimag(self%complex_modulus(cmplx(-rate, 0.0_wp, wp)))/pi
   end function spectrum

   !> Factor from E to the plane-strain modulus: E' = E/(1 - nu^2), Eq. (1)
   elemental function plane_strain_factor(self) result(factor)
      class(material_t), intent(in) :: self
      !> 1/(1 - nu^2) [-]
      real(wp) :: factor

      factor = 1.0_wp/(1.0_wp - self%nu**2)
   end function plane_strain_factor

   !> Mass density
   elemental function density_of(self) result(density)
      class(material_t), intent(in) :: self
      !> Density [kg/m3], > 0; 0 if unknown
      real(wp) :: density

      density = self%mass_density
   end function density_of

   !> Poisson's ratio, constant in time
   elemental function poisson_ratio_of(self) result(poisson_ratio)
      class(material_t), intent(in) :: self
      !> The ratio [-], -1 < nu <= 0.5
      real(wp) :: poisson_ratio

      poisson_ratio = self%nu
   end function poisson_ratio_of

   !> Set density and Poisson's ratio, which do not affect the relaxation modulus; only while the
   !> material is being built, before threads share it
   pure subroutine set_constants(self, error, density, poisson_ratio)
      !> The material; unchanged on failure
      class(material_t), intent(inout) :: self
      !> Error of code `error_input`, unallocated if both are within their ranges
      type(error_t), allocatable, intent(out) :: error
      !> Density [kg/m3], > 0; absent: unchanged, initially unknown
      real(wp), intent(in), optional :: density
      !> Poisson's ratio, in (-1, 0.5]; absent: unchanged, initially 0.5
      real(wp), intent(in), optional :: poisson_ratio

      if (present(density)) call check_values('material', constants(1:1), [density], error)
      if (allocated(error)) return
      if (present(poisson_ratio)) &
         call check_values('material', constants(2:2), [poisson_ratio], error)
      if (allocated(error)) return
      if (present(density)) self%mass_density = density
      if (present(poisson_ratio)) self%nu = poisson_ratio
   end subroutine set_constants

   !> Whether the material has been built
   elemental function is_built(self)
      class(material_t), intent(in) :: self
      logical :: is_built

      is_built = .not. ieee_is_nan(self%rubbery())
   end function is_built

   !> Whether the modulus is constant: no relaxation, no flow
   pure function elastic(self)
      class(material_t), intent(in) :: self
      logical :: elastic

      elastic = .not. (self%glassy() > self%rubbery() .or. self%viscosity > 0.0_wp)
   end function elastic

   !> Check values against the ranges of their parameters
   pure subroutine check_values(what, parameters, values, error)
      !> Material model, for the message
      character(len=*), intent(in) :: what
      !> The parameters, shape (n)
      type(parameter_t), intent(in) :: parameters(:)
      !> Their values, shape (n)
      real(wp), intent(in) :: values(:)
      !> Error of code `error_input`, unallocated if all are within their ranges
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: unit
      integer :: i

      do i = 1, size(parameters)
         if (is_within(parameters(i)%range, values(i))) cycle
         unit = ''
         if (parameters(i)%unit /= '') unit = ' ['//trim(parameters(i)%unit)//']'
         call raise(error, error_input, what//', '//trim(parameters(i)%name)//': found ' &
            //real_text(values(i))//', expected a number ' &
            //interval_text(parameters(i)%range)//unit, about=trim(parameters(i)%name))
         return
      end do
   end subroutine check_values

   !> Power of time in a unit of times, rates or their roots; 0 for others
   elemental function power_of_time(unit) result(power)
      character(len=*), intent(in) :: unit
      real(wp) :: power

      power = merge(1.0_wp, 0.0_wp, unit == 's')
      if (unit == '1/s') power = -1.0_wp
      if (unit == 's^1/2') power = 0.5_wp
      if (unit == 's^-1/2') power = -0.5_wp
   end function power_of_time

end module vcor_material_type
