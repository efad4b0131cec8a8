!> Generalised Maxwell solid, a Prony series with an optional dashpot in parallel:
!> E(t) = E_0 + sum_i E_i exp(-b_i t) + viscosity delta(t). The elastic solid has no exponential,
!> the standard linear solid one; a rigid body is an elastic solid of infinite modulus
module vcor_material_prony
   use, intrinsic :: ieee_arithmetic, only : ieee_positive_inf, ieee_value
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : unset, wp
   use vcor_material_exponential_sum, only : exponential_sum_t
   use vcor_number, only : not_negative, positive
   use vcor_material_type, only : check_values, equilibrium_modulus, material_t, &
      parameter_t, poisson_ratio
   implicit none
   private

   public :: prony_t, new_prony, new_sls, new_elastic, new_rigid
   public :: prony_parameters, sls_parameters, elastic_parameters, rigid_parameters

   !> Parameters of model `rigid`
   type(parameter_t), parameter :: rigid_parameters(*) = [ &
      parameter_t('poisson_ratio', "Poisson's ratio (has no effect)", '', poisson_ratio%range, &
      required=.false.)]
   !> Parameters of model `elastic`
   type(parameter_t), parameter :: elastic_parameters(*) = [poisson_ratio, &
      parameter_t('modulus', "Young's modulus", 'Pa', positive)]
   !> Parameters of model `sls`
   type(parameter_t), parameter :: sls_parameters(*) = [poisson_ratio, &
      parameter_t('glassy_modulus', 'Modulus at time zero', 'Pa', positive), &
      parameter_t('alpha', 'Rate; rubbery modulus = glassy_modulus*alpha/beta', '1/s', &
      not_negative), &
      parameter_t('beta', 'Rate of relaxation', '1/s', not_negative)]
   !> Parameters of model `prony`; a fit determines `times`
   type(parameter_t), parameter :: prony_parameters(*) = [poisson_ratio, equilibrium_modulus, &
      parameter_t('moduli', 'Moduli of the relaxing terms', 'Pa', positive, required=.false., &
      is_list=.true.), &
      parameter_t('rates', 'Rates of the relaxing terms; or give times', '1/s', positive, &
      required=.false., is_list=.true., instead='times'), &
      parameter_t('times', 'Relaxation times of the terms; or give rates', 's', positive, &
      required=.false., is_list=.true.), &
      parameter_t('viscosity', 'Viscosity of a dashpot in parallel', 'Pa s', not_negative, &
      required=.false., default='0.0')]

   !> E(t) = E_0 + sum_i E_i exp(-b_i t) + viscosity delta(t), Eqs. (17) and (26)
   type, extends(material_t) :: prony_t
      private
      !> The series without its dashpot
      type(exponential_sum_t) :: terms = exponential_sum_t(unset, null(), null())
   contains
      procedure :: relaxation
      procedure :: relaxation_at
      procedure :: rate
      procedure :: integral
      procedure :: complex_modulus
      procedure :: glassy
      procedure :: rubbery
      procedure :: exponentials
   end type prony_t

