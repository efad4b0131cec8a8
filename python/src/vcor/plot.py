"""Figures of results: histories, hysteresis loops, moduli, sweeps and maps.

`figure` makes one from results and tables of measured points; the command `vcor plot` calls it.
Lengths, times and the like are shown in units that suit them; files are in SI units.
"""

from __future__ import annotations

import contextlib
import io
import math
import os
import textwrap
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.style
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from matplotlib.ticker import FixedLocator, MaxNLocator

from . import _text, points
from ._command import FORMATS
from ._library import Floats, InputError, UsageError, numbers, printable, whole
from ._text import command, option
from .arguments import listed
from .case import Case
from .sources import Result, Source, is_result, is_temperature, legends_of
from .units import PREFIXES, TURN, ZERO_C

STYLE = Path(__file__).with_name("vcor.mplstyle")
KINDS = ("history", "loop", "moduli", "sweep", "map")
#: Width of a column and of a page, height of a panel, and least width of panels side by side [cm]
COLUMN, PAGE, HEIGHT, NARROW = 8.5, 17.0, 6.5, 5.0
#: Grey of the hatching, light behind curves and dark enough for print
HATCH = "0.65"
#: Most levels of a map by their number
_MOST_LEVELS = 50
#: Widths that are drawn [cm]
_WIDTHS = (4.25, 60.0)
#: Results or curves that can be told apart
MOST = 8
_SCALED = ("m", "s", "N", "Pa", "J", "kg", "W")
_WORDS = {
    "cor": "coefficient of restitution",
    "cor_sphere": "restitution of the sphere alone",
    "min_frequency": "lowest frequency of interest",
    "resilience": "rebound resilience",
    "rebound_height": "rebound height",
}
#: Hatching by what the column validity says, and its text
_HATCHES = {"outside": ("/////", "outside of the model's validity"),
            "caution": ("//", "with caution: 99 of 100 within 10 % or 0.05")}  # fmt: skip
#: Most lines of a text in a legend
_MOST_LINES = 20
#: Letters of a label for an inch, and the width of a panel that its numbers take [in]
_LETTERS, _BESIDE = 15.0, 0.75
#: Markers of measured points
_MARKS = "osD^v<>phX"
#: Colours of a map, light enough for lines and hatching over them
_SHADES = LinearSegmentedColormap.from_list("", mpl.colormaps["Blues"](np.linspace(0.0, 0.7, 64)))
#: Colour of the points of a map without a result: grey, which is not a level
_NOTHING = "0.8"
_Range = tuple[float | None, float | None]


@dataclass
class _Wishes:
    """Contents and style of a figure."""

    results: list[Result]
    #: Whether the user gave the texts of the results
    given: bool
    #: Labels of the axes x and y that the user gave
    names: dict[str, str]
    data: list[pd.DataFrame]
    quantities: Sequence[str]
    log: str | None
    ranges: dict[str, _Range]
    levels: int | Sequence[float]
    hatch: bool
    width: float | None


