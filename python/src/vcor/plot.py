"""Figures of results: histories, hysteresis loops, moduli, sweeps and maps.

`figure` makes one from files of the program and measured data; the command `vcor plot` calls it.
Lengths, times and the like are shown in units that suit them; measured data and files are in SI.
"""

from __future__ import annotations

import argparse
import csv
import math
import os
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import h5netcdf
import matplotlib as mpl
import matplotlib.style
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator

from . import _library
from ._library import Error, FileError, Floats, InputError, UsageError
from .results import open as open_results

STYLE = Path(__file__).with_name("vcor.mplstyle")
KINDS = ("history", "loop", "moduli", "sweep", "map")
FORMATS = ("svg", "pdf", "png")
#: Width of a column and of a page, height of a panel [cm]
COLUMN, PAGE, HEIGHT = 8.5, 17.0, 6.5
#: Results or curves that can be told apart
MOST = 8
_PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
_SCALED = ("m", "s", "N", "Pa", "J", "kg", "W")
#: Names of columns of measured data beside those of vcor
_OTHER_NAMES = {"t": "time", "E": "relaxation_modulus", "omega": "frequency", "e": "cor"}
_WORDS = {"cor": "coefficient of restitution", "min_frequency": "lowest frequency of interest"}
_OUTSIDE = "outside of the model's validity"


class Result:
    """A file of results: its summary, and what else it holds."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)
        self.summary = open_results(path)
        with h5netcdf.File(self.path, "r") as file:
            self.groups = set(file.groups)
        self.axes = [str(dim) for dim in self.summary.dims if str(dim) != "material"]
        self.case: str = str(self.summary.attrs.get("case", ""))
        self.title = str(self.summary.attrs.get("title", ""))

    def group(self, name: str, what: str) -> xr.Dataset:
        """A group of the file; refused if there is none."""
        if name not in self.groups:
            raise InputError(f"{self.path}: there is no {what} in this file")
        return open_results(self.path, name)

    def kind(self) -> str:
        """Kind of figure that the file is for."""
        if "relaxation" in self.groups:
            return "moduli"
        if "history" in self.groups:
            return "history"
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
            raise UsageError(
                f"{self.path}: found no quantity '{name}', expected one of {', '.join(numeric)}"
            )
        if not np.isfinite(self.summary[name]).any():
            raise InputError(f"{self.path}: '{name}' has no value at any point of this sweep")
        return self.summary[name]


class Data:
    """Measured points: columns by the names of their header, in SI units."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = os.fspath(path)
        try:
            text = Path(path).read_text(encoding="utf-8-sig")
        except OSError as error:
            raise FileError(f"{self.path}: {error.strerror}") from None
        lines = [line for line in text.splitlines() if line.split("#")[0].strip()]
        if len(lines) < 2:
            raise InputError(f"{self.path}: expected a header and at least one row of numbers")
        delimiter = next((mark for mark in ";,\t" if mark in lines[0]), " ")
        rows = list(csv.reader(lines, delimiter=delimiter, skipinitialspace=True))
        self.columns: dict[str, Floats] = {}
        for i, head in enumerate(rows[0]):
            found = re.fullmatch(r"\s*([\w.]+)\s*(?:[\[(](.*)[\])])?\s*", head)
            if not found:
                raise InputError(f"{self.path}:1: found '{head}' as name of a column")
            name, unit = found.groups()
            try:
                values = [float(row[i]) if row[i].strip() else math.nan for row in rows[1:]]
            except (ValueError, IndexError):
                raise InputError(f"{self.path}: column '{name}' holds more than numbers") from None
            self.columns[_OTHER_NAMES.get(name, name)] = np.array(values) * _size(unit, self.path)

    def find(self, name: str) -> tuple[Floats | None, Floats | None]:
        """Values and standard errors of a quantity or an address, None where there are none."""
        for key in (name, name.rpartition(".")[2]):
            if key in self.columns:
                return self.columns[key], self.columns.get(f"{key}_sigma")
        return None, None


