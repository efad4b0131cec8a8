!> Ranks, the only module that knows of MPI; without it there is one rank
!>
!> Only the thread that called `join_ranks` calls anything else here. Nothing waits for a rank that
!> is at work: messages with numbers are posted and looked for. Built with the macro `VCOR_MPI`
!> there is MPI.
module vcor_sweep_mpi
#ifdef VCOR_MPI
   use, intrinsic :: iso_c_binding, only : c_char, c_int, c_null_char
   use mpi_f08, only : mpi_allreduce, mpi_bcast, mpi_character, mpi_comm_rank, mpi_comm_size, &
      mpi_comm_world, mpi_double_precision, mpi_finalize, mpi_get_count, mpi_in_place, &
      mpi_init_thread, mpi_integer, mpi_iprobe, mpi_irecv, mpi_isend, mpi_max, mpi_min, mpi_recv, &
      mpi_request, mpi_send, mpi_status, mpi_status_ignore, mpi_test, mpi_thread_funneled, mpi_wait
#endif
   use vcor_error, only : error_t, raise
   use vcor_kinds, only : wp
   implicit none
   private

   public :: join_ranks, leave_ranks, this_rank, rank_count
   public :: send_order, receive_order, inbox_t, outbox_t
   public :: share_error, share_flag, differs

   !> Number of this rank, from 0
   integer :: rank = 0
   !> Number of ranks
   integer :: ranks = 1

   !> Numbers on their way from another rank
   type :: inbox_t
      !> What has arrived, shape (n)
      real(wp), allocatable :: numbers(:)
      !> Whether something is on its way
      logical, private :: is_posted = .false.
#ifdef VCOR_MPI
      !> What is under way
      type(mpi_request), private :: request
#endif
   contains
      !> Look whether something has arrived
      procedure :: look
   end type inbox_t

   !> Numbers on their way to another rank
   type :: outbox_t
      !> What is sent, shape (n)
      real(wp), allocatable, private :: numbers(:)
      !> Whether something is on its way
      logical, private :: is_posted = .false.
#ifdef VCOR_MPI
      !> What is under way
      type(mpi_request), private :: request
#endif
   contains
      !> Send numbers
      procedure :: post
      !> Wait until they have left
      procedure :: finish
   end type outbox_t

#ifdef VCOR_MPI
   interface
      !> Set a variable of the environment
      function c_setenv(name, value, overwrite) result(status) bind(c, name="setenv")
         import :: c_char, c_int
         !> Name, ends with NUL
         character(len=1, kind=c_char), intent(in) :: name(*)
         !> Value, ends with NUL
         character(len=1, kind=c_char), intent(in) :: value(*)
         !> 0: a variable that is there stays
         integer(c_int), intent(in), value :: overwrite
         !> 0 on success
         integer(c_int) :: status
      end function c_setenv

      !> Set an option of a socket
      function c_setsockopt(descriptor, level, option, value, length) result(status) &
         bind(c, name="setsockopt")
         import :: c_int
         !> Descriptor of an open file
         integer(c_int), intent(in), value :: descriptor
         !> Protocol that knows the option
         integer(c_int), intent(in), value :: level
         !> The option
         integer(c_int), intent(in), value :: option
         !> Its value
         integer(c_int), intent(in) :: value
         !> Bytes of the value (a `socklen_t`)
         integer(c_int), intent(in), value :: length
         !> 0 on success
         integer(c_int) :: status
      end function c_setsockopt
   end interface
#endif

contains

   !> Number of this rank
   function this_rank() result(number)
      !> Number, from 0
      integer :: number

      number = rank
   end function this_rank

   !> Number of ranks
   function rank_count() result(number)
      !> Number, at least 1
      integer :: number

      number = ranks
   end function rank_count

