!> Moduli of the materials of a case: computed, written to files and shown; and the impact of the
!> case, whose contact time says what of them matters
module vcor_app_material
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_app_cli, only : request_t
   use vcor_app_files, only : write_files
   use vcor_app_job, only : job_t
   use vcor_app_screen, only : heading, line, short, significant
   use vcor_case_case, only : case_t
   use vcor_case_printed, only : case_text
   use vcor_case_problem, only : material_of_case
   use vcor_error, only : error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_file, only : write_stdout
   use vcor_io_moduli_tables, only : moduli_tables
   use vcor_text, only : integer_text, printable
   use vcor_io_table, only : table_t
   use vcor_kinds, only : wp
   use vcor_material_moduli, only : compute_moduli, curves_t, loss_tangent, moduli_t, specimen_t
   use vcor_sweep_sweep, only : solve_point, worker_t
   implicit none
   private

   public :: show_materials, window_t, find_window

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

   !> An impact
   type :: window_t
      !> The case; of a sweep its first point, which stands for all of them
      type(case_t) :: case
      !> Contact time [s]; 0: the impact has no result
      real(wp) :: contact_time = 0.0_wp
      !> Coefficient of restitution [-], where there is a contact time
      real(wp) :: cor = 0.0_wp
      !> Contact time or, where there is none, a time in its place [s]; that of any impact
      real(wp) :: reference = 1.0e-3_wp
      !> Notes about them, one to a line
      character(len=:), allocatable :: notes
   end type window_t

contains

   !> Solve the impact of a case, the first one of a sweep
   subroutine find_window(job, window, error)
      type(job_t), intent(in) :: job
      type(window_t), intent(out) :: window
      !> Error of code `error_input`, unallocated on success, with or without a result
      type(error_t), allocatable, intent(out) :: error

      !> Contact times are about three times the time scale of Hertz's impact
      real(wp), parameter :: hertz = 3.0_wp
      type(worker_t) :: worker
      type(outcome_t) :: outcome
      type(error_t), allocatable :: trouble
      integer :: i

      window%case = job%case
      window%notes = ''
      do i = 1, size(job%sweep%grid%axes)
         associate (axis => job%sweep%grid%axes(i))
            call window%case%put(axis%address, axis%values(1), error)
            if (allocated(error)) return
            window%notes = window%notes//'  note: the case varies '//axis%name//', here it is ' &
               //trim(adjustl(significant(axis%values(1))))//nl
         end associate
      end do
      call solve_point(job%sweep, 1, worker, outcome, trouble)
      if (allocated(trouble)) then
         window%notes = window%notes//'  note: the impact cannot be solved ('//trouble%message &
            //'): its window is not known'//nl
      else if (outcome%status /= contact_separated) then
         window%reference = hertz*worker%problem%impact%time_scale()
         window%notes = window%notes//'  note: the impact does not end in separation: its window ' &
            //'is not known'//nl
      else
         window%contact_time = outcome%contact_time
         window%reference = outcome%contact_time
         window%cor = outcome%cor
      end if
   end subroutine find_window

   !> Compute, write and show the moduli of a case
   subroutine show_materials(request, job, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      !> Unallocated on success, with or without an impact that ends
      type(error_t), allocatable, intent(out) :: error

      type(specimen_t), allocatable :: materials(:)
      type(moduli_t) :: moduli
      type(table_t) :: tables(3)
      character(len=:), allocatable :: title, files
      type(window_t) :: window
      integer :: i

      call find_window(job, window, error)
      if (allocated(error)) return
      associate (case => window%case)
         allocate (materials(case%count('material')))
         do i = 1, size(materials)
            call case%get('material', 'model', materials(i)%model, i)
            call material_of_case(case, i, materials(i)%material, error)
            if (allocated(error)) return
         end do
         call compute_moduli(moduli, materials, window%contact_time, window%reference, &
            request%range, error)
         if (allocated(error)) return
         call case%get('case', 'title', title)
         call moduli_tables(moduli, title, case_text(case, complete=.true.), tables)
      end associate
      call write_files(job, tables, files, error)
      if (allocated(error) .or. request%quiet) return
      call write_stdout(report(job%case%source, title, moduli)//window%notes//files//nl, error)
   end subroutine show_materials

   !> What the screen shows
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
         associate (material => moduli%materials(i))
            text = text//nl//'  '//printable(material%name)//', '//material%model//nl
            if (material%rigid) then
               text = text//'    does not deform: no moduli'//nl
            else
               text = text//values_of(material)
            end if
         end associate
      end do
      text = text//nl
   end function report

   !> Values of one material
   function values_of(curves) result(text)
      type(curves_t), intent(in) :: curves
      character(len=:), allocatable :: text

      text = line('    glassy modulus', 36, 'E(0)', curves%glassy, 'Pa', '') &
         //line('    rubbery modulus', 36, 'E(inf)', curves%rubbery, 'Pa', '')
      if (curves%viscosity > 0.0_wp) &
         text = text//line('    dashpot in parallel', 36, 'eta', curves%viscosity, 'Pa s', '')
      if (ieee_is_nan(curves%at_contact_time)) return
      text = text &
         //line('    relaxation modulus at t0', 36, 'E(t0)', curves%at_contact_time, 'Pa', '') &
         //line('    storage modulus at 2 pi/t0', 36, "E'", curves%storage_at_min, 'Pa', '') &
         //line('    loss modulus at 2 pi/t0', 36, "E''", curves%loss_at_min, 'Pa', '') &
         //line('    loss tangent at 2 pi/t0', 36, 'tan(d)', &
         loss_tangent(curves%storage_at_min, curves%loss_at_min), '', '')
   end function values_of

end module vcor_app_material
