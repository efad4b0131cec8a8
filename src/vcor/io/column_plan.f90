!> Which columns of a data file are read, as what and in which units
!>
!> By what the user says, else by the header, else by their number: two columns are time and
!> relaxation modulus, three are angular frequency, storage and loss modulus, in units of the SI.
module vcor_io_column_plan
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_io_columns, only : decimals_t
   use vcor_io_header, only : check_unit, header_t, known_roles => roles, longest_word, &
      most_columns, name_of, role_complex, role_frequency, role_loss, role_none, &
      role_of, role_relaxation, role_storage, role_tangent, &
      role_time
   use vcor_kinds, only : wp
   use vcor_text, only : integer_text, shortened
   use vcor_io_units, only : angular_units, time_units
   use vcor_words, only : contains_word
   implicit none
   private

   public :: plan_t, reading_t, make_plan, columns_text

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
      !> How the numbers are written
      type(decimals_t) :: decimals
   end type plan_t

contains

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
      character(len=:), allocatable :: place, head
      integer :: roles(most_columns), i
      logical :: shear(most_columns), told

      place = name//":"//integer_text(line)
      head = place
      if (header%lines > 0) head = name//":"//integer_text(header%line)
      if (columns > most_columns .or. columns < 2 &
         .or. (header%lines > 0 .and. columns /= header%count)) then
         call raise(error, error_input, place//": found "//columns_text(columns) &
            //", expected 2, a time and a modulus, or 3, a frequency, a storage and a " &
            //"loss modulus"//expected_of(header, columns))
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
      ! a header that tells one unit tells all: what it leaves out is not that of the SI
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

   !> Of a frequency and an angular frequency side by side, which say the same, keep one: the one in
   !> the unit that the user gives, else the angular one
   pure subroutine choose_frequency(reading, units, roles)
      !> What the user says
      type(reading_t), intent(in) :: reading
      !> Units of the columns, shape (n)
      character(len=*), intent(in) :: units(:)
      !> What they hold, shape (n)
      integer, intent(inout) :: roles(:)

      logical :: kept(size(roles))
      integer :: i

      if (count(roles == role_frequency) < 2) return
      kept = [(contains_word(angular_units, units(i)), i=1, size(roles))]
      if (size(reading%units) > 0) kept = units == reading%units(1)
      kept = kept .and. roles == role_frequency
      if (any(kept)) where (roles == role_frequency .and. .not. kept) roles = role_none
   end subroutine choose_frequency

   !> Refuse a header that does not say which columns to read
   subroutine check_names(header, roles, units, told, plan, head, error)
      !> The header
      type(header_t), intent(in) :: header
      !> What each column holds, as far as the header says it, shape (n)
      integer, intent(in) :: roles(:)
      !> Their units, shape (>= n)
      character(len=*), intent(in) :: units(:)
      !> Whether the user tells the units
      logical, intent(in) :: told
      !> The columns to be read
      type(plan_t), intent(in) :: plan
      !> File and line of the header, for messages
      character(len=*), intent(in) :: head
      !> Error of code `error_input`, unallocated where it does
      type(error_t), allocatable, intent(out) :: error

      integer :: i

      do i = 1, size(plan%places)
         associate (place => plan%places(i))
            if (count(roles == plan%roles(i)) > 1) then
               call raise(error, error_input, head//": found "//columns_text(count(roles &
                  == plan%roles(i)))//" of "//name_of(plan%roles(i), "")//", expected one")
            else if (roles(place) == role_none &
               .and. index(header%columns(place)%name, "*") > 0) then
               ! some other spelling of a complex modulus, or of a complex viscosity
               call raise(error, error_input, head//": found '" &
                  //shortened(trim(header%columns(place)%name))//"' as name of a column, " &
                  //"expected one such as "//trim(known_roles(plan%roles(i))%example))
            else if (roles(place) == role_none .and. units(place) == "" .and. .not. told) then
               ! its place alone says nothing, the logarithm of a modulus may stand there
               call raise(error, error_input, head//": found '" &
                  //shortened(trim(header%columns(place)%name))//"' as name of a column, " &
                  //"expected one such as "//trim(known_roles(plan%roles(i))%example) &
                  //", a unit beside it, or --units")
            end if
         end associate
         if (allocated(error)) return
      end do
   end subroutine check_names

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

   !> What is missing of storage and loss modulus where one of them is there
   pure function lacking(roles) result(text)
      !> What each column holds
      integer, intent(in) :: roles(:)
      !> In words, or nothing
      character(len=:), allocatable :: text

      logical :: loss

      text = ""
      loss = any(roles == role_loss .or. roles == role_tangent)
      if (any(roles == role_storage) .and. .not. loss) text = "; there is no loss modulus"
      if (loss .and. all(roles /= role_storage)) text = "; there is no storage modulus"
      if (any(roles == role_complex) .and. all(roles /= role_tangent)) text &
         = "; a complex modulus needs the loss tangent beside it"
   end function lacking

   !> A number of columns in words
   pure function columns_text(columns) result(text)
      !> The number
      integer, intent(in) :: columns
      !> `2 columns`
      character(len=:), allocatable :: text

      text = integer_text(columns)//" column"
      if (columns /= 1) text = text//"s"
   end function columns_text

   !> What a header says against the number of columns
   pure function expected_of(header, columns) result(text)
      !> The header
      type(header_t), intent(in) :: header
      !> Number of columns of the first line of numbers
      integer, intent(in) :: columns
      !> In words, or nothing
      character(len=:), allocatable :: text

      text = ""
      if (header%lines == 0) return
      text = "; the header has "//integer_text(header%count)
      if (columns > header%count .and. columns <= 2*header%count) text = text//" (with decimal " &
         //"commas expected semicolons or tabs between them)"
   end function expected_of

end module vcor_io_column_plan
