"""Keys and values that a case cannot have."""

import os

import pytest
from cases import MODELS, SLS, add_line, case_text, edit, without
from program import INPUT, NUMERICAL, PAPER, SUCCESS, Done, complaint

# Model, group and key, for each key that has to be a positive number
POSITIVE = [
    ("sls", "impact", "velocity"),
    ("sls", "sphere", "radius"),
    ("sls", "sphere", "mass"),
    ("sls", "plate", "half_thickness"),
    ("sls", "material", "density"),
    ("sls", "material", "glassy_modulus"),
    ("elastic", "material", "modulus"),
    ("cerf", "material", "relaxing_modulus"),
    ("cerf", "material", "beta"),
    ("power_law", "material", "coefficient"),
    ("mittag_leffler", "material", "relaxing_modulus"),
    ("mittag_leffler", "material", "time"),
    ("sls", "solver", "time_step"),
    ("sls", "solver", "end_time"),
]
# ... that may be zero, but no less
NOT_NEGATIVE = [
    ("sls", "material", "alpha"),
    ("sls", "material", "beta"),
    ("prony", "material", "equilibrium_modulus"),
    ("prony", "material", "viscosity"),
    ("power_law", "material", "equilibrium_modulus"),
    ("cerf", "material", "equilibrium_modulus"),
    ("mittag_leffler", "material", "equilibrium_modulus"),
]
# ... and each list of positive numbers
LISTS = [
    ("prony", "material", "moduli"),
    ("prony", "material", "rates"),
    ("prony_times", "material", "times"),
]
# A number each that is free to be anything finite
FREE = [("sls", "plate", "surface_radius"), ("sls", "solver", "volterra_coefficient")]
RANGES = [
    ("sls", "material", "poisson_ratio"),
    ("power_law", "material", "exponent"),
    ("mittag_leffler", "material", "exponent"),
    ("sls", "solver", "accuracy"),
]
NUMBERS = POSITIVE + NOT_NEGATIVE + LISTS + FREE + RANGES


def spoiled(vcor, where, value, says=()):
    """What the program says when a key has this value."""
    model, group, key = where
    text, line = edit(case_text(model), group, key, value)
    vcor.write(text)
    return vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=says)


def refused(where, value, says=()):
    """What the library says when a key has this value: its line is that of the program, and some
    hundred values take no process each."""
    import vcor

    model, group, key = where
    text, line = edit(case_text(model), group, key, value)
    with pytest.raises(vcor.InputError) as caught:
        vcor.Case(text, name="case.nml").text()
    done = Done(INPUT, "", f"vcor: error: {caught.value}\n")
    return complaint(done, INPUT, says, f"case.nml:{line}")


def ids(where):
    return f"{where[0]}-{where[2]}" if isinstance(where, tuple) else None


@pytest.mark.parametrize("model", sorted(MODELS))
def test_the_unspoiled_cases_are_right(vcor, model):
    vcor.write(case_text(model))
    assert vcor.numbers("case.nml")["status"] == "separated"


@pytest.mark.parametrize("where", NUMBERS, ids=ids)
@pytest.mark.parametrize("value", ["NaN", "1.0.0"])
def test_the_line_of_the_program(vcor, where, value):
    """It is that of the library, which the tables below ask."""
    assert spoiled(vcor, where, value) == refused(where, value)


@pytest.mark.parametrize("where", POSITIVE, ids=ids)
@pytest.mark.parametrize("value", ["0.0", "-0.0", "-1.0", "-1e-300"])
def test_not_positive(where, value):
    refused(where, value, ["found", "expected", "> 0"])


@pytest.mark.parametrize("where", NOT_NEGATIVE, ids=ids)
@pytest.mark.parametrize("value", ["-1.0", "-1e-300"])
def test_negative(where, value):
    refused(where, value, ["found -1", "expected", ">= 0"])


@pytest.mark.parametrize("where", LISTS, ids=ids)
@pytest.mark.parametrize("value", ["0.0", "-2.0"])
def test_not_positive_in_a_list(where, value):
    refused(where, f"1.0, {value}, 3.0", [f"found {value}", "value 2", "> 0"])


