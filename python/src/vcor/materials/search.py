"""Search of the parameters with which a case follows data: least squares in their logarithms."""

from __future__ import annotations

import itertools
import math
import re
import time
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from scipy.optimize import least_squares

from .._differences import slopes
from .._library import Error, Floats, InputError, NumericalError, UsageError
from .._text import option
from ..case import Case, number
from .noise import Noise
from .observations import Block, Impacts, velocity_of

#: Step of the logarithms of parameters for derivatives of fourth order, which errors are made of
STEP = 0.02
#: The same for those of first order, which lead downhill, the largest part of a datum that such a
#: step may change, and how often it is shortened for that
STRIDE, MOVED, SHORTER = 1e-3, 0.05, 3
#: Points that a fit may start from, and how many of them do
STARTS, REFINED = 64, 4
#: Time of a fit that is announced [s], and how often it solves all impacts, by the third power of
#: its parameters: six fits of two or three took 0.7 to 2.3 times as long, with their intervals
LONG, SOLVED = 60.0, 20
#: Times the usual number of steps of an impact that a start may take
DEAR = 100
#: Parts in which the starts are tried
PARTS = 32
#: Logarithm of the factor from the first guess beyond which parameters are not followed
FARTHEST = math.log(1e12)
#: Part of the largest slope below which a parameter has vanished
VANISHED = 1e-3
#: Rounds in which the errors of the data follow the fit, and their change that ends them
ROUNDS, SETTLED = 8, 0.01


class Corrected(Protocol):
    """Impacts of a problem by corrected thin mechanics."""

    thin: Case
    #: Errors of the exact data of each block of impacts
    errors: list[Floats]

    def predict(self, values: Floats) -> list[Floats]:
        """Data of each block of impacts for each row of values, shape (rows, n)."""


