"""Write the figures and the numbers of docs/measurements.md: impacts compared with measurements.

The measurements and the cases are in data/measurements; every number that is put in is there, in
the examples that are named here, or in the capitals below.

    pip install './python[fit]' && python docs/make_measurements.py [FOLDER]
"""

import re
import sys
from math import pi
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib import style
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.optimize import brentq
from vcor.plot import HATCH, PAGE, STYLE

import vcor

ROOT = Path(__file__).resolve().parent.parent
DATA = ROOT / "data" / "measurements"
#: Standard deviation of handbook values of moduli and of densities
MODULUS, DENSITY = "5%", "2%"
#: Of a laboratory that is not known [m/s2]
GRAVITY = 9.80665
#: Samples of each band
SAMPLES = 128
#: Relative error of a loss factor of a data sheet
LOSS_FACTOR = "10%"
#: Speed of the oblique impacts [m/s]
OBLIQUE = 3.9
#: Error of an angle [degrees] and of a restitution that are read from a figure
ANGLE, READING = 0.15, 0.005
#: Frequency up to which the data sheet of Sorbothane has moduli [Hz]; above it are digitised ones
SHEET = 60.0
#: Radii of a plunger whose shape is not known [m]
PLUNGERS = 0.006, 0.0125
POUND_PER_CUBIC_FOOT = 16.0185
#: Solids whose slope is compared with that of Kelvin-Voigt: keys of &material; three are drawn
SOLIDS = {
    "standard solid, 1:10": {"model": "sls", "glassy_modulus": 1e8, "alpha": 1e4, "beta": 1e5},
    "power law 0.5 and a spring": {"model": "power_law", "equilibrium_modulus": 1e7,
                                   "coefficient": 1e5, "exponent": 0.5},
    "power law 0.8 and a spring": {"model": "power_law", "equilibrium_modulus": 1e7,
                                   "coefficient": 1e4, "exponent": 0.8},
    "standard solid, 1:100": {"model": "sls", "glassy_modulus": 1e9, "alpha": 1e3, "beta": 1e5},
    "standard solid, 1:30, and a dashpot": {"model": "prony", "equilibrium_modulus": 1e7,
                                            "moduli": 3e8, "rates": 1e5, "viscosity": 1e2},
    "power law 0.95 and a spring": {"model": "power_law", "equilibrium_modulus": 1e7,
                                    "coefficient": 1e4, "exponent": 0.95},
}  # fmt: skip


def data(name):
    """A file of data/measurements; units as its header has them."""
    table = pd.read_csv(DATA / f"{name}.csv", comment="#")
    return table.rename(columns=lambda head: head.split(" [")[0])


def case(name):
    """A case of data/measurements."""
    return vcor.read(DATA / f"{name}.nml")


def put_in(*names):
    """The numbers of cases that were put in by hand, as their files have them."""
    lines = []
    for name in names:
        text = re.sub(r"!.*", "", (ROOT / name).read_text("utf-8"))
        groups = re.findall(r"&(impact|sphere|plate|material)\b(.*?)(?:^|\s)/", text, re.S | re.M)
        keys = [re.sub(r"\s*=\s*", " ", keys).strip().replace("'", "") for _, keys in groups]
        words = [re.sub(r"\s*[,\n]\s*", ", ", one) for one in keys]
        words = [re.sub(r"^name (.*?), model ", r"*\1* ", word) for word in words]
        lines.append(f"- [{Path(name).name}](../{name}): {'; '.join(words)}")
    return "\n".join(["Inputs (of a fitted number, its first guess):", "", *lines])


def panels(*corners):
    """A figure as wide as a page, a panel for each corner, such as `upper right`, that has its letter."""
    made = Figure(figsize=(PAGE / 2.54, 7.6 / 2.54), layout="constrained")
    axes = made.subplots(1, len(corners))
    for axis, letter, (height, side) in zip(axes, "ab", map(str.split, corners), strict=True):
        place = {"upper": 0.965, "lower": 0.035}[height], {"left": 0.025, "right": 0.975}[side]
        axis.text(place[1], place[0], f"({letter})", transform=axis.transAxes, ha=side,
                  va={"upper": "top", "lower": "bottom"}[height], zorder=6,
                  bbox={"fc": "white", "ec": "none", "pad": 1.0})  # fmt: skip
    return made, axes


def table(head, *rows):
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def measured(axis, x, y, y_error=None, x_error=None, **options):
    """Measured points with their errors."""
    settings = {"fmt": "o", "color": "0.2", "mfc": "white", "capsize": 1.5, "elinewidth": 0.7,
                "zorder": 5, **options}  # fmt: skip
    axis.errorbar(x, y, y_error, x_error, **settings)


def curve(axis, x, y, color, line="-", **options):
    """A computed curve."""
    axis.plot(x, y, color=color, linestyle=line, marker=options.pop("marker", ""), **options)


def hatch(axis, x, validity, whose=None):
    """Hatch where the program judges a curve not to be good, narrowly where it is outside; the legend says whose."""
    edges = np.concatenate([x[:1], np.sqrt(x[1:] * x[:-1]), x[-1:]])
    for word, lines in (("caution", "//"), ("outside", "////")):
        for i in np.flatnonzero(np.asarray(validity) == word):
            axis.axvspan(edges[i], edges[i + 1], fill=False, hatch=lines, ec=HATCH, lw=0, zorder=0)
        if whose and word in validity:
            axis.fill([], [], fill=False, hatch=lines, ec=HATCH, lw=0, label=f"{whose}: {word}")


