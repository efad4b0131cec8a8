"""Figures: what is in them, not only that they are there."""

import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree

import h5py
import numpy as np
import pytest
from cases import SLS, case_text
from figure import blocks, crowded, places, plots, texts
from program import FILE, INPUT, PAPER, ROOT, USAGE, Vcor, complaint, contents

SWEEP = ROOT / "examples" / "sweeps"
FEW = ["--set", "sweep.count=6"]
GRID = """
&sweep
   parameter = 'impact.velocity'
   values = {velocities}
/
&sweep
   parameter = 'rubber.beta'
   values = {betas}
/
"""


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """A folder with files of results."""
    vcor = Vcor(tmp_path_factory.mktemp("results"))
    names = ["sls", "sls_ghost", "butyl_prony_ghost", "butyl_power_law_printed"]
    vcor.succeeds("run", "--quiet", *[PAPER / f"{name}.nml" for name in names])
    for name in ("sls_velocity", "butyl_prony_velocity", "butyl_cerf_velocity"):
        vcor.succeeds("run", "--quiet", SWEEP / f"{name}.nml", *FEW)
    grid = SLS + GRID.format(
        velocities="1.0, 2.0, 4.0, 8.0, 16.0, 32.0", betas="600.0, 1200.0, 2400.0"
    )
    vcor.write(grid, "grid.nml")
    vcor.succeeds("run", "--quiet", "grid.nml")
    for name in ("sls", "butyl_cerf", "butyl_prony"):
        vcor.succeeds("material", "--quiet", PAPER / f"{name}.nml")
    for path in vcor.folder.glob("*.csv"):
        path.unlink()
    return vcor.folder


@pytest.fixture
def plot(vcor, results):
    """Draw results in the folder of the test; the figure."""

    def draw(*words, name="figure.svg"):
        files = [results / word if str(word).endswith(".h5") else word for word in words]
        out = vcor.succeeds("plot", *files, "--output", name)
        assert out.splitlines()[0] == f"written {name}"
        return vcor.folder / name

    return draw


def test_history(vcor, results, plot):
    """Fig. 2: three lines, each with its dashed continuation and its value at t0."""
    figure = plot("sls_ghost.h5", "--script")
    found = texts(figure)
    for text in (
        "time [ms]",
        "normalised response",
        "indentation s/smax",
        "velocity −s′/v0",
        "force F/Fmax",
    ):
        assert text in found
    cor, ratio, time = vcor.succeeds(
        "run", PAPER / "sls_ghost.nml", "--print", "cor,residual_ratio,contact_time"
    ).split()
    assert f"COR {float(cor):.4f}" in found
    assert f"{float(ratio):.4f}" in found
    assert f"t0 = {1e3 * float(time):.3f} ms" in found
    assert plots(figure) == 9
    script = (vcor.folder / "figure.gp").read_text()
    assert len(re.findall(r"data index \d+ using 1:2 with lines ls \d dt \(", script)) == 3

    curves = blocks(vcor.folder / "figure.dat")
    assert len(curves) == 9
    for place, at_end in ((0, float(ratio)), (3, float(cor)), (6, 0.0)):
        line, ghost, point = curves[place : place + 3]
        t0 = 1e3 * float(time)
        assert line[0][0] == 0.0 and line[-1] == ghost[0]
        assert line[-1][0] == pytest.approx(t0, rel=1e-9)
        assert point[0] == pytest.approx((t0, at_end), abs=1e-9)
        # the line ends at the value that is marked, but for what lies between two times
        assert line[-1][1] == pytest.approx(at_end, abs=2e-4)
        assert ghost[-1][0] == pytest.approx(2.0, rel=1e-9)
    assert max(y for _, y in curves[0]) == pytest.approx(1, abs=1e-3)
    assert curves[3][0][1] == -1.0
    assert max(y for _, y in curves[6]) == pytest.approx(1, abs=1e-3)


def test_history_without_ghost_lines(plot):
    figure = plot("sls.h5", "--kind", "history")
    assert plots(figure) == 6
    assert "COR 0.4320" in texts(figure)


def test_several_histories(plot):
    """A panel for each response, one legend."""
    figure = plot("sls_ghost.h5", "butyl_prony_ghost.h5")
    found = texts(figure)
    for text in ("indentation s/smax", "velocity −s′/v0", "force F/Fmax"):
        assert found.count(text) == 1
    assert found.count("time [ms]") == 3
    assert plots(figure) == 18
    legend = [text for text in found if "COR" in text]
    assert len(legend) == 2
    assert legend[0].startswith("SLS with ghost lines: COR 0.4313, t0 = 1.342 ms")
    assert legend[1].startswith("BUTYL-B252, Prony series")


