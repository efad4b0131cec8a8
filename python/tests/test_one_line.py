"""Input that is damaged or blank ends in one line that can be read, with the right exit code."""

import sys
import warnings

import numpy as np
import pytest

import vcor
from vcor import _command
from vcor._command import MODULES
from vcor.materials.grid import digits_of, resolution

DROP = """&impact drop_height = 1.0 /
&sphere radius = 0.006, mass = 0.007, material = 'hard' /
&plate material = 'soft', waves = 'none' /
&material name = 'hard', model = 'rigid' /
&material name = 'soft', model = 'power_law', poisson_ratio = 0.5, coefficient = 4e6,
   exponent = 0.15 /
"""
#: Letters of a message at most, the name of its file apart
MOST = 300


def refusal(capsys, name, *words):
    """Exit code and line of a command that refuses its input."""
    with pytest.raises(SystemExit) as caught:
        _command.call(name, [str(word) for word in words])
    line = capsys.readouterr().err
    assert line.startswith("vcor: error: ") and line.count("\n") == 1
    return caught.value.code, line


# -------------------------------------------------------------------------- numbers of any power

HUGE = ["1e400", "1e999", f"1e{'9' * 5000}", f"1{'0' * 5000}", f"-1e{'1' * 4400}", "1e+0400"]


DYNAMIC = "f [Hz],omega [rad/s],E' [Pa],E'' [Pa]\n1,6.2832,1e6,1e5\n10,62.832,2e6,2e5\n"


@pytest.mark.parametrize("cell", HUGE)
@pytest.mark.parametrize("text", [
    "t [s],E [Pa]\n1,3e6\n2,{}\n3,2e6\n",
    "t [s],E [Pa]\n1,3e6\n{},2.5e6\n3,2e6\n",
    # a quantity that stands there twice
    DYNAMIC + "{},628.32,3e6,3e5\n",
    DYNAMIC + "{0},{0},3e6,3e5\n",
])  # fmt: skip
def test_numbers_that_are_no_reals_are_refused(tmp_path, capsys, cell, text):
    (tmp_path / "a.csv").write_text(text.format(cell))
    for name in ("table", "fit"):
        code, line = refusal(capsys, name, tmp_path / "a.csv")
        assert code == 3 and len(line) < MOST + len(str(tmp_path))


@pytest.mark.parametrize(
    "cell", ["0e400", f"0e{'9' * 5000}", "0.0e-400", "1e-400", f"1e-{'1' * 4400}"]
)
def test_zero_with_any_power_is_zero(tmp_path, cell):
    (tmp_path / "a.csv").write_text(f"velocity [m/s],cor,impact.gravity\n1,0.5,{cell}\n2,0.4,0\n")
    assert vcor.read_data(tmp_path / "a.csv")["impact.gravity"].tolist() == [0.0, 0.0]


@pytest.mark.parametrize(("cell", "unit", "count"), [
    ("1.50", 0.01, 3), ("1500", 100.0, 2), ("2.5e-3", 1e-4, 2), ("1,25d2", 1.0, 3),
    ("0e400", np.inf, 0), ("1e-999", 0.0, 1), (f"1.0e{'9' * 4400}", np.inf, 2),
])  # fmt: skip
def test_the_unit_of_the_last_digit(cell, unit, count):
    assert digits_of(cell) == (pytest.approx(unit, rel=1e-15), count)
    if count > 1 and unit < 10:
        assert resolution(cell) == pytest.approx(unit / 2, rel=1e-15)


# ----------------------------------------------------------------------------- blanks and lengths


@pytest.mark.parametrize("blank", [" ", "\t", "\r", "\n", "", "  \n"])
@pytest.mark.parametrize("name", ["table", "card"])
def test_a_blank_argument_is_refused(capsys, name, blank):
    code, line = refusal(capsys, name, "a.csv", blank)
    assert code == 2 and f"unrecognized arguments: {blank!r}" in line


@pytest.mark.parametrize("name", [name for name in MODULES if name != "export"])
def test_a_blank_file_is_refused(capsys, tmp_path, name):
    words = {"card": ["--for", "abaqus"], "identify": ["a.csv", "--free", "a.b"],
             "page": ["--vary", "a.b=1:2", "--save", f"{tmp_path / 'page.html'}"],
             "uncertainty": ["--vary", "a.b=5%"]}.get(name, [])  # fmt: skip
    assert refusal(capsys, name, "", *words)[0] in (2, 4)
    assert refusal(capsys, name, tmp_path / " ", *words)[0] == 4


@pytest.mark.parametrize("name", ["table", "fit"])
def test_a_standard_input_that_is_closed_is_refused(capsys, monkeypatch, name):
    monkeypatch.setattr(sys, "stdin", None)
    assert refusal(capsys, name, "-") == (4, "vcor: error: the standard input is closed\n")


