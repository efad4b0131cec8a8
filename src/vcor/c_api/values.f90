!> What the C interface takes and hands over: pointers, texts, numbers, columns and errors
module vcor_c_api_values
   use, intrinsic :: iso_c_binding, only : c_associated, c_char, c_double, c_f_pointer, c_int, &
      c_loc, c_null_char, c_ptr, c_size_t
   use vcor_error, only : error_file, error_input, error_t, error_usage, raise
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, shortened
   implicit none
   private

   public :: c_column_t, new_column, put_column, put_text, refuse_long
   public :: demand, get_array, array_at, report_error, put_error
   public :: put_pointer, put_count, put_copy, c_text, c_numbers

   !> `vcor_error`
   type, bind(c) :: c_error_t
      !> 0 or one of the `error_*` constants
      integer(c_int) :: code
      !> One line, ended by a null
      character(kind=c_char) :: message(2048)
   end type c_error_t

   !> `vcor_column`
   type, bind(c) :: c_column_t
      !> Name, or address of a swept key
      character(kind=c_char) :: name(256) = c_null_char
      !> Symbol of the paper
      character(kind=c_char) :: symbol(16) = c_null_char
      !> Unit
      character(kind=c_char) :: unit(32) = c_null_char
      !> Meaning
      character(kind=c_char) :: meaning(128) = c_null_char
      !> Words for which its numbers stand
      character(kind=c_char) :: labels(512) = c_null_char
      !> Number of the first word
      integer(c_int) :: first = 0
      !> 1 if its numbers are whole
      integer(c_int) :: is_whole = 0
   end type c_column_t

   !> Where arrays without elements are
   real(c_double), target :: nothing = 0.0_c_double

   interface
      !> Allocate memory that the caller releases with free()
      function malloc(size) bind(c, name='malloc') result(room)
         import :: c_ptr, c_size_t
         !> Bytes
         integer(c_size_t), value :: size
         type(c_ptr) :: room
      end function malloc
   end interface

