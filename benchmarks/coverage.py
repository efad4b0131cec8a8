"""How often the 68 and 95 % profile intervals of `vcor.identify` hold the truth.

    python benchmarks/coverage.py [MODEL ...] [--draws N] [--first SEED] [--noise 0.01] [--write]

Data are those of python/tests/data, by another solver, with seeded normal noise; each seed is one
draw. Of 300 draws 205 +- 8 and 285 +- 4 are expected to hold each parameter; more is right where an
interval ends at the limit of a parameter's range. --write puts the rows into docs/measured.md. Needs the package with scipy,
and python/tests.
"""

import argparse
import re
import sys
from pathlib import Path

import numpy as np

TOP = Path(__file__).parents[1]
TESTS = TOP / "python" / "tests"
DOCUMENT = TOP / "docs" / "measured.md"
sys.path.insert(0, str(TESTS))

import test_identify as cases  # noqa: E402

import vcor  # noqa: E402
from vcor.materials.data import read_data  # noqa: E402


def held(case, data, errors, truth):
    """Whether the intervals hold the true values, shape (2 levels, parameters)."""
    found = vcor.identify(case, data, list(truth), errors=errors)
    ends = np.array([(one.interval_68, one.interval_95) for one in found.estimates])
    values = np.array(list(truth.values()))[:, None]
    return ((ends[..., 0] <= values) & (values <= ends[..., 1])).T


def coverage(model, seeds, noise):
    """Draws whose intervals hold each parameter, of both levels, and how many were refused."""
    table = read_data(TESTS / "data" / f"impacts_of_{model}.csv")
    clean = {key: one.to_numpy() for key, one in table.items()}
    truth = {f"rubber.{key}": value for key, value in cases.TRUTH[model].items()}
    errors = {"cor": noise, "contact_time": noise}
    counts, refused = np.zeros((2, len(truth)), int), 0
    for done, seed in enumerate(seeds, 1):
        rng = np.random.default_rng(seed)
        data = dict(clean)
        for name in errors:
            data[name] = clean[name] * (1 + noise * rng.normal(size=len(clean[name])))
        try:
            counts += held(cases.guess(model), data, errors, truth)
        except vcor.NumericalError as error:
            refused += 1
            print(f"{model}, seed {seed}: {error}", file=sys.stderr)
        if done % 20 == 0:
            print(f"{model}: {counts.tolist()} of {done}", file=sys.stderr, flush=True)
    return dict(zip(truth, counts.T.tolist(), strict=True)), refused


def row(model, counts, draws, refused):
    """The row of a model in Markdown: shares of the draws that are not refused."""
    judged = draws - refused
    names = ", ".join(f"`{name.partition('.')[2]}`" for name in counts)
    shares = [", ".join(f"{100 * both[i] / judged:.0f}" for both in counts.values()) for i in (0, 1)]
    of = f"{judged} of {draws}" if refused else f"{draws}"
    return f"| `{model}`: {names} | {of} | {shares[0]} | {shares[1]} |"


def write(rows):
    """Put the rows into the page, in place of those of the same models."""
    text = DOCUMENT.read_text("utf-8")
    for model, line in rows.items():
        start, rest = text.split("<!-- coverage -->")
        rest, count = re.subn(rf"^\| `{model}`: .*$", lambda _, line=line: line, rest, flags=re.M)
        if count != 1:
            sys.exit(f"coverage: {DOCUMENT.name} has {count} rows of {model}, expected one")
        text = f"{start}<!-- coverage -->{rest}"
    DOCUMENT.write_text(text, "utf-8")


def main():
    """Print a row per model."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", default=list(cases.TRUTH))
    parser.add_argument("--draws", type=int, default=300)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--noise", type=float, default=0.01)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    seeds = range(options.first, options.first + options.draws)
    rows = {}
    for model in options.models:
        counts, refused = coverage(model, seeds, options.noise)
        rows[model] = row(model, counts, options.draws, refused)
        print(rows[model], flush=True)
    if options.write:
        write(rows)


if __name__ == "__main__":
    main()
