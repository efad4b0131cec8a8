"""Fits of the models: exact data give their parameters back, and standard errors are honest."""

import numpy as np
import pytest
from conftest import EVERYTHING

import vcor
from vcor.materials.fit import fit_samples, moduli_at
from vcor.materials.laws import LAWS, fit_law
from vcor.materials.misfit import are_alike
from vcor.materials.prony import fit_series
from vcor.materials.samples import Samples

#: Draws of noise, of each model
DRAWS = 40 if EVERYTHING else 20
TRUTH = {
    "sls": {"glassy_modulus": 15e6, "alpha": 300.0, "beta": 1200.0},
    "power_law": {"equilibrium_modulus": 2.28e6, "coefficient": 8.85e5, "exponent": 0.5},
    "cerf": {"equilibrium_modulus": 2.28e6, "relaxing_modulus": 676.5e6, "beta": 700.0},
    "mittag_leffler": {
        "equilibrium_modulus": 2.28e6, "relaxing_modulus": 676.5e6, "exponent": 0.62, "time": 2e-6,
    },
    "prony": {
        "equilibrium_modulus": 10.421e6, "moduli": [87.344e6, 38.204e6, 20.181e6],
        "times": [1 / 34221, 1 / 6426, 1 / 972],
    },
}  # fmt: skip


def sampled(model, first, last, n, dynamic=False, **changes):
    """Samples of a material."""
    keys = {"name": "m", "model": model, "poisson_ratio": 0.5} | TRUTH[model] | changes
    groups = {
        "impact": {"velocity": 1.0}, "sphere": {"radius": 1.0, "mass": 1.0, "material": "m"},
        "plate": {"material": "m", "waves": "none"}, "material": keys,
    }  # fmt: skip
    at = np.geomspace(first, last, n)
    at = 1 / at[::-1] if dynamic else at
    return Samples(at, moduli_at(vcor.Case(groups).material("m"), at, dynamic))


def usual(model, dynamic=False, **changes):
    """Samples over the decades in which a law relaxes."""
    first, last = (1e-5, 1e-2) if model == "sls" else (1e-9, 1e-1)
    return sampled(model, first, last, 41, dynamic, **changes)


def spoiled(samples, seed, noise=0.01):
    """The same with noise."""
    rng = np.random.default_rng(1000 + seed)
    factors = 1 + noise * rng.standard_normal(samples.moduli.shape)
    return Samples(samples.at, samples.moduli * factors)


@pytest.mark.parametrize("dynamic", [False, True])
@pytest.mark.parametrize("model", LAWS)
def test_exact_data_give_the_exact_parameters(model, dynamic):
    samples, truth = usual(model, dynamic), TRUTH[model]
    _, found = fit_law(model, {}, samples)
    assert found.values == pytest.approx(list(truth.values()), rel=1e-8)
    assert set(found.states) == {"free"}
    for i, (key, value) in enumerate(truth.items()):
        _, found = fit_law(model, {key: value}, samples)
        assert found.values == pytest.approx(list(truth.values()), rel=1e-8)
        assert [state == "fixed" for state in found.states] == [i == k for k in range(len(truth))]
        assert found.errors[i] == 0


@pytest.mark.parametrize("dynamic", [False, True])
@pytest.mark.parametrize("model", LAWS)
def test_the_truth_is_within_three_standard_errors(model, dynamic):
    """Of 300 draws 2 or 3 miss, and the errors are not too large either."""
    samples, truth = usual(model, dynamic), np.array(list(TRUTH[model].values()))
    missed, spread = 0, 0.0
    for seed in range(DRAWS):
        _, found = fit_law(model, {}, spoiled(samples, seed))
        distance = (found.values - truth) / found.errors
        missed += bool((np.abs(distance) > 3).any())
        spread += distance[-1] ** 2 / DRAWS
    assert missed <= 2
    # the mean of so many squares of normal numbers has the standard deviation `wide`
    wide = (2 / DRAWS) ** 0.5
    assert 1 - 2.7 * wide < spread < 1 + 4.1 * wide


@pytest.mark.parametrize(
    ("model", "changes", "band"),
    [
        ("mittag_leffler", {"equilibrium_modulus": 2.06e6, "relaxing_modulus": 1.11e8,
                            "exponent": 0.218, "time": 1e-3}, (1e-6, 1e-1, 40)),
        ("cerf", {"equilibrium_modulus": 3.5e5, "relaxing_modulus": 1.67e7, "beta": 6.0},
         (2.1e-7, 2.7e-3, 56)),
        ("sls", {"glassy_modulus": 2.26e7, "alpha": 195.0, "beta": 338.0}, (1.9e-7, 3e-4, 86)),
    ],
    ids=["small", "hardly_begun", "like_a_fluid"],
)  # fmt: skip
def test_parameters_at_the_edge_of_the_data(model, changes, band):
    """The sum of squares is not a parabola there, and a modulus or a rate vanishes in the noise."""
    samples, truth = sampled(model, *band, **changes), np.array(list(changes.values()))
    for seed in range(4 if EVERYTHING else 2):
        _, found = fit_law(model, {}, spoiled(samples, seed))
        assert (np.abs(found.values - truth) <= 3 * found.errors).all()


