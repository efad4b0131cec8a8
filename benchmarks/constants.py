#!/usr/bin/env python3
"""What other values of a constant of the source change: solves random impacts with each of them.

    constants.py FILE NAME VALUE ... [--only FAMILY,...]
    constants.py solver/ive/march.f90 soon 0.0 0.3 --only practical,wide

FILE is below src/vcor and has `NAME = NUMBER` once as a named constant. Each value is built in a copy of the source,
which takes minutes at first, and solves the same impacts: those of accuracy_families.py with a seed of their own, with
tables of data, with exact mechanics (exact_impacts.py), and on structures. Each line says how many impacts change, by
how much at most and by how many of the errors that they state, what becomes of panels or steps and of the time, and
which statuses change. Needs CMake, the Python package (PYTHONPATH=python/src and
VCOR_LIBRARY=build/release/libvcor_python.so will do), and what tests/reference/requirements.txt names.
"""

import argparse
import json
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path

import accuracy_families as families
import exact_impacts
from make_impacts import Draw, text_of

import vcor

TOP = Path(__file__).resolve().parent.parent
SEED = "halves"
#: Impacts of each family of accuracy_families.py, and of the others
COUNTS = {
    "practical": 60, "wide": 50, "pairs": 30, "wide pairs": 30, "dashpots": 30, "frozen plates": 20,
    "nearly fluid plates": 40, "exponents near 0": 15, "exponents near 1": 15, "shapes and gravity": 50,
}  # fmt: skip
TABLES, EXACT, STRUCTURES = 30, 40, 60
RESULTS = ("cor", "cor_sphere", "contact_time", "max_force")
#: A relative change that is rounding
ROUNDING = 1e-13
STRUCTURE_MATERIALS = {
    "glass": "model='elastic', modulus=70e9, poisson_ratio=0.22, density=2500",
    "pmma": "model='elastic', modulus=4e9, poisson_ratio=0.35, density=1190",
    "sls": "model='sls', glassy_modulus=3e9, alpha=2e3, beta=5e3, poisson_ratio=0.4, density=1200",
}


def structure(draw):
    """A steel ball on a beam, plate, rod or block."""

    def log(low, high):
        return math.exp(draw.uniform(math.log(low), math.log(high)))

    radius, body = log(1e-3, 2e-2), draw.choice(["beam", "plate", "rod", "block"])
    material = draw.choice(["steel", *STRUCTURE_MATERIALS])
    damping = draw.choice(["", f", damping_ratio={log(1e-3, 0.3)}"])
    if body == "beam":
        support = draw.choice(["supported", "clamped", "cantilever", "free"])
        keys = (f"support='{support}', length={log(0.05, 0.6)}, width={log(0.005, 0.05)}, "
                f"thickness={log(1e-3, 0.02)}{damping}")  # fmt: skip
    elif body == "plate":
        keys = (f"support='supported', length={log(0.05, 0.5)}, width={log(0.05, 0.5)}, "
                f"thickness={log(5e-4, 0.01)}{damping}")  # fmt: skip
    elif body == "rod":
        support = draw.choice(["free", "clamped"])
        keys = f"support='{support}', length={log(0.02, 1)}, diameter={log(0.004, 0.04)}{damping}"
    else:
        spring = f", stiffness={log(1e3, 1e7)}"
        keys = f"mass={log(1e-3, 10)}" + draw.choice(["", spring, f"{spring}, damping={log(0.1, 100)}"])
    own = STRUCTURE_MATERIALS.get(material)
    return "".join([
        "&contact pair='series' /\n" * (material == "sls"),
        f"&impact velocity={log(0.1, 5)} /\n&sphere radius={radius}, material='steel' /\n",
        f"&plate material='{material}' /\n&target body='{body}', {keys} /\n",
        "&material name='steel', model='elastic', modulus=210e9, poisson_ratio=0.3, density=7850 /\n",
        f"&material name='{material}', {own} /\n" if own else "",
    ])  # fmt: skip


