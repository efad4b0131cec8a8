!> A material that was found by a fit, as a group of a case and in the place of another
module vcor_case_identified
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t, parameters_of
   use vcor_material_parameter, only : parameter_t
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : find_group
   use vcor_case_printed, only : case_text
   implicit none
   private

   public :: put_material, take_as_is, material_text

contains

   !> Set the model and all numbers of a material of a case; its name, density and Poisson's ratio
   !> stay
   subroutine put_material(case, item, data)
      !> The case; it need not be validated again
      type(case_t), intent(inout) :: case
      !> Number of the material
      integer, intent(in) :: item
      type(material_data_t), intent(in) :: data

      type(parameter_t), allocatable :: parameters(:)
      integer :: i

      call case%set(case%address('material', 'model', item), data%model, given=.true.)
      call take_as_is(case, item)
      allocate (parameters, source=parameters_of(data%model))
      do i = 1, size(parameters)
         if (.not. parameters(i)%fitted .or. parameters(i)%is_list) cycle
         associate (name => parameters(i)%name)
            call case%set(case%address('material', name, item), data%number(name))
         end associate
      end do
      if (data%model /= 'prony') return
      call case%set(case%address('material', 'moduli', item), data%list('moduli'), given=.true.)
      call case%set(case%address('material', 'times', item), 1.0_wp/data%list('rates'), &
         given=.true.)
   end subroutine put_material

   !> Let the moduli of a material be those of the impact: tensile, at its temperature
   pure subroutine take_as_is(case, item)
      type(case_t), intent(inout) :: case
      !> Number of the material
      integer, intent(in) :: item

      call case%unset(case%address('material', 'modulus_kind', item))
      call case%unset(case%address('material', 'shift', item))
   end subroutine take_as_is

   !> A material as a &material group
   function material_text(data, density, poisson_ratio, valid_from, valid_to) result(text)
      !> The material, with its name
      type(material_data_t), intent(in) :: data
      !> Density [kg/m3]; 0: not known
      real(wp), intent(in) :: density
      !> Poisson's ratio [-]
      real(wp), intent(in) :: poisson_ratio
      !> First time that the model was fitted to [s]
      real(wp), intent(in) :: valid_from
      !> Last time that the model was fitted to [s]
      real(wp), intent(in) :: valid_to
      !> The group, each key with its unit and meaning
      character(len=:), allocatable :: text

      type(case_t) :: case
      integer :: item

      call case%start('fit')
      call case%add(find_group('material'), 0, item)
      call case%set(case%address('material', 'name'), data%name, given=.true.)
      call put_material(case, item, data)
      if (density > 0.0_wp) call case%set(case%address('material', 'density'), density)
      call case%set(case%address('material', 'poisson_ratio'), poisson_ratio)
      call case%set(case%address('material', 'valid_from'), valid_from)
      call case%set(case%address('material', 'valid_to'), valid_to)
      text = case_text(case, complete=.false., remarks=.true.)
   end function material_text

end module vcor_case_identified
