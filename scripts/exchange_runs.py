#!/usr/bin/env python3
"""Runs what vcor export writes in the programs themselves, and compares e and contact times.

    scripts/exchange_runs.py PROGRAM [COMMAND ...]

PROGRAM is lammps, liggghts or yade. COMMAND runs it, {file} and {v} are the input and the velocity; by
default the usual one. Prints the rows of the table in docs/exchange.md. Needs the Python package.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import vcor

COMMANDS = {
    "lammps": ["lmp", "-log", "none", "-in", "{file}", "-var", "v", "{v}"],
    "liggghts": ["liggghts", "-log", "none", "-in", "{file}", "-var", "v", "{v}"],
    "yade": ["yade", "-n", "-x", "{file}", "{v}"],
}
SAID = re.compile(r"e = ([\d.e+-]+), contact time ([\d.e+-]+) s")
VELOCITIES = np.geomspace(0.05, 5, 5)
RUBBER = {"name": "rubber", "model": "sls", "glassy_modulus": 1.5e7, "alpha": 300.0, "beta": 1200.0,
          "density": 1200.0, "poisson_ratio": 0.48}
STEEL = {"name": "steel", "model": "elastic", "modulus": 2e11, "density": 7800.0, "poisson_ratio": 0.3}
CASES = {
    "equal beads": vcor.pair(RUBBER, (0.005, 0.005)),
    "unequal beads": vcor.pair(RUBBER, (0.005, 0.003)),
    "bead and wall": vcor.pair([RUBBER, STEEL], (0.005,)),
}


def main():
    program, *command = sys.argv[1:]
    command = command or COMMANDS[program]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "input.py"
        for name, case in CASES.items():
            options = vcor.export(case, program, VELOCITIES).options
            for law, (text, twin) in enumerate(options.items(), 1):
                path.write_text(str(vcor.export(case, program, VELOCITIES, law=law)))
                found = []
                for v in VELOCITIES:
                    words = [word.format(file=path, v=f"{v:.12g}") for word in command]
                    done = subprocess.run(words, cwd=folder, capture_output=True,
                                          encoding="utf-8", errors="replace")
                    if not (said := SAID.search(done.stdout)):
                        sys.exit(f"{' '.join(words)}: {(done.stdout + done.stderr)[-500:]}")
                    found.append([float(number) for number in said.groups()])
                e, time = np.array(found).T
                label = re.sub(r"\b\d[\d.e+]{4,}", "...", text)
                print(f"| {program} | {name} | `{label}` | {np.abs(e - twin.cor[::2]).max():.1e} | "
                      f"{100 * np.abs(time / twin.time[::2] - 1).max():.1f} % |", flush=True)


if __name__ == "__main__":
    main()
