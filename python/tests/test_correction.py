"""Exact results from corrected thin ones: polynomials, samples and bands against solved samples."""

import copy
import json
import re
import types
import warnings

import numpy as np
import pandas as pd
import pytest
from conftest import EVERYTHING, FEW, PAPER, ROOT, long_tests

import vcor
from vcor import _command, uncertainty_samples
from vcor._correction import Coordinates, Correction, parts_of
from vcor._kriging import Kriged
from vcor.materials import identification_exact, search
from vcor.materials.limits import Fit
from vcor.materials.observations import observations
from vcor.materials.search import Problem
from vcor.uncertainty import Drawn, _propagate
from vcor.uncertainty_samples import ACCURATE, sampled
from vcor.uncertainty_sweep import _bands

EXAMPLES = ROOT / "examples"
QUANTITIES = ["cor_sphere", "contact_time", "max_force"]
#: Error of a sample over its estimate from twenty of them, with the tails beyond these
TAILS = 3.0


@pytest.fixture(autouse=True)
def quiet():
    """Verdicts of the impacts are not what is tested."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        yield


def coordinates(*uniform, weight=1, most=8):
    n = len(uniform)
    return Coordinates(np.array(uniform), np.full(n, weight), np.full(n, most))


def test_polynomials_are_orthonormal():
    """By Gauss's rules: normal and uniform coordinates, all products up to the fourth degree."""
    x, w = np.polynomial.hermite_e.hermegauss(8)
    y, v = np.polynomial.legendre.leggauss(8)
    z = np.stack(np.meshgrid(x, np.sqrt(3) * y), axis=-1).reshape(-1, 2)
    weights = np.outer(v / v.sum(), w / w.sum()).ravel()
    both = coordinates(False, True)
    values = both.values(z, both.terms(4))
    assert values.shape[1] == 15
    assert np.allclose(values.T @ (weights[:, None] * values), np.eye(15), atol=1e-12)


def test_terms_by_their_weights():
    along = Coordinates(np.array([False, True]), np.array([2, 1]), np.array([8, 3]))
    found = {tuple(one) for one in along.terms(5).tolist()}
    assert found == {(0, 0), (0, 1), (0, 2), (0, 3), (1, 0), (1, 1), (1, 2), (1, 3), (2, 0), (2, 1)}


def test_ratios_and_differences_are_found_by_what_is_left_out():
    """A product and a sum with a rough result are met to rounding, one with its zeros too."""
    rng = np.random.default_rng(5)
    z = rng.standard_normal((60, 2))
    wave = np.exp(np.sin(3 * z[:, 0]))
    rough = np.stack([wave, wave, np.sin(9 * z[:, 0])])
    smooth = 2 + z[:, 0] * z[:, 1] - 0.3 * z[:, 1] ** 2
    exact = np.stack([rough[0] * smooth, rough[1] + smooth, rough[2] + smooth]).T
    first = np.array([[1.0, 2.0, 3.0]])
    thin_0 = np.array([[1.0, 0.5, 2.0]])
    parts = parts_of("thin", rough.T, thin_0, first)
    found = Correction.fitted(coordinates(False, False), z[:40], exact[:40] / first,
                              {key: one[:40] for key, one in parts.items()})  # fmt: skip
    assert found.keys == [("thin", True), ("thin", False), ("thin", False)]
    left = {key: one[40:] for key, one in parts.items()}
    assert np.allclose(found.results(z[40:], left) * first, exact[40:], rtol=1e-9)


def test_what_thin_mechanics_do_not_have_is_not_used():
    z = np.random.default_rng(2).standard_normal((40, 1))
    exact = 1 + z + z**2
    parts = parts_of("thin", np.where(z > 1, np.nan, exact), np.ones((1, 1)), np.ones((1, 1)))
    found = Correction.fitted(coordinates(False), z, exact, parts)
    assert found.keys == [None] and np.allclose(found.results(z, {}), exact)


def vary_of(case, **more):
    """Spreads of an impact, its body and its plate, and of a modulus and a time."""
    plate = case["plate.material"]
    spreads = {
        "sphere.radius": "3%",
        f"{plate}.density": "3%",
        f"{plate}.poisson_ratio": "0.4:0.49",
    }
    drop = case["impact.drop_height"] is not None
    spreads["impact.drop_height" if drop else "impact.velocity"] = "5%"
    for key in ("glassy_modulus", "equilibrium_modulus", "coefficient", "beta", "moduli(1)"):
        if f"{plate}.{key}" in case and case[f"{plate}.{key}"]:
            spreads[f"{plate}.{key}"] = "10%"
    return spreads | more


