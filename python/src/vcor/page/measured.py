"""Own measured points of a page: rows as they are typed, or a file with names of columns."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from .._library import Error, Floats
from ..case import Case
from .keys import Key

#: Wrong lines that are shown
_MOST_FAULTS = 5
#: Largest e: that of a row above it is a resilience in per cent, say
_LARGEST = 2.0
_CELL = re.compile(r"([-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?)\s*(%?)")


@dataclass
class Measured:
    """Points: coefficients, and what is known of their impacts."""

    #: SI values at addresses, each of shape (n,)
    at: Mapping[str, Floats] = field(default_factory=dict)
    #: Coefficient of restitution and length of the bar to each side, of shape (n,)
    e: Floats = field(default_factory=lambda: np.empty(0))
    bar: Floats = field(default_factory=lambda: np.empty(0))
    #: Faults of lines, and how columns were understood
    faults: list[str] = field(default_factory=list)


def rows(text: str, address: str, key: Key) -> Measured:
    """Points of rows `x, e` or `x, e, bar`, as the page of a file reads them.

    Parameters
    ----------
    text
        The rows. Cells end at commas, semicolons, tabs or blanks; with semicolons or tabs a comma
        is a decimal one. `#` begins a remark, and the first row may be a heading.
    address, key
        What x is, in its usual unit.
    """
    made: list[tuple[float, float, float]] = []
    faults: list[str] = []
    is_first = True
    wanted = f"expected {key.label}, e and the length of a bar or none"
    for number, line in enumerate(text.splitlines(), 1):
        row = line.partition("#")[0].strip()
        if not row:
            continue
        pattern = r"\s*[;\t]\s*" if re.search(r"[;\t]", row) else r"\s*,\s*|\s+"
        cells = [cell.strip() for cell in re.split(pattern, row)]
        found = [_CELL.fullmatch(cell) for cell in cells]
        was_first, is_first = is_first, False
        if was_first and not any(found):
            continue
        wrong = [cell for cell, one in zip(cells, found, strict=True) if one is None]
        if wrong:
            faults.append(f"line {number}: found '{wrong[0]:.30}', {wanted}")
            continue
        numbers = [float(one[1].replace(",", ".")) / (100 if one[2] else 1) for one in found if one]
        if not 2 <= len(numbers) <= 3:
            faults.append(f"line {number}: found {len(numbers)} numbers, {wanted}")
            continue
        x, e, bar = (*numbers, 0.0)[:3]
        if not 0 <= e <= _LARGEST:
            faults.append(f"line {number}: found e = {e:g}, expected 0 to {_LARGEST:g}; a "
                          "resilience is its square")  # fmt: skip
        elif bar < 0:
            faults.append(f"line {number}: found a bar of {bar:g}, expected a length")
        else:
            made.append((float(key.written(repr(x))), e, bar))
    if len(faults) > _MOST_FAULTS:
        faults[_MOST_FAULTS:] = [f"and {len(faults) - _MOST_FAULTS} more lines"]
    table = np.reshape(np.array(made), (-1, 3))
    return Measured({address: table[:, 0]}, table[:, 1], table[:, 2], faults)


def of_file(path: str | os.PathLike[str], case: Case) -> Measured:
    """Points of a file whose columns have names, as `vcor identify` reads it.

    Raises
    ------
    Error
        It has no coefficients of restitution, or is no such file.
    """
    # pandas and scipy, which a page without files does not need
    from ..materials.observations import (
        NO_DIGITS,
        SETTINGS,
        _as_velocities,
        gravity_of,
        read_columns,
    )

    columns, about, _ = read_columns(path, case)
    known = {}
    if "drop_height" in columns:
        known["impact.drop_height"] = columns["drop_height"]
    columns, _ = _as_velocities(os.fspath(path), dict(columns), case, NO_DIGITS)
    for name in ("cor_sphere", "cor", "resilience"):
        if name in columns:
            break
    else:
        raise Error(f"{os.fspath(path)}: found {', '.join(columns)}, expected measured "
                    "coefficients of restitution, resiliences or rebounds")  # fmt: skip
    e = columns[name]
    bar = columns.get(f"{name}_sigma", np.zeros(len(e)))
    if name == "resilience":
        # that of a ball at rest on the other side: e^2
        e, bar = np.sqrt(e), np.divide(bar, 2 * np.sqrt(e))
    names = {SETTINGS.get(one, one): column for one, column in columns.items()}
    known |= {one: column for one, column in names.items() if one in case and "." in one}
    if "impact.velocity" in known:
        height = known["impact.velocity"] ** 2 / (2 * gravity_of(case))
        known.setdefault("impact.drop_height", height)
    if "sphere.radius" in known:
        known["sphere.diameter"] = 2 * known["sphere.radius"]
    return Measured(known, e, np.nan_to_num(bar), [str(about["taken"])])
