!> The file of an unfinished sweep, `STEM.part`, from which `--resume` continues
!>
!> It is text. The first line has the version of the program, a check sum of the case and the
!> columns of the summary, with the labels of those that are texts; then there is a line for each
!> finished point, all of one length, in any order:
!>
!>     # vcor VERSION HASH cor cor_sphere ... status=separated,no_separation,...
!>     INDEX BITS BITS ... CHECK
!>
!> with the number of the point, the bits of each number of its outcome (`row_of`) as 16 hexadecimal
!> digits, and their check sum in as many, which every single wrong bit changes.
!> The file is created exclusively, and only ever appended to. If the process is killed, or the disk
!> is full, the last line may be incomplete; it is dropped. A line that is wrong in any other way is
!> refused with the whole file.
module vcor_io_restart
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan
   use, intrinsic :: iso_c_binding, only : c_associated, c_int, c_int64_t, c_null_ptr, c_ptr
   use, intrinsic :: iso_fortran_env, only : int32, int64
   use vcor_case_case, only : case_t
   use vcor_case_printed, only : case_text
   use vcor_error, only : error_file, error_t, raise
   use vcor_impact_trajectory, only : contact_separated
   use vcor_io_crc, only : crc32
   use vcor_io_file, only : remove_file, write_all
   use vcor_io_path, only : check_plain, check_readable, quoted_path, raise_system
   use vcor_io_posix, only : c_fclose, c_fileno, c_fopen, c_text, c_truncate, errno_exists, &
      last_errno
   use vcor_kinds, only : wp
   use vcor_sweep_quantity, only : labels_of, point_pending, quantity_t, summary_t
   use vcor_text, only : integer_text, shortened
   use vcor_version, only : version
   implicit none
   private

   public :: restart_t, create_restart, open_restart, raise_unfinished, hash_of

   !> File of an unfinished sweep
   type :: restart_t
      character(len=:), allocatable :: path
      !> C stream, null unless the file is open
      type(c_ptr), private :: stream = c_null_ptr
   contains
      procedure :: is_open, put, remove
      procedure :: close => close_restart
   end type restart_t

   !> Digits of an index, and of a number or a check sum
   integer, parameter :: index_width = 10, number_width = 16
   !> Columns that a point has if the bodies separated
   character(len=*), parameter :: known(*) = [character(len=12) :: 'cor', 'cor_sphere', &
      'contact_time']
   character(len=*), parameter :: digits = '0123456789abcdef'

