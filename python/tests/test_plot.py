"""Figures: what they show, and how the command answers."""

import itertools
import os
import random
import re
import runpy
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import h5py
import matplotlib as mpl
import matplotlib.style
import numpy as np
import pytest
from conftest import PAPER, ROOT, SWEEPS
from matplotlib.text import Text

import vcor
from vcor import _command
from vcor.materials.data import read_data
from vcor.plot import KINDS, STYLE, _find, _label_decades, figure, save

EVERYTHING = "VCOR_ALL_TESTS" in os.environ


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Files of results of all kinds."""
    folder = tmp_path_factory.mktemp("results")
    sls, velocity = PAPER / "sls.nml", SWEEPS / "sls_velocity.nml"
    for words in (
        ["run", PAPER / "sls_ghost.nml"],
        ["run", PAPER / "butyl_prony_ghost.nml"],
        ["run", sls, "--set", "output.history=.false.", "--set", "output.stem=bare"],
        ["run", velocity, "--set", "output.stem=sweep"],
        ["run", velocity, "--set", "output.stem=soft", "--set", "rubber.beta=900"],
        ["run", SWEEPS / "velocity_and_radius.nml", "--set", "output.stem=cube"],
        ["material", sls, PAPER / "butyl_prony.nml"],
    ):
        subprocess.run(
            [os.environ["VCOR"], *map(str, words), "--quiet"], cwd=folder, check=True, timeout=None
        )
    return folder


def curves(axis):
    """Curves of a panel with a text."""
    return [line for line in axis.lines if line.get_label()[0] != "_"]


def texts(made):
    """Texts of the legend."""
    return [text.get_text() for legend in made.legends for text in legend.get_texts()]


def test_a_history(results):
    made = figure([results / "sls_ghost.h5"])
    (axis,) = made.axes
    summary = vcor.open(results / "sls_ghost.h5")
    end = 1e3 * float(summary.contact_time)
    assert axis.get_xlabel() == "time [ms]"
    assert texts(made)[-1] == f"t₀ = {end:.4g} ms"
    indentation, velocity, force, _ = curves(axis)
    for line, at_end in (
        (indentation, summary.residual_ratio),
        (velocity, summary.cor),
        (force, 0.0),
    ):
        assert line.get_xdata()[-1] == pytest.approx(end)
        assert line.get_ydata()[-1] == pytest.approx(float(at_end), abs=2e-3)
        assert np.max(line.get_ydata()) <= 1.001
    assert velocity.get_ydata()[0] == -1.0
    dashed = [line for line in axis.lines if line.get_linestyle() == "--"]
    assert len(dashed) == 3
    assert dashed[0].get_xdata()[-1] > end
    assert f"COR {float(summary.cor):.4g}" in [text.get_text() for text in axis.texts]


def test_two_histories(results):
    names = ["sls_ghost.h5", "butyl_prony_ghost.h5"]
    made = figure([results / name for name in names])
    assert [axis.get_title(loc="left") for axis in made.axes] == ["(a)", "(b)", "(c)"]
    assert len(texts(made)) == 2 and all("COR 0." in text for text in texts(made))
    one, other = (vcor.open(results / name) for name in names)
    first = made.axes[1].lines
    assert first[0].get_ydata()[-1] == pytest.approx(float(one.cor), abs=2e-3)
    assert curves(made.axes[1])[1].get_ydata()[-1] == pytest.approx(float(other.cor), abs=2e-3)
    assert made.get_size_inches()[0] == pytest.approx(17 / 2.54)


def test_a_loop(results):
    path = results / "sls_ghost.h5"
    made = figure([path], kind="loop")
    (line,) = curves(made.axes[0])
    x, y = 1e-3 * line.get_xdata(), line.get_ydata()
    lost = float(vcor.open(path).hysteresis_energy)
    assert np.diff(x) @ (y[1:] + y[:-1]) / 2 == pytest.approx(lost, rel=1e-3)
    assert texts(made) == [f"energy loss {1e3 * lost:.4g} mJ"]
    assert y[-1] == pytest.approx(0.0, abs=1.0)


def test_a_coupled_contact(results, tmp_path):
    """Its indentation is the path of the sphere; there is no loss of the contact alone."""
    subprocess.run(
        [os.environ["VCOR"], "run", PAPER / "sls.nml", "--set", "plate.waves=body", "--quiet"],
        cwd=tmp_path, check=True, timeout=None,
    )  # fmt: skip
    path = tmp_path / "sls.h5"
    result = vcor.open(path)
    velocity = curves(figure([path]).axes[0])[1].get_ydata()
    assert velocity[0] == pytest.approx(-1.0)
    assert velocity[-1] == pytest.approx(float(result.cor), abs=1e-6)
    made = figure([path], kind="loop")
    (line,) = curves(made.axes[0])
    x, y = 1e-3 * line.get_xdata(), line.get_ydata()
    lost = float(result.energy_loss)
    # the trapezoidal rule over 80 steps
    assert np.diff(x) @ (y[1:] + y[:-1]) / 2 == pytest.approx(lost, rel=5e-3)
    assert texts(made) == [f"energy loss {lost:.4g} J"]


def test_a_history_through_several_contacts(tmp_path):
    """It goes on to the last separation, with the energy in the structure."""
    case = ROOT / "examples" / "ball_on_cantilever.nml"
    subprocess.run(
        [os.environ["VCOR"], "run", case, "--quiet"], cwd=tmp_path, check=True, timeout=None
    )
    path = tmp_path / "ball_on_cantilever.h5"
    result = vcor.open(path)
    (axis,) = figure([path]).axes
    _, velocity, force, given, _ = curves(axis)
    end = 1e3 * float(result.last_separation)
    assert end > 1.5e3 * float(result.contact_time)
    assert force.get_xdata()[-1] == pytest.approx(end)
    assert velocity.get_ydata()[-1] == pytest.approx(float(result.cor_sphere), abs=1e-3)
    share = float(result.wave_energy / result.initial_energy)
    assert given.get_ydata()[-1] == pytest.approx(share, rel=1e-2)
    assert not any(len(line.get_xdata()) for line in axis.lines if line.get_linestyle() == "--")


def test_moduli(results):
    made = figure([results / "sls_material.h5"])
    relaxation, moduli, tangent = made.axes
    rubber = vcor.read(PAPER / "sls.nml").material("rubber")
    line = relaxation.lines[0]
    np.testing.assert_allclose(line.get_ydata(), 1e-6 * rubber.relaxation(line.get_xdata()))
    # with what is marked
    assert len(curves(moduli)) == 3 and len(curves(tangent)) == 1
    both = figure([results / "sls_material.h5", results / "butyl_prony_material.h5"])
    assert len(both.axes) == 4 and len(texts(both)) == 2


# The narrowest, a column and a page; those between them are long tests
@pytest.mark.parametrize("width", [4.25, 6, 8.5, 10, 17] if EVERYTHING else [4.25, 8.5, 17])
def test_no_text_lies_on_another(results, width):
    """Of the legend, the letters of the panels, what is marked, and the numbers at the end."""
    for name in ("sls_material.h5", "sls_ghost.h5"):
        made = figure([results / name], width=width)
        made.draw_without_rendering()
        (legend,) = made.legends
        for axis in made.axes:
            heads = [axis.get_title(loc=where) for where in ("left", "center", "right")]
            found = [
                one
                for one in axis.findobj(Text)
                if one.get_text() and (one.get_text() in heads or one in axis.texts)
            ]
            boxes = [one.get_window_extent() for one in found]
            assert not any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
            assert not any(one.overlaps(legend.get_window_extent()) for one in boxes)
            # beyond the markers at the edge
            edge = axis.get_window_extent().x1
            marker = max(line.get_markersize() for line in axis.lines) / 2 * made.dpi / 72
            assert all(
                box.x0 > edge + marker
                for box, one in zip(boxes, found, strict=True)
                if one in axis.texts
            )


def test_a_sweep(results):
    names = ["cor", "contact_time", "max_force"]
    made = figure([results / "sweep.h5", results / "soft.h5"], quantities=names)
    data = vcor.open(results / "sweep.h5")
    assert len(made.axes) == 3
    np.testing.assert_array_equal(curves(made.axes[0])[0].get_ydata(), data.cor)
    np.testing.assert_allclose(curves(made.axes[1])[0].get_ydata(), 1e3 * data.contact_time)
    assert made.axes[1].get_ylabel() == "contact time [ms]"
    assert "beta = 900 s⁻¹" in texts(made)
    (line,) = curves(figure([vcor.read(SWEEPS / "sls_velocity.nml").run()], legends=["x"]).axes[0])
    np.testing.assert_array_equal(line.get_ydata(), data.cor)
    given = figure([results / "sweep.h5", results / "soft.h5"], legends=["one", "two"])
    assert texts(given)[:2] == ["one", "two"]


def test_a_map(results):
    made = figure([results / "cube.h5"])
    axis, bar = made.axes
    assert axis.get_ylabel() == "sphere radius [mm]"
    assert axis.get_yscale() == axis.get_xscale() == "log"
    assert bar.get_ylabel() == "coefficient of restitution"
    narrow = figure([results / "cube.h5"], ranges={"z": (0.4, 0.8), "x": (5.0, None)})
    assert narrow.axes[1].get_ylim() == (0.4, 0.8)
    assert narrow.axes[0].get_xlim()[0] == 5.0


def test_a_map_with_a_hole(results):
    """A point without a result is grey, and the lines and labels of the others are there."""
    data = vcor.open(results / "cube.h5")
    whole = figure([data])
    data.cor[1, 1] = np.nan
    made = figure([data])
    assert len(made.axes[0].texts) >= 0.7 * len(whole.axes[0].texts) > 0
    assert texts(made)[0] == "no result" and "no result" not in texts(whole)


def test_the_legend_leaves_out_what_a_case_has_not(results, tmp_path):
    """A unit of 1, and keys that only another case has."""
    plate = vcor.read(SWEEPS / "sls_velocity.nml")
    text = re.sub(r"half_thickness = .*\n", "", str(plate)).replace("'relaxing'", "'none'")
    made = figure([plate.run(), vcor.Case(text).run()])
    found = texts(made)
    assert "half thickness = 0.02 m, waves = 'relaxing'" in found and "waves = 'none'" in found


def test_where_the_model_does_not_hold(results):
    data = vcor.open(results / "sweep.h5")
    made = figure([results / "sweep.h5"])
    hatches = {"outside": "/////", "caution": "//"}
    spans = [patch for patch in made.axes[0].patches if patch.get_hatch()]
    hatched = any(data.validity == "outside")
    assert bool(spans) == hatched == ("outside of the model's validity" in texts(made))
    for patch in spans:
        low, high = patch.get_extents().transformed(made.axes[0].transData.inverted()).intervalx
        v = data["impact.velocity"]
        inside = data.validity.values[(v > low) & (v < high)]
        assert {hatches[level] for level in inside} == {patch.get_hatch()}


def test_caution_has_hatching_of_its_own():
    case = vcor.read(PAPER.parent / "steel_on_glass.nml")
    # without the waves that it has
    case["plate.waves"] = "none"
    thick = {"plate.half_thickness": np.geomspace(5e-4, 1e-1, 12)}
    found = case.sweep(thick, ["max_force", "validity"])
    assert set(found.validity.values) == {"good", "caution", "outside"}
    over = {"impact.velocity": np.geomspace(0.01, 1.0, 4)}
    for data in (found, case.sweep(thick | over, ["max_force", "validity"])):
        made = figure([data], quantities=["max_force"])
        assert texts(made)[-2:] == [
            "outside of the model's validity",
            "with caution: 99 of 100 within 10 % or 0.05",
        ]
    axes = figure([found], quantities=["max_force"]).axes[0]
    spans = [patch for patch in axes.patches if patch.get_hatch()]
    assert [patch.get_hatch() for patch in spans] == ["/////", "//"]


def test_measured_points(results, tmp_path):
    (tmp_path / "drops.csv").write_text(
        "# a laboratory\nvelocity [m/s]; cor; cor_sigma; contact_time [ms]\n"
        "5; 0.42; 0.01; 1.5\n10; 0.43; 0.02;\n"
    )
    files = [results / "sweep.h5", tmp_path / "drops.csv"]
    made = figure(files, quantities=["cor", "contact_time"])
    assert "drops" in texts(made)
    bars = [axis.containers[0] for axis in made.axes]
    np.testing.assert_array_equal(bars[0].lines[0].get_xdata(), [5.0, 10.0])
    np.testing.assert_array_equal(bars[0].lines[0].get_ydata(), [0.42, 0.43])
    (segments,) = (c.get_segments() for c in bars[0].lines[2])
    np.testing.assert_allclose([s[:, 1] for s in segments], [[0.41, 0.43], [0.41, 0.45]])
    np.testing.assert_allclose(bars[1].lines[0].get_ydata(), [1.5, np.nan])
    (tmp_path / "moduli.csv").write_text("f [kHz],storage_modulus [MPa]\n1,5\n2,6\n")
    made = figure([results / "sls_material.h5", tmp_path / "moduli.csv"])
    (bar,) = made.axes[1].containers
    # in the unit of the data, as the curves are
    np.testing.assert_allclose(bar.lines[0].get_xdata(), [1e3, 2e3])
    np.testing.assert_allclose(bar.lines[0].get_ydata(), [5, 6])
    assert made.axes[1].get_xlabel() == "frequency [Hz]"
    alone = figure([results / "sls_material.h5"])
    assert alone.axes[1].get_xlabel() == "angular frequency [rad/s]"
    least, own = (one.axes[1].lines[0].get_xdata() for one in (made, alone))
    np.testing.assert_allclose(2 * np.pi * least, own)
    # one marker for each modulus
    (tmp_path / "both.csv").write_text("w [rad/s],E' [MPa],E'' [MPa]\n1,5,1\n2,6,2\n")
    made = figure([results / "sls_material.h5", tmp_path / "both.csv"])
    marks = [one.lines[0].get_marker() for one in made.axes[1].containers]
    assert len({*marks}) == 2 and made.axes[1].get_xlabel() == "angular frequency [rad/s]"
    named = {text.get_text() for text in made.legends[0].get_texts()}
    assert {"both: storage modulus", "both: loss modulus"} <= named
    (tmp_path / "force.csv").write_text("time [ms],force [N]\n0.5,500\n")
    made = figure([results / "sls_ghost.h5", tmp_path / "force.csv"])
    (bar,) = made.axes[0].containers
    assert bar.lines[0].get_ydata()[0] == pytest.approx(
        500 / float(vcor.open(results / "sls_ghost.h5").max_force)
    )
    (tmp_path / "other.csv").write_text("speed,max_force\n1,2\n")
    with pytest.raises(vcor.InputError, match="velocity, max_force"):
        figure([results / "sweep.h5", tmp_path / "other.csv"])
    (tmp_path / "unit.csv").write_text("velocity [knots],cor\n1,2\n")
    with pytest.raises(vcor.InputError, match="found 'knots' as unit"):
        figure([results / "sweep.h5", tmp_path / "unit.csv"])


def test_temperatures_are_shown_in_celsius_on_request(tmp_path):
    case = vcor.read(SWEEPS / "squash_ball.nml")
    sweep = case.sweep({"impact.temperature": [283.15, 298.15, 313.15]}, ["cor"])
    points = tmp_path / "points.csv"
    points.write_text("temperature [K], cor\n298.15, 0.35\n")
    for celsius, unit, values in (
        (False, "K", (283.15, 298.15, 313.15)),
        (True, "°C", (10, 25, 40)),
    ):
        axis = figure([sweep, points], celsius=celsius).axes[0]
        assert axis.get_xlabel() == f"impact temperature [{unit}]"
        (line, *_), shown = axis.lines, [tuple(one.get_xdata()) for one in axis.lines]
        assert tuple(line.get_xdata()) == values
        assert any(np.allclose(x, values[1]) for x in shown)
    pair = {"impact.temperature": [283.15, 298.15], "impact.velocity": [1.0, 2.0, 3.0]}
    texts = [
        [one.get_text() for one in figure(case.sweep(pair, ["cor"]), kind="sweep", celsius=celsius)
         .legends[0].get_texts()]
        for celsius in (False, True)
    ]  # fmt: skip
    assert "impact temperature = 283.15 K" in texts[0] and "impact temperature = 10 °C" in texts[1]


# A column is a long test
@pytest.mark.parametrize("width, panels", [(6, 1), (17, 2), *[(8.5, 1)] * EVERYTHING])
def test_panels_have_room_at_every_width(results, tmp_path, width, panels):
    """Those of a narrow figure are one below the other; no number of an axis is over another."""
    made = figure([results / "cube.h5"], quantities=["cor", "contact_time"], width=width)
    places = [
        axis.get_subplotspec().get_gridspec().ncols for axis in made.axes if axis.get_title("left")
    ]
    assert places == [panels, panels]
    made.savefig(tmp_path / "a.png")
    for axis in made.axes:
        boxes = [one.get_window_extent() for one in axis.get_xticklabels() if one.get_text()]
        assert all(a.x1 < b.x0 for a, b in zip(boxes, boxes[1:], strict=False) if b.x0 > a.x0)


def test_axes_that_are_wanted(results):
    made = figure([results / "sweep.h5"], log="xy", ranges={"y": (0.1, 1.0)}, width=12)
    (axis,) = made.axes
    assert (axis.get_xscale(), axis.get_yscale()) == ("log", "log")
    assert axis.get_ylim() == (0.1, 1.0)
    assert made.get_size_inches()[0] == pytest.approx(12 / 2.54)


def test_moduli_of_a_fit(tmp_path):
    """A group of vcor fit and the data that it comes from."""
    data = ROOT / "examples/soft_rubber_data.csv"
    fit = vcor.fit(data, model="mittag_leffler", density=1100.0)
    (tmp_path / "soft.nml").write_text(fit.group)
    relaxation, *_ = figure([tmp_path / "soft.nml", data]).axes
    (bar,) = relaxation.containers
    times, moduli = bar.lines[0].get_data()
    assert len(times) == 57
    line = relaxation.lines[0]
    assert line.get_xdata()[0] == pytest.approx(times[0])
    found = np.interp(np.log(times), np.log(line.get_xdata()), line.get_ydata())
    np.testing.assert_allclose(found, moduli, rtol=2e-3)
    # moduli as instruments write them
    (tmp_path / "dynamic.txt").write_text("f, E_stor, E_loss\nHz, MPa, MPa\n1,5,1\n2,6,2\n")
    axes = figure([tmp_path / "soft.nml", tmp_path / "dynamic.txt"]).axes
    (bar,) = axes[1].containers[:1]
    np.testing.assert_allclose(bar.lines[0].get_xdata(), [1, 2])


@pytest.mark.parametrize(
    "text",
    [
        "velocity [m/s]\tcor\n5\t0.42\n10\t0.43\n",
        "# drops\nvelocity cor\n5 0.42\n10 0.43\n",
        "velocity (m/s);cor\n5,0;0,42\n10,0;0,43\n",
        "velocity [mm/s], cor [%]\n5e3, 42\n1e4, 43\n",
        "impact.velocity, e\n5, 0.42\n10, 0.43\n",
    ],
)
def test_ways_to_write_data(tmp_path, text):
    (tmp_path / "drops.csv").write_text(text, encoding="utf-8-sig")
    data = read_data(tmp_path / "drops.csv")
    np.testing.assert_allclose(_find(data, "impact.velocity")[0], [5, 10])
    np.testing.assert_allclose(_find(data, "cor")[0], [0.42, 0.43])


def test_levels_of_a_map(results):
    cube = results / "cube.h5"
    axis, bar = figure([cube], levels=[0.4, 0.5, 0.6]).axes
    np.testing.assert_array_equal(bar.get_yticks(), [0.4, 0.5, 0.6])
    cor = vcor.open(cube).cor
    _, bar = figure([cube], levels=4).axes
    ticks = bar.get_yticks()
    assert 3 <= len(ticks) <= 7 and ticks[0] <= cor.min() and ticks[-1] >= cor.max()
    _, bar = figure([cube], log="z", quantities=["max_force"]).axes
    assert bar.get_yscale() == "log" and {f"{tick:e}"[0] for tick in bar.get_yticks()} <= set("125")


def test_the_switch_of_the_hatching(results):
    for name in ("sweep.h5", "cube.h5"):
        made = figure([results / name], hatch=False)
        assert "outside of the model's validity" not in texts(made)
        assert not [patch for patch in made.axes[0].patches if patch.get_hatch()]
        assert "outside of the model's validity" in texts(figure([results / name]))


def write_points(path, axes, **columns):
    """A file of results made by h5py."""
    with h5py.File(path, "w") as file:
        file.attrs["title"] = np.bytes_(columns.pop("title", ""))
        for name, values in axes.items():
            file[f"summary/{name}"] = values
            file[f"summary/{name}"].make_scale(name)
        for name, values in columns.items():
            file[f"summary/{name}"] = values
            for place, axis in enumerate(axes):
                file[f"summary/{name}"].dims[place].attach_scale(file[f"summary/{axis}"])


def test_a_map_with_holes(tmp_path):
    z = np.array([[1.0, 2.0, 3.0], [np.nan, 4.0, 5.0], [3.0, 5.0, 6.0]])
    axes = {"impact.velocity": [1.0, 2.0, 3.0], "sphere.radius": [1.0, 2.0, 3.0]}
    write_points(tmp_path / "holes.h5", axes, cor=z)
    axis, _ = figure([tmp_path / "holes.h5"]).axes
    assert axis.get_xlabel() == "impact velocity" and axis.get_ylabel() == "sphere radius"
    paths = [path for one in axis.collections[:1] for path in one.get_paths()]
    assert not any(path.contains_point((1.99, 1.01)) for path in paths)
    write_points(tmp_path / "none.h5", axes, cor=np.full((3, 3), np.nan))
    with pytest.raises(vcor.InputError, match="no value at any point"):
        figure([tmp_path / "none.h5"])


def test_values_in_any_order(tmp_path):
    for kind in (">f4", "<f8", "<i2"):
        values = np.array([4, 1, 2], dtype=kind)
        write_points(tmp_path / "a.h5", {"sphere.radius": values}, cor=np.array([3, 2, 1.0]))
        (line,) = figure([tmp_path / "a.h5"]).axes[0].lines
        np.testing.assert_array_equal(line.get_data(), [[1, 2, 4], [2, 1, 3]])


def test_equal_ratios_are_logarithmic(tmp_path):
    for values, scale in (([1, 10, 100.0], "log"), ([1, 2, 3.0], "linear"), ([1, 2.0], "linear")):
        write_points(tmp_path / "a.h5", {"sphere.radius": values}, cor=values)
        assert figure([tmp_path / "a.h5"]).axes[0].get_xscale() == scale


def test_a_curve_for_each_value(tmp_path):
    axes = {"impact.velocity": [1.0, 2.0, 3.0], "sphere.radius": [1.0, 2.0]}
    write_points(tmp_path / "a.h5", axes, cor=np.arange(6.0).reshape(3, 2))
    made = figure([tmp_path / "a.h5"], kind="sweep")
    assert texts(made) == ["sphere radius = 1", "sphere radius = 2"]
    np.testing.assert_array_equal(curves(made.axes[0])[1].get_ydata(), [1, 3, 5])


TITLE = "a_b {c} <d> & \"e\" 'f' h^2 @x ~y `z` $HOME$ $\\frac$ 100% α \\n"


def test_texts_stand_for_themselves(results, tmp_path):
    """No title is a formula, none leaves its line, and none is cut."""
    files = [results / "sweep.h5", results / "soft.h5"]
    words = ["--legend", TITLE, "--legend", "plain", "--output", f"{tmp_path}/a.svg"]
    words += ["--quantity", "cor,max_force", "--quiet"]
    _command.call("plot", [*map(str, files), *words])
    ElementTree.parse(tmp_path / "a.svg")
    made = figure(files, legends=[TITLE, "ä" * 300], quantities=["cor", "max_force"])
    shown = texts(made)
    assert shown[0] == TITLE
    assert re.fullmatch("ä{90,110}\nä{90,110}\nä+", shown[1]) and shown[1].count("ä") == 300
    shutil.copy(results / "sweep.h5", tmp_path / "other.h5")
    with h5py.File(tmp_path / "other.h5", "a") as file:
        file.attrs["title"] = "two\nlines \x1b[31m"
        file["summary/cor"].attrs["long_name"] = "$x^$ \x07"
    made = figure([tmp_path / "other.h5", results / "soft.h5"])
    assert texts(made)[0] == "two lines ?[31m"
    save(made, tmp_path / "b.svg")


def test_file_that_others_changed(results, tmp_path):
    """It is drawn as before."""
    path = tmp_path / "a.h5"
    shutil.copy(results / "sls_ghost.h5", path)
    with h5py.File(path, "r+") as file:
        file.attrs["remark"] = "looks good"
    figure([path])


def lightness(colour):
    """L* of a colour, 0 to 100 (CIE 1976; sRGB, IEC 61966-2-1)."""
    parts = np.array(mpl.colors.to_rgb(colour))
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    luminance = linear @ [0.2126, 0.7152, 0.0722]
    return 116 * luminance ** (1 / 3) - 16 if luminance > 0.008856 else 903.3 * luminance


def test_curves_can_be_told_apart_in_grey():
    """No two styles share a lightness, a marker or a line; the first four are far apart."""
    with mpl.style.context(STYLE):
        styles = list(mpl.rcParams["axes.prop_cycle"])
    light = [lightness(style["color"]) for style in styles]
    assert len(styles) == 8 and max(light) <= 72
    assert min(np.diff(sorted(light))) >= 4
    assert min(np.diff(sorted(light[:4]))) >= 13
    for key in ("marker", "linestyle"):
        assert len({str(style[key]) for style in styles}) == 8


# Less than an octave, a decade, many, small numbers, and those within a decade; others of these
# kinds are long tests
@pytest.mark.parametrize(
    "ends",
    [(0.39, 0.41), (0.3, 3.0), (1e-8, 1e3), (1e-6, 9e-5), (2e-6, 5e-6),
     *[(0.25, 0.56), (0.05, 40.0)] * EVERYTHING],
)  # fmt: skip
def test_labels_of_a_logarithmic_axis(results, ends):
    (axis,) = (made := figure([results / "sweep.h5"], log="xy")).axes
    axis.set(xscale="log", yscale="log", xlim=ends, ylim=ends)
    for which in (axis.xaxis, axis.yaxis):
        _label_decades(which)
        made.draw_without_rendering()
        ticks = [t for t in which.get_major_ticks() if ends[0] <= t.get_loc() <= ends[1]]
        assert len(ticks) >= 3
        boxes = [tick.label1.get_window_extent() for tick in ticks]
        assert not any(a.overlaps(b) for a, b in itertools.pairwise(boxes))
        words = [tick.label1.get_text() for tick in ticks]
        assert len(set(words)) == len(words)
        assert not any("e+" in word or "e-" in word for word in words)
        assert not any(label.get_text() for label in which.get_ticklabels(minor=True))


# The slowest has the longest numbers; others are long tests
@pytest.mark.parametrize("velocity", [0.02, *[0.5, 90.0] * EVERYTHING])
def test_room_for_the_ticks(results, tmp_path, velocity):
    """The labels of an axis stand apart, and within the picture, however long the contact is."""
    case = vcor.read(PAPER / "sls.nml")
    case["impact.velocity"] = velocity
    case.save(tmp_path / "case.nml")
    run = [os.environ["VCOR"], "run", tmp_path / "case.nml", "--quiet", "--output", tmp_path]
    subprocess.run(run, check=True)
    (path,) = tmp_path.glob("*.h5")
    for files, kind in (([path], "history"), ([path, path], "history"), ([path], "loop")):
        made = figure(files, kind=kind)
        made.draw_without_rendering()
        for axis in made.axes:
            for which in (axis.xaxis, axis.yaxis):
                low, high = which.get_view_interval()
                ticks = [tick for tick in which.get_major_ticks() if low <= tick.get_loc() <= high]
                boxes = [tick.label1.get_window_extent() for tick in ticks]
                assert len(boxes) >= 3
                assert not any(a.overlaps(b) for a, b in itertools.pairwise(boxes))
        inside = made.get_tightbbox().padded(-0.02)
        width, height = made.get_size_inches()
        assert inside.x0 >= 0 and inside.y0 >= 0 and inside.x1 <= width and inside.y1 <= height


# ---------------------------------------------------------------------------------- command


@pytest.mark.parametrize("ending", ["svg", "pdf", "png"])
def test_formats(results, tmp_path, ending, capsys):
    target = tmp_path / f"figure.{ending}"
    _command.call("plot", [str(results / "sweep.h5"), "--output", str(target)])
    assert capsys.readouterr().out == f"written {target}\n"
    start = {"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG"}[ending]
    first = target.read_bytes()
    assert first.startswith(start)
    save(figure([results / "sweep.h5"]), target)
    assert target.read_bytes() == first


def test_a_script_stands_in_no_package_s_way(results, tmp_path, capsys):
    for name in ("vcor", "numpy"):
        with pytest.raises(SystemExit):
            _command.call(
                "plot",
                [str(results / "sweep.h5"), "--script", "--output", f"{tmp_path}/{name}.svg"],
            )
        assert f"a script {name}.py would hide" in capsys.readouterr().err
        assert not (tmp_path / f"{name}.py").exists()


def test_a_folder(results, tmp_path):
    folder = tmp_path / "new" / "figures"
    _command.call(
        "plot", [str(results / "cube.h5"), "--output", str(folder), "--format", "png", "--quiet"]
    )
    assert [path.name for path in folder.iterdir()] == ["cube_map.png"]


@pytest.fixture(scope="module")
def bad(results):
    """Files that are not what is needed."""
    (results / "text.h5").write_text("hello\n" * 1000)
    (results / "nothing.h5").write_bytes(b"")
    whole = (results / "sweep.h5").read_bytes()
    (results / "cut.h5").write_bytes(whole[:3000])
    with h5py.File(results / "sweep.h5") as file:
        place = file["summary/cor"].id.get_chunk_info(0).byte_offset
    (results / "bit.h5").write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
    (results / "folder.h5").mkdir()
    (results / "link.svg").symlink_to("/dev/null")
    for name, values in (("still", [0.0, 0.0, 0.0]), ("part", None)):
        with h5py.File(results / f"{name}.h5", "w") as file:
            file["summary/cor"] = [0.5]
            for column in ("time", "indentation", "relative_velocity", "force"):
                if values:
                    file[f"history/{column}"] = [0.0, 1.0, 2.0] if column == "time" else values
            if not values:
                file["history/time"] = [0.0, 1.0]
    with h5py.File(results / "radius.h5", "w") as file:
        file["summary/sphere.radius"] = [1.0, 2.0]
        file["summary/sphere.radius"].make_scale()
        file["summary/cor"] = [0.5, 0.6]
        file["summary/cor"].dims[0].attach_scale(file["summary/sphere.radius"])
    with h5py.File(results / "empty.h5", "w"):
        pass
    (results / "few.csv").write_text("velocity,cor\n")
    (results / "words.csv").write_text("velocity,cor\n1,high\n")
    (results / "no_range.nml").write_text("&material name = 'x', model = 'rigid' /\n")
    return results


@pytest.mark.parametrize(
    "words, code, line",
    [
        (["gone.h5"], 4, r"gone\.h5: there is no such file"),
        (["text.h5"], 3, "this is no HDF5 file"),
        (["nothing.h5"], 3, "this is no HDF5 file"),
        (["cut.h5"], 4, "cannot be read"),
        (["bit.h5"], 4, "cannot be read"),
        (["folder.h5"], 4, "found a folder"),
        (["empty.h5"], 3, "no group 'summary'"),
        (["still.h5"], 3, "not that of an impact"),
        (["part.h5"], 3, "no 'indentation' in 'history'"),
        (["sweep.h5", "sls_ghost.h5"], 3, "for a figure of kind history"),
        (["sweep.h5", "radius.h5"], 3, "over 'sphere.radius', that of the first file"),
        (["sweep.h5", "--quantity", "force"], 2, "no quantity 'force', expected one of cor,"),
        (["sweep.h5", "--quantity", "status"], 2, "no quantity 'status'"),
        (["sls_ghost.h5", "--quantity", "cor"], 2, "--quantity.*history"),
        (["sweep.h5", "--kind", "loop"], 3, "no time history"),
        (["sls_ghost.h5", "--kind", "moduli"], 3, "no moduli"),
        (["sls_ghost.h5", "--kind", "sweep"], 3, "found 0 swept parameters"),
        (["sweep.h5", "--kind", "map"], 3, "a map needs a sweep of two parameters"),
        (["cube.h5", "cube.h5"], 2, "a map shows one file"),
        (["cube.h5", "--legend", "a"], 2, "without a legend"),
        (["sls_ghost.h5", "--legend", "a"], 2, "found --legend"),
        (["sls_material.h5", "--legend", "a"], 2, "found --legend"),
        (["bare.h5"], 3, r"output\.history = \.true\."),
        (["sls_ghost.h5"] * 9, 2, "at most 8"),
        (["few.csv"], 3, "found no numbers"),
        (["sweep.h5", "words.csv"], 3, "in column 'cor', expected a number"),
        (["no_range.nml"], 3, "valid_from"),
        (["sweep.h5", "--legend", "a", "--legend", "b"], 2, "--legend: found 2 for 1"),
        (["sweep.h5", "--legend", "a\tb"], 2, "control character"),
        (["sweep.h5", "a\nb.h5"], 2, "control character"),
        (["sweep.h5", "--range", "x=1"], 2, r"expected a range such as x=0\.1:10"),
        (["sweep.h5", "--range", "x=nan:1"], 2, "expected a range"),
        (["cube.h5", "--levels", "a"], 2, "or levels such as"),
        (["cube.h5", "--levels", "0.5"], 2, "expected two or more"),
        (["cube.h5", "--levels", "nan,1"], 2, "not a finite number"),
        (["cube.h5", "--levels", "inf,1"], 2, "not a finite number"),
        (["sweep.h5", "--log", "w"], 2, "expected letters among x, y, z"),
        (["sweep.h5", "--width", "1"], 2, "a width of 1 cm"),
        (["sweep.h5", "--width", "85"], 2, "such as 85mm"),
        (["sweep.h5", "--width", "8,5"], 2, "--width: found '8,5', expected"),
        (["sweep.h5", "--range", "x=100:200"], 2, r"x is impact velocity \[m/s\] from 1 to 50"),
        (["cube.h5", "--kind", "sweep"], 3, "expected --kind map"),
        (["sweep.h5", "--kind", "histroy"], 2, "'histroy'.*history"),
        (["sweep.h5", "--scrpt"], 2, "--scrpt.*--help"),
        ([], 2, "required: FILE"),
        (["sweep.h5", "--output", "a.svg", "--format", "pdf"], 2, "--format is pdf"),
        (["sweep.h5", "--output", "a.svgg"], 2, "unknown format 'svgg'"),
        (["sweep.h5", "--output", "link.svg"], 4, "device"),
        (["sweep.h5", "--output", "/proc/none/x.svg"], 4, "/proc/none"),
        (["sweep.h5", "--output", "text.h5/x.svg"], 4, "text.h5"),
        (["sweep.h5", "--output", "|touch x.svg"], 2, "pipe"),
        (["sweep.h5", "--output", "a/<x/"], 2, "pipe"),
    ],
)
def test_errors(bad, monkeypatch, capsys, words, code, line):
    monkeypatch.chdir(bad)
    before = sorted(bad.iterdir())
    with pytest.raises(SystemExit) as caught:
        _command.call("plot", words)
    out, err = capsys.readouterr()
    assert (caught.value.code, out) == (code, ""), err
    assert re.fullmatch(rf"vcor: error: .*{line}.*\n", err), err
    assert sorted(bad.iterdir()) == before


def test_no_damage_of_numbers_is_missed(results, tmp_path):
    """They have the check sums of HDF5."""
    whole = (results / "sls_ghost.h5").read_bytes()
    chunks = []
    with h5py.File(results / "sls_ghost.h5") as file:
        for group in file.values():
            for one in group.values():
                if one.dtype.kind in "fi":
                    assert one.fletcher32
                    chunks.append(one.id.get_chunk_info(0))
    lot = random.Random(1)
    for _ in range(100 if EVERYTHING else 10):
        data = bytearray(whole)
        chunk = lot.choice(chunks)
        data[chunk.byte_offset + lot.randrange(chunk.size)] ^= 1 << lot.randrange(8)
        (tmp_path / "a.h5").write_bytes(data)
        with pytest.raises(vcor.FileError, match="cannot be read"):
            for group in ("summary", "history"):
                vcor.open(tmp_path / "a.h5", group)
    os.mkfifo(tmp_path / "pipe.h5")
    with pytest.raises(vcor.FileError, match="expected a file of results"):
        vcor.open(tmp_path / "pipe.h5")


NAMES = ["$(touch X)", "x'; touch X; '", 'x".system("touch X")."', "-e {x}", "#x \\", "Stoß_α"]


def test_names_are_names(results, tmp_path, monkeypatch):
    """As the name of a figure, of its folder and of the file of results; the scripts make the same
    figures, that with other options too."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "points ' \".csv").write_text("velocity,cor\n5,0.4\n")
    drawn = {}
    for name in NAMES:
        shutil.copy(results / "sweep.h5", f"{name}.h5")
        words = ["--quiet", "--script", f"--output={name}/"]
        _command.call("plot", [*words, "--", f"./{name}.h5", "points ' \".csv"])
        drawn[f"{name}/{name}_sweep"] = None
    words = ["--log", "x", "--range", "y=0:1", "--legend", "it's one", "--script", "--quiet"]
    _command.call("plot", [*words, f"--output=out/{NAMES[1]}.svg", "--", f"{NAMES[0]}.h5"])
    drawn[f"out/{NAMES[1]}"] = None
    for path in drawn:
        drawn[path] = Path(f"{path}.svg").read_bytes()
        Path(f"{path}.svg").unlink()
    for path in drawn:
        script = tmp_path / f"{path}.py"
        with monkeypatch.context() as patch:
            patch.chdir(script.parent)
            runpy.run_path(script.name, run_name="__main__")
    for path, first in drawn.items():
        assert Path(f"{path}.svg").read_bytes() == first, path
    assert not list(tmp_path.rglob("X"))


