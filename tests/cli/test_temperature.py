"""Temperature: a shifted material is the one whose constants are shifted by hand."""

import math

import h5py
import pytest
from program import ALL, FILE, INPUT, NAMES

GAS_CONSTANT = 8.31446261815324
REFERENCE = 298.15
# Rounding, as the steps of a solution enlarge it
ROUNDING = 1e-11

# A material at its reference temperature, or with times a and moduli b times as large
MODELS = {
    "sls": lambda a, b: f"glassy_modulus = {15e6 * b!r}, alpha = {300 / a!r}, beta = {1200 / a!r}",
    "prony": lambda a, b: f"equilibrium_modulus = {4e6 * b!r}, moduli = {6e6 * b!r}, {9e6 * b!r}, "
    f"times = {2e-4 * a!r}, {3e-3 * a!r}, viscosity = {20 * a * b!r}",
    "power_law": lambda a, b: f"equilibrium_modulus = {2e6 * b!r}, "
    f"coefficient = {1e6 * b * a**0.3!r}, exponent = 0.3",
    "cerf": lambda a, b: f"equilibrium_modulus = {4e5 * b!r}, relaxing_modulus = {6e8 * b!r}, "
    f"beta = {700 / math.sqrt(a)!r}",
    "mittag_leffler": lambda a, b: f"equilibrium_modulus = {2e6 * b!r}, "
    f"relaxing_modulus = {7e7 * b!r}, exponent = 0.6, time = {2e-5 * a!r}",
    "table": lambda a, b: "file = 'points.csv'",
}

LAWS = {
    "wlf": "shift = 'wlf', wlf_c1 = 8.86, wlf_c2 = 101.6",
    "arrhenius": "shift = 'arrhenius', activation_energy = 9e4",
    "table": "shift = 'table', shift_file = 'shift.csv'",
}
POINTS = {-40.0: 9.5, -10.0: 4.0, 10.0: 1.25, 25.0: 0.0, 40.0: -0.9, 80.0: -2.5}


def factor(law, temperature):
    """a_T, at a temperature of the table where the law is one."""
    if law == "wlf":
        distance = temperature - REFERENCE
        return 10 ** (-8.86 * distance / (101.6 + distance))
    if law == "arrhenius":
        return math.exp(9e4 / GAS_CONSTANT * (1 / temperature - 1 / REFERENCE))
    return 10 ** POINTS[round(temperature - 273.15, 6)]


def write_points(vcor, a=1.0, b=1.0, name="E"):
    rows = [
        f"{1e-7 * 10 ** (i / 4) * a!r},{b * (2e6 + 3e7 / (1 + (10 ** (i / 4) / 1e3) ** 0.4))!r}"
        for i in range(33)
    ]
    vcor.write(f"t [s],{name} [Pa]\n" + "\n".join(rows), "points.csv")


def material(model, a=1.0, b=1.0, more="", name="sheet"):
    more = f",\n   {more}" if more else ""
    return (
        f"&material name = '{name}', model = '{model}', density = 1100, poisson_ratio = 0.4,\n"
        f"   {MODELS[model](a, b)}{more} /\n"
    )


def shifted(model, law, vertical=False, name="sheet"):
    more = f"{LAWS[law]}, reference_temperature = {REFERENCE}"
    return material(model, more=more + ", vertical_shift = .true." * vertical, name=name)


def case(*materials, temperature=None, bodies=("steel", "sheet"), more=""):
    t = "" if temperature is None else f", temperature = {temperature!r}"
    ball, sheet = bodies
    return (
        f"&impact velocity = 5{t} /\n&sphere radius = 0.01, material = '{ball}' /\n"
        f"&plate material = '{sheet}', half_thickness = 0.02, waves = 'hereditary' /\n"
        + "".join(materials)
        + "&material name = 'steel', model = 'rigid', density = 7800 /\n"
        + more
    )


@pytest.fixture(autouse=True)
def shift_file(vcor):
    rows = "\n".join(f"{t},{log}" for t, log in POINTS.items())
    vcor.write(f"T [C], log10_aT\n{rows}\n", "shift.csv")


