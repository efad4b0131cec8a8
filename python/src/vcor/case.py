"""Cases: read, changed and solved."""

from __future__ import annotations

import contextlib
import importlib
import math
import os
import re
import sys
import time
import types
import warnings
from collections.abc import Callable, Mapping, Sequence
from ctypes import byref, c_char_p, c_double, c_int, c_void_p
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _coverage, _library
from ._library import (
    Error,
    Floats,
    InputError,
    NoResultWarning,
    NumericalError,
    UnitWarning,
    UsageError,
    call,
    encoded,
    numbers,
    whole,
)
from ._text import write

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

Value = bool | int | float | str | Sequence[float]
Groups = Mapping[str, Mapping[str, Any] | Sequence[Mapping[str, Any]]]

#: Time that a call of the library should take [s]: what Ctrl-C waits for
_CHUNK_TIME = 0.3
#: Status of a point whose values make no impact
_INVALID = 3
#: Most threads and points, as the program has them
_MOST_THREADS, MOST_POINTS = 1024, 100_000_000
#: Sweeps that take longer show a progress bar in a terminal [s]
_BAR_DELAY = 1.0


def read(path: str | os.PathLike[str], *materials: str | os.PathLike[str]) -> Case:
    """Read a case file, completed by files of materials.

    Parameters
    ----------
    path
        The file; data files that it names are relative to its folder.
    *materials
        Files of &material groups, as `vcor run` takes them after a case.

    Returns
    -------
    Case
        The case. What it says is checked when it is used, so that values can be set first.

    Raises
    ------
    FileError
        The file cannot be read.
    InputError
        It is no case.
    """
    case = _from_file(path)
    for one in materials:
        case.add(_from_file(one))
    return case


def read_cases(paths: Sequence[str | os.PathLike[str]]) -> list[Case]:
    """Cases of files, completed by the files of materials after them, as `vcor run` has it."""
    cases: list[Case] = []
    for path in paths:
        one = _from_file(path)
        if any(one[f"{body}.material"] for body in ("sphere", "plate")):
            cases.append(one)
            continue
        if not cases:
            raise UsageError(f"{os.fspath(path)}: a file with nothing but &material groups "
                             "completes the cases before it, expected a case first")  # fmt: skip
        for case in cases:
            case.add(one)
    return cases


def _from_file(path: str | os.PathLike[str]) -> Case:
    """The case of a file."""
    case = Case.__new__(Case)
    case._read(None, os.fspath(path))
    return case


