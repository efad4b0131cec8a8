#!/usr/bin/env python3
"""How accurate vcor is on impacts of many kinds: measures, and writes the tables of docs/measured.md.

    accuracy_families.py [--only NAME,...] [--share 0.1] [--cases FILE]

Each family of impacts is drawn from a seed of its own and solved with the methods and accuracies of its runs.
The error is the distance from the best solution, see `best_of`. The tables go between the markers of
docs/measured.md, with --only to the screen; --share solves a share of each family. --cases writes the
impacts that are refused, missed, or whose error is stated too small, as case files with remarks. Takes about
a quarter of an hour on two idle cores. Needs the Python package (PYTHONPATH=python/src and
VCOR_LIBRARY=build/release/libvcor_python.so will do), and what tests/reference/requirements.txt names.
"""

import argparse
import csv
import itertools
import math
import multiprocessing
import os
import re
import sys
import tempfile
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
TOP = Path(__file__).resolve().parent.parent
REFERENCE = TOP / "tests" / "reference"
DOCUMENT = TOP / "docs" / "measured.md"
sys.path.insert(0, str(REFERENCE))

import numpy as np  # noqa: E402
from make_impacts import EXPECT, LAWS, RIGID, SLS, Draw, impact, read_set, text_of  # noqa: E402

import vcor  # noqa: E402

SEED = "vcor 1.0"
#: Methods and accuracies that are judged, and those of the best solution and of the one that is to confirm it
RUNS, BEST = [("ive", 1e-6), ("ive", 1e-8), ("ive", 1e-10), ("direct", 1e-6)], [("ive", 1e-11), ("direct", 1e-8)]
#: The same for frozen plates, which only direct solves: nothing confirms its best solution
FROZEN_RUNS, FROZEN_BEST = [("direct", 1e-6), ("direct", 1e-8)], [("direct", 1e-9)]
#: How a case file says that its plate is frozen
FROZEN = "waves = 'frozen'"
#: An error is stated too small when it is more than so many times larger, and rounding does not explain it
HONEST, ROUNDING = 3.0, 1e-12
#: Accuracy of the references
REFERENCE_ERROR = 1.2e-11
#: The contact time, and the residual indentation that moves with it, are promised down to this
BEST_TIME = 1e-9
#: Least cor and cor_sphere that count as a rebound
REBOUND = 0.01
#: Bound of the error of each column over the accuracy, for ive, as docs/accuracy.md has it
BOUNDS = dict(cor=1, cor_sphere=1, contact_time=1, max_indentation=1, max_force=1,
              residual_indentation=3, hysteresis_energy=2, wave_energy=2)
STATED = ("cor_error", "cor_sphere_error")
VERDICTS = {"refused": "refused", "missed": "error above accuracy", "above": "estimate above accuracy",
            "small": "error above 3 times the estimate", "unknown": "not judged"}


# ------------------------------------------------------------------------------------ solutions


def solve(text, runs):
    """The outcome of each run, None where the bodies do not separate; and the statuses."""
    found, statuses = {}, set()
    for method, group in itertools.groupby(sorted(runs), lambda run: run[0]):
        accuracies = [accuracy for _, accuracy in group]
        case = vcor.Case(f"{text}&solver method = '{method}' /\n", name=str(REFERENCE / "case.nml"))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", vcor.NoResultWarning)
            result = case.points({"solver.accuracy": accuracies}, [*EXPECT, *STATED, "status"], threads=1)
        for i, accuracy in enumerate(accuracies):
            status = str(result.status.values[i])
            statuses.add(status)
            row = {name: float(result[name].values[i]) for name in (*EXPECT, *STATED)}
            found[method, accuracy] = row if status == "separated" else None
    return found, statuses


def distance(row, other):
    """How far two outcomes are apart in cor and cor_sphere."""
    return max(abs(row[name] - other[name]) for name in ("cor", "cor_sphere"))


def stated(row):
    """The larger of the errors that an outcome states."""
    return max(row[name] for name in STATED)


@dataclass
class Judged:
    """An impact and what became of its runs."""

    text: str
    #: The best outcome, its error, and how far direct is from it
    best: dict
    error: float = math.inf
    apart: float = math.nan
    #: Keys of VERDICTS, the error, and the errors of the columns over the accuracy, by run
    verdicts: dict = field(default_factory=dict)
    errors: dict = field(default_factory=dict)
    shares: dict = field(default_factory=dict)


