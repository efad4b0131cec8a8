"""Uncertainty: elasticities against independent differences, Sobol' indices against known ones."""

import contextlib
import json
import re
import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import PAPER, ROOT, SWEEPS
from properties import examples, given, st
from scipy.integrate import solve_ivp

import vcor
from vcor import _command, plot, uncertainty_samples
from vcor.uncertainty import Spread

EXAMPLES = ROOT / "examples"
MATERIAL = ["rubber.glassy_modulus", "rubber.alpha", "rubber.beta"]


@pytest.fixture
def half_space(sls):
    """The SLS of the paper without waves: its scaling laws are known."""
    sls["plate.waves"] = "none"
    return sls


def test_elasticities_obey_the_scaling_of_a_half_space(half_space):
    # cor depends on alpha/beta and on beta T alone, T^5 proportional to m^2/(R E^2 v)
    found = vcor.sensitivities(half_space, [*MATERIAL, "impact.velocity"], ["cor", "contact_time"])
    modulus, alpha, beta, velocity = found.sel(quantity="cor").values
    assert modulus == pytest.approx(-0.4 * (alpha + beta), rel=1e-7)
    assert velocity == pytest.approx(-0.2 * (alpha + beta), rel=1e-7)
    modulus, alpha, beta, velocity = found.sel(quantity="contact_time").values
    assert modulus == pytest.approx(-0.4 * (1 + alpha + beta), rel=1e-7)
    assert velocity == pytest.approx(-0.2 * (1 + alpha + beta), rel=1e-7)


def results_of_the_ode(p):
    """Impact on an SLS plate with relaxing waves: the internal variable and two integrals of F."""
    v0, radius, m = p["impact.velocity"], p["sphere.radius"], p["steel.density"]
    m *= 4 / 3 * np.pi * radius**3
    plane = 1 - p["rubber.poisson_ratio"] ** 2
    beta, glassy = p["rubber.beta"], p["rubber.glassy_modulus"] / plane
    rubbery = glassy * p["rubber.alpha"] / beta
    k = 4 / 3 * np.sqrt(radius)
    wave = np.sqrt(3 * p["rubber.density"]) / (16 * p["rubber.density"])
    wave /= p["plate.half_thickness"] ** 2

    def fields(t, y):
        integral, double, q = y[:3]
        decay = np.exp(-beta * t)
        modulus = rubbery + (glassy - rubbery) * decay
        alpha = wave / np.sqrt(modulus)
        slope = alpha * beta * (glassy - rubbery) * decay / modulus / 2
        s = v0 * t - double / m - alpha * integral
        u = s * np.sqrt(abs(s))
        force = k * (rubbery * u + (glassy - rubbery) * (u - q))
        plate = slope * integral + alpha * force
        speed = v0 - integral / m - plate
        rise = k * (1.5 * glassy * np.sqrt(abs(s)) * speed - (glassy - rubbery) * beta * (u - q))
        return force, s, speed, plate, beta * (u - q), rise

    def rates(t, y):
        force, _, speed, plate, relaxing, _ = fields(t, y)
        return force, y[0], relaxing, force * speed, force * plate

    def end(t, y):
        return fields(t, y)[0]

    end.terminal, end.direction = True, -1
    time = (m**2 / (radius * glassy**2 * v0)) ** 0.2
    sizes = np.array([m * v0, m * v0 * time, (v0 * time) ** 1.5, m * v0**2, m * v0**2])
    found = solve_ivp(
        rates, (0, 20 * time), np.zeros(5), method="DOP853", rtol=1e-12, atol=1e-13 * sizes,
        events=[end, lambda t, y: fields(t, y)[2], lambda t, y: fields(t, y)[5]],
    )  # fmt: skip
    t0, y = found.t_events[0][0], found.y_events[0][0]
    _, s, speed, _, _, _ = fields(t0, y)
    return [
        -speed / v0, y[0] / m / v0 - 1, t0, fields(found.t_events[2][-1], found.y_events[2][-1])[0],
        fields(found.t_events[1][0], found.y_events[1][0])[1], s, y[3], y[4],
    ]  # fmt: skip


