!> Solve the points of a sweep on all ranks and their threads; a single impact is a sweep of one
!> point
!>
!> A point is the inputs of the case with some numbers replaced. The problem of the case is built
!> again where they differ, so no point reads, looks up or checks the case, or computes the rules of
!> a solver again. A
!> point that is impossible or cannot be solved has a status instead of numbers and does not stop
!> the others.
!>
!> The work is done in rounds. In a round the next points are dealt to the ranks, the threads of
!> each rank solve its share, the first rank gathers the outcomes, and all ranks agree on the length
!> of the next round and whether there is one. Outcomes are stored by the place of their point, so
!> they are bitwise the same for any number of ranks and threads. Points without a result are
!> counted by their status; the message of the first one of each is found by solving it once more.
!>
!> Procedures that threads call have no static storage. gfortran 12 keeps the length of a function
!> result of deferred length there: such a function is called before the threads begin, or by one
!> thread at a time.
module vcor_sweep_points
   use, intrinsic :: iso_fortran_env, only : int64
!$ use omp_lib, only : omp_get_max_threads, omp_get_thread_num
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, wanted
   use vcor_case_cause, only : may_contribute
   use vcor_case_grid, only : grid_t, new_grid
   use vcor_case_inputs, only : input_key_t, inputs_t
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_case_reader, only : quantity_at
   use vcor_case_reading, only : refuse_unread
   use vcor_error, only : error_input, error_t, raise
   use vcor_impact_outcome, only : outcome_t
   use vcor_impact_trajectory, only : contact_lasting, contact_sticking, trajectory_t
   use vcor_impact_validity, only : forgotten_base, surroundings_t
   use vcor_kinds, only : wp
   use vcor_number, only : contains_number, interval_t
   use vcor_sweep_mpi, only : from_first_rank, gathered, largest_of_ranks, rank_count, this_rank
   use vcor_sweep_quantity, only : new_summary, point_failed, point_invalid, point_pending, &
      row_of, summary_t
   use vcor_text, only : integer_text
   implicit none
   private

   public :: sweep_t, new_sweep, worker_t, solve_point
   public :: put_numbers, solve_numbers, name_reason, without_result
   public :: failure_t, failures_t, solve_sweep, solve_points, monitor_t
   public :: default_threads, most_threads, clock

   !> All impacts of a case; immutable once built, so that threads can share it
   type :: sweep_t
      !> Grid of its points
      type(grid_t) :: grid
      !> The case, with the first valid value of each parameter that varies
      type(case_t) :: case
      !> Problem of this case
      type(problem_t) :: problem
      !> Valid ranges of the parameters that vary, shape (axes)
      type(interval_t), allocatable, private :: ranges(:)
      !> Message for a value out of range, shape (axes)
      type(error_t), allocatable, private :: objections(:)
      !> The numbers of the inputs that vary, shape (axes)
      type(input_key_t), allocatable, private :: quantities(:)
   contains
      procedure :: is_grid
   end type sweep_t

   !> Working storage of one thread: its current impact
   type :: worker_t
      !> The impact and its solver
      type(problem_t) :: problem
      !> Its trajectory
      type(trajectory_t) :: trajectory
      !> The inputs with the numbers of the impact
      type(inputs_t), private :: inputs
      !> Whether inputs and problem have been copied from the sweep
      logical, private :: is_ready = .false.
   end type worker_t

   !> Target time of a round [s]: a killed process loses no more, and it is long against the time in
   !> which ranks and threads wait for each other at its end
   real(wp), parameter :: round_time = 0.2_wp
   !> Minimum points of a round per thread, so that threads end at about the same time: one of four
   !> points that takes twice as long keeps the others waiting for a fifth of the round
   integer, parameter :: min_points = 4
   !> Largest ratio of the length of a round to the one before, as the first points may be untypical
   integer, parameter :: growth = 4
   !> Largest number of points that a thread takes at once: 16 thin impacts take a millisecond,
   !> beside which taking them costs nothing
   integer, parameter :: longest_chunk = 16

   !> Largest number of threads of a process
   integer, parameter :: most_threads = 1024

   !> Statuses of points without a result
   integer, parameter :: without_result(*) = &
      [point_invalid, point_failed, contact_lasting, contact_sticking]

   !> Points of one kind
   type :: failure_t
      !> Their status
      integer :: status = point_pending
      integer :: count = 0
      !> Number of the first one
      integer :: first = 0
      !> Message of the first one
      character(len=:), allocatable :: message
   end type failure_t

   !> Points without a result
   type :: failures_t
      integer :: count = 0
      !> Number of different statuses
      integer :: kinds = 0
      !> Points of each status, in the order of their first points; 1 .. `kinds` are in use
      type(failure_t) :: kind(size(without_result))
      !> Points with a result of which the estimated error is above the accuracy requested; they
      !> have no message
      type(failure_t) :: inexact
   end type failures_t

   !> Observer of a sweep: it stores results and shows progress
   type, abstract :: monitor_t
   contains
      !> Called when points are finished
      procedure(finished_i), deferred :: finished
   end type monitor_t

   abstract interface
      !> Called on the first rank when points are finished
      subroutine finished_i(self, places, summary, error)
         import :: error_t, monitor_t, summary_t
         class(monitor_t), intent(inout) :: self
         !> The points
         integer, intent(in) :: places(:)
         !> All outcomes
         type(summary_t), intent(in) :: summary
         !> Error that ends the sweep, such as a full disk; unallocated on success
         type(error_t), allocatable, intent(out) :: error
      end subroutine finished_i
   end interface

