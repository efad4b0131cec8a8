!> The validated case: values and defaults, what contradicts itself, options, and the way back to a
!> namelist
program test_case
   use, intrinsic :: ieee_arithmetic, only : ieee_is_nan, ieee_quiet_nan, ieee_value
   use vcor_error, only : error_input, error_t, error_usage
   use vcor_io_case_reader, only : override, read_case_text
   use vcor_kinds, only : wp
   use vcor_case_address, only : resolve
   use vcor_case_case, only : case_t
   use vcor_case_checks, only : validate
   use vcor_case_entries, only : address_t, entry_t, operator(==)
   use vcor_case_printed, only : case_text
   use vcor_case_problem, only : problem_of_case, problem_t
   use vcor_case_catalogue, only : catalogue, find_group, find_key, first_row, groups, last_row
   use vcor_impact_shape, only : find_shape, other_shapes, shape_parameters, shapes, sphere_shapes
   use vcor_solver_features, only : method_choices, method_table, methods
   use vcor_words, only : contains_word, edit_distance, list_of_words, nearest_name
   use vcor_number, only : real_text
   use vcor_text, only : integer_text, is_utf8, printable, quoted, shortened
   use vcor_test, only : check, check_close, check_contains, check_text, finish, suite
   implicit none

   character(len=*), parameter :: lf = achar(10)
   character(len=*), parameter :: impact = "&impact velocity = 5.0 /"//lf
   character(len=*), parameter :: sphere = "&sphere radius = 0.01, material = 'steel' /"//lf
   character(len=*), &
      & parameter :: plate = "&plate half_thickness = 0.005, material = 'sls rubber' /"//lf
   character(len=*), &
      & parameter :: steel = "&material name = 'steel', model = 'rigid', density = 7800.0 /"//lf
   character(len=*), &
      & parameter :: rubber = "&material name = 'sls rubber', model = 'sls', density = 1100.0," &
      & //" poisson_ratio = 0.5, glassy_modulus = 1.0e7, alpha = 250.0, beta = 1000.0 /"//lf
   !> A case with nothing wrong: impact in line 1, sphere 2, plate 3, steel 4, rubber 5
   character(len=*), parameter :: good = impact//sphere//plate//steel//rubber

   call suite("case")
   call test_catalogue()
   call test_tables()
   call test_values()
   call test_places()
   call test_missing()
   call test_ranges()
   call test_models()
   call test_prony()
   call test_bodies()
   call test_overrides()
   call test_wrong_overrides()
   call test_addresses()
   call test_printing()
   call test_round_trips()
   call test_number_texts()
   call test_words()
   call finish()