def test_history_without_separation(vcor):
    vcor.write(SLS)
    done = vcor("run", "--quiet", "case.nml", "--set", "solver.end_time=5e-4")
    assert done.code == 5
    vcor.succeeds("plot", "case.h5", "--quiet")
    figure = vcor.folder / "case_history.svg"
    assert plots(figure) == 3
    assert not any("COR" in text for text in texts(figure))
    vcor.succeeds("plot", "case.h5", "case.h5", "--legend", "a", "--legend", "b", "--quiet")
    assert "a: no separation" in texts(figure)


@pytest.mark.parametrize("velocity", [0.02, 0.5, 10.0, 90.0])
def test_room_for_the_ticks(vcor, velocity):
    """The labels of an axis stand apart, however long the contact is."""
    vcor.write(SLS)
    for method in ("sls", "none"):
        words = ["--set", f"impact.velocity={velocity}", "--set", f"output.stem={method}"]
        if method == "none":
            words += ["--set", "plate.waves=none"]
        vcor.succeeds("run", "--quiet", "case.nml", *words)
    for files in (["sls.h5"], ["sls.h5", "none.h5"]):
        for kind in ("history", "loop"):
            vcor.succeeds("plot", *files, "--kind", kind, "--output", "figure.svg")
            ticks = [text for text, _, y, _, at in places(vcor.folder / "figure.svg") if at == "middle"]
            assert sum(bool(re.fullmatch(r"[\d.e+-]+", text)) for text in ticks) >= 3
            assert crowded(vcor.folder / "figure.svg") == []


@pytest.mark.parametrize(
    "sweep",
    [
        "parameter = 'rubber.beta', start = 0.0003, stop = 0.0011, count = 3",
        "parameter = 'rubber.beta', start = 1200.1, stop = 1200.7, count = 3",
        "parameter = 'rubber.beta', start = 1.1e6, stop = 3.7e6, count = 3",
        "parameter = 'rubber.beta', start = 0.0002, stop = 0.05, count = 5, spacing = 'log'",
        "parameter = 'rubber.beta', start = 1e6, stop = 2e8, count = 5, spacing = 'log'",
        "parameter = 'rubber.beta', start = 1e3, stop = 3e3, count = 5, spacing = 'log'",
    ],
)
def test_room_for_the_ticks_of_a_sweep(vcor, sweep):
    vcor.write(SLS + f"&sweep\n {sweep}\n/\n")
    vcor.succeeds("run", "--quiet", "case.nml", "--set", "rubber.alpha=1e-4")
    vcor.succeeds("plot", "case.h5", "--quantity", "cor,max_force", "--output", "figure.svg")
    assert crowded(vcor.folder / "figure.svg") == []
    below = max(y for _, _, y, _, at in places(vcor.folder / "figure.svg") if at == "middle")
    labels = [text for text, _, y, _, _ in places(vcor.folder / "figure.svg") if below - 30 < y < below]
    assert len(labels) >= 2


def test_very_small_numbers(plot):
    """Powers of ten stand in the label: they would not find room beside the axis."""
    figure = plot("sls_velocity.h5", "--quantity", "cor_error")
    (label,) = [text for text in texts(figure) if text.startswith("estimated error of cor")]
    assert re.fullmatch(r"estimated error of cor \[10-\d+\]", label)
    assert all(len(text) < 5 for text, _, _, _, anchor in places(figure) if anchor == "end")


def test_legend_of_one_file(vcor, results, plot):
    """It is shown, or refused where nothing is there that it could stand beside."""
    found = texts(plot("sls.h5", "--kind", "loop", "--legend", "my text"))
    assert "my text, energy loss 0.7918 J" in found
    assert "my text" in texts(plot("sls_velocity.h5", "--legend", "my text"))
    for name, kind in (("sls", "history"), ("sls_material", "moduli"), ("grid", "map")):
        vcor.refuses("plot", results / f"{name}.h5", "--legend", "x", code=USAGE, says=["--legend", kind])


def test_quantity_of_an_impact(vcor, results):
    vcor.refuses(
        "plot", results / "sls.h5", "--quantity", "cor", code=USAGE, says=["--quantity", "history"]
    )