def figure(
    files: Source | Sequence[Source],
    *,
    kind: str | None = None,
    quantities: Sequence[str] | None = None,
    legends: Sequence[str] = (),
    labels: Sequence[str] = (),
    xlabel: str | None = None,
    ylabel: str | None = None,
    log: str | None = None,
    ranges: dict[str, _Range] | None = None,
    levels: int | Sequence[float] = 8,
    hatch: bool = True,
    width: float | None = None,
    celsius: bool = False,
    columns: Any = None,
    units: Any = None,
    where: Any = None,
) -> Figure:
    """Make a figure.

    Parameters
    ----------
    files
        Files of results (.h5) or materials (.nml), cases, which are solved, or sweeps of
        `Case.run`, all of one kind, and files of measured points (any other ending); one or
        several.
    kind
        One of `KINDS`; None: what the first file is for.
    quantities
        Columns of the summary for sweeps and maps, a panel each; None: cor.
    legends
        A text for each file of results; none: titles, or what differs in the cases.
    labels
        A text for each file of measured points; none: names of the files.
    xlabel, ylabel
        Label of an axis, where all panels have the same; None: the quantity with its unit.
    log
        Axes that are logarithmic, letters among x, y and z (levels of a map), "" for none; None:
        those whose values are in equal ratios, and moduli.
    ranges
        First and last value of the axes x, y and of the levels z, in the units that are drawn.
    levels
        Levels of a map in the unit that is drawn, or about how many.
    hatch
        Whether to hatch where the model does not hold.
    width
        Width [cm]; None: 8.5 for one panel, 17 for several.
    celsius
        Whether temperatures are shown in degrees Celsius in place of kelvin.
    columns, units
        Which columns of measured data are what, and their units, as for `vcor.read_data`.
    where
        Which rows of measured data are taken, as for `vcor.read_data`.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, to be changed or saved; its `get_label` is its kind.
    """
    # a Dataset and a name are iterable, too
    files = [files] if isinstance(files, (xr.Dataset, str, Case)) else listed(files)
    sources = [source for source in files if is_result(source)]
    if len(sources) > MOST:
        raise UsageError(f"found {len(sources)} results, expected at most {MOST} in one figure")
    results = [Result(source, celsius=celsius) for source in sources]
    measured = [one for one in files if not is_result(one)]
    data = points.read(measured, columns, units, where)
    if not results:
        raise UsageError("expected at least one file of results, such as sls.h5")
    legends = listed(legends)
    if legends and len(legends) != len(results):
        raise UsageError(
            f"{option('legends')}: found {len(legends)} for {len(results)} file(s) of "
            "results, expected one for each"
        )
    labels = listed(labels)
    if labels and len(labels) != len(data):
        raise UsageError(f"{option('labels')}: found {len(labels)} for {len(data)} file(s) of "
                         "measured points, expected one for each")  # fmt: skip
    for one, text in zip(data, labels, strict=False):
        one.attrs["label"] = text
    for one in data if celsius else ():
        for key in one:
            if is_temperature(str(key)) and not str(key).endswith("_sigma"):
                one[key] -= ZERO_C
    kind = kind or results[0].kind()
    if kind not in KINDS:
        raise UsageError(f"unknown kind '{kind}', expected one of {', '.join(KINDS)}")
    if quantities and kind not in ("sweep", "map"):
        raise UsageError(
            f"found {option('quantities')}, which a figure of kind {kind} does not show; a sweep "
            "has them against its parameter"
        )
    _check_axes(log, ranges or {}, levels)
    if width is not None and not _WIDTHS[0] <= numbers(width, "width", 0, "cm") <= _WIDTHS[1]:
        raise UsageError(f"found a width of {width:g} cm, expected {_WIDTHS[0]:g} to "
                         f"{_WIDTHS[1]:g}, or with a unit such as 85mm")  # fmt: skip
    for result in results[1:]:
        if result.kind() != results[0].kind():
            raise InputError(
                f"{result.path}: this file is for a figure of kind {result.kind()}, "
                f"{results[0].path} for one of kind {results[0].kind()}"
            )
    for result, text in zip(results, legends or legends_of(results), strict=True):
        result.text = printable(str(text))
    names = [points.plain_name(name) for name in listed(quantities or "cor")]
    if "validity" in names:
        raise UsageError(f"{option('quantities')}: validity is hatched behind every quantity, such "
                         f"as {option('quantities', 'cor')}; it is none with an axis")  # fmt: skip
    own = {axis: text for axis, text in (("x", xlabel), ("y", ylabel)) if text is not None}
    wishes = _Wishes(
        results, bool(legends), own, data, names, log, ranges or {}, levels, hatch, width
    )
    draw: Callable[[_Wishes], Figure] = globals()[f"_{kind}"]
    with mpl.style.context(STYLE):
        made = draw(wishes)
        made.set_label(kind)
        _legend(made)
        _adjust(made, wishes)
    shown = {text for axis in made.axes for text in axis.get_legend_handles_labels()[1]}
    for one in data:
        if not any(text == _stem(one) or text.startswith(f"{_stem(one)}: ") for text in shown):
            raise InputError(
                f"{one.attrs['path']}: found the columns {', '.join(one)}, expected one for each "
                f"axis{': ' * bool(results[0].axes)}{', '.join(results[0].axes)}"
            )
    return made


def history(case: Case, **options: Any) -> Figure:
    """Figure of the impact of a case against time; options are those of `figure`."""
    return figure(case, kind="history", **options)


# ------------------------------------------------------------------------------- kinds


def _check_axes(
    log: str | None, ranges: Mapping[str, _Range], levels: int | Sequence[float]
) -> None:
    """Refuse axes that there are not, and ranges and levels that are none."""
    if log is not None and (not isinstance(log, str) or set(log) - set("xyz")):
        raise UsageError(f"{option('log', log)}: expected letters among x, y, z, or none")
    for name, ends in ranges.items():
        with contextlib.suppress(TypeError, ValueError):
            low, high = (None if end is None else float(end) for end in ends)
            sizes = [abs(end) for end in (low, high) if end]
            if name in ("x", "y", "z") and low != high and all(1e-30 < s < 1e30 for s in sizes):
                continue
        found = [*ends] if np.iterable(ends) else [ends]
        words = ":".join("" if end is None else str(end) for end in found)
        raise UsageError(f"found '{name}={words}', expected a range such as x=0.1:10 or y=0:")
    if np.ndim(levels) == 0:
        whole(levels, "levels", 2, _MOST_LEVELS)
    elif not np.isfinite(numbers(levels, "levels")).all():
        raise UsageError("found a level that is not a finite number, expected such as 0.2,0.5")


def _courses(results: list[Result]) -> list[dict[str, Any]]:
    """Histories up to the end of contact, of the last one with a structure, and after it."""
    courses = []
    names = ("indentation", "relative_velocity", "force")
    for result in results:
        history = result.group("history", "time history (a sweep has none)", "time", *names)
        time, end = history.time.values, result.number("last_separation")
        if not np.isfinite(end):
            end = result.number("contact_time")
        course: dict[str, Any] = {name: history[name].values for name in names}
        course |= {"end": end, "contact": slice(None), "ghost": slice(0, 0), "given": None}
        struck = "&target" in result.case
        if struck:
            # the work of the force on the structure
            power = course["force"] * history["plate_velocity"].values
            work = np.cumsum(np.diff(time) * (power[1:] + power[:-1]) / 2)
            course["given"] = np.insert(work, 0, 0.0)
            course["relative_velocity"] = history["sphere_velocity"].values
        elif np.isnan(course["relative_velocity"]).all() and "sphere_velocity" in history:
            # coupled contact: the indentation is the path of the sphere
            course["relative_velocity"] = history["sphere_velocity"].values
        if not (course["relative_velocity"].max() > 0 and course["force"].max() > 0):
            raise InputError(f"{result.path}: the history in this file is not that of an impact")
        if np.isfinite(end) and end < time[-1] * (1 - 1e-9):
            n = int(np.searchsorted(time, end))
            for name in names:
                course[name] = np.insert(course[name], n, np.interp(end, time, course[name]))
            time = np.insert(time, n, end)
            course |= {"contact": slice(None, n + 1), "ghost": slice(n, None)}
        courses.append(course | {"time": time})
    return courses


