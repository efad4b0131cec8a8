!> The command run for a sweep, on all ranks and their threads
!>
!> Only the first rank reads and writes files and prints.
module vcor_app_sweep
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_app_cli, only : request_t
   use vcor_app_files, only : claim_files, remark, write_files, write_numbers
   use vcor_app_job, only : job_t
   use vcor_app_screen, only : blocks, digits_of_level, heading, padded, right
   use vcor_app_sweep_validity, only : exact_points, points_remark, points_report
   use vcor_app_validity, only : about_numbers
   use vcor_app_warnings, only : warn_of_data
   use vcor_case_grid, only : coordinates, grid_t
   use vcor_case_printed, only : case_text
   use vcor_error, only : error_input, error_numerical, error_t, raise
   use vcor_impact_validity, only : level_none
   use vcor_io_crc, only : crc32
   use vcor_io_file, only : stderr_is_terminal, write_stdout, write_terminal
   use vcor_rounded, only : plain_number, significant
   use vcor_io_restart, only : create_restart, hash_of, open_restart, restart_t
   use vcor_text, only : integer_text
   use vcor_words, only : joined
   use vcor_io_results, only : summary_table
   use vcor_io_table, only : place_in_table, table_t
   use vcor_kinds, only : unset, wp
   use vcor_sweep_mpi, only : differs, largest_of_ranks, share_error, this_rank
   use vcor_sweep_points, only : clock, default_threads, failures_t, monitor_t, solve_points
   use vcor_sweep_quantity, only : new_summary, point_pending, quantities, quantity_names, &
      quantity_place, quantity_t, status_name, summary_t
   implicit none
   private

   public :: run_sweep

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')

   !> Time after which a sweep gets a file of finished points [s]; a shorter one is quickly repeated
   real(wp), parameter :: time_without_file = 1.0_wp
   !> Minimum time between two progress lines [s]
   real(wp), parameter :: time_between_lines = 0.2_wp
   !> Time left from which on it is said once where stderr is no terminal, such as a log [s]
   real(wp), parameter :: long = 10.0_wp
   !> Length of the progress line
   integer, parameter :: width = 72

   !> Observer of a sweep that keeps finished points in a file and shows its progress
   type, extends(monitor_t) :: watch_t
      !> Path of the file; empty if there is none
      character(len=:), allocatable :: path
      !> Check sum of the case
      integer :: hash = 0
      type(restart_t) :: file
      !> Whether to show progress on the terminal
      logical :: shows = .false.
      !> Where it is none: whether the time that is left is still to be said
      logical :: tells = .false.
      !> Points of the sweep
      integer :: points = 0
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
   end type watch_t

