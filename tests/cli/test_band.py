"""The band of the data of a fit: an impact that depends on the material outside of it is warned of."""

import re

import pytest
from program import INPUT, PAPER, SUCCESS

POWER_LAW = PAPER / "butyl_power_law.nml"


def warning(vcor, *words, name=POWER_LAW):
    done = vcor("run", name, "--print", "cor", *words)
    assert done.code == SUCCESS
    return "".join(line for line in done.err.splitlines(keepends=True) if "validity " not in line)


def change(line):
    return abs(float(re.search(r"cor changes by (\S+),", line)[1]))


def test_data_that_begin_too_late(vcor):
    """Times below 1 us carry 1e-2 in the cor of BUTYL."""
    line = warning(vcor, "--set", "butyl.valid_from=1e-6")
    assert line.startswith("vcor: warning: ") and line.count("\n") == 1
    assert "valid_from 1.0E-06 s" in line and "'butyl'" in line
    assert "the contact lasts 7.7E-04 s, and 0.13 % of it lies before the data" in line
    assert change(line) == pytest.approx(1.1e-2, rel=0.05) and "depends on the extrapolation of the fit" in line


def test_contact_before_all_data(vcor):
    line = warning(vcor, "--set", "butyl.valid_from=1e-2")
    assert "the contact lasts 7.7E-04 s, and all of it lies before the data of 'butyl'" in line
    # said whatever the change of cor is
    line = warning(vcor, "--set", "butyl.valid_from=1e-2", "--set", "butyl.coefficient=1e-3")
    assert "all of it lies before" in line and change(line) < 1e-4


def test_data_that_begin_early(vcor):
    assert warning(vcor, "--set", "butyl.valid_from=1e-12") == ""
    assert warning(vcor, "--set", "butyl.valid_to=1") == ""
    earlier = change(warning(vcor, "--set", "butyl.valid_from=1e-8"))
    assert earlier == pytest.approx(1.1e-3, rel=0.05)


def test_struck_block(vcor):
    """Behind a heavy block the change is that of the contact alone."""
    words = ["--set", "butyl.valid_from=1e-6"]
    alone = change(warning(vcor, *words, "--set", "plate.waves='none'"))
    text = POWER_LAW.read_text(encoding="utf-8") + "\n&target body = 'block', mass = 50.0 /\n"
    vcor.write(text)
    line = warning(vcor, *words, "--set", "plate.waves='none'", name="case.nml")
    assert line.count("\n") == 1 and "depends on the extrapolation of the fit" in line
    assert change(line) == pytest.approx(alone, rel=0.05)


def test_data_that_end_too_soon(vcor):
    line = warning(vcor, "--set", "butyl.valid_to=1e-4")
    assert "valid_to 1.0E-04 s" in line and change(line) > 1e-2
    assert "87 % of it lies after the data" in line


def test_sweep_leans(vcor):
    """For a sweep the worse of the shortest and the longest contact is reported."""
    done = vcor("run", PAPER.parent / "sweeps" / "butyl_power_law_velocity.nml", "--quiet",
                "--set", "butyl.valid_from=1e-6", "--set", "sweep.count=3")
    assert done.code == SUCCESS and done.err.count("\n") == 1
    assert "impact.velocity = 50" in done.err


@pytest.mark.parametrize("plate", ["half_thickness=0.02", "thickness=0.04", None])
def test_exact_mechanics_rely_on_the_data_as_others(vcor, tmp_path, plate):
    """The change is that of the thin plate, or of a half space without waves."""
    text = re.sub(r"half_thickness *= *[^,/\s]+,?", "", POWER_LAW.read_text())
    case = tmp_path / "case.nml"
    case.write_text(re.sub(r"&plate", f"&plate {plate + ',' if plate else ''}", text)
                    .replace("&case", "&contact mechanics = 'exact' /\n&case"))  # fmt: skip
    waves = "hereditary" if plate else "none"
    band = "butyl.valid_from=1e-6"
    exact, other = (warning(vcor, "--set", f"plate.waves={one}", "--set", band, name=case)
                    for one in ("body", waves))  # fmt: skip
    assert "'butyl'" in exact and exact.count("\n") == 1
    assert change(exact) == pytest.approx(change(other), rel=0.3)


def test_band_is_checked(vcor):
    words = ["--set", "butyl.valid_from=1e-3", "--set", "butyl.valid_to=1e-4"]
    vcor.refuses("run", POWER_LAW, *words, code=INPUT, says="valid_from < valid_to")
    vcor.refuses("run", POWER_LAW, "--set", "butyl.valid_from=0", code=INPUT, says="valid_from")
    vcor.refuses("run", POWER_LAW, "--set", "steel.valid_from=1", code=INPUT, says="rigid")