def best_of(text, found):
    """The impact with its best solution and the run that it comes from.

    It is the one by ive at the smallest accuracy, known as well as it states. Where direct is farther away than
    HONEST times what both state, it is known to this distance only. On frozen plates it is the one by direct.
    """
    by_ive = next((run for run in sorted(found) if run[0] == "ive" and found[run]), None)
    by_direct = next((run for run in sorted(found) if run[0] == "direct" and found[run]), None)
    run = by_ive or by_direct
    best = Judged(text, found[run], stated(found[run]))
    if by_ive and by_direct:
        best.apart = distance(found[by_ive], found[by_direct])
        if best.apart > HONEST * (best.error + stated(found[by_direct])) + ROUNDING:
            best.error = best.apart
    return best, run


def judge(text, keeps=None, expected=None):
    """An impact of a family, judged; None if it is none of it or does not separate."""
    runs, best = (FROZEN_RUNS, FROZEN_BEST) if FROZEN in text else (RUNS, BEST)
    try:
        if keeps:
            row = solve(text, runs[:1])[0][runs[0]]
            if row and not keeps(row):
                return None
        found, statuses = solve(text, runs if expected else [*runs, *best])
    except vcor.InputError:
        return None
    if not any(found.values()):
        return Judged(text, {}, verdicts={run: {"refused"} for run in runs}) if statuses == {"failed"} else None
    one, best_run = (Judged(text, expected, REFERENCE_ERROR), None) if expected else best_of(text, found)
    for run in runs:
        judge_run(one, run, found[run], run == best_run)
    return one


def judge_run(one, run, row, is_best):
    """One run of an impact."""
    verdict = one.verdicts[run] = set()
    if row is None:
        verdict.add("refused")
        return
    if stated(row) > run[1]:
        verdict.add("above")
    error = distance(row, one.best)
    if is_best or (one.error > run[1] / 3 and abs(error - run[1]) < one.error):
        verdict.add("unknown")
        return
    one.errors[run] = error
    if error > run[1] + one.error:
        verdict.add("missed")
    for name in ("cor", "cor_sphere"):
        if abs(row[name] - one.best[name]) > HONEST * row[f"{name}_error"] + ROUNDING + one.error:
            verdict.add("small")
    scale = dict(one.best, cor=1.0, cor_sphere=1.0, residual_indentation=one.best["max_indentation"],
                 hysteresis_energy=one.best["initial_energy"], wave_energy=one.best["initial_energy"])
    one.shares[run] = {}
    for name in BOUNDS:
        slow = name in ("contact_time", "residual_indentation")
        accuracy = max(run[1], BEST_TIME) if slow else run[1]
        one.shares[run][name] = abs(row[name] - one.best[name]) / scale[name] / accuracy


# ------------------------------------------------------------------------------------- families


def plate_of(case):
    """Material of the plate."""
    return next(m for m in case["materials"] if m["name"] == case["plate"]["material"])


def such(accepts, draw_case=Draw.case):
    """A way to draw: the next case that a condition accepts."""
    return lambda draw: next(case for case in iter(lambda: draw_case(draw), None) if accepts(case))


def is_pair(case):
    """Whether two viscoelastic bodies are a pair by Eq. (1)."""
    relaxing = [m for m in case["materials"] if m["model"] not in ("rigid", "elastic")]
    return case["contact"]["pair"] == "eq1" and len(relaxing) == 2


def wide(draw):
    """A practical impact moved by decades."""
    case, one = draw.case(), draw.random
    case["velocity"] *= 10 ** one.uniform(-2, 2)
    case["plate"]["half_thickness"] *= 10 ** one.uniform(-1, 1.5)
    for material in case["materials"]:
        longer = 10 ** one.uniform(-4, 4)
        powers = dict(times=1, time=1, viscosity=1, alpha=-1, beta=-0.5 if material["model"] == "cerf" else -1)
        for key in powers.keys() & material.keys():
            material[key] = (np.array(material[key]) * longer ** powers[key]).tolist()
    return case