def legend(axis, columns=2):
    """Legend above a panel."""
    axis.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, columnspacing=1.0,
                fontsize=7, handlelength=2.2)  # fmt: skip


def band(one, vary, address, values, quantity, **options):
    """Percentiles 2.5, 50 and 97.5 of a quantity over an address, by `vcor uncertainty`."""
    found = []
    for value in values:
        one = one.copy()
        one[address] = value
        spread = vcor.propagate(one, vary, samples=SAMPLES, quantities=[quantity], **options)
        found.append(spread.table.percentiles.sel(percent=[2.5, 50, 97.5]).values[0])
    return np.array(found).T


def fill(axis, x, low, high, color):
    """A band, smooth over few values."""
    fine = np.geomspace(x[0], x[-1], 60)
    low, high = (smooth(x, end)[1] for end in (low, high))
    axis.fill_between(fine, low, high, color=color, alpha=0.2, lw=0)


def smooth(x, y):
    """A curve through a few values over the logarithm of x."""
    fine = np.geomspace(x[0], x[-1], 60)
    return fine, PchipInterpolator(np.log(x), y)(np.log(fine))


def ticks(axis, values):
    """Ticks of a logarithmic axis."""
    axis.set_xscale("log")
    axis.set_xticks(values, [f"{value:g}" for value in values])
    axis.minorticks_off()
    axis.set_xlim(values[0], values[-1])


def loss_band(one, v):
    """Relative ends of the loss into a half space of the plate, for uncertain materials."""
    one = one.copy()
    one["plate.waves"] = "none"
    names = [one["sphere.material"], one["plate.material"]]
    vary = {f"{name}.modulus": MODULUS for name in names} | {f"{names[1]}.density": DENSITY}
    low, middle, high = band(one, vary, "impact.velocity", [v], "wave_loss")
    return (low / middle)[0], (high / middle)[0]


# --------------------------------------------------------------------------- alumina on thick glass


def oblique():
    """Normal velocity and normal restitution of oblique impacts, and its error from reading."""
    read = data("alumina_on_glass_oblique")
    at, e_t = read.restitution_angle.values, read.tangential_restitution.values
    before, after = np.radians(read.rebound_incidence), np.radians(read.rebound_angle)
    ratio = CubicSpline(read.rebound_incidence, np.tan(after) / np.tan(before))(at)
    relative = np.sqrt(
        (READING / e_t) ** 2
        + sum(
            (np.radians(ANGLE) / (np.sin(angle) * np.cos(angle))) ** 2 for angle in (before, after)
        )
    )
    return OBLIQUE * np.cos(np.radians(at)), e_t / ratio, e_t / ratio * relative


def alumina():
    """Four plates under the sphere of Kharaz et al., and the thickness that is not known."""
    point = data("alumina_on_glass").iloc[0]
    one = vcor.read(ROOT / "examples" / "alumina_on_glass.nml")
    v = np.geomspace(1.5, 5, 4)
    fine = np.geomspace(1.5, 5, 24)
    quantities = ["cor_sphere", "wave_loss", "validity", "validity_cause"]
    made, (left, right) = panels("upper right", "lower right")
    rows, plates = [], {}
    half_space = vcor.Case(re.sub(r"half_thickness.*\n", "\n", one.text()))
    choices = (
        ("no waves", one, "none", "0.5", ":"),
        ("thin plate, 25 mm", one, "constant", "C2", "-."),
        ("body, 25 mm", one, "body", "C1", "-"),
        ("half space", half_space, "body", "C3", "--"),
    )
    low, high = loss_band(half_space, point.velocity)
    for name, of, waves, color, line in choices:
        of = of.copy()
        of["plate.waves"] = waves
        at = v if waves == "body" else fine
        found = of.sweep({"impact.velocity": at}, quantities)
        loss = PchipInterpolator(np.log(at), 1 - found.cor_sphere)(np.log(fine))
        plates[name] = of.solve({"impact.velocity": point.velocity}, quantities)
        words = {"good": ""}.get(plates[name]["validity"], f" ({plates[name]['validity']})")
        curve(left, fine, 1 - loss, color, line, label=name + words)
        if name == "half space":
            left.fill_between(fine, 1 - high * loss, 1 - low * loss, color=color, alpha=0.2, lw=0)
        rows.append([f"{name} (`{waves}`)", plates[name]["cor_sphere"], plates[name]])
    loss = plates["no waves"]["wave_loss"]
    rows.append(["no waves, less `wave_loss`", np.sqrt(1 - loss), None])
    measured(left, *oblique(), fmt="D", color="0.45", label="oblique, from figures")
    measured(left, point.velocity, point.cor_sphere, point.cor_sphere_sigma, label="measured")
    left.set(xlabel="normal velocity [m/s]", ylabel="restitution of the sphere", ylim=(0.965, 1.05))
    ticks(left, [1.5, 2, 3, 4, 5])
    legend(left)
    thick = np.array([10, 13, 16, 20, 25, 35, 50])
    for name, waves, color, line in (
        ("thin plate", "constant", "C2", "-."),
        ("body", "body", "C1", "-"),
    ):
        one["plate.waves"] = waves
        e = one.sweep({"plate.half_thickness": thick * 5e-4}, ["cor_sphere", "validity"])
        curve(right, *smooth(thick, e.cor_sphere), color, line, label=name)
        if waves == "body":
            reaches = np.interp(point.cor_sphere, e.cor_sphere[:4], thick[:4])
        else:
            hatch(right, thick, e.validity.values, name)
    right.axhspan(
        point.cor_sphere - point.cor_sphere_sigma,
        point.cor_sphere + point.cor_sphere_sigma,
        color="0.85",
        lw=0,
        label="measured, rounding",
    )
    right.set(xlabel="thickness of the glass [mm]", ylim=(0.955, 1.002))
    ticks(right, [10, 15, 20, 25, 35, 50])
    legend(right)
    text = table(["plate", "given", "fitted", "predicted e", "measured e",
                  "share of the measured loss", "validity"], *(
        [name, "E, ν, ρ of both, v" + (", 25 mm" if "25 mm" in name else ""), "nothing", f"{e:.4f}",
         f"{point.cor_sphere:.2f}", f"{abs(100 * (1 - e) / (1 - point.cor_sphere)):.0f} %",
         f"{of['validity']}, {of['validity_cause']}" if of else "first order"]
        for name, e, of in rows))  # fmt: skip
    v_n, e_n, error = oblique()
    return made, text + "\n\n" + table(
        ["more", "value"],
        ["thickness at which `body` meets the measured value", f"{reaches:.0f} mm"],
        ["95 % band of the half space for 5 % in the moduli, 2 % in the density",
         f"{1 - high * (1 - rows[3][1]):.4f} to {1 - low * (1 - rows[3][1]):.4f}"],
        ["mean of the oblique points, and their mean error of reading",
         f"{e_n.mean():.2f}, {error.mean():.3f}"])  # fmt: skip