def figure(
    files: Sequence[str | os.PathLike[str]],
    *,
    kind: str | None = None,
    quantities: Sequence[str] = ("cor",),
    legends: Sequence[str] = (),
    log: str | None = None,
    ranges: dict[str, tuple[float | None, float | None]] | None = None,
    width: float | None = None,
) -> Figure:
    """Make a figure.

    Parameters
    ----------
    files
        Files of results (.h5) of one kind, and of measured points (any other ending).
    kind
        One of `KINDS`; None: what the first file is for.
    quantities
        Columns of the summary for sweeps and maps, a panel each.
    legends
        A text for each file of results; none: titles, or what differs in the cases.
    log
        Axes that are logarithmic, letters among x and y, "" for none; None: those whose values are
        in equal ratios, and moduli.
    ranges
        First and last value of the axes x, y and of the colours z, in the units that are drawn.
    width
        Width [cm]; None: 8.5 for one panel, 17 for several.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, to be changed or saved.
    """
    data = [Data(name) for name in files if not _is_result(name)]
    results = [Result(name) for name in files if _is_result(name)]
    if not results:
        raise UsageError("expected at least one file of results, such as sls.h5")
    if len(results) > MOST:
        raise UsageError(f"found {len(results)} results, expected at most {MOST} in one figure")
    if legends and len(legends) != len(results):
        raise UsageError(
            f"found {len(legends)} --legend for {len(results)} file(s) of results, "
            "expected one for each"
        )
    kind = kind or results[0].kind()
    if kind not in KINDS:
        raise UsageError(f"unknown kind '{kind}', expected one of {', '.join(KINDS)}")
    for result in results[1:]:
        if result.kind() != results[0].kind():
            raise InputError(
                f"{result.path}: this file is for a figure of kind {result.kind()}, "
                f"{results[0].path} for one of kind {results[0].kind()}"
            )
    texts = list(legends) or _legends(results)
    draw: Callable[..., Figure] = globals()[f"_{kind}"]
    with mpl.style.context(STYLE):
        if kind in ("sweep", "map"):
            made = draw(results, texts, data, bool(legends), quantities)
        else:
            made = draw(results, texts, data, bool(legends))
        _adjust(made, log, ranges or {}, width)
    return made


def _is_result(name: str | os.PathLike[str]) -> bool:
    return os.fspath(name).endswith(".h5")


