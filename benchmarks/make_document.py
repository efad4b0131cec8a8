#!/usr/bin/env python3
"""Write the tables of docs/measured.md, between its markers, and docs/performance.svg.

    make_document.py FOLDER      with accuracy.csv, modes.csv and comparison.csv, or sweeps.csv, or
                                 all of them

Run by make_document.sh. The figure needs matplotlib.
"""

import csv
import math
import pathlib
import platform
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
DOCUMENT = TOP / "docs" / "measured.md"
FIGURE = TOP / "docs" / "performance.svg"

STYLE = TOP / "python/src/vcor/vcor.mplstyle"
# Colour and name of each impact, symbol and name of each other solver
PROBLEMS = {
    "sls": ("C0", "SLS"),
    "butyl_prony": ("C1", "Prony series"),
    "butyl_cerf": ("C2", "CERF"),
    "butyl_power_law": ("C3", "power law"),
}
SHAPES = {"cvode": ("^", "CVODE"), "runge_kutta": ("D", "Runge-Kutta"), "solve_ivp": ("s", "solve_ivp")}


def read(path):
    """The rows of a file."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def table(head, lines, right):
    """A table of Markdown; the columns of `right` are aligned to the right."""
    marks = ["--:" if i in right else "---" for i in range(len(head))]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in [head, marks, *lines])


def cost(text):
    """A time with three digits."""
    value = float(text)
    place = 2 - math.floor(math.log10(value))
    return f"{round(value, place):,.{max(place, 0)}f}".replace(",", " ")


def small(text):
    """An error with two digits."""
    return f"{float(text):.1e}"


# Tables


def comparison_table(rows):
    """The solvers at the same error."""
    base = {}
    for row in rows:
        if row["solver"] == "vcor ive" or (
            row["solver"] == "vcor ive as prony" and row["problem"] not in base
        ):
            base[row["problem"]] = float(row["microseconds"])
    lines = [
        [
            f"`{row['problem']}`",
            row["solver"].replace("_", "\\_"),
            small(row["error"]),
            cost(row["microseconds"]),
            f"{float(row['microseconds']) / base[row['problem']]:.1f}"
            if row["problem"] in base
            else "",
            row["steps"],
            row["settings"],
        ]
        for row in rows
    ]
    head = ["problem", "solver", "error of COR", "µs per impact", "ratio", "steps", "settings"]
    return table(head, lines, {2, 3, 4, 5})


def accuracy_table(rows):
    """Time and true error over the accuracy, a method and problem per pair of columns."""
    accuracies = sorted({row["accuracy"] for row in rows}, key=float, reverse=True)
    found = {(r["method"], r["problem"], r["accuracy"]): r for r in rows}
    tables = []
    for method in dict.fromkeys(row["method"] for row in rows):
        problems = list(dict.fromkeys(r["problem"] for r in rows if r["method"] == method))
        head = ["accuracy"]
        for problem in problems:
            head += [f"`{problem}`, µs", "error"]
        lines = []
        for accuracy in accuracies:
            line = [accuracy]
            for problem in problems:
                row = found.get((method, problem, accuracy))
                line += [cost(row["microseconds"]), small(row["error"])] if row else ["", ""]
            lines.append(line)
        tables.append(f"Method `{method}`:\n\n{table(head, lines, set(range(len(head))))}")
    return "\n\n".join(tables)


def modes_table(rows):
    """Time over the number of modes."""
    lines = [
        [row["modes"], cost(row["microseconds"]), row["steps"], row["cor"], small(row["estimate"])]
        for row in rows
    ]
    head = ["modes", "µs per impact", "panels", "COR", "estimated error"]
    return table(head, lines, set(range(len(head))))


def models_table(rows):
    """Time of the exact models compared with the paper's, a column per model."""
    models = list(dict.fromkeys((row["waves"], row["law"]) for row in rows))
    found = {(r["problem"], r["waves"], r["law"]): float(r["microseconds"]) for r in rows}
    lines = []
    for problem in dict.fromkeys(row["problem"] for row in rows):
        paper = found[problem, "relaxing", "boltzmann"]
        line = [f"`{problem}`"]
        for model in models:
            time = found[(problem, *model)]
            line.append(cost(time) if time == paper else f"{cost(time)} ({time / paper:.1f})")
        lines.append(line)
    head = ["problem"] + [f"{waves}, {law}" for waves, law in models]
    return table(head, lines, set(range(1, len(head))))


def points_table(rows):
    """Time and memory of whole sweeps over their points, one thread, both files."""
    lines = [
        [
            f"{int(row['points']):,}".replace(",", " "),
            f"{float(row['cpu']):.2f}",
            cost(str(1e6 * float(row["cpu"]) / int(row["points"]))),
            f"{float(row['memory']):.0f}",
            f"{float(row['csv']):.1f}",
            f"{float(row['hdf5']):.1f}",
        ]
        for row in rows
        if [row[name] for name in ("files", "programs", "ranks", "threads")] == ["both", "1", "0", "1"]
    ]
    head = ["points", "CPU time, s", "µs per point", "memory, MB", "CSV, MB", "HDF5, MB"]
    return table(head, lines, range(6))