contains

   !> Build a Prony series
   pure subroutine new_prony(self, equilibrium, moduli, rates, viscosity, error)
      type(prony_t), intent(out) :: self
      !> Equilibrium modulus [Pa], >= 0
      real(wp), intent(in) :: equilibrium
      !> Moduli of the terms [Pa], > 0, shape (n)
      real(wp), intent(in) :: moduli(:)
      !> Rates of the terms [1/s], > 0, shape (n)
      real(wp), intent(in) :: rates(:)
      !> Viscosity of the dashpot [Pa s], >= 0
      real(wp), intent(in) :: viscosity
      type(error_t), allocatable, intent(out) :: error

      if (size(moduli) /= size(rates)) then
         call raise(error, error_input, 'a Prony series needs as many rates as moduli, or as ' &
            //'many times', about='rates times moduli')
      else if (.not. (all(moduli > 0.0_wp) .and. all(rates > 0.0_wp))) then
         call raise(error, error_input, 'the moduli and rates of a Prony series must be positive')
      else if (.not. all([moduli, rates, equilibrium, viscosity] <= huge(1.0_wp))) then
         call raise(error, error_input, 'the numbers of a Prony series must be finite')
      else if (.not. (equilibrium >= 0.0_wp .and. viscosity >= 0.0_wp)) then
         call raise(error, error_input, &
            'equilibrium modulus and viscosity of a Prony series must not be negative')
      else if (.not. equilibrium + sum(moduli) + viscosity > 0.0_wp) then
         call raise(error, error_input, 'no stiffness, expected moduli, viscosity > 0 or ' &
            //'equilibrium_modulus > 0', about='moduli viscosity equilibrium_modulus')
      end if
      if (allocated(error)) return

      self%terms%equilibrium = equilibrium
      allocate (self%terms%moduli, source=moduli)
      allocate (self%terms%rates, source=rates)
      self%viscosity = viscosity
      self%discrete = .true.
   end subroutine new_prony

   !> Build the standard linear solid of Eq. (13): E_g (a/b + (1 - a/b) exp(-b t)). For b = 0 it is
   !> the elastic solid E_g, the limit with which the paper checks its scheme
   pure subroutine new_sls(self, glassy_modulus, alpha, beta, error)
      type(prony_t), intent(out) :: self
      !> Glassy modulus E_g [Pa], > 0
      real(wp), intent(in) :: glassy_modulus
      !> Parameter a [1/s], 0 <= a <= b; the rubbery modulus is E_g a/b
      real(wp), intent(in) :: alpha
      !> Rate of relaxation b [1/s], >= 0
      real(wp), intent(in) :: beta
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: rubbery_fraction

      call check_values('sls', sls_parameters(2:), [glassy_modulus, alpha, beta], error)
      if (allocated(error)) return
      if (.not. beta >= alpha) then
         call raise(error, error_input, 'a standard linear solid needs 0 <= alpha <= beta, ' &
            //'or its rubbery modulus exceeds the glassy one', about='alpha beta')
      end if
      if (allocated(error)) return

      rubbery_fraction = 1.0_wp
      if (beta > 0.0_wp) rubbery_fraction = alpha/beta
      if (rubbery_fraction < 1.0_wp) then
         call new_prony(self, glassy_modulus*rubbery_fraction, &
            [glassy_modulus*(1.0_wp - rubbery_fraction)], [beta], 0.0_wp, error)
      else
         call new_elastic(self, glassy_modulus, error)
      end if
   end subroutine new_sls

   !> Build an elastic solid
   pure subroutine new_elastic(self, modulus, error)
      type(prony_t), intent(out) :: self
      !> Young's modulus [Pa], > 0
      real(wp), intent(in) :: modulus
      type(error_t), allocatable, intent(out) :: error

      real(wp), parameter :: none(0) = [real(wp) ::]

      call new_prony(self, modulus, none, none, 0.0_wp, error)
   end subroutine new_elastic

   !> Build a rigid body: all moduli are infinite
   pure subroutine new_rigid(self)
      type(prony_t), intent(out) :: self

      self%rigid = .true.
      self%terms%equilibrium = ieee_value(1.0_wp, ieee_positive_inf)
      allocate (self%terms%moduli(0), self%terms%rates(0))
   end subroutine new_rigid

   !> Relaxation modulus E(t) for t > 0
   elemental function relaxation(self, t) result(value)
      class(prony_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Modulus [Pa]
      real(wp) :: value

      value = self%terms%value(t)
   end function relaxation

   !> Relaxation modulus E(t) at many times; the loop over times is vectorised for each term
   pure subroutine relaxation_at(self, t, value)
      class(prony_t), intent(in) :: self
      !> Times since the strain step [s], t >= 0
      real(wp), intent(in) :: t(:)
      !> Modulus [Pa], same shape
      real(wp), intent(out) :: value(:)

      integer :: i, j

      do j = 1, size(t)
         value(j) = self%terms%equilibrium
      end do
      if (.not. allocated(self%terms%moduli)) return
      do i = 1, size(self%terms%moduli)
         do j = 1, size(t)
            value(j) = value(j) + self%terms%moduli(i)*exp(-self%terms%rates(i)*t(j))
         end do
      end do
   end subroutine relaxation_at

   !> Rate of relaxation dE/dt
   elemental function rate(self, t) result(value)
      class(prony_t), intent(in) :: self
      !> Time since the strain step [s], t >= 0
      real(wp), intent(in) :: t
      !> Rate [Pa/s], <= 0
      real(wp) :: value

      value = unset
      if (allocated(self%terms%moduli)) &
         value = -sum(self%terms%moduli*self%terms%rates*exp(-self%terms%rates*t))
   end function rate

   !> Integral of E from 0 to t: E_0 t + sum E_i (1 - exp(-b_i t))/b_i
   elemental function integral(self, t) result(value)
      class(prony_t), intent(in) :: self
      !> Upper limit [s], t >= 0
      real(wp), intent(in) :: t
      !> Integral [Pa s]
      real(wp) :: value

      value = self%terms%integral(t)
   end function integral

   !> Complex modulus E_0 + sum E_i s/(s + b_i) + viscosity s, Eq. (27)
   elemental function complex_modulus(self, s) result(modulus)
      class(prony_t), intent(in) :: self
      !> Laplace variable [1/s], not at -b_i
      complex(wp), intent(in) :: s
      !> Complex modulus [Pa]
      complex(wp) :: modulus

      modulus = self%terms%complex_modulus(s) + self%viscosity*s
   end function complex_modulus

   !> Glassy modulus E_0 + sum E_i, without the dashpot
   pure function glassy(self) result(modulus)
      class(prony_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = self%terms%value(0.0_wp)
   end function glassy

   !> Rubbery modulus E_0
   pure function rubbery(self) result(modulus)
      class(prony_t), intent(in) :: self
      !> Modulus [Pa]
      real(wp) :: modulus

      modulus = self%terms%equilibrium
   end function rubbery

   !> The series itself; window and accuracy have no effect
   pure subroutine exponentials(self, window, accuracy, terms)
      class(prony_t), intent(in) :: self
      !> Time up to which the sum is to hold [s]
      real(wp), intent(in) :: window
      !> Wanted relative accuracy
      real(wp), intent(in) :: accuracy
      !> The series
      type(exponential_sum_t), intent(out) :: terms

      associate (not_needed => [window, accuracy])
      end associate
      terms = self%terms
      terms%viscosity = self%viscosity
   end subroutine exponentials

end module vcor_material_prony
