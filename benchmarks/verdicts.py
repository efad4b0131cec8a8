#!/usr/bin/env python3
"""How far each verdict is off: draws impacts, solves them with exact mechanics, and prints a table.

    verdicts.py [--seed N] [--count 300] [--only CLASS;...] [--worst N] [--write [TABLE]]

Radius 0.5 to 20 mm, velocity 0.1 to 20 m/s, thickness 0.3 to 20 radii, all log-uniform; the materials of
examples/materials, and power laws and Prony series with loss tangents up to 1 at the frequency of the contact. Other
shapes are cones, punches, bodies of revolution and true spheres of the same mass, on plates and half spaces, half of
them with their weight.
Impacts whose cor_sphere, as computed or exact, is below 0.02 are drawn again. Only `cor_deviation` is judged here,
without the measures of other things (contact_ratio, extent). --worst prints the impacts of each class that
are farthest from their prediction. --write puts the table into docs/measured.md, and how many verdicts of all classes
together are right into the sentences of the help, the legend of figures, the FAQ and that page; with a file it takes
the table that was printed into it. Takes about ten minutes. Needs the Python package (PYTHONPATH=python/src and
VCOR_LIBRARY=build/release/libvcor_python.so will do).
"""

import argparse
import math
import os
import re
import sys
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np  # noqa: E402

import vcor  # noqa: E402

TOP = Path(__file__).resolve().parent.parent
#: Waves, law and pair that a class prescribes, or None where they are drawn
CLASSES = {
    "paper": ("relaxing", "boltzmann", "eq1"),
    "hereditary": ("hereditary", "receding", "series"),
    "constant": ("constant", None, None),
    "none, plates": ("none", None, None),
    "none, half spaces": ("none", None, None),
    "none, layers": ("none", None, None),
    "pairs of beads": ("none", None, None),
    "other shapes": ("none", None, None),
}
#: Smallest restitution that is drawn, and largest loss tangent
LEAST, LOSSY = 0.02, 1.0
#: Share of cor_sphere and least change that each level allows
GOOD, CAUTION = (0.02, 0.01), (0.1, 0.05)


@dataclass(frozen=True)
class Material:
    """One material: its namelist without the name, and what drawing needs to know."""

    text: str
    #: kg/m3
    density: float
    elastic: bool = False
    rigid: bool = False


@dataclass
class Impact:
    """One impact: its case, the restitution computed and exact, and the change predicted."""

    case: str
    computed: float
    exact: float
    predicted: float

    def excess(self, limit: tuple[float, float]) -> float:
        """Difference to the exact restitution over a limit, which is a share of the computed one."""
        return abs(self.exact - self.computed) / max(
            limit[0] * self.computed, limit[1]
        )

    def is_within(self, limit: tuple[float, float]) -> bool:
        """Whether the exact restitution is within a limit."""
        return self.excess(limit) <= 1.0

    def level(self) -> str:
        """The verdict by the predicted change alone."""
        for name, (share, least) in (("good", GOOD), ("caution", CAUTION)):
            if abs(self.predicted) <= max(share * self.computed, least):
                return name
        return "outside"


def examples() -> list[Material]:
    """The materials of examples/materials, at their reference temperature."""
    found = []
    for path in sorted((TOP / "examples" / "materials").glob("*.nml")):
        lines = [
            line.split("!")[0].strip()
            for line in path.read_text(encoding="utf-8").splitlines()
        ]
        skip = (
            "&",
            "/",
            "name",
            "shift",
            "reference_temperature",
            "wlf",
            "yield_strength",
        )
        keys = [line for line in lines if line and not line.startswith(skip)]
        text = ", ".join(keys)
        density = float(re.search(r"density *= *([0-9.e]+)", text)[1])
        found.append(Material(text, density, elastic="'elastic'" in text))
    return found


def relaxing(rng: np.random.Generator) -> Material:
    """A power law or a Prony series of 1 to 5 terms, none of them stiffer than a hard polymer at 1 us."""
    ratio = rng.choice([0.35, 0.45, 0.5])
    least = 10 ** rng.uniform(5.5, 9.3)
    if rng.random() < 0.4:
        # the relaxing part relative to the equilibrium modulus, at 10 us
        exponent = rng.uniform(0.1, 0.6)
        strength = min(least * 10 ** rng.uniform(-2, 1.5), 5e9) * 1e-5**exponent
        text = f"model = 'power_law', equilibrium_modulus = {least:.6e}, coefficient = {strength:.6e}, exponent = {exponent:.4f}"
    else:
        count = rng.integers(1, 6)
        moduli = ", ".join(
            f"{least * 10 ** rng.uniform(-1.5, 0.7):.6e}" for _ in range(count)
        )
        rates = ", ".join(f"{10 ** rng.uniform(1, 6):.6e}" for _ in range(count))
        text = f"model = 'prony', equilibrium_modulus = {least:.6e}, moduli = {moduli}, rates = {rates}"
    return Material(f"{text}, poisson_ratio = {ratio}, density = 1100.0", 1100.0)


