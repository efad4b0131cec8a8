"""Reference impacts at temperatures: temperature.txt, which tests/unit/test_impacts.f90 reads.

The case has the shift and the temperature; what is expected of it comes from impact_solver.py, which
has no temperature: here the constants of each model are shifted by hand, times by a_T and moduli
by b_T. Between the points of a table log10 a_T is scipy's PchipInterpolator, after F. N. Fritsch and
J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984) 300.

Usage:  make_temperature.py [--output DIR]           writes temperature.txt and shift.csv
"""

import argparse
import math
import os
import pathlib
from concurrent.futures import ProcessPoolExecutor

os.environ.setdefault("OMP_NUM_THREADS", "1")    # the impacts run in parallel, not the matrices

from scipy.interpolate import PchipInterpolator

from impact_solver import solve
from make_impacts import (CERF, EXPECT, FLUID, HERE, LAWS, LEFFLER, LEFFLER_BALL, PLATES, POWER,
                          PRONY, RIGID, SLS, SOFT, SOFT_SLS, VISCOUS, VOIGT, entry, head, impact,
                          text_of)

GAS_CONSTANT = 8.31446261815324
# log10 a_T over degrees Celsius, as a laboratory has it
SHIFTS = {-40.0: 9.41, -25.0: 6.02, -10.0: 3.71, 0.0: 2.49, 10.0: 1.42, 25.0: 0.0, 40.0: -1.06,
          60.0: -2.13, 90.0: -3.2}

WLF = dict(shift="wlf", reference_temperature=298.15, wlf_c1=8.86, wlf_c2=101.6)
GLASSY = dict(shift="wlf", reference_temperature=210.0, wlf_c1=16.2, wlf_c2=53.6)
ARRHENIUS = dict(shift="arrhenius", reference_temperature=293.15, activation_energy=8.5e4)
TABLE = dict(shift="table", reference_temperature=298.15, shift_file="shift.csv")


def factors(law, temperature):
    """a_T and b_T."""
    reference = law["reference_temperature"]
    vertical = temperature / reference if law.get("vertical_shift") else 1.0
    if law["shift"] == "wlf":
        distance = temperature - reference
        return 10 ** (-law["wlf_c1"] * distance / (law["wlf_c2"] + distance)), vertical
    if law["shift"] == "arrhenius":
        exponent = law["activation_energy"] / GAS_CONSTANT * (1 / temperature - 1 / reference)
        return math.exp(exponent), vertical
    decades = PchipInterpolator([t + 273.15 for t in SHIFTS], list(SHIFTS.values()))
    return 10 ** float(decades(temperature) - decades(reference)), vertical


def at(material, law, temperature):
    """The material with the constants that it has at the temperature."""
    a, b = factors(law, temperature)
    powers = dict(
        glassy_modulus=b, equilibrium_modulus=b, relaxing_modulus=b, moduli=b, viscosity=a * b,
        coefficient=b * a ** material.get("exponent", 0), time=a, times=a, rates=1 / a,
        alpha=1 / a, beta=a ** -0.5 if material["model"] == "cerf" else 1 / a)
    def scaled(key, value):
        if key not in powers:
            return value
        return [x * powers[key] for x in value] if isinstance(value, list) else value * powers[key]
    return {key: scaled(key, value) for key, value in material.items()}


def shear(material):
    """The material with shear moduli, said to be such."""
    factor = 2 * (1 + material["poisson_ratio"])
    keys = ("glassy_modulus", "equilibrium_modulus", "relaxing_modulus", "moduli", "viscosity",
            "coefficient", "modulus")
    out = dict(material, modulus_kind="shear")
    for key in keys:
        if key in out:
            value = out[key]
            out[key] = [x / factor for x in value] if isinstance(value, list) else value / factor
    return out


def cases():
    """Remark, temperature, laws by the names of materials, and the case at the reference."""
    number = 0
    laws = (WLF, ARRHENIUS, TABLE)
    temperatures = (283.0, 305.0, 318.15)
    for material in (SLS, PRONY, POWER, CERF, LEFFLER, VISCOUS, VOIGT):
        for i, law in enumerate(laws):
            waves, contact = PLATES[number % 5], LAWS[number % 2]
            number += 1
            yield (f"{material['model']}, {law['shift']}, {waves}, {contact}",
                   temperatures[(number + i) % 3], {"plate": law},
                   impact((RIGID, material), waves, contact, velocity=3.0))
    pairs = ((SOFT_SLS, PRONY), (LEFFLER_BALL, SLS), (SOFT_SLS, POWER), (SOFT, CERF))
    for i, pair in enumerate(pairs):
        for rule in ("eq1", "series"):
            both = {"plate": laws[i % 3], "ball": laws[(i + 1) % 3]}
            if pair[0] is SOFT:
                both = {"plate": dict(WLF, vertical_shift=True)}
            yield (f"two bodies, {rule}", 303.15, both,
                   impact(pair, PLATES[i], LAWS[i % 2], rule, velocity=1.5))
    yield ("one material", 290.0, {"plate": dict(ARRHENIUS, vertical_shift=True)},
           impact((CERF,), "relaxing", "receding"))
    yield ("far above the reference", 240.0, {"plate": GLASSY},
           impact((RIGID, dict(CERF, beta=1e-2)), "hereditary", "receding"))
    yield ("a fluid ball that is cold", 275.0, {"ball": WLF},
           impact((FLUID, CERF), "none", "boltzmann", "series"))
    for material in (PRONY, POWER, LEFFLER):
        yield (f"shear moduli, {material['model']}", 308.15,
               {"plate": dict(WLF, vertical_shift=True)},
               impact((SOFT_SLS if material is PRONY else RIGID, material), "relaxing",
                      "boltzmann", "series"))


def solved_entry(numbered):
    """Text of an impact of the set, and a line for the screen."""
    number, (note, temperature, laws, case) = numbered
    written, solved = [], []
    for material in case["materials"]:
        law = laws.get(material["name"])
        solved.append(at(material, law, temperature) if law else material)
        known = shear(material) if note.startswith("shear") and law else material
        written.append({**known, **(law or {})})
    text = text_of(dict(case, materials=written))
    text = text.replace("vertical_shift = 1.0", "vertical_shift = .true.")
    text = text.replace("&impact ", f"&impact temperature = {temperature!r}, ", 1)
    outcome, error = solve(dict(case, materials=solved))
    return entry(f"{number} {note}", text, outcome), (
        f"{number:4d} {note:45s} cor {outcome['cor']:.12f}  two meshes {error:.1e}  imbalance "
        f"{outcome['energy_imbalance']:.1e}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", default=HERE, type=pathlib.Path)
    options = parser.parse_args()
    rows = "".join(f"{t!r}, {log!r}\n" for t, log in SHIFTS.items())
    (options.output / "shift.csv").write_text("T [C], log10_aT\n" + rows, encoding="utf-8")
    out = head("Impacts at temperatures, made by make_temperature.py.",
               "Expected: " + ", ".join(EXPECT))
    with ProcessPoolExecutor() as pool:
        for text, line in pool.map(solved_entry, enumerate(cases(), 1)):
            out += text
            print(line, flush=True)
    (options.output / "temperature.txt").write_text(out, encoding="utf-8")


if __name__ == "__main__":
    main()
