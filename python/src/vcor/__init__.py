"""Coefficient of restitution of viscoelastic spheres and plates.

All numbers are in SI units; results are `xarray.Dataset` objects with units in their attributes.
"""

import importlib
from typing import TYPE_CHECKING, Any

from ._library import (
    Error,
    FileError,
    InputError,
    NoResultWarning,
    NumericalError,
    UsageError,
    __version__,
)
from .case import Case, Material, read
from .fit import Fit, fit
from .results import open  # noqa: A004  (vcor.open reads as vcor.read does)

if TYPE_CHECKING:
    from .cards import card, read_card
    from .exchange import export, pair
    from .identification import identify
    from .master_curve import master
    from .uncertainty import propagate, sensitivities

__all__ = [
    "Case",
    "Error",
    "FileError",
    "Fit",
    "InputError",
    "Material",
    "NoResultWarning",
    "NumericalError",
    "UsageError",
    "__version__",
    "card",
    "export",
    "fit",
    "identify",
    "master",
    "open",
    "pair",
    "propagate",
    "read",
    "read_card",
    "sensitivities",
]

# Messages of the interpreter name an error as users import it
for _kind in (Error, FileError, InputError, NoResultWarning, NumericalError, UsageError):
    _kind.__module__ = "vcor"

#: What needs scipy, by its module; imported when it is used
_LATER = {
    "card": "cards",
    "export": "exchange",
    "identify": "identification",
    "master": "master_curve",
    "pair": "exchange",
    "propagate": "uncertainty",
    "read_card": "cards",
    "sensitivities": "uncertainty",
}


def __getattr__(name: str) -> Any:
    if name not in _LATER:
        raise AttributeError(f"module 'vcor' has no attribute '{name}'")
    found = getattr(importlib.import_module(f"vcor.{_LATER[name]}"), name)
    globals()[name] = found
    return found
