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
      !> Number of points
      integer :: count = 0
      !> First of them
      integer :: first = 0
      !> What was wrong there
      character(len=:), allocatable :: message
   end type failure_t

   !> All reasons
   type :: failures_t
      !> Number of points without a result
      integer :: count = 0
      !> Number of reasons
      integer :: reasons = 0
      !> Reasons; those in use are 1 to `reasons`
      type(failure_t) :: reason(most_reasons)
      !> Number of points with an estimated error above the accuracy asked for
      integer :: inexact = 0
      !> First of them
      integer :: first_inexact = 0
   contains
      !> Note a point without a result
      procedure :: note
      !> Note a point with an estimated error above the accuracy asked for
      procedure :: note_inexact
      !> Order the reasons by their first point
      procedure :: sort
      !> All reasons as numbers
      procedure :: pack => pack_reasons
      !> Add reasons from numbers
      procedure :: add_packed
   end type failures_t

contains

   !> Note a point without a result. In whatever order the points come, the reasons are the same in
   !> the end, as long as there are not more than `most_reasons`; the rest counts for the last one
   pure subroutine note(self, point, message)
      !> The reasons
      class(failures_t), intent(inout) :: self
      !> Number of the point
      integer, intent(in) :: point
      !> What is wrong; what differs in its numbers only is the same reason
      character(len=*), intent(in) :: message

      call note_points(self, 1, point, message)
   end subroutine note

   !> Note a point with an estimated error above the accuracy asked for
   pure subroutine note_inexact(self, point)
      !> The reasons
      class(failures_t), intent(inout) :: self
      !> Number of the point
      integer, intent(in) :: point

      call note_inexact_points(self, 1, point)
   end subroutine note_inexact

   !> Note points with an estimated error above the accuracy asked for
   pure subroutine note_inexact_points(self, count, point)
      !> The reasons
      class(failures_t), intent(inout) :: self
      !> Number of points
      integer, intent(in) :: count
      !> First of them
      integer, intent(in) :: point

      if (count == 0) return
      if (self%inexact == 0 .or. point < self%first_inexact) self%first_inexact = point
      self%inexact = self%inexact + count
   end subroutine note_inexact_points

   !> Note points without a result, for one reason
   pure subroutine note_points(self, count, point, message)
      !> The reasons
      class(failures_t), intent(inout) :: self
      !> Number of points
      integer, intent(in) :: count
      !> First of them
      integer, intent(in) :: point
      !> What is wrong
      character(len=*), intent(in) :: message

      integer :: i

      self%count = self%count + count
      do i = 1, self%reasons
         if (words_of(self%reason(i)%message) == words_of(message)) exit
      end do
      i = min(i, most_reasons)
      self%reasons = max(self%reasons, i)
      associate (reason => self%reason(i))
         if (reason%count == 0 .or. point < reason%first) then
            reason%first = point
            reason%message = message
         end if
         reason%count = reason%count + count
      end associate
   end subroutine note_points

   !> All reasons as numbers: for each count, first point, numbers of its text, text; that of
   !> inexact points has no text
   pure function pack_reasons(self) result(numbers)
      !> The reasons
      class(failures_t), intent(in) :: self
      !> Numbers, shape (n)
      real(wp), allocatable :: numbers(:)

      integer :: i

      numbers = real([self%inexact, self%first_inexact, 0], wp)
      do i = 1, self%reasons
         associate (reason => self%reason(i), text => numbers_of(self%reason(i)%message))
            numbers = [numbers, real([reason%count, reason%first, size(text)], wp), text]
         end associate
      end do
   end function pack_reasons

   !> Add reasons from numbers
   pure subroutine add_packed(self, numbers)
      !> The reasons
      class(failures_t), intent(inout) :: self
      !> Numbers, as `pack` made them, any number of times, shape (n)
      real(wp), intent(in) :: numbers(:)

      integer :: at, count, first, length

      at = 0
      do while (at < size(numbers))
         count = nint(numbers(at + 1))
         first = nint(numbers(at + 2))
         length = nint(numbers(at + 3))
         if (length == 0) then
            call note_inexact_points(self, count, first)
         else
            call note_points(self, count, first, trim(text_of(numbers(at + 4:at + 3 + length))))
         end if
         at = at + 3 + length
      end do
   end subroutine add_packed
   !> Order the reasons by their first point
   pure subroutine sort(self)
      !> The reasons
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
      !> The message
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
