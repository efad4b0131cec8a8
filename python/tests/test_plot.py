"""Figures: what they show, and how the command answers."""

import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import PAPER, SWEEPS

import vcor
from vcor.plot import figure, main, save


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Files of results of all kinds."""
    import os

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
    assert f"{end:.4g} ms" in axis.get_title()
    indentation, velocity, force = curves(axis)
    for line, at_end in (
        (indentation, summary.residual_ratio),
        (velocity, summary.cor),
        (force, 0.0),
    ):
        assert line.get_xdata()[-1] == pytest.approx(end)
        assert line.get_ydata()[-1] == pytest.approx(float(at_end), abs=2e-3)
        assert np.max(line.get_ydata()) <= 1.001
    dashed = [line for line in axis.lines if line.get_linestyle() == "--"]
    assert len(dashed) == 3
    assert dashed[0].get_xdata()[-1] > end
    assert f"COR {float(summary.cor):.4g}" in [text.get_text() for text in axis.texts]


def test_two_histories(results):
    made = figure([results / "sls_ghost.h5", results / "butyl_prony_ghost.h5"])
    assert [axis.get_title(loc="left") for axis in made.axes] == ["(a)", "(b)", "(c)"]
    assert len(texts(made)) == 2 and all("COR 0." in text for text in texts(made))
    assert made.get_size_inches()[0] == pytest.approx(17 / 2.54)


def test_a_loop(results):
    path = results / "sls_ghost.h5"
    made = figure([path], kind="loop")
    (line,) = curves(made.axes[0])
    x, y = 1e-3 * line.get_xdata(), line.get_ydata()
    lost = float(vcor.open(path).hysteresis_energy)
    assert np.trapezoid(y, x) == pytest.approx(lost, rel=1e-3)
    assert texts(made) == [f"energy loss {1e3 * lost:.4g} mJ"]
    assert y[-1] == pytest.approx(0.0, abs=1.0)


def test_moduli(results):
    made = figure([results / "sls_material.h5"])
    relaxation, moduli, tangent = made.axes
    rubber = vcor.read(PAPER / "sls.nml").material("rubber")
    line = relaxation.lines[0]
    np.testing.assert_allclose(line.get_ydata(), 1e-6 * rubber.relaxation(line.get_xdata()))
    assert len(curves(moduli)) == 2 and len(curves(tangent)) == 1
    both = figure([results / "sls_material.h5", results / "butyl_prony_material.h5"])
    assert len(both.axes) == 4 and len(texts(both)) == 2


def test_a_sweep(results):
    names = ["cor", "contact_time", "max_force"]
    made = figure([results / "sweep.h5", results / "soft.h5"], quantities=names)
    data = vcor.open(results / "sweep.h5")
    assert len(made.axes) == 3
    np.testing.assert_array_equal(curves(made.axes[0])[0].get_ydata(), data.cor)
    np.testing.assert_allclose(curves(made.axes[1])[0].get_ydata(), 1e3 * data.contact_time)
    assert made.axes[1].get_ylabel() == "contact time [ms]"
    assert any("rubber.beta = 900" in text for text in texts(made))
    given = figure([results / "sweep.h5", results / "soft.h5"], legends=["one", "two"])
    assert texts(given)[:2] == ["one", "two"]


def test_a_map(results):
    made = figure([results / "cube.h5"])
    axis, bar = made.axes
    assert axis.get_ylabel() == "sphere radius [mm]"
    assert axis.get_yscale() == "log" and axis.get_xscale() == "linear"
    assert bar.get_ylabel() == "coefficient of restitution"
    narrow = figure([results / "cube.h5"], ranges={"z": (0.4, 0.8), "x": (5.0, None)})
    assert narrow.axes[0].collections[0].get_clim() == (0.4, 0.8)
    assert narrow.axes[0].get_xlim()[0] == 5.0


def test_where_the_model_does_not_hold(results):
    data = vcor.open(results / "sweep.h5")
    made = figure([results / "sweep.h5"])
    spans = [patch for patch in made.axes[0].patches if patch.get_hatch()]
    hatched = any(data.validity == "outside")
    assert bool(spans) == hatched == ("outside of the model's validity" in texts(made))
    for patch in spans:
        low, high = patch.get_x(), patch.get_x() + patch.get_width()
        v = data["impact.velocity"]
        inside = data.validity.values[(v > low) & (v < high)]
        assert (inside == "outside").all()


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
    (tmp_path / "moduli.csv").write_text("omega [kHz],storage_modulus [MPa]\n1,5\n2,6\n")
    made = figure([results / "sls_material.h5", tmp_path / "moduli.csv"])
    (bar,) = made.axes[1].containers
    np.testing.assert_allclose(bar.lines[0].get_xdata(), 2e3 * np.pi * np.array([1, 2]))
    np.testing.assert_allclose(bar.lines[0].get_ydata(), [5, 6])
    (tmp_path / "force.csv").write_text("time [ms],force\n0.5,500\n")
    made = figure([results / "sls_ghost.h5", tmp_path / "force.csv"])
    (bar,) = made.axes[0].containers
    assert bar.lines[0].get_ydata()[0] == pytest.approx(
        500 / float(vcor.open(results / "sls_ghost.h5").max_force)
    )
    (tmp_path / "other.csv").write_text("speed,rebound\n1,2\n")
    with pytest.raises(vcor.InputError, match="speed, rebound"):
        figure([results / "sweep.h5", tmp_path / "other.csv"])
    (tmp_path / "unit.csv").write_text("velocity [kn],cor\n1,2\n")
    with pytest.raises(vcor.InputError, match="unknown unit 'kn'"):
        figure([results / "sweep.h5", tmp_path / "unit.csv"])


def test_axes_that_are_wanted(results):
    made = figure([results / "sweep.h5"], log="xy", ranges={"y": (0.1, 1.0)}, width=12)
    (axis,) = made.axes
    assert (axis.get_xscale(), axis.get_yscale()) == ("log", "log")
    assert axis.get_ylim() == (0.1, 1.0)
    assert made.get_size_inches()[0] == pytest.approx(12 / 2.54)


# ---------------------------------------------------------------------------------- command


@pytest.mark.parametrize("ending", ["svg", "pdf", "png"])
def test_formats(results, tmp_path, ending, capsys):
    target = tmp_path / f"figure.{ending}"
    main([str(results / "sweep.h5"), "--output", str(target)])
    assert capsys.readouterr().out == f"written {target}\n"
    start = {"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG"}[ending]
    first = target.read_bytes()
    assert first.startswith(start)
    save(figure([results / "sweep.h5"]), target)
    assert target.read_bytes() == first


def test_a_script_makes_the_same_figure(results, tmp_path):
    words = ["--log", "x", "--range", "y=0:1", "--legend", "it's one", "--script", "--quiet"]
    main([str(results / "sweep.h5"), *words, "--output", str(tmp_path / "a.svg")])
    first = (tmp_path / "a.svg").read_bytes()
    (tmp_path / "a.svg").unlink()
    subprocess.run([sys.executable, "a.py"], cwd=tmp_path, check=True)
    assert (tmp_path / "a.svg").read_bytes() == first


def test_a_folder(results, tmp_path):
    folder = tmp_path / "new" / "figures"
    main([str(results / "cube.h5"), "--output", str(folder), "--format", "png", "--quiet"])
    assert [path.name for path in folder.iterdir()] == ["cube_map.png"]


@pytest.mark.parametrize(
    "words, code, line",
    [
        (["gone.h5"], 4, r"gone\.h5: there is no such file"),
        (["sweep.h5", "sls_ghost.h5"], 3, "for a figure of kind history"),
        (["sweep.h5", "--quantity", "force"], 2, "no quantity 'force', expected one of cor,"),
        (["sweep.h5", "--kind", "loop"], 3, "no time history"),
        (["bare.h5"], 3, r"output\.history = \.true\."),
        (["sweep.h5", "--legend", "a", "--legend", "b"], 2, "found 2 --legend for 1"),
        (["sweep.h5", "--range", "x=1"], 2, r"expected such as x=0\.1:10"),
        (["cube.h5", "--kind", "sweep"], 3, "expected --kind map"),
        (["sweep.h5", "--output", "a.svg", "--format", "pdf"], 2, "contradicts --format pdf"),
    ],
)
def test_errors(results, monkeypatch, capsys, words, code, line):
    monkeypatch.chdir(results)
    with pytest.raises(SystemExit) as caught:
        main(words)
    out, err = capsys.readouterr()
    assert (caught.value.code, out) == (code, "")
    assert re.fullmatch(rf"vcor: error: .*{line}.*\n", err)