class Case:
    """One impact, or a sweep, as a case file describes it.

    `case["impact.velocity"]` is the value at an address, in SI units; addresses are those of
    `--set`: `group.key`, `material_name.key`, `material_name.moduli(2)`.

    Parameters
    ----------
    source
        The text of a case file, or its groups as a mapping, such as
        `{"impact": {"velocity": 10.0}, "material": [{"name": "steel", ...}, ...]}`.
        A group of which there are several is a sequence.
    name
        Name for messages; data files are relative to its folder.

    Raises
    ------
    InputError
        The text is no case: an unknown key, say. The message names the line.
    """

    def __init__(self, source: str | Groups, *, name: str = "case.nml") -> None:
        if isinstance(source, Mapping):
            source = _namelists(source)
        elif not isinstance(source, str) or "&" not in source:
            raise InputError(f"found {source!r:.80}, expected the text of a case or its groups; "
                             "vcor.read reads a file")  # fmt: skip
        self._read(source, name)

    def _read(self, text: str | None, name: str) -> None:
        """Begin with a text, or with the file `name` if it is None."""
        self.name = name
        # the folder of the process may change
        self._path = str(Path(name).absolute())
        self._pointer = _library.Handle()
        call("vcor_read", text or c_char_p(), os.fsencode(name), byref(self._pointer))
        if text is None:
            text = Path(name).read_text(encoding="utf-8", errors="surrogateescape")
        self._text = text
        #: Texts and paths of the materials that complete it
        self._added: list[tuple[str, str]] = []
        self._settings: dict[str, str] = {}
        self._numbers: dict[str, float] = {}
        #: Addresses of the points whose units `solve` has looked at, and what was said of units
        self._looked_at: tuple[str, ...] | None = None
        self._told: set[str] = set()

    def add(self, materials: Case) -> None:
        """Complete the case by &material groups, whose data files stay where they are."""
        call("vcor_add_materials", self._pointer, materials._pointer)
        _coverage.forget(self)
        self._added = [*self._added, (materials._text, materials._path)]

    def __setitem__(self, address: str, value: ArrayLike) -> None:
        """Set a value; what the impact does not read is refused when it is solved."""
        written = _written(value, address) if not isinstance(value, str) else value
        call("vcor_set", self._pointer, address, written)
        if address not in _coverage.ONLY_FASTER:
            _coverage.forget(self)
        self._settings = {**self._settings, address: written}
        # a text or a list may set what is known by another address, too
        if isinstance(value, float):
            self._numbers = {**self._numbers, address: value}
        else:
            self._numbers, self._looked_at = {}, None

    def __getitem__(self, address: str) -> Value | None:
        """Value at an address, given or by default; None if there is none."""
        text = _library.text_of("vcor_get", self._pointer, address)
        return None if text is None else _value(text)

    def __contains__(self, address: str) -> bool:
        """Whether there is such an address, with or without a value."""
        try:
            self[address]
        except _library.UsageError:
            return False
        return True

    # list(case) would ask for case[0], case[1] and so on
    __iter__ = None

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle: the text and what was set; data files stay where they are."""
        return _restored, (self._text, self._path, self.name, self._settings, self._added)

    def __str__(self) -> str:
        """The case as namelists, what was given."""
        return self.text()

    def __repr__(self) -> str:
        return f"<vcor.Case {self.name!r}>"

    def copy(self) -> Case:
        """Another case of the same values."""
        return _changed(self, self._text, self._settings, self._added)

    def text(self, *, complete: bool = False) -> str:
        """The case as namelists, with `complete` also every default; the case is checked."""
        return _library.text_of("vcor_case_text", self._pointer, int(complete)) or ""

    def save(self, path: str | os.PathLike[str], *, complete: bool = False) -> None:
        """Write the case to a file that the program reads; data files stay where they are."""
        text, folder = self.text(complete=complete), Path(self._path).parent
        if Path(path).absolute().parent != folder:
            text = _from_anywhere(text, folder)
        write(Path(path), text.encode())

    def material(self, name: str) -> Material:
        """Material of the case by its name."""
        return Material(self, name)

    def run(self, *, threads: int | None = None, progress: bool | None = None) -> xr.Dataset:
        """Solve the case.

        Parameters
        ----------
        threads
            Threads for a case with &sweep groups; None: what the batch system, OMP_NUM_THREADS or
            the affinity of the process allows.
        progress
            Whether to show a bar; None: in a terminal or notebook, if it takes more than a second.

        Returns
        -------
        xarray.Dataset
            The summary, as in the files of the program: numbers of a single impact, or an array
            over the parameters that the case varies. `attrs["units"]` has the unit of each.
            `attrs["validity"]` of the dataset is "good", or how many points are not and by which
            measures, with a `ValidityWarning`; `attrs["beyond_data"]` has what the data behind the
            materials do not cover, a line each, with a `DataRangeWarning`.

        Raises
        ------
        NumericalError
            A single impact has no result. If it sticks, or does not separate within end_time, the
            summary is in the attribute `result`.
        """
        _threads(threads)
        axes = self._axes()
        if axes:
            return self.sweep(axes, threads=threads, progress=progress)
        self._warn({})
        names = list(_library.columns(0))
        columns, point = _coverage.with_judged(names), np.empty((1, 0))
        try:
            values, _ = self._solve([], point, columns, 1)
        except Error as error:
            if isinstance(error, NumericalError):
                error.result = self._without_result(names)
            raise
        made = self._dataset(names, values, {})
        made.attrs |= _coverage.about(self, [], point, values)
        return made

    def solve(
        self,
        values: Mapping[str, float] | None = None,
        quantities: Sequence[str] | None = None,
    ) -> _coverage.Numbers:
        """Solve one impact, for loops: plain numbers, less than 0.1 ms in addition to the solver.

        Parameters
        ----------
        values
            Values at some addresses for this time only, in SI units. Cheaper than setting them.
        quantities
            Columns of the summary; None: all.

        Returns
        -------
        dict
            Number of each quantity, in SI units; texts such as `status` as words. Its attributes
            `validity` and `beyond_data` are those of the dataset of `run`, with the same warnings.

        Raises
        ------
        NumericalError
            There is no result.
        InputError
            The values make no impact.
        """
        columns = _library.columns(0)
        names = _names(quantities)
        # numbers that were set go in as those of a point: nothing is checked and built anew then
        wanted = [*_coverage.with_judged(names), "status"]
        point = self._numbers if values is None else scalars(values)
        remark = ""
        if (addresses := tuple(point)) != self._looked_at:
            self._warn(point)
            self._looked_at = addresses
        if point:
            row = np.array([[*point.values()]])
            try:
                found, remark = self._solve(list(point), row, wanted, 1)
            except Error:
                if values is not None:
                    raise
                remark = "see the case itself"
            if remark and values is not None:
                kind = InputError if found[0, -1] == _INVALID else NumericalError
                raise kind(f"{self.name}: {_reason(remark)}")
        if not point or remark:
            point = {}
            found, _ = self._solve([], np.empty((1, 0)), wanted, 1)
        row = found[0].tolist()
        made = _coverage.Numbers(
            (name, columns[name].value(row[i])) for i, name in enumerate(names)
        )
        values_there = np.array([[*point.values()]])
        vars(made).update(_coverage.about(self, list(point), values_there, found[:, :-1]))
        return made

    def points(
        self,
        values: Mapping[str, ArrayLike],
        quantities: Sequence[str] | None = None,
        *,
        threads: int | None = None,
        progress: bool | None = None,
    ) -> xr.Dataset:
        """Solve a list of points: point i has value i of each address.

        Parameters
        ----------
        values
            Values at addresses in SI units, each of shape (n,) or a number for all points.
        quantities
            Columns of the summary; None: all.
        threads, progress
            As for `run`.

        Returns
        -------
        xarray.Dataset
            The columns over the dimension `point`, with attributes and warnings as those of `run`.
            A point without a result has nan and a `status`
            that says why; a `NoResultWarning` says how many there are. Ctrl-C ends the computation.
        """
        given = arrays(values)
        longest = max(given, key=lambda address: len(given[address]))
        for address, array in given.items():
            if len(array) not in (1, len(given[longest])):
                raise InputError(f"{address}: found {len(array)} values, and {len(given[longest])} "
                                 f"of {longest}; expected as many, or one")  # fmt: skip
        self._warn(given)
        columns = np.broadcast_arrays(*given.values())
        names = _names(quantities)
        table = np.stack(columns, axis=1)
        wanted = _coverage.with_judged(names)
        results = self._solve_all(list(given), table, wanted, threads, progress)
        coords = {
            address: ("point", column) for address, column in zip(values, columns, strict=True)
        }
        made = self._dataset(names, results, coords)
        made.attrs |= _coverage.about(self, list(given), table, results)
        return made

    def sweep(
        self,
        values: Mapping[str, ArrayLike],
        quantities: Sequence[str] | None = None,
        *,
        threads: int | None = None,
        progress: bool | None = None,
    ) -> xr.Dataset:
        """Solve all combinations of values, a labelled cube.

        Parameters
        ----------
        values
            Values at addresses in SI units, each of shape (n_i,); the last one varies fastest.
        quantities
            Columns of the summary; None: all.
        threads, progress
            As for `run`.

        Returns
        -------
        xarray.Dataset
            The columns over a dimension for each address, named by it. Otherwise as `points`.
        """
        axes = arrays(values)
        if (count := math.prod(map(len, axes.values()))) > MOST_POINTS:
            raise InputError(f"{self.name}: the grid has {count} points, expected at most "
                             f"{MOST_POINTS}")  # fmt: skip
        self._warn(axes)
        grid = np.meshgrid(*axes.values(), indexing="ij")
        table = np.stack([axis.ravel() for axis in grid], axis=1)
        names = _names(quantities)
        wanted = _coverage.with_judged(names)
        results = self._solve_all(list(axes), table, wanted, threads, progress)
        coords = {address: (address, axis) for address, axis in axes.items()}
        made = self._dataset(names, results, coords)
        made.attrs |= _coverage.about(self, list(axes), table, results)
        return made

    def history(self) -> xr.Dataset:
        """History of a single impact.

        Returns
        -------
        xarray.Dataset
            Indentation, force and so on over `time`, as in the files of the program; also of an
            impact that sticks or does not separate. Attributes and warnings as those of `run`.

        Raises
        ------
        NumericalError
            The solution failed.
        InputError
            The case is wrong, or a sweep.
        """
        self._warn({})
        columns = list(_library.columns(1).values())
        rows, pointer = c_int(), c_void_p()
        call("vcor_history", self._pointer, byref(rows), byref(pointer))
        values = _library.take_numbers(pointer, rows.value * len(columns)).reshape(rows.value, -1).T
        variables = {
            column.name: ("time", row, column.attrs)
            for column, row in zip(columns, values, strict=True)
        }
        time_axis = variables.pop("time")
        attrs = self._attrs({}) | _coverage.about_history(self)
        return _dataset(variables, {"time": time_axis}, attrs)

    def plot(self, kind: str | None = None, **options: Any) -> Figure:
        """Solve the case and draw it; needs Matplotlib.

        Parameters
        ----------
        kind
            "history" or "loop", of a case with &sweep groups "sweep" or "map"; None: the first that
            fits.
        options
            Those of `vcor.plot.figure`.
        """
        made: Figure = importlib.import_module("vcor.plot").figure(self, kind=kind, **options)
        return made

    def verify(self) -> xr.Dataset:
        """Solve the case by all methods and compare them, as `vcor verify CASE` does.

        Returns
        -------
        xarray.Dataset
            Over the dimension `quantity`: the most accurate value (`best`), that by internal
            variables (`ive`), that by product integration extrapolated (`direct`), and the number
            of digits that can be trusted (`digits`).

        Raises
        ------
        NumericalError
            The methods contradict each other, or none has a result.
        """
        self._warn({})
        columns = _library.columns(2)
        names = ("best", "ive", "direct", "digits")
        values = np.empty((len(columns), len(names)))
        call("vcor_verify", self._pointer, values)
        return _dataset(
            {name: ("quantity", values[:, i]) for i, name in enumerate(names)},
            {
                "quantity": list(columns),
                "units": ("quantity", [column.unit for column in columns.values()]),
            },
            self._attrs({}),
        )

    def _describe(self, address: str) -> _library.Column:
        """Path, unit and meaning of an address."""
        struct = _library.ColumnStruct()
        call("vcor_describe", self._pointer, address, byref(struct))
        return struct.column

    def _axes(self) -> dict[str, Floats]:
        """Addresses that the case varies, with their values."""
        axes: dict[str, Floats] = {}
        struct, n, values = _library.ColumnStruct(), c_int(), c_void_p()
        while True:
            call("vcor_axis", self._pointer, len(axes), byref(struct), byref(n), byref(values))
            if not values:
                return axes
            axes[struct.column.name] = _library.take_numbers(values, n.value)

    def _solve(
        self, addresses: Sequence[str], values: Floats, names: Sequence[str], threads: int
    ) -> tuple[Floats, str]:
        """Columns of points, shape (points, names), and a remark on points without a result."""
        results, values = np.empty((len(values), len(names))), np.ascontiguousarray(values)
        given, wanted = (_library.texts(tuple(words)) for words in (addresses, names))
        remark = call("vcor_solve", self._pointer, len(addresses), given, len(values), values,
                      len(names), wanted, results, threads)  # fmt: skip
        return results, remark

    def _warn(self, points: Mapping[str, ArrayLike]) -> None:
        """Warn of numbers of the case and of points that look like those in another unit."""
        found = c_void_p()
        # what is wrong is refused by the solution
        with contextlib.suppress(Error):
            points = points or self._axes()
            given, columns = _library.texts(tuple(points)), map(np.ravel, points.values())
            ends = [[end.reduce(one, initial=np.nan) for end in (np.fmin, np.fmax)]
                    for one in columns]  # fmt: skip
            call("vcor_warnings", self._pointer, len(points), given, 2,
                 np.ascontiguousarray(np.reshape(ends, (-1, 2)).T), byref(found))  # fmt: skip
        for line in (_library.take_text(found) or "").splitlines():
            # what is wrong with a value, wherever it stands, once for a case and its copies
            if (flaw := re.sub(r"^.*: (?=\S+ = )", "", line)) not in self._told:
                self._told.add(flaw)
                warnings.warn(line, UnitWarning, stacklevel=3)

    def _settled(self, addresses: Sequence[str], values: Floats) -> Case:
        """A copy with values, of which all is solved on the mesh that suits it, for differences."""
        near = self.copy()
        for address, value in zip(addresses, values, strict=True):
            near[address] = float(value)
        # where it has no result, its neighbours are solved as others
        with contextlib.suppress(Error):
            call("vcor_settle", near._pointer)
        return near

    @property
    def _has_mesh(self) -> bool:
        """Whether the method in use has a mesh of its own for each impact."""
        return self["plate.waves"] == "body" or self["solver.method"] == "coupled"

    def _solve_all(
        self,
        addresses: list[str],
        table: Floats,
        names: list[str],
        threads: int | None,
        progress: bool | None,
    ) -> Floats:
        """Solve points in parts that take a moment each, for the bar and Ctrl-C."""
        threads = _threads(threads)
        results = np.empty((len(table), len(names)))
        remarks = []
        # a round of points, until it is known how long one takes
        length, start = threads or len(os.sched_getaffinity(0)), 0
        with progress_bar(len(table), progress) as bar:
            while start < len(table):
                part = slice(start, start + length)
                begin = time.perf_counter()
                results[part], remark = self._solve(addresses, table[part], names, threads)
                elapsed = time.perf_counter() - begin
                if remark:
                    remarks.append(remark)
                bar.update(min(length, len(table) - start))
                start += length
                length = max(1, min(4 * length, int(length * _CHUNK_TIME / max(elapsed, 1e-6))))
        if remarks:
            lost = sum(int(remark.split(" ", 1)[0]) for remark in remarks)
            warnings.warn(
                f"{self.name}: {lost} of {len(table)} points have no result, the first one: "
                f"{_reason(remarks[0])}",
                NoResultWarning,
                stacklevel=3,
            )
        return results

    def _dataset(
        self, names: list[str], values: Floats, coords: Mapping[str, tuple[str, Floats]]
    ) -> xr.Dataset:
        """Columns as a Dataset over the dimensions of the coordinates."""
        columns, shape = _library.columns(0), {dim: len(axis) for dim, axis in coords.values()}
        variables = {
            name: (
                tuple(shape),
                columns[name].values(column).reshape(tuple(shape.values())),
                columns[name].attrs,
            )
            for name, column in zip(names, values.T[: len(names)], strict=True)
        }
        described = {
            address: (dim, axis, self._describe(address).attrs)
            for address, (dim, axis) in coords.items()
        }
        return _dataset(variables, described, self._attrs(coords))

    def _attrs(self, coords: Mapping[str, tuple[str, Floats]]) -> dict[str, str]:
        """What the program writes at the root of a file."""
        try:
            text = self.text(complete=True)
        except InputError:
            # the points may give what the case lacks
            first = self.copy()
            for address, (_, axis) in coords.items():
                first[address] = float(axis[0])
            text = first.text(complete=True)
        return {
            "program": "vcor",
            "version": _library.__version__,
            "title": str(self["case.title"]),
            "case": text,
        }

    def _without_result(self, names: list[str]) -> xr.Dataset | None:
        """Summary of an impact without a result: nan, and the status."""
        values = np.full((1, len(names)), np.nan)
        # the library says why, and leaves the status
        with contextlib.suppress(NumericalError):
            call("vcor_solve", self._pointer, 0, _library.texts(()), 1, np.empty((1, 0)),
                 len(names), _library.texts(tuple(names)), values, 1)  # fmt: skip
        return self._dataset(names, values, {})


class Material:
    """A material of a case.

    Parameters
    ----------
    case
        The case; changes of its values count.
    name
        Name of the material.
    """

    def __init__(self, case: Case, name: str) -> None:
        self._case = case
        self.name = name
        self.relaxation([])

    def relaxation(self, times: ArrayLike) -> NDArray[np.float64]:
        """Relaxation modulus E(t) [Pa] at times >= 0 [s], in their shape."""
        t = numbers(times, "times", np.inf, "numbers")
        moduli = np.empty(t.size)
        call("vcor_relaxation", self._case._pointer, self.name, t.size, t.ravel(), moduli)
        return moduli.reshape(t.shape)

    def complex_modulus(self, frequencies: ArrayLike) -> NDArray[np.complex128]:
        """Complex modulus E' + i E'' [Pa] at angular frequencies >= 0 [rad/s], in their shape."""
        w = numbers(frequencies, "frequencies", np.inf, "numbers")
        storage, loss = np.empty(w.size), np.empty(w.size)
        given = self._case._pointer, self.name, w.size, w.ravel()
        call("vcor_complex_modulus", *given, storage, loss)
        return (storage + 1j * loss).reshape(w.shape)

    def time_factor(self) -> float:
        """Shift factor a_T at `impact.temperature` [1]; 1 for a material without a shift."""
        factor = c_double()
        call("vcor_time_factor", self._case._pointer, self.name, byref(factor))
        return factor.value


