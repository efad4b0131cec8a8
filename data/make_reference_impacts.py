"""Write data/reference_impacts.json: 40 impacts for others to test their solvers against.

    python data/make_reference_impacts.py [FILE]

Needs the Python package of vcor and f90nml. The values of the first 34 are those of programs that share nothing with
vcor (tests/reference); vcor solves each again, and the file says how far it is off. The last six are solved by vcor and
compared with finite elements, whose numbers the head of tests/reference/coupled_elements.py has.
"""

import csv
import io
import json
import re
import sys
import warnings
from pathlib import Path

import f90nml

import vcor

ROOT = Path(__file__).resolve().parent.parent
REFERENCE = ROOT / "tests/reference"
UNITS = {
    "cor": "1", "cor_sphere": "1", "contact_time": "s", "max_indentation": "m", "max_force": "N",
    "residual_indentation": "m", "hysteresis_energy": "J", "wave_energy": "J", "initial_energy": "J",
    "contact_radius": "m",
}  # fmt: skip
#: Number to which the error of a quantity is relative
SCALES = {
    "cor": 1.0, "cor_sphere": 1.0, "residual_indentation": "max_indentation",
    "hysteresis_energy": "initial_energy", "wave_energy": "initial_energy",
}  # fmt: skip
COLLOCATION = "spectral collocation of the Volterra equation in sqrt(t), tests/reference/impact_solver.py"
FREDHOLM = "Fredholm equation of the layer and the impact with its law, tests/reference/make_layers.py"
COUPLED = "method coupled of vcor: convolution quadrature of contact and waves, extrapolated"
ELEMENTS = "explicit finite elements, extrapolated over the mesh, tests/reference/coupled_elements.py"
#: Rows of reference.csv
PAPER = (
    "elastic_half_space_v0.001", "elastic_lambda0.05", "elastic_lambda0.2", "elastic_lambda1.0", "elastic_steel_on_glass",
    "sls_v1", "sls_v10", "sls_plate_none_v10", "sls_plate_constant_v10", "butyl_prony_v10", "butyl_cerf_v10",
    "butyl_power_law_v10", "power_law_a0.5", "kelvin_voigt_sphere", "two_sls", "rubber_on_butyl_prony",
)  # fmt: skip
#: Numbers of impacts in designed.txt
THIN = (2, 10, 30, 33, 37, 41, 45, 49, 53, 67)
#: Places in layers.json
LAYERS = (0, 1, 2, 4, 6, 7, 8, 12)
GLASS = (
    "&material name = 'plate', model = 'elastic', density = 2500.0, poisson_ratio = 0.22, modulus = 70.0e9 /"
)
RUBBER = (
    "&material name = 'plate', model = 'sls', density = 1100.0, poisson_ratio = 0.48, "
    "glassy_modulus = 15.0e6, alpha = 300.0, beta = 1200.0 /"
)
#: Name, velocity, radius, keys of the plate, material, and cor_sphere by finite elements
WAVES = (
    ("steel on 4 mm of glass", 1.0, 0.002, "thickness = 0.004", GLASS, 0.82699),
    ("steel on 2 mm of glass", 1.0, 0.002, "thickness = 0.002", GLASS, 0.49167),
    ("steel on 40 mm of rubber", 10.0, 0.01, "thickness = 0.04", RUBBER, 0.38016),
    ("steel on 20 mm of rubber", 5.0, 0.01, "thickness = 0.02", RUBBER, 0.09511),
    ("steel on 10 mm of bonded rubber", 2.0, 0.01, "thickness = 0.01, base = 'bonded'", RUBBER, 0.60743),
    ("steel on 10 mm of sliding rubber", 2.0, 0.01, "thickness = 0.01, base = 'sliding'", RUBBER, 0.58139),
)


def inputs(text):
    """Groups and keys of a case."""
    groups = f90nml.reads(text).todict()
    return {name: groups[name] for name in groups if name not in ("case", "solver")}


def difference(one, other, names):
    """The largest difference of these quantities, each relative to its scale."""
    found = 0.0
    for name in names:
        scale = SCALES.get(name, name)
        size = scale if isinstance(scale, float) else one[scale]
        found = max(found, abs(other[name] - one[name]) / (abs(size) or 1.0))
    return float(f"{found:.1e}")


def entry(kind, name, text, values, error, method):
    """An impact whose values are given, solved again by vcor."""
    case = vcor.Case(text)
    case["solver.method"], case["solver.accuracy"] = "ive", 1e-11
    found = case.solve({}, list(values))
    first = [key for key in values if key in ("cor", "cor_sphere")]
    return {
        "name": name, "mechanics": kind, "inputs": inputs(text), "case": text,
        "results": {key: {"value": value, "unit": UNITS[key]} for key, value in values.items()},
        "error": error, "method": method,
        "second": {
            "method": "method ive of vcor: internal variables, accuracy 1e-11",
            "difference_of_cor": difference(values, found, first),
            "largest_difference": difference(values, found, values),
        },
    }  # fmt: skip