def _history(wishes: _Wishes) -> Figure:
    """Indentation, velocity and force against time, each divided by its largest value."""
    courses = _courses(wishes.results)
    factor, unit = _scale("s", *[course["time"] for course in courses])
    names = {
        "indentation": "indentation s/sₘₐₓ",
        "relative_velocity": "velocity −s′/v₀",
        "force": "force F/Fₘₐₓ",
    }
    one = len(courses) == 1
    if one and wishes.given:
        raise UsageError(f"found {option('legends')}, which a history of one file does not show")
    if one and courses[0]["given"] is not None:
        names["relative_velocity"] = "velocity of the ball −z′/v₀"
        if np.isfinite(courses[0]["given"]).all():
            names["given"] = "energy to the structure W/KE₀"
    made, axes = _new(wishes, 1 if one else 3, 1 if one else 3)
    for i, (result, course) in enumerate(zip(wishes.results, courses, strict=True)):
        end = factor * course["end"]
        cor = result.number("cor" if course["given"] is None else "cor_sphere")
        ended = np.isfinite(end)
        text = result.text + (
            f": COR {cor:.4g}, t₀ = {end:.4g} {unit}" if ended else ": no separation"
        )
        for k, (name, label) in enumerate(names.items()):
            axis, number, shown = (axes[0], k, label) if one else (axes[k], i, text)
            size = result.number({"indentation": "max_indentation"}.get(name, "max_force"))
            if name == "relative_velocity" or not np.isfinite(size):
                size = -course[name][0] if name == "relative_velocity" else course[name].max()
            if name == "given":
                size = result.number("initial_energy")
            time, values = factor * course["time"], course[name] / size
            contact, ghost = course["contact"], course["ghost"]
            _curve(axis, number, time[contact], values[contact], shown, linestyle="-")
            _curve(axis, number, time[ghost], values[ghost], None, linestyle="--")
            if ended:
                _curve(axis, number, [end], [np.interp(end, time, values)], None, linestyle="",
                       clip_on=False)  # fmt: skip
            if i == 0:
                _points(axis, wishes.data, "time", name, factor, 1.0 / size)
        if one and ended:
            axes[0].axvline(end, color="0.5", lw=0.6, ls=":", label=f"t₀ = {end:.4g} {unit}")
            residual = result.number("residual_ratio")
            # lines where the values are, words far enough apart
            room = math.copysign(max(0.0, 0.16 - abs(residual - cor)) / 2, residual - cor)
            for y, shift, words in ((cor, -room, f"COR {cor:.4g}"), (residual, room, "")):
                axes[0].axhline(y, color="0.5", lw=0.6, ls=":")
                axes[0].annotate(words or f"{y:.4g}", (1, y + shift), (5, 0), va="center",
                                 xycoords=("axes fraction", "data"),
                                 textcoords="offset points")  # fmt: skip
    for axis, label in zip(axes, ["normalised response"] if one else names.values(), strict=True):
        axis.set(xlabel=f"time [{unit}]", ylabel=label)
        axis.set_xlim(0, factor * max(course["time"][-1] for course in courses))
        if not one:
            axis.locator_params(axis="x", nbins=4)
    return made


def _loop(wishes: _Wishes) -> Figure:
    """Force against indentation up to the end of contact, with the energy lost."""
    courses = _courses(wishes.results)
    fx, x_unit = _scale("m", *[course["indentation"] for course in courses])
    fy, y_unit = _scale("N", *[course["force"] for course in courses])
    made, (axis,) = _new(wishes, 1, 1)
    # coupled contact: the indentation is the path of the sphere
    losses = [result.number("hysteresis_energy") for result in wishes.results]
    losses = [
        result.number("energy_loss") if np.isnan(lost) else lost
        for result, lost in zip(wishes.results, losses, strict=True)
    ]
    # three times the stated error of cor, as an energy
    errors = [
        np.nan_to_num(6.0 * result.number("initial_energy") * result.number("cor_error"))
        for result in wishes.results
    ]
    factor, unit = _scale("J", *losses, *errors)
    for i, (result, course) in enumerate(zip(wishes.results, courses, strict=True)):
        lost, error = losses[i], errors[i]
        words = f"energy loss {factor * lost:.4g} {unit}"
        if abs(lost) < error:
            words = f"energy loss < {factor * error:.1g} {unit}"
        parts = [result.text] if len(courses) > 1 or wishes.given else []
        contact = course["contact"]
        _curve(axis, i, fx * course["indentation"][contact], fy * course["force"][contact],
               ", ".join([*parts, words] if np.isfinite(lost) else parts))  # fmt: skip
    _points(axis, wishes.data, "indentation", "force", fx, fy)
    axis.set_xlabel(_with_unit("indentation", x_unit))
    axis.set_ylabel(_with_unit("contact force", y_unit))
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=min(0.0, axis.get_ylim()[0]) if wishes.data else 0)
    return made