contains

   !> Check sum of what a sweep is: the completed case and the points of its data files
   function hash_of(case) result(hash)
      !> A validated case, its data read
      type(case_t), intent(in) :: case
      integer(int32) :: hash

      real(wp), allocatable :: numbers(:)
      character(len=*), parameter :: keys(3) = &
         [character(len=10) :: 'shift_file', 'times', 'moduli']
      integer :: i, item

      hash = crc32(case_text(case, complete=.true.), 0_int32)
      do item = 1, case%count('material')
         do i = 1, size(keys)
            call case%get('material', trim(keys(i)), numbers, item)
            hash = crc32(transfer(numbers, repeat(' ', 8*size(numbers))), hash)
         end do
      end do
      call case%get('target', 'file', numbers)
      hash = crc32(transfer(numbers, repeat(' ', 8*size(numbers))), hash)
   end function hash_of

   !> Whether the file is open
   pure function is_open(self)
      class(restart_t), intent(in) :: self
      logical :: is_open

      is_open = c_associated(self%stream)
   end function is_open

   !> Create a file with the points finished so far
   subroutine create_restart(self, path, hash, summary, error)
      type(restart_t), intent(inout) :: self
      !> Its path, which must not exist
      character(len=*), intent(in) :: path
      !> Check sum of the case
      integer(int32), intent(in) :: hash
      type(summary_t), intent(in) :: summary
      !> Set if the file exists or cannot be written
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: reason
      integer :: i

      self%path = path
      self%stream = c_fopen(c_text(path), c_text('wx'))
      reason = last_errno()
      if (c_associated(self%stream)) then
         call append(self, head(hash, summary%quantities), error)
         if (.not. allocated(error)) call self%put(pack([(i, i=1, size(summary%status))], &
            summary%status /= point_pending), summary, error)
      else if (reason == errno_exists) then
         call raise_unfinished(path, error)
      else
         call raise_system(error, 'cannot write '//quoted_path(path), reason)
      end if
   end subroutine create_restart

   !> Raise the error that a sweep is unfinished
   subroutine raise_unfinished(path, error)
      !> Path of its file
      character(len=*), intent(in) :: path
      !> Set
      type(error_t), allocatable, intent(inout) :: error

      call raise(error, error_file, quoted_path(path)//' has the points of an unfinished sweep: ' &
         //'--resume continues it; to begin anew, delete the file')
   end subroutine raise_unfinished

   !> Read an existing file, and open it for the points that remain
   subroutine open_restart(self, path, hash, summary, error)
      type(restart_t), intent(inout) :: self
      character(len=*), intent(in) :: path
      !> Check sum of the case
      integer(int32), intent(in) :: hash
      !> Outcomes, all pending; on return those of the file are there
      type(summary_t), intent(inout) :: summary
      !> Error of code `error_file` if the file is of another case, version or columns, damaged or
      !> not readable; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer(int64) :: length
      integer(c_int) :: reason
      logical :: failed

      self%path = path
      call check_plain(path, error)
      if (.not. allocated(error)) &
         call read_file(path, head(hash, summary%quantities), summary, length, error)
      if (allocated(error)) return
      failed = c_truncate(c_text(path), int(length, c_int64_t)) /= 0
      reason = last_errno()
      if (.not. failed) then
         self%stream = c_fopen(c_text(path), c_text('a'))
         reason = last_errno()
         failed = .not. c_associated(self%stream)
      end if
      if (failed) then
         call raise_system(error, 'cannot write '//quoted_path(path), reason)
      else if (length == 0) then
         call append(self, head(hash, summary%quantities), error)
      end if
   end subroutine open_restart

   !> Read the points of a file
   subroutine read_file(path, expected, summary, length, error)
      character(len=*), intent(in) :: path
      !> First line
      character(len=*), intent(in) :: expected
      !> On return with the outcomes of the file
      type(summary_t), intent(inout) :: summary
      !> Length of its complete lines [bytes]
      integer(int64), intent(out) :: length
      !> Set as by `open_restart`
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: line, flaw
      real(wp), allocatable :: bounds(:, :), row(:)
      integer, allocatable :: needed(:)
      integer(int64) :: bytes
      integer :: place, status, unit

      length = 0
      allocate (bounds, source=bounds_of(summary%quantities))
      allocate (row(size(bounds, 2)))
      needed = needed_places(summary%quantities)
      call check_readable(path, 'the file of an unfinished sweep', error)
      if (allocated(error)) return
      open (newunit=unit, file=path, access='stream', form='unformatted', status='old', &
         action='read', iostat=status)
      if (status /= 0) then
         call raise(error, error_file, 'cannot read '//quoted_path(path))
         return
      end if
      inquire (unit, size=bytes)
      line = repeat(' ', int(min(bytes, len(expected, kind=int64))))
      read (unit, iostat=status) line
      ! a first line that is incomplete is dropped like any other
      if (status == 0 .and. line /= expected(:len(line))) then
         call raise(error, error_file, quoted_path(path)//' is not of this case and version: ' &
            //difference(line, expected)//'; delete it, or resume what it is of')
      else if (status == 0 .and. len(line) == len(expected)) then
         length = len(expected)
         line = repeat(' ', line_length(size(row)))
         do
            read (unit, iostat=status) line
            if (status /= 0) exit
            call read_line(line, bounds, place, row, flaw)
            if (flaw == '') then
               if (place < 1 .or. place > size(summary%status)) then
                  flaw = 'the sweep has no point '//integer_text(place)
               else if (summary%status(place) /= point_pending) then
                  flaw = 'it is the second line of point '//integer_text(place)
               else if (nint(row(size(row) - 1)) == contact_separated &
                        .and. any(ieee_is_nan(row(needed)))) then
                  flaw = 'point '//integer_text(place)//' has separated without a result'
               end if
            end if
            if (flaw /= '') then
               call raise(error, error_file, quoted_path(path)//' is damaged in line ' &
                  //integer_text(1 + int((length - len(expected))/len(line)) + 1)//': '//flaw &
                  //'; delete the file to begin anew')
               exit
            end if
            call summary%put(place, row)
            length = length + len(line)
         end do
         if (.not. (allocated(error) .or. is_iostat_end(status))) &
            call raise(error, error_file, 'cannot read '//quoted_path(path))
      end if
      close (unit)
   end subroutine read_file

   !> What differs in the first line, for messages
   pure function difference(found, expected) result(text)
      !> Beginning of the file, and first line that it should have
      character(len=*), intent(in) :: found, expected
      character(len=:), allocatable :: text

      character(len=:), allocatable :: ours, theirs
      integer :: i

      !> Words before the columns
      integer, parameter :: lead = 4

      do i = 1, lead
         if (word_of(found, i) == word_of(expected, i)) cycle
         text = "it begins with '"//shortened(up_to_word(found, lead))//"', expected '" &
            //up_to_word(expected, lead)//"'"
         return
      end do
      i = lead + 1
      do while (word_of(found, i) == word_of(expected, i) .and. word_of(expected, i) /= '')
         i = i + 1
      end do
      theirs = shortened(word_of(found, i))
      ours = word_of(expected, i)
      text = 'its column '//integer_text(i - lead)//" is '"//theirs//"', expected '"//ours//"'"
      if (ours == '') text = 'it has the column '//integer_text(i - lead)//", '"//theirs &
         //"', expected "//integer_text(i - 1 - lead)//' columns'
      if (theirs == '') text = 'it has no column '//integer_text(i - lead)//", expected '"//ours &
         //"'"
   end function difference

   !> Word of the first line of a text
   pure function word_of(text, number) result(word)
      character(len=*), intent(in) :: text
      !> Number of the word, from 1
      integer, intent(in) :: number
      !> The word; empty if there are fewer
      character(len=:), allocatable :: word

      integer :: before

      before = len(up_to_word(text, number - 1))
      word = up_to_word(text, number)
      if (before > 0) before = before + 1
      word = word(min(before, len(word)) + 1:)
   end function word_of

   !> The first words of the first line of a text
   pure function up_to_word(text, number) result(words)
      character(len=*), intent(in) :: text
      !> How many
      integer, intent(in) :: number
      !> The words; the whole line if it has fewer
      character(len=:), allocatable :: words

      integer :: i, last

      last = index(text//new_line('a'), new_line('a')) - 1
      words = ''
      do i = 1, number
         if (len(words) == last) return
         words = text(:len(words) + max(1, scan(text(len(words) + 2:last)//' ', ' ')))
      end do
   end function up_to_word

   !> Places in a row of the numbers that every point with a result has
   pure function needed_places(quantities) result(places)
      type(quantity_t), intent(in) :: quantities(:)
      !> Places, shape (n)
      integer, allocatable :: places(:)

      integer :: i

      places = pack([(i, i=1, size(quantities))], [(any(known == quantities(i)%name), &
         i=1, size(quantities))])
   end function needed_places

   !> Smallest and largest values of the numbers of a row: those of texts have a meaning only there
   pure function bounds_of(quantities) result(bounds)
      type(quantity_t), intent(in) :: quantities(:)
      !> Bounds, shape (2, numbers); of numbers without bounds none, +-huge
      real(wp), allocatable :: bounds(:, :)

      integer :: i

      allocate (bounds(2, size(quantities) + 1))
      do i = 1, size(quantities)
         bounds(:, i) = huge(1.0_wp)*[-1, 1]
         if (quantities(i)%is_whole) bounds(:, i) = real(huge(1), wp)*[-1, 1]
         if (quantities(i)%labels /= '') bounds(:, i) = quantities(i)%first &
            + [0, size(labels_of(quantities(i))) - 1]
      end do
      ! the last number is 0 or 1
      bounds(:, size(quantities) + 1) = [0, 1]
   end function bounds_of

   !> Read the line of a point
   pure subroutine read_line(line, bounds, place, row, flaw)
      character(len=*), intent(in) :: line
      !> Bounds of its numbers, shape (2, numbers)
      real(wp), intent(in) :: bounds(:, :)
      !> Number of the point, 0 if the line is damaged
      integer, intent(out) :: place
      !> Its numbers; undefined if the line is damaged
      real(wp), intent(out) :: row(:)
      !> What is wrong with the line; empty if nothing is
      character(len=:), allocatable, intent(out) :: flaw

      integer(int64) :: words(size(row) + 1)
      character(len=index_width) :: index_text
      integer :: digit, i, j, k, number, status

      place = 0
      flaw = 'expected the bits of a point'
      read (line(:index_width), '(i10)', iostat=status) number
      if (status /= 0) return
      write (index_text, '(i10)') number
      if (line(:index_width) /= index_text) return
      k = index_width
      do i = 1, size(words)
         if (line(k + 1:k + 1) /= ' ') return
         words(i) = 0
         do j = k + 2, k + 1 + number_width
            digit = index(digits, line(j:j)) - 1
            if (digit < 0) return
            words(i) = ior(shiftl(words(i), 4), int(digit, int64))
         end do
         k = k + 1 + number_width
      end do
      if (line(k + 1:) /= new_line('a')) return
      flaw = 'it has the wrong check sum'
      if (words(size(words)) /= check_of(number, words(:size(row)))) return
      flaw = 'expected the bits of a point'
      do i = 1, size(row)
         row(i) = transfer(words(i), 1.0_wp)
         if (bounds(2, i) >= huge(1.0_wp)) cycle
         ! a NaN fails the first comparison, before it is rounded
         if (.not. abs(row(i)) <= huge(1)) return
         if (row(i) < bounds(1, i) .or. row(i) > bounds(2, i)) return
         if (abs(row(i) - anint(row(i))) > 0.0_wp) return
      end do
      place = number
      flaw = ''
   end subroutine read_line

   !> Append finished points
   subroutine put(self, places, summary, error)
      class(restart_t), intent(inout) :: self
      !> The points
      integer, intent(in) :: places(:)
      type(summary_t), intent(in) :: summary
      !> Set if they could not be written
      type(error_t), allocatable, intent(out) :: error

      !> Points that are written in one call
      integer, parameter :: most_lines = 1000
      character(len=:), allocatable :: text
      integer :: first, i, n, width

      width = line_length(size(summary%values) + 2)
      allocate (character(len=width*min(most_lines, size(places))) :: text)
      do first = 1, size(places), most_lines
         n = min(most_lines, size(places) - first + 1)
         do i = 1, n
            associate (place => places(first + i - 1))
               call write_line(place, summary%row(place), text((i - 1)*width + 1:i*width))
            end associate
         end do
         call append(self, text(:n*width), error)
         if (allocated(error)) return
      end do
   end subroutine put

   !> Write the line of a point
   pure subroutine write_line(place, row, line)
      !> Number of the point
      integer, intent(in) :: place
      !> Its numbers
      real(wp), intent(in) :: row(:)
      character(len=*), intent(out) :: line

      integer(int64) :: words(size(row) + 1)
      integer :: digit, i, j, k

      words(:size(row)) = transfer(row, words)
      words(size(words)) = check_of(place, words(:size(row)))
      write (line(:index_width), '(i10)') place
      k = index_width
      do i = 1, size(words)
         line(k + 1:k + 1) = ' '
         do j = k + 1 + number_width, k + 2, -1
            digit = int(iand(words(i), 15_int64)) + 1
            line(j:j) = digits(digit:digit)
            words(i) = shiftr(words(i), 4)
         end do
         k = k + 1 + number_width
      end do
      line(k + 1:) = new_line('a')
   end subroutine write_line

   !> Length of the line of a point with its end [bytes]
   pure function line_length(numbers) result(length)
      !> Numbers of a point
      integer, intent(in) :: numbers
      integer :: length

      length = index_width + (1 + number_width)*(numbers + 1) + 1
   end function line_length

   !> Check sum of a point: rotating and exclusive-or are undone by their inverses, so that any
   !> change of a single number changes the sum
   pure function check_of(place, words) result(check)
      !> Number of the point
      integer, intent(in) :: place
      !> Bits of its numbers
      integer(int64), intent(in) :: words(:)
      integer(int64) :: check

      integer :: i

      check = place
      do i = 1, size(words)
         check = ieor(ishftc(check, 1), words(i))
      end do
   end function check_of

   !> First line
   pure function head(hash, quantities) result(line)
      !> Check sum of the case
      integer(int32), intent(in) :: hash
      !> The columns
      type(quantity_t), intent(in) :: quantities(:)
      character(len=:), allocatable :: line

      character(len=8) :: number
      integer :: i, j

      write (number, '(z8.8)') hash
      line = '# vcor '//version//' '//number
      do i = 1, size(quantities)
         line = line//' '//trim(quantities(i)%name)
         if (quantities(i)%labels == '') cycle
         associate (labels => labels_of(quantities(i)))
            line = line//'='//trim(labels(1))
            do j = 2, size(labels)
               line = line//','//trim(labels(j))
            end do
         end associate
      end do
      line = line//new_line('a')
   end function head

   !> Append text to the file
   subroutine append(self, text, error)
      type(restart_t), intent(in) :: self
      character(len=*), intent(in) :: text
      !> Set if it could not be written
      type(error_t), allocatable, intent(out) :: error

      integer(c_int) :: reason

      call write_all(c_fileno(self%stream), text, reason)
      if (reason /= 0) call raise_system(error, 'cannot write '//quoted_path(self%path), reason)
   end subroutine append

   !> Close the file and keep it
   subroutine close_restart(self)
      class(restart_t), intent(inout) :: self

      integer(c_int) :: ignored

      if (self%is_open()) ignored = c_fclose(self%stream)
      self%stream = c_null_ptr
   end subroutine close_restart

   !> Close the file and remove it, if it is open
   subroutine remove(self)
      class(restart_t), intent(inout) :: self

      if (self%is_open()) call remove_file(self%path)
      call self%close()
   end subroutine remove

end module vcor_io_restart
