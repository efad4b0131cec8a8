"""Write docs/results.svg, the picture of the README: restitution against velocity, temperature and thickness.

    pip install './python[plot]' && python docs/make_results.py
"""

from pathlib import Path

import numpy as np
from matplotlib import rc_context, style
from matplotlib.figure import Figure
from vcor.plot import PAGE, STYLE

import vcor

ROOT = Path(__file__).resolve().parent.parent
EXAMPLES = ROOT / "examples"


def draw(axis, x, found, label=None):
    """cor_sphere over x, dashed where it is outside the validity of the model."""
    y, outside = found.cor_sphere.values, found.validity.values == "outside"
    (line,) = axis.plot(x, np.where(outside, np.nan, y), "-", marker="", label=label)
    # up to the next points that are not
    near = outside | np.roll(outside, 1) | np.roll(outside, -1)
    near[[0, -1]] = outside[[0, -1]] | outside[[1, -2]]
    axis.plot(x, np.where(near, y, np.nan), "--", marker="", color=line.get_color(), zorder=line.zorder - 0.1)


def curve(axis, case, address, values, label=None, scale=1.0):
    """The restitution over one number of a case."""
    found = case.sweep({address: values}, quantities=["cor_sphere", "validity"], progress=False)
    draw(axis, scale * values, found, label)


def plate(axis):
    """The paper's steel ball on its rubber plate, with the paper's mechanics and with others."""
    velocities = np.geomspace(0.1, 20, 25)
    for label, keys in {
        "paper's": {},
        "exact": {"plate.waves": "body"},
        "no waves": {"plate.waves": "none", "contact.law": "receding"},
    }.items():
        case = vcor.read(EXAMPLES / "paper" / "sls.nml")
        for address, value in keys.items():
            case[address] = value
        curve(axis, case, "impact.velocity", velocities, label)
    axis.set(title="(a) steel ball on rubber", xlabel="velocity [m/s]", xscale="log", ylim=(0, 0.7),
             ylabel="coefficient of restitution")  # fmt: skip


def ball(axis):
    """A ball of butyl rubber on a rigid floor, dropped from three heights."""
    kelvin = np.linspace(268.15, 338.15, 40)
    for height in (0.01, 0.1, 0.5):
        case = vcor.read(EXAMPLES / "sweeps" / "squash_ball.nml")
        case["impact.drop_height"] = height
        found = case.sweep({"impact.temperature": kelvin}, quantities=["cor_sphere", "validity"], progress=False)
        draw(axis, kelvin - 273.15, found, f"{height:g} m")
    axis.set(title="(b) butyl ball on a floor", xlabel="temperature [°C]", ylim=(0.2, 0.5))


def glass(axis):
    """An alumina sphere on glass of any thickness, and what Kharaz et al. measured on thick glass."""
    half = 1e-3 * np.geomspace(5, 25, 25)
    axis.axhspan(0.975, 0.985, color="0.8", zorder=0, label="measured")
    for label, waves in (("thin plate", "constant"), ("exact", "body")):
        case = vcor.read(EXAMPLES / "alumina_on_glass.nml")
        case["plate.waves"] = waves
        curve(axis, case, "plate.half_thickness", half, label, scale=2e3)
    axis.set(title="(c) alumina sphere on glass", xlabel="thickness [mm]", xscale="log", ylim=(0.95, 1))
    axis.set_xticks([10, 20, 50], ["10", "20", "50"])
    axis.minorticks_off()


def main():
    """Write the figure."""
    with style.context(STYLE), rc_context():
        made = Figure(figsize=(PAGE / 2.54, 6.2 / 2.54), layout="constrained")
        titles = ("mechanics", "drop height", None)
        for axis, panel, title in zip(made.subplots(1, 3), (plate, ball, glass), titles, strict=True):
            panel(axis)
            axis.legend(title=title, alignment="left")
        made.savefig(ROOT / "docs" / "results.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
