"""The sweep behind a page, and its interpolation as the page does it.

The page interpolates with `at` of page.js, which is `Table.at` once more: here it measures the
error on impacts that the sweep does not have.
"""

from __future__ import annotations

import contextlib
import itertools
import math
import os
import time
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _library
from .._coverage import unwarned
from .._library import Error, NoResultWarning, NumericalError, ValidityWarning
from .._text import option
from ..arguments import threads_of
from ..case import Case, number
from ..units import size
from .axes import Axis

#: Points along each axis by the number of axes: the fewest, and the most, for which there is room
LEAST, MOST = {1: 17, 2: 9, 3: 7}, {1: 129, 2: 65, 3: 25}
#: Time that the usual number of points may take; what takes longer is announced [s]
_LONG = 10.0
#: Impacts that measure the error of interpolation: half as many as points, between these
_FRESH = 25, 200
#: Standard gravity [m/s2]
_GRAVITY = (size("gn", "m/s2") or (math.nan,))[0]
#: Points of a cubic polynomial
_CUBIC = 4
#: Columns that make the state of a point: nothing is interpolated
#: between two statuses, two levels of validity or two numbers of contacts
_STATE = ("status", "validity", "contacts")


@dataclass(frozen=True)
class Found:
    """Entry of a table at a place: a value, or none between different states."""

    #: Coefficient of restitution of the sphere; nan if there is none
    value: float
    #: States of the nearest points, as numbers of `Table.states`; one if there is a value
    states: list[int]


@dataclass
class Table:
    """Impacts on a grid; place 0 to count - 1 along each axis."""

    name: str
    counts: tuple[int, ...]
    #: Coefficient of restitution of the sphere, nan without a result; shape (points,)
    cor: NDArray[np.float32]
    #: Number of the state of each point; shape (points,)
    state: NDArray[np.uint8]
    #: Number of the measure that decides on validity; shape (points,)
    cause: NDArray[np.uint8]
    #: Texts of the states: status, validity and what else `_STATE` has
    states: list[tuple[str, ...]]
    #: The case as namelists with every default
    case: str = ""
    #: Height of the drop, as `drop_of` has it
    drop: dict[str, float] = field(default_factory=dict)
    #: Largest error of interpolation at fresh impacts; nan if there is none with a value
    error: float = math.nan
    #: Fresh impacts, those without a value, and those that have another state than the page says
    fresh: int = 0
    blank: int = 0
    other: int = 0
    #: How many points have no result, and why the first one has none; empty if all have one
    lost: str = ""
    #: Remarks on impacts that the data behind the materials do not cover
    beyond: list[str] = field(default_factory=list)

    def at(self, places: Sequence[float]) -> Found:
        """Interpolate with cubic polynomials in each axis, never between different states.

        The corners of the cell have to be of one state. The four points along an axis are those
        around the place, or one step to a side if only these are of this state; if there are none,
        it is linear.
        """
        cells = [min(int(place), count - 2)
                 for place, count in zip(places, self.counts, strict=True)]  # fmt: skip
        # a place on a point needs no neighbours
        exact = [round(place) if place == round(place) else None for place in places]
        corners = [[on] if on is not None else [cell, cell + 1]
                   for on, cell in zip(exact, cells, strict=True)]  # fmt: skip
        states = sorted({int(self.state[self._index(one)]) for one in itertools.product(*corners)})
        if len(states) > 1:
            return Found(math.nan, states)
        for points in (*self._cubes(cells, exact), corners):
            nodes = [self._index(one) for one in itertools.product(*points)]
            if all(self.state[node] == states[0] for node in nodes):
                weights = [
                    _lagrange(some, place) for some, place in zip(points, places, strict=True)
                ]
                parts = [math.prod(some) for some in itertools.product(*weights)]
                return Found(float(np.dot(parts, self.cor[nodes].astype(float))), states)
        raise AssertionError("the corners are of one state")

    def _cubes(self, cells: list[int], exact: list[int | None]) -> Iterator[list[list[int]]]:
        """Points for cubic polynomials: those around the cell first."""
        starts = []
        for cell, on, count in zip(cells, exact, self.counts, strict=True):
            if on is not None:
                starts.append([[on]])
                continue
            some = dict.fromkeys(min(max(cell - 1 + shift, 0), count - _CUBIC)
                                 for shift in (0, -1, 1))  # fmt: skip
            starts.append([list(range(one, one + _CUBIC)) for one in some])
        yield from map(list, itertools.product(*starts))

    def _index(self, place: Sequence[int]) -> int:
        """Index of a place of the grid in a flat list."""
        return int(np.ravel_multi_index(tuple(place), self.counts))


def _lagrange(points: list[int], place: float) -> list[float]:
    """Weights of the values at some points for that at a place."""
    return [math.prod((place - other) / (point - other) for other in points if other != point)
            for point in points]  # fmt: skip


