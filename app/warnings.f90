!> Warnings on stderr: implausible input, values that are taken because none is given, and impacts
!> that rely on a material beyond the data of its fit
module vcor_app_warnings
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_case_address, only : swept_addresses
   use vcor_case_case, only : case_t
   use vcor_case_checks, only : implausible_numbers, note_length
   use vcor_case_entries, only : operator(==)
   use vcor_case_grid, only : grid_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_coverage, only : find_remarks, outcomes_t, remark_length
   use vcor_kinds, only : wp
   use vcor_number, only : real_text
   use vcor_rounded, only : short
   use vcor_sweep_points, only : sweep_t
   use vcor_sweep_quantity, only : quantity_place, summary_t
   use vcor_text, only : printable
   implicit none
   private

   public :: warn_of_input, warn_of_data

contains

   !> Warn on stderr of implausible numbers, and note which values are taken because none is given:
   !> the mass of one of two spheres, the temperature of a material with a shift
   subroutine warn_of_input(case, sweep)
      type(case_t), intent(in) :: case
      !> Its impacts
      type(sweep_t), intent(in) :: sweep

      character(len=note_length), allocatable :: notes(:)
      character(len=:), allocatable :: name, mechanics
      real(wp) :: temperature
      integer :: i

      call implausible_numbers(case, sweep%grid, notes)
      do i = 1, size(notes)
         write (error_unit, '(a)') 'vcor: warning: '//trim(notes(i))
      end do
      if (sweep%problem%surroundings%is_sphere .and. .not. any(swept_addresses(case) &
         == case%address('sphere', 'mass')) .and. .not. case%given('sphere', 'mass')) &
         write (error_unit, '(a)') 'vcor: note: '//case%location('plate', 'surface_radius') &
         //': the second body is a sphere, and mass is not given: the mass is that of &sphere ' &
         //'alone, '//short(sweep%problem%impact%mass)//' kg, as if the second one could not ' &
         //'move; two free spheres need their reduced mass, m1 m2/(m1 + m2)'
      call case%get('contact', 'mechanics', mechanics)
      if (mechanics == 'exact' .and. case%count('target') > 0 &
          .and. .not. case%given('plate', 'waves')) then
         write (error_unit, '(a)') 'vcor: note: '//case%location('contact', 'mechanics') &
            //": the surface moves with the structure: mechanics = 'exact' leaves plate.waves " &
            //"= 'none'"
      else if (mechanics == 'exact' .and. case%has_second_sphere() &
               .and. .not. case%given('plate', 'waves')) then
         write (error_unit, '(a)') 'vcor: note: '//case%location('contact', 'mechanics') &
            //": two spheres are no half space: mechanics = 'exact' leaves plate.waves = 'none'"
      end if
      if (case%given('impact', 'temperature') .or. any(swept_addresses(case) &
         == case%address('impact', 'temperature'))) return
      do i = 1, case%count('material')
         if (.not. case%given('material', 'shift', i)) cycle
         call case%get('material', 'name', name, i)
         call case%get('material', 'reference_temperature', temperature, i)
         write (error_unit, '(a)') 'vcor: note: '//case%location('material', 'shift', i) &
            //": '"//printable(name)//"' is at its reference temperature, " &
            //real_text(temperature)//' K: there is no impact.temperature'
      end do
   end subroutine warn_of_input

   !> Warn on stderr of impacts that rely on what the data of the materials do not say
   subroutine warn_of_data(case, grid, summary)
      type(case_t), intent(in) :: case
      type(grid_t), intent(in) :: grid
      type(summary_t), intent(in) :: summary

      character(len=remark_length), allocatable :: remarks(:)
      integer :: i

      call find_remarks(case, grid, outcomes_t(summary%status == contact_separated, &
         summary%values(quantity_place('contact_time'))%reals, &
         summary%values(quantity_place('cor'))%reals), size(grid%axes) > 0, remarks)
      do i = 1, size(remarks)
         write (error_unit, '(a)') 'vcor: warning: '//trim(remarks(i))
      end do
   end subroutine warn_of_data

end module vcor_app_warnings
