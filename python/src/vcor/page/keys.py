"""The catalogue of groups and keys for a form: what a value is, and its unit in a laboratory."""

from __future__ import annotations

import functools
import json
import re
from collections.abc import Iterator
from ctypes import byref, c_void_p
from dataclasses import dataclass, field
from decimal import Decimal, DecimalException
from typing import Any

from .. import _library
from .._library import UsageError
from ..case import Case
from ..units import examples, size

#: Units of a laboratory by SI unit; all others are SI units
_USUAL = {"m": "mm", "K": "C", "Pa": "MPa", "kg": "g"}
_NUMBER = re.compile(r"([-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eEdD][-+]?\d+)?)\s*(.*)", re.S)
#: Powers of ten of numbers that are written without an exponent
_PLAIN = -5, 9


@dataclass(frozen=True)
class Key:
    """A key of the catalogue, as `vcor help --json` describes it."""

    group: str
    name: str
    #: real, integer, logical, text or list
    type: str
    meaning: str
    unit: str
    range: str
    #: Words that it may have, and what they mean
    choices: tuple[str, ...]
    meanings: dict[str, str] = field(hash=False)
    #: Choices of the selector of its group that have it; empty: all
    models: tuple[str, ...] = ()
    required: bool = False

    @property
    def is_file(self) -> bool:
        """Whether it names a file of the machine, which a page neither asks for nor reads."""
        return self.name.endswith("file")

    @property
    def usual(self) -> str:
        """The unit in which a page shows it."""
        return _USUAL.get(self.unit, self.unit)

    @property
    def label(self) -> str:
        """Its name in words, with its unit."""
        words = self.name.replace("_", " ").replace("wlf", "WLF")
        unit = {"C": "°C", "1": "", "-": ""}.get(self.usual, self.usual)
        return words[:1].upper() + words[1:] + f" [{unit}]" * bool(unit)

    def shown(self, value: Any) -> str:
        """A value of a case as the page shows it, in the usual unit."""
        if value is None:
            return ""
        if isinstance(value, (bool, str)):
            return str(value)
        if isinstance(value, list):
            return ", ".join(self.shown(one) for one in value)
        return self._number(value)

    def _number(self, value: float) -> str:
        """A number in the usual unit of the key, without rounding."""
        factor, offset = _decimals(self.usual, self.unit)
        found = (Decimal(repr(value)) - offset) / factor
        found = found.normalize()
        if _PLAIN[0] <= found.adjusted() <= _PLAIN[1]:
            return f"{found:f}"
        return f"{found:.{len(found.as_tuple().digits) - 1}e}"

    def written(self, text: str) -> str:
        """A text of a user in SI units, as a namelist has it.

        A number may have a unit of its own. What is no number is left as it is: the library says
        what it expects.

        Raises
        ------
        UsageError
            The unit is none of this quantity.
        """
        if self.type == "list":
            return ", ".join(self._si(one) for one in re.split(r"[,;\s]+(?=[-+.\d])", text))
        if self.type == "real":
            return self._si(text.strip())
        return text

    def _si(self, text: str) -> str:
        """A number in SI units as a namelist has it; a text that is no number stays as it is.

        UsageError: a unit of another quantity.
        """
        found = _NUMBER.fullmatch(text)
        if found is None:
            return text
        unit = found[2].strip()
        if unit and (not self.unit or size(unit, self.unit) is None):
            if not re.fullmatch(r"[\w%°µ/*^.\- ]+", unit):
                return text
            expected = examples(self.unit) if self.unit else "a number without one"
            raise UsageError(f"{self.group}.{self.name}: found the unit '{unit:.40}', expected "
                             f"{expected}")  # fmt: skip
        factor, offset = _decimals(unit or self.usual, self.unit)
        try:
            value = Decimal(re.sub("[dD]", "e", found[1].replace(",", "."))) * factor + offset
        except DecimalException:
            return text
        # the nearest number to what was typed, so that 12.3 mm are 0.0123 m
        return repr(float(value))


@dataclass(frozen=True)
class Group:
    """A group of the catalogue."""

    name: str
    meaning: str
    repeated: bool
    #: Key that decides which others there are; empty: none
    selector: str
    keys: tuple[Key, ...]

    def key(self, name: str, model: str | None = None) -> Key | None:
        """Key of a name, that of a choice of the selector where there are several."""
        found = [one for one in self.keys if one.name == name]
        fits = [one for one in found if not one.models or model is None or model in one.models]
        return fits[0] if fits else None

    def keys_of(self, model: str | None) -> Iterator[Key]:
        """Keys that a choice of the selector has."""
        for key in self.keys:
            if not key.models or model in key.models:
                yield key


@functools.cache
def groups() -> dict[str, Group]:
    """The catalogue by the names of its groups."""
    pointer = c_void_p()
    _library.call("vcor_catalogue", byref(pointer))
    made = {}
    for one in json.loads(_library.take_text(pointer) or "[]"):
        keys = tuple(
            Key(
                one["name"], key["name"], key["type"], key["meaning"], key["unit"], key["range"],
                tuple(key["choices"]), {word["word"]: word["meaning"] for word in key["meanings"]},
                tuple(key["models"]), key["required"],
            )
            for key in one["keys"]
        )  # fmt: skip
        made[one["name"]] = Group(
            one["name"], one["meaning"], one["repeated"], one["selector"], keys
        )
    return made


def key_of(case: Case, address: str) -> Key:
    """Key at an address of a case, without the place in a list."""
    owner, _, name = address.partition("(")[0].rpartition(".")
    group = groups().get(owner) or groups()["material"]
    model = case[f"{owner}.{group.selector}"] if group.selector else None
    found = group.key(name, None if model is None else str(model)) or group.key(name)
    if found is None:
        raise UsageError(f"{address}: unknown key '{name}'")
    return found


def _decimals(unit: str, si: str) -> tuple[Decimal, Decimal]:
    """Factor and offset of a unit as they are written, not as they are rounded."""
    factor, offset = (size(unit, si) if si else None) or (1.0, 0.0)
    return Decimal(repr(factor)), Decimal(repr(offset))