def _restored(
    text: str,
    path: str,
    name: str,
    settings: Mapping[str, str],
    added: Sequence[tuple[str, str]] = (),
) -> Case:
    """A case from its pickle; data files are found from the folder where it was."""
    case = Case(text, name=path)
    case.name = name
    for one in added:
        case.add(Case(one[0], name=one[1]))
    for address, value in settings.items():
        case[address] = value
    return case


def _changed(
    case: Case, text: str, settings: Mapping[str, str] | None = None, added: Any = ()
) -> Case:
    """A case with another text in the place of one, which knows what was said of its units."""
    made = _restored(text, case._path, case.name, settings or {}, added)
    made._told = case._told
    return made


def _from_anywhere(text: str, folder: Path) -> str:
    """A case as it is printed, a key a line, with the data files of a folder by absolute paths."""
    return re.sub(
        r"(?m)^(   (?:shift_)?file = )('(?:[^']|'')*')$",
        lambda found: found[1] + _written(str(folder / str(_value(found[2]))), "file"),
        text,
    )


def number(case: Case, address: str, missing: float = math.nan) -> float:
    """Number at an address of a case."""
    value = case[address]
    return float(value) if isinstance(value, (int, float)) else missing


def radius_of(case: Case, missing: float = math.nan) -> float:
    """Radius of the sphere [m], from its diameter where that is given."""
    return number(case, "sphere.radius", 0.5 * number(case, "sphere.diameter", 2.0 * missing))


