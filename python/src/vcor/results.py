"""Results of the program."""

from __future__ import annotations

import faulthandler
import os
import resource
import signal
import tempfile
import warnings
from collections.abc import Iterator
from pathlib import Path

import h5py
import numpy as np
import xarray as xr

from ._coverage import of_columns
from ._library import Error, FileError, InputError

#: How files of HDF5 begin
_HDF5 = b"\x89HDF\r\n\x1a\n"
#: Processor time in which HDF5 reads any file [s], and what it reads in a second more [bytes]
_PATIENCE, _PACE = 5, 50_000_000
#: Largest ratio by which the filters of HDF5 make data smaller (deflate)
_DEFLATE = 1032
#: Attributes of dimension scales
_OF_SCALES = {"CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST"}


def open(path: str | os.PathLike[str], group: str = "summary") -> xr.Dataset:  # noqa: A001
    """Read a file of results, STEM.h5.

    Parameters
    ----------
    path
        The HDF5 file of `vcor run` or `vcor material`.
    group
        `summary` (a value per impact or material), `history` (over time, of a single impact),
        `bounces` (one after the other, with `impact.bounces`), or `relaxation` and `dynamic`
        (moduli, of `vcor material`).

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
    return read_group(path, group)


def read_group(path: str, group: str) -> xr.Dataset:
    """A group of a file that `open` has read before, and need not check for damage once more."""
    try:
        with h5py.File(path, "r") as file:
            attrs, found = dict(file.attrs), file.get(group)
            if not isinstance(found, h5py.Group):
                raise InputError(f"{path}: there is no group '{group}' of vcor in this file")
            columns = {name: _column(one) for name, one in found.items()
                       if isinstance(one, h5py.Dataset)}  # fmt: skip
            axes = {name: columns.pop(name) for name in list(columns) if _is_scale(found[name])}
            result = xr.Dataset(columns, axes, dict(found.attrs))
    except Error:
        raise
    except (
        KeyError, OSError, ValueError, TypeError, RuntimeError, AttributeError, MemoryError,
    ) as error:  # fmt: skip
        raise FileError(f"{path}: this file cannot be read: {error}") from None
    if len(shapes := {one.dims for one in result.data_vars.values()}) > 1:
        found = " and ".join(str(one) for one in sorted(shapes))
        raise FileError(f"{path}: this file is damaged: the columns of '{group}' have dimensions "
                        f"{found}, expected the same of all")  # fmt: skip
    if "impact" in result.dims:
        result = result.isel(impact=0, drop=True)
    attrs |= of_columns(result.data_vars)
    return result.assign_attrs(attrs | dict(result.attrs))


def _column(one: h5py.Dataset) -> xr.Variable:
    """A column along its dimension scales, or alone along dimensions of its own shape."""
    attrs = {name: text for name, text in one.attrs.items() if name not in _OF_SCALES}
    if _is_scale(one):
        dims = [_name(one)]
    else:
        dims = [_name(scales[0]) if len(scales) else f"{size} values"
                for scales, size in zip(one.dims, one.shape, strict=True)]  # fmt: skip
    if h5py.check_string_dtype(one.dtype):
        return xr.Variable(dims, np.asarray(one.asstr()[()], dtype=str), attrs)
    return xr.Variable(dims, one[()], attrs)


def _is_scale(one: h5py.Dataset) -> bool:
    """Whether a dataset is the scale of a dimension."""
    # h5py of Debian 12 has no property for it
    return bool(h5py.h5ds.is_scale(one.id))


def _name(one: h5py.Dataset) -> str:
    """Name of a dataset in its group."""
    return str(one.name).rpartition("/")[2]


def as_csv(data: xr.Dataset) -> str:
    """Results over one address as the program writes them to CSV."""
    columns = [*data.coords.values(), *data.data_vars.values()]
    units = [f" [{one.attrs['units']}]" if "units" in one.attrs else "" for one in columns]
    head = [
        f"vcor {data.attrs['version']}", f"title: {data.attrs['title']}",
        *(f"samples: {data.attrs['samples']}" for _ in [0] if "samples" in data.attrs),
        "columns:",
        *(f"  {one.name}{unit} {one.attrs['long_name']}"
          for one, unit in zip(columns, units, strict=True)),
        "case:", *data.attrs["case"].splitlines(),
    ]  # fmt: skip
    cells = [[f"{one:.17g}" if one.dtype.kind == "f" else str(one) for one in column.values]
             for column in columns]  # fmt: skip
    rows = [[str(one.name) for one in columns], *zip(*cells, strict=True)]
    return "".join(f"# {line}\n" for line in head) + "".join(f"{','.join(row)}\n" for row in rows)


def as_hdf5(data: xr.Dataset) -> bytes:
    """Results as `open` reads them."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "results.h5"
        data.drop_attrs(deep=False).to_netcdf(path, group="summary", engine="h5netcdf")
        with h5py.File(path, "r+") as file:
            file.attrs.update(data.attrs)
        return path.read_bytes()


