!> The catalogue: a single table of all groups and keys of a case
!>
!> Reading, checking, printing, sweeps and help follow from it. A new key needs a new row here and
!> code that reads its value, see `vcor_case_reading`. The keys of `&material` come from the
!> parameters of the models, a row for each key of each model, and those of `&sphere` in part from
!> the shapes; rows of one key have the same kind and default. Texts have fixed lengths, as arrays
!> of constants require; a unit test fails if one is full.
module vcor_case_catalogue
   use vcor_impact_shape, only : other_shapes, shape_parameters, sphere_shapes
   use vcor_kinds, only : coarsest_accuracy, finest_accuracy, wp
   use vcor_material, only : identifiable_models, model_parameters, models, relaxing_models
   use vcor_material_type, only : density
   use vcor_number, only : interval_t, interval_text, positive
   use vcor_material_shift, only : shift_laws, shift_parameters
   use vcor_solver_features, only : method_choices
   use vcor_text, only : lower
   use vcor_words, only : contains_word, join_words
   implicit none
   private

   public :: key_t, group_t, catalogue, groups, real_key, integer_key, logical_key, text_key, &
      list_key
   public :: find_group, find_key, first_row, key_row, last_row, row_for_model
   public :: kind_name, range_text, wanted, keys_of, group_names, described_keys, most_points

   !> Largest number of points of a grid
   integer, parameter :: most_points = 100000000

   !> Kinds of values: a real number
   integer, parameter :: real_key = 1
   !> An integer
   integer, parameter :: integer_key = 2
   !> A logical
   integer, parameter :: logical_key = 3
   !> A text
   integer, parameter :: text_key = 4
   !> A list of real numbers
   integer, parameter :: list_key = 5

   !> One key
   type :: key_t
      !> Its group, lower case
      character(len=16) :: group = ""
      !> Name, lower case
      character(len=26) :: name = ""
      !> One of the `*_key` constants; the name `kind` would be mistaken for the intrinsic function
      integer :: value_kind = 0
      !> Meaning, one line
      character(len=96) :: meaning = ""
      !> Unit; blank if there is none
      character(len=16) :: unit = ""
      !> Range of a number, or of every number of a list
      type(interval_t) :: range = interval_t()
      !> Possible words of a text, separated by blanks; blank: any text
      character(len=128) :: choices = ""
      !> Default as in a namelist, but texts without quotes; blank: none, '' (two quotes): the empty
      !> text
      character(len=32) :: default = ""
      !> Values of the group's selector for which the row holds, separated by blanks; blank: all
      character(len=128) :: models = ""
      !> Whether the key must be given
      logical :: required = .false.
      !> Alternative key, which excludes this one; blank: none
      character(len=26) :: instead = ""
   end type key_t

   !> One group
   type :: group_t
      !> Name, lower case
      character(len=16) :: name = ""
      !> What it describes, one line
      character(len=96) :: meaning = ""
      !> Whether a case must have it
      logical :: required = .false.
      !> Whether a case may have more than one
      logical :: repeated = .false.
      !> Key that names an item of a repeated group; blank: none
      character(len=32) :: label = ""
      !> Key whose value is looked up in `models`; blank: none
      character(len=32) :: selector = ""
      !> Whether its presence has a meaning: a completed case has it only if it is given
      logical :: optional = .false.
   end type group_t

   type(interval_t), parameter :: accuracy_range = interval_t(lower=finest_accuracy, &
      upper=coarsest_accuracy)
   type(interval_t), parameter :: not_negative = interval_t(lower=0.0_wp)
   type(interval_t), parameter :: of_a_grid = interval_t(lower=1.0_wp, upper=real(most_points, wp))
   type(interval_t), parameter :: of_bounces = interval_t(lower=1.0_wp, upper=1000.0_wp)
   type(interval_t), parameter :: order_range = interval_t(lower=1.0_wp, upper=2.0_wp)
   !> Of damping ratios: a mode that does not oscillate has none
   type(interval_t), parameter :: of_damping = interval_t(0.0_wp, 1.0_wp, upper_open=.true.)

   !> The groups, in the order in which they are printed
   type(group_t), parameter :: groups(*) = [ &
      group_t("case", "Title of the case"), &
      group_t("impact", "How the sphere strikes the plate", required=.true.), &
      group_t("sphere", "The sphere, or another body that strikes", required=.true., &
         selector="shape"), &
      group_t("plate", "The plate", required=.true.), &
      group_t("target", "What carries the struck surface, if it is of finite size", &
         selector="body", optional=.true.), &
      group_t("contact", "Law of the contact force"), &
      group_t("material", "A material used by the sphere or the plate", required=.true., &
         repeated=.true., label="name", selector="model"), &
      group_t("solver", "How the equation of motion is solved"), &
      group_t("sweep", "A parameter to vary; several groups make a grid", repeated=.true.), &
      group_t("output", "Files to write, and their folder")]

   integer :: i
   !> The keys, group by group, in the order of `groups`
   type(key_t), parameter :: catalogue(*) = [ &
      key_t("case", "title", text_key, "Title, copied to the results", default="''"), &
      !
      key_t("impact", "velocity", real_key, "Approach velocity at first contact", "m/s", &
         positive, required=.true., instead="drop_height"), &
      key_t("impact", "drop_height", real_key, &
         "Height of the drop, instead of velocity = sqrt(2 g drop_height)", "m", &
         positive), &
      key_t("impact", "temperature", real_key, "Temperature of both bodies; default: that at " &
         //"which their constants hold", "K", positive), &
      key_t("impact", "gravity", real_key, &
         "Gravity g along the impact, 0 on a pendulum; default: none; drop_height falls with " &
         //"9.80665", "m/s2", not_negative), &
      key_t("impact", "bounces", integer_key, "Bounces under the weight to follow, at most; " &
         //"direct only", range=of_bounces, default="1"), &
      !
      key_t("sphere", "shape", text_key, "Shape of the body", &
         choices=sphere_shapes//" "//other_shapes, default="sphere"), &
      key_t("sphere", "radius", real_key, "Radius", "m", positive, models=sphere_shapes, &
         required=.true., instead="diameter"), &
      key_t("sphere", "diameter", real_key, "Diameter, instead of radius", "m", positive, &
         models=sphere_shapes), &
      key_t("sphere", "material", text_key, "Name of its material", required=.true.), &
      key_t("sphere", "mass", real_key, "Mass; default: from radius and density", "kg", &
         positive, models=sphere_shapes), &
      key_t("sphere", "mass", real_key, "Mass", "kg", positive, models=other_shapes, &
         required=.true.), &
      (key_t("sphere", shape_parameters(i)%parameter%name, real_key, &
         shape_parameters(i)%parameter%meaning, shape_parameters(i)%parameter%unit, &
         shape_parameters(i)%parameter%range, models=shape_parameters(i)%shape, &
         required=.true.), i=1, size(shape_parameters)), &
      !
      key_t("plate", "half_thickness", real_key, &
         "Half the thickness; not needed without waves; if omitted with 'body': a half space", &
         "m", positive, instead="thickness"), &
      key_t("plate", "thickness", real_key, "Thickness, instead of half_thickness", "m", &
         positive), &
      key_t("plate", "material", text_key, "Name of its material", required=.true.), &
      key_t("plate", "base", text_key, &
         "What is below: nothing, or a rigid floor to which the layer is bonded or on which it " &
         //"slides", choices="free bonded sliding", default="free"), &
      key_t("plate", "waves", text_key, "Model of the waves in the plate", &
         choices="none constant relaxing frozen hereditary body", default="relaxing"), &
      key_t("plate", "surface_radius", real_key, &
         "Radius of curvature of the surface; 0: flat, negative: concave", "m", default="0.0"), &
      key_t("plate", "extent", real_key, &
         "Distance to the nearest edge of the plate, for the measure needed_extent", "m", &
         positive), &
      !
      key_t("target", "body", text_key, "Kind of structure", &
         choices="plate beam rod block modes", required=.true.), &
      key_t("target", "support", text_key, &
         "How it is held: a plate at its edges, a beam at its ends, a rod at the far end", &
         choices="supported clamped cantilever free", models="plate beam rod", required=.true.), &
      key_t("target", "length", real_key, "Length", "m", positive, models="plate beam rod", &
         required=.true.), &
      key_t("target", "width", real_key, "Width", "m", positive, models="plate beam", &
         required=.true.), &
      key_t("target", "diameter", real_key, "Diameter of the rod", "m", positive, models="rod", &
         required=.true.), &
      key_t("target", "thickness", real_key, &
         "Thickness along the impact; default: that of &plate, needed if that has a base", "m", &
         positive, models="plate beam"), &
      key_t("target", "material", text_key, &
         "Name of its material; default: that of &plate, needed if that has a base", &
         models="plate beam rod"), &
      key_t("target", "position", list_key, &
         "Place of the impact from the left end, two numbers for a plate; default: middle or tip", &
         "m", not_negative, models="plate beam"), &
      key_t("target", "damping_ratio", real_key, &
         "Damping ratio of each mode, added to those of a file", range=of_damping, &
         default="0.0", models="plate beam rod modes"), &
      key_t("target", "mass", real_key, "Mass of the block", "kg", positive, models="block", &
         required=.true.), &
      key_t("target", "stiffness", real_key, "Stiffness of the spring behind it; 0: free", "N/m", &
         not_negative, default="0.0", models="block"), &
      key_t("target", "damping", real_key, "Damping of the dashpot behind it", "N s/m", &
         not_negative, default="0.0", models="block"), &
      key_t("target", "file", text_key, &
         "File of frequencies, damping ratios and modal masses or mode shapes", models="modes", &
         required=.true.), &
      key_t("target", "residual_compliance", real_key, &
         "Flexibility of the modes that the file leaves out", "m/N", not_negative, &
         default="0.0", models="modes"), &
      !
      key_t("contact", "mechanics", text_key, &
         "Defaults of law, pair and waves: the paper's, or receding, series and body", &
         choices="paper exact", default="paper"), &
      key_t("contact", "law", text_key, "Law of the force while the contact shrinks", &
         choices="boltzmann receding", default="boltzmann"), &
      key_t("contact", "pair", text_key, "Rule that combines the moduli of two bodies", &
         choices="eq1 series", default="eq1"), &
      !
      key_t("material", "name", text_key, "Name; blanks and underscores are equivalent", &
         required=.true.), &
      key_t("material", "model", text_key, "Model of the relaxation modulus", &
         choices=models, required=.true.), &
      key_t("material", density%name, real_key, density%meaning, density%unit, density%range), &
      key_t("material", "yield_strength", real_key, &
         "Yield strength, for the validity measure mean_pressure", "Pa", positive), &
      (key_t("material", model_parameters(i)%parameter%name, &
         merge(list_key, real_key, model_parameters(i)%parameter%is_list), &
         model_parameters(i)%parameter%meaning, model_parameters(i)%parameter%unit, &
         model_parameters(i)%parameter%range, default=model_parameters(i)%parameter%default, &
         models=model_parameters(i)%model, required=model_parameters(i)%parameter%required, &
         instead=model_parameters(i)%parameter%instead), &
         i=1, size(model_parameters)), &
      key_t("material", "file", text_key, &
         "File of times and moduli; relative to the folder of the case", models="table", &
         required=.true.), &
      key_t("material", "time_unit", text_key, &
         "Unit of the times of a file that does not name it", &
         choices="ns us ms s min h", models="table"), &
      key_t("material", "modulus_unit", text_key, &
         "Unit of the moduli of a file that does not name it", &
         choices="Pa kPa MPa GPa", models="table"), &
      key_t("material", "modulus_kind", text_key, &
         "Whether the moduli are E, or G = E/(2 (1 + nu))", &
         choices="tensile shear", models="elastic "//relaxing_models, default="tensile"), &
      key_t("material", "valid_from", real_key, &
         "First time of the data to which the model was fitted", "s", positive, &
         models=identifiable_models), &
      key_t("material", "valid_to", real_key, &
         "Last time of the data to which the model was fitted", "s", positive, &
         models=identifiable_models), &
      key_t("material", "shift", text_key, "Law by which the temperature shifts all times", &
         choices=shift_laws, models=relaxing_models), &
      (key_t("material", shift_parameters(i)%name, real_key, shift_parameters(i)%meaning, &
         shift_parameters(i)%unit, shift_parameters(i)%range, models=relaxing_models), &
         i=1, size(shift_parameters)), &
      key_t("material", "shift_file", text_key, &
         "File of temperatures [K or C] and log10 of the shift factor", models=relaxing_models), &
      key_t("material", "vertical_shift", logical_key, &
         "Whether moduli are also proportional to the temperature; default: .false.", &
         models=relaxing_models), &
      key_t("material", "valid_temperature_from", real_key, &
         "Lowest temperature of the data behind the shift", "K", positive, &
         models=relaxing_models), &
      key_t("material", "valid_temperature_to", real_key, &
         "Highest temperature of the data behind the shift", "K", positive, &
         models=relaxing_models), &
      !
      key_t("solver", "method", text_key, &
         "auto: coupled for waves = 'body', direct for the paper's variants, otherwise ive", &
         choices=method_choices, default="auto"), &
      key_t("solver", "scheme", text_key, "Scheme of the direct method", &
         choices="product adams_bashforth", default="product"), &
      key_t("solver", "time_step", real_key, "Time step; default: chosen by the solver", &
         "s", positive), &
      key_t("solver", "end_time", real_key, &
         "Time at which the solver gives up; default: chosen by the solver", "s", positive), &
      key_t("solver", "accuracy", real_key, &
         "Largest error of the COR; default: 1e-8 (ive), 1e-6 (direct), 1e-5 (coupled)", &
         range=accuracy_range), &
      key_t("solver", "form", text_key, "Form of Eq. (8); adams_bashforth only", &
         choices="a b", default="a"), &
      key_t("solver", "quadrature", text_key, "Quadrature of the sums; adams_bashforth only", &
         choices="rectangle trapezoid", default="trapezoid"), &
      key_t("solver", "volterra_order", integer_key, &
         "Terms of the Volterra series; 2: direct only", range=order_range, default="1"), &
      key_t("solver", "volterra_coefficient", real_key, &
         "Coefficient of the second term; n = 1.5 for a sphere", "m^-n", default="1.0"), &
      key_t("solver", "continue_after_separation", logical_key, &
         "Continue to end_time as if the sphere were glued to the plate; direct only", &
         default=".false."), &
      !
      key_t("sweep", "parameter", text_key, "Address of the parameter, as in --set: group.key", &
         required=.true.), &
      key_t("sweep", "values", list_key, "Values; or give start, stop and count"), &
      key_t("sweep", "start", real_key, "First value"), &
      key_t("sweep", "stop", real_key, "Last value"), &
      key_t("sweep", "count", integer_key, "Number of values", range=of_a_grid), &
      key_t("sweep", "spacing", text_key, "Equal steps of the value or of its logarithm", &
         choices="linear log", default="linear"), &
      !
      key_t("output", "csv", logical_key, "Write CSV files", default=".true."), &
      key_t("output", "hdf5", logical_key, "Write an HDF5 file", default=".true."), &
      key_t("output", "history", logical_key, "Write the time history", default=".true."), &
      key_t("output", "directory", text_key, "Folder of the files", default="."), &
      key_t("output", "stem", text_key, &
      "Start of the file names; default: the name of the case file")]

   !> First row of each group
   integer, parameter :: first_row(size(groups)) = &
      [(findloc(catalogue%group, groups(i)%name, dim=1), i=1, size(groups))]
   !> Last row of each group
   integer, parameter :: last_row(size(groups)) = &
      [(findloc(catalogue%group, groups(i)%name, dim=1, back=.true.), i=1, size(groups))]
   !> First row of the key of each row
   integer, parameter :: key_row(size(catalogue)) = [(findloc( &
      catalogue%group == catalogue(i)%group .and. catalogue%name == catalogue(i)%name, &
      .true., dim=1), i=1, size(catalogue))]

contains

   !> Index of a group in `groups`
   pure function find_group(name) result(group)
      !> Name in any case
      character(len=*), intent(in) :: name
      !> Index; 0 if there is no such group
      integer :: group

      character(len=len(name)) :: small

      group = 0
      if (name == "") return
      small = lower(name)
      do group = 1, size(groups)
         ! most names differ in their first letter, which is compared without a call
         if (groups(group)%name(1:1) /= small(1:1)) cycle
         if (groups(group)%name == small) return
      end do
      group = 0
   end function find_group

   !> First row of a key
   pure function find_key(group, name) result(row)
      !> Name of the group in any case
      character(len=*), intent(in) :: group
      !> Name of the key in any case
      character(len=*), intent(in) :: name
      !> Row of `catalogue`; 0 if there is no such key
      integer :: row

      character(len=len(name)) :: small
      integer :: owner

      row = 0
      owner = find_group(group)
      if (owner == 0 .or. name == "") return
      small = lower(name)
      do row = first_row(owner), last_row(owner)
         if (catalogue(row)%name(1:1) /= small(1:1)) cycle
         if (catalogue(row)%name == small) return
      end do
      row = 0
   end function find_key

   !> Row of a key for a model
   pure function row_for_model(row, model) result(found)
      !> First row of the key
      integer, intent(in) :: row
      !> Value of the group's selector, lower case; blank if the group has none
      character(len=*), intent(in) :: model
      !> Row; 0 if the key does not belong to the model
      integer :: found

      do found = row, size(catalogue)
         if (key_row(found) /= key_row(row)) cycle
         if (catalogue(found)%models == "") return
         if (contains_word(catalogue(found)%models, model)) return
      end do
      found = 0
   end function row_for_model

   !> Range of a key as text: `> 0`, `in (-1, 0.5]`, `one of none, constant`; empty if unlimited
   pure function range_text(key) result(text)
      type(key_t), intent(in) :: key
      !> Its range
      character(len=:), allocatable :: text

      text = ""
      if (key%value_kind /= text_key) then
         text = interval_text(key%range)
      else if (key%choices /= "") then
         text = "one of "//join_words(key%choices)
      end if
   end function range_text

   !> The keys as pages describe them: equal rows for several models are merged
   pure function described_keys() result(keys)
      !> Rows, merged ones with the models of all
      type(key_t), allocatable :: keys(:)
      type(key_t) :: key
      logical :: is_first(size(catalogue))
      integer :: row, other

      allocate (keys, source=catalogue)
      is_first = .true.
      do row = 2, size(catalogue)
         key = catalogue(row)
         other = findloc(keys(:row - 1)%group == key%group .and. keys(:row - 1)%name == key%name &
            .and. keys(:row - 1)%unit == key%unit .and. keys(:row - 1)%meaning == key%meaning &
            .and. (keys(:row - 1)%required .eqv. key%required), .true., dim=1)
         if (other == 0) cycle
         keys(other)%models = trim(keys(other)%models)//" "//catalogue(row)%models
         is_first(row) = .false.
      end do
      keys = pack(keys, is_first)
   end function described_keys

   !> Description of the values of a key: `a number > 0 [m]`
   pure function wanted(key) result(text)
      type(key_t), intent(in) :: key
      !> Kind, range and unit
      character(len=:), allocatable :: text

      text = kind_name(key%value_kind)
      if (key%choices /= "") text = ""
      text = trim(adjustl(text//" "//range_text(key)))
      if (key%unit /= "") text = text//" ["//trim(key%unit)//"]"
   end function wanted

   !> Kind of a key in words, as in `expected a number`
   pure function kind_name(kind) result(name)
      !> One of the `*_key` constants
      integer, intent(in) :: kind
      !> The words
      character(len=:), allocatable :: name

      character(len=*), parameter :: names(*) = [character(len=18) :: "a number", &
         "a whole number", ".true. or .false.", "a text in quotes", "numbers"]

      name = trim(names(kind))
   end function kind_name

   !> Names of the keys of a group, each once, separated by blanks
   pure function keys_of(group, model) result(words)
      !> Index of the group
      integer, intent(in) :: group
      !> Only keys of this model; absent: all
      character(len=*), intent(in), optional :: model
      character(len=:), allocatable :: words
      integer :: row

      words = ""
      do row = first_row(group), last_row(group)
         if (contains_word(words, catalogue(row)%name)) cycle
         if (present(model)) then
            if (row_for_model(row, model) == 0) cycle
         end if
         words = trim(words//" "//catalogue(row)%name)
      end do
      words = trim(adjustl(words))
   end function keys_of

   !> Names of the groups, separated by blanks
   pure function group_names() result(words)
      character(len=:), allocatable :: words
      integer :: group

      words = trim(groups(1)%name)
      do group = 2, size(groups)
         words = words//" "//trim(groups(group)%name)
      end do
   end function group_names

end module vcor_case_catalogue
