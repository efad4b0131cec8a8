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

   public :: put_material, put_points, put_solver, material_text

contains

   !> Set the model and all numbers of a material of a case; its name, density and Poisson's ratio
   !> stay
   subroutine put_material(case, item, data)
      !> The case; it need not be validated again
      type(case_t), intent(inout) :: case
      !> Number of the material
      integer, intent(in) :: item
      !> The material
      type(material_data_t), intent(in) :: data

      type(parameter_t), allocatable :: parameters(:)
      integer :: i

      call put(case, item, 'model', word=data%model)
      allocate (parameters, source=parameters_of(data%model))
      do i = 1, size(parameters)
         if (.not. parameters(i)%fitted .or. parameters(i)%is_list) cycle
         call put_number(case, item, parameters(i)%name, data%number(parameters(i)%name))
      end do
      if (data%model /= 'prony') return
      call put(case, item, 'moduli', list=data%list('moduli'))
      call put(case, item, 'times', list=1.0_wp/data%list('rates'))
   end subroutine put_material

   !> Make a material of a case one that is given by points
   subroutine put_points(case, item, times, moduli)
      !> The case; it need not be validated again
      type(case_t), intent(inout) :: case
      !> Number of the material
      integer, intent(in) :: item
      !> Times [s], shape (n)
      real(wp), intent(in) :: times(:)
      !> Moduli [Pa], shape (n)
      real(wp), intent(in) :: moduli(:)

      call put(case, item, 'model', word='table')
      call put(case, item, 'times', list=times)
      call put(case, item, 'moduli', list=moduli)
   end subroutine put_points

   !> Have the impact of a case solved by product integration, with steps as they are needed
   subroutine put_solver(case, accuracy)
      !> The case; it need not be validated again
      type(case_t), intent(inout) :: case
      !> Wanted error of the restitution [-]
      real(wp), intent(in) :: accuracy

      call case%set(case%address('solver', 'method'), 'direct', given=.true.)
      call case%set(case%address('solver', 'scheme'), 'product', given=.true.)
      call case%set(case%address('solver', 'accuracy'), accuracy)
      call case%unset(case%address('solver', 'time_step'))
   end subroutine put_solver

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
      call put(case, item, 'name', word=data%name)
      call put_material(case, item, data)
      if (density > 0.0_wp) call put_number(case, item, 'density', density)
      call put_number(case, item, 'poisson_ratio', poisson_ratio)
      call put_number(case, item, 'valid_from', valid_from)
      call put_number(case, item, 'valid_to', valid_to)
      text = case_text(case, complete=.false., remarks=.true.)
   end function material_text

   !> Set a number
   subroutine put_number(case, item, key, number)
      !> The case
      type(case_t), intent(inout) :: case
      !> Number of the material
      integer, intent(in) :: item
      !> Name of the key
      character(len=*), intent(in) :: key
      !> The number
      real(wp), intent(in) :: number

      call case%set(case%address('material', key, item), number)
   end subroutine put_number

   !> Set a text or a list
   subroutine put(case, item, key, word, list)
      !> The case
      type(case_t), intent(inout) :: case
      !> Number of the material
      integer, intent(in) :: item
      !> Name of the key
      character(len=*), intent(in) :: key
      !> The text, where the key takes one
      character(len=*), intent(in), optional :: word
      !> The list, where the key takes one, shape (n)
      real(wp), intent(in), optional :: list(:)

      if (present(word)) call case%set(case%address('material', key, item), word, given=.true.)
      if (present(list)) call case%set(case%address('material', key, item), list, given=.true.)
   end subroutine put

end module vcor_case_identified
