"""Cases: the same bits as the program, its errors, threads, processes."""

import concurrent.futures
import contextlib
import csv
import functools
import multiprocessing
import os
import pickle
import random
import signal
import subprocess
import sys
import threading
import warnings
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from conftest import EVERYTHING, PAPER, ROOT, SWEEPS, long_tests

import vcor
from vcor import _coverage, _library
from vcor.case import as_case

SINGLE = ["sls", "butyl_cerf", "butyl_prony_ghost", "sls_printed",
          *long_tests("butyl_power_law", "elastic")]  # fmt: skip
GROUPS = {
    "case": {"title": "it's a ball"},
    "impact": {"velocity": 10.0},
    "sphere": {"radius": 0.01, "material": "steel"},
    "plate": {"half_thickness": 0.02, "material": "rubber"},
    "material": [
        {"name": "steel", "model": "rigid", "density": 7800.0},
        {
            "name": "rubber",
            "model": "prony",
            "density": 1200.0,
            "poisson_ratio": 0.4,
            "equilibrium_modulus": 1e6,
            "moduli": [1e6, np.float64(2e6)],
            "times": np.array([1e-3, 1e-4]),
        },
    ],
    "output": {"history": False},
}


def same(one, other):
    """Whether two datasets are the same bits."""
    assert set(one.variables) == set(other.variables)
    for name in one.variables:
        a, b = one[name], other[name]
        assert a.dims == b.dims, name
        assert a.attrs == b.attrs, name
        if a.dtype.kind == "f":
            assert np.array_equal(a.values, b.values, equal_nan=True), name
        else:
            assert (a.values == b.values).all(), name
    assert one.attrs["title"] == other.attrs["title"]
    return True


@pytest.mark.parametrize("name", SINGLE)
def test_a_single_impact(program, tmp_path, name):
    program("run", PAPER / f"{name}.nml", "--output", tmp_path, "--quiet")
    case = vcor.read(PAPER / f"{name}.nml")
    stem = case["output.stem"]
    found = case.run()
    assert same(found, vcor.open(tmp_path / f"{stem}.h5"))
    assert same(case.history(), vcor.open(tmp_path / f"{stem}.h5", "history"))
    attrs = dict(found.attrs)
    # solved for who looks at it: the screen and `run`, not a file
    assert attrs.pop("exact_cor_sphere", 0.0) >= 0.0
    assert attrs == vcor.open(tmp_path / f"{stem}.h5").attrs
    numbers = xr.Dataset({name: ((), value) for name, value in case.solve().items()})
    for name, value in found.items():
        assert np.array_equal(numbers[name], value, equal_nan=value.dtype.kind == "f"), name


@pytest.mark.parametrize("threads", [1, 2])
def test_a_sweep(program, tmp_path, threads):
    path = SWEEPS / "velocity_and_radius.nml"
    words = ["--set", "output.stem=cube", "--output", tmp_path, "--quiet"]
    program("run", path, *words)
    cube = vcor.read(path).run(threads=threads, progress=False)
    assert same(cube, vcor.open(tmp_path / "cube.h5"))
    assert cube.cor.dims == ("impact.velocity", "sphere.radius")
    assert cube["sphere.radius"].attrs["units"] == "m"


