"""Write the tables of docs/structures.md: restitution on rigid, infinite and finite bodies.

    python docs/make_structures.py [FOLDER]
"""

import math
import re
import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

import vcor

ROOT = Path(__file__).resolve().parent.parent
STEEL = {"name": "steel", "model": "elastic", "modulus": 210e9, "poisson_ratio": 0.3, "density": 7850.0}
GLASS = {"name": "glass", "model": "elastic", "modulus": 70e9, "poisson_ratio": 0.22, "density": 2500.0}
# name, radius of the steel ball [m], material, length, width and thickness [m]; at 1 m/s
PLATES = [
    ("steel, 300 x 300 x 3 mm", 0.005, STEEL, 0.3, 0.3, 0.003),
    ("steel, 100 x 100 x 3 mm", 0.005, STEEL, 0.1, 0.1, 0.003),
    ("steel, 50 x 50 x 3 mm", 0.005, STEEL, 0.05, 0.05, 0.003),
    ("the same 300 x 300 x 3 mm, a ball of 10 mm", 0.01, STEEL, 0.3, 0.3, 0.003),
    ("glass tile, 100 x 100 x 4 mm, a ball of 2 mm", 0.002, GLASS, 0.1, 0.1, 0.004),
    ("phone glass, 150 x 70 x 0.7 mm", 0.005, GLASS, 0.15, 0.07, 0.0007),
]
# mass [kg] and stiffness [N/m] of an anvil of steel
ANVILS = [(0.05, 1e9), (0.2, 1e8), (1.0, 1e7)]
# A plastic sheet of 2 mm under a rigid ball, and half of its sides [m]
SHEET = {"name": "sheet", "model": "prony", "density": 1200.0, "poisson_ratio": 0.3,
         "equilibrium_modulus": 2.5e9, "moduli": [2.5e9], "times": [1e-5]}  # fmt: skip
SIDE, THICKNESS = 0.12, 0.002
# Natural rubber, and the masses of the block of it [kg]
RUBBER = {"name": "rubber", "model": "prony", "density": 1100.0, "poisson_ratio": 0.5,
          "equilibrium_modulus": 2e6, "moduli": [3e5, 3e5, 4e5, 6e5],
          "rates": [30.0, 300.0, 3e3, 3e4]}  # fmt: skip
BLOCKS = [10.0, 1.0, 0.2]
# mass of the anvil of a rebound test [kg]
MASSES = [70.0, 35.0, 10.0]


def case(radius, plate, target=None, **more):
    """A steel ball at 1 m/s."""
    groups = {
        "impact": {"velocity": 1.0},
        "sphere": {"radius": radius, "material": "steel"},
        "plate": {"material": plate["name"], **more},
        "material": [STEEL] if plate is STEEL else [STEEL, plate],
    }
    if target:
        groups["target"] = target
    return vcor.Case(groups)


def solved(one):
    """Restitution of the sphere and number of contacts."""
    found = one.run()
    return float(found.cor_sphere), int(found.contacts)


def plates():
    """Supported plates: no waves, an infinite plate, and the plate with its edges."""
    lines = ["| plate | no waves | infinite | with its edges | contacts |", "|---|---|---|---|---|"]
    for name, radius, material, length, width, thickness in PLATES:
        body = {"body": "plate", "support": "supported", "length": length, "width": width}
        none, _ = solved(case(radius, material, waves="none"))
        infinite, _ = solved(case(radius, material, thickness=thickness, waves="constant"))
        finite, contacts = solved(case(radius, material, body, thickness=thickness))
        lines.append(f"| {name} | {none:.3f} | {infinite:.3f} | {finite:.3f} | {contacts} |")
    return "\n".join(lines)


def anvils():
    """Blocks on springs."""
    lines = ["| anvil | on | e |", "|---|---|---|"]
    for mass, stiffness in ANVILS:
        e, _ = solved(case(0.005, STEEL, {"body": "block", "mass": mass, "stiffness": stiffness}))
        lines.append(f"| {mass:g} kg | {stiffness / 1e6:g} kN/mm | {e:.3f} |")
    return "\n".join(lines)


def pendulum():
    """The rebound test of the example on a free anvil."""
    pad = vcor.read(ROOT / "examples" / "rubber_pad_on_steel.nml")
    half_space = vcor.Case(re.sub(r"\n *(thickness|base) *=[^\n]*", "", str(pad)))
    half_space["plate.waves"] = "none"
    lines = ["| anvil | pad | half space |", "|---|---|---|"]
    for mass in [None, *MASSES]:
        if mass:
            for one in (pad, half_space):
                one["target.body"] = "block"
                one["target.mass"] = mass
        row = [f"{100 * float(one.run().resilience):.1f} %" for one in (pad, half_space)]
        lines.append(f"| {f'{mass:g} kg' if mass else 'fixed'} | {row[0]} | {row[1]} |")
    return "\n".join(lines)


