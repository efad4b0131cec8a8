!> The command run for a single impact; sweeps are in `vcor_app_sweep`
module vcor_app_run
   use vcor_app_bounces, only : bounces_report
   use vcor_app_cli, only : request_t
   use vcor_app_files, only : claim_files, remark, write_files, write_numbers
   use vcor_app_job, only : job_t
   use vcor_app_screen, only : report
   use vcor_app_validity, only : about_numbers, measures_remark, measures_report, mechanics_of, &
      name_of_exact
   use vcor_app_warnings, only : warn_of_data
   use vcor_case_printed, only : case_text
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_impact_outcome, only : bounces_of, outcome_t
   use vcor_impact_trajectory, only : contact_lasting, contact_resting, contact_separated, &
      trajectory_t
   use vcor_impact_validity, only : forgotten_base
   use vcor_io_coverage, only : beyond_table
   use vcor_io_file, only : write_stdout
   use vcor_rounded, only : short
   use vcor_text, only : integer_text
   use vcor_io_results, only : bounces_table, history_table, summary_table
   use vcor_io_table, only : table_t
   use vcor_kinds, only : wp
   use vcor_solver_type, only : light_plate
   use vcor_sweep_quantity, only : new_summary, row_of, summary_t
   use vcor_sweep_points, only : solve_point, worker_t
   use vcor_verify_models, only : model_t, solve_exact
   use vcor_words, only : joined
   implicit none
   private

   public :: run_impact

