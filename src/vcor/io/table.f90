!> Tables of results: named columns over one or more named dimensions, and what describes them
!>
!>     call new_table(summary, version, title, case_text)
!>     call add_dimension(summary, "impact", rows)
!>     call add_column(summary, "cor", cor, "1", "coefficient of restitution")
!>
!> A plain table has one dimension. Its coordinates are numbers of their own, such as the times of a
!> history, or just the row numbers 1, 2, 3 ... A grid has more dimensions; the rows of its columns
!> run through them with the last dimension the fastest, as in nested loops, the first one outside.
!>
!> Units: `1` for numbers without dimension, such as ratios, counts and numbers in a row; the SI
!> unit otherwise, as in `m/s` and `N s`; nothing for text.
!>
!> Building a table cannot fail at the caller's hand: the first fault (lengths that do not match, a
!> name twice) is kept, and `check_table`, which every writer calls, makes an error of it. All
!> components are public for the writers and for reading; they are set by the procedures below only.
module vcor_io_table
   use vcor_error, only : error_internal, error_t, raise
   use vcor_kinds, only : wp
   implicit none
   private

   public :: table_t, column_t, dimension_t, fact_t
   public :: new_table, add_dimension, add_column, add_fact, move_in_column, check_table
   public :: row_count, coordinate_row, text_value
   public :: real_column, integer_column, text_column

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

   !> One dimension
   type :: dimension_t
      !> Coordinates; their name is that of the dimension, their number its length
      type(column_t) :: coordinate
      !> True if the coordinates are the numbers 1, 2, 3 ... and say nothing by themselves
      logical :: is_index = .false.
   end type dimension_t

   !> A number that holds for a table as a whole
   type :: fact_t
      !> Name, one word
      character(len=:), allocatable :: name
      !> The number
      real(wp) :: value = 0.0_wp
      !> Unit
      character(len=:), allocatable :: unit
      !> What it is, one line
      character(len=:), allocatable :: long_name
   end type fact_t

   !> A table
   type :: table_t
      !> Version of the program that made it
      character(len=:), allocatable :: version
      !> Title of the case
      character(len=:), allocatable :: title
      !> Full case, any number of lines
      character(len=:), allocatable :: case_text
      !> Dimensions, the slowest first; those in use are 1 to `dimension_count`
      type(dimension_t), allocatable :: dimensions(:)
      !> Number of dimensions
      integer :: dimension_count = 0
      !> Columns; those in use are 1 to `column_count`
      type(column_t), allocatable :: columns(:)
      !> Number of columns
      integer :: column_count = 0
      !> Numbers that hold for all of it; those in use are 1 to `fact_count`
      type(fact_t) :: facts(4)
      !> Number of these
      integer :: fact_count = 0
      !> First fault in building the table; not allocated if there is none
      character(len=:), allocatable :: fault
   end type table_t

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

   !> Begin a table
   pure subroutine new_table(table, version, title, case_text)
      !> Table without dimensions and columns
      type(table_t), intent(out) :: table
      !> Version of the program
      character(len=*), intent(in) :: version
      !> Title of the case
      character(len=*), intent(in) :: title
      !> Full case, any number of lines
      character(len=*), intent(in) :: case_text

      table%version = version
      table%title = trim(title)
      table%case_text = case_text
      allocate(table%dimensions(4))
      allocate(table%columns(32))
   end subroutine new_table

   !> Number of rows: the product of the lengths of the dimensions
   pure function row_count(table) result(rows)
      !> Table with at least one dimension
      type(table_t), intent(in) :: table
      !> Number of rows
      integer :: rows
      integer :: i

      rows = 1
      do i = 1, table%dimension_count
         rows = rows*table%dimensions(i)%coordinate%length
      end do
   end function row_count

   !> Which coordinate of a dimension a row has
   pure function coordinate_row(table, number, row) result(place)
      !> Table
      type(table_t), intent(in) :: table
      !> Number of the dimension, from 1
      integer, intent(in) :: number
      !> Number of the row, from 1
      integer, intent(in) :: row
      !> Number of the coordinate, from 1
      integer :: place
      integer :: i, stride

      stride = 1
      do i = number + 1, table%dimension_count
         stride = stride*table%dimensions(i)%coordinate%length
      end do
      place = mod((row - 1)/stride, table%dimensions(number)%coordinate%length) + 1
   end function coordinate_row

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

   !> Check that a table is complete and sound
   pure subroutine check_table(table, error)
      !> Table to check
      type(table_t), intent(in) :: table
      !> Set to the first fault in building it
      type(error_t), allocatable, intent(out) :: error

      if (allocated(table%fault)) then
         call raise(error, error_internal, table%fault)
      else if (table%dimension_count == 0) then
         call raise(error, error_internal, "the table has no dimension, expected at least one")
      end if
   end subroutine check_table

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

   !> Add a number that holds for a table as a whole
   pure subroutine add_fact(table, name, value, unit, long_name)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name
      character(len=*), intent(in) :: name
      !> The number
      real(wp), intent(in) :: value
      !> Unit
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name

      if (table%fact_count == size(table%facts)) then
         table%fault = "a table has more facts than there is room for"
         return
      end if
      table%fact_count = table%fact_count + 1
      associate (fact => table%facts(table%fact_count))
         fact%name = name
         fact%value = value
         fact%unit = unit
         fact%long_name = long_name
      end associate
   end subroutine add_fact

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

   !> Make room for a column and describe it; its values are set by the caller
   pure subroutine take_column(table, name, unit, long_name, kind, length)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Name of the column
      character(len=*), intent(in) :: name
      !> Unit
      character(len=*), intent(in) :: unit
      !> What it is
      character(len=*), intent(in) :: long_name
      !> One of the kinds of columns
      integer, intent(in) :: kind
      !> Number of values
      integer, intent(in) :: length
      type(column_t), allocatable :: more(:)
      integer :: i

      call check_name(table, name)
      if (allocated(table%fault)) return
      if (table%dimension_count == 0) then
         table%fault = "column '"//name//"' comes before the first dimension of its table"
         return
      else if (length /= row_count(table)) then
         table%fault = "column '"//name//"' has another length than its table"
         return
      end if

      ! Columns move to the larger array, their values stay where they are in memory
      if (table%column_count == size(table%columns)) then
         allocate(more(2*size(table%columns)))
         do i = 1, table%column_count
            call move_column(table%columns(i), more(i))
         end do
         call move_alloc(more, table%columns)
      end if
      table%column_count = table%column_count + 1
      call describe(table%columns(table%column_count), name, unit, long_name, kind, length)
   end subroutine take_column

   !> Add a dimension
   pure subroutine take_dimension(table, coordinate, is_index)
      !> Table to add to
      type(table_t), intent(inout) :: table
      !> Coordinates; not allocated afterwards
      type(column_t), intent(inout) :: coordinate
      !> Whether they are just numbers in a row
      logical, intent(in) :: is_index
      type(dimension_t), allocatable :: more(:)
      integer :: i

      call check_name(table, coordinate%name)
      if (allocated(table%fault)) return
      if (table%column_count > 0) then
         table%fault = "dimension '"//coordinate%name//"' comes after the first column of its table"
         return
      end if

      if (table%dimension_count == size(table%dimensions)) then
         allocate(more(2*size(table%dimensions)))
         do i = 1, table%dimension_count
            more(i)%is_index = table%dimensions(i)%is_index
            call move_column(table%dimensions(i)%coordinate, more(i)%coordinate)
         end do
         call move_alloc(more, table%dimensions)
      end if
      table%dimension_count = table%dimension_count + 1
      table%dimensions(table%dimension_count)%is_index = is_index
      call move_column(coordinate, table%dimensions(table%dimension_count)%coordinate)
   end subroutine take_dimension

   !> Keep a fault if a name is empty, not on one line or taken
   pure subroutine check_name(table, name)
      !> Table
      type(table_t), intent(inout) :: table
      !> Name of a new column or dimension
      character(len=*), intent(in) :: name
      logical :: taken
      integer :: i

      if (allocated(table%fault)) return
      if (.not. allocated(table%columns)) then
         table%fault = "'"//name//"' is added to a table that was not begun"
         return
      end if
      taken = .false.
      do i = 1, table%column_count
         taken = taken .or. table%columns(i)%name == name
      end do
      do i = 1, table%dimension_count
         taken = taken .or. table%dimensions(i)%coordinate%name == name
      end do
      if (taken) table%fault = "two columns of a table are called '"//name//"'"
      if (len_trim(name) == 0) table%fault = "a column of a table has no name"
      do i = 1, len(name)
         if (iachar(name(i:i)) < iachar(" ")) &
            & table%fault = "the name of a column of a table is not a single line of text"
      end do
   end subroutine check_name

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

end module vcor_io_table
