"""The table of the paper's printed numbers, and runs of the program that give them again.

A run is written as in the table: the name of a case file below examples/paper, then settings
group.key=value, separated by blanks. Each distinct run is made once.
"""

import csv
import functools
import os
import re
import subprocess
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from pathlib import Path
from types import SimpleNamespace

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
CASES = ROOT / "examples" / "paper"
TABLE = HERE / "printed.csv"

# Summary columns that an expression of the table may name
COLUMNS = [
    "cor",
    "cor_sphere",
    "contact_time",
    "max_indentation",
    "max_force",
    "residual_indentation",
    "residual_ratio",
    "hysteresis_energy",
    "wave_energy",
    "initial_energy",
    "min_frequency",
    "inelasticity",
    "loss_tangent",
]

# Seconds after which a run counts as one that does not end
LIMIT = 1000


def program():
    """Path of the program, which the environment has to say."""
    path = os.environ.get("VCOR")
    assert path, "the environment variable VCOR is not set, expected the path of the program"
    return str(Path(path).absolute())


def call(run, *options):
    """Run the program on a run of the table, without a check."""
    case, *settings = run.split()
    words = [str(CASES / case)]
    for setting in settings:
        words += ["--set", setting]
    return subprocess.run(
        [program(), "run", *words, *options],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=LIMIT,
        check=False,
    )


@functools.cache
def outcome(run):
    """The summary of a run: each column of COLUMNS as an attribute."""
    done = call(run, "--print", ",".join(COLUMNS), "--quiet")
    assert (done.returncode, done.stderr) == (0, ""), f"{run}: {done.stderr}"
    return SimpleNamespace(**dict(zip(COLUMNS, map(float, done.stdout.split()), strict=True)))


def cor(run):
    """Coefficient of restitution of a run."""
    return outcome(run).cor


def named_step(line):
    """The time step [s] that the error of an unstable run names: the last number of the line."""
    return float(re.findall(r"\d+(?:\.\d*)?(?:[eE][-+]?\d+)?", line)[-1])


def half_unit(text):
    """Half a unit of the last digit of a number written in decimal; None for words."""
    try:
        return Decimal(5).scaleb(Decimal(text).as_tuple().exponent - 1)
    except InvalidOperation:
        return None


@dataclass(frozen=True)
class Row:
    """A printed number: what the paper says, and the run that says it too."""

    id: str
    quantity: str
    symbol: str
    # As the paper has it, perhaps in words
    printed: str
    # The number that is meant
    value: str
    unit: str
    place: str
    run: str
    # A second run, for ratios; empty otherwise
    other: str
    # Of summary columns in SI units, those of the second run as other.NAME; gives `unit`
    expression: str
    # What the printed digits allow: half a unit of the last one
    tolerance: str
    # yes or no: whether the run gives the printed digits
    reproduced: str
    # What converged runs give
    converged: str
    converged_run: str
    converged_other: str
    remark: str

    def evaluate(self, run, other):
        """The expression with one run, or two."""
        names = dict(vars(outcome(run)))
        if other:
            names["other"] = outcome(other)
        return eval(self.expression, {"__builtins__": {}}, names)

    def computed(self):
        """What the row's run gives."""
        return self.evaluate(self.run, self.other)

    def computed_converged(self):
        """What the converged runs give."""
        return self.evaluate(self.converged_run, self.converged_other)

    def agrees(self):
        """Whether the run gives the printed digits."""
        return abs(self.computed() - float(self.value)) <= float(self.tolerance)

    def decimals(self):
        """Decimals that show one digit more than is printed."""
        return max(0, 1 - Decimal(self.tolerance).normalize().adjusted() - 1)


def read_table():
    """All rows."""
    with TABLE.open(newline="", encoding="utf-8") as file:
        return [Row(**line) for line in csv.DictReader(file)]