#ifdef VCOR_MPI

   !> Begin, before anything else
   subroutine join_ranks()
      integer :: provided

      call stay_on_node()
      call mpi_init_thread(mpi_thread_funneled, provided)
      call send_at_once()
      call mpi_comm_rank(mpi_comm_world, rank)
      call mpi_comm_size(mpi_comm_world, ranks)
   end subroutine join_ranks

   !> Where all ranks are on one node, have OpenMPI look for no network, and learn what `mpirun`
   !> says of the ranks by messages instead of memory that all share: the one takes 0.2 s, the other
   !> 0.01 s. What the user has set stays
   subroutine stay_on_node()
      character(len=12) :: all_ranks, ranks_here
      integer(c_int) :: ignored
      integer :: status

      ! mpirun tells both
      call get_environment_variable('OMPI_COMM_WORLD_SIZE', all_ranks, status=status)
      if (status /= 0) return
      call get_environment_variable('OMPI_COMM_WORLD_LOCAL_SIZE', ranks_here, status=status)
      if (status /= 0 .or. ranks_here /= all_ranks) return
      ignored = c_setenv('OMPI_MCA_pml'//c_null_char, 'ob1'//c_null_char, 0_c_int)
      ignored = c_setenv('PMIX_MCA_gds'//c_null_char, 'hash'//c_null_char, 0_c_int)
   end subroutine stay_on_node

   !> Have the sockets of this process send what is written at once (`TCP_NODELAY`): a rank tells
   !> `mpirun` in several messages that it ends, and each would wait until the system has
   !> acknowledged the one before, which takes it 0.04 s
   subroutine send_at_once()
      ! numbers of the protocol and of its option, the same on Linux, BSD and macOS
      integer(c_int), parameter :: tcp = 6, no_delay = 1, yes = 1
      ! the sockets that MPI opens when it begins are among the first
      integer(c_int), parameter :: descriptors = 256
      integer(c_int) :: i, ignored

      ! what is no such socket is left as it is
      do i = 0, descriptors - 1
         ignored = c_setsockopt(i, tcp, no_delay, yes, int(storage_size(yes)/8, c_int))
      end do
   end subroutine send_at_once

   !> End: waits for all ranks
   subroutine leave_ranks()
      call mpi_finalize()
   end subroutine leave_ranks

   !> Send an order to a rank
   subroutine send_order(order, to)
      !> The order
      integer, intent(in) :: order(2)
      !> The rank
      integer, intent(in) :: to

      call mpi_send(order, size(order), mpi_integer, to, 0, mpi_comm_world)
   end subroutine send_order

   !> Wait for an order of the first rank
   subroutine receive_order(order)
      !> The order
      integer, intent(out) :: order(2)

      call mpi_recv(order, size(order), mpi_integer, 0, 0, mpi_comm_world, mpi_status_ignore)
   end subroutine receive_order

   !> Look whether something has arrived
   subroutine look(self, from, has_arrived)
      !> What is on its way
      class(inbox_t), intent(inout) :: self
      !> Rank that sends
      integer, intent(in) :: from
      !> Whether `numbers` is complete
      logical, intent(out) :: has_arrived

      type(mpi_status) :: status
      logical :: is_there
      integer :: n

      has_arrived = .false.
      if (.not. self%is_posted) then
         call mpi_iprobe(from, 1, mpi_comm_world, is_there, status)
         if (.not. is_there) return
         call mpi_get_count(status, mpi_double_precision, n)
         if (allocated(self%numbers)) deallocate (self%numbers)
         allocate (self%numbers(n))
         call mpi_irecv(self%numbers, n, mpi_double_precision, from, 1, mpi_comm_world, &
            self%request)
         self%is_posted = .true.
      end if
      call mpi_test(self%request, has_arrived, mpi_status_ignore)
      self%is_posted = .not. has_arrived
   end subroutine look

   !> Send numbers to the first rank
   subroutine post(self, numbers)
      !> Nothing is on its way in it
      class(outbox_t), intent(inout) :: self
      !> The numbers; not allocated afterwards, shape (n)
      real(wp), allocatable, intent(inout) :: numbers(:)

      call move_alloc(numbers, self%numbers)
      call mpi_isend(self%numbers, size(self%numbers), mpi_double_precision, 0, 1, &
         mpi_comm_world, self%request)
      self%is_posted = .true.
   end subroutine post

   !> Wait until the numbers have left
   subroutine finish(self)
      !> What is on its way; nothing afterwards
      class(outbox_t), intent(inout) :: self

      if (.not. self%is_posted) return
      call mpi_wait(self%request, mpi_status_ignore)
      self%is_posted = .false.
   end subroutine finish

   !> An error of one rank becomes that of all: the first rank's, if it has one. All ranks call this
   subroutine share_error(error)
      !> Error of this rank; on return that of all, or unallocated if no rank has one
      type(error_t), allocatable, intent(inout) :: error

      character(len=:), allocatable :: message
      character(len=24) :: name
      integer :: numbers(2), owner

      if (ranks == 1) return
      owner = ranks
      if (allocated(error)) owner = rank
      call mpi_allreduce(mpi_in_place, owner, 1, mpi_integer, mpi_min, mpi_comm_world)
      if (owner == ranks) return
      numbers = 0
      message = ''
      if (owner == rank) then
         message = error%message
         write (name, '(a, i0, a)') 'rank ', rank, ': '
         if (rank > 0) message = trim(name)//' '//message
         numbers = [error%code, len(message)]
      end if
      call mpi_bcast(numbers, 2, mpi_integer, owner, mpi_comm_world)
      if (owner /= rank) message = repeat(' ', numbers(2))
      call mpi_bcast(message, numbers(2), mpi_character, owner, mpi_comm_world)
      call raise(error, numbers(1), message)
   end subroutine share_error

   !> What the first rank knows becomes known to all. All ranks call this
   subroutine share_flag(flag)
      !> Flag; on return that of the first rank
      logical, intent(inout) :: flag

      integer :: number

      if (ranks == 1) return
      number = merge(1, 0, flag)
      call mpi_bcast(number, 1, mpi_integer, 0, mpi_comm_world)
      flag = number == 1
   end subroutine share_flag

   !> Whether a number is another one on different ranks. All ranks call this
   function differs(number)
      !> Number of this rank
      integer, intent(in) :: number
      !> Whether not all are the same
      logical :: differs

      integer :: ends(2)

      differs = .false.
      if (ranks == 1) return
      ! the largest of the numbers and of their complements
      ends = [number, not(number)]
      call mpi_allreduce(mpi_in_place, ends, 2, mpi_integer, mpi_max, mpi_comm_world)
      differs = ends(1) /= not(ends(2))
   end function differs

#else

   !> Begin, before anything else
   subroutine join_ranks()
   end subroutine join_ranks

   !> End: waits for all ranks
   subroutine leave_ranks()
   end subroutine leave_ranks

   !> Send an order to a rank; there is none
   subroutine send_order(order, to)
      !> The order
      integer, intent(in) :: order(2)
      !> The rank
      integer, intent(in) :: to

      ! nobody to send to
      if (to == rank .and. order(1) > 0) return
   end subroutine send_order

   !> Wait for an order of the first rank; there is none
   subroutine receive_order(order)
      !> The order: to end
      integer, intent(out) :: order(2)

      order = 0
   end subroutine receive_order

   !> Look whether something has arrived; nothing ever does
   subroutine look(self, from, has_arrived)
      !> What is on its way
      class(inbox_t), intent(inout) :: self
      !> Rank that sends
      integer, intent(in) :: from
      !> Whether `numbers` is complete
      logical, intent(out) :: has_arrived

      has_arrived = self%is_posted .and. from > ranks
   end subroutine look

   !> Send numbers to the first rank, which keeps them
   subroutine post(self, numbers)
      !> Nothing is on its way in it
      class(outbox_t), intent(inout) :: self
      !> The numbers; not allocated afterwards, shape (n)
      real(wp), allocatable, intent(inout) :: numbers(:)

      call move_alloc(numbers, self%numbers)
   end subroutine post

   !> Wait until the numbers have left
   subroutine finish(self)
      !> What is on its way; nothing afterwards
      class(outbox_t), intent(inout) :: self

      self%is_posted = .false.
   end subroutine finish

   !> An error of one rank becomes that of all: there is one rank
   subroutine share_error(error)
      !> Error of this rank
      type(error_t), allocatable, intent(inout) :: error

      if (allocated(error)) error%message = trim(error%message)
   end subroutine share_error

   !> What the first rank knows becomes known to all: there is one rank
   subroutine share_flag(flag)
      !> The flag
      logical, intent(inout) :: flag

      flag = flag .and. ranks == 1
   end subroutine share_flag

   !> Whether a number is another one on different ranks: there is one rank
   function differs(number)
      !> Number of this rank
      integer, intent(in) :: number
      !> Whether not all are the same
      logical :: differs

      differs = number /= number + rank
   end function differs

#endif

end module vcor_sweep_mpi
