!> Rows of a table as lines on the standard output, for scripts: bare values with blanks between
!> them
module vcor_io_row_text
   use vcor_error, only : error_t
   use vcor_io_column, only : column_t, integer_column, real_column, text_value
   use vcor_io_file, only : write_stdout
   use vcor_io_number, only : decimal_t, longest_integer, longest_real, new_decimal, put_integer, &
      put_real
   use vcor_io_table, only : coordinate_row, row_count, table_t
   implicit none
   private

   public :: write_rows, place_in_table

   !> Characters that are collected before they are written
   integer, parameter :: buffer_length = 65536

contains

   !> Place of a dimension or a column
   pure function place_in_table(table, name) result(place)
      !> The table
      type(table_t), intent(in) :: table
      !> Name
      character(len=*), intent(in) :: name
      !> Number of the dimension, or of the column after all dimensions; 0 if there is neither
      integer :: place

      do place = 1, table%dimension_count
         if (table%dimensions(place)%coordinate%name == name) return
      end do
      do place = table%dimension_count + 1, table%dimension_count + table%column_count
         if (table%columns(place - table%dimension_count)%name == name) return
      end do
      place = 0
   end function place_in_table

   !> Write some dimensions and columns of all rows
   subroutine write_rows(table, places, error)
      !> The table
      type(table_t), intent(in) :: table
      !> Places of dimensions and columns, in their order, shape (n)
      integer, intent(in) :: places(:)
      !> Set if they could not be written
      type(error_t), allocatable, intent(out) :: error

      type(decimal_t), allocatable :: decimal
      character(len=:), allocatable :: buffer
      integer :: row, i, last

      allocate (decimal)
      call new_decimal(decimal)
      allocate (character(len=buffer_length) :: buffer)
      last = 0
      do row = 1, row_count(table)
         do i = 1, size(places)
            if (i > 1) call put_text(' ')
            associate (of_column => places(i) - table%dimension_count)
               if (of_column > 0) then
                  call put_value(table%columns(of_column), row)
               else
                  call put_value(table%dimensions(places(i))%coordinate, &
                     coordinate_row(table, places(i), row))
               end if
            end associate
            if (allocated(error)) return
         end do
         call put_text(new_line('a'))
      end do
      call write_stdout(buffer(:last), error)

   contains

      !> One value
      subroutine put_value(column, number)
         !> Column
         type(column_t), intent(in) :: column
         !> Number of the value in it
         integer, intent(in) :: number

         ! room for any number, and what stands around it
         if (last > buffer_length - max(longest_real, longest_integer, column%width) - 2) then
            call write_stdout(buffer(:last), error)
            last = 0
            if (allocated(error)) return
         end if
         select case (column%kind)
         case (real_column)
            call put_real(decimal, column%reals(number), buffer, last)
         case (integer_column)
            call put_integer(column%integers(number), buffer, last)
         case default
            call put_text(text_value(column, number))
         end select
      end subroutine put_value

      !> A short text
      subroutine put_text(text)
         !> The text
         character(len=*), intent(in) :: text

         buffer(last + 1:last + len(text)) = text
         last = last + len(text)
      end subroutine put_text
   end subroutine write_rows

end module vcor_io_row_text