def _dataset(
    variables: Mapping[str, Any], coords: Mapping[str, Any], attrs: Mapping[str, str]
) -> xr.Dataset:
    """Columns with their units, labelled. What needs no labels starts sooner, without xarray."""
    import xarray as xr

    return xr.Dataset(variables, coords=coords, attrs=attrs)


def as_case(case: Case | str | os.PathLike[str]) -> Case:
    """A case, or that of a file."""
    case = case if isinstance(case, Case) else read(case)
    case._warn({})
    return case


def with_material(case: Case, name: str, change: Callable[[re.Match[str]], str]) -> Case:
    """A copy of a case with a changed &material group in the place of that of this name."""
    title = re.escape(_written(case[f"{name}.name"], name))
    text = re.sub(rf"(?ms)^&material\n   name = {title}\n.*?^/$", change, case.text())
    return _changed(case, text)


def with_values(case: Case, values: Mapping[str, float]) -> Case:
    """A copy of a case without its &sweep groups, with values in their place."""
    text = re.sub(r"(?ms)^&sweep\n.*?^/$", "", case.text())
    made = _changed(case, text)
    for address, value in values.items():
        made[address] = value
    return made


def _namelists(groups: Groups) -> str:
    """Text of a case from its groups."""
    lines: list[str] = []
    for group, items in groups.items():
        one = isinstance(items, (str, Mapping)) or not np.iterable(items)
        for item in [items] if one else items:
            if not isinstance(item, Mapping):
                raise InputError(f"&{group}: found {item!r:.60}, expected the keys of a group and "
                                 "their values, or a list of such groups")  # fmt: skip
            lines.append(f"&{_name(group)}")
            lines += [f"   {_name(key)} = {_written(value, f'{group}.{key}')}"
                      for key, value in item.items()]  # fmt: skip
            lines.append("/")
    return "\n".join(lines) + "\n"


