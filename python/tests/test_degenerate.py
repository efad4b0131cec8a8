"""Data that cannot determine what is asked are refused, whatever the model and the digits."""

import re

import numpy as np
import pytest
from properties import HealthCheck, given, settings, st

import vcor
from vcor.materials.noise import Noise
from vcor.materials.observations import last_digit

# Those of test_identify.py find the least of several minima
pytestmark = pytest.mark.usefixtures("few_starts")

CASE = """&impact velocity = 3.0{impact} /
&sphere radius = 0.01{sphere}, material = 'steel' /
&plate half_thickness = 0.02, material = 'rubber', waves = '{waves}' /
&contact law = 'receding' /
&material name = 'steel', model = 'rigid', density = 7800 /
&material name = 'rubber', density = 1100, poisson_ratio = 0.45, {material} /
"""
MODELS = {
    "sls": "model = 'sls', glassy_modulus = 4.2e7, alpha = 300.0, beta = 1200.0",
    "prony": "model = 'prony', equilibrium_modulus = 4e6, moduli = 1.5e7, times = 5e-4",
    "voigt": "model = 'prony', equilibrium_modulus = 5e6, viscosity = 400.0",
    "power_law": "model = 'power_law', equilibrium_modulus = 3e6, coefficient = 2e5,"
    " exponent = 0.45",
    "power_law_alone": "model = 'power_law', coefficient = 2e5, exponent = 0.3",
    "cerf": "model = 'cerf', equilibrium_modulus = 2e6, relaxing_modulus = 2e7, beta = 30.0",
}
FREE = {
    "sls": "glassy_modulus alpha beta",
    "prony": "equilibrium_modulus moduli(1) times(1)",
    "voigt": "equilibrium_modulus viscosity",
    "power_law": "equilibrium_modulus coefficient exponent",
    "power_law_alone": "coefficient exponent",
    "cerf": "equilibrium_modulus relaxing_modulus beta",
}
WLF = {"impact": ", temperature = 310.0", "shift": ", shift = 'wlf',"
       " reference_temperature = 298.15, wlf_c1 = 8.6, wlf_c2 = 190.4"}  # fmt: skip
ARRHENIUS = {"impact": ", temperature = 310.0", "shift": ", shift = 'arrhenius',"
             " reference_temperature = 298.15, activation_energy = 6e4"}  # fmt: skip
#: What is free besides the material, what is measured, and what is different in the case
KINDS = {
    "velocity": ([], ["cor"], {}),
    "mass": (["sphere.mass"], ["cor", "contact_time"], {"sphere": ", mass = 0.03"}),
    "radius": (["sphere.radius"], ["cor", "contact_time"], {}),
    "ratio": (["rubber.poisson_ratio"], ["cor", "contact_time"], {}),
    "wlf": (["rubber.wlf_c1", "rubber.wlf_c2"], ["cor", "contact_time"], WLF),
    "energy": (["rubber.activation_energy"], ["cor", "contact_time"], ARRHENIUS),
}


def trial(model, kind, digits, seed):
    """A case with a wrong guess, data of the true one, and the true values."""
    more, names, changes = KINDS[kind]
    fields = {"impact": "", "sphere": "", "waves": "none", "shift": "", **changes}
    shift = fields.pop("shift")
    case = vcor.Case(CASE.format(material=MODELS[model] + shift, **fields))
    free = [f"rubber.{key}" for key in FREE[model].split()] + more
    return case, *measured(case, free, names, digits, seed)


def measured(case, free, names, digits, seed, n=5):
    """Data of a case, rounded or with noise, and its values, which become another guess."""
    truth = {a: float(np.atleast_1d(case[a])[0]) for a in free}
    exact = case.copy()
    exact["solver.accuracy"] = 1e-11
    velocity = np.geomspace(0.3, 20, n)
    found = exact.points({"impact.velocity": velocity}, names, progress=False)
    rng = np.random.default_rng(seed)
    data = {"velocity": velocity}
    for name in names:
        column = found[name].values
        if digits == "noise":
            column = column * (1 + 0.01 * rng.normal(size=len(column)))
        elif digits:
            column = np.array([float(f"{value:.{digits - 1}e}") for value in column])
        data[name] = column
    for address, value in truth.items():
        narrow = re.search("exponent|ratio", address)
        case[address] = value * rng.uniform(0.9, 1.05) if narrow else value * rng.uniform(0.7, 1.5)
    return data, free, truth