def _new(panels: int, columns: int) -> tuple[Figure, list[Axes]]:
    """A figure with panels, and letters on them if there are several."""
    rows = -(-panels // columns)
    wide = COLUMN if columns == 1 else PAGE
    made = Figure(figsize=(wide / 2.54, rows * HEIGHT / 2.54))
    axes = [made.add_subplot(rows, columns, i + 1) for i in range(panels)]
    if panels > 1:
        for letter, axis in zip("abcdefghijklmnop", axes, strict=False):
            axis.set_title(f"({letter})", loc="left")
    return made, axes


def _legend(made: Figure, *axes: Axes) -> None:
    """Legend above the panels, of the curves of some of them."""
    found: dict[str, Any] = {}
    for axis in axes:
        for handle, text in zip(*axis.get_legend_handles_labels(), strict=True):
            found.setdefault(text, handle)
    if _OUTSIDE in found:
        found[_OUTSIDE] = found.pop(_OUTSIDE)
    if found:
        width, height = made.get_size_inches()
        columns = 2 if width > 4 and len(found) > 2 and max(map(len, found)) < 45 else 1
        made.legend(list(found.values()), list(found), loc="outside upper left", ncols=columns)
        # room for its lines
        made.set_size_inches(width, height + 0.17 * -(-len(found) // columns))


def _curve(axis: Axes, number: int, x: Any, y: Any, text: str | None, **options: Any) -> Any:
    """A curve in a style of its own, by its number; with a marker every so often."""
    style = list(mpl.rcParams["axes.prop_cycle"])[number % MOST]
    settings: dict[str, Any] = {**style, "label": text, **options}
    if "marker" not in options and len(x) > 10:
        settings["markevery"] = 0.1
    return axis.plot(x, y, **settings)


def _scale(unit: str, *values: Any) -> tuple[float, str]:
    """Factor and unit in which some values are between 1 and 1000."""
    if unit not in _SCALED:
        return 1.0, "" if unit == "1" else unit
    sizes = [np.nanmax(np.abs(v), initial=0.0) for v in values]
    largest = max((float(s) for s in sizes if np.isfinite(s)), default=0.0)
    power = 3 * math.floor(math.log10(largest * (1 + 1e-9)) / 3) if largest > 0 else 0
    power = min(max(power, min(_PREFIXES)), max(_PREFIXES))
    if unit == "kg":
        return (1e3, "g") if power < 0 else (1.0, "kg")
    return 10.0**-power, _PREFIXES[power] + unit


def _size(unit: str | None, path: str) -> float:
    """A unit of measured data in SI units."""
    if not unit or unit in ("1", "-"):
        return 1.0
    known = (*_SCALED, "m/s", "rad/s", "1/s", "kg/m3", "K", "N s", "Hz")
    if unit in known and unit != "Hz":
        return 1.0
    for power, prefix in _PREFIXES.items():
        if prefix and unit.replace("μ", "µ").startswith(prefix) and unit[1:] in (*known, "g"):
            return float(10.0**power) * {"Hz": 2 * math.pi, "g": 1e-3}.get(unit[1:], 1.0)
    if unit in ("g", "Hz", "%"):
        return {"g": 1e-3, "Hz": 2 * math.pi, "%": 0.01}[unit]
    raise InputError(f"{path}: unknown unit '{unit}', expected such as s, ms, MPa, rad/s")


def _with_unit(text: str, unit: str) -> str:
    return f"{text} [{unit}]" if unit else text


def _name_of(address: str) -> str:
    """A parameter in words."""
    group, _, key = address.rpartition(".")
    words = key.replace("_", " ")
    known = ("impact", "sphere", "plate", "solver")
    return f"{group} {words}" if group in known else f"{words} of {group.replace('_', ' ')}"


def _label(array: xr.DataArray, unit: str) -> str:
    name = str(array.name)
    text = _WORDS.get(name) or array.attrs.get("long_name") or name
    if "." in name:
        text = _name_of(name)
    return _with_unit(text, unit)


def _is_geometric(values: Floats) -> bool:
    """Whether values are in equal ratios, and not in equal steps too."""
    if len(values) < 3 or not (values > 0).all():
        return False
    steps = np.diff(np.log(np.sort(values)))
    return bool(np.ptp(steps) < 1e-6 * steps.max())


def _points(axis: Axes, data: list[Data], x: str, y: str, fx: float, fy: float) -> None:
    """Measured points with their errors."""
    for number, one in enumerate(data):
        (at, at_sigma), (values, sigma) = one.find(x), one.find(y)
        if at is None or values is None:
            continue
        axis.errorbar(
            fx * at, fy * values,
            None if sigma is None else fy * sigma, None if at_sigma is None else fx * at_sigma,
            fmt="osD^v"[number % 5], color="0.3", mfc="white", capsize=1.5, elinewidth=0.7, ls="",
            label=Path(one.path).stem.replace("_", " "), zorder=5,
        )  # fmt: skip


def _refuse_unused(made: Figure, data: list[Data]) -> Figure:
    """Measured points that no panel shows are a mistake in their header."""
    shown = {text for axis in made.axes for text in axis.get_legend_handles_labels()[1]}
    for one in data:
        if Path(one.path).stem.replace("_", " ") not in shown:
            raise InputError(
                f"{one.path}: found the columns {', '.join(one.columns)}, none of which the figure "
                "shows; expected those of its axes"
            )
    return made


# ------------------------------------------------------------------------------- kinds


def _courses(results: list[Result]) -> list[dict[str, Any]]:
    """Histories up to the end of contact, and after it."""
    courses = []
    for result in results:
        history = result.group("history", "time history (a sweep has none)")
        end = result.number("contact_time")
        time = history.time.values
        course: dict[str, Any] = {"time": time, "end": end}
        for name in ("indentation", "relative_velocity", "force"):
            course[name] = history[name].values
        if not (course["relative_velocity"].max() > 0 and course["force"].max() > 0):
            raise InputError(f"{result.path}: the history in this file is not that of an impact")
        if np.isfinite(end) and end < time[-1] * (1 - 1e-9):
            n = int(np.searchsorted(time, end))
            for name in ("indentation", "relative_velocity", "force"):
                course[name] = np.insert(course[name], n, np.interp(end, time, course[name]))
            course["time"] = np.insert(time, n, end)
            course["contact"] = slice(None, n + 1)
            course["ghost"] = slice(n, None)
        else:
            course["contact"], course["ghost"] = slice(None), slice(0, 0)
        courses.append(course)
    return courses


def _history(results: list[Result], texts: list[str], data: list[Data], _: bool) -> Figure:
    """Indentation, velocity and force over time, each over its largest value."""
    courses = _courses(results)
    factor, unit = _scale("s", *[course["time"] for course in courses])
    names = {
        "indentation": r"indentation $s/s_{\max}$",
        "relative_velocity": r"velocity $-s'/v_0$",
        "force": r"force $F/F_{\max}$",
    }
    one = len(results) == 1
    made, axes = _new(1, 1) if one else _new(3, 3)
    for i, (result, course, text) in enumerate(zip(results, courses, texts, strict=True)):
        end, cor = factor * course["end"], result.number("cor")
        if not one:
            ended = f"COR {cor:.4g}, $t_0$ = {end:.4g} {unit}"
            text += f": {ended if np.isfinite(cor) else 'no separation'}"
        largest = {
            "indentation": result.number("max_indentation"),
            "relative_velocity": -course["relative_velocity"].max(),
            "force": result.number("max_force"),
        }
        for k, (name, label) in enumerate(names.items()):
            axis = axes[0] if one else axes[k]
            size = largest[name]
            size = size if np.isfinite(size) else course[name].max()
            shown = label if one else text
            number = k if one else i
            time, values = factor * course["time"], course[name] / size
            _curve(
                axis,
                number,
                time[course["contact"]],
                values[course["contact"]],
                shown,
                linestyle="-",
            )
            rest = course["ghost"]
            options = {"linestyle": "--", "marker": ""}
            _curve(axis, number, time[rest], values[rest], None, **options)
            if np.isfinite(end):
                _curve(axis, number, [end], [np.interp(end, time, values)], None, linestyle="")
            if one or i == 0:
                _points(axis, data, "time", name, factor, 1.0 / size)
        if one and np.isfinite(end):
            axes[0].axvline(end, color="0.5", lw=0.6, ls=":")
            note = {"fontsize": 8, "va": "center", "xycoords": ("axes fraction", "data")}
            residual = result.number("residual_ratio")
            # the lines where the values are, the words far enough apart
            room = max(0.0, 0.16 - abs(residual - cor)) / 2
            apart = room if residual > cor else -room
            for value, shift, words in (
                (cor, -apart, f"COR {cor:.4g}"),
                (residual, apart, f"{residual:.4g}"),
            ):
                axes[0].axhline(value, color="0.5", lw=0.6, ls=":")
                axes[0].annotate(words, (1.02, value + shift), **note)  # type: ignore[arg-type]
            axes[0].set_title(f"$t_0$ = {end:.4g} {unit}")
    for axis, label in zip(axes, ["normalised response"] if one else names.values(), strict=True):
        axis.set_xlabel(_with_unit("time", unit))
        axis.set_ylabel(label)
        axis.set_xlim(0, factor * max(course["time"][-1] for course in courses))
    _legend(made, axes[0])
    return _refuse_unused(made, data)


def _loop(results: list[Result], texts: list[str], data: list[Data], given: bool) -> Figure:
    """Force over indentation up to the end of contact, with the energy lost."""
    courses = _courses(results)
    fx, x_unit = _scale("m", *[course["indentation"] for course in courses])
    fy, y_unit = _scale("N", *[course["force"] for course in courses])
    made, (axis,) = _new(1, 1)
    for i, (result, course, text) in enumerate(zip(results, courses, texts, strict=True)):
        lost = result.number("hysteresis_energy")
        # three times the stated error of cor, as an energy
        error = 6.0 * result.number("initial_energy") * result.number("cor_error")
        shown = max(lost, error) if np.isfinite(error) else lost
        factor, unit = _scale("J", shown)
        words = f"energy loss {factor * lost:.4g} {unit}"
        if abs(lost) < error:
            words = f"energy loss < {factor * error:.1g} {unit}"
        parts = [text] if len(results) > 1 or given else []
        part = course["contact"]
        _curve(axis, i, fx * course["indentation"][part], fy * course["force"][part],
               ", ".join([*parts, words] if np.isfinite(lost) else parts), marker="")  # fmt: skip
    _points(axis, data, "indentation", "force", fx, fy)
    axis.set_xlabel(_with_unit("indentation", x_unit))
    axis.set_ylabel(_with_unit("contact force", y_unit))
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=min(0.0, axis.get_ylim()[0]) if data else 0)
    _legend(made, axis)
    return _refuse_unused(made, data)


def _moduli(results: list[Result], texts: list[str], data: list[Data], _: bool) -> Figure:
    """Relaxation modulus over time, storage and loss modulus and loss tangent over frequency."""
    curves = []
    for result, text in zip(results, texts, strict=True):
        relaxation = result.group("relaxation", "moduli (vcor material makes a file of them)")
        dynamic = result.group("dynamic", "moduli")
        # what does not relax is no curve
        names = [str(name) for name in dynamic.material.values
                 if (dynamic.loss_modulus.sel(material=name) > 0).any()]  # fmt: skip
        end = float(relaxation.attrs.get("contact_time", math.nan))
        low = float(relaxation.attrs.get("min_frequency", math.nan))
        for name in names:
            words = name if len(results) == 1 else text if len(names) == 1 else f"{text}: {name}"
            one = xr.merge([relaxation.sel(material=name, drop=True).drop_vars("in_window"),
                            dynamic.sel(material=name, drop=True).drop_vars("in_window")],
                           combine_attrs="drop")  # fmt: skip
            curves.append((words, one, end, low))
        if not names:
            raise InputError(f"{result.path}: no material in this file relaxes")
    if len(curves) > MOST:
        raise InputError(f"found {len(curves)} materials, expected at most {MOST} in one figure")
    factor, unit = _scale("Pa", *[one.storage_modulus.values for _, one, *_ in curves])
    columns = ("relaxation_modulus", "storage_modulus", "loss_modulus", "loss_tangent")
    single = len(curves) == 1
    made, axes = _new(2, 2) if single else _new(4, 2)
    if single:
        axes = [axes[0], axes[1], axes[1], axes[1].twinx()]
    places = dict(zip(columns, axes, strict=True))
    for i, (text, one, end, low) in enumerate(curves):
        for k, name in enumerate(columns):
            axis = places[name]
            over = "time" if k == 0 else "frequency"
            fy = 1.0 if name == "loss_tangent" else factor
            label = text if not single else name.replace("_", " ") if k > 0 else None
            values = fy * one[name].where(one[name] > 0)
            number = max(0, k - 1) if single else i
            _curve(axis, number, one[over], values, label, marker="")
            mark, where = (end, "$t_0$") if k == 0 else (low, r"$\omega_{\min}$")
            if np.isfinite(mark) and not (single and k > 1):
                axis.axvline(mark, color="0.5", lw=0.6, ls=":")
                if single or len(results) == 1:
                    scale, shown = _scale("s", mark) if k == 0 else (1.0, "rad/s")
                    axis.set_title(f"{where} = {scale * mark:.4g} {shown}")
            if i == 0:
                _points(axis, data, over, name, 1.0, fy)
    for name, axis in places.items():
        over_time = name == "relaxation_modulus"
        axis.set_xlabel(_with_unit("time", "s") if over_time else "angular frequency [rad/s]")
        axis.set_xscale("log")
        if name == "loss_tangent":
            axis.set_ylabel("loss tangent")
            axis.set_ylim(bottom=0)
        else:
            low, high = axis.dataLim.intervaly
            axis.set_yscale("log" if high > 10 * low else "linear")
            words = "storage and loss modulus" if single and not over_time else name
            axis.set_ylabel(_with_unit(words.replace("_", " "), unit))
            _label_short_decades(axis)
    _legend(made, *(axes[1:] if single else axes[:1]))
    return _refuse_unused(made, data)


def _sweep(
    results: list[Result], texts: list[str], data: list[Data], given: bool, names: Sequence[str]
) -> Figure:
    """Quantities over a parameter; of two parameters a curve for each value of one."""
    lines: list[tuple[str | None, xr.Dataset]] = []
    across = _across(results[0])
    for result, text in zip(results, texts, strict=True):
        if _across(result) != across:
            raise InputError(
                f"{result.path}: this sweep is over '{_across(result)}', that of the first file "
                f"over '{across}'"
            )
        if len(result.axes) == 1:
            lines.append((text if len(results) > 1 or given else None, result.summary))
            continue
        if len(results) > 1:
            raise InputError(f"{result.path}: this sweep has two parameters; with several files in "
                             "one figure expected one")  # fmt: skip
        (other,) = (axis for axis in result.axes if axis != across)
        values = result.summary[other]
        if len(values) > MOST:
            raise InputError(f"{result.path}: a curve for each of the {len(values)} values of "
                             f"'{other}' is more than the {MOST} that can be told apart; expected "
                             "--kind map")  # fmt: skip
        factor, unit = _scale(values.attrs.get("units", ""), values.values)
        lines += [
            (f"{_name_of(other)} = {factor * float(v):.5g} {unit}".strip(),
             result.summary.sel({other: v}))
            for v in values
        ]  # fmt: skip
    made, axes = _new(len(names), min(2, len(names)))
    at = [line[across] for _, line in lines]
    fx, x_unit = _scale(at[0].attrs.get("units", ""), *[one.values for one in at])
    log = all(_is_geometric(one.values) for one in at)
    for name, axis in zip(names, axes, strict=True):
        first = [result.column(name) for result in results][0]
        fy, y_unit = _scale(first.attrs.get("units", ""), *[line[name].values for _, line in lines])
        for i, (words, line) in enumerate(lines):
            ordered = line.sortby(across)
            _curve(axis, i, fx * ordered[across], fy * ordered[name], words)
        _hatch_span(axis, [line for _, line in lines], across, fx)
        _points(axis, data, across, name, fx, fy)
        if log:
            axis.set_xscale("log")
        axis.set_xlabel(_label(at[0], x_unit))
        axis.set_ylabel(_label(first, y_unit))
    _legend(made, axes[0])
    return _refuse_unused(made, data)


def _across(result: Result) -> str:
    """The parameter that a sweep is drawn over: the one with more values."""
    if len(result.axes) not in (1, 2):
        raise InputError(f"{result.path}: found {len(result.axes)} swept parameters, expected one "
                         "or two")  # fmt: skip
    return max(result.axes, key=lambda axis: result.summary.sizes[axis])


def _hatch_span(axis: Axes, lines: list[xr.Dataset], across: str, factor: float) -> None:
    """Hatch the part of an axis in which the model does not hold for one of the curves at least."""
    x = factor * np.unique(np.concatenate([line[across].values for line in lines]))
    outside = np.zeros(len(x), dtype=bool)
    for line in lines:
        if "validity" in line:
            where = factor * line[across].values[(line.validity == "outside").values]
            outside |= np.isin(x, where)
    edges = np.concatenate([x[:1], (x[1:] + x[:-1]) / 2, x[-1:]])
    steps = np.diff(np.concatenate([[0], outside.astype(int), [0]]))
    for start, end in zip(np.flatnonzero(steps > 0), np.flatnonzero(steps < 0), strict=True):
        axis.axvspan(edges[start], edges[end], fill=False, hatch="////", ec="0.8", lw=0,
                     label=_OUTSIDE, zorder=0)  # fmt: skip


def _map(
    results: list[Result], texts: list[str], data: list[Data], given: bool, names: Sequence[str]
) -> Figure:
    """A quantity over two parameters, as filled contours with labelled lines."""
    result = results[0]
    if len(results) > 1:
        raise UsageError(f"a map shows one file of results, found {len(results)}")
    if len(result.axes) != 2 or min(result.summary.sizes[axis] for axis in result.axes) < 2:
        raise InputError(f"{result.path}: a map needs a sweep of two parameters, with two values "
                         "of each or more")  # fmt: skip
    ordered = result.summary.sortby(result.axes)
    x, y = (ordered[axis] for axis in result.axes)
    (fx, x_unit), (fy, y_unit) = (_scale(a.attrs.get("units", ""), a.values) for a in (x, y))
    made, axes = _new(len(names), min(2, len(names)))
    for name, axis in zip(names, axes, strict=True):
        column = result.column(name)
        fz, z_unit = _scale(column.attrs.get("units", ""), column.values)
        z = np.ma.masked_invalid(fz * ordered[name].values.T)
        filled = axis.contourf(fx * x, fy * y, z, levels=10)
        if np.ptp(z) > 0:
            drawn = axis.contour(fx * x, fy * y, z, levels=filled.levels, colors="0.1")
            axis.clabel(drawn, fontsize=7)
        made.colorbar(filled, ax=axis, label=_label(column, z_unit))
        if "validity" in ordered and (ordered.validity == "outside").any():
            outside = (ordered.validity == "outside").values.T.astype(float)
            with mpl.rc_context({"hatch.color": "0.55"}):
                axis.contourf(fx * x, fy * y, outside, levels=[0.5, 1.5], colors="none",
                              hatches=["////"])  # fmt: skip
            axis.fill([], [], fill=False, hatch="////", ec="0.55", lw=0, label=_OUTSIDE)
        for one in data:
            (px, _), (py, _), (pz, _) = (one.find(n) for n in (*result.axes, name))
            if px is None or py is None:
                continue
            options = {"color": "white"} if pz is None else {"c": fz * pz, "norm": filled.norm}
            axis.scatter(fx * px, fy * py, s=18, edgecolors="k", linewidths=0.6, zorder=5,
                         label=Path(one.path).stem.replace("_", " "), **options)  # fmt: skip
        for values, setter in ((x, axis.set_xscale), (y, axis.set_yscale)):
            if _is_geometric(values.values):
                setter("log")
        axis.set_xlabel(_label(x, x_unit))
        axis.set_ylabel(_label(y, y_unit))
        _label_short_decades(axis)
    _legend(made, axes[0])
    return _refuse_unused(made, data)


# ----------------------------------------------------------------------------- details


def _label_short_decades(axis: Axes) -> None:
    """Plain numbers where a logarithmic axis has less than two decades."""
    for which in (axis.xaxis, axis.yaxis):
        low, high = sorted(which.get_view_interval())
        if which.get_scale() != "log" or not 0 < low < high < 100 * low:
            continue
        power = 10.0 ** math.floor(math.log10(low))
        marks = np.array([n * power * 10**k for k in range(3) for n in (1, 2, 5)])
        marks = marks[(marks >= low * 0.999) & (marks <= high * 1.001)]
        if len(marks) > 1:
            which.set_major_locator(FixedLocator(list(marks)))
            which.set_major_formatter(lambda value, _: f"{value:g}")
            which.set_minor_formatter(lambda *_: "")


def _adjust(
    made: Figure,
    log: str | None,
    ranges: dict[str, tuple[float | None, float | None]],
    width: float | None,
) -> None:
    """What the user wants otherwise: logarithmic axes, ranges, width."""
    for axis in made.axes:
        if axis.get_label() == "<colorbar>":
            continue
        if log is not None:
            axis.set_xscale("log" if "x" in log else "linear")
            axis.set_yscale("log" if "y" in log else "linear")
            _label_short_decades(axis)
        if "x" in ranges:
            axis.set_xlim(*ranges["x"])
        if "y" in ranges:
            axis.set_ylim(*ranges["y"])
        if "z" in ranges:
            for drawn in axis.collections:
                if drawn.get_array() is not None:
                    drawn.set_clim(*ranges["z"])
    if width:
        _, height = made.get_size_inches()
        made.set_size_inches(width / 2.54, height)


def _legends(results: list[Result]) -> list[str]:
    """Texts of the legend: titles, or up to three values in which the cases differ, or names."""
    titles = [result.title for result in results]
    if all(titles) and len(set(titles)) == len(titles):
        return titles
    values = [_values(result.case) for result in results]
    keys = [key for key in values[0] if len({one.get(key) for one in values}) > 1]
    keys = [key for key in keys if not key.startswith(("case.", "output."))]
    words = [", ".join(f"{key} = {one.get(key)}" for key in keys) for one in values]
    if 0 < len(keys) <= 3 and len(set(words)) == len(words):
        return words
    return [Path(result.path).stem for result in results]


def _values(case: str) -> dict[str, str]:
    """Addresses and values of a case as it is printed."""
    found: dict[str, str] = {}
    group = ""
    for line in case.splitlines():
        if line.startswith("&"):
            group = line[1:].strip()
        key, mark, value = (part.strip() for part in line.partition(" = "))
        if mark and group == "material" and key == "name":
            group = value.strip("'").replace(" ", "_")
        if mark:
            found[f"{group}.{key}"] = value
    return found


# ----------------------------------------------------------------------------- command


def save(made: Figure, path: str | os.PathLike[str]) -> None:
    """Write a figure as SVG, PDF or PNG; the same results give the same bytes."""
    path = Path(path)
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    try:
        with mpl.style.context(STYLE):
            made.savefig(path, metadata=dated.get(path.suffix))
    except OSError as error:
        raise FileError(f"{path}: {error.strerror}") from None


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="vcor plot",
        description="Draw figures of results: FILE.h5 of vcor run or vcor material, and measured "
        "points in FILE.csv with a header such as: velocity [m/s], cor, cor_sigma",
    )
    add = parser.add_argument
    add("files", nargs="+", metavar="FILE", help="results (.h5), and measured points (.csv)")
    add("--kind", choices=KINDS, help="kind of figure; default: what the first file is for")
    add("--quantity", metavar="NAME,NAME", default="cor", help="columns for sweeps and maps")
    add("--legend", metavar="TEXT", action="append", default=[], help="a text for each result")
    add("--log", metavar="AXES", help="logarithmic axes: x, y, xy, or none")
    add("--range", metavar="AXIS=FROM:TO", action="append", default=[],
        help="range of x, y or the colours z, in the unit that is drawn")  # fmt: skip
    add("--width", metavar="CM", type=float, help=f"width; default: {COLUMN} or {PAGE}")
    add("--output", metavar="PATH", help="NAME.svg, .pdf or .png, or a folder")
    add("--format", choices=FORMATS, help="format in a folder; default: svg")
    add("--script", action="store_true", help="leave the Python script that makes the figure")
    add("--quiet", action="store_true", help="say nothing of what is written")
    add("--version", action="version", version=f"vcor {_library.__version__}")
    return parser


def _ranges(words: Sequence[str]) -> dict[str, tuple[float | None, float | None]]:
    ranges = {}
    for word in words:
        found = re.fullmatch(r"([xyz])=([^:]*):([^:]*)", word)
        try:
            if not found:
                raise ValueError
            low, high = (float(end) if end else None for end in found.groups()[1:])
        except ValueError:
            raise UsageError(f"--range {word}: expected such as x=0.1:10 or y=0:") from None
        ranges[found[1]] = (low, high)
    return ranges


def _target(output: str | None, format_: str | None, usual: str) -> Path:
    """File of the figure."""
    if output and Path(output).suffix[1:] in FORMATS and not Path(output).is_dir():
        if format_ and Path(output).suffix[1:] != format_:
            raise UsageError(f"the name '{output}' contradicts --format {format_}")
        return Path(output)
    folder = Path(output or ".")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder}: {error.strerror}") from None
    return folder / f"{usual}.{format_ or 'svg'}"