def _moduli(wishes: _Wishes) -> Figure:
    """Relaxation modulus against time; storage, loss modulus and loss tangent against frequency."""
    for one in wishes.data:
        count = one["temperature"].nunique() if "temperature" in one else 0
        if count > 1:
            raise InputError(
                f"{one.attrs['path']}: found moduli at {count} temperatures, expected one, or the "
                f"master curve of {command('master')}"
            )
    columns = ("relaxation_modulus", "storage_modulus", "loss_modulus", "loss_tangent")
    curves = []
    several = len(wishes.results) > 1
    for result in wishes.results:
        needed = "moduli (vcor material makes a file of them)"
        both = [result.group("relaxation", needed, "time", columns[0]),
                result.group("dynamic", needed, "frequency", *columns[1:])]  # fmt: skip
        ends = [float(both[0].attrs.get(k, math.nan)) for k in ("contact_time", "min_frequency")]
        # an elastic material has no curves
        loss = both[1].loss_modulus
        names = [name for name in loss.material.values if (loss.sel(material=name) > 0).any()]
        if not names:
            raise InputError(f"{result.path}: no material in this file relaxes")
        for name in names:
            words = printable(str(name))
            if several or wishes.given:
                words = result.text if len(names) == 1 else f"{result.text}: {words}"
            curves.append((words, [one.sel(material=name) for one in both], ends))
    if len(curves) > MOST:
        raise InputError(f"found {len(curves)} materials, expected at most {MOST} in one figure")
    factor, unit = _scale("Pa", *[both[1].storage_modulus.values for _, both, _ in curves])
    single = len(curves) == 1
    if single and wishes.given:
        raise UsageError(f"found {option('legends')}, which moduli of one material do not show")
    made, axes = _new(wishes, 2 if single else 4, 2)
    if single:
        axes = [axes[0], axes[1], axes[1], axes[1].twinx()]
    # in the unit of the data, if there are any
    hertz = any(one.attrs.get("hertz") for one in wishes.data)
    turn = TURN if hertz else 1.0
    for i, (text, both, ends) in enumerate(curves):
        if several and np.isfinite(ends).all():
            time, shown = _scale("s", ends[0])
            text += f": t₀ = {time * ends[0]:.4g} {shown}, {_least(ends[1], hertz)}"
        for k, (axis, name) in enumerate(zip(axes, columns, strict=True)):
            number, label = (max(0, k - 1), name.replace("_", " ")) if single else (i, text)
            one, over = (both[0], "time") if k == 0 else (both[1], "frequency")
            fy = 1.0 if name == "loss_tangent" else factor
            values = fy * one[name].where(one[name] > 0)
            fx = 1 / turn if k else 1.0
            _curve(axis, number, fx * one[over], values, None if single and k == 0 else label)
            mark = ends[k > 0]
            if np.isfinite(mark) and not (single and k > 1) and (several or i == 0):
                color = axis.lines[-1].get_color() if several else "0.25"
                time, shown = _scale("s", mark)
                said = _least(mark, hertz) if k else f"t₀ = {time * mark:.4g} {shown}"
                axis.axvline(
                    fx * mark, color=color, lw=0.9, ls=":", label=None if several else said
                )
            if i == 0:
                _points(axis, wishes.data, over, name, fx, fy, shift=k if single else 0)
    for k, (axis, name) in enumerate(zip(axes, columns, strict=True)):
        across = "frequency [Hz]" if hertz else "angular frequency [rad/s]"
        axis.set_xlabel(across if k else "time [s]")
        axis.set_xscale("log")
        words = name.replace("_", " ")
        if name == "loss_tangent":
            axis.set_ylabel(words)
            axis.set_ylim(bottom=0)
            continue
        low, high = axis.dataLim.intervaly
        axis.set_yscale("log" if high > 10 * low else "linear")
        axis.set_ylabel(_with_unit("storage and loss modulus" if single and k else words, unit))
    return made


