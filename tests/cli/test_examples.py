"""The examples, and the namelists that f90nml makes of them."""

import csv
import functools
import re

import f90nml
import pytest
from cases import SLS, case_text
from program import EXAMPLES, KINDS, NUMERICAL, ONE_OF_EACH, PAPER, Vcor

# Examples with the paper's scheme are there to show its error
CONVERGED = {path for path in EXAMPLES if "adams_bashforth" not in path.read_text()}
pytestmark = pytest.mark.usefixtures("data_files")
EACH = pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
# These are solved once more, to the same numbers. All examples run, and are checked in all forms
SOME = pytest.mark.parametrize("path", ONE_OF_EACH, ids=lambda path: path.stem)


@functools.cache
def numbers_of(path):
    """All numbers of an example, which is solved once for all tests."""
    return Vcor(path.parent).numbers(path)


def checked(vcor, *names):
    """What check prints of cases, each value to its last bit, but for the name of their files."""
    out = vcor.succeeds("check", *names)
    return re.sub(r" *stem = .*the name of the case file.*\n", "", out)


@EACH
def test_runs(vcor, path):
    out = vcor.succeeds("run", path, "--output", "out")
    stem = path.stem
    files = {found.name for found in (vcor.folder / "out").iterdir()}
    bounces = {f"{stem}_bounces.csv"} if "bounces" in path.read_text().partition("&impact")[2] else set()
    assert files == {f"{stem}_summary.csv", f"{stem}.csv", f"{stem}.h5"} | bounces
    assert out.isascii() and "\t" not in out
    assert not any(line.endswith(" ") for line in out.splitlines())
    lines = (vcor.folder / "out" / f"{stem}_summary.csv").read_text().splitlines()
    (numbers,) = csv.DictReader(line for line in lines if not line.startswith("#"))
    assert numbers["status"] == "separated"
    assert 0 < float(numbers["cor"]) < 1
    if path not in CONVERGED:
        return
    # points of data are met by a sum of exponentials to some digits only
    # exact mechanics have waves, to 1e-5
    text = path.read_text()
    limit = 5e-5 if "'table'" in text else 1e-5 if "'exact'" in text else 1e-6
    assert float(numbers["cor_error"]) <= limit
    energy = float(numbers["initial_energy"])
    assert abs(float(numbers["energy_imbalance"])) <= 1e-6 * energy


def test_the_kinds_are_there():
    assert {path.stem for path in EXAMPLES} >= set(KINDS)


def test_all_in_one_call(vcor):
    out = vcor.succeeds("run", *ONE_OF_EACH, "--print", "cor").splitlines()
    assert out == [numbers_of(path)["cor"] for path in ONE_OF_EACH]


@EACH
def test_f90nml_reads_them(path):
    groups = f90nml.read(path)
    assert groups["impact"].get("velocity", groups["impact"].get("drop_height")) > 0
    assert len(groups["material"]) in {1, 2, 3} or isinstance(groups["material"], dict)


def as_f90nml_writes(vcor, source, name, **form):
    groups = f90nml.read(source)
    for key, value in form.items():
        setattr(groups, key, value)
    groups.write(vcor.folder / name, force=True)
    return name


FORMS = {
    "plain": {},
    "upper": {"uppercase": True},
    "narrow": {"column_width": 30},
    "end_comma": {"end_comma": True},
    "float": {"float_format": ".17e"},
    "logical": {"logical_repr": ("F", "T")},
    "indent": {"indent": "\t"},
    "index": {"default_start_index": 1},
}


@EACH
def test_f90nml_round_trip(vcor, path):
    """What f90nml makes of a case is the same case in all forms, bit for bit, and runs to the same
    numbers."""
    names = [as_f90nml_writes(vcor, path, f"{form}.nml", **FORMS[form]) for form in FORMS]
    assert checked(vcor, *names) == len(FORMS) * checked(vcor, path)
    if path in ONE_OF_EACH:
        assert vcor.numbers(names[0]) == numbers_of(path)


@SOME
def test_f90nml_reads_what_check_prints(vcor, path):
    vcor.write(vcor.succeeds("check", path), "checked.nml")
    name = as_f90nml_writes(vcor, vcor.folder / "checked.nml", "written.nml")
    assert vcor.numbers(name) == numbers_of(path)


@SOME
def test_f90nml_reads_the_case_in_the_results(vcor, path):
    """The remarks at the top of a CSV file hold the case as it was run."""
    vcor.succeeds("run", path, "--quiet")
    lines = (vcor.folder / f"{path.stem}_summary.csv").read_text().splitlines()
    start = lines.index("# case:") + 1
    text = "\n".join(line[2:] for line in lines[start:] if line.startswith("#"))
    vcor.write(text + "\n", "again.nml")
    assert vcor.numbers("again.nml") == numbers_of(path)
    name = as_f90nml_writes(vcor, vcor.folder / "again.nml", "written.nml")
    assert checked(vcor, name) == checked(vcor, "again.nml")