def test_loop(vcor, results, plot):
    """Fig. 3: force over indentation, up to t0 only."""
    figure = plot("sls_ghost.h5", "butyl_power_law_printed.h5", "--kind", "loop", "--script")
    found = texts(figure)
    assert "indentation [mm]" in found and "contact force [N]" in found
    assert any(text.endswith(", energy loss 0.7932 J") for text in found)
    assert any(text.endswith(", energy loss 1.172 J") for text in found)
    assert plots(figure) == 2
    sls, butyl = blocks(vcor.folder / "figure.dat")
    assert sls[0] == butyl[0] == (0.0, 0.0)
    assert max(x for x, _ in sls) == pytest.approx(4.5, abs=0.05)
    assert max(y for _, y in sls) == pytest.approx(600.7, abs=0.1)
    assert max(x for x, _ in butyl) == pytest.approx(2.19, abs=0.005)
    assert max(y for _, y in butyl) == pytest.approx(921.7, abs=0.1)
    # between two times the force is not quite zero
    assert abs(sls[-1][1]) < 0.1 and abs(butyl[-1][1]) < 0.5
    # the area is the energy, mm N = mJ
    area = sum((a + b) / 2 * (x - w) for (w, a), (x, b) in zip(sls, sls[1:], strict=False))
    assert area / 1e3 == pytest.approx(0.7932, rel=1e-3)


def test_loop_of_one(plot):
    found = texts(plot("sls.h5", "--kind", "loop"))
    assert "energy loss 0.7918 J" in found


@pytest.mark.parametrize("accuracy", ["1e-8", "1e-5"])
def test_loop_without_loss(vcor, accuracy):
    """The rounding of an elastic contact is no loss, and no gain: the legend tells a bound."""
    vcor.write(case_text("elastic"))
    words = ["--set", "output.stem=ball", "--set", f"solver.accuracy={accuracy}"]
    vcor.succeeds("run", "case.nml", *words, "--output", ".", "--quiet")
    vcor.succeeds("plot", "ball.h5", "--kind", "loop", "--output", "figure.svg")
    (text,) = [text for text in texts(vcor.folder / "figure.svg") if "energy" in text]
    number, prefix = re.fullmatch(r"energy loss < ([\d.]+) ([nµ])J", text).groups()
    with h5py.File(vcor.folder / "ball.h5") as file:
        bound, loss = 6 * file["summary/cor_error"][0], abs(file["summary/hysteresis_energy"][0])
        bound *= file["summary/initial_energy"][0]
    assert float(number) * {"n": 1e-9, "µ": 1e-6}[prefix] == pytest.approx(bound, rel=0.5)
    assert loss < bound


def test_moduli(vcor, plot):
    """Fig. 1: the window of the impact is marked."""
    figure = plot("sls_material.h5", "--script")
    found = texts(figure)
    for text in (
        "time [s]",
        "relaxation modulus [MPa]",
        "angular frequency [rad/s]",
        "storage and loss modulus [MPa]",
        "loss tangent",
        "storage modulus E′",
        "loss modulus E″",
        "loss tangent tan δ",
        "t0 = 1.342 ms",
        "ωmin = 4684 rad/s",
    ):
        assert text in found
    assert plots(figure) == 4
    relaxation, storage, loss, tangent = blocks(vcor.folder / "figure.dat")
    for time, modulus in relaxation:
        assert modulus == pytest.approx(15 * (0.25 + 0.75 * np.exp(-1200 * time)), rel=1e-8)
    for (w, e1), (_, e2), (_, tan) in zip(storage, loss, tangent, strict=True):
        complex_modulus = 15 * (300 + 1j * w) / (1200 + 1j * w)
        assert complex(e1, e2) == pytest.approx(complex_modulus, rel=1e-8)
        assert tan == pytest.approx(e2 / e1, rel=1e-8)


def test_several_moduli(plot):
    """Fig. 5: a panel for each modulus, the windows in the legend."""
    figure = plot("butyl_cerf_material.h5", "butyl_prony_material.h5")
    found = texts(figure)
    for text in ("relaxation modulus", "storage modulus", "loss modulus"):
        assert f"{text} [MPa]" in found
    assert "loss tangent" in found
    assert plots(figure) == 8
    assert any("Prony" in text and "t0 = 0.7871 ms" in text for text in found)
    assert any("CERF" in text and "t0 = 0.7606 ms" in text for text in found)


def test_sweep(vcor, plot):
    """Fig. 8: a curve for each file, with what differs in the titles as its text."""
    figure = plot("butyl_prony_velocity.h5", "butyl_cerf_velocity.h5", "--script")
    found = texts(figure)
    assert "impact velocity [m/s]" in found
    assert "coefficient of restitution" in found
    assert "Prony series" in found
    assert "Mittag-Leffler (CERF) model" in found
    assert plots(figure) == 2
    prony, cerf = blocks(vcor.folder / "figure.dat")
    assert [x for x, _ in prony] == pytest.approx(np.linspace(1, 50, 6))
    assert all(a > b for (_, a), (_, b) in zip(prony, cerf, strict=True))
    cor = vcor.succeeds(
        "run", SWEEP / "butyl_prony_velocity.nml", *FEW, "--print", "cor"
    ).split()
    assert [y for _, y in prony] == pytest.approx([float(word) for word in cor], rel=1e-8)


