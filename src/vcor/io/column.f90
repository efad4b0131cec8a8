!> Columns of results: a name, a unit, a meaning, and values of one kind
!>
!> Units: `1` for numbers without dimension, such as ratios, counts and numbers in a row; the SI
!> unit otherwise, as in `m/s` and `N s`; nothing for text.
module vcor_io_column
   use vcor_kinds, only : wp
   implicit none
   private

   public :: column_t, real_column, integer_column, text_column
   public :: describe, join_texts, move_column, text_value

   !> Kind of a column: real numbers
   integer, parameter :: real_column = 1
   !> Kind of a column: whole numbers
   integer, parameter :: integer_column = 2
   !> Kind of a column: text
   integer, parameter :: text_column = 3

   !> One column: what it is called and its values, of one kind
   type :: column_t
      !> Name, one line
      character(len=:), allocatable :: name
      !> Unit: `1` without dimension, empty for text
      character(len=:), allocatable :: unit
      !> What it is, one line
      character(len=:), allocatable :: long_name
      !> `real_column`, `integer_column` or `text_column`: which of the following is allocated
      integer :: kind = real_column
      !> Values, shape (length)
      real(wp), allocatable :: reals(:)
      !> Values, shape (length)
      integer, allocatable :: integers(:)
      !> Values one after the other, each `width` characters, padded with blanks
      character(len=:), allocatable :: texts
      !> Characters per text value
      integer :: width = 0
      !> Number of values
      integer :: length = 0
   end type column_t

contains

   !> Set everything but the values
   pure subroutine describe(column, name, unit, long_name, kind, length)
      !> Column to describe
      type(column_t), intent(inout) :: column
      !> Name
      character(len=*), intent(in) :: name
      !> Unit
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name
      !> One of the kinds of columns
      integer, intent(in) :: kind
      !> Number of values
      integer, intent(in) :: length

      column%name = trim(name)
      column%unit = trim(unit)
      column%long_name = trim(long_name)
      column%kind = kind
      column%length = length
   end subroutine describe

   !> Set the values of a text column
   pure subroutine join_texts(column, values)
      !> Column to set
      type(column_t), intent(inout) :: column
      !> Values, shape (length)
      character(len=*), intent(in) :: values(:)
      integer :: i, width

      ! One text for all: no memory of its own for each of a million values
      width = 0
      if (size(values) > 0) width = maxval(len_trim(values))
      column%width = width
      allocate(character(len=width*size(values)) :: column%texts)
      do i = 1, size(values)
         column%texts((i - 1)*width + 1:i*width) = values(i)
      end do
   end subroutine join_texts

   !> Move a column without a copy of its values
   pure subroutine move_column(from, to)
      !> Column to move; without values afterwards
      type(column_t), intent(inout) :: from
      !> Where it goes
      type(column_t), intent(inout) :: to

      call move_alloc(from%name, to%name)
      call move_alloc(from%unit, to%unit)
      call move_alloc(from%long_name, to%long_name)
      call move_alloc(from%reals, to%reals)
      call move_alloc(from%integers, to%integers)
      call move_alloc(from%texts, to%texts)
      to%kind = from%kind
      to%width = from%width
      to%length = from%length
   end subroutine move_column

   !> Value of a text column
   pure function text_value(column, row) result(text)
      !> Text column
      type(column_t), intent(in) :: column
      !> Number of the value, from 1
      integer, intent(in) :: row
      !> The value, without blanks at its end
      character(len=:), allocatable :: text

      text = trim(column%texts((row - 1)*column%width + 1:row*column%width))
   end function text_value

end module vcor_io_column
