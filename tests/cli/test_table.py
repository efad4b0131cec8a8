"""Model table: E(t) from a data file."""

import os
import re

import numpy as np
import pytest
from cases import HEAD, MODELS, edit
from program import FILE, INPUT, NUMERICAL, complaint

# The plate is BUTYL as in MODELS["prony"], by its points
PLAIN = HEAD + "   model = 'table'\n   file = 'data.csv'\n/\n"
TABLE = PLAIN[:-2] + "   time_unit = 's'\n   modulus_unit = 'Pa'\n/\n"
LINE = TABLE.splitlines().index("   file = 'data.csv'") + 1


def modulus(time):
    """The Prony series of MODELS["prony"]."""
    terms = [(20.181e6, 972.0), (38.204e6, 6426.0), (87.344e6, 34221.0)]
    return 10.421e6 + sum(e * np.exp(-rate * time) for e, rate in terms)


def points(per_decade=25):
    """Times and moduli, from 0.1 us to 10 s."""
    time = np.logspace(-7, 1, 8 * per_decade + 1)
    return time, modulus(time)


def rows(columns, separator=","):
    """Lines of a data file."""
    return [separator.join(map(repr, map(float, row))) for row in zip(*columns, strict=True)]


LINES = rows(points())
DATA = "\n".join(LINES) + "\n"


@pytest.fixture
def table(vcor):
    vcor.write(TABLE)
    vcor.write(DATA, "data.csv")
    return vcor


def cor(vcor, *words):
    return float(vcor.numbers("case.nml", *words)["cor"])


def test_is_the_series_its_points_are_from(vcor):
    """The interpolation is within 5e-5 of the modulus with 25 points to the decade, and within a
    third of that with 50; the restitution changes by a fraction of it."""
    fine = ["--set", "solver.method=direct", "--set", "solver.accuracy=1e-7"]
    vcor.write(HEAD + MODELS["prony"])
    exact = cor(vcor, *fine)
    tangent = float(vcor.numbers("case.nml")["loss_tangent"])
    vcor.write(TABLE)
    errors = []
    for per_decade in (25, 50, 100):
        vcor.write("\n".join(rows(points(per_decade))), "data.csv")
        errors.append(abs(cor(vcor, *fine) - exact))
        assert abs(cor(vcor) - cor(vcor, *fine)) < 5e-6
        assert float(vcor.numbers("case.nml")["loss_tangent"]) == pytest.approx(tangent, rel=1e-4)
    assert errors[0] < 2e-5
    assert errors[1] < errors[0] / 3
    assert errors[2] < errors[1] / 3


@pytest.mark.parametrize("method", ["direct", "ive"])
def test_constant_modulus_is_elastic(vcor, method):
    setting = ["--set", f"solver.method={method}", "--print", "cor,inelasticity,loss_tangent"]
    vcor.write(HEAD + MODELS["elastic"])
    exact = vcor.succeeds("run", "case.nml", *setting).split()
    vcor.write(TABLE)
    vcor.write("1e-6,15e6\n1e-3,15e6\n1,15e6\n", "data.csv")
    found = vcor.succeeds("run", "case.nml", *setting).split()
    assert list(map(float, found)) == pytest.approx(list(map(float, exact)), rel=1e-9)


FORMS = {
    "header": "time,modulus\n" + DATA,
    "header with units": "time [s],relaxation_modulus [Pa]\n" + DATA,
    "units in parentheses": "t (s), E(t) (Pa)\n" + DATA,
    "other units": "Time [ms],E [N/mm2]\n"
    + "\n".join(rows((points()[0] * 1e3, points()[1] / 1e6))) + "\n",
    "remark first": "# BUTYL, 300 K\n#\n\ntime,modulus\n" + DATA,
    "remarks between": DATA.replace("\n", "\n# 1,2\n \t\n"),
    "remarks behind": DATA.replace("\n", "  # 1,2\n"),
    "commas and blanks": DATA.replace(",", " , "),
    "indented": "  " + DATA.replace("\n", " \t\n\t "),
    "CRLF": DATA.replace("\n", "\r\n"),
    "byte-order mark": "\ufeff" + DATA,
    "byte-order mark and header": "\ufefftime,modulus\r\n" + DATA.replace("\n", "\r\n"),
    "last line without end": DATA[:-1],
    "D exponents": DATA.replace("e", "D"),
}


