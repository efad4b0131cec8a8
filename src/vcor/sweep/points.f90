!> The points of a sweep, or of a part of it, as a task of all ranks and their threads
module vcor_sweep_points
   use vcor_error, only : error_t
   use vcor_kinds, only : wp
   use vcor_impact_trajectory, only : contact_lasting, contact_sticking
   use vcor_sweep_aside, only : aside_t
   use vcor_sweep_failures, only : failures_t
   use vcor_sweep_monitor, only : monitor_t
   use vcor_sweep_mpi, only : rank_count
   use vcor_sweep_partition, only : new_todo, part_t, todo_t
   use vcor_sweep_quantity, only : point_failed, point_invalid, point_pending
   use vcor_sweep_summary, only : new_summary, numbers_per_point, summary_t
   use vcor_sweep_sweep, only : lacking, solve_points, sweep_t
   use vcor_sweep_team, only : task_t, work_together
   implicit none
   private

   public :: solve_part

   !> Outcomes that the first rank has to keep
   type, extends(aside_t) :: keeping_t
      !> First place
      integer :: first = 0
      !> Last place
      integer :: last = 0
      !> Outcomes of these places as `solve` made them, shape (n); not allocated: there are none
      real(wp), allocatable :: result(:)
      !> Where they are kept, all places of the part
      type(summary_t), pointer :: summary => null()
      !> What has no result and why
      type(failures_t), pointer :: failures => null()
      !> Who watches
      class(monitor_t), pointer :: monitor => null()
      !> What ends the sweep
      type(error_t), allocatable :: error
   contains
      !> Keep them
      procedure :: run
   end type keeping_t

   !> Points as a task
   type, extends(task_t) :: points_t
      !> The sweep
      type(sweep_t), pointer :: sweep => null()
      !> Part of its points
      type(part_t) :: part
      !> Threads of this rank
      integer :: threads = 1
      !> What is to be kept, on the first rank
      type(keeping_t) :: keeping
      !> Whether a thread keeps outcomes while others solve the next ones: where there are threads,
      !> and no other ranks that wait for this one
      logical :: overlaps = .false.
   contains
      !> Solve places
      procedure :: solve
      !> Take their outcomes
      procedure :: take
      !> Whether to stop
      procedure :: stop_code
   end type points_t

contains

   !> Solve what is pending of a part of a sweep; all ranks call this
   !>
   !> Reasons are not kept in files. A failure that comes from there is solved once more for its
   !> reason: the status stays, since the same point gives the same bits.
   subroutine solve_part(sweep, part, threads, monitor, summary, failures, stopped, error)
      !> The sweep
      type(sweep_t), intent(in), target :: sweep
      !> Part of its points
      type(part_t), intent(in) :: part
      !> Threads of this rank, > 0
      integer, intent(in) :: threads
      !> Who watches
      class(monitor_t), intent(inout), target :: monitor
      !> Outcomes of all places of the part, those that are there already included; on the first
      !> rank
      type(summary_t), intent(inout), target :: summary
      !> What points have no result and why; on the first rank
      type(failures_t), intent(out), target :: failures
      !> Stop code of the monitor if it has ended the sweep before its time, 0 otherwise
      integer, intent(out) :: stopped
      !> What ended the sweep; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(points_t) :: task
      type(todo_t) :: todo
      integer :: i

      task%sweep => sweep
      task%part = part
      task%threads = threads
      task%least = 2*threads
      if (threads == 1) task%least = 1
      task%overlaps = threads > 1 .and. rank_count() == 1
      task%keeping%summary => summary
      task%keeping%failures => failures
      task%keeping%monitor => monitor
      if (allocated(summary%status)) then
         do i = 1, size(summary%status)
            if (any(summary%status(i) == [contact_lasting, contact_sticking])) &
               call failures%note(part%point(i), lacking(summary%status(i)))
         end do
         call new_todo(todo, .not. (summary%status == point_pending &
            .or. summary%status == point_invalid .or. summary%status == point_failed))
      end if
      call work_together(task, todo, stopped, error)
      if (.not. allocated(error)) then
         call task%keeping%run()
         call move_alloc(task%keeping%error, error)
      end if
      call failures%sort()
   end subroutine solve_part

   !> Solve places
   subroutine solve(self, first, last, result, error)
      !> The points
      class(points_t), intent(inout) :: self
      !> First place
      integer, intent(in) :: first
      !> Last place
      integer, intent(in) :: last
      !> Outcomes, then what has none and why, shape (n)
      real(wp), allocatable, intent(out) :: result(:)
      !> Error of code `error_internal` if there is not enough memory; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(summary_t) :: summary
      type(failures_t) :: failures
      integer :: n

      n = last - first + 1
      call new_summary(summary, n, error, before=first - 1)
      if (allocated(error)) return
      if (self%overlaps) then
         call solve_points(self%sweep, first, last, self%threads, summary, failures, self%part, &
            self%keeping)
         call move_alloc(self%keeping%error, error)
         if (allocated(error)) return
      else
         call solve_points(self%sweep, first, last, self%threads, summary, failures, self%part)
      end if
      associate (reasons => failures%pack())
         allocate (result(n*numbers_per_point + size(reasons)))
         result(n*numbers_per_point + 1:) = reasons
      end associate
      call pack_into(result)

   contains

      !> Outcomes as the first of so many numbers
      subroutine pack_into(numbers)
         !> Numbers, by point and quantity
         real(wp), intent(inout) :: numbers(n, numbers_per_point)

         call summary%pack(numbers)
      end subroutine pack_into
   end subroutine solve

   !> Take the outcomes of places; with threads they are kept along with the next ones at work
   subroutine take(self, first, last, result, error)
      !> The points
      class(points_t), intent(inout) :: self
      !> First place
      integer, intent(in) :: first
      !> Last place
      integer, intent(in) :: last
      !> Outcomes, as `solve` made them, shape (n)
      real(wp), intent(in) :: result(:)
      !> What ends the sweep; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      self%keeping%first = first
      self%keeping%last = last
      self%keeping%result = result
      if (self%overlaps) return
      call self%keeping%run()
      call move_alloc(self%keeping%error, error)
   end subroutine take

   !> Keep outcomes
   subroutine run(self)
      !> The outcomes; none afterwards
      class(keeping_t), intent(inout) :: self

      integer :: n

      if (.not. allocated(self%result)) return
      n = self%last - self%first + 1
      call unpack_from(self%result)
      ! other threads may be noting theirs: one at a time, see vcor_sweep_sweep
!$omp critical (vcor_failures)
      call self%failures%add_packed(self%result(n*numbers_per_point + 1:))
!$omp end critical (vcor_failures)
      call self%monitor%finished(self%first, self%last, self%summary, self%error)
      deallocate (self%result)

   contains

      !> Outcomes from the first of so many numbers
      subroutine unpack_from(numbers)
         !> Numbers, by point and quantity
         real(wp), intent(in) :: numbers(n, numbers_per_point)

         call self%summary%unpack(self%first, numbers)
      end subroutine unpack_from
   end subroutine run

   !> Whether to stop
   function stop_code(self) result(code)
      !> The points
      class(points_t), intent(in) :: self
      !> 0 to go on
      integer :: code

      code = self%keeping%monitor%stop_code()
   end function stop_code

end module vcor_sweep_points
