"""Figures of a live page: e against a number, the impact over time, its loop, moduli."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from bokeh.models import (
    BoxAnnotation,
    Column,
    ColumnDataSource,
    HoverTool,
    LinearAxis,
    Range1d,
    Row,
)
from bokeh.plotting import figure

from .._library import Floats
from ..units import TURN, size
from .answer import Answer, Curve, Span, seen
from .document import LINES
from .keys import Key
from .measured import Measured

#: Colours of curves on a light and on a dark page, the present one first: of different lightness,
#: so that a colour-blind reader tells them apart; each has a pattern of its own too
COLOURS = {
    False: ["#0060a0", "#b34700", "#00593f", "#7a3e9d", "#8a6d00", "#9c1c3c", "#50565e"],
    True: ["#62b5f2", "#f2a04a", "#6fd3ae", "#c9a0e8", "#e6d36a", "#ff9bb0", "#aab2bb"],
}
PATTERNS = ["solid", "dashed", "dotted", "dotdash", [8, 2], [2, 2, 8, 2], [12, 3]]
#: Curves that can be kept beside the present one
MOST_KEPT = len(PATTERNS) - 1
_PAPER = {False: ("#ffffff", "#16191d", "#b9c0c8"), True: ("#14171a", "#eceff2", "#4b535c")}
_TOOLS = "pan,box_zoom,wheel_zoom,reset,save"
_HEIGHT, _SMALL = 330, 250
#: Prefixes of a unit by size, for axes
_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))


def scaled(values: Floats, unit: str) -> tuple[float, str]:
    """Size of a unit with a prefix that suits some values, and its name."""
    with np.errstate(invalid="ignore"):
        largest = float(np.nanmax(np.abs(values), initial=0.0))
    for one, prefix in _PREFIXES:
        if largest >= one:
            return one, prefix + unit
    return 1.0, unit


class Figures:
    """The figures of one page; `root` holds them."""

    def __init__(self) -> None:
        """Make the sources and the figures, all of them empty."""
        self.is_dark = False
        self._sources = {
            name: ColumnDataSource(data={column: [] for column in columns}, name=name)
            for name, columns in {
                "here": ("x", "e"), "points": ("x", "e", "low", "high"),
                "data": ("frequency", "modulus"),
            }.items()
        }  # fmt: skip
        self._curves = [
            ColumnDataSource(data={column: [] for column in ("x", "e", *LINES)}, name=f"curve {i}")
            for i in range(MOST_KEPT + 1)
        ]
        self._histories = [
            ColumnDataSource(data={column: [] for column in ("t", "s", "f")})
            for _ in range(MOST_KEPT + 1)
        ]
        self._moduli = [
            ColumnDataSource(data={column: [] for column in ("frequency", "storage", "loss")})
            for _ in range(2)
        ]
        self._measured = Measured()
        #: Moduli that were measured, of the material of a file
        self._answer: Answer | None = None
        self.curve: Any = None
        self.curve_box = Column(sizing_mode="stretch_width", name="curve")
        self._make_small()
        small = [self.force, self.loop, self.moduli]
        self.small_box = Row(
            *small, sizing_mode="stretch_width", name="small",
            styles={"flex-wrap": "wrap", "gap": "0.6rem"},
        )  # fmt: skip
        self.span: Span | None = None
        self.key: Key | None = None

    # ------------------------------------------------------------------------- making

    def _new(self, name: str, height: int, x: str, y: str, **more: Any) -> Any:
        """An empty figure with the tools of the page; `x` and `y` are the labels of its axes."""
        made = figure(
            height=height, sizing_mode="stretch_width", x_axis_label=x, y_axis_label=y,
            tools=_TOOLS, toolbar_location="above", name=name, **more,
        )  # fmt: skip
        made.toolbar.logo = None
        made.toolbar.autohide = True
        if height == _SMALL:
            # side by side where there is room
            made.styles = {"flex": "1 1 17rem", "min-width": "0"}
        return made

    def _make_small(self) -> None:
        """Make the figures of the impact, the loop and the moduli."""
        self.force = self._new("force", _SMALL, "time", "force", title="Impact")
        self.force.extra_y_ranges = {"s": Range1d(0, 1)}
        self.force.y_range, self.force.x_range = Range1d(0, 1), Range1d(0, 1)
        self.force.add_layout(LinearAxis(y_range_name="s", axis_label="indentation"), "right")
        self.loop = self._new("loop", _SMALL, "indentation", "force", title="Loop")
        self.loop.y_range, self.loop.x_range = Range1d(0, 1), Range1d(0, 1)
        self.moduli = self._new("moduli", _SMALL, "frequency [Hz]", "modulus [Pa]",
                                x_axis_type="log", y_axis_type="log", x_range=Range1d(1, 10),
                                y_range=Range1d(1, 10), title="Moduli")  # fmt: skip
        self._drawn: list[tuple[Any, int]] = []
        for i, source in enumerate(self._histories):
            dash = PATTERNS[i]
            self._drawn += [
                (self.force.line("t", "f", source=source, line_dash=dash, line_width=2.2), i),
                (self.loop.line("s", "f", source=source, line_dash=dash, line_width=2.2), i),
            ]
        self._thin = self.force.line("t", "s", source=self._histories[0], y_range_name="s",
                                     line_width=1.4, line_dash=[3, 3])  # fmt: skip
        for i, source in enumerate(self._moduli):
            for column, width in (("storage", 2.4), ("loss", 1.4)):
                self._drawn.append((
                    self.moduli.line("frequency", column, source=source, line_width=width,
                                     line_dash="solid" if column == "storage" else [4, 3]), i,
                ))  # fmt: skip
        self._data = self.moduli.scatter("frequency", "modulus", source=self._sources["data"],
                                         size=5, marker="diamond")  # fmt: skip
        self.band = BoxAnnotation(fill_alpha=0.15, line_color=None, visible=False)
        self.moduli.add_layout(self.band)
        self.paint()

    def set_span(self, span: Span | None, key: Key | None) -> None:
        """Draw the curve against another number."""
        self.span, self.key = span, key
        if span is None or key is None:
            self.curve_box.children = []
            return
        x = [self._x(span.first), self._x(span.last)]
        made = self._new(
            "figure", _HEIGHT, key.label, "e of the sphere",
            x_axis_type="log" if span.is_log else "linear",
            x_range=Range1d(*x, reset_start=x[0], reset_end=x[1]), y_range=Range1d(0, 1),
        )  # fmt: skip
        self._lines = []
        for i, source in enumerate(self._curves):
            if i == 0:
                for level, (dash, width) in LINES.items():
                    one = made.line("x", level, source=source, line_dash=dash, line_width=width)
                    self._lines.append((one, 0))
            else:
                one = made.line("x", "e", source=source, line_dash=PATTERNS[i], line_width=1.8)
                self._lines.append((one, i))
        points, here = self._sources["points"], self._sources["here"]
        self._bars = made.segment("x", "low", "x", "high", source=points, line_width=1.5)
        self._points = made.scatter("x", "e", source=points, size=8, marker="diamond")
        self._here = made.scatter("x", "e", source=here, size=13, line_width=2.5, fill_alpha=0)
        shown = [self._points, self._here, *[one for one, _ in self._lines]]
        made.add_tools(HoverTool(renderers=shown, tooltips=[(key.label, "$x"), ("e", "$y")]))
        self.curve = made
        for source in self._curves:
            source.data = {column: [] for column in source.data}
        self.paint()
        self.curve_box.children = [made]
        self.show_points(self._measured)

    def paint(self) -> None:
        """Give all parts the colours of a light or a dark page."""
        colours = COLOURS[self.is_dark]
        paper, words, line = _PAPER[self.is_dark]
        for plot in (self.curve, self.force, self.loop, self.moduli):
            if plot is None:
                continue
            plot.background_fill_color = paper
            plot.border_fill_color = None
            plot.outline_line_color = line
            for axis in plot.axis:
                axis.axis_line_color = axis.major_tick_line_color = words
                axis.minor_tick_line_color = words
                axis.axis_label_text_color = axis.major_label_text_color = words
                axis.axis_label_text_font_style = "normal"
                axis.axis_label_text_font_size = axis.major_label_text_font_size = "13px"
            if plot.title is not None:
                plot.title.text_color = words
            for grid in plot.grid:
                grid.grid_line_color, grid.grid_line_alpha = line, 0.4
        for drawn, i in [*self._drawn, *(self._lines if self.curve else [])]:
            drawn.glyph.line_color = colours[i]
        self._thin.glyph.line_color = words
        self._data.glyph.line_color = self._data.glyph.fill_color = words
        self.band.fill_color = colours[0]
        if self.curve:
            self._here.glyph.line_color = colours[0]
            for one in (self._points, self._bars):
                one.glyph.line_color = words
            self._points.glyph.fill_color = words

    # ------------------------------------------------------------------------- showing

    def _x(self, values: Any) -> Any:
        """Values of the axis in its usual unit."""
        assert self.key is not None
        factor, offset = size(self.key.usual, self.key.unit) if self.key.unit else (1.0, 0.0)  # type: ignore[misc]
        return (values - offset) / factor

    def show(self, answer: Answer, here: float | None, kept: Sequence[Answer]) -> None:
        """Show what is known of the impact, and of the kept ones."""
        self._answer = answer
        self._show_curves(answer.curves or [], here, answer)
        self._show_histories([answer.history, *[one.history for one in kept]])
        if answer.numbers is not None:
            self._show_titles(answer.numbers)
        self._show_moduli(answer)

    def _show_curves(self, curves: Sequence[Curve], here: float | None, answer: Answer) -> None:
        """Draw the present curve, the kept ones and the point of the case."""
        if self.curve is None:
            return
        for i, source in enumerate(self._curves):
            if i >= len(curves):
                source.data = {column: [] for column in source.data}
                continue
            curve = curves[i]
            known = np.isfinite(curve.cor) | np.array([one != "" for one in curve.level])
            level = np.array(curve.level)[known]
            e = curve.cor[known]
            data = {"x": self._x(curve.x[known]), "e": e}
            for one in LINES:
                # a line of a level goes on to the first point of the next one
                on = level == one
                on[1:] |= on[:-1] & (level[1:] != "none")
                data[one] = np.where(on, e, np.nan)
            source.data = data
        e_here = answer.numbers["cor_sphere"] if answer.numbers else np.nan
        is_on = here is not None and np.isfinite(float(e_here))
        self._sources["here"].data = {
            "x": [self._x(here)] if is_on else [], "e": [e_here] if is_on else [],
        }  # fmt: skip
        self._fit_axis()

    def _fit_axis(self) -> None:
        """The whole curve and all points within the axis."""
        found = [np.asarray(source.data["e"], dtype=float) for source in self._curves]
        points = self._sources["points"].data
        found += [np.asarray(points[one], dtype=float) for one in ("low", "high")]
        found.append(np.asarray(self._sources["here"].data["e"], dtype=float))
        all_of = np.concatenate(found)
        all_of = all_of[np.isfinite(all_of)]
        if not all_of.size:
            return
        low, high = float(all_of.min()), float(all_of.max())
        # so that a curve that is nearly level is shown as such
        margin = max(0.08 * (high - low), 0.01)
        _fit(self.curve.y_range, max(low - margin, -0.02), min(high + margin, 1.05))

    def show_points(self, measured: Measured) -> None:
        """Show measured points that know the number of the axis."""
        self._measured = measured
        x = measured.at.get(self.span.address) if self.span else None
        if x is None:
            self._sources["points"].data = {one: [] for one in ("x", "e", "low", "high")}
        else:
            e, bar = measured.e, measured.bar
            self._sources["points"].data = {
                "x": self._x(x), "e": e, "low": e - bar, "high": e + bar,
            }  # fmt: skip
        if self.curve:
            self._fit_axis()

    def _show_histories(self, histories: Sequence[Mapping[str, Floats] | None]) -> None:
        """Draw force and indentation of some impacts; None: that one has no history."""
        known = [one for one in histories if one is not None]
        if not known:
            return
        columns = {name: np.concatenate([one[name] for one in known]) for name in known[0]}
        t, t_unit = scaled(columns["time"], "s")
        s, s_unit = scaled(columns["indentation"], "m")
        f, f_unit = scaled(columns["force"], "N")
        for i, source in enumerate(self._histories):
            one = histories[i] if i < len(histories) else None
            source.data = {
                "t": one["time"] / t if one else [], "s": one["indentation"] / s if one else [],
                "f": one["force"] / f if one else [],
            }  # fmt: skip
        self.force.xaxis.axis_label = f"time [{t_unit}]"
        self.force.yaxis[0].axis_label = self.loop.yaxis[0].axis_label = f"force [{f_unit}]"
        self.force.yaxis[1].axis_label = self.loop.xaxis.axis_label = f"indentation [{s_unit}]"
        ends = {name: float(np.nanmax(column)) for name, column in columns.items()}
        least = min(0.0, float(np.nanmin(columns["force"]))) / f
        low = min(0.0, float(np.nanmin(columns["indentation"]))) / s
        _fit(self.force.x_range, 0.0, ends["time"] / t)
        for plot in (self.force, self.loop):
            _fit(plot.y_range, least, 1.06 * ends["force"] / f)
        for one in (self.force.extra_y_ranges["s"], self.loop.x_range):
            _fit(one, low, 1.06 * ends["indentation"] / s)

    def _show_titles(self, numbers: Mapping[str, float | str]) -> None:
        """Duration of the contact and energy of the loop."""
        time, lost = float(numbers["contact_time"]), float(numbers["hysteresis_energy"])
        if np.isnan(lost):
            # coupled contact: the indentation is the path of the sphere
            lost = float(numbers["energy_loss"])
        words = {"Impact": ("contact", time, "s"), "Loop": ("energy lost", lost, "J")}
        for plot, (name, (what, value, unit)) in zip((self.force, self.loop), words.items(),
                                                     strict=True):  # fmt: skip
            one, shown = scaled(np.array([value]), unit)
            plot.title.text = f"{name}: {what} {value / one:.3g} {shown}" if value > 0 else name

    def _show_moduli(self, answer: Answer) -> None:
        """Draw storage and loss modulus of both materials, and the band that the impact sees."""
        if answer.moduli is None or answer.numbers is None:
            return
        found = list(answer.moduli.values())
        for i, source in enumerate(self._moduli):
            one = found[i] if i < len(found) else None
            source.data = {
                "frequency": one["frequency"] / TURN if one else [],
                "storage": one["storage_modulus"] if one else [],
                "loss": one["loss_modulus"] if one else [],
            }  # fmt: skip
        self.moduli.visible = bool(found)
        if found:
            all_of = np.concatenate([one[k] for one in found
                                     for k in ("storage_modulus", "loss_modulus")])  # fmt: skip
            all_of = all_of[all_of > 0]
            _fit(self.moduli.y_range, float(all_of.min()) / 1.5, float(all_of.max()) * 1.5)
            f = found[0]["frequency"] / TURN
            _fit(self.moduli.x_range, float(f.min()), float(f.max()))
        contact_time = float(answer.numbers["contact_time"])
        self.band.visible = bool(found) and contact_time > 0
        if self.band.visible:
            self.band.left, self.band.right = (one / TURN for one in seen(contact_time))

    def show_data(self, frequency: Sequence[float], modulus: Sequence[float]) -> None:
        """Show measured moduli beside those of the material."""
        self._sources["data"].data = {"frequency": list(frequency), "modulus": list(modulus)}

    def table(self) -> Mapping[str, Any]:
        """The curves that are shown."""
        return {str(i): source.data for i, source in enumerate(self._curves)}


def _fit(one: Any, start: float, end: float) -> None:
    """Set the ends of an axis, and those to which it is reset."""
    if not end > start:
        end = start + 1.0
    one.update(start=start, end=end, reset_start=start, reset_end=end)
