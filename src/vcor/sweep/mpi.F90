!> MPI ranks; no other module uses MPI
!>
!> With the macro `VCOR_MPI` the module uses MPI, without it there is one rank. All ranks call the
!> same procedures in the same order, only from the thread that called `join_ranks`.
module vcor_sweep_mpi
#ifdef VCOR_MPI
   use mpi_f08, only : mpi_allreduce, mpi_bcast, mpi_comm_rank, mpi_comm_size, mpi_comm_world, &
      mpi_double_precision, mpi_finalize, mpi_gather, mpi_gatherv, mpi_init_thread, mpi_integer, &
      mpi_max, mpi_thread_funneled
#endif
   use vcor_error, only : error_t, raise
   use vcor_kinds, only : wp
   implicit none
   private

   public :: join_ranks, leave_ranks, this_rank, rank_count
   public :: from_first_rank, largest_of_ranks, gathered, differs, share_error

   !> Index of this rank, from 0
   integer :: rank = 0
   !> Number of ranks
   integer :: ranks = 1

contains

   !> Initialise MPI, before anything else
   subroutine join_ranks()
#ifdef VCOR_MPI
      integer :: provided

      call mpi_init_thread(mpi_thread_funneled, provided)
      call mpi_comm_rank(mpi_comm_world, rank)
      call mpi_comm_size(mpi_comm_world, ranks)
#endif
   end subroutine join_ranks

   !> Finalise MPI; returns after all ranks have called it
   subroutine leave_ranks()
#ifdef VCOR_MPI
      call mpi_finalize()
#endif
   end subroutine leave_ranks

   !> Index of this rank
   function this_rank() result(number)
      !> Index, from 0
      integer :: number

      number = rank
   end function this_rank

   !> Number of ranks
   function rank_count() result(number)
      integer :: number

      number = ranks
   end function rank_count

   !> Send numbers of the first rank to all
   function from_first_rank(numbers) result(those)
      !> Numbers of this rank, ignored except on the first
      integer, intent(in) :: numbers(:)
      !> Numbers of the first rank
      integer, allocatable :: those(:)
#ifdef VCOR_MPI
      integer :: n

      n = size(numbers)
      call mpi_bcast(n, 1, mpi_integer, 0, mpi_comm_world)
      allocate (those(n))
      if (rank == 0) those = numbers
      call mpi_bcast(those, n, mpi_integer, 0, mpi_comm_world)
#else
      those = numbers
#endif
   end function from_first_rank

   !> Elementwise maximum over all ranks
   function largest_of_ranks(numbers) result(most)
      !> Numbers of this rank, of the same shape on all ranks
      integer, intent(in) :: numbers(:)
      !> Elementwise maximum
      integer :: most(size(numbers))

#ifdef VCOR_MPI
      call mpi_allreduce(numbers, most, size(numbers), mpi_integer, mpi_max, mpi_comm_world)
#else
      most = numbers
#endif
   end function largest_of_ranks

   !> Concatenate the numbers of all ranks, in the order of ranks
   function gathered(numbers) result(those)
      !> Numbers of this rank
      real(wp), intent(in) :: numbers(:)
      !> Numbers of all ranks on the first rank; shape (0) on the others
      real(wp), allocatable :: those(:)
#ifdef VCOR_MPI
      integer :: sizes(ranks), offsets(ranks), i

      sizes = 0
      call mpi_gather(size(numbers), 1, mpi_integer, sizes, 1, mpi_integer, 0, mpi_comm_world)
      offsets = [(sum(sizes(:i - 1)), i=1, ranks)]
      allocate (those(sum(sizes)))
      call mpi_gatherv(numbers, size(numbers), mpi_double_precision, those, sizes, offsets, &
         mpi_double_precision, 0, mpi_comm_world)
#else
      those = numbers
#endif
   end function gathered

   !> Whether a number differs between ranks
   function differs(number)
      !> Number of this rank
      integer, intent(in) :: number
      !> Whether not all are equal
      logical :: differs

      integer :: ends(2)

      ! maxima of the numbers and of their complements
      ends = largest_of_ranks([number, not(number)])
      differs = ends(1) /= not(ends(2))
   end function differs

   !> Share an error with all ranks: that of the lowest rank that has one
   subroutine share_error(error)
      !> Error of this rank; on return that of all, or unallocated if no rank has one. Only the
      !> first rank has its message
      type(error_t), allocatable, intent(inout) :: error

      ! factor above the largest code; characters that fit into a number
      integer, parameter :: codes = 1000, room = storage_size(1.0_wp)/8
      character(len=:), allocatable :: message
      real(wp), allocatable :: letters(:)
      character(len=24) :: name
      integer :: found(1)

      if (ranks == 1) return
      found = -huge(found)
      if (allocated(error)) found = -(codes*rank + error%code)
      found = largest_of_ranks(found)
      if (found(1) == -huge(found)) return
      message = ''
      if (-found(1)/codes == rank) then
         message = error%message
         write (name, '(a, i0, a)') 'rank ', rank, ':'
         if (rank > 0) message = trim(name)//' '//message
      end if
      allocate (letters, source=gathered(transfer(message//repeat(' ', &
         modulo(-len(message), room)), [1.0_wp])))
      message = transfer(letters, repeat(' ', room*size(letters)))
      call raise(error, mod(-found(1), codes), trim(message))
   end subroutine share_error

end module vcor_sweep_mpi
