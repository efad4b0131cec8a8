"""Fits: the same as those of the program."""

import json
import re

import numpy as np
import pytest
from conftest import PAPER, ROOT

import vcor
from vcor import _command
from vcor.materials import fit as fit_module
from vcor.materials.data import read_data
from vcor.materials.fit import samples_of

DATA = ROOT / "examples" / "soft_rubber_data.csv"


@pytest.mark.parametrize(
    "settings",
    [
        {},
        {"terms": 3, "density": 1100.0, "poisson_ratio": 0.45, "name": "soft"},
        {"model": "mittag_leffler"},
    ],
    ids=["prony", "terms", "law"],
)
def test_a_file(program, tmp_path, settings):
    words = []
    for key, value in settings.items():
        words += [f"--{key.replace('_', '-')}", value]
    program("fit", DATA, *words, "--output", tmp_path / "fit.nml", "--quiet")
    written = (tmp_path / "fit.nml").read_text()
    found = vcor.fit(DATA, **settings)
    assert written.endswith(found.group)
    assert str(found) == found.group
    for parameter in found.parameters:
        assert parameter.state in ("free", "bound") and parameter.error > 0
        assert parameter.name in found.group
    assert 0 < found.rms < 0.1


def test_linear_algebra_on_one_thread(monkeypatch):
    """Threads of small matrices only wait for each other, and for the processor."""
    info = pytest.importorskip("threadpoolctl").threadpool_info
    search, used = fit_module.fit_series, []

    def watched(*given):
        used.extend(one["num_threads"] for one in info() if one["user_api"] == "blas")
        return search(*given)

    monkeypatch.setattr(fit_module, "fit_series", watched)
    with pytest.importorskip("threadpoolctl").threadpool_limits(2, "blas"):
        vcor.fit(DATA)
    assert set(used) == {1}


def test_arrays():
    """The parameters that made the data, and a group that a case takes."""
    rubber = vcor.read(PAPER / "sls.nml").material("rubber")
    t = np.geomspace(1e-5, 1e-1, 60)
    found = vcor.fit((t[::-1], rubber.relaxation(t)[::-1]), model="sls")
    assert found["beta"] == pytest.approx(1200.0, rel=1e-6)
    assert found["alpha"] == pytest.approx(300.0, rel=1e-6)
    assert found.follows and found.rms < 1e-7
    w = np.geomspace(1e1, 1e6, 60)
    modulus = rubber.complex_modulus(w)
    again = vcor.fit((w, modulus.real, modulus.imag), model="prony", terms=1, name="block")
    assert again["times"] == [pytest.approx(1 / 1200.0, rel=1e-5)]
    fixed = vcor.fit((t, rubber.relaxation(t)), model="sls", fix={"beta": 1200.0})
    (beta,) = (one for one in fixed.parameters if one.name == "beta")
    assert (beta.state, beta.value, beta.error, beta.unit) == ("fixed", 1200.0, 0.0, "1/s")
    with pytest.raises(KeyError):
        fixed["exponent"]
    text = re.sub(
        r"&material\s+name = 'rubber'.*?^/$",
        found.group.replace("'material'", "'rubber'").replace("/\n", "   density = 1100.0\n/"),
        vcor.read(PAPER / "sls.nml").text(),
        flags=re.DOTALL | re.MULTILINE,
    )
    assert 0 < vcor.Case(text).solve()["cor"] < 1


def test_covariance_of_the_terms_is_that_of_the_linear_problem():
    t = np.geomspace(1e-5, 1e-1, 60)
    noise = np.random.default_rng(1).normal(size=t.size)
    made = 2e6 + 6e6 * np.exp(-t / 2e-4) + 4e6 * np.exp(-t / 5e-3)
    found = vcor.fit((t, made * np.exp(0.01 * noise)), terms=2)
    rest, *moduli = (one.value for one in found.parameters if one.unit == "Pa")
    times = found["times"]
    terms = [np.exp(-t / time) for time in times]
    model = rest + sum(g * e for g, e in zip(moduli, terms, strict=True))
    slopes = [np.ones_like(t)]
    for g, e, time in zip(moduli, terms, times, strict=True):
        slopes += [e, g * e * t / time**2]
    slopes = np.array(slopes).T / model[:, None]
    misfit = np.log(model / made) - 0.01 * noise
    covariance = np.linalg.inv(slopes.T @ slopes) * (misfit @ misfit) / (t.size - 5)
    assert np.allclose(found.covariance, covariance, rtol=1e-4, atol=0)


