!> Solve the points of a sweep, or of a part of it, on all ranks and their threads; a single impact
!> is a sweep of one point
!>
!> A point is the case with some numbers replaced. The problem of the case follows these numbers, so
!> no point reads, looks up or checks the whole case, or computes the rules of a solver again. A
!> point that is impossible or cannot be solved has a status instead of numbers and does not stop
!> the others.
!>
!> The work is done in rounds. In a round each rank solves its part of the next points, the first
!> rank gathers the outcomes, and all ranks agree on the length of the next round and whether there
!> is one. Outcomes are stored by the place of their point, so they are bitwise the same for any
!> number of ranks and threads. Points without a result are grouped by reason, and those less
!> accurate than requested are counted.
!>
!> Procedures that threads call have no static storage. gfortran 12 keeps the length of a function
!> result of deferred length there: such a function is called before the threads begin, or by one
!> thread at a time.
module vcor_sweep_points
   use, intrinsic :: iso_fortran_env, only : int64
!$ use omp_lib, only : omp_get_max_threads, omp_get_thread_num
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, wanted
   use vcor_case_grid, only : grid_t, new_grid
   use vcor_case_problem, only : may_contribute, problem_of_case, problem_t
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_lasting, contact_resting, contact_separated, &
      contact_sticking, trajectory_t
   use vcor_kinds, only : wp
   use vcor_number, only : contains_number, interval_t
   use vcor_sweep_mpi, only : from_first_rank, gathered, largest_of_ranks, rank_count, this_rank
   use vcor_sweep_part, only : most_threads, new_part, part_t
   use vcor_sweep_quantity, only : new_summary, point_failed, point_invalid, point_pending, &
      summary_t, values_of
   use vcor_text, only : integer_text
   implicit none
   private

   public :: sweep_t, new_sweep, worker_t, solve_point
   public :: failure_t, failures_t, solve_sweep, solve_points, monitor_t, default_threads, clock

   !> All impacts of a case; immutable once built, so that threads can share it
   type :: sweep_t
      !> Grid of its points
      type(grid_t) :: grid
      !> The case, with the first valid value of each parameter that varies
      type(case_t), private :: case
      !> Problem of this case
      type(problem_t) :: problem
      !> Valid ranges of the parameters that vary, shape (axes)
      type(interval_t), allocatable, private :: ranges(:)
      !> Message for a value out of range, shape (axes)
      type(error_t), allocatable, private :: objections(:)
   contains
      procedure :: is_grid
   end type sweep_t

   !> Working storage of one thread: its current impact
   type :: worker_t
      !> The impact and its solver
      type(problem_t) :: problem
      !> Its trajectory
      type(trajectory_t) :: trajectory
      !> The case with the numbers of the impact
      type(case_t), private :: case
      !> Whether case and problem have been copied from the sweep
      logical, private :: is_ready = .false.
   end type worker_t

   !> Target time of a round [s]: a killed process loses no more, and it is long against the time in
   !> which ranks and threads wait for each other at its end
   real(wp), parameter :: round_time = 0.2_wp
   !> Minimum points of a round per thread, so that threads end at about the same time
   integer, parameter :: min_points = 4
   !> Largest ratio of the length of a round to the one before
   integer, parameter :: growth = 4
   !> Largest number of points that a thread takes at once
   integer, parameter :: longest_chunk = 16

   !> Largest number of different reasons
   integer, parameter :: most_reasons = 20

   !> A reason, of fixed length so that ranks can send it
   type :: failure_t
      integer :: count = 0
      !> Number of its first point
      integer :: first = huge(1)
      !> Message of that point; blank: the estimated error is above the requested accuracy
      character(len=504) :: message = ''
   end type failure_t

   !> All reasons
   type :: failures_t
      !> Number of points without a result
      integer :: count = 0
      integer :: reasons = 0
      !> Reasons; 1 .. `reasons` are in use
      type(failure_t) :: reason(most_reasons)
      !> Points with an estimated error above the requested accuracy
      type(failure_t) :: inexact
   contains
      procedure :: note, sort, add_packed
      procedure :: pack => pack_reasons
   end type failures_t

   !> Observer of a sweep: it stores results, shows progress and may stop the sweep
   type, abstract :: monitor_t
   contains
      !> Called when points are finished
      procedure(finished_i), deferred :: finished
      !> Whether the sweep has to stop
      procedure(stop_code_i), deferred, nopass :: stop_code
   end type monitor_t

   abstract interface
      !> Called on the first rank when points are finished
      subroutine finished_i(self, first, last, count, summary, error)
         import :: error_t, monitor_t, summary_t
         class(monitor_t), intent(inout) :: self
         !> First place that may have changed
         integer, intent(in) :: first
         !> Last place that may have changed
         integer, intent(in) :: last
         !> Number of newly finished points between these places
         integer, intent(in) :: count
         type(summary_t), intent(inout) :: summary
         !> Error that ends the sweep, such as a full disk; unallocated on success
         type(error_t), allocatable, intent(out) :: error
      end subroutine finished_i

      !> Whether the sweep has to stop after the points in progress
      function stop_code_i() result(code)
         !> 0 to continue; any other code is passed to the caller of the sweep
         integer :: code
      end function stop_code_i
   end interface