@pytest.mark.parametrize(
    "head, name, unit", [("t [ms],E [Pa]", "time", "ms"), ("time [s],E [MPa]", "modulus", "MPa")]
)
def test_units_of_the_header(vcor, head, name, unit):
    """They are taken; those of the case must not contradict them, nor may both be missing."""
    vcor.write(PLAIN)
    vcor.write(head + "\n" + DATA, "data.csv")
    assert float(vcor.numbers("case.nml")["cor"]) > 0
    vcor.write(TABLE)
    says = [f"'{unit}'", f"{name}_unit = '{'s' if name == 'time' else 'Pa'}'", "leave that out"]
    vcor.refuses("run", "case.nml", code=INPUT, at="data.csv:1", says=says)
    vcor.write(PLAIN)
    for head in ("", "t,E\n"):
        vcor.write(head + DATA, "data.csv")
        says = ["no unit of the time", "time_unit", "vcor table data.csv > t.csv"]
        vcor.refuses("run", "case.nml", code=INPUT, at="data.csv:1", says=says)


OTHERS = {
    "semicolons": (DATA.replace(",", ";"), "1 column"),
    "tabs": (DATA.replace(",", "\t"), "1 column"),
    "blanks": (DATA.replace(",", "   "), "1 column"),
    "decimal commas": (DATA.replace(",", ";").replace(".", ","), "expected a number"),
    "title": ("Relaxation of BUTYL at 300 K\n" + DATA, "1 column"),
    "old line ends": (DATA.replace("\n", "\r"), "control character"),
    "shear": ("omega [rad/s],G [Pa]\n" + DATA, "'omega'"),
    "frequency": ("f [Hz],E [Pa]\n" + DATA, "'f'"),
    "tab in a name": ("t\tx [s],E [Pa]\n" + DATA, "'t x'"),
    "temperature": ("T [s],E [Pa]\n" + DATA, "'T'"),
    "order": ("E,t\n" + DATA, "'E'"),
    "storage": ("t,E'\n" + DATA, "'E''"),
    "complex": ("t,E*\n" + DATA, "'E*'"),
    "stress": ("t [s],stress [Pa]\n" + DATA, "'stress'"),
    "logarithms": ("log t,log E\n" + DATA, "'log_t'"),
    "unit of time": ("t [days],E [Pa]\n" + DATA, "'days'"),
    "unit of modulus": ("t [s],E [bar]\n" + DATA, "'bar'"),
    "capitals": ("t [s],E [MPA]\n" + DATA, "'MPA'"),
}


@pytest.mark.parametrize("kind", OTHERS)
def test_other_files_name_the_command_that_converts(vcor, kind):
    text, said = OTHERS[kind]
    vcor.write(PLAIN)
    vcor.write(text.encode(), "data.csv")
    says = [said, "vcor table data.csv > t.csv"]
    vcor.refuses("run", "case.nml", code=INPUT, at="data.csv:1", says=says)


@pytest.mark.parametrize("head", ["t [s],G [Pa]", "t,shear modulus", "t,G(t)"])
def test_shear_moduli(table, head):
    table.write(head + "\n" + DATA, "data.csv")
    says = ["shear modulus", "2 (1 + nu) G", "modulus_kind = 'shear'"]
    table.refuses("run", "case.nml", code=INPUT, at="data.csv:1", says=says)


@pytest.mark.parametrize("form", FORMS)
def test_forms_of_a_file(table, form):
    expected = table.numbers("case.nml")
    table.write(FORMS[form].encode(), "data.csv")
    if form == "other units":
        table.write(PLAIN)
        found = table.numbers("case.nml")["cor"]
        assert float(found) == pytest.approx(float(expected["cor"]), rel=1e-8)
    else:
        assert table.numbers("case.nml") == expected