def _name(key: str) -> str:
    """Name of a group or a key; nothing that would read as more than that."""
    if not isinstance(key, str) or not re.fullmatch(r"\w+(\([\d:]*\))?", key, re.ASCII):
        raise InputError(f"found {key!r:.60}, expected the name of a group or a key: letters, "
                         "digits and underscores")  # fmt: skip
    return key


def _written(value: Any, name: str) -> str:
    """A value as a namelist has it; `name` is what is given it."""
    if isinstance(value, str):
        return "'" + value.replace("'", "''") + "'"
    if isinstance(value, (bool, np.bool_)):
        return ".true." if value else ".false."
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    found = numbers(value, name, expected="a text, True, False, or numbers in one dimension")
    return ", ".join(map(repr, np.atleast_1d(found).tolist()))


def _value(text: str) -> Value:
    """A value from a namelist."""
    if text.startswith("'"):
        return text[1:-1].replace("''", "'")
    if text in (".true.", ".false."):
        return text == ".true."
    numbers = [float(word) for word in text.replace(",", " ").split()]
    # the library writes a list of one number with a comma
    if "," in text or len(numbers) != 1:
        return numbers
    return int(text) if text.lstrip("+-").isdigit() else numbers[0]


def arrays(values: Mapping[str, ArrayLike], *expected: Any) -> dict[str, Floats]:
    """Columns of numbers, each as an array of one dimension."""
    if not hasattr(values, "items") or not len(values.keys()):
        raise InputError("expected at least one column of numbers, by its address or name")
    for name in values.keys():  # noqa: SIM118  (those of a Series are no values)
        encoded(name)
    return {name: np.atleast_1d(numbers(given, name, *expected)) for name, given in values.items()}


