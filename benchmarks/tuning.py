#!/usr/bin/env python3
"""Spoil the tuning constants one by one.

Builds a copy of the tree in which the constants of src/vcor/tuning.f90 are variables read from a
file, solves the reference impacts of tests/reference and counts instructions with each constant
multiplied by each factor, and prints a table: instructions per impact of the paper's cases over those
without a change, impacts that miss the reference as tests/unit/test_impacts.f90 counts them, and
impacts whose contact time or residual indentation misses where that test does not look (receding);
last, impacts on layers that miss it as tests/cli/test_body_reference.py counts them, and impacts by
product integration. With --tests it runs these tests of CTest, too, and names those that fail.

With --spoil it only looks for a factor with which a test fails, for each constant: first the unit
tests, then tests of the program.

    benchmarks/tuning.py [--factors 0.5,2] [--only REGEX] [--build DIR] [--accuracies 1e-6,1e-8,1e-10]
                         [--cases REGEX] [--tests REGEX]
    benchmarks/tuning.py --spoil [--only REGEX] [--build DIR]

Needs the compiler, CMake and valgrind; an hour for all constants.
"""

import argparse
import atexit
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TUNING = "src/vcor/tuning.f90"
CONSTANT = re.compile(r"^   (real\(wp\)|integer), parameter :: (\w+) = ([-\d.e+]+)(_wp)?( !.*)?$",
                      re.MULTILINE)
FIRST = {
    "src/vcor/material.f90": "      if (allocated(data%unknown)) then\n",
    "tests/unit/harness.f90": "      suite_name = name\n",
}
"""Where a material is made, which every impact begins with, and where a unit test begins."""
SETS = {"practical": 1.0e-11, "random": 1.0e-12, "designed": 3.0e-12, "found": 1.0e-12}
COLUMNS = ("cor cor_sphere contact_time max_indentation max_force residual_indentation "
           "hysteresis_energy wave_energy cor_error cor_sphere_error status").split()
SHARE = (1.0, 1.0, 1.0, 1.0, 1.0, 3.0, 2.0, 2.0)
"""Error of the first eight columns over the accuracy, as tests/unit/test_impacts.f90 has it."""
CASES = {
    "sls": ("sls", (), 40),
    "prony": ("butyl_prony", (), 40),
    "cerf": ("butyl_cerf", (), 40),
    "power": ("butyl_power_law", (), 40),
    "exact": ("butyl_prony", ("contact.law=receding", "plate.waves=hereditary"), 40),
    "exact cerf": ("butyl_cerf", ("contact.law=receding", "plate.waves=hereditary"), 40),
    "body": ("sls", ("plate.waves=body",), 2),
    "direct": ("sls", ("solver.method=direct",), 2),
    "receding": ("sls", ("solver.method=direct", "contact.law=receding"), 2),
}
"""Impacts whose instructions are counted: example, settings, and number of velocities."""

SPOILING = (0.03, 30.0, 1.0e-4, 1.0e4, 1.0e-9, 1.0e9)
"""Factors with --spoil; the last ones for thresholds between numbers that are far apart."""
GUARDS = ("^test_", "^cli_test_(body|results|gravity|mechanics)$")
"""Tests with --spoil, the faster ones first."""

