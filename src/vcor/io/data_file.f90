!> Reads the data files of materials, in the form of `vcor_io_columns`
!>
!> Relaxation modulus: each line has a time and a modulus. One line before the first number may name
!> the columns. The units are in the case; a header with other units, shear moduli or dynamic data
!> is refused.
!>
!> Shift factors: each line has a temperature and log10 a_T. A line before the first number names
!> them and states the unit of temperatures, K or C; it may follow a #, and units may be in a second
!> line. Without it temperatures are in K.
module vcor_io_data_file
   use vcor_error, only : error_input, error_t, raise
   use vcor_io_columns, only : lines_in, read_value, row_t
   use vcor_io_file, only : read_text_file
   use vcor_io_header, only : check_unit, header_t, longest_word, name_of, names_tensile, &
      note_comment, read_names, read_units, role_none, role_of, role_relaxation, role_time, &
      temperature_names, unit_size
   use vcor_io_path, only : folder_of, join_path
   use vcor_kinds, only : wp
   use vcor_material_table, only : modulus_rounding
   use vcor_case_case, only : case_t
   use vcor_number, only : read_real, real_text
   use vcor_text, only : integer_text, lower, printable, shortened
   use vcor_words, only : contains_word
   implicit none
   private

   public :: read_data, data_file

   !> Names of the columns
   character(len=*), parameter :: names(2) = [character(len=7) :: "time", "modulus"]
   !> Roles of the columns
   integer, parameter :: expected_roles(2) = [role_time, role_relaxation]

   !> Zero of the Celsius scale [K]
   real(wp), parameter :: ice_point = 273.15_wp
   !> Names of the units of temperature
   character(len=*), parameter :: kelvin_names = 'k kelvin'
   character(len=*), parameter :: celsius_names = 'c degc deg_c celsius'
   !> Expected file, for messages
   character(len=*), parameter :: shift_example = ', expected a temperature and log10 of the ' &
      //"shift factor under a header such as 'T [C], log10_aT'"

