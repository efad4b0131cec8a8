"""Results at the samples of uncertain parameters: solved each, or from thin mechanics corrected.

An impact with exact mechanics takes 50 ms, and a sweep asks for some 50,000. So the exact results
are those of thin mechanics with a correction that is fitted to some hundred exact impacts
(`_correction`), of all points of a sweep at once: the point of the sweep is one more coordinate.
Where thin mechanics do not read a parameter, the correction alone follows it. The error is measured
at further exact impacts. Where it stays too large, or where results are not smooth (an impact
without a result, another number of contacts), every sample is solved.
"""

from __future__ import annotations

import functools
import itertools
import math
import os
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri
from scipy.stats import qmc

from . import _library
from ._correction import (
    MOST_DEGREE,
    POINTS_PER_TERM,
    Coordinates,
    Correction,
    Parts,
    parts_of,
)
from ._library import Error, Floats, NoResultWarning
from ._text import option
from .arguments import namelists, threads_of
from .case import INVALID, SEPARATED, Case, number, with_material

#: Part of the standard deviation over the samples that the error of a sample may have
ACCURATE = 0.01
#: Fresh impacts that the error is measured at, and those of each point of a sweep at least
FRESH, FRESH_OF_POINT = 20, 2
#: Fewest impacts that a correction is fitted to
FEWEST = 32
#: Degree of the terms that the first impacts determine: of second order in the parameters; along a
#: sweep, where a power of a parameter counts twice, these change by one power of its point, and
#: those of first order by three
FIRST_DEGREE, FIRST_ALONG = 2, 5
#: Highest power of the point of a sweep
MOST_ALONG = 5
#: Time that is announced, and that of the impacts that it is estimated from [s]
LONG, TRIAL = 60.0, 0.3
#: Samples of thin mechanics that their time is estimated from
TRIED = 128
#: Waves of thin mechanics, and what a rigid ball has of its material
THIN_WAVES = ("hereditary", "none")
RIGID_KEYS = ("name", "density", "poisson_ratio", "yield_strength")
#: Columns that tell impacts apart between which results are not smooth
STATE = ("status", "contacts")
#: How often points are drawn in the place of those whose values make no impact
ROUNDS = 8
#: Impacts that elasticities take, to each parameter
OTHERS = 4


@dataclass(frozen=True)
class Plan:
    """Samples of the parameters of an impact."""

    case: Case
    addresses: list[str]
    #: Standardised coordinates of the samples, shape (samples, addresses)
    z: Floats
    #: Values at the addresses by standardised coordinates
    place: Callable[[Floats], Floats]
    #: Which coordinates are uniform, shape (addresses,)
    uniform: Sequence[bool]
    #: Address and value of a sweep that the impact is a point of; empty and 0 of one impact
    swept: str
    value: float
    #: Results of the impact itself, shape (quantities,)
    middle: Floats


@dataclass(frozen=True)
class Sampled:
    """Results of the samples of one impact or of the points of a sweep."""

    #: For each plan results, nan where there are none, shape (samples, quantities)
    found: list[Floats]
    #: Results of a plan at standardised coordinates, shape (points, quantities)
    at: Callable[[int, Floats], Floats]
    #: Impacts that were solved with the mechanics of the case
    solved: int
    #: Further ones that the error was measured at, 0: every sample was solved
    fresh: int = 0
    #: Error of a sample as part of the standard deviation, shape (quantities,)
    error: Floats | None = None
    #: Warnings of samples without a result
    notes: Sequence[warnings.WarningMessage] = ()


def sampled(
    plans: Sequence[Plan], quantities: Sequence[str], seed: int, threads: int | None,
    corrected: bool | None = None,
) -> Sampled:  # fmt: skip
    """Results of all samples of plans with the same addresses and coordinates.

    Parameters
    ----------
    corrected
        Whether thin mechanics are corrected; None: if each exact impact has a mesh of its own,
        which takes long.
    """
    count = sum(len(plan.z) for plan in plans)
    if plans[0].case._has_mesh if corrected is None else corrected:
        found = _Corrected(plans, list(quantities), seed, threads).sampled(count)
        if found is not None:
            return found
    else:
        _announce(plans, count, threads)
    with warnings.catch_warnings(record=True) as notes:
        warnings.simplefilter("always")
        solved = [_solve(plan, plan.z, quantities, threads) for plan in plans]

    def at(i: int, z: Floats) -> Floats:
        """Results at further points of a plan, shape (points, quantities)."""
        return _solve(plans[i], z, quantities, threads)

    return Sampled(solved, at, count, notes=notes)