def thin_case(file, **settings):
    case = vcor.read(EXAMPLES / file)
    case[f"{case['plate.material']}.poisson_ratio"] = 0.45
    for address, value in settings.items():
        case[address.replace("__", ".")] = value
    return case


@pytest.mark.parametrize(("file", "settings"), [
    ("paper/sls.nml", {}), ("paper/butyl_prony.nml", {"plate__waves": "constant"}),
    ("paper/butyl_power_law.nml", {}), ("paper/butyl_cerf.nml", {"contact__law": "receding"}),
    ("glass_bead_on_pmma.nml", {"plate__waves": "relaxing"}),
    *long_tests(("paper/sls.nml", {"contact__law": "receding"}),
                ("paper/sls.nml", {"plate__waves": "constant"}),
                ("paper/sls.nml", {"impact__velocity": 0.5}),
                ("paper/butyl_prony.nml", {}), ("paper/butyl_cerf.nml", {})),
])  # fmt: skip
def test_corrected_samples_are_those_that_are_solved(file, settings):
    """Ten thin cases from others without their waves, or with those of other laws."""
    case = thin_case(file, **settings)
    one, two = (
        _propagate(case, vary_of(case), None, 1024, QUANTITIES, 1, None, corrected)
        for corrected in (True, False)
    )
    assert one.fresh == 20 < one.solved < two.solved == two.samples and two.fresh == 0
    assert (one.table.correction <= ACCURATE).all() and (two.table.correction == 0).all()
    for key in ("first", "total"):
        off = np.abs(one.table[key] - two.table[key])
        assert (off <= two.table[f"{key}_error"] + 1e-12).all()
        # the samples are the same, so that indices differ by much less than those of others do
        assert off.max() <= TAILS * ACCURATE
    deviation = two.table.material
    for key in ("mean", "percentiles", "swing"):
        assert (np.abs(one.table[key] - two.table[key]) <= TAILS * ACCURATE * deviation).all()
    assert (one.table["value"] == two.table["value"]).all()
    assert (one.table.elasticity == two.table.elasticity).all()


def test_the_stated_error_is_that_of_all_samples():
    case = thin_case("paper/butyl_prony.nml")
    drawn = Drawn.of(case, vary_of(case), None, 1024, QUANTITIES, 3)
    one, two = (
        sampled([drawn.plan], QUANTITIES, 3, None, corrected) for corrected in (True, False)
    )
    deviation = two.found[0].std(axis=0)
    error = np.sqrt(np.mean(((one.found[0] - two.found[0]) / deviation) ** 2, axis=0))
    assert (error < TAILS * one.error).all() and (error > one.error / TAILS).all()


def test_wide_spreads_take_more_impacts():
    """Until the error is small enough."""
    case = thin_case("paper/sls.nml")
    vary = {"impact.velocity": "0.5:20", "rubber.beta": "350:5000"}
    narrow, wide = (
        _propagate(case, one, None, 4096, ["cor_sphere"], 1, None, True)
        for one in (dict.fromkeys(vary, "2%"), vary)
    )
    assert narrow.solved < wide.solved and wide.fresh == 20
    solved = _propagate(case, vary, None, 4096, ["cor_sphere"], 1, None, False)
    off = np.abs(wide.table.percentiles - solved.table.percentiles)
    assert (off < TAILS * ACCURATE * solved.table.material).all()


def test_what_jumps_is_not_corrected():
    """A whole number of steps does not follow the parameters."""
    case = thin_case("paper/butyl_power_law.nml")
    vary = {"butyl.coefficient": "0.5e6:5e6", "impact.velocity": "0.1:20"}
    found = _propagate(case, vary, None, 512, ["cor", "steps"], 1, None, True)
    assert found.fresh == 0 and found.solved == found.samples


