!> Chunks dealt out to ranks: every place once, failures and stops on a rank that is not the first
!>
!>     mpirun -n N ranks work|fail|stop
program ranks
   use vcor_counting_task, only : counting_t
   use vcor_error, only : error_numerical, error_t
   use vcor_sweep_mpi, only : differs, join_ranks, leave_ranks, rank_count, share_error, &
      share_flag, this_rank
   use vcor_sweep_partition, only : new_todo, todo_t
   use vcor_sweep_team, only : work_together
   use vcor_test, only : check, check_text, finish, suite
   implicit none

   integer, parameter :: places = 20000
   type(counting_t) :: task
   type(todo_t) :: todo
   type(error_t), allocatable :: error
   character(len=8) :: way
   integer :: stopped
   logical :: flag

   call join_ranks()
   call get_command_argument(1, way)
   call suite("ranks "//way)
   call check(rank_count() > 1, "there are several ranks")
   call task%reset(places)
   ! what only the last rank does
   if (this_rank() == rank_count() - 1) then
      if (way == "fail") task%fails_after = 2
      if (way == "stop") task%stops_after = 2
   end if
   if (this_rank() == 0) call new_todo(todo, task%seen == 1)
   call work_together(task, todo, stopped, error)

   call check(task%chunks > 0, "every rank has work")
   if (this_rank() == 0) then
      select case (way)
      case ("work")
         call check(task%is_right(), "every place once")
         call check(stopped == 0, "nobody stopped it")
      case ("stop")
         call check(stopped == 15, "the code of the last rank")
         call check(all(task%seen <= 1), "no place twice")
         call check(count(task%seen == 1) + todo%left == places, "the rest is left")
         call check(todo%left > 0, "something is left")
      case default
         call check(all(task%seen <= 1), "no place twice")
         call check(todo%left > 0, "something is left")
      end select
   end if

   call share_error(error)
   call check(allocated(error) .eqv. way == "fail", "all ranks know of the failure")
   if (allocated(error)) then
      call check(error%code == error_numerical, "its code")
      call check_text(error%message(:5), "rank ", "where it was")
      call check_text(error%message(8:), " injected failure", "what it was")
   end if
   flag = this_rank() == 0
   call share_flag(flag)
   call check(flag, "what the first rank knows")
   call check(.not. differs(-7), "the same number")
   call check(differs(this_rank()), "different numbers")
   call leave_ranks()
   call finish()
end program ranks
