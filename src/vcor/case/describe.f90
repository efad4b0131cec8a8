!> Parts of a case as the descriptions that factories take
module vcor_case_describe
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_kinds, only : wp
   use vcor_material, only : material_data_t
   use vcor_solver, only : solver_settings_t
   use vcor_case_entries, only : entries_t
   use vcor_case_catalogue, only : catalogue, find_group, first_row, last_row, real_key
   implicit none
   private

   public :: describe_material, describe_solver, number

contains

   !> Describe a material
   subroutine describe_material(case, item, data)
      !> The case
      class(entries_t), intent(in) :: case
      !> Number of the material
      integer, intent(in) :: item
      !> Its description
      type(material_data_t), intent(out) :: data

      real(wp), allocatable :: list(:)
      real(wp) :: value
      integer :: group, row
      logical :: is_taken

      group = find_group('material')
      call case%get('material', 'name', data%name, item)
      call case%get('material', 'model', data%model, item)
      do row = first_row(group), last_row(group)
         if (catalogue(row)%value_kind /= real_key) cycle
         call case%get('material', catalogue(row)%name, value, item)
         if (.not. ieee_is_nan(value)) call data%set(catalogue(row)%name, value, is_taken)
      end do
      call case%get('material', 'moduli', list, item)
      call data%set_list('moduli', list)
      call case%get('material', 'rates', list, item)
      call data%set_list('rates', list)
      call case%get('material', 'times', list, item)
      if (data%model == 'table') then
         call data%set_list('times', list)
      else if (case%given('material', 'times', item)) then
         call data%set_list('rates', 1.0_wp/list)
      end if
   end subroutine describe_material

   !> How a case is to be solved
   subroutine describe_solver(case, settings)
      !> The case
      class(entries_t), intent(in) :: case
      !> The settings
      type(solver_settings_t), intent(out) :: settings

      character(len=:), allocatable :: name
      integer :: order

      call case%get('solver', 'method', name)
      settings%method = name
      call case%get('solver', 'scheme', name)
      settings%scheme = name
      call case%get('solver', 'form', name)
      settings%form = name
      call case%get('solver', 'quadrature', name)
      settings%quadrature = name
      settings%time_step = number(case, 'solver', 'time_step')
      settings%end_time = number(case, 'solver', 'end_time')
      settings%accuracy = number(case, 'solver', 'accuracy')
      call case%get('solver', 'volterra_order', order)
      if (order == 2) &
         settings%second_coefficient = number(case, 'solver', 'volterra_coefficient')
      call case%get('solver', 'continue_after_separation', settings%ghost)
   end subroutine describe_solver

   !> Value of a real key, 0 where there is none
   function number(case, group, key) result(value)
      !> A case
      class(entries_t), intent(in) :: case
      !> Group
      character(len=*), intent(in) :: group
      !> Key
      character(len=*), intent(in) :: key
      !> Value
      real(wp) :: value

      call case%get(group, key, value)
      if (ieee_is_nan(value)) value = 0.0_wp
   end function number

end module vcor_case_describe
