"""Cases: read, changed and solved."""

from __future__ import annotations

import contextlib
import math
import os
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from ctypes import byref, c_char_p, c_double, c_int, c_void_p
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

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
)
from .arguments import (
    MOST_POINTS,
    Groups,
    Value,
    arrays,
    namelists,
    names_of,
    scalars,
    threads_of,
    value_of,
    written,
)
from .material import Material
from .progress import progress_bar

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

#: Time that a call of the library should take [s]: what Ctrl-C waits for
_CHUNK_TIME = 0.3
#: Status of an impact with a result, and of a point whose values make no impact
SEPARATED, INVALID = 0, 3


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
    return _made("vcor_read", c_char_p(), os.fsencode(path))


def _loaded(dump: bytes) -> Case:
    """The case of a dump."""
    return _made("vcor_load", dump)


def _made(function: str, *arguments: Any) -> Case:
    """The case that a function of the library makes."""
    case = Case.__new__(Case)
    case._pointer = _library.Handle()
    call(function, *arguments, byref(case._pointer))
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

    #: Handle of the library, which has all that the case is
    _pointer: _library.Handle
    #: `figure` of `vcor.plot`, which the package sets: figures know cases, cases no figures
    plot: ClassVar[Callable[..., Figure]]
    #: `live` of `vcor.page`, which the package sets, too
    page: ClassVar[Callable[..., Any]]

    def __init__(self, source: str | Groups, *, name: str = "case.nml") -> None:
        """Read the text of a case, or groups by their names; `name` stands in messages.

        InputError: what the text or the groups have is wrong, or `source` is neither.
        """
        if isinstance(source, Mapping):
            source = namelists(source)
        elif not isinstance(source, str) or "&" not in source:
            raise InputError(f"found {source!r:.80}, expected the text of a case or its groups; "
                             "vcor.read reads a file")  # fmt: skip
        self._pointer = _library.Handle()
        call("vcor_read", source, os.fsencode(name), byref(self._pointer))

    @property
    def name(self) -> str:
        """Name of the case for messages, mostly that of its file."""
        return os.fsdecode(_library.bytes_of("vcor_name", self._pointer))

    def add(self, materials: Case) -> None:
        """Complete the case by &material groups, whose data files stay where they are."""
        if not isinstance(materials, Case):
            raise UsageError(f"found {materials!r:.60}, expected a case of &material groups, as "
                             "vcor.read makes it of a file")  # fmt: skip
        call("vcor_add_materials", self._pointer, materials._pointer)

    def __setitem__(self, address: str, value: ArrayLike) -> None:
        """Set a value; what the impact does not read is refused when it is solved."""
        text = value if isinstance(value, str) else written(value, address)
        call("vcor_set", self._pointer, address, text)

    def __delitem__(self, address: str) -> None:
        """Remove a value, so that its default holds; by its name a group, or a material."""
        call("vcor_unset", self._pointer, address)

    def __getitem__(self, address: str) -> Value | None:
        """Value at an address, given or by default; None if there is none."""
        text = _library.text_of("vcor_get", self._pointer, address)
        return None if text is None else value_of(text)

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
        """Pickle: a dump of the library, which refuses another version and other data files."""
        return _loaded, (_library.bytes_of("vcor_dump", self._pointer),)

    def __str__(self) -> str:
        """The case as namelists, what was given."""
        return self.text()

    def __repr__(self) -> str:
        return f"<vcor.Case {self.name!r}>"

    def copy(self) -> Case:
        """Another case of the same values."""
        return _made("vcor_copy", self._pointer)

    def text(self, *, complete: bool = False) -> str:
        """The case as namelists, with `complete` also every default; the case is checked."""
        return _library.text_of("vcor_case_text", self._pointer, int(complete)) or ""

    def save(self, path: str | os.PathLike[str], *, complete: bool = False) -> None:
        """Write the case to a file that the program reads; data files stay where they are."""
        call("vcor_save", self._pointer, os.fsencode(path), int(complete))

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
            materials do not cover, a line each, with a `DataRangeWarning`. For a single impact
            `attrs["exact_cor_sphere"]` is cor_sphere with `mechanics = 'exact'`, nan if it has
            none; it takes a second solution, which `solve` does not do.

        Raises
        ------
        NumericalError
            A single impact has no result. If it sticks, or does not separate within end_time, the
            summary is in the attribute `result`.
        """
        threads_of(threads)
        axes = self._axes()
        if axes:
            return self.sweep(axes, threads=threads, progress=progress)
        names = list(_library.columns(0))
        try:
            values, about = _coverage.impact(self, {}, names)
        except NumericalError as error:
            error.result = self._without_result(names)
            raise
        made = self._dataset(names, np.array([values]), {})
        made.attrs |= about
        exact = c_double()
        call("vcor_exact", self._pointer, byref(exact))
        made.attrs["exact_cor_sphere"] = exact.value
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
        columns, names = _library.columns(0), names_of(quantities)
        numbers, about = _coverage.impact(self, scalars(values), names, quantities)
        made = _coverage.Numbers(
            (name, columns[name].value(one)) for name, one in zip(names, numbers, strict=True)
        )
        vars(made).update(about)
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
        names = names_of(quantities)
        table = np.stack(columns, axis=1)
        wanted = _coverage.with_judged(names)
        results = self._solve_all(list(given), table, wanted, threads, progress)
        coords = {
            address: ("point", column) for address, column in zip(values, columns, strict=True)
        }
        made = self._dataset(names, results, coords)
        made.attrs |= _coverage.about(self, list(given), table, results, quantities)
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
        names = names_of(quantities)
        wanted = _coverage.with_judged(names)
        results = self._solve_all(list(axes), table, wanted, threads, progress)
        coords = {address: (address, axis) for address, axis in axes.items()}
        made = self._dataset(names, results, coords)
        made.attrs |= _coverage.about(self, list(axes), table, results, quantities)
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
        columns = _library.columns(1)
        variables = {
            name: ("time", row, columns[name].attrs) for name, row in self._history().items()
        }
        time_axis = variables.pop("time")
        attrs = self._attrs({}) | _coverage.about_history(self)
        return _dataset(variables, {"time": time_axis}, attrs)

    def bounces(self) -> xr.Dataset:
        """Bounces of a single impact under its weight, up to `impact.bounces`.

        Returns
        -------
        xarray.Dataset
            Time, velocity, coefficient of restitution, height and so on over `bounce`, as in the
            files of the program; none if the sphere stays where it first touches. When and how they
            ended is in the summary that `run` gives: `bouncing_time`, `bounces_end`. Attributes and
            warnings as those of `run`.

        Raises
        ------
        NumericalError
            The solution failed.
        InputError
            The case is wrong, or a sweep.

        Examples
        --------
        The restitution against the speed of impact from one drop:

        >>> case = vcor.read("superball.nml")
        >>> case.bounces().to_dataframe().plot("velocity", "cor")  # doctest: +SKIP
        """
        self._warn({})
        columns = _library.columns(3)
        variables: dict[str, Any] = {
            name: (
                "bounce",
                row.astype(int) if columns[name].is_whole else row,
                columns[name].attrs,
            )
            for name, row in self._rows("vcor_bounces", 3).items()
        }
        number = variables.pop("bounce")
        attrs = self._attrs({}) | _coverage.about_history(self)
        return _dataset(variables, {"bounce": number}, attrs)

    def _history(self) -> dict[str, Floats]:
        """Columns of the history by name, without warnings."""
        return self._rows("vcor_history", 1)

    def _rows(self, function: str, table: int) -> dict[str, Floats]:
        """Columns by name of a table that the library makes of a single impact."""
        names = list(_library.columns(table))
        rows, pointer = c_int(), c_void_p()
        call(function, self._pointer, byref(rows), byref(pointer))
        values = _library.take_numbers(pointer, rows.value * len(names))
        return dict(zip(names, values.reshape(rows.value, len(names)).T, strict=True))

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
            columns = map(np.ravel, points.values())
            ends = [[end.reduce(one, initial=np.nan) for end in (np.fmin, np.fmax)]
                    for one in columns]  # fmt: skip
            call("vcor_warnings", self._pointer, len(points), _library.texts(tuple(points)), 2,
                 np.ascontiguousarray(np.reshape(ends, (-1, 2)).T), byref(found))  # fmt: skip
        for line in (_library.take_text(found) or "").splitlines():
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
        threads = threads_of(threads)
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
        """Attributes that the program writes at the root of a file."""
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


def with_material(case: Case, name: str, group: str, path: str | None = None) -> Case:
    """A copy of a case with a &material group in the place of that of this name.

    Data files of the group are relative to the folder of `path`, or to that of the case.
    """
    made = case.copy()
    source = c_char_p() if path is None else os.fsencode(path)
    call("vcor_replace_material", made._pointer, name, group, source)
    return made


def with_values(case: Case, values: Mapping[str, float]) -> Case:
    """A copy of a case without its &sweep groups, with values in their place."""
    made = case.copy()
    call("vcor_remove_sweeps", made._pointer)
    for address, value in values.items():
        made[address] = value
    return made


def _reason(remark: str) -> str:
    """Why a point has no result, from `3 of 9 points have no result, the first is ...: why`."""
    return remark.split(": ", 1)[1]