def test_impacts_without_a_result_are_not_corrected():
    """A few samples outlast the end time: all are solved, and these are lost."""
    case = thin_case("paper/sls.nml")
    times = _propagate(case, {"rubber.beta": "20%"}, None, 512, ["contact_time"], 1, None, False)
    case["solver.end_time"] = float(times.table.percentiles.sel(percent=97.5).item())
    found = _propagate(case, {"rubber.beta": "20%"}, None, 512, ["contact_time"], 1, None, True)
    assert found.fresh == 0 and 0 < found.lost < 0.1 * found.samples


def test_values_that_make_no_impact_are_lost_alone():
    """As many as of samples that are solved, and the others are corrected."""
    case = thin_case("paper/sls.nml")
    case["rubber.poisson_ratio"] = 0.49
    one, two = (
        _propagate(case, {"rubber.poisson_ratio": "0.006", "rubber.beta": "5%"}, None, 1024,
                   ["cor"], 1, None, corrected)
        for corrected in (True, False)
    )  # fmt: skip
    assert one.lost == two.lost > 0 and one.fresh == 20


def test_contacts_are_not_mixed():
    """Impacts of one contact and of two are no neighbours."""
    case = thin_case("paper/sls.nml")
    drawn = Drawn.of(case, {"rubber.beta": "5%"}, None, 64, ["cor"], 1)
    made = uncertainty_samples._Corrected([drawn.plan], ["cor"], 1, None)
    points = made._points(lambda n: np.linspace(0.1, 0.9, n)[:, None], 9)
    assert made._are_smooth(points)
    points.exact[3, made.columns.index("contacts")] = 2
    assert not made._are_smooth(points)
    points.exact[3, made.columns.index("contacts")] = 1
    points.exact[4, made.columns.index("status")] = 1
    assert not made._are_smooth(points)


@pytest.mark.parametrize(("spread", "is_smooth"), [("0.0005", True), ("0.0023", False)])
def test_a_block_that_is_struck_again_is_not_corrected(monkeypatch, spread, is_smooth):
    """Below 49 g the block of 55 g comes back to the ball: one sample in a hundred does, and thin
    mechanics of all samples show it."""
    case = vcor.Case({
        "impact": {"velocity": 1.0}, "sphere": {"radius": 0.01, "material": "steel"},
        "plate": {"material": "steel", "waves": "body"},
        "target": {"body": "block", "mass": 0.055, "stiffness": 1e6},
        "material": {"name": "steel", "model": "elastic", "modulus": 2.1e11, "density": 7850.0,
                     "poisson_ratio": 0.3},
    })  # fmt: skip
    said = []
    monkeypatch.setattr(uncertainty_samples, "say", lambda *words: said.append(words[3:]))
    drawn = Drawn.of(case, {"target.mass": spread}, None, 192, ["cor_sphere"], 1)
    found = sampled([drawn.plan], ["cor_sphere"], 1, None)
    thin = case.copy()
    thin["plate.waves"] = "none"
    mass = drawn.plan.place(drawn.plan.z)[:, 0]
    contacts = thin.points({"target.mass": mass}, ["contacts"]).contacts.values
    assert (np.ptp(contacts) == 0) == is_smooth
    assert (found.fresh == 20) == is_smooth and (found.solved == len(mass)) != is_smooth
    # all samples of one contact have a result, those of two have none of their own here
    assert (np.isfinite(found.found[0][:, 0]) == (contacts == 1)).all()
    reasons = [words[0] for words in said if words]
    assert is_smooth == (not reasons) and all("samples" in one for one in reasons)


def test_bands_by_one_correction():
    """Of all points of a sweep at once, against samples that are solved at each."""
    case = thin_case("paper/sls.nml")
    vary = {"rubber.beta": "5%", "rubber.glassy_modulus": "5%", "impact.velocity": "2%"}
    case = vcor.Case(case.text() + "&sweep parameter = 'impact.velocity', start = 1.0, stop = 20.0,"
                     " count = 7, spacing = 'log' /\n")  # fmt: skip
    one, two = (
        _bands(case, vary, None, 512, QUANTITIES, 1, None, corrected) for corrected in (True, False)
    )
    assert one.points[0].fresh == 20 and one.points[0].solved < 7 * 100
    assert "samples" in one.table.attrs and "samples" not in two.table.attrs
    for name in QUANTITIES:
        deviation = two.table[f"{name}_material"]
        for end in ("2.5", "50", "97.5"):
            off = np.abs(one.table[f"{name}_p{end}"] - two.table[f"{name}_p{end}"])
            assert (off <= TAILS * ACCURATE * deviation).all()
    for first, second in zip(one.points, two.points, strict=True):
        assert np.allclose(first.table.total, second.table.total, atol=TAILS * ACCURATE)


