!> Impacts of the verification table: a sphere, mostly rigid, on a plate of one material
!>
!> The sphere and the plate are those of Green's paper unless a law needs others: a ball of 10 mm
!> radius and 7800 kg/m3 on a plate of 20 mm half thickness, 1100 kg/m3 and Poisson's ratio 0.5.
module vcor_verify_impacts
   use vcor_constants, only : pi
   use vcor_error, only : error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus, pair_series
   use vcor_impact_law, only : contact_law_t
   use vcor_impact_plate, only : new_plate, plate_t, waves_none
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_material_prony, only : new_rigid, prony_t
   implicit none
   private

   public :: strike, zener_plate, hertz_scale, hertz_duration, elastic, sls, kelvin_voigt

   !> Duration of Hertz's impact in units of T, (4/5) B(2/5, 1/2) (5/4)^(2/5) = 3.2180654597190435;
   !> anew, not the constant that the solvers use [-]
   real(wp), parameter :: hertz_duration = 0.8_wp*1.25_wp**0.4_wp &
      *gamma(0.4_wp)*gamma(0.5_wp)/gamma(0.9_wp)
   !> Velocity of the paper's first impact [m/s]
   real(wp), parameter :: usual_velocity = 10.0_wp
   !> Radius of the paper's sphere [m]
   real(wp), parameter :: usual_radius = 0.01_wp
   !> Density of the paper's sphere [kg/m3]
   real(wp), parameter :: sphere_density = 7800.0_wp
   !> Density of the paper's plates [kg/m3]
   real(wp), parameter :: plate_density = 1100.0_wp
   !> Half thickness of the paper's plates [m]
   real(wp), parameter :: usual_half_thickness = 0.02_wp

contains

   !> A sphere strikes a material; the first error stays
   subroutine strike(impact, error, material, waves, velocity, mass, radius, half_thickness, &
                     receding, sphere)
      !> The impact
      type(impact_t), intent(out) :: impact
      !> Unallocated on success
      type(error_t), allocatable, intent(inout) :: error
      !> The material, of any model
      type(material_data_t), intent(in) :: material
      !> One of the `waves_*` constants; absent: the plate does not move
      integer, intent(in), optional :: waves
      !> Velocity [m/s]; absent: the paper's
      real(wp), intent(in), optional :: velocity
      !> Mass of the sphere [kg]; absent: the paper's
      real(wp), intent(in), optional :: mass
      !> Radius of the sphere [m]; absent: the paper's
      real(wp), intent(in), optional :: radius
      !> Half thickness of the plate [m]; absent: the paper's
      real(wp), intent(in), optional :: half_thickness
      !> Whether the contact is receding; absent: the force is that of all the past
      logical, intent(in), optional :: receding
      !> Material of the sphere, in series with the plate's; absent: it is rigid
      type(material_data_t), intent(in), optional :: sphere

      class(material_t), allocatable :: body, ball
      type(prony_t) :: rigid
      type(contact_modulus_t) :: modulus
      type(plate_t) :: plate
      type(contact_law_t) :: law
      type(error_t), allocatable :: trouble
      real(wp) :: v, m, r, h
      integer :: model

      if (allocated(error)) return
      model = waves_none
      if (present(waves)) model = waves
      v = usual_velocity
      if (present(velocity)) v = velocity
      m = 4.0_wp/3.0_wp*pi*usual_radius**3*sphere_density
      if (present(mass)) m = mass
      r = usual_radius
      if (present(radius)) r = radius
      if (present(receding)) law%receding = receding
      h = usual_half_thickness
      if (present(half_thickness)) h = half_thickness

      call make_body(body, material, trouble)
      if (present(sphere)) then
         if (.not. allocated(trouble)) call make_body(ball, sphere, trouble)
      else
         call new_rigid(rigid)
         allocate (ball, source=rigid)
      end if
      if (.not. allocated(trouble)) &
         call new_contact_modulus(modulus, ball, body, .false., trouble, pair_series)
      if (.not. allocated(trouble)) call new_plate(plate, body, h, model, trouble)
      if (.not. allocated(trouble)) &
         call new_impact(impact, v, m, r, 0.0_wp, modulus, plate, trouble, law)
      if (allocated(trouble)) call move_alloc(trouble, error)
   end subroutine strike

   !> A material of the plates' density
   subroutine make_body(body, material, error)
      !> The material
      class(material_t), allocatable, intent(out) :: body
      !> Its description
      type(material_data_t), intent(in) :: material
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(material_data_t) :: data

      data = material
      data%name = 'body'
      call data%set('density', plate_density)
      call new_material(body, data, error)
   end subroutine make_body

   !> A rigid sphere strikes a plate of a given lambda, which falls with the square of the thickness
   subroutine zener_plate(impact, error, material, waves, lambda)
      !> The impact
      type(impact_t), intent(out) :: impact
      !> Unallocated on success
      type(error_t), allocatable, intent(inout) :: error
      !> The material
      type(material_data_t), intent(in) :: material
      !> One of the `waves_*` constants, not none
      integer, intent(in) :: waves
      !> Zener's parameter [-], > 0
      real(wp), intent(in) :: lambda

      call strike(impact, error, material, waves)
      if (allocated(error)) return
      call strike(impact, error, material, waves, &
         half_thickness=usual_half_thickness*sqrt(impact%inelasticity()/lambda))
   end subroutine zener_plate

   !> Time scale T = (m/(k sqrt(v0)))^(2/5) of an impact, by the modulus it has after a long time
   pure function hertz_scale(impact) result(scale)
      !> The impact
      type(impact_t), intent(in) :: impact
      !> Time scale [s]
      real(wp) :: scale

      scale = (impact%mass/(impact%hertz_factor*impact%modulus%rubbery()*sqrt(impact%velocity))) &
         **0.4_wp
   end function hertz_scale

   !> An elastic material
   pure function elastic(modulus) result(data)
      !> Young's modulus [Pa]
      real(wp), intent(in) :: modulus
      !> Its description
      type(material_data_t) :: data

      data%model = 'elastic'
      call data%set('modulus', modulus)
   end function elastic

   !> A standard linear solid
   pure function sls(glassy_modulus, alpha, beta) result(data)
      !> Modulus at first [Pa]
      real(wp), intent(in) :: glassy_modulus
      !> Rate alpha [1/s]
      real(wp), intent(in) :: alpha
      !> Rate of relaxation [1/s]
      real(wp), intent(in) :: beta
      !> Its description
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
      !> Its description
      type(material_data_t) :: data

      data%model = 'prony'
      call data%set('equilibrium_modulus', modulus)
      call data%set('viscosity', viscosity)
   end function kelvin_voigt

end module vcor_verify_impacts
