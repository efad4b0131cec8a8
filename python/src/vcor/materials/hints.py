"""Which quantity a column may be whose name is not known, for messages."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence

from ..units import quantities_of
from .names import CUES, Head, is_function, plain

#: By SI unit: what a column of a table of impacts may be
_OF_IMPACTS = {
    "m": ["drop_height", "rebound_height", "diameter", "radius", "plate.thickness",
          "max_indentation"],
    "m/s": ["velocity", "rebound_velocity"],
    "s": ["contact_time", "bounce_time", "event_time"],
    "1": ["cor", "resilience"],
    "N": ["max_force"],
    "K": ["temperature"],
    "kg": ["mass"],
}  # fmt: skip
#: Quantities of which a table of impacts has one at most
_ONE_OF = (
    {"drop_height", "velocity"},
    {"rebound_height", "rebound_velocity"},
    {"radius", "diameter"},
    {"bounce_time", "event_time"},
)


def of_impacts(head: Head, names: Collection[str]) -> list[str]:
    """Names that a column beside others may have, the likeliest first; empty: unknown."""
    units = quantities_of(head.unit) if head.unit else list(_OF_IMPACTS)
    may = [name for unit in units for name in _OF_IMPACTS.get(unit, [])]
    there = {*names}.union(*(pair for pair in _ONE_OF if pair & {*names}))
    return _likely(head, may, there, sure=not head.unit)


def of_moduli(head: Head, may: Sequence[str], names: Collection[str]) -> list[str]:
    """Which of some moduli, times or frequencies a column may be."""
    return _likely(head, may, names)


def _likely(
    head: Head, may: Sequence[str], there: Collection[str], *, sure: bool = False
) -> list[str]:
    """Quantities by the words of a name; all that are not there if no word tells."""
    if is_other(head):
        return []
    by_word = [name for name in may if _says(head, CUES.get(name, []))]
    return [name for name in (by_word if by_word or sure else may) if name not in there]


def is_other(head: Head) -> bool:
    """Whether a name says that a column is no quantity that is known."""
    return is_function(head.text) or _says(head, CUES["other"])


def _says(head: Head, cues: Sequence[str]) -> bool:
    """Whether one of some words stands in a name."""
    bare = re.sub(r"\s*[\[(][^\[\]()]*[\])]\s*$", "", head.text.strip())
    text = " ".join(["", *re.findall(r"[^\W_]+", plain(bare)), ""])
    return any(f" {cue[:-1]} " in text if cue.endswith(".") else f" {cue}" in text for cue in cues)
