"""`vcor page`: its ranges, its sweep and the interpolation, without a browser."""

import itertools
import json
import math
import re
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import PAPER, ROOT

import vcor
from vcor import page
from vcor._command import call
from vcor.page import document, table
from vcor.page.axes import axes_of
from vcor.page.table import Table

PAD = ROOT / "examples" / "rubber_pad_on_steel.nml"
SLS = PAPER / "sls.nml"
MATERIALS = ROOT / "examples" / "materials"
#: Rounding of a number of four bytes, the size in which the page has them
SINGLE = 1.2e-7
DROP = """
&case title = 'Drop </script><b>&amp;' /
&impact drop_height = 0.5, temperature = 298.15 /
&sphere radius = 0.01, material = 'steel' /
&plate material = 'natural rubber', waves = 'none' /
"""


def data_of(text):
    """What a page has of the sweep."""
    (found,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)
    return json.loads(found)


# ------------------------------------------------------------------------------- ranges


def test_ranges_have_the_units_of_users():
    case = vcor.read(SLS)
    vary = {"sphere.diameter": "2mm:10mm", "impact.velocity": "0.1:10 m/s"}
    diameter, velocity = axes_of(case, vary)
    assert (diameter.unit, diameter.first, diameter.last, diameter.is_log) == ("mm", 2, 10, False)
    assert diameter.si(diameter.nodes(3)) == pytest.approx([0.002, 0.006, 0.01])
    assert velocity.is_log and velocity.nodes(3) == pytest.approx([0.1, 1, 10])
    drop = vcor.Case(DROP)
    (temperature,) = axes_of(drop, {"impact.temperature": "0.1C:60C"})
    assert (temperature.unit, temperature.is_log) == ("°C", False)
    assert temperature.si(temperature.nodes(2)) == pytest.approx([273.25, 333.15])