@pytest.mark.parametrize("model", ["prony", "power_law"])
def test_json_of_the_program(program, tmp_path, model):
    """The document is that of Python, and `vcor uncertainty` takes it."""
    words = ["--terms", "3"] if model == "prony" else ["--fix", "exponent=0.4"]
    program("fit", DATA, "--model", model, *words, "--name", "soft rubber", "--json", "a/fit.json")
    written = json.loads((tmp_path / "a" / "fit.json").read_text())
    fix = {} if model == "prony" else {"exponent": 0.4}
    terms = 3 if model == "prony" else None
    found = vcor.fit(DATA, model=model, terms=terms, fix=fix, name="soft rubber")
    assert written == found.as_dict()
    values, errors = np.array(
        [(one["value"], one["standard_error"]) for one in written["parameters"]]
    ).T
    correlation = np.array(written["correlation"])
    assert np.array_equal(correlation, correlation.T)
    assert np.allclose(written["covariance"], correlation * np.outer(errors, errors), rtol=1e-14)
    assert np.array_equal(np.diag(correlation) == 0, errors == 0)
    text = vcor.read(PAPER / "sls.nml").text()
    text = re.sub(r"&material\s+name = 'rubber'.*?^/$", written["group"], text, flags=re.S | re.M)
    text = text.replace("name = 'soft rubber'", "density = 1100, name = 'soft rubber'")
    case = vcor.Case(text.replace("'rubber'", "'soft rubber'"))
    (tmp_path / "case.nml").write_text(case.text())
    pytest.importorskip("SALib", reason="vcor uncertainty needs it, vcor.fit does not")
    _command.call(
        "uncertainty",
        [str(tmp_path / "case.nml"), "--covariance", str(tmp_path / "a" / "fit.json")]
        + ["--samples", "64", "--quantity", "cor", "--output", str(tmp_path), "--quiet"],
    )
    spread = json.loads((tmp_path / "case_uncertainty.json").read_text())["quantities"]["cor"]
    slopes = np.array([spread["elasticity"].get(f"soft rubber.{one['name']}", 0.0) / one["value"]
                       for one in written["parameters"] if one["value"] > 0])  # fmt: skip
    kept = values > 0
    variance = slopes @ np.array(written["covariance"])[np.ix_(kept, kept)] @ slopes
    assert spread["material"] == pytest.approx(spread["value"] * np.sqrt(variance), rel=0.5)


def test_no_file_that_was_read_is_replaced(program, tmp_path):
    (tmp_path / "data.csv").write_text(DATA.read_text())
    said = program("fit", "data.csv", "--json", "data.csv", code=2)
    assert "would replace a file that is read" in said
    words = ["--json", "a.nml", "--output", "a.nml"]
    assert "is that of --output" in program("fit", "data.csv", *words, code=2)


@pytest.mark.parametrize(
    "data, settings, error, line",
    [
        ("gone.csv", {}, vcor.FileError, "No such file"),
        (DATA, {"model": "pronny"}, vcor.InputError, "did you mean 'prony'"),
        (DATA, {"model": "sls", "fix": {"exponent": 1.0}}, vcor.InputError, "expected a parameter"),
        (([1.0, 2.0], [1.0, 2.0]), {}, vcor.InputError, "found 2 moduli"),
        (([1.0, 2.0], [1.0, -2.0]), {}, vcor.InputError, "numbers > 0"),
        (None, {}, vcor.InputError, "expected two or three arrays of one length"),
        (([1, 2, 3], [1, 2]), {}, vcor.InputError, "expected two or three arrays of one length"),
        (([1, 2, 3], [3, 2, 1j]), {}, vcor.InputError, "data: expected numbers"),
        (DATA, {"fix": {"exponent": None}}, vcor.InputError, "exponent: expected a number"),
        (DATA, {"model": 3}, vcor.InputError, "found 3, expected a text"),
        (DATA, {"name": "a\nb"}, vcor.InputError, "the name of the material: found"),
        (DATA, {"name": "a\x1bb"}, vcor.InputError, "be read on one line"),
        (DATA, {"name": "a\udcffb"}, vcor.InputError, "be read on one line"),
    ],
)
def test_errors(data, settings, error, line):
    with pytest.raises(error, match=line):
        vcor.fit(data, **settings)


