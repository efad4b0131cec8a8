!> The program vcor: the coefficient of restitution of viscoelastic impacts
!>
!> Each command has a page in `vcor_app_commands` and a call here.
program vcor_main
   use, intrinsic :: iso_c_binding, only : c_int, c_intptr_t
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_app_cli, only : argument_t, get_arguments, parse, request_t, sum_of_words
   use vcor_app_external, only : run_external
   use vcor_app_help, only : help_text
   use vcor_app_help_json, only : help_json
   use vcor_app_job, only : job_t, prepare
   use vcor_app_material, only : show_materials
   use vcor_app_run, only : run_impact
   use vcor_rounded, only : short
   use vcor_app_sweep, only : run_sweep
   use vcor_app_verify, only : verify_case, verify_program
   use vcor_app_warnings, only : warn_of_input
   use vcor_case_printed, only : case_text
   use vcor_error, only : error_numerical, error_t, error_usage, raise
   use vcor_io_file, only : write_stdout
   use vcor_number, only : real_text
   use vcor_solver, only : default_accuracy
   use vcor_sweep_mpi, only : differs, join_ranks, leave_ranks, share_error, this_rank
   use vcor_text, only : integer_text
   use vcor_version, only : version
   implicit none

   interface
      !> End the process with an exit code, without the message of `stop`
      subroutine c_exit(code) bind(c, name='exit')
         import :: c_int
         integer(c_int), intent(in), value :: code
      end subroutine c_exit

      !> Set the handler of a signal
      function c_signal(number, handler) result(before) bind(c, name='signal')
         import :: c_int, c_intptr_t
         integer(c_int), intent(in), value :: number
         !> The handler and the one before it; 1: ignore the signal
         integer(c_intptr_t), intent(in), value :: handler
         integer(c_intptr_t) :: before
      end function c_signal
   end interface

   !> Signal that a file exceeds the limit of the user (SIGXFSZ)
   integer(c_int), parameter :: file_too_large = 25

   type(argument_t), allocatable :: words(:)
   type(request_t) :: request
   type(error_t), allocatable :: error
   integer(c_intptr_t) :: ignored

   call get_arguments(words)
   call run_external(words)
   call join_ranks()
   ! writing fails then, as on a full disk
   ignored = c_signal(file_too_large, 1_c_intptr_t)
   call parse(words, request, error)
   call share_error(error)
   if (.not. allocated(error)) then
      ! ranks with different commands would wait for each other
      if (differs(sum_of_words(words))) call raise(error, error_usage, &
         'not all ranks have the same command line, expected the same words after vcor')
   end if
   if (.not. allocated(error)) call execute(request, error)
   call share_error(error)
   if (allocated(error)) then
      call print_error(error)
      flush (error_unit)
   end if
   call leave_ranks()
   if (allocated(error)) then
      call c_exit(int(error%code, c_int))
   end if

contains

   !> Execute a request. All ranks run cases; one rank does everything else. All cases are read and
   !> validated before the first one runs, so an error in the last one does not appear after hours.
   !> After a numerical failure the next case runs; any other error ends the program
   subroutine execute(request, error)
      type(request_t), intent(in) :: request
      !> The last error, unallocated on success; earlier ones have been printed
      type(error_t), allocatable, intent(out) :: error

      type(job_t), allocatable :: jobs(:)
      type(error_t), allocatable :: trouble
      character(len=:), allocatable :: text, topic
      integer :: i

      if (this_rank() > 0 .and. request%command /= 'run') return
      allocate (jobs(0))
      select case (request%command)
      case ('version')
         call write_stdout('vcor '//version//new_line('a'), error)
      case ('help')
         topic = ''
         if (size(request%files) > 0) topic = request%files(1)%text
         if (request%json) then
            text = help_json()
         else
            call help_text(topic, text, error)
         end if
         if (.not. allocated(error)) call write_stdout(text, error)
      case default
         if (size(request%files) == 0) then
            call verify_program(request%quiet, error)
         else
            call prepare(request, jobs, error)
            if (request%command == 'run') call share_error(error)
         end if
      end select
      if (allocated(error)) return
      do i = 1, size(jobs)
         select case (request%command)
         case ('run')
            ! all ranks run a sweep, the first one a single impact
            if (this_rank() == 0 .and. .not. request%quiet) &
               call warn_of_input(jobs(i)%case, jobs(i)%sweep)
            if (jobs(i)%sweep%is_grid()) then
               call run_sweep(request, jobs(i), trouble)
            else if (this_rank() == 0) then
               call run_impact(request, jobs(i), trouble)
            end if
            call share_error(trouble)
         case ('check')
            call warn_of_input(jobs(i)%case, jobs(i)%sweep)
            call write_stdout(case_text(jobs(i)%case, complete=.true., remarks=.true.) &
               //chosen(jobs(i)), trouble)
         case ('material')
            call show_materials(request, jobs(i), trouble)
         case default
            call verify_case(jobs(i), request%quiet, trouble)
         end select
         if (.not. allocated(trouble)) cycle
         if (allocated(error) .and. trouble%code == error_numerical) call print_error(error)
         call move_alloc(trouble, error)
         if (error%code /= error_numerical) return
      end do
   end subroutine execute

   !> Print an error, from the first rank only
   subroutine print_error(error)
      type(error_t), intent(in) :: error

      if (this_rank() > 0) return
      write (error_unit, '(a)') 'vcor: error: '//error%message
   end subroutine print_error

   !> Defaults that the program chooses, as comments
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
         text = text//'! mass of the sphere: ' &
            //real_text(job%sweep%problem%impact%mass)//' kg'//new_line('a')
      end if
   end function chosen

end program vcor_main