@pytest.mark.parametrize("mask, mode", [(0o022, 0o644), (0o077, 0o600)])
def test_permissions(results, tmp_path, mask, mode):
    """Files have the permissions that the umask leaves, and a link is replaced by the file."""
    (tmp_path / "victim").write_text("precious")
    (tmp_path / "b.svg").symlink_to(tmp_path / "victim")
    before = os.umask(mask)
    try:
        for name in ("a", "b"):
            target = f"{tmp_path}/{name}.svg"
            _command.call(
                "plot", [str(results / "sweep.h5"), "--output", target, "--script", "--quiet"]
            )
    finally:
        os.umask(before)
    assert (tmp_path / "victim").read_text() == "precious"
    assert not (tmp_path / "b.svg").is_symlink()
    for name in ("a.svg", "a.py", "b.py"):
        assert (tmp_path / name).stat().st_mode & 0o777 == mode
    assert len(list(tmp_path.iterdir())) == 5


def test_a_name_that_begins_a_pipe(results, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    shutil.copy(results / "sweep.h5", "|touch x.h5")
    with pytest.raises(SystemExit) as caught:
        _command.call("plot", ["|touch x.h5"])
    assert caught.value.code == 4 and "pipe" in capsys.readouterr().err
    _command.call("plot", ["|touch x.h5", "--output", "figure.svg", "--quiet"])
    assert Path("figure.svg").exists()


def test_results_are_not_replaced(results, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "points.svg").write_text("velocity,cor\n5,0.4\n")
    words = [str(results / "sweep.h5"), "points.svg", "--output", "./points.svg"]
    with pytest.raises(SystemExit) as caught:
        _command.call("plot", words)
    assert caught.value.code == 2 and "would replace" in capsys.readouterr().err


def test_the_package_that_is_missing(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.delitem(sys.modules, "vcor.plot")
    monkeypatch.delitem(sys.modules, "vcor.materials.plot_command", raising=False)
    with pytest.raises(SystemExit) as caught:
        _command.plot()
    assert caught.value.code == 2
    line = "vcor: error: vcor plot needs the Python package matplotlib, expected: pip install"
    assert capsys.readouterr().err == f"{line} matplotlib\n"


def test_help(capsys):
    with pytest.raises(SystemExit) as caught:
        _command.call("plot", ["--help"])
    page = capsys.readouterr().out
    assert caught.value.code == 0 and page.startswith("usage: vcor plot ")
    for word in ("--kind", "--log", "--range", "--levels", "--no-hatch", "--script", *KINDS):
        assert word in page


def test_figures_of_cases_without_a_file():
    """The same curves as from a file; a sweep is drawn as such."""
    case = vcor.read(ROOT / "examples/paper/sls.nml")
    one, other = case.plot("history"), vcor.plot.history(case, width=6.0)
    assert texts(one) == texts(other) and len(one.axes[0].lines) > 3
    assert other.get_size_inches()[0] == pytest.approx(6.0 / 2.54)
    assert case.plot("loop", xlabel="approach [mm]").axes[0].get_xlabel() == "approach [mm]"
    case["output.history"] = False
    sweep = vcor.Case(case.text() + "\n&sweep parameter = 'impact.velocity', values = 1.0, 2.0 /")
    assert sweep.plot().axes[0].get_xlabel() == "impact velocity [m/s]"
    assert "plot" in dir(vcor) and "read" in dir(vcor) and "np" not in dir(vcor)


def test_labels_of_axes_and_points(tmp_path):
    """A text for each file of points, and for an axis that all panels have."""
    sweep = vcor.read(ROOT / "examples/sweeps/sls_velocity.nml").run()
    points = tmp_path / "drops.csv"
    points.write_text("velocity [m/s], cor\n2.0, 0.4\n5.0, 0.42\n")
    made = vcor.plot.figure([sweep, points], labels="by film", xlabel="speed", ylabel="e")
    assert "by film" in [text.get_text() for text in made.legends[0].get_texts()]
    assert (made.axes[0].get_xlabel(), made.axes[0].get_ylabel()) == ("speed", "e")
    curve = made.axes[0].lines[0]
    assert curve.get_marker() in ("", "None", None)
    with pytest.raises(vcor.UsageError, match="labels: found 1 for 0"):
        vcor.plot.figure([sweep], labels="by film")
    with pytest.raises(vcor.UsageError, match="the panels have several"):
        vcor.plot.figure([sweep], quantities=["cor", "max_force"], ylabel="e")


def test_validity_is_no_quantity_with_an_axis(results):
    with pytest.raises(vcor.UsageError, match="validity is hatched behind every quantity"):
        vcor.plot.figure([results / "sweep.h5"], quantities=["validity"])


def test_points_beyond_the_data_are_marked(results):
    sweep = vcor.open(results / "sweep.h5")
    (axis,) = sweep.coords
    out = np.arange(sweep.sizes[axis]) == 1
    made = vcor.plot.figure(sweep.assign(beyond=(axis, out)))
    (marks,) = [line for line in made.axes[0].lines if "beyond" in str(line.get_label())]
    np.testing.assert_array_equal(marks.get_xdata(), sweep[axis].values[out])


def test_moduli_at_several_temperatures_are_refused(results):
    data = ROOT / "examples/identification/dma.csv"
    with pytest.raises(vcor.InputError, match="13 temperatures.*vcor.master"):
        vcor.plot.figure([results / "sls_material.h5", data])


def test_a_legend_has_one_unit_of_energy(results):
    """Also where the losses are on both sides of 1 J."""
    files = [results / "sls_ghost.h5", results / "butyl_prony_ghost.h5"]
    lost = [1e3 * vcor.open(file)["hysteresis_energy"].item() for file in files]
    assert lost[0] < 1000 < lost[1]
    words = texts(figure(files, kind="loop"))
    assert [word.rpartition(" ")[2] for word in words] == ["J", "J"]


def test_every_level_inside_the_frame_has_its_number():
    made = vcor.read(ROOT / "examples/sweeps/velocity_and_radius.nml").plot(
        quantities=["wave_energy"], log="z"
    )
    shown = [text.get_text() for text in made.axes[0].texts if text.get_visible()]
    # of eight levels two cut a corner
    assert len(shown) == 7 and len(set(shown)) == len(shown)