READER = """
contains

   !> Read other values once, if a file of them is named
   subroutine read_tuning()
      character(len=300) :: name
      real(wp) :: value
      integer :: unit, status
      logical, save :: is_read = .false.

      if (is_read) return
      is_read = .true.
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
    text = (folder / TUNING).read_text()
    cases = "\n".join(f"         case ('{name}')\n            {name} = "
                      + ("nint(value)" if kind == "integer" else "value")
                      for name, kind, _ in constants(text))
    text = CONSTANT.sub(r"   \1, protected :: \2 = \3\4", text)
    (folder / TUNING).write_text(text.replace("\nend module", READER % cases + "\nend module"))
    use = "   use vcor_tuning, only : read_tuning\n   implicit none\n"
    for name, first in FIRST.items():
        text = (folder / name).read_text().replace("   implicit none\n", use, 1)
        if text.count(first) != 1:
            sys.exit(f"{name}: found {text.count(first)} lines '{first.strip()}', expected 1")
        (folder / name).write_text(text.replace(first, "      call read_tuning()\n" + first))
    subprocess.run(["cmake", "--preset", "release", f"-DVCOR_PYTHON={ROOT / 'build/venv/bin/python'}"],
                   cwd=folder, check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", "build/release"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return folder / "build/release/vcor"


def references(folder, sets):
    """The reference impacts as case files beside their data: name, file, expected numbers, accuracies."""
    impacts = []
    for name, accuracy in sets.items():
        for part in (folder / f"tests/reference/{name}.txt").read_text().split("! impact ")[1:]:
            title = part.split("\n", 1)[0]
            expect = [float(x) for x in re.search(r"! expect (.*)", part)[1].split()]
            file = folder / f"tests/reference/{name}_{title.split()[0]}.nml"
            file.write_text("! " + part)
            own = re.search(r"; accuracy (.*)", title) if name == "body" else None
            accuracies = [float(x) for x in own[1].split()] if own else accuracy
            impacts.append((f"{name} {title}", file, expect, accuracies, "'receding'" in part))
    return impacts


def results(program, impacts, environment, *settings):
    """Name, columns, expected numbers, accuracies, and whether receding; no columns without a result."""
    run = subprocess.run([program, "run", *(file.name for _, file, *_ in impacts), "--quiet", "--print",
                          ",".join(COLUMNS), *(word for setting in settings for word in ("--set", setting))],
                         cwd=impacts[0][1].parent, env=environment, text=True, capture_output=True, check=False)
    rows = run.stdout.strip().split("\n")
    for row, (name, _, *rest) in zip(rows if len(rows) == len(impacts) else [""] * len(impacts), impacts):
        words = row.replace(",", " ").split()
        if " table" not in name:
            yield name, [float(x) for x in words[:-1]] if "separated" in words else None, *rest


def misses(program, impacts, accuracy, environment):
    """What the impacts miss, by name and column."""
    missed = set()
    settings = ("solver.method=ive", f"solver.accuracy={accuracy:g}")
    for name, found, expect, reference, receding in results(program, impacts, environment, *settings):
        if not found:
            missed.add((name, "status"))
            continue
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


def misses_on_layers(program, impacts, environment):
    """The same of impacts on layers, with the default accuracy."""
    missed = set()
    for name, found, expect, (sphere, relative, rest), _ in results(program, impacts, environment):
        if not found:
            missed.add((name, "status"))
            continue
        allowed = {0: 3.0 * found[8] + relative, 1: min(1.0e-7, 3.0 * found[9]) + sphere,
                   6: (1.0e-7 + rest) * expect[8], 7: (1.0e-7 + rest) * expect[8]}
        missed |= {(name, COLUMNS[i]) for i, most in allowed.items() if not abs(found[i] - expect[i]) <= most}
    return missed


def misses_by_product(program, impacts, accuracy, environment):
    """The same of product integration, whose accuracy is that of the coefficients of restitution."""
    missed = set()
    settings = ("solver.method=direct", f"solver.accuracy={accuracy:g}")
    for name, found, expect, reference, _ in results(program, impacts, environment, *settings):
        if not found:
            missed.add((name, "status"))
            continue
        for i in (0, 1):
            if not abs(found[i] - expect[i]) <= min(accuracy, 3.0 * found[8 + i]) + reference:
                missed.add((name, COLUMNS[i]))
    return missed


def instructions(program, folder, environment, cases, times):
    """Instructions of sweeps of the cases over so many times their number of velocities."""
    counts = []
    for example, settings, points in cases.values():
        text = (ROOT / f"examples/paper/{example}.nml").read_text()
        case = folder / "instructions.nml"
        case.write_text(text + "&sweep parameter = 'impact.velocity', start = 1.0, stop = 12.0, "
                        f"count = {times * points}, spacing = 'log' /\n")
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, "run", case,
                   "--threads", "1", "--quiet", "--print", "cor"]
        for setting in settings:
            command += ["--set", setting]
        run = subprocess.run(command, env=environment, text=True, capture_output=True, check=False)
        counts.append(int(re.search(r"Collected : (\d+)", run.stderr)[1]))
    return counts


def failed_tests(folder, environment, tests, *options):
    """Names of the tests that fail; a test that hangs fails."""
    run = subprocess.run(["ctest", "--test-dir", folder / "build/release", "-R", tests, "--timeout", "200", *options],
                         env=environment, text=True, capture_output=True, check=False)
    if "No tests were found" in run.stdout + run.stderr:
        sys.exit(f"there are no tests '{tests}': run scripts/test.sh first, which makes build/venv for them")
    return re.findall(r"- (\w+) \((?:Failed|Timeout|SEGFAULT|Subprocess aborted)", run.stdout)


def changed(kind, value, factor):
    """The value of a constant times a factor."""
    if kind != "integer":
        return value * factor
    return min(max(round(value * factor), 1), 10**9)


def spoil(folder, environment, values, chosen):
    """Name for each constant a factor and a test that it fails."""
    values.write_text("")
    for tests in GUARDS:
        if failed := failed_tests(folder, environment, tests):
            sys.exit(f"these tests fail without a change: {' '.join(failed)}")
    for name, kind, value in chosen:
        found = ["none"]
        for tests, factor in ((tests, factor) for tests in GUARDS for factor in SPOILING):
            values.write_text(f"{name} {changed(kind, value, factor)!r}\n")
            if failed := failed_tests(folder, environment, tests, "--stop-on-failure"):
                found = [f"{factor:g}", *failed]
                break
        print(f"{name:24}", *found, flush=True)


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--factors", default="0.5,2")
    parser.add_argument("--only", default="")
    parser.add_argument("--build", type=Path)
    parser.add_argument("--accuracies", default="1e-6,1e-8,1e-10")
    parser.add_argument("--cases", default="")
    parser.add_argument("--tests", default="")
    parser.add_argument("--spoil", action="store_true")
    options = parser.parse_args()
    accuracies = [float(x) for x in options.accuracies.split(",")]
    folder = (options.build or Path(tempfile.mkdtemp(prefix="vcor_tuning_"))).resolve()
    if not options.build:
        atexit.register(shutil.rmtree, folder)
    program = folder / "build/release/vcor"
    if not program.exists():
        program = build(folder)
    values = folder / f"values_{os.getpid()}.txt"
    environment = dict(os.environ, VCOR_TUNING=str(values), OMP_NUM_THREADS="1")
    chosen = [constant for constant in constants((ROOT / TUNING).read_text()) if re.search(options.only, constant[0])]
    if options.spoil:
        spoil(folder, environment, values, chosen)
        return
    impacts = references(folder, SETS)
    layers = references(folder, {"body": 0.0})
    practical = references(folder, {"practical": SETS["practical"]})
    cases = {name: case for name, case in CASES.items() if re.search(options.cases, name)}

    def measure(line):
        values.write_text(line)
        missed = [misses(program, impacts, accuracy, environment) for accuracy in accuracies]
        missed.append(misses_on_layers(program, layers, environment))
        missed.append(misses_by_product(program, practical, 1.0e-6, environment))
        return [(n - i) / 1000.0 / points for n, i, (*_, points) in
                zip(instructions(program, folder, environment, cases, 1), idle, cases.values())], missed

    def remark():
        if not options.tests:
            return ""
        return "   failed: " + (" ".join(failed_tests(folder, environment, options.tests)) or "none")

    # what a run costs without an impact
    values.write_text("")
    few, many = (instructions(program, folder, environment, cases, times) for times in (1, 3))
    idle = [n - (m - n) / 2 for n, m in zip(few, many)]
    usual, known = measure("")
    sets = [f"{accuracy:g}" for accuracy in accuracies] + ["body", "direct"]
    print("usual: instructions per impact [1000]",
          ", ".join(f"{name} {count:.0f}" for name, count in zip(cases, usual)), remark())
    for name, missed in zip(sets, known, strict=True):
        print(f"missed at {name}:", "; ".join(sorted(" ".join(miss) for miss in missed)) or "none")
    print(f"{'constant':24} {'factor':>6} " + " ".join(f"{name:>10}" for name in cases)
          + " ".join(f"{name:>9}" for name in sets) + "   new misses + receding (mended) of each set", flush=True)
    for name, kind, value in chosen:
        for factor in map(float, options.factors.split(",")):
            counts, missed = measure(f"{name} {changed(kind, value, factor)!r}\n")
            row = f"{name:24} {factor:6g} " + " ".join(f"{c / u:10.3f}" for c, u in zip(counts, usual))
            for now, before in zip(missed, known):
                tested = {m for m in now - before if not m[1].endswith("receding")}
                row += f" {len(tested):>3}+{len(now - before) - len(tested)}({len(before - now)})"
            print(row + remark(), flush=True)


if __name__ == "__main__":
    sys.exit(main())