def _sweep(wishes: _Wishes) -> Figure:
    """Quantities against a parameter; of two parameters a curve for each value of one."""
    results, names = wishes.results, wishes.quantities
    lines: list[tuple[str | None, xr.Dataset]] = []
    across = _across(results[0])
    for result in results:
        if _across(result) != across:
            raise InputError(
                f"{result.path}: this sweep is over '{_across(result)}', that of the first file "
                f"over '{across}'"
            )
        if len(result.axes) == 1:
            shown = len(results) > 1 or wishes.given
            lines.append((result.text if shown else None, result.summary))
            continue
        if len(results) > 1:
            raise InputError(
                f"{result.path}: this sweep has two parameters; with several files in one figure "
                "expected one"
            )
        (other,) = (axis for axis in result.axes if axis != across)
        values = result.summary[other]
        if len(values) > MOST:
            raise InputError(
                f"{result.path}: a curve for each of the {len(values)} values of '{other}' is more "
                f"than the {MOST} that can be told apart; expected {option('kind', 'map')}"
            )
        factor, unit = _scale(values.attrs.get("units", ""), values.values)
        for value in values:
            name = f"{_name_of(other)} = {factor * float(value):.5g} {unit}".strip()
            lines.append((name, result.summary.sel({other: value})))
    made, axes = _new(wishes, len(names), min(2, len(names)))
    lines = [(words, line.sortby(across)) for words, line in lines]
    at = [line[across] for _, line in lines]
    fx, x_label = _labelled(across, at[0].attrs, *[one.values for one in at])
    for name, axis in zip(names, axes, strict=True):
        column, *_ = [result.column(name) for result in results]
        fy, y_label = _labelled(name, column.attrs, *[line[name].values for _, line in lines])
        for i, (words, line) in enumerate(lines):
            _curve(axis, i, fx * line[across], fy * line[name], words)
            _bands(axis, i, fx * line[across], line, name, fy)
        if wishes.hatch:
            _hatch_span(axis, [line for _, line in lines], across, fx)
        _points(axis, wishes.data, across, name, fx, fy)
        if all(_is_geometric(one.values) for one in at):
            axis.set_xscale("log")
        axis.set(xlabel=x_label, ylabel=y_label)
    return made


def _bands(axis: Axes, number: int, x: Any, line: xr.Dataset, name: str, factor: float) -> None:
    """Additions of vcor uncertainty to a curve: shares of the samples, and exact mechanics."""
    color = list(mpl.rcParams["axes.prop_cycle"])[number % MOST]["color"]
    for low, high, text, alpha in (("2.5", "97.5", "95 %", 0.2), ("16", "84", "68 %", 0.3)):
        if (bottom := f"{name}_p{low}") in line and (top := f"{name}_p{high}") in line:
            axis.fill_between(x, factor * line[bottom], factor * line[top], color=color, lw=0,
                              alpha=alpha, label=f"{text} of the samples")  # fmt: skip
    if "beyond" in line and (out := line["beyond"].values.astype(bool)).any():
        axis.plot(x[out], factor * line[name][out], color=color, ls="", marker="o", mfc="white",
                  label="beyond the data of the materials")  # fmt: skip
    if f"{name}_exact" in line and np.isfinite(line[f"{name}_exact"]).any():
        axis.plot(x, factor * line[f"{name}_exact"], color=color, ls="--", marker="",
                  label="exact mechanics")  # fmt: skip


def _across(result: Result) -> str:
    """The parameter that a sweep is drawn over: the one with more values."""
    if len(result.axes) not in (1, 2):
        found = len(result.axes)
        raise InputError(f"{result.path}: found {found} swept parameters, expected one or two")
    return max(result.axes, key=lambda axis: result.summary.sizes[axis])


def _hatch_span(axis: Axes, lines: list[xr.Dataset], across: str, factor: float) -> None:
    """Hatch the parts of an axis by the worst validity of the curves."""
    x = factor * np.unique(np.concatenate([line[across].values for line in lines]))
    edges = np.concatenate([x[:1], (x[1:] + x[:-1]) / 2, x[-1:]])
    rest = np.ones(len(x), dtype=bool)
    for level, (lines_of, text) in _HATCHES.items():
        found = np.zeros(len(x), dtype=bool)
        for line in lines:
            if "validity" in line:
                found |= np.isin(x, factor * line[across].values[line.validity.values == level])
        steps = np.diff(np.concatenate([[0], (found & rest).astype(int), [0]]))
        rest &= ~found
        for start, end in zip(np.flatnonzero(steps > 0), np.flatnonzero(steps < 0), strict=True):
            axis.axvspan(edges[start], edges[end], fill=False, hatch=lines_of, ec=HATCH, lw=0,
                         label=text, zorder=0)  # fmt: skip