def with_exponents(near):
    """A way to draw practical impacts of materials with an exponent close to 0 or 1."""

    def draw_case(draw):
        case = such(lambda case: any("exponent" in m for m in case["materials"]))(draw)
        for material in case["materials"]:
            if "exponent" in material:
                material["exponent"] = abs(near - draw.log(1e-3, 0.05))
        return case

    return draw_case


def nearly_fluid(draw):
    """The paper's sphere on an SLS plate that relaxes to next to nothing."""
    beta = draw.log(3e3, 1e7)
    plate = dict(SLS, alpha=beta * draw.log(1e-18, 1e-2), beta=beta)
    waves, law = draw.random.choice(["relaxing", "hereditary"]), draw.random.choice(LAWS)
    return impact((RIGID, plate), waves, law, velocity=draw.log(0.1, 30), half_thickness=draw.log(0.003, 0.05))


def shaped(draw):
    """A practical impact of a cone, punch or profile, or of a sphere with gravity."""
    case, one = draw.case(), draw.random
    r, p = case["sphere"]["radius"], one.uniform(1.2, 6)
    shape, keys = one.choice([("sphere", {}), ("cone", dict(half_angle=one.uniform(20, 85))),
                              ("punch", dict(punch_radius=r * one.uniform(0.05, 0.5))),
                              ("power", dict(profile_power=p, profile_coefficient=0.5 * r ** (1 - p)))])
    if shape == "sphere":
        return dict(case, gravity=draw.log(1, 100))
    case["sphere"] = dict(shape=shape, mass=8e3 * r**3, material=case["sphere"]["material"], **keys)
    case["plate"].pop("surface_radius", None)
    if shape == "punch":
        case["contact"]["law"] = "boltzmann"
    return case


def rebounds(row):
    """Whether the sphere leaves with a velocity that anyone would measure."""
    return min(row["cor"], row["cor_sphere"]) >= REBOUND


def hardly_rebounds(row):
    """Whether it does not."""
    return not rebounds(row)


@dataclass
class Family:
    """A kind of impacts."""

    name: str
    count: int
    #: Description for the reader
    about: str
    #: The next case of a make_impacts.Draw
    draw: Callable = Draw.case
    #: Whether an outcome belongs to the family
    keeps: Callable | None = None
    #: Whether the plates are all frozen; none is otherwise
    frozen: bool = False


FAMILIES = [
    Family("practical", 600, "radii of 0.1 to 100 mm, 0.01 to 50 m/s, moduli of 1 MPa to 3 GPa that relax within two "
           "decades of the contact time and beyond; all models but tables, all thin plates but frozen ones, laws and "
           "pairs; `cor` and `cor_sphere` above 0.01", keeps=rebounds),
    Family("little rebound", 60, "the same, but `cor` or `cor_sphere` below 0.01", keeps=hardly_rebounds),
    Family("wide", 500, "practical ones with the velocity moved by up to two decades, the thickness by one, the "
           "relaxation times by four", wide),
    Family("pairs", 200, "practical pairs of two viscoelastic bodies by Eq. (1)", such(is_pair)),
    Family("wide pairs", 200, "the same, moved as the wide ones", such(is_pair, wide)),
    Family("dashpots", 150, "practical, with a dashpot", such(lambda c: any("viscosity" in m for m in c["materials"]))),
    Family("frozen plates", 150, "practical, on frozen plates, which `direct` solves", frozen=True),
    Family("nearly fluid plates", 150, "the paper's sphere on SLS plates that keep 1e-2 to 1e-18 of their modulus", nearly_fluid),
    Family("exponents near 0", 60, "practical, exponents of 0.001 to 0.05", with_exponents(0.0)),
    Family("exponents near 1", 60, "practical, exponents of 0.95 to 0.999", with_exponents(1.0)),
    Family("shapes and gravity", 150, "practical: cones, punches, profiles, and spheres with gravity of 1 to 100 m/s²",
           shaped),
]


def draw_family(family, count, pool):
    """So many judged impacts of a family."""
    draw, found = Draw(f"{SEED} {family.name}"), []
    draw_case = such(lambda case: (case["plate"]["waves"] == "frozen") == family.frozen, family.draw)
    while len(found) < count:
        texts = [text_of(draw_case(draw)) for _ in range(count - len(found))]
        found += filter(None, pool.starmap(judge, [(text, family.keeps) for text in texts], chunksize=1))
    return found[:count]


