"""Programs of particles and bodies that take a coefficient of restitution."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import _text

TEMPLATES = Path(__file__).with_name("templates")


@dataclass(frozen=True)
class Target:
    """A program that takes e: an entry of templates/programs.toml."""

    name: str
    files: Sequence[str]
    laws: Sequence[Mapping[str, Any]] = ()
    notes: Sequence[str] = ()
    run: str = ""
    #: How it takes pairs of several types: the law of each ("pairs"), its e with a modulus of each
    #: type ("types"), a table of all ("table"); else why it does not
    mixture: str = ""


_PROGRAMS = tomllib.loads(_text.read_text(TEMPLATES / "programs.toml"))
TARGETS = {name: Target(name, **keys) for name, keys in _PROGRAMS.items()}
