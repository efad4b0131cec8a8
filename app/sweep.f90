!> The command run for a sweep, on all ranks and their threads
!>
!> Only the first rank reads and writes files and talks to the user.
module vcor_app_sweep
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_app_cli, only : request_t
   use vcor_app_files, only : check_columns, check_finished, find_previous, previous_t, remark, &
      replacement_note, write_files, write_numbers
   use vcor_app_job, only : job_t, shard_text
   use vcor_app_screen, only : coordinates, heading, padded, right, shown, significant
   use vcor_app_signals, only : catch_signals, caught_signal, release_signals, &
      signal_name
   use vcor_app_validity, only : about_numbers, joined, points_remark, points_report, &
      warn_of_bands
   use vcor_case_grid, only : grid_t
   use vcor_error, only : error_input, error_numerical, error_t, raise
   use vcor_io_checkpoint, only : checkpoint_t, create_checkpoint, open_checkpoint, read_points
   use vcor_io_file, only : move_file, stderr_is_terminal, write_stdout, write_terminal
   use vcor_io_identity, only : identity_of, identity_t, number_of
   use vcor_text, only : integer_text
   use vcor_io_path, only : anything_at, make_directory, quoted_path
   use vcor_io_results, only : summary_table
   use vcor_io_table, only : place_in_table, table_t
   use vcor_kinds, only : wp
   use vcor_sweep_mpi, only : differs, largest_of_ranks, share_error, this_rank
   use vcor_sweep_points, only : clock, default_threads, failures_t, monitor_t, solve_points
   use vcor_sweep_quantity, only : new_summary, point_failed, point_invalid, point_pending, &
      quantities, quantity_place, quantity_t, summary_t
   implicit none
   private

   public :: run_sweep

   !> Exit code of a run ended by a signal minus the number of the signal, as in shells
   integer, parameter :: signal_base = 128
   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

   !> Time after which a sweep gets a file [s]; a shorter one is quickly repeated
   real(wp), parameter :: time_without_file = 0.25_wp
   !> Minimum time between two progress lines [s]
   real(wp), parameter :: time_between_lines = 0.2_wp
   !> Length of the progress line
   integer, parameter :: width = 72

   !> Observer of a sweep that writes its file and shows its progress
   type, extends(monitor_t) :: watch_t
      !> Whether to store finished points in a file
      logical :: keeps = .false.
      !> Whether to show progress on the terminal
      logical :: shows = .false.
      character(len=:), allocatable :: path
      type(identity_t) :: identity
      !> Grid of the sweep
      type(grid_t) :: grid
      type(checkpoint_t) :: file
      !> Points done
      integer :: done = 0
      !> Points done at the start
      integer :: done_before = 0
      !> Time of the start [s]
      real(wp) :: start = 0.0_wp
      !> Time of the last progress line [s]
      real(wp), private :: shown = 0.0_wp
   contains
      procedure :: finished, clear
      procedure, nopass :: stop_code => caught_signal
   end type watch_t

