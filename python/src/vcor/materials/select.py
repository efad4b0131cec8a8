"""Which rows of a file are taken: by a column of words or numbers, a sheet, or a temperature."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .._library import Floats, UsageError
from .._text import option
from .grid import is_number, number
from .labels import read_label
from .names import plain

#: Conditions as a user states them: {"ball": "golf"}, ["ball=golf", "temperature!=-20C"]
Where = Mapping[str, str | float] | Sequence[str] | str | None

#: Difference of temperatures that are the same [K]
_SAME = 1.0
#: Most words of a column that a message shows
_MOST_WORDS = 6


@dataclass
class Condition:
    """Rows that are taken have a value in a column, or one in a range; or they have not."""

    name: str
    value: str
    negated: bool
    #: Whether a file had such a column, sheets or temperatures
    seen: bool = False
    #: Whether a row was taken
    met: bool = False
    #: Values of the column, in the order of the file
    found: dict[str, None] = field(default_factory=dict)

    def __str__(self) -> str:
        return f"{self.name}{'!' * self.negated}={self.value}"

    @property
    def bounds(self) -> tuple[str, str] | None:
        """Ends of a range A:B; None: it is a single value."""
        first, mark, last = self.value.partition(":")
        return (first.strip(), last.strip()) if mark else None

    def takes(self, cell: str) -> bool:
        """Whether a cell fulfils the condition."""
        self.seen = True
        if cell and len(self.found) < 100:
            self.found[cell] = None
        if (ends := self.bounds) and all(not end or is_number(end) for end in ends):
            low, high = (number(end) if end else bound for end, bound in
                         zip(ends, (-math.inf, math.inf), strict=True))  # fmt: skip
            fits = is_number(cell) and low <= number(cell) <= high
        elif is_number(cell) and is_number(self.value):
            fits = math.isclose(number(cell), number(self.value), rel_tol=1e-9)
        else:
            fits = plain(cell) == plain(self.value)
        taken = fits != self.negated
        self.met |= taken
        return taken

    def temperatures(self, kelvin: Floats) -> NDArray[np.bool_]:
        """Which of some temperatures [K] fulfil the condition."""
        self.seen = True
        for one in kelvin[np.isfinite(kelvin)][:100]:
            self.found[f"{round(float(one) - 273.15, 2) + 0.0:g}C"] = None
        ends = self.bounds or (self.value, self.value)
        slack = 0.0 if self.bounds else _SAME
        low, high = (_kelvin(end, str(self)) if end else bound for end, bound in
                     zip(ends, (-math.inf, math.inf), strict=True))  # fmt: skip
        taken: NDArray[np.bool_] = (
            (kelvin >= low - slack) & (kelvin <= high + slack)
        ) != self.negated
        self.met |= bool(taken.any())
        return taken

    def refusal(self, where: str) -> UsageError:
        """Why no row was taken, or why the condition means nothing."""
        known = list(self.found)
        if plain(self.name) == "line":
            known = [f"{known[0]} to {known[-1]}"] if known else []
        told = ", ".join(f"'{one[:40]}'" for one in known[:_MOST_WORDS])
        told += f" and {len(known) - _MOST_WORDS} more" * (len(known) > _MOST_WORDS)
        if not self.seen:
            others = "; sheet, temperature and line are columns too"
            if plain(self.name) in ("sheet", "temperature", "line"):
                others = ""
            return UsageError(f"{option('where')}: {where} no column '{self.name[:60]}'{others}")
        return UsageError(f"{option('where')}: found no row with '{self!s:.80}', expected one of "
                          f"{told or 'its values'}")  # fmt: skip


def _kelvin(text: str, what: str) -> float:
    """Temperature [K] of a condition.

    UsageError: a text that is no temperature.
    """
    label = read_label(text)
    if not math.isfinite(label.kelvin):
        raise UsageError(f"{option('where')}: found '{what:.80}', expected temperatures such as "
                         "-20C or 253K")  # fmt: skip
    return label.kelvin


def conditions(where: Where) -> list[Condition]:
    """Conditions as a user states them."""
    if isinstance(where, Mapping):
        where = [f"{name}={value}" for name, value in where.items()]
    if isinstance(where, str):
        where = [where]
    found = []
    for text in where or []:
        parts = re.fullmatch(r"\s*(.+?)\s*(!?)=\s*(.+?)\s*", str(text))
        if not parts:
            raise UsageError(
                f"{option('where')}: found '{text!s:.80}', expected COLUMN=VALUE, COLUMN!=VALUE or "
                "COLUMN=FROM:TO; sheet, temperature and line are columns too"
            )
        found.append(Condition(parts[1], parts[3], bool(parts[2])))
    return found


def words_of(cells: Sequence[str]) -> list[str]:
    """The words of a column that has few, each for several rows; empty if it has others."""
    words = list(dict.fromkeys(filter(None, cells)))
    few = 2 <= len(words) <= _MOST_WORDS and 2 * len(words) <= len(cells)
    return words if few and not any(map(is_number, words)) else []