def test_a_covariance_is_corrected(tmp_path):
    """Parameters that move together are coordinates of their own."""
    case = thin_case("paper/sls.nml")
    values = np.array([1.5e7, 300.0, 1200.0])
    shape = np.array([[4.0, 3.0, 1.0], [3.0, 9.0, 2.0], [1.0, 2.0, 6.0]]) * 1e-4
    source = {
        "name": "rubber",
        "parameters": [{"name": name, "value": value} for name, value in
                       zip(["glassy_modulus", "alpha", "beta"], values, strict=True)],
        "covariance": (shape * np.outer(values, values)).tolist(),
    }  # fmt: skip
    one, two = (
        _propagate(case, {"impact.velocity": "2%"}, source, 1024, ["cor"], 1, None, corrected)
        for corrected in (True, False)
    )
    assert one.fresh == 20
    assert np.allclose(one.table.total, two.table.total, atol=TAILS * ACCURATE)
    assert np.allclose(one.table.swing, two.table.swing, rtol=1e-3)


@pytest.mark.usefixtures("no_figures")
def test_an_exact_impact(tmp_path, capsys):
    """The report, the JSON and the attributes say from how many exact impacts, and how good."""
    words = [str(EXAMPLES / "sls_exact.nml"), "--vary", "rubber.beta=5%", "--vary",
             "impact.velocity=2%", "--quantity", "cor_sphere,max_force", "--samples", "512",
             "--output", str(tmp_path)]  # fmt: skip
    _command.call("uncertainty", words)
    said = capsys.readouterr().out
    number = re.search(r"correction from (\d+) exact impacts, 20 of which it does not know", said)
    document = json.loads((tmp_path / "sls_exact_uncertainty.json").read_text())
    assert document["solved"] == int(number[1]) == 52 and document["fresh"] == 20
    assert document["samples"] == 512
    for one in document["quantities"].values():
        assert 0 < one["correction"] < ACCURATE
    # samples that are solved
    case = vcor.read(EXAMPLES / "sls_exact.nml")
    vary = {"rubber.beta": "5%", "impact.velocity": "2%"}
    drawn = Drawn.of(case, vary, None, 512, ["cor_sphere", "max_force"], 1)
    found = sampled([drawn.plan], drawn.quantities, 1, None)
    rows = [0, 100, 200, 300]
    solved = case._solve(list(vary), drawn.plan.place(drawn.plan.z[rows]), drawn.quantities, 0)[0]
    deviation = found.found[0].std(axis=0)
    assert (np.abs(found.found[0][rows] - solved) < TAILS * ACCURATE * deviation).all()


BALL_ON_LAYER = """
&impact velocity = 5.0 /
&sphere radius = 0.01, material = 'steel' /
&plate material = 'rubber', thickness = 0.03, base = 'bonded' /
&contact mechanics = 'exact' /
&material name = 'steel', model = 'elastic', modulus = 2.1e11, density = 7850.0,
   poisson_ratio = 0.3 /
&material name = 'rubber', model = 'sls', glassy_modulus = 1.5e7, alpha = 300.0, beta = 1200.0,
   poisson_ratio = 0.45, density = 1100.0 /
"""


def test_a_ball_that_deforms_on_a_layer_that_relaxes():
    """Thin mechanics have none; of a rigid one they do, without its modulus."""
    case = vcor.Case(BALL_ON_LAYER)
    vary = {"rubber.poisson_ratio": "1%", "rubber.beta": "5%", "steel.modulus": "20%"}
    (thin,) = uncertainty_samples.thin_cases(case, list(vary)).values()
    assert thin.reads.tolist() == [True, True, False] and thin.case["steel.model"] == "rigid"
    assert case["steel.model"] == "elastic"
    drawn = Drawn.of(case, vary, None, 512, ["cor_sphere", "max_force"], 1)
    found = sampled([drawn.plan], drawn.quantities, 1, None)
    assert found.fresh == 20 and found.solved < 100
    rows = [0, 100, 200]
    solved = case._solve(list(vary), drawn.plan.place(drawn.plan.z[rows]), drawn.quantities, 0)[0]
    deviation = found.found[0].std(axis=0)
    assert (np.abs(found.found[0][rows] - solved) < TAILS * ACCURATE * deviation).all()


