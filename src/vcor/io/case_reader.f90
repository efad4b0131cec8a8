!> Reads case files and command line options into a case
!>
!> Reading, overriding and validating are separate steps, so an option can correct an error in the
!> file.
module vcor_io_case_reader
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_case_namelist, only : namelist_t, new_namelist, statement_t
   use vcor_io_file, only : read_text_file
   use vcor_io_data_file, only : data_folder, file_keys
   use vcor_io_path, only : path_from
   use vcor_case_values, only : convert, convert_text, range_message
   use vcor_case_address, only : resolve, unknown_group, unknown_key
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, find_group, groups, key_t, list_key, real_key
   use vcor_case_entries, only : address_t, entry_t
   use vcor_text, only : has_control, integer_text, printable, shortened
   implicit none
   private

   public :: read_case, read_case_text, add_materials, override, set_value

   !> Largest number of items of a repeated group
   integer, parameter :: most_items = 1000

contains

   !> Read a case file, without validation
   subroutine read_case(case, filename, error)
      !> The case; its earlier contents are lost
      type(case_t), intent(inout) :: case
      character(len=*), intent(in) :: filename
      !> Error of code `error_file` if the file cannot be read, `error_input` if its contents are
      !> wrong
      type(error_t), allocatable, intent(out) :: error
      character(len=:), allocatable :: text

      call case%start(filename)
      call read_text_file(filename, text, error)
      if (allocated(error)) return
      call read_case_text(case, text, filename, error)
   end subroutine read_case

   !> Read the text of a case, without validation
   subroutine read_case_text(case, text, source, error)
      !> The case; its earlier contents are lost
      type(case_t), intent(inout) :: case
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
            //": the file is empty, expected groups such as &impact velocity = 5.0 /")
   end subroutine read_case_text

   !> Add the materials of another file to a case, or put its only one in the place of one of the
   !> case; their data files are relative to its folder
   subroutine add_materials(case, materials, place)
      type(case_t), intent(inout) :: case
      !> A case with materials only
      type(case_t), intent(in) :: materials
      !> Index of the material that is replaced; absent: none
      integer, intent(in), optional :: place

      type(address_t) :: address
      character(len=:), allocatable :: file
      integer :: i, item, own

      do item = 1, materials%count('material')
         call case%adopt(materials, item, place)
         own = case%count('material')
         if (present(place)) own = place
         do i = 1, size(file_keys)
            address = case%address('material', trim(file_keys(i)), own)
            call case%get('material', trim(file_keys(i)), file, own)
            if (file /= '') call case%set(address, path_from(data_folder(case), &
               data_folder(materials), file), given=.true.)
         end do
      end do
   end subroutine add_materials

   !> Read one group
   subroutine read_group(case, namelist, name, line, error)
      type(case_t), intent(inout) :: case
      !> The namelists, after the name of the group
      type(namelist_t), intent(inout) :: namelist
      character(len=*), intent(in) :: name
      integer, intent(in) :: line
      type(error_t), allocatable, intent(out) :: error
      type(statement_t) :: statement
      character(len=:), allocatable :: message
      integer :: group, item
      logical :: found

      group = find_group(name)
      if (group == 0) then
         message = unknown_group(name)
      else if (groups(group)%repeated) then
         if (case%count(name) >= most_items) message = "found more than " &
               //integer_text(most_items)//" &"//trim(groups(group)%name)//" groups"
      else if (case%count(name) > 0) then
         message = "group &"//trim(groups(group)%name)//" is there twice, the first in line " &
               //integer_text(case%line(group, 1))
      end if
      if (allocated(message)) then
         call raise(error, error_input, namelist%place(line)//": "//message)
         return
      end if

      call case%add(group, line, item)
      do
         call namelist%next_statement(name, statement, found, error)
         if (allocated(error)) return
         if (.not. found) exit
         call read_statement(case, namelist, statement, group, item, message)
         if (allocated(message)) then
            call raise(error, error_input, namelist%place(statement%line)//": "//message)
            return
         end if
      end do
   end subroutine read_group

   !> Read one statement
   subroutine read_statement(case, namelist, statement, group, item, message)
      type(case_t), intent(inout) :: case
      !> Namelists of the statement
      type(namelist_t), intent(in) :: namelist
      type(statement_t), intent(in) :: statement
      integer, intent(in) :: group
      integer, intent(in) :: item
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message
      type(entry_t) :: entry, before
      type(address_t) :: address

      address = case%address(groups(group)%name, statement%key, item)
      if (address%group == 0) then
         message = unknown_key(statement%key, group)
         return
      end if
      associate (key => catalogue(address%row))
         before = case%entry(address)
         if (before%given) then
            message = 'the key is given twice, first in line '//integer_text(before%line)
         else if (allocated(statement%section) .and. key%value_kind /= list_key) then
            message = 'found ('//shortened(statement%section) &
               //'), but it is a single value, not a list'
         else
            call convert(key, namelist%text, statement%values, entry, message)
            if (allocated(statement%section) .and. .not. allocated(message)) then
               if (.not. is_whole(statement%section, size(entry%list))) message = 'found (' &
                  //shortened(statement%section)//'), expected the whole list, such as ' &
                  //trim(key%name)//' = 1.0, 2.0'
            end if
            entry%line = statement%line
            if (.not. allocated(message)) call case%set(address, entry)
         end if
         if (allocated(message)) message = trim(key%name)//': '//message
      end associate
   end subroutine read_statement

   !> Whether a section is that of a whole list; f90nml has an option to write such sections
   pure function is_whole(section, n) result(yes)
      !> Text in the parentheses
      character(len=*), intent(in) :: section
      !> Length of the list
      integer, intent(in) :: n
      logical :: yes

      yes = any(section == [character(len=16) :: ':', '1:', ':'//integer_text(n), &
         '1:'//integer_text(n)]) .or. (section == '1' .and. n == 1)
   end function is_whole

   !> Set a value by `path=value`, as for the option --set
   subroutine override(case, setting, error, option)
      type(case_t), intent(inout) :: case
      !> `group.key=value` or `material_name.key=value`; a text needs no quotes
      character(len=*), intent(in) :: setting
      !> Error of code `error_usage` if path or value cannot be read, `error_input` if the value is
      !> out of range; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Beginning of messages about the value, before its address; absent: none
      character(len=*), intent(in), optional :: option

      character(len=:), allocatable :: by
      integer :: mark

      by = ""
      if (present(option)) by = option//" "
      mark = end_of_path(setting)
      if (has_control(setting)) then
         call raise(error, error_usage, by//shortened(setting)//": found a control character")
      else if (mark < 2) then
         call raise(error, error_usage, by//shortened(setting)//": expected group.key=value")
      else
         call set_value(case, setting(:mark-1), setting(mark+1:), error, option)
      end if
   end subroutine override

   !> Set the value at a path
   subroutine set_value(case, address_text, value, error, option)
      type(case_t), intent(inout) :: case
      !> `group.key` or `material_name.key`
      character(len=*), intent(in) :: address_text
      !> As a namelist has it; a text needs no quotes
      character(len=*), intent(in) :: value
      !> As of `override`
      type(error_t), allocatable, intent(out) :: error
      !> Beginning of messages about the value, before its address; absent: none
      character(len=*), intent(in), optional :: option

      type(entry_t) :: entry
      character(len=:), allocatable :: message, path, by
      type(address_t) :: address
      type(key_t) :: key
      integer :: row

      by = ""
      if (present(option)) by = option//" "
      path = trim(adjustl(address_text))
      entry%origin = by//shortened(path)
      if (has_control(path//value)) then
         call raise(error, error_usage, entry%origin//": found a control character")
         return
      end if
      call resolve(case, path, address, message)
      if (allocated(message)) then
         call raise(error, error_usage, entry%origin//": "//message)
         return
      end if
      row = case%row(address)
      if (row == 0) row = address%row
      key = catalogue(row)
      if (address%element > 0) key%value_kind = real_key
      if (len_trim(value) == 0) then
         message = "there is no value after the equals sign"
      else
         call convert_text(key, trim(adjustl(value)), entry, message)
      end if
      if (allocated(message)) then
         call raise(error, error_usage, entry%origin//": "//message)
         return
      end if
      message = range_message(key, entry)
      if (message /= "") then
         call raise(error, error_input, entry%origin//": "//message)
         return
      end if
      ! the check refuses two options for one quantity; of two calls by a program the last one
      ! counts
      call case%drop_alternative(address, always=.not. present(option))
      call case%set(address, entry)
   end subroutine set_value

   !> Position of the equals sign between path and value; a quoted name may contain one, too
   pure function end_of_path(setting) result(mark)
      character(len=*), intent(in) :: setting
      !> Position, 0 if there is none
      integer :: mark
      integer :: start

      start = 1
      if (scan(setting, "'""") == 1) start = index(setting(2:), setting(1:1)) + 2
      mark = index(setting(start:), "=")
      if (mark > 0) mark = mark + start - 1
   end function end_of_path

end module vcor_io_case_reader