def _solve(plan: Plan, z: Floats, quantities: Sequence[str], threads: int | None) -> Floats:
    """Results at standard coordinates z of a plan, shape (points, quantities)."""
    return _solve_sorted(plan.case, plan.addresses, plan.place(z), quantities, threads)


def _solve_sorted(
    case: Case, addresses: list[str], table: Floats, names: Sequence[str], threads: int | None
) -> Floats:
    """Columns of points, shape (points, names), those of equal Poisson's ratios one by one.

    Of these the law of a layer is made once; a Saltelli sample has few different values.
    """
    dear = [k for k, one in enumerate(addresses) if one.lower().endswith(".poisson_ratio")]
    order = np.lexsort(table[:, dear].T) if dear else np.arange(len(table))
    found = np.empty((len(table), len(names)))
    found[order] = case._solve_all(addresses, table[order], list(names), threads, None)
    return found


def _announce(plans: Sequence[Plan], count: int, threads: int | None) -> None:
    """Say how long the samples take, if that is long: some of all plans are solved."""
    size, each, begin = _cores(threads), 0.0, time.perf_counter()
    while time.perf_counter() - begin < TRIAL and size <= len(plans[0].z):
        start = time.perf_counter()
        for plan in plans:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                _solve(plan, plan.z[:size], ["cor"], threads)
        # by the largest number, in which what is made once counts least
        each, size = (time.perf_counter() - start) / (size * len(plans)), 4 * size
    say(plans[0].case, count, count * each)


def say(case: Case, impacts: int, seconds: float, why: str = "") -> None:
    """Say how long impacts take, if that is long."""
    if seconds > LONG:
        warnings.warn(
            f"{case.name}: {why}{impacts} impacts take some {math.ceil(seconds / 60)} min; "
            f"{option('samples')} with a smaller number takes less", stacklevel=2,
        )  # fmt: skip


def _cores(threads: int | None) -> int:
    """Number of threads, by default one for each core that the process may use."""
    return threads_of(threads) or len(os.sched_getaffinity(0))


@dataclass(frozen=True)
class Thin:
    """A case with thin mechanics."""

    case: Case
    #: Which of the addresses that vary it reads, shape (addresses,)
    reads: NDArray[np.bool_]


def thin_cases(case: Case, addresses: Sequence[str]) -> dict[str, Thin]:
    """The case with thin mechanics that it can have, by their waves.

    Thin mechanics know no ball that deforms on a layer that relaxes: there it is a rigid one.
    """
    made = {}
    for waves, is_rigid in itertools.product(THIN_WAVES, (False, True)):
        if waves in made or (waves == case["plate.waves"] and not case._has_mesh):
            continue
        try:
            one = _with_rigid_ball(case) if is_rigid else case.copy()
            one["solver.method"] = "auto"
            one["plate.waves"] = waves
            one._solve([], np.empty((1, 0)), ["cor"], 1)
        except Error:
            continue
        made[waves] = Thin(one, np.array([_reads(one, case, address) for address in addresses]))
    return made


def _with_rigid_ball(case: Case) -> Case:
    """The case with a ball that does not deform."""
    name = str(case["sphere.material"])
    keys = {key: case[f"{name}.{key}"] for key in RIGID_KEYS}
    given = {key: value for key, value in keys.items() if value is not None}
    return with_material(case, name, namelists({"material": {"model": "rigid", **given}}))


def _reads(thin: Case, case: Case, address: str) -> bool:
    """Whether thin mechanics of a case solve it with the number that it has at an address."""
    try:
        thin._solve([address], np.array([[number(case, address)]]), ["cor"], 1)
    except Error:
        return False
    return True


@dataclass(frozen=True)
class _Points:
    """Points with their results, columns as `_Corrected.columns` has them."""

    #: Plan of each, shape (points,), and coordinates, shape (points, coordinates)
    which: NDArray[np.intp]
    z: Floats
    thin: dict[str, Floats]
    exact: Floats

    def with_more(self, other: _Points) -> _Points:
        """These points and others."""
        thin = {name: np.vstack([one, other.thin[name]]) for name, one in self.thin.items()}
        return _Points(np.concatenate([self.which, other.which]), np.vstack([self.z, other.z]),
                       thin, np.vstack([self.exact, other.exact]))  # fmt: skip