def test_values_beyond_a_range_that_thin_mechanics_do_not_read():
    """They are no impacts, which a correction would not know: every sample is solved."""
    case = vcor.Case(BALL_ON_LAYER)
    case["steel.poisson_ratio"] = 0.49
    drawn = [
        Drawn.of(case, {"steel.poisson_ratio": spread}, None, 256, ["cor_sphere"], 1)
        for spread in ("0.005", "0.001")
    ]
    made = [uncertainty_samples._Corrected([one.plan], ["cor_sphere"], 1, None) for one in drawn]
    assert [one._are_in_range() for one in made] == [False, True]


@pytest.mark.usefixtures("no_figures")
def test_files_of_exact_bands_say_how(tmp_path, capsys):
    case = vcor.read(EXAMPLES / "sls_exact.nml").text()
    (tmp_path / "a.nml").write_text(
        case + "&sweep parameter = 'impact.velocity', values = 0.2, 0.3, 0.4 /\n"
    )
    words = [str(tmp_path / "a.nml"), "--vary", "rubber.beta=5%", "--quantity", "cor_sphere",
             "--samples", "256", "--output", str(tmp_path)]  # fmt: skip
    _command.call("uncertainty", words)
    said = capsys.readouterr().out
    (said,) = (line for line in said.splitlines() if line.startswith("by thin mechanics"))
    assert "with a correction from 52 exact impacts" in said
    assert f"# samples: {said}\n" in (tmp_path / "a_uncertainty.csv").read_text()
    assert vcor.open(tmp_path / "a_uncertainty.h5").attrs["samples"] == said
    assert len(pd.read_csv(tmp_path / "a_uncertainty.csv", comment="#")) == 3


@pytest.mark.skipif(not EVERYTHING, reason="takes long: scripts/test_long.sh")
@pytest.mark.parametrize(("file", "keys"), [
    (EXAMPLES / "sls_exact.nml", ("beta", "glassy_modulus")),
    (EXAMPLES / "rubber_pad_on_steel.nml", ("equilibrium_modulus", "moduli(3)")),
])  # fmt: skip
def test_exact_indices_are_those_of_solved_samples(file, keys):
    case = vcor.read(file)
    case["contact.mechanics"] = "exact"
    vary = {"impact.velocity": "3%", "plate.thickness": "3%"} if "pad" in file.name else {
        "impact.velocity": "3%", "plate.half_thickness": "3%"}  # fmt: skip
    vary |= {f"rubber.{key}": "10%" for key in keys}
    one, two = (
        _propagate(case, vary, None, 1024, QUANTITIES, 1, None, corrected)
        for corrected in (True, False)
    )
    assert one.fresh == 20 and one.solved < 200
    for key in ("first", "total"):
        assert (np.abs(one.table[key] - two.table[key]) <= two.table[f"{key}_error"] + 1e-3).all()
    off = np.abs(one.table.percentiles - two.table.percentiles)
    assert (off <= TAILS * ACCURATE * two.table.material).all()


def test_paper_cases_keep_their_samples():
    """Cheap mechanics are solved at every sample."""
    found = vcor.propagate(PAPER / "sls.nml", {"rubber.beta": "5%"}, samples=128)
    assert found.solved == found.samples and found.fresh == 0 and "correction" not in str(found)


def exact_drops(velocities, **settings):
    """A case with exact mechanics and its data without noise, with errors of 1 %."""
    case = vcor.read(EXAMPLES / "sls_exact.nml")
    for address, value in settings.items():
        case[address.replace("__", ".")] = value
    names = ["cor_sphere", "contact_time"]
    found = case.points({"impact.velocity": velocities}, names)
    data = {"velocity": velocities}
    for name in names:
        data |= {name: found[name].values, f"{name}_sigma": 0.01 * found[name].values}
    return case, data