@pytest.mark.parametrize("where", NUMBERS, ids=ids)
@pytest.mark.parametrize("value", ["NaN", "nan", "Inf", "-Infinity", "+inf"])
def test_not_finite(where, value):
    refused(where, value, [f"found '{value}'", "finite"])


@pytest.mark.parametrize("where", NUMBERS, ids=ids)
@pytest.mark.parametrize("value", ["1e400", "1d999999999999"])
def test_too_large(where, value):
    refused(where, value, [value, "too large"])


def test_too_small(vcor):
    """A number that underflows would be taken for zero."""
    spoiled(vcor, ("sls", "impact", "velocity"), "1e-400", ["1e-400", "too small"])


@pytest.mark.parametrize("where", NUMBERS, ids=ids)
@pytest.mark.parametrize(
    "value", ["ten", "'ten'", "1.0.0", "1e", "0x10", "1.0f", "10m", "--1", ".true.", "1_8", "$"]
)
def test_text_for_a_number(where, value):
    refused(where, value, ["found", value, "expected"])


@pytest.mark.parametrize("where", NUMBERS, ids=ids)
def test_empty_value(where):
    refused(where, "", ["no value"])


@pytest.mark.parametrize(
    "group, key", [("sphere", "material"), ("plate", "waves"), ("case", "title")]
)
def test_empty_text_value(vcor, group, key):
    spoiled(vcor, ("sls", group, key), "", ["no value"])


def test_empty_value_before_the_end(vcor):
    vcor.write(SLS.replace("   velocity = 10.0\n/", "   velocity = /"))
    vcor.refuses("run", "case.nml", code=INPUT, at="case.nml:5", says="no value")


@pytest.mark.parametrize("value", [",", ", 3.0", "3.0,, 4.0", "2*", "1.0, 2*, 3.0"])
def test_hole_in_a_list(vcor, value):
    """Fortran would leave what was there before, which is nothing."""
    spoiled(vcor, ("prony", "material", "rates"), value)


@pytest.mark.parametrize("where", POSITIVE + NOT_NEGATIVE + FREE + RANGES, ids=ids)
@pytest.mark.parametrize("value", ["0.4, 0.4", "0.4 0.4", "2*0.4"])
def test_too_many_values(where, value):
    refused(where, value, ["more than one value"])


def test_too_many_texts(vcor):
    spoiled(vcor, ("sls", "case", "title"), "'Ball' 'on plate'", ["more than one value"])


@pytest.mark.parametrize("value", ["-1.0", "-1.5", "0.5000001", "0.6", "49"])
def test_poisson_ratio(vcor, value):
    spoiled(vcor, ("sls", "material", "poisson_ratio"), value, ["found", "in (-1, 0.5]"])


@pytest.mark.parametrize("value", ["-0.9999", "0.0", "0.5"])
def test_poisson_ratio_within(vcor, value):
    text, _ = edit(SLS, "material", "poisson_ratio", value)
    vcor.write(text)
    assert vcor.numbers("case.nml")["status"] == "separated"


@pytest.mark.parametrize("value", ["0.0", "1.0", "-0.5", "2.0"])
def test_exponent(vcor, value):
    spoiled(vcor, ("power_law", "material", "exponent"), value, [f"found {value}", "in (0, 1)"])


@pytest.mark.parametrize("value", ["0.0", "1.2", "-0.5", "1.0000000000000002"])
def test_exponent_of_mittag_leffler(vcor, value):
    where = ("mittag_leffler", "material", "exponent")
    spoiled(vcor, where, value, [f"found {value}", "in (0, 1]"])


@pytest.mark.parametrize("value", ["1.0", "0.9999999999999999", "0.01"])
def test_exponent_of_mittag_leffler_within(vcor, value):
    text, _ = edit(case_text("mittag_leffler"), "material", "exponent", value)
    vcor.write(text)
    direct = ["--set", "solver.method=direct"]
    assert vcor.numbers("case.nml", *direct)["status"] == "separated"


def test_misspelt_time(vcor):
    text = case_text("mittag_leffler").replace("   time =", "   tmie =")
    vcor.write(text)
    line = text.splitlines().index("   tmie = 2.0e-5") + 1
    says = ["unknown key 'tmie'", "did you mean 'time'?"]
    vcor.refuses("check", "case.nml", code=INPUT, at=f"case.nml:{line}", says=says)