contains

   !> Run the sweep of a case; all ranks call this
   subroutine run_sweep(request, job, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      !> Error of code `error_numerical` if points have no result, of another code for other
      !> failures; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(summary_t) :: summary
      type(failures_t) :: failures
      type(watch_t) :: watch

      watch%hash = hash_of(job%case)
      ! ranks exchange rows of numbers: versions with other columns must not mix
      if (differs(crc32(quantity_names(), watch%hash))) then
         call raise(error, error_input, job%case%source//': not all ranks read the same case, or ' &
            //'have the same version of vcor')
         return
      end if
      if (this_rank() == 0) call begin(request, job, watch, summary, error)
      call share_error(error)
      if (allocated(error)) return
      call solve_points(job%sweep, threads_of(request), summary, failures, error, watch)
      if (this_rank() == 0) then
         call watch%clear()
         if (.not. allocated(error)) call finish(request, job, watch, summary, failures, error)
         call watch%file%close()
      end if
      call share_error(error)
   end subroutine run_sweep

   !> Find the points that remain
   subroutine begin(request, job, watch, summary, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      type(watch_t), intent(inout) :: watch
      !> Outcomes of an interrupted run; the others are pending
      type(summary_t), intent(out) :: summary
      type(error_t), allocatable, intent(out) :: error

      logical :: unfinished

      watch%path = job%files%part
      watch%points = job%sweep%grid%count()
      call new_summary(summary, watch%points, error, threads_of(request))
      if (allocated(error)) error%message = job%case%source//': '//error%message
      if (.not. allocated(error)) call claim_files(job%files, request%resume, unfinished, error)
      if (allocated(error)) return
      if (unfinished) call open_restart(watch%file, watch%path, watch%hash, summary, error)
      watch%done = count(summary%status /= point_pending)
      watch%done_before = watch%done
      watch%start = clock()
      watch%shows = stderr_is_terminal() .and. .not. request%quiet
      watch%tells = .not. (watch%shows .or. request%quiet)
   end subroutine begin

   !> Write the results of a sweep
   subroutine finish(request, job, watch, summary, failures, error)
      type(request_t), intent(in) :: request
      type(job_t), intent(in) :: job
      type(watch_t), intent(inout) :: watch
      type(summary_t), intent(inout) :: summary
      type(failures_t), intent(in) :: failures
      type(error_t), allocatable, intent(out) :: error

      type(error_t), allocatable :: trouble
      type(table_t) :: tables(1)
      character(len=:), allocatable :: files, less, title, validity

      call end_of_sweep(job, failures, error)
      call warn_of_data(job%case, job%sweep%grid, summary)
      if (size(request%names) > 0) then
         validity = points_remark(job%sweep%grid, summary)
      else
         validity = points_report(job%sweep%grid, summary, job%sweep%problem%surroundings)
         if (.not. request%quiet .and. job%method /= 'coupled') &
            validity = validity//exact_points(job%case, job%sweep%grid, summary)
      end if
      call job%case%get('case', 'title', title)
      call summary_table(tables(1), title, case_text(job%case, complete=.true.), job%sweep%grid, &
         summary)
      call write_files(job%files, tables, files, trouble, threads_of(request))
      if (allocated(trouble)) then
         continue
      else if (size(request%names) > 0) then
         ! results stand under their names
         call watch%file%remove()
         call write_numbers(request, tables(1), trouble)
         less = ''
         if (failures%inexact%count > 0) less = inexact(job, failures)
         if (.not. request%quiet) call remark(about_numbers(job%case, joined(less, validity)))
      else
         call watch%file%remove()
         if (.not. request%quiet) call write_stdout(report(job, title, failures, files, tables(1), &
            validity), trouble)
      end if
      if (allocated(trouble)) call move_alloc(trouble, error)
   end subroutine finish

   !> Raise an error if points have no result, after all points are done
   subroutine end_of_sweep(job, failures, error)
      type(job_t), intent(in) :: job
      type(failures_t), intent(in) :: failures
      !> Error of code `error_numerical`, unallocated if all points have a result
      type(error_t), allocatable, intent(out) :: error

      if (failures%count == 0) return
      call raise(error, error_numerical, job%case%source//': '//integer_text(failures%count) &
         //' of '//integer_text(job%sweep%grid%count())//' points without result, the first at ' &
         //coordinates(job%sweep%grid, failures%kind(1)%first)//': '//failures%kind(1)%message)
   end subroutine end_of_sweep

   !> Report of a sweep: swept parameters, ranges of the outcomes, and points without a result
   function report(job, title, failures, files, summary, validity) result(text)
      type(job_t), intent(in) :: job
      character(len=*), intent(in) :: title
      type(failures_t), intent(in) :: failures
      !> Written files, one per line
      character(len=*), intent(in) :: files
      !> Outcomes
      type(table_t), intent(in) :: summary
      !> Report of their validity, one item per line
      character(len=*), intent(in) :: validity
      character(len=:), allocatable :: text

      character(len=:), allocatable :: method
      integer :: i
      logical :: history

      text = heading(job%case%source, title)
      do i = 1, size(job%sweep%grid%axes)
         associate (axis => job%sweep%grid%axes(i), n => size(job%sweep%grid%axes(i)%values))
            text = text//trim(padded('  '//axis%name, 50)//right(plain_number(axis%values(1), 8), &
               16)//' ..'//right(plain_number(axis%values(n), 8), 16)//' ' &
               //padded(axis%unit, 8)//' '//integer_text(n) &
               //merge(' value ', ' values', n == 1))//nl
         end associate
      end do
      ! with `auto` the method may differ between points
      call job%case%get('solver', 'method', method)
      if (method /= 'auto' .or. job%method /= 'ive') method = job%method
      text = text//nl//'  '//integer_text(job%sweep%grid%count())//' impacts, '//method//nl
      text = text//nl//ranges(job%sweep%grid, summary)
      if (failures%count > 0) text = text//nl//failed_points(job, failures)
      if (len(validity) > 0) text = text//nl//validity
      if (failures%inexact%count > 0) text = text//nl//'  note: '//inexact(job, failures)//nl
      call job%case%get('output', 'history', history)
      if (history .and. any(job%files%writes)) text = text//nl &
         //'  note: time histories are written for single impacts only'//nl
      if (len(files) > 0) text = text//nl//files
      text = text//nl
   end function report

   !> Smallest and largest outcomes, and where they are: values of the parameter, or numbers of the
   !> points where there are several parameters
   function ranges(grid, summary) result(text)
      type(grid_t), intent(in) :: grid
      type(table_t), intent(in) :: summary
      character(len=:), allocatable :: text

      character(len=:), allocatable :: line, lines
      type(quantity_t), allocatable :: columns(:)
      logical :: strikes_again
      integer :: first, last, i, j, k

      allocate (columns, source=quantities())
      strikes_again = maxval(summary%columns(place_in_table(summary, 'contacts') &
         - size(summary%dimensions))%integers) > 1
      text = padded('', 58)//'        smallest         at         largest         at'//nl
      if (size(grid%axes) > 1) text = padded('', 58) &
         //'        smallest   at point         largest   at point'//nl
      line = ''
      do i = 1, size(blocks)
         lines = ''
         do j = 1, size(blocks(i)%names)
            if (blocks(i)%names(j) == '') exit
            if (any(blocks(i)%names(j) == [character(len=15) :: 'contacts', 'last_separation']) &
                .and. .not. strikes_again) cycle
            associate (quantity => columns(quantity_place(blocks(i)%names(j))), &
                       values => numbers_of(summary, blocks(i)%names(j)))
               first = 0
               do k = 1, size(values)
                  if (ieee_is_nan(values(k))) cycle
                  if (first == 0) then
                     first = k
                     last = k
                  end if
                  if (values(k) < values(first)) first = k
                  if (values(k) > values(last)) last = k
               end do
               if (first == 0) cycle
               k = digits_between(values(first), values(last))
               line = padded('    '//trim(quantity%meaning), 50)//padded(quantity%symbol, 8) &
                  //significant(values(first), max(k, digits_at(blocks(i)%names(j), first))) &
                  //where_is(first) &
                  //significant(values(last), max(k, digits_at(blocks(i)%names(j), last))) &
                  //where_is(last)
               if (quantity%unit /= '1') line = line//' '//trim(quantity%unit)
               lines = lines//line//nl
            end associate
         end do
         if (lines /= '') text = text//'  '//trim(blocks(i)%title)//nl//lines
      end do

   contains

      !> Digits of a quantity that validity and error of a point leave
      function digits_at(name, point) result(digits)
         character(len=*), intent(in) :: name
         integer, intent(in) :: point
         integer :: digits

         character(len=*), parameter :: with_errors(*) = [character(len=12) :: 'cor', &
            'cor_sphere', 'contact_time', 'max_force']
         real(wp) :: error(1), value(1)

         error = 0.0_wp
         value = 1.0_wp
         if (any(name == with_errors)) then
            associate (values => numbers_of(summary, name), &
                       errors => numbers_of(summary, trim(name)//'_error'))
               value = values(point)
               error = errors(point)
            end associate
         end if
         associate (column => summary%columns(place_in_table(summary, 'validity') &
                    - size(summary%dimensions)))
            ! texts are counted from 1, levels from that of no result
            digits = digits_of_level(column%integers(point) - 1 + level_none, value(1), error(1))
         end associate
      end function digits_at

      !> Place of a point
      function where_is(point) result(place)
         integer, intent(in) :: point
         character(len=:), allocatable :: place

         place = right(integer_text(point), 11)
         if (size(grid%axes) == 1) place = right(plain_number(grid%axes(1)%values(point), 5), 11)
      end function where_is
   end function ranges

   !> Numbers of a column
   pure function numbers_of(summary, name) result(values)
      type(table_t), intent(in) :: summary
      character(len=*), intent(in) :: name
      real(wp), allocatable :: values(:)

      associate (column => summary%columns(place_in_table(summary, trim(name)) &
                 - size(summary%dimensions)))
         if (allocated(column%integers)) then
            values = real(column%integers, wp)
            ! 0 counts nothing: the point has no result
            where (column%integers == 0) values = unset
         else
            values = column%reals
         end if
      end associate
   end function numbers_of

   !> Digits that tell two numbers apart
   pure function digits_between(least, most) result(digits)
      real(wp), intent(in) :: least, most
      !> 2 .. 8
      integer :: digits

      digits = 2
      if (most > least) digits = min(8, max(2, &
         2 + ceiling(log10(max(abs(least), abs(most))/(most - least)))))
   end function digits_between

   !> Points without a result, by their status
   function failed_points(job, failures) result(text)
      type(job_t), intent(in) :: job
      type(failures_t), intent(in) :: failures
      character(len=:), allocatable :: text

      integer :: i

      text = '  '//integer_text(failures%count)//' of '//integer_text(job%sweep%grid%count()) &
         //' points without result:'//nl
      do i = 1, failures%kinds
         associate (kind => failures%kind(i))
            text = text//'  '//right(integer_text(kind%count), 8)//'  ' &
               //trim(status_name(kind%status))//', first at point ' &
               //integer_text(kind%first)//', ' &
               //coordinates(job%sweep%grid, kind%first)//':'//nl &
               //'            '//kind%message//nl
         end associate
      end do
   end function failed_points

   !> Number of points that are less accurate than requested
   function inexact(job, failures) result(text)
      type(job_t), intent(in) :: job
      type(failures_t), intent(in) :: failures
      !> One line
      character(len=:), allocatable :: text

      text = integer_text(failures%inexact%count)//' of '//integer_text(job%sweep%grid%count()) &
         //' points have an estimated error above the accuracy asked for, the first one is point ' &
         //integer_text(failures%inexact%first)//': ' &
         //coordinates(job%sweep%grid, failures%inexact%first)
   end function inexact

   !> Keep finished points and show progress; the monitor's `finished`
   subroutine finished(self, places, summary, error)
      class(watch_t), intent(inout) :: self
      !> The points
      integer, intent(in) :: places(:)
      type(summary_t), intent(in) :: summary
      !> Set if they cannot be kept; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: line
      real(wp) :: now, rate, left

      now = clock()
      self%done = self%done + size(places)
      if (self%file%is_open()) then
         call self%file%put(places, summary, error)
      else if (self%path /= '' .and. now - self%start > time_without_file) then
         call create_restart(self%file, self%path, self%hash, summary, error)
      end if
      if (allocated(error)) return
      rate = real(self%done - self%done_before, wp)/max(now - self%start, epsilon(now))
      left = real(self%points - self%done, wp)/rate
      line = integer_text(self%done)//' of '//integer_text(self%points)//' points, ' &
         //integer_text(int(100.0_wp*real(self%done, wp)/real(self%points, wp)))//' %, ' &
         //rate_text(rate)//', '//time_text(left)//' left'
      if (self%shows .and. now - self%shown > time_between_lines) then
         call write_terminal(achar(13)//'  '//line//repeat(' ', max(0, width - len(line))))
         self%shown = now
      else if (self%tells .and. now - self%start > time_without_file) then
         self%tells = .false.
         if (left > long) call write_terminal('vcor: note: '//line//new_line('a'))
      end if
   end subroutine finished

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