def test_f90nml_repeats(vcor):
    """Equal neighbours become a repeat count."""
    text = case_text("prony").replace("20.181e6, 38.204e6, 87.344e6", "2.0e6, 2.0e6, 2.0e6")
    vcor.write(text)
    groups = f90nml.read(vcor.folder / "case.nml")
    groups.repeat_counter = True
    groups.write(vcor.folder / "written.nml")
    assert "3*2" in (vcor.folder / "written.nml").read_text()
    assert vcor.numbers("written.nml") == vcor.numbers("case.nml")


def test_f90nml_patch(vcor):
    vcor.write(SLS)
    groups = {"impact": {"velocity": 3.5}}
    f90nml.patch(vcor.folder / "case.nml", groups, vcor.folder / "written.nml")
    setting = ["--set", "impact.velocity=3.5"]
    assert vcor.numbers("written.nml") == vcor.numbers("case.nml", *setting)


@pytest.mark.parametrize("title", ["It's", 'say "a"', "both ' and \"", "a, b / c ! d", "&end", "α"])
def test_f90nml_titles(vcor, title):
    vcor.write(SLS)
    groups = f90nml.read(vcor.folder / "case.nml")
    groups["case"]["title"] = title
    groups.write(vcor.folder / "written.nml")
    assert title in vcor.succeeds("run", "written.nml")
    groups = f90nml.reads(vcor.succeeds("check", "written.nml"))
    assert groups["case"]["title"] == title


ONE_CASE = {
    "upper case": SLS.upper(),
    "&end": SLS.replace("\n/", "\n&end"),
    "&END": SLS.replace("\n/", "\n&END"),
    "double quotes": SLS.replace("'", '"'),
    "commas": SLS.replace("\n/", ",\n/")
    .replace("&solver,", "&solver")
    .replace("&output,", "&output"),
    "one line each": SLS.replace("\n   ", " ").replace("\n/", " /"),
    "blanks": SLS.replace(" = ", "   =\n      "),
    "no blanks": SLS.replace(" = ", "="),
    "tabs": SLS.replace("   ", "\t").replace(" = ", "\t=\t"),
    "remarks": SLS.replace("\n", " ! a 'remark' / & \"\n").replace("\n&", "\n! &x y = 1 /\n\n&"),
    "D exponents": SLS.replace("15.0e6", "1.5D+07").replace("10.0", "1D1"),
    "repeat counts": SLS.replace("= 0.5", "= 1*0.5").replace("= 10.0", "= 1*10.0"),
    "order": SLS[SLS.index("&material") :] + SLS[: SLS.index("&material")],
    "name last": SLS.replace("   name = 'rubber'\n", "")[:-2] + "   name = 'rubber'\n/\n",
}


@pytest.mark.parametrize("form", ONE_CASE)
def test_forms_of_one_case(vcor, form):
    """One case, written in all the ways that Fortran allows."""
    vcor.write(SLS)
    vcor.write(ONE_CASE[form], "other.nml")
    assert vcor.numbers("other.nml") == vcor.numbers("case.nml")


LISTS = {
    "lines": "20.181e6,\n  38.204e6,\n  87.344e6",
    "blanks": "20.181e6  38.204e6  87.344e6",
    "end comma": "20.181e6, 38.204e6, 87.344e6,",
    "remarks": "20.181e6, ! first\n  38.204e6, ! second\n  87.344e6",
}
PLAIN = "moduli = 20.181e6, 38.204e6, 87.344e6"


@pytest.mark.parametrize("form", LISTS)
def test_forms_of_a_list(vcor, form):
    text = case_text("prony")
    vcor.write(text)
    vcor.write(text.replace(PLAIN, f"moduli = {LISTS[form]}"), "other.nml")
    assert PLAIN in text
    assert vcor.numbers("other.nml") == vcor.numbers("case.nml")


def test_f90nml_reads_a_failed_case(vcor):
    """A summary without numbers still holds its case."""
    vcor.write(SLS)
    done = vcor("run", "case.nml", "--set", "solver.end_time=1e-3")
    assert done.code == NUMERICAL
    lines = (vcor.folder / "case.csv").read_text().splitlines()
    start = lines.index("# case:") + 1
    text = "\n".join(line[2:] for line in lines[start:] if line.startswith("#"))
    assert f90nml.reads(text)["solver"]["end_time"] == 1e-3


def test_rounding_is_shown_as_zero(vcor):
    """An elastic body has no indentation left, and loses nothing in the contact."""
    screen = vcor.succeeds("run", str(PAPER / "elastic.nml"))
    for symbol, unit in {r"s\(t0\)": " m", "s0/smax": "", "W_h": " J"}.items():
        assert re.search(rf" {symbol} +0{unit}( |$)", screen, re.M), symbol
