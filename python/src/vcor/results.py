"""Results of the program."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import xarray as xr

from ._library import FileError, InputError, is_altered

#: How files of HDF5 begin
_HDF5 = b"\x89HDF\r\n\x1a\n"


def open(path: str | os.PathLike[str], group: str = "summary") -> xr.Dataset:  # noqa: A001
    """Read a file of results, STEM.h5.

    Parameters
    ----------
    path
        The HDF5 file of `vcor run` or `vcor material`.
    group
        `summary` (a value per impact or material), `history` (over time, of a single impact), or
        `relaxation` and `dynamic` (moduli, of `vcor material`).

    Returns
    -------
    xarray.Dataset
        As `Case.run` and `Case.history` give it: units in the attributes of each variable, version,
        title and case in those of the whole.

    Raises
    ------
    FileError
        The file cannot be read, or it is damaged.
    InputError
        It is no HDF5 file, or has no such group.
    """
    path = os.fspath(path)
    _check(path)
    try:
        # A file without dimension scales, which is none of vcor's, is for its readers to refuse
        options: dict[str, Any] = {"engine": "h5netcdf", "phony_dims": "access"}
        with xr.open_dataset(path, **options) as root:
            attrs = dict(root.attrs)
        with xr.open_dataset(path, group=group, **options) as data:
            result = data.load()
    except (KeyError, OSError, ValueError, TypeError, RuntimeError, AttributeError) as error:
        if isinstance(error, KeyError) or "group not found" in str(error):
            raise InputError(f"{path}: there is no group '{group}' of vcor in this file") from error
        raise FileError(f"{path}: this file cannot be read: {error}") from None
    if "impact" in result.dims:
        result = result.isel(impact=0, drop=True)
    return result.assign_attrs(attrs | dict(result.attrs))


def _check(path: str) -> None:
    """Refuse what is no HDF5 file, or damaged: some damage lets HDF5 crash."""
    try:
        if Path(path).exists() and not Path(path).is_file():
            raise FileError(f"{path}: found a folder or a device, expected a file of results")
        with Path(path).open("rb") as file:
            if file.read(len(_HDF5)) != _HDF5:
                raise InputError(f"{path}: this is no HDF5 file")
        if is_altered(path):
            raise FileError(f"{path}: this file is damaged: its check sum is wrong")
    except FileNotFoundError:
        raise FileError(f"{path}: there is no such file") from None
    except OSError as error:
        if isinstance(error, FileError):
            raise
        raise FileError(f"{path}: {error.strerror}") from None