@pytest.mark.parametrize("name", ["X_Columns", "X_Dimension", "X0", "Delta_X", "Y_Unit_Label"])
@pytest.mark.parametrize("value", ["", "\t", "\tnonsense"])
def test_a_line_of_labview_without_a_value(tmp_path, name, value):
    facts = {"X_Columns": "\tNo", "X_Dimension": "\tTime", "X0": "\t0.0", "Delta_X": "\t0.1",
             "Y_Unit_Label": "\tN", name: value}  # fmt: skip
    lines = [f"{key}{one}" for key, one in facts.items()]
    (tmp_path / "a.lvm").write_text(
        "LabVIEW Measurement\t\n" + "\n".join(lines) + "\n***End_of_Header***\nX_Value\tForce\n"
        "\t9\n\t8\n"
    )
    try:
        vcor.read_data(tmp_path / "a.lvm")
    except vcor.InputError as error:
        assert len(str(error)) < MOST + len(str(tmp_path))


@pytest.mark.parametrize("letter", ["x", "x ", "'", "é", "1"])
def test_a_line_is_short_whatever_a_cell_holds(tmp_path, capsys, letter):
    long = letter * 20_000
    for text in (f"t [s],{long}\n1,2\n2,1\n", f"t [s],E [Pa]\n1,{long}\n2,1\n",
                 ",".join(f"column {i}" for i in range(200)) + "\n" + ",".join("1" * 200) + "\n",
                 f"velocity [m/s],{long}\n1,2\n2,1\n"):  # fmt: skip
        (tmp_path / "a.csv").write_text(text)
        code, line = refusal(capsys, "table", tmp_path / "a.csv")
        # the columns that are known are named
        assert code in (2, 3) and len(line) < 3.5 * MOST


@pytest.mark.parametrize("name", ["LAMMPS", "lammps", "MercuryDPM", "Yade"])
def test_programs_of_another_command_are_named(capsys, name):
    code, line = refusal(capsys, "card", "a.nml", "--for", name)
    assert code == 2 and f"vcor export writes for {name.lower()}" in line
    # in any case, where they belong: the case is what is missing
    code, line = refusal(capsys, "export", "no.nml", "--for", name, "--velocities", "1:2:3")
    assert code == 4 and "no.nml" in line


def test_a_figure_of_a_case_says_what_is_drawn(tmp_path, capsys):
    (tmp_path / "a.nml").write_text(DROP)
    code, line = refusal(capsys, "plot", tmp_path / "a.nml")
    assert code == 3 and "the results of vcor run, a .h5" in line


# ------------------------------------------------------------------------------------- arguments


@pytest.mark.parametrize("call", [
    vcor.open, vcor.read, vcor.fit, vcor.master, vcor.read_data, vcor.read_card,
    lambda path: vcor.card(path, "m"), lambda path: vcor.identify(path, path, ["a.b"]),
    lambda path: vcor.identify(vcor.Case(DROP), path, ["soft.exponent"]),
    lambda path: vcor.propagate(path, {"a.b": 0.1}),
    lambda path: vcor.propagate(vcor.Case(DROP), {}, covariance=path),
])  # fmt: skip
def test_a_byte_0_in_a_path_is_refused(call):
    with pytest.raises((vcor.FileError, vcor.InputError), match="null byte|byte 0"):
        call("a\0b")


@pytest.mark.parametrize("given", [
    np.array([1, 2]), 5, [1, 2], {"time": 3}, [None], np.array(["s", 2.5], object),
], ids=str)  # fmt: skip
def test_units_and_columns_are_texts(tmp_path, given):
    path = tmp_path / "a.csv"
    path.write_text("t,E\n1,3\n2,2\n")
    with pytest.raises(vcor.UsageError, match="units: found .*, expected texts"):
        vcor.read_data(path, units=given)
    if not isinstance(given, dict):
        with pytest.raises(vcor.UsageError, match="columns: found .*, expected texts"):
            vcor.read_data(path, given)
    # columns have numbers, and arrays of texts are texts
    assert vcor.read_data(path, {"time": 2, "relaxation_modulus": 1}).time.tolist() == [3, 2]
    assert vcor.read_data(path, units=np.array(["ms", "kPa"])).time.tolist() == [1e-3, 2e-3]


def test_no_files_are_no_master_curve():
    with pytest.raises(vcor.UsageError, match="expected at least one file of data"):
        vcor.master([])


@pytest.mark.parametrize("height", [2.54, 10.0])
def test_no_warning_is_of_a_height_that_no_one_gave(height):
    case = vcor.Case(DROP)
    case["impact.drop_height"] = height
    found = case.solve()
    data = {"drop_height": [height, height / 2], "cor": [found["cor"], found["cor"]]}
    with warnings.catch_warnings():
        warnings.simplefilter("error", vcor.UnitWarning)
        assert vcor.identify(case, data, ["soft.exponent"]).advice