def test_time_missing(vcor):
    text, _ = without(case_text("mittag_leffler"), "time = 2.0e-5")
    vcor.write(text)
    vcor.refuses("check", "case.nml", code=INPUT, says=["case.nml:", "'time' is missing"])


@pytest.mark.parametrize("value", ["0.0", "1.0e-12", "0.2", "-1.0e-6"])
def test_accuracy(vcor, value):
    spoiled(vcor, ("sls", "solver", "accuracy"), value, ["found", "expected a number in ["])


@pytest.mark.parametrize("value", ["0", "3", "-1"])
def test_volterra_order(vcor, value):
    spoiled(vcor, ("sls", "solver", "volterra_order"), value, [f"found {value}", "whole number"])


@pytest.mark.parametrize("value", ["1.0", "1.5", "one", "'1'", "NaN", "99999999999999"])
def test_no_whole_number(vcor, value):
    spoiled(vcor, ("sls", "solver", "volterra_order"), value, [value, "whole number"])


@pytest.mark.parametrize("key", ["csv", "hdf5", "history"])
@pytest.mark.parametrize("value", ["1", "yes", "'true'", "tru", "none"])
def test_no_logical(vcor, key, value):
    spoiled(vcor, ("sls", "output", key), value, [value, ".true. or .false."])


@pytest.mark.parametrize("value", ["steel", "42", ".true."])
def test_text_without_quotes(vcor, value):
    spoiled(vcor, ("sls", "sphere", "material"), value, [value, "quotes"])


@pytest.mark.parametrize(
    "group, key, value, known",
    [
        ("plate", "waves", "relaxed", "relaxing"),
        ("solver", "method", "direkt", "direct"),
        ("solver", "scheme", "products", "product"),
        ("material", "model", "SLS model", "sls"),
    ],
)
def test_unknown_choice(vcor, group, key, value, known):
    spoiled(vcor, ("sls", group, key), f"'{value}'", [value.lower(), "expected", known])


def test_scheme_of_another_method(vcor):
    text, _ = edit(SLS, "solver", "method", "'ive'")
    text, line = edit(text, "solver", "scheme", "'adams_bashforth'")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says="scheme")


@pytest.mark.parametrize(
    "group, key, nearest",
    [
        ("impact", "velocitty", "velocity"),
        ("sphere", "raduis", "radius"),
        ("plate", "half_thicknes", "half_thickness"),
        ("material", "poison_ratio", "poisson_ratio"),
        ("material", "glasy_modulus", "glassy_modulus"),
        ("solver", "end_tim", "end_time"),
        ("output", "hdf", "hdf5"),
    ],
)
def test_unknown_key(vcor, group, key, nearest):
    said = spoiled(vcor, ("sls", group, key), "1", [f"unknown key '{key}'", f"&{group}"])
    assert f"'{nearest}'" in said


@pytest.mark.parametrize(
    "setting, nearest",
    [
        ("rubber.model='slss'", "sls"),
        ("rubber.model='mittag-leffler'", "mittag_leffler"),
        ("plate.waves='relaxng'", "relaxing"),
        ("contact.law='receeding'", "receding"),
        ("plate.waves='bodywaves'", "body"),
        ("solver.method='drect'", "direct"),
        ("solver.form='c'", ""),
        ("solver.method='best'", ""),
    ],
)
def test_unknown_choice(vcor, setting, nearest):
    """All are named, and the nearest one if there is one."""
    said = vcor.refuses("run", PAPER / "sls.nml", "--set", setting, code=INPUT, says="expected one of")
    assert said.endswith(f"; did you mean '{nearest}'?") or not nearest and "did you" not in said


def test_key_of_another_group(vcor):
    spoiled(vcor, ("sls", "sphere", "half_thickness"), "0.01", ["half_thickness", "&plate"])


def test_key_of_another_model(vcor):
    spoiled(vcor, ("sls", "material", "exponent"), "0.5", ["exponent", "'sls'", "glassy_modulus"])


@pytest.mark.parametrize("again", ["velocity = 10.0", "VELOCITY = 20.0"])
def test_key_given_twice(vcor, again):
    text, line = add_line(SLS, "velocity = 10.0", again)
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=["velocity", "twice"])


def test_list_given_twice(vcor):
    text, line = add_line(case_text("prony"), "rates = 972.0, 6426.0, 34221.0", "rates(2) = 1000.0")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=["rates", "twice"])


