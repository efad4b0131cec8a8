"""Sources of figures: files of results, materials, and sweeps in memory."""

from __future__ import annotations

import contextlib
import math
import os
from pathlib import Path

import h5py
import numpy as np
import xarray as xr

from ._library import Error, InputError, UsageError, printable
from ._text import near, values_of
from .case import Case, number
from .material_files import material_case
from .results import open as open_results
from .results import read_group
from .units import ZERO_C

Source = str | os.PathLike[str] | xr.Dataset | Case


class Result:
    """Results of a file, of a case that is solved, of a sweep, or materials of a file."""

    def __init__(self, source: Source, *, celsius: bool = False) -> None:
        """Open a file, or take a Dataset or a case, which is solved.

        Temperatures are in C where `celsius`, else in K. FileError or InputError: a file that
        cannot be read, or has no results.
        """
        self._held: dict[str, xr.Dataset] = {}
        self.groups: set[str] = set()
        if isinstance(source, xr.Dataset):
            self.path, self.summary = "sweep", source
        elif isinstance(source, Case):
            self.path, self.summary = "case", source.run()
            if not self.summary.dims:
                self._held["history"] = source.history()
        else:
            self.path = os.fspath(source)
        if self.path.endswith(".nml"):
            self.summary, self._held = xr.Dataset(), _moduli_of(self.path)
        self.groups |= set(self._held)
        if not isinstance(source, (xr.Dataset, Case)) and not self._held:
            self.summary = open_results(source)
            with h5py.File(self.path, "r") as file:
                self.groups |= set(file)
        self.summary = _in_celsius(self.summary) if celsius else self.summary
        self.axes = [str(dim) for dim in self.summary.dims if str(dim) != "material"]
        self.case = str(self.summary.attrs.get("case", ""))
        #: Its label in a legend
        self.text = ""
        self.title = printable(str(self.summary.attrs.get("title", "")))

    def group(self, name: str, what: str, *columns: str) -> xr.Dataset:
        """A group of the file with some columns; refused if there is none."""
        if name not in self.groups:
            raise InputError(f"{self.path}: there is no {what} in this file")
        found = self._held[name] if self._held else read_group(self.path, name)
        for column in columns:
            if column not in found:
                raise InputError(f"{self.path}: there is no '{column}' in '{name}' of this file")
        return found

    def kind(self) -> str:
        """Kind of figure that the file is for."""
        for group, kind in (("relaxation", "moduli"), ("history", "history")):
            if group in self.groups:
                return kind
        if self.axes:
            return "map" if len(self.axes) == 2 else "sweep"
        raise InputError(
            f"{self.path}: there is a single impact without a time history in this file, of which "
            "no figure is made; run it with output.history = .true."
        )

    def number(self, name: str) -> float:
        """A number of the summary of a single impact, nan if it is not there."""
        return float(self.summary[name]) if name in self.summary else math.nan

    def column(self, name: str) -> xr.DataArray:
        """A quantity of a sweep."""
        numeric = [str(n) for n, v in self.summary.data_vars.items() if v.dtype.kind in "fi"]
        if name not in numeric:
            known = f"{', '.join(numeric)}{near(name, numeric)}"
            raise UsageError(f"{self.path}: found no quantity '{name}', expected one of {known}")
        if not np.isfinite(self.summary[name]).any():
            raise InputError(f"{self.path}: '{name}' has no value at any point of this sweep")
        return self.summary[name]


def is_temperature(name: str) -> bool:
    """Whether a quantity or an address is a temperature, which figures may show in °C."""
    return "temperature" in name.rpartition(".")[2]


def _in_celsius(data: xr.Dataset) -> xr.Dataset:
    """The same with swept temperatures in degrees Celsius."""
    swept = {name: at for name, at in data.coords.items() if is_temperature(str(name))}
    return data.assign_coords(
        {name: (at - ZERO_C).round(9).assign_attrs(units="°C") for name, at in swept.items()}
    )


def _moduli_of(path: str) -> dict[str, xr.Dataset]:
    """Moduli of the materials of a case, or of &material groups alone such as `vcor fit` writes."""
    case, names, _ = material_case(path)
    relaxation, dynamic = [], []
    for name in names:
        address = name.replace(" ", "_")
        first, last = (number(case, f"{address}.valid_{end}") for end in ("from", "to"))
        if math.isnan(first + last):
            continue
        time = np.geomspace(first, last, 200)
        material, frequency = case.material(name), 1.0 / time[::-1]
        modulus = material.complex_modulus(frequency)
        columns = {"storage_modulus": modulus.real, "loss_modulus": modulus.imag,
                   "loss_tangent": modulus.imag / modulus.real}  # fmt: skip
        relaxation.append(xr.Dataset({"relaxation_modulus": ("time", material.relaxation(time))},
                                     {"time": time, "material": name}))  # fmt: skip
        dynamic.append(xr.Dataset({key: ("frequency", one) for key, one in columns.items()},
                                  {"frequency": frequency, "material": name}))  # fmt: skip
    if not relaxation:
        raise InputError(
            f"{path}: no material has valid_from and valid_to, between which its moduli are drawn; "
            "draw the file that vcor material makes, or of impacts the results of vcor run, a .h5"
        )
    both = {"relaxation": relaxation, "dynamic": dynamic}
    return {key: xr.concat(some, "material", join="outer") for key, some in both.items()}


def is_result(source: Source) -> bool:
    """Whether a source is results or materials, and no file of measured points."""
    return isinstance(source, (xr.Dataset, Case)) or os.fspath(source).endswith((".h5", ".nml"))


def legends_of(results: list[Result]) -> list[str]:
    """Texts of the legend: titles, or up to three values in which the cases differ, or names."""
    titles = [result.title for result in results]
    if all(titles) and len(set(titles)) == len(titles):
        return titles
    lines = [map(printable, result.case.splitlines()) for result in results]
    values = [values_of("\n".join(case)) for case in lines]
    keys = [key for key in values[0] if len({one.get(key) for one in values}) > 1]
    keys = [key for key in keys if not key.startswith(("case.", "output."))]
    if 0 < len(keys) <= 3:
        units = {}
        for key in keys:
            with contextlib.suppress(Error):
                unit = Case(results[0].case, name=results[0].path)._describe(key).unit
                units[key] = {"1": "", "1/s": "s⁻¹"}.get(unit, unit)
        names = {key: key.rpartition(".")[2].replace("_", " ") for key in keys}
        words = [", ".join(f"{name} = {_short(one[key])} {units.get(key, '')}".strip()
                           for key, name in names.items() if key in one)
                 for one in values]  # fmt: skip
        if len(set(words)) == len(words):
            return words
    return [printable(Path(result.path).stem) for result in results]


def _short(value: str) -> str:
    """A value of a case as a figure shows it, numbers with five digits."""
    with contextlib.suppress(ValueError):
        return f"{float(value):.5g}"
    return value
