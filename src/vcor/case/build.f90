!> From a validated case to the impact and its solver
module vcor_case_build
   use vcor_error, only : error_t
   use vcor_impact_problem, only : impact_t
   use vcor_material, only : material_data_t, material_t, new_material
   use vcor_solver, only : new_solver, solver_settings_t, solver_t
   use vcor_case_blueprint, only : blueprint_t, new_blueprint, place_t, solver_place
   use vcor_case_case, only : case_t
   use vcor_case_describe, only : describe_material, describe_solver
   implicit none
   private

   public :: build_impact, build_material, build_solver, locate

contains

   !> The impact that a case describes; what a sweep varies is as the case has it
   subroutine build_impact(case, impact, error)
      !> A validated case
      type(case_t), intent(in) :: case
      !> The impact
      type(impact_t), intent(out) :: impact
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(blueprint_t) :: blueprint
      type(place_t) :: cause, none(0)

      call new_blueprint(blueprint, case, none, error, cause)
      if (.not. allocated(error)) call blueprint%build(impact, error, cause)
      if (allocated(error)) call locate(case, cause, error)
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

      call describe_solver(case, settings)
      call new_solver(solver, settings, impact, error)
      if (allocated(error)) call locate(case, solver_place(settings), error)
   end subroutine build_solver

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

      call describe_material(case, item, data)
      call new_material(material, data, error)
      if (allocated(error)) call locate(case, place_t('material', 'name', item), error)
   end subroutine build_material

   !> Say in an error where in the case its cause stands
   subroutine locate(case, cause, error)
      !> A case
      type(case_t), intent(in) :: case
      !> What the error is about
      type(place_t), intent(in) :: cause
      !> The error
      type(error_t), intent(inout) :: error

      error%message = case%location(trim(cause%group), trim(cause%key), cause%item)//': ' &
         //error%message
   end subroutine locate

end module vcor_case_build