# -------------------------------------------------------------------------------------- ice on ice


def slope(one, v):
    """Restitution against velocity, and d ln e/d ln v."""
    e = one.sweep({"impact.velocity": v}, ["cor"]).cor.values
    return e, CubicSpline(np.log(v), np.log(e))(np.log(v), 1)


def ice():
    """Laws of ice compared with the steepest linear solid."""
    made, (left, right) = panels("lower left", "upper right")
    one = case("ice")
    v = np.geomspace(1e-9, 1e5, 100)
    steepest = {}
    for law, color, line in (("receding", "C1", "-"), ("boltzmann", "C1", "--")):
        one["contact.law"] = law
        e, s = slope(one, v)
        steepest[law] = PchipInterpolator(e[::-1], s[::-1])
        curve(right, e, -s, color, line, label=f"Kelvin-Voigt, {law}")
    one["contact.law"] = "receding"
    largest = 0.0
    lines = [(0, (1, 1)), (0, (5, 1)), (0, (3, 1, 1, 1))]
    for name, keys in SOLIDS.items():
        solid = vcor.Case({
            "impact": {"velocity": 1.0}, "sphere": {"radius": 0.025, "material": "hard"},
            "plate": {"material": "solid", "waves": "none"}, "contact": {"law": "receding"},
            "material": [{"name": "hard", "model": "rigid", "density": 917.0},
                         {"name": "solid", "density": 917.0, "poisson_ratio": 0.33, **keys}],
        })  # fmt: skip
        e, s = slope(solid, np.geomspace(1e-9, 1e3, 80))
        known = (e > 0.02) & (e < 0.9) & (s < 0)
        largest = max(largest, np.max(s[known] / steepest["receding"](e[known])))
        if lines:
            curve(right, e[known], -s[known], "0.5", lines.pop(0), label=name)
    rows = []
    styles = zip(("C2", "C3", "C5"), ("-", "--", "-."), data("ice_laws").itertuples(), strict=True)
    for color, line, law in styles:
        critical = 0.01 * law.critical_velocity
        at = np.geomspace(max(law.lowest_velocity, critical), law.highest_velocity, 9)
        e = (at / critical) ** -law.exponent
        fit = vcor.identify(one, {"velocity": at, "cor": e}, ["ice.viscosity"])
        measured(left, at, e, color=color, label=f"{law.temperature} K, law")
        known = fit.band
        curve(left, known["velocity"], known["cor"], color, line, label=f"{law.temperature} K, fit")
        left.fill_between(
            known["velocity"], known["low"], known["high"], color=color, alpha=0.2, lw=0
        )
        measured(right, e[[0, -1]], [law.exponent] * 2, fmt="o-", color=color)
        over = [law.exponent / -steepest["receding"](e[i]) for i in (4, 8)]
        models = [row["model"] for row in fit.data]
        rows.append([
            f"{law.temperature} K", f"{law.exponent:.3f}", f"{e[0]:.2f} to {e[-1]:.2f}",
            f"{over[0]:.2f} and {over[1]:.2f}", f"{fit['ice.viscosity'] / 1e6:.2f} MPa s",
            f"{100 * fit.relative_error:.0f} %", f"{max(models):.2f} to {min(models):.2f}",
        ])  # fmt: skip
    seen = data("ice_spheres").iloc[0]
    middle = np.sqrt(seen.lowest_velocity * seen.highest_velocity)
    measured(
        left,
        middle,
        seen["mean"],
        [[seen["mean"] - seen.lowest], [seen.highest - seen["mean"]]],
        [[middle - seen.lowest_velocity], [seen.highest_velocity - middle]],
        fmt="s",
        label="spheres of 15 mm",
    )
    across = np.geomspace(1e-4, 0.3, 40)
    judged = one.sweep({"impact.velocity": across}, ["validity"]).validity.values
    hatch(left, across, judged, "fit, pressure")
    left.set(xscale="log", xlim=(1e-4, 0.3), ylim=(0, 1.05), xlabel="velocity [m/s]",
             ylabel="coefficient of restitution")  # fmt: skip
    legend(left)
    right.set(
        xlabel="coefficient of restitution", ylabel="−d ln e/d ln v", xlim=(0, 1), ylim=(0, 0.34)
    )
    measured(right, [], [], fmt="o-", label="laws of ice")
    legend(right)
    return made, table(
        ["law", "its slope", "its e",
         "its slope over that of Kelvin-Voigt, in the middle and at the fast end",
         "fitted viscosity", "misfit of the fit", "e of the fit"],
        *rows) + "\n\n" + table(
        ["more", "value"],
        [f"largest slope of {len(SOLIDS)} other solids over that of Kelvin-Voigt at the same e",
         f"{largest:.2f}"])  # fmt: skip


