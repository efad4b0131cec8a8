!> A case as bytes from which it is made again, with all that was set
!>
!>     vcor VERSION CHECK
!>     FIELD ...
!>
!> CHECK is the check sum of all that follows. A field is `LENGTH:BYTES` and a line feed: name of
!> the case, folder where the process was when it was read, number of data files, path and check sum
!> of each, text of the case, and where its groups and values come from, in the order of the text.
module vcor_io_dump
   use, intrinsic :: iso_fortran_env, only : int32
   use vcor_case_case, only : case_t
   use vcor_case_catalogue, only : catalogue, first_row, groups, key_row, last_row
   use vcor_case_entries, only : address_t, entry_t
   use vcor_case_printed, only : value_text
   use vcor_error, only : error_input, error_t, raise
   use vcor_io_case_reader, only : read_case_text
   use vcor_io_crc, only : crc32
   use vcor_io_data_file, only : data_file, file_keys, modes_file
   use vcor_io_file, only : read_text_file
   use vcor_io_path, only : folder_of, join_path
   use vcor_text, only : buffer_t, integer_text, printable, shortened
   use vcor_version, only : version
   implicit none
   private

   public :: dump_case, load_case

   character(len=*), parameter :: newline = achar(10), magic = 'vcor '
   !> Sum of a file that cannot be read
   character(len=*), parameter :: no_file = 'none'

   !> Fields that are taken one after the other
   type :: fields_t
      !> All of them
      character(len=:), allocatable :: text
      !> First byte of the next one
      integer :: next = 1
      !> Whether a field was not there
      logical :: are_short = .false.
   contains
      procedure :: take, take_number
   end type fields_t

