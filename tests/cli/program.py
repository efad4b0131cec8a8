"""The program as its users see it: words in, exit code, screen and files out."""

import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
SWEEPS = sorted((ROOT / "examples" / "sweeps").glob("*.nml"))
MATERIALS = sorted((ROOT / "examples" / "materials").glob("*.nml"))
# A case that a file of vcor fit completes, docs/recipes.md
PENDULUM = ROOT / "examples" / "identification" / "pendulum.nml"
EXAMPLES = sorted(set((ROOT / "examples").glob("**/*.nml")) - {*SWEEPS, *MATERIALS, PENDULUM})
PAPER = ROOT / "examples" / "paper"

EVERYTHING = "VCOR_ALL_TESTS" in os.environ


def long_tests(*cases):
    """Cases that prove once more what others of the same test prove: of the long tests only."""
    return list(cases) if EVERYTHING else []


# Examples of each model, shape, plate, structure and method, and of data; in the long tests all of them
KINDS = """ball_on_anvil block butyl_cerf butyl_power_law_ghost butyl_prony_frozen coating_on_steel cone_into_gel
fractional_zener granular_pair pad_on_beam sls_exact sls_printed steel_on_measured_rubber superball""".split()
ONE_OF_EACH = [path for path in EXAMPLES if EVERYTHING or path.stem in KINDS]

# Exit codes
SUCCESS, USAGE, INPUT, FILE, NUMERICAL = 0, 2, 3, 4, 5

# All columns of a summary, in their order
NAMES = [
    "cor",
    "cor_sphere",
    "contact_time",
    "max_indentation",
    "max_force",
    "residual_indentation",
    "residual_ratio",
    "hysteresis_energy",
    "wave_energy",
    "energy_loss",
    "initial_energy",
    "energy_imbalance",
    "contacts",
    "last_separation",
    "structure_energy",
    "bounces",
    "bouncing_time",
    "bouncing_time_error",
    "bounces_end",
    "min_frequency",
    "inelasticity",
    "loss_tangent",
    "cor_error",
    "cor_sphere_error",
    "contact_time_error",
    "max_force_error",
    "resilience",
    "rebound_height",
    "contact_radius",
    "contact_ratio",
    "thickness_ratio",
    "layer_ratio",
    "layer_stiffening",
    "layer_strain",
    "plate_wave_number",
    "needed_extent",
    "deflection_ratio",
    "highest_mode",
    "block_reach",
    "weight_ratio",
    "mass_ratio",
    "mean_pressure",
    "axis_tension",
    "cor_deviation",
    "wave_loss",
    "peak_loss_tangent",
    "peak_storage_modulus",
    "validity",
    "validity_cause",
    "steps",
    "status",
]
ALL = ",".join(NAMES)
# Those that are whole numbers in the file of a part, and those of them that are texts elsewhere
WHOLE = {"contacts", "bounces", "bounces_end", "steps", "status", "validity", "validity_cause"}
TEXTS = WHOLE - {"contacts", "bounces", "steps"}

# What is said on stderr of the validity of bare numbers
VALIDITY = re.compile(r"^vcor: note: .*: validity.*\n", re.MULTILINE)

# Seconds after which a run counts as one that does not end, far beyond what a busy machine takes
LIMIT = 1000


def program():
    """Path of the program, which the environment has to say."""
    path = os.environ.get("VCOR")
    assert path, "the environment variable VCOR is not set, expected the path of the program"
    return str(Path(path).absolute())


@dataclass
class Done:
    """Files that a run has left."""

    code: int
    out: str
    err: str


def contents(folder):
    """All files below a folder: their bytes and when they were written."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            found[path] = (path.read_bytes(), path.stat().st_mtime_ns)
        else:
            found[path] = path.is_dir()
    return found


class Vcor:
    """The program in a folder of its own."""

    def __init__(self, folder):
        self.folder = folder

    def write(self, text, name="case.nml"):
        """Write a case file; its name, as the command line has it."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(text, bytes):
            path.write_bytes(text)
        else:
            path.write_text(text, encoding="utf-8")
        return str(name)

    def __call__(self, *words, **options):
        """Run the program."""
        options.setdefault("cwd", self.folder)
        options.setdefault("stdout", subprocess.PIPE)
        options.setdefault("timeout", LIMIT)
        if "input" not in options:
            options.setdefault("stdin", subprocess.DEVNULL)
        done = subprocess.run(
            [program(), *map(str, words)],
            stderr=subprocess.PIPE,
            encoding="utf-8",
            check=False,
            **options,
        )
        return Done(done.returncode, done.stdout or "", done.stderr)

    def succeeds(self, *words, **options):
        """Run the program, which says nothing on stderr but how valid its numbers are; what it
        prints."""
        done = self(*words, **options)
        assert (done.code, VALIDITY.sub("", done.err)) == (SUCCESS, "")
        return done.out

    def numbers(self, *words, **options):
        """All columns of the summary as text, by name."""
        values = self.succeeds("run", *words, "--print", ALL, "--quiet", **options).split()
        assert len(values) == len(NAMES)
        return dict(zip(NAMES, values, strict=True))

    def refuses(self, *words, code, says=(), at="", **options):
        """Run the program, which complains and leaves everything as it was; what it says."""
        before = contents(self.folder)
        done = self(*words, **options)
        assert done.out == ""
        line = complaint(done, code, says, at)
        assert contents(self.folder) == before
        return line


def complaint(done, code, says=(), at=""):
    """The one line of an error, without its end."""
    assert done.code == code, done.err
    assert done.err.endswith("\n")
    line = done.err[:-1]
    assert "\n" not in line
    assert line.isprintable()
    assert line.startswith(f"vcor: error: {at}: " if at else "vcor: error: ")
    assert len(line) < 500
    for word in [says] if isinstance(says, str) else says:
        assert word in line
    for word in ("backtrace", "Fortran runtime", "At line", "HDF5-DIAG"):
        assert word.lower() not in line.lower()
    return line