def main(arguments: Sequence[str] | None = None) -> None:
    """Command `vcor plot`; exits with the codes of the program."""
    options = _parser().parse_args(arguments)
    settings: dict[str, Any] = {"quantities": options.quantity.split(",")}
    for name in ("kind", "width"):
        if getattr(options, name) is not None:
            settings[name] = getattr(options, name)
    if options.legend:
        settings["legends"] = options.legend
    if options.log is not None:
        settings["log"] = "" if options.log == "none" else options.log
    try:
        if options.range:
            settings["ranges"] = _ranges(options.range)
        made = figure(options.files, **settings)
        first = next(name for name in options.files if _is_result(name))
        kind = options.kind or Result(first).kind()
        target = _target(options.output, options.format, f"{Path(first).stem}_{kind}")
        if any(target.resolve() == Path(name).resolve() for name in options.files):
            raise InputError(f"{target}: the figure would replace this file")
        save(made, target)
        written = [target]
        if options.script:
            written.append(target.with_suffix(".py"))
            written[-1].write_text(_script(options.files, settings, target), encoding="utf-8")
    except Error as error:
        sys.stderr.write(f"vcor: error: {error}\n")
        sys.exit(error.code)
    if not options.quiet:
        sys.stdout.write("".join(f"written {path}\n" for path in written))


def _script(files: Sequence[str], settings: dict[str, Any], target: Path) -> str:
    """Python script that makes the same figure."""
    names = [os.path.relpath(name, target.parent) for name in files]
    lines = [f"    {name}={value!r}," for name, value in settings.items()]
    return "\n".join(
        [
            '"""Figure made by vcor plot; change it here, and run it in its folder."""',
            "",
            "import vcor.plot",
            "",
            "figure = vcor.plot.figure(",
            f"    {names!r},",
            *lines,
            ")",
            f"vcor.plot.save(figure, {target.name!r})",
            "",
        ]
    )


if __name__ == "__main__":
    main()