def test_quantities(plot):
    """Fig. 9: a panel for each."""
    names = "contact_time,min_frequency,max_indentation,max_force"
    figure = plot("butyl_cerf_velocity.h5", "--quantity", names)
    found = texts(figure)
    for text in (
        "contact time [ms]",
        "lowest frequency of interest [rad/s]",
        "largest indentation [mm]",
        "largest contact force [kN]",
    ):
        assert text in found
    assert found.count("impact velocity [m/s]") == 4
    assert plots(figure) == 4


def test_sweep_that_is_logarithmic(vcor):
    text = SLS + (
        "&sweep\n parameter = 'sphere.radius'\n start = 1e-4\n stop = 1e-2\n"
        " count = 5\n spacing = 'log'\n/\n"
    )
    vcor.write(text)
    vcor.succeeds("run", "--quiet", "case.nml")
    vcor.succeeds("plot", "case.h5", "--script")
    assert "set logscale x" in (vcor.folder / "case_sweep.gp").read_text()
    assert "sphere radius [mm]" in texts(vcor.folder / "case_sweep.svg")
    words = ["--set", "sweep.spacing='linear'", "--set", "output.stem=even"]
    vcor.succeeds("run", "--quiet", "case.nml", *words)
    vcor.succeeds("plot", "even.h5", "--script")
    assert "set logscale x" not in (vcor.folder / "even_sweep.gp").read_text()


def test_values_in_any_order(vcor):
    values = "9.0, 1.0, 5.0, 3.0"
    vcor.write(SLS + f"&sweep\n parameter = 'impact.velocity'\n values = {values}\n/\n")
    vcor.succeeds("run", "--quiet", "case.nml")
    vcor.succeeds("plot", "case.h5", "--script")
    (line,) = blocks(vcor.folder / "case_sweep.dat")
    assert [x for x, _ in line] == [1.0, 3.0, 5.0, 9.0]
    cor = dict(
        zip(
            (9.0, 1.0, 5.0, 3.0),
            map(float, vcor.succeeds("run", "case.nml", "--print", "cor").split()),
            strict=True,
        )
    )
    assert [y for _, y in line] == pytest.approx([cor[x] for x, _ in line], rel=1e-8)


def test_sweep_of_two_parameters(plot):
    """Curves over the parameter with more values."""
    figure = plot("grid.h5", "--kind", "sweep")
    found = texts(figure)
    assert plots(figure) == 3
    assert "impact velocity [m/s]" in found
    for beta in (600, 1200, 2400):
        assert f"rubber beta = {beta} 1/s" in found


def test_what_differs_is_the_legend(vcor):
    """Runs with one title: values that differ tell them apart."""
    vcor.write(SLS + "&sweep\n parameter = 'impact.velocity'\n values = 1.0, 5.0, 9.0\n/\n")
    files = []
    for beta in (600, 1200):
        setting = [f"rubber.beta={beta}", f"rubber.alpha={beta / 4}", f"output.stem=b{beta}"]
        words = [word for value in setting for word in ("--set", value)]
        vcor.succeeds("run", "--quiet", "case.nml", *words)
        files.append(f"b{beta}.h5")
    vcor.succeeds("plot", *files)
    found = texts(vcor.folder / "b600_sweep.svg")
    assert "alpha = 150 1/s, beta = 600 1/s" in found
    assert "alpha = 300 1/s, beta = 1200 1/s" in found
    # the same case twice: the files
    shutil.copy(vcor.folder / "b600.h5", vcor.folder / "again_1.h5")
    vcor.succeeds("plot", "b600.h5", "again_1.h5")
    found = texts(vcor.folder / "b600_sweep.svg")
    assert "b600" in found and "again_1" in found


TITLE = "a_b {c} <d> & \"e\" 'f' ''g'' h^2 @x ~y `z` $HOME 100% α \\n"


def test_texts_stand_for_themselves(vcor, results):
    """Nothing in a title is a mark to gnuplot, or a command."""
    words = ["--legend", TITLE, "--legend", "plain", "--output", "figure.svg"]
    files = [results / "sls_velocity.h5", results / "butyl_prony_velocity.h5"]
    # two panels: a page has room for it
    vcor.succeeds("plot", *files, *words, "--quantity", "cor,max_force")
    assert TITLE in texts(vcor.folder / "figure.svg")
    ElementTree.parse(vcor.folder / "figure.svg")


def test_long_texts_are_cut(vcor, results):
    words = ["--legend", "x" * 300, "--legend", "ä" * 300, "--output", "figure.svg"]
    vcor.succeeds("plot", results / "sls.h5", results / "sls_ghost.h5", "--kind", "loop", *words)
    found = texts(vcor.folder / "figure.svg")
    assert any(re.fullmatch("x{15,30}…, energy loss .*", text) for text in found)
    assert any(re.fullmatch("ä{15,30}…, energy loss .*", text) for text in found)


