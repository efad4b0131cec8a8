!> Names and units of the columns of a data file
!>
!> A name may include its unit: `E [MPa]`, `E (MPa)`, `E/MPa`. Units may also be in a second line,
!> as other fitting programs write them, or in comments `# name [unit] ...` before the header, as
!> vcor writes them.
module vcor_io_header
   use vcor_error, only : error_input, error_t, raise
   use vcor_kinds, only : pi, wp
   use vcor_io_columns, only : most_columns, split
   use vcor_text, only : lower, shortened
   use vcor_words, only : contains_word, join_words, nearest_name
   implicit none
   private

   public :: header_t, column_name_t, roles, name_of, role_of, names_columns, names_tensile
   public :: read_names, read_units, note_comment
   public :: check_unit, unit_size, time_units, frequency_units, angular_units, modulus_units
   public :: longest_word, temperature_names
   public :: role_none, role_time, role_frequency, role_relaxation, role_storage, role_loss, &
      role_tangent, role_complex

   character(len=*), parameter :: time_units = "ns us ms s min h"
   !> Units of angular frequency
   character(len=*), parameter :: angular_units = "rad/s krad/s"
   !> Units of frequency and of angular frequency
   character(len=*), parameter :: frequency_units = "mHz Hz kHz MHz GHz "//angular_units
   character(len=*), parameter :: modulus_units = "Pa kPa MPa GPa N/m2 N/mm2"
   !> Names of a column of temperatures
   character(len=*), parameter :: temperature_names = "T temp temp. temperature"
   !> Length of the longest name or unit
   integer, parameter :: longest_word = 40
   !> Unit of a pure number
   character(len=*), parameter :: pure_number = "1"
   !> Role of a column: none of the following
   integer, parameter :: role_none = 0
   !> Times
   integer, parameter :: role_time = 1
   !> Frequencies, or angular frequencies
   integer, parameter :: role_frequency = 2
   !> Relaxation moduli
   integer, parameter :: role_relaxation = 3
   !> Storage moduli
   integer, parameter :: role_storage = 4
   !> Loss moduli
   integer, parameter :: role_loss = 5
   !> Loss tangents, which give the loss moduli if there are none
   integer, parameter :: role_tangent = 6
   !> Magnitudes of complex moduli, which give the storage moduli if there are none
   integer, parameter :: role_complex = 7

   !> Properties of a role
   type :: role_t
      character(len=18) :: words = ""
      !> Unit if none is stated
      character(len=5) :: unit = ""
      !> Known units, separated by blanks
      character(len=len(frequency_units)) :: units = ""
      !> Names of such a column, separated by blanks; moduli with initial g are shear moduli
      character(len=132) :: names = ""
      !> Examples of names, for messages
      character(len=26) :: example = ""
   end type role_t

   character(len=*), parameter :: cycle_names = "f freq"
   character(len=*), parameter :: angular_names = "omega w angular_frequency "//char(207)//char(137)
   !> The roles, in the order of the `role_*` constants
   type(role_t), parameter :: roles(7) = [ &
      role_t("time", "s", time_units, "t time times step_time", "t or time"), &
      role_t("frequency", "rad/s", frequency_units, &
      cycle_names//" "//angular_names//" frequency nu", "f or omega"), &
      role_t("relaxation modulus", "Pa", modulus_units, &
      "e g modulus relaxation_modulus e_relax g_relax e_t g_t young_modulus young's_modulus " &
      //"shear_modulus relaxation", "E or relaxation_modulus"), &
      role_t("storage modulus", "Pa", modulus_units, &
      "e' g' e_stor g_stor e_storage g_storage storage storage_modulus e_prime g_prime", &
      "E' or E_stor"), &
      role_t("loss modulus", "Pa", modulus_units, &
      "e'' g'' e"" g"" e_loss g_loss loss loss_modulus e_double_prime g_double_prime", &
      "E'' or E_loss"), &
      role_t("loss tangent", pure_number, pure_number, &
      "loss_tangent loss_factor damping_factor", "tan_delta"), &
      role_t("complex modulus", "Pa", modulus_units, &
      "e* g* |e*| |g*| |e| |g| e_star g_star complex_modulus complex_shear_modulus", "|E*|")]

   !> Name and unit of a column
   type :: column_name_t
      !> Name in lower case, except for T, with `_` for blanks
      character(len=longest_word) :: name = ""
      !> Unit; blank if it is not stated
      character(len=longest_word) :: unit = ""
      !> Line of the unit, otherwise of the name
      integer :: line = 0
   end type column_name_t

   !> Names and units of all columns
   type :: header_t
      !> Number of lines of the header that were read, 0 .. 2
      integer :: lines = 0
      !> Line of the names
      integer :: line = 0
      !> Number of columns
      integer :: count = 0
      type(column_name_t) :: columns(most_columns)
      !> Names and units from comments
      type(column_name_t) :: hints(most_columns)
      integer :: hint_count = 0
   end type header_t

contains

   !> Store the unit of a column from a comment `name [unit] ...`
   pure subroutine note_comment(header, comment)
      type(header_t), intent(inout) :: header
      character(len=*), intent(in) :: comment

      character(len=:), allocatable :: text
      integer :: left, right

      text = adjustl(comment)
      left = index(text, " [")
      right = index(text, "]")
      if (left < 2 .or. right < left + 3 .or. header%hint_count == most_columns) return
      if (index(text(:left - 1), " ") > 0) return
      header%hint_count = header%hint_count + 1
      header%hints(header%hint_count) = &
         column_name_t(lower(text(:left - 1)), text(left + 2:right - 1))
   end subroutine note_comment

   !> Read the line of names
   pure subroutine read_names(header, content, line)
      type(header_t), intent(inout) :: header
      character(len=*), intent(in) :: content
      integer, intent(in) :: line

      integer :: i, k, columns, from(most_columns), to(most_columns)
      character(len=:), allocatable :: cell

      call split(content, columns, from, to)
      header%lines = 1
      header%line = line
      header%count = 0
      do i = 1, min(columns, most_columns)
         cell = unquoted(content(from(i):to(i)))
         ! two tabs between names
         if (scan(content, ",;") == 0 .and. cell == "") cycle
         if (scan(content, ",;") == 0 .and. scan(cell, "[(") == 1 .and. header%count > 0) then
            ! a unit separated from its name by a blank
            header%columns(header%count)%unit = without_brackets(cell)
            cycle
         end if
         header%count = header%count + 1
         call take_apart(cell, header%columns(header%count))
         header%columns(header%count)%line = line
      end do
      do i = 1, header%count
         do k = 1, header%hint_count
            if (header%columns(i)%unit == "" .and. header%hints(k)%name == header%columns(i)%name) &
               header%columns(i)%unit = header%hints(k)%unit
         end do
      end do
   end subroutine read_names

   !> Whether a line names columns: it has at least two, and one name is known
   pure function names_columns(content) result(yes)
      character(len=*), intent(in) :: content
      logical :: yes

      type(header_t) :: header
      character(len=longest_word) :: unit
      integer :: i, known, role
      logical :: shear

      call read_names(header, content, 0)
      known = 0
      do i = 1, header%count
         ! a line of units has no names
         header%columns(i)%unit = ""
         call role_of(header%columns(i), role, shear, unit)
         if (role /= role_none) known = known + 1
      end do
      yes = known > 0 .and. header%count > 1
   end function names_columns

   !> Read the line of units
   pure subroutine read_units(header, content, line)
      type(header_t), intent(inout) :: header
      character(len=*), intent(in) :: content
      integer, intent(in) :: line

      integer :: i, columns, from(most_columns), to(most_columns)
      character(len=:), allocatable :: cell

      call split(content, columns, from, to)
      header%lines = 2
      do i = 1, min(columns, header%count)
         cell = without_brackets(unquoted(content(from(i):to(i))))
         if (cell == "" .or. cell == "-") cycle
         header%columns(i)%unit = cell
         header%columns(i)%line = line
      end do
   end subroutine read_units

   !> A cell without quotation marks around it
   pure function unquoted(cell) result(text)
      character(len=*), intent(in) :: cell
      !> Its content
      character(len=:), allocatable :: text

      text = cell
      if (len(cell) < 3) return
      if (cell(1:1) == '"' .and. cell(len(cell):) == '"') &
         text = trim(adjustl(cell(2:len(cell) - 1)))
   end function unquoted

   !> A unit without enclosing brackets
   pure function without_brackets(cell) result(text)
      character(len=*), intent(in) :: cell
      !> The unit
      character(len=:), allocatable :: text

      text = trim(adjustl(cell))
      if (len(text) < 2) return
      if (scan(text(1:1), "[(") > 0 .and. scan(text(len(text):), "])") > 0) &
         text = trim(adjustl(text(2:len(text) - 1)))
   end function without_brackets

   !> Separate name and unit
   pure subroutine take_apart(cell, column)
      character(len=*), intent(in) :: cell
      type(column_name_t), intent(out) :: column

      character(len=:), allocatable :: name
      integer :: i, mark

      name = lower(cell)
      if (is_tangent(name)) then
         column%name = "loss_tangent"
         column%unit = pure_number
         return
      end if
      ! the unit follows `in`, as in `t in s`
      mark = index(name, " in ")
      if (mark > 1) then
         column%unit = without_brackets(cell(mark + 4:))
         name = name(:mark - 1)
      end if
      ! in E(t) the parentheses belong to the name, in E(Pa) they enclose a unit
      mark = index(name, "(t)") + index(name, "(w)") + index(name, "(f)") + index(name, "(omega)")
      if (mark > 1) then
         i = mark + index(name(mark:), ")")
         column%unit = adjustl(cell(i:))
         if (column%unit(1:1) == "/") column%unit = column%unit(2:)
         column%unit = without_brackets(column%unit)
         name = name(:mark - 1)
      else
         mark = scan(name, "[(/")
         if (mark > 1) then
            column%unit = cell(mark:)
            if (name(mark:mark) == "/") column%unit = cell(mark + 1:)
            column%unit = without_brackets(column%unit)
            name = name(:mark - 1)
         end if
      end if
      name = trim(adjustl(name))
      do i = 1, len(name)
         if (name(i:i) == " ") name(i:i) = "_"
      end do
      ! T is the temperature
      if (name == "t" .and. index(cell, "T") == 1) name = "T"
      column%name = name
   end subroutine take_apart

   !> Whether a name is one of the loss tangent: tan_delta, tan d, tan(delta), tand ...
   pure function is_tangent(name) result(yes)
      !> The name, lower case
      character(len=*), intent(in) :: name
      logical :: yes

      character(len=*), parameter :: angles = " d del delta "//char(206)//char(180)//" phi "
      character(len=:), allocatable :: angle
      integer :: mark

      yes = .false.
      if (index(name, "tan") /= 1 .or. len(name) < 4) return
      angle = name(4:)
      if (scan(angle(1:1), "_ -(") > 0) angle = angle(2:)
      mark = scan(angle, " )[(")
      if (mark > 1) angle = angle(:mark - 1)
      yes = contains_word(angles, angle)
   end function is_tangent

   !> Standard spelling of a unit
   pure function usual_unit(unit) result(usual)
      !> A unit in any spelling
      character(len=*), intent(in) :: unit
      !> Standard spelling if it is known, otherwise unchanged
      character(len=longest_word) :: usual

      character(len=*), parameter :: micro = char(181), mu = char(206)//char(188)
      character(len=*), parameter :: squared = char(178), latin = char(194)
      integer :: mark

      usual = unit
      ! in UTF-8 this byte precedes the characters of Latin-1
      mark = index(usual, latin)
      if (mark > 0) usual = usual(:mark - 1)//usual(mark + 1:)
      if (usual(:1) == micro) usual = "u"//usual(2:)
      if (usual(:2) == mu) usual = "u"//usual(3:)
      mark = index(usual, "^2")
      if (mark > 1) usual = usual(:mark - 1)//usual(mark + 1:)
      mark = index(usual, squared)
      if (mark > 1) usual(mark:mark) = "2"
      if (usual == "sec") usual = "s"
   end function usual_unit

   !> Role of a column by its name, otherwise by its unit, and its unit as far as it is known
   pure subroutine role_of(column, role, shear, unit)
      type(column_name_t), intent(in) :: column
      !> One of the `role_*` constants
      integer, intent(out) :: role
      !> Whether its values are shear moduli
      logical, intent(out) :: shear
      !> Unit in its standard spelling; blank if unknown
      character(len=longest_word), intent(out) :: unit

      integer :: i

      unit = usual_unit(column%unit)
      role = role_none
      do i = 1, size(roles)
         if (contains_word(roles(i)%names, column%name)) role = i
      end do
      shear = (role >= role_relaxation .or. contains_word(modulus_units, unit)) &
         .and. role /= role_tangent .and. names_shear(column%name)
      if (unit == "" .and. contains_word(cycle_names, column%name)) unit = "Hz"
      if (unit == "" .and. contains_word(angular_names, column%name)) unit = "rad/s"
      if (role /= role_none) return
      if (contains_word(time_units, unit)) role = role_time
      if (contains_word(frequency_units, unit)) role = role_frequency
   end subroutine role_of

   !> Role of a column in words
   pure function name_of(role, unit) result(name)
      !> One of the `role_*` constants except `role_none`
      integer, intent(in) :: role
      character(len=*), intent(in) :: unit
      character(len=:), allocatable :: name

      name = trim(roles(role)%words)
      if (role == role_frequency .and. index(unit, "rad") > 0) name = "angular frequency"
   end function name_of

   !> Whether a name denotes a shear modulus: G, Gt, G0, G', |G*|, or shear (Schub) in a word
   pure function names_shear(name) result(yes)
      !> The name, lower case, `_` for blanks
      character(len=*), intent(in) :: name
      logical :: yes

      yes = index(name, "shear") > 0 .or. index(name, "schub") > 0 .or. has_symbol(name, "g")
   end function names_shear

   !> Whether a name denotes a tensile modulus: E, Et, E0, E', |E*|, or Young or tensile in a word
   pure function names_tensile(name) result(yes)
      !> The name, lower case, `_` for blanks
      character(len=*), intent(in) :: name
      logical :: yes

      yes = index(name, "young") > 0 .or. index(name, "tensile") > 0 .or. has_symbol(name, "e")
   end function names_tensile

   !> Whether a name contains a symbol: a letter alone or with an index, such as t, that does not
   !> begin a word
   pure function has_symbol(name, letter) result(yes)
      !> The name, lower case, `_` for blanks
      character(len=*), intent(in) :: name
      character, intent(in) :: letter
      logical :: yes

      character(len=*), parameter :: letters = "abcdefghijklmnopqrsuvwxyz"
      integer :: i, first

      yes = .false.
      first = 1
      do i = 1, len_trim(name)
         if (scan(name(i:i), "_|(") > 0) then
            first = i + 1
         else if (i == first .and. name(i:i) == letter) then
            if (i == len_trim(name)) then
               yes = .true.
            else
               yes = yes .or. verify(name(i + 1:i + 1), letters) > 0
            end if
         end if
      end do
   end function has_symbol

   !> Size of a unit in SI units
   pure function unit_size(unit) result(scale)
      character(len=*), intent(in) :: unit
      !> In s, rad/s or Pa
      real(wp) :: scale

      character(len=*), parameter :: names(*) = [character(len=6) :: "ns", "us", "ms", "min", "h", &
         "kPa", "krad/s", "MPa", "N/mm2", "GPa", "mHz", "Hz", "kHz", "MHz", "GHz"]
      real(wp), parameter :: sizes(*) = [1.0e-9_wp, 1.0e-6_wp, 1.0e-3_wp, 60.0_wp, 3600.0_wp, &
         1.0e3_wp, 1.0e3_wp, 1.0e6_wp, 1.0e6_wp, 1.0e9_wp, &
         2.0_wp*pi*[1.0e-3_wp, 1.0_wp, 1.0e3_wp, 1.0e6_wp, 1.0e9_wp]]
      integer :: i

      scale = 1.0_wp
      i = findloc(names == unit, .true., dim=1)
      if (i > 0) scale = sizes(i)
   end function unit_size

   !> Check that a unit suits the role of a column
   subroutine check_unit(unit, role, place, error)
      character(len=*), intent(in) :: unit
      !> Role of the column
      integer, intent(in) :: role
      !> File and line of the unit, for messages
      character(len=*), intent(in) :: place
      !> Error of code `error_input`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: known, near, what

      known = trim(roles(role)%units)
      if (contains_word(known, unit)) return
      what = trim(roles(role)%words)
      if (index(what, "modulus") > 0) what = "modulus"
      near = nearest_unit(unit, known)
      if (near /= "") near = "; did you mean '"//near//"'?"
      call raise(error, error_input, place//": found '"//shortened(trim(unit))//"' as unit of " &
         //"the "//what//", expected one of "//join_words(known)//near)
   end subroutine check_unit

   !> Suggestion for an unknown unit
   pure function nearest_unit(unit, known) result(near)
      character(len=*), intent(in) :: unit
      !> Known ones, separated by blanks
      character(len=*), intent(in) :: known
      !> The nearest one; empty if none is near, or if the unit is that of another quantity
      character(len=:), allocatable :: near

      near = ""
      if (len_trim(unit) < 2 .or. contains_word(time_units//" "//frequency_units//" " &
         //modulus_units, unit)) return
      near = nearest_name(trim(unit), known)
   end function nearest_unit

end module vcor_io_header