def _map(wishes: _Wishes) -> Figure:
    """Quantities against two parameters, as filled contours with labelled lines."""
    result, names = wishes.results[0], wishes.quantities
    if len(wishes.results) > 1 or wishes.given:
        found = option("legends") if wishes.given else f"{len(wishes.results)} of them"
        raise UsageError(f"a map shows one file of results without a legend, found {found}")
    if len(result.axes) != 2 or min(result.summary.sizes[axis] for axis in result.axes) < 2:
        raise InputError(
            f"{result.path}: a map needs a sweep of two parameters, with two values of each or more"
        )
    ordered = result.summary.sortby(result.axes)
    x, y = (ordered[axis] for axis in result.axes)
    (fx, x_label), (fy, y_label) = (_labelled(str(a.name), a.attrs, a.values) for a in (x, y))
    made, axes = _new(wishes, len(names), min(2, len(names)))
    for name, axis in zip(names, axes, strict=True):
        column = result.column(name)
        fz, z_label = _labelled(name, column.attrs, column.values)
        z = np.ma.masked_invalid(fz * ordered[name].values.T)
        levels = _levels(wishes, float(z.min()), float(z.max()))
        extend = ("min" if z.min() < levels[0] else "") + ("max" if z.max() > levels[-1] else "")
        norm = (LogNorm if "z" in (wishes.log or "") else Normalize)(levels[0], levels[-1])
        if np.ma.getmaskarray(z).any():
            axis.set_facecolor(_NOTHING)
            axis.fill([], [], color=_NOTHING, label="no result")
        filled = axis.contourf(fx * x, fy * y, z, levels=levels, norm=norm, cmap=_SHADES,
                               extend={"": "neither", "minmax": "both"}.get(extend, extend)
                               )  # fmt: skip
        for values, setter in ((x, axis.set_xscale), (y, axis.set_yscale)):
            if _is_geometric(values.values):
                setter("log")
        if z.max() > z.min():
            drawn = axis.contour(fx * x, fy * y, z, levels=levels, colors="0.1")
            places = _label_places(axis, drawn)
            for number in axis.clabel(drawn, fontsize=7, inline=False, fmt=_number, colors="k",
                                      manual=places):  # fmt: skip
                number.set_path_effects([withStroke(linewidth=1.6, foreground="w")])
        bar = made.colorbar(filled, ax=axis, label=z_label, ticks=levels)
        bar.ax.minorticks_off()
        bar.ax.yaxis.set_major_formatter(lambda value, _: _number(value))
        for level, (lines, text) in _HATCHES.items():
            if not (wishes.hatch and "validity" in ordered and (ordered.validity == level).any()):
                continue
            found = (ordered.validity == level).values.T.astype(float)
            with mpl.rc_context({"hatch.color": "0.3", "hatch.linewidth": 0.35}):
                axis.contourf(fx * x, fy * y, found, levels=[0.5, 1.5], colors="none",
                              hatches=[lines])  # fmt: skip
            if found.min() < 1:
                axis.contour(fx * x, fy * y, found, levels=[0.5], colors="0.25", linestyles=":")
            axis.fill([], [], fill=False, hatch=lines, ec="0.25", lw=0, label=text)
        for one in wishes.data:
            (px, _), (py, _), (pz, _) = (_find(one, n) for n in (*result.axes, name))
            if px is None or py is None:
                continue
            options = {"color": "white"} if pz is None else {
                "c": fz * pz, "norm": filled.norm, "cmap": _SHADES}  # fmt: skip
            axis.scatter(fx * px, fy * py, s=18, edgecolors="k", linewidths=0.6, zorder=5,
                         label=_stem(one), **options)  # fmt: skip
        axis.set(xlabel=x_label, ylabel=y_label)
    return made


def _label_places(axis: Axes, drawn: Any) -> list[tuple[float, float]]:
    """A place on each level of a map for its number.

    It is inside the frame and clear of the others, as near as possible to the diagonal that leaves
    the fewest levels out. A level whose line is shorter than its number has none.
    """
    back, across = axis.transAxes.inverted(), axis.transData
    best: list[tuple[float, float]] = []
    for sign in (1.0, -1.0):
        found: list[tuple[float, float]] = []
        taken: list[Floats] = []
        for path in drawn.get_paths():
            if not len(path.vertices):
                continue
            at = back.transform(across.transform(path.vertices))
            if np.max(np.ptp(at, axis=0)) < 0.06:
                continue
            off = np.abs(sign * (at[:, 0] - 0.5) - (at[:, 1] - 0.5))
            # in the corners too, where nothing else is left
            for margin in (0.08, 0.04):
                inside = np.all((at > margin) & (at < 1 - margin), axis=1)
                for other in taken:
                    inside &= np.hypot(*(at - other).T) > 0.08
                if inside.any():
                    k = int(np.argmin(np.where(inside, off, np.inf)))
                    taken.append(at[k])
                    found.append((float(path.vertices[k, 0]), float(path.vertices[k, 1])))
                    break
        best = max(best, found, key=len)
    return best


