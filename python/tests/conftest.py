"""What the tests of the package share: the program to compare with, and cases."""

import os
import subprocess
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# The same examples in each run, and nothing written beside the sources
settings.register_profile("vcor", deadline=None, database=None, derandomize=True,
                          suppress_health_check=list(HealthCheck))  # fmt: skip
settings.load_profile("vcor")

ROOT = Path(__file__).parents[2]
PAPER = ROOT / "examples" / "paper"
SWEEPS = ROOT / "examples" / "sweeps"


@pytest.fixture
def program(tmp_path):
    """Run the program in an empty folder; its exit code, output and line of error."""

    def run(*words, code=0):
        done = subprocess.run(
            [os.environ["VCOR"], *map(str, words)],
            cwd=tmp_path,
            capture_output=True,
            encoding="utf-8",
            check=False,
        )
        assert done.returncode == code, done.stderr
        return done.stdout if code == 0 else done.stderr

    return run


@pytest.fixture
def sls():
    """The SLS case of the paper."""
    import vcor

    return vcor.read(PAPER / "sls.nml")