contains

   !> Run a case of a single impact
   subroutine run_impact(request, job, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      !> Error of code `error_numerical` if the impact has no result, of another code for other
      !> failures; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(summary_t) :: summary
      type(table_t), allocatable :: tables(:)
      type(worker_t) :: worker
      type(outcome_t) :: outcome
      type(error_t), allocatable :: trouble
      character(len=:), allocatable :: completed, files, title
      logical :: ignored

      call claim_files(job%files, request%resume, ignored, error)
      if (allocated(error)) return
      call job%case%get('case', 'title', title)
      completed = case_text(job%case, complete=.true.)
      call new_summary(summary, 1, error)
      if (allocated(error)) return
      call solve_point(job%sweep, 1, worker, outcome, error)
      call summary%put(1, row_of(outcome))
      if (.not. allocated(error)) call warn_of_data(job%case, job%sweep%grid, &
         summary)
      allocate (tables(1 + count([job%files%bounces, job%files%history])))
      call summary_table(tables(1), title, completed, job%sweep%grid, summary)
      if (allocated(error)) then
         error%message = job%case%source//': '//error%message
         ! without a trajectory, only numbers can be written
         if (error%code == error_numerical .and. size(request%names) > 0) &
            call write_numbers(request, tables(1), trouble)
         if (allocated(trouble)) call move_alloc(trouble, error)
         return
      end if
      call end_of(job, outcome, worker%trajectory, error)
      if (job%files%bounces) call bounces_table(tables(2), title, completed, &
         bounces_of(worker%problem%impact, worker%trajectory, outcome))
      if (job%files%history) call history_table(tables(size(tables)), title, completed, &
         worker%problem%impact, worker%trajectory)
      call write_files(job%files, tables, files, trouble)
      if (allocated(trouble)) then
         continue
      else if (size(request%names) > 0) then
         call write_numbers(request, tables(1), trouble)
         if (.not. request%quiet) call remark(about_numbers(job%case, &
            joined(joined(uncovered(job, outcome), inexact(outcome)), &
            measures_remark(outcome, worker%problem%surroundings))))
      else if (.not. request%quiet) then
         call write_screen()
      end if
      if (allocated(trouble)) call move_alloc(trouble, error)

   contains

      !> Write the report, including results of the exact mechanics
      subroutine write_screen()
         type(model_t) :: exact
         character(len=:), allocatable :: bounces, lines, method
         logical :: is_shown

         associate (reading => job%sweep%problem%reading)
            lines = as_line('mechanics: '//mechanics_of(job%case, reading))
            is_shown = .false.
            if (outcome%status == contact_separated) then
               call solve_exact(job%case, outcome, exact, is_shown)
               if (is_shown) lines = as_line('mechanics: '//mechanics_of(job%case, reading) &
                  //'; '//word_of(name_of_exact(job%case))//': ' &
                  //mechanics_of(job%case, reading, exact))
               if (allocated(exact%failure)) lines = lines &
                  //as_line('note: no result with '//name_of_exact(job%case)//': '//exact%failure)
               if (is_shown .and. .not. allocated(exact%failure)) then
                  lines = lines//measures_report(outcome, worker%problem%surroundings, &
                     exact%outcome)
               else
                  lines = lines//measures_report(outcome, worker%problem%surroundings)
               end if
            end if
         end associate
         if (.not. is_shown) exact%outcome = outcome_t()
         bounces = ''
         if (job%files%bounces) bounces = bounces_report(bounces_of(worker%problem%impact, &
            worker%trajectory, outcome), outcome%validity)
         associate (course => worker%trajectory)
            ! a kernel that is not a finite sum of exponentials was approximated
            if (course%kernel_terms > 0) lines = lines//as_line('kernel as a sum of ' &
               //integer_text(course%kernel_terms)//' exponentials, to ' &
               //short(course%kernel_error))
            method = job%method
            ! `auto` uses direct if ive fails
            if (method == 'ive' .and. course%stages == 0) method = 'direct'
            call write_stdout(report(job%case%source, title, method, outcome, &
               exact%outcome, name_of_exact(job%case), course%state(1, course%last), bounces, &
               lines//remarks_on(job, outcome)//files), trouble)
         end associate
      end subroutine write_screen
   end subroutine run_impact

   !> First word of a text
   pure function word_of(text) result(word)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: word

      word = text(:index(text//' ', ' ') - 1)
   end function word_of

   !> A line of the report
   pure function as_line(words) result(text)
      !> Its text; may be empty
      character(len=*), intent(in) :: words
      !> The line; empty without text
      character(len=:), allocatable :: text

      text = ''
      if (len(words) > 0) text = '  '//words//new_line('a')
   end function as_line

   !> Notes about an outcome outside of the range of the model
   function remarks_on(job, outcome) result(text)
      type(job_t), intent(in) :: job
      type(outcome_t), intent(in) :: outcome
      character(len=:), allocatable :: text

      text = ''
      if (outcome%status /= contact_separated) return
      if (len(inexact(outcome)) > 0) call add(inexact(outcome))
      if (job%method == 'ive' .and. job%case%given('solver', 'time_step')) &
         call add('solver.time_step is without effect: method ive takes its own steps')
      if (outcome%is_coupled()) call add('contact and waves are solved as one: cor is ' &
         //'cor_sphere, and hysteresis_energy, wave_energy, deflection_ratio and inelasticity ' &
         //'are nan')
      if (outcome%contacts > 1) then
         call add('the first separation, with cor_sphere '//short(outcome%first_cor_sphere) &
            //', is not the end: the structure strikes again, '//integer_text(outcome%contacts) &
            //' contacts in '//short(outcome%last_separation)//' s')
      end if
      if (outcome%cor_sphere < 0.0_wp .and. outcome%has_structure()) then
         call add('the sphere does not rebound (cor_sphere below zero): it follows the ' &
            //'structure, which moves away faster')
      else if (outcome%cor_sphere < 0.0_wp) then
         call add('the sphere does not rebound (cor_sphere ' &
            //'below zero): the plate moves faster than it, and it will strike the plate again')
      end if
      if (uncovered(job, outcome) /= '') call add(uncovered(job, outcome))

   contains

      !> One line
      subroutine add(line)
         character(len=*), intent(in) :: line

         text = text//as_line('note: '//line)
      end subroutine add
   end function remarks_on

   !> Message if the data of the materials do not cover the contact
   function uncovered(job, outcome) result(text)
      type(job_t), intent(in) :: job
      type(outcome_t), intent(in) :: outcome
      !> In words; empty if they do
      character(len=:), allocatable :: text

      integer :: sphere, plate

      text = ''
      if (outcome%status /= contact_separated) return
      sphere = job%case%material_of('sphere')
      plate = job%case%material_of('plate')
      text = beyond_table(job%case, plate, trim(merge('both bodies', 'the plate  ', &
         plate == sphere)), [outcome%contact_time])
      if (plate /= sphere) text = joined(beyond_table(job%case, sphere, 'the sphere', &
         [outcome%contact_time]), text)
   end function uncovered

   !> Message if a result is less accurate than requested
   pure function inexact(outcome) result(text)
      type(outcome_t), intent(in) :: outcome
      !> In words; empty if it is as accurate as requested
      character(len=:), allocatable :: text

      text = ''
      if (outcome%status /= contact_separated) return
      if (outcome%misses()) text = 'the estimated error, ' &
         //short(max(outcome%cor_error, outcome%cor_sphere_error)) &
         //', is above the accuracy asked for, '//short(outcome%accuracy)
   end function inexact

   !> Raise an error with the reason if the impact ends without separation
   subroutine end_of(job, outcome, trajectory, error)
      type(job_t), intent(in) :: job
      type(outcome_t), intent(in) :: outcome
      type(trajectory_t), intent(in) :: trajectory
      !> Error of code `error_numerical`; unallocated if the bodies separated or rest
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: time, too_light, reason
      real(wp) :: last, end_time
      logical :: was_short, gave_up, is_lighter

      if (any(outcome%status == [contact_separated, contact_resting])) return
      ! a solver may go on until the end of the contact
      last = trajectory%state(1, trajectory%last)
      gave_up = .false.
      if (job%case%given('solver', 'end_time')) then
         call job%case%get('solver', 'end_time', end_time)
         gave_up = last < end_time
         last = min(last, end_time)
      end if
      time = short(last)
      associate (impact => job%sweep%problem%impact)
         too_light = trim(light_plate(impact))
         is_lighter = job%sweep%problem%surroundings%is_lighter(impact)
         ! an end of the user's that is early says nothing yet
         was_short = job%case%given('solver', 'end_time') &
            .and. last < impact%lasting_time(impact%time_scale())
      end associate
      if (outcome%status == contact_lasting) then
         reason = 'give a longer solver.end_time'
         if (job%method == 'direct') reason = reason//'; a contact shorter than the ' &
            //'steps is missed, give a shorter solver.time_step'
         if (gave_up) reason = 'a contact this long needs too many steps to reach solver.end_time'
         if (is_lighter) then
            if (was_short) reason = reason//'; '//forgotten_base
            if (.not. was_short) reason = forgotten_base
         end if
         if (too_light /= '' .and. .not. was_short) reason = too_light
         call raise(error, error_numerical, job%case%source//': the bodies do not separate ' &
            //'within '//time//' s: '//reason)
      else
         reason = 'the material dissipates all the energy of the impact'
         if (.not. job%sweep%problem%impact%modulus%rubbery() > 0.0_wp) &
            reason = 'the material, without equilibrium modulus, does not push it back'
         if (too_light /= '') reason = too_light
         call raise(error, error_numerical, job%case%source//': the sphere sticks: after ' &
            //time//' s all motion has decayed in contact; '//reason)
      end if
   end subroutine end_of

end module vcor_app_run
