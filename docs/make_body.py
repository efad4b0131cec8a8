"""Write docs/body.svg and docs/body_rubber.svg: restitution with plates that are thin, of any
thickness, and half spaces.

    VCOR=build/release/vcor python docs/make_body.py
"""

import os
import subprocess
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import numpy as np
from matplotlib.figure import Figure

ROOT = Path(__file__).resolve().parent.parent
VCOR = os.environ.get("VCOR", str(ROOT / "build" / "release" / "vcor"))
STYLE = {"font.size": 9, "svg.fonttype": "none", "svg.hashsalt": "vcor", "axes.grid": True,
         "grid.color": "#dddddd", "axes.axisbelow": True, "lines.linewidth": 1.4}

GLASS = """&impact velocity = 1.0 /
&sphere radius = 2e-3, material = 'steel' /
&plate half_thickness = 8e-3, material = 'glass' /
&material name = 'steel', model = 'elastic', modulus = 210e9, poisson_ratio = 0.3,
   density = 7800.0 /
&material name = 'glass', model = 'elastic', modulus = 70e9, poisson_ratio = 0.22,
   density = 2500.0 /
"""
PMMA = """&impact velocity = 3.1 /
&sphere radius = 1e-3, material = 'glass' /
&plate half_thickness = 1.5e-3, material = 'PMMA' /
&contact pair = 'series' /
&material name = 'glass', model = 'elastic', modulus = 70e9, poisson_ratio = 0.22,
   density = 2500.0 /
&material name = 'PMMA', model = 'prony', equilibrium_modulus = 2.6e9, moduli = 0.5e9, 0.9e9,
   rates = 3e4, 4e5, poisson_ratio = 0.35, density = 1190.0 /
"""


def restitution(text, *words):
    """cor_sphere of a case with some keys set; nan where the sphere does not separate."""
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "case.nml"
        case.write_text(text, encoding="utf-8")
        sets = [part for word in words for part in ("--set", word)]
        run = subprocess.run([VCOR, "run", "case.nml", "--quiet", "--print", "cor_sphere", *sets],
                             cwd=folder, capture_output=True, text=True)
    return float(run.stdout) if run.returncode == 0 else float("nan")


def over_thickness(axes, text, thicknesses, title):
    """Restitution over the thickness H [mm]."""
    curves = {"thin plate": "hereditary", "body": "body"}
    for name, waves in curves.items():
        values = [restitution(text, f"plate.waves={waves}", f"plate.half_thickness={5e-4 * x}")
                  for x in thicknesses]
        axes.plot(thicknesses, values, label=name, color={"thin plate": "C0", "body": "C3"}[name])
    half_space = text.replace(text[text.index("half_thickness"):text.index("material", text.index(
        "half_thickness"))], "")
    value = restitution(half_space, "plate.waves=body")
    axes.axhline(value, color="C3", linestyle="--", label="half space")
    value = restitution(text, "plate.waves=none")
    axes.axhline(value, color="0.4", linestyle=":", label="no waves")
    axes.set(xscale="log", xlabel="thickness $H$ [mm]", title=title)
    axes.set_xlim(thicknesses[0], thicknesses[-1])
    ticks = [x for x in (0.5, 1, 2, 5, 10, 20, 50) if thicknesses[0] <= x <= thicknesses[-1]]
    axes.set_xticks(ticks, [str(x) for x in ticks])
    axes.minorticks_off()


def thickness_figure():
    """Steel on glass, and a glass bead on PMMA."""
    figure = Figure(figsize=(6.9, 2.9), layout="constrained")
    glass, pmma = figure.subplots(1, 2)
    over_thickness(glass, GLASS, np.geomspace(3, 50, 33), "4 mm steel ball on glass, 1 m/s")
    over_thickness(pmma, PMMA, np.geomspace(1, 30, 31), "2 mm glass bead on PMMA, 3.1 m/s")
    glass.set(ylabel="restitution of the sphere", ylim=(0.75, 1.005))
    pmma.set(ylim=(0.3, 0.9))
    pmma.legend(loc="lower right", framealpha=1)
    return figure


def rubber_figure():
    """The paper's rubber with its model, the thin plate and the body."""
    text = (ROOT / "examples" / "paper" / "sls.nml").read_text("utf-8")
    velocities = np.geomspace(0.2, 20, 25)
    figure = Figure(figsize=(4.6, 3.1), layout="constrained")
    axes = figure.subplots()
    for name, waves, colour, line in (("the paper's plate (relaxing)", "relaxing", "0.4", ":"),
                                      ("thin plate (hereditary)", "hereditary", "C0", "-"),
                                      ("body", "body", "C3", "-")):
        values = [restitution(text, f"plate.waves={waves}", f"impact.velocity={v}",
                              "rubber.poisson_ratio=0.48")
                  for v in velocities]
        axes.plot(velocities, values, label=name, color=colour, linestyle=line)
    axes.set(xscale="log", xlabel="velocity [m/s]", ylabel="restitution of the sphere")
    axes.set_xlim(velocities[0], velocities[-1])
    axes.set_xticks([0.2, 0.5, 1, 2, 5, 10, 20], ["0.2", "0.5", "1", "2", "5", "10", "20"])
    axes.minorticks_off()
    axes.legend(framealpha=1)
    return figure


def main():
    """Write the figures."""
    with matplotlib.rc_context(STYLE):
        for name, figure in (("body", thickness_figure()), ("body_rubber", rubber_figure())):
            figure.savefig(ROOT / "docs" / f"{name}.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
