!> A text that grows at its end, in a time proportional to its length
module vcor_buffer
   implicit none
   private

   public :: buffer_t

   !> A growing text
   type :: buffer_t
      !> Bytes so far
      integer :: length = 0
      !> Room for bytes, the first `length` are in use
      character(len=:), allocatable, private :: room
   contains
      !> Put a text at the end
      procedure :: add
      !> The text so far
      procedure :: text
   end type buffer_t

contains

   !> Put a text at the end
   pure subroutine add(self, part)
      class(buffer_t), intent(inout) :: self
      character(len=*), intent(in) :: part
      character(len=:), allocatable :: larger
      integer, parameter :: first_room = 256

      if (.not. allocated(self%room)) allocate(character(len=first_room) :: self%room)
      if (self%length + len(part) > len(self%room)) then
         allocate(character(len=2*(self%length + len(part))) :: larger)
         larger(:self%length) = self%room(:self%length)
         call move_alloc(larger, self%room)
      end if
      self%room(self%length+1:self%length+len(part)) = part
      self%length = self%length + len(part)
   end subroutine add

   !> The text so far
   pure function text(self) result(all)
      class(buffer_t), intent(in) :: self
      !> Everything that was added
      character(len=self%length) :: all

      if (self%length > 0) all = self%room(:self%length)
   end function text

end module vcor_buffer
