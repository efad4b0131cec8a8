!> Data files that materials are identified from: relaxation moduli over time, or storage and loss
!> moduli over frequency
!>
!> With a header of names, and units in it or in a second line, or without. Where nothing tells, two
!> columns are time and relaxation modulus, three are angular frequency, storage and loss modulus,
!> and units are those of the SI. What is read becomes tensile moduli in SI units.
module vcor_io_sample_file
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_io_columns, only : lines_in, split, start_of, take_line
   use vcor_io_header, only : check_unit, header_t, longest_word, most_columns, note_comment, &
      read_names, read_units, role_frequency, role_loss, role_none, role_of, role_relaxation, &
      role_storage, role_time
   use vcor_io_real, only : looks_numeric, read_real
   use vcor_io_text_file, only : read_text_file
   use vcor_kinds, only : wp
   use vcor_material_fit_samples, only : samples_t
   use vcor_material_table, only : largest_value, smallest_value
   use vcor_study_text, only : integer_text, printable, real_text, shortened
   use vcor_study_units, only : time_units, unit_size
   use vcor_study_words, only : contains_word
   implicit none
   private

   public :: read_samples, reading_t

   !> What the user says about the columns
   type :: reading_t
      !> Units by the option, one word per column, blank for one that the file tells; shape (0), (2)
      !> or (3)
      character(len=longest_word), allocatable :: units(:)
      !> Whether the moduli are shear moduli
      logical :: shear = .false.
      !> Poisson's ratio [-]; beyond 0.5: not given
      real(wp) :: poisson_ratio = 1.0_wp
   end type reading_t

   !> Columns that are read
   type :: plan_t
      !> Number of columns in each line
      integer :: columns = 0
      !> Places of time or frequency and one or two moduli, shape (2) or (3)
      integer, allocatable :: places(:)
      !> What these hold
      integer, allocatable :: roles(:)
      !> Their units
      character(len=longest_word), allocatable :: units(:)
      !> Whether the moduli are shear moduli
      logical :: shear = .false.
   end type plan_t

