"""What a result does not know of itself travels with it: validity, and the range of the data."""

import pickle
import warnings

import numpy as np
import pytest
from conftest import PAPER

import vcor
from vcor._coverage import unwarned

SHEET = """
&impact drop_height = 0.25, temperature = 273.15 /
&sphere diameter = 0.006, material = 'ball' /
&plate thickness = 0.003, base = 'bonded', material = 'sheet' /
&contact mechanics = 'exact' /
&material name = 'ball', model = 'elastic', modulus = 210e9, poisson_ratio = 0.3, density = 7800 /
&material name = 'sheet', model = 'sls', density = 1200, poisson_ratio = 0.49,
   glassy_modulus = 50e6, alpha = 300, beta = 1200, valid_from = 3e-3, shift = 'wlf',
   wlf_c1 = 9.0, wlf_c2 = 89.0, reference_temperature = 273.15, valid_temperature_from = 260 /
"""


def heard(work, kind):
    """What work returns, and the warnings of a kind that it gives."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        made = work()
    return made, [str(one.message) for one in caught if one.category is kind]


def butyl(**values):
    case = vcor.read(PAPER / "butyl_power_law.nml")
    for key, value in values.items():
        case[f"butyl.{key}"] = value
    return case


VELOCITY = {"impact.velocity": [5.0, 10.0]}
CALLS = {
    "run": lambda case: case.run().attrs,
    "history": lambda case: case.history().attrs,
    "points": lambda case: case.points(VELOCITY, ["cor"]).attrs,
    "sweep": lambda case: case.sweep(VELOCITY, ["cor"]).attrs,
    "solve": lambda case: vars(case.solve()),
    "values": lambda case: vars(case.solve({"impact.velocity": 10.0}, ["cor"])),
}


@pytest.mark.parametrize("call", CALLS.values(), ids=list(CALLS))
def test_data_that_begin_too_late(call):
    said, lines = heard(lambda: call(butyl(valid_from=1e-6)), vcor.DataRangeWarning)
    assert len(lines) == 1 and "valid_from 1.0E-06 s" in lines[0] and "cor changes by" in lines[0]
    assert said["beyond_data"] == lines[0]
    said, lines = heard(lambda: call(butyl(valid_from=1e-12, valid_to=1.0)), vcor.DataRangeWarning)
    assert lines == [] and said.get("beyond_data", "") == ""


@pytest.mark.parametrize("call", CALLS.values(), ids=list(CALLS))
def test_validity(call):
    said, lines = heard(lambda: call(butyl()), vcor.ValidityWarning)
    assert len(lines) == 1 and "outside (cor_deviation)" in lines[0]
    assert said["validity"] in lines[0]
    good = butyl()
    good["sphere.radius"], good["impact.velocity"] = 1e-3, 1e-3
    good["impact.gravity"] = 0.0
    low = {"impact.velocity": [1e-3, 2e-3]}
    found, lines = heard(lambda: good.points(low), vcor.ValidityWarning)
    worst = set(found.validity.values)
    assert (found.attrs["validity"] == "good") == (worst == {"good"}) == (lines == [])


@pytest.mark.parametrize("asked", ["validity", ["cor", "validity"]])
def test_who_asks_for_the_validity_is_not_warned(asked):
    for work in (
        lambda: butyl().solve(quantities=asked),
        lambda: butyl().points({"impact.velocity": [1.0, 2.0]}, asked),
        lambda: butyl().sweep({"impact.velocity": [1.0, 2.0]}, asked),
    ):
        assert heard(work, vcor.ValidityWarning)[1] == []
    assert heard(lambda: butyl().solve(quantities=["cor"]), vcor.ValidityWarning)[1] != []


@pytest.mark.parametrize("ball", ["elastic", "rigid", "same"])
@pytest.mark.parametrize("base", ["bonded", "sliding"])
def test_layers_on_a_base(ball, base):
    """Whatever the ball is of: the layer has no direct solution where both deform."""
    text = SHEET.replace("bonded", base)
    if ball == "rigid":
        text = text.replace("'elastic', modulus = 210e9, poisson_ratio = 0.3,", "'rigid',")
    if ball == "same":
        text = text.replace("material = 'ball' /", "material = 'sheet' /")
    case = vcor.Case(text)
    found, lines = heard(case.solve, vcor.DataRangeWarning)
    assert found["status"] == "separated" and found["contact_time"] < 3e-3
    assert len(lines) == 1 and "all of it lies before the data of 'sheet'" in lines[0]
    assert "cor changes by" in lines[0]


def test_temperatures():
    case = butyl()
    case["butyl.shift"], case["butyl.reference_temperature"] = "wlf", 300.0
    case["butyl.wlf_c1"], case["butyl.wlf_c2"] = 9.0, 89.0
    case["butyl.valid_temperature_to"] = 310.0
    case["impact.temperature"] = 330.0
    assert "outside of the data behind the shift" in heard(case.run, vcor.DataRangeWarning)[1][0]
    both = {"impact.temperature": [300.0, 330.0]}
    lines = heard(lambda: case.points(both), vcor.DataRangeWarning)[1]
    assert len(lines) == 1 and "1 of 2 temperatures lie outside" in lines[0]


def test_loops_ask_again_when_they_must():
    """Of one impact after another: a longer contact, a shorter one, another band."""
    case = butyl(valid_to=1e-3)
    # of those between two that have been examined is said what is said of these
    loop = ((10.0, False), (1e-3, True), (10.0, False), (0.1, True), (20.0, False), (1e-3, True))
    for velocity, beyond in loop:
        found, lines = heard(
            lambda v=velocity: case.solve({"impact.velocity": v}), vcor.DataRangeWarning
        )
        assert bool(lines) == bool(found.beyond_data) == beyond, velocity
    case["butyl.valid_to"] = 1e3
    assert case.solve({"impact.velocity": 1e-3}).beyond_data == ""
    case["butyl.valid_to"] = 1e-4
    assert case.solve().beyond_data != ""
    del case["butyl.valid_to"]
    for given, beyond in (({}, False), ({"butyl.valid_to": 1e-4}, True)):
        for address, value in given.items():
            case[address] = value
        assert beyond == bool(case.solve().beyond_data)


def test_what_is_said_of_a_case_is_said_of_no_other():
    """A copy and a pickled case are examined anew, with the ranges that they have by then."""
    case = butyl(valid_from=1e-6)
    assert case.solve().beyond_data != ""
    for other in (case.copy(), pickle.loads(pickle.dumps(case))):
        other["butyl.valid_from"] = 1e-12
        assert other.solve().beyond_data == "" and case.solve().beyond_data != ""


def test_warnings_can_be_filtered():
    case = butyl(valid_from=1e-6)
    assert issubclass(vcor.DataRangeWarning, UserWarning)
    assert issubclass(vcor.ValidityWarning, UserWarning)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        warnings.simplefilter("error", vcor.DataRangeWarning)
        with pytest.raises(vcor.DataRangeWarning):
            case.run()
    with warnings.catch_warnings(), unwarned():
        warnings.simplefilter("error")
        case.points(VELOCITY)
    found = case.solve()
    assert pickle.loads(pickle.dumps(found)).beyond_data == found.beyond_data


def test_the_same_as_of_the_file(program, tmp_path):
    program("run", PAPER / "sls.nml", "--output", tmp_path, "--quiet")
    validity = vcor.open(tmp_path / "sls.h5").attrs["validity"]
    assert validity == vcor.read(PAPER / "sls.nml").run().attrs["validity"] != "good"


@pytest.mark.parametrize("height", ["velocity = 1.0", "drop_height = 0.05"])
def test_result_of_no_separation(height):
    """The summary of the error has the status, whatever gives the velocity."""
    text = (PAPER / "sls.nml").read_text()
    case = vcor.Case(text.replace("velocity = 10.0", height).replace("velocity=10.0", height))
    case["solver.end_time"] = 1e-5
    with pytest.raises(vcor.NumericalError) as caught:
        case.run()
    assert caught.value.result["status"].item() == "no_separation"
    assert np.isnan(caught.value.result["cor"].item())


def test_a_list_of_one_number_is_a_list():
    text = (PAPER / "sls.nml").read_text()
    case = vcor.Case(
        text
        + """
&material name = 'm', model = 'prony', density = 1.0, poisson_ratio = 0.3,
   equilibrium_modulus = 1.0, moduli = 1e7, times = 1e-3 /
"""
    )
    assert case["m.moduli"] == [1e7] and case["m.times"] == [1e-3]
    assert case["m.moduli(1)"] == 1e7 and case["m.equilibrium_modulus"] == 1.0
    case["m.moduli"] = case["m.moduli"]
    assert case["m.moduli"] == [1e7]