def _check(path: str) -> None:
    """Refuse what is no HDF5 file, damaged, or leads to other files: some damage stops HDF5."""
    try:
        if Path(path).exists() and not Path(path).is_file():
            raise FileError(f"{path}: found a folder or a device, expected a file of results")
        with Path(path).open("rb") as file:
            if file.read(len(_HDF5)) != _HDF5:
                raise InputError(f"{path}: this is no HDF5 file")
    except FileNotFoundError:
        raise FileError(f"{path}: there is no such file") from None
    except (OSError, ValueError) as error:
        if isinstance(error, Error):
            raise
        # a byte 0 in a name is a ValueError
        raise FileError(f"{path}: {getattr(error, 'strerror', None) or error}") from None
    if not _survives(path):
        raise FileError(f"{path}: this file is damaged: HDF5 cannot read it")
    try:
        for _ in _datasets(path):
            pass
    except Error:
        raise
    except (OSError, RuntimeError, KeyError, ValueError, TypeError) as error:
        raise FileError(f"{path}: this file cannot be read: {error}") from None


def _datasets(path: str) -> Iterator[h5py.Dataset]:
    """Datasets of a file; refused if one of them is elsewhere, or larger than the file can hold."""
    size = _DEFLATE * Path(path).stat().st_size
    with h5py.File(path, "r") as file:
        groups, known = [file["/"]], set()
        while groups:
            group = groups.pop()
            for name in group:
                kind = group.get(name, getlink=True)
                if isinstance(kind, h5py.ExternalLink) or not isinstance(
                    kind, (h5py.HardLink, h5py.SoftLink)
                ):
                    raise InputError(f"{path}: '{name}' is a link to another file, "
                                     "expected results in one file")  # fmt: skip
                if not isinstance(kind, h5py.HardLink):
                    continue
                found = group[name]
                place = h5py.h5o.get_info(found.id).addr
                if place in known:
                    continue
                known.add(place)
                if isinstance(found, h5py.Group):
                    groups.append(found)
                elif isinstance(found, h5py.Dataset):
                    if found.external or found.is_virtual:
                        raise InputError(f"{path}: the data of '{name}' are in another "
                                         "file, expected results in one file")  # fmt: skip
                    if found.nbytes > size:
                        raise FileError(
                            f"{path}: this file is damaged: '{name}' has {found.nbytes} "
                            "bytes, more than the file can hold"
                        )
                    yield found


def _survives(path: str) -> bool:
    """Whether HDF5 comes to an end with a file, tried by a child process.

    A damaged text of variable length makes it crash or read for ever.
    """
    with warnings.catch_warnings():
        # the child calls nothing but HDF5, whose lock h5py holds while it forks
        warnings.simplefilter("ignore", DeprecationWarning)
        child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    try:
        faulthandler.disable()
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        signal.signal(signal.SIGPROF, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_PROF, _PATIENCE + Path(path).stat().st_size / _PACE)
        with h5py.File(path, "r") as file:
            dict(file.attrs)
        for one in _datasets(path):
            dict(one.attrs)
            dict(one.parent.attrs)
            one[()]
    # what it says is for the parent to find
    except Exception:  # noqa: S110
        pass
    finally:
        os._exit(0)
