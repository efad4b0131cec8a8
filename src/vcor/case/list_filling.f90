!> Lists that a namelist gives in parts, `moduli(1) = ...` and `moduli(2:3) = ...`
module vcor_case_list_filling
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, shortened
   implicit none
   private

   public :: filling_t

   !> Largest index of a list that is given in parts
   integer, parameter :: largest_index = 100000

   !> One list
   type :: list_t
      !> Handle of its entry
      integer :: handle = 0
      !> Line of its first part
      integer :: line = 0
      !> Largest index so far
      integer :: n = 0
      !> The numbers, shape (>= n)
      real(wp), allocatable :: numbers(:)
      !> Which of them are there, shape (>= n)
      logical, allocatable :: filled(:)
   end type list_t

   !> The lists of one group
   type :: filling_t
      !> Number of lists
      integer :: n = 0
      !> The lists, shape (>= n)
      type(list_t), allocatable, private :: lists(:)
   contains
      !> Begin with no list
      procedure :: clear
      !> Whether parts of a list are there
      procedure :: has
      !> Put a part in its place
      procedure :: put
      !> A list, all parts of which have to be there
      procedure :: finish
   end type filling_t

contains

   !> Begin with no list
   pure subroutine clear(self)
      !> The lists
      class(filling_t), intent(inout) :: self
      ! More than any group has
      integer, parameter :: most_lists = 16

      if (allocated(self%lists)) deallocate(self%lists)
      allocate(self%lists(most_lists))
      self%n = 0
   end subroutine clear

   !> Whether parts of a list are there
   pure function has(self, handle) result(yes)
      !> The lists
      class(filling_t), intent(in) :: self
      !> Handle of the list's entry
      integer, intent(in) :: handle
      !> True if there are
      logical :: yes

      yes = any(self%lists(:self%n)%handle == handle)
   end function has

   !> Put a part in its place
   pure subroutine put(self, handle, section, part, line, message)
      !> The lists
      class(filling_t), intent(inout) :: self
      !> Handle of the list's entry
      integer, intent(in) :: handle
      !> What stands in parentheses: `2`, `2:3`, `2:`, `:3` or `:`
      character(len=*), intent(in) :: section
      !> The numbers, shape (n), n >= 1
      real(wp), intent(in) :: part(:)
      !> Line they stand in
      integer, intent(in) :: line
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      integer :: first, last, i

      call read_section(section, size(part), first, last, message)
      if (allocated(message)) return
      do i = 1, self%n
         if (self%lists(i)%handle == handle) exit
      end do
      self%n = max(self%n, i)
      associate (list => self%lists(i))
         if (list%handle == 0) then
            list%handle = handle
            list%line = line
            allocate(list%numbers(last), list%filled(last))
            list%filled = .false.
         end if
         call make_room(list, last)
         if (any(list%filled(first:last))) then
            message = "element "//integer_text(first - 1 + findloc_true(list%filled(first:last))) &
               & //" is given twice"
            return
         end if
         list%numbers(first:last) = part
         list%filled(first:last) = .true.
         list%n = max(list%n, last)
      end associate
   end subroutine put

   !> A list, all parts of which have to be there
   pure subroutine finish(self, i, handle, numbers, line, message)
      !> The lists
      class(filling_t), intent(in) :: self
      !> Which list, 1 to n
      integer, intent(in) :: i
      !> Handle of its entry
      integer, intent(out) :: handle
      !> The numbers, shape (n)
      real(wp), allocatable, intent(out) :: numbers(:)
      !> Line of its first part
      integer, intent(out) :: line
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      associate (list => self%lists(i))
         handle = list%handle
         line = list%line
         numbers = list%numbers(:list%n)
         if (.not. all(list%filled(:list%n))) message = "element " &
            & //integer_text(findloc_true(.not. list%filled(:list%n)))//" of the list is missing"
      end associate
   end subroutine finish

   !> Make room for more numbers
   pure subroutine make_room(list, n)
      !> The list
      type(list_t), intent(inout) :: list
      !> Largest index there has to be room for
      integer, intent(in) :: n
      real(wp), allocatable :: numbers(:)
      logical, allocatable :: filled(:)

      if (n <= size(list%filled)) return
      allocate(numbers(2*n), filled(2*n))
      filled = .false.
      numbers(:list%n) = list%numbers(:list%n)
      filled(:list%n) = list%filled(:list%n)
      call move_alloc(numbers, list%numbers)
      call move_alloc(filled, list%filled)
   end subroutine make_room

   !> Index of the first true element
   pure function findloc_true(mask) result(i)
      !> Logicals, shape (n)
      logical, intent(in) :: mask(:)
      !> Index, n + 1 when there is none
      integer :: i

      do i = 1, size(mask)
         if (mask(i)) return
      end do
   end function findloc_true

   !> Read a section
   pure subroutine read_section(section, n, first, last, message)
      !> What stands in parentheses
      character(len=*), intent(in) :: section
      !> Number of values there are for it
      integer, intent(in) :: n
      !> First index
      integer, intent(out) :: first
      !> Last index
      integer, intent(out) :: last
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      integer :: colon
      logical :: good

      last = 0
      colon = index(section, ":")
      if (colon == 0) then
         ! As gfortran and f90nml do, more values than one go on from this element
         call read_index(section, 0, first, good)
         last = first + n - 1
      else
         call read_index(section(:colon-1), 1, first, good)
         if (good) call read_index(section(colon+1:), first + n - 1, last, good)
      end if
      if (.not. good) then
         message = "found ("//shortened(section)//"), expected such as (2) or (2:3), from 1 to " &
            & //integer_text(largest_index)
      else if (last - first + 1 /= n) then
         message = "found "//integer_text(n)//" values for ("//shortened(section)//"), expected " &
            & //integer_text(max(0, last - first + 1))
      else if (last > largest_index) then
         message = "found index "//integer_text(last)//", expected at most " &
            & //integer_text(largest_index)
      end if
   end subroutine read_section

   !> Read an index
   pure subroutine read_index(word, default, number, good)
      !> The index as it is written, perhaps between blanks
      character(len=*), intent(in) :: word
      !> What a blank word means; 0: nothing
      integer, intent(in) :: default
      !> The index
      integer, intent(out) :: number
      !> Whether it is an index from 1 to `largest_index`
      logical, intent(out) :: good
      character(len=:), allocatable :: digits
      integer, parameter :: most_digits = 9
      integer :: status

      number = default
      digits = trim(adjustl(word))
      status = 0
      if (digits /= "") then
         status = 1
         if (len(digits) <= most_digits .and. verify(digits, "0123456789") == 0) &
            & read(digits, *, iostat=status) number
      end if
      good = status == 0 .and. number >= 1 .and. (number <= largest_index .or. digits == "")
   end subroutine read_index

end module vcor_case_list_filling
