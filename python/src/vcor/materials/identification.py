"""Identification of parameters from measured impacts, records of force and moduli.

Least squares of (model - datum)/sigma over the logarithms of the parameters. What the data do not
determine is found from the singular values of the derivatives, and said instead of a number.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import least_squares
from scipy.special import chdtri, ndtri, stdtrit

from .. import _command, _library, _text
from .._library import MOST_SEED, Error, Floats, InputError, NumericalError, UsageError, whole
from ..case import Case, as_case, listed, number, progress_bar, read, scalars, with_material
from .data import Columns, Units, add_data_options, columns_option
from .fit import fit
from .observations import (
    COEFFICIENTS,
    Block,
    File,
    Impacts,
    Record,
    Source,
    materials_of,
    observations,
    sharpen,
    velocity_of,
    window,
)

#: Accuracy of the impacts; derivatives are differences of them
ACCURACY = 1e-9
#: Step of the logarithms of parameters for derivatives
STEP = 1e-3
#: Standard error of the logarithm of a combination above which it is not determined: a factor e,
#: if its parameters have no limit on either side
UNDETERMINED = 1.0
#: Levels of the intervals
LEVELS = (0.6827, 0.95)
#: Points that a fit may start from, and how many of them do
STARTS, REFINED = 64, 4
#: Logarithms of the factors from the first guess beyond which an interval is open, and the others
#: are not followed
OPEN, FARTHEST = math.log(1e4), math.log(1e12)
#: Probability of a larger misfit below which the model does not follow the data
FOLLOWS = 1e-3
#: Distance from the end of a range, in the logarithm, within which a parameter is at its bound
BESIDE = 1e-4
#: Longest first step of a profile, in the logarithm
LONGEST = 0.7
#: Rise, in widths of the interval, from which on no straight line leads to its end
STEEP = 3.0
#: Part of the largest slope below which a parameter has vanished
VANISHED = 1e-3
#: What could be measured next, each to NEXT_ERROR
NEXT = ("cor_sphere", "contact_time", "max_force")
NEXT_ERROR = 0.01
#: Factor from the measured velocities to those that may be measured next
NEXT_REACH = 3.0
#: Keys of a material that stay with another model
KEPT = ("name", "density", "poisson_ratio", "shift", "shift_file", "reference_temperature",
        "wlf_c1", "wlf_c2", "activation_energy", "vertical_shift", "valid_temperature_from",
        "valid_temperature_to")  # fmt: skip
#: What is said of a datum
DATUM = ("source", "quantity", "at", "value", "sigma", "model", "residual")
#: Abscissae of data that are no impacts
_ACROSS = {
    "force": "time [s]",
    "relaxation_modulus": "time [s]",
    "storage_modulus": "frequency [rad/s]",
    "loss_modulus": "frequency [rad/s]",
}


@dataclass(frozen=True)
class Estimate:
    """A parameter that was identified, in SI units."""

    address: str
    unit: str
    value: float
    #: Standard error; nan at a bound: the interval tells what is known
    standard_error: float
    #: Profile intervals that hold the value with 68 and 95 %; an open end is 0 or inf
    interval_68: tuple[float, float]
    interval_95: tuple[float, float]


@dataclass(frozen=True)
class Identification:
    """What the data say about the parameters.

    `str` gives the report that the command prints.
    """

    case: Case
    estimates: tuple[Estimate, ...]
    #: Covariance of the logarithms of the parameters
    covariance: Floats
    #: Sum of the squares of (model - datum)/sigma; its degrees of freedom
    chi2: float
    dof: int
    #: Relative error of each datum, estimated; None: the data have errors of their own
    relative_error: float | None
    #: Combinations of parameters from the best to the worst determined, with the relative error
    combinations: tuple[tuple[str, float], ...]
    eigenvalues: Floats
    aic: float
    bic: float
    #: Whether the model follows the data: they scatter as their errors say, or these are estimated
    follows: bool
    #: DATUM of each datum
    data: tuple[dict[str, Any], ...]
    #: Times that the data see [s], of a material with a shift at its reference temperature
    window: tuple[float, float]
    #: The measurement that would help most: quantity, velocity [m/s], and by how much
    advice: str
    #: Prediction: velocity, cor or cor_sphere, and the ends of its 95 % band
    band: dict[str, list[float]] = field(repr=False)
    model: str = ""
    #: Where the model of the impact does not hold, in words
    validity: str = "good"
    #: Which columns of the files were taken for what
    taken: tuple[str, ...] = ()

    def __getitem__(self, address: str) -> float:
        """Value of a parameter."""
        return {one.address: one.value for one in self.estimates}[address]

    def as_dict(self) -> dict[str, Any]:
        """All results as they are written to JSON."""
        values = np.array([one.value for one in self.estimates])
        known = [math.nan if math.isnan(one.standard_error) else 1.0 for one in self.estimates]
        covariance = self.covariance * np.outer(known, known)
        deviations = np.sqrt(np.diag(covariance))
        rows = [dataclasses.asdict(one) for one in self.estimates]
        keys = ("combination", "relative_error")
        return _text.document(
            model=self.model,
            parameters=[{"name": row.pop("address"), **row} for row in rows],
            covariance=covariance * np.outer(values, values),
            correlation=covariance / np.outer(deviations, deviations),
            fisher={
                "eigenvalues": self.eigenvalues,
                "combinations": [dict(zip(keys, one, strict=True)) for one in self.combinations],
            },
            chi2=self.chi2,
            degrees_of_freedom=self.dof,
            relative_error=self.relative_error,
            follows=self.follows,
            aic=self.aic,
            bic=self.bic,
            window=self.window,
            validity=self.validity,
            next=self.advice,
            data=self.data,
            band=self.band,
        )

    def __str__(self) -> str:
        return _report(self)

    def figure(self) -> Any:
        """Figure (matplotlib): data, model with the band of cor, and residuals below."""
        from ..plot import COLUMN, HEIGHT, PAGE, _label_decades, _labelled, _legend, drawn

        names = list(dict.fromkeys(row["quantity"] for row in self.data))
        width = COLUMN if len(names) == 1 else PAGE
        settings: dict[str, Any] = {"sharex": "col", "squeeze": False, "height_ratios": (3, 1)}
        with drawn(width, 1.4 * HEIGHT, 2, len(names), **settings) as (made, axes):
            for (above, below), name in zip(axes.T, names, strict=True):
                rows = sorted(
                    (r for r in self.data if r["quantity"] == name), key=lambda r: r["at"]
                )
                at, value, sigma, model, residual = (
                    np.array([row[key] for row in rows])
                    for key in ("at", "value", "sigma", "model", "residual")
                )
                attrs = {"units": "N" if name == "force" else "Pa"}
                column = _library.columns(0).get(name)
                factor, label = _labelled(name, column.attrs if column else attrs, value)
                # at several temperatures, say, no line leads through all
                apart = len(set(at)) < len(set(zip(at, model, strict=True)))
                line = at, factor * model
                if name in self.band and self.band["velocity"] and not apart:
                    band = {key: np.array(column) for key, column in self.band.items()}
                    line = band["velocity"], band[name]
                    above.fill_between(
                        band["velocity"], band["low"], band["high"], alpha=0.3, lw=0, color="C1",
                        label="95 % band",
                    )  # fmt: skip
                above.plot(
                    *line, marker="x" if apart else "", ls="" if apart else "-", color="C1",
                    zorder=3, label="model",
                )  # fmt: skip
                above.errorbar(
                    at, factor * value, factor * sigma, fmt="o", ms=3, color="black",
                    mfc="white", label="data",
                )  # fmt: skip
                above.set_ylabel(label)
                below.axhline(0, lw=0.5, color="grey", marker="")
                below.plot(at, residual, "o", ms=3, color="black")
                below.set(xlabel=_ACROSS.get(name, "velocity [m/s]"), ylabel="residual/error")
                if at.min() > 0 and at.max() > 8 * at.min():
                    above.set_xscale("log")
                if "modulus" in name:
                    above.set_yscale("log")
                for axis in (above.xaxis, above.yaxis):
                    _label_decades(axis)
            _legend(made)
        return made


class _Problem:
    """Residuals of all data over the logarithms x of the parameters."""

    def __init__(
        self, case: Case, free: Sequence[str], blocks: Sequence[Block],
        errors: Mapping[str, float], bar: Any,
    ) -> None:  # fmt: skip
        self.case, self.free, self.blocks, self.bar = case, list(free), list(blocks), bar
        self.impacts = [block for block in blocks if isinstance(block, Impacts)]
        #: Velocities of the first impacts, or of the case [m/s]
        own = np.array([velocity_of(case)])
        self.speeds = next((block.velocity for block in self.impacts), own)
        self.quantity = [name for block in blocks for name in block.quantity]
        self.value = np.concatenate([block.value for block in blocks])
        scale = np.concatenate([getattr(b, "scale", np.abs(b.value)) for b in blocks])
        sigma = np.concatenate([block.sigma for block in blocks])
        for name, error in errors.items():
            if not 0 < error < math.inf:
                raise UsageError(f"--error {name}: found {error:g}, expected a number > 0")
            if name not in self.quantity:
                known = ", ".join(dict.fromkeys(self.quantity))
                raise UsageError(f"--error {name}: the data have no such column, they are {known}")
            if not np.isnan(sigma[np.equal(self.quantity, name)]).any():
                raise UsageError(f"--error {name}: these data have errors of their own")
        given = np.array([errors.get(name, np.nan) for name in self.quantity])
        sigma = np.where(np.isnan(sigma), given * scale, sigma)
        missing = np.isnan(sigma)
        sources = [block.source for block in blocks for _ in block.quantity]
        if missing.any() and not missing.all():
            i = int(np.argmax(missing))
            name, at = self.quantity[i], np.concatenate([block.at for block in blocks])[i]
            raise InputError(f"{sources[i]}: some data have a standard error, {name} at {at:.6g} "
                             f"has none: give a column {name}_sigma with a number there, or "
                             f"--error {name}=2%")  # fmt: skip
        self.estimated = bool(missing.all())
        self.sigma = scale if self.estimated else sigma
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
        if not (self.sigma > 0).all():
            i = int(np.argmin(self.sigma > 0))
            raise InputError(f"{sources[i]}: found a {self.quantity[i]} of {self.value[i]:.6g}, "
                             "expected one > 0, or with a standard error")  # fmt: skip
        self._last = np.empty(0), np.empty(0)
        self.dof = len(self.value) - len(self.free) - sum(block.unknowns for block in blocks)
        if self.dof < (1 if self.estimated else 0):
            raise InputError(self.too_few(len(self.value)))

    def too_few(self, data: int) -> str:
        """Message about so many distinct data."""
        files = ", ".join(dict.fromkeys(block.source for block in self.blocks))
        return (f"{files}: found {data} distinct data for {len(self.free)} parameters, expected "
                "more")  # fmt: skip

    def predict(self, x: Floats) -> Floats:
        """Data for each row of x, shape (rows, data)."""
        values = np.exp(x)
        self.bar.update(len(x) * sum(len(impacts.velocity) for impacts in self.impacts))
        return np.hstack([b.predict(self.case, self.free, values) for b in self.blocks])

    def residuals(self, x: Floats) -> Floats:
        """Residuals at one point, shape (data,); the last are kept."""
        if not np.array_equal(x, self._last[0]):
            self._last = x.copy(), (self.predict(x[None])[0] - self.value) / self.sigma
        return self._last[1]

    def derivatives(self, x: Floats, what: Any = None) -> Floats:
        """Derivatives of the data, shape (data, parameters); one-sided beside a limit."""
        predict = what or self.predict
        steps = STEP * np.eye(len(x))
        found = predict(np.vstack([x, x + steps, x - steps]))
        above, below = found[1 : len(x) + 1] - found[0], found[0] - found[len(x) + 1 :]
        slope: Floats = np.where(
            np.isnan(above), below, np.where(np.isnan(below), above, (above + below) / 2)
        )
        return slope.T / STEP

    def elasticities(self, x: Floats, probe: Impacts, names: Sequence[str]) -> Floats:
        """Derivatives of logarithms of quantities, shape (impacts and names, parameters)."""

        def logarithms(points: Floats) -> Floats:
            found = probe.quantities(self.case, self.free, np.exp(points), list(names))
            return np.log(np.abs(found.reshape(len(points), -1)))

        return self.derivatives(x, logarithms)

    def slopes(self, x: Floats, which: Sequence[int]) -> Floats:
        """Derivatives of the residuals by some of the parameters, one-sided: good for descent."""
        steps = STEP * np.eye(len(x))[list(which)]
        found = self.predict(x + steps)
        if np.isnan(found).any():
            steps = -steps
            found = self.predict(x + steps)
        change = (found - self.value) / self.sigma - self.residuals(x)
        slope: Floats = np.nan_to_num(change / steps.sum(axis=1)[:, None]).T
        return slope

    def minimize(
        self, x: Floats, which: Sequence[int], most: int = 60, tolerance: float = 1e-12,
        *, again: bool = True,
    ) -> tuple[Floats, float]:  # fmt: skip
        """Least squares over some of the parameters from x; inf where there is no result."""
        which, x = list(which), x.copy()
        x[which] = np.clip(x, self.low + 1e-6, self.high - 1e-6)[which]

        def full(part: Floats) -> Floats:
            x[which] = part
            return x

        if not np.isfinite(self.residuals(x)).all():
            return x, math.inf
        if which:
            found = least_squares(
                lambda part: self.residuals(full(part)),
                x[which],
                lambda part: self.slopes(full(part), which),
                bounds=(self.low[which], self.high[which]),
                xtol=tolerance, ftol=tolerance, gtol=tolerance, max_nfev=most,
            )  # fmt: skip
            full(found.x)
            lengths = np.linalg.norm(found.jac, axis=0)
            vanished = [which[i] for i in np.flatnonzero(lengths < VANISHED * lengths.max())]
            if again and vanished:
                # a modulus next to 0 has no slope that leads back
                other = x.copy()
                other[vanished] = self.guess[vanished]
                other, chi2 = self.minimize(other, which, most, tolerance, again=False)
                if chi2 < 2 * found.cost:
                    return other, chi2
        return x, float(np.sum(self.residuals(x) ** 2))

    def best(self, seed: int) -> tuple[Floats, float]:
        """The smallest sum of squares from several starts, the first one the case itself."""
        x = self.guess
        spread = np.random.default_rng(seed).uniform(-math.log(10), math.log(10), (STARTS, len(x)))
        starts = np.vstack([x, x + spread])
        # in parts, for the bar and Ctrl-C
        found_there = np.vstack([self.predict(part) for part in np.array_split(starts, 8)])
        sums = np.sum(((found_there - self.value) / self.sigma) ** 2, axis=1)
        order = np.argsort(np.where(np.isnan(sums), np.inf, sums), kind="stable")[:REFINED]
        if not np.isfinite(sums[order[0]]):
            raise NumericalError(f"{self.case.name}: no start of the parameters has a result for "
                                 "all data")  # fmt: skip
        every = range(len(x))
        found: list[tuple[Floats, float]] = []
        for i in dict.fromkeys([0, *order]):
            found.append(self.minimize(starts[i], every, 30))
            found.sort(key=lambda one: one[1])
            # the same from two starts
            if len(found) > 1 and found[1][1] < (1 + 1e-6) * found[0][1]:
                break
        return self.minimize(self.in_order(found[0][0]), every)

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


def identify(
    case: Case | str | os.PathLike[str],
    data: Source | Sequence[Source],
    free: Sequence[str],
    *,
    fix: Mapping[str, float] | None = None,
    errors: Mapping[str, float] | None = None,
    model: str | None = None,
    seed: int = 1,
    columns: Columns = None,
    units: Units = None,
) -> Identification:
    """Identify parameters of a case from measured data, as `vcor identify` does.

    Parameters
    ----------
    case
        The case; the values of the free parameters are a first guess.
    data
        Files, or columns in SI units (a mapping or a DataFrame). Impacts have a row: `velocity` or
        `drop_height`, `temperature`, `radius`, `mass` or any address, and measured columns of the
        summary, such as `cor`, `cor_sphere`, `resilience`, `rebound_height`, `contact_time`,
        `max_force`; `bounce_time` are the times in flight of one sequence of bounces. `time` and
        `force` are a record of one impact; `time` and `relaxation_modulus`, or `frequency`,
        `storage_modulus` and `loss_modulus`, are moduli of the material that is free. NAME_sigma
        is the standard error of a column. Without errors all data have the same relative one.
    free
        Addresses of the parameters, all > 0; of a material with `model` they may be empty.
    fix
        Values at addresses that are given.
    errors
        Relative standard errors by column, where the data have none.
    model
        Another model for the material, `prony:2` for two terms; all its parameters are free.
    seed
        Seed of the starts.
    columns, units
        Which columns of files are what, and their units, as for `vcor.read_data`.

    Returns
    -------
    Identification
        Values, intervals, and what the data do not say.

    Raises
    ------
    InputError
        The data cannot be used.
    NumericalError
        The data do not determine the parameters; the message names the combinations that they do
        determine, and what would help.
    """
    case = as_case(case).copy()
    free = free.split(",") if isinstance(free, str) else listed(free)
    for address in free:
        if b"solver." in _library.encoded(address).lower():
            raise UsageError(f"{address}: found a setting of the solver, expected a parameter")
    fix = scalars(fix)
    for address, value in fix.items():
        case[address] = value
    alone: Any = [data] if hasattr(data, "keys") else listed(data)
    # a DataFrame is no Mapping
    sources = [dict(one.items()) if hasattr(one, "keys") else one for one in alone]
    sources = [one if isinstance(one, dict) else File(one, columns, units) for one in sources]
    if not sources:
        raise UsageError("expected at least one file or table of data")
    free = [address for address in free if address not in fix]
    if model:
        case, free = _with_model(case, free, model, fix, sources)
    if not free:
        also = f" that --fix does not give, found {', '.join(fix)}" if fix else ""
        raise UsageError(f"expected at least one free parameter{also}")
    whole(seed, "--seed", 0, MOST_SEED)
    if len(set(free)) < len(free):
        raise UsageError("a free parameter is named twice")
    blocks = [observations(case, source, free) for source in sources]
    if case["solver.method"] != "direct":
        sharpen(case, ACCURACY)
    with progress_bar(None, None) as bar:
        problem = _Problem(case, free, blocks, scalars(errors), bar)
        x, chi2 = problem.best(seed)
        return _judged(problem, x, chi2, model or "")


def _judged(problem: _Problem, x: Floats, chi2: float, model: str) -> Identification:
    """What the fit says; refused if a combination is not determined."""
    case, free, dof = problem.case, problem.free, problem.dof
    found = problem.predict(x[None])[0]
    taken = tuple(b.said() if isinstance(b, Record) else b.taken for b in problem.blocks)
    places = len({*zip(problem.quantity, found, strict=True)})
    distinct = len({*zip(problem.quantity, found, problem.value, strict=True)})
    # copies of a datum neither determine more nor tell how much data scatter
    if places < len(x) or (problem.estimated and distinct <= len(x)):
        raise InputError(problem.too_few(min(places, distinct)))
    every = range(len(x))
    slopes = problem.derivatives(x) / problem.sigma[:, None]
    scale = math.sqrt(chi2 / dof) if problem.estimated else 1.0
    eigenvalues, vectors = np.linalg.eigh(slopes.T @ slopes / scale**2)
    unseen = eigenvalues < 1 / OPEN**2
    eigenvalues = eigenvalues.clip(1 / OPEN**2)
    covariance = (vectors / eigenvalues) @ vectors.T
    limits = [_intervals(problem, x, chi2, scale, covariance, i) for i in every]
    free_of_limits = [i for i in every if limits[i][-1] == (0.0, math.inf)]
    if free_of_limits:
        own = slopes[:, free_of_limits] / scale
        values, directions = np.linalg.eigh(own.T @ own)
        if values[0] < 1 / UNDETERMINED**2:
            directions = directions[:, values < 1 / UNDETERMINED**2]
        lost = np.eye(len(x))[:, free_of_limits] @ directions
        raise NumericalError(_not_determined(problem, x, lost))
    for address, value in zip(free, np.exp(x), strict=True):
        case[address] = float(value)
    deviations = np.sqrt(np.diag(covariance))
    ends = [*zip(x - problem.low, problem.high - x, strict=True)]
    at_bound = [
        min(ends[i]) < BESIDE or limits[i][0][0] == 0 or limits[i][0][1] == math.inf for i in every
    ]
    estimates = tuple(
        Estimate(
            address,
            case._describe(address).unit,
            float(np.exp(x[i])),
            math.nan if at_bound[i] else float(np.exp(x[i]) * deviations[i]),
            *limits[i],
        )
        for i, address in enumerate(free)
    )
    n, k = len(problem.value), len(x) + int(problem.estimated)
    likelihood = n * math.log(max(chi2, 1e-300) / n) if problem.estimated else chi2
    materials = materials_of(free)
    sigma = scale * problem.sigma
    residual = (found - problem.value) / np.fmax(sigma, 1e-300)
    sources = [block.source for block in problem.blocks for _ in block.quantity]
    at = np.concatenate([block.at for block in problem.blocks])
    numbers = np.stack([at, problem.value, sigma, found, residual], axis=1).tolist()
    rows = tuple(
        dict(zip(DATUM, (source, name, *row), strict=True))
        for source, name, row in zip(sources, problem.quantity, numbers, strict=True)
    )
    order = np.argsort(-eigenvalues)
    return Identification(
        case=case,
        estimates=estimates,
        covariance=covariance,
        chi2=chi2,
        dof=dof,
        taken=tuple(filter(None, taken)),
        follows=problem.estimated or chi2 <= float(chdtri(max(dof, 1), FOLLOWS)),
        relative_error=scale if problem.estimated else None,
        combinations=tuple(
            (_product(free, vectors[:, j]), math.inf if unseen[j] else eigenvalues[j] ** -0.5)
            for j in order
        ),
        eigenvalues=eigenvalues[order],
        aic=likelihood + 2 * k,
        bic=likelihood + k * math.log(n),
        data=rows,
        window=window(problem.blocks, case, materials[0] if len(materials) == 1 else ""),
        advice=_next(problem, x, eigenvalues, vectors),
        band=_band(problem, x, covariance),
        model=model,
        validity=_validity(problem, case),
    )


def _validity(problem: _Problem, case: Case) -> str:
    """Where the model of the impact does not hold for measured impacts, in words."""
    found = [pair for block in problem.impacts for pair in block.validity(case)]
    words = [
        f"{kind} at {sum(one == kind for one, _ in found)} of {len(found)} impacts, by "
        + ", ".join(sorted({cause for one, cause in found if one == kind}))
        for kind in ("outside", "caution")
        if any(one == kind for one, _ in found)
    ]
    return "; ".join(words) or "good"


def _not_determined(problem: _Problem, x: Floats, lost: Floats) -> str:
    """Line that says which combinations the data determine, and what would fix the rest."""
    free = problem.free
    involved = [i for i in range(len(free)) if np.linalg.norm(lost[i]) > 0.01]
    # basis of the determined space, each combination with one parameter of its own
    kept = np.linalg.svd(lost[involved].T)[2][lost.shape[1] :]
    texts = []
    if len(kept):
        order = np.argsort(np.linalg.norm(lost[involved], axis=1), kind="stable")
        own, rest = order[: len(kept)], order[len(kept) :]
        powers = np.linalg.solve(kept[:, own], kept[:, rest])
        for i, row in zip(own, powers, strict=True):
            direction = np.zeros(len(free))
            direction[involved[i]] = 1
            direction[[involved[j] for j in rest]] = row
            texts.append(_product(free, direction))
    names = " and ".join([", ".join(free[i] for i in involved[:-1]), free[involved[-1]]][
        len(involved) == 1 :])  # fmt: skip
    each = " each" if len(involved) > 1 else ""
    said = f"the data do not determine {names}{each}"
    if texts:
        said += f": they fix {' and '.join(texts)}"
    helps = [name for name in NEXT if _responds(problem, x, lost, name)]
    if helps:
        said += f"; give a {' or a '.join(helps)}, or fix one of them (--fix ADDRESS=VALUE)"
    else:
        said += "; fix one of them (--fix ADDRESS=VALUE)"
    return f"{problem.case.name}: {said}"


def _responds(problem: _Problem, x: Floats, lost: Floats, name: str) -> bool:
    """Whether a measured quantity would respond to every combination that is lost."""
    if not problem.impacts:
        return False
    slopes = problem.elasticities(x, problem.impacts[0], [name])
    known = np.linalg.svd(slopes @ lost, compute_uv=False)
    return len(known) >= lost.shape[1] and bool(known.min() > NEXT_ERROR)


def _intervals(
    problem: _Problem, x: Floats, chi2: float, scale: float, covariance: Floats, i: int
) -> list[tuple[float, float]]:
    """Profile intervals of a parameter, one of each of LEVELS."""
    widths = [
        float(stdtrit(problem.dof, half) if problem.estimated else ndtri(half))
        for half in ((1 + level) / 2 for level in LEVELS)
    ]
    ends = [_ends(problem, x, chi2, scale, covariance[:, i], i, side, widths) for side in (-1, 1)]
    return [(math.exp(low), math.exp(high)) for low, high in zip(*ends, strict=True)]


def _ends(
    problem: _Problem, x: Floats, chi2: float, scale: float, covariance: Floats, i: int,
    side: int, widths: Sequence[float],
) -> list[float]:  # fmt: skip
    """Logarithms at which the smallest sum of squares is larger by width^2; inf where it never is.

    The root z of the rise is next to linear: from the last point with less than the width the line
    leads on, and a point with more closes the bracket.
    """
    others = [j for j in range(len(x)) if j != i]
    reach = OPEN + max(0.0, side * (problem.guess[i] - x[i]))
    error = math.sqrt(covariance[i])
    slope_of_others = covariance / covariance[i]
    inside, z, point, rate = 0.0, 0.0, x, 1 / error
    outside: list[tuple[float, float]] = []
    ends = []
    for width in widths:
        outside = [one for one in outside if one[1] > width]
        for _ in range(25):
            if outside and outside[-1][1] < STEEP * width:
                far, z_far = outside[-1]
                trial = inside + (far - inside) * max(0.05, (width - z) / (z_far - z))
            elif outside:
                trial = (inside + outside[-1][0]) / 2
            else:
                step = (width - z) / rate
                trial = min(reach, inside + min(step, 2 * inside + LONGEST))
            straight = (trial - inside) * side * slope_of_others
            # where the line leads to points without a result, the others start where they are
            for start in (point + straight, point.copy()):
                start[i] = x[i] + side * trial
                found_at, found = problem.minimize(start, others, 30, 1e-5)
                if math.isfinite(found):
                    break
            rise = math.sqrt(max(found - chi2, 0.0)) / max(scale, 1e-300)
            if rise < width:
                if trial > inside and rise > z:
                    rate = (rise - z) / (trial - inside)
                    slope_of_others = side * (found_at - point) / (trial - inside)
                inside, z, point = trial, rise, found_at
            else:
                outside.append((trial, rise))
            if abs(rise - width) < 5e-3 * width or inside >= reach:
                break
            if outside and outside[-1][0] - inside < 1e-3 * outside[-1][0]:
                break
        ends.append(x[i] + side * trial if inside < reach else side * math.inf)
    return ends


def _probe(case: Case, grid: Floats, name: str = "cor") -> Impacts:
    """Impacts of the case at other velocities."""
    return Impacts("", {"velocity": grid, name: np.ones(len(grid))}, case)


def _next(problem: _Problem, x: Floats, eigenvalues: Floats, vectors: Floats) -> str:
    """The measurement that would bring the worst combination down most."""
    case, free, speeds = problem.case, problem.free, problem.speeds
    grid = np.geomspace(speeds.min() / NEXT_REACH, speeds.max() * NEXT_REACH, 13)
    probe = _probe(case, grid)
    measured = (grid >= speeds.min()) & (grid <= speeds.max())
    feasible = measured | [kind != "outside" for kind, _ in probe.validity(case)]
    slopes = problem.elasticities(x, probe, NEXT) / NEXT_ERROR
    fisher = (vectors * eigenvalues) @ vectors.T
    now = np.sqrt(np.diag(np.linalg.inv(fisher)))
    best, where = 1.0, None
    for j, row in enumerate(slopes):
        if not (np.isfinite(row).all() and feasible[j // len(NEXT)]):
            continue
        then = np.sqrt(np.diag(np.linalg.inv(fisher + np.outer(row, row))))
        if then.max() / now.max() < best:
            best, where = then.max() / now.max(), j
    if where is None or best > 0.98:
        return "no single measurement of an impact would help much"
    name, speed = NEXT[where % len(NEXT)], grid[where // len(NEXT)]
    worst = free[int(np.argmax(now))]
    return (f"{name} at {speed:.3g} m/s to {100 * NEXT_ERROR:g} %: {worst} to "
            f"{_percent(best * now.max())} instead of {_percent(now.max())}")  # fmt: skip


def _band(problem: _Problem, x: Floats, covariance: Floats) -> dict[str, list[float]]:
    """Prediction of cor, or what was measured of it, over velocity with its 95 % band."""
    grid = np.geomspace(problem.speeds.min() / 2, problem.speeds.max() * 2, 41)
    name = "cor_sphere" if {"cor", "cor_sphere"} & {*problem.quantity} == {"cor_sphere"} else "cor"
    probe = _probe(problem.case, grid, name)

    def cor(points: Floats) -> Floats:
        return probe.predict(problem.case, problem.free, np.exp(points))

    slopes = problem.derivatives(x, cor)
    deviation = np.sqrt(np.einsum("ij,jk,ik->i", slopes, covariance, slopes))
    middle, half = cor(x[None])[0], float(ndtri(0.975)) * deviation
    columns = {"velocity": grid, name: middle, "low": middle - half, "high": middle + half}
    good = np.isfinite(middle)
    return {name: column[good].tolist() for name, column in columns.items()}


def _with_model(
    case: Case, free: Sequence[str], model: str, fix: Mapping[str, float], sources: Sequence[Source]
) -> tuple[Case, list[str]]:
    """The case with another model for the material of the free parameters, all of it free."""
    names = materials_of(free)
    if len(names) != 1 or not all(address.startswith(f"{names[0]}.") for address in free):
        raise UsageError("--model: the free parameters must be those of one material")
    name = names[0]
    kind, _, terms = str(model).partition(":")
    if not re.fullmatch(r"prony:0*[1-9]\d?|[^:]*", str(model)):
        raise UsageError(f"--model {model}: expected the name of a model, or such as prony:2")
    first, last = window([observations(case, one, free) for one in sources], case, name)
    times = np.geomspace(first, last, 60)
    reference = case.copy()
    if case[f"{name}.shift"] is not None:
        reference["impact.temperature"] = number(case, f"{name}.reference_temperature")
    moduli = reference.material(name).relaxation(times)
    keys: dict[str, list[float]] = {}
    if kind == "prony":
        # equal moduli and times that are apart, also where one term would do
        n = int(terms or 1)
        keys["equilibrium_modulus"] = [moduli[-1]]
        keys["moduli"] = [(moduli[0] - moduli[-1]) / n] * n
        keys["times"] = list(np.geomspace(first, last, n + 2)[1:-1])
    else:
        for one in fit((times, moduli), model=kind, name=name).parameters:
            keys[one.name] = [one.value]

    def other(old: re.Match[str]) -> str:
        kept = [line for line in old[0].splitlines() if line.split("=")[0].strip() in KEPT]
        rows = [f"   {key} = {', '.join(repr(float(x)) for x in row)}" for key, row in keys.items()]
        return "\n".join(["&material", f"   model = '{kind}'", *kept, *rows, "/"])

    changed = with_material(case, name, other)
    addresses = [
        f"{name}.{key}({i + 1})" if key in ("moduli", "times") else f"{name}.{key}"
        for key, row in keys.items()
        for i, x in enumerate(row)
        if x > 0
    ]
    addresses += [address for address in free if address.rpartition(".")[2] in KEPT]
    for address in fix:
        if address in addresses:
            changed[address] = float(fix[address])
            addresses.remove(address)
    return changed, addresses


def _product(names: Sequence[str], direction: Floats) -> str:
    """A direction of logarithms as a product of powers, the largest power 1."""
    scaled = direction / direction[np.argmax(np.abs(direction))]
    factors = []
    for name, power in zip(names, scaled, strict=True):
        if abs(power) >= 0.02:
            text = f"{power:.2f}".rstrip("0").rstrip(".")
            factors.append(name if text == "1" else f"{name}^{text}")
    return "*".join(factors)


def _percent(error: float) -> str:
    if not math.isfinite(error):
        return "at bound" if math.isnan(error) else "unknown"
    return f"{100 * error:.2g} %" if error < 1 else f"{100 * error:.0f} %"


def _report(found: Identification) -> str:
    """What the command prints."""
    lines = [
        f"{len(found.data)} data of {', '.join(dict.fromkeys(r['source'] for r in found.data))}",
        *found.taken,
    ]
    head = f"{'':32s} {'value':>12s} {'error':>9s}  {'68 % interval':26s}{'95 % interval':26s}"
    lines += ["", head.rstrip()]
    for one in found.estimates:
        ends = "".join(
            f"{f'{low:.5g} to {high:.5g}':26s}" for low, high in (one.interval_68, one.interval_95)
        )
        error = _percent(one.standard_error / one.value)
        name = f"{one.address} [{one.unit}]" if one.unit not in ("", "1") else one.address
        lines.append(f"{name:32s} {one.value:12.6g} {error:>9s}  {ends}".rstrip())
    for one in found.estimates:
        if math.isnan(one.standard_error):
            wide = [f", {end:g} is as good" for end in one.interval_68 if end in (0, math.inf)]
            lines.append(f"{one.address} is at its bound{''.join(wide)}: no standard error")
    if found.relative_error is None:
        lines += ["", f"chi2/dof {found.chi2 / max(found.dof, 1):.3g} ({found.dof} dof)"]
    else:
        lines += ["", f"error of each datum {_percent(found.relative_error)}, from the misfit "
                  f"({found.dof} degrees of freedom)"]  # fmt: skip
    lines[-1] += f", AIC {found.aic:.1f}, BIC {found.bic:.1f}"
    if not found.follows:
        lines.append("the data scatter more than their errors: the model (waves, law, material) "
                     "does not describe them")  # fmt: skip
    lines += ["", "what the data determine, from best to worst (eigenvalue of the Fisher matrix):"]
    lines += [
        f"  {_percent(error):>8s}  {text}  ({value:.3g})"
        for (text, error), value in zip(found.combinations, found.eigenvalues, strict=True)
    ]
    low, high = found.window
    seen = f"the data see the material from {low:.2g} to {high:.2g} s"
    materials = materials_of([one.address for one in found.estimates])
    if len(materials) == 1 and found.case[f"{materials[0]}.shift"] is not None:
        kelvin = number(found.case, f"{materials[0]}.reference_temperature")
        seen += f" at its reference temperature, {kelvin:.2f} K"
    lines += ["", seen]
    if {row["quantity"] for row in found.data} <= {*COEFFICIENTS}:
        lines += ["these are coefficients only: the scale of times rests on what is not free"]
    lines += [f"validity: {found.validity}", f"what would help most: {found.advice}", ""]
    lines.append(f"{'datum':20s}{'at':>12s}{'value':>13s}{'model':>13s}{'residual/error':>16s}")
    shown = sorted(found.data, key=lambda row: -abs(row["residual"]))[:20]
    lines += [
        f"{r['quantity']:20s}{r['at']:12.5g}{r['value']:13.6g}{r['model']:13.6g}"
        f"{r['residual']:16.2f}"
        for r in found.data if any(r is one for one in shown)
    ]  # fmt: skip
    if len(found.data) > len(shown):
        lines.append(f"(the {len(shown)} largest of {len(found.data)} residuals)")
    return "\n".join(lines) + "\n"


def _pairs(words: Sequence[str], option: str) -> dict[str, float]:
    """NAME=NUMBER of an option, percent as a fraction."""
    found = {}
    for word in words:
        name, _, text = word.partition("=")
        try:
            found[name] = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
        except ValueError:
            raise UsageError(f"{option} {word}: expected NAME=NUMBER") from None
    return found


def main(arguments: Sequence[str] | None = None) -> None:
    """Command `vcor identify`; exits with the codes of the program."""
    parser = _command.Parser(
        "identify",
        description="Identify parameters of a case from measured impacts (a row each: velocity or "
        "drop_height, and cor, contact_time ...), records of time and force, and moduli. Writes "
        "the case, JSON and a figure.",
    )
    parser.add_outputs()
    add = parser.add_argument
    add("case", metavar="CASE.nml", help="case; its values are the first guess")
    data = "data files with a header, and files of materials (.nml) that the case needs"
    add("data", nargs="+", metavar="DATA", help=data)
    add("--free", metavar="ADDRESS,ADDRESS", help="parameters to be identified")
    add("--fix", metavar="ADDRESS=VALUE", action="append", default=[], help="a value that is given")
    error = "relative error of a column that has none, such as cor=1%%"
    add("--error", metavar="NAME=VALUE", action="append", default=[], help=error)
    model = "another model of the material, such as sls or prony:2; several are compared"
    add("--model", metavar="NAME,NAME", action="append", default=[], help=model)
    add("--seed", type=int, default=1, help="seed of the starts")
    add_data_options(parser)
    with _command.one_line():
        _work(parser.options(arguments))


def _work(options: argparse.Namespace) -> None:
    if options.free is None:
        raise UsageError("expected --free ADDRESS,ADDRESS, the parameters to be identified")
    free = [word.strip() for word in options.free.split(",") if word.strip()]
    fix, errors = _pairs(options.fix, "--fix"), _pairs(options.error, "--error")
    found: list[Identification] = []
    refused: list[Error] = []
    models = [word.strip() for words in options.model for word in words.split(",")]
    case = read(options.case, *(name for name in options.data if name.endswith(".nml")))
    data = [name for name in options.data if not name.endswith(".nml")]
    said: dict[str, Any] = {"columns": columns_option(options.columns), "units": options.units}
    for model in models or [None]:
        try:
            found.append(
                identify(case, data, free, fix=fix, errors=errors, model=model, seed=options.seed,
                         **said)
            )  # fmt: skip
        except NumericalError as error:
            refused.append(error)
    if not found:
        raise refused[0]
    best = min(found, key=lambda one: one.aic)
    report, written = str(best), best.as_dict()
    if len(models) > 1:
        order = sorted(found, key=lambda one: one.aic)
        keys = ("model", "chi2", "aic", "bic")
        written["models"] = [{key: getattr(one, key) for key in keys} for one in order]
        report += f"\n{'model':16s}{'parameters':>11s}{'chi2':>12s}{'AIC':>10s}{'BIC':>10s}\n"
        for one in order:
            report += f"{one.model:16s}{len(one.estimates):11d}{one.chi2:12.4g}"
            report += f"{one.aic:10.1f}{one.bic:10.1f}\n"
        report += "".join(f"no result: {error}\n" for error in refused)
    texts = {".nml": best.case.text(), ".json": written}
    stem = f"{Path(options.case).stem}_identified"
    from .._outputs import finish

    finish(options, report, stem, texts, best.figure())