class Problem:
    """Residuals of all data as functions of the logarithms x of the parameters."""

    def __init__(
        self, case: Case, free: Sequence[str], blocks: Sequence[Block],
        errors: Mapping[str, float], bar: Any,
    ) -> None:  # fmt: skip
        """Set up the search for `free`, addresses of numbers > 0, from their values in the case.

        `errors` as in `Noise`; `bar` shows progress. UsageError: a first guess that is not > 0.
        InputError: fewer data than parameters, or none left to estimate their scatter from.
        """
        self.case, self.free, self.blocks, self.bar = case, list(free), list(blocks), bar
        self.impacts = [block for block in blocks if isinstance(block, Impacts)]
        #: Velocities of the first impacts, or of the case [m/s]
        own = np.array([velocity_of(case)])
        self.speeds = next((block.velocity for block in self.impacts), own)
        self.quantity = [name for block in blocks for name in block.quantity]
        self.value = np.concatenate([block.value for block in blocks])
        scale = np.concatenate([block.scale for block in blocks])
        #: Size of each datum
        self.scale = np.where(scale > 0, scale, math.inf)
        #: Which data are of impacts without their records
        self.is_impact = np.repeat([isinstance(block, Impacts) for block in blocks],
                                   [len(block.value) for block in blocks])  # fmt: skip
        self.noise = Noise(blocks, errors)
        values = np.array([number(case, address) for address in free])
        if not (values > 0).all():
            address = free[int(np.argmin(values > 0))]
            what = f"found {case[address]}"
            what = "the case does not give it" if case[address] is None else what
            raise UsageError(f"{address}: {what}, expected a number > 0 as first guess")
        guess = np.log(values)
        self.guess = guess
        # steps against an end of a range that is not known would hold up all parameters
        self.low, self.high = (
            np.array([_farthest(case, *one, reach) for one in zip(free, guess, strict=True)])
            for reach in (-FARTHEST, FARTHEST)
        )
        self._last = np.empty(0), np.empty(0)
        #: Thin mechanics, corrected, in the place of those of the case
        self.corrected: Corrected | None = None
        self._check_count()
        #: Relative scatter of the data, if it is estimated
        self.scatter = 1.0
        #: Standard error of each datum; the errors of the solution come with the search
        self.sigma = self.noise.sigma(self.scatter, np.zeros(len(self.value)))

    def _check_count(self) -> None:
        """Refuse data that are too few, copies counted as one."""
        places = [(k, *one) for k, block in enumerate(self.blocks) for one in block.place]
        where = [*zip(self.quantity, places, strict=True)]
        several = {*zip(where, self.value, strict=True)}
        #: Degrees of freedom; what a record leaves unknown counts, too
        self.dof = len(self.value) - len(self.free) - sum(block.unknowns for block in self.blocks)
        few = self.dof < (1 if self.noise.estimated else 0)
        # copies of a datum neither determine more nor show how much data scatter
        few |= len({*where}) < len(self.free)
        few |= self.noise.estimated and len(several) <= len(self.free)
        if few:
            files = ", ".join(dict.fromkeys(block.source for block in self.blocks))
            found = min(len({*where}), len(several))
            n = len(self.free)
            line = f"{files}: found {found} distinct dat{'a' if found > 1 else 'um'} for {n} "
            line += f"parameter{'s' * (n > 1)}, expected more"
            if self.noise.estimated and self.dof >= 0 and len({*where}) >= n:
                # nothing is left to estimate a scatter from
                line += f", or their errors: {option('errors', {self.quantity[0]: 0.01})}"
            raise InputError(line)

    def correct(self, corrected: Corrected | None) -> None:
        """Predict impacts by corrected thin mechanics from here on, or by the case."""
        self.corrected, self._last = corrected, (np.empty(0), np.empty(0))

    @property
    def quick(self) -> Case:
        """The case, or its thin mechanics if these are corrected."""
        return self.corrected.thin if self.corrected else self.case

    def parts(self, values: Floats) -> list[Floats]:
        """Numbers of all data by their blocks."""
        ends = np.cumsum([len(block.value) for block in self.blocks])[:-1]
        return np.split(values, ends)

    def _errors_of_model(self, x: Floats) -> Floats:
        """Errors of the solutions at x, of each datum, shape (data,)."""
        if self.corrected:
            own = iter(self.corrected.errors)
            return np.concatenate([
                next(own) if isinstance(block, Impacts)
                else block.error_of_model(self.case, self.free, np.exp(x))
                for block in self.blocks
            ])  # fmt: skip
        errors = [block.error_of_model(self.case, self.free, np.exp(x)) for block in self.blocks]
        return np.concatenate(errors)

    def predict(self, x: Floats, near: Floats | None = None) -> Floats:
        """Data for each row of x, shape (rows, data), on the meshes that suit the point `near`."""
        values, middle = np.exp(x), None if near is None else np.exp(near)
        self.bar.update(len(x) * sum(len(impacts.velocity) for impacts in self.impacts))
        corrected = iter(self.corrected.predict(values) if self.corrected else ())
        return np.hstack([
            next(corrected) if self.corrected and isinstance(block, Impacts)
            else block.predict(self.case, self.free, values, middle)
            for block in self.blocks
        ])  # fmt: skip

    def residuals(self, x: Floats) -> Floats:
        """Residuals at one point, shape (data,); the last data are kept."""
        if not np.array_equal(x, self._last[0]):
            self._last = x.copy(), self.predict(x[None])[0] - self.value
        residuals: Floats = self._last[1] / self.sigma
        return residuals

    def derivatives(self, x: Floats) -> tuple[Floats, float]:
        """Derivatives of the residuals, shape (data, parameters), and their error, a norm."""
        near, far = (
            np.nan_to_num(slopes(lambda steps: self.predict(x + steps, x), len(x), step))
            / self.sigma[:, None]
            for step in (STEP, 2 * STEP)
        )
        return near, float(np.linalg.norm(near - far))

    def elasticities(self, x: Floats, probe: Impacts, names: Sequence[str]) -> Floats:
        """Derivatives of logarithms of quantities, shape (impacts and names, parameters)."""

        def logarithms(steps: Floats) -> Floats:
            """Logarithms of the quantities, shape (points, impacts and names), for steps from x."""
            found = probe.quantities(
                self.quick, self.free, np.exp(x + steps), list(names), middle=np.exp(x)
            )
            return np.log(np.abs(found.reshape(len(steps), -1)))

        return slopes(logarithms, len(x), STEP)

    def downhill(self, x: Floats, which: list[int]) -> Floats:
        """Derivatives of the residuals by some of the parameters, one-sided: good for descent."""
        here, steps = self.value + self.sigma * self.residuals(x), STRIDE * np.eye(len(x))[which]
        found = self.predict(x + steps)
        if np.isnan(found).any():
            steps = -steps
            found = self.predict(x + steps)
        # the data follow no line as far as that, or have no results, where the effects of two
        # parameters all but cancel: of a shift's activation energy beside its reference temperature
        for _ in range(SHORTER):
            moved = np.nan_to_num((np.abs(found - here) / self.scale).max(axis=1), nan=math.inf)
            if not (far := moved > MOVED).any():
                break
            steps[far] *= np.fmax(MOVED / 2 / moved[far, None], MOVED)
            found[far] = self.predict(x + steps[far])
        change = (found - here) / self.sigma
        slope: Floats = np.nan_to_num(change / steps.sum(axis=1)[:, None]).T
        return slope

    def minimize(
        self, x: Floats, which: Sequence[int], most: int = 60, tolerance: float = 1e-12,
        *, ranges: tuple[Floats, Floats] | None = None, again: bool = True,
    ) -> tuple[Floats, float]:  # fmt: skip
        """Least squares in some of the parameters from x; inf where there is no result."""
        which, x = list(which), x.copy()
        low, high = ranges or (self.low, self.high)
        x[which] = np.clip(x, low + 1e-6, high - 1e-6)[which]

        def full(part: Floats) -> Floats:
            """All parameters, with some of them replaced."""
            x[which] = part
            return x

        if not np.isfinite(self.residuals(x)).all():
            return x, math.inf
        if which:
            found = least_squares(
                lambda part: self.residuals(full(part)),
                x[which],
                lambda part: self.downhill(full(part), which),
                bounds=(low[which], high[which]),
                xtol=1e-12, ftol=tolerance, gtol=1e-12, max_nfev=most,
            )  # fmt: skip
            full(found.x)
            lengths = np.linalg.norm(found.jac, axis=0)
            vanished = [which[i] for i in np.flatnonzero(lengths < VANISHED * lengths.max())]
            if again and vanished:
                # a modulus next to 0 has no slope that leads back
                other = x.copy()
                other[vanished] = self.guess[vanished]
                other, chi2 = self.minimize(
                    other, which, most, tolerance, ranges=ranges, again=False
                )
                if chi2 < 2 * found.cost:
                    return other, chi2
        return x, float(np.sum(self.residuals(x) ** 2))

    def best(self, seed: int) -> tuple[Floats, float]:
        """The smallest sum of squares from several starts, the first one the case itself."""
        x = self.guess
        spread = np.random.default_rng(seed).uniform(-math.log(10), math.log(10), (STARTS, len(x)))
        # of impacts that fail slowly, or hardly rebound and take as long, one is enough; all in
        # parts, for the bar and Ctrl-C
        for impacts, place in itertools.product(self.impacts, (0.5, 0.0, 1.0)):
            found_steps = []
            for part in np.array_split(spread, PARTS):
                found_steps.append(impacts.steps(self.quick, self.free, np.exp(x + part), place))
                self.bar.update(len(part))
            steps = np.concatenate(found_steps)
            usual = np.median(steps[np.isfinite(steps)]) if np.isfinite(steps).any() else 0.0
            spread = spread[steps <= DEAR * usual]
        starts = np.vstack([x, x + spread])
        found_there = np.vstack([self.predict(part) for part in np.array_split(starts, PARTS)])
        sums = np.sum(((found_there - self.value) / self.sigma) ** 2, axis=1)
        order = np.argsort(np.where(np.isnan(sums), np.inf, sums), kind="stable")[:REFINED]
        if not np.isfinite(sums[order[0]]):
            raise NumericalError(f"{self.case.name}: no start of the parameters has a result for "
                                 "all data")  # fmt: skip
        begin = time.perf_counter()
        self.residuals(starts[order[0]])
        if not self.corrected:
            self.announce(SOLVED * len(x) ** 3 * (time.perf_counter() - begin))
        every = range(len(x))
        found: list[tuple[Floats, float]] = []
        for i in dict.fromkeys([0, *order]):
            found.append(self.minimize(starts[i], every, 30))
            found.sort(key=lambda one: one[1])
            # the same from two starts
            if len(found) > 1 and found[1][1] < (1 + 1e-6) * found[0][1]:
                break
        return self.settle(self.in_order(found[0][0]))

    def announce(self, seconds: float) -> None:
        """Say how long the fit takes, if that is long."""
        if seconds > LONG:
            warnings.warn(f"{self.case.name}: the fit takes some {math.ceil(seconds / 60)} min; "
                          "fewer data, or means of repeated ones, take less",
                          stacklevel=3)  # fmt: skip

    def settle(self, x: Floats) -> tuple[Floats, float]:
        """The smallest sum of squares near x, with errors of the data that belong to it."""
        for _ in range(ROUNDS):
            before = self.sigma
            model = self._errors_of_model(x)
            if self.noise.estimated:
                misfit = self.sigma * self.residuals(x)
                self.scatter = self.noise.scatter(misfit, model, self.dof)
            self.sigma = self.noise.sigma(self.scatter, model)
            x, chi2 = self.minimize(x, range(len(x)))
            if (np.abs(self.sigma / before - 1) < SETTLED).all():
                break
        return x, chi2

    def likelihood(self, x: Floats) -> float:
        """-2 times the logarithm of the likelihood, but for a constant of the data."""
        misfit, sigma = self.sigma * self.residuals(x), self.sigma
        if self.noise.estimated:
            model = self._errors_of_model(x)
            sigma = self.noise.sigma(self.noise.scatter(misfit, model, len(misfit)), model)
        excess = np.log(sigma**2 / self.noise.sigma(1.0, np.zeros(len(sigma))) ** 2)
        return float(np.sum((misfit / sigma) ** 2 + excess * self.noise.estimated))

    def in_order(self, x: Floats) -> Floats:
        """The same with the terms of series in the order of their times in the guess."""
        x = x.copy()
        terms: dict[tuple[str, str], list[int]] = {}
        for i, address in enumerate(self.free):
            if found := re.fullmatch(r"(.+\.)(moduli|times|rates)\(\d+\)", address):
                terms.setdefault((found[1], found[2]), []).append(i)
        for (name, key), times in terms.items():
            moduli = terms.get((name, "moduli"), [])
            if key != "moduli" and len(moduli) == len(times):
                wanted, order = np.argsort(self.guess[times]), np.argsort(x[times])
                for places in (times, moduli):
                    x[np.array(places)[wanted]] = x[np.array(places)[order]]
        return x


def _farthest(case: Case, address: str, inside: float, reach: float) -> float:
    """How far the logarithm of a parameter may go from a value: its reach, or the range ends."""
    case, end = case.copy(), inside + reach
    far = end
    while abs(end - inside) > 1e-9:
        try:
            case[address] = math.exp(far)
            inside = far
        except Error:
            end = far
        far = (inside + end) / 2
    return inside
