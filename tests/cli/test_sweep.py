"""Sweeps: what is refused, what comes out, and what happens to points without a result."""

import math
import os
import subprocess
import sys

import h5py
import numpy
import pytest
from cases import MODELS, SLS, case_text, edit, without
from program import ALL, INPUT, NAMES, NUMERICAL, ROOT, SUCCESS, SWEEPS, USAGE, WHOLE, program


def sweep(parameter, *lines):
    """A &sweep group, a line for the parameter and each key."""
    return "\n".join(["&sweep", f"   parameter = {parameter!r}", *lines, "/", ""])


VELOCITIES = sweep("impact.velocity", "values = 2.0, 5.0, 10.0")
RATES = sweep("rubber.beta", "start = 600", "stop = 1200", "count = 2")


def rows(vcor, *names, file="case.nml", words=()):
    """What --print says, a list of words per point."""
    done = vcor("run", file, "--print", ",".join(names), *words)
    assert done.code in {SUCCESS, NUMERICAL}
    return [line.split() for line in done.out.splitlines()]


def summary(vcor, name="case_summary.csv"):
    lines = (vcor.folder / name).read_text().splitlines()
    lines = [line.split(",") for line in lines if not line.startswith("#")]
    return [dict(zip(lines[0], line, strict=True)) for line in lines[1:]]


# What is refused, with the line it is about (from the &sweep on) and words of the message


def line_of(text, line):
    return [found.strip() for found in text.splitlines()].index(line) + 1


REFUSED = {
    "text": (["parameter = 'sphere.material'", "values = 1"], 1, ["a text", "real number"]),
    "choice": (["parameter = 'solver.method'", "values = 1"], 1, ["a text"]),
    "switch": (
        ["parameter = 'solver.continue_after_separation'", "values = 1"],
        1,
        ["a switch", "real number"],
    ),
    "whole number": (["parameter = 'solver.volterra_order'", "values = 1"], 1, ["whole number"]),
    "output": (["parameter = 'output.csv'", "values = 1"], 1, ["output"]),
    "itself": (["parameter = 'sweep.start'", "values = 1"], 1, ["sweep"]),
    "unknown key": (["parameter = 'rubber.betta'", "values = 1"], 1, ["did you mean 'beta'"]),
    "unknown group": (["parameter = 'impac.velocity'", "values = 1"], 1, ["'impact'"]),
    "unknown material": (["parameter = 'ruber.beta'", "values = 1"], 1, ["'rubber'"]),
    "no path": (["parameter = 'velocity'", "values = 1"], 1, ["group.key"]),
    "empty path": (["parameter = ''", "values = 1"], 1, ["empty"]),
    "other model": (["parameter = 'rubber.modulus'", "values = 1"], 1, ["model 'sls'", "beta"]),
    "no parameter": (["values = 1"], 0, ["'parameter' is missing"]),
    "no values": (["parameter = 'impact.velocity'"], 0, ["values, or start, stop and count"]),
    "both": (["parameter = 'impact.velocity'", "values = 1", "start = 1"], 3, ["both"]),
    "both, count": (["parameter = 'impact.velocity'", "count = 1", "values = 1"], 2, ["both"]),
    "value twice": (["parameter = 'impact.velocity'", "values = 3, 1, 2, 1.0"], 2, ["1.0", "twice"]),
    "a million times": (
        ["parameter = 'impact.velocity'", "values = 1000000*1.0"],
        2,
        ["1.0", "twice"],
    ),
    "ends that are one": (
        ["parameter = 'impact.velocity'", "start = 2", "stop = 2", "count = 3"],
        4,
        ["2.0", "twice"],
    ),
    "log of values": (
        ["parameter = 'impact.velocity'", "values = 1, 2", "spacing = 'log'"],
        3,
        ["'log'", "values"],
    ),
    "no stop": (
        ["parameter = 'impact.velocity'", "start = 1", "count = 3"],
        0,
        ["'stop' is missing"],
    ),
    "no points": (
        ["parameter = 'impact.velocity'", "start = 1", "stop = 2", "count = 0"],
        4,
        ["found 0", "in [1, 100000000]"],
    ),
    "half a count": (
        ["parameter = 'impact.velocity'", "start = 1", "stop = 2", "count = 2.5"],
        4,
        ["whole number"],
    ),
    "too many": (
        ["parameter = 'impact.velocity'", "start = 1", "stop = 2", "count = 200000000"],
        4,
        ["found 200000000", "in [1, 100000000]"],
    ),
    "beyond all whole numbers": (
        ["parameter = 'impact.velocity'", "start = 1", "stop = 2", "count = 20000000000"],
        4,
        ["found '20000000000'", "in [1, 100000000]"],
    ),
    "too many of two": (
        ["parameter = 'impact.velocity', values = 1, 2 / &sweep", "parameter = 'sphere.radius'",
         "start = 1", "stop = 2", "count = 60000000"],
        2,
        ["points", "at most 100000000"],
    ),
    "spacing": (
        ["parameter = 'impact.velocity'", "start = 1", "stop = 2", "count = 2", "spacing = 'lin'"],
        5,
        ["'lin'", "linear, log"],
    ),
    "log of zero": (
        ["parameter = 'impact.velocity'", "start = 0", "stop = 2", "count=2", "spacing = 'log'"],
        2,
        ["found start = 0.0", "> 0"],
    ),
    "log to below zero": (
        ["parameter = 'impact.velocity'", "start = 1", "stop = -2", "count=2", "spacing = 'log'"],
        3,
        ["found stop = -2.0", "> 0"],
    ),
    "nan": (["parameter = 'impact.velocity'", "values = 1, NaN"], 2, ["values"]),
    "inf": (
        ["parameter = 'impact.velocity'", "start = 1", "stop = Inf", "count = 2"],
        3,
        ["stop"],
    ),
    "overflow": (["parameter = 'impact.velocity'", "values = 1e400"], 2, ["values"]),
    "empty list": (["parameter = 'impact.velocity'", "values ="], 2, ["values"]),
    "texts": (["parameter = 'impact.velocity'", "values = 'a'"], 2, ["text in quotes"]),
    "word too long": (
        ["parameter = 'impact.velocity'", "start = 1, stop = 2, count = 2, spacing = 'logarithmic'"],
        2, ["'logarithmic'", "did you mean 'log'?"],
    ),
    "unknown word": (["parameter = 'impact.velocity'", "step = 1"], 2, ["'step'", "did you mean"]),
}


