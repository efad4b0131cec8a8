!> Points without a result, grouped by the reason, and those whose result is not what was asked for
module vcor_sweep_failures
   use vcor_kinds, only : wp
   use vcor_sweep_mpi, only : numbers_of, text_of
   implicit none
   private

   public :: failure_t, failures_t

   !> Most reasons that are told apart
   integer, parameter :: most_reasons = 20

   !> One reason
   type :: failure_t
      integer :: count = 0
      !> First of them
      integer :: first = huge(1)
      !> What was wrong there; empty: the estimated error is above the accuracy asked for
      character(len=:), allocatable :: message
   end type failure_t

   !> All reasons
   type :: failures_t
      !> Number of points without a result
      integer :: count = 0
      integer :: reasons = 0
      !> Reasons; those in use are 1 to `reasons`
      type(failure_t) :: reason(most_reasons)
      !> Points with an estimated error above the accuracy asked for
      type(failure_t) :: inexact
   contains
      procedure :: note, sort, add_packed
      procedure :: pack => pack_reasons
   end type failures_t

contains

   !> Note points. In whatever order they come, the reasons are the same in the end, as long as
   !> there are not more than `most_reasons`; the rest counts for the last one
   pure subroutine note(self, point, message, count)
      class(failures_t), intent(inout) :: self
      !> Number of the first of the points
      integer, intent(in) :: point
      !> Why they have no result; what differs in its numbers only is the same reason. Empty: they
      !> have one with an estimated error above the accuracy asked for
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
         if (words_of(self%reason(i)%message) == words_of(message)) exit
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

   !> All reasons as numbers: for each first point, count, numbers of its text, text
   pure function pack_reasons(self) result(numbers)
      class(failures_t), intent(in) :: self
      !> Numbers, shape (n)
      real(wp), allocatable :: numbers(:)

      integer :: i

      allocate (numbers(0))
      if (self%inexact%count > 0) &
         numbers = real([self%inexact%first, self%inexact%count, 0], wp)
      do i = 1, self%reasons
         associate (reason => self%reason(i), text => numbers_of(self%reason(i)%message))
            numbers = [numbers, real([reason%first, reason%count, size(text)], wp), text]
         end associate
      end do
   end function pack_reasons

   !> Add reasons from numbers
   pure subroutine add_packed(self, numbers)
      class(failures_t), intent(inout) :: self
      !> Numbers, as `pack` made them, any number of times, shape (n)
      real(wp), intent(in) :: numbers(:)

      integer :: at, next

      at = 1
      do while (at < size(numbers))
         next = at + 3 + nint(numbers(at + 2))
         call self%note(nint(numbers(at)), trim(text_of(numbers(at + 3:next - 1))), &
            nint(numbers(at + 1)))
         at = next
      end do
   end subroutine add_packed

   !> Order the reasons by their first point
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
      !> Its text without what numbers are written with
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

end module vcor_sweep_failures