@pytest.mark.parametrize(
    ("words", "code", "says"),
    [
        (["--vary", "plate.waves=none:body"], 2, ["plate.waves", "not one number"]),
        (["--vary", "sphere.material=1:2"], 2, ["sphere.material", "not one number"]),
        (["--vary", "rubber.moduli=1MPa:2MPa"], 2, ["rubber.moduli", "not one number"]),
        (["--vary", "impact.velocity=slow:fast"], 2, ["slow:fast", "a range of two numbers"]),
        (["--vary", "impact.velocity"], 2, ["a range of two numbers", "1m/s:5m/s"]),
        (["--vary", "impact.velocity=3m/s:1m/s"], 2, ["found 3 to 1", "smaller to the larger"]),
        (["--vary", "impact.velocity=3m/s:3m/s"], 2, ["found 3 to 3"]),
        (["--vary", "impact.velocity=1e999m/s:2m/s"], 2, ["found inf to 2"]),
        (["--vary", "impact.velocity=1mm/s:3"], 2, ["found two units", "m/s"]),
        (["--vary", "impact.velocity=1kg:3kg"], 2, ["unknown unit 'kg'"]),
        (["--vary", "impact.velocity=1m/s:3km/h"], 2, ["two units"]),
        (["--vary", "impact.speed=1m/s:3m/s"], 2, ["unknown key 'speed'"]),
        ([], 2, ["--vary", "found 0 numbers"]),
        (
            [f"--vary=rubber.rates({i})=1 1/s:2 1/s" for i in range(1, 5)],
            2, ["--vary", "found 4 numbers, expected one to 3"],
        ),
        (["--vary=impact.velocity=1m/s:2m/s"] * 2, 2, ["impact.velocity twice"]),
        (["--vary", "impact.velocity=1e4m/s:1e5m/s"], 5, ["an indentation of"]),
        (["--vary", "impact.velocity=1m/s:2m/s", "--points", "3"], 2, ["--points", "from 4 to"]),
        (["--vary", "impact.velocity=1m/s:2m/s", "--set", "impact.speed=1"], 2, ["'speed'"]),
        (["--vary", "impact.velocity=1m/s:2m/s", "--save", "x.pdf"], 2, ["'pdf'", "html"]),
        (["--vary", "impact.velocity=1m/s:2m/s", "--save", "/dev/full/x.html"], 4, ["/dev/full"]),
        ([str(SLS), "--vary", "impact.velocity=1m/s:2m/s"], 2, ["a second case"]),
        (["none.nml", "--vary", "impact.velocity=1m/s:2m/s"], 4, ["none.nml"]),
    ],
)  # fmt: skip
def test_what_is_refused(words, code, says, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    save = [] if "--save" in words else ["--save", "x.html"]
    with pytest.raises(SystemExit) as leaving:
        call("page", [str(PAD), *words, *save, *([] if "--points" in words else ["--points=4"])])
    out, err = capsys.readouterr()
    assert (leaving.value.code, out) == (code, "")
    assert err.startswith("vcor: error: ") and err.count("\n") == 1
    for word in says:
        assert word in err
    assert not list(tmp_path.iterdir())


def test_a_sweep_is_refused():
    with pytest.raises(vcor.InputError, match="found a &sweep group, expected a single impact"):
        page.make(ROOT / "examples/sweeps/sls_velocity.nml", {"impact.velocity": "1m/s:2m/s"})


# ------------------------------------------------------------------------ interpolation


def grid(shape, cor, state=None):
    """A table of a function of the places, and of a state of each point."""
    places = np.indices(shape).reshape(len(shape), -1)
    states = np.zeros(places.shape[1]) if state is None else state(*places)
    return Table(
        "", shape, cor(*places).astype(np.float32), states.astype(np.uint8),
        np.zeros(places.shape[1], np.uint8), [("separated", "good"), ("separated", "outside")],
    )  # fmt: skip


@pytest.mark.parametrize("shape", [(6,), (5, 4), (4, 6, 5)])
def test_cubic_polynomials_are_exact(shape):
    """In each axis, at the ends and on the points too: only the rounding of the values is left."""
    factors = [(0.3, -0.2, 0.05, 0.01), (1.0, 0.1, -0.03, 0.004), (0.5, 0.2, 0.01, -0.005)]

    def cor(*places):
        parts = zip(factors, places, strict=False)
        return math.prod(np.polynomial.polynomial.polyval(one, part) for part, one in parts)

    made = grid(shape, cor)
    largest = float(np.abs(made.cor).max())
    rows = np.random.default_rng(1).random((50, len(shape))) * (np.array(shape) - 1)
    ends = itertools.product(*[(0, size - 1, 1.5) for size in shape])
    for place in [*rows.tolist(), *ends]:
        found = made.at(place)
        assert found.states == [0]
        # weights of a cubic polynomial add up to at most 1.63 in each axis within the range
        assert found.value == pytest.approx(float(cor(*place)), abs=3**3 * SINGLE * largest)


@pytest.mark.parametrize("shape", [(9,), (9, 8), (5, 6, 7)])
def test_nothing_is_interpolated_between_states(shape):
    """Of two states with different constants a place has one of both, or none."""

    def state(*places):
        return (sum(places) > 6).astype(int)

    made = grid(shape, lambda *places: 0.25 + 0.5 * state(*places), state)
    seen = set()
    for place in np.random.default_rng(2).random((300, len(shape))) * (np.array(shape) - 1):
        found = made.at(place.tolist())
        corners = itertools.product(*[(math.floor(one), math.floor(one) + 1) for one in place])
        around = {int(state(*corner)) for corner in map(np.array, corners)}
        assert set(found.states) == around
        if len(around) > 1:
            assert math.isnan(found.value)
        else:
            assert found.value == pytest.approx(0.25 + 0.5 * around.pop(), abs=1e-6)
        seen.add(len(found.states))
    assert seen == {1, 2}


def test_a_point_beside_another_state_keeps_its_value():
    made = grid((8,), lambda i: 0.1 * i, lambda i: (i > 3).astype(int))
    for i in range(8):
        assert made.at([i]).value == pytest.approx(0.1 * i, abs=1e-6)
    assert math.isnan(made.at([3.5]).value)


def test_the_error_that_is_said():
    """Other impacts than those that measured it have no error that is much larger."""
    made = page.make(SLS, {"impact.velocity": "1m/s:5m/s"}, points=9)
    (found,) = made.tables
    (axis,) = made.axes
    shares = np.linspace(0.01, 0.99, 40)
    case = vcor.read(SLS)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", vcor.ValidityWarning)
        solved = case.points({axis.address: axis.si(axis.values(shares))}, ["cor_sphere"])
    errors = [
        abs(found.at([8 * share]).value - value)
        for share, value in zip(shares, solved.cor_sphere.values, strict=True)
    ]
    errors = [error for error in errors if not math.isnan(error)]
    assert len(errors) > 20 and found.fresh == table._FRESH[0]
    assert found.error > SINGLE and max(errors) < 2 * found.error
    assert f"largest error of e {found.error:.1e}" in str(made)


def test_verdicts_and_points_without_a_result():
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        made = page.make(PAD, {"impact.velocity": "0.2m/s:8m/s"}, points=33)
    (found,) = made.tables
    assert {one.category for one in heard} == {vcor.NoResultWarning}
    levels = [found.states[i] for i in dict.fromkeys(found.state.tolist())]
    assert levels[:3] == [("separated", level, "1") for level in ("good", "caution", "outside")]
    lost = np.isnan(found.cor)
    assert [found.states[i][1] for i in found.state[lost]] == ["none"] * lost.sum()
    assert f"{lost.sum()} of 33 points have no result" in str(made)
    assert found.blank > 0 and found.other < found.fresh / 10


def test_a_change_of_a_whole_number_is_one_of_the_state(monkeypatch):
    """As that of contacts with a structure; here the number of steps."""
    monkeypatch.setattr(table, "_STATE", ("status", "validity", "steps"))
    made = page.make(SLS, {"plate.thickness": "1mm:100mm"}, points=17)
    (found,) = made.tables
    steps = [one[2] for one in found.states]
    assert len(set(steps)) > 1 and all(re.fullmatch(r"\d+", one) for one in steps)
    for i, (one, other) in enumerate(itertools.pairwise(found.state)):
        assert math.isnan(found.at([i + 0.5]).value) == (one != other)


# ------------------------------------------------------------------------------ the file


def test_materials_complete_the_case_or_are_choices(tmp_path):
    case = tmp_path / "drop.nml"
    case.write_text(DROP)
    files = [MATERIALS / f"{name}.nml" for name in ("steel", "natural_rubber", "butyl")]
    made = page.make(case, {"impact.temperature": "0C:40C"}, files, points=5)
    assert [one.name for one in made.tables] == ["natural rubber", "butyl"]
    single = vcor.read(case, *files)
    for name, one in zip(("natural rubber", "butyl"), made.tables, strict=True):
        single["plate.material"] = name
        single["impact.temperature"] = 273.15
        value = single.solve(quantities=["cor_sphere", "validity"])["cor_sphere"]
        assert one.cor[0] == pytest.approx(value, rel=1e-6)
        assert f"material = '{name}'" in one.case
    with pytest.raises(vcor.UsageError, match="found 'butyl' twice"):
        page.make(case, {"impact.temperature": "0C:40C"}, [*files, files[-1]], points=5)


@pytest.mark.parametrize(
    ("settings", "vary", "at", "height"),
    [
        ({}, {"impact.velocity": "1m/s:3m/s"}, 2.0, 4 / (2 * 9.80665)),
        ({"impact.gravity": "1.62"}, {"impact.velocity": "1m/s:3m/s"}, 2.0, 4 / (2 * 1.62)),
        ({}, {"plate.thickness": "20mm:30mm"}, 0.02, 100 / (2 * 9.80665)),
        ({"impact.velocity": None, "impact.drop_height": "0.3"}, {"plate.thickness": "20mm:30mm"},
         0.02, 0.3),
        ({"impact.velocity": None}, {"impact.drop_height": "0.1m:2m"}, 0.7, 0.7),
    ],
)  # fmt: skip
def test_the_height_of_the_drop(settings, vary, at, height):
    text = SLS.read_text()
    if settings.get("impact.velocity", "") is None:
        text = re.sub(r"(?m)^ *velocity *=.*$", "", text)
        settings = {key: one for key, one in settings.items() if one is not None}
    case = vcor.Case(text)
    made = page.make(case, vary, settings=settings, points=4)
    drop = data_of(made.text)["tables"][0]["drop"]
    assert drop["factor"] * at ** drop.get("power", 0) == pytest.approx(height, rel=1e-12)


def test_a_file_stands_alone(tmp_path):
    case = tmp_path / "drop.nml"
    case.write_text(DROP)
    files = [MATERIALS / f"{name}.nml" for name in ("steel", "natural_rubber")]
    made = page.make(case, {"impact.temperature": "0C:40C"}, files, points=5)
    made.save(tmp_path / "drop.html")
    text = (tmp_path / "drop.html").read_text(encoding="utf-8")
    assert len(text) < document.MOST_BYTES
    assert "default-src 'none'" in text
    before, _, rest = text.partition("/* BEGIN bokeh.min.js */")
    own = before + rest.partition("/* END bokeh.min.js */")[2]
    assert not re.search(r"https?:|\bsrc=|@import|url\(", own)
    # a title is a text, not a part of the page
    assert "<b>" not in own and data_of(text)["title"] == "Drop </script><b>&amp;"
    assert "__" not in own and str(tmp_path) not in own


def test_a_page_names_no_folder(tmp_path):
    """Neither that of the case nor that of a table, in whatever the page says."""
    folder = tmp_path / "of a user" / "materials"
    folder.mkdir(parents=True)
    source = ROOT / "examples" / "steel_on_measured_rubber.nml"
    data = ROOT / "examples" / "soft_rubber_data.csv"
    (folder / data.name).write_text(data.read_text())
    head, mark, rest = source.read_text().rpartition("&material")
    (folder / "rubber.nml").write_text(mark + rest)
    case = tmp_path / "of a user" / "case.nml"
    case.write_text(head)
    # contacts shorter than the data know, and some that are no impact
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        made = page.make(
            case, {"impact.velocity": "1m/s:9e5m/s"}, [folder / "rubber.nml"], points=9
        )
    assert {vcor.NoResultWarning, vcor.DataRangeWarning} & {one.category for one in heard}
    (found,) = data_of(made.text)["tables"]
    assert data.name in found["case"]
    assert str(tmp_path) not in made.text and str(tmp_path) not in str(made)
    # a name that ends as that of the folder does, and a folder above, are another one
    folders = {Path("a"), Path()}
    assert (
        document._without(folders, "a/x.csv, 'a/y', data/z, ../a/w") == "x.csv, 'y', data/z, ../a/w"
    )


def test_a_page_that_would_be_too_large(monkeypatch):
    monkeypatch.setattr(document, "MOST_BYTES", 100_000)
    with pytest.raises(vcor.UsageError, match=r"has 1\.3 MB, expected at most 0 MB; points with"):
        page.make(SLS, {"impact.velocity": "1m/s:5m/s"}, points=5)


def test_the_number_of_points_follows_from_the_time(monkeypatch):
    assert [table._count(axes, 0.0) for axes in (1, 2, 3)] == [129, 65, 25]
    assert [table._count(axes, 100.0) for axes in (1, 2, 3)] == [17, 9, 7]
    # ten seconds for the points and half as many others
    assert table._count(2, 0.0166) == 20
    monkeypatch.setattr(table, "_time", lambda case, axes: 6.0)
    with pytest.warns(UserWarning, match=r"42 impacts take some 4 min; points with") as heard:
        page.make(SLS, {"impact.velocity": "1m/s:5m/s"}, threads=1)
    assert len([one for one in heard if "impacts take" in str(one.message)]) == 1
