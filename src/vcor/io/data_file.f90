!> Reads the data files of a case: plain text of columns with a comma between them
!>
!> The first line names both columns with their units, `time [s],relaxation_modulus [Pa]` or
!> `temperature [K],log10_shift_factor [1]`. A file of moduli may have no such line, or no units in
!> it, if the case gives time_unit and modulus_unit. A file of the modes of a structure has three
!> columns in any order, `frequency [Hz],damping_ratio,modal_mass [kg]` or in place of the last one
!> `mode_shape [kg^-0.5]` at the struck point, of shapes that are normalised by the mass. Text after
!> a # and blank lines are ignored. All other forms are refused: vcor table makes a plain file of
!> what instruments write.
module vcor_io_data_file
   use vcor_case_case, only : case_t
   use vcor_error, only : error_input, error_t, raise
   use vcor_io_file, only : read_text_file
   use vcor_io_path, only : folder_of, join_path
   use vcor_kinds, only : wp
   use vcor_material_table, only : largest_value, modulus_rounding, smallest_value
   use vcor_number, only : looks_numeric, most_magnitude, read_real, real_text
   use vcor_text, only : has_control, integer_text, lower, printable, shortened
   use vcor_words, only : contains_word
   implicit none
   private

   public :: read_data, data_file, modes_file, data_folder, file_keys

   !> Keys of &material that name a data file
   character(len=*), parameter :: file_keys(*) = [character(len=10) :: 'file', 'shift_file']

   !> Names of the columns, separated by blanks
   character(len=*), parameter :: time_names = 't time', &
      tensile_names = 'e e(t)', neutral_names = 'modulus relaxation_modulus', &
      shear_names = 'g g(t) shear_modulus shear_relaxation_modulus', &
      temperature_names = 'T temperature Temperature', &
      shift_names = 'log10_shift_factor log10_at log10_a_t log10(at) log10(a_t)'
   !> Units of temperatures
   character(len=*), parameter :: kelvin_names = 'K', celsius_names = 'C degC'
   !> Zero of the Celsius scale [K]
   real(wp), parameter :: ice_point = 273.15_wp
   !> Most columns of a file
   integer, parameter :: most_columns = 3
   !> Longest name or unit of a column
   integer, parameter :: longest_word = 40

   !> A file of columns
   type :: plain_t
      !> Number of columns
      integer :: columns = 2
      !> Name for messages
      character(len=:), allocatable :: name
      !> Name of the file and how to make a plain one of it, for messages
      character(len=:), allocatable :: advice
      !> Names and units of the columns; blank if the file does not state them
      character(len=longest_word) :: names(most_columns) = '', units(most_columns) = ''
      !> Line of the names; 0: none
      integer :: head = 0
      !> The numbers, shape (columns, n)
      real(wp), allocatable :: points(:, :)
      !> Their lines, shape (n)
      integer, allocatable :: lines(:)
      !> Last line of the file
      integer :: last_line = 0
   end type plain_t

