"""Moduli that a material is fitted to, and statistics of their misfits."""

from __future__ import annotations

import math
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from .._library import Floats, NumericalError
from .misfit import are_alike

#: Condition of the scaled derivatives above which parameters are not determined: a change of the
#: data by 1e-7 would leave them no common digit
WORST_CONDITION = 1e7
#: Root mean square misfit below the accuracy of any data, and one too large for noise of any kind
NEGLIGIBLE, TOO_LARGE = 5e-3, math.log(2)
#: Distance from the end of a range, in a variable, within which it is tried whether it is reached
BESIDE = 1e-3


def one_thread() -> AbstractContextManager[Any]:
    """Linear algebra on one thread: matrices of fits are small, and further threads only wait.

    On a busy machine they take thirty times as long. Without threadpoolctl nothing is changed.
    """
    try:
        from threadpoolctl import threadpool_limits
    except ModuleNotFoundError:
        return nullcontext()
    limits: AbstractContextManager[Any] = threadpool_limits(limits=1, user_api="blas")
    return limits


@dataclass(frozen=True)
class Samples:
    """Relaxation moduli against time, or storage and loss moduli against angular frequency."""

    #: Times [s] or angular frequencies [rad/s], rising, shape (n,)
    at: Floats
    #: Relaxation, or storage and loss moduli [Pa], shape (1 or 2, n)
    moduli: Floats
    #: Further keys of the &material group
    keys: tuple[str, ...] = ()
    #: Of a master curve: which curve each point is of, shape (n,)
    curve: NDArray[np.int_] | None = None

    @property
    def dynamic(self) -> bool:
        """Whether they are storage and loss moduli."""
        return len(self.moduli) == 2

    @property
    def data(self) -> Floats:
        """All moduli in one row [Pa]."""
        return self.moduli.ravel()

    @property
    def first_time(self) -> float:
        """First time, or reciprocal of the largest frequency [s]."""
        return float(1 / self.at[-1] if self.dynamic else self.at[0])

    @property
    def last_time(self) -> float:
        """Last time, or reciprocal of the smallest frequency [s]."""
        return float(1 / self.at[0] if self.dynamic else self.at[-1])

    @property
    def softest(self) -> float:
        """Smallest relaxation or storage modulus [Pa]."""
        return float(self.moduli[0].min())

    @property
    def ones(self) -> Floats:
        """Moduli of an equilibrium modulus of 1 Pa."""
        return np.repeat([1.0, 0.0][: len(self.moduli)], len(self.at))

    def logs(self, moduli: Floats) -> Floats:
        """Residuals: logarithms of moduli/data."""
        rest: Floats = np.log(np.maximum(moduli, 1e-200) / self.data)
        return rest


class Problem:
    """Residuals of variables with limits, which the fits of laws and of series have in common."""

    samples: Samples
    low: Floats
    high: Floats

    def residuals(self, x: Floats) -> Floats:
        """Logarithms of model/data, shape (m,)."""
        raise NotImplementedError

    def jacobian(self, x: Floats) -> Floats:
        """Their derivatives, shape (m, n)."""
        raise NotImplementedError

    def minimize(
        self, x: Floats, tolerance: float = 1e-14, most: int = 400
    ) -> tuple[Floats, float, bool]:
        """Least squares from x; the point, the sum of squares, and whether it has converged."""
        if not len(x):
            return x, float(np.sum(self.residuals(x) ** 2)), True
        with np.errstate(over="ignore", under="ignore"):
            found = least_squares(
                self.residuals, np.clip(x, self.low + 1e-9, self.high - 1e-9), self.jacobian,
                bounds=(self.low, self.high), x_scale="jac", ftol=max(tolerance, 1e-15),
                xtol=max(1e-3 * tolerance, 1e-13), gtol=1e-15, max_nfev=most,
            )  # fmt: skip
        return found.x, 2 * found.cost, found.status > 0

    def scatter(self, points: Floats, r: Floats, free: Floats) -> tuple[Floats, float, bool]:
        """Covariance of the variables at a solution, and statistics of the residuals.

        Variables at a bound are unknowns like the others, so that the errors of the others allow
        for their possible values; they take no part in the variance.

        Parameters
        ----------
        points
            Derivatives, shape (m, n).
        r
            Residuals, shape (m,).
        free
            Which variables are at no bound, shape (n,).

        Returns
        -------
        Floats, float, bool
            Covariance of the variables divided by the variance of a residual, this variance, and
            whether the residuals are too correlated for noise.
        """
        inner = points[:, free]
        if condition(inner) > WORST_CONDITION:
            raise NumericalError("the data do not determine all parameters")
        variance = float(r @ r) / max(1, len(r) - inner.shape[1])
        rms = math.sqrt(r @ r / len(r))
        structured = rms > NEGLIGIBLE and are_alike(
            r, inner, len(self.samples.moduli), self.samples.curve
        )
        return covariance(points), variance, structured or rms > TOO_LARGE


def condition(derivatives: Floats) -> float:
    """Condition number of derivatives by parameters, each scaled to length 1."""
    if not derivatives.size:
        return 1.0
    values = np.linalg.svd(derivatives / np.linalg.norm(derivatives, axis=0), compute_uv=False)
    return float(values[0] / max(values[-1], 1e-300))


def covariance(derivatives: Floats) -> Floats:
    """Inverse of the products of derivatives, shape (n, n)."""
    lengths = np.maximum(np.linalg.norm(derivatives, axis=0), 1e-300)
    _, values, vectors = np.linalg.svd(derivatives / lengths, full_matrices=False)
    values = np.maximum(values, 1e-15 * values.max(initial=1e-300))
    found: Floats = (vectors.T / values**2) @ vectors / np.outer(lengths, lengths)
    return (found + found.T) / 2