@pytest.mark.parametrize(
    "key, unit, size",
    [
        ("time_unit", "ns", 1e-9),
        ("time_unit", "us", 1e-6),
        ("time_unit", "ms", 1e-3),
        ("time_unit", "s", 1.0),
        ("time_unit", "min", 60.0),
        ("time_unit", "h", 3600.0),
        ("modulus_unit", "Pa", 1.0),
        ("modulus_unit", "kPa", 1e3),
        ("modulus_unit", "MPa", 1e6),
        ("modulus_unit", "GPa", 1e9),
        ("modulus_unit", "mpa", 1e6),
    ],
)
def test_units(table, key, unit, size):
    expected = cor(table)
    time, values = points()
    if key == "time_unit":
        time = time / size
    else:
        values = values / size
    table.write("\n".join(rows((time, values))), "data.csv")
    setting = ["--set", f"rubber.{key}={unit}"]
    # the steps of the solver may fall differently where a digit does
    assert cor(table, *setting) == pytest.approx(expected, rel=1e-8)
    name = {"mpa": "MPa"}.get(unit, unit)
    assert f"{key} = '{name}'" in table.succeeds("check", "case.nml", *setting)


def test_units_are_known(table):
    text, line = edit(TABLE, "material", "time_unit", "'days'")
    table.write(text)
    table.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=["'days'", "min, h"])
    text, line = edit(TABLE, "material", "modulus_unit", "'psi'")
    table.write(text)
    table.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=["'psi'", "MPa, GPa"])


def test_file_in_the_folder_of_the_case(vcor):
    """A path is from the folder of the case, wherever the program runs."""
    text = TABLE.replace("data.csv", "data/rubber.csv")
    vcor.write(text, "study/case.nml")
    vcor.write(DATA, "study/data/rubber.csv")
    expected = vcor.numbers("study/case.nml")
    inside = vcor.folder / "study"
    assert vcor.numbers("case.nml", cwd=inside) == expected
    assert vcor.numbers("../study/case.nml", cwd=inside) == expected
    assert vcor.numbers(inside / "case.nml", cwd="/") == expected
    vcor.write(DATA, "other.csv")
    for path in ("../other.csv", vcor.folder / "other.csv", "'../other.csv'"):
        setting = ["--set", f"rubber.file={path}"]
        assert vcor.numbers("study/case.nml", *setting) == expected
    absolute = text.replace("data/rubber.csv", str(vcor.folder / "other.csv"))
    vcor.write(absolute, "absolute.nml")
    assert vcor.numbers("absolute.nml") == expected


def test_check_prints_the_name_of_the_file(table):
    out = table.succeeds("check", "case.nml")
    assert "file = 'data.csv'" in out
    assert "time_unit = 's'" in out and "modulus_unit = 'Pa'" in out
    assert "times = " not in out and "moduli = " not in out
    table.write(out, "again.nml")
    assert table.numbers("again.nml") == table.numbers("case.nml")


def with_line(number, line):
    """The data with another line."""
    lines = list(LINES)
    lines[number - 1] = line
    return "\n".join(lines) + "\n"


T4, E4 = LINES[3].split(",")
BAD = {
    "text": (with_line(5, "x,1e6"), 5, ["'x'", "a number"]),
    "text for a modulus": (with_line(5, "1e-3,hard"), 5, ["'hard'", "a number"]),
    "half a header": ("time,5\n" + DATA, 1, ["'time'", "a number"]),
    "two headers": ("time,modulus\ns,Pa\n" + DATA, 2, ["'s'", "a number"]),
    "letter in a number": (with_line(5, "1e-3,1O.5"), 5, ["'1O.5'"]),
    "numbers in quotes": (with_line(5, '"1e-3","1e6"'), 5, ['"1e-3"']),
    "unit behind a number": (with_line(5, "1e-3 s,1e6"), 5, ["'1e-3 s'"]),
    "repeated time": (with_line(5, f"{T4},1e6"), 5, ["after", "line 4", "increase"]),
    "falling time": (with_line(5, "1e-9,1e6"), 5, ["time 1.0e-9", "line 4", "increase"]),
    "growing modulus": (with_line(5, f"{LINES[4].split(',')[0]},2e9"), 5, ["2.0e9", "line 4"]),
    "time of zero": (with_line(1, "0,2e9"), 1, ["0.0", "a time > 0"]),
    "negative time": (with_line(1, "-1,2e9"), 1, ["-1.0", "a time > 0"]),
    "modulus of zero": (with_line(5, f"{LINES[4].split(',')[0]},0.0"), 5, ["0.0", "a modulus > 0"]),
    "negative modulus": (with_line(5, f"{LINES[4].split(',')[0]},-1"), 5, ["-1.0", "a modulus"]),
    "nan": (with_line(5, f"{LINES[4].split(',')[0]},nan"), 5, ["'nan'", "finite"]),
    "nan first": ("nan,nan\n" + DATA, 1, ["'nan'", "finite"]),
    "infinity": (with_line(5, f"{LINES[4].split(',')[0]},Inf"), 5, ["'Inf'", "finite"]),
    "too large": (with_line(1, "1e-7,1e301"), 1, ["1e301", "too large"]),
    "far too large": (with_line(1, "1e-7,1e99999"), 1, ["too large"]),
    "too small": (with_line(1, "1e-301,1e6"), 1, ["1e-301", "too small"]),
    "beyond all": (with_line(1, "1e-7,1e31"), 1, ["1.0e31", "1.0e30"]),
    "one column": (with_line(5, "1e-3"), 5, ["1 column", "expected 2"]),
    "three columns": (with_line(5, "1e-3,1e6,1"), 5, ["3 columns", "expected 2"]),
    "three columns by blanks": (with_line(5, "1e-3 1e6 1"), 5, ["1 column", "expected 2"]),
    "comma at the end": (with_line(5, "1e-3,1e6,"), 5, ["3 columns"]),
    "decimal commas": (with_line(5, "0,001;1000000,5"), 5, ["3 columns"]),
    "no modulus": (with_line(5, "1e-3,"), 5, ["''", "a number"]),
    "after remarks": ("# a\n\n# b\ntime,modulus\n" + with_line(5, "1e-3"), 9, ["1 column"]),
    "CRLF": (with_line(5, "1e-3").replace("\n", "\r\n"), 5, ["1 column"]),
}