def test_map(vcor, results, plot):
    """Filled areas, a line and a text for each level."""
    figure = plot("grid.h5", "--script")
    found = texts(figure)
    assert "rubber beta [1/s]" in found
    assert "impact velocity [m/s]" in found
    assert "coefficient of restitution" in found
    with h5py.File(results / "grid.h5") as file:
        cor = file["summary/cor"][:]
    # gnuplot draws a text twice, the first time for the box behind it
    levels = {float(text) for text in found if re.fullmatch(r"0\.\d+", text)}
    assert len(levels) >= 4
    assert all(cor.min() < level < cor.max() for level in levels)
    script = (vcor.folder / "figure.gp").read_text()
    areas = script.count("filledcurves")
    lines = script.count("with lines")
    assert lines >= len(levels) and areas > lines
    assert plots(figure) == areas + lines
    # the first area is the whole map
    whole = blocks(vcor.folder / "figure.dat")[0]
    assert {min(x for x, _ in whole), max(x for x, _ in whole)} == {1.0, 32.0}
    assert {min(y for _, y in whole), max(y for _, y in whole)} == {600.0, 2400.0}


def test_map_with_holes(vcor):
    """Points without a result are white."""
    text = SLS + GRID.format(velocities="1.0, -1.0, 4.0, 8.0, 9.0", betas="600.0, 700.0, 800.0")
    vcor.write(text)
    assert vcor("run", "--quiet", "case.nml").code == 5
    vcor.succeeds("plot", "case.h5", "--script")
    script = (vcor.folder / "case_map.gp").read_text()
    assert plots(vcor.folder / "case_map.svg") >= 3
    vcor.succeeds("plot", "case.h5", "--kind", "sweep")
    assert plots(vcor.folder / "case_sweep.svg") == 3
    assert "filledcurves" in script


def test_nothing_but_holes(vcor):
    vcor.write(SLS + "&sweep\n parameter = 'impact.velocity'\n values = -1.0, -2.0\n/\n")
    assert vcor("run", "--quiet", "case.nml").code == 5
    vcor.refuses("plot", "case.h5", code=INPUT, at="case.h5", says=["'cor'", "no impact"])


@pytest.mark.parametrize("kind", ["svg", "pdf", "png"])
def test_formats(vcor, plot, results, kind):
    begins = {"svg": b"<?xml", "pdf": b"%PDF", "png": b"\x89PNG"}[kind]
    assert plot("sls.h5", name=f"a.b.{kind}").read_bytes().startswith(begins)
    vcor.succeeds("plot", results / "sls.h5", "--format", kind, "--output", "name")
    assert (vcor.folder / "name" / f"sls_history.{kind}").read_bytes().startswith(begins)
    vcor.succeeds("plot", results / "sls.h5", "--format", kind)
    assert (vcor.folder / f"sls_history.{kind}").read_bytes().startswith(begins)
    # nothing else is left
    assert {path.name for path in vcor.folder.iterdir()} == {
        f"a.b.{kind}",
        "name",
        f"sls_history.{kind}",
    }


def test_size_of_png(plot):
    """A column of 8.5 cm with 300 pixels to the inch."""
    data = plot("sls.h5", name="a.png").read_bytes()
    assert int.from_bytes(data[16:20], "big") == round(8.5 / 2.54 * 300)


@pytest.mark.parametrize("name", ["two words.svg", "Stoß_α.svg", "it's ''.svg", "a/b c/d.svg", "$x`y`.svg"])
def test_names(vcor, results, name):
    vcor.succeeds("plot", results / "sls.h5", "--output", name, "--script")
    path = vcor.folder / name
    before = path.read_bytes()
    path.unlink()
    by_hand(path.with_suffix(".gp"), vcor.folder)
    assert path.read_bytes() == before


def test_directory(vcor, results):
    (vcor.folder / "there").mkdir()
    assert vcor.succeeds("plot", results / "sls.h5", "--output", "there") == (
        "written there/sls_history.svg\n"
    )
    vcor.succeeds("plot", results / "sls.h5", "--output", "new/")
    assert (vcor.folder / "new" / "sls_history.svg").exists()
    vcor.succeeds("plot", results / "sls.h5", "--output", "newer/folder")
    assert (vcor.folder / "newer" / "folder" / "sls_history.svg").exists()
    vcor.succeeds("plot", results / "sls.h5", "--output", "v1.2/")
    assert (vcor.folder / "v1.2" / "sls_history.svg").exists()


