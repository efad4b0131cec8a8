!> What ranks say to each other: numbers of the first one, the largest ones, all of them, errors
program ranks
   use vcor_error, only : error_file, error_t, error_usage, raise
   use vcor_kinds, only : wp
   use vcor_sweep_mpi, only : differs, from_first_rank, gathered, join_ranks, largest_of_ranks, &
      leave_ranks, rank_count, share_error, this_rank
   use vcor_test, only : check, check_text, finish, suite
   implicit none

   type(error_t), allocatable :: error
   real(wp), allocatable :: numbers(:)
   integer :: i, last

   call join_ranks()
   call suite("ranks")
   last = rank_count() - 1
   call check(last > 0, "there are several ranks")
   associate (those => from_first_rank([(i + this_rank(), i=1, 5*(1 - this_rank()))]))
      call check(size(those) == 5 .and. all(those == [1, 2, 3, 4, 5]), "numbers of the first")
   end associate
   call check(all(largest_of_ranks([this_rank(), -this_rank()]) == [last, 0]), "the largest")
   ! each rank has one more than the one before, the first none
   allocate (numbers, source=gathered([(real(10*this_rank() + i, wp), i=1, this_rank())]))
   if (this_rank() == 0) then
      call check(size(numbers) == last*(last + 1)/2, "as many as all have")
      call check(nint(numbers(1)) == 11 .and. nint(numbers(size(numbers))) == 11*last, "in order")
   else
      call check(size(numbers) == 0, "the first has them")
   end if
   call check(.not. differs(-7), "the same number")
   call check(differs(this_rank()), "different numbers")

   call share_error(error)
   call check(.not. allocated(error), "no rank has an error")
   if (this_rank() == last) call raise(error, error_file, "injected failure")
   call share_error(error)
   call check(allocated(error), "all ranks have the error")
   call check(error%code == error_file, "its code")
   if (this_rank() == 0) then
      call check_text(error%message(:5), "rank ", "where it was")
      call check_text(error%message(8:), " injected failure", "what it was")
      deallocate (error)
      call raise(error, error_usage, "the first one's own")
   end if
   call share_error(error)
   call check(error%code == error_usage, "of two errors that of the first rank")
   if (this_rank() == 0) call check_text(error%message, "the first one's own", "its message")
   call leave_ranks()
   call finish()
end program ranks