def same(found, expected, within):
    for name in NAMES:
        a, b = found[name], expected[name]
        try:
            a, b = float(a), float(b)
        except ValueError:
            assert a == b, name
            continue
        # the remainder of a balance, an estimate of an error, and what they decide
        if name in {"energy_imbalance", "steps"} or name.endswith("_error") or math.isnan(b):
            continue
        assert a == pytest.approx(b, rel=within), name


@pytest.mark.parametrize("method", ["ive", "direct"])
@pytest.mark.parametrize("model", MODELS)
def test_shifted_constants(vcor, model, method):
    """Each model, each law and method, and the vertical shift."""
    for law, temperature in {"wlf": 310.0, "arrhenius": 280.0, "table": 283.15}.items():
        a = factor(law, temperature)
        for vertical in (False, True):
            b = temperature / REFERENCE if vertical else 1.0
            # a table's sum of exponentials is worth some digits only
            accuracy = ", accuracy = 1e-4" if (model, method) == ("table", "ive") else ""
            solver = f"&solver method = '{method}'{accuracy} /\n"
            write_points(vcor)
            vcor.write(case(shifted(model, law, vertical), temperature=temperature, more=solver))
            found = vcor.numbers("case.nml")
            write_points(vcor, a, b)
            vcor.write(case(material(model, a, b), more=solver))
            same(found, vcor.numbers("case.nml"), ROUNDING)


@pytest.mark.parametrize("pair", ["eq1", "series"])
@pytest.mark.parametrize(
    "models", [("sls", "mittag_leffler"), ("power_law", "cerf"), ("cerf", "sls")], ids="-".join
)
def test_two_shifted_bodies(vcor, models, pair):
    """Each body has its own shift; the contact modulus is that of both."""
    temperature = 305.0
    laws = ("wlf", "arrhenius")
    more = f"&contact pair = '{pair}', law = 'receding' /\n"
    names = ("ball", "sheet")
    parts = [shifted(models[i], laws[i], name=names[i]) for i in range(2)]
    vcor.write(case(*parts, temperature=temperature, bodies=names, more=more))
    found = vcor.numbers("case.nml")
    parts = [material(models[i], factor(laws[i], temperature), name=names[i]) for i in range(2)]
    vcor.write(case(*parts, bodies=names, more=more))
    same(found, vcor.numbers("case.nml"), ROUNDING)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("model", MODELS)
def test_reference_temperature_changes_no_bit(vcor, model, law):
    write_points(vcor)
    vcor.write(case(material(model)))
    plain = vcor.numbers("case.nml")
    vcor.write(case(shifted(model, law, vertical=True), temperature=REFERENCE))
    assert vcor.numbers("case.nml") == plain
    vcor.write(case(shifted(model, law, vertical=True)))
    assert vcor.numbers("case.nml") == plain


@pytest.mark.parametrize("model", MODELS)
def test_moduli(vcor, model):
    """What vcor material writes is at the temperature, too."""
    a = factor("wlf", 310.0)
    tables = []
    for text in (
        case(shifted(model, "wlf"), temperature=310.0),
        case(material(model, a)),
    ):
        write_points(vcor, 1.0 if "shift" in text else a)
        vcor.write(text)
        vcor.succeeds("material", "case.nml", "--from", "1e-6", "--to", "1e-1", "--points", "40")
        with h5py.File(vcor.folder / "case_material.h5") as file:
            groups = [file[name] for name in file if name != "summary"]
            tables.append([column[...] for group in groups for column in group.values()])
    assert len(tables[0]) == len(tables[1]) > 4
    for one, other in zip(*tables, strict=True):
        if one.dtype.kind == "f":
            assert one == pytest.approx(other, rel=ROUNDING, nan_ok=True)


def test_what_check_prints_runs(vcor):
    vcor.write(case(shifted("sls", "wlf"), temperature=310.0))
    plain = vcor.numbers("case.nml")
    vcor.write(vcor.succeeds("check", "case.nml"), "checked.nml")
    assert vcor.numbers("checked.nml") == plain
    vcor.write(vcor.succeeds("check", "case.nml", "--set", "sheet.vertical_shift=t"), "checked.nml")
    assert vcor.numbers("checked.nml") != plain


