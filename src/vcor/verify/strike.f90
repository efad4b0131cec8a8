!> An impact of the verification table: a sphere, rigid unless a law says otherwise, on a plate
!>
!> The default sphere and plate are those of Green's paper: a ball of 10 mm radius and 7800 kg/m3 on
!> a plate of 20 mm half thickness, 1100 kg/m3 and Poisson's ratio 0.5. Time scale and lambda are
!> computed here independently of the impact that the solvers see.
module vcor_verify_strike
   use vcor_constants, only : pi
   use vcor_error, only : error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus, pair_series
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_plate, only : new_plate, plate_t, waves_none
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   implicit none
   private

   public :: strike_t, time_scale, zener_plate, hertz_duration, elastic, sls, kelvin_voigt
   public :: density

   !> Duration of Hertz's impact in units of T, (4/5) B(2/5, 1/2) (5/4)^(2/5) = 3.2180654597190435
   !> [-], independent of the constant that the solvers use
   real(wp), parameter :: hertz_duration = 0.8_wp*1.25_wp**0.4_wp &
      *gamma(0.4_wp)*gamma(0.5_wp)/gamma(0.9_wp)
   !> Density [kg/m3] and 1/(1 - nu^2) of the plates
   real(wp), parameter :: density = 1100.0_wp, plane_strain = 1.0_wp/(1.0_wp - 0.25_wp)

   !> A sphere strikes a plate
   type :: strike_t
      !> Material of the plate, of any model
      type(material_data_t) :: plate
      !> Material of the sphere, in series with the plate's; without a model: rigid
      type(material_data_t) :: sphere
      !> One of the `waves_*` constants
      integer :: waves = waves_none
      !> Whether the contact is receding
      logical :: receding = .false.
      !> Velocity [m/s]
      real(wp) :: velocity = 10.0_wp
      !> Mass of the sphere [kg]
      real(wp) :: mass = 4.0_wp/3.0_wp*pi*0.01_wp**3*7800.0_wp
      !> Radius of the sphere [m]
      real(wp) :: radius = 0.01_wp
      !> Half thickness of the plate [m]
      real(wp) :: half_thickness = 0.02_wp
   contains
      procedure :: get_impact
   end type strike_t

contains

   !> Build the impact, its equation of motion
   subroutine get_impact(self, impact, error)
      class(strike_t), intent(in) :: self
      type(impact_t), intent(out) :: impact
      type(error_t), allocatable, intent(out) :: error

      class(material_t), allocatable :: sphere, body
      type(material_data_t) :: ball
      type(contact_modulus_t) :: modulus
      type(plate_t) :: plate
      type(contact_law_t) :: law

      ball = self%sphere
      if (.not. allocated(ball%model)) ball%model = 'rigid'
      law%receding = self%receding
      call make_body(body, self%plate, error)
      if (.not. allocated(error)) call make_body(sphere, ball, error)
      if (.not. allocated(error)) &
         call new_contact_modulus(modulus, sphere, body, .false., error, pair_series)
      if (.not. allocated(error)) &
         call new_plate(plate, body, self%half_thickness, self%waves, error)
      if (.not. allocated(error)) call new_impact(impact, self%velocity, self%mass, self%radius, &
         0.0_wp, modulus, plate, error, law)
   end subroutine get_impact

   !> Build a material with the density of the plates
   subroutine make_body(body, material, error)
      class(material_t), allocatable, intent(out) :: body
      type(material_data_t), intent(in) :: material
      type(error_t), allocatable, intent(out) :: error

      type(material_data_t) :: data

      data = material
      data%name = 'body'
      if (data%model /= 'rigid') call data%set('density', density)
      call new_material(body, data, error)
   end subroutine make_body

   !> Time scale T = (m/(k sqrt(v0)))^(2/5), k = (4/3) sqrt(R) E/(1 - nu^2), of a rigid sphere [s]
   pure function time_scale(strike, modulus) result(scale)
      type(strike_t), intent(in) :: strike
      !> Young's modulus E of the plate [Pa]
      real(wp), intent(in) :: modulus
      real(wp) :: scale

      scale = (strike%mass/(4.0_wp/3.0_wp*sqrt(strike%radius)*plane_strain*modulus &
         *sqrt(strike%velocity)))**0.4_wp
   end function time_scale

   !> A rigid sphere on an elastic plate of given lambda = alpha m/T, with
   !> alpha = sqrt(3 rho/E')/(16 rho h^2), which falls with the square of the half thickness h
   pure function zener_plate(modulus, waves, lambda) result(strike)
      !> Young's modulus [Pa]
      real(wp), intent(in) :: modulus
      !> One of the `waves_*` constants, except `waves_none`
      integer, intent(in) :: waves
      !> Zener's parameter [-], > 0
      real(wp), intent(in) :: lambda
      type(strike_t) :: strike

      strike = strike_t(elastic(modulus), waves=waves)
      strike%half_thickness = sqrt(sqrt(3.0_wp*density/(plane_strain*modulus)) &
         /(16.0_wp*density)*strike%mass/time_scale(strike, modulus)/lambda)
   end function zener_plate

   !> An elastic material
   pure function elastic(modulus) result(data)
      !> Young's modulus [Pa]
      real(wp), intent(in) :: modulus
      type(material_data_t) :: data

      data%model = 'elastic'
      call data%set('modulus', modulus)
   end function elastic

   !> A standard linear solid
   pure function sls(glassy_modulus, alpha, beta) result(data)
      !> Modulus at t = 0 [Pa]
      real(wp), intent(in) :: glassy_modulus
      !> Rates of Eq. (13) [1/s]: `beta` is the relaxation rate
      real(wp), intent(in) :: alpha, beta
      type(material_data_t) :: data

      data%model = 'sls'
      call data%set('glassy_modulus', glassy_modulus)
      call data%set('alpha', alpha)
      call data%set('beta', beta)
   end function sls

   !> A spring and a dashpot side by side
   pure function kelvin_voigt(modulus, viscosity) result(data)
      !> Modulus of the spring [Pa]
      real(wp), intent(in) :: modulus
      !> Viscosity of the dashpot [Pa s]
      real(wp), intent(in) :: viscosity
      type(material_data_t) :: data

      data%model = 'prony'
      call data%set('equilibrium_modulus', modulus)
      call data%set('viscosity', viscosity)
   end function kelvin_voigt

end module vcor_verify_strike
