!> Case files as they are written: what is understood, and what is said about what is not
program test_namelist
   use vcor_error, only : error_file, error_input, error_t
   use vcor_io_case_reader, only : read_case, read_case_text
   use vcor_kinds, only : wp
   use vcor_case_case, only : case_t
   use vcor_test, only : check, check_close, check_contains, check_text, finish, suite
   implicit none

   character(len=*), parameter :: lf = achar(10), cr = achar(13), tab = achar(9)
   character(len=*), parameter :: bom = char(239)//char(187)//char(191)
   !> File the tests write, in the folder they run in
   character(len=*), parameter :: scratch = "test_namelist_scratch.nml"

   call suite("namelist")
   call test_layout()
   call test_numbers()
   call test_logicals_and_texts()
   call test_lists()
   call test_structure_errors()
   call test_name_errors()
   call test_value_errors()
   call test_list_errors()
   call test_files()
   call test_large_files()
   call finish()

contains

   !> The same value, written in every way that is allowed
   subroutine test_layout()
      call reads_velocity("&impact velocity = 5.0 /", "one line")
      call reads_velocity("&impact velocity=5.0/", "no blanks")
      call reads_velocity("&IMPACT Velocity = 5.0 /", "upper case")
      call reads_velocity("&impact"//lf//"velocity ="//lf//"  5.0"//lf//"/"//lf, &
         & "value in the next line")
      call reads_velocity("&impact"//lf//"velocity"//lf//"= 5.0 ! the key alone"//lf//"/", &
         & "sign in the next line")
      call reads_velocity("&impact"//cr//lf//"velocity = 5.0"//cr//lf//"/"//cr//lf, "CRLF")
      call reads_velocity("&impact"//cr//"velocity = 5.0 ! m/s"//cr//"/"//cr, &
         & "carriage returns alone")
      call reads_velocity(tab//"&impact"//tab//"velocity"//tab//"="//tab//"5.0"//tab//"/", "tabs")
      call reads_velocity(bom//"&impact velocity = 5.0 /", "byte order mark")
      call reads_velocity("&impact velocity = 5.0 &end", "end by &end")
      call reads_velocity("&impact velocity = 5.0 &END ! what follows is a comment", "end by &END")
      call reads_velocity("! 'a / & = $ comment"//lf//lf//"&impact ! it's one"//lf &
         & //" velocity = 5.0!m/s"//lf//"/", &
         & "comments")
      call reads_velocity("! Stoß, H"//char(233)//"rtz"//lf//"&impact velocity = 5.0 /", &
         & "UTF-8 and Latin-1 in comments")
      call reads_velocity("&impact velocity = 5.0, /", "a comma at the end")
      call reads_velocity("&impact velocity = 1*5.0 /", "repeat count of one")
      call reads_velocity("&case title = 'a' / &impact velocity = 5.0 / &plate/", &
         & "groups in one line")
   end subroutine test_layout

   !> Numbers by Fortran's rules
   subroutine test_numbers()
      call reads_number("5", 5.0_wp)
      call reads_number("+5.", 5.0_wp)
      call reads_number(".5", 0.5_wp)
      call reads_number("1d-3", 1.0e-3_wp)
      call reads_number("1.5e+3", 1500.0_wp)
      call reads_number("1.5D3", 1500.0_wp)
      call reads_number("0001.5E0003", 1500.0_wp)
      call reads_number("1.0e299", 1.0e299_wp)
      call reads_number("1e-299", 1.0e-299_wp)
      call reads_number("0.0e999", 0.0_wp)
      call reads_number("-0", 0.0_wp)
      call reads_number(repeat("0", 500)//"."//repeat("0", 500)//"25e501", 2.5_wp)
      call reads_number("1"//repeat("0", 500)//"e-500", 1.0_wp)
      call reads_number("0.1234567890123456789", 0.12345678901234568_wp)
   end subroutine test_numbers

   !> Logicals and texts
   subroutine test_logicals_and_texts()
      call reads_logical(".true.", .true.)
      call reads_logical("T", .true.)
      call reads_logical("true", .true.)
      call reads_logical(".F.", .false.)
      call reads_logical(".FALSE.", .false.)

      call reads_title("'plain'", "plain")
      call reads_title('"double"', "double")
      call reads_title("''", "")
      call reads_title("'it''s'", "it's")
      call reads_title('"it''s"', "it's")
      call reads_title('"a ""quoted"" word"', 'a "quoted" word')
      call reads_title("'a ! b / c & d, e = f (g) &end'", "a ! b / c & d, e = f (g) &end")
      call reads_title("'  blanks inside   count  '", "  blanks inside   count  ")
      call reads_title("'Stoß auf Gummi, β = 5 1/s'", "Stoß auf Gummi, β = 5 1/s")
      call reads_title("''''", "'")
   end subroutine test_logicals_and_texts

   !> Lists
   subroutine test_lists()
      call reads_list("moduli = 1.0, 2.0, 3.0", [1.0_wp, 2.0_wp, 3.0_wp])
      call reads_list("moduli = 1.0 2.0"//lf//"  3.0", [1.0_wp, 2.0_wp, 3.0_wp])
      call reads_list("moduli = 1.0,"//lf//lf//"! comment"//lf//" 2.0 ! another"//lf//", 3.0,", &
         & [1.0_wp, 2.0_wp, 3.0_wp])
      call reads_list("moduli = 3*1.0, 2*2e6", [1.0_wp, 1.0_wp, 1.0_wp, 2.0e6_wp, 2.0e6_wp])
      call reads_list("moduli(1:3) = 1.0, 2.0, 3.0", [1.0_wp, 2.0_wp, 3.0_wp])
      call reads_list("moduli(:) = 1.0, 2.0", [1.0_wp, 2.0_wp])
      call reads_list("moduli(1) = 1.0", [1.0_wp])
   end subroutine test_lists

   !> What is wrong with groups and statements
   subroutine test_structure_errors()
      call refuses("", "x.nml: |empty|&impact", "empty file")
      call refuses(bom//lf//"  ! nothing here"//lf, "empty", "comments alone")
      call refuses("velocity = 5.0", "x.nml:1: |'velocity' outside of groups|&group", "no group")
      call refuses(lf//lf//"$impact velocity = 5.0 $end", "x.nml:3: |$impact|not with $", &
         & "dollar group")
      call refuses("&impact velocity = 5.0 / radius", &
         & "'radius' outside of groups|ends its group", "text behind a group")
      call refuses("&output directory = out/run /", "out without quotes, expected 'out'", &
         & "slash in a text without quotes")
      call refuses("&impact velocity = 5.0", "x.nml:1: |end of the file in &impact|expected /", &
         & "group not ended")
      call refuses("&impact"//lf//"velocity = 5.0"//lf//"&sphere radius = 1 /", &
         & "x.nml:3: |'&sphere' in &impact|expected /", "group within a group")
      call refuses("&end", "&end outside of a group", "end without a group")
      call refuses("& impact velocity = 5.0 /", "& without a name", "ampersand alone")
      call refuses("&impact /"//lf//"/", "x.nml:2: |'/' outside of groups", "two slashes")
      call refuses("&impact velocity 5.0 /", "'velocity' in &impact|key = value", "no equals sign")
      call refuses("&impact = 5.0 /", "'=' in &impact|key = value", "no key")
      call refuses("&impact 'velocity' = 5.0 /", "in &impact|key = value", "key in quotes")
      call refuses("&impact velocity == 5.0 /", "'=' among values", "two equals signs")
      call refuses("&impact velocity = (5.0, 1.0) /", "'(5.0, 1.0)' among values", "complex number")
      call refuses("&impact velocity(1 = 5.0 /", "'(' without its counterpart", &
         & "parenthesis not closed")
      call refuses("&impact velocity = ) /", "')' without its counterpart", &
         & "parenthesis not opened")
      call refuses("&case"//lf//" title = 'cut off"//lf//"/", "x.nml:2: |cut off|closing quote", &
         & "text cut off")
      call refuses("&case title = 'it's' /", "'it's|doubled", "quote not doubled")
      call refuses("&case title = 'a'b /", "'a'b|blank or a comma", "text glued to a word")
      call refuses("&case title = 1*'once' /", "repeat count", "repeat count of a text")
      call refuses("&case title = 'ab"//achar(0)//"cd' /", "byte 0|text file", "NUL in a text")
      call refuses(achar(127)//"ELF"//achar(2)//achar(1), "x.nml:1: |byte 127|text file", &
         & "binary file")
      call refuses("&impact velocity = 5.0 ! "//achar(7)//lf//"/", "byte 7", "bell in a comment")
      call refuses(char(255)//char(254)//"&"//achar(0)//"i"//achar(0), &
         & "x.nml:1: |outside of groups", "UTF-16")
   end subroutine test_structure_errors

   !> What is wrong with the names of groups and keys
   subroutine test_name_errors()
      call refuses(lf//"&impcat velocity = 5.0 /", &
         & "x.nml:2: |unknown group '&impcat'|did you mean 'impact'?", &
         & "misspelt group")
      call refuses("&Material_ name = 'a' /", &
         & "unknown group '&Material_'|did you mean 'material'?", "a letter too many")
      call refuses("&wall velocity = 5.0 /", "unknown group '&wall'|known: case, impact, sphere", &
         & "unknown group")
      call refuses("&impact"//lf//"veloctiy = 5.0 /", &
         & "x.nml:2: |unknown key 'veloctiy' in &impact|did you mean 'velocity'?", "misspelt key")
      call refuses("&material poisson = 0.5 /", "did you mean 'poisson_ratio'?", &
         & "beginning of a key")
      call refuses("&plate radius = 0.5 /", "unknown key 'radius' in &plate|belongs to &sphere", &
         & "key of another group")
      call refuses("&impact colour = 5.0 /", "unknown key 'colour' in &impact|known: velocity", &
         & "unknown key")
      call refuses("&impact impact%velocity = 5.0 /", "unknown key 'impact%velocity'", "component")
      call refuses("&impact "//repeat("x", 500)//" = 5.0 /", "unknown key 'xxx|xxx...'", "long key")
      call refuses("&impact "//char(27)//"[31m = 5.0 /", "byte 27", "escape sequence")
      call refuses("&impact velo"//char(200)//"city = 5.0 /", &
         & "'velo?city'|did you mean 'velocity'?", "Latin-1 in a key")
      call refuses("&impact velocity = 5.0"//lf//"velocity = 6.0 /", "x.nml:2: |twice|line 1", &
         & "key twice")
      call refuses("&impact velocity = 5.0, VELOCITY = 5.0 /", "twice", "key twice in upper case")
      call refuses("&impact velocity = 5.0 /"//lf//"&Impact /", &
         & "x.nml:2: |&impact is there twice|line 1", "group twice")
      call refuses(repeat("&material /"//lf, 1001), "x.nml:1001: |more than 1000 &material", &
         & "too many materials")
   end subroutine test_name_errors

   !> What is wrong with values
   subroutine test_value_errors()
      call refuses_value("", "velocity' has no value")
      call refuses_value(",", "empty value")
      call refuses_value("5.0,,", "empty value")
      call refuses_value("fast", "velocity: |'fast', expected a number > 0 [m/s]")
      call refuses_value("'5.0'", "in quotes, '5.0', expected a number")
      call refuses_value(".true.", "'.true.', expected a number")
      call refuses_value("NaN", "'NaN'|finite")
      call refuses_value("-nan", "'-nan'|finite")
      call refuses_value("Inf", "'Inf'|finite")
      call refuses_value("+Infinity", "'+Infinity'|finite")
      call refuses_value("1e400", "1e400, which is too large")
      call refuses_value("-1d99999999999", "too large")
      call refuses_value("1"//repeat("0", 400), "too large")
      call refuses_value("1.8e308", "too large")
      call refuses_value("1e-400", "too small")
      call refuses_value("0."//repeat("0", 400)//"1", "too small")
      call refuses_value("1.0.0", "'1.0.0', expected a number")
      call refuses_value("5.0;", "'5.0;', expected a number")
      call refuses_value("5.0_wp", "'5.0_wp', expected a number")
      call refuses_value("1e", "'1e', expected a number")
      call refuses_value("1e+", "'1e+', expected a number")
      call refuses_value("1.5-3", "'1.5-3', expected a number")
      call refuses_value("1e3.5", "'1e3.5', expected a number")
      call refuses_value("--5", "'--5', expected a number")
      call refuses_value(".", "'.', expected a number")
      call refuses_value("-", "'-', expected a number")
      call refuses_value("*", "'*', expected a number")
      call refuses_value("0x10", "'0x10', expected a number")
      call refuses_value("1,5", "more than one value|'1,5'|decimal point, not a comma")
      call refuses_value("5.0 6.0", "more than one value|'5.0 6.0'")
      call refuses_value("2*5.0", "more than one value: 2*5.0 is not a product|5.0 given 2 times")
      call refuses_value("3*", "repeat count without a value")
      call refuses_value("0*5.0", "repeat count that is not a positive number")
      call refuses_value("99999999999*5.0", "repeat count")
      call refuses_value("5.0 m/s", "more than one value|'5.0 m'|; give 5.0, in m/s")
      call refuses_value("5.0m", "'5.0m', expected a number|; give 5.0, in m/s")
      call refuses("&material modulus = 70 GPa /", "'70 GPa'|; give 70e9, in Pa", "modulus in GPa")
      call refuses("&material modulus = .7TPa /", "'.7TPa'|; give .7e12, in Pa", "modulus in TPa")
      call refuses("&sphere radius = 5 mm /", "'5 mm'|; give 5e-3, in m", "radius in millimetres")
      call refuses("&material moduli = 1e6 2 MPa /", "'MPa'|; give 2e6, in Pa", "a list with units")

      call refuses("&solver volterra_order = 1.0 /", &
         & "volterra_order: |'1.0', expected a whole number in [1, 2]", &
         & "real for an integer")
      call refuses("&solver volterra_order = 99999999999 /", &
         & "'99999999999', expected a whole number", "large integer")
      call refuses("&solver volterra_order = one /", "'one', expected a whole number", &
         & "text for an integer")
      call refuses("&output csv = yes /", "'yes', expected .true. or .false.", "yes for a logical")
      call refuses("&output csv = 1 /", "'1', expected .true. or .false.", "number for a logical")
      call refuses("&output csv = tru /", "'tru', expected .true. or .false.", "misspelt logical")
      call refuses("&output csv = 'true' /", "in quotes|expected .true. or .false.", &
         & "text for a logical")
      call refuses("&sphere material = steel /", "steel without quotes, expected 'steel'", &
         & "no quotes")
      call refuses("&sphere material = sls rubber /", "more than one value|'sls rubber'", &
         & "two words without quotes")
      call refuses("&sphere material = 5 /", "5 without quotes", "number for a text")
      call refuses("&case title = 'a', 'b' /", "more than one value", "two texts")
      call refuses("&case title = 'a"//char(233)//"b' /", "not UTF-8|'a?b'", "Latin-1 text")
      call refuses("&case title = '"//repeat("x", 5000)//"' /", "5000 bytes|at most 4096", &
         & "long text")
   end subroutine test_value_errors

   !> What is wrong with lists
   subroutine test_list_errors()
      call refuses_list("moduli = 1.0,, 2.0", "empty value")
      call refuses_list("moduli = , 2.0", "empty value")
      call refuses_list("moduli = 1.0, x", "moduli: |'x', expected numbers > 0 [Pa]")
      call refuses_list("moduli = 1.0, 'x'", "in quotes")
      call refuses_list("moduli = 1.0, NaN", "finite")
      call refuses_list("moduli = 2000000*1.0", "more than 1000000 numbers")
      call refuses_list("moduli = 999999999*1.0 999999999*1.0 999999999*1.0", &
         & "more than 1000000 numbers")
      call refuses_list("moduli(2) = 1.0", &
         & "x.nml:2: |moduli: found (2), expected the whole list|moduli = 1.0, 2.0")
      call refuses_list("moduli(1:2) = 1.0, 2.0, 3.0", &
         & "moduli: found (1:2), expected the whole list")
      call refuses_list("density(1) = 1.0", "density: |single value")
   end subroutine test_list_errors

   !> Files that are not case files
   subroutine test_files()
      type(case_t) :: case
      type(error_t), allocatable :: error
      real(wp) :: velocity

      call read_case(case, "no_such_file.nml", error)
      call check_error(error, error_file, "no_such_file.nml: |no such file", "missing file")
      call read_case(case, "no_such_folder/case.nml", error)
      call check_error(error, error_file, "no such file", "missing folder")
      call read_case(case, ".", error)
      call check_error(error, error_file, ".: |directory", "directory")
      call read_case(case, "", error)
      call check_error(error, error_file, "empty", "file name without a letter")
      call read_case(case, "/dev/null", error)
      call check_error(error, error_input, "/dev/null: |empty", "null device")

      call write_file("")
      call read_case(case, scratch, error)
      call check_error(error, error_input, scratch//": |empty", "empty file")
      call write_file("&impact velocity = 5.0 /")
      call read_case(case, scratch, error)
      call check(.not. allocated(error), "a file without line feed at its end is read")
      call case%get("impact", "velocity", velocity)
      call check_close(velocity, 5.0_wp, 0.0_wp, "velocity of the file")
      call check_text(case%location("impact", "velocity"), scratch//":1", "place in the file")
      call write_file(lf//"&impact velocity = five /")
      call read_case(case, scratch, error)
      call check_error(error, error_input, scratch//":2: |'five'", "wrong value in a file")
      call remove_file()
   end subroutine test_files

   !> Large input is refused or read, and takes no time worth naming
   subroutine test_large_files()
      type(case_t) :: case
      type(error_t), allocatable :: error
      character(len=:), allocatable :: text
      real(wp), allocatable :: moduli(:)
      integer, parameter :: megabyte = 1000000

      call refuses("&impact velocity = "//repeat("5", megabyte)//" /", "5...,|too large", &
         & "1 MB number")
      call refuses("&case title = '"//repeat("x", megabyte)//" /", "x... is cut off", &
         & "1 MB text that is cut off")
      call refuses("&"//repeat("x", megabyte)//" /", "unknown group|xxx...'", "1 MB group")
      call refuses("&impact "//repeat("x", megabyte)//" = 5.0 /", "unknown key|xxx...'", "1 MB key")
      call refuses("&impact velocity = "//repeat("5 ", megabyte/2)//" /", "more than one value", &
         & "500,000 values")
      call refuses(repeat("(", megabyte), "'('", "1 MB of parentheses")
      call refuses("&impact "//repeat("a=1 ", megabyte/4)//" /", "unknown key 'a'", &
         & "250,000 statements")
      call refuses("&material "//repeat("density=1 ", megabyte/10)//" /", "twice", &
         & "100,000 times the same")
      text = "! "//repeat("x", megabyte)//lf//"&material moduli = "//repeat("1.5 ", megabyte/4)//"/"
      call read_case_text(case, text, "x.nml", error)
      call check(.not. allocated(error), "a line of 1 MB is read")
      call case%get("material", "moduli", moduli)
      call check(size(moduli) == megabyte/4, "250,000 moduli are read")

      call write_file(repeat(" ", 5*megabyte))
      call read_case(case, scratch, error)
      call check_error(error, error_input, scratch//": |larger than 4 MB", "5 MB file")
      call remove_file()
   end subroutine test_large_files

   !> Check that the velocity is read as 5 m/s
   subroutine reads_velocity(text, what)
      !> The case
      character(len=*), intent(in) :: text
      !> What is special about it
      character(len=*), intent(in) :: what
      type(case_t) :: case
      type(error_t), allocatable :: error
      real(wp) :: velocity

      call read_case_text(case, text, "x.nml", error)
      call check(.not. allocated(error), what//" is read")
      call case%get("impact", "velocity", velocity)
      call check_close(velocity, 5.0_wp, 0.0_wp, what)
   end subroutine reads_velocity

   !> Check that a number is read
   subroutine reads_number(written, number)
      !> As it is written
      character(len=*), intent(in) :: written
      !> The number
      real(wp), intent(in) :: number
      type(case_t) :: case
      type(error_t), allocatable :: error
      real(wp) :: found

      call read_case_text(case, "&plate surface_radius = "//written//" /", "x.nml", error)
      call check(.not. allocated(error), written//" is read")
      call case%get("plate", "surface_radius", found)
      call check_close(found, number, 0.0_wp, written)
   end subroutine reads_number

   !> Check that a logical is read
   subroutine reads_logical(written, flag)
      !> As it is written
      character(len=*), intent(in) :: written
      !> The logical
      logical, intent(in) :: flag
      type(case_t) :: case
      type(error_t), allocatable :: error
      logical :: found

      call read_case_text(case, "&solver continue_after_separation = "//written//" /", "x.nml", &
         & error)
      call check(.not. allocated(error), written//" is read")
      call case%get("solver", "continue_after_separation", found)
      call check(found .eqv. flag, written)
   end subroutine reads_logical

   !> Check that a title is read
   subroutine reads_title(written, title)
      !> As it is written
      character(len=*), intent(in) :: written
      !> The title
      character(len=*), intent(in) :: title
      type(case_t) :: case
      type(error_t), allocatable :: error
      character(len=:), allocatable :: found

      call read_case_text(case, "&case title = "//written//" /", "x.nml", error)
      call check(.not. allocated(error), written//" is read")
      call case%get("case", "title", found)
      call check_text(found, title, written)
   end subroutine reads_title

   !> Check that moduli are read
   subroutine reads_list(written, moduli)
      !> Statements of a material
      character(len=*), intent(in) :: written
      !> The moduli
      real(wp), intent(in) :: moduli(:)
      type(case_t) :: case
      type(error_t), allocatable :: error
      real(wp), allocatable :: found(:)

      call read_case_text(case, "&material "//written//" /", "x.nml", error)
      call check(.not. allocated(error), written//" is read")
      call case%get("material", "moduli", found)
      call check(size(found) == size(moduli), written//": number of moduli")
      if (size(found) == size(moduli)) call check_close(found, moduli, 0.0_wp, written)
   end subroutine reads_list

   !> Check that a case is refused as wrong input
   subroutine refuses(text, words, what)
      !> The case
      character(len=*), intent(in) :: text
      !> Parts of the message, separated by bars
      character(len=*), intent(in) :: words
      !> What is wrong with it
      character(len=*), intent(in) :: what
      type(case_t) :: case
      type(error_t), allocatable :: error

      call read_case_text(case, text, "x.nml", error)
      call check_error(error, error_input, words, what)
   end subroutine refuses

   !> Check that a velocity is refused
   subroutine refuses_value(written, words)
      !> As it is written
      character(len=*), intent(in) :: written
      !> Parts of the message, separated by bars
      character(len=*), intent(in) :: words

      call refuses("&impact"//lf//"velocity = "//written//" /", "x.nml:2: |"//words, &
         & written(:min(40, len(written))))
   end subroutine refuses_value

   !> Check that statements of a material are refused
   subroutine refuses_list(written, words)
      !> The statements
      character(len=*), intent(in) :: written
      !> Parts of the message, separated by bars
      character(len=*), intent(in) :: words

      call refuses("&material"//lf//written//" /", words, written)
   end subroutine refuses_list

   !> Check an error: its code, its words, and that it is one line that can be shown
   subroutine check_error(error, code, words, what)
      !> The error
      type(error_t), allocatable, intent(in) :: error
      !> Its code
      integer, intent(in) :: code
      !> Parts of its message, separated by bars
      character(len=*), intent(in) :: words
      !> What is wrong
      character(len=*), intent(in) :: what
      integer, parameter :: longest_message = 300
      integer :: first, last, i

      call check(allocated(error), what//" is refused")
      if (.not. allocated(error)) return
      call check(error%code == code, what//": exit code")
      first = 1
      do while (first <= len(words))
         last = first + index(words(first:)//"|", "|") - 2
         call check_contains(error%message, words(first:last), what)
         first = last + 2
      end do
      call check(len(error%message) <= longest_message, what//": short message")
      call check(all([(iachar(error%message(i:i)) >= 32, i = 1, len(error%message))]), what &
         & //": one line")
   end subroutine check_error

   !> Write the scratch file
   subroutine write_file(text)
      !> Its bytes
      character(len=*), intent(in) :: text
      integer :: unit

      open(newunit=unit, file=scratch, status="replace", action="write", access="stream", &
         & form="unformatted")
      write(unit) text
      close(unit)
   end subroutine write_file

   !> Remove the scratch file
   subroutine remove_file()
      integer :: unit

      open(newunit=unit, file=scratch, status="old")
      close(unit, status="delete")
   end subroutine remove_file

end program test_namelist