@pytest.mark.parametrize("model", ["prony", "table"])
def test_a_sweep_has_the_bits_of_single_runs(vcor, model):
    """On any number of threads, across the reference temperature, with one speed and several."""
    write_points(vcor)
    temperatures = [275.0, 283.15, 298.15, 310.0, 340.0]
    text = case(shifted(model, "wlf"), temperature=300.0)
    sweep = "&sweep parameter = 'impact.temperature', values = " + ", ".join(map(str, temperatures))
    vcor.write(text, "single.nml")
    vcor.write(
        text.replace(", temperature = 300.0", "")
        + "&sweep parameter = 'impact.velocity', values = 2, 5 /\n"
        + sweep
        + " /\n"
    )
    rows = []
    for threads in (1, 2, 3):
        out = vcor.succeeds("run", "case.nml", "--print", ALL, "--quiet", "--threads", threads)
        rows.append(out.splitlines())
    assert rows[0] == rows[1] == rows[2]
    assert len(rows[0]) == 2 * len(temperatures)
    for i, temperature in enumerate(temperatures):
        single = vcor.numbers("single.nml", "--set", f"impact.temperature={temperature}")
        assert rows[0][len(temperatures) + i].split()[-len(NAMES) :] == list(single.values())


def test_constants_of_the_law_are_swept(vcor):
    vcor.write(
        case(shifted("sls", "wlf"), temperature=310.0)
        + "&sweep parameter = 'sheet.wlf_c1', values = 5, 8.86, 12 /\n"
    )
    rows = vcor.succeeds("run", "case.nml", "--print", "cor", "--quiet").splitlines()
    vcor.write(case(shifted("sls", "wlf"), temperature=310.0))
    for value, row in zip((5, 8.86, 12), rows, strict=True):
        single = vcor.numbers("case.nml", "--set", f"sheet.wlf_c1={value}")
        assert row.split()[-1] == single["cor"]


def test_points_without_a_law_have_no_result(vcor):
    vcor.write(
        case(shifted("sls", "wlf"))
        + "&sweep parameter = 'impact.temperature', values = 150, 300 /\n"
    )
    done = vcor("run", "case.nml", "--print", "cor,status", "--quiet")
    assert done.code == 5
    first, second = done.out.splitlines()
    assert first.split()[-2:] == ["nan", "invalid"]
    assert second.split()[-1] == "separated"
    assert "below which the WLF law does not hold" in done.err


@pytest.mark.parametrize(
    "old, new, says",
    [
        (", temperature = 310.0", ", temperature = 0", ["temperature", "> 0 [K]"]),
        (", temperature = 310.0", ", temperature = -3", ["temperature", "> 0 [K]; -3.0 C is 270.15 K"]),
        (", temperature = 310.0", ", temperature = 190", ["wlf_c2 = 101.6", "does not hold"]),
        (", temperature = 310.0", ", temperature = 23", ["does not hold; 23.00 C is 296.15 K"]),
        (", reference_temperature = 298.15", "", ["'reference_temperature' is missing", "'sheet'"]),
        (", wlf_c2 = 101.6", "", ["'wlf_c2' is missing", "shift = 'wlf'"]),
        ("wlf_c2 = 101.6", "wlf_c2 = -5", ["wlf_c2", "> 0 [K]"]),
        ("wlf_c1 = 8.86", "wlf_c1 = nan", ["wlf_c1"]),
        ("shift = 'wlf', ", "", ["'reference_temperature' is for a material of shift wlf, arrhenius, table"]),
        ("'wlf'", "'wfl'", ["shift", "'wfl'", "did you mean 'wlf'"]),
        ("'wlf'", "'arrhenius'", ["'wlf_c1' is for a material of shift wlf"]),
        ("wlf_c1 = 8.86", "activation_energy = 8e4, wlf_c1 = 8.86", ["'activation_energy'"]),
        ("wlf_c1 = 8.86", "valid_temperature_from = 300, valid_temperature_to = 290, wlf_c1 = 8.86",
         ["valid_temperature_from < valid_temperature_to"]),
        ("wlf_c1 = 8.86", "vertical_shift = 3, wlf_c1 = 8.86", [".true. or .false."]),
        ("wlf_c1 = 8.86", "wlf_c1 = 1e30", ["1e-60 and 1e60"]),
    ],
)  # fmt: skip
def test_refused(vcor, old, new, says):
    """In one line that names the case and the key."""
    text = case(shifted("sls", "wlf"), temperature=310.0)
    assert old in text
    vcor.write(text.replace(old, new, 1))
    vcor.refuses("run", "case.nml", code=INPUT, says=["case.nml:", *says])