contains

   !> Whether the case has a &sweep group
   pure function is_grid(self) result(yes)
      class(sweep_t), intent(in) :: self
      logical :: yes

      yes = size(self%grid%axes) > 0
   end function is_grid

   !> Build what all impacts of a case have in common
   subroutine new_sweep(self, case, error)
      type(sweep_t), intent(out) :: self
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i, j, n, row

      call new_grid(case, self%grid, error)
      if (allocated(error)) return
      self%case = case
      n = size(self%grid%axes)
      allocate (self%ranges(n), self%objections(n))
      do i = 1, n
         row = case%row(self%grid%axes(i)%address)
         associate (axis => self%grid%axes(i), key => catalogue(row))
            self%ranges(i) = key%range
            self%objections(i)%message = axis%name//' is out of range, expected '//wanted(key)
            call self%case%oust(axis%address, always=.true.)
            do j = 1, size(axis%values)
               if (.not. contains_number(key%range, axis%values(j))) cycle
               call self%case%set(axis%address, axis%values(j))
               exit
            end do
         end associate
      end do
      call problem_of_case(self%problem, self%case, error)
      if (.not. allocated(error)) return
      ! other values of the parameters that vary may be valid
      do i = 1, n
         if (.not. may_contribute(self%case, self%grid%axes(i)%address, error)) cycle
         deallocate (error)
         return
      end do
   end subroutine new_sweep

   !> Solve one point
   subroutine solve_point(self, point, worker, outcome, error)
      type(sweep_t), intent(in) :: self
      !> Index of the point, from 1
      integer, intent(in) :: point
      !> Working storage of the thread: a new one, or that of an earlier point
      type(worker_t), intent(inout) :: worker
      !> Outcome; without numbers on failure
      type(outcome_t), intent(out) :: outcome
      !> Error of code `error_input` if the parameters describe no impact that can be solved, of
      !> another code if the solution fails; unallocated on success, even without separation
      type(error_t), allocatable, intent(out) :: error

      real(wp) :: value
      integer :: i, place(size(self%grid%axes))

      if (.not. worker%is_ready) then
         worker%case = self%case
         worker%problem = self%problem
         worker%is_ready = .true.
      end if
      place = self%grid%places(point)
      do i = 1, size(place)
         value = self%grid%axes(i)%values(place(i))
         if (contains_number(self%ranges(i), value)) then
            call worker%case%set(self%grid%axes(i)%address, value)
         else if (.not. allocated(error)) then
            call raise(error, error_input, self%objections(i)%message)
         end if
      end do
      if (.not. allocated(error)) call worker%problem%update(worker%case, error)
      if (.not. allocated(error)) call worker%problem%solve(worker%trajectory, &
         outcome, error)
      if (.not. allocated(error)) return
      outcome = outcome_t(status=merge(point_invalid, point_failed, error%code == error_input), &
         steps=outcome%steps)
   end subroutine solve_point

   !> Reason why an impact has no coefficient of restitution
   pure function why_no_result(status) result(reason)
      integer, intent(in) :: status
      !> In words; empty if it has one
      character(len=:), allocatable :: reason

      select case (status)
      case (contact_separated, contact_resting)
         reason = ''
      case (contact_lasting)
         reason = 'the bodies do not separate within solver.end_time'
      case (contact_sticking)
         reason = 'the sphere sticks: all motion dies out in contact'
      case default
         reason = 'no result'
      end select
   end function why_no_result

   !> Default number of threads: the cores that the process may use, or OMP_NUM_THREADS of the
   !> environment
   function default_threads() result(threads)
      !> Number, >= 1; without OpenMP 1
      integer :: threads

      threads = 1