contains

   !> Whether the case has a &sweep group
   pure function is_grid(self) result(yes)
      class(sweep_t), intent(in) :: self
      logical :: yes

      yes = size(self%grid%axes) > 0
   end function is_grid

   !> Build what all impacts of a case have in common
   subroutine new_sweep(self, case, error, all_materials)
      type(sweep_t), intent(out) :: self
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Error of code `error_input`, also if a value that varies or was set after reading the case
      !> has no effect; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Whether materials have an effect that no body uses; absent: no
      logical, intent(in), optional :: all_materials

      type(error_t), allocatable :: unread
      logical :: shows_all
      integer :: i, j, n, row

      call new_grid(case, self%grid, error)
      if (allocated(error)) return
      self%case = case
      n = size(self%grid%axes)
      allocate (self%ranges(n), self%objections(n), self%quantities(n))
      do i = 1, n
         row = case%row(self%grid%axes(i)%address)
         associate (axis => self%grid%axes(i), key => catalogue(row))
            self%ranges(i) = key%range
            self%objections(i)%message = axis%name//' is out of range, expected '//wanted(key)
            call self%case%drop_alternative(axis%address, always=.true.)
            do j = 1, size(axis%values)
               if (.not. contains_number(key%range, axis%values(j))) cycle
               call self%case%set(axis%address, axis%values(j))
               exit
            end do
         end associate
      end do
      call problem_of_case(self%problem, self%case, error)
      do i = 1, n
         self%quantities(i) = quantity_at(self%grid%axes(i)%address, self%problem%inputs)
      end do
      shows_all = .false.
      if (present(all_materials)) shows_all = all_materials
      call refuse_unread(self%problem%reading, case, .not. allocated(error), shows_all, unread)
      if (allocated(unread)) then
         call move_alloc(unread, error)
         return
      end if
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

      real(wp) :: numbers(size(self%grid%axes))
      integer :: i, place(size(self%grid%axes))

      place = self%grid%places(point)
      do i = 1, size(place)
         numbers(i) = self%grid%axes(i)%values(place(i))
      end do
      call put_numbers(self, numbers, worker, error)
      call solve_numbers(worker, outcome, error)
   end subroutine solve_point

   !> Put the numbers of a point in the place of those before
   subroutine put_numbers(self, numbers, worker, error)
      type(sweep_t), intent(in) :: self
      !> A number for each axis, shape (axes)
      real(wp), intent(in) :: numbers(:)
      !> Working storage of the thread: a new one, or that of an earlier point
      type(worker_t), intent(inout) :: worker
      !> Error of code `error_input` if one is out of range; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      if (.not. worker%is_ready) then
         worker%inputs = self%problem%inputs
         worker%problem = self%problem
         worker%is_ready = .true.
      end if
      do i = 1, size(numbers)
         if (contains_number(self%ranges(i), numbers(i))) then
            call worker%inputs%put(self%quantities(i), numbers(i))
         else if (.not. allocated(error)) then
            call raise(error, error_input, self%objections(i)%message)
         end if
      end do
   end subroutine put_numbers

   !> Solve the point of the numbers that were put
   subroutine solve_numbers(worker, outcome, error)
      type(worker_t), intent(inout) :: worker
      !> Outcome; without numbers on failure
      type(outcome_t), intent(out) :: outcome
      !> Error of the numbers, which is kept; on return as that of `solve_point`
      type(error_t), allocatable, intent(inout) :: error

      if (.not. allocated(error)) call worker%problem%build(worker%inputs, error)
      if (.not. allocated(error)) call worker%problem%solve(worker%trajectory, &
         outcome, error)
      if (.not. allocated(error)) return
      outcome = outcome_t(status=merge(point_invalid, point_failed, error%code == error_input), &
         steps=outcome%steps)
   end subroutine solve_numbers

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
      if (.not. allocated(error)) call solve_points(sweep, threads, summary, failures, error)
   end subroutine solve_sweep

   !> Solve the pending points of a sweep; all ranks call this
   subroutine solve_points(sweep, threads, summary, failures, error, monitor, learned)
      type(sweep_t), intent(in) :: sweep
      !> Threads of this rank, > 0; without OpenMP there is one
      integer, intent(in) :: threads
      !> On the first rank the outcomes of all points; those already there are kept
      type(summary_t), intent(inout) :: summary
      !> On the first rank the points without a result
      type(failures_t), intent(out) :: failures
      !> Error that ended the sweep, which may differ between ranks; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Observer of the sweep
      class(monitor_t), intent(inout), optional :: monitor
      !> Surroundings of the impacts, which take over what this rank has learned of the face
      type(surroundings_t), intent(inout), optional :: learned

      !> Working storage of the threads of this rank, kept from round to round
      type(worker_t), allocatable :: workers(:)
      integer, allocatable :: pending(:)
      !> Outcomes of this rank, one point after the other
      real(wp), allocatable :: rows(:)
      real(wp) :: start
      integer :: agreed(2), done, length, i

      allocate (pending(0), workers(threads))
      if (this_rank() == 0) pending = &
         pack([(i, i=1, size(summary%status))], summary%status == point_pending)
      pending = from_first_rank(pending)
      done = 0
      length = min_points*threads*rank_count()
      do
         ! the first rank decides on the length, any rank on an early end
         agreed = largest_of_ranks([merge(length, 0, this_rank() == 0), &
            merge(1, 0, allocated(error))])
         if (done == size(pending) .or. agreed(2) == 1) exit
         start = clock()
         length = min(agreed(1), size(pending) - done)
         associate (places => pending(done + 1:done + length))
            call solve_share(sweep, places(dealt(length, this_rank())), workers, rows)
            rows = gathered(rows)
            if (this_rank() == 0) then
               call store(summary, places, rows)
               if (present(monitor)) call monitor%finished(places, summary, error)
            end if
         end associate
         done = done + length
         length = max(min_points*threads*rank_count(), min(growth*length, &
            int(real(length, wp)*round_time/max(clock() - start, epsilon(start)))))
      end do
      if (agreed(2) == 0 .and. this_rank() == 0) call count_failures(sweep, summary, failures)
      if (.not. present(learned)) return
      do i = 1, threads
         if (workers(i)%is_ready) call learned%learn_from(workers(i)%problem%surroundings)
      end do
   end subroutine solve_points

   !> Points of a round that are dealt to a rank: each rank has one of every N consecutive points,
   !> not always the same one, or a rank would have a single value of the last parameter where N
   !> points are a row of the grid
   function dealt(points, rank) result(share)
      !> Number of points of the round
      integer, intent(in) :: points
      !> Index of the rank, from 0
      integer, intent(in) :: rank
      !> Places in the round, from 1
      integer, allocatable :: share(:)

      integer :: i

      associate (ranks => rank_count())
         share = pack([(i, i=1, points)], &
            [(mod(i - 1 + (i - 1)/ranks, ranks) == rank, i=1, points)])
      end associate
   end function dealt

   !> Solve points on the threads of this rank
   subroutine solve_share(sweep, points, workers, numbers)
      type(sweep_t), intent(in) :: sweep
      integer, intent(in) :: points(:)
      !> Working storage, one for each thread
      type(worker_t), intent(inout) :: workers(:)
      !> Outcomes from `row_of`, one point after the other
      real(wp), allocatable, intent(out) :: numbers(:)

      real(wp), allocatable :: rows(:, :)
      integer :: team, chunk, i

      allocate (rows(size(row_of(outcome_t())), size(points)))
      team = max(1, min(size(workers), size(points)))
      ! small enough for all threads to end at about the same time
      chunk = max(1, min(longest_chunk, size(points)/(8*team)))
