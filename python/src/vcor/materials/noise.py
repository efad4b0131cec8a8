"""Errors of data: what is stated or estimated of them, their last digits, and the model's own."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np
from scipy.optimize import brentq

from .._library import Floats, InputError, UsageError
from .._text import option
from .observations import Block


class Noise:
    """Standard errors of data, from three sources.

    A *stated* error, or one that is estimated from the misfit: then all data have the same part of
    their size, the scatter. The *rounding* to the last digit of a datum. The error of the *model's*
    own solution. The last two are a floor: however well a curve goes through the data, they say
    nothing below it.
    """

    def __init__(self, blocks: Sequence[Block], errors: Mapping[str, float]) -> None:
        """Collect the errors of all data of the blocks.

        `errors` has relative standard errors > 0 by quantity, for data without their own.
        UsageError: an error <= 0, or of a quantity that the data do not have or that has its own.
        InputError: some data have a standard error and others none, or a datum without an error is
        not positive.
        """
        quantity = [name for block in blocks for name in block.quantity]
        sources = [block.source for block in blocks for _ in block.quantity]
        value, self._scale, self._digit, at, sigma = (
            np.concatenate([getattr(block, name) for block in blocks])
            for name in ("value", "scale", "digit", "at", "sigma")
        )
        for name, error in errors.items():
            said = option("errors", {name: error})
            if not 0 < error < math.inf:
                raise UsageError(f"{said}: expected a number > 0")
            if name not in quantity:
                known = ", ".join(dict.fromkeys(quantity))
                raise UsageError(f"{said}: the data have no such column, they are {known}")
            if not np.isnan(sigma[np.equal(quantity, name)]).any():
                raise UsageError(f"{said}: these data have errors of their own")
        given = np.array([errors.get(name, np.nan) for name in quantity])
        self._stated = np.where(np.isnan(sigma), given * self._scale, sigma)
        missing = np.isnan(self._stated)
        if missing.any() and not missing.all():
            i = int(np.argmax(missing))
            raise InputError(
                f"{sources[i]}: some data have a standard error, {quantity[i]} at "
                f"{at[i]:.6g} has none: give a column {quantity[i]}_sigma with "
                f"a number there, or {option('errors', {quantity[i]: 0.02})}"
            )
        #: Whether the scatter is to be estimated
        self.estimated = bool(missing.all())
        stated = self._scale if self.estimated else self._stated
        if not (stated > 0).all():
            i = int(np.argmin(stated > 0))
            raise InputError(f"{sources[i]}: found a {quantity[i]} of {value[i]:.6g}, "
                             "expected one > 0, or with a standard error")  # fmt: skip
        rows = list(zip(quantity, value, strict=True))
        count = Counter(rows)
        self._copies = np.array([count[row] for row in rows])

    def sigma(self, scatter: float, model: Floats) -> Floats:
        """Standard error of each datum for a scatter and the errors of the model, shape (n,)."""
        stated = scatter * self._scale if self.estimated else self._stated
        # data that read the same have the same rounding, not one each, unless they scatter: what
        # a normal scatter leaves of the correlation (Widrow & Kollar 2008, Quantization Noise)
        same = np.exp(-((2 * math.pi * stated / self._digit) ** 2))
        rounding = self._digit**2 / 12 * (1 + (self._copies - 1) * same)
        sigma: Floats = np.sqrt(stated**2 + rounding + model**2)
        return sigma

    def scatter(self, misfit: Floats, model: Floats, expected: float) -> float:
        """Scatter with which the sum of (misfit/sigma)^2 is as expected; 0 if the floor is more."""

        def excess(scatter: float) -> float:
            """Sum of (misfit/sigma)^2 less the expected one."""
            return float(np.sum((misfit / self.sigma(scatter, model)) ** 2)) - expected

        most = float(np.linalg.norm(misfit / self._scale)) / math.sqrt(expected)
        if excess(0.0) <= 0:
            return 0.0
        return float(brentq(excess, 0.0, 1.01 * most, xtol=1e-4 * most))

    def relative(self, sigma: Floats) -> float:
        """Root of the mean square of standard errors as parts of the data."""
        return float(np.sqrt(np.mean((sigma / self._scale) ** 2)))