def test_a_temperature_needs_a_shift(vcor):
    vcor.write(case(material("sls"), temperature=310.0))
    vcor.refuses("run", "case.nml", code=INPUT, says=["needs a shift"], at="case.nml:1")
    vcor.write(
        case(material("sls")) + "&sweep parameter = 'impact.temperature', values = 280, 290 /\n"
    )
    vcor.refuses("run", "case.nml", code=INPUT, says=["does not read", "needs a shift"])
    # an idle material has no say
    idle = shifted("cerf", "wlf", name="idle")
    vcor.write(case(material("sls"), idle, temperature=310.0))
    vcor.refuses("run", "case.nml", code=INPUT, says=["needs a shift"], at="case.nml:1")


def test_idle_materials_need_not_bear_the_temperature(vcor):
    idle = shifted("cerf", "wlf", name="idle").replace("101.6", "10.0")
    vcor.write(case(shifted("sls", "wlf"), idle, temperature=270.0))
    assert vcor.numbers("case.nml")["status"] == "separated"


@pytest.mark.parametrize(
    "table, says",
    [
        ("T [C], log10_aT\n0, 1\n20, 0.5\n10, 0.7\n", ["shift.csv:4", "all rise or all fall"]),
        ("T [C], log10_aT\n0, 1\n20, 1.5\n", ["shift.csv:3", "fall as the temperature rises"]),
        ("T [C], log10_aT\n0, 1\n0, 0.5\n", ["shift.csv:3", "all rise or all fall"]),
        ("T [F], log10_aT\n0, 1\n50, 0.5\n", ["unit of the temperatures", "K or C"]),
        ("T, log10_aT\n0, 1\n50, 0.5\n", ["unit of the temperatures", "K or C"]),
        ("T [C], aT\n0, 1\n50, 0.5\n", ["shift.csv:1", "log10 of the shift factor"]),
        ("T [C], log10_aT\n-300, 1\n50, 0.5\n", ["shift.csv:2", "> 0 K"]),
        ("T [C], log10_aT\n0, 1, 2\n50, 0.5\n", ["shift.csv:2", "3 columns"]),
        ("T [C], log10_aT\n0, x\n50, 0.5\n", ["shift.csv:2", "'x'"]),
        ("T [C], log10_aT\n0, nan\n50, 0.5\n", ["shift.csv:2"]),
        ("T [C], log10_aT\n0, 1\n", ["2 at least"]),
        ("", ["shift.csv"]),
        ("250,3\n298.15,0\n320,-1.5\n", ["shift.csv:1", "without names", "vcor table shift.csv"]),
        ("250 3\n298.15 0\n", ["shift.csv:1", "1 column", "vcor table shift.csv > t.csv"]),
        ("Temp./°C;log aT\n-23,15;3\n", ["shift.csv:1", "vcor table shift.csv > t.csv"]),
        ("T [C],ln aT\n0,1\n50,-3\n", ["shift.csv:1", "log10 of the shift factor"]),
        ("T [C], log10_aT\n30, 1\n90, -4\n", ["303.15 K to 363.15 K", "not extrapolated"]),
        ("T [C], log10_aT\n-30, 1\n30, -4\n", ["243.15 K to 303.15 K", "not extrapolated"]),
    ],
)
def test_refused_tables(vcor, table, says):
    vcor.write(table, "shift.csv")
    vcor.write(case(shifted("sls", "table"), temperature=310.0))
    vcor.refuses("run", "case.nml", code=INPUT, says=says)


def test_a_missing_table(vcor):
    vcor.write(case(shifted("sls", "table").replace("shift.csv", "no.csv"), temperature=310.0))
    vcor.refuses("run", "case.nml", code=FILE, says=["no.csv"], at="case.nml:6")


