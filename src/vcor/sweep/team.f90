!> Chunks of a task, dealt out to ranks
!>
!> The first rank deals and works too. A rank that works always has a second chunk in hand, so that
!> it never waits for the first one, which looks for results between short chunks of its own. A
!> chunk is as long as the rank that gets it needs for a certain time, judged by its chunks before,
!> and towards the end shorter, so that all ranks end at about the same time. Where there are many
!> ranks, that time grows with their number, and so the first rank has the same few hundred messages
!> per second to look after.
!>
!> An error on any rank ends the work of all: chunks that are at work come to their end, no other
!> begins.
module vcor_sweep_team
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_error, only : error_t, raise
   use vcor_kinds, only : wp
   use vcor_sweep_mpi, only : inbox_t, outbox_t, rank_count, receive_order, send_order, this_rank
   use vcor_sweep_partition, only : todo_t
   use vcor_text, only : integer_text
   implicit none
   private

   public :: task_t, work_together

   !> What there is to do, place by place
   type, abstract :: task_t
      !> Places that should not be fewer in a chunk: threads want something to do [-], > 0
      integer :: least = 1
   contains
      !> Solve places
      procedure(solve_i), deferred :: solve
      !> Take a result, on the first rank
      procedure(take_i), deferred :: take
      !> Whether to stop
      procedure(stop_code_i), deferred :: stop_code
   end type task_t

   abstract interface
      !> Solve places
      subroutine solve_i(self, first, last, result, error)
         import :: error_t, task_t, wp
         !> The task
         class(task_t), intent(inout) :: self
         !> First place
         integer, intent(in) :: first
         !> Last place
         integer, intent(in) :: last
         !> The result, in numbers, shape (n)
         real(wp), allocatable, intent(out) :: result(:)
         !> What ends the work of all ranks; unallocated on success
         type(error_t), allocatable, intent(out) :: error
      end subroutine solve_i

      !> Take a result, on the first rank; results come in any order
      subroutine take_i(self, first, last, result, error)
         import :: error_t, task_t, wp
         !> The task
         class(task_t), intent(inout) :: self
         !> First place
         integer, intent(in) :: first
         !> Last place
         integer, intent(in) :: last
         !> The result, as `solve` gave it, shape (n)
         real(wp), intent(in) :: result(:)
         !> What ends the work of all ranks; unallocated on success
         type(error_t), allocatable, intent(out) :: error
      end subroutine take_i

      !> Whether to stop after the chunks that are at work
      function stop_code_i(self) result(code)
         import :: task_t
         !> The task
         class(task_t), intent(in) :: self
         !> 0 to go on
         integer :: code
      end function stop_code_i
   end interface

   !> Time that a chunk should take [s]: of a rank alone
   real(wp), parameter :: time_alone = 0.05_wp
   !> Of the first rank, which others wait for [s]
   real(wp), parameter :: time_first = 0.02_wp
   !> Of the others, per rank [s] and at least
   real(wp), parameter :: time_others = 0.2_wp, time_per_rank = 0.003_wp
   !> How much longer than the one before a chunk may be
   integer, parameter :: growth = 4
   !> Chunks that a rank has in hand
   integer, parameter :: depth = 2
   !> Numbers before a result: seconds, stop code, code of the error, letters of its message
   integer, parameter :: head = 4

   !> How fast a rank is
   type :: pace_t
      !> Places per second; 0 as long as it is not known
      real(wp) :: rate = 0.0_wp
      !> Places of the last chunk
      integer :: last = 0
   end type pace_t

   !> What the first rank knows of another
   type :: member_t
      !> Results on their way
      type(inbox_t) :: inbox
      !> Chunks in hand, first and last place, in the order of their results
      integer :: chunks(2, depth) = 0
      !> Number of chunks in hand
      integer :: in_hand = 0
      !> How fast it is
      type(pace_t) :: pace
   end type member_t

