"""Impacts with exact mechanics in a fit: those of thin mechanics with a correction.

A fit with its profiles asks for some thousand times all impacts, which takes minutes with exact
mechanics. So it begins at the solution with thin mechanics, moves to that of corrected ones, and
takes its derivatives and profiles from these. The correction is one of each datum in the
logarithms of the parameters (`vcor._correction`), fitted to exact impacts around the solution in
the directions of the covariance. Its error is measured at further ones.
"""

from __future__ import annotations

import math
import time
import warnings

import numpy as np
from scipy.stats import qmc

from .._correction import MOST_DEGREE, POINTS_PER_TERM, Coordinates, Correction, parts_of
from .._library import Floats, NumericalError
from ..case import Case
from ..uncertainty_samples import thin_cases
from .observations import Impacts, Record
from .search import STEP, Problem

#: Standard errors to each side that a correction is fitted to; beyond it stays as it is there
REACH = 3.0
#: Standard errors that the correction takes: at least those whose reach holds the steps of
#: derivatives, at most what polynomials follow
LEAST, MOST = 4 * STEP / REACH, 0.3
#: Rounds in which the solution may move, and the standard errors within which it has come to rest
ROUNDS, REST = 5, 1.0
#: Points that the error is measured at, and the largest one in parts of the errors of the data
FRESH, ACCURATE = 4, 0.1
#: Rounds of fitting, in each of which the points are doubled
FITS = 3
#: How often a fit solves all impacts beside the points of corrections, of which it has two of first
#: order, and the time that is announced [s]
ROWS, LONG = 20, 60.0


class Corrected:
    """Thin mechanics, corrected, in the place of exact ones for the impacts of a problem."""

    def __init__(self, problem: Problem, thin: Case) -> None:
        self.thin, self.case, self.free = thin, problem.case, problem.free
        self.blocks = problem.impacts
        #: Logarithms of the parameters at the middle, and standard errors by columns
        self.middle, self.root = problem.guess, LEAST * np.eye(len(problem.free))
        k = len(problem.free)
        self.uniform = Coordinates(np.full(k, True), np.ones(k, dtype=int), np.full(k, MOST_DEGREE))
        #: Where exact impacts are known, shape (points, parameters), and their data of each block
        self.known = np.empty((0, k))
        self.exact = [np.empty((0, len(block.value))) for block in self.blocks]
        #: Exact and thin data at the middle, and the correction of each block; none at first
        self.first: list[tuple[Floats, Floats]] = []
        self.corrections: list[Correction] = []
        self.errors: list[Floats] = []
        #: Impacts that were solved, of these those that measure the error, and that: root mean
        #: square in parts of the errors of the data
        self.solved, self.fresh, self.error = 0, 0, 0.0
        begin = time.perf_counter()
        self.set_errors(problem.guess)
        rows = ROWS + 4 * (k + 1) + _points_at_first(self.uniform) + FRESH
        seconds = rows * (time.perf_counter() - begin)
        if seconds > LONG:
            warnings.warn(
                f"{problem.case.name}: {rows * self.impacts} exact impacts take some "
                f"{math.ceil(seconds / 60)} min; fewer data, or means of repeated ones, take less",
                stacklevel=4,
            )

    def set_errors(self, x: Floats) -> None:
        """Take the errors of the exact solution at a point."""
        self.errors = [one.error_of_model(self.case, self.free, np.exp(x)) for one in self.blocks]
        self.solved += self.impacts

    @property
    def impacts(self) -> int:
        """Impacts of all blocks."""
        return sum(len(block.velocity) for block in self.blocks)

    def solve(self, x: Floats) -> list[Floats]:
        """Exact data of each block at points, in one call, which are known from here on."""
        found = [one.predict(self.case, self.free, np.exp(x)) for one in self.blocks]
        self.solved += len(x) * self.impacts
        self.known = np.vstack([self.known, x])
        self.exact = [np.vstack(pair) for pair in zip(self.exact, found, strict=True)]
        return found

    def coordinates(self, x: Floats) -> Floats:
        """Standardised coordinates of logarithms."""
        z: Floats = np.linalg.solve(self.root, (x - self.middle).T).T
        return z * (math.sqrt(3) / REACH)

    def fit(self, middle: Floats, root: Floats, z: Floats) -> bool:
        """Fit to what is known within reach and at further points; False without results."""
        self.middle, self.root = middle, root
        at_middle = self.solve(np.vstack([middle, middle + z @ root.T]))
        place = self.coordinates(self.known)
        near = (np.abs(place) < math.sqrt(3) * (1 + 1e-9)).all(axis=1)
        self.first, self.corrections = [], []
        for block, exact, here in zip(self.blocks, self.exact, at_middle, strict=True):
            thin = block.predict(self.thin, self.free, np.exp(self.known[near]))
            thin_0 = block.predict(self.thin, self.free, np.exp(middle)[None])
            if not (np.isfinite(exact[near]).all() and np.isfinite(thin).all()):
                return False
            parts = parts_of("", thin, thin_0, here[:1])
            self.corrections.append(
                Correction.fitted(self.uniform, place[near], exact[near] / here[:1], parts)
            )
            self.first.append((here[:1], thin_0))
        return True

    def predict(self, block: Impacts, values: Floats) -> Floats:
        """Data of a block for each row of values, shape (rows, n); nan without result."""
        thin = block.predict(self.thin, self.free, values)
        if not self.corrections:
            return thin
        i = next(i for i, one in enumerate(self.blocks) if one is block)
        exact_0, thin_0 = self.first[i]
        edge = math.sqrt(3)
        z = np.clip(self.coordinates(np.log(values)), -edge, edge)
        parts = parts_of("", thin, thin_0, exact_0)
        return self.corrections[i].results(z, parts) * exact_0

    def measure(self, problem: Problem, x: Floats, z: Floats) -> float:
        """Error at a solution and beside it, root mean square in parts of those of the data."""
        points = np.vstack([x, x + z @ self.root.T])
        # as they are predicted without them
        mine = [self.predict(one, np.exp(points)) for one in self.blocks]
        exact = self.solve(points)
        sigma = np.concatenate([
            part for block, part in zip(problem.blocks, problem.parts(problem.sigma), strict=True)
            if isinstance(block, Impacts)
        ])  # fmt: skip
        off = (np.hstack(mine) - np.hstack(exact)) / sigma
        self.fresh, self.error = len(points) * self.impacts, float(np.sqrt(np.mean(off**2)))
        return self.error


