"""How often the 95 % profile intervals of `vcor.identify` hold the truth.

    python benchmarks/coverage.py [MODEL ...] [--draws N] [--noise 0.01] [--rise]

Data are those of python/tests/data, by another solver, with seeded normal noise. Of 300 draws 285 are
expected to hold each parameter, and at least 273 with a probability of 0.999; more is right where an
interval ends at the limit of a parameter's range. --rise looks for no interval: it asks whether the
sum of squares with the parameter at its true value, the others fitted, is larger than the least one
by less than 1.96^2, which is the same and a fifth of the work. Needs the package with scipy, and
python/tests.
"""

import argparse
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np

TESTS = Path(__file__).parents[1] / "python" / "tests"
sys.path.insert(0, str(TESTS))

import test_identify as cases  # noqa: E402

import vcor  # noqa: E402
from vcor.materials import identification as inner  # noqa: E402
from vcor.materials.data import read_data  # noqa: E402


def by_interval(case, data, errors, truth):
    """Whether the interval of each parameter holds its true value."""
    found = vcor.identify(case, data, list(truth), errors=errors)
    ends = np.array([one.interval_95 for one in found.estimates])
    values = np.array(list(truth.values()))
    return (ends[:, 0] <= values) & (values <= ends[:, 1])


def by_rise(case, data, errors, truth):
    """The same by the sum of squares at the true value of each parameter."""
    case["solver.accuracy"] = inner.ACCURACY
    blocks = [inner.observations(case, data, list(truth))]
    problem = inner.Problem(case, list(truth), blocks, errors, SimpleNamespace(update=len))
    best, least = problem.best(1)
    values, held = np.log(list(truth.values())), []
    for i, value in enumerate(values):
        others = [j for j in range(len(values)) if j != i]
        found = np.inf
        for start in (values, best):
            start = start.copy()
            start[i] = value
            found = min(found, problem.minimize(start, others, 30, 1e-5)[1])
        held.append(found - least <= 1.95996**2)
    return np.array(held)


def coverage(model, draws, noise, holds):
    """Draws whose intervals hold each parameter, and how many were refused."""
    table = read_data(TESTS / "data" / f"impacts_of_{model}.csv")
    clean = {key: one.to_numpy() for key, one in table.items()}
    truth = {f"rubber.{key}": value for key, value in cases.TRUTH[model].items()}
    errors = {"cor": noise, "contact_time": noise}
    held, refused = np.zeros(len(truth), int), 0
    for draw in range(draws):
        rng = np.random.default_rng(draw)
        data = dict(clean)
        for name in errors:
            data[name] = clean[name] * (1 + noise * rng.normal(size=len(clean[name])))
        try:
            held += holds(cases.guess(model), data, errors, truth)
        except vcor.NumericalError as error:
            refused += 1
            print(f"{model}, draw {draw}: {error}", file=sys.stderr)
        if draw % 20 == 19:
            print(f"{model}: {held} of {draw + 1}", file=sys.stderr, flush=True)
    return dict(zip(truth, held.tolist(), strict=True)), refused


def main():
    """Print a row per model."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", default=list(cases.TRUTH))
    parser.add_argument("--draws", type=int, default=300)
    parser.add_argument("--noise", type=float, default=0.01)
    parser.add_argument("--rise", action="store_true")
    options = parser.parse_args()
    holds = by_rise if options.rise else by_interval
    for model in options.models:
        held, refused = coverage(model, options.draws, options.noise, holds)
        rows = ", ".join(f"{name} {count}" for name, count in held.items())
        print(f"{model}: {rows} of {options.draws}, {refused} refused", flush=True)


if __name__ == "__main__":
    main()