def solve(
    case: Case, name: str, axes: Sequence[Axis], count: int | None, threads: int | None
) -> Table:
    """Solve the impacts of a page.

    Parameters
    ----------
    case
        The case with its materials.
    name
        Name of the choice.
    axes
        What varies.
    count
        Points along each axis; None: between `LEAST` and `MOST`, what ten seconds allow.
    threads
        As for `Case.sweep`.

    Raises
    ------
    Error
        No point has a result: why the first one has none.
    """
    one, cores = _time(case, axes), threads_of(threads) or len(os.sched_getaffinity(0))
    counts = (count or _count(len(axes), one / cores),) * len(axes)
    fresh = min(max(math.prod(counts) // 2, _FRESH[0]), _FRESH[1])
    _announce(f"{case.name}{f' with {name}' * bool(name)}", math.prod(counts) + fresh, one / cores)
    columns = ["cor_sphere", "validity_cause", *_STATE]
    nodes = {axis.address: axis.si(axis.nodes(counts[0])) for axis in axes}
    with warnings.catch_warnings(record=True) as heard, unwarned(ValidityWarning):
        warnings.simplefilter("always")
        data = case.sweep(nodes, columns, threads=threads)
    cor = data.cor_sphere.values.ravel()
    if not np.isfinite(cor).any():
        case.solve({address: values[0] for address, values in nodes.items()}, ["cor_sphere"])
        raise NumericalError(f"{case.name}: no point has a result")
    for note in heard:
        warnings.warn(note.message, stacklevel=2)
    lost = [str(note.message) for note in heard if note.category is NoResultWarning]
    with warnings.catch_warnings(), unwarned():
        # the same as of the sweep
        warnings.simplefilter("ignore")
        shares = np.random.default_rng(1).random((fresh, len(axes)))
        points = {axis.address: axis.si(axis.values(share))
                  for axis, share in zip(axes, shares.T, strict=True)}  # fmt: skip
        tested = case.points(points, columns, threads=threads)
    known = _states(data)
    states = list(dict.fromkeys(known))
    causes = _library.columns(0)["validity_cause"].labels.split()
    made = Table(
        name, counts, cor.astype(np.float32),
        np.array([states.index(one) for one in known], dtype=np.uint8),
        np.array([causes.index(one) for one in data.validity_cause.values.ravel()], dtype=np.uint8),
        states, case=data.attrs["case"], drop=drop_of(case, axes), fresh=fresh,
        lost="".join(lost).removeprefix(f"{case.name}: "),
        beyond=data.attrs.get("beyond_data", "").splitlines(),
    )  # fmt: skip
    errors = []
    for share, state, value in zip(shares, _states(tested), tested.cor_sphere.values, strict=True):
        found = made.at([(counts[0] - 1) * one for one in share])
        if math.isnan(found.value):
            made.blank += 1
        elif states[found.states[0]] != state:
            made.other += 1
        else:
            errors.append(abs(found.value - value))
    made.error = max(errors, default=math.nan)
    return made


def _states(data: Any) -> list[tuple[str, ...]]:
    """State of each point: texts that change where nothing may be interpolated."""
    columns = [data[name].values.ravel() for name in _STATE]
    return list(zip(*[column.astype(str).tolist() for column in columns], strict=True))


def _time(case: Case, axes: Sequence[Axis]) -> float:
    """Time of the impact in the middle [s]; 0 if it has no result."""
    middle = {axis.address: float(axis.si(axis.values(np.array(0.5)))) for axis in axes}
    with warnings.catch_warnings(), unwarned(), contextlib.suppress(Error):
        warnings.simplefilter("ignore")
        # the first one may read data files and make tables
        case.solve(middle, ["cor_sphere"])
        begin = time.perf_counter()
        case.solve(middle, ["cor_sphere"])
        return time.perf_counter() - begin
    return 0.0


def _count(axes: int, one: float) -> int:
    """Points along each axis, by the time that one takes [s]: what `_LONG` allows."""
    least, most = LEAST[axes], MOST[axes]
    # with half as many fresh impacts
    one = max(1.5 * one, _LONG / most**axes)
    return max(int((_LONG / one) ** (1 / axes) + 1e-9), least)


def _announce(what: str, impacts: int, one: float) -> None:
    """Say how long it takes, if that is long."""
    if (seconds := impacts * one) > _LONG:
        words = f"{seconds / 60:.0f} min" if seconds > 90 else f"{seconds:.0f} s"
        warnings.warn(f"{what}: {impacts} impacts take some {words}; {option('points')} with a "
                      "smaller number takes less", stacklevel=2)  # fmt: skip


def drop_of(case: Case, axes: Sequence[Axis]) -> dict[str, float]:
    """Height of the drop: its `factor` [SI], times a power of the SI number of an axis, if any.

    It is the drop height where the case has one, else v^2/(2 g); empty if g varies.
    """
    varied = [axis.address for axis in axes]
    height, velocity = "impact.drop_height", "impact.velocity"
    if height in varied:
        return {"factor": 1.0, "axis": varied.index(height), "power": 1.0}
    if velocity not in varied and not math.isnan(fixed := number(case, height)):
        return {"factor": fixed}
    if "impact.gravity" in varied:
        return {}
    gravity = number(case, "impact.gravity", 0.0) or _GRAVITY
    if velocity in varied:
        return {"factor": 0.5 / gravity, "axis": varied.index(velocity), "power": 2.0}
    return {"factor": 0.5 * number(case, velocity) ** 2 / gravity}
