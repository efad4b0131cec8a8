#!/usr/bin/env python3
"""Measure whole sweeps, from the start of the program to its end: time and memory over the number
of points, threads and ranks. Writes sweeps.csv into a folder.

    sweeps.py PROGRAM FOLDER [MPI_PROGRAM]

Standard library only. Run by make_document.sh. What is compared runs in turn, and the shortest of
so many runs counts: other programs on the machine only ever make one longer.
"""

import concurrent.futures
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import time

TOP = pathlib.Path(__file__).resolve().parent.parent
CASE = (TOP / "examples" / "sweeps" / "sls_velocity.nml").read_text()
RUNS = {1000: 9, 10000: 9, 100000: 9, 1000000: 4}
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


def measure(command, threads, points, files):
    """One run: seconds, seconds of CPU and megabytes of the largest process, and megabytes of the
    files."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        case = write_case(folder, points, files)
        words = [*command, "run", case, "--set", "solver.accuracy=1e-6", "--quiet"]
        environment = {**os.environ, "OMP_NUM_THREADS": str(threads)}
        start = time.perf_counter()
        process = subprocess.Popen(
            [*map(str, words), "--output", str(folder / "out")], env=environment
        )
        _, status, usage = os.wait4(process.pid, 0)
        spent = time.perf_counter() - start
        if status != 0:
            sys.exit(f"sweeps: {words} failed")
        sizes = [
            (folder / "out" / file).stat().st_size / 1e6 if (folder / "out" / file).exists() else 0.0
            for file in ("case_summary.csv", "case.h5")
        ]
        return spent, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, *sizes


def measure_all(programs, *arguments):
    """So many programs at once, each with the whole sweep: the largest of each number."""
    with concurrent.futures.ThreadPoolExecutor() as pool:
        runs = [pool.submit(measure, *arguments) for _ in range(programs)]
        return list(map(max, zip(*(run.result() for run in runs), strict=True)))


def compare(variants, points, files):
    """A row for each way to run a sweep: programs at once, ranks, threads, command."""
    found = [[] for _ in variants]
    for _ in range(RUNS[points]):
        for (programs, _, threads, command), runs in zip(variants, found, strict=True):
            runs.append(measure_all(programs, command, threads, points, files))
    rows = []
    for (programs, ranks, threads, _), runs in zip(variants, found, strict=True):
        numbers = map(min, zip(*runs, strict=True))
        rows.append([points, files, programs, ranks, threads, *numbers])
        print(*rows[-1], flush=True)
    return rows


def main():
    """Measure and write."""
    if len(sys.argv) not in {3, 4}:
        sys.exit("usage: sweeps.py PROGRAM FOLDER [MPI_PROGRAM]")
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    names = ["points", "files", "programs", "ranks", "threads"]
    names += ["seconds", "cpu", "memory", "csv", "hdf5"]
    rows = []
    for points in RUNS:
        for files in ("none", "both"):
            ways = [(1, 0, 1, [program]), (1, 0, 2, [program]), (2, 0, 1, [program])]
            rows += compare(ways, points, files)
    if len(sys.argv) == 4:
        os.environ["OMPI_ALLOW_RUN_AS_ROOT"] = os.environ["OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"
        for points in (100000, 1000000):
            for files in ("none", "both"):
                ways = [(1, n, 1, ["mpirun", "-n", n, sys.argv[3]]) for n in (1, 2)]
                rows += compare(ways, points, files)
    with open(folder / "sweeps.csv", "w", newline="") as file:
        csv.writer(file).writerows([names, *rows])


if __name__ == "__main__":
    main()
