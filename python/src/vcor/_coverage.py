"""Warnings about results: their validity, and data that do not cover an impact.

The library judges both; what it says travels with each result, as warnings and as attributes.
"""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextvars import ContextVar
from ctypes import byref, c_double, c_void_p
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._library import DataRangeWarning, Error, Floats, UnitWarning, ValidityWarning, call

#: A `Case`, whose module uses this one
Case = Any

#: Columns that the remarks are made from
_JUDGED = ("validity", "validity_cause", "status", "contact_time", "cor")
#: Levels that need no remark
_NO_REMARK = ("good", "none")

#: Warnings that are not given
_silent: ContextVar[tuple[type[Warning], ...]] = ContextVar("silent", default=())


class Numbers(dict[str, float | str]):
    """The numbers of an impact by their names, and what they do not know of themselves.

    Attributes
    ----------
    validity
        "good", or the level with the measure that decides, as "outside (contact_ratio)".
    beyond_data
        Lines about data of materials that do not cover the impact; empty if they do.
    """

    validity: str = ""
    beyond_data: str = ""


@contextlib.contextmanager
def unwarned(*kinds: type[Warning]) -> Iterator[None]:
    """Give no warnings of these kinds, or of both, of results that are parts of another one."""
    token = _silent.set(kinds or (ValidityWarning, DataRangeWarning))
    try:
        yield
    finally:
        _silent.reset(token)


def with_judged(names: Sequence[str]) -> list[str]:
    """Names of columns, and after them those that the remarks are made from."""
    return [*names, *_JUDGED]


def validity_of(levels: ArrayLike, causes: ArrayLike) -> str:
    """How many points are outside and caution, and by which measures.

    Parameters
    ----------
    levels, causes
        The columns `validity` and `validity_cause`, of shape (points,).
    """
    level, cause = np.asarray(levels).ravel(), np.asarray(causes).ravel()
    parts = []
    # the worst first; good and none need no remark
    for word in reversed(_library.columns(0)["validity"].labels.split()):
        found = level == word
        if word in _NO_REMARK or not found.any():
            continue
        at = f"{found.sum()} of {len(level)} points " if len(level) > 1 else ""
        measures = dict.fromkeys(cause[found].tolist())
        parts.append(f"{at}{word} ({', '.join(measures)})")
    return ", ".join(parts) or ("good" if (level == "good").any() else "none")


class Remarks(NamedTuple):
    """What there is to say about an impact, in lines; empty if nothing."""

    #: Numbers that look like those in another unit
    units: str
    #: A level of validity that is not good, with the name of the case
    validity: str
    #: What the data of the materials do not cover
    beyond_data: str


def solved(
    case: Case,
    point: Mapping[str, float],
    names: Sequence[str],
    is_judged: bool = True,
    is_examined: bool = True,
) -> tuple[list[float], Remarks, Error | None]:
    """Solve one impact in one call of the library; nothing is warned of.

    Parameters
    ----------
    case, point
        The case, and values at some addresses; the case itself if there are none.
    names
        Columns of the summary.
    is_judged, is_examined
        Whether remarks on the validity and on the data are wanted; these may take two solutions.

    Returns
    -------
    tuple
        Numbers of the columns, the remarks, and the error of an impact without a result.
    """
    m, k, fault = len(point), len(names), None
    numbers, units, validity, data = (c_double * k)(), c_void_p(), c_void_p(), c_void_p()
    try:
        call("vcor_impact", case._pointer, m, _library.texts(tuple(point)),
             (c_double * m)(*point.values()), k, _library.texts(tuple(names)), numbers,
             byref(units), byref(validity) if is_judged else None,
             byref(data) if is_examined else None)  # fmt: skip
    except Error as error:
        fault = error
    texts = (_library.take_text(one) or "" if one else "" for one in (units, validity, data))
    return list(numbers), Remarks(*texts), fault