def by_hand(script, folder, **options):
    """Run gnuplot as a user would."""
    done = subprocess.run(
        ["gnuplot", str(script)], cwd=folder, capture_output=True, text=True, check=False, **options
    )
    assert (done.returncode, done.stderr) == (0, "")


FIGURES = {
    "history": ["sls_ghost.h5"],
    "histories": ["sls_ghost.h5", "butyl_prony_ghost.h5"],
    "loop": ["sls_ghost.h5", "--kind", "loop"],
    "moduli": ["sls_material.h5"],
    "several moduli": ["butyl_cerf_material.h5", "butyl_prony_material.h5"],
    "sweep": ["sls_velocity.h5"],
    "map": ["grid.h5"],
}


@pytest.mark.parametrize("words", FIGURES.values(), ids=FIGURES)
def test_script(vcor, plot, words):
    """The script that is left draws the same figure, wherever it is called from."""
    figure = plot(*words, "--script", name="out/figure.svg")
    before = figure.read_bytes()
    assert {path.name for path in figure.parent.iterdir()} == {
        "figure.svg",
        "figure.gp",
        "figure.dat",
    }
    for folder, script in ((figure.parent, "figure.gp"), (vcor.folder, "out/figure.gp")):
        figure.unlink()
        by_hand(script, folder)
        assert figure.read_bytes() == before
    # ... and so does the program, without a trace of the time
    assert plot(*words, name="again.svg").read_bytes() != b""
    figure.unlink()
    plot(*words, name="out/figure.svg")
    assert figure.read_bytes() == before


@pytest.mark.parametrize("script", [[], ["--script"]])
def test_without_gnuplot(vcor, results, plot, script):
    """One line, and the script is there for a machine that has it."""
    (vcor.folder / "bin").mkdir()
    done = vcor(
        "plot",
        results / "sls.h5",
        "--output",
        "figure.svg",
        *script,
        env={"PATH": str(vcor.folder / "bin")},
    )
    complaint(done, FILE, ["'figure.svg'", "no gnuplot", "gnuplot-nox", "'figure.gp'"])
    assert done.out == ""
    assert not (vcor.folder / "figure.svg").exists()
    by_hand("figure.gp", vcor.folder)
    assert (vcor.folder / "figure.svg").read_bytes() == plot("sls.h5", name="b/figure.svg").read_bytes()


def test_without_a_path(vcor, results):
    done = vcor("plot", results / "sls.h5", env={"PATH": ""})
    complaint(done, FILE, ["no gnuplot", "'sls_history.gp'"])


def test_gnuplot_that_fails(vcor, results):
    (vcor.folder / "bin").mkdir()
    fake = vcor.folder / "bin" / "gnuplot"
    fake.write_text("#!/bin/sh\necho trouble\necho trouble >&2\nexit 1\n")
    fake.chmod(0o755)
    done = vcor("plot", results / "sls.h5", env={"PATH": f"{fake.parent}:{os.environ['PATH']}"})
    complaint(done, FILE, ["gnuplot fails", "'sls_history.gp'"])
    left = {path.name for path in vcor.folder.iterdir()}
    assert left == {"bin", "sls_history.gp", "sls_history.dat"}


def test_settings_of_the_user_do_not_count(vcor, plot, results):
    before = plot("sls.h5").read_bytes()
    (vcor.folder / ".gnuplot").write_text("set title 'mine'\nset grid\n")
    environment = {**os.environ, "HOME": str(vcor.folder)}
    vcor.succeeds("plot", results / "sls.h5", "--output", "figure.svg", env=environment)
    assert (vcor.folder / "figure.svg").read_bytes() == before


def lightness(colour):
    """L* of a colour like #4a9bd8, 0 to 100 (CIE 1976; sRGB, IEC 61966-2-1)."""
    parts = np.array([int(colour[i : i + 2], 16) for i in (1, 3, 5)]) / 255
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    luminance = linear @ [0.2126, 0.7152, 0.0722]
    return 116 * luminance ** (1 / 3) - 16 if luminance > 0.008856 else 903.3 * luminance


def test_curves_can_be_told_apart_in_grey(vcor, plot):
    """No two styles share a lightness, nor a marker; the first four are far apart, none is faint.

    Markers clear their ground: half of them differ from the others by being open.
    """
    plot("sls.h5", "--script")
    script = (vcor.folder / "figure.gp").read_text()
    styles = re.findall(r"set style line \d lc rgb '(#\w+)' lw \S+ pt (\d+) .* dt (.*)", script)
    assert len(styles) == 8
    light = [lightness(colour) for colour, _, _ in styles]
    assert min(np.diff(sorted(light))) >= 4
    assert min(np.diff(sorted(light[:4]))) >= 13
    assert max(light) <= 72
    assert len({marker for _, marker, _ in styles}) == 8
    assert len({dash for _, _, dash in styles}) >= 7
    assert len(re.findall(r" pointinterval -\d+ ", script)) == 3