# ------------------------------------------------------------------------------- spheres and walls


def of_yield(at):
    """Validity of an impact, and the pressure that decides on it."""
    return f"{at['validity']}, mean pressure {at['mean_pressure'] / 1e9:.2f} GPa"


def acetate():
    """A pair of spheres predicts the wall; a glass sphere on a wall that yields."""
    made, (left, right) = panels("upper right", "lower right")
    seen = data("acetate_pair").iloc[0]
    v = np.geomspace(0.3, 3, 4)
    fine = np.geomspace(0.3, 3, 24)
    rows = []
    fits = {
        "Kelvin-Voigt": ("acetate", "acetate.viscosity", "{:.0f} Pa s"),
        "one loss tangent": ("lossy", "lossy.exponent", "exponent {:.4f}"),
    }
    for (model, (name, free, form)), color in zip(fits.items(), ("C1", "C2"), strict=True):
        pair, wall = case("acetate_pair"), case("acetate_on_wall")
        for one in (pair, wall):
            one["sphere.material"] = name
        pair["plate.material"] = name
        fit = vcor.identify(pair, DATA / "acetate_pair.csv", [free])
        pair[free] = wall[free] = fit[free]
        vary = {"aluminium.modulus": MODULUS}
        low, _, high = band(wall, vary, "impact.velocity", v, "cor", covariance=fit.as_dict())
        fill(left, v, low, high, color)
        for one, line, what in ((pair, ":", "pair"), (wall, "-", "wall")):
            found = one.sweep({"impact.velocity": fine}, ["cor", "validity"])
            curve(left, fine, found.cor, color, line, label=f"{what}, {model}")
        hatch(left, fine, found.validity.values)
        at = wall.solve({"impact.velocity": seen.velocity}, ["cor", "wave_loss", "validity"])
        ends = band(wall, vary, "impact.velocity", [seen.velocity], "cor", covariance=fit.as_dict())
        rows.append([f"acetate on a wall, {model}", form.format(fit[free]), f"{at['cor']:.3f}",
                     f"{ends[0][0]:.3f} to {ends[2][0]:.3f}", "not found",
                     at["validity"]])  # fmt: skip
    measured(left, seen.velocity, seen.cor, seen.cor_sigma, label="pair, measured")
    left.set(xlabel="velocity [m/s]", ylabel="coefficient of restitution", ylim=(0.81, 0.91))
    legend(left)
    one, seen = case("glass_on_wall"), data("glass_on_wall").iloc[0]
    low, high = loss_band(one, seen.velocity)
    found = one.sweep({"impact.velocity": v}, ["cor_sphere"]).cor_sphere.values
    loss = PchipInterpolator(np.log(v), 1 - found)(np.log(fine))
    curve(right, fine, 1 - loss, "C3", "--", label="glass on a wall, half space")
    right.fill_between(fine, 1 - high * loss, 1 - low * loss, color="C3", alpha=0.2, lw=0)
    one["plate.waves"] = "none"
    judged = one.sweep({"impact.velocity": fine}, ["validity"]).validity.values
    hatch(right, fine, judged, "half space")
    measured(
        right,
        seen.velocity,
        seen.cor_sphere,
        seen.cor_sphere_sigma,
        label="glass on a wall, measured",
    )
    one["plate.waves"] = "body"
    at = one.solve({"impact.velocity": seen.velocity}, ["cor_sphere", "mean_pressure", "validity"])
    e = at["cor_sphere"]
    rows.append(["glass on a wall", "nothing", f"{e:.4f}",
                 f"{1 - high * (1 - e):.4f} to {1 - low * (1 - e):.4f}", f"{seen.cor_sphere:.2f}",
                 of_yield(at)])  # fmt: skip
    granite, big = case("granite_spheres"), data("granite_spheres").iloc[0]
    at = granite.solve({"impact.velocity": big.velocity}, ["cor", "mean_pressure", "validity"])
    right.fill_between([0.3, 1.5], big.cor - big.cor_sigma, big.cor + big.cor_sigma,
                       color="0.85", lw=0, label="granite pair, measured", zorder=0.5)  # fmt: skip
    curve(right, fine, np.full(fine.shape, at["cor"]), "0.4", ":", label="granite pair, elastic")
    rows.append(["two granite spheres", "nothing", f"{at['cor']:.4f}", "no loss in the model",
                 f"{big.cor:.2f} ± {big.cor_sigma:.2f}",
                 of_yield(at)])  # fmt: skip
    right.set(xlabel="velocity [m/s]", ylim=(0.74, 1.01))
    legend(right)
    for axis in (left, right):
        ticks(axis, [0.3, 0.5, 1, 2, 3])
    return made, table(["impact at 1 m/s", "fitted", "predicted e", "95 % band", "measured e",
                        "validity"], *rows)  # fmt: skip