def test_elasticities_are_those_of_another_solution(sls):
    quantities = ["cor", "cor_sphere", "contact_time", "max_force", "max_indentation"]
    quantities += ["residual_indentation", "hysteresis_energy", "wave_energy"]
    addresses = [*MATERIAL, "rubber.poisson_ratio", "rubber.density", "plate.half_thickness"]
    addresses += ["impact.velocity", "sphere.radius", "steel.density"]
    values = {address: sls[address] for address in addresses}
    solved = sls.solve({"solver.accuracy": 1e-11}, quantities=quantities)
    assert np.allclose(results_of_the_ode(values), list(solved.values()), rtol=1e-9)
    step, slopes = 2e-3, []
    for address in addresses:
        ends = [
            results_of_the_ode({**values, address: values[address] * np.exp(side * step)})
            for side in (-1, 1)
        ]
        slopes.append(np.diff(np.log(ends), axis=0)[0] / (2 * step))
    found = vcor.sensitivities(sls, addresses, quantities)
    assert np.allclose(found.values, np.array(slopes).T, rtol=0, atol=1e-5)


def test_elasticities_at_the_end_of_a_range(half_space):
    # E' = E/(1 - nu^2): what a modulus does, times 2 nu^2/(1 - nu^2)
    half_space["rubber.poisson_ratio"] = 0.5
    found = vcor.sensitivities(
        half_space, ["rubber.glassy_modulus", "rubber.poisson_ratio"], ["cor"]
    )
    modulus, ratio = found.sel(quantity="cor").values
    assert ratio == pytest.approx(modulus * 2 * 0.25 / 0.75, rel=1e-7)
    alone = vcor.sensitivities(half_space, "rubber.glassy_modulus", "cor")
    assert alone.item() == pytest.approx(modulus, rel=1e-12)


def test_small_spreads_are_linear(sls):
    vary = {"rubber.alpha": 0.001, "rubber.beta": 0.002}
    found = vcor.propagate(sls, vary, samples=2048, quantities=["cor"])
    elastic = found.table.elasticity.sel(quantity="cor").values
    wanted = (elastic * [0.001, 0.002]) ** 2
    row = found.table.sel(quantity="cor")
    assert float(row.material / row["value"]) == pytest.approx(wanted.sum() ** 0.5, rel=0.03)
    share = wanted / wanted.sum()
    assert np.allclose(row["first"], share, atol=0.05)
    assert np.allclose(row["total"], share, atol=0.05)
    assert float(row.numerical) < 1e-6
    below, above = row.swing.sel(source="rubber.beta").values
    assert below > float(row["value"]) > above
    assert (row.percentiles.diff("percent") > 0).all()


def test_covariance_counts_as_one_parameter(half_space, tmp_path):
    # modulus and rates that go together as k to c k, t to c^(-2/5) t change nothing
    size = 0.05
    direction = np.array([1.0, 0.4, 0.4])
    values = np.array([1.5e7, 300.0, 1200.0])
    covariance = size**2 * np.outer(direction * values, direction * values)
    source = {
        "parameters": [{"name": n, "value": v} for n, v in zip(MATERIAL, values, strict=True)],
        "covariance": covariance.tolist(),
    }
    file = tmp_path / "fit.json"
    file.write_text(json.dumps(source))
    found = vcor.propagate(
        half_space, {"sphere.radius": 0.01}, covariance=file, samples=512,
        quantities=["cor", "max_force"],
    )  # fmt: skip
    assert list(found.table.source.values) == ["sphere.radius", "covariance"]
    total = found.table.total.sel(quantity="cor").values
    assert total[1] == pytest.approx(0, abs=1e-6)
    assert float(found.table.total.sel(quantity="max_force", source="covariance")) > 0.3
    # the bar of the tornado: all of them moved together by one standard deviation
    ends = [
        half_space.solve(
            dict(zip(MATERIAL, values * np.exp(side * size * direction), strict=True)),
            ["cor", "max_force"],
        )
        for side in (-1, 1)
    ]
    swing = found.table.swing.sel(source="covariance")
    for name in ("cor", "max_force"):
        wanted = [end[name] for end in ends]
        assert swing.sel(quantity=name).values == pytest.approx(wanted, rel=1e-6)


