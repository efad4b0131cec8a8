!> A task that counts how often each place is solved, and fails or stops where it is told to
module vcor_counting_task
   use vcor_error, only : error_numerical, error_t, raise
   use vcor_kinds, only : wp
   use vcor_sweep_team, only : task_t
   implicit none
   private

   public :: counting_t

   !> Places that are counted
   type, extends(task_t) :: counting_t
      !> How often each was solved, shape (places)
      integer, allocatable :: seen(:)
      !> What came of it, shape (places)
      real(wp), allocatable :: values(:)
      !> Chunks solved on this rank
      integer :: chunks = 0
      !> Chunks after which it fails on this rank
      integer :: fails_after = huge(1)
      !> Chunks after which it stops
      integer :: stops_after = huge(1)
   contains
      !> Solve places
      procedure :: solve
      !> Take what came of it
      procedure :: take
      !> Whether to stop
      procedure :: stop_code
      !> Begin
      procedure :: reset
      !> Whether each place was solved once
      procedure :: is_right
   end type counting_t

contains

   !> Begin
   subroutine reset(self, places)
      !> The task
      class(counting_t), intent(inout) :: self
      !> Number of places
      integer, intent(in) :: places

      if (allocated(self%seen)) deallocate (self%seen, self%values)
      allocate (self%seen(places), source=0)
      allocate (self%values(places), source=0.0_wp)
      self%chunks = 0
      self%fails_after = huge(1)
      self%stops_after = huge(1)
   end subroutine reset

   !> Whether each place was solved once
   pure function is_right(self)
      !> The task
      class(counting_t), intent(in) :: self
      !> Whether it was
      logical :: is_right
      integer :: i

      is_right = all(self%seen == 1) .and. all(self%values >= 0.0_wp)
      do i = 1, size(self%values)
         if (self%values(i) > 0.0_wp) is_right = is_right .and. nint(self%values(i)) == i
      end do
   end function is_right

   !> Solve places
   subroutine solve(self, first, last, result, error)
      !> The task
      class(counting_t), intent(inout) :: self
      !> First place
      integer, intent(in) :: first
      !> Last place
      integer, intent(in) :: last
      !> Numbers of the places
      real(wp), allocatable, intent(out) :: result(:)
      !> Set after so many chunks
      type(error_t), allocatable, intent(out) :: error
      integer :: i, now, start, rate

      self%chunks = self%chunks + 1
      if (self%chunks > self%fails_after) then
         call raise(error, error_numerical, "injected failure")
         return
      end if
      ! a place takes a tenth of a millisecond
      call system_clock(start, rate)
      do
         call system_clock(now)
         if (real(now - start, wp) >= 1.0e-4_wp*real(rate, wp)*real(last - first + 1, wp)) exit
      end do
      result = [(real(i, wp), i = first, last)]
   end subroutine solve

   !> Take what came of it
   subroutine take(self, first, last, result, error)
      !> The task
      class(counting_t), intent(inout) :: self
      !> First place
      integer, intent(in) :: first
      !> Last place
      integer, intent(in) :: last
      !> Numbers of the places
      real(wp), intent(in) :: result(:)
      !> Set if there are not as many as places
      type(error_t), allocatable, intent(out) :: error

      if (size(result) /= last - first + 1) then
         call raise(error, error_numerical, "another number of results than expected")
         return
      end if
      self%seen(first:last) = self%seen(first:last) + 1
      self%values(first:last) = result
   end subroutine take

   !> Whether to stop
   function stop_code(self) result(code)
      !> The task
      class(counting_t), intent(in) :: self
      !> 15 after so many chunks
      integer :: code

      code = 0
      if (self%chunks >= self%stops_after) code = 15
   end function stop_code

end module vcor_counting_task