# ----------------------------------------------------------------------------------- contact times


def their_time(one, v, plate):
    """Contact time of Hertz as McLaskey and Glaser (2010) write and confirm it."""
    ball = one["sphere.material"]
    sum_ = sum(
        (1 - one[f"{name}.poisson_ratio"] ** 2) / (pi * one[f"{name}.modulus"])
        for name in (ball, plate)
    )
    density = one[f"{ball}.density"]
    return 4.53 * (4 * density * pi * sum_ / 3) ** 0.4 * one["sphere.radius"] * v**-0.2


def contact_times():
    """Contact time against velocity, and against the thickness of a plate."""
    made, (left, right) = panels("lower left", "lower left")
    one, seen = case("steel_ball_on_steel"), data("contact_time").iloc[0]
    v = np.geomspace(0.3, 3, 24)
    vary = {"steel.modulus": MODULUS, "block.modulus": MODULUS, "steel.density": DENSITY}
    at = np.geomspace(0.3, 3, 4)
    low, _, high = 1e6 * band(one, vary, "impact.velocity", at, "contact_time")
    found = one.sweep({"impact.velocity": v}, ["contact_time", "validity"])
    fill(left, at, low, high, "C1")
    curve(left, v, 1e6 * found.contact_time, "C1", label="vcor")
    curve(left, v, 1e6 * their_time(one, v, "block"), "black", ":", label="McLaskey and Glaser")
    hatch(left, v, found.validity.values)
    left.axhspan(
        seen.contact_time - seen.contact_time_sigma,
        seen.contact_time + seen.contact_time_sigma,
        color="0.88",
        lw=0,
        zorder=0,
        label="measured, speed not known",
    )
    left.set(xlabel="velocity [m/s]", ylabel="contact time [µs]", ylim=(3.8, 7.8))
    ticks(left, [0.3, 0.5, 1, 2, 3])
    legend(left)
    time = one.solve({"impact.velocity": 1.0}, ["contact_time"])["contact_time"]
    meets = (1e6 * time / (seen.contact_time + seen.contact_time_sigma * np.array([1, 0, -1]))) ** 5
    one["plate.waves"] = "body"
    wave = one.solve({"impact.velocity": 1.0}, ["contact_time", "cor_sphere"])
    rows = [
        ["contact time at 1 m/s, vcor without waves", f"{1e6 * time:.3f} µs"],
        ["the same by the formula of McLaskey and Glaser",
         f"{1e6 * their_time(one, 1.0, 'block'):.3f} µs"],
        ["with waves in 50 mm of steel", f"{1e6 * wave['contact_time']:.3f} µs"],
        ["measured", f"about {seen.contact_time:.0f} µs"],
        ["speed that gives it, and speeds that give 5.5 to 4.5 µs",
         f"{meets[1]:.1f} m/s, {meets[0]:.1f} to {meets[2]:.1f} m/s"],
    ]  # fmt: skip
    plate, claim = case("steel_on_glass"), data("plate_thickness").iloc[0]
    half = np.geomspace(0.4e-3, 30e-3, 120)
    thin = plate.sweep(
        {"plate.half_thickness": half}, ["contact_time", "inelasticity", "cor_sphere"]
    )
    thick = np.array([1.0, 1.4, 2.0, 2.5, 3.0, 4.0, 5.0])
    plate["plate.waves"] = "body"
    body = plate.sweep(
        {"plate.half_thickness": thick * 5e-4},
        ["contact_time", "cor_sphere", "validity", "plate_wave_number"],
    )
    # the thickness that the thin plate's contact time would read
    read = np.interp(-body.contact_time, -thin.contact_time, 2e3 * half)
    lam = np.interp(thick * 5e-4, half, thin.inelasticity)
    error = read / thick - 1
    curve(right, thin.inelasticity, thin.cor_sphere, "C2", "-.", label="e, thin plate")
    # lam falls with the thickness
    curve(right, *smooth(lam[::-1], body.cor_sphere.values[::-1]), "C1", label="e, body")
    second = right.twinx()
    curve(second, *smooth(lam[::-1], 100 * error[::-1]), "C3", "--")
    curve(right, [], [], "C3", "--", label="error of the thickness")
    limit = 100 * claim.largest_relative_error
    second.fill_between(
        [0.05, claim.largest_inelasticity], -limit, limit, color="0.88", lw=0, zorder=0
    )
    right.fill_between([], [], [], color="0.88", label="measured: within 3 %")
    right.set(xlabel="inelasticity λ", ylabel="restitution of the sphere", ylim=(0, 1),
              zorder=second.get_zorder() + 1, frame_on=False)  # fmt: skip
    right.tick_params(right=False)
    second.set(ylabel="error of the thickness [%]", ylim=(-10, 40))
    second.tick_params(left=False, top=False)
    ticks(right, [0.05, 0.1, 0.2, 0.5, 1, 2])
    legend(right)
    steps = [[f"{h:.1f} mm", f"{of:.2f}", f"{k:.2f}", f"{zener:.3f}", f"{e:.3f}",
              f"{100 * wrong:+.1f} %"]
             for h, of, k, zener, e, wrong in zip(
                 thick, lam, body.plate_wave_number.values,
                 np.interp(thick * 5e-4, half, thin.cor_sphere), body.cor_sphere.values, error,
                 strict=True)]  # fmt: skip
    return made, table(["contact time", "value"], *rows) + "\n\n" + table(
        ["glass", "λ", "`plate_wave_number`", "e, thin plate", "e, body",
         "error of the thickness from the contact time"],
        *steps)  # fmt: skip


