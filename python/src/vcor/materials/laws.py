"""Fits of the models with a few parameters: sls, power_law, cerf, mittag_leffler.

All are E_0 + E_1 f(t/tau; a), linear in two moduli for a given shape, a time, an exponent or both;
f is the library's. So the shapes are scanned in the whole range that the data resolve, with the
best two moduli of each, and every local minimum of the scan starts an iteration: no start is
guessed.

Near a solution that the data determine well the sum of squares is quadratic, and its derivatives
give the standard errors. It is not if a parameter is known only to some ten percent, or is at the
end of its range. Then each parameter in turn is held at other values while the others are fitted
again: the interval of three standard errors ends where the sum of squares has risen by 3^2
variances (profile likelihood: D. M. Bates and D. G. Watts, Nonlinear Regression Analysis and Its
Applications, Wiley 1988, chapter 6). The standard error is a third of the distance to the farther
end; for a quadratic sum of squares it is the usual one.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import minimum_filter
from scipy.optimize import brentq

from .._library import Floats, NumericalError
from .._text import option
from ..case import Case
from .samples import BESIDE, Problem, Samples

#: Factors from the times and moduli of the data to the ends of the range of a fit, and to those of
#: the range in which the interval of a parameter is looked for
TIME_MARGIN, MODULUS_MARGIN, INTERVAL_MARGIN = 1e4, 1e6, 1e8
#: Least exponent
LEAST_EXPONENT = 1e-3
#: Times of the scan per decade, and the factor from the data to its ends; exponents of the scan
PER_DECADE, SCAN_MARGIN = 4, 1e2
EXPONENTS = (0.02, *np.arange(0.05, 0.96, 0.05).round(2), 0.98)
#: Most minima of the scan from which an iteration starts
MOST_STARTS = 6
#: Standard errors to the end of an interval
REACH = 3.0
#: Relative error up to which the derivatives suffice: it has itself an error of some three times
#: this
ENOUGH = 0.02
#: Steps of the differences: of a logarithm of time, and of an exponent
STEP = 3e-5
#: Case of the shape of a law
_CASE = """&impact velocity = 1.0 /
&sphere radius = 1.0, mass = 1.0, material = 'm' /
&plate material = 'm', waves = 'none' /
&material name = 'm', model = '{}', poisson_ratio = 0.5, {} /
"""


@dataclass(frozen=True)
class Law:
    """A model E_0 + E_1 f(t/tau; a)."""

    #: Its parameters, and their units
    units: Mapping[str, str]
    #: The values of f: E_0 = 0, E_1 = 1 Pa, tau = 1 s
    shape: Mapping[str, float]
    #: Parameter of the time, and d ln(parameter)/d ln(tau)
    time: str = ""
    power: float = 0.0
    #: Parameter that may be 0, and largest exponent
    vanishing: str = "equilibrium_modulus"
    most_exponent: float = 1.0


LAWS = {
    "sls": Law(
        {"glassy_modulus": "Pa", "alpha": "1/s", "beta": "1/s"},
        {"glassy_modulus": 1, "alpha": 0, "beta": 1}, "beta", -1.0, "alpha",
    ),
    "power_law": Law(
        {"equilibrium_modulus": "Pa", "coefficient": "Pa s^a", "exponent": "1"},
        {"equilibrium_modulus": 0, "coefficient": 1, "exponent": 0.5}, most_exponent=0.9999,
    ),
    "cerf": Law(
        {"equilibrium_modulus": "Pa", "relaxing_modulus": "Pa", "beta": "s^-1/2"},
        {"equilibrium_modulus": 0, "relaxing_modulus": 1, "beta": 1}, "beta", -0.5,
    ),
    "mittag_leffler": Law(
        {"equilibrium_modulus": "Pa", "relaxing_modulus": "Pa", "exponent": "1", "time": "s"},
        {"equilibrium_modulus": 0, "relaxing_modulus": 1, "exponent": 0.5, "time": 1},
        "time", 1.0,
    ),
}  # fmt: skip


@dataclass
class Found:
    """Result of a fit, in the order of the parameters."""

    values: Floats
    errors: Floats
    #: free, fixed or bound
    states: list[str]
    correlation: Floats
    structured: bool


class LawProblem(Problem):
    """Residuals of a law by the logarithms of its free parameters; one that may be 0 is linear."""

    def __init__(self, model: str, fixed: Mapping[str, float], samples: Samples) -> None:
        """Set up a fit of `model` to samples; `fixed` has given parameters in SI units."""
        self.model, self.law, self.samples = model, LAWS[model], samples
        self.names = list(self.law.units)
        self.values = np.array([fixed.get(name, 1.0) for name in self.names])
        self.states = ["fixed" if name in fixed else "free" for name in self.names]
        #: Size of the parameter that may be 0, else 0
        self.unit = np.zeros(len(self.names))
        self.vanishing = self.names.index(self.law.vanishing)
        modulus = self.law.vanishing == "equilibrium_modulus"
        self.unit[self.vanishing] = samples.softest if modulus else 1 / samples.last_time
        keys = ", ".join(f"{key} = {value}" for key, value in self.law.shape.items())
        self.case = Case(_CASE.format(model, keys))
        self.material = self.case.material("m")
        self.set_free(TIME_MARGIN)

    def set_free(self, margin: float) -> None:
        """List the free parameters, and their limits for times beyond the data by a factor."""
        self.free = np.flatnonzero(np.array(self.states) == "free")
        first, last = self.samples.first_time / margin, self.samples.last_time * margin
        softest = math.log(self.samples.softest / MODULUS_MARGIN)
        hardest = math.log(self.samples.moduli.max() * MODULUS_MARGIN)
        low, high = [], []
        for k in self.free:
            unit = self.law.units[self.names[k]]
            ends = softest, hardest
            if self.unit[k] > 0:
                ends = 0.0, math.inf
            elif self.names[k] == self.law.time:
                one, other = (self.law.power * math.log(time) for time in (first, last))
                ends = min(one, other), max(one, other)
            elif unit == "1":
                ends = math.log(LEAST_EXPONENT), math.log(self.law.most_exponent)
            elif unit == "Pa s^a":
                # C of C t^-a may have any value
                ends = softest + min(0.0, math.log(first)), hardest + max(0.0, math.log(last))
            low.append(ends[0])
            high.append(ends[1])
        self.low, self.high = np.array(low), np.array(high)

    def variables(self, values: Floats) -> Floats:
        """Variables of the free parameters from the values of all."""
        x = np.log(np.maximum(values, 1e-300))[self.free]
        may_vanish = self.unit[self.free] > 0
        x[may_vanish] = values[self.free][may_vanish] / self.unit[self.free][may_vanish]
        found: Floats = np.clip(x, self.low, self.high)
        return found

    def all(self, x: Floats) -> Floats:
        """Values of all parameters from the variables."""
        values = self.values.copy()
        for k, one in zip(self.free, x, strict=True):
            values[k] = one * self.unit[k] if self.unit[k] > 0 else math.exp(one)
        return values

    def parts(self, values: Floats) -> tuple[Any, Any, Any, Any]:
        """E_0, E_1, tau and exponent of values of the parameters; these may be rows."""
        given = dict(zip(self.names, values, strict=True))
        if self.model == "sls":
            rest = np.minimum(given["alpha"] / given["beta"], 1 - 1e-12)
            moduli = given["glassy_modulus"] * rest, given["glassy_modulus"] * (1 - rest)
        else:
            moduli = values[0], values[1]
        tau = given[self.law.time] ** (1 / self.law.power) if self.law.time else 1.0
        return *moduli, tau, given.get("exponent")

    def shape(self, tau: Any, exponent: float | None) -> Floats:
        """Moduli f of the shape at the samples, shape (..., m)."""
        if exponent is not None:
            self.case["m.exponent"] = float(exponent)
        x = np.multiply.outer(1 / np.asarray(tau, dtype=float), self.samples.at)
        if self.samples.dynamic:
            x = np.multiply.outer(np.asarray(tau, dtype=float), self.samples.at)
            found = self.material.complex_modulus(x)
            return np.concatenate([found.real, found.imag], axis=-1)
        return self.material.relaxation(x)

    def moduli(self, values: Floats) -> Floats:
        """Moduli at the samples [Pa]."""
        rest, relaxing, tau, exponent = self.parts(values)
        found: Floats = rest * self.samples.ones + relaxing * self.shape(tau, exponent)
        return found

    def residuals(self, x: Floats) -> Floats:
        """Logarithms of model/data."""
        return self.samples.logs(self.moduli(self.all(x)))

    def jacobian(self, x: Floats) -> Floats:
        """Their derivatives, those of the shape by differences."""
        values = self.all(x)
        rest, relaxing, tau, exponent = self.parts(values)
        shapes = self.shape(tau * np.exp([0.0, STEP, -STEP]), exponent)
        model = rest * self.samples.ones + relaxing * shapes[0]
        by_time = relaxing * (shapes[1] - shapes[2]) / (2 * STEP)
        columns = []
        for k in self.free:
            name = self.names[k]
            if name == "exponent":
                low, high = exponent * math.exp(-STEP), exponent * math.exp(STEP)
                high = min(high, self.law.most_exponent)
                rise = self.shape(tau, high) - self.shape(tau, low)
                column = relaxing * rise / math.log(high / low)
            elif self.model == "sls":
                glassy, alpha, beta = values
                alike = self.samples.ones - shapes[0]
                column = {
                    "glassy_modulus": model,
                    "alpha": glassy / beta * self.unit[k] * alike,
                    "beta": -by_time - glassy * alpha / beta * alike,
                }[name]
            elif name == self.law.time:
                column = by_time / self.law.power
            elif name == "equilibrium_modulus":
                column = self.unit[k] * self.samples.ones
            else:
                column = relaxing * shapes[0]
            columns.append(column)
        found: Floats = np.array(columns).T / np.maximum(model, 1e-200)[:, None]
        return found

    def starts(self) -> list[Floats]:
        """Values of all parameters at the local minima of a scan of all shapes, lowest first."""
        times, exponents = self._scan()
        grid = np.empty((len(self.names), len(times), len(exponents)))
        cost = np.empty(grid.shape[1:])
        for j, exponent in enumerate(exponents):
            shapes = self.shape(times, exponent)
            grid[:, :, j] = self._best_moduli(shapes, times, exponent)
            rest, relaxing, *_ = self.parts(grid[:, :, j])
            model = rest[:, None] * self.samples.ones + relaxing[:, None] * shapes
            cost[:, j] = np.sum(self.samples.logs(model) ** 2, axis=1)
        cost = np.where(np.isfinite(cost), cost, np.inf)
        lowest = (cost <= minimum_filter(cost, 3, mode="nearest")) & np.isfinite(cost)
        places = sorted(np.argwhere(lowest).tolist(), key=lambda one: cost[*one])
        return [grid[:, i, j] for i, j in places[:MOST_STARTS]]

    def _scan(self) -> tuple[Floats, list[Any]]:
        """Times and exponents of the scan, one if it is given or if there is none."""
        given = dict(zip(self.names, zip(self.values, self.states, strict=True), strict=True))
        first = self.samples.first_time / SCAN_MARGIN
        last = self.samples.last_time * SCAN_MARGIN
        times = np.geomspace(first, last, 1 + math.ceil(PER_DECADE * math.log10(last / first)))
        if not self.law.time:
            times = np.ones(1)
        elif given[self.law.time][1] != "free":
            times = np.array([given[self.law.time][0] ** (1 / self.law.power)])
        exponents: list[Any] = [None]
        if "exponent" in given:
            value, state = given["exponent"]
            exponents = list(EXPONENTS) if state == "free" else [value]
        return times, exponents

    def _best_moduli(self, shapes: Floats, times: Floats, exponent: Any) -> Floats:
        """Values of all parameters with the two moduli >= 0 of least relative misfit, by shape."""
        data = self.samples.data
        columns = np.stack([np.broadcast_to(self.samples.ones / data, shapes.shape), shapes / data])
        target = np.ones(shapes.shape)
        known = [None, None] if self.model == "sls" else [
            value if state != "free" else None
            for value, state in zip(self.values[:2], self.states[:2], strict=True)
        ]  # fmt: skip
        for i, value in enumerate(known):
            if value is not None:
                target = target - value * columns[i]
        product = np.einsum("itm,jtm->ijt", columns, columns)
        right = np.maximum(np.einsum("itm,tm->it", columns, target), 0.0)
        alone = right / np.maximum(np.einsum("iit->it", product), 1e-300)
        determinant = product[0, 0] * product[1, 1] - product[0, 1] ** 2
        full = np.einsum("itm,tm->it", columns, target)
        with np.errstate(divide="ignore", invalid="ignore"):
            both = np.stack([
                product[1, 1] * full[0] - product[0, 1] * full[1],
                product[0, 0] * full[1] - product[0, 1] * full[0],
            ]) / determinant  # fmt: skip
        first = np.where(both[1] < 0, alone[0], 0.0)
        second = np.where(both[1] < 0, 0.0, alone[1])
        good = (both >= 0).all(axis=0)
        found = np.where(good, both, [first, second])
        for i, value in enumerate(known):
            if value is not None:
                found[i], found[1 - i] = value, alone[1 - i]
        found = np.maximum(found, 1e-3 * self.samples.softest)
        rows = {
            "equilibrium_modulus": found[0], "glassy_modulus": found.sum(axis=0),
            "relaxing_modulus": found[1], "coefficient": found[1],
            "alpha": found[0] / found.sum(axis=0) / times, "exponent": exponent,
        }  # fmt: skip
        if self.law.time:
            rows[self.law.time] = times**self.law.power
        values = np.array([np.broadcast_to(rows[name], times.shape) for name in self.names])
        for k, state in enumerate(self.states):
            if state != "free":
                values[k] = self.values[k]
        return values


def fit_law(model: str, fixed: Mapping[str, float], samples: Samples) -> tuple[LawProblem, Found]:
    """Fit a law to samples."""
    problem = LawProblem(model, fixed, samples)
    trials = [problem.minimize(problem.variables(start)) for start in problem.starts()]
    if not trials:
        raise NumericalError(f"model {model} does not resemble the data")
    x, squares, converged = min(trials, key=lambda one: one[1])
    problem.values = problem.all(x)
    converged = _follow_bounds(problem, squares) and converged
    if not converged:
        raise NumericalError(
            f"the fit of model {model} does not converge: give parameters with "
            f"{option('fix')}, or another model"
        )
    states, values = problem.states, problem.values
    whole = copy.copy(problem)
    whole.states = ["free" if state == "bound" else state for state in states]
    whole.set_free(INTERVAL_MARGIN)
    x = whole.variables(values)
    r = whole.residuals(x)
    free = np.array(states)[whole.free] == "free"
    try:
        inverse, variance, structured = whole.scatter(whole.jacobian(x), r, free)
    except NumericalError as error:
        raise NumericalError(
            f"{error} of model {model}: take fewer, by {option('fix')}, or another model"
        ) from None
    deviations = np.sqrt(np.diag(inverse))
    sizes = np.where(whole.unit > 0, whole.unit, values)[whole.free]
    errors, correlation = np.zeros(len(values)), np.zeros((len(values), len(values)))
    errors[whole.free] = sizes * deviations * math.sqrt(variance)
    correlation[np.ix_(whole.free, whole.free)] = inverse / np.outer(deviations, deviations)
    if (errors > ENOUGH * np.maximum(values, whole.unit)).any():
        _widen(whole, errors, float(r @ r), variance)
    return problem, Found(values, errors, states, correlation, structured)


def _follow_bounds(problem: LawProblem, squares: float) -> bool:
    """Take parameters to the ends of their ranges where that fits as well: a modulus or rate to 0.

    Others that diverge keep the end of the range of the fit as their value.
    """
    converged = True
    for _ in range(len(problem.free)):
        x = problem.variables(problem.values)
        beside = np.minimum(x - problem.low, problem.high - x)
        if not len(x) or beside.min() > BESIDE:
            break
        i = int(np.argmin(beside))
        k = int(problem.free[i])
        end = problem.low[i] if x[i] - problem.low[i] < BESIDE else problem.high[i]
        held = copy.copy(problem)
        held.states, held.values = list(problem.states), problem.values.copy()
        held.states[k] = "bound"
        held.values[k] = end * held.unit[k] if held.unit[k] > 0 else math.exp(end)
        held.set_free(TIME_MARGIN)
        x, there, good = held.minimize(held.variables(held.values))
        if there > squares * (1 + 1e-6) + 1e-20 * len(problem.samples.data):
            break
        converged = good
        problem.states, problem.free, problem.low, problem.high = (
            held.states, held.free, held.low, held.high,
        )  # fmt: skip
        problem.values, squares = held.all(x), min(squares, there)
    return converged


def _widen(problem: LawProblem, errors: Floats, squares: float, variance: float) -> None:
    """Replace the standard errors by those of intervals."""
    for k in problem.free:
        ends = [_end(problem, int(k), side, errors[k], squares, variance) for side in (-1, 1)]
        value = problem.values[k]
        errors[k] = max(abs(end - value) for end, _ in ends) / REACH
        # the interval does not end: not even the order of magnitude is known
        if any(is_open for _, is_open in ends):
            errors[k] = max(errors[k], value)


def _end(
    problem: LawProblem, k: int, side: int, error: float, squares: float, variance: float
) -> tuple[float, bool]:
    """One end of the interval of a parameter, and whether it may lie beyond."""
    best, unit = problem.values[k], problem.unit[k]
    i = int(np.flatnonzero(problem.free == k)[0])
    held = copy.copy(problem)
    held.states = list(problem.states)
    held.states[k] = "fixed"
    held.set_free(INTERVAL_MARGIN)
    # one that may be 0 is a term of a sum and goes in steps, any other is a factor
    if unit > 0:
        bounded = side < 0
        limit = best if bounded else 1e6 * max(best, unit)
        step = min(REACH * error, max(best, unit))
    else:
        bounded = side > 0 and problem.names[k] == "exponent"
        limit = side * ((problem.low if side < 0 else problem.high)[i] - math.log(best))
        step = min(REACH * error / best, 0.7)
    solutions = {0.0: held.variables(problem.values)}
    enough = squares + REACH**2 * variance

    def place(step: float) -> float:
        """The number at a distance from the best one."""
        return float(max(0.0, best + side * step) if unit > 0 else best * math.exp(side * step))

    def rise(step: float) -> float:
        """Root of the rise of the sum of squares, in standard deviations, less those wanted."""
        held.values = problem.values.copy()
        held.values[k] = place(step)
        inside = max((one for one in solutions if one <= step), default=0.0)
        x, found, _ = held.minimize(solutions[inside], 1e-6, 60)
        # another valley may be lower; a scan of time and exponent takes as long as the whole fit
        if found > enough and not ("exponent" in held.names and held.law.time):
            for start in held.starts():
                y, other, _ = held.minimize(held.variables(start), 1e-6, 60)
                if other < found:
                    x, found = y, other
        if found < enough:
            solutions[step] = x
        return math.sqrt(max(0.0, found - squares) / variance) - REACH

    limit, inside = max(0.0, limit), 0.0
    step = min(step, limit)
    while (over := rise(step)) < 0:
        if step >= limit:
            return place(limit), not bounded
        inside, step = step, min(limit, step * min(2.0, 1.05 * REACH / max(over + REACH, 1.0)))
    if over > 0.05:
        step = brentq(rise, inside, step, xtol=5e-3 * step, rtol=1e-10)
    return place(step), False
