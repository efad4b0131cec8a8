"""Fig. 8 of the paper: COR of BUTYL-B252 against velocity, three models of the same rubber.

Writes the cases with f90nml, solves them in one call of vcor and reads the summaries with pandas.
Needs vcor in the PATH.
"""

import pathlib
import subprocess
import sys

import f90nml
import pandas as pd

here = pathlib.Path(__file__).parent
work = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else "fig8")
work.mkdir(exist_ok=True)

files = []
for model in ("prony", "cerf", "power_law"):
    case = f90nml.read(here / f"butyl_{model}_velocity.nml")
    case["sweep"] = {"parameter": "impact.velocity", "values": [1, 2, 5, 10, 20, 35, 50]}
    case["solver"] = {"accuracy": 1e-6}
    files.append(work / f"{model}.nml")
    case.write(files[-1], force=True)

subprocess.run(["vcor", "run", "--quiet", "--output", work, *files], check=True)
table = pd.concat(
    {
        file.stem: pd.read_csv(
            file.with_name(f"{file.stem}_summary.csv"), comment="#", index_col="impact.velocity"
        )["cor"]
        for file in files
    },
    axis="columns",
)
print(table)
