!> From a validated case to the impact and its solver
module vcor_study_build
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_constants, only : pi
   use vcor_error, only : error_t
   use vcor_impact_contact, only : contact_modulus_t, new_contact_modulus
   use vcor_impact_plate, only : new_plate, plate_t, waves_constant, waves_frozen, &
      waves_none, waves_relaxing
   use vcor_impact_problem, only : impact_t, new_impact
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_solver, only : new_solver, solver_settings_t, solver_t
   use vcor_study_case, only : case_t
   implicit none
   private

   public :: build_impact, build_material, build_solver

contains

   !> The impact that a case describes
   subroutine build_impact(case, impact, error)
      !> A validated case
      type(case_t), intent(in) :: case
      !> The impact
      type(impact_t), intent(out) :: impact
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      class(material_t), allocatable :: sphere, surface
      type(contact_modulus_t) :: modulus
      type(plate_t) :: plate
      character(len=:), allocatable :: waves
      real(wp) :: radius, mass
      integer :: sphere_item, plate_item, model

      call named_material(case, 'sphere', sphere_item, sphere, error)
      if (allocated(error)) return
      call named_material(case, 'plate', plate_item, surface, error)
      if (allocated(error)) return

      call new_contact_modulus(modulus, sphere, surface, sphere_item == plate_item, error)
      if (allocated(error)) then
         call locate(case, 'plate', 'material', error)
         return
      end if

      call case%get('plate', 'waves', waves)
      select case (waves)
      case ('none')
         model = waves_none
      case ('constant')
         model = waves_constant
      case ('frozen')
         model = waves_frozen
      case default
         model = waves_relaxing
      end select
      call new_plate(plate, surface, number(case, 'plate', 'half_thickness'), model, error)
      if (allocated(error)) then
         call locate(case, 'plate', 'waves', error)
         return
      end if

      radius = number(case, 'sphere', 'radius')
      mass = 4.0_wp/3.0_wp*pi*radius**3*sphere%density
      if (case%given('sphere', 'mass')) mass = number(case, 'sphere', 'mass')
      call new_impact(impact, number(case, 'impact', 'velocity'), mass, radius, &
         number(case, 'plate', 'surface_radius'), modulus, plate, error)
      if (allocated(error)) call locate(case, 'sphere', 'radius', error)
   end subroutine build_impact

   !> The solver that a case asks for
   subroutine build_solver(case, impact, solver, error)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Its impact
      type(impact_t), intent(in) :: impact
      !> The solver
      class(solver_t), allocatable, intent(out) :: solver
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(solver_settings_t) :: settings
      integer :: order

      call case%get('solver', 'method', settings%method)
      call case%get('solver', 'scheme', settings%scheme)
      call case%get('solver', 'form', settings%form)
      call case%get('solver', 'quadrature', settings%quadrature)
      settings%time_step = number(case, 'solver', 'time_step')
      settings%end_time = number(case, 'solver', 'end_time')
      settings%accuracy = number(case, 'solver', 'accuracy')
      call case%get('solver', 'volterra_order', order)
      if (order == 2) &
         settings%second_coefficient = number(case, 'solver', 'volterra_coefficient')
      call case%get('solver', 'continue_after_separation', settings%ghost)
      call new_solver(solver, settings, impact, error)
      if (.not. allocated(error)) return
      if (settings%scheme == 'product') then
         call locate(case, 'solver', 'method', error)
      else
         call locate(case, 'solver', 'scheme', error)
      end if
   end subroutine build_solver

   !> The material that a body names
   subroutine named_material(case, body, item, material, error)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Group of the body: sphere or plate
      character(len=*), intent(in) :: body
      !> Item of the material
      integer, intent(out) :: item
      !> The material
      class(material_t), allocatable, intent(out) :: material
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: name

      call case%get(body, 'material', name)
      item = case%find_material(name)
      call build_material(case, item, material, error)
   end subroutine named_material

   !> A material of a case
   subroutine build_material(case, item, material, error)
      !> A validated case
      type(case_t), intent(in) :: case
      !> Number of the material
      integer, intent(in) :: item
      !> The material
      class(material_t), allocatable, intent(out) :: material
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(material_data_t) :: data

      call case%get('material', 'name', data%name, item)
      call case%get('material', 'model', data%model, item)
      data%density = number(case, 'material', 'density', item)
      if (case%has_value('material', 'poisson_ratio', item)) &
         call case%get('material', 'poisson_ratio', data%poisson_ratio, item)
      data%modulus = number(case, 'material', 'modulus', item)
      data%glassy_modulus = number(case, 'material', 'glassy_modulus', item)
      data%alpha = number(case, 'material', 'alpha', item)
      data%beta = number(case, 'material', 'beta', item)
      data%equilibrium_modulus = number(case, 'material', 'equilibrium_modulus', item)
      call case%get('material', 'moduli', data%moduli, item)
      call case%get('material', 'times', data%times, item)
      if (case%given('material', 'times', item)) then
         data%rates = 1.0_wp/data%times
      else
         call case%get('material', 'rates', data%rates, item)
      end if
      data%viscosity = number(case, 'material', 'viscosity', item)
      data%coefficient = number(case, 'material', 'coefficient', item)
      data%exponent = number(case, 'material', 'exponent', item)
      data%relaxing_modulus = number(case, 'material', 'relaxing_modulus', item)
      data%time = number(case, 'material', 'time', item)
      call new_material(material, data, error)
      if (allocated(error)) call locate(case, 'material', 'name', error, item)
   end subroutine build_material

   !> Value of a real key, 0 where there is none
   function number(case, group, key, item) result(value)
      !> A case
      type(case_t), intent(in) :: case
      !> Group
      character(len=*), intent(in) :: group
      !> Key
      character(len=*), intent(in) :: key
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item
      !> Value
      real(wp) :: value

      call case%get(group, key, value, item)
      if (ieee_is_nan(value)) value = 0.0_wp
   end function number

   !> Say in an error where in the case its cause stands
   subroutine locate(case, group, key, error, item)
      !> A case
      type(case_t), intent(in) :: case
      !> Group
      character(len=*), intent(in) :: group
      !> Key
      character(len=*), intent(in) :: key
      !> The error
      type(error_t), intent(inout) :: error
      !> Number of the item; absent: 1
      integer, intent(in), optional :: item

      error%message = case%location(group, key, item)//': '//error%message
   end subroutine locate

end module vcor_study_build