# ------------------------------------------------------------------------------------- a golf ball


def flights(v, e, height, count):
    """Times in flight between bounces after a fall, from e over v."""
    restitution = PchipInterpolator(np.log(v), e)
    speed, times = np.sqrt(2 * GRAVITY * height), []
    for _ in range(count):
        speed *= restitution(np.log(speed))
        times.append(2 * speed / GRAVITY)
    return np.array(times)


def golf():
    """First rebounds fit one number, which predicts the bounces that follow."""
    made, (left, right) = panels("upper right", "upper left")
    drops, seen = data("golf_ball"), data("golf_ball_flights")
    v, rows = np.geomspace(1.5, 6, 24), []
    ratio, of_drops = drops.rebound_height / drops.drop_height, 0.01 * drops.drop_height
    first = np.sqrt(ratio)
    measured(
        left,
        np.sqrt(2 * GRAVITY * of_drops),
        first,
        first * drops.rebound_height_sigma / drops.rebound_height / 2,
        label="first rebounds, fitted",
    )
    fits = {"one loss tangent": ("lossy", "lossy.exponent", "exponent {:.4f}"),
            "Kelvin-Voigt": ("kelvin", "kelvin.viscosity", "{:.0f} Pa s")}  # fmt: skip
    for (model, (name, free, form)), color in zip(fits.items(), ("C1", "C2"), strict=True):
        one = case("golf_ball")
        one["sphere.material"] = name
        fit = vcor.identify(one, DATA / "golf_ball.csv", [free])
        value, error = fit[free], fit.estimates[0].standard_error
        speeds = vcor.Case(one.text().replace("drop_height = 1.0", "velocity = 1.0"))
        low, e, high = (
            speeds.points({"impact.velocity": v, free: x}, ["cor_sphere"]).cor_sphere.values
            for x in (value + 1.96 * error, value, value - 1.96 * error)
        )
        curve(left, v, e, color, label=model)
        left.fill_between(v, low, high, color=color, alpha=0.2, lw=0)
        chi2 = 0.0
        for (height, run), mark in zip(seen.groupby("drop_height"), "sD", strict=True):
            times = flights(v, e, 0.01 * height, len(run))
            off, relative = run.flight_time / times - 1, run.flight_time_sigma / times
            chi2 += np.sum((off / relative) ** 2)
            measured(
                right,
                run.bounce + (0.08 if mark == "D" else -0.08),
                100 * off,
                100 * relative,
                fmt=mark,
                color=color,
                label=f"{height} cm, {model}",
            )
        judged = speeds.solve({"impact.velocity": 4.0, free: value}, ["validity", "validity_cause"])
        rows.append([model, form.format(value), f"{fit.chi2:.1f} for {fit.dof}",
                     f"{times[-1]:.3f} s", f"{chi2:.0f} for {len(seen)}",
                     f"{judged['validity']}, {judged['validity_cause']}"])  # fmt: skip
    for (height, run), mark in zip(seen.groupby("drop_height"), "sD", strict=True):
        time, sigma = run.flight_time.values, run.flight_time_sigma.values
        measured(left, GRAVITY / 2 * np.sqrt(time[1:] * time[:-1]), time[1:] / time[:-1],
                 np.hypot(sigma[1:], sigma[:-1]) / time[:-1], fmt=mark, color="0.45",
                 label=f"flights, {height} cm")  # fmt: skip
    left.set(xlabel="velocity [m/s]", ylabel="restitution of the sphere", ylim=(0.86, 0.93))
    ticks(left, [1.5, 2, 3, 4, 5, 6])
    legend(left)
    right.axhline(0, color="black", lw=0.6, marker="")
    right.set(xlabel="bounce", ylabel="flight: measured − predicted [%]")
    legend(right)
    return made, table(["material", "fitted", "χ² of the first rebounds",
                        "predicted eighth flight, 110 cm",
                        "χ² of all flights", "validity at 4 m/s"], *rows)  # fmt: skip


# ---------------------------------------------------------------- rubbers, and a ball that bounces