!$omp parallel default(none) num_threads(team) shared(sweep, points, chunk, workers, rows)
      block
         type(outcome_t) :: outcome
         type(error_t), allocatable :: trouble
         integer :: thread

         thread = 1
!$       thread = omp_get_thread_num() + 1
!$omp do schedule(dynamic, chunk)
         do i = 1, size(points)
            call solve_point(sweep, points(i), workers(thread), outcome, trouble)
            rows(:, i) = row_of(outcome)
         end do
!$omp end do
      end block
!$omp end parallel
      numbers = reshape(rows, [size(rows)])
   end subroutine solve_share

   !> Store the outcomes of a round
   subroutine store(summary, places, numbers)
      type(summary_t), intent(inout) :: summary
      !> Points of the round
      integer, intent(in) :: places(:)
      !> Outcomes of all ranks, one rank after the other
      real(wp), intent(in) :: numbers(:)

      integer, allocatable :: share(:)
      integer :: columns, i, j, k

      columns = size(numbers)/size(places)
      k = 0
      do i = 0, rank_count() - 1
         share = dealt(size(places), i)
         do j = 1, size(share)
            call summary%put(places(share(j)), numbers(k + 1:k + columns))
            k = k + columns
         end do
      end do
   end subroutine store

   !> Count the points without a result by their status
   subroutine count_failures(sweep, summary, failures)
      type(sweep_t), intent(in) :: sweep
      !> Outcomes of all points
      type(summary_t), intent(in) :: summary
      type(failures_t), intent(out) :: failures

      integer :: first(size(without_result)), i

      failures%inexact%count = count(summary%inexact)
      failures%inexact%first = findloc(summary%inexact, .true., dim=1)
      do i = 1, size(first)
         first(i) = findloc(summary%status, without_result(i), dim=1)
      end do
      where (first == 0) first = huge(first)
      do while (any(first < huge(first)))
         i = minloc(first, dim=1)
         failures%kinds = failures%kinds + 1
         associate (kind => failures%kind(failures%kinds))
            kind%status = without_result(i)
            kind%first = first(i)
            kind%count = count(summary%status == kind%status)
            failures%count = failures%count + kind%count
            call explain(sweep, kind)
         end associate
         first(i) = huge(first)
      end do
   end subroutine count_failures

   !> Find the message of a point without a result
   subroutine explain(sweep, kind)
      type(sweep_t), intent(in) :: sweep
      !> Its status and number; on return also the message
      type(failure_t), intent(inout) :: kind

      type(worker_t) :: worker
      type(outcome_t) :: outcome
      type(error_t), allocatable :: trouble

      if (any(kind%status == [point_invalid, point_failed])) &
         call solve_point(sweep, kind%first, worker, outcome, trouble)
      call name_reason(sweep%problem, kind%status, trouble, kind%message)
   end subroutine explain

   !> Why an impact has no result
   pure subroutine name_reason(problem, status, error, message)
      !> The impact, or one like it
      type(problem_t), intent(in) :: problem
      !> One of `without_result`
      integer, intent(in) :: status
      !> Error of an impact that is invalid or failed
      type(error_t), allocatable, intent(in) :: error
      !> In words
      character(len=:), allocatable, intent(out) :: message

      select case (status)
      case (contact_lasting)
         message = 'the bodies do not separate within solver.end_time'
         if (problem%surroundings%is_lighter(problem%impact)) message = &
            'the bodies do not separate: '//forgotten_base
      case (contact_sticking)
         message = 'the sphere sticks: all motion decays in contact'
      case default
         message = 'no result'
         if (allocated(error)) message = error%message
      end select
   end subroutine name_reason

   !> Wall-clock time
   function clock() result(time)
      !> Time since an arbitrary origin, > 0 [s]
      real(wp) :: time

      integer(int64) :: count, rate

      call system_clock(count, rate)
      time = real(count, wp)/real(rate, wp)
   end function clock

end module vcor_sweep_points