def test_figure_is_replaced(vcor, plot):
    (vcor.folder / "figure.svg").write_text("old")
    assert plots(plot("sls.h5")) == 6


REFUSED = {
    "text": (["text.h5"], INPUT, "text.h5: this is no HDF5 file"),
    "empty file": (["nothing.h5"], INPUT, "nothing.h5: this is no HDF5 file"),
    "cut off": (["cut.h5"], FILE, "cut.h5: this file is damaged"),
    "not there": (["none.h5"], FILE, "none.h5: there is no such file"),
    "directory": (["folder"], FILE, "folder: found a directory"),
    "no name": ([""], FILE, "empty"),
    "no results": (["empty.h5"], INPUT, "empty.h5: there are no results"),
    "other results": (["other.h5"], INPUT, "other.h5: there are no results of vcor"),
    "incomplete": (["part.h5"], INPUT, "part.h5: there is no 'indentation' in 'history'"),
    "lengths": (["lengths.h5"], INPUT, "'indentation' of 'history' has not as many values"),
    "nothing moves": (["still.h5"], INPUT, "still.h5: the time history"),
    "not a number": (["nan.h5"], INPUT, "nan.h5: the time history"),
    "compound": (["compound.h5"], FILE, "'summary/x' cannot be read"),
    "no moduli": (["sls.h5", "--kind", "moduli"], INPUT, "no moduli in this file"),
    "no history": (["sls_velocity.h5", "--kind", "loop"], INPUT, "this is a sweep"),
    "no history at all": (["sls_material.h5", "--kind", "history"], INPUT, "no time history"),
    "no sweep": (["sls.h5", "--kind", "sweep"], INPUT, "this is no sweep"),
    "no map": (["sls_velocity.h5", "--kind", "map"], INPUT, "a sweep of two parameters, found 1"),
    "two kinds": (["sls.h5", "sls_velocity.h5"], INPUT, "kind sweep, sls.h5 for one of kind history"),
    "two maps": (["grid.h5", "grid.h5"], USAGE, "a map shows one file"),
    "two quantities": (["grid.h5", "--quantity", "cor,max_force"], USAGE, "one quantity, found 2"),
    "two grids": (["grid.h5", "grid.h5", "--kind", "sweep"], INPUT, "two parameters"),
    "two parameters": (["sls_velocity.h5", "radius.h5"], INPUT, "over 'sphere.radius'"),
    "text column": (["sls_velocity.h5", "--quantity", "status"], INPUT, "'status' of 'summary'"),
    "kind": (["sls.h5", "--kind", "histroy"], USAGE, "did you mean 'history'?"),
    "no kind": (["sls.h5", "--kind", "x"], USAGE, "history, loop, moduli, sweep, map"),
    "format": (["sls.h5", "--format", "jpg"], USAGE, "known: svg, pdf, png"),
    "ending": (["sls.h5", "--output", "a.svgg"], USAGE, "did you mean 'svg'?"),
    "two formats": (["sls.h5", "--output", "a.pdf", "--format", "png"], USAGE, "--format is png"),
    "quantity": (["sls_velocity.h5", "--quantity", "contct_time"], USAGE, "'contact_time'"),
    "parameter": (["sls_velocity.h5", "--quantity", "impact.x"], INPUT, "no 'impact.x'"),
    "legend": (["sls.h5", "--legend", "a", "--legend", "b"], USAGE, "found 2 --legend for 1 file"),
    "nine": (["sls.h5"] * 9, USAGE, "at most 8"),
    "option": (["sls.h5", "--scrpt"], USAGE, "'--script'"),
    "value": (["sls.h5", "--script=yes"], USAGE, "no value"),
    "no file": (["--kind", "loop"], USAGE, "vcor plot RESULT.h5"),
    "itself": (["x.svg", "--output", "x.svg"], INPUT, "x.svg"),
    "its data": (["x.dat", "--output", "x.svg"], INPUT, "x.dat"),
    "its script": (["x.gp", "--output", "x.svg", "--script"], INPUT, "x.gp"),
    "no place": (["sls.h5", "--output", "/proc/none/x.svg"], FILE, "/proc/none"),
    "below a file": (["sls.h5", "--output", "text.h5/x.svg"], FILE, "text.h5"),
    "device": (["sls.h5", "--output", "folder/link.svg"], FILE, "device"),
}