def test_exact_mechanics_beside_a_single_impact():
    """The dataset has the restitution of exact mechanics, its own where it has them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", vcor.ValidityWarning)
        case = vcor.read(PAPER / "sls.nml")
        exact = case.copy()
        exact["plate.waves"], exact["contact.law"] = "body", "receding"
        expected = exact.solve()["cor_sphere"]
        assert case.run().attrs["exact_cor_sphere"] == expected
        assert exact.run().attrs["exact_cor_sphere"] == expected
        assert "exact_cor_sphere" not in case.sweep({"impact.velocity": [1.0, 2.0]}).attrs


def test_every_column_is_that_of_the_csv_file(program, tmp_path):
    """run, sweep, points and solve give the same bits as the program, in every column."""
    path = SWEEPS / "velocity_and_radius.nml"
    settings = ["output.stem=cube", "output.hdf5=F"]
    words = [word for setting in settings for word in ("--set", setting)]
    program("run", path, *words, "--output", tmp_path, "--quiet")
    lines = (tmp_path / "cube_summary.csv").read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    case = vcor.read(path)
    cube = case.run(progress=False)
    axes = {name: cube[name].values for name in cube.dims}
    values = {name: [float(row[name]) for row in rows] for name in axes}
    points = case.points(values, progress=False)
    assert same(case.sweep(axes, progress=False), cube)
    assert set(rows[0]) == {*axes, *cube.data_vars} == {*axes, *points.data_vars}
    columns = {name: cube[name].values.ravel() for name in cube.data_vars}
    arrays = {name: one.values for name, one in points.items()}
    for i, row in enumerate(rows):
        some = [columns, arrays]
        if EVERYTHING or i % 7 == 0:
            one = case.solve({name: values[name][i] for name in axes})
            some.append({name: {i: value} for name, value in one.items()})
        for name, column in columns.items():
            shown = row[name] if column.dtype.kind == "U" else float(row[name])
            for value in (found[name][i] for found in some):
                assert value == shown or value != value and shown != shown, (name, i)


def test_points_and_sweeps_are_single_impacts(sls):
    velocities, betas = [2.5, 10.0], [600.0, 1200.0, 2400.0]
    values = {"impact.velocity": velocities, "rubber.beta": betas}
    cube = sls.sweep(values, ["cor", "max_force"])
    points = sls.points({"impact.velocity": 10.0, "rubber.beta": betas})
    assert cube.sizes == {"impact.velocity": 2, "rubber.beta": 3}
    for beta, point in zip(betas, points.cor.values, strict=True):
        case = sls.copy()
        case["rubber.beta"] = beta
        assert case["rubber.beta"] == beta
        one = case.solve()
        assert case.run().cor == point == one["cor"]
        assert sls.solve({"rubber.beta": beta}, ["cor"]) == {"cor": point}
        at = {"impact.velocity": 10.0, "rubber.beta": beta}
        assert cube.cor.sel(at) == point
        assert cube.max_force.sel(at) == one["max_force"]
    assert points["rubber.beta"].dims == ("point",)
    assert sls["rubber.beta"] == 1200.0


def test_numbers_that_are_set_in_a_loop(sls, program):
    """The quick way of solve gives what the case gives, texts and lists set in between too."""
    for beta, waves in [(600.0, "none"), (1200.0, "relaxing"), (2400.0, "constant")]:
        sls["rubber.beta"] = beta
        sls["plate.waves"] = waves
        sls["impact.velocity"] = 5
        words = [f"rubber.beta={beta}", f"plate.waves={waves}", "impact.velocity=5"]
        settings = [word for setting in words for word in ("--set", setting)]
        cor = program("run", PAPER / "sls.nml", *settings, "--print", "cor")
        assert sls.solve()["cor"] == float(cor) == sls.run().cor
    # what was set may be varied all the same
    assert sls.points({"rubber.beta": [2400.0]}).cor[0] == float(cor)


def test_two_names_of_one_address(sls):
    """The last one counts in solve as it does in run."""
    sls["impact.velocity"] = 1.0
    for name, value in [("IMPACT.VELOCITY", 2), ("Impact.velocity", 3.0), ("impact.velocity", 4)]:
        sls[name] = value
        assert sls.solve()["cor"] == sls.run().cor
    case = vcor.Case(GROUPS)
    case["rubber.moduli(2)"] = 5e6
    case["rubber.moduli"] = [1e6, 2e6]
    assert case.solve()["cor"] == case.run().cor == vcor.Case(GROUPS).run().cor


def test_a_height_in_place_of_a_velocity(sls):
    """The last one set counts, and one that varies before both."""
    sls["impact.drop_height"] = 0.5
    assert sls["impact.velocity"] is None
    cor = sls.solve()["cor"]
    sls["impact.velocity"] = np.sqrt(9.80665)
    assert sls["impact.drop_height"] is None
    assert sls.solve()["cor"] == cor
    assert sls.points({"impact.drop_height": [0.1, 0.5]}).cor[1] == cor


def test_a_value_that_is_not_read_is_refused(sls, program):
    sls["solver.form"] = "b"
    with pytest.raises(vcor.InputError) as caught:
        sls.solve()
    line = program("run", PAPER / "sls.nml", "--set", "solver.form=b", code=3)
    assert line == f"vcor: error: --set {caught.value}\n"


def test_a_case_from_a_mapping(tmp_path, program):
    case = vcor.Case(GROUPS)
    case.save(tmp_path / "c.nml")
    again = vcor.read(tmp_path / "c.nml")
    assert again["case.title"] == "it's a ball"
    assert again["rubber.moduli"] == [1e6, 2e6]
    assert again["rubber.moduli(2)"] == 2e6
    assert again["output.history"] is False
    assert again["solver.volterra_order"] == 1
    assert again["solver.time_step"] is None
    cor = float(program("run", "c.nml", "--print", "cor"))
    assert case.run().cor == cor == again.solve()["cor"]
    assert str(case) == str(again)
    assert "accuracy" not in case.text()
    assert "waves = 'relaxing'" in case.text(complete=True)


def test_a_data_file_is_found_from_the_case(tmp_path):
    case = vcor.read(ROOT / "examples/steel_on_measured_rubber.nml")
    assert 0.0 < case.solve()["cor"] < 1.0
    assert repr(pickle.loads(pickle.dumps(case)).solve()) == repr(case.solve())


def test_a_data_file_is_found_from_elsewhere(tmp_path, monkeypatch):
    """From a copy, a pickle and a saved case, in another folder or process than at first."""
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    (tmp_path / "a" / "points.csv").write_text(
        "time [s],relaxation_modulus [Pa]\n1e-6,2e6\n1e-3,1e6\n"
    )
    material = "&material name = 'x', model = 'table', poisson_ratio = 0.4, file = 'points.csv' /\n"
    rest = "&impact velocity = 1 /\n&sphere radius = 0.01, mass = 0.01, material = 'x' /\n"
    (tmp_path / "a" / "c.nml").write_text(
        material + rest + "&plate waves = 'none', material = 'x' /\n"
    )
    monkeypatch.chdir(tmp_path / "a")
    case = vcor.read("c.nml")
    wanted = case.solve()["cor"]
    case.save("again.nml")
    assert "file = 'points.csv'" in (tmp_path / "a" / "again.nml").read_text()
    monkeypatch.chdir(tmp_path / "b")
    case.save("c.nml")
    for one in (case.copy(), pickle.loads(pickle.dumps(case)), vcor.read("c.nml")):
        assert one.solve()["cor"] == wanted


def test_points_give_what_the_case_lacks(sls):
    """As a &sweep group of the program may."""
    case = vcor.Case({**GROUPS, "impact": {}})
    whole = vcor.Case(GROUPS).run().cor
    assert case.points({"impact.velocity": [10.0, 1.0]}, ["cor"]).cor[0] == whole
    assert case.sweep({"impact.velocity": [10.0]}, ["cor"]).cor[0] == whole
    with pytest.raises(vcor.InputError, match="key 'velocity' is missing"):
        case.points({"sphere.radius": [0.01]})
    expected = sls.solve()["cor"]
    sls["rubber.beta"] = 100.0
    assert sls.points({"rubber.beta": [1200.0]}, ["cor"]).cor[0] == expected


def test_files_of_materials_complete_a_case(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "points.csv").write_text(
        "time [s],relaxation_modulus [Pa]\n1e-6,2e6\n1e-3,1e6\n"
    )
    material = "&material name = 'x', model = 'table', poisson_ratio = 0.4, file = 'points.csv' /\n"
    (tmp_path / "a" / "x.nml").write_text(material)
    rest = "&impact velocity = 1 /\n&sphere radius = 0.01, mass = 0.01, material = 'x' /\n"
    (tmp_path / "drop.nml").write_text(rest + "&plate waves = 'none', material = 'x' /\n")
    found = vcor.read(tmp_path / "drop.nml", tmp_path / "a" / "x.nml").run()
    assert 0 < float(found.cor) < 1


def test_moduli(sls):
    rubber = sls.material("rubber")
    glassy, alpha, beta = (sls[f"rubber.{key}"] for key in ("glassy_modulus", "alpha", "beta"))
    t = np.array([[0.0, 1e-4], [1e-3, 1e-2]])
    ratio = alpha / beta
    expected = glassy * (ratio + (1 - ratio) * np.exp(-beta * t))
    np.testing.assert_allclose(rubber.relaxation(t), expected, rtol=1e-14)
    w = 1e3
    expected = glassy * (ratio + (1 - ratio) * 1j * w / (1j * w + beta))
    np.testing.assert_allclose(rubber.complex_modulus(w), expected, rtol=1e-14)
    assert rubber.complex_modulus(w).shape == ()
    sls["rubber.glassy_modulus"] = 2 * glassy
    np.testing.assert_allclose(rubber.relaxation(0.0), 2 * glassy)
    with pytest.raises(vcor.UsageError, match="did you mean 'rubber'"):
        sls.material("ruber")


def test_verify(sls):
    table = sls.verify()
    assert float(table.best.sel(quantity="cor")) == pytest.approx(float(sls.run().cor), abs=1e-9)
    assert float(table.digits.sel(quantity="cor")) >= 6
    assert abs(float((table.ive - table.direct).sel(quantity="cor"))) < 1e-8


# ---------------------------------------------------------------------------------- errors


@pytest.mark.parametrize(
    "setting, error, code",
    [
        ("impact.velocity=-1", vcor.InputError, 3),
        ("impact.velocty=1", vcor.UsageError, 2),
        ("rubber.beta=soft", vcor.UsageError, 2),
        ("rubber.beta=nan", vcor.UsageError, 2),
        ("solver.end_time=1e-5", vcor.NumericalError, 5),
        ("plate.half_thickness=1e-4", vcor.NumericalError, 5),
    ],
)
def test_errors_are_those_of_the_program(sls, program, setting, error, code):
    line = program("run", PAPER / "sls.nml", "--set", setting, "--print", "cor", code=code)
    with pytest.raises(error) as caught:
        address, value = setting.split("=")
        sls[address] = value
        sls.run()
    assert caught.value.code == code
    if error is not vcor.NumericalError:
        # the program says which option the address is from
        assert line == f"vcor: error: --set {caught.value}\n"
        return
    # the program explains at length why nothing comes back
    assert line.startswith("vcor: error: ")
    assert np.isnan(caught.value.result.cor)
    assert str(caught.value.result.status.values) in ("no_separation", "sticks")
    assert len(sls.history().time) > 2


def test_errors_of_files(tmp_path, program):
    with pytest.raises(vcor.FileError) as caught:
        vcor.read(tmp_path / "gone.nml")
    assert str(caught.value) in program("check", tmp_path / "gone.nml", code=4)
    with pytest.raises(vcor.FileError):
        vcor.open(tmp_path / "gone.h5")
    for place in ("/dev/full", tmp_path, "/proc/x.nml", tmp_path / "gone" / "x.nml"):
        with pytest.raises(vcor.FileError):
            vcor.read(PAPER / "sls.nml").save(place)
    (tmp_path / "bad.nml").write_text("&impact\n velocity = fast /\n")
    with pytest.raises(vcor.InputError, match=r"bad\.nml:2: velocity: found 'fast'"):
        vcor.read(tmp_path / "bad.nml")
    with pytest.raises(vcor.InputError, match=r"^case\.nml:1: unknown group"):
        vcor.Case("&impct velocity = 1.0 /")


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda case: case.points({"impact.velocity": [1, 2], "sphere.radius": [1, 2, 3]}),
         "impact.velocity: found 2 values, and 3 of sphere.radius"),
        (lambda case: case.points({"plate.waves": ["none", "body"]}),
         "plate.waves: expected numbers"),
        (lambda case: case.sweep({"impact.velocity": [[1, 2]]}),
         "^impact.velocity: expected numbers in one dimension"),
        (lambda case: case.solve({"impact.velocity": [1, 2]}),
         "^impact.velocity: expected a number"),
        (lambda case: case.sweep({"impact.velocity": [1, 2]}, [1]), "found 1, expected a text"),
        (lambda case: case.sweep({"impact.velocity": [1, 2]}, 1), "found 1, expected a text"),
        (lambda case: case.points({("impact", "velocity"): [1, 2]}), "expected a text"),
        (lambda case: case.points(None), "at least one column of numbers"),
        (lambda case: case.points({"impact.velocity": 1.0}, threads=0), "threads: found 0"),
        (lambda case: case.points({"impact.velocity": 1.0}, threads=1025),
         "threads: found 1025, expected a whole number from 1 to 1024"),
        (lambda case: case.sweep({"impact.velocity": range(1, 10002), "rubber.beta": range(10000)}),
         "the grid has 100010000 points, expected at most 100000000"),
        (lambda case: case.material(0), "found 0, expected a text"),
        (lambda case: case.material("rubber").complex_modulus([1.0, np.inf]),
         "found a frequency that is not a number or infinite"),
        (lambda case: case.material("rubber").relaxation(None), "times: expected numbers"),
        (lambda case: case.material("rubber").relaxation(-1.0), "found a negative time"),
        (lambda case: case.material("rubber").complex_modulus([-1.0]),
         "found a negative frequency"),
        (lambda case: case.material("rubber").time_factors([300.0, np.nan]),
         "found a temperature that is not a number or infinite"),
        (lambda case: case.material("rubber").time_factors([0.0]),
         "found a temperature that is not positive"),
        (lambda case: vcor.Case("sls.nml"), "vcor.read reads a file"),
        (lambda case: vcor.Case(PAPER / "sls.nml"), "vcor.read reads a file"),
        (lambda case: vcor.Case(None), "found None, expected the text of a case or its groups"),
        (lambda case: vcor.Case(case), "found <vcor.Case .*, expected the text of a case"),
        (lambda case: vcor.Case([1]), "expected the text of a case"),
        (lambda case: vcor.Case(b"&case /"), "expected the text of a case"),
        (lambda case: vcor.Case(case.text() + "\0&solver\n nonsense = 1\n/\n"), "found byte 0"),
        (lambda case: vcor.Case(case.text() + "! \ud800"), "is no character"),
        (lambda case: vcor.Case(case.text(), name="a\0b"), "found byte 0"),
        (lambda case: vcor.Case({"case": None}), "&case: found None, expected the keys"),
        (lambda case: vcor.Case({"case": 3}), "&case: found 3, expected the keys"),
        (lambda case: vcor.Case({"material": "x"}), "&material: found 'x', expected the keys"),
        (lambda case: vcor.Case({"material": [1]}), "&material: found 1, expected the keys"),
        (lambda case: vcor.Case({"impact": {"velocity": 1j}}), "^impact.velocity: expected"),
        (lambda case: vcor.Case({"impact": {"velocity": None}}), "^impact.velocity: expected"),
        (lambda case: vcor.Case({"material": {"moduli": [[1, 2], [3, 4]]}}),
         "^material.moduli: expected .* in one dimension"),
        (lambda case: vcor.Case({"impact": {"velocity=3 gravity": 1.0}}), "the name of a group or"),
        (lambda case: vcor.Case({"case / &contact": {}}), "the name of a group or a key"),
        (lambda case: vcor.Case({"impact": {3: 1.0}}), "found 3, expected the name"),
    ],
)  # fmt: skip
def test_wrong_arguments_are_refused(sls, call, words):
    with pytest.raises(vcor.InputError, match=words):
        call(sls)


@pytest.mark.parametrize("address", [3, None, ("impact", "velocity"), "impact.velocity\0x"])
def test_wrong_addresses(sls, address):
    with pytest.raises(vcor.InputError, match="expected a text"):
        sls[address] = 1
    with pytest.raises(vcor.InputError, match="expected a text"):
        sls[address]


@pytest.mark.parametrize(
    "value",
    [
        None, 1j, [1 + 2j], [None], b"3", ["3"], [True], {}, object(), [1.0, [2.0]], 10**400,
        np.array(["2020-01-01"], "M8[s]"), np.array([1], "m8[s]"), np.zeros(2, [("a", float)]),
        np.array([1.0, None]),
    ],
)  # fmt: skip
def test_wrong_numbers(sls, value):
    for solve in (sls.points, sls.sweep, sls.solve):
        with pytest.raises(vcor.InputError, match=r"^impact\.velocity: expected"):
            solve({"impact.velocity": value})
    with pytest.raises(vcor.InputError, match=r"^impact\.velocity: "):
        sls["impact.velocity"] = value


def test_numbers_of_other_kinds(sls):
    """Real numbers of any type are accepted; masked ones have no value."""
    expected = sls.points({"impact.velocity": [1.0, 2.0]}, ["cor"]).cor.values
    for one in (range(1, 3), np.array([1, 2], "u1"), np.array([Fraction(1), Decimal(2)]),
                xr.DataArray([1.0, 2.0]), np.ma.array([1.0, 2.0], mask=False)):  # fmt: skip
        assert (sls.points({"impact.velocity": one}, ["cor"]).cor.values == expected).all()
    with pytest.warns(vcor.NoResultWarning, match="1 of 2 points"):
        found = sls.sweep({"impact.velocity": np.ma.array([1, 7], mask=[False, True])}, ["cor"])
    assert found.cor[0] == expected[0]
    assert np.isnan([found.cor[1], found["impact.velocity"][1]]).all()
    assert sls.solve({"impact.velocity": np.float32(2)})["cor"] == expected[1]


def test_tables_and_series_of_pandas(sls):
    table = pd.DataFrame({"impact.velocity": [1.0, 2.0], "rubber.beta": [600, 1200]})
    found = sls.points(table, ["cor"])
    assert sls.points(table[:0], ["cor"]).sizes == {"point": 0}
    assert sls.solve(table.iloc[1], ["cor"])["cor"] == found.cor[1]


def test_whether_an_address_exists(sls):
    assert "impact.velocity" in sls
    assert "solver.time_step" in sls
    assert "impact.velocty" not in sls
    assert 3 not in sls
    with pytest.raises(TypeError, match="not iterable"):
        list(sls)


def test_other_bytes_than_utf_8_in_a_comment(tmp_path):
    """They are read, copied and pickled."""
    path = tmp_path / "latin.nml"
    path.write_bytes((PAPER / "sls.nml").read_bytes() + b"! \xb5m\n")
    case = vcor.read(path)
    assert str(case) == str(case.copy()) == str(pickle.loads(pickle.dumps(case)))


def test_numbers_in_another_unit(sls):
    """The sentences of the program, from the case, what was set, and points."""

    def said(use):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            with contextlib.suppress(vcor.NumericalError):
                use()
        return [str(one.message) for one in caught if one.category is vcor.UnitWarning]

    assert said(sls.run) == []
    velocity = "impact.velocity = 1000.0 m/s is more than 300.0: is it in mm/s?"
    for values in ([1.0, 1000.0], [1000.0, np.nan], [1000.0]):
        for use in ("points", "sweep"):
            solve = functools.partial(
                getattr(vcor.Case(str(sls)), use), {"impact.velocity": values}
            )
            assert said(solve) == [velocity]
    assert said(lambda: sls.points({"impact.velocity": []})) == []
    text = str(sls).replace("radius = 0.01", "radius = 10.0")
    line = "case.nml:10: sphere.radius = 10.0 m is more than 1.0: is it in mm?"
    for use in ("run", "solve", "history", "verify"):
        heavy = vcor.Case(text)
        assert said(getattr(heavy, use)) == [line]
    swept = vcor.Case(f"{text}&sweep parameter = 'impact.velocity', values = 1, 2 /")
    assert said(lambda: as_case(swept)) == [line] and said(swept.run) == []
    # once for a case and its copies
    assert said(heavy.run) == said(heavy.copy().run) == []
    heavy["rubber.density"] = 1.2
    assert said(heavy.solve) == ["rubber.density = 1.2 kg/m3 is less than 10.0: is it in g/cm3?"]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        with contextlib.suppress(vcor.NumericalError):
            vcor.propagate(vcor.Case(text), {"rubber.beta": "5%"}, samples=32)
    assert [str(one.message) for one in caught if one.category is vcor.UnitWarning] == [line]


def test_points_without_a_result(sls):
    with pytest.warns(vcor.NoResultWarning, match="2 of 3 points have no result"):
        found = sls.points({"impact.velocity": [-1.0, 10.0, np.nan]})
    assert list(found.status) == ["invalid", "separated", "invalid"]
    assert np.isnan(found.cor[0]) and found.cor[1] == sls.run().cor
    for odd in (np.nan, np.inf):
        with pytest.warns(vcor.NoResultWarning, match="1 of 2 points have no result"):
            assert list(sls.copy().points({"impact.velocity": [odd, 10.0]}).status) == [
                "invalid", "separated"
            ]  # fmt: skip
    with pytest.raises(vcor.InputError, match="out of range"):
        sls.solve({"impact.velocity": -1.0})
    with pytest.raises(vcor.UsageError, match=r"^impact\.velocty: .*did you mean 'velocity'"):
        sls.points({"impact.velocty": [1.0]})
    assert sls.solve(quantities="cor") == sls.solve(quantities=["cor"])
    assert repr(vcor.UsageError) == "<class 'vcor.UsageError'>"
    with pytest.raises(vcor.InputError, match="does not belong to model"):
        sls.points({"rubber.exponent": [1.0]})
    with pytest.raises(vcor.UsageError, match="did you mean 'cor'"):
        sls.points({"impact.velocity": [1.0]}, ["core"])
    with pytest.raises(vcor.InputError):
        sls.points({})


SHIFTED = """
&impact velocity = 2.0, temperature = 300.0 /
&sphere radius = 0.01, material = 'steel' /
&plate half_thickness = 0.02, material = 'butyl', waves = 'relaxing' /
&material name = 'steel', model = 'rigid', density = 7800 /
&material name = 'butyl', model = 'prony', density = 1100, poisson_ratio = 0.45,
   equilibrium_modulus = 1e7, moduli = 2e7, 4e7, 9e7, rates = 9e2, 6e3, 3e4, valid_from = 1e-5,
   shift = 'wlf', wlf_c1 = 9.0, wlf_c2 = 89.0, reference_temperature = 293.15,
   valid_temperature_to = 305.0 /
