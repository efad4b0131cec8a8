"""Results of the program."""

from __future__ import annotations

import os

import xarray as xr

from ._library import FileError, InputError


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
        The file cannot be read.
    InputError
        It has no such group.
    """
    path = os.fspath(path)
    try:
        with xr.open_dataset(path, engine="h5netcdf") as root:
            attrs = dict(root.attrs)
        with xr.open_dataset(path, engine="h5netcdf", group=group) as data:
            result = data.load()
    except FileNotFoundError:
        raise FileError(f"{path}: there is no such file") from None
    except (KeyError, OSError) as error:
        kind = InputError if "unable to open" not in str(error).lower() else FileError
        raise kind(f"{path}: there is no group '{group}' of vcor in this file") from error
    if "impact" in result.dims:
        result = result.isel(impact=0, drop=True)
    return result.assign_attrs(attrs | dict(result.attrs))
