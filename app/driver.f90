!> What the commands do
module vcor_app_driver
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_app_argument, only : argument_t
   use vcor_app_cli, only : request_t
   use vcor_app_help, only : help_text
   use vcor_app_job, only : endings, job_t, prepare
   use vcor_app_screen, only : report, short
   use vcor_app_verify, only : verify_case, verify_program
   use vcor, only : contact_lasting, contact_separated, data_file, default_accuracy, &
      error_numerical, error_t, evaluate, history_table, integer_text, make_directory, outcome_t, &
      quantities, quantity_value, raise, real_text, status_name, summary_table, table_t, &
      trajectory_t, version, wp, write_csv, write_hdf5, write_stdout
   implicit none
   private

   public :: execute, complain

contains

   !> Do what is asked for
   subroutine execute(request, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The first error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      select case (request%command)
      case ('version')
         call write_stdout('vcor '//version//new_line('a'), error)
      case ('help')
         call help(request%files, error)
      case ('check')
         call check(request, error)
      case ('verify')
         call verify(request, error)
      case default
         call run(request, error)
      end select
   end subroutine execute

   !> One line on stderr
   subroutine complain(error)
      !> The error
      type(error_t), intent(in) :: error

      write (error_unit, '(a)') 'vcor: error: '//error%message
   end subroutine complain

   !> Print a help page
   subroutine help(topics, error)
      !> Topic, if any
      type(argument_t), intent(in) :: topics(:)
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: text

      if (size(topics) > 0) then
         call help_text(topics(1)%text, text, error)
      else
         call help_text('', text, error)
      end if
      if (.not. allocated(error)) call write_stdout(text, error)
   end subroutine help

   !> Validate cases and print them complete
   subroutine check(request, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The first error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(job_t), allocatable :: jobs(:)
      integer :: i

      call prepare(request, jobs, error)
      if (allocated(error)) return
      do i = 1, size(jobs)
         call write_stdout(jobs(i)%case%to_text(complete=.true., remarks=.true.)//chosen(jobs(i)), &
            error)
         if (allocated(error)) return
      end do
   end subroutine check

   !> Verify the program, or cases
   subroutine verify(request, error)
      !> The request
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
      !> The case
      type(job_t), intent(in) :: job
      !> Lines
      character(len=:), allocatable :: text

      text = new_line('a')//'! method: '//job%method//new_line('a')
      if (.not. job%case%given('solver', 'accuracy')) text = text//'! accuracy: ' &
         //short(default_accuracy(job%method))//new_line('a')
      if (.not. job%case%given('sphere', 'mass')) text = text//'! mass of the sphere: ' &
         //real_text(job%impact%mass)//' kg'//new_line('a')
   end function chosen

   !> Run cases. All are read and validated before the first one runs, so that a mistake in the
   !> last does not come after hours
   subroutine run(request, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The first error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(job_t), allocatable :: jobs(:)
      type(error_t), allocatable :: trouble
      integer :: i

      call prepare(request, jobs, error)
      if (allocated(error)) return
      do i = 1, size(jobs)
         call run_job(request, jobs(i), trouble)
         if (gives_up(trouble, error)) return
      end do
   end subroutine run

   !> Run one case
   subroutine run_job(request, job, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The case
      type(job_t), intent(in) :: job
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(trajectory_t) :: trajectory
      type(outcome_t) :: outcome
      type(error_t), allocatable :: trouble
      character(len=:), allocatable :: files, title

      call job%solver%solve(job%impact, trajectory, error)
      if (allocated(error)) then
         error%message = job%case%source//': '//error%message
         return
      end if
      outcome = evaluate(job%impact, trajectory)
      call end_of(job, outcome, trajectory, error)

      files = ''
      if (any(job%writes)) then
         call write_files(request, job, outcome, trajectory, files, trouble)
         if (allocated(trouble)) then
            call move_alloc(trouble, error)
            return
         end if
      end if
      call job%case%get('case', 'title', title)
      if (size(request%names) > 0) then
         call write_stdout(numbers(request%names, outcome)//new_line('a'), trouble)
      else if (.not. request%quiet) then
         call write_stdout(report(job%case%source, title, job%method, outcome, &
            trajectory%state(1, trajectory%last), &
            kernel_of(trajectory)//remarks_on(job, outcome)//files), trouble)
      end if
      if (allocated(trouble)) call move_alloc(trouble, error)
   end subroutine run_job

   !> What stood for a kernel that is no finite sum of exponentials
   function kernel_of(trajectory) result(text)
      !> Trajectory
      type(trajectory_t), intent(in) :: trajectory
      !> A line, or nothing
      character(len=:), allocatable :: text

      text = ''
      if (trajectory%kernel_terms > 0) text = '  kernel as a sum of ' &
         //integer_text(trajectory%kernel_terms)//' exponentials, to ' &
         //short(trajectory%kernel_error)//new_line('a')
   end function kernel_of

   !> Remarks on an outcome that is beyond what the model is made for
   function remarks_on(job, outcome) result(text)
      !> The case
      type(job_t), intent(in) :: job
      !> Its outcome
      type(outcome_t), intent(in) :: outcome
      !> Lines
      character(len=:), allocatable :: text

      real(wp) :: radius, half_thickness

      text = ''
      if (outcome%status /= contact_separated) return
      call job%case%get('sphere', 'radius', radius)
      if (outcome%max_indentation > radius) call add("the indentation exceeds the sphere's " &
         //"radius: Hertz's contact does not apply")
      if (job%case%given('plate', 'half_thickness')) then
         call job%case%get('plate', 'half_thickness', half_thickness)
         if (outcome%max_indentation > 2.0_wp*half_thickness) &
            call add('the indentation exceeds the thickness of the plate')
      end if
      if (outcome%cor_sphere < 0.0_wp) call add('the sphere goes on in its direction ' &
         //'(cor_sphere below zero): the plate has run away from it')
      call remark_on_data('sphere')
      call remark_on_data('plate')

   contains

      !> Data that do not cover the contact
      subroutine remark_on_data(body)
         !> Group of the body
         character(len=*), intent(in) :: body

         ! what counts is the material between the contact time and a hundredth of it
         real(wp), parameter :: early = 0.01_wp
         character(len=:), allocatable :: name
         real(wp), allocatable :: times(:)
         integer :: item

         call job%case%get(body, 'material', name)
         item = job%case%find_material(name)
         if (data_file(job%case, item) == '') return
         call job%case%get('material', 'times', times, item)
         name = 'the data of the '//body//' ('//data_file(job%case, item)//') '
         if (times(1) > early*outcome%contact_time) call add(name//'begin at ' &
            //short(times(1))//' s: before that the modulus is taken as constant')
         if (times(size(times)) < outcome%contact_time) call add(name//'end at ' &
            //short(times(size(times)))//' s: after that the modulus is taken as constant')
      end subroutine remark_on_data

      !> One line
      subroutine add(line)
         !> The remark
         character(len=*), intent(in) :: line

         text = text//'  note: '//line//new_line('a')
      end subroutine add
   end function remarks_on

   !> An impact without separation has no coefficient of restitution: say why
   subroutine end_of(job, outcome, trajectory, error)
      !> The case
      type(job_t), intent(in) :: job
      !> Its outcome
      type(outcome_t), intent(in) :: outcome
      !> Its trajectory
      type(trajectory_t), intent(in) :: trajectory
      !> Error of code `error_numerical`; unallocated where the bodies separated
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: time

      if (outcome%status == contact_separated) return
      time = short(trajectory%state(1, trajectory%last))
      if (outcome%status == contact_lasting) then
         call raise(error, error_numerical, job%case%source//': the bodies do not separate ' &
            //'within '//time//' s: give a longer solver.end_time; with method direct a ' &
            //'contact shorter than its steps is missed, give a shorter solver.time_step')
      else
         call raise(error, error_numerical, job%case%source//': the sphere sticks: after ' &
            //time//' s all motion has died out in contact; the plate takes up the blow ' &
            //'(inelasticity '//short(job%impact%inelasticity())//') or the material, without ' &
            //'equilibrium modulus, does not push it back')
      end if
   end subroutine end_of

   !> Write the files of a case
   subroutine write_files(request, job, outcome, trajectory, files, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The case
      type(job_t), intent(in) :: job
      !> Its outcome
      type(outcome_t), intent(in) :: outcome
      !> Its trajectory
      type(trajectory_t), intent(in) :: trajectory
      !> Files written, one to a line
      character(len=:), allocatable, intent(out) :: files
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(table_t) :: summary, course
      character(len=:), allocatable :: title, text, directory
      integer :: i
      logical :: history

      call job%case%get('output', 'history', history)
      call job%case%get('case', 'title', title)
      text = job%case%to_text(complete=.true.)
      call summary_table(summary, title, text, [outcome])
      if (history) call history_table(course, title, text, trajectory)

      call job%case%get('output', 'directory', directory)
      if (allocated(request%directory)) directory = request%directory
      files = ''
      call make_directory(directory, error)
      if (allocated(error)) return
      if (job%writes(1)) call write_csv(job%path//trim(endings(1)), summary, error)
      if (allocated(error)) return
      if (job%writes(2)) call write_csv(job%path//trim(endings(2)), course, error)
      if (allocated(error)) return
      if (job%writes(3)) then
         if (history) then
            call write_hdf5(job%path//trim(endings(3)), summary, course, error)
         else
            call write_hdf5(job%path//trim(endings(3)), summary, error=error)
         end if
         if (allocated(error)) return
      end if
      do i = 1, size(endings)
         if (job%writes(i)) files = files//'  written '//job%path//trim(endings(i))//new_line('a')
      end do
   end subroutine write_files

   !> Bare numbers for --print
   function numbers(names, outcome) result(text)
      !> Names of the quantities
      type(argument_t), intent(in) :: names(:)
      !> Outcome
      type(outcome_t), intent(in) :: outcome
      !> Numbers separated by blanks
      character(len=:), allocatable :: text

      integer :: i, j

      text = ''
      do i = 1, size(names)
         if (i > 1) text = text//' '
         select case (names(i)%text)
         case ('steps')
            text = text//integer_text(outcome%steps)
         case ('status')
            text = text//status_name(outcome%status)
         case default
            do j = 1, size(quantities)
               if (quantities(j)%name == names(i)%text) &
                  text = text//real_text(quantity_value(outcome, j))
            end do
         end select
      end do
   end function numbers

end module vcor_app_driver
