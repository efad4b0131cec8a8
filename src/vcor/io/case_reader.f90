!> Case files and command line options into a case
!>
!> Reading, overriding and validating are steps of their own: an option can mend what the file has
!> wrong.
module vcor_io_case_reader
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_case_list_filling, only : filling_t
   use vcor_case_namelist, only : namelist_t, new_namelist, statement_t
   use vcor_io_text_file, only : read_text_file
   use vcor_case_values, only : convert, convert_text
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group, find_key, groups, list_key, row_for_model
   use vcor_case_path, only : unknown_group, unknown_key
   use vcor_case_store, only : entry_t, range_message
   use vcor_text, only : has_control, integer_text, printable, shortened
   implicit none
   private

   public :: read_case, read_case_text, override

   !> Most items of a repeated group
   integer, parameter :: most_items = 1000

contains

   !> Read a case file; what it says is not validated
   subroutine read_case(case, filename, error)
      !> The case, which starts anew
      type(case_t), intent(inout) :: case
      !> Name of the file
      character(len=*), intent(in) :: filename
      !> Error of code `error_file` when the file cannot be read, `error_input` when its contents
      !> are wrong
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: text

      call case%start(filename)
      call read_text_file(filename, text, error)
      if (allocated(error)) return
      call read_case_text(case, text, filename, error)
   end subroutine read_case

   !> Read the text of a case; what it says is not validated
   subroutine read_case_text(case, text, source, error)
      !> The case, which starts anew
      type(case_t), intent(inout) :: case
      !> The text
      character(len=*), intent(in) :: text
      !> Name of its source, for messages and for the default of `output.stem`
      character(len=*), intent(in) :: source
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(namelist_t) :: namelist
      character(len=:), allocatable :: name
      integer :: line
      logical :: empty

      call case%start(source)
      call new_namelist(namelist, text, source)
      empty = .true.
      do
         call namelist%next_group(name, line, error)
         if (allocated(error)) return
         if (.not. allocated(name)) exit
         call read_group(case, namelist, name, line, error)
         if (allocated(error)) return
         empty = .false.
      end do
      if (empty) call raise(error, error_input, printable(source) &
         & //": the file is empty, expected groups such as &impact velocity = 5.0 /")
   end subroutine read_case_text

   !> Read one group
   subroutine read_group(case, namelist, name, line, error)
      !> The case
      type(case_t), intent(inout) :: case
      !> The namelists, after the name of the group
      type(namelist_t), intent(inout) :: namelist
      !> Name of the group as it is written
      character(len=*), intent(in) :: name
      !> Line of it
      integer, intent(in) :: line
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(statement_t) :: statement
      type(filling_t) :: filling
      character(len=:), allocatable :: message
      integer :: group, item
      logical :: found

      group = find_group(name)
      if (group == 0) then
         message = unknown_group(name)
      else if (groups(group)%repeated) then
         if (case%count(name) >= most_items) message = "found more than " &
            & //integer_text(most_items)//" &"//trim(groups(group)%name)//" groups"
      else if (case%count(name) > 0) then
         message = "group &"//trim(groups(group)%name)//" is there twice, the first in line " &
            & //integer_text(case%line(group, 1))
      end if
      if (allocated(message)) then
         call raise(error, error_input, namelist%place(line)//": "//message)
         return
      end if

      call case%add(group, line, item)
      call filling%clear()
      do
         call namelist%next_statement(name, statement, found, error)
         if (allocated(error)) return
         if (.not. found) exit
         call read_statement(case, namelist, statement, group, item, filling, message)
         if (allocated(message)) then
            call raise(error, error_input, namelist%place(statement%line)//": "//message)
            return
         end if
      end do
      call finish_lists(case, filling, error)
   end subroutine read_group

   !> Read one statement
   subroutine read_statement(case, namelist, statement, group, item, filling, message)
      !> The case
      type(case_t), intent(inout) :: case
      !> The namelists the statement is from
      type(namelist_t), intent(in) :: namelist
      !> The statement
      type(statement_t), intent(in) :: statement
      !> Index of its group
      integer, intent(in) :: group
      !> Number of the item
      integer, intent(in) :: item
      !> Lists that are given in parts
      type(filling_t), intent(inout) :: filling
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      type(entry_t) :: entry
      integer :: row, handle

      row = find_key(groups(group)%name, statement%key)
      if (row == 0) then
         message = unknown_key(statement%key, group)
         return
      end if
      handle = case%handle(groups(group)%name, statement%key, item)
      associate (key => catalogue(row))
         if (allocated(statement%section)) then
            if (key%value_kind /= list_key) then
               message = "found ("//shortened(statement%section) &
                  & //"), but it is a single value, not a list"
            else if (case%is_given(handle)) then
               message = twice(case, handle)
            else
               call convert(key, namelist%text, statement%values, entry, message)
               if (.not. allocated(message)) call filling%put(handle, statement%section, &
                  & entry%list, statement%line, message)
            end if
         else if (case%is_given(handle) .or. filling%has(handle)) then
            message = twice(case, handle)
         else
            call convert(key, namelist%text, statement%values, entry, message)
            entry%line = statement%line
            if (.not. allocated(message)) call case%assign(handle, entry)
         end if
         if (allocated(message)) message = trim(key%name)//": "//message
      end associate
   end subroutine read_statement

   !> What to say about a key that is given twice
   pure function twice(case, handle) result(message)
      !> The case
      type(case_t), intent(in) :: case
      !> Handle of the key
      integer, intent(in) :: handle
      !> The message
      character(len=:), allocatable :: message
      type(entry_t) :: entry

      entry = case%entry(handle)
      message = "the key is given twice"
      if (entry%line > 0) message = message//", first in line "//integer_text(entry%line)
   end function twice

   !> Set the lists of a group that were given in parts
   subroutine finish_lists(case, filling, error)
      !> The case
      type(case_t), intent(inout) :: case
      !> The parts
      type(filling_t), intent(in) :: filling
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(entry_t) :: entry
      character(len=:), allocatable :: message
      integer :: i, handle

      do i = 1, filling%n
         call filling%finish(i, handle, entry%list, entry%line, message)
         if (allocated(message)) then
            call raise(error, error_input, printable(case%source)//":"//integer_text(entry%line) &
               & //": "//case%path(handle)//": "//message)
            return
         end if
         entry%given = .true.
         entry%present = .true.
         call case%assign(handle, entry)
      end do
   end subroutine finish_lists

   !> Set one value by `path=value`, as the option --set has it
   subroutine override(case, setting, error)
      !> The case
      type(case_t), intent(inout) :: case
      !> `group.key=value` or `material_name.key=value`; a text may stand without quotes
      character(len=*), intent(in) :: setting
      !> Error of code `error_usage` when path or value cannot be read, `error_input` when the
      !> value is out of range; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(entry_t) :: entry
      character(len=:), allocatable :: message, path
      integer :: mark, handle, group, row, item, applicable

      if (has_control(setting)) then
         call raise(error, error_usage, "--set "//shortened(setting)//": found a control character")
         return
      end if
      mark = end_of_path(setting)
      if (mark < 2) then
         call raise(error, error_usage, "--set "//shortened(setting)//": expected group.key=value")
         return
      end if
      path = trim(adjustl(setting(:mark-1)))
      entry%origin = "--set "//shortened(path)
      call case%resolve(path, handle, message)
      if (allocated(message)) then
         call raise(error, error_usage, entry%origin//": "//message)
         return
      end if
      call case%locate(handle, group, row, item)
      applicable = row_for_model(row, case%model(group, item))
      if (applicable == 0) applicable = row
      if (len_trim(setting(mark+1:)) == 0) then
         message = "there is no value after the equals sign"
      else
         call convert_text(catalogue(applicable), trim(adjustl(setting(mark+1:))), entry, message)
      end if
      if (allocated(message)) then
         call raise(error, error_usage, entry%origin//": "//message)
         return
      end if
      message = range_message(catalogue(applicable), entry)
      if (message /= "") then
         call raise(error, error_input, entry%origin//": "//message)
         return
      end if
      call case%assign(handle, entry)
   end subroutine override

   !> Position of the equals sign between path and value; a name in quotes may have one, too
   pure function end_of_path(setting) result(mark)
      !> The setting
      character(len=*), intent(in) :: setting
      !> Position, 0 when there is none
      integer :: mark
      integer :: start

      start = 1
      if (scan(setting, "'""") == 1) start = index(setting(2:), setting(1:1)) + 2
      mark = index(setting(start:), "=")
      if (mark > 0) mark = mark + start - 1
   end function end_of_path

end module vcor_io_case_reader
