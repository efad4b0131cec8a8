!> Tables of results: named columns over one or more named dimensions
!>
!>     call new_table(summary, 'summary', title, case_text)
!>     call add_dimension(summary, 'impact', rows)
!>     call add_column(summary, column_of('cor', cor, '1', 'coefficient of restitution'))
!>
!> All dimensions are added before the first column. The last dimension varies fastest along a
!> column, as in nested loops; the length of a column is the product of their lengths.
!>
!> The unit is `1` for dimensionless numbers, such as ratios and counts, empty for text, and
!> otherwise the SI unit, as in `m/s` and `N s`.
!>
!> All components are public for the writers; only the procedures below set them.
module vcor_io_table
   use vcor_kinds, only : wp
   use vcor_version, only : version
   implicit none
   private

   public :: table_t, column_t, real_column, integer_column, text_column
   public :: new_table, add_dimension, add_column, column_of
   public :: row_count, coordinate_row, place_in_table, text_value

   !> Kinds of values of a column
   integer, parameter :: real_column = 1, integer_column = 2, text_column = 3

   !> Named values of one kind: a column, the coordinates of a dimension, or one number of a whole
   !> table. A column without values, but with a length, gets its values later
   type :: column_t
      !> One line
      character(len=:), allocatable :: name
      !> `1` if dimensionless, empty for text
      character(len=:), allocatable :: unit
      !> Meaning, one line
      character(len=:), allocatable :: long_name
      !> `real_column`, `integer_column` or `text_column`
      integer :: kind = real_column
      !> Numbers, allocated in a real column only, shape (length)
      real(wp), allocatable :: reals(:)
      !> Whole numbers, or for each row the index of its text, from 1, shape (length)
      integer, allocatable :: integers(:)
      !> The different texts one after the other, each `width` characters, padded with blanks
      character(len=:), allocatable :: texts
      !> Characters per text
      integer :: width = 0
      !> Number of values
      integer :: length = 0
      !> Whether they are the coordinates 1, 2, 3 ..., which have no meaning of their own
      logical :: is_index = .false.
   end type column_t

   !> A table
   type :: table_t
      !> Name of its group in an HDF5 file
      character(len=:), allocatable :: name
      !> Version of the program that made it
      character(len=:), allocatable :: version
      character(len=:), allocatable :: title
      !> Full case, any number of lines
      character(len=:), allocatable :: case_text
      !> Coordinates of the dimensions, the slowest first
      type(column_t), allocatable :: dimensions(:)
      !> Columns
      type(column_t), allocatable :: columns(:)
      !> Numbers of the whole table
      type(column_t), allocatable :: facts(:)
   end type table_t

   !> A column: its name, values, unit and meaning
   interface column_of
      module procedure column_of_reals
      module procedure column_of_integers
      module procedure column_of_texts
   end interface column_of

   !> Add a dimension: its coordinates, or its name and length
   interface add_dimension
      module procedure add_coordinates
      module procedure add_index_dimension
   end interface add_dimension

