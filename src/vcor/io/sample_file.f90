!> Data files that materials are identified from: relaxation moduli over time, or storage and loss
!> moduli (or the storage or complex modulus and the loss tangent) over frequency
!>
!> With a header of names, and units in it or in a second line, or without. Instruments write other
!> lines before it (TRIOS), or the header behind `##` (NETZSCH). Where nothing tells, two columns
!> are time and relaxation modulus, three are angular frequency, storage and loss modulus, and units
!> are those of the SI. What is read becomes tensile moduli in SI units, in rising order.
module vcor_io_sample_file
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_io_column_plan, only : columns_text, make_plan, plan_t, reading_t
   use vcor_io_columns, only : decimals_t, lines_in, mixed_decimals, not_a_text, read_value, &
      split, start_of, take_decimals, take_line
   use vcor_io_header, only : header_t, most_columns, name_of, names_columns, note_comment, &
      read_names, read_units, role_complex, role_frequency, role_tangent
   use vcor_case_real, only : looks_numeric
   use vcor_io_text_file, only : read_text_file
   use vcor_kinds, only : wp
   use vcor_fit_samples, only : samples_t
   use vcor_text, only : has_control, integer_text, printable, real_text
   use vcor_io_units, only : unit_size
   implicit none
   private

   public :: read_samples, reading_t, standard_input

   !> Name that means the standard input
   character(len=*), parameter :: standard_input = "-"

contains

   !> Read samples from a file
   subroutine read_samples(samples, filename, reading, note, place, error)
      !> The samples, of tensile moduli in SI units
      type(samples_t), intent(out) :: samples
      !> Name of the file; `-` is the standard input
      character(len=*), intent(in) :: filename
      !> What the user says about it
      type(reading_t), intent(in) :: reading
      !> How it was understood, in words
      character(len=:), allocatable, intent(out) :: note
      !> File and lines of the numbers, `data.csv:3-42`, for messages about all of them
      character(len=:), allocatable, intent(out) :: place
      !> Error of code `error_file` when the file cannot be read, `error_input` when its contents
      !> are wrong, `error_usage` when something has to be said about it; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=*), parameter :: expected = "a file of moduli over time or frequency"
      type(plan_t) :: plan
      character(len=:), allocatable :: name, text
      real(wp), allocatable :: points(:, :)
      integer :: lines(2), n

      if (filename == standard_input) then
         name = "stdin"
         call read_text_file("/dev/stdin", text, error, kind=expected)
      else
         name = printable(filename)
         call read_text_file(filename, text, error, kind=expected)
      end if
      if (allocated(error)) return
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
         if (i > 1 .and. plan%shear .and. plan%roles(i) /= role_tangent) text = text//"shear "
         text = text//name_of(plan%roles(i), plan%units(i))//" ["//trim(plan%units(i))//"]"
      end do
      if (plan%decimals%commas) text = text//", with decimal commas"
   end function described

   !> Read the points
   subroutine read_points(text, name, reading, plan, points, n, lines, error)
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
      !> Lines of the first and the last of them
      integer, intent(out) :: lines(2)
      !> Error, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(header_t) :: header
      type(decimals_t) :: decimals, before
      character(len=:), allocatable :: content, comment, message
      integer :: start, line, columns, from(most_columns), to(most_columns), i, names_line
      logical :: numeric, falls

      allocate (points(3, lines_in(text)))
      names_line = line_of_names(text)
      falls = .false.
      start = start_of(text)
      line = 0
      lines = 0
      n = 0
      do while (start <= len(text))
         call take_line(text, start, content, comment)
         line = line + 1
         if (n == 0 .and. header%lines == 0) call note_comment(header, comment)
         if (has_control(content)) then
            call raise(error, error_input, name//":"//integer_text(line)//": "//not_a_text)
            return
         end if
         if (line <= names_line) then
            if (line == names_line) call read_names(header, names_in(content, comment), line)
            cycle
         end if
         call take_decimals(content, decimals)
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
         before%commas = before%commas .or. decimals%commas
         before%points = before%points .or. decimals%points
         if (before%commas .and. before%points) then
            message = mixed_decimals
         else if (columns /= plan%columns) then
            message = "found "//columns_text(columns)//", expected " &
               //integer_text(plan%columns)//" as before"
         else
            points(:, n + 1) = 0.0_wp
            do i = 1, size(plan%places)
               if (allocated(message)) exit
               call read_value(content(from(plan%places(i)):to(plan%places(i))), &
                  name_of(plan%roles(i), plan%units(i)), unit_size(trim(plan%units(i))), &
                  points(i, n + 1), message)
            end do
            if (.not. allocated(message) .and. n > 0) then
               ! instruments sweep frequencies in either direction
               if (n == 1) falls = plan%roles(1) == role_frequency &
                  .and. points(1, n + 1) < points(1, n)
               if (.not. merge(points(1, n + 1) < points(1, n), points(1, n + 1) > points(1, n), &
                  falls)) message = "found "//name_of(plan%roles(1), "")//" " &
                  //real_text(points(1, n + 1))//" after "//real_text(points(1, n))//" in line " &
                  //integer_text(lines(2))//", expected them to " &
                  //trim(merge("decrease as before", "increase          ", falls))
            end if
         end if
         if (allocated(message)) then
            call raise(error, error_input, name//":"//integer_text(line)//": "//message)
            return
         end if
         n = n + 1
         if (n == 1) lines(1) = line
         lines(2) = line
      end do
      plan%decimals = before
      if (falls) points(:, :n) = points(:, n:1:-1)
      if (n >= 2) return
      message = "found no numbers"
      if (n == 1) message = "found one row of numbers"
      call raise(error, error_input, name//":"//integer_text(max(1, line))//": "//message &
         //", expected two rows at least, of time and modulus or of frequency, storage and loss " &
         //"modulus")
   end subroutine read_points

   !> Line that names the columns: the last one before the numbers that has a known name
   function line_of_names(text) result(found)
      !> Contents of the file
      character(len=*), intent(in) :: text
      !> Number of the line; 0 if there is none
      integer :: found

      type(decimals_t) :: decimals
      character(len=:), allocatable :: content, comment
      integer :: start, line, columns, from(most_columns), to(most_columns), i

      found = 0
      line = 0
      start = start_of(text)
      do while (start <= len(text))
         call take_line(text, start, content, comment)
         line = line + 1
         if (names_columns(names_in(content, comment))) found = line
         call take_decimals(content, decimals)
         call split(content, columns, from, to)
         if (columns < 2) cycle
         if (all([(looks_numeric(content(from(i):to(i))), i=1, min(columns, most_columns))])) exit
      end do
   end function line_of_names

   !> What a line may name columns by: its content, or what stands behind ##
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

end module vcor_io_sample_file
