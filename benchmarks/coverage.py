"""How often the 95 % profile intervals of `vcor.identify` hold the truth.

    python benchmarks/coverage.py [MODEL ...] [--draws N] [--noise 0.01]

Data are those of python/tests/data, by another solver, with seeded normal noise. Of 300 draws 285 are
expected to hold each parameter, and at least 273 with a probability of 0.999; more is right where an
interval ends at the limit of a parameter's range. Needs the package with scipy, and python/tests.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

TESTS = Path(__file__).parents[1] / "python" / "tests"
sys.path.insert(0, str(TESTS))

import test_identify as cases  # noqa: E402

import vcor  # noqa: E402
from vcor.data import Data  # noqa: E402


def coverage(model, draws, noise):
    """Draws whose intervals hold each parameter, how many were refused, and of how many."""
    clean = Data(TESTS / "data" / f"impacts_of_{model}.csv").columns
    truth = cases.TRUTH[model]
    free = [f"rubber.{key}" for key in truth]
    errors = {"cor": noise, "contact_time": noise}
    held, refused = np.zeros(len(truth), int), 0
    for draw in range(draws):
        rng = np.random.default_rng(draw)
        data = dict(clean)
        for name in errors:
            data[name] = clean[name] * (1 + noise * rng.normal(size=len(clean[name])))
        try:
            found = vcor.identify(cases.guess(model), data, free, errors=errors)
        except vcor.NumericalError as error:
            refused += 1
            print(f"draw {draw}: {error}", file=sys.stderr)
            continue
        for i, (one, value) in enumerate(zip(found.estimates, truth.values(), strict=True)):
            held[i] += one.interval_95[0] <= value <= one.interval_95[1]
    return dict(zip(truth, held.tolist(), strict=True)), refused


def main():
    """Print a row per model."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", default=list(cases.TRUTH))
    parser.add_argument("--draws", type=int, default=300)
    parser.add_argument("--noise", type=float, default=0.01)
    options = parser.parse_args()
    for model in options.models:
        held, refused = coverage(model, options.draws, options.noise)
        rows = ", ".join(f"{name} {count}" for name, count in held.items())
        print(f"{model}: {rows} of {options.draws - refused}, {refused} refused", flush=True)


if __name__ == "__main__":
    main()
