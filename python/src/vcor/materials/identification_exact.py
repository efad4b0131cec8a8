"""Impacts with exact mechanics in a fit: those of thin mechanics with a correction.

A fit with its profiles asks for some thousand times all impacts, which takes minutes with exact
mechanics. So each datum is that of thin mechanics times a ratio, or plus a difference. It is
interpolated (`vcor._kriging`) from exact impacts at few rows of parameters, and not over these: a
parameter that hardly matters may go to 0 or be ten times as large. The coordinates are the thin
data themselves, in the directions in which parameters move them. There a standard error is as long
in all directions, and a ratio next to a plane.

Exact impacts are where the answers are:

1. at the first guess, from whose ratios the search from several starts begins;
2. at each solution with the ratios so far, until it has come to rest. What remains of a move is
   that times the change of the ratio as part of that of the datum;
3. beside the solution, one row to each parameter: ratios have slopes in all directions then;
4. at the solution and at the ends of the widest intervals. What is off there shifts the solution
   and the ends: that is the error of the answers. Unless it is small, these impacts are known from
   then on, too, and solution and intervals are found again.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .._correction import divides
from .._differences import slopes
from .._kriging import Kriged
from .._library import Floats, NumericalError
from ..case import Case
from ..uncertainty_samples import thin_cases
from .limits import Fit, Interval
from .observations import Record
from .search import SOLVED, STEP, Problem

#: Part of all data over which ratios change. Of 12 exact impacts with three parameters, one of them
#: hardly determined, errors at 40 fresh points from 5, 9 and 15 known ones were the same within a
#: factor of 3 for 0.04 to 0.4, at most 1e-3 of the errors of the data
LENGTH = 0.1
#: Rounds in which the solution may move; standard errors within which it has come to rest, which
#: the impacts beside it make up for; and the part of the last move from which on it does not
#: come to rest without these
ROUNDS, REST, SLOW = 6, 0.1, 0.5
#: Standard errors from the solution to the impacts beside it, and the most in logarithms
WIDTH, MOST = 2.0, 1.0
#: Rounds in which the ends of intervals are met, and how far these and the solution may be off, in
#: standard errors
MEETINGS, ACCURATE = 4, 0.01
#: Standard errors within which two ends are one
SAME = 0.1
#: Time of a fit in those of all exact impacts once: some, and some to each parameter. Four fits of
#: two and three parameters to 12 and 60 impacts took 0.7 to 1.1 times as long
ROWS, ROWS_EACH = 12, 5


class Corrected:
    """Thin mechanics, corrected, in the place of exact ones for the impacts of a problem."""

    def __init__(self, problem: Problem, thin: Case) -> None:
        """Begin without exact impacts.

        `problem` has the data and its impacts, and `thin` is its case by thin mechanics.
        """
        self.problem, self.thin = problem, thin
        self.blocks = problem.impacts
        #: Numbers of data of the blocks
        self.ends = np.cumsum([len(block.value) for block in self.blocks])
        #: Where exact impacts are known, in logarithms, shape (points, parameters), and their exact
        #: and thin data and numbers of contacts, shape (points, data)
        self.known = np.empty((0, len(problem.free)))
        self.exact, self.of_thin, self.contacts = np.empty((3, 0, self.ends[-1]))
        #: Which data have a ratio, the others have a difference, shape (data,)
        self.ratio: NDArray[np.bool_] = np.empty(0, dtype=bool)
        #: Coordinates by thin data, shape (data, parameters), and the correction
        self.frame = np.empty((self.ends[-1], 0))
        self.correction: Kriged | None = None
        self.errors = [np.zeros(len(block.value)) for block in self.blocks]
        #: Ends of intervals that were off, as parameters and sides, which are looked at again
        self.off: list[tuple[int, int]] = []
        #: Impacts that were solved, of these those that measure the error, and that: root mean
        #: square in parts of the errors of the data
        self.solved, self.fresh, self.error = 0, 0, 0.0

    @property
    def impacts(self) -> int:
        """Impacts of all blocks."""
        return sum(len(block.velocity) for block in self.blocks)

    def solve(self, x: Floats) -> tuple[Floats, Floats]:
        """Exact data at points and their numbers of contacts, known from here on; nan: none.

        Shape (points, data). The errors of the solution are those at the first point.
        """
        found = [one.solved(self.problem.case, self.problem.free, np.exp(x)) for one in self.blocks]
        exact, contacts = (np.hstack([one[k] for one in found]) for k in (0, 2))
        self.errors = [one[1] for one in found]
        self.solved += len(x) * self.impacts
        self.known, self.exact = np.vstack([self.known, x]), np.vstack([self.exact, exact])
        self.of_thin = np.vstack([self.of_thin, self._thin(np.exp(x))])
        self.contacts = np.vstack([self.contacts, contacts])
        return exact, contacts

    def _thin(self, values: Floats) -> Floats:
        """Thin data for each row of values, shape (rows, data)."""
        return np.hstack([one.predict(self.thin, self.problem.free, values) for one in self.blocks])

    def fit(self, x: Floats) -> None:
        """Interpolate from what is known of the kind that impacts are at a known point.

        NumericalError: there are no results there.
        """
        middle = int(np.flatnonzero((self.known == x).all(axis=1))[-1])
        same = np.isfinite(self.exact + self.of_thin).all(axis=1)
        same &= (self.contacts == self.contacts[middle]).all(axis=1)
        if not same[middle]:
            raise NumericalError(f"{self.problem.case.name}: no result for all data")
        # the last one is what others are corrected about
        rows = [*(i for i in np.flatnonzero(same) if i != middle), middle]
        exact, thin = self.exact[rows], self.of_thin[rows]
        sigma = self.problem.sigma[self.problem.is_impact]
        slope = slopes(lambda steps: self._thin(np.exp(x + steps)), len(x), STEP)
        directions = np.linalg.qr(np.nan_to_num(slope) / sigma[:, None])[0] / sigma[:, None]
        self.frame = directions / (LENGTH * np.linalg.norm(thin[-1] / sigma))
        self.ratio = np.array([divides(one) for one in thin.T])
        with np.errstate(divide="ignore", invalid="ignore"):
            values = np.where(self.ratio, exact / thin, exact - thin)
        self.correction = Kriged(thin @ self.frame, values)
        self.problem.correct(self)

    def predict(self, values: Floats) -> list[Floats]:
        """Data of each block for each row of values, shape (rows, n); nan without result."""
        thin = self._thin(values)
        if self.correction:
            more = self.correction(thin @ self.frame)
            thin = np.where(self.ratio, thin * more, thin + more)
        return np.split(thin, self.ends[:-1], axis=1)

    def meets(self, best: Fit, limits: Sequence[Sequence[Interval]]) -> bool:
        """Whether a fit and the ends of its widest intervals are those of exact impacts.

        If not, the exact impacts there are known from here on, and the next time it is the ends
        that were off which are looked at. NumericalError: there are none, or they have another
        number of contacts.
        """
        problem, x = self.problem, best.x
        ends = self.off or _apart(best, limits)
        points = np.array([x, *(limits[i][-1].ends[side] for i, side in ends)])
        mine = problem.predict(points)
        exact, own = mine.copy(), problem.is_impact
        exact[:, own], contacts = self.solve(points)
        off = (exact - mine) / problem.sigma
        good = np.isfinite(off).all(axis=1) & (contacts == contacts[0]).all(axis=1)
        # no end is where there is no result
        closed = [True, *(math.isfinite(limits[i][-1][:2][side]) for i, side in ends)]
        if not good[closed].all():
            raise NumericalError(
                f"{problem.case.name}: the intervals hold several kinds of impacts"
            )
        self.fresh = int(good.sum()) * self.impacts
        self.error = float(np.sqrt(np.mean(off[good][:, own] ** 2)))
        # the solution moves by the part that parameters can follow
        errors = [float(np.linalg.norm(np.linalg.qr(best.slopes)[0].T @ off[0]))]
        squares = np.sum(((np.stack([exact, mine]) - problem.value) / problem.sigma) ** 2, axis=2)
        rises = np.sqrt(np.fmax(squares[:, 1:] - squares[:, :1], 0.0))
        deviations = np.sqrt(np.diag(best.covariance()))
        for (i, _), row, is_closed, (wanted, rise) in zip(
            ends, points[1:], closed[1:], rises.T, strict=True
        ):
            # in standard errors: along an interval the root of the rise is next to linear
            scale = abs(row[i] - x[i]) / (deviations[i] * rise) if is_closed and rise > 0 else 1.0
            errors.append(scale * abs(wanted - rise) if np.isfinite(wanted) else 0.0)
        is_met = max(errors) < ACCURATE
        self.off = [end for end, error in zip(ends, errors[1:], strict=True) if error >= ACCURATE]
        if not is_met:
            self.fit(x)
        return is_met


def corrected(problem: Problem, seed: int) -> tuple[Floats, float] | None:
    """The solution of a problem, whose impacts are corrected thin ones from here on.

    None if they cannot be: there are records of impacts, or thin or exact mechanics have no results
    for the data.
    """
    thin = thin_cases(problem.case, problem.free)
    good = [one.case for one in thin.values() if one.reads.all()]
    if not good or any(isinstance(block, Record) for block in problem.blocks):
        return None
    made, x = Corrected(problem, good[0]), problem.guess
    begin = time.perf_counter()
    is_result = bool(np.isfinite(made.solve(x[None])[0]).all())
    problem.announce((ROWS + ROWS_EACH * len(x)) * (time.perf_counter() - begin))
    try:
        if is_result:
            made.fit(x)
        else:
            problem.correct(made)
        x, _ = problem.best(seed)
        move = math.inf
        for _ in range(ROUNDS):
            made.solve(x[None])
            made.fit(x)
            before, last = x, move
            x, _ = problem.settle(x)
            there, here = problem.predict(np.array([before, x])) / problem.sigma
            move = float(np.linalg.norm(here - there))
            if move < REST or move > SLOW * last:
                break
        made.solve(np.vstack([x, x + _beside(problem, x)]))
        made.fit(x)
        return problem.settle(x)
    except NumericalError:
        problem.correct(None)
        return None


def _beside(problem: Problem, x: Floats) -> Floats:
    """Steps of the logarithms from a solution in directions that are independent, by rows."""
    derivatives, _ = problem.derivatives(x)
    values, vectors = np.linalg.eigh(derivatives.T @ derivatives)
    steps: Floats = (vectors * np.fmin(WIDTH * np.fmax(values, 1e-300) ** -0.5, MOST)).T
    return steps


def is_exact(best: Fit, limits: Sequence[Sequence[Interval]], meetings: int) -> bool:
    """Whether a fit and its intervals are those of exact impacts; else they are to be found again.

    After some meetings, or where impacts are of several kinds, all impacts are solved.
    """
    problem = best.problem
    made = problem.corrected
    if not isinstance(made, Corrected):
        return True
    try:
        if made.meets(best, limits):
            return True
        if meetings < MEETINGS:
            return False
    except NumericalError:
        pass
    problem.correct(None)
    begin = time.perf_counter()
    problem.residuals(best.x)
    problem.announce(SOLVED * len(best.x) ** 3 * (time.perf_counter() - begin))
    return False


def _apart(best: Fit, limits: Sequence[Sequence[Interval]]) -> list[tuple[int, int]]:
    """Parameters and sides, 0 and 1, of the widest intervals, those of one place once."""
    found: list[tuple[int, int]] = []
    for i, both in enumerate(limits):
        for side in (0, 1):
            x = both[-1].ends[side]
            others = (limits[j][-1].ends[k] for j, k in found)
            if all(np.linalg.norm(best.slopes @ (x - one)) > SAME for one in [best.x, *others]):
                found.append((i, side))
    return found