@pytest.mark.parametrize("command", ["run", "check"])
@pytest.mark.parametrize("way", REFUSED)
def test_refused(vcor, way, command):
    lines, at, says = REFUSED[way]
    vcor.write(SLS + "\n".join(["&sweep", *lines, "/", ""]))
    line = SLS.count("\n") + 1 + at
    vcor.refuses(command, "case.nml", code=INPUT, at=f"case.nml:{line}", says=says)


@pytest.mark.parametrize("path", ["rubber.moduli", "rubber.rates", "rubber.moduli(4)"])
def test_lists_are_refused(vcor, path):
    text = case_text("prony")
    vcor.write(text + sweep(path, "values = 1e6"))
    line = text.count("\n") + 2
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says="list")


def test_number_of_a_list(vcor):
    """A point is the case with that number of the list."""
    text = case_text("prony")
    vcor.write(text + sweep("rubber.moduli(2)", "values = 10e6, 40e6"))
    words = ["run", "case.nml", "--print", "rubber.moduli(2),cor"]
    rows = [line.split() for line in vcor.succeeds(*words).splitlines()]
    vcor.write(text, "single.nml")
    for modulus, cor in rows:
        words = ["--print", "cor", "--set", f"rubber.moduli(2)={modulus}"]
        assert vcor.succeeds("run", "single.nml", *words).strip() == cor
    assert rows[0][1] != rows[1][1]
    vcor.succeeds("run", "case.nml")
    with h5py.File(vcor.folder / "case.h5") as file:
        assert list(file["summary/rubber.moduli(2)"]) == [10e6, 40e6]