@pytest.mark.parametrize("command", ["run", "check"])
@pytest.mark.parametrize("kind", BAD)
def test_bad_lines(table, command, kind):
    text, line, says = BAD[kind]
    table.write(text.encode(), "data.csv")
    table.refuses(command, "case.nml", code=INPUT, at=f"data.csv:{line}", says=says)


FEW = ["", "\n", "# only a remark\n", "\ufeff", "time,modulus\n", "1e-3,1e6\n", "t,E\n1e-3,1e6\n"]


@pytest.mark.parametrize("text", FEW)
def test_too_few_points(table, text):
    """The line is the last one, where more were expected."""
    table.write(text, "data.csv")
    n = "1 point," if "1e-3" in text else "0 points,"
    at = f"data.csv:{max(1, text.count(chr(10)))}"
    table.refuses("run", "case.nml", code=INPUT, at=at, says=[n, "2 at least"])


def test_two_points_are_enough(table):
    table.write("1e-7,1e8\n1e-1,1e6\n", "data.csv")
    assert 0 < cor(table) < 1
    assert cor(table) == pytest.approx(cor(table, "--set", "solver.method=direct"), abs=1e-3)


@pytest.mark.parametrize("n", [1, 100, 100_000])
def test_random_bytes(table, n):
    state, data = 1, bytearray()
    for _ in range(n):
        state = (state * 1103515245 + 12345) % 2**31
        data.append(state >> 16 & 255)
    table.write(bytes(data), "data.csv")
    table.refuses("run", "case.nml", code=INPUT, says="data.csv")


def test_message_names_the_folder(vcor):
    vcor.write(TABLE, "study/case.nml")
    vcor.write("1e-3\n1e-2,1\n", "study/data.csv")
    vcor.refuses("run", "study/case.nml", code=INPUT, at="study/data.csv:1", says="1 column")


def test_missing_file(vcor):
    vcor.write(TABLE)
    vcor.refuses("run", "case.nml", code=FILE, at=f"case.nml:{LINE}", says=["data.csv", "no such"])
    setting = ["--set", "rubber.file=other.csv"]
    where = "--set rubber.file"
    vcor.refuses("check", "case.nml", *setting, code=FILE, at=where, says=["other.csv", "no such"])


def test_folder_in_place_of_a_file(vcor):
    vcor.write(TABLE)
    (vcor.folder / "data.csv").mkdir()
    where = f"case.nml:{LINE}"
    vcor.refuses("run", "case.nml", code=FILE, at=where, says=["data.csv", "directory", "moduli"])


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read every file")
def test_unreadable_file(table):
    (table.folder / "data.csv").chmod(0)
    table.refuses("run", "case.nml", code=FILE, at=f"case.nml:{LINE}", says="ermission")


