!> What the commands do
module vcor_app_driver
   use, intrinsic :: iso_fortran_env, only : error_unit
   use vcor_app_argument, only : argument_t
   use vcor_app_cli, only : request_t
   use vcor_app_help, only : help_text
   use vcor_app_screen, only : report, short
   use vcor, only : build_impact, build_solver, case_t, contact_lasting, contact_separated, &
      data_file, default_accuracy, error_input, error_numerical, error_t, evaluate, history_table, &
      impact_t, integer_text, join_path, make_directory, method_for, outcome_t, override, &
      quantities, quantity_value, raise, read_case, read_data, real_text, same_file, &
      solver_t, status_name, summary_table, table_t, trajectory_t, version, wp, write_csv, &
      write_hdf5, write_stdout
   implicit none
   private

   public :: execute, complain

   !> One case of a call, ready to run
   type :: job_t
      !> The case
      type(case_t) :: case
      !> Its impact
      type(impact_t) :: impact
      !> Its solver
      class(solver_t), allocatable :: solver
      !> Its method
      character(len=:), allocatable :: method
      !> Directory and stem of its files
      character(len=:), allocatable :: path
      !> Which of its files it writes, in the order of `endings`
      logical :: writes(3) = .true.
   end type job_t

   !> What the names of the files end with
   character(len=*), parameter :: endings(3) = [character(len=12) :: '_summary.csv', '.csv', '.h5']

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
         if (.not. allocated(trouble)) cycle
         ! a case that fails numerically does not stop the others, anything else does
         if (trouble%code /= error_numerical) then
            call move_alloc(trouble, error)
            return
         end if
         if (allocated(error)) call complain(error)
         call move_alloc(trouble, error)
      end do
   end subroutine run

   !> Read, override, validate and build all cases of a request
   subroutine prepare(request, jobs, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The cases
      type(job_t), allocatable, intent(out) :: jobs(:)
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: directory, stem, method, scheme
      logical :: csv, hdf5, history
      integer :: i, j

      allocate (jobs(size(request%files)))
      do i = 1, size(jobs)
         associate (job => jobs(i))
            call read_case(job%case, request%files(i)%text, error)
            if (allocated(error)) return
            do j = 1, size(request%settings)
               call override(job%case, request%settings(j)%text, error)
               if (allocated(error)) return
            end do
            call job%case%validate(error)
            if (allocated(error)) return
            call read_data(job%case, error)
            if (allocated(error)) return
            call build_impact(job%case, job%impact, error)
            if (allocated(error)) return
            call build_solver(job%case, job%impact, job%solver, error)
            if (allocated(error)) return

            call job%case%get('solver', 'method', method)
            call job%case%get('solver', 'scheme', scheme)
            job%method = method_for(method, scheme)
            call job%case%get('output', 'directory', directory)
            if (allocated(request%directory)) directory = request%directory
            call job%case%get('output', 'stem', stem)
            job%path = join_path(directory, stem)
            call job%case%get('output', 'csv', csv)
            call job%case%get('output', 'hdf5', hdf5)
            call job%case%get('output', 'history', history)
            job%writes = [csv, csv .and. history, hdf5]
            ! bare numbers are for scripts, which would be surprised by files
            if (size(request%names) > 0 .and. .not. allocated(request%directory)) &
               job%writes = .false.
         end associate
         do j = 1, i
            call refuse_clash(request, jobs, i, j, error)
            if (allocated(error)) return
         end do
      end do
   end subroutine prepare

   !> No file of one case may be a file of another, nor a case file itself, nor a data file
   subroutine refuse_clash(request, jobs, new, old, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The cases
      type(job_t), intent(in) :: jobs(:)
      !> A case
      integer, intent(in) :: new
      !> A case that comes no later
      integer, intent(in) :: old
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, j

      do i = 1, size(endings)
         if (jobs(new)%writes(i)) call keep_data(new, old)
         if (jobs(old)%writes(i) .and. old /= new) call keep_data(old, new)
         if (allocated(error)) return
         if (.not. jobs(new)%writes(i)) cycle
         if (same_file(jobs(new)%path//trim(endings(i)), request%files(old)%text)) then
            call raise(error, error_input, request%files(new)%text//': its results would replace ' &
               //'the case file '//request%files(old)%text//': give it another output.stem')
            return
         end if
         if (old == new) cycle
         do j = 1, size(endings)
            if (.not. jobs(old)%writes(j)) cycle
            if (same_file(jobs(new)%path//trim(endings(i)), jobs(old)%path//trim(endings(j)))) then
               call raise(error, error_input, request%files(new)%text//': its files would ' &
                  //'replace those of '//request%files(old)%text//': give one of them another ' &
                  //'output.stem')
               return
            end if
         end do
      end do

   contains

      !> No file of a case may be a data file of another or its own
      subroutine keep_data(writer, reader)
         !> The case whose results are written
         integer, intent(in) :: writer
         !> The case whose data files are read
         integer, intent(in) :: reader

         do j = 1, jobs(reader)%case%count('material')
            if (.not. same_file(jobs(writer)%path//trim(endings(i)), &
               data_file(jobs(reader)%case, j))) cycle
            call raise(error, error_input, request%files(writer)%text//': its results would ' &
               //'replace the data file '//data_file(jobs(reader)%case, j) &
               //': give it another output.stem')
         end do
      end subroutine keep_data
   end subroutine refuse_clash

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
            trajectory%state(1, trajectory%last), remarks_on(job, outcome)//files), trouble)
      end if
      if (allocated(trouble)) call move_alloc(trouble, error)
   end subroutine run_job

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