contains

   !> Read samples from a file
   subroutine read_samples(samples, filename, reading, note, error)
      !> The samples, of tensile moduli in SI units
      type(samples_t), intent(out) :: samples
      !> Name of the file
      character(len=*), intent(in) :: filename
      !> What the user says about it
      type(reading_t), intent(in) :: reading
      !> How it was understood, in words
      character(len=:), allocatable, intent(out) :: note
      !> Error of code `error_file` when the file cannot be read, `error_input` when its contents
      !> are wrong, `error_usage` when something has to be said about it; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(plan_t) :: plan
      character(len=:), allocatable :: text
      real(wp), allocatable :: points(:, :)
      integer :: n

      call read_text_file(filename, text, error, kind="a file of moduli over time or frequency")
      if (allocated(error)) return
      call read_points(text, printable(filename), reading, plan, points, n, error)
      if (allocated(error)) return
      if (plan%shear .and. reading%poisson_ratio > 0.5_wp) then
         call raise(error, error_usage, printable(filename)//": found shear moduli, which become " &
            //"tensile ones, E = 2 (1 + nu) G, by Poisson's ratio: give --poisson-ratio")
         return
      end if

      samples%dynamic = plan%roles(1) == role_frequency
      allocate (samples%at(n), samples%modulus(n), samples%loss(merge(n, 0, samples%dynamic)))
      samples%at = points(1, :n)*unit_size(trim(plan%units(1)))
      samples%modulus = points(2, :n)*unit_size(trim(plan%units(2)))
      if (samples%dynamic) samples%loss = points(3, :n)*unit_size(trim(plan%units(3)))
      if (plan%shear) then
         samples%modulus = 2.0_wp*(1.0_wp + reading%poisson_ratio)*samples%modulus
         samples%loss = 2.0_wp*(1.0_wp + reading%poisson_ratio)*samples%loss
      end if
      note = described(plan, n)
   end subroutine read_samples

   !> How a file was understood
   pure function described(plan, n) result(text)
      !> What was read
      type(plan_t), intent(in) :: plan
      !> Number of points
      integer, intent(in) :: n
      !> In words
      character(len=:), allocatable :: text

      integer :: i

      text = integer_text(n)//" points of "
      do i = 1, size(plan%roles)
         if (i > 1) text = text//", "
         if (i > 1 .and. plan%shear) text = text//"shear "
         text = text//name_of(plan%roles(i), plan%units(i))//" ["//trim(plan%units(i))//"]"
      end do
   end function described

   !> What a column holds, in words
   pure function name_of(role, unit) result(name)
      !> One of the `role_*` constants
      integer, intent(in) :: role
      !> Its unit
      character(len=*), intent(in) :: unit
      !> The name
      character(len=:), allocatable :: name

      select case (role)
      case (role_time)
         name = "time"
      case (role_frequency)
         name = "frequency"
         if (index(unit, "rad") > 0) name = "angular frequency"
      case (role_relaxation)
         name = "relaxation modulus"
      case (role_storage)
         name = "storage modulus"
      case default
         name = "loss modulus"
      end select
   end function name_of

   !> Read the points
   subroutine read_points(text, name, reading, plan, points, n, error)
      !> Contents of the file
      character(len=*), intent(in) :: text
      !> Its name for messages
      character(len=*), intent(in) :: name
      !> What the user says about it
      type(reading_t), intent(in) :: reading
      !> What was read
      type(plan_t), intent(out) :: plan
      !> Points, shape (2 or 3, >= n)
      real(wp), allocatable, intent(out) :: points(:, :)
      !> Their number, >= 2
      integer, intent(out) :: n
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(header_t) :: header
      character(len=:), allocatable :: content, comment, message
      integer :: start, line, last_line, columns, from(most_columns), to(most_columns), i
      logical :: numeric

      allocate (points(3, lines_in(text)))
      start = start_of(text)
      line = 0
      n = 0
      do while (start <= len(text))
         call take_line(text, start, content, comment)
         line = line + 1
         if (n == 0 .and. header%lines == 0) call note_comment(header, comment)
         call split(content, columns, from, to)
         if (columns == 0) cycle
         if (n == 0 .and. header%lines < 2) then
            numeric = columns > most_columns
            do i = 1, min(columns, most_columns)
               numeric = numeric .or. looks_numeric(content(from(i):to(i)))
            end do
            if (.not. numeric) then
               if (header%lines == 0) then
                  call read_names(header, content, line)
               else
                  call read_units(header, content, line)
               end if
               cycle
            end if
         end if
         if (n == 0) call make_plan(header, columns, reading, name, line, plan, error)
         if (allocated(error)) return
         if (columns /= plan%columns) then
            message = "found "//integer_text(columns)//" column"//trim(merge("s", " ", &
               columns > 1))//", expected "//integer_text(plan%columns)//" as before"
         else
            call read_point(content, from, to, plan, points(:, n + 1), message)
            if (.not. allocated(message) .and. n > 0) then
               if (.not. points(1, n + 1) > points(1, n)) message = "found " &
                  //name_of(plan%roles(1), "")//" "//real_text(points(1, n + 1))//" after " &
                  //real_text(points(1, n))//" in line "//integer_text(last_line) &
                  //", expected them to increase"
            end if
         end if
         if (allocated(message)) then
            call raise(error, error_input, name//":"//integer_text(line)//": "//message)
            return
         end if
         n = n + 1
         last_line = line
      end do
      if (n >= 2) return
      message = "found no numbers"
      if (n == 1) message = "found one row of numbers"
      call raise(error, error_input, name//":"//integer_text(max(1, line))//": "//message &
         //", expected two rows at least, of time and modulus or of frequency, storage and loss " &
         //"modulus")
   end subroutine read_points

   !> Read one point
   subroutine read_point(content, from, to, plan, point, message)
      !> The line
      character(len=*), intent(in) :: content
      !> Where the columns begin
      integer, intent(in) :: from(:)
      !> Where they end
      integer, intent(in) :: to(:)
      !> What is read
      type(plan_t), intent(in) :: plan
      !> The point, shape (2 or 3 of 3)
      real(wp), intent(out) :: point(:)
      !> What is wrong, unallocated on success
      character(len=:), allocatable, intent(out) :: message

      character(len=:), allocatable :: expected
      real(wp) :: size_of_unit
      integer :: i

      point = 0.0_wp
      do i = 1, size(plan%places)
         expected = "a "//name_of(plan%roles(i), plan%units(i))//" > 0"
         if (expected(3:3) == "a") expected = "an"//expected(2:)
         associate (first => from(plan%places(i)), last => to(plan%places(i)))
            call read_real(content(first:last), expected, point(i), message)
         end associate
         if (allocated(message)) return
         size_of_unit = unit_size(trim(plan%units(i)))
         if (.not. point(i) > 0.0_wp) then
            message = "found "//real_text(point(i))//", expected "//expected
         else if (.not. (point(i) >= smallest_value/size_of_unit &
            .and. point(i) <= largest_value/size_of_unit)) then
            message = "found "//real_text(point(i))//", expected "//expected//", between " &
               //real_text(smallest_value)//" and "//real_text(largest_value) &
               //" in units of the SI"
         end if
         if (allocated(message)) return
      end do
   end subroutine read_point

   !> Which columns are read, as what and in which units
   subroutine make_plan(header, columns, reading, name, line, plan, error)
      !> What stands before the first number
      type(header_t), intent(in) :: header
      !> Number of columns of the first line of numbers
      integer, intent(in) :: columns
      !> What the user says
      type(reading_t), intent(in) :: reading
      !> Name of the file
      character(len=*), intent(in) :: name
      !> First line of numbers
      integer, intent(in) :: line
      !> The plan
      type(plan_t), intent(out) :: plan
      !> Error of code `error_input` or `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=longest_word) :: units(most_columns), word
      character(len=:), allocatable :: place
      integer :: roles(most_columns), i
      logical :: shear(most_columns)

      place = name//":"//integer_text(line)
      if (columns > most_columns .or. columns < 2 &
         .or. (header%lines > 0 .and. columns /= header%count)) then
         call raise(error, error_input, place//": found "//integer_text(columns) &
            //" columns, expected 2, a time and a modulus, or 3, a frequency, a storage and a " &
            //"loss modulus"//expected_of(header))
         return
      end if
      plan%columns = columns
      roles = role_none
      units = ""
      shear = .false.
      do i = 1, header%count
         call role_of(header%columns(i), roles(i), shear(i), units(i))
      end do
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
         call raise(error, error_input, place//": found "//integer_text(columns) &
            //" columns that are not understood, expected time and relaxation modulus, or " &
            //"frequency, storage and loss modulus; a header such as t,E or omega,E_stor,E_loss " &
            //"tells which is which")
         return
      end if

      plan%shear = reading%shear .or. any(shear(plan%places))
      allocate (plan%units(size(plan%places)))
      do i = 1, size(plan%places)
         word = units(plan%places(i))
         if (size(reading%units) > 0) then
            if (reading%units(i) /= "") word = reading%units(i)
         end if
         if (word == "" .and. plan%roles(i) == role_frequency .and. header%lines > 0) then
            call raise(error, error_usage, place//": the unit of '" &
               //shortened(trim(header%columns(plan%places(i))%name)) &
               //"' is not told: give --units, such as Hz,Pa,Pa or rad/s,Pa,Pa")
            return
         end if
         if (word == "") word = default_unit(plan%roles(i))
         place = name
         if (header%lines > 0) place = name//":" &
            //integer_text(header%columns(plan%places(i))%line)
         call check_unit(word, plan%roles(i), place, error)
         if (allocated(error)) return
         plan%units(i) = word
      end do
   end subroutine make_plan

   !> What a header says against the number of columns
   pure function expected_of(header) result(text)
      !> The header
      type(header_t), intent(in) :: header
      !> In words, or nothing
      character(len=:), allocatable :: text

      text = ""
      if (header%lines > 0) text = "; the header has "//integer_text(header%count)
   end function expected_of

   !> Unit of the SI
   pure function default_unit(role) result(unit)
      !> What the column holds
      integer, intent(in) :: role
      !> The unit
      character(len=5) :: unit

      select case (role)
      case (role_time)
         unit = "s"
      case (role_frequency)
         unit = "rad/s"
      case default
         unit = "Pa"
      end select
   end function default_unit

   !> Choose the columns to be read: by what they hold, or by their places where there are two or
   !> three
   pure subroutine choose_columns(roles, plan)
      !> What each column holds, as far as that is known
      integer, intent(in) :: roles(:)
      !> The plan; its places are not allocated where there is no choice
      type(plan_t), intent(inout) :: plan

      logical :: dynamic
      integer :: i

      dynamic = any(roles == role_frequency)
      if (.not. dynamic .and. all(roles /= role_time)) dynamic = size(roles) > 2
      if (dynamic) then
         plan%roles = [role_frequency, role_storage, role_loss]
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

end module vcor_io_sample_file