@pytest.mark.parametrize("path", ["impact.velocity", "IMPACT.Velocity", " impact.velocity "])
def test_twice_is_refused(vcor, path):
    vcor.write(SLS + VELOCITIES + sweep(path, "values = 1"))
    first = SLS.count("\n") + 2
    line = first + VELOCITIES.count("\n")
    vcor.refuses(
        "run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=["twice", f"case.nml:{first}"]
    )


def test_names_that_are_the_same_in_hdf5(vcor):
    """A slash would denote a group there."""
    text = SLS.replace("'steel'", "'pu/tpu'").replace("'rubber'", "'PU tpu'")
    groups = [sweep(f"{name}.density", "values = 900, 1000") for name in ("pu/tpu", "pu_tpu")]
    vcor.write(text + "".join(groups))
    line = (text + groups[0]).count("\n") + 2
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=["HDF5", "same name"])


def test_too_many_points_in_all(vcor):
    long = "start = 1\n stop = 2\n count = 20000"
    vcor.write(SLS + sweep("impact.velocity", long) + sweep("sphere.radius", long))
    vcor.refuses("run", "case.nml", code=INPUT, says=["4.0e8 points"])


def test_no_more_groups_than_dimensions(vcor):
    """HDF5 has 32 dimensions at most, and each parameter is one."""
    terms = 16
    text = case_text("sls").replace("&sphere", "&sphere mass = 0.03,")
    text += "".join(
        f"&material name = 'm{i}', model = 'elastic', modulus = 1e6, poisson_ratio = 0.5 /\n"
        for i in range(terms)
    )
    keys = [f"m{i}.{key}" for i in range(terms) for key in ("modulus", "poisson_ratio")]
    groups = [sweep(key, "values = 0.5") for key in ["impact.velocity", *keys]]
    vcor.write(text + "".join(groups))
    line = (text + "".join(groups[:32])).count("\n") + 2
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says=["33", "32", "HDF5"])


def test_verify_is_for_single_impacts(vcor):
    vcor.write(SLS + VELOCITIES)
    line = SLS.count("\n") + 2
    vcor.refuses("verify", "case.nml", code=INPUT, at=f"case.nml:{line}", says="single")


# What comes out


def test_grid_order(vcor):
    """The first group varies slowest, and a point is the impact by itself, to the last bit."""
    vcor.write(SLS + VELOCITIES + RATES)
    vcor.write(SLS, "one.nml")
    found = rows(vcor, "impact.velocity", "rubber.beta", *NAMES)
    points = [(v, b) for v in (2.0, 5.0, 10.0) for b in (600.0, 1200.0)]
    assert [(float(row[0]), float(row[1])) for row in found] == points
    for (velocity, beta), row in zip(points, found, strict=True):
        words = ["--set", f"impact.velocity={velocity}", "--set", f"rubber.beta={beta}"]
        assert dict(zip(NAMES, row[2:], strict=True)) == vcor.numbers("one.nml", *words)


def test_csv(vcor):
    vcor.write(SLS + VELOCITIES + RATES)
    out = vcor.succeeds("run", "case.nml")
    table = summary(vcor)
    assert list(table[0]) == ["impact.velocity", "rubber.beta", *NAMES]
    assert len(table) == 6
    assert [list(row.values()) for row in table] == rows(
        vcor, "impact.velocity", "rubber.beta", *NAMES
    )
    text = (vcor.folder / "case_summary.csv").read_text()
    assert "#   impact.velocity [m/s] " in text and "#   rubber.beta [1/s] " in text
    assert "# &sweep" in text
    assert {path.name for path in vcor.folder.iterdir()} == {
        "case.nml",
        "case_summary.csv",
        "case.h5",
    }
    assert out.count("time histories") == 1
    for word in ("impact.velocity", "3 values", "6 impacts", "case_summary.csv", "case.h5"):
        assert word in out


def test_no_word_of_histories_nobody_asked_for(vcor):
    text, _ = edit(SLS, "output", "history", ".false.")
    vcor.write(text + VELOCITIES)
    assert "histories" not in vcor.succeeds("run", "case.nml")


