!> A case as namelists
module vcor_case_printed
   use vcor_kinds, only : wp
   use vcor_case_catalogue, only : catalogue, first_row, groups, integer_key, key_row, key_t, &
      last_row, list_key, logical_key, real_key, row_for_model
   use vcor_case_case, only : case_t
   use vcor_case_entries, only : address_t, entry_t
   use vcor_number, only : real_text
   use vcor_text, only : buffer_t, integer_text, quoted
   implicit none
   private

   public :: case_text, value_text

   !> Longest line of a list [bytes]
   integer, parameter :: line_width = 96
   !> Column of remarks after shorter lines
   integer, parameter :: remark_column = 48
   !> Indentation of the keys
   character(len=*), parameter :: indent = "   "
   !> Line end
   character(len=*), parameter :: newline = achar(10)

contains

   !> A case as namelists: groups in the order of the catalogue, for a material only the keys of its
   !> model
   pure function case_text(self, complete, remarks) result(text)
      type(case_t), intent(in) :: self
      !> Whether to print defaults of keys that were not given; absent: no
      logical, intent(in), optional :: complete
      !> Whether to add unit and meaning of each key as a comment; absent: no
      logical, intent(in), optional :: remarks
      !> Lines, each with a line feed
      character(len=:), allocatable :: text
      type(buffer_t) :: buffer
      type(entry_t) :: entry
      character(len=:), allocatable :: line
      logical :: all, remarked
      integer :: group, item, items, row, applicable

      all = .false.
      if (present(complete)) all = complete
      remarked = .false.
      if (present(remarks)) remarked = remarks
      do group = 1, size(groups)
         items = self%count(groups(group)%name)
         if (all .and. .not. (groups(group)%repeated .or. groups(group)%optional)) items = 1
         do item = 1, items
            if (buffer%length > 0) call buffer%add(newline)
            call buffer%add("&"//trim(groups(group)%name)//newline)
            do row = first_row(group), last_row(group)
               ! a key with a row for each model is printed once
               if (key_row(row) /= row) cycle
               applicable = row_for_model(row, self%model(group, item))
               if (applicable == 0) cycle
               entry = self%entry(address_t(group, item, row))
               if (.not. (entry%given .or. all .and. entry%present)) cycle
               line = indent//trim(catalogue(row)%name)//" = "//value_text(catalogue(row), entry)
               if (remarked) call add_remark(line, catalogue(applicable), entry)
               call buffer%add(line//newline)
            end do
            call buffer%add("/"//newline)
         end do
      end do
      text = buffer%text()
   end function case_text

   !> Append unit and meaning of a key to its value
   pure subroutine add_remark(line, key, entry)
      !> Key and value; a list may have several lines
      character(len=:), allocatable, intent(inout) :: line
      !> Row of the key for the model of its item
      type(key_t), intent(in) :: key
      type(entry_t), intent(in) :: entry
      integer :: last_line

      last_line = len(line) - index(line, newline, back=.true.)
      line = line//repeat(" ", max(0, remark_column - last_line))//" ! "
      if (key%unit /= "") line = line//"["//trim(key%unit)//"] "
      line = line//trim(key%meaning)
      if (.not. entry%given) line = line//" (default)"
   end subroutine add_remark

   !> A value in namelist format
   pure function value_text(key, entry) result(text)
      type(key_t), intent(in) :: key
      type(entry_t), intent(in) :: entry
      !> The value; a long list has several lines
      character(len=:), allocatable :: text

      select case (key%value_kind)
      case (real_key)
         text = real_text(entry%number)
      case (integer_key)
         text = integer_text(nint(entry%number))
      case (logical_key)
         text = trim(merge('.true. ', '.false.', entry%number > 0.5_wp))
      case (list_key)
         text = list_text(entry%list, len(indent) + len_trim(key%name) + len(" = "))
      case default
         text = quoted(entry%text)
      end select
   end function value_text

   !> A list of numbers separated by commas
   pure function list_text(list, column) result(text)
      !> The numbers, shape (n)
      real(wp), intent(in) :: list(:)
      !> Bytes before the first number in its line
      integer, intent(in) :: column
      !> The text; further lines are aligned with the first number
      character(len=:), allocatable :: text
      type(buffer_t) :: buffer
      character(len=:), allocatable :: number
      integer :: i, used

      used = column
      do i = 1, size(list)
         number = real_text(list(i))
         if (i < size(list)) number = number//","
         if (used + len(number) + 1 > line_width .and. i > 1) then
            call buffer%add(newline//repeat(" ", column))
            used = column
         else if (i > 1) then
            call buffer%add(" ")
            used = used + 1
         end if
         call buffer%add(number)
         used = used + len(number)
      end do
      text = buffer%text()
   end function list_text

end module vcor_case_printed
