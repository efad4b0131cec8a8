"""The job scripts of docs/sweeps.md, with what Slurm would do."""

import os
import subprocess

import pytest
from cases import SLS
from long_sweep import same_files
from program import ROOT, program

SWEEP = "&sweep\n   parameter = 'impact.velocity'\n   start = 1\n   stop = 9\n   count = 50\n/\n"


@pytest.fixture
def place(vcor):
    """A folder with a case, its results in the folder ref, and the commands of a cluster."""
    vcor.write(SLS + SWEEP)
    vcor.succeeds("run", "case.nml", "--output", "ref")
    commands = vcor.folder / "bin"
    commands.mkdir()
    (commands / "vcor").symlink_to(program())
    srun = commands / "srun"
    srun.write_text('#!/bin/sh\nwhile [ "${1#--}" != "$1" ]; do shift; done\nexec "$@"\n')
    srun.chmod(0o755)
    return vcor


def block_with(word):
    blocks = (ROOT / "docs" / "sweeps.md").read_text(encoding="utf-8").split("```sh\n")[1:]
    return next(block for block in blocks if word in block).split("```")[0]


def submit(place, word, **variables):
    script = place.folder / "job.sh"
    script.write_text(block_with(word))
    environment = {
        **os.environ,
        "PATH": f"{place.folder / 'bin'}{os.pathsep}{os.environ['PATH']}",
        "SLURM_CPUS_PER_TASK": "2",
        **{f"SLURM_{name}": str(value) for name, value in variables.items()},
    }
    done = subprocess.run(
        ["bash", "-eu", script],
        cwd=place.folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_job_of_ranks(place):
    assert "50 impacts" in submit(place, "--job-name=sweep")
    same_files(place.folder / "results", place.folder / "ref")
    assert "50 impacts" in submit(place, "--job-name=sweep")
    same_files(place.folder / "results", place.folder / "ref")
