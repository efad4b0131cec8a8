!> Reads data files from which materials are identified: relaxation moduli over time, or storage and
!> loss moduli (or storage or complex modulus and loss tangent) over frequency
!>
!> The head of a file is everything before the first line of numbers. It may be
!>
!>  - empty: two columns are time and relaxation modulus, three are angular frequency, storage and
!>    loss modulus, in SI units;
!>  - a line of names, with or without units: `t [s], E [MPa]`;
!>  - a line of names and one of units: `t;E`, `s;MPa`;
!>  - comments with the units, as vcor writes them, and a line of names: `# time [s] ...`,
!>    `# E [Pa] ...`, `time,E`;
!>  - names after `##`, as NETZSCH writes them: `##Temp./C;f/Hz;E'/MPa;E"/MPa`;
!>  - other lines, and then names and units, as TRIOS writes them: `[step]`, `Frequency sweep`,
!>    `Angular frequency<tab>Storage modulus<tab>Loss modulus`, `rad/s<tab>Pa<tab>Pa`.
!>
!> What the user specifies overrides the head. The samples are tensile moduli in SI units, in
!> increasing order of time or frequency.
module vcor_io_sample_file
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_io_columns, only : decimals_t, lines_in, most_columns, not_a_text, read_value, &
      row_t
   use vcor_io_file, only : read_text_file
   use vcor_io_header, only : angular_units, check_unit, header_t, known_roles => roles, &
      longest_word, name_of, names_columns, note_comment, read_names, read_units, &
      role_complex, role_frequency, role_loss, role_none, role_of, role_relaxation, role_storage, &
      role_tangent, role_time, temperature_names, time_units, unit_size
   use vcor_kinds, only : wp
   use vcor_fit_samples, only : samples_t
   use vcor_number, only : real_text
   use vcor_text, only : has_control, integer_text, printable, shortened
   use vcor_words, only : contains_word
   implicit none
   private

   public :: read_samples, read_samples_text, reading_t, standard_input

   !> Name of the standard input
   character(len=*), parameter :: standard_input = "-"

   !> What the user specifies about the columns
   type :: reading_t
      !> Units of the columns, one word each, blank for one that the file states; shape (0), (2) or
      !> (3)
      character(len=longest_word), allocatable :: units(:)
      logical :: shear = .false.
      !> Poisson's ratio [-]; above 0.5: unknown
      real(wp) :: poisson_ratio = 1.0_wp
   end type reading_t

   !> Columns to read
   type :: plan_t
      !> Number of columns of each line
      integer :: columns = 0
      !> Columns of time or frequency and of one or two moduli, shape (2) or (3)
      integer, allocatable :: places(:)
      !> Their roles
      integer, allocatable :: roles(:)
      !> Their units
      character(len=longest_word), allocatable :: units(:)
      logical :: shear = .false.
      !> Decimal points or commas
      type(decimals_t) :: decimals
   end type plan_t

