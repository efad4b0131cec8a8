"""Advice on parameters: those that data determine, in words, and what to measure next."""

from __future__ import annotations

import functools
import math
import warnings
from collections.abc import Sequence

import numpy as np
from scipy.linalg import qr

from .._library import Floats, UnitWarning
from .._text import option
from ..case import Case
from .limits import LEAST
from .observations import Impacts
from .search import Problem

#: Quantities that could be measured next, each to NEXT_ERROR
NEXT = ("cor_sphere", "contact_time", "max_force")
NEXT_ERROR = 0.01
#: Factor from the measured velocities to those that may be measured next
NEXT_REACH = 3.0
#: Part of the worst standard error that a measurement that helps leaves at most
HELPS = 0.98


def probe(case: Case, velocities: Floats, name: str = "cor") -> Impacts:
    """Impacts of the case at other velocities."""
    return Impacts("", {"velocity": velocities, name: np.ones(len(velocities))}, case)


def product(names: Sequence[str], direction: Floats) -> str:
    """A direction of logarithms as a product of powers, the largest power 1."""
    scaled = direction / direction[np.argmax(np.abs(direction))]
    factors = []
    for name, power in zip(names, scaled, strict=True):
        if abs(power) >= LEAST:
            text = f"{power:.2f}".rstrip("0").rstrip(".")
            factors.append(name if text == "1" else f"{name}^{text}")
    return "*".join(factors)


def percent(error: float) -> str:
    """A relative error."""
    if not math.isfinite(error):
        return "at bound" if math.isnan(error) else "unknown"
    return f"{100 * error:.2g} %" if error < 1 else f"{100 * error:.0f} %"


def not_determined(problem: Problem, x: Floats, lost: Floats) -> str:
    """Line that says which combinations the data determine, and what would fix the rest."""
    free = problem.free
    involved = [i for i in range(len(free)) if np.linalg.norm(lost[i]) > LEAST]
    # basis of the determined space, each combination with one parameter of its own
    kept = np.linalg.svd(lost[involved].T)[2][lost.shape[1] :]
    texts = []
    if len(kept):
        order = qr(kept, pivoting=True, mode="r")[1]
        own, rest = np.sort(order[: len(kept)]), order[len(kept) :]
        powers = np.linalg.solve(kept[:, own], kept[:, rest])
        for i, row in zip(own, powers, strict=True):
            direction = np.zeros(len(free))
            direction[involved[i]] = 1
            direction[[involved[j] for j in rest]] = row
            texts.append(product(free, direction))
    names = " and ".join([", ".join(free[i] for i in involved[:-1]), free[involved[-1]]][
        len(involved) == 1 :])  # fmt: skip
    each = " each" if len(involved) > 1 else ""
    said = f"the data do not determine {names}{each}"
    if texts:
        said += f": they fix {' and '.join(texts)}"
    helps = [name for name in NEXT if _responds(problem, x, lost, name)]
    fix = "one of them" if lost.shape[1] == 1 else f"{lost.shape[1]} of them"
    fix = fix if len(involved) > 1 else "it"
    given = f"give a {' or a '.join(helps)}, or " if helps else ""
    return f"{problem.case.name}: {said}; {given}fix {fix} ({option('fix', {'ADDRESS': ...})})"


def _responds(problem: Problem, x: Floats, lost: Floats, name: str) -> bool:
    """Whether a measured quantity would respond to every combination that is lost."""
    if not problem.impacts or len(problem.impacts[0].velocity) < lost.shape[1]:
        return False
    slopes = problem.elasticities(x, problem.impacts[0], [name]) @ lost
    if not np.isfinite(slopes).all():
        return False
    return bool(np.linalg.svd(slopes, compute_uv=False).min() > NEXT_ERROR)


def next_measurement(problem: Problem, x: Floats, covariance: Floats) -> str:
    """The measurement that would bring the worst parameter down most."""
    case, free, speeds = problem.case, problem.free, problem.speeds
    grid = np.geomspace(speeds.min() / NEXT_REACH, speeds.max() * NEXT_REACH, 13)
    trial = probe(case, grid)
    slopes = problem.elasticities(x, trial, NEXT) / NEXT_ERROR
    now = np.diag(covariance)
    # one datum more takes a matrix of rank 1 from the covariance
    seen = slopes @ covariance
    left = (now - seen**2 / (1 + np.sum(slopes * seen, axis=1))[:, None]).max(axis=1) / now.max()

    @functools.cache
    def is_feasible(speed: float) -> bool:
        """Whether such an impact has been measured, or the model holds for it."""
        if speeds.min() <= speed <= speeds.max():
            return True
        with warnings.catch_warnings():
            # no one has given these velocities
            warnings.simplefilter("ignore", UnitWarning)
            return probe(case, np.array([speed])).validity(case)[0][0] != "outside"

    helps = np.argsort(left, kind="stable")[: np.sum(left <= HELPS**2)]
    where = next((int(j) for j in helps if is_feasible(float(grid[j // len(NEXT)]))), None)
    if where is None:
        return "no single further impact would help much"
    best = float(left[where])
    name, speed = NEXT[where % len(NEXT)], grid[where // len(NEXT)]
    worst = free[int(np.argmax(now))]
    before, after = (percent(math.sqrt(part * now.max())) for part in (1.0, max(best, 0.0)))
    return (f"{name} at {speed:.3g} m/s to {100 * NEXT_ERROR:g} %: {worst} to {after} instead of "
            f"{before}")  # fmt: skip