KEYS = [
    ("impact.velocity", "2.0, 20.0"),
    ("sphere.radius", "0.005, 0.02"),
    ("sphere.mass", "0.01, 0.1"),
    ("plate.half_thickness", "0.01, 0.03"),
    ("plate.surface_radius", "-0.1, 0.0, 0.5"),
    ("steel.density", "2000, 7800"),
    ("rubber.density", "900, 1300"),
    ("rubber.poisson_ratio", "0.3, 0.5"),
    ("rubber.glassy_modulus", "5e6, 50e6"),
    ("rubber.alpha", "100, 600"),
    ("solver.accuracy", "1e-6, 1e-9, 1e-7"),
    ("solver.end_time", "1.0, 2.0"),
]


@pytest.mark.parametrize("path, values", KEYS)
def test_every_key(vcor, path, values):
    check_key(vcor, SLS, path, values)


@pytest.mark.parametrize(
    "model, path, values",
    [
        ("elastic", "rubber.modulus", "1e6, 1e7"),
        ("prony", "rubber.viscosity", "0.0, 100.0"),
        ("prony", "rubber.equilibrium_modulus", "0.0, 1e7"),
        ("power_law", "rubber.coefficient", "0.5e6, 1e6"),
        ("power_law", "rubber.exponent", "0.3, 0.6"),
        ("cerf", "rubber.beta", "500.0, 700.0"),
        ("cerf", "rubber.relaxing_modulus", "1e8, 6e8"),
        ("mittag_leffler", "rubber.time", "1e-5, 1e-4"),
        ("mittag_leffler", "rubber.exponent", "0.4, 1.0"),
    ],
)
def test_every_key_of_a_model(vcor, model, path, values):
    check_key(vcor, case_text(model), path, values)


def check_key(vcor, text, path, values):
    vcor.write(text + sweep(path, f"values = {values}"))
    vcor.write(text, "one.nml")
    for value, row in zip(values.split(","), rows(vcor, *NAMES), strict=True):
        numbers = vcor.numbers("one.nml", "--set", f"{path}={value.strip()}")
        assert dict(zip(NAMES, row, strict=True)) == numbers


@pytest.mark.parametrize("key, value", [("time_step", "1e-6, 2e-6"), ("accuracy", "1e-4, 1e-5")])
def test_settings_of_direct(vcor, key, value):
    text, _ = edit(SLS, "solver", "method", "'direct'")
    check_key(vcor, text, f"solver.{key}", value)


def test_second_coefficient(vcor):
    text, _ = edit(SLS, "solver", "volterra_order", "2")
    check_key(vcor, text, "solver.volterra_coefficient", "0.0, 1.0")


@pytest.mark.parametrize("name", ["sls rubber", "'sls rubber'", "sls_rubber", "SLS Rubber"])
def test_names_of_materials(vcor, name):
    vcor.write(SLS.replace("'rubber'", "'SLS rubber'") + sweep(f"{name}.beta", "values = 600, 900"))
    vcor.succeeds("run", "case.nml")
    assert "sls_rubber.beta" in summary(vcor)[0]


def test_one_material_of_both_bodies(vcor):
    text, _ = edit(SLS, "sphere", "material", "'rubber'")
    check_key(vcor, text, "rubber.beta", "600, 1200")
    check_key(vcor, text, "rubber.density", "600, 1200")


@pytest.mark.usefixtures("data_files")
def test_material_of_data(vcor):
    """Points of data are fitted once, whatever the density."""
    text = (ROOT / "examples" / "steel_on_measured_rubber.nml").read_text()
    name = [line.split("'")[1] for line in text.splitlines() if "name" in line][-1]
    for key in ("density", "poisson_ratio"):
        check_key(vcor, text, f"{name}.{key}", "0.3, 0.4" if "ratio" in key else "900, 1300")