def speedup_table(rows):
    """Whole sweeps by two threads and two ranks, by the clock on the wall, and two programs at
    once, which share nothing: what the machine can give."""
    one, lines = {}, []
    for row in rows:
        key = (row["points"], row["files"], row["ranks"] != "0")
        seconds = float(row["seconds"])
        if row["programs"] == "2":
            way, gain = "2 programs", 2.0 * one[key] / seconds
        elif row["ranks"] == "2" or row["threads"] == "2":
            way = "2 ranks" if row["ranks"] == "2" else "2 threads"
            gain = one[key] / seconds
        else:
            one[key] = seconds
            continue
        points = f"{int(row['points']):,}".replace(",", " ")
        lines.append(
            [points, row["files"], way, f"{one[key]:.2f}", f"{seconds:.2f}", f"{gain:.2f}"]
        )
    head = ["points", "files", "by", "one, s", "two, s", "times as much per second"]
    return table(head, lines, {0, 3, 4, 5})


def first_line(*command):
    """The first line that a command prints, or nothing."""
    try:
        return subprocess.run(command, capture_output=True, text=True).stdout.splitlines()[0]
    except (OSError, IndexError):
        return ""


def machine():
    """The machine on which it ran."""
    try:
        info = pathlib.Path("/proc/cpuinfo").read_text()
        processor = re.search(r"model name\s*:\s*(.*)", info).group(1)
    except (OSError, AttributeError):
        processor = platform.machine()
    parts = [processor, first_line("gfortran", "--version"), "`-O3`"]
    try:
        import numpy
        import scipy

        parts.append(f"SciPy {scipy.__version__} with NumPy {numpy.__version__}")
    except ImportError:
        pass
    cache = TOP / "build" / "release" / "CMakeCache.txt"
    text = cache.read_text() if cache.exists() else ""
    version = re.search(r"^VCOR_SUNDIALS_VERSION:\w+=(.+)$", text, re.M)
    if version:
        parts.append(f"SUNDIALS {version.group(1)}")
    return ", ".join(part for part in parts if part) + "."


# Figure


def figure(accuracy, comparison, modes):
    """Write error over time, and time over modes."""
    # only who has measured anew needs it
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(fname=STYLE):
        made = Figure(figsize=(6.7, 3.2), layout="constrained")
        left, right = made.subplots(1, 2, width_ratios=(2, 1))
        for problem, (colour, name) in PROBLEMS.items():
            for method, line in (("ive", "-"), ("direct", "--")):
                # several accuracies can give the same panels; an error of rounding is at the edge
                points = {
                    row["error"]: (float(row["microseconds"]), max(float(row["error"]), 1.1e-13))
                    for row in accuracy
                    if (row["problem"], row["method"]) == (problem, method)
                }
                if points:
                    label = name if method == "ive" else ""
                    left.loglog(*zip(*points.values()), color=colour, ls=line, marker=".", label=label)
        for row in comparison:
            if row["solver"] in SHAPES:
                colour, _ = PROBLEMS[row["problem"]]
                at = float(row["microseconds"]), float(row["error"])
                left.loglog(*at, color=colour, ls="", marker=SHAPES[row["solver"]][0], mfc="white", ms=5)
        for line, name in (("-", "ive"), ("--", "direct")):
            left.plot([], [], color="0.3", ls=line, marker=".", label=name)
        for shape, name in SHAPES.values():
            left.plot([], [], color="0.3", ls="", marker=shape, mfc="white", ms=5, label=name)
        left.set(xlabel="time per impact [\N{MICRO SIGN}s]", ylabel="error of the COR",
                 xlim=(1, 1e6), ylim=(1e-13, 1e-4), title="(a) cost of accuracy")  # fmt: skip
        made.legend(ncols=5, loc="outside upper center")
        points = [(float(row["modes"]), float(row["microseconds"])) for row in modes]
        right.loglog(*zip(*points), color="C0", ls="-", marker=".")
        right.set_xscale("log", base=2)
        right.set(xlabel="terms of the Prony series", ylabel="time per impact [\N{MICRO SIGN}s]",
                  ylim=(1, 1e3), title="(b) cost of terms")  # fmt: skip
        right.xaxis.set_major_formatter("{x:.0f}")
        made.savefig(FIGURE, metadata={"Date": None})


def main():
    """Write both."""
    if len(sys.argv) != 2:
        sys.exit("usage: make_document.py FOLDER")
    folder = pathlib.Path(sys.argv[1])
    blocks = {"machine": machine()}
    if (folder / "comparison.csv").exists():
        accuracy, modes, comparison = (
            read(folder / f"{name}.csv") for name in ("accuracy", "modes", "comparison")
        )
        blocks["comparison"] = comparison_table(comparison)
        blocks["accuracy"] = accuracy_table(accuracy)
        blocks["modes"] = modes_table(modes)
        blocks["models"] = models_table(read(folder / "models.csv"))
        figure(accuracy, comparison, modes)
        print(f"written {FIGURE.relative_to(TOP)}")
    # whole sweeps, where they were measured
    if (folder / "sweeps.csv").exists():
        sweeps = read(folder / "sweeps.csv")
        blocks["points"] = points_table(sweeps)
        blocks["speedup"] = speedup_table(sweeps)
    text = DOCUMENT.read_text()
    for name, block in blocks.items():
        pattern = rf"(<!-- {name} -->\n).*?(<!-- /{name} -->)"
        text, count = re.subn(pattern, lambda m: f"{m[1]}\n{block}\n\n{m[2]}", text, flags=re.S)
        if count != 1:
            sys.exit(f"make_document: {DOCUMENT.name} has {count} blocks '{name}', expected one")
    DOCUMENT.write_text(text)
    print(f"written {DOCUMENT.relative_to(TOP)}")


if __name__ == "__main__":
    main()