!$    threads = min(omp_get_max_threads(), most_threads)
   end function default_threads

   !> Solve all points of a sweep
   subroutine solve_sweep(sweep, threads, summary, failures, error)
      type(sweep_t), intent(in) :: sweep
      !> Number of threads, > 0; without OpenMP there is one
      integer, intent(in) :: threads
      !> Outcomes, each at the index of its point
      type(summary_t), intent(out) :: summary
      !> Points without a result, and the reasons
      type(failures_t), intent(out) :: failures
      !> Error of code `error_file` if memory is too small, `error_input` if sweep or threads are
      !> invalid; unallocated on success, even if no point has a result
      type(error_t), allocatable, intent(out) :: error

      if (.not. allocated(sweep%grid%axes)) then
         call raise(error, error_input, 'the sweep is empty: new_sweep has not built it')
      else if (threads < 1 .or. threads > most_threads) then
         call raise(error, error_input, 'found '//integer_text(threads)//' threads, expected ' &
            //'1 to '//integer_text(most_threads))
      end if
      if (.not. allocated(error)) &
         call new_summary(summary, sweep%grid%count(), error, threads)
      if (.not. allocated(error)) call solve_points(sweep, new_part(sweep%grid%count(), 1, 1), &
         threads, summary, failures, error)
   end subroutine solve_sweep

   !> Solve the pending points of a part of a sweep; all ranks call this
   subroutine solve_points(sweep, part, threads, summary, failures, error, monitor, stopped)
      type(sweep_t), intent(in) :: sweep
      !> Part of its points
      type(part_t), intent(in) :: part
      !> Threads of this rank, > 0; without OpenMP there is one
      integer, intent(in) :: threads
      !> On the first rank the outcomes at all places of the part; those already there are kept
      type(summary_t), intent(inout) :: summary
      !> On the first rank the points without a result, and the reasons
      type(failures_t), intent(out) :: failures
      !> Error that ended the sweep, which may differ between ranks; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Observer of the sweep
      class(monitor_t), intent(inout), optional :: monitor
      !> Stop code of the monitor if it ended the sweep early, 0 otherwise
      integer, intent(out), optional :: stopped

      !> Working storage of the threads of this rank, kept from round to round
      type(worker_t), allocatable :: workers(:)
      integer, allocatable :: pending(:)
      real(wp), allocatable :: numbers(:)
      real(wp) :: start
      integer :: agreed(3), done, length, i

      allocate (pending(0))
      if (this_rank() == 0) then
         pending = pack([(i, i=1, part%count())], summary%status == point_pending)
         do i = 1, part%count()
            if (any(summary%status(i) == [contact_lasting, contact_sticking])) &
               call failures%note(part%point(i), why_no_result(summary%status(i)))
         end do
      end if
      pending = from_first_rank(pending)
      allocate (workers(threads))
      done = 0
      length = min_points*threads*rank_count()
      do
         ! length of the next round from the first rank; a wish to stop from any rank
         agreed = [merge(length, 0, this_rank() == 0), stop_code(monitor), &
            merge(1, 0, allocated(error))]
         agreed = largest_of_ranks(agreed)
         if (done == size(pending) .or. any(agreed(2:) /= 0)) exit
         start = clock()
         length = min(agreed(1), size(pending) - done)
         call solve_round(pending(done + 1:done + length))
         done = done + length
         length = max(min_points*threads*rank_count(), min(growth*length, &
            int(real(length, wp)*round_time/max(clock() - start, epsilon(start)))))
      end do
      if (agreed(3) /= 0) return
      if (this_rank() > 0) then
         numbers = failures%pack()
      else
         allocate (numbers(0))
      end if
      numbers = gathered(numbers)
      call failures%add_packed(numbers)
      call failures%sort()
      if (.not. present(stopped)) return
      stopped = agreed(2)
      ! a stop after the last point has no effect
      if (this_rank() == 0) then
         if (.not. any(summary%status == point_pending)) stopped = 0
      end if

   contains

      !> Solve the points of a round, each rank its part
      subroutine solve_round(places)
         !> Places of the points of the round
         integer, intent(in) :: places(:)

         type(part_t) :: own
         !> Outcomes as numbers, a column for each point of `own`
         real(wp), allocatable :: rows(:, :)
         real(wp), allocatable :: numbers(:)
         integer :: columns, team, chunk, count, i, j, k

         own = new_part(size(places), this_rank() + 1, rank_count())
         columns = size(values_of(outcome_t()))
         allocate (rows(columns, own%count()))
         team = max(1, min(threads, own%count()))
         ! small enough for all threads to end at about the same time
         chunk = max(1, min(longest_chunk, own%count()/(8*team)))
!$omp parallel default(none) num_threads(team) &
!$omp shared(sweep, part, own, places, chunk, workers, rows, failures, monitor)
         block
            type(outcome_t) :: outcome
            type(error_t), allocatable :: trouble
            integer :: point, thread

            thread = 1
!$          thread = omp_get_thread_num() + 1
!$omp do schedule(dynamic, chunk)
            do j = 1, size(rows, 2)
               if (stop_code(monitor) /= 0) then
                  rows(:, j) = values_of(outcome_t(status=point_pending))
                  cycle
               end if
               point = part%point(places(own%point(j)))
               call solve_point(sweep, point, workers(thread), outcome, trouble)
               rows(:, j) = values_of(outcome)
               if (any(outcome%status == [contact_separated, contact_resting]) &
                   .and. .not. outcome%misses()) cycle
!$omp critical (vcor_failures)
               if (allocated(trouble)) then
                  call failures%note(point, trouble%message)
               else
                  call failures%note(point, why_no_result(outcome%status))
               end if
!$omp end critical (vcor_failures)
            end do
!$omp end do
         end block
!$omp end parallel
         numbers = gathered(reshape(rows, [size(rows)]))
         if (this_rank() > 0) return
         count = 0
         k = 0
         do i = 1, rank_count()
            own = new_part(size(places), i, rank_count())
            do j = 1, own%count()
               call summary%put(places(own%point(j)), numbers(k + 1:k + columns))
               if (nint(numbers(k + columns)) /= point_pending) count = count + 1
               k = k + columns
            end do
         end do
         if (present(monitor)) call monitor%finished(places(1), places(size(places)), count, &
            summary, error)
      end subroutine solve_round
   end subroutine solve_points

   !> Stop code of a monitor, if there is one
   function stop_code(monitor) result(code)
      !> Observer of the sweep
      class(monitor_t), intent(in), optional :: monitor
      !> 0 to continue
      integer :: code

      code = 0
      if (present(monitor)) code = monitor%stop_code()
   end function stop_code

   !> Wall-clock time
   function clock() result(time)
      !> Time since an arbitrary origin, > 0 [s]
      real(wp) :: time

      integer(int64) :: count, rate

      call system_clock(count, rate)
      time = real(count, wp)/real(rate, wp)
   end function clock

   !> Count points for a reason. The result does not depend on the order of calls, as long as there
   !> are no more than `most_reasons` reasons; the last one includes the rest
   pure subroutine note(self, point, message, count)
      class(failures_t), intent(inout) :: self
      !> Index of the first of the points
      integer, intent(in) :: point
      !> Why they have no result; messages that differ only in numbers are one reason. Empty: they
      !> have a result with an estimated error above the requested accuracy
      character(len=*), intent(in) :: message
      !> Number of points; absent: 1
      integer, intent(in), optional :: count

      integer :: i, n

      n = 1
      if (present(count)) n = count
      if (message == '') then
         call add(self%inexact)
         return
      end if
      self%count = self%count + n
      do i = 1, self%reasons
         if (words_of(trim(self%reason(i)%message)) == words_of(message)) exit
      end do
      i = min(i, most_reasons)
      self%reasons = max(self%reasons, i)
      call add(self%reason(i))

   contains

      !> Add the points to a reason
      pure subroutine add(reason)
         type(failure_t), intent(inout) :: reason

         reason%count = reason%count + n
         if (point > reason%first) return
         reason%first = point
         reason%message = message
      end subroutine add
   end subroutine note

   !> All reasons as numbers, which ranks can send
   pure function pack_reasons(self) result(numbers)
      class(failures_t), intent(in) :: self
      !> Numbers, shape (n)
      real(wp), allocatable :: numbers(:)

      numbers = transfer([self%inexact, self%reason(:self%reasons)], [1.0_wp])
   end function pack_reasons

   !> Add reasons from numbers
   pure subroutine add_packed(self, numbers)
      class(failures_t), intent(inout) :: self
      !> Numbers from any number of calls of `pack`, shape (n)
      real(wp), intent(in) :: numbers(:)

      type(failure_t), allocatable :: others(:)
      integer :: i

      allocate (others, source=transfer(numbers, [failure_t ::]))
      do i = 1, size(others)
         if (others(i)%count > 0) &
            call self%note(others(i)%first, trim(others(i)%message), others(i)%count)
      end do
   end subroutine add_packed

   !> Sort the reasons by their first point
   pure subroutine sort(self)
      class(failures_t), intent(inout) :: self

      type(failure_t) :: other
      integer :: i, j

      do i = 2, self%reasons
         do j = i, 2, -1
            if (self%reason(j - 1)%first < self%reason(j)%first) exit
            other = self%reason(j)
            self%reason(j) = self%reason(j - 1)
            self%reason(j - 1) = other
         end do
      end do
   end subroutine sort

   !> A message without its numbers
   pure function words_of(message) result(words)
      character(len=*), intent(in) :: message
      !> The text without the characters of numbers
      character(len=:), allocatable :: words

      character(len=*), parameter :: numeric = '0123456789+-.eE'
      character(len=len(message)) :: buffer
      integer :: i, n

      n = 0
      buffer = ''
      do i = 1, len(message)
         if (index(numeric, message(i:i)) > 0) cycle
         n = n + 1
         buffer(n:n) = message(i:i)
      end do
      words = buffer(:n)
   end function words_of

end module vcor_sweep_points
