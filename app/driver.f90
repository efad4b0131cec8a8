!> What the commands do
module vcor_app_driver
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_app_argument, only : argument_t
   use vcor_app_cli, only : request_t
   use vcor_app_fit, only : fit_data
   use vcor_app_help, only : help_text
   use vcor_app_help_json, only : help_json
   use vcor_app_job, only : job_t, prepare
   use vcor_app_merge, only : merge_shards
   use vcor_app_material, only : show_materials
   use vcor_app_plot, only : plot
   use vcor_app_run, only : run_job
   use vcor_app_screen, only : short
   use vcor_app_verify, only : verify_case, verify_program
   use vcor_case_printed, only : case_text
   use vcor_error, only : error_numerical, error_t
   use vcor_io_file, only : write_stdout
   use vcor_io_number, only : decimal_text
   use vcor_text, only : integer_text
   use vcor_solver, only : default_accuracy
   use vcor_sweep_mpi, only : share_error, this_rank
   use vcor_version, only : version
   implicit none
   private

   public :: execute, complain

contains

   !> Do what is asked for. All ranks run cases; for the rest one is enough
   subroutine execute(request, error)
      type(request_t), intent(in) :: request
      !> The first error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      if (request%command == 'run') then
         call run(request, error)
         return
      else if (this_rank() > 0) then
         return
      end if
      select case (request%command)
      case ('version')
         call write_stdout('vcor '//version//new_line('a'), error)
      case ('help')
         call help(request%files, request%json, error)
      case ('merge')
         call merge_shards(request, error)
      case ('check')
         call check(request, error)
      case ('material')
         call materials(request, error)
      case ('fit')
         call fit_data(request, error)
      case ('plot')
         call plot(request, error)
      case ('verify')
         call verify(request, error)
      case default
         continue
      end select
   end subroutine execute

   !> One line on stderr; all ranks have the same to say
   subroutine complain(error)
      type(error_t), intent(in) :: error

      if (this_rank() > 0) return
      write (error_unit, '(a)') 'vcor: error: '//error%message
   end subroutine complain

   !> Print a help page
   subroutine help(topics, json, error)
      !> Topic, if any
      type(argument_t), intent(in) :: topics(:)
      !> Whether to print everything as JSON
      logical, intent(in) :: json
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: text, topic

      topic = ''
      if (size(topics) > 0) topic = topics(1)%text
      if (json) then
         text = help_json()
      else
         call help_text(topic, text, error)
      end if
      if (.not. allocated(error)) call write_stdout(text, error)
   end subroutine help

   !> Validate cases and print them complete
   subroutine check(request, error)
      type(request_t), intent(in) :: request
      !> The first error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(job_t), allocatable :: jobs(:)
      integer :: i

      call prepare(request, jobs, error)
      if (allocated(error)) return
      do i = 1, size(jobs)
         call write_stdout(case_text(jobs(i)%case, complete=.true., &
            remarks=.true.)//chosen(jobs(i)), &
            error)
         if (allocated(error)) return
      end do
   end subroutine check

   !> Moduli of the materials of cases
   subroutine materials(request, error)
      type(request_t), intent(in) :: request
      !> The first error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(job_t), allocatable :: jobs(:)
      integer :: i

      call prepare(request, jobs, error)
      if (allocated(error)) return
      do i = 1, size(jobs)
         call show_materials(request, jobs(i), error)
         if (allocated(error)) return
      end do
   end subroutine materials

   !> Verify the program, or cases
   subroutine verify(request, error)
      type(request_t), intent(in) :: request
      !> The first error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(job_t), allocatable :: jobs(:)
      type(error_t), allocatable :: trouble
      integer :: i

      if (size(request%files) == 0) then
         call verify_program(request%quiet, error)
         return
      end if
      call prepare(request, jobs, error)
      if (allocated(error)) return
      do i = 1, size(jobs)
         call verify_case(jobs(i), request%quiet, trouble)
         if (gives_up(trouble, error)) return
      end do
   end subroutine verify

   !> Take over the trouble that a case made. A case that fails numerically does not stop the
   !> others, anything else does
   function gives_up(trouble, error)
      !> Trouble of the case, unallocated if there was none; taken over
      type(error_t), allocatable, intent(inout) :: trouble
      !> Trouble of the cases before; said on stderr if there is more now
      type(error_t), allocatable, intent(inout) :: error
      !> Whether the cases that are left have to go
      logical :: gives_up

      gives_up = .false.
      if (.not. allocated(trouble)) return
      gives_up = trouble%code /= error_numerical
      if (allocated(error) .and. .not. gives_up) call complain(error)
      call move_alloc(trouble, error)
   end function gives_up

   !> What the program chooses where the case says nothing, as comments
   function chosen(job) result(text)
      type(job_t), intent(in) :: job
      character(len=:), allocatable :: text

      character(len=:), allocatable :: method

      call job%case%get('solver', 'method', method)
      text = job%method
      if (method == 'auto') text = method//' ('//text//')'
      text = new_line('a')//'! method: '//text//new_line('a')
      if (.not. job%case%given('solver', 'accuracy')) text = text//'! accuracy: ' &
         //short(default_accuracy(job%method))//new_line('a')
      if (job%sweep%is_grid()) then
         text = text//'! points: '//integer_text(job%sweep%grid%count())//new_line('a')
      else if (.not. job%case%given('sphere', 'mass')) then
         text = text//'! mass of the sphere: '//decimal_text(job%impact%mass)//' kg'//new_line('a')
      end if
   end function chosen

   !> Run cases. All are read and validated before the first one runs, so that a mistake in the
   !> last does not come after hours
   subroutine run(request, error)
      type(request_t), intent(in) :: request
      !> The first error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(job_t), allocatable :: jobs(:)
      type(error_t), allocatable :: trouble
      integer :: i

      call prepare(request, jobs, error)
      call share_error(error)
      if (allocated(error)) return
      do i = 1, size(jobs)
         call run_job(request, jobs(i), trouble)
         if (gives_up(trouble, error)) return
      end do
   end subroutine run

end module vcor_app_driver
