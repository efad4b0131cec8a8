"""Write docs/receding.svg: force over indentation for both contact laws, the paper's SLS case.

    VCOR=build/release/vcor python docs/make_receding.py
"""

import csv
import os
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
VCOR = os.environ.get("VCOR", str(ROOT / "build" / "release" / "vcor"))
FIGURE = ROOT / "docs" / "receding.svg"

WIDTH, HEIGHT = 640, 400
LEFT, RIGHT, TOP, BOTTOM = 70, 20, 20, 55
LARGEST = 6.0, 800.0  # mm, N
# plate model, contact law, colour, dashes
CURVES = [
    ("none", "boltzmann", "#1f77b4", "6 4"),
    ("none", "receding", "#1f77b4", ""),
    ("hereditary", "boltzmann", "#d62728", "6 4"),
    ("hereditary", "receding", "#d62728", ""),
]
NAMES = {"none": "no waves", "hereditary": "thin plate"}


def history(waves, law):
    """Indentation [mm] and force [N] over time."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["--set", f"plate.waves={waves}", "--set", f"contact.law={law}"]
        words += ["--set", "output.hdf5=false", "--output", folder, "--quiet"]
        case = ROOT / "examples" / "paper" / "sls.nml"
        subprocess.run([VCOR, "run", str(case), *words], check=True)
        lines = (Path(folder) / "sls.csv").read_text("utf-8").splitlines()
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    return [(1e3 * float(row["indentation"]), float(row["force"])) for row in rows]


def place(x, y):
    """Position in the figure."""
    return (
        LEFT + x / LARGEST[0] * (WIDTH - LEFT - RIGHT),
        HEIGHT - BOTTOM - y / LARGEST[1] * (HEIGHT - TOP - BOTTOM),
    )


def text(x, y, words, anchor="middle", more=""):
    """A text."""
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{more}>{words}</text>'


def figure():
    """The figure as SVG."""
    right, bottom = place(LARGEST[0], 0.0)
    parts = []
    for i in range(7):
        x, _ = place(i, 0.0)
        parts.append(f'<path d="M{x:.1f} {TOP}V{bottom:.1f}" stroke="#ddd"/>')
        parts.append(text(x, bottom + 18, str(i)))
    for force in range(0, 801, 100):
        _, y = place(0.0, force)
        parts.append(f'<path d="M{LEFT} {y:.1f}H{right:.1f}" stroke="#ddd"/>')
        parts.append(text(LEFT - 8, y + 4, str(force), "end"))
    parts.append(
        f'<rect x="{LEFT}" y="{TOP}" width="{right - LEFT:.1f}" height="{bottom - TOP:.1f}" '
        'fill="none" stroke="#000"/>'
    )
    parts.append(text((LEFT + right) / 2, bottom + 40, "indentation, mm"))
    middle = (TOP + bottom) / 2
    parts.append(text(20, middle, "force, N", more=f' transform="rotate(-90 20 {middle:.1f})"'))
    for i, (waves, law, colour, dashes) in enumerate(CURVES):
        points = [place(x, y) for x, y in history(waves, law)]
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
        line = f'fill="none" stroke="{colour}" stroke-width="1.6"'
        if dashes:
            line += f' stroke-dasharray="{dashes}"'
        parts.append(f'<path d="M{path}" {line}/>')
        x, y = LEFT + 20, TOP + 22 + 18 * i
        parts.append(f'<path d="M{x} {y}H{x + 34}" {line}/>')
        parts.append(text(x + 42, y + 4, f"{NAMES[waves]}, {law}", "start"))
    body = "\n".join(parts)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" '
        f'viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="12">\n'
        "<title>Contact force over indentation for both contact laws</title>\n"
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>\n{body}\n</svg>\n'
    )


if __name__ == "__main__":
    FIGURE.write_text(figure(), "utf-8")