contains

   !> Refuse an argument that is null
   subroutine demand(argument, name, error)
      type(c_ptr), intent(in) :: argument
      !> Its name in include/vcor.h
      character(len=*), intent(in) :: name
      !> An earlier error, which is kept, or one of code `error_usage`; unallocated on success
      type(error_t), allocatable, intent(inout) :: error

      if (c_associated(argument) .or. allocated(error)) return
      call raise(error, error_usage, 'the argument '//name//' is NULL')
   end subroutine demand

   !> Get an array of the caller
   subroutine get_array(n, place, name, array, error)
      !> Number of its elements
      integer(c_int), intent(in) :: n
      !> Its address, which may be null if it has no element
      type(c_ptr), intent(in) :: place
      !> Its name in include/vcor.h
      character(len=*), intent(in) :: name
      real(c_double), pointer, intent(out) :: array(:)
      !> An earlier error, which is kept, or one of code `error_usage`; unallocated on success
      type(error_t), allocatable, intent(inout) :: error

      nullify (array)
      if (n > 0) call demand(place, name, error)
      if (n < 0 .and. .not. allocated(error)) &
         call raise(error, error_usage, 'found a negative number of elements of '//name)
      if (.not. allocated(error)) call c_f_pointer(array_at(place, n), array, [n])
   end subroutine get_array

   !> Address of an array, or any other one for an array without elements, which may be null
   function array_at(place, n) result(address)
      type(c_ptr), intent(in) :: place
      !> Number of its elements
      integer(c_int), intent(in) :: n
      type(c_ptr) :: address

      address = place
      if (n <= 0) address = c_loc(nothing)
   end function array_at

   !> Report an error to the caller, and return its code
   function report_error(trouble, error) result(code)
      !> The error, unallocated for success
      type(error_t), allocatable, intent(in) :: trouble
      !> `vcor_error`, or null
      type(c_ptr), intent(in) :: error
      !> 0 on success, else the code of the error
      integer(c_int) :: code

      code = 0
      if (allocated(trouble)) then
         code = int(trouble%code, c_int)
         call put_error(error, code, trouble%message)
      else
         call put_error(error, code, '')
      end if
   end function report_error

   !> Report a code and a line to the caller
   subroutine put_error(error, code, message)
      !> `vcor_error`, or null
      type(c_ptr), intent(in) :: error
      integer(c_int), intent(in) :: code
      !> What is wrong, or a remark
      character(len=*), intent(in) :: message

      type(c_error_t), pointer :: to

      if (.not. c_associated(error)) return
      call c_f_pointer(error, to)
      to%code = code
      call put_text(message, to%message)
   end subroutine put_error

   !> A column with name, unit and meaning; its other components are empty
   pure function new_column(name, unit, meaning) result(column)
      character(len=*), intent(in) :: name, unit, meaning
      type(c_column_t) :: column

      call put_text(trim(name), column%name)
      call put_text(trim(unit), column%unit)
      if (unit == '') call put_text('1', column%unit)
      call put_text(trim(meaning), column%meaning)
   end function new_column

   !> Set a column of the caller, unless there is no place for it
   subroutine put_column(place, column)
      !> `vcor_column`, or null
      type(c_ptr), intent(in) :: place
      type(c_column_t), intent(in) :: column

      type(c_column_t), pointer :: to

      if (.not. c_associated(place)) return
      call c_f_pointer(place, to)
      to = column
   end subroutine put_column

   !> Refuse the name of a column that is longer than its place
   subroutine refuse_long(name, error)
      !> Address of a swept key
      character(len=*), intent(in) :: name
      !> An earlier error, which is kept, or one of code `error_input`; unallocated on success
      type(error_t), allocatable, intent(inout) :: error

      type(c_column_t) :: column

      if (len_trim(name) < size(column%name) .or. allocated(error)) return
      call raise(error, error_input, shortened(name)//': found an address of ' &
         //integer_text(len_trim(name))//' bytes, expected at most ' &
         //integer_text(size(column%name) - 1)//', with a shorter name of the material')
   end subroutine refuse_long

   !> Copy a text into a C array, cut if it does not fit
   pure subroutine put_text(text, room)
      character(len=*), intent(in) :: text
      character(kind=c_char), intent(inout) :: room(:)

      integer :: i, n

      n = min(len(text), size(room) - 1)
      do i = 1, n
         room(i) = text(i:i)
      end do
      room(n + 1) = c_null_char
   end subroutine put_text

   !> Set a pointer of the caller, unless there is no place for it
   subroutine put_pointer(place, pointer)
      !> Address of the pointer, or null
      type(c_ptr), intent(in) :: place
      type(c_ptr), intent(in) :: pointer

      type(c_ptr), pointer :: to

      if (.not. c_associated(place)) return
      call c_f_pointer(place, to)
      to = pointer
   end subroutine put_pointer

   !> Set a whole number of the caller, unless there is no place for it
   subroutine put_count(place, count)
      !> Address of the number, or null
      type(c_ptr), intent(in) :: place
      integer, intent(in) :: count

      integer(c_int), pointer :: to

      if (.not. c_associated(place)) return
      call c_f_pointer(place, to)
      to = int(count, c_int)
   end subroutine put_count

   !> Hand a copy over to the caller
   subroutine put_copy(place, copy, error)
      !> Address of the pointer of the caller
      type(c_ptr), intent(in) :: place
      !> From `c_text` or `c_numbers`
      type(c_ptr), intent(in) :: copy
      !> Error of code `error_file` if there was no memory for it; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      call put_pointer(place, copy)
      if (.not. c_associated(copy)) call raise(error, error_file, 'the memory is too small')
   end subroutine put_copy

   !> Copy of a text for C, to be released with free()
   function c_text(text) result(copy)
      character(len=*), intent(in) :: text
      !> The copy; null if there is no memory
      type(c_ptr) :: copy

      character(kind=c_char), pointer :: letters(:)

      copy = malloc(int(len(text) + 1, c_size_t))
      if (.not. c_associated(copy)) return
      call c_f_pointer(copy, letters, [len(text) + 1])
      call put_text(text, letters)
   end function c_text

   !> Copy of numbers for C, to be released with free()
   function c_numbers(numbers) result(copy)
      real(wp), intent(in) :: numbers(:)
      !> The copy; null if there is no memory
      type(c_ptr) :: copy

      real(c_double), pointer :: room(:)

      copy = malloc(int(max(1, size(numbers)), c_size_t)*storage_size(numbers)/8)
      if (.not. c_associated(copy)) return
      call c_f_pointer(copy, room, [size(numbers)])
      room = numbers
   end function c_numbers

end module vcor_c_api_values