@pytest.mark.parametrize(
    "line, key",
    [
        ("velocity = 10.0", "velocity"),
        ("radius = 0.01", "radius"),
        ("material = 'steel'", "material"),
        ("material = 'rubber'", "material"),
        ("half_thickness = 0.02", "half_thickness"),
        ("model = 'sls'", "model"),
        ("density = 7800.0", "density"),
        ("density = 1100.0", "density"),
        ("poisson_ratio = 0.5", "poisson_ratio"),
        ("glassy_modulus = 15.0e6", "glassy_modulus"),
        ("alpha = 300.0", "alpha"),
        ("beta = 1200.0", "beta"),
    ],
)
def test_key_missing(vcor, line, key):
    text, _ = without(SLS, line)
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", f"'{key}' is missing"])


@pytest.mark.parametrize("name", ["steel", "rubber"])
def test_name_missing(vcor, name):
    text, _ = without(SLS, f"name = '{name}'")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", "name"])


@pytest.mark.parametrize("key, model", [("rates", "prony"), ("times", "prony_times")])
@pytest.mark.parametrize("value", ["1.0, 2.0", "1.0", "1.0, 2.0, 3.0, 4.0", "4*1.0"])
def test_lengths(vcor, key, model, value):
    spoiled(vcor, (model, "material", key), value, ["3 moduli", key])


def test_rates_and_times(vcor):
    spoiled(vcor, ("prony", "material", "times"), "1.0, 2.0, 3.0", ["rates", "times", "one of"])


def test_neither_rates_nor_times(vcor):
    text, _ = without(case_text("prony"), "rates = 972.0, 6426.0, 34221.0")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", "rates", "times"])


def test_no_stiffness(vcor):
    text, _ = without(case_text("prony"), "rates = 972.0, 6426.0, 34221.0")
    text, _ = without(text, "moduli = 20.181e6, 38.204e6, 87.344e6")
    text, _ = without(text, "equilibrium_modulus = 10.421e6")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", "rubber", "stiffness"])


@pytest.mark.parametrize("value", ["1200.1", "1e50"])
def test_rubbery_above_glassy(vcor, value):
    spoiled(vcor, ("sls", "material", "alpha"), value, ["alpha", "beta", "1200.0", "rubbery"])


def test_rubbery_modulus_without_relaxation(vcor):
    text, _ = edit(SLS, "material", "beta", "0.0")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", "alpha", "beta"])


@pytest.mark.parametrize("group", ["sphere", "plate"])
def test_material_not_there(vcor, group):
    spoiled(vcor, ("sls", group, "material"), "'ruber'", ["'ruber'", f"&{group}", "rubber"])


@pytest.mark.parametrize("name", ["steel", "STEEL", " steel "])
def test_material_there_twice(vcor, name):
    text, line = edit(SLS, "material", "name", f"'{name}'")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says="two materials")


def test_blank_and_underscore_are_one_name(vcor):
    text = SLS.replace("'steel'", "'hard steel'").replace("'rubber'", "'hard_steel'")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", "two materials"])


def test_both_rigid(vcor):
    spoiled(vcor, ("sls", "plate", "material"), "'steel'", ["both rigid"])


@pytest.mark.parametrize("value", ["-0.005", "-0.01", "-1e-9"])
def test_hollow_smaller_than_the_sphere(vcor, value):
    says = ["surface_radius = -", "and radius = 0.01", "larger"]
    spoiled(vcor, ("sls", "plate", "surface_radius"), value, says)


def test_time_step_not_below_end_time(vcor):
    text, _ = edit(SLS, "solver", "end_time", "1.0e-3")
    text, _ = edit(text, "solver", "time_step", "1.0e-3")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", "time_step", "end_time"])


@pytest.mark.parametrize("value", ["'a/b'", "'../x'", "'/proc/x'"])
def test_stem_with_a_folder(vcor, value):
    """A stem is a name: the folder is output.directory."""
    spoiled(vcor, ("sls", "output", "stem"), value, ["stem"])


