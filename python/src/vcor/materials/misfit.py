"""Whether misfits are noise: neighbours of noise are independent, of a wrong model they are not."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .._library import Floats

#: Standard deviations above the mean that one fit of a thousand exceeds by chance
SIGNIFICANT = 3.1
#: Fewest misfits in excess of the parameters for a correlation to be significant
LEAST_EXCESS = 5


def are_alike(
    r: Floats, derivatives: Floats, quantities: int = 1, curve: NDArray[np.int_] | None = None
) -> bool:
    """Whether neighbouring misfits are more correlated than those of noise.

    Noise is independent from point to point, while a wrong model errs in the same direction at
    many. So the test uses not the size of the misfits but their correlation with the next one,
    rho = sum r_i r_(i+1)/sum r_i^2, in their order. For noise it would be 0, but a fit has removed
    the smooth part that its p parameters could follow. Let r = M e with independent noise e of one
    variance and the projection M orthogonal to the derivatives, and let A r be the mean of the two
    neighbours, so rho = r'A r/r'r. Then rho has the mean tr(MA)/n and the variance
    2 (tr(MAMA) - tr(MA)^2/n)/(n (n + 2)), n = m - p, for any number m of points (Durbin and Watson,
    Biometrika 37 (1950) 409, doi:10.1093/biomet/37.3-4.409).

    Parameters
    ----------
    r
        Misfits, shape (m,); of several quantities one after the other, each at the same points.
    derivatives
        By all that was fitted, of full rank, shape (m, p).
    quantities
        How many there are.
    curve
        Which curve each point belongs to, shape (m/quantities,): neighbours are of one curve, as
        curves of several temperatures in a master curve err by themselves. None: there is one.
    """
    m, p = derivatives.shape
    if m < p + LEAST_EXCESS or not r @ r > 0:
        return False
    own = np.zeros(m // quantities, dtype=int) if curve is None else curve
    sequence = np.concatenate([own + i * (own.max() + 1) for i in range(quantities)])
    order = np.argsort(sequence, kind="stable")
    pairs = np.diff(sequence[order]) == 0
    before, after = order[:-1][pairs], order[1:][pairs]

    def neighbours(columns: Floats) -> Floats:
        """Mean of the two neighbours of each number; a missing one counts as 0."""
        means = np.zeros_like(columns)
        means[before] += columns[after] / 2
        means[after] += columns[before] / 2
        return means

    q = np.linalg.qr(derivatives)[0]
    aq = neighbours(q)
    g = q.T @ aq
    n = m - p
    mean = -float(np.trace(g)) / n
    square = 0.5 * len(before) - 2 * float(np.sum(aq**2)) + float(np.sum(g**2))
    rho = float(r @ neighbours(r) / (r @ r))
    # storage and loss modulus may share their noise, or one has nearly all of it: in both cases the
    # variance is that of one quantity
    deviation = math.sqrt(max(0.0, quantities * 2 * (square - n * mean**2) / (n * (n + 2))))
    return bool(rho - mean > SIGNIFICANT * deviation)