def _levels(wishes: _Wishes, low: float, high: float) -> list[float]:
    """Levels of a map: those that are wanted, or round numbers over its range."""
    bounds, smallest, largest = wishes.ranges.get("z", (None, None)), low, high
    low, high = (end if end is not None else e for end, e in zip(bounds, (low, high), strict=True))
    if not isinstance(wishes.levels, (int, np.integer)):
        levels = sorted({float(level) for level in wishes.levels})
    elif "z" in (wishes.log or ""):
        if not 0 < low < high:
            raise InputError(f"found values from {low:g} to {high:g}, of which no logarithm is")
        first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
        steps = (1, 2, 5) if 3 * (last - first) <= 2 * wishes.levels else (1,)
        rounds = np.array([m * 10.0**k for k in range(first, last + 1) for m in steps])
        below, above = rounds[rounds <= low * (1 + 1e-9)], rounds[rounds >= high * (1 - 1e-9)]
        levels = rounds[(rounds >= below[-1]) & (rounds <= above[0])].tolist()
    else:
        ticks = MaxNLocator(wishes.levels, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
        levels = [float(round(tick, 12)) for tick in ticks]
    if len(levels) < 2:
        raise UsageError("found one level, expected two or more")
    if levels[-1] < smallest or levels[0] > largest:
        raise UsageError(f"found levels from {levels[0]:g} to {levels[-1]:g}, expected some among "
                         f"the values, which are from {smallest:.4g} to {largest:.4g}")  # fmt: skip
    return levels


# ----------------------------------------------------------------------------- details


@contextlib.contextmanager
def drawn(
    width: float, height: float, rows: int = 1, columns: int = 1, **settings: Any
) -> Iterator[tuple[Figure, Any]]:
    """A new figure of a size [cm] and its axes, in the style of the package while it is drawn."""
    with mpl.style.context(STYLE):
        made = Figure(figsize=(width / 2.54, height / 2.54))
        yield made, made.subplots(rows, columns, **settings)


def _new(wishes: _Wishes, panels: int, columns: int) -> tuple[Figure, list[Axes]]:
    """A figure with panels, and letters on them if there are several."""
    wide = wishes.width or (COLUMN if columns == 1 else PAGE)
    columns = min(columns, max(1, int(wide / NARROW)))
    rows = -(-panels // columns)
    made = Figure(figsize=(wide / 2.54, rows * HEIGHT / 2.54))
    axes = [made.add_subplot(rows, columns, i + 1) for i in range(panels)]
    if panels > 1:
        for letter, axis in zip("abcdefghijklmnop", axes, strict=False):
            axis.set_title(f"({letter})", loc="left")
    return made, axes


def _legend(made: Figure) -> None:
    """Legend above the panels, of all curves in them."""
    found: dict[str, Any] = {}
    for axis in made.axes:
        for handle, text in zip(*axis.get_legend_handles_labels(), strict=True):
            found.setdefault(text, handle)
    for _, text in _HATCHES.values():
        if text in found:
            found[text] = found.pop(text)
    if not found:
        return
    width, height = made.get_size_inches()
    # letters that a line has room for
    room = round(16.5 * width) - 7
    columns = 2 if len(found) > 2 and max(map(len, found)) < room / 2 - 7 else 1
    texts = [
        "\n".join(textwrap.wrap(text, room, max_lines=_MOST_LINES, placeholder=" …"))
        for text in found
    ]
    lines = -(-sum(text.count("\n") + 1 for text in texts) // columns)
    above = 0.165 * lines + 0.06
    made.set_size_inches(width, height + above)
    made.set_layout_engine("constrained", rect=(0, 0, 1, height / (height + above)))
    made.legend(list(found.values()), texts, loc="upper left", ncol=columns, borderaxespad=0.2)


def _curve(axis: Axes, number: int, x: Any, y: Any, text: str | None, **options: Any) -> None:
    """A curve in a style of its own, by its number; values that stand alone are marked."""
    settings = {**list(mpl.rcParams["axes.prop_cycle"])[number % MOST], "label": text, **options}
    known = np.concatenate([[False], np.isfinite(np.asarray(y, float)), [False]])
    alone = np.flatnonzero(known[1:-1] & ~known[:-2] & ~known[2:])
    if not len(alone):
        settings["marker"] = ""
    axis.plot(x, y, **settings, markevery=[int(i) for i in alone])


def _least(frequency: float, hertz: bool) -> str:
    """The lowest frequency of interest [rad/s] in words."""
    if hertz:
        return f"fₘᵢₙ = {frequency / TURN:.4g} Hz"
    return f"ωₘᵢₙ = {frequency:.4g} rad/s"


def _points(
    axis: Axes, data: list[pd.DataFrame], x: str, y: str, fx: float, fy: float, *, shift: int = 0
) -> None:
    """Measured points with their errors; a shift is for the quantities of a panel that has several.

    Each of these has a marker of its own, named in the legend.
    """
    for number, one in enumerate(data):
        (at, at_sigma), (values, sigma) = _find(one, x), _find(one, y)
        if at is None or values is None:
            continue
        axis.errorbar(
            fx * at, fy * values,
            None if sigma is None else fy * sigma, None if at_sigma is None else fx * at_sigma,
            fmt=_MARKS[(number + max(0, shift - 1) * len(data)) % len(_MARKS)], color="0.3",
            mfc="white", capsize=1.5, elinewidth=0.7, ls="", zorder=3,
            label=f"{_stem(one)}: {y.replace('_', ' ')}" if shift else _stem(one),
        )  # fmt: skip


def _find(data: pd.DataFrame, name: str) -> tuple[Floats | None, Floats | None]:
    """Values and standard errors of a quantity or an address, else None."""
    for key in (name, name.rpartition(".")[2]):
        if key in data:
            sigma = f"{key}_sigma"
            return data[key].to_numpy(), data[sigma].to_numpy() if sigma in data else None
    return None, None


def _stem(data: pd.DataFrame) -> str:
    """Measured data in the legend."""
    stem = Path(data.attrs["path"]).stem.replace("_", " ")
    return printable(str(data.attrs.get("label", stem)))


def _scale(unit: str, *values: Any) -> tuple[float, str]:
    """Factor and unit in which some values are between 1 and 1000."""
    if unit not in _SCALED:
        return 1.0, "" if unit == "1" else printable(unit)
    sizes = [np.nanmax(np.abs(v), initial=0.0) for v in values]
    largest = max((float(s) for s in sizes if np.isfinite(s)), default=0.0)
    power = 3 * math.floor(math.log10(largest * (1 + 1e-9)) / 3) if largest > 0 else 0
    power = min(max(power, min(PREFIXES)), max(PREFIXES))
    if unit == "kg":
        return (1e3, "g") if power < 0 else (1.0, "kg")
    return 10.0**-power, PREFIXES[power] + unit


def _with_unit(text: str, unit: str) -> str:
    """A label with its unit, if there is one."""
    return f"{text} [{unit}]" if unit else text


def _name_of(address: str) -> str:
    """A parameter in words."""
    group, _, key = printable(address).replace("_", " ").rpartition(".")
    return key if address == "impact.drop_height" else f"{group} {key}"


def _labelled(name: str, attrs: Mapping[Any, Any], *values: Any) -> tuple[float, str]:
    """Factor for the values of a quantity, and its name in words with the unit that they have."""
    factor, unit = _scale(attrs.get("units", ""), *values)
    text = _WORDS.get(name) or printable(str(attrs.get("long_name") or name.replace("_", " ")))
    return factor, _with_unit(_name_of(name) if "." in name else text, unit)


def _number(value: float) -> str:
    """A tick in four digits; very small and large ones with a power of ten."""
    digits, _, power = f"{value:.3e}".partition("e")
    if value == 0 or -4 < int(power) < 5:
        return f"{float(f'{value:.3e}'):.6g}"
    raised = str(int(power)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    digits = f"{float(digits):g}·"
    return f"{'' if digits == '1·' else digits}10{raised}"


def _is_geometric(values: Floats) -> bool:
    """Whether values are in equal ratios, and not in equal steps too."""
    if len(values) < 3 or not (values > 0).all():
        return False
    steps = np.diff(np.log(np.sort(values)))
    return bool(np.ptp(steps) < 1e-6 * steps.max())


def _adjust(made: Figure, wishes: _Wishes) -> None:
    """Apply choices of the user: labels, logarithmic axes and ranges; no text is a formula."""
    _name_axes(made, wishes.names)
    for axis in made.axes:
        texts = [axis.title, axis.xaxis.label, axis.yaxis.label, *axis.texts]
        for text in texts:
            text.set_parse_math(False)
        place = axis.get_subplotspec()
        columns = 1 if place is None else place.get_gridspec().ncols
        rooms = (made.get_size_inches()[0] / columns - _BESIDE, HEIGHT / 2.54)
        for which, inches in zip((axis.xaxis, axis.yaxis), rooms, strict=True):
            lines = textwrap.wrap(which.label.get_text(), max(12, round(_LETTERS * inches)))
            which.label.set_text("\n".join(lines))
        if axis.get_label() == "<colorbar>":
            continue
        for letter, which in (("x", axis.xaxis), ("y", axis.yaxis)):
            if wishes.log not in (None, "z"):
                scale = "log" if letter in wishes.log else "linear"
                axis.set(**{f"{letter}scale": scale})
                if scale == "log" and min(which.get_view_interval()) <= 0:
                    axis.autoscale(axis=letter)  # type: ignore[arg-type]
            if letter in wishes.ranges:
                axis.set(**{f"{letter}lim": wishes.ranges[letter]})
                (low, high), ends = sorted(which.get_view_interval()), which.get_data_interval()
                if high < min(ends) or low > max(ends):
                    raise UsageError(
                        f"{option('ranges', {letter: (low, high)})}: no data in it, "
                        f"{letter} is {which.label.get_text()} from {min(ends):.4g} to "
                        f"{max(ends):.4g}"
                    )
            _label_decades(which)
    for legend in made.legends:
        for text in legend.get_texts():
            text.set_parse_math(False)


def _name_axes(made: Figure, names: Mapping[str, str]) -> None:
    """Labels that the user gave, of panels that have the same."""
    panels = [axis for axis in made.axes if axis.get_label() != "<colorbar>"]
    for letter, text in names.items():
        axes = [axis.xaxis if letter == "x" else axis.yaxis for axis in panels]
        found = sorted({axis.label.get_text() for axis in axes})
        if len(found) > 1:
            raise UsageError(f"found --{letter}label, but the panels have several: "
                             f"{'; '.join(found)}")  # fmt: skip
        for axis in axes:
            axis.label.set_text(printable(text))


def _label_decades(which: Any) -> None:
    """Plain numbers on a logarithmic axis without far decades, as many as there is room for."""
    low, high = sorted(which.get_view_interval())
    if which.get_scale() != "log" or not 0 < low < high:
        return
    which.set_minor_formatter(lambda *_: "")
    if high < 100 * low or (low > 0.9e-3 and high < 1.1e4):
        which.set_major_formatter(lambda value, _: _number(value))
    power = 10.0 ** math.floor(math.log10(low))
    # numbers with powers are wide
    steps = (1, 2, 5) if low > 0.9e-3 or high < 10 * low else (1, 3)
    marks = [n * power * 10**k for k in range(3) for n in steps]
    if high < 4 * low:
        marks = list(MaxNLocator(5, steps=[1, 2, 5, 10]).tick_values(low, high))
    if high < 100 * low:
        inside = [mark for mark in marks if low * 0.999 <= mark <= high * 1.001]
        which.set_major_locator(FixedLocator(inside))


def save(made: Figure, path: str | os.PathLike[str]) -> None:
    """Write a figure as SVG, PDF or PNG; the same results give the same bytes."""
    path = Path(path)
    if path.suffix[1:].lower() not in FORMATS:
        raise UsageError(f"{path}: expected a name that ends with .{', .'.join(FORMATS)}")
    dated = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}
    bytes_ = io.BytesIO()
    with mpl.style.context(STYLE):
        made.savefig(bytes_, format=path.suffix[1:], metadata=dated.get(path.suffix))
    _text.write(path, bytes_.getvalue())