contains

   !> Run the sweep of a case; all ranks call this
   subroutine run_sweep(request, job, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      !> Error of code `error_numerical` if points have no result, of another code for other
      !> failures; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(previous_t) :: previous
      type(summary_t) :: summary
      type(failures_t) :: failures
      type(watch_t) :: watch
      integer :: stopped
      logical :: is_finished

      watch%identity = identity_of(job%case, job%part)
      watch%path = job%files%path//'.part.h5'
      watch%keeps = any(job%files%writes) .and. this_rank() == 0
      is_finished = .false.
      if (this_rank() == 0) call begin(request, job, watch, previous, summary, is_finished, error)
      call share_error(error)
      is_finished = any(largest_of_ranks([merge(1, 0, is_finished)]) == 1)
      if (is_finished .or. allocated(error)) return
      if (differs(number_of(watch%identity))) then
         call raise(error, error_input, job%case%source//': not all ranks read the same case, or ' &
            //'have the same version of vcor')
         return
      end if

      call catch_signals()
      call solve_points(job%sweep, job%part, threads_of(request), summary, failures, error, watch, &
         stopped)
      if (this_rank() == 0) then
         call watch%clear()
         if (.not. allocated(error)) call finish(request, job, watch, previous, summary, failures, &
            stopped, error)
         call watch%file%close()
      end if
      call share_error(error)
      call release_signals()
   end subroutine run_sweep

   !> Find existing results, and the points that remain
   subroutine begin(request, job, watch, previous, summary, is_finished, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      type(watch_t), intent(inout) :: watch
      !> Existing results
      type(previous_t), intent(out) :: previous
      !> Existing outcomes; the others are pending
      type(summary_t), intent(out) :: summary
      logical, intent(out) :: is_finished
      type(error_t), allocatable, intent(out) :: error

      logical :: is_unfinished

      is_finished = .false.
      is_unfinished = .false.
      if (watch%keeps) is_unfinished = anything_at(watch%path)
      call find_previous(job%files, watch%identity, previous)
      call new_summary(summary, job%part%count(), error, threads_of(request))
      if (allocated(error)) error%message = job%case%source//': '//error%message
      if (.not. (allocated(error) .or. is_unfinished)) then
         if (request%resume .and. request%shards > 0) &
            call look_into_shard(previous, watch, summary, is_unfinished, error)
         if (.not. (is_unfinished .or. allocated(error))) &
            call check_finished(request, job%files, previous, job%part%count(), &
         is_finished, error)
      end if
      if (allocated(error) .or. is_finished) return
      if (is_unfinished) then
         call open_checkpoint(watch%file, watch%path, watch%identity, summary, error, &
            anew=.not. request%resume)
      else if (request%resume .and. previous%has_hdf5) then
         call check_columns(previous%path, error)
      else if (watch%keeps) then
         ! detect a wrong path now, not after hours
         call make_directory(job%files%directory(), error)
      end if
      if (allocated(error)) return
      if (is_unfinished .and. .not. request%resume) call remark(quoted_path(watch%path) &
         //' is given up, the sweep begins anew (--resume would go on with it)')
      ! files do not contain why a point has no result: it is solved again, to the same bits
      where (summary%status == point_invalid .or. summary%status == point_failed) &
         summary%status = point_pending
      watch%done = count(summary%status /= point_pending)
      watch%done_before = watch%done
      watch%grid = job%sweep%grid
      watch%start = clock()
      watch%shows = stderr_is_terminal() .and. .not. request%quiet
   end subroutine begin

   !> Read an existing shard; damaged points of a finished one are solved again
   subroutine look_into_shard(previous, watch, summary, is_unfinished, error)
      !> The existing shard, if any
      type(previous_t), intent(in) :: previous
      type(watch_t), intent(in) :: watch
      !> Its outcomes, allocated
      type(summary_t), intent(inout) :: summary
      !> Whether points remain to be solved; its file is then renamed to that of an unfinished one
      logical, intent(out) :: is_unfinished
      type(error_t), allocatable, intent(out) :: error

      is_unfinished = .false.
      if (.not. previous%exist .or. allocated(previous%objection)) return
      call read_points(previous%path, watch%identity, summary, error)
      if (allocated(error)) return
      is_unfinished = any(summary%status == point_pending)
      if (is_unfinished) call move_file(previous%path, watch%path, error)
   end subroutine look_into_shard

   !> Finish a sweep: write the results, or report what stopped it
   subroutine finish(request, job, watch, previous, summary, failures, stopped, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      type(watch_t), intent(inout) :: watch
      !> Results that existed before
      type(previous_t), intent(in) :: previous
      type(summary_t), intent(inout) :: summary
      type(failures_t), intent(in) :: failures
      !> Signal that ended the sweep; 0: none
      integer, intent(in) :: stopped
      type(error_t), allocatable, intent(out) :: error

      type(error_t), allocatable :: trouble
      logical :: is_shard

      is_shard = request%shards > 0
      if (watch%keeps .and. .not. watch%file%is_open() .and. (is_shard .or. stopped /= 0)) then
         call create_checkpoint(watch%file, watch%path, watch%identity, watch%grid, summary, &
            error)
         if (allocated(error)) return
      end if
      if (stopped /= 0) then
         call raise(error, signal_base + stopped, job%case%source//': stopped by ' &
            //signal_name(stopped)//' after '//integer_text(watch%done)//' of ' &
            //integer_text(job%part%count())//' points')
         if (watch%keeps) error%message = error%message//', which are in ' &
            //quoted_path(watch%path)//'; the same command with --resume goes on'
         return
      end if
      call end_of_sweep(job, failures, error)
      if (is_shard) then
         call finish_shard(request, job, watch, failures, trouble)
      else
         call finish_whole(request, job, watch, summary, failures, trouble)
      end if
      if (allocated(trouble)) then
         call move_alloc(trouble, error)
      else
         call remark(replacement_note(previous))
      end if
   end subroutine finish

   !> Write the results of a whole sweep
   subroutine finish_whole(request, job, watch, summary, failures, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      type(watch_t), intent(inout) :: watch
      type(summary_t), intent(inout) :: summary
      type(failures_t), intent(in) :: failures
      type(error_t), allocatable, intent(out) :: error

      type(table_t) :: tables(1)
      character(len=:), allocatable :: files, validity, less

      call warn_of_bands(job%case, job%sweep%grid, summary)
      if (size(request%names) > 0) then
         validity = points_remark(job%sweep%grid, summary)
      else
         validity = points_report(job%sweep%grid, summary)
      end if
      associate (identity => watch%identity)
         call summary_table(tables(1), identity%title, identity%case_text, job%sweep%grid, summary)
         call write_files(job%files, tables, files, error, identity%data, threads_of(request))
         if (allocated(error)) return
         ! results are complete under their final names
         call watch%file%remove()
         if (size(request%names) > 0) then
            call write_numbers(request, tables(1), error)
            if (request%quiet) return
            less = ''
            if (failures%inexact%count > 0) less = inexact(job, failures)
            call remark(about_numbers(job%case, joined(less, validity)))
         else if (.not. request%quiet) then
            call write_stdout(report(job, identity%title, failures, files, &
               tables(1), validity), error)
         end if
      end associate
   end subroutine finish_whole

   !> Rename the file of a finished shard
   subroutine finish_shard(request, job, watch, failures, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      type(watch_t), intent(inout) :: watch
      type(failures_t), intent(in) :: failures
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: path

      path = job%files%path//trim(job%files%endings(3))
      call watch%file%close_as(path, error)
      if (.not. allocated(error) .and. .not. request%quiet) &
         call write_stdout(report(job, watch%identity%title, failures, &
            '  written '//path//nl), error)
   end subroutine finish_shard

   !> Raise an error if points have no result, after all points are done
   subroutine end_of_sweep(job, failures, error)
      type(job_t), intent(in) :: job
      type(failures_t), intent(in) :: failures
      !> Error of code `error_numerical`, unallocated if all points have a result
      type(error_t), allocatable, intent(out) :: error

      if (failures%count == 0) return
      call raise(error, error_numerical, job%case%source//': '//integer_text(failures%count) &
         //' of '//integer_text(job%part%count())//' points'//shard_text(job%part) &
         //' without result, the first at ' &
         //coordinates(job%sweep%grid, failures%reason(1)%first)//': ' &
         //trim(failures%reason(1)%message))
   end subroutine end_of_sweep

   !> Report of a sweep or a shard: swept parameters, ranges of the outcomes, points without a
   !> result and the reasons
   function report(job, title, failures, files, summary, validity) result(text)
      type(job_t), intent(in) :: job
      character(len=*), intent(in) :: title
      type(failures_t), intent(in) :: failures
      !> Written files, one per line
      character(len=*), intent(in) :: files
      !> Outcomes of a whole sweep
      type(table_t), intent(in), optional :: summary
      !> Report of their validity, one item per line
      character(len=*), intent(in), optional :: validity
      character(len=:), allocatable :: text

      character(len=:), allocatable :: method
      integer :: i
      logical :: history

      text = heading(job%case%source, title)
      do i = 1, size(job%sweep%grid%axes)
         associate (axis => job%sweep%grid%axes(i), n => size(job%sweep%grid%axes(i)%values))
            text = text//trim(padded('  '//axis%name, 50)//significant(axis%values(1))//' ..' &
               //significant(axis%values(n))//' '//padded(axis%unit, 8)//' '//integer_text(n) &
               //merge(' value ', ' values', n == 1))//nl
         end associate
      end do
      text = text//nl//'  '//integer_text(job%part%count())
      if (job%part%parts > 1) text = text//' of '//integer_text(job%part%points)
      ! with `auto` the method may differ between points
      call job%case%get('solver', 'method', method)
      if (method /= 'auto' .or. job%method /= 'ive') method = job%method
      text = text//' impacts'//shard_text(job%part)//', '//method//nl
      if (present(summary)) text = text//nl//ranges(summary)
      if (failures%count > 0) text = text//nl//reasons(job, failures)
      if (present(validity)) then
         if (len(validity) > 0) text = text//nl//validity
      end if
      if (failures%inexact%count > 0) text = text//nl//'  note: '//inexact(job, failures)//nl
      call job%case%get('output', 'history', history)
      if (history .and. any(job%files%writes) .and. job%part%parts == 1) text = text//nl &
         //'  note: time histories are written of single impacts only'//nl
      if (len(files) > 0) text = text//nl//files
      text = text//nl
   end function report

   !> Smallest and largest outcomes
   function ranges(summary) result(text)
      type(table_t), intent(in) :: summary
      character(len=:), allocatable :: text

      character(len=:), allocatable :: line
      real(wp) :: least, most
      type(quantity_t), allocatable :: columns(:)
      logical :: any_there
      integer :: i, k

      allocate (columns, source=quantities())
      text = padded('', 58)//'        smallest         largest'//nl
      do i = 1, size(shown)
         associate (quantity => columns(quantity_place(shown(i))), &
                    column => summary%columns(place_in_table(summary, trim(shown(i))) &
                    - size(summary%dimensions)))
            any_there = .false.
            do k = 1, column%length
               if (ieee_is_nan(column%reals(k))) cycle
               if (.not. any_there) then
                  least = column%reals(k)
                  most = least
               end if
               any_there = .true.
               least = min(least, column%reals(k))
               most = max(most, column%reals(k))
            end do
            if (.not. any_there) cycle
            line = padded('  '//trim(quantity%meaning), 50)//padded(quantity%symbol, 8) &
               //significant(least)//significant(most)
            if (quantity%unit /= '1') line = line//' '//trim(quantity%unit)
            text = text//line//nl
         end associate
      end do
   end function ranges

   !> Points without a result, and the reasons
   function reasons(job, failures) result(text)
      type(job_t), intent(in) :: job
      type(failures_t), intent(in) :: failures
      character(len=:), allocatable :: text

      integer :: i

      text = '  '//integer_text(failures%count)//' of '//integer_text(job%part%count()) &
         //' points'//shard_text(job%part)//' without result:'//nl
      do i = 1, failures%reasons
         associate (reason => failures%reason(i))
            text = text//'  '//right(integer_text(reason%count), 8)//'  ' &
               //trim(reason%message)//nl &
               //'            first at point '//integer_text(reason%first)//': ' &
               //coordinates(job%sweep%grid, reason%first)//nl
         end associate
      end do
   end function reasons

   !> Number of points that are less accurate than requested
   function inexact(job, failures) result(text)
      type(job_t), intent(in) :: job
      !> Reasons, with the count of inexact points
      type(failures_t), intent(in) :: failures
      !> One line
      character(len=:), allocatable :: text

      text = integer_text(failures%inexact%count)//' of '//integer_text(job%part%count()) &
         //' points'//shard_text(job%part)//' have an estimated error above the accuracy ' &
         //'asked for, the first one is point '//integer_text(failures%inexact%first)//': ' &
         //coordinates(job%sweep%grid, failures%inexact%first)
   end function inexact

   !> Store finished points and show progress; the monitor's `finished`
   subroutine finished(self, first, last, count, summary, error)
      class(watch_t), intent(inout) :: self
      !> First place that may have changed
      integer, intent(in) :: first
      !> Last place that may have changed
      integer, intent(in) :: last
      !> Number of newly finished points between these places
      integer, intent(in) :: count
      type(summary_t), intent(inout) :: summary
      !> Set if they cannot be stored; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: now

      now = clock()
      self%done = self%done + count
      if (self%file%is_open()) then
         call self%file%put(first, last, summary, error)
      else if (self%keeps .and. now - self%start > time_without_file) then
         call create_checkpoint(self%file, self%path, self%identity, self%grid, summary, &
            error)
      end if
      if (allocated(error)) return
      if (self%shows .and. now - self%shown > time_between_lines) then
         call show(self, now - self%start)
         self%shown = now
      end if
   end subroutine finished

   !> Show the progress of the sweep
   subroutine show(self, time)
      type(watch_t), intent(in) :: self
      !> Time since the start [s]
      real(wp), intent(in) :: time

      character(len=:), allocatable :: line
      real(wp) :: rate
      integer :: points

      points = self%identity%part%count()
      rate = real(self%done - self%done_before, wp)/max(time, epsilon(time))
      line = '  '//integer_text(self%done)//' of '//integer_text(points)//' points, ' &
         //integer_text(int(100.0_wp*real(self%done, wp)/real(points, wp)))//' %, ' &
         //rate_text(rate)//', '//time_text(real(points - self%done, wp)/rate)//' left'
      call write_terminal(achar(13)//line//repeat(' ', max(0, width - len(line))))
   end subroutine show

   !> A rate as text
   function rate_text(rate) result(text)
      !> Points per second
      real(wp), intent(in) :: rate
      !> The rate, per minute or hour if it is small
      character(len=:), allocatable :: text

      if (rate >= 1.0_wp) then
         text = integer_text(nint(rate))//'/s'
      else if (rate >= 1.0_wp/60.0_wp) then
         text = integer_text(nint(60.0_wp*rate))//'/min'
      else
         text = integer_text(nint(3600.0_wp*rate))//'/h'
      end if
   end function rate_text

   !> A time in hours, minutes and seconds
   function time_text(time) result(text)
      !> Time [s]
      real(wp), intent(in) :: time
      !> Such as `1:02:03`
      character(len=:), allocatable :: text

      real(wp), parameter :: longest = 1.0e9_wp
      character(len=16) :: buffer
      integer :: left

      left = ceiling(min(time, longest))
      write (buffer, '(i0, 2(":", i2.2))') left/3600, mod(left, 3600)/60, mod(left, 60)
      text = trim(buffer)
   end function time_text

   !> Erase the progress line
   subroutine clear(self)
      class(watch_t), intent(inout) :: self

      if (self%shown > 0.0_wp) &
         call write_terminal(achar(13)//repeat(' ', width)//achar(13))
      self%shown = 0.0_wp
   end subroutine clear

   !> Number of threads of each rank
   function threads_of(request) result(threads)
      type(request_t), intent(in) :: request
      integer :: threads

      threads = request%threads
      if (threads == 0) threads = default_threads()
   end function threads_of

end module vcor_app_sweep