def test_what_is_swept_need_not_be_given(vcor):
    text, _ = without(SLS, "velocity = 10.0")
    vcor.write(text)
    vcor.refuses("run", "case.nml", code=INPUT, says="'velocity' is missing")
    vcor.write(text + VELOCITIES)
    assert len(rows(vcor, "cor")) == 3
    vcor.write(without(SLS, "beta = 1200.0")[0] + sweep("rubber.beta", "values = 100, 600"))
    assert [row[0] for row in rows(vcor, "status")] == ["invalid", "separated"]


def test_spacing(vcor):
    for lines, values in [
        (("start = 1", "stop = 50", "count = 50"), range(1, 51)),
        (("start = 1e-3", "stop = 1e3", "count = 7", "spacing = 'log'"), numpy.logspace(-3, 3, 7)),
        (("start = 3", "stop = 1", "count = 3"), [3, 2, 1]),
        (("start = 3", "stop = 1", "count = 1"), [3]),
        (("values = 3, 1, 2", "spacing = 'linear'"), [3, 1, 2]),
    ]:
        vcor.write(SLS + sweep("impact.velocity", *lines))
        found = [float(row[0]) for row in rows(vcor, "impact.velocity")]
        assert found == pytest.approx(list(values), rel=1e-15)
        assert found[0] == list(values)[0]


def test_set_can_change_a_sweep(vcor):
    vcor.write(SLS + VELOCITIES)
    assert len(rows(vcor, "cor", words=["--set", "sweep.values=1,2,3,4"])) == 4
    vcor.write(SLS + VELOCITIES + RATES)
    vcor.refuses(
        "run", "case.nml", "--set", "sweep.count=3", code=USAGE, says=["2 &sweep groups", "one"]
    )


def test_several_cases(vcor):
    vcor.write(SLS + VELOCITIES, "a.nml")
    vcor.write(SLS, "b.nml")
    out = vcor.succeeds("run", "a.nml", "b.nml", "--print", "cor", "--output", "out")
    assert out.count("\n") == 4
    assert {path.name for path in (vcor.folder / "out").iterdir()} == {
        "a_summary.csv",
        "a.h5",
        "b_summary.csv",
        "b.csv",
        "b.h5",
    }


# --print


def test_print_names_a_swept_parameter_only(vcor):
    vcor.write(SLS + VELOCITIES)
    words = ["run", "case.nml", "--print", "rubber.beta,cor"]
    vcor.refuses(*words, code=USAGE, says=["'rubber.beta'"])
    words = ["run", "case.nml", "--print", "impact.velocty"]
    vcor.refuses(*words, code=USAGE, says=["'impact.velocity'"])


def test_print_of_many_points(vcor):
    """Longer than the buffer."""
    text, _ = edit(SLS, "solver", "accuracy", "1e-2")
    vcor.write(text + sweep("impact.velocity", "start = 1", "stop = 2", "count = 1001"))
    found = rows(vcor, *NAMES)
    assert len(found) == 1001
    assert {len(row) for row in found} == {len(NAMES)}
    assert {row[-1] for row in found} == {"separated"}


# Points without a result


def test_points_out_of_range(vcor):
    vcor.write(
        SLS + sweep("sphere.radius", "start=-0.01", "stop=0.02", "count=4") + sweep(
            "rubber.alpha", "values = 300, 1500"
        )
    )
    done = vcor("run", "case.nml")
    assert done.code == NUMERICAL
    assert done.err.count("\n") == 1
    assert done.err.startswith("vcor: error: case.nml: 6 of 8 points")
    assert "sphere.radius = -0.01, rubber.alpha = 300.0: " in done.err
    assert "sphere.radius is out of range, expected a number > 0 [m]" in done.err
    table = summary(vcor)
    statuses = [row["status"] for row in table]
    assert statuses == ["invalid"] * 5 + ["separated", "invalid", "separated"] or statuses == [
        "invalid"
    ] * 4 + ["separated", "invalid"] * 2
    for row in table:
        bad = row["status"] == "invalid"
        assert (row["steps"] == "0") == bad
        # not dropped, and ive states no such errors
        absent = {"rebound_height", "bouncing_time_error"}
        absent |= {"contact_time_error", "max_force_error"}
        absent |= {"layer_ratio", "layer_stiffening", "layer_strain", "axis_tension", "highest_mode"}
        absent |= {"block_reach"}
        for name in set(NAMES) - WHOLE - absent:
            assert math.isnan(float(row[name])) == bad, name
    # grouped by status, with the first point of each and its message
    first = "first at point 1, sphere.radius = -0.01, rubber.alpha = 300.0:"
    assert f"       6  invalid, {first}\n            sphere.radius is out of range, exp" in done.out
    with h5py.File(vcor.folder / "case.h5") as file:
        status = file["summary/status"].asstr()[:]
        assert status.shape == (4, 2)
        assert list(status.flat) == statuses
        assert (numpy.isnan(file["summary/cor"][:]) == (status == "invalid")).all()