@pytest.mark.parametrize(
    ("group", "key", "value", "says"),
    [
        ("plate", "waves", "'frozen'", "waves = 'frozen' are solved by method = 'direct' only"),
        ("solver", "volterra_order", "2", "the second term of the Volterra series is solved by method = 'direct' only"),
        ("solver", "continue_after_separation", ".true.", "only method = 'direct' continues after the separation"),
    ],
)
def test_rare_values(vcor, group, key, value, says):
    """The paper's variants are solved by product integration, which auto takes for them."""
    text, _ = edit(SLS, group, key, value)
    results = []
    for method in ("auto", "direct"):
        vcor.write(edit(text, "solver", "method", f"'{method}'")[0])
        results.append(vcor.numbers("case.nml"))
        assert results[-1]["status"] == "separated"
    assert results[0] == results[1]
    vcor.write(edit(text, "solver", "method", "'ive'")[0])
    done = vcor("run", "case.nml")
    assert done.code == INPUT and says in done.err


@pytest.mark.parametrize("sign, says", [("\t", "a tab"), ("\x1b", "control character"), ("\x7f", "control character")])
def test_name_with_a_control_character(vcor, sign, says):
    """What cannot be seen makes two names of what looks like one."""
    text = SLS.replace("'rubber'", f"'soft{sign}rubber'")
    vcor.write(text)
    done = vcor("run", "case.nml")
    complaint(done, INPUT, says)


