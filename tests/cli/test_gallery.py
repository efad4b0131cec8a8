"""The gallery: its commands draw the figures that stand there."""

import os
import re
import subprocess

import pytest
from figure import crowded, plots, texts
from program import ROOT, program

PAGE = ROOT / "docs" / "gallery.md"
FOLDER = ROOT / "docs" / "gallery"
RESPONSES = ["indentation s/smax", "velocity −s′/v0", "force F/Fmax", "time [ms]"]
COR = "coefficient of restitution"
VELOCITY = "impact velocity [m/s]"
PRONY, CERF, POWER = (
    "Prony series, Eq. (26)",
    "fractional model, Eq. (24)",
    "fractional model, Eq. (23-b)",
)

# What each figure shows: texts, and the number of lines, filled shapes and sets of points.
# Responses over time are three lines, their three ghosts and the three values at t0; the map has six
# lines from 0.4 to 0.9 between seven areas
FIGURES = {
    "fig1": (["relaxation modulus E(t)", "storage modulus E′", "loss modulus E″"], 4),
    "fig2": ([*RESPONSES, "COR 0.4313", "0.5593", "t0 = 1.342 ms"], 9),
    "fig3": (["SLS, energy loss 0.7932 J", "BUTYL-B252, energy loss 1.172 J"], 2),
    "fig4": (
        [f"alpha = {beta // 4} 1/s, beta = {beta} 1/s" for beta in (600, 1200, 2400, 4800)]
        + [COR, VELOCITY],
        4,
    ),
    "fig5": (
        [
            f"{CERF}: t0 = 0.7606 ms, ωmin = 8261 rad/s",
            f"{PRONY}: t0 = 0.7871 ms, ωmin = 7982 rad/s",
            "relaxation modulus [MPa]",
            "storage modulus [MPa]",
            "loss modulus [MPa]",
            "loss tangent",
            "time [s]",
            "angular frequency [rad/s]",
        ],
        8,
    ),
    "fig6": ([*RESPONSES, "COR 0.2146", "t0 = 0.7755 ms"], 9),
    "fig7": ([*RESPONSES, "COR 0.2673", "t0 = 0.7964 ms"], 9),
    "fig8": ([COR, VELOCITY, PRONY, CERF, POWER], 3),
    "fig9": (
        [
            "contact time [ms]",
            "lowest frequency of interest [rad/s]",
            "largest indentation [mm]",
            "largest contact force [kN]",
            VELOCITY,
            CERF,
            POWER,
        ],
        8,
    ),
    "histories": (
        [*RESPONSES, f"{POWER}: COR 0.2146, t0 = 0.7755 ms", f"{PRONY}: COR 0.2673, t0 = 0.7964 ms"],
        18,
    ),
    "map": ([COR, VELOCITY, "sphere radius [mm]", "0.5", "0.6", "0.7", "0.8", "0.9"], 13),
}


@pytest.fixture(scope="module")
def gallery(tmp_path_factory):
    """The figures, made anew."""
    folder = tmp_path_factory.mktemp("gallery")
    done = subprocess.run(
        [ROOT / "scripts" / "figures.sh", folder],
        env={**os.environ, "VCOR": program()},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return folder


def test_all_figures(gallery):
    made = {path.name for path in gallery.iterdir()}
    assert made == {path.name for path in FOLDER.iterdir()} == {f"{name}.svg" for name in FIGURES}
    shown = re.findall(r'<img src="gallery/(\w+\.svg)"', PAGE.read_text(encoding="utf-8"))
    assert sorted(shown) == sorted(made)


@pytest.mark.parametrize("name", FIGURES)
def test_content(gallery, name):
    expected, count = FIGURES[name]
    found = texts(gallery / f"{name}.svg")
    for text in expected:
        assert text in found
    assert plots(gallery / f"{name}.svg") == count
    assert crowded(gallery / f"{name}.svg") == []


def numbers(path):
    """All numbers of a figure, and what stands between them."""
    parts = re.split(r"(-?\d+\.\d+)", path.read_text(encoding="utf-8"))
    return [float(word) for word in parts[1::2]], parts[::2]


@pytest.mark.parametrize("name", FIGURES)
def test_up_to_date(gallery, name):
    """What stands in the sources is what the commands make; the last digit of a coordinate, a
    hundredth of a pixel, is the machine's."""
    made, between = numbers(gallery / f"{name}.svg")
    kept, around = numbers(FOLDER / f"{name}.svg")
    version = re.compile(r"GNUPLOT [\d.]+ patchlevel \d+")
    strip = [version.sub("", text) for text in between]
    assert strip == [version.sub("", text) for text in around]
    assert made == pytest.approx(kept, abs=0.021)


def test_wrong_use(tmp_path):
    done = subprocess.run(
        [ROOT / "scripts" / "figures.sh", tmp_path, "more"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr == "figures: error: found 2 arguments, expected one directory or nothing\n"