def draw_impacts(only, folder):
    """Family, text, method and accuracy of each impact."""
    found = []
    for family in families.FAMILIES:
        if family.name not in COUNTS or (only and family.name not in only):
            continue
        draw = Draw(f"{SEED} {family.name}")
        draw_case = families.such(
            lambda case, frozen=family.frozen: (case["plate"]["waves"] == "frozen") == frozen, family.draw
        )
        for i in range(COUNTS[family.name]):
            text = text_of(draw_case(draw))
            runs = [("direct", 1e-6)] if family.frozen else [("ive", 1e-8)]
            if i % 3 == 0 and not family.frozen:
                runs += [("ive", 1e-10)] + [("direct", 1e-6)] * (family.name != "nearly fluid plates")
            found += [(family.name, text, *run) for run in runs]
    if not only or "tables" in only:
        draw, tables = Draw(f"{SEED} tables"), []
        draw_case = families.such(
            lambda case: case["plate"]["material"] == "plate" != case["sphere"]["material"]
            and case["plate"]["waves"] in ("none", "relaxing")
            and "viscosity" not in families.plate_of(case)
        )
        while len(tables) < TABLES:
            case = draw_case(draw)
            try:
                row = vcor.Case(text_of(case)).solve(quantities=["cor", "contact_time"])
            except vcor.NumericalError:
                continue
            if row["cor"] > families.REBOUND:
                path = folder / f"{len(tables)}.csv"
                table = families.as_table(case, path, row["contact_time"], 8 if len(tables) % 2 else 25)
                tables.append(("tables", text_of(table), "ive", 1e-6))
        found += tables
    if not only or "exact" in only:
        draws = [random.Random(f"77 {i}") for i in range(EXACT)]
        found += [("exact", exact_impacts.make(one), "auto", 1e-5) for one in draws]
    if not only or "structures" in only:
        draws = [random.Random(f"{SEED} {i}") for i in range(STRUCTURES)]
        found += [("structures", structure(one), "auto", 1e-8) for one in draws]
    return found


def solve_all(impacts):
    """Results, errors and status of each impact, and the processor time of all [s]."""
    names, found, start = [*RESULTS, *(f"{name}_error" for name in RESULTS), "steps"], [], time.process_time()
    for _, text, method, accuracy in impacts:
        case = vcor.Case(text)
        case["solver.method"] = method
        row = case.points({"solver.accuracy": [accuracy]}, [*names, "status"], threads=1)
        found.append({name: row[name].values[0].item() for name in names} | {"status": str(row.status.values[0])})
    return found, time.process_time() - start


def compared(before, after):
    """One line on what has changed."""
    changed, largest, stated, steps, statuses = 0, 0.0, 0.0, [0, 0], Counter()
    for old, new in zip(before, after, strict=True):
        if old["status"] != new["status"]:
            statuses[f"{old['status']} -> {new['status']}"] += 1
        elif old["status"] == "separated":
            steps = [steps[0] + old["steps"], steps[1] + new["steps"]]
            changed += any(old[name] != new[name] for name in RESULTS)
            for name in RESULTS:
                size = 1.0 if name.startswith("cor") else abs(old[name])
                change, error = abs(new[name] - old[name]), old[f"{name}_error"]
                largest = max(largest, change / size)
                if change > ROUNDING * size and error > 0:
                    stated = max(stated, change / error)
    return (f"{changed} of {len(before)} change, by {largest:.1e} at most, {stated:.2g} stated errors; "
            f"steps {steps[0]:.0f} -> {steps[1]:.0f}; {dict(statuses) or ''}")  # fmt: skip


def main():
    """Build and solve with each value."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="source file below src/vcor; 'solve' is used by the script itself")
    parser.add_argument("name", help="name of the constant")
    parser.add_argument("values", nargs="*", help="other values, as in Fortran but for the kind")
    parser.add_argument("--only", default="", help="families, separated by commas")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    if options.file == "solve":
        impacts = json.loads(Path(options.name).read_text())
        print(json.dumps(solve_all(impacts)))
        return
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        copy = shutil.copytree(TOP, folder / "copy", ignore=shutil.ignore_patterns("build", ".git"))
        source = copy / "src" / "vcor" / options.file
        text = source.read_text()
        pattern = rf"(?m)^(\s*(?:real\(wp\)|integer), parameter ::.*\b{options.name} = )[-+0-9.e]+(_wp)?"
        if len(re.findall(pattern, text)) != 1:
            sys.exit(f"constants: expected one constant {options.name} that is a number in {options.file}")
        cases = folder / "impacts.json"
        cases.write_text(json.dumps(draw_impacts([one for one in options.only.split(",") if one], folder)))
        subprocess.run(["cmake", "--preset", "release"], cwd=copy, check=True, stdout=subprocess.DEVNULL)
        before = None
        for value in [None, *options.values]:
            if value is not None:
                source.write_text(re.sub(pattern, rf"\g<1>{value}\g<2>", text))
            build = ["cmake", "--build", "--preset", "release", "--target", "vcor_python"]
            subprocess.run(build, cwd=copy, check=True, stdout=subprocess.DEVNULL)
            found = subprocess.run(
                [sys.executable, __file__, "solve", cases], check=True, capture_output=True, text=True,
                env=os.environ | {"VCOR_LIBRARY": str(copy / "build" / "release" / "libvcor_python.so")},
            )  # fmt: skip
            after, seconds = json.loads(found.stdout)
            if before is None:
                before, first = after, seconds
            else:
                print(f"{value}: {compared(before, after)} time x {seconds / first:.2f}", flush=True)


if __name__ == "__main__":
    main()
