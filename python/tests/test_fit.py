"""Fits: the same as those of the program."""

import re

import numpy as np
import pytest
from conftest import PAPER, ROOT

import vcor

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


@pytest.mark.parametrize(
    "data, settings, error, line",
    [
        ("gone.csv", {}, vcor.FileError, "there is no such file"),
        (DATA, {"model": "pronny"}, vcor.InputError, "did you mean 'prony'"),
        (DATA, {"model": "sls", "fix": {"exponent": 1.0}}, vcor.InputError, "expected a parameter"),
        (([1.0, 2.0], [1.0, 2.0]), {}, vcor.InputError, "found 2 moduli"),
        (([1.0, 2.0], [1.0, -2.0]), {}, vcor.InputError, "numbers > 0"),
    ],
    ids=["file", "model", "fix", "few", "negative"],
)
def test_errors(data, settings, error, line):
    with pytest.raises(error, match=line):
        vcor.fit(data, **settings)