contains

   !> Work off what there is to do; all ranks call this, with the same task
   subroutine work_together(task, todo, stopped, error)
      !> The task
      class(task_t), intent(inout) :: task
      !> Places to be solved, on the first rank; empty afterwards unless the work was ended
      type(todo_t), intent(inout) :: todo
      !> Stop code that ended the work before its time, 0 if there was none; on the first rank
      integer, intent(out) :: stopped
      !> What ended the work; unallocated on success. Ranks may have different ones
      type(error_t), allocatable, intent(out) :: error

      stopped = 0
      if (this_rank() == 0) then
         call deal(task, todo, stopped, error)
      else
         call serve(task, error)
      end if
   end subroutine work_together

   !> The first rank: deal, and work
   subroutine deal(task, todo, stopped, error)
      !> The task
      class(task_t), intent(inout) :: task
      !> Places to be solved
      type(todo_t), intent(inout) :: todo
      !> Stop code
      integer, intent(out) :: stopped
      !> What ended the work
      type(error_t), allocatable, intent(out) :: error

      type(member_t), allocatable :: others(:)
      type(pace_t) :: pace
      real(wp) :: own_time, others_time
      integer :: ranks, i, first, last

      ranks = rank_count()
      allocate (others(ranks - 1))
      own_time = merge(time_alone, time_first, ranks == 1)
      others_time = max(time_others, time_per_rank*real(ranks, wp))
      stopped = 0
      do
         if (stopped == 0) stopped = task%stop_code()
         do i = 1, ranks - 1
            call collect(task, others(i), i, stopped, error)
            if (allocated(error) .or. stopped /= 0) cycle
            do while (others(i)%in_hand < depth .and. todo%left > 0)
               call take_chunk(task, todo, others(i)%pace, others_time, ranks, first, last)
               call send_order([first, last], i)
               others(i)%in_hand = others(i)%in_hand + 1
               others(i)%chunks(:, others(i)%in_hand) = [first, last]
            end do
         end do
         if (todo%left > 0 .and. stopped == 0 .and. .not. allocated(error)) then
            call take_chunk(task, todo, pace, min(own_time, least_wait(others)), ranks, first, last)
            call work(task, first, last, pace, error)
         else if (all(others%in_hand == 0)) then
            exit
         end if
      end do
      do i = 1, ranks - 1
         call send_order([0, 0], i)
      end do
      ! what came too late to end anything
      if (todo%left == 0) stopped = 0
   end subroutine deal

   !> Time after which the first of the other ranks may be without work: that of a chunk, if it has
   !> a second one in hand
   pure function least_wait(others) result(time)
      !> The other ranks
      type(member_t), intent(in) :: others(:)
      !> Time [s]; 0 where a rank's pace is not known
      real(wp) :: time

      integer :: i

      time = huge(time)
      do i = 1, size(others)
         associate (chunk => others(i)%chunks(:, depth), rate => others(i)%pace%rate)
            if (others(i)%in_hand < depth) cycle
            if (rate > 0.0_wp) then
               time = min(time, real(chunk(2) - chunk(1) + 1, wp)/rate)
            else
               time = 0.0_wp
            end if
         end associate
      end do
   end function least_wait

   !> Take a chunk off
   subroutine take_chunk(task, todo, pace, time, ranks, first, last)
      !> The task
      class(task_t), intent(in) :: task
      !> Places to be solved
      type(todo_t), intent(inout) :: todo
      !> How fast the rank is
      type(pace_t), intent(inout) :: pace
      !> Time the chunk should take [s]
      real(wp), intent(in) :: time
      !> Number of ranks
      integer, intent(in) :: ranks
      !> First place
      integer, intent(out) :: first
      !> Last place
      integer, intent(out) :: last

      real(wp) :: length

      length = real(max(pace%last, task%least), wp)
      if (pace%rate > 0.0_wp) length = min(real(growth, wp)*length, pace%rate*time)
      ! what is left makes a few chunks for each rank
      length = min(length, real(todo%left, wp)/real(2*ranks, wp))
      call todo%take(max(task%least, int(length)), first, last)
      pace%last = last - first + 1
   end subroutine take_chunk

   !> The first rank solves a chunk of its own
   subroutine work(task, first, last, pace, error)
      !> The task
      class(task_t), intent(inout) :: task
      !> First place
      integer, intent(in) :: first
      !> Last place
      integer, intent(in) :: last
      !> How fast the rank is
      type(pace_t), intent(inout) :: pace
      !> What ends the work
      type(error_t), allocatable, intent(out) :: error

      real(wp), allocatable :: result(:)
      real(wp) :: start

      start = seconds()
      call task%solve(first, last, result, error)
      if (allocated(error)) return
      call judge(pace, last - first + 1, seconds() - start)
      call task%take(first, last, result, error)
   end subroutine work

   !> Take what has come from a rank
   subroutine collect(task, member, rank, stopped, error)
      !> The task
      class(task_t), intent(inout) :: task
      !> What is known of the rank
      type(member_t), intent(inout) :: member
      !> The rank
      integer, intent(in) :: rank
      !> Stop code; set if the rank has one
      integer, intent(inout) :: stopped
      !> What ended the work; the first one stays
      type(error_t), allocatable, intent(inout) :: error

      type(error_t), allocatable :: trouble
      logical :: has_arrived

      do while (member%in_hand > 0)
         call member%inbox%look(rank, has_arrived)
         if (.not. has_arrived) return
         associate (numbers => member%inbox%numbers, chunk => member%chunks(:, 1))
            if (stopped == 0) stopped = nint(numbers(2))
            if (nint(numbers(3)) /= 0) then
               call raise(trouble, nint(numbers(3)), 'rank '//integer_text(rank)//': ' &
                  //text_of(numbers))
            else
               call judge(member%pace, chunk(2) - chunk(1) + 1, numbers(1))
               if (.not. allocated(error)) &
                  call task%take(chunk(1), chunk(2), numbers(head + 1:), trouble)
            end if
         end associate
         if (allocated(trouble) .and. .not. allocated(error)) call move_alloc(trouble, error)
         member%chunks(:, :depth - 1) = member%chunks(:, 2:)
         member%in_hand = member%in_hand - 1
      end do
   end subroutine collect

   !> Message of an error that came from a rank
   pure function text_of(numbers) result(text)
      !> What came
      real(wp), intent(in) :: numbers(:)
      !> The message
      character(len=nint(numbers(4))) :: text

      text = transfer(numbers(head + 1:), text)
   end function text_of

   !> All ranks but the first: work
   subroutine serve(task, error)
      !> The task
      class(task_t), intent(inout) :: task
      !> What ended the work on this rank
      type(error_t), allocatable, intent(out) :: error

      type(outbox_t) :: outboxes(depth)
      real(wp), allocatable :: result(:), numbers(:)
      real(wp) :: start
      integer :: order(2), i

      i = 1
      do
         call receive_order(order)
         if (order(1) == 0) exit
         start = seconds()
         ! after an error every order is answered by it
         if (.not. allocated(error)) call task%solve(order(1), order(2), result, error)
         if (allocated(error)) then
            result = transfer(error%message//repeat(' ', 8), [0.0_wp])
            numbers = [0.0_wp, 0.0_wp, real(error%code, wp), real(len(error%message), wp), result]
         else
            allocate (numbers(head + size(result)))
            numbers(:head) = [seconds() - start, real(task%stop_code(), wp), 0.0_wp, 0.0_wp]
            numbers(head + 1:) = result
         end if
         call outboxes(i)%finish()
         call outboxes(i)%post(numbers)
         i = mod(i, depth) + 1
      end do
      do i = 1, depth
         call outboxes(i)%finish()
      end do
   end subroutine serve

   !> Judge how fast a rank is by a chunk
   pure subroutine judge(pace, places, time)
      !> How fast it is
      type(pace_t), intent(inout) :: pace
      !> Places of the chunk
      integer, intent(in) :: places
      !> Time that it took [s]
      real(wp), intent(in) :: time

      ! no clock is finer
      real(wp), parameter :: least_time = 1.0e-6_wp
      real(wp) :: rate

      rate = real(places, wp)/max(time, least_time)
      if (pace%rate > 0.0_wp) rate = 0.5_wp*(rate + pace%rate)
      pace%rate = rate
   end subroutine judge

   !> Time by the clock on the wall
   function seconds()
      !> Time since some moment [s]
      real(wp) :: seconds

      integer(int64) :: count, rate

      call system_clock(count, rate)
      seconds = real(count, wp)/real(rate, wp)
   end function seconds

end module vcor_sweep_team