class _Corrected:
    """Samples by thin mechanics, corrected to those of the case."""

    def __init__(
        self, plans: Sequence[Plan], quantities: list[str], seed: int, threads: int | None
    ) -> None:
        """Prepare for plans of one case, several along a sweep, with points by a seed."""
        self.plans, self.quantities, self.threads = plans, quantities, threads
        self.case = plans[0].case
        self.along = int(len(plans) > 1)
        parameters = len(plans[0].uniform)
        self.coordinates = Coordinates(
            np.array([*plans[0].uniform, *[True] * self.along]),
            np.array([1 + self.along] * parameters + [1] * self.along),
            np.array([MOST_DEGREE] * parameters + [min(MOST_ALONG, len(plans) - 1)] * self.along),
        )
        known = _library.columns(0)
        stated = [f"{name}_error" for name in quantities]
        #: Columns of the results, and where the stated error of a quantity is; -1: nowhere
        self.columns = list(dict.fromkeys(
            [*quantities, *STATE, *(name for name in stated if name in known)]))  # fmt: skip
        self.stated = [self.columns.index(name) if name in known else -1 for name in stated]
        # points that come later are in the gaps of those before
        self.design = qmc.Sobol(len(self.coordinates.uniform), seed=np.random.default_rng(seed))
        random = np.random.default_rng([seed, 1])
        self.fresh = lambda n: random.random((n, len(self.coordinates.uniform)))
        #: Addresses of what varies, that of a sweep last
        self.addresses = [*plans[0].addresses]
        if self.along and plans[0].swept not in self.addresses:
            self.addresses.append(plans[0].swept)
        self.thin = thin_cases(self.case, self.addresses)
        #: Results of thin mechanics at the samples of each plan, where they were needed
        self.of_samples: dict[str, list[Floats]] = {}
        self.solved, self.seconds = 0, 0.0
        #: Divisors of the results, shape (plans, quantities): those at the middle of each plan
        self.size = np.stack([np.where(plan.middle == 0, 1.0, plan.middle) for plan in plans])
        self.thin_size = {
            name: self._results_thin(one, np.arange(len(plans)), None)
            for name, one in self.thin.items()
        }

    def sampled(self, count: int) -> Sampled | None:
        """Results of the samples; None if every sample has to be solved, `count` in all."""
        terms = len(self.coordinates.terms(FIRST_ALONG if self.along else FIRST_DEGREE))
        number = 2 ** math.ceil(math.log2(max(FEWEST, POINTS_PER_TERM * terms)))
        further = max(FRESH, FRESH_OF_POINT * len(self.plans))
        if not self.thin or number + further > count / 2 or not self._are_in_range():
            _announce(self.plans, count, self.threads)
            return None
        names = list(self.thin)
        points, before = self._points(self.design.random, number, announced=True), math.inf
        while True:
            fresh = self._points(self.fresh, further)
            if min(len(points.z) - number, len(fresh.z) - further) < 0:
                why = "few samples are impacts"
                break
            if not self._are_smooth(points.with_more(fresh)):
                why = "results jump between the samples"
                break
            worst, error = math.inf, np.full(1, math.inf)
            for k in range(len(names)):
                fitted = self._fitted(points, names[: k + 1])
                if not fitted:
                    continue
                correction, found = fitted
                error, allowed = self._errors(correction, found, fresh)
                worst = float((error / allowed).max())
                if worst <= 1:
                    at = functools.partial(self._at, correction)
                    return Sampled(found, at, self.solved, len(fresh.z), error)
            if math.isinf(worst):
                why = "thin mechanics have no results of one kind at all samples"
                break
            # at the rate of the last round, a half at least; the first one has none
            rate = min(0.5, worst / before) if math.isfinite(before) else 0.25
            rounds = math.floor(math.log2(count / 2 / (len(points.z) + further)))
            if worst * rate**rounds > 1:
                why = (f"thin mechanics with a correction from {self.solved} exact impacts err by "
                       f"{100 * float(error.max()):.2g} % of the standard deviation")  # fmt: skip
                break
            points = points.with_more(fresh)
            points = points.with_more(self._points(self.design.random, number))
            number, before = 2 * number, worst
        say(self.case, count, count * self.seconds / self.solved, f"{why}: ")
        return None

    def _are_in_range(self) -> bool:
        """Whether all samples of parameters that no thin mechanics read are in their ranges.

        Of the others thin mechanics show which values make no impact.
        """
        trial = self.case.copy()
        reads = np.any([one.reads for one in self.thin.values()], axis=0)
        table = np.vstack([self._values(np.full(len(plan.z), i), plan.z)
                           for i, plan in enumerate(self.plans)])  # fmt: skip
        try:
            for k in np.flatnonzero(~reads):
                for end in (table[:, k].min(), table[:, k].max()):
                    trial[self.addresses[k]] = float(end)
        except Error:
            return False
        return True

    def _values(self, which: NDArray[np.intp], z: Floats) -> Floats:
        """Values at the addresses at points of plans, shape (points, addresses)."""
        n = len(self.plans[0].addresses)
        table = np.empty((len(which), len(self.addresses)))
        for i in np.unique(which):
            table[which == i, :n] = self.plans[i].place(z[which == i, :n])
        if len(self.addresses) > n:
            table[:, n] = [self.plans[i].value for i in which]
        return table

    def _results(self, which: NDArray[np.intp], z: Floats) -> Floats:
        """Columns of the case at points of plans, shape (points, columns)."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NoResultWarning)
            return self.case._solve_all(
                self.addresses, self._values(which, z), self.columns, self.threads, None
            )

    def _results_thin(self, thin: Thin, which: NDArray[np.intp], z: Floats | None) -> Floats:
        """Columns of thin mechanics at points of plans, None: at the middle of each."""
        if z is None:
            given = [self.plans[0].swept] * self.along
            table = np.array([[self.plans[i].value for i in which]] * self.along)
            table = table.T.reshape(len(which), self.along)
        else:
            given = [one for one, read in zip(self.addresses, thin.reads, strict=True) if read]
            table = self._values(which, z)[:, thin.reads]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", NoResultWarning)
            if not given:
                found = thin.case._solve(given, np.empty((1, 0)), self.columns, 1)[0]
                return np.repeat(found, len(which), axis=0)
            return _solve_sorted(thin.case, given, table, self.columns, self.threads)

    def _points(
        self, shares: Callable[[int], Floats], number: int, announced: bool = False
    ) -> _Points:
        """A number of points at shares of the distributions, and their results.

        Values that make no impact are left out. The first points say how long all take, with the
        samples of thin mechanics.
        """
        state = self.columns.index("status")
        which, z = np.empty(0, dtype=np.intp), np.empty((0, len(self.coordinates.uniform)))
        thin = {name: np.empty((0, len(self.columns))) for name in self.thin}
        for _ in range(ROUNDS):
            if len(z) == number:
                break
            share = np.clip(shares(number), 1e-12, 1 - 1e-12)
            new = np.where(self.coordinates.uniform, math.sqrt(12) * (share - 0.5), ndtri(share))
            of = np.zeros(number, dtype=np.intp)
            if self.along:
                of = (share[:, -1] * len(self.plans)).astype(np.intp)
                new[:, -1] = self._place_along(of)
            found = {name: self._results_thin(one, of, new) for name, one in self.thin.items()}
            kept = np.all([one[:, state] != INVALID for one in found.values()], axis=0)
            kept &= np.cumsum(kept) <= number - len(z)
            which, z = np.concatenate([which, of[kept]]), np.vstack([z, new[kept]])
            thin = {name: np.vstack([one, found[name][kept]]) for name, one in thin.items()}
        exact, begin, trial = [], time.perf_counter(), min(2 * _cores(self.threads), len(z) - 1)
        for part in (slice(0, trial), slice(trial, len(z))):
            exact.append(self._results(which[part], z[part]))
            self.solved += len(exact[-1])
            if announced and part.start == 0:
                more = len(self.plans) * OTHERS * len(self.plans[0].addresses)
                seconds = (len(z) + more) * (time.perf_counter() - begin) / trial
                say(self.case, len(z) + more, seconds + self._time_of_samples())
        self.seconds += time.perf_counter() - begin
        return _Points(which, z, thin, np.vstack(exact))

    def _place_along(self, which: NDArray[np.intp]) -> Floats:
        """Coordinate of plans along the sweep."""
        place: Floats = math.sqrt(12) * ((which + 0.5) / len(self.plans) - 0.5)
        return place

    def _are_smooth(self, points: _Points) -> bool:
        """Whether all impacts have results, of one kind."""
        status, contacts = (points.exact[:, self.columns.index(name)] for name in STATE)
        finite = np.isfinite(points.exact[:, : len(self.quantities)])
        return bool((status == SEPARATED).all() and np.ptp(contacts) == 0 and finite.all())

    def _parts(self, which: NDArray[np.intp], thin: Mapping[str, Floats]) -> Parts:
        """Results of thin mechanics in parts of those at the middle of each plan."""
        n = len(self.quantities)
        made: dict[tuple[str, bool], Floats] = {}
        for name, one in thin.items():
            made |= parts_of(name, one[:, :n], self.thin_size[name][which, :n], self.size[which])
        return made

    def _fitted(self, points: _Points, names: list[str]) -> tuple[Correction, list[Floats]] | None:
        """A correction of some thin mechanics and the results of all samples by it.

        None if they have no results of one kind there.
        """
        if not all(self._reaches_samples(name) for name in names):
            return None
        n = len(self.quantities)
        thin = {name: points.thin[name] for name in names}
        correction = Correction.fitted(
            self.coordinates, points.z, points.exact[:, :n] / self.size[points.which],
            self._parts(points.which, thin),
        )  # fmt: skip
        return correction, [self._at_samples(correction, i, names) for i in range(len(self.plans))]

    def _reaches_samples(self, name: str) -> bool:
        """Whether thin mechanics have results of one kind at all samples that are impacts.

        They show what no few exact impacts can: that none of the samples is an impact of another
        kind.
        """
        if name not in self.of_samples:
            self.of_samples[name] = np.split(self._samples_of(name), len(self.plans))
        known = np.vstack(self.of_samples[name])
        status, contacts = (known[:, self.columns.index(column)] for column in STATE)
        good = status == SEPARATED
        return bool(good.any() and (good | (status == INVALID)).all()
                    and np.ptp(contacts[good]) == 0)  # fmt: skip

    def _samples_of(self, name: str, most: int | None = None) -> Floats:
        """Columns of thin mechanics at the samples of all plans, or at the first ones of each."""
        z = [plan.z[:most] for plan in self.plans]
        which = np.repeat(np.arange(len(z)), len(z[0]))
        return self._results_thin(self.thin[name], which, np.vstack(z))

    def _time_of_samples(self) -> float:
        """About how long the samples of thin mechanics take [s]."""
        size, begin = max(1, TRIED // len(self.plans)), time.perf_counter()
        self._samples_of(next(iter(self.thin)), size)
        return (time.perf_counter() - begin) * len(self.plans[0].z) / size

    def _at_samples(self, correction: Correction, i: int, names: list[str]) -> Floats:
        """Results of the samples of a plan; nan where the values make no impact."""
        plan, thin = self.plans[i], {name: self.of_samples[name][i] for name in names}
        found = self._corrected(correction, np.full(len(plan.z), i), plan.z, thin)
        state = self.columns.index("status")
        for one in thin.values():
            found[one[:, state] == INVALID] = np.nan
        return found

    def _at(self, correction: Correction, i: int, z: Floats) -> Floats:
        """Results of a plan at coordinates, shape (points, quantities)."""
        which = np.full(len(z), i)
        needed = {key[0] for key in correction.keys if key}
        thin = {name: self._results_thin(self.thin[name], which, z) for name in needed}
        found = self._corrected(correction, which, z, thin)
        # beyond the ends of uniform distributions the correction knows nothing
        uniform = np.array(self.plans[i].uniform)
        beyond = np.flatnonzero((np.abs(z[:, uniform]) > math.sqrt(3) + 1e-9).any(axis=1))
        if beyond.size:
            found[beyond] = self._results(which[beyond], z[beyond])[:, : found.shape[1]]
        return found

    def _corrected(
        self, correction: Correction, which: NDArray[np.intp], z: Floats, thin: dict[str, Floats]
    ) -> Floats:
        """Results of plans `which` at z by thin ones, corrected, shape (points, quantities)."""
        if self.along and z.shape[1] < len(self.coordinates.uniform):
            z = np.column_stack([z, self._place_along(which)])
        found: Floats = correction.results(z, self._parts(which, thin)) * self.size[which]
        return found

    def _errors(
        self, correction: Correction, found: list[Floats], fresh: _Points
    ) -> tuple[Floats, Floats]:
        """Root mean square error at fresh impacts, and the allowed one, per standard deviation.

        No correction is better than the exact impacts are, by the errors that they state.
        """
        deviation = np.stack([np.nanstd(one, axis=0) for one in found])[fresh.which]
        # what does not vary at all is met to rounding
        deviation = np.fmax(deviation, 1e-12 * np.abs(self.size[fresh.which]))
        n = len(self.quantities)
        made = self._corrected(correction, fresh.which, fresh.z, fresh.thin)
        error = np.sqrt(np.mean(((made - fresh.exact[:, :n]) / deviation) ** 2, axis=0))
        allowed = np.full(n, ACCURATE)
        for k, place in enumerate(self.stated):
            if place >= 0:
                own = np.sqrt(np.nanmean((fresh.exact[:, place] / deviation[:, k]) ** 2))
                allowed[k] = max(ACCURATE, float(own))
        return error, allowed