def test_large_file(table):
    table.write("# " + "x" * 5_000_000 + "\n" + DATA, "data.csv")
    table.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{LINE}", says=["data.csv", "4 MB"])


def test_file_is_required(vcor):
    vcor.write(TABLE.replace("   file = 'data.csv'\n", ""))
    vcor.refuses("run", "case.nml", code=INPUT, says=["'file'", "missing", "'table'"])
    vcor.write(TABLE.replace("'data.csv'", "''"))
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{LINE}", says="empty")


@pytest.mark.parametrize("key", ["times", "moduli", "rates"])
def test_the_points_cannot_be_typed(table, key):
    text, line = edit(TABLE, "material", key, "1.0, 2.0")
    table.write(text)
    says = [f"'{key}'", "'table'", "file, time_unit, modulus_unit"]
    table.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=says)


def test_results_do_not_replace_the_data(vcor):
    """The history of rubber.nml would be rubber.csv."""
    vcor.write(TABLE.replace("data.csv", "rubber.csv"), "rubber.nml")
    vcor.write(DATA, "rubber.csv")
    vcor.refuses("run", "rubber.nml", code=INPUT, says=["rubber.csv", "output.stem"])
    vcor.succeeds("run", "rubber.nml", "--output", "out")
    vcor.succeeds("run", "rubber.nml", "--set", "output.history=.false.")
    assert (vcor.folder / "rubber.csv").read_text() == DATA
    # nor that of another case of the same call, in either order
    vcor.write(HEAD + MODELS["sls"], "other.nml")
    words = ["other.nml", "rubber.nml", "--set", "output.history=.false."]
    vcor.write(TABLE.replace("data.csv", "other_summary.csv"), "rubber.nml")
    vcor.write(DATA, "other_summary.csv")
    vcor.refuses("run", *words, code=INPUT, says=["other_summary.csv", "output.stem"])
    words[:2] = words[1::-1]
    vcor.refuses("run", *words, code=INPUT, says=["other_summary.csv", "output.stem"])


def test_note_on_data_that_do_not_cover_the_contact(table):
    assert "note" not in table.succeeds("run", "case.nml")
    table.write("\n".join(LINES[75:]), "data.csv")
    out = table.succeeds("run", "case.nml")
    assert "note: the data of the plate (data.csv) begin at 1.0E-04 s" in out
    assert re.search(r"begin at 1.0E-04 s: [0-9.]+ % of the contact lies before, where the modulus is taken as constant", out)
    # a response by frequencies needs exponentials
    exact = table("run", "case.nml", "--set", "plate.waves=body", "--set", "output.stem=exact")
    assert "% of the contact lies before, where the modulus is that of exponentials fitted to the data" in exact.out
    assert out.count("note: the data") == 1
    # with bare numbers, too
    bare = table("run", "case.nml", "--print", "cor")
    assert bare.code == 0
    assert "note: case.nml: the data of the plate (data.csv) begin at 1.0E-04 s" in bare.err
    table.write("\n".join(LINES[:50]), "data.csv")
    out = table.succeeds("run", "case.nml")
    assert "note: the data of the plate (data.csv) end at " in out
    assert out.count("note: the data") == 1


def test_contacts_of_a_sweep_that_the_data_do_not_cover(table):
    """How many lie wholly before the data, or how much of the shortest; of the longest after."""
    table.write(TABLE + "&sweep parameter='impact.velocity', values=0.01, 1, 10 /\n", "sweep.nml")
    words = ["run", "sweep.nml", "--quiet"]

    def contacts():
        """Contact times, the longest first."""
        return [float(x) for x in table(*words, "--print", "contact_time").out.split()]

    def said(kept):
        """What is said of so much of the data."""
        table.write("\n".join(kept), "data.csv")
        done = table(*words)
        assert done.code == 0 and done.err.count("warning") == 1
        return re.search(r"of 'rubber' \(data.csv\) (.*) lies? .*constant", done.err)[1]

    assert table(*words).err == ""
    longest, middle, shortest = contacts()
    times = np.array([float(line.split(",")[0]) for line in LINES])
    first = np.argmax(times > (middle * longest) ** 0.5)
    assert said(LINES[first:]) == f"begin at {times[first]:.1E} s: 2 of 3 contacts"
    first = np.argmax(times > 0.3 * shortest)
    words_said = said(LINES[first:])
    share = 100 * times[first] / contacts()[-1]
    assert words_said == f"begin at {times[first]:.1E} s: {share:.0f} % of the shortest contact"
    last = np.argmax(times > 0.5 * longest)
    words_said = said(LINES[: last + 1])
    share = 100 * (1 - times[last] / contacts()[0])
    assert words_said == f"end at {times[last]:.1E} s: {share:.0f} % of the longest contact"


