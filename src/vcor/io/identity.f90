!> Identity of a file of results: version of the program, case, data files and points
module vcor_io_identity
   use, intrinsic :: iso_fortran_env, only : int32, int64, int8
   use vcor_error, only : error_file, error_t, raise
   use vcor_io_data_file, only : data_file
   use vcor_io_hdf5_reader, only : close_hdf5, open_hdf5, reader_t, text_attribute
   use vcor_text, only : integer_text, shortened
   use vcor_io_path, only : quoted_path
   use vcor_kinds, only : wp
   use vcor_io_seal, only : crc32
   use vcor_case_case, only : case_t
   use vcor_case_printed, only : case_text
   use vcor_sweep_part, only : new_part, part_t
   use vcor_version, only : version
   implicit none
   private

   public :: identity_t, identity_of, read_identity, read_csv, check_same, number_of

   !> Identity of a file of results
   type :: identity_t
      !> Version; empty if the file is not from this program
      character(len=:), allocatable :: version
      character(len=:), allocatable :: title
      character(len=:), allocatable :: case_text
      !> Check sum of the points in the data files of the case
      character(len=:), allocatable :: data
      !> Points in the file
      type(part_t) :: part
   end type identity_t

contains

   !> Identity of a run of a case
   function identity_of(case, part) result(identity)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> Points of the run
      type(part_t), intent(in) :: part
      type(identity_t) :: identity

      identity%version = version
      call case%get('case', 'title', identity%title)
      identity%case_text = case_text(case, complete=.true.)
      identity%data = data_of(case)
      identity%part = part
   end function identity_of

   !> Check sum of the points in the data files of a case
   function data_of(case) result(text)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      !> The sum; empty if there are no data files
      character(len=:), allocatable :: text

      real(wp), allocatable :: numbers(:), times(:), moduli(:)
      character(len=8) :: digits
      integer(int32) :: sum
      integer :: item

      sum = 0
      text = ''
      do item = 1, case%count('material')
         call case%get('material', 'shift_file', numbers, item)
         if (data_file(case, item) /= '') then
            call case%get('material', 'times', times, item)
            call case%get('material', 'moduli', moduli, item)
            numbers = [numbers, times, moduli]
         end if
         if (size(numbers) == 0) cycle
         sum = crc32(transfer(numbers, [0_int8]), sum)
         write (digits, '(z8.8)') sum
         text = digits
      end do
   end function data_of

   !> Number that is equal on all ranks if they have the same case
   pure function number_of(identity) result(number)
      !> Identity of the run
      type(identity_t), intent(in) :: identity
      integer :: number

      number = crc32(transfer(identity%version//identity%case_text//identity%data, [0_int8]), &
         int(identity%part%number, int32))
   end function number_of

   !> Read the identity of an HDF5 file
   subroutine read_identity(path, identity, error)
      character(len=*), intent(in) :: path
      !> Its identity; a single shard without points if it states none
      type(identity_t), intent(out) :: identity
      !> Set if it cannot be read, or is not an HDF5 file
      type(error_t), allocatable, intent(out) :: error

      type(reader_t) :: reader

      identity%version = ''
      call open_hdf5(reader, path, error)
      if (allocated(error)) return
      if (text_attribute(reader, 'program') == 'vcor') &
         identity%version = text_attribute(reader, 'version')
      identity%title = text_attribute(reader, 'title')
      identity%case_text = text_attribute(reader, 'case')
      identity%data = text_attribute(reader, 'data')
      identity%part = new_part(max(0, number('points')), max(1, number('shard')), &
         max(1, number('shards')))
      call close_hdf5(reader)

   contains

      !> Read a number from an attribute
      function number(name)
         character(len=*), intent(in) :: name
         !> The number; 0 if there is none
         integer :: number

         character(len=:), allocatable :: digits
         integer :: status

         number = 0
         digits = text_attribute(reader, name)
         if (len(digits) == 0) return
         read (digits, *, iostat=status) number
         if (status /= 0) number = 0
      end function number
   end subroutine read_identity

   !> Read the identity of a CSV file from its head, and optionally count its rows
   subroutine read_csv(path, identity, rows)
      character(len=*), intent(in) :: path
      !> Its identity, without data
      type(identity_t), intent(out) :: identity
      !> Number of complete rows after the names of the columns; 0 if there is no such file
      integer, intent(out), optional :: rows

      character(len=*), parameter :: program = '# vcor '
      ! room for any line of the head; only the first character of a row matters
      character(len=9000) :: line
      character :: last
      integer(int64) :: bytes
      integer :: unit, status, lines
      logical :: in_case

      identity%version = ''
      identity%title = ''
      identity%case_text = ''
      identity%data = ''
      in_case = .false.
      ! lines after the head, including the line of names
      lines = 0
      if (present(rows)) rows = 0
      open (newunit=unit, file=path, status='old', action='read', iostat=status)
      if (status /= 0) return
      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) exit
         if (line(:1) /= '#') then
            lines = lines + 1
            if (.not. present(rows)) exit
         else if (lines == 0 .and. in_case) then
            identity%case_text = identity%case_text//trim(line(3:))//new_line('a')
         else if (lines == 0 .and. index(line, program) == 1) then
            identity%version = trim(line(len(program) + 1:))
         end if
         in_case = in_case .or. line == '# case:'
      end do
      close (unit)
      if (.not. in_case) identity%version = ''
      if (.not. present(rows)) return
      ! a last row without a line end is incomplete
      open (newunit=unit, file=path, status='old', action='read', access='stream', &
         form='unformatted', iostat=status)
      if (status /= 0) return
      inquire (unit, size=bytes)
      read (unit, pos=max(1_int64, bytes), iostat=status) last
      close (unit)
      if (status == 0) rows = max(0, lines - merge(1, 2, last == new_line('a')))
   end subroutine read_csv

   !> Refuse a file of another identity, apart from the number of the shard
   subroutine check_same(path, found, expected, error)
      character(len=*), intent(in) :: path
      type(identity_t), intent(in) :: found
      type(identity_t), intent(in) :: expected
      !> Error of code `error_file` with the reason, unallocated if the identities agree
      type(error_t), allocatable, intent(out) :: error

      if (found%version /= expected%version) then
         call raise(error, error_file, quoted_path(path)//' is of another version: it has '// &
            shortened(found%version)//', this is '//expected%version)
      else if (found%case_text /= expected%case_text) then
         call raise(error, error_file, quoted_path(path)//' is of another case: '// &
            first_difference(found%case_text, expected%case_text))
      else if (found%data /= expected%data) then
         call raise(error, error_file, quoted_path(path)//' was made from a data file with '// &
            'other points')
      else if (found%part%parts /= expected%part%parts) then
         call raise(error, error_file, quoted_path(path)//' is one of '// &
            integer_text(found%part%parts)//' shards, this is one of '// &
            integer_text(expected%part%parts))
      end if
   end subroutine check_same

   !> First difference between two cases
   pure function first_difference(found, expected) result(text)
      !> A case
      character(len=*), intent(in) :: found
      !> Another case
      character(len=*), intent(in) :: expected
      !> Text for an error, or for a note that the file is replaced
      character(len=:), allocatable :: text
      character(len=:), allocatable :: one, other
      integer :: i, start

      start = 1
      do i = 1, min(len(found), len(expected))
         if (found(i:i) /= expected(i:i)) exit
         if (found(i:i) == new_line('a')) start = i + 1
      end do
      one = line_at(found)
      other = line_at(expected)
      if (one(:index(one, '=')) == other(:index(other, '=')) .and. index(one, '=') > 0) then
         text = "it has '"//one//"', this one '"//other//"'"
      else if (index(expected(min(start, len(expected) + 1):), one) > 0) then
         text = "it lacks '"//other//"'"
      else
         text = "it has '"//one//"', which this one lacks"
      end if

   contains

      !> The line that begins at `start`
      pure function line_at(case_text) result(line)
         character(len=*), intent(in) :: case_text
         !> The line, shortened if it is long
         character(len=:), allocatable :: line

         line = case_text(min(start, len(case_text) + 1):)
         line = shortened(trim(adjustl(line(:index(line//new_line('a'), new_line('a')) - 1))))
      end function line_at
   end function first_difference

end module vcor_io_identity