# Impacts far beyond all that is real, each of which made some number leave its range
EXTREMES = [
    """
&impact velocity = 0.002762, gravity = 9.81 /
&sphere radius = 1.866e-08, material = 'a', mass = 1.648e-18 /
&plate half_thickness = 9.306e-14, material = 'b', waves = 'constant' /
&contact law = 'boltzmann', pair = 'series' /
&material name = 'a', model = 'rigid', density = 7800 /
&material name = 'b', density = 2.435e+04, poisson_ratio = 0.0, model = 'sls', glassy_modulus = 1.916e+05,
    beta = 296.3, alpha = 2.963e-16 /
&solver method='ive', accuracy=1e-10 /
""",
    """
&impact velocity = 0.001687, gravity = 100000.0 /
&sphere radius = 6.272e-07, material = 'a' /
&plate half_thickness = 1.469e-07, material = 'b', waves = 'hereditary' /
&contact law = 'receding', pair = 'eq1' /
&material name = 'a', model = 'rigid', density = 7800 /
&material name = 'b', density = 0.1576, poisson_ratio = 0.0, model = 'prony', equilibrium_modulus = 2.272e+06,
    viscosity = 3.035e+04 /
&solver method='ive', accuracy=1e-10 /
""",
    """
&impact velocity = 1608, gravity = 9.81 /
&sphere radius = 120.3, material = 'a' /
&plate half_thickness = 0.0003161, material = 'b', waves = 'hereditary' /
&contact law = 'boltzmann', pair = 'series' /
&material name = 'a', density = 5.09e+04, poisson_ratio = 0.5, model = 'cerf', equilibrium_modulus = 1.767e-07,
    relaxing_modulus = 1.767e+05, beta = 743.7 /
&material name = 'b', density = 326.8, poisson_ratio = 0.5, model = 'prony', equilibrium_modulus = 2.235e-15,
    moduli = 0.002235, 1.164e-07, times = 1.066e-11, 1.432e-07 /
&solver method='ive', accuracy=1e-06 /
""",
    """
&impact velocity = 1.533, gravity = 1e-06 /
&sphere radius = 0.0007186, material = 'a', mass = 2.64e-08 /
&plate half_thickness = 7.823e-05, material = 'b', waves = 'relaxing' /
&contact law = 'boltzmann', pair = 'series' /
&material name = 'a', density = 9.139, poisson_ratio = 0.5, model = 'sls', glassy_modulus = 1.864e-05,
    beta = 0.2399, alpha = 2.399e-19 /
&material name = 'b', density = 0.0777, poisson_ratio = 0.0, model = 'mittag_leffler',
    equilibrium_modulus = 1.132e-29, relaxing_modulus = 11.32, exponent = 1.758158196819191e-06, time = 80.45 /
&solver method='ive', accuracy=1e-10 /
""",
    """
&impact velocity = 1.905e-08, gravity = 1e-06 /
&sphere radius = 0.001343, material = 'a' /
&plate half_thickness = 1.527e-05, material = 'b', waves = 'none' /
&contact law = 'boltzmann', pair = 'eq1' /
&material name = 'a', model = 'rigid', density = 7800 /
&material name = 'b', density = 0.02728, poisson_ratio = 0.45, model = 'power_law',
    equilibrium_modulus = 1.787e-12, coefficient = 2.296e+05, exponent = 0.9343229990955173 /
&solver method='ive', accuracy=1e-06 /
""",
    """
&impact velocity = 0.1685 /
&sphere radius = 8.461e-07, material = 'a', mass = 1.063e-16 /
&plate half_thickness = 1.135e-11, material = 'b', waves = 'hereditary' /
&contact law = 'boltzmann', pair = 'eq1' /
&material name = 'a', model = 'rigid', density = 7800 /
&material name = 'b', density = 1593, poisson_ratio = 0.0, model = 'prony', equilibrium_modulus = 24.58,
    moduli = 2458, times = 4.509e-15, viscosity = 5.927e-06 /
&solver method='direct', accuracy=1e-08 /
""",
    """
&impact velocity = 2.14e-10 /
&sphere radius = 1.012e-07, material = 'a' /
&plate half_thickness = 1.106e-10, material = 'b', waves = 'frozen' /
&contact law = 'receding', pair = 'series' /
&material name = 'a', model = 'rigid', density = 7800 /
&material name = 'b', density = 3.744e+04, poisson_ratio = 0.45, model = 'prony',
    equilibrium_modulus = 2.09e-12, viscosity = 2.652 /
&solver method='ive', accuracy=0.001 /
""",
    """
&impact velocity = 1.724e-12 /
&sphere radius = 0.02221, material = 'a' /
&plate half_thickness = 2.001, material = 'b', waves = 'hereditary' /
&contact law = 'boltzmann', pair = 'series' /
&material name = 'a', density = 0.2495, poisson_ratio = 0.3, model = 'prony', equilibrium_modulus = 3.175e-26,
    viscosity = 1498 /
&material name = 'b', density = 64.12, poisson_ratio = 0.45, model = 'power_law', equilibrium_modulus = 37.45,
    coefficient = 3.427e+15, exponent = 0.9999999980894608 /
&solver method='ive', accuracy=0.001 /
""",
]
# ... and one that takes 20 s until its accuracy is out of reach
SLOW = """
&impact velocity = 0.02747 /
&sphere radius = 5.264e-08, material = 'a' /
&plate half_thickness = 2.708e-12, material = 'b', waves = 'hereditary' /
&contact law = 'boltzmann', pair = 'series' /
&material name = 'a', model = 'elastic', density = 1100, modulus = 5000000.0, poisson_ratio = 0.5 /
&material name = 'b', density = 0.7347, poisson_ratio = 0.0, model = 'mittag_leffler',
    equilibrium_modulus = 2.313e-08, relaxing_modulus = 2.313e+04, exponent = 0.998581562376, time = 3.462e-09 /
&solver method='ive', accuracy=1e-10 /
"""
if "VCOR_ALL_TESTS" in os.environ:
    EXTREMES.append(SLOW)


@pytest.mark.parametrize("case", EXTREMES)
def test_extreme_impacts(vcor, case):
    """They end with numbers or with a line, in debug builds too."""
    vcor.write(case)
    done = vcor("run", "case.nml", "--print", "cor", "--quiet")
    assert done.code in (SUCCESS, NUMERICAL), done.err
    if done.code == NUMERICAL:
        assert done.err.count("vcor: error: ") == 1


@pytest.mark.parametrize("text", ["23 C", "23C", "23 °C", "23°C", "23 degC"])
def test_degrees_celsius(vcor, text):
    """A temperature in degrees Celsius is refused with the kelvin that it is."""
    changed, line = edit(SLS, "impact", "velocity", f"10.0\n   temperature = {text}")
    vcor.write(changed)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line + 1}", says=["temperature", "296.15 K"])


@pytest.mark.parametrize("quotes", ["‘’", "“”", "’’"])
def test_curly_quotes(vcor, quotes):
    """Quotes of a word processor are named as such."""
    vcor.write(SLS.replace("'steel'", f"{quotes[0]}steel{quotes[1]}", 1))
    vcor.refuses("run", "case.nml", code=INPUT, says=["curly quotes", "'steel'"])
