"""Identification of a material from measured moduli."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from ctypes import c_char_p
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _library
from .._library import InputError, numbers, whole, within
from ..case import scalars

#: Poisson's ratio that says that there is none
NOT_GIVEN = 1.0
#: Most terms of a Prony series, as the program has them
_MOST_TERMS = 60


def ratio_of(poisson_ratio: float | None) -> float:
    """Poisson's ratio as the library takes it, checked."""
    return NOT_GIVEN if poisson_ratio is None else within(poisson_ratio, "--poisson-ratio", -1, 0.5)


@dataclass(frozen=True)
class Parameter:
    """A parameter of a fit, in SI units."""

    name: str
    unit: str
    value: float
    #: Standard error; 0 if the value was given
    error: float
    #: free, fixed (given) or bound (at the end of its range)
    state: str


@dataclass(frozen=True)
class Fit:
    """A material that was found in data."""

    #: Parameters; moduli and times of a Prony series alternate, the fastest term first
    parameters: tuple[Parameter, ...]
    #: The material as a &material group, to be put into a case
    group: str
    #: Root of the mean square of the relative misfits
    rms: float
    #: Whether the model follows the data: the misfits are noise
    follows: bool
    #: Covariance of the parameters, in their units; 0 of what is given
    covariance: _library.Floats = field(repr=False)
    _document: dict[str, Any] = field(repr=False)

    def __getitem__(self, name: str) -> float | list[float]:
        """Value of a parameter, a list for the terms of a series."""
        values = [one.value for one in self.parameters if one.name == name]
        if not values:
            raise KeyError(name)
        return values if name in ("moduli", "times") else values[0]

    def as_dict(self) -> dict[str, Any]:
        """All results, as `vcor fit --json` writes them."""
        return self._document

    def __str__(self) -> str:
        return self.group


def fit(
    data: str | os.PathLike[str] | Sequence[ArrayLike],
    *,
    model: str = "prony",
    terms: int | None = None,
    fix: Mapping[str, float] | None = None,
    poisson_ratio: float | None = None,
    density: float | None = None,
    name: str | None = None,
) -> Fit:
    """Fit a model to relaxation moduli, or to storage and loss moduli, as `vcor fit` does.

    Parameters
    ----------
    data
        A data file as `vcor fit` reads it, units and kind by its header; or arrays: times [s] and
        relaxation moduli [Pa], or angular frequencies [rad/s], storage and loss moduli [Pa], each
        of shape (n,).
    model
        Model of the relaxation modulus.
    terms
        Terms of a Prony series; None: as many as the data support.
    fix
        Parameters of the model that have a given value, in SI units.
    poisson_ratio
        Poisson's ratio; None: 0.5. Needed for a file of shear moduli.
    density
        Density [kg/m3], for the group of the result.
    name
        Name of the material; None: that of the file.

    Returns
    -------
    Fit
        Parameters with standard errors, and the material as a group of a case.

    Raises
    ------
    FileError
        The file cannot be read.
    InputError
        The data cannot be fitted.
    NumericalError
        The fit fails, or the data do not determine the parameters.
    """
    fixed = scalars(fix)
    file: bytes | c_char_p = c_char_p()
    samples = np.empty((0, 0))
    if isinstance(data, (str, os.PathLike)):
        file = os.fsencode(data)
        name = name or Path(data).stem
    else:
        parts = data if np.iterable(data) else []
        columns = [numbers(part, "data", np.inf, "numbers").ravel() for part in parts]
        if len({len(column) for column in columns}) == 1:
            samples = np.array(columns)
        if len(samples) not in (2, 3) or not ((samples >= 1e-30) & (samples <= 1e30)).all():
            raise InputError(
                "expected two or three arrays of one length with numbers > 0, from 1e-30 to 1e30: "
                "times and moduli, or angular frequencies, storage and loss moduli"
            )
        samples = np.ascontiguousarray(samples[:, np.argsort(samples[0], kind="stable")])
    given = len(fixed), _library.texts(tuple(fixed)), np.array([*fixed.values()], dtype=float)
    count = 0 if terms is None else whole(terms, "terms", 1, _MOST_TERMS)
    rho = 0.0 if density is None else within(density, "density", 0, 1e30)
    wish = (model, name or "material", count, *given, ratio_of(poisson_ratio), rho)
    document = _library.text_of("vcor_fit_data", file, *samples.shape[::-1], samples, *wish)
    found = json.loads(document or "")
    parameters = tuple(
        Parameter(one["name"].partition("(")[0], *list(one.values())[1:])
        for one in found["parameters"]
    )
    covariance = np.array(found["covariance"], dtype=float)
    return Fit(parameters, found["group"], found["rms_misfit"], found["follows"], covariance, found)