def on_sheet(target=None, **plate):
    """A rigid ball on the sheet."""
    groups = {
        "impact": {"velocity": 2.0},
        "sphere": {"radius": 0.002, "material": "ball"},
        "plate": {"material": "sheet", **plate},
        "contact": {"law": "boltzmann"},
        "material": [{"name": "ball", "model": "rigid", "density": 2500.0}, SHEET],
    }
    if target:
        groups["target"] = target
    return float(vcor.Case(groups).run().cor_sphere)


def modes_of_sheet(moduli):
    """Modes of the sheet with the modulus that a function gives for the glassy frequency [rad/s]."""
    glassy = SHEET["equilibrium_modulus"] + SHEET["moduli"][0]
    order = np.arange(1, 121, 2) * math.pi / SIDE
    wave = (order[:, None] ** 2 + order**2).ravel()
    bending = THICKNESS**2 / (12 * (1 - SHEET["poisson_ratio"] ** 2) * SHEET["density"])
    w = np.sort(wave) * math.sqrt(glassy * bending)
    w = w[w < 8e6]
    ratio = np.zeros_like(w)
    for n, one in enumerate(w):
        w[n], ratio[n] = moduli(one, glassy)
    mass = SHEET["density"] * THICKNESS * SIDE**2 / 4
    return "frequency [Hz],damping_ratio,modal_mass [kg]\n" + "".join(
        f"{f / (2 * math.pi)!r},{zeta!r},{mass!r}\n" for f, zeta in zip(w.tolist(), ratio.tolist(), strict=True)
    )


def with_loss(w, glassy):
    """Frequency with the storage modulus there, and half of the loss tangent there."""
    modulus, first = glassy, w
    for _ in range(60):
        p = 1j * w * SHEET["times"][0]
        modulus = SHEET["equilibrium_modulus"] + SHEET["moduli"][0] * p / (1 + p)
        w = first * math.sqrt(modulus.real / glassy)
    return w, 0.5 * modulus.imag / modulus.real


def relaxing():
    """A sheet of a material that relaxes, and what modes with damping ratios make of it."""
    body = {"body": "plate", "support": "supported", "length": SIDE, "width": SIDE}
    lines = ["| the sheet | e |", "|---|---|"]
    e = on_sheet(thickness=THICKNESS, waves="hereditary")
    lines.append(f"| infinite, `waves = 'hereditary'` | {e:.6f} |")
    lines.append(f"| {1e3 * SIDE:g} x {1e3 * SIDE:g} mm, its material in every mode | {on_sheet(body, thickness=THICKNESS):.6f} |")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "modes.csv"
        for name, law in (("a damping ratio for each mode", with_loss), ("modes without loss", lambda w, _: (w, 0.0))):
            path.write_text(modes_of_sheet(law), encoding="utf-8")
            lines.append(f"| {name} | {on_sheet({'body': 'modes', 'file': str(path)}):.3f} |")
    return "\n".join(lines)


def waves():
    """A steel ball on a block of rubber, with and without waves in it."""
    groups = {
        "impact": {"drop_height": 0.25},
        "sphere": {"radius": 0.0075, "material": "steel"},
        "plate": {"material": "rubber", "waves": "none"},
        "contact": {"law": "receding", "pair": "series"},
        "material": [{"name": "steel", "model": "rigid", "density": 7850.0}, RUBBER],
    }
    one = vcor.Case(groups)
    lines = ["| block | without waves | with waves | `block_reach` |", "|---|---|---|---|"]
    for mass in [None, *BLOCKS]:
        if mass:
            one["target.body"] = "block"
            one["target.mass"] = mass
        found = []
        for kind in ("none", "body"):
            one["plate.waves"] = kind
            found.append(one.run())
        reach = f"{float(found[1].block_reach):.2f}" if mass else ""
        lines.append(
            f"| {f'{mass:g} kg' if mass else 'floor'} | {float(found[0].cor_sphere):.3f} | "
            f"{float(found[1].cor_sphere):.3f} | {reach} |"
        )
    return "\n".join(lines)


def main(folder):
    """Write the page to a folder."""
    text = (ROOT / "docs" / "structures.md").read_text("utf-8")
    for make in (plates, relaxing, anvils, pendulum, waves):
        pattern = rf"(<!-- {make.__name__} -->\n).*?(\n<!-- end -->)"
        text = re.sub(pattern, rf"\g<1>{make()}\g<2>", text, flags=re.DOTALL)
    (folder / "structures.md").write_text(text, "utf-8")


if __name__ == "__main__":
    # the page is about them
    warnings.simplefilter("ignore", vcor.ValidityWarning)
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