def rigid(rng: np.random.Generator) -> Material:
    """A rigid ball as heavy as one of glass, ceramic or steel."""
    density = rng.choice([2500.0, 4000.0, 7800.0])
    return Material(f"model = 'rigid', density = {density}", density, rigid=True)


def shape(rng: np.random.Generator, radius: float, density: float) -> str:
    """A body that is not a paraboloid, as heavy as the ball of this radius and about as blunt."""
    name = rng.choice(["cone", "punch", "power", "true_sphere"])
    if name == "true_sphere":
        return f"shape = 'true_sphere', radius = {radius:.6e}"
    mass = 4 / 3 * math.pi * radius**3 * density
    if name == "cone":
        key = f"half_angle = {rng.uniform(45, 85):.3f}"
    elif name == "punch":
        key = f"punch_radius = {radius * rng.uniform(0.05, 0.5):.6e}"
    else:
        power = rng.uniform(1.2, 6)
        key = f"profile_power = {power:.4f}, profile_coefficient = {0.5 * radius ** (1 - power):.6e}"
    return f"shape = '{name}', mass = {mass:.6e}, {key}"


def draw(name: str, rng: np.random.Generator, known: list[Material]) -> tuple[str, str]:
    """An impact of a class: its case with the mechanics of the class, and with exact ones."""

    def any_of() -> Material:
        return known[rng.integers(len(known))] if rng.random() < 0.5 else relaxing(rng)

    gravity, body = "0", ""
    radius, velocity = 5e-4 * 40 ** rng.random(), 0.1 * 200 ** rng.random()
    thickness = radius * 0.3 * (20 / 0.3) ** rng.random()
    hard = [one for one in known if one.elastic]
    ball = (
        rigid(rng)
        if rng.random() < 0.25
        else hard[rng.integers(len(hard))]
        if rng.random() < 0.6
        else any_of()
    )
    plate = any_of()
    waves, law, pair = CLASSES[name]
    while waves == "constant" and "power_law" in plate.text:
        # infinitely stiff at first, so it would not move
        plate = any_of()
    law = law or rng.choice(["boltzmann", "receding"])
    pair = pair or rng.choice(["eq1", "series"])
    of_plate, mass = f"thickness = {thickness:.6e}", ""
    if name == "none, half spaces":
        of_plate = ""
    elif name == "none, layers":
        of_plate += f", base = '{rng.choice(['bonded', 'sliding'])}'"
        if not (plate.elastic and (ball.elastic or ball.rigid)):
            # a layer that relaxes needs a rigid ball
            ball = rigid(rng)
    elif name == "pairs of beads":
        if ball.rigid:
            ball = any_of()
        other = radius * rng.choice([1.0, 3.0])
        masses = ball.density * radius**3, plate.density * other**3
        of_plate = f"surface_radius = {other:.6e}"
        mass = f", mass = {4 / 3 * math.pi * masses[0] * masses[1] / sum(masses):.6e}"
    elif name == "other shapes":
        body = shape(rng, radius, ball.density)
        gravity = rng.choice(["0", "9.81"])
        if rng.random() < 0.5:
            of_plate = ""

    def text(waves: str, law: str, pair: str) -> str:
        return (
            f"&impact velocity = {velocity:.6e}, gravity = {gravity} /\n"
            f"&sphere {body or f'radius = {radius:.6e}'}, material = 'ball'{mass} /\n"
            f"&plate material = 'plate', waves = '{waves}'{', ' if of_plate else ''}{of_plate} /\n"
            f"&contact law = '{law}', pair = '{pair}' /\n"
            f"&material name = 'ball', {ball.text} /\n&material name = 'plate', {plate.text} /\n"
        )

    exact = "receding"
    if "'punch'" in body:
        # its contact has one radius
        exact = law = "boltzmann"
    return text(waves, law, pair), text("none" if mass else "body", exact, "series")


def solve(name: str, rng: np.random.Generator, known: list[Material]) -> Impact | None:
    """Draw and solve an impact; None if it has no restitution, or too small a one, or too large a loss tangent."""
    case, with_exact = draw(name, rng, known)
    try:
        computed = vcor.Case(case).solve()
        if (
            str(computed["status"]) != "separated"
            or not float(computed["peak_loss_tangent"]) <= LOSSY
        ):
            return None
        exact = vcor.Case(with_exact).solve()
    except vcor.NumericalError:
        return None
    values = float(computed["cor_sphere"]), float(exact["cor_sphere"])
    if str(exact["status"]) != "separated" or not min(values) > LEAST:
        return None
    return Impact(case, *values, float(computed["cor_deviation"]))


def share(part: list[Impact], whole: list[Impact]) -> str:
    """How many of how many."""
    return (
        f"{len(part)}/{len(whole)} = {100 * len(part) / len(whole):.0f} %"
        if whole
        else "-"
    )


