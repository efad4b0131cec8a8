!> The command material: computes, writes and shows the moduli of the materials of a case
module vcor_app_material
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_app_cli, only : request_t
   use vcor_app_files, only : write_files
   use vcor_app_job, only : find_window, job_t, window_t
   use vcor_app_screen, only : heading, line
   use vcor_rounded, only : short, significant
   use vcor_case_printed, only : case_text
   use vcor_case_body, only : material_of_case
   use vcor_error, only : error_t
   use vcor_io_file, only : write_stdout
   use vcor_io_results, only : moduli_tables
   use vcor_text, only : integer_text, printable
   use vcor_io_table, only : table_t
   use vcor_kinds, only : wp
   use vcor_material_moduli, only : compute_moduli, curves_t, loss_tangent, moduli_t
   implicit none
   private

   public :: show_materials

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

contains

   !> Compute, write and show the moduli of a case
   subroutine show_materials(request, job, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      !> Unallocated on success, even if the impact does not end
      type(error_t), allocatable, intent(out) :: error

      type(moduli_t) :: moduli
      type(table_t) :: tables(3)
      character(len=:), allocatable :: title, files
      type(window_t) :: window
      integer :: i

      call find_window(job, window, error)
      if (allocated(error)) return
      associate (case => window%case)
         allocate (moduli%materials(case%count('material')))
         do i = 1, size(moduli%materials)
            call case%get('material', 'model', moduli%materials(i)%model, i)
            call material_of_case(case, i, moduli%materials(i)%material, error)
            if (allocated(error)) return
         end do
         call compute_moduli(moduli, window%contact_time, window%reference, request%range, error)
         if (allocated(error)) return
         call case%get('case', 'title', title)
         call moduli_tables(moduli, title, case_text(case, complete=.true.), tables)
      end associate
      call write_files(job%files, tables, files, error)
      if (allocated(error) .or. request%quiet) return
      call write_stdout(report(job%case%source, title, moduli)//window%notes//files//nl, error)
   end subroutine show_materials

   !> Text for the screen
   function report(filename, title, moduli) result(text)
      character(len=*), intent(in) :: filename
      character(len=*), intent(in) :: title
      type(moduli_t), intent(in) :: moduli
      character(len=:), allocatable :: text

      integer :: i, n

      n = size(moduli%times)
      text = heading(filename, title)//'  '//integer_text(n)//' times from ' &
         //short(moduli%times(1))//' to '//short(moduli%times(n))//' s'
      if (moduli%contact_time > 0.0_wp) text = text//', the impact up to t0 = ' &
         //trim(adjustl(significant(moduli%contact_time)))//' s'
      text = text//nl//'  '//integer_text(n)//' frequencies from '//short(moduli%frequencies(1)) &
         //' to '//short(moduli%frequencies(n))//' rad/s'
      if (moduli%contact_time > 0.0_wp) text = text//', the impact from 2 pi/t0 = ' &
         //trim(adjustl(significant(moduli%min_frequency)))//' rad/s'
      text = text//nl
      do i = 1, size(moduli%materials)
         associate (curves => moduli%materials(i))
            text = text//nl//'  '//printable(curves%material%name)//', '//curves%model//nl
            if (curves%material%rigid) then
               text = text//'    does not deform: no moduli'//nl
            else
               text = text//values_of(curves)
            end if
         end associate
      end do
      text = text//nl
   end function report

   !> Lines of one material
   function values_of(curves) result(text)
      type(curves_t), intent(in) :: curves
      character(len=:), allocatable :: text

      text = line('    glassy modulus', 36, 'E(0)', curves%material%glassy(), 'Pa', '') &
         //line('    rubbery modulus', 36, 'E(inf)', curves%material%rubbery(), 'Pa', '')
      if (curves%material%viscosity > 0.0_wp) text = text//line('    dashpot in parallel', 36, &
         'eta', curves%material%viscosity, 'Pa s', '')
      if (ieee_is_nan(curves%at_contact_time)) return
      text = text &
         //line('    relaxation modulus at t0', 36, 'E(t0)', curves%at_contact_time, 'Pa', '') &
         //line('    storage modulus at 2 pi/t0', 36, "E'", curves%storage_at_min, 'Pa', '') &
         //line('    loss modulus at 2 pi/t0', 36, "E''", curves%loss_at_min, 'Pa', '') &
         //line('    loss tangent at 2 pi/t0', 36, 'tan(d)', &
         loss_tangent(curves%storage_at_min, curves%loss_at_min), '', '')
   end function values_of

end module vcor_app_material
