"""The gallery: its commands draw the figures that stand there."""

import os
import re
import subprocess
import sys

import pytest
from conftest import ROOT

PAGE = ROOT / "docs" / "figures.md"
FOLDER = ROOT / "docs" / "gallery"
RESPONSES = ["indentation s/sₘₐₓ", "velocity −s′/v₀", "force F/Fₘₐₓ", "time [ms]"]
COR = "coefficient of restitution"
VELOCITY = "impact velocity [m/s]"
PRONY, CERF, POWER = (
    "Prony series, Eq. (26)",
    "fractional model, Eq. (24)",
    "fractional model, Eq. (23-b)",
)
MODULI = ["relaxation modulus [MPa]", "loss tangent", "time [s]", "angular frequency [rad/s]"]
# How the text of a hatched part begins, whose number is measured
HATCHED = "with caution: "

# What is written in each figure
FIGURES = {
    "fig1": [*MODULI, "storage modulus", "loss modulus", "t₀ = 1.342 ms", "ωₘᵢₙ = 4684 rad/s"],
    "fig2": [*RESPONSES, "COR 0.4313", "0.5593", "t₀ = 1.342 ms"],
    "fig3": ["SLS, energy loss 0.7932 J", "BUTYL-B252, energy loss 1.172 J"],
    "fig4": [
        *[f"alpha = {beta // 4} s⁻¹, beta = {beta} s⁻¹" for beta in (600, 1200, 2400, 4800)],
        COR,
        VELOCITY,
    ],
    "fig5": [
        *MODULI,
        f"{CERF}: t₀ = 760.6 µs, ωₘᵢₙ = 8261 rad/s",
        f"{PRONY}: t₀ = 787.1 µs, ωₘᵢₙ = 7982 rad/s",
        "(d)",
    ],
    "fig6": [*RESPONSES, "COR 0.2146", "t₀ = 0.7755 ms"],
    "fig7": [*RESPONSES, "COR 0.2673", "t₀ = 0.7964 ms"],
    "fig8": [COR, VELOCITY, PRONY, CERF, POWER],
    "fig9": [
        "contact time [ms]",
        "lowest frequency of interest [rad/s]",
        "largest indentation [mm]",
        "largest contact force [kN]",
        VELOCITY,
        CERF,
        POWER,
    ],
    "histories": [
        *RESPONSES,
        f"{POWER}: COR 0.2146, t₀ = 0.7755 ms",
        f"{PRONY}: COR 0.2673, t₀ = 0.7964 ms",
    ],
    "map": [COR, VELOCITY, "sphere radius [mm]", "0.6", "0.7", "0.8", "0.9"],
    "energy": ["energy given to the plate or structure", VELOCITY, "0.1", "0.01"],
    "fit": [*MODULI, "soft rubber data"],
    "validity": [COR, "plate half thickness [mm]", "measured"],
}


@pytest.fixture(scope="module")
def gallery(tmp_path_factory):
    """The figures, made anew."""
    folder = tmp_path_factory.mktemp("gallery")
    done = subprocess.run(
        [ROOT / "scripts" / "figures.sh", folder],
        env={**os.environ, "PYTHON": sys.executable},
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return folder


def written(path):
    """Texts of a figure, which Matplotlib leaves as remarks next to their glyphs."""
    text = path.read_text(encoding="utf-8")
    return [found.replace("&gt;", ">") for found in re.findall(r"<!-- (.*?) -->", text)]


def test_all_figures(gallery):
    made = {path.name for path in gallery.iterdir()}
    assert made == {path.name for path in FOLDER.iterdir()} == {f"{name}.svg" for name in FIGURES}
    shown = re.findall(r'<img src="gallery/(\w+\.svg)"', PAGE.read_text(encoding="utf-8"))
    assert sorted(shown) == sorted(made)


@pytest.mark.parametrize("name", FIGURES)
def test_content(gallery, name):
    found = written(gallery / f"{name}.svg")
    for text in FIGURES[name]:
        assert text in found
    assert any(text.startswith(HATCHED) for text in found) == (name == "validity")


def numbers(path):
    """All numbers of a figure, and the text between them, without the names of clip paths.

    Such a name is a hash of numbers, and changes with the last digit of one.
    """
    text = re.sub(r"\bp[0-9a-f]{10}\b", "path", path.read_text(encoding="utf-8"))
    parts = re.split(r"(-?\d+\.\d+)", text)
    return [float(word) for word in parts[1::2]], parts[::2]


@pytest.mark.parametrize("name", FIGURES)
def test_up_to_date(gallery, name):
    """The figures in the sources are those of the commands, within a hundredth of a point."""
    made, between = numbers(gallery / f"{name}.svg")
    kept, around = numbers(FOLDER / f"{name}.svg")
    assert between == around
    assert made == pytest.approx(kept, abs=0.011)


def test_wrong_use(tmp_path):
    done = subprocess.run(
        [ROOT / "scripts" / "figures.sh", tmp_path, "more"],
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr == "figures: error: found 2 arguments, expected one directory or nothing\n"
