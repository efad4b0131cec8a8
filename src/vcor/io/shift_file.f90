!> Tables of shift factors: a temperature and log10 a_T to a line
!>
!> Columns and decimals are as in files of moduli. A line before the first number names them and
!> tells the unit of the temperatures, K or C; it may stand behind a #, units may stand in a second
!> line. Without it they are in K.
module vcor_io_shift_file
   use vcor_error, only : error_input, error_t, raise
   use vcor_io_columns, only : lines_in, row_t
   use vcor_io_header, only : header_t, read_names, read_units
   use vcor_case_real, only : read_real
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, lower, real_text, shortened
   use vcor_words, only : contains_word
   implicit none
   private

   public :: read_shift_table

   !> Zero of the Celsius scale [K]
   real(wp), parameter :: ice_point = 273.15_wp
   !> Names of a temperature, and of its units
   character(len=*), parameter :: temperature_names = 't T temp temp. temperature'
   character(len=*), parameter :: kelvin_names = 'k kelvin'
   character(len=*), parameter :: celsius_names = 'c degc deg_c celsius'
   !> What a file should have
   character(len=*), parameter :: example = ', expected a temperature and log10 of the shift ' &
      //"factor under a header such as 'T [C], log10_aT'"

contains

   !> Read a table
   subroutine read_shift_table(text, name, table, error)
      !> Contents of the file
      character(len=*), intent(in) :: text
      !> Name of the file for messages
      character(len=*), intent(in) :: name
      !> Temperature [K], rising, and log10 a_T, one after the other, shape (2 n), n >= 2
      real(wp), allocatable, intent(out) :: table(:)
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(row_t) :: row
      type(header_t) :: header
      character(len=:), allocatable :: message
      real(wp), allocatable :: points(:, :)
      real(wp) :: zero
      integer :: n

      allocate (points(2, lines_in(text)))
      n = 0
      zero = 0.0_wp
      do
         call row%take(text)
         if (.not. row%is_there) exit
         if (n == 0 .and. .not. (row%columns > 0 .and. row%is_numeric(1))) then
            call take_head(header, row%content, row%comment, row%line, message)
         else if (row%columns > 0) then
            call row%check(message)
            if (allocated(message)) then
               continue
            else if (row%columns /= 2) then
               message = 'found '//integer_text(row%columns)//' columns'//example
            else
               if (n == 0) call find_zero(header, zero, message)
               if (.not. allocated(message)) call read_real(row%cell(1), 'a temperature', &
                  points(1, n + 1), message)
               if (.not. allocated(message)) call read_real(row%cell(2), &
                  'log10 of a shift factor', points(2, n + 1), message)
               if (.not. allocated(message)) then
                  n = n + 1
                  points(1, n) = points(1, n) + zero
                  call compare(points(:, :n), message)
               end if
            end if
         end if
         if (allocated(message)) then
            call raise(error, error_input, name//':'//integer_text(row%line)//': '//message)
            return
         end if
      end do
      if (n < 2) then
         call raise(error, error_input, name//': found '//integer_text(n)//' lines of numbers, ' &
            //'expected 2 at least'//example)
         return
      end if
      if (points(1, 2) < points(1, 1)) points(:, :n) = points(:, n:1:-1)
      table = reshape(points(:, :n), [2*n])
   end subroutine read_shift_table

   !> Take a line before the numbers: the names, the units, or a comment that says neither
   pure subroutine take_head(header, content, comment, line, message)
      type(header_t), intent(inout) :: header
      character(len=*), intent(in) :: content
      !> What follows its #
      character(len=*), intent(in) :: comment
      integer, intent(in) :: line
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      type(header_t) :: names

      if (header%lines > 0) then
         if (content /= '') call read_units(header, content, line)
         return
      end if
      call read_names(names, trim(content//comment), line)
      if (names%count == 2 .and. contains_word(temperature_names, names%columns(1)%name) &
          .and. index(names%columns(2)%name, 'log') == 1) then
         header = names
      else if (content /= '') then
         message = "found '"//shortened(content)//"'"//example
      end if
   end subroutine take_head

   !> Find what is 0 in the unit of the temperatures
   pure subroutine find_zero(header, zero, message)
      type(header_t), intent(in) :: header
      !> Temperature [K]
      real(wp), intent(out) :: zero
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      character(len=:), allocatable :: unit

      zero = 0.0_wp
      if (header%lines == 0) return
      unit = trim(lower(header%columns(1)%unit))
      ! the sign of degrees, in whatever encoding
      do while (len(unit) > 1)
         if (iachar(unit(1:1)) < 128) exit
         unit = unit(2:)
      end do
      if (contains_word(celsius_names, unit)) then
         zero = ice_point
      else if (.not. contains_word(kelvin_names, unit)) then
         message = "found '"//shortened(trim(header%columns(1)%unit))//"' as unit of the " &
            //'temperatures, expected K or C, as in T [K] or T [C]'
      end if
   end subroutine find_zero

   !> Compare the last point of some with the one before it
   pure subroutine compare(points, message)
      !> Temperature [K] and log10 a_T, shape (2, n), n >= 1
      real(wp), intent(in) :: points(:, :)
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      integer :: n

      n = size(points, 2)
      if (.not. points(1, n) > 0.0_wp) then
         message = 'found a temperature of '//real_text(points(1, n))//' K, expected one > 0 K'
      else if (n > 1) then
         associate (step => points(:, n) - points(:, n - 1))
            if (.not. abs(step(1)) > 0.0_wp &
                .or. step(1)*(points(1, 2) - points(1, 1)) < 0.0_wp) then
               message = 'found '//real_text(points(1, n))//' K after ' &
                  //real_text(points(1, n - 1))//' K, expected temperatures that all rise or ' &
                  //'all fall'
            else if (step(1)*step(2) > 0.0_wp) then
               message = 'found log10 a_T = '//real_text(points(2, n))//' after ' &
                  //real_text(points(2, n - 1))//', expected shift factors that fall as the ' &
                  //'temperature rises'
            end if
         end associate
      end if
   end subroutine compare

end module vcor_io_shift_file