contains

   !> Make a dump
   function dump_case(case, place) result(dump)
      type(case_t), intent(in) :: case
      !> Folder where the process was when the case was read
      character(len=*), intent(in) :: place
      !> The bytes
      character(len=:), allocatable :: dump

      type(buffer_t) :: buffer
      type(entry_t) :: entry
      character(len=:), allocatable :: path, fields
      integer :: group, i, item, row, n

      call put(buffer, case%source)
      call put(buffer, place)
      n = 0
      do item = 1, case%count('material')
         do i = 1, size(file_keys)
            if (data_file(case, item, trim(file_keys(i))) /= '') n = n + 1
         end do
      end do
      if (modes_file(case) /= '') n = n + 1
      call put(buffer, integer_text(n))
      do item = 1, case%count('material')
         do i = 1, size(file_keys)
            path = data_file(case, item, trim(file_keys(i)))
            if (path == '') cycle
            call case%get('material', trim(file_keys(i)), fields, item)
            call put(buffer, fields)
            call put(buffer, sum_of(path))
         end do
      end do
      path = modes_file(case)
      if (path /= '') then
         call case%get('target', 'file', fields)
         call put(buffer, fields)
         call put(buffer, sum_of(path))
      end if
      call put(buffer, given_text(case))
      do group = 1, size(groups)
         do item = 1, case%count(groups(group)%name)
            call put(buffer, integer_text(case%line(group, item)))
            path = case%source
            if (groups(group)%name == 'material') path = case%source_of(item)
            call put(buffer, path)
            do row = first_row(group), last_row(group)
               entry = case%entry(address_t(group, item, row))
               if (key_row(row) /= row .or. .not. entry%given) cycle
               call put(buffer, integer_text(entry%line))
               if (.not. allocated(entry%origin)) entry%origin = ''
               call put(buffer, entry%origin)
            end do
         end do
      end do
      fields = buffer%text()
      dump = magic//version//' '//hexadecimal(crc32(fields, 0_int32))//newline//fields
   end function dump_case

   !> Make a case from a dump
   subroutine load_case(dump, case, place, error)
      character(len=*), intent(in) :: dump
      !> The case; its earlier contents are lost
      type(case_t), intent(inout) :: case
      !> Folder where the process was when the case was read
      character(len=:), allocatable, intent(out) :: place
      !> Error of code `error_input` if the dump is damaged or of another version, or a data file is
      !> another one, `error_file` if one cannot be read; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(fields_t) :: fields
      type(entry_t) :: entry
      character(len=*), parameter :: damaged = 'the dump of a case is damaged, expected it as ' &
         //'vcor_dump made it'
      character(len=:), allocatable :: bytes, head, path, source, text, was
      integer :: group, item, line, mark, row

      mark = index(dump, newline)
      head = dump(:max(mark - 1, 0))
      mark = index(head, ' ', back=.true.)
      if (index(head, magic) /= 1 .or. mark <= len(magic)) then
         call raise(error, error_input, "found '"//shortened(head) &
            //"', expected a dump of a case, as vcor_dump makes it")
      else if (head(len(magic) + 1:mark - 1) /= version) then
         call raise(error, error_input, 'found a dump of a case by vcor ' &
            //shortened(head(len(magic) + 1:mark - 1))//', expected one by vcor '//version)
      else
         fields%text = dump(len(head) + 2:)
         if (head(mark + 1:) /= hexadecimal(crc32(fields%text, 0_int32))) call raise(error, &
            error_input, damaged)
      end if
      if (allocated(error)) return

      source = fields%take()
      place = fields%take()
      do item = 1, fields%take_number()
         path = join_path(join_path(place, folder_of(source)), fields%take())
         was = fields%take()
         if (fields%are_short) exit
         if (was == sum_of(path)) cycle
         call read_text_file(path, bytes, error)
         if (.not. allocated(error)) call raise(error, error_input, printable(path)//': it is ' &
            //'not the file that it was when the case was dumped, expected the same one')
         return
      end do
      text = fields%take()
      if (.not. fields%are_short) call read_case_text(case, text, source, error)
      if (fields%are_short) call raise(error, error_input, damaged)
      if (allocated(error)) return
      do group = 1, size(groups)
         do item = 1, case%count(groups(group)%name)
            line = fields%take_number()
            call case%trace_item(group, item, line, fields%take())
            do row = first_row(group), last_row(group)
               entry = case%entry(address_t(group, item, row))
               if (key_row(row) /= row .or. .not. entry%given) cycle
               line = fields%take_number()
               call case%trace(address_t(group, item, row), line, fields%take())
            end do
         end do
      end do
      if (fields%are_short .or. fields%next <= len(fields%text)) &
         call raise(error, error_input, damaged)
   end subroutine load_case

   !> All that is given, also keys that do not belong to the model
   function given_text(case) result(text)
      type(case_t), intent(in) :: case
      !> Namelists in the order of the catalogue
      character(len=:), allocatable :: text

      type(buffer_t) :: buffer
      type(entry_t) :: entry
      integer :: group, item, row

      do group = 1, size(groups)
         do item = 1, case%count(groups(group)%name)
            call buffer%add('&'//trim(groups(group)%name)//newline)
            do row = first_row(group), last_row(group)
               entry = case%entry(address_t(group, item, row))
               if (key_row(row) /= row .or. .not. entry%given) cycle
               call buffer%add(trim(catalogue(row)%name)//' = ' &
                  //value_text(catalogue(row), entry)//newline)
            end do
            call buffer%add('/'//newline)
         end do
      end do
      text = buffer%text()
   end function given_text

   !> Check sum of a file
   function sum_of(path) result(text)
      character(len=*), intent(in) :: path
      !> Eight hexadecimal digits and the size; `none` if it cannot be read
      character(len=:), allocatable :: text

      type(error_t), allocatable :: error
      character(len=:), allocatable :: bytes

      call read_text_file(path, bytes, error)
      text = no_file
      if (.not. allocated(error)) &
         text = hexadecimal(crc32(bytes, 0_int32))//' '//integer_text(len(bytes))
   end function sum_of

   !> A check sum in words
   pure function hexadecimal(number) result(text)
      integer(int32), intent(in) :: number
      character(len=8) :: text

      write (text, '(z8.8)') number
   end function hexadecimal

   !> Add a field
   pure subroutine put(buffer, field)
      type(buffer_t), intent(inout) :: buffer
      character(len=*), intent(in) :: field

      call buffer%add(integer_text(len(field))//':'//field//newline)
   end subroutine put

   !> Take the next field; a dump whose check sum is right has all of them, unless it is of another
   !> build of the same version
   function take(self) result(field)
      class(fields_t), intent(inout) :: self
      !> Empty if there is none
      character(len=:), allocatable :: field

      integer :: first, length

      field = ''
      first = self%next + index(self%text(self%next:), ':')
      length = whole(self%text(self%next:first - 2))
      self%are_short = self%are_short .or. length < 0 .or. length > len(self%text) - first
      if (self%are_short) return
      field = self%text(first:first + length - 1)
      self%next = first + length + 1
   end function take

   !> Take the next field, a whole number
   function take_number(self) result(number)
      class(fields_t), intent(inout) :: self
      !> 0 if there is none
      integer :: number

      number = whole(self%take())
      self%are_short = self%are_short .or. number < 0
      number = max(number, 0)
   end function take_number

   !> A whole number >= 0
   pure function whole(text) result(number)
      character(len=*), intent(in) :: text
      !> -1 if the text is none
      integer :: number

      integer :: status

      number = -1
      if (text == '' .or. len(text) > 9 .or. verify(text, '0123456789') > 0) return
      read (text, *, iostat=status) number
      if (status /= 0) number = -1
   end function whole

end module vcor_io_dump