@pytest.fixture
def bad(vcor, results):
    """A folder with files that are not what is needed."""
    folder = vcor.folder
    for name in ("sls", "sls_velocity", "sls_material", "grid"):
        shutil.copy(results / f"{name}.h5", folder)
    for name in ("x.svg", "x.dat", "x.gp"):
        shutil.copy(results / "sls.h5", folder / name)
    (folder / "text.h5").write_text("hello\n" * 1000)
    (folder / "nothing.h5").write_bytes(b"")
    (folder / "cut.h5").write_bytes((results / "sls.h5").read_bytes()[:3000])
    (folder / "folder").mkdir()
    (folder / "folder" / "link.svg").symlink_to("/dev/null")
    with h5py.File(folder / "empty.h5", "w"):
        pass
    with h5py.File(folder / "other.h5", "w") as file:
        file["a/b"] = np.arange(4.0)
    with h5py.File(folder / "part.h5", "w") as file:
        file["summary/cor"] = [0.5]
        file["history/time"] = np.arange(4.0)
    with h5py.File(folder / "lengths.h5", "w") as file:
        for name in ("time", "relative_velocity", "force"):
            file[f"history/{name}"] = np.arange(4.0)
        file["history/indentation"] = np.arange(3.0)
    for name, value in (("still", 0.0), ("nan", np.nan)):
        with h5py.File(folder / f"{name}.h5", "w") as file:
            for column in ("time", "indentation", "relative_velocity", "force"):
                file[f"history/{column}"] = [0.0, 1.0, 2.0 if column == "time" else value]
            if not value:
                file["history/force"][:] = 0.0
    with h5py.File(folder / "compound.h5", "w") as file:
        file["summary/x"] = np.zeros(3, dtype=[("a", float)])
    with h5py.File(folder / "radius.h5", "w") as file:
        file["summary/sphere.radius"] = [1.0, 2.0]
        file["summary/sphere.radius"].make_scale()
        file["summary/cor"] = [0.5, 0.6]
    return vcor


@pytest.mark.parametrize("words, code, says", REFUSED.values(), ids=REFUSED)
def test_refused(bad, words, code, says):
    before = contents(bad.folder)
    done = bad("plot", *words)
    assert done.out == ""
    complaint(done, code, says)
    assert contents(bad.folder) == before


def test_what_others_wrote(bad):
    """A file of h5py without order, units and scales of its own serves as well."""
    bad.succeeds("plot", "radius.h5", "--script")
    found = texts(bad.folder / "radius_sweep.svg")
    assert "sphere radius" in found and "cor" in found
    assert blocks(bad.folder / "radius_sweep.dat") == [[(1.0, 0.5), (2.0, 0.6)]]


def test_other_types(vcor):
    """Numbers of any width and byte order, whole ones, text of fixed length."""
    for name, kind in (("a", ">f4"), ("b", "<f8"), ("c", "<i2")):
        with h5py.File(vcor.folder / f"{name}.h5", "w") as file:
            file.attrs["title"] = np.bytes_(f"title {name}")
            file["summary/sphere.radius"] = np.array([1, 2, 4], dtype=kind)
            file["summary/sphere.radius"].attrs["units"] = np.bytes_("m")
            if kind != "<i2":
                file["summary/sphere.radius"].make_scale()
            file["summary/cor"] = np.array([3, 2, 1], dtype=kind)
            file["summary/status"] = np.array([b"separated", b"x", b""])
    vcor.succeeds("plot", "a.h5", "b.h5", "--script")
    found = texts(vcor.folder / "a_sweep.svg")
    assert "title a" in found and "title b" in found and "sphere radius [m]" in found
    line = [(1.0, 3.0), (2.0, 2.0), (4.0, 1.0)]
    assert blocks(vcor.folder / "a_sweep.dat") == [line, line]
    vcor.refuses("plot", "c.h5", code=INPUT, at="c.h5", says="single impact")


def test_quiet(vcor, results):
    assert vcor.succeeds("plot", results / "sls.h5", "--quiet") == ""
    assert {path.name for path in vcor.folder.iterdir()} == {"sls_history.svg"}


@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help(vcor, option):
    page = vcor.succeeds("help", "plot")
    assert vcor.succeeds("plot", option) == page
    assert vcor.succeeds("plot", "no.h5", option) == page
    assert page.isascii() and page.endswith("\n")
    assert all(len(line) <= 86 and line == line.rstrip() for line in page.splitlines())
    for word in ("--kind", "--quantity", "--legend", "--output", "--format", "--script", "--quiet"):
        assert f"\n  {word} " in page
    for kind in ("history", "loop", "moduli", "sweep", "map"):
        assert f"\n  {kind} " in page
    assert "vcor plot" in vcor.succeeds("help")
    vcor.refuses("help", "plto", code=USAGE, says="'plot'")
    vcor.refuses("plto", "x.h5", code=USAGE, says="'plot'")