@pytest.mark.usefixtures("few_starts")
def test_identification_with_exact_mechanics():
    """The parameters that data were made with, at the minimum of exact impacts, and how good."""
    case, data = exact_drops(np.array([0.1, 0.3, 0.9]))
    free = ["rubber.glassy_modulus", "rubber.beta"]
    guess = case.copy()
    guess["rubber.glassy_modulus"], guess["rubber.beta"] = 1e7, 1800.0
    found = vcor.identify(guess, data, free)
    for one in found.estimates:
        # noise-free data: what is off is the error of the correction and of the minimum
        assert abs(one.value - case[one.address]) < 0.01 * one.standard_error
        low, high = one.interval_95
        assert low < case[one.address] < high
    # a guess, four solutions, two rows beside the last one, it and the four ends of intervals
    assert found.fresh == 3 * 5 and found.solved <= 3 * (1 + 4 + 2 + 5)
    assert 0 < found.correction < 0.01 and found.chi2 < 1e-3
    assert f"with a correction from {found.solved} exact impacts" in str(found)
    assert found.as_dict()["solved"] == found.solved
    # the band is that of the exact impacts
    middle = (np.array(found.band["low"]) + np.array(found.band["high"])) / 2
    case["rubber.glassy_modulus"], case["rubber.beta"] = (found[one] for one in free)
    speed = found.band["velocity"][20]
    wanted = case.solve({"impact.velocity": speed}, ["cor"])["cor"]
    name = "cor_sphere" if "cor_sphere" in found.band else "cor"
    assert found.band[name][20] == pytest.approx(wanted, abs=1e-4)
    assert middle[20] == pytest.approx(wanted, abs=1e-4)


@pytest.mark.usefixtures("few_starts")
def test_the_minimum_is_that_of_exact_impacts():
    """Of coefficients with noise; with one correction for all parameters it is 0.1 errors off."""
    case, data = exact_drops(np.geomspace(0.1, 1.0, 6))
    free = ["rubber.alpha", "rubber.beta"]
    del data["contact_time"], data["contact_time_sigma"]
    noise = np.random.default_rng(3).standard_normal(6)
    data["cor_sphere"] *= 1 + 0.005 * noise
    data["cor_sphere_sigma"] /= 2
    case["rubber.alpha"], case["rubber.beta"] = 390.0, 960.0
    found = vcor.identify(case, data, free)
    assert found.solved <= 100 and found.correction < 0.01
    # Gauss and Newton by differences of exact impacts over a tenth of a standard error
    x = np.log([one.value for one in found.estimates])
    values, vectors = np.linalg.eigh(found.covariance)
    steps = 0.05 * (vectors * np.sqrt(values)).T
    table = np.exp(np.vstack([x, x + steps, x - steps]))
    case["solver.accuracy"] = 1e-5
    exact = np.array([
        case.points({"impact.velocity": data["velocity"], **dict(zip(free, row, strict=True))},
                    ["cor_sphere"]).cor_sphere.values
        for row in table
    ])  # fmt: skip
    r = (exact - data["cor_sphere"]) / data["cor_sphere_sigma"]
    slopes = (r[1:3] - r[3:]).T / 0.1
    assert np.allclose(slopes.T @ slopes, np.eye(2), atol=5e-3)
    assert np.linalg.norm(slopes.T @ r[0]) < 0.01
    assert found.chi2 == pytest.approx(r[0] @ r[0], abs=1e-3)


@pytest.fixture(scope="module")
def solved_drops():
    """A problem of two exact drops, thin mechanics corrected at its guess and its least squares."""
    case, data = exact_drops(np.array([0.1, 0.9]))
    free = ["rubber.glassy_modulus", "rubber.beta"]
    case["solver.accuracy"] = 1e-5
    blocks = observations(case, data, free)
    bar = types.SimpleNamespace(update=lambda _: None)
    problem = Problem(case, free, blocks, {}, bar)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(search, "STARTS", FEW)
        x, chi2 = identification_exact.corrected(problem, 1)
    best = Fit(problem, x, chi2, *problem.derivatives(x))
    return problem, best, [best.intervals(i) for i in range(2)]


@pytest.fixture
def corrected_drops(solved_drops):
    """The same, which a test may change."""
    return copy.deepcopy(solved_drops)