@settings(max_examples=8, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.data())
def test_what_data_cannot_determine_is_refused(data):
    model = data.draw(st.sampled_from(list(MODELS)))
    # the shift is tried where all of the material's times are parameters
    kinds = [k for k in KINDS if model in ("sls", "prony") or k not in ("wlf", "energy")]
    kind = data.draw(st.sampled_from(kinds))
    digits = data.draw(st.sampled_from([None, 10, 7, 3, "noise"]))
    case, table, free, _ = trial(model, kind, digits, data.draw(st.integers(0, 99)))
    with pytest.raises(vcor.NumericalError, match="do not determine") as caught:
        vcor.identify(case, table, free)
    assert "\n" not in str(caught.value)


@settings(max_examples=3, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.sampled_from(["sls", "prony", "power_law", "cerf"]), st.integers(0, 99))
def test_rounded_data_that_determine_it_give_the_truth(model, seed):
    case, table, free, truth = trial(model, "mass", 4, seed)
    case["sphere.mass"] = truth.pop(free.pop())
    found = vcor.identify(case, table, free)
    for one in found.estimates:
        # within twice a 95 % interval, that no seed fails
        (low, high), value = one.interval_95, one.value
        assert value * (low / value) ** 2 <= truth[one.address] <= value * (high / value) ** 2


@pytest.mark.parametrize(
    ("free", "shift"),
    [
        (["rubber.times(1)", "rubber.activation_energy"], ARRHENIUS),
        (["rubber.reference_temperature", "rubber.activation_energy"], ARRHENIUS),
        (["rubber.times(1)", "rubber.wlf_c1"], WLF),
        (["rubber.wlf_c1", "rubber.wlf_c2"], WLF),
    ],
)
@pytest.mark.parametrize(("digits", "count"), [(None, 10), (3, 5)])
def test_one_temperature_fixes_one_constant_of_a_shift(free, shift, digits, count):
    fields = {"sphere": "", "waves": "none", "impact": shift["impact"]}
    case = vcor.Case(CASE.format(material=MODELS["prony"] + shift["shift"], **fields))
    truth = {address: float(np.atleast_1d(case[address])[0]) for address in free}
    data, *_ = measured(case, free, ["cor"], digits, 1, n=count)
    for address, value in truth.items():
        case[address] = value * (1.004 if "reference" in address else 0.8)
    with pytest.raises(vcor.NumericalError, match="do not determine"):
        vcor.identify(case, data, free)


@pytest.mark.parametrize("kelvin", [285.0, 310.0])
def test_a_shift_is_not_determined_to_either_side_of_its_reference(kelvin):
    """Few digits and few data: the search ends far from the guess, from where E seems limited."""
    fields = {"sphere": "", "waves": "none", "impact": f", temperature = {kelvin}"}
    case = vcor.Case(CASE.format(material=MODELS["prony"] + ARRHENIUS["shift"], **fields))
    free = ["rubber.reference_temperature", "rubber.activation_energy"]
    data, *_ = measured(case, free, ["cor"], 3, 0, n=3 if kelvin < 300 else 5)
    case[free[0]], case[free[1]] = 299.3, 4.8e4
    with pytest.raises(vcor.NumericalError, match="do not determine rubber.reference_temperature"):
        vcor.identify(case, data, free)


def test_one_number_of_a_plate_fixes_no_two_of_its_parameters():
    fields = {"impact": "", "sphere": "", "waves": "relaxing"}
    case = vcor.Case(CASE.format(material=MODELS["power_law"], **fields))
    free = ["rubber.density", "plate.half_thickness"]
    data, *_ = measured(case, free, ["cor"], None, 3)
    with pytest.raises(vcor.NumericalError) as caught:
        vcor.identify(case, data, free)
    # alpha goes with the root of the density and the square of the thickness
    assert "they fix rubber.density^0.25*plate.half_thickness;" in str(caught.value)