def resilience():
    """Rebound of rubbers whose loss factor a data sheet has; a ball that bounces for 40 s."""
    made, (left, right) = panels("upper right", "lower right")
    one = vcor.read(ROOT / "examples" / "identification" / "resilience.nml")
    exponent = np.geomspace(0.01, 0.78, 60)
    loss = np.tan(pi * exponent / 2)
    exact = one.sweep({"rubber.exponent": exponent}, ["resilience"]).resilience.values
    exponent_of = PchipInterpolator(exact[::-1], exponent[::-1])
    few = np.array([0.01, 0.05, 0.15, 0.4, 0.7])
    low, _, high = band(one, {"rubber.exponent": LOSS_FACTOR}, "rubber.exponent", few, "resilience")
    fill(left, np.tan(pi * few / 2), 100 * low, 100 * high, "C1")
    curve(left, loss, 100 * exact, "C1", label="exact")
    one["contact.law"] = "boltzmann"
    other = one.sweep({"rubber.exponent": exponent}, ["resilience"]).resilience.values
    curve(left, loss, 100 * other, "C2", "-.", label="boltzmann")
    curve(left, loss, 100 * np.exp(-pi * loss), "black", ":", label="textbook")
    one["contact.law"] = "receding"
    rows = []
    for name, row in zip(
        ("Sylodyn ND", "Sylodyn NF"), data("resilience").itertuples(), strict=True
    ):
        value = one.solve({"rubber.exponent": 2 / pi * np.arctan(row.loss_factor)}, ["resilience"])
        measured(left, row.loss_factor, 100 * row.resilience, 100 * row.resilience_sigma,
                 label=None if rows else "data sheets")  # fmt: skip
        needed = np.tan(pi / 2 * exponent_of(row.resilience))
        rows.append([name, f"loss factor {row.loss_factor:.2f}",
                     f"{100 * value['resilience']:.1f} %",
                     f"{100 * np.exp(-pi * row.loss_factor):.1f} %",
                     f"{100 * row.resilience:.0f} ± {100 * row.resilience_sigma:.0f} %",
                     f"{needed:.3f}"])  # fmt: skip
    for name, row in zip(
        ("red ball", "black ball"), data("rubber_balls").itertuples(), strict=True
    ):
        needed = np.tan(pi / 2 * exponent_of(row.resilience))
        left.axhline(100 * row.resilience, color="0.45", lw=0.7, ls="--", marker="", zorder=1)
        at = 0.7 if row.resilience > 0.5 else 0.022
        left.annotate(name, (at, 100 * row.resilience + 1), color="0.4", fontsize=7)
        rows.append([name, "nothing", "none", "none", f"about {100 * row.resilience:.0f} %",
                     f"{needed:.3f}"])  # fmt: skip
    left.set(xlabel="loss factor tan δ", ylabel="resilience [%]", ylim=(0, 100))
    ticks(left, [0.02, 0.05, 0.1, 0.2, 0.5, 1, 2])
    legend(left)
    text = table(["rubber", "given", "predicted resilience", "textbook", "measured",
                  "tan δ that the measured value requires"], *rows)  # fmt: skip
    flight = data("bouncing_ball")
    period, middle = (flight.end - flight.start) / 10, (flight.end + flight.start) / 2
    bounces = np.diff(middle) / np.sqrt(period[1:].values * period[:-1].values)
    e = (period[1:].values / period[:-1].values) ** (1 / bounces)
    v = GRAVITY / 2 * np.sqrt(period[1:].values * period[:-1].values)
    one, at, fine = case("bouncing_ball"), np.geomspace(0.1, 1.3, 4), np.geomspace(0.1, 1.3, 24)
    found = one.sweep({"impact.velocity": at}, ["cor_sphere"]).cor_sphere.values
    lost = PchipInterpolator(np.log(at), 1 - found)(np.log(fine))
    low, high = loss_band(one, 1.0)
    curve(right, fine, 1 - lost, "C3", "--", label="elastic half space")
    right.fill_between(fine, 1 - high * lost, 1 - low * lost, color="C3", alpha=0.2, lw=0)
    curve(right, fine, np.ones_like(fine), "0.5", ":", label="no waves")
    measured(right, v, e, e.std(ddof=1), label="from times in flight")
    right.set(xlabel="velocity [m/s]", ylabel="restitution of the sphere", ylim=(0.9915, 1.0002))
    ticks(right, [0.1, 0.2, 0.5, 1, 1.3])
    legend(right)
    steps = [[f"{of:.2f}", f"{1e3 * (1 - seen):.1f} ± {1e3 * e.std(ddof=1):.1f}",
              f"{1e3 * np.interp(of, fine, lost):.1f}"]
             for of, seen in zip(v, e, strict=True)]  # fmt: skip
    return made, text + "\n\n" + table(
        ["v [m/s]", "measured 1000 (1 − e)", "predicted 1000 (1 − e)"], *steps)  # fmt: skip


# ---------------------------------------------------------------- three grades of one rubber


def lighter(one, radius, wanted):
    """Possible reasons for a rebound below that of a fixed pad: cells of the table."""
    quantities = ["resilience", "layer_strain"]
    fixed = one.solve({"sphere.radius": radius}, quantities)
    stiff = one.copy()
    for name in ("relaxing_modulus", "equilibrium_modulus"):
        stiff[f"sorbothane.{name}"] = 1.5 * stiff[f"sorbothane.{name}"]
    anvil = vcor.Case(one.text() + "&target body = 'block', mass = 1 /")
    # how far the fixed pad relies on the fit beyond its data is said above
    del anvil["sorbothane.valid_from"], anvil["sorbothane.valid_to"]

    def on(mass):
        """Resilience on a free anvil of a mass [kg]."""
        return anvil.solve({"sphere.radius": radius, "target.mass": mass}, ["resilience"])["resilience"]

    meets = brentq(lambda mass: on(mass) - wanted, 0.1, 10.0, rtol=1e-4)
    return [f"{fixed['layer_strain']:.2f}", f"{100 * fixed['resilience']:.1f} %",
            f"{100 * stiff.solve({'sphere.radius': radius}, quantities)['resilience']:.1f} %",
            *(f"{100 * on(mass):.1f} %" for mass in (10.0, 1.0)), f"{meets:.2f} kg"]  # fmt: skip


