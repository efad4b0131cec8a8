"""Makes data/impacts_of_*.csv: impacts of known parameters by the solver of the references.

That solver shares nothing with vcor; its numbers are good to about 1e-9.
Run by hand: python make_data.py [sls prony ...]
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


def main():
    for name in sys.argv[1:] or MATERIALS:
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
