"""Damaged HDF5 files: whatever is wrong with one, the program ends with one line or with the right
results.

The test runs a few of these trials. By hand, for many:

    VCOR=build/release/vcor python tests/cli/damage.py --count 20000 --seed 1
"""

import argparse
import random
import resource
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy
from cases import SLS, edit
from program import FILE, INPUT, LIMIT, NUMERICAL, SUCCESS, Vcor, program

# What a run may take: it needs 10 ms and 50 MB
CPU_SECONDS = 30
ADDRESS_SPACE = 2 << 30

SWEEP = (
    "&sweep\n   parameter = 'impact.velocity'\n   start = 1.0\n   stop = 9.0\n   count = 9\n/\n"
    "&sweep\n   parameter = 'sphere.radius'\n   values = -0.01, 0.0, 0.005, 0.01\n/\n"
)
SHARDS = ["out/case_shard_1_of_2.h5", "out/case_shard_2_of_2.h5"]


@dataclass
class Target:
    """A command that reads a file."""

    words: list  # after the name of the program
    damaged: str  # the file
    inputs: list  # all files that have to be there
    results: list  # files that are there in the end, as they should be


TARGETS = {
    "resume a finished sweep": Target(
        ["run", "case.nml", "--output", "out", "--resume"],
        "out/case.h5",
        ["case.nml", "out/case.h5", "out/case_summary.csv"],
        ["out/case.h5", "out/case_summary.csv"],
    ),
    "resume a finished impact": Target(
        ["run", "one.nml", "--output", "out", "--resume"],
        "out/one.h5",
        ["one.nml", "out/one.h5", "out/one.csv", "out/one_summary.csv"],
        ["out/one.h5"],
    ),
    "resume an unfinished sweep": Target(
        ["run", "case.nml", "--output", "out", "--resume"],
        "out/case.part.h5",
        ["case.nml", "out/case.part.h5"],
        ["out/case.h5", "out/case_summary.csv"],
    ),
    "begin an unfinished sweep anew": Target(
        ["run", "case.nml", "--output", "out"],
        "out/case.part.h5",
        ["case.nml", "out/case.part.h5"],
        ["out/case.h5", "out/case_summary.csv"],
    ),
    "resume a finished shard": Target(
        ["run", "case.nml", "--output", "out", "--resume", "--shard", "1/2"],
        SHARDS[0],
        ["case.nml", SHARDS[0]],
        SHARDS[:1],
    ),
    "merge": Target(
        ["merge", *SHARDS, "--output", "out"],
        SHARDS[1],
        SHARDS,
        ["out/case.h5", "out/case_summary.csv"],
    ),
}


def make_files(folder):
    """All files of all targets, undamaged."""
    vcor = Vcor(folder)
    case, _ = edit(SLS, "solver", "accuracy", "1e-6")
    vcor.write(case, "one.nml")
    vcor.succeeds("run", "one.nml", "--output", "out")
    vcor.write(case + SWEEP, "case.nml")
    assert vcor("run", "case.nml", "--output", "out").code == NUMERICAL
    for number in (1, 2):
        done = vcor("run", "case.nml", "--output", "out", "--shard", f"{number}/2")
        assert done.code == NUMERICAL
    # one shard is all of a sweep, and its file that of an unfinished one: take points away
    assert vcor("run", "case.nml", "--output", "all", "--shard", "1/1").code == NUMERICAL
    part = folder / "out" / "case.part.h5"
    shutil.move(folder / "all" / "case_shard_1_of_1.h5", part)
    take_away(part, slice(5, 20))


def column_place(path, name):
    """Where the numbers of a column begin in a file, and their type."""
    with h5py.File(path) as file:
        column = file["summary"][name]
        return column.id.get_offset(), column.dtype, len(column)


def take_away(path, rows):
    """Points become pending, in the bytes of the file: HDF5 knows nothing of it."""
    data = bytearray(path.read_bytes())
    for name, value in (("status", -1), ("check", 0), ("steps", 0)):
        offset, dtype, length = column_place(path, name)
        numbers = numpy.frombuffer(data, dtype, length, offset)
        numbers[rows] = value
    path.write_bytes(data)


