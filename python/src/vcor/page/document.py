"""The page as one file: what was computed, its figure, and the script that shows both."""

from __future__ import annotations

import base64
import json
import math
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from bokeh.embed import json_item
from bokeh.models import ColumnDataSource, HoverTool, Range1d
from bokeh.plotting import figure
from bokeh.resources import Resources

from .. import _library
from .._library import InputError, UsageError, __version__, whole
from .._text import option, place, write
from ..case import Case, as_case, read
from ..material_files import material_case
from .axes import Axis, axes_of
from .table import Table, solve

#: Largest file [bytes]
MOST_BYTES = 2_000_000
#: Points along an axis: those of a cubic polynomial, and what a curve of a page can show
LEAST_POINTS, MOST_POINTS = 4, 257
#: Patterns and widths of the curve by validity: told apart without colour
LINES = {"good": ("solid", 3.0), "caution": ("dashed", 2.5), "outside": ("dotted", 2.5)}
#: Meaning of the levels; docs/validity.md
VERDICTS = {
    "good": "The model holds: no measure reaches its first threshold.",
    "caution": "Some numbers are off by a few per cent",
    "outside": "This is not an impact that the model describes",
}
_PARTS = ("page.html", "page.css", "page.js")


@dataclass(frozen=True)
class Page:
    """A page; `str` is the report of the command."""

    text: str
    axes: list[Axis]
    tables: list[Table]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page to a file."""
        write(Path(path), self.text.encode())

    def __str__(self) -> str:
        return "\n".join(f"{table.name or 'impacts'}: {said(table)}" for table in self.tables)


def said(table: Table) -> str:
    """Text of a page about the numbers behind it."""
    grid = " x ".join(map(str, table.counts))
    words = f"{grid} impacts" + f"; {table.lost}" * bool(table.lost)
    words += f"; interpolated, checked by {table.fresh} other impacts: "
    if math.isnan(table.error):
        return words + "none of them where the page shows a number, so that its error is unknown"
    words += f"largest error of e {table.error:.1e}"
    if table.blank:
        words += f", {table.blank} where the page shows no number"
    if table.other:
        words += f", {table.other} with another verdict than the page shows"
    return words


def make(
    case: Case | str | os.PathLike[str],
    vary: Mapping[str, str],
    materials: Sequence[str | os.PathLike[str]] = (),
    *,
    settings: Mapping[str, str] | None = None,
    body: str = "plate",
    points: int | None = None,
    threads: int | None = None,
) -> Page:
    """Solve a sweep and make a page that shows it with sliders.

    Parameters
    ----------
    case
        A single impact, or its file.
    vary
        Range of one to three addresses, `{"impact.temperature": "0C:60C"}`; the curve is drawn
        against the first one. The page has the units of the ranges.
    materials
        Files of materials. One of a name that the case refers to completes the case; one of
        another name is a choice on the page.
    settings
        Values at addresses that replace those of the case, as `--set` has them.
    body
        "plate" or "sphere": the body whose material is chosen.
    points
        Points along each axis; None: what some ten seconds allow, between 17 and 129 for one
        number, 9 and 65 for two, 7 and 25 for three.
    threads
        As for `Case.run`.

    Raises
    ------
    UsageError
        A range is none, or the page would be larger than 2 MB.
    InputError
        The case or a material is wrong, or values make no impact.
    NumericalError
        No point has a result.
    """
    if points is not None:
        whole(points, option("points"), LEAST_POINTS, MOST_POINTS)
    if body not in ("plate", "sphere"):
        raise UsageError(f"{option('body')}: found {body!r:.60}, expected plate or sphere")
    cases = _choices(as_case(case), materials, body)
    for one in cases.values():
        for address, text in (settings or {}).items():
            one[address] = text
    first = next(iter(cases.values()))
    axes = axes_of(first, vary)
    trial = first.copy()
    for axis in axes:
        trial[axis.address] = float(axis.si(axis.nodes(2))[0])
    if trial._axes():
        raise InputError(f"{first.name}: found a &sweep group, expected a single impact, whose "
                         f"numbers {option('vary')} varies")  # fmt: skip
    tables = [solve(one, name, axes, points, threads) for name, one in cases.items()]
    folders = {Path(one.name).parent for one in cases.values()} | {
        Path(one).parent for one in materials
    }
    for table in tables:
        table.lost, table.case = (_without(folders, text) for text in (table.lost, table.case))
        table.beyond = [_without(folders, line) for line in table.beyond]
    page = Page(_document(first, axes, tables, body), axes, tables)
    if (size := len(page.text.encode())) > MOST_BYTES:
        raise UsageError(f"the page has {size / 1e6:.1f} MB, expected at most "
                         f"{MOST_BYTES / 1e6:.0f} MB; {option('points')} with a smaller number "
                         "makes it smaller")  # fmt: skip
    return page


def _choices(case: Case, materials: Sequence[str | os.PathLike[str]], body: str) -> dict[str, Case]:
    """The case with each material of a body; its own first, whose name is empty if it is alone."""
    case = case.copy()
    known = {str(case[f"{one}.material"]) for one in ("sphere", "plate")}
    own = str(case[f"{body}.material"])
    others: dict[str, Case] = {}
    for path in materials:
        _, names, has_impact = material_case(path)
        if has_impact:
            raise UsageError(f"{os.fspath(path)}: found a second case, expected a file with "
                             "nothing but &material groups")  # fmt: skip
        group = read(path)
        if {_plain(name) for name in names} & {_plain(name) for name in known}:
            case.add(group)
            continue
        if len(names) > 1:
            raise UsageError(f"{os.fspath(path)}: found {len(names)} materials, none of which the "
                             "case names; expected one, which the page offers")  # fmt: skip
        if names[0] in others:
            raise UsageError(f"{os.fspath(path)}: found '{names[0]}' twice, expected it once")
        others[names[0]] = group
    found = {own if others else "": case}
    for name, group in others.items():
        found[name] = case.copy()
        found[name].add(group)
        found[name][f"{body}.material"] = name
    return found


def _without(folders: set[Path], text: str) -> str:
    """A text without the folders of files, which are nothing for who receives a page."""
    for folder in folders:
        for name in (folder.resolve(), folder.absolute(), folder):
            text = re.sub(rf"(?<![\w/.-]){re.escape(str(name))}/", "", text)
    return text


def _plain(name: str) -> str:
    return name.casefold().replace(" ", "_")


def _document(case: Case, axes: list[Axis], tables: list[Table], body: str) -> str:
    """The text of the page."""
    columns = _library.columns(0)
    causes = columns["validity_cause"].labels.split()
    title = str(case["case.title"] or "").strip() or Path(case.name).stem
    content = {
        "version": __version__,
        "title": title,
        "body": body,
        "axes": [
            {"address": one.address, "label": one.label, "unit": one.unit, "factor": one.factor,
             "offset": one.offset, "first": one.first, "last": one.last, "log": one.is_log}
            for one in axes
        ],
        "causes": [[name, columns[name].meaning if name in columns else ""] for name in causes],
        "verdicts": VERDICTS,
        "tables": [_packed(one) for one in tables],
        "figure": json_item(_figure(axes[0])),
    }  # fmt: skip
    texts = [Path(__file__).with_name(name).read_text(encoding="utf-8") for name in _PARTS]
    page, style, script = texts
    # in a script of HTML, < would begin a tag
    data = json.dumps(content, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    bokeh = Resources(mode="inline", components=["bokeh"]).render_js()
    parts = {"style": style, "bokeh": bokeh, "data": data, "script": script}
    for name, part in parts.items():
        before, mark, after = page.partition(f"<!-- {name} -->")
        assert mark
        page = before + part + after
    return page


def _packed(table: Table) -> dict[str, Any]:
    """A table as the page reads it: numbers in base 64, little endian."""

    def packed(numbers: Any, kind: str) -> str:
        """Numbers of a kind in base 64."""
        return base64.b64encode(np.asarray(numbers, dtype=kind).tobytes()).decode()

    return {
        "name": table.name, "counts": table.counts, "cor": packed(table.cor, "<f4"),
        "state": packed(table.state, "u1"), "cause": packed(table.cause, "u1"),
        "states": table.states, "case": table.case, "drop": table.drop, "beyond": table.beyond,
        "error": None if math.isnan(table.error) else table.error, "said": said(table),
    }  # fmt: skip


def _figure(axis: Axis) -> Any:
    """The curve against the first number, with the present place and measured points."""
    label = axis.label + f" [{axis.unit}]" * bool(axis.unit)
    made = figure(
        height=340, sizing_mode="stretch_width", x_axis_label=label,
        y_axis_label="e of the sphere", x_axis_type="log" if axis.is_log else "linear",
        x_range=Range1d(start=axis.first, end=axis.last), y_range=Range1d(start=0, end=1),
        tools="pan,box_zoom,wheel_zoom,reset,save", toolbar_location="above", name="figure",
    )  # fmt: skip
    made.toolbar.logo = None
    curve = ColumnDataSource({"x": [], **{level: [] for level in LINES}}, name="curve")
    for level, (dash, width) in LINES.items():
        made.line("x", level, source=curve, line_dash=dash, line_width=width, name=level)
    points = ColumnDataSource({"x": [], "e": [], "low": [], "high": []}, name="points")
    made.segment("x", "low", "x", "high", source=points, line_width=1.5, name="bars")
    shown = made.scatter("x", "e", source=points, size=8, marker="diamond", name="measured")
    here = ColumnDataSource({"x": [], "e": []}, name="here")
    made.scatter("x", "e", source=here, size=12, line_width=2.5, fill_alpha=0, name="place")
    made.add_tools(HoverTool(renderers=[shown], tooltips=[(label, "@x"), ("e", "@e")]))
    return made


def target(path: str, case: str) -> Path:
    """Where the page of a case goes."""
    return place(path, f"{Path(case).stem}_page", ["html"], None, [case])