def test_ten_thousand_points(table):
    expected = cor(table)
    time = np.logspace(-7, 1, 10_000)
    table.write("\n".join(rows((time, modulus(time)))), "data.csv")
    assert cor(table) == pytest.approx(expected, abs=2e-5)


def falling(first, n=40):
    """Data of a modulus that falls as a power of the time, from `first` to 10 s."""
    time = np.logspace(np.log10(first), 1, n)
    return "\n".join(rows((time, 1e7 * (time / first) ** -0.3))) + "\n"


@pytest.mark.parametrize("first", [1e-3, 1e-2])
def test_data_that_begin_after_the_contact(table, first):
    """No sum of exponentials stands for the modulus: auto takes the method that works, which ive is
    not, and says so nowhere but where it names the method."""
    table.write(falling(first), "data.csv")
    direct = ["--set", "solver.method=direct"]
    auto = table.numbers("case.nml")
    assert auto == table.numbers("case.nml", *direct)
    fine = table.numbers("case.nml", *direct, "--set", "solver.accuracy=1e-8")
    assert abs(float(auto["cor"]) - float(fine["cor"])) < 1e-6
    assert "\n  method direct in " in table.succeeds("run", "case.nml")
    assert "so only direct is shown" in table.succeeds("verify", "case.nml")
    done = table("run", "case.nml", "--set", "solver.method=ive", "--print", "cor,cor_error,status")
    assert (done.code, done.out) == (NUMERICAL, "nan nan failed\n")
    complaint(done, NUMERICAL, ["method = 'auto' tries the other method"], at="case.nml")


def test_data_that_begin_after_the_contacts_of_a_sweep(table):
    table.write(TABLE + "&sweep parameter = 'impact.velocity', values = 1, 5 /\n")
    table.write(falling(1e-3), "data.csv")
    words = ["run", "case.nml", "--print", "cor,status"]
    found = table(*words)
    assert found.code == 0 and "the data of 'rubber' (data.csv) begin at 1.0E-03 s" in found.err
    assert found.out == table(*words, "--set", "solver.method=direct").out
    done = table(*words, "--set", "solver.method=ive")
    assert (done.code, done.out) == (NUMERICAL, "nan failed\n" * 2)
    assert "2 of 2 points without result" in done.err


def test_error_above_the_accuracy(table):
    """A result that is less accurate than asked for has a note, one that is a hundred times less is
    none."""
    ive = ["--set", "solver.method=ive", "--set"]
    error = float(table.numbers("case.nml", *ive, "solver.accuracy=1e-2")["cor_error"])
    assert 1e-7 < error < 1e-4
    note = "above the accuracy asked for"
    for share, code, notes in [(1.1, 0, 0), (0.9, 0, 1), (0.011, 0, 1), (0.009, NUMERICAL, 0)]:
        done = table("run", "case.nml", *ive, f"solver.accuracy={share * error}")
        assert (done.code, done.out.count(note)) == (code, notes)
    bare = ["run", "case.nml", *ive, f"solver.accuracy={0.1 * error}", "--print", "cor"]
    done = table(*bare)
    assert done.code == 0 and done.out.count("\n") == 1
    assert done.err.count("\n") == 1 and done.err.startswith("vcor: note: case.nml: ")
    assert note in done.err
    done = table(*bare, "--quiet")
    assert (done.code, done.err) == (0, "")
    table.write(TABLE + "&sweep parameter = 'impact.velocity', values = 10, 20 /\n")
    done = table(*bare)
    assert done.code == 0 and done.out.count("\n") == 2
    assert done.err.count("\n") == 1
    assert f"vcor: note: case.nml: 2 of 2 points have an estimated error {note}" in done.err
    done = table(*bare, "--quiet")
    assert (done.code, done.err) == (0, "")
    words = ["run", "case.nml", "--output", "other"]
    out = table.succeeds(*words, *ive, f"solver.accuracy={0.1 * error}")
    assert f"2 of 2 points have an estimated error {note}" in out