contains

   !> Read samples from a file
   subroutine read_samples(samples, filename, reading, note, place, error)
      !> The samples, of tensile moduli in SI units
      type(samples_t), intent(out) :: samples
      !> Name of the file; `-` is the standard input
      character(len=*), intent(in) :: filename
      !> What the user specifies
      type(reading_t), intent(in) :: reading
      !> How the file was read, in words
      character(len=:), allocatable, intent(out) :: note
      !> File and lines of the numbers, `data.csv:3-42`, for messages about all of them
      character(len=:), allocatable, intent(out) :: place
      !> Error of code `error_file` if the file cannot be read, `error_input` if its contents are
      !> wrong, `error_usage` if the user must specify more; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: expected = "a file of moduli over time or frequency"
      character(len=:), allocatable :: name, text

      if (filename == standard_input) then
         name = "stdin"
         call read_text_file("/dev/stdin", text, error, kind=expected)
      else
         name = filename
         call read_text_file(filename, text, error, kind=expected)
      end if
      if (.not. allocated(error)) &
         call read_samples_text(samples, text, name, reading, note, place, error)
   end subroutine read_samples

   !> Read samples from the text of a file
   subroutine read_samples_text(samples, text, source, reading, note, place, error)
      !> The samples, of tensile moduli in SI units
      type(samples_t), intent(out) :: samples
      character(len=*), intent(in) :: text
      !> Name of the file, for messages
      character(len=*), intent(in) :: source
      !> What the user specifies
      type(reading_t), intent(in) :: reading
      !> How the file was read, in words
      character(len=:), allocatable, intent(out) :: note
      !> File and lines of the numbers
      character(len=:), allocatable, intent(out) :: place
      !> Error of code `error_input` or `error_usage` as from `read_samples`
      type(error_t), allocatable, intent(out) :: error

      type(plan_t) :: plan
      character(len=:), allocatable :: name
      real(wp), allocatable :: points(:, :)
      integer :: lines(2), n

      name = printable(source)
      call read_points(text, name, reading, plan, points, n, lines, error)
      if (allocated(error)) return
      if (plan%shear .and. reading%poisson_ratio > 0.5_wp) then
         call raise(error, error_usage, name//": found shear moduli, which become " &
            //"tensile ones, E = 2 (1 + nu) G, by Poisson's ratio: give --poisson-ratio")
         return
      end if

      samples%dynamic = plan%roles(1) == role_frequency
      allocate (samples%at(n), samples%modulus(n), samples%loss(merge(n, 0, samples%dynamic)))
      samples%at = points(1, :n)*unit_size(trim(plan%units(1)))
      samples%modulus = points(2, :n)*unit_size(trim(plan%units(2)))
      if (samples%dynamic) samples%loss = points(3, :n)*unit_size(trim(plan%units(3)))
      ! |E*| = E' sqrt(1 + tan(delta)^2), E'' = E' tan(delta)
      if (plan%roles(2) == role_complex) samples%modulus &
         = samples%modulus/hypot(1.0_wp, samples%loss)
      if (plan%roles(size(plan%roles)) == role_tangent) samples%loss = samples%loss*samples%modulus
      if (plan%shear) then
         samples%modulus = 2.0_wp*(1.0_wp + reading%poisson_ratio)*samples%modulus
         samples%loss = 2.0_wp*(1.0_wp + reading%poisson_ratio)*samples%loss
      end if
      note = described(plan, n)
      place = name//":"//integer_text(lines(1))//"-"//integer_text(lines(2))
      samples%keys = keys_in(text)
   end subroutine read_samples_text

   !> Keys for the &material group in comments of a file, `# &material shift = 'wlf', ...`
   function keys_in(text) result(keys)
      character(len=*), intent(in) :: text
      !> A line for each of these comments
      character(len=:), allocatable :: keys

      character(len=*), parameter :: mark = "&material "
      character(len=:), allocatable :: remark
      type(row_t) :: row

      keys = ""
      do
         call row%take(text)
         if (.not. row%is_there) exit
         remark = adjustl(row%comment)
         if (index(remark, mark) == 1) &
            keys = keys//"   "//printable(trim(remark(len(mark) + 1:)))//new_line("a")
      end do
   end function keys_in

   !> How a file was read, in words
   pure function described(plan, n) result(text)
      type(plan_t), intent(in) :: plan
      integer, intent(in) :: n
      character(len=:), allocatable :: text

      integer :: i

      text = integer_text(n)//" points of "
      do i = 1, size(plan%roles)
         if (i > 1) text = text//", "
         if (i > 1 .and. plan%shear .and. plan%roles(i) /= role_tangent) text = text//"shear "
         text = text//name_of(plan%roles(i), plan%units(i))//" ["//trim(plan%units(i))//"]"
      end do
      if (plan%decimals%commas) text = text//", with decimal commas"
   end function described

   !> Read the points
   subroutine read_points(text, name, reading, plan, points, n, lines, error)
      character(len=*), intent(in) :: text
      character(len=*), intent(in) :: name
      !> What the user specifies
      type(reading_t), intent(in) :: reading
      type(plan_t), intent(out) :: plan
      !> Points, shape (2 or 3, >= n)
      real(wp), allocatable, intent(out) :: points(:, :)
      !> Number of points, >= 2
      integer, intent(out) :: n
      !> Their first and last line
      integer, intent(out) :: lines(2)
      type(error_t), allocatable, intent(out) :: error

      type(header_t) :: header
      type(row_t) :: row
      character(len=:), allocatable :: found

      n = 0
      call read_head(text, name, row, header, error)
      if (.not. allocated(error)) &
         call read_numbers(text, name, header, reading, row, plan, points, n, lines, error)
      if (allocated(error) .or. n >= 2) return
      found = "found no numbers"
      if (n == 1) found = "found one row of numbers"
      call raise(error, error_input, name//":"//integer_text(max(1, row%line))//": "//found &
         //", expected two rows at least, of time and modulus or of frequency, storage and loss " &
         //"modulus")
   end subroutine read_points

   !> Read the head, everything before the first line of numbers
   subroutine read_head(text, name, row, header, error)
      character(len=*), intent(in) :: text
      character(len=*), intent(in) :: name
      !> The first line of numbers, if any
      type(row_t), intent(out) :: row
      type(header_t), intent(out) :: header
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: names_line, i

      names_line = line_of_names(text)
      do
         call row%take(text)
         if (.not. row%is_there) return
         if (has_control(row%content)) then
            call raise(error, error_input, name//":"//integer_text(row%line)//": "//not_a_text)
            return
         end if
         if (header%lines == 0) call note_comment(header, row%comment)
         if (row%line == names_line) &
            call read_names(header, names_in(row%content, row%comment), row%line)
         if (row%line <= names_line .or. row%columns == 0) cycle
         if (header%lines == 2 .or. row%columns > most_columns) return
         if (any(row%is_numeric([(i, i=1, row%columns)]))) return
         if (header%lines == 0) then
            ! no name is known
            call read_names(header, row%content, row%line)
         else
            call read_units(header, row%content, row%line)
         end if
      end do
   end subroutine read_head

   !> Read the numbers, in increasing order of time or frequency
   subroutine read_numbers(text, name, header, reading, row, plan, points, n, lines, error)
      character(len=*), intent(in) :: text
      character(len=*), intent(in) :: name
      !> The head
      type(header_t), intent(in) :: header
      !> What the user specifies
      type(reading_t), intent(in) :: reading
      !> First line of numbers; on return the end of the text
      type(row_t), intent(inout) :: row
      type(plan_t), intent(out) :: plan
      !> Points, shape (2 or 3, >= n)
      real(wp), allocatable, intent(out) :: points(:, :)
      !> Number of points
      integer, intent(out) :: n
      !> Their first and last line
      integer, intent(out) :: lines(2)
      !> Error of code `error_input` or `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: message, temperature
      !> Column of the temperature; 0: none
      integer :: temperature_column
      !> Whether frequencies decrease
      logical :: is_descending
      integer :: i

      allocate (points(3, lines_in(text)))
      is_descending = .false.
      temperature_column = 0
      temperature = ""
      lines = 0
      n = 0
      do while (row%is_there)
         if (row%columns > 0) then
            call row%check(message)
            if (n == 0 .and. .not. allocated(message)) then
               call make_plan(header, row%columns, reading, name, row%line, plan, error)
               if (allocated(error)) return
               lines(1) = row%line
               temperature_column = findloc([(all(plan%places /= i) .and. &
                  contains_word(temperature_names, header%columns(i)%name), &
                  i=1, header%count)], .true., dim=1)
            end if
            if (.not. allocated(message)) call read_point(row, plan, points(:, n + 1), message)
            if (.not. allocated(message) .and. n > 0) then
               ! instruments sweep frequencies up or down
               if (n == 1) is_descending = plan%roles(1) == role_frequency &
                  .and. points(1, 2) < points(1, 1)
               call check_order(plan, points(1, n:n + 1), lines(2), is_descending, message)
               if (allocated(message) .and. temperature_column > 0) then
                  if (row%cell(temperature_column) /= temperature) message = "found several " &
                     //"temperatures, "//temperature//" and "//row%cell(temperature_column) &
                     //", expected one; vcor master makes one curve of them"
               end if
            end if
            if (allocated(message)) then
               call raise(error, error_input, name//":"//integer_text(row%line)//": "//message)
               return
            end if
            n = n + 1
            lines(2) = row%line
            if (temperature_column > 0) temperature = row%cell(temperature_column)
         end if
         call row%take(text)
      end do
      plan%decimals = row%so_far
      if (is_descending) points(:, :n) = points(:, n:1:-1)
   end subroutine read_numbers

   !> Read the numbers of a line
   subroutine read_point(row, plan, point, message)
      type(row_t), intent(in) :: row
      type(plan_t), intent(in) :: plan
      !> The numbers, followed by 0, shape (3)
      real(wp), intent(out) :: point(:)
      !> Message on failure, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      integer :: i

      point = 0.0_wp
      if (row%columns /= plan%columns) then
         message = "found "//columns_text(row%columns)//", expected " &
            //integer_text(plan%columns)//" as before"
         return
      end if
      do i = 1, size(plan%places)
         call read_value(row%cell(plan%places(i)), name_of(plan%roles(i), plan%units(i)), &
            unit_size(trim(plan%units(i))), point(i), message)
         if (allocated(message)) return
      end do
   end subroutine read_point

   !> Check that times increase, and that frequencies increase or decrease
   subroutine check_order(plan, pair, line, is_descending, message)
      type(plan_t), intent(in) :: plan
      !> Times or frequencies of a line and of the next one
      real(wp), intent(in) :: pair(2)
      !> Number of the first of these lines
      integer, intent(in) :: line
      !> Whether they must decrease
      logical, intent(in) :: is_descending
      !> Message if they do not, otherwise unallocated
      character(len=:), allocatable, intent(out) :: message

      if (merge(pair(2) < pair(1), pair(2) > pair(1), is_descending)) return
      message = "found "//name_of(plan%roles(1), "")//" "//real_text(pair(2))//" after " &
         //real_text(pair(1))//" in line "//integer_text(line)//", expected them to " &
         //trim(merge("decrease as before", "increase          ", is_descending))
   end subroutine check_order

   !> Line of the names of columns: the last one with a known name before the numbers
   function line_of_names(text) result(found)
      character(len=*), intent(in) :: text
      !> Number of the line; 0 if there is none
      integer :: found

      type(row_t) :: row
      integer :: i

      found = 0
      do
         call row%take(text)
         if (.not. row%is_there) exit
         if (names_columns(names_in(row%content, row%comment))) found = row%line
         if (row%columns < 2) cycle
         if (all(row%is_numeric([(i, i=1, min(row%columns, most_columns))]))) exit
      end do
   end function line_of_names

   !> Part of a line that may name columns: its content, or the text after ##
   pure function names_in(content, comment) result(text)
      !> The line without its comment
      character(len=*), intent(in) :: content
      !> The comment, without its #
      character(len=*), intent(in) :: comment
      !> The words
      character(len=:), allocatable :: text

      text = content
      if (content == "" .and. index(comment, "#") == 1) text = comment(2:)
   end function names_in

   !> Choose the columns to read, their roles and units
   subroutine make_plan(header, columns, reading, name, line, plan, error)
      !> The head
      type(header_t), intent(in) :: header
      !> Number of columns of the first line of numbers
      integer, intent(in) :: columns
      !> What the user specifies
      type(reading_t), intent(in) :: reading
      character(len=*), intent(in) :: name
      !> First line of numbers
      integer, intent(in) :: line
      type(plan_t), intent(out) :: plan
      !> Error of code `error_input` or `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=longest_word) :: units(most_columns), word
      character(len=:), allocatable :: place, head
      integer :: roles(most_columns), i
      logical :: shear(most_columns), told

      place = name//":"//integer_text(line)
      head = place
      if (header%lines > 0) head = name//":"//integer_text(header%line)
      if (columns > most_columns .or. columns < 2 &
         .or. (header%lines > 0 .and. columns /= header%count)) then
         call raise(error, error_input, place//": found "//columns_text(columns)//", " &
            //expected_of(header, columns))
         return
      end if
      plan%columns = columns
      roles = role_none
      units = ""
      shear = .false.
      do i = 1, header%count
         call role_of(header%columns(i), roles(i), shear(i), units(i))
      end do
      call choose_frequency(reading, units, roles)
      if (size(reading%units) > 0) then
         i = merge(role_time, role_frequency, contains_word(time_units, reading%units(1)))
         if (any(roles == merge(role_frequency, role_time, i == role_time)) &
            .and. all(roles /= i)) then
            call raise(error, error_usage, "--units: found '"//trim(reading%units(1)) &
               //"', but "//name//" has "//name_of(merge(role_frequency, role_time, &
               i == role_time), "")//" in its first column")
            return
         end if
         if (all(roles == role_none)) roles(1) = i
      end if
      call choose_columns(roles(:columns), plan)
      if (size(reading%units) > 0 .and. allocated(plan%places)) then
         if (size(reading%units) /= size(plan%places)) deallocate (plan%places)
      end if
      if (.not. allocated(plan%places)) then
         call raise(error, error_input, head//": found "//integer_text(columns) &
            //" columns that are not understood, expected time and relaxation modulus, or " &
            //"frequency, storage and loss modulus; a header such as t,E or omega,E_stor,E_loss " &
            //"tells which is which"//lacking(roles(:columns)))
         return
      end if
      if (header%lines > 0) then
         call check_names(header, roles(:columns), units, size(reading%units) > 0, plan, head, &
            error)
         if (allocated(error)) return
      end if

      plan%shear = reading%shear .or. any(shear(plan%places))
      allocate (plan%units(size(plan%places)))
      ! if a header states one unit, units that it omits are not assumed to be SI
      told = header%lines > 1 .or. any(header%columns(plan%places)%unit /= "" &
         .and. plan%roles /= role_tangent)
      do i = 1, size(plan%places)
         word = units(plan%places(i))
         if (size(reading%units) > 0) then
            if (reading%units(i) /= "" .and. plan%roles(i) /= role_tangent) then
               if (word /= "" .and. word /= reading%units(i) &
                  .and. header%columns(plan%places(i))%unit /= "") then
                  call raise(error, error_usage, "--units: found '"//trim(reading%units(i)) &
                     //"', but "//name//":"//integer_text(header%columns(plan%places(i))%line) &
                     //" says '"//trim(word)//"'; leave --units away, or correct the file")
                  return
               end if
               word = reading%units(i)
            end if
         end if
         if (word == "" .and. plan%roles(i) == role_frequency .and. header%lines > 0) then
            call raise(error, error_usage, head//": the unit of '" &
               //shortened(trim(header%columns(plan%places(i))%name)) &
               //"' is not told: give --units, such as Hz,Pa,Pa or rad/s,Pa,Pa")
            return
         end if
         if (word == "" .and. told .and. plan%roles(i) /= role_tangent) then
            call raise(error, error_input, name//":" &
               //integer_text(maxval(header%columns(:columns)%line))//": found no unit of '" &
               //shortened(trim(header%columns(plan%places(i))%name))//"', a " &
               //name_of(plan%roles(i), "")//", though others have one; expected one for each, " &
               //"or --units")
            return
         end if
         if (word == "") word = known_roles(plan%roles(i))%unit
         place = name
         if (header%lines > 0) place = name//":" &
            //integer_text(header%columns(plan%places(i))%line)
         call check_unit(word, plan%roles(i), place, error)
         if (allocated(error)) return
         plan%units(i) = word
      end do
   end subroutine make_plan

   !> If both frequency and angular frequency are there, which are equivalent, keep one: that in the
   !> unit of the user, otherwise the angular one
   pure subroutine choose_frequency(reading, units, roles)
      !> What the user specifies
      type(reading_t), intent(in) :: reading
      !> Units of the columns, shape (n)
      character(len=*), intent(in) :: units(:)
      !> Roles of the columns, shape (n)
      integer, intent(inout) :: roles(:)

      logical :: kept(size(roles))
      integer :: i

      if (count(roles == role_frequency) < 2) return
      kept = [(contains_word(angular_units, units(i)), i=1, size(roles))]
      if (size(reading%units) > 0) kept = units == reading%units(1)
      kept = kept .and. roles == role_frequency
      if (any(kept)) where (roles == role_frequency .and. .not. kept) roles = role_none
   end subroutine choose_frequency

   !> Refuse a header that does not identify the columns to read
   subroutine check_names(header, roles, units, told, plan, head, error)
      type(header_t), intent(in) :: header
      !> Role of each column, as far as the header states it, shape (n)
      integer, intent(in) :: roles(:)
      !> Their units, shape (>= n)
      character(len=*), intent(in) :: units(:)
      !> Whether the user specifies the units
      logical, intent(in) :: told
      !> Columns to read
      type(plan_t), intent(in) :: plan
      !> File and line of the header, for messages
      character(len=*), intent(in) :: head
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      do i = 1, size(plan%places)
         associate (place => plan%places(i))
            if (count(roles == plan%roles(i)) > 1) then
               call raise(error, error_input, head//": found "//columns_text(count(roles &
                  == plan%roles(i)))//" of "//name_of(plan%roles(i), "")//", expected one")
            else if (roles(place) == role_none &
               .and. index(header%columns(place)%name, "*") > 0) then
               ! another name of a complex modulus or a complex viscosity
               call raise(error, error_input, head//": found '" &
                  //shortened(trim(header%columns(place)%name))//"' as name of a column, " &
                  //"expected one such as "//trim(known_roles(plan%roles(i))%example))
            else if (roles(place) == role_none .and. units(place) == "" .and. .not. told) then
               ! the place is not enough: the column may be the logarithm of a modulus
               call raise(error, error_input, head//": found '" &
                  //shortened(trim(header%columns(place)%name))//"' as name of a column, " &
                  //"expected one such as "//trim(known_roles(plan%roles(i))%example) &
                  //", a unit beside it, or --units")
            end if
         end associate
         if (allocated(error)) return
      end do
   end subroutine check_names

   !> Choose the columns to read: by their roles or, of two or three columns, by their places
   pure subroutine choose_columns(roles, plan)
      !> Role of each column, as far as it is known
      integer, intent(in) :: roles(:)
      !> The plan; its places are unallocated if there is no choice
      type(plan_t), intent(inout) :: plan

      logical :: dynamic
      integer :: i

      dynamic = any(roles == role_frequency)
      if (.not. dynamic .and. all(roles /= role_time)) dynamic = size(roles) > 2
      if (dynamic) then
         plan%roles = [role_frequency, role_storage, role_loss]
         if (all(roles /= role_loss) .and. any(roles == role_tangent)) plan%roles(3) = role_tangent
         if (all(roles /= role_storage) .and. any(roles == role_complex) &
            .and. any(roles == role_tangent)) plan%roles(2:) = [role_complex, role_tangent]
      else
         plan%roles = [role_time, role_relaxation]
      end if
      if (all([(any(roles == plan%roles(i)), i=1, size(plan%roles))])) then
         plan%places = [(findloc(roles, plan%roles(i), dim=1), i=1, size(plan%roles))]
      else if (size(roles) == size(plan%roles)) then
         if (all(roles == role_none .or. roles == plan%roles)) &
            plan%places = [(i, i=1, size(roles))]
      end if
   end subroutine choose_columns

   !> Message about a storage or loss modulus that is missing beside the other
   pure function lacking(roles) result(text)
      !> Role of each column
      integer, intent(in) :: roles(:)
      !> In words; may be empty
      character(len=:), allocatable :: text

      logical :: loss

      text = ""
      loss = any(roles == role_loss .or. roles == role_tangent)
      if (any(roles == role_storage) .and. .not. loss) text = "; there is no loss modulus"
      if (loss .and. all(roles /= role_storage)) text = "; there is no storage modulus"
      if (any(roles == role_complex) .and. all(roles /= role_tangent)) text &
         = "; a complex modulus needs the loss tangent beside it"
   end function lacking

   !> Number of columns in words
   pure function columns_text(columns) result(text)
      integer, intent(in) :: columns
      !> `2 columns`
      character(len=:), allocatable :: text

      text = integer_text(columns)//" column"
      if (columns /= 1) text = text//"s"
   end function columns_text

   !> What is expected of the number of columns, by the header if there is one
   pure function expected_of(header, columns) result(text)
      type(header_t), intent(in) :: header
      !> Number of columns of the first line of numbers
      integer, intent(in) :: columns
      character(len=:), allocatable :: text

      text = "expected 2, a time and a modulus, or 3, a frequency, a storage and a loss modulus"
      if (header%lines == 0 .or. columns == header%count) return
      text = "but the header has "//integer_text(header%count)
      if (columns > header%count .and. columns <= 2*header%count) text = text//" (with decimal " &
         //"commas expected semicolons or tabs between them)"
   end function expected_of

end module vcor_io_sample_file