@pytest.mark.parametrize(
    "table",
    [
        "T [K], log10_aT\n250, 3\n298.15, 0\n320, -1.5\n",
        "temperature [K],log10_shift_factor [1]\n320,-1.5\n298.15,0\n250,3\n",
        "# of BUTYL\n\ntemperature [degC],log10 a_T\r\n-23.15,3\r\n25.0,0\r\n46.85,-1.5\r\n",
        # only differences count
        "Temperature (degC), log10(a_T)\n-23.15,5\n25.0,2\n46.85,0.5\n",
    ],
)
def test_tables(vcor, table):
    """Names and units; the factor at the reference temperature is 1."""
    vcor.write(table, "shift.csv")
    vcor.write(case(shifted("sls", "table"), temperature=320.0))
    found = vcor.numbers("case.nml")
    vcor.write(case(material("sls", 10**-1.5)))
    same(found, vcor.numbers("case.nml"), 1e-9)


def test_temperatures_beyond_the_data_are_warned_of(vcor):
    text = case(shifted("sls", "wlf"), temperature=310.0)
    text = text.replace("wlf_c1", "valid_temperature_from = 250, valid_temperature_to = 305, wlf_c1")
    vcor.write(text)
    done = vcor("run", "case.nml", "--print", "cor", "--quiet")
    assert done.code == 0
    assert "vcor: warning: case.nml: the temperature, 310.0 K = 36.85 C, lies outside" in done.err
    assert "(valid_temperature_from 250.0 K = -23.15 C, valid_temperature_to 305.0 K = 31.85 C)" in done.err
    vcor.write(text + "&sweep parameter = 'impact.temperature', values = 240, 250, 300, 320 /\n")
    done = vcor("run", "case.nml", "--print", "cor", "--quiet")
    assert done.err.count("vcor: warning") == 1
    assert "2 of 4 temperatures lie outside" in done.err
    # data of one temperature scatter by a degree
    for inside in ("300.0", "305.007", "249.5"):
        vcor.write(text.replace("310.0", inside))
        assert vcor("run", "case.nml", "--print", "cor", "--quiet").err == ""


def test_notes(vcor):
    """No temperature, and one in degrees Celsius."""
    vcor.write(case(shifted("sls", "wlf")))
    for command in ("run", "check"):
        done = vcor(command, "case.nml")
        assert done.code == 0
        notes = [line for line in done.err.splitlines() if "validity" not in line]
        assert len(notes) == 1
        assert notes[0].startswith("vcor: note: case.nml:")
        assert "'sheet' is at its reference temperature, 298.15 K" in notes[0]
    vcor.write(case(shifted("sls", "wlf").replace("298.15", "27.0"), temperature=25.0))
    assert "temperature = 25.0 K is less than 100.0: is it in degrees Celsius? That is 298.15 K" in vcor(
        "check", "case.nml"
    ).err


def test_the_band_of_times_is_shifted(vcor):
    """valid_from and valid_to hold at the reference temperature."""
    a = factor("wlf", 310.0)
    said = []
    for text in (
        case(shifted("sls", "wlf"), temperature=310.0).replace("'wlf'", "'wlf', valid_from = 1e-3"),
        case(material("sls", a, more=f"valid_from = {1e-3 * a!r}")),
    ):
        vcor.write(text)
        said.append(vcor("run", "case.nml", "--print", "cor", "--quiet").err)
    assert said[0] == said[1]
    assert "valid_from" in said[0]


def test_another_table_is_another_case(vcor):
    """The file of an unfinished sweep has a check sum of its table."""
    vcor.write(
        case(shifted("sls", "table"))
        + "&sweep parameter = 'impact.temperature', values = 280, 290, 300 /\n"
    )
    vcor.write("another\n", "case.part")
    said = []
    for _ in range(2):
        done = vcor("run", "case.nml", "--resume", "--quiet")
        assert done.code == FILE
        said.append(done.err.split("expected '")[1])
        vcor.write("T [C], log10_aT\n0, 1\n50, -3\n", "shift.csv")
    assert said[0] != said[1]