GROUP = """&material
   name = 'soft rubber'
   model = 'mittag_leffler'
   poisson_ratio = 0.4
   equilibrium_modulus = 1e6
   exponent = 0.4
   relaxing_modulus = 1e9
   time = 1.0
   shift = 'table'
   shift_file = 'shift.csv'
   reference_temperature = 293.15
/
"""


def test_the_group_of_a_fit_takes_the_place_of_that_of_the_case(tmp_path):
    """Its shift counts, not that of the guess; the density of the case stays."""
    case = vcor.read(EXAMPLES / "identification" / "block.nml")
    case = vcor.Case(case.text().replace("'rubber'", "'soft rubber'"))
    (tmp_path / "shift.csv").write_text("T [K],log10 a_T\n273.15,4\n293.15,0\n313.15,-2.4\n")
    values = {"equilibrium_modulus": 1e6, "exponent": 0.4, "relaxing_modulus": 1e9, "time": 1.0}
    source = {
        "name": "soft rubber",
        "parameters": [{"name": name, "value": value} for name, value in values.items()],
        "covariance": np.diag([(1e-4 * value) ** 2 for value in values.values()]).tolist(),
        "group": GROUP,
        "note": "the errors are too small",
    }
    (tmp_path / "fit.json").write_text(json.dumps(source))
    with pytest.warns(UserWarning, match="the errors are too small"):
        found = vcor.propagate(
            case, covariance=tmp_path / "fit.json", samples=64, quantities=["cor"]
        )
    text = case.text()[: case.text().rindex("&material")]
    group = GROUP.replace("time = 1.0", "time = 1.0, density = 1100")
    wanted = vcor.Case(text + group, name=str(tmp_path / "case.nml")).solve()["cor"]
    assert float(found.table.value.sel(quantity="cor")) == pytest.approx(wanted, abs=1e-9)
    assert abs(case.solve()["cor"] - wanted) > 0.05


@pytest.mark.parametrize("text", ["velocity,cor\n1,0.5\n", "[1]", '{"name": 3}'])
def test_what_is_no_fit_is_named(text, tmp_path, sls):
    (tmp_path / "fit.json").write_text(text)
    with pytest.raises(vcor.InputError, match="JSON.* of vcor fit or identify"):
        vcor.propagate(sls, covariance=tmp_path / "fit.json")


VALID = {
    "name": "rubber",
    "parameters": [{"name": "beta", "value": 900.0, "standard_error": 2.0},
                   {"name": "rubber.alpha", "value": 200.0}],
    "covariance": [[4.0, 0.1], [0.1, 1.0]],
    "group": "&material name = 'rubber', model = 'sls', glassy_modulus = 1e7, alpha = 200.0, "
             "beta = 900.0, poisson_ratio = 0.5 /",
    "note": "",
}  # fmt: skip
ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3)
    ),
    max_leaves=6,
)


def places(document, path=()):
    """Places of a document, its own first."""
    yield path
    inner = document.items() if isinstance(document, dict) else ()
    for key, one in enumerate(document) if isinstance(document, list) else inner:
        yield from places(one, (*path, key))


@examples(300)
@given(st.data())
def test_a_damaged_fit_is_a_line(sls, tmp_path, data):
    """Whatever stands in a place of the document: a spread, or an error of the input, or a
    combination that a covariance of such numbers leaves free."""
    document = json.loads(json.dumps(VALID))
    path = data.draw(st.sampled_from(list(places(VALID))[1:]))
    inner = document
    for key in path[:-1]:
        inner = inner[key]
    if data.draw(st.booleans()):
        inner[path[-1]] = data.draw(ANYTHING)
    else:
        del inner[path[-1]]
    (tmp_path / "fit.json").write_text(json.dumps(document))
    with warnings.catch_warnings(), contextlib.suppress(vcor.InputError):
        warnings.simplefilter("ignore", UserWarning)
        try:
            case, spread = Spread.joint(sls, tmp_path / "fit.json")
        except vcor.NumericalError as error:
            assert "the fit does not determine" in str(error)
            return
        assert np.isfinite(spread.place(np.full((1, len(spread.addresses)), 0.3))).all()
        assert case.text()


