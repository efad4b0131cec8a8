"""Which values of the parameters data allow: intervals, and combinations without any limit.

The least sum of squares while one parameter is held rises by width^2 at the ends
of an interval (a profile). Parameters that the derivatives do not show to be determined may rise
for another reason: the path has come to the end of a range, or so far that it is not followed. Then
the data set no limit there. What they do not limit on either side they do not determine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from scipy.special import ndtri, stdtrit

from .._library import Floats
from .search import FARTHEST, Problem

#: Levels of the intervals
LEVELS = (0.6827, 0.95)
#: Standard error of a logarithm above which derivatives do not show that a parameter is
#: determined: a factor e; or fewer of those that the error of the derivatives alone would give
UNDETERMINED, DOUBT = 1.0, 1 / 3
#: Least part of a parameter in a direction of length 1 that counts
LEAST = 0.02
#: Logarithm of the factor from the first guess beyond which an interval is open
OPEN = math.log(1e4)
#: Longest first step of a profile, in the logarithm
LONGEST = 0.7
#: Distance from the end of a range, in the logarithm, within which a parameter is at its bound
BESIDE = 1e-4
#: Steps of a profile at most, the part of the width that its end is met to, and the part of the
#: distance that brackets it
MOST, MET, CLOSED = 25, 5e-3, 1e-3
#: Rise, in widths, from which on no straight line leads to the end
STEEP = 1e3


class Better(Exception):  # noqa: N818
    """A profile has found a better fit than the one it began at."""

    def __init__(self, x: Floats) -> None:
        """Begin with the logarithms of the better parameters, shape (parameters,)."""
        super().__init__()
        self.x = x


class Interval(NamedTuple):
    """Values of a parameter that the data allow, in logarithms; an open end is infinite."""

    low: float
    high: float
    #: Whether the data set an end of it, and not only the ranges of parameters
    limited: bool
    #: Logarithms of all parameters at the lower and the upper end, or as far as was followed
    ends: tuple[Floats, Floats]


class _End(NamedTuple):
    at: float
    by_data: bool
    #: Logarithms of all parameters there, or as far as the path was followed
    x: Floats


@dataclass(frozen=True)
class Fit:
    """The best fit: logarithms of the parameters, the sum of squares and the derivatives."""

    problem: Problem
    x: Floats
    chi2: float
    #: Derivatives of the residuals, shape (data, parameters), and their error, a norm
    slopes: Floats
    error: float
    #: Intervals of a fit nearby, whose ends are tried first
    before: Sequence[Sequence[Interval]] = ()
    #: Intervals that were found, by the parameter and those that were held
    found: dict[tuple[int, ...], list[Interval]] = field(default_factory=dict, init=False)

    def covariance(self, held: Sequence[int] = ()) -> Floats:
        """Covariance of the logarithms while some of them are held: rows and columns of 0.

        None is less known than an open interval.
        """
        moving = [i for i in range(len(self.x)) if i not in held]
        slopes = self.slopes[:, moving]
        values, vectors = np.linalg.eigh(slopes.T @ slopes)
        covariance = np.zeros((len(self.x), len(self.x)))
        covariance[np.ix_(moving, moving)] = (vectors / values.clip(1 / OPEN**2)) @ vectors.T
        return covariance

    def doubtful(self, held: Sequence[int] = ()) -> list[int]:
        """Parameters of directions that the derivatives do not show to be determined.

        The worst first, while some are held.
        """
        least = min(UNDETERMINED, DOUBT / max(self.error, 1e-300))
        moving = [i for i in range(len(self.x)) if i not in held]
        values, vectors = np.linalg.eigh(self.slopes[:, moving].T @ self.slopes[:, moving])
        weak = vectors[:, values < 1 / least**2]
        deviations = np.diag(self.covariance(held))
        found = [i for i, row in zip(moving, weak, strict=True) if np.linalg.norm(row) > LEAST]
        return sorted(found, key=lambda i: -deviations[i])

    def intervals(self, i: int, held: Sequence[int] = ()) -> list[Interval]:
        """Profile intervals of a parameter, one of each of LEVELS, while some others are held."""
        if (i, *held) not in self.found:
            self.found[i, *held] = self._intervals(i, held)
        return self.found[i, *held]

    def _intervals(self, i: int, held: Sequence[int]) -> list[Interval]:
        """The intervals by profiles on both sides, with the widths of the levels in deviations."""
        estimated, dof = self.problem.noise.estimated, self.problem.dof
        halves = [(1 + level) / 2 for level in LEVELS]
        widths = [float(stdtrit(dof, one) if estimated else ndtri(one)) for one in halves]
        low, high = (_Profile(self, i, side, held).ends(widths) for side in (-1, 1))
        return [
            Interval(below.at, above.at, below.by_data or above.by_data, (below.x, above.x))
            for below, above in zip(low, high, strict=True)
        ]

    def free(self, held: Sequence[int] = ()) -> int | None:
        """A parameter that the data do not limit on either side while some are held, if any."""
        for i in self.doubtful(held):
            if not self.intervals(i, held)[-1].limited:
                return i
        return None

    def lost(self, first: int) -> Floats:
        """Directions that the data leave free, shape (parameters, directions).

        One parameter is known to be free. While it is held others may be free still: there are as
        many directions. In each of them one moves, and those that are not free follow.
        """
        free = [first]
        while (another := self.free(free)) is not None:
            free.append(another)
        rest = [i for i in range(len(self.x)) if i not in free]
        directions = np.eye(len(self.x))[:, free]
        directions[rest] = -np.linalg.lstsq(self.slopes[:, rest], self.slopes[:, free])[0]
        return directions


class _Profile:
    """The least sum of squares while a parameter is held at values to one side of the best."""

    def __init__(self, fit: Fit, i: int, side: int, held: Sequence[int]) -> None:
        """Take parameter `i` of a fit, to the side +1 or -1; those in `held` do not vary."""
        self.fit, self.i, self.side = fit, i, side
        covariance, x, problem = fit.covariance(held), fit.x, fit.problem
        self.others = [j for j in range(len(x)) if j != i and j not in held]
        doubtful = fit.doubtful(held)
        #: Others that may not be followed to the end, if this one is in doubt: what the data
        #: determine has its ends from them, wherever others have got to that they do not see
        self.doubtful = [j for j in doubtful if j in self.others] if i in doubtful else []
        #: How far parameters are followed, to the side of their ranges or beyond the guess
        self.low = np.fmax(problem.low, np.minimum(x, problem.guess) - OPEN)
        self.high = np.fmin(problem.high, np.maximum(x, problem.guess) + OPEN)
        self.reach = self.high[i] - x[i] if side > 0 else x[i] - self.low[i]
        sure = [j for j in range(len(x)) if j not in self.doubtful]
        self.low[sure], self.high[sure] = problem.low[sure], problem.high[sure]
        self.error = math.sqrt(covariance[i, i])
        self.slope_of_others = covariance[i] / covariance[i, i]
        #: Points that are tried first for each level
        self.hints = [one.ends[side > 0] for one in fit.before[i]] if fit.before else []

    def ends(self, widths: Sequence[float]) -> list[_End]:
        """Logarithms at which the sum of squares is larger by width^2; inf where it never is.

        The root z of the rise is next to linear: from the last point with less than the width the
        line leads on, and a point with more closes the bracket. A point with far more may be one
        that the search of the others has not come to from so far away: the next step is shorter,
        until it is negligible compared with the distance.
        """
        inside, z, point, step, longest = 0.0, 0.0, self.fit.x, math.inf, math.inf
        rate = 1 / self.error
        outside: list[tuple[float, float, _End]] = []
        ends = []
        for width in widths:
            outside = [one for one in outside if one[1] > width]
            end = self.not_followed(inside, point)
            hint = self.hints.pop(0) if self.hints else None
            for _ in range(MOST if inside < self.reach else 0):
                ahead = self.side * (hint[self.i] - self.fit.x[self.i]) if hint is not None else 0
                if inside < ahead < (outside[-1][0] if outside else self.reach):
                    step = ahead - inside
                elif outside:
                    far, z_far, _ = outside[-1]
                    step = (far - inside) * max(0.05, (width - z) / (z_far - z))
                else:
                    step = (width - z) / max(rate, 1e-300)
                    step = min(step, 2 * inside + LONGEST, longest, self.reach - inside)
                trial = inside + step
                found_at, rise = self.least(point, trial, step, width, hint)
                hint = None
                here = self.end(found_at, rise, inside, point)
                if rise < width:
                    if rise > z:
                        self.slope_of_others = self.side * (found_at - point) / step
                    rate, longest = max(rise - z, 0.0) / step, 2 * longest
                    inside, z, point = trial, rise, found_at
                    if inside >= self.reach or math.isinf(here.at):
                        end = self.not_followed(inside, point)
                        break
                elif rise < STEEP * width or not here.by_data and math.isfinite(rise):
                    outside.append((trial, rise, here))
                else:
                    longest = step / 4
                if abs(rise - width) < MET * width:
                    end = here
                    break
                if outside and outside[-1][0] - inside < CLOSED * outside[-1][0]:
                    end = outside[-1][2]
                    break
                if longest < CLOSED * inside:
                    # data make no such jump where they made no rise
                    at = _End(self.fit.x[self.i] + self.side * inside, False, point)
                    end = at if math.isinf(rise) else self.not_followed(inside, point)
                    break
            ends.append(end)
        return ends

    def not_followed(self, distance: float, x: Floats) -> _End:
        """An end beyond which the path is not followed: open, but for that of a range."""
        problem, i = self.fit.problem, self.i
        at = float(self.fit.x[i] + self.side * distance)
        last = problem.high[i] if self.side > 0 else problem.low[i]
        of_range = abs(at - last) < BESIDE and abs(last - problem.guess[i]) < FARTHEST - BESIDE
        return _End(at if of_range else self.side * math.inf, False, x)

    def least(
        self, point: Floats, trial: float, ahead: float, width: float, hint: Floats | None
    ) -> tuple[Floats, float]:
        """Where the least sum of squares is at a distance, and the root of its rise.

        Beside a point that is known by a hint, ahead of the last one, or beside that.
        """
        fit, i = self.fit, self.i
        straight = point + ahead * self.side * self.slope_of_others
        found_at, found = point, math.inf
        # the line may lead to points without a result, or to another minimum, above the width: then
        # the others start where they are
        for start in (straight if hint is None else hint.copy(), point.copy()):
            start[i] = fit.x[i] + self.side * trial
            at, squares = fit.problem.minimize(
                start, self.others, 30, 1e-5, ranges=(self.low, self.high)
            )
            if squares < found:
                found_at, found = at, squares
            if found < fit.chi2 + width**2:
                break
        if found < fit.chi2 - 1:
            raise Better(found_at)
        return found_at, math.sqrt(max(found - fit.chi2, 0.0))

    def end(self, at: Floats, rise: float, inside: float, last: Floats) -> _End:
        """Kind of the end if it is at a point: set by data, a range, or open.

        `inside` and `last` are the distance and the point before it, with less than the rise.

        The data set no end where there is no result, nor where another parameter that may have
        followed this one has come to the end of its range, or so far that it is not followed.
        """
        x, problem = self.fit.x, self.fit.problem
        if not math.isfinite(rise):
            return _End(float(x[self.i] + self.side * inside), False, last)
        stopped = [
            j for j in self.doubtful
            if min(at[j] - self.low[j], self.high[j] - at[j]) < BESIDE
            <= min(x[j] - self.low[j], self.high[j] - x[j])
        ]  # fmt: skip
        far = [
            j for j in stopped
            if min(at[j] - problem.low[j], problem.high[j] - at[j]) > 2 * BESIDE
        ]  # fmt: skip
        return _End(self.side * math.inf if far else float(at[self.i]), not stopped, at)
