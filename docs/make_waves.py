"""Write the tables of docs/impact.md and docs/waves.svg: what each choice of waves and the floor below a layer change.

pip install './python[plot]' && python docs/make_waves.py [FOLDER]
"""

import re
import sys
from pathlib import Path

import numpy as np
from matplotlib import style
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator
from vcor.plot import PAGE, STYLE

import vcor

ROOT = Path(__file__).resolve().parent.parent
#: Plates: file, thicknesses of the table [mm], speeds [m/s], thickness of the lower panel [mm]
PLATES = {
    "rubber": ("examples/paper/sls.nml", (10, 20, 40, 80, 160), (0.5, 2, 10), 40),
    "glass": ("data/measurements/steel_on_glass.nml", (1, 2, 4, 8, 20, 50), (0.3, 1, 3), 4),
    "PMMA": ("examples/glass_bead_on_pmma.nml", (1, 1.5, 3, 6, 15), (0.3, 1, 3), 3),
}
#: Choices: head of the table, keys, and whether the plate is a half space
CHOICES = {
    "body": ("`'body'`", {"waves": "body"}, False),
    "paper": ("`'relaxing'`, `boltzmann`, `eq1`", {"waves": "relaxing"}, False),
    "thin plate": (
        "`'hereditary'`, `receding`, `series`",
        {"waves": "hereditary", "law": "receding", "pair": "series"},
        False,
    ),
    "half space": ("`'body'`, no thickness", {"waves": "body"}, True),
    "no waves": (
        "`'none'`, `receding`, `series`",
        {"waves": "none", "law": "receding", "pair": "series"},
        False,
    ),
}
#: Looks of their curves
LOOKS = [
    {"color": "black", "linestyle": "-", "zorder": 3},
    {"color": "C1", "linestyle": "--"},
    {"color": "C2", "linestyle": "-."},
    {"color": "C3", "linestyle": ":"},
    {"color": "0.5", "linestyle": (0, (8, 2))},
]
#: Points of a curve
POINTS = 16
#: Test pieces of rubber on a floor: the case, and thicknesses [mm]
PAD, PADS = "examples/rubber_pad_on_steel.nml", (3, 6, 12.5, 25, 50)
#: Light balls on a layer of 5 mm: material, density [kg/m3], diameter [mm], velocity [m/s]
BALLS = [("steel", 7800, 6, 1), ("steel", 7800, 2, 1), ("glass", 2500, 3, 1), ("steel", 7800, 2, 3), ("steel", 7800, 1, 3)]
#: The layer: shear modulus [Pa], density [kg/m3], thickness [m]
SHEAR, DENSITY, LAYER = 1.2e6, 1100.0, 0.005
LIGHT = """
&impact velocity = {velocity} /
&sphere diameter = {diameter}, material = 'ball' /
&plate thickness = {thickness}, base = '{base}', material = 'rubber' /
&contact mechanics = 'exact' /
&material name = 'ball', model = 'rigid', density = {ball} /
&material name = 'rubber', model = 'elastic', modulus = {modulus}, poisson_ratio = 0.5, density = {layer} /
"""


def case(plate, choice):
    """The case of a plate with a choice of mechanics."""
    _, keys, half_space = CHOICES[choice]
    text = vcor.read(ROOT / PLATES[plate][0]).text()
    # the keys that the choice sets, and those that the sweep sets
    text = re.sub(r"\n *(law|pair|waves|velocity|drop_height) *=.*", "", text)
    text = re.sub(r"&contact\s*/", "", text)
    if half_space:
        text = re.sub(r"\n *half_thickness *=.*", "", text)
    text = text.replace("&impact", "&impact\n velocity = 1.0")
    text = text.replace("&plate", f"&plate\n waves = '{keys['waves']}'")
    one = vcor.Case(text)
    # of a rigid sphere there is no pair, and an elastic contact has one law
    unread = {"rubber": ["pair"], "glass": ["law", "pair"]}.get(plate, [])
    for key in ("law", "pair"):
        if key in keys and key not in unread:
            one[f"contact.{key}"] = keys[key]
    return one


def solve(plate, choice, thick, speeds):
    """Restitution and `plate_wave_number` over thickness [mm] and speed."""
    at = {"impact.velocity": np.asarray(speeds, float)}
    if not CHOICES[choice][2]:
        at = {"plate.half_thickness": 5e-4 * np.asarray(thick, float), **at}
    names = ["cor_sphere", "plate_wave_number"]
    found = case(plate, choice).sweep(at, names, progress=False)
    return [np.broadcast_to(found[name].values, (len(thick), len(speeds))) for name in names]


def choices(plate):
    """The choices of a plate; `relaxing` and `hereditary` are the same for an elastic one."""
    return [name for name in CHOICES if (plate, name) != ("glass", "paper")]


def errors(values, exact):
    """Relative errors in words."""
    words = []
    for value, right in zip(values, exact, strict=True):
        percent = 100 * (value / right - 1)
        words.append(f"{percent:+.0f} %" if abs(percent) >= 9.5 else f"{percent:+.1f} %")
        if value >= 4 * right:
            words[-1] = f"×{value / right:.0f}"
    return ", ".join(words)


