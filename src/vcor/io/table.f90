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
!> Building a table cannot fail at the caller's hand: the first fault (lengths that do not match, a
!> name twice) is kept, and `check_table`, which every writer calls, makes an error of it. All
!> components are public for the writers and for reading; they are set by the procedures below and
!> those of `vcor_io_table_columns` only.
module vcor_io_table
   use vcor_error, only : error_internal, error_t, raise
   use vcor_io_column, only : column_t, describe, move_column
   use vcor_kinds, only : wp
   implicit none
   private

   public :: table_t, dimension_t, fact_t
   public :: new_table, add_fact, check_table, row_count, coordinate_row
   public :: take_column, take_dimension

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

end module vcor_io_table