def test_all_points_out_of_range(vcor):
    vcor.write(SLS + sweep("impact.velocity", "values = -1, 0"))
    done = vcor("run", "case.nml")
    assert done.code == NUMERICAL
    assert [row["status"] for row in summary(vcor)] == ["invalid", "invalid"]


def test_quiet_failure(vcor):
    vcor.write(SLS + sweep("impact.velocity", "values = -1, 1"))
    done = vcor("run", "case.nml", "--quiet")
    assert (done.code, done.out) == (NUMERICAL, "")
    assert done.err.count("\n") == 1


def test_no_separation(vcor):
    text, _ = edit(SLS, "solver", "end_time", "1.4e-3")
    vcor.write(text + sweep("impact.velocity", "values = 1, 10"))
    found = rows(vcor, "status", "cor", "initial_energy")
    assert [row[0] for row in found] == ["no_separation", "separated"]
    assert found[0][1] == "nan" and float(found[0][2]) > 0


def test_sticking_and_failing(vcor):
    """Each in its way, with the others done."""
    text, _ = edit(SLS, "material", "alpha", "0.0")
    text, _ = edit(text, "plate", "waves", "'none'")
    vcor.write(text + sweep("rubber.beta", "values = 1e6, 100"))
    assert [row[0] for row in rows(vcor, "status")] == ["sticks", "separated"]
    text, _ = edit(SLS, "solver", "scheme", "'adams_bashforth'")
    vcor.write(text + sweep("solver.time_step", "values = 1e-6, 1e-3, 2e-3, 2e-6"))
    done = vcor("run", "case.nml")
    assert done.code == NUMERICAL
    assert [row["status"] for row in summary(vcor)] == ["separated", "failed", "failed", "separated"]
    assert "       2  failed, first at point 2, solver.time_step = 0.001:\n" in done.out
    assert "            solver.time_step is 1.00E-03 s, too long" in done.out


def test_step_beyond_the_end(vcor):
    text, _ = edit(SLS, "solver", "end_time", "0.1")
    text, _ = edit(text, "solver", "method", "'direct'")
    vcor.write(text + sweep("solver.time_step", "values = 1e-5, 0.2"))
    assert [row[0] for row in rows(vcor, "status")] == ["separated", "invalid"]


def test_faults_of_the_case_are_found_before(vcor):
    """What no point can mend stops the run."""
    text, line = edit(SLS, "material", "poisson_ratio", "0.7")
    vcor.write(text + VELOCITIES)
    vcor.refuses("run", "case.nml", code=INPUT, at=f"case.nml:{line}", says="0.7")


def test_others_are_done_when_a_sweep_fails(vcor):
    vcor.write(SLS + sweep("impact.velocity", "values = -1, 1"), "a.nml")
    vcor.write(SLS, "b.nml")
    done = vcor("run", "a.nml", "b.nml", "--print", "status")
    assert done.code == NUMERICAL
    assert done.out.split() == ["invalid", "separated", "separated"]


# Threads


GRID = (
    sweep("impact.velocity", "start = -1", "stop = 20", "count = 22")
    + sweep("rubber.alpha", "values = 100, 300, 1500")
    + sweep("solver.accuracy", "values = 1e-4, 1e-8")
)