contains

   !> Read the data files of a validated case: the points become `times` and `moduli` of their
   !> material, keys that users cannot set, and those of a shift become the list `shift_file`.
   !> Frequencies [Hz], damping ratios and modal masses [kg] of a structure become the list `file`
   subroutine read_data(case, error)
      type(case_t), intent(inout) :: case
      !> Error of code `error_file` if a file cannot be read, `error_input` if its contents are
      !> wrong; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(plain_t) :: plain
      character(len=:), allocatable :: path
      integer :: item

      do item = 1, case%count('material')
         path = data_file(case, item, 'shift_file')
         if (path /= '') then
            call read_file(case%location('material', 'shift_file', item), &
               'a file of temperatures and shift factors')
            if (.not. allocated(error)) call check_shift(plain, error)
            if (allocated(error)) return
            call case%set(case%address('material', 'shift_file', item), &
               reshape(plain%points, [size(plain%points)]), given=.true.)
         end if
         path = data_file(case, item)
         if (path == '') cycle
         call read_file(case%location('material', 'file', item), 'a file of times and moduli')
         if (.not. allocated(error)) call check_moduli(plain, case, item, error)
         if (allocated(error)) return
         call case%set(case%address('material', 'times', item), plain%points(1, :), given=.false.)
         call case%set(case%address('material', 'moduli', item), plain%points(2, :), given=.false.)
      end do
      path = modes_file(case)
      if (path == '') return
      call read_file(case%location('target', 'file'), 'a file of the modes of a structure', 3)
      if (.not. allocated(error)) call check_modes(plain, error)
      if (.not. allocated(error)) call case%set(case%address('target', 'file'), &
         reshape(plain%points, [size(plain%points)]), given=.true.)

   contains

      !> Read the file at `path`
      subroutine read_file(place, kind, columns)
         !> Place of the key that names it, and what it is, for messages
         character(len=*), intent(in) :: place, kind
         !> Number of columns; absent: 2
         integer, intent(in), optional :: columns

         character(len=:), allocatable :: text

         call read_text_file(path, text, error, kind=kind)
         if (allocated(error)) then
            error%message = place//': '//error%message
         else
            call read_plain(text, printable(path), plain, error, columns)
         end if
      end subroutine read_file
   end subroutine read_data

   !> Path of a data file of a material, relative to the folder of the case
   pure function data_file(case, item, key) result(path)
      type(case_t), intent(in) :: case
      integer, intent(in) :: item
      !> Key of the file; absent: `file`
      character(len=*), intent(in), optional :: key
      !> The path; empty if the case has no such file
      character(len=:), allocatable :: path

      if (present(key)) then
         call case%get('material', key, path, item)
      else
         call case%get('material', 'file', path, item)
      end if
      if (path /= '') path = join_path(data_folder(case), path)
   end function data_file

   !> Path of the file of the modes of a structure, relative to the folder of the case
   pure function modes_file(case) result(path)
      type(case_t), intent(in) :: case
      !> The path; empty if the case has no such file
      character(len=:), allocatable :: path

      call case%get('target', 'file', path)
      if (case%row(case%address('target', 'file')) == 0) path = ''
      if (path /= '') path = join_path(data_folder(case), path)
   end function modes_file

   !> Folder of the data files of a case
   pure function data_folder(case) result(folder)
      type(case_t), intent(in) :: case
      !> With a slash at its end; empty for the current one
      character(len=:), allocatable :: folder

      folder = folder_of(case%source)
      if (allocated(case%folder)) folder = case%folder
   end function data_folder

   !> Read columns with or without names
   subroutine read_plain(text, name, plain, error, columns)
      character(len=*), intent(in) :: text
      !> Name of the file, for messages
      character(len=*), intent(in) :: name
      type(plain_t), intent(out) :: plain
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      !> Number of columns, 2 or 3; absent: 2
      integer, intent(in), optional :: columns

      character(len=*), parameter :: byte_order_mark = char(239)//char(187)//char(191)
      character(len=*), parameter :: line_feed = achar(10)
      character(len=:), allocatable :: line, message
      integer :: first, last, n, least

      plain%name = name
      plain%advice = '; vcor table '//name//' > t.csv makes such a file of others'
      if (present(columns)) plain%columns = columns
      ! vcor table makes files of two columns
      if (plain%columns > 2) plain%advice = ''
      least = merge(2, 1, plain%columns == 2)
      n = count([(text(first:first) == line_feed, first=1, len(text))]) + 1
      allocate (plain%points(plain%columns, n), plain%lines(n))
      n = 0
      first = 1
      if (index(text, byte_order_mark) == 1) first = 1 + len(byte_order_mark)
      do while (first <= len(text))
         last = first + index(text(first:)//line_feed, line_feed) - 2
         line = text(first:last)
         first = last + 2
         plain%last_line = plain%last_line + 1
         line = stripped(line(:index(line//'#', '#') - 1))
         if (len(line) == 0) cycle
         call take_line(plain, line, n, message)
         if (.not. allocated(message)) cycle
         call complain(plain, plain%last_line, message, error)
         return
      end do
      if (n < least) call complain(plain, max(1, plain%last_line), 'found '//integer_text(n) &
         //trim(merge(' point ', ' points', n == 1))//', expected '//integer_text(least) &
         //' at least', error)
      plain%points = plain%points(:, :n)
      plain%lines = plain%lines(:n)
   end subroutine read_plain

   !> Take a line: the names, or the numbers
   subroutine take_line(plain, line, n, message)
      type(plain_t), intent(inout) :: plain
      !> The line without remark and without blanks around it
      character(len=*), intent(in) :: line
      !> Number of points
      integer, intent(inout) :: n
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      character(len=len(line)) :: cells(most_columns)
      integer :: columns, first, i, mark

      columns = 1 + count([(line(i:i) == ',', i=1, len(line))])
      if (has_control(line)) then
         message = 'found a control character, expected a text file of '//trim(merge('two  ', &
            'three', plain%columns == 2))//' columns with a comma between them'
      else if (columns /= plain%columns) then
         message = 'found '//integer_text(columns)//trim(merge(' column ', ' columns', &
            columns == 1))//', expected '//integer_text(plain%columns)//' with a comma between them'
      end if
      if (allocated(message)) then
         message = message//plain%advice
         return
      end if
      first = 1
      do i = 1, plain%columns
         mark = first + index(line(first:)//',', ',') - 1
         cells(i) = stripped(line(first:mark - 1))
         first = mark + 1
      end do
      if (n == 0 .and. plain%head == 0 .and. .not. any([(looks_numeric(trim(cells(i))), &
          i=1, plain%columns)])) then
         plain%head = plain%last_line
         do i = 1, plain%columns
            call take_name(trim(cells(i)), plain%names(i), plain%units(i))
         end do
         return
      end if
      do i = 1, plain%columns
         call read_real(trim(cells(i)), 'a number', plain%points(i, n + 1), message)
         if (.not. allocated(message)) cycle
         if (scan(trim(cells(i)), '; '//achar(9)) > 0) message = message//plain%advice
         return
      end do
      n = n + 1
      plain%lines(n) = plain%last_line
   end subroutine take_line

   !> A text without blanks, tabs and the first half of a line end of Windows at its ends
   pure function stripped(text)
      character(len=*), intent(in) :: text
      character(len=:), allocatable :: stripped

      character(len=*), parameter :: blanks = ' '//achar(9)//achar(13)
      integer :: first

      first = verify(text, blanks)
      stripped = text(max(1, first):verify(text, blanks, back=.true.))
   end function stripped

   !> Split `name [unit]` or `name (unit)`
   pure subroutine take_name(cell, name, unit)
      character(len=*), intent(in) :: cell
      !> The name, with underscores for blanks
      character(len=*), intent(out) :: name
      !> The unit; blank if there is none
      character(len=*), intent(out) :: unit

      integer :: i, mark

      unit = ''
      mark = index(cell, '[')
      if (mark == 0 .and. index(cell, ' (') > 0) mark = index(cell, ' (') + 1
      if (mark > 0 .and. scan(cell(max(1, len(cell)):), '])') > 0) then
         unit = adjustl(cell(mark + 1:len(cell) - 1))
      else
         mark = len(cell) + 1
      end if
      name = cell(:mark - 1)
      do i = 1, len_trim(name)
         if (name(i:i) == ' ') name(i:i) = '_'
      end do
   end subroutine take_name

   !> Raise an error about a line of a file
   subroutine complain(plain, line, message, error)
      type(plain_t), intent(in) :: plain
      integer, intent(in) :: line
      character(len=*), intent(in) :: message
      type(error_t), allocatable, intent(out) :: error

      call raise(error, error_input, plain%name//':'//integer_text(line)//': ' &
         //printable(message))
   end subroutine complain

   !> Check names, units and numbers of a relaxation modulus; the points become SI units
   subroutine check_moduli(plain, case, item, error)
      type(plain_t), intent(inout) :: plain
      type(case_t), intent(in) :: case
      !> Index of the material
      integer, intent(in) :: item
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: example = ", expected names such as 'time [s]," &
         //"relaxation_modulus [Pa]'"
      character(len=7), parameter :: what(2) = ['time   ', 'modulus']
      character(len=:), allocatable :: kind, message
      real(wp) :: scale(2)
      integer :: i

      call case%get('material', 'modulus_kind', kind, item)
      if (plain%head > 0) then
         if (.not. contains_word(time_names, lower(trim(plain%names(1)))) &
             .or. plain%names(1) == 'T') then
            message = "found '"//trim(plain%names(1))//"'"//example//plain%advice
         else if (contains_word(shear_names, lower(trim(plain%names(2))))) then
            if (kind /= 'shear') message = "found '"//trim(plain%names(2))//"', a shear " &
               //"modulus, expected a relaxation modulus E: give modulus_kind = 'shear' in its " &
               //'&material group, which makes E = 2 (1 + nu) G of it'
         else if (contains_word(tensile_names, lower(trim(plain%names(2))))) then
            if (kind == 'shear') message = "found '"//trim(plain%names(2))//"', a tensile " &
               //"modulus, but the case has modulus_kind = 'shear'"
         else if (.not. contains_word(neutral_names, lower(trim(plain%names(2))))) then
            message = "found '"//trim(plain%names(2))//"'"//example//plain%advice
         end if
         if (allocated(message)) call complain(plain, plain%head, message, error)
      end if
      do i = 1, 2
         if (.not. allocated(error)) call find_unit(trim(what(i)))
      end do
      if (allocated(error)) return
      do i = 1, size(plain%lines)
         call check_point(plain%points(:, :i), scale, plain%lines(:i), message)
         if (.not. allocated(message)) cycle
         call complain(plain, plain%lines(i), message, error)
         return
      end do
      plain%points(1, :) = plain%points(1, :)*scale(1)
      plain%points(2, :) = plain%points(2, :)*scale(2)

   contains

      !> Find the unit of a column, by its name or by the key of the case
      subroutine find_unit(what)
         !> `time` or `modulus`
         character(len=*), intent(in) :: what

         character(len=:), allocatable :: key, stated, unit

         stated = trim(plain%units(i))
         if (stated == 'N/mm2') stated = 'MPa'
         call case%get('material', what//'_unit', key, item)
         unit = stated
         if (unit == '') unit = key
         scale(i) = unit_size(what, unit)
         if (stated == '' .and. key == '') then
            call complain(plain, max(1, plain%head), 'found no unit of the '//what//', expected ' &
               //"a first line such as 'time [s],relaxation_modulus [Pa]', or "//what//'_unit in ' &
               //'the &material group'//plain%advice, error)
         else if (.not. scale(i) > 0.0_wp) then
            call complain(plain, plain%head, "found '"//stated//"' as unit of the "//what &
               //', expected one of '//trim(merge('ns, us, ms, s, min, h', &
               'Pa, kPa, MPa, GPa    ', what == 'time'))//plain%advice, error)
         else if (stated /= '' .and. key /= '' .and. stated /= key) then
            call complain(plain, plain%head, "found '"//stated//"' as unit of the "//what &
               //', but the case has '//what//"_unit = '"//key//"': leave that out", error)
         end if
      end subroutine find_unit
   end subroutine check_moduli

   !> Size of a unit
   pure function unit_size(what, unit) result(scale)
      !> `time` or `modulus`
      character(len=*), intent(in) :: what
      character(len=*), intent(in) :: unit
      !> In s or Pa; 0 if it is not known
      real(wp) :: scale

      character(len=*), parameter :: times(*) = [character(len=3) :: 'ns', 'us', 'ms', 's', 'min', &
         'h'], moduli(*) = [character(len=3) :: 'Pa', 'kPa', 'MPa', 'GPa']
      real(wp), parameter :: seconds(0:*) = [0.0_wp, 1.0e-9_wp, 1.0e-6_wp, 1.0e-3_wp, 1.0_wp, &
         60.0_wp, 3600.0_wp], pascals(0:*) = [0.0_wp, 1.0_wp, 1.0e3_wp, 1.0e6_wp, 1.0e9_wp]

      if (what == 'time') then
         scale = seconds(findloc(times == unit, .true., dim=1))
      else
         scale = pascals(findloc(moduli == unit, .true., dim=1))
      end if
   end function unit_size

   !> Check the last point of a relaxation modulus
   pure subroutine check_point(points, scale, lines, message)
      !> Times and moduli in their units, shape (2, n)
      real(wp), intent(in) :: points(:, :)
      !> These units [s, Pa]
      real(wp), intent(in) :: scale(2)
      !> Their lines, shape (n)
      integer, intent(in) :: lines(:)
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      character(len=*), parameter :: what(2) = [character(len=7) :: 'time', 'modulus']
      integer :: i, n

      n = size(lines)
      do i = 1, 2
         associate (value => points(i, n))
            if (value*scale(i) >= smallest_value .and. value*scale(i) <= largest_value) cycle
            message = 'found '//real_text(value)//', expected a '//trim(what(i))//' > 0'
            if (value > 0.0_wp) message = message//', between '//real_text(smallest_value) &
               //' and '//real_text(largest_value)//' in units of the SI'
            return
         end associate
      end do
      if (n == 1) return
      associate (before => points(:, n - 1), point => points(:, n))
         if (.not. point(1) > before(1)) then
            message = 'found time '//real_text(point(1))//' after '//real_text(before(1)) &
               //' in line '//integer_text(lines(n - 1))//', expected times that increase'
         else if (.not. point(2) <= before(2)*(1.0_wp + modulus_rounding)) then
            message = 'found modulus '//real_text(point(2))//' after '//real_text(before(2)) &
               //' in line '//integer_text(lines(n - 1))//', expected moduli that fall: a ' &
               //'relaxation modulus never grows with time; for data with noise fit a model ' &
               //'with vcor fit'
         end if
      end associate
   end subroutine check_point

   !> Check names, units and numbers of the modes of a structure; the columns become frequency [Hz],
   !> damping ratio [-] and modal mass [kg], infinite on a node
   subroutine check_modes(plain, error)
      type(plain_t), intent(inout) :: plain
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: example = ", expected 'frequency [Hz],damping_ratio," &
         //"modal_mass [kg]', or mode_shape [kg^-0.5] in place of the mass"
      character(len=:), allocatable :: message
      real(wp), allocatable :: points(:, :)
      integer :: i, j, column(3), rigid
      logical :: is_shape

      column = 0
      is_shape = .false.
      if (plain%head == 0) message = 'found numbers without names'//example
      j = 0
      do i = 1, plain%columns
         if (allocated(message)) exit
         select case (lower(trim(plain%names(i))))
         case ('frequency')
            j = 1
            if (plain%units(i) /= 'Hz') message = unit_message('Hz')
         case ('damping_ratio')
            j = 2
            if (all(plain%units(i) /= [' ', '1'])) message = unit_message('1')
         case ('modal_mass')
            j = 3
            if (plain%units(i) /= 'kg') message = unit_message('kg')
         case ('mode_shape')
            j = 3
            is_shape = .true.
            if (plain%units(i) /= 'kg^-0.5') message = unit_message('kg^-0.5')
         case default
            message = "found '"//trim(plain%names(i))//"'"//example
         end select
         if (allocated(message)) exit
         if (column(j) > 0) message = "found '"//trim(plain%names(i))//"' after '" &
            //trim(plain%names(column(j)))//"'"//example
         column(j) = i
      end do
      if (allocated(message)) then
         call complain(plain, max(1, plain%head), message, error)
         return
      end if
      points = plain%points(column, :)
      rigid = 0
      do i = 1, size(plain%lines)
         if (.not. (points(1, i) >= 0.0_wp .and. points(1, i) <= most_magnitude)) then
            message = 'found '//real_text(points(1, i))//', expected a frequency >= 0'
         else if (.not. (points(2, i) >= 0.0_wp .and. points(2, i) < 1.0_wp)) then
            message = 'found '//real_text(points(2, i))//', expected a damping ratio in [0, 1)'
         else if (.not. is_shape .and. .not. (points(3, i) > 0.0_wp &
                  .and. points(3, i) <= most_magnitude)) then
            message = 'found '//real_text(points(3, i))//', expected a modal mass > 0'
         else if (.not. abs(points(3, i)) <= most_magnitude) then
            message = 'found '//real_text(points(3, i))//', expected the shape of a mode, ' &
               //'normalised by its mass'
         else if (.not. points(1, i) > 0.0_wp) then
            rigid = rigid + 1
            if (rigid > 2) message = 'found a third mode of frequency 0, expected at most two: ' &
               //'the struck point moves along one line, and turns with the body'
         end if
         if (allocated(message)) then
            call complain(plain, plain%lines(i), message, error)
            return
         end if
         if (is_shape) points(3, i) = 1.0_wp/max(points(3, i)**2, tiny(1.0_wp))
      end do
      call move_alloc(points, plain%points)

   contains

      !> Message about a unit
      function unit_message(unit) result(text)
         !> Expected one
         character(len=*), intent(in) :: unit
         character(len=:), allocatable :: text

         text = "found '"//trim(plain%units(i))//"' as unit of "//trim(plain%names(i)) &
            //', expected '//unit
         if (plain%units(i) == '') text = 'found no unit of '//trim(plain%names(i)) &
            //', expected ['//unit//']'
      end function unit_message
   end subroutine check_modes

   !> Check names, units and numbers of a table of shift factors; the temperatures become K and rise
   subroutine check_shift(plain, error)
      type(plain_t), intent(inout) :: plain
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: example = ", expected a temperature and log10 of the shift " &
         //"factor under 'temperature [K],log10_shift_factor [1]'"
      character(len=:), allocatable :: message, unit
      integer :: i, n

      unit = trim(plain%units(1))
      if (plain%head == 0) then
         message = 'found numbers without names'//example//plain%advice
      else if (.not. contains_word(temperature_names, trim(plain%names(1))) &
               .or. .not. contains_word(shift_names, lower(trim(plain%names(2)))) &
               .or. all(plain%units(2) /= [' ', '1'])) then
         message = "found '"//trim(plain%names(1))//","//trim(plain%names(2))//"'"//example &
            //plain%advice
      else if (contains_word(celsius_names, unit) .and. unit /= '') then
         plain%points(1, :) = plain%points(1, :) + ice_point
      else if (unit /= kelvin_names) then
         message = "found '"//unit//"' as unit of the temperatures, expected K or C, as in " &
            //'temperature [C]'//plain%advice
      end if
      if (allocated(message)) then
         call complain(plain, max(1, plain%head), message, error)
         return
      end if
      do i = 1, size(plain%lines)
         call compare_shifts(plain%points(:, :i), message)
         if (.not. allocated(message)) cycle
         call complain(plain, plain%lines(i), message, error)
         return
      end do
      n = size(plain%lines)
      if (plain%points(1, 2) < plain%points(1, 1)) plain%points = plain%points(:, n:1:-1)
   end subroutine check_shift

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