contains

   !> The catalogue agrees with itself: what its readers rely on
   subroutine test_catalogue()
      integer :: row, group

      do group = 1, size(groups)
         associate (here => groups(group))
            call check(is_short(here%name) .and. is_short(here%meaning) .and. is_short(here%label) &
               & .and. is_short(here%selector), trim(here%name)//" does not fill its texts")
         end associate
         call check(first_row(group) <= last_row(group), trim(groups(group)%name)//" has keys")
         call check(all(catalogue(first_row(group):last_row(group))%group == groups(group)%name), &
            & trim(groups(group)%name)//" is in one place")
         call check(find_group(groups(group)%name) == group, trim(groups(group)%name)//" is found")
      end do
      call check(first_row(1) == 1 .and. last_row(size(groups)) == size(catalogue), &
         & "each row has its group")
      do row = 1, size(catalogue)
         call check(catalogue(row)%value_kind >= 1 .and. catalogue(row)%value_kind <= 5, &
            & trim(catalogue(row)%name)//" has a kind")
         call check(catalogue(row)%meaning /= "", trim(catalogue(row)%name)//" has a meaning")
         associate (key => catalogue(row))
            call check(is_short(key%group) .and. is_short(key%name) .and. is_short(key%meaning) &
               & .and. is_short(key%unit) .and. is_short(key%choices) .and. is_short(key%default) &
               & .and. is_short(key%models), trim(key%name)//" does not fill its texts")
         end associate
         call check(.not. catalogue(row)%required .or. catalogue(row)%default == "", &
            & trim(catalogue(row)%name)//" is required or has a default")
      end do
      call check(find_key("IMPACT", "Velocity") == find_key("impact", "velocity"), &
         & "names in any case are found")
      call check(find_key("impact", "speed") == 0, "what is not there is not found")
      call check(find_key("impact", repeat("velocity", 20)) == 0, "nor is what is too long")
   end subroutine test_catalogue

   !> The tables of shapes and methods: each name has one row, no row lacks a text, and the names of
   !> the keys are those of the rows
   subroutine test_tables()
      character(len=*), parameter :: names = sphere_shapes//" "//other_shapes
      character(len=:), allocatable :: name
      integer :: i

      call check(size(list_of_words(names)) == size(shapes), "a row for each name of a shape")
      do i = 1, size(shapes)
         name = trim(shapes(i)%name)
         call check(contains_word(names, name) .and. find_shape(name) == i, name//" is a choice")
         call check(shapes(i)%meaning /= "" .and. is_short(shapes(i)%meaning), &
            & name//" is explained")
         call check(contains_word(sphere_shapes, name) &
            & .or. any(shape_parameters%shape == shapes(i)%name), name//" has numbers")
      end do
      do i = 1, size(shape_parameters)
         associate (number => shape_parameters(i)%parameter)
            name = trim(number%name)
            call check(find_shape(trim(shape_parameters(i)%shape)) > 0, name//" is of a shape")
            call check(number%meaning /= "" .and. is_short(number%meaning) &
               & .and. is_short(number%unit), name//" is explained")
            call check(count(shape_parameters%parameter%name == number%name) == 1, &
               & name//" stands for one number")
         end associate
      end do
      do i = 1, size(list_of_words(method_choices))
         associate (words => list_of_words(method_choices))
            name = trim(words(i))
         end associate
         call check(name == "auto" .or. count(methods == name) == 1, name//" has a row")
      end do
      do i = 1, size(methods)
         associate (method => method_table(i))
            name = trim(method%name)
            call check(method%meaning /= "" .and. is_short(method%meaning) .and. method%keys /= "" &
               & .and. is_short(method%keys), name//" is explained")
            call check(method%accuracy > 0.0_wp, name//" has an accuracy")
            ! a scheme of another method has a key of its own
            call check(contains_word(method_choices, name) .or. index(method%keys, "scheme") > 0, &
               & name//" can be chosen")
         end associate
      end do
   end subroutine test_tables

   !> Whether a text of fixed length has room at its end: one that is cut off has none
   pure function is_short(text) result(yes)
      !> The text
      character(len=*), intent(in) :: text
      !> Whether it has
      logical :: yes

      yes = len_trim(text) < len(text)
   end function is_short

   !> Values and defaults of each kind
   subroutine test_values()
      type(case_t) :: case
      type(error_t), allocatable :: error
      character(len=:), allocatable :: text
      real(wp), allocatable :: list(:)
      real(wp) :: number
      integer :: whole
      logical :: flag

      call read_case_text(case, good, "folder/run.v2.nml", error)
      call check(.not. allocated(error), "the good case is read")
      call validate(case, error)
      call check(.not. allocated(error), "the good case is valid")

      call case%get("impact", "velocity", number)
      call check_close(number, 5.0_wp, 0.0_wp, "velocity")
      call case%get("Material", "DENSITY", number, 2)
      call check_close(number, 1100.0_wp, 0.0_wp, "density of the second material")
      call case%get("sphere", "material", text)
      call check_text(text, "steel", "material of the sphere")
      call check(case%count("material") == 2, "two materials")
      call check(case%count("solver") == 0, "no solver")
      call check(case%given("impact", "velocity"), "velocity is given")
      call check(.not. case%given("sphere", "mass"), "mass is not given")
      call check(.not. has_value(case, "sphere", "mass"), "mass has no value")
      call case%get("sphere", "mass", number)
      call check(ieee_is_nan(number), "the mass that is not there is NaN")

      call case%get("solver", "method", text)
      call check_text(text, "auto", "default of a text")
      call check(has_value(case, "solver", "method"), "a default is a value")
      call check(.not. case%given("solver", "method"), "a default is not given")
      call case%get("solver", "volterra_order", whole)
      call check(whole == 1, "default of an integer")
      call case%get("solver", "volterra_coefficient", number)
      call check_close(number, 1.0_wp, 0.0_wp, "default of a number")
      call case%get("output", "csv", flag)
      call check(flag, "default of a logical, true")
      call case%get("solver", "continue_after_separation", flag)
      call check(.not. flag, "default of a logical, false")
      call case%get("case", "title", text)
      call check_text(text, "", "default of the title")
      call check(has_value(case, "case", "title"), "the empty title is a value")
      call check(.not. has_value(case, "solver", "accuracy"), "the accuracy has no default")
      call case%get("output", "stem", text)
      call check_text(text, "run.v2", "the stem is from the file name")
      call case%get("material", "moduli", list, 2)
      call check(size(list) == 0, "a list that is not there is empty")
      call case%get("material", "density", number, 3)
      call check(ieee_is_nan(number), "a value of a material that is not there is NaN")
      call case%get("solver", "no_such_key", whole)
      call check(whole == -huge(whole), "an integer that is not there")

      call check(case%find_material("STEEL") == 1, "material in upper case")
      call check(case%find_material("sls_rubber") == 2, "underscore for a blank")
      call check(case%find_material("rubber") == 0, "no such material")

      call read_case_text(case, "&impact /", ".nml", error)
      call case%get("output", "stem", text)
      call check_text(text, ".nml", "a file name that is an extension")
      call read_case_text(case, "&impact /", "-", error)
      call case%get("output", "stem", text)
      call check_text(text, "-", "a file name without extension")
      call read_case_text(case, "&plate waves = ' CONSTANT ' /", "x.nml", error)
      call case%get("plate", "waves", text)
      call check_text(text, "constant", "a choice in upper case")
   end subroutine test_values

   !> Where a value was given
   subroutine test_places()
      type(case_t) :: case
      type(error_t), allocatable :: error

      call read_case_text(case, "! comment"//lf//"&impact"//lf//lf//" velocity = 5.0 /"//lf &
         & //good(len(impact)+1:), "dir/case.nml", error)
      call check_text(case%location("impact", "velocity"), "dir/case.nml:4", "line of a key")
      call check_text(case%location("sphere", "mass"), "dir/case.nml:5", &
         & "line of the group without the key")
      call check_text(case%location("material", "beta", 2), "dir/case.nml:8", &
         & "line in the second material")
      call check_text(case%location("solver", "method"), "dir/case.nml", "file without the group")
      call check_text(case%location("material", "beta", 7), "dir/case.nml", "file without the item")
      call override(case, "sphere.mass=0.1", error, option="--set")
      call check_text(case%location("sphere", "mass"), "--set sphere.mass", "an option")
   end subroutine test_places

   !> What must be there
   subroutine test_missing()
      call refuses(sphere//plate//steel//rubber, "x.nml: |no &impact group|velocity", "no impact")
      call refuses(impact//plate//steel//rubber, "no &sphere group|radius, material", "no sphere")
      call refuses(impact//sphere//steel//rubber, "no &plate group", "no plate")
      call refuses(impact//sphere//plate, "no &material group|name, model", "no material")
      call refuses("&impact /"//lf//good(len(impact)+1:), &
         & "x.nml:1: |'velocity' is missing in &impact|number > 0 [m/s]", "no velocity")
      call refuses(impact//"&sphere material = 'steel' /"//lf//plate//steel//rubber, &
         & "x.nml:2: |'radius'", "no radius")
      call refuses(good//"&material model = 'rigid' /", "x.nml:6: |'name' is missing", "no name")
      call refuses(good//"&material name = 'x' /", &
         & "x.nml:6: |'model' is missing|'x'|one of rigid", "no model")
      call refuses_material("model='elastic' modulus=1", &
         & "'poisson_ratio' is missing|'m'|'elastic'|in (-1, 0.5]")
      call refuses_material("model='sls' poisson_ratio=0 alpha=1 beta=1", &
         & "'glassy_modulus' is missing")
      call refuses_material("model='cerf' poisson_ratio=0 relaxing_modulus=1", &
         & "'beta' is missing|[s^-1/2]")
      call refuses_material("model='power_law' poisson_ratio=0 coefficient=1", &
         & "'exponent' is missing|in (0, 1)")
      call accepts(good//"&material name = 'm' model = 'rigid' /", &
         & "rigid without density and Poisson's ratio")
      call accepts(good//"&material name = 'm' model = 'rigid' poisson_ratio = 0.3 /", &
         & "rigid with Poisson's ratio")
   end subroutine test_missing

   !> Ranges
   subroutine test_ranges()
      call refuses("&impact velocity = 0.0 /"//good(len(impact):), &
         & "x.nml:1: |velocity: found 0.0, expected a number > 0", &
         & "zero velocity")
      call refuses("&impact velocity = -5.0 /"//good(len(impact):), "velocity: found -5.0", &
         & "negative velocity")
      call refuses(impact//"&sphere radius=-0.01 material='steel' /"//lf//plate//steel//rubber, &
         & "x.nml:2: |radius: found -0.01, expected a number > 0 [m]", "negative radius")
      call refuses_material("model='elastic' modulus=1 poisson_ratio=-1", &
         & "poisson_ratio: found -1.0|in (-1, 0.5]")
      call refuses_material("model='elastic' modulus=1 poisson_ratio=0.51", &
         & "poisson_ratio: found 0.51")
      call refuses_material("model='rigid' poisson_ratio=0.51", "poisson_ratio: found 0.51")
      call refuses_material("model='elastic' modulus=0 poisson_ratio=0", &
         & "modulus: found 0.0, expected a number > 0 [Pa]")
      call refuses_material("model='elastic' density=0 modulus=1 poisson_ratio=0", &
         & "density: found 0.0")
      call refuses_material("model='power_law' poisson_ratio=0 coefficient=1 exponent=1", &
         & "exponent: found 1.0|in (0, 1)")
      call refuses_material("model='mittag_leffler' poisson_ratio=0 relaxing_modulus=1 time=1 " &
         & //"exponent=1.2", "exponent: found 1.2|in (0, 1]")
      call refuses_material("model='mittag_leffler' poisson_ratio=0 relaxing_modulus=1 time=0 " &
         & //"exponent=1", "time: found 0.0|> 0 [s]")
      call refuses_material("model='cerf' poisson_ratio=0 relaxing_modulus=1 beta=0", &
         & "beta: found 0.0|> 0 [s^-1/2]")
      call refuses_material("model='sls' poisson_ratio=0 glassy_modulus=1 alpha=-1 beta=0", &
         & "alpha: found -1.0|>= 0 [1/s]")
      call refuses_material("model='prony' poisson_ratio=0 moduli=1,-2 rates=1,1", &
         & "moduli: found -2.0 in value 2")
      call refuses_material("model='prony' poisson_ratio=0 moduli=1,2 rates=1,0", &
         & "rates: found 0.0 in value 2")
      call refuses_material("model='prony' poisson_ratio=0 viscosity=-1", "viscosity: found -1.0")
      call refuses_material("model='jelly'", &
         & "model: found 'jelly', expected one of rigid, elastic, sls")
      call refuses(good//"&solver accuracy = 1.0 /", &
         & "accuracy: found 1.0, expected a number in [1.0e-11, 0.1]", "accuracy")
      call refuses(good//"&solver volterra_order = 3 /", &
         & "volterra_order: found 3, expected a whole number in [1, 2]", &
         & "order")
      call refuses(good//"&solver method = 'fast' /", &
         & "method: found 'fast', expected one of auto, ive, direct", "method")
      call refuses(good//"&output directory = '' /", "directory: found an empty text", &
         & "empty directory")
      call refuses(good//"&solver time_step = 1e-3, end_time = 1e-3 /", "time_step < end_time", &
         & "one step")
      call accepts(good//"&case title = '' / &solver volterra_order = 2, accuracy = 1e-11 /", &
         & "bounds that are inside")
   end subroutine test_ranges

   !> Models and their keys
   subroutine test_models()
      call accepts_material("model='elastic' modulus=1e6 poisson_ratio=0.5")
      call accepts_material("model='Power_Law' coefficient=1e6 exponent=.5 poisson_ratio=-0.9")
      call accepts_material("model='cerf' relaxing_modulus=1 beta=1 poisson_ratio=0 " &
         & //"equilibrium_modulus=0")
      call accepts_material("model='mittag_leffler' relaxing_modulus=1 exponent=1 time=1e-6 " &
         & //"poisson_ratio=0")
      call refuses_material("model='cerf' relaxing_modulus=1 beta=1 time=1 poisson_ratio=0", &
         & "'time' does not belong to model 'cerf'")
      call accepts_material("model='sls' glassy_modulus=1 alpha=0 beta=0 poisson_ratio=0")
      call accepts_material("model='sls' glassy_modulus=1 alpha=3 beta=3 poisson_ratio=0")
      call refuses_material("model='sls' glassy_modulus=1 alpha=3.5 beta=3 poisson_ratio=0", &
         & "found alpha = 3.5 and beta = 3.0|rubbery modulus|exceeds the glassy one")
      call refuses_material("model='sls' glassy_modulus=1 alpha=3 beta=0 poisson_ratio=0", &
         & "found alpha = 3.0 and beta = 0.0|alpha <= beta")
      call refuses(good//lf//"&material name='m' model='elastic' poisson_ratio=0 modulus=1"//lf &
         & //"beta=1 /", "x.nml:8: |key 'beta' does not belong to model 'elastic'|modulus", &
         & "key of another model")
      call refuses_material("model='rigid' modulus=1", "'modulus' does not belong to model 'rigid'")
      call refuses_material("model='power_law' moduli=1 poisson_ratio=0", &
         & "'moduli' does not belong to model 'power_law'")
      call refuses(good//"&material name = 'STEEL' model = 'rigid' /", &
         & "x.nml:6: |two materials|'STEEL'|x.nml:4", &
         & "name twice")
      call refuses(good//"&material name = 'SLS_rubber' model = 'rigid' /", "two materials", &
         & "name twice, underscore")
      call refuses(good//"&material name = ' ' model = 'rigid' /", "name: found an empty text", &
         & "empty name")
   end subroutine test_models

   !> Prony series
   subroutine test_prony()
      character(len=*), parameter :: prony = "model='prony' poisson_ratio=0.5 "

      call accepts_material(prony//"moduli=1,2 rates=3,4")
      call accepts_material(prony//"moduli=1,2 times=3,4")
      call accepts_material(prony//"viscosity=1")
      call accepts_material(prony//"equilibrium_modulus=1")
      call accepts_material(prony//"equilibrium_modulus=1 viscosity=1")
      call refuses_material(prony, "no stiffness|moduli, viscosity > 0 or equilibrium_modulus > 0")
      call refuses_material(prony//"equilibrium_modulus=0 viscosity=0", "no stiffness")
      call refuses_material(prony//"moduli=1,2 rates=3,4,5", "found 3 rates and 2 moduli")
      call refuses_material(prony//"moduli=1,2 times=3", "found 1 times and 2 moduli")
      call refuses_material(prony//"moduli=1,2 rates=3,4 times=3,4", "both rates and times")
      call refuses_material(prony//"moduli=1,2", "2 moduli|as many rates as moduli")
      call refuses_material(prony//"rates=1,2", "2 rates|as many rates as moduli")
      call refuses_material(prony//"times=1,2 viscosity=1", "2 times|as many rates as moduli")
   end subroutine test_prony

   !> Sphere and plate
   subroutine test_bodies()
      character(len=*), parameter :: light = "&material name='light' model='elastic' modulus=1 " &
         & //"poisson_ratio=0 /"//lf

      call refuses(impact//"&sphere radius=0.01 material='steal' /"//lf//plate//steel//rubber, &
         & "x.nml:2: |no material 'steal' for &sphere|did you mean 'steel'?", "misspelt material")
      call refuses(impact//sphere//"&plate half_thickness=1 material='wood' /"//lf//steel//rubber, &
         & "x.nml:3: |no material 'wood' for &plate|known: steel, sls_rubber", "unknown material")
      call refuses(impact//"&sphere radius=0.01 material='light' /"//lf//plate//light//rubber, &
         & "x.nml:4: |'density' is missing|'light'|mass of the sphere", "sphere without density")
      call accepts(impact//"&sphere radius=0.01 material='light' mass=0.1 /"//lf//plate//light &
         & //rubber, "mass makes up for the density")
      call refuses(impact//sphere//"&plate half_thickness=1 material='light' /"//lf//steel//light, &
         & "x.nml:5: |'density' is missing|'light'|plate|waves = 'none'", &
         & "plate without density")
      call refuses(impact//sphere//"&plate material='sls_rubber' /"//lf//steel//rubber, &
         & "x.nml:3: |'half_thickness' is missing in &plate|waves = 'none'", &
         & "plate without thickness")
      call accepts(impact//sphere//"&plate material='light' waves='none' /"//lf//steel//light, &
         & "a half space needs neither thickness nor density")
      call accepts(impact//"&sphere radius=0.01 material='sls rubber' /"//lf &
         & //"&plate material='steel' /"//lf//steel &
         & //rubber, "a rigid plate does not move")
      call refuses(impact//sphere//"&plate material='steel' /"//lf//steel, "both rigid", &
         & "nothing deforms")
      call refuses(impact//sphere &
         & //"&plate material='sls rubber' half_thickness=1 surface_radius=-0.01 /"//lf//steel &
         & //rubber, "x.nml:3: |surface_radius = -0.01 and radius = 0.01|larger radius", &
         & "hollow as narrow as the sphere")
      call accepts(impact//sphere &
         & //"&plate material='sls rubber' half_thickness=1 surface_radius=-0.02 /"//lf//steel &
         & //rubber, "hollow wider than the sphere")
      call accepts(impact//sphere &
         & //"&plate material='sls rubber' half_thickness=1 surface_radius=0.001 /"//lf//steel &
         & //rubber, "small sphere")
   end subroutine test_bodies

   !> Options that override
   subroutine test_overrides()
      type(case_t) :: case
      type(error_t), allocatable :: error
      character(len=:), allocatable :: text
      real(wp), allocatable :: list(:)
      integer :: whole
      logical :: flag

      call read_case_text(case, good &
         & //"&material name='p.1 = x', model='prony' poisson_ratio=0 viscosity=1 /" &
         & //"&material name='plate' model='rigid' /", "x.nml", error)
      call sets_number(case, "impact.velocity=2.5", "impact", "velocity", 1, 2.5_wp)
      call sets_number(case, " Impact.VELOCITY = 1d1 ", "impact", "velocity", 1, 10.0_wp)
      call sets_number(case, "sls_rubber.beta=500", "material", "beta", 2, 500.0_wp)
      call sets_number(case, "'sls rubber'.beta=600", "material", "beta", 2, 600.0_wp)
      call sets_number(case, """SLS rubber"".beta=700", "material", "beta", 2, 700.0_wp)
      call sets_number(case, "sls rubber.beta=800", "material", "beta", 2, 800.0_wp)
      call sets_number(case, "'p.1 = x'.viscosity=2", "material", "viscosity", 3, 2.0_wp)
      call sets_number(case, "plate.half_thickness=0.1", "plate", "half_thickness", 1, 0.1_wp)
      call sets_number(case, "plate.density=5", "material", "density", 4, 5.0_wp)
      call sets_number(case, "solver.time_step=1e-6", "solver", "time_step", 1, 1.0e-6_wp)
      call check(case%count("solver") == 1, "an option makes its group")
      call override(case, "solver.volterra_order=2", error)
      call case%get("solver", "volterra_order", whole)
      call check(whole == 2, "integer by option")
      call override(case, "output.csv=F", error)
      call case%get("output", "csv", flag)
      call check(.not. flag, "logical by option")
      call override(case, "p.1 = x.moduli=1,2", error)
      call check(allocated(error), "a name with an equals sign needs quotes")
      call override(case, "'p.1 = x'.moduli=1, 2*2", error, option="--set")
      call case%get("material", "moduli", list, 3)
      call check(size(list) == 3, "list by option")
      call override(case, "solver.method=IVE", error)
      call case%get("solver", "method", text)
      call check_text(text, "ive", "choice by option, without quotes")
      call override(case, "case.title=it's / = & a title!", error)
      call case%get("case", "title", text)
      call check_text(text, "it's / = & a title!", "text by option, without quotes")
      call override(case, "case.title='it''s a title'", error)
      call case%get("case", "title", text)
      call check_text(text, "it's a title", "text by option, in quotes")
      call override(case, "case.title=''", error)
      call case%get("case", "title", text)
      call check_text(text, "", "empty text by option")
      call build(case, error)
      call check_error(error, error_input, &
         & "--set 'p.1 = x'.moduli: |3 moduli|as many rates as moduli", "contradiction by option")

      call read_case_text(case, "&material name='''0''' / &material name='it''s' /", "x.nml", error)
      call sets_number(case, "'0'.density=1", "material", "density", 1, 1.0_wp)
      call sets_number(case, "'''0'''.density=2", "material", "density", 1, 2.0_wp)
      call sets_number(case, "it's.density=3", "material", "density", 2, 3.0_wp)
      call sets_number(case, "'it''s'.density=4", "material", "density", 2, 4.0_wp)

      call read_case_text(case, impact//sphere//plate//rubber, "x.nml", error)
      call sets_number(case, "material.beta=300", "material", "beta", 1, 300.0_wp)
      call override(case, "sphere.material=sls rubber", error, option="--set")
      call validate(case, error)
      call check(.not. allocated(error), "an option mends a case")
   end subroutine test_overrides

   !> Options that cannot be understood or are out of range
   subroutine test_wrong_overrides()
      call refuses_option("", error_usage, "expected group.key=value")
      call refuses_option("impact.velocity", error_usage, &
         & "--set impact.velocity: |expected group.key=value")
      call refuses_option("=5", error_usage, "expected group.key=value")
      call refuses_option("velocity=5", error_usage, &
         & "'velocity', expected group.key or material_name.key")
      call refuses_option(".velocity=5", error_usage, "expected group.key")
      call refuses_option("impact.=5", error_usage, "expected group.key")
      call refuses_option("impact.velocity=", error_usage, "no value")
      call refuses_option("impact.veloctiy=5", error_usage, &
         & "--set impact.veloctiy: |did you mean 'velocity'?")
      call refuses_option("impcat.velocity=5", error_usage, &
         & "'impcat' is neither a group nor a material|'impact'")
      call refuses_option("sls_ruber.beta=5", error_usage, &
         & "'sls_ruber' is neither|did you mean 'sls_rubber'?")
      call refuses_option("wood.beta=5", error_usage, &
         & "'wood'|known: case, impact|steel, sls_rubber")
      call refuses_option("steel.colour=5", error_usage, &
         & "unknown key 'colour' in &material|known: name")
      call refuses_option("'impact'.velocity=5", error_usage, "'impact' is neither")
      call refuses_option("'sls rubber.beta=5", error_usage, "did you mean 'sls_rubber'?")
      call refuses_option("material.beta=5", error_usage, "2 &material groups|steel, sls_rubber")
      call refuses_option("impact.velocity=fast", error_usage, &
         & "'fast', expected a number > 0 [m/s]")
      call refuses_option("impact.velocity=NaN", error_usage, "finite")
      call refuses_option("impact.velocity=1e400", error_usage, "too large")
      call refuses_option("impact.velocity=1,5", error_usage, "decimal point")
      call refuses_option("impact.velocity=5 /", error_usage, "'5 /', expected a number")
      call refuses_option("impact.velocity=5 radius=6", error_usage, &
         & "'5 radius=6'|expected a number")
      call refuses_option("impact.velocity=5 'x", error_usage, "'x is cut off")
      call refuses_option("impact.velocity=!5", error_usage, "'!5', expected a number")
      call refuses_option("case.title='no end", error_usage, "'no end is cut off|closing quote")
      call refuses_option("case.title=a"//achar(10)//"b", error_usage, "control character")
      call refuses_option("solver.volterra_order=1.5", error_usage, "whole number")
      call refuses_option("impact.velocity=-5", error_input, &
         & "--set impact.velocity: |found -5.0, expected a number > 0")
      call refuses_option("solver.method=fast", error_input, &
         & "found 'fast', expected one of auto, ive, direct")
      call refuses_option("steel.poisson_ratio=0.6", error_input, "in (-1, 0.5]")
   end subroutine test_wrong_overrides

   !> Addresses, for sweeps
   subroutine test_addresses()
      type(case_t) :: case, copy
      type(error_t), allocatable :: error
      character(len=:), allocatable :: message
      real(wp) :: number
      type(address_t) :: address
      integer :: i, whole

      call read_case_text(case, good, "x.nml", error)
      call resolve(case, "sls_rubber.beta", address, message)
      call check(.not. allocated(message), "a path is resolved")
      call check(address == case%address("material", "beta", 2), "path and name lead to the same")
      call check_text(case%path(address), "sls_rubber.beta", "path of an address")
      call check_text(case%path(case%address("impact", "velocity")), "impact.velocity", &
         & "another path")
      copy = case
      do i = 1, 1001
         call copy%set(address, real(i, wp))
      end do
      call copy%get("material", "beta", number, 2)
      call check_close(number, 1001.0_wp, 0.0_wp, "the number that was set")
      call case%get("material", "beta", number, 2)
      call check_close(number, 1000.0_wp, 0.0_wp, "the other case has its own")
      call case%set(case%address("solver", "volterra_order"), 2.0_wp)
      call case%get("solver", "volterra_order", whole)
      call check(whole == 2, "an integer is set")
      call check(case%count("solver") == 1, "its group is there then")
      call check(case%address("material", "beta", 3) == address_t(), "no third material")
   end subroutine test_addresses

   !> A case as text
   subroutine test_printing()
      type(case_t) :: case
      type(error_t), allocatable :: error
      character(len=:), allocatable :: text

      call read_case_text(case, "&impact velocity = 5 / &case title = 'it''s' / &solver /", &
         & "x.nml", error)
      call check_text(case_text(case), "&case"//lf//"   title = 'it''s'"//lf//"/"//lf//lf &
         & //"&impact"//lf//"   velocity = 5.0"//lf//"/"//lf//lf//"&solver"//lf//"/"//lf, &
         & "what was given")
      text = case_text(case, complete=.true.)
      call check_contains(text, "   stem = 'x'"//lf, "stem of the complete case")
      call check_contains(text, "   continue_after_separation = .false."//lf, &
         & "logical of the complete case")
      call check_contains(text, "   volterra_order = 1"//lf, "integer of the complete case")
      call check(index(text, "accuracy") == 0, "what has no value is not printed")
      text = case_text(case, complete=.true., remarks=.true.)
      call check_contains(text, "! [m/s] Approach velocity", "remark with unit")
      call check_contains(text, "(default)", "remark on a default")
   end subroutine test_printing

   !> Whether a key has a value, given or by default
   pure function has_value(case, group, key) result(yes)
      !> The case
      type(case_t), intent(in) :: case
      !> Name of the group
      character(len=*), intent(in) :: group
      !> Name of the key
      character(len=*), intent(in) :: key
      !> Whether it has
      logical :: yes

      type(entry_t) :: entry

      entry = case%entry(case%address(group, key))
      yes = entry%present
   end function has_value

   !> Text to case to text to case
   subroutine test_round_trips()
      call round_trip(good, "plain case")
      call round_trip(good//"&case title = 'a ''tricky'' ""title"" ! / & , = Stoß' /", &
         & "tricky title")
      call round_trip(good &
         & //"&solver time_step = 1.2345678901234567e-6, accuracy=1e-9 volterra_coefficient=-.1 /" &
         & //"&output stem = 'it''s', csv = f, directory = '/tmp/a b' /", "many digits")
      call round_trip(good &
         & //"&material name='p' model='prony' poisson_ratio=.3 equilibrium_modulus=1e5" &
         & //" moduli = 2*1.1e6, 3e7, times = .1 .01 0.001 /", "prony with repeats")
      call round_trip(good//"&material name='p' model='prony' poisson_ratio=.3 moduli=" &
         & //repeat("0.1234567890123,", 100) &
         & //" rates="//repeat("1.5d-7 ", 100)//"/", "long lists")
      call round_trip(good &
         & //"&material name='c' model='cerf' poisson_ratio=.3 relaxing_modulus=1 beta=0.1 /" &
         & //"&material name='w' model='power_law' poisson_ratio=.3 coefficient=1e59" &
         & //" exponent=0.3333333333333333 /" &
         & //"&material name='e' model='elastic' poisson_ratio=.3 modulus=2.1e11 /", &
         & "the other models")
   end subroutine test_round_trips

   !> Shortest texts of numbers
   subroutine test_number_texts()
      real(wp) :: number, back
      character(len=:), allocatable :: text
      integer :: i, differences

      call check_text(real_text(0.0_wp), "0.0", "zero")
      call check_text(real_text(1.0_wp), "1.0", "one")
      call check_text(real_text(-0.01_wp), "-0.01", "negative hundredth")
      call check_text(real_text(1.0e-3_wp/3.0_wp), "0.0003333333333333333", "sixteen digits")
      call check_text(real_text(1.0e-5_wp), "1.0e-5", "small")
      call check_text(real_text(7.0e10_wp), "7.0e10", "large")
      call check_text(real_text(123456.5_wp), "123456.5", "with a fraction")
      call check_text(real_text(1.0e6_wp), "1.0e6", "a million")
      call check_text(real_text(0.1_wp + 0.2_wp), "0.30000000000000004", "seventeen digits")
      call check_text(real_text(huge(1.0_wp)), "1.7976931348623157e308", "the largest")
      call check_text(real_text(tiny(1.0_wp)), "2.2250738585072014e-308", "the smallest")
      call check_text(real_text(ieee_value(1.0_wp, ieee_quiet_nan)), "NaN", "not a number")
      number = 1.0e-290_wp
      differences = 0
      do i = 1, 2000
         number = number*1.9437120001_wp
         text = real_text(number)
         read(text, *) back
         if (abs(back - number) > 0.0_wp) differences = differences + 1
      end do
      call check(differences == 0, "numbers are read back as they were")
   end subroutine test_number_texts

   !> Words of others, near ones and strange ones
   subroutine test_words()
      call check(edit_distance("velocity", "velocity") == 0, "same word")
      call check(edit_distance("veloctiy", "velocity") == 1, "two letters swapped")
      call check(edit_distance("", "abc") == 3, "three letters put in")
      call check(edit_distance("kitten", "sitting") == 3, "kitten and sitting")
      call check_text(nearest_name("RADUIS", "radius mass material"), "radius", &
         & "nearest in upper case")
      call check_text(nearest_name("x", "radius mass"), "", "nothing is near")
      call check_text(nearest_name("x", "s a e"), "", "no other letter is near")
      call check_text(nearest_name("E", "s a e"), "e", "the same letter is")
      call check_text(nearest_name("velocity", "validity impact.velocity"), "impact.velocity", &
         & "near without its group")
      call check_text(nearest_name("equil", "density equilibrium_modulus"), &
         & "equilibrium_modulus", "a beginning")
      call check_text(quoted("it's"), "'it''s'", "quotes")
      call check_text(printable("a"//achar(27)//"b"//achar(9)//"c"//char(233)), "a?b c?", &
         & "what cannot be shown")
      call check_text(printable("ß"//char(194)//char(155)//"m"), "ß??m", &
         & "the other control characters")
      call check(len(shortened(repeat("ß", 500))) <= 60, "a long text is shortened")
      call check(is_utf8(shortened("x"//repeat("ß", 500))), "between letters")
      call check(is_utf8("Stoß β €"), "UTF-8")
      call check(.not. is_utf8("Sto"//char(223)), "Latin-1 is not UTF-8")
      call check(.not. is_utf8(char(192)//char(128)), "a form that is too long is not UTF-8")
      call check(.not. is_utf8(char(237)//char(160)//char(128)), "a surrogate is not UTF-8")
   end subroutine test_words

   !> Check that a case is the same after printing and reading, and its text, too
   subroutine round_trip(text, what)
      !> A valid case
      character(len=*), intent(in) :: text
      !> What is special about it
      character(len=*), intent(in) :: what
      type(case_t) :: first, second
      type(error_t), allocatable :: error

      call read_case_text(first, text, "x.nml", error)
      call check(.not. allocated(error), what//" is read")
      call validate(first, error)
      call check(.not. allocated(error), what//" is valid")
      call read_case_text(second, case_text(first), "x.nml", error)
      call check(.not. allocated(error), what//" is read again")
      call check_text(case_text(second), case_text(first), what)
      call check_text(case_text(second, complete=.true.), case_text(first, complete=.true.), what &
         & //", complete")
      call read_case_text(second, case_text(first, complete=.true., remarks=.true.), "y.nml", error)
      call check(.not. allocated(error), what//" is read again with remarks")
      call validate(second, error)
      call check(.not. allocated(error), what//" is valid with its defaults")
      call check_text(case_text(second), case_text(first, complete=.true.), what &
         & //", complete and given")
   end subroutine round_trip

   !> Check that an option sets a number
   subroutine sets_number(case, setting, group, key, item, number)
      !> The case
      type(case_t), intent(inout) :: case
      !> The option's value
      character(len=*), intent(in) :: setting
      !> Group that is meant
      character(len=*), intent(in) :: group
      !> Key that is meant
      character(len=*), intent(in) :: key
      !> Item that is meant
      integer, intent(in) :: item
      !> The number
      real(wp), intent(in) :: number
      type(error_t), allocatable :: error
      real(wp) :: found

      call override(case, setting, error, option="--set")
      call check(.not. allocated(error), setting//" is understood")
      call case%get(group, key, found, item)
      call check_close(found, number, 0.0_wp, setting)
   end subroutine sets_number

   !> Check that an option is refused
   subroutine refuses_option(setting, code, words)
      !> The option's value
      character(len=*), intent(in) :: setting
      !> Code of the error
      integer, intent(in) :: code
      !> Parts of the message, separated by bars
      character(len=*), intent(in) :: words
      type(case_t) :: case
      type(error_t), allocatable :: error
      character(len=:), allocatable :: before

      call read_case_text(case, good, "x.nml", error)
      before = case_text(case)
      call override(case, setting, error, option="--set")
      call check_error(error, code, "--set |"//words, "--set "//printable(setting))
      call check_text(case_text(case), before, setting//" changes nothing")
   end subroutine refuses_option

   !> Check that a case is valid
   subroutine accepts(text, what)
      !> The case
      character(len=*), intent(in) :: text
      !> What is special about it
      character(len=*), intent(in) :: what
      type(case_t) :: case
      type(error_t), allocatable :: error

      call read_case_text(case, text, "x.nml", error)
      call check(.not. allocated(error), what//": is read")
      call build(case, error)
      call check(.not. allocated(error), what)
   end subroutine accepts

   !> Check a case and build its impact
   subroutine build(case, error)
      !> The case
      type(case_t), intent(in) :: case
      !> What is wrong, unallocated on success
      type(error_t), allocatable, intent(out) :: error
      type(problem_t) :: problem

      call validate(case, error)
      if (.not. allocated(error)) call problem_of_case(problem, case, error)
   end subroutine build

   !> Check that a material is valid
   subroutine accepts_material(statements)
      !> Its statements but the name
      character(len=*), intent(in) :: statements

      call accepts(good//"&material name = 'm' "//statements//" /", statements)
   end subroutine accepts_material

   !> Check that a case is read but not valid
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
      call check(.not. allocated(error), what//": is read")
      call build(case, error)
      call check_error(error, error_input, words, what)
   end subroutine refuses

   !> Check that a material is not valid
   subroutine refuses_material(statements, words)
      !> Its statements but the name
      character(len=*), intent(in) :: statements
      !> Parts of the message, separated by bars
      character(len=*), intent(in) :: words

      call refuses(good//"&material name = 'm' "//statements//" /", "x.nml:6: |"//words, statements)
   end subroutine refuses_material

   !> Check an error: its code and its words
   subroutine check_error(error, code, words, what)
      !> The error
      type(error_t), allocatable, intent(in) :: error
      !> Its code
      integer, intent(in) :: code
      !> Parts of its message, separated by bars
      character(len=*), intent(in) :: words
      !> What is wrong
      character(len=*), intent(in) :: what
      integer :: first, last

      call check(allocated(error), what//" is refused")
      if (.not. allocated(error)) return
      call check(error%code == code, what//": exit code "//integer_text(error%code))
      first = 1
      do while (first <= len(words))
         last = first + index(words(first:)//"|", "|") - 2
         call check_contains(error%message, words(first:last), what)
         first = last + 2
      end do
   end subroutine check_error

end program test_case