def corrected(problem: Problem, seed: int) -> tuple[Floats, float] | None:
    """The solution of a problem, whose impacts are corrected thin ones from here on.

    None if they cannot be: there are records of impacts, thin mechanics do not follow the data, or
    the correction is not good enough.
    """
    thin, k = thin_cases(problem.case, problem.free), len(problem.free)
    good = [one.case for one in thin.values() if one.reads.all()]
    if not good or any(isinstance(block, Record) for block in problem.blocks):
        return None
    try:
        made = Corrected(problem, good[0])
        problem.correct(made)
        x, _ = problem.best(seed)
        beside = np.vstack([np.eye(k), -np.eye(k)])
        for _ in range(ROUNDS):
            root = _root(problem, x)
            if not made.fit(x, root, beside):
                break
            problem.correct(made)
            before = x
            x, _ = problem.settle(x)
            if np.abs(np.linalg.solve(root, x - before)).max() < REST:
                found = _refined(problem, made, x, seed)
                if found:
                    return found
                break
    except NumericalError:
        # thin mechanics have no result for these data
        pass
    problem.correct(None)
    return None


def _refined(
    problem: Problem, made: Corrected, x: Floats, seed: int
) -> tuple[Floats, float] | None:
    """The solution with corrections of higher order; None if they are not good enough."""
    k = len(x)
    number = _points_at_first(made.uniform)
    design, random = qmc.Sobol(k, seed=np.random.default_rng(seed)), np.random.default_rng(seed)
    made.set_errors(x)
    for _ in range(FITS):
        if not made.fit(x, _root(problem, x), REACH * (2 * design.random(number) - 1)):
            return None
        problem.correct(made)
        x, chi2 = problem.settle(x)
        fresh = np.clip(random.standard_normal((FRESH, k)), -REACH, REACH)
        if made.measure(problem, x, fresh) < ACCURATE:
            return x, chi2
        number *= 2
    return None


def _points_at_first(coordinates: Coordinates) -> int:
    """Points to which terms of second degree are fitted."""
    return int(2 ** math.ceil(math.log2(POINTS_PER_TERM * len(coordinates.terms(2)))))


def _root(problem: Problem, x: Floats) -> Floats:
    """Standard errors of the logarithms at a solution, by columns."""
    slopes, _ = problem.derivatives(x)
    values, vectors = np.linalg.eigh(slopes.T @ slopes)
    errors = np.fmax(values, 1e-300) ** -0.5
    root: Floats = vectors * np.clip(errors, LEAST, MOST)
    return root