@pytest.mark.parametrize(("change", "words"), [
    ({"covariance": None}, "found no JSON"), ({"covariance": [[1.0]]}, "of 2 x 2 finite numbers"),
    ({"covariance": [[4.0, None], [None, 1.0]]}, "found no JSON"),
    ({"covariance": [[4.0, 0.1], [1.0]]}, "found no JSON"),
    ({"covariance": [[4.0, 0.9], [0.1, 1.0]]}, "not symmetrical"),
    ({"covariance": [[1e308, 0.1], [0.1, 1.0]], "parameters": [
        {"name": "beta", "value": 1e-3}, {"name": "alpha", "value": 200.0}]}, "too large for"),
    ({"group": 3}, "expected texts as name, group and note"),
    ({"group": "&impact velocity = 3 /"}, "expected &material groups alone"),
    ({"group": "&material"}, "fit.json:1"), ({"parameters": [3, 4]}, "parameter without a name"),
    ({"parameters": {"beta": 1}}, "found no JSON"), ({"name": ["x"]}, "expected texts"),
])  # fmt: skip
def test_a_fit_is_not_taken_unchecked(sls, tmp_path, change, words):
    (tmp_path / "fit.json").write_text(json.dumps(VALID | change))
    with pytest.raises(vcor.InputError, match=words):
        Spread.joint(sls, tmp_path / "fit.json")


@pytest.mark.parametrize("text", ["[" * 100000, '{"a":' * 100000])
def test_depth_is_no_fit(sls, tmp_path, text):
    (tmp_path / "fit.json").write_text(text)
    with pytest.raises(vcor.InputError, match="found no JSON"):
        Spread.joint(sls, tmp_path / "fit.json")


def test_model_error_is_the_distance_to_the_exact_mechanics(half_space):
    # with its thickness it is a plate that could bend, and the exact mechanics have its waves
    found = vcor.propagate(half_space, {"rubber.beta": 0.01}, samples=64, quantities=["cor"])
    exact = half_space.copy()
    exact["plate.waves"] = "body"
    difference = exact.solve()["cor"] - half_space.solve()["cor"]
    assert float(found.table.model.sel(quantity="cor")) == pytest.approx(abs(difference), rel=1e-9)
    assert found.dominant == "model"


def test_a_layer_without_waves_is_compared_with_its_waves(half_space):
    half_space["plate.base"] = "bonded"
    half_space["contact.law"] = "receding"
    found = vcor.propagate(half_space, {"rubber.beta": 0.01}, samples=64, quantities=["cor"])
    assert float(found.table.model.sel(quantity="cor")) > 1e-5


def test_what_lies_beyond_the_data_is_said(half_space, swept):
    """A band of times or temperatures that does not hold the impact, as `vcor run` warns of it."""
    rubber = half_space["plate.material"]
    inside = vcor.propagate(half_space, {f"{rubber}.beta": "1%"}, samples=64)
    assert inside.beyond == "" and "beyond" not in str(inside)
    half_space[f"{rubber}.valid_from"] = 2 * half_space.solve()["contact_time"]
    found = vcor.propagate(half_space, {f"{rubber}.beta": "1%"}, samples=64)
    assert f"the data of '{rubber}' begin at" in found.beyond
    assert found.beyond in str(found) and found.as_dict()["beyond"] == found.beyond
    swept["rubber.valid_from"] = float(np.median(swept.run().contact_time))
    along = str(vcor.bands(swept, {"rubber.beta": "1%"}, samples=64))
    assert "beyond the data, which no column above contains, at " in along


def test_the_same_seed_gives_the_same_numbers(sls):
    one, two = (vcor.propagate(sls, {"rubber.beta": "5%"}, samples=64) for _ in range(2))
    assert one.as_dict() == two.as_dict()


