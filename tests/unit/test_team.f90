!> Parts of a sweep, what is left of it, and the dealing of chunks on one rank; tests/mpi has more
program test_team
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use vcor_counting_task, only : counting_t
   use vcor_error, only : error_numerical, error_t
   use vcor_impact_outcome, only : outcome_t
   use vcor_kinds, only : wp
   use vcor_sweep_failures, only : failures_t
   use vcor_sweep_partition, only : new_part, new_todo, part_t, todo_t
   use vcor_sweep_quantity, only : point_invalid, point_pending
   use vcor_sweep_summary, only : new_summary, numbers_per_point, summary_t
   use vcor_sweep_team, only : work_together
   use vcor_test, only : check, check_text, finish, suite
   implicit none

   call suite("team")
   call test_parts()
   call test_todo()
   call test_packed_outcomes()
   call test_packed_reasons()
   call test_work()
   call finish()

contains

   !> Every point is in one part, the parts are of one size, and no value of a row has a part alone
   subroutine test_parts()
      integer, parameter :: points(*) = [1, 7, 12, 100], parts(*) = [1, 2, 3, 5, 10]
      integer, allocatable :: owners(:)
      type(part_t) :: part
      integer :: i, j, n, place

      do i = 1, size(points)
         do j = 1, size(parts)
            if (parts(j) > points(i)) cycle
            allocate (owners(points(i)), source=0)
            do n = 1, parts(j)
               part = new_part(points(i), n, parts(j))
               call check(abs(part%count() - points(i)/parts(j)) <= 1, "parts are of one size")
               do place = 1, part%count()
                  owners(part%point(place)) = owners(part%point(place)) + 1
                  if (place > 1) call check(part%point(place) > part%point(place - 1), "in order")
               end do
            end do
            call check(all(owners == 1), "every point is in one part")
            deallocate (owners)
         end do
      end do
      part = new_part(100, 3, 10)
      call check(any(mod([(part%point(i), i = 1, 10)], 10) == 0) &
         .and. any(mod([(part%point(i), i = 1, 10)], 10) == 5), "a part has all values of a row")
   end subroutine test_parts

   !> Chunks have what is not done, once
   subroutine test_todo()
      type(todo_t) :: todo
      logical :: done(20)
      integer :: first, last, i

      done = .false.
      done([1, 2, 7, 8, 9, 13, 20]) = .true.
      call new_todo(todo, done)
      call check(todo%left == 13, "13 are left")
      do i = 1, 20
         call todo%take(3, first, last)
         if (last < first) exit
         call check(last - first < 3, "at most three")
         call check(.not. any(done(first:last)), "none is done")
         done(first:last) = .true.
      end do
      call check(all(done) .and. todo%left == 0, "all are taken")
      call new_todo(todo, done)
      call todo%take(1, first, last)
      call check(last < first, "nothing is left")
      call new_todo(todo, [logical ::])
      call check(todo%left == 0, "nothing of nothing")
   end subroutine test_todo

   !> Outcomes as numbers and back
   subroutine test_packed_outcomes()
      type(summary_t) :: chunk, whole
      type(outcome_t) :: outcome
      type(error_t), allocatable :: error
      real(wp) :: numbers(2, numbers_per_point)
      integer :: i

      call new_summary(chunk, 2, error, before=5)
      outcome%cor = 0.1_wp
      outcome%wave_energy = 1.0e-300_wp
      outcome%steps = 12345
      call chunk%put(6, outcome)
      outcome%status = point_invalid
      call chunk%put(7, outcome)
      call chunk%pack(numbers)
      call new_summary(whole, 8, error)
      call check(.not. allocated(error), "room")
      call whole%unpack(6, numbers)
      call check(all(whole%status == [(point_pending, i = 1, 5), 0, point_invalid, &
         point_pending]), "status")
      call check(whole%steps(6) == 12345, "steps")
      call check(abs(whole%values(1)%at(6) - 0.1_wp) <= 0.0_wp, "the same number")
      call check(ieee_is_nan(whole%values(1)%at(7)), "no number where there is none")
      call whole%blank_pending()
      call check(ieee_is_nan(whole%values(1)%at(8)), "nor where it is pending")
      call check(abs(whole%values(1)%at(6) - 0.1_wp) <= 0.0_wp, "but where it is not")
   end subroutine test_packed_outcomes

   !> Reasons as numbers and back
   subroutine test_packed_reasons()
      type(failures_t) :: one, other, both

      call one%note(8, "radius is out of range")
      call one%note(3, "no separation within 1 s")
      call other%note(2, "no separation within 2 s")
      call other%note(9, "no separation within 3 s")
      call both%add_packed(one%pack())
      call both%add_packed(other%pack())
      call both%add_packed(new_reasons())
      call both%sort()
      call check(both%count == 4 .and. both%reasons == 2, "four points, two reasons")
      call check(both%reason(1)%count == 3 .and. both%reason(1)%first == 2, "three of one")
      call check_text(both%reason(1)%message, "no separation within 2 s", "the first one's words")
      call check_text(both%reason(2)%message, "radius is out of range", "the other")
   end subroutine test_packed_reasons

   !> No reasons, as numbers
   function new_reasons() result(numbers)
      !> Numbers
      real(wp), allocatable :: numbers(:)
      type(failures_t) :: none

      numbers = none%pack()
   end function new_reasons

   !> One rank works off everything, stops, and ends with an error
   subroutine test_work()
      type(counting_t) :: task
      type(todo_t) :: todo
      type(error_t), allocatable :: error
      integer :: stopped

      call task%reset(1000)
      task%seen(100:200) = 1
      call new_todo(todo, task%seen == 1)
      call work_together(task, todo, stopped, error)
      call check(.not. allocated(error) .and. stopped == 0, "done")
      call check(task%is_right(), "every place once")

      call task%reset(1000)
      task%stops_after = 3
      call new_todo(todo, task%seen == 1)
      call work_together(task, todo, stopped, error)
      call check(stopped == 15 .and. .not. allocated(error), "stopped")
      call check(count(task%seen == 1) + todo%left == 1000, "the rest is left")
      call check(todo%left > 0 .and. todo%left < 1000, "not all, not nothing")

      call task%reset(1000)
      task%fails_after = 3
      call new_todo(todo, task%seen == 1)
      call work_together(task, todo, stopped, error)
      call check(allocated(error), "failed")
      if (allocated(error)) call check(error%code == error_numerical, "with the code of the error")
   end subroutine test_work

end program test_team