contains

   !> Read the data files of a validated case: the points become `times` and `moduli` of their
   !> material, keys that users cannot set, and those of a shift become the list `shift_file`
   subroutine read_data(case, error)
      type(case_t), intent(inout) :: case
      !> Error of code `error_file` if a file cannot be read, `error_input` if its contents are
      !> wrong; unallocated on success
      type(error_t), allocatable, intent(out) :: error
      real(wp), allocatable :: times(:), moduli(:)
      character(len=:), allocatable :: path, text, unit
      real(wp) :: scale(2)
      integer :: item

      do item = 1, case%count("material")
         path = data_file(case, item, "shift_file")
         if (path /= "") then
            call read_file("shift_file", "a file of temperatures and shift factors")
            if (.not. allocated(error)) &
               call read_shift_table(text, printable(path), times, error)
            if (allocated(error)) return
            call case%set(case%address("material", "shift_file", item), times, given=.true.)
         end if
         path = data_file(case, item)
         if (path == "") cycle
         call read_file("file", "a file of times and moduli")
         if (allocated(error)) return
         call case%get("material", "time_unit", unit, item)
         scale(1) = unit_size(unit)
         call case%get("material", "modulus_unit", unit, item)
         scale(2) = unit_size(unit)
         call case%get("material", "modulus_kind", unit, item)
         call read_points(text, printable(path), scale, unit == "shear", times, moduli, error)
         if (allocated(error)) return
         call case%set(case%address("material", "times", item), times, given=.false.)
         call case%set(case%address("material", "moduli", item), moduli, given=.false.)
      end do

   contains

      !> Read the file named by a key
      subroutine read_file(key, kind)
         character(len=*), intent(in) :: key, kind

         call read_text_file(path, text, error, kind=kind)
         if (allocated(error)) error%message = case%location("material", key, item)//": " &
            //error%message
      end subroutine read_file
   end subroutine read_data

   !> Path of a data file of a material, relative to the folder of the case file
   pure function data_file(case, item, key) result(path)
      type(case_t), intent(in) :: case
      integer, intent(in) :: item
      !> Key of the file; absent: `file`
      character(len=*), intent(in), optional :: key
      !> The path; empty if the case has no such file
      character(len=:), allocatable :: path

      if (present(key)) then
         call case%get("material", key, path, item)
      else
         call case%get("material", "file", path, item)
      end if
      if (path /= "") path = join_path(folder_of(case%source), path)
   end function data_file

   !> Read the points of a relaxation modulus
   subroutine read_points(text, name, scale, is_shear, times, moduli, error)
      character(len=*), intent(in) :: text
      character(len=*), intent(in) :: name
      !> Units of times [s] and moduli [Pa]
      real(wp), intent(in) :: scale(2)
      !> Whether they are shear moduli according to the case
      logical, intent(in) :: is_shear
      !> Times [s], shape (n), n >= 2
      real(wp), allocatable, intent(out) :: times(:)
      !> Moduli [Pa], shape (n)
      real(wp), allocatable, intent(out) :: moduli(:)
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(row_t) :: row
      type(header_t) :: header
      character(len=:), allocatable :: message
      real(wp), allocatable :: points(:, :)
      integer :: n, last_line
      logical :: first

      allocate (points(2, lines_in(text)))
      n = 0
      first = .true.
      do
         call row%take(text)
         if (.not. row%is_there) exit
         if (first) call note_comment(header, row%comment)
         if (row%columns == 0) cycle
         if (first) then
            first = .false.
            if (.not. any(row%is_numeric([1, 2]))) then
               call read_names(header, row%content, row%line)
               call check_header(header, name, scale, is_shear, error)
               if (allocated(error)) return
               cycle
            end if
         end if
         call row%check(message)
         if (allocated(message)) then
            continue
         else if (row%columns == 2) then
            call read_value(row%cell(1), trim(names(1)), scale(1), points(1, n + 1), message)
            if (.not. allocated(message)) &
                  call read_value(row%cell(2), trim(names(2)), scale(2), points(2, n + 1), message)
            if (.not. allocated(message) .and. n > 0) &
                  call compare(points(:, n), points(:, n + 1), last_line, message)
         else
            message = "found "//integer_text(row%columns)//" columns, expected 2, a time and a " &
                  //"modulus, with a comma, a semicolon, a tab or blanks between them"
         end if
         if (allocated(message)) then
            call raise(error, error_input, name//":"//integer_text(row%line)//": "//message)
            return
         end if
         n = n + 1
         last_line = row%line
      end do
      if (n < 2) then
         call raise(error, error_input, name//":"//integer_text(max(1, row%line))//": found " &
               //integer_text(n)//" "//trim(merge("point ", "points", n == 1)) &
               //", expected 2 at least, a time and a modulus to a line")
         return
      end if
      times = points(1, :n)*scale(1)
      moduli = points(2, :n)*scale(2)
   end subroutine read_points

   !> Refuse a header of other quantities than time and relaxation modulus, or with units other than
   !> those of the case. A line without exactly two names is a title
   subroutine check_header(header, name, scale, is_shear, error)
      type(header_t), intent(in) :: header
      character(len=*), intent(in) :: name
      !> Units of times [s] and moduli [Pa] in the case
      real(wp), intent(in) :: scale(2)
      !> Whether the case has shear moduli
      logical, intent(in) :: is_shear
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      character(len=longest_word) :: unit, key
      character(len=:), allocatable :: place, found
      integer :: i, role
      logical :: shear

      place = name//":"//integer_text(header%line)
      do i = 1, header%count
         call role_of(header%columns(i), role, shear, unit)
         found = place//": found '"//shortened(trim(header%columns(i)%name))//"'"
         if (header%count /= 2) found = found//" in a title"
         shear = shear .or. index(header%columns(i)%name, "shear") > 0
         if (shear .and. .not. is_shear) then
            call raise(error, error_input, found//", a shear modulus, expected a relaxation " &
                  //"modulus E: give modulus_kind = 'shear' in its &material group, which makes " &
                  //"E = 2 (1 + nu) G of it, or identify a material by vcor fit")
         else if (is_shear .and. role == role_relaxation &
               .and. names_tensile(header%columns(i)%name)) then
            call raise(error, error_input, found//", a tensile modulus, but the case has " &
                  //"modulus_kind = 'shear'")
         else if (all(role /= [role_none, role_time, role_relaxation])) then
            call raise(error, error_input, found//" ("//name_of(role, unit)//"), expected a " &
                  //"time and a relaxation modulus E: dynamic data are for vcor fit, which " &
                  //"identifies a material in them")
         end if
         if (allocated(error)) return
         if (header%count /= 2) cycle
         if (all(role /= [role_none, expected_roles(i)])) then
            call raise(error, error_input, found//" ("//name_of(role, unit)//") as column " &
                  //integer_text(i)//", expected a time and a relaxation modulus")
         else if (role == role_none .and. unit == "") then
            call raise(error, error_input, found//" as name of a column, expected "//example(i) &
                  //", or a unit beside it")
         end if
         if (allocated(error)) return
         if (unit == "") cycle
         call check_unit(unit, expected_roles(i), place, error)
         if (allocated(error)) return
         if (abs(unit_size(trim(unit))/scale(i) - 1.0_wp) < 0.01_wp) cycle
         key = unit
         if (unit == "N/mm2") key = "MPa"
         if (unit == "N/m2") key = "Pa"
         call raise(error, error_input, place//": found '"//trim(unit) &
               //"' as unit of the "//trim(names(i))//", which is not that of the case; give " &
               //trim(names(i))//"_unit = '"//trim(key)//"' in its &material group")
         return
      end do

   contains

      !> Names of a column, for messages
      pure function example(i) result(text)
         integer, intent(in) :: i
         character(len=:), allocatable :: text

         text = "t or time"
         if (i == 2) text = "E or modulus"
      end function example
   end subroutine check_header

   !> Compare a point with the one before it
   pure subroutine compare(before, point, line, message)
      real(wp), intent(in) :: before(2)
      real(wp), intent(in) :: point(2)
      !> Line of the previous point
      integer, intent(in) :: line
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      if (.not. point(1) > before(1)) then
         message = "found time "//real_text(point(1))//" after "//real_text(before(1)) &
               //" in line "//integer_text(line)//", expected times that increase"
      else if (.not. point(2) <= before(2)*(1.0_wp + modulus_rounding)) then
         message = "found modulus "//real_text(point(2))//" after "//real_text(before(2)) &
               //" in line "//integer_text(line)//", expected moduli that fall: a relaxation " &
               //"modulus never grows with time; for data with noise identify a model by vcor fit"
      end if
   end subroutine compare

   !> Read a table of shift factors
   subroutine read_shift_table(text, name, table, error)
      !> Contents of the file
      character(len=*), intent(in) :: text
      !> Name of the file, for messages
      character(len=*), intent(in) :: name
      !> Temperatures [K], increasing, each followed by log10 a_T, shape (2 n), n >= 2
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
               message = 'found '//integer_text(row%columns)//' columns'//shift_example
            else
               if (n == 0) call find_zero(header, zero, message)
               if (.not. allocated(message)) call read_real(row%cell(1), 'a temperature', &
                  points(1, n + 1), message)
               if (.not. allocated(message)) call read_real(row%cell(2), &
                  'log10 of a shift factor', points(2, n + 1), message)
               if (.not. allocated(message)) then
                  n = n + 1
                  points(1, n) = points(1, n) + zero
                  call compare_shifts(points(:, :n), message)
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
            //'expected 2 at least'//shift_example)
         return
      end if
      if (points(1, 2) < points(1, 1)) points(:, :n) = points(:, n:1:-1)
      table = reshape(points(:, :n), [2*n])
   end subroutine read_shift_table

   !> Read a line before the numbers: the names, the units, or a comment
   pure subroutine take_head(header, content, comment, line, message)
      type(header_t), intent(inout) :: header
      character(len=*), intent(in) :: content
      !> Text after the #
      character(len=*), intent(in) :: comment
      integer, intent(in) :: line
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      type(header_t) :: names

      if (header%lines > 0) then
         if (content /= '') call read_units(header, content, line)
         return
      end if
      call read_names(names, trim(content//comment), line)
      if (names%count == 2 .and. contains_word('t '//temperature_names, names%columns(1)%name) &
          .and. index(names%columns(2)%name, 'log') == 1) then
         header = names
      else if (content /= '') then
         message = "found '"//shortened(content)//"'"//shift_example
      end if
   end subroutine take_head

   !> Zero of the temperature scale of a file
   pure subroutine find_zero(header, zero, message)
      type(header_t), intent(in) :: header
      !> Temperature [K]
      real(wp), intent(out) :: zero
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      character(len=:), allocatable :: unit

      zero = 0.0_wp
      if (header%lines == 0) return
      unit = trim(lower(header%columns(1)%unit))
      ! the degree sign in any encoding
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

   !> Check that the last shift factor of a list may follow the one before
   pure subroutine compare_shifts(points, message)
      !> Temperature [K] and log10 a_T, shape (2, n), n >= 1
      real(wp), intent(in) :: points(:, :)
      !> Message on failure, unallocated on success
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
   end subroutine compare_shifts

end module vcor_io_data_file