def test_command(tmp_path, capsys):
    words = [PAPER / "sls.nml", "--vary", "rubber.beta=5%", "--vary", "impact.velocity=9:11"]
    words += ["--samples", "64", "--output", tmp_path]
    _command.call("uncertainty", [str(word) for word in words])
    said = capsys.readouterr().out
    assert "numerical   material      model" in said
    written = json.loads((tmp_path / "sls_uncertainty.json").read_text())
    assert set(written["quantities"]["cor"]["elasticity"]) == {"rubber.beta", "impact.velocity"}
    assert (tmp_path / "sls_uncertainty.svg").exists()


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("rubber.beta", "expected such as 5%"),
        ("rubber.beta=-5%", "larger than 0"),
        ("rubber.beta=2:1", "expected such as"),
        ("rubber.bta=5%", "bta"),
        ("rubber.model=5%", "expected a number"),
        ("impact.drop_height=5%", "the case does not give it"),
    ],
)
def test_bad_spreads_are_refused_in_one_line(word, said, capsys, tmp_path):
    with pytest.raises(SystemExit) as caught:
        _command.call(
            "uncertainty", [str(PAPER / "sls.nml"), "--vary", word, "--output", str(tmp_path)]
        )
    assert caught.value.code in (2, 3)
    error = capsys.readouterr().err
    assert error.startswith("vcor: error: ")
    assert error.count("\n") == 1
    assert said in error


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--quantity", "cor,status"], "status: found a column of words"),
        (["--quantity", "validity"], "validity: found a column of words"),
        (["--seed", "-1"], "seed: found -1"),
        (["--threads", "0"], "threads: found 0"),
    ],
)
def test_bad_options_are_refused_in_one_line(words, said, capsys, tmp_path):
    words = [str(PAPER / "sls.nml"), "--vary", "rubber.beta=5%", *words, "--output", str(tmp_path)]
    with pytest.raises(SystemExit) as caught:
        _command.call("uncertainty", words)
    assert caught.value.code == 2
    error = capsys.readouterr().err
    assert said in error and error.count("\n") == 1


@pytest.mark.parametrize(
    ("spread", "code", "said"),
    [
        # 5 m on 10 mm, for 5 %
        ("sphere.radius=5", 2, "5 % is 5%"),
        ("impact.velocity=10.1", 2, "10.1 % is 10.1%"),
        ("rubber.poisson_ratio=2", 2, "2 % is 2%"),
        # a deviation leaves it positive, and a tenth of the samples are not
        ("impact.velocity=8", 5, "samples have no result, the first one because impact.velocity"),
        ("sphere.radius=8e-3", 5, "expected 10 % at most: --vary ADDRESS=LOW:HIGH"),
    ],
)
def test_a_spread_that_leaves_few_results_has_no_table(capsys, tmp_path, spread, code, said):
    words = [PAPER / "sls.nml", "--vary", spread, "--samples", "64", "--output", tmp_path / "out"]
    with pytest.raises(SystemExit) as caught:
        _command.call("uncertainty", [str(word) for word in words])
    out, err = capsys.readouterr()
    assert caught.value.code == code and out == ""
    assert said in err and err.count("\n") == 1 and not (tmp_path / "out").exists()


def test_a_number_that_is_meant_in_percent_is_refused(sls):
    with pytest.raises(vcor.UsageError, match=r"expected at most 1; 5 % is 0.05 or '5%'"):
        vcor.propagate(sls, {"sphere.radius": 5})


def test_a_few_samples_without_a_result_are_noted(sls):
    with pytest.warns(vcor.NoResultWarning, match=r"of \d+ points have no result"):
        found = vcor.propagate(sls, {"impact.velocity": "5"}, samples=256, quantities=["cor"])
    assert 0 < found.lost <= 0.1 * found.samples


def test_a_list_is_varied_term_by_term():
    case = vcor.read(PAPER / "butyl_prony.nml")
    with pytest.raises(vcor.UsageError, match=r"such as butyl.moduli\(1\)"):
        vcor.propagate(case, {"butyl.moduli": 0.05})