def references(pool):
    """The judged impacts of tests/reference, those of tables left out, and those of frozen plates by themselves."""
    rows = []
    with open(REFERENCE / "reference.csv", newline="") as file:
        for row in csv.DictReader(file):
            text = (REFERENCE / "cases" / f"{row['name']}.nml").read_text()
            rows.append((text, None, {name: float(row[name]) for name in EXPECT}))
    for name in ("practical", "random", "designed", "shapes", "found", "temperature"):
        rows += [(text, None, expected) for _, text, expected in read_set(REFERENCE / f"{name}.txt")
                 if "model = 'table'" not in text]
    about = "those of [tests/reference](../tests/reference) but tables"
    judged = pool.starmap(judge, rows, chunksize=4)
    return [("references", about, [one for one in judged if FROZEN not in one.text]),
            ("references, frozen", "those of frozen plates", [one for one in judged if FROZEN in one.text])]


# ---------------------------------------------------------------------------------- tables of data

PER_DECADE = (8, 25)
#: Plates on which the modulus before the first point of a table hardly matters, and those where it may
PLATES = {"`none`, `relaxing`": ("none", "relaxing"),
          "`constant`, `frozen`, `hereditary`": ("constant", "frozen", "hereditary")}


def as_table(case, path, duration, per_decade):
    """The case with a table of the plate's modulus from 1e-7 to 10 contact times."""
    times = duration * np.logspace(-7, 1, 8 * per_decade + 1)
    moduli = vcor.Case(text_of(case)).material("plate").relaxation(times)
    lines = [f"{t:.15e}, {e:.15e}" for t, e in zip(times, moduli, strict=True)]
    path.write_text("\n".join(["time [s], modulus [Pa]", *lines]) + "\n")
    table = {key: plate_of(case)[key] for key in ("name", "density", "poisson_ratio")}
    others = [m for m in case["materials"] if m["name"] != "plate"]
    return dict(case, materials=[dict(table, model="table", file=str(path)), *others])


def table_errors(case):
    """Errors of the coefficients for PER_DECADE; None without rebound."""
    quantities = ["cor", "cor_sphere", "contact_time"]
    try:
        exact = vcor.Case(text_of(case)).solve(quantities=quantities)
    except vcor.NumericalError:
        return None
    if not rebounds(exact):
        return None
    with tempfile.TemporaryDirectory() as folder:
        tables = [as_table(case, Path(folder) / f"{n}.csv", exact["contact_time"], n) for n in PER_DECADE]
        return [distance(vcor.Case(text_of(one)).solve(quantities=quantities), exact) for one in tables]


def draw_tables(waves, count, pool):
    """Errors of so many practical impacts whose plate is a table of data without noise."""
    draw, found = Draw(f"{SEED} tables"), []
    draw_case = such(lambda case: case["plate"]["material"] == "plate" != case["sphere"]["material"]
                     and case["plate"]["waves"] in waves and "viscosity" not in plate_of(case))
    while len(found) < count:
        found += filter(None, pool.map(table_errors, [draw_case(draw) for _ in range(16)], chunksize=1))
    return np.array(found[:count])


# ------------------------------------------------------------------------------------ the document


def table(head, lines, left):
    """A table of Markdown; but for the columns of `left`, aligned to the right."""
    marks = ["---" if i in left else "--:" for i in range(len(head))]
    return "\n".join("| " + " | ".join(map(str, cells)) + " |" for cells in [head, marks, *lines])


def small(value):
    """An error with two digits, and accuracies as they are written."""
    if not math.isfinite(value):
        return ""
    return f"{value:.1e}".replace("e-0", "e-").replace("e+00", "").replace("1.0e-", "1e-")


def families_table(families):
    """The families, and how well the best solution is confirmed."""
    lines = []
    for name, about, impacts in families:
        apart = sorted(one.apart for one in impacts if math.isfinite(one.apart))
        ends = [small(apart[int(0.9 * len(apart))]), small(apart[-1])] if apart else ["", ""]
        lines.append([name, about, len(impacts), len(apart) or "", *ends])
    head = ["family", "what it is", "impacts", "compared with `direct`", "nine of ten within", "all within"]
    return table(head, lines, {0, 1})


