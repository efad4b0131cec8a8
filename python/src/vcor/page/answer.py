"""Answer of a page to a case: numbers of the impact, its history, a curve, moduli.

Nothing here knows of a browser. `parts` gives one part after another, so that the thread that
computes them can leave what nobody waits for any more.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from ctypes import byref, c_double
from dataclasses import dataclass

import numpy as np

from .. import _coverage, _library
from .._library import Error, Floats, call
from ..case import Case
from .document import VERDICTS
from .table import drop_of

#: Points of a curve, and how they are computed: every so many first, so that it grows as a whole
POINTS = 101
_STRIDES = (20, 10, 5, 1)
#: Most points of a history that are drawn
_MOST_TIMES = 400
#: Times that a contact sees, in parts of its duration: what `vcor identify` takes
_SEEN = (0.01, 1.0)
#: Times of a figure of moduli, in parts of the duration of the contact
_DRAWN = (1e-4, 1e2)
_TIMES = 121


@dataclass(frozen=True)
class Span:
    """The number against which a curve is drawn, in SI units."""

    address: str
    first: float
    last: float
    is_log: bool

    def values(self, count: int = POINTS) -> Floats:
        """Values from the first to the last one, which are exact."""
        if self.is_log:
            found = np.geomspace(self.first, self.last, count)
        else:
            found = np.linspace(self.first, self.last, count)
        found[[0, -1]] = self.first, self.last
        return found


@dataclass
class Curve:
    """Coefficients over a span; nan without a result or not yet computed."""

    x: Floats
    cor: Floats
    level: list[str]


@dataclass
class Answer:
    """Results of an impact; None where there are none yet."""

    #: Columns of the summary by name, texts as words
    numbers: dict[str, float | str] | None = None
    #: Remarks on data that do not cover the impact, and on numbers that may be in another unit
    remarks: Sequence[str] = ()
    #: Height of the drop [m], nan if there is none
    drop: float = np.nan
    #: Columns of the history by name
    history: Mapping[str, Floats] | None = None
    #: Curve of the case, and those of the kept ones
    curves: Sequence[Curve] | None = None
    #: Moduli of each material that relaxes by its name
    moduli: Mapping[str, Mapping[str, Floats]] | None = None
    #: Why there is no result, in the line of the program; empty if there is one
    fault: str = ""
    #: Exit code of the program for it
    code: int = 1
    #: Whether nothing more comes
    is_whole: bool = False


def parts(case: Case, span: Span | None, others: Sequence[Case]) -> Iterator[Answer]:
    """Compute what a page shows: what is known so far, again and again.

    Parameters
    ----------
    case
        A single impact.
    span
        What the curves are drawn against; None: no curves.
    others
        Cases with curves of their own.
    """
    made = Answer()
    try:
        made.numbers, made.remarks = _numbers(case)
        made.drop = drop_of(case, []).get("factor", np.nan)
    except Error as error:
        made.fault, made.code = str(error), error.code
        made.is_whole = True
    yield made
    if made.numbers is None:
        return
    made.moduli = _moduli(case, float(made.numbers["contact_time"]))
    # with exact mechanics the history is a solution of its own
    if case._has_mesh:
        yield made
    made.history = _history(case)
    if span is not None:
        yield from _curves(made, [case, *others], span)
    made.is_whole = True
    yield made


def exact(case: Case) -> float:
    """Coefficient of restitution of the sphere with exact mechanics, nan without a result."""
    found = c_double()
    try:
        call("vcor_exact", case._pointer, byref(found))
    except Error:
        return np.nan
    return found.value


def sentence(numbers: Mapping[str, float | str]) -> tuple[str, str]:
    """Level of validity and what it means, as the page of a file says it."""
    level, cause = str(numbers["validity"]), str(numbers["validity_cause"])
    if level == "none":
        return "", f"No result: {str(numbers['status']).replace('_', ' ')}."
    if cause == "none":
        return level, VERDICTS[level]
    columns = _library.columns(0)
    meaning = f" ({columns[cause].meaning})" if cause in columns else ""
    return level, f"{VERDICTS[level]}, by {cause}{meaning}."


# The thread of a page gives no warnings: filters of warnings are those of the whole process


def _numbers(case: Case) -> tuple[dict[str, float | str], list[str]]:
    """All columns of the summary; numbers in another unit, and what the data do not cover."""
    columns = _library.columns(0)
    # data are compared by solutions, which take long with exact mechanics
    is_examined = not case._has_mesh
    found, remarks, fault = _coverage.solved(case, {}, list(columns), False, is_examined)
    if fault:
        raise fault
    lines = [*remarks.units.splitlines(), *remarks.beyond_data.splitlines()]
    if not is_examined and any(case[f"{path_of(name)}.valid_from"] is not None
                               for name in materials_of(case)):  # fmt: skip
        lines.append("Whether the data of the materials cover this contact is not examined here "
                     "with exact mechanics; vcor run says it.")  # fmt: skip
    pairs = zip(columns.items(), found, strict=True)
    return {name: column.value(value) for (name, column), value in pairs}, lines


def _history(case: Case) -> dict[str, Floats]:
    """Columns of the history, thinned."""
    columns = case._history()
    size = len(columns["time"])
    # the last point too
    take = np.unique(np.append(np.arange(0, size, max(1, size // _MOST_TIMES)), size - 1))
    return {name: columns[name][take] for name in ("time", "indentation", "force")}


def _curves(made: Answer, cases: Sequence[Case], span: Span) -> Iterator[Answer]:
    """Coefficients of cases over a span, coarse points first."""
    x = span.values()
    made.curves = [Curve(x, np.full(len(x), np.nan), [""] * len(x)) for _ in cases]
    labels = _library.columns(0)["validity"]
    done = np.zeros(len(x), dtype=bool)
    for stride in _STRIDES:
        new = np.flatnonzero(~done & (np.arange(len(x)) % stride == 0))
        done[new] = True
        # one point at a time where that takes a moment, so that it can be left
        step = len(new) if not any(case._has_mesh for case in cases) else 1
        for case, curve in zip(cases, made.curves, strict=True):
            for start in range(0, len(new), step):
                some = new[start : start + step]
                try:
                    found, _ = case._solve(
                        [span.address], x[some, None], ["cor_sphere", "validity"], 0
                    )
                except Error:
                    break
                curve.cor[some] = found[:, 0]
                for i, level in zip(some, labels.values(found[:, 1]), strict=True):
                    curve.level[i] = str(level)
                if step == 1:
                    yield made
    yield made


def _moduli(case: Case, contact_time: float) -> dict[str, dict[str, Floats]]:
    """Moduli of the materials that relax, around the times of the contact."""
    if not contact_time > 0:
        return {}
    times = contact_time * np.geomspace(*_DRAWN, _TIMES)
    made = {}
    for name in materials_of(case):
        if case[f"{path_of(name)}.model"] in ("rigid", "elastic"):
            continue
        try:
            material = case.material(name)
            modulus = material.complex_modulus(1.0 / times)
        except Error:
            continue
        made[name] = {
            "frequency": 1.0 / times, "storage_modulus": modulus.real,
            "loss_modulus": modulus.imag,
        }  # fmt: skip
    return made


def seen(contact_time: float) -> tuple[float, float]:
    """Angular frequencies that a contact sees [rad/s]."""
    return 1.0 / (_SEEN[1] * contact_time), 1.0 / (_SEEN[0] * contact_time)


def materials_of(case: Case) -> list[str]:
    """Names of the materials in use, each once."""
    bodies = ("sphere", "plate", "target")
    names = [case[f"{body}.material"] for body in bodies]
    return list(dict.fromkeys(str(name) for name in names if name))


def path_of(name: str) -> str:
    """Name of a material in an address."""
    return "'" + name.replace("'", "''") + "'" if "." in name else name.replace(" ", "_")


def start_of(value: float | None, unit: str) -> tuple[float, float, bool]:
    """Range around a value, for its slider and its curve: first, last, equal ratios."""
    if unit == "K":
        return 253.15, 353.15, False
    if value is None or not value > 0:
        return 0.0, 1.0, False
    return value / 4.0, value * 4.0, True


def height(metres: float) -> str:
    """A length with three digits in a unit that suits it."""
    for size, unit in ((1.0, "m"), (1e-2, "cm"), (1e-3, "mm")):
        if metres >= size or unit == "mm":
            return f"{metres / size:.3g} {unit}"
    raise AssertionError