def test_any_thickness_and_what_has_no_parts(sls):
    """With waves = 'body' the loss has no parts, and what states no error has none."""
    sls["plate.waves"], sls["rubber.poisson_ratio"] = "body", 0.48
    found = vcor.propagate(sls, {"rubber.beta": 0.05, "impact.velocity": 0.02}, samples=8)
    assert "energy_loss" in found.table.quantity and "wave_energy" not in found.table.quantity
    assert np.isfinite(found.table.elasticity).all()
    for name in ("cor", "contact_time", "max_force"):
        row = found.table.sel(quantity=name)
        assert 0 < float(row.numerical) < 1e-2 * abs(float(row.value))
        # the impact is exact already
        assert float(row.model) == 0.0
    assert np.isnan(found.table.numerical.sel(quantity="energy_loss"))
    assert re.search(r"(?m)^energy_loss \[J\] +\S+ +- ", str(found))


@pytest.mark.parametrize("form", [(1, 2), [0.1], None, True, {"a": 0.1}, "wide"])
def test_what_is_no_distribution_is_told_the_forms(sls, form):
    with pytest.raises(vcor.UsageError, match=r"expected such as 0.05 or '5%', '0.1' .* or '1:2'"):
        vcor.propagate(sls, {"sphere.radius": form}, samples=8, quantities=["cor"])


def test_elasticities_of_any_thickness(sls):
    """cor depends on ratios of moduli and densities: multiplying all by one number leaves it."""
    sls["plate.waves"] = "body"
    names = ["rubber.glassy_modulus", "rubber.density", "steel.density"]
    found = vcor.sensitivities(sls, names, ["cor_sphere", "contact_time"])
    cor, time = np.abs(found.sum("parameter").values)
    # what follows the parameters, to 1e-6 and 1e-5, over the steps
    assert cor < 1e-4 and time < 2e-3


def test_elasticities_of_any_thickness_do_not_depend_on_the_step(sls, monkeypatch):
    """On one mesh results follow the parameters between springs and steps."""
    sls["plate.waves"] = "body"
    names, found = ["impact.velocity", "plate.half_thickness"], []
    for step in (1e-3, 2e-2):
        monkeypatch.setattr(vcor.uncertainty, "STEP", step)
        found.append(vcor.sensitivities(sls, names, ["cor_sphere", "max_force"]).values)
    short, long = found
    # without the edge between springs, max_force scatters by 0.07; 1e-4 is 1e-7 of a result
    assert np.abs(short - long).max() < 2e-4


def test_a_mesh_that_is_kept(sls):
    """By a method that has one, until a number of the solver changes."""
    names = ["cor_sphere", "max_force", "steps"]
    settled = sls._settled(["impact.velocity"], [9.0])
    settled["impact.velocity"] = 10.0
    assert settled.solve(quantities=names) == sls.solve(quantities=names)
    sls["plate.waves"] = "body"
    settled = sls._settled(["impact.velocity"], [6.0])
    settled["impact.velocity"] = 10.0
    on_another, own = (case.solve(quantities=names) for case in (settled, sls))
    assert on_another["cor_sphere"] == pytest.approx(own["cor_sphere"], abs=1e-5)
    assert on_another["cor_sphere"] != own["cor_sphere"]
    for case in (settled, sls):
        case["solver.accuracy"] = 1e-4
    assert settled.solve(quantities=names) == sls.solve(quantities=names)


def test_the_figure_has_its_legend_where_all_matplotlibs_have_one(sls):
    """Outside of the axes there is a place for it from Matplotlib 3.7 on only."""
    (axis,) = vcor.propagate(sls, {"rubber.beta": "5%"}, samples=64).figure().axes
    texts = [text.get_text() for text in axis.get_legend().get_texts()]
    assert texts == ["− one standard deviation", "+ one"]
    assert not axis.figure.legends


def test_a_name_in_the_figure_is_no_formula(half_space):
    case = vcor.Case(half_space.text().replace("'rubber'", r"'$\frac$'"))
    figure = vcor.propagate(case, {r"$\frac$.beta": "5%"}, samples=64).figure()
    figure.draw_without_rendering()
    (label,) = figure.axes[0].get_yticklabels()
    assert label.get_text() == r"\$\frac\$ beta"


