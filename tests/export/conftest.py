"""One run of the program, whose files all tests of this folder read."""

import os
import subprocess
from pathlib import Path

import pytest

CASE = Path(__file__).parents[2] / "examples" / "paper" / "sls.nml"


@pytest.fixture(scope="session")
def vcor():
    """Path of the program, from the environment."""
    program = os.environ.get("VCOR")
    if not program:
        pytest.fail("the environment variable VCOR is not set, expected the path of the program")
    return program


@pytest.fixture(scope="session")
def run(vcor):
    """Run the program on the example and write to a folder."""

    def call(folder, **options):
        return subprocess.run(
            [vcor, "run", str(CASE), "--output", str(folder)],
            capture_output=True,
            text=True,
            timeout=600,
            **options,
        )

    return call


@pytest.fixture(scope="session")
def folder(run, tmp_path_factory):
    """Folder with the files of one run; its name has a blank and letters beyond ASCII."""
    folder = tmp_path_factory.mktemp("out") / "Stoß α"
    done = run(folder)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="session")
def summary_csv(folder):
    return folder / "sls_summary.csv"


@pytest.fixture(scope="session")
def history_csv(folder):
    return folder / "sls.csv"


@pytest.fixture(scope="session")
def hdf5(folder):
    return folder / "sls.h5"