def paper():
    """The paper's mechanics: Boltzmann's force, Eq. (1), thin plates."""
    rows = {row["name"]: row for row in csv.DictReader((REFERENCE / "reference.csv").open())}
    names = [name for name in UNITS if name != "contact_radius"]
    for name in PAPER:
        text = (REFERENCE / "cases" / f"{name}.nml").read_text("utf-8")
        values = {key: float(rows[name][key]) for key in names}
        yield entry("paper", name, text, values, 10.0 ** -min(12, int(rows[name]["digits"])), COLLOCATION)


def thin():
    """Receding contact, bodies in series, no plate or a thin one by the correspondence principle."""
    text = (REFERENCE / "designed.txt").read_text("utf-8")
    impacts = re.findall(r"^! impact (\d+) (.*)\n! expect (.*)\n((?:[&\s].*\n?)*)", text, re.M)
    for number, remark, expected, case in impacts:
        if int(number) in THIN:
            values = dict(zip(UNITS, map(float, expected.split()), strict=False))
            yield entry("exact, thin plate", f"{remark}, {number}", case, values, 1e-11, COLLOCATION)


def layers():
    """Layers on a rigid floor, at rest in every moment."""
    rows = json.loads((REFERENCE / "layers.json").read_text("utf-8"))
    for number in LAYERS:
        one = rows[number]["case"]
        made = io.StringIO()
        keys = {
            "impact": ("velocity", "gravity"),
            "sphere": ("shape", "radius", "mass", "half_angle", "profile_power", "profile_coefficient"),
            "plate": ("base", "thickness"),
            "contact": ("law",),
        }
        more = {"sphere": "material = 'body'", "plate": "material = 'layer', waves = 'none'"}
        for group, names in keys.items():
            words = [f"{name} = {one[name]!r}" for name in names if name in one]
            made.write(f"&{group} {', '.join(filter(None, [*words, more.get(group, '')]))} /\n")
        made.write("&material name = 'body', model = 'rigid' /\n&material name = 'layer', model = 'prony'")
        for name in ("poisson_ratio", "equilibrium_modulus"):
            made.write(f", {name} = {one[name]!r}")
        for name in ("moduli", "rates"):
            made.write(f", {name} = {', '.join(map(repr, one[name]))}")
        made.write(" /\n")
        name = f"{one['shape']} on a {one['base']} layer, {one['law']}"
        yield entry("layer", name, made.getvalue(), rows[number]["expect"], 1e-11, FREDHOLM)


def waves():
    """Contact and waves together."""
    for name, velocity, radius, plate, material, elements in WAVES:
        text = (
            f"&impact velocity = {velocity} /\n&sphere radius = {radius}, material = 'ball' /\n"
            f"&plate {plate}, material = 'plate', waves = 'body' /\n"
            f"&material name = 'ball', model = 'rigid', density = 7800.0 /\n{material}\n"
        )
        case = vcor.Case(text)
        case["solver.accuracy"] = 5e-7
        # no second method has the digits of a contact time with waves
        errors = {"cor_sphere": "cor_sphere_error", "max_force": "max_force_error"}
        found = case.solve({}, [*errors, *errors.values()])
        yield {
            "name": name, "mechanics": "exact", "inputs": inputs(text), "case": text,
            "results": {
                key: {"value": float(f"{found[key]:.7g}"), "unit": UNITS[key], "error": float(f"{found[error]:.1e}")}
                for key, error in errors.items()
            },
            "error": float(f"{found['cor_sphere_error']:.1e}"), "method": COUPLED,
            "second": {
                "method": ELEMENTS, "cor_sphere": elements,
                "difference_of_cor": float(f"{abs(found['cor_sphere'] - elements):.1e}"),
            },
        }  # fmt: skip


def main():
    """Write the file."""
    warnings.simplefilter("ignore", vcor.ValidityWarning)
    made = {
        "about": "Impacts of a body on a plate, half space, layer or sphere, linear and without friction, SI units. "
        "docs/reproducing_the_paper.md explains every field.",
        "version": vcor.__version__,
        "impacts": [*paper(), *thin(), *layers(), *waves()],
    }
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "data/reference_impacts.json"
    path.write_text(json.dumps(made, indent=1, ensure_ascii=False) + "\n", "utf-8")


if __name__ == "__main__":
    main()
