"""Makes data/impacts_of_*.csv: impacts of known parameters by the solver of the references.

That solver shares nothing with vcor; its numbers are good to about 1e-9.
Run by hand: python make_data.py [sls prony ...]; block prints examples/identification/block.csv
"""

import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "reference"))

import impact_solver  # noqa: E402
import make_impacts  # noqa: E402

MATERIALS = {
    "sls": "model = 'sls', glassy_modulus = 1.5e7, alpha = 300, beta = 1200",
    "prony": "model = 'prony', equilibrium_modulus = 3e6, moduli = 6e6, 4e6, times = 2e-4, 2e-3",
    "power_law": "model = 'power_law', equilibrium_modulus = 2e6, coefficient = 1e5, "
    "exponent = 0.5",
    "mittag_leffler": "model = 'mittag_leffler', equilibrium_modulus = 2e6, "
    "relaxing_modulus = 1e7, exponent = 0.6, time = 1e-3",
}
# where the solver of the references does not take the other
LAWS = {"mittag_leffler": "boltzmann"}
CASE = """&impact velocity = {velocity} /
&sphere radius = 0.01, material = 'steel' /
&plate half_thickness = 0.02, material = 'rubber', waves = 'none' /
&contact law = '{law}' /
&material name = 'steel', model = 'rigid', density = 7800 /
&material name = 'rubber', density = 1100, poisson_ratio = 0.45, {material} /
"""


def block():
    """Impacts of examples/identification: three temperatures, shifted by hand, 1 % of noise."""
    rng = np.random.default_rng(1)
    for celsius in (20, 40, 60):
        factor = 10 ** (-12 * (celsius - 20) / (80 + celsius - 20))
        material = "model = 'mittag_leffler', equilibrium_modulus = 1e6, relaxing_modulus = 1e9, "
        material += f"exponent = 0.4, time = {factor!r}"
        for velocity in (1.0, 3.0, 10.0):
            text = CASE.format(velocity=velocity, material=material, law="boltzmann")
            out, _ = impact_solver.solve(make_impacts.case_of(text.replace("0.45", "0.4")))
            cor, time = (out[name] * (1 + 0.01 * rng.normal()) for name in ("cor", "contact_time"))
            print(f"{velocity},{celsius},{cor:.5f},{cor / 100:.4f},{1e3 * time:.5g}", end="")
            print(f",{10 * time:.3g}", flush=True)


def main():
    for name in sys.argv[1:] or MATERIALS:
        if name == "block":
            block()
            continue
        material, rows = MATERIALS[name], []
        for velocity in np.geomspace(0.3, 20, 10):
            text = CASE.format(velocity=velocity, material=material, law=LAWS.get(name, "receding"))
            out, _ = impact_solver.solve(make_impacts.case_of(text))
            rows.append((velocity, out["cor"], out["contact_time"]))
            print(name, rows[-1], flush=True)
        path = Path(__file__).parent / "data" / f"impacts_of_{name}.csv"
        with path.open("w", encoding="utf-8") as file:
            file.write(f"# {material}\n# by tests/reference/impact_solver.py: see make_data.py\n")
            file.write("velocity [m/s],cor,contact_time [s]\n")
            for row in rows:
                file.write(",".join(f"{value:.12g}" for value in row) + "\n")


if __name__ == "__main__":
    main()
