"""Interpolation of smooth functions from few points in any places (kriging).

A function is taken as one of a random process with the covariance exp(-d^2/2) of its values at
points a distance d apart. Between known points it is where that process is on average (Sacks et al.
1989, doi:10.1214/ss/1177012413): a sum of such bells that meets them. From one point that is a
constant, from two a slope along their line and none across it, as an update by Broyden has it; from
more, the polynomials that their number and places determine.
"""

from __future__ import annotations

import numpy as np

from ._library import Floats

#: Variance of the errors of known values as part of that of the process: values good to 1e-5 that
#: change by a third over a distance of 1
NUGGET = 1e-9


class Kriged:
    """Functions from their values at points, about those at the last one."""

    def __init__(self, points: Floats, values: Floats) -> None:
        """Take values, shape (points, functions), at points, shape (points, coordinates).

        Coordinates are in units of the distance over which the functions change.
        """
        self.points, self.last = points, values[-1]
        bells = self._bells(points) + NUGGET * np.eye(len(points))
        self.weights: Floats = np.linalg.solve(bells, values - self.last)

    def __call__(self, at: Floats) -> Floats:
        """Values, shape (rows, functions), for rows of coordinates; the last one far from all."""
        found: Floats = self.last + self._bells(at) @ self.weights
        return found

    def _bells(self, at: Floats) -> Floats:
        """Covariances of the values at rows of coordinates with those at the known points."""
        bells: Floats = np.exp(-np.sum((at[:, None] - self.points) ** 2, axis=2) / 2)
        return bells
