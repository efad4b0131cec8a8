"""Numbers that a page varies: their ranges in units as users write them."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .._library import Floats, UsageError
from .._text import option
from ..case import Case
from ..units import examples, size

#: Most numbers that one page varies
MOST = 3
#: Ratio of the ends from which on points and slider are in equal ratios
_RATIO = 10.0
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eEdD][-+]?\d+)?"


@dataclass(frozen=True)
class Axis:
    """A number that the page varies; `first`, `last` and `values` are in its unit."""

    address: str
    label: str
    #: As it was given; empty for a number without one
    unit: str
    #: SI units in one of it, and its zero in SI units
    factor: float
    offset: float
    first: float
    last: float

    @property
    def is_log(self) -> bool:
        """Whether points are in equal ratios: numbers > 0 over a decade or more."""
        return self.offset == 0 and self.first > 0 and self.last >= _RATIO * self.first

    def values(self, shares: Floats) -> Floats:
        """Values at shares of the range from 0 to 1."""
        if self.is_log:
            return self.first * (self.last / self.first) ** shares
        return self.first + (self.last - self.first) * shares

    def si(self, values: Floats) -> Floats:
        """Values of the unit in SI units."""
        return values * self.factor + self.offset

    def nodes(self, count: int) -> Floats:
        """Values of `count` points from the first to the last, which are exact."""
        found = self.values(np.linspace(0.0, 1.0, count))
        found[-1] = self.last
        return found


def axes_of(case: Case, vary: Mapping[str, str]) -> list[Axis]:
    """Numbers that a page varies, by ranges as `{"impact.temperature": "0C:60C"}` has them.

    Parameters
    ----------
    case
        The case that has the addresses.
    vary
        Range of one to three addresses: two numbers with their unit and a colon between them. The
        unit of the first number may be left out; without any the numbers are in SI units.

    Raises
    ------
    UsageError
        An address is none or no number, or the range is none; the message is one line.
    """
    name = option("vary")
    if not 1 <= len(vary) <= MOST:
        raise UsageError(f"{name}: found {len(vary)} numbers, expected one to {MOST}, such as "
                         "impact.velocity=1m/s:5m/s")  # fmt: skip
    axes = [_axis(case, address, text) for address, text in vary.items()]
    for i, one in enumerate(axes):
        if one.address in [other.address for other in axes[:i]]:
            raise UsageError(f"{name}: found {one.address} twice, expected it once")
    return axes


def _axis(case: Case, address: str, text: str) -> Axis:
    """The axis of ADDRESS=FROM:TO, in the unit that the ends have; refused if it is none."""
    column = case._describe(address)
    si = column.unit
    not_one = UsageError(f"{address}: found a key that is not one number, expected the address of "
                         "a number, such as impact.velocity")  # fmt: skip
    if isinstance(case[address], (str, bool, list)):
        raise not_one
    form = {"K": "0C:60C", "m": "2mm:10mm", "m/s": "1m/s:5m/s", "Pa": "1MPa:5MPa", "1": "0.3:0.5"}
    such = f"{address}={form.get(si, f'1{si}:2{si}')}"
    ends = [re.fullmatch(rf"\s*({_NUMBER})\s*(.*?)\s*", part) for part in text.split(":")]
    if len(ends) != 2 or None in ends:
        raise UsageError(f"{address}={text}: expected a range of two numbers, such as {such}")
    numbers = [float(re.sub("[dD]", "e", end[1])) for end in ends if end]
    units = [end[2] for end in ends if end]
    unit = units[1] or ("" if units[0] or si == "1" else si)
    if units[0] not in ("", unit):
        raise UsageError(f"{address}={text}: found two units, expected one, such as {such}")
    sizes = size(unit or "1", si)
    if sizes is None:
        raise UsageError(f"{address}={text}: unknown unit '{unit}', expected one such as "
                         f"{examples(si)}")  # fmt: skip
    first, last = numbers
    if not (math.isfinite(first) and math.isfinite(last) and first < last):
        raise UsageError(f"{address}={text}: found {first:g} to {last:g}, expected a range from "
                         f"the smaller to the larger number, such as {such}")  # fmt: skip
    trial = case.copy()
    trial[address] = first * sizes[0] + sizes[1]
    if not isinstance(trial[address], float):
        raise not_one
    label = re.split("[;,]", column.meaning)[0]
    group = column.name.rpartition(".")[0]
    if group != "impact":
        label = f"{group.capitalize().replace('_', ' ')}: {label[:1].lower()}{label[1:]}"
    shown = "" if unit in ("", "1", "-") else {"C": "°C", "F": "°F"}.get(unit, unit)
    return Axis(column.name, label, shown, *sizes, first, last)