HEAD = (
    "| class | `good` within 2 % or 0.01 | worst, times that | `caution` within 10 % or 0.05 | of those within 2 % or "
    "0.01, `good` | of those far off, `outside` | far off and `good` |\n"
    "| --- | --- | --: | --- | --- | --- | --: |"
)
#: Sentences with the shares of `good` and `caution` that are right, in 100: the text before the number and after it
SENTENCES = {
    "app/screen.f90": (
        (r"\(", r" of 100 random impacts\), caution", "good"),
        (r"\(", r" of 100\), outside", "caution"),
    ),
    "python/src/vcor/plot.py": (
        ("with caution: ", " of 100 within 10 %", "caution"),
    ),
    "docs/faq.md": (
        (r"the model's \(", r" of 100 random\n", "good"),
        (r"exact mechanics, ", r" of 100 with `caution` within", "caution"),
    ),
    "docs/validity.md": (
        (r"`good` means within 2 % or 0.01 \(", r" of 100\)", "good"),
        (r"`caution` within\n  10 % or 0.05 \(", r" of 100\)", "caution"),
    ),
}


def shares(table: str) -> dict[str, int]:
    """Right verdicts of all classes of a table together, in 100, rounded down."""
    found = {}
    for verdict, column in (("good", 2), ("caution", 4)):
        counts = [
            re.match(r" (\d+)/(\d+)", line.split("|")[column])
            for line in table.splitlines()
        ]
        known = [one for one in counts if one]
        right, all_of = (sum(int(one[i]) for one in known) for i in (1, 2))
        found[verdict] = 100 * right // all_of
    return found


def table_of_page() -> str:
    """The table in docs/measured.md."""
    page = (TOP / "docs/measured.md").read_text(encoding="utf-8")
    start = page.index(HEAD)
    return page[start : page.index("\n\n", start)]


def places(table: str) -> Iterator[tuple[Path, str, str]]:
    """Each file with a sentence, what it says and what it should say."""
    found = shares(table)
    for name, sentences in SENTENCES.items():
        path = TOP / name
        text = path.read_text(encoding="utf-8")
        for before, after, verdict in sentences:
            matches = re.findall(rf"{before}(\d+){after}", text)
            if len(matches) != 1:
                raise LookupError(f"{name} has {len(matches)} sentences '{before}N{after}', expected one")
        right = text
        for before, after, verdict in sentences:
            right = re.sub(rf"({before})\d+({after})", rf"\g<1>{found[verdict]}\g<2>", right)
        yield path, text, right


def write(table: str) -> None:
    """Put a table and its sentences into the pages."""
    path = TOP / "docs/measured.md"
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace(table_of_page(), table.strip()), encoding="utf-8")
    for file, _, right in places(table):
        file.write_text(right, encoding="utf-8")


def report(name: str, impacts: list[Impact]) -> str:
    """How far each verdict of a class is off, a row of the table."""
    by = {
        level: [one for one in impacts if one.level() == level]
        for level in ("good", "caution", "outside")
    }
    close = [one for one in impacts if one.is_within(GOOD)]
    far = [one for one in impacts if not one.is_within(CAUTION)]
    worst = max((one.excess(GOOD) for one in by["good"]), default=0.0)
    cells = [
        name,
        share([one for one in by["good"] if one.is_within(GOOD)], by["good"]),
        f"{worst:.1f}",
        share([one for one in by["caution"] if one.is_within(CAUTION)], by["caution"]),
        share([one for one in close if one.level() == "good"], close),
        share([one for one in far if one.level() == "outside"], far),
        str(len([one for one in far if one.level() == "good"])),
    ]
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    """Draw, solve and print."""
    warnings.simplefilter("ignore", vcor.ValidityWarning)
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seed", type=int, default=1, help="seed of the impacts")
    parser.add_argument("--count", type=int, default=300, help="impacts of each class")
    parser.add_argument("--only", default="", help="classes, separated by commas")
    parser.add_argument(
        "--worst", type=int, default=0, help="impacts to print of each class"
    )
    parser.add_argument(
        "--write", nargs="?", const="", metavar="TABLE", help="write the pages; from a table"
    )
    options = parser.parse_args()
    if options.write:
        write(Path(options.write).read_text(encoding="utf-8"))
        return
    known = examples()
    lines = [HEAD]
    print(HEAD)
    for index, name in enumerate(CLASSES):
        if options.only and not any(
            name.startswith(one) for one in options.only.split(";")
        ):
            continue
        rng = np.random.default_rng([options.seed, index])
        impacts: list[Impact] = []
        while len(impacts) < options.count:
            one = solve(name, rng, known)
            if one is not None:
                impacts.append(one)
        lines.append(report(name, impacts))
        print(lines[-1], flush=True)
        impacts.sort(key=lambda one: -abs(one.exact - one.computed - one.predicted))
        for one in impacts[: options.worst]:
            print(
                f"computed {one.computed:.4f}, exact {one.exact:.4f}, predicted {one.computed + one.predicted:.4f}\n{one.case}",
                file=sys.stderr,
            )
    if options.write is not None:
        write("\n".join(lines))


if __name__ == "__main__":
    main()
