#!/usr/bin/env python3
"""Spoil the tuning constants of the internal-variable method one by one.

Builds a copy of the tree in which the constants of src/vcor/solver/ive/tuning.f90 are variables read
from a file, solves the reference impacts of tests/reference and counts instructions with each constant
multiplied by each factor, and prints a table: instructions per impact of the paper's cases over those
without a change, impacts that miss the reference as tests/unit/test_impacts.f90 counts them, and
impacts whose contact time or residual indentation misses where that test does not look (receding).

    benchmarks/tuning.py [--factors 0.5,2] [--only REGEX] [--build DIR] [--accuracies 1e-6,1e-8,1e-10]

Needs the compiler, CMake and valgrind; half an hour for all constants.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TUNING = "src/vcor/solver/ive/tuning.f90"
CONSTANT = re.compile(r"^   (real\(wp\)|integer), parameter :: (\w+) = ([-\d.e+]+)(_wp)?( !.*)?$",
                      re.MULTILINE)
SETS = {"practical": 1.0e-11, "random": 1.0e-12, "designed": 3.0e-12, "found": 1.0e-12}
COLUMNS = ("cor cor_sphere contact_time max_indentation max_force residual_indentation "
           "hysteresis_energy wave_energy cor_error cor_sphere_error status").split()
SHARE = (1.0, 1.0, 1.0, 1.0, 1.0, 3.0, 2.0, 2.0)
"""Error of the first eight columns over the accuracy, as tests/unit/test_impacts.f90 has it."""
CASES = {
    "sls": ("sls", ()),
    "prony": ("butyl_prony", ()),
    "cerf": ("butyl_cerf", ()),
    "power": ("butyl_power_law", ()),
    "exact": ("butyl_prony", ("contact.law=receding", "plate.waves=hereditary")),
    "exact cerf": ("butyl_cerf", ("contact.law=receding", "plate.waves=hereditary")),
}
"""Impacts whose instructions are counted: example and settings."""
POINTS = 40
"""Velocities that they are counted for."""

READER = """
contains

   !> Read other values, if a file of them is named
   subroutine read_tuning()
      character(len=300) :: name
      real(wp) :: value
      integer :: unit, status

      call get_environment_variable("VCOR_TUNING", name, status=status)
      if (status /= 0) return
      open(newunit=unit, file=trim(name), status="old", action="read")
      do
         read(unit, *, iostat=status) name, value
         if (status /= 0) exit
         select case (name)
%s
         end select
      end do
      close(unit)
   end subroutine read_tuning
