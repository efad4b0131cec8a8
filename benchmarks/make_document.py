#!/usr/bin/env python3
"""Write the tables of docs/performance.md, between its markers, and docs/performance.svg.

    make_document.py FOLDER      with accuracy.csv, modes.csv and comparison.csv, or sweeps.csv, or
                                 all of them

Standard library only. Run by make_document.sh.
"""

import csv
import math
import pathlib
import platform
import re
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parent.parent
DOCUMENT = TOP / "docs" / "performance.md"
FIGURE = TOP / "docs" / "performance.svg"

COLOURS = {
    "sls": "#1f77b4",
    "butyl_prony": "#d62728",
    "butyl_cerf": "#2ca02c",
    "butyl_power_law": "#9467bd",
}


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
    """What it ran on."""
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


class Axes:
    """A box with two logarithmic axes."""

    def __init__(self, left, top, width, height, x, y):
        self.left, self.top, self.width, self.height = left, top, width, height
        self.x, self.y = x, y
        self.parts = []

    def at(self, x, y):
        """Where a point is."""
        a = (math.log(x) - math.log(self.x[0])) / (math.log(self.x[1]) - math.log(self.x[0]))
        b = (math.log(y) - math.log(self.y[0])) / (math.log(self.y[1]) - math.log(self.y[0]))
        return self.left + a * self.width, self.top + (1.0 - b) * self.height

    def grid(self, x_ticks, y_ticks, x_label, y_label):
        """Lines, labels and the box."""
        bottom, right = self.top + self.height, self.left + self.width
        for value, text in x_ticks:
            x = self.at(value, self.y[0])[0]
            self.parts.append(f'<path d="M{x:.1f} {self.top}V{bottom}" stroke="#ddd"/>')
            self.text(x, bottom + 18, text, "middle")
        for value, text in y_ticks:
            y = self.at(self.x[0], value)[1]
            self.parts.append(f'<path d="M{self.left} {y:.1f}H{right}" stroke="#ddd"/>')
            self.text(self.left - 8, y + 4, text, "end")
        self.parts.append(
            f'<rect x="{self.left}" y="{self.top}" width="{self.width}" height="{self.height}" '
            'fill="none" stroke="#000"/>'
        )
        self.text(self.left + self.width / 2, bottom + 38, x_label, "middle")
        x, y = self.left - 48, self.top + self.height / 2
        self.parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="middle" '
            f'transform="rotate(-90 {x:.1f} {y:.1f})">{y_label}</text>'
        )

    def text(self, x, y, text, anchor="start", colour="#000"):
        """A label."""
        self.parts.append(
            f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{text}</text>'
        )

    def line(self, points, colour, dashes=""):
        """A polyline through points of the axes."""
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in (self.at(*point) for point in points))
        style = f' stroke-dasharray="{dashes}"' if dashes else ""
        self.parts.append(
            f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="1.5"{style}/>'
        )

    def mark(self, x, y, shape, colour):
        """A symbol at a point of the axes."""
        self.symbol(*self.at(x, y), shape, colour)

    def symbol(self, x, y, shape, colour):
        """A symbol."""
        shapes = {
            "circle": f"M{x - 3:.1f} {y:.1f}a3 3 0 1 0 6 0a3 3 0 1 0 -6 0z",
            "square": f"M{x - 4:.1f} {y - 4:.1f}h8v8h-8z",
            "triangle": f"M{x:.1f} {y - 5:.1f}l5 9h-10z",
            "diamond": f"M{x:.1f} {y - 5:.1f}l5 5l-5 5l-5 -5z",
        }
        fill = colour if shape == "circle" else "#fff"
        self.parts.append(f'<path d="{shapes[shape]}" fill="{fill}" stroke="{colour}"/>')


def power(exponent):
    """A power of ten."""
    return f'10<tspan dy="-5" font-size="9">{str(exponent).replace("-", "−")}</tspan>'


def figure(accuracy, comparison, modes):
    """Error over time, and time over modes."""
    left = Axes(72, 16, 420, 380, (1e0, 1e6), (1e-13, 1e-2))
    left.grid(
        [(10.0**n, power(n)) for n in range(0, 7)],
        [(10.0**n, power(n)) for n in range(-13, -1)],
        "time per impact, µs",
        "error of the COR, absolute",
    )
    for problem, colour in COLOURS.items():
        for method, dashes in (("ive", ""), ("direct", "5 4")):
            # several accuracies can give the same panels
            points = {
                row["error"]: (float(row["microseconds"]), max(float(row["error"]), 1.1e-13))
                for row in accuracy
                if (row["problem"], row["method"]) == (problem, method)
            }
            if points:
                left.line(points.values(), colour, dashes)
                for point in points.values():
                    left.mark(*point, "circle", colour)
    shapes = {"cvode": "triangle", "runge_kutta": "diamond", "solve_ivp": "square"}
    for row in comparison:
        if row["solver"] in shapes:
            left.mark(
                float(row["microseconds"]),
                float(row["error"]),
                shapes[row["solver"]],
                COLOURS[row["problem"]],
            )

    right = Axes(570, 16, 220, 380, (0.9, 300.0), (1e0, 1e3))
    right.grid(
        [(2.0**n, str(2**n)) for n in range(0, 9, 2)],
        [(10.0**n, power(n)) for n in range(0, 4)],
        "terms of the Prony series",
        "time per impact, µs",
    )
    points = [(float(row["modes"]), float(row["microseconds"])) for row in modes]
    right.line(points, "#1f77b4")
    for point in points:
        right.mark(*point, "circle", "#1f77b4")

    x, y = 72, 460
    for i, (problem, colour) in enumerate(COLOURS.items()):
        left.parts.append(f'<path d="M{x + 125 * i} {y}h20" stroke="{colour}" stroke-width="2"/>')
        left.text(x + 125 * i + 26, y + 4, problem)
    y += 22
    for i, (text, dashes) in enumerate((("ive", ""), ("direct", ' stroke-dasharray="5 4"'))):
        left.parts.append(f'<path d="M{x + 125 * i} {y}h20" stroke="#000"{dashes}/>')
        left.text(x + 125 * i + 26, y + 4, text)
    names = {"cvode": "CVODE", "runge_kutta": "Runge-Kutta", "solve_ivp": "solve_ivp"}
    for i, (solver, shape) in enumerate(shapes.items()):
        left.symbol(x + 260 + 125 * i, y, shape, "#000")
        left.text(x + 276 + 125 * i, y + 4, names[solver])

    body = "\n".join(left.parts + right.parts)
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" width="820" height="500" viewBox="0 0 820 500" '
        'font-family="sans-serif" font-size="12">\n'
        "<title>Cost of accuracy, and of internal variables</title>\n"
        f'<rect width="820" height="500" fill="#fff"/>\n{body}\n</svg>\n'
    )


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
        FIGURE.write_text(figure(accuracy, comparison, modes))
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
