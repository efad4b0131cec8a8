#!/usr/bin/env python3
"""Measure whole sweeps, from the start of the program to its end: time and memory over the number
of points, threads and ranks. Writes sweeps.csv into a folder.

    sweeps.py PROGRAM FOLDER [MPI_PROGRAM]

Standard library only. Run by make_document.sh; the median of so many runs counts, by the clock on
the wall: the machine has to be quiet.
"""

import csv
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parent.parent
CASE = (TOP / "examples" / "sweeps" / "sls_velocity.nml").read_text()
RUNS = {1000: 9, 10000: 9, 100000: 7, 1000000: 3}
FILES = {"none": (False, False), "csv": (True, False), "hdf5": (False, True), "both": (True, True)}


def write_case(folder, points, files):
    """The velocity sweep with so many points; its name."""
    text = CASE.replace("count = 50", f"count = {points}")
    assert text != CASE
    yes = [f".{str(flag).lower()}." for flag in FILES[files]]
    text += f"&output csv = {yes[0]}, hdf5 = {yes[1]} /\n"
    path = folder / "case.nml"
    path.write_text(text)
    return path


def measure(command, points, files):
    """Seconds, seconds of CPU and megabytes of the largest process, and megabytes of the files."""
    found = []
    for _ in range(RUNS[points]):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            case = write_case(folder, points, files)
            words = [*command, "run", case, "--set", "solver.accuracy=1e-6", "--quiet"]
            start = time.perf_counter()
            process = subprocess.Popen([*map(str, words), "--output", str(folder / "out")])
            _, status, usage = os.wait4(process.pid, 0)
            spent = time.perf_counter() - start
            if status != 0:
                sys.exit(f"sweeps: {words} failed")
            sizes = [
                (folder / "out" / file).stat().st_size / 1e6
                if (folder / "out" / file).exists() else 0.0
                for file in ("case_summary.csv", "case.h5")
            ]
            cpu = usage.ru_utime + usage.ru_stime
            found.append((spent, cpu, usage.ru_maxrss / 1024, *sizes))
    return [statistics.median(column) for column in zip(*found, strict=True)]


def main():
    """Measure and write."""
    if len(sys.argv) not in {3, 4}:
        sys.exit("usage: sweeps.py PROGRAM FOLDER [MPI_PROGRAM]")
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    names = ["points", "files", "ranks", "threads", "seconds", "cpu", "memory", "csv", "hdf5"]
    rows = []
    for points in RUNS:
        for threads in (1, 2):
            for files in ("none", "both"):
                os.environ["OMP_NUM_THREADS"] = str(threads)
                found = measure([program], points, files)
                rows.append([points, files, 0, threads, *found])
                print(*rows[-1], flush=True)
    if len(sys.argv) == 4:
        os.environ["OMP_NUM_THREADS"] = "1"
        os.environ["OMPI_ALLOW_RUN_AS_ROOT"] = os.environ["OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"
        for points in (100000, 1000000):
            for ranks in (1, 2):
                for files in ("none", "both"):
                    command = ["mpirun", "-n", ranks, sys.argv[3]]
                    rows.append([points, files, ranks, 1, *measure(command, points, files)])
                    print(*rows[-1], flush=True)
    with open(folder / "sweeps.csv", "w", newline="") as file:
        csv.writer(file).writerows([names, *rows])


if __name__ == "__main__":
    main()