def results_table(families):
    """Verdicts on the runs."""
    lines = []
    for name, _, impacts in families:
        for i, run in enumerate(impacts[0].verdicts):
            counts = [sum(verdict in one.verdicts[run] for one in impacts) for verdict in VERDICTS]
            worst = max((one.errors[run] for one in impacts if run in one.errors), default=math.nan)
            first = ["", ""] if i else [name, len(impacts)]
            lines.append([*first, f"`{run[0]}` {small(run[1])}", *counts, small(worst)])
    head = ["family", "impacts", "asked for", *VERDICTS.values(), "largest error"]
    return table(head, lines, {0, 2})


def columns_table(families):
    """Largest error of each column over the accuracy, by law: the end of a receding contact is slow."""
    lines = []
    for column, bound in BOUNDS.items():
        for law in ("boltzmann", "receding") if column == "contact_time" else (None,):
            line = [f"`{column}`" + (f", {law}" if law else ""), bound]
            for method, names in (("ive", ("references", "practical", "dashpots")), ("direct", ("references",))):
                for name, _, impacts in families:
                    if name in names:
                        found = [one.shares[run][column] for one in impacts for run in one.shares
                                 if run[0] == method and law in (None, "receding" if "'receding'" in one.text
                                                                 else "boltzmann")]
                        line.append(f"{max(found):.2g}" if found else "")
            lines.append(line)
    head = ["column", "bound", "`ive`, references", "`ive`, practical", "`ive`, dashpots", "`direct`, references"]
    return table(head, lines, {0})


def tables_table(tables):
    """Errors of impacts with tables of data."""
    lines = [[plates, n, len(column), *map(small, np.quantile(column, (0.5, 0.9, 1.0)))]
             for plates, found in tables.items() for n, column in zip(PER_DECADE, found.T, strict=True)]
    head = ["plates", "points per decade", "impacts", "median error", "nine of ten within", "largest of these"]
    return table(head, lines, {0})


def remarkable(families):
    """The impacts that are refused, missed, contradicted, or whose error is stated too small."""
    for name, _, impacts in families:
        for one in impacts:
            bad = {run: verdict & {"refused", "missed", "small"} for run, verdict in one.verdicts.items()}
            if one.error == one.apart or any(bad.values()):
                yield (f"! {name}: cor {one.best.get('cor')}, cor_sphere {one.best.get('cor_sphere')}, "
                       f"known to {one.error:.1e}, direct is {one.apart:.1e} away")
                yield from (f"! {run[0]} {run[1]:g}: {', '.join(sorted(verdict))}, error "
                            f"{one.errors.get(run, math.nan):.1e}" for run, verdict in bad.items() if verdict)
                yield one.text


def write(blocks):
    """Put the blocks into the document."""
    text = DOCUMENT.read_text()
    for name, block in blocks.items():
        pattern = rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)"
        text, count = re.subn(pattern, rf"\g<1>\n{block}\n\n\g<2>", text, flags=re.DOTALL)
        if count != 1:
            sys.exit(f"accuracy_families: {DOCUMENT.name} has {count} blocks '{name}', expected one")
    DOCUMENT.write_text(text)
    print(f"written {DOCUMENT.relative_to(TOP)}")


def main():
    """Draw, solve, and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="families, separated by commas")
    parser.add_argument("--share", type=float, default=1.0, help="share of the impacts of each family")
    parser.add_argument("--cases", type=Path, help="file for the impacts with something to see")
    options = parser.parse_args()
    only = options.only.split(",") if options.only else ["references", *(one.name for one in FAMILIES), "tables"]
    families, tables = [], {}
    with multiprocessing.Pool() as pool:
        if "references" in only:
            families += references(pool)
        for family in (family for family in FAMILIES if family.name in only):
            impacts = draw_family(family, math.ceil(family.count * options.share), pool)
            families.append((family.name, family.about, impacts))
            print(f"{family.name}: {len(impacts)} impacts", flush=True)
        if "tables" in only:
            tables = {plates: draw_tables(waves, math.ceil(60 * options.share), pool)
                      for plates, waves in PLATES.items()}
    if options.cases:
        options.cases.write_text("\n".join(remarkable(families)) + "\n")
    blocks = {"families": families_table(families), "results": results_table(families),
              "columns": columns_table(families), "tables": tables_table(tables)}
    if options.only:
        print("\n\n".join(blocks.values()))
    else:
        write(blocks)


if __name__ == "__main__":
    main()
