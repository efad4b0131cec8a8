!> Running a case: its impact, or the impacts of its sweep
module vcor_app_run
   use vcor_app_cli, only : request_t
   use vcor_app_band, only : warn_of_bands
   use vcor_app_job, only : endings, job_t
   use vcor_app_screen, only : report, short
   use vcor_app_sweep_screen, only : coordinates, sweep_report
   use vcor, only : contact_lasting, contact_separated, data_file, default_threads, &
      error_numerical, error_t, failures_t, history_table, integer_text, make_directory, &
      new_summary, outcome_t, place_in_table, raise, solve_point, solve_points, summary_t, &
      summary_table, table_t, trajectory_t, worker_t, wp, write_csv, write_hdf5, write_rows, &
      write_stdout
   implicit none
   private

   public :: run_job

contains

   !> Run a case
   subroutine run_job(request, job, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The case
      type(job_t), intent(in) :: job
      !> Error of code `error_numerical` if an impact has no result, of another if there is worse;
      !> unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(summary_t) :: summary
      type(table_t) :: table
      type(worker_t) :: worker
      type(outcome_t) :: outcome
      type(failures_t) :: failures
      type(error_t), allocatable :: trouble
      character(len=:), allocatable :: files, text, title
      integer :: points

      points = job%sweep%grid%count()
      call new_summary(summary, points, error)
      if (allocated(error)) return
      if (job%sweep%is_grid()) then
         call solve_points(job%sweep, 1, points, threads_of(request), summary, failures)
         call end_of_sweep(job, failures, error)
      else
         call solve_point(job%sweep, 1, worker, outcome, error)
         if (allocated(error)) then
            error%message = job%case%source//': '//error%message
            return
         end if
         call summary%put(1, outcome)
         call end_of(job, outcome, worker%trajectory, error)
      end if

      call warn_of_bands(job, summary)
      call job%case%get('case', 'title', title)
      call summary_table(table, title, job%case%to_text(complete=.true.), job%sweep%grid, summary)
      call write_files(request, job, table, worker%trajectory, files, trouble)
      if (allocated(trouble)) then
         continue
      else if (size(request%names) > 0) then
         call write_numbers(request, table, trouble)
      else if (.not. request%quiet) then
         if (job%sweep%is_grid()) then
            text = sweep_report(job, title, table, failures, files)
         else
            text = report(job%case%source, title, job%method, outcome, &
               worker%trajectory%state(1, worker%trajectory%last), &
               kernel_of(worker%trajectory)//remarks_on(job, outcome)//files)
         end if
         call write_stdout(text, trouble)
      end if
      if (allocated(trouble)) call move_alloc(trouble, error)
   end subroutine run_job

   !> Number of threads
   function threads_of(request) result(threads)
      !> The request
      type(request_t), intent(in) :: request
      !> Number, at least 1
      integer :: threads

      threads = request%threads
      if (threads == 0) threads = default_threads()
   end function threads_of

   !> Points without a result make an error of the whole, after all others are done
   subroutine end_of_sweep(job, failures, error)
      !> The case
      type(job_t), intent(in) :: job
      !> What has no result
      type(failures_t), intent(in) :: failures
      !> Error of code `error_numerical`, unallocated where all points have a result
      type(error_t), allocatable, intent(out) :: error

      if (failures%count == 0) return
      call raise(error, error_numerical, job%case%source//': '//integer_text(failures%count) &
         //' of '//integer_text(job%sweep%grid%count())//' points without result, the first at ' &
         //coordinates(job, failures%reason(1)%first)//': '//failures%reason(1)%message)
   end subroutine end_of_sweep

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
   subroutine write_files(request, job, summary, trajectory, files, error)
      !> The request
      type(request_t), intent(in) :: request
      !> The case
      type(job_t), intent(in) :: job
      !> Its outcomes
      type(table_t), intent(in) :: summary
      !> The trajectory of a single impact
      type(trajectory_t), intent(in) :: trajectory
      !> Files written, one to a line
      character(len=:), allocatable, intent(out) :: files
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(table_t) :: course
      character(len=:), allocatable :: directory
      integer :: i

      files = ''
      if (.not. any(job%writes)) return
      if (job%history) call history_table(course, summary%title, summary%case_text, trajectory)

      call job%case%get('output', 'directory', directory)
      if (allocated(request%directory)) directory = request%directory
      call make_directory(directory, error)
      if (allocated(error)) return
      if (job%writes(1)) call write_csv(job%path//trim(endings(1)), summary, error)
      if (allocated(error)) return
      if (job%writes(2)) call write_csv(job%path//trim(endings(2)), course, error)
      if (allocated(error)) return
      if (job%writes(3)) then
         if (job%history) then
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

   !> Bare numbers for --print, a line per impact
   subroutine write_numbers(request, summary, error)
      !> The request
      type(request_t), intent(in) :: request
      !> Outcomes
      type(table_t), intent(in) :: summary
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: places(size(request%names)), i

      do i = 1, size(places)
         places(i) = place_in_table(summary, request%names(i)%text)
      end do
      call write_rows(summary, places, error)
   end subroutine write_numbers

end module vcor_app_run