def table(plate):
    """The table of a plate in Markdown."""
    _, thick, speeds, _ = PLATES[plate]
    found = {name: solve(plate, name, thick, speeds) for name in choices(plate)}
    exact, wave_number = found.pop("body")
    heads = [CHOICES[name][0] for name in ("body", *found)]
    lines = [["thickness", "`plate_wave_number`", *heads]]
    for i, h in enumerate(thick):
        line = [f"{h} mm", ", ".join(f"{k:.2f}" for k in wave_number[i])]
        line.append(", ".join(f"{e:.4f}" for e in exact[i]))
        line += [errors(e[i], exact[i]) for e, _ in found.values()]
        lines.append(line)
    return markdown(lines)


def markdown(lines):
    """Lines of cells as a table; the first is the head."""
    lines = [lines[0], ["---"] * len(lines[0]), *lines[1:]]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def pads():
    """Rebound of a test piece on its floor against its thickness, and of a half space."""
    lines = [["thickness", "contact time", "largest force", "resilience", "$a/H$", "stiffening"]]
    names = ["contact_time", "max_force", "resilience", "layer_ratio", "layer_stiffening"]
    one = vcor.read(ROOT / PAD)
    for thick in PADS:
        found = one.solve({"plate.thickness": 1e-3 * thick}, names)
        line = [f"{thick:g} mm", f"{1e3 * found['contact_time']:.2f} ms", f"{found['max_force']:.0f} N"]
        line += [f"{100 * found['resilience']:.1f} %", f"{found['layer_ratio']:.2f}", f"{found['layer_stiffening']:.2f}"]
        lines.append(line)
    text = re.sub(r"\n *(thickness|base) *=.*", "", one.text())
    found = vcor.Case(text.replace("&plate", "&plate\n waves = 'none'")).solve({}, names[:3])
    line = [f"{1e3 * found['contact_time']:.2f} ms", f"{found['max_force']:.0f} N", f"{100 * found['resilience']:.1f} %"]
    return markdown([*lines, ["half space", *line, "", ""]])


def light():
    """The share of the energy of a light ball that waves in an elastic layer take."""
    lines = [["ball", "$c_st_0/2H$", "bonded", "sliding"]]
    for name, ball, diameter, velocity in BALLS:
        shares = []
        for base in ("bonded", "sliding"):
            text = LIGHT.format(velocity=velocity, diameter=1e-3 * diameter, thickness=LAYER, base=base, ball=ball,
                                modulus=3 * SHEAR, layer=DENSITY)  # fmt: skip
            found = vcor.Case(text).solve({}, ["cor_sphere", "contact_time"])
            shares.append(f"{100 * (1 - found['cor_sphere'] ** 2):.2g} %")
            if base == "bonded":
                crossings = (SHEAR / DENSITY) ** 0.5 * found["contact_time"] / (2 * LAYER)
        lines.append([f"{name} of {diameter} mm at {velocity} m/s", f"{crossings:.1f}", *shares])
    return markdown(lines)


def curves(axes, plate, letters):
    """Relative difference from the exact restitution against thickness, and restitution against speed."""
    upper, lower = axes
    _, thick, speeds, middle = PLATES[plate]
    over_thick = np.geomspace(thick[0], thick[-1], POINTS)
    over_speed = np.geomspace(speeds[0], speeds[-1], POINTS)
    exact = solve(plate, "body", over_thick, speeds[1:2])[0]
    for i, name in enumerate(CHOICES):
        if name not in choices(plate):
            continue
        look = {"marker": "", "label": name, **LOOKS[i]}
        lower.plot(over_speed, solve(plate, name, [middle], over_speed)[0][0], **look)
        if name != "body":
            e = solve(plate, name, over_thick, speeds[1:2])[0]
            upper.plot(over_thick, abs(e / exact - 1)[:, 0], **look)
    upper.set(title=f"({letters[0]}) {plate}, {speeds[1]} m/s", xlabel="thickness [mm]", xscale="log",
              yscale="log", ylim=(1e-4, 100))  # fmt: skip
    lower.set(title=f"({letters[1]}) {plate}, {middle} mm", xlabel="velocity [m/s]", xscale="log")
    for axis, ticks in ((upper, thick), (lower, speeds)):
        axis.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axis.xaxis.set_minor_locator(NullLocator())


def figure():
    """The curves of all plates."""
    made = Figure(figsize=(PAGE / 2.54, 10.5 / 2.54), layout="constrained")
    axes = made.subplots(2, 3)
    for column, plate, letters in zip(axes.T, PLATES, ("ad", "be", "cf"), strict=True):
        curves(column, plate, letters)
    note = "elastic: the paper's\nis the thin plate"
    axes[0, 1].text(0.97, 0.94, note, transform=axes[0, 1].transAxes, ha="right", va="top")
    axes[1, 1].text(0.97, 0.8, note, transform=axes[1, 1].transAxes, ha="right", va="top")
    axes[0, 0].set_ylabel("relative difference from body")
    axes[1, 0].set_ylabel("restitution of the sphere")
    made.legend(*axes[1, 0].get_legend_handles_labels(), loc="outside upper center", ncols=5)
    return made


def main(folder):
    """Write the page and its figure to a folder."""
    text = (ROOT / "docs" / "impact.md").read_text("utf-8")
    made = {plate: table(plate) for plate in PLATES} | {"pad": pads(), "light": light()}
    for name, lines in made.items():
        pattern = rf"(<!-- {name} -->\n).*?(\n<!-- end -->)"
        text = re.sub(pattern, lambda found, lines=lines: f"{found[1]}{lines}{found[2]}", text, flags=re.DOTALL)
    (folder / "impact.md").write_text(text, "utf-8")
    with style.context(STYLE):
        figure().savefig(folder / "waves.svg", metadata={"Date": None})


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