def test_intervals_with_another_number_of_contacts_are_solved(monkeypatch, corrected_drops):
    """A correction is not fitted across such a jump, nor where there is no result."""
    problem, best, limits = corrected_drops
    made = problem.corrected
    solve = identification_exact.Corrected.solve

    def with_jump(self, x):
        exact, contacts = solve(self, x)
        contacts[-1, 0] = self.contacts[-1, 0] = 2
        return exact, contacts

    def with_gap(self, x):
        exact, contacts = solve(self, x)
        exact[-1, 0] = self.exact[-1, 0] = np.nan
        return exact, contacts

    for one in (with_jump, with_gap):
        problem.correct(made)
        monkeypatch.setattr(identification_exact.Corrected, "solve", one)
        assert not identification_exact.is_exact(best, limits, 1)
        assert problem.corrected is None
    monkeypatch.undo()
    problem.correct(made)
    assert identification_exact.is_exact(best, limits, 1) and made.error < 0.01
    # without a correction it is met
    problem.correct(None)
    assert identification_exact.is_exact(best, limits, 1)


def test_ends_that_are_off_are_met_again(monkeypatch, corrected_drops):
    problem, best, limits = corrected_drops
    made = problem.corrected
    known = len(made.known)
    predict = problem.predict
    off = made.predict(np.exp(best.x[None]))[0][0]

    def wrong(x, near=None):
        found = predict(x, near)
        # at the last point, an end
        found[-1] += 0.1 * problem.sigma
        return found

    monkeypatch.setattr(problem, "predict", wrong)
    assert not made.meets(best, limits)
    monkeypatch.undo()
    assert made.off == [(1, 1)] and len(made.known) == known + 5
    assert made.meets(best, limits) and made.off == [] and made.fresh == 2 * made.impacts
    assert np.allclose(made.predict(np.exp(best.x[None]))[0][0], off, rtol=1e-4)


def test_interpolation_from_few_points():
    """It meets what is known, has slopes where points are, and leaves that along no other way."""
    points = np.array([[0.0, 0.0], [0.1, 0.0]])
    values = np.array([[1.0, 2.0], [1.1, 2.0]])
    found = Kriged(points, values)(np.array([[0.0, 0.0], [0.1, 0.0], [0.05, 0.0], [0.1, 0.1]]))
    assert np.allclose(found[:2], values, atol=1e-6)
    assert np.allclose(found[2:, 0], [1.05, 1.1], atol=2e-3) and np.allclose(found[:, 1], 2)
    assert np.allclose(Kriged(points[:1], values[:1])(np.ones((3, 2))), values[0])
    # of a smooth function, better with each point: by its second and third order, and beyond
    x = np.random.default_rng(1).uniform(-0.3, 0.3, (60, 2))
    smooth = np.exp(x @ [0.5, -0.3])[:, None]
    errors = [np.abs(Kriged(x[:n], smooth[:n])(x[30:]) - smooth[30:]).max() for n in (1, 5, 12, 20)]
    assert errors[0] > 0.1 and errors[1] < 0.02 and errors[2] < 2e-3 and errors[3] < 5e-4


def test_cheap_impacts_are_identified_without_a_correction():
    case = thin_case("paper/sls.nml")
    data = {"velocity": [1.0, 5.0], "cor": [0.5, 0.43]}
    found = vcor.identify(case, data, ["rubber.beta"], errors={"cor": 0.02})
    assert found.solved == 0 and "correction" not in str(found)


@pytest.mark.skipif(not EVERYTHING, reason="takes long: scripts/test_long.sh")
def test_exact_intervals_are_those_of_solved_impacts(monkeypatch):
    """Without a correction, which takes minutes."""
    case, data = exact_drops(np.array([0.1, 0.9]))
    free = ["rubber.glassy_modulus", "rubber.beta"]
    one = vcor.identify(case, data, free)
    monkeypatch.setattr("vcor.materials.identification.corrected", lambda *_: None)
    two = vcor.identify(case, data, free)
    assert one.solved > 0 == two.solved
    for mine, wanted in zip(one.estimates, two.estimates, strict=True):
        assert abs(mine.value - wanted.value) < 0.01 * wanted.standard_error
        assert mine.standard_error == pytest.approx(wanted.standard_error, rel=0.01)
        for key in ("interval_68", "interval_95"):
            ends = np.array(getattr(mine, key)) - getattr(wanted, key)
            # the ends of a profile are met to 0.5 % of its width
            assert (np.abs(ends) < 0.025 * wanted.standard_error).all()
