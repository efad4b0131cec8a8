"""Whether misfits are noise: neighbours of noise are independent, those of a model are not."""

from __future__ import annotations

import math

import numpy as np

from .._library import Floats

#: Standard deviations above the mean that one fit of a thousand exceeds by chance
SIGNIFICANT = 3.1
#: Fewest misfits in excess of the parameters for a correlation to be significant
LEAST_EXCESS = 5


def are_alike(r: Floats, derivatives: Floats) -> bool:
    """Whether neighbouring misfits of a sequence are more alike than noise leaves them.

    The correlation rho = sum r_i r_(i+1)/sum r_i^2 is compared with that of independent noise e of
    one variance after a fit of p parameters, r = M e with the projection M orthogonal to the
    derivatives. With A r the mean of the two neighbours, rho = r'A r/r'r has the mean tr(MA)/n and
    the variance 2 (tr(MAMA) - tr(MA)^2/n)/(n (n + 2)), n = m - p (Durbin and Watson, Biometrika 37
    (1950) 409, doi:10.1093/biomet/37.3-4.409).

    Parameters
    ----------
    r
        Misfits in their order, shape (m,).
    derivatives
        By all that was fitted, shape (m, p).
    """
    m, p = derivatives.shape
    if m < p + LEAST_EXCESS or not r @ r > 0:
        return False

    def neighbours(columns: Floats) -> Floats:
        """Mean of the two neighbours of each number; a missing one counts as 0."""
        means = np.zeros_like(columns)
        means[:-1] += columns[1:] / 2
        means[1:] += columns[:-1] / 2
        return means

    q = np.linalg.qr(derivatives)[0]
    aq = neighbours(q)
    g = q.T @ aq
    n = m - p
    mean = -float(np.trace(g)) / n
    square = 0.5 * (m - 1) - 2 * float(np.sum(aq**2)) + float(np.sum(g**2))
    rho = float(r @ neighbours(r) / (r @ r))
    deviation = math.sqrt(max(0.0, 2 * (square - n * mean**2) / (n * (n + 2))))
    return bool(rho - mean > SIGNIFICANT * deviation)
