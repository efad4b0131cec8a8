"""Arguments of calls and values of a case: checked, and as a case file has them."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._library import Floats, InputError, UsageError, encoded, numbers, whole

Value = bool | int | float | str | Sequence[float]
Groups = Mapping[str, Mapping[str, Any] | Sequence[Mapping[str, Any]]]

#: Most threads and points, as the program has them
_MOST_THREADS, MOST_POINTS = 1024, 100_000_000


def namelists(groups: Groups) -> str:
    """Text of a case from its groups."""
    lines: list[str] = []
    for group, items in groups.items():
        one = isinstance(items, (str, Mapping)) or not np.iterable(items)
        for item in [items] if one else items:
            if not isinstance(item, Mapping):
                raise InputError(f"&{group}: found {item!r:.60}, expected the keys of a group and "
                                 "their values, or a list of such groups")  # fmt: skip
            lines.append(f"&{_name(group)}")
            lines += [f"   {_name(key)} = {written(value, f'{group}.{key}')}"
                      for key, value in item.items()]  # fmt: skip
            lines.append("/")
    return "\n".join(lines) + "\n"


def _name(key: str) -> str:
    """Name of a group or a key; nothing that would read as more than that."""
    if not isinstance(key, str) or not re.fullmatch(r"\w+(\([\d:]*\))?", key, re.ASCII):
        raise InputError(f"found {key!r:.60}, expected the name of a group or a key: letters, "
                         "digits and underscores")  # fmt: skip
    return key


def written(value: Any, name: str) -> str:
    """A value as a namelist has it; `name` is what is given it."""
    if isinstance(value, str):
        return "'" + value.replace("'", "''") + "'"
    if isinstance(value, (bool, np.bool_)):
        return ".true." if value else ".false."
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    found = numbers(value, name, expected="a text, True, False, or numbers in one dimension")
    return ", ".join(map(repr, np.atleast_1d(found).tolist()))


def value_of(text: str) -> Value:
    """A value from a namelist."""
    if text.startswith("'"):
        return text[1:-1].replace("''", "'")
    if text in (".true.", ".false."):
        return text == ".true."
    numbers = [float(word) for word in text.replace(",", " ").split()]
    # the library writes a list of one number with a comma
    if "," in text or len(numbers) != 1:
        return numbers
    return int(text) if text.lstrip("+-").isdigit() else numbers[0]


def arrays(values: Mapping[str, ArrayLike], *expected: Any) -> dict[str, Floats]:
    """Columns of numbers, each as an array of one dimension."""
    if not hasattr(values, "items") or not len(values.keys()):
        raise InputError("expected at least one column of numbers, by its address or name")
    for name in values.keys():  # noqa: SIM118  (those of a Series are no values)
        encoded(name)
    return {name: np.atleast_1d(numbers(given, name, *expected)) for name, given in values.items()}


def scalars(values: Mapping[str, float] | None) -> dict[str, float]:
    """Numbers by their addresses or names; None: none."""
    if values is None or isinstance(values, Mapping) and not values:
        return {}
    return {name: float(one[0]) for name, one in arrays(values, 0, "a number").items()}


def threads_of(given: int | None) -> int:
    """Number of threads; None: what SLURM gives, or 0 for those that the library takes."""
    if given is not None:
        return whole(given, "threads", 1, _MOST_THREADS)
    name = "SLURM_CPUS_PER_TASK"
    word = os.environ.get(name, "").strip()
    if word and not word.isdecimal():
        raise UsageError(f"{name}: found '{word:.60}', expected a whole number from 1 "
                         f"to {_MOST_THREADS}")  # fmt: skip
    return whole(int(word), name, 1, _MOST_THREADS) if word else 0


def names_of(quantities: Sequence[str] | None) -> list[str]:
    """Names of columns; None: all."""
    return listed(list(_library.columns(0)) if quantities is None else quantities)


def listed(names: Any) -> list[Any]:
    """Names as a list; a text is one."""
    return [names] if isinstance(names, str) or not np.iterable(names) else list(names)