def sorbothane():
    """Vertical rebound of three grades from their moduli, with everything that the sheet does not say varied."""
    made, (left, right) = panels("upper left", "lower right")
    moduli, rows, causes = data("sorbothane_moduli"), [], []
    for color, grade in zip(("C0", "C1", "C2"), data("sorbothane").itertuples(), strict=True):
        known = moduli[moduli.durometer_shore_00 == grade.durometer_shore_00]
        found = {"none": [], "body": []}
        for most in (SHEET, np.inf):
            seen = known[known.frequency <= most]
            omega = 2 * pi * seen.frequency.values
            storage = seen.storage_modulus.values
            fit = vcor.fit([omega, storage, storage * seen.loss_tangent.values], name="sorbothane",
                           model="mittag_leffler" if most > SHEET else "power_law",
                           density=grade.density * POUND_PER_CUBIC_FOOT)  # fmt: skip
            one = case("sorbothane")
            one.add(vcor.Case(fit.group))
            for waves, values in found.items():
                for base in ("bonded", "sliding"):
                    one["plate.waves"], one["plate.base"] = waves, base
                    values += [one.solve({"sphere.radius": radius}, ["resilience", "peak_loss_tangent"])
                               for radius in PLUNGERS]  # fmt: skip
        one["plate.waves"], one["plate.base"] = "none", "bonded"
        causes.append([f"{grade.durometer_shore_00} Shore 00", *lighter(one, PLUNGERS[0], grade.resilience)])
        tangent = found["none"][-1]["peak_loss_tangent"]
        low, high = ({waves: 100 * end(one["resilience"] for one in values)
                      for waves, values in found.items()} for end in (min, max))  # fmt: skip
        name, at = f"{grade.durometer_shore_00} Shore 00", grade.durometer_shore_00
        for waves, shift in (("none", -2), ("body", 2)):
            middle = (low[waves] + high[waves]) / 2
            measured(left, [at + shift], [middle], (high[waves] - low[waves]) / 2, color=color,
                     fmt="s" if waves == "none" else "D",
                     label={"none": "without waves", "body": "with waves"}[waves] if not rows else None)  # fmt: skip
        measured(left, [at], [100 * grade.resilience], label=None if rows else "measured")
        measured(right, known.frequency, known.loss_tangent, color=color, fmt="o", label=name)
        frequency = 2 * pi * np.geomspace(5, 500, 40)
        modulus = one.material("sorbothane").complex_modulus(frequency)
        curve(right, frequency / (2 * pi), modulus.imag / modulus.real, color)
        rows.append([name, f"{tangent:.2f}",
                     *(f"{low[waves]:.0f} to {high[waves]:.0f} %" for waves in found),
                     f"{100 * np.exp(-pi * tangent):.0f} %", f"{100 * grade.resilience:.0f} %"])  # fmt: skip
    left.set(xlabel="hardness [Shore 00]", ylabel="resilience [%]", xlim=(20, 80), ylim=(0, 45))
    right.set(xlabel="frequency [Hz]", ylabel="loss tangent", xscale="log", ylim=(0, 1))
    legend(left)
    legend(right)
    return made, table(["grade", "tan δ at π/t₀", "predicted without waves", "with waves", "textbook",
                        "measured"], *rows) + "\n\n" + table(
        ["grade", "`layer_strain`", "fixed, without waves", "moduli times 1.5", "anvil of 10 kg", "anvil of 1 kg",
         "anvil that gives the measured value"], *causes)  # fmt: skip


#: Sections of the page, and the cases with the numbers that were put in
PARTS = {
    "alumina": (alumina, "examples/alumina_on_glass"),
    "times": (contact_times, "data/measurements/steel_ball_on_steel",
              "data/measurements/steel_on_glass"),
    "golf": (golf, "data/measurements/golf_ball"),
    "rebound": (resilience, "examples/identification/resilience",
                "data/measurements/bouncing_ball"),
    "sorbothane": (sorbothane, "data/measurements/sorbothane"),
    "spheres": (acetate, "data/measurements/acetate_pair", "data/measurements/acetate_on_wall",
                "data/measurements/glass_on_wall", "data/measurements/granite_spheres"),
    "ice": (ice, "data/measurements/ice"),
}  # fmt: skip


def page(text, tables):
    """The page with its tables made anew, each between its name and `end` in comments."""
    for name, lines in tables.items():
        text, count = re.subn(rf"(<!-- {name} -->\n).*?(\n<!-- end -->)",
                              lambda found, lines=lines: found[1] + lines + found[2], text,
                              flags=re.DOTALL)  # fmt: skip
        if count != 1:
            raise SystemExit(f"docs/measurements.md: found {count} places for {name}, expected one")
    return text


def main(folder):
    """Write the page and its figures to a folder."""
    tables = {}
    with style.context(STYLE):
        for name, (make, *cases) in PARTS.items():
            made, text = make()
            tables[name] = f"{text}\n\n{put_in(*(f'{one}.nml' for one in cases))}"
            made.savefig(folder / f"measurements_{name}.svg", metadata={"Date": None})
    text = (ROOT / "docs" / "measurements.md").read_text("utf-8")
    (folder / "measurements.md").write_text(page(text, tables), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