def test_arrays_by_name_have_units_and_any_order():
    omega = np.geomspace(1, 1e4, 25)
    p = (1j * omega * 1e-3) ** 0.5
    found = 2e6 + 5e7 * p / (1 + p)
    settings = {"model": "mittag_leffler", "poisson_ratio": 0.5}
    right = vcor.fit((omega, found.real, found.imag), **settings)
    for data in (
        {
            "E'' [MPa]": found.imag / 1e6,
            "f [Hz]": omega / (2 * np.pi),
            "E' [MPa]": found.real / 1e6,
        },
        {"loss_modulus": found.imag, "omega": omega, "storage_modulus": found.real},
        {"Frequency [rad/s]": omega, "G' [Pa]": found.real / 3, "G'' [Pa]": found.imag / 3},
    ):
        one = vcor.fit(data, **settings)
        assert [p.value for p in one.parameters] == pytest.approx(
            [p.value for p in right.parameters], rel=1e-6
        )
    with pytest.warns(UserWarning, match=r"'frequency' is taken in rad/s; 'frequency \[Hz\]' is"):
        vcor.fit({"frequency": omega, "storage_modulus": found.real, "loss_modulus": found.imag},
                 **settings)  # fmt: skip


RISE, FALL = [1.0, 2.0, 3.0], [3.0, 2.0, 1.0]


@pytest.mark.parametrize(("data", "error", "line"), [
    ({"x": RISE, "y": FALL}, vcor.InputError, "found 'x', expected time, relaxation"),
    ({"t [s]": RISE}, vcor.InputError, "found time, expected time, relaxation_modulus"),
    ({"t [mm]": RISE, "E [Pa]": FALL}, vcor.InputError, r"found 't \[mm\]'"),
    ({"t": RISE, "time [s]": FALL}, vcor.InputError, "found two arrays of the time"),
    ({"t": RISE, "G": FALL}, vcor.UsageError, "found shear moduli, 'G', expected poisson"),
    ({"t": RISE, "log E": FALL}, vcor.InputError, "found 'log E'"),
    ({}, vcor.InputError, "found nothing"),
])  # fmt: skip
def test_arrays_by_name_are_known(data, error, line):
    with pytest.raises(error, match=line):
        vcor.fit(data)


def test_many_points_are_averaged(tmp_path):
    """A record with equal steps in time: the result is that of the same points, spaced by ratio."""
    time = np.arange(1, 100_001) * 1e-3
    noise = np.random.default_rng(4).standard_normal(len(time))
    modulus = 2e6 * (0.4 + 0.6 * np.exp(-time / 5)) * np.exp(0.01 * noise)
    path = tmp_path / "long.csv"
    rows = "".join(f"{t:.6g},{e:.7g}\n" for t, e in zip(time, modulus, strict=True))
    path.write_text("t [s],E [Pa]\n" + rows)
    samples, _, (note,) = samples_of(read_data(path))
    assert f"100000 points are more than 2000: the fit is to {len(samples.at)} " in note
    assert len(samples.at) < 1002 and np.all(np.diff(samples.at) > 0)
    found = vcor.fit(path, model="sls", poisson_ratio=0.4)
    assert found["glassy_modulus"] == pytest.approx(2e6, rel=5e-3)
    assert found["beta"] == pytest.approx(0.2, rel=2e-2)
    path.write_text("t [s],E [Pa]\n" + rows[: rows.index("\n1.5,") + 1])
    samples, _, notes = samples_of(read_data(path))
    assert len(samples.at) == 1499 and not notes
