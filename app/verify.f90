!> The command verify: the program against laws and known numbers, or a case by several methods
module vcor_app_verify
   use vcor_app_job, only : job_t
   use vcor_app_verify_screen, only : comparison_text, law_text, models_text
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_io_file, only : write_stdout
   use vcor_text, only : integer_text
   use vcor_verify_comparison, only : compare
   use vcor_verify_comparison_type, only : comparison_t
   use vcor_verify_models, only : model_t, solve_models
   use vcor_verify_row, only : law_t, verdict_t
   use vcor_verify_table, only : build_law, law_count, verify_law
   use vcor_version, only : version
   implicit none
   private

   public :: verify_program, verify_case

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

contains

   !> Evaluate the verification table and print it, law by law
   subroutine verify_program(quiet, error)
      !> Nothing on the screen
      logical, intent(in) :: quiet
      !> Error of code `error_numerical` if a row fails, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(law_t) :: law
      type(verdict_t), allocatable :: verdicts(:)
      character(len=:), allocatable :: first
      integer :: i, j, rows, failed

      rows = 0
      failed = 0
      first = ''
      if (.not. quiet) call write_stdout('vcor '//version//'  verification'//nl, error)
      do i = 1, law_count
         if (.not. allocated(error)) call build_law(i, law, error)
         if (allocated(error)) return
         call verify_law(law, verdicts)
         if (.not. quiet) call write_stdout(nl//law_text(law, verdicts), error)
         do j = 1, law%count
            rows = rows + 1
            if (verdicts(j)%passed) cycle
            failed = failed + 1
            if (failed == 1) first = law%title//': '//law%rows(j)%name//', ' &
               //trim(law%rows(j)%method)
         end do
      end do
      if (.not. quiet .and. .not. allocated(error)) call write_stdout(nl//integer_text(rows) &
         //' checks, '//integer_text(failed)//' failed'//nl, error)
      if (failed > 0 .and. .not. allocated(error)) call raise(error, error_numerical, &
         integer_text(failed)//' of '//integer_text(rows)//' checks failed, the first one: '//first)
   end subroutine verify_program

   !> Solve a case by all methods and print what they agree on
   subroutine verify_case(job, quiet, error)
      type(job_t), intent(in) :: job
      !> Nothing on the screen
      logical, intent(in) :: quiet
      !> Error of code `error_numerical` if they do not agree, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(comparison_t) :: comparison
      type(model_t), allocatable :: models(:)
      character(len=:), allocatable :: title

      call compare(job%case, job%impact, comparison, error)
      if (allocated(error)) then
         error%message = job%case%source//': '//error%message
         return
      end if
      call job%case%get('case', 'title', title)
      if (.not. quiet) then
         call solve_models(job%case, models)
         call write_stdout(comparison_text(job%case%source, title, comparison) &
            //models_text(models), error)
      end if
      if (allocated(comparison%objection) .and. .not. allocated(error)) &
         call raise(error, error_numerical, job%case%source//': '//comparison%objection)
   end subroutine verify_case

end module vcor_app_verify