def test_a_parameter_that_vanishes_is_at_its_bound():
    samples = sampled("power_law", 1e-7, 1e-1, 61, equilibrium_modulus=0.0)
    _, found = fit_law("power_law", {}, samples)
    assert (found.values[0], found.states[0]) == (0.0, "bound")
    assert found.values[1:] == pytest.approx([8.85e5, 0.5], rel=1e-8)
    _, found = fit_law("sls", {}, sampled("sls", 1e-5, 1e-2, 61, alpha=0.0))
    assert (found.values[1], found.states[1]) == (0.0, "bound")
    # an exponent of 1, and a rate that tends to infinity
    _, found = fit_law("mittag_leffler", {}, usual("sls"))
    assert (found.values[2], found.states[2]) == (1.0, "bound")
    assert found.values[3] == pytest.approx(1 / 1200, rel=1e-8)
    _, found = fit_law("cerf", {}, usual("power_law"))
    assert found.states[2] == "bound" and (found.errors[1:] >= found.values[1:]).all()
    assert found.values[1] / found.values[2] == pytest.approx(8.85e5, rel=1e-3)


@pytest.mark.parametrize("dynamic", [False, True])
def test_a_series_is_found_again(dynamic):
    truth = TRUTH["prony"]
    series, found = fit_series(sampled("prony", 1e-6, 1e-1, 101, dynamic), None, None)
    assert series.moduli == pytest.approx(truth["moduli"], rel=1e-8)
    assert np.exp(series.times) == pytest.approx(truth["times"], rel=1e-8)
    assert found.values[0] == pytest.approx(10.421e6, rel=1e-8)
    _, given = fit_series(sampled("prony", 1e-6, 1e-1, 101, dynamic), 3, 10.421e6)
    assert (given.states[0], given.errors[0]) == ("fixed", 0.0)
    assert given.values == pytest.approx(found.values, rel=1e-8)


@pytest.mark.parametrize(("equilibrium", "last"), [(10.421e6, 1e-1), (1e3, 6e-3)])
def test_errors_of_a_series(equilibrium, last):
    """Of 300 draws 8 and 3 miss."""
    samples = sampled("prony", 1e-6, last, 101, equilibrium_modulus=equilibrium)
    truth, missed = TRUTH["prony"], 0
    values = [equilibrium, *np.ravel([truth["moduli"], truth["times"]], order="F")]
    for seed in range(30):
        _, found = fit_series(spoiled(samples, seed), 3, None)
        missed += bool((np.abs(found.values - values) > 3 * found.errors).any())
    assert missed <= 3


def test_a_series_follows_a_power_law_but_not_noise():
    samples = sampled("power_law", 1e-6, 1e-2, 81)
    series, _ = fit_series(samples, None, None)
    assert 8 <= len(series.times) <= 12 and np.abs(series.misfits).max() <= 1e-3
    noisy, found = fit_series(spoiled(samples, 1), None, None)
    assert 3 <= len(noisy.times) <= 7 and not found.structured
    assert np.sqrt(np.mean(noisy.misfits**2)) == pytest.approx(0.01, rel=0.25)
    few, found = fit_series(samples, 3, None)
    assert len(few.times) == 3 and found.structured


def test_modes_that_the_data_do_not_see_are_labelled():
    """Two terms within the data, and terms outside them."""
    t = np.geomspace(1e-5, 1e-2, 40)
    made = 1e6 + 5e6 * np.exp(-t / 1e-4) + 3e6 * np.exp(-t / 1e-3) + 2e6 * np.exp(-t / 2e-2)
    fit = fit_samples(Samples(t, made[None]), "data", terms=3)
    hidden = {one.term: one.hidden for one in fit.parameters if one.term}
    assert hidden == {1: "", 2: "", 3: "after the data"}
    seen = {one["name"]: one["seen"] for one in fit.as_dict()["parameters"]}
    assert seen["moduli(2)"] and not seen["moduli(3)"] and not seen["times(3)"]
    noise = 1 + 0.02 * np.random.default_rng(2).standard_normal(40)
    fit = fit_samples(Samples(t, (1e6 + 5e6 * np.exp(-t / 1e-3))[None] * noise), "data", terms=2)
    assert "not determined by the data" in {one.hidden for one in fit.parameters}


def test_noise_is_taken_for_structure_once_in_a_thousand():
    rng, n = np.random.default_rng(1), 4000 if EVERYTHING else 1000
    # so many more than one in a thousand are one in a thousand of such tests
    most = 14 if EVERYTHING else 5
    for m in (12, 30, 80):
        x = np.linspace(-1, 1, m)
        basis = np.vander(x, 4)
        q = np.linalg.qr(np.concatenate([basis, basis]))[0]
        # noise that storage and loss modulus share
        draws = np.tile(rng.standard_normal((n, m)), 2)
        draws = draws - draws @ q @ q.T
        assert sum(are_alike(r, np.concatenate([basis, basis]), 2) for r in draws) <= most
        alone = np.linalg.qr(basis)[0]
        draws = rng.standard_normal((n, m))
        draws -= draws @ alone @ alone.T
        assert sum(are_alike(r, basis) for r in draws) <= most
    waves = np.tile(np.cos(6 * x), 2)
    waves -= q @ (q.T @ waves)
    assert are_alike(waves, np.concatenate([basis, basis]), 2)
    assert sum(are_alike(r + 3 * np.sin(10 * x), basis) for r in draws[:100]) >= 98
    # each of two curves that overlap errs by itself
    own = np.arange(m) % 2
    both = draws[:100] + np.where(own, 2.0, -2.0)
    assert sum(are_alike(r, basis, 1, own) for r in both) >= 98
    assert sum(are_alike(r, basis, 1, own) for r in draws) <= most
    assert sum(are_alike(r, basis) for r in both) == 0
    assert not are_alike(np.zeros(m), basis) and not are_alike(draws[0, :6], basis[:6])


@pytest.mark.parametrize("dynamic", [False, True])
def test_a_damaged_value_is_a_misfit(dynamic):
    samples = usual("sls", dynamic)
    samples.moduli[-1, 3] *= 1e12
    fit = fit_samples(samples, "data", model="sls")
    assert not fit.follows and abs(fit.largest) > 0.5
