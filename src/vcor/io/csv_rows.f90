!> Rows of a table as text with commas, by any thread
module vcor_io_csv_rows
   use, intrinsic :: iso_c_binding, only : c_carriage_return, c_new_line
   use vcor_io_column, only : column_t, integer_column, real_column, text_column
   use vcor_io_number, only : decimal_t, longest_integer, longest_real, new_decimal, put_integer, &
      & put_real
   use vcor_io_table, only : coordinate_row, table_t
   implicit none
   private

   public :: row_writer_t, new_row_writer, field

   !> What makes quotation marks necessary; `#` begins a comment for most readers
   character(len=*), parameter :: special = '",#'//c_new_line//c_carriage_return

   !> What a thread writes rows with
   type :: row_writer_t
      !> The rows
      character(len=:), allocatable :: text
      !> Last character in use
      integer :: last = 0
      !> Powers of ten for the numbers
      type(decimal_t), private :: decimal
      !> Room for a row
      integer, private :: width = 0
   contains
      !> Make text of rows
      procedure :: take
   end type row_writer_t

contains

   !> Prepare for the rows of a table
   subroutine new_row_writer(self, table)
      !> What a thread writes with
      type(row_writer_t), intent(out) :: self
      !> The table
      type(table_t), intent(in) :: table
      integer :: i

      call new_decimal(self%decimal)
      self%width = 1
      do i = 1, table%dimension_count
         self%width = self%width + widest(table%dimensions(i)%coordinate)
      end do
      do i = 1, table%column_count
         self%width = self%width + widest(table%columns(i))
      end do

   contains

      !> Most letters that a value takes, with what stands around it
      pure function widest(column) result(letters)
         !> The column
         type(column_t), intent(in) :: column
         !> Number of letters
         integer :: letters

         ! every letter may be one that is written twice
         letters = 3 + max(longest_real, longest_integer, 2*column%width)
      end function widest
   end subroutine new_row_writer

   !> Make text of rows
   subroutine take(self, first, last, table)
      !> What the thread writes with; the text is that of these rows afterwards
      class(row_writer_t), intent(inout) :: self
      !> First row
      integer, intent(in) :: first
      !> Last row
      integer, intent(in) :: last
      !> The table
      type(table_t), intent(in) :: table
      integer :: i, row
      logical :: is_first

      if (allocated(self%text)) then
         if (len(self%text) < (last - first + 1)*self%width) deallocate(self%text)
      end if
      if (.not. allocated(self%text)) &
         & allocate(character(len=(last - first + 1)*self%width) :: self%text)
      self%last = 0
      do row = first, last
         is_first = .true.
         do i = 1, table%dimension_count
            if (table%dimensions(i)%is_index) cycle
            call put_value(self, table%dimensions(i)%coordinate, coordinate_row(table, i, row), &
               & is_first)
         end do
         do i = 1, table%column_count
            call put_value(self, table%columns(i), row, is_first)
         end do
         self%last = self%last + 1
         self%text(self%last:self%last) = c_new_line
      end do
   end subroutine take

   !> Add one value
   subroutine put_value(self, column, row, is_first)
      !> What the thread writes with
      type(row_writer_t), intent(inout) :: self
      !> Column
      type(column_t), intent(in) :: column
      !> Number of the value
      integer, intent(in) :: row
      !> Whether it is the first of the line; false afterwards
      logical, intent(inout) :: is_first

      if (.not. is_first) then
         self%last = self%last + 1
         self%text(self%last:self%last) = ","
      end if
      is_first = .false.
      select case (column%kind)
      case (real_column)
         call put_real(self%decimal, column%reals(row), self%text, self%last)
      case (integer_column)
         call put_integer(column%integers(row), self%text, self%last)
      case default
         associate (from => (row - 1)*column%width + 1, to => row*column%width)
            if (needs_quotes(column%texts(from:to))) then
               ! one thread at a time: the length of what a function returns is static
!$omp critical (vcor_quotes)
               call add(field(column%texts(from:to)))
!$omp end critical (vcor_quotes)
            else
               call add(column%texts(from:from + len_trim(column%texts(from:to)) - 1))
            end if
         end associate
      end select

   contains

      !> Add text
      subroutine add(text)
         !> The text
         character(len=*), intent(in) :: text

         self%text(self%last + 1:self%last + len(text)) = text
         self%last = self%last + len(text)
      end subroutine add
   end subroutine put_value

   !> Whether a text has to stand between quotation marks
   pure function needs_quotes(text)
      !> Any text; blanks at its end do not count
      character(len=*), intent(in) :: text
      !> Whether it has to
      logical :: needs_quotes

      ! An empty field might make an empty line, which readers skip
      needs_quotes = len_trim(text) == 0
      if (.not. needs_quotes) needs_quotes = text(1:1) == " " .or. scan(text, special) > 0
   end function needs_quotes

   !> A text as a field of a row
   pure function field(text)
      !> Any text; blanks at its end do not count
      character(len=*), intent(in) :: text
      !> The text, between quotation marks if need be
      character(len=:), allocatable :: field
      integer :: i

      field = trim(text)
      if (.not. needs_quotes(text)) return

      field = '"'
      do i = 1, len_trim(text)
         field = field//text(i:i)
         if (text(i:i) == '"') field = field//'"'
      end do
      field = field//'"'
   end function field

end module vcor_io_csv_rows