@pytest.fixture
def swept(half_space):
    """The half space over three velocities."""
    text = half_space.text() + "&sweep parameter = 'impact.velocity', values = 1.0, 5.0, 20.0 /\n"
    return vcor.Case(text)


def test_bands_are_those_of_each_impact(swept):
    """Along a sweep, what each of its impacts has, with the same samples."""
    vary = {"rubber.beta": "5%", "impact.velocity": "2%"}
    found = vcor.bands(swept, vary, samples=64, quantities=["cor", "max_force"])
    table = found.table.sel({"impact.velocity": 5.0})
    single = vcor.Case(swept.text().partition("&sweep")[0])
    single["impact.velocity"] = 5.0
    wanted = vcor.propagate(single, vary, samples=64, quantities=["cor", "max_force"])
    assert found.points[1].as_dict() == wanted.as_dict()
    for name in found.quantities:
        row = wanted.table.sel(quantity=name)
        for percent in row.percent.values:
            assert table[f"{name}_p{percent:g}"] == row.percentiles.sel(percent=percent)
        assert table[name] == row["value"]
        assert abs(table[f"{name}_exact"] - table[name]) == row.model
        assert table[f"{name}_material"] == row.material > 0
        assert table[f"{name}_numerical"] == row.numerical
    assert table.max_force_exact.attrs["units"] == "N"
    assert table.validity.item() == wanted.validity == swept.run().validity.values[1]


@pytest.mark.usefixtures("no_figures")
def test_a_long_computation_is_announced(swept, tmp_path, capsys, monkeypatch):
    """How many impacts it solves and about how long that takes, before it begins, and with
    PYTHONWARNINGS = ignore too."""
    warnings.simplefilter("ignore")
    swept.save(tmp_path / "a.nml")
    words = [str(tmp_path / "a.nml"), "--vary", "rubber.beta=5%", "--samples", "64", "--quantity",
             "cor", "--output", str(tmp_path)]  # fmt: skip
    for limit, said in ((1e9, False), (0.0, True)):
        monkeypatch.setattr(uncertainty_samples, "LONG", limit)
        _command.call("uncertainty", words)
        assert ("144 impacts take some" in capsys.readouterr().err) is said


def test_bands_are_of_all_quantities_that_the_impacts_have(swept):
    found = vcor.bands(swept, {"rubber.beta": "5%"}, samples=64)
    assert found.quantities[0] == "cor"
    there = {"cor_sphere", "contact_time", "max_force", "resilience", "mean_pressure",
             "contact_radius", "energy_loss", "peak_loss_tangent"}  # fmt: skip
    assert there <= set(found.quantities)
    # a half space without a drop
    assert not {"rebound_height", "layer_ratio", "cor_error", "contact_ratio"} & set(
        found.quantities
    )
    low, high = found.table["resilience_p2.5"], found.table["resilience_p97.5"]
    assert (low < found.table.resilience).all() and (found.table.resilience < high).all()


def test_small_bands_follow_the_scaling_of_a_half_space(swept):
    """cor depends on velocity and modulus by E^2 v alone: bands of one are those of the other."""
    some = [
        vcor.bands(swept, {address: spread}, samples=256, quantities=["cor"]).table
        for address, spread in (("impact.velocity", "2%"), ("rubber.glassy_modulus", "1%"))
    ]
    for end in ("2.5", "97.5"):
        first, second = (table[f"cor_p{end}"] / table.cor - 1 for table in some)
        assert (abs(first) > 1e-5).all()
        assert np.allclose(first, second, rtol=0.02)


