"""Coefficient of restitution of viscoelastic spheres and plates.

All numbers are in SI units; results are `xarray.Dataset` objects with units in their attributes.
"""

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
    "fit",
    "open",
    "read",
]