def impact(
    case: Case,
    point: Mapping[str, float],
    names: Sequence[str],
    asked: Sequence[str] | None = (),
    level: int = 3,
) -> tuple[list[float], dict[str, str]]:
    """Solve one impact; warn of what there is to say about it.

    Parameters
    ----------
    case, point, names
        As for `solved`.
    asked, level
        As for `about`.

    Returns
    -------
    tuple
        Numbers of the columns, and attributes as of `about`.
    """
    silent = _silent.get()
    is_judged = ValidityWarning not in silent and not _asks(asked)
    numbers, remarks, fault = solved(
        case, point, [*names, *_JUDGED[:2]], is_judged, DataRangeWarning not in silent
    )
    for line in remarks.units.splitlines():
        warnings.warn(line, UnitWarning, stacklevel=level)
    if fault:
        raise fault
    columns = _library.columns(0)
    word, cause = (
        columns[name].value(one) for name, one in zip(_JUDGED[:2], numbers[-2:], strict=True)
    )
    said = {"validity": str(word) if word in _NO_REMARK else f"{word} ({cause})"}
    if remarks.beyond_data:
        said["beyond_data"] = remarks.beyond_data.strip("\n")
    if remarks.validity:
        warnings.warn(remarks.validity, ValidityWarning, stacklevel=level)
    for line in remarks.beyond_data.splitlines():
        warnings.warn(line, DataRangeWarning, stacklevel=level)
    return numbers[:-2], said


def about(
    case: Case,
    addresses: Sequence[str],
    table: Floats,
    results: Floats,
    asked: Sequence[str] | None = (),
    level: int = 3,
) -> dict[str, str]:
    """Attributes of points on validity and coverage; warns of them.

    Parameters
    ----------
    case, addresses, table
        The case and its points, of shape (points, addresses).
    results
        Their columns, the last of which are those of `with_judged`.
    asked
        Quantities that the caller has named: who asks for the validity needs no warning of it.
    level
        Frames from here to the caller that is warned.

    Returns
    -------
    dict
        Attributes: `validity`, and `beyond_data` where there is anything to say.
    """
    levels, causes = (
        _library.columns(0)[name].values(results[:, i - len(_JUDGED)])
        for i, name in enumerate(_JUDGED[:2])
    )
    said = {"validity": validity_of(levels, causes)}
    if lines := _beyond_data(case, addresses, table, *results[:, -3:].T):
        said["beyond_data"] = lines
    is_known = _asks(asked) or said["validity"] in _NO_REMARK
    if not is_known and ValidityWarning not in _silent.get():
        warnings.warn(
            f"{case.name}: validity: {said['validity']}", ValidityWarning, stacklevel=level
        )
    for line in lines.splitlines():
        warnings.warn(line, DataRangeWarning, stacklevel=level)
    return said


def _asks(asked: Sequence[str] | None) -> bool:
    """Whether the validity is among the quantities that a caller has named."""
    return "validity" in ([asked] if isinstance(asked, str) else asked or ())


def about_history(case: Case) -> dict[str, str]:
    """Attributes of a history on the validity and coverage of its impact; warns of them."""
    with contextlib.suppress(Error):
        return impact(case, {}, (), level=4)[1]
    # it sticks, or does not separate
    return {"validity": "none"}


def _beyond_data(
    case: Case,
    addresses: Sequence[str],
    table: Floats,
    status: Floats,
    contact_time: Floats,
    cor: Floats,
) -> str:
    """Lines about data that do not cover the points; empty if they do."""
    # what nobody hears takes two solutions
    if DataRangeWarning in _silent.get():
        return ""
    text = c_void_p()
    with contextlib.suppress(Error):
        call("vcor_beyond_data", case._pointer, len(addresses),
             _library.texts(tuple(addresses)), len(table), np.ascontiguousarray(table),
             *map(np.ascontiguousarray, (status, contact_time, cor)), byref(text))  # fmt: skip
    return (_library.take_text(text) or "").strip("\n") if text else ""


def of_columns(variables: Mapping[Any, Any]) -> dict[str, str]:
    """The attribute `validity` of a summary that has its columns."""
    found = [variables[name].values for name in _JUDGED[:2] if name in variables]
    if len(found) < len(_JUDGED[:2]) or any(one.dtype.kind != "U" for one in found):
        return {}
    return {"validity": validity_of(*found)}
