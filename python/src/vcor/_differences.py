"""Derivatives by differences of fourth order, one-sided beside the end of a range."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ._library import Floats

#: Steps and weights of the differences, times 12: central, and to either side
_FORMULAS = (
    ((-2, -1, 1, 2), (1, -8, 8, -1)),
    ((0, 1, 2, 3, 4), (-25, 48, -36, 16, -3)),
    ((0, -1, -2, -3, -4), (25, -48, 36, -16, 3)),
)


def slopes(results: Callable[[Floats], Floats], count: int, step: float) -> Floats:
    """Derivatives of results by each of some parameters, where all of these are 0.

    Parameters
    ----------
    results
        Results, shape (points, n), at points of shape (points, count); nan where there are none.
    count
        Number of parameters.
    step
        Step of the differences: the error is that of a result over it, and its fourth power.

    Returns
    -------
    Array of shape (n, count), nan where there are no results on either side.
    """
    n = results(np.zeros((1, count))).shape[1]
    slope = np.full((n, count), np.nan)
    for steps, weights in _FORMULAS:
        rest = np.flatnonzero(np.isnan(slope).any(axis=0))
        if not rest.size:
            break
        points = np.zeros((len(rest), len(steps), count))
        for row, i in zip(points, rest, strict=True):
            row[:, i] = np.array(steps) * step
        found = results(points.reshape(-1, count)).reshape(len(rest), len(steps), n)
        slope[:, rest] = np.einsum("ijk,j->ki", found, weights) / (12 * step)
    return slope