@pytest.mark.parametrize("model", ["sls", "cerf"])
def test_same_bits_for_any_number_of_threads(vcor, model):
    grid = GRID if model == "sls" else GRID.replace("rubber.alpha", "rubber.beta")
    vcor.write(case_text(model) + grid)
    files = []
    screens = set()
    for threads in (1, 2, 4, 7):
        done = vcor("run", "case.nml", "--threads", threads)
        assert done.code == NUMERICAL
        screens.add((done.out, done.err))
        files.append(
            [(vcor.folder / name).read_bytes() for name in ("case_summary.csv", "case.h5")]
        )
    assert all(other == files[0] for other in files)
    assert len(screens) == 1


def test_more_threads_than_points(vcor):
    vcor.write(SLS + VELOCITIES)
    assert rows(vcor, ALL, words=["--threads", "64"]) == rows(vcor, ALL, words=["--threads=1"])
    vcor.write(SLS)
    assert len(rows(vcor, "cor", words=["--threads", "4"])) == 1


@pytest.mark.parametrize("value", ["0", "-1", "1.5", "x", "1e3", "99999", "12345678901234567890"])
def test_number_of_threads(vcor, value):
    vcor.write(SLS)
    vcor.refuses(
        "run", "case.nml", f"--threads={value}", code=USAGE, says=["--threads", f"'{value}'"]
    )


# check


def test_check(vcor):
    vcor.write(SLS + VELOCITIES + RATES)
    out = vcor.succeeds("check", "case.nml")
    assert out.count("&sweep") == 2
    assert "! points: 6" in out
    for line in ("parameter = 'impact.velocity'", "values = 2.0, 5.0, 10.0", "count = 2"):
        assert line in out
    assert out.count("spacing = 'linear'") == 2
    vcor.write(out, "checked.nml")
    assert rows(vcor, ALL, file="checked.nml") == rows(vcor, ALL)


def test_check_of_a_case_that_only_its_sweep_completes(vcor):
    text, _ = without(SLS, "velocity = 10.0")
    vcor.write(text + VELOCITIES)
    assert "! points: 3" in vcor.succeeds("check", "case.nml")


# The examples


@pytest.mark.parametrize("path", SWEEPS, ids=lambda path: path.stem)
def test_examples(vcor, path):
    vcor.succeeds("run", path)
    assert {row["status"] for row in summary(vcor, f"{path.stem}_summary.csv")} == {"separated"}
    assert (vcor.folder / f"{path.stem}.h5").exists()


def script(vcor, *words):
    """Run a script that finds the program in the PATH; what it prints."""
    (vcor.folder / "bin").mkdir()
    (vcor.folder / "bin" / "vcor").symlink_to(program())
    path = f"{vcor.folder / 'bin'}:{os.environ['PATH']}"
    return subprocess.run(
        words,
        cwd=vcor.folder,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
        check=True,
        timeout=600,
    ).stdout


def test_shell_script(vcor):
    lines = script(vcor, "sh", ROOT / "examples" / "sweeps" / "fig4.sh").splitlines()
    assert len(lines) == 200
    table = numpy.array([line.split() for line in lines], dtype=float)
    assert sorted(set(table[:, 0])) == [600, 1200, 2400, 4800]
    found = table[(table[:, 0] == 1200) & (table[:, 1] == 10)]
    assert found[0, 2] == pytest.approx(0.4319869, abs=1e-7)


def test_python_script(vcor):
    out = script(vcor, sys.executable, ROOT / "examples" / "sweeps" / "fig8.py", "work")
    row = [line.split() for line in out.splitlines() if line.startswith("10.0 ")][0]
    for model, cor in zip(("prony", "cerf", "power_law"), row[1:], strict=True):
        path = ROOT / "examples" / "paper" / f"butyl_{model}.nml"
        assert float(cor) == pytest.approx(float(vcor.numbers(path)["cor"]), abs=2e-6)


def test_models_are_all_there():
    """The tests above have a key of each."""
    assert set(MODELS) >= {"elastic", "sls", "prony", "power_law", "cerf", "mittag_leffler"}