def test_command_over_a_sweep(swept, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    swept.save("rubber.nml")
    words = ["rubber.nml", "--vary", "rubber.beta=5%", "--samples", "64", "--quantity",
             "contact_time,cor", "--output", "found"]  # fmt: skip
    _command.call("uncertainty", words)
    said = capsys.readouterr().out
    assert "contact_time: the largest error is that of the model at 3 of 3 values" in said
    written = vcor.open("found/rubber_uncertainty.h5")
    rows = pd.read_csv("found/rubber_uncertainty.csv", comment="#")
    document = json.loads(Path("found/rubber_uncertainty.json").read_text())
    assert document["parameter"] == "impact.velocity" and document["unit"] == "m/s"
    ends = [f"contact_time_p{end}" for end in ("2.5", "16", "50", "84", "97.5")]
    assert (np.diff([written[name] for name in ends], axis=0) > 0).all()
    for name in ("impact.velocity", *ends, "cor", "validity", "validity_cause"):
        assert (rows[name].to_numpy() == written[name].values).all()
    for i, point in enumerate(document["points"]):
        known = point["quantities"]["contact_time"]["percentiles"]
        assert list(known.values()) == [float(written[name][i]) for name in ends]
    assert vcor.Case(written.attrs["case"]).run().cor.equals(swept.run().cor)
    # what vcor plot draws of it: two shares, and the exact mechanics
    _command.call(
        "plot", ["found/rubber_uncertainty.h5", "--quantity", "contact_time", "--output", "b.svg"]
    )
    figure = plot.figure("found/rubber_uncertainty.h5", quantities=["contact_time"])
    outer, inner = (one.get_paths()[0].vertices[:, 1] for one in figure.axes[0].collections)
    assert outer.max() == pytest.approx(1e3 * written["contact_time_p97.5"].values.max())
    assert inner.min() == pytest.approx(1e3 * written["contact_time_p16"].values.min())
    exact = next(line for line in figure.axes[0].lines if line.get_label() == "exact mechanics")
    assert np.allclose(exact.get_ydata(), 1e3 * written.contact_time_exact)


def test_values_of_a_sweep_without_a_result(swept):
    """They are nan, and said; the others have their bands."""
    swept["solver.end_time"] = 1.8e-3
    with pytest.warns(vcor.NoResultWarning, match="1 of 3 values of impact.velocity, and"):
        found = vcor.bands(swept, {"rubber.beta": "1%"}, samples=64, quantities=["cor"])
    assert np.isfinite(found.table.cor).values.tolist() == [False, True, True]
    assert found.table.validity.values[0] == "none"
    assert [one is None for one in found.points] == [True, False, False]
    assert "nan" in str(found) and found.as_dict()["points"][0] == {"value": 1.0}
    swept["solver.end_time"] = 1e-5
    with pytest.raises(vcor.NumericalError, match="do not separate within solver.end_time"):
        vcor.bands(swept, {"rubber.beta": "1%"}, samples=64)


def test_sweeps_that_have_no_bands(swept, half_space):
    with pytest.raises(vcor.UsageError, match="found 0 swept parameters, expected one"):
        vcor.bands(half_space, {"rubber.beta": "1%"})
    with pytest.raises(vcor.UsageError, match="found 2 swept parameters, expected one"):
        vcor.bands(SWEEPS / "velocity_and_radius.nml", {"rubber.beta": "1%"})
    with pytest.raises(vcor.UsageError, match="this parameter is swept, expected a spread about"):
        vcor.bands(swept, {"impact.velocity": "1:2"})
    with pytest.raises(vcor.UsageError, match=r"a sweep over impact.velocity.*vcor.bands"):
        vcor.propagate(swept, {"rubber.beta": "1%"})
    source = {"parameters": [{"name": "impact.velocity", "value": 2.0}], "covariance": [[0.01]]}
    with pytest.raises(vcor.UsageError, match="is swept, and the covariance has it"):
        vcor.bands(swept, covariance=source)


def test_forms_of_a_spread_are_those_of_the_caller(sls, capsys):
    with pytest.raises(vcor.UsageError, match=r"such as 0.05 or '5%', '0.1' \(in its unit"):
        vcor.propagate(sls, {"rubber.beta": "x"})
    with pytest.raises(SystemExit):
        _command.call("uncertainty", [str(PAPER / "sls.nml"), "--vary", "rubber.beta=x"])
    assert "expected such as 5%, 0.1 (in its unit) or 1:2" in capsys.readouterr().err
