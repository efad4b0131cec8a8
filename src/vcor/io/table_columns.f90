!> Dimensions and columns of every kind put into a table, all dimensions before the first column
module vcor_io_table_columns
   use vcor_io_column, only : column_t, describe, integer_column, join_texts, real_column, &
      & text_column
   use vcor_io_table, only : table_t, take_column, take_dimension
   use vcor_kinds, only : wp
   implicit none
   private

   public :: add_dimension, add_column, move_in_column

   !> Add a dimension, all of them before the first column
   interface add_dimension
      module procedure add_index_dimension
      module procedure add_real_dimension
      module procedure add_integer_dimension
      module procedure add_text_dimension
   end interface add_dimension

   !> Add a column; its length is the product of the lengths of all dimensions
   interface add_column
      module procedure add_real_column
      module procedure add_integer_column
      module procedure add_text_column
   end interface add_column

   !> Add a column whose values move to the table: nothing is copied, which counts for millions
   interface move_in_column
      module procedure move_in_real_column
      module procedure move_in_integer_column
   end interface move_in_column

contains

   !> Add a dimension whose coordinates are the numbers 1, 2, 3 ...
   pure subroutine add_index_dimension(table, name, length)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the dimension
      character(len=*), intent(in) :: name
      !> Its length, not negative
      integer, intent(in) :: length
      type(column_t) :: coordinate
      integer :: i

      call describe(coordinate, name, "1", "number of the "//name, integer_column, max(length, 0))
      coordinate%integers = [(i, i = 1, length)]
      call take_dimension(table, coordinate, .true.)
   end subroutine add_index_dimension

   !> Add a dimension with real numbers
   pure subroutine add_real_dimension(table, name, values, unit, long_name)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the dimension
      character(len=*), intent(in) :: name
      !> Coordinates, shape (length)
      real(wp), intent(in) :: values(:)
      !> Unit
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name
      type(column_t) :: coordinate

      call describe(coordinate, name, unit, long_name, real_column, size(values))
      coordinate%reals = values
      call take_dimension(table, coordinate, .false.)
   end subroutine add_real_dimension

   !> Add a dimension with whole numbers
   pure subroutine add_integer_dimension(table, name, values, unit, long_name)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the dimension
      character(len=*), intent(in) :: name
      !> Coordinates, shape (length)
      integer, intent(in) :: values(:)
      !> Unit
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name
      type(column_t) :: coordinate

      call describe(coordinate, name, unit, long_name, integer_column, size(values))
      coordinate%integers = values
      call take_dimension(table, coordinate, .false.)
   end subroutine add_integer_dimension

   !> Add a dimension with names
   pure subroutine add_text_dimension(table, name, values, unit, long_name)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the dimension
      character(len=*), intent(in) :: name
      !> Coordinates, shape (length)
      character(len=*), intent(in) :: values(:)
      !> Unit, empty
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name
      type(column_t) :: coordinate

      call describe(coordinate, name, unit, long_name, text_column, size(values))
      call join_texts(coordinate, values)
      call take_dimension(table, coordinate, .false.)
   end subroutine add_text_dimension

   !> Add a column of real numbers
   pure subroutine add_real_column(table, name, values, unit, long_name)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the column
      character(len=*), intent(in) :: name
      !> Values, shape (rows); NaN and infinity are allowed
      real(wp), intent(in) :: values(:)
      !> Unit
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name

      call take_column(table, name, unit, long_name, real_column, size(values))
      if (allocated(table%fault)) return
      table%columns(table%column_count)%reals = values
   end subroutine add_real_column

   !> Add a column of whole numbers
   pure subroutine add_integer_column(table, name, values, unit, long_name)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the column
      character(len=*), intent(in) :: name
      !> Values, shape (rows)
      integer, intent(in) :: values(:)
      !> Unit
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name

      call take_column(table, name, unit, long_name, integer_column, size(values))
      if (allocated(table%fault)) return
      table%columns(table%column_count)%integers = values
   end subroutine add_integer_column

   !> Add a column of text
   pure subroutine add_text_column(table, name, values, unit, long_name)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the column
      character(len=*), intent(in) :: name
      !> Values, shape (rows); blanks at their ends do not count
      character(len=*), intent(in) :: values(:)
      !> Unit, empty
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name

      call take_column(table, name, unit, long_name, text_column, size(values))
      if (allocated(table%fault)) return
      call join_texts(table%columns(table%column_count), values)
   end subroutine add_text_column

   !> Add a column of real numbers, which move
   pure subroutine move_in_real_column(table, name, values, unit, long_name)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the column
      character(len=*), intent(in) :: name
      !> Values, shape (rows); not allocated afterwards
      real(wp), allocatable, intent(inout) :: values(:)
      !> Unit
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name

      call take_column(table, name, unit, long_name, real_column, size(values))
      if (allocated(table%fault)) return
      call move_alloc(values, table%columns(table%column_count)%reals)
   end subroutine move_in_real_column

   !> Add a column of whole numbers, which move
   pure subroutine move_in_integer_column(table, name, values, unit, long_name)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the column
      character(len=*), intent(in) :: name
      !> Values, shape (rows); not allocated afterwards
      integer, allocatable, intent(inout) :: values(:)
      !> Unit
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name

      call take_column(table, name, unit, long_name, integer_column, size(values))
      if (allocated(table%fault)) return
      call move_alloc(values, table%columns(table%column_count)%integers)
   end subroutine move_in_integer_column

end module vcor_io_table_columns