def test_the_number_of_parameters_to_fix_is_said():
    case, data, free, _ = trial("sls", "wlf", 3, 1)
    with pytest.raises(vcor.NumericalError, match="fix 2 of them"):
        vcor.identify(case, data, free)


def test_equal_numbers_have_one_rounding_error():
    """A coefficient of 0.528 at ten velocities says of an exponent what one such number says."""
    case = vcor.Case(CASE.format(material=MODELS["power_law_alone"], impact="", sphere="",
                                 waves="none"))  # fmt: skip
    data, *_ = measured(case, ["rubber.exponent"], ["cor"], 3, 1)
    case["rubber.coefficient"] = 2e5
    assert len(set(data["cor"])) == 1
    found = vcor.identify(case, data, ["rubber.exponent"]).estimates[0]
    slope = float(vcor.sensitivities(case, ["rubber.exponent"], ["cor"]).item())
    error = 1e-3 / np.sqrt(12) / abs(slope) / data["cor"][0]
    assert found.standard_error / found.value == pytest.approx(error, rel=0.05)
    assert found.interval_95[0] < 0.3 < found.interval_95[1]


@pytest.mark.parametrize(
    ("values", "units"),
    [
        ([0.528, 0.53, 0.6], [1e-3, 1e-3, 1e-3]),
        ([1.94e-3, 8.9e-4, 2e-3], [1e-5, 1e-5, 1e-5]),
        ([1.94e-3, 8.93e-4, 2e-3], [1e-5, 1e-6, 1e-5]),
        ([12.34, 5.67, np.nan], [0.01, 0.01, np.nan]),
        ([0.0, 120.5, 3.0], [0.1, 0.1, 0.1]),
        ([0.559 * 1e-3, 0.581 * 1e-3], [1e-6, 1e-6]),
        ([np.nan], [np.nan]),
    ],
)
def test_the_last_digit_of_a_column(values, units):
    assert last_digit(np.array(values)) == pytest.approx(np.array(units), rel=1e-9, nan_ok=True)


class Column:
    """Ten data of 1 with three decimals, without an error of their own."""

    quantity, source = ["cor"] * 10, "data"
    value = scale = np.ones(10)
    digit, at, sigma = np.full(10, 1e-3), np.arange(10.0), np.full(10, np.nan)


def test_the_scatter_is_what_the_floor_does_not_explain():
    noise, model = Noise([Column], {}), np.full(10, 1e-9)
    ripple = 0.01 * np.resize([1.0, -1.0], 10)
    assert noise.scatter(ripple, model, 10) == pytest.approx(0.01, rel=1e-3)
    assert noise.scatter(1e-4 * ripple, model, 10) == 0.0
    assert noise.sigma(0.0, model)[0] == pytest.approx(1e-3 / np.sqrt(12) * np.sqrt(10))
    assert noise.sigma(1.0, model)[0] == pytest.approx(1.0, rel=1e-6)


def test_a_covariance_with_a_free_direction_is_refused():
    case = vcor.Case(CASE.format(material=MODELS["sls"], impact="", sphere="", waves="none"))
    values = [4.2e7, 300.0, 1200.0]
    loose = np.outer([1, 0.4, 0.4], [1, 0.4, 0.4]) * 4.0 + 1e-6 * np.eye(3)
    names = [f"rubber.{key}" for key in FREE["sls"].split()]
    rows = [
        {"name": n, "value": v, "standard_error": v} for n, v in zip(names, values, strict=True)
    ]
    document = {"parameters": rows, "covariance": loose * np.outer(values, values)}
    with pytest.raises(vcor.NumericalError, match=r"not determine rubber.glassy_modulus\*"):
        vcor.propagate(case, covariance=document, samples=64)
    document["covariance"] = 1e-4 * document["covariance"]
    vcor.propagate(case, covariance=document, samples=64, quantities=["cor"])