"""
#: Numbers that loops give, with what makes no impact, or none with a result
LOOPS = {
    "impact.velocity": (0.5, 2.0, 20.0, -1.0, 1000.0, np.nan),
    "impact.drop_height": (0.1, 2.0),
    "impact.temperature": (280.0, 300.0, 320.0),
    "sphere.radius": (0.005, 0.01, 12.0),
    "sphere.mass": (0.01, 0.05),
    "plate.thickness": (0.01, 0.04, 0.0),
    "butyl.moduli(2)": (1e7, 4e7, -1.0),
    "butyl.poisson_ratio": (0.3, 0.5),
    "butyl.wlf_c2": (50.0, 89.0),
    "solver.accuracy": (1e-5, 1e-8),
    "solver.end_time": (1e-2, 1.0, 1e-5),
}


def test_impacts_of_a_loop_do_not_depend_on_those_before():
    """Numbers, validity and errors are those of a copy, whatever was solved and set."""

    def solved(case, values):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            try:
                found = case.solve(values)
                made = repr(found), found.validity
            except vcor.Error as error:
                made = repr(error)
        return made, [str(one.message) for one in caught if one.category is vcor.ValidityWarning]

    dice, case, given, failed = random.Random(5), vcor.Case(SHIFTED), [], 0
    for number in range(80):
        if number % 4 == 0:
            address = dice.choice(list(LOOPS)[3:])
            case[address] = dice.choice(LOOPS[address][:2])
        elif number % 4 == 1:
            # a loop over one address asks again and again
            given = dice.sample(list(LOOPS), dice.randint(0, 3))
        values = {address: dice.choice(LOOPS[address]) for address in given}
        found = solved(case, values)
        assert found == solved(case.copy(), values), (number, values)
        failed += isinstance(found[0], str)
    assert 5 < failed < 60


def test_a_single_impact_is_one_call_of_the_library(sls, monkeypatch):
    """What there is to say about it comes with it."""
    names, call = [], _library.call
    for module in (vcor.case, _coverage):
        monkeypatch.setattr(module, "call", lambda *given: names.append(given[0]) or call(*given))
    with pytest.warns(vcor.ValidityWarning, match="sls.nml: validity: outside") as caught:
        sls.solve({"impact.velocity": 10.0})
    assert names == ["vcor_impact"] and caught[0].filename == __file__


def test_a_loop_names_the_cause_of_each_impact(sls):
    """The plate is lighter than the ball at one radius and not at another."""
    case = vcor.Case(str(sls))
    case["plate.half_thickness"] = 1e-4
    for radius, words in ((1e-5, "within solver.end_time"), (1e-2, r"plate\.base")):
        with pytest.raises(vcor.NumericalError, match=words):
            case.solve({"sphere.radius": radius, "solver.end_time": 1e-9})


def test_a_sweep_of_a_case_that_varies_something_else():
    case = vcor.read(SWEEPS / "sls_velocity.nml")
    with pytest.raises(vcor.InputError, match=r"sls_velocity\.nml:\d+: the case varies"):
        case.points({"sphere.radius": [0.01]})
    with pytest.raises(vcor.InputError):
        case.history()
    assert case.points({"impact.velocity": [1.0], "sphere.radius": [0.01]}).cor[0] > 0


# ---------------------------------------------------------------------------------- threads


def test_eight_threads_at_once(sls):
    """One case and cases of their own, solved, set and read side by side."""
    betas = np.linspace(600.0, 2400.0, 40)
    expected = sls.points({"rubber.beta": betas}, threads=1)
    alone = repr(sls.solve())

    def work(number):
        own = vcor.read(PAPER / "sls.nml")
        found = []
        for beta in betas[number::8]:
            own["rubber.beta"] = beta
            found.append(own.solve()["cor"])
            assert repr(sls.solve()) == alone
        shared = sls.points({"rubber.beta": betas}, threads=1 + number % 2)
        assert same(shared, expected)
        with pytest.raises(vcor.InputError):
            vcor.Case("&impact velocity = -1.0 /").text()
        return found

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        results = list(pool.map(work, range(8)))
    for number, found in enumerate(results):
        assert np.array_equal(found, expected.cor.values[number::8])


def solve_pickled(case, velocities):
    return case.points({"impact.velocity": velocities}, threads=2).cor.values


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_other_processes(sls, method):
    """A case pickles with what was set; a child of fork solves though its parent had threads."""
    sls["rubber.beta"] = 900.0
    velocities = np.linspace(1.0, 20.0, 60)
    expected = solve_pickled(sls, velocities)
    context = multiprocessing.get_context(method)
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as pool:
        parts = pool.map(solve_pickled, [sls] * 3, np.split(velocities, 3))
        assert np.array_equal(np.concatenate(list(parts)), expected)


def test_ctrl_c_ends_a_sweep(sls):
    """An interrupt comes through while the library works."""
    threading.Timer(0.5, os.kill, [os.getpid(), signal.SIGINT]).start()
    with pytest.raises(KeyboardInterrupt):
        sls.points({"impact.velocity": np.linspace(0.1, 50.0, 20_000_000)}, ["cor"], threads=1)
    assert sls.solve()["status"] == "separated"


def test_the_progress_bar(sls, capsys, monkeypatch):
    monkeypatch.setattr("vcor.progress._BAR_DELAY", 0.0)
    sls.points({"impact.velocity": [1.0, 2.0]}, progress=True)
    assert "2/2" in capsys.readouterr().err
    sls.points({"impact.velocity": [1.0, 2.0]})
    assert capsys.readouterr().err == ""


def test_a_case_may_outlive_the_modules():
    """The interpreter empties them when it ends, some before the last case."""
    script = (
        f"import vcor\ncase = vcor.read({str(PAPER / 'sls.nml')!r})\n"
        "for name in list(vars(vcor._library)): setattr(vcor._library, name, None)\n"
        "del case\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=True)
    assert done.stdout == done.stderr == b""


def test_nothing_is_printed(tmp_path):
    """Errors print nothing either."""
    script = (
        "import vcor, warnings; warnings.simplefilter('ignore')\n"
        f"case = vcor.read({str(PAPER / 'sls.nml')!r})\n"
        "case.points({'impact.velocity': [-1.0, 1.0]}); case.run(); case.verify()\n"
        "try: case['impact.velocity'] = -1.0\n"
        "except ValueError: pass\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=True)
    assert done.stdout == done.stderr == b""


def test_results_are_xarray(sls):
    assert isinstance(sls.run(), xr.Dataset)
    assert sls.run().max_force.attrs["units"] == "N"
    assert sls.run().cor.attrs["long_name"].startswith("coefficient of restitution")
    assert "units" not in sls.run().status.attrs


def rubber(shift=True):
    """A ball on a rubber that the temperature shifts, as groups."""
    groups = {key: dict(value) for key, value in GROUPS.items() if key != "material"}
    material = dict(GROUPS["material"][1])
    if shift:
        material.update(shift="wlf", reference_temperature=298.15, wlf_c1=8.86, wlf_c2=101.6)
    return {**groups, "material": [GROUPS["material"][0], material]}


def test_a_sweep_over_the_temperature():
    """Alone and with the velocity; at the reference temperature not a bit changes."""
    temperatures = [283.15, 298.15, 313.15]
    case = vcor.Case(rubber())
    cube = case.sweep({"impact.temperature": temperatures, "impact.velocity": [2.0, 10.0]})
    assert cube["impact.temperature"].attrs["units"] == "K"
    assert cube.cor.shape == (3, 2)
    assert len(set(cube.cor.values.ravel())) == 6
    for temperature in temperatures:
        case["impact.temperature"] = temperature
        single = case.run().cor
        assert single == cube.cor.sel({"impact.temperature": temperature, "impact.velocity": 10.0})
    plain = vcor.Case(rubber(shift=False)).run().cor
    assert plain == cube.cor.sel({"impact.temperature": 298.15, "impact.velocity": 10.0})
    with pytest.raises(vcor.InputError, match="needs a shift"):
        vcor.Case(rubber(shift=False)).sweep({"impact.temperature": temperatures})


def test_moduli_are_those_of_the_case_as_it_is():
    """Two materials in turn, after numbers, texts, lists and groups were set or taken away."""
    groups = rubber(shift=False)
    groups["material"].append({"name": "gum", "model": "elastic", "modulus": 5e6,
                               "poisson_ratio": 0.5, "density": 1000.0})  # fmt: skip
    case = vcor.Case(groups)
    one, other = case.material("rubber"), case.material("gum")
    first = float(one.relaxation(0.0))
    assert (other.relaxation(0.0), one.relaxation(0.0)) == (5e6, first)
    case["gum.modulus"] = 6e6
    assert (one.relaxation(0.0), other.relaxation(0.0)) == (first, 6e6)
    case["rubber.moduli"] = [2e6, 3e6]
    assert one.relaxation(0.0) == first + 2e6
    case["rubber.moduli(1)"] = 3e6
    assert one.relaxation(0.0) == first + 3e6
    case["rubber.modulus_kind"] = "shear"
    assert one.relaxation(0.0) == pytest.approx(2.8 * (first + 3e6))
    copy = case.copy()
    copy["gum.modulus"] = 7e6
    assert (other.relaxation(0.0), copy.material("gum").relaxation(0.0)) == (6e6, 7e6)
    case["gum.modulus"] = 8e6
    with pytest.raises(vcor.InputError, match="expected a number > 0"):
        case["gum.modulus"] = -1.0
    assert other.relaxation(0.0) == 8e6
    with pytest.raises(vcor.UsageError):
        case.material("gumm")
    assert other.relaxation(0.0) == 8e6


def test_moduli_at_a_temperature():
    """Times are longer by the factor a_T."""
    case = vcor.Case(rubber())
    plain = case.material("rubber").relaxation([1e-4])
    case["impact.temperature"] = 310.0
    factor = 10 ** (-8.86 * 11.85 / (101.6 + 11.85))
    assert case.material("rubber").relaxation([1e-4 * factor]) == pytest.approx(plain, rel=1e-13)


def test_shift_factors_at_temperatures(tmp_path):
    """Those of the material at each temperature of the impact, whether this has one or not."""
    case, temperatures = vcor.Case(rubber()), np.array([[290.0, 298.15], [310.0, 350.0]])
    material = case.material("rubber")
    law = -8.86 * (temperatures - 298.15) / (101.6 + temperatures - 298.15)
    assert np.log10(material.time_factors(temperatures)) == pytest.approx(law, abs=1e-12)
    case["impact.temperature"] = 310.0
    assert material.time_factor() == material.time_factors([310.0])[0]
    assert material.time_factors([]).shape == (0,)
    with pytest.raises(vcor.InputError, match=r"temperature = 150\.0.*wlf_c2 = 101\.6"):
        material.time_factors([310.0, 150.0])
    # the case is as it was
    assert float(case["impact.temperature"]) == 310.0
    plain = vcor.Case(rubber(shift=False)).material("rubber")
    assert (plain.time_factors(temperatures) == 1.0).all()
    path = tmp_path / "shifts.csv"
    path.write_text("temperature [K],log10_shift_factor [1]\n290,0.6\n298.15,0.0\n330,-2.0\n")
    groups = rubber(shift=False)
    groups["material"][1].update(shift="table", reference_temperature=298.15, shift_file=str(path))
    table = vcor.Case(groups).material("rubber")
    assert np.log10(table.time_factors([330.0, 298.15])) == pytest.approx([-2.0, 0.0], abs=1e-12)
    with pytest.raises(vcor.InputError, match="not extrapolated"):
        table.time_factors([331.0])


def test_a_number_of_a_list():
    """An address may be a number of a list, in a case, a sweep and points."""
    case = vcor.Case(GROUPS)
    cor = case.sweep({"rubber.moduli(2)": [1e6, 2e6]}).cor
    assert cor[1] == case.run().cor
    case["rubber.moduli(2)"] = 1e6
    assert float(case["rubber.moduli(2)"]) == 1e6
    assert cor[0] == case.run().cor == case.points({"rubber.moduli(2)": [1e6]}).cor[0]
    with pytest.raises(vcor.InputError, match="moduli"):
        case["rubber.moduli(3)"] = 1e6


@pytest.mark.parametrize(
    "folder", ["it's", 'say "it"', "a, velocity = 3", "x' / &impact velocity=3", "é"]
)
def test_data_files_of_any_folder(tmp_path, monkeypatch, folder):
    """Found by a case, its materials and its copies; nothing of a name is read as a key."""
    place = tmp_path / folder.replace("/", "!")
    place.mkdir()
    for name in ("x.csv", "it's.csv"):
        (place / name).write_text("time [s],relaxation_modulus [Pa]\n1e-6,1e7\n1e-3,5e6\n1,1e6\n")
    bodies = "&impact velocity=1.0 /\n&sphere radius=0.01, material='s' /\n&plate material='r', " \
             "waves='none' /\n&material name='s', model='rigid', density=7800. /\n"  # fmt: skip
    (tmp_path / "base.nml").write_text(bodies)
    title = "&case title = 'file = ''x.csv''' /\n"
    cors = set()
    for data in ("x.csv", "it''s.csv"):
        rubber = f"&material name='r', model='table', poisson_ratio=0.5, file='{data}' /\n"
        (place / "m.nml").write_text(f"! file = 'nowhere.csv'\n{rubber}")
        (place / "case.nml").write_text(title + bodies + rubber)
        both = vcor.read(tmp_path / "base.nml", place / "m.nml")
        alone = vcor.read(place / "case.nml")
        alone.save(tmp_path / "saved.nml")
        monkeypatch.chdir(place)
        relative = vcor.read("../base.nml", "m.nml")
        saved = vcor.read(tmp_path / "saved.nml")
        assert saved["case.title"] == "file = 'x.csv'"
        for case in (both, alone, relative, saved, both.copy(), pickle.loads(pickle.dumps(both))):
            assert case["impact.velocity"] == 1.0
            cors.add(case.solve()["cor"])
    assert len(cors) == 1


def test_files_of_materials_hold_materials_only(tmp_path, sls):
    (tmp_path / "m.nml").write_text(
        "&material name = 'x', model = 'rigid' /\n&impact velocity=3 /\n"
    )
    with pytest.raises(vcor.InputError, match="m.nml: found other groups, expected &material"):
        vcor.read(PAPER / "sls.nml", tmp_path / "m.nml")


def test_address_that_is_too_long():
    name = "r" * 280
    case = vcor.Case(PAPER.joinpath("sls.nml").read_text().replace("rubber", name))
    assert case.solve({f"{name}.beta": 600.0}, ["cor"])["cor"] > 0
    with pytest.raises(vcor.InputError, match="an address of 285 bytes, expected at most 255"):
        case.points({f"{name}.beta": [600.0]}, ["cor"])


def test_a_material_of_the_name_of_a_group(sls):
    """Nothing is removed of which it is not clear whether it was meant."""
    case = vcor.Case(str(sls).replace("'steel'", "'Plate'"))
    with pytest.raises(vcor.UsageError, match="of a group and of a material"):
        del case["plate"]
    assert repr(case.solve()) == repr(sls.solve())
    del case["'plate'"]
    assert case["plate.waves"] is not None and "Plate.density" not in case


def test_a_name_with_an_equals_sign(sls):
    name = sls["plate.material"]
    case = vcor.Case(str(sls).replace(f"'{name}'", "'a=b'"))
    case["a=b.beta"] = sls[f"{name}.beta"] = 1100.0
    assert case["a=b.beta"] == 1100.0 and repr(case.solve()) == repr(sls.solve())


@pytest.mark.parametrize("other", [None, "rubber.nml", {"material": []}])
def test_what_is_added_is_a_case(sls, other):
    with pytest.raises(vcor.UsageError, match="expected a case of &material groups"):
        sls.add(other)
