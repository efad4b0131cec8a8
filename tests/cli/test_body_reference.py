"""Plates with waves = 'body' against an independent computation, tests/reference/body.txt."""

import re

import pytest
from program import ROOT

# Beside the accuracy of the reference itself, which is stated with each impact
RESTITUTION, ENERGY = 1e-7, 1e-7
# cor_sphere by method direct, which takes the equations another way
DIRECT = 1e-5
# An error is stated too small when the true one is more than so many times larger
HONEST = 3.0


def impacts():
    """Number, case, expected columns and accuracies of each impact."""
    head, *blocks = (ROOT / "tests" / "reference" / "body.txt").read_text("utf-8").split("! impact ")
    names = re.search(r"Expected: (.*)", head)[1].split(", ")
    for block in blocks:
        remark, numbers, text = block.split("\n", 2)
        values = map(float, numbers.removeprefix("! expect ").split())
        sphere, relative, rest = map(float, remark.split("accuracy ")[1].split())
        yield pytest.param(text, dict(zip(names, values, strict=True)), sphere, relative, rest,
                           id=remark.split(";")[0].replace(" ", "_"))


def solved(vcor, *options):
    """Columns that the program prints."""
    names = ["cor", "cor_sphere", "cor_error", "cor_sphere_error", "wave_energy",
             "hysteresis_energy"]
    out = vcor("run", "case.nml", "--quiet", "--print", ",".join(names), *options)
    assert out.code == 0, out.err
    return dict(zip(names, map(float, out.out.split()), strict=True))


@pytest.mark.parametrize("text, expected, sphere, relative, rest", list(impacts()))
def test_impact(vcor, text, expected, sphere, relative, rest):
    vcor.write(text)
    found = solved(vcor)
    error = abs(found["cor_sphere"] - expected["cor_sphere"])
    assert error <= RESTITUTION + sphere
    assert error <= HONEST * found["cor_sphere_error"] + sphere
    assert abs(found["cor"] - expected["cor"]) <= HONEST * found["cor_error"] + relative
    for name in ("wave_energy", "hysteresis_energy"):
        assert abs(found[name] - expected[name]) <= (ENERGY + rest) * expected["initial_energy"]


@pytest.mark.parametrize("text, expected, sphere, relative, rest", list(impacts())[::3])
def test_direct(vcor, text, expected, sphere, relative, rest):
    vcor.write(text)
    found = solved(vcor, "--set", "solver.method=direct", "--set", f"solver.accuracy={DIRECT}")
    error = abs(found["cor_sphere"] - expected["cor_sphere"])
    assert error <= min(DIRECT, HONEST * found["cor_sphere_error"])
    assert abs(found["cor"] - expected["cor"]) <= HONEST * found["cor_error"] + relative