def scalars(values: Mapping[str, float] | None) -> dict[str, float]:
    """Numbers by their addresses or names; None: none."""
    if values is None or isinstance(values, Mapping) and not values:
        return {}
    return {name: float(one[0]) for name, one in arrays(values, 0, "a number").items()}


def _threads(given: int | None) -> int:
    """Number of threads; None: what SLURM gives, or 0 for those that the library takes."""
    if given is not None:
        return whole(given, "threads", 1, _MOST_THREADS)
    name = "SLURM_CPUS_PER_TASK"
    word = os.environ.get(name, "").strip()
    if word and not word.isdecimal():
        raise UsageError(f"{name}: found '{word:.60}', expected a whole number from 1 "
                         f"to {_MOST_THREADS}")  # fmt: skip
    return whole(int(word), name, 1, _MOST_THREADS) if word else 0


def _names(quantities: Sequence[str] | None) -> list[str]:
    """Names of columns; None: all."""
    return listed(list(_library.columns(0)) if quantities is None else quantities)


def listed(names: Any) -> list[Any]:
    """Names as a list; a text is one."""
    return [names] if isinstance(names, str) or not np.iterable(names) else list(names)


def _reason(remark: str) -> str:
    """Why a point has no result, from `3 of 9 points have no result, the first is ...: why`."""
    return remark.split(": ", 1)[1]


def progress_bar(total: int | None, progress: bool | None) -> Any:
    """A progress bar, or none; a total that is not known is None."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if progress is None:
        progress = sys.stderr.isatty() or hasattr(shell, "kernel")
    if not progress:
        return contextlib.nullcontext(types.SimpleNamespace(update=lambda _: None))
    with warnings.catch_warnings():
        # a notebook without ipywidgets has the bar of a terminal
        warnings.simplefilter("ignore")
        from tqdm.auto import tqdm

    return tqdm(total=total, unit="impact", delay=_BAR_DELAY)
