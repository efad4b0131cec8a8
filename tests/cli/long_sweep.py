"""A sweep that takes a while, whatever the build: long enough to be interrupted."""

import os
import resource
import signal
import subprocess
import time
from pathlib import Path

from cases import SLS, edit
from program import FILE, NUMERICAL, SUCCESS, contents, program

PART = "case.part"
FILES = ["case.h5", "case_summary.csv"]
# Points per second of CPU time on one core by the text of a sweep, once it has been measured
PACE = {}


def sweep_text(count):
    """A map over velocity and radius; a tenth of the radii is below zero. A point takes as long as ten of method ive,
    so that a long sweep has small files. Of two spheres, whose exact mechanics, which the screen has, take no time."""
    text, _ = edit(SLS, "solver", "accuracy", "1e-6")
    text, _ = edit(text, "solver", "method", "'direct'")
    text, _ = edit(text, "sphere", "mass", "0.03")
    text = text.replace("half_thickness = 0.02", "waves = 'none', surface_radius = 0.05")
    return text + (
        "&sweep\n   parameter = 'impact.velocity'\n   start = 1.0\n   stop = 50.0\n"
        f"   count = {max(2, count // 10)}\n/\n"
        "&sweep\n   parameter = 'sphere.radius'\n   start = -0.002\n   stop = 0.02\n"
        "   count = 10\n/\n"
    )


def write_long_sweep(vcor, seconds, text_of=sweep_text):
    """A case that takes so long on one core: by its CPU time, whatever else the machine is at. `text_of` gives the case
    for a number of points."""
    if text_of not in PACE:
        points = 10
        while True:
            vcor.write(text_of(points))
            start = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            done = vcor("run", "case.nml", "--print", "cor", "--threads", "1")
            spent = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - start
            assert done.code in (SUCCESS, NUMERICAL)
            if spent > 0.2:
                break
            points *= 3
        PACE[text_of] = points / spent
    vcor.write(text_of(int(seconds * PACE[text_of])))


def begin(vcor, *words, folder="out", **options):
    """Start a run: on one thread, so that it takes as long on any number of cores."""
    options.setdefault("stdout", subprocess.PIPE)
    options.setdefault("stderr", subprocess.PIPE)
    return subprocess.Popen(
        [program(), "run", "case.nml", "--output", folder, "--threads", "1", *words],
        cwd=vcor.folder,
        encoding="utf-8",
        **options,
    )


def wait_for(path, process):
    """Wait until there is a file."""
    while not path.exists():
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)


def done_in(path):
    """Number of complete lines of points."""
    return max(0, path.read_bytes().count(b"\n") - 1)


def stopped_at(vcor, size, folder="out"):
    """Run until the file of points would grow beyond this size [byte], which no time decides; the
    file, which ends within a line."""

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    process = begin(vcor, folder=folder, preexec_fn=limit)
    _, said = process.communicate()
    assert process.returncode == FILE, said
    part = vcor.folder / folder / PART
    assert part.stat().st_size == size
    return part


def interrupted(vcor, number=signal.SIGKILL, folder="out", *words):
    """Run, wait until there is something to resume, and send a signal; what the run said."""
    process = begin(vcor, *words, folder=folder)
    part = vcor.folder / folder / PART
    wait_for(part, process)
    while done_in(part) < 5:
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    os.kill(process.pid, number)
    out, err = process.communicate(timeout=600)
    return process.returncode, out, err


def same_files(one: Path, other: Path, names=FILES):
    """Both folders hold these files and nothing else, byte for byte."""
    assert {path.name for path in contents(one)} == set(names)
    for name in names:
        assert (one / name).read_bytes() == (other / name).read_bytes(), name