def damage(data, random):
    """Other bytes in place of those of a file, and what was done to them."""
    data = bytearray(data)
    kind = random.choice(["bit", "bits", "cut", "zeros", "noise", "swap", "more"])
    length = min(len(data), int(2 ** random.uniform(0.0, 12.0)))
    start = random.randrange(len(data) - length + 1)
    if kind in {"bit", "bits"}:
        for _ in range(1 if kind == "bit" else random.randint(2, 100)):
            data[random.randrange(len(data))] ^= 1 << random.randrange(8)
    elif kind == "cut":
        del data[start:]
    elif kind == "zeros":
        data[start : start + length] = bytes(length)
    elif kind == "noise":
        data[start : start + length] = random.randbytes(length)
    elif kind == "swap":
        other = random.randrange(len(data) - length + 1)
        data[start : start + length] = data[other : other + length]
    else:
        data += random.randbytes(length)
    return bytes(data), kind


def limit():
    """Memory and time of the processor that a run may have, whatever else the machine is at."""
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESS_SPACE, ADDRESS_SPACE))
    resource.setrlimit(resource.RLIMIT_CPU, (CPU_SECONDS, CPU_SECONDS + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def listing(folder):
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


def verdict(target, pristine, folder):
    """Run the command on what is in a folder; what became of it: `refused`, `right`, or a fault."""
    before = {name: (folder / name).read_bytes() for name in listing(folder)}
    try:
        done = subprocess.run(
            [program(), *target.words],
            cwd=folder,
            capture_output=True,
            encoding="utf-8",
            errors="replace",
            stdin=subprocess.DEVNULL,
            timeout=10 * LIMIT,
            preexec_fn=limit,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return "hangs"
    if done.returncode < 0:
        return "signal " + str(-done.returncode)
    if done.returncode in {INPUT, FILE}:
        line = done.stderr
        if not line.startswith("vcor: error: ") or line.count("\n") != 1:
            return "more than a line"
        if not line[:-1].isprintable() or len(line) > 500:
            return "line that cannot be read"
        if {name: (folder / name).read_bytes() for name in listing(folder)} != before:
            return "files on refusal"
        return "refused"
    if done.returncode not in {SUCCESS, NUMERICAL}:
        return f"exit code {done.returncode}"
    for name in target.results:
        path = folder / name
        if not path.is_file() or path.read_bytes() != (pristine / name).read_bytes():
            return "undetected"
    return "right"


def trials(pristine, count, seed, report=None):
    """Damage files and see: how often what became of them, by target; the faults."""
    found = {name: Counter() for name in TARGETS}
    faults = []
    for number in range(count):
        lot = random.Random(f"{seed} {number}")
        name = list(TARGETS)[number % len(TARGETS)]
        target = TARGETS[name]
        with tempfile.TemporaryDirectory() as place:
            folder = Path(place)
            for path in target.inputs:
                (folder / path).parent.mkdir(exist_ok=True)
                shutil.copy(pristine / path, folder / path)
            whole = (folder / target.damaged).read_bytes()
            data, kind = damage(whole, lot)
            if data == whole:
                continue
            (folder / target.damaged).write_bytes(data)
            end = verdict(target, pristine, folder)
        found[name][end] += 1
        if end not in {"refused", "right"}:
            faults.append(f"{name}, {kind}, seed {seed} {number}: {end}")
            if report:
                report(faults[-1])
    return found, faults


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--count", type=int, default=1000, help="number of trials")
    parser.add_argument("--seed", type=int, default=1, help="which ones")
    parser.add_argument("--keep", type=Path, help="folder for the undamaged files")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        pristine = arguments.keep or Path(place)
        pristine.mkdir(exist_ok=True)
        make_files(pristine)
        found, faults = trials(pristine, arguments.count, arguments.seed, print)
    for name, ends in found.items():
        print(f"{name}: {sum(ends.values())} tried, {dict(ends)}")
    print(f"{sum(sum(ends.values()) for ends in found.values())} tried, {len(faults)} faults")
    return len(faults) > 0


if __name__ == "__main__":
    sys.exit(main())