contains

   !> Begin a table
   pure subroutine new_table(table, name, title, case_text)
      !> Table without dimensions and columns
      type(table_t), intent(out) :: table
      !> Name of its group in an HDF5 file
      character(len=*), intent(in) :: name
      character(len=*), intent(in) :: title
      !> Full case, any number of lines
      character(len=*), intent(in) :: case_text

      table%name = name
      table%version = version
      table%title = trim(title)
      table%case_text = case_text
      allocate (table%dimensions(0), table%columns(0), table%facts(0))
   end subroutine new_table

   !> Number of rows: the product of the lengths of the dimensions
   pure function row_count(table) result(rows)
      !> Table with at least one dimension
      type(table_t), intent(in) :: table
      integer :: rows

      rows = product(table%dimensions%length)
   end function row_count

   !> Index of the coordinate of a row in a dimension
   pure function coordinate_row(table, number, row) result(place)
      type(table_t), intent(in) :: table
      integer, intent(in) :: number
      integer, intent(in) :: row
      !> Index of the coordinate, from 1
      integer :: place

      place = mod((row - 1)/product(table%dimensions(number + 1:)%length), &
         table%dimensions(number)%length) + 1
   end function coordinate_row

   !> Place of a dimension or a column
   pure function place_in_table(table, name) result(place)
      type(table_t), intent(in) :: table
      character(len=*), intent(in) :: name
      !> Index of the dimension, or of the column plus the number of dimensions; 0 if there is
      !> neither
      integer :: place

      do place = 1, size(table%dimensions)
         if (table%dimensions(place)%name == name) return
      end do
      do place = size(table%dimensions) + 1, size(table%dimensions) + size(table%columns)
         if (table%columns(place - size(table%dimensions))%name == name) return
      end do
      place = 0
   end function place_in_table

   !> Value of a text column
   pure function text_value(column, row) result(text)
      !> Text column
      type(column_t), intent(in) :: column
      integer, intent(in) :: row
      !> The value, without trailing blanks
      character(len=:), allocatable :: text

      associate (last => column%integers(row)*column%width)
         text = trim(column%texts(last - column%width + 1:last))
      end associate
   end function text_value

   !> A column of real numbers
   pure function column_of_reals(name, values, unit, long_name) result(column)
      !> Name, unit and meaning
      character(len=*), intent(in) :: name, unit, long_name
      !> Values, shape (length); NaN and infinity are allowed
      real(wp), intent(in) :: values(:)
      type(column_t) :: column

      call describe(column, name, unit, long_name)
      column%kind = real_column
      column%reals = values
      column%length = size(values)
   end function column_of_reals

   !> A column of whole numbers
   pure function column_of_integers(name, values, unit, long_name) result(column)
      !> Name, unit and meaning
      character(len=*), intent(in) :: name, unit, long_name
      !> Values, shape (length)
      integer, intent(in) :: values(:)
      type(column_t) :: column

      call describe(column, name, unit, long_name)
      column%kind = integer_column
      column%integers = values
      column%length = size(values)
   end function column_of_integers

   !> A column of text
   pure function column_of_texts(name, values, unit, long_name) result(column)
      !> Name, unit (empty) and meaning
      character(len=*), intent(in) :: name, unit, long_name
      !> Values, shape (length); trailing blanks are ignored
      character(len=*), intent(in) :: values(:)
      type(column_t) :: column

      integer :: i

      call describe(column, name, unit, long_name)
      column%kind = text_column
      column%integers = [(i, i=1, size(values))]
      column%length = size(values)
      if (size(values) > 0) column%width = maxval(len_trim(values))
      allocate (character(len=column%width*size(values)) :: column%texts)
      do i = 1, size(values)
         column%texts((i - 1)*column%width + 1:i*column%width) = values(i)
      end do
   end function column_of_texts

   !> Set name, unit and meaning of a column
   pure subroutine describe(column, name, unit, long_name)
      type(column_t), intent(inout) :: column
      !> Name, unit and meaning
      character(len=*), intent(in) :: name, unit, long_name

      column%name = trim(name)
      column%unit = trim(unit)
      column%long_name = trim(long_name)
   end subroutine describe

   !> Add a dimension with the coordinates 1, 2, 3 ...
   pure subroutine add_index_dimension(table, name, length)
      type(table_t), intent(inout) :: table
      character(len=*), intent(in) :: name
      !> Length, >= 0
      integer, intent(in) :: length

      type(column_t) :: coordinates
      integer :: i

      coordinates = column_of(name, [(i, i=1, length)], '1', 'number of the '//name)
      coordinates%is_index = .true.
      call add_coordinates(table, coordinates)
   end subroutine add_index_dimension

   !> Add a dimension with coordinates
   pure subroutine add_coordinates(table, coordinates)
      type(table_t), intent(inout) :: table
      type(column_t), intent(in) :: coordinates

      table%dimensions = [table%dimensions, coordinates]
   end subroutine add_coordinates

   !> Add a column, copied; large columns are added empty, and their values moved in afterwards
   pure subroutine add_column(table, column)
      type(table_t), intent(inout) :: table
      type(column_t), intent(in) :: column

      table%columns = [table%columns, column]
   end subroutine add_column

end module vcor_io_table
