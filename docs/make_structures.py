"""Write the tables of docs/structures.md: restitution on rigid, infinite and finite bodies.

    python docs/make_structures.py [FOLDER]
"""

import re
import sys
import warnings
from pathlib import Path

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
    one = vcor.read(ROOT / "examples" / "rubber_pad_on_steel.nml")
    lines = ["| anvil | resilience |", "|---|---|", f"| fixed | {100 * float(one.run().resilience):.1f} % |"]
    one["target.body"] = "block"
    for mass in MASSES:
        one["target.mass"] = mass
        lines.append(f"| {mass:g} kg | {100 * float(one.run().resilience):.1f} % |")
    return "\n".join(lines)


def main(folder):
    """Write the page to a folder."""
    text = (ROOT / "docs" / "structures.md").read_text("utf-8")
    for make in (plates, anvils, pendulum):
        pattern = rf"(<!-- {make.__name__} -->\n).*?(\n<!-- end -->)"
        text = re.sub(pattern, rf"\g<1>{make()}\g<2>", text, flags=re.DOTALL)
    (folder / "structures.md").write_text(text, "utf-8")


if __name__ == "__main__":
    # the page is about them
    warnings.simplefilter("ignore", vcor.ValidityWarning)
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