"""


def constants(text):
    """Names, kinds and values of the constants."""
    return [(name, kind, float(value)) for kind, name, value, *_ in CONSTANT.findall(text)]


def build(folder):
    """Build the copy; its program."""
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, text=True, capture_output=True, check=True)
    for name in files.stdout.split():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, target)
    tuning = folder / TUNING
    text = tuning.read_text()
    found = constants(text)
    cases = "\n".join(f"         case ('{name}')\n            {name} = "
                      + ("nint(value)" if kind == "integer" else "value") for name, kind, _ in found)
    text = CONSTANT.sub(r"   \1, protected :: \2 = \3\4", text)
    tuning.write_text(text.replace("\nend module", READER % cases + "\nend module"))
    solver = folder / "src/vcor/solver/ive.f90"
    text = solver.read_text()
    text = text.replace("      self%accuracy = min(", "      call read_tuning()\n      self%accuracy = min(", 1)
    text = text.replace("   use vcor_solver_ive_tuning, only : ", "   use vcor_solver_ive_tuning, only : "
                        "read_tuning, ", 1)
    solver.write_text(re.sub(r"(only : read_tuning,) (.*) &\n", r"\1 &\n      \2 &\n", text, count=1))
    subprocess.run(["cmake", "--preset", "release"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", "build/release", "--target", "vcor_program"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    return folder / "build/release/vcor"


def references(folder):
    """The reference impacts as case files beside their data: name, file, expected numbers, accuracy."""
    impacts = []
    for name, accuracy in SETS.items():
        for part in (folder / f"tests/reference/{name}.txt").read_text().split("! impact ")[1:]:
            title = part.split("\n", 1)[0]
            expect = [float(x) for x in re.search(r"! expect (.*)", part)[1].split()]
            file = folder / f"tests/reference/{name}_{title.split()[0]}.nml"
            file.write_text("! " + part)
            impacts.append((f"{name} {title}", file, expect, accuracy, "'receding'" in part))
    return impacts


def misses(program, impacts, accuracy, environment):
    """What the impacts miss, by name and column."""
    run = subprocess.run([program, "run", *(file.name for _, file, *_ in impacts), "--quiet", "--print",
                          ",".join(COLUMNS), "--set", "solver.method=ive", "--set",
                          f"solver.accuracy={accuracy:g}"], cwd=impacts[0][1].parent, env=environment,
                         text=True, capture_output=True, check=False)
    rows = run.stdout.strip().split("\n")
    if len(rows) != len(impacts):
        return {("all", "no result")}
    missed = set()
    for row, (name, _, expect, reference, receding) in zip(rows, impacts):
        words = row.replace(",", " ").split()
        if " table" in name:
            continue
        if words[-1] != "separated":
            missed.add((name, "status"))
            continue
        found = [float(word) for word in words[:-1]]
        scale = [1.0, 1.0, *expect[2:5], expect[3], expect[8], expect[8]]
        error = [abs(f - e) / s for f, e, s in zip(found, expect, scale)]
        for i, share in enumerate(SHARE):
            tolerance = share * max(accuracy, 1.0e-9 if i in (2, 5) else 0.0)
            if not error[i] <= tolerance + reference:
                missed.add((name, COLUMNS[i] + (" receding" if receding and i in (2, 5) else "")))
        for i in (0, 1):
            if not error[i] <= 3.0 * found[8 + i] + 1.0e-12 + reference:
                missed.add((name, COLUMNS[8 + i]))
    return missed


def instructions(program, folder, environment, points):
    """Instructions of sweeps of the cases over so many velocities."""
    counts = []
    for example, settings in CASES.values():
        text = (ROOT / f"examples/paper/{example}.nml").read_text()
        case = folder / "instructions.nml"
        case.write_text(text + "&sweep parameter = 'impact.velocity', start = 1.0, stop = 12.0, "
                        f"count = {points}, spacing = 'log' /\n")
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, "run", case,
                   "--threads", "1", "--quiet", "--print", "cor"]
        for setting in settings:
            command += ["--set", setting]
        run = subprocess.run(command, env=environment, text=True, capture_output=True, check=False)
        counts.append(int(re.search(r"Collected : (\d+)", run.stderr)[1]))
    return counts


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--factors", default="0.5,2")
    parser.add_argument("--only", default="")
    parser.add_argument("--build", type=Path)
    parser.add_argument("--accuracies", default="1e-6,1e-8,1e-10")
    options = parser.parse_args()
    accuracies = [float(x) for x in options.accuracies.split(",")]
    folder = (options.build or Path(tempfile.mkdtemp(prefix="vcor_tuning_"))).resolve()
    program = folder / "build/release/vcor"
    if not program.exists():
        program = build(folder)
    impacts = references(folder)
    values = folder / f"values_{os.getpid()}.txt"
    environment = dict(os.environ, VCOR_TUNING=str(values), OMP_NUM_THREADS="1")

    def measure(line):
        values.write_text(line)
        missed = [misses(program, impacts, accuracy, environment) for accuracy in accuracies]
        return [(n - i) / 1000.0 / POINTS for n, i in
                zip(instructions(program, folder, environment, POINTS), idle)], missed

    # what a run costs without an impact
    values.write_text("")
    few, many = (instructions(program, folder, environment, n) for n in (POINTS, 3 * POINTS))
    idle = [n - (m - n) / 2 for n, m in zip(few, many)]
    usual, known = measure("")
    print("usual: instructions per impact [1000]",
          ", ".join(f"{name} {count:.0f}" for name, count in zip(CASES, usual)))
    for accuracy, missed in zip(accuracies, known, strict=True):
        print(f"missed at {accuracy:g}:", "; ".join(sorted(" ".join(miss) for miss in missed)) or "none")
    print(f"{'constant':24} {'factor':>6} " + " ".join(f"{name:>10}" for name in CASES)
          + " ".join(f"{accuracy:>9.0e}" for accuracy in accuracies) + "   new misses (mended) at each accuracy",
          flush=True)
    for name, kind, value in constants((ROOT / TUNING).read_text()):
        if not re.search(options.only, name):
            continue
        for factor in map(float, options.factors.split(",")):
            other = value * factor
            if kind == "integer":
                other = round(other)
            counts, missed = measure(f"{name} {other!r}\n")
            row = f"{name:24} {factor:6g} " + " ".join(f"{c / u:10.3f}" for c, u in zip(counts, usual))
            for now, before in zip(missed, known):
                tested = {m for m in now - before if not m[1].endswith("receding")}
                row += f" {len(tested):>3}+{len(now - before) - len(tested)}({len(before - now)})"
            print(row, flush=True)
    if not options.build:
        shutil.rmtree(folder)


if __name__ == "__main__":
    sys.exit(main())
