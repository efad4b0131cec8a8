"""Identification of a material from measured moduli."""

from __future__ import annotations

import ctypes
import json
import os
from collections.abc import Mapping, Sequence
from ctypes import Structure, c_char_p, c_double, c_int, c_void_p
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _library
from ._library import InputError

#: Poisson's ratio that says that there is none
_NOT_GIVEN = 1.0


class _Fit(Structure):
    """`c_fit_t` of src/vcor/fit/c_api.f90."""

    _fields_ = [
        *[(name, c_char_p) for name in ("file", "model", "name")],
        *[(name, c_int) for name in ("terms", "dynamic", "n", "fixed_count")],
        *[(name, c_void_p) for name in ("at", "modulus", "loss")],
        ("fixed_names", c_char_p),
        ("fixed_values", c_void_p),
        *[(name, c_double) for name in ("poisson_ratio", "density")],
        ("json", c_void_p),
    ]


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
    fix = fix or {}
    fixed = np.array([float(value) for value in fix.values()])
    wish = _Fit(
        model=model.encode(),
        terms=terms or 0,
        fixed_count=len(fix),
        fixed_names=" ".join(fix).encode(),
        fixed_values=fixed.ctypes.data,
        poisson_ratio=_NOT_GIVEN if poisson_ratio is None else poisson_ratio,
        density=density or 0.0,
    )
    if isinstance(data, (str, os.PathLike)):
        wish.file = os.fsencode(data)
        name = name or Path(data).stem
        arrays = np.empty((0, 0))
    else:
        arrays = np.array([np.ravel(np.asarray(column, dtype=float)) for column in data])
        if len(arrays) not in (2, 3) or not (np.isfinite(arrays) & (arrays > 0)).all():
            raise InputError(
                "expected two or three arrays of one length with numbers > 0: times and moduli, "
                "or angular frequencies, storage and loss moduli"
            )
        arrays = np.ascontiguousarray(arrays[:, np.argsort(arrays[0], kind="stable")])
        wish.n, wish.dynamic = arrays.shape[1], len(arrays) == 3
        wish.at, wish.modulus, wish.loss = (row.ctypes.data for row in (*arrays, arrays[-1])[:3])
    wish.name = (name or "material").encode()
    _library.call("vcor_fit_data", ctypes.addressof(wish))
    found = json.loads(_library.take_text(c_void_p(wish.json)) or "")
    parameters = tuple(
        Parameter(one["name"].partition("(")[0], *list(one.values())[1:])
        for one in found["parameters"]
    )
    covariance = np.array(found["covariance"], dtype=float)
    return Fit(parameters, found["group"], found["rms_misfit"], found["follows"], covariance, found)


def read_moduli(
    path: str | os.PathLike[str], poisson_ratio: float | None = None
) -> dict[str, _library.Floats]:
    """Read a data file of moduli as `vcor fit` does, units and kind by its header.

    Parameters
    ----------
    path
        The file: columns, or the export of an instrument.
    poisson_ratio
        Poisson's ratio, for a file of shear moduli.

    Returns
    -------
    dict
        `time` [s] and `relaxation_modulus` [Pa], or `frequency` [rad/s], `storage_modulus` and
        `loss_modulus` [Pa], of shape (n,), rising.
    """
    n, dynamic, values = c_int(), c_int(), c_void_p()
    ratio = _NOT_GIVEN if poisson_ratio is None else poisson_ratio
    results = map(ctypes.byref, (n, dynamic, values))
    _library.call("vcor_read_moduli", os.fsencode(path), ratio, *results)
    names = ["frequency", "storage_modulus", "loss_modulus"]
    names = names if dynamic else ["time", "relaxation_modulus"]
    table = _library.take_numbers(values, len(names) * n.value).reshape(len(names), -1)
    return dict(zip(names, table, strict=True))
